//! The page of the largest study: its size, and how long a browser takes to paint it; how much later than its run the page of a
//! study that is watched shows what was saved.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::summary::duration;

const STUDY: &str = "mei2016";
const MOST_BYTES: f64 = 500e3;
const MOST_SECONDS: f64 = 0.3;
const MOST_LATE: f64 = 0.3;
const TIMES: usize = 9;

pub fn print() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = tempfile::tempdir().expect("there is a place for temporary files");
    let mut run = Command::new(env!("CARGO_BIN_EXE_gearstudy"));
    run.arg("run").arg("--quiet").arg(root.join("studies").join(format!("{STUDY}.yaml")));
    run.arg("--results").arg(folder.path()).arg("--cache").arg(folder.path().join("cache"));
    assert!(run.status().expect("it starts").success(), "{STUDY} runs");
    let page = folder.path().join(STUDY).join("report.html");
    let bytes = fs::metadata(&page).expect("it has a page").len() as f64;
    let load = fs::read_to_string("/proc/loadavg").unwrap_or_default();
    println!("\nThe page of {STUDY}; load {}\n", load.split(' ').next().unwrap_or_default());
    println!("size: {:.0} kB, {:.2} of {:.0} kB", bytes / 1e3, bytes / MOST_BYTES, MOST_BYTES / 1e3);
    let python = root.join(".venv/bin/python");
    let script = root.join("tests/python/first_paint.py");
    let output = Command::new(&python).arg(script).arg(&page).arg(TIMES.to_string()).output();
    let Some(output) = output.ok().filter(|output| output.status.success()) else {
        println!("first paint: not measured, there is no {} or no Chromium", python.display());
        return;
    };
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let mut seconds: Vec<f64> = text.lines().filter_map(|line| Some(1e-3 * line.parse::<f64>().ok()?)).collect();
    seconds.sort_by(f64::total_cmp);
    let (fastest, median) = (seconds[0], seconds[seconds.len() / 2]);
    let [shown, at_best] = [median, fastest].map(duration);
    println!(
        "first paint: {shown}, {:.2} of 300 ms; at best {at_best}, {:.2}",
        median / MOST_SECONDS,
        fastest / MOST_SECONDS
    );
    watched(root, &python, folder.path());
}

/// From a save to the new page in a browser that has it open, without what the run takes.
fn watched(root: &Path, python: &Path, folder: &Path) {
    let study = fs::copy(root.join("studies/quick.yaml"), folder.join("quick.yaml"));
    study.expect("there is a place for temporary files");
    let script = root.join("tests/python/watch.py");
    let output = Command::new(python).arg(script).arg(env!("CARGO_BIN_EXE_gearstudy")).arg(folder).output();
    let text = output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
    let seconds: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    let [fastest, median, ..] = seconds[..] else {
        println!("page of a watched study: not measured, `watch.py` has failed");
        return;
    };
    println!(
        "page of a watched study, after the run: {}, {:.2} of 300 ms; at best {}, {:.2}",
        duration(median),
        median / MOST_LATE,
        duration(fastest),
        fastest / MOST_LATE
    );
}
