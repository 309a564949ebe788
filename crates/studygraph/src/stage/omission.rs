//! What a stage does not compute, why, and about what it would have taken.
//!
//! The time is counted work times what a unit takes, scaled by how long the work took that the stage did: right to a
//! factor of two or three, which is all that anybody wants to know of it. Must not know: tables, the runner.

use std::sync::Arc;

use declare::work::{Counter, Work};

/// Something that was not computed, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct Omission {
    pub what: Arc<str>,
    pub why: Arc<str>,
    /// None where nothing to speak of is saved, or nobody knows.
    pub saved: Option<Saved>,
}

/// Work that would have been done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Saved {
    /// As much as that.
    Fixed(&'static Counter, f64),
    /// `times` as many as there were of what was `done`.
    For { done: &'static Counter, saved: &'static Counter, times: f64 },
}

impl Omission {
    #[must_use]
    pub fn new(what: impl AsRef<str>, why: impl AsRef<str>) -> Self {
        Self { what: what.as_ref().into(), why: why.as_ref().into(), saved: None }
    }

    #[must_use]
    pub fn saving(self, saved: Option<Saved>) -> Self {
        Self { saved, ..self }
    }

    /// About how many seconds it would have taken a stage that did `work` in `seconds`; none when that is not known.
    #[must_use]
    pub fn seconds(&self, work: &Work, seconds: f64) -> Option<f64> {
        let (counter, count) = match self.saved? {
            Saved::Fixed(counter, count) => (counter, count),
            Saved::For { done, saved, times } => (saved, times * work.count(done) as f64),
        };
        let usual = work.seconds();
        // A stage that did next to nothing tells nothing of the machine.
        let pace = if usual > LEAST { (seconds / usual).clamp(1.0 / MOST_PACE, MOST_PACE) } else { 1.0 };
        let unit = counter.seconds;
        (count > 0.0 && unit > 0.0).then_some(pace * unit * count)
    }
}

/// Those that save the same unknown for the same reason as one, for readers.
#[must_use]
pub fn together(omissions: &[Omission]) -> Vec<Omission> {
    let mut found: Vec<Omission> = Vec::new();
    for omission in omissions {
        match found.last_mut().filter(|last| last.saved.is_none() && omission.saved.is_none()) {
            Some(last) if last.why == omission.why => last.what = format!("{}, {}", last.what, omission.what).into(),
            _ => found.push(omission.clone()),
        }
    }
    found
}

/// Seconds of counted work below which the measured time is that of other things.
const LEAST: f64 = 1e-4;
/// By how much a machine may be faster or slower.
const MOST_PACE: f64 = 4.0;

#[cfg(test)]
mod tests {
    use super::*;

    static SOLVES: Counter = Counter { name: "solves", seconds: 3e-7, adds: true };
    static PRESSURES: Counter = Counter { name: "pressures", seconds: 6e-8, adds: true };
    static MESHES: Counter = Counter { name: "meshes", seconds: 2e-2, adds: true };

    #[test]
    fn time_saved_is_the_work_left_out_at_the_pace_of_the_work_done() {
        let solves = |count| Work::of(&SOLVES, count);
        let pressures = Saved::For { done: &SOLVES, saved: &PRESSURES, times: 1.0 };
        let omission = Omission::new("pressures", "nobody asked").saving(Some(pressures));
        // A pressure is a fifth of a solve, on whatever machine.
        for seconds in [0.12, 0.4] {
            let saved = omission.seconds(&solves(1_000_000), seconds).unwrap();
            assert!((saved / seconds - 0.2).abs() < 1e-12);
        }
        assert_eq!(omission.seconds(&Work::NONE, 3.0), None, "no solves, no pressures");
        let meshes = Omission::new("meshes", "").saving(Some(Saved::Fixed(&MESHES, 4.0)));
        assert!((meshes.seconds(&Work::NONE, 1e-5).unwrap() - 0.08).abs() < 1e-12);
        assert_eq!(Omission::new("a", "b").seconds(&solves(10), 1.0), None);
    }
}
