//! Problems with constraints and known minima, by every method.
//!
//! The problems and their minima are numbers 6, 24, 35, 43, 65, 71 and 76 of Hock and Schittkowski, Test Examples for
//! Nonlinear Programming Codes (Springer 1981); bounds that they do not have are wide of the minimum.

use super::{choice, integer, search};
use crate::optimize::constraints::{Evaluation, KEPT};
use crate::optimize::search::{Optimizer, Reason};
use declare::error::Failure;
use declare::record::Value;

struct Problem {
    number: u32,
    bounds: &'static [(f64, f64)],
    /// Objective and constraints.
    function: fn(&[f64]) -> (f64, Vec<f64>),
    minimum: f64,
    at: &'static [f64],
    /// Has an equation, which no sample meets.
    equation: bool,
}

const PROBLEMS: [Problem; 7] = [
    Problem {
        number: 6,
        bounds: &[(-4.0, 4.0); 2],
        function: |x| {
            let equation = x[1] - x[0] * x[0];
            ((1.0 - x[0]).powi(2), vec![equation, -equation])
        },
        minimum: 0.0,
        at: &[1.0, 1.0],
        equation: true,
    },
    Problem {
        number: 24,
        bounds: &[(0.0, 6.0); 2],
        function: |x| {
            let root = 3_f64.sqrt();
            let value = ((x[0] - 3.0).powi(2) - 9.0) * x[1].powi(3) / (27.0 * root);
            (value, vec![x[0] / root - x[1], x[0] + root * x[1], 1.0 - (x[0] + root * x[1]) / 6.0])
        },
        minimum: -1.0,
        at: &[3.0, 1.732_050_807_568_877_2],
        equation: false,
    },
    Problem {
        number: 35,
        bounds: &[(0.0, 4.0); 3],
        function: |x| {
            let value = 9.0 - 8.0 * x[0] - 6.0 * x[1] - 4.0 * x[2]
                + 2.0 * x[0] * x[0]
                + 2.0 * x[1] * x[1]
                + x[2] * x[2]
                + 2.0 * x[0] * x[1]
                + 2.0 * x[0] * x[2];
            (value, vec![1.0 - (x[0] + x[1] + 2.0 * x[2]) / 3.0])
        },
        minimum: 1.0 / 9.0,
        at: &[4.0 / 3.0, 7.0 / 9.0, 4.0 / 9.0],
        equation: false,
    },
    Problem {
        number: 43,
        bounds: &[(-3.0, 4.0); 4],
        function: |x| {
            let s: Vec<f64> = x.iter().map(|x| x * x).collect();
            let value = s[0] + s[1] + 2.0 * s[2] + s[3] - 5.0 * x[0] - 5.0 * x[1] - 21.0 * x[2] + 7.0 * x[3];
            let first = 8.0 - s[0] - s[1] - s[2] - s[3] - x[0] + x[1] - x[2] + x[3];
            let second = 10.0 - s[0] - 2.0 * s[1] - s[2] - 2.0 * s[3] + x[0] + x[3];
            let third = 5.0 - 2.0 * s[0] - s[1] - s[2] - 2.0 * x[0] + x[1] + x[3];
            (value, vec![first / 8.0, second / 10.0, third / 5.0])
        },
        minimum: -44.0,
        at: &[0.0, 1.0, 2.0, -1.0],
        equation: false,
    },
    Problem {
        number: 65,
        bounds: &[(-4.5, 4.5), (-4.5, 4.5), (-5.0, 5.0)],
        function: |x| {
            let value = (x[0] - x[1]).powi(2) + (x[0] + x[1] - 10.0).powi(2) / 9.0 + (x[2] - 5.0).powi(2);
            (value, vec![1.0 - x.iter().map(|x| x * x).sum::<f64>() / 48.0])
        },
        minimum: 0.953_528_856_7,
        at: &[3.650_461_8, 3.650_461_8, 4.620_417_1],
        equation: false,
    },
    Problem {
        number: 71,
        bounds: &[(1.0, 5.0); 4],
        function: |x| {
            let equation = x.iter().map(|x| x * x).sum::<f64>() / 40.0 - 1.0;
            let value = x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2];
            (value, vec![x.iter().product::<f64>() / 25.0 - 1.0, equation, -equation])
        },
        minimum: 17.014_017_3,
        at: &[1.0, 4.742_999_4, 3.821_150_3, 1.379_408_2],
        equation: true,
    },
    Problem {
        number: 76,
        bounds: &[(0.0, 4.0); 4],
        function: |x| {
            let value = x[0] * x[0] + 0.5 * x[1] * x[1] + x[2] * x[2] + 0.5 * x[3] * x[3] - x[0] * x[2] + x[2] * x[3]
                - x[0]
                - 3.0 * x[1]
                + x[2]
                - x[3];
            let first = 5.0 - x[0] - 2.0 * x[1] - x[2] - x[3];
            let second = 4.0 - 3.0 * x[0] - x[1] - 2.0 * x[2] + x[3];
            (value, vec![first / 5.0, second / 4.0, (x[1] + 4.0 * x[2] - 1.5) / 1.5])
        },
        minimum: -4.681_818_181,
        at: &[3.0 / 11.0, 23.0 / 11.0, 0.0, 6.0 / 11.0],
        equation: false,
    },
];

