//! Pressures through whole studies: columns, units, rows, demand, threads, what is warned of.

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use gearmesh::gear::work::{CONTACT_PRESSURES, CONTACT_SOLVES};
use gearstudy::program;
use studygraph::runner::events::Silent;
use studygraph::runner::execute::execute;
use studygraph::runner::options::{Options, Wanted};
use studygraph::runner::outcome::Outcome;
use studygraph::stage::Want;
use studygraph::store::cache::Cache;
use studygraph::table::data::{Data, Table};

const SUMMARY: [&str; 7] = [
    "largest_pressure",
    "pressure_position",
    "pressure_roll_angle",
    "pressure_pair",
    "pressure_z",
    "pressure_half_width",
    "corner_load_share",
];
const CURVE: [&str; 15] = [
    "pressure",
    "coming_pressure",
    "coming_half_width",
    "newest_pressure",
    "newest_half_width",
    "second_pressure",
    "second_half_width",
    "third_pressure",
    "third_half_width",
    "fourth_pressure",
    "fourth_half_width",
    "fifth_pressure",
    "fifth_half_width",
    "sixth_pressure",
    "sixth_half_width",
];
const RESOLVED: &str = "method: { finite_element: { elements_across: 6 } }, torque: 100 N m";

/// The pair 19/48, with and without a relief that keeps the load from the corners, and with a crown.
fn study(stiffness: &str, ste: &str) -> String {
    format!(
        "study: pressures
title: Pressures
seed: 1
stages:
  pair:
    kind: geometry
    module: 3 mm
    pressure_angle: 20 deg
    rack: {{ addendum: 1.0, dedendum: 1.25, tip_radius: 0.38 }}
    material: {{ youngs_modulus: 206 GPa, poisson_ratio: 0.3 }}
    pinion: {{ teeth: 19, face_width: 20 mm, bore_radius: 15 mm }}
    gear: {{ teeth: 48, face_width: 18 mm, bore_radius: 38 mm }}
  stiffness: {{ kind: stiffness, pair: pair, {stiffness} }}
  designs:
    kind: modification
    pair: pair
    designs:
      crowned: [lead_crowning: {{ gear: pinion, amount: 8 um }}]
      relieved: [tip_relief: {{ gear: both, amount: 40 um, length: 5 mm, curve: parabolic }}]
      unmodified: []
  ste: {{ kind: ste, stiffness: stiffness, designs: [designs], torque: [50 N m, 100 N m], slices: 17, {ste} }}
"
    )
}

fn run(text: &str, jobs: usize, [summary, curve, map]: [&[&str]; 3]) -> (Outcome, Vec<Table>) {
    let study = program::load_text(text, Path::new("pressures.yaml")).unwrap_or_else(|error| panic!("{error}"));
    let folder = tempfile::tempdir().unwrap();
    let cache = Cache::open(folder.path()).unwrap();
    let want = |table: &str, columns: &[&str]| {
        let columns = columns.iter().map(|&column| column.to_owned()).collect();
        Wanted { stage: "ste".to_owned(), want: Want { table: table.to_owned(), columns } }
    };
    let mut wanted = vec![want("summary", summary), want("curve", curve)];
    wanted.extend(map.iter().map(|table| want(table, &[])));
    let names: Vec<String> = wanted.iter().map(|wanted| wanted.want.table.clone()).collect();
    let outcome =
        execute(&study, &cache, &Options { jobs, wanted, ..Options::default() }, &Silent, &AtomicBool::new(false));
    let outcome = outcome.unwrap();
    assert_eq!(outcome.faults().count(), 0);
    let tables = names.iter().map(|table| outcome.table(&cache, "ste", table).unwrap()).collect();
    (outcome, tables)
}

fn warnings(outcome: &Outcome) -> Vec<&str> {
    let warnings = outcome.stage("ste").unwrap().warnings.iter().map(String::as_str);
    warnings.filter(|text| text.contains("corner")).collect()
}

