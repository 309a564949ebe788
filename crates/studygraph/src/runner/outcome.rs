//! What came of a run: per stage a status, and the way to its tables.
//!
//! Must not know: how it is shown; threads.

use std::collections::HashMap;
use std::sync::Arc;

use super::board::{Board, StageState};
use super::fault::Fault;
use super::key::{Cut, KeyedChunk, phrase};
use super::plan::left_out;
use crate::stage::Omission;
use crate::store::bundle;
use crate::store::cache::{Cache, Lookup};
use crate::store::entry::StoredTable;
use crate::store::error::StoreError;
use crate::store::manifest::{
    Config, Described, FORMAT, KeyRecord, Manifest, OmissionRecord, Source, StageRecord, TableRecord,
};
use crate::store::parquet;
use crate::study::settings::Shown;
use crate::study::{self, Study};
use crate::table::data::Table;
use crate::table::schema::Schema;
use declare::digest::Digest;
use declare::work::Work;

/// What came of a run.
#[derive(Debug)]
pub struct Outcome {
    /// Every stage after all it reads.
    pub stages: Vec<StageOutcome>,
    places: HashMap<String, usize>,
    /// Whether the user stopped it.
    pub stopped: bool,
    pub seconds: f64,
}

#[derive(Debug)]
pub struct StageOutcome {
    pub name: String,
    pub kind: &'static str,
    pub version: u32,
    /// Hit, Done, Failed or Skipped.
    pub state: StageState,
    /// Why it ran, failed or was skipped; `unchanged` when it did not have to run.
    pub why: String,
    pub fault: Option<Fault>,
    pub chunks: usize,
    /// Chunks that were computed in this run.
    pub ran: usize,
    /// Seconds of computing, whenever that was.
    pub seconds: f64,
    /// Work that was counted then.
    pub work: Work,
    pub warnings: Vec<String>,
    pub left_out: Arc<[Omission]>,
    pub keys: Vec<KeyRecord>,
    /// As the manifest keeps it.
    pub config: Config,
    /// The demanded tables, in the order of the stage; empty unless it was a hit or ran.
    pub tables: Vec<(Arc<Schema>, StoredTable)>,
    parts: Vec<Digest>,
    whole: Option<Digest>,
    /// Whether it cut itself: its tables come in pieces, in the order of their rows.
    is_cut: bool,
}

impl Outcome {
    /// What a board shows at the end. All of it is copied: what threads made lies among what they needed meanwhile, and one digest
    /// keeps a page of it from being given back.
    #[must_use]
    pub fn of(board: &Board, stopped: bool, seconds: f64) -> Self {
        // Of thousands of stages of a kind the same is left out.
        let mut last: Arc<[Omission]> = Arc::default();
        let mut left_out = |node: usize| {
            let found = left_out(board, node);
            if *last != *found {
                last = found.into();
            }
            Arc::clone(&last)
        };
        let stages = board.graph.order.iter().map(|&node| {
            let (progress, of_study) = (&board.nodes[node], &board.study.nodes[node]);
            let fault = progress.fault.as_ref().map(|(_, fault)| fault.clone());
            let schema = |name: &str| board.graph.demanded[node].iter().find(|schema| schema.name == name).cloned();
            let tables = progress.tables.iter().filter_map(|table| Some((schema(&table.name)?, table.clone())));
            StageOutcome {
                name: of_study.name.clone(),
                kind: of_study.kind.name,
                version: of_study.kind.version,
                state: progress.state,
                why: match progress.state {
                    StageState::Skipped => progress.skipped.clone(),
                    StageState::Failed => fault.as_ref().map_or_else(String::new, Fault::to_string),
                    _ if progress.why.is_empty() => "unchanged".to_owned(),
                    _ => phrase(&progress.why),
                },
                fault,
                chunks: progress.parts.len(),
                ran: progress.ran,
                seconds: progress.seconds(),
                work: progress.work(board.study.program.counters),
                warnings: progress.warnings(|_| true),
                left_out: left_out(node),
                keys: copied(progress.parts.iter().map(|part| &part.record)),
                config: Config::of(&Shown { fields: of_study.kind.fields, record: &of_study.record }),
                tables: if progress.state.has_tables() { tables.collect() } else { Vec::new() },
                parts: progress.parts.iter().map(|part| part.key).collect(),
                whole: progress.whole,
                is_cut: is_cut(&progress.parts),
            }
        });
        let stages: Vec<StageOutcome> = stages.collect();
        let places = stages.iter().enumerate().map(|(place, stage)| (stage.name.clone(), place)).collect();
        Self { stages, places, stopped, seconds }
    }

