//! Every published byte: a changed one is noticed by whoever looks, and two runs of two versions of a study into one folder
//! never make a whole file look damaged.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};

use super::diff::{committed, git};
use crate::archive::{archived, entries, packed};
use crate::desk::Desk;
use studygraph::store::archive::METADATA;
use studygraph::store::hdf5::Writer;
use studygraph::store::index::{INDEX, Index, digest};
use studygraph::store::manifest::Manifest;
use studygraph::store::parquet;
use studygraph::table::data::{Data, Table};

fn manifest(desk: &Desk) -> Manifest {
    serde_json::from_slice(&fs::read(desk.path("results/quick/manifest.json")).unwrap()).unwrap()
}

/// Changes one byte and keeps the size; the time as well, which anybody can set.
fn spoil(path: &Path) {
    let modified = fs::metadata(path).unwrap().modified().unwrap();
    let mut bytes = fs::read(path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(path, bytes).unwrap();
    fs::File::options().write(true).open(path).unwrap().set_modified(modified).unwrap();
}

#[test]
fn a_changed_byte_of_any_file_is_noticed_by_every_command_and_mended_by_a_run() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    let (told, _) = desk.run(&["status", "--check", "quick.yaml"], 0);
    let files: Vec<String> = manifest(&desk).files.into_iter().map(|record| record.file).collect();
    assert!(told.starts_with("quick: up to date\n") && told.contains(&format!("{} files as", files.len())), "{told}");
    for kind in ["report.html", "figures/torque.svg", "quick.h5", "ste.curve.parquet", "report.verdicts.parquet"] {
        assert!(files.iter().any(|file| file == kind), "{kind} is not listed: {files:?}");
        let path = desk.path("results/quick").join(kind);
        let before = fs::read(&path).unwrap();
        let text = fs::read(desk.path("results/quick/manifest.json")).unwrap();
        spoil(&path);
        assert!(desk.run(&["status", "quick.yaml"], 0).0.contains(kind));
        let (out, error) = desk.run(&["status", "--check", "quick.yaml"], 4);
        assert!(out.contains(&format!("{kind}: damaged")) && error.contains(kind), "{out}{error}");
        assert!(desk.run(&["diff", "results", "results"], 4).0.contains(kind));
        let (_, refused) = desk.run(&["archive", "quick.yaml", "-o", "a.zip"], 1);
        assert!(refused.contains(kind) && refused.contains("first: gearstudy run quick.yaml"), "{refused}");
        let (out, _) = desk.run(&["run", "quick.yaml"], 0);
        assert!(out.contains(&format!("`{kind}` was not what the last run wrote; it is written anew")), "{out}");
        assert!(fs::read(&path).unwrap() == before, "{kind} came out otherwise");
        assert!(fs::read(desk.path("results/quick/manifest.json")).unwrap() == text, "{kind}: another manifest");
        assert!(desk.run(&["run", "quick.yaml"], 0).0.contains("nothing to do"));
    }
    // The cache as well: no other command reads it all.
    let folder = fs::read_dir(desk.path(".gearstudy/cache/entries")).unwrap().next().unwrap().unwrap().path();
    let entry = fs::read_dir(folder).unwrap().next().unwrap().unwrap().path();
    let mut bytes = fs::read(&entry).unwrap();
    *bytes.last_mut().unwrap() ^= 1;
    fs::write(&entry, bytes).unwrap();
    // A run with nothing to do would not read it; so it is gone once it is named.
    let (_, error) = desk.run(&["status", "--check", "quick.yaml"], 4);
    assert!(error.contains(&*entry.file_name().unwrap().to_string_lossy()), "{error}");
    desk.run(&["run", "quick.yaml"], 0);
    desk.run(&["status", "--check", "quick.yaml"], 0);
    // What cannot be looked into hides nothing else.
    // A folder of entries that no key begins with: keys change with the code.
    let free =
        (0..=255_u8).map(|name| desk.path(&format!(".gearstudy/cache/entries/{name:02x}"))).find(|path| !path.exists());
    fs::write(free.unwrap(), "a file").unwrap();
    fs::remove_dir_all(desk.path(".gearstudy/cache/journals")).unwrap();
    fs::write(desk.path(".gearstudy/cache/journals"), "a file").unwrap();
    desk.run(&["status", "--check", "quick.yaml"], 0);
}

