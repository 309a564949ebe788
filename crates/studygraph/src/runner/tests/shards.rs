//! Runs in pieces: who computes what, in which order, what is left out, what is refused.

use std::fs;
use std::path::Path;

use super::*;
use crate::runner::shard::{
    Ran, ShardError, ShardPlan, State, merge, of_study, pack_file, plan as divide, plan_file, ranges, state, states,
};

fn numbers(count: u32) -> Vec<f64> {
    (1..=count).map(f64::from).collect()
}

impl Bench {
    fn divided(&self, specs: &[Spec], count: usize, into: &str) -> Result<ShardPlan, ShardError> {
        divide(&self.study(specs), &self.cache(), &self.options, count, &self.folder.path().join(into))
            .map(|(plan, _)| plan)
    }

    fn shard(&self, specs: &[Spec], into: &str, index: usize) -> Result<Ran, ShardError> {
        let folder = self.folder.path().join(into);
        let plan = ShardPlan::read(&folder)?;
        let scratch = tempfile::tempdir().unwrap();
        let stop = AtomicBool::new(false);
        of_study(&self.study(specs), &plan, (&folder, index), scratch.path(), &self.options, &Silent, &stop)
    }

    fn merged(&self, into: &str, cache: &Path) -> Result<usize, ShardError> {
        let cache = Cache::open(cache).unwrap();
        merge(&self.folder.path().join(into), self.program, &cache).map(|(_, merged)| merged.parts)
    }
}

/// Stage and part, in the order of the shards.
fn all_parts(plan: &ShardPlan) -> Vec<(String, usize)> {
    let shares = plan.shards.iter().flat_map(super::super::shard::Shard::share);
    shares.flat_map(|(stage, parts)| parts.into_iter().map(move |part| (stage.clone(), part))).collect()
}

#[test]
fn every_part_is_in_one_shard_and_shards_cost_about_the_same() {
    let bench = Bench::new();
    let specs = [stage("a", 1.0).mode("uneven").cut(&CUT, &numbers(50)), stage("b", 1.0).of(&["a"])];
    let total: f64 = 50.0 * 51.0 / 2.0;
    for count in [1, 2, 3, 7, 25, 50, 51, 1000] {
        let plan = bench.divided(&specs, count, &format!("plan{count}")).unwrap();
        let expected: Vec<_> = (0..50).map(|part| ("a".to_owned(), part)).collect();
        assert_eq!(all_parts(&plan), expected, "{count}");
        assert!(plan.shards.len() <= count && plan.levels.len() == 1);
        let longest = plan.shards.iter().map(|shard| shard.seconds).fold(0.0, f64::max);
        assert!(longest <= total / count as f64 + 51.0, "{count}: {longest}");
        assert!((plan.shards.iter().map(|shard| shard.seconds).sum::<f64>() / total - 1.0).abs() < 0.01);
    }
    assert_eq!(ranges([0, 1, 2, 5, 7, 8]), "0-2,5,7-8");
}

/// `heavy` is computed once, `cheap` by whoever needs it; `c` waits for `b`; `last` is left to the merge.
fn levels() -> Vec<Spec> {
    vec![
        stage("heavy", 2.0).mode("heavy"),
        stage("cheap", 3.0).of(&["heavy"]),
        stage("b", 10.0).of(&["cheap"]).cut(&CUT, &numbers(9)),
        stage("c", 100.0).of(&["b"]).cut(&CUT, &numbers(6)),
        stage("last", 1000.0).of(&["c", "b"]),
    ]
}

#[test]
fn merged_shards_are_what_one_run_computes() {
    let mut local = Bench::new();
    let expected = local.run(&levels());
    let tables = |bench: &Bench, outcome: &Outcome| -> Vec<Vec<f64>> {
        ["heavy", "cheap", "b", "c", "last"].iter().map(|stage| values(bench, outcome, stage)).collect()
    };
    for count in [1, 4, 40] {
        let mut bench = Bench::new();
        let specs = levels();
        let plan = bench.divided(&specs, count, "plan").unwrap();
        assert_eq!(plan.levels.len(), 3, "{:?}", plan.levels);
        let folder = bench.folder.path().join("plan");
        let above = plan.levels[1].first;
        let early = bench.shard(&specs, "plan", above).unwrap_err().to_string();
        assert!(early.contains("run those first"), "{early}");
        for level in &plan.levels {
            // From the last to the first: in any order.
            for index in (level.first..level.end).rev() {
                assert_eq!(state(&folder, &plan, index, true), State::Missing);
                assert!(matches!(bench.shard(&specs, "plan", index).unwrap(), Ran::Packed { .. }));
                assert_eq!(state(&folder, &plan, index, true), State::Sound);
            }
        }
        assert_eq!(count_of(&bench, "heavy"), 1, "once, whatever their number");
        assert_eq!((count_of(&bench, "b"), count_of(&bench, "c"), count_of(&bench, "last")), (9, 6, 0));
        // A second time: as good, and merged all the same.
        bench.shard(&specs, "plan", 0).unwrap();
        assert_eq!(bench.merged("plan", &bench.root()).unwrap(), 1 + 9 + 6);
        assert_eq!(bench.merged("plan", &bench.root()).unwrap(), 1 + 9 + 6, "again");
        let outcome = bench.run(&specs);
        assert_eq!(bench.computed(), ["cheap", "last"], "all else came from the shards");
        assert_eq!(tables(&bench, &outcome), tables(&local, &expected));
    }
}

