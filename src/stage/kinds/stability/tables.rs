//! The tables of the stage kind `stability`.
//!
//! Must not know: how cases come about.

use std::collections::BTreeMap;

use gearmesh::gear::stability::{DigitsLost, Report, Verdict};
use studygraph::table::data::{Row, Table, TableError};
use studygraph::table::schema::{Column, Schema};

/// In the order of [`write`].
pub fn schemas() -> Vec<Schema> {
    let case = || Column::text("case", "Name of the case: an axis with its value, a trap, or a sample.").key();
    let axis = || Column::text("axis", "The axis the case lies on; `trap` and `sample` for those that lie on none.");
    // All of it is the same bits on any processor but what faer factorised: compliances of finite elements move by 1e-9,
    // and with them residuals by as many roundings, jumps and differences by 1e-12. Digits lost are of other methods, or of
    // geometry alone.
    let factorised = |column: Column| column.tolerance(1e-11, 1e-6);
    vec![
        Schema::new(
            "checks",
            "What was found of every invariant of every case.",
            vec![
                case(),
                Column::text("invariant", "What must hold.").key(),
                axis(),
                factorised(
                    Column::float("value", "", "How far it is from holding, as the limit counts it.").allows_nan(),
                ),
                factorised(
                    Column::float("limit", "", "What the value may be; NaN where the case is refused.").allows_nan(),
                ),
                Column::text("verdict", "holds, broken or refused."),
                Column::text("reason", "Why it is refused, or that the value is not a number."),
            ],
        ),
        Schema::new(
            "digits",
            "The kernels' numbers against a second evaluation in twice the precision. SI.",
            vec![
                case(),
                Column::text("quantity", "What is compared.").key(),
                axis(),
                Column::float("place", "", "Where the case lies on its axis: 0 at the first value, 1 at the last."),
                Column::float("value", "", "As the kernels compute it.").allows_nan(),
                Column::float("exact", "", "As the second evaluation computes it.").allows_nan(),
                Column::float("digits_lost", "", "15.95 + log10 of the relative difference, 0 at least."),
                Column::float("condition", "", "Relative change per relative change of the inputs.").allows_nan(),
            ],
        ),
        Schema::new(
            "summary",
            "How many rows of `checks` hold, by axis.",
            vec![
                Column::text("axis", "The axis; `trap` and `sample` for those that lie on none.").key(),
                Column::integer("cases", "Cases that lie on it."),
                Column::integer("computed", "Cases that could be computed at all."),
                Column::integer("holds", "Rows that hold."),
                Column::integer("broken", "Rows that do not."),
                Column::integer("refused", "Rows that physics or the model excludes."),
            ],
        ),
        Schema::new(
            "quantities",
            "The most digits lost of each quantity.",
            vec![
                Column::text("quantity", "What is compared.").key(),
                Column::integer("cases", "Cases in which it is compared."),
                Column::float("median", "", "Digits lost in the median of the cases."),
                Column::float("worst", "", "Most digits lost."),
                Column::text("case", "Where that is."),
                Column::float("condition", "", "The condition number there.").allows_nan(),
                Column::float("beyond_condition", "", "Most digits lost on top of what the condition takes."),
            ],
        ),
    ]
}

/// Name, axis, place on it, and what was found.
type Checked = (String, &'static str, f64, Report);

fn beyond(found: &DigitsLost) -> f64 {
    found.lost - libm::log10(found.condition.max(1.0))
}

pub fn write(checked: &[Checked]) -> Result<Vec<Table>, TableError> {
    let (mut checks, mut digits): (Vec<Row>, Vec<Row>) = Default::default();
    let mut axes: BTreeMap<&str, [usize; 5]> = BTreeMap::new();
    let mut quantities: BTreeMap<&str, Vec<(&DigitsLost, &str)>> = BTreeMap::new();
    let number = |value: f64| if value.is_finite() { value } else { f64::NAN };
    for (name, axis, place, report) in checked {
        let counts = axes.entry(*axis).or_default();
        counts[0] += 1;
        counts[1] += usize::from(report.findings.iter().any(|finding| finding.verdict != Verdict::Refused));
        for finding in &report.findings {
            counts[match finding.verdict {
                Verdict::Holds => 2,
                Verdict::Broken => 3,
                Verdict::Refused => 4,
            }] += 1;
            let strange = finding.verdict != Verdict::Refused && !finding.value.is_finite();
            let reason = if strange { format!("the value is {}", finding.value) } else { finding.reason.clone() };
            checks.push(vec![
                name.as_str().into(),
                finding.invariant.into(),
                (*axis).into(),
                number(finding.value).into(),
                number(finding.limit).into(),
                finding.verdict.word().into(),
                reason.as_str().into(),
            ]);
        }
        for found in &report.digits {
            quantities.entry(found.quantity).or_default().push((found, name));
            digits.push(vec![
                name.as_str().into(),
                found.quantity.into(),
                (*axis).into(),
                (*place).into(),
                number(found.value).into(),
                number(found.exact).into(),
                found.lost.into(),
                number(found.condition).into(),
            ]);
        }
    }
    let summary = axes
        .into_iter()
        .map(|(axis, counts)| -> Row { std::iter::once(axis.into()).chain(counts.map(Into::into)).collect() });
    let quantities = quantities.into_iter().map(|(quantity, mut found)| -> Row {
        found.sort_by(|one, two| one.0.lost.total_cmp(&two.0.lost));
        let (worst, case) = found[found.len() - 1];
        let most = found.iter().map(|(found, _)| beyond(found)).fold(f64::NEG_INFINITY, f64::max);
        vec![
            quantity.into(),
            found.len().into(),
            found[found.len() / 2].0.lost.into(),
            worst.lost.into(),
            case.into(),
            number(worst.condition).into(),
            most.into(),
        ]
    });
    let rows = [checks, digits, summary.collect(), quantities.collect()];
    schemas().into_iter().zip(rows).map(|(schema, rows)| Table::from_rows(schema, rows)).collect()
}
