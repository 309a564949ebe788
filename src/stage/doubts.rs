//! What is said of transmission errors that the law of contact is in doubt about: once for all that is computed together, of the
//! worst design.
//!
//! Must not know: how large a doubt is, whose designs they are.

use declare::units::in_unit;
use gearmesh::gear::transmission_error::doubt::{Cause, Doubt};

/// A design under a torque, and what its number may be off by.
#[derive(Clone, Debug)]
pub struct Doubted<'a> {
    /// Its name.
    pub design: &'a str,
    /// On the pinion \[N m\].
    pub torque: f64,
    /// What the law of contact may be off by.
    pub doubt: Doubt,
    /// Of the transmission error \[m\].
    pub peak_to_peak: f64,
}

impl Doubted<'_> {
    /// Over the approach.
    fn share(&self) -> f64 {
        self.doubt.size / self.doubt.approach
    }

    fn says(&self) -> String {
        let Doubt { size, widest: [half, limit], cause, .. } = self.doubt;
        let millimetres = |length: f64| in_unit(length, "mm");
        let reason = match cause {
            Cause::BaseCircle(side) => format!(
                "a contact is wider than the flank of the {} is long down to its base circle, where Hertz' contact ends",
                side.name()
            ),
            Cause::TwoTouches(apart) => format!(
                "a pair touches at two places, {:.6} mm apart, and the law of contact knows one",
                millimetres(apart)
            ),
            Cause::Shape => {
                "beside a contact the flanks do not stand apart as the parabola of the law of contact".to_owned()
            }
            Cause::Width => format!("the flanks touch {:.6} mm to either side", millimetres(half)),
        };
        let beyond = if half > limit {
            let touch = if cause == Cause::Width {
                String::new()
            } else {
                format!("touch {:.6} mm to either side, ", millimetres(half))
            };
            format!(", but {touch}are half planes up to {:.6} mm only", millimetres(limit))
        } else {
            String::new()
        };
        let range = if self.peak_to_peak > 0.0 {
            format!(" and {:.2} % of the peak-to-peak", 100.0 * size / self.peak_to_peak)
        } else {
            String::new()
        };
        format!(
            "design `{}` at {} N m: {reason}{beyond}; the transmission error may be off by {:.3} um, {:.2} % of the approach{range}",
            self.design,
            self.torque,
            in_unit(size, "um"),
            100.0 * self.share(),
        )
    }
}

/// What is to be said of all of them; nothing where no doubt matters.
#[must_use]
pub fn sentence<'a>(all: impl IntoIterator<Item = Doubted<'a>>) -> Option<String> {
    let mattering: Vec<Doubted> = all.into_iter().filter(|doubted| doubted.doubt.matters()).collect();
    // Of equal ones the first, so that the order of the tasks says which.
    let worst = mattering.iter().reduce(|worst, next| if next.share() > worst.share() { next } else { worst })?;
    let others = match mattering.len() - 1 {
        0 => String::new(),
        1 => "; one other design and torque is in doubt, less so".to_owned(),
        count => format!("; {count} other designs and torques are in doubt, less so"),
    };
    Some(worst.says() + &others)
}
