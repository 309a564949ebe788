//! The cache key of a stage or chunk, and the sentence that says why it differs from the last one.
//!
//! Both come from one [`KeyRecord`]: the key is the digest of the parts that are in the record and of nothing else, so
//! whatever changes a key has a name. Never in it: labels of stages, paths, times, thread counts. The name of a stage enters by
//! its seed alone, and only where random numbers are drawn. Must not know: the cache, states.

use std::fmt;
use std::sync::Arc;

use super::chunk::{Chunks, chunks};
use super::graph::{Graph, Input};
use crate::stage::Demand;
use crate::store::entry::StoredTable;
use crate::store::hexadecimal;
use crate::store::manifest::{KeyRecord, Short};
use crate::study::Study;
use declare::digest::{Digest, Writer};
use declare::record::Record;
use declare::seed::Seed;

/// A chunk of a stage, or all of it.
pub struct KeyedChunk {
    pub key: Digest,
    pub record: KeyRecord,
    pub cut: Cut,
}

/// What of its stage a chunk is.
#[derive(Clone, Debug, PartialEq)]
pub enum Cut {
    /// All of it.
    Whole,
    /// These values of this axis.
    Axis(&'static str, Vec<f64>),
    /// One of the parts into which the stage cuts itself.
    Part {
        /// Which one, from 0.
        index: usize,
        /// The field that says first which rows there are.
        field: &'static str,
        /// Whether it is made of the tables of all others.
        is_of_all: bool,
    },
}

impl KeyedChunk {
    /// The field along which its stage is cut.
    #[must_use]
    pub fn axis(&self) -> Option<&'static str> {
        match self.cut {
            Cut::Whole => None,
            Cut::Axis(field, _) | Cut::Part { field, .. } => Some(field),
        }
    }

    /// Whether it is made of the tables of all others.
    #[must_use]
    pub fn is_of_all(&self) -> bool {
        matches!(self.cut, Cut::Part { is_of_all: true, .. })
    }
}

/// The keys of a stage whose inputs are known; `tables` gives what a node came out as.
#[must_use]
pub fn parts<'t>(
    study: &Study,
    graph: &Graph,
    node: usize,
    tables: impl Fn(usize) -> &'t [StoredTable],
) -> Vec<KeyedChunk> {
    let of_study = &study.nodes[node];
    let own = of_study.stage.parts();
    let chunks = if own.is_some() { None } else { chunks(of_study.kind, &of_study.record) };
    let inputs = graph.inputs[node].iter().map(|from| (from.port.clone(), input(from, tables(from.node))));
    let common = Parts {
        code: graph.codes[node],
        record: &of_study.record,
        rows: match (&own, &chunks) {
            (Some(own), _) => own.fields.to_vec(),
            (None, chunks) => chunks.iter().map(|chunks| chunks.field).collect(),
        },
        shared: own.as_ref().map(|own| own.shared),
        inputs: inputs.collect(),
        seed: of_study.stage.uses_seed().then(|| Seed::of_stage(study.seed, &of_study.name)),
        demand: &graph.demands[node],
    };
    let common = common.common();
    let part = |axis: Option<Digest>, cut: Cut| {
        let record = common.record(axis.as_ref());
        KeyedChunk { key: record.key, record, cut }
    };
    if let Some(own) = own {
        let field = own.fields.first().copied().unwrap_or_default();
        let count = own.each.len();
        let keyed = |(index, digest)| {
            part(Some(digest), Cut::Part { index, field, is_of_all: own.last_is_of_all && index + 1 == count })
        };
        return own.each.into_iter().enumerate().map(keyed).collect();
    }
    match chunks {
        None => vec![part(None, Cut::Whole)],
        Some(Chunks { field, values }) => {
            let keyed = |values: Vec<f64>| part(Some(values_of(field, &values)), Cut::Axis(field, values));
            values.into_iter().map(keyed).collect()
        }
    }
}

