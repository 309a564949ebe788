//! What a comparison found. Written as it stands for `--format json`: additions only.
//!
//! Must not know: how it is found or shown.

use serde::Serialize;

use crate::table::data::Cell;

/// How far two of a kind are apart. The order is that of weight.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Difference {
    #[default]
    Same,
    WithinTolerance,
    /// It could not be compared.
    Unknown,
    Changed,
    Removed,
    Added,
}

impl Difference {
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Same => "same",
            Self::WithinTolerance => "within tolerance",
            Self::Unknown => "could not be compared",
            Self::Changed => "changed",
            Self::Removed => "removed",
            Self::Added => "added",
        }
    }

    /// So that colour is never alone.
    #[must_use]
    pub const fn sign(self) -> &'static str {
        match self {
            Self::Same => "=",
            Self::WithinTolerance => "≈",
            Self::Unknown => "?",
            Self::Changed => "≠",
            Self::Removed => "−",
            Self::Added => "+",
        }
    }

    /// Whether it is a difference beyond tolerance.
    #[must_use]
    pub fn differs(self) -> bool {
        self >= Self::Changed
    }

    /// Of what is made of several: changed as soon as one part differs, else unknown as soon as one is.
    #[must_use]
    pub fn of_parts(parts: impl Iterator<Item = Self>) -> Self {
        parts.max().unwrap_or(Self::Same).min(Self::Changed)
    }
}

/// The whole comparison.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// What is compared with what, in words: `HEAD (59b124e)`, `the working tree`.
    pub before: String,
    pub after: String,
    pub state: Difference,
    /// Files that are not what their manifest says: whatever else is said of their tables goes by the manifest.
    pub damaged: Vec<Damage>,
    /// Verdicts on published numbers that are other words now, those that need attention first.
    pub verdicts: Vec<Flip>,
    pub studies: Vec<StudyDiff>,
    /// What could not be compared at all, and why.
    pub problems: Vec<String>,
    /// Studies whose later results are not those of their files and of this program, as far as somebody looked.
    pub stale: Vec<Stale>,
    /// What was left out on purpose, and why.
    pub remarks: Vec<String>,
}

/// Results that are not those of the study as it is now.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Stale {
    pub study: String,
    /// A sentence.
    pub problem: String,
}

/// A file that is not what its manifest says.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Damage {
    /// The side, in words.
    pub at: String,
    pub study: String,
    pub file: String,
    /// A phrase that follows the file's name.
    pub problem: String,
}

/// A verdict that is another word than it was.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Flip {
    pub study: String,
    /// The report stage.
    pub stage: String,
    pub label: String,
    /// Where the paper says it.
    pub location: String,
    /// The computed cell, formula or claim.
    pub cell: String,
    /// None for an entry that was not there.
    pub before: Option<String>,
    /// None for an entry that is gone.
    pub after: Option<String>,
    pub published: String,
    pub computed_before: Option<f64>,
    pub computed_after: Option<f64>,
    pub unit: String,
    /// Of a claim: in how many rows it held and holds.
    pub found_before: String,
    pub found_after: String,
    pub needs_attention: bool,
}

#[derive(Clone, Debug, Serialize)]
pub struct StudyDiff {
    pub name: String,
    /// The name of the study before: most of its tables are the same.
    pub renamed_from: Option<String>,
    pub state: Difference,
    /// What is to be known of the results themselves: from another text of the study, of an earlier format.
    pub remarks: Vec<String>,
    pub stages: Vec<StageDiff>,
}

#[derive(Clone, Debug, Serialize)]
pub struct StageDiff {
    pub name: String,
    pub kind: String,
    /// What the stage was called before: the same kind, the same tables.
    pub renamed_from: Option<String>,
    pub state: Difference,
    /// What it was computed from that differs; may say something although every value is the same.
    pub why: Vec<Reason>,
    pub tables: Vec<TableDiff>,
}

/// One part of what a stage is computed from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Reason {
    pub part: ChangedPart,
    /// The field, the port.
    pub what: String,
    /// Of an input: the tables of the stage behind the port that are other ones, `stage.table`; the stage alone where none
    /// is.
    pub from: Vec<String>,
    pub before: Option<String>,
    pub after: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ChangedPart {
    Kind,
    Config,
    Input,
    Code,
    Seed,
    /// What the rest of the study asks of the stage.
    Demand,
    /// It failed or was skipped: its tables are those of an earlier run.
    Status,
    /// Nothing that is recorded.
    Unknown,
}

