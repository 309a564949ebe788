//! The profiles of a design as one section across the face sees them.
//!
//! A sum of a profile and a lead has one profile all over the face; what varies over the surface has another one in each
//! section. Must not know: any single family, load.

use super::{Design, Modification, NamedModification};
use crate::gear::geometry::Side;
use crate::numeric::quadratic::Quadratic;

/// A modification in one section.
#[derive(Clone, Copy, Debug)]
pub struct Section<'a> {
    modification: &'a dyn Modification,
    /// Where the section is \[m\], if that matters.
    z: Option<f64>,
}

/// Those of the pinion and of the gear.
pub type Profiles<'a> = [Vec<Section<'a>>; 2];

impl<'a> Section<'a> {
    fn new(modification: &'a dyn Modification, z: f64) -> Self {
        Self { modification, z: modification.varies_over_surface().then_some(z) }
    }

    /// Depth at a roll angle, what the lead takes off not among it \[m\].
    #[must_use]
    #[inline]
    pub fn depth(&self, roll: f64) -> f64 {
        let depth = self.modification.depth(roll);
        self.z.map_or(depth, |z| depth + self.modification.surface(roll, z))
    }

    /// The quadratic in the roll angle that it is between the breaks on either side of one, if it is known to be one there.
    #[must_use]
    pub fn quadratic(&self, roll: f64) -> Option<Quadratic> {
        if self.z.is_some() { None } else { self.modification.profile_quadratic(roll) }
    }

    /// The depth at a roll angle and its first and second derivative, on the smooth stretch that `inside` lies on, if they are
    /// known.
    #[must_use]
    pub fn rates(&self, roll: f64, inside: f64) -> Option<[f64; 3]> {
        if let Some(z) = self.z {
            let of_profile = if self.modification.varies_along_profile() {
                self.modification.profile_rates(roll, inside)?
            } else {
                [0.0; 3]
            };
            let of_surface = self.modification.surface_rates(roll, z)?;
            return Some([0, 1, 2].map(|order| of_profile[order] + of_surface[order]));
        }
        let quadratic = self.modification.profile_quadratic(inside).map(|quadratic| quadratic.rates(roll));
        quadratic.or_else(|| self.modification.profile_rates(roll, inside))
    }

    /// Roll angles between which that is a cubic of its own, of what is a spline through many points.
    #[must_use]
    pub fn knots(&self) -> &'a [f64] {
        self.modification.profile_knots()
    }

    /// Roll angles at which that is not smooth.
    #[must_use]
    pub fn breaks(&self) -> &'a [f64] {
        self.modification.profile_breaks()
    }
}

impl Design {
    /// What varies along the profile of either gear, in the section at z \[m\].
    #[must_use]
    pub fn profiles(&self, z: f64) -> Profiles<'_> {
        let varies = |part: &&NamedModification| {
            part.modification.varies_along_profile() || part.modification.varies_over_surface()
        };
        [Side::Pinion, Side::Gear].map(|side| {
            let parts = self.side(side).iter().filter(varies);
            parts.map(|part| Section::new(&*part.modification, z)).collect()
        })
    }

    /// Whether anything is not a sum of a profile and a lead.
    #[must_use]
    pub fn varies_over_surface(&self) -> bool {
        self.pinion.iter().chain(&self.gear).any(|part| part.modification.varies_over_surface())
    }
}
