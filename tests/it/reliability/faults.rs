//! Every operation on the disk fails once, and from then on: the run says so or its results are right, and the next run is
//! well in every case.
//!
//! By itself some of the operations see one error each, for time; `GEARSTUDY_FAULTS=each` fails every operation once and
//! lasting and every fourth allocation, `GEARSTUDY_FAULTS=all` with every error and every allocation. Must not know: which
//! operations there are.

use std::fs;
use std::path::Path;

use rayon::prelude::*;

use super::cache::TINY;
use super::disk::{self, EINTR, EIO, ENOSPC, EROFS, Ended, Place, SHORT};
use super::published::{Published, differences, published};

/// What was published before: one stage more, and a figure of another name.
pub fn earlier() -> String {
    let more = "  others:\n    kind: modification\n    pair: pair\n    designs:\n      long:\n        - tip_relief: { gear: both, \
                amount: 9 um, fraction: 1.0, curve: linear }\n  report:\n";
    let text = TINY.replace("  report:\n", more).replace("name: relief", "name: earlier");
    assert!(text != TINY && text.contains("others"));
    text
}

/// What a study publishes when nothing goes wrong.
pub fn undisturbed(study: &str) -> Published {
    let folder = disk::folder();
    let place = Place::new(folder.path());
    assert_eq!(place.good_run(study), 0);
    let published = published(&place.results());
    assert!(published.len() > 8, "{:?}", published.keys());
    published
}

/// The state that each case begins with.
pub struct Before {
    pub folder: tempfile::TempDir,
}

impl Before {
    pub fn of(studies: &[&str]) -> Self {
        let folder = disk::folder();
        let place = Place::new(folder.path());
        for study in studies {
            assert_eq!(place.good_run(study), 0);
        }
        Self { folder }
    }

    pub fn copy(&self, to: &Path) {
        copy(self.folder.path(), to);
    }
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let (path, target) = (entry.as_ref().unwrap().path(), to.join(entry.unwrap().file_name()));
        if path.is_dir() {
            copy(&path, &target);
        } else {
            fs::copy(&path, &target).unwrap();
        }
    }
}

/// How many operations a run takes, and how many allocations while it publishes.
pub fn counted(before: &Before, study: &str) -> (usize, usize) {
    let folder = disk::folder();
    before.copy(folder.path());
    let place = Place::new(folder.path());
    let count = place.root.join("count");
    let orders = [("SHIM_COUNT", count.display().to_string()), ("SHIM_MEMORY", i64::MAX.to_string())];
    let Ended { status, out, error } = place.run(study, &orders);
    assert!(status.success(), "{out}{error}");
    let text = fs::read_to_string(count).unwrap();
    let mut numbers = text.split_whitespace().map(|number| number.parse().unwrap());
    (numbers.next().unwrap(), numbers.next().unwrap())
}

/// One run under orders and a good one after it; what is wrong with them.
fn tried(before: &Before, study: &str, expected: &Published, orders: &[(&str, String)], abort: bool) -> Vec<String> {
    let folder = disk::folder();
    before.copy(folder.path());
    let place = Place::new(folder.path());
    let count = place.root.join("count");
    let mut all = orders.to_vec();
    all.push(("SHIM_COUNT", count.display().to_string()));
    let Ended { status, error, .. } = place.run(study, &all);
    let failed = fs::read_to_string(count).unwrap_or_default();
    let failed = failed.split_whitespace().skip(2).collect::<Vec<_>>().join(" ");
    let mut wrong = Vec::new();
    let mut complain = |what: String| wrong.push(format!("{orders:?} ({failed}): {what}"));
    match status.code() {
        Some(0) => {
            let found = differences(expected, &published(&place.results()));
            if !found.is_empty() {
                complain(format!("it ended with 0, but {found:?} differ\n{error}"));
            }
        }
        Some(1..=3) if error.contains("gearstudy: ") && !error.contains("panicked") => {}
        // libhdf5 ends the program by itself when it cannot begin.
        None | Some(255) if abort => {}
        _ => complain(format!("it ended with {status}\n{error}")),
    }
    let code = place.good_run(study);
    if code != 0 {
        complain(format!("the run after it ended with {code}"));
    }
    let found = differences(expected, &published(&place.results()));
    if !found.is_empty() {
        complain(format!("after a good run {found:?} differ; the first said\n{error}"));
    }
    wrong
}

/// 0: some operations see one error each; 1: each sees one error once and another one lasting; 2: each sees every error.
pub fn thorough() -> u8 {
    match std::env::var("GEARSTUDY_FAULTS").as_deref() {
        Ok("each") => 1,
        Ok("all") => 2,
        _ => 0,
    }
}

