//! One row of the table of verdicts as text: with the digits of the paper, one more for what was computed.
//!
//! Must not know: HTML, terminals. Serves both.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use serde::Serialize;

use super::{ReportError, floats, texts};
use declare::number::{Printed, significant, unit_symbol, with_unit};
use declare::units::split_quantity;
use studygraph::table::data::Table;

/// A row, ready to be set.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Row {
    pub number: i64,
    pub label: String,
    /// Where the paper says it.
    pub location: String,
    pub cell: String,
    pub with: String,
    pub is_claim: bool,
    pub published: String,
    pub computed: String,
    pub difference: String,
    pub relative: String,
    pub tolerance: String,
    pub expected: String,
    pub verdict: String,
    pub sign: &'static str,
    pub because: String,
    pub note: String,
    /// What it is inside the intervals of its inputs.
    pub rounding: String,
    pub numbers: String,
    pub proof: String,
    pub failing: String,
}

/// A sign for a verdict, so that colour is never alone.
#[must_use]
pub fn sign(verdict: &str) -> &'static str {
    match verdict {
        "reproduced" | "holds" => "✓",
        "explained" | "refuted" => "≠",
        _ => "!",
    }
}

/// # Errors
/// When the table is of another shape.
pub fn rows(table: &Table) -> Result<Vec<Row>, ReportError> {
    let text = |name: &str| texts(table, name);
    let number = |name: &str| floats(table, name);
    let numbers = super::integers(table, "number")?;
    let (labels, locations, cells, with) = (text("label")?, text("where")?, text("cell")?, text("with")?);
    let (kinds, stated, found, units) = (text("kind")?, text("published_text")?, text("found")?, text("unit")?);
    let (computed, difference) = (number("computed")?, number("difference")?);
    let (relative, tolerance) = (number("relative_difference")?, number("tolerance")?);
    let (expected, expected_tolerance) = (number("expected")?, number("expected_tolerance")?);
    let (verdicts, because, note) = (text("verdict")?, text("because")?, text("note")?);
    // Results of an earlier version have none.
    let rounding = text("rounding").ok();
    let (arithmetic, proof, failing) = (text("numbers")?, text("proof")?, text("failing")?);
    let one = |row: usize| {
        let is_claim = kinds[row] == "claim";
        let unit = units[row].as_str();
        let printed = Printed::read(&stated[row]).unwrap_or(Printed { decimals: 0, exponent: 0 });
        let within = |value: f64, tolerance: f64| match (value.is_nan(), is_claim) {
            (true, _) => String::new(),
            (false, true) => format!("{} rows", significant(value, 4)),
            (false, false) => with_unit(&format!("{} ± {}", close(value, printed), significant(tolerance, 2)), unit),
        };
        Row {
            number: numbers[row],
            label: labels[row].clone(),
            location: locations[row].clone(),
            cell: cells[row].clone(),
            with: with[row].clone(),
            is_claim,
            published: if is_claim { "claimed".to_owned() } else { as_printed(&stated[row]) },
            computed: if is_claim {
                found[row].clone()
            } else {
                with_unit(&near(computed[row], tolerance[row], printed), unit)
            },
            difference: if is_claim {
                String::new()
            } else {
                apart(&signed(near(difference[row], tolerance[row], printed)), unit)
            },
            relative: if is_claim || relative[row].is_nan() { String::new() } else { percent(relative[row]) },
            tolerance: if is_claim {
                String::new()
            } else {
                apart(&format!("± {}", significant(tolerance[row], 3)), unit)
            },
            expected: within(expected[row], expected_tolerance[row]),
            verdict: verdicts[row].clone(),
            sign: sign(&verdicts[row]),
            because: because[row].clone(),
            note: note[row].clone(),
            rounding: rounding.map_or_else(String::new, |rounding| rounding[row].clone()),
            numbers: arithmetic[row].clone(),
            proof: proof[row].clone(),
            failing: failing[row].clone(),
        }
    };
    // Verdict by verdict, each in the order of the study.
    let mut order: Vec<usize> = (0..table.rows()).collect();
    order.sort_by_key(|&row| rank(&verdicts[row]));
    Ok(said_once(order.into_iter().map(one).collect()))
}

/// A reason of more characters than this is not read twice.
const LONG: usize = 60;
/// What stands before each remark about rounded inputs.
const REMARK: &str = " · ";

