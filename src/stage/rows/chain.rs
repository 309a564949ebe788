//! The stages that are computed anew for rows, and what they read of each other and of the study.
//!
//! Each is built by its kind from its record with a row's values in it, and run as in the study. Must not know: what any of
//! them computes.

use std::sync::{Mutex, PoisonError};

use crate::stage::neglected_corners;
use crate::stage::{self, Context, Demand, Inputs, Kind, Port, Stage, Want};
use declare::digest::Writer;
use declare::error::{Diagnostic, Failure};
use declare::record::Record;
use declare::record::varied::{self, Varied};
use studygraph::table::data::Table;
use studygraph::warning::Warning;

use super::Column;

/// Why a row has no values.
#[derive(Clone, Debug, PartialEq)]
pub enum Trouble {
    /// Its design cannot be, for this reason.
    Invalid(String),
    /// The user stopped, or the stage that has the rows cannot go on.
    Failed(Failure),
}

impl Trouble {
    /// What a stage of a kind said.
    pub fn of(kind: &str, failure: Failure) -> Self {
        match failure {
            Failure::Failed(message) => Self::Invalid(format!("{kind}: {message}")),
            Failure::Study(wrong) => Self::Invalid(format!("{kind}: {}", wrong.first.message)),
            Failure::Stopped => Self::Failed(Failure::Stopped),
        }
    }
}

/// Where the tables of a port come from.
#[derive(Clone, Debug, PartialEq)]
enum Source {
    /// A port of the stage that has the rows.
    Outer(usize),
    Link(usize),
}

/// A stage that is computed anew.
pub struct Link {
    pub kind: &'static Kind,
    pub record: Record,
    /// Ports and where they lead.
    ports: Vec<(Port, Source)>,
    /// What others ask of it.
    pub demand: Demand,
    /// Whether it draws random numbers.
    pub uses_seed: bool,
}

/// All of them, each after those it reads; the asked one is the last.
pub struct Chain {
    pub links: Vec<Link>,
    /// What they read of the study, as ports of the stage that has the rows.
    pub outer: Vec<Port>,
}

/// The tables of the links that were run, by link.
pub type Tables = Vec<Option<Vec<Table>>>;

