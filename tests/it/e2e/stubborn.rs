//! Output that nobody reads, leftovers of killed runs, odd file names: nothing of it may cost results.

use std::process::{Command, Stdio};
use std::{fs, io};

use crate::desk::Desk;

/// `gearstudy run … | head -1`: the reader is gone before the work is done.
#[test]
fn a_run_goes_on_when_nobody_reads_what_it_says() {
    let desk = Desk::with("quick.yaml");
    let (reader, writer) = io::pipe().unwrap();
    drop(reader);
    let mut command = Command::new(env!("CARGO_BIN_EXE_gearstudy"));
    command.current_dir(desk.path(".")).env_remove("GEARSTUDY_CACHE").args(["run", "quick.yaml", "--explain"]);
    assert!(command.stdout(writer).stderr(Stdio::null()).status().unwrap().success());
    assert!(desk.path("results/quick/report.html").is_file());
    assert!(desk.run(&["run", "quick.yaml"], 0).0.contains("nothing to do"));
}

#[cfg(target_os = "linux")]
#[test]
fn a_table_that_cannot_be_printed_is_an_error() {
    let desk = Desk::with("quick.yaml");
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_gearstudy"));
    let output = command.current_dir(desk.path(".")).arg("kinds").stdout(full).output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{error}");
    assert!(error.contains("cannot write to standard output"), "{error}");
}

/// A run that was killed between the manifest and the page, or while it wrote a file.
#[test]
fn leftovers_and_a_page_of_an_earlier_run_are_mended() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "quick.yaml"], 0);
    let page = desk.path("results/quick/report.html");
    let earlier = fs::read(&page).unwrap();
    let text = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    fs::write(desk.path("quick.yaml"), text.replace("count: 5 }", "count: 9 }")).unwrap();
    desk.run(&["run", "quick.yaml"], 0);
    let later = fs::read(&page).unwrap();
    fs::write(&page, &earlier).unwrap();
    fs::write(desk.path("results/quick/.partial-abc"), "").unwrap();
    fs::write(desk.path("results/quick/figures/.partial-def"), "").unwrap();
    let (out, _) = desk.run(&["run", "quick.yaml"], 0);
    assert!(out.contains("nothing to compute, results brought up to date"), "{out}");
    assert!(fs::read(&page).unwrap() == later);
    for folder in ["results/quick", "results/quick/figures"] {
        let mut names = fs::read_dir(desk.path(folder)).unwrap().map(|entry| entry.unwrap().file_name());
        assert!(names.all(|name| !name.to_string_lossy().starts_with('.')));
    }
    let figure = desk.path("results/quick/figures/torque.svg");
    fs::remove_file(&figure).unwrap();
    desk.run(&["run", "quick.yaml"], 0);
    assert!(figure.is_file());
    assert!(desk.run(&["run", "quick.yaml"], 0).0.contains("nothing to do"));
}

#[test]
fn a_stage_that_fails_takes_no_figure_along() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "quick.yaml"], 0);
    let text = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    // So near to its bore that the formula for the body does not hold.
    fs::write(desk.path("quick.yaml"), text.replace("bore_radius: 18 mm", "bore_radius: 32 mm")).unwrap();
    desk.run(&["run", "quick.yaml"], 3);
    for name in ["stiffness", "transmission_error", "torque"] {
        assert!(desk.path(&format!("results/quick/figures/{name}.svg")).is_file(), "{name}");
    }
    let page = fs::read_to_string(desk.path("results/quick/report.html")).unwrap();
    assert!(page.contains("what is shown of it is from its last success"));
}

#[test]
fn a_new_study_is_valid_whatever_its_file_is_called() {
    let desk = Desk::with("quick.yaml");
    let long = format!("{}.yaml", "a".repeat(100));
    for (file, name) in [
        ("My Study.yaml", "my-study"),
        ("ünï cödé.yaml", "n--c-d"),
        ("....yaml", "study"),
        (".yaml", "yaml"),
        ("null.yaml", "study"),
        ("漢字.yaml", "study"),
        (long.as_str(), long.get(..64).unwrap()),
    ] {
        desk.run(&["new", file], 0);
        let (out, _) = desk.run(&["check", file], 0);
        assert!(out.contains(&format!("`{name}` is valid")), "{out}");
    }
}

