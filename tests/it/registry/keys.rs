//! Every input of a stage is in its cache key: any field of any example is changed, and then either the key of a stage is
//! another one, or its tables are the same bit for bit.
//!
//! The tables that come in are those of the unchanged study, so that nothing but the key can notice a change. Stages whose
//! record is unchanged are not run, nor are those whose key is another one.

mod changes;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex};

use changes::{Change, fields, other_numbers};
use declare::digest::Digest;
use declare::error::Failure;
use declare::record::Record;
use declare::seed::Seed;
use declare::work::Tally;
use gearstudy::program::PROGRAM;
use gearstudy::stage::kinds::KINDS;
use gearstudy::stage::{Context, Inputs, Kind, Others};
use studygraph::runner::events::Silent;
use studygraph::runner::execute::execute;
use studygraph::runner::graph::Graph;
use studygraph::runner::key::{Cut, KeyedChunk, parts};
use studygraph::runner::options::Options;
use studygraph::runner::outcome::Outcome;
use studygraph::store::cache::Cache;
use studygraph::store::entry::StoredTable;
use studygraph::study::{Settings, Study, examine_changed_text};
use studygraph::table::data::{Cell, Table};
use studygraph::warning;

/// What a stage gives: each table as its content, and the sentences of its warnings.
type Given = (Vec<(String, Digest)>, Vec<String>);

/// A study with the keys of its stages.
struct Keyed {
    study: Study,
    graph: Graph,
    parts: Vec<Vec<KeyedChunk>>,
    /// By stage, its record without places, for a comparison.
    records: Vec<String>,
}

/// The unchanged study, and the tables that were needed so far, by stage.
struct Base {
    keyed: Keyed,
    tables: BTreeMap<String, Vec<Table>>,
    stored: BTreeMap<String, Vec<StoredTable>>,
    given: BTreeMap<Digest, Given>,
}

fn read(text: &str, set: &[String]) -> Option<Study> {
    let settings = Settings { set: set.to_vec(), name: None };
    examine_changed_text(text, Path::new("t.yaml"), &PROGRAM, &settings).ok()
}

/// A record without the places of its values: `Place { … }` has no braces inside.
fn without_places(record: &Record) -> String {
    let text = format!("{record:?}");
    let mut kept = String::with_capacity(text.len());
    let mut rest = text.as_str();
    while let Some((before, after)) = rest.split_once("Place {") {
        kept += before;
        rest = after.split_once('}').map_or("", |(_, after)| after);
    }
    kept + rest
}

impl Keyed {
    /// None where what stages read of each other does not go together.
    fn new(study: Study, stored: &BTreeMap<String, Vec<StoredTable>>) -> Option<Self> {
        let graph = Graph::new(&study, &[]).ok()?;
        let none = Vec::new();
        let of_node = |node: usize| stored.get(&study.nodes[node].name).unwrap_or(&none).as_slice();
        let keyed = (0..study.nodes.len()).map(|node| parts(&study, &graph, node, of_node)).collect();
        let records = study.nodes.iter().map(|node| without_places(&node.record)).collect();
        Some(Self { parts: keyed, graph, records, study })
    }

    fn position(&self, name: &str) -> Option<usize> {
        self.study.nodes.iter().position(|node| node.name == name)
    }

