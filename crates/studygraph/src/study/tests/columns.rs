//! CSV files as fields: what their lines say, and where what is wrong with them stands.

use crate::study::columns::fields;
use crate::study::conditions::file_and_conditions;
use crate::study::document::{Content, Node};

/// `name: value`, lists between brackets.
fn said(text: &str) -> Vec<String> {
    let shown = |node: &Node| match &node.content {
        Content::Scalar { text, .. } => text.clone(),
        Content::Sequence(items) => format!("{:?}", items.iter().map(Node::describe).collect::<Vec<_>>()),
        Content::Mapping(_) => "a mapping".to_owned(),
    };
    fields(text, &[]).unwrap().0.iter().map(|pair| format!("{}: {}", pair.key, shown(&pair.node))).collect()
}

/// Line, column and what is said.
fn refused(text: &str) -> String {
    let found = fields(text, &[]).unwrap_err();
    let place = found.place.unwrap();
    format!("{}:{}: {}", place.line, place.column, found.message)
}

#[test]
fn columns_are_lists_and_first_lines_are_values() {
    let points = ["x: [\"`4 mm`\", \"`8.5 mm`\"]", "y: [\"`-1 um`\", \"`2e-1 um`\"]"];
    assert_eq!(said("x [mm], y [um]\n4,-1\n8.5,2e-1\n"), points);
    // Semicolons and tabs leave the comma to numbers; spaces, empty lines, comments and quotes say nothing.
    assert_eq!(said("x [mm]; y [um]\n\n 4 ;-1\n# half way\n8,5;2e-1"), points);
    assert_eq!(said("\"x [mm]\"\ty [um]\n4\t\"-1\"\n8,5\t2e-1"), points);
    assert_eq!(said("# z: 19\n# Machine: P 40\n#\nx [-]\n1\n")[..], ["z: 19", "x: [\"`1`\"]"]);
    assert_eq!(said("x [mm]; y [um]\n4;-1;\n8.5;2e-1;\n"), points);
    // Columns of one name follow each other.
    assert_eq!(
        said("# at: [1 mm, 2 mm]\ny [um], y [um]\n1,3\n2,4\n")[1],
        "y: [\"`1 um`\", \"`2 um`\", \"`3 um`\", \"`4 um`\"]"
    );
}

#[test]
fn a_list_stands_at_the_last_column_of_its_name() {
    let (pairs, header) = fields("# one: 1\nx [mm], x [mm], y [um]\n4,5,-1\n", &[]).unwrap();
    let at = |name: &str| {
        pairs.iter().find(|pair| pair.key == name).map(|pair| (pair.node.place.line, pair.node.place.column))
    };
    assert_eq!((at("x"), at("y")), (Some((2, 9)), Some((2, 17))));
    assert_eq!((header.line, header.column), (2, 1));
}

#[test]
fn what_is_no_table_is_refused_at_its_line() {
    assert_eq!(refused(""), "1:1: this file has no columns");
    assert_eq!(refused("4,1\n"), "1:1: `4` stands where the name of a column is expected");
    assert_eq!(refused("x [mm],\n4,1\n"), "1:8: a column has no name");
    assert_eq!(refused("x [mm], y\n"), "1:9: the column `y` has no unit");
    assert_eq!(refused("x [mm], y [my]\n"), "1:9: unknown unit `my` of the column `y`");
    assert_eq!(refused("x [mm], y [um]\n4,1\n\n8\n"), "4:1: this line has 1 value, and there are 2 columns");
    assert_eq!(refused("x [mm], y [um]\n4,1,-3,5\n"), "2:1: this line has 4 values, and there are 2 columns");
    assert_eq!(refused("x [mm]; y [um]\n4; \n"), "2:3: a value of `y` is missing");
    assert_eq!(refused("# x: 4\nx [mm]\n4\n"), "2:1: `x` stands here a second time");
    assert_eq!(refused("# x: [4 mm]\nx [mm]\n4\n"), "2:1: `x` stands here a second time");
    assert_eq!(refused("# z:\nx [mm]\n4\n"), "1:3: `z` has no value");
    assert_eq!(refused("# z: [1\nx [mm]\n4\n"), "1:6: `[` is opened and never closed");
}

