//! What stages say of each other: names that exist, kinds that fit, no circle, tables and columns that are there.
//!
//! Must not know: when or how stages run.

use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};

use super::Node;
use super::blame::{Blame, Built};
use super::decode::Reference;
use super::quantity::interval::Interval;
use super::words::{alternatives, article, quote, stage_of};
use crate::stage::{Kind, Port, Want};
use crate::table::schema::Schema;
use crate::table::select::CellName;
use crate::table::tolerance::Allowance;
use declare::error::{Diagnostic, Place, nearest, suggest};
use declare::record::{Record, Value};

/// An edge of the graph: the stage that is read, and where that is said.
type Edge = (usize, Place);

/// A stage whose fields are read, as far as they can be, but which is not built yet.
pub struct Draft {
    pub name: String,
    pub place: Place,
    /// Whether no stage can have this name.
    pub is_misnamed: bool,
    pub kind: Option<&'static Kind>,
    pub record: Option<Record>,
    pub references: Vec<Reference>,
    /// Its numbers that are written as intervals.
    pub intervals: Vec<Interval>,
}

/// Checks the fields that name a stage: that there is one, of a kind that fits, and no circle of them.
pub fn check_references(drafts: &[Draft], blame: &mut Blame) {
    let index = by_name(drafts.iter().map(|draft| draft.name.as_str()));
    let mut edges = Vec::with_capacity(drafts.len());
    let (earlier, mut unfit) = (blame.wrong.len(), BTreeSet::new());
    for (at, draft) in drafts.iter().enumerate() {
        let mut own = Vec::new();
        for reference in &draft.references {
            // A stage whose kind cannot be read may be of any.
            let fits = |other: &Draft| {
                reference.kinds.is_empty() || other.kind.is_none_or(|kind| reference.kinds.contains(&kind.name))
            };
            let target = index.get(reference.stage.as_str()).copied();
            if let Some(target) = target.filter(|target| fits(&drafts[*target])) {
                own.push((target, reference.place));
            } else if target.is_none() && blame.is_misnamed {
                blame.doubt(at);
            } else {
                let found = target.and_then(|target| drafts[target].kind).map(|kind| kind.name);
                // Of those whose kind can be read.
                let others =
                    drafts.iter().filter(|other| other.kind.is_some() && fits(other) && other.name != draft.name);
                let others = others.map(|other| other.name.as_str()).collect();
                blame.put(at, does_not_fit(reference, found, others));
                unfit.insert(reference.place.offset);
            }
        }
        edges.push(own);
    }
    // What was found of such a stage before follows from that.
    let found = blame.wrong.split_off(earlier);
    blame.wrong.retain(|told| told.place.is_none_or(|place| !unfit.contains(&place.offset)));
    blame.wrong.extend(found);
    let names: Vec<_> = drafts.iter().map(|draft| draft.name.as_str()).collect();
    check_circles(&names, &edges, blame);
}