/// The digest of some values of an axis.
fn values_of(field: &str, values: &[f64]) -> Digest {
    Writer::new("gearstudy 1 axis").text(field).floats(values).finish()
}

/// What the chunks of one stage have in common.
pub struct Parts<'a> {
    /// As [`code`](super::graph::code).
    pub code: Digest,
    pub record: &'a Record,
    /// The fields that say which rows there are.
    pub rows: Vec<&'static str>,
    /// What of them every row depends on, where the stage cuts itself.
    pub shared: Option<Digest>,
    /// Port, and the digest of what comes in.
    pub inputs: Vec<(String, Digest)>,
    pub seed: Option<Seed>,
    pub demand: &'a Demand,
}

impl Parts<'_> {
    /// The record of one chunk, that has these `values` of the axis; none of a stage that is not cut.
    #[cfg(test)]
    pub fn record(&self, values: Option<&[f64]>) -> KeyRecord {
        let axis = values.zip(self.rows.first()).map(|(values, field)| values_of(field, values));
        self.common().record(axis.as_ref())
    }

    /// What is digested once for all chunks.
    #[must_use]
    pub fn common(&self) -> Common<'_> {
        let mut config = Writer::new("gearstudy 1 config");
        let mut fields = Vec::new();
        for field in self.record.fields.iter().filter(|(name, _)| !self.rows.contains(name)) {
            let mut writer = Writer::new("gearstudy 1 field");
            Record::write_fields(std::slice::from_ref(field), &mut writer);
            let digest = writer.finish();
            config.text(field.0).digest(&digest);
            fields.push((field.0.to_owned(), Short::from(&digest)));
        }
        if let (Some(shared), Some(field)) = (self.shared, self.rows.first()) {
            config.text(field).digest(&shared);
            fields.push(((*field).to_owned(), Short::from(&shared)));
        }
        config.count(fields.len());
        let seed = self.seed.map(|seed| seed.digest());
        Common {
            code: self.code,
            config: config.finish(),
            fields: fields.into(),
            seed,
            demand: demand(self.demand),
            inputs: &self.inputs,
        }
    }
}

/// The digest of what is asked of a stage.
fn demand(demand: &Demand) -> Digest {
    let mut writer = Writer::new("gearstudy 1 demand");
    writer.count(demand.tables.len());
    for (table, columns) in &demand.tables {
        writer.text(table).count(columns.len());
        for column in columns {
            writer.text(column);
        }
    }
    writer.finish()
}

/// Digests that all chunks of a stage have in common.
pub struct Common<'a> {
    code: Digest,
    config: Digest,
    fields: Arc<[(String, Short)]>,
    seed: Option<Digest>,
    demand: Digest,
    inputs: &'a [(String, Digest)],
}

impl Common<'_> {
    /// The record of the chunk that this digest tells from the others; none of a stage that is not cut.
    #[must_use]
    pub fn record(&self, axis: Option<&Digest>) -> KeyRecord {
        let mut key = Writer::new("gearstudy 1 key");
        for part in [Some(&self.code), Some(&self.config), axis, self.seed.as_ref(), Some(&self.demand)] {
            match part {
                Some(digest) => key.text(&hexadecimal::text(digest)),
                None => key.text(""),
            };
        }
        key.count(self.inputs.len());
        for (port, digest) in self.inputs {
            key.text(port).text(&hexadecimal::text(digest));
        }
        KeyRecord {
            key: key.finish(),
            config: Short::from(&self.config),
            fields: Arc::clone(&self.fields),
            axis: axis.map(Short::from),
            code: Short::from(&self.code),
            seed: self.seed.as_ref().map(Short::from),
            demand: Short::from(&self.demand),
            inputs: self.inputs.iter().map(|(port, digest)| (port.clone(), Short::from(digest))).collect(),
        }
    }
}

