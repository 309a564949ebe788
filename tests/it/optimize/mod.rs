//! The optimisers seen from outside: what every method promises, known functions, other implementations.

mod conformance;
mod constrained;
mod functions;
mod kinks;
mod reference;

use gearstudy::base::error::Failure;
use gearstudy::base::record::Value;
use gearstudy::base::seed::Seed;
use gearstudy::optimize::bounds::Bounds;
use gearstudy::optimize::search::Optimizer;
use gearstudy::optimize::{METHODS, optimizer};

use crate::support::record;

/// A method with some parameters set, on a box.
fn search(method: &str, given: &[(&str, Value)], bounds: &[(f64, f64)], seed: u64) -> Optimizer {
    let fields = METHODS.iter().find(|entry| entry.member.name == method).unwrap().member.fields;
    let bounds = Bounds::new(bounds.to_vec()).unwrap();
    optimizer(method, &record(fields, given), bounds, Seed::of_stage(seed, "optimum")).unwrap()
}

/// Runs a search to its end on one thread.
fn run(mut search: Optimizer, function: impl Fn(&[f64]) -> f64) -> Optimizer {
    search.run(|points| Ok::<_, Failure>(points.iter().map(|point| function(point)).collect())).unwrap();
    search
}

fn integer(value: i64) -> Value {
    Value::Integer(value)
}

fn choice(value: &'static str) -> Value {
    Value::Choice(value)
}
