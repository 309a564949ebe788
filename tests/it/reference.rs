//! The 40-digit reference through the whole chain: one study's text in, tables out; and relations in closed form through
//! the stage `ste`. That the pieces meet the reference is tested beside them; here, that nothing is lost on the way.

use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;

use serde_json::Value;

use crate::registry::walk::{Ran, demand, load, walk};
use declare::seed::Seed;
use declare::work::Tally;
use gearmesh::gear::compliance::{ContactLaw, PairCompliance, ToothCompliance};
use gearmesh::gear::contact::gap::Gaps;
use gearmesh::gear::geometry::Side;
use gearmesh::gear::material::Plane;
use gearmesh::gear::mesh::{Mesh, Settings};
use gearmesh::numeric::chebyshev::Series;
use gearstudy::stage::designs;
use gearstudy::stage::{Context, Inputs, compliance, pair};
use studygraph::table::data::Table;

/// ρ_fP = c/(1 − sin α) and r_f/1.75, as the reference has them. Its crowning of 6.34 and 5.67 µm is that at the ends of
/// the common face of 18 mm; at the ends of the pinion's own 20 mm it is (20/18)² times as deep.
const STUDY: &str = "
study: chain
stages:
  pair:
    kind: geometry
    module: 3 mm
    pressure_angle: 20 deg
    rack: { addendum: 1.0, dedendum: 1.25, tip_radius: RHO }
    material: { youngs_modulus: 206 GPa, poisson_ratio: 0.3 }
    pinion: { teeth: 19, face_width: 20 mm, bore_radius: 14.142857142857142 mm }
    gear: { teeth: 48, face_width: 18 mm, bore_radius: 39 mm }
  stiffness: { kind: stiffness, pair: pair, method: energy, root: trochoid, contact: linear, coupling: none }
  designs:
    kind: modification
    pair: pair
    designs:
      unmodified: []
      iso:
        - tip_relief: { gear: both, amount: 7.81 um, length: 5.05 mm, curve: parabolic }
        - lead_crowning: { gear: pinion, amount: 7.827160493827161 um }
      ga:
        - tip_relief: { gear: both, amount: 6.93 um, length: 3.41 mm, curve: parabolic }
        - lead_crowning: { gear: pinion, amount: 7 um }
      long: [tip_relief: { gear: both, amount: 7 um, fraction: 1 }]
      short: [tip_relief: { gear: both, amount: 7 um, fraction: 0.5 }]
  ste: { kind: ste, stiffness: stiffness, designs: designs, torque: [10 N m, 50 N m, 75 N m] }
";

fn chain() -> BTreeMap<String, Ran> {
    let rho = 0.25 / (1.0 - libm::sin(20_f64.to_radians()));
    assert!((rho * 3.0 - 1.139_852_523_435_553).abs() < 1e-14);
    walk(&load(&STUDY.replace("RHO", &rho.to_string())))
}

fn table<'a>(ran: &'a BTreeMap<String, Ran>, stage: &str, name: &str) -> &'a Table {
    ran[stage].tables.iter().find(|table| table.name() == name).unwrap()
}

fn reference() -> BTreeMap<String, f64> {
    let file: Value = serde_json::from_str(include_str!("../reference/energy_pinion.json")).unwrap();
    let values = file["values"].as_object().unwrap().iter();
    values.map(|(name, entry)| (name.clone(), entry["float"].as_f64().unwrap())).collect()
}

#[track_caller]
fn close(name: &str, computed: f64, expected: f64, relative: f64) {
    assert!((computed / expected - 1.0).abs() < relative, "{name}: {computed}, reference {expected}");
}