fn every_operation(before: &Before, study: &str, step: usize) {
    let expected = undisturbed(study);
    let (operations, _) = counted(before, study);
    assert!(operations > 50, "only {operations}: is the disk of the run the one that fails?");
    let errors = [ENOSPC, EIO, EINTR, EROFS, SHORT];
    let (mut wrong, mut cases) = (Vec::new(), 0);
    let mut case = |at: usize, error: i32, lasting: bool| {
        let orders = [("SHIM_AT", at.to_string()), ("SHIM_ERROR", error.to_string())];
        let lasting = lasting.then(|| ("SHIM_LASTING", "1".to_owned()));
        let orders: Vec<_> = orders.into_iter().chain(lasting).collect();
        wrong.extend(tried(before, study, &expected, &orders, false));
        cases += 1;
    };
    for (index, at) in (1..=operations).step_by(if thorough() > 0 { 1 } else { step }).enumerate() {
        match thorough() {
            2 => {
                for error in errors {
                    case(at, error, false);
                    case(at, error, true);
                }
            }
            1 => {
                case(at, errors[index % 5], false);
                case(at, errors[(index + 2) % 5], true);
            }
            _ => case(at, errors[index / 2 % 5], index % 2 == 1),
        }
    }
    println!("{operations} operations, {cases} cases");
    assert!(wrong.is_empty(), "{} of {cases} cases:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn a_first_run_survives_the_failure_of_any_operation() {
    if disk::library().is_some() {
        every_operation(&Before::of(&[]), TINY, 7);
    }
}

/// Tables and figures go, others come, and the cache has some of it.
#[test]
fn a_changed_study_survives_the_failure_of_any_operation() {
    if disk::library().is_some() {
        every_operation(&Before::of(&[&earlier()]), TINY, 11);
    }
}

/// With nothing to do there is little to fail, and nothing to lose.
#[test]
fn a_run_with_nothing_to_do_survives_the_failure_of_any_operation() {
    if disk::library().is_some() {
        every_operation(&Before::of(&[TINY]), TINY, 3);
    }
}

/// Whether these tests would see it: a disk that says of lost bytes that it has them is as a program that looks at no result.
#[test]
fn a_write_whose_failure_nobody_hears_of_is_seen_here() {
    if disk::library().is_none() {
        return;
    }
    let (before, expected) = (Before::of(&[]), undisturbed(TINY));
    let (operations, _) = counted(&before, TINY);
    let lie = |at: usize| {
        let orders = [("SHIM_AT", at), ("SHIM_ERROR", 5), ("SHIM_LASTING", 1), ("SHIM_LIES", 1)];
        tried(&before, TINY, &expected, &orders.map(|(name, value)| (name, value.to_string())), false)
    };
    // What comes after the manifest's bytes is its index, which is not missed when it is lost.
    let seen = (operations / 2..operations * 9 / 10).step_by(operations / 18).filter(|at| !lie(*at).is_empty()).count();
    assert!(seen >= 4, "only {seen} were seen");
}

/// The program ends at once when it gets no memory; that is as good as being killed.
#[test]
fn publishing_survives_the_failure_of_an_allocation() {
    if disk::library().is_none() {
        return;
    }
    let (before, expected) = (Before::of(&[&earlier()]), undisturbed(TINY));
    let (_, allocations) = counted(&before, TINY);
    assert!(allocations > 500, "{allocations}");
    // Each takes two runs of the program: all of them an hour.
    let tries = [24, allocations / 4, allocations][usize::from(thorough())];
    println!("{allocations} allocations, {tries} cases");
    let wrong: Vec<String> = (0..tries)
        .into_par_iter()
        .flat_map_iter(|index| {
            let at = 1 + index * allocations / tries;
            tried(&before, TINY, &expected, &[("SHIM_MEMORY", at.to_string())], true)
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Nobody can be told when results and log lie on one full disk; the code tells.
#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_error_is_no_panic() {
    let folder = disk::folder();
    let place = Place::new(folder.path());
    fs::write(place.disk.join("results"), "in the way").unwrap();
    for arguments in [place.words(TINY), vec!["check".to_owned(), "missing.yaml".to_owned()], vec!["--help".to_owned()]]
    {
        let full = || fs::File::options().write(true).open("/dev/full").unwrap();
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_gearstudy"));
        let status = command.args(&arguments).stdout(full()).stderr(full()).status().unwrap();
        assert!(matches!(status.code(), Some(1 | 2)), "{arguments:?}: {status}");
    }
}
