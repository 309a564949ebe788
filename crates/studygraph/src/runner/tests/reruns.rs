//! What is computed again, what is not, and the reason that is given.

use super::*;
use crate::runner::board::StageState;
use crate::runner::graph::Graph;
use crate::runner::options::{Force, Wanted};
use crate::store::cache::Remove;
use crate::store::results::{Changes, Folder};

#[test]
fn nothing_runs_the_second_time() {
    let mut bench = Bench::new();
    assert_eq!(bench.planned(&diamond()), ["a: run: never ran", "b: wait for a", "c: wait for a", "d: wait for b, c"]);
    assert!(!bench.plan(&diamond()).is_up_to_date());
    let first = bench.run(&diamond());
    assert_eq!(bench.computed(), ["a", "b", "c", "d"]);
    assert_eq!(values(&bench, &first, "d"), [1112.0]);
    assert!(bench.plan(&diamond()).is_up_to_date());
    let second = bench.run(&diamond());
    assert!(bench.computed().is_empty());
    assert!(second.stages.iter().all(|stage| stage.state == StageState::Hit && stage.why == "unchanged"));
    let contents = |outcome: &Outcome| outcome.stages.iter().map(|s| s.tables[0].1.content).collect::<Vec<_>>();
    assert_eq!(contents(&first), contents(&second));
}

#[test]
fn a_changed_field_is_named_and_the_wave_follows() {
    let mut bench = Bench::new();
    bench.run(&diamond());
    let mut changed = diamond();
    changed[1] = stage("b", 11.0).of(&["a"]);
    assert_eq!(bench.planned(&changed), ["a: hit", "b: run: config changed: value", "c: hit", "d: wait for b"]);
    let outcome = bench.run(&changed);
    assert_eq!(bench.computed(), ["b", "d"]);
    assert_eq!(outcome.stage("d").unwrap().why, "input changed: of0");
    // Going back costs nothing: the earlier entries are still there.
    bench.run(&diamond());
    assert!(bench.computed().is_empty());
}

#[test]
fn a_stage_that_comes_out_as_before_stops_the_wave() {
    let mut bench = Bench::new();
    let specs = |value| vec![stage("a", value).mode("coarse"), stage("b", 1.0).of(&["a"]), stage("c", 1.0).of(&["b"])];
    bench.run(&specs(5.1));
    let outcome = bench.run(&specs(5.9));
    assert_eq!(bench.computed(), ["a"]);
    assert_eq!(outcome.stage("b").unwrap().state, StageState::Hit);
    bench.run(&specs(6.1));
    assert_eq!(bench.computed(), ["a", "b", "c"]);
}

#[test]
fn a_new_seed_concerns_only_stages_that_draw() {
    let mut bench = Bench::new();
    let specs = |name| {
        vec![
            stage("a", 1.0).mode("ignores_seed"),
            Spec { name, ..stage("b", 1.0).mode("seeded") },
            stage("c", 1.0).of(&[name]),
        ]
    };
    let first = bench.run(&specs("b"));
    bench.seed = 2;
    assert_eq!(bench.planned(&specs("b")), ["a: hit", "b: run: seed changed", "c: wait for b"]);
    let second = bench.run(&specs("b"));
    assert_eq!(bench.computed(), ["b", "c"]);
    assert_ne!(values(&bench, &first, "b"), values(&bench, &second, "b"));
    // What draws without saying so is given the same numbers under every seed: its tables fit its key.
    bench.options.force = Force::Stages(["a".to_owned()].into());
    assert_eq!(bench.run(&specs("b")).stage("a").unwrap().state, StageState::Done);
    bench.options.force = Force::Nothing;
    // The seed comes from the name, so a new name draws anew; a study without random numbers would not notice.
    bench.run(&specs("renamed_b"));
    assert_eq!(bench.computed(), ["c", "renamed_b"]);
}

