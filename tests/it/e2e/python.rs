//! A real run's files in the eyes of other programs: pyarrow, h5py, and the program's own CSV.

use std::ffi::OsStr;
use std::fs;
use std::path::Path;

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

/// The guide's lines for Python, each run as they stand, in the folder where the guide is.
#[test]
fn the_recipes_of_the_guide_run_and_units_arrive() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["new", "my-study.yaml"], 0);
    desk.run(&["run", "--quiet", "my-study.yaml"], 0);
    let guide = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/guide.md")).unwrap();
    let recipes: Vec<&str> =
        guide.split("\n```python\n").skip(1).map(|rest| rest.split("\n```").next().unwrap()).collect();
    assert_eq!(recipes.len(), 3);
    let mut said = String::new();
    for recipe in recipes {
        let Some(one) = python::run_lines("docs/guide.md", recipe, &desk.path(".")) else { return };
        said += &one;
    }
    // By pandas and Polars as names of columns, by DuckDB as rows.
    assert!(said.matches("peak_to_peak [um]").count() >= 2, "{said}");
    let row = |line: &str| line.contains("peak_to_peak") && line.contains("│ um");
    assert!(said.lines().any(row), "{said}");
}

/// What Excel is given is read by a reader that is told as much of it as Excel knows, and holds the same numbers.
#[test]
fn excel_reads_the_numbers_of_the_table() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    let table = |format: &str| desk.run(&["table", "quick.yaml", "ste.summary", "--format", format], 0).0;
    for format in ["csv", "excel", "excel-comma"] {
        fs::write(desk.path(format), table(format)).unwrap();
    }
    let lines = "\
import pandas
plain = pandas.read_csv('csv')
point = pandas.read_csv('excel', encoding='utf-8-sig')
comma = pandas.read_csv('excel-comma', encoding='utf-8-sig', sep=';', decimal=',')
assert list(plain.columns) == list(point.columns) == list(comma.columns), comma.columns
assert (comma.dtypes == plain.dtypes).all(), comma.dtypes
assert plain.equals(point) and plain.equals(comma)
assert open('excel', 'rb').read(3) == b'\\xef\\xbb\\xbf'
print(len(plain))
";
    let said = python::run_lines("excel", lines, &desk.path("."));
    assert!(said.is_none_or(|said| said.trim() == "20"));
}