fn rows(table: &Table, design: &str, torque: f64) -> Vec<usize> {
    let (designs, torques) = (table.texts("design"), table.floats("torque"));
    (0..table.rows()).filter(|&row| designs[row] == design && (torques[row] - torque).abs() < 1.0).collect()
}

/// Tables against each other: the largest of the summary is that of the curve and of its pairs, at its place; the map adds up to
/// the torque and comes near it.
#[test]
fn summary_curve_and_map_tell_the_same() {
    for (stiffness, ste, newest) in [
        (RESOLVED, "pressure_positions: 16", 0),
        (RESOLVED, "pressure_positions: 16, corner_contact: exact, slice_coupling: plate", 1),
        (
            "method: energy, contact: load_dependent, torque: 100 N m",
            "pressure_positions: 16, corner_contact: exact",
            1,
        ),
    ] {
        let (outcome, tables) = run(&study(stiffness, ste), 0, [&SUMMARY, &CURVE, &["pressure"]]);
        let [summary, curve, map] = &tables[..] else { panic!() };
        for design in ["crowned", "relieved", "unmodified"] {
            for torque in [50.0, 100.0] {
                let at = rows(summary, design, torque)[0];
                let of = |name: &str| summary.floats(name)[at];
                let largest = of("largest_pressure");
                let points = rows(curve, design, torque);
                let most = |names: &[&str]| {
                    let all = names.iter().flat_map(|name| points.iter().map(|&row| curve.floats(name)[row]));
                    all.fold(0.0, f64::max)
                };
                let pairs: Vec<&str> = CURVE[1..].iter().copied().filter(|name| name.ends_with("pressure")).collect();
                for found in [most(&["pressure"]), most(&pairs)] {
                    assert!(found <= largest * (1.0 + 1e-9) && found > 0.97 * largest, "{design} {found} {largest}");
                }
                for &row in &points {
                    let pairs = pairs.iter().map(|name| curve.floats(name)[row]).fold(0.0, f64::max);
                    assert!((pairs / curve.floats("pressure")[row] - 1.0).abs() < 1e-9, "{design} {pairs}");
                }
                // Half the width is 2 p/(π p_max), where no corner is near; p is the load of a single pair.
                let (position, half) = (of("pressure_position"), of("pressure_half_width"));
                let force = torque / 26.781_240e-3;
                if design == "relieved" {
                    let load = std::f64::consts::FRAC_PI_2 * largest * 1e6 * half * 1e-6 * 18e-3;
                    assert!((load / force - 1.0).abs() < 2e-4, "{load} {force}");
                    assert!(of("pressure_z").is_nan());
                    let roll = (position + 2.009_267) / 26.781_240;
                    assert!((of("pressure_roll_angle").to_radians() - roll).abs() < 1e-4, "{roll}");
                    assert_eq!(summary.integers("pressure_pair")[at], 0);
                }
                assert_eq!(of("pressure_z").is_nan(), design != "crowned");
                // The map.
                let cells = rows(map, design, torque);
                let strips = if design == "crowned" { 17 } else { 1 };
                let width = 18e-3 / f64::from(strips);
                let step = |row: usize| map.integers("step")[row];
                for residue in 0..16 {
                    let here = cells.iter().filter(|&&row| step(row).rem_euclid(16) == residue);
                    let sum: f64 = here.map(|&row| map.floats("load_per_width")[row] * 1e3 * width).sum();
                    let off = if design == "crowned" { 1e-6 } else { 1e-7 };
                    assert!((sum / force - 1.0).abs() < off, "{design} {sum} {force}");
                }
                let found = cells.iter().map(|&row| map.floats("pressure")[row]).fold(0.0, f64::max);
                assert!(found <= largest * (1.0 + 1e-9) && found > 0.93 * largest, "{design} {found} {largest}");
                assert!(cells.iter().all(|&row| map.integers("strip")[row] <= i64::from(strips)));
                let before = cells.iter().any(|&row| step(row) < 0 && map.floats("load_per_width")[row] > 0.0);
                assert!(!before || (newest == 1 && design != "relieved"), "{design}");
                // Corners: a relief keeps the load from them.
                let share = of("corner_load_share");
                let Some(Data::Flag(flags)) = map.column("at_corner") else { panic!() };
                let flagged = cells.iter().any(|&row| flags[row]);
                assert_eq!(share > 0.0, design != "relieved", "{design} {share}");
                assert!(!flagged || design != "relieved");
            }
        }
        let warned = warnings(&outcome);
        // Each torque is a chunk of its own, and what they say is one.
        let warned: Vec<_> = warned.into_iter().filter(|text| !text.contains("`corner_contact` is `none`")).collect();
        let [text] = &warned[..] else { panic!("{warned:?}") };
        let resolved = stiffness == RESOLVED;
        let told = rows(&tables[0], "crowned", 50.0).into_iter().chain(rows(&tables[0], "crowned", 100.0));
        let told = told.chain(rows(&tables[0], "unmodified", 50.0)).chain(rows(&tables[0], "unmodified", 100.0));
        let most = told.map(|row| tables[0].floats("corner_load_share")[row]).fold(0.0, f64::max);
        assert!(text.contains(&format!("It has up to {:.1} % of the load, on ", 100.0 * most)), "{text} {most}");
        let end =
            "This is the worst of 4: `crowned`, `unmodified` at 50 to 100 N m; `summary.corner_load_share` has each";
        assert!(text.ends_with(end), "{text}");
        assert_eq!(text.contains("a contact that just reaches it"), resolved, "{text}");
        assert_eq!(text.contains("this law of contact does not know it"), !resolved, "{text}");
    }
}

