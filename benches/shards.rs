//! A study in pieces: what all pieces and the merge take together, in the processor time of one run.

use std::fmt::Write;
use std::path::Path;
use std::process::{Command, Stdio};

/// Torques and designs of the study: 128 parts of many curves.
const TORQUES: usize = 512;
const DESIGNS: usize = 16;
/// How often each is measured; the fastest counts.
const ROUNDS: usize = 3;

fn study() -> String {
    let mut text = String::from(
        "study: pieces\n\
         stages:\n\
         \x20 pair:\n\
         \x20   kind: geometry\n\
         \x20   module: 3 mm\n\
         \x20   pinion: { teeth: 24, face_width: 20 mm, bore_radius: 15 mm }\n\
         \x20   gear: { teeth: 36, face_width: 20 mm, bore_radius: 15 mm }\n\
         \x20 stiffness: { kind: stiffness, pair: pair }\n",
    );
    writeln!(text, "  ste: {{ kind: ste, stiffness: stiffness, designs: designs, torque: {{ from: 50 N m, to: 250 N m, count: {TORQUES} }} }}")
        .expect("a string takes all");
    text += "  designs:\n    kind: modification\n    pair: pair\n    designs:\n";
    for design in 0..DESIGNS {
        writeln!(text, "      d{design}: [tip_relief: {{ gear: both, amount: {design} um, length: 3 mm }}]")
            .expect("a string takes all");
    }
    text
}

/// Processor time of all processes that were waited for, in seconds; a hundredth of one is the least.
fn spent() -> f64 {
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // Behind the name in brackets; the 14th and 15th from there are user and system time of children.
    let fields = text.rsplit_once(')').map_or("", |(_, rest)| rest);
    let of_children = fields.split_whitespace().skip(13).take(2);
    of_children.filter_map(|field| field.parse::<f64>().ok()).sum::<f64>() / 100.0
}

fn run(folder: &Path, words: &[&str]) -> f64 {
    let before = spent();
    let mut command = Command::new(env!("CARGO_BIN_EXE_gearstudy"));
    command.arg("--quiet").args(words).current_dir(folder).env_remove("GEARSTUDY_CACHE");
    let status = command.stdin(Stdio::null()).stdout(Stdio::null()).status().expect("the program was built");
    assert!(status.success(), "{words:?} failed");
    spent() - before
}

/// How many shards a plan has: at most as many as were asked for, since a part is never cut.
fn shards(plan: &Path) -> usize {
    let text = std::fs::read(plan.join("plan.json")).expect("a plan was made");
    let plan: serde_json::Value = serde_json::from_slice(&text).expect("a plan is JSON");
    plan["shards"].as_array().expect("it has shards").len()
}

fn bytes(folder: &Path) -> u64 {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    entries.filter_map(|entry| entry.metadata().ok()).map(|metadata| metadata.len()).sum()
}

/// Prints the ratios.
pub fn print() {
    println!("\n{} curves in pieces, processor time in that of one run, fastest of {ROUNDS}:", TORQUES * DESIGNS);
    let fresh = || {
        let folder = tempfile::tempdir().expect("there is a place for temporary files");
        std::fs::write(folder.path().join("pieces.yaml"), study()).expect("the folder is ours");
        folder
    };
    let fastest = |one: &dyn Fn() -> [f64; 3]| {
        (0..ROUNDS).map(|_| one()).min_by(|a, b| a.iter().sum::<f64>().total_cmp(&b.iter().sum())).unwrap_or_default()
    };
    let [whole, ..] = fastest(&|| [run(fresh().path(), &["run", "pieces.yaml", "--jobs", "1"]), 0.0, 0.0]);
    println!("one run: {whole:.2} s");
    println!("{:>8} {:>8} {:>8} {:>8} {:>8} {:>12}", "asked", "planned", "all", "shards", "merge", "kB a curve");
    for count in [1, 8, 32, 128] {
        let (size, made) = (std::cell::Cell::new(0), std::cell::Cell::new(0));
        let [planning, computing, merging] = fastest(&|| {
            let folder = fresh();
            let path = folder.path();
            let asked = count.to_string();
            let planning = run(path, &["shard", "plan", "pieces.yaml", "--shards", &asked, "--into", "plan"]);
            let planned = shards(&path.join("plan"));
            let computing =
                (0..planned).map(|shard| run(path, &["shard", "run", "plan", &shard.to_string(), "--jobs", "1"]));
            let computing = computing.sum();
            made.set(planned);
            size.set(bytes(&path.join("plan/shards")));
            [planning, computing, run(path, &["shard", "merge", "plan", "--jobs", "1"])]
        });
        let all = planning + computing + merging;
        let each = size.get() as f64 / 1e3 / (TORQUES * DESIGNS) as f64;
        let planned = made.get();
        let [all, computing, merging] = [all, computing, merging].map(|seconds| seconds / whole);
        println!("{count:>8} {planned:>8} {all:>8.2} {computing:>8.2} {merging:>8.2} {each:>12.2}");
    }
}