impl ChangedPart {
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Kind => "kind",
            Self::Config => "config",
            Self::Input => "input",
            Self::Code => "code",
            Self::Seed => "seed",
            Self::Demand => "demand",
            Self::Status => "status",
            Self::Unknown => "unknown",
        }
    }
}

#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct TableDiff {
    /// `stage.table`.
    pub name: String,
    pub state: Difference,
    /// Whether values were compared, or content hashes alone.
    pub by_values: bool,
    /// Why values were not compared, or rows not matched.
    pub note: String,
    pub rows_before: usize,
    pub rows_after: usize,
    pub rows_added: usize,
    pub rows_removed: usize,
    /// Keys of the first few.
    pub added: Vec<Key>,
    pub removed: Vec<Key>,
    pub schema: Vec<SchemaChange>,
    /// Columns in which anything differs.
    pub columns: Vec<ColumnDiff>,
    /// Rows that are beyond tolerance by most, measured by each column's largest value.
    pub worst: Vec<Worst>,
    /// Of a table that holds sampled curves. Where these are not sampled in the same places, nothing is said of rows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub curves: Option<CurvesDiff>,
}

/// Sampled curves of both tables, each as a whole.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CurvesDiff {
    /// The column over which they are sampled.
    pub along: String,
    pub along_unit: String,
    /// Curves that are in both tables.
    pub compared: usize,
    /// Those that are not the same, and those that differ by more than the tolerance.
    pub changed: usize,
    pub beyond: usize,
    /// Sampled in other places.
    pub resampled: usize,
    /// Those that begin or end elsewhere, by more than the tolerance of that column.
    pub moved_ends: usize,
    pub added: Vec<Key>,
    pub removed: Vec<Key>,
    /// Columns in which anything differs, the quantity that the curves are of first.
    pub columns: Vec<CurveColumn>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CurveColumn {
    pub name: String,
    pub unit: String,
    /// Curves that are not the same, and those that differ by more than the tolerance.
    pub changed: usize,
    pub beyond: usize,
    pub largest: Option<Vertical>,
}

/// Two curves where they are furthest apart; interpolated where one is not sampled.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Vertical {
    /// `after − before`.
    pub difference: f64,
    pub before: f64,
    pub after: f64,
    /// Where, in the column over which they are sampled.
    pub at: f64,
    /// Of the curve.
    pub key: Key,
}

/// Column and value of a row's key.
pub type Key = Vec<(String, Value)>;

#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct SchemaChange {
    pub column: String,
    /// `added`, `removed`, `type`, `unit`, `key`, `tolerance`.
    pub what: &'static str,
    pub before: String,
    pub after: String,
    /// Whether it is a difference; a changed tolerance alone is none.
    pub differs: bool,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ColumnDiff {
    pub name: String,
    /// Of both values; where the unit changed, that of the later table; where each row has its own, that of the row that is
    /// shown.
    pub unit: String,
    /// Rows that are in both tables.
    pub compared: usize,
    /// Values that are not the same.
    pub changed: usize,
    /// Values that differ by more than the tolerance.
    pub beyond: usize,
    pub absolute_tolerance: f64,
    pub relative_tolerance: f64,
    pub largest_absolute: Option<Extreme>,
    /// Relative to the larger of the two values.
    pub largest_relative: Option<Extreme>,
    /// As a multiple of what the tolerance allows: beyond it above 1, infinite for what is not a number.
    pub largest_over: Option<Extreme>,
}

impl ColumnDiff {
    /// The values that stand for all that changed: those furthest apart, and of words the first.
    #[must_use]
    pub fn shown(&self) -> Option<&Extreme> {
        self.largest_absolute.as_ref().or(self.largest_over.as_ref())
    }
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Extreme {
    /// `after − before`; its size over the larger of the two; or over what is allowed.
    pub difference: f64,
    pub before: Value,
    pub after: Value,
    pub key: Key,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Worst {
    pub key: Key,
    /// The column that is beyond tolerance by most in this row.
    pub column: String,
    pub unit: String,
    pub before: Value,
    pub after: Value,
    /// Of numbers: `after − before`.
    pub difference: Option<f64>,
}

/// A cell; NaN becomes `null`.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Value {
    Float(f64),
    Integer(i64),
    Text(String),
    Flag(bool),
}

impl From<Cell> for Value {
    fn from(cell: Cell) -> Self {
        match cell {
            Cell::Float(value) => Self::Float(value),
            Cell::Integer(value) => Self::Integer(value),
            Cell::Text(value) => Self::Text(value),
            Cell::Flag(value) => Self::Flag(value),
        }
    }
}