/// A number with a comma that parts thousands would be a thousandth of what was measured.
#[test]
fn a_file_has_one_sign_before_decimals() {
    let mixed = "x [mm]; y [nm]\n16.263;-531\n17.171;-1,570\n";
    assert_eq!(refused(mixed), "3:8: `-1,570` has a comma, and a number in line 2 a point");
    assert_eq!(
        refused("x [mm]; y [um]\n15,1274;-1.259\n"),
        "2:9: `-1.259` has a point, and a number in line 2 a comma"
    );
    let thousands = "x [mm]; y [nm]\n16;-531\n17;-1,570\n";
    assert_eq!(refused(thousands), "3:4: the comma of `-1,570` seems to part thousands, as it is a decimal comma here");
    // Decimals of other counts, whole numbers beyond 999, and small ones among three decimals say that it does not.
    for column in ["531\n1,570\n2,5\n", "1531\n1,570\n", "0\n-1,570\n", "531\n0,570\n"] {
        fields(&format!("x [mm];y [mm]\n{}", column.replace('\n', ";1\n")), &[]).unwrap();
    }
}

/// `name: value`, and lists between brackets, of the lines that meet a condition.
fn of(text: &str, conditions: &str) -> Vec<String> {
    let (_, conditions) = file_and_conditions(conditions).unwrap();
    let shown = |node: &Node| match &node.content {
        Content::Sequence(items) => items.iter().map(Node::describe).collect::<Vec<_>>().join(" "),
        _ => node.describe(),
    };
    match fields(text, &conditions) {
        Ok((pairs, _)) => pairs.iter().map(|pair| format!("{}: {}", pair.key, shown(&pair.node))).collect(),
        Err(found) => {
            let place = found.place.unwrap();
            vec![format!("{}:{}: {}; {}", place.line, place.column, found.message, found.help.unwrap_or_default())]
        }
    }
}

#[test]
fn marks_of_missing_values_are_named_and_left_out_on_request() {
    for mark in
        ["", "NaN", "nan", "-", "--", "---", "n/a", "N/A", "#N/A", "*", "***", "?", "null", "9999", "-9999", "99999.00"]
    {
        let text = format!("x [mm]; y [um]\n4;-1\n5;{mark}\n6;-3\n");
        let [said] = &of(&text, "a.csv")[..] else { panic!("{mark}") };
        let written = if mark.is_empty() { "\"\"" } else { mark };
        let remedy = format!(
            "leave out the line, or write `# missing: {written}` above the columns to leave out every such line"
        );
        assert!(said.starts_with("3:3: ") && said.ends_with(&remedy), "{mark}: {said}");
        let asked = format!("# missing: {written}\n{text}");
        assert_eq!(of(&asked, "a.csv"), ["x: `4 mm` `6 mm`", "y: `-1 um` `-3 um`"], "{mark}");
    }
    let several = "# missing: [---, NaN, 9999]\nx [mm], y [um]\n4, -1\n5, ---\n6, nan\n7, 9999.0\n8, -2\n";
    assert_eq!(of(several, "a.csv"), ["x: `4 mm` `8 mm`", "y: `-1 um` `-2 um`"]);
    // Marks that are numbers are compared as numbers, with a decimal point or a decimal comma.
    for (mark, written) in [
        ("-999,9", "-999,9"),
        ("-999,9", "-999,90"),
        ("\"-999,9\"", "-999,9"),
        ("-999.9", "-999,9"),
        ("-999", "-999,0"),
        ("-999", "-999,000"),
        ("-999,0", "-999"),
        ("-9,99e2", "-999"),
        ("NaN,-999,9", "-999,9"),
        ("[NaN, -999,9]", "-999,9"),
    ] {
        let text = format!("# missing: {mark}\nx [mm]; y [um]\n9;-1,5\n5;{written}\n6;9,0\n");
        assert_eq!(of(&text, "a.csv"), ["x: `9 mm` `6 mm`", "y: `-1.5 um` `9.0 um`"], "{mark} {written}");
    }
    for (mark, written) in [("-999", "-999.0"), ("-999.0", "-999"), ("NaN, -999", "-999.00")] {
        let text = format!("# Missing: {mark}\nx [mm], y [um]\n9,-1.5\n5,{written}\n6,9.0\n");
        assert_eq!(of(&text, "a.csv"), ["x: `9 mm` `6 mm`", "y: `-1.5 um` `9.0 um`"], "{mark} {written}");
    }
    // Of two lines with marks both count.
    assert_eq!(of("# missing: NaN\n# missing: -999\nx [mm]\n1\nNaN\n-999\n", "a.csv"), ["x: `1 mm`"]);
    assert_eq!(
        of("# missing: -999,9\nx [mm], y [um]\n4,-1\n5,9\n", "a.csv"),
        ["1:12: `-999,9` can be read as one mark and as two; write a space behind a comma between two marks, and a \
          decimal point in a number"]
    );
    assert!(of("x [mm]\n-9999.9\n", "a.csv")[0].contains("stands for a missing value"));
    // What is a number stays one.
    assert_eq!(
        of("x [mm]\n999\n9998\n-0.5\n.5\n99.99\n", "a.csv"),
        ["x: `999 mm` `9998 mm` `-0.5 mm` `.5 mm` `99.99 mm`"]
    );
}