impl Chain {
    /// `demands` are what is asked of each stage beside what the others read.
    ///
    /// # Errors
    /// What a kind refuses of the study as it is.
    pub fn new(varied: &Varied, demands: Vec<Demand>) -> Result<Self, Diagnostic> {
        let mut built: Vec<(&'static Kind, Vec<Port>)> = Vec::new();
        let mut draws = Vec::new();
        for stage in &varied.stages {
            let own = self::built(stage)?;
            draws.push(own.uses_seed());
            built.push((kind(stage)?, own.inputs()));
        }
        let mut chain = Self { links: Vec::new(), outer: Vec::new() };
        for (index, ((kind, ports), demand)) in built.iter().zip(demands).enumerate() {
            let mut link = Link {
                kind,
                record: varied.stages[index].filled.clone(),
                ports: Vec::new(),
                demand,
                uses_seed: draws[index],
            };
            for port in ports {
                // Columns on demand are never what another stage of the chain reads.
                if !port.is_wanted(&link.demand) {
                    continue;
                }
                let source = chain.source(varied, &built, index, port);
                link.ports.push((port.clone(), source));
            }
            chain.links.push(link);
        }
        for reader in 0..chain.links.len() {
            for (port, source) in chain.links[reader].ports.clone() {
                if let Source::Link(read) = source {
                    let tables = &mut chain.links[read].demand.tables;
                    for Want { table, columns } in port.wants {
                        tables.entry(table).or_default().extend(columns);
                    }
                }
            }
        }
        Ok(chain)
    }

    fn source(&mut self, varied: &Varied, built: &[(&'static Kind, Vec<Port>)], index: usize, port: &Port) -> Source {
        let (mut stage, mut through) = (port.stage.clone(), port.through);
        while let Some(read) = varied.stages.iter().position(|other| other.name == stage) {
            let Some(name) = through else { return Source::Link(read) };
            let Some(further) = built[read].1.iter().find(|port| port.name == name) else { return Source::Link(read) };
            (stage, through) = (further.stage.clone(), further.through);
        }
        // Ports are part of a key by name and content: the name says whose it is, and not what the stage is called.
        let name = format!("{} of {} {}", port.name, built[index].0.name, index + 1);
        self.outer.push(Port { name, stage, through, wants: port.wants.clone(), only_for: &[] });
        Source::Outer(self.outer.len() - 1)
    }

    /// Digest of where the stages read what, and what is asked of each.
    pub fn write(&self, writer: &mut Writer) {
        writer.count(self.links.len());
        for Link { kind, record: _, ports, demand, uses_seed } in &self.links {
            writer.text(kind.name).flag(*uses_seed).count(ports.len());
            for (port, source) in ports {
                match source {
                    Source::Outer(at) => writer.text(&port.name).text(&self.outer[*at].name),
                    Source::Link(read) => writer.text(&port.name).count(*read),
                };
            }
            writer.count(demand.tables.len());
            for (table, columns) in &demand.tables {
                writer.text(table).count(columns.len());
                for column in columns {
                    writer.text(column);
                }
            }
        }
    }

    /// What a stage reads, of the tables of those that were run and of the study.
    pub fn inputs<'t>(&self, index: usize, tables: &'t Tables, outer: &Inputs<'t>) -> Inputs<'t> {
        let mut inputs = Inputs::default();
        for (port, source) in &self.links[index].ports {
            let found: Vec<&Table> = match source {
                Source::Outer(at) => outer.ports.get(&self.outer[*at].name).cloned().unwrap_or_default(),
                Source::Link(read) => tables[*read].iter().flatten().collect(),
            };
            inputs.ports.insert(port.name.clone(), found);
        }
        inputs
    }

    /// Whether all that a stage reads of the others is there.
    pub fn can_run(&self, index: usize, tables: &Tables) -> bool {
        self.links[index].ports.iter().all(|(_, source)| match source {
            Source::Outer(_) => true,
            Source::Link(read) => tables[*read].is_some(),
        })
    }

    /// The link that a port of a stage leads to, if it is one.
    pub fn read_by(&self, index: usize, port: &str) -> Option<usize> {
        let found = self.links[index].ports.iter().find(|(own, _)| own.name == port)?;
        if let Source::Link(read) = found.1 { Some(read) } else { None }
    }

    /// Whether a port of a stage leads to a link.
    pub fn reads(&self, index: usize, read: usize) -> bool {
        self.links[index].ports.iter().any(|(_, source)| *source == Source::Link(read))
    }

    /// The names of the ports of a stage.
    pub fn ports(&self, index: usize) -> impl Iterator<Item = &str> {
        self.links[index].ports.iter().map(|(port, _)| port.name.as_str())
    }

    /// A stage's record with a row's values in it.
    pub fn record(&self, index: usize, columns: &[Column], row: &[f64]) -> Record {
        let mut record = self.links[index].record.clone();
        for (column, value) in columns.iter().zip(row).filter(|(column, _)| column.axis.stage == index) {
            column.axis.put(&mut record, *value);
        }
        record
    }

    /// Builds and runs a stage with a row's values.
    ///
    /// # Errors
    /// What it refuses or fails with.
    pub fn run(
        &self,
        index: usize,
        (columns, row): (&[Column], &[f64]),
        tables: &Tables,
        (context, outer): (&Context, &Inputs),
    ) -> Result<Vec<Table>, Trouble> {
        let is_heard = false;
        // What a stage warns of in one of a million rows nobody reads.
        let inner = Context { progress: &|_| (), warn: &|_| (), is_heard, ..*context };
        self.run_in(index, (columns, row), tables, (&inner, outer))
    }

    /// The worst that stages report of tip corners that they leave out, with a row's values; none where one cannot run.
    pub fn warning_of_corners(
        &self,
        (columns, row): (&[Column], &[f64]),
        (context, outer): (&Context, &Inputs),
    ) -> Option<Warning> {
        let worst: Mutex<Option<Warning>> = Mutex::default();
        let warn = |warning: Warning| {
            if warning.is_about(neglected_corners::ABOUT) {
                let mut worst = worst.lock().unwrap_or_else(PoisonError::into_inner);
                *worst = Some(worst.take().map_or_else(|| warning.clone(), |before| before.worse(warning.clone())));
            }
        };
        let inner = Context { progress: &|_| (), warn: &warn, ..*context };
        let mut tables: Tables = self.links.iter().map(|_| None).collect();
        for link in 0..self.links.len() {
            tables[link] = Some(self.run_in(link, (columns, row), &tables, (&inner, outer)).ok()?);
        }
        worst.into_inner().unwrap_or_else(PoisonError::into_inner)
    }

    fn run_in(
        &self,
        index: usize,
        (columns, row): (&[Column], &[f64]),
        tables: &Tables,
        (context, outer): (&Context, &Inputs),
    ) -> Result<Vec<Table>, Trouble> {
        let link = &self.links[index];
        let stage = (link.kind.build)(&self.record(index, columns, row))
            .map_err(|wrong| Trouble::Invalid(format!("{}: {}", link.kind.name, wrong.first.message)))?;
        let inner = Context { demand: &link.demand, ..*context };
        stage.run(&inner, &self.inputs(index, tables, outer)).map_err(|failure| Trouble::of(link.kind.name, failure))
    }
}

/// The kind of a stage.
///
/// # Errors
/// When there is none of this name.
pub fn kind(stage: &varied::Stage) -> Result<&'static Kind, Diagnostic> {
    stage::kind(stage.kind).ok_or_else(|| Diagnostic::new(format!("there is no kind `{}`", stage.kind)))
}

/// A stage as it is in the study.
///
/// # Errors
/// What its kind refuses.
pub fn built(stage: &varied::Stage) -> Result<Box<dyn Stage>, Diagnostic> {
    (kind(stage)?.build)(&stage.record).map_err(|wrong| *wrong.first)
}
