//! Archives as a user makes and verifies them: what they say, what they refuse, and that verifying finds a difference.

mod hostile;
mod python;

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::desk::Desk;
use studygraph::store::archive::open::open;
use studygraph::store::archive::pack::{Entries, pack};
use studygraph::store::archive::{METADATA, sha256};
use studygraph::store::index::digest;
use studygraph::store::manifest::Manifest;
use studygraph::store::parquet;
use studygraph::table::data::{Data, Table};

/// Everything in an archive.
pub fn entries(path: &Path) -> Entries {
    let mut archive = open(path).unwrap();
    let names: Vec<String> = archive.names().map(str::to_owned).collect();
    names.into_iter().map(|name| (name.clone(), archive.bytes(&name).unwrap())).collect()
}

pub fn archived(study: &str, words: &[&str]) -> Desk {
    let desk = Desk::with(study);
    let run: Vec<&str> = ["run", study, "--quiet"].iter().chain(words).copied().collect();
    desk.run(&run, 0);
    desk.run(&["archive", study, "-o", "a.zip"], 0);
    desk
}

fn manifest(entries: &Entries) -> Manifest {
    serde_json::from_slice(&entries["results/quick/manifest.json"]).unwrap()
}

fn put_manifest(entries: &mut Entries, manifest: &Manifest) {
    entries.insert("results/quick/manifest.json".to_owned(), serde_json::to_vec(manifest).unwrap());
}

/// Packs an archive that is described as it is: files that are described have the digest of what is in them now.
pub fn packed(mut entries: Entries) -> Vec<u8> {
    if let Ok(mut value) = serde_json::from_slice::<Value>(&entries[METADATA]) {
        for entity in value["@graph"].as_array_mut().into_iter().flatten().filter(|it| it["sha256"].is_string()) {
            if let Some(bytes) = entity["@id"].as_str().and_then(|name| entries.get(name)) {
                entity["sha256"] = sha256(bytes).into();
            }
        }
        entries.insert(METADATA.to_owned(), serde_json::to_vec(&value).unwrap());
    }
    pack(&entries).unwrap()
}

/// The same table with one number of a column moved by a share of itself.
fn moved(table: &Table, column: &str, row: usize, by: f64) -> Table {
    let position = table.schema().position(column).unwrap();
    let mut columns = table.columns().to_vec();
    let Data::Float(values) = &mut columns[position] else { panic!("{column} holds no numbers") };
    values[row] *= 1.0 + by;
    Table::from_columns(table.schema().clone(), columns).unwrap()
}

/// An archive is written over an archive, and over nothing that would be lost.
#[test]
fn an_archive_takes_the_place_of_no_other_file() {
    let desk = archived("quick.yaml", &[]);
    fs::write(desk.path("notes.txt"), "kept").unwrap();
    fs::write(desk.path("empty"), "").unwrap();
    for name in ["quick.yaml", "notes.txt", "results/quick/manifest.json", "results/new.zip"] {
        let before = fs::read(desk.path(name)).ok();
        let (_, message) = desk.run(&["archive", "quick.yaml", "-o", name], 1);
        assert!(message.contains(name) && message.contains("name another file"), "{message}");
        assert!(fs::read(desk.path(name)).ok() == before, "{name} was touched");
    }
    desk.run(&["archive", "quick.yaml", "-o", "empty"], 0);
}

/// SPDX 3.0, annex B: a licence that is not in the list is `LicenseRef-` and a name of its own.
#[test]
fn a_licence_that_is_not_in_the_list_is_described_as_such() {
    let desk = archived("quick.yaml", &[]);
    for (given, id) in [
        ("LicenseRef-own.1", "#LicenseRef-own.1"),
        ("DocumentRef-a:LicenseRef-b", "#DocumentRef-a:LicenseRef-b"),
        ("MIT OR LicenseRef-own", "#license"),
    ] {
        desk.run(&["archive", "quick.yaml", "-o", "own.zip", "--license", given], 0);
        let value: Value = serde_json::from_slice(&entries(&desk.path("own.zip"))[METADATA]).unwrap();
        let graph = value["@graph"].as_array().unwrap();
        let entity =
            |id: &str| graph.iter().find(|entity| entity["@id"] == id).unwrap_or_else(|| panic!("{id}: {value:#}"));
        assert_eq!(entity("./")["license"]["@id"], id);
        assert_eq!((&entity(id)["@type"], &entity(id)["name"]), (&"CreativeWork".into(), &given.into()));
        assert!(
            !value.to_string().contains("licenses/LicenseRef") && !value.to_string().contains("licenses/DocumentRef")
        );
        let own = given.rsplit(' ').next().unwrap();
        assert!(entity(&format!("#{own}"))["description"].as_str().unwrap().contains("not in the SPDX list"));
        fs::remove_file(desk.path("own.zip")).unwrap();
    }
    for wrong in ["LicenseRef-", "LicenseRef-a_b", "LicenseRef-a WITH", "DocumentRef-a:MIT"] {
        let (_, error) = desk.run(&["archive", "quick.yaml", "-o", "own.zip", "--license", wrong], 1);
        assert!(error.contains("SPDX"), "{wrong}: {error}");
    }
}

