//! Where published results stand: up to date, stale and why, missing. No stage runs, and no cache is needed.
//!
//! The keys of a stage follow from its configuration, its code and the content of what it reads. The manifest holds the
//! contents of all tables, so the keys that a run would find can be compared with those the results were made under.
//! Demand is what the manifest shows was asked for. Must not know: how it is shown.

use std::collections::{HashMap, HashSet};

use super::graph::Graph;
use super::key::{self, KeyedChunk, explain, phrase};
use super::options::Wanted;
use crate::stage::Want;
use crate::store::entry::StoredTable;
use crate::store::index::LINE_ENDS;
use crate::store::manifest::{KeyRecord, Manifest, StageRecord, TableRecord};
use crate::store::results::{FileState, Folder, Known, PAGE, is_drawn};
use crate::study::{self, Node, Study};
use declare::digest::Digest;
use declare::error::Diagnostic;

/// All stages of a study, every one after all it reads.
#[derive(Clone, Debug, PartialEq)]
pub struct Standing {
    pub stages: Vec<StageStanding>,
    /// Whether there is a manifest at all.
    pub has_results: bool,
    /// Whether the study's file is another than the results were made from, be it by a comment.
    pub text_changed: bool,
    /// Stages that only the results have.
    pub gone: Vec<String>,
    /// Page, figures and HDF5 file that are here, but not as the last run wrote them.
    pub foreign: Vec<String>,
    /// Of these, texts of which the line ends alone differ.
    pub line_ends: Vec<String>,
    /// Those that another run wrote.
    pub other_run: Vec<String>,
    /// Those that are not here.
    pub missing: Vec<String>,
    /// Of all files that are not here, those in whose place a pointer of Git LFS is.
    pub pointers: Vec<String>,
    /// Whether page and figures are those of the last run.
    pub report: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub struct StageStanding {
    pub name: String,
    pub state: Condition,
    /// Of a stage that is not stale: files that the manifest lists and that are not here. A clone has only what git
    /// keeps; a run brings them back.
    pub absent: Vec<String>,
    /// Of a stage that is not stale: the keys under which a cache has its tables.
    pub keys: Vec<Digest>,
}

/// Where one stage stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Condition {
    UpToDate,
    /// With the reason.
    Stale(String),
    /// With what is not there.
    Missing(String),
    /// A file that is not as the manifest lists it.
    Damaged(String),
    /// Files of which git changed the line ends and nothing else.
    LineEnds(String),
    /// Files that another run wrote, under another manifest.
    OtherRun(String),
    /// Only a run of these stages can tell.
    Waits(Vec<String>),
}

impl Condition {
    #[must_use]
    pub const fn word(&self) -> &'static str {
        match self {
            Self::UpToDate => "up to date",
            Self::Stale(_) => "stale",
            Self::Missing(_) => "missing",
            Self::Damaged(_) => "damaged",
            Self::LineEnds(_) => "line ends",
            Self::OtherRun(_) => "other run",
            Self::Waits(_) => "waits",
        }
    }

    /// Empty for what is up to date.
    #[must_use]
    pub fn why(&self) -> String {
        match self {
            Self::UpToDate => String::new(),
            Self::Stale(why) | Self::Missing(why) | Self::Damaged(why) | Self::LineEnds(why) | Self::OtherRun(why) => {
                why.clone()
            }
            Self::Waits(names) => format!("for {}", names.join(", ")),
        }
    }
}

impl Standing {
    #[must_use]
    pub fn is_up_to_date(&self) -> bool {
        self.has_results
            && !self.text_changed
            && self.gone.is_empty()
            && self.foreign.is_empty()
            && self.other_run.is_empty()
            && self.stages.iter().all(|stage| stage.state == Condition::UpToDate)
    }

    /// All files that the manifest lists and that are not here.
    #[must_use]
    pub fn absent(&self) -> Vec<&str> {
        self.stages.iter().flat_map(|stage| &stage.absent).map(String::as_str).collect()
    }

    /// The first thing that is not as it should be.
    #[must_use]
    pub fn problem(&self) -> Option<String> {
        let foreign = || self.foreign.first().map(|file| format!("`{file}` is not as the last run wrote it"));
        let other_run = || self.other_run.first().map(|file| format!("`{file}` is of another run"));
        self.first(|state| *state != Condition::UpToDate).or_else(foreign).or_else(other_run)
    }

    /// The first thing by which the results are not those of the study and the program now, whatever became of the files: while a
    /// run publishes, these need not fit.
    #[must_use]
    pub fn outdated(&self) -> Option<String> {
        self.first(|state| matches!(state, Condition::Stale(_) | Condition::Missing(_)))
    }

