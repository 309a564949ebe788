//! Cells that stages name of each other's tables: whether a row will be there that they mean.
//!
//! Which values a key column is going to have often follows from the study alone: names of designs, torques of an axis. A
//! condition on another value is refused before anything runs. Must not know: which columns these are, or what they mean.

use std::collections::BTreeMap;

use super::Node;
use super::links::{begins, find};
use super::words::quote;
use crate::table::data::Cell;
use crate::table::select::{self, CellName};
use declare::error::{Diagnostic, Place};
use declare::record::{Record, Value};

/// Values of the key columns, by stage, table and column; nothing where they are not known.
struct Keys<'a> {
    nodes: BTreeMap<&'a str, &'a Node>,
}

impl Keys<'_> {
    fn of(&self, stage: &str, table: &str, column: &str) -> Option<Vec<Cell>> {
        // No stage reads from itself: that was refused.
        self.nodes.get(stage)?.stage.keys(table, column, &|stage, table, column| self.of(stage, table, column))
    }
}

/// What is wrong with the conditions of all cells that are named.
pub fn check(nodes: &[Node]) -> Vec<Diagnostic> {
    let keys = Keys { nodes: nodes.iter().map(|node| (node.name.as_str(), node)).collect() };
    let mut wrong = Vec::new();
    for node in nodes {
        for cell in node.stage.cells() {
            if let Some(found) = missing(&keys, &cell) {
                wrong.push(found.at(place_of(&node.record, &cell)));
            }
        }
        let placed = node.stage.conditions().into_iter();
        wrong.extend(placed.filter_map(|(rows, place)| Some(missing(&keys, &rows)?.at(place))));
    }
    wrong
}

/// The first condition of a cell that no row is going to meet.
fn missing(keys: &Keys, cell: &CellName) -> Option<Diagnostic> {
    let schemas = keys.nodes.get(cell.stage.as_str())?.stage.outputs();
    let schema = schemas.iter().find(|schema| schema.name == cell.table)?;
    cell.conditions.iter().find_map(|(name, value)| {
        let known = keys.of(&cell.stage, &cell.table, name)?;
        let there = select::unmet(schema.column(name)?, value, &known)?;
        let message = format!(
            "no row of {} will have {}",
            quote(&format!("{}.{}", cell.stage, cell.table)),
            quote(&format!("{name}={value}"))
        );
        Some(Diagnostic::new(message).help(there))
    })
}

/// Where a record names a cell: the text that begins as it does and has its conditions.
fn place_of(record: &Record, cell: &CellName) -> Place {
    let table = format!("{}.{}", cell.stage, cell.table);
    let names_it = |value: &Value| {
        let Value::Text(text) = value else { return false };
        begins(text, &table) && CellName::parse(text).is_ok_and(|named| named.conditions == cell.conditions)
    };
    find(record, &names_it).unwrap_or(record.place)
}
