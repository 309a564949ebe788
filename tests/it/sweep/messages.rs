//! What is refused, with its place and the nearest name.

use super::*;
use gearstudy::program;
use std::path::Path;

fn message(text: &str) -> String {
    program::load_text(text, Path::new("t.yaml")).map_or_else(|error| error.to_string(), |_| "accepted".to_owned())
}

#[test]
fn wrong_sweeps_say_where_and_what_is_near() {
    let amount = "amount: { field: \"designs.designs.long[1].tip_relief.amount\", values: [1 um, 2 um] }";
    let of = |vary: &str, rest: &str| message(&swept(&format!("vary:\n  {vary}\noutputs: [mean]\n{rest}")));
    for (found, expected) in [
        (of(amount, ""), "accepted"),
        (of(&amount.replace("tip_relief.amount", "tip_relief.amuont"), ""), "did you mean `amount`?"),
        (of(&amount.replace("long[1]", "lnog[1]"), ""), "did you mean `long`?"),
        (of(&amount.replace("[1].tip", "[0].tip"), ""), "lead_crowning"),
        (of(&amount.replace("2 um]", "2 N]"), ""), "a force"),
        (of(&amount.replace("2 um]", "2 m]"), ""), "must be"),
        (
            of("gear: { field: \"designs.designs.long[1].tip_relief.gear\", values: [1] }", ""),
            "only numbers are varied",
        ),
        (of("own: { field: sweep.best, values: [1] }", ""), "`ste` does not read `sweep`"),
        (of("Amount: { field: ste.torque, values: [1 N m] }", ""), "cannot be the name of a column"),
        (of("torque: { field: ste.torque }", ""), "needs its `values`, or `from` and `to`"),
        (of("torque: { values: [1 N m] }", ""), "does not say which `field` it varies"),
        (of("torque: { field: ste.torque, valuse: [1 N m] }", ""), "did you mean `values`?"),
        (of("torque: { field: ste.torque, from: 1 N m, to: 2 N m }", ""), "`torque` has no values of its own"),
        (of("torque: { field: ste.torque, values: [1 N m, 1 N m] }", ""), "has the value 1 N m twice"),
        (of(&amount.replace("values: [1 um, 2 um]", "within: ± 2 um"), ""), "distributions are for `kind: scatter`"),
        (of("mean: { field: ste.torque, values: [1 N m] }", ""), "two columns `mean`"),
        (of("reason: { field: ste.torque, values: [1 N m] }", ""), "a column of every table of rows"),
        (
            of(
                &format!("{amount}\n  again: {{ field: \"designs.designs.long[1].tip_relief.amount\", values: 1 um }}"),
                "",
            ),
            "cannot be varied by itself",
        ),
        (
            of(
                &format!(
                    "{amount}\n  o: {{ field: \"designs.designs.other[0].profile_crowning.amount\", values: 1 um }}"
                ),
                "",
            ),
            "is of the design",
        ),
        (of(amount, "where: \"amuont > 1\""), "did you mean `amount`?"),
        (of(amount, "where: \"amount + 1\""), "`where` is true or false"),
        (of(amount, "where: \"amount > 1\""), "do not go together"),
        (
            of(
                "torque: { field: ste.torque, values: [1 N m] }\n  width: { field: pair.gear.face_width, values: [9 mm] }",
                "",
            ),
            "a row has one design, and there are several",
        ),
        (of(amount, "minimize: maen"), "did you mean `mean`?"),
        (of(amount, "method: zip\nbest: 0"), "between 1 and 10000"),
        (
            of(&format!("{amount}\n  torque: {{ field: ste.torque, values: [1 N m] }}"), "method: zip"),
            "takes as many of each",
        ),
        (of("count: { field: ste.positions, from: 8, to: 11, count: 3 }", ""), "takes whole numbers"),
        (message(&swept(&format!("vary:\n  {amount}\noutputs: [maen]"))), "did you mean `mean`?"),
        (message(&swept(&format!("vary:\n  {amount}\noutputs: [\"cost.seconds\"]"))), "differs from run to run"),
        (
            message(
                &swept(&format!("vary:\n  {amount}\noutputs: [mean]"))
                    .replace("torque: 50 N m", "torque: [50 N m, 60 N m]"),
            ),
            "has several values of `torque`",
        ),
    ] {
        assert!(found.contains(expected), "{expected}: {found}");
        assert!(found == "accepted" || found.starts_with("t.yaml:"), "{found}");
    }
}
