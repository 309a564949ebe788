//! Tables by name: `study.stage.table`, of the results folder or, with a prefix, of a commit.
//!
//! Must not know: SQL.

use declare::error::suggest;
use studygraph::history::side::{Got, Side};
use studygraph::store::cache::Cache;
use studygraph::store::manifest::{Manifest, StageRecord, TableRecord};
use studygraph::store::results::Folder;
use studygraph::table::data::Table;

/// Opens the results of a revision or a folder; those that are meant where none is named.
pub type Open<'a> = &'a dyn Fn(Option<&str>) -> Result<Side, String>;

/// What is to be done about a table, or a column, that a study gives only where it is asked for: the study, and `stage.table` or
/// `stage.table.column`. Nothing where that is not so.
pub type OnDemand<'a> = &'a dyn Fn(&str, &str) -> Option<String>;

/// All tables that a query can read.
pub struct Tables<'a> {
    open: Open<'a>,
    on_demand: OnDemand<'a>,
    /// What `stage.table` is a table of; the only study there is, where this is none.
    study: Option<&'a str>,
    /// Has tables that are not kept with the results.
    cache: Option<&'a Cache>,
    sides: Vec<(Option<String>, Side)>,
    /// Whether a table was not read since a file that is there cannot be.
    is_unread: bool,
}

/// Why there is no table.
struct Failure {
    message: String,
    /// A file that is there cannot be read.
    is_unread: bool,
}

impl Failure {
    fn unread(message: impl Into<String>) -> Self {
        Self { message: message.into(), is_unread: true }
    }
}

impl From<String> for Failure {
    fn from(message: String) -> Self {
        Self { message, is_unread: false }
    }
}

/// The tables that there are.
pub struct List {
    /// Each in the words of a query, with its rows and columns.
    pub tables: Vec<(String, TableRecord)>,
    /// Why studies are missing from it.
    pub problems: Vec<String>,
}

/// A study of a side: its name, its folder, and what was run.
struct Study {
    name: String,
    folder: String,
    manifest: Manifest,
}

/// The studies of a side. One that cannot be read keeps no other from being asked.
#[derive(Default)]
struct Studies {
    sound: Vec<Study>,
    /// Names of the others, and why they cannot be read.
    unread: Vec<(String, String)>,
}

impl Studies {
    /// # Errors
    /// When this study is there, but cannot be read.
    fn check(&self, name: &str) -> Result<(), Failure> {
        let problem = self.unread.iter().find(|(unread, _)| unread == name);
        problem.map_or(Ok(()), |(_, problem)| Err(Failure::unread(problem)))
    }

    fn problems(&self) -> impl Iterator<Item = &str> {
        self.unread.iter().map(|(_, problem)| problem.as_str())
    }
}

impl<'a> Tables<'a> {
    #[must_use]
    pub fn new(open: Open<'a>, on_demand: OnDemand<'a>, study: Option<&'a str>, cache: Option<&'a Cache>) -> Self {
        Self { open, on_demand, study, cache, sides: Vec::new(), is_unread: false }
    }

    /// The table of this name: `stage.table` or `study.stage.table`, behind `revision:` where another side is meant.
    ///
    /// # Errors
    /// One sentence: there is none, with the nearest there is, or its values are not kept.
    pub fn read(&mut self, name: &str) -> Result<Table, String> {
        self.found(name).map_err(|Failure { message, is_unread }| {
            self.is_unread |= is_unread;
            message
        })
    }

    /// Whether [`Tables::read`] found none since a file that is there cannot be read.
    #[must_use]
    pub fn is_unread(&self) -> bool {
        self.is_unread
    }

    fn found(&mut self, name: &str) -> Result<Table, Failure> {
        // A revision may have colons in it, a table has none.
        let (revision, inside) = match name.rsplit_once(':') {
            Some((revision, inside)) => (Some(revision), inside),
            None => (None, name),
        };
        let (study, cache, on_demand) = (self.study, self.cache, self.on_demand);
        let side = self.side(revision)?;
        match table(side, study, cache, inside, on_demand)? {
            Ok(table) => Ok(table),
            // While a run publishes, its files and its manifest do not belong together: once more when none does.
            Err(Missed { folder, why }) => {
                let Some(folder) = side.path().and_then(|path| Folder::at(&path.join(folder))) else { return Err(why) };
                let _lock = folder.lock();
                table(side, study, cache, inside, on_demand)?.map_err(|missed| missed.why)
            }
        }
    }

    /// Every table.
    ///
    /// # Errors
    /// When the results cannot be read, or not those of the one study that is meant.
    pub fn list(&mut self) -> Result<List, String> {
        let wanted = self.study;
        let side = self.side(None)?;
        let studies = studies(side).map_err(|failure| failure.message)?;
        known_study(&studies, wanted, side).map_err(|failure| failure.message)?;
        let problems = studies.problems().filter(|_| wanted.is_none()).map(str::to_owned).collect();
        let wanted = studies.sound.into_iter().filter(|study| wanted.is_none_or(|wanted| study.name == wanted));
        let tables = wanted.flat_map(|study| {
            let records = study.manifest.stages.into_iter().flat_map(|stage| stage.tables);
            records.map(move |record| (format!("{}.{}", study.name, record.name), record)).collect::<Vec<_>>()
        });
        Ok(List { tables: tables.collect(), problems })
    }

