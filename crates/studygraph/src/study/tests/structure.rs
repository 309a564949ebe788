//! Lines and brackets that do not fit together; several mistakes at once; what others call a field.

use super::{VALID, changed, each_is_refused, load, refused};

const SPACE: &str = "a space is missing behind the `:` of `module:3 mm`\n  help: write `module: 3 mm`";

#[test]
fn structure_is_told_in_the_words_of_whoever_wrote_it() {
    each_is_refused(&[
        (
            "    module: 3 mm\n",
            "   module: 3 mm\n",
            "8:4: `module: 3 mm` is indented by 3 spaces, which no line above it that it could belong to is\n  help: indent it by 2 or 4 spaces",
        ),
        (
            "    module: 3 mm\n",
            "      module: 3 mm\n",
            "8:7: `module: 3 mm` is indented further than `kind` above it, which has its value already\n  help: indent it by 4 spaces, as `kind`",
        ),
        (
            "kind: geometry",
            "kind geometry",
            "7:5: `kind geometry` has no `:` between a name and its value\n  help: write `kind: geometry`",
        ),
        (
            "kind: geometry",
            "kind = geometry",
            "7:5: `kind = geometry` has no `:` between a name and its value\n  help: write `kind: geometry`",
        ),
        (
            "    module: 3 mm\n",
            " module: 3 mm\n",
            "8:2: `module: 3 mm` is indented by 1 space, which no line above it that it could belong to is\n  help: indent it by 0 or 2 spaces",
        ),
        ("module: 3 mm", "module:3 mm", &format!("8:5: {SPACE}")),
        (
            "face_width: 20 mm }",
            "face_width: 20 mm",
            "11:12: `{` is opened in line 10 and not closed here\n  help: close it with `}`, or put a comma between its items",
        ),
        (
            "        - nothing\n",
            "        nothing: 1\n",
            "19:9: `nothing: 1` has no dash, and stands in a list\n  help: write `- nothing: 1` for another item, or indent it by 10 spaces if it belongs to the item in line 18",
        ),
        (
            "        - tip_relief: { amount: 7.81 um }\n",
            "        tip_relief: { amount: 7.81 um }\n",
            "18:9: `tip_relief: { amount: 7.81 um }` has no dash, and the list that begins with it goes on in line 19\n  help: write `- tip_relief: { amount: 7.81 um }`",
        ),
        (
            "        - tip_relief: { amount: 7.81 um }\n",
            "          tip_relief:\n            amount: 7.81 um\n",
            "18:11: `tip_relief:` has no dash, and the list that begins with it goes on in line 20\n  help: write `- tip_relief:`",
        ),
        (
            "        - nothing\n",
            "       - nothing\n",
            "19:8: `- nothing` is indented by 7 spaces, which no line above it that it could belong to is\n  help: indent it by 6 or 8 spaces",
        ),
        (
            "title: A small study",
            "title: A study: small",
            "2:1: a second `:` stands in the value of `title`\n  help: put the text in quotes: `title: \"A study: small of 5 µm\"`",
        ),
        ("title: A small", "title: \"A small", "2:8: a quote is opened and not closed in its line"),
        (
            "    module: 3 mm\n    rack",
            "    module:3mm\n    rack",
            "8:5: a space is missing behind the `:` of `module:3mm`\n  help: write `module: 3mm`",
        ),
        ("tables: [1, 2]", "tables: [1, 2]]", "3:9: `{` is opened here and closed by `]`"),
    ]);
}

#[test]
fn all_mistakes_that_can_be_told_by_themselves_are_told_at_once_in_the_order_of_the_text() {
    let text = changed("module: 3 mm", "modul: 3 mm\n    extra: 1");
    let text =
        text.replace("teeth: 19, face_width: 20 mm", "teeth: many, face_width: 20").replace("count: 16", "count: 0");
    let lines: Vec<String> = refused(&text).lines().filter(|line| !line.starts_with(' ')).map(str::to_owned).collect();
    let starts = ["t.yaml:8:5: unknown", "t.yaml:9:5: unknown", "t.yaml:11:22: ", "t.yaml:11:40: ", "t.yaml:31:"];
    assert_eq!(lines.len(), starts.len(), "{lines:#?}");
    for (line, start) in lines.iter().zip(starts) {
        assert!(line.starts_with(start), "{line:?} is not {start:?}");
    }
    // What stands there under another name is not missing as well.
    assert!(!lines.iter().any(|line| line.contains("has no `module`")));
    let many: Vec<String> = (0..14).map(|index| format!("    extra{index}: 1\n")).collect();
    let many = many.concat();
    let error = load(&VALID.replacen("    module: 3 mm\n", &format!("    module: 3 mm\n{many}"), 1)).err().unwrap();
    assert_eq!(error.each().count(), 14);
    assert_eq!(error.clone().in_full().to_string().matches("unknown field").count(), 14);
    assert!(error.to_string().ends_with("\nt.yaml: and 4 more; `gearstudy check` tells all"), "{error}");
}

