//! Arithmetic with dimensions: `F / k1 - F / k2 > published`.
//!
//! The library parses; the tree is walked here, because a formula must not divide whole numbers (`1 / 2` is a half), must
//! not add newtons to metres, and must give the same bits on every machine. Allowed: `+ - * / ^`, comparisons, `&&`,
//! `||`, `!`, sqrt, abs, min, max, sin, cos, tan, atan, and over all rows of its operands mean, rms, sum. Values are SI; an
//! angle counts as a plain number. Must not know: tables, entries.

#[cfg(test)]
mod tests;
mod units;

use std::collections::BTreeSet;

use evalexpr::{EvalexprError, Node, Operator, Value, build_operator_tree};

use super::quantity::{Number, described, power, product, shown, wider};
use declare::error::suggest;
use declare::units::{Dimension, RATIO};

/// Longer formulas are refused: nobody reads them, and the parser's recursion stays shallow.
const LONGEST: usize = 600;
const FUNCTIONS: [&str; 11] = ["abs", "atan", "cos", "max", "mean", "min", "rms", "sin", "sqrt", "sum", "tan"];
/// Those that make one number of all rows.
const OVER_ROWS: [&str; 3] = ["mean", "rms", "sum"];

/// What an expression gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    Number(Number),
    Truth(bool),
}

/// What the names in a formula stand for, in one row of several.
#[derive(Clone, Copy)]
pub struct Names<'a> {
    pub value: &'a dyn Fn(&str, usize) -> Option<Number>,
    pub row: usize,
    pub rows: usize,
}

/// A parsed and checked expression.
#[derive(Debug)]
pub struct Formula {
    pub text: String,
    root: Node,
    is_claim: bool,
}

impl Formula {
    /// Reads an expression whose names are all in `names`.
    ///
    /// # Errors
    /// A sentence: what cannot be read, or which operator, function or name is not known.
    pub fn parse(text: &str, names: &[&str]) -> Result<Self, String> {
        if text.trim().is_empty() {
            return Err("the formula is empty".to_owned());
        }
        let length = text.chars().count();
        if length > LONGEST {
            return Err(format!("the formula has {length} characters; at most {LONGEST} are read"));
        }
        refuse_foreign(text)?;
        let root = build_operator_tree(text).map_err(|error| unreadable(text, &error))?;
        let is_claim = check(&root, names)?;
        Ok(Self { text: text.trim().to_owned(), root, is_claim })
    }

    /// Whether it is true or false rather than a number.
    #[must_use]
    pub fn is_claim(&self) -> bool {
        self.is_claim
    }

    /// The names that occur in it.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.root.iter_variable_identifiers()
    }

    /// Whether a name is used outside of functions over all rows, so that it must stand for one number at a time.
    #[must_use]
    pub fn row_by_row(&self, name: &str) -> bool {
        row_by_row(&self.root, name)
    }

    /// # Errors
    /// Units that do not go together, or a result that is not finite.
    pub fn evaluate(&self, names: Names) -> Result<Outcome, String> {
        evaluate(&self.root, names)
    }

    /// Both sides of every comparison as numbers: `2.867 µm > 2.316 µm`. Lengths and the like are given in `unit` when
    /// it fits.
    ///
    /// # Errors
    /// As [`Formula::evaluate`].
    pub fn with_numbers(&self, names: Names, unit: &str) -> Result<String, String> {
        with_numbers(&self.root, names, unit)
    }
}

/// The names in a text, each once, if it can be read.
#[must_use]
pub fn names_in(text: &str) -> Option<BTreeSet<String>> {
    let can_be_read = text.chars().count() <= LONGEST && refuse_foreign(text).is_ok();
    let root = can_be_read.then(|| build_operator_tree(text).ok())??;
    Some(root.iter_variable_identifiers().map(str::to_owned).collect())
}

/// Refuses what the library reads and nobody means.
fn refuse_foreign(text: &str) -> Result<(), String> {
    if let Some(sign) = ["//", "/*"].into_iter().find(|sign| text.contains(sign)) {
        return Err(format!("`{text}` has `{sign}`, which is no sign of a formula: a division is one `/`"));
    }
    if text.contains(['[', ']']) {
        return Err(format!("`{text}` has a cell with `[…]`; name it in `let` or `with`, and write the name here"));
    }
    let mut words = text.split(|character: char| !character.is_alphanumeric());
    match words.find(|word| word.starts_with("0x") || word.starts_with("0X")) {
        Some(word) => Err(format!("`{word}` is a hexadecimal number; write it with decimal digits")),
        None => Ok(()),
    }
}

