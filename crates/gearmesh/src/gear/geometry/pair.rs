//! Two gears on their centre distance, or why they cannot run together.
//!
//! Without a given centre distance the flanks touch on both sides (no backlash):
//! inv α_w = inv α + 2 tan α (x1 + x2)/(z1 + z2). Source: ISO 21771-1:2024, section 8.
//! Must not know: stiffness, load.

use super::error::{GeometryError, Millimetres, Parameter, Plain, Problem, Reached};
use super::involute::{inverse_involute, involute};
use super::outline::tip::Tip;
use super::validity::root_distance;
use super::{Gear, GearPair, Side, Specification};

/// The named points of the path of contact, as path positions s \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ZonePoints {
    /// A, start of contact.
    pub a: f64,
    /// B, one base pitch before E: with 1 < ε_α < 2 the start of single contact.
    pub b: f64,
    /// C, the pitch point.
    pub c: f64,
    /// D, one base pitch after A: with 1 < ε_α < 2 the end of single contact.
    pub d: f64,
    /// E, end of contact.
    pub e: f64,
}

/// How deep a tip may be in the mate's root \[modules\]: how well the distance between curves is known.
const PENETRATION: f64 = 1e-9;
/// How much nearer the gears may be than without backlash \[modules\]: room for a rounded centre distance.
const OVERLAP: f64 = 1e-3;

impl GearPair {
    /// # Errors
    /// When a gear is impossible, the gears do not belong together, the teeth do not fit into each other, contact would
    /// lie below a form radius, or the contact ratio is not above 1.
    pub fn new(
        pinion: Specification,
        gear: Specification,
        centre_distance: Option<f64>,
    ) -> Result<Self, GeometryError> {
        Self::with_tips([pinion, gear], [Tip::Land; 2], centre_distance)
    }

    /// Pinion and gear, each with its tip: contact ends where the flanks do.
    ///
    /// # Errors
    /// As [`GearPair::new`], and when a tooth has no room for its tip.
    pub fn with_tips(
        [pinion, gear]: [Specification; 2],
        tips: [Tip; 2],
        centre_distance: Option<f64>,
    ) -> Result<Self, GeometryError> {
        let made = |specification: &Specification, tip: Tip, side: Side| {
            Gear::new(specification).and_then(|gear| gear.with_tip(tip)).map_err(|error| error.on(side))
        };
        let (pinion, gear) = (made(&pinion, tips[0], Side::Pinion)?, made(&gear, tips[1], Side::Gear)?);
        check_same_rack(&pinion, &gear)?;
        let base_sum = pinion.base_radius + gear.base_radius;
        let without_backlash = |shift: fn(&Specification) -> f64| -> Result<f64, GeometryError> {
            Ok(base_sum / libm::cos(angle_without_backlash(&pinion, &gear, shift)?))
        };
        let nominal = without_backlash(|specification| specification.profile_shift)?;
        let centre_distance = centre_distance.unwrap_or(nominal);
        // Thinner teeth fit on a smaller one.
        let nearest = without_backlash(Specification::generating_profile_shift)?;
        let minimum = nearest - OVERLAP * pinion.specification.module;
        if !(centre_distance >= minimum && centre_distance.is_finite()) {
            let (found, minimum) = (Millimetres(centre_distance), Millimetres(nearest));
            return Err(Problem::CentreDistance { found, minimum }.into());
        }
        let tangent_length = ((centre_distance - base_sum) * (centre_distance + base_sum)).sqrt();
        let base_pitch =
            std::f64::consts::PI * pinion.specification.module * libm::cos(pinion.specification.pressure_angle);
        let [start_of_contact, end_of_contact] = ends_of_contact(&pinion, &gear, tangent_length);
        let pair = Self {
            working_pressure_angle: libm::atan2(tangent_length, base_sum),
            contact_ratio: (end_of_contact - start_of_contact) / base_pitch,
            pinion,
            gear,
            centre_distance,
            tangent_length,
            start_of_contact,
            end_of_contact,
            base_pitch,
        };
        pair.check()?;
        Ok(pair)
    }

    fn check(&self) -> Result<(), GeometryError> {
        for side in [Side::Pinion, Side::Gear] {
            let (own, mate) = (self.side(side), self.side(side.other()));
            let clearance = self.centre_distance - own.tip_radius - mate.root_radius;
            // The centre distance goes through an angle, each radius is a sum of products, and all began as decimals in other
            // units: some thirty roundings of at most ε of the centre distance. A 0 that was written down comes out within.
            let rounding = 32.0 * f64::EPSILON * self.centre_distance;
            if clearance < -rounding {
                let (tip, clearance) = (Millimetres(own.tip_radius), Millimetres(clearance));
                return Err(GeometryError::from(Problem::NoClearance { tip, clearance }).on(side));
            }
        }
        // Before interference: with flanks that short nothing touches down there.
        let takes_over = self.contact_ratio > 1.0;
        if !takes_over {
            return Err(Problem::ContactRatio { ratio: Plain(self.contact_ratio) }.into());
        }
        for side in [Side::Pinion, Side::Gear] {
            let own = self.side(side);
            if self.is_curtailed(side) {
                let distance = root_distance(self, side)?;
                if distance < -PENETRATION * own.specification.module {
                    return Err(self.interference(side, Some(Millimetres(-distance))));
                }
            }
        }
        Ok(())
    }

