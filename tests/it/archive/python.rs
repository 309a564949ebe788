//! What the packages `rocrate` and `runcrate` make of an archive.

use std::ffi::OsStr;
use std::fs;

use super::archived;
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
