//! The tables that a query names, and the query as SQLite takes it.
//!
//! A table's name has parts, `energy_ga.ste.summary`, with or without quotes; SQLite knows names of one part. So a name
//! is put into one pair of quotes wherever it stands: behind FROM and JOIN, and before a column. Names of columns are put
//! in quotes too, since some are words of SQL. Must not know: which tables there are, and what their columns hold.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use sqlparser::ast::{
    Expr, GroupByExpr, Ident, ObjectName, ObjectNamePart, Query, Select, SelectItem, SelectItemQualifiedWildcardKind,
    SetExpr, Statement, TableFactor, Value, VisitMut, VisitorMut,
};
use sqlparser::dialect::GenericDialect;
use sqlparser::parser::{Parser, ParserOptions};

use super::kinds::Kinds;
use declare::error::suggest;

/// A longer text is not a query somebody wrote.
const MOST_BYTES: usize = 16 << 10;
/// Terms within terms; every link of a chain of ANDs is one.
const MOST_DEPTH: usize = 200;

const ONE_SELECT: &str = "a query is one SELECT, and changes nothing";

/// A query that was read.
pub(super) struct Parsed {
    /// With every table's name in one pair of quotes.
    pub text: String,
    /// Each once, in the order in which they come, as they stand in `text`.
    pub tables: Vec<String>,
    /// Whether the rows have an order: that of ORDER BY, or of the one table they are taken from.
    pub ordered: bool,
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
        return Err(ONE_SELECT.to_owned());
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
    // Names are found, and no term is too deep.
    if let ControlFlow::Break(problem) = query.visit(&mut Kinds) {
        return Err(problem);
    }
    Ok(Parsed { text: query.to_string(), tables: names.tables, ordered })
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
    /// Names that the query gives to its own parts, `WITH name AS`, in lower case: SQLite tells no case apart.
    own: BTreeSet<String>,
    depth: usize,
}

impl VisitorMut for Names {
    type Break = String;

    fn pre_visit_query(&mut self, query: &mut Query) -> ControlFlow<String> {
        if changes(&query.body) {
            return ControlFlow::Break(ONE_SELECT.to_owned());
        }
        let with = query.with.iter().flat_map(|with| &with.cte_tables);
        self.own.extend(with.map(|table| table.alias.name.value.to_lowercase()));
        ControlFlow::Continue(())
    }

    fn pre_visit_select(&mut self, select: &mut Select) -> ControlFlow<String> {
        for item in &mut select.projection {
            match item {
                SelectItem::QualifiedWildcard(SelectItemQualifiedWildcardKind::ObjectName(name), _) => self.join(name),
                SelectItem::ExprWithAlias { alias, .. } => quote(alias),
                _ => {}
            }
        }
        ControlFlow::Continue(())
    }

    /// What has no name is called as it was written, not as it is changed: given here, where it is known not to be too deep.
    fn post_visit_select(&mut self, select: &mut Select) -> ControlFlow<String> {
        for item in select.projection.iter_mut().filter(|_| self.pass == Pass::Tables) {
            if let SelectItem::UnnamedExpr(term) = item
                && !matches!(term, Expr::Identifier(_) | Expr::CompoundIdentifier(_))
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
                return ControlFlow::Break(format!("`{name}` is not a name of a table"));
            };
            if !self.own.contains(&whole.to_lowercase()) && !self.tables.contains(&whole) {
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
        match (self.pass, term) {
            (Pass::Columns, Expr::CompoundIdentifier(parts)) => {
                if let Some((column, table)) = parts.split_last().filter(|(_, table)| table.len() > 1) {
                    let whole = joined(table);
                    if !self.is_table(&whole) {
                        let help = suggest(&whole, self.tables.iter().map(String::as_str));
                        return ControlFlow::Break(format!("`{whole}` is not a table of this query; {help}"));
                    }
                    *parts = vec![Ident::new(whole), column.clone()];
                }
                parts.iter_mut().for_each(quote);
            }
            (Pass::Columns, Expr::Identifier(name)) => quote(name),
            _ => {}
        }
        ControlFlow::Continue(())
    }

    fn post_visit_expr(&mut self, _: &mut Expr) -> ControlFlow<String> {
        self.depth -= 1;
        ControlFlow::Continue(())
    }

    fn pre_visit_value(&mut self, value: &mut sqlparser::ast::ValueWithSpan) -> ControlFlow<String> {
        match &value.value {
            Value::Placeholder(sign) => ControlFlow::Break(format!("`{sign}` stands for a value that nobody gives")),
            Value::HexStringLiteral(digits) => {
                ControlFlow::Break(format!("`{digits}` is hexadecimal: write the number with the digits 0 to 9"))
            }
            _ => ControlFlow::Continue(()),
        }
    }
}

impl Names {
    fn is_table(&self, name: &str) -> bool {
        self.tables.iter().any(|table| table == name) || self.own.contains(&name.to_lowercase())
    }

    /// Puts a table's name into one pair of quotes.
    fn join(&self, name: &mut ObjectName) {
        if let Some(whole) = whole(name).filter(|whole| self.is_table(whole)) {
            name.0 = vec![ObjectNamePart::Identifier(Ident::with_quote('"', whole))];
        }
    }
}

/// Whether the body of a query is more than a question: `WITH … DELETE`.
fn changes(body: &SetExpr) -> bool {
    match body {
        SetExpr::Select(_) | SetExpr::Query(_) | SetExpr::Values(_) => false,
        SetExpr::SetOperation { left, right, .. } => changes(left) || changes(right),
        _ => true,
    }
}

fn quote(name: &mut Ident) {
    name.quote_style = Some('"');
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
