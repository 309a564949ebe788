//! What is said of transmission errors that the law of contact is in doubt about: once for all of a stage, of the worst design
//! and torque.
//!
//! Must not know: how large a doubt is, whose designs they are.

use declare::units::in_unit;
use gearmesh::gear::mesh::answers::contact_law_error::{Cause, ContactLawError};
use studygraph::warning::Cases;

/// A design under a torque, and what its number may be off by.
#[derive(Clone, Debug)]
pub struct ReportedContactLawError<'a> {
    /// Its name.
    pub design: &'a str,
    /// On the pinion \[N m\].
    pub torque: f64,
    /// What the law of contact may be off by.
    pub doubt: ContactLawError,
    /// Of the transmission error \[m\].
    pub peak_to_peak: f64,
}

impl ReportedContactLawError<'_> {
    /// Over the approach.
    fn share(&self) -> f64 {
        self.doubt.size / self.doubt.approach
    }

    fn says(&self) -> String {
        let ContactLawError { size, position, widest: [half, limit], cause, .. } = self.doubt;
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
        format!(
            "design `{}` at {} N m: {reason}{beyond}; the transmission error may be off by {:.3} um, {:.2} % of the \
             approach{}, {:.3} mm into the mesh cycle",
            self.design,
            self.torque,
            in_unit(size, "um"),
            100.0 * self.share(),
            self.of_peak_to_peak(" and"),
            millimetres(position),
        )
    }

    fn of_peak_to_peak(&self, before: &str) -> String {
        if self.peak_to_peak > 0.0 {
            format!("{before} {:.2} % of the peak-to-peak", 100.0 * self.doubt.size / self.peak_to_peak)
        } else {
            String::new()
        }
    }

    /// What is said of it among all of a stage; nothing where the doubt does not matter.
    #[must_use]
    pub fn told(&self) -> Option<Cases> {
        let Self { design, torque, doubt, .. } = self;
        let size = in_unit(doubt.size, "um");
        let most = format!("{size:.3} um{} with `{design}` at {torque} N m", self.of_peak_to_peak(","));
        let case = Cases::one("law of contact", design, (*torque, "N m"), (self.share(), self.says()));
        doubt.matters().then(|| case.with_most(size, most))
    }
}
