//! Parts of a sweep in the real runner: any threads, rows taken over, runs that are stopped.

use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use super::*;
use gearstudy::program;
use studygraph::runner::events::{Event, Observer, Silent};
use studygraph::runner::execute::execute;
use studygraph::runner::options::Options;
use studygraph::runner::outcome::{Outcome, StageOutcome};
use studygraph::runner::plan::plan;
use studygraph::store::cache::Cache;
use studygraph::study::Study;

fn load_text(text: &str) -> Study {
    program::load_text(text, Path::new("t.yaml")).unwrap_or_else(|error| panic!("{error}"))
}

fn run(text: &str, cache: &Cache, jobs: usize) -> Outcome {
    let study = load_text(text);
    let outcome =
        execute(&study, cache, &Options { jobs, ..Options::default() }, &Silent, &AtomicBool::new(false)).unwrap();
    assert_eq!(outcome.faults().count(), 0, "{:?}", outcome.faults().collect::<Vec<_>>());
    outcome
}

fn sweep(outcome: &Outcome) -> &StageOutcome {
    outcome.stage("sweep").unwrap()
}

fn contents(outcome: &Outcome) -> Vec<(String, String)> {
    sweep(outcome).tables.iter().map(|(schema, table)| (schema.name.clone(), table.content.to_string())).collect()
}

/// Rows computed and taken over, of all parts that the run knows.
fn counted(outcome: &Outcome) -> [u64; 2] {
    let work = sweep(outcome).work.named();
    ["sweep_rows_computed", "sweep_rows_taken_over"].map(|name| work.get(name).copied().unwrap_or(0))
}

/// Some twenty thousand rows of a few parts; only extremes are asked, so that they are quick.
pub fn grid(amounts: &str, torques: &str) -> String {
    let fields = format!(
        "vary:\n  amount: {{ field: \"designs.designs.long[1].tip_relief.amount\", {amounts} }}\n  \
         torque: {{ field: ste.torque, {torques} }}\noutputs: [peak_to_peak]"
    );
    swept(&fields).replace("positions: 16", "positions: 8")
}

const AMOUNTS: &str = "from: 1 um, to: 12 um, count: 12";
pub const TORQUES: &str = "from: 1 N m, to: 1500 N m, count: 1500";

fn cache(folder: &Path) -> Cache {
    Cache::open(folder).unwrap()
}

#[test]
fn any_threads_give_the_same_bits_and_an_added_value_computes_its_rows_alone() {
    let [one, two] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let first = run(&grid(AMOUNTS, TORQUES), &cache(one.path()), 1);
    assert!(sweep(&first).chunks >= 3, "{} chunks", sweep(&first).chunks);
    assert_eq!(counted(&first), [18_000, 0]);
    let again = run(&grid(AMOUNTS, TORQUES), &cache(two.path()), 2);
    assert_eq!(contents(&first), contents(&again));
    assert_eq!(run(&grid(AMOUNTS, TORQUES), &cache(one.path()), 2).ran(), 0, "nothing to do");

    // A torque more changes every part, and an amount more some: the other rows are taken over.
    let torques = TORQUES.replace("to: 1500 N m, count: 1500", "to: 1501 N m, count: 1501");
    let more = run(&grid(AMOUNTS, &torques), &cache(one.path()), 2);
    assert_eq!(counted(&more), [12, 18_000]);
    let fresh = tempfile::tempdir().unwrap();
    let alone = run(&grid(AMOUNTS, &torques), &cache(fresh.path()), 2);
    assert_eq!(counted(&alone), [18_012, 0]);
    assert_eq!(contents(&more), contents(&alone), "to the last bit");

    let amounts = AMOUNTS.replace("to: 12 um, count: 12", "to: 13 um, count: 13");
    let before = sweep(&more).keys.iter().map(|key| key.key).collect::<Vec<_>>();
    let wider = run(&grid(&amounts, &torques), &cache(one.path()), 2);
    let kept = sweep(&wider).keys.iter().filter(|key| before.contains(&key.key)).count();
    assert!(kept >= 1, "no part stayed as it was");
    let [computed, taken] = counted(&wider);
    // Parts that stayed are counted with what they were; 1,501 rows are new.
    let first = counted(&more);
    assert!(computed <= first[0] + 1501 && computed + taken == 13 * 1501, "{computed} {taken}");
    let fresh = run(&grid(&amounts, &torques), &cache(fresh.path()), 1);
    assert_eq!(contents(&wider), contents(&fresh));

    // Another best list is made of the same rows.
    let best = grid(&amounts, &torques).replace("outputs: [peak_to_peak]", "outputs: [peak_to_peak]\n    best: 7");
    let listed = run(&best, &cache(one.path()), 2);
    assert_eq!((sweep(&listed).ran, listed.ran()), (1, 1));
    // Another output is another function of the values.
    let other = best.replace("[peak_to_peak]", "[maximum]");
    assert_eq!(counted(&run(&other, &cache(one.path()), 2)), [13 * 1501, 0]);
}