/// What stands as deep as the stages and is a field of the one above it; what has no space or brace, so that it is a name.
#[test]
fn a_field_that_is_no_field_where_it_stands_is_told_as_what_it_was_meant_for() {
    let is_said = |text: &str, said: &str| assert!(refused(text).contains(said), "{}", refused(text));
    let dedented = "study: t\nstages:\n  one:\n    kind: geometry\n  pinion: { teeth: 19 }\n  bolts: 6\n";
    for (line, field) in [(5, "pinion"), (6, "bolts")] {
        is_said(
            dedented,
            &format!(
                "t.yaml:{line}:3: `{field}` stands among the stages, and is a field of `one` above it\n  help: indent it as deep as \
                 the other fields of `one`"
            ),
        );
    }
    let space = "unknown field `teeth:19` of `pinion`\n  help: a space is missing behind the `:`; write `teeth: 19`";
    is_said(&changed("teeth: 19, face_width: 20 mm", "teeth:19, face_width: 20 mm"), space);
    let brace = "a `{` is missing in the value of `pinion`\n  help: write `pinion: { teeth: 19, face_width: 20 mm }`";
    is_said(&changed("{ teeth: 19, face_width: 20 mm }", "teeth: 19, face_width: 20 mm }"), brace);
}

/// A list that goes on without its dash, a stage that stands as deep as the fields of the one before.
#[test]
fn a_name_that_stands_twice_may_have_another_cause() {
    let text = "study: t\nstages:\n  one:\n    kind: export\n    figures:\n      - name: a\n        table: x\n        name: b\n";
    let help = "8:9: `name` stands here a second time\n  help: the first is in line 6; write `- name: b` for another item of the list";
    assert!(refused(text).contains(help), "{}", refused(text));
    let text = "study: t\nstages:\n  one:\n    kind: geometry\n    two:\n    kind: export\n";
    let help = "6:5: `kind` stands here a second time\n  help: the first is in line 4; `two` in line 5 is indented as deep as what \
                follows it: indent it less, or what belongs to it further";
    assert!(refused(text).contains(help), "{}", refused(text));
    let text = "study: t\nstudy: u\n";
    assert!(
        refused(text)
            .contains("2:1: `study` stands here a second time\n  help: the first is in line 1; keep one of them")
    );
}

#[test]
fn words_of_others_lead_to_the_field() {
    each_is_refused(&[
        ("teeth: 19", "z: 19", "10:15: unknown field `z` of `pinion`\n  help: here it is called `teeth`"),
        (
            "teeth: 19",
            "Diameter: 57 mm",
            "10:15: unknown field `Diameter` of `pinion`\n  help: here it is called `teeth`: a length over the module",
        ),
        (
            "teeth: 19",
            "teeth: 19, helix_angle: 3 deg",
            "10:26: unknown field `helix_angle` of `pinion`\n  help: spur gears only",
        ),
        (
            "module: 3 mm",
            "module: 3 mm\n    z: 19",
            "9:5: unknown field `z` of `pair`\n  help: a study calls it `teeth`, in `pinion`; known here: `kind`, `module`, `pressure_angle`, `rack`, `youngs_modulus`, `pinion`, `overlap`, `ground`, `side`, `note`, `bolts`",
        ),
        // Not at the top of a study, where there are no fields of stages.
        (
            "seed: 7",
            "bore_diameter: 7",
            "4:1: unknown field `bore_diameter` of the study\n  help: known here: `stages`, `set`, `files`, `study`, `title`, `source`, `seed`, `tolerances`",
        ),
        (
            "amount: 7.81 um",
            "amount: 0,00781 mm",
            "18:33: `0,00781 mm` is two values to YAML: a decimal point, not a comma, and nothing parts thousands\n  help: write `0.00781 mm`",
        ),
        (
            "amount: 7.81 um",
            "amount: 7,810 nm",
            "18:33: `7,810 nm` is two values to YAML: a decimal point, not a comma, and nothing parts thousands\n  help: write `7810 nm`, or `7.810 nm` if the comma is a decimal one",
        ),
        (
            "amount: 7.81 um",
            "amount: 7,810,000 pm",
            "18:33: `7,810,000 pm` is several values to YAML: a decimal point, not a comma, and nothing parts thousands\n  help: write `7810000 pm`",
        ),
    ]);
}
