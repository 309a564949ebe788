//! What the optimisers cost themselves, on an objective that costs next to nothing.

use criterion::{Criterion, criterion_group};

use crate::brief;
use gearmesh::optimize::{self, Method, sobol::Sobol};
use gearmesh::prelude::*;

criterion_group!(name = benches; config = brief(); targets = methods);

fn methods(criterion: &mut Criterion) {
    let bench = |criterion: &mut Criterion, name: &str, method: &dyn Method| {
        criterion.bench_function(name, |bencher| {
            bencher.iter(|| {
                let bounds =
                    Bounds::new(vec![(0.0, 8e-6), (0.0, 6e-3), (0.0, 8e-6)]).expect("the bounds are ascending");
                let seed = Seed::of_stage(7, "optimum");
                let mut search = optimize::search(method, bounds, seed).expect("it fits three variables");
                search.run(|points| Ok::<_, Failure>(points.iter().map(|point| objective(point)).collect()))
            });
        });
    };
    let evolution = DifferentialEvolution { population: 60, generations: 200, tolerance: 0.0, ..<_>::default() };
    bench(criterion, "optimize/genetic 100x100", &Genetic::default());
    bench(criterion, "optimize/differential_evolution 60x200", &evolution);
    bench(criterion, "optimize/nelder_mead", &NelderMead::default());
    bench(criterion, "optimize/sobol 65536", &Sobol { points: 65_536 });
}

/// A bowl in lengths like those of a tooth modification, above 0.
fn objective(point: &[f64]) -> f64 {
    let at = |axis: usize, lowest: f64, scale: f64| ((point[axis] - lowest) / scale).powi(2);
    0.25 + at(0, 6.93e-6, 8e-6) + at(1, 3.41e-3, 6e-3) + at(2, 5.67e-6, 8e-6)
}
