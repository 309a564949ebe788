//! The power fails during a run: a recorded run is cut anywhere, and what a file system may lose of it is lost.
//!
//! Of a file what was written since its last `fsync` may be there, in part, as zeros, or not. Of a folder what was made,
//! renamed and removed since its last `fsync` may have happened or not, each by itself: more than any journal loses.
//! Must not know: which files there are.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::time::{Duration, SystemTime};

use super::cache::TINY;
use super::disk::{self, Place};
use super::faults::{Before, earlier, thorough, undisturbed};
use super::kills;
use super::published::{Published, differences, essence, published};
use declare::digest::Digest;
use studygraph::store::cache::{Cache, Lookup};
use studygraph::store::manifest::Manifest;
use studygraph::store::results::{Folder, is_drawn};

/// One thing that a run did to the disk.
enum Step {
    Write {
        file: usize,
        at: usize,
        bytes: Vec<u8>,
    },
    Cut {
        file: usize,
        length: usize,
    },
    Sync {
        file: usize,
    },
    SyncFolder {
        folder: String,
    },
    /// In this folder a name was given or taken.
    Name {
        folder: String,
        change: Change,
    },
}

#[derive(Clone)]
enum Change {
    Give { name: String, file: usize, instead_of: Option<String> },
    Take { name: String },
    MakeFolder { name: String },
    TakeFolder { name: String },
}

/// A disk as it was before, and what was done to it.
struct Trace {
    folders: BTreeSet<String>,
    names: BTreeMap<String, usize>,
    contents: Vec<Vec<u8>>,
    steps: Vec<Step>,
}

fn folder_of(name: &str) -> String {
    name.rsplit_once('/').map_or(String::new(), |(folder, _)| folder.to_owned())
}

impl Trace {
    fn before(disk: &Path) -> Self {
        let mut trace =
            Self { folders: [String::new()].into(), names: BTreeMap::new(), contents: Vec::new(), steps: Vec::new() };
        trace.look_into(disk, "");
        trace
    }