#[test]
fn every_file_is_checked() {
    let desk = Desk::with("quick.yaml");
    for name in ["a.yaml", "b.yaml"] {
        fs::write(desk.path(name), "study: x").unwrap();
    }
    let (out, error) = desk.run(&["check", "a.yaml", "quick.yaml", "b.yaml"], 2);
    assert!(out.contains("`quick` is valid"), "{out}");
    assert!(error.contains("a.yaml:") && error.contains("b.yaml:"), "{error}");
}

/// Two designs of one name are refused before anything is computed with them.
#[test]
fn designs_of_one_name_are_refused() {
    let desk = Desk::with("quick.yaml");
    let text = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    let with = |from: &str, to: &str| {
        assert!(text.contains(from));
        fs::write(desk.path("quick.yaml"), text.replace(from, to)).unwrap();
    };
    with("designs: [designs, optimum]", "designs: [designs, designs]");
    assert!(desk.run(&["check", "quick.yaml"], 2).1.contains("the designs of `designs` are listed twice"));
    // A report that names a design which is not there is refused before.
    let unnamed = text.replace("design=optimum", "design=short");
    let named = unnamed.replace("    minimize: peak_to_peak", "    name: short\n    minimize: peak_to_peak");
    fs::write(desk.path("quick.yaml"), named).unwrap();
    let (_, error) = desk.run(&["run", "quick.yaml", "--only", "ste"], 3);
    assert!(error.contains("`designs` and `optimum` both give a design called `short`"), "{error}");
    with("    minimize: peak_to_peak", "    name: 'a, b]'\n    minimize: peak_to_peak");
    assert!(desk.run(&["check", "quick.yaml"], 2).1.contains("cannot be the name of a design"));
    with("length: [0.5 mm, 6 mm]", "length: [30 mm, 60 mm]");
    let (_, error) = desk.run(&["run", "quick.yaml", "--only", "optimum"], 3);
    assert!(error.contains("can be built on this pair; in the middle: the relief starts"), "{error}");
}

/// What only the pair can tell of a relief is told where the study states it.
#[test]
fn a_relief_that_does_not_fit_is_shown_in_its_line() {
    let desk = Desk::with("quick.yaml");
    let text = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    let (from, to) = ("fraction: 0.5, curve: linear", "length: 40 mm, curve: linear");
    let line = 1 + text.lines().position(|line| line.contains(from)).unwrap();
    let column = 1 + text.lines().nth(line - 1).unwrap().find("fraction").unwrap();
    fs::write(desk.path("quick.yaml"), text.replace(from, to)).unwrap();
    let place =
        format!("quick.yaml:{line}:{}: design `short`, tip_relief: the relief starts 40.0", column + "length: ".len());
    for (word, code) in [("check", 2), ("run", 3)] {
        let (_, error) = desk.run(&[word, "quick.yaml"], code);
        assert!(error.contains(&place), "{place}: {error}");
    }
}

/// A byte that changed in a published table: whoever reads it says what to do, and a run does it.
#[test]
fn a_damaged_table_is_told_with_the_way_out() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "quick.yaml"], 0);
    let path = desk.path("results/quick/ste.summary.parquet");
    let mut bytes = fs::read(&path).unwrap();
    bytes[300] ^= 1;
    fs::write(&path, bytes).unwrap();
    for words in [vec!["table", "quick.yaml", "ste.summary"], vec!["report", "quick.yaml"]] {
        let (_, error) = desk.run(&words, 1);
        let told =
            error.contains("ste.summary.parquet` is damaged") && error.contains("`gearstudy run` writes it anew");
        assert!(told, "{error}");
    }
    let (out, _) = desk.run(&["run", "quick.yaml"], 0);
    assert!(out.contains("`ste.summary.parquet` was not what the last run wrote; it is written anew"), "{out}");
    desk.run(&["report", "quick.yaml"], 0);
}
