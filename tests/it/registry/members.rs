//! Every modification family, compliance method and optimiser runs on a standard pair and gives finite tables that
//! differ from those without it.

use std::collections::BTreeSet;

use super::is_name;
use super::walk::{demand, load, walk};
use declare::declared::record_of;
use gearmesh::gear::compliance::METHODS;
use gearmesh::gear::modification::{FAMILIES, members};
use gearmesh::gear::problem;
use gearmesh::optimize;
use studygraph::table::data::{Data, Table};

const PAIR: &str = "
  pair:
    kind: geometry
    module: 3 mm
    pinion: { teeth: 24, face_width: 20 mm, bore_radius: 18 mm }
    gear: { teeth: 36, face_width: 20 mm, bore_radius: 28 mm }
";

fn study(stages: &str) -> String {
    format!("study: t\nseed: 5\nstages:{PAIR}{stages}")
}

/// Ways to write each family; every one must do something to the transmission error.
const FAMILY_USES: &[(&str, &str)] = &[
    ("tip_relief", "{ gear: both, amount: 6 um, length: 4 mm }"),
    ("tip_relief", "{ gear: pinion, amount: 6 um, fraction: 1, curve: parabolic }"),
    ("tip_relief", "{ gear: gear, amount: 6 um, fraction: 0.8, curve: power, exponent: 1.5 }"),
    ("tip_relief", "{ gear: both, amount: 6 um, length: 1 mm, counted_from: single_zone }"),
    ("tip_relief", "{ gear: both, amount: 6 um, length: 2 mm, counted_from: zone_end }"),
    ("tip_relief", "{ gear: pinion, amount: 6 um, start_roll_angle: 24 deg }"),
    ("tip_relief", "{ gear: pinion, amount: 6 um, start_diameter: 73 mm }"),
    (
        "tip_relief",
        "{ gear: both, length: 4 mm, iso_amount: { tangential_load: 4000 N, mesh_stiffness: 19 N/(mm um) } }",
    ),
    ("root_relief", "{ gear: both, amount: 6 um, length: 4 mm }"),
    ("root_relief", "{ gear: pinion, amount: 6 um, fraction: 1, curve: parabolic }"),
    ("root_relief", "{ gear: gear, amount: 6 um, length: 1 mm, counted_from: single_zone }"),
    ("arc", "{ gear: both, tip_share: 0.02, length_share: 0.2 }"),
    ("arc", "{ gear: pinion, tip_amount: 60 um, start_diameter: 76 mm }"),
    ("arc", "{ gear: gear, tip_share: 0.02, length_share: 0.2, formulas: printed }"),
    ("parabola", "{ gear: both, tip_share: 0.02, length_share: 0.2 }"),
    ("parabola", "{ gear: gear, tip_amount: 60 um, start_diameter: 112 mm }"),
    ("profile_crowning", "{ gear: both, amount: 5 um }"),
    ("profile_slope", "{ gear: pinion, amount: 5 um }"),
    ("profile_slope", "{ gear: gear, amount: -5 um }"),
    ("lead_crowning", "{ gear: pinion, amount: 5 um }"),
    ("helix_slope", "{ gear: gear, amount: -5 um }"),
    ("end_relief", "{ gear: both, amount: 5 um, length: 3 mm }"),
    (
        "measured",
        "{ gear: pinion, roll_lengths: [2 mm, 6 mm, 10 mm, 14 mm, 17 mm], deviations: [-3 um, -1 um, 0 um, -2 um, -5 um] }",
    ),
    ("end_relief", "{ gear: pinion, amount: 5 um, length: 3 mm, end: I, curve: parabolic }"),
    ("end_relief", "{ gear: pinion, amount: 5 um, length: 3 mm, end: II, curve: power, exponent: 3 }"),
];

