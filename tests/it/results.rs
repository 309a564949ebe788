//! The committed results are those of the committed studies and of this program. Where only the code has changed since,
//! the studies are run, and the values must be the same: a kernel can be written anew without new results.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::support::with_code;
use gearstudy::program;
use studygraph::diff::model::Difference as Compared;
use studygraph::diff::table::compare;
use studygraph::runner::events::Silent;
use studygraph::runner::execute::{execute, run};
use studygraph::runner::options::Options;
use studygraph::runner::standing::{self, Condition, Standing, standing};
use studygraph::store::cache::Cache;
use studygraph::store::entry::StoredTable;
use studygraph::store::manifest::{Manifest, TableRecord};
use studygraph::store::results::Folder;
use studygraph::study::Study;
use studygraph::table::schema::Schema;

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

/// Whether all that is not as it should be is that the code has changed.
fn only_code_changed(standing: &Standing) -> bool {
    let by_code = |state: &Condition| match state {
        Condition::UpToDate | Condition::Waits(_) => true,
        Condition::Stale(why) => why == "code changed",
        Condition::Missing(_) | Condition::Damaged(_) | Condition::LineEnds(_) | Condition::OtherRun(_) => false,
    };
    let rest =
        standing.has_results && !standing.text_changed && standing.gone.is_empty() && standing.foreign.is_empty();
    rest && !standing.is_up_to_date() && standing.stages.iter().all(|stage| by_code(&stage.state))
}

/// The tables that come out other than they were, or not at all. Last digits may differ between processors: a table that is
/// there is compared by its tolerances, and where some of a stage are there they speak for the others.
fn changed(study: &Study, folder: &Folder, manifest: &Manifest) -> Vec<String> {
    let place = tempfile::tempdir().unwrap();
    let cache = Cache::open(&place.path().join("cache")).unwrap();
    let options = Options { wanted: standing::demand(study, manifest), ..Options::default() };
    let outcome = execute(study, &cache, &options, &Silent, &AtomicBool::new(false)).unwrap();
    let mut found: Vec<String> =
        outcome.faults().map(|(stage, fault)| format!("stage `{stage}` fails: {fault}")).collect();
    for stage in &manifest.stages {
        let is_there = |record: &&TableRecord| folder.path().join(&record.file).is_file();
        let any = stage.tables.iter().any(|record| is_there(&record));
        for record in &stage.tables {
            let name = record.name.split_once('.').map_or("", |(_, name)| name);
            let content =
                |(schema, table): &(Arc<Schema>, StoredTable)| (schema.name == name).then(|| table.content.to_string());
            let now = outcome.stage(&stage.name).and_then(|stage| stage.tables.iter().find_map(content));
            let same = now.as_ref() == Some(&record.content);
            let close = || {
                let (before, after) = (folder.table(record), outcome.table(&cache, &stage.name, name));
                let diff =
                    before.ok().zip(after.ok()).map(|(before, after)| compare("", &before, &after, None, &|_| None));
                diff.is_some_and(|diff| matches!(diff.state, Compared::Same | Compared::WithinTolerance))
            };
            if !(same || now.is_some() && if is_there(&record) { close() } else { any }) {
                found.push(format!("table `{}` has other values than before", record.name));
            }
        }
    }
    found
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
        let manifest = folder.manifest().unwrap();
        let found = if only_code_changed(&found) {
            println!("results/{name}: the code has changed since; the study is run to see whether its values have");
            changed(&study, &folder, &manifest)
        } else {
            found.problem().into_iter().collect()
        };
        problems.extend(found.into_iter().map(|problem| format!("results/{name}: {problem}")));
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

/// The test above can fail: a study with one number changed, a program with another code, and one with other values.
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
    // Judged by its values, the study is the same; one number changed is one table, and all that read it.
    let quick = top.join("studies/quick.yaml");
    let study = program::load(&quick).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let folder = Folder::new(folder.path(), "quick");
    let cache = tempfile::tempdir().unwrap();
    let (cache, stop) = (Cache::open(cache.path()).unwrap(), AtomicBool::new(false));
    let (_, published) = run(&study, &cache, &Options::default(), &Silent, &stop, &folder, None).unwrap();
    let other = with_code(program::load(&quick).unwrap(), |_| "other".to_owned());
    assert!(
        only_code_changed(&standing(&other, &folder).unwrap())
            && !only_code_changed(&standing(&study, &folder).unwrap())
    );
    assert_eq!(changed(&other, &folder, &published.manifest), Vec::<String>::new());
    let text = std::fs::read_to_string(&quick).unwrap().replacen("face_width: 20 mm", "face_width: 20.5 mm", 1);
    let found = changed(&program::load_text(&text, &quick).unwrap(), &folder, &published.manifest);
    assert!(found.contains(&"table `pair.gears` has other values than before".to_owned()), "{found:?}");
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
