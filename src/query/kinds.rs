//! What SQLite would take silently for something else: a text for a number, a whole number's division for a whole number.
//!
//! In SQLite 7 / 2 is 3, 5.5 % 2 is 1, 'a' + 1 is 1, and every text is above every number. So divisions are made real, and
//! where a number is meant or two values are compared, the query is given functions of [`super::database`] that refuse, row
//! by row, what does not fit. Two columns that are said to be equal stay as they are: that is how joins are written, and
//! SQLite has no quicker way than that operator. Must not know: which columns there are.

use std::ops::ControlFlow;

use sqlparser::ast::{
    BinaryOperator, CastKind, DataType, Expr, Function, FunctionArg, FunctionArgExpr, FunctionArgumentList,
    FunctionArguments, Ident, ObjectName, ObjectNamePart, UnaryOperator, Value, VisitorMut,
};

/// `is_number(x, name)`: x, which is not a text.
pub(super) const IS_NUMBER: &str = "is_number";
/// `compared(x, y, name, name)`: −1, 0 or 1 of two values of one kind.
pub(super) const COMPARED: &str = "compared";
/// `is_between(x, low, high, names)`: 0 or 1 of three values of one kind.
pub(super) const IS_BETWEEN: &str = "is_between";
/// `is_among(x, a, b, …, names)`: 0 or 1 of values of one kind.
pub(super) const IS_AMONG: &str = "is_among";
/// Values of an IN that are looked at: functions of SQLite take a few hundred arguments.
const MOST_AMONG: usize = 100;

/// Functions of SQLite that give a number for a text, too.
const OF_NUMBERS: [&str; 6] = ["sum", "avg", "total", "abs", "round", "sign"];

/// Changes every term of a query.
pub(super) struct Kinds;

impl VisitorMut for Kinds {
    type Break = String;

    fn post_visit_expr(&mut self, term: &mut Expr) -> ControlFlow<String> {
        use BinaryOperator::{
            And, BitwiseAnd, BitwiseOr, Divide, Eq, Gt, GtEq, Lt, LtEq, Minus, Modulo, Multiply, NotEq, Or,
            PGBitwiseShiftLeft, PGBitwiseShiftRight, Plus,
        };
        match term {
            Expr::BinaryOp { left, op, right } => match op {
                Plus | Minus | Multiply | BitwiseAnd | BitwiseOr | PGBitwiseShiftLeft | PGBitwiseShiftRight => {
                    take_for_number(left);
                    take_for_number(right);
                }
                Divide => {
                    take_for_number(right);
                    take_for_number(left);
                    let (kind, data_type, expr) = (CastKind::Cast, DataType::Real, taken(left));
                    **left = Expr::Cast { kind, expr, data_type, array: false, format: None };
                }
                Modulo => *term = call("mod", vec![*taken(left), *taken(right)]),
                And | Or => {
                    take_for_truth(left);
                    take_for_truth(right);
                }
                Eq | NotEq if is_column(left) && is_column(right) => {}
                Eq | NotEq | Lt | LtEq | Gt | GtEq if !is_row(left) && !is_row(right) => {
                    **left = named(COMPARED, vec![*taken(left), *taken(right)]);
                    **right = Expr::Value(Value::Number("0".to_owned(), false).with_empty_span());
                }
                _ => {}
            },
            Expr::UnaryOp { op: UnaryOperator::Minus | UnaryOperator::Plus | UnaryOperator::BitwiseNot, expr } => {
                take_for_number(expr);
            }
            Expr::UnaryOp { op: UnaryOperator::Not, expr } => take_for_truth(expr),
            // The term itself is given once: written out for each limit, terms within each other would have no end.
            Expr::Between { expr, negated, low, high } if !is_row(expr) => {
                let given = vec![*taken(expr), *taken(low), *taken(high)];
                *term = unless(*negated, named(IS_BETWEEN, given));
            }
            Expr::InList { expr, list, negated } if !is_row(expr) && list.len() <= MOST_AMONG => {
                let given = std::iter::once(*taken(expr)).chain(std::mem::take(list)).collect();
                *term = unless(*negated, named(IS_AMONG, given));
            }
            Expr::Function(function) if OF_NUMBERS.contains(&function.name.to_string().to_lowercase().as_str()) => {
                if let FunctionArguments::List(given) = &mut function.args {
                    for argument in &mut given.args {
                        if let FunctionArg::Unnamed(FunctionArgExpr::Expr(term)) = argument {
                            take_for_number(term);
                        }
                    }
                }
            }
            _ => {}
        }
        ControlFlow::Continue(())
    }
}

fn take_for_number(term: &mut Expr) {
    let is_one = match inside(term) {
        Expr::Value(value) => matches!(value.value, Value::Number(..) | Value::Null | Value::Boolean(_)),
        Expr::BinaryOp { op, .. } => *op != BinaryOperator::StringConcat,
        Expr::Cast { data_type: DataType::Real, .. } => true,
        _ => false,
    };
    if !is_one {
        *term = named(IS_NUMBER, vec![std::mem::replace(term, nothing())]);
    }
}

/// A condition is a number, 0 or 1; what is none by its form may be a text.
fn take_for_truth(term: &mut Expr) {
    if is_column(term) || matches!(inside(term), Expr::Value(_)) {
        take_for_number(term);
    }
}

/// A function of these terms, with their names behind them.
fn named(function: &str, mut given: Vec<Expr>) -> Expr {
    let names: Vec<Expr> = given.iter().map(|term| text(name(term))).collect();
    given.extend(names);
    call(function, given)
}

fn unless(negated: bool, term: Expr) -> Expr {
    if !negated {
        return term;
    }
    // In brackets, since NOT takes in more of what follows than NOT IN does.
    Expr::Nested(Box::new(Expr::UnaryOp { op: UnaryOperator::Not, expr: Box::new(term) }))
}

/// What stands in brackets.
fn inside(mut term: &Expr) -> &Expr {
    while let Expr::Nested(within) = term {
        term = within;
    }
    term
}

fn is_column(term: &Expr) -> bool {
    matches!(inside(term), Expr::Identifier(_) | Expr::CompoundIdentifier(_))
}

fn is_row(term: &Expr) -> bool {
    matches!(inside(term), Expr::Tuple(_))
}

/// The name of a column, without its table's; empty where it is none.
fn name(term: &Expr) -> String {
    match inside(term) {
        Expr::Identifier(name) => name.value.clone(),
        Expr::CompoundIdentifier(parts) => parts.last().map_or_else(String::new, |name| name.value.clone()),
        _ => String::new(),
    }
}

fn text(value: String) -> Expr {
    Expr::Value(Value::SingleQuotedString(value).with_empty_span())
}

fn nothing() -> Expr {
    Expr::Value(Value::Null.with_empty_span())
}

fn taken(term: &mut Box<Expr>) -> Box<Expr> {
    std::mem::replace(term, Box::new(nothing()))
}

fn call(name: &str, given: Vec<Expr>) -> Expr {
    let args = given.into_iter().map(|term| FunctionArg::Unnamed(FunctionArgExpr::Expr(term))).collect();
    Expr::Function(Function {
        name: ObjectName(vec![ObjectNamePart::Identifier(Ident::new(name))]),
        uses_odbc_syntax: false,
        parameters: FunctionArguments::None,
        args: FunctionArguments::List(FunctionArgumentList { duplicate_treatment: None, args, clauses: Vec::new() }),
        filter: None,
        null_treatment: None,
        over: None,
        within_group: Vec::new(),
    })
}
