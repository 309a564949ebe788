//! Energy method against the 40-digit reference, invariants, and the refusals.

use std::collections::BTreeSet;

use serde_json::Value;

use super::energy::Tooth;
use super::sainsot::Body;
use super::*;
use crate::base::record::Record;
use crate::gear::geometry::root::Root;
use crate::gear::geometry::testing::{pair_19_48, specification};

fn setting(root: RootShape, coupled: bool) -> Setting {
    Setting { root, contact: ContactLaw::Linear, coupled }
}

/// The largest value on an interval: a scan, then thirds around the best place.
fn maximum(function: impl Fn(f64) -> f64, lower: f64, upper: f64) -> f64 {
    let at = |index: i32| lower + (upper - lower) * f64::from(index) / 200.0;
    let best = (0..=200).max_by(|&a, &b| function(at(a)).total_cmp(&function(at(b)))).unwrap();
    let (mut a, mut b) = (at((best - 1).max(0)), at((best + 1).min(200)));
    for _ in 0..120 {
        let (left, right) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
        if function(left) < function(right) { a = left } else { b = right }
    }
    function(a).max(function(at(best)))
}

/// Stiffness of one pair at path position `s`, linear contact on the common width \[N/m\].
fn pair_stiffness(pair: &Pair, compliance: &PairCompliance, s: f64) -> f64 {
    let teeth = compliance.pinion.total(pair.roll(Side::Pinion, s)) + compliance.gear.total(pair.roll(Side::Gear, s));
    1.0 / (teeth + 4.0 * (1.0 - 0.09) / (std::f64::consts::PI * 206e9 * 0.018))
}

/// Published value (tier 1: an independent 40-digit computation): every key of the file that belongs to this layer.
#[test]
fn every_reference_value_is_met_to_one_part_in_a_trillion() {
    let text = include_str!("../../../tests/reference/energy_pinion.json");
    let reference: Value = serde_json::from_str(text).unwrap();
    let pair = pair_19_48(1.75);
    let pinion = &pair.pinion;
    let root = Root::new(pinion, RootShape::Trochoid);
    let tooth = Tooth::new(pinion, &root);
    let body = Body::new(pinion, &root);
    let (compliance, _) =
        PairCompliance::new(method("energy").unwrap(), &Record::default(), &pair, &setting(RootShape::Trochoid, false))
            .unwrap();
    let (single_start, single_end) = (pair.end_of_contact - pair.base_pitch, pair.start_of_contact + pair.base_pitch);
    let single = |s: f64| pair_stiffness(&pair, &compliance, s);
    let double = |s: f64| single(s) + single(s + pair.base_pitch);
    let force = 50.0 / pinion.base_radius;
    let single_min = single(single_start).min(single(single_end));
    let double_max = maximum(double, pair.start_of_contact, single_start);

    let mut left: BTreeSet<String> = BTreeSet::new();
    for (name, entry) in reference["values"].as_object().unwrap() {
        let expected = entry["float"].as_f64().unwrap();
        let computed = match name.as_str() {
            "base_pitch" => pair.base_pitch * 1e3,
            "line_T1T2" => pair.tangent_length * 1e3,
            "s_A" => pair.start_of_contact * 1e3,
            "s_E" => pair.end_of_contact * 1e3,
            "contact_ratio" => pair.contact_ratio,
            "double_zone_length" => pair.base_pitch * (pair.contact_ratio - 1.0) * 1e3,
            "hertz_linear_1_over_kh" => 4.0 * 0.91 / (std::f64::consts::PI * 206e3 * 18.0),
            "pinion.base_radius" => pinion.base_radius * 1e3,
            "pinion.form_radius" => pinion.form_radius * 1e3,
            "pinion.tip_thickness_arc" => pinion.tip_thickness() * 1e3,
            "pinion.half_base_angle_alpha2" => pinion.half_base_angle,
            "pinion.theta_f" => root.half_angle,
            "pinion.sainsot_L" => body.factors[0],
            "pinion.sainsot_M" => body.factors[1],
            "pinion.sainsot_P" => body.factors[2],
            "pinion.sainsot_Q" => body.factors[3],
            "pair.pitch_point.compliance" => 1e3 / single(pinion.reference_radius * 20_f64.to_radians().sin()),
            "pair.pitch_point.stiffness" => single(pinion.reference_radius * 20_f64.to_radians().sin()),
            "single_zone_max_stiffness" => maximum(single, single_start, single_end),
            "double_zone_max_stiffness" => double_max,
            "single_zone_min_stiffness" => single_min,
            "load_along_LOA" => force,
            "STEpp_unmodified" => (force / single_min - force / double_max) * 1e6,
            other => match component(&tooth, pinion, other) {
                Some(value) => value,
                None => {
                    left.insert(other.to_owned());
                    continue;
                }
            },
        };
        assert!((computed / expected - 1.0).abs() < 1e-12, "{name}: computed {computed}, reference {expected}");
    }
    // The approaches need the contact solver, the undercut belongs to the geometry: both are tested there.
    assert!(left.iter().all(|name| name.starts_with("approach.") || name.starts_with("undercut_")), "{left:?}");
    assert_eq!(left.len(), 8);
}

