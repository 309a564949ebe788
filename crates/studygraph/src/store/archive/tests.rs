//! Archives made here come back; every way known to make a bad one is refused; mutated ones never panic.

use std::fs;
use std::io::{Cursor, Write};
use std::path::Path;

use chacha20::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use serde_json::json;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use super::open::{Archive, MOST_BYTES, MOST_ENTRIES, open};
use super::pack::{Entries, pack};
use super::{METADATA, sha256};

const STUDY: &str = "a.yaml";
const TABLE: &str = "results/a/t.parquet";

/// A description that names `parts`.
fn metadata(parts: &[&str]) -> Vec<u8> {
    let parts: Vec<_> = parts.iter().map(|id| json!({ "@id": id })).collect();
    let graph = json!([
        { "@id": METADATA, "about": { "@id": "./" } },
        { "@id": "./", "hasPart": parts, "mainEntity": { "@id": STUDY } },
    ]);
    serde_json::to_vec(&json!({ "@graph": graph })).unwrap()
}

/// The entries, described with their digests.
fn digested() -> Entries {
    let mut entries = entries();
    let value: serde_json::Value = serde_json::from_slice(&entries[METADATA]).unwrap();
    let mut graph = value["@graph"].as_array().unwrap().clone();
    let files = entries.iter().filter(|(name, _)| *name != METADATA);
    graph.extend(files.map(|(name, bytes)| json!({ "@id": name, "@type": ["File", "X"], "sha256": sha256(bytes) })));
    entries.insert(METADATA.to_owned(), serde_json::to_vec(&json!({ "@graph": graph })).unwrap());
    entries
}

fn entries() -> Entries {
    let named = |name: &str, bytes: &[u8]| (name.to_owned(), bytes.to_vec());
    Entries::from([
        named(METADATA, &metadata(&[STUDY, TABLE, "https://example.org/paper"])),
        named(STUDY, "study: a, and enough of it to be worth compressing, compressing, compressing".as_bytes()),
        named(TABLE, &[7; 300]),
    ])
}

fn check(bytes: &[u8]) -> Result<Archive<Cursor<Vec<u8>>>, String> {
    Archive::check(Cursor::new(bytes.to_vec()), "x.zip").map_err(|error| error.to_string())
}

#[track_caller]
fn refused(bytes: &[u8], wanted: &str) {
    match check(bytes) {
        Ok(_) => panic!("accepted; expected: {wanted}"),
        Err(problem) => {
            assert!(problem.contains(wanted) && problem.contains("`x.zip`") && !problem.contains('\n'), "{problem}");
        }
    }
}

/// The entries and one more that the writer makes as it is told.
fn with(name: &str, options: SimpleFileOptions, bytes: &[u8]) -> Vec<u8> {
    let mut writer = ZipWriter::new_append(Cursor::new(pack(&entries()).unwrap())).unwrap();
    writer.start_file(name, options).unwrap();
    writer.write_all(bytes).unwrap();
    writer.finish().unwrap().into_inner()
}

/// Replaces every occurrence; as many bytes.
fn patched(bytes: &[u8], from: &[u8], to: &[u8]) -> Vec<u8> {
    assert_eq!(from.len(), to.len());
    let mut patched = bytes.to_vec();
    let mut found = 0;
    for at in 0..=bytes.len() - from.len() {
        if &bytes[at..at + from.len()] == from {
            patched[at..at + to.len()].copy_from_slice(to);
            found += 1;
        }
    }
    assert!(found > 0);
    patched
}

#[test]
fn what_is_packed_comes_back_and_is_the_same_bytes_again() {
    let bytes = pack(&entries()).unwrap();
    assert_eq!(bytes, pack(&entries()).unwrap());
    let mut archive = check(&bytes).unwrap();
    assert_eq!(archive.described().unwrap(), STUDY);
    assert_eq!(archive.names().collect::<Vec<_>>(), entries().keys().map(String::as_str).collect::<Vec<_>>());
    for (name, content) in entries() {
        assert_eq!(archive.bytes(&name).unwrap(), content, "{name}");
    }
    assert!(archive.bytes("absent").is_err());
    // No time: the first that the format can name, in both directories.
    assert_eq!(bytes.windows(4).filter(|window| **window == [0, 0, 0x21, 0]).count(), 2 * entries().len());
}

