//! The tables on demand that put articles' own samples and sweeps beside the integral ones.

use super::walk::{load, walk};

const STAGES: &str = "
study: t
stages:
  pair:
    kind: geometry
    module: 3 mm
    pinion: { teeth: 30, face_width: 10 mm, bore_radius: 20 mm }
    gear: { teeth: 40, face_width: 10 mm, bore_radius: 28 mm }
  k: { kind: stiffness, pair: pair }
  designs: { kind: modification, pair: pair, designs: { none: [], arc: [arc: { gear: both, tip_share: 0.02, length_share: 0.2 }] } }
  sweep:
    kind: optimizer
    stiffness: k
    method: { grid: { levels: 5 } }
    minimize: variance
    positions: 8
    at: { torque: 300 N m }
    design:
      - arc: { gear: pinion, tip_share: [0.02, 0.10], length_share: [0.05, 0.25] }
      - arc: { gear: gear, tip_share: [0.02, 0.10], length_share: [0.05, 0.25] }
  plain: { kind: ste, stiffness: k, designs: designs, torque: [200 N m, 300 N m] }
  turned: { kind: ste, stiffness: k, designs: designs, torque: 300 N m, first_sample: 25 deg }
  dense: { kind: ste, stiffness: k, designs: designs, torque: 300 N m, samples: 20000, first_sample: 0.0003 deg }
";

#[test]
fn samples_are_points_of_the_curve_and_their_fitness_is_that_of_the_article() {
    let ran = walk(&load(STAGES));
    let table = |stage: &str, name: &str| ran[stage].tables.iter().find(|table| table.name() == name).unwrap();
    let of = |stage: &str, name: &str, column: &str, design: &str, torque: f64| -> Vec<f64> {
        let found = table(stage, name);
        (0..found.rows())
            .filter(|&row| found.texts("design")[row] == design && found.floats("torque")[row] == torque)
            .map(|row| found.floats(column)[row])
            .collect()
    };
    for design in ["none", "arc"] {
        for torque in [200.0, 300.0] {
            let angles = of("plain", "samples", "rotation_angle", design, torque);
            assert_eq!(angles, (0..12).map(f64::from).collect::<Vec<_>>());
            let errors = of("plain", "samples", "transmission_error", design, torque);
            assert_eq!(errors[0], of("plain", "curve", "transmission_error", design, torque)[0]);
            let mean = errors.iter().sum::<f64>() / 12.0;
            let squares: f64 = errors.iter().map(|error| (error - mean).powi(2)).sum();
            let fitness = of("plain", "sample_summary", "fitness", design, torque)[0];
            assert!((fitness * squares / 12.0 - 1.0).abs() < 1e-12);
            let range =
                errors.iter().copied().fold(f64::MIN, f64::max) - errors.iter().copied().fold(f64::MAX, f64::min);
            assert!((of("plain", "sample_summary", "peak_to_peak", design, torque)[0] - range).abs() < 1e-12);
            // Twelve samples are not the curve.
            assert!(range < of("plain", "summary", "peak_to_peak", design, torque)[0]);
        }
        // Two pitches and a twelfth further: every sample is its successor.
        let [plain, turned] =
            ["plain", "turned"].map(|stage| of(stage, "samples", "transmission_error", design, 300.0));
        for (index, value) in turned.iter().enumerate() {
            assert!((value - plain[(index + 1) % 12]).abs() < 1e-9, "{index}");
        }
        // Many samples are: first order in their distance where the curve jumps.
        for column in ["mean", "variance"] {
            let [sampled, whole] = [
                of("dense", "sample_summary", column, design, 300.0)[0],
                of("dense", "summary", column, design, 300.0)[0],
            ];
            assert!((sampled / whole - 1.0).abs() < 1e-3, "{column}: {sampled} {whole}");
        }
    }
}

#[test]
fn a_grid_of_625_designs_is_a_table_with_exact_levels() {
    let ran = walk(&load(STAGES));
    let table = |name: &str| ran["sweep"].tables.iter().find(|table| table.name() == name).unwrap();
    let all = table("evaluations");
    assert_eq!(all.rows(), 625);
    let variables = ["pinion_arc_tip_share", "pinion_arc_length_share", "gear_arc_tip_share", "gear_arc_length_share"];
    let levels = [[0.02, 0.04, 0.06, 0.08, 0.10], [0.05, 0.10, 0.15, 0.20, 0.25]];
    for row in 0..625 {
        for (place, name) in variables.iter().enumerate() {
            let digit = row / 5_usize.pow(3 - u32::try_from(place).unwrap()) % 5;
            assert!((all.floats(name)[row] - levels[place % 2][digit]).abs() < 1e-16);
        }
        assert!((all.floats("objective")[row] * all.floats("fitness")[row] - 1.0).abs() < 1e-15);
    }
    let minimum = (0..625).min_by(|a, b| all.floats("objective")[*a].total_cmp(&all.floats("objective")[*b])).unwrap();
    assert_eq!(all.floats("objective")[minimum], table("best").floats("objective")[0]);
    for name in variables {
        assert_eq!(all.floats(name)[minimum], table("best").floats(name)[0]);
    }
}