/// Whatever bit of a table is changed, all who read it say that it is damaged; the library that reads Parquet panics at
/// some of them.
#[test]
fn no_damage_to_a_table_ends_in_a_panic() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    let path = desk.path("results/quick/ste.summary.parquet");
    let whole = fs::read(&path).unwrap();
    let mut refused = 0;
    for at in (0..whole.len()).step_by(3) {
        let mut bytes = whole.clone();
        bytes[at] ^= 1 << (at % 8);
        refused += usize::from(parquet::read(bytes).is_err());
    }
    assert!(refused > whole.len() / 30, "{refused} of {}", whole.len() / 3);
    // In the footer lie offsets and lengths.
    for at in (whole.len() - 1400..whole.len() - 8).step_by(90) {
        let mut bytes = whole.clone();
        bytes[at] ^= 2;
        fs::write(&path, bytes).unwrap();
        let output = desk.command(&["table", "quick.yaml", "ste.summary"]).output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(matches!(output.status.code(), Some(0 | 1)) && !error.contains("panicked"), "{at}: {error}");
    }
}

/// Figures of what was measured lie apart, so that what git keeps is the same after every run.
#[test]
fn what_differs_from_run_to_run_lies_apart() {
    let desk = Desk::with("quick.yaml");
    let text = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    let stage = "  cost:\n    kind: accuracy\n    of: stiffness\n    quantities: [summary.mean]\n    reference: {}\n    ladders: \
                 { l: [{}] }\n    repeats: 1\n  report:\n";
    let figure = "      - { name: seconds, title: Time, kind: points, table: cost.ladder, x: seconds, y: value }\n";
    fs::write(desk.path("quick.yaml"), text.replace("  report:\n", stage) + figure).unwrap();
    let kept = || -> Vec<(String, Vec<u8>)> {
        let read = |file: String| (file.clone(), fs::read(desk.path("results/quick").join(file)).unwrap());
        manifest(&desk).files.into_iter().filter(|record| !record.varies).map(|record| read(record.file)).collect()
    };
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    let (first, seconds) = (kept(), desk.path("results/quick/figures/measured/seconds.svg"));
    assert!(first.iter().any(|(file, _)| file == "figures/torque.svg") && seconds.is_file());
    assert!(!desk.path("results/quick/figures/seconds.svg").exists());
    desk.run(&["run", "--quiet", "--force", "quick.yaml"], 0);
    assert!(first == kept());
}

/// What git keeps has a digest in the manifest, so a commit can be looked at as well.
#[test]
fn a_figure_that_was_changed_before_the_commit_is_found() {
    let desk = committed();
    let ignored = fs::read_to_string(desk.path(".gitignore")).unwrap();
    fs::write(desk.path(".gitignore"), format!("{ignored}!results/*/figures/\nresults/*/figures/measured/\n")).unwrap();
    let figure = desk.path("results/quick/figures/torque.svg");
    let before = fs::read(&figure).unwrap();
    spoil(&figure);
    git(&desk, &["add", "-A"]);
    git(&desk, &["commit", "-qm", "two"]);
    fs::write(&figure, before).unwrap();
    let (told, _) = desk.run(&["diff", "HEAD"], 4);
    assert!(told.contains("figures/torque.svg has other bytes than were written"), "{told}");
}

