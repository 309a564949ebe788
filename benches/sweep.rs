//! Sweeps: what a row takes, and how that goes with rows, torques of a design, and pairs.

use std::fmt::Write;

use std::time::Instant;

use crate::article::Stages;

const BASE: &str = "\
study: sweeps
stages:
  pair:
    kind: geometry
    module: 3 mm
    pinion: { teeth: 19, face_width: 20 mm, bore_radius: 14.079 mm }
    gear: { teeth: 48, face_width: 18 mm, bore_radius: 38.823 mm }
  designs:
    kind: modification
    pair: pair
    designs:
      relieved:
        - lead_crowning: { gear: pinion, amount: 6 um }
        - tip_relief: { gear: both, amount: 8 um, length: 5 mm, curve: parabolic }
  ste: { kind: ste, stiffness: stiffness, designs: designs, torque: 50 N m, positions: 16, harmonics: 3 }
";
const ENERGY: &str = "  stiffness: { kind: stiffness, pair: pair, coupling: none }\n";
const MESHED: &str = "  stiffness: { kind: stiffness, pair: pair, method: finite_element, torque: 50 N m }\n";
const ALL: &str = "peak_to_peak, mean, \"harmonics[order=3].amplitude\", largest_pressure";

/// A sweep of so many pairs, amounts and torques.
fn sweep(stiffness: &str, [pairs, amounts, torques]: [usize; 3], outputs: &str) -> Stages {
    let mut text =
        format!("{BASE}{stiffness}  sweep:\n    kind: sweep\n    of: ste\n    outputs: [{outputs}]\n    vary:\n");
    let mut axis = |name: &str, field: &str, from: &str, to: &str, count: usize| {
        let values =
            if count > 1 { format!("from: {from}, to: {to}, count: {count}") } else { format!("values: {to}") };
        writeln!(text, "      {name}: {{ field: \"{field}\", {values} }}").expect("a string takes all");
    };
    if pairs > 1 {
        axis("width", "pair.gear.face_width", "10 mm", "18 mm", pairs);
    }
    axis("amount", "designs.designs.relieved[1].tip_relief.amount", "1 um", "20 um", amounts);
    axis("torque", "ste.torque", "2 N m", "200 N m", torques);
    if stiffness == MESHED {
        text = text.replace("harmonics: 3 }", "harmonics: 3, corner_contact: exact }");
    }
    let folder = tempfile::tempdir().expect("there is a place for temporary files");
    let path = folder.path().join("sweeps.yaml");
    std::fs::write(&path, text).expect("the folder is ours");
    let mut stages = Stages::at(&path);
    stages.prepare("sweep");
    stages
}

/// Seconds that a run takes, the best of three.
fn seconds(stages: &Stages) -> f64 {
    let once = |_| {
        let began = Instant::now();
        std::hint::black_box(stages.run("sweep"));
        began.elapsed().as_secs_f64()
    };
    (0..3).map(once).fold(f64::INFINITY, f64::min)
}

/// Times of one row of the first line are 1.
pub fn print() {
    println!("\nStage sweep, energy method, linear, crowned and relieved, 16 positions, all threads\n");
    println!("{:<64} {:>9} {:>9} {:>7}", "rows", "ms", "µs a row", "ratio");
    let mut first = None;
    let mut line = |name: &str, stiffness: &str, counts: [usize; 3], outputs: &str| {
        let stages = sweep(stiffness, counts, outputs);
        let (taken, rows) = (seconds(&stages), counts.iter().product::<usize>() as f64);
        let each = taken * 1e6 / rows;
        let one = *first.get_or_insert(each);
        println!("{name:<64} {:>9.1} {each:>9.2} {:>7.2}", taken * 1e3, each / one);
    };
    line("1,000: 100 amounts, 10 torques", ENERGY, [1, 100, 10], ALL);
    line("10,000: 100 amounts, 100 torques", ENERGY, [1, 100, 100], ALL);
    line("100,000: 1,000 amounts, 100 torques", ENERGY, [1, 1000, 100], ALL);
    line("10,000: 10,000 amounts, 1 torque", ENERGY, [1, 10_000, 1], ALL);
    line("10,000: 10 amounts, 1,000 torques", ENERGY, [1, 10, 1000], ALL);
    line("10,000: 10 pairs, 10 amounts, 100 torques", ENERGY, [10, 10, 100], ALL);
    line("10,000: 1,000 pairs, 10 amounts, 1 torque", ENERGY, [1000, 10, 1], ALL);
    line("10,000, peak-to-peak alone", ENERGY, [1, 100, 100], "peak_to_peak");
    line("10,000, peak-to-peak and mean", ENERGY, [1, 100, 100], "peak_to_peak, mean");
    line("2,000, finite elements, resolved contact, corner contact", MESHED, [1, 20, 100], ALL);
    line("200 from table to table", ENERGY, [1, 10, 20], "peak_to_peak, corner_load_share");
}
