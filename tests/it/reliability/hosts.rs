//! Two computers on one folder: two runs with other names and starts, whose disk knows no `flock`.

use std::fs;
use std::process::Child;
use std::time::Duration;

use serde_json::Value;

use super::cache::TINY;
use super::disk::{self, Place};
use super::faults::undisturbed;
use super::published::{differences, published};
use studygraph::store::index::Stamp;

/// The orders that make a run one of a computer of this name.
fn host(place: &Place, name: &str) -> Vec<(&'static str, String)> {
    let file = |kind: &str, text: String| {
        let path = place.root.join(format!("{kind}-{name}"));
        fs::write(&path, text + "\n").unwrap();
        path.display().to_string()
    };
    vec![
        ("SHIM_NO_FLOCK", "1".to_owned()),
        ("SHIM_HOST", file("host", name.to_owned())),
        ("SHIM_BOOT", file("boot", format!("boot-of-{name}"))),
    ]
}

#[test]
fn two_computers_publish_two_versions_into_one_folder() {
    if disk::library().is_none() {
        return;
    }
    let folder = disk::folder();
    let a = Place::new(folder.path());
    let b = a.beside("other");
    // Another study of the name would be refused; a copy of the same one may have settings.
    let versions: [&[&str]; 2] = [&[], &["--set", "pair.pinion.face_width=21 mm", "--name", "tiny"]];
    let expected = versions.map(|settings| {
        let folder = disk::folder();
        let place = Place::new(folder.path());
        assert!(place.command(TINY, &[]).args(settings).status().unwrap().success());
        published(&place.results())
    });
    let mut last = [0, 0];
    for round in 0..24 {
        if round % 6 == 5 {
            fs::remove_dir_all(a.disk.join("cache")).unwrap();
        }
        let mut first = a.command(TINY, &host(&a, "one"));
        first.args(versions[0]);
        let mut second = b.command(TINY, &host(&b, "two"));
        second.args(versions[1]);
        let (first, second): (Child, Child) = if round % 2 == 0 {
            let first = first.spawn().unwrap();
            (first, second.spawn().unwrap())
        } else {
            let second = second.spawn().unwrap();
            (first.spawn().unwrap(), second)
        };
        for child in [first, second] {
            let output = child.wait_with_output().unwrap();
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        }
        let now = published(&a.results());
        let differing = expected.each_ref().map(|expected| differences(expected, &now));
        let whose = differing.iter().position(Vec::is_empty);
        assert!(whose.is_some(), "round {round}: neither version: {differing:?}");
        last[whose.unwrap()] += 1;
        let left: Vec<_> = fs::read_dir(a.results()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert!(left.iter().all(|name| !name.to_string_lossy().starts_with('.')), "{left:?}");
    }
    println!("the last one was: {last:?}");
}

/// A lock file as a run of `host` writes it.
fn lock_of(host: &str, boot: &str) -> String {
    let machine = fs::read_to_string("/etc/machine-id").unwrap_or_default();
    format!(
        "{{\"host\":\"{host}\",\"machine\":\"{}\",\"boot\":\"{boot}\",\"process\":4194303,\"started\":1,\"space\":\"pid:[1]\",\
         \"since\":\"2026-01-02T03:04:05Z\"}}\n",
        machine.trim()
    )
}

#[test]
fn who_is_waited_for_is_named() {
    if disk::library().is_none() {
        return;
    }
    let folder = disk::folder();
    let place = Place::new(folder.path());
    fs::create_dir_all(place.results()).unwrap();
    let lock = place.results().join(".lock");
    fs::write(&lock, lock_of("elsewhere", "other")).unwrap();
    let child = place.command(TINY, &host(&place, "one")).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(1500));
    assert!(lock.exists() && !place.results().join("manifest.json").exists(), "it did not wait");
    fs::remove_file(&lock).unwrap();
    let output = child.wait_with_output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{error}");
    for words in
        ["waiting for `", "results/tiny", "process 4194303 on the computer `elsewhere`, since 2026-01-02T03:04:05Z"]
    {
        assert!(error.contains(words), "{error}");
    }
    assert!(differences(&undisturbed(TINY), &published(&place.results())).is_empty());
}