fn count_of(bench: &Bench, stage: &str) -> usize {
    count(&bench.counter(stage))
}

#[test]
fn what_is_known_is_not_planned_and_goes_along_where_it_is_read() {
    let mut bench = Bench::new();
    let few = [levels()[..2].to_vec(), vec![stage("b", 10.0).of(&["cheap"]).cut(&CUT, &numbers(4))]].concat();
    bench.run(&few);
    let specs = levels();
    let plan = bench.divided(&specs, 100, "plan").unwrap();
    let of_b: Vec<usize> =
        all_parts(&plan).into_iter().filter(|(stage, _)| stage == "b").map(|(_, part)| part).collect();
    assert_eq!(of_b, [4, 5, 6, 7, 8]);
    // `c` reads all of `b`, and a shard has no cache but what it is given.
    assert!(plan.known && plan.levels.len() == 2);
    for index in 0..plan.shards.len() {
        bench.shard(&specs, "plan", index).unwrap();
    }
    assert_eq!(count_of(&bench, "b"), 9);
    bench.merged("plan", &bench.root()).unwrap();
    bench.run(&specs);
    assert_eq!(bench.computed(), ["last"]);
    let nothing = bench.divided(&specs, 100, "again").unwrap();
    assert!(nothing.shards.is_empty() && nothing.levels.is_empty());
    let none = bench.shard(&specs, "again", 0).unwrap_err().to_string();
    assert!(none.contains("nothing is left to compute"), "{none}");
    assert_eq!(bench.merged("again", &bench.root()).unwrap(), 0);
}

#[test]
fn every_cut_and_every_flipped_byte_of_a_pack_is_noticed() {
    let bench = Bench::new();
    let specs = [stage("a", 1.0).cut(&CUT, &numbers(6))];
    let plan = bench.divided(&specs, 2, "plan").unwrap();
    let folder = bench.folder.path().join("plan");
    for index in 0..2 {
        bench.shard(&specs, "plan", index).unwrap();
    }
    let path = pack_file(&folder, 1);
    let whole = fs::read(&path).unwrap();
    let root = bench.folder.path().join("other cache");
    for length in (0..whole.len()).step_by(89).chain([whole.len() - 1]) {
        fs::write(&path, &whole[..length]).unwrap();
        assert!(matches!(state(&folder, &plan, 1, false), State::Damaged(_)), "cut to {length}, seen by its size");
    }
    fs::write(&path, [&whole[..], b"x"].concat()).unwrap();
    assert!(matches!(state(&folder, &plan, 1, false), State::Damaged(_)));
    for position in (0..whole.len()).step_by(31) {
        let mut bytes = whole.clone();
        bytes[position] ^= 0x04;
        fs::write(&path, &bytes).unwrap();
        assert!(matches!(state(&folder, &plan, 1, true), State::Damaged(_)), "flipped byte {position}");
        let refused = bench.merged("plan", &root).unwrap_err().to_string();
        assert!(refused.contains("damaged"), "flipped byte {position}: {refused}");
        // Where only all bytes show it, it is removed: the next look for missing shards finds it.
        assert_ne!(state(&folder, &plan, 1, false), State::Sound, "flipped byte {position}");
    }
    // A hole that the power left, and the pack of another shard.
    fs::write(&path, vec![0; whole.len()]).unwrap();
    assert_eq!(state(&folder, &plan, 1, false), State::Damaged("it does not begin as it should".to_owned()));
    fs::copy(pack_file(&folder, 0), &path).unwrap();
    assert_eq!(state(&folder, &plan, 1, false), State::Damaged("it belongs to another shard".to_owned()));
    fs::remove_file(&path).unwrap();
    let refused = bench.merged("plan", &root).unwrap_err().to_string();
    assert!(refused.contains("of 2 shards") && refused.contains("1 missing (1)"), "{refused}");
    bench.shard(&specs, "plan", 1).unwrap();
    assert_eq!(states(&folder, &plan, true), [State::Sound, State::Sound]);
    assert_eq!(bench.merged("plan", &root).unwrap(), 6);
}

