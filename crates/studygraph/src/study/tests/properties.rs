//! Whatever the text: no panic, soon an answer, and a place that is inside the text.

use std::path::Path;
use std::time::{Duration, Instant};

use proptest::prelude::*;

use super::{PROGRAM, VALID, load};
use crate::study::{LoadError, load as load_file, load_text};

/// Checks that the place of a message is where its line and column say, and inside the text.
fn check_place(error: &LoadError) {
    let Some(place) = error.diagnostic.place else {
        // Only a file without content has no place.
        assert!(error.diagnostic.message.contains("empty"), "{error}");
        return;
    };
    let text = &error.text;
    assert!(
        text.get(place.offset..place.offset + place.length).is_some(),
        "{place:?} in {} bytes: {error}",
        text.len()
    );
    let before = &text[..place.offset];
    let breaks = before.replace("\r\n", "\n").replace('\r', "\n");
    assert_eq!(place.line, breaks.matches('\n').count() + 1, "{error}\n{text:?}");
    let line = breaks.rfind('\n').map_or(0, |at| at + 1);
    // One byte order mark in front of a document has no width; elsewhere it is a character.
    let of_line = &breaks[line..];
    let columns =
        [of_line, of_line.strip_prefix('\u{feff}').unwrap_or(of_line), of_line.trim_start_matches('\u{feff}')]
            .map(|text| text.chars().count() + 1);
    assert!(columns.contains(&place.column), "{columns:?}: {error}\n{text:?}");
}

fn check(text: &str) {
    if let Err(error) = load(text) {
        check_place(&error);
        assert!(error.to_string().len() < 2000, "{error}");
    }
}

/// Pieces that studies are made of, and pieces that break them.
fn piece() -> impl Strategy<Value = String> {
    let pieces = [
        "study: a\n",
        "stages:\n",
        "  pair:\n",
        "    kind: geometry\n",
        "kind: ste",
        "    module: 3 mm\n",
        "- ",
        "  ",
        "\t",
        "\n",
        "\r\n",
        "\r",
        "{",
        "}",
        "[",
        "]",
        ",",
        ": ",
        "&a ",
        "*a",
        "<<: ",
        "|\n",
        ">-\n",
        "'",
        "\"",
        "# µ\n",
        "µm",
        "🦀",
        "---\n",
        "...\n",
        "!!str ",
        "%YAML 1.2\n",
        "? ",
        "3",
        "1e999",
        ".nan",
        "null",
        "~",
        "from: 1 N m",
        "count: 9",
        "\\x",
        "\u{feff}",
        "\u{85}",
        "\u{2028}",
        "@",
        "`",
    ];
    prop_oneof![3 => prop::sample::select(pieces.to_vec()).prop_map(str::to_owned), 1 => "\\PC{0,4}"]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text_gets_an_answer(text in "(?s).{0,200}") {
        check(&text);
    }

    #[test]
    fn marks_and_a_control_character_get_an_answer(marks in 0_usize..4) {
        check(&format!("{}\u{e}", "\u{feff}".repeat(marks)));
    }

    #[test]
    fn any_pieces_get_an_answer(pieces in prop::collection::vec(piece(), 0..40)) {
        check(&pieces.concat());
    }

    #[test]
    fn a_study_that_was_changed_gets_an_answer(
        changes in prop::collection::vec((0..VALID.len(), 0_usize..6, piece()), 1..4)
    ) {
        let mut text = VALID.to_owned();
        for (at, cut, new) in changes {
            let mut at = at.min(text.len());
            while !text.is_char_boundary(at) {
                at -= 1;
            }
            let mut end = (at + cut).min(text.len());
            while !text.is_char_boundary(end) {
                end += 1;
            }
            text.replace_range(at..end, &new);
        }
        check(&text);
    }

    #[test]
    fn any_bytes_in_a_file_get_an_answer(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), &bytes).unwrap();
        if let Err(error) = load_file(file.path(), &PROGRAM) {
            check_place(&error);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    /// As it is, and behind a header with which its lines are read: the place is in the table, or in the study.
    #[test]
    fn any_table_gets_an_answer(text in "[0-9a-c,;.:#\\[\\] \t\"µ\u{feff}\n\r-]{0,120}", has_header in any::<bool>()) {
        let folder = tempfile::tempdir().unwrap();
        let study = folder.path().join("t.yaml");
        std::fs::write(&study, VALID.replace("module: 3 mm", "file: t.csv\n    module: 3 mm")).unwrap();
        let header = if has_header { "teeth [mm]; note [-]\n" } else { "" };
        std::fs::write(folder.path().join("t.csv"), format!("{header}{text}")).unwrap();
        let error = load_file(&study, &PROGRAM).err().expect("it has fields that are none");
        check_place(&error);
    }
}

