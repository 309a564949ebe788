//! Two gears on their centre distance: path of contact, contact ratio, and what keeps them from meshing.
//!
//! Path positions s \[m\] count from the pinion's tangent point T1. Must not know: loads.

use super::error::{GeometryError, mm};
use super::involute::inv;
use super::{Gear, Pair, Side, Specification};

impl Pair {
    /// Meshes two gears; without a centre distance they run without backlash.
    ///
    /// # Errors
    /// When a gear is impossible, they interfere, jam, or lose contact before the next pair takes over.
    pub fn new(
        pinion: Specification,
        gear: Specification,
        given_centre_distance: Option<f64>,
    ) -> Result<Self, GeometryError> {
        let (pinion, gear) = (Gear::new(Side::Pinion, &pinion)?, Gear::new(Side::Gear, &gear)?);
        let base_radii = pinion.base_radius + gear.base_radius;
        let tight_angle = tight_pressure_angle(&pinion, &gear)?;
        let tight = base_radii / libm::cos(tight_angle);
        let centre_distance = given_centre_distance.unwrap_or(tight);
        if centre_distance < tight * (1.0 - 1e-9) || !centre_distance.is_finite() {
            let (given, tight) = (mm(centre_distance), mm(tight));
            return fail("centre_distance", format!("the centre distance is {given}; below {tight} the flanks jam"));
        }
        let working_pressure_angle =
            if given_centre_distance.is_none() { tight_angle } else { libm::acos(base_radii / centre_distance) };
        let tangent_length = base_radii * libm::tan(working_pressure_angle);
        let reach = |gear: &Gear| gear.base_radius * gear.roll_at(gear.tip_radius);
        let (start_of_contact, end_of_contact) = (tangent_length - reach(&gear), reach(&pinion));
        let base_pitch =
            std::f64::consts::PI * pinion.specification.module * libm::cos(pinion.specification.pressure_angle);
        let pair = Self {
            contact_ratio: (end_of_contact - start_of_contact) / base_pitch,
            pinion,
            gear,
            centre_distance,
            given_centre_distance,
            working_pressure_angle,
            tangent_length,
            start_of_contact,
            end_of_contact,
            base_pitch,
        };
        pair.meshes().map(|()| pair)
    }

    /// The roll angle \[rad\] of a gear's contact point at path position `s`: u1 = s/r_b1, u2 = (L − s)/r_b2.
    #[must_use]
    pub fn roll(&self, side: Side, s: f64) -> f64 {
        match side {
            Side::Pinion => s / self.pinion.base_radius,
            Side::Gear => (self.tangent_length - s) / self.gear.base_radius,
        }
    }

    #[must_use]
    pub fn side(&self, side: Side) -> &Gear {
        match side {
            Side::Pinion => &self.pinion,
            Side::Gear => &self.gear,
        }
    }

    fn meshes(&self) -> Result<(), GeometryError> {
        for (side, deepest) in [(Side::Pinion, self.start_of_contact), (Side::Gear, self.end_of_contact)] {
            let gear = self.side(side);
            let (name, mate) = (side.name(), side.mate().name());
            let roll = self.roll(side, deepest);
            let form_roll = gear.roll_at(gear.form_radius);
            if roll < form_roll - 1e-9 {
                let (other, form) = (self.side(side.mate()), mm(gear.form_radius));
                // The tip that would reach just to the start of the involute.
                let rest = self.tangent_length - form_roll * gear.base_radius;
                let largest = mm((other.base_radius * other.base_radius + rest * rest).sqrt());
                let tip = mm(other.tip_radius);
                let reaches = if roll < 0.0 {
                    let past = mm(-roll * gear.base_radius);
                    format!("reaches {past} past the tangent point into the root of the {name}")
                } else {
                    let reached = mm(gear.radius_at(roll));
                    format!("reaches the {name} at radius {reached}, where its involute starts only at {form}")
                };
                let problem = format!(
                    "interference: the tip of the {mate} {reaches}; the {mate} may have a tip radius of {largest} at most, not {tip}, \
                     or the {name} more teeth or profile shift"
                );
                return fail(if side == Side::Pinion { "pinion.teeth" } else { "gear.teeth" }, problem);
            }
            let clearance = self.centre_distance - gear.root_radius - self.side(side.mate()).tip_radius;
            if clearance < 0.0 {
                let problem =
                    format!("the tip of the {mate} cuts {} into the root circle of the {name}", mm(-clearance));
                return fail("rack.dedendum", problem);
            }
        }
        if self.contact_ratio.is_nan() || self.contact_ratio <= 1.0 {
            let ratio = self.contact_ratio;
            return fail(
                "pinion.teeth",
                format!(
                    "the contact ratio is {ratio:.4}; it must be above 1, so that a pair takes over before the last one leaves"
                ),
            );
        }
        Ok(())
    }
}

fn fail<T>(field: &'static str, problem: String) -> Result<T, GeometryError> {
    Err(GeometryError::Pair { field, problem })
}

/// α_w without backlash: inv α_w = inv α + 2 tan α (x1 + x2)/(z1 + z2).
fn tight_pressure_angle(pinion: &Gear, gear: &Gear) -> Result<f64, GeometryError> {
    let (a, b) = (&pinion.specification, &gear.specification);
    let shift = a.profile_shift + b.profile_shift;
    if shift == 0.0 {
        return Ok(a.pressure_angle);
    }
    let teeth = f64::from(a.teeth) + f64::from(b.teeth);
    let wanted = inv(a.pressure_angle) + 2.0 * libm::tan(a.pressure_angle) * shift / teeth;
    if wanted <= 0.0 {
        return fail(
            "gear.profile_shift",
            format!("with x1 + x2 = {shift} the teeth cannot come together without backlash"),
        );
    }
    // inv is convex and increasing, so from above Newton's method decreases monotonically.
    let mut angle = libm::cbrt(3.0 * wanted).min(1.5).max(a.pressure_angle);
    for _ in 0..100 {
        let tan = libm::tan(angle);
        let step = (tan - angle - wanted) / (tan * tan);
        angle -= step;
        if step.abs() <= f64::EPSILON * angle {
            break;
        }
    }
    Ok(angle)
}
