//! The committed results are those of the committed studies and of this program; nothing is run to find out.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use gearstudy::runner::standing::standing;
use gearstudy::stage::code_digest;
use gearstudy::store::results::Folder;
use gearstudy::study;

/// Studies whose manifest is under version control; without git, every one that has a manifest but `quick`.
fn committed(top: &Path) -> BTreeSet<String> {
    let output = Command::new("git").arg("-C").arg(top).args(["ls-files", "results"]).output();
    let listed = output.ok().filter(|output| output.status.success());
    let listed = listed.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
    let name = |line: &str| Some(line.strip_prefix("results/")?.strip_suffix("/manifest.json")?.to_owned());
    let tracked: BTreeSet<String> = listed.lines().filter_map(name).collect();
    if !tracked.is_empty() {
        return tracked;
    }
    let folders = std::fs::read_dir(top.join("results")).unwrap().map(|entry| entry.unwrap());
    let with_manifest = folders.filter(|entry| entry.path().join("manifest.json").is_file());
    with_manifest.map(|entry| entry.file_name().to_string_lossy().into_owned()).filter(|name| name != "quick").collect()
}

#[test]
fn committed_results_are_not_stale() {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    let names = committed(top);
    assert!(names.contains("energy_ga"), "{names:?}");
    let mut problems = Vec::new();
    for name in names {
        let study = study::load(&top.join("studies").join(format!("{name}.yaml"))).unwrap();
        let folder = Folder::new(&top.join("results"), &study.name);
        // Only the small tables are committed; what the manifest says of the others is what they are.
        let found = standing(&study, &folder, code_digest, true).unwrap();
        problems.extend(found.problem().map(|problem| format!("results/{name}: {problem}")));
        let manifest = folder.manifest().unwrap();
        let there = manifest.stages.iter().flat_map(|stage| &stage.tables);
        let mut read = 0;
        for record in there.filter(|record| folder.path().join(&record.file).is_file()) {
            read += 1;
            problems.extend(folder.table(record).err().map(|error| error.to_string()));
        }
        assert!(read >= 3, "{name}: the small tables are committed");
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
    let study = study::load_text(&other, &path).unwrap();
    let found = standing(&study, &folder, code_digest, true).unwrap().problem().unwrap();
    assert!(found.contains("stage `pair` is not up to date: stale: ") && found.contains("pinion"), "{found}");
    let study = study::load_text(&text, &path).unwrap();
    let found = standing(&study, &folder, |_| "other".to_owned(), true).unwrap().problem().unwrap();
    assert!(found.contains("stage `pair` is not up to date: stale: code changed"), "{found}");
}
