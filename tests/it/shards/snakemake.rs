//! The rules for Snakemake that `docs/cluster.md` shows.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::{assert_as_local, installed, program, swept};

/// What stands between the fences behind this line of the page.
fn shown(page: &str, language: &str) -> String {
    let text = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(page)).unwrap();
    let (_, rest) =
        text.split_once(&format!("```{language}\n")).unwrap_or_else(|| panic!("{page} shows no {language}"));
    rest.split_once("\n```").unwrap().0.to_owned() + "\n"
}

/// `$GEARSTUDY_SNAKEMAKE`, the one that `make setup` installs, or that on the path.
fn snakemake() -> Option<PathBuf> {
    if let Some(named) = std::env::var_os("GEARSTUDY_SNAKEMAKE").filter(|named| !named.is_empty()) {
        return Some(named.into());
    }
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join(".venv/snakemake/bin/snakemake");
    if own.is_file() {
        return Some(own);
    }
    installed("shards by Snakemake", &["snakemake"], "snakemake").then(|| "snakemake".into())
}

#[test]
fn snakemake_runs_the_pieces_by_the_rules_that_are_documented() {
    let Some(snakemake) = snakemake() else { return };
    let desk = swept();
    fs::write(
        desk.path("Snakefile"),
        shown("docs/cluster.md", "python").replace("study.yaml", "swept.yaml").replace("SHARDS = 100", "SHARDS = 5"),
    )
    .unwrap();
    let folder = program().parent().unwrap().to_owned();
    let path =
        std::env::join_paths(std::iter::once(folder).chain(std::env::split_paths(&std::env::var_os("PATH").unwrap())))
            .unwrap();
    let run = |words: &[&str]| {
        let mut command = Command::new(&snakemake);
        let output = command
            .args(["--cores", "2", "--quiet"])
            .args(words)
            .current_dir(desk.path(""))
            .env("PATH", &path)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{said}");
    };
    run(&[]);
    assert_as_local(&desk);
    // One piece is lost: that one is run again, and merged.
    fs::remove_file(desk.path("plan/shards/3.pack")).unwrap();
    let before = fs::metadata(desk.path("plan/shards/1.pack")).unwrap().modified().unwrap();
    fs::remove_dir_all(desk.path("results")).unwrap();
    run(&[]);
    assert_eq!(fs::metadata(desk.path("plan/shards/1.pack")).unwrap().modified().unwrap(), before);
    assert_as_local(&desk);
}