/// As systems and other programs hand crates on: unpacked, in a folder, with files of their own.
#[test]
fn crates_are_read_unpacked_and_in_a_folder_and_beside_files_of_systems() {
    let mut entries = digested();
    for extra in
        [".DS_Store", "results/.DS_Store", "__MACOSX/._a.yaml", "ro-crate-preview.html", "ro-crate-preview_files/a.css"]
    {
        entries.insert(extra.to_owned(), b"x".to_vec());
    }
    let inside: Entries = entries.iter().map(|(name, bytes)| (format!("up/crate/{name}"), bytes.clone())).collect();
    for entries in [&entries, &inside] {
        let mut archive = check(&pack(entries).unwrap()).unwrap();
        archive.intact().unwrap();
        assert_eq!((archive.described().unwrap(), archive.bytes(TABLE).unwrap()), (STUDY.to_owned(), vec![7; 300]));
    }
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in &inside {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
    let own = folder.path().join("up/crate");
    for path in [folder.path(), &own, &own.join(METADATA)] {
        let mut archive = open(path).unwrap();
        archive.intact().unwrap();
        assert_eq!((archive.described().unwrap(), archive.bytes(TABLE).unwrap()), (STUDY.to_owned(), vec![7; 300]));
    }
    // Files beside the folder of the crate are none of it; inside they were added.
    fs::write(folder.path().join("README.txt"), "").unwrap();
    fs::write(folder.path().join("up/README.md"), "").unwrap();
    open(folder.path()).unwrap().intact().unwrap();
    let mut beside = inside.clone();
    beside.extend([("README.txt".to_owned(), b"x".to_vec()), ("up/README.md".to_owned(), b"x".to_vec())]);
    check(&pack(&beside).unwrap()).unwrap().intact().unwrap();
    fs::write(own.join("more"), "").unwrap();
    let said = open(folder.path()).unwrap().intact().unwrap_err().to_string();
    assert!(said.ends_with("says: `more` was added"), "{said}");
    fs::remove_file(own.join(TABLE)).unwrap();
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("/etc/passwd", own.join(TABLE)).unwrap();
        let said = open(&own).err().unwrap().to_string();
        assert!(said.contains("the entry `results/a/t.parquet` is a symbolic link"), "{said}");
    }
    // Two crates are not one.
    let mut two = inside.clone();
    two.extend(digested().into_iter().map(|(name, bytes)| (format!("other/{name}"), bytes)));
    refused(&pack(&two).unwrap(), "it has 2 crates, in `other/` and `up/crate/`: unpack it, and name one of them");
}

#[test]
fn names_that_lead_elsewhere_are_refused() {
    let plain = SimpleFileOptions::default();
    for (name, wanted) in [
        ("../x", "points outside"),
        ("a/../../x", "points outside"),
        ("a/..", "points outside"),
        ("/etc/passwd", "absolute path"),
        ("C:/x", "absolute path"),
        ("a//b", "empty parts"),
        ("./a", "empty parts"),
        ("a\nb", "control characters"),
    ] {
        refused(&with(name, plain, b"x"), wanted);
    }
    refused(&with(&"x".repeat(256), plain, b"x"), "too long a name");
    // Writers turn backslashes round; whoever means harm does not.
    refused(&patched(&with("..Xx", plain, b"x"), b"..Xx", b"..\\x"), "backslashes");
    refused(&patched(&with("bad!", plain, b"x"), b"bad!", b"bad\xff"), "not UTF-8");
}

