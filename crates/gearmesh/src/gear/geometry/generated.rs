//! What the tool leaves of a tooth below the flank: the root curve of its tip round, and what lies between that and the
//! involute of the finished tooth.
//!
//! - Of a pinion-type cutter it is the root curve as well, up to the involute or across it.
//! - Without protuberance and stock, nothing: the curve goes over into the involute or, where the rack undercuts, crosses it.
//! - A protuberance that reaches s_pr beyond the finished flank cuts into it. The curve crosses the involute itself or, before
//!   that, the involute of the protuberance's straight side, which has the base circle r cos α_prP.
//! - Where more stock is left than the protuberance takes away, grinding ends where the round of the tip faces the flank, by
//!   an arc of the radius ρ_g, tangent to the flank, up to the root curve: the notch, as deep as stock is left there.
//!
//! Lengths in m, angles in rad. Source: ISO 6336-3:2019, figures of the basic rack with protuberance and of the grinding notch,
//! for what they are called; the curves are envelopes (see `trochoid.rs`). Must not know: stiffness.

use std::f64::consts::FRAC_PI_2;

use super::error::{GeometryError, Millimetres, Plain, Problem};
use super::pinion_cutter::PinionCutter;
use super::root_piece::Piece;
use super::trochoid::Trochoid;
use super::{Gear, Specification};
use crate::numeric::crossing;

/// s_pr \[modules\] below which there is none.
const NOTHING: f64 = 1e-9;
/// How far out, in radii, the sides of a protuberance are looked for.
const FARTHEST: f64 = 4.0;
/// Notches are searched up to this radius \[modules\].
const LARGEST_NOTCH: f64 = 2.0;

/// A generated root, below the flank.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Generated {
    /// The root curve, from the root circle up.
    pub trochoid: Trochoid,
    /// What lies between it and the involute, if anything.
    pub beyond: Option<Piece>,
    /// Where the involute begins.
    pub joint: Joint,
    /// t_g: how deep grinding leaves a notch; 0 without one.
    pub notch_depth: f64,
}

/// Where the involute begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// The form radius.
    pub radius: f64,
    /// Roll angle of the involute there.
    pub roll: f64,
    /// Whether the root crosses the involute instead of being tangent to it.
    pub undercut: bool,
}

impl Gear {
    /// What its tool leaves below the flank.
    ///
    /// # Errors
    /// When the notch has no room. A gear that could be made has it.
    pub fn generated(&self) -> Result<Generated, GeometryError> {
        Generated::new(&self.specification, self.base_radius, self.half_base_angle)
    }

    /// The root curve this gear's tool generates.
    #[must_use]
    pub fn trochoid(&self) -> Trochoid {
        self.generated().map_or_else(|_| Trochoid::of(&self.specification), |generated| generated.trochoid)
    }
}

impl Generated {
    /// Of a gear whose tool and circles have been checked.
    ///
    /// # Errors
    /// When the notch has no room.
    pub(super) fn new(
        specification: &Specification,
        base_radius: f64,
        half_base_angle: f64,
    ) -> Result<Self, GeometryError> {
        if let Some(cutter) = &specification.cutter {
            return Self::shaped(specification, cutter, base_radius, half_base_angle);
        }
        let making = Making { specification, base_radius, half_base_angle, curve: Trochoid::of(specification) };
        let beyond = specification.rack.residual_undercut();
        if beyond > NOTHING {
            return Ok(making.protuberance(beyond));
        }
        if beyond < -NOTHING {
            return making.stock(beyond);
        }
        Ok(making.plain())
    }
}

