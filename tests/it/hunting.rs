//! Gears with pitch deviations as a stage.

use std::f64::consts::TAU;

use studygraph::table::data::Table;

use crate::registry::walk::{load, walk};

const TEETH: [u32; 2] = [19, 48];

fn study(of: &str, deviations: &[f64], list: &str) -> String {
    let list_of: Vec<String> = deviations.iter().map(|deviation| format!("{deviation} um")).collect();
    format!(
        "study: t\nstages:
  geometry:
    kind: geometry
    module: 3 mm
    pinion: {{ teeth: {}, face_width: 20 mm, bore_radius: 14 mm }}
    gear: {{ teeth: {}, face_width: 20 mm, bore_radius: 38 mm }}
  designs: {{ kind: modification, pair: geometry, designs: {{ plain: [] }} }}
  stiffness: {{ kind: stiffness, pair: geometry, method: energy }}
  hunting: {{ kind: hunting, stiffness: stiffness, designs: designs, torque: 500 N m, {of}: {{ {list}: [{}] }} }}
",
        TEETH[0],
        TEETH[1],
        list_of.join(", ")
    )
}

fn ran(text: &str, name: &str) -> Table {
    let ran = walk(&load(text));
    ran["hunting"].tables.iter().find(|table| table.name() == name).unwrap().clone()
}

/// Tier: closed form; a gear that runs out is off by A sin(2π i/z), and pairs of teeth that all carry load add up linearly: the error
/// has the order 1 of that gear, nearly A cos α, beside every multiple of the mesh frequency, and nothing else.
#[test]
fn an_eccentric_pinion_is_heard_once_a_turn() {
    for (index, of) in ["pinion", "gear"].into_iter().enumerate() {
        let amplitude = 5.0;
        let teeth = TEETH[index];
        let deviation = |tooth: u32| amplitude * (TAU * f64::from(tooth) / f64::from(teeth)).sin();
        let deviations: Vec<f64> = (0..teeth).map(deviation).collect();
        let table = ran(&study(of, &deviations, "cumulative"), "spectrum");
        let (orders, found) = (table.floats(&format!("{of}_order")), table.floats("amplitude"));
        let expected = amplitude * 20.0_f64.to_radians().cos();
        let mut beside = 0;
        for (order, found) in orders.iter().zip(found) {
            let whole = (order - order.round()).abs() < 1e-9;
            let from_mesh = order.round().rem_euclid(f64::from(teeth));
            if whole && from_mesh.min(f64::from(teeth) - from_mesh) <= 1.0 {
                beside += 1;
            } else {
                assert!(*found < 1e-9, "{of}, order {order}: {found} um");
            }
            if (order - 1.0).abs() < 1e-9 {
                assert!(*found > 0.95 * expected && *found < expected, "{of}: {found} of {expected}");
            }
        }
        // 1, and around both multiples of the mesh frequency: of the last not what is above it.
        assert_eq!(beside, 6, "{of}");
    }
}

/// Tier: arithmetic; total and single deviations of what was given, whichever way it was given.
#[test]
fn pitch_deviations_come_back() {
    let single: Vec<f64> = (0..TEETH[0]).map(|tooth| f64::from(tooth * tooth % 7) - 3.0).collect();
    let mean = single.iter().sum::<f64>() / f64::from(TEETH[0]);
    let mut sum = 0.0;
    let cumulative: Vec<f64> = single
        .iter()
        .map(|deviation| {
            sum += deviation - mean;
            sum
        })
        .collect();
    let [low, high] = [f64::min, f64::max].map(|pick| cumulative.iter().copied().reduce(pick).unwrap());
    let largest = single.iter().map(|deviation| (deviation - mean).abs()).fold(0.0, f64::max);
    let [one, other] = [(&single, "single"), (&cumulative, "cumulative")]
        .map(|(given, list)| ran(&study("pinion", given, list), "summary"));
    for table in [&one, &other] {
        for (column, exact) in [("pinion_cumulative_deviation", high - low), ("pinion_single_deviation", largest)] {
            let found = table.floats(column)[0];
            assert!((found - exact).abs() < 1e-9, "{column}: {found} for {exact}");
        }
        assert_eq!(table.integers("pitches")[0], 912);
        assert!(table.floats("gear_single_deviation")[0] < 1e-300);
    }
    let [one, other] = [one, other].map(|table| table.floats("peak_to_peak")[0]);
    assert!((one - other).abs() < 1e-9, "{one} {other}");
    let without = ran(&study("pinion", &vec![0.0; TEETH[0] as usize], "single"), "summary");
    let [with, alone] = ["peak_to_peak", "peak_to_peak_without_deviations"].map(|column| without.floats(column)[0]);
    assert!(with <= alone && with > 0.99 * alone, "{with} of {alone}");
}