#[test]
fn a_study_s_tables_meet_the_reference() {
    let (ran, reference) = (chain(), reference());
    let stiffness = table(&ran, "stiffness", "summary");
    for (column, name) in [
        ("single_max", "single_zone_max_stiffness"),
        ("single_min", "single_zone_min_stiffness"),
        ("double_max", "double_zone_max_stiffness"),
    ] {
        close(column, stiffness.floats(column)[0], reference[name], 1e-9);
    }
    let summary = table(&ran, "ste", "summary");
    let row = |design: &str, torque: f64| {
        let is_it = |row: &usize| summary.texts("design")[*row] == design && summary.floats("torque")[*row] == torque;
        (0..summary.rows()).find(is_it).unwrap()
    };
    let peak_to_peak = summary.floats("peak_to_peak")[row("unmodified", 50.0)];
    close("peak_to_peak", peak_to_peak, reference["STEpp_unmodified"], 1e-9);
    close("peak_to_peak", peak_to_peak, 3.000_883_377, 1e-9);
    let gears = table(&ran, "pair", "gears");
    let pinion = gears.texts("gear").iter().position(|gear| gear == "pinion").unwrap();
    close("base_radius", gears.floats("base_radius")[pinion], reference["pinion.base_radius"], 1e-14);
    close("form_radius", gears.floats("form_radius")[pinion], reference["pinion.form_radius"], 1e-12);
    let pair = table(&ran, "pair", "pair");
    close("contact_ratio", pair.floats("contact_ratio")[0], reference["contact_ratio"], 1e-14);
}

/// Invariant: what the summary says of a curve is what the rows of the curve say.
#[test]
fn summaries_agree_with_their_curves() {
    let ran = chain();
    let (summary, curve) = (table(&ran, "ste", "summary"), table(&ran, "ste", "curve"));
    for row in 0..summary.rows() {
        let (design, torque) = (&summary.texts("design")[row], summary.floats("torque")[row]);
        let its = |at: &usize| curve.texts("design")[*at] == *design && curve.floats("torque")[*at] == torque;
        let points: Vec<usize> = (0..curve.rows()).filter(its).collect();
        assert!(points.len() >= 64, "{design}");
        let value = |column: &str| summary.floats(column)[row];
        let along = |column: &str| points.iter().map(|at| curve.floats(column)[*at]).collect::<Vec<f64>>();
        let (minimum, maximum) = (f64::min as fn(f64, f64) -> f64, f64::max as fn(f64, f64) -> f64);
        let error = along("transmission_error");
        let [lowest, highest] =
            [(f64::INFINITY, minimum), (0.0, maximum)].map(|(from, pick)| error.iter().copied().fold(from, pick));
        // The extrema are among the rows.
        let (minimum, maximum) = (value("minimum"), value("maximum"));
        assert!((minimum - lowest).abs() < 1e-12, "{design} {torque}: {minimum} {lowest}");
        assert!((maximum - highest).abs() < 1e-12, "{design} {torque}: {maximum} {highest}");
        assert!((maximum - minimum - value("peak_to_peak")).abs() < 1e-12, "{design} {torque}");
        assert!(minimum < value("mean") && value("mean") < maximum);
        // Popoviciu's bound on a variance.
        assert!(value("variance") <= 0.25 * value("peak_to_peak").powi(2) * (1.0 + 1e-12));
        assert!((value("variance") * value("reciprocal_variance") - 1.0).abs() < 1e-14);
        let share =
            along("newest_load_share").into_iter().fold(0.0, |maximum: f64, share| maximum.max(share).max(1.0 - share));
        assert!(share <= value("largest_load_share") + 1e-12, "{design} {torque}");
        let pressure = along("pressure").into_iter().fold(0.0, f64::max);
        assert!((pressure / value("largest_pressure") - 1.0).abs() < 1e-3, "{design} {torque}: {pressure}");
    }
}