/// Checks that every tolerance is meant for a column that is there, and fits it. It may be meant for a stage that is not there,
/// unless all are.
pub fn check_tolerances(tolerances: &[(Allowance, Place)], nodes: &[Node], are_all: bool) -> Vec<Diagnostic> {
    let mut wrong = Vec::new();
    for (allowance, place) in tolerances {
        let mut known = Vec::new();
        let mut found = false;
        for node in nodes {
            for schema in node.stage.outputs() {
                for column in &schema.columns {
                    known.push(format!("{}.{}.{}", node.name, schema.name, column.name));
                    if allowance.means(&node.name, &schema.name, &column.name) {
                        found = true;
                        wrong.extend(allowance.of(column).err().map(|problem| Diagnostic::new(problem).at(*place)));
                    }
                }
            }
        }
        let begins_so = |node: &Node| allowance.name.strip_prefix(&node.name).is_some_and(|rest| rest.starts_with('.'));
        if !found && (are_all || nodes.iter().any(begins_so)) {
            let parts = allowance.name.split('.').count();
            let same = known.iter().map(|full| full.splitn(4 - parts, '.').last().unwrap_or(full));
            let help = suggest(&allowance.name, same.collect::<Vec<_>>());
            let message = format!("there is no column {}", quote(&allowance.name));
            wrong.push(Diagnostic::new(message).at(*place).help(help));
        }
    }
    wrong
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

/// Checks what built stages read from each other: that stage, table and column are there, and no circle of stages. What is
/// read from a stage that could not be built is not known.
pub fn check_ports(built: &[Built], blame: &mut Blame) {
    let name = |one: &Built| one.as_ref().map_or_else(Clone::clone, |node| node.name.clone());
    let names: Vec<String> = built.iter().map(name).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let index = by_name(names.iter().copied());
    let ports: Vec<Vec<Port>> =
        built.iter().map(|one| one.as_ref().map_or_else(|_| Vec::new(), |node| node.stage.inputs())).collect();
    let nodes = || built.iter().enumerate().filter_map(|(at, one)| Some((at, one.as_ref().ok()?)));
    // What a stage reads that has something wrong with it is not known.
    let is_known: Vec<bool> = built.iter().enumerate().map(|(at, one)| one.is_ok() && !blame.is_unsound(at)).collect();
    // Where a reference fits no stage, nothing can be read.
    let told: BTreeSet<usize> = blame.wrong.iter().filter_map(|found| Some(found.place?.offset)).collect();
    // A record may name a stage twice, once rightly.
    let is_told = |node: &Node, port: &Port| {
        let are_told = |places: Vec<Place>| places.iter().any(|place| told.contains(&place.offset));
        !told.is_empty() && (told.contains(&place_of(node, port).offset) || are_told(references(&node.record, port)))
    };
    let mut edges = vec![Vec::new(); built.len()];
    for (at, node) in nodes() {
        for port in &ports[at] {
            let place = place_of(node, port);
            if told.contains(&place.offset) {
                continue;
            }
            if let Some(target) = index.get(port.stage.as_str()) {
                edges[at].push((*target, place));
            } else if blame.is_misnamed {
                blame.doubt(at);
            } else {
                let others = names.iter().copied().filter(|name| *name != node.name);
                let help = suggest(&port.stage, others.collect::<Vec<_>>());
                blame.put(at, no_stage(&port.stage).at(place).help(help));
            }
        }
    }
    check_circles(&names, &edges, blame);

    // Of stages that others read; they may be many, and those that are read few.
    let outputs: Vec<OnceCell<Vec<Schema>>> = built.iter().map(|_| OnceCell::new()).collect();
    let given = |at: usize| {
        let node = built[at].as_ref().ok()?;
        Some((node, outputs[at].get_or_init(|| node.stage.outputs()).as_slice()))
    };
    for (at, node) in nodes() {
        for port in ports[at].iter().filter(|port| port.only_for.is_empty() && !is_told(node, port)) {
            let target = match source(port, &index, &is_known, &ports) {
                Ok(target) => target,
                Err(found) => {
                    blame.put(at, found.at(place_of(node, port)));
                    continue;
                }
            };
            let Some((read, schemas)) = target.and_then(given) else { continue };
            for want in &port.wants {
                for (found, column) in missing(read, want, schemas) {
                    for place in places_of(node, port, &want.table, column) {
                        blame.put(at, found.clone().at(place));
                    }
                }
                let needed = target.into_iter().flat_map(|target| &ports[target]);
                for (needed, column) in needed.filter_map(|needed| Some((needed, asked(needed, want)?))) {
                    // What that takes in turn, since it is wanted.
                    let from = source(needed, &index, &is_known, &ports).ok().flatten().and_then(given);
                    let Some((from, schemas)) = from else { continue };
                    for (found, _) in needed.wants.iter().flat_map(|want| missing(from, want, schemas)) {
                        let whole = format!("{}.{}.{column}", read.name, want.table);
                        let message = format!("{} cannot be computed: {}", quote(&whole), found.message);
                        for place in places_of(node, port, &want.table, Some(column)) {
                            blame.put(at, Diagnostic { message: message.clone(), ..found.clone() }.at(place));
                        }
                    }
                }
            }
        }
    }
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

/// The stage whose tables a port reads: the one it names, or what that one reads through a port of its own; none where that
/// is not known.
fn source(
    port: &Port,
    index: &BTreeMap<&str, usize>,
    is_known: &[bool],
    ports: &[Vec<Port>],
) -> Result<Option<usize>, Diagnostic> {
    let mut port = port;
    // More steps than stages are a circle, which was told.
    for _ in 0..=ports.len() {
        let Some(&target) = index.get(port.stage.as_str()) else { return Ok(None) };
        let Some(through) = port.through else { return Ok(Some(target)) };
        if !is_known[target] {
            return Ok(None);
        }
        port = ports[target].iter().find(|other| other.name == through).ok_or_else(|| {
            Diagnostic::new(format!("stage {} reads nothing as {}", quote(&port.stage), quote(through)))
        })?;
    }
    Ok(None)
}

/// What is missing of a table that is wanted: itself, or columns, each with its name.
fn missing<'a>(node: &Node, want: &'a Want, outputs: &[Schema]) -> Vec<(Diagnostic, Option<&'a str>)> {
    let stage = node.name.as_str();
    let Some(schema) = outputs.iter().find(|schema| schema.name == want.table) else {
        let message = format!("stage {} has no table {}", quote(stage), quote(&want.table));
        let help = match node.stage.lacks(&want.table) {
            Some(why) => why.to_owned(),
            None => suggest(&want.table, outputs.iter().map(|schema| schema.name.as_str())),
        };
        return vec![(Diagnostic::new(message).help(help), None)];
    };
    let missing = want.columns.iter().filter(|column| schema.column(column).is_none());
    let told = missing.map(|column| {
        let table = format!("{stage}.{}", want.table);
        let message = format!("table {} has no column {}", quote(&table), quote(column));
        let help = suggest(column, schema.columns.iter().map(|column| column.name.as_str()));
        (Diagnostic::new(message).help(help), Some(column.as_str()))
    });
    told.collect()
}

/// Where a record says that a port is read: a reference to the stage, a text that begins with the stage, or the record itself.
fn place_of(node: &Node, port: &Port) -> Place {
    let record = &node.record;
    let begins_so = |value: &Value| matches!(value, Value::Text(text) if begins(text, &port.stage));
    let found = references(record, port).first().copied();
    let found = found.or_else(|| find(record, &begins_so).first().copied());
    found.or_else(|| places_named(node, port, &|_| true).first().copied()).unwrap_or(record.place)
}

/// Where a record refers to the stage of a port.
fn references(record: &Record, port: &Port) -> Vec<Place> {
    find(record, &|value| matches!(value, Value::Reference(name) if *name == port.stage))
}

/// Where a record says that a table is read, or a column of it: in every text that begins with `stage.table` and has the
/// column in it or beside it, else in all that begin so, else as [`place_of`].
fn places_of(node: &Node, port: &Port, table: &str, column: Option<&str>) -> Vec<Place> {
    let record = &node.record;
    let cells = |column: Option<&str>| {
        let is_it = |cell: &CellName| cell.table == table && column.is_none_or(|column| cell.column == column);
        places_named(node, port, &is_it)
    };
    let whole = format!("{}.{table}", port.stage);
    let texts = |test: &dyn Fn(&str) -> bool| {
        find(record, &|value| matches!(value, Value::Text(text) if begins(text, &whole) && test(text)))
    };
    let with_column = column.map_or_else(Vec::new, |column| {
        let mut places = texts(&|text| has_word(text, column));
        beside(record, &whole, column, &mut places);
        // A cell need not be written in one piece.
        places.extend(cells(Some(column)));
        places.sort_by_key(|place| place.offset);
        places.dedup_by_key(|place| place.offset);
        places
    });
    let places = if with_column.is_empty() { texts(&|_| true) } else { with_column };
    let places = if places.is_empty() { cells(None) } else { places };
    if places.is_empty() { vec![place_of(node, port)] } else { places }
}

/// Where a stage names cells of what a port reads.
fn places_named(node: &Node, port: &Port, is_it: &dyn Fn(&CellName) -> bool) -> Vec<Place> {
    let named = node.stage.named().into_iter().filter(|named| named.cell.stage == port.stage && is_it(&named.cell));
    named.map(|named| named.place).collect()
}

/// The places where a column stands beside its table, each a text of its own in one record.
fn beside(record: &Record, table: &str, column: &str, places: &mut Vec<Place>) {
    let of = |test: &dyn Fn(&str) -> bool| {
        let own = record.fields.iter().filter(|(_, entry)| inner(&entry.value).is_empty());
        let is_it = |value: &Value| matches!(value, Value::Text(text) if test(text));
        own.flat_map(|(_, entry)| find_in(&entry.value, entry.place, &is_it)).collect::<Vec<_>>()
    };
    if !of(&|text| text == table).is_empty() {
        places.extend(of(&|text| text == column));
    }
    for (_, entry) in &record.fields {
        for record in inner(&entry.value) {
            beside(record, table, column, places);
        }
    }
}

/// The records that a value holds.
fn inner(value: &Value) -> Vec<&Record> {
    match value {
        Value::List(entries) => entries.iter().flat_map(|entry| inner(&entry.value)).collect(),
        Value::Map(entries) => entries.iter().flat_map(|(_, entry)| inner(&entry.value)).collect(),
        other => other.record().into_iter().collect(),
    }
}

fn in_name(character: char) -> bool {
    character.is_alphanumeric() || character == '_' || character == '-'
}

fn begins(text: &str, with: &str) -> bool {
    text.strip_prefix(with).is_some_and(|rest| !rest.starts_with(in_name))
}

fn has_word(text: &str, word: &str) -> bool {
    text.split(|character| !in_name(character)).any(|part| part == word)
}

/// The places of all values that pass the test, in the order of the record.
fn find(record: &Record, test: &dyn Fn(&Value) -> bool) -> Vec<Place> {
    record.fields.iter().flat_map(|(_, entry)| find_in(&entry.value, entry.place, test)).collect()
}

fn find_in(value: &Value, place: Place, test: &dyn Fn(&Value) -> bool) -> Vec<Place> {
    if test(value) {
        return vec![place];
    }
    match value {
        Value::List(entries) => entries.iter().flat_map(|entry| find_in(&entry.value, entry.place, test)).collect(),
        Value::Map(entries) => entries.iter().flat_map(|(_, entry)| find_in(&entry.value, entry.place, test)).collect(),
        other => other.record().map_or_else(Vec::new, |record| find(record, test)),
    }
}

/// Walks the graph depth first, without recursion: a study may have very many stages. The first circle is told.
fn check_circles(names: &[&str], edges: &[Vec<Edge>], blame: &mut Blame) {
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
                    let circle: Vec<usize> = circle.collect();
                    let found = circle_found(circle.iter().map(|&stage| names[stage]).collect()).at(place);
                    blame.put_on_all(circle, found);
                    return;
                }
            }
        }
    }
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