/// Why there is no expression, in words of formulas rather than of trees.
fn unreadable(text: &str, error: &EvalexprError) -> String {
    if !matches!(error, EvalexprError::AppendedToLeafNode) {
        return format!("`{text}` cannot be read: {error}");
    }
    let words: Vec<&str> = text.split_whitespace().collect();
    let with_unit = words.windows(2).find(|pair| {
        let is_number = pair[0].trim_start_matches(['(', '-']).parse::<f64>().is_ok();
        is_number && pair[1].starts_with(|first: char| first.is_alphabetic() || first == '°')
    });
    match with_unit {
        Some(pair) => format!(
            "`{text}` has a number with a unit, `{}`; write a name there, and what it stands for beside the formula: \
             `with: {{ limit: {} }}`, in a report also in `let`",
            pair.join(" "),
            pair.join(" ").trim_matches(['(', ')'])
        ),
        None => format!("`{text}` has two values without an operator between them"),
    }
}

/// Checks names, operators and functions; says whether the node is true or false rather than a number.
fn check(node: &Node, names: &[&str]) -> Result<bool, String> {
    let children = node.children();
    // Every side of an operator must be there and be of one sort: numbers, or something true or false.
    let sides = |sign: &str, count: usize, are_truths: bool| {
        if children.len() != count {
            return Err(format!("a value is missing at `{sign}`"));
        }
        for child in children {
            if check(child, names)? != are_truths {
                let wanted = if are_truths {
                    "joins comparisons, not numbers"
                } else {
                    "needs numbers, not something true or false"
                };
                return Err(format!("`{sign}` {wanted}"));
            }
        }
        Ok(())
    };
    match node.operator() {
        Operator::RootNode => match children {
            [child] => check(child, names),
            _ => Err("something is missing between brackets".to_owned()),
        },
        Operator::Add => sides("+", 2, false).map(|()| false),
        Operator::Sub => sides("-", 2, false).map(|()| false),
        Operator::Neg => sides("-", 1, false).map(|()| false),
        Operator::Mul => sides("*", 2, false).map(|()| false),
        Operator::Div => sides("/", 2, false).map(|()| false),
        Operator::Exp if children.first().is_some_and(|base| *base.operator() == Operator::Exp) => {
            Err("`a^b^c` can be read in two ways; write brackets, `(a^b)^c` or `a^(b^c)`".to_owned())
        }
        Operator::Exp => sides("^", 2, false).map(|()| false),
        operator if comparison(operator).is_some() => {
            sides(comparison(operator).unwrap_or(""), 2, false).map(|()| true)
        }
        Operator::And => sides("&&", 2, true).map(|()| true),
        Operator::Or => sides("||", 2, true).map(|()| true),
        Operator::Not => sides("!", 1, true).map(|()| true),
        Operator::Const { value: Value::Int(_) | Value::Float(_) } => Ok(false),
        Operator::VariableIdentifierRead { identifier } => {
            if names.contains(&identifier.as_str()) {
                Ok(false)
            } else {
                Err(format!("`{identifier}` is not given; {}", suggest(identifier, names.iter().copied())))
            }
        }
        Operator::FunctionIdentifier { identifier } => {
            if !FUNCTIONS.contains(&identifier.as_str()) {
                return Err(format!("there is no function `{identifier}`; {}", suggest(identifier, FUNCTIONS)));
            }
            if !matches!(children, [only] if *only.operator() == Operator::RootNode) {
                return Err(format!("`{identifier}` takes its values in brackets"));
            }
            let arguments = arguments(children);
            let expected = if matches!(identifier.as_str(), "min" | "max") { 2..=usize::MAX } else { 1..=1 };
            if !expected.contains(&arguments.len()) {
                return Err(format!("`{identifier}` is given {} values", arguments.len()));
            }
            for argument in arguments {
                if check(argument, names)? {
                    return Err(format!("`{identifier}` needs numbers, not something true or false"));
                }
            }
            Ok(false)
        }
        other => Err(format!("`{}` has no place in a formula", other.to_string().trim())),
    }
}

fn row_by_row(node: &Node, name: &str) -> bool {
    match node.operator() {
        Operator::VariableIdentifierRead { identifier } => identifier == name,
        Operator::FunctionIdentifier { identifier } if OVER_ROWS.contains(&identifier.as_str()) => false,
        _ => node.children().iter().any(|child| row_by_row(child, name)),
    }
}

fn comparison(operator: &Operator) -> Option<&'static str> {
    match operator {
        Operator::Eq => Some("="),
        Operator::Neq => Some("≠"),
        Operator::Gt => Some(">"),
        Operator::Lt => Some("<"),
        Operator::Geq => Some("≥"),
        Operator::Leq => Some("≤"),
        _ => None,
    }
}

