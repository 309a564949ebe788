//! Second method: SciPy's Nelder–Mead step for step, its differential evolution and an independent genetic algorithm by
//! their statistics, its Sobol points. The values come from `reference.py`.

use serde_json::Value as Json;

use super::{integer, run, search};
use crate::optimize::search::Optimizer;
use declare::record::Value;

fn reference(part: &str) -> Vec<Json> {
    let all: Json = serde_json::from_str(include_str!("reference.json")).unwrap();
    all[part].as_array().unwrap().clone()
}

fn number(row: &Json, name: &str) -> f64 {
    row[name].as_f64().unwrap_or_else(|| panic!("no number `{name}` in {row}"))
}

/// The functions of the script, with the same operations in the same order.
fn function(name: &str) -> fn(&[f64]) -> f64 {
    match name {
        "rosenbrock" => |x| {
            let y: Vec<f64> = x.iter().map(|t| -2.0 * (1.0 - t) + 2.0 * t).collect();
            let mut total = 0.0;
            for pair in y.windows(2) {
                let (a, b) = (pair[0], pair[1]);
                total += 100.0 * ((b - a * a) * (b - a * a)) + (1.0 - a) * (1.0 - a);
            }
            total
        },
        "slope" => |x| {
            let mut total = 0.0;
            for (k, t) in x.iter().enumerate() {
                total += (k as f64 + 1.0) * t + (t - 0.3) * (t - 0.3);
            }
            total
        },
        "corners" => |x| {
            let mut total = 0.0;
            for (k, t) in x.iter().enumerate() {
                total += (k as f64 + 1.0) * (t - 0.7).abs();
            }
            total
        },
        "bent" => |x| {
            let mut total = 0.0;
            for (k, t) in x.iter().enumerate() {
                let (weight, next) = (k as f64 + 1.0, x[(k + 1) % x.len()]);
                total += weight * (t - 0.2 * weight).powi(2) + (t * next - 0.3).powi(2);
            }
            total
        },
        "steps" => |x| x.iter().map(|t| (50.0 * (t - 0.7).abs()).floor()).sum(),
        _ => panic!("no function `{name}`"),
    }
}

#[test]
fn the_simplex_moves_as_scipy_s_does() {
    for row in reference("nelder_mead") {
        let name = row["function"].as_str().unwrap();
        let dimension = row["dimension"].as_u64().unwrap() as usize;
        let given = [("restarts", integer(0)), ("tolerance", Value::Number(1e-8))];
        let found = run(search("nelder_mead", &given, &vec![(0.0, 1.0); dimension], 1), function(name));
        let best = found.best().unwrap();
        assert_eq!(found.evaluations() as f64, number(&row, "evaluations"), "{name} in {dimension} variables");
        assert_eq!(best.value.to_bits(), number(&row, "value").to_bits(), "{name} in {dimension} variables");
        for (ours, theirs) in best.point.iter().zip(row["point"].as_array().unwrap()) {
            assert_eq!(ours.to_bits(), theirs.as_f64().unwrap().to_bits(), "{name} in {dimension} variables");
        }
    }
}

/// SciPy's line search looks at the whole line and comes near a bound only to its tolerance, so only the ends are compared.
#[test]
fn powell_s_method_ends_where_scipy_s_does() {
    for row in reference("powell") {
        let name = row["function"].as_str().unwrap();
        let dimension = row["dimension"].as_u64().unwrap() as usize;
        let found = run(search("powell", &[], &vec![(0.0, 1.0); dimension], 1), function(name));
        let best = found.best().unwrap();
        println!("{name} {dimension}: {} evaluations, SciPy {}", found.evaluations(), row["evaluations"]);
        assert!((best.value - number(&row, "value")).abs() < 1e-7, "{name} in {dimension}: {:e}", best.value);
        for (ours, theirs) in best.point.iter().zip(row["point"].as_array().unwrap()) {
            assert!((ours - theirs.as_f64().unwrap()).abs() < 1e-7, "{name} in {dimension} variables: {ours}");
        }
        assert!(found.evaluations() as f64 <= 2.0 * number(&row, "evaluations"), "{name} in {dimension} variables");
    }
}

#[test]
fn differential_evolution_takes_as_many_generations_as_scipy_s() {
    for row in reference("differential_evolution") {
        let name = row["function"].as_str().unwrap();
        let dimension = row["dimension"].as_u64().unwrap() as usize;
        let target = number(&row, "target");
        let given = [
            ("population", integer(row["population"].as_i64().unwrap())),
            ("generations", integer(2000)),
            ("tolerance", Value::Number(0.0)),
        ];
        let counts: Vec<f64> = (0..101)
            .map(|seed| {
                let found =
                    run(search("differential_evolution", &given, &vec![(0.0, 1.0); dimension], seed), function(name));
                let reached = found.history().iter().position(|row| row.best_so_far < target);
                // The script does not count the first population.
                reached.expect("the target is reached") as f64
            })
            .collect();
        assert_same_mean(&counts, &row);
    }
}

#[test]
fn the_genetic_algorithm_converges_as_an_independent_one_does() {
    let bowl = |x: &[f64]| 0.1 + (x[0] - 0.3).powi(2) + (x[1] - 0.62).powi(2) + (x[2] - 0.81).powi(2);
    let found: Vec<Optimizer> =
        (0..100).map(|seed| run(search("genetic", &[("bits", integer(10))], &[(0.0, 1.0); 3], seed), bowl)).collect();
    for row in reference("genetic") {
        let at = row["generation"].as_u64().unwrap() as usize - 1;
        let so_far = row["of"] == "best_so_far";
        let excess: Vec<f64> = found
            .iter()
            .map(|search| {
                let generation = search.history()[at];
                ((if so_far { generation.best_so_far } else { generation.best }) - 0.1).ln()
            })
            .collect();
        assert_same_mean(&excess, &row);
    }
}

/// Two samples of one distribution differ in their means by more than 3.5 standard errors once in two thousand times.
fn assert_same_mean(values: &[f64], row: &Json) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
    let error = (variance / count + number(row, "deviation").powi(2) / number(row, "runs")).sqrt();
    let difference = mean - number(row, "mean");
    println!("{mean} ± {}, {:.2} standard errors from {row}", variance.sqrt(), difference / error);
    assert!(
        difference.abs() < 3.5 * error,
        "{mean} ± {}: {:.2} standard errors from {row}",
        variance.sqrt(),
        difference / error
    );
}

#[test]
fn sobol_points_are_those_of_joe_and_kuo() {
    let mut met = Vec::new();
    let mut points = search("sobol", &[("points", integer(64))], &[(0.0, 1.0); 16], 1);
    points
        .run(|batch| {
            met.extend_from_slice(batch);
            Ok::<_, declare::error::Failure>(vec![0.0; batch.len()])
        })
        .unwrap();
    let expected = reference("sobol");
    assert_eq!(met.len(), expected.len());
    for (ours, theirs) in met.iter().zip(expected) {
        let theirs: Vec<f64> = theirs.as_array().unwrap().iter().map(|whole| whole.as_f64().unwrap() / 64.0).collect();
        assert_eq!(*ours, theirs);
    }
}