    fn look_into(&mut self, folder: &Path, prefix: &str) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = format!("{prefix}{}", path.file_name().unwrap().to_string_lossy());
            if path.is_dir() {
                self.look_into(&path, &format!("{name}/"));
                self.folders.insert(name);
            } else {
                self.names.insert(name, self.contents.len());
                self.contents.push(fs::read(&path).unwrap());
            }
        }
    }

    /// Adds what the shim wrote down.
    fn record(&mut self, text: &[u8]) {
        let (mut names, mut folders) = (self.names.clone(), self.folders.clone());
        let (mut open, mut files) = (BTreeMap::new(), self.contents.len());
        let mut rest = text;
        while let Some(end) = rest.iter().position(|byte| *byte == b'\n') {
            let line = std::str::from_utf8(&rest[..end]).unwrap().to_owned();
            rest = &rest[end + 1..];
            let words: Vec<&str> = line.split('\t').collect();
            let named = |change: Change, name: &str| Step::Name { folder: folder_of(name), change };
            match words[..] {
                ["open", id, name, cut] => {
                    if folders.contains(name) {
                        continue;
                    }
                    let known = names.get(name).copied();
                    let file = known.unwrap_or(files);
                    if known.is_none() {
                        files += 1;
                        names.insert(name.to_owned(), file);
                        let change = Change::Give { name: name.to_owned(), file, instead_of: None };
                        self.steps.push(named(change, name));
                    } else if cut == "1" {
                        self.steps.push(Step::Cut { file, length: 0 });
                    }
                    open.insert(id.to_owned(), file);
                }
                ["write", id, at, length] => {
                    let length: usize = length.parse().unwrap();
                    let bytes = rest[..length].to_vec();
                    rest = &rest[length..];
                    self.steps.push(Step::Write { file: open[id], at: at.parse().unwrap(), bytes });
                }
                ["truncate", id, length] => {
                    self.steps.push(Step::Cut { file: open[id], length: length.parse().unwrap() });
                }
                ["fsync", id, name] => self.steps.push(match open.get(id) {
                    Some(file) => Step::Sync { file: *file },
                    None => Step::SyncFolder { folder: name.to_owned() },
                }),
                ["rename", from, to] => {
                    let file = names.remove(from).unwrap();
                    names.insert(to.to_owned(), file);
                    assert_eq!(folder_of(from), folder_of(to));
                    let change = Change::Give { name: to.to_owned(), file, instead_of: Some(from.to_owned()) };
                    self.steps.push(named(change, to));
                }
                ["link", from, to] => {
                    let file = names[from];
                    names.insert(to.to_owned(), file);
                    let change = Change::Give { name: to.to_owned(), file, instead_of: None };
                    self.steps.push(named(change, to));
                }
                ["unlink", name] => {
                    names.remove(name).unwrap();
                    self.steps.push(named(Change::Take { name: name.to_owned() }, name));
                }
                ["mkdir", name] => {
                    folders.insert(name.to_owned());
                    self.steps.push(named(Change::MakeFolder { name: name.to_owned() }, name));
                }
                ["rmdir", name] => {
                    folders.remove(name);
                    self.steps.push(named(Change::TakeFolder { name: name.to_owned() }, name));
                }
                _ => panic!("{line}"),
            }
        }
    }

    /// What is on the disk when the power fails before the step `end`.
    fn after_the_cut(&self, end: usize, chance: &mut Chance) -> BTreeMap<String, Vec<u8>> {
        let done = &self.steps[..end];
        // All, most, half or nothing of what need not be there.
        let kept = [1.0, 0.9, 0.5, 0.0][chance.below(4)];
        let (mut names, mut folders) = (self.names.clone(), self.folders.clone());
        for (index, step) in done.iter().enumerate() {
            let Step::Name { folder, change } = step else { continue };
            let later = &done[index..];
            let synced = later.iter().any(|step| matches!(step, Step::SyncFolder { folder: it } if it == folder));
            if !synced && !chance.is(kept) {
                continue;
            }
            match change {
                Change::Give { name, file, instead_of } => {
                    names.insert(name.clone(), *file);
                    if let Some(from) = instead_of {
                        names.remove(from);
                    }
                }
                Change::Take { name } => {
                    names.remove(name);
                }
                Change::MakeFolder { name } => {
                    folders.insert(name.clone());
                }
                Change::TakeFolder { name } => {
                    folders.remove(name);
                }
            }
        }
        let whole = |name: &str| name.match_indices('/').all(|(at, _)| folders.contains(&name[..at]));
        let mut contents = BTreeMap::new();
        for (name, file) in names.into_iter().filter(|(name, _)| whole(name)) {
            contents.insert(name, self.content(file, done, chance));
        }
        // Folders without files, as names that end in a stroke.
        contents.extend(folders.iter().filter(|name| whole(name)).map(|name| (format!("{name}/"), Vec::new())));
        contents
    }

    fn content(&self, file: usize, done: &[Step], chance: &mut Chance) -> Vec<u8> {
        let mut content = self.contents.get(file).cloned().unwrap_or_default();
        let is_sync = |step: &Step| matches!(step, Step::Sync { file: it } if *it == file);
        let synced = done.iter().rposition(is_sync).map_or(0, |position| position + 1);
        let apply = |content: &mut Vec<u8>, step: &Step| match step {
            Step::Write { file: it, at, bytes } if *it == file => {
                content.resize(content.len().max(at + bytes.len()), 0);
                content[*at..at + bytes.len()].copy_from_slice(bytes);
            }
            Step::Cut { file: it, length } if *it == file => content.resize(*length, 0),
            _ => {}
        };
        done[..synced].iter().for_each(|step| apply(&mut content, step));
        let before = content.clone();
        done[synced..].iter().for_each(|step| apply(&mut content, step));
        if content == before {
            return content;
        }
        match chance.below(5) {
            // All of it came to the disk; nothing did; the size did.
            0 => {}
            1 => content = before,
            2 => {
                let length = content.len();
                content = before;
                content.resize(length, 0);
            }
            // The beginning; some blocks.
            3 => content.truncate(chance.below(content.len() + 1)),
            _ => {
                for block in content.chunks_mut(512) {
                    if chance.is(0.5) {
                        block.fill(0);
                    }
                }
            }
        }
        content
    }
}

/// The same in every run of the test (splitmix64).
struct Chance(u64);