    /// What of the contact ratio is lost where contact ends at a root form circle; 0 where the tips end it.
    #[must_use]
    pub fn lost_contact_ratio(&self) -> f64 {
        let whole = ends_by_tips(&self.pinion, &self.gear, self.tangent_length);
        (self.start_of_contact - whole[0] + whole[1] - self.end_of_contact) / self.base_pitch
    }

    /// The centre distance \[m\] at which teeth as thick as these have no backlash; NaN where there is none.
    #[must_use]
    pub fn nearest_centre_distance(&self) -> f64 {
        let angle = angle_without_backlash(&self.pinion, &self.gear, Specification::generating_profile_shift);
        angle.map_or(f64::NAN, |angle| (self.pinion.base_radius + self.gear.base_radius) / libm::cos(angle))
    }

    /// Refuses a pair one of whose tips would touch below the mate's root form circle, wherever contact ends.
    ///
    /// # Errors
    /// The first gear that has no involute where the mate's tip would touch.
    pub fn refuse_interference(&self) -> Result<(), GeometryError> {
        let curtailed = [Side::Pinion, Side::Gear].into_iter().find(|side| self.is_curtailed(*side));
        curtailed.map_or(Ok(()), |side| Err(self.interference(side, None)))
    }

    fn interference(&self, side: Side, cut: Option<Millimetres>) -> GeometryError {
        let (own, mate, roll) = (self.side(side), self.side(side.other()), self.reached_roll(side));
        let reach = self.tangent_length - own.base_radius * own.form_roll;
        GeometryError::from(Problem::Interference {
            mate_tip: Millimetres(mate.tip_radius),
            cut,
            reached: if roll < 0.0 {
                Reached::InsideBaseCircle
            } else {
                Reached::Radius(Millimetres(own.radius_at(roll)))
            },
            form: Millimetres(own.form_radius),
            largest: Millimetres(libm::hypot(mate.base_radius, reach)),
        })
        .on(side)
    }

    /// The roll angle of a gear to which its mate's tip would reach if the involute went on; below the root form circle where
    /// [`GearPair::is_curtailed`].
    #[must_use]
    pub fn reached_roll(&self, side: Side) -> f64 {
        let (own, mate) = (self.side(side), self.side(side.other()));
        (self.tangent_length - mate.base_radius * mate.flank_end.roll) / own.base_radius
    }

    /// Whether contact ends at the root form circle of a gear, short of where the mate's tip would end it.
    #[must_use]
    pub fn is_curtailed(&self, side: Side) -> bool {
        // A rounding's worth of overlap is none.
        self.reached_roll(side) < self.side(side).form_roll - 1e-12
    }

    /// Path positions at which the flanks of gear and pinion end towards their tips: where contact starts and ends, or beyond where
    /// it is curtailed.
    #[must_use]
    pub fn flank_ends(&self) -> [f64; 2] {
        let end = |side: Side, works: f64| {
            let is_longer = self.is_curtailed(side.other());
            if is_longer { self.path_position(side, self.side(side).flank_end.roll) } else { works }
        };
        [end(Side::Gear, self.start_of_contact), end(Side::Pinion, self.end_of_contact)]
    }

    /// The roll angle of a gear up to which its mate's flank lets it work: that of its tip usable circle d_Na.
    #[must_use]
    pub fn highest_roll(&self, side: Side) -> f64 {
        match side {
            Side::Pinion => self.roll(side, self.end_of_contact),
            Side::Gear => self.roll(side, self.start_of_contact),
        }
    }

    /// The points A to E of the path of contact.
    #[must_use]
    pub fn zone_points(&self) -> ZonePoints {
        ZonePoints {
            a: self.start_of_contact,
            b: self.end_of_contact - self.base_pitch,
            c: self.pinion.base_radius * libm::tan(self.working_pressure_angle),
            d: self.start_of_contact + self.base_pitch,
            e: self.end_of_contact,
        }
    }

    /// The path position of a gear's flank point, from its roll angle: the inverse of [`GearPair::roll`].
    #[must_use]
    pub fn path_position(&self, side: Side, roll: f64) -> f64 {
        match side {
            Side::Pinion => roll * self.pinion.base_radius,
            Side::Gear => self.tangent_length - roll * self.gear.base_radius,
        }
    }

