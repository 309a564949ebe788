//! Every text of a study against every file that is published: what cannot be held is refused at its place before anything
//! runs, and everything else comes out as it went in.

use std::fs;
use std::path::Path;

use crate::desk::Desk;
use gearstudy::program::load_text;
use studygraph::store::hdf5;

/// Stands where a text is put.
const TEXT: &str = "<TEXT>";

/// A small study with a text in every field that takes any.
const STUDY: &str = "\
study: texts
title: <TEXT>
source: { paper: <TEXT>, tables: [1] }
stages:
  pair:
    kind: geometry
    module: 3 mm
    pressure_angle: 20 deg
    pinion: { teeth: 24, face_width: 20 mm, bore_radius: 18 mm }
    gear: { teeth: 36, face_width: 20 mm, bore_radius: 28 mm }
  stiffness: { kind: stiffness, pair: pair }
  report:
    kind: report
    published:
      - label: <TEXT>
        where: <TEXT>
        cell: pair.pair.contact_ratio
        value: 1.9
        tolerance: 1 %
        expected: { value: 1.6, tolerance: 10 % }
        because: <TEXT>
        proof: { claim: computed > 1 }
        note: <TEXT>
    figures:
      - name: stiffness
        title: <TEXT>
        table: stiffness.curve
        x: cycle_position
        y: stiffness
        x_label: <TEXT>
        y_label: <TEXT>
        note: <TEXT>
        published: [{ y: 3e8 N/m, label: <TEXT> }]
";

/// What means something to one format or another, and no control character.
const ODD: &str = "=1+1 \t <b>&amp;</b> ]]> --> <!-- </script> </title> '\" \\ | `x` {{ 1 }} {% x %} µ\u{300} \u{202e}\u{2066} \
                   \u{2028}\u{feff}\u{e000}\u{10ffff}\u{1f600} $(x) %s \\0 \\u0000 &#0; ,;\nnext";

/// A text as a study may write it.
fn quoted(text: &str) -> String {
    serde_json::to_string(text).unwrap()
}

#[test]
fn a_text_with_a_character_that_some_file_cannot_hold_is_refused_in_every_field() {
    let path = Path::new("texts.yaml");
    assert!(load_text(&STUDY.replace(TEXT, "fine"), path).is_ok());
    let fields = STUDY.matches(TEXT).count();
    assert!(fields >= 10, "{fields}");
    for (written, number) in [
        ("\"a\\0b\"", "U+0000 (NUL)"),
        ("\"a\\x00b\"", "U+0000 (NUL)"),
        ("\"a\\u0000b\"", "U+0000 (NUL)"),
        ("a\0b", "U+0000 (NUL)"),
        ("'a\0b'", "U+0000 (NUL)"),
        ("\"a\\eb\"", "U+001B (escape)"),
        ("\"a\\rb\"", "U+000D (carriage return)"),
        ("\"a\\x7Fb\"", "U+007F"),
        ("\"a\\Nb\"", "U+0085"),
        ("\"a\\uFFFEb\"", "U+FFFE"),
    ] {
        // Where the character stands behind the beginning of the text.
        let inside = 1 + usize::from(written.starts_with(['"', '\'']));
        for (field, (at, _)) in STUDY.match_indices(TEXT).enumerate() {
            let before = STUDY[..at].replace(TEXT, "fine");
            let text = format!("{before}{written}{}", STUDY[at + TEXT.len()..].replace(TEXT, "fine"));
            let Err(error) = load_text(&text, path) else { panic!("{written} in field {field} was accepted") };
            let (line, column) =
                (before.matches('\n').count() + 1, before.len() - before.rfind('\n').unwrap() + inside);
            let says = format!("texts.yaml:{line}:{column}: no text of a study can hold the character {number}");
            assert!(error.to_string().starts_with(&says), "{error}, not {says}");
        }
    }
}

