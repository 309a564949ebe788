//! `tests/reference/energy_pinion.json`, every value of it.

use serde_json::Value as Json;

use super::*;

/// Tier: values computed to 40 digits by another program. Every value of the file is compared, none by name alone.
#[test]
fn every_value_of_the_reference() {
    let file: Json =
        serde_json::from_str(include_str!("../../../../../../tests/reference/energy_pinion.json")).unwrap();
    let pair = pair(1.75);
    let tabulated = energy(&pair, SUMMED).unwrap();
    let root = pair.pinion.root(RootShape::Trochoid).unwrap();
    let beam = Beam::new(&pair.pinion, &root, 1.2).unwrap();
    let body = Body::new(root.half_angle, 1.75);
    let [single_min, single_max, double_max] = extremes(&pair, &tabulated);
    let force = 50.0 / pair.pinion.base_radius;
    let zone = pair.zone_points();
    let twelve = Gear::new(&Specification { teeth: 12, bore_radius: 5e-3, ..specifications(3e-3, 1.75)[0] }).unwrap();
    assert!(twelve.undercut);
    let mut compared = 0;
    for (key, row) in file["values"].as_object().unwrap() {
        let parts: Vec<&str> = key.split('.').collect();
        let computed = match key.as_str() {
            "base_pitch" => pair.base_pitch,
            "line_T1T2" => pair.tangent_length,
            "s_A" => zone.a,
            "s_E" => zone.e,
            "contact_ratio" => pair.contact_ratio,
            "double_zone_length" => zone.b - zone.a,
            "hertz_linear_1_over_kh" => STEELS.linear() / pair.contact_width(),
            "pinion.base_radius" => pair.pinion.base_radius,
            "pinion.form_radius" => pair.pinion.form_radius,
            "pinion.tip_thickness_arc" => pair.pinion.tip_thickness(),
            "pinion.half_base_angle_alpha2" => pair.pinion.half_base_angle,
            "pinion.theta_f" => root.half_angle,
            "pinion.sainsot_L" => body.polynomials[0],
            "pinion.sainsot_M" => body.polynomials[1],
            "pinion.sainsot_P" => body.polynomials[2],
            "pinion.sainsot_Q" => body.polynomials[3],
            "pair.pitch_point.compliance" => 1.0 / mesh_stiffness(&pair, &tabulated, zone.c),
            "pair.pitch_point.stiffness" => mesh_stiffness(&pair, &tabulated, zone.c),
            "single_zone_max_stiffness" => single_max,
            "double_zone_max_stiffness" => double_max,
            "single_zone_min_stiffness" => single_min,
            "load_along_LOA" => force,
            "STEpp_unmodified" => force / single_min - force / double_max,
            "undercut_z12.gamma" => twelve.trochoid().joint(),
            "undercut_z12.junction_radius" => twelve.form_radius,
            _ if parts[0] == "approach" => approach(&pair, &tabulated, force, parts[1], parts[2]),
            _ => {
                let (name, quantity) = key.split_once(".1_over_").unwrap_or_else(|| panic!("unknown value `{key}`"));
                let radius: f64 = name.strip_prefix("pinion.r").unwrap().parse().unwrap();
                let roll = pair.pinion.roll_at(radius * 1e-3);
                let parts = beam.parts(roll);
                match quantity {
                    "kb" => parts.bending,
                    "ks" => parts.shear,
                    "ka" => parts.axial,
                    "kf" => body.compliance(&pair.pinion, roll),
                    _ => panic!("unknown value `{key}`"),
                }
            }
        };
        let scale = match row["unit"].as_str().unwrap() {
            "mm" | "mm/N" => 1e3,
            "um" => 1e6,
            "1" | "rad" | "N" | "N/m" => 1.0,
            unit => panic!("unknown unit {unit}"),
        };
        let expected: f64 = row["value"].as_str().unwrap().parse().unwrap();
        let difference = computed * scale / expected - 1.0;
        assert!(difference.abs() < 1e-12, "{key}: {} for {expected}, off by {difference:e}", computed * scale);
        compared += 1;
    }
    assert_eq!(compared, 51);
}

/// Approach \[m\] of two crowned gears with parabolic relief of both tips, uncoupled, the crown integrated exactly.
fn approach(pair: &GearPair, tabulated: &Tabulated, force: f64, design: &str, place: &str) -> f64 {
    let (amount, length, crown) = match design {
        "iso" => (7.81e-6, 5.05e-3, 6.34e-6),
        "ga" => (6.93e-6, 3.41e-3, 5.67e-6),
        _ => panic!("unknown design {design}"),
    };
    let zone = pair.zone_points();
    let positions = match place {
        "sA+1mm" => vec![zone.a + 1e-3, zone.a + 1e-3 + pair.base_pitch],
        "mid_double" => vec![0.5 * (zone.a + zone.b), 0.5 * (zone.a + zone.b) + pair.base_pitch],
        "pitch" => vec![zone.c],
        _ => panic!("unknown place {place}"),
    };
    let relief = |from_tip: f64| {
        let part = (1.0 - from_tip / length).max(0.0);
        amount * (0.44 * part + 0.56 * part * part)
    };
    let load = |w: f64| {
        let part = (w / crown).max(0.0).sqrt().min(1.0);
        w.max(0.0) * part - crown * part.powi(3) / 3.0
    };
    let contact = STEELS.linear() / pair.contact_width();
    let pairs: Vec<(f64, f64)> = positions
        .into_iter()
        .map(|s| {
            let compliance = tabulated.compliance.pinion.total(pair.roll(Side::Pinion, s))
                + tabulated.compliance.gear.total(pair.roll(Side::Gear, s))
                + contact;
            (compliance, relief(s - zone.a) + relief(zone.e - s))
        })
        .collect();
    bracketed(0.0, 1e-3, |delta| pairs.iter().map(|(c, gap)| load(delta - gap) / c).sum::<f64>() - force).unwrap()
}
