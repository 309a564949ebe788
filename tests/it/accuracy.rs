//! The kind `accuracy` through the whole program: what it says of a stage's settings is what the stage gives with them.

use std::path::Path;

use crate::registry::walk::{Ran, load, walk};
use crate::support::with_code;
use gearstudy::program::load_text;
use studygraph::runner::events::Silent;
use studygraph::runner::options::Options;
use studygraph::runner::{execute::execute, plan::plan};
use studygraph::store::cache::Cache;
use studygraph::table::data::Table;

const BASE: &str = "
study: t
seed: 5
stages:
  pair:
    kind: geometry
    module: 3 mm
    pinion: { teeth: 24, face_width: 20 mm, bore_radius: 18 mm }
    gear: { teeth: 36, face_width: 20 mm, bore_radius: 28 mm }
  k: { kind: stiffness, pair: pair }
  other: { kind: stiffness, pair: pair, coupling: none }
  designs:
    kind: modification
    pair: pair
    designs:
      short: [tip_relief: { gear: both, amount: 9 um, fraction: 0.5 }]
      ends: [end_relief: { gear: pinion, amount: 9 um, length: 4 mm, curve: power, exponent: 1.7 }]
  ste: { kind: ste, stiffness: k, designs: designs, torque: [40 N m, 150 N m], positions: 16 }
";

fn table<'a>(ran: &'a Ran, name: &str) -> &'a Table {
    ran.tables.iter().find(|table| table.name() == name).unwrap()
}

/// Second method: the same settings as stages of their own.
#[test]
fn a_step_is_the_stage_with_its_settings() {
    let accuracy = "
  accuracy:
    kind: accuracy
    of: ste
    quantities: [summary.mean, 'summary[design=short, torque=150 N m].peak_to_peak']
    reference: { positions: 300, slices: 301 }
    ladders:
      slices: [{ slices: 3 }, { slices: 9, positions: 16 }]
      models: [{ stiffness: other }]
    repeats: 2
";
    let apart = "
  reference: { kind: ste, stiffness: k, designs: designs, torque: [40 N m, 150 N m], positions: 300, slices: 301 }
  three: { kind: ste, stiffness: k, designs: designs, torque: [40 N m, 150 N m], positions: 16, slices: 3 }
  uncoupled: { kind: ste, stiffness: other, designs: designs, torque: [40 N m, 150 N m], positions: 16 }
";
    let ran = walk(&load(&(BASE.to_owned() + accuracy + apart)));
    let summary = |stage: &str, column: &str| table(&ran[stage], "summary").floats(column).to_vec();
    let ladder = table(&ran["accuracy"], "ladder");
    assert_eq!(ladder.rows(), 6);
    let row = |name: &str, step: i64, quantity: &str| {
        let found = (0..ladder.rows()).find(|&row| {
            ladder.texts("ladder")[row] == name
                && ladder.integers("step")[row] == step
                && ladder.texts("quantity")[row].starts_with(quantity)
        });
        found.unwrap()
    };
    for (name, stage) in [("slices", "three"), ("models", "uncoupled")] {
        let [means, converged] = [stage, "reference"].map(|stage| summary(stage, "mean"));
        let errors: Vec<f64> = means.iter().zip(&converged).map(|(one, two)| (one / two - 1.0).abs()).collect();
        let worst = (0..errors.len()).max_by(|a, b| errors[*a].total_cmp(&errors[*b])).unwrap();
        let row = row(name, 1, "summary.mean");
        assert_eq!(ladder.floats("value")[row].to_bits(), means[worst].to_bits(), "{name}");
        assert_eq!(ladder.floats("reference")[row].to_bits(), converged[worst].to_bits(), "{name}");
        assert!((ladder.floats("relative_error")[row] - errors[worst]).abs() < 1e-12, "{name}");
        assert!((ladder.floats("absolute_error")[row] - (means[worst] - converged[worst]).abs()).abs() < 1e-15);
        let said = &ladder.texts("row")[row];
        assert_eq!(
            *said,
            [
                "design=ends, torque=40",
                "design=ends, torque=150",
                "design=short, torque=40",
                "design=short, torque=150"
            ][worst]
        );
        assert_eq!(ladder.texts("unit")[row], "um");
    }
    // One row by its conditions; a slice more or less is nothing to a face that is flat.
    let relief = row("slices", 1, "summary[");
    assert_eq!(ladder.texts("row")[relief], "design=short, torque=150");
    assert!(ladder.floats("relative_error")[relief] < 1e-9);
    assert_eq!(ladder.texts("setting")[row("slices", 2, "summary[")], "slices: 9, positions: 16");
    // From 3 slices to 9 the error falls, by the order that two errors say; `positions: 16` is what the stage has anyway.
    let [coarse, fine] = [1, 2].map(|step| ladder.floats("relative_error")[row("slices", step, "summary.mean")]);
    let order = ladder.floats("observed_order")[row("slices", 2, "summary.mean")];
    assert!(fine < 0.5 * coarse && fine > 0.0, "{coarse} {fine}");
    assert!((order - (coarse / fine).ln() / 3_f64.ln()).abs() < 1e-12, "{order}");
    assert!(ladder.floats("observed_order")[row("slices", 1, "summary.mean")].is_nan());
    assert!(ladder.floats("seconds").iter().all(|seconds| *seconds > 0.0));
    assert!(ladder.floats("evaluations").iter().all(|count| count.is_nan()));

    // The front: whoever is not on it is beaten by somebody in both.
    let [errors, seconds] = ["relative_error", "seconds"].map(|column| ladder.floats(column));
    let studygraph::table::data::Data::Flag(front) = ladder.column("on_front").unwrap() else { panic!() };
    for row in 0..ladder.rows() {
        let beaten = (0..ladder.rows()).any(|other| {
            ladder.texts("quantity")[other] == ladder.texts("quantity")[row]
                && errors[other] <= errors[row]
                && seconds[other] <= seconds[row]
                && (errors[other] < errors[row] || seconds[other] < seconds[row])
        });
        assert_eq!(front[row], !beaten, "{row}");
    }
    let choice = table(&ran["accuracy"], "choice");
    assert_eq!(choice.rows(), 6);
    for row in 0..choice.rows() {
        let (quantity, wanted) = (&choice.texts("quantity")[row], choice.floats("wanted")[row]);
        let fits = |other: &usize| ladder.texts("quantity")[*other] == *quantity && errors[*other] <= wanted;
        let best = (0..ladder.rows()).filter(fits).min_by(|a, b| seconds[*a].total_cmp(&seconds[*b]));
        let studygraph::table::data::Data::Flag(met) = choice.column("met").unwrap() else { panic!() };
        assert_eq!(met[row], best.is_some());
        let setting = best.map_or("", |best| ladder.texts("setting")[best].as_str());
        assert_eq!(choice.texts("setting")[row], setting);
    }
    assert_eq!(table(&ran["accuracy"], "spread").rows(), 0);
    assert_eq!(table(&ran["accuracy"], "reference").texts("setting"), ["positions: 300, slices: 301"]);
}

