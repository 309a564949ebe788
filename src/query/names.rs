//! The tables that a query names, and the query as SQLite takes it.
//!
//! A table's name has parts, `energy_ga.ste.summary`, with or without quotes; SQLite knows names of one part. So a name
//! is put into one pair of quotes wherever it stands: behind FROM and JOIN, and before a column. Where SQLite would give
//! another number than a reader expects (7 / 2 is 3, 5.5 % 2 is 1, 'a' + 1 is 1), the query is changed or refused. Must not
//! know: which tables there are, but what their columns hold.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use sqlparser::ast::{
    BinaryOperator, CastKind, DataType, Expr, Function, FunctionArg, FunctionArgExpr, FunctionArgumentList,
    FunctionArguments, GroupByExpr, Ident, ObjectName, ObjectNamePart, Query, Select, SelectItem,
    SelectItemQualifiedWildcardKind, SetExpr, Statement, TableFactor, Value, VisitMut, VisitorMut,
};
use sqlparser::dialect::GenericDialect;
use sqlparser::parser::{Parser, ParserOptions};

use studygraph::table::data::{Data, Table};

/// A longer text is no query somebody wrote.
const MOST_BYTES: usize = 16 << 10;
/// Terms within terms; every link of a chain of ANDs is one.
const MOST_DEPTH: usize = 200;

/// A query that was read.
pub(super) struct Parsed {
    /// With every table's name in one pair of quotes.
    pub text: String,
    /// Each once, in the order in which they come, as they stand in `text`.
    pub tables: Vec<String>,
    /// Whether the rows have an order: that of ORDER BY, or of the one table they are taken from.
    pub ordered: bool,
    /// Columns that something is done to which only numbers allow.
    numbers: BTreeSet<String>,
    /// Columns that are compared with a text.
    texts: BTreeSet<String>,
}

/// Reads one SELECT.
///
/// # Errors
/// One sentence about the text.
pub(super) fn parse(text: &str) -> Result<Parsed, String> {
    if text.len() > MOST_BYTES {
        return Err(format!("the query has {} bytes; the longest has {MOST_BYTES}", text.len()));
    }
    let options = ParserOptions { trailing_commas: true, ..ParserOptions::default() };
    let parser = Parser::new(&GenericDialect).with_options(options).try_with_sql(text);
    let mut statements = parser.and_then(|mut parser| parser.parse_statements()).map_err(|error| {
        format!("the query is no SQL: {}", error.to_string().trim_start_matches("sql parser error: "))
    })?;
    let [Statement::Query(query)] = &mut statements[..] else {
        return Err("a query is one SELECT, and changes nothing".to_owned());
    };
    let mut names = Names::default();
    // Tables before columns: `a.b.c` before a column is a table only if a table is called so.
    for pass in [Pass::Tables, Pass::Columns] {
        names.pass = pass;
        if let ControlFlow::Break(problem) = query.visit(&mut names) {
            return Err(problem);
        }
    }
    let ordered = query.order_by.is_some() || is_part_of_one_table(query);
    let Names { tables, mut numbers, mut texts, given, .. } = names;
    // What the query calls so itself may hold anything.
    numbers.retain(|name| !given.contains(name));
    texts.retain(|name| !given.contains(name));
    Ok(Parsed { text: query.to_string(), tables, ordered, numbers, texts })
}

/// Whether the columns hold what the query takes them for.
///
/// # Errors
/// One sentence, which names the first that does not in any table.
pub(super) fn check_kinds(query: &Parsed, tables: &[(&str, Table)]) -> Result<(), String> {
    let all = |name: &str, wanted: fn(&Data) -> bool| {
        let mut found = tables.iter().filter_map(|(_, table)| table.column(name)).map(wanted).peekable();
        found.peek().is_some() && found.all(|found| found)
    };
    if let Some(name) = query.numbers.iter().find(|name| all(name, |data| matches!(data, Data::Text(_)))) {
        return Err(format!("`{name}` holds text, and the query takes it for numbers"));
    }
    match query.texts.iter().find(|name| all(name, |data| !matches!(data, Data::Text(_)))) {
        None => Ok(()),
        Some(name) => Err(format!("`{name}` holds no text: compare it with a value without quotes")),
    }
}

