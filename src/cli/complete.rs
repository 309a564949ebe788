//! What a shell completes: words of the command line, and names of the study that stands on it.
//!
//! The shell asks this program, with a variable of the environment; without it nothing of this is built. Must not know:
//! what any command does.

use std::collections::BTreeSet;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use clap::{Arg, Command, CommandFactory, ValueEnum};
use clap_complete::engine::{ArgValueCompleter, CompletionCandidate, PathCompleter, ValueCompleter};
use clap_complete::env::{CompleteEnv, Shells};

use super::arguments::{Arguments, RESULTS, Shell};
use super::progress::{complain, out};
use super::show::TEMPLATES;
use super::{Ending, studies};
use crate::program;
use crate::stage::{self, kinds::KINDS};
use studygraph::history::side::Side;
use studygraph::presence;
use studygraph::store::manifest::Manifest;
use studygraph::store::results::Folder;
use studygraph::study::{Node, Study, described, named};
use studygraph::table::data::Cell;
use studygraph::table::schema::Schema;

/// Set by the shell's function.
const VARIABLE: &str = "GEARSTUDY_COMPLETE";
/// Values of a column that are offered.
const MOST_VALUES: usize = 100;

/// Answers a shell that asks; the exit code then.
pub(super) fn asked() -> Option<i32> {
    std::env::var_os(VARIABLE)?;
    let here = std::env::current_dir().ok();
    match CompleteEnv::with_factory(command).var(VARIABLE).try_complete(std::env::args_os(), here.as_deref()) {
        Ok(answered) => answered.then_some(0),
        Err(error) => {
            complain(&format!("gearstudy: {error}"));
            Some(1)
        }
    }
}

/// Prints what makes a shell ask.
pub(super) fn script(shell: Shell) -> Result<(), Ending> {
    let first = std::env::args_os().next().unwrap_or_else(|| "gearstudy".into());
    // A name is found where commands are found; a path is this one wherever the shell stands.
    let program = if Path::new(&first).components().count() > 1 {
        std::path::absolute(&first).map_or(first, PathBuf::into_os_string)
    } else {
        first
    };
    let program = program.to_string_lossy();
    if shell == Shell::Bash {
        out(&include_str!("complete.bash").replace("PROGRAM", &format!("'{}'", program.replace('\'', r"'\''"))));
        return Ok(());
    }
    let name = shell.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default();
    let mut text = Vec::new();
    let written = Shells::builtins()
        .completer(&name)
        .map(|shell| shell.write_registration(VARIABLE, "gearstudy", "gearstudy", &program, &mut text));
    match written {
        Some(Ok(())) => out(&String::from_utf8_lossy(&text)),
        _ => return Err(Ending::Usage(format!("there are no completions for {name}"))),
    }
    Ok(())
}

/// The command line, every word of which is completed.
fn command() -> Command {
    completed(Arguments::command())
}

fn completed(command: Command) -> Command {
    let name = command.get_name().to_owned();
    command.mut_args(|argument| completed_argument(&name, argument)).mut_subcommands(completed)
}

fn completed_argument(command: &str, argument: Arg) -> Arg {
    let by: fn(&Line, &str) -> Vec<Offer> = match (command, argument.get_id().as_str()) {
        ("query", "study") | ("diff", "words" | "studies") => Line::with_results,
        (_, "study" | "studies") => return argument.add(ArgValueCompleter::new(study_files)),
        (_, "only" | "force") => Line::stages,
        (_, "want") => Line::on_demand,
        ("table", "table") => Line::tables,
        ("table", "conditions") => Line::conditions,
        ("table", "columns") => Line::columns,
        ("diff", "tolerances") => Line::tolerances,
        (_, "set") => Line::fields,
        ("kinds", "kind") => |_, so_far| kinds(so_far),
        ("new", "template") => |_, _| TEMPLATES.iter().map(|(name, ..)| Offer::of(*name, "")).collect(),
        ("help", "command") => |line, _| line.commands(),
        _ => return argument,
    };
    argument.add(ArgValueCompleter::new(move |so_far: &OsStr| offered(by, so_far)))
}

/// A word that may stand, and what it means.
struct Offer {
    word: String,
    meaning: String,
}

impl Offer {
    fn of(word: impl Into<String>, meaning: impl Into<String>) -> Self {
        Self { word: word.into(), meaning: meaning.into() }
    }

    fn candidate(self) -> CompletionCandidate {
        let meaning = (!self.meaning.is_empty()).then(|| self.meaning.into());
        CompletionCandidate::new(self.word).help(meaning)
    }
}

fn offered(by: fn(&Line, &str) -> Vec<Offer>, so_far: &OsStr) -> Vec<CompletionCandidate> {
    let Some(so_far) = so_far.to_str() else { return Vec::new() };
    let line = Line::read();
    let listed = line.listed(so_far);
    let all = by(&line, so_far).into_iter().filter(|offer| !listed.contains(&offer.word.as_str()));
    all.filter(|offer| offer.word.starts_with(so_far)).map(Offer::candidate).collect()
}

