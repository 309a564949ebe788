//! How exact complementarity can be: gaps by the second evaluation, in twice the precision, put into the balance of the kernels.

use std::sync::Arc;

use super::super::precise::exact_gap;
use super::super::tests::{base, of_teeth};
use super::*;
use crate::gear::compliance::weber_banaschek::WeberBanaschek;
use crate::numeric::double_double::Double;

/// The largest of all positions: what penetrations with exact gaps leave unexplained over the force, and what of it copies of the
/// gaps do; how far gaps are off over what both reliefs take, the kernels' search and its copies.
fn exact_residual(case: &Case) -> ([f64; 2], [f64; 2]) {
    let built = case.build().unwrap();
    let loading = built.cycle.loaded(&built.design, case.torque);
    let gaps = Gaps::new(&built.pair, &built.design.profiles(0.0));
    let (mut found, mut off) = ([0.0_f64; 2], [0.0_f64; 2]);
    for zone in &built.cycle.zones {
        for share in SHARES {
            let position = zone.start + share * (zone.end - zone.start);
            let state = loading.state(position, zone.pairs);
            let springs = built.cycle.springs(zone.pairs);
            let pairs = pairs(&built, position, springs);
            let places: Vec<f64> = (0..springs).map(|index| built.cycle.path_position(position, index)).collect();
            let exact: Vec<Double> = places.iter().map(|s| exact_gap(case, &built, Double::from(*s))).collect();
            let smallest = exact.iter().copied().reduce(|one, two| if two < one { two } else { one }).unwrap();
            for (j, s) in places.iter().enumerate() {
                let load = state.balance.loads[j];
                if load <= 0.0 {
                    continue;
                }
                let of_others = |k: usize| Double::from(pairs.compliance[j][k]) * state.balance.loads[k];
                let others = (0..springs).filter(|k| *k != j).fold(Double::ZERO, |sum, k| sum + of_others(k));
                let penetration = Double::from(state.balance.approach) - (exact[j] - smallest) - others;
                let unexplained = penetration / pairs.compliance[j][j] - load;
                let wrong = [gaps.at(*s), loading.gap(*s)].map(|gap| (Double::from(gap.unwrap()) - exact[j]).high);
                let of_copy = (unexplained - wrong[1] / pairs.compliance[j][j]).high.abs();
                found[0] = found[0].max(unexplained.high.abs() / loading.force());
                found[1] = found[1].max(of_copy / loading.force());
                for (off, wrong) in off.iter_mut().zip(wrong) {
                    *off = off.max(wrong.abs() / (2.0 * case.relief));
                }
            }
        }
    }
    (found, off)
}

/// Tier: second method. With gaps in twice the precision, loads and approach of the kernels are complementary to 1e-12, for
/// gears of a thousand teeth too, which move by little under the same torque; gaps and their copies are as exact as is said.
#[test]
fn complementarity_is_kept_with_exact_gaps_too() {
    for teeth in [[19, 48], [100, 48], [300, 48], [1000, 48]] {
        let mut case = base();
        case.gears = of_teeth(teeth);
        (case.relief, case.relief_length) = (8e-6, 4e-3);
        case.model.method = Arc::new(WeberBanaschek::default());
        case.model.assumptions.coupled = true;
        let ([residual, without_copies], off) = exact_residual(&case);
        println!("{teeth:?}: {residual:e}, without what copies are off by {without_copies:e}; gaps off by {off:?}");
        assert!(residual < PROMISED, "{teeth:?}: {residual:e}");
        assert!(off.iter().all(|off| *off < COPY), "{teeth:?}: {off:?}");
    }
}
