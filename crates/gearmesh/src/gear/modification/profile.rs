//! What all modifications of a gear take off its flanks in the middle of the face, as the outline of a tooth needs it.
//!
//! Must not know: any single family, how an outline is made.

use std::sync::Arc;

use super::{Design, NamedModification};
use crate::gear::geometry::Side;
use crate::gear::geometry::outline::curve::Relief;

/// The modifications of one gear that vary along its profile in the middle of the face.
#[derive(Debug)]
struct Profile(Vec<NamedModification>);

impl Relief for Profile {
    fn depth(&self, roll: f64) -> f64 {
        self.0.iter().map(|part| part.modification.depth(roll) + part.modification.surface(roll, 0.0)).sum()
    }

    fn breaks(&self) -> Vec<f64> {
        let mut places: Vec<f64> = self.0.iter().flat_map(|part| part.modification.profile_breaks()).copied().collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        places
    }
}

impl Design {
    /// The sum of what is taken off a gear's flanks in the middle of the face beside its leads, if anything is.
    #[must_use]
    pub fn relief(&self, side: Side) -> Option<Arc<dyn Relief>> {
        let varies = |part: &&NamedModification| {
            part.modification.varies_along_profile() || part.modification.varies_over_surface()
        };
        let parts: Vec<NamedModification> = self.side(side).iter().filter(varies).cloned().collect();
        (!parts.is_empty()).then(|| -> Arc<dyn Relief> { Arc::new(Profile(parts)) })
    }
}