#[derive(Clone, Copy, Default, PartialEq, Eq)]
enum Pass {
    #[default]
    Tables,
    Columns,
}

#[derive(Default)]
struct Names {
    pass: Pass,
    tables: Vec<String>,
    /// Names that the query gives to its own parts: `WITH name AS`.
    own: BTreeSet<String>,
    /// Names that it gives to columns.
    given: BTreeSet<String>,
    numbers: BTreeSet<String>,
    texts: BTreeSet<String>,
    depth: usize,
}

impl VisitorMut for Names {
    type Break = String;

    fn pre_visit_query(&mut self, query: &mut Query) -> ControlFlow<String> {
        let with = query.with.iter().flat_map(|with| &with.cte_tables);
        self.own.extend(with.map(|table| table.alias.name.value.clone()));
        ControlFlow::Continue(())
    }

    fn pre_visit_select(&mut self, select: &mut Select) -> ControlFlow<String> {
        for item in &mut select.projection {
            match item {
                SelectItem::QualifiedWildcard(SelectItemQualifiedWildcardKind::ObjectName(name), _) => self.join(name),
                SelectItem::ExprWithAlias { alias, .. } => drop(self.given.insert(alias.value.clone())),
                _ => {}
            }
        }
        ControlFlow::Continue(())
    }

    /// What has no name is called as it was written, not as it is changed: given here, where it is known not to be too deep.
    fn post_visit_select(&mut self, select: &mut Select) -> ControlFlow<String> {
        for item in select.projection.iter_mut().filter(|_| self.pass == Pass::Tables) {
            if let SelectItem::UnnamedExpr(term) = item
                && column(term).is_none()
            {
                let alias = Ident::with_quote('"', term.to_string());
                *item = SelectItem::ExprWithAlias { expr: term.clone(), alias };
            }
        }
        ControlFlow::Continue(())
    }

    fn pre_visit_table_factor(&mut self, factor: &mut TableFactor) -> ControlFlow<String> {
        let TableFactor::Table { name, args, .. } = factor else { return ControlFlow::Continue(()) };
        if args.is_some() {
            return ControlFlow::Break(format!("`{name}` cannot be called: a query reads tables of studies alone"));
        }
        if self.pass == Pass::Tables {
            let Some(whole) = whole(name) else {
                return ControlFlow::Break(format!("`{name}` is no name of a table"));
            };
            if !self.own.contains(&whole) && !self.tables.contains(&whole) {
                self.tables.push(whole);
            }
            self.join(name);
        }
        ControlFlow::Continue(())
    }

    fn pre_visit_expr(&mut self, term: &mut Expr) -> ControlFlow<String> {
        self.depth += 1;
        if self.depth > MOST_DEPTH {
            return ControlFlow::Break(format!("the query has more than {MOST_DEPTH} terms within each other"));
        }
        if self.pass == Pass::Tables {
            self.note_kinds(term)?;
        }
        if let (Pass::Columns, Expr::CompoundIdentifier(parts)) = (self.pass, term)
            && parts.len() > 2
            && let Some((column, table)) = parts.split_last()
        {
            let whole = joined(table);
            if self.tables.contains(&whole) {
                *parts = vec![Ident::with_quote('"', whole), column.clone()];
            }
        }
        ControlFlow::Continue(())
    }

    fn post_visit_expr(&mut self, term: &mut Expr) -> ControlFlow<String> {
        self.depth -= 1;
        if let (Pass::Columns, Expr::BinaryOp { left, op, right }) = (self.pass, &mut *term) {
            match op {
                BinaryOperator::Divide => {
                    let expr = std::mem::replace(left, nothing());
                    let (kind, data_type) = (CastKind::Cast, DataType::Real);
                    **left = Expr::Cast { kind, expr, data_type, array: false, format: None };
                }
                BinaryOperator::Modulo => {
                    let (left, right) = (std::mem::replace(left, nothing()), std::mem::replace(right, nothing()));
                    *term = call("mod", [*left, *right]);
                }
                _ => {}
            }
        }
        ControlFlow::Continue(())
    }
}

