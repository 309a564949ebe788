//! What samples estimate, against closed forms: means, quantiles and Sobol' indices of the Ishigami function and the
//! g-function; each error against the truth, and how it falls.

use std::f64::consts::PI;

use crate::numeric::indices::{Indices, Pair, indices};
use crate::numeric::replicates::{Estimate, REPLICATES, Sample};
use crate::optimize::by_number::Random;
use crate::optimize::scrambled::Scrambled;
use declare::seed::Seed;

/// sin x₁ + 7 sin² x₂ + 0.1 x₃⁴ sin x₁ over [−π, π]³ (Ishigami and Homma, 1990).
fn ishigami(point: &[f64]) -> f64 {
    let x: Vec<f64> = point.iter().map(|share| PI * (2.0 * share - 1.0)).collect();
    let sine = libm::sin(x[0]);
    sine + 7.0 * libm::sin(x[1]).powi(2) + 0.1 * x[2].powi(4) * sine
}

/// First order and total of each field, and the variance.
fn of_ishigami() -> (Vec<[f64; 2]>, f64) {
    let (a, b, pi4) = (7.0_f64, 0.1, PI.powi(4));
    let [one, two] = [0.5 * (1.0 + b * pi4 / 5.0).powi(2), a * a / 8.0];
    let both = b * b * pi4 * pi4 * 8.0 / 225.0;
    let variance = one + two + both;
    let of = |first: f64, total: f64| [first / variance, total / variance];
    (vec![of(one, one + both), of(two, two), of(0.0, both)], variance)
}

const COEFFICIENTS: [f64; 6] = [0.0, 1.0, 4.5, 9.0, 99.0, 99.0];

/// Sobol's g-function, Π (|4 x − 2| + a)/(1 + a): a kink in every variable.
fn g(point: &[f64]) -> f64 {
    point.iter().zip(COEFFICIENTS).map(|(x, a)| ((4.0 * x - 2.0).abs() + a) / (1.0 + a)).product()
}

fn of_g() -> (Vec<[f64; 2]>, f64) {
    let own: Vec<f64> = COEFFICIENTS.iter().map(|a| 1.0 / (3.0 * (1.0 + a) * (1.0 + a))).collect();
    let all: f64 = own.iter().map(|own| 1.0 + own).product();
    let variance = all - 1.0;
    (own.iter().map(|own| [own / variance, own * all / (1.0 + own) / variance]).collect(), variance)
}

/// Shares of point `number`, of a sample cut into replicates.
type Draw<'a> = &'a dyn Fn(usize, usize) -> Vec<f64>;

fn sobol(number: usize, dimension: usize) -> Vec<f64> {
    let sequence = Scrambled::new(REPLICATES, dimension, &Seed::of_stage(11, "estimates"));
    (0..dimension).map(|at| sequence.coordinate(number % REPLICATES, at, number / REPLICATES)).collect()
}

fn random(number: usize, dimension: usize) -> Vec<f64> {
    let mut point = vec![0.0; dimension];
    Random::new(Seed::of_stage(11, "estimates")).point(number, &mut point);
    point
}

fn sample(function: fn(&[f64]) -> f64, dimension: usize, count: usize, draw: Draw) -> Sample {
    let values: Vec<f64> = (0..count).map(|number| function(&draw(number, dimension))).collect();
    Sample::new(&values)
}

fn found(function: fn(&[f64]) -> f64, fields: usize, count: usize, draw: Draw) -> Vec<Indices> {
    let values: Vec<([f64; 2], Vec<f64>)> = (0..count)
        .map(|number| {
            let point = draw(number, 2 * fields);
            let (a, b) = point.split_at(fields);
            let replaced = |field: usize| {
                let mut mixed = a.to_vec();
                mixed[field] = b[field];
                function(&mixed)
            };
            ([function(a), function(b)], (0..fields).map(replaced).collect())
        })
        .collect();
    let pairs = values.iter().map(|(both, replaced)| Pair { both: *both, replaced });
    let (found, counted) = indices(pairs, fields);
    assert_eq!(counted, count);
    found
}

/// The power with which a number falls over sizes, by least squares of logarithms.
fn order(sizes: &[usize], values: &[f64]) -> f64 {
    let points: Vec<(f64, f64)> =
        sizes.iter().zip(values).map(|(size, value)| (libm::log(*size as f64), libm::log(*value))).collect();
    let count = points.len() as f64;
    let mean = points.iter().fold((0.0, 0.0), |sum, point| (sum.0 + point.0 / count, sum.1 + point.1 / count));
    let both: f64 = points.iter().map(|point| (point.0 - mean.0) * (point.1 - mean.1)).sum();
    both / points.iter().map(|point| (point.0 - mean.0) * (point.0 - mean.0)).sum::<f64>()
}