    #[must_use]
    pub fn stage(&self, name: &str) -> Option<&StageOutcome> {
        self.places.get(name).map(|&place| &self.stages[place])
    }

    /// The faults, with the names of their stages.
    pub fn faults(&self) -> impl Iterator<Item = (&str, &Fault)> {
        self.stages.iter().filter_map(|stage| Some((stage.name.as_str(), stage.fault.as_ref()?)))
    }

    /// The number of stages of which anything was computed.
    #[must_use]
    pub fn ran(&self) -> usize {
        self.stages.iter().filter(|stage| stage.ran > 0).count()
    }

    /// A table, from the cache.
    ///
    /// # Errors
    /// When the stage gave no such table, or the cache was damaged since. A damaged entry is forgotten, so the next run
    /// computes it again.
    pub fn table(&self, cache: &Cache, stage: &str, table: &str) -> Result<Table, StoreError> {
        let parts = filled_keys(cache, self.parts(stage), table);
        let loaded = parts.iter().map(|&key| forget_damaged(cache, key, cache.table(key, table)));
        let loaded = loaded.collect::<Result<Vec<_>, _>>()?;
        together(&format!("{stage}.{table}"), loaded)
    }

    /// The Parquet file of a table.
    ///
    /// # Errors
    /// As [`Outcome::table`].
    pub fn bytes(&self, cache: &Cache, stage: &str, table: &str) -> Result<Vec<u8>, StoreError> {
        match self.parts(stage) {
            &[key] => forget_damaged(cache, key, cache.bytes(key, table)),
            _ => parquet::write(&self.table(cache, stage, table)?),
        }
    }

    /// A table piece by piece, in the order of its rows; none where it does not come in pieces.
    ///
    /// # Errors
    /// Of each piece as [`Outcome::table`].
    pub fn pieces<'o>(
        &self,
        cache: &'o Cache,
        stage: &str,
        table: &str,
    ) -> Option<impl Iterator<Item = Result<Table, StoreError>> + use<'o>> {
        self.stage(stage).filter(|stage| stage.is_cut)?;
        let keys = filled_keys(cache, self.parts(stage), table);
        let table = table.to_owned();
        (keys.len() > 1).then(|| keys.into_iter().map(move |key| forget_damaged(cache, key, cache.table(key, &table))))
    }

    /// The number of stages that the cache has not taken.
    #[must_use]
    pub fn unkept(&self, cache: &Cache) -> usize {
        self.stages.iter().filter(|stage| stage.parts.iter().any(|key| cache.is_unkept(*key))).count()
    }

    /// The keys under which the cache has what came of it.
    pub fn keys(&self) -> impl Iterator<Item = Digest> {
        let done = self.stages.iter().filter(|stage| stage.state.has_tables());
        done.flat_map(|stage| stage.parts.iter().copied().chain(stage.whole))
    }

    fn parts(&self, stage: &str) -> &[Digest] {
        self.stage(stage).filter(|stage| stage.state.has_tables()).map_or(&[], |stage| &stage.parts)
    }

    /// The manifest of this run, without facts and files. Keys, fields and tables of the stages go into it and are not known here
    /// any longer: of thousands of stages they are as much as the study.
    #[must_use]
    pub fn take_manifest(&mut self, study: &Study) -> Manifest {
        let source = study.source.as_ref().map(|source| Source {
            paper: source.paper.clone(),
            tables: source.tables.clone(),
            figures: source.figures.clone(),
        });
        // Tables of one schema share what the manifest says of it.
        let mut described: HashMap<*const Schema, Described> = HashMap::new();
        let mut described = |schema: &Arc<Schema>| {
            described.entry(Arc::as_ptr(schema)).or_insert_with(|| Described::of(schema)).clone()
        };
        let mut manifest = Manifest {
            format: FORMAT,
            study: study.name.clone(),
            title: study.title.clone(),
            seed: study.seed,
            source,
            study_digest: study::digest(&study.text),
            seconds: self.seconds,
            stages: self.stages.iter_mut().map(|stage| stage.take_record(&mut described)).collect(),
            tolerances: study.tolerances.iter().map(|one| (one.name.clone(), one.text.clone())).collect(),
            ..Manifest::default()
        };
        bundle::assign(&mut manifest);
        manifest
    }
}

