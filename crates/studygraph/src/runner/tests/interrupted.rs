//! Runs that are stopped, killed, or not alone.

// A test may panic.
#![allow(clippy::disallowed_methods)]

use std::process::{Command, Stdio};
use std::time::Instant;

use super::*;
use crate::runner::board::StageState;
use crate::runner::events::{Event, Observer};
use crate::runner::execute::{RunError, run};
use crate::store::error::StoreError;
use crate::store::results::Folder;

fn twenty() -> Vec<f64> {
    (1..=20).map(f64::from).collect()
}

/// Stops the run after the third chunk.
struct Stopper<'a>(&'a AtomicBool);

impl Observer for Stopper<'_> {
    fn event(&self, event: &Event<'_>) {
        if matches!(event, Event::Progressed { share, .. } if *share > 0.14) {
            self.0.store(true, Ordering::Relaxed);
        }
    }
}

#[test]
fn a_stopped_run_goes_on_where_it_was() {
    let mut bench = Bench::new();
    bench.options.jobs = 1;
    let specs = [stage("a", 1.0).cut(&CUT, &twenty()), stage("b", 1.0).of(&["a"])];
    let stop = AtomicBool::new(false);
    let study = bench.study(&specs);
    let outcome = execute(&study, &bench.cache(), &bench.options, &Stopper(&stop), &stop).unwrap();
    assert!(outcome.stopped);
    let states: Vec<_> = outcome.stages.iter().map(|stage| (stage.state, stage.why.as_str())).collect();
    assert_eq!(states, [(StageState::Skipped, "stopped"), (StageState::Skipped, "stopped")]);
    assert_eq!(count(&bench.counter("a")), 3);
    let outcome = bench.run(&specs);
    assert!(!outcome.stopped);
    assert_eq!(bench.computed(), ["a×17", "b"]);
}

/// Stops the run when `b` is finished.
struct StopAfterB<'a>(&'a AtomicBool);

impl Observer for StopAfterB<'_> {
    fn event(&self, event: &Event<'_>) {
        if matches!(event, Event::Finished { stage: "b", .. }) {
            self.0.store(true, Ordering::Relaxed);
        }
    }
}

#[test]
fn a_running_stage_hears_that_it_should_stop() {
    let mut bench = Bench::new();
    let stop = AtomicBool::new(false);
    let study = bench.study(&[stage("a", 1.0).mode("until_stopped"), stage("b", 1.0)]);
    let outcome = execute(&study, &bench.cache(), &bench.options, &StopAfterB(&stop), &stop).unwrap();
    assert!(outcome.stopped);
    assert_eq!(outcome.stage("a").unwrap().state, StageState::Skipped);
    assert_eq!(outcome.stage("b").unwrap().state, StageState::Done);
    assert_eq!(bench.run(&[stage("b", 1.0)]).stage("b").unwrap().state, StageState::Hit);
}

/// Stops the run when a file of the results is next.
struct StopBefore<'a>(&'a str, &'a AtomicBool);

impl Observer for StopBefore<'_> {
    fn event(&self, event: &Event<'_>) {
        if matches!(event, Event::Publishing { file } if *file == self.0) {
            self.1.store(true, Ordering::Relaxed);
        }
    }
}

#[test]
fn whoever_stops_while_results_are_written_gets_them_next_time() {
    let bench = Bench::new();
    let folder = Folder::new(&bench.folder.path().join("results"), "study");
    let publish = |specs: &[Spec], observer: &dyn Observer, stop: &AtomicBool| {
        run(&bench.study(specs), &bench.cache(), &bench.options, observer, stop, &folder, None)
    };
    let (specs, stop) = ([stage("a", 1.0), stage("b", 1.0)], AtomicBool::new(false));
    let stopped = publish(&specs, &StopBefore("b.values.parquet", &stop), &stop);
    assert!(matches!(stopped, Err(RunError::Store(StoreError::Stopped { path })) if path == "b.values.parquet"));
    assert!(folder.path().join("a.values.parquet").exists() && folder.manifest().is_none());
    let (outcome, published) = publish(&specs, &Silent, &AtomicBool::new(false)).unwrap();
    assert_eq!((outcome.ran(), published.changes.tables.len()), (0, 2));

    // A run that was stopped before publishes what it has.
    let (specs, stop) =
        ([stage("c", 1.0), stage("a", 2.0).mode("until_stopped"), stage("b", 2.0)], AtomicBool::new(false));
    let (outcome, published) = publish(&specs, &StopAfterB(&stop), &stop).unwrap();
    assert!(outcome.stopped && published.changes.tables.contains(&"b.values.parquet".to_owned()), "{published:?}");
}

