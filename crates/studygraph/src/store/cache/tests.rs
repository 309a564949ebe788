//! The cache: what it keeps, what it notices, what cleaning removes.

mod packs;

use super::*;
use crate::store::journal::JournalStage;
use crate::store::manifest::{KeyRecord, Short};
use crate::store::parquet::tests::{assert_identical, everything};
use crate::table::schema::Schema;
use declare::digest::Writer;

fn key(name: &str) -> Digest {
    Writer::new("test").text(name).finish()
}

fn filled(root: &Path) -> Cache {
    let cache = Cache::open(root).unwrap();
    let second = Table::from_rows(everything(0).schema().clone(), vec![]).unwrap();
    let mut schema = second.schema().clone();
    schema.name = "empty".to_owned();
    let second = Table::from_rows(schema, vec![]).unwrap();
    let work = [("contact_solves".to_owned(), 7)].into();
    let of_run = OfRun { seconds: 1.5, work, warnings: vec!["warned".to_owned().into()] };
    cache.put(key("a"), &[&everything(20), &second], of_run).unwrap();
    cache
}

#[test]
fn what_was_put_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().join("deep/cache");
    let cache = filled(&root);
    let Lookup::Found(entry) = cache.look_up(key("a")) else { panic!() };
    let of_run = entry.of_run;
    assert_eq!(
        (of_run.seconds, of_run.work["contact_solves"], &of_run.warnings[0]),
        (1.5, 7, &"warned".to_owned().into())
    );
    assert_eq!(entry.tables[0].content, everything(20).content_hash());
    assert_identical(&cache.table(key("a"), "curve").unwrap(), &everything(20));
    assert_eq!(cache.table(key("a"), "empty").unwrap().rows(), 0);
    assert!(cache.table(key("a"), "absent").is_err());
    assert_eq!(cache.look_up(key("b")), Lookup::Missing);
    assert_eq!(fs::read(root.join(".gitignore")).unwrap(), b"*\n");
    assert!(cache.verify(false).is_empty());
}

#[test]
fn every_cut_and_every_flipped_byte_is_noticed() {
    let folder = tempfile::tempdir().unwrap();
    let cache = filled(folder.path());
    let path = cache.path(key("a"));
    let whole = fs::read(&path).unwrap();
    let readable = || {
        matches!(cache.look_up(key("a")), Lookup::Found(_))
            && ["curve", "empty"].iter().all(|table| cache.table(key("a"), table).is_ok())
    };
    assert!(readable());
    for length in (0..whole.len()).step_by(97) {
        fs::write(&path, &whole[..length]).unwrap();
        assert!(matches!(cache.look_up(key("a")), Lookup::Damaged(_)), "cut to {length}");
    }
    for position in (0..whole.len()).step_by(13) {
        let mut bytes = whole.clone();
        bytes[position] ^= 0x10;
        fs::write(&path, &bytes).unwrap();
        assert!(!readable(), "flipped byte {position}");
        assert_eq!(cache.verify(false).len(), 1, "flipped byte {position}");
    }
    fs::write(cache.path(key("b")), &whole).unwrap_or_else(|_| {
        fs::create_dir_all(cache.path(key("b")).parent().unwrap()).unwrap();
        fs::write(cache.path(key("b")), &whole).unwrap();
    });
    assert_eq!(cache.look_up(key("b")), Lookup::Damaged("it belongs to another key".to_owned()));
}

#[test]
fn two_contents_for_one_key_are_refused_and_the_first_stays() {
    let folder = tempfile::tempdir().unwrap();
    let cache = filled(folder.path());
    let error = cache.put(key("a"), &[&everything(21)], OfRun::default()).unwrap_err().to_string();
    assert!(error.contains("not deterministic") && error.contains("`curve`"), "{error}");
    assert_eq!(cache.table(key("a"), "curve").unwrap().rows(), 20);
    cache.put(key("b"), &[&everything(3)], OfRun::default()).unwrap();
    cache.put(key("b"), &[&everything(3)], OfRun::default()).unwrap();
}

