//! SIGKILL at random moments of a study of very many stages: the next run goes on from there, and all come to the same.
//!
//! By itself few moments of a study of some hundred stages; `GEARSTUDY_KILLS=50x5000` kills at 50 moments of 5,000 stages.
//! Must not know: how entries are kept.

use std::collections::BTreeSet;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::cache::TINY;
use super::disk::{self, Place};
use super::faults::thorough;
use super::published::{differences, published};
use studygraph::store::cache::{Cache, Lookup};
use studygraph::store::manifest::Manifest;
use studygraph::store::results::Folder;

/// Longer than an entry waits for its group and a disk needs for it, on a machine that is busy.
const COMMITTED: Duration = Duration::from_secs(3);

pub fn study(stages: usize) -> String {
    let mut text =
        "study: tiny\nstages:\n  pair:\n    kind: geometry\n    module: 3 mm\n    pressure_angle: 20 deg\n    \
                    material: { youngs_modulus: 206 GPa, poisson_ratio: 0.3 }\n    \
                    pinion: { teeth: 24, face_width: 20 mm, bore_radius: 18 mm }\n    \
                    gear: { teeth: 36, face_width: 20 mm, bore_radius: 28 mm }\n"
            .to_owned();
    for stage in 0..stages {
        let amount = 5.0 + stage as f64 * 1e-3;
        text += &format!("  m{stage}:\n    kind: modification\n    pair: pair\n    designs: {{ a: [ lead_crowning: ");
        text += &format!("{{ gear: pinion, amount: {amount:.3} um }} ] }}\n");
    }
    text
}

/// The moments, and the stages of the study.
fn asked() -> (usize, usize) {
    let asked = std::env::var("GEARSTUDY_KILLS").unwrap_or_else(|_| "6x200".to_owned());
    let (moments, stages) = asked.split_once('x').unwrap();
    (moments.parse().unwrap(), stages.parse().unwrap())
}

/// Starts a run, and kills it after a while; gives the stages that it had told of long enough before, and whether it was
/// killed at all.
fn killed(place: &Place, text: &str, after: Duration) -> (Vec<String>, bool) {
    let mut words = place.words(text);
    words.retain(|word| word != "--quiet");
    let mut child = Command::new(env!("CARGO_BIN_EXE_gearstudy"))
        .args(words)
        .current_dir(&place.root)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let out = BufReader::new(child.stdout.take().unwrap());
    let told = std::thread::spawn(move || {
        let ran = out.lines().map_while(Result::ok).filter(|line| line.split_whitespace().nth(1) == Some("ran"));
        ran.map(|line| (line.split_whitespace().next().unwrap().to_owned(), Instant::now())).collect::<Vec<_>>()
    });
    std::thread::sleep(after);
    let at = Instant::now();
    child.kill().unwrap();
    let was_killed = !child.wait().unwrap().success();
    let told = told.join().unwrap().into_iter();
    (told.filter(|(_, told)| *told + COMMITTED < at).map(|(stage, _)| stage).collect(), was_killed)
}

fn kept(cache: &Path, manifest: &Manifest) -> Vec<String> {
    let cache = Cache::open(cache).unwrap();
    let found = |key| matches!(cache.look_up(key), Lookup::Found(_));
    let stages = manifest.stages.iter().filter(|stage| stage.keys.iter().all(|record| found(record.key)));
    stages.map(|stage| stage.name.clone()).collect()
}

