//! One gear from its specification, or why it is impossible.
//!
//! r = m z/2, r_b = r cos α, r_a = r + m(h_aP + x), r_f = r − m(h_fP − x_E), ψ_b = (π/2 + 2x_E tan α)/z + inv α.
//! Source: ISO 21771-1:2024, sections 5 and 7. Must not know: the mate.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use std::ops::RangeInclusive;

use super::error::shown::{beside, beside_both};
use super::error::{Degrees, GeometryError, Millimetres, Parameter, Plain, Problem};
use super::flank_end::FlankEnd;
use super::generated::Generated;
use super::involute::involute;
use super::outline::tip::Tip;
use super::pinion_cutter::Shaping;
use super::trochoid;
use super::{DEGREE, Gear, Rack, Specification};

/// Least bore radius over root radius: a body held at a point would turn about it without limit.
const LEAST_BORE: f64 = 1e-3;

impl Gear {
    /// # Errors
    /// When no such gear can be cut: a value out of its range, an impossible rack, no involute left by undercut,
    /// pointed teeth, a bore that reaches the root.
    pub fn new(specification: &Specification) -> Result<Self, GeometryError> {
        check_ranges(specification)?;
        let shaping = specification.cutter.as_ref().map(|cutter| cutter.shaping(specification)).transpose()?;
        if shaping.is_none() {
            check_rack(specification)?;
        }
        let Specification { teeth, module, pressure_angle, profile_shift, rack, .. } = *specification;
        let generating_shift = specification.generating_profile_shift();
        let reference_radius = 0.5 * module * f64::from(teeth);
        let base_radius = reference_radius * libm::cos(pressure_angle);
        let root_radius = shaping.as_ref().map_or_else(
            || reference_radius - module * (rack.dedendum - generating_shift),
            |shaping| shaping.centre_distance - shaping.tip_radius,
        );
        let tip_radius =
            specification.tip_radius.unwrap_or(reference_radius + module * (rack.addendum + profile_shift));
        let half_base_angle = (FRAC_PI_2 + 2.0 * generating_shift * libm::tan(pressure_angle)) / f64::from(teeth)
            + involute(pressure_angle);
        let least_shift =
            -(FRAC_PI_2 + f64::from(teeth) * involute(pressure_angle)) / (2.0 * libm::tan(pressure_angle));
        // Without an allowance that is what the profile shift must be above; with one it is rarely the rack that is wrong.
        if half_base_angle <= 0.0 && specification.thickness_allowance < 0.0 {
            let [allowance, minimum] =
                [specification.thickness_allowance, specification.allowance_of(least_shift)].map(Millimetres);
            return Err(Problem::NoTooth { allowance, minimum }.into());
        }
        if root_radius <= 0.0
            && let Some(cutter) = specification.cutter
        {
            let [own, largest] = [cutter.addendum, cutter.addendum + root_radius / module].map(Plain);
            return Err(out_of_range(
                Parameter::CutterAddendum,
                beside(&own, &largest),
                format!("below {} modules, where the root circle vanishes", beside(&largest, &own)),
            ));
        }
        if root_radius <= 0.0 {
            let [own, largest] = [rack.dedendum, 0.5 * f64::from(teeth) + generating_shift].map(Plain);
            return Err(out_of_range(
                Parameter::RackDedendum,
                beside(&own, &largest),
                format!("below {} modules, where the root circle vanishes", beside(&largest, &own)),
            ));
        }
        if half_base_angle <= 0.0 {
            let [own, minimum] = [profile_shift, least_shift].map(Plain);
            let range = format!("above {} modules, where the tooth vanishes", beside(&minimum, &own));
            return Err(out_of_range(Parameter::ProfileShift, beside(&own, &minimum), range));
        }
        let Generated { joint, .. } = Generated::new(specification, base_radius, half_base_angle)?;
        let mut gear = Self {
            specification: *specification,
            reference_radius,
            base_radius,
            tip_radius,
            root_radius,
            form_radius: joint.radius,
            form_roll: joint.roll,
            undercut: joint.undercut,
            half_base_angle,
            tip: Tip::Land,
            flank_end: FlankEnd::corner(0.0),
        };
        gear.check()?;
        if let Some(shaping) = &shaping {
            gear.check_generated(shaping)?;
        }
        gear.flank_end = FlankEnd::corner(gear.tip_roll());
        Ok(gear)
    }

