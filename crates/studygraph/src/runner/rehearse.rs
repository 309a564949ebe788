//! What can be known to be wrong with a study before it is run: its quick stages are computed, and nothing is kept.
//!
//! A relief that is longer than the flank is a mistake of the study, but only the tables of the pair show it. So stages that
//! take next to no time are computed in memory, and the others are asked what they refuse of those tables. Must not know:
//! the cache, results, kinds.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::graph::{Graph, Input};
use super::work::{demanded, seen};
use crate::stage::{Ahead, Context, Inputs, RowCount};
use crate::study::{Node, Study};
use crate::table::data::Table;
use crate::threads;
use declare::error::{Diagnostic, Failure, Place};
use declare::seed::Seed;
use declare::work::Tally;

/// Seconds that a stage may take, and all of them together, as they are estimated.
const OF_STAGE: f64 = 0.1;
const OF_ALL: f64 = 1.0;

/// Tables by node and name.
type Known = BTreeMap<(usize, String), Arc<Table>>;

/// Everything that quick stages, and those that read from them, find wrong.
///
/// # Errors
/// As [`Graph::new`].
pub fn rehearse(study: &Study) -> Result<Vec<Diagnostic>, Diagnostic> {
    threads::with_all(|| computed(study))
}

fn computed(study: &Study) -> Result<Vec<Diagnostic>, Diagnostic> {
    let graph = Graph::new(study, &[])?;
    let (mut known, mut wrong, mut left) = (Known::new(), Vec::new(), OF_ALL);
    for &node in &graph.order {
        let of_study = &study.nodes[node];
        let mut ports = BTreeMap::new();
        for input in &graph.inputs[node] {
            if let Some(tables) = tables_of(&known, input) {
                ports.insert(input.port.clone(), tables);
            }
        }
        let is_whole = ports.len() == graph.inputs[node].len();
        let mut ahead = Ahead::default();
        for (input, table) in ports.iter().flat_map(|(port, tables)| tables.iter().map(move |table| (port, table))) {
            ahead.know(input, table.name(), RowCount::exact(table.rows()));
        }
        let inputs = Inputs {
            ports: ports
                .iter()
                .map(|(port, tables)| (port.clone(), tables.iter().map(Arc::as_ref).collect()))
                .collect(),
        };
        let seconds = of_study.stage.estimate(&graph.demands[node], &ahead).seconds;
        let result = if is_whole && seconds <= OF_STAGE.min(left) && !of_study.stage.runs_alone() {
            left -= seconds;
            run(study, &graph, node, &inputs)
        } else {
            of_study.stage.refuses(&inputs).map(|()| Vec::new())
        };
        match result {
            Ok(tables) => {
                known.extend(tables.into_iter().map(|table| ((node, table.name().to_owned()), Arc::new(table))));
            }
            Err(Failure::Study(found)) => wrong.extend(found),
            Err(Failure::Failed(message)) => {
                let place = place_of(of_study, &message);
                wrong.push(Diagnostic::new(format!("`{}`: {message}", of_study.name)).at(place));
            }
            Err(Failure::Stopped) => {}
        }
    }
    Ok(wrong)
}

/// The field that a message names, as `slice_coupling: plate`, where the study states it; else the stage.
fn place_of(of_study: &Node, message: &str) -> Place {
    let named = message.split('`').skip(1).step_by(2).map(|word| word.split(':').next().unwrap_or(word));
    let mut stated = named.filter_map(|name| of_study.record.entry(name));
    stated.next().map(|entry| entry.place).filter(|place| *place != Place::default()).unwrap_or(of_study.place)
}

/// What a port reads, where all of it is known.
fn tables_of(known: &Known, input: &Input) -> Option<Vec<Arc<Table>>> {
    let table = |want: &crate::stage::Want| {
        let table = known.get(&(input.node, want.table.clone()))?;
        seen(Arc::clone(table), &want.columns).ok()
    };
    input.wants.iter().map(table).collect()
}

fn run(study: &Study, graph: &Graph, node: usize, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
    let (of_study, demand) = (&study.nodes[node], &graph.demands[node]);
    let context = Context {
        seed: if of_study.stage.uses_seed() {
            Seed::of_stage(study.seed, &of_study.name)
        } else {
            Seed::of_stage(0, "")
        },
        demand,
        stop: &AtomicBool::new(false),
        progress: &|_| (),
        warn: &|_| (),
        is_heard: false,
        work: &Tally::default(),
    };
    let tables = of_study.stage.run(&context, inputs)?;
    // What is a bug of the stage is told when it is run.
    Ok(demanded(&graph.outputs[node], demand, tables).unwrap_or_default())
}
