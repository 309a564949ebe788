//! Texts of a study that name what is in tables: `stage.table[column=value, …].column`, and parts of it.
//!
//! Which fields have such texts the program says. What they can name are the tables of the stages as they are written. Must not
//! know: which stages there are, what their tables are for.

use std::ops::Range;

use super::{Beside, Found, Offer, Offers, of_kind, offer};
use crate::program::{Names, Program};
use crate::study::assemble::that_stand;
use crate::study::document::{Content, KeyValue, Node as Tree};
use crate::study::{Node, named};
use crate::table::data::Cell;
use crate::table::schema::{Column, Schema, Type};
use declare::parameter::Field;

/// A text of a field, and the stages that it may name something of.
pub(super) struct Naming<'a> {
    pub names: Names,
    pub beside: Beside<'a>,
    pub nodes: Vec<Node>,
    pub all: &'a [KeyValue],
}

/// What is named at a place of such a text.
enum Spot {
    Stage,
    Table {
        stage: String,
    },
    Column(Within),
    /// A column of a condition.
    Condition(Within),
    Value(Within, String),
    /// A table of the stage, or a column of the table that is meant where none is said.
    Either(Within),
}

struct Within {
    stage: String,
    table: String,
}

impl<'a> Naming<'a> {
    /// What a field names, if anything.
    pub fn of(field: &Field, beside: Beside<'a>, all: &'a [KeyValue], program: &Program) -> Option<Self> {
        let kind = beside.kind?.name;
        let is_it = |naming: &&crate::program::Naming| naming.kind == kind && naming.field == field.name;
        let names = program.named.iter().filter(is_it).map(|naming| naming.names);
        // A field of the same name may stand elsewhere: it names columns beside the field with their table.
        let names = names.into_iter().find(|names| match names {
            Names::Columns { table } => beside.fields.iter().any(|field| field.name == *table),
            _ => true,
        })?;
        Some(Self { names, beside, nodes: that_stand(all, program), all })
    }

    /// What could stand at `offset` of a text in the place of the word around it; `node` is the value there.
    pub fn offers(&self, text: &str, node: &Tree, offset: usize) -> Option<Offers> {
        let written = Written::of(text, node);
        let head = written.until(offset)?;
        let (spot, start) = self.spot(head)?;
        let stops: &[char] = match spot {
            Spot::Value(..) => &[',', ']', '}', '"', '\'', '\n'],
            _ => &['.', '[', '=', ',', ']', '}', '"', '\'', '\n', ' ', ':'],
        };
        let end = text[offset..].find(stops).map_or(text.len(), |at| offset + at);
        let end = offset + text[offset..end].trim_end().len();
        let all = self.named(&spot);
        // Where something stands already, an example of the whole would be put behind it.
        (!all.is_empty() || !head.is_empty()).then_some(Offers { range: written.start + start..end, all })
    }

    /// Columns of the conditions of a map.
    pub fn own_names(&self, range: Range<usize>) -> Option<Offers> {
        let within = self.table_beside()?;
        let schema = named::table(&self.nodes, &within.stage, &within.table)?;
        let is_free = |column: &&Column| !self.beside.map.iter().any(|pair| pair.key == column.name);
        let all = schema.columns.iter().filter(is_free).map(|column| of_column(column, ": ")).collect();
        Some(Offers { range, all })
    }

    /// What stands at `offset` of a text.
    pub fn found(&self, text: &str, node: &Tree, offset: usize) -> Option<Found> {
        let written = Written::of(text, node);
        let rest = written.text.get(offset.checked_sub(written.start)?..)?;
        let end = rest.find(['.', '[', '=', ',', ']', '"', '\'', ' ']).map_or(written.end(), |at| offset + at);
        let head = written.until(end)?;
        let (spot, start) = self.spot(head)?;
        let word = head[start..].trim();
        match &spot {
            Spot::Stage => {
                let node = self.nodes.iter().find(|node| node.name == word)?;
                self.said(word, of_kind(node.kind))
            }
            Spot::Table { stage } => self.of_table(&named::table(&self.nodes, stage, word)?, stage),
            Spot::Column(within) | Spot::Condition(within) => self.column(within, word),
            Spot::Value(within, column) => self.column(within, column),
            Spot::Either(within) => self
                .column(within, word)
                .or_else(|| self.of_table(&named::table(&self.nodes, &within.stage, word)?, &within.stage)),
        }
    }