#[test]
fn links_and_repeated_names_are_refused() {
    let mut writer = ZipWriter::new_append(Cursor::new(pack(&entries()).unwrap())).unwrap();
    writer.add_symlink("link", "/etc/passwd", SimpleFileOptions::default()).unwrap();
    refused(&writer.finish().unwrap().into_inner(), "symbolic link");
    let twice = with("b.yaml", SimpleFileOptions::default(), b"study: b");
    refused(&patched(&twice, b"b.yaml", b"a.yaml"), "two entries `a.yaml`");
}

/// An entry whose bytes hold another one, header and all, and a directory that lists both: readers that go by the
/// directory see two files, those that go from header to header one.
#[test]
fn entries_inside_each_other_are_refused() {
    let stored = SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
    let find = |bytes: &[u8], from: usize, wanted: &[u8]| {
        from + bytes[from..].windows(wanted.len()).position(|window| window == wanted).unwrap()
    };
    let alone = with("b.yaml", stored, b"x");
    let name = find(&alone, 0, b"b.yaml");
    let inner = &alone[name - 30..=name + "b.yaml".len()];
    assert!(inner.starts_with(b"PK\x03\x04"));
    let mut writer = ZipWriter::new_append(Cursor::new(pack(&entries()).unwrap())).unwrap();
    for (name, bytes) in [("a.bin", inner), ("b.yaml", b"x")] {
        writer.start_file(name, stored).unwrap();
        writer.write_all(bytes).unwrap();
    }
    let mut bytes = writer.finish().unwrap().into_inner();
    assert!(check(&bytes).is_ok(), "side by side they are two files");
    let within = find(&bytes, 0, inner);
    let listed = bytes.windows(4).rposition(|window| window == b"PK\x01\x02").unwrap();
    assert_eq!(&bytes[listed + 46..listed + 52], b"b.yaml");
    bytes[listed + 42..listed + 46].copy_from_slice(&u32::try_from(within).unwrap().to_le_bytes());
    refused(&bytes, "is damaged");
}

/// The size of the table, as both directories write it.
fn declared(bytes: &[u8], size: u32) -> Vec<u8> {
    patched(
        bytes,
        &[&300_u32.to_le_bytes()[..], &300_u32.to_le_bytes()[..]].concat(),
        &[&300_u32.to_le_bytes()[..], &size.to_le_bytes()[..]].concat(),
    )
}

#[test]
fn bombs_are_refused() {
    let bytes = pack(&entries()).unwrap();
    refused(&declared(&bytes, u32::try_from(MOST_BYTES).unwrap() + 1), "larger than 1024 MiB");
    // What is said and what is there: the compressed zeros say that they are 77 bytes and are a million.
    let zeros = with("zeros", SimpleFileOptions::default(), &vec![0; 1_000_000]);
    refused(
        &patched(&zeros, &1_000_000_u32.to_le_bytes(), &77_u32.to_le_bytes()),
        "larger than its declared uncompressed size",
    );
    refused(&patched(&zeros, &1_000_000_u32.to_le_bytes(), &2_000_000_u32.to_le_bytes()), "it says it has 2000000");
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for index in 0..=MOST_ENTRIES {
        writer.start_file(index.to_string(), SimpleFileOptions::default()).unwrap();
    }
    refused(&writer.finish().unwrap().into_inner(), "10001 entries, more than 10000");
}

#[test]
fn damage_is_found_wherever_it_is() {
    let bytes = pack(&entries()).unwrap();
    refused(b"", "not an archive");
    refused(b"PK no, this is a letter", "not an archive");
    for length in 0..bytes.len() {
        assert!(check(&bytes[..length]).is_err(), "cut off after {length} bytes");
    }
    refused(&patched(&bytes, &[7; 300], &[8; 300]), "`results/a/t.parquet`: ");
    assert!(open(std::path::Path::new("/no/such/file")).is_err_and(|error| error.to_string().contains("cannot read")));
    assert!(open(Path::new("/dev/null")).is_err_and(|error| error.to_string().contains("neither a file nor a folder")));
}