impl Generated {
    /// What a cutter leaves.
    fn shaped(
        specification: &Specification,
        cutter: &PinionCutter,
        base_radius: f64,
        half_base_angle: f64,
    ) -> Result<Self, GeometryError> {
        let shaping = cutter.shaping(specification)?;
        let curve = Trochoid::shaped(&shaping, specification.teeth, cutter);
        let roll = shaping.rolls(base_radius)[0];
        let of = |trochoid, roll: f64, undercut| {
            let joint = Joint { radius: base_radius * (1.0 + roll * roll).sqrt(), roll, undercut };
            Self { trochoid, beyond: None, joint, notch_depth: 0.0 }
        };
        if roll >= 0.0 {
            return Ok(of(curve, roll, false));
        }
        let at = |q: f64| {
            let [x, y] = curve.point_at(q);
            (libm::hypot(x, y), libm::atan2(x, y))
        };
        let upper = curve.joint_parameter();
        let lowest = crossing::bracketed(0.0, upper, |q| at(q).0 - base_radius).unwrap_or(upper);
        let excess = |q: f64| {
            let (radius, angle) = at(q);
            let roll = roll_at(base_radius, radius);
            angle - half_base_angle + (roll - libm::atan(roll))
        };
        // No sign change only where both differ by rounding, at the very threshold of undercut.
        let q = crossing::bracketed(lowest, upper, excess).unwrap_or(lowest);
        Ok(of(curve.up_to_parameter(q), roll_at(base_radius, at(q).0), true))
    }
}

/// A gear on the way.
struct Making<'a> {
    specification: &'a Specification,
    base_radius: f64,
    half_base_angle: f64,
    curve: Trochoid,
}