    /// The same gear with another tip.
    ///
    /// # Errors
    /// When the tooth has no room for it.
    pub fn with_tip(self, tip: Tip) -> Result<Self, GeometryError> {
        let flank_end = FlankEnd::of(&self, tip)?;
        Ok(Self { tip, flank_end, ..self })
    }

    /// Refuses a cutter whose flank begins, at its base circle, before the gear's flank ends.
    fn check_generated(&self, shaping: &Shaping) -> Result<(), GeometryError> {
        let [_, highest] = shaping.rolls(self.base_radius);
        if highest < self.tip_roll() {
            let [reached, tip] = [self.radius_at(highest), self.tip_radius].map(Millimetres);
            let teeth = self.specification.cutter.map_or(0, |cutter| cutter.teeth);
            return Err(Problem::CutterTooSmall { teeth, reached, tip }.into());
        }
        Ok(())
    }

    /// Whether a rack without protuberance would leave a flank below the tip circle.
    fn is_cut_by_protuberance(&self) -> bool {
        let given = self.specification;
        let rack = Rack { protuberance: 0.0, machining_allowance: 0.0, ..given.rack };
        given.cutter.is_none()
            && given.rack.residual_undercut() > 0.0
            && Generated::new(&Specification { rack, ..given }, self.base_radius, self.half_base_angle)
                .is_ok_and(|plain| plain.joint.radius < self.tip_radius)
    }

    fn check(&self) -> Result<(), GeometryError> {
        let Specification { teeth, bore_radius, tip_radius, .. } = self.specification;
        // Named for what must hold, so that a NaN fails too.
        let has_flank = self.tip_radius > self.form_radius;
        if !has_flank && self.is_cut_by_protuberance() {
            let rack = &self.specification.rack;
            return Err(Problem::ProtuberanceTooLarge {
                protuberance: Plain(rack.protuberance),
                allowance: Plain(rack.machining_allowance),
                angle: Degrees(rack.protuberance_angle),
                tip: Millimetres(self.tip_radius),
            }
            .into());
        }
        if !has_flank {
            return Err(Problem::NoFlank {
                form: Millimetres(self.form_radius),
                tip: Millimetres(self.tip_radius),
                teeth,
                minimum: Plain(self.least_shift_without_undercut()),
            }
            .into());
        }
        let has_land = self.tip_thickness() > 0.0;
        if !has_land {
            return Err(Problem::Pointed {
                tip: Millimetres(self.tip_radius),
                apex: Millimetres(self.radius_at(self.apex_roll())),
                tip_is_given: tip_radius.is_some(),
            }
            .into());
        }
        let minimum = LEAST_BORE * self.root_radius;
        // The bound as a message shows it must pass: it is rounded.
        if !(bore_radius >= minimum * (1.0 - 1e-9) && bore_radius < self.root_radius) {
            let [bore, minimum, root] = [bore_radius, minimum, self.root_radius].map(Millimetres);
            return Err(Problem::Bore { bore, minimum, root }.into());
        }
        Ok(())
    }
}

fn out_of_range(parameter: Parameter, found: String, range: String) -> GeometryError {
    Problem::OutOfRange { parameter, found, range }.into()
}