/// Files of studies, and names of those in the folder `studies`.
fn study_files(so_far: &OsStr) -> Vec<CompletionCandidate> {
    let is_study = |path: &Path| path.extension().is_some_and(|end| end == "yaml" || end == "yml");
    let mut all = PathCompleter::file().filter(is_study).complete(so_far);
    let start = so_far.to_string_lossy();
    let stems = studies::all().unwrap_or_default();
    let stems = stems.iter().filter_map(|path| path.file_stem()?.to_str());
    all.extend(stems.filter(|stem| stem.starts_with(&*start)).map(CompletionCandidate::new));
    all
}

/// Kinds, and the fields below a path of them.
fn kinds(so_far: &str) -> Vec<Offer> {
    let Some((path, _)) = so_far.rsplit_once('.') else {
        return KINDS.iter().map(|kind| Offer::of(kind.name, kind.summary)).collect();
    };
    let (name, below) = path.split_once('.').unwrap_or((path, ""));
    let Some(kind) = stage::kind(name) else { return Vec::new() };
    described::below(kind, below)
        .into_iter()
        .map(|(name, meaning)| Offer::of(format!("{path}.{name}"), meaning))
        .collect()
}

/// All tables that there can be, each with its stage.
fn schemas(nodes: &[Node]) -> impl Iterator<Item = (&str, Schema)> {
    nodes.iter().flat_map(|node| node.stage.outputs().into_iter().map(|schema| (node.name.as_str(), schema)))
}

/// What stands on the line that is completed.
struct Line {
    words: Vec<OsString>,
}

impl Line {
    /// The shell hands it over behind `--`.
    fn read() -> Self {
        Self { words: std::env::args_os().skip_while(|word| word != "--").skip(2).collect() }
    }

    /// What stands already in the list `a,b,…` whose last item is completed.
    fn listed(&self, so_far: &str) -> Vec<&str> {
        let lists = self.words.iter().filter_map(|word| word.to_str()?.rsplit_once(','));
        let here = lists.filter(|(_, last)| *last == so_far).map(|(before, _)| before.rsplit('=').next());
        here.flatten().flat_map(|before| before.split(',')).collect()
    }

    fn results(&self) -> PathBuf {
        let mut words = self.words.iter();
        let mut found = None;
        while let Some(word) = words.next() {
            match word.to_str().and_then(|word| word.strip_prefix("--results")) {
                Some("") => found = words.next().map(PathBuf::from),
                Some(value) => found = value.strip_prefix('=').map(PathBuf::from),
                None => {}
            }
        }
        found.unwrap_or_else(|| PathBuf::from(RESULTS))
    }

    /// The first word that is a study.
    fn study(&self) -> Option<Study> {
        let files = self.words.iter().skip(1).filter_map(|word| studies::file(Path::new(word)).ok());
        // Nobody reads a message while a word is completed.
        let is_file = |path: &PathBuf| presence::is_file(path).unwrap_or(false);
        files.filter(is_file).find_map(|path| program::load(&path).ok())
    }

    fn manifest(&self) -> Option<(Folder, Manifest)> {
        let folder = Folder::new(&self.results(), &self.study()?.name);
        let manifest = folder.manifest()?;
        Some((folder, manifest))
    }

    fn with_results(&self, _: &str) -> Vec<Offer> {
        let names = Side::folder(&self.results(), "").and_then(|side| side.studies()).unwrap_or_default();
        names.into_iter().map(|name| Offer::of(name, "")).collect()
    }

    fn stages(&self, _: &str) -> Vec<Offer> {
        let Some(study) = self.study() else { return Vec::new() };
        study.nodes.iter().map(|node| Offer::of(&node.name, node.kind.summary)).collect()
    }

    /// Tables and columns that are computed only when somebody asks for them.
    fn on_demand(&self, _: &str) -> Vec<Offer> {
        let nodes = self.study().map(|study| study.nodes).unwrap_or_default();
        named::on_demand(&nodes).into_iter().map(|(name, meaning)| Offer::of(name, meaning)).collect()
    }

    /// Those of the results; before there are any, those that a run gives.
    fn tables(&self, _: &str) -> Vec<Offer> {
        if let Some((_, manifest)) = self.manifest() {
            let records = manifest.stages.iter().flat_map(|stage| &stage.tables);
            return records.map(|record| Offer::of(&record.name, &*record.description)).collect();
        }
        let nodes = self.study().map(|study| study.nodes).unwrap_or_default();
        let given = schemas(&nodes).filter(|(_, schema)| !schema.on_demand);
        given.map(|(stage, schema)| Offer::of(format!("{stage}.{}", schema.name), schema.description)).collect()
    }

    fn stands_here(&self, table: &str) -> bool {
        self.words.iter().any(|word| word == table)
    }