/// A mesh twice as fine is better by the order of its elements, and seeds give a spread in order.
#[test]
fn meshes_converge_and_seeds_spread() {
    let text = BASE.to_owned()
        + "
  mesh: { kind: stiffness, pair: pair, method: { finite_element: { elements_across: 6 } }, torque: 50 N m }
  meshes:
    kind: accuracy
    of: mesh
    quantities: [summary.single_max, summary.mean]
    reference: { method: { finite_element: { elements_across: 20 } } }
    ladders:
      finite_element:
        - { method: { finite_element: { elements_across: 6 } } }
        - { method: { finite_element: { elements_across: 10 } } }
      energy: [{ method: energy }]
    repeats: 1
  search:
    kind: optimizer
    stiffness: k
    positions: 8
    at: { torque: 150 N m }
    method: { differential_evolution: { population: 10, generations: 4 } }
    search: plain
    design: [tip_relief: { gear: both, amount: [0 um, 20 um], fraction: [0.2, 1] }]
  searches:
    kind: accuracy
    of: search
    quantities: [best.objective]
    evaluations: best.evaluations
    reference: { method: { differential_evolution: { population: 20, generations: 60 } } }
    ladders:
      generations:
        - { method: { differential_evolution: { population: 10, generations: 2 } } }
        - { method: { differential_evolution: { population: 10, generations: 30 } } }
    seeds: 6
    repeats: 2
";
    let ran = walk(&load(&text));
    let meshes = table(&ran["meshes"], "ladder");
    let column = |name: &str, quantity: &str| -> Vec<f64> {
        (0..meshes.rows())
            .filter(|&row| meshes.texts("quantity")[row] == quantity)
            .map(|row| meshes.floats(name)[row])
            .collect()
    };
    // energy, 6 across, 10 across
    let errors = column("relative_error", "summary.mean");
    assert!(errors[0] > 0.02 && errors[1] < 0.01 && errors[2] < 0.4 * errors[1], "{errors:?}");
    let orders = column("observed_order", "summary.mean");
    // With 10 across the fourth power of the size is taken off, with 6 it is not.
    assert!(orders[0].is_nan() && orders[1].is_nan() && (3.0..9.0).contains(&orders[2]), "{orders:?}");

    let spread = table(&ran["searches"], "spread");
    assert_eq!(spread.integers("seeds"), [6, 6]);
    let of = |row: usize| {
        ["smallest", "lower_quartile", "median", "upper_quartile", "largest"].map(|name| spread.floats(name)[row])
    };
    for row in 0..2 {
        assert!(of(row).is_sorted(), "{:?}", of(row));
    }
    assert!(of(0)[4] > of(0)[0], "six seeds find six optima after two generations");
    assert!(of(1)[2] < of(0)[2] && of(1)[4] - of(1)[0] < of(0)[4] - of(0)[0]);
    assert!(spread.floats("evaluations")[1] > 5.0 * spread.floats("evaluations")[0]);
}