impl Making<'_> {
    fn joint(&self, roll: f64, undercut: bool) -> Joint {
        Joint { radius: self.base_radius * (1.0 + roll * roll).sqrt(), roll, undercut }
    }

    fn plain(&self) -> Generated {
        let angle = self.specification.pressure_angle;
        let against = self.curve.against(angle);
        let joint = if against.end >= 0.0 {
            Joint {
                radius: (self.base_radius * self.base_radius + against.end * against.end).sqrt(),
                roll: against.end / self.base_radius,
                undercut: false,
            }
        } else {
            let eta = against.joint();
            return self.crossed(angle + eta, against.roll(eta));
        };
        Generated { trochoid: self.curve, beyond: None, joint, notch_depth: 0.0 }
    }

    /// The curve up to where it crosses the involute.
    fn crossed(&self, normal_angle: f64, roll: f64) -> Generated {
        Generated {
            trochoid: self.curve.up_to(normal_angle),
            beyond: None,
            joint: self.joint(roll, true),
            notch_depth: 0.0,
        }
    }

    /// The tool's round reaches beyond the finished flank by `beyond` \[modules\].
    fn protuberance(&self, beyond: f64) -> Generated {
        let angle = self.specification.pressure_angle;
        let inward = beyond * self.specification.module / self.base_radius;
        let (main, side_angle) = (self.curve.against(angle), self.specification.rack.protuberance_angle);
        // Of the finished flank, which is thicker than the one that the round is tangent to.
        let excess = |eta: f64| main.excess(eta) - inward;
        let lowest = if main.end >= 0.0 { 0.0 } else { main.base() };
        let direct = crossing::bracketed(side_angle - angle, lowest, excess).map(|eta| angle + eta);
        let side = self.curve.against(side_angle);
        let on_side = side_angle + side.joint();
        if let Some(normal_angle) = direct.filter(|found| *found >= on_side) {
            return self.crossed(normal_angle, main.roll(normal_angle - angle));
        }
        let from = side.roll(on_side - side_angle);
        let half_base_angle = self.curve.half_base_angle_of(side_angle);
        // Both involutes at a radius: how much thicker the side leaves the tooth.
        let thicker = |radius: f64| {
            let half_angle = |base: f64, half_base_angle: f64| {
                let roll = roll_at(base, radius);
                half_base_angle - (roll - libm::atan(roll))
            };
            half_angle(side.base_radius, half_base_angle) - half_angle(self.base_radius, self.half_base_angle)
        };
        let lower = side.base_radius * (1.0 + from * from).sqrt();
        let found = crossing::bracketed(lower, FARTHEST * lower, thicker);
        let Some(radius) = found else {
            // Beyond any tip circle.
            return Generated {
                trochoid: self.curve.up_to(on_side),
                beyond: None,
                joint: self.joint(f64::INFINITY, true),
                notch_depth: 0.0,
            };
        };
        let to = roll_at(side.base_radius, radius);
        Generated {
            trochoid: self.curve.up_to(on_side),
            beyond: Some(Piece::Involute { base_radius: side.base_radius, half_base_angle, from, to }),
            joint: Joint { radius, roll: roll_at(self.base_radius, radius), undercut: true },
            notch_depth: 0.0,
        }
    }

    /// The tool's round stays short of the finished flank by −`beyond` \[modules\].
    fn stock(&self, beyond: f64) -> Result<Generated, GeometryError> {
        let Specification { pressure_angle: angle, module, rack, .. } = *self.specification;
        let inward = beyond * module / self.base_radius;
        let main = self.curve.against(angle);
        let undercuts = main.end < 0.0;
        let top = if undercuts { main.base() } else { 0.0 };
        let excess = |eta: f64| main.excess(eta) - inward;
        if undercuts && let Some(eta) = crossing::bracketed(0.0, top, excess) {
            return Ok(self.crossed(angle + eta, main.roll(eta)));
        }
        // On the normal on which the round faces the tool's own flank, as far as the finished one has it.
        let roll = (main.end / self.base_radius + inward).max(0.0);
        let highest = self.curve.up_to(angle + top).joint_parameter();
        // The flank, its outward normal, and the place of the root curve that faces it.
        let (sine, cosine) = libm::sincos(roll - self.half_base_angle);
        let at = |along: f64| {
            let out = self.base_radius * roll + along;
            [out * cosine - self.base_radius * sine, self.base_radius * cosine + out * sine]
        };
        let distance = |[x, y]: [f64; 2], q: f64| {
            let [p, o] = self.curve.point_at(q);
            libm::hypot(p - x, o - y)
        };
        let notch_depth = distance(at(0.0), highest);
        let meeting = |radius: f64| {
            let centre = at(radius);
            let outside = |q: f64| distance(centre, q) - radius;
            (radius > notch_depth && outside(0.0) > 0.0)
                .then(|| crossing::bracketed(0.0, highest, outside))
                .flatten()
                .map(|q| (q, centre))
        };
        let radius = rack.notch_radius * module;
        let Some((q, [x, y])) = meeting(radius) else {
            let smallest = notch_depth / module;
            let (mut good, mut bad) = (smallest * (1.0 + 1e-9), LARGEST_NOTCH);
            for _ in 0..50 {
                let middle = 0.5 * (good + bad);
                *(if meeting(middle * module).is_some() { &mut good } else { &mut bad }) = middle;
            }
            let [radius, smallest, largest] = [rack.notch_radius, smallest, good].map(Plain);
            return Err(Problem::NotchRadius { radius, depth: Millimetres(notch_depth), smallest, largest }.into());
        };
        let (centre_radius, centre_angle) = (libm::hypot(x, y), libm::atan2(x, y));
        let [p, o] = self.curve.point_at(q);
        let start = libm::atan2(x - p, y - o) - centre_angle;
        let extent = FRAC_PI_2 - (roll - self.half_base_angle) - centre_angle;
        Ok(Generated {
            trochoid: self.curve.up_to_parameter(q),
            beyond: Some(Piece::Arc { centre_radius, centre_angle, radius, start, extent }),
            joint: self.joint(roll, false),
            notch_depth,
        })
    }
}

/// u of an involute at a radius.
fn roll_at(base_radius: f64, radius: f64) -> f64 {
    ((radius - base_radius) * (radius + base_radius)).max(0.0).sqrt() / base_radius
}
