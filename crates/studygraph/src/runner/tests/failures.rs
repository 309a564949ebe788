//! Stages that fail, panic, come out different; caches that are damaged.

use std::fs;
use std::path::Path;

use super::*;
use crate::runner::board::StageState;
use crate::runner::fault::Fault;
use crate::runner::options::Force;
use crate::store::results::Folder;

fn with_fault(mode: &str) -> Vec<Spec> {
    vec![
        stage("a", 1.0).mode(mode),
        stage("b", 1.0).of(&["a"]),
        stage("c", 1.0).of(&["b"]),
        stage("x", 1.0),
        stage("y", 1.0).of(&["x"]),
    ]
}

fn states(outcome: &Outcome) -> Vec<StageState> {
    outcome.stages.iter().map(|stage| stage.state).collect()
}

#[test]
fn a_failure_is_not_kept() {
    let mut bench = Bench::new();
    bench.options.jobs = 1;
    let outcome = bench.run(&with_fault("fail"));
    assert_eq!(outcome.faults().collect::<Vec<_>>(), [("a", &Fault::Failed("3 teeth are too few".to_owned()))]);
    assert_eq!(states(&outcome)[..3], [StageState::Failed, StageState::Skipped, StageState::Skipped]);
    assert_eq!(outcome.stage("y").unwrap().why, "`a` failed");
    assert_eq!(bench.computed(), ["a"]);
    assert_eq!(bench.planned(&with_fault("fail"))[0], "a: run: failed the last time");
    bench.run(&with_fault("fail"));
    assert_eq!(bench.computed(), ["a"]);
    // After a success the reason is what changed since then.
    bench.run(&with_fault("fine"));
    bench.run(&with_fault("fail"));
    assert_eq!(bench.planned(&with_fault("other"))[0], "a: run: config changed: mode");
}

#[test]
fn keep_going_runs_what_does_not_depend_on_it() {
    let mut bench = Bench::new();
    bench.options.keep_going = true;
    let outcome = bench.run(&with_fault("fail"));
    assert_eq!(bench.computed(), ["a", "x", "y"]);
    assert_eq!(
        states(&outcome),
        [StageState::Failed, StageState::Skipped, StageState::Skipped, StageState::Done, StageState::Done]
    );
    assert_eq!(outcome.stage("b").unwrap().why, "`a` failed");
    assert_eq!(outcome.stage("c").unwrap().why, "`b` was not run");
}

#[test]
fn a_panic_is_a_bug_of_one_stage() {
    let mut bench = Bench::new();
    bench.options.keep_going = true;
    let outcome = bench.run(&with_fault("panic"));
    assert_eq!(outcome.stage("a").unwrap().fault, Some(Fault::Bug("index out of range".to_owned())));
    assert_eq!(states(&outcome)[3..], [StageState::Done, StageState::Done]);
}

#[test]
fn a_failed_chunk_fails_its_stage_and_the_others_are_kept() {
    let mut bench = Bench::new();
    bench.options.keep_going = true;
    let torques = [1.0, 2.0, 3.0];
    let failing = vec![stage("a", 1.0).cut(&CUT, &torques).mode("fail")];
    assert_eq!(states(&bench.run(&failing)), [StageState::Failed]);
    assert_eq!(bench.computed(), ["a×3"]);
    // One bad input among chunks: without keep-going the rest is not begun.
    bench.options.keep_going = false;
    bench.options.jobs = 1;
    bench.run(&failing);
    assert_eq!(bench.computed(), ["a"]);
}

#[test]
fn a_stage_that_comes_out_different_is_found_out() {
    let mut bench = Bench::new();
    let specs = [stage("a", 1.0).mode("random")];
    bench.run(&specs);
    bench.options.force = Force::All;
    // The switch is shared with nobody else, but forced runs may take it either way: two must differ from one.
    let outcomes = [bench.run(&specs), bench.run(&specs)];
    let found = outcomes.iter().filter_map(|outcome| outcome.stage("a").unwrap().fault.as_ref());
    let messages: Vec<String> = found.map(Fault::to_string).collect();
    assert_eq!(messages.len(), 1, "{messages:?}");
    assert!(messages[0].contains("not deterministic: table `values`"), "{messages:?}");
}

#[test]
fn warnings_are_kept_with_the_tables() {
    let mut bench = Bench::new();
    let specs = [stage("a", 1.0).mode("warn")];
    for _ in 0..2 {
        assert_eq!(bench.run(&specs).stage("a").unwrap().warnings, ["outside its range"]);
    }
    assert!(bench.computed().is_empty());
}

/// Every entry file, and the bytes of its last table.
fn entries(root: &Path) -> Vec<PathBuf> {
    let folders = fs::read_dir(root.join("entries")).unwrap().map(|entry| entry.unwrap().path());
    folders.flat_map(|folder| fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path())).collect()
}

fn damage(bench: &Bench, change: impl Fn(&mut Vec<u8>)) {
    for path in entries(&bench.root()) {
        let mut bytes = fs::read(&path).unwrap();
        change(&mut bytes);
        fs::write(&path, bytes).unwrap();
    }
}

