//! What is said of a number inside the intervals of its inputs.
//!
//! Must not know: how it was found. Values in the row's unit.

use super::super::verdict::Comparison;
use super::search::{Broken, Cut, Found, How};
use declare::number::{significant, with_unit};
use gearmesh::optimize::least_squares::uncertainty::digits;

/// Before each remark, so that a page can say once what several rows share; reasons have semicolons.
const REMARK: &str = " · ";

/// What is to be said of a number whose inputs were printed rounded.
#[derive(Clone, Debug)]
pub enum Inside {
    Range(Range),
    /// Nothing: this stage depends on them and is not computed anew.
    Held(String),
}

/// What a number comes to.
#[derive(Clone, Debug)]
pub struct Range {
    found: Found,
    /// Of each end that is refused, and of where it is not continuous: inputs with their values.
    cuts: Vec<String>,
    broken: String,
}

impl Inside {
    /// The least and the largest value.
    pub fn ends(&self) -> Option<(f64, f64)> {
        if let Self::Range(range) = self { Some((range.found.least, range.found.largest)) } else { None }
    }

    /// Whether what lies between both is not shown to be taken.
    pub fn is_broken(&self) -> bool {
        matches!(self, Self::Range(range) if range.found.broken.is_some())
    }

    pub fn said(&self, comparison: &Comparison, unit: &str) -> String {
        match self {
            Self::Range(range) => range.said(comparison, unit),
            Self::Held(stage) => {
                let why = format!("inputs were printed rounded; `{stage}` is not computed anew for them");
                ["no range is known", &why].join(REMARK)
            }
        }
    }
}

impl Range {
    /// `words` are the inputs that are moved at a place, with their values; none where nothing changes the number.
    pub fn of(found: Found, words: impl Fn(&[f64]) -> Vec<String>) -> Option<Self> {
        let is_changed =
            found.least < found.largest || found.refused > 0 || !found.cuts.is_empty() || found.broken.is_some();
        let cut = |cut: &Cut| {
            let mut place = vec![0.0; cut.input + 1];
            place[cut.input] = cut.place;
            words(&place).concat()
        };
        let cuts = found.cuts.iter().map(cut).collect();
        let broken = found.broken.as_ref().map_or_else(String::new, |broken| match words(&broken.place) {
            some if some.len() < 3 => some.join(" and "),
            many => format!("{} inputs between their ends", many.len()),
        });
        is_changed.then_some(Self { found, cuts, broken })
    }

    /// Between what it is, and whether some value inside agrees with what is published.
    fn said(&self, comparison: &Comparison, unit: &str) -> String {
        let Found { least, largest, .. } = self.found;
        // To a hundredth of what is between them.
        let shown = digits(least.abs().max(largest.abs()), (largest - least) / 2000.0).clamp(3, 12);
        let number = |value: f64| significant(value, shown);
        let range = format!("{} to {} over the rounded inputs", number(least), with_unit(&number(largest), unit));
        let reached = match (comparison.agrees_as_stated(), comparison.is_reached()) {
            (true, _) => "as stated they reproduce it",
            (false, Some(true)) => "some value inside reproduces it",
            (false, _) => "none found inside reproduces it",
        };
        let mut said = vec![format!("{range}; {reached}")];
        if let Some(Broken { how, .. }) = &self.found.broken {
            let at = if self.broken.is_empty() { String::new() } else { format!(" with {}", self.broken) };
            said.push(match how {
                How::Refused(reason) => format!("inside there is no value{at}: {reason}"),
                How::Endless => format!("inside it is not finite, near what it is{at}"),
                How::Jumps(from, to) => {
                    format!("inside it jumps from {} to {}{at}", number(*from), with_unit(&number(*to), unit))
                }
            });
        }
        for (Cut { side, place, reason, .. }, at) in self.found.cuts.iter().zip(&self.cuts) {
            let beyond = if *side == 0 { "below" } else { "above" };
            said.push(if *place == 0.0 {
                format!("{beyond} what is stated there is no value: {reason}")
            } else {
                format!("searched only up to {at}, {beyond} which there is no value: {reason}")
            });
        }
        if self.found.refused > 0 {
            let Found { refused, corners, reason, .. } = &self.found;
            said.push(format!("no value at {refused} of {corners} corners, for example: {reason}"));
        }
        said.join(REMARK)
    }
}
