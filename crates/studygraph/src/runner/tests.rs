//! Studies of stages that count how often they are run.

mod failures;
mod interrupted;
mod keys;
mod reruns;
mod shards;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use rand_core::Rng;
use rayon::prelude::*;

use super::events::Silent;
use super::execute::execute;
use super::options::Options;
use super::outcome::Outcome;
use super::plan::{Plan, plan};
use crate::about::ABOUT;
use crate::program::{Pictures, Program};
use crate::stage::{Ahead, Context, Demand, Estimate, Inputs, Kind, Port, RowCount, Stage, Want};
use crate::store::cache::Cache;
use crate::study::{Node, Study};
use crate::table::data::{Row, Table};
use crate::table::schema::{Column, Schema};
use declare::error::{Failure, Faults, Place};
use declare::parameter::Field;
use declare::record::{PlacedValue, Record, Value};

/// How often each counter was run.
static COUNTS: Mutex<BTreeMap<String, usize>> = Mutex::new(BTreeMap::new());
/// Makes stages in mode `random` differ from run to run.
static RANDOM: AtomicBool = AtomicBool::new(false);

/// How many stages of a bench are running.
static RUNNING: Mutex<BTreeMap<String, usize>> = Mutex::new(BTreeMap::new());

struct Company(String);

impl Company {
    fn join(bench: &str) -> Self {
        *RUNNING.lock().unwrap().entry(bench.to_owned()).or_default() += 1;
        Self(bench.to_owned())
    }

    fn size(&self) -> usize {
        RUNNING.lock().unwrap()[&self.0]
    }
}

impl Drop for Company {
    fn drop(&mut self) {
        if let Some(count) = RUNNING.lock().unwrap().get_mut(&self.0) {
            *count -= 1;
        }
    }
}

const fn axis(chunk: usize) -> Field {
    Field::number("torque", 0.0, 1e9, "").axis(chunk).example("3")
}

const fn kind(name: &'static str, fields: &'static [Field]) -> Kind {
    Kind { name, version: 1, summary: "", fields, curves: &[], example: "", build }
}

static PLAIN: Kind = kind("plain", &[]);
static CUT: Kind = kind("cut", &[axis(1)]);
static CUT_BY_FOUR: Kind = kind("cut_by_four", &[axis(4)]);

#[allow(clippy::unnecessary_wraps)] // the type of `Kind::build`
fn build(record: &Record) -> Result<Box<dyn Stage>, Faults> {
    Ok(Box::new(Probe { record: record.clone() }))
}

/// A stage that does as its record says; its value is its own plus those of its inputs.
struct Probe {
    record: Record,
}

impl Probe {
    fn mode(&self) -> &str {
        self.record.text("mode")
    }

    fn wants(&self) -> Vec<Want> {
        let columns = self.record.maybe_text("column").into_iter().map(str::to_owned).collect();
        vec![Want { table: self.record.maybe_text("table").unwrap_or("values").to_owned(), columns }]
    }
}

impl Stage for Probe {
    fn inputs(&self) -> Vec<Port> {
        let names = self.record.maybe_list("of").unwrap_or_default();
        let ports = names.iter().enumerate().map(|(index, entry)| {
            let Value::Reference(stage) = &entry.value else { unreachable!() };
            let port = Port {
                name: format!("of{index}"),
                stage: stage.clone(),
                through: None,
                wants: self.wants(),
                only_for: if self.mode() == "for_extra" { &[("values", "extra")] } else { &[] },
            };
            if self.mode() == "through" { port.through("of0") } else { port }
        });
        ports.collect()
    }

    fn outputs(&self) -> Vec<Schema> {
        let values = vec![
            Column::float("torque", "N m", "").key(),
            Column::float("value", "um", ""),
            Column::float("extra", "um", "").on_demand(),
            Column::float("seconds", "s", "").volatile(),
        ];
        let detail = vec![Column::float("torque", "N m", "").key(), Column::float("value", "um", "")];
        vec![Schema::new("values", "", values), Schema::new("detail", "", detail).on_demand()]
    }