/// What programs print for a number that is none: spreadsheets in two languages, C libraries of Windows and others, tables of words.
#[test]
fn marks_of_other_programs_are_known() {
    for mark in [
        "N.A.",
        "n.a",
        "n. a.",
        "n.d.",
        "nd",
        "k.A.",
        "#NV",
        "#WERT!",
        "#VALUE!",
        "#DIV/0!",
        "#ZAHL!",
        "#NUM!",
        "#NULL!",
        "#REF!",
        "1.#QNAN",
        "1.#QNAN0",
        "1.#IND",
        "-1.#IND",
        "-1.#IND00",
        "1.#SNAN",
        "1.#INF",
        "-1.#INF",
        "1,#QNAN",
        "-1,#IND",
        "nan(ind)",
        "-nan(ind)",
        "nan(snan)",
        "NaN(0x8000)",
        "+nan",
        "-NaN",
        "inf",
        "-inf",
        "Infinity",
        "<NA>",
        "(null)",
        "missing",
        "void",
        "empty",
        "invalid",
        "error",
        "ovf",
        "overflow",
    ] {
        let text = format!("x [mm]; y [um]\n4;-1\n1;7\n5;{mark}\n6;-3\n");
        let said = of(&text, "a.csv").concat();
        assert!(said.starts_with(&format!("4:3: `{mark}` stands for a missing value of `y`")), "{mark}: {said}");
        let asked = format!("# missing: {mark}\n{text}");
        assert_eq!(of(&asked, "a.csv"), ["x: `4 mm` `1 mm` `6 mm`", "y: `-1 um` `7 um` `-3 um`"], "{mark}");
    }
    // A line that begins with one is no comment.
    for mark in ["#N/A", "#NV", "#DIV/0!"] {
        let said = of(&format!("x [mm], y [um]\n4,-1\n{mark},7\n"), "a.csv").concat();
        assert!(said.starts_with(&format!("3:1: `{mark}` stands for a missing value of `x`")), "{said}");
    }
    assert_eq!(
        of("x [mm], y [um]\n4,-1\n# N/A, see the protocol\n#no value, too\n", "a.csv"),
        ["x: `4 mm`", "y: `-1 um`"]
    );
    assert!(of("x [mm]\nnano\n", "a.csv")[0].starts_with("x: `nano mm`"));
}

