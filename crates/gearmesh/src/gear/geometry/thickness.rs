//! How thick teeth are made: by allowances, or as a span or balls in the spaces say; and the generating profile shift.
//!
//! A gear whose teeth are thicker by an allowance A_s on the reference circle is cut with x_E = x + A_s/(2 m tan α) and turned to the
//! tip circle of x, on the centre distance of x. A measurement says x_E, and so A_s. Lengths in m, angles in rad. Source: ISO
//! 21771-1:2024, clauses on tooth thickness, span measurement and dimensions over balls. Must not know: the mate.

use std::f64::consts::PI;
use std::fmt::Debug;

use super::Specification;
use super::error::{GeometryError, Millimetres, Problem};
use super::inspection::odd;
use super::involute::involute;
use declare::declared::Registrable;
use declare::units::LENGTH;
use declare::{Declared, registry};

/// The largest and the smallest A_s that a drawing allows \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// A_sns.
    pub largest: f64,
    /// A_sni.
    pub smallest: f64,
}

impl Limits {
    /// That of a gear in the middle of what is allowed.
    #[must_use]
    pub fn middle(self) -> f64 {
        0.5 * (self.largest + self.smallest)
    }
}

/// What a study states of the thickness.
pub trait Stated: Debug + Registrable {
    /// The allowances of a gear that is specified like this, whatever its own allowance is.
    ///
    /// # Errors
    /// When the smallest is above the largest, or no gear with these teeth measures as stated.
    fn limits(&self, specification: &Specification) -> Result<Limits, GeometryError>;

    /// k of the span and D_M \[m\] of the balls that it was measured with, if it was.
    fn measured_with(&self) -> (Option<u32>, Option<f64>) {
        (None, None)
    }
}

registry!(THICKNESSES: Stated = Allowance, Span, OverBalls);

/// Deviations from the thickness without backlash, on the reference circle, as DIN 3967 has them.
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "allowance")]
pub struct Allowance {
    /// Upper allowance A_sns; below 0 for backlash.
    #[declared(dimension = LENGTH, minimum = -0.1, maximum = 0.1, example = "-60 um")]
    pub upper: f64,
    /// Lower allowance A_sni, when it is another one; the gear is computed in the middle.
    #[declared(dimension = LENGTH, minimum = -0.1, maximum = 0.1, example = "-90 um")]
    pub lower: Option<f64>,
}

/// A span over teeth.
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "span")]
pub struct Span {
    /// Number k of teeth in the span.
    #[declared(minimum = 1, maximum = 10_000, example = "3")]
    pub teeth: u32,
    /// Span measurement W_k, the largest one.
    #[declared(dimension = LENGTH, minimum = 1e-9, maximum = 1e3, example = "23.1 mm")]
    pub largest: f64,
    /// The smallest W_k, when it is another one; the gear is computed in the middle.
    #[declared(dimension = LENGTH, minimum = 1e-9, maximum = 1e3, example = "23.05 mm")]
    pub smallest: Option<f64>,
}

/// Two balls or pins in spaces as nearly opposite as there are.
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "over_balls")]
pub struct OverBalls {
    /// Diameter D_M of the balls.
    #[declared(dimension = LENGTH, minimum = 1e-9, maximum = 1e2, example = "5.25 mm")]
    pub ball_diameter: f64,
    /// Dimension M_dK over both, the largest one.
    #[declared(dimension = LENGTH, minimum = 1e-9, maximum = 1e3, example = "80.1 mm")]
    pub largest: f64,
    /// The smallest M_dK, when it is another one; the gear is computed in the middle.
    #[declared(dimension = LENGTH, minimum = 1e-9, maximum = 1e3, example = "80.05 mm")]
    pub smallest: Option<f64>,
}

fn ordered(largest: f64, smallest: f64) -> Result<Limits, GeometryError> {
    if smallest > largest {
        let [largest, smallest] = [largest, smallest].map(Millimetres);
        return Err(Problem::ThicknessLimits { largest, smallest }.into());
    }
    Ok(Limits { largest, smallest })
}

impl Stated for Allowance {
    fn limits(&self, _specification: &Specification) -> Result<Limits, GeometryError> {
        ordered(self.upper, self.lower.unwrap_or(self.upper))
    }
}

impl Stated for Span {
    fn limits(&self, specification: &Specification) -> Result<Limits, GeometryError> {
        let stated = ordered(self.largest, self.smallest.unwrap_or(self.largest))?;
        let allowance =
            |length: f64| specification.allowance_of(specification.profile_shift_of_span(self.teeth, length));
        Ok(Limits { largest: allowance(stated.largest), smallest: allowance(stated.smallest) })
    }

    fn measured_with(&self) -> (Option<u32>, Option<f64>) {
        (Some(self.teeth), None)
    }
}

impl Stated for OverBalls {
    fn limits(&self, specification: &Specification) -> Result<Limits, GeometryError> {
        let stated = ordered(self.largest, self.smallest.unwrap_or(self.largest))?;
        let allowance = |over_two: f64| {
            let shift = specification.profile_shift_of_balls(self.ball_diameter, over_two).ok_or_else(|| {
                let minimum = specification.base_diameter() * odd(specification.teeth) + self.ball_diameter;
                Problem::BallsInside { found: Millimetres(over_two), minimum: Millimetres(minimum) }
            })?;
            Ok::<_, GeometryError>(specification.allowance_of(shift))
        };
        Ok(Limits { largest: allowance(stated.largest)?, smallest: allowance(stated.smallest)? })
    }

    fn measured_with(&self) -> (Option<u32>, Option<f64>) {
        (None, Some(self.ball_diameter))
    }
}

impl Specification {
    /// x_E: with which the gear is cut.
    #[must_use]
    pub fn generating_profile_shift(&self) -> f64 {
        self.profile_shift + self.thickness_allowance / (2.0 * self.module * libm::tan(self.pressure_angle))
    }

    /// A_s of a gear that is cut with this x_E.
    #[must_use]
    pub fn allowance_of(&self, generating: f64) -> f64 {
        2.0 * self.module * libm::tan(self.pressure_angle) * (generating - self.profile_shift)
    }

    fn base_diameter(&self) -> f64 {
        self.module * f64::from(self.teeth) * libm::cos(self.pressure_angle)
    }

    /// The generating profile shift at which a span over so many teeth has a length \[m\].
    #[must_use]
    pub fn profile_shift_of_span(&self, teeth: u32, length: f64) -> f64 {
        let (z, k) = (f64::from(self.teeth), f64::from(teeth));
        let (sine, cosine) = libm::sincos(self.pressure_angle);
        let pitches = PI * (k - 0.5) + z * involute(self.pressure_angle);
        (length / (self.module * cosine) - pitches) * cosine / (2.0 * sine)
    }

    /// The generating profile shift at which the dimension over two balls is so large \[m\]; none where the balls would lie
    /// inside the base circle.
    #[must_use]
    pub fn profile_shift_of_balls(&self, diameter: f64, over_two: f64) -> Option<f64> {
        let z = f64::from(self.teeth);
        let ratio = self.base_diameter() * odd(self.teeth) / (over_two - diameter);
        (ratio > 0.0 && ratio <= 1.0).then(|| {
            let half_base_angle = involute(libm::acos(ratio)) - diameter / self.base_diameter() + PI / z;
            let shifted = half_base_angle - involute(self.pressure_angle) - 0.5 * PI / z;
            0.5 * z * shifted / libm::tan(self.pressure_angle)
        })
    }
}

#[cfg(test)]
mod tests;
