//! GNU Parallel over local slots.

use std::fs;
use std::process::{Command, Stdio};
use std::time::Duration;

use super::{assert_as_local, installed, program, swept};

#[test]
fn gnu_parallel_runs_the_pieces_over_two_slots() {
    if !installed("shards by GNU Parallel", &["parallel"], "parallel") {
        return;
    }
    let desk = swept();
    fs::write(desk.path("site.yaml"), "slots: 2\n").unwrap();
    let words =
        ["run", "swept.yaml", "--engine", "parallel", "--shards", "8", "--into", "a plan", "--profile", "site.yaml"];
    let (out, error) = desk.run(&words, 0);
    assert!(format!("{out}{error}").contains("starting 8 of 8 shards: 0-7"), "{out}{error}");
    assert_as_local(&desk);
    let log = fs::read_to_string(desk.path("a plan/logs/joblog")).unwrap();
    assert_eq!(log.lines().count(), 9, "a heading and a line for each: {log}");
    assert!(log.lines().skip(1).all(|line| line.split('\t').nth(6) == Some("0")), "{log}");
    // A shard that leaves nothing is started as often as the profile says, and then it is told where to look.
    fs::remove_file(desk.path("a plan/shards/2.pack")).unwrap();
    fs::write(desk.path("site.yaml"), "slots: 2\nprogram: /bin/true\nattempts: 2\n").unwrap();
    let (out, error) = desk.run(&words, 3);
    let said = format!("{out}{error}");
    assert_eq!(said.matches("starting 1 of 8 shards: 2").count(), 2, "{said}");
    assert!(said.contains("shard 2 was started 2 times and left nothing; their output is in `"), "{said}");
}

/// A signal ends the watching with its code, and the same command goes on from there. Not that of Ctrl-C, which is ignored, and
/// is to stay so, where tests run in the background of a script.
#[test]
fn a_stopped_command_goes_on_from_where_it_was() {
    if !installed("shards by GNU Parallel", &["parallel"], "parallel") {
        return;
    }
    let desk = swept();
    fs::write(desk.path("site.yaml"), "slots: 1\n").unwrap();
    let words =
        ["run", "swept.yaml", "--engine", "parallel", "--shards", "10", "--into", "plan", "--profile", "site.yaml"];
    let mut command = Command::new(program());
    command.args(words).current_dir(desk.path("")).env_remove("GEARSTUDY_CACHE");
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    while !fs::read_dir(desk.path("plan/shards"))
        .is_ok_and(|mut packs| packs.any(|pack| pack.unwrap().path().ends_with("0.pack")))
    {
        std::thread::sleep(Duration::from_millis(10));
    }
    assert!(Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(143), "{error}");
    assert!(error.contains("the same command goes on from here"), "{error}");
    assert!(!desk.path("results").exists());
    let (out, error) = desk.run(&words, 0);
    assert!(
        !format!("{out}{error}").contains("starting 10 of 10"),
        "what was there is not computed again: {out}{error}"
    );
    assert_as_local(&desk);
}
