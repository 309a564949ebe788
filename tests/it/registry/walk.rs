//! A runner of a dozen lines, without cache, threads or demand from downstream: the second method for what the real one
//! does, and a way to see single stages.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

use declare::seed::Seed;
use declare::work::Tally;
use gearstudy::program;
use gearstudy::stage::{Context, Demand, Inputs, Stage};
use studygraph::stage::estimate::{Ahead, Certainty, RowCount};
use studygraph::study::Study;
use studygraph::table::data::Table;
use studygraph::warning;

/// All tables of a stage, in its own order, and what it warned of.
pub struct Ran {
    pub tables: Vec<Table>,
    pub warnings: Vec<String>,
}

pub fn load(text: &str) -> Study {
    program::load_text(text, Path::new("t.yaml")).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Everything the stage can give, or only what is not on demand.
pub fn demand(stage: &dyn Stage, everything: bool) -> Demand {
    let schemas = stage.outputs().into_iter().filter(|schema| everything || !schema.on_demand);
    let columns = |columns: &[studygraph::table::schema::Column]| -> BTreeSet<String> {
        columns.iter().filter(|column| everything && column.on_demand).map(|column| column.name.clone()).collect()
    };
    Demand { tables: schemas.map(|schema| (schema.name.clone(), columns(&schema.columns))).collect() }
}

/// Runs the stages of a study one after the other, each with all that the ones before it can give.
pub fn walk(study: &Study) -> BTreeMap<String, Ran> {
    let mut done: BTreeMap<String, Ran> = BTreeMap::new();
    while done.len() < study.nodes.len() {
        let before = done.len();
        for node in &study.nodes {
            let sources = sources(study, node.stage.as_ref());
            if done.contains_key(&node.name) || !sources.values().all(|stage| done.contains_key(stage)) {
                continue;
            }
            let mut inputs = Inputs::default();
            for (port, stage) in &sources {
                inputs.ports.insert(port.clone(), done[stage].tables.iter().collect());
            }
            let stage = node.stage.as_ref();
            let (least, mut most) = (demand(stage, false), demand(stage, true));
            without_what_lacks(stage, &inputs, &mut most);
            if least != most {
                run(study.seed, &node.name, stage, &inputs, &least);
            }
            let ran = run(study.seed, &node.name, stage, &inputs, &most);
            done.insert(node.name.clone(), ran);
        }
        assert!(done.len() > before, "nothing can go on");
    }
    done
}

/// Takes out the columns for which a port is read whose tables are not there.
fn without_what_lacks(stage: &dyn Stage, inputs: &Inputs, demand: &mut Demand) {
    for port in stage.inputs() {
        let there = |table: &str| inputs.ports[&port.name].iter().any(|known| known.name() == table);
        if port.wants.iter().all(|want| there(&want.table)) {
            continue;
        }
        for (table, column) in port.only_for {
            demand.tables.get_mut(*table).map(|columns| columns.remove(*column));
        }
    }
}

/// The stage behind each port.
fn sources(study: &Study, stage: &dyn Stage) -> BTreeMap<String, String> {
    let resolve = |name: &str, through: Option<&str>| {
        let Some(through) = through else { return name.to_owned() };
        let middle = study.nodes.iter().find(|node| node.name == name).unwrap();
        middle.stage.inputs().into_iter().find(|port| port.name == through).unwrap().stage
    };
    stage.inputs().into_iter().map(|port| (port.name.clone(), resolve(&port.stage, port.through))).collect()
}

/// Holds a stage to the rows that it foresaw: exact, a bound, or right to a factor of two and a half.
fn foreseen(name: &str, stage: &dyn Stage, demand: &Demand, inputs: &Inputs, tables: &[Table]) {
    let mut ahead = Ahead::default();
    for (port, tables) in &inputs.ports {
        for table in tables {
            ahead.know(port, table.name(), RowCount::exact(table.rows()));
        }
    }
    let estimate = stage.estimate(demand, &ahead);
    assert_eq!(estimate.tables.len(), tables.len(), "`{name}` foresees other tables than it gives");
    for table in tables {
        let rows = estimate.of_table(table.name()).unwrap();
        let (said, given) = (rows.count as f64, table.rows() as f64);
        let kept = match rows.certainty {
            Certainty::Exact => rows.index() == table.rows(),
            Certainty::AtMost => said >= given,
            Certainty::About => (said + 20.0) * 2.5 >= given && said <= 2.5 * (given + 20.0),
        };
        assert!(kept, "`{name}.{}` has {given} rows, foreseen were {rows:?}", table.name());
    }
}

/// Runs one stage, and holds it to giving exactly what it was asked for.
fn run(seed: u64, name: &str, stage: &dyn Stage, inputs: &Inputs, demand: &Demand) -> Ran {
    let (stop, warnings) = (AtomicBool::new(false), Mutex::new(Vec::new()));
    let last = Mutex::new(0.0);
    let progress = |share: f64| {
        assert!((0.0..=1.0).contains(&share), "`{name}` is done to {share}");
        *last.lock().unwrap() = share;
    };
    let context = Context {
        seed: Seed::of_stage(seed, name),
        demand,
        stop: &stop,
        progress: &progress,
        warn: &|text| warnings.lock().unwrap().push(text),
        is_heard: true,
        work: &Tally::default(),
    };
    let tables = stage.run(&context, inputs).unwrap_or_else(|failure| panic!("`{name}`: {failure}"));
    let wanted: Vec<_> = stage.outputs().into_iter().filter(|schema| demand.table(&schema.name)).collect();
    let wanted: Vec<_> = wanted.into_iter().map(|schema| demand.narrowed(schema)).collect();
    let given: Vec<_> = tables.iter().map(|table| table.schema().clone()).collect();
    assert_eq!(given, wanted, "`{name}` gives other tables than it was asked for");
    foreseen(name, stage, demand, inputs, &tables);
    let warnings = warning::sentences(warnings.into_inner().unwrap());
    Ran { tables, warnings }
}
