//! What has a closed form where flanks touch on the line of action, from A to E, and beyond it a quick copy.
//!
//! Must not know: modification, load.

use super::path::Path;
use crate::gear::contact::flattening::combined_radius;
use crate::gear::geometry::Side;
use crate::numeric::graded::Graded;

/// Against the path position.
#[derive(Clone, Debug)]
pub(in crate::gear::mesh) struct Closed {
    /// From A to E.
    inside: [f64; 2],
    tangent_length: f64,
    of: Of,
    beyond: Graded,
}

#[derive(Clone, Copy, Debug)]
enum Of {
    /// From the corner of this gear's tip, where its radius of curvature is so much, along its flank \[m\], and 1/2 r_b.
    Distance { side: Side, tip: f64, per_diameter: f64 },
    /// Times the root of the combined radius.
    Root(f64),
}

impl Closed {
    pub(in crate::gear::mesh) fn distance(path: &Path, side: Side) -> Self {
        let (tip, base) = path.flank_end(side);
        let of = Of::Distance { side, tip, per_diameter: 0.5 / base };
        Self::new(path, of, &|s| path.corner_distance(side, s))
    }

    /// Half the width of the contact over the square root of the load per width; `unit` is that of a combined radius of 1 m.
    pub(in crate::gear::mesh) fn half_width(path: &Path, unit: f64) -> Self {
        Self::new(path, Of::Root(unit), &|s| unit * combined_radius(path.radii(s)).sqrt())
    }

    fn new(path: &Path, of: Of, function: &dyn Fn(f64) -> f64) -> Self {
        let beyond = path.fit(0.0, function).unwrap_or_default();
        Self { inside: path.inside(), tangent_length: path.tangent_length(), of, beyond }
    }

    #[inline]
    pub(in crate::gear::mesh) fn is_inside(&self, s: f64) -> bool {
        s >= self.inside[0] && s <= self.inside[1]
    }

    #[inline]
    pub(in crate::gear::mesh) fn value(&self, s: f64) -> f64 {
        if self.is_inside(s) { self.inside(s) } else { self.beyond.value(s) }
    }

    /// From A to E.
    #[inline]
    pub(in crate::gear::mesh) fn inside(&self, s: f64) -> f64 {
        match self.of {
            Of::Distance { side, tip, per_diameter } => {
                let here = if side == Side::Pinion { s } else { self.tangent_length - s };
                (tip - here) * (tip + here) * per_diameter
            }
            Of::Root(unit) => unit * combined_radius([s, self.tangent_length - s]).sqrt(),
        }
    }
}