#[test]
fn a_new_label_recomputes_nothing() {
    let mut bench = Bench::new();
    bench.run(&[stage("a", 1.0), stage("b", 1.0).of(&["a"])]);
    let outcome = bench.run(&[stage("renamed_a", 1.0), stage("renamed_b", 1.0).of(&["renamed_a"])]);
    assert!(bench.computed().is_empty());
    assert_eq!(values(&bench, &outcome, "renamed_b"), [2.0]);
}

#[test]
fn the_order_of_stages_in_the_file_does_not_matter() {
    let mut bench = Bench::new();
    bench.run(&diamond());
    let mut turned = diamond();
    turned.reverse();
    let order: Vec<String> = bench.plan(&turned).stages.into_iter().map(|stage| stage.name).collect();
    assert_eq!(order, ["a", "b", "c", "d"]);
    bench.run(&turned);
    assert!(bench.computed().is_empty());
}

#[test]
fn new_code_runs_again_and_stops_where_values_agree() {
    let mut bench = Bench::new();
    bench.run(&diamond());
    bench.program = &OTHER;
    assert_eq!(bench.planned(&diamond())[0], "a: run: code changed");
    let outcome = bench.run(&diamond());
    assert_eq!(bench.computed(), ["a", "b", "c", "d"]);
    assert_eq!(outcome.stage("d").unwrap().why, "code changed");
}

#[test]
fn what_is_asked_for_goes_upstream_and_readers_of_less_do_not_notice() {
    let mut bench = Bench::new();
    let outcome = bench.run(&diamond());
    let left_out: Vec<_> = outcome.stage("a").unwrap().left_out.iter().map(|omission| &*omission.what).collect();
    assert_eq!(left_out, ["column `values.extra`", "table `detail`"]);
    // The user asks for a column of `a`: nobody below reads it.
    let want = Want { table: "values".to_owned(), columns: vec!["extra".to_owned()] };
    bench.options.wanted = vec![Wanted { stage: "a".to_owned(), want }];
    assert_eq!(bench.planned(&diamond())[0], "a: run: demand changed");
    let outcome = bench.run(&diamond());
    assert_eq!(bench.computed(), ["a"]);
    assert_eq!(outcome.table(&bench.cache(), "a", "values").unwrap().floats("extra"), [2.0]);
    // Another stage asks for it: nothing new for `a`.
    bench.options.wanted.clear();
    let mut specs = diamond();
    specs.push(stage("e", 0.0).of(&["a"]).text("column", "extra"));
    bench.run(&specs);
    assert_eq!(bench.computed(), ["e"]);
    specs.push(stage("f", 0.0).of(&["b"]).text("table", "detail"));
    let outcome = bench.run(&specs);
    assert_eq!(bench.computed(), ["b", "f"]);
    assert_eq!(outcome.stage("b").unwrap().left_out.len(), 1);
    // Columns that always come may be named without effect.
    let want = Want { table: "values".to_owned(), columns: vec!["value".to_owned()] };
    bench.options.wanted = vec![Wanted { stage: "c".to_owned(), want }];
    bench.run(&specs);
    assert!(bench.computed().is_empty());
}

#[test]
fn a_port_for_a_column_on_demand_is_read_only_where_that_is_wanted() {
    let mut bench = Bench::new();
    let read_by = |mode: &str| vec![stage("a", 1.0), stage("b", 2.0).of(&["a"]).mode(mode).text("table", "detail")];
    let outcome = bench.run(&read_by("for_extra"));
    assert_eq!(bench.computed(), ["a", "b"]);
    assert_eq!(outcome.table(&bench.cache(), "b", "values").unwrap().floats("value"), [2.0], "nothing was read");
    let left_out: Vec<_> = outcome.stage("a").unwrap().left_out.iter().map(|omission| &*omission.what).collect();
    assert!(left_out.contains(&"table `detail`"), "{left_out:?}");
    let want = Want { table: "values".to_owned(), columns: vec!["extra".to_owned()] };
    bench.options.wanted = vec![Wanted { stage: "b".to_owned(), want }];
    let outcome = bench.run(&read_by("for_extra"));
    assert_eq!(bench.computed(), ["a", "b"], "`a` gives more, and `b` reads it");
    assert_eq!(outcome.table(&bench.cache(), "b", "values").unwrap().floats("value"), [3.0]);
    // What it needs goes on upstream, and what is not there is said with who needs it.
    let missing = vec![stage("a", 1.0), stage("b", 2.0).of(&["a"]).mode("for_extra").text("table", "detials")];
    let error = Graph::new(&bench.study(&missing), &bench.options.wanted).unwrap_err();
    assert_eq!(error.message, "what is asked of `b` cannot be computed: stage `a` (plain) has no table `detials`");
    bench.options.wanted.clear();
    bench.run(&missing);
}

