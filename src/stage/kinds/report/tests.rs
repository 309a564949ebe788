//! The stage as a whole, on small tables, with records built by hand.

use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

use super::stated::{Expected, StatedProof};
use super::*;
use crate::stage::Demand;
use declare::declared::record_of;
use declare::error::Place;
use declare::record::{PlacedValue as Item, Value};
use declare::seed::Seed;
use declare::work::Tally;
use studygraph::table::data::Cell;
use studygraph::table::schema::Column;

mod figures;
mod printed;

type Fields<'a> = &'a [(&'static str, Value)];

fn item(value: Value) -> Item {
    Item { value, place: Place { line: 7, ..Place::default() } }
}

fn text(text: &str) -> Value {
    Value::Text(text.to_owned())
}

fn map(pairs: &[(&str, &str)]) -> Value {
    Value::Map(pairs.iter().map(|(name, value)| ((*name).to_owned(), item(text(value)))).collect())
}

fn group<T: Declared>(fields: Fields) -> Value {
    let mut record = record_of(T::MEMBER.fields, fields);
    record.place.line = 3;
    record.fields.iter_mut().for_each(|(_, entry)| entry.place.line = 7);
    Value::Group(record)
}

fn list(values: Vec<Value>) -> Value {
    Value::List(values.into_iter().map(item).collect())
}

fn record(published: Vec<Value>, figures: Vec<Value>) -> Record {
    let fields = vec![("published", item(list(published))), ("figures", item(list(figures)))];
    Record { fields, place: Place::default() }
}

fn summary() -> Table {
    let schema = Schema::new(
        "summary",
        "",
        vec![
            Column::text("design", "").key(),
            Column::float("torque", "N m", "").key(),
            Column::float("peak_to_peak", "um", "").allows_nan(),
            Column::float("seconds", "s", "").volatile(),
            Column::integer("positions", ""),
        ],
    );
    let mut rows = Vec::new();
    for (torque, unmodified, iso, ga) in [(25.0, 1.5, 1.4, 1.9), (50.0, 3.0, 0.75, 0.43), (100.0, 6.0, 3.7, f64::NAN)] {
        for (design, value) in [("unmodified", unmodified), ("iso", iso), ("ga", ga)] {
            rows.push(vec![design.into(), torque.into(), value.into(), 0.1.into(), 64.into()]);
        }
    }
    Table::from_rows(schema, rows).unwrap()
}

fn run(published: Vec<Value>, figures: Vec<Value>) -> Result<Vec<Table>, String> {
    run_on(&summary(), published, figures).map(|(tables, _)| tables)
}

/// The tables of the report on one table of another stage, and what it warns of.
fn run_on(summary: &Table, published: Vec<Value>, figures: Vec<Value>) -> Result<(Vec<Table>, Vec<String>), String> {
    run_record(summary, &record(published, figures))
}

fn run_record(summary: &Table, record: &Record) -> Result<(Vec<Table>, Vec<String>), String> {
    let stage = (KIND.build)(record).map_err(|diagnostic| format!("study: {diagnostic}"))?;
    if let Some(found) = stage.wrong().first() {
        return Err(format!("study: {found}"));
    }
    let tables = stage.outputs().into_iter().map(|schema| (schema.name, BTreeSet::new())).collect();
    let (demand, stop) = (Demand { tables }, AtomicBool::new(false));
    let warned = Mutex::new(Vec::new());
    let context = Context {
        seed: Seed::of_stage(1, "report"),
        demand: &demand,
        stop: &stop,
        progress: &|_| (),
        warn: &|warning| warned.lock().unwrap().push(String::from(warning)),
        is_heard: true,
        work: &Tally::default(),
    };
    let inputs = Inputs { ports: [("ste".to_owned(), vec![summary])].into() };
    let tables = stage.run(&context, &inputs).map_err(|failure| match failure {
        Failure::Study(wrong) => format!("line {}: {}", wrong.first.place.unwrap().line, wrong.first),
        other => other.to_string(),
    })?;
    let warned = warned.lock().unwrap().clone();
    Ok((tables, warned))
}

fn verdict(fields: Fields) -> Result<(String, Table), String> {
    let table = run(vec![group::<Published>(fields)], vec![])?.remove(0);
    Ok((table.texts("verdict")[0].clone(), table))
}

const UNMODIFIED: &str = "ste.summary[design=unmodified, torque=50 N m].peak_to_peak";
const ISO: &str = "ste.summary[design=iso, torque=50 N m].peak_to_peak";

#[test]
fn a_cell_is_compared_in_the_printed_unit() {
    let (word, table) = verdict(&[("cell", text(UNMODIFIED)), ("value", text("0.0030 mm"))]).unwrap();
    assert_eq!(word, "reproduced");
    assert_eq!((table.floats("computed")[0], table.floats("tolerance")[0]), (0.003, 0.000_05));
    assert_eq!((table.texts("unit")[0].as_str(), table.texts("published_text")[0].as_str()), ("mm", "0.0030 mm"));
}

#[test]
fn tolerances_are_digits_shares_or_quantities() {
    for (value, tolerance, expected) in [
        ("3.02 um", "digits", "unexplained"),
        ("3.0 um", "digits", "reproduced"),
        ("3.02 um", "1 %", "reproduced"),
        ("3.04 um", "1 %", "unexplained"),
        ("3.04 um", "50 nm", "reproduced"),
        ("3.04 um", "0.03 um", "unexplained"),
    ] {
        let fields = [("cell", text(UNMODIFIED)), ("value", text(value)), ("tolerance", text(tolerance))];
        assert_eq!(verdict(&fields).unwrap().0, expected, "{value} within {tolerance}");
    }
    let negative = |value: &str, tolerance: &str| {
        let fields = [
            ("formula", text("a - 1")),
            ("with", map(&[("a", "0.5")])),
            ("value", text(value)),
            ("tolerance", text(tolerance)),
        ];
        verdict(&fields).unwrap().0
    };
    assert_eq!(negative("-0.504", "1 %"), "reproduced");
    assert_eq!(negative("-0.51", "1 %"), "unexplained");
    assert_eq!(negative("-0.504", "0.005"), "reproduced");
    for (value, tolerance, message) in [
        ("3 um", "-1 %", "negative"),
        ("3 um", "1 N", "does not fit"),
        ("3 um", "0.1", "does not fit"),
        ("0 um", "1 %", "of a value of 0 is nothing"),
        ("3 um", "tight", "tolerance `tight`"),
        ("three", "digits", "`three` is not a number"),
        ("3 furlong", "digits", "unknown unit"),
    ] {
        let fields = [("cell", text(UNMODIFIED)), ("value", text(value)), ("tolerance", text(tolerance))];
        let error = verdict(&fields).unwrap_err();
        assert!(error.starts_with("study: ") && error.contains(message), "{error}");
    }
}

#[test]
fn a_formula_has_the_unit_of_its_value() {
    let with = map(&[("iso", ISO), ("none", UNMODIFIED)]);
    let reduction = [("formula", text("1 - iso / none")), ("with", with), ("value", text("75.0 %"))];
    let (word, table) = verdict(&reduction).unwrap();
    assert_eq!(word, "reproduced");
    assert!((table.floats("computed")[0] - 75.0).abs() < 1e-12);
    assert_eq!(table.texts("numbers")[0], "iso = 0.75\u{202f}µm, none = 3\u{202f}µm");

    let own = map(&[("a", "2.316 um"), ("b", "0.728 um")]);
    let fields = [
        ("formula", text("1 - b / a")),
        ("with", own.clone()),
        ("value", text("68.5 %")),
        ("tolerance", text("0.2 %")),
    ];
    assert_eq!(verdict(&fields).unwrap().0, "reproduced");
    // Units are checked before anything runs where no cell is in the way, and when it runs otherwise.
    let error = verdict(&[("formula", text("a + b")), ("with", own), ("value", text("68.5 %"))]).unwrap_err();
    assert!(error.starts_with("study: what is computed is a length, but the published `68.5 %` is a ratio"), "{error}");
    let error = verdict(&[("cell", text(ISO)), ("value", text("3 N"))]).unwrap_err();
    assert!(error.contains("is a length, but the published `3 N` is a force"), "{error}");
}

#[test]
fn a_claim_is_counted_row_by_row() {
    let cells = |second: &str| map(&[("iso", "ste.summary[design=iso].peak_to_peak"), ("other", second)]);
    let holds = [("claim", text("iso < other")), ("with", cells("ste.summary[design=unmodified].peak_to_peak"))];
    let (word, table) = verdict(&holds).unwrap();
    assert_eq!((word.as_str(), table.texts("found")[0].as_str()), ("holds", "holds in 3 of 3"));

    let low = [("claim", text("iso < other")), ("with", cells("1 um"))];
    let (word, table) = verdict(&low).unwrap();
    assert_eq!((word.as_str(), table.texts("found")[0].as_str()), ("unexplained", "holds in 1 of 3"));
    assert_eq!(
        table.texts("failing")[0],
        "does not hold at torque 25\u{202f}N·m; torque 100\u{202f}N·m; at torque 25\u{202f}N·m: 1.4\u{202f}µm ≥ 1\u{202f}µm"
    );
    let mut explained = low.to_vec();
    explained.push(("because", text("each relief is best at one load")));
    assert_eq!(verdict(&explained).unwrap().0, "refuted");
    explained.push(("expected", group::<Expected>(&[("value", text("1")), ("tolerance", text("0"))])));
    assert_eq!(verdict(&explained).unwrap().0, "refuted");
    explained.pop();
    explained.push(("expected", group::<Expected>(&[("value", text("2")), ("tolerance", text("0"))])));
    assert_eq!(verdict(&explained).unwrap().0, "moved");
    explained.pop();
    // In the proof of a claim the two numbers are counts of rows.
    explained.push(("proof", group::<StatedProof>(&[("claim", text("published == 3 && computed == 1"))])));
    assert_eq!(verdict(&explained).unwrap().0, "refuted");

    let alone = [("claim", text("iso < other")), ("with", map(&[("iso", ISO), ("other", "0.5 um")]))];
    let (word, table) = verdict(&alone).unwrap();
    assert_eq!((word.as_str(), table.texts("found")[0].as_str()), ("unexplained", "does not hold"));
    assert_eq!(table.texts("failing")[0], "0.75\u{202f}µm ≥ 0.5\u{202f}µm");
}

#[test]
fn rows_of_a_claim_must_line_up() {
    let with = map(&[("a", "ste.summary[design=iso].peak_to_peak"), ("b", "ste.summary[torque=50 N m].peak_to_peak")]);
    let error = verdict(&[("claim", text("a < b")), ("with", with)]).unwrap_err();
    assert!(error.contains("the rows of a (3, by torque) and b (3, by design) do not line up"), "{error}");
    let with = map(&[("a", "1 um, 2 um"), ("b", "ste.summary[design=iso].peak_to_peak")]);
    let error = verdict(&[("claim", text("a < b")), ("with", with)]).unwrap_err();
    assert!(error.contains("the rows of b (3, by torque) and a (2) do not line up"), "{error}");
}

/// The printed column of a table beside the computed one: row by row, and as one distance.
#[test]
fn a_list_of_quantities_stands_beside_the_rows_in_their_order() {
    let with = map(&[("printed", "1.5 um, 0.7 um, 3.9 um"), ("ours", "ste.summary[design=iso].peak_to_peak")]);
    let distance = [
        ("formula", text("rms(ours - printed)")),
        ("with", with.clone()),
        ("value", text("0.13 um")),
        ("tolerance", text("0.01 um")),
    ];
    let (word, table) = verdict(&distance).unwrap();
    assert_eq!(word, "reproduced");
    let expected = libm::sqrt((0.01 + 0.0025 + 0.04) / 3.0);
    assert!((table.floats("computed")[0] - expected).abs() < 1e-12, "{}", table.floats("computed")[0]);
    assert_eq!(table.texts("numbers")[0], "printed = 3 values, ours = 3 values");
    let (word, table) = verdict(&[("claim", text("ours < printed")), ("with", with.clone())]).unwrap();
    assert_eq!((word.as_str(), table.texts("found")[0].as_str()), ("unexplained", "holds in 2 of 3"));
    assert!(table.texts("failing")[0].starts_with("does not hold at torque 50\u{202f}N·m"), "{table:?}");
    // All rows go into the numbers of this claim, so it is judged once.
    let claim = text("rms(ours - printed) < 0.2 * mean(printed)");
    let (word, table) = verdict(&[("claim", claim), ("with", with)]).unwrap();
    assert_eq!((word.as_str(), table.texts("found")[0].as_str()), ("holds", "holds"));
    let with = map(&[("a", "1 um, 2 N")]);
    let error = verdict(&[("formula", text("sum(a)")), ("with", with), ("value", text("1 um"))]).unwrap_err();
    assert!(error.contains("`1 um, 2 N` lists a length and a force"), "{error}");
}

#[test]
fn a_reason_needs_its_proof_and_its_expectation() {
    let entry = |claim: &str, expected: &str| {
        let with = map(&[("F", "1866.979 N"), ("k1", "2.738e8 N/m"), ("k2", "4.724e8 N/m")]);
        vec![
            ("cell", text(UNMODIFIED)),
            ("value", text("2.316 um")),
            ("because", text("its own stiffnesses bound it")),
            ("proof", group::<StatedProof>(&[("claim", text(claim)), ("with", with)])),
            ("expected", group::<Expected>(&[("value", text(expected)), ("tolerance", text("0.1 %"))])),
        ]
    };
    let (word, table) = verdict(&entry("F / k1 - F / k2 > published", "3.0 um")).unwrap();
    assert_eq!(word, "explained");
    assert_eq!(
        table.texts("proof")[0],
        "F / k1 - F / k2 > published: 2.867\u{202f}µm > 2.316\u{202f}µm, \
         with F = 1866.98\u{202f}N, k1 = 273.8×10⁶\u{202f}N/m, k2 = 472.4×10⁶\u{202f}N/m"
    );
    assert!((table.floats("relative_difference")[0] - (3.0 - 2.316) / 2.316).abs() < 1e-12);
    let (word, table) = verdict(&entry("F / k1 - F / k2 < published", "3.0 um")).unwrap();
    assert_eq!(word, "unexplained");
    assert!(
        table.texts("proof")[0].contains("2.867\u{202f}µm ≥ 2.316\u{202f}µm — does not hold"),
        "{}",
        table.texts("proof")[0]
    );
    assert_eq!(verdict(&entry("F / k1 - F / k2 > published", "3.1 um")).unwrap().0, "moved");
    assert_eq!(verdict(&entry("F / k1 - F / k2 <= computed", "3000 nm")).unwrap().0, "explained");
    let error = verdict(&entry("F / k1 - k2 > published", "3.0 um")).unwrap_err();
    assert!(error.starts_with("study: proof: a length and a stiffness"), "{error}");
}

#[test]
fn cells_that_cannot_be_compared_are_refused_by_name() {
    for (cell, message) in [
        ("ste.summary[design=iso].peak_to_peak", "names 3 rows where one is meant; add torque"),
        (
            "ste.summary[design=is, torque=50 N m].peak_to_peak",
            "no row has `design=is`; did you mean `iso`? there: `ga`, `iso`, `unmodified`",
        ),
        ("ste.summary[design=iso, torque=51 N m].peak_to_peak", "no row has `torque=51 N m`; there: `25 N m`"),
        ("ste.summary[design=ga, torque=100 N m].peak_to_peak", "column `peak_to_peak` is NaN"),
        ("ste.summary[design=iso, torque=50 N m].seconds", "differs from run to run"),
        ("ste.summary[design=iso, torque=50 N m].design", "holds texts, not numbers"),
        ("ste.summary[design=iso, torque=50 N m].peek_to_peak", "did you mean `peak_to_peak`?"),
        ("ste.summary[desing=iso].peak_to_peak", "did you mean `design`?"),
        ("ste.curve[design=iso].x", "no table `curve`"),
        ("other.summary[design=iso].x", "nothing came in through `other`"),
    ] {
        let error = verdict(&[("cell", text(cell)), ("value", text("1 um")), ("where", text("Table 2"))]).unwrap_err();
        assert!(error.starts_with("line 7: ") && error.contains(message), "{cell}: {error}");
    }
}

#[test]
fn entries_that_make_no_sense_are_refused_when_the_study_is_read() {
    let value = ("value", text("1 um"));
    let cases: Vec<(Vec<(&'static str, Value)>, &str)> = vec![
        (vec![value.clone()], "one of `cell`, `formula` and `claim`; found none"),
        (vec![("cell", text(ISO)), ("claim", text("1 < 2"))], "found `cell` and `claim`"),
        (vec![("cell", text(ISO))], "the published `value` is missing"),
        (vec![("claim", text("1 < 2")), value.clone()], "it has no `value`"),
        (vec![("cell", text("3 um")), value.clone()], "is not a cell"),
        (vec![("cell", text("ste.summary")), value.clone()], "neither a quantity"),
        (vec![("formula", text("1 < 2")), value.clone()], "call it `claim`"),
        (vec![("claim", text("1 + 2"))], "a claim compares"),
        (vec![("cell", text(ISO)), ("with", map(&[("a", "1")])), value.clone()], "not to a `cell`"),
        (vec![("formula", text("a")), ("with", map(&[("a", "1 um"), ("b", "2")])), value.clone()], "gives `b`, but"),
        (vec![("formula", text("a + c")), ("with", map(&[("a", "1 um")])), value.clone()], "`c` is not given"),
        (vec![("formula", text("a")), ("with", map(&[("a", "1 furlong")])), value.clone()], "unknown unit `furlong`"),
        (
            vec![("cell", text(ISO)), value.clone(), ("proof", group::<StatedProof>(&[("claim", text("1 < 2"))]))],
            "not the reason it proves",
        ),
        (
            vec![
                ("cell", text(ISO)),
                value.clone(),
                ("because", text("x")),
                ("proof", group::<StatedProof>(&[("claim", text("1 + 2"))])),
            ],
            "a proof compares",
        ),
        (
            vec![("cell", text(ISO)), value, ("expected", group::<Expected>(&[("value", text("1 N"))]))],
            "is a force; the published value is a length",
        ),
    ];
    for (fields, message) in cases {
        let error = verdict(&fields).unwrap_err();
        assert!(error.starts_with("study: ") && error.contains(message), "{message}: {error}");
    }
}

#[test]
fn ports_ask_for_each_table_once_with_the_columns_named() {
    let published = group::<Published>(&[("cell", text(ISO)), ("value", text("1 um"))]);
    let claim = group::<Published>(&[("claim", text("a < 2")), ("with", map(&[("a", "pair.summary.ratio")]))]);
    let stage = (KIND.build)(&record(vec![published, claim], vec![figures::figure(&[])])).unwrap();
    let ports = stage.inputs();
    assert_eq!(ports.iter().map(|port| port.stage.as_str()).collect::<Vec<_>>(), ["ste", "pair"]);
    assert_eq!(ports[0].wants.len(), 1);
    assert_eq!(ports[0].wants[0].columns, ["design", "peak_to_peak", "torque"]);
}

#[test]
fn the_counts_add_up_and_an_empty_report_is_one() {
    let tables = run(vec![group::<Published>(&[("cell", text(ISO)), ("value", text("1 um"))])], vec![]).unwrap();
    assert_eq!(tables[1].integers("count").iter().sum::<i64>(), 1);
    assert_eq!(tables[1].column("verdict").unwrap().cell(0), Cell::from("unexplained"));
    let tables = run(vec![], vec![]).unwrap();
    assert_eq!(tables.iter().map(Table::rows).collect::<Vec<_>>(), [0, 7, 0, 0, 0]);
}