    /// What a name in a map of conditions is.
    pub fn found_name(&self, name: &str) -> Option<Found> {
        self.column(&self.table_beside()?, name)
    }

    fn of_table(&self, schema: &Schema, stage: &str) -> Option<Found> {
        self.said(stage, format!("{stage}.{}\n{}", schema.name, schema.description))
    }

    fn column(&self, within: &Within, name: &str) -> Option<Found> {
        let schema = named::table(&self.nodes, &within.stage, &within.table)?;
        let Column { unit, description, .. } = schema.column(name)?;
        let unit = if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
        self.said(&within.stage, format!("{}.{}.{name}{unit}\n{description}", within.stage, within.table))
    }

    fn said(&self, stage: &str, described: String) -> Option<Found> {
        let declared = self.all.iter().find(|pair| pair.key == stage)?.place;
        Some(Found { described, declared: Some(declared) })
    }

    /// What is named behind `head`, and where in it that begins.
    fn spot(&self, head: &str) -> Option<(Spot, usize)> {
        let plain = |spot| Some((spot, 0));
        match self.names {
            Names::Columns { .. } => match self.beside.name {
                Some(column) => plain(Spot::Value(self.table_beside()?, column.to_owned())),
                None => plain(Spot::Column(self.table_beside()?)),
            },
            Names::Table => match spot(head)? {
                (found @ (Spot::Stage | Spot::Table { .. }), start) => Some((found, start)),
                _ => None,
            },
            Names::Cells => spot(head),
            Names::CellsOf { stage, table } => shortened(self.text_beside(stage)?, table, head),
            Names::CellsOfKind { kind, table } => {
                let node = self.nodes.iter().find(|node| node.kind.name == kind)?;
                shortened(&node.name, table, head)
            }
        }
    }

    fn named(&self, spot: &Spot) -> Vec<Offer> {
        let tables = |stage: &str| named::tables(&self.nodes, stage).into_iter();
        let of_table = |schema: Schema| offer(&schema.name, &schema.description, &schema.name);
        let schema = |within: &Within| named::table(&self.nodes, &within.stage, &within.table);
        match spot {
            Spot::Stage => {
                let others = self.nodes.iter().filter(|node| Some(node.name.as_str()) != self.beside.stage);
                others.map(|node| offer(&node.name, node.kind.name, &node.name)).collect()
            }
            Spot::Table { stage } => tables(stage).map(of_table).collect(),
            Spot::Column(within) => schema(within).map_or_else(Vec::new, |schema| self.columns(&schema)),
            Spot::Either(within) => {
                let columns = schema(within).map_or_else(Vec::new, |schema| self.columns(&schema));
                columns.into_iter().chain(tables(&within.stage).map(of_table)).collect()
            }
            Spot::Condition(within) => {
                let Some(schema) = schema(within) else { return Vec::new() };
                // By its key a row is told from all others.
                let mut columns: Vec<&Column> = schema.columns.iter().collect();
                columns.sort_by_key(|column| !column.key);
                columns.into_iter().map(|column| of_column(column, "=")).collect()
            }
            Spot::Value(within, column) => {
                let Some(schema) = schema(within) else { return Vec::new() };
                let Some(column) = schema.column(column) else { return Vec::new() };
                let values =
                    named::Keys::new(&self.nodes).of(&within.stage, &within.table, &column.name).unwrap_or_default();
                let written = values.into_iter().map(|value| match value {
                    Cell::Float(value) => format!("{value} {}", column.unit).trim_end().to_owned(),
                    other => other.to_string(),
                });
                written.map(|value| offer(&value, &column.description, &value)).collect()
            }
        }
    }