/// `pinion.r28.5.1_over_kb` and its like.
fn component(tooth: &Tooth, pinion: &crate::gear::geometry::Gear, name: &str) -> Option<f64> {
    let (radius, which) = name.strip_prefix("pinion.r")?.split_once(".1_over_")?;
    let parts = tooth.components(pinion.roll_at(radius.parse::<f64>().ok()? * 1e-3));
    let value = match which {
        "kb" => parts.bending,
        "ks" => parts.shear,
        "ka" => parts.axial,
        "kf" => parts.body,
        _ => return None,
    };
    Some(value * 1e3)
}

/// Second method: the direct formula integrated adaptively in the tooth's height, without antiderivatives.
#[test]
fn the_tables_agree_with_the_direct_evaluation_on_any_gear() {
    for (teeth, shift) in [(18, 0.0), (19, 0.0), (25, 0.5), (48, 0.0), (120, -0.3), (300, 0.0)] {
        let pair = Pair::new(specification(teeth, shift), specification(40, -shift), None).unwrap();
        let root = Root::new(&pair.pinion, RootShape::Trochoid);
        let tooth = Tooth::new(&pair.pinion, &root);
        let (compliance, _) =
            PairCompliance::new(&METHODS[0], &Record::default(), &pair, &setting(RootShape::Trochoid, false)).unwrap();
        let (lower, upper) = (compliance.pinion.bending.lower(), compliance.pinion.bending.upper());
        for step in 0..=97 {
            let roll = lower + (upper - lower) * f64::from(step) / 97.0;
            let parts = tooth.components(roll);
            let direct = parts.bending + parts.shear + parts.axial + parts.body;
            let error = compliance.pinion.total(roll) / direct - 1.0;
            assert!(error.abs() < 1e-12, "z {teeth}, x {shift}, roll {roll}: {error:e}");
        }
    }
}

/// Invariant: a pair `k` times as large, with faces of the same width, is as stiff.
#[test]
fn stiffness_does_not_depend_on_scale() {
    for root in [RootShape::Trochoid, RootShape::CircularFillet] {
        let of = |scale: f64| {
            let mut gears = [specification(19, 0.0), specification(48, 0.0)];
            for gear in &mut gears {
                gear.module *= scale;
                gear.bore_radius *= scale;
            }
            let pair = Pair::new(gears[0], gears[1], None).unwrap();
            let (compliance, _) =
                PairCompliance::new(&METHODS[0], &Record::default(), &pair, &setting(root, true)).unwrap();
            let middle = 0.5 * (pair.start_of_contact + pair.end_of_contact);
            (pair_stiffness(&pair, &compliance, middle), compliance.gear.neighbours[0].value(0.3))
        };
        for scale in [1e-3, 0.5, 7.0, 1e3] {
            assert!((of(scale).0 / of(1.0).0 - 1.0).abs() < 1e-11, "{root:?} × {scale}");
            assert!((of(scale).1 / of(1.0).1 - 1.0).abs() < 1e-10, "{root:?} × {scale}");
        }
    }
}

/// Published value: with the bore the article did not print as the one fitted number, its two stiffnesses come out
/// together from the circular fillet, and not from the trochoid.
#[test]
fn the_articles_stiffnesses_single_out_the_circular_fillet() {
    let maxima = |ratio: f64, root| {
        let pair = pair_19_48(ratio);
        let (compliance, _) =
            PairCompliance::new(&METHODS[0], &Record::default(), &pair, &setting(root, false)).unwrap();
        let (start, end) = (pair.end_of_contact - pair.base_pitch, pair.start_of_contact + pair.base_pitch);
        let single = |s: f64| pair_stiffness(&pair, &compliance, s);
        let double = |s: f64| single(s) + single(s + pair.base_pitch);
        (maximum(single, start, end) / 1e8, maximum(double, pair.start_of_contact, start) / 1e8)
    };
    let (single, double) = maxima(1.758, RootShape::CircularFillet);
    assert!((single - 2.738).abs() < 5e-4 && (double - 4.727).abs() < 5e-4, "{single} {double}");
    let (single, double) = maxima(2.057, RootShape::Trochoid);
    assert!((single - 2.738).abs() < 5e-4 && (double - 4.775).abs() < 5e-4, "{single} {double}");
}

