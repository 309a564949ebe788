//! The optimisers seen from outside: what every method promises, known functions, other implementations.

mod conformance;
mod constrained;
mod functions;
mod kinks;
mod reference;

use declare::declared::record_of;
use declare::error::Failure;
use declare::record::Value;
use declare::seed::Seed;
use gearmesh::optimize;
use gearmesh::optimize::bounds::Bounds;
use gearmesh::optimize::search::Optimizer;
use gearmesh::optimize::{METHODS, Method};

/// A method with some parameters set, on a box.
fn search(method: &str, given: &[(&str, Value)], bounds: &[(f64, f64)], seed: u64) -> Optimizer {
    let bounds = Bounds::new(bounds.to_vec()).unwrap();
    optimize::search(&*with(method, given), bounds, Seed::of_stage(seed, "optimum")).unwrap()
}

fn with(method: &str, given: &[(&str, Value)]) -> Box<dyn Method> {
    let fields = METHODS.iter().find(|entry| entry.member.name == method).unwrap().member.fields;
    optimize::read(method, &record_of(fields, given)).unwrap()
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
