//! Clones in which files are not what was committed: other line ends, pointers of Git LFS, results of a newer version.

use std::fs;
use std::process::Command;

use super::diff::git;
use crate::desk::Desk;

/// A study of which everything is committed.
fn committed_whole(text: Option<&str>) -> Desk {
    let desk = Desk::with("quick.yaml");
    if let Some(text) = text {
        fs::write(desk.path("quick.yaml"), text).unwrap();
    }
    git(&desk, &["init", "-q", "-b", "main"]);
    fs::write(desk.path(".gitignore"), ".gearstudy/\n").unwrap();
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    git(&desk, &["add", "-A"]);
    git(&desk, &["commit", "-qm", "one"]);
    desk
}

/// Runs the program in the clone `windows`; all that it says.
fn in_clone(desk: &Desk, words: &[&str], code: i32) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gearstudy"));
    command.current_dir(desk.path("windows")).env_remove("GEARSTUDY_CACHE").args(words);
    let output = command.output().unwrap();
    let said = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
    assert_eq!(output.status.code(), Some(code), "{words:?}: {said}");
    said
}

fn cloned_with_crlf(desk: &Desk) {
    git(desk, &["clone", "-q", "-c", "core.autocrlf=true", ".", "windows"]);
    let manifest = fs::read_to_string(desk.path("windows/results/quick/manifest.json")).unwrap();
    assert!(manifest.contains("\r\n"), "git changed no line ends");
}

/// The HDF5 file differs from run to run, so the index alone has its digest: for a manifest whose line ends git changed as well.
#[cfg(feature = "hdf5")]
#[test]
fn the_index_is_that_of_a_manifest_with_other_line_ends() {
    let desk = committed_whole(None);
    cloned_with_crlf(&desk);
    let file = |at: &str| fs::read(desk.path(at).join("results/quick/quick.h5")).unwrap();
    assert_eq!(file(""), file("windows"));
    for words in [&["status", "quick.yaml"][..], &["run", "quick.yaml"], &["status", "--check", "quick.yaml"]] {
        let said = in_clone(&desk, words, 0);
        assert!(!said.contains("another run") && !said.contains("`quick.h5`"), "{words:?}: {said}");
    }
}

#[test]
fn files_of_a_stage_with_other_line_ends_are_not_damaged() {
    let study = "study: quick\nstages:\n  pair:\n    kind: geometry\n    module: 1.5 mm\n    \
                 pinion: { teeth: 23, face_width: 10 mm, bore_radius: 5 mm }\n    \
                 gear: { teeth: 31, face_width: 10 mm, bore_radius: 6 mm }\n  drawing: { kind: export, pair: pair }\n";
    let desk = committed_whole(Some(study));
    cloned_with_crlf(&desk);
    let said = in_clone(&desk, &["status", "quick.yaml"], 0);
    assert!(said.contains("drawing  line ends  `drawing.") && said.contains("(git's autocrlf)"), "{said}");
    assert!(!said.contains("damaged") && !said.contains("as the manifest lists"), "{said}");
    in_clone(&desk, &["run", "--quiet", "quick.yaml"], 0);
    assert_eq!(in_clone(&desk, &["status", "--check", "quick.yaml"], 0).lines().next(), Some("quick: up to date"));
}

/// A run would lose what a newer version knows.
#[test]
fn results_of_a_newer_version_are_called_so_and_not_replaced() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    let path = desk.path("results/quick/manifest.json");
    let written = fs::read_to_string(&path).unwrap();
    assert!(written.contains("\"format\": 2"));
    for newer in [written.replace("\"format\": 2", "\"format\": 999"), "{ \"format\": 999, \"runs\": 3 }".to_owned()] {
        fs::write(&path, &newer).unwrap();
        for words in [
            &["status", "quick.yaml"][..],
            &["run", "quick.yaml"],
            &["run", "--force", "quick.yaml"],
            &["run", "--dry-run", "quick.yaml"],
            &["report", "quick.yaml"],
            &["table", "quick.yaml"],
            &["diff", "results", "results"],
            &["query", "SELECT 1 FROM quick.ste.summary"],
            &["archive", "quick.yaml", "-o", "b.zip"],
            &["gc", "--days", "0"],
        ] {
            let (out, error) = desk.run(words, 1);
            let said = out + &error;
            assert!(
                said.contains("was written by a newer version of gearstudy: it has format 999"),
                "{words:?}: {said}"
            );
            assert!(said.contains("; use that version") && !said.contains("damaged"), "{words:?}: {said}");
            let is_of_one = !["diff", "query", "gc"].contains(&words[0]);
            assert_eq!(said.contains(", or delete the file, and"), is_of_one, "{words:?}: {said}");
            assert_eq!(fs::read_to_string(&path).unwrap(), newer, "{words:?}");
        }
    }
    // As the message says.
    fs::remove_file(&path).unwrap();
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    desk.run(&["status", "--check", "quick.yaml"], 0);
}

#[test]
fn pointers_of_git_lfs_are_called_so() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    let pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 1\n";
    let path = |name: &str| desk.path("results/quick").join(name);
    let says = |words: &[&str], code: i32| {
        let (out, error) = desk.run(words, code);
        let said = out + &error;
        assert!(said.contains("of Git LFS: `git lfs pull` fetches"), "{words:?}: {said}");
        assert!(!said.contains("damaged") && !said.contains("as the last run wrote"), "{words:?}: {said}");
        said
    };
    let manifest = fs::read(path("manifest.json")).unwrap();
    fs::write(path("manifest.json"), pointer).unwrap();
    for words in [
        &["status", "quick.yaml"][..],
        &["run", "quick.yaml"],
        &["table", "quick.yaml"],
        &["diff", "results", "results"],
        &["archive", "quick.yaml", "-o", "a.zip"],
    ] {
        says(words, 1);
        assert_eq!(fs::read_to_string(path("manifest.json")).unwrap(), pointer, "{words:?}");
    }
    fs::write(path("manifest.json"), manifest).unwrap();

    fs::write(path("ste.summary.parquet"), pointer).unwrap();
    assert!(says(&["status", "quick.yaml"], 0).contains("`ste.summary.parquet` is a pointer"));
    fs::write(path("report.html"), pointer).unwrap();
    let said = says(&["status", "quick.yaml"], 0);
    assert!(said.contains("and 1 more are pointers of Git LFS"), "{said}");
    says(&["status", "--check", "quick.yaml"], 0);
    says(&["archive", "quick.yaml", "-o", "a.zip"], 1);
    desk.run(&["table", "quick.yaml", "ste.summary"], 0);
    says(&["table", "quick.yaml", "ste.summary", "--cache", "none"], 1);
    let (_, error) = desk.run(&["status", "--check", "quick.yaml", "--cache", "none"], 4);
    assert!(error.contains("pointers of Git LFS; `git lfs pull` fetches them"), "{error}");
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    desk.run(&["status", "--check", "quick.yaml"], 0);
}
