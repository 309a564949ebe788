//! Fronts of several objectives beside those of another implementation, pymoo's, run here.

#[path = "../../crates/gearmesh/src/optimize/tests/fronts/problems.rs"]
mod problems;

use serde_json::{Value, json};

use self::problems::{Problem, problems};
use crate::python;
use declare::error::Failure;
use declare::seed::Seed;
use gearmesh::optimize::bounds::Bounds;
use gearmesh::optimize::constraints::Evaluation;
use gearmesh::optimize::hypervolume::hypervolume;
use gearmesh::optimize::latin_hypercube;
use gearmesh::optimize::nsga2::Nsga2;
use gearmesh::optimize::optimizer;

const POPULATION: usize = 100;
const GENERATIONS: usize = 200;

fn front(problem: &Problem, seed: u64) -> Vec<Vec<f64>> {
    let settings = Nsga2 { population: POPULATION, generations: GENERATIONS, ..Nsga2::default() };
    let bounds = Bounds::new(problem.bounds.clone()).unwrap();
    let mut search = optimizer(&settings, bounds, Seed::of_stage(seed, "front")).unwrap();
    let evaluate = |x: &Vec<f64>| (problem.function)(x);
    search.run_constrained(|points| Ok::<_, Failure>(points.iter().map(evaluate).collect())).unwrap();
    search.front(POPULATION).into_iter().map(|member| member.evaluation.objectives().collect()).collect()
}

/// The whole front's, from its closed form or many of its points.
fn exact(problem: &Problem) -> f64 {
    let point = |at: u32| (problem.front)(f64::from(at) / 20_000.0);
    problem.exact.unwrap_or_else(|| hypervolume(&(0..=20_000).map(point).collect::<Vec<_>>(), problem.reference))
}

fn told(problem: &Problem) -> Value {
    let bounds = Bounds::new(problem.bounds.clone()).unwrap();
    let drawn = latin_hypercube::points(40, problem.bounds.len(), &mut Seed::of_stage(1, "probes").generator(0));
    let probes: Vec<Value> = drawn
        .iter()
        .map(|unit| {
            let point = bounds.point(unit);
            let evaluation = (problem.function)(&point);
            let objectives: Vec<f64> = evaluation.objectives().collect();
            json!({ "point": point, "objectives": objectives, "constraints": evaluation.constraints })
        })
        .collect();
    let fronts = [1].map(|seed| front(problem, seed));
    let hypervolumes = fronts.each_ref().map(|front| hypervolume(front, problem.reference));
    json!({
        "name": problem.name,
        "bounds": problem.bounds,
        "reference": problem.reference,
        "exact": exact(problem),
        "probes": probes,
        "fronts": fronts,
        "hypervolumes": hypervolumes,
    })
}

/// Tier: second implementation. As many generations of as many individuals, problems and hypervolume pymoo's own.
#[test]
fn fronts_are_as_good_as_pymoo_s() {
    let problems: Vec<Value> = problems().iter().map(told).collect();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("fronts.json");
    let all = json!({ "population": POPULATION, "generations": GENERATIONS, "problems": problems });
    std::fs::write(&file, all.to_string()).unwrap();
    if let Some(said) = python::run("fronts.py", &[file.as_os_str()]) {
        println!("{said}");
    }
}
