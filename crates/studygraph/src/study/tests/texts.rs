//! Texts that are not a study at all, each with its whole message.

use super::refused;

/// Whole texts.
const TEXTS: &[(&str, &str)] = &[
    ("", "1:1: the file is empty\n  help: a study starts with `study: NAME` and `stages:`"),
    ("# only\n", "1:1: the file is empty\n  help: a study starts with `study: NAME` and `stages:`"),
    ("---\n", "1:1: the file is empty\n  help: a study starts with `study: NAME` and `stages:`"),
    ("~", "1:1: the file is empty\n  help: a study starts with `study: NAME` and `stages:`"),
    ("3", "1:1: a study is a mapping that starts with `study: NAME`, not `3`"),
    ("[a]", "1:1: a study is a mapping that starts with `study: NAME`, not a list"),
    (
        "study: a\nstages: []",
        "2:9: `stages` is a list; a mapping from names to stages is expected\n  help: stages are written `NAME: { kind: KIND, … }`",
    ),
    (
        "study: a\nstages: {}",
        "2:9: a study has at least one stage\n  help: stages are written `NAME: { kind: KIND, … }`",
    ),
    (
        "study: a\nstages:",
        "2:1: `stages` is nothing; a mapping from names to stages is expected\n  help: stages are written `NAME: { kind: KIND, … }`",
    ),
    ("study: a", "1:1: the study has no `stages`\n  help: stages are written `NAME: { kind: KIND, … }`"),
    ("study: a\nstages:\n\tpair: 3", "3:1: a tab stands where YAML allows only spaces\n  help: indent with spaces"),
    ("study: a\n\tb: c", "2:1: a tab stands where YAML allows only spaces\n  help: indent with spaces"),
    ("a: b: c", "1:1: a second `:` stands in the value of `a`\n  help: put the text in quotes: `a: \"b: c\"`"),
    ("a: \"b", "1:4: a quote is opened and never closed"),
    ("study: a\ntitle: \"b\n", "2:8: a quote is opened and never closed"),
    ("study: \"a\ntitle: b # c\"\nstages: {}\n", "1:8: a quote is opened and not closed in its line"),
    ("stages:\n  a:\n    kind: \"it's \\\"b\n", "3:11: a quote is opened and never closed"),
    (
        r#"a: "1 \pm 2""#,
        "1:4: a `\\` in double quotes begins an escape, and there is none of this letter\n  help: write the text in single quotes, or without any",
    ),
    ("a: [b", "1:4: `[` is opened and never closed"),
    ("a: *b", "1:4: this alias has no anchor (`&name`) before it"),
    ("a: &a [*a]", "1:8: this alias stands inside the value it stands for"),
    ("a: !!str b", "1:4: YAML tags have no meaning in a study\n  help: the type of a value follows from its field"),
    ("%YAML 1.2\n---\na: b", "1:1: YAML directives (`%…`) have no meaning in a study"),
    (
        "study: a\n---\nstudy: b\n",
        "2:1: a study is one YAML document; a second one starts here\n  help: put it into a file of its own",
    ),
    ("[a]: b", "1:1: a name is expected before the colon"),
    ("? [a]\n: b", "1:3: a name is expected before the colon"),
    (": b", "1:1: a name is missing before the colon"),
    ("a: &a b\n<<: 3\n", "2:1: `<<` merges a mapping, or a list of mappings"),
    ("µ: ä: b", "1:1: a second `:` stands in the value of `µ`\n  help: put the text in quotes: `µ: \"ä: b\"`"),
    (
        "study: µ\r\ntitle: b\r\nstages:\r\n  ä: 3",
        "1:8: `µ` cannot be the name of a study\n  help: lower-case letters, digits, `-` and `_` make a name, at most 64 of them",
    ),
    (
        "a: |\n  µ\nb: 'c\n  d'\n",
        "1:1: unknown field `a` of the study\n  help: known here: `stages`, `set`, `files`, `study`, `title`, `source`, `seed`, `tolerances`",
    ),
    (
        "study: a\nstages: {pair: {kind: geometry, module: 'µµµ\n  µ'}}",
        "2:10: `pair` has no `pinion`; a mapping with the fields `teeth`, `face_width` is expected\n  help: The driving gear.\nt.yaml:2:41: `µµµ µ` is not a number; a length (for example `3 mm`) is expected",
    ),
    (
        "\u{feff}µ: 3",
        "1:1: unknown field `µ` of the study\n  help: known here: `stages`, `set`, `files`, `study`, `title`, `source`, `seed`, `tolerances`",
    ),
    (
        "a: \0",
        "1:4: no text of a study can hold the character U+0000 (NUL)\n  help: leave it out: of control characters, files of every format hold only line breaks and tabs",
    ),
    (
        "study: a # \0\nstages: {}",
        "1:12: no text of a study can hold the character U+0000 (NUL)\n  help: leave it out: of control characters, files of every format hold only line breaks and tabs",
    ),
    (
        "µ: 'a\0b'\n",
        "1:6: no text of a study can hold the character U+0000 (NUL)\n  help: leave it out: of control characters, files of every format hold only line breaks and tabs",
    ),
    (
        "\u{feff}µ: \u{1b}[2J",
        "1:4: no text of a study can hold the character U+001B (escape)\n  help: leave it out: of control characters, files of every format hold only line breaks and tabs",
    ),
    (
        "a: |\n  b\n  c\u{c}\n",
        "3:4: no text of a study can hold the character U+000C\n  help: leave it out: of control characters, files of every format hold only line breaks and tabs",
    ),
    (
        "a: \u{85}",
        "1:4: no text of a study can hold the character U+0085\n  help: leave it out: of control characters, files of every format hold only line breaks and tabs",
    ),
    (
        "a: \u{ffff}",
        "1:4: no text of a study can hold the character U+FFFF\n  help: leave it out: of control characters, files of every format hold only line breaks and tabs",
    ),
    (
        "a: \"µ\\\\0 \\0\"",
        "1:10: no text of a study can hold the character U+0000 (NUL)\n  help: leave it out: of control characters, files of every format hold only line breaks and tabs",
    ),
    (
        "a: \"b\n  c\\x00\"",
        "2:4: no text of a study can hold the character U+0000 (NUL)\n  help: leave it out: of control characters, files of every format hold only line breaks and tabs",
    ),
    (
        "a: \"\\u0000\"",
        "1:5: no text of a study can hold the character U+0000 (NUL)\n  help: leave it out: of control characters, files of every format hold only line breaks and tabs",
    ),
    (
        "a: \"\\U00000000\"",
        "1:5: no text of a study can hold the character U+0000 (NUL)\n  help: leave it out: of control characters, files of every format hold only line breaks and tabs",
    ),
    (
        "\"\\e\": b",
        "1:2: no text of a study can hold the character U+001B (escape)\n  help: leave it out: of control characters, files of every format hold only line breaks and tabs",
    ),
    (
        "a: [b, {\"c\": \"d\\r\\n\"}]",
        "1:16: no text of a study can hold the character U+000D (carriage return)\n  help: leave it out: of control characters, files of every format hold only line breaks and tabs",
    ),
    (
        "a: @b",
        "1:4: `@` cannot stand here\n  help: put a text that holds such characters in quotes, and look at the indentation",
    ),
    (
        "a: `b",
        "1:4: ``` cannot stand here\n  help: put a text that holds such characters in quotes, and look at the indentation",
    ),
    (
        "- a\nb: c",
        "2:1: `b: c` has no dash, and stands in a list\n  help: write `- b: c` for another item, or indent it by 2 spaces if it belongs to the item in line 1",
    ),
    ("a:\n  b\n c: d", "2:3: `b` has no `:` between a name and its value\n  help: write `b: …`"),
];

#[test]
fn a_text_that_is_no_study_gets_its_message() {
    let mut wrong = Vec::new();
    for (text, expected) in TEXTS {
        let message = refused(text);
        // What else is wrong comes behind it.
        if message != format!("t.yaml:{expected}") && !message.starts_with(&format!("t.yaml:{expected}\nt.yaml:")) {
            wrong.push(format!("{text:?}\n expected {expected:?}\n but got  {message:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