/// Values, names of fields, of kinds and of stages, in the message and on standard error.
#[test]
fn a_message_shows_what_cannot_be_seen_by_its_number() {
    let hidden = "\u{a0}\u{ad}\u{34f}\u{61c}\u{115f}\u{1680}\u{17b4}\u{180e}\u{2000}\u{2009}\u{200a}\u{200b}\u{200c}\u{200d}\u{200e}\
                  \u{200f}\u{2028}\u{2029}\u{202a}\u{202e}\u{202f}\u{205f}\u{2060}\u{2064}\u{2066}\u{2069}\u{206f}\u{2800}\u{3000}\
                  \u{3164}\u{fe00}\u{fe0f}\u{feff}\u{ffa0}\u{fff9}\u{110bd}\u{13430}\u{1bca0}\u{1d173}\u{e0001}\u{e0041}\u{e007f}\u{e0100}\
                  \u{e000}\u{f8ff}\u{fdd0}\u{fffc}\u{f0000}\u{10fffd}";
    let study = STUDY.replace(TEXT, "fine");
    for character in hidden.chars() {
        let number = format!("U+{:04X}", u32::from(character));
        for (place, from, to) in [
            ("a value", "module: 3 mm", format!("module: 3{character}x mm")),
            ("a quoted value", "module: 3 mm", format!("module: \"3{character}x mm\"")),
            ("a field", "pressure_angle:", format!("pressure{character}angle:")),
            ("a kind", "kind: stiffness", format!("kind: stiff{character}ness")),
            ("a stage", "pair: pair }", format!("pair: pa{character}ir }}")),
            ("a column", "y: stiffness", format!("y: stiff{character}ness")),
        ] {
            let text = study.replacen(from, &to, 1);
            assert_ne!(text, study);
            let Err(error) = load_text(&text, Path::new("texts.yaml")) else {
                panic!("{number} in {place} is accepted")
            };
            let said = error.to_string();
            assert!(said.contains(&number) && !said.contains(character), "{number} in {place}: {said:?}");
        }
    }
    let desk = Desk::with("quick.yaml");
    let (_, said) = desk.run(&["table", "quick\u{200b}.yaml"], 1);
    assert!(said.contains("quickU+200B.yaml"), "{said}");
}

#[test]
fn any_other_text_is_published_as_it_was_written() {
    let desk = Desk::with("quick.yaml");
    let values = |text: &str| STUDY.replace(TEXT, &quoted(text));
    fs::write(desk.path("texts.yaml"), values(ODD)).unwrap();
    desk.run(&["run", "texts.yaml", "--quiet"], 0);
    let results = desk.path("results/texts");

    // In the tables, and so in Parquet and the cache.
    let (json, _) = desk.run(&["table", "texts.yaml", "report.verdicts", "--format", "json"], 0);
    let rows: serde_json::Value = serde_json::from_str(&json).unwrap();
    let is_odd = |value: &serde_json::Value| value.as_str().is_some_and(|text| text == ODD);
    assert!(json_texts(&rows).filter(|value| is_odd(value)).count() >= 4, "{json}");
    let table = hdf5::read(&results.join("texts.h5"), "report", "verdicts").unwrap();
    for column in ["label", "because", "note"] {
        assert_eq!(table.texts(column)[0], ODD, "{column}");
    }
    // No cell of the CSV is a formula, and the text behind the apostrophe is whole.
    let (csv, _) = desk.run(&["table", "texts.yaml", "report.verdicts", "--format", "csv", "--columns", "label"], 0);
    assert!(csv.contains("\"'=1+1 \t"), "{csv}");
    // A figure is XML, the page has no element of the text.
    let svg = fs::read_to_string(results.join("figures/stiffness.svg")).unwrap();
    let figure = roxmltree::Document::parse(&svg).unwrap();
    assert!(figure.descendants().any(|node| node.text().is_some_and(|text| text.contains("=1+1"))));
    let page = fs::read_to_string(results.join("report.html")).unwrap();
    assert!(page.contains("=1+1") && !page.contains("<b>&amp;") && !page.contains("{{ 1 }}<"));
    assert_eq!(page.matches("<title>").count(), page.matches("</title>").count());
    // And the whole of it can be archived and made again.
    desk.run(&["archive", "texts.yaml", "-o", "texts.zip", "--author", "=Ada <a@b> \"A\" & 'B'"], 0);
    desk.run(&["verify", "texts.zip", "--quiet"], 0);
    desk.run(&["status", "texts.yaml"], 0);
}

fn json_texts(value: &serde_json::Value) -> Box<dyn Iterator<Item = &serde_json::Value> + '_> {
    match value {
        serde_json::Value::Array(items) => Box::new(items.iter().flat_map(json_texts)),
        serde_json::Value::Object(fields) => Box::new(fields.values().flat_map(json_texts)),
        other => Box::new(std::iter::once(other)),
    }
}
