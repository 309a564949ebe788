//! The tables of limits.
//!
//! Must not know: how anything in them is found.

use super::search::{End, Parameter, Side};
use studygraph::table::columns::Columns;

/// The key of `admitted`, which no parameter can be called.
pub const SIDE: &str = "side";

/// An end of a parameter.
pub struct LimitRow<'a> {
    pub parameter: &'a Parameter,
    pub end: &'a End,
}

impl<'a> LimitRow<'a> {
    fn value(&self) -> f64 {
        self.parameter.shown(self.end.admitted)
    }

    fn reason(&self) -> &'a str {
        self.end.refused.as_ref().map_or("", |(_, reason)| reason)
    }
}

pub fn limits<'a>() -> Columns<LimitRow<'a>> {
    let value = "The outermost value that is admitted, or the bound where nothing is refused up to it.";
    let reason = "Why the next value beyond is refused, in the words of the stage; empty where none is.";
    Columns::new("limits", "How far each parameter can go to either side, the others being as in the study.")
        .text("parameter", "Name of the parameter.", |row: &LimitRow<'a>| row.parameter.name.as_str())
        .key()
        .text(SIDE, "Lower or upper.", |row| row.end.side.word())
        .key()
        .text("field", "The field that it is.", |row| row.parameter.path.as_str())
        .text("unit", "Unit of the value.", |row| row.parameter.unit.as_str())
        .shown("value", "", value, LimitRow::value)
        .flag("refused", "Whether anything is refused beyond it.", |row| row.end.refused.is_some())
        .text("reason", reason, LimitRow::reason)
        .integer("evaluations", "Values that were tried to this side.", |row| row.end.evaluations)
}

/// One end of all parameters, in their units.
pub struct AdmittedRow {
    side: Side,
    values: Vec<f64>,
}

impl AdmittedRow {
    /// Of both ends.
    pub fn both(rows: &[LimitRow]) -> [Self; 2] {
        Side::BOTH.map(|side| {
            let of_side = rows.iter().filter(|row| row.end.side == side);
            Self { side, values: of_side.map(LimitRow::value).collect() }
        })
    }
}

/// What a report compares with a quantity: a column has one unit, and parameters have theirs.
pub fn admitted(parameters: &[Parameter]) -> Columns<AdmittedRow> {
    let all = Columns::new("admitted", "The values of `limits`, each parameter in a column with its unit.")
        .text(SIDE, "Lower or upper.", |row: &AdmittedRow| row.side.word())
        .key();
    parameters.iter().enumerate().fold(all, |all, (at, parameter)| {
        let description = format!("Outermost value of `{}` that is admitted.", parameter.path);
        all.shown(&parameter.name, &parameter.unit, &description, move |row| row.values[at])
    })
}
