//! The thickness measured back from the drawn outline, what is undone, backlash by a second way, and a printout.

use std::f64::consts::{FRAC_PI_2, PI};

use proptest::prelude::*;

use super::*;
use crate::gear::geometry::outline::Outline;
use crate::gear::geometry::outline::curve::OutlinePart;
use crate::gear::geometry::outline::roots::Root;
use crate::gear::geometry::outline::roots::trochoid::{RackTip, Trochoid};
use crate::gear::geometry::outline::sample::Density;
use crate::gear::geometry::{Gear, GearPair, Rack};
use crate::gear::material::Material;

fn specification(teeth: u32, profile_shift: f64, allowance: f64) -> Specification {
    Specification {
        teeth,
        module: 2e-3,
        pressure_angle: 20_f64.to_radians(),
        profile_shift,
        thickness_allowance: allowance,
        cutter: None,
        rack: Rack::ISO_53_A,
        tip_radius: None,
        face_width: 20e-3,
        bore_radius: 0.2e-3 * f64::from(teeth),
        material: Material::STEEL,
    }
}

/// Twice the distance of the drawn flank from the centreline along the reference circle, where two of its points lie on either
/// side of that circle.
fn drawn_thickness(gear: &Gear) -> f64 {
    let outline = Outline::new(gear, Trochoid { rack_tip: RackTip::Given }.toe(gear).unwrap(), gear.tip, None).unwrap();
    let points = outline.half(Density { points: 20_000, chord_error: None });
    let flank = points.iter().filter(|point| outline.segments[point.segment].part == OutlinePart::Flank);
    let polar: Vec<[f64; 2]> = flank.map(|point| point.local.position).map(|[x, y]| [x.hypot(y), x.atan2(y)]).collect();
    let r = gear.reference_radius;
    let ends = polar.windows(2).find(|ends| (ends[0][0] > r) != (ends[1][0] > r)).unwrap();
    let share = (r - ends[0][0]) / (ends[1][0] - ends[0][0]);
    2.0 * r * (ends[0][1] + share * (ends[1][1] - ends[0][1])).abs()
}

/// Tier: second method; the thickness as drawn is that of the rack, π m/2 + 2 x m tan α, and the allowance.
#[test]
fn the_outline_is_as_thick_as_allowed() {
    for (teeth, shift, allowance) in [(17, 0.3, -60e-6), (24, 0.0, 25e-6), (41, -0.2, -0.2e-3), (8, 0.5, -30e-6)] {
        let specification = specification(teeth, shift, allowance);
        let gear = Gear::new(&specification).unwrap();
        let rack = 2e-3 * (FRAC_PI_2 + 2.0 * shift * specification.pressure_angle.tan());
        let found = drawn_thickness(&gear) - rack;
        assert!((found - allowance).abs() < 1e-10, "{teeth}: {found:e} for {allowance:e}");
    }
}

/// Tier: second method; the backlash at the working circles is a turn of one gear by which its other flanks touch: the centre
/// distance at which thinner teeth would have none says the same by involute functions of the sum of the x_E.
#[test]
fn the_pair_has_the_backlash_of_both_allowances() {
    for allowances in [[-60e-6, -90e-6], [0.0, -50e-6], [-40e-6, 10e-6]] {
        let gears = [specification(19, 0.2, allowances[0]), specification(48, -0.1, allowances[1])];
        let nominal = GearPair::new(
            Specification { thickness_allowance: 0.0, ..gears[0] },
            Specification { thickness_allowance: 0.0, ..gears[1] },
            None,
        )
        .unwrap();
        let pair = GearPair::new(gears[0], gears[1], None).unwrap();
        assert_eq!(pair.centre_distance.to_bits(), nominal.centre_distance.to_bits());
        assert_eq!(pair.contact_ratio.to_bits(), nominal.contact_ratio.to_bits());
        assert!(nominal.backlash().circumferential.abs() < 1e-15);
        // On the reference circles the allowances are taken off; the base pitch turns one into the other.
        let backlash = pair.backlash();
        let normal = -(allowances[0] + allowances[1]) * gears[0].pressure_angle.cos();
        assert!((backlash.normal - normal).abs() < 1e-14, "{:e} {normal:e}", backlash.normal);
    }
}

/// Tier: published; the limits of the printout that `inspection` has, as a drawing states them: by allowances, by dimensions over
/// balls, by spans.
#[test]
fn each_way_to_say_it_says_the_same() {
    let own =
        Specification { rack: Rack { tip_radius: 0.2, ..Rack::ISO_53_A }, module: 1e-3, ..specification(30, 0.0, 0.0) };
    let allowed = Allowance { upper: -30e-6, lower: Some(-60e-6) }.limits(&own).unwrap();
    let balls =
        OverBalls { ball_diameter: 1.7e-3, largest: 32.2380e-3, smallest: Some(32.1641e-3) }.limits(&own).unwrap();
    // Printed to 0.1 um, which is a third of that in thickness and a little more.
    assert!((balls.largest - allowed.largest).abs() < 0.03e-6 && (balls.smallest - allowed.smallest).abs() < 0.03e-6);
    let gear = |allowance: f64| Gear::new(&Specification { thickness_allowance: allowance, ..own }).unwrap();
    let span = Span { teeth: 4, largest: gear(-30e-6).span(4).length, smallest: Some(gear(-60e-6).span(4).length) };
    let span = span.limits(&own).unwrap();
    assert!((span.largest + 30e-6).abs() < 1e-15 && (span.smallest + 60e-6).abs() < 1e-15);
    assert!((allowed.middle() + 45e-6).abs() < 1e-20);
}

#[test]
fn what_cannot_be_is_told() {
    let own = specification(24, 0.0, 0.0);
    let told = |error: GeometryError| error.to_string();
    let said = told(Allowance { upper: -30e-6, lower: Some(-10e-6) }.limits(&own).unwrap_err());
    assert_eq!(said, "the smallest tooth is -0.01 mm, but must be at most the largest, -0.03 mm");
    let said = told(OverBalls { ball_diameter: 3.5e-3, largest: 30e-3, smallest: None }.limits(&own).unwrap_err());
    assert!(said.contains("but must be above 48.6") && said.contains("on the base circle"), "{said}");
    let said = told(Gear::new(&specification(24, 0.0, -4e-3)).unwrap_err());
    assert!(said.contains("the thickness allowance is -4 mm, but must be above -3.8"), "{said}");
}

proptest! {
    /// What was measured says the allowance, whichever way.
    #[test]
    fn measurements_are_undone(teeth in 12_u32..200, shift in -0.2..0.6, allowance in -0.2e-3..0.1e-3) {
        let own = specification(teeth, shift, 0.0);
        let gear = Gear::new(&Specification { thickness_allowance: allowance, ..own });
        prop_assume!(gear.is_ok());
        let gear = gear.unwrap();
        let span = gear.span(gear.usual_span_teeth());
        let found = Span { teeth: span.teeth, largest: span.length, smallest: None }.limits(&own).unwrap();
        prop_assert!((found.middle() - allowance).abs() < 1e-13 * f64::from(teeth));
        if let Some(balls) = gear.balls(gear.usual_ball_diameter()) {
            let found = OverBalls { ball_diameter: balls.diameter, largest: balls.over_two, smallest: None }.limits(&own).unwrap();
            prop_assert!((found.middle() - allowance).abs() < 1e-12 * f64::from(teeth));
        }
        prop_assert!((gear.thickness_at(gear.reference_radius) - 2e-3 * (0.5 * PI + 2.0 * shift * own.pressure_angle.tan()) - allowance).abs() < 1e-15 * f64::from(teeth));
    }
}