/// Five of its own errors: of 8 replicates, one in a thousand is farther off.
#[track_caller]
fn within(estimate: Estimate, exact: f64, what: &str) {
    let off = (estimate.value - exact).abs();
    assert!(off <= 5.0 * estimate.error, "{what}: {} ± {} is not {exact}", estimate.value, estimate.error);
}

/// Tier: closed form and order of convergence. The mean of the Ishigami function is 3.5: with scrambled points its error
/// falls with a power beyond −1.2, with independent ones with −1/2.
#[test]
fn the_error_of_a_mean_falls_as_is_promised() {
    let sizes = [256, 1024, 4096, 16_384];
    for (draw, orders, what) in
        [(sobol as fn(usize, usize) -> Vec<f64>, -1.8..=-1.2, "sobol"), (random, -0.62..=-0.38, "random")]
    {
        let means: Vec<Estimate> = sizes.iter().map(|size| sample(ishigami, 3, *size, &draw).mean()).collect();
        for mean in &means {
            within(*mean, 3.5, what);
        }
        let errors: Vec<f64> = means.iter().map(|mean| mean.error).collect();
        let power = order(&sizes, &errors);
        assert!(orders.contains(&power), "{what}: {power} {errors:?}");
    }
}

/// Tier: closed form. The g-function of one variable with a = 0 is uniform over 0 to 2: its quantiles are twice the share.
#[test]
fn quantiles_have_errors_of_their_own_that_fall() {
    let sizes = [256, 1024, 4096, 16_384];
    for share in [0.05, 0.5, 0.95] {
        let found: Vec<Estimate> = sizes.iter().map(|size| sample(g, 1, *size, &sobol).quantile(share)).collect();
        for found in &found {
            within(*found, 2.0 * share, "uniform");
        }
        let power = order(&sizes, &found.iter().map(|found| found.error).collect::<Vec<_>>());
        assert!(power < -0.8, "{share}: {power} {found:?}");
    }
    // Of many variables no closed form is at hand: independent points are the second method.
    let [exact, fine] = [&random as Draw, &sobol].map(|draw| sample(ishigami, 3, 32_768, draw).quantile(0.95));
    assert!((exact.value - fine.value).abs() < 5.0 * (exact.error + fine.error), "{exact:?} {fine:?}");
    assert!(fine.error < 0.5 * exact.error, "{exact:?} {fine:?}");
}

/// Tier: closed form and order of convergence.
#[test]
fn indices_are_those_of_closed_forms_and_their_errors_fall() {
    let sizes = [512, 4096, 32_768];
    for (function, (exact, _), what) in
        [(ishigami as fn(&[f64]) -> f64, of_ishigami(), "Ishigami"), (g, of_g(), "g-function")]
    {
        let mut errors = Vec::new();
        for size in sizes {
            let found = found(function, exact.len(), size, &sobol);
            let mut squares = 0.0;
            for (found, exact) in found.iter().zip(&exact) {
                within(found.first, exact[0], what);
                within(found.total, exact[1], what);
                squares += found.first.error * found.first.error + found.total.error * found.total.error;
            }
            errors.push((squares / (2 * exact.len()) as f64).sqrt());
        }
        let power = order(&sizes, &errors);
        assert!(power < -0.7, "{what}: {power} {errors:?}");
        assert!(errors[2] < 2e-3, "{what}: {errors:?}");
    }
    // The printed ones of the Ishigami function.
    let (exact, variance) = of_ishigami();
    let printed = [[0.3139, 0.5576], [0.4424, 0.4424], [0.0, 0.2437]];
    for (exact, printed) in exact.iter().zip(printed) {
        assert!((exact[0] - printed[0]).abs() < 5e-5 && (exact[1] - printed[1]).abs() < 5e-5);
    }
    assert!((variance - 13.8446).abs() < 5e-5);
}

/// A field that changes nothing has no indices but 0, and where nothing varies there are none.
#[test]
fn what_does_not_vary_has_no_indices() {
    let idle = found(|point| point[0], 2, 256, &sobol);
    assert!(idle[1].first.value.abs() < 1e-15 && idle[1].total.value.abs() < 1e-15);
    assert!((idle[0].total.value - 1.0).abs() < 0.05);
    let constant = found(|_| 7.0, 2, 64, &sobol);
    assert!(constant.iter().all(|indices| indices.first.value.is_nan() && indices.total.error.is_nan()));
}