impl Chance {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    fn below(&mut self, limit: usize) -> usize {
        usize::try_from(self.next() % limit as u64).unwrap()
    }

    fn is(&mut self, share: f64) -> bool {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64 <= share && share > 0.0
    }
}

fn lay_out(state: &BTreeMap<String, Vec<u8>>, disk: &Path) {
    for name in state.keys().filter_map(|name| name.strip_suffix('/')) {
        fs::create_dir_all(disk.join(name)).unwrap();
    }
    for (name, bytes) in state.iter().filter(|(name, _)| !name.ends_with('/')) {
        let path = disk.join(name);
        fs::write(&path, bytes).unwrap();
        // To start a computer takes longer than a moment.
        if name.ends_with("/.lock") {
            let time = SystemTime::now() - Duration::from_mins(1);
            fs::File::options().write(true).open(path).unwrap().set_modified(time).unwrap();
        }
    }
}

/// The tables of every entry of a cache.
type Tables = BTreeMap<(Digest, String), Vec<u8>>;

/// Those of entries with files of their own, and those that packs may have under these keys.
fn tables(cache: &Cache, disk: &Path, packed: &[Digest]) -> Tables {
    let mut keys: BTreeSet<Digest> = packed.iter().copied().collect();
    let folders = fs::read_dir(disk.join("cache/entries")).into_iter().flatten();
    for folder in folders.map(|folder| folder.unwrap().path()) {
        for entry in fs::read_dir(&folder).into_iter().flatten().map(|entry| entry.unwrap().path()) {
            let part = |path: &Path| path.file_name().unwrap().to_string_lossy().into_owned();
            keys.extend(Digest::from_hex(&(part(&folder) + &part(&entry))));
        }
    }
    let mut tables = Tables::new();
    for key in keys {
        let Lookup::Found(entry) = cache.look_up(key) else { continue };
        for table in &entry.tables {
            if let Ok(bytes) = cache.bytes(key, &table.name) {
                tables.insert((key, table.name.clone()), bytes);
            }
        }
    }
    tables
}

fn keys(manifest: &Manifest) -> impl Iterator<Item = Digest> {
    manifest.stages.iter().flat_map(|stage| &stage.keys).map(|record| record.key)
}

/// What the program takes for good in a state must be good.
fn accepted(place: &Place, whole: &Tables, expected: &Published, manifest: &Manifest) -> Vec<String> {
    let mut wrong = Vec::new();
    let cache = Cache::open_if_possible(&place.disk.join("cache"));
    let packed: Vec<Digest> = whole.keys().map(|(key, _)| *key).collect();
    for (key, bytes) in tables(&cache, &place.disk, &packed) {
        if whole.get(&key) != Some(&bytes) {
            wrong.push(format!("the cache gives a wrong table {}", key.1));
        }
    }
    let folder = Folder::new(&place.disk.join("results"), "tiny");
    let changes = folder.changes(manifest, true);
    for (name, bytes) in expected {
        let written = match name.as_str() {
            "manifest.json" => changes.manifest,
            "tiny.h5" => changes.hdf5,
            name if is_drawn(name) => changes.drawn,
            _ => changes.tables.contains(name),
        };
        let is_good = |there: Vec<u8>| essence(name, there) == *bytes;
        if !written && !fs::read(folder.path().join(name)).is_ok_and(is_good) {
            wrong.push(format!("a run would leave {name} as it is"));
        }
    }
    wrong
}

