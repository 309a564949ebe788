//! Compliance of teeth: what every method gives, as functions of the roll angle of the loaded point.
//!
//! Micro-geometry never enters these tables; it only changes gaps. Lengths in m, forces in N.
//! Must not know: modification, load.

pub mod energy;
pub mod iso6336;
pub mod ring;
pub mod sainsot;
pub mod sections;

#[cfg(test)]
mod tests;

use crate::base::parameter::Member;
use crate::base::record::Record;
use crate::gear::geometry::root::RootShape;
use crate::gear::geometry::{Pair, Side};
use crate::numeric::chebyshev::Series;

/// A way to find a tooth's compliance.
pub struct Method {
    pub member: Member,
    /// The compliances of one gear of a pair, and what the user should know about them.
    pub tooth: fn(&Record, &Pair, Side, &Setting) -> Result<(ToothCompliance, Vec<String>), ComplianceError>,
}

/// The methods, one line each.
pub const METHODS: &[Method] = &[energy::METHOD];

const MEMBERS: &[Member] = &[METHODS[0].member];

/// The methods as a user sees them.
#[must_use]
pub fn members() -> &'static [Member] {
    MEMBERS
}

/// The method called `name`.
#[must_use]
pub fn method(name: &str) -> Option<&'static Method> {
    METHODS.iter().find(|method| method.member.name == name)
}

/// What every method is told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    pub root: RootShape,
    pub contact: ContactLaw,
    /// Whether loaded neighbours deflect each other through the body.
    pub coupled: bool,
}

impl PairCompliance {
    /// The compliances of both gears by one method.
    ///
    /// # Errors
    /// When the method has no answer for one of the gears.
    pub fn new(
        method: &Method,
        options: &Record,
        pair: &Pair,
        setting: &Setting,
    ) -> Result<(Self, Vec<String>), ComplianceError> {
        let (pinion, mut warnings) = (method.tooth)(options, pair, Side::Pinion, setting)?;
        let (gear, more) = (method.tooth)(options, pair, Side::Gear, setting)?;
        warnings.extend(more);
        Ok((Self { pinion, gear, contact: setting.contact, coupled: setting.coupled }, warnings))
    }
}

/// Why a method has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ComplianceError {
    #[error("contact reaches the {gear} at radius {:.6} mm, below {:.6} mm where its root begins; choose another root", reached * 1e3, starts * 1e3)]
    Root { gear: &'static str, reached: f64, starts: f64 },
    #[error(
        "the body formula of Sainsot et al. gives a negative compliance for the {gear} (h = r_f/r_bore = {radius_ratio:.3}, \
         θ_f = {half_angle:.4} rad); it was fitted for h from 1.4 to 7 and θ_f from 0.01 to 0.12 rad"
    )]
    Body { gear: &'static str, radius_ratio: f64, half_angle: f64 },
}

/// Linear elastic, isotropic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// E \[Pa\].
    pub youngs_modulus: f64,
    /// ν.
    pub poisson_ratio: f64,
}

/// The compliances \[m/N\] of one gear's tooth over the whole of its face width, against the roll angle \[rad\] of the
/// contact point.
#[derive(Clone, Debug, PartialEq)]
pub struct ToothCompliance {
    pub bending: Series,
    pub shear: Series,
    pub axial: Series,
    /// Gear body under the tooth's own load.
    pub body: Series,
    /// Distance from the contact point to the tooth's centreline along the load line \[m\]: the depth t of the
    /// load-dependent contact laws.
    pub contact_depth: Series,
    /// Body deflection at a tooth per load on the neighbour k + 1 pitches ahead. The argument is the roll angle u of the
    /// tooth with the *smaller* roll angle; the other one has u + (k + 1)·2π/z. Symmetric, so one table serves both.
    pub neighbours: Vec<Series>,
}

impl ToothCompliance {
    /// Everything but the contact \[m/N\].
    #[must_use]
    pub fn total(&self, roll: f64) -> f64 {
        self.bending.value(roll) + self.shear.value(roll) + self.axial.value(roll) + self.body.value(roll)
    }
}

/// How two flanks flatten against each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactLaw {
    /// 4(1 − ν²)/(π E b): the article `energy_ga`.
    Linear,
    /// Weber and Banaschek: 2(1 − ν²)/(πE)·[ln(2t/b_H) − ν/(2(1 − ν))] per body and load per width.
    LoadDependent,
}

/// Everything the contact solver needs to know of a pair's elasticity.
#[derive(Clone, Debug, PartialEq)]
pub struct PairCompliance {
    pub pinion: ToothCompliance,
    pub gear: ToothCompliance,
    pub contact: ContactLaw,
    /// Whether loads on neighbouring teeth deflect each other through the gear bodies.
    pub coupled: bool,
}