    /// The tables of a part of a stage with what others give, and what it warns of.
    fn run(
        &self,
        node: usize,
        part: usize,
        tables: &BTreeMap<String, Vec<Table>>,
    ) -> Result<(Vec<Table>, Vec<String>), String> {
        let of_study = &self.study.nodes[node];
        let mut inputs = Inputs::default();
        for input in &self.graph.inputs[node] {
            let from = tables.get(&self.study.nodes[input.node].name);
            let wanted = |table: &&Table| input.wants.iter().any(|want| want.table == table.name());
            inputs.ports.insert(input.port.clone(), from.into_iter().flatten().filter(wanted).collect());
        }
        let (stop, warnings) = (AtomicBool::new(false), Mutex::new(Vec::new()));
        let is_drawn = of_study.stage.uses_seed();
        let context = Context {
            seed: if is_drawn { Seed::of_stage(self.study.seed, &of_study.name) } else { Seed::of_stage(0, "") },
            demand: &self.graph.demands[node],
            stop: &stop,
            progress: &|_| (),
            warn: &|warning| warnings.lock().unwrap().push(warning),
            is_heard: true,
            work: &Tally::default(),
        };
        let others = Parts { keyed: self, node, tables };
        let found = match &self.parts[node][part].cut {
            Cut::Whole => of_study.stage.run(&context, &inputs),
            Cut::Axis(field, values) => {
                let built = (of_study.kind.build)(&of_study.record.with_axis(field, values));
                built.map_err(|wrong| wrong.first.message.clone())?.run(&context, &inputs)
            }
            Cut::Part { index, .. } => of_study.stage.run_part(*index, &context, &inputs, &others),
        };
        let found = found.map_err(|failure| format!("{failure}"))?;
        Ok((found, warning::sentences(warnings.into_inner().unwrap())))
    }
}

/// The parts of a stage, each computed when it is read.
struct Parts<'k> {
    keyed: &'k Keyed,
    node: usize,
    tables: &'k BTreeMap<String, Vec<Table>>,
}

impl Others for Parts<'_> {
    fn of_part(&self, part: usize, table: &str) -> Result<Arc<Table>, Failure> {
        let (tables, _) = self.keyed.run(self.node, part, self.tables).map_err(Failure::new)?;
        let found = tables.into_iter().find(|found| found.name() == table);
        found.map(Arc::new).ok_or_else(|| Failure::new("there is no such table"))
    }

    fn earlier(&self, _table: &str, _first: &[Cell], _last: &[Cell]) -> Vec<Arc<Table>> {
        Vec::new()
    }
}

fn given(ran: Result<(Vec<Table>, Vec<String>), String>) -> Given {
    match ran {
        Ok((tables, warnings)) => {
            (tables.iter().map(|table| (table.name().to_owned(), table.content_hash())).collect(), warnings)
        }
        Err(reason) => (Vec::new(), vec![reason]),
    }
}

impl Base {
    fn new(text: &str) -> Self {
        let study = read(text, &[]).unwrap_or_else(|| panic!("the examples are no study:\n{text}"));
        let mut stored = BTreeMap::new();
        let mut tables: BTreeMap<String, Vec<Table>> = BTreeMap::new();
        let graph = Graph::new(&study, &[]).unwrap();
        // Those alone that others read.
        for &node in graph.order.iter().filter(|node| !graph.readers[**node].is_empty()) {
            let keyed = Keyed::new(read(text, &[]).unwrap(), &stored).unwrap();
            let mut whole = Vec::new();
            for part in 0..keyed.parts[node].len() {
                let (found, _) = keyed.run(node, part, &tables).unwrap();
                whole.push(found);
            }
            let whole = together(whole);
            let name = study.nodes[node].name.clone();
            stored.insert(name.clone(), whole.iter().map(|table| StoredTable::describe(table).unwrap()).collect());
            tables.insert(name, whole);
        }
        let keyed = Keyed::new(study, &stored).unwrap();
        Self { keyed, tables, stored, given: BTreeMap::new() }
    }

    /// The stages of a changed study that changed and have a part with a key of the unchanged one, and other tables there.
    fn stale(&mut self, changed: &Keyed) -> Vec<String> {
        let mut stale = Vec::new();
        for (node, of_node) in changed.study.nodes.iter().enumerate() {
            let Some(own) = self.keyed.position(&of_node.name) else { continue };
            let is_drawn = of_node.stage.uses_seed() || self.keyed.study.nodes[own].stage.uses_seed();
            let is_alike = changed.records[node] == self.keyed.records[own];
            if is_alike && (!is_drawn || changed.study.seed == self.keyed.study.seed) {
                continue;
            }
            for (part, keyed) in changed.parts[node].iter().enumerate() {
                let Some(known) = self.keyed.parts[own].iter().position(|known| known.key == keyed.key) else {
                    continue;
                };
                let before = match self.given.get(&keyed.key) {
                    Some(before) => before.clone(),
                    None => given(self.keyed.run(own, known, &self.tables)),
                };
                self.given.insert(keyed.key, before.clone());
                if given(changed.run(node, part, &self.tables)) != before {
                    stale.push(of_node.name.clone());
                }
            }
        }
        stale.dedup();
        stale
    }
}

