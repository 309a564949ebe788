//! Tips that the tool chamfers: the rack with its ramp is the oracle, as in `cutter.rs`.

use super::cutter::{distance_to_swept, distance_to_trapezoid};
use super::*;
use crate::gear::geometry::outline::Outline;
use crate::gear::geometry::outline::curve::OutlinePart;
use crate::gear::geometry::outline::roots::Toe;
use crate::gear::geometry::outline::tip::Tip;

/// The rack's tooth with a sharp tip, and the trapezoid of its ramp from where that begins: the smaller distance is that of the union.
fn distance(gear: &Gear, angle: f64, height: f64, [x, y]: [f64; 2]) -> f64 {
    let Specification { module, pressure_angle, rack, .. } = gear.specification;
    let shift = gear.specification.generating_profile_shift() * module;
    let half = |depth: f64| module * PI / 4.0 - depth * pressure_angle.tan();
    let (deep, begin) = (rack.dedendum * module, height - rack.addendum * module);
    distance_to_swept(gear, x, y, |x, y| {
        let flank = distance_to_trapezoid([half(deep), deep], pressure_angle, 0.0, [x, y + shift]);
        flank.min(distance_to_trapezoid([half(begin), begin], angle, 0.0, [x, y + shift]))
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 30, ..ProptestConfig::default() })]

    /// Tier: the cutter itself. The ramp touches every point of the chamfer and the flank below it, and goes nowhere deeper; the
    /// flank ends where it does, thicker teeth included.
    #[test]
    fn the_ramp_touches_the_whole_chamfer(
        teeth in 14_u32..90, shift in -0.2..0.5_f64, steeper in 3.0..40.0_f64, height in 0.05..0.3_f64, allowance in -0.1e-3..0.0_f64,
    ) {
        let mut specification = specification(teeth, 3.0, shift);
        specification.rack.tip_radius = 0.0;
        specification.thickness_allowance = allowance;
        specification.bore_radius = 1e-3;
        let (angle, height) = ((20.0 + steeper) * DEGREE, height * 3e-3);
        let made = Gear::new(&specification).and_then(|gear| gear.with_tip(Tip::SemiTopping { angle, height }));
        let Ok(gear) = made else { return Err(TestCaseError::reject("no such gear")) };
        let outline = Outline::new(&gear, Toe::of(&gear.root(RootShape::Trochoid).unwrap()), gear.tip, None).unwrap();
        prop_assert!((outline.end_roll - gear.flank_end.roll).abs() < 1e-15);
        let chamfer = outline.segments.iter().find(|segment| segment.part == OutlinePart::TipBreak);
        let Some(chamfer) = chamfer else { return Err(TestCaseError::reject("the ramp begins beyond the tip")) };
        let end = gear.flank(gear.flank_end.roll);
        let start = chamfer.start();
        prop_assert!((start[0] - end.half_thickness).hypot(start[1] - end.height) < 1e-12);
        for k in 0..=6 {
            let part = f64::from(k) / 6.0;
            let point = chamfer.curve.point(chamfer.parameter(part));
            let away = distance(&gear, angle, height, point) * 1e3;
            prop_assert!(away.abs() < 1e-9, "chamfer at {part}: {away} mm");
            let flank = gear.flank(gear.form_roll + part * (gear.flank_end.roll - gear.form_roll));
            let away = distance(&gear, angle, height, [flank.half_thickness, flank.height]) * 1e3;
            prop_assert!(away.abs() < 1e-9, "flank at {part}: {away} mm");
        }
        let tip = chamfer.end();
        prop_assert!((tip[0].hypot(tip[1]) - gear.tip_radius).abs() < 1e-14);
        // The corner turns by what two involutes differ in there: that of the pressure angles at its radius.
        let radius = gear.radius_at(gear.flank_end.roll);
        let at = |base: f64| (base / radius).acos();
        let turned = at(gear.reference_radius * angle.cos()) - at(gear.base_radius);
        prop_assert!((gear.flank_end.interior_angle - (PI - turned)).abs() < 1e-12, "{turned}");
    }
}

/// Tier: limits; contact ends at the chamfer, a ramp beyond the tip does nothing, and what does not fit is refused with its bound.
#[test]
fn contact_ends_where_the_ramp_begins() {
    let specifications = [specification(24, 3.0, 0.0), specification(48, 3.0, 0.0)];
    let pair = |height: f64| {
        let tip = Tip::SemiTopping { angle: 45.0 * DEGREE, height };
        GearPair::with_tips(specifications, [tip; 2], None)
    };
    let plain = GearPair::new(specifications[0], specifications[1], None).unwrap();
    assert_eq!(pair(0.0).unwrap().contact_ratio.to_bits(), plain.contact_ratio.to_bits());
    let broken = pair(0.3e-3).unwrap();
    let lost = [&broken.pinion, &broken.gear].map(|gear| gear.base_radius * (gear.tip_roll() - gear.flank_end.roll));
    let ratio = plain.contact_ratio - (lost[0] + lost[1]) / plain.base_pitch;
    assert!((broken.contact_ratio - ratio).abs() < 1e-13 && lost.iter().all(|lost| *lost > 0.1e-3), "{lost:?}");
    let refused = pair(2.5e-3).unwrap_err();
    assert!(refused.subject() == Subject::Tip && refused.to_string().contains("must be by"), "{refused}");
    let flat = Gear::new(&specifications[0]).unwrap().with_tip(Tip::SemiTopping { angle: 20.0 * DEGREE, height: 1e-4 });
    let refused = flat.unwrap_err();
    assert!(
        refused.subject() == Subject::Tip && refused.to_string().contains("above the pressure angle, 20 deg"),
        "{refused}"
    );
}
