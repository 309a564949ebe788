//! Tables of many stages of one kind are one file, and every stage's own table is had from it.

use super::*;
use crate::store::bundle::MANY;

const STAGES: usize = MANY + 8;

fn many(stages: usize) -> Vec<(String, Table)> {
    (0..stages).map(|index| (format!("m{index}"), everything(index % 4))).collect()
}

fn manifest_of(tables: &[(String, Table)]) -> Manifest {
    let stage = |(name, table): &(String, Table)| StageRecord {
        name: name.clone(),
        kind: "modification".to_owned(),
        status: "ran".to_owned(),
        tables: vec![TableRecord::new(name, table.schema(), &StoredTable::describe(table).unwrap())],
        ..manifest(&[]).stages.remove(0)
    };
    Manifest { stages: tables.iter().map(stage).collect(), ..manifest(&[]) }
}

/// Publishes, and says which tables were asked for.
fn publish_all(folder: &Folder, tables: &[(String, Table)], manifest: &Manifest) -> (Published, Vec<String>) {
    let asked = std::cell::RefCell::new(Vec::new());
    let table = |stage: &str, _: &str| {
        asked.borrow_mut().push(stage.to_owned());
        Ok(tables.iter().find(|(name, _)| name == stage).unwrap().1.clone())
    };
    let bytes = |stage: &str, name: &str| parquet::write(&table(stage, name)?);
    let source = Source { table: Some(&table), ..Source::of(&bytes) };
    let published = folder.publish(manifest, Facts::default, source).unwrap();
    (published, asked.into_inner())
}

fn check(folder: &Folder, tables: &[(String, Table)]) {
    let read = folder.manifest().unwrap();
    assert_eq!(read.stages.len(), tables.len());
    for ((_, table), stage) in tables.iter().zip(&read.stages) {
        assert_identical(&folder.table(&stage.tables[0]).unwrap(), table);
    }
    assert!(folder.known().unwrap().unwrap().changed().is_empty());
}

#[test]
fn many_small_tables_are_one_file() {
    let root = tempfile::tempdir().unwrap();
    let folder = Folder::new(root.path(), "s");
    let mut tables = many(STAGES);
    let (first, asked) = publish_all(&folder, &tables, &manifest_of(&tables));
    assert_eq!((first.changes.tables, asked.len()), (vec!["_modification.curve.parquet".to_owned()], STAGES));
    let parquets = |folder: &Folder| files(folder).iter().filter(|name| name.ends_with(".parquet")).count();
    assert_eq!(parquets(&folder), 1);
    check(&folder, &tables);
    #[cfg(feature = "hdf5")]
    {
        let whole = folder.whole("_modification.curve.parquet").unwrap();
        assert_identical(&whole, &hdf5::read(&folder.path().join("s.h5"), "_modification", "curve").unwrap());
    }
    // Nothing to do.
    let (again, asked) = publish_all(&folder, &tables, &manifest_of(&tables));
    assert_eq!((again.changes, asked.len()), (Changes::default(), 0));
    // One that has changed is asked for, the others are taken from the file.
    tables[7].1 = everything(9);
    let (changed, asked) = publish_all(&folder, &tables, &manifest_of(&tables));
    assert_eq!((changed.changes.tables.len(), asked), (1, vec!["m7".to_owned()]));
    check(&folder, &tables);
    // A file that is not what was written is not taken for good.
    fs::write(folder.path().join("_modification.curve.parquet"), "x").unwrap();
    let (damaged, asked) = publish_all(&folder, &tables, &manifest_of(&tables));
    assert_eq!((damaged.changes.foreign.len(), asked.len()), (1, STAGES));
    check(&folder, &tables);
    // A stage that is no more takes its rows along, though no other table has changed.
    let gone = tables.remove(3).0;
    let (fewer, asked) = publish_all(&folder, &tables, &manifest_of(&tables));
    assert_eq!((fewer.changes.tables.len(), asked.len()), (1, 0));
    assert!(!folder.whole("_modification.curve.parquet").unwrap().texts("stage").contains(&gone));
    check(&folder, &tables);
    // Few enough for files of their own, which are those of a study that never had more.
    tables.truncate(MANY);
    publish_all(&folder, &tables, &manifest_of(&tables));
    assert_eq!(parquets(&folder), MANY);
    check(&folder, &tables);
    for (name, table) in &tables {
        let bytes = fs::read(folder.path().join(format!("{name}.curve.parquet"))).unwrap();
        assert_eq!(bytes, parquet::write(table).unwrap());
    }
}

/// A stage that was not asked for keeps its rows, wherever they lie then.
#[test]
fn a_stage_that_was_skipped_keeps_its_rows() {
    let root = tempfile::tempdir().unwrap();
    let folder = Folder::new(root.path(), "s");
    let mut tables = many(STAGES);
    publish_all(&folder, &tables, &manifest_of(&tables));
    tables[0].1 = everything(8);
    let mut some = manifest_of(&tables);
    for stage in &mut some.stages[1..] {
        (stage.status, stage.why) = ("skipped".to_owned(), "not asked for".to_owned());
        stage.tables.clear();
    }
    let (_, asked) = publish_all(&folder, &tables, &some);
    assert_eq!(asked, ["m0"]);
    check(&folder, &tables);
    some.stages.truncate(MANY - 1);
    tables.truncate(MANY - 1);
    let (_, asked) = publish_all(&folder, &tables, &some);
    assert!(asked.is_empty(), "all are had from the bundle");
    check(&folder, &tables);
}

/// Whatever cannot be a line of a bundle has its file.
#[test]
fn tables_of_other_columns_have_their_files() {
    let root = tempfile::tempdir().unwrap();
    let folder = Folder::new(root.path(), "s");
    let mut tables = many(STAGES);
    tables[STAGES - 1].1 = crate::store::entry::part(&everything(5), |column| column.name != "stiffness").unwrap();
    tables[STAGES - 2].1 = everything(5000);
    publish_all(&folder, &tables, &manifest_of(&tables));
    let own = ["m38.curve.parquet", "m39.curve.parquet"];
    assert_eq!(STAGES, 40);
    assert!(own.iter().all(|name| files(&folder).contains(&(*name).to_owned())), "{:?}", files(&folder));
    check(&folder, &tables);
}