    fn first(&self, counts: impl Fn(&Condition) -> bool) -> Option<String> {
        if !self.has_results {
            return Some("there are no results".to_owned());
        }
        let of_stage = self.stages.iter().find(|stage| counts(&stage.state)).map(|stage| {
            let (name, word, why) = (&stage.name, stage.state.word(), stage.state.why());
            format!("stage `{name}` is not up to date: {word}: {why}")
        });
        let gone = || self.gone.first().map(|name| format!("the results have a stage `{name}`, the study has none"));
        let changed = || self.text_changed.then(|| "the study's file has changed since".to_owned());
        of_stage.or_else(gone).or_else(changed)
    }
}

/// Compares a study with its results. What the manifest says of tables that are not here is taken for granted: a clone
/// has only those that git keeps. Files that are here must be as they were written.
///
/// # Errors
/// What is wrong with the study's graph; a manifest that cannot be read.
pub fn standing(study: &Study, folder: &Folder) -> Result<Standing, Diagnostic> {
    let known = folder.known().map_err(|error| Diagnostic::new(error.to_string()))?;
    standing_of(study, known.as_ref())
}

/// The same where manifest and files were looked at already.
///
/// # Errors
/// What is wrong with the study's graph.
pub fn standing_of(study: &Study, known: Option<&Known>) -> Result<Standing, Diagnostic> {
    let manifest = known.map(|known| &known.manifest);
    let graph = Graph::new(study, &manifest.map(|manifest| demand(study, manifest)).unwrap_or_default())?;
    let mut tables: Vec<Option<Vec<StoredTable>>> = vec![None; study.nodes.len()];
    let records: HashMap<&str, &StageRecord> =
        manifest.iter().flat_map(|manifest| &manifest.stages).map(|stage| (&*stage.name, stage)).collect();
    let mut stages = Vec::new();
    for &node in &graph.order {
        let name = &study.nodes[node].name;
        let mut unknown: Vec<usize> = graph.inputs[node].iter().map(|input| input.node).collect();
        unknown.sort_unstable();
        unknown.dedup();
        unknown.retain(|&input| tables[input].is_none());
        let record = records.get(name.as_str()).copied();
        let (mut absent, mut keys) = (Vec::new(), Vec::new());
        let state = match (known, record) {
            (None, _) => Condition::Missing("there are no results".to_owned()),
            (Some(_), None) => Condition::Missing("never ran".to_owned()),
            (Some(_), Some(record)) if record.keys.is_empty() || record.tables.is_empty() => {
                Condition::Missing(format!("{}: {}", record.status, record.why))
            }
            _ if !unknown.is_empty() => {
                Condition::Waits(unknown.iter().map(|&input| study.nodes[input].name.clone()).collect())
            }
            (Some(known), Some(record)) => {
                let seen = |input: usize| tables[input].as_deref().unwrap_or_default();
                let parts = key::parts(study, &graph, node, seen);
                let axis = parts.first().and_then(KeyedChunk::axis);
                let now: Vec<&KeyRecord> = parts.iter().map(|part| &part.record).collect();
                match stale(record, study.nodes[node].kind.name, &now, axis) {
                    Some(why) => Condition::Stale(why),
                    None => {
                        tables[node] = record.tables.iter().map(TableRecord::stored).collect();
                        keys = parts.iter().map(|part| part.key).collect();
                        let damaged;
                        (absent, damaged) = files(known, record);
                        damaged.unwrap_or(Condition::UpToDate)
                    }
                }
            }
        };
        stages.push(StageStanding { name: name.clone(), state, absent, keys });
    }
    let names: HashSet<&str> = study.nodes.iter().map(|node| node.name.as_str()).collect();
    let in_study = |stage: &&StageRecord| names.contains(stage.name.as_str());
    let of_manifest = manifest.iter().flat_map(|manifest| &manifest.stages);
    let digest = study::digest(&study.text);
    let tables = manifest.iter().flat_map(|manifest| &manifest.stages).flat_map(|stage| &stage.tables);
    let of_tables: HashSet<&String> = tables.flat_map(|table| table.files.iter().chain([&table.file])).collect();
    let others: Vec<(&str, FileState)> = known
        .iter()
        .flat_map(|known| known.manifest.files.iter().map(move |record| (known, &record.file)))
        .filter(|(_, file)| !of_tables.contains(file))
        .map(|(known, file)| (file.as_str(), known.state(file)))
        .collect();
    let is_alike = |file: &&String| known.is_some_and(|known| known.has_other_line_ends(file));
    let drawn = || others.iter().filter(|(file, _)| is_drawn(file));
    let in_state = |states: &[FileState]| -> Vec<String> {
        let files = others.iter().filter(|(_, state)| states.contains(state));
        files.map(|(file, _)| (*file).to_owned()).collect()
    };
    let foreign = in_state(&[FileState::Changed, FileState::Unreadable]);
    let files = known.iter().flat_map(|known| known.manifest.files.iter().map(move |record| (known, &record.file)));
    let pointers = files.filter(|(known, file)| known.state(file) == FileState::Pointer);
    Ok(Standing {
        stages,
        has_results: manifest.is_some(),
        text_changed: manifest.is_some_and(|manifest| manifest.study_digest != digest),
        gone: of_manifest.filter(|stage| !in_study(stage)).map(|stage| stage.name.clone()).collect(),
        line_ends: foreign.iter().filter(is_alike).cloned().collect(),
        foreign,
        other_run: in_state(&[FileState::OtherRun]),
        missing: in_state(&[FileState::Absent, FileState::Pointer]),
        pointers: pointers.map(|(_, file)| file.clone()).collect(),
        report: drawn().any(|(file, _)| *file == PAGE) && drawn().all(|(_, state)| *state == FileState::Intact),
    })
}

