//! What a search is after: what is to be small, and what every design must keep.
//!
//! A constraint is kept in every case, or with `combine: quantile` in that share of them. By how much it is broken is
//! counted in its limit. Must not know: how a design is found, how it is searched.

use crate::stage::cases::Cases;
use crate::stage::limit::Comparison;
use crate::stage::measures::{Measure, Measures};
use declare::declared::Placed;
use declare::error::Diagnostic;
use declare::number::{significant, with_unit};
use declare::units::in_unit;
use gearmesh::gear::mesh::Loaded;
use gearmesh::optimize::constraints::Evaluation;

/// Objectives and constraints.
pub struct Goal {
    /// All numbers that are asked of a curve, those that are to be small first.
    pub measures: Vec<Measure>,
    /// How many of them are to be small; at least one.
    objectives: usize,
    pub limits: Vec<Limit>,
    asked: Measures,
}

/// A constraint.
#[derive(Clone, Debug)]
pub struct Limit {
    /// Which of the measures.
    pub measure: usize,
    /// The most it may be; else the least.
    is_most: bool,
    /// In SI.
    value: f64,
    /// What a reserve of 1 is, in SI: the limit, or where that is 0 one of its unit.
    scale: f64,
    /// As the study has it.
    pub text: String,
}

/// What a design is worth.
#[derive(Clone, Debug)]
pub struct Worth {
    pub evaluation: Evaluation,
    /// What each limit is for, in the case that decides, in SI.
    pub limited: Vec<f64>,
}

impl Goal {
    /// # Errors
    /// What is no number of a curve, no limit, or cannot be kept whatever the design, with its place.
    pub fn read(minimize: &[Placed<String>], subject_to: &[Placed<String>]) -> Result<Self, Diagnostic> {
        let mut measures: Vec<Measure> = Vec::new();
        for text in minimize {
            let measure = Measure::placed(text)?;
            if measures.contains(&measure) {
                let message = format!("`{}` is to be minimized twice", measure.column);
                return Err(Diagnostic::new(message).at(text.place));
            }
            measures.push(measure);
        }
        let objectives = measures.len();
        let mut limits: Vec<(Limit, &Placed<String>)> = Vec::new();
        for text in subject_to {
            let limit = Limit::read(text, &mut measures)?;
            let contradicts = |other: &Limit| {
                let (most, least) = if limit.is_most { (&limit, other) } else { (other, &limit) };
                other.measure == limit.measure && most.is_most && !least.is_most && most.value < least.value
            };
            if let Some((other, _)) = limits.iter().find(|(other, _)| contradicts(other)) {
                let message = format!("no design keeps both `{}` and `{}`", other.text, limit.text);
                return Err(Diagnostic::new(message).at(text.place));
            }
            limits.push((limit, text));
        }
        let asked = Measures::new(measures.clone());
        Ok(Self { measures, objectives, limits: limits.into_iter().map(|(limit, _)| limit).collect(), asked })
    }

    /// What is to be small.
    pub fn objectives(&self) -> &[Measure] {
        &self.measures[..self.objectives]
    }

    /// Whether it is a front that is searched.
    pub fn has_front(&self) -> bool {
        self.objectives > 1
    }

    /// Whether a cycle has to know what loads do to the roots.
    pub fn needs_roots(&self) -> bool {
        self.measures.iter().any(Measure::needs_roots)
    }

    /// All measures of one case, in SI; none where the design is beyond the model.
    pub fn of_case(&self, loading: &Loaded) -> Option<Vec<f64>> {
        // The two that searches are mostly after, by a path of their own.
        if let [only] = &self.measures[..] {
            if only.is("peak_to_peak") {
                return Some(vec![loading.peak_to_peak()]);
            }
            if only.is("variance") {
                return Some(vec![loading.variance()]);
            }
        }
        let settings = loading.mesh().settings;
        self.asked.of(loading, (settings, 0), |_| f64::NAN).ok()
    }

    /// What the measures of all cases come to.
    pub fn worth(&self, cases: &Cases, of_cases: &[Option<Vec<f64>>]) -> Worth {
        let Some(of_cases) = of_cases.iter().map(Option::as_ref).collect::<Option<Vec<_>>>() else {
            return Worth { evaluation: Evaluation::from(f64::INFINITY), limited: vec![f64::NAN; self.limits.len()] };
        };
        let of = |measure: usize| of_cases.iter().map(|values| values[measure]).collect::<Vec<f64>>();
        let mut objectives = (0..self.objectives).map(|measure| cases.combined(&of(measure)));
        let value = objectives.next().unwrap_or(f64::NAN);
        let further = objectives.collect();
        let broken = |limit: &Limit| {
            let broken: Vec<f64> = of(limit.measure).into_iter().map(|value| -limit.reserve(value)).collect();
            if broken.iter().any(|broken| broken.is_nan()) { f64::NAN } else { cases.decisive(&broken) }
        };
        let constraints: Vec<f64> = self.limits.iter().map(|limit| -broken(limit)).collect();
        let limited = self.limits.iter().zip(&constraints).map(|(limit, reserve)| limit.at(*reserve)).collect();
        Worth { evaluation: Evaluation { value, further, constraints }, limited }
    }
}

