//! Printed values of two other sources, the flanks themselves, and what undoes itself.

use proptest::prelude::*;

use super::*;
use crate::gear::geometry::{Rack, Specification};
use crate::gear::material::Material;

fn specification(teeth: u32, module: f64, profile_shift: f64, rack: Rack) -> Specification {
    Specification {
        teeth,
        module,
        pressure_angle: 20_f64.to_radians(),
        profile_shift,
        thickness_allowance: 0.0,
        cutter: None,
        rack,
        tip_radius: None,
        face_width: 10.0 * module,
        bore_radius: 0.2 * module * f64::from(teeth),
        material: Material::STEEL,
    }
}

/// A gear that is cut deeper by an allowance, with the tip circle that it has without.
fn thinner(of: &Specification, allowance: f64) -> Gear {
    let tip_radius = Gear::new(of).unwrap().tip_radius;
    let gear = Gear::new(&Specification { thickness_allowance: allowance, ..*of }).unwrap();
    assert_eq!(gear.tip_radius.to_bits(), tip_radius.to_bits());
    gear
}

/// Tier: published; the printout of the gear calculation by MESYS on the pages of Ondrives (z 30, m 1 mm, x 0, reference profile
/// 1.25/0.20/1.00, allowances −0.06 and −0.03 mm, D_M 1.7 mm), to all digits that it prints, in mm.
#[test]
fn a_printout_of_another_program() {
    let rack = Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.2, ..Rack::ISO_53_A };
    let nominal = specification(30, 1e-3, 0.0, rack);
    // A_s, x_E, d_f, d_Ff, s, s_a, M_rK, M_dK, d_M
    let printed = [
        (-0.06, -0.0824, 27.3352, 28.3762, 1.5108, 0.6734, 16.0821, 32.1641, 29.8612),
        (-0.03, -0.0412, 27.4176, 28.4047, 1.5408, 0.7054, 16.1190, 32.2380, 29.9256),
    ];
    for (allowance, x, root, form, thickness, tip, radial, over_two, contact) in printed {
        let gear = thinner(&nominal, allowance * 1e-3);
        let balls = gear.balls(1.7e-3).unwrap();
        let found = [
            (gear.specification.generating_profile_shift(), x),
            (2e3 * gear.root_radius, root),
            (2e3 * gear.form_radius, form),
            (1e3 * gear.thickness_at(gear.reference_radius), thickness),
            (1e3 * gear.tip_thickness(), tip),
            (1e3 * balls.radial, radial),
            (1e3 * balls.over_two, over_two),
            (2e3 * balls.contact_radius, contact),
        ];
        for (found, printed) in found {
            assert!((found - printed).abs() <= 0.5001e-4, "{found} for {printed} at an allowance of {allowance} mm");
        }
        assert!(balls.measurable);
        let thicker =
            gear.thickness_at(gear.reference_radius) - Gear::new(&nominal).unwrap().thickness_at(0.5 * 30.0 * 1e-3);
        assert!((thicker - allowance * 1e-3).abs() < 1e-15);
    }
    let limit = Gear::new(&nominal).unwrap().least_shift_without_undercut();
    assert!((limit + 0.6363).abs() <= 0.5001e-4, "x_Emin: {limit}");
}

/// Tier: published; Elements of Metric Gear Technology (Stock Drive Products), table 10-1: m 10 mm, z 12, x 0.3.
#[test]
fn a_chord_of_a_handbook() {
    let gear = Gear::new(&specification(12, 10e-3, 0.3, Rack::ISO_53_A)).unwrap();
    assert!((1e3 * gear.thickness_at(gear.reference_radius) - 17.8918).abs() <= 0.5001e-4);
    let Chord { length, height } = gear.chord(gear.reference_radius);
    assert!((1e3 * length - 17.8256).abs() <= 0.5001e-4 && (1e3 * height - 13.6657).abs() <= 0.5001e-4);
}

