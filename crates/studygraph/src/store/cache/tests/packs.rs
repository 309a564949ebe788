//! Many small entries share a file, and lose nothing by it.

use std::path::PathBuf;

use super::*;

const MANY: usize = ALONE + 30;
/// Entries of the first of two groups.
const FIRST: usize = 18;

fn name(index: usize) -> Digest {
    key(&format!("entry {index}"))
}

fn table(index: usize) -> Table {
    everything(1 + index % 5)
}

/// Entries that were written in two groups.
fn many(root: &Path) -> Cache {
    let cache = Cache::open(root).unwrap();
    for index in 0..MANY {
        put(&cache, index);
        if index + 1 == ALONE + FIRST {
            cache.flush();
        }
    }
    cache
}

fn put(cache: &Cache, index: usize) {
    let of_run = OfRun { seconds: 0.5, warnings: vec![index.to_string().into()], ..OfRun::default() };
    cache.put(name(index), &[&table(index)], of_run).unwrap();
}

fn packs(root: &Path) -> Vec<PathBuf> {
    let mut packs: Vec<_> = fs::read_dir(root.join("packs")).unwrap().map(|entry| entry.unwrap().path()).collect();
    packs.sort();
    packs
}

/// How many entries are found whole; what is found is right.
fn found(cache: &Cache) -> usize {
    let whole = |index: &usize| {
        let Lookup::Found(entry) = cache.look_up(name(*index)) else { return false };
        assert_eq!((entry.key, &entry.of_run.warnings), (name(*index), &vec![index.to_string().into()]));
        let Ok(back) = cache.table(name(*index), "curve") else { return false };
        assert_identical(&back, &table(*index));
        assert_eq!(entry.tables[0].content, back.content_hash());
        true
    };
    (0..MANY).filter(whole).count()
}

#[test]
fn many_small_entries_share_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let cache = many(folder.path());
    assert_eq!(found(&cache), MANY, "also those that wait");
    assert_eq!(cache.bytes(name(MANY - 1), "curve").unwrap(), parquet::write(&table(MANY - 1)).unwrap());
    drop(cache);
    let files = |root: &Path| fs::read_dir(root).unwrap().count();
    assert_eq!(packs(folder.path()).len(), 1);
    let entries = folder.path().join("entries");
    let alone: usize = fs::read_dir(&entries).unwrap().map(|entry| files(&entry.unwrap().path())).sum();
    assert_eq!(alone, ALONE);
    let cache = Cache::open(folder.path()).unwrap();
    assert_eq!(found(&cache), MANY);
    assert!(cache.verify(true).is_empty() && cache.problems() == (None, None));
    // Put again, they are not written again.
    let before = fs::read(&packs(folder.path())[0]).unwrap();
    (0..MANY).for_each(|index| put(&cache, index));
    // Those of a run that keeps few have files, as ever.
    drop(cache);
    assert_eq!(packs(folder.path()).len(), 1);
    assert_eq!(fs::read(&packs(folder.path())[0]).unwrap(), before);
    // A table that does not fit the others under its key.
    let cache = many(folder.path());
    let other = cache.put(name(MANY - 1), &[&everything(9)], OfRun::default()).unwrap_err();
    assert!(matches!(other, StoreError::NotDeterministic { .. }), "{other}");
    // Large tables have files.
    cache.put(key("large"), &[&everything(3000)], OfRun::default()).unwrap();
    assert!(cache.path(key("large")).is_file());
}

/// A group is written without anybody asking, in less than a second on any disk that works.
#[test]
fn a_group_is_written_while_the_run_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let cache = many(folder.path());
    let began = std::time::Instant::now();
    loop {
        // As another process that was started meanwhile sees it.
        let other = Cache::open(folder.path()).unwrap();
        if found(&other) == MANY {
            break;
        }
        assert!(began.elapsed() < Duration::from_mins(1), "nobody writes the second group");
        std::thread::sleep(Duration::from_millis(5));
    }
    drop(cache);
}

/// Cut anywhere, as by a kill: whole groups are found, and what is found is right.
#[test]
fn a_pack_that_is_cut_short_has_its_first_groups() {
    let folder = tempfile::tempdir().unwrap();
    drop(many(folder.path()));
    let path = packs(folder.path()).remove(0);
    let bytes = fs::read(&path).unwrap();
    let mut numbers = std::collections::BTreeSet::new();
    for length in (0..bytes.len()).step_by(bytes.len() / 20).chain([bytes.len()]) {
        fs::write(&path, &bytes[..length]).unwrap();
        let cache = Cache::open(folder.path()).unwrap();
        let count = found(&cache);
        assert!([ALONE, ALONE + FIRST, MANY].contains(&count), "{length}: {count}");
        assert!(cache.verify(false).is_empty(), "a killed run damages nothing");
        numbers.insert(count);
    }
    assert_eq!(numbers.len(), 3);
    // The next run keeps what is missing in a pack of its own.
    fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    drop(many(folder.path()));
    assert_eq!((packs(folder.path()).len(), found(&Cache::open(folder.path()).unwrap())), (2, MANY));
}