fn cut_anywhere(first: Option<&str>, study: &str, seed: u64, most: usize) {
    if disk::library().is_none() {
        return;
    }
    let recorded = disk::folder();
    let before = Before::of(&first.into_iter().collect::<Vec<_>>());
    before.copy(recorded.path());
    let place = Place::new(recorded.path());
    let mut trace = Trace::before(&place.disk);
    let (log, boot) = (place.root.join("trace"), place.root.join("boot"));
    fs::write(&boot, "before the power cut\n").unwrap();
    let orders = [("SHIM_TRACE", log.display().to_string()), ("SHIM_BOOT", boot.display().to_string())];
    let ended = place.run(study, &orders);
    assert!(ended.status.success(), "{}", ended.error);
    trace.record(&fs::read(log).unwrap());
    let expected = undisturbed(study);
    assert_eq!(differences(&expected, &published(&place.results())), Vec::<String>::new());
    let manifest = Folder::new(&place.disk.join("results"), "tiny").manifest().unwrap();
    let earlier = Folder::new(&before.folder.path().join("disk/results"), "tiny").manifest();
    let packed: Vec<Digest> = [&manifest].into_iter().chain(&earlier).flat_map(keys).collect();
    let whole = tables(&Cache::open_if_possible(&place.disk.join("cache")), &place.disk, &packed);
    assert!(whole.len() > 3 && trace.steps.len() > 20, "{} tables, {} steps", whole.len(), trace.steps.len());
    // Nothing lost, nothing wrong: the record is that of the run.
    let mut chance = Chance(seed);
    let mut wrong = Vec::new();
    let (states, every) = if thorough() > 0 { (5000, 4) } else { (600, 20) };
    let (mut runs, states) = (0, most.min(states));
    for state in 0..states {
        let end = chance.below(trace.steps.len() + 1);
        let left = trace.after_the_cut(end, &mut chance);
        let folder = disk::folder();
        let place = Place::new(folder.path());
        lay_out(&left, &place.disk);
        let told = format!("state {state}, cut at {end} of {}", trace.steps.len());
        wrong.extend(accepted(&place, &whole, &expected, &manifest).into_iter().map(|what| format!("{told}: {what}")));
        if state % every == 0 {
            runs += 1;
            let code = place.good_run(study);
            let found = differences(&expected, &published(&place.results()));
            if code != 0 || !found.is_empty() {
                wrong.push(format!("{told}: the run after it ended with {code}; {found:?} differ"));
            }
        }
    }
    println!("{} steps, {states} states, {runs} runs", trace.steps.len());
    assert!(wrong.is_empty(), "{} faults:\n{}", wrong.len(), wrong[..wrong.len().min(20)].join("\n"));
}

#[test]
fn a_power_cut_during_a_first_run() {
    cut_anywhere(None, TINY, 1, usize::MAX);
}

#[test]
fn a_power_cut_while_results_change() {
    cut_anywhere(Some(&earlier()), TINY, 2, usize::MAX);
}

/// More small entries than have files of their own: the others are in packs, and their tables in bundles. Then one of many
/// stages changes, and the records and rows of all others stay where they are.
#[test]
fn a_power_cut_while_one_of_many_stages_changes() {
    let many = kills::study(40);
    let other = many.replacen("amount: 5.001 um", "amount: 9.5 um", 1);
    assert_ne!(many, other);
    cut_anywhere(Some(&many), &other, 4, 80);
}

/// The record is what was done: when nothing is lost, the disk is as the run left it.
#[test]
fn a_cut_after_everything_came_to_the_disk_loses_nothing() {
    if disk::library().is_none() {
        return;
    }
    let folder = disk::folder();
    let place = Place::new(folder.path());
    let mut trace = Trace::before(&place.disk);
    let log = place.root.join("trace");
    assert!(place.run(TINY, &[("SHIM_TRACE", log.display().to_string())]).status.success());
    trace.record(&fs::read(log).unwrap());
    let files = trace.contents.len() + trace.steps.len();
    trace.steps.extend((0..files).map(|file| Step::Sync { file }));
    let folders: Vec<String> = trace
        .steps
        .iter()
        .filter_map(|step| if let Step::Name { folder, .. } = step { Some(folder.clone()) } else { None })
        .collect();
    trace.steps.extend(folders.into_iter().map(|folder| Step::SyncFolder { folder }));
    let left = trace.after_the_cut(trace.steps.len(), &mut Chance(3));
    let mut there = Trace::before(&place.disk);
    let names = std::mem::take(&mut there.names);
    let there: BTreeMap<String, Vec<u8>> =
        names.into_iter().map(|(name, file)| (name, std::mem::take(&mut there.contents[file]))).collect();
    let left: BTreeMap<String, Vec<u8>> = left.into_iter().filter(|(name, _)| !name.ends_with('/')).collect();
    assert_eq!(left.keys().collect::<Vec<_>>(), there.keys().collect::<Vec<_>>());
    assert!(left == there);
    assert!(essence("report.html", left["results/tiny/report.html"].clone()).ends_with(b"true"));
}
