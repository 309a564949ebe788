//! The runner when there is nothing to do, and the whole program as a user meets it.

use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use criterion::{Criterion, criterion_group};

use crate::article;
use crate::brief;
use gearstudy::program;
use studygraph::runner::events::Silent;
use studygraph::runner::execute;
use studygraph::runner::options::Options;
use studygraph::runner::plan;
use studygraph::store::cache::Cache;
use studygraph::store::results::Folder;

criterion_group!(name = benches; config = brief(); targets = runner);

fn runner(criterion: &mut Criterion) {
    let folder = tempfile::tempdir().expect("there is a place for temporary files");
    let mut group = criterion.benchmark_group("runner");
    group.bench_function("read study", |bencher| bencher.iter(|| program::load(&article::path())));
    let study = program::load(&article::path()).unwrap_or_else(|error| panic!("{error}"));
    let cache = Cache::open(&folder.path().join("cache")).expect("the folder is ours");
    let results = Folder::new(&folder.path().join("results"), &study.name);
    let (options, stop) = (Options::default(), AtomicBool::new(false));
    let run = || execute::run(&study, &cache, &options, &Silent, &stop, &results, None);
    run().unwrap_or_else(|error| panic!("{error}"));
    group.bench_function("plan of nothing to do", |bencher| bencher.iter(|| plan::plan(&study, &cache, &options)));
    group.bench_function("run of nothing to do", |bencher| bencher.iter(run));
}

/// A command of the program and its wall times.
pub struct Process {
    pub name: &'static str,
    pub median: f64,
    pub fastest: f64,
    pub times: usize,
}

/// Starts the program again and again.
pub fn processes() -> Vec<Process> {
    let folder = tempfile::tempdir().expect("there is a place for temporary files");
    let (results, cache) = (folder.path().join("results"), folder.path().join("cache"));
    let run = || {
        let mut command = Command::new(env!("CARGO_BIN_EXE_gearstudy"));
        command.arg("run").arg(article::path()).arg("--results").arg(&results).arg("--cache").arg(&cache);
        command
    };
    let version = || {
        let mut command = Command::new(env!("CARGO_BIN_EXE_gearstudy"));
        command.arg("--version");
        command
    };
    let remove = |path: &Path| {
        if path.exists() {
            std::fs::remove_dir_all(path).expect("the folder is ours");
        }
    };
    vec![
        timed("study energy_ga, cold", 7, || {
            remove(&results);
            remove(&cache);
            time(run())
        }),
        timed("study energy_ga, nothing to do", 60, || time(run())),
        timed("gearstudy --version", 60, || time(version())),
    ]
}

fn time(mut command: Command) -> Duration {
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let began = Instant::now();
    let status = command.status().expect("the program was built");
    let took = began.elapsed();
    assert!(status.success(), "{command:?} failed");
    took
}

fn timed(name: &'static str, times: usize, mut once: impl FnMut() -> Duration) -> Process {
    let mut taken: Vec<f64> = (0..times).map(|_| once().as_secs_f64()).collect();
    taken.sort_by(f64::total_cmp);
    Process { name, median: taken[times / 2], fastest: taken[0], times }
}