fn solve(method: &str, given: &[(&str, Value)], problem: &Problem, scale: f64) -> Optimizer {
    let mut search = search(method, given, problem.bounds, 1);
    let evaluate = |point: &Vec<f64>| {
        let (value, constraints) = (problem.function)(point);
        Evaluation { value: scale * value, constraints, ..Evaluation::default() }
    };
    search.run_constrained(|points| Ok::<_, Failure>(points.iter().map(evaluate).collect())).unwrap();
    search
}

/// The objective may be a µm or a km: the multipliers take its size.
#[test]
fn local_searches_reach_the_minimum_on_the_constraints() {
    for method in ["powell", "nelder_mead"] {
        for problem in &PROBLEMS {
            for scale in [1e-6, 1.0, 1e3] {
                let given = [("evaluations", integer(100_000))];
                let found = solve(method, &given, problem, scale);
                let best = found.best().unwrap();
                let missed = best.value / scale - problem.minimum;
                let aside = best.point.iter().zip(problem.at).map(|(x, at)| (x - at).abs()).fold(0.0, f64::max);
                println!(
                    "{method} {} × {scale:e}: {} evaluations, {missed:e} at {aside:e}",
                    problem.number,
                    found.evaluations()
                );
                assert_eq!(best.violation.to_bits(), 0, "{method}, problem {}", problem.number);
                assert!(missed.abs() < 2e-6, "{method}, problem {}: {missed:e}", problem.number);
                assert!(aside < 1e-3, "{method}, problem {}: {aside:e}", problem.number);
            }
        }
    }
}

#[test]
fn a_population_reaches_the_minimum_within_the_constraints() {
    for problem in PROBLEMS.iter().filter(|problem| !problem.equation) {
        let found = solve("differential_evolution", &[("generations", integer(600))], problem, 1.0);
        let best = found.best().unwrap();
        let missed = best.value - problem.minimum;
        println!("{}: {missed:e} after {}", problem.number, found.evaluations());
        assert_eq!(best.violation.to_bits(), 0, "problem {}", problem.number);
        assert!(missed.abs() < 2e-6, "problem {}: {missed:e}", problem.number);
    }
}

