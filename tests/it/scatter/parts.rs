//! Parts of a scatter in the real runner.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use super::*;
use gearstudy::program;
use studygraph::runner::events::Silent;
use studygraph::runner::execute::execute;
use studygraph::runner::options::Options;
use studygraph::runner::outcome::Outcome;
use studygraph::store::cache::Cache;

fn run(text: &str, cache: &Cache, jobs: usize) -> Outcome {
    let study = program::load_text(text, Path::new("t.yaml")).unwrap_or_else(|error| panic!("{error}"));
    let options = Options { jobs, ..Options::default() };
    let outcome = execute(&study, cache, &options, &Silent, &AtomicBool::new(false)).unwrap();
    assert_eq!(outcome.faults().count(), 0, "{:?}", outcome.faults().collect::<Vec<_>>());
    outcome
}

fn contents(outcome: &Outcome) -> Vec<(String, String)> {
    let tables = &outcome.stage("scatter").unwrap().tables;
    tables.iter().map(|(schema, table)| (schema.name.clone(), table.content.to_string())).collect()
}

/// More samples compute themselves alone, and give what a run by itself gives; so does another number of threads. Another
/// limit computes no row.
#[test]
fn more_samples_compute_themselves_alone() {
    let [one, two] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let [first, second] = [&one, &two].map(|folder| Cache::open(folder.path()).unwrap());
    let text = |samples: usize, limit: &str| {
        let fields = format!(
            "samples: {samples}\nindices: 64\noutputs: [unloaded_peak_to_peak]\nlimits: [unloaded_peak_to_peak <= {limit}]"
        );
        scattered(&[AMOUNT, TILT, TORQUES], &fields)
    };
    let rows = |outcome: &Outcome| {
        let work = outcome.stage("scatter").unwrap().work.named();
        ["sweep_rows_computed", "sweep_rows_taken_over"].map(|name| work.get(name).copied().unwrap_or(0))
    };
    // 64 samples with two fields and all of them replaced, and 136 by themselves, under three torques.
    assert_eq!(rows(&run(&text(200, "1 um"), &first, 1)), [(64 * 4 + 136) * 3, 0]);
    let more = run(&text(240, "1 um"), &first, 2);
    assert_eq!(rows(&more), [(64 * 4 + 40) * 3, 136 * 3], "the first part as it was, the second by forty samples more");
    assert_eq!(contents(&more), contents(&run(&text(240, "1 um"), &second, 1)));
    let other = run(&text(240, "2 um"), &first, 2);
    assert_eq!(other.ran(), 1, "what is made of all");
    assert_ne!(contents(&other), contents(&more));
}
