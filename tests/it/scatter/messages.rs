//! What is refused, with its place and the nearest name.

use super::*;
use gearstudy::program;
use std::path::Path;

fn message(text: &str) -> String {
    program::load_text(text, Path::new("t.yaml")).map_or_else(|error| error.to_string(), |_| "accepted".to_owned())
}

#[test]
fn wrong_scatters_say_where_and_what_is_near() {
    let of = |vary: &[&str], rest: &str| message(&scattered(vary, &format!("outputs: [mean]\n{rest}")));
    let amount = |how: &str| {
        let column = AMOUNT.replace("within: ± 2 um", how);
        of(&[&column], "")
    };
    let correlated = |between: &str| of(&[AMOUNT, TILT], &format!("correlations: [{between}]"));
    let third = "third: { field: ste.pinion_profile_slope, normal: 1 um }";
    let mut faults = Vec::new();
    for (found, expected) in [
        (of(&[AMOUNT, TILT, TORQUES], ""), "accepted"),
        (amount("within: +- 2 um"), "accepted"),
        (amount("within: 2 um, shape: triangular"), "accepted"),
        (amount("normal: 1 um, from: 0 um"), "accepted"),
        (amount("from: 0 um, mode: 2 um, to: 9 um"), "accepted"),
        (amount("within: ± 9 um"), "would lie between −1 um and 17 um"),
        (amount("normal: 4 um"), "cut it off with `from` and `to`"),
        (amount("from: 0 um, to: 9 m"), "must be"),
        (amount("within: ± 2"), "has no unit"),
        (amount("within: ± 2 N"), "a force"),
        (amount("within: ± 0 um"), "would not vary"),
        (amount("within: -2 um"), "must be"),
        (amount("within: ± 2 um, shape: squre"), "no shape of a tolerance"),
        (amount("within: ± 2 um, normal: 1 um"), "has both `within` and `normal`"),
        (amount("within: ± 2 um, from: 1 um"), "has its own limits"),
        (amount("mode: 2 um"), "needs `from` and `to`"),
        (amount("from: 3 um, mode: 2 um, to: 9 um"), "`mode` lies between"),
        (amount("normal: 1 um, mode: 2 um"), "has both"),
        (amount("shape: normal"), "does not say how it is distributed"),
        (amount("iso1328: 7"), "has no tolerance in ISO 1328-1"),
        (amount("values: [1 um, 2 um]"), "nothing is distributed"),
        (of(&["slope: { field: ste.pinion_profile_slope, iso1328: 12 }"], ""), "class 12"),
        (of(&["slope: { field: ste.helix_slope, iso1328: 7 }"], ""), "has no tolerance in ISO 1328-1"),
        (of(&["teeth: { field: pair.pinion.teeth, within: ± 2 }"], ""), "takes whole numbers"),
        (of(&["teeth: { field: pair.pinion.teeth, from: 17, to: 20 }"], ""), "takes whole numbers"),
        (
            of(&["amuont: { field: \"designs.designs.long[1].tip_relief.amuont\", within: ± 2 um }"], ""),
            "did you mean `amount`?",
        ),
        (of(&[AMOUNT], "samples: 1"), "between 16 and"),
        (of(&[AMOUNT], "samples: 2000000000"), "between 16 and"),
        (of(&[AMOUNT], "indices: 3"), "with fewer than 16"),
        (of(&[AMOUNT], "limits: [maen <= 3 um]"), "did you mean `mean`?"),
        (of(&[AMOUNT], "limits: [mean <= 3 MPa]"), "`3 MPa` is no limit of `mean`"),
        (correlated("{ between: [amount, tilt], is: 0.5 }"), "accepted"),
        (correlated("{ between: [amount, tlit], is: 0.5 }"), "did you mean `tilt`?"),
        (correlated("{ between: [amount], is: 0.5 }"), "names two columns"),
        (correlated("{ between: [amount, amount], is: 0.5 }"), "is one column"),
        (correlated("{ between: [amount, tilt], is: 1.5 }"), "between -1 and 1"),
        (correlated("{ between: [amount, tilt], is: 0.5 }, { between: [tilt, amount], is: -0.5 }"), "stated twice"),
        (
            of(
                &[AMOUNT, TILT, third],
                "correlations: [{ between: [amount, tilt], is: 0.9 }, { between: [tilt, third], is: 0.9 }, { between: [amount, third], is: -0.9 }]",
            ),
            "lies between 0.62",
        ),
        (
            message(&scattered(&[AMOUNT], "outputs: [mean]").replace("torque: 50 N m", "torque: [50 N m, 60 N m]")),
            "has several values of `torque`",
        ),
        (
            message(
                &scattered(&[AMOUNT], "outputs: [mean]")
                    .replace("torque: 50 N m", "torque: 50 N m, bearing_span: 90 mm"),
            ),
            "`bearing_span` goes with",
        ),
    ] {
        if !found.contains(expected) || (found != "accepted" && !found.starts_with("t.yaml:")) {
            faults.push(format!("{expected}: {found}"));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n\n"));
}
