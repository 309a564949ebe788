//! A manifest as text. Format 2 says once what many tables and chunks have in common, and has one line for each table,
//! column and file, so that a difference between two commits can be read. Format 1, of earlier versions, is still read.
//!
//! Must not know: what any of it is for.

use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::lines::Lines;
use super::{
    ColumnRecord, Config, FileRecord, Machine, Manifest, More, OmissionRecord, PartsRecord, Program, Source,
    StageRecord, StudyFolder, TableRecord,
};
use crate::store::journal::Failed;
use crate::store::key_record::{KeyRecord, Short};
use crate::store::shared;

#[derive(Serialize, Deserialize)]
pub(super) struct Text<'a> {
    format: u32,
    study: Cow<'a, str>,
    title: Cow<'a, str>,
    seed: u64,
    source: Cow<'a, Option<Source>>,
    study_digest: Cow<'a, str>,
    program: Cow<'a, Program>,
    #[serde(default)]
    study_folder: Cow<'a, StudyFolder>,
    machine: Cow<'a, Machine>,
    written: Cow<'a, str>,
    seconds: f64,
    /// What tables are, by a name for those that are alike.
    #[serde(default)]
    schemas: Schemas,
    stages: Stages<'a>,
    #[serde(default, skip_serializing_if = "<[_]>::is_empty")]
    tolerances: Cow<'a, [(String, String)]>,
    #[serde(default)]
    files: Cow<'a, [FileRecord]>,
}

/// In the order in which they were first needed.
#[derive(Default)]
struct Schemas(Vec<(Arc<str>, TableSchema)>);

#[derive(Clone, Serialize, Deserialize)]
struct TableSchema {
    #[serde(with = "shared")]
    description: Arc<str>,
    #[serde(serialize_with = "shared::serialize", deserialize_with = "shared::all")]
    columns: Arc<[ColumnRecord]>,
}

/// The stages of a manifest.
enum Stages<'a> {
    Read(Vec<Stage<'a>>),
    /// To be written, one made ready after the other: all at once take as much as the manifest. With the names of the schemas of
    /// all their tables.
    Of(&'a [StageRecord], Vec<Arc<str>>),
}

#[derive(Serialize, Deserialize)]
struct Stage<'a> {
    name: Cow<'a, str>,
    kind: Cow<'a, str>,
    version: u32,
    keys: Vec<Keys>,
    #[serde(default, skip_serializing_if = "Config::is_null")]
    config: Config,
    status: Cow<'a, str>,
    why: Cow<'a, str>,
    seconds: f64,
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    work: Cow<'a, BTreeMap<String, u64>>,
    #[serde(default, skip_serializing_if = "<[_]>::is_empty")]
    warnings: Cow<'a, [String]>,
    #[serde(default, skip_serializing_if = "<[_]>::is_empty")]
    left_out: Cow<'a, [OmissionRecord]>,
    tables: Vec<Table<'a>>,
}

/// The keys of chunks that differ by their axis alone. Format 1 has one `key` and `axis` for each.
#[derive(Serialize, Deserialize)]
struct Keys {
    config: Short,
    #[serde(default, serialize_with = "shared::serialize", deserialize_with = "shared::all")]
    fields: Arc<[(String, Short)]>,
    code: Short,
    #[serde(default, skip_serializing_if = "Nothing::is_empty")]
    seed: Nothing,
    demand: Short,
    #[serde(serialize_with = "shared::serialize", deserialize_with = "shared::all")]
    inputs: Arc<[(String, Short)]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    key: Option<Failed>,
    #[serde(default, skip_serializing_if = "Nothing::is_empty")]
    axis: Nothing,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    chunks: Vec<(Failed, Short)>,
}

/// Nothing is an empty text.
#[derive(Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct Nothing(#[serde(with = "crate::store::key_record::optional")] Option<Short>);

impl Nothing {
    #[allow(clippy::trivially_copy_pass_by_ref)] // as serde calls it
    fn is_empty(&self) -> bool {
        self.0.is_none()
    }
}

#[derive(Serialize, Deserialize)]
struct Table<'a> {
    name: Cow<'a, str>,
    rows: usize,
    content: Cow<'a, str>,
    /// The name of its schema; none in format 1.
    #[serde(default, skip_serializing_if = "str::is_empty")]
    schema: Cow<'a, str>,
    #[serde(default, skip_serializing)]
    description: Option<String>,
    #[serde(default, skip_serializing)]
    columns: Option<Vec<ColumnRecord>>,
    file: Cow<'a, str>,
    #[serde(default, skip_serializing_if = "<[_]>::is_empty")]
    files: Cow<'a, [String]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    parts: Option<Cow<'a, PartsRecord>>,
}

impl Serialize for Schemas {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, schema) in &self.0 {
            map.serialize_entry(&**name, schema)?;
        }
        map.end()
    }
}

impl<'de> Deserialize<'de> for Schemas {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let known = BTreeMap::<String, TableSchema>::deserialize(deserializer)?;
        Ok(Self(known.into_iter().map(|(name, schema)| (name.into(), schema)).collect()))
    }
}

