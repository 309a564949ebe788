//! The tables that a query names, and the query as polars takes it.
//!
//! A table's name has parts, `energy_ga.ste.summary`, with or without quotes; polars knows names of one part. So a name
//! is put into one pair of quotes wherever it stands: behind FROM and JOIN, and before a column. Must not know: which
//! tables there are.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use sqlparser::ast::{
    Expr, GroupByExpr, Ident, ObjectName, ObjectNamePart, Query, SelectItemQualifiedWildcardKind, SetExpr, Statement,
    TableFactor, VisitMut, VisitorMut,
};
use sqlparser::dialect::GenericDialect;
use sqlparser::parser::{Parser, ParserOptions};

/// A longer text is no query somebody wrote.
const MOST_BYTES: usize = 16 << 10;
/// Terms within terms; every link of a chain of ANDs is one.
pub(super) const MOST_DEPTH: usize = 200;

/// SELECTs in one query: polars plans a chain of UNIONs in a time that grows with its square.
pub(super) const MOST_SELECTS: usize = 64;

/// CASEs within each other: polars copies all that is within for each of them.
pub(super) const MOST_CASES: usize = 8;

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
    /// Names that the query gives to its own parts: `WITH name AS`.
    own: BTreeSet<String>,
    depth: usize,
    cases: usize,
    selects: usize,
}

impl VisitorMut for Names {
    type Break = String;

    fn pre_visit_query(&mut self, query: &mut Query) -> ControlFlow<String> {
        let with = query.with.iter().flat_map(|with| &with.cte_tables);
        self.own.extend(with.map(|table| table.alias.name.value.clone()));
        if self.pass == Pass::Tables {
            self.selects += selects(query);
            if self.selects > MOST_SELECTS {
                return ControlFlow::Break(format!("the query has more than {MOST_SELECTS} SELECTs"));
            }
        }
        if let SetExpr::Select(select) = &mut *query.body
            && self.pass == Pass::Columns
        {
            for item in &mut select.projection {
                if let sqlparser::ast::SelectItem::QualifiedWildcard(kind, _) = item
                    && let SelectItemQualifiedWildcardKind::ObjectName(name) = kind
                {
                    self.join(name);
                }
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
        match term {
            Expr::Case { .. } => {
                self.cases += 1;
                if self.cases > MOST_CASES {
                    return ControlFlow::Break(format!("the query has more than {MOST_CASES} CASEs within each other"));
                }
            }
            Expr::Exists { .. } => {
                return ControlFlow::Break("EXISTS is not known here: write IN (SELECT …) or a JOIN".to_owned());
            }
            _ => {}
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
        self.cases -= usize::from(matches!(term, Expr::Case { .. }));
        ControlFlow::Continue(())
    }
}

impl Names {
    /// Puts a table's name into one pair of quotes.
    fn join(&self, name: &mut ObjectName) {
        if let Some(whole) = whole(name).filter(|whole| self.tables.contains(whole)) {
            name.0 = vec![ObjectNamePart::Identifier(Ident::with_quote('"', whole))];
        }
    }
}

fn joined(parts: &[Ident]) -> String {
    parts.iter().map(|part| part.value.as_str()).collect::<Vec<_>>().join(".")
}

/// None where a part of the name is computed.
fn whole(name: &ObjectName) -> Option<String> {
    let parts: Option<Vec<&str>> = name.0.iter().map(|part| Some(part.as_ident()?.value.as_str())).collect();
    Some(parts?.join("."))
}

/// Those side by side, by UNION and the like.
fn selects(query: &Query) -> usize {
    let (mut open, mut count) = (vec![&*query.body], 0);
    while let Some(part) = open.pop() {
        match part {
            SetExpr::SetOperation { left, right, .. } => open.extend([&**left, &**right]),
            _ => count += 1,
        }
    }
    count
}

/// Whether the rows are some of those of one table, and so in its order.
fn is_part_of_one_table(query: &Query) -> bool {
    let SetExpr::Select(select) = &*query.body else { return false };
    let grouped = !matches!(&select.group_by, GroupByExpr::Expressions(by, _) if by.is_empty());
    let one = matches!(&select.from[..], [table] if table.joins.is_empty()
        && matches!(table.relation, TableFactor::Table { .. }));
    one && !grouped && select.distinct.is_none() && query.with.is_none()
}