#[test]
fn every_family_changes_the_transmission_error() {
    let used: BTreeSet<_> = FAMILY_USES.iter().map(|(family, _)| *family).collect();
    let known: BTreeSet<_> = FAMILIES.iter().map(|family| family.member.name).collect();
    assert_eq!(used, known, "a family without a use here, or the reverse");
    assert!(members().iter().map(|member| member.name).eq(FAMILIES.iter().map(|family| family.member.name)));
    let mut designs =
        "  designs:\n    kind: modification\n    pair: pair\n    designs:\n      unmodified: []\n".to_owned();
    for (index, (family, fields)) in FAMILY_USES.iter().enumerate() {
        assert!(is_name(family));
        designs += &format!("      d{index}: [{family}: {fields}]\n");
    }
    for coupling in ["none", "body"] {
        let text = study(&format!(
            "  k: {{ kind: stiffness, pair: pair, coupling: {coupling} }}\n{designs}  ste: {{ kind: ste, stiffness: k, designs: designs, torque: 150 N m, positions: 16 }}\n"
        ));
        let ran = walk(&load(&text));
        let summary = ran["ste"].tables.iter().find(|table| table.name() == "summary").unwrap();
        let value = |column: &str, design: &str| {
            let row = summary.texts("design").iter().position(|name| name == design).unwrap();
            summary.floats(column)[row]
        };
        let columns = ["mean", "maximum", "minimum", "variance", "largest_pressure"];
        let plain = columns.map(|column| value(column, "unmodified"));
        for (index, (family, fields)) in FAMILY_USES.iter().enumerate() {
            let values = columns.map(|column| value(column, &format!("d{index}")));
            assert!(values.iter().all(|value| value.is_finite() && *value > 0.0), "{family}: {fields}: {values:?}");
            // Material was only taken off: the approach cannot be smaller anywhere, so not in the mean.
            assert!(values[0] > plain[0] * (1.0 + 1e-6), "{family}: {fields}: {} {}", values[0], plain[0]);
        }
        let resolved = ran["designs"].tables.iter().find(|table| table.name() == "resolved").unwrap();
        assert!(resolved.rows() >= FAMILY_USES.len());
        assert!(resolved.floats("amount").iter().all(|amount| amount.abs() > 1.0), "every amount is shown, in µm");
    }
}

#[test]
fn every_compliance_method_runs_with_every_root_contact_and_coupling() {
    let mut stages = String::new();
    let mut count = 0;
    for method in METHODS {
        assert!(is_name(method.member.name) && !method.member.summary.is_empty());
        if (method.read)(&record_of(method.member.fields, &[])).whole_pair() {
            continue;
        }
        for root in ["trochoid", "circular_fillet", "base_circle"] {
            for contact in ["linear", "load_dependent"] {
                for coupling in ["none", "body"] {
                    let name = method.member.name;
                    if name == "finite_element" && root == "base_circle" {
                        // Refused: a sharp corner. `compliance/finite_element/tests.rs` reads the message.
                        continue;
                    }
                    // What is asked holds for any mesh; a coarse one takes a tenth of the time.
                    let name =
                        if name == "finite_element" { "{ finite_element: { elements_across: 6 } }" } else { name };
                    stages += &format!(
                        "  k{count}: {{ kind: stiffness, pair: pair, method: {name}, root: {root}, contact: {contact}, coupling: {coupling}, torque: 150 N m }}\n"
                    );
                    count += 1;
                }
            }
        }
    }
    // Read back by a stage that loads them, every table says the same of the mesh.
    stages += "  none: { kind: modification, pair: pair, designs: { unmodified: [] } }\n";
    for index in 0..count {
        stages += &format!(
            "  ste{index}: {{ kind: ste, stiffness: k{index}, designs: none, torque: 150 N m, positions: 8 }}\n"
        );
    }
    let ran = walk(&load(&study(&stages)));
    let table = |stage: String| ran[&stage].tables.iter().find(|table| table.name() == "summary").unwrap();
    let summary = |index: usize, column: &str| table(format!("k{index}")).floats(column)[0];
    let base_radius = 36.0 * libm::cos(20f64.to_radians());
    for index in 0..count {
        let largest = table(format!("ste{index}")).floats("maximum")[0] * 1e-6;
        let stiffness = summary(index, "single_min");
        assert!(
            (stiffness * largest * base_radius * 1e-3 / 150.0 - 1.0).abs() < 1e-6,
            "{index}: {largest} {stiffness}"
        );
        let [single, double] = ["single_max", "double_max"].map(|column| summary(index, column));
        assert!(
            (2e8..6e8).contains(&single) && double > 1.2 * single && double < 2.0 * single,
            "{index}: {single} {double}"
        );
        // Uncoupled and coupled differ where two pairs are in contact, and only there.
        if index % 2 == 1 {
            assert!((summary(index - 1, "single_max") / single - 1.0).abs() < 1e-12);
            assert!(summary(index - 1, "double_max") > 1.01 * double);
        }
    }
}

