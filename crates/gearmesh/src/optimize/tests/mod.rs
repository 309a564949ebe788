//! The optimisers seen from outside: what every method promises, known functions, other implementations.

#![allow(clippy::float_cmp, reason = "tests say where a value must be met exactly")]
#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the numbers are the tests' own")]

mod conformance;
mod constrained;
mod estimates;
mod fronts;
mod functions;
mod kinks;
mod reference;

use declare::declared::{Declared, record_of};
use declare::error::Failure;
use declare::record::Value;
use declare::seed::Seed;

use super::bounds::Bounds;
use super::genetic::{Genetic, Selection};
use super::search::Optimizer;
use super::{METHODS, Method, optimizer, read};

/// A method with some parameters set, on a box.
fn search(method: &str, given: &[(&str, Value)], bounds: &[(f64, f64)], seed: u64) -> Optimizer {
    let bounds = Bounds::new(bounds.to_vec()).unwrap();
    super::search(&*with(method, given), bounds, Seed::of_stage(seed, "optimum")).unwrap()
}

fn with(method: &str, given: &[(&str, Value)]) -> Box<dyn Method> {
    let fields = METHODS.iter().find(|entry| entry.member.name == method).unwrap().member.fields;
    read(method, &record_of(fields, given)).unwrap()
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

/// What a study would read, and what somebody writes in Rust, are one search.
#[test]
fn a_method_can_be_made_without_a_study() {
    let settings = Genetic { population: 20, generations: 5, selection: Selection::Tournament, ..Genetic::default() };
    let seed = || Seed::of_stage(7, "optimum");
    let bounds = || Bounds::new(vec![(-1.0, 2.0)]).unwrap();
    let best = |mut search: Optimizer| {
        search.run(|points| Ok::<_, Failure>(points.iter().map(|point| point[0] * point[0]).collect())).unwrap();
        search.best().cloned()
    };
    let read = read("genetic", &settings.record()).unwrap();
    let typed = best(optimizer(&settings, bounds(), seed()).unwrap());
    assert!(typed.is_some() && typed == best(super::search(&*read, bounds(), seed()).unwrap()));
    let wrong = Genetic { crossover: 1.5, ..settings.clone() };
    assert!(optimizer(&wrong, bounds(), seed()).is_err_and(|error| error.message == "`crossover` is 1.5"));
    let elite = Genetic { elite: 20, ..settings };
    assert!(optimizer(&elite, bounds(), seed()).is_err_and(|error| error.field == Some("elite")));
}

#[test]
fn every_method_and_its_record_say_the_same() {
    for method in METHODS {
        let record = record_of(method.member.fields, &[]);
        assert!((method.read)(&record).foresee(3).is_ok(), "{}", method.member.name);
    }
}
