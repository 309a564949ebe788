//! GNU Parallel over local slots.

use std::fs;

use super::{assert_as_local, installed, swept};

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
    assert!(said.contains("shards 2 were started 2 times and left nothing; what they said is in `"), "{said}");
}
