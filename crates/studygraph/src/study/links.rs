//! What stages say of each other: names that exist, kinds that fit, no circle, tables and columns that are there.
//!
//! Must not know: when or how stages run.

use std::cell::OnceCell;
use std::collections::BTreeMap;

use super::Node;
use super::decode::Reference;
use super::words::{alternatives, article, quote, stage_of};
use crate::stage::{Kind, Port, Want};
use crate::table::schema::Schema;
use crate::table::tolerance::Allowance;
use declare::error::{Diagnostic, Place, nearest, suggest};
use declare::record::{Record, Value};

/// An edge of the graph: the stage that is read, and where that is said.
type Edge = (usize, Place);

/// Checks the fields that name a stage.
///
/// A stage whose fields are read but which is not built yet.
pub struct Draft {
    pub name: String,
    pub place: Place,
    pub kind: &'static Kind,
    pub record: Record,
    pub references: Vec<Reference>,
}

/// # Errors
/// When the stage is missing or of a wrong kind, or the stages read each other in a circle.
pub fn check_references(drafts: &[Draft]) -> Result<(), Diagnostic> {
    let index = by_name(drafts.iter().map(|draft| draft.name.as_str()));
    let mut edges = Vec::with_capacity(drafts.len());
    for draft in drafts {
        let mut own = Vec::new();
        for reference in &draft.references {
            let fits = |kind: &str| reference.kinds.is_empty() || reference.kinds.contains(&kind);
            let target = index.get(reference.stage.as_str()).copied();
            let Some(target) = target.filter(|target| fits(drafts[*target].kind.name)) else {
                let found = target.map(|target| drafts[target].kind.name);
                let others = drafts.iter().filter(|other| fits(other.kind.name) && other.name != draft.name);
                return Err(does_not_fit(reference, found, others.map(|other| other.name.as_str()).collect()));
            };
            own.push((target, reference.place));
        }
        edges.push(own);
    }
    let names: Vec<_> = drafts.iter().map(|draft| draft.name.as_str()).collect();
    check_circles(&names, &edges)
}

/// Checks that every tolerance is meant for a column that is there, and fits it.
///
/// # Errors
/// When there is no such column, or one holds no numbers or numbers in another unit.
pub fn check_tolerances(tolerances: &[(Allowance, Place)], nodes: &[Node]) -> Result<(), Diagnostic> {
    for (allowance, place) in tolerances {
        let mut known = Vec::new();
        let mut found = false;
        for node in nodes {
            for schema in node.stage.outputs() {
                for column in &schema.columns {
                    known.push(format!("{}.{}.{}", node.name, schema.name, column.name));
                    if allowance.means(&node.name, &schema.name, &column.name) {
                        found = true;
                        allowance.of(column).map_err(|problem| Diagnostic::new(problem).at(*place))?;
                    }
                }
            }
        }
        if !found {
            let parts = allowance.name.split('.').count();
            let same = known.iter().map(|full| full.splitn(4 - parts, '.').last().unwrap_or(full));
            let help = suggest(&allowance.name, same.collect::<Vec<_>>());
            let message = format!("there is no column {}", quote(&allowance.name));
            return Err(Diagnostic::new(message).at(*place).help(help));
        }
    }
    Ok(())
}

/// A reference to no stage, or to one of the kind `found`; `fitting` are the stages that would do.
fn does_not_fit(reference: &Reference, found: Option<&str>, fitting: Vec<&str>) -> Diagnostic {
    let message = match found {
        None => format!("there is no stage {}", quote(&reference.stage)),
        Some(kind) => {
            let (stage, expected) = (quote(&reference.stage), stage_of(reference.kinds));
            format!("{stage} is {} `{kind}` stage; {expected} is expected", article(kind))
        }
    };
    let near = if found.is_none() { nearest(&reference.stage, fitting.iter().copied()) } else { None };
    let help = match (near, fitting.is_empty()) {
        (Some(near), _) => format!("did you mean `{near}`?"),
        (None, false) => format!("stages that fit here: {}", alternatives(fitting)),
        (None, true) => format!("{} is expected, and there is none in this study", stage_of(reference.kinds)),
    };
    Diagnostic::new(message).at(reference.place).help(help)
}

