//! Printed tables: what their rows stand for, and what is wrong with them.

use super::super::stated::PrintedRow;
use super::*;

const SHORT: &str = "ste.summary[design=iso, torque=50 N m]";
const LONG: &str = "ste.summary[design=iso, torque=100 N m]";

fn row(fields: Fields) -> Value {
    group::<PrintedRow>(fields)
}

fn texts(each: &[&str]) -> Value {
    list(each.iter().map(|one| text(one)).collect())
}

/// A list for each name.
fn names(pairs: &[(&str, &[&str])]) -> Value {
    Value::Map(pairs.iter().map(|(name, values)| ((*name).to_owned(), item(texts(values)))).collect())
}

fn report(table: &[(&'static str, Value)], rows: Vec<Value>, shared: &[(&str, &str)]) -> Record {
    let fields: Vec<_> = table.iter().cloned().chain([("rows", list(rows))]).collect();
    let table = group::<PrintedTable>(&fields);
    let fields = vec![("printout", item(list(vec![table]))), ("let", item(map(shared)))];
    Record { fields, place: Place::default() }
}

/// What is wrong with a report of one table, with lines.
fn wrong(table: &[(&'static str, Value)], rows: Vec<Value>, shared: &[(&str, &str)]) -> Vec<String> {
    let stage = build(&report(table, rows, shared)).unwrap();
    stage.wrong().iter().map(|wrong| format!("{}: {}", wrong.place.unwrap().line, wrong.message)).collect()
}

/// A printed table is the entries that it stands for, and what all formulas know is said once.
#[test]
fn a_printed_table_is_a_line_for_each_number() {
    let whole = "ste.summary[design=ga, torque=25 N m].peak_to_peak";
    let rows = || {
        vec![
            row(&[("label", text("short")), ("cell", texts(&["peak_to_peak"])), ("value", texts(&["0.75 um"]))]),
            row(&[("label", text("ratio")), ("formula", texts(&["a / b - 1"])), ("value", texts(&["100 %"]))]),
            row(&[("label", text("whole")), ("cell", texts(&[whole])), ("value", texts(&["1.90 um"]))]),
            row(&[("label", text("half")), ("formula", texts(&["peak_to_peak / b"])), ("value", texts(&["0.375"]))]),
        ]
    };
    let table = [("where", text("page 3")), ("of", text(SHORT)), ("tolerance", text("0.1 %"))];
    let shared = [("a", "4 um"), ("b", "2 um")];
    let verdicts = run_record(&summary(), &report(&table, rows(), &shared)).unwrap().0.remove(0);
    assert_eq!(verdicts.texts("verdict"), ["reproduced"; 4]);
    assert_eq!(verdicts.texts("label"), ["short", "ratio", "whole", "half"]);
    assert_eq!(verdicts.texts("cell")[0], format!("{SHORT}.peak_to_peak"));
    assert_eq!(verdicts.texts("with")[3], format!("peak_to_peak = {SHORT}.peak_to_peak; b = 2 um"));
    // What nothing uses is told, where it stands.
    let more = [("a", "4 um"), ("b", "2 um"), ("c", "1 um")];
    assert_eq!(wrong(&table, rows(), &more), ["7: `let` gives `c`, but no formula, claim or proof uses it"]);
}

/// Numbers that stand side by side are entries of their own, each with what its column begins with; one that stands alone is of the table.
#[test]
fn columns_stand_side_by_side() {
    let columns = || map(&[("short", SHORT), ("long", LONG)]);
    let table = [
        ("of", text("ste.summary[design=ga, torque=25 N m]")),
        ("columns", columns()),
        ("let", names(&[("d", &["0.5 um", "0.7 um"])])),
    ];
    let rows = vec![
        row(&[("label", text("alone")), ("cell", texts(&["peak_to_peak"])), ("value", texts(&["1.9 um"]))]),
        row(&[("label", text("both")), ("cell", texts(&["peak_to_peak"])), ("value", texts(&["0.75 um", "3.70 um"]))]),
        row(&[
            ("label", text("less")),
            ("formula", texts(&["peak_to_peak - d"])),
            ("value", texts(&["0.25 um", "3.00 um"])),
        ]),
        row(&[("label", text("blank")), ("formula", texts(&["d", "2*d"])), ("value", texts(&["none", "1.4 um"]))]),
        row(&[
            ("label", text("stands")),
            ("cell", texts(&["peak_to_peak"])),
            ("value", texts(&["0.80 um", "3.90 um"])),
            ("because", text("read off a figure")),
            (
                "expected",
                list(vec![
                    group::<Expected>(&[("value", text("0.75 um"))]),
                    group::<Expected>(&[("value", text("3.70 um"))]),
                ]),
            ),
        ]),
    ];
    let verdicts = run_record(&summary(), &report(&table, rows, &[])).unwrap().0.remove(0);
    let labels = [
        "alone",
        "both, short",
        "both, long",
        "less, short",
        "less, long",
        "blank, long",
        "stands, short",
        "stands, long",
    ];
    assert_eq!(verdicts.texts("label"), labels);
    let words: Vec<&str> = verdicts.texts("verdict").iter().map(String::as_str).collect();
    assert_eq!(words, [["reproduced"; 6].as_slice(), ["explained"; 2].as_slice()].concat());
    let cells = verdicts.texts("cell");
    assert_eq!([&cells[1], &cells[2]], [&format!("{SHORT}.peak_to_peak"), &format!("{LONG}.peak_to_peak")]);
}

/// A row that fits no column, a name that fits none, and what is left unused are told where they stand; nothing else is then said.
#[test]
fn rows_that_fit_no_column_are_refused() {
    let columns = ("columns", map(&[("short", SHORT), ("long", LONG)]));
    let cell = ("cell", texts(&["peak_to_peak"]));
    let one = |fields: Fields| vec![row(&[&[("label", text("x"))], fields].concat())];
    let of_columns = |fields: Fields| wrong(std::slice::from_ref(&columns), one(fields), &[]);
    let value = |each: &[&str]| ("value", texts(each));
    assert_eq!(
        of_columns(&[cell.clone(), value(&["1 um", "2 um", "3 um"])]),
        ["7: 3 values in a table of 2 `columns`"]
    );
    assert_eq!(of_columns(&[cell.clone(), value(&["none", "none"])]), ["7: the row has no number"]);
    let cells = ("cell", texts(&["a", "b", "c"]));
    assert_eq!(of_columns(&[cells, value(&["1 um", "2 um"])]), ["7: `cell` lists 3 for 2 values"]);
    let expected = ("expected", list(vec![group::<Expected>(&[("value", text("1 um"))])]));
    assert_eq!(of_columns(&[cell.clone(), value(&["1 um", "2 um"]), expected]), ["7: `expected` lists 1 for 2 values"]);
    let alone = of_columns(&[cell.clone(), value(&["1 um"])]);
    assert_eq!(alone, ["7: `peak_to_peak` is a column alone, and the table does not say of what"]);
    let each = ("let", names(&[("d", &["1 um", "2 um"])]));
    let formula = ("formula", texts(&["2*d"]));
    let message = "7: `d` stands for one thing in each of `columns`, and this row has one number";
    assert_eq!(wrong(&[columns.clone(), each], one(&[formula, value(&["1 um"])]), &[]), [message]);
    let plain = wrong(&[], one(&[cell.clone(), value(&["1 um", "2 um"])]), &[]);
    assert_eq!(plain, ["7: 2 values in a table of one column"]);
    let single = ("columns", map(&[("short", SHORT)]));
    let message = "7: `columns` are numbers that stand side by side, two or more; for one there is `of`";
    assert_eq!(wrong(&[single], one(&[cell.clone(), value(&["1 um"])]), &[]), [message]);
    let three = ("let", names(&[("d", &["1 um", "2 um", "3 um"])]));
    let fits = one(&[cell, value(&["1 um", "2 um"])]);
    let message = "7: `d` stands for 3 things in a table of 2 `columns`";
    assert_eq!(wrong(&[columns.clone(), three], fits.clone(), &[]), [message]);
    let unused = ("let", names(&[("d", &["1 um"])]));
    assert_eq!(wrong(&[columns, unused], fits, &[]), ["7: `let` gives `d`, but no formula of the table uses it"]);
}