/// The tables of all parts, each by its name.
fn together(parts: Vec<Vec<Table>>) -> Vec<Table> {
    let mut by_name: Vec<(String, Vec<Table>)> = Vec::new();
    for table in parts.into_iter().flatten() {
        match by_name.iter_mut().find(|(name, _)| name == table.name()) {
            Some((_, tables)) => tables.push(table),
            None => by_name.push((table.name().to_owned(), vec![table])),
        }
    }
    by_name.into_iter().filter_map(|(_, tables)| Table::concatenated(tables).unwrap()).collect()
}

/// The stages by which tables of a stage are reached, itself and those that compute it anew among them.
fn closure(kind: &Kind) -> BTreeSet<&'static str> {
    let names = |text: &str| -> Vec<&'static str> {
        let words: BTreeSet<&str> = text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).collect();
        KINDS.iter().map(|kind| kind.name).filter(|name| words.contains(name)).collect()
    };
    let reads = |kind: &Kind| -> Vec<&'static str> { names(kind.example).into_iter().collect() };
    let mut found: BTreeSet<&'static str> = [kind.name].into();
    let anew = ["limit", "fit", "sweep", "scatter", "report", "accuracy"];
    if ["geometry", "modification", "stiffness", "ste"].contains(&kind.name) {
        found.extend(anew);
    }
    let mut open: Vec<&str> = found.iter().copied().collect();
    while let Some(name) = open.pop() {
        let kind = KINDS.iter().find(|kind| kind.name == name).unwrap();
        open.extend(reads(kind).into_iter().filter(|read| found.insert(read)).collect::<Vec<_>>());
    }
    found
}

/// A study of the examples of some kinds, and where each stands.
fn study(kinds: &BTreeSet<&str>) -> (String, BTreeMap<&'static str, std::ops::Range<usize>>) {
    let (mut text, mut ranges) = ("study: t\nseed: 3\nstages:\n".to_owned(), BTreeMap::new());
    for kind in KINDS.iter().filter(|kind| kinds.contains(kind.name)) {
        text += &format!("  {}:\n", kind.name);
        let start = text.len();
        for line in kind.example.trim().lines() {
            text += &format!("    {line}\n");
        }
        ranges.insert(kind.name, start..text.len());
    }
    (text, ranges)
}

/// Tries changes until one is a study in which something of a stage changed; the name of what then is stale.
fn tried(base: &mut Base, text: &str, changes: Vec<Change>) -> Option<Vec<String>> {
    for change in changes {
        let study = match change {
            Change::Text(text) => read(&text, &[]),
            Change::Set(set) => read(text, &[set]),
        };
        let Some(changed) = study.and_then(|study| Keyed::new(study, &base.stored)) else { continue };
        let is_other = |(node, record): (usize, &String)| {
            let own = base.keyed.position(&changed.study.nodes[node].name);
            own.is_none_or(|own| base.keyed.records[own] != *record)
        };
        if changed.study.seed == base.keyed.study.seed && !changed.records.iter().enumerate().any(is_other) {
            continue;
        }
        return Some(base.stale(&changed));
    }
    None
}

fn is_embedded(kind: &str) -> bool {
    ["geometry", "modification", "stiffness", "ste"].contains(&kind)
}

