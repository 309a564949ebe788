//! Both formats are read, and what is written is what was there.

use super::*;

/// As versions before format 2 wrote it.
const FIRST: &str = r#"{
  "format": 1, "study": "s", "title": "S", "seed": 3, "source": { "paper": "p", "tables": [1] },
  "study_digest": "d", "program": { "version": "0.1.0", "commit": null, "uncommitted_changes": null, "rustc": "r", "profile": "p" },
  "machine": { "system": "l", "processor": "p", "cores": 2, "threads": 2 }, "written": "2026-11-20T00:00:00Z", "seconds": 0.5,
  "stages": [{
    "name": "ste", "kind": "ste", "version": 1,
    "keys": [
      { "key": "KEY1", "config": "CONFIG", "fields": [["teeth", "0123456789ab"]], "axis": "AXIS1", "code": "CODE", "seed": "",
        "demand": "DEMAND", "inputs": [["pair", "INPUT"]] },
      { "key": "KEY2", "config": "CONFIG", "fields": [["teeth", "0123456789ab"]], "axis": "AXIS2", "code": "CODE", "seed": "",
        "demand": "DEMAND", "inputs": [["pair", "INPUT"]] }
    ],
    "config": { "torque": ["1 N m", "2 N m"] }, "status": "ran", "why": "never ran", "seconds": 0.25, "warnings": ["careful"],
    "left_out": [{ "what": "w", "why": "y", "saved_seconds": 0.5 }],
    "tables": [TABLE1, TABLE2]
  }],
  "files": [{ "file": "ste.curve.parquet", "bytes": 7, "digest": "e" }, { "file": "s.h5", "varies": true }]
}"#;
const TABLE: &str = r#"{ "name": "ste.NAME", "description": "Words.", "rows": 4, "content": "c", "file": "ste.NAME.parquet",
  "columns": [{ "name": "x", "type": "float", "unit": "um", "description": "X.", "key": true, "volatile": false,
    "absolute_tolerance": 0.0, "relative_tolerance": 1e-9 }] }"#;

fn first() -> String {
    let digits = ["KEY1", "KEY2", "CONFIG", "AXIS1", "AXIS2", "CODE", "DEMAND", "INPUT"].iter().enumerate();
    let text =
        FIRST.replace("TABLE1", &TABLE.replace("NAME", "curve")).replace("TABLE2", &TABLE.replace("NAME", "other"));
    digits.fold(text, |text, (digit, name)| text.replace(name, &format!("{digit}").repeat(64)))
}

/// A manifest with something in every field.
pub(super) fn sample() -> Manifest {
    Manifest { format: FORMAT, ..serde_json::from_str(&first()).unwrap() }
}

#[test]
fn the_first_format_is_read_and_the_second_says_the_same() {
    let old: Manifest = serde_json::from_str(&first()).unwrap();
    let stage = &old.stages[0];
    assert_eq!((old.format, stage.keys.len(), stage.tables[1].file.as_str()), (1, 2, "ste.other.parquet"));
    assert_eq!((stage.keys[1].key, stage.keys[1].seed), (Digest([0x11; 32]), None));
    assert_eq!(
        (stage.keys[1].config.to_string(), stage.keys[0].axis.unwrap().to_string()),
        ("222222222222".into(), "333333333333".into())
    );
    assert_eq!((&*stage.tables[0].description, stage.tables[0].columns[0].unit.as_str()), ("Words.", "um"));
    let text = String::from_utf8(old.text().unwrap()).unwrap();
    let new: Manifest = serde_json::from_str(&text).unwrap();
    assert_eq!(new, Manifest { format: FORMAT, ..old.clone() });
    assert_eq!(text.matches("Words.").count(), 2, "once for each table of the kind");
    assert_eq!(text.matches("222222222222").count(), 1, "once for all chunks");
    assert_eq!(String::from_utf8(new.text().unwrap()).unwrap(), text);
    // Many tables that are alike say it once, wherever they were read.
    let mut more = new.clone();
    for index in 0..40 {
        let mut stage = old.stages[0].clone();
        stage.name = format!("s{index}");
        for table in &mut stage.tables {
            table.name = format!("s{index}.{}", table.table());
            table.file = own_file(&table.name);
        }
        stage.tables[1].file = "_ste.other.parquet".to_owned();
        more.stages.push(stage);
    }
    more.stages[7].tables[0].columns = Arc::from([]);
    let text = String::from_utf8(more.text().unwrap()).unwrap();
    assert_eq!((text.matches("\"X.\"").count(), text.matches("\"ste.curve.2\"").count()), (2, 2));
    let read: Manifest = serde_json::from_str(&text).unwrap();
    assert_eq!(read.stages[9].tables[1].file, "_ste.other.parquet");
    assert_eq!(read.stages[9].tables[0].file, "s8.curve.parquet");
    let own = |manifest: &Manifest| manifest.stages[7].clone();
    assert_eq!(own(&read), StageRecord { tables: own(&read).tables, ..own(&more) });
    assert!(read.stages[7].tables[0].columns.is_empty() && !read.stages[8].tables[0].columns.is_empty());
}

/// A difference between two commits is read by people: what changed stands in lines of its own.
#[test]
fn a_change_is_a_few_lines() {
    let old: Manifest = serde_json::from_str(&first()).unwrap();
    let lines = |manifest: &Manifest| {
        String::from_utf8(manifest.text().unwrap()).unwrap().lines().map(str::to_owned).collect::<Vec<_>>()
    };
    let mut new = old.clone();
    new.stages[0].tables[1].rows = 5;
    new.stages[0].tables[1].content = "other".to_owned();
    let (before, after) = (lines(&old), lines(&new));
    assert_eq!(before.len(), after.len());
    assert_eq!(before.iter().zip(&after).filter(|(a, b)| a != b).count(), 1);
    assert!(before.iter().all(|line| line.len() < 500), "{before:#?}");
}

#[test]
fn a_table_without_columns_is_no_table() {
    let text = String::from_utf8(serde_json::from_str::<Manifest>(&first()).unwrap().text().unwrap()).unwrap();
    let wrong =
        serde_json::from_str::<Manifest>(&text.replace("\"schema\": \"ste.other\"", "\"schema\": \"ste.absent\""));
    assert!(wrong.unwrap_err().to_string().contains("ste.absent"));
}

/// Tier: second method; the text is kept up to the list, and is what writing all of it gives.
#[test]
fn another_list_of_files_needs_no_reading() {
    let mut manifest: Manifest = serde_json::from_str(&first()).unwrap();
    // A text may say what the list begins with.
    manifest.title = "\n \"files\": [".to_owned();
    let text = manifest.text().unwrap();
    for files in [&manifest.files[..], &manifest.files[1..], &[]] {
        let other = Manifest::with_other_files(text.clone(), files).unwrap();
        assert_eq!(String::from_utf8(other).unwrap(), String::from_utf8(manifest.text_with(files).unwrap()).unwrap());
    }
    let none = Manifest { files: Vec::new(), ..manifest.clone() }.text().unwrap();
    assert_eq!(Manifest::with_other_files(none, &manifest.files).unwrap(), text);
    // What this program did not write is not taken for it.
    for strange in [first().into_bytes(), serde_json::to_vec_pretty(&manifest).unwrap(), Vec::new()] {
        assert_eq!(Manifest::with_other_files(strange, &[]), None);
    }
}