#[test]
fn one_of_several_teeth_is_chosen_or_all_are_averaged() {
    let text = "tooth; x [mm]; y [um]\n1; 4; -1\n1; 5; -2\n6; 4; -3\n6; 5; -5\n";
    assert_eq!(of(text, "a.csv[tooth=6]"), ["x: `4 mm` `5 mm`", "y: `-3 um` `-5 um`"]);
    assert_eq!(of(text, "a.csv[ tooth = 1.0 ]"), ["x: `4 mm` `5 mm`", "y: `-1 um` `-2 um`"]);
    assert_eq!(of(text, "a.csv[tooth=mean]"), ["x: `4 mm` `5 mm`", "y: `-2 um` `-3.5 um`"]);
    // Lines of teeth may take turns, and other columns can be named too.
    let flanks = "flank, tooth [-], x [mm]\nleft,1,4\nright,1,5\nleft,2,6\nright,2,7\n";
    assert_eq!(of(flanks, "a.csv[tooth=2, flank=Right]"), ["x: `7 mm`"]);
    assert_eq!(of("tooth, x [mm]\n3,4\n3,5\n", "a.csv"), ["x: `4 mm` `5 mm`"]);
    for (text, name, expected) in [
        (
            text,
            "a.csv",
            "1:1: this file has several teeth: `1`, `6`; name one behind the file, `\"NAME.csv[tooth=1]\"`",
        ),
        (text, "a.csv[tooth=7]", "1:1: no line has `7` in the column `tooth`; there are `1`, `6`"),
        (text, "a.csv[gear=7]", "1:1: there is no column `gear`"),
        ("tooth, x [mm]\n1,4\n1,5\n2,4\n", "a.csv[tooth=mean]", "1:1: `1` has 2 lines, and `2` has 1"),
        (
            "tooth, x [mm], d [um]\n1,4,1\n1,5,1\n2,6,1\n2,9,1\n",
            "a.csv[tooth=mean]",
            "1:8: the places in `x` are not the same",
        ),
        (
            flanks,
            "a.csv[tooth=1]",
            "1:1: the column `flank` is no field; name the lines that count behind the file, `\"NAME.csv[flank=left]\"`",
        ),
        ("Zahn-Nr; x [mm]\n1; 4\n", "a.csv", "1:1: the column `Zahn-Nr` is no field; call the column `tooth`"),
        ("Flanke [-]; x [mm]\n1; 4\n", "a.csv", "1:1: the column `Flanke` is no field; name the lines"),
    ] {
        let said = of(text, name);
        assert!(said[0].starts_with(expected), "{name}: {said:?}");
    }
    // Letters may be large or small in names of columns, as in values.
    for name in ["Tooth", "TOOTH", "tooth"] {
        let text = text.replace("tooth", name);
        assert_eq!(of(&text, "a.csv[tooth=6]"), ["x: `4 mm` `5 mm`", "y: `-3 um` `-5 um`"], "{name}");
        assert!(of(&text, "a.csv")[0].starts_with("1:1: this file has several teeth"), "{name}");
    }
    let german = "Zahn; Flanke; x [mm]\n1; Links; 4\n1; Rechts; 5\n2; Links; 6\n";
    assert_eq!(of(german, "a.csv[zahn=1, Flanke=rechts]"), ["x: `5 mm`"]);
    for wrong in ["a.csv[tooth]", "a.csv[]", "a.csv[=3]", "a.csv[tooth=]", "a.csv[tooth=mean, Tooth=2]"] {
        assert!(file_and_conditions(wrong).is_err(), "{wrong}");
    }
}

#[test]
fn marks_of_a_merge_are_named() {
    let text = "x [mm]\n<<<<<<< HEAD\n4\n=======\n5\n>>>>>>> other\n";
    assert_eq!(refused(text), "2:1: a merge left both versions from line 2 to 6; keep one");
}
