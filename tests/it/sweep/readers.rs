//! The rows of a sweep in the eyes of other programs, in the file as it was published.

use std::ffi::OsStr;
use std::io::Write;

use crate::desk::Desk;
use crate::python;

#[test]
fn duckdb_answers_as_queries_do() {
    let desk = Desk::with("sweep_quick.yaml");
    desk.run(&["run", "sweep_quick.yaml", "--quiet", "--only", "grid"], 0);
    let results = desk.path("results");
    let words = [env!("CARGO_BIN_EXE_gearstudy"), results.to_str().unwrap(), "sweep_quick", "grid", "peak_to_peak"];
    let words = words.map(OsStr::new);
    let Some(said) = python::run("duckdb_rows.py", &words) else { return };
    if said.starts_with("SKIPPED") {
        // Past the capture of a test that passes: nobody shall take this for a check that was made.
        return std::io::stderr().write_all(format!("\n{said}").as_bytes()).unwrap();
    }
    // 6 amounts, 4 lengths, 4 torques; one answer each for both counts, the reasons, 7 best rows, 4 torques.
    let answers: usize = said.split(" rows, ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!(said.starts_with("96 rows, ") && answers >= 1 + 1 + 2 + 7 + 4, "{said}");
}
