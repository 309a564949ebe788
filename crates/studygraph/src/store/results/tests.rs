//! Publishing: once, only what changed, after failures and kills, in clones.

mod bundles;

use std::cell::Cell;
use std::fs;

use super::*;
use crate::store::entry::StoredTable;
use crate::store::facts::Facts;
#[cfg(feature = "hdf5")]
use crate::store::hdf5;
use crate::store::index::{INDEX, Index};
use crate::store::manifest::{FORMAT, FileRecord, StageRecord};
use crate::store::parquet::tests::{assert_identical, everything};
use crate::table::schema::Schema;

fn tables() -> Vec<(&'static str, Table)> {
    let named = |name: &str, rows| {
        let table = everything(rows);
        let schema = Schema { name: name.to_owned(), ..table.schema().clone() };
        Table::from_columns(schema, table.columns().to_vec()).unwrap()
    };
    vec![("ste", named("curve", 30)), ("ste", named("summary", 3)), ("pair", named("geometry", 1))]
}

fn manifest(tables: &[(&str, Table)]) -> Manifest {
    let stage = |name: &str| StageRecord {
        name: name.to_owned(),
        kind: name.to_owned(),
        version: 1,
        keys: vec![],
        config: serde_json::Value::Null.into(),
        status: "ran".to_owned(),
        why: "never ran".to_owned(),
        seconds: 0.1,
        work: std::collections::BTreeMap::new(),
        warnings: vec![],
        left_out: vec![],
        tables: tables
            .iter()
            .filter(|(stage, _)| *stage == name)
            .map(|(stage, table)| TableRecord::new(stage, table.schema(), &StoredTable::describe(table).unwrap()))
            .collect(),
    };
    Manifest { format: FORMAT, study: "s".to_owned(), stages: vec![stage("pair"), stage("ste")], ..Manifest::default() }
}

fn publish(folder: &Folder, tables: &[(&str, Table)], manifest: &Manifest) -> (Published, usize) {
    let asked = Cell::new(0);
    let bytes = |stage: &str, name: &str| {
        asked.set(asked.get() + 1);
        parquet::write(&tables.iter().find(|(s, table)| *s == stage && table.name() == name).unwrap().1)
    };
    let facts = Facts::default;
    (folder.publish(manifest, facts, Source::of(&bytes)).unwrap(), asked.get())
}

