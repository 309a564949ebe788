//! Fits with closed forms: a line, bounds, flat directions, several solutions, models with holes and with noise.

use std::convert::Infallible;

use super::uncertainty::{Uncertainty, digits};
use super::*;

type Model<'a> = &'a dyn Fn(&[f64]) -> Option<Vec<f64>>;

/// A fit of what `model` gives, and how many points it asked for.
fn fitted(bounds: &[(f64, f64)], start: &[f64], model: &dyn Fn(&[f64]) -> Option<Vec<f64>>) -> (Option<Fit>, usize) {
    let mut asked = 0;
    let mut evaluate = |points: &[Vec<f64>]| -> Result<Answers, Infallible> {
        asked += points.len();
        for point in points {
            let is_inside = point.iter().zip(bounds).all(|(value, (low, high))| low <= value && value <= high);
            assert!(is_inside, "{point:?} is outside");
        }
        Ok(points.iter().map(|point| model(point)).collect())
    };
    let Ok(noise) = derivative::noise(bounds, start, &mut evaluate);
    let search = Search { bounds: bounds.to_vec(), steps: 200, gain: 1e-14, noise: noise.unwrap_or(0.0) };
    let Ok(fit) = search.from(start, &mut evaluate);
    (fit, asked)
}

/// Tier: closed form; a line through points by least squares: intercept, slope and their deviations (any textbook).
#[test]
fn a_line_has_its_normal_equations() {
    let data = [(1.0, 1.1), (2.0, 1.9), (3.0, 3.2), (4.0, 3.9)];
    let model = |p: &[f64]| Some(data.iter().map(|(x, y)| p[0] + p[1] * x - y).collect());
    let (fit, asked) = fitted(&[(-10.0, 10.0), (-10.0, 10.0)], &[5.0, -3.0], &model);
    let fit = fit.unwrap();
    // x̄ = 2.5, ȳ = 2.525, Sxx = 5, Sxy = 4.85.
    let (slope, intercept) = (0.97, 2.525 - 0.97 * 2.5);
    assert!((fit.point[1] - slope).abs() < 1e-9 && (fit.point[0] - intercept).abs() < 1e-9, "{:?}", fit.point);
    let uncertainty = Uncertainty::of(&fit);
    let found: Vec<f64> = uncertainty.deviations(1.0).collect();
    assert!((found[1] - (1.0_f64 / 5.0).sqrt()).abs() < 1e-7);
    assert!((found[0] - (0.25 + 2.5 * 2.5 / 5.0_f64).sqrt()).abs() < 1e-7);
    // r = −x̄ √(n/Σx²).
    assert!((uncertainty.correlation(0, 1) + 2.5 * (4.0_f64 / 30.0).sqrt()).abs() < 1e-7);
    assert!(uncertainty.rank == 2 && uncertainty.flat.is_none() && fit.freedom() == 2);
    assert!(asked < 60, "{asked}");
}

/// Tier: closed form; where the least lies outside, the parameter is held at its bound and the other is least there.
#[test]
fn a_bound_holds_what_would_go_beyond() {
    let model = |p: &[f64]| Some(vec![p[0] - 3.0, p[0] + p[1] - 1.0, p[1]]);
    for start in [[0.0, 0.0], [1.0, 5.0], [-4.0, -5.0]] {
        let (fit, _) = fitted(&[(-4.0, 1.0), (-5.0, 5.0)], &start, &model);
        let fit = fit.unwrap();
        // With p0 = 1 what is left is p1² + p1², least at 0.
        assert!((fit.point[0] - 1.0).abs() < 1e-12 && fit.point[1].abs() < 1e-8, "{:?}", fit.point);
        assert_eq!(fit.is_held, [true, false]);
        let uncertainty = Uncertainty::of(&fit);
        assert!(uncertainty.covariance[0][0].is_nan() && (uncertainty.covariance[1][1] - 0.5).abs() < 1e-8);
        assert_eq!((uncertainty.free, uncertainty.rank, fit.freedom()), (1, 1, 2));
    }
}

