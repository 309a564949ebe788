//! What a run published, without the facts of that run: two runs of one study must agree in it, byte for byte.
//!
//! Must not know: how the run went.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde_json::Value;

/// Behind it a page has program, machine and times.
const FACTS: &str = "<!-- run:";

/// Every published file by name.
pub type Published = BTreeMap<String, Vec<u8>>;

/// Names that begin with a dot are not results: locks, and leftovers of killed runs; nor is the index, which has times.
pub fn published(folder: &Path) -> Published {
    let mut files = Published::new();
    collect(folder, "", &mut files);
    files
}

fn collect(folder: &Path, prefix: &str, files: &mut Published) {
    for entry in fs::read_dir(folder).into_iter().flatten() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let whole = format!("{prefix}{name}");
        if path.is_dir() {
            collect(&path, &format!("{whole}/"), files);
        } else if !name.starts_with('.') && name != "files.json" {
            files.insert(whole, essence(&name, fs::read(&path).unwrap()));
        }
    }
}

/// A file without the facts of the run that wrote it.
pub fn essence(name: &str, bytes: Vec<u8>) -> Vec<u8> {
    match name {
        "manifest.json" => manifest(&bytes),
        "report.html" => {
            let text = String::from_utf8_lossy(&bytes).into_owned();
            let (page, facts) = text.split_once(FACTS).unwrap_or((&text, ""));
            // A page that was cut short has no end.
            format!("{page}{}", facts.trim_end().ends_with("</html>")).into_bytes()
        }
        _ => bytes,
    }
}

fn manifest(bytes: &[u8]) -> Vec<u8> {
    let Ok(mut manifest) = serde_json::from_slice::<Value>(bytes) else { return bytes.to_vec() };
    for name in ["program", "machine", "study_folder", "written", "seconds"] {
        manifest[name] = Value::Null;
    }
    for stage in manifest["stages"].as_array_mut().unwrap() {
        for name in ["seconds", "status", "why", "left_out"] {
            stage[name] = Value::Null;
        }
    }
    serde_json::to_vec(&manifest).unwrap()
}

/// Where two results differ, by name.
pub fn differences(a: &Published, b: &Published) -> Vec<String> {
    let names = a.keys().chain(b.keys().filter(|name| !a.contains_key(*name)));
    names.filter(|name| a.get(*name) != b.get(*name)).cloned().collect()
}
