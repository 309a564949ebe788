//! The families of friction laws, one line each: the coefficient of friction of flanks that roll and slide on each other.
//!
//! Everything in SI; each law turns it into the units of its source. Must not know: who carries which load, gears.

pub mod benedict_kelley;
pub mod constant;
pub mod iso_14179_2;
#[cfg(test)]
mod tests;
pub mod xu;

use std::fmt::Debug;

use declare::declared::Registrable;
use declare::registry;

/// A contact of two flanks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rolling {
    /// Load per width \[N/m\].
    pub line_load: f64,
    /// The largest pressure by Hertz \[Pa\].
    pub pressure: f64,
    /// ρ_red: combined radius of curvature \[m\].
    pub radius: f64,
    /// At which the contact moves along the flanks of pinion and gear \[m/s\].
    pub speeds: [f64; 2],
}

impl Rolling {
    /// v_g: sliding speed \[m/s\], positive where the pinion's flank is the faster one: beyond the pitch point.
    #[must_use]
    pub fn sliding(&self) -> f64 {
        self.speeds[0] - self.speeds[1]
    }

    /// v_Σ \[m/s\].
    #[must_use]
    pub fn sum(&self) -> f64 {
        self.speeds[0] + self.speeds[1]
    }

    /// SR: sliding speed over the mean speed, without sign.
    #[must_use]
    pub fn slide_to_roll(&self) -> f64 {
        2.0 * self.sliding().abs() / self.sum()
    }
}

/// A quantity that a law knows from so much to so much.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// What it is, as part of a sentence.
    pub quantity: &'static str,
    /// The unit in which both are; empty for a plain number.
    pub unit: &'static str,
    /// What it is.
    pub value: f64,
    /// From where to where the law knows it.
    pub range: [f64; 2],
}

/// A law with its settings: a declared struct, which anybody can make.
pub trait Law: Debug + Registrable + Send + Sync {
    /// Whether one coefficient holds along the whole path: that of the pitch point under the whole load.
    fn is_mean(&self) -> bool {
        false
    }

    /// μ of a loaded contact with a radius above 0, not below 0. Where nothing slides it has no meaning.
    fn coefficient(&self, rolling: &Rolling) -> f64;

    /// What of a contact the law knows within limits.
    fn limits(&self, _rolling: &Rolling) -> Vec<Limit> {
        Vec::new()
    }
}

registry!(
    LAWS: Law = constant::Constant,
    iso_14179_2::Iso14179,
    benedict_kelley::BenedictKelley,
    xu::Xu,
);
