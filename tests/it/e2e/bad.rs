//! Studies that must be refused, through the program: code 2, a message for each mistake with its place, quickly, nothing written.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use crate::desk::Desk;

/// Runs a study that must be refused; what is said about it, with the name of the file in front.
fn refused(desk: &Desk, file: &str) -> String {
    let before = listing(desk);
    let began = Instant::now();
    let (out, error) = desk.run(&["run", file], 2);
    let took = began.elapsed();
    assert_eq!(out, "", "{file}: a message belongs on standard error");
    assert!(took < Duration::from_secs(1), "{file}: {took:?}");
    assert_eq!(before, listing(desk), "{file}: something was written");
    // Messages, each with its help if it has one; of several mistakes one message each.
    let mut before = "";
    for line in error.lines() {
        let is_help = line.starts_with("  help: ") && before.starts_with(&format!("{file}:"));
        assert!(is_help || line.starts_with(&format!("{file}:")), "{error}");
        before = line;
    }
    assert!(error.lines().count() >= 1, "a message");
    assert!(!error.contains("panicked") && !error.contains('\u{1b}'), "{error}");
    error
}

fn listing(desk: &Desk) -> Vec<String> {
    let mut names: Vec<_> = fs::read_dir(desk.path("."))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

/// Whether `file:line:column: ` stands in front.
fn has_place(message: &str) -> bool {
    let mut parts = message.splitn(4, ':').skip(1);
    let number = |part: Option<&str>| part.is_some_and(|text| text.parse::<u32>().is_ok_and(|number| number > 0));
    number(parts.next()) && number(parts.next())
}

#[test]
fn every_bad_study_ends_with_code_2_and_its_message_alone() {
    let desk = Desk::with("quick.yaml");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad");
    let mut count = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "yaml") {
            continue;
        }
        let name = path.file_name().unwrap().to_str().unwrap();
        fs::copy(&path, desk.path(name)).unwrap();
        let error = refused(&desk, name);
        assert!(has_place(&error), "{error}");
        assert_eq!(error, fs::read_to_string(path.with_extension("expected")).unwrap());
        count += 1;
    }
    assert!(count >= 28, "only {count} bad studies");
}

/// What only tables show: those of quick stages are there in a moment.
#[test]
fn a_check_computes_what_takes_no_time_and_says_what_does_not_fit() {
    let desk = Desk::with("quick.yaml");
    let quick = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    let checked = |changes: &[(&str, &str)]| {
        let text = changes.iter().fold(quick.clone(), |text, (old, new)| {
            assert!(text.contains(old), "{old}");
            text.replacen(old, new, 1)
        });
        fs::write(desk.path("changed.yaml"), text).unwrap();
        desk.run(&["check", "changed.yaml"], 2).1
    };
    let long = checked(&[("amount: 12 um, fraction: 0.5", "amount: 12 um, length: 22 mm")]);
    let starts =
        "changed.yaml:24:60: design `short`, tip_relief: the relief starts 22.000000 mm from the end of the flank;";
    assert!(long.starts_with(starts), "{long}");
    let whole_pairs = [
        ("method: energy, root: trochoid, contact: linear, coupling: body", "method: iso6336"),
        ("designs: [designs, optimum]", "designs: [designs, optimum]\n    slice_coupling: plate"),
    ];
    let message = checked(&whole_pairs);
    assert!(message.starts_with("changed.yaml:43:21: `ste`: `slice_coupling: plate` needs"), "{message}");
    assert!(!desk.path("results").exists() && !desk.path(".gearstudy").exists(), "nothing is written");
}

#[test]
fn what_is_no_file_of_text_has_no_line_but_a_reason() {
    let desk = Desk::with("quick.yaml");
    fs::create_dir(desk.path("folder.yaml")).unwrap();
    assert!(refused(&desk, "folder.yaml").contains("this is a directory"));
    assert!(desk.run(&["run", "quik.yaml"], 1).1.contains("did you mean `quick.yaml`?"), "a word that names nothing");
}

/// 10 MB of each shape that makes parsers slow, deep or fat.
#[test]
fn ten_megabytes_of_nesting_are_refused_at_once() {
    let desk = Desk::with("quick.yaml");
    let indented: Vec<_> = (0..4000)
        .map(|depth| {
            " ".repeat(depth)
                + "a:
"
        })
        .collect();
    for (name, text) in [
        ("brackets.yaml", "[".repeat(10_000_000)),
        ("braces.yaml", "{a: ".repeat(2_500_000)),
        ("dashes.yaml", "- ".repeat(5_000_000)),
        ("indented.yaml", indented.concat()),
    ] {
        fs::write(desk.path(name), text).unwrap();
        assert!(refused(&desk, name).contains("too large for a study"), "{name}");
    }
    // Just small enough to be read: depth is refused where it is too deep.
    for (name, text) in [
        ("brackets.yaml", "[".repeat(1 << 20)),
        ("braces.yaml", "{a: ".repeat(1 << 18)),
        ("dashes.yaml", "- ".repeat(1 << 19)),
    ] {
        fs::write(desk.path(name), text).unwrap();
        let error = refused(&desk, name);
        assert!(error.contains("levels deep") && has_place(&error), "{error}");
    }
}

/// A slip in the second study costs nothing: the first is not begun.
#[test]
fn nothing_is_run_when_one_of_several_studies_is_bad() {
    let desk = Desk::with("quick.yaml");
    fs::write(desk.path("bad.yaml"), "study: bad\nstages: {}\n").unwrap();
    let (out, error) = desk.run(&["run", "quick.yaml", "bad.yaml"], 2);
    assert!(out.is_empty() && error.starts_with("bad.yaml:2:9:"), "{out}{error}");
    assert_eq!(listing(&desk), ["bad.yaml", "quick.yaml"]);
    for command in ["check", "plan", "status", "report", "table"] {
        assert!(desk.run(&[command, "bad.yaml"], 2).1.starts_with("bad.yaml:2:9:"), "{command}");
    }
}

/// What a factor of a rating lacks is told before anything runs, with what to give and what to state.
#[test]
fn a_check_says_what_a_rating_lacks() {
    let desk = Desk::with("quick.yaml");
    let text = "study: lacking
stages:
  pair:
    kind: geometry
    module: 3 mm
    pinion: { teeth: 19, face_width: 20 mm, bore_radius: 14 mm }
    gear: { teeth: 48, face_width: 18 mm, bore_radius: 38 mm }
  rating:
    kind: rating
    pair: pair
    torque: 100 N m
    speed: 1500 rpm
    pinion: { material: case_hardened_steel }
    gear: { material: case_hardened_steel }
";
    fs::write(desk.path("lacking.yaml"), text).unwrap();
    let told = desk.run(&["check", "lacking.yaml"], 2).1;
    let expected = "K_V needs `base_pitch_deviation`: give it, or state the factor as `factors.dynamic_factor`";
    assert!(told.contains("lacking.yaml:8:3: `rating`: ") && told.contains(expected), "{told}");
}
