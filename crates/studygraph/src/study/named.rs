//! What the stages of a study have, by name: tables, columns, and the values of keys that are known before anything runs.
//!
//! Must not know: where a word stands, who asks.

use std::collections::BTreeMap;

use super::Node;
use crate::table::data::Cell;
use crate::table::schema::Schema;

/// Stages that give each other the values of a key, at most: in a text that is no study they may ask in a circle.
const DEEPEST: usize = 8;

/// The tables that a stage can give.
#[must_use]
pub fn tables(nodes: &[Node], stage: &str) -> Vec<Schema> {
    nodes.iter().find(|node| node.name == stage).map(|node| node.stage.outputs()).unwrap_or_default()
}

/// One of them.
#[must_use]
pub fn table(nodes: &[Node], stage: &str, table: &str) -> Option<Schema> {
    tables(nodes, stage).into_iter().find(|schema| schema.name == table)
}

/// The values that key columns are going to have, as far as that is known.
pub struct Keys<'a> {
    nodes: BTreeMap<&'a str, &'a Node>,
}

impl<'a> Keys<'a> {
    pub fn new(nodes: impl IntoIterator<Item = &'a Node>) -> Self {
        Self { nodes: nodes.into_iter().map(|node| (node.name.as_str(), node)).collect() }
    }

    #[must_use]
    pub fn stage(&self, name: &str) -> Option<&'a Node> {
        self.nodes.get(name).copied()
    }

    /// Those of one column; none where they are not known.
    #[must_use]
    pub fn of(&self, stage: &str, table: &str, column: &str) -> Option<Vec<Cell>> {
        self.within(DEEPEST, stage, table, column)
    }

    fn within(&self, left: usize, stage: &str, table: &str, column: &str) -> Option<Vec<Cell>> {
        let left = left.checked_sub(1)?;
        let node = self.stage(stage)?;
        node.stage.keys(table, column, &|stage, table, column| self.within(left, stage, table, column))
    }
}

/// What stages give only where somebody asks for it, as `stage.table` or `stage.table.column`, with its meaning.
#[must_use]
pub fn on_demand(nodes: &[Node]) -> Vec<(String, String)> {
    let mut all = Vec::new();
    for (node, schema) in
        nodes.iter().flat_map(|node| node.stage.outputs().into_iter().map(move |schema| (node, schema)))
    {
        let table = format!("{}.{}", node.name, schema.name);
        let columns = schema.columns.iter().filter(|column| column.on_demand);
        all.extend(columns.map(|column| (format!("{table}.{}", column.name), column.description.clone())));
        all.extend(schema.on_demand.then(|| (table, schema.description.clone())));
    }
    all
}

/// A column's unit and meaning, on one line.
#[must_use]
pub fn meaning(unit: &str, description: &str) -> String {
    if unit.is_empty() { description.to_owned() } else { format!("[{unit}] {description}") }
}
