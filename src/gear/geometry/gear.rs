//! One gear: everything that follows from its specification, and what makes a specification no gear.
//!
//! Terms and symbols of ISO 21771. Lengths in m, angles in rad. Must not know: the mating gear.

use std::f64::consts::{FRAC_PI_2, PI};

use super::error::{GeometryError, mm};
use super::involute::{inv, inverse_roll, point_angle};
use super::trochoid::Trochoid;
use super::{Gear, Side, Specification};

impl Gear {
    /// # Errors
    /// When the rack cannot exist, the tooth is pointed or cut through, or the bore does not leave a body.
    pub fn new(side: Side, specification: &Specification) -> Result<Self, GeometryError> {
        let fail = |field, problem| Err(GeometryError::Gear { gear: side.name(), field, problem });
        let Specification { teeth, module, pressure_angle, profile_shift, rack, .. } = *specification;
        let positive = |value: f64| value.is_finite() && value > 0.0;
        if teeth < 4 || !positive(module) || !(positive(pressure_angle) && pressure_angle < FRAC_PI_2) {
            let problem = format!("{teeth} teeth, module {}, pressure angle {pressure_angle} rad", mm(module));
            return fail("teeth", problem);
        }
        if !positive(specification.face_width) {
            return fail(
                "face_width",
                format!("its face width is {}; it must be positive", mm(specification.face_width)),
            );
        }
        let reference_radius = 0.5 * module * f64::from(teeth);
        let base_radius = reference_radius * libm::cos(pressure_angle);
        let root_radius = reference_radius - module * (rack.dedendum - profile_shift);
        let nominal_tip = reference_radius + module * (rack.addendum + profile_shift);
        let tip_radius = specification.tip_radius.unwrap_or(nominal_tip);
        let half_base_angle =
            (FRAC_PI_2 + 2.0 * profile_shift * libm::tan(pressure_angle)) / f64::from(teeth) + inv(pressure_angle);

        let trochoid = Trochoid::new(specification);
        if trochoid.rack_tip_land() < -1e-12 * module {
            let (sin, cos, tan) = (libm::sin(pressure_angle), libm::cos(pressure_angle), libm::tan(pressure_angle));
            let full_round = (0.25 * PI - rack.dedendum * tan) * cos / (1.0 - sin);
            let problem = if full_round < 0.0 {
                format!("a rack with dedendum {} comes to a point before its tip at this pressure angle", rack.dedendum)
            } else {
                format!("the rack's tip radius {} is larger than its full round {full_round:.5}", rack.tip_radius)
            };
            return fail("rack.tip_radius", problem);
        }
        if rack.tip_radius < 0.0 {
            return fail("rack.tip_radius", format!("the rack's tip radius {} is negative", rack.tip_radius));
        }
        if !positive(root_radius) {
            return fail("teeth", format!("its root circle has the radius {}; it must be positive", mm(root_radius)));
        }
        if !(specification.bore_radius >= 0.0 && specification.bore_radius < root_radius) {
            let (bore, root) = (mm(specification.bore_radius), mm(root_radius));
            return fail(
                "bore_radius",
                format!("its bore radius {bore} must be from 0 to below the root radius {root}"),
            );
        }
        let (_, form_roll) = trochoid.junction(base_radius, half_base_angle);
        let form_radius = base_radius * (1.0 + form_roll * form_roll).sqrt();
        if tip_radius <= form_radius {
            let (tip, form) = (mm(tip_radius), mm(form_radius));
            return fail("tip_radius", format!("its tip radius {tip} is not above {form}, where the involute starts"));
        }
        let gear = Self {
            specification: *specification,
            reference_radius,
            base_radius,
            tip_radius,
            root_radius,
            form_radius,
            half_base_angle,
        };
        if gear.tip_thickness() <= 0.0 {
            let (tip, point) = (mm(tip_radius), mm(gear.point_radius()));
            let problem = format!(
                "with x = {profile_shift} its teeth come to a point at the radius {point}; \
                 the tip radius must be below that, not {tip}"
            );
            return fail(if specification.tip_radius.is_some() { "tip_radius" } else { "profile_shift" }, problem);
        }
        Ok(gear)
    }

    /// Half the angle of the tooth at `radius` on the involute \[rad\].
    #[must_use]
    pub fn half_angle(&self, radius: f64) -> f64 {
        point_angle(self.roll_at(radius), self.half_base_angle)
    }

    /// Arc thickness of the tooth at the tip \[m\]; not positive when the tooth would be pointed.
    #[must_use]
    pub fn tip_thickness(&self) -> f64 {
        2.0 * self.tip_radius * self.half_angle(self.tip_radius)
    }

    /// Roll angle of the involute's point at `radius` \[rad\]; 0 at and below the base circle.
    #[must_use]
    pub fn roll_at(&self, radius: f64) -> f64 {
        inverse_roll(radius, self.base_radius)
    }

    /// Radius of the involute's point at a roll angle \[m\].
    #[must_use]
    pub fn radius_at(&self, roll: f64) -> f64 {
        self.base_radius * (1.0 + roll * roll).sqrt()
    }

    /// Roll angle u_p at which the two flanks would meet: u_p − arctan u_p = ψ_b.
    #[must_use]
    pub fn point_roll(&self) -> f64 {
        let psi = self.half_base_angle;
        // u³/3 is the leading term; from above Newton's method converges monotonically, the function being convex.
        let mut roll = libm::cbrt(3.0 * psi) * (1.0 + psi);
        for _ in 0..60 {
            let step = (roll - libm::atan(roll) - psi) * (1.0 + roll * roll) / (roll * roll);
            roll -= step;
            if step.abs() <= f64::EPSILON * roll {
                break;
            }
        }
        roll
    }

    fn point_radius(&self) -> f64 {
        self.radius_at(self.point_roll())
    }

    /// The smallest profile shift x at which the rack does not undercut.
    #[must_use]
    pub fn smallest_shift_without_undercut(&self) -> f64 {
        let gear = &self.specification;
        let sin = libm::sin(gear.pressure_angle);
        let needed = gear.rack.dedendum - gear.rack.tip_radius * (1.0 - sin);
        needed - 0.5 * f64::from(gear.teeth) * sin * sin
    }
}

impl Side {
    #[must_use]
    pub fn mate(self) -> Self {
        match self {
            Self::Pinion => Self::Gear,
            Self::Gear => Self::Pinion,
        }
    }

    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Pinion => "pinion",
            Self::Gear => "gear",
        }
    }
}