    /// The roll angle of a gear down to which it works: that of its root usable circle d_Nf.
    #[must_use]
    pub fn lowest_roll(&self, side: Side) -> f64 {
        match side {
            Side::Pinion => self.roll(side, self.start_of_contact),
            Side::Gear => self.roll(side, self.end_of_contact),
        }
    }

    /// The smaller of the two face widths \[m\]: what is in contact.
    #[must_use]
    pub fn contact_width(&self) -> f64 {
        self.pinion.specification.face_width.min(self.gear.specification.face_width)
    }
}

/// Where contact would go if the mate had an involute everywhere: from where the gear's flank ends to where the pinion's does.
fn ends_by_tips(pinion: &Gear, gear: &Gear, tangent_length: f64) -> [f64; 2] {
    [tangent_length - gear.base_radius * gear.flank_end.roll, pinion.base_radius * pinion.flank_end.roll]
}

/// The same, as far as the mate has one.
fn ends_of_contact(pinion: &Gear, gear: &Gear, tangent_length: f64) -> [f64; 2] {
    let [start, end] = ends_by_tips(pinion, gear, tangent_length);
    // A rounding's worth of overlap is none.
    let forms =
        [pinion.base_radius * (pinion.form_roll - 1e-12), tangent_length - gear.base_radius * (gear.form_roll - 1e-12)];
    [
        if start < forms[0] { pinion.base_radius * pinion.form_roll } else { start },
        if end > forms[1] { tangent_length - gear.base_radius * gear.form_roll } else { end },
    ]
}

fn check_same_rack(pinion: &Gear, gear: &Gear) -> Result<(), GeometryError> {
    let (one, two) = (&pinion.specification, &gear.specification);
    let same = |a: f64, b: f64| (a - b).abs() <= 1e-12 * a;
    let differs = |parameter, pinion: String, gear: String| Problem::Differs { parameter, pinion, gear };
    if !same(one.module, two.module) {
        let shown = |value| Millimetres(value).to_string();
        return Err(differs(Parameter::Module, shown(one.module), shown(two.module)).into());
    }
    if !same(one.pressure_angle, two.pressure_angle) {
        let shown = |value| super::error::Degrees(value).to_string();
        return Err(differs(Parameter::PressureAngle, shown(one.pressure_angle), shown(two.pressure_angle)).into());
    }
    Ok(())
}

fn angle_without_backlash(pinion: &Gear, gear: &Gear, shift: fn(&Specification) -> f64) -> Result<f64, GeometryError> {
    let angle = pinion.specification.pressure_angle;
    let teeth = f64::from(pinion.specification.teeth) + f64::from(gear.specification.teeth);
    let sum = shift(&pinion.specification) + shift(&gear.specification);
    let value = involute(angle) + 2.0 * libm::tan(angle) * sum / teeth;
    if value <= 0.0 {
        let minimum = Plain(-0.5 * involute(angle) * teeth / libm::tan(angle));
        return Err(Problem::ProfileShiftSum { sum: Plain(sum), minimum }.into());
    }
    Ok(inverse_involute(value, angle))
}

/// x1 + x2 of gears that have no backlash on a centre distance \[m\]: the inverse of the sum's equation; `module` in m,
/// `pressure_angle` in rad.
///
/// # Errors
/// When the centre distance is not larger than the sum of the base radii.
pub fn profile_shift_sum(
    teeth: [u32; 2],
    module: f64,
    pressure_angle: f64,
    centre_distance: f64,
) -> Result<f64, GeometryError> {
    let teeth = f64::from(teeth[0]) + f64::from(teeth[1]);
    let base_sum = 0.5 * module * teeth * libm::cos(pressure_angle);
    // Not negated: NaN is refused too.
    if !(centre_distance > base_sum && centre_distance.is_finite()) {
        let (found, minimum) = (Millimetres(centre_distance), Millimetres(base_sum));
        return Err(Problem::CentreDistance { found, minimum }.into());
    }
    let tangent_length = ((centre_distance - base_sum) * (centre_distance + base_sum)).sqrt();
    let working_angle = libm::atan2(tangent_length, base_sum);
    Ok(0.5 * (involute(working_angle) - involute(pressure_angle)) * teeth / libm::tan(pressure_angle))
}

/// k in modules: the tip shortening, of either gear, that leaves the clearance of the basic rack on a centre distance \[m\],
/// k = x1 + x2 − (a − a_d)/m, where a_d = m(z1 + z2)/2.
#[must_use]
pub fn tip_shortening(teeth: [u32; 2], module: f64, profile_shift_sum: f64, centre_distance: f64) -> f64 {
    profile_shift_sum - centre_distance / module + 0.5 * (f64::from(teeth[0]) + f64::from(teeth[1]))
}