#[test]
fn missing_and_damaged_objects_are_computed_again() {
    let mut bench = Bench::new();
    bench.run(&diamond());
    for path in entries(&bench.root()) {
        fs::remove_file(path).unwrap();
    }
    assert_eq!(bench.planned(&diamond())[0], "a: run: object missing");
    bench.run(&diamond());
    assert_eq!(bench.computed(), ["a", "b", "c", "d"]);
    damage(&bench, |bytes| bytes.truncate(100));
    assert_eq!(bench.planned(&diamond())[0], "a: run: object damaged: it is cut short");
    bench.run(&diamond());
    assert_eq!(bench.computed(), ["a", "b", "c", "d"]);
    assert!(bench.cache().verify(false).is_empty());
}

#[test]
fn a_table_found_damaged_while_running_is_computed_again() {
    let mut bench = Bench::new();
    bench.run(&diamond());
    // The headers stay sound, so the plan sees nothing; then `d` needs the tables.
    let flip = |bytes: &mut Vec<u8>| {
        let last = bytes.len() - 100;
        bytes[last] ^= 1;
    };
    damage(&bench, flip);
    assert!(bench.plan(&diamond()).is_up_to_date());
    let mut specs = diamond();
    specs.push(stage("e", 1.0).of(&["b", "c"]));
    let outcome = bench.run(&specs);
    assert_eq!(values(&bench, &outcome, "e"), [113.0]);
    // `b` and `c` needed `a` for it, `d` nobody read.
    assert_eq!(bench.computed(), ["a", "b", "c", "e"]);
    assert!(outcome.stage("b").unwrap().why.starts_with("object damaged"));
    assert_eq!(bench.cache().verify(false).len(), 1);
    // Publishing finds the last one.
    let folder = Folder::new(&bench.folder.path().join("results"), "study");
    let (study, cache, stop) = (bench.study(&specs), bench.cache(), AtomicBool::new(false));
    let (outcome, _) =
        crate::runner::execute::run(&study, &cache, &bench.options, &Silent, &stop, &folder, None).unwrap();
    assert_eq!(outcome.stage("d").unwrap().why, "object missing");
    assert!(bench.cache().verify(false).is_empty());
}

#[test]
fn damaged_chunks_are_computed_again_by_themselves() {
    let mut bench = Bench::new();
    let specs = |more| {
        let mut specs = vec![stage("a", 1.0).cut(&CUT, &[1.0, 2.0, 3.0])];
        if more {
            specs.push(stage("b", 1.0).of(&["a"]));
        }
        specs
    };
    let first = bench.run(&specs(false));
    let path = entries(&bench.root()).into_iter().max_by_key(|path| fs::metadata(path).unwrap().len()).unwrap();
    let mut bytes = fs::read(&path).unwrap();
    let last = bytes.len() - 50;
    bytes[last] ^= 1;
    fs::write(&path, bytes).unwrap();
    let second = bench.run(&specs(true));
    assert_eq!(bench.computed(), ["a", "b"]);
    assert_eq!(first.stage("a").unwrap().tables[0].1.content, second.stage("a").unwrap().tables[0].1.content);
    // What the chunks are together is lost: no chunk is computed for it.
    let whole = entries(&bench.root()).into_iter().min_by_key(|path| fs::metadata(path).unwrap().len()).unwrap();
    fs::remove_file(whole).unwrap();
    assert_eq!(bench.planned(&specs(false)), ["a: run: chunks not put together"]);
    bench.run(&specs(false));
    assert!(bench.computed().is_empty());
    assert!(bench.plan(&specs(false)).is_up_to_date());
}

#[test]
fn wrong_graphs_are_one_clear_message() {
    let bench = Bench::new();
    let message = |specs: &[Spec]| plan(&bench.study(specs), &bench.cache(), &bench.options).unwrap_err();
    let circle = message(&[
        stage("z", 1.0).of(&["a"]),
        stage("a", 1.0).of(&["c"]),
        stage("b", 1.0).of(&["a"]),
        stage("c", 1.0).of(&["b"]),
    ]);
    assert_eq!(circle.message, "stages read each other in a circle: `a` reads `c`, `c` reads `b`, `b` reads `a`");
    assert_eq!(message(&[stage("a", 1.0).of(&["a"])]).message, "stages read each other in a circle: `a` reads `a`");
    let missing = message(&[stage("first", 1.0), stage("b", 1.0).of(&["frist"])]);
    assert_eq!(missing.message, "there is no stage `frist`");
    assert_eq!(missing.help.as_deref(), Some("did you mean `first`?"));
    let table = message(&[stage("a", 1.0), stage("b", 1.0).of(&["a"]).text("table", "value")]);
    assert_eq!(table.message, "stage `a` (plain) has no table `value`");
    assert_eq!(table.help.as_deref(), Some("did you mean `values`?"));
    let column = message(&[stage("a", 1.0), stage("b", 1.0).of(&["a"]).text("column", "extras")]);
    assert_eq!(column.message, "table `a.values` has no column `extras`");
    let through = message(&[stage("a", 1.0), stage("b", 1.0).of(&["a"]).mode("through")]);
    assert!(through.message.contains("`a` reads no such thing"), "{}", through.message);
    let round = message(&[stage("a", 1.0).of(&["b"]).mode("through"), stage("b", 1.0).of(&["a"]).mode("through")]);
    assert!(round.message.contains("leads back to itself"), "{}", round.message);
}
