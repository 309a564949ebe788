//! Varied fields of which some follow from the others by formulas: the values of all for values of the others.
//!
//! Must not know: where the values of the others come from.

use crate::stage::formula::{Formula, Names, Outcome};
use crate::stage::quantity::Number;
use declare::error::{Diagnostic, Place};
use declare::record::varied::{Axis, Values};
use declare::units::{parse_quantity, showing};

/// Where the value of a field comes from.
enum Source {
    /// Index among the free ones.
    Free(usize),
    Follows(Formula),
}

/// Varied fields, at least one of them free.
pub struct Followed {
    axes: Vec<Axis>,
    /// By axis.
    sources: Vec<Source>,
    /// Of the free ones, the indices of their axes.
    free: Vec<usize>,
}

impl Followed {
    /// # Errors
    /// When every field follows from others, or a formula cannot be read.
    pub fn new(axes: &[Axis]) -> Result<Self, Diagnostic> {
        let is_free = |axis: &Axis| !matches!(axis.values, Values::Follows(_));
        let free: Vec<usize> = (0..axes.len()).filter(|index| is_free(&axes[*index])).collect();
        if free.is_empty() {
            let place = axes.first().map_or_else(Place::default, |axis| axis.values_place);
            return Err(Diagnostic::new("nothing is free: every field follows from others").at(place));
        }
        let names: Vec<&str> = free.iter().map(|index| axes[*index].name.as_str()).collect();
        let source = |axis: &Axis| {
            let Values::Follows(text) = &axis.values else {
                return Ok(Source::Free(names.iter().position(|name| *name == axis.name).unwrap_or_default()));
            };
            let wrong = |message: String| Diagnostic::new(message).at(axis.values_place);
            let formula = Formula::parse(text, &names).map_err(wrong)?;
            if formula.is_claim() {
                return Err(wrong(format!("`{text}` is true or false; `follows` is a number")));
            }
            Ok(Source::Follows(formula))
        };
        let sources = axes.iter().map(source).collect::<Result<_, _>>()?;
        Ok(Self { axes: axes.to_vec(), sources, free })
    }

    /// All of them, in the order of the study.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// The values of all axes in SI for those of the free ones. Formulas are of the numbers in the units of the columns, and
    /// give one in the unit of their own.
    ///
    /// # Errors
    /// A value that a field cannot have, or a formula that has none.
    pub fn values(&self, free: &[f64]) -> Result<Vec<f64>, String> {
        let number = |name: &str, _row: usize| {
            let at = self.free.iter().position(|index| self.axes[*index].name == name)?;
            Some(Number::plain(showing(&self.axes[self.free[at]].unit)(free[at])))
        };
        let names = Names { value: &number, row: 0, rows: 1 };
        let one = |(axis, source): (&Axis, &Source)| match source {
            Source::Free(at) => Ok(free[*at]),
            Source::Follows(formula) => followed(axis, formula, names),
        };
        self.axes.iter().zip(&self.sources).map(one).collect()
    }
}

fn followed(axis: &Axis, formula: &Formula, names: Names) -> Result<f64, String> {
    let Outcome::Number(number) = formula.evaluate(names)? else {
        return Err("a formula gives a number".to_owned());
    };
    let unit = &axis.unit;
    let text = format!("{:e} {unit}", number.si);
    let value =
        if unit.is_empty() { number.si } else { parse_quantity(&text).map_err(|error| error.to_string())?.value };
    let (low, high) = axis.range;
    let is_whole = axis.multiple.is_none_or(|multiple| value % multiple as f64 == 0.0);
    if value < low || value > high || !is_whole {
        return Err(format!("`{}` would be {}, which `{}` cannot be", axis.name, text.trim_end(), axis.path));
    }
    Ok(value)
}
