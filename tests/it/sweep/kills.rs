//! SIGKILL at random moments of a sweep, a disk that fails, three runs at once: no torn file is taken for a part, no part that
//! was there is lost, and in the end everything is as an undisturbed run publishes it.
//!
//! By itself few moments; `GEARSTUDY_SWEEP_KILLS=50` kills at fifty. Must not know: how parts are kept.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::parts::{TORQUES, grid};
use crate::reliability::disk::{self, Place};
use crate::reliability::published::{differences, published};
use declare::digest::Digest;
use studygraph::store::cache::{Cache, Lookup};
use studygraph::store::file::TEMPORARY;
use studygraph::store::results::Folder;

/// 30,000 rows in some parts, each with a file of its own.
fn text() -> String {
    grid("from: 1 um, to: 30 um, count: 20", TORQUES).replace("study: t\n", "study: tiny\n")
}

/// The keys of the parts, from the manifest of an undisturbed run.
fn keys(place: &Place) -> Vec<Digest> {
    let manifest = Folder::at(&place.results()).unwrap().manifest().unwrap();
    let sweep = manifest.stages.iter().find(|stage| stage.name == "sweep").unwrap();
    sweep.keys.iter().map(|record| record.key).collect()
}

/// Those of which every byte is what was written; none is damaged.
fn sound(cache: &Path, keys: &[Digest]) -> BTreeSet<usize> {
    let cache = Cache::open(cache).unwrap();
    let is_sound = |key: &Digest| match cache.look_up(*key) {
        Lookup::Found(_) => cache.table(*key, "rows").map(|_| true).unwrap(),
        Lookup::Missing => false,
        Lookup::Damaged(why) => panic!("a torn file is taken for a part: {why}"),
    };
    keys.iter().enumerate().filter(|(_, key)| is_sound(key)).map(|(part, _)| part).collect()
}

fn partial(folder: &Path) -> usize {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let count = |path: std::path::PathBuf| {
        let is_partial = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(TEMPORARY));
        usize::from(is_partial) + if path.is_dir() { partial(&path) } else { 0 }
    };
    entries.map(|entry| count(entry.path())).sum()
}

fn start(place: &Place, text: &str) -> std::process::Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gearstudy"));
    command.args(place.words(text)).current_dir(&place.root);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

#[test]
fn a_sweep_that_is_killed_at_any_moment_is_gone_on_with() {
    let moments = std::env::var("GEARSTUDY_SWEEP_KILLS").map_or(4, |moments| moments.parse().unwrap());
    let text = text();
    let home = disk::folder();
    let undisturbed = Place::new(home.path());
    let began = Instant::now();
    assert!(start(&undisturbed, &text).wait().unwrap().success());
    let lasted = began.elapsed();
    let (keys, wanted) = (keys(&undisturbed), published(&undisturbed.results()));
    assert!(keys.len() > 3 && wanted.contains_key("sweep.rows.parquet"), "{} parts", keys.len());
    // splitmix64: the same in every run of the test, as far as the machine is.
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut share = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    };
    let (mut done, mut killed, mut kept) = (0, 0, 0);
    while done < moments {
        let home = disk::folder();
        let place = Place::new(home.path());
        let cache = place.disk.join("cache");
        let mut before = BTreeSet::new();
        // Killed again while it goes on from the kill before; the later, the less is left to do.
        for _ in 0..4 {
            let mut child = start(&place, &text);
            std::thread::sleep(lasted.mul_f64(share()));
            child.kill().unwrap();
            let was_killed = !child.wait().unwrap().success();
            done += 1;
            killed += usize::from(was_killed);
            let now = if cache.exists() { sound(&cache, &keys) } else { BTreeSet::new() };
            assert!(before.is_subset(&now), "parts are lost: {before:?}, then {now:?}");
            before = now;
            if !was_killed || done == moments {
                break;
            }
            kept += before.len();
        }
        assert!(start(&place, &text).wait().unwrap().success());
        assert_eq!(differences(&wanted, &published(&place.results())), Vec::<String>::new());
        assert_eq!(sound(&cache, &keys).len(), keys.len());
        assert_eq!(partial(&place.results()), 0, "leftovers among the results");
        // What is left of kills in the cache goes when it is cleaned up, and nothing else does.
        let gc = Command::new(env!("CARGO_BIN_EXE_gearstudy"))
            .args(["gc", "--results"])
            .arg(place.disk.join("results"))
            .arg("--cache")
            .arg(&cache)
            .current_dir(&place.root)
            .output()
            .unwrap();
        assert!(gc.status.success(), "{}", String::from_utf8_lossy(&gc.stderr));
        assert_eq!((partial(&cache), sound(&cache, &keys).len()), (0, keys.len()));
    }
    // Past the capture of a test that passes, where many were asked for.
    if moments > 4 {
        eprintln!("{done} moments, {killed} kills, {kept} parts there when it was gone on with");
    }
    // A run that is done before its moment was not killed: on a machine that others leave meanwhile most may be.
    assert!(killed > 0, "none of {done} runs was killed");
}