impl Serialize for Stages<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Read(stages) => stages.serialize(serializer),
            Self::Of(records, schemas) => {
                let mut schemas = schemas.iter();
                serializer.collect_seq(records.iter().map(|record| Stage::of(record, &mut schemas)))
            }
        }
    }
}

impl<'de> Deserialize<'de> for Stages<'_> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Vec::deserialize(deserializer).map(Self::Read)
    }
}

impl Serialize for Manifest {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        text(self, &self.files).serialize(serializer)
    }
}

/// A manifest that lists these files.
pub(super) fn text<'a>(manifest: &'a Manifest, files: &'a [FileRecord]) -> Text<'a> {
    let mut named = Named::default();
    let tables = manifest.stages.iter().flat_map(|stage| stage.tables.iter().map(|table| (&*stage.kind, table)));
    let of_tables = tables.map(|(kind, table)| named.name(kind, table)).collect();
    Text {
        format: manifest.format.max(super::FORMAT),
        study: Cow::Borrowed(&manifest.study),
        title: Cow::Borrowed(&manifest.title),
        seed: manifest.seed,
        source: Cow::Borrowed(&manifest.source),
        study_digest: Cow::Borrowed(&manifest.study_digest),
        program: Cow::Borrowed(&manifest.program),
        study_folder: Cow::Borrowed(&manifest.study_folder),
        machine: Cow::Borrowed(&manifest.machine),
        written: Cow::Borrowed(&manifest.written),
        seconds: manifest.seconds,
        stages: Stages::Of(&manifest.stages, of_tables),
        schemas: Schemas(named.schemas),
        tolerances: Cow::Borrowed(&manifest.tolerances),
        files: Cow::Borrowed(files),
    }
}

/// Where the list of files begins, which is the last: no text in a manifest has a line of its own.
const FILES: &[u8] = b"\n \"files\": ";

/// As [`Manifest::with_other_files`]: what stands before the list is kept and not read.
pub(super) fn with_other_files(mut text: Vec<u8>, files: &[FileRecord]) -> Option<Vec<u8>> {
    let at = text.windows(FILES.len()).rposition(|window| window == FILES)? + FILES.len();
    if !text.ends_with(b"\n}\n") || !text.starts_with(b"{\n \"format\": ") {
        return None;
    }
    text.truncate(at);
    let lines = Lines::inside(1);
    files.serialize(&mut serde_json::Serializer::with_formatter(&mut text, lines)).ok()?;
    text.extend_from_slice(b"\n}\n");
    Some(text)
}

/// Names for schemas: that of kind and table, with a number where that is taken.
#[derive(Default)]
struct Named {
    schemas: Vec<(Arc<str>, TableSchema)>,
    /// Of kind and table, the places of those that were met.
    met: HashMap<(String, String), Vec<usize>>,
    /// The last name of these columns' place in memory, which alike tables share, with its kind and table; the place stays
    /// theirs while the manifest does.
    quick: HashMap<(*const ColumnRecord, *const u8), (String, String, Arc<str>)>,
}

impl Named {
    fn name(&mut self, kind: &str, table: &TableRecord) -> Arc<str> {
        let place = (table.columns.as_ptr(), table.description.as_ptr());
        if let Some((of, own, name)) = self.quick.get(&place)
            && (of.as_str(), own.as_str()) == (kind, table.table())
        {
            return Arc::clone(name);
        }
        let name = self.compared(kind, table);
        self.quick.insert(place, (kind.to_owned(), table.table().to_owned(), Arc::clone(&name)));
        name
    }

    fn compared(&mut self, kind: &str, table: &TableRecord) -> Arc<str> {
        let own = table.table();
        let met = self.met.entry((kind.to_owned(), own.to_owned())).or_default();
        let same = |place: &&usize| {
            let TableSchema { description, columns } = &self.schemas[**place].1;
            (Arc::ptr_eq(columns, &table.columns) || *columns == table.columns) && *description == table.description
        };
        if let Some(place) = met.iter().find(same) {
            return Arc::clone(&self.schemas[*place].0);
        }
        let name = if met.is_empty() { format!("{kind}.{own}") } else { format!("{kind}.{own}.{}", met.len() + 1) };
        let name: Arc<str> = name.into();
        met.push(self.schemas.len());
        let schema = TableSchema { description: Arc::clone(&table.description), columns: Arc::clone(&table.columns) };
        self.schemas.push((Arc::clone(&name), schema));
        name
    }
}

