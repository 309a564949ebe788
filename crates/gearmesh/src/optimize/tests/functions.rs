//! Known functions: their minima are found, to stated tolerances, from 20 seeds. What each method is not made for is
//! stated too: a local search may end in any of several minima, a genetic algorithm with ten bits near one.

use super::{choice, integer, run, search};
use crate::optimize::search::{Optimizer, Reason};
use declare::record::Value;

const SEEDS: std::ops::Range<u64> = 0..20;

type Function = fn(&[f64]) -> f64;

/// A function, its box, its lowest value, and how near every seed must come.
type Case = (Function, &'static [(f64, f64)], f64, f64);

fn sphere(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum()
}

fn rosenbrock(x: &[f64]) -> f64 {
    x.windows(2).map(|pair| 100.0 * (pair[1] - pair[0] * pair[0]).powi(2) + (1.0 - pair[0]).powi(2)).sum()
}

/// Lowest at 0; a local minimum near every other point with whole coordinates.
fn rastrigin(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x + 10.0 * (1.0 - libm::cos(std::f64::consts::TAU * x))).sum()
}

fn himmelblau(x: &[f64]) -> f64 {
    (x[0] * x[0] + x[1] - 11.0).powi(2) + (x[0] + x[1] * x[1] - 7.0).powi(2)
}

/// The four minima of [`himmelblau`], all 0; the first is exact, the others from a Newton iteration.
const HIMMELBLAU: [[f64; 2]; 4] = [
    [3.0, 2.0],
    [-2.805_118_086_952_745, 3.131_312_518_250_573],
    [-3.779_310_253_377_747, -3.283_185_991_286_169_4],
    [3.584_428_340_330_492, -1.848_126_526_964_403_6],
];

/// Like the peak-to-peak transmission error against tip relief: kinks, and a flat bottom of width 0.2 at 0.27.
fn plateau(x: &[f64]) -> f64 {
    0.27 + x.iter().map(|x| ((x - 0.6).abs() - 0.1).max(0.0)).sum::<f64>()
}

