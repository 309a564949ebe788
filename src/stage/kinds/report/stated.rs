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

/// A table as it was printed: a line for each number, or for those that stand side by side.
#[derive(Debug, Declared)]
pub struct PrintedTable {
    /// where it is printed: a page, a section of a printout
    #[declared(name = "where", example = "Printout, page 3")]
    pub location: Option<String>,
    /// what the cells of rows of one number begin with, so that a row, and a name in a formula, is a column alone
    #[declared(example = "rating.summary")]
    pub of: Option<Placed<String>>,
    /// for numbers that stand side by side: what each is called, and what its cells begin with
    #[declared(example = "pair.inspection[gear=pinion]")]
    pub columns: Option<Vec<(String, Placed<String>)>>,
    /// what names stand for in the formulas of its rows: a cell or quantity, or one for each of `columns`
    #[declared(name = "let", example = "33.129 mm")]
    pub names: Option<Vec<(String, Vec<Placed<String>>)>>,
    /// how far apart counts as equal in rows that say nothing of it: `digits`, `1 %`, or a quantity
    #[declared(default = "digits")]
    pub tolerance: Placed<String>,
    /// why they differ, in rows that say nothing of it
    #[declared(example = "the program rounds the centre distance")]
    pub because: Option<String>,
    /// what is printed
    pub rows: Vec<PrintedRow>,
}

/// A number of a printed table, or those that stand side by side.
#[derive(Debug, Declared)]
pub struct PrintedRow {
    /// what it is, in words
    #[declared(example = "Span measurement W_k")]
    pub label: String,
    /// the computed cell, or its column where the table says the rest; or one for each value
    #[declared(example = "tip_radius")]
    pub cell: Option<Vec<Placed<String>>>,
    /// or arithmetic over names in `let` and columns of where the cells begin; or one for each value
    #[declared(example = "a / b - 1")]
    pub formula: Option<Vec<Placed<String>>>,
    /// the value as printed, with its unit; or those of `columns`, `none` where nothing is printed
    #[declared(example = "33.129 mm")]
    pub value: Vec<Placed<String>>,
    /// how far apart counts as equal in this row
    #[declared(example = "1 %")]
    pub tolerance: Option<Placed<String>>,
    /// where the computed value stands today, so that it cannot drift unseen; one for each that is printed
    pub expected: Option<Vec<Expected>>,
    /// why they differ
    #[declared(example = "the program rounds its stiffness")]
    pub because: Option<String>,
    /// a remark that claims no difference
    #[declared(example = "read off the figure")]
    pub note: Option<String>,
}

/// Where a computed value stands.
#[derive(Clone, Debug, Declared)]
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