/// The disk is full, broken, or takes half of what it is given, at moments all over a run. What the run says and leaves is
/// sound, and the next one ends as an undisturbed one. That errors are reported, `reliability::faults` holds.
#[test]
fn a_disk_that_fails_under_a_sweep_costs_time_alone() {
    if disk::library().is_none() {
        return;
    }
    let text = text();
    let home = disk::folder();
    let undisturbed = Place::new(home.path());
    let counted = home.path().join("counted");
    let ended = undisturbed.run(&text, &[("SHIM_COUNT", counted.to_string_lossy().into_owned())]);
    assert!(ended.status.success(), "{}", ended.error);
    let operations = fs::read_to_string(&counted).unwrap();
    let operations: usize = operations.split_whitespace().next().unwrap().parse().unwrap();
    let (keys, wanted) = (keys(&undisturbed), published(&undisturbed.results()));
    for (turn, error) in [disk::ENOSPC, disk::EIO, disk::SHORT].into_iter().enumerate() {
        for step in 0..3 {
            let at = 1 + (operations * (2 * step + 1) + turn * operations / 3) / 7;
            let home = disk::folder();
            let place = Place::new(home.path());
            let lasting = usize::from(step == 1).to_string();
            let orders = [("SHIM_AT", at.to_string()), ("SHIM_ERROR", error.to_string()), ("SHIM_LASTING", lasting)];
            let ended = place.run(&text, &orders);
            let is_reported = !ended.status.success() || !ended.error.is_empty();
            assert!(
                step != 1 || error == disk::SHORT || is_reported,
                "an error that lasts is reported: {error} at {at}"
            );
            let there = if place.disk.join("cache").exists() {
                sound(&place.disk.join("cache"), &keys)
            } else {
                BTreeSet::new()
            };
            assert!(start(&place, &text).wait().unwrap().success());
            let case = format!("{error} at {at} of {operations}, {} parts: {}", there.len(), ended.error);
            assert_eq!(differences(&wanted, &published(&place.results())), Vec::<String>::new(), "{case}");
            assert_eq!(partial(&place.results()), 0, "{case}");
        }
    }
}

/// One cache and one folder for all of them.
#[test]
fn three_runs_of_a_sweep_at_once_agree() {
    let text = text();
    let (alone, shared) = (disk::folder(), disk::folder());
    let (alone, shared) = (Place::new(alone.path()), Place::new(shared.path()));
    assert!(start(&alone, &text).wait().unwrap().success());
    let mut runs = [0, 1, 2].map(|turn| {
        std::thread::sleep(Duration::from_millis(turn * 100));
        start(&shared, &text)
    });
    assert!(runs.iter_mut().all(|run| run.wait().unwrap().success()));
    assert_eq!(differences(&published(&alone.results()), &published(&shared.results())), Vec::<String>::new());
    assert_eq!(partial(&shared.results()), 0);
}
