//! What a fit refuses before anything runs, and where.

use std::path::Path;

use super::{BORES, PAIR, STE, STIFFNESS, fit, study};
use gearstudy::program;

fn message(stages: &[&str]) -> String {
    match program::load_text(&study(stages), Path::new("t.yaml")) {
        Ok(_) => "accepted".to_owned(),
        Err(error) => error.to_string(),
    }
}

const MEET: &str = "\n      - { cell: stiffness.summary.single_max, value: 2.738e8 N/m }";

#[test]
fn wrong_fits_say_where_and_what_is_near() {
    let of = |vary: &str, meet: &str| message(&[PAIR, STIFFNESS, &fit("stiffness", vary, meet, "")]);
    let bore = "{ bore: { field: pair.pinion.bore_radius, from: 8 mm, to: 20 mm } }";
    let met = |text: &str| of(bore, &format!("\n      - {{ {text} }}"));
    assert_eq!(of(BORES, MEET), "accepted");
    let cases = [
        (of(&bore.replace("bore_radius", "bore"), MEET), "bore_radius"),
        (of(&bore.replace("pair.pinion", "pear.pinion"), MEET), "did you mean `pair`"),
        (
            of(&bore.replace("from: 8 mm, to: 20 mm", "from: 20 mm, to: 8 mm"), MEET),
            "`to` (`8 mm`) must be above `from` (`20 mm`)",
        ),
        (
            of(&bore.replace("from: 8 mm, to: 20 mm", "values: [8 mm, 9 mm]"), MEET),
            "`bore` has no bounds to be fitted within",
        ),
        (of(&bore.replace("from: 8 mm, to: 20 mm", "normal: 1 mm"), MEET), "`bore` has no bounds to be fitted within"),
        (of(&bore.replace("from: 8 mm, to: 20 mm", "within: ± 0 mm"), MEET), "`within`"),
        (of("{ teeth: { field: pair.gear.teeth, from: 40, to: 50 } }", MEET), "whole numbers, which cannot be fitted"),
        (of("{ bore: { field: pair.gear.bore_radius, follows: 2 * bare } }", MEET), "nothing is free"),
        (of(&BORES.replace("* bore }", "* bare }"), MEET), "did you mean `bore`"),
        (of(&BORES.replace("* bore }", "< bore }"), MEET), "`follows` is a number"),
        (of(&BORES.replace("* bore }", "* bore, from: 20 mm }"), MEET), "`from` does not go with `follows`"),
        (of(&bore.replace("bore:", "largest:"), MEET), "`largest` is a column of the table `solutions`"),
        (of("{}", MEET), "`vary` is empty"),
        (of(bore, " []"), "`meet` is empty"),
        (met("cell: stiffness.summary.single_mex, value: 1 N/m"), "did you mean `single_max`"),
        (met("cell: stiffness.summery.single_max, value: 1 N/m"), "did you mean `summary`"),
        (met("cell: ste.summary.mean, value: 1.6 um"), "no cell of what is computed anew: `pair`, `stiffness`"),
        (met("cell: fit.parameters.value, value: 1"), "no cell of what is computed anew: `pair`, `stiffness`"),
        (met("cell: 3 mm, value: 1 N/m"), "`3 mm` is not a cell"),
        (met("value: 1 N/m"), "one `cell` or one `formula`"),
        (met("cell: stiffness.summary.single_max"), "`value`"),
        (met("cell: stiffness.summary.single_max, value: 3 mm"), "the published `3 mm` is a length"),
        (met("cell: stiffness.summary.single_max, value: \"1 N/m, 2 mm\""), "`2 mm` is a length"),
        (
            met("cell: stiffness.summary.single_max, value: 1 N/m, tolerance: 0 N/m"),
            "leaves no measure of a difference",
        ),
        (met("formula: 2 * a, with: { a: 3 mm }, value: 6 mm"), "has no cell in it"),
        (met("formula: a > b, with: { a: stiffness.summary.single_max, b: 1 N/m }, value: 1"), "a fit meets numbers"),
        (met("formula: a + b, with: { a: stiffness.summary.single_max, b: 1 mm }, value: 1"), "a length"),
        (
            of(
                "\n      one: { field: pair.pinion.bore_radius, from: 8 mm, to: 20 mm }\n      two: { field: pair.gear.bore_radius, from: 20 mm, to: 40 mm }",
                MEET,
            ),
            "1 value cannot determine 2 parameters",
        ),
        (message(&[PAIR, STIFFNESS, STE, &fit("fit", BORES, MEET, "")]), "`fit` is a `fit` stage"),
    ];
    for (found, wanted) in cases {
        assert!(found.contains(wanted), "`{wanted}` is not in\n{found}");
    }
    // A sweep has rows of its own.
    let sweep = format!("  sweep:\n    kind: sweep\n    of: stiffness\n    outputs: [mean]\n    vary:{BORES}\n")
        .replace("from: 8 mm, to: 20 mm", "values: [8 mm]");
    let found = message(&[PAIR, STIFFNESS, &sweep]);
    assert!(
        found.contains("follows from other columns, which `kind: fit` and `kind: limit` alone can have"),
        "{found}"
    );
}