#[test]
fn cleaning_keeps_what_journals_name_and_waits_for_nobody() {
    let folder = tempfile::tempdir().unwrap();
    let cache = filled(folder.path());
    cache.put(key("b"), &[&everything(3)], OfRun::default()).unwrap();
    let start = Short::from(&key("part"));
    let (fields, inputs) = (Arc::default(), Arc::default());
    let (config, code, demand) = (start, start, start);
    let record = KeyRecord { key: key("a"), config, fields, axis: None, code, seed: None, demand, inputs };
    let stage = JournalStage { name: "s".into(), keys: vec![record], ..JournalStage::default() };
    cache.put_journal("study", &Journal::of(std::slice::from_ref(&stage)));
    assert_eq!(cache.journal("study").stages().collect::<Vec<_>>(), [stage]);
    fs::write(cache.path(key("a")).with_file_name(".partial-x"), "left behind").unwrap();

    let busy = Cache::clean(folder.path(), Remove::All, false).unwrap_err();
    assert!(matches!(busy, StoreError::InUse { .. }));
    drop(cache);
    let counts = |removed: Removed| (removed.entries, removed.leftovers, removed.kept);
    assert_eq!(counts(Cache::clean(folder.path(), Remove::Unreferenced, true).unwrap()), (1, 1, 1));
    assert_eq!(counts(Cache::clean(folder.path(), Remove::Unreferenced, false).unwrap()), (1, 1, 1));
    let keep = std::collections::BTreeSet::new();
    let unused = Remove::Unused { keep: &keep, unused: Duration::from_hours(1), most: None };
    assert_eq!(counts(Cache::clean(folder.path(), unused, false).unwrap()), (0, 0, 1));
    let cache = Cache::open(folder.path()).unwrap();
    assert!(matches!(cache.look_up(key("a")), Lookup::Found(_)));
    assert_eq!(cache.look_up(key("b")), Lookup::Missing);
    drop(cache);
    assert_eq!(counts(Cache::clean(folder.path(), Remove::All, false).unwrap()), (1, 0, 0));
    assert_eq!(counts(Cache::clean(&folder.path().join("none"), Remove::All, false).unwrap()), (0, 0, 0));
}

/// A run that writes nothing looks for none; files of others that live stay.
#[cfg(target_os = "linux")]
#[test]
fn a_run_that_writes_removes_what_killed_runs_left() {
    let folder = tempfile::tempdir().unwrap();
    drop(filled(folder.path()));
    let cache = Cache::open(folder.path()).unwrap();
    let own = cache.path(key("b")).parent().unwrap().to_owned();
    let folders = [folder.path().to_owned(), own]
        .into_iter()
        .chain(["entries", "journals", "notes", "packs"].map(|name| folder.path().join(name)));
    let boot = blake3::hash(crate::store::owner::boot().as_bytes()).to_hex()[..8].to_owned();
    let (mut left, mut others) = (Vec::new(), Vec::new());
    for folder in folders {
        fs::create_dir_all(&folder).unwrap();
        // Of a container that is gone, and of another computer.
        for (files, name) in
            [(&mut left, format!("0badc0de-1-0-{boot}-")), (&mut others, "0badc0de-1-0-0-0".to_owned())]
        {
            files.push(folder.join(format!(".partial-{name}")));
            fs::write(files.last().unwrap(), "left").unwrap();
        }
    }
    assert!(matches!(cache.look_up(key("a")), Lookup::Found(_)));
    assert!(left.iter().all(|path| path.exists()), "without a write");
    cache.put(key("b"), &[&everything(3)], OfRun::default()).unwrap();
    assert_eq!(left.iter().filter(|path| path.exists()).count(), 0, "{left:?}");
    assert!(others.iter().all(|path| path.exists()));
}

#[test]
fn a_folder_that_cannot_be_made_is_one_clear_error() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("file"), "").unwrap();
    let error = Cache::open(&folder.path().join("file/cache")).err().unwrap().to_string();
    assert!(error.contains("cannot open `") && error.contains("file/cache"), "{error}");
}

