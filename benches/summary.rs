//! One table of everything that was measured, against its target where it has one.

use std::fs;
use std::path::{Path, PathBuf};

use crate::program::Process;

/// Bench or process, its target \[s\], what is compared.
const TARGETS: &[(&str, f64, &str)] = &[
    ("study energy_ga, cold", 1.0, "whole process, no cache, no results"),
    ("study energy_ga, nothing to do", 15e-3, "whole process, everything cached and published"),
    ("gearstudy --version", 5e-3, "whole process"),
    ("stage/optimum", 0.3, "genetic, 100 × 100, 64 positions, all threads"),
    ("ste/curve uncoupled", 20e-6, "64 positions, crowned, both tips relieved, one thread"),
];

pub fn print(processes: &[Process]) {
    let mut rows: Vec<(String, f64, String)> = processes
        .iter()
        .map(|process| (process.name.to_owned(), process.seconds, format!("median of {}", process.times)))
        .collect();
    let measured = measured().into_iter().map(|(name, seconds)| (name, seconds, "median by criterion".to_owned()));
    rows.extend(measured);
    println!("\nEverything, against its target on this machine\n");
    println!("{:<34} {:>10} {:>10} {:>8}  compared", "what", "measured", "target", "ratio");
    for (name, seconds, how) in rows {
        let target = TARGETS.iter().find(|(target, ..)| *target == name);
        let (limit, ratio, compared) = match target {
            Some((_, limit, compared)) => {
                let verdict = if seconds <= *limit { "" } else { ": MISSED" };
                (duration(*limit), format!("{:.2}", seconds / limit), format!("{compared}; {how}{verdict}"))
            }
            None => ("-".to_owned(), "-".to_owned(), how),
        };
        println!("{name:<34} {:>10} {limit:>10} {ratio:>8}  {compared}", duration(seconds));
    }
}

pub fn duration(seconds: f64) -> String {
    match seconds {
        _ if seconds < 1e-6 => format!("{:.0} ns", seconds * 1e9),
        _ if seconds < 1e-3 => format!("{:.2} µs", seconds * 1e6),
        _ if seconds < 1.0 => format!("{:.2} ms", seconds * 1e3),
        _ => format!("{seconds:.2} s"),
    }
}

/// The medians that criterion left \[s\], by name: `group/bench`.
fn measured() -> Vec<(String, f64)> {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| PathBuf::from("target"), PathBuf::from);
    let folder = std::env::var_os("CRITERION_HOME").map_or_else(|| target.join("criterion"), PathBuf::from);
    let mut found = Vec::new();
    collect(&folder, &mut found);
    found.sort_by(|one, two| one.0.cmp(&two.0));
    found
}

fn collect(folder: &Path, found: &mut Vec<(String, f64)>) {
    let read = |name: &str| -> Option<serde_json::Value> {
        serde_json::from_slice(&fs::read(folder.join("new").join(name)).ok()?).ok()
    };
    if let (Some(bench), Some(estimates)) = (read("benchmark.json"), read("estimates.json")) {
        let name = bench["full_id"].as_str().unwrap_or("?").to_owned();
        found.extend(estimates["median"]["point_estimate"].as_f64().map(|nanoseconds| (name, nanoseconds * 1e-9)));
        return;
    }
    let mut folders: Vec<PathBuf> =
        fs::read_dir(folder).into_iter().flatten().flatten().map(|one| one.path()).collect();
    folders.retain(|path| path.is_dir());
    for path in folders {
        collect(&path, found);
    }
}
