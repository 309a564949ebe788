//! The committed results are those of the committed studies and of this program; nothing is run to find out.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::support::with_code;
use gearstudy::program;
use studygraph::runner::standing::standing;
use studygraph::store::results::Folder;

/// Studies with a manifest under version control, and their files there; without git, all that lies there but `quick`.
fn committed(top: &Path) -> BTreeMap<String, Vec<PathBuf>> {
    let output = Command::new("git").arg("-C").arg(top).args(["ls-files", "-z", "results"]).output();
    let listed = output.ok().filter(|output| output.status.success()).map(|output| output.stdout).unwrap_or_default();
    let listed = String::from_utf8(listed).unwrap();
    let mut files: Vec<PathBuf> = listed.split_terminator('\0').map(PathBuf::from).collect();
    if files.is_empty() {
        let all = files_in(&top.join("results"));
        files = all.iter().map(|path| path.strip_prefix(top).unwrap().to_owned()).collect();
        files.retain(|path| !path.starts_with("results/quick"));
    }
    let mut studies = BTreeMap::<String, Vec<PathBuf>>::new();
    for file in files {
        let name = file.iter().nth(1).unwrap().to_string_lossy().into_owned();
        studies.entry(name).or_default().push(file);
    }
    studies.retain(|name, files| files.contains(&Path::new("results").join(name).join("manifest.json")));
    studies
}

fn files_in(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.flat_map(|path| if path.is_dir() { files_in(&path) } else { vec![path] }).collect()
}

/// Judged from the committed files alone, as in a fresh clone: what else a run left in the folder must not help.
#[test]
fn committed_results_are_not_stale() {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    let clone = tempfile::tempdir().unwrap();
    let studies = committed(top);
    assert!(studies.contains_key("energy_ga"), "{studies:?}");
    let mut problems = Vec::new();
    for (name, files) in studies {
        let tables = files.iter().filter(|file| file.extension().is_some_and(|it| it == "parquet")).count();
        for file in files {
            std::fs::create_dir_all(clone.path().join(&file).parent().unwrap()).unwrap();
            std::fs::copy(top.join(&file), clone.path().join(&file)).unwrap();
        }
        let study = program::load(&top.join("studies").join(format!("{name}.yaml"))).unwrap();
        let folder = Folder::new(&clone.path().join("results"), &study.name);
        // Only the small tables are committed; what the manifest says of the others is what they are.
        let found = standing(&study, &folder).unwrap();
        problems.extend(found.problem().map(|problem| format!("results/{name}: {problem}")));
        let manifest = folder.manifest().unwrap();
        let there = manifest.stages.iter().flat_map(|stage| &stage.tables);
        let mut read = 0;
        for record in there.filter(|record| folder.path().join(&record.file).is_file()) {
            read += 1;
            problems.extend(folder.table(record).err().map(|error| error.to_string()));
        }
        // Each of them belongs to the manifest and was read; a study has some.
        assert!(read == tables && read >= 1, "{name}: {read} of {tables} committed tables are in the manifest");
    }
    assert!(
        problems.is_empty(),
        "the committed results are not those of this program and these studies:\n  {}\nTo refresh them: `make \
         results`, look at what changed, and commit `results/`.",
        problems.join("\n  ")
    );
}

/// The test above can fail: a study with one number changed, and a program with another code.
#[test]
fn stale_results_are_found() {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    let path = top.join("studies/energy_ga.yaml");
    let text = std::fs::read_to_string(&path).unwrap();
    let folder = Folder::new(&top.join("results"), "energy_ga");
    let other = text.replacen("face_width: 20 mm", "face_width: 20.5 mm", 1);
    assert_ne!(text, other);
    let study = program::load_text(&other, &path).unwrap();
    let found = standing(&study, &folder).unwrap().problem().unwrap();
    assert!(found.contains("stage `pair` is not up to date: stale: ") && found.contains("pinion"), "{found}");
    let study = with_code(program::load_text(&text, &path).unwrap(), |_| "other".to_owned());
    let found = standing(&study, &folder).unwrap().problem().unwrap();
    assert!(found.contains("stage `pair` is not up to date: stale: code changed"), "{found}");
}

/// What git keeps of the results follows from study and program: nothing in it was measured.
#[test]
fn nothing_committed_varies_from_run_to_run() {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    for (name, files) in committed(top) {
        let folder = Folder::new(&top.join("results"), &name);
        let manifest = folder.manifest().unwrap();
        let tables: Vec<_> = manifest.stages.iter().flat_map(|stage| &stage.tables).collect();
        for file in files {
            let inside =
                file.strip_prefix(Path::new("results").join(&name)).unwrap().to_string_lossy().replace('\\', "/");
            let listed = manifest.files.iter().find(|record| record.file == inside);
            let is_digested = listed.is_some_and(|record| record.digest.is_some());
            let measured = tables.iter().any(|table| table.file == inside && table.varies());
            if inside != "manifest.json" && (!is_digested || measured) {
                found.push(file.display().to_string());
            }
        }
    }
    assert!(found.is_empty(), "without a digest in their manifest, or measured: {found:#?}");
}