/// Long reasons that rows of one verdict share stand at the first of them, and so do long remarks about rounded inputs; the others name
/// it. Rows of another verdict may be hidden.
fn said_once(mut rows: Vec<Row>) -> Vec<Row> {
    let mut first: BTreeMap<(String, String), i64> = BTreeMap::new();
    let mut known = |text: &str, verdict: &str, number: i64| {
        if text.chars().count() <= LONG {
            return None;
        }
        match first.entry((verdict.to_owned(), text.to_owned())) {
            Entry::Occupied(known) => Some(*known.get()),
            Entry::Vacant(new) => {
                new.insert(number);
                None
            }
        }
    };
    for row in &mut rows {
        if let Some(other) = known(&row.because, &row.verdict, row.number) {
            row.because = format!("for the reason of row {other}");
        }
        let mut of_row: Vec<i64> = Vec::new();
        let mut own: Vec<&str> = Vec::new();
        for (at, remark) in row.rounding.split(REMARK).enumerate() {
            // What comes first is of the row alone.
            match if at == 0 { None } else { known(remark, &row.verdict, row.number) } {
                Some(other) if other != row.number => of_row.push(other),
                _ => own.push(remark),
            }
        }
        of_row.dedup();
        let others = of_row.iter().map(|other| format!("more as in row {other}"));
        let all: Vec<String> = own.into_iter().map(str::to_owned).chain(others).collect();
        row.rounding = all.join(REMARK);
    }
    rows
}

/// How far apart two values are. Of two percentages that is points: in percent it would read as a share of one of them.
pub fn apart(number: &str, unit: &str) -> String {
    with_unit(number, if unit == "%" { "points" } else { unit })
}

/// What needs attention comes first, then what is explained, then what agrees; as the table of counts has them.
fn rank(verdict: &str) -> usize {
    const ORDER: [&str; 7] = ["unexplained", "moved", "outdated", "explained", "refuted", "reproduced", "holds"];
    ORDER.iter().position(|known| *known == verdict).unwrap_or(0)
}

/// The printed text with the typography of a journal: `2.738e8 N/m` as `2.738×10⁸ N/m`.
fn as_printed(text: &str) -> String {
    let (number, unit) = split_quantity(text);
    match (number.parse::<f64>(), Printed::read(text)) {
        (Ok(value), Some(printed)) => with_unit(&printed.show(value, 0), unit),
        _ => text.to_owned(),
    }
}

/// As [`close`]; 0 where it is less than a thousandth of the tolerance, which says no more of it.
fn near(value: f64, tolerance: f64, printed: Printed) -> String {
    if value.abs() < 1e-3 * tolerance { "0".to_owned() } else { close(value, printed) }
}

/// In the manner of the printed value with one more digit; a count as a count; by significant digits where that would show nothing.
fn close(value: f64, printed: Printed) -> String {
    let is_count = printed.decimals == 0 && printed.exponent == 0 && value.fract() == 0.0;
    let shown = printed.show(value, usize::from(!is_count));
    let is_lost = value != 0.0 && !shown.chars().any(|digit| ('1'..='9').contains(&digit));
    if is_lost || shown.chars().count() > 14 { significant(value, 3) } else { shown }
}

fn signed(text: String) -> String {
    let is_zero = !text.chars().any(|digit| ('1'..='9').contains(&digit));
    if text.starts_with('−') || is_zero { text } else { format!("+{text}") }
}

