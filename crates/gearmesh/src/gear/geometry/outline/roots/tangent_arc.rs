//! An arc tangent to the root circle and to the flank: of the radius that makes it begin on the base circle, of a given
//! radius, or of the largest that two neighbours leave room for.
//!
//! Below the base circle the flank is the radial line at ψ_b. From the base circle, r_c = (r_b² − r_f²)/(2 r_f). Must not
//! know: other roots.

use super::base_arc::Base;
use super::{Root, Toe};
use crate::gear::geometry::Gear;
use crate::gear::geometry::error::GeometryError;
use declare::units::LENGTH;
use declare::{Declared, Words};

/// Arc tangent to the root circle and to the flank (or the radial line below the base circle).
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "tangent_arc")]
pub struct TangentArc {
    /// How large the arc is, where no radius is given.
    #[declared(default = "base_circle")]
    pub size: Size,
    /// Radius of the arc.
    #[declared(minimum = 0.0, maximum = 100.0, dimension = LENGTH, example = "0.9 mm")]
    pub radius: Option<f64>,
}

/// How large an arc is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum Size {
    /// the arc begins on the base circle
    BaseCircle,
    /// neighbouring arcs meet in the middle of the space
    Largest,
}

impl Root for TangentArc {
    fn toe(&self, gear: &Gear) -> Result<Toe, GeometryError> {
        let radius = match (self.radius, self.size) {
            (Some(radius), _) => radius,
            (None, Size::Largest) => gear.largest_fillet(),
            (None, Size::BaseCircle) => Base::new(gear, "a tangent arc from the base circle")?.touching_radius(),
        };
        Ok(Toe::of(&gear.fillet(radius)?))
    }
}
