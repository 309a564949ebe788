//! Whether what an entry sets against each other are quantities of one sort, before any of them is computed.
//!
//! Must not know: values.

use super::ReportEntry;
use super::subject::{GIVEN, Proof, Subject};
use crate::stage::DimensionOf;
use crate::stage::formula::Formula;
use crate::stage::operand::Source;
use crate::stage::operand::names::Operands;
use crate::stage::quantity::Number;
use crate::stage::target::Target;
use declare::error::{Diagnostic, Place};
use declare::units::Dimension;

/// What helps where a bare number stands beside a quantity.
const NAME_IT: &str =
    "a number in a formula has no unit; write `limit` there, and beside it `with: { limit: 3 um }`, or in `let`";

impl ReportEntry {
    /// What does not go together in its formulas; `of` has the dimension of a cell.
    pub fn at_odds(&self, of: DimensionOf) -> Vec<Diagnostic> {
        let published = self.published.as_ref().map(|target| target.stated.dimension);
        let mut found = Vec::new();
        if let Subject::Formula(formula, with) | Subject::Claim(formula, with) = &self.subject {
            match dimension(formula, with, None, self.place, of) {
                Err(wrong) => found.push(wrong),
                Ok(Some(dimension)) => {
                    let number = Number { si: f64::NAN, dimension };
                    let wrong = |target: &Target| {
                        let message = target.stated.check_dimension(number).err()?;
                        Some(Diagnostic::new(message).at(target.place))
                    };
                    found.extend(self.published.as_ref().and_then(wrong));
                }
                Ok(None) => {}
            }
        }
        if let Some(Proof { claim, place, with }) = &self.proof
            && let Err(wrong) = dimension(claim, with, published, *place, of)
        {
            found.push(Diagnostic { message: format!("proof: {}", wrong.message), ..wrong });
        }
        found
    }
}

/// Of a formula with these names; the value that is published and the one that is computed are of one sort.
fn dimension(
    formula: &Formula,
    with: &Operands,
    published: Option<Dimension>,
    place: Place,
    of: DimensionOf,
) -> Result<Option<Dimension>, Diagnostic> {
    let of_name = |name: &str| {
        let Some((_, operand)) = with.iter().find(|(known, _)| known == name) else {
            return published.filter(|_| GIVEN.contains(&name));
        };
        match &operand.source {
            Source::Cells(cell) => of(cell),
            Source::Quantities { numbers, .. } => numbers.first().map(|number| number.dimension),
        }
    };
    formula.dimension(&of_name).map_err(|message| {
        let wrong = Diagnostic::new(message).at(place);
        if formula.has_numbers() { wrong.help(NAME_IT) } else { wrong }
    })
}
