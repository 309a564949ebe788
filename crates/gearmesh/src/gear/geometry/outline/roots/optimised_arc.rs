//! The article's optimisation, solved: the arc tangent to the flank on the base circle that comes nearest to the root circle.
//!
//! Equations 27 to 30 as corrected: the circle passes through A along the flank, its centre lies between the tooth and the
//! middle of the space, and the distance between its lowest point and the root circle must be least. That distance falls
//! as r_c grows to (r_b² − r_f²)/(2 r_f), where it is zero. So the best radius is that or, where the space is too narrow,
//! r_b tan(π/z − ψ_b), with the centre in the middle of the space. Then the root lies above the root circle, but is still
//! smooth. Source: Zhai, Liang and Fu 2020, section 5. Must not know: other roots.

use std::f64::consts::PI;

use super::base_arc::Base;
use super::{Root, Toe};
use crate::gear::geometry::Gear;
use crate::gear::geometry::error::GeometryError;
use declare::Declared;

/// Arc tangent to the flank on the base circle that comes nearest to the root circle (zhai2020, 27 to 30).
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "optimised_arc")]
pub struct OptimisedArc {}

/// The best radius; positive, since no tooth fills its pitch on the base circle. What rolls a tip land along the root,
/// h_f < π/(4 tan α), and leaves something below the base circle, h_f − x > z (1 − cos α)/2, has ψ_b = π/(2z) + 2x tan α/z
/// + inv α < π/z − (α − sin α), whatever its teeth.
#[must_use]
pub fn radius(base: &Base) -> f64 {
    base.touching_radius().min(base.middle_radius())
}

impl Root for OptimisedArc {
    fn toe(&self, gear: &Gear) -> Result<Toe, GeometryError> {
        let base = Base::new(gear, "the optimised arc")?;
        let circle = base.tangent_circle(radius(&base));
        let lowest = libm::atan2(circle.centre[1], circle.centre[0]) + PI;
        Ok(Toe { segments: base.segments(circle, lowest), form_roll: 0.0 })
    }
}
