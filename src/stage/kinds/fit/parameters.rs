//! What is fitted: fields within their bounds.
//!
//! Must not know: what is met.

use declare::error::Diagnostic;
use declare::record::varied::{Axis, Form, Spread, Values, Varied};
use declare::units::showing;

/// The column of a parameter's standard deviation.
pub fn deviation_name(name: &str) -> String {
    format!("{name}_standard_deviation")
}

/// Columns of `solutions` that no parameter can be called.
const RESERVED: [&str; 8] = ["solution", "sum_of_squares", "largest", "meets", "starts", "steps", "settled", "edge"];

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

/// Those of the fields that follow from nothing.
///
/// # Errors
/// A field that cannot be fitted.
pub fn parameters(axes: &[Axis]) -> Result<Vec<Parameter>, Diagnostic> {
    let mut parameters: Vec<Parameter> = Vec::new();
    for axis in axes {
        let clashes =
            RESERVED.contains(&axis.name.as_str()) || axes.iter().any(|other| deviation_name(&other.name) == axis.name);
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
    Ok(parameters)
}

/// The values that the study has; none where it has several of a field, or one outside of the bounds.
pub fn own_values(varied: &Varied, parameters: &[Parameter]) -> Option<Vec<f64>> {
    let free = varied.axes.iter().filter(|axis| !matches!(axis.values, Values::Follows(_)));
    free.zip(parameters)
        .map(|(axis, parameter)| {
            let value = varied.own(axis)?;
            (parameter.bounds.0 <= value && value <= parameter.bounds.1).then_some(value)
        })
        .collect()
}