/// Stops a run once so many parts are kept.
struct Stopper<'a> {
    stop: &'a AtomicBool,
    shares: AtomicUsize,
}

impl Observer for Stopper<'_> {
    fn event(&self, event: &Event) {
        if let Event::Progressed { stage: "sweep", share } = event
            && *share > 0.5
        {
            self.shares.fetch_add(1, Ordering::Relaxed);
            self.stop.store(true, Ordering::Relaxed);
        }
    }
}

#[test]
fn a_sweep_that_was_stopped_goes_on_where_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let text = grid("from: 1 um, to: 24 um, count: 24", TORQUES);
    let (study, cache) = (load_text(&text), cache(folder.path()));
    let stop = AtomicBool::new(false);
    let stopper = Stopper { stop: &stop, shares: AtomicUsize::new(0) };
    let stopped = execute(&study, &cache, &Options { jobs: 1, ..Options::default() }, &stopper, &stop).unwrap();
    assert!(stopped.stopped && stopper.shares.load(Ordering::Relaxed) > 0);
    let planned = plan(&study, &cache, &Options::default()).unwrap();
    let planned = planned.stages.iter().find(|stage| stage.name == "sweep").unwrap();
    assert!((1..planned.chunks).contains(&planned.missing), "{} of {}", planned.missing, planned.chunks);
    let finished = run(&text, &cache, 2);
    assert_eq!(sweep(&finished).ran, planned.missing);
    let fresh = tempfile::tempdir().unwrap();
    assert_eq!(contents(&finished), contents(&run(&text, &self::cache(fresh.path()), 2)));
}

/// Drawn designs: more of them are added to those that are there, but for a Latin hypercube, whose strata move.
#[test]
fn more_samples_are_added_to_those_that_are_there() {
    for (method, kept) in [("sobol", true), ("random", true), ("latin_hypercube", false)] {
        let text = |samples: usize| {
            let fields = format!(
                "method: {{ {method}: {{ samples: {samples} }} }}\nvary:\n  \
                 amount: {{ field: \"designs.designs.long[1].tip_relief.amount\", from: 0 um, to: 12 um }}\n  \
                 torque: {{ field: ste.torque, from: 1 N m, to: 300 N m }}\noutputs: [peak_to_peak]"
            );
            swept(&fields).replace("positions: 16", "positions: 8")
        };
        let [folder, fresh] = [(); 2].map(|()| tempfile::tempdir().unwrap());
        assert_eq!(counted(&run(&text(300), &cache(folder.path()), 2)), [300, 0]);
        let more = run(&text(500), &cache(folder.path()), 2);
        assert_eq!(counted(&more), if kept { [200, 300] } else { [500, 0] }, "{method}");
        assert_eq!(contents(&more), contents(&run(&text(500), &cache(fresh.path()), 1)));
    }
}

/// What a run will take is said before, part by part.
#[test]
fn rows_are_foreseen() {
    let folder = tempfile::tempdir().unwrap();
    let study = load_text(&grid(AMOUNTS, TORQUES));
    let found = plan(&study, &cache(folder.path()), &Options::default()).unwrap();
    let planned = found.stages.iter().find(|stage| stage.name == "sweep").unwrap();
    let rows = planned.expected.as_ref().unwrap().tables.iter().find(|(name, _)| name == "rows").unwrap().1;
    assert_eq!((rows.count, rows.certainty.name()), (18_000, "exact"));
}
