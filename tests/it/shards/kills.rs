//! Pieces that are killed at any moment, run twice at once, and a disk that is full: no torn file is taken for a pack, no
//! finished piece is lost, and in the end everything is as one run makes it.

use std::fs;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use super::{assert_as_local, program, swept};
use crate::desk::Desk;
#[cfg(target_os = "linux")]
use crate::reliability::disk;

const SHARDS: usize = 6;
/// The run is killed at the operation, as the failing disk has it.
#[cfg(target_os = "linux")]
const KILLED: i32 = -9;

fn planned() -> Desk {
    let desk = swept();
    desk.run(&["shard", "plan", "swept.yaml", "--shards", &SHARDS.to_string(), "--into", "plan"], 0);
    desk
}

fn start(desk: &Desk, index: usize) -> Child {
    let mut command = Command::new(program());
    command.args(["--quiet", "shard", "run", "plan", &index.to_string()]).current_dir(desk.path(""));
    command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

fn sound(desk: &Desk) -> Vec<usize> {
    let (out, _) = desk.run(&["shard", "status", "plan", "--check", "--json"], 0);
    serde_json::from_value(serde_json::from_str::<serde_json::Value>(&out).unwrap()["sound"].clone()).unwrap()
}

/// Two of each shard at once, each killed after another time; `status --check` (code 0) finds nothing that is damaged.
#[test]
fn killed_pieces_leave_nothing_that_is_taken_for_a_pack() {
    let desk = planned();
    let mut finished: Vec<usize> = Vec::new();
    for round in 0..3_u64 {
        for index in 0..SHARDS {
            let mut children = [start(&desk, index), start(&desk, index)];
            // From before anything happened to after the end, which takes some hundred milliseconds.
            std::thread::sleep(Duration::from_millis((round * 120 + index as u64 * 11) % 500));
            for child in &mut children {
                child.kill().unwrap();
                child.wait().unwrap();
            }
        }
        let now = sound(&desk);
        assert!(finished.iter().all(|index| now.contains(index)), "round {round}: {finished:?}, then {now:?}");
        finished = now;
        if finished.len() == SHARDS {
            break;
        }
    }
    for index in 0..SHARDS {
        assert!(start(&desk, index).wait().unwrap().success());
    }
    // The merge as well.
    for moment in [50, 200, 400] {
        let mut child = Command::new(program());
        let child = child.args(["--quiet", "shard", "merge", "plan"]).current_dir(desk.path(""));
        let mut child = child.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(moment));
        child.kill().unwrap();
        child.wait().unwrap();
    }
    desk.run(&["shard", "merge", "plan"], 0);
    assert_as_local(&desk);
}

/// The n-th operation on the folder of the packs fails, for every n: the disk is full, broken, writes only half, or the
/// piece is killed there. What is there then is a pack or nothing; and the next run finds all in order.
#[cfg(target_os = "linux")]
#[test]
fn a_disk_that_fails_costs_a_piece_and_no_more() {
    let Some(library) = disk::library() else { return };
    let desk = swept();
    desk.run(&["shard", "plan", "swept.yaml", "--shards", "128", "--into", "plan"], 0);
    let folder = desk.path("plan/shards").canonicalize().unwrap();
    let pack = folder.join("2.pack");
    for error in [disk::ENOSPC, disk::EIO, disk::SHORT, KILLED] {
        let mut failures = 0;
        for at in 1..100 {
            let counted = desk.path("counted");
            let mut command = Command::new(program());
            command.args(["--quiet", "shard", "run", "plan", "2", "--jobs", "1"]).current_dir(desk.path(""));
            command.env("LD_PRELOAD", library).env("SHIM_FOLDER", &folder).env("SHIM_COUNT", &counted);
            command.env("SHIM_AT", at.to_string()).env("SHIM_ERROR", error.to_string());
            let output = command.output().unwrap();
            let said = String::from_utf8_lossy(&output.stderr);
            let left: Vec<_> =
                fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
            let operations: usize = fs::read_to_string(&counted)
                .unwrap_or_default()
                .split_whitespace()
                .next()
                .map_or(0, |count| count.parse().unwrap());
            assert_eq!(sound(&desk).contains(&2), pack.exists(), "{error} at {at}: it is sound or not there");
            if output.status.success() {
                assert_eq!(left, ["2.pack"], "{error} at {at}");
            } else {
                failures += 1;
                assert!(
                    error == KILLED || (output.status.code() == Some(1) && said.contains("plan/shards")),
                    "{error} at {at}: {said}"
                );
                assert!(error == KILLED || left.iter().all(|name| name == "2.pack"), "{error} at {at}: {left:?}");
            }
            for name in &left {
                fs::remove_file(folder.join(name)).unwrap();
            }
            if operations > 0 && operations < at {
                break;
            }
        }
        assert!(failures > 2 || error == disk::SHORT, "{error}: {failures}");
    }
}

/// A cache that takes nothing is told before anything is published.
#[test]
fn a_merge_into_a_cache_that_is_none_is_refused() {
    let desk = planned();
    for index in 0..SHARDS {
        assert!(start(&desk, index).wait().unwrap().success());
    }
    fs::write(desk.path("file"), "").unwrap();
    let (_, error) = desk.run(&["shard", "merge", "plan", "--cache", "file"], 1);
    assert!(error.contains("does not take the shards"), "{error}");
    assert!(!desk.path("results").exists());
    desk.run(&["shard", "merge", "plan"], 0);
    assert_as_local(&desk);
}
