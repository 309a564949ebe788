//! Runs that are killed, stopped by Ctrl-C or another signal, or not alone.

use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use std::{fs, thread};

use crate::desk::Desk;
use studygraph::store::cache::Cache;

/// A study that takes a second or two: the quick one with 59 torques, each a chunk of its own.
fn long() -> Desk {
    let desk = Desk::with("quick.yaml");
    let text = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    let more = text
        .replace("{ from: 50 N m, to: 250 N m, count: 5 }", "{ from: 10 N m, to: 300 N m, count: 59 }")
        .replace("population: 24, generations: 40", "population: 6, generations: 4");
    assert!(more.contains("count: 59") && more.contains("population: 6"));
    fs::write(desk.path("quick.yaml"), more).unwrap();
    desk
}

fn start(desk: &Desk) -> Child {
    let program = env!("CARGO_BIN_EXE_gearstudy");
    let mut command = Command::new(if cfg!(target_os = "linux") { "env" } else { program });
    if cfg!(target_os = "linux") {
        // Tests that a shell started in the background ignore Ctrl-C, and so would what they start.
        command.args(["--default-signal=INT,TERM,HUP", program]);
    }
    command
        .current_dir(desk.path("."))
        .env_remove("GEARSTUDY_CACHE")
        .args(["run", "quick.yaml"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Entries in the cache that the next run finds.
fn entries(desk: &Desk) -> usize {
    let root = desk.path(".gearstudy/cache");
    // Looked into and not made.
    if root.join("entries").is_dir() { Cache::open(&root).unwrap().keys().len() } else { 0 }
}

fn wait_for(desk: &Desk, child: &mut Child, count: usize) {
    let began = Instant::now();
    while entries(desk) < count {
        assert!(child.try_wait().unwrap().is_none(), "it ended before it had {count} entries: make the study longer");
        assert!(began.elapsed() < Duration::from_mins(1), "{count} entries are never reached");
        thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn a_killed_run_goes_on_and_ends_as_an_undisturbed_one() {
    let undisturbed = long();
    undisturbed.run(&["run", "quick.yaml"], 0);
    let desk = long();
    // Once while the first stages are being computed, once amid the chunks, once near their end.
    for count in [2, 20, 50] {
        let mut child = start(&desk);
        wait_for(&desk, &mut child, count);
        child.kill().unwrap();
        child.wait().unwrap();
        assert!(!desk.path("results/quick/report.html").exists());
    }
    let kept = entries(&desk);
    let (plan, _) = desk.run(&["plan", "quick.yaml"], 0);
    assert!(plan.contains("of 59 chunks"), "{plan}");
    desk.run(&["run", "quick.yaml"], 0);
    assert_eq!(undisturbed.contents("quick"), desk.contents("quick"));
    assert!(kept >= 50 && entries(&desk) == entries(&undisturbed), "{kept}, {}", entries(&desk));
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_keeps_what_is_finished() {
    let desk = long();
    let mut child = start(&desk);
    wait_for(&desk, &mut child, 15);
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    let output = child.wait_with_output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{error}");
    assert!(error.contains("what was finished is kept"), "{error}");
    let kept = entries(&desk);
    let statuses = desk.statuses("quick");
    let status = |name: &str| statuses.iter().find(|(stage, _)| stage == name).unwrap().1.clone();
    assert_eq!(["pair", "stiffness", "ste"].map(status), ["ran", "ran", "skipped"], "{statuses:?}");
    desk.run(&["run", "quick.yaml"], 0);
    assert!(kept >= 15 && kept < entries(&desk));
    // `ste` was begun, so of it only the missing chunks were computed; what was finished came from the cache.
    assert_eq!(desk.ran("quick"), ["ste", "report"]);
    let undisturbed = long();
    undisturbed.run(&["run", "quick.yaml"], 0);
    assert_eq!(undisturbed.contents("quick"), desk.contents("quick"));
}

#[cfg(unix)]
fn send(child: &Child, signals: &[&str]) {
    for signal in signals {
        let sent = Command::new("kill").args([*signal, &child.id().to_string()]).status().unwrap();
        assert!(sent.success(), "{signal}");
    }
}

#[cfg(unix)]
#[test]
fn the_exit_code_says_which_signal_stopped_a_run() {
    for (signal, code) in [("-TERM", 143), ("-HUP", 129)] {
        let desk = long();
        let mut child = start(&desk);
        wait_for(&desk, &mut child, 4);
        send(&child, &[signal]);
        let output = child.wait_with_output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{error}");
        assert!(error.contains("what was finished is kept"), "{error}");
    }
}

/// Both are waiting when the program goes on: it is at its end before any stage has looked up.
#[cfg(unix)]
#[test]
fn a_second_signal_ends_a_run_at_once() {
    let desk = long();
    let mut child = start(&desk);
    wait_for(&desk, &mut child, 4);
    send(&child, &["-STOP", "-TERM", "-INT", "-CONT"]);
    let output = child.wait_with_output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(matches!(output.status.code(), Some(130 | 143)), "{:?}: {error}", output.status);
    assert!(error.contains("once more to stop at once") && !error.contains("is kept"), "{error}");
}

/// As `nohup` does it.
#[cfg(target_os = "linux")]
#[test]
fn a_signal_that_is_ignored_from_the_start_stays_ignored() {
    let desk = long();
    let mut child = Command::new("sh")
        .args(["-c", "trap '' HUP; exec \"$0\" run quick.yaml", env!("CARGO_BIN_EXE_gearstudy")])
        .current_dir(desk.path("."))
        .env_remove("GEARSTUDY_CACHE")
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    wait_for(&desk, &mut child, 1);
    send(&child, &["-HUP"]);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn two_runs_of_one_study_in_one_folder_both_end_well() {
    let desk = Desk::with("quick.yaml");
    for round in 0..3 {
        let children: Vec<Child> = (0..3).map(|_| start(&desk)).collect();
        for child in children {
            let output = child.wait_with_output().unwrap();
            let error = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "round {round}: {error}");
        }
        assert!(desk.run(&["run", "quick.yaml"], 0).0.contains("nothing to do"));
        desk.run(&["table", "quick.yaml", "ste.curve"], 0);
        fs::remove_dir_all(desk.path("results")).unwrap();
        if round == 1 {
            fs::remove_dir_all(desk.path(".gearstudy")).unwrap();
        }
    }
}
