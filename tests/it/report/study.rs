//! The stage `report` run on the tables, and the manifest of the study they would belong to.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::record::list;
use super::tables::tables;
use declare::declared;
use declare::digest::Digest;
use declare::record::Value;
use declare::seed::Seed;
use declare::work::Tally;
use gearstudy::report::{self, Rendered};
use gearstudy::stage::{self, Context, Demand, Inputs};
use studygraph::store::entry::StoredTable;
use studygraph::store::manifest::{
    KeyRecord, Machine, Manifest, OmissionRecord, Program, Short, Source, StageRecord, TableRecord,
};
use studygraph::table::data::Table;

fn report_tables(published: Vec<Value>, figures: Vec<Value>, tables: &BTreeMap<String, Table>) -> Vec<Table> {
    let kind = stage::kind("report").unwrap();
    let record = declared::record_of(kind.fields, &[("published", list(published)), ("figures", list(figures))]);
    let built = (kind.build)(&record).unwrap();
    let wanted = built.outputs().into_iter().map(|schema| (schema.name, BTreeSet::new())).collect();
    let (demand, stop) = (Demand { tables: wanted }, AtomicBool::new(false));
    let context = Context {
        seed: Seed::of_stage(7, "report"),
        demand: &demand,
        stop: &stop,
        progress: &|_| (),
        warn: &|_| (),
        is_heard: true,
        work: &Tally::default(),
    };
    let mut inputs = Inputs::default();
    for (name, table) in tables {
        inputs.ports.entry(name.split('.').next().unwrap().to_owned()).or_default().push(table);
    }
    built.run(&context, &inputs).unwrap()
}

fn record_of(stage: &str, table: &Table) -> TableRecord {
    TableRecord::new(stage, table.schema(), &StoredTable::describe(table).unwrap())
}

pub fn manifest(tables: &BTreeMap<String, Table>) -> Manifest {
    let start = Short::from(&Digest([0x3d; 32]));
    let stage = |name: &str, kind: &str, status: &str, why: &str, seconds: f64| StageRecord {
        name: name.to_owned(),
        kind: kind.to_owned(),
        version: 1,
        keys: vec![KeyRecord {
            key: Digest([0x8f; 32]),
            config: start,
            fields: Arc::default(),
            axis: None,
            code: start,
            seed: None,
            demand: start,
            inputs: Arc::default(),
        }],
        config: serde_json::Value::Null.into(),
        status: status.to_owned(),
        why: why.to_owned(),
        seconds,
        work: BTreeMap::from([("contact_solves".to_owned(), 3500)]),
        warnings: Vec::new(),
        left_out: Vec::new(),
        tables: tables
            .iter()
            .filter(|(full, _)| full.starts_with(&format!("{name}.")))
            .map(|(_, table)| record_of(name, table))
            .collect(),
    };
    let mut stages = vec![
        stage("pair", "geometry", "hit", "the same as before", 0.000_4),
        stage("stiffness", "stiffness", "hit", "the same as before", 0.001_9),
        stage("optimum", "optimizer", "ran", "config changed: method.population", 0.283),
        stage("ste", "ste", "ran", "input changed: designs", 0.041),
        stage("report", "report", "ran", "input changed: ste", 0.002),
    ];
    stages[1].warnings.push(
        "body compliance: the half tooth angle at the root θ_f = 0.1586 rad is outside the fitted range 0.01 to 0.12 rad".into(),
    );
    stages[1].left_out.push(OmissionRecord {
        what: "slices along the face".into(),
        why: "nothing varies along it: one slice stands for all".into(),
        saved_seconds: Some(0.014),
    });
    stages[3].left_out.push(OmissionRecord {
        what: "contact before A and after E".into(),
        why: "the separation of 3.5 µm at 0.25 mm exceeds the deflection".into(),
        saved_seconds: None,
    });
    Manifest {
        format: 1,
        study: "energy-ga".to_owned(),
        title: "Energy-method stiffness, and tip relief and crowning found by a genetic algorithm".to_owned(),
        seed: 7,
        source: Some(Source { paper: "energy_ga".to_owned(), tables: vec![1, 2], figures: vec![1, 3, 4, 5] }),
        study_digest: "5d".repeat(32),
        program: Program {
            version: "0.1.0".to_owned(),
            code: "c0de".repeat(8),
            commit: Some("524add1f".repeat(5)),
            uncommitted_changes: Some(false),
            rustc: "rustc 1.95.0".to_owned(),
            profile: "release".to_owned(),
            dependencies: String::new(),
        },
        machine: Machine {
            system: "Debian GNU/Linux 12, x86_64".to_owned(),
            processor: "a processor".to_owned(),
            cores: 2,
            threads: 2,
        },
        written: "2026-11-21T05:00:00Z".to_owned(),
        seconds: 0.33,
        stages,
        ..Manifest::default()
    }
}

/// All tables of the study, those of the report among them, and the manifest.
pub fn study(published: Vec<Value>, figures: Vec<Value>) -> (Manifest, BTreeMap<String, Table>) {
    let mut tables = tables();
    for table in report_tables(published, figures, &tables) {
        tables.insert(format!("report.{}", table.name()), table);
    }
    (manifest(&tables), tables)
}

pub fn render(manifest: &Manifest, tables: &BTreeMap<String, Table>) -> Rendered {
    report::render(manifest, &|name| tables.get(name).cloned().map(Arc::new)).unwrap()
}
