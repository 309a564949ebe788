//! What a formula is a quantity of, from what its names are: before any of their values is known.
//!
//! Must not know: values, but those that stand in the formula.

use evalexpr::{Node, Operator, Value};

use super::{Formula, OVER_ROWS, arguments, comparison, of_one_sort, plain};
use crate::stage::quantity::{Number, power, product};
use declare::units::{Dimension, RATIO};

/// A dimension, and a value where one stands in the formula; NaN elsewhere. None where nothing can be said.
type Known = Option<Number>;

impl Formula {
    /// Its dimension; `of` says that of a name. None for what is true or false, and where that of a name is not known.
    ///
    /// # Errors
    /// As [`Formula::evaluate`], of units that do not go together.
    pub fn dimension(&self, of: &dyn Fn(&str) -> Option<Dimension>) -> Result<Option<Dimension>, String> {
        Ok(known(&self.root, of)?.map(|number| number.dimension))
    }

    /// Whether a number stands in it, which has no unit.
    #[must_use]
    pub fn has_numbers(&self) -> bool {
        has_numbers(&self.root)
    }
}

fn has_numbers(node: &Node) -> bool {
    matches!(node.operator(), Operator::Const { value: Value::Int(_) | Value::Float(_) })
        || node.children().iter().any(has_numbers)
}

fn known(node: &Node, of: &dyn Fn(&str) -> Option<Dimension>) -> Result<Known, String> {
    let some = |dimension: Dimension| Some(Number { si: f64::NAN, dimension });
    let all = |nodes: Vec<&Node>| nodes.into_iter().map(|node| known(node, of)).collect::<Result<Vec<Known>, String>>();
    let sides = || all(node.children().iter().collect());
    // Of all, if each is known.
    let alike = |values: Vec<Known>, at: &str, sign: &str| {
        let values: Option<Vec<Number>> = values.into_iter().collect();
        Ok::<_, String>(values.map(|values| of_one_sort(&values, at, sign)).transpose()?.flatten().and_then(some))
    };
    match node.operator() {
        Operator::Const { value: Value::Float(si) } => Ok(Some(Number { si: *si, dimension: RATIO })),
        Operator::Const { value: Value::Int(value) } => Ok(Some(Number { si: *value as f64, dimension: RATIO })),
        Operator::VariableIdentifierRead { identifier } => Ok(of(identifier).and_then(some)),
        Operator::RootNode | Operator::Neg => Ok(sides()?.pop().flatten()),
        Operator::Add => alike(sides()?, "at", "+"),
        Operator::Sub => alike(sides()?, "at", "-"),
        Operator::Mul | Operator::Div => {
            let sign = if matches!(node.operator(), Operator::Mul) { 1 } else { -1 };
            let [Some(a), Some(b)] = sides()?[..] else { return Ok(None) };
            Ok(some(product(a.dimension, b.dimension, sign)))
        }
        Operator::Exp => {
            let [Some(base), Some(exponent)] = sides()?[..] else { return Ok(None) };
            // The exponent may be a cell, whose value is not known yet.
            if exponent.si.is_nan() && base.dimension != RATIO {
                return Ok(None);
            }
            Ok(some(power(base.dimension, exponent)?))
        }
        operator if comparison(operator).is_some() => {
            alike(sides()?, "at", comparison(operator).unwrap_or_default()).map(|_| None)
        }
        Operator::FunctionIdentifier { identifier } => {
            let mut values = all(arguments(node.children()))?;
            match identifier.as_str() {
                "min" | "max" => alike(values, "in", identifier),
                "sqrt" => match values.pop().flatten() {
                    Some(value) => Ok(some(power(value.dimension, Number::plain(0.5))?)),
                    None => Ok(None),
                },
                "sin" | "cos" | "tan" | "atan" => {
                    if let Some(value) = values.pop().flatten() {
                        plain(value, identifier)?;
                    }
                    Ok(some(RATIO))
                }
                name if OVER_ROWS.contains(&name) || name == "abs" => Ok(values.pop().flatten()),
                _ => Ok(None),
            }
        }
        _ => sides().map(|_| None),
    }
}