/// Counted: what nobody asks for is neither computed nor warned of; pairs take one solve a row more, the map one a position.
#[test]
fn pressures_cost_nothing_when_nobody_asks() {
    let text = study("method: energy, contact: load_dependent, torque: 100 N m", "corner_contact: exact");
    let work = |summary: &[&str], curve: &[&str], map: &[&str]| {
        let (outcome, tables) = run(&text, 0, [summary, curve, map]);
        let stage = outcome.stage("ste").unwrap();
        let warned = warnings(&outcome).len();
        (stage.work.count(&CONTACT_SOLVES), stage.work.count(&CONTACT_PRESSURES), warned, tables[1].rows() as u64)
    };
    let (solves, pressures, warned, points) = work(&[], &[], &[]);
    assert_eq!((pressures, warned), (0, 0));
    let (again, pressures, warned, _) = work(&SUMMARY, &CURVE[..1], &[]);
    assert!(pressures > 0 && warned == 1);
    let (pairs, ..) = work(&SUMMARY, &CURVE, &[]);
    assert_eq!(pairs, again + points);
    let (mapped, ..) = work(&SUMMARY, &CURVE[..1], &["pressure"]);
    assert_eq!(mapped, again + 6 * 32, "{solves}");
}

#[test]
fn any_number_of_threads_gives_the_same_pressures() {
    let bits = |jobs: usize| {
        let text = study(RESOLVED, "corner_contact: exact, pressure_positions: 8");
        let (_, tables) = run(&text, jobs, [&SUMMARY, &CURVE, &["pressure"]]);
        let column =
            |table: &Table, name: &str| -> Vec<u64> { table.floats(name).iter().map(|v| v.to_bits()).collect() };
        let of_summary = SUMMARY.iter().filter(|name| **name != "pressure_pair").map(|name| column(&tables[0], name));
        let of_curve = CURVE.iter().map(|name| column(&tables[1], name));
        let of_map = ["load_per_width", "pressure", "half_width", "z"].iter().map(|name| column(&tables[2], name));
        of_summary.chain(of_curve).chain(of_map).collect::<Vec<_>>()
    };
    let one = bits(1);
    assert!(one.iter().flatten().collect::<BTreeSet<_>>().len() > 1000, "they differ");
    for jobs in [2, 5] {
        assert!(one == bits(jobs), "{jobs} threads");
    }
}