#[test]
fn a_description_that_does_not_describe_is_refused() {
    let described = |bytes: Vec<u8>| {
        pack(
            &Entries::from([(METADATA.to_owned(), bytes)])
                .into_iter()
                .chain([(STUDY.to_owned(), b"study: a".to_vec())])
                .collect(),
        )
        .unwrap()
    };
    let mut without = entries();
    without.remove(METADATA);
    refused(&pack(&without).unwrap(), "has no `ro-crate-metadata.json`");
    refused(&described(b"{".to_vec()), "is damaged");
    refused(&described(b"[]".to_vec()), "describes no data set");
    refused(&described(("[".repeat(100_000)).into_bytes()), "is damaged");
    for outside in ["../x", "/etc/passwd", "file:///etc/passwd", "%2e%2e/x", "absent"] {
        refused(&described(metadata(&[STUDY, outside])), &format!("names `{outside}`"));
    }
    let other = String::from_utf8(metadata(&[])).unwrap().replace(STUDY, "../a.yaml");
    refused(&described(other.into_bytes()), "names no study");
}

/// Checksums of the zip are those of whoever packed it last; the description says what was archived.
#[test]
fn files_are_those_that_the_description_names() {
    assert_eq!(sha256(b"abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad", "FIPS 180-4, B.1");
    let intact =
        |entries: &Entries| check(&pack(entries).unwrap()).unwrap().intact().map_err(|error| error.to_string());
    assert_eq!(intact(&digested()), Ok(()));
    let mut changed = digested();
    changed.get_mut(TABLE).unwrap()[299] = 8;
    changed.insert("more".to_owned(), Vec::new());
    let said = intact(&changed).unwrap_err();
    let both = "is not what `ro-crate-metadata.json` says: `more` was added, `results/a/t.parquet` has other contents";
    assert!(said.ends_with(both), "{said}");
    let text = String::from_utf8(digested()[METADATA].clone()).unwrap();
    let described = |text: String| {
        let mut entries = digested();
        entries.insert(METADATA.to_owned(), text.into_bytes());
        intact(&entries).unwrap_err()
    };
    assert!(described(text.replace("sha256", "sha1")).contains("`a.yaml` has no digest"));
    let gone = text.replace("\"@graph\":[", "\"@graph\":[{\"@id\":\"gone\",\"@type\":\"File\"},");
    assert!(described(gone).ends_with("says: `gone` is missing"));
    assert!(intact(&entries()).unwrap_err().contains("`a.yaml` was added"), "no digest at all");
}

/// Bytes changed, cut out, put in, moved: an answer, never a panic; what is accepted can be read.
#[test]
fn mutated_archives_never_panic() {
    let original = pack(&entries()).unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(6);
    let mut below = |limit: usize| usize::try_from(random.next_u64() % (limit.max(1) as u64)).unwrap();
    let [mut accepted, mut kinds] = [0, 0];
    let mut problems = std::collections::BTreeSet::new();
    for _ in 0..4000 {
        let mut bytes = original.clone();
        for _ in 0..=below(3) {
            let (at, length) = (below(bytes.len()), below(12));
            let end = (at + length).min(bytes.len());
            match below(5) {
                0 => bytes[at] = u8::try_from(below(256)).unwrap(),
                1 => bytes[at] ^= 1 << below(8),
                2 => drop(bytes.drain(at..end)),
                3 => {
                    let copied = bytes[at..end].to_vec();
                    let to = below(bytes.len());
                    bytes.splice(to..to, copied);
                }
                _ => bytes[at..end].fill([0, 0xff][below(2)]),
            }
            if bytes.is_empty() {
                break;
            }
        }
        match check(&bytes) {
            Ok(mut archive) => {
                accepted += 1;
                let names: Vec<String> = archive.names().map(str::to_owned).collect();
                for name in names {
                    archive.bytes(&name).unwrap();
                }
            }
            Err(problem) => kinds += usize::from(problems.insert(problem)),
        }
    }
    // Some bytes do not matter (a version, a mode); most do, and for many different reasons.
    assert!((1..2000).contains(&accepted) && kinds > 20, "{accepted} {kinds}");
}