/// Tier: second method. The plane that touches a flank is at the largest projection of its points, a ball at their least
/// distance from its centre; both are searched for on the flank.
#[test]
fn planes_and_balls_touch_the_flanks() {
    for (teeth, shift) in [(17, 0.3), (24, 0.0), (25, -0.1), (60, 0.5), (121, 0.0)] {
        let gear = Gear::new(&specification(teeth, 2e-3, shift, Rack::ISO_53_A)).unwrap();
        let pitch = 2.0 * PI / f64::from(teeth);
        let rolls =
            || (0..=20_000).map(|step| gear.form_roll + (gear.flank_end.roll - gear.form_roll) * f64::from(step) / 2e4);
        let span = gear.span(gear.usual_span_teeth());
        assert!(span.on_flank, "{teeth}");
        // From the middle of the teeth that are spanned, the outermost flank is so far to the side.
        let turn = 0.5 * f64::from(span.teeth - 1) * pitch;
        let aside = |roll: f64| {
            let point = gear.flank(roll);
            let (sine, cosine) = libm::sincos(turn);
            point.half_thickness * cosine + point.height * sine
        };
        let widest = rolls().map(aside).fold(0.0, f64::max);
        assert!((2.0 * widest / span.length - 1.0).abs() < 1e-8, "{teeth}: {} for {}", span.length, 2.0 * widest);
        let balls = gear.balls(gear.usual_ball_diameter()).unwrap();
        assert!((balls.contact_radius / gear.middle_radius() - 1.0).abs() < 1e-12);
        let (sine, cosine) = libm::sincos(0.5 * pitch);
        let centre = [balls.centre_radius * sine, balls.centre_radius * cosine];
        let away = |roll: f64| {
            let point = gear.flank(roll);
            libm::hypot(point.half_thickness - centre[0], point.height - centre[1])
        };
        let nearest = rolls().map(away).fold(f64::INFINITY, f64::min);
        assert!(
            (2.0 * nearest / balls.diameter - 1.0).abs() < 1e-6,
            "{teeth}: {} for {}",
            balls.diameter,
            2.0 * nearest
        );
    }
}

/// Tier: closed form; without profile shift and allowance the constant chord is π m/2 cos² α for any number of teeth.
#[test]
fn the_constant_chord_is_that_of_the_rack() {
    for teeth in [20, 41, 300] {
        let gear = Gear::new(&specification(teeth, 3e-3, 0.0, Rack::ISO_53_A)).unwrap();
        let cosine = libm::cos(gear.specification.pressure_angle);
        let Chord { length, height } = gear.constant_chord();
        // The thickness is a difference of involute functions times a radius of a hundred modules.
        assert!((length / (0.5 * PI * 3e-3 * cosine * cosine) - 1.0).abs() < 1e-12);
        assert!((height - 3e-3 + 0.5 * length * libm::tan(gear.specification.pressure_angle)).abs() < 1e-15);
    }
}

#[test]
fn a_ball_that_finds_no_place_is_told() {
    let gear = Gear::new(&specification(24, 2e-3, 0.0, Rack::ISO_53_A)).unwrap();
    assert_eq!((gear.balls(0.0), gear.balls(-1e-3), gear.balls(f64::NAN)), (None, None, None));
    assert!(gear.balls(1e-6).is_none());
    assert!(!gear.balls(20e-3).unwrap().measurable);
    assert!(!gear.span(0).on_flank && !gear.span(24).on_flank);
}

proptest! {
    /// What was measured says the profile shift.
    #[test]
    fn measurements_are_undone(teeth in 12_u32..200, shift in -0.2..0.6, module in 1e-4..0.05) {
        let specification = specification(teeth, module, shift, Rack::ISO_53_A);
        let gear = Gear::new(&specification);
        prop_assume!(gear.is_ok());
        let gear = gear.unwrap();
        let span = gear.span(gear.usual_span_teeth());
        let found = specification.profile_shift_of_span(span.teeth, span.length);
        prop_assert!((found - shift).abs() < 1e-11, "{found} for {shift}");
        if let Some(balls) = gear.balls(gear.usual_ball_diameter()) {
            let found = specification.profile_shift_of_balls(balls.diameter, balls.over_two).unwrap();
            prop_assert!((found - shift).abs() < 1e-10, "{found} for {shift}");
        }
    }
}