/// Checks what built stages read from each other.
///
/// # Errors
/// When a stage, table or column is missing, or the stages read each other in a circle.
pub fn check_ports(nodes: &[Node]) -> Result<(), Diagnostic> {
    let index = by_name(nodes.iter().map(|node| node.name.as_str()));
    let ports: Vec<Vec<Port>> = nodes.iter().map(|node| node.stage.inputs()).collect();
    // Of stages that others read; they may be many, and those that are read few.
    let outputs: Vec<OnceCell<Vec<Schema>>> = nodes.iter().map(|_| OnceCell::new()).collect();
    let outputs = |node: usize| outputs[node].get_or_init(|| nodes[node].stage.outputs()).as_slice();
    let mut edges = Vec::with_capacity(nodes.len());
    for (node, own) in nodes.iter().zip(&ports) {
        let edge = |port: &Port| {
            let place = place_of(&node.record, port, None);
            let target = index.get(port.stage.as_str()).copied();
            target.map(|target| (target, place)).ok_or_else(|| {
                let help =
                    suggest(&port.stage, index.keys().copied().filter(|name| *name != node.name).collect::<Vec<_>>());
                no_stage(&port.stage).at(place).help(help)
            })
        };
        edges.push(own.iter().map(edge).collect::<Result<Vec<_>, _>>()?);
    }
    let names: Vec<_> = nodes.iter().map(|node| node.name.as_str()).collect();
    check_circles(&names, &edges)?;

    for (node, own) in nodes.iter().zip(&ports) {
        for port in own.iter().filter(|port| port.only_for.is_empty()) {
            let target = source(port, &index, &ports).map_err(|found| found.at(place_of(&node.record, port, None)))?;
            for want in &port.wants {
                check_want(&nodes[target], want, outputs(target))
                    .map_err(|(found, column)| found.at(place_of(&node.record, port, Some((&want.table, column)))))?;
                // What that takes in turn, since it is wanted.
                for needed in &ports[target] {
                    let Some(column) = asked(needed, want) else { continue };
                    let from = source(needed, &index, &ports)?;
                    for missing in &needed.wants {
                        check_want(&nodes[from], missing, outputs(from)).map_err(|(found, _)| {
                            let whole = format!("{}.{}.{column}", nodes[target].name, want.table);
                            let message = format!("{} cannot be computed: {}", quote(&whole), found.message);
                            let place = place_of(&node.record, port, Some((&want.table, Some(column))));
                            Diagnostic { message, ..found }.at(place)
                        })?;
                    }
                }
            }
        }
    }
    Ok(())
}

/// The column on demand among those that are wanted for which a port is read.
fn asked<'a>(port: &Port, want: &'a Want) -> Option<&'a str> {
    let read_for = |column: &&String| port.only_for.contains(&(&*want.table, &***column));
    want.columns.iter().find(read_for).map(String::as_str)
}

fn by_name<'a>(names: impl Iterator<Item = &'a str>) -> BTreeMap<&'a str, usize> {
    names.enumerate().map(|(at, name)| (name, at)).collect()
}

fn no_stage(name: &str) -> Diagnostic {
    Diagnostic::new(format!("there is no stage {}", quote(name)))
}

/// The stage whose tables a port reads: the one it names, or what that one reads through a port of its own.
fn source(port: &Port, index: &BTreeMap<&str, usize>, ports: &[Vec<Port>]) -> Result<usize, Diagnostic> {
    let mut port = port;
    loop {
        let target = *index.get(port.stage.as_str()).ok_or_else(|| no_stage(&port.stage))?;
        let Some(through) = port.through else { return Ok(target) };
        port = ports[target].iter().find(|other| other.name == through).ok_or_else(|| {
            Diagnostic::new(format!("stage {} reads nothing as {}", quote(&port.stage), quote(through)))
        })?;
    }
}

/// Says with the error which column is missing, if it is not the table.
fn check_want<'a>(node: &Node, want: &'a Want, outputs: &[Schema]) -> Result<(), (Diagnostic, Option<&'a str>)> {
    let stage = node.name.as_str();
    let Some(schema) = outputs.iter().find(|schema| schema.name == want.table) else {
        let message = format!("stage {} has no table {}", quote(stage), quote(&want.table));
        let help = match node.stage.lacks(&want.table) {
            Some(why) => why.to_owned(),
            None => suggest(&want.table, outputs.iter().map(|schema| schema.name.as_str())),
        };
        return Err((Diagnostic::new(message).help(help), None));
    };
    let missing = want.columns.iter().find(|column| schema.column(column).is_none());
    missing.map_or(Ok(()), |column| {
        let table = format!("{stage}.{}", want.table);
        let message = format!("table {} has no column {}", quote(&table), quote(column));
        let help = suggest(column, schema.columns.iter().map(|column| column.name.as_str()));
        Err((Diagnostic::new(message).help(help), Some(column)))
    })
}

