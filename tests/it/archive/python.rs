//! What the packages `rocrate` and `runcrate` make of an archive.

use std::ffi::OsStr;
use std::fs;

use serde_json::Value;
use studygraph::store::archive::METADATA;

use super::{archived, entries};
use crate::python;

#[test]
fn rocrate_and_runcrate_read_the_archive() {
    let desk = archived("quick.yaml", &[]);
    let words = ["--license", "CC-BY-4.0", "--author", "Ada Lovelace 0000-0002-1825-0097"];
    desk.run(&[&["archive", "quick.yaml", "-o", "b.zip"][..], &words].concat(), 0);
    fs::create_dir(desk.path("unpacked")).unwrap();
    for (name, license) in [("a.zip", "#license"), ("b.zip", "https://spdx.org/licenses/CC-BY-4.0")] {
        let (file, folder) = (desk.path(name), desk.path("unpacked").join(name));
        let Some(said) = python::run("crate.py", &[file.as_os_str(), folder.as_os_str(), OsStr::new(license)]) else {
            return;
        };
        let count: Vec<usize> = said.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        // Stages; tables; files: as many as the manifest lists.
        assert_eq!(count[0], 6, "{said}");
        assert_eq!(count[1], desk.contents("quick").len(), "{said}");
        assert!(count[2] > count[1], "{said}");
    }
}

/// roc-validator holds archives to RO-Crate 1.3: with a paper by its name alone and no licence; with a DOI, several
/// licences and an author.
#[test]
fn archives_meet_every_required_check_of_ro_crate() {
    let desk = archived("quick.yaml", &[]);
    let text = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    let archive = |paper: &str, file: &str, words: &[&str]| {
        let source = format!("seed: 1\nsource: {{ paper: {paper:?}, tables: [1] }}\n");
        fs::write(desk.path("quick.yaml"), text.replacen("seed: 1\n", &source, 1)).unwrap();
        desk.run(&["run", "quick.yaml", "--quiet"], 0);
        desk.run(&[&["archive", "quick.yaml", "-o", file][..], words].concat(), 0);
        let crated: Value = serde_json::from_slice(&entries(&desk.path(file))[METADATA]).unwrap();
        let graph = crated["@graph"].as_array().unwrap();
        let mut ids: Vec<&str> = graph.iter().map(|entity| entity["@id"].as_str().unwrap()).collect();
        ids.sort_unstable();
        assert!(ids.windows(2).all(|pair| pair[0] != pair[1]), "an identifier has two entities: {ids:?}");
        graph.iter().find(|entity| entity["@id"] == "./").unwrap().clone()
    };
    let root = archive("author2020", "b.zip", &[]);
    assert_eq!((&root["citation"], &root["isBasedOn"][1]["@id"]), (&Value::Null, &"#paper-author2020".into()));
    let words = ["--license", "mit or apache-2.0", "--author", "Ada Lovelace 0000-0002-1825-0097"];
    let root = archive("A. Author, 2020, doi:10.1000/182.", "c.zip", &words);
    assert_eq!(root["citation"]["@id"], "https://doi.org/10.1000/182");
    let files = ["b.zip", "c.zip"].map(|name| desk.path(name));
    python::run("ro_crate_validator.py", &files.each_ref().map(|file| file.as_os_str()));
}