/// One of them is to be named.
#[test]
fn a_folder_with_several_crates_says_which_there_are() {
    let desk = archived("quick.yaml", &[]);
    for name in ["two/first", "two/deep/second"] {
        for (file, bytes) in entries(&desk.path("a.zip")) {
            let path = desk.path(name).join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, bytes).unwrap();
        }
    }
    let (_, error) = desk.run(&["verify", "two"], 1);
    assert!(error.contains("it has 2 crates, in `deep/second/` and `first/`: name one of them"), "{error}");
    desk.run(&["verify", "two/first", "--quiet"], 0);
    let inside: Entries =
        entries(&desk.path("a.zip")).into_iter().map(|(name, bytes)| (format!("in/{name}"), bytes)).collect();
    let both = entries(&desk.path("a.zip")).into_iter().chain(inside).collect();
    fs::write(desk.path("both.zip"), pack(&both).unwrap()).unwrap();
    // The one at the top is meant; what else there is was added to it.
    assert!(desk.run(&["verify", "both.zip"], 1).1.contains("was added"));
}

#[test]
fn an_archive_is_the_same_bytes_again_and_verifies_as_identical() {
    let desk = archived("quick.yaml", &["--want", "stiffness.iso6336,ste.summary.largest_pressure"]);
    let first = fs::read(desk.path("a.zip")).unwrap();
    desk.run(&["archive", "quick.yaml", "-o", "a.zip"], 0);
    assert!(first == fs::read(desk.path("a.zip")).unwrap(), "the same results, other bytes");

    // Somewhere else, with nothing but the file; afterwards nothing else is there.
    let (empty, temporary) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let file = desk.path("a.zip");
    let mut command = desk.command(&["verify", &file.display().to_string(), "--json", "--jobs", "3"]);
    let output = command.current_dir(empty.path()).env("TMPDIR", temporary.path()).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    for folder in [&empty, &temporary] {
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }
    let said: Value = serde_json::from_slice(&output.stdout).unwrap();
    let names = |list: &Value| -> Vec<String> {
        list.as_array().unwrap().iter().map(|table| table["name"].as_str().unwrap().to_owned()).collect()
    };
    let listed: Vec<String> = desk.contents("quick").into_iter().map(|(name, _)| name).collect();
    assert_eq!(names(&said["tables"]), listed);
    assert!(listed.contains(&"stiffness.iso6336".to_owned()), "what was asked for on demand is archived too");
    assert_eq!((said["identical"].as_u64(), said["different"].as_u64()), (Some(listed.len() as u64), Some(0)));
    assert_eq!(said["notes"], serde_json::json!([]));

    // Unpacked, it is a folder in which the program finds its way.
    for (name, bytes) in entries(&file) {
        let path = empty.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
    let output = desk.command(&["status", "quick.yaml"]).current_dir(empty.path()).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(said, "quick: up to date; the cache does not have 6 of 6 stages, so a run computes them again\n");
}

#[test]
fn verify_says_what_came_out_other_than_archived() {
    let desk = archived("quick.yaml", &[]);
    let mut entries = entries(&desk.path("a.zip"));
    let mut manifest = manifest(&entries);
    manifest.program.version = "0.0.9".to_owned();
    manifest.program.dependencies = "other".to_owned();
    // Two archived tables are made to differ, consistently: by less and by more than the tolerance of 1e-9.
    for (name, column, by) in [("ste.summary", "mean", 1e-12), ("stiffness.summary", "single_max", 1e-3)] {
        let record = manifest.stages.iter_mut().flat_map(|stage| &mut stage.tables).find(|table| table.name == name);
        let record = record.unwrap();
        let file = format!("results/quick/{}", record.file);
        let table = parquet::read(entries[&file].clone()).unwrap();
        let row = table.rows() - 1;
        let table = moved(&table, column, row, by);
        record.content = table.content_hash().to_string();
        let (bytes, name) = (parquet::write(&table).unwrap(), record.file.clone());
        let listed = manifest.files.iter_mut().find(|listed| listed.file == name).unwrap();
        listed.digest = listed.digest.as_ref().map(|_| digest(&bytes));
        entries.insert(file, bytes);
    }
    put_manifest(&mut entries, &manifest);
    fs::write(desk.path("b.zip"), packed(entries)).unwrap();
    let (out, error) = desk.run(&["verify", "b.zip"], 4);
    assert!(error.contains("quick: 1 of "), "{error}");
    assert!(out.contains("made with another version of gearstudy: 0.0.9"), "{out}");
    assert!(out.contains("made with other versions of libraries"), "{out}");
    let line = |name: &str| out.lines().find(|line| line.trim_start().starts_with(name)).unwrap().to_owned();
    let within = line("ste.summary");
    assert!(within.contains("within tolerance") && within.contains("worst in mean at design="), "{within}");
    let different = line("stiffness.summary");
    assert!(different.contains("different") && different.contains("worst in single_max at row=1"), "{different}");
    assert!(different.contains("by 9.99e-4 of it"), "{different}");
    let (json, _) = desk.run(&["verify", "b.zip", "--json"], 4);
    let said: Value = serde_json::from_str(&json).unwrap();
    assert_eq!((said["within_tolerance"].as_u64(), said["different"].as_u64()), (Some(1), Some(1)));
    let summary = said["tables"].as_array().unwrap().iter().find(|table| table["name"] == "ste.summary").unwrap();
    assert_eq!(summary["worst"]["column"], "mean");
    assert!(summary["worst"]["key"].as_object().is_some_and(|key| key.contains_key("design")), "{summary}");
    assert!(summary["worst"]["over_tolerance"].as_f64().is_some_and(|over| over > 0.0 && over <= 1.0), "{summary}");
}

/// Whatever the file: found before anything runs.
#[test]
fn a_file_that_is_not_as_archived_is_found_before_the_run() {
    let desk = archived("quick.yaml", &[]);
    let whole = entries(&desk.path("a.zip"));
    let said = |entries: &Entries| {
        fs::write(desk.path("b.zip"), pack(entries).unwrap()).unwrap();
        let (out, error) = desk.run(&["verify", "b.zip"], 1);
        // Not even the first line of the run.
        assert_eq!(out, "");
        error
    };
    for name in whole.keys().filter(|name| *name != METADATA) {
        let mut entries = whole.clone();
        let bytes = entries.get_mut(name).unwrap();
        let middle = bytes.len() / 2;
        bytes[middle] ^= 1;
        assert!(said(&entries).contains(&format!("`{name}` has other contents")), "{name}: {}", said(&entries));
    }
    let mut entries = whole.clone();
    entries.insert("results/quick/more.parquet".to_owned(), b"x".to_vec());
    assert!(said(&entries).contains("`results/quick/more.parquet` was added"));
    entries = whole.clone();
    entries.remove("results/quick/report.html");
    assert!(said(&entries).contains("`results/quick/report.html`, which is not in it"), "{}", said(&entries));
}

#[test]
fn what_is_missing_stale_or_incomplete_is_not_archived() {
    let desk = Desk::with("quick.yaml");
    let refused = |wanted: &str, command: &str| {
        let (_, error) = desk.run(&["archive", "quick.yaml", "-o", "a.zip"], 1);
        assert!(error.contains(wanted) && error.contains(&format!("first: gearstudy {command} quick.yaml")), "{error}");
        assert!(!desk.path("a.zip").exists());
    };
    refused("there are no results", "run");
    desk.run(&["run", "quick.yaml", "--only", "stiffness", "--quiet"], 0);
    refused("stage `designs` is not up to date: missing: skipped: not asked for", "run");
    desk.run(&["run", "quick.yaml", "--quiet"], 0);
    let text = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    fs::write(desk.path("quick.yaml"), text.replace("to: 250 N m, count: 5", "to: 260 N m, count: 22")).unwrap();
    refused("stage `ste` is not up to date: stale: config changed: new values of torque", "run");
    fs::write(desk.path("quick.yaml"), format!("{text}# a remark\n")).unwrap();
    refused("the study's file has changed since", "run");
    fs::write(desk.path("quick.yaml"), &text).unwrap();
    fs::remove_file(desk.path("results/quick/ste.curve.parquet")).unwrap();
    refused("`ste.curve.parquet` is not here", "run");
    fs::write(desk.path("results/quick/ste.curve.parquet"), "short").unwrap();
    refused("stage `ste` is not up to date: damaged: `ste.curve.parquet` is not as the manifest lists it", "run");
    desk.run(&["run", "quick.yaml", "--quiet"], 0);
    fs::remove_file(desk.path("results/quick/report.html")).unwrap();
    refused("the report is not that of the last run", "report");
    desk.run(&["report", "quick.yaml"], 0);
    desk.run(&["archive", "quick.yaml", "-o", "a.zip", "--license", "CC BY"], 1);
    desk.run(&["archive", "quick.yaml", "-o", "no/such/folder/a.zip"], 1);
    desk.run(&["archive", "quick.yaml", "-o", "a.zip"], 0);
}