#[test]
fn a_run_that_is_killed_at_any_moment_is_gone_on_with() {
    let (moments, stages) = asked();
    let text = study(stages);
    let home = disk::folder();
    let place = Place::new(home.path());
    let began = Instant::now();
    assert_eq!(place.good_run(&text), 0);
    let lasted = began.elapsed();
    let undisturbed = published(&place.results());
    let manifest = Folder::at(&place.results()).unwrap().manifest().unwrap();
    // splitmix64: the same in every run of the test, as far as the machine is.
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut share = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut done = 0;
    while done < moments {
        let home = disk::folder();
        let place = Place::new(home.path());
        let cache = place.disk.join("cache");
        let mut before = Vec::new();
        let mut kills = 0;
        // Killed again while it goes on from the kill before.
        while kills < 3 && done < moments {
            let (told, was_killed) = killed(&place, &text, lasted.mul_f64(share()));
            done += 1;
            if !was_killed {
                break;
            }
            kills += 1;
            let now = kept(&cache, &manifest);
            let lost: Vec<&String> = before.iter().chain(&told).filter(|stage| !now.contains(*stage)).collect();
            assert!(lost.is_empty(), "{} stages are lost, {:?} …", lost.len(), lost.first());
            before = now;
        }
        assert_eq!(place.good_run(&text), 0);
        let after = published(&place.results());
        assert_eq!(differences(&undisturbed, &after), Vec::<String>::new());
        assert_eq!(kept(&cache, &manifest).len(), stages + 1);
        // Nothing that grows from kill to kill: a pack for each run, and what `gc` takes away.
        let packs = fs::read_dir(cache.join("packs")).map_or(0, Iterator::count);
        assert!(packs <= kills + 1, "{packs} packs after {kills} kills");
        let left = fs::read_dir(place.results()).unwrap().map(|entry| entry.unwrap().file_name());
        assert!(left.into_iter().all(|name| !name.to_string_lossy().starts_with('.')));
    }
}

/// Wherever a run is killed, the next one that writes removes the file that it was at.
#[test]
fn files_of_killed_runs_are_removed_by_the_next() {
    fn left(folder: &Path) -> Vec<PathBuf> {
        let entries = fs::read_dir(folder).into_iter().flatten().map(|entry| entry.unwrap().path());
        let is_left = |path: &PathBuf| path.file_name().unwrap().to_string_lossy().starts_with(".partial-");
        entries.flat_map(|path| if path.is_dir() { left(&path) } else { vec![path] }).filter(is_left).collect()
    }
    if disk::library().is_none() {
        return;
    }
    let changed = TINY.replace("amount: 12 um", "amount: 13 um");
    assert_ne!(TINY, changed);
    let (mut places, mut at) = (BTreeSet::new(), 1);
    loop {
        let home = disk::folder();
        let place = Place::new(home.path());
        let killed = place.run(TINY, &[("SHIM_AT", at.to_string()), ("SHIM_ERROR", "-9".to_owned())]);
        if killed.status.success() {
            break;
        }
        let before = left(&place.disk);
        places.extend(before.iter().map(|path| path.strip_prefix(&place.disk).unwrap().parent().unwrap().to_owned()));
        let next = place.run(&changed, &[]);
        assert!(next.status.success(), "{}", next.error);
        assert_eq!(left(&place.disk), Vec::<PathBuf>::new(), "killed at operation {at}, which left {before:?}");
        at += if thorough() > 0 { 1 } else { 5 };
    }
    let in_cache = places.iter().filter(|place| place.starts_with("cache")).count();
    assert!(in_cache >= 2 && places.iter().any(|place| place.starts_with("results")), "{places:?}");
}

/// Two runs at once on one cache and one folder: each has its pack, and both come to the same.
#[test]
fn two_runs_of_very_many_stages_at_once_agree() {
    let text = study(120);
    let (alone, both) = (disk::folder(), disk::folder());
    let (alone, both) = (Place::new(alone.path()), Place::new(both.path()));
    assert_eq!(alone.good_run(&text), 0);
    let words = both.words(&text);
    let run = || Command::new(env!("CARGO_BIN_EXE_gearstudy")).args(&words).spawn().unwrap();
    let mut runs = [run(), run(), run()];
    assert!(runs.iter_mut().all(|run| run.wait().unwrap().success()));
    assert_eq!(differences(&published(&alone.results()), &published(&both.results())), Vec::<String>::new());
    let manifest = Folder::at(&both.results()).unwrap().manifest().unwrap();
    assert_eq!(kept(&both.disk.join("cache"), &manifest).len(), 121);
}