fn check_ranges(specification: &Specification) -> Result<(), GeometryError> {
    type Show = fn(f64, [f64; 2]) -> String;
    type Row = (Parameter, f64, RangeInclusive<f64>, Show, &'static str);
    let length: Show = |value, [one, other]| beside_both(&Millimetres(value), [&Millimetres(one), &Millimetres(other)]);
    let angle: Show = |value, [one, other]| beside_both(&Degrees(value), [&Degrees(one), &Degrees(other)]);
    let plain: Show = |value, [one, other]| beside_both(&Plain(value), [&Plain(one), &Plain(other)]);
    let Specification { teeth, module, pressure_angle, profile_shift, rack, face_width, material, .. } = *specification;
    let rows: [Row; 14] = [
        (Parameter::Teeth, teeth.into(), 4.0..=10_000.0, plain, ""),
        (Parameter::Module, module, 1e-6..=10.0, length, ""),
        (Parameter::PressureAngle, pressure_angle, DEGREE..=45.0 * DEGREE, angle, ""),
        (Parameter::ProfileShift, profile_shift, -5.0..=5.0, plain, " modules"),
        (Parameter::RackAddendum, rack.addendum, 0.1..=5.0, plain, " modules"),
        (Parameter::RackDedendum, rack.dedendum, 0.1..=5.0, plain, " modules"),
        (Parameter::RackTipRadius, rack.tip_radius, 0.0..=5.0, plain, " modules"),
        (Parameter::Protuberance, rack.protuberance, 0.0..=1.0, plain, " modules"),
        (Parameter::ProtuberanceAngle, rack.protuberance_angle, DEGREE..=45.0 * DEGREE, angle, ""),
        (Parameter::MachiningAllowance, rack.machining_allowance, 0.0..=1.0, plain, " modules"),
        (Parameter::NotchRadius, rack.notch_radius, 0.0..=5.0, plain, " modules"),
        (Parameter::FaceWidth, face_width, 1e-6..=100.0, length, ""),
        (Parameter::YoungsModulus, material.youngs_modulus, 1.0..=1e15, plain, " Pa"),
        (Parameter::PoissonRatio, material.poisson_ratio, 0.0..=0.5, plain, ""),
    ];
    let of_cutter = specification.cutter.iter().flat_map(|cutter| -> [Row; 4] {
        [
            (Parameter::CutterTeeth, cutter.teeth.into(), 4.0..=100_000.0, plain, ""),
            (Parameter::CutterProfileShift, cutter.profile_shift, -5.0..=5.0, plain, " modules"),
            (Parameter::CutterAddendum, cutter.addendum, 0.1..=5.0, plain, " modules"),
            (Parameter::CutterTipRadius, cutter.tip_radius, 0.0..=5.0, plain, " modules"),
        ]
    });
    for (parameter, value, range, show, unit) in rows.into_iter().chain(of_cutter) {
        if !range.contains(&value) {
            let ends = [*range.start(), *range.end()];
            let [from, to] = ends.map(|end| show(end, [value; 2]));
            return Err(out_of_range(parameter, show(value, ends) + unit, format!("{from} to {to}{unit}")));
        }
    }
    Ok(())
}

fn check_rack(specification: &Specification) -> Result<(), GeometryError> {
    let Specification { pressure_angle, rack, .. } = *specification;
    let plain = Rack { protuberance: 0.0, machining_allowance: 0.0, ..rack };
    if trochoid::full_round(&Specification { rack: plain, ..*specification }) <= 0.0 {
        let largest = Degrees(libm::atan(FRAC_PI_4 / rack.dedendum));
        return Err(
            Problem::NoTipLand { dedendum: Plain(rack.dedendum), angle: Degrees(pressure_angle), largest }.into()
        );
    }
    let largest = trochoid::full_round(specification);
    if largest <= 0.0 {
        let (sine, cosine) = libm::sincos(pressure_angle);
        let largest = rack.protuberance + FRAC_PI_4 * cosine - rack.dedendum * sine;
        let [allowance, dedendum, largest] = [rack.machining_allowance, rack.dedendum, largest].map(Plain);
        return Err(Problem::AllowanceTooLarge { allowance, dedendum, largest }.into());
    }
    // Full round is allowed, so it must be reachable by a decimal number.
    if rack.tip_radius > largest * (1.0 + 1e-9) {
        return Err(Problem::TipRoundTooLarge { radius: Plain(rack.tip_radius), largest: Plain(largest) }.into());
    }
    if rack.protuberance > 0.0 && rack.protuberance_angle >= pressure_angle {
        let [own, flank] = [rack.protuberance_angle, pressure_angle].map(Degrees);
        let range = format!("below the pressure angle, {}", beside(&flank, &own));
        return Err(out_of_range(Parameter::ProtuberanceAngle, beside(&own, &flank), range));
    }
    Ok(())
}