#[test]
fn mistakes_in_overrides_are_found_where_they_stand() {
    let with = |of: &str, quantity: &str, reference: &str, ladder: &str| {
        let text = format!(
            "{BASE}  accuracy:\n    kind: accuracy\n    of: {of}\n    quantities: {quantity}\n    reference: {reference}\n    ladders: {{ a: {ladder} }}\n"
        );
        load_text(&text, Path::new("t.yaml")).err().map(|error| error.to_string()).unwrap_or_default()
    };
    let fine = "[summary.mean]";
    assert_eq!(with("ste", fine, "{ positions: 64 }", "[{ positions: 8 }]"), "");
    let line = BASE.lines().count();
    for (found, place, says) in [
        (with("ste", fine, "{}", "[{ positons: 8 }]"), format!("{}:22", line + 6), "did you mean `positions`?"),
        (with("ste", fine, "{ positions: 4 }", "[{}]"), format!("{}:29", line + 5), "between 8 and 100000"),
        (
            with("ste", fine, "{ kind: report }", "[{}]"),
            format!("{}:18", line + 5),
            "the kind of a stage cannot be replaced",
        ),
        (
            with("ste", fine, "{ stiffness: designs }", "[{}]"),
            format!("{}:29", line + 5),
            "`designs` is a `modification` stage",
        ),
        (with("sty", fine, "{}", "[{}]"), format!("{}:9", line + 3), "did you mean `ste`?"),
        (with("accuracy", fine, "{}", "[{}]"), format!("{}:9", line + 3), "replaces fields of another stage itself"),
        (with("ste", "[summary.maen]", "{}", "[{}]"), format!("{}:18", line + 4), "did you mean `mean`?"),
        (with("ste", "[sumary.mean]", "{}", "[{}]"), format!("{}:18", line + 4), "did you mean `summary`?"),
        (with("ste", "[summary.design]", "{}", "[{}]"), format!("{}:18", line + 4), "holds texts, not numbers"),
        (with("ste", "[mean]", "{}", "[{}]"), format!("{}:18", line + 4), "write `table.column`"),
        (with("ste", fine, "{}", "[]"), format!("{}:14", line + 6), "the ladders are empty"),
        (with("ste", fine, "64", "[{}]"), format!("{}:16", line + 5), "a mapping from fields of the stage in `of`"),
    ] {
        assert!(found.contains(&place) && found.contains(says), "{place} {says}\n{found}");
    }
}

/// The other stage is not read, but what it says is in the key, and so is its code.
#[test]
fn the_key_follows_the_other_stage_and_its_code() {
    let folder = tempfile::tempdir().unwrap();
    let cache = Cache::open(folder.path()).unwrap();
    let stop = std::sync::atomic::AtomicBool::new(false);
    let text = |positions: usize| {
        BASE.replace("positions: 16", &format!("positions: {positions}"))
            + "  accuracy: { kind: accuracy, of: ste, quantities: [summary.mean], reference: { slices: 33 }, ladders: { a: [{ slices: 5 }] }, repeats: 1 }\n"
    };
    let options = Options::default();
    let study = |positions, code_of| with_code(load(&text(positions)), code_of);
    let one: fn(&str) -> String = |_| "one".to_owned();
    let outcome = execute(&study(16, one), &cache, &options, &Silent, &stop).unwrap();
    assert_eq!(outcome.faults().count(), 0);
    let action = |positions, code_of| {
        let plan = plan(&study(positions, code_of), &cache, &options).unwrap();
        plan.stages.iter().find(|stage| stage.name == "accuracy").unwrap().action.phrase()
    };
    assert_eq!(action(16, one), "hit");
    assert_eq!(action(17, one), "run: config changed: reference, ladders");
    let other: fn(&str) -> String = |kind| if kind == "ste" { "two" } else { "one" }.to_owned();
    assert!(action(16, other).contains("code changed"), "{}", action(16, other));
    let other = |kind: &str| if kind == "optimizer" { "two" } else { "one" }.to_owned();
    assert_eq!(action(16, other), "hit");
}

