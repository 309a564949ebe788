//! What limits refuse before anything runs, and where.

use std::path::Path;

use super::{PAIR, limit, study};
use gearstudy::program;

fn message(vary: &str, more: &str) -> String {
    match program::load_text(&study(&[PAIR, &limit("pair", vary, more)]), Path::new("t.yaml")) {
        Ok(_) => "accepted".to_owned(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn wrong_limits_say_where_and_what_is_near() {
    let bore = "{ bore: { field: pair.pinion.bore_radius, from: 8 mm, to: 20 mm } }";
    let of = |from: &str, to: &str| message(&bore.replace(from, to), "");
    let two = |field: &str| {
        let (one, other) = (
            "bore: { field: pair.pinion.bore_radius, from: 8 mm, to: 20 mm }",
            format!("other: {{ field: {field}, from: 25 mm, to: 40 mm }}"),
        );
        message(&format!("{{ {one}, {other} }}"), "")
    };
    assert_eq!(of("", ""), "accepted");
    assert_eq!(two("pair.gear.bore_radius"), "accepted");
    let cases = [
        (of("bore_radius", "bore_radios"), "did you mean `bore_radius`"),
        (of("pair.pinion", "pear.pinion"), "did you mean `pair`"),
        (of("from: 8 mm, to: 20 mm", "from: 20 mm, to: 8 mm"), "`to` (`8 mm`) must be above `from` (`20 mm`)"),
        (of("from: 8 mm, to: 20 mm", "values: [8 mm, 9 mm]"), "`bore` has no bounds up to which it is tried"),
        (of("to: 20 mm", "to: 20 mm, count: 3"), "write `from` and `to`, without a `count`"),
        (of("from: 8 mm, to: 20 mm", "within: ± 1 mm"), "`bore` has no bounds up to which it is tried"),
        (of("from: 8 mm, to: 20 mm", "follows: 2 * bare"), "nothing is free"),
        (of("bore:", "side:"), "`side` is a column of the table `admitted`"),
        (two("pair.pinion.tip_radius"), "the study has no value of `pair.pinion.tip_radius`"),
        (message("{}", ""), "`vary` is empty"),
        (message(bore, "probes: 0"), "`probes` must be between 1 and"),
        (message(bore, "of: limit"), "`of`"),
    ];
    for (found, wanted) in cases {
        assert!(found.contains(wanted), "`{wanted}` is not in\n{found}");
    }
}