    fn estimate(&self, demand: &Demand, _ahead: &Ahead) -> Estimate {
        let rows = RowCount::exact(self.record.maybe_axis("torque").map_or(1, <[f64]>::len));
        let mut all =
            self.outputs().into_iter().fold(Estimate::new(false), |all, schema| all.rows(demand, schema, rows));
        all.seconds += if self.mode() == "heavy" { 10.0 } else { 0.0 };
        // Later values take longer.
        all.seconds +=
            if self.mode() == "uneven" { self.record.maybe_axis("torque").unwrap_or(&[]).iter().sum() } else { 0.0 };
        all
    }

    fn uses_seed(&self) -> bool {
        self.mode() == "seeded"
    }

    fn runs_alone(&self) -> bool {
        self.mode() == "alone"
    }

    fn run(&self, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let folder = self.record.text("counter").rsplit_once('/').map_or("", |(folder, _)| folder).to_owned();
        let company = Company::join(&folder);
        *COUNTS.lock().unwrap().entry(self.record.text("counter").to_owned()).or_default() += 1;
        let mut value = self.record.number("value");
        for tables in inputs.ports.values() {
            for table in tables {
                value += table.floats("value").iter().sum::<f64>();
                assert_eq!(table.column("extra").is_some(), self.record.maybe_text("column").is_some());
            }
        }
        match self.mode() {
            "fail" => return Err(Failure::new("3 teeth are too few")),
            "panic" => panic!("index out of range"),
            "coarse" => value = value.floor(),
            "random" => value += if RANDOM.fetch_xor(true, Ordering::Relaxed) { 1.0 } else { 0.0 },
            "counted" => value += f64::from(u32::try_from(count(self.record.text("counter"))).unwrap()),
            "seeded" => value += f64::from(context.seed.generator(0).next_u32()),
            "ignores_seed" => value += f64::from(context.seed.generator(1).next_u32()),
            "warn" => (context.warn)("outside its range".to_owned().into()),
            "slow" => std::thread::sleep(Duration::from_millis(20)),
            "alone" => {
                for _ in 0..10 {
                    assert_eq!(company.size(), 1, "somebody else runs");
                    std::thread::sleep(Duration::from_millis(2));
                }
            }
            "until_stopped" => {
                while context.check_stop().is_ok() {
                    std::thread::sleep(Duration::from_millis(1));
                }
                return Err(Failure::Stopped);
            }
            "parallel" => {
                let terms: Vec<f64> = (1..2000_u32).into_par_iter().map(|n| libm::sin(f64::from(n) + value)).collect();
                value = terms.iter().sum();
            }
            _ => {}
        }
        let torques = self.record.maybe_axis("torque").unwrap_or(&[0.0]);
        let extra = context.demand.column("values", "extra");
        let seconds = f64::from(u32::try_from(count(self.record.text("counter"))).unwrap());
        let rows = torques.iter().map(|&torque| -> Row {
            let value = value + torque;
            let extra = extra.then(|| (2.0 * value).into());
            [torque.into(), value.into()].into_iter().chain(extra).chain([seconds.into()]).collect()
        });
        let [values, detail] = self.outputs().try_into().unwrap();
        let mut tables = vec![Table::from_rows(context.demand.narrowed(values), rows.collect()).unwrap()];
        if context.demand.table("detail") {
            let rows = torques.iter().map(|&torque| vec![torque.into(), (value - torque).into()]);
            tables.push(Table::from_rows(detail, rows.collect()).unwrap());
        }
        Ok(tables)
    }
}

fn count(counter: &str) -> usize {
    COUNTS.lock().unwrap().get(counter).copied().unwrap_or(0)
}

/// A stage to be.
#[derive(Clone)]
struct Spec {
    name: &'static str,
    kind: &'static Kind,
    fields: Vec<(&'static str, Value)>,
}

fn stage(name: &'static str, value: f64) -> Spec {
    let fields = vec![("value", Value::Number(value)), ("mode", Value::Text(String::new()))];
    Spec { name, kind: &PLAIN, fields }
}

impl Spec {
    fn with(mut self, name: &'static str, value: Value) -> Self {
        self.fields.retain(|(field, _)| *field != name);
        self.fields.push((name, value));
        self
    }

    fn mode(self, mode: &str) -> Self {
        self.with("mode", Value::Text(mode.to_owned()))
    }

    fn of(self, stages: &[&str]) -> Self {
        let entry = |name: &&str| PlacedValue { value: Value::Reference((*name).to_owned()), place: Place::default() };
        self.with("of", Value::List(stages.iter().map(entry).collect()))
    }