#[test]
fn plans_are_never_mixed() {
    let bench = Bench::new();
    let specs = [stage("a", 1.0).cut(&CUT, &numbers(6))];
    let plan = bench.divided(&specs, 3, "plan").unwrap();
    let bytes = fs::read(plan_file(&bench.folder.path().join("plan"))).unwrap();
    assert_eq!(bench.divided(&specs, 2, "plan").unwrap(), plan, "planned once, whatever is asked the second time");
    assert_eq!(fs::read(plan_file(&bench.folder.path().join("plan"))).unwrap(), bytes);
    let other = divide(
        &Study { text: "other".to_owned(), ..bench.study(&specs) },
        &bench.cache(),
        &bench.options,
        3,
        &bench.folder.path().join("plan"),
    );
    let message = other.unwrap_err().to_string();
    assert!(message.contains("has a plan of `study`, for another text of it"), "{message}");
    // Another program.
    let about = crate::about::About { code: "ffff456789abcdef", version: "0.2.0", ..ABOUT };
    let message = plan.check(&about, Path::new("plan")).unwrap_err().to_string();
    assert!(
        message.contains(
            "version 0.1.0 (code 01234567), and this is version 0.2.0 (code ffff4567), built from other sources"
        ),
        "{message}"
    );
    let about = crate::about::About { dependencies: "new", ..ABOUT };
    assert!(plan.check(&about, Path::new("plan")).unwrap_err().to_string().contains("other dependencies"));
    // The pack of another plan.
    let more = [stage("a", 1.0).cut(&CUT, &numbers(7))];
    let second = bench.divided(&more, 3, "second").unwrap();
    bench.shard(&more, "second", 0).unwrap();
    fs::copy(pack_file(&bench.folder.path().join("second"), 0), pack_file(&bench.folder.path().join("plan"), 0))
        .unwrap();
    assert_ne!(plan.digest, second.digest);
    assert_eq!(
        state(&bench.folder.path().join("plan"), &plan, 0, false),
        State::Damaged("it belongs to another plan".to_owned())
    );
    // A plan that somebody wrote into.
    let path = plan_file(&bench.folder.path().join("plan"));
    fs::write(&path, String::from_utf8(bytes).unwrap().replace("\"text\":\"\"", "\"text\":\"study: b\"")).unwrap();
    let message = ShardPlan::read(&bench.folder.path().join("plan")).unwrap_err().to_string();
    assert!(message.contains("the study in it is not the one that was planned"), "{message}");
    for (bytes, expected) in [("{", "it is no plan"), ("", "it is no plan")] {
        fs::write(&path, bytes).unwrap();
        let message = ShardPlan::read(&bench.folder.path().join("plan")).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    }
}

#[test]
fn what_fails_says_so_in_the_place_of_its_pack() {
    let bench = Bench::new();
    let specs = [stage("a", 1.0).mode("fail").cut(&CUT, &numbers(4))];
    let plan = bench.divided(&specs, 2, "plan").unwrap();
    let folder = bench.folder.path().join("plan");
    let failed = bench.shard(&specs, "plan", 0).unwrap_err();
    assert!(matches!(&failed, ShardError::Failed(message) if message.contains("3 teeth are too few")), "{failed}");
    let State::Failed(message) = state(&folder, &plan, 0, true) else { panic!() };
    assert_eq!(message, "stage `a` failed: 3 teeth are too few");
    let refused = bench.merged("plan", &bench.root()).unwrap_err().to_string();
    assert!(refused.contains("1 missing (1), 1 failed (0)"), "{refused}");
    // Mended, for example by more memory.
    bench.shard(&[stage("a", 1.0).cut(&CUT, &numbers(4))], "plan", 0).unwrap();
    assert_eq!(state(&folder, &plan, 0, true), State::Sound);
    assert_eq!(fs::read_dir(folder.join("shards")).unwrap().count(), 1);
}

/// Tables that differ under one key are an error of the program, wherever they come from.
#[test]
fn shards_that_disagree_are_not_merged() {
    let bench = Bench::new();
    let specs = [stage("a", 1.0).mode("counted").cut(&CUT, &numbers(3))];
    bench.divided(&specs, 1, "plan").unwrap();
    bench.shard(&specs, "plan", 0).unwrap();
    bench.merged("plan", &bench.root()).unwrap();
    bench.shard(&specs, "plan", 0).unwrap();
    let refused = bench.merged("plan", &bench.root()).unwrap_err().to_string();
    assert!(refused.contains("not deterministic"), "{refused}");
}