pub fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent.abs() < 0.005 {
        return "0.00\u{202f}%".to_owned();
    }
    let decimals = if percent.abs() < 9.995 { 2 } else { 1 };
    let text = if percent.abs() < 1e4 {
        format!("{percent:+.decimals$}").replace('-', "−")
    } else {
        signed(significant(percent, 3))
    };
    format!("{text}\u{202f}{}", unit_symbol("%"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_shown_with_the_digits_of_the_paper() {
        let micrometres = Printed::read("2.316 um").unwrap();
        assert_eq!(as_printed("2.738e8 N/m"), "2.738×10⁸\u{202f}N/m");
        assert_eq!(as_printed("0.40 um"), "0.40\u{202f}µm");
        assert_eq!(close(3.000_883, micrometres), "3.0009");
        assert_eq!(close(0.000_001, micrometres), "1×10⁻⁶");
        assert_eq!(close(0.0, micrometres), "0.0000");
        assert_eq!(close(1e20, micrometres), "100×10¹⁸");
        assert_eq!(signed("0.0000".to_owned()), "0.0000");
        assert_eq!((percent(0.2957).as_str(), percent(-0.0123).as_str()), ("+29.6\u{202f}%", "−1.23\u{202f}%"));
        assert_eq!(percent(-0.000_01), "0.00\u{202f}%");
    }

    #[test]
    fn two_percentages_are_points_apart() {
        assert_eq!(apart("−19.4", "%"), "−19.4\u{202f}points");
        assert_eq!(apart("−19.4", "um"), "−19.4\u{202f}µm");
    }

    #[test]
    fn counts_are_counts_and_what_is_nothing_is_0() {
        let teeth = Printed::read("19").unwrap();
        assert_eq!((close(19.0, teeth).as_str(), close(19.2, teeth).as_str()), ("19", "19.2"));
        assert_eq!(close(2.0, Printed::read("2.0").unwrap()), "2.00");
        let gap = Printed::read("0 mm").unwrap();
        // ±1 nm: below a picometre there is nothing to see.
        assert_eq!(near(-28.4e-15, 1e-6, gap), "0");
        assert_eq!(near(2e-9, 1e-6, gap), "2×10⁻⁹");
        assert_eq!(near(0.5e-9, 1e-6, gap), "0");
        assert_eq!(near(-28.4e-15, 0.0, gap), "−28.4×10⁻¹⁵", "without a tolerance nothing is small");
    }

    #[test]
    fn what_needs_attention_is_first_and_each_verdict_stands_together() {
        let mut words =
            ["refuted", "reproduced", "explained", "holds", "outdated", "explained", "refuted", "unexplained"];
        words.sort_by_key(|word| rank(word));
        let sorted = ["unexplained", "outdated", "explained", "explained", "refuted", "refuted", "reproduced", "holds"];
        assert_eq!(words, sorted);
    }
    #[test]
    fn a_long_reason_stands_at_the_first_row_of_a_verdict() {
        let long = "the program stops its search where both curves agree to a ten-thousandth of the module";
        let row = |number: i64, verdict: &str, because: &str| Row {
            number,
            verdict: verdict.to_owned(),
            because: because.to_owned(),
            ..Row::default()
        };
        let rows = [
            row(4, "unexplained", long),
            row(2, "explained", long),
            row(3, "explained", "rounded"),
            row(5, "explained", long),
            row(6, "explained", "rounded"),
            row(7, "explained", long),
        ];
        let said: Vec<String> = said_once(rows.to_vec()).into_iter().map(|row| row.because).collect();
        let shared = "for the reason of row 2";
        assert_eq!(said, [long, long, "rounded", shared, "rounded", shared]);
    }

    #[test]
    fn a_long_remark_stands_at_the_first_row_of_a_verdict() {
        let cut =
            "searched only up to `pair.pinion.bore_radius` at 25.38 mm, above which there is no value: geometry: a; b";
        let corner = "no value at 2 of 4 corners, for example: geometry: the bore radius is 26 mm, but must be below";
        let held = "no range is known · inputs were printed rounded; `sweep` is not computed anew for them";
        let row = |number: i64, verdict: &str, rounding: String| Row {
            number,
            verdict: verdict.to_owned(),
            rounding,
            ..Row::default()
        };
        let range = "1 to 2 mm over the rounded inputs; some value inside reproduces it";
        let rows = [
            row(1, "reproduced", format!("{range} · {cut} · {corner}")),
            row(2, "reproduced", format!("3 to 4 mm over the rounded inputs; none found · {cut} · {corner}")),
            row(3, "reproduced", format!("{range} · {corner}")),
            row(4, "explained", format!("3 to 4 mm · {cut}")),
            row(5, "explained", held.to_owned()),
            row(6, "explained", held.to_owned()),
            row(7, "explained", String::new()),
        ];
        let said: Vec<String> = said_once(rows.to_vec()).into_iter().map(|row| row.rounding).collect();
        assert_eq!(said[0], rows[0].rounding);
        assert_eq!(said[1], "3 to 4 mm over the rounded inputs; none found · more as in row 1");
        assert_eq!(said[2], format!("{range} · more as in row 1"));
        assert_eq!(said[3], rows[3].rounding, "rows of another verdict may be hidden");
        assert_eq!(
            (said[4].as_str(), said[5].as_str(), said[6].as_str()),
            (held, "no range is known · more as in row 5", "")
        );
    }
}
