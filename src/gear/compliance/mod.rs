//! Compliance of teeth: what every method gives, as functions of the roll angle of the loaded point.
//!
//! Micro-geometry never enters these tables; it only changes gaps. Lengths in m, forces in N.
//! Must not know: modification, load.

use crate::numeric::chebyshev::Series;

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