/// The arguments of a function: a bracket around one value, or around a tuple.
fn arguments(children: &[Node]) -> Vec<&Node> {
    match children {
        [only] => match only.operator() {
            Operator::RootNode => arguments(only.children()),
            Operator::Tuple => only.children().iter().collect(),
            _ => vec![only],
        },
        several => several.iter().collect(),
    }
}

fn number(node: &Node, names: Names) -> Result<Number, String> {
    match evaluate(node, names)? {
        Outcome::Number(number) => Ok(number),
        Outcome::Truth(_) => Err("a number was expected, not something true or false".to_owned()),
    }
}

/// An angle or a ratio, as the functions of angles need one.
fn plain(value: Number, function: &str) -> Result<f64, String> {
    if value.fits(Number::plain(1.0)) {
        Ok(value.si)
    } else {
        Err(format!("`{function}` needs an angle or a plain number, not {}", described(value.dimension)))
    }
}

fn truth(node: &Node, names: Names) -> Result<bool, String> {
    match evaluate(node, names)? {
        Outcome::Truth(truth) => Ok(truth),
        Outcome::Number(_) => Err("a comparison was expected, not a number".to_owned()),
    }
}

/// The dimension of values that are added, compared or chosen from; they stand at a sign, or in a function.
fn of_one_sort(values: &[Number], at: &str, sign: &str) -> Result<Option<Dimension>, String> {
    let Some((first, rest)) = values.split_first() else { return Ok(None) };
    if let Some(other) = rest.iter().find(|other| !first.fits(**other)) {
        let (a, b) = (described(first.dimension), described(other.dimension));
        return Err(format!("{a} and {b} do not go together {at} `{sign}`"));
    }
    let all = rest.iter().fold(*first, |a, &b| Number { dimension: wider(a, b), ..b });
    Ok(Some(all.dimension))
}

