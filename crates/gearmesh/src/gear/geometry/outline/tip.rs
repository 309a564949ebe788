//! The tip of a tooth: an arc of the tip circle, with its corner as it is, chamfered or rounded.
//!
//! A chamfer begins on the flank its size below the tip circle and ends on the tip circle its size from the corner. A
//! rounding is an arc tangent to the flank and, from inside, to the tip circle. A semi-topping tool chamfers the tip by a ramp at the
//! root of its teeth, in the angle α_KP: a straight side that generates an involute with the base circle r cos α_KP, which crosses the
//! flank. Must not know: the root.

use std::fmt::Debug;

use super::curve::{Curve, OutlinePart, Segment};
use crate::gear::geometry::Gear;
use crate::gear::geometry::error::shown::beside;
use crate::gear::geometry::error::{Degrees, GeometryError, Millimetres, Parameter, Problem};
use crate::gear::geometry::involute::involute;
use crate::numeric::crossing;
use declare::declared::Registrable;
use declare::units::{ANGLE, LENGTH};
use declare::{Declared, registry};

/// What becomes of the corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tip {
    /// It stays: flank and tip circle meet in it.
    Land,
    /// Its size \[m\].
    Chamfer(f64),
    /// Its radius \[m\].
    Rounding(f64),
    /// What the ramp of a semi-topping tool leaves.
    SemiTopping {
        /// α_KP \[rad\].
        angle: f64,
        /// h_K: how far below the addendum line of the rack the ramp begins \[m\].
        height: f64,
    },
}

impl Tip {
    /// The same on a gear of other size: all lengths times `factor`.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        match self {
            Self::Land => Self::Land,
            Self::Chamfer(size) => Self::Chamfer(size * factor),
            Self::Rounding(radius) => Self::Rounding(radius * factor),
            Self::SemiTopping { angle, height } => Self::SemiTopping { angle, height: height * factor },
        }
    }
}

/// The flank ends in a corner on the tip circle.
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "land")]
pub struct Land {}

/// A straight chamfer, as high as it is wide.
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "chamfer")]
pub struct Chamfer {
    /// How far it begins below the tip circle.
    #[declared(dimension = LENGTH, minimum = 0.0, maximum = 1.0, example = "0.3 mm")]
    pub size: f64,
}

/// An arc tangent to the flank and to the tip circle.
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "rounding")]
pub struct Rounding {
    /// Radius of the arc.
    #[declared(dimension = LENGTH, minimum = 0.0, maximum = 1.0, example = "0.2 mm")]
    pub radius: f64,
}

/// The chamfer that a semi-topping tool generates with its flank.
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "semi_topping")]
pub struct SemiTopping {
    /// Angle α_KP of the tool's ramp; above the pressure angle.
    #[declared(dimension = ANGLE, minimum = 0.08, maximum = 1.4, default = "45 deg")]
    pub angle: f64,
    /// How far below the addendum line of the rack, m h_aP*, the ramp begins.
    #[declared(dimension = LENGTH, minimum = 0.0, maximum = 1.0, example = "0.3 mm")]
    pub height: f64,
}

/// What a study states of a tip.
pub trait Stated: Debug + Registrable {
    /// The tip with its size in SI.
    fn tip(&self) -> Tip;
}

impl Stated for Land {
    fn tip(&self) -> Tip {
        Tip::Land
    }
}

impl Stated for Chamfer {
    fn tip(&self) -> Tip {
        Tip::Chamfer(self.size)
    }
}

impl Stated for Rounding {
    fn tip(&self) -> Tip {
        Tip::Rounding(self.radius)
    }
}

impl Stated for SemiTopping {
    fn tip(&self) -> Tip {
        Tip::SemiTopping { angle: self.angle, height: self.height }
    }
}

registry!(TIPS: Stated = Land, Chamfer, Rounding, SemiTopping);

impl Tip {
    /// How far below the tip circle the flank of a gear with this tip ends \[m\]; the radius of a rounding.
    #[must_use]
    pub fn size(self, gear: &Gear) -> f64 {
        match self {
            Self::Land => 0.0,
            Self::Chamfer(size) | Self::Rounding(size) => size,
            Self::SemiTopping { .. } => gear.tip_radius - gear.radius_at(gear.flank_end.roll),
        }
    }

    /// Where the flank ends, and what lies between it and the tooth's centreline.
    ///
    /// # Errors
    /// When the break is larger than the tooth has room for.
    pub(in crate::gear::geometry) fn segments(
        self,
        gear: &Gear,
        flank: &Curve,
        form_roll: f64,
    ) -> Result<(f64, Vec<Segment>), GeometryError> {
        let top = Top { gear, flank, form_roll };
        let size = match self {
            Self::Land => return top.land(),
            Self::Chamfer(size) | Self::Rounding(size) if size <= 0.0 => return top.land(),
            Self::Chamfer(size) | Self::Rounding(size) => size,
            Self::SemiTopping { angle, height } => {
                top.check_angle(angle)?;
                height
            }
        };
        let cut = |size: f64| match self {
            Self::Rounding(_) => top.rounding(size),
            Self::SemiTopping { angle, .. } => top.ramp(angle, size),
            _ => top.chamfer(size),
        };
        cut(size).ok_or_else(|| {
            // Room shrinks steadily as the break grows.
            let (mut good, mut bad) = (0.0, size);
            for _ in 0..50 {
                let middle = 0.5 * (good + bad);
                *(if cut(middle).is_some() { &mut good } else { &mut bad }) = middle;
            }
            Problem::TipBreakTooLarge { size: Millimetres(size), largest: Millimetres(good) }.into()
        })
    }
}