    /// The table that stands on the line, of those that there can be, with its stage.
    fn table<'a>(&self, nodes: &'a [Node]) -> Option<(&'a str, Schema)> {
        schemas(nodes).find(|(stage, schema)| self.stands_here(&format!("{stage}.{}", schema.name)))
    }

    /// The columns of the table that stands on the line, with their units and meanings; before there are any, those that a
    /// run gives.
    fn columns_of_table(&self) -> Vec<Offer> {
        let offer = |name: &str, unit: &str, meaning: &str| Offer::of(name, named::meaning(unit, meaning));
        if let Some((_, manifest)) = self.manifest() {
            let mut records = manifest.stages.iter().flat_map(|stage| &stage.tables);
            let columns = records.find(|record| self.stands_here(&record.name)).map(|record| record.columns.iter());
            let columns = columns.into_iter().flatten();
            return columns.map(|column| offer(&column.name, &column.unit, &column.description)).collect();
        }
        let nodes = self.study().map(|study| study.nodes).unwrap_or_default();
        let columns = self.table(&nodes).map(|(_, schema)| schema.columns).unwrap_or_default();
        let columns = columns.iter().filter(|column| !column.on_demand);
        columns.map(|column| offer(&column.name, &column.unit, &column.description)).collect()
    }

    fn columns(&self, _: &str) -> Vec<Offer> {
        self.columns_of_table()
    }

    /// `column=`, and behind it the values that there are.
    fn conditions(&self, so_far: &str) -> Vec<Offer> {
        let Some((column, _)) = so_far.split_once('=') else {
            return self.columns_of_table().into_iter().map(|of| Offer::of(of.word + "=", of.meaning)).collect();
        };
        let values = self.values(column).unwrap_or_default().into_iter().map(|value| value.to_string());
        let mut seen = BTreeSet::new();
        let distinct = values.filter(|value| seen.insert(value.clone())).take(MOST_VALUES);
        distinct.map(|value| Offer::of(format!("{column}={value}"), "")).collect()
    }

    /// The values of a column of the table that stands on the line; before there are any, those that its keys will have.
    fn values(&self, column: &str) -> Option<Vec<Cell>> {
        let Some((folder, manifest)) = self.manifest() else {
            let nodes = self.study()?.nodes;
            let (stage, schema) = self.table(&nodes)?;
            schema.column(column)?;
            return named::Keys::new(&nodes).of(stage, &schema.name, column);
        };
        let mut records = manifest.stages.iter().flat_map(|stage| &stage.tables);
        let table = folder.table(records.find(|record| self.stands_here(&record.name))?).ok()?;
        let data = table.column(column)?;
        Some((0..table.rows()).map(|row| data.cell(row)).collect())
    }

    /// `stage.table.column=`, of all results.
    fn tolerances(&self, _: &str) -> Vec<Offer> {
        let results = self.results();
        let names = Side::folder(&results, "").and_then(|side| side.studies()).unwrap_or_default();
        let mut all = Vec::new();
        for manifest in names.iter().filter_map(|name| Folder::new(&results, name).manifest()) {
            for record in manifest.stages.iter().flat_map(|stage| &stage.tables) {
                let columns = record.columns.iter().filter(|column| studygraph::diff::table::is_number(column));
                let offer = |name: &str, meaning: &str| Offer::of(format!("{}.{name}=", record.name), meaning);
                all.extend(columns.map(|column| offer(&column.name, &column.description)));
            }
        }
        all
    }

    /// `stage.field.field=`.
    fn fields(&self, so_far: &str) -> Vec<Offer> {
        let Some(study) = self.study() else { return Vec::new() };
        let Some((path, _)) = so_far.rsplit_once('.') else {
            return study.nodes.iter().map(|node| Offer::of(format!("{}.", node.name), node.kind.summary)).collect();
        };
        let (stage, below) = path.split_once('.').unwrap_or((path, ""));
        let Some(node) = study.nodes.iter().find(|node| node.name == stage) else { return Vec::new() };
        let named = |(name, meaning): (&str, &'static str)| {
            let inner = if below.is_empty() { name.to_owned() } else { format!("{below}.{name}") };
            let end = if described::below(node.kind, &inner).is_empty() { "=" } else { "." };
            Offer::of(format!("{path}.{name}{end}"), meaning)
        };
        described::below(node.kind, below).into_iter().map(named).collect()
    }

    /// Commands below those that stand behind `help`.
    fn commands(&self) -> Vec<Offer> {
        let mut here = Arguments::command();
        let words: Vec<&str> = self.words.iter().filter_map(|word| word.to_str()).collect();
        // The last one is being completed.
        for word in words.iter().skip(2).take(words.len().saturating_sub(3)) {
            match here.find_subcommand(word) {
                Some(found) => here = found.clone(),
                None => return Vec::new(),
            }
        }
        let meaning = |command: &Command| command.get_about().map(ToString::to_string).unwrap_or_default();
        here.get_subcommands().map(|command| Offer::of(command.get_name(), meaning(command))).collect()
    }
}