/// Second method: Sainsot's formula was fitted to this very ring; inside its range the two agree to a few percent (to 12 % at
/// the thin-ring end of the fit).
#[test]
fn the_ring_agrees_with_sainsots_formula_inside_its_range() {
    use super::ring::{Load, Ring};
    for (teeth, ratio) in [(30, 1.5), (30, 3.0), (60, 2.0), (60, 4.0), (100, 3.0)] {
        let mut gear = specification(teeth, 0.0);
        gear.face_width = 1.0;
        let root_radius = gear.module * (0.5 * f64::from(teeth) - 1.25);
        gear.bore_radius = root_radius / ratio;
        let pair = Pair::new(gear, gear, None).unwrap();
        let root = Root::new(&pair.pinion, RootShape::Trochoid);
        let body = Body::new(&pair.pinion, &root);
        let ring = Ring::new(gear.bore_radius, root_radius, root.half_angle, &gear.material);
        for share in [0.0, 0.5, 1.0] {
            let tip = pair.pinion.roll_at(pair.pinion.tip_radius);
            let low = pair.pinion.roll_at(pair.pinion.form_radius);
            let roll = low + (tip - low) * share;
            let angle = roll - pair.pinion.half_base_angle;
            let load = Load { across: angle.cos(), outwards: -angle.sin(), moment: pair.pinion.base_radius };
            let found = ring.influence(0.0).compliance(load, load) / body.compliance(roll);
            println!("z {teeth} h {ratio} at {share}: ring / formula = {found:.4}");
            let allowed = if ratio < 2.0 { 0.13 } else { 0.04 };
            assert!((found - 1.0).abs() < allowed, "z {teeth}, h {ratio}, at {share}: {found}");
        }
    }
}

/// Published claim (physics of coupled teeth): adding pair stiffnesses overstates double contact by some 10 % for a
/// bore of r_f/1.4, and by far more for small bores.
#[test]
fn sharing_a_body_softens_double_contact() {
    let overstated = |ratio: f64| {
        let pair = pair_19_48(ratio);
        let (c, _) =
            PairCompliance::new(&METHODS[0], &Record::default(), &pair, &setting(RootShape::Trochoid, true)).unwrap();
        let (first, second) = (pair.start_of_contact + 2.5e-3, pair.start_of_contact + 2.5e-3 + pair.base_pitch);
        let (a, b) = (1.0 / pair_stiffness(&pair, &c, first), 1.0 / pair_stiffness(&pair, &c, second));
        let across = c.pinion.neighbours[0].value(pair.roll(Side::Pinion, first))
            + c.gear.neighbours[0].value(pair.roll(Side::Gear, second));
        let coupled = (a + b - 2.0 * across) / (a * b - across * across);
        assert!(across > 0.0 && across < a.min(b));
        (1.0 / a + 1.0 / b) / coupled - 1.0
    };
    let (thick, thin) = (overstated(4.0), overstated(1.4));
    println!("pairs summed overstate double contact by {:.1} % at h 1.4, {:.1} % at h 4", thin * 100.0, thick * 100.0);
    assert!((0.05..0.20).contains(&thin) && (0.25..0.60).contains(&thick), "{thin} {thick}");
}

#[test]
fn what_a_formula_cannot_give_is_refused_with_its_reason() {
    let tabulated = |teeth: u32, bore_ratio: f64, root| {
        let mut gear = specification(teeth, 0.0);
        gear.bore_radius = gear.module * (0.5 * f64::from(teeth) - 1.25) / bore_ratio;
        let pair = Pair::new(specification(30, 0.0), gear, None).unwrap();
        PairCompliance::new(&METHODS[0], &Record::default(), &pair, &setting(root, true)).map(|(_, warnings)| warnings)
    };
    let warnings = tabulated(19, 1.75, RootShape::Trochoid).unwrap();
    assert!(
        warnings.iter().any(|warning| warning.contains("θ_f = 0.1586") && warning.contains("0.12")),
        "{warnings:?}"
    );
    assert!(matches!(tabulated(800, 1.75, RootShape::Trochoid), Err(ComplianceError::Body { .. })));
    // A tooth of 48 started at the base circle would be integrated through the body: it starts at the root circle.
    let clamped = Root::new(&pair_19_48(1.75).gear, RootShape::BaseCircle);
    assert!((clamped.clamped_height / clamped.half_angle.cos() - 0.068_25).abs() < 1e-12);
}