/// The largest miss of `value` by any seed, and the most evaluations.
fn misses(method: &str, given: &[(&str, Value)], bounds: &[(f64, f64)], function: Function, value: f64) -> f64 {
    SEEDS
        .map(|seed| {
            let found = run(search(method, given, bounds, seed), function);
            assert!(found.evaluations() <= found.budget());
            found.best().unwrap().value - value
        })
        .fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn differential_evolution_finds_the_lowest_minimum() {
    let cases: [Case; 4] = [
        (sphere, &[(-5.0, 3.0); 4], 0.0, 1e-9),
        (rosenbrock, &[(-2.0, 2.0); 3], 0.0, 1e-9),
        (rastrigin, &[(-5.12, 4.0); 2], 0.0, 1e-9),
        (plateau, &[(0.0, 1.0); 3], 0.27, 1e-15),
    ];
    for mutant in ["rand", "current_to_best"] {
        for (function, bounds, value, tolerance) in cases {
            let given = [("mutant", choice(mutant)), ("generations", integer(400))];
            let missed = misses("differential_evolution", &given, bounds, function, value);
            assert!((0.0..tolerance).contains(&missed), "{mutant}, {} variables: {missed:e}", bounds.len());
        }
    }
}

#[test]
fn polishing_sharpens_a_short_evolution() {
    let bounds = [(-2.0, 2.0); 3];
    let given = |polish| [("generations", integer(30)), ("polish", choice(polish))];
    let rough = misses("differential_evolution", &given("none"), &bounds, rosenbrock, 0.0);
    let polished = misses("differential_evolution", &given("nelder_mead"), &bounds, rosenbrock, 0.0);
    assert!(rough > 1e-4, "{rough:e}");
    assert!(polished < 1e-15, "{polished:e}");
    let found = run(search("differential_evolution", &given("nelder_mead"), &bounds, 1), rosenbrock);
    assert_eq!(found.finished(), Some(Reason::Converged));
    assert_eq!(found.history()[29].evaluations, 60 * 30);
}

#[test]
fn local_searches_converge_from_anywhere() {
    let start = [("start", choice("random"))];
    let cases: [Case; 3] = [
        (sphere, &[(-5.0, 3.0); 4], 0.0, 1e-13),
        (rosenbrock, &[(-2.0, 2.0); 3], 0.0, 1e-13),
        (plateau, &[(0.0, 1.0); 3], 0.27, 1e-15),
    ];
    for method in ["nelder_mead", "powell"] {
        for (function, bounds, value, tolerance) in cases {
            let missed = misses(method, &start, bounds, function, value);
            assert!((0.0..tolerance).contains(&missed), "{method}, {} variables: {missed:e}", bounds.len());
        }
    }
}

#[test]
fn restarts_free_a_simplex_stuck_in_a_sharp_valley() {
    // Kinks like those of a peak-to-peak value: without a restart some seeds end on the valley's floor, far from 0.
    let valley: Function =
        |x| x.windows(2).map(|pair| 20.0 * (pair[1] - pair[0]).abs()).sum::<f64>() + (x[0] - 0.37).abs();
    let missed = |restarts| {
        let given = [("restarts", integer(restarts)), ("start", choice("random"))];
        misses("nelder_mead", &given, &[(0.0, 1.3); 3], valley, 0.0)
    };
    assert!(missed(0) > 0.1, "{:e}", missed(0));
    assert!(missed(3) < 1e-7, "{:e}", missed(3));
}

/// Without the replacement of directions both would use up 5000.
#[test]
fn conjugate_directions_save_evaluations() {
    let narrow: Function = |x| (x[0] + x[1] - 1.1).powi(2) + 1e3 * (x[0] - x[1] - 0.2).powi(2);
    let cases: [(Function, _, _); 2] = [(rosenbrock, [(-2.0, 2.0); 2], 300), (narrow, [(0.0, 1.0); 2], 60)];
    for (function, bounds, maximum) in cases {
        let found = run(search("powell", &[("restarts", integer(0))], &bounds, 1), function);
        assert_eq!(found.finished(), Some(Reason::Converged));
        assert!(found.best().unwrap().value < 1e-15, "{:?}", found.best());
        assert!(found.evaluations() < maximum, "{} evaluations", found.evaluations());
    }
}

#[test]
fn a_minimum_in_a_corner_is_met_exactly() {
    // Lowest at (−1, 7): falling to one bound and to the other.
    let corner: Function = |x| (x[0] + 2.0).powi(2) + (8.0 - x[1]);
    for (method, given) in [
        ("nelder_mead", [("start", choice("random"))]),
        ("powell", [("start", choice("random"))]),
        ("differential_evolution", [("polish", choice("nelder_mead"))]),
    ] {
        for seed in SEEDS {
            let found = run(search(method, &given, &[(-1.0, 3.0), (0.0, 7.0)], seed), corner);
            assert_eq!(found.best().unwrap().point, [-1.0, 7.0], "{method}, seed {seed}");
        }
    }
}

#[test]
fn all_four_minima_of_himmelblau_are_met() {
    let bounds = [(-5.0, 5.0); 2];
    let nearest = |found: &Optimizer| {
        let point = &found.best().unwrap().point;
        let distance = |minimum: &[f64; 2]| (point[0] - minimum[0]).abs().max((point[1] - minimum[1]).abs());
        let at = (0..4).min_by(|a, b| distance(&HIMMELBLAU[*a]).total_cmp(&distance(&HIMMELBLAU[*b]))).unwrap();
        (at, distance(&HIMMELBLAU[at]))
    };
    let mut met = [0; 4];
    for seed in SEEDS {
        for method in ["nelder_mead", "powell"] {
            let found = run(search(method, &[("start", choice("random"))], &bounds, seed), himmelblau);
            let (at, distance) = nearest(&found);
            assert!(distance < 1e-6, "{method}, seed {seed}: {distance:e} from {:?}", HIMMELBLAU[at]);
            met[at] += 1;
        }
        let polish = [("polish", choice("nelder_mead"))];
        let (at, distance) = nearest(&run(search("differential_evolution", &polish, &bounds, seed), himmelblau));
        assert!(distance < 1e-6, "seed {seed}: {distance:e} from {:?}", HIMMELBLAU[at]);
    }
    // A local search goes to a minimum near its start; evolution mostly to the one with the widest basin.
    assert!(met.iter().all(|count| *count > 0), "{met:?}");
}

#[test]
fn the_genetic_algorithm_comes_as_near_as_its_bits_allow() {
    // Ten bits on 0..1: a step of 1/1023. With an elite the best value never gets worse.
    let bowl: Function = |x| 0.1 + (x[0] - 0.3).powi(2) + (x[1] - 0.62).powi(2) + (x[2] - 0.81).powi(2);
    for coding in ["binary", "gray"] {
        for selection in ["roulette", "tournament"] {
            let given = [("coding", choice(coding)), ("selection", choice(selection)), ("elite", integer(1))];
            for seed in SEEDS {
                let found = run(search("genetic", &given, &[(0.0, 1.0); 3], seed), bowl);
                let missed = found.best().unwrap().value - 0.1;
                assert!(missed < 1e-3, "{coding}, {selection}, seed {seed}: {missed:e}");
                assert!(found.history().windows(2).all(|rows| rows[1].best <= rows[0].best));
            }
        }
    }
    let missed = misses("genetic", &[("coding", choice("gray"))], &[(0.0, 1.0); 3], plateau, 0.27);
    assert!((0.0..1e-2).contains(&missed), "{missed:e}");
}