/// What another stage reads from the tables is the pair, the compliance and the designs, to the last digits. The reference
/// takes the gap on the line of action: with it, equilibrium by hand gives its digits; with the least gap, those of `ste`.
#[test]
fn modified_designs_meet_the_reference_at_three_mesh_positions() {
    let (ran, reference) = (chain(), reference());
    let pair = pair::read(table(&ran, "pair", "gears"), table(&ran, "pair", "pair")).unwrap();
    let stiffness = |name| table(&ran, "stiffness", name);
    let compliance = compliance::read(stiffness("compliance"), stiffness("neighbours"), stiffness("model")).unwrap();
    let cycle = Mesh::new(&pair, &compliance, Settings::default()).unwrap();
    let families = gearmesh::gear::modification::members();
    let named = designs::read(table(&ran, "designs", "designs"), table(&ran, "designs", "elements"), families).unwrap();
    let pitch_point = pair.pinion.reference_radius * libm::sin(pair.working_pressure_angle);
    let double = (pair.contact_ratio - 1.0) * pair.base_pitch;
    let contact = 4.0 * (1.0 - 0.09) / (std::f64::consts::PI * 206e9 * 18e-3);
    let mut compared = 0;
    for (name, expected) in reference.iter().filter(|(name, _)| name.starts_with("approach.")) {
        let (design, place) = name.strip_prefix("approach.").unwrap().split_once('.').unwrap();
        let (position, pairs) = match place {
            "sA+1mm" => (1e-3, 2),
            "mid_double" => (0.5 * double, 2),
            "pitch" => (pitch_point - pair.start_of_contact, 1),
            other => panic!("{other}"),
        };
        let built = named.iter().find(|named| named.name == design).unwrap().built(&pair).unwrap();
        let profiles = built.profiles(0.0);
        let gaps = Gaps::new(&pair, &profiles);
        let edge = built.lead(9e-3);
        let by_hand = |gap: &dyn Fn(f64, [f64; 2]) -> f64| {
            let load = |approach: f64| {
                let one = |index: usize| {
                    let s = pair.start_of_contact + position + pair.base_pitch * index as f64;
                    let rolls = [s / pair.pinion.base_radius, (pair.tangent_length - s) / pair.gear.base_radius];
                    let teeth = compliance.pinion.total(rolls[0]) + compliance.gear.total(rolls[1]);
                    // A crown of this height at the edges, pressed in by w: k (w t − C t³/3).
                    let w = (approach - gap(s, rolls)).max(0.0);
                    let t = if w >= edge { 1.0 } else { (w / edge).sqrt() };
                    (w * t - edge * t * t * t / 3.0) / (teeth + contact)
                };
                (0..pairs).map(one).sum::<f64>() - 50.0 / pair.pinion.base_radius
            };
            1e6 * gearmesh::numeric::crossing::bracketed(0.0, 1e-4, load).unwrap()
        };
        let on_line =
            |_: f64, [pinion, gear]: [f64; 2]| built.depth(Side::Pinion, pinion) + built.depth(Side::Gear, gear);
        close(name, by_hand(&on_line), *expected, 1e-11);
        let state = cycle.loaded(&built, 50.0).state(position, pairs);
        close(name, state.transmission_error() * 1e6, by_hand(&|s, _| gaps.at(s).unwrap()), 1e-11);
        compared += 1;
    }
    assert_eq!(compared, 6);
}

