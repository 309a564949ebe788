//! Cells that stages name of each other's tables: whether a row will be there that they mean, and one only, and a number in
//! it that can be compared with what it is compared with.
//!
//! Which values a key column is going to have often follows from the study alone: names of designs, torques of an axis. A
//! condition on another value is refused before anything runs. Must not know: which columns these are, or what they mean.

use std::collections::BTreeSet;

use super::Node;
use super::blame::{Blame, Built};
use super::named::Keys;
use super::words::quote;
use crate::stage::Named;
use crate::table::data::Cell;
use crate::table::schema::{Column, Schema, Type};
use crate::table::select::{self, CellName};
use declare::error::Diagnostic;
use declare::units::{Dimension, described, parse_unit, same_dimension};

/// Checks all cells that are named.
pub fn check(built: &[Built], blame: &mut Blame) {
    let keys = Keys::new(built.iter().flatten());
    for (at, node) in built.iter().enumerate().filter_map(|(at, one)| Some((at, one.as_ref().ok()?))) {
        // Several cells may have their rows from one place.
        let mut told = BTreeSet::new();
        for named in node.stage.named() {
            for found in wrong(&keys, &named) {
                let found = found.or_at(named.place);
                if told.insert((found.place.map(|place| place.offset), found.message.clone())) {
                    blame.put(at, found);
                }
            }
        }
        for found in node.stage.at_odds(&|cell| dimension(table(&keys, cell)?.1.column(&cell.column)?)) {
            blame.put(at, found);
        }
    }
}

/// What is wrong with a cell, where its stage and table are there.
fn wrong(keys: &Keys, named: &Named) -> Vec<Diagnostic> {
    let cell = &named.cell;
    let Some((node, schema)) = table(keys, cell) else { return Vec::new() };
    let unmet = unmet(keys, named, &schema);
    if !unmet.is_empty() {
        return unmet;
    }
    several(keys, named, &schema)
        .filter(|_| node.stage.combines(&cell.table))
        .or_else(|| incomparable(named, schema.column(&cell.column)?))
        .into_iter()
        .collect()
}

/// The table of a cell and its stage.
fn table<'a>(keys: &Keys<'a>, cell: &CellName) -> Option<(&'a Node, Schema)> {
    let node = keys.stage(&cell.stage)?;
    Some((node, node.stage.outputs().into_iter().find(|schema| schema.name == cell.table)?))
}

fn holds_numbers(column: &Column) -> bool {
    matches!(column.kind, Type::Float | Type::Integer)
}

/// What a column's numbers are of, if it holds any.
fn dimension(column: &Column) -> Option<Dimension> {
    holds_numbers(column).then(|| parse_unit(&column.unit).ok().map(|unit| unit.dimension))?
}

/// The conditions that fit no column, or that no row is going to meet.
fn unmet(keys: &Keys, Named { cell, rows, .. }: &Named, schema: &Schema) -> Vec<Diagnostic> {
    let unmet = |condition: &(String, String)| {
        let (name, value) = condition;
        // That the column is missing is told of all that a stage reads.
        let column = schema.column(name)?;
        if let Err(message) = select::check_conditions(schema, std::slice::from_ref(condition)) {
            return Some(Diagnostic::new(message).at(*rows));
        }
        let known = keys.of(&cell.stage, &cell.table, name)?;
        let there = select::unmet(column, value, &known)?;
        let table = quote(&format!("{}.{}", cell.stage, cell.table));
        let message = format!("no row of {table} will have {}", quote(&format!("{name}={value}")));
        Some(Diagnostic::new(message).at(*rows).help(there))
    };
    cell.conditions.iter().filter_map(unmet).collect()
}

/// The keys that tell rows apart where one is meant.
fn several(keys: &Keys, Named { cell, is_one, rows, .. }: &Named, schema: &Schema) -> Option<Diagnostic> {
    // A condition on a column that is not there was told.
    if !is_one || cell.conditions.iter().any(|(name, _)| schema.column(name).is_none()) {
        return None;
    }
    let is_free = |column: &&Column| cell.conditions.iter().all(|(name, _)| *name != column.name);
    let free = schema.key_columns().map(|at| &schema.columns[at]).filter(is_free);
    let open: Vec<(&Column, Vec<Cell>)> = free
        .filter_map(|column| Some((column, keys.of(&cell.stage, &cell.table, &column.name)?)))
        .filter(|(_, values)| values.len() > 1)
        .collect();
    let (column, values) = open.first()?;
    let count: usize = open.iter().map(|(_, values)| values.len()).product();
    let table = quote(&format!("{}.{}", cell.stage, cell.table));
    let message = format!("one row of {table} is meant, and there will be {count} or more");
    let names: Vec<String> = open.iter().map(|(column, _)| quote(&column.name)).collect();
    let example = select::condition(column, &values[0]);
    Some(
        Diagnostic::new(message)
            .at(*rows)
            .help(format!("say which by {}, for example `{example}`", names.join(" and "))),
    )
}

/// A column without numbers, or in another unit than what it is compared with.
fn incomparable(named: &Named, column: &Column) -> Option<Diagnostic> {
    let name = quote(&column.name);
    if !holds_numbers(column) {
        return Some(Diagnostic::new(format!("column {name} holds {}s, not numbers", column.kind.name())));
    }
    let (other, text, place) = named.beside.as_ref()?;
    let own = dimension(column)?;
    let message = format!("column {name} is {}, and {} is {}", described(own), quote(text), described(*other));
    let without_unit = !column.unit.is_empty() && text.trim().parse::<f64>().is_ok();
    let help =
        without_unit.then(|| format!("{} has no unit: for example `{} {}`", quote(text), text.trim(), column.unit));
    (!same_dimension(own, *other)).then(|| Diagnostic { help, ..Diagnostic::new(message).at(*place) })
}