impl Limit {
    fn read(text: &Placed<String>, measures: &mut Vec<Measure>) -> Result<Self, Diagnostic> {
        Self::parse(text.value.trim(), measures).map_err(|wrong| wrong.at(text.place))
    }

    fn parse(text: &str, measures: &mut Vec<Measure>) -> Result<Self, Diagnostic> {
        let Some(comparison) = Comparison::of(text).filter(|comparison| comparison.may_be_met) else {
            return Err(Diagnostic::new(format!("`{text}` is not a constraint"))
                .help("write `column <= limit` or `column >= limit`, for example `largest_pressure <= 1400 MPa`"));
        };
        let measure = Measure::read(comparison.name)?;
        let [value, one] = comparison.bound(measure.unit)?;
        let index = measures.iter().position(|known| *known == measure).unwrap_or_else(|| {
            measures.push(measure);
            measures.len() - 1
        });
        let scale = if value == 0.0 { one } else { value.abs() };
        Ok(Self { measure: index, is_most: comparison.is_upper, value, scale, text: text.to_owned() })
    }

    /// What is left, in shares of the limit.
    fn reserve(&self, value: f64) -> f64 {
        let left = if self.is_most { self.value - value } else { value - self.value };
        left / self.scale
    }

    /// The value with this reserve.
    fn at(&self, reserve: f64) -> f64 {
        if self.is_most { self.value - reserve * self.scale } else { self.value + reserve * self.scale }
    }

    /// `1512.3 MPa, 112.3 MPa too much`, for the reserve of what comes nearest.
    pub fn missed(&self, reserve: f64, unit: &str) -> String {
        let shown = |value: f64| with_unit(&significant(in_unit(value, unit), 6), unit);
        let how = if self.is_most { "too much" } else { "too little" };
        format!("{}, {} {how}", shown(self.at(reserve)), shown(-reserve * self.scale))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use declare::error::Place;

    fn placed(texts: &[&str]) -> Vec<Placed<String>> {
        texts.iter().map(|text| Placed { value: (*text).to_owned(), place: Place::default() }).collect()
    }

    fn goal(minimize: &[&str], subject_to: &[&str]) -> Result<Goal, Diagnostic> {
        Goal::read(&placed(minimize), &placed(subject_to))
    }

    #[test]
    fn objectives_and_limits_share_what_they_ask() {
        let limits = ["largest_pressure <= 1.4 GPa", "loaded_contact_ratio >= 1.2", "peak_to_peak <= 0 um"];
        let goal = goal(&["peak_to_peak", "harmonics[order=2].amplitude"], &limits).unwrap();
        let names: Vec<&str> = goal.measures.iter().map(|measure| measure.column.as_str()).collect();
        assert_eq!(names, ["peak_to_peak", "amplitude_2", "largest_pressure", "loaded_contact_ratio"]);
        assert_eq!(goal.objectives().len(), 2);
        assert_eq!(goal.limits.iter().map(|limit| limit.measure).collect::<Vec<_>>(), [2, 3, 0]);
        let close = |found: f64, exact: f64| assert!((found - exact).abs() < 1e-12, "{found} {exact}");
        close(goal.limits[0].reserve(1.05e9), 0.25);
        close(goal.limits[1].reserve(0.9), -0.25);
        // A limit of 0 has no size; one µm is one.
        close(goal.limits[2].reserve(2e-6), -2.0);
        assert_eq!(goal.limits[0].missed(-0.25, "MPa"), "1750\u{202f}MPa, 350\u{202f}MPa too much");
        assert_eq!(goal.limits[1].missed(-0.25, ""), "0.9, 0.3 too little");
    }

    #[test]
    fn what_cannot_be_asked_is_refused() {
        let refused = |minimize: &[&str], subject_to: &[&str]| {
            let wrong = goal(minimize, subject_to).err().unwrap();
            format!("{}; {}", wrong.message, wrong.help.unwrap_or_default())
        };
        let plain = ["peak_to_peak"];
        assert!(refused(&["peak_to_peek"], &[]).contains("did you mean `peak_to_peak`?"));
        assert!(refused(&["harmonics[order=0].amplitude"], &[]).contains("`harmonics[order=1].amplitude`"));
        assert!(refused(&["error_estimate"], &[]).contains("no number of a curve that a design can change"));
        assert!(refused(&["mean", "mean"], &[]).contains("twice"));
        assert!(refused(&plain, &["largest_presure <= 1 GPa"]).contains("did you mean `largest_pressure`?"));
        assert!(refused(&plain, &["largest_pressure < 1 GPa"]).contains("`column <= limit`"));
        assert!(refused(&plain, &["largest_pressure <= 1400"]).contains("given in MPa"));
        assert!(refused(&plain, &["loaded_contact_ratio >= 1 um"]).contains("a plain number"));
        assert!(refused(&plain, &["largest_pressure <= many MPa"]).contains("many"));
        let both = refused(&plain, &["mean >= 3 um", "mean <= 2 um"]);
        assert!(both.contains("no design keeps both `mean >= 3 um` and `mean <= 2 um`"), "{both}");
    }
}