/// What a method of whole pairs is told of single teeth changes nothing, and what it left out is said.
#[test]
fn methods_of_whole_pairs_ask_for_no_root_contact_or_coupling() {
    let whole: Vec<_> =
        METHODS.iter().filter(|method| (method.read)(&record_of(method.member.fields, &[])).whole_pair()).collect();
    assert!(!whole.is_empty());
    for method in whole {
        let name = method.member.name;
        let stage =
            |label: &str, rest: &str| format!("  {label}: {{ kind: stiffness, pair: pair, method: {name}{rest} }}\n");
        let texts = [
            stage("k0", ", torque: 150 N m"),
            stage("k1", ", root: circular_fillet, coupling: none, torque: 150 N m"),
            "  none: { kind: modification, pair: pair, designs: { unmodified: [] } }\n  ste: { kind: ste, stiffness: k0, designs: none, torque: 150 N m, positions: 16 }\n".to_owned(),
        ];
        let loaded = load(&study(&texts.concat()));
        let node = loaded.nodes.iter().find(|node| node.name == "k0").unwrap();
        let omissions = node.stage.left_out(&demand(node.stage.as_ref(), true));
        for what in ["root curve", "contact law", "influence of neighbouring teeth"] {
            let found = omissions.iter().find(|omission| *omission.what == *what);
            assert!(found.is_some_and(|omission| omission.why.contains(name)), "{what}");
        }
        let ran = walk(&loaded);
        let table = |stage: &str, table: &str| -> &Table {
            ran[stage].tables.iter().find(|found| found.name() == table).unwrap()
        };
        for column in ["single_max", "double_min", "mean"] {
            let [one, two] = ["k0", "k1"].map(|stage| table(stage, "summary").floats(column)[0]);
            assert_eq!(one.to_bits(), two.to_bits(), "{column}");
        }
        assert_eq!(table("k1", "model").texts("root"), ["none"]);
        assert_eq!(table("k1", "model").texts("contact"), ["included"]);
        assert_eq!(table("k1", "neighbours").rows(), 0);
        // Hertz needs materials and curvature, no law.
        let pressure = table("ste", "summary").floats("largest_pressure")[0];
        assert!((500.0..2000.0).contains(&pressure), "{pressure}");

        let text = study(&stage("k", ", contact: load_dependent, torque: 150 N m"));
        let error = gearstudy::program::load_text(&text, std::path::Path::new("t.yaml")).err().unwrap().to_string();
        assert!(error.contains(&format!("is not for the method `{name}`")), "{error}");
    }
}

#[test]
fn every_optimiser_finds_something_better_than_nothing() {
    let methods = [
        ("genetic", "{ population: 12, generations: 6 }"),
        ("differential_evolution", "{ population: 8, generations: 8, polish: nelder_mead }"),
        ("nelder_mead", "{ evaluations: 80 }"),
        ("powell", "{ evaluations: 80 }"),
        ("nsga2", "{ population: 10, generations: 8 }"),
        ("grid", "{ levels: 6 }"),
        ("latin_hypercube", "{ points: 40 }"),
        ("sobol", "{ points: 32 }"),
    ];
    let known: BTreeSet<_> = optimize::members().iter().map(|member| member.name).collect();
    assert_eq!(known, methods.iter().map(|(name, _)| *name).collect(), "a method without a run here, or the reverse");
    let mut stages = "  k: { kind: stiffness, pair: pair }\n  none: { kind: modification, pair: pair, designs: { unmodified: [] } }\n".to_owned();
    for objective in ["peak_to_peak", "variance"] {
        for (name, fields) in methods {
            stages += &format!(
                "  {name}_{objective}:\n    kind: optimizer\n    stiffness: k\n    name: {name}_{objective}\n    method: {{ {name}: {fields} }}\n    minimize: {objective}\n    positions: 8\n    at: {{ torque: [100 N m, 150 N m], combine: mean }}\n    design:\n      - tip_relief: {{ gear: both, amount: [0 um, 30 um], fraction: [0.2, 1] }}\n"
            );
        }
    }
    let all = methods
        .iter()
        .flat_map(|(name, _)| ["peak_to_peak", "variance"].map(|objective| format!("{name}_{objective}")));
    let all: Vec<String> = all.collect();
    stages += &format!("  ste: {{ kind: ste, stiffness: k, designs: [none, {}], torque: 150 N m }}\n", all.join(", "));
    let ran = walk(&load(&study(&stages)));
    let summary = ran["ste"].tables.iter().find(|table| table.name() == "summary").unwrap();
    let row = |design: &str| summary.texts("design").iter().position(|name| name == design).unwrap();
    for name in &all {
        let best = &ran[name].tables[0];
        assert_eq!(best.texts("design"), std::slice::from_ref(name));
        let (amount, fraction) = (best.floats("tip_relief_amount")[0], best.floats("tip_relief_fraction")[0]);
        assert!((0.0..=30.0).contains(&amount) && (0.2..=1.0).contains(&fraction), "{name}: {amount} {fraction}");
        assert!(best.floats("objective")[0] < 4.0, "{name}: {}", best.floats("objective")[0]);
        // What the search promises is what the stage `ste` finds for the design it wrote.
        let (found, plain) = (summary.floats("variance")[row(name)], summary.floats("variance")[row("unmodified")]);
        assert!(found < 0.6 * plain, "{name}: {found} {plain}");
    }
}