/// With nothing to do there is nothing to wait for, also where a look at the files would be worth noting.
#[test]
fn a_run_with_nothing_to_do_waits_for_nobody() {
    if disk::library().is_none() {
        return;
    }
    let folder = disk::folder();
    let place = Place::new(folder.path());
    let orders = host(&place, "one");
    assert!(place.run(TINY, &orders).status.success());
    let table = place.results().join("pair.pair.parquet");
    fs::write(&table, fs::read(&table).unwrap()).unwrap();
    let lock = place.results().join(".lock");
    fs::write(&lock, lock_of("elsewhere", "other")).unwrap();
    let ended = place.run(TINY, &orders);
    assert!(ended.status.success() && !ended.error.contains("waiting"), "{}", ended.error);
    assert!(lock.exists() && differences(&undisturbed(TINY), &published(&place.results())).is_empty());
}

/// What the index says of a file counts until the computer is started anew: a power cut can take the bytes and leave size,
/// times and inode, which is put together here.
#[test]
fn stamps_of_before_a_power_cut_are_not_trusted() {
    if disk::library().is_none() {
        return;
    }
    let folder = disk::folder();
    let place = Place::new(folder.path());
    let (expected, before, after) = (undisturbed(TINY), host(&place, "before"), host(&place, "after"));
    assert!(place.run(TINY, &before).status.success());
    let table = place.results().join("pair.pair.parquet");
    let length = fs::metadata(&table).unwrap().len();
    fs::write(&table, vec![0; usize::try_from(length).unwrap()]).unwrap();
    std::thread::sleep(Duration::from_millis(50));
    let index = place.results().join("files.json");
    let mut noted: Value = serde_json::from_slice(&fs::read(&index).unwrap()).unwrap();
    let files = noted["files"].as_array_mut().unwrap();
    let stamp = files.iter_mut().find(|file| file["file"] == "pair.pair.parquet").unwrap();
    let now = Stamp::of(&fs::metadata(&table).unwrap());
    stamp["stamp"] = serde_json::to_value(now).unwrap();
    fs::write(&index, noted.to_string()).unwrap();
    // In the same start a stamp is as good as a look: that is what makes a run with nothing to do quick.
    assert!(place.run(TINY, &before).status.success());
    assert_eq!(differences(&expected, &published(&place.results())), ["pair.pair.parquet"]);
    assert!(place.run(TINY, &after).status.success());
    assert_eq!(differences(&expected, &published(&place.results())), Vec::<String>::new());
}

/// Of this computer before it was started anew, or of a process that is no more; a run that was killed at any step of it.
#[test]
fn locks_of_the_dead_are_taken_over_without_a_word() {
    if disk::library().is_none() {
        return;
    }
    let folder = disk::folder();
    let place = Place::new(folder.path());
    let expected = undisturbed(TINY);
    let orders = host(&place, "one");
    fs::create_dir_all(place.results()).unwrap();
    let lock = place.results().join(".lock");
    for boot in ["before", "boot-of-one"] {
        let text = lock_of("one", boot);
        let space = fs::read_link("/proc/self/ns/pid").unwrap();
        fs::write(&lock, text.replace("pid:[1]", &space.to_string_lossy())).unwrap();
        let ended = place.run(TINY, &orders);
        assert!(ended.status.success() && ended.error.is_empty() && ended.out.is_empty(), "{}", ended.error);
        assert!(!lock.exists());
        assert!(differences(&expected, &published(&place.results())).is_empty());
        fs::remove_file(place.results().join("manifest.json")).unwrap();
    }
    let mut left = 0;
    for at in (40..400).step_by(18) {
        fs::remove_dir_all(place.results()).unwrap();
        let mut orders = orders.clone();
        orders.extend([("SHIM_AT", at.to_string()), ("SHIM_ERROR", "-9".to_owned())]);
        let killed = place.run(TINY, &orders);
        left += usize::from(lock.exists());
        let ended = place.run(TINY, &host(&place, "one"));
        assert!(
            ended.status.success() && ended.error.is_empty(),
            "killed ({}) at {at}: {}",
            killed.status,
            ended.error
        );
        assert!(differences(&expected, &published(&place.results())).is_empty(), "killed at {at}");
        fs::create_dir_all(place.results()).unwrap();
    }
    assert!(left > 3, "{left} locks were left behind");
}