fn files(folder: &Folder) -> Vec<String> {
    let entries = fs::read_dir(folder.path()).unwrap();
    let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn everything_is_written_once_and_reads_back() {
    let root = tempfile::tempdir().unwrap();
    let folder = Folder::new(root.path(), "s");
    let tables = tables();
    let (first, _) = publish(&folder, &tables, &manifest(&tables));
    assert_eq!(first.changes.tables.len(), 3);
    for record in first.manifest.stages.iter().flat_map(|stage| &stage.tables) {
        let (_, table) = tables.iter().find(|(stage, t)| format!("{stage}.{}", t.name()) == record.name).unwrap();
        assert_identical(table, &folder.table(record).unwrap());
        #[cfg(feature = "hdf5")]
        {
            let (stage, name) = split(&record.name);
            assert_identical(table, &hdf5::read(&folder.path().join("s.h5"), stage, name).unwrap());
        }
    }
    let stamp = |name: &str| fs::metadata(folder.path().join(name)).unwrap().modified().unwrap();
    // The index notes what was read: files of the same moment as itself.
    let kept = || files(&folder).into_iter().filter(|name| name != INDEX);
    let stamps: Vec<_> = kept().map(|name| stamp(&name)).collect();
    let again = Manifest { seconds: 9.0, ..manifest(&tables) };
    let panics = || panic!("nothing is written, so nobody asks for facts");
    let second = folder.publish(&again, panics, Source::of(&|_, _| panic!("nothing is read"))).unwrap();
    assert_eq!(second.changes, Changes::default());
    assert_eq!(stamps, kept().map(|name| stamp(&name)).collect::<Vec<_>>());
}

#[test]
fn only_what_changed_is_asked_for() {
    let root = tempfile::tempdir().unwrap();
    let folder = Folder::new(root.path(), "s");
    let mut tables = tables();
    publish(&folder, &tables, &manifest(&tables));
    fs::write(folder.path().join("notes.txt"), "mine").unwrap();
    tables[1].1 = Table::from_rows(tables[1].1.schema().clone(), vec![]).unwrap();
    let (published, asked) = publish(&folder, &tables, &manifest(&tables));
    assert_eq!((published.changes.tables, asked), (vec!["ste.summary.parquet".to_owned()], 1));
    // A file that was lost or cut comes back.
    fs::write(folder.path().join("ste.curve.parquet"), "x").unwrap();
    assert_eq!(folder.changes(&manifest(&tables), false).tables, ["ste.curve.parquet"]);
    assert_eq!(publish(&folder, &tables, &manifest(&tables)).1, 1);
    // A table that is no more takes its file along; what was never listed stays.
    tables.remove(0);
    let (published, asked) = publish(&folder, &tables, &manifest(&tables));
    assert_eq!((published.changes.remove, asked), (vec!["ste.curve.parquet".to_owned()], 0));
    assert!(!files(&folder).contains(&"ste.curve.parquet".to_owned()));
    assert!(files(&folder).contains(&"notes.txt".to_owned()));
}

#[test]
fn a_stage_that_failed_keeps_its_last_tables() {
    let root = tempfile::tempdir().unwrap();
    let folder = Folder::new(root.path(), "s");
    let tables = tables();
    let (first, _) = publish(&folder, &tables, &manifest(&tables));
    let mut failed = manifest(&tables);
    let stage = &mut failed.stages[1];
    (stage.status, stage.why) = ("failed".to_owned(), "no".to_owned());
    stage.tables.clear();
    let (second, asked) = publish(&folder, &tables, &failed);
    assert_eq!(asked, 0);
    assert_eq!(second.manifest.stages[1].status, "failed");
    assert_eq!(second.manifest.stages[1].tables, first.manifest.stages[1].tables);
    assert!(publish(&folder, &tables, &manifest(&tables)).0.changes.manifest);
    assert_eq!(folder.manifest().unwrap().stages[1].status, "ran");
}

/// A clone has the manifest and the small tables only: running there brings the others back and changes nothing else.
#[test]
fn missing_files_come_back_without_a_new_manifest() {
    let root = tempfile::tempdir().unwrap();
    let folder = Folder::new(root.path(), "s");
    let tables = tables();
    publish(&folder, &tables, &manifest(&tables));
    let before = fs::read(folder.path().join(MANIFEST)).unwrap();
    fs::remove_file(folder.path().join("ste.curve.parquet")).unwrap();
    if cfg!(feature = "hdf5") {
        fs::remove_file(folder.path().join(folder.hdf5_file())).unwrap();
    }
    let panics = || panic!("the facts of the first run stand");
    let bytes = |_: &str, name: &str| {
        let (_, table) = tables.iter().find(|(_, table)| table.name() == name).unwrap();
        parquet::write(table)
    };
    let again = folder.publish(manifest(&tables), panics, Source::of(&bytes)).unwrap();
    assert_eq!(again.changes.tables, ["ste.curve.parquet"]);
    assert_eq!(before, fs::read(folder.path().join(MANIFEST)).unwrap());
    assert_eq!(folder.changes(&manifest(&tables), false), Changes::default());
}

#[test]
fn after_a_kill_no_new_file_passes_for_the_old_one() {
    let root = tempfile::tempdir().unwrap();
    let folder = Folder::new(root.path(), "s");
    let old = tables();
    publish(&folder, &old, &manifest(&old));
    let mut new = tables();
    for (_, table) in &mut new[..2] {
        *table = Table::from_rows(table.schema().clone(), vec![]).unwrap();
    }
    // The first new file happens to be as long as the old one; the second never comes.
    let length = fs::metadata(folder.path().join("ste.curve.parquet")).unwrap().len();
    let bytes = |_: &str, name: &str| match name {
        "curve" => Ok(vec![b'x'; usize::try_from(length).unwrap()]),
        _ => Err(StoreError::InUse { path: "killed".to_owned(), who: String::new() }),
    };
    assert!(folder.publish(manifest(&new), || unreachable!(), Source::of(&bytes)).is_err());
    assert_eq!(folder.changes(&manifest(&old), false).tables, ["ste.curve.parquet", "ste.summary.parquet"]);
    publish(&folder, &old, &manifest(&old));
    for record in &folder.manifest().unwrap().stages[1].tables {
        folder.table(record).unwrap();
    }
}

#[test]
fn a_manifest_from_elsewhere_removes_nothing_outside() {
    let root = tempfile::tempdir().unwrap();
    let folder = Folder::new(root.path(), "s");
    let tables = tables();
    publish(&folder, &tables, &manifest(&tables));
    fs::write(root.path().join("precious"), "").unwrap();
    let mut wicked = folder.manifest().unwrap();
    let (bytes, digest) = (Some(0), Some(crate::store::index::digest(b"")));
    wicked.files.push(FileRecord { file: "../precious".into(), bytes, digest, varies: false });
    fs::write(folder.path().join(MANIFEST), serde_json::to_vec(&wicked).unwrap()).unwrap();
    publish(&folder, &tables, &Manifest { title: "new".into(), ..manifest(&tables) });
    assert!(root.path().join("precious").exists());
}

/// A table that holds two files, with these texts in the second.
fn drawing(texts: &[&str]) -> Table {
    let schema = Schema::of_files("files", "What was drawn.", vec!["a.csv".to_owned(), "b.dxf".to_owned()]);
    let mut rows: Vec<crate::table::data::Row> = vec![vec!["a.csv".into(), 1_usize.into(), "x,y".into()]];
    rows.extend(texts.iter().enumerate().map(|(at, text)| vec!["b.dxf".into(), (at + 1).into(), (*text).into()]));
    Table::from_rows(schema, rows).unwrap()
}

#[test]
fn files_that_a_table_holds_are_published_kept_whole_and_removed() {
    let root = tempfile::tempdir().unwrap();
    let folder = Folder::new(root.path(), "s");
    let with = |texts: &[&str]| vec![("ste", drawing(texts)), ("pair", everything(1))];
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    let (first, _) = publish(&folder, &with(&["0", "EOF"]), &manifest(&with(&["0", "EOF"])));
    assert_eq!(first.changes.files, ["ste.a.csv", "ste.b.dxf"]);
    assert_eq!((read("ste.a.csv").as_str(), read("ste.b.dxf").as_str()), ("x,y\n", "0\nEOF\n"));
    #[cfg(feature = "hdf5")]
    {
        let path = folder.path().join(folder.hdf5_file());
        assert!(hdf5::read(&path, "ste", "files").is_err() && hdf5::read(&path, "pair", "curve").is_ok());
    }
    let listed = |published: &Published, name: &str| {
        published.manifest.files.iter().find(|record| record.file == name).and_then(|record| record.bytes)
    };
    assert_eq!((listed(&first, "ste.a.csv"), listed(&first, "ste.b.dxf")), (Some(4), Some(6)));
    let nothing = |_: &str, _: &str| panic!("nothing is read");
    assert_eq!(folder.changes(&manifest(&with(&["0", "EOF"])), false), Changes::default());
    let facts = Facts::default;
    assert_eq!(
        folder.publish(manifest(&with(&["0", "EOF"])), facts, Source::of(&nothing)).unwrap().changes,
        Changes::default()
    );

    // A file that was cut short comes back from its table.
    fs::write(folder.path().join("ste.b.dxf"), "0").unwrap();
    let again = folder.publish(manifest(&with(&["0", "EOF"])), facts, Source::of(&nothing)).unwrap();
    assert_eq!((again.changes.files.len(), read("ste.b.dxf").as_str()), (1, "0\nEOF\n"));

    let (second, _) = publish(&folder, &with(&["0", "EOF", "9"]), &manifest(&with(&["0", "EOF", "9"])));
    assert_eq!((second.changes.tables.len(), listed(&second, "ste.b.dxf")), (1, Some(8)));
    let (last, _) = publish(&folder, &[("pair", everything(1))], &manifest(&[("pair", everything(1))]));
    assert_eq!(last.changes.remove, ["ste.files.parquet", "ste.a.csv", "ste.b.dxf"]);
    assert!(!files(&folder).iter().any(|name| name.starts_with("ste.")), "{:?}", files(&folder));
}

/// A page and a figure that say how many rows there are, and a figure that differs from run to run.
fn draw(manifest: &Manifest, tables: Tables<'_>) -> Result<Vec<Drawn>, String> {
    let rows = tables("ste.curve").ok_or("no curve")?.rows();
    let drawn = |file: &str, varies| Drawn { file: file.to_owned(), bytes: format!("{rows}").into_bytes(), varies };
    assert!(manifest.files.is_empty(), "they are listed when all is drawn");
    Ok(vec![drawn("figures/a.svg", false), drawn("figures/measured/b.svg", true), drawn(PAGE, true)])
}

fn publish_drawn(folder: &Folder, tables: &[(&str, Table)]) -> Published {
    let bytes = |stage: &str, name: &str| {
        parquet::write(&tables.iter().find(|(s, table)| *s == stage && table.name() == name).unwrap().1)
    };
    folder.publish(manifest(tables), Facts::default, Source { draw: Some(&draw), ..Source::of(&bytes) }).unwrap()
}

/// All files of a folder but the manifest and the index.
fn listed(folder: &Folder) -> Vec<String> {
    folder.manifest().unwrap().files.into_iter().map(|record| record.file).collect()
}

#[test]
fn every_published_file_is_listed_and_a_changed_byte_is_noticed_and_mended() {
    let root = tempfile::tempdir().unwrap();
    let folder = Folder::new(root.path(), "s");
    let tables = tables();
    let first = publish_drawn(&folder, &tables);
    assert!(first.changes.drawn && first.undrawn.is_none());
    assert!(
        ["figures/a.svg", "figures/measured/b.svg", PAGE].iter().all(|file| listed(&folder).contains(&(*file).into()))
    );
    assert_eq!(listed(&folder).len(), if cfg!(feature = "hdf5") { 7 } else { 6 });
    assert_eq!(publish_drawn(&folder, &tables).changes, Changes::default());
    let text = fs::read(folder.path().join(MANIFEST)).unwrap();
    for file in listed(&folder) {
        let path = folder.path().join(&file);
        let before = fs::read(&path).unwrap();
        let mut changed = before.clone();
        *changed.last_mut().unwrap() ^= 1;
        fs::write(&path, &changed).unwrap();
        assert_eq!(folder.known().unwrap().unwrap().changed(), [file.as_str()]);
        let mended = publish_drawn(&folder, &tables);
        assert_eq!(mended.changes.foreign, [file.as_str()]);
        assert!(before == fs::read(&path).unwrap(), "{file}");
        assert!(text == fs::read(folder.path().join(MANIFEST)).unwrap(), "{file}");
        assert_eq!(publish_drawn(&folder, &tables).changes, Changes::default(), "{file}");
    }
}

/// What differs from run to run is in the index alone: two folders have one manifest.
#[test]
fn the_manifest_of_the_same_results_is_the_same_whatever_was_measured() {
    let root = tempfile::tempdir().unwrap();
    let texts: Vec<Vec<u8>> = [1.0, 2.0]
        .into_iter()
        .map(|seconds| {
            let folder = Folder::new(&root.path().join(seconds.to_string()), "s");
            let mut tables = tables();
            for (_, table) in &mut tables {
                let mut columns = table.columns().to_vec();
                *columns.last_mut().unwrap() = Data::Float(vec![seconds; table.rows()]);
                *table = Table::from_columns(table.schema().clone(), columns).unwrap();
            }
            publish_drawn(&folder, &tables);
            fs::read(folder.path().join(MANIFEST)).unwrap()
        })
        .collect();
    assert_eq!(String::from_utf8_lossy(&texts[0]), String::from_utf8_lossy(&texts[1]));
}

/// Times that tell nothing are not trusted: the same size, times and inode, other bytes.
#[test]
fn stamps_are_trusted_only_where_they_tell() {
    let root = tempfile::tempdir().unwrap();
    let folder = Folder::new(root.path(), "s");
    publish_drawn(&folder, &tables());
    let wait = || std::thread::sleep(std::time::Duration::from_millis(20));
    let path = folder.path().join(PAGE);
    let edit = |change: &dyn Fn(&mut Index)| {
        let (mut index, _) = Index::read(folder.path()).unwrap();
        change(&mut index);
        wait();
        index.write(folder.path()).unwrap();
    };
    // As if the stamp of a changed page had been noted: nobody would look.
    wait();
    fs::write(&path, "31").unwrap();
    let now = crate::store::index::look(&path, PAGE).unwrap();
    let note = |index: &mut Index| index.files.iter_mut().find(|seen| seen.file == PAGE).unwrap().stamp = now.stamp;
    edit(&note);
    let state = || folder.known().unwrap().unwrap().state(PAGE);
    assert_eq!(state(), FileState::Intact, "its stamp is trusted");
    assert_eq!(folder.known().unwrap().unwrap().without_stamps().state(PAGE), FileState::Changed);
    // Written in the same moment as the index: its times would not have told.
    let handle = fs::File::options().write(true).open(folder.path().join(INDEX)).unwrap();
    handle.set_modified(std::time::UNIX_EPOCH).unwrap();
    assert_eq!(state(), FileState::Changed);
    handle.set_modified(std::time::SystemTime::now()).unwrap();
    assert_eq!(state(), FileState::Intact);
    // Another start of the machine.
    edit(&|index| index.boot = "another".to_owned());
    assert_eq!(state(), FileState::Changed);
}

/// Losing the index costs reading: tables are judged by their values, the rest is made again.
#[test]
fn without_an_index_nothing_is_lost() {
    let root = tempfile::tempdir().unwrap();
    let folder = Folder::new(root.path(), "s");
    let tables = tables();
    publish_drawn(&folder, &tables);
    let text = fs::read(folder.path().join(MANIFEST)).unwrap();
    fs::remove_file(folder.path().join(INDEX)).unwrap();
    let again = publish_drawn(&folder, &tables).changes;
    assert!(again.tables.is_empty() && again.foreign.is_empty() && again.drawn, "{again:?}");
    assert!(text == fs::read(folder.path().join(MANIFEST)).unwrap());
    assert_eq!(publish_drawn(&folder, &tables).changes, Changes::default());
}

#[test]
fn a_page_that_cannot_be_drawn_keeps_no_table_back() {
    let root = tempfile::tempdir().unwrap();
    let folder = Folder::new(root.path(), "s");
    let tables = tables();
    let bytes = |_: &str, name: &str| parquet::write(&tables.iter().find(|(_, table)| table.name() == name).unwrap().1);
    let fails: Draw<'_> = &|_, _| Err("no ink".to_owned());
    let published =
        folder.publish(manifest(&tables), Facts::default, Source { draw: Some(fails), ..Source::of(&bytes) }).unwrap();
    assert_eq!(published.undrawn.as_deref(), Some("no ink"));
    assert!(listed(&folder).contains(&"ste.curve.parquet".to_owned()) && !listed(&folder).contains(&PAGE.to_owned()));
    fs::create_dir_all(folder.path().join(FIGURES)).unwrap();
    fs::write(folder.path().join("figures/old.svg"), "").unwrap();
    let redrawn = folder.redraw(&draw, "", &|_| None).unwrap().unwrap();
    assert!(redrawn.undrawn.is_none() && listed(&folder).contains(&PAGE.to_owned()));
    assert!(!folder.path().join("figures/old.svg").exists(), "a figure that nobody drew");
    assert_eq!(publish_drawn(&folder, &tables).changes, Changes::default());
}

/// Whoever stops while files are written gets what a kill would leave, and never a file that is half new.
#[test]
fn publishing_stops_before_any_file_and_the_next_run_ends_it() {
    for stop_before in 0.. {
        let root = tempfile::tempdir().unwrap();
        let folder = Folder::new(root.path(), "s");
        let tables = tables();
        let bytes =
            |_: &str, name: &str| parquet::write(&tables.iter().find(|(_, table)| table.name() == name).unwrap().1);
        let asked = Cell::new(0);
        let next = |file: &str| {
            asked.set(asked.get() + 1);
            if asked.get() > stop_before { Err(StoreError::Stopped { path: file.to_owned() }) } else { Ok(()) }
        };
        let source = Source { draw: Some(&draw), next: &next, ..Source::of(&bytes) };
        let Err(fault) = folder.publish(manifest(&tables), Facts::default, source) else {
            // Three tables, HDF5 where there is any, and the page before and after it is drawn.
            assert_eq!(stop_before, if cfg!(feature = "hdf5") { 6 } else { 5 });
            return;
        };
        assert!(matches!(fault, StoreError::Stopped { .. }), "{fault}");
        assert!(folder.manifest().is_none());
        publish_drawn(&folder, &tables);
        assert_eq!(publish_drawn(&folder, &tables).changes, Changes::default());
    }
}