/// The answer to a text that was made to hurt, and how long it took.
fn hurt(what: &str, text: &str) -> String {
    let start = Instant::now();
    let answer = load_text(text, Path::new("t.yaml"), &PROGRAM);
    let took = start.elapsed();
    // Far above what it takes, far below what blows up: a guard against growth, not a measurement.
    assert!(took < Duration::from_secs(20), "{what} took {took:?}");
    let error = answer.err().expect("it is refused");
    check_place(&error);
    error.to_string()
}

fn lines(count: usize, line: impl Fn(usize) -> String) -> String {
    (0..count).map(line).collect::<Vec<_>>().concat()
}

#[test]
fn texts_that_were_made_to_hurt_get_a_short_answer() {
    let big = 1 << 20;
    let fill = |piece: &str| piece.repeat(big / piece.len());
    let study = |rest: &str| format!("study: a\nstages:\n  a: {{ kind: geometry, note: {rest} }}\n");
    let bomb = lines(39, |at| format!("a{}: &a{} [*a{at}, *a{at}, *a{at}, *a{at}]\n", at + 1, at + 1));
    let deeper = lines(39, |at| format!("a{}: &a{} [[*a{at}]]\n", at + 1, at + 1));
    let stages = lines(20_000, |at| format!("  s{at}: {{kind: report}}\n"));
    let circle = lines(7000, |at| {
        format!("  s{at}: {{kind: ste, pair: p, designs: [], torque: 1 N m, before: s{}}}\n", (at + 1) % 7000)
    });
    for (what, text, part) in [
        ("brackets", fill("["), "nested more than 64 levels"),
        ("braces", fill("{a: "), "nested more than 64 levels"),
        ("dashes", fill("- "), "nested more than 64 levels"),
        ("block", lines(1400, |at| format!("{}a:\n", " ".repeat(at))), "nested more than 64 levels"),
        ("alias bomb", format!("a0: &a0 [x, x]\n{bomb}"), "more than 100000 values"),
        ("alias depth", format!("a0: &a0 [x]\n{deeper}"), "nested more than 64 levels"),
        ("anchors", format!("{}x{}", "[".repeat(50), "]".repeat(50)).replace('[', "[&a "), "mapping"),
        ("values", format!("[{}]", fill("a,")), "more than 100000 values"),
        ("keys", lines(90_000, |at| format!("k{at}:\n")), "more than 100000"),
        ("one key", fill("a:\n"), "a second time"),
        ("long scalar", study(&fill("µ")), "has no `module`"),
        ("long number", format!("study: a\nstages: {{a: {{kind: geometry, module: {} mm}}}}", fill("1")), "too large"),
        (
            "long unit",
            format!("study: a\nstages: {{a: {{kind: geometry, module: 1 {}}}}}", fill("m^9 ")),
            "of another kind",
        ),
        ("quotes", fill("'"), ""),
        ("tabs", fill("\t"), ""),
        ("comments", fill("# a\n"), "empty"),
        ("questions", fill("? "), ""),
        ("colons", fill(": "), ""),
        (
            "stages",
            format!("study: a\nstages:\n{stages}  x: {{kind: report, cells: nobody.a.b}}\n"),
            "there is no stage `nobody`",
        ),
        (
            "circle",
            format!(
                "study: a\nstages:\n{circle}  p: {{kind: geometry, module: 3 mm, pinion: {{teeth: 19, face_width: 1 mm}}}}\n"
            ),
            "in a circle",
        ),
    ] {
        let answer = hurt(what, &text);
        assert!(answer.contains(part), "{what}: {answer}");
        assert!(answer.len() < 1000, "{what}: {answer}");
    }
}