/// The upper end of a flank.
struct Top<'a> {
    gear: &'a Gear,
    flank: &'a Curve,
    form_roll: f64,
}

fn radius([x, y]: [f64; 2]) -> f64 {
    libm::hypot(x, y)
}

fn half_angle([x, y]: [f64; 2]) -> f64 {
    libm::atan2(x, y)
}

impl Top<'_> {
    /// The roll angle at which the flank reaches a radius.
    fn roll_at(&self, wanted: f64) -> Option<f64> {
        let unmodified = self.gear.roll_at(wanted);
        if let Curve::Modified { relief, .. } = self.flank {
            // What is taken off shifts the place by about its depth over r_b.
            let depth = |roll: f64| relief.depth(roll).abs() / self.gear.base_radius;
            let room = 4.0 * (depth(unmodified) + depth(unmodified + 4.0 * depth(unmodified))) + 1e-9;
            return crossing::bracketed((unmodified - room).max(0.0), unmodified + room, |roll| {
                radius(self.flank.point(roll)) - wanted
            });
        }
        (wanted >= self.gear.base_radius).then_some(unmodified)
    }

    /// The arc of the tip circle from an angle to the centreline.
    fn on_tip(&self, angle: f64) -> Segment {
        Segment::about_centre(OutlinePart::TipLand, self.gear.tip_radius, angle, 0.0)
    }

    fn corner(&self) -> Option<(f64, f64)> {
        let end = self.roll_at(self.gear.tip_radius)?;
        let angle = half_angle(self.flank.point(end));
        (end > self.form_roll && angle > 0.0).then_some((end, angle))
    }

    fn land(&self) -> Result<(f64, Vec<Segment>), GeometryError> {
        let depth = Millimetres(match self.flank {
            Curve::Modified { relief, .. } => relief.depth(self.gear.tip_roll()),
            _ => 0.0,
        });
        let (end, angle) = self.corner().ok_or(Problem::TipTakenOff { depth })?;
        Ok((end, vec![self.on_tip(angle)]))
    }

    fn chamfer(&self, size: f64) -> Option<(f64, Vec<Segment>)> {
        let tip = self.gear.tip_radius;
        let end = self.roll_at(tip - size)?;
        let angle = self.corner()?.1 - size / tip;
        if end < self.form_roll || angle < 0.0 {
            return None;
        }
        let land = self.on_tip(angle);
        Some((end, vec![Segment::straight(OutlinePart::TipBreak, self.flank.point(end), land.start()), land]))
    }

    fn check_angle(&self, angle: f64) -> Result<(), GeometryError> {
        let [angle, flat] = [angle, self.gear.specification.pressure_angle].map(Degrees);
        if angle.0 <= flat.0 {
            return Err(Problem::OutOfRange {
                parameter: Parameter::TipAngle,
                found: beside(&angle, &flat),
                range: format!("above the pressure angle, {}", beside(&flat, &angle)),
            }
            .into());
        }
        Ok(())
    }

    /// What a ramp leaves that begins a height below the addendum line; the whole land where that is beyond the tip.
    fn ramp(&self, angle: f64, height: f64) -> Option<(f64, Vec<Segment>)> {
        let specification = &self.gear.specification;
        let (tip, reference) = (self.gear.tip_radius, self.gear.reference_radius);
        // Where it begins above the rack's pitch line, and half the thickness that it leaves on that line.
        let begin =
            specification.module * (specification.rack.addendum + specification.generating_profile_shift()) - height;
        let slopes = libm::tan(angle) - libm::tan(specification.pressure_angle);
        let half = reference * self.gear.half_angle(reference) + begin * slopes;
        let (base_radius, half_base_angle) = (reference * libm::cos(angle), half / reference + involute(angle));
        let roll_at = |radius: f64| ((radius - base_radius) * (radius + base_radius)).max(0.0).sqrt() / base_radius;
        let angle_at = |roll: f64| half_base_angle - (roll - libm::atan(roll));
        let excess = |roll: f64| {
            let point = self.flank.point(roll);
            angle_at(roll_at(radius(point))) - half_angle(point)
        };
        let (last, corner) = self.corner()?;
        if excess(last) >= 0.0 {
            return Some((last, vec![self.on_tip(corner)]));
        }
        let end = crossing::bracketed(self.form_roll, last, excess)?;
        let (from, to) = (roll_at(radius(self.flank.point(end))), roll_at(tip));
        let land = angle_at(to);
        let curve = Curve::Involute { base_radius, half_base_angle };
        (land >= 0.0).then(|| (end, vec![Segment { part: OutlinePart::TipBreak, curve, from, to }, self.on_tip(land)]))
    }

    fn rounding(&self, round: f64) -> Option<(f64, Vec<Segment>)> {
        let tip = self.gear.tip_radius;
        let centre = |roll: f64| {
            let local = self.flank.local(roll);
            // The material lies to the left of the way up.
            [local.position[0] - round * local.tangent[1], local.position[1] + round * local.tangent[0]]
        };
        let distance = |roll: f64| radius(centre(roll)) - (tip - round);
        let last = self.corner()?.0;
        let end = crossing::bracketed(self.form_roll, last, distance)?;
        let [x, y] = centre(end);
        if x < 0.0 {
            return None;
        }
        let [from_x, from_y] = self.flank.point(end);
        let from = libm::atan2(from_y - y, from_x - x);
        let to = libm::atan2(y, x);
        let arc =
            Segment { part: OutlinePart::TipBreak, curve: Curve::Arc { centre: [x, y], radius: round }, from, to };
        Some((end, vec![arc, self.on_tip(half_angle([x, y]))]))
    }
}
