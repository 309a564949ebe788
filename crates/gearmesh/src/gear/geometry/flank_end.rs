//! Where the flank of a gear ends towards the tip: in a corner on the tip circle, in one at a chamfer, or where it goes over
//! into a rounding.
//!
//! Lengths in m, angles in rad. The circle through the end is the tip form circle d_Fa of ISO 21771-1:2024, up to which the
//! mate can use the flank. Must not know: the mate, the root.

use std::f64::consts::{FRAC_PI_2, PI};

use super::Gear;
use super::error::GeometryError;
use super::outline::curve::{Curve, OutlinePart};
use super::outline::tip::Tip;

/// The end of a flank.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlankEnd {
    /// Its roll angle.
    pub roll: f64,
    /// Between the flank and what follows it, inside the tooth: π where the flank goes over into a rounding.
    pub interior_angle: f64,
    /// Radius of the arc that follows; 0 where the flank ends in a corner.
    pub radius: f64,
}

impl Gear {
    /// The corner in which the flank ends, or, before a rounding, the one that it takes away.
    #[must_use]
    pub fn last_corner(&self) -> FlankEnd {
        if self.flank_end.radius > 0.0 { FlankEnd::corner(self.tip_roll()) } else { self.flank_end }
    }
}

impl FlankEnd {
    /// The corner with the tip circle, which the flank meets at 90° + α_a, tan α_a its roll angle.
    #[must_use]
    pub fn corner(roll: f64) -> Self {
        Self { roll, interior_angle: FRAC_PI_2 + libm::atan(roll), radius: 0.0 }
    }

    /// That of a gear with this tip.
    pub(super) fn of(gear: &Gear, tip: Tip) -> Result<Self, GeometryError> {
        let Gear { base_radius, half_base_angle, form_roll, .. } = *gear;
        let flank = Curve::Involute { base_radius, half_base_angle };
        let (roll, top) = tip.segments(gear, &flank, form_roll)?;
        let corner = Self::corner(roll);
        let Some(next) = top.first().filter(|segment| segment.part == OutlinePart::TipBreak) else { return Ok(corner) };
        if let Tip::Rounding(radius) = tip {
            return Ok(Self { roll, interior_angle: PI, radius });
        }
        let ([p, q], [x, y]) = (flank.local(roll).tangent, next.curve.local(next.from).tangent);
        Ok(Self { roll, interior_angle: PI - libm::atan2(p * y - q * x, p * x + q * y), radius: 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gear::fixtures::standard;
    use crate::gear::geometry::{GearPair, Side};

    fn gear(tip: Tip) -> Gear {
        Gear::new(&standard(24, 3e-3, 2.0)).unwrap().with_tip(tip).unwrap()
    }

    /// Tier: closed form; the circle about the arc's centre touches flank and tip circle: with its radius r and the flank's
    /// radius of curvature ρ there, (ρ − r)² + r_b² = (r_a − r)².
    #[test]
    fn a_rounding_touches_flank_and_tip_circle() {
        for radius in [1e-6, 0.1e-3, 0.4e-3] {
            let gear = gear(Tip::Rounding(radius));
            let centre = (gear.tip_radius - radius - gear.base_radius) * (gear.tip_radius - radius + gear.base_radius);
            let curvature = radius + centre.sqrt();
            assert!((gear.flank_end.roll * gear.base_radius / curvature - 1.0).abs() < 1e-12, "{radius}");
            assert_eq!((gear.flank_end.radius, gear.flank_end.interior_angle), (radius, PI));
        }
    }

    /// Tier: closed form; the chamfer begins its size below the tip circle; a triangle with both ends of the chamfer by the
    /// polar angles of the involute has the same angle.
    #[test]
    fn a_chamfer_begins_below_the_tip_circle() {
        for size in [1e-6, 0.1e-3, 0.4e-3] {
            let gear = gear(Tip::Chamfer(size));
            let end = gear.radius_at(gear.flank_end.roll);
            assert!((end - (gear.tip_radius - size)).abs() < 1e-15, "{size}");
            let ([s, c], turned) = ([end, gear.tip_radius], gear.half_angle(end) - gear.half_angle(gear.tip_radius));
            let angle = turned + size / gear.tip_radius;
            // Against the radius through the flank's end, the flank leans by α and the chamfer by this.
            let leaning = (c * angle.sin()).atan2(c * angle.cos() - s);
            let interior = PI - (leaning - gear.flank_end.roll.atan());
            assert!((gear.flank_end.interior_angle - interior).abs() < 1e-9, "{size}");
        }
    }

    /// Tier: invariant; a break of no size is none, and the land meets the flank at 90° + α_a.
    #[test]
    fn a_break_of_no_size_is_a_corner() {
        let plain = gear(Tip::Land);
        for tip in [Tip::Chamfer(0.0), Tip::Rounding(0.0)] {
            assert_eq!(gear(tip).flank_end, plain.flank_end);
        }
        assert_eq!(plain.flank_end.roll.to_bits(), plain.tip_roll().to_bits());
        let small = gear(Tip::Chamfer(1e-9)).flank_end;
        assert!((small.roll - plain.flank_end.roll).abs() < 1e-6);
        assert!(small.interior_angle > plain.flank_end.interior_angle);
    }

    /// Tier: closed form; the path of contact ends where both tip form circles cut the line of action (ISO 21771-1:2024, 8).
    #[test]
    fn contact_ends_at_the_tip_form_circles() {
        let specifications = [standard(19, 3e-3, 2.0), standard(48, 3e-3, 2.0)];
        let sharp = GearPair::new(specifications[0], specifications[1], None).unwrap();
        let pair = GearPair::with_tips(specifications, [Tip::Chamfer(0.2e-3), Tip::Rounding(0.3e-3)], None).unwrap();
        let along = |side: Side| {
            let gear = pair.side(side);
            let form = gear.radius_at(gear.flank_end.roll);
            (form * form - gear.base_radius * gear.base_radius).sqrt()
        };
        let ratio = (along(Side::Pinion) + along(Side::Gear) - sharp.tangent_length) / sharp.base_pitch;
        assert!((pair.contact_ratio - ratio).abs() < 1e-12);
        assert!(pair.contact_ratio < sharp.contact_ratio - 0.03, "{} {}", pair.contact_ratio, sharp.contact_ratio);
        let refused = GearPair::with_tips(specifications, [Tip::Chamfer(1.5e-3); 2], None).unwrap_err();
        assert!(refused.to_string().contains("tip"), "{refused}");
    }
}
