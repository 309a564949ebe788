//! What a paper printed, as a study states it: fields of entries and of printed tables.
//!
//! Must not know: what is compared with them.

use declare::Declared;
use declare::declared::Placed;

/// One of the paper's numbers or claims.
#[derive(Debug, Declared)]
pub struct Published {
    /// what it is, in words
    #[declared(example = "Largest transmission error")]
    pub label: Option<String>,
    /// where the paper says it: a table, an equation, a page
    #[declared(name = "where", example = "Table 3")]
    pub location: Option<String>,
    /// the computed cell, `stage.table[key=value, …].column`
    #[declared(example = "ste.summary[design=long, torque=100 N m].peak_to_peak")]
    pub cell: Option<Placed<String>>,
    /// or arithmetic over the names in `with`: + - * / ^ sqrt abs min max
    #[declared(example = "a / b - 1")]
    pub formula: Option<Placed<String>>,
    /// or a comparison that the paper says is true, in every row of its cells
    #[declared(example = "a < b")]
    pub claim: Option<Placed<String>>,
    /// what the names in a formula or claim stand for: cells or quantities
    #[declared(example = "stiffness.summary.mean")]
    pub with: Option<Vec<(String, Placed<String>)>>,
    /// the published value as printed, with its unit
    #[declared(example = "4.2 um")]
    pub value: Option<Placed<String>>,
    /// how far apart counts as equal: `digits` (half a unit in the last printed place), `1 %`, or a quantity
    #[declared(default = "digits")]
    pub tolerance: Placed<String>,
    /// where the computed value stands today, so that it cannot drift unseen
    pub expected: Option<Expected>,
    /// why they differ
    #[declared(example = "the paper rounds its stiffness")]
    pub because: Option<String>,
    /// arithmetic that proves the reason
    pub proof: Option<StatedProof>,
    /// a remark that claims no difference
    #[declared(example = "read off the figure")]
    pub note: Option<String>,
}

/// A table as it was printed: a line for each number.
#[derive(Debug, Declared)]
pub struct PrintedTable {
    /// where it is printed: a page, a section of a printout
    #[declared(name = "where", example = "Printout, page 3")]
    pub location: Option<String>,
    /// what the cells of its rows begin with, so that a row names a column alone
    #[declared(example = "pair.gears[gear=pinion]")]
    pub of: Option<Placed<String>>,
    /// how far apart counts as equal in rows that say nothing of it: `digits`, `1 %`, or a quantity
    #[declared(default = "digits")]
    pub tolerance: Placed<String>,
    /// why they differ, in rows that say nothing of it
    #[declared(example = "the program rounds the centre distance")]
    pub because: Option<String>,
    /// what is printed
    pub rows: Vec<PrintedRow>,
}

/// A number of a printed table.
#[derive(Debug, Declared)]
pub struct PrintedRow {
    /// what it is, in words
    #[declared(example = "Span measurement W_k")]
    pub label: String,
    /// the computed cell, or its column where the table says the rest
    #[declared(example = "tip_radius")]
    pub cell: Option<Placed<String>>,
    /// or arithmetic over the names in `let`
    #[declared(example = "a / b - 1")]
    pub formula: Option<Placed<String>>,
    /// the value as printed, with its unit
    #[declared(example = "33.129 mm")]
    pub value: Placed<String>,
    /// how far apart counts as equal in this row
    #[declared(example = "1 %")]
    pub tolerance: Option<Placed<String>>,
    /// where the computed value stands today, so that it cannot drift unseen
    pub expected: Option<Expected>,
    /// why they differ
    #[declared(example = "the program rounds its stiffness")]
    pub because: Option<String>,
    /// a remark that claims no difference
    #[declared(example = "read off the figure")]
    pub note: Option<String>,
}

impl PrintedTable {
    /// The rows as entries of their own.
    pub fn entries(self) -> impl Iterator<Item = Published> {
        let Self { location, of, tolerance, because, rows } = self;
        rows.into_iter().map(move |row| {
            let whole = |cell: Placed<String>| match &of {
                Some(of) if !cell.value.contains('.') => {
                    Placed { value: format!("{}.{}", of.value.trim(), cell.value.trim()), place: cell.place }
                }
                _ => cell,
            };
            Published {
                label: Some(row.label),
                location: location.clone(),
                cell: row.cell.map(whole),
                formula: row.formula,
                claim: None,
                with: None,
                value: Some(row.value),
                tolerance: row.tolerance.unwrap_or_else(|| tolerance.clone()),
                expected: row.expected,
                because: row.because.or_else(|| because.clone()),
                proof: None,
                note: row.note,
            }
        })
    }
}

/// Where a computed value stands.
#[derive(Debug, Declared)]
pub struct Expected {
    /// the value the study stands by, with its unit; for a claim the number of rows
    #[declared(example = "4.18 um")]
    pub value: Placed<String>,
    /// how far apart counts as equal: `digits` (half a unit in the last printed place), `1 %`, or a quantity
    #[declared(default = "digits")]
    pub tolerance: Placed<String>,
}

/// What proves a reason.
#[derive(Debug, Declared)]
pub struct StatedProof {
    /// a comparison that must hold; `published` and `computed` are known in it
    #[declared(example = "computed < published")]
    pub claim: Placed<String>,
    /// what its other names stand for: cells or quantities
    #[declared(example = "stiffness.summary.mean")]
    pub with: Option<Vec<(String, Placed<String>)>>,
}
