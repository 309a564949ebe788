//! The ends of what is admitted about a value: by steps outward to the first that is refused, then by bisection.
//!
//! Must not know: what refuses, what is computed for it.

use crate::stage::rows::values::level;
use declare::error::Failure;
use declare::number::{significant, with_unit};

/// Ends are found to this share of what is tried, or to neighbouring numbers.
const NEAR: f64 = 1e-12;

/// A field that is tried.
#[derive(Clone, Debug)]
pub struct Parameter {
    pub name: String,
    pub path: String,
    pub unit: String,
    /// In SI, the lower one first.
    pub bounds: [f64; 2],
    /// Of a whole number: what it is a multiple of.
    pub multiple: Option<f64>,
    /// What the study has, in SI.
    pub own: Option<f64>,
}

/// To which side of an admitted value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    Lower,
    Upper,
}

/// An end of what is admitted of a parameter.
pub struct End {
    /// Its index.
    pub parameter: usize,
    pub side: Side,
    /// The outermost value that is admitted, all tried ones between it and the study's being so too.
    pub admitted: f64,
    /// The nearest beyond it that is refused, and why; none up to the bound.
    pub refused: Option<(f64, String)>,
    /// Values that were tried to this side.
    pub evaluations: usize,
}

/// Why each of these values of parameters is refused; none where it is not.
pub type Ask<'a> = &'a mut dyn FnMut(&[(usize, f64)]) -> Result<Vec<Option<String>>, Failure>;

impl Side {
    pub const BOTH: [Self; 2] = [Self::Lower, Self::Upper];

    pub fn word(self) -> &'static str {
        match self {
            Self::Lower => "lower",
            Self::Upper => "upper",
        }
    }

    fn bound(self, parameter: &Parameter) -> f64 {
        parameter.bounds[self as usize]
    }

    /// Whether a value is no nearer than another one.
    fn is_beyond(self, value: f64, other: f64) -> bool {
        match self {
            Self::Lower => value <= other,
            Self::Upper => value >= other,
        }
    }
}

impl Parameter {
    /// In its unit, so that what is written is what was tried.
    pub fn shown(&self, si: f64) -> f64 {
        level(si, &self.unit).shown
    }

    fn words(&self, si: f64) -> String {
        with_unit(&significant(self.shown(si), 6), &self.unit)
    }

    /// The nearest value that can be written in its unit.
    fn at(&self, si: f64) -> f64 {
        match self.multiple {
            Some(multiple) => (si / multiple).round() * multiple,
            None => level(si, &self.unit).si,
        }
    }

    /// What the study has, where that is tried.
    fn inside(&self) -> Option<f64> {
        self.own.filter(|own| self.bounds[0] <= *own && *own <= self.bounds[1])
    }

    /// From one value in so many steps to another, which is the last; whole numbers may be fewer.
    fn steps(&self, from: f64, to: f64, count: usize) -> Vec<f64> {
        if from.total_cmp(&to).is_eq() {
            return Vec::new();
        }
        let inner = (1..count).map(|step| self.at(from + (to - from) * (step as f64 / count as f64)));
        let mut steps: Vec<f64> = inner.filter(|step| step.total_cmp(&from).is_ne()).collect();
        steps.push(to);
        steps.dedup();
        steps
    }

    /// A value between two, if they are not near enough.
    fn between(&self, one: f64, two: f64) -> Option<f64> {
        let (low, high) = (one.min(two), one.max(two));
        let middle = self.at(0.5 * (low + high));
        let is_near = high - low <= NEAR * (self.bounds[1] - self.bounds[0]);
        (!is_near && low < middle && middle < high).then_some(middle)
    }

    /// All that is tried where the study's own value says nothing, the nearest to it first.
    fn anywhere(&self, probes: usize) -> Vec<f64> {
        let [low, high] = self.bounds;
        let wanted = self.own.unwrap_or(0.5 * (low + high));
        let mut values = vec![low];
        values.extend(self.steps(low, high, probes));
        values.sort_by(|one, two| (one - wanted).abs().total_cmp(&(two - wanted).abs()));
        values
    }
}

impl End {
    fn learn(&mut self, value: f64, reason: Option<String>) {
        self.evaluations += 1;
        // What lies beyond a refusal does not count, admitted or not.
        if self.refused.as_ref().is_some_and(|(refused, _)| self.side.is_beyond(value, *refused)) {
            return;
        }
        match reason {
            Some(reason) => self.refused = Some((value, reason)),
            None => self.admitted = value,
        }
    }
}

/// Both ends of every parameter, the lower one first.
///
/// # Errors
/// When a parameter of `of` is refused everywhere, and what `ask` says.
pub fn ends((of, parameters): (&str, &[Parameter]), probes: usize, ask: Ask) -> Result<Vec<End>, Failure> {
    let starts = starts((of, parameters), probes, ask)?;
    let mut ends: Vec<End> = Vec::new();
    for (parameter, start) in starts.into_iter().enumerate() {
        let end = |side| End { parameter, side, admitted: start, refused: None, evaluations: 0 };
        ends.extend(Side::BOTH.map(end));
    }
    let mut steps: Vec<(usize, f64)> = Vec::new();
    for (at, end) in ends.iter().enumerate() {
        let parameter = &parameters[end.parameter];
        let outward = parameter.steps(end.admitted, end.side.bound(parameter), probes);
        steps.extend(outward.into_iter().map(|value| (at, value)));
    }
    while !steps.is_empty() {
        let asked: Vec<(usize, f64)> = steps.iter().map(|(at, value)| (ends[*at].parameter, *value)).collect();
        for ((at, value), reason) in steps.into_iter().zip(ask(&asked)?) {
            ends[at].learn(value, reason);
        }
        let next = |(at, end): (usize, &End)| {
            let (refused, _) = end.refused.as_ref()?;
            Some((at, parameters[end.parameter].between(end.admitted, *refused)?))
        };
        steps = ends.iter().enumerate().filter_map(next).collect();
    }
    Ok(ends)
}

/// An admitted value of each: the study's, or the nearest of some others.
fn starts((of, parameters): (&str, &[Parameter]), probes: usize, ask: Ask) -> Result<Vec<f64>, Failure> {
    let own = parameters.iter().enumerate().filter_map(|(at, parameter)| Some((at, parameter.inside()?)));
    let own: Vec<(usize, f64)> = own.collect();
    let mut starts: Vec<Option<f64>> = vec![None; parameters.len()];
    for ((at, value), reason) in own.iter().zip(ask(&own)?) {
        starts[*at] = reason.is_none().then_some(*value);
    }
    let mut found = Vec::with_capacity(parameters.len());
    for (at, (parameter, start)) in parameters.iter().zip(starts).enumerate() {
        if let Some(start) = start {
            found.push(start);
            continue;
        }
        let tried = parameter.anywhere(probes);
        let asked: Vec<(usize, f64)> = tried.iter().map(|value| (at, *value)).collect();
        let reasons = ask(&asked)?;
        let Some(admitted) = reasons.iter().position(Option::is_none) else {
            let [low, high] = parameter.bounds.map(|bound| parameter.words(bound));
            let nearest = tried.first().map_or_else(String::new, |value| parameter.words(*value));
            let reason = reasons.into_iter().flatten().next().unwrap_or_default();
            return Err(Failure::new(format!(
                "`{of}` is refused with each of {} values of `{}` from {low} to {high}, with {nearest} for example: {reason}",
                tried.len(),
                parameter.name
            )));
        };
        found.push(tried[admitted]);
    }
    Ok(found)
}