/// Where a record says what a port reads: a text that begins with `stage.table` (and has the column in it), a
/// reference to the stage, a text that begins with the stage, or the record itself.
fn place_of(record: &Record, port: &Port, wanted: Option<(&str, Option<&str>)>) -> Place {
    let text = |test: &dyn Fn(&str) -> bool| find(record, &|value| matches!(value, Value::Text(text) if test(text)));
    let cell = wanted.and_then(|(table, column)| {
        let table = format!("{}.{table}", port.stage);
        let with_column = column.and_then(|column| text(&|cell| begins(cell, &table) && has_word(cell, column)));
        with_column.or_else(|| text(&|cell| begins(cell, &table)))
    });
    cell.or_else(|| find(record, &|value| matches!(value, Value::Reference(name) if *name == port.stage)))
        .or_else(|| text(&|cell| begins(cell, &port.stage)))
        .unwrap_or(record.place)
}

fn in_name(character: char) -> bool {
    character.is_alphanumeric() || character == '_' || character == '-'
}

pub(super) fn begins(text: &str, with: &str) -> bool {
    text.strip_prefix(with).is_some_and(|rest| !rest.starts_with(in_name))
}

fn has_word(text: &str, word: &str) -> bool {
    text.split(|character| !in_name(character)).any(|part| part == word)
}

/// The first value that passes the test, in the order of the record.
pub(super) fn find(record: &Record, test: &dyn Fn(&Value) -> bool) -> Option<Place> {
    record.fields.iter().find_map(|(_, entry)| find_in(&entry.value, entry.place, test))
}

fn find_in(value: &Value, place: Place, test: &dyn Fn(&Value) -> bool) -> Option<Place> {
    if test(value) {
        return Some(place);
    }
    match value {
        Value::List(entries) => entries.iter().find_map(|entry| find_in(&entry.value, entry.place, test)),
        Value::Map(entries) => entries.iter().find_map(|(_, entry)| find_in(&entry.value, entry.place, test)),
        other => other.record().and_then(|record| find(record, test)),
    }
}

/// Walks the graph depth first, without recursion: a study may have very many stages.
fn check_circles(names: &[&str], edges: &[Vec<Edge>]) -> Result<(), Diagnostic> {
    #[derive(Clone, Copy, PartialEq)]
    enum Mark {
        New,
        Open,
        Done,
    }
    let mut marks = vec![Mark::New; names.len()];
    for start in 0..names.len() {
        if marks[start] != Mark::New {
            continue;
        }
        marks[start] = Mark::Open;
        let mut path = vec![(start, 0)];
        while let Some((stage, next)) = path.last_mut() {
            let Some(&(target, place)) = edges[*stage].get(*next) else {
                marks[*stage] = Mark::Done;
                path.pop();
                continue;
            };
            *next += 1;
            match marks[target] {
                Mark::Done => {}
                Mark::New => {
                    marks[target] = Mark::Open;
                    path.push((target, 0));
                }
                Mark::Open => {
                    let circle = path.iter().map(|(stage, _)| *stage).skip_while(|stage| *stage != target);
                    return Err(circle_found(circle.map(|stage| names[stage]).collect()).at(place));
                }
            }
        }
    }
    Ok(())
}

fn circle_found(mut circle: Vec<&str>) -> Diagnostic {
    if let [only] = circle.as_slice() {
        return Diagnostic::new(format!("stage {} refers to itself", quote(only)));
    }
    circle.push(circle[0]);
    let mut shown: Vec<_> = circle.iter().map(|name| quote(name)).collect();
    if shown.len() > 12 {
        let middle = format!("{} more", shown.len() - 10);
        shown.splice(5..shown.len() - 5, [middle]);
    }
    let help = "a stage can only read what is finished before it";
    Diagnostic::new(format!("these stages read each other in a circle: {}", shown.join(" → "))).help(help)
}
