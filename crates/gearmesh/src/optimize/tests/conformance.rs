//! What every registered method promises: points inside the box, the same sequence for the same seed, no more
//! evaluations than its budget, sense in the face of senseless values.

// A test may panic.
#![allow(clippy::disallowed_methods)]

use std::collections::BTreeMap;

use proptest::prelude::*;

use super::{choice, integer, run, search, with};
use crate::optimize::bounds::Bounds;
use crate::optimize::constraints::Evaluation;
use crate::optimize::search::{Optimizer, Reason};
use crate::optimize::{self, METHODS, members};
use declare::declared::{entry, record_of};
use declare::error::Failure;
use declare::record::Value;
use declare::seed::Seed;

/// Short runs of every method, and of the variants that take another path.
fn variants() -> Vec<(&'static str, Vec<(&'static str, Value)>)> {
    let levels = Value::List(vec![entry(integer(3))]);
    let few = || ("population", integer(9));
    vec![
        ("genetic", vec![few(), ("generations", integer(7))]),
        (
            "genetic",
            vec![few(), ("generations", integer(7)), ("coding", choice("gray")), ("mutation_of", choice("bit"))],
        ),
        (
            "genetic",
            vec![few(), ("generations", integer(7)), ("selection", choice("tournament")), ("elite", integer(2))],
        ),
        ("genetic", vec![few(), ("generations", integer(50)), ("converged_after", integer(3))]),
        ("differential_evolution", vec![few(), ("generations", integer(20)), ("weight", Value::Number(2.0))]),
        (
            "differential_evolution",
            vec![few(), ("mutant", choice("current_to_best")), ("polish", choice("nelder_mead"))],
        ),
        ("nelder_mead", vec![("edge", Value::Number(1.0))]),
        ("nelder_mead", vec![("start", choice("random")), ("evaluations", integer(50))]),
        ("nsga2", vec![few(), ("generations", integer(7))]),
        ("nsga2", vec![few(), ("generations", integer(7)), ("mutation", Value::Number(1.0))]),
        ("powell", vec![("step", Value::Number(1.0))]),
        ("powell", vec![("start", choice("random")), ("evaluations", integer(50))]),
        ("grid", vec![("levels", levels)]),
        ("latin_hypercube", vec![("points", integer(300))]),
        ("sobol", vec![("points", integer(300))]),
    ]
}

/// All points of a run, in the order asked for.
fn points(mut search: Optimizer, mut function: impl FnMut(&[f64]) -> f64) -> (Vec<Vec<f64>>, Optimizer) {
    let mut met = Vec::new();
    search
        .run(|batch| {
            assert!(!batch.is_empty());
            met.extend_from_slice(batch);
            Ok::<_, Failure>(batch.iter().map(|point| function(point)).collect())
        })
        .unwrap();
    (met, search)
}

/// A positive number that depends on the point in no useful way, sometimes inadmissible.
fn noise(point: &[f64]) -> f64 {
    let mixed =
        point.iter().fold(7_u64, |mixed, x| (mixed ^ x.to_bits()).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29));
    match mixed % 7 {
        0 => f64::NAN,
        1 => f64::INFINITY,
        _ => (mixed >> 40) as f64,
    }
}