/// What was archived is made again from the archived tables: a page, a figure and an HDF5 file that show something else
/// are found, though every digest in the archive is right.
#[test]
fn what_an_archive_shows_is_what_its_tables_hold() {
    let desk = archived("quick.yaml", &[]);
    let whole = entries(&desk.path("a.zip"));
    let said = |change: &dyn Fn(&mut Vec<u8>), file: &str, code: i32| {
        let mut entries = whole.clone();
        let name = format!("results/quick/{file}");
        let bytes = entries.get_mut(&name).unwrap();
        change(bytes);
        let new = digest(bytes);
        // All that vouches for it is made to.
        let mut manifest: Manifest = serde_json::from_slice(&entries["results/quick/manifest.json"]).unwrap();
        for record in manifest.files.iter_mut().filter(|record| record.file == file && !record.varies) {
            record.digest = Some(new.clone());
        }
        let text = serde_json::to_vec(&manifest).unwrap();
        let mut index = Index::parse(&entries[&format!("results/quick/{INDEX}")]).unwrap();
        index.manifest = digest(&text);
        index.files.iter_mut().filter(|seen| seen.file == file).for_each(|seen| seen.digest.clone_from(&new));
        entries.insert(format!("results/quick/{INDEX}"), index.bytes().unwrap());
        entries.insert("results/quick/manifest.json".to_owned(), text);
        assert!(entries.contains_key(METADATA));
        fs::write(desk.path("b.zip"), packed(entries)).unwrap();
        desk.run(&["verify", "b.zip"], code)
    };
    let other = |from: &'static str, to: &'static str| {
        move |bytes: &mut Vec<u8>| {
            let text = String::from_utf8(bytes.clone()).unwrap();
            assert!(text.contains(from));
            *bytes = text.replacen(from, to, 1).into_bytes();
        }
    };
    for (file, change) in [
        ("report.html", other("holds", "fails")),
        ("figures/torque.svg", other("<svg", "<svg data-x='1'")),
        ("figures/torque.vl.json", other("Torque", "Force")),
    ] {
        let (out, error) = said(&change, file, 4);
        assert!(out.contains(&format!("{file}: different: it is not what its tables show")), "{out}");
        assert!(error.contains("1 of 8 other files are not what the tables hold"), "{error}");
    }
    // As another version of libhdf5 might write it: tables in another order. Then one number is another.
    let hdf5 = |by: f64| {
        let whole = &whole;
        move |bytes: &mut Vec<u8>| {
            let mut writer = Writer::new("other.h5").unwrap();
            let tables = whole.iter().rev().filter_map(|(name, bytes)| {
                let stage = name.strip_prefix("results/quick/")?.strip_suffix(".parquet")?.split('.').next()?;
                Some((stage, parquet::read(bytes.clone()).unwrap()))
            });
            for (stage, table) in tables {
                let mut columns = table.columns().to_vec();
                if (stage, table.name()) == ("stiffness", "curve")
                    && let Some(Data::Float(values)) = columns.last_mut()
                {
                    values[0] += by;
                }
                writer.add(stage, &Table::from_columns(table.schema().clone(), columns).unwrap()).unwrap();
            }
            *bytes = writer.finish(<[u8]>::to_vec).unwrap();
        }
    };
    let (out, _) = said(&hdf5(0.0), "quick.h5", 0);
    assert!(out.contains("quick.h5: otherwise: the same tables"), "{out}");
    let (out, _) = said(&hdf5(1.0), "quick.h5", 4);
    assert!(out.contains("quick.h5: different: it does not hold the table `stiffness.curve`"), "{out}");
}

/// Rounds in which two versions of a study take turns. Each publishes its own; what readers see is whole.
const ROUNDS: usize = 12;

#[test]
fn two_versions_of_a_study_in_one_folder_never_look_damaged() {
    let desk = Desk::with("quick.yaml");
    // Another file of the name would be refused; the same one may have settings.
    let one = ["quick.yaml"];
    let two = ["quick.yaml", "--set", "ste.torque.count=7", "--name", "quick"];
    for version in [&one[..], &two] {
        desk.run(&[&["run", "--quiet"], version].concat(), 0);
    }
    let start = |words: &[&str]| -> Child {
        let mut command = Command::new(env!("CARGO_BIN_EXE_gearstudy"));
        command.current_dir(desk.path("")).env_remove("GEARSTUDY_CACHE").args(words);
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
    };
    let ended = |child: Child, what: &str| {
        let output = child.wait_with_output().unwrap();
        let said = [&output.stdout[..], &output.stderr[..]].map(String::from_utf8_lossy).concat();
        let bad = ["damaged", "not as", "not what", "other bytes", "other values", "cannot read"];
        assert!(!bad.iter().any(|word| said.contains(word)), "{what}: {said}");
        output.status.code().unwrap_or(-1)
    };
    let report = [&["report"][..], &two].concat();
    let done = AtomicBool::new(false);
    std::thread::scope(|scope| {
        for words in [
            &["status", "quick.yaml"][..],
            &["table", "quick.yaml", "ste.summary"],
            &["diff", "results", "results"],
            &report,
        ] {
            let (done, start, ended) = (&done, &start, &ended);
            scope.spawn(move || {
                while !done.load(Ordering::Relaxed) {
                    assert_eq!(ended(start(words), &words.join(" ")), 0, "{words:?}");
                }
            });
        }
        let all = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            for round in 0..ROUNDS {
                let children = [&one[..], &two].map(|version| start(&[&["run"], version].concat()));
                for child in children {
                    assert_eq!(ended(child, &format!("round {round}")), 0, "round {round}");
                }
            }
        }));
        done.store(true, Ordering::Relaxed);
        all.unwrap();
    });
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    assert!(desk.run(&["status", "--check", "quick.yaml"], 0).0.starts_with("quick: up to date\n"));
}
