//! The curves of which a root is made.
//!
//! Must not know: which root has which.

use super::involute::{Section, involute_at};
use super::trochoid::Trochoid;

/// A smooth piece of a root, from the clamped end upwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Piece {
    /// Over q = asinh(cot γ).
    Trochoid(Trochoid),
    /// Over the angle about its centre, 0 towards the gear's centre.
    Arc {
        /// Distance of its centre from the gear's \[m\].
        centre_radius: f64,
        /// Angle of its centre from the tooth's centreline \[rad\].
        centre_angle: f64,
        /// Its radius \[m\].
        radius: f64,
        /// The parameter at its lower end \[rad\]; 0 where it touches the root circle.
        start: f64,
        /// The parameter at its upper end \[rad\].
        extent: f64,
    },
    /// Over the roll angle of an involute that is not the flank's.
    Involute {
        /// Its base radius \[m\].
        base_radius: f64,
        /// Half the angle between it and its mirror image at its base circle \[rad\].
        half_base_angle: f64,
        /// Roll angle at its lower end.
        from: f64,
        /// Roll angle at its upper end.
        to: f64,
    },
    /// Over the radius.
    Radial {
        /// Its angle from the tooth's centreline, ψ_b \[rad\].
        angle: f64,
        /// Its lower end \[m\].
        lower: f64,
        /// Its upper end, r_b \[m\].
        upper: f64,
    },
}

impl Piece {
    /// The range of the parameter.
    #[must_use]
    pub fn range(&self) -> (f64, f64) {
        match self {
            Self::Trochoid(curve) => (0.0, curve.joint_parameter()),
            Self::Arc { start, extent, .. } => (*start, *extent),
            Self::Involute { from, to, .. } => (*from, *to),
            Self::Radial { lower, upper, .. } => (*lower, *upper),
        }
    }

    /// The section at a parameter.
    #[must_use]
    pub fn section(&self, parameter: f64) -> Section {
        match *self {
            Self::Trochoid(curve) => curve.section(parameter),
            Self::Arc { centre_radius, centre_angle, radius, .. } => {
                let (sine, cosine) = libm::sincos(centre_angle);
                let (arc_sine, arc_cosine) = libm::sincos(centre_angle + parameter);
                Section {
                    half_thickness: centre_radius * sine - radius * arc_sine,
                    height: centre_radius * cosine - radius * arc_cosine,
                    height_rate: radius * arc_sine,
                }
            }
            Self::Involute { base_radius, half_base_angle, .. } => involute_at(base_radius, half_base_angle, parameter),
            Self::Radial { angle, .. } => {
                let (sine, cosine) = libm::sincos(angle);
                Section { half_thickness: parameter * sine, height: parameter * cosine, height_rate: cosine }
            }
        }
    }
}