#[test]
fn only_some_stages_and_what_they_need() {
    let mut bench = Bench::new();
    let mut specs = diamond();
    specs.push(stage("e", 0.0).of(&["a"]).text("column", "extra"));
    bench.options.only = vec!["b".to_owned()];
    let outcome = bench.run(&specs);
    assert_eq!(bench.computed(), ["a", "b"]);
    assert_eq!(outcome.stage("d").unwrap().why, "not asked for");
    // The demand was that of the whole study, so the rest finds `a` and `b` done.
    bench.options.only.clear();
    bench.run(&specs);
    assert_eq!(bench.computed(), ["c", "d", "e"]);
    bench.options.only = vec!["bb".to_owned()];
    let error = plan(&bench.study(&specs), &bench.cache(), &bench.options).unwrap_err();
    assert_eq!(error.message, "there is no stage `bb`");
    assert!(error.help.is_some());
}

#[test]
fn an_added_value_computes_only_itself() {
    let mut bench = Bench::new();
    let specs = |torques: &[f64]| {
        vec![stage("a", 1.0), stage("ste", 2.0).of(&["a"]).cut(&CUT, torques), stage("z", 0.0).of(&["ste"])]
    };
    let outcome = bench.run(&specs(&[25.0, 50.0, 100.0]));
    assert_eq!(bench.computed(), ["a", "ste×3", "z"]);
    assert_eq!(values(&bench, &outcome, "ste"), [28.0, 53.0, 103.0]);
    assert_eq!(values(&bench, &outcome, "z"), [184.0]);
    let more = specs(&[25.0, 50.0, 75.0, 100.0]);
    let planned = bench.plan(&more);
    assert_eq!((planned.stages[1].missing, planned.stages[1].chunks), (1, 4));
    assert_eq!(planned.stages[1].action.phrase(), "run: config changed: new values of torque");
    let outcome = bench.run(&more);
    assert_eq!(bench.computed(), ["ste", "z"]);
    assert_eq!(values(&bench, &outcome, "ste"), [28.0, 53.0, 78.0, 103.0]);
    // A value less: its rows go, the others are there.
    bench.run(&specs(&[50.0, 100.0]));
    assert_eq!(bench.computed(), ["z"]);
    // Content does not depend on how the stage is cut.
    let by_four = vec![stage("a", 1.0), stage("ste", 2.0).of(&["a"]).cut(&CUT_BY_FOUR, &[50.0, 100.0])];
    let whole = bench.run(&by_four).stage("ste").unwrap().tables[0].1.content;
    let cut = bench.run(&specs(&[50.0, 100.0])).stage("ste").unwrap().tables[0].1.content;
    assert_eq!(whole, cut);
}

#[test]
fn force_computes_again_and_an_equal_result_goes_no_further() {
    let mut bench = Bench::new();
    bench.run(&diamond());
    bench.options.force = Force::Stages(["b".to_owned()].into());
    assert_eq!(bench.planned(&diamond())[1], "b: run: forced");
    bench.run(&diamond());
    assert_eq!(bench.computed(), ["b"]);
    bench.options.force = Force::All;
    bench.run(&diamond());
    assert_eq!(bench.computed(), ["a", "b", "c", "d"]);
    bench.options.force = Force::Stages(["x".to_owned()].into());
    assert!(plan(&bench.study(&diamond()), &bench.cache(), &bench.options).is_err());
}

