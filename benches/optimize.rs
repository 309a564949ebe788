//! What the optimisers cost themselves, on an objective that costs next to nothing.

use criterion::{Criterion, criterion_group};

use crate::brief;
use declare::declared::record_of;
use declare::error::Failure;
use declare::record::Value;
use declare::seed::Seed;
use gearmesh::optimize::bounds::Bounds;
use gearmesh::optimize::{self, METHODS};

criterion_group!(name = benches; config = brief(); targets = methods);

fn methods(criterion: &mut Criterion) {
    let bench = |criterion: &mut Criterion, name: &str, method: &str, given: &[(&str, Value)]| {
        let fields =
            METHODS.iter().find(|entry| entry.member.name == method).map_or(&[][..], |entry| entry.member.fields);
        let method = optimize::read(method, &record_of(fields, given)).expect("the method is registered");
        criterion.bench_function(name, |bencher| {
            bencher.iter(|| {
                let bounds =
                    Bounds::new(vec![(0.0, 8e-6), (0.0, 6e-3), (0.0, 8e-6)]).expect("the bounds are ascending");
                let seed = Seed::of_stage(7, "optimum");
                let mut search = optimize::search(&*method, bounds, seed).expect("it fits three variables");
                search.run(|points| Ok::<_, Failure>(points.iter().map(|point| objective(point)).collect()))
            });
        });
    };
    let evolution =
        [("population", Value::Integer(60)), ("generations", Value::Integer(200)), ("tolerance", Value::Number(0.0))];
    bench(criterion, "optimize/genetic 100x100", "genetic", &[]);
    bench(criterion, "optimize/differential_evolution 60x200", "differential_evolution", &evolution);
    bench(criterion, "optimize/nelder_mead", "nelder_mead", &[]);
    bench(criterion, "optimize/sobol 65536", "sobol", &[("points", Value::Integer(65_536))]);
}

/// A bowl in lengths like those of a tooth modification, above 0.
fn objective(point: &[f64]) -> f64 {
    let at = |axis: usize, lowest: f64, scale: f64| ((point[axis] - lowest) / scale).powi(2);
    0.25 + at(0, 6.93e-6, 8e-6) + at(1, 3.41e-3, 6e-3) + at(2, 5.67e-6, 8e-6)
}