    /// Those that the field can name: a cell is a number, and seldom a key.
    fn columns(&self, schema: &Schema) -> Vec<Offer> {
        let all_fit = matches!(self.names, Names::Columns { .. });
        let is_number = |column: &Column| matches!(column.kind, Type::Float | Type::Integer) && !column.volatile;
        let mut columns: Vec<&Column> = schema.columns.iter().filter(|column| all_fit || is_number(column)).collect();
        columns.sort_by_key(|column| !all_fit && column.key);
        columns.into_iter().map(|column| of_column(column, "")).collect()
    }

    /// The table in the field beside this one, the first of several.
    fn table_beside(&self) -> Option<Within> {
        let Names::Columns { table } = self.names else { return None };
        let (stage, table) = self.text_beside(table)?.trim().split_once('.')?;
        Some(Within { stage: stage.to_owned(), table: table.to_owned() })
    }

    fn text_beside(&self, field: &str) -> Option<&'a str> {
        let mut node = &self.beside.pairs.iter().find(|pair| pair.key == field)?.node;
        if let Content::Sequence(items) = &node.content {
            node = items.first()?;
        }
        let Content::Scalar { text, .. } = &node.content else { return None };
        Some(text)
    }
}

fn of_column(column: &Column, behind: &str) -> Offer {
    offer(&column.name, &named::meaning(&column.unit, &column.description), &format!("{}{behind}", column.name))
}

/// Of a text in which the stage is not said, and where it is `table` not the table either.
fn shortened(stage: &str, table: Option<&str>, head: &str) -> Option<(Spot, usize)> {
    if let (Some(table), false) = (table, head.contains(['.', '[', ' '])) {
        let within = Within { stage: stage.to_owned(), table: table.to_owned() };
        return Some((Spot::Either(within), 0));
    }
    let (found, start) = spot(&format!("{stage}.{head}"))?;
    Some((found, start.checked_sub(stage.len() + 1)?))
}

/// Of a text that says all.
fn spot(head: &str) -> Option<(Spot, usize)> {
    let within = |stage: &str, table: &str| Within { stage: stage.trim().to_owned(), table: table.trim().to_owned() };
    let Some((name, inside)) = head.split_once('[') else {
        let start = head.rfind('.').map_or(0, |at| at + 1);
        let found = match head.split('.').collect::<Vec<_>>()[..] {
            [_] => Spot::Stage,
            [stage, _] => Spot::Table { stage: stage.trim().to_owned() },
            [stage, table, _] => Spot::Column(within(stage, table)),
            _ => return None,
        };
        // Behind a blank there is something else than a name.
        return (!head.contains(' ')).then_some((found, start));
    };
    let (stage, table) = name.split_once('.')?;
    let within = within(stage, table);
    if let Some((_, behind)) = inside.rsplit_once(']') {
        let column = behind.strip_prefix('.')?;
        return (!column.contains([' ', '.'])).then(|| (Spot::Column(within), head.len() - column.len()));
    }
    let part = inside.rsplit(',').next().unwrap_or(inside);
    Some(match part.split_once('=') {
        Some((column, value)) => (Spot::Value(within, column.trim().to_owned()), head.len() - value.trim_start().len()),
        None => (Spot::Condition(within), head.len() - part.trim_start().len()),
    })
}

/// The text of a value as it is written, without the quote before it.
struct Written<'a> {
    text: &'a str,
    start: usize,
}

impl<'a> Written<'a> {
    fn of(text: &'a str, node: &Tree) -> Self {
        let start = node.place.offset;
        let start = start + usize::from(text[start..].starts_with(['"', '\'']));
        Self { text: text[start..].lines().next().unwrap_or(""), start }
    }

    fn end(&self) -> usize {
        self.start + self.text.len()
    }

    /// What stands before a byte of the study; none where that is on another line.
    fn until(&self, offset: usize) -> Option<&'a str> {
        self.text.get(..offset.checked_sub(self.start)?)
    }
}