    /// What is to be done about a column that a table of this name does not have, if its study gives it where it is asked for.
    #[must_use]
    pub fn lacking(&self, name: &str, column: &str) -> Option<String> {
        let inside = name.rsplit_once(':').map_or(name, |(_, inside)| inside);
        let (study, table) = parted(self.study, inside)?;
        (self.on_demand)(study, &format!("{table}.{column}"))
    }

    fn side(&mut self, revision: Option<&str>) -> Result<&Side, String> {
        let at = match self.sides.iter().position(|(known, _)| known.as_deref() == revision) {
            Some(at) => at,
            None => {
                self.sides.push((revision.map(str::to_owned), (self.open)(revision)?));
                self.sides.len() - 1
            }
        };
        Ok(&self.sides[at].1)
    }
}

/// A table that a manifest lists and nobody has.
struct Missed {
    folder: String,
    why: Failure,
}

fn table(
    side: &Side,
    study: Option<&str>,
    cache: Option<&Cache>,
    name: &str,
    on_demand: OnDemand<'_>,
) -> Result<Result<Table, Missed>, Failure> {
    let studies = studies(side)?;
    let is_short = name.matches('.').count() < 2;
    if is_short {
        known_study(&studies, study, side)?;
    }
    let only = study.or(match (&studies.sound[..], &studies.unread[..]) {
        ([only], []) => Some(only.name.as_str()),
        _ => None,
    });
    let Some((of, stage, record)) = find(&studies.sound, only, name) else {
        if let Some((of, _)) = parted(only, name) {
            studies.check(of)?;
        }
        if let Some(said) = parted(only, name).and_then(|(study, table)| on_demand(study, table)) {
            return Err(said.into());
        }
        let known = known(&studies.sound, only, name.matches('.').count());
        let help = std::iter::once(suggest(name, known.iter().map(String::as_str)));
        let help = help.chain(studies.problems().map(str::to_owned)).collect::<Vec<_>>().join("; ");
        return Err(format!("there is no table `{name}` in {}; {help}", side.label).into());
    };
    let (got, damage) = side.table(&of.folder, stage, record, cache);
    Ok(match got {
        Got::Table(table) => Ok(*table),
        Got::Without(why) => {
            let message = format!("`{name}` {why}, and the cache does not have it; `gearstudy run` computes it again");
            let why = Failure { message, is_unread: damage.is_some() };
            Err(Missed { folder: of.folder.clone(), why })
        }
    })
}

fn studies(side: &Side) -> Result<Studies, Failure> {
    let mut studies = Studies::default();
    for folder in side.studies().map_err(Failure::unread)? {
        match side.manifest(&folder) {
            Ok(Some(manifest)) => {
                let name = if side.is_single() { manifest.study.clone() } else { folder.clone() };
                studies.sound.push(Study { name, folder, manifest });
            }
            Ok(None) => {}
            Err(problem) => studies.unread.push((folder, problem)),
        }
    }
    if !studies.sound.is_empty() {
        return Ok(studies);
    }
    let problems: Vec<&str> = studies.problems().collect();
    Err(if problems.is_empty() {
        format!("there are no results in {}", side.label).into()
    } else {
        Failure::unread(problems.join("; "))
    })
}

fn known_study(studies: &Studies, wanted: Option<&str>, side: &Side) -> Result<(), Failure> {
    let is_there = |wanted: &&str| studies.sound.iter().any(|study| study.name == **wanted);
    let Some(wanted) = wanted.filter(|wanted| !is_there(wanted)) else { return Ok(()) };
    studies.check(wanted)?;
    let help = suggest(wanted, studies.sound.iter().map(|study| study.name.as_str()));
    Err(format!("there is no study `{wanted}` in {}; {help}", side.label).into())
}

fn find<'a>(
    studies: &'a [Study],
    only: Option<&str>,
    name: &str,
) -> Option<(&'a Study, &'a StageRecord, &'a TableRecord)> {
    let (study, table) = parted(only, name)?;
    let of = studies.iter().find(|candidate| candidate.name == study)?;
    let mut tables = of.manifest.stages.iter().flat_map(|stage| stage.tables.iter().map(move |record| (stage, record)));
    tables.find(|(_, record)| record.name == table).map(|(stage, record)| (of, stage, record))
}

/// The study of a name, and `stage.table`.
fn parted<'a>(only: Option<&'a str>, name: &'a str) -> Option<(&'a str, &'a str)> {
    if name.matches('.').count() == 1 { Some((only?, name)) } else { name.split_once('.') }
}

/// Names with as many points as the one that was asked for, where there are such.
fn known(studies: &[Study], only: Option<&str>, points: usize) -> Vec<String> {
    let short = points < 2 && only.is_some();
    let wanted = studies.iter().filter(|study| !short || only == Some(&study.name));
    let names = wanted.flat_map(|study| {
        let records = study.manifest.stages.iter().flat_map(|stage| &stage.tables);
        records.map(move |record| if short { record.name.clone() } else { format!("{}.{}", study.name, record.name) })
    });
    names.collect()
}
