//! What has a closed form where flanks touch on the line of action, from A to E, and beyond it a quick copy.
//!
//! Must not know: modification, load.

use super::path::Path;
use crate::gear::contact::flattening::combined_radius;
use crate::gear::geometry::Side;
use crate::numeric::graded::Graded;

/// Against the path position.
#[derive(Clone, Debug)]
pub(super) struct Closed {
    path: Path,
    of: Of,
    beyond: Graded,
}

#[derive(Clone, Copy, Debug)]
enum Of {
    /// From the corner of this gear's tip along its flank \[m\].
    Distance(Side),
    /// Times the root of the combined radius.
    Root(f64),
}

impl Closed {
    pub(super) fn distance(path: &Path, side: Side) -> Self {
        Self::new(path, Of::Distance(side))
    }

    /// Half the width of the contact over the square root of the load per width; `unit` is that of a combined radius of 1 m.
    pub(super) fn half_width(path: &Path, unit: f64) -> Self {
        Self::new(path, Of::Root(unit))
    }

    fn new(path: &Path, of: Of) -> Self {
        Self { path: path.clone(), of, beyond: path.fit(0.0, &|s| of.on(path, s)).unwrap_or_default() }
    }

    #[inline]
    pub(super) fn value(&self, s: f64) -> f64 {
        if self.path.is_inside(s) { self.of.on(&self.path, s) } else { self.beyond.value(s) }
    }
}

impl Of {
    fn on(self, path: &Path, s: f64) -> f64 {
        match self {
            Self::Distance(side) => path.corner_distance(side, s),
            Self::Root(unit) => unit * combined_radius(path.radii(s)).sqrt(),
        }
    }
}
