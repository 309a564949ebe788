//! What is fitted: fields within their bounds, and fields that follow from them.
//!
//! Must not know: what is met.

use super::tables;
use crate::stage::formula::Formula;
use declare::error::Diagnostic;
use declare::record::Value;
use declare::record::varied::{Axis, Form, Spread, Values, Varied};
use declare::units::showing;

/// A field that is fitted.
#[derive(Clone, Debug)]
pub struct Parameter {
    pub name: String,
    pub path: String,
    pub unit: String,
    /// In SI.
    pub bounds: (f64, f64),
    /// Whether they are about a value that the study states.
    pub is_interval: bool,
}

impl Parameter {
    /// In its unit.
    pub fn shown(&self, si: f64) -> f64 {
        showing(&self.unit)(si)
    }
}

/// Where the value of a varied field comes from.
pub enum Source {
    /// Index of the parameter.
    Free(usize),
    Follows(Formula),
}

/// The parameters, and where the value of each axis comes from.
///
/// # Errors
/// A field that cannot be fitted, or a formula that cannot be read.
pub fn parameters(axes: &[Axis]) -> Result<(Vec<Parameter>, Vec<Source>), Diagnostic> {
    let mut parameters: Vec<Parameter> = Vec::new();
    for axis in axes {
        let clashes = tables::RESERVED.contains(&axis.name.as_str())
            || axes.iter().any(|other| tables::deviation_name(&other.name) == axis.name);
        if clashes {
            let message = format!("`{}` is a column of the table `solutions`; take another name", axis.name);
            return Err(Diagnostic::new(message).at(axis.place));
        }
        let (bounds, is_interval) = match &axis.values {
            Values::Between(low, high) => ((*low, *high), false),
            // What was printed rounded is somewhere within.
            Values::Spread(Spread { form: Form::Within(half, _), about, .. }) => {
                (((about - half).max(axis.range.0), (about + half).min(axis.range.1)), true)
            }
            Values::Follows(_) => continue,
            Values::Each(_) | Values::Spread(_) => {
                return Err(Diagnostic::new(format!("`{}` has no bounds to be fitted within", axis.name))
                    .at(axis.values_place)
                    .help("write `from` and `to` without a `count`, or `within: ± …` of the value in the study"));
            }
        };
        if axis.multiple.is_some() {
            let message =
                format!("`{}` takes whole numbers, which cannot be fitted: nothing lies between them", axis.name);
            return Err(Diagnostic::new(message).at(axis.place).help("sweep them: `kind: sweep` takes all `values`"));
        }
        let (name, path, unit) = (axis.name.clone(), axis.path.clone(), axis.unit.clone());
        parameters.push(Parameter { name, path, unit, bounds, is_interval });
    }
    if parameters.is_empty() {
        return Err(Diagnostic::new("nothing is free: every field follows from others").at(axes[0].values_place));
    }
    let names: Vec<&str> = parameters.iter().map(|parameter| parameter.name.as_str()).collect();
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
    let sources = axes.iter().map(source).collect::<Result<Vec<_>, _>>()?;
    Ok((parameters, sources))
}

/// The values that the study has; none where it has several of a field, or one outside of the bounds.
pub fn own_values(varied: &Varied, parameters: &[Parameter]) -> Option<Vec<f64>> {
    let free = varied.axes.iter().filter(|axis| !matches!(axis.values, Values::Follows(_)));
    free.zip(parameters)
        .map(|(axis, parameter)| {
            let entry = axis.slot.entry(&varied.stages[axis.stage].record)?;
            let value = match &entry.value {
                Value::Quantity(value) | Value::Number(value) => *value,
                Value::Axis(values) if values.len() == 1 => values[0],
                _ => return None,
            };
            (parameter.bounds.0 <= value && value <= parameter.bounds.1).then_some(value)
        })
        .collect()
}