/// Harris' relations for a pair stiffness k that is the same everywhere, handed to `ste` as tables: nothing F/2k, long
/// linear relief |F/k − C|/2 at every load, short linear relief F/2k; unloaded C/2 and nothing.
#[test]
fn harris_relations_hold_through_the_stage() {
    const STIFFNESS: f64 = 2.8e8;
    let study = load(&STUDY.replace("RHO", "0.38"));
    let ran = walk(&study);
    let contact = 4.0 * (1.0 - 0.09) / (std::f64::consts::PI * 206e9 * 18e-3);
    let constant = |value: f64| Series::from_values(0.0, 2.0, &[value; 3]);
    let tooth = || ToothCompliance {
        bending: constant(0.5 * (1.0 / STIFFNESS - contact)),
        shear: constant(0.0),
        axial: constant(0.0),
        body: constant(0.0),
        contact_depth: constant(2.5e-3),
        corner: 0.0,
        inclined: None,
        neighbours: Vec::new(),
    };
    let elastic = PairCompliance {
        pinion: tooth(),
        gear: tooth(),
        contact: Some(ContactLaw::Linear),
        plane: Plane::Strain,
        coupled: false,
    };
    let pair = pair::read(table(&ran, "pair", "gears"), table(&ran, "pair", "pair")).unwrap();
    let radii = [pair.pinion.base_radius, pair.gear.base_radius];
    let written = compliance::write(&elastic, radii, "energy", "trochoid").unwrap();

    let stage = &study.nodes.iter().find(|node| node.name == "ste").unwrap().stage;
    let mut inputs = Inputs::default();
    inputs.ports.insert("pair".to_owned(), ran["pair"].tables.iter().collect());
    inputs.ports.insert("stiffness".to_owned(), written.iter().collect());
    inputs.ports.insert("designs_1".to_owned(), ran["designs"].tables.iter().collect());
    let (demand, stop) = (demand(stage.as_ref(), false), AtomicBool::new(false));
    let context = Context {
        seed: Seed::of_stage(1, "ste"),
        demand: &demand,
        stop: &stop,
        progress: &|_| (),
        warn: &|_| (),
        is_heard: true,
        work: &Tally::default(),
    };
    let tables = stage.run(&context, &inputs).unwrap();
    let summary = tables.iter().find(|table| table.name() == "summary").unwrap();
    let families = gearmesh::gear::modification::members();
    let named = designs::read(table(&ran, "designs", "designs"), table(&ran, "designs", "elements"), families).unwrap();
    let mut seen = 0;
    for row in 0..summary.rows() {
        let (design, torque) = (summary.texts("design")[row].as_str(), summary.floats("torque")[row]);
        let deflection = 1e6 * torque / pair.pinion.base_radius / STIFFNESS;
        let (loaded, unloaded) = match design {
            "long" => (0.5 * (deflection - 7.0).abs(), 3.5),
            "unmodified" | "short" => (0.5 * deflection, 0.0),
            _ => continue,
        };
        let found = [summary.floats("peak_to_peak")[row], summary.floats("unloaded_peak_to_peak")[row]];
        if design == "unmodified" {
            assert!((found[0] - loaded).abs() < 1e-9 * deflection.max(7.0), "{torque}: {} {loaded}", found[0]);
            assert!(found[1].abs() < 1e-9, "{torque} unloaded: {}", found[1]);
            seen += 1;
            continue;
        }
        // The relations take the gap on the line of action, to which the least one of a relief is close.
        let close = |found: f64, relation: f64| (found - relation).abs() < 0.006 * 7.0;
        assert!(
            close(found[0], loaded) && close(found[1], unloaded),
            "{design} {torque}: {found:?} {loaded} {unloaded}"
        );
        // With it they are equilibrium by hand, at places so dense that kinks between them are lost by 2e-4 of the relief.
        let built = named.iter().find(|named| named.name == design).unwrap().built(&pair).unwrap();
        let profiles = built.profiles(0.0);
        let gaps = Gaps::new(&pair, &profiles);
        let by_hand = |deflection: f64| {
            let error = |index: u32| {
                let s = pair.start_of_contact + pair.base_pitch * f64::from(index) / 20_000.0;
                let ahead =
                    (s + pair.base_pitch <= pair.end_of_contact).then(|| gaps.at(s + pair.base_pitch)).flatten();
                let (one, two) = (1e6 * gaps.at(s).unwrap(), ahead.map_or(f64::INFINITY, |gap| 1e6 * gap));
                // The nearer pair alone, or both.
                (one.min(two) + deflection).min(0.5 * (one + two + deflection))
            };
            let errors = || (0..20_000).map(error);
            errors().fold(f64::MIN, f64::max) - errors().fold(f64::MAX, f64::min)
        };
        for (found, exact) in found.into_iter().zip([by_hand(deflection), by_hand(0.0)]) {
            assert!((found - exact).abs() < 2e-4 * 7.0, "{design} {torque}: {found} {exact}");
        }
        seen += 1;
    }
    assert_eq!(seen, 9);
}