/// Within its bounds, and with every constraint kept, or with a warning that none is.
#[test]
fn every_design_problem_runs_and_says_what_it_keeps() {
    let problems = [
        ("root_arc", "{ formulas: derived }", "nelder_mead", true),
        ("root_arc", "{ formulas: derived }", "powell", true),
        ("root_arc", "{ formulas: printed }", "powell", false),
        ("fillet", "{ root: rack, minimize: compliance, elements_across: 6 }", "grid: { levels: 3 }", true),
        ("fillet", "{ root: arc, load: tip, plane: stress, elements_across: 6 }", "powell: { tolerance: 1e-2 }", true),
    ];
    let used: BTreeSet<_> = problems.iter().map(|(name, ..)| *name).collect();
    let known: BTreeSet<_> = problem::members().iter().map(|member| member.name).collect();
    assert_eq!(known, used, "a problem without a run here, or the reverse");
    let mut stages = String::new();
    for (at, (name, fields, method, _)) in problems.iter().enumerate() {
        stages += &format!(
            "  s{at}: {{ kind: root_optimizer, pair: pair, problem: {{ {name}: {fields} }}, method: {{ {method} }} }}\n"
        );
    }
    let stages = stages.replace("{ nelder_mead }", "nelder_mead").replace("{ powell }", "powell");
    let ran = walk(&load(&study(&stages)));
    for (at, (name, fields, _, keeps)) in problems.iter().enumerate() {
        let stage = &ran[&format!("s{at}")];
        let table = |name: &str| stage.tables.iter().find(|found| found.name() == name).unwrap();
        let variables = table("variables");
        for row in 0..variables.rows() {
            let value = |column: &str| variables.floats(column)[row];
            assert!((value("least")..=value("most")).contains(&value("value")), "{name} {fields}");
        }
        let Data::Flag(kept) = table("constraints").column("kept").unwrap() else { panic!("no flags") };
        assert_eq!(kept.iter().all(|kept| *kept), *keeps, "{name} {fields}");
        assert_eq!(table("best").floats("violation")[0] > 0.0, !keeps, "{name} {fields}");
        assert_eq!(stage.warnings.is_empty(), *keeps, "{name} {fields}: {:?}", stage.warnings);
        assert!(table("evaluations").rows() >= table("best").integers("evaluations")[0] as usize);
    }
    // Two methods, and the closed form of the article's problem as corrected.
    let radius = |stage: &str| ran[stage].tables[1].floats("value")[0];
    assert!((radius("s0") - radius("s1")).abs() < 1e-5, "{} {}", radius("s0"), radius("s1"));
}

/// A method that meshes the teeth says with what, knows the stress at the roots, and claims nothing to be left out; the
/// others have no rows and say why.
#[test]
fn a_method_that_meshes_says_with_what() {
    let text = study(
        "  beam: { kind: stiffness, pair: pair }\n  mesh: { kind: stiffness, pair: pair, method: { finite_element: { elements_across: 6 } }, torque: 50 N m, accuracy: 0.5 % }\n",
    );
    let loaded = load(&text);
    let ran = walk(&loaded);
    let table = |stage: &str, name: &str| ran[stage].tables.iter().find(|table| table.name() == name);
    assert_eq!(table("beam", "mesh").unwrap().rows(), 0);
    assert!(table("beam", "root_stress").is_none());
    let mesh = table("mesh", "mesh").unwrap();
    assert_eq!(mesh.texts("gear"), ["gear", "pinion"]);
    assert!(mesh.floats("error_estimate").iter().all(|estimate| (0.001..0.5).contains(estimate)));
    let stress = table("mesh", "root_stress").unwrap();
    assert!(stress.rows() > 20 && stress.floats("stress").iter().all(|stress| *stress > 0.0));
    for (stage, says) in [("beam", true), ("mesh", false)] {
        let node = loaded.nodes.iter().find(|node| node.name == stage).unwrap();
        let left_out = node.stage.left_out(&super::walk::demand(node.stage.as_ref(), true));
        assert_eq!(left_out.iter().any(|omission| omission.what.contains("mesh")), says, "{stage}");
    }
}
