//! What searches are after: numbers of a curve, limits, fronts; and how staged ones get there.

use std::collections::BTreeMap;

use super::walk::{Ran, load, walk};
use crate::desk::Desk;
use gearmesh::optimize::hypervolume::hypervolume;
use studygraph::table::data::Table;

const PAIR: &str = "
study: t
title: T
seed: 1
stages:
  pair:
    kind: geometry
    module: 3 mm
    pressure_angle: 20 deg
    rack: { addendum: 1.0, dedendum: 1.25, tip_radius: 0.38 }
    material: { youngs_modulus: 206 GPa, poisson_ratio: 0.3 }
    pinion: { teeth: 25, face_width: 25 mm, bore_radius: 15 mm }
    gear: { teeth: 53, face_width: 25 mm, bore_radius: 30 mm }
  k: { kind: stiffness, pair: pair, coupling: body }
  base: &base
    kind: optimizer
    stiffness: k
    name: base
    at: { torque: [100 N m, 150 N m, 200 N m] }
    design:
      - tip_relief: { gear: both, amount: [0 um, 30 um], length: [0.5 mm, 6 mm], curve: linear }
";

fn ran(stages: &str) -> BTreeMap<String, Ran> {
    walk(&load(&format!("{PAIR}{stages}")))
}

fn table<'a>(ran: &'a BTreeMap<String, Ran>, stage: &str, name: &str) -> &'a Table {
    ran[stage].tables.iter().find(|table| table.name() == name).unwrap()
}

/// A number of a design, the largest over the torques.
fn worst(summary: &Table, design: &str, column: &str) -> f64 {
    let rows = (0..summary.rows()).filter(|row| summary.texts("design")[*row] == design);
    rows.map(|row| summary.floats(column)[row]).fold(f64::NEG_INFINITY, f64::max)
}