#[test]
fn whatever_field_changes_a_key_changes_or_no_table_does() {
    let (mut changed, mut untouched) = (0, Vec::new());
    // The study of the stages that are computed anew by others has them all.
    let embedding = closure(KINDS.iter().find(|kind| kind.name == "geometry").unwrap());
    let mut sets: Vec<(BTreeSet<&str>, Vec<&str>)> = vec![(embedding.clone(), embedding.iter().copied().collect())];
    for kind in KINDS.iter().filter(|kind| !embedding.contains(kind.name)) {
        sets.push((
            closure(kind).into_iter().filter(|name| !embedding.contains(name) || is_embedded(name)).collect(),
            vec![kind.name],
        ));
    }
    for (kinds, of) in sets {
        let (text, ranges) = study(&kinds);
        let mut base = Base::new(&text);
        for name in of {
            let mut all: Vec<(String, Vec<Change>)> = Vec::new();
            for (at, changes) in other_numbers(&text, ranges[name].clone()).into_iter().enumerate() {
                all.push((format!("number {} of {name}", at + 1), changes));
            }
            let node = base.keyed.position(name).unwrap();
            let (declared, record) =
                (base.keyed.study.nodes[node].kind.fields, base.keyed.study.nodes[node].record.clone());
            fields(name, declared, Some(&record), &mut all);
            for (what, changes) in all {
                match tried(&mut base, &text, changes) {
                    Some(stale) => {
                        assert!(stale.is_empty(), "{what}: the tables of {stale:?} change and their keys do not");
                        changed += 1;
                    }
                    None => untouched.push(what),
                }
            }
        }
        let seed = text.replacen("seed: 3", "seed: 4", 1);
        assert_eq!(tried(&mut base, &text, vec![Change::Text(seed)]), Some(Vec::new()), "the seed");
    }
    // Those that go with no other field of the example, or name cells.
    assert!(changed > 450 && untouched.len() < changed / 3, "{} beside {changed}: {untouched:?}", untouched.len());
}