/// What cannot be written is kept in memory, whatever the reason, and is as good as what was written.
#[test]
fn what_the_disk_does_not_take_is_there_all_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let entry = |cache: &Cache| {
        let Lookup::Found(entry) = cache.look_up(key("a")) else { panic!() };
        assert_identical(&cache.table(key("a"), "curve").unwrap(), &everything(20));
        assert!(cache.table(key("a"), "absent").is_err());
        entry
    };
    let root = folder.path().join("cache");
    let kept = filled(&root);
    assert!(!kept.is_unkept(key("a")) && kept.problems() == (None, None));
    let on_disk = entry(&kept);
    let path = kept.path(key("a"));
    let bytes = fs::read(&path).unwrap();
    let put = |cache: &Cache, rows: usize| {
        let schema = Schema { name: "empty".to_owned(), ..everything(0).schema().clone() };
        let empty = Table::from_rows(schema, vec![]).unwrap();
        cache.put(key("a"), &[&everything(rows), &empty], on_disk.of_run.clone())
    };
    let spoiled = folder.path().join("spoiled");
    drop(Cache::open(&spoiled).unwrap());
    fs::write(spoiled.join("entries"), "no folder").unwrap();
    for cache in [Cache::open(&spoiled).unwrap(), Cache::open_if_possible(&spoiled.join("entries"))] {
        put(&cache, 20).unwrap();
        assert_eq!(entry(&cache), on_disk);
        assert!(cache.is_unkept(key("a")) && cache.problems().0.is_some());
        cache.forget(key("a"));
        assert_eq!(entry(&cache), on_disk);
        // Still an error: it is not a fault of the disk.
        assert!(matches!(put(&cache, 21), Err(StoreError::NotDeterministic { .. })));
        assert_eq!(cache.journal("study"), Journal::default());
        cache.put_journal("study", &Journal::default());
    }
    // A folder in the place of an entry: an empty one goes, another one stays.
    fs::remove_file(&path).unwrap();
    fs::create_dir(&path).unwrap();
    assert_eq!(kept.look_up(key("a")), Lookup::Damaged("it is not a regular file".to_owned()));
    put(&kept, 20).unwrap();
    assert!(!kept.is_unkept(key("a")) && fs::read(&path).unwrap() == bytes);
    fs::remove_file(&path).unwrap();
    fs::create_dir_all(path.join("mine")).unwrap();
    put(&kept, 20).unwrap();
    assert!(kept.is_unkept(key("a")) && path.join("mine").is_dir());
    entry(&kept);
}

/// Ages are set by hand: what is kept stays whatever its age, of the rest the longest unused goes first, and what a run
/// used counts from then on.
#[test]
fn the_longest_unused_goes_first_and_what_is_kept_never() {
    let folder = tempfile::tempdir().unwrap();
    let cache = Cache::open(folder.path()).unwrap();
    let names = ["old", "kept", "used", "young"];
    for (name, rows) in names.iter().zip(1..) {
        cache.put(key(name), &[&everything(rows)], OfRun::default()).unwrap();
    }
    let days = |days: u64| SystemTime::now() - Duration::from_hours(24 * days);
    let age =
        |path: &Path, age: SystemTime| File::options().append(true).open(path).unwrap().set_modified(age).unwrap();
    for (name, old) in names.iter().zip([50, 60, 70, 5]) {
        age(&cache.path(key(name)), days(old));
    }
    let short = Short::from(&key("part"));
    let record = KeyRecord {
        key: key("used"),
        config: short,
        fields: Arc::default(),
        axis: None,
        code: short,
        seed: None,
        demand: short,
        inputs: Arc::default(),
    };
    let stage = JournalStage { name: "s".into(), keys: vec![record], ..JournalStage::default() };
    cache.put_journal("study", &Journal::of(&[stage]));
    let journal = cache.journal_path("study");
    let noted = || fs::metadata(&journal).unwrap().modified().unwrap();
    let before = noted();
    cache.note_use("study");
    assert_eq!(noted(), before, "noted a moment ago");
    age(&journal, days(40));
    cache.note_use("study");
    assert!(noted() >= before);
    age(&journal, days(10));
    cache.note_use("nobody");
    let size = |name: &str| fs::metadata(cache.path(key(name))).unwrap().len();
    let (kept, used, young) = (size("kept"), size("used"), size("young"));
    drop(cache);
    let keep = [key("kept")].into();
    let there = || {
        let cache = Cache::open(folder.path()).unwrap();
        names.map(|name| matches!(cache.look_up(key(name)), Lookup::Found(_)))
    };
    let clean = |days: u64, most: Option<u64>| {
        let unused = Duration::from_hours(24 * days);
        Cache::clean(folder.path(), Remove::Unused { keep: &keep, unused, most }, false).unwrap()
    };
    let removed = clean(30, None);
    assert_eq!(there(), [false, true, true, true]);
    assert_eq!((removed.needed, removed.needed_bytes, removed.kept), (1, kept, 3));
    clean(30, Some(kept + used + young));
    assert_eq!(there(), [false, true, true, true]);
    clean(30, Some(kept + used + young - 1));
    assert_eq!(there(), [false, true, false, true], "used ten days ago, before what is five days old");
    let removed = clean(30, Some(1));
    assert_eq!(there(), [false, true, false, false]);
    assert_eq!((removed.kept_bytes, removed.needed_bytes), (kept, kept), "more than it may, and said");
}