/// What the child of the next test does; nothing when the tests are run as usual.
#[test]
fn child_that_is_killed() {
    let Some(folder) = std::env::var_os("GEARSTUDY_TEST_CHILD") else { return };
    let bench = Bench::new();
    let specs = slow(&bench, std::path::Path::new(&folder));
    let cache = Cache::open(&std::path::Path::new(&folder).join("cache")).unwrap();
    execute(&specs, &cache, &bench.options, &Silent, &AtomicBool::new(false)).unwrap();
}

fn slow(bench: &Bench, folder: &std::path::Path) -> Study {
    let mut study = bench.study(&[stage("a", 1.0).cut(&CUT, &twenty()).mode("slow"), stage("b", 1.0).of(&["a"])]);
    // The counters are part of the configuration: parent and child must agree.
    for node in &mut study.nodes {
        for (name, entry) in &mut node.record.fields {
            if *name == "counter" {
                entry.value = Value::Text(format!("{}/{}", folder.display(), node.name));
            }
        }
        node.stage = (node.kind.build)(&node.record).unwrap();
    }
    study
}

#[test]
fn a_killed_process_loses_only_what_it_was_at() {
    let bench = Bench::new();
    let folder = bench.folder.path();
    let stored = || {
        assert_eq!(bench.cache().verify(false), []);
        walk(&bench.root().join("entries"))
    };
    let mut child = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "runner::tests::interrupted::child_that_is_killed"])
        .env("GEARSTUDY_TEST_CHILD", folder)
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let began = Instant::now();
    while walk(&bench.root().join("entries")) < 4 {
        assert!(began.elapsed() < Duration::from_mins(1), "the child does not get anywhere");
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let kept = stored();
    assert!((4..20).contains(&kept), "{kept}");
    let study = slow(&bench, folder);
    let outcome = execute(&study, &bench.cache(), &bench.options, &Silent, &AtomicBool::new(false)).unwrap();
    assert_eq!(outcome.stage("b").unwrap().state, StageState::Done);
    assert_eq!(count(&format!("{}/a", folder.display())), 20 - kept);
}

/// The number of finished files below a folder.
fn walk(folder: &std::path::Path) -> usize {
    let Ok(entries) = std::fs::read_dir(folder) else { return 0 };
    let paths = entries.map(|entry| entry.unwrap().path());
    let finished = |path: &PathBuf| !path.file_name().unwrap().to_string_lossy().starts_with(".partial-");
    paths.filter(finished).map(|path| if path.is_dir() { walk(&path) } else { 1 }).sum()
}

#[test]
fn two_runs_at_once_on_one_cache_agree() {
    let bench = Bench::new();
    let specs = [stage("a", 1.0).cut(&CUT, &twenty()).mode("parallel"), stage("b", 1.0).of(&["a"])];
    let (first, second) = std::thread::scope(|scope| {
        let run = || execute(&bench.study(&specs), &bench.cache(), &bench.options, &Silent, &AtomicBool::new(false));
        let other = scope.spawn(run);
        (run().unwrap(), other.join().unwrap().unwrap())
    });
    for (a, b) in first.stages.iter().zip(&second.stages) {
        assert!(a.state.has_tables() && b.state.has_tables());
        assert_eq!(a.tables[0].1.content, b.tables[0].1.content);
    }
    assert!(bench.cache().verify(false).is_empty());
    assert_eq!(walk(&bench.root().join("entries")), 22);
}