/// Equidistant samples alone come without the curve, and are the same.
#[test]
fn samples_alone_are_those_beside_the_curve() {
    let text = BASE.to_owned()
        + "
  samples: { kind: accuracy, of: ste, quantities: [sample_summary.mean], reference: { samples: 900 }, ladders: { a: [{}] }, repeats: 1 }
";
    let ran = walk(&load(&text));
    let ladder = table(&ran["samples"], "ladder");
    let means = table(&ran["ste"], "sample_summary").floats("mean");
    assert!(means.contains(&ladder.floats("value")[0]), "{means:?}");
    assert_eq!(ladder.texts("setting"), ["as it is"]);
    assert!(ladder.floats("relative_error")[0] > 0.0);
}

/// Second method: the objective of the design that was found, by the stage `ste` with far more positions and slices.
#[test]
fn a_wanted_accuracy_is_met_by_searches_curves_and_stiffness() {
    let text = BASE.to_owned()
        + "
  search:
    kind: optimizer
    stiffness: k
    at: { torque: 150 N m }
    accuracy: 0.02 %
    method: { differential_evolution: { population: 10, generations: 8 } }
    design:
      - tip_relief: { gear: both, amount: [0 um, 20 um], fraction: [0.2, 1] }
      - end_relief: { gear: pinion, amount: [3 um, 9 um], length: 4 mm, curve: power, exponent: 1.7 }
  fine: { kind: ste, stiffness: k, designs: [search, designs], torque: [40 N m, 150 N m], positions: 400, slices: 601 }
  wish: { kind: ste, stiffness: k, designs: [search, designs], torque: [40 N m, 150 N m], accuracy: 0.02 % }
  ring: { kind: stiffness, pair: pair, method: { energy: { body: ring } }, accuracy: 1 % }
  exact: { kind: stiffness, pair: pair, method: { energy: { body: ring, harmonics: 1000 } } }
  hopeless: { kind: stiffness, pair: pair, accuracy: 0.000000001 % }
";
    let ran = walk(&load(&text));
    let best = table(&ran["search"], "best");
    let estimate = best.floats("error_estimate")[0];
    assert!(estimate <= 2e-4 && best.integers("slices")[0] > 9, "{estimate} {:?}", best.integers("slices"));
    let [fine, wish] = ["fine", "wish"].map(|stage| table(&ran[stage], "summary"));
    let optimum =
        (0..fine.rows()).find(|&row| fine.texts("design")[row] == "optimum" && fine.floats("torque")[row] == 150.0);
    let truth = fine.floats("peak_to_peak")[optimum.unwrap()];
    let error = (best.floats("objective")[0] / truth - 1.0).abs();
    assert!(error <= estimate, "{error}");
    for row in 0..wish.rows() {
        let error = (wish.floats("peak_to_peak")[row] / fine.floats("peak_to_peak")[row] - 1.0).abs();
        let (estimate, slices) = (wish.floats("error_estimate")[row], wish.integers("slices")[row]);
        assert!(estimate <= 2e-4 && error <= estimate, "{error} {estimate}");
        // A design without a closed form takes as many slices as it needs, the other those it is given.
        assert!(if wish.texts("design")[row] == "short" { slices == 17 } else { slices >= 9 }, "{slices}");
        assert_eq!(wish.integers("positions")[row], 16);
    }
    let [ring, exact] = ["ring", "exact"].map(|stage| table(&ran[stage], "summary"));
    for column in ["single_max", "double_max", "mean"] {
        let error = (ring.floats(column)[0] / exact.floats(column)[0] - 1.0).abs();
        assert!(error < 1e-2 && error > 1e-7, "{column}: {error}");
    }
    assert!((0.01..1.0).contains(&ring.floats("error_estimate")[0]), "in percent");
    assert!(
        ran["hopeless"].warnings.iter().any(|warning| warning.contains("not to 1.0e-11")),
        "{:?}",
        ran["hopeless"].warnings
    );
    // The accuracy is that of the sampling; corners that the model leaves out are another error, and are reported.
    let of_accuracy = |stage: &str| {
        let warnings = ran[stage].warnings.iter().filter(|warning| !warning.contains("`corner_contact` is `none`"));
        warnings.cloned().collect::<Vec<_>>()
    };
    assert!(of_accuracy("ring").is_empty() && of_accuracy("wish").is_empty(), "{:?}", of_accuracy("wish"));
    // Without end relief it is better, which the search says.
    let search = of_accuracy("search");
    assert!(search.iter().all(|warning| warning.starts_with("a simpler design is as good")), "{search:?}");
}
