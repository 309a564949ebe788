//! A real run's files in the eyes of other programs: pyarrow, h5py, and the program's own CSV.

use std::ffi::OsStr;

use crate::desk::Desk;
use crate::python;

#[test]
fn pyarrow_h5py_and_csv_read_the_same_values() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "quick.yaml"], 0);
    let (study, results) = (desk.path("quick.yaml"), desk.path("results/quick"));
    let program = OsStr::new(env!("CARGO_BIN_EXE_gearstudy"));
    let Some(said) = python::run("read_back.py", &[program, study.as_os_str(), results.as_os_str()]) else { return };
    let count = |what: &str| {
        let before = said.split(&format!(" {what}")).next().unwrap();
        before.rsplit(' ').next().unwrap().trim().parse::<usize>().unwrap()
    };
    // As many as the manifest lists, and enough of everything to mean something.
    assert_eq!(count("tables"), desk.contents("quick").len(), "{said}");
    assert!(count("tables") >= 20 && count("columns") > 100 && count("values") > 10_000, "{said}");
    assert!(count("keys") > 10 && count("units") > 40, "{said}");
}