impl Names {
    /// Notes the columns that are taken for numbers, and those that are compared with a text.
    fn note_kinds(&mut self, term: &Expr) -> ControlFlow<String> {
        use BinaryOperator::{Divide, Eq, Gt, GtEq, Lt, LtEq, Minus, Modulo, Multiply, NotEq, Plus};
        match term {
            Expr::BinaryOp { left, op: Plus | Minus | Multiply | Divide | Modulo, right } => {
                for side in [left, right] {
                    if let Expr::Value(value) = &**side
                        && let Value::SingleQuotedString(_) = value.value
                    {
                        return ControlFlow::Break(format!("{side} is text, and the query takes it for a number"));
                    }
                    self.numbers.extend(column(side));
                }
            }
            Expr::BinaryOp { left, op: Eq | NotEq | Lt | LtEq | Gt | GtEq, right } => {
                for (name, other) in [(column(left), right), (column(right), left)] {
                    let Expr::Value(value) = &**other else { continue };
                    match value.value {
                        Value::Number(..) => self.numbers.extend(name),
                        Value::SingleQuotedString(_) => self.texts.extend(name),
                        _ => {}
                    }
                }
            }
            Expr::Function(function) if OF_NUMBERS.contains(&function.name.to_string().to_lowercase().as_str()) => {
                let FunctionArguments::List(given) = &function.args else { return ControlFlow::Continue(()) };
                let given = given.args.iter().filter_map(|argument| match argument {
                    FunctionArg::Unnamed(FunctionArgExpr::Expr(term)) => column(term),
                    _ => None,
                });
                self.numbers.extend(given);
            }
            _ => {}
        }
        ControlFlow::Continue(())
    }

    /// Puts a table's name into one pair of quotes.
    fn join(&self, name: &mut ObjectName) {
        if let Some(whole) = whole(name).filter(|whole| self.tables.contains(whole)) {
            name.0 = vec![ObjectNamePart::Identifier(Ident::with_quote('"', whole))];
        }
    }
}

/// Functions that give a number for a text, too.
const OF_NUMBERS: [&str; 8] = ["sum", "avg", "total", "abs", "round", "median", "stddev", "variance"];

/// The name of a column, without its table's.
fn column(term: &Expr) -> Option<String> {
    match term {
        Expr::Identifier(name) => Some(name.value.clone()),
        Expr::CompoundIdentifier(parts) => parts.last().map(|name| name.value.clone()),
        _ => None,
    }
}

fn nothing() -> Box<Expr> {
    Box::new(Expr::Value(Value::Null.with_empty_span()))
}

fn call(name: &str, given: [Expr; 2]) -> Expr {
    let args = given.map(|term| FunctionArg::Unnamed(FunctionArgExpr::Expr(term))).to_vec();
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

fn joined(parts: &[Ident]) -> String {
    parts.iter().map(|part| part.value.as_str()).collect::<Vec<_>>().join(".")
}

/// None where a part of the name is computed.
fn whole(name: &ObjectName) -> Option<String> {
    let parts: Option<Vec<&str>> = name.0.iter().map(|part| Some(part.as_ident()?.value.as_str())).collect();
    Some(parts?.join("."))
}

/// Whether the rows are some of those of one table, and so in its order.
fn is_part_of_one_table(query: &Query) -> bool {
    let SetExpr::Select(select) = &*query.body else { return false };
    let grouped = !matches!(&select.group_by, GroupByExpr::Expressions(by, _) if by.is_empty());
    let one = matches!(&select.from[..], [table] if table.joins.is_empty()
        && matches!(table.relation, TableFactor::Table { .. }));
    one && !grouped && select.distinct.is_none() && query.with.is_none()
}
