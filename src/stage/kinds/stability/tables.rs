//! The tables of the stage kind `stability`.
//!
//! Must not know: how cases come about.

use std::collections::BTreeMap;

use gearmesh::gear::stability::{DigitsLost, Finding, Report, Verdict};
use studygraph::table::columns::{Columns, finite};
use studygraph::table::data::{Table, TableError};
use studygraph::table::schema::{Column, Schema};

/// The case a row is of, and the axis that lies on.
#[derive(Clone, Copy)]
struct CaseOf<'a> {
    name: &'a str,
    axis: &'static str,
}

/// The case, the column that tells its rows apart, and its axis: how the tables begin that have rows of every case.
fn of_case<'a, T>(
    columns: Columns<T>,
    (name, description): (&str, &str),
    get: impl Fn(&T) -> (CaseOf<'a>, &'static str) + Copy + 'static,
) -> Columns<T> {
    let case = "Name of the case: an axis with its value, a trap, or a sample.";
    let axis = "The axis the case lies on; `trap` and `sample` for those that lie on none.";
    columns
        .text("case", case, move |row| get(row).0.name)
        .key()
        .text(name, description, move |row| get(row).1)
        .key()
        .text("axis", axis, move |row| get(row).0.axis)
}

/// What was found of an invariant of a case.
type CheckRow<'a> = (CaseOf<'a>, &'a Finding);

fn checks<'a>() -> Columns<CheckRow<'a>> {
    // All of it is the same bits on any processor but what faer factorised: compliances of finite elements move by
    // 1e-9, and with them residuals by as many roundings, jumps and differences by 1e-12. Digits lost are of other
    // methods, or of geometry alone.
    let factorised = |column: Column| column.tolerance(1e-11, 1e-6).allows_nan();
    let columns = Columns::new("checks", "What was found of every invariant of every case.");
    of_case(columns, ("invariant", "What must hold."), |row: &CheckRow<'a>| (row.0, row.1.invariant))
        .float("value", "", "How far it is from holding, as the limit counts it.", |row| finite(row.1.value))
        .but(factorised)
        .float("limit", "", "What the value may be; NaN where the case is refused.", |row| finite(row.1.limit))
        .but(factorised)
        .text("verdict", "holds, broken or refused.", |row| row.1.verdict.word())
        .text("reason", "Why it is refused, or that the value is not a number.", |(_, finding)| {
            let strange = finding.verdict != Verdict::Refused && !finding.value.is_finite();
            if strange { format!("the value is {}", finding.value) } else { finding.reason.clone() }
        })
}

/// A case, its place on its axis, and what was found of one of its quantities.
type DigitsRow<'a> = (CaseOf<'a>, f64, &'a DigitsLost);

fn digits<'a>() -> Columns<DigitsRow<'a>> {
    let description = "The kernels' numbers against a second evaluation in twice the precision. SI.";
    let place = "Where the case lies on its axis: 0 at the first value, 1 at the last.";
    let lost = "15.95 + log10 of the relative difference, 0 at least.";
    let condition = "Relative change per relative change of the inputs.";
    let columns = Columns::new("digits", description);
    of_case(columns, ("quantity", "What is compared."), |row: &DigitsRow<'a>| (row.0, row.2.quantity))
        .float("place", "", place, |row| row.1)
        .float("value", "", "As the kernels compute it.", |row| finite(row.2.value))
        .but(Column::allows_nan)
        .float("exact", "", "As the second evaluation computes it.", |row| finite(row.2.exact))
        .but(Column::allows_nan)
        .float("digits_lost", "", lost, |row| row.2.lost)
        .float("condition", "", condition, |row| finite(row.2.condition))
        .but(Column::allows_nan)
}

/// What came of the cases of an axis.
#[derive(Default)]
struct Counts {
    cases: usize,
    computed: usize,
    holds: usize,
    broken: usize,
    refused: usize,
}

impl Counts {
    fn add(&mut self, report: &Report) {
        self.cases += 1;
        self.computed += usize::from(report.findings.iter().any(|finding| finding.verdict != Verdict::Refused));
        for finding in &report.findings {
            *match finding.verdict {
                Verdict::Holds => &mut self.holds,
                Verdict::Broken => &mut self.broken,
                Verdict::Refused => &mut self.refused,
            } += 1;
        }
    }
}

fn summary() -> Columns<(&'static str, Counts)> {
    let axis = "The axis; `trap` and `sample` for those that lie on none.";
    Columns::new("summary", "How many rows of `checks` hold, by axis.")
        .text("axis", axis, |row: &(&'static str, Counts)| row.0)
        .key()
        .integer("cases", "Cases that lie on it.", |row| row.1.cases)
        .integer("computed", "Cases that could be computed at all.", |row| row.1.computed)
        .integer("holds", "Rows that hold.", |row| row.1.holds)
        .integer("broken", "Rows that do not.", |row| row.1.broken)
        .integer("refused", "Rows that physics or the model excludes.", |row| row.1.refused)
}

/// A quantity in all its cases: from the fewest to the most digits lost, each with the name of its case.
type QuantityRow<'a> = (&'static str, Vec<(&'a DigitsLost, &'a str)>);

fn quantities<'a>() -> Columns<QuantityRow<'a>> {
    let last = |row: &QuantityRow<'a>| row.1[row.1.len() - 1];
    let beyond = |(found, _): &(&DigitsLost, &str)| found.lost - libm::log10(found.condition.max(1.0));
    Columns::new("quantities", "The most digits lost of each quantity.")
        .text("quantity", "What is compared.", |row: &QuantityRow<'a>| row.0)
        .key()
        .integer("cases", "Cases in which it is compared.", |row| row.1.len())
        .float("median", "", "Digits lost in the median of the cases.", |row| row.1[row.1.len() / 2].0.lost)
        .float("worst", "", "Most digits lost.", move |row| last(row).0.lost)
        .text("case", "Where that is.", move |row| last(row).1)
        .float("condition", "", "The condition number there.", move |row| finite(last(row).0.condition))
        .but(Column::allows_nan)
        .float("beyond_condition", "", "Most digits lost on top of what the condition takes.", move |row| {
            row.1.iter().map(beyond).fold(f64::NEG_INFINITY, f64::max)
        })
}

/// In the order of [`write`].
pub fn schemas() -> Vec<Schema> {
    vec![checks().schema(), digits().schema(), summary().schema(), quantities().schema()]
}

/// Name, axis, place on it, and what was found.
type Checked = (String, &'static str, f64, Report);

pub fn write(checked: &[Checked]) -> Result<Vec<Table>, TableError> {
    let (mut found, mut lost): (Vec<CheckRow>, Vec<DigitsRow>) = Default::default();
    let mut axes: BTreeMap<&str, Counts> = BTreeMap::new();
    let mut compared: BTreeMap<&str, Vec<(&DigitsLost, &str)>> = BTreeMap::new();
    for (name, axis, place, report) in checked {
        let case = CaseOf { name, axis };
        axes.entry(*axis).or_default().add(report);
        found.extend(report.findings.iter().map(|finding| (case, finding)));
        for digits in &report.digits {
            compared.entry(digits.quantity).or_default().push((digits, name));
            lost.push((case, *place, digits));
        }
    }
    for cases in compared.values_mut() {
        cases.sort_by(|one, two| one.0.lost.total_cmp(&two.0.lost));
    }
    let (axes, compared): (Vec<_>, Vec<_>) = (axes.into_iter().collect(), compared.into_iter().collect());
    Ok(vec![checks().table(&found)?, digits().table(&lost)?, summary().table(&axes)?, quantities().table(&compared)?])
}
