//! One table of everything that was measured, against its target where it has one.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::measured::BASE;
use crate::program::Process;

/// Bench or process, its target \[s\], what is compared.
const TARGETS: &[(&str, f64, &str)] = &[
    ("study energy_ga, cold", 1.0, "whole process, no cache, no results"),
    ("study energy_ga, nothing to do", 10e-3, "whole process, everything cached and published"),
    ("gearstudy --version", 3e-3, "whole process"),
    ("stage/optimum", 0.3, "genetic, 100 × 100, 64 positions, all threads"),
    ("diff/report 1e5 rows x 9", 0.1, "two folders of Parquet to the text, rows by key"),
    ("diff/report 1e6 rows x 9", 1.0, "as before"),
    ("finite elements/48 teeth, 0.2 %", 1.0, "influence functions of a gear at 0.2 % accuracy, one thread"),
    ("finite elements/48 teeth, resolved, 0.1 %", 50e-3, "tables of a gear with resolved contact, one thread"),
    ("finite elements/curve, resolved, uncoupled", 30e-6, "64 positions, both tips relieved, one thread"),
    ("finite elements/curve, resolved, coupled, corner contact", 150e-6, "as before"),
    (
        "finite elements/both sweeps of mei2016",
        1.0,
        "1,250 coupled curves with corner contact, 24 positions, all threads",
    ),
    ("profile/whole gear, 17 teeth x 200 points", 100e-6, "exact points of all teeth, one thread"),
    ("profile/whole gear, 48 teeth x 200 points", 100e-6, "as before"),
    ("profile/sweep of 10,000 designs", 0.5, "pairs with both profiles and every check, one thread"),
    ("designs/ste of 8,000", 0.8, "one torque, 64 positions, curves and harmonics as tables, all threads"),
    ("ste/curve uncoupled", 20e-6, "64 positions, crowned, both tips relieved, one thread"),
];

/// One row of the table.
struct Measured {
    name: String,
    median: f64,
    /// Whatever else the machine does only adds, so this is the steadier figure on one that is not idle.
    fastest: f64,
    how: String,
}

pub fn print(processes: &[Process]) {
    let mut rows: Vec<Measured> = Vec::new();
    for &Process { name, median, fastest, times } in processes {
        rows.push(Measured { name: name.to_owned(), median, fastest, how: format!("{times} starts") });
    }
    let found = measured();
    print_traces(&found);
    rows.extend(found);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let load = fs::read_to_string("/proc/loadavg").unwrap_or_default();
    let load = load.split(' ').next().unwrap_or_default().to_owned();
    println!("\nEverything, against its target; {threads} processors, load {load}; ratios are to the target\n");
    println!(
        "{:<40} {:>10} {:>10} {:>10} {:>6} {:>7}  compared",
        "what", "median", "fastest", "target", "median", "fastest"
    );
    for Measured { name, median, fastest, how } in rows {
        let target = TARGETS.iter().find(|(target, ..)| *target == name);
        let (limit, ratios, compared) = match target {
            Some((_, limit, compared)) => {
                let verdict = if median <= *limit { "met" } else { "MISSED" };
                let ratios = format!("{:>6.2} {:>7.2}", median / limit, fastest / limit);
                (duration(*limit), ratios, format!("{verdict}: {compared}; {how}"))
            }
            None => ("-".to_owned(), format!("{:>6} {:>7}", "-", "-"), how),
        };
        let (median, fastest) = (duration(median), duration(fastest));
        println!("{name:<40} {median:>10} {fastest:>10} {limit:>10} {ratios}  {compared}");
    }
}

/// Time of sampled flanks over that of the relief that they are traces of.
fn print_traces(found: &[Measured]) {
    println!("\nFlanks as measured, 500 points, over a parabolic relief: median and fastest\n");
    for Measured { name, median, fastest, .. } in found.iter().filter(|one| one.name.starts_with("measured/")) {
        let trace = name.split_once(", ").and_then(|(_, rest)| rest.split(", ").next()).unwrap_or_default();
        let base = name.replacen(trace, BASE, 1);
        if let Some(base) = found.iter().find(|one| one.name == base && one.name != *name) {
            println!("{name:<60} {:>6.2} {:>6.2}", median / base.median, fastest / base.fastest);
        }
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

/// What criterion left, by name: `group/bench`.
fn measured() -> Vec<Measured> {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| PathBuf::from("target"), PathBuf::from);
    let folder = std::env::var_os("CRITERION_HOME").map_or_else(|| target.join("criterion"), PathBuf::from);
    let mut found = Vec::new();
    collect(&folder, &mut found);
    found.sort_by(|one, two| one.name.cmp(&two.name));
    found
}

fn collect(folder: &Path, found: &mut Vec<Measured>) {
    let read =
        |name: &str| -> Option<Value> { serde_json::from_slice(&fs::read(folder.join("new").join(name)).ok()?).ok() };
    if let (Some(bench), Some(estimates), Some(sample)) =
        (read("benchmark.json"), read("estimates.json"), read("sample.json"))
    {
        let numbers = |name: &str| sample[name].as_array().into_iter().flatten().filter_map(Value::as_f64);
        let fastest = numbers("times").zip(numbers("iters")).map(|(time, count)| time / count);
        found.push(Measured {
            name: bench["full_id"].as_str().unwrap_or("?").to_owned(),
            median: estimates["median"]["point_estimate"].as_f64().unwrap_or(f64::NAN) * 1e-9,
            fastest: fastest.fold(f64::INFINITY, f64::min) * 1e-9,
            how: format!("{} samples by criterion", numbers("iters").count()),
        });
        return;
    }
    let mut folders: Vec<PathBuf> =
        fs::read_dir(folder).into_iter().flatten().flatten().map(|one| one.path()).collect();
    folders.retain(|path| path.is_dir());
    for path in folders {
        collect(&path, found);
    }
}
