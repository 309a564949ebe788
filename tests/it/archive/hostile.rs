//! Archives whose study, manifest or tables are not what they should be: one message, code 1 or 2, and no panic.

use std::fs;
use std::io::Cursor;

use chacha20::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use serde_json::{Value, json};

use super::{archived, entries, manifest, packed, put_manifest};
use crate::desk::Desk;
use gearstudy::program::PROGRAM;
use studygraph::runner::verify::unpack;
use studygraph::store::archive::METADATA;
use studygraph::store::archive::open::Archive;
use studygraph::store::archive::pack::{Entries, pack};

/// Verifies what `change` makes of an archive, which must end with `code` and one message with `wanted` in it.
#[track_caller]
fn refused(desk: &Desk, code: i32, wanted: &str, change: impl FnOnce(&mut Entries)) {
    let mut changed = entries(&desk.path("a.zip"));
    change(&mut changed);
    fs::write(desk.path("b.zip"), packed(changed)).unwrap();
    let (_, error) = desk.run(&["verify", "b.zip", "--quiet"], code);
    assert!(error.contains(wanted) && !error.contains("bug"), "{error}");
}

#[test]
fn what_does_not_belong_together_is_refused() {
    let desk = archived("quick.yaml", &[]);
    let (study, table) = ("quick.yaml", "results/quick/ste.summary.parquet");
    refused(&desk, 1, "names no study", |entries| {
        let mut value: Value = serde_json::from_slice(&entries[METADATA]).unwrap();
        value["@graph"][1]["mainEntity"] = json!({ "@id": "../../quick.yaml" });
        entries.insert(METADATA.to_owned(), serde_json::to_vec(&value).unwrap());
    });
    refused(&desk, 1, "names `results/quick/ste.summary.parquet`, which is not in it", |entries| {
        drop(entries.remove(table));
    });
    refused(&desk, 2, "quick.yaml:", |entries| drop(entries.insert(study.to_owned(), b"study: [".to_vec())));
    refused(&desk, 2, "too large for a study", |entries| drop(entries.insert(study.to_owned(), vec![b'a'; 4 << 20])));
    refused(&desk, 1, "it is not about the study", |entries| {
        entries.get_mut(study).unwrap().extend(b"# a remark\n");
    });
    refused(&desk, 1, "`results/quick/manifest.json`", |entries| {
        drop(entries.insert("results/quick/manifest.json".to_owned(), b"{".to_vec()));
    });
    refused(&desk, 1, "it has no `results/quick/../../../etc/passwd`", |entries| {
        let mut manifest = manifest(entries);
        manifest.stages[0].tables[0].file = "../../../etc/passwd".to_owned();
        put_manifest(entries, &manifest);
    });
    refused(&desk, 1, "it has format 3", |entries| {
        let mut manifest = manifest(entries);
        manifest.format = 3;
        put_manifest(entries, &manifest);
    });
    refused(&desk, 1, "its values are not those", |entries| {
        let other = entries["results/quick/stiffness.summary.parquet"].clone();
        entries.insert(table.to_owned(), other);
    });
    refused(&desk, 1, "`results/quick/ste.summary.parquet`", |entries| {
        drop(entries.insert(table.to_owned(), b"PAR1 no table PAR1".to_vec()));
    });
    // The table is given by no stage of this program: it is told, and the others are compared.
    refused(&desk, 4, "1 of", |entries| {
        let mut manifest = manifest(entries);
        let mut unknown = manifest.stages[0].tables[0].clone();
        unknown.name = "pair.unknown".to_owned();
        manifest.stages[0].tables.push(unknown);
        put_manifest(entries, &manifest);
    });
    fs::write(desk.path("b.zip"), "a letter").unwrap();
    assert!(desk.run(&["verify", "b.zip"], 1).1.contains("`b.zip` is not an archive"));
    assert!(desk.run(&["verify", "absent.zip"], 1).1.contains("cannot read `absent.zip`"));
}

/// Mutated where the checksums of the zip file do not help: packed anew.
#[test]
fn mutated_studies_and_manifests_never_panic() {
    let desk = archived("quick.yaml", &[]);
    let all = entries(&desk.path("a.zip"));
    let (study, inside) = ("quick.yaml", "results/quick/manifest.json");
    let described = json!({ "@graph": [
        { "@id": METADATA, "about": { "@id": "./" } },
        { "@id": "./", "hasPart": [{ "@id": study }, { "@id": inside }], "mainEntity": { "@id": study } },
    ]});
    let mut small = Entries::from([(METADATA.to_owned(), serde_json::to_vec(&described).unwrap())]);
    for name in [study, inside] {
        small.insert(name.to_owned(), all[name].clone());
    }
    let work = tempfile::tempdir().unwrap();
    let check = |entries: &Entries| {
        let archive = Archive::check(Cursor::new(pack(entries).unwrap()), "x.zip");
        let mut archive = archive.map_err(|error| error.to_string())?;
        unpack(&mut archive, work.path(), &PROGRAM).map(drop).map_err(|error| error.to_string())
    };
    assert_eq!(check(&small), Ok(()));
    let mut random = ChaCha8Rng::seed_from_u64(66);
    let mut below = |limit: usize| usize::try_from(random.next_u64() % (limit.max(1) as u64)).unwrap();
    let mut problems = std::collections::BTreeSet::new();
    for round in 0..240 {
        let mut entries = small.clone();
        let bytes = entries.get_mut([METADATA, study, inside][round % 3]).unwrap();
        for _ in 0..=below(2) {
            let at = below(bytes.len());
            let end = (at + below(40)).min(bytes.len());
            match below(3) {
                0 => bytes[at] = b"{}[]:,\"0\xff -"[below(11)],
                1 => drop(bytes.drain(at..end)),
                _ => {
                    let copied = bytes[at..end].to_vec();
                    bytes.splice(at..at, copied);
                }
            }
        }
        if let Err(problem) = check(&entries) {
            problems.insert(problem);
        }
    }
    assert!(problems.len() > 50, "{}", problems.len());
}