    fn cut(mut self, kind: &'static Kind, torques: &[f64]) -> Self {
        self.kind = kind;
        self.with("torque", Value::Axis(torques.to_vec()))
    }

    fn text(self, field: &'static str, text: &str) -> Self {
        self.with(field, Value::Text(text.to_owned()))
    }
}

static PROGRAM: Program = Program {
    kinds: &[],
    foreign: &[],
    derived: &[],
    named: &[],
    code_of: |_| String::from("code"),
    counters: &[],
    about: ABOUT,
    pictures: Pictures::NONE,
};
static OTHER: Program = Program {
    kinds: &[],
    foreign: &[],
    derived: &[],
    named: &[],
    code_of: |_| String::from("other code"),
    counters: &[],
    about: ABOUT,
    pictures: Pictures::NONE,
};

/// A folder with a cache, and the studies run on it.
struct Bench {
    folder: tempfile::TempDir,
    seed: u64,
    program: &'static Program,
    options: Options,
    /// What the stages had counted before the last run.
    before: BTreeMap<String, usize>,
}

impl Bench {
    fn new() -> Self {
        let options = Options { jobs: 2, ..Options::default() };
        Self { folder: tempfile::tempdir().unwrap(), seed: 1, program: &PROGRAM, options, before: BTreeMap::new() }
    }

    fn root(&self) -> PathBuf {
        self.folder.path().join("cache")
    }

    fn cache(&self) -> Cache {
        Cache::open(&self.root()).unwrap()
    }

    /// The counter of a stage keeps its name when the stage is renamed.
    fn counter(&self, name: &str) -> String {
        format!("{}/{}", self.folder.path().display(), name.trim_start_matches("renamed_"))
    }

    fn study(&self, specs: &[Spec]) -> Study {
        let node = |spec: &Spec| {
            let spec = spec.clone().text("counter", &self.counter(spec.name));
            let entry = |value| PlacedValue { value, place: Place::default() };
            let fields = spec.fields.into_iter().map(|(name, value)| (name, entry(value))).collect();
            let record = Record { fields, place: Place::default() };
            let stage = (spec.kind.build)(&record).unwrap();
            Node { name: spec.name.to_owned(), place: Place::default(), kind: spec.kind, record, stage }
        };
        Study {
            changes: crate::study::Changes::default(),
            tolerances: Vec::new(),
            name: "study".to_owned(),
            title: String::new(),
            source: None,
            seed: self.seed,
            path: self.folder.path().join("study.yaml"),
            text: String::new(),
            nodes: specs.iter().map(node).collect(),
            notes: Vec::new(),
            program: self.program,
        }
    }

    fn plan(&self, specs: &[Spec]) -> Plan {
        plan(&self.study(specs), &self.cache(), &self.options).unwrap()
    }

    /// `stage: action` for every stage, as planned.
    fn planned(&self, specs: &[Spec]) -> Vec<String> {
        let stages = self.plan(specs).stages;
        stages.iter().map(|stage| format!("{}: {}", stage.name, stage.action.phrase())).collect()
    }

    fn run(&mut self, specs: &[Spec]) -> Outcome {
        let study = self.study(specs);
        self.before = specs.iter().map(|spec| (spec.name.to_owned(), count(&self.counter(spec.name)))).collect();
        execute(&study, &self.cache(), &self.options, &Silent, &AtomicBool::new(false)).unwrap()
    }

    /// What the last run computed: `stage` or `stage×n`.
    fn computed(&self) -> Vec<String> {
        let ran = self.before.iter().map(|(name, before)| (name, count(&self.counter(name)) - before));
        ran.filter(|(_, runs)| *runs > 0)
            .map(|(name, runs)| if runs == 1 { name.clone() } else { format!("{name}×{runs}") })
            .collect()
    }
}

/// a → b → d, a → c → d.
fn diamond() -> Vec<Spec> {
    vec![stage("a", 1.0), stage("b", 10.0).of(&["a"]), stage("c", 100.0).of(&["a"]), stage("d", 1000.0).of(&["b", "c"])]
}

/// The values of a table of a stage.
fn values(bench: &Bench, outcome: &Outcome, stage: &str) -> Vec<f64> {
    outcome.table(&bench.cache(), stage, "values").unwrap().floats("value").to_vec()
}
