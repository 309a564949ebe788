//! The shapes a tooth's root may be given, as sections from the clamped end up to the involute.
//!
//! - `Trochoid`: what the tool leaves; clamped where it touches the root circle.
//! - `CircularFillet`: an arc of the rack's tip radius ρ_fP, tangent to the root circle and to the flank, the flank
//!   being the involute and, below the base circle, the radial line at ψ_b; clamped at the root circle.
//! - `BaseCircle`: no root at all; the involute is clamped at the base circle, or at the root circle where that is larger
//!   (from 42 teeth on with a dedendum of 1.25), since a tooth clamped inside its own body would be integrated through it.
//!
//! Must not know: stiffness, load.

use std::f64::consts::{FRAC_PI_2, PI};

use super::Gear;
use super::error::{GeometryError, Millimetres, Problem};
use super::generated::Generated;
use super::involute::Section;
use super::root_piece::Piece;
use crate::numeric::crossing;
use declare::Words;

/// How a tooth ends at its root.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum RootShape {
    /// the root curve that the rack generates
    Trochoid,
    /// an arc of the rack's tip radius between flank and root circle
    CircularFillet,
    /// no root: the involute clamped at the base circle (or root circle, if larger)
    BaseCircle,
}

/// A tooth's root of a certain shape.
#[derive(Clone, Debug, PartialEq)]
pub struct Root {
    /// θ_f: half the tooth's angle at the clamped end.
    pub half_angle: f64,
    /// Roll angle at which the involute begins.
    pub form_roll: f64,
    /// Each begins where the one before ends; none where the involute itself is clamped.
    pub pieces: Vec<Piece>,
}

impl Root {
    /// The clamped end of a tooth of this gear: where the root curve touches the root circle or, without one, where the
    /// involute begins.
    #[must_use]
    pub fn clamped_end(&self, gear: &Gear) -> Section {
        let lowest = self.pieces.first().map(|piece| piece.section(piece.range().0));
        lowest.unwrap_or_else(|| gear.flank(self.form_roll))
    }
}

impl Gear {
    /// The root of this gear's teeth in a certain shape.
    ///
    /// # Errors
    /// When circular fillets of neighbouring teeth would overlap; a generated root of a gear that could be made exists.
    pub fn root(&self, shape: RootShape) -> Result<Root, GeometryError> {
        match shape {
            RootShape::Trochoid => {
                let Generated { trochoid, beyond, joint, .. } = self.generated()?;
                Ok(Root {
                    half_angle: trochoid.root_half_angle(),
                    form_roll: joint.roll,
                    pieces: std::iter::once(Piece::Trochoid(trochoid)).chain(beyond).collect(),
                })
            }
            RootShape::CircularFillet => self.circular_fillet(),
            RootShape::BaseCircle => {
                let form_roll = self.roll_at(self.root_radius.max(self.base_radius));
                Ok(Root { half_angle: self.half_angle_at_roll(form_roll), form_roll, pieces: Vec::new() })
            }
        }
    }

    fn circular_fillet(&self) -> Result<Root, GeometryError> {
        let radius = self.specification.tool_tip_radius() * self.specification.module;
        let root = self.unbounded_fillet(radius);
        let overlap = self.overlap(&root);
        if overlap > 1e-9 * self.root_radius {
            return Err(Problem::FilletDoesNotFit { radius: Millimetres(radius), overlap: Millimetres(overlap) }.into());
        }
        Ok(root)
    }

    /// A root whose arc has this radius \[m\], tangent to the root circle and to the flank.
    ///
    /// # Errors
    /// When the arcs of neighbouring teeth would overlap; the message names the largest radius.
    pub fn fillet(&self, radius: f64) -> Result<Root, GeometryError> {
        let root = self.unbounded_fillet(radius);
        let overlap = self.overlap(&root);
        if overlap > 1e-9 * self.root_radius {
            let [radius, overlap, largest] = [radius, overlap, self.largest_fillet()].map(Millimetres);
            return Err(Problem::RootArcTooLarge { radius, overlap, largest }.into());
        }
        Ok(root)
    }

    /// The radius \[m\] with which the arcs of neighbouring teeth meet in the middle of the space.
    #[must_use]
    pub fn largest_fillet(&self) -> f64 {
        let excess = |radius: f64| self.overlap(&self.unbounded_fillet(radius));
        // The space on the tip circle is wider than the arc can be.
        crossing::bracketed(0.0, 2.0 * PI * self.tip_radius / f64::from(self.specification.teeth), excess)
            .unwrap_or(0.0)
    }

    /// How far the arcs of neighbouring teeth overlap on the root circle \[m\]; negative where some land remains.
    fn overlap(&self, root: &Root) -> f64 {
        2.0 * self.root_radius * (root.half_angle - PI / f64::from(self.specification.teeth))
    }

    fn unbounded_fillet(&self, radius: f64) -> Root {
        let centre_radius = self.root_radius + radius;
        // A circle tangent to an involute has its centre on the flank's normal, which is tangent to the base circle.
        let along = ((centre_radius - self.base_radius) * (centre_radius + self.base_radius)).max(0.0).sqrt();
        let on_involute = along >= radius && centre_radius > self.base_radius;
        let mut pieces = Vec::new();
        let (form_roll, centre_angle) = if on_involute {
            let roll = (along - radius) / self.base_radius;
            (roll, self.half_base_angle - roll + libm::atan(along / self.base_radius))
        } else {
            (0.0, self.half_base_angle + libm::asin(radius / centre_radius))
        };
        let extent = FRAC_PI_2 + self.half_base_angle - form_roll - centre_angle;
        if radius > 0.0 {
            pieces.push(Piece::Arc { centre_radius, centre_angle, radius, start: 0.0, extent });
        }
        if !on_involute {
            let lower = ((centre_radius - radius) * (centre_radius + radius)).sqrt();
            pieces.push(Piece::Radial { angle: self.half_base_angle, lower, upper: self.base_radius });
        }
        Root { half_angle: centre_angle, form_roll, pieces }
    }
}