fn evaluate(node: &Node, names: Names) -> Result<Outcome, String> {
    let children = node.children();
    let two = |sign: &str| match children {
        [a, b] => Ok((number(a, names)?, number(b, names)?)),
        _ => Err(format!("`{sign}` needs two values")),
    };
    let alike = |sign: &str| {
        let (a, b) = two(sign)?;
        of_one_sort(&[a, b], "at", sign).map(|_| (a, b))
    };
    let finite = |si: f64, dimension: Dimension| {
        if si.is_finite() {
            Ok(Outcome::Number(Number { si, dimension }))
        } else {
            Err(format!("`{}` gives {si}, which is not a finite number", node.operator().to_string().trim()))
        }
    };
    match node.operator() {
        Operator::RootNode => {
            children.first().map_or(Err("nothing to evaluate".to_owned()), |child| evaluate(child, names))
        }
        Operator::Add => alike("+").and_then(|(a, b)| finite(a.si + b.si, wider(a, b))),
        Operator::Sub => alike("-").and_then(|(a, b)| finite(a.si - b.si, wider(a, b))),
        Operator::Mul => two("*").and_then(|(a, b)| finite(a.si * b.si, product(a.dimension, b.dimension, 1))),
        Operator::Div => two("/").and_then(|(a, b)| finite(a.si / b.si, product(a.dimension, b.dimension, -1))),
        Operator::Exp => two("^").and_then(|(a, b)| {
            let dimension = power(a.dimension, b)?;
            finite(libm::pow(a.si, b.si), dimension)
        }),
        Operator::Neg => match children {
            [only] => number(only, names).map(|a| Outcome::Number(Number { si: -a.si, ..a })),
            _ => Err("`-` needs a value".to_owned()),
        },
        operator if comparison(operator).is_some() => {
            let (a, b) = alike(comparison(operator).unwrap_or(""))?;
            let order = a.si.partial_cmp(&b.si).ok_or("a value is not a number")?;
            Ok(Outcome::Truth(match operator {
                Operator::Gt => order.is_gt(),
                Operator::Lt => order.is_lt(),
                Operator::Geq => order.is_ge(),
                Operator::Leq => order.is_le(),
                Operator::Neq => order.is_ne(),
                _ => order.is_eq(),
            }))
        }
        // Both sides are evaluated: a unit that does not fit must not hide behind a first side that decides.
        Operator::And | Operator::Or => match children {
            [a, b] => {
                let (a, b) = (truth(a, names)?, truth(b, names)?);
                Ok(Outcome::Truth(if matches!(node.operator(), Operator::And) { a && b } else { a || b }))
            }
            _ => Err("`&&` and `||` need two sides".to_owned()),
        },
        Operator::Not => match children {
            [only] => truth(only, names).map(|truth| Outcome::Truth(!truth)),
            _ => Err("`!` needs a comparison".to_owned()),
        },
        Operator::Const { value: Value::Float(value) } => finite(*value, RATIO),
        Operator::Const { value: Value::Int(value) } => finite(*value as f64, RATIO),
        Operator::VariableIdentifierRead { identifier } => {
            let value = (names.value)(identifier, names.row).ok_or_else(|| format!("`{identifier}` is not given"))?;
            finite(value.si, value.dimension)
        }
        Operator::FunctionIdentifier { identifier } if OVER_ROWS.contains(&identifier.as_str()) => {
            let [child] = arguments(children)[..] else { return Err(format!("`{identifier}` needs one value")) };
            let of_row = |row| number(child, Names { row, ..names });
            let values = (0..names.rows).map(of_row).collect::<Result<Vec<_>, _>>()?;
            let dimension = values.iter().copied().reduce(|a, b| Number { dimension: wider(a, b), ..b });
            let dimension = dimension.map_or(RATIO, |number| number.dimension);
            let sum = |of: fn(f64) -> f64| values.iter().map(|value| of(value.si)).sum::<f64>();
            let count = values.len() as f64;
            let si = match identifier.as_str() {
                "mean" => sum(|value| value) / count,
                "rms" => (sum(|value| value * value) / count).sqrt(),
                _ => sum(|value| value),
            };
            finite(si, dimension)
        }
        Operator::FunctionIdentifier { identifier } => {
            let values =
                arguments(children).into_iter().map(|child| number(child, names)).collect::<Result<Vec<_>, _>>()?;
            let (first, rest) = values.split_first().ok_or_else(|| format!("`{identifier}` needs a value"))?;
            of_one_sort(&values, "in", identifier)?;
            match identifier.as_str() {
                "abs" => finite(first.si.abs(), first.dimension),
                "sqrt" => finite(first.si.sqrt(), power(first.dimension, Number::plain(0.5))?),
                "sin" => finite(libm::sin(plain(*first, identifier)?), RATIO),
                "cos" => finite(libm::cos(plain(*first, identifier)?), RATIO),
                "tan" => finite(libm::tan(plain(*first, identifier)?), RATIO),
                "atan" => finite(libm::atan(plain(*first, identifier)?), RATIO),
                "min" => Ok(Outcome::Number(
                    rest.iter().fold(*first, |a, &b| Number { si: a.si.min(b.si), dimension: wider(a, b) }),
                )),
                _ => Ok(Outcome::Number(
                    rest.iter().fold(*first, |a, &b| Number { si: a.si.max(b.si), dimension: wider(a, b) }),
                )),
            }
        }
        other => Err(format!("`{}` has no place in a formula", other.to_string().trim())),
    }
}

fn with_numbers(node: &Node, names: Names, unit: &str) -> Result<String, String> {
    let joined = |word: &str| {
        let parts =
            node.children().iter().map(|child| with_numbers(child, names, unit)).collect::<Result<Vec<_>, _>>()?;
        Ok(parts.join(word))
    };
    match node.operator() {
        Operator::RootNode => joined(""),
        Operator::And => joined(" and "),
        Operator::Or => joined(" or "),
        Operator::Not => joined("").map(|inner: String| format!("not ({inner})")),
        operator => match (comparison(operator), node.children()) {
            (Some(sign), [a, b]) => {
                let (a, b) = (number(a, names)?, number(b, names)?);
                // A plain zero takes the other side's unit.
                let (a, b) = (Number { dimension: wider(a, b), ..a }, Number { dimension: wider(b, a), ..b });
                let pair = |digits| (shown(a, unit, digits), shown(b, unit, digits));
                let told_apart =
                    (4..=12).map(pair).find(|(left, right)| left != right || a.si.total_cmp(&b.si).is_eq());
                let (left, right) = told_apart.unwrap_or_else(|| pair(17));
                // The sign of the *finding*, so that a refuted comparison does not read as if it held.
                let holds = truth(node, names)?;
                Ok(if holds { format!("{left} {sign} {right}") } else { format!("{left} {} {right}", negated(sign)) })
            }
            _ => number(node, names).map(|value| shown(value, unit, 4)),
        },
    }
}

/// What is the case when a comparison does not hold.
fn negated(sign: &str) -> &'static str {
    match sign {
        ">" => "≤",
        "<" => "≥",
        "≥" => "<",
        "≤" => ">",
        "=" => "≠",
        _ => "=",
    }
}