/// Tier: invariant; of two parameters that come in as a sum or a product alone one direction is flat, and no more is claimed.
#[test]
fn what_the_residuals_do_not_determine_is_said() {
    let model = |p: &[f64]| Some(vec![p[0] * p[1] - 6.0, 2.0 * p[0] * p[1] - 12.0, p[2] - 1.0]);
    let bounds = [(0.5, 10.0), (0.5, 10.0), (0.0, 3.0), (0.0, 1.0)];
    let (one, _) = fitted(&bounds, &[1.0, 1.0, 0.0, 0.5], &model);
    let one = one.unwrap();
    assert!((one.point[0] * one.point[1] - 6.0).abs() < 1e-8 && (one.point[2] - 1.0).abs() < 1e-9);
    let found = Uncertainty::of(&one);
    let deviations: Vec<f64> = found.deviations(1.0).collect();
    assert!(deviations[0].is_infinite() && deviations[1].is_infinite() && deviations[3].is_infinite());
    assert!((deviations[2] - 1.0).abs() < 1e-7, "{deviations:?}");
    assert!(found.rank == 2 && found.condition.is_infinite() && found.correlation(0, 1).is_nan());
    assert!(found.flat.is_some());
    // Without the one that comes in nowhere, the direction is along p0/p1.
    let without = |p: &[f64]| Some(vec![p[0] * p[1] - 6.0, 2.0 * p[0] * p[1] - 12.0]);
    let (two, _) = fitted(&bounds[..2], &[1.0, 1.0], &without);
    let two = two.unwrap();
    let flat = Uncertainty::of(&two).flat.unwrap();
    assert!((flat[0] / flat[1] + two.point[0] / two.point[1]).abs() < 1e-6, "{flat:?} at {:?}", two.point);
}

/// Tier: closed form; x² = 2 has two solutions, each from its side, and they are not one.
#[test]
fn two_solutions_are_two() {
    let model = |p: &[f64]| Some(vec![p[0] * p[0] - 2.0]);
    let ends: Vec<Fit> = [-1.0, -0.2, 2.5].iter().map(|at| fitted(&[(-3.0, 3.0)], &[*at], &model).0.unwrap()).collect();
    for (fit, root) in ends.iter().zip([-1.0, -1.0, 1.0]) {
        assert!((fit.point[0] - root * 2.0_f64.sqrt()).abs() < 1e-9, "{:?}", fit.point);
    }
    assert!(ends[0].is_as(&ends[1], 1e-3, &[6.0]) && !ends[0].is_as(&ends[2], 1e-3, &[6.0]));
}

/// A model without numbers on some of the way: they are gone round; without any at the start there is no fit.
#[test]
fn where_the_model_has_no_numbers_nothing_is_taken() {
    let model = |p: &[f64]| (p[0] < 2.0).then(|| vec![p[0] - 1.9]);
    let (fit, _) = fitted(&[(0.0, 5.0)], &[0.1], &model);
    assert!((fit.unwrap().point[0] - 1.9).abs() < 1e-9);
    assert!(fitted(&[(0.0, 5.0)], &[4.0], &model).0.is_none());
}

/// The least sum of squares on a grid of the points at which the model has residuals.
fn least_of_grid(bounds: [(f64, f64); 2], count: usize, model: &dyn Fn(&[f64]) -> Option<Vec<f64>>) -> f64 {
    let value = |(low, high): (f64, f64), at: usize| low + (high - low) * at as f64 / count as f64;
    let sums = (0..=count).flat_map(|one| (0..=count).map(move |two| (one, two)));
    let sums = sums.filter_map(|(one, two)| model(&[value(bounds[0], one), value(bounds[1], two)]));
    sums.map(|residuals| dot(&residuals, &residuals)).fold(f64::INFINITY, f64::min)
}

/// Tier: closed form; where the least is beyond a slanted edge, it is the foot of the perpendicular, from any start. Along the
/// edge the sum of squares falls, which a search that only shortens its steps does not see.
#[test]
fn a_search_goes_along_the_edge_of_what_the_model_admits() {
    // Least at (3, 2), beyond x + 2 y = 4; the foot of the perpendicular is (3, 2) − 0.6 (1, 2).
    let model = |p: &[f64]| (p[0] + 2.0 * p[1] <= 4.0).then(|| vec![10.0 * (p[0] - 3.0), 10.0 * (p[1] - 2.0)]);
    for start in [[0.0, 0.0], [4.0, -4.0], [-4.0, 4.0], [0.1, 1.95], [3.9, 0.0]] {
        let (fit, asked) = fitted(&[(-5.0, 5.0), (-5.0, 5.0)], &start, &model);
        let fit = fit.unwrap();
        assert!(
            (fit.point[0] - 2.4).abs() < 1e-5 && (fit.point[1] - 0.8).abs() < 1e-5,
            "{:?} from {start:?}",
            fit.point
        );
        assert!(fit.end == End::Settled && asked < 2000, "{:?} after {asked}", fit.end);
        assert!(fit.beyond.is_some_and(|beyond| model(&beyond).is_none()), "{start:?}");
        assert!((fit.sum_of_squares - 180.0).abs() < 1e-3, "{}", fit.sum_of_squares);
    }
}