impl<'a> Stage<'a> {
    /// With the names of the schemas of its tables, which are the next ones.
    fn of(stage: &'a StageRecord, schemas: &mut impl Iterator<Item = &'a Arc<str>>) -> Self {
        let tables = stage.tables.iter().zip(schemas).map(|(table, schema)| Table {
            name: Cow::Borrowed(&table.name),
            rows: table.rows,
            content: Cow::Borrowed(&table.content),
            schema: Cow::Borrowed(schema),
            description: None,
            columns: None,
            file: Cow::Borrowed(&table.file),
            files: Cow::Borrowed(&table.files),
            parts: table.parts.as_ref().map(Cow::Borrowed),
        });
        Self {
            name: Cow::Borrowed(&stage.name),
            kind: Cow::Borrowed(&stage.kind),
            version: stage.version,
            keys: keys(&stage.keys),
            config: stage.config.clone(),
            status: Cow::Borrowed(&stage.status),
            why: Cow::Borrowed(&stage.why),
            seconds: stage.seconds,
            work: Cow::Borrowed(&stage.work),
            warnings: Cow::Borrowed(&stage.warnings),
            left_out: Cow::Borrowed(&stage.left_out),
            tables: tables.collect(),
        }
    }
}

/// Chunks one after the other that differ by their axis alone stand together.
fn keys(records: &[KeyRecord]) -> Vec<Keys> {
    let mut all: Vec<Keys> = Vec::new();
    for KeyRecord { key, config, fields, axis, code, seed, demand, inputs } in records {
        let last = all.last_mut().filter(|last| {
            let same = (&last.config, &last.code, last.seed.0, &last.demand) == (config, code, *seed, demand);
            same && last.fields == *fields && last.inputs == *inputs
        });
        match (last, axis) {
            (Some(Keys { chunks, .. }), Some(axis)) if !chunks.is_empty() => chunks.push((Failed(*key), *axis)),
            (_, axis) => all.push(Keys {
                config: *config,
                fields: Arc::clone(fields),
                code: *code,
                seed: Nothing(*seed),
                demand: *demand,
                inputs: Arc::clone(inputs),
                key: axis.is_none().then_some(Failed(*key)),
                axis: Nothing(None),
                chunks: axis.iter().map(|axis| (Failed(*key), *axis)).collect(),
            }),
        }
    }
    all
}

impl<'de> Deserialize<'de> for Manifest {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = Text::deserialize(deserializer)?;
        let schemas: HashMap<&str, &TableSchema> =
            text.schemas.0.iter().map(|(name, schema)| (&**name, schema)).collect();
        let wrong = |problem: String| serde::de::Error::custom(problem);
        // Those to be written are records already.
        let Stages::Read(stages) = text.stages else { return Err(wrong("it has no stages".to_owned())) };
        let stages = stages.into_iter().map(|stage| stage.record(&schemas).map_err(wrong));
        Ok(Self {
            stages: stages.collect::<Result<_, D::Error>>()?,
            format: text.format,
            study: text.study.into_owned(),
            title: text.title.into_owned(),
            seed: text.seed,
            source: text.source.into_owned(),
            study_digest: text.study_digest.into_owned(),
            program: text.program.into_owned(),
            study_folder: text.study_folder.into_owned(),
            machine: text.machine.into_owned(),
            written: text.written.into_owned(),
            seconds: text.seconds,
            tolerances: text.tolerances.into_owned(),
            files: text.files.into_owned(),
            more: More::default(),
        })
    }
}

impl Stage<'_> {
    fn record(self, schemas: &HashMap<&str, &TableSchema>) -> Result<StageRecord, String> {
        let table = |table: Table| {
            let TableSchema { description, columns } = match (table.description, table.columns) {
                (Some(description), Some(columns)) => {
                    TableSchema { description: description.into(), columns: columns.into() }
                }
                _ => schemas.get(&*table.schema).map(|schema| (*schema).clone()).ok_or_else(|| {
                    format!(
                        "table `{}` has the columns `{}`, and nothing says which those are",
                        table.name, table.schema
                    )
                })?,
            };
            Ok(TableRecord {
                description,
                columns,
                file: table.file.into_owned(),
                name: table.name.into_owned(),
                rows: table.rows,
                content: table.content.into_owned(),
                files: table.files.into_owned(),
                parts: table.parts.map(Cow::into_owned),
            })
        };
        let keys = self.keys.into_iter().flat_map(|keys| {
            let single = keys.key.map(|key| (key, keys.axis.0));
            let chunks = keys.chunks.into_iter().map(|(key, axis)| (key, Some(axis)));
            let record = move |(Failed(key), axis)| KeyRecord {
                key,
                config: keys.config,
                fields: Arc::clone(&keys.fields),
                axis,
                code: keys.code,
                seed: keys.seed.0,
                demand: keys.demand,
                inputs: Arc::clone(&keys.inputs),
            };
            single.into_iter().chain(chunks).map(record)
        });
        Ok(StageRecord {
            keys: keys.collect(),
            name: self.name.into_owned(),
            kind: self.kind.into_owned(),
            version: self.version,
            config: self.config,
            status: self.status.into_owned(),
            why: self.why.into_owned(),
            seconds: self.seconds,
            work: self.work.into_owned(),
            warnings: self.warnings.into_owned(),
            left_out: self.left_out.into_owned(),
            tables: self.tables.into_iter().map(table).collect::<Result<_, String>>()?,
        })
    }
}