/// Tier: second method. The same method with every design as asked for, to its end: a staged search comes as near as what it
/// calls a gain, and looks at less than a quarter as many designs as asked for. What it says of the best is what `ste` says.
#[test]
fn a_staged_search_finds_the_same_with_few_designs_as_asked_for() {
    let ran = ran("
  staged: &search
    <<: *base
    name: staged
    slice_coupling: plate
    slices: 9
    method: { differential_evolution: { population: 16, generations: 30, polish: nelder_mead } }
    at: { torque: [100 N m, 200 N m] }
    design:
      - tip_relief: { gear: both, amount: [0 um, 30 um], length: [0.5 mm, 6 mm], curve: linear }
      - lead_crowning: { gear: pinion, amount: [0 um, 8 um] }
  plain: { <<: *search, name: plain, search: plain }
  ste: { kind: ste, stiffness: k, designs: [staged, plain], torque: [100 N m, 200 N m], slice_coupling: plate, slices: 9 }
");
    let objective = |stage: &str| table(&ran, stage, "best").floats("objective")[0];
    for stage in ["staged", "plain"] {
        let found = worst(table(&ran, "ste", "summary"), stage, "peak_to_peak");
        assert!((objective(stage) / found - 1.0).abs() < 1e-9, "{stage}: {} {found}", objective(stage));
    }
    let above = objective("staged") / objective("plain") - 1.0;
    println!("staged: {above:e} above plain");
    assert!(above < 1e-3, "{above:e}");
    let passes = table(&ran, "staged", "passes");
    let asked = (0..passes.rows()).filter(|row| passes.integers("slices")[*row] == 9);
    let asked: i64 = asked.map(|row| passes.integers("evaluations")[row]).sum();
    let all = table(&ran, "plain", "best").integers("evaluations")[0];
    println!("{asked} of {all} designs as asked for");
    assert!(4 * asked < all, "{asked} of {all}");
    assert_eq!(passes.texts("what")[0], "search");
    assert!(table(&ran, "plain", "passes").rows() == 1);
}

/// Tier: second method; a grid of 61 by 61 designs. A limit is kept, binds, and costs no more than it must.
#[test]
fn a_limit_is_kept_and_binds() {
    let ran = ran("
  limited: { <<: *base, name: limited, subject_to: \"unloaded_peak_to_peak <= 2.5 um\" }
  local: { <<: *base, name: local, method: nelder_mead, search: plain, subject_to: \"unloaded_peak_to_peak <= 2.5 um\" }
  grid: { <<: *base, name: grid, method: { grid: { levels: 61 } }, subject_to: \"unloaded_peak_to_peak <= 2.5 um\" }
  ste: { kind: ste, stiffness: k, designs: [base, limited], torque: [100 N m, 150 N m, 200 N m] }
");
    let objective = |stage: &str| table(&ran, stage, "best").floats("objective")[0];
    let summary = table(&ran, "ste", "summary");
    assert!(worst(summary, "base", "unloaded_peak_to_peak") > 2.6);
    let limited = worst(summary, "limited", "unloaded_peak_to_peak");
    assert!((2.4..=2.5 + 1e-6).contains(&limited), "{limited}");
    let told = table(&ran, "limited", "best").floats("unloaded_peak_to_peak")[0];
    assert!((told / limited - 1.0).abs() < 1e-9, "{told} {limited}");
    let (found, grid) = (objective("limited"), objective("grid"));
    println!("{found} {} {grid}, without a limit {}", objective("local"), objective("base"));
    assert!(found > 1.01 * objective("base") && found <= grid && found > 0.9 * grid, "{found} {grid}");
    assert!(objective("local") <= grid);
}

/// Tier: second method; the front of all designs of a grid, and what `ste` says of each point. Its designs can be loaded.
#[test]
fn a_front_is_that_of_a_grid_and_its_points_are_designs() {
    let ran = ran("
  front: { <<: *base, name: front, method: { nsga2: { population: 60, generations: 60 } }, minimize: [peak_to_peak, unloaded_peak_to_peak], front_points: 24 }
  grid: { <<: *base, name: grid, method: { grid: { levels: 61 } }, minimize: [peak_to_peak, unloaded_peak_to_peak], front_points: 400 }
  ste: { kind: ste, stiffness: k, designs: front, torque: [100 N m, 150 N m, 200 N m] }
");
    let points = |stage: &str| -> Vec<Vec<f64>> {
        let front = table(&ran, stage, "front");
        let of =
            |row: usize| ["peak_to_peak", "unloaded_peak_to_peak"].map(|column| front.floats(column)[row]).to_vec();
        (0..front.rows()).map(of).collect()
    };
    let (found, grid) = (points("front"), points("grid"));
    let volume = |points: &[Vec<f64>]| hypervolume(points, &[8.0, 12.0]);
    println!("{} {} of {} points", volume(&found), volume(&grid), grid.len());
    assert!(volume(&found) > 0.97 * volume(&grid) && volume(&found) < 1.03 * volume(&grid));
    assert!(found.len() >= 20 && found.windows(2).all(|pair| pair[0][0] < pair[1][0] && pair[0][1] > pair[1][1]));
    let summary = table(&ran, "ste", "summary");
    let front = table(&ran, "front", "front");
    for (row, point) in found.iter().enumerate() {
        for (column, value) in ["peak_to_peak", "unloaded_peak_to_peak"].iter().zip(point) {
            let of_ste = worst(summary, &front.texts("design")[row], column);
            assert!((value - of_ste).abs() <= 1e-9 * of_ste.abs(), "{row} {column}: {value} {of_ste}");
        }
    }
    let best = table(&ran, "front", "best").floats("objective")[0];
    assert!(found.iter().any(|point| point[0] == best), "the balanced point is one of the front");
}

/// Tier: second method; numbers and what counts of several cases by hand, from the tables of `ste`.
#[test]
fn any_number_of_a_curve_can_be_small() {
    let ran = ran("
  second: { <<: *base, name: second, minimize: \"harmonics[order=2].amplitude\" }
  spread: { <<: *base, name: spread, minimize: variance, at: { torque: [100 N m, 150 N m, 200 N m], combine: mean_and_spread, spread: 2 } }
  ste: { kind: ste, stiffness: k, designs: [second, spread, base], torque: [100 N m, 150 N m, 200 N m] }
");
    let harmonics = table(&ran, "ste", "harmonics");
    let amplitude = |design: &str| {
        let rows = (0..harmonics.rows())
            .filter(|row| harmonics.texts("design")[*row] == design && harmonics.integers("order")[*row] == 2);
        rows.map(|row| harmonics.floats("amplitude")[row]).fold(0.0, f64::max)
    };
    let objective = |stage: &str| table(&ran, stage, "best").floats("objective")[0];
    assert!(
        (objective("second") / amplitude("second") - 1.0).abs() < 1e-6,
        "{} {}",
        objective("second"),
        amplitude("second")
    );
    assert!(amplitude("second") < 0.9 * amplitude("base"));
    let summary = table(&ran, "ste", "summary");
    let rows = (0..summary.rows()).filter(|row| summary.texts("design")[*row] == "spread");
    let values: Vec<f64> = rows.map(|row| summary.floats("variance")[row]).collect();
    let mean = values.iter().sum::<f64>() / 3.0;
    let deviation = (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / 3.0).sqrt();
    assert!((objective("spread") / (mean + 2.0 * deviation) - 1.0).abs() < 1e-6);
}

/// Which limit no design keeps, and by how much; a box that changes nothing; a simpler design that does as well.
#[test]
fn what_cannot_be_and_what_need_not_be_is_said() {
    let desk = Desk::with("quick.yaml");
    let refused = |stages: &str| {
        std::fs::write(desk.path("goals.yaml"), format!("{PAIR}{stages}")).unwrap();
        desk.run(&["run", "goals.yaml"], 3).1
    };
    let never = refused(
        "  never: { <<: *base, name: never, subject_to: [\"largest_pressure <= 300 MPa\", \"peak_to_peak <= 9 um\"] }\n",
    );
    assert!(never.contains("no design that was tried keeps `largest_pressure <= 300 MPa` (nearest: 1009."), "{never}");
    assert!(never.contains("MPa too much)") && !never.contains("9 um"), "{never}");
    let both = refused(
        "  both: { <<: *base, name: both, subject_to: [\"unloaded_peak_to_peak <= 0.1 um\", \"peak_to_peak <= 2 um\"] }\n",
    );
    assert!(
        both.contains("each of the constraints") && both.contains("none that was tried keeps all of them"),
        "{both}"
    );
    let warned = ran("
  same: { <<: *base, name: same, minimize: largest_pressure, design: [tip_relief: { gear: both, amount: [1 um, 2 um], length: [0.5 mm, 0.6 mm] }] }
  long: { <<: *base, name: long, settled: { improvement: 1 % }, design: [tip_relief: { gear: both, amount: [5 um, 25 um], fraction: 1, curve: linear }, end_relief: { gear: pinion, amount: [0 um, 5 um], length: 3 mm }] }
  beyond: { <<: *base, name: beyond, method: { latin_hypercube: { points: 400 } }, design: [tip_relief: { gear: both, amount: [0 um, 30 um], length: [0.5 mm, 60 mm] }] }
");
    let says = |stage: &str, what: &str| warned[stage].warnings.iter().any(|warning| warning.contains(what));
    assert!(
        says("same", "every design that was tried has the same `largest_pressure`"),
        "{:?}",
        warned["same"].warnings
    );
    assert!(
        says("long", "a simpler design is as good: linear tip relief of both gears"),
        "{:?}",
        warned["long"].warnings
    );
    assert!(!says("base", "simpler"), "{:?}", warned["base"].warnings);
    // The flank is about a quarter as long as the box.
    let beyond = warned["beyond"].warnings.iter().find(|warning| warning.contains(" designs do not fit, ")).unwrap();
    let share: f64 = beyond.split("fit, ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!((60.0..90.0).contains(&share) && beyond.contains("and the first because "), "{beyond}");
    assert!(!says("base", "do not fit"), "{:?}", warned["base"].warnings);
}

/// Tier: second method; what is told of long relief is what `ste` says of a design with it. At each torque by itself, tilted too.
#[test]
fn a_curve_tells_of_a_simpler_design_that_is_as_good() {
    let stages = |amount: &str| {
        format!(
            "
  designs:
    kind: modification
    pair: pair
    designs:
      none: []
      long: [tip_relief: {{ gear: both, amount: {amount} um, fraction: 1, curve: linear }}]
      parts: [tip_relief: {{ gear: both, amount: 12 um, length: 4 mm, curve: parabolic }}, end_relief: {{ gear: pinion, amount: 1 um, length: 3 mm }}]
  within: &ste {{ kind: ste, stiffness: k, designs: designs, torque: [150 N m], helix_slope: [0 um, 5 um], simpler_within: 20 % }}
  not_asked: {{ kind: ste, stiffness: k, designs: designs, torque: [150 N m], helix_slope: [0 um, 5 um] }}
  search:
    <<: *base
    name: search
    at: {{ torque: 150 N m, helix_slope: [0 um, 20 um] }}
    design:
      - tip_relief: {{ gear: both, amount: [0 um, 30 um], length: [0.5 mm, 6 mm], curve: linear }}
      - lead_crowning: {{ gear: pinion, amount: [0 um, 12 um] }}
  as_searched: {{ kind: ste, stiffness: k, designs: search, torque: [150 N m], helix_slope: [0 um, 20 um], simpler_within: 0.1 % }}
"
        )
    };
    let of_parts =
        |ran: &BTreeMap<String, Ran>, design: &str| worst(table(ran, "within", "summary"), design, "peak_to_peak");
    let first = ran(&stages("1"));
    let said: Vec<&String> = first["within"].warnings.iter().filter(|said| said.contains("simpler")).collect();
    println!("{said:?}");
    assert!(
        said.len() == 1 && said[0].starts_with("design `parts` at 150 N m: a simpler design is as good"),
        "{said:?}"
    );
    let between = |text: &str, from: &str, to: &str| {
        let after = text.split_once(from).unwrap().1;
        after.split_once(to).unwrap().0.to_owned()
    };
    let amount = between(said[0], "gear: both, amount: ", " um");
    let [is, share] =
        ["is larger by ", "is smaller by "].map(|is| said[0].contains(is).then(|| between(said[0], is, " %")));
    let share = is.map_or_else(|| -share.unwrap().parse::<f64>().unwrap(), |larger| larger.parse().unwrap());
    let second = ran(&stages(&amount));
    let found = 100.0 * (of_parts(&second, "long") / of_parts(&second, "parts") - 1.0);
    assert!((found - share).abs() < 0.02 * share.abs() + 0.05 && found < 20.0, "{found} {share}");
    // Nothing is said where nobody asks, and where a search finds what long relief does not reach.
    for stage in ["not_asked", "search", "as_searched"] {
        assert!(
            first[stage].warnings.iter().all(|said| !said.contains("simpler")),
            "{stage}: {:?}",
            first[stage].warnings
        );
    }
}

/// Tier: second method; a plain search of 2480 designs as asked for, and `ste`. Coarse slices put the pressure elsewhere: what keeps
/// the limit in a coarse look may break it. What is found keeps it as asked for, and is as good as what keeps it.
#[test]
fn a_staged_search_keeps_a_limit_as_asked_for() {
    let ran = ran("
  designs:
    kind: modification
    pair: pair
    designs:
      free: [tip_relief: { gear: both, amount: 16.06620 um, length: 4.126276 mm, curve: linear }, lead_crowning: { gear: pinion, amount: 0.00816 um }]
      plain: [tip_relief: { gear: both, amount: 16.10582 um, length: 4.291348 mm, curve: linear }, lead_crowning: { gear: pinion, amount: 9.9202 um }]
  limited:
    kind: optimizer
    name: limited
    stiffness: k
    slice_coupling: plate
    slices: 13
    method: { differential_evolution: { population: 16, generations: 30 } }
    at: { torque: [100 N m, 200 N m], helix_slope: [0 um, 15 um] }
    subject_to: largest_pressure <= 1215 MPa
    design:
      - tip_relief: { gear: both, amount: [0 um, 30 um], length: [0.5 mm, 6 mm], curve: linear }
      - lead_crowning: { gear: pinion, amount: [0 um, 12 um] }
  ste: { kind: ste, stiffness: k, designs: [designs, limited], torque: [100 N m, 200 N m], helix_slope: [0 um, 15 um], slice_coupling: plate, slices: 13 }
");
    let of = |design: &str, column: &str| worst(table(&ran, "ste", "summary"), design, column);
    let told = |column: &str| table(&ran, "limited", "best").floats(column)[0];
    let [found, free, plain] = ["limited", "free", "plain"].map(|design| of(design, "peak_to_peak"));
    println!("{found}, by a plain search {plain}, without a limit {free}");
    for (column, is) in [("objective", found), ("largest_pressure", of("limited", "largest_pressure"))] {
        assert!((told(column) / is - 1.0).abs() < 1e-9, "{column}: {} {is}", told(column));
    }
    // The best without a limit breaks it; this one keeps it.
    assert!(free < plain && of("free", "largest_pressure") > 1300.0 && of("plain", "largest_pressure") < 1215.1);
    assert!(told("largest_pressure") <= 1215.0 * (1.0 + 1e-7), "{}", told("largest_pressure"));
    assert!(found < 1.005 * plain, "{found} {plain}");
}

/// Coarse looks find designs that keep this limit, looks as asked for none: that is what is told, with what is true of those.
#[test]
fn what_only_coarse_looks_keep_is_not_said_to_be_kept() {
    let desk = Desk::with("quick.yaml");
    let stages = "
  limited: { <<: *base, name: limited, slice_coupling: plate, slices: 9, method: { differential_evolution: { population: 8, generations: 15 } }, at: { torque: [100 N m, 200 N m], helix_slope: [0 um, 15 um] }, subject_to: largest_pressure <= 1175 MPa, design: [tip_relief: { gear: both, amount: [0 um, 30 um], length: [0.5 mm, 6 mm], curve: linear }, lead_crowning: { gear: pinion, amount: [0 um, 12 um] }] }
";
    std::fs::write(desk.path("goals.yaml"), format!("{PAIR}{stages}")).unwrap();
    let said = desk.run(&["run", "goals.yaml"], 3).1;
    let nearest = said.split_once("no design that was tried keeps `largest_pressure <= 1175 MPa` (nearest: ");
    let nearest: f64 = nearest.unwrap_or_else(|| panic!("{said}")).1.split('.').next().unwrap().parse().unwrap();
    assert!((1176.0..1200.0).contains(&nearest), "{said}");
}