/// Any byte: what is found is right, what is not is computed and found again.
#[test]
fn a_damaged_pack_is_noticed() {
    let folder = tempfile::tempdir().unwrap();
    drop(many(folder.path()));
    let path = packs(folder.path()).remove(0);
    let bytes = fs::read(&path).unwrap();
    for at in (0..bytes.len()).step_by(bytes.len() / 23) {
        let mut damaged = bytes.clone();
        damaged[at] ^= 0x10;
        fs::write(&path, &damaged).unwrap();
        let cache = Cache::open(folder.path()).unwrap();
        let count = found(&cache);
        assert!((ALONE..MANY).contains(&count), "byte {at} is in no entry: {count}");
        assert!(!cache.verify(true).is_empty() || count == ALONE || count == ALONE + FIRST, "{at}");
        drop(cache);
        // It is known to be gone by the next run, which computes it.
        assert!(found(&Cache::open(folder.path()).unwrap()) <= count);
        let cache = many(folder.path());
        assert_eq!(found(&cache), MANY);
        drop(cache);
        assert_eq!(found(&Cache::open(folder.path()).unwrap()), MANY, "{at}");
        for path in packs(folder.path()) {
            fs::remove_file(path).unwrap();
        }
    }
}

#[test]
fn cleaning_rewrites_packs() {
    let folder = tempfile::tempdir().unwrap();
    drop(many(folder.path()));
    let start = Short::from(&key("part"));
    let record = |index| KeyRecord {
        key: name(index),
        config: start,
        fields: Arc::default(),
        axis: None,
        code: start,
        seed: None,
        demand: start,
        inputs: Arc::default(),
    };
    let wanted = [0, ALONE + 1, MANY - 1];
    let stage = JournalStage { name: "s".into(), keys: wanted.map(record).into(), ..JournalStage::default() };
    Cache::open(folder.path()).unwrap().put_journal("study", &Journal::of(&[stage]));
    fs::write(folder.path().join("packs/notes.txt"), "mine").unwrap();
    fs::write(folder.path().join("packs/.partial-1-1"), "left").unwrap();
    let before = fs::metadata(&packs(folder.path())[1]).unwrap().len();
    let removed = Cache::clean(folder.path(), Remove::Unreferenced, true).unwrap();
    assert_eq!((removed.entries, removed.kept, removed.leftovers), (MANY - 3, 3, 1));
    assert_eq!(removed.foreign, [folder.path().join("packs/notes.txt")]);
    assert_eq!(found(&Cache::open(folder.path()).unwrap()), MANY, "a dry run");
    assert_eq!(Cache::clean(folder.path(), Remove::Unreferenced, false).unwrap(), removed);
    let cache = Cache::open(folder.path()).unwrap();
    assert_eq!(found(&cache), 3);
    assert!(wanted.iter().all(|index| matches!(cache.look_up(name(*index)), Lookup::Found(_))));
    drop(cache);
    assert!(fs::metadata(&packs(folder.path())[0]).unwrap().len() * 3 < before);
    let removed = Cache::clean(folder.path(), Remove::All, false).unwrap();
    assert_eq!((removed.entries, removed.kept), (3, 0));
    assert_eq!(packs(folder.path()), [folder.path().join("packs/notes.txt")]);
}

/// Where no pack can be made, what was computed is kept in memory, and is told.
#[test]
fn what_the_disk_does_not_take_is_kept_in_memory() {
    let folder = tempfile::tempdir().unwrap();
    let cache = Cache::open(folder.path()).unwrap();
    fs::write(folder.path().join("packs"), "no folder").unwrap();
    (0..MANY).for_each(|index| put(&cache, index));
    cache.flush();
    assert_eq!(found(&cache), MANY);
    assert_eq!((0..MANY).filter(|index| cache.is_unkept(name(*index))).count(), MANY - ALONE);
    assert!(cache.problems().0.unwrap().contains("packs"));
    assert_eq!(cache.problems().0, cache.problems().0);
    drop(cache);
    assert_eq!(found(&Cache::open(folder.path()).unwrap()), ALONE);
}