const INTERVALS: &str = "
study: t
stages:
  pair:
    kind: geometry
    module: 3 mm
    pinion: { teeth: 19, profile_shift: &x 0.1 ± 0.01, face_width: 20 mm, bore_radius: 14 mm }
    gear: { teeth: 48, profile_shift: *x, face_width: 20 mm, bore_radius: 38 mm }
  report:
    kind: report
    published:
      - { label: Difference, formula: b - a, with: { a: \"pair.gears[gear=pinion].tip_radius\", b: \"pair.gears[gear=gear].tip_radius\" }, value: 43.53 mm, tolerance: 1 um }
";

/// Two numbers that are alike are two, and one that is used twice is one: their intervals go together.
#[test]
fn one_number_used_twice_has_another_key_than_two_that_are_alike() {
    let base = Base::new(INTERVALS);
    let two = INTERVALS.replace("&x ", "").replace("*x", "0.1 ± 0.01");
    let changed = Keyed::new(read(&two, &[]).unwrap(), &base.stored).unwrap();
    let report = changed.position("report").unwrap();
    let other = given(changed.run(report, 0, &base.tables));
    assert_ne!(other, given(base.keyed.run(report, 0, &base.tables)), "the ranges are others");
    assert_ne!(changed.parts[report][0].key, base.keyed.parts[report][0].key);
}

/// Tables that name fields, or stages, are made anew when these are called otherwise.
#[test]
fn a_stage_that_is_called_otherwise_has_other_keys_where_tables_name_it() {
    let kinds = closure(KINDS.iter().find(|kind| kind.name == "geometry").unwrap());
    let (text, _) = study(&kinds);
    let mut base = Base::new(&text);
    for name in ["geometry", "modification", "ste"] {
        let mut renamed = text.replace(&format!("  {name}:\n"), &format!("  other-{name}:\n"));
        for (before, after) in [(": ", " "), (": ", "\n"), (": ", ","), ("\"", "."), (" ", ".")] {
            renamed = renamed.replace(&format!("{before}{name}{after}"), &format!("{before}other-{name}{after}"));
        }
        renamed = renamed.replace(&format!("kind: other-{name}"), &format!("kind: {name}"));
        let study = read(&renamed, &[]).unwrap_or_else(|| panic!("{renamed}"));
        let graph = Graph::new(&study, &[]).unwrap_or_else(|wrong| panic!("{}\n{renamed}", wrong.message));
        assert!(graph.order.len() == kinds.len());
        // What the stage gives does not change with its name.
        if let Some(known) = base.stored.get(name).cloned() {
            base.stored.insert(format!("other-{name}"), known);
        }
        if let Some(known) = base.tables.get(name).cloned() {
            base.tables.insert(format!("other-{name}"), known);
        }
        let changed = Keyed::new(study, &base.stored).unwrap();
        assert_eq!(base.stale(&changed), Vec::<String>::new(), "{name}");
    }
}

const OWN_VALUES: &str = "
study: t
seed: 3
stages:
  pair:
    kind: geometry
    module: 3 mm
    pinion: { teeth: 19, profile_shift: 0.0, face_width: 20 mm, bore_radius: 14 mm }
    gear: { teeth: 48, profile_shift: 0.0, face_width: 20 mm, bore_radius: 38 mm }
  limit:
    kind: limit
    of: pair
    vary:
      x1: { field: pair.pinion.profile_shift, from: -1, to: 1.5 }
      x2: { field: pair.gear.profile_shift, from: -1, to: 1.5 }
  fit:
    kind: fit
    of: pair
    starts: 1
    vary:
      x1: { field: pair.pinion.profile_shift, from: -0.4, to: 0.6 }
      x2: { field: pair.gear.profile_shift, from: -0.4, to: 0.7 }
    meet:
      - { cell: pair.pair.contact_ratio, value: 1.7, tolerance: 0.001 }
      - { cell: pair.pair.centre_distance, value: 101 mm, tolerance: 1 um }
";

/// A run with a cache, and the content of all tables that it leaves.
fn run_with(cache: &Cache, text: &str) -> (Outcome, BTreeMap<(String, String), Digest>) {
    let study = read(text, &[]).unwrap_or_else(|| panic!("{text}"));
    let stop = AtomicBool::new(false);
    let outcome = execute(&study, cache, &Options::default(), &Silent, &stop).unwrap();
    assert_eq!(outcome.faults().count(), 0);
    let mut tables = BTreeMap::new();
    for stage in &outcome.stages {
        for (schema, _) in &stage.tables {
            let table = outcome.table(cache, &stage.name, &schema.name).unwrap();
            tables.insert((stage.name.clone(), schema.name.clone()), table.content_hash());
        }
    }
    (outcome, tables)
}

/// Tier: closed form; the ends of x1 with x2 as in the study are where the contact ratio is 1. A cache that knows the study with
/// another x2 gives them too, and all else that an empty one gives.
#[test]
fn a_value_that_a_search_begins_from_is_in_its_key() {
    let folders = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
    let [warm, empty] = [0, 1].map(|at: usize| Cache::open(folders[at].path()).unwrap());
    let other = OWN_VALUES.replace("teeth: 48, profile_shift: 0.0", "teeth: 48, profile_shift: 0.6");
    let (_, before) = run_with(&warm, OWN_VALUES);
    let (outcome, tables) = run_with(&warm, &other);
    assert_eq!(tables, run_with(&empty, &other).1);
    for (stage, table) in [("limit", "limits"), ("fit", "solutions")] {
        let key = (stage.to_owned(), table.to_owned());
        assert_ne!(before[&key], tables[&key], "{stage}");
    }
    let limits = outcome.table(&warm, "limit", "limits").unwrap();
    for (row, expected) in [(0, -0.797_747_31), (1, 0.725_607_11)] {
        let found = limits.floats("value")[row];
        assert!((found - expected).abs() < 1e-8, "{found}, not {expected}");
        let at_end = other.replace("teeth: 19, profile_shift: 0.0", &format!("teeth: 19, profile_shift: {found}"));
        let only = at_end.split("  limit:").next().unwrap();
        let (outcome, _) = run_with(&empty, only);
        let ratio = outcome.table(&empty, "pair", "pair").unwrap().floats("contact_ratio")[0];
        // The upper end is where the tip of the pinion is pointed.
        assert!(row == 1 || (ratio - 1.0).abs() < 1e-9, "{ratio}");
    }
}