/// Tier: second method, a dense grid; edges that are bent, meet in a corner, or meet a bound.
#[test]
fn the_least_at_an_edge_is_that_of_a_dense_grid() {
    let residuals = |p: &[f64]| vec![p[0] - 1.5, 2.0 * (p[1] - 1.2), 0.5 * p[0] * p[1]];
    let disc = |p: &[f64]| (p[0] * p[0] + p[1] * p[1] <= 1.0).then(|| residuals(p));
    let outside = |p: &[f64]| ((p[0] - 1.5) * (p[0] - 1.5) + (p[1] - 1.0) * (p[1] - 1.0) >= 0.5).then(|| residuals(p));
    let corner = |p: &[f64]| (p[0] <= 0.5 && p[0] + p[1] <= 1.0).then(|| residuals(p));
    let wedge = |p: &[f64]| (2.0 * p[0] + p[1] <= 1.0 && p[0] + 2.0 * p[1] <= 1.0).then(|| residuals(p));
    let to_bound = |p: &[f64]| (p[0] + 3.0 * p[1] <= 1.0).then(|| vec![p[0] + 3.0, p[1] - 3.0]);
    let bounds = [(-2.0, 2.0), (-2.0, 2.0)];
    let models: [(&str, Model); 5] =
        [("disc", &disc), ("outside", &outside), ("corner", &corner), ("wedge", &wedge), ("bound", &to_bound)];
    for (name, model) in models {
        let least = least_of_grid(bounds, 800, model);
        for start in [[0.0, 0.0], [-0.9, 0.1], [0.2, -0.9]] {
            let fit = fitted(&bounds, &start, model).0.unwrap();
            assert!(model(&fit.point).is_some());
            // Around a hole there are two ways, of which one ends higher.
            let is_least = name == "outside" || fit.sum_of_squares <= least + 1e-4;
            assert!(is_least, "{name} from {start:?}: {} at {:?}, not {least}", fit.sum_of_squares, fit.point);
            assert_eq!(fit.end, End::Settled, "{name} from {start:?} at {:?}", fit.point);
        }
    }
}

/// A least value inside, far from the points without residuals that a step met, is no edge.
#[test]
fn a_least_value_inside_is_not_at_an_edge() {
    let model = |p: &[f64]| (p[0].abs() <= 1.0).then(|| vec![2.0 + (p[0] - 0.3) * (p[0] - 0.3)]);
    for start in [-0.99, -0.5, 0.2, 0.9] {
        let fit = fitted(&[(-3.0, 4.0)], &[start], &model).0.unwrap();
        assert!((fit.point[0] - 0.3).abs() < 1e-3, "{:?} from {start}", fit.point);
        assert!(fit.end == End::Settled && fit.beyond.is_none(), "{:?} {:?} from {start}", fit.end, fit.beyond);
    }
}

/// What cannot be shown to be least is not called so: a comb of slits has no edge with a normal.
#[test]
fn a_search_that_an_edge_ends_says_so() {
    let comb = |p: &[f64]| {
        let is_slit = libm::sin(3e5 * (p[0] - 0.3 * p[1])) > 0.9;
        (p[0] < 0.5 && !(p[0] > 0.499 && is_slit)).then(|| vec![p[0] - 1.0, p[1] - 0.2 * p[0]])
    };
    let fit = fitted(&[(0.0, 2.0), (-1.0, 1.0)], &[0.1, 0.9], &comb).0.unwrap();
    assert!(fit.point[0] <= 0.5 && (fit.end != End::Settled || fit.sum_of_squares < 0.2505), "{fit:?}");
}

/// Tier: invariant; a model with noise ends where no step can be told from it, soon, and near the least.
#[test]
fn noise_ends_a_search() {
    // Noise that is a function of the point.
    let noise = |x: f64| 1e-6 * libm::sin(1e9 * x);
    let data = [0.5, 1.0, 1.5, 2.0];
    let model = |p: &[f64]| {
        Some(data.iter().map(|x| libm::exp(-p[0] * x) * (1.0 + noise(p[0] + x)) - libm::exp(-0.7 * x)).collect())
    };
    let (fit, asked) = fitted(&[(0.1, 3.0)], &[2.0], &model);
    let fit = fit.unwrap();
    assert!((fit.point[0] - 0.7).abs() < 1e-5, "{:?}", fit.point);
    assert!(fit.end == End::Settled && asked < 120, "{asked}");
}

/// Tier: closed form; half a unit in the last digit covers the deviation.
#[test]
fn digits_are_those_that_a_deviation_leaves() {
    for (value, deviation, wanted) in [
        (14.079, 0.004, 4),
        (14.079, 0.006, 3),
        (-14.079, 0.5, 2),
        (14.079, 0.51, 1),
        (14.079, 60.0, 0),
        (9.99, 0.05, 2),
        (0.001_234, 1e-7, 4),
        (7.0, 0.0, 15),
        (0.0, 1.0, 0),
        (1.0, f64::INFINITY, 0),
        (1.0, f64::NAN, 0),
    ] {
        assert_eq!(digits(value, deviation), wanted, "{value} ± {deviation}");
    }
}