/// The digest of what a port reads.
#[must_use]
pub fn input(input: &Input, tables: &[StoredTable]) -> Digest {
    let mut writer = Writer::new("gearstudy 1 input");
    writer.count(input.wants.len());
    for want in &input.wants {
        match tables.iter().find(|table| table.name == want.table) {
            Some(table) => table.write_seen(&want.columns, &mut writer),
            None => {
                writer.text(&want.table);
            }
        }
    }
    writer.finish()
}

/// The key under which it is kept what the chunks' tables are together.
#[must_use]
pub fn whole<'a>(chunks: impl Iterator<Item = &'a [StoredTable]>) -> Digest {
    let mut writer = Writer::new("gearstudy 1 whole");
    for tables in chunks {
        writer.count(tables.len());
        for table in tables {
            writer.text(&table.name).digest(&table.content).digest(&table.base).count(table.columns.len());
            for column in &table.columns {
                writer.text(&column.name).digest(&column.content);
            }
        }
    }
    writer.finish()
}

/// One reason to compute.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Why {
    NeverRan,
    FailedBefore,
    Forced,
    /// Fields that changed.
    Config(Vec<String>),
    /// The axis has values that were not there.
    Axis(&'static str),
    /// A port through which something else came in.
    Input(String),
    Code,
    Seed,
    Demand,
    ObjectMissing,
    /// With what is wrong.
    ObjectDamaged(String),
    /// All chunks are there, but what they are together is not known.
    NotPutTogether,
}

impl fmt::Display for Why {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NeverRan => write!(formatter, "never ran"),
            Self::FailedBefore => write!(formatter, "failed the last time"),
            Self::Forced => write!(formatter, "forced"),
            Self::Config(fields) if fields.is_empty() => write!(formatter, "config changed"),
            Self::Config(fields) => write!(formatter, "config changed: {}", fields.join(", ")),
            Self::Axis(field) => write!(formatter, "config changed: new values of {field}"),
            Self::Input(port) => write!(formatter, "input changed: {port}"),
            Self::Code => write!(formatter, "code changed"),
            Self::Seed => write!(formatter, "seed changed"),
            Self::Demand => write!(formatter, "demand changed"),
            Self::ObjectMissing => write!(formatter, "object missing"),
            Self::ObjectDamaged(problem) => write!(formatter, "object damaged: {problem}"),
            Self::NotPutTogether => write!(formatter, "chunks not put together"),
        }
    }
}

/// Several reasons as one phrase.
#[must_use]
pub fn phrase(why: &[Why]) -> String {
    why.iter().map(Why::to_string).collect::<Vec<_>>().join("; ")
}

/// Why `now` has another key than the records of the last success.
#[must_use]
pub fn explain(last: &[KeyRecord], now: &KeyRecord, axis: Option<&'static str>) -> Vec<Why> {
    let Some(nearest) = last.iter().find(|record| record.axis == now.axis).or(last.first()) else {
        return vec![Why::NeverRan];
    };
    let mut why = Vec::new();
    if nearest.config != now.config {
        why.push(Why::Config(differences(&nearest.fields, &now.fields)));
    }
    if nearest.axis != now.axis {
        why.push(axis.map_or(Why::Config(Vec::new()), Why::Axis));
    }
    why.extend(differences(&nearest.inputs, &now.inputs).into_iter().map(Why::Input));
    for (changed, reason) in [
        (nearest.seed != now.seed, Why::Seed),
        (nearest.code != now.code, Why::Code),
        (nearest.demand != now.demand, Why::Demand),
    ] {
        if changed {
            why.push(reason);
        }
    }
    // The same parts in another order: ports that changed places.
    if why.is_empty() { vec![Why::Config(Vec::new())] } else { why }
}

/// The names whose value differs, or that only one of the two has.
fn differences(was: &[(String, Short)], is: &[(String, Short)]) -> Vec<String> {
    let changed = is.iter().filter(|pair| !was.contains(pair)).map(|(name, _)| name.clone());
    let gone = was.iter().filter(|(name, _)| !is.iter().any(|(other, _)| other == name)).map(|(name, _)| name.clone());
    changed.chain(gone).collect()
}
