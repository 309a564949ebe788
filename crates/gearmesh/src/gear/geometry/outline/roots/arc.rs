//! The article's arc: from the base circle to a point H = r_b − r_f lower on the page (equations 17 to 20).
//!
//! Its lowest point is that far below A in y, not in radius, so it is never tangent to the root circle: it crosses
//! it, ends above it (a step remains), or meets its neighbour in the middle of the space first (a notch remains). As
//! printed, equation 20 has the sign that puts the centre above A; the flank then has a corner of 2θ there. Source: Zhai,
//! Liang and Fu 2020, as in `base_arc.rs`. Must not know: other roots.

use super::base_arc::{Base, Circle, DOWN_THE_PAGE};
use super::{Root, Toe};
use crate::gear::geometry::Gear;
use crate::gear::geometry::error::GeometryError;
use declare::{Declared, Words};

/// Arc from the base circle down by r_b − r_f, as in zhai2020; it need not meet the root circle.
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "arc")]
pub struct Arc {
    /// Which sign equation 20 has.
    #[declared(default = "derived")]
    pub formulas: Formulas,
}

/// Which sign equation 20 has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum Formulas {
    /// the centre at Y_A − r_c sin θ, so that flank and arc share a tangent
    Derived,
    /// the centre at Y_A + r_c sin θ, as equation 20 has it
    Printed,
}

/// The article's circle with either sign in equation 20.
#[must_use]
pub fn circle(base: &Base, formulas: Formulas) -> Circle {
    let circle = base.article_circle();
    let y = match formulas {
        Formulas::Derived => circle.centre[1],
        Formulas::Printed => 2.0 * base.a[1] - circle.centre[1],
    };
    Circle { centre: [circle.centre[0], y], ..circle }
}

impl Root for Arc {
    fn toe(&self, gear: &Gear) -> Result<Toe, GeometryError> {
        let base = Base::new(gear, "the arc of zhai2020")?;
        let circle = circle(&base, self.formulas);
        Ok(Toe { segments: base.segments(circle, DOWN_THE_PAGE), form_roll: 0.0 })
    }
}