/// What must be asked for on demand so that a run gives the tables and columns that a manifest lists.
#[must_use]
pub fn demand(study: &Study, manifest: &Manifest) -> Vec<Wanted> {
    let mut wanted = Vec::new();
    let nodes: HashMap<(&str, &str), &Node> =
        study.nodes.iter().map(|node| ((&*node.name, node.kind.name), node)).collect();
    for record in &manifest.stages {
        let Some(node) = nodes.get(&(&*record.name, &*record.kind)) else { continue };
        for schema in node.stage.outputs() {
            let name = format!("{}.{}", node.name, schema.name);
            let Some(table) = record.tables.iter().find(|table| table.name == name) else { continue };
            let listed = |column: &str| table.columns.iter().any(|listed| listed.name == column);
            let columns = schema.columns.iter().filter(|column| column.on_demand && listed(&column.name));
            let columns: Vec<String> = columns.map(|column| column.name.clone()).collect();
            if schema.on_demand || !columns.is_empty() {
                wanted.push(Wanted { stage: node.name.clone(), want: Want { table: schema.name, columns } });
            }
        }
    }
    wanted
}

/// Why the keys are other ones than those of the results.
fn stale(record: &StageRecord, kind: &str, now: &[&KeyRecord], axis: Option<&'static str>) -> Option<String> {
    if record.kind != kind {
        return Some(format!("kind changed: it was {}", record.kind));
    }
    let is_new = |part: &&&KeyRecord| !record.keys.iter().any(|key| key.key == part.key);
    let mut reasons = Vec::new();
    for part in now.iter().filter(is_new) {
        for why in explain(&record.keys, part, axis) {
            if !reasons.contains(&why) {
                reasons.push(why);
            }
        }
    }
    if !reasons.is_empty() {
        return Some(phrase(&reasons));
    }
    (record.keys.len() != now.len()).then(|| format!("config changed: fewer values of {}", axis.unwrap_or("an axis")))
}

/// The files of a stage's tables that are not here, and the worst of those that are, but not as they were written.
fn files(known: &Known, record: &StageRecord) -> (Vec<String>, Option<Condition>) {
    let (mut absent, mut odd, mut unread, mut other_run) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut line_ends = Vec::new();
    let of_table = |table: &TableRecord| {
        let held = table.files.iter().map(|file| (file.clone(), known.state(file)));
        [(table.file.clone(), known.table_state(table))].into_iter().chain(held).collect::<Vec<_>>()
    };
    for (file, state) in record.tables.iter().flat_map(of_table) {
        match state {
            FileState::Intact => {}
            FileState::Absent | FileState::Pointer => absent.push(file),
            FileState::OtherRun => other_run.push(file),
            FileState::Unreadable => unread.push(file),
            FileState::Changed if known.has_other_line_ends(&file) => line_ends.push(file),
            FileState::Changed | FileState::Unknown | FileState::Unlisted => odd.push(file),
        }
    }
    let damaged = named(&odd, "is not as the manifest lists it", "are not as the manifest lists them")
        .or_else(|| named(&unread, "cannot be read", "cannot be read"))
        .map(Condition::Damaged);
    let several = "are as they were written; only their line ends differ (git's autocrlf)";
    let line_ends = || named(&line_ends, LINE_ENDS, several).map(Condition::LineEnds);
    let other_run = || named(&other_run, "is of another run", "are of another run").map(Condition::OtherRun);
    (absent, damaged.or_else(line_ends).or_else(other_run))
}

/// The first of some files, the number of the others, and what is wrong with one or with several; nothing where there are
/// none.
fn named(files: &[String], one: &str, several: &str) -> Option<String> {
    match files {
        [] => None,
        [file] => Some(format!("`{file}` {one}")),
        [first, ..] => Some(format!("`{first}` and {} more {several}", files.len() - 1)),
    }
}