#[test]
fn a_port_through_another_stage_reads_what_that_one_reads() {
    let mut bench = Bench::new();
    let specs = |b| vec![stage("a", 7.0), stage("b", b).of(&["a"]), stage("c", 0.0).of(&["b"]).mode("through")];
    let outcome = bench.run(&specs(1.0));
    assert_eq!(values(&bench, &outcome, "c"), [7.0]);
    bench.run(&specs(2.0));
    assert_eq!(bench.computed(), ["b"]);
}

#[test]
fn one_and_eight_threads_give_the_same_contents() {
    let contents = |jobs| {
        let mut bench = Bench::new();
        bench.options.jobs = jobs;
        let torques: Vec<f64> = (1..12).map(f64::from).collect();
        let mut specs = vec![stage("a", 0.3).mode("parallel")];
        for name in ["b", "c", "d", "e", "f"] {
            specs.push(stage(name, 0.1).of(&["a"]).mode("parallel").cut(&CUT_BY_FOUR, &torques));
        }
        specs.push(stage("g", 0.2).of(&["b", "c", "d", "e", "f"]).mode("parallel"));
        specs.push(stage("h", 0.2).of(&["g"]).mode("seeded"));
        let outcome = bench.run(&specs);
        outcome.stages.iter().map(|stage| (stage.name.clone(), stage.tables[0].1.content)).collect::<Vec<_>>()
    };
    let one = contents(1);
    assert_eq!(one, contents(2));
    assert_eq!(one, contents(8));
}

#[test]
fn cleaning_keeps_the_last_run_of_every_study() {
    let mut bench = Bench::new();
    let specs = |value| vec![stage("a", value), stage("b", 1.0).of(&["a"]).cut(&CUT, &[1.0, 2.0])];
    bench.run(&specs(1.0));
    bench.run(&specs(2.0));
    let removed = Cache::clean(&bench.root(), Remove::Unreferenced, false).unwrap();
    // One of `a`, two chunks of `b` and what they are together, of the last run and of the one before.
    assert_eq!((removed.entries, removed.kept), (4, 4));
    bench.run(&specs(2.0));
    assert!(bench.computed().is_empty());
    assert_eq!(bench.run(&specs(1.0)).stage("a").unwrap().why, "config changed: value");
}

#[test]
fn results_are_published_once() {
    let bench = Bench::new();
    let folder = Folder::new(&bench.folder.path().join("results"), "study");
    let mut specs = diamond();
    specs.push(stage("ste", 2.0).of(&["a"]).cut(&CUT, &[25.0, 50.0]));
    let run = |specs: &[Spec]| {
        let (study, cache, stop) = (bench.study(specs), bench.cache(), AtomicBool::new(false));
        crate::runner::execute::run(&study, &cache, &bench.options, &Silent, &stop, &folder, None).unwrap()
    };
    let (_, published) = run(&specs);
    assert_eq!(published.changes.tables.len(), 5);
    let ste = published.manifest.stages.iter().find(|stage| stage.name == "ste").unwrap();
    assert_eq!(folder.table(&ste.tables[0]).unwrap().floats("value"), [28.0, 53.0]);
    assert_eq!(ste.keys.len(), 2);
    assert_eq!(run(&specs).1.changes, Changes::default());
    // The table of one stage changes, the manifest of that and of those below.
    specs[2] = stage("c", 101.0).of(&["a"]);
    assert_eq!(run(&specs).1.changes.tables, ["c.values.parquet", "d.values.parquet"]);
}

/// Whatever else is ready waits, before and after; the order of the study says who comes first.
#[test]
fn a_stage_that_runs_alone_has_no_company() {
    let mut bench = Bench::new();
    bench.options.jobs = 4;
    let mut specs = vec![stage("first", 1.0).mode("alone"), stage("second", 1.0).mode("alone")];
    for name in ["a", "b", "c", "d", "e"] {
        specs.push(stage(name, 1.0).mode("slow"));
    }
    specs.push(stage("after", 1.0).mode("slow").of(&["first"]));
    specs.push(stage("last", 1.0).mode("alone").of(&["second", "a"]));
    let outcome = bench.run(&specs);
    assert_eq!(outcome.faults().count(), 0);
    assert_eq!(bench.computed().len(), specs.len());
}
