//! Files that cannot be read, or hold no text.

use std::fs;
use std::path::Path;

use super::PROGRAM;
use crate::study::load;

fn refused(path: &Path) -> String {
    load(path, &PROGRAM).err().expect("it is refused").to_string()
}

#[test]
fn a_file_that_is_missing_is_said_to_be_and_its_neighbour_named() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("energy_ga.yaml"), "").unwrap();
    let wanted = folder.path().join("energy-ga.yaml");
    let near = folder.path().join("energy_ga.yaml");
    assert_eq!(
        refused(&wanted),
        format!("{}: there is no such file\n  help: did you mean `{}`?", wanted.display(), near.display())
    );
    let far = folder.path().join("nowhere/zzzzzzzz.yaml");
    assert_eq!(refused(&far), format!("{}: there is no such file", far.display()));
}

#[test]
fn a_directory_is_no_study_but_may_hold_one() {
    let folder = tempfile::tempdir().unwrap();
    let message = format!("{}: this is a directory; a study is one YAML file", folder.path().display());
    assert_eq!(refused(folder.path()), format!("{message}\n  help: there is no YAML file in it"));
    for name in ["b.yaml", "a.yml", "0.txt"] {
        fs::write(folder.path().join(name), "").unwrap();
    }
    let first = folder.path().join("a.yml");
    let help = format!("name a file in it, for example `{}`", first.display());
    assert_eq!(refused(folder.path()), format!("{message}\n  help: {help}"));
}

#[test]
fn bytes_that_are_no_utf8_have_a_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.yaml");
    let refused_bytes = |bytes: &[u8]| {
        fs::write(&path, bytes).unwrap();
        refused(&path).replacen(&path.display().to_string(), "a.yaml", 1)
    };
    let help = "\n  help: save it as UTF-8";
    assert_eq!(
        refused_bytes(b"study: a\r\ntitle: \xc2\xb5 \xb5m\r\n"),
        format!("a.yaml:2:10: this file is not UTF-8: the byte 0xB5 cannot stand here{help}")
    );
    assert_eq!(refused_bytes(b"\xff\xfes\0t\0"), format!("a.yaml:1:1: this file is UTF-16, not UTF-8{help}"));
    // A character that is cut off at the end.
    assert_eq!(
        refused_bytes(b"study: \xc2"),
        format!("a.yaml:1:8: this file is not UTF-8: the byte 0xC2 cannot stand here{help}")
    );
}

#[test]
fn a_file_that_is_too_large_is_not_parsed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.yaml");
    let expected = "this file is larger than 1024 KiB, too large for a study";
    fs::write(&path, "[".repeat(10_000_000)).unwrap();
    assert!(refused(&path).contains(expected), "{}", refused(&path));
    // One byte decides.
    fs::write(&path, "#".repeat((1 << 20) + 1)).unwrap();
    assert!(refused(&path).contains(expected));
    fs::write(&path, "#".repeat(1 << 20)).unwrap();
    assert!(refused(&path).contains("empty"));
    // A file without an end and without a size of its own.
    assert!(refused(Path::new("/dev/zero")).contains(expected));
}