#[test]
fn every_method_is_tried_and_described() {
    let tried: std::collections::BTreeSet<_> = variants().iter().map(|(name, _)| *name).collect();
    for (method, member) in METHODS.iter().zip(members()) {
        assert_eq!(method.member.name, member.name);
        assert!(tried.contains(member.name), "{} has no variant here", member.name);
        for text in std::iter::once(member.summary).chain(member.fields.iter().map(|field| field.summary)) {
            assert!(!text.is_empty() && !text.ends_with('.'), "{text:?}");
        }
        // The defaults alone must do.
        assert!(search(member.name, &[], &[(0.0, 1.0); 2], 1).finished().is_none());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn bounds_and_budget_hold_for_any_values(
        seed in any::<u64>(),
        corners in prop::collection::vec((-1e6..1e6_f64, 1e-6..1e6_f64), 1..5),
        scale in 1e-9..1e9_f64,
    ) {
        let bounds: Vec<_> = corners.iter().map(|(minimum, span)| (*minimum, minimum + span)).collect();
        for (method, given) in variants() {
            let (met, done) = points(search(method, &given, &bounds, seed), |point| noise(point) * scale);
            for point in &met {
                prop_assert_eq!(point.len(), bounds.len());
                prop_assert!(point.iter().zip(&bounds).all(|(x, (minimum, maximum))| minimum <= x && x <= maximum), "{} {:?}", method, point);
            }
            prop_assert_eq!(met.len(), done.evaluations());
            prop_assert!(done.evaluations() <= done.budget(), "{}: {} of {}", method, done.evaluations(), done.budget());
        }
    }
}

#[test]
fn what_a_method_asks_for_is_foreseen() {
    let bounds = [(0.0, 8e-6), (0.0, 6e-3), (-1.0, 1.0)];
    for (method, given) in variants() {
        let foreseen = with(method, &given).foresee(bounds.len()).unwrap();
        let (met, done) = points(search(method, &given, &bounds, 5), noise);
        let asked = (met.len(), done.history().len());
        assert_eq!(foreseen.evaluations, done.budget(), "{method}");
        if foreseen.exact {
            assert_eq!((foreseen.evaluations, foreseen.batches), asked, "{method}");
        }
        assert!(foreseen.evaluations >= asked.0 && foreseen.batches >= asked.1 && foreseen.memory > 0, "{method}");
    }
}

/// The noise of each point, a stretch of the batch on each thread.
fn on_threads(threads: usize, batch: &[Vec<f64>]) -> Vec<f64> {
    std::thread::scope(|scope| {
        let stretches = batch.chunks(batch.len().div_ceil(threads).max(1));
        let stretches: Vec<_> =
            stretches.map(|points| scope.spawn(|| points.iter().map(|point| noise(point)).collect())).collect();
        stretches.into_iter().flat_map(|values| -> Vec<f64> { values.join().unwrap() }).collect()
    })
}

#[test]
fn a_seed_gives_one_sequence_however_the_batch_is_evaluated() {
    let bounds = [(0.0, 8e-6), (0.0, 6e-3), (-1.0, 1.0)];
    for (method, given) in variants() {
        let (expected, _) = points(search(method, &given, &bounds, 5), noise);
        for threads in [1, 3] {
            let mut met = Vec::new();
            let mut again = search(method, &given, &bounds, 5);
            again
                .run(|batch| {
                    met.extend_from_slice(batch);
                    Ok::<_, Failure>(on_threads(threads, batch))
                })
                .unwrap();
            assert_eq!(met, expected, "{method} on {threads} threads");
        }
        let (other, _) = points(search(method, &given, &bounds, 6), noise);
        let random = match method {
            "grid" | "sobol" => false,
            "nelder_mead" | "powell" => given.contains(&("start", choice("random"))),
            _ => true,
        };
        assert_eq!(other != expected, random, "{method}: another seed");
    }
}

#[test]
fn the_population_methods_use_exactly_their_budget() {
    let bounds = [(0.0, 1.0); 3];
    let genetic = run(search("genetic", &[], &bounds, 1), |x| 1.0 + x[0]);
    assert_eq!((genetic.evaluations(), genetic.budget(), genetic.history().len()), (10_000, 10_000, 100));
    assert_eq!(genetic.finished(), Some(Reason::Generations));
    let given = [("population", integer(20)), ("generations", integer(15))];
    let evolution = run(search("differential_evolution", &given, &bounds, 1), |x| x[0]);
    assert_eq!((evolution.evaluations(), evolution.budget()), (300, 300));
    // Children come in pairs; an odd population has no room for the last.
    let odd =
        run(search("genetic", &[("population", integer(9)), ("generations", integer(7))], &bounds, 1), |x| 1.0 + x[0]);
    assert_eq!((odd.evaluations(), odd.budget()), (63, 63));
    let grid = run(search("grid", &[], &bounds, 1), |x| x[0]);
    assert_eq!((grid.evaluations(), grid.finished()), (1331, Some(Reason::Complete)));
}

#[test]
fn a_stalled_genetic_algorithm_ends_when_asked_to() {
    let given = [("converged_after", integer(5))];
    let flat = run(search("genetic", &given, &[(0.0, 1.0)], 1), |_| 1.0);
    // The first generation is an improvement on nothing.
    assert_eq!((flat.finished(), flat.history().len()), (Some(Reason::Converged), 6));
    // Every generation gains a thousandth of the best value; only a least improvement above that ends the run.
    let shrinking = |given: &[(&str, Value)]| {
        let mut search = search("genetic", given, &[(0.0, 1.0)], 1);
        let mut value = 1.0;
        search
            .run(|batch| {
                value *= 0.999;
                Ok::<_, Failure>(vec![value; batch.len()])
            })
            .unwrap();
        search.history().len()
    };
    assert_eq!(shrinking(&given), 100);
    let [patience] = given;
    assert_eq!(shrinking(&[patience, ("least_improvement", Value::Number(0.002))]), 6);
}

#[test]
fn equal_chromosomes_are_equal_points_so_a_caller_can_keep_their_values() {
    let mut known: BTreeMap<Vec<u64>, f64> = BTreeMap::new();
    let mut computed = 0;
    let bowl = |x: &[f64]| 0.1 + (x[0] - 0.3).powi(2) + (x[1] - 0.62).powi(2);
    let given = [("bits", integer(4))];
    let mut cached = search("genetic", &given, &[(0.0, 1.0); 2], 9);
    cached
        .run(|batch| {
            let value = |point: &Vec<f64>| {
                *known.entry(point.iter().map(|x| x.to_bits()).collect()).or_insert_with(|| {
                    computed += 1;
                    bowl(point)
                })
            };
            Ok::<_, Failure>(batch.iter().map(value).collect())
        })
        .unwrap();
    assert!(computed <= 256, "{computed} of {}", cached.evaluations());
    assert_eq!(cached.best(), run(search("genetic", &given, &[(0.0, 1.0); 2], 9), bowl).best());
}

#[test]
fn children_have_only_bits_of_their_parents() {
    // Without mutation a bit that all individuals share can never change.
    let bits = 12_usize;
    let given = [("bits", integer(12)), ("mutation", Value::Number(0.0)), ("population", integer(6))];
    let code = |x: f64| (x * f64::from((1_u32 << bits) - 1)).round() as u32;
    let mut always_set = u32::MAX;
    let mut never_set = u32::MAX;
    let (met, _) = points(search("genetic", &given, &[(0.0, 1.0)], 4), |x| 1.0 + x[0]);
    for batch in met.chunks(6) {
        let codes: Vec<u32> = batch.iter().map(|point| code(point[0])).collect();
        let set = codes.iter().fold(u32::MAX, |all, code| all & code);
        let unset = codes.iter().fold(u32::MAX, |all, code| all & !code);
        if always_set != u32::MAX {
            assert_eq!((set & always_set, unset & never_set), (always_set, never_set));
        }
        (always_set, never_set) = (set, unset);
    }
    // Without mutation the population ends as copies of one.
    assert_eq!((always_set | never_set) & 0xFFF, 0xFFF);
}

#[test]
fn the_first_population_holds_ones_and_zeros_alike() {
    let (met, _) = points(
        search("genetic", &[("population", integer(2000)), ("generations", integer(1))], &[(0.0, 1.0); 3], 8),
        |_| 1.0,
    );
    let ones: u32 = met.iter().flatten().map(|x| ((x * 1023.0).round() as u32).count_ones()).sum();
    // Binomial(60000, 1/2): a standard deviation of 122.
    assert!(ones.abs_diff(30_000) < 490, "{ones}");
}

#[test]
fn inadmissible_points_are_never_the_best() {
    for (method, given) in variants() {
        let (_, done) =
            points(search(method, &given, &[(0.0, 1.0); 2], 3), |x| if x[0] < 0.5 { f64::NAN } else { 1.0 + x[0] });
        // A simplex that starts where nothing is admissible finds nothing; whoever looks everywhere does.
        assert!(done.best().is_some() || given.contains(&("start", choice("random"))), "{method}");
        assert!(
            done.best().is_none_or(|best| best.point[0] >= 0.5 && best.value >= 1.5),
            "{method}: {:?}",
            done.best()
        );
        assert!(done.history().iter().all(|row| row.best >= 1.5 && !row.mean.is_nan()), "{method}");
        let (_, done) = points(search(method, &given, &[(0.0, 1.0); 2], 3), |_| f64::NAN);
        assert!(done.best().is_none(), "{method}");
        assert!(done.history().iter().all(|row| row.best == f64::INFINITY && row.mean == f64::INFINITY), "{method}");
    }
}

#[test]
fn not_a_number_counts_as_infinite() {
    for (method, given) in variants() {
        let met = |inadmissible| {
            points(search(method, &given, &[(0.0, 1.0); 2], 3), |x| if x[0] < 0.5 { inadmissible } else { 1.0 + x[0] })
                .0
        };
        assert_eq!(met(f64::NAN), met(f64::INFINITY), "{method}");
    }
}

#[test]
fn senseless_answers_are_refused() {
    for (method, given) in variants() {
        let mut search = search(method, &given, &[(0.0, 1.0); 2], 3);
        let count = search.ask().len();
        let message = search.tell(&vec![1.0; count + 1]).unwrap_err().to_string();
        assert_eq!(message, format!("{} values were told for {count} points", count + 1));
        let several = |further: usize| -> Vec<Evaluation> {
            (0..count).map(|_| Evaluation { further: vec![1.0; further], ..Evaluation::from(1.0) }).collect()
        };
        let mut mixed = several(1);
        mixed[count - 1] = Evaluation { further: vec![1.0; 2], ..Evaluation::from(1.0) };
        if count > 1 {
            let message = search.tell_constrained(mixed).unwrap_err().to_string();
            assert!(message.starts_with("a point has 3 objectives and 0 constraints, and others"), "{message}");
        }
        assert!(search.tell(&vec![f64::NEG_INFINITY; count]).unwrap_err().to_string().contains("minus infinity"));
        // Refused values are as if never told.
        assert_eq!((search.ask().len(), search.evaluations()), (count, 0));
        let mut done = run(search, |_| 1.0);
        assert!(done.ask().is_empty() && done.tell(&[]).unwrap_err().to_string().contains("has ended"));
    }
    let mut roulette = search("genetic", &[], &[(0.0, 1.0)], 1);
    let message = roulette.tell(&[-3.25; 100]).unwrap_err().to_string();
    assert!(message.contains("at least 0, not -3.25") && message.contains("tournament"), "{message}");
    let mut tournament = search("genetic", &[("selection", choice("tournament"))], &[(0.0, 1.0)], 1);
    tournament.tell(&[-3.25; 100]).unwrap();
}

#[test]
fn impossible_set_ups_are_refused() {
    let refusal = |method: &str, given: &[(&str, Value)], dimension: usize| {
        let fields = members().iter().find(|member| member.name == method).map_or(&[][..], |member| member.fields);
        let bounds = Bounds::new(vec![(0.0, 1.0); dimension]).unwrap();
        let method_of = optimize::read(method, &record_of(fields, given));
        let refused = method_of.and_then(|method| optimize::search(&*method, bounds, Seed::of_stage(1, "optimum")));
        refused.err().unwrap_or_else(|| panic!("{method} was accepted")).message
    };
    let list = |levels: &[i64]| Value::List(levels.iter().map(|level| entry(integer(*level))).collect());
    assert!(refusal("genetics", &[], 1).contains("there is no `genetics`"));
    assert!(refusal("genetic", &[("elite", integer(100))], 1).contains("no room for offspring"));
    assert!(refusal("grid", &[("levels", list(&[3, 4]))], 3).contains("2 levels are given for 3 variables"));
    assert!(refusal("grid", &[("levels", list(&[1000]))], 3).contains("1000000000 points"));
    assert!(refusal("grid", &[("levels", list(&[100_000]))], 5).contains("too many points to count"));
    assert!(refusal("sobol", &[], 49).contains("at most 48 variables"));
    assert!(refusal("nelder_mead", &[("evaluations", integer(10))], 10).contains("too few"));
    assert!(refusal("powell", &[("evaluations", integer(10))], 5).contains("too few for a line along each of 5"));
    let polish = [("polish", choice("nelder_mead")), ("polish_evaluations", integer(10))];
    assert!(refusal("differential_evolution", &polish, 11).contains("too few evaluations to polish 11"));
}