impl StageOutcome {
    /// Its tables that are too long for the one file of all tables.
    fn beyond_hdf5(&self) -> impl Iterator<Item = OmissionRecord> {
        let long = self.tables.iter().filter(|(_, table)| bundle::is_long(table.rows));
        long.map(|(_, table)| OmissionRecord {
            what: format!("table `{}` in the HDF5 file", table.name).into(),
            why: format!("that file is made in memory; all {} rows are in the table's Parquet file", table.rows).into(),
            saved_seconds: None,
        })
    }

    fn take_record(&mut self, described: &mut impl FnMut(&Arc<Schema>) -> Described) -> StageRecord {
        let status = match self.state {
            StageState::Hit if self.ran == 0 => "hit",
            StageState::Hit | StageState::Done => "ran",
            StageState::Failed => "failed",
            _ => "skipped",
        };
        let omission = |omission: &Omission| OmissionRecord {
            what: omission.what.clone(),
            why: omission.why.clone(),
            saved_seconds: omission.seconds(&self.work, self.seconds),
        };
        StageRecord {
            name: self.name.clone(),
            kind: self.kind.to_owned(),
            version: self.version,
            keys: std::mem::take(&mut self.keys),
            config: std::mem::take(&mut self.config),
            status: status.to_owned(),
            why: self.why.clone(),
            seconds: self.seconds,
            work: self.work.named(),
            warnings: self.warnings.clone(),
            left_out: self.left_out.iter().map(omission).chain(self.beyond_hdf5()).collect(),
            tables: std::mem::take(&mut self.tables)
                .into_iter()
                .map(|(schema, table)| TableRecord::described(&self.name, &described(&schema), &table))
                .collect(),
        }
    }
}

/// Records of chunks; what they have in common they share as those do that they are copied from.
fn copied<'r>(records: impl Iterator<Item = &'r KeyRecord>) -> Vec<KeyRecord> {
    let mut last: Option<(&KeyRecord, KeyRecord)> = None;
    let copied = |record: &'r KeyRecord| {
        let mut copy = record.clone();
        match &last {
            Some((of, known)) if Arc::ptr_eq(&of.fields, &record.fields) => copy.fields = Arc::clone(&known.fields),
            _ => copy.fields = record.fields.iter().cloned().collect(),
        }
        copy.inputs = record.inputs.iter().cloned().collect();
        last = Some((record, copy.clone()));
        copy
    };
    records.map(copied).collect()
}

/// Whether the tables of a stage come in pieces.
pub(super) fn is_cut(parts: &[KeyedChunk]) -> bool {
    parts.len() > 1 && parts.iter().all(|part| matches!(part.cut, Cut::Part { .. }))
}

/// Of entries that have so many rows of a table those that have any; the first, where none has.
pub(super) fn filled(rows: impl Iterator<Item = usize>) -> Vec<usize> {
    let filled: Vec<usize> = rows.enumerate().filter(|(_, rows)| *rows > 0).map(|(index, _)| index).collect();
    if filled.is_empty() { vec![0] } else { filled }
}

/// The keys of those that have rows of a table. What cannot be looked up is left to whoever reads it.
fn filled_keys(cache: &Cache, keys: &[Digest], table: &str) -> Vec<Digest> {
    if keys.len() < 2 {
        return keys.to_vec();
    }
    let rows = |key: &Digest| match cache.look_up(*key) {
        Lookup::Found(entry) => entry.tables.iter().find(|stored| stored.name == table).map_or(1, |stored| stored.rows),
        Lookup::Missing | Lookup::Damaged(_) => 1,
    };
    filled(keys.iter().map(rows)).into_iter().map(|index| keys[index]).collect()
}

/// The chunks of a table as one.
///
/// # Errors
/// When they do not fit together: a table of a stage that is cut must have the axis in its key.
pub fn together(name: &str, parts: Vec<Table>) -> Result<Table, StoreError> {
    let failed = |problem: String| StoreError::Format { table: name.to_owned(), problem };
    Table::concatenated(parts)
        .map_err(|error| failed(error.to_string()))?
        .ok_or_else(|| failed("there is no such table".to_owned()))
}

fn forget_damaged<T>(cache: &Cache, key: Digest, read: Result<T, StoreError>) -> Result<T, StoreError> {
    if let Err(StoreError::Damaged { .. }) = &read {
        cache.forget(key);
    }
    read
}