/// Why local searches are not given the rule of populations: a local search stops at a cliff, and reports that. A cliff
/// far from the minimum is not reported.
#[test]
fn a_cliff_stops_a_local_search_far_from_the_minimum() {
    let slope = |x: &[f64]| x[0] + 2.0 * x[1];
    let kept = |x: &[f64]| x[0] + x[1] - 0.9;
    let bounds = [(0.0, 1.0); 2];
    for method in ["powell", "nelder_mead"] {
        for restarts in [0, 30] {
            let given = [("restarts", integer(restarts))];
            let cliff = |x: &[f64]| if kept(x) < 0.0 { f64::INFINITY } else { slope(x) };
            let mut cliff = super::run(search(method, &given, &bounds, 1), cliff);
            assert!(method != "powell" || cliff.best().unwrap().value > 1.2, "{:?}", cliff.best());
            assert_eq!(cliff.finished(), Some(Reason::Edge), "{method} {restarts}: {:?}", cliff.best());
            assert!(cliff.doubt().unwrap().contains("stopped at the edge of the valid designs"));
            let far = |x: &[f64]| if x[0] > 0.9 { f64::NAN } else { (x[0] - 0.3).powi(2) + (x[1] - 0.6).powi(2) };
            let mut far = super::run(search(method, &given, &bounds, 1), far);
            assert_eq!((far.finished(), far.doubt()), (Some(Reason::Converged), None), "{method}");
        }
        let edge = |x: &[f64]| if x[0] > 0.700_123 { f64::NAN } else { -x[0] };
        assert_eq!(super::run(search(method, &[], &[(0.0, 1.0)], 1), edge).finished(), Some(Reason::Edge), "{method}");
    }
    let mut smooth = search("powell", &[], &bounds, 1);
    let evaluate = |x: &Vec<f64>| Evaluation { value: slope(x), constraints: vec![kept(x)], ..Evaluation::default() };
    smooth.run_constrained(|points| Ok::<_, Failure>(points.iter().map(evaluate).collect())).unwrap();
    assert!((smooth.best().unwrap().value - 0.9).abs() < 1e-6, "{:?}", smooth.best());
    assert_eq!(smooth.finished(), Some(Reason::Converged));
}

#[test]
fn where_nothing_keeps_the_constraints_the_least_broken_point_is_named() {
    let evaluate = |x: &Vec<f64>| Evaluation {
        value: x[0],
        constraints: vec![-0.25 - x[0] * x[0], x[1] - 2.0],
        ..Evaluation::default()
    };
    for (method, near) in
        [("powell", 1e-5), ("nelder_mead", 1e-5), ("differential_evolution", 1e-5), ("genetic", 1e-2), ("grid", 1e-9)]
    {
        let mut search = search(method, &[], &[(0.0, 1.0); 2], 1);
        search.run_constrained(|points| Ok::<_, Failure>(points.iter().map(evaluate).collect())).unwrap();
        let best = search.best().unwrap();
        assert!(search.evaluations() <= search.budget(), "{method}");
        assert!((best.violation - 1.25).abs() < near, "{method}: {best:?}");
        assert!(search.history().iter().all(|row| row.best.is_infinite() && row.best_so_far.is_infinite()), "{method}");
    }
    let mut tournament = search("genetic", &[("selection", choice("tournament"))], &[(0.0, 1.0)], 1);
    let broken = Evaluation { value: -1.0, constraints: vec![-2.0 * KEPT], ..Evaluation::default() };
    tournament.tell_constrained(vec![broken; 100]).unwrap();
    assert!(tournament.best().unwrap().violation > KEPT);
}

#[test]
fn a_constraint_that_is_no_number_makes_a_point_inadmissible() {
    for method in ["powell", "nelder_mead", "differential_evolution", "latin_hypercube"] {
        let mut search = search(method, &[], &[(0.0, 1.0); 2], 1);
        let evaluate = |x: &Vec<f64>| Evaluation {
            value: x[0] * x[0] + x[1],
            constraints: vec![if x[0] < 0.4 { f64::NAN } else { x[1] - 0.2 }],
            ..Evaluation::default()
        };
        search.run_constrained(|points| Ok::<_, Failure>(points.iter().map(evaluate).collect())).unwrap();
        let best = search.best().unwrap();
        assert!(best.point[0] >= 0.4 && best.point[1] > 0.2 - 2.0 * KEPT, "{method}: {best:?}");
    }
}
