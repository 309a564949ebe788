//! How a total load spreads over a few springs that stand behind gaps: a monotone complementarity problem.
//!
//! Find the approach x and penetrations w_j = x − gap_j − Σ_k c_jk load_k with load_j = response_j(w_j) ≥ 0, zero for
//! w_j ≤ 0, and Σ load_j = total. Responses are convex and increasing, so without coupling Newton's method started above
//! the root falls onto it monotonically and needs no safeguard. With coupling the loads minimise a convex complementary
//! energy; semismooth Newton finds them, and where it should cycle, relaxation inside a bracket does. Gaps are measured
//! from the smallest one: then x keeps all its digits however small the load. Must not know: what the springs are.

use self::bordered::Bordered;
use super::crossing::crossing;

pub(super) mod bordered;
pub mod side_by_side;

/// The most springs one problem may have.
pub const MOST_SPRINGS: usize = 6;

/// Share of the total below which what a Newton step leaves, being of second order, is rounding.
const NEARLY: f64 = 1e-9;
/// By what a Newton step changes the error at least, where it is of second order.
const FALL: f64 = 1e-3;
/// An error from which the next step leads nearer than what is only about right.
const NEAR: f64 = 1e-2;
/// How often a step of Newton's method may bring little.
const STEPS: u32 = 60;
/// Share of the total that rounding leaves.
const ROUNDING: f64 = 1e-14;

/// One number per spring.
pub type PerSpring = [f64; MOST_SPRINGS];
/// Penetration of one spring per load on another; symmetric, the diagonal is not read.
pub type Coupling = [PerSpring; MOST_SPRINGS];

/// Loads and their slopes as functions of the penetration.
pub trait Springs {
    /// Load and d load/d penetration: zero for `penetration` ≤ 0, convex and increasing above.
    fn response(&self, spring: usize, penetration: f64) -> (f64, f64);

    /// The same but for a small part of it, for steps that are far from the end; none where it takes no less.
    fn response_about(&self, _spring: usize, _penetration: f64) -> Option<(f64, f64)> {
        None
    }
}

/// Equilibrium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Balance {
    /// x, counted from the smallest gap.
    pub approach: f64,
    /// 0 or more; they add up to the total.
    pub loads: PerSpring,
    /// w_j; where there is no load, minus the distance that is still open.
    pub penetration: PerSpring,
    /// d total/d x.
    pub slope: f64,
}

impl Balance {
    /// Of nothing.
    pub const EMPTY: Self =
        Self { approach: 0.0, loads: [0.0; MOST_SPRINGS], penetration: [0.0; MOST_SPRINGS], slope: 0.0 };
}

/// The approach of linear springs without coupling: sort by gap and take prefix sums. Exact.
#[must_use]
pub fn linear_approach(stiffness: &PerSpring, gaps: &[f64], total: f64) -> f64 {
    match gaps {
        [gap] => return (total + stiffness[0] * gap) / stiffness[0],
        [one, two] => {
            let ([first, second], [near, far]) = if two < one { ([1, 0], [two, one]) } else { ([0, 1], [one, two]) };
            let moment = stiffness[first] * near;
            let approach = (total + moment) / stiffness[first];
            if approach <= *far {
                return approach;
            }
            return (total + (moment + stiffness[second] * far)) / (stiffness[first] + stiffness[second]);
        }
        _ => (),
    }
    let mut order = [0, 1, 2, 3, 4, 5];
    let order = &mut order[..gaps.len()];
    for i in 1..order.len() {
        let mut k = i;
        while k > 0 && gaps[order[k]] < gaps[order[k - 1]] {
            order.swap(k, k - 1);
            k -= 1;
        }
    }
    let (mut sum, mut moment, mut approach) = (0.0, 0.0, 0.0);
    for (rank, &spring) in order.iter().enumerate() {
        sum += stiffness[spring];
        moment += stiffness[spring] * gaps[spring];
        approach = (total + moment) / sum;
        if order.get(rank + 1).is_none_or(|&next| approach <= gaps[next]) {
            break;
        }
    }
    approach
}

/// Nothing is loaded. `penetration` is then the margin by which a spring is the nearest one, so that its sign tells
/// the nearest and its zero is where two springs change places.
#[must_use]
pub fn unloaded(gaps: &[f64]) -> Balance {
    let mut balance = Balance::EMPTY;
    for (spring, gap) in gaps.iter().enumerate() {
        let others = gaps.iter().enumerate().filter(|(other, _)| *other != spring).map(|(_, gap)| *gap);
        let margin = others.fold(f64::INFINITY, f64::min) - gap;
        balance.penetration[spring] = if margin.is_finite() { margin } else { 0.0 };
    }
    balance
}

/// Equilibrium without coupling. `total` > 0, the smallest gap is 0, and at `above` the springs carry `total` or more.
pub fn balance(springs: &impl Springs, gaps: &[f64], total: f64, above: f64) -> Balance {
    // Mostly there are one or two, which are quicker when that is known.
    match *gaps {
        [gap] => balance_of(springs, [gap], total, above),
        [one, two] => balance_of(springs, [one, two], total, above),
        _ => {
            // What is added to as many as there may be is never loaded.
            let mut all = [f64::INFINITY; MOST_SPRINGS];
            all[..gaps.len()].copy_from_slice(gaps);
            let mut found = balance_of(springs, all, total, above);
            found.penetration[gaps.len()..].fill(0.0);
            found
        }
    }
}

#[inline]
fn balance_of<const N: usize>(springs: &impl Springs, gaps: [f64; N], total: f64, above: f64) -> Balance {
    let responses = |spring: usize, [penetration]: &[f64; 1]| {
        let (load, rise) = if *penetration > 0.0 { springs.response(spring, *penetration) } else { (0.0, 0.0) };
        [[load], [rise]]
    };
    let found = side_by_side::balances(responses, &gaps.map(|gap| [gap]), total, [above]);
    let mut balance = Balance { approach: found.approach[0], slope: found.slope[0], ..Balance::EMPTY };
    for spring in 0..N {
        balance.penetration[spring] = found.penetration[spring][0];
        balance.loads[spring] = found.loads[spring][0];
    }
    balance
}

/// Equilibrium with coupling; the rest as in [`balance`].
pub fn balance_coupled(springs: &impl Springs, gaps: &[f64], coupling: &Coupling, total: f64, above: f64) -> Balance {
    let mut start = Balance { approach: above, ..Balance::EMPTY };
    for (penetration, gap) in start.penetration.iter_mut().zip(gaps) {
        *penetration = above - gap;
    }
    newton(springs, gaps, coupling, total, start).unwrap_or_else(|| relaxed(springs, gaps, coupling, total, above))
}

fn newton(
    springs: &impl Springs,
    gaps: &[f64],
    coupling: &Coupling,
    total: f64,
    mut found: Balance,
) -> Option<Balance> {
    let count = gaps.len();
    let (mut before, mut left) = (f64::INFINITY, STEPS);
    while left > 0 {
        let (from, mut is_about) = (found.approach, false);
        let mut rises = [0.0; MOST_SPRINGS];
        for (spring, rise) in rises[..count].iter_mut().enumerate() {
            let w = found.penetration[spring];
            let about = if w > 0.0 && before > NEAR { springs.response_about(spring, w) } else { None };
            is_about |= about.is_some();
            let exact = || if w > 0.0 { springs.response(spring, w) } else { (0.0, 0.0) };
            (found.loads[spring], *rise) = about.unwrap_or_else(exact);
        }
        let mut residual = [0.0; MOST_SPRINGS];
        // The largest residual against what it was made of.
        let mut error = 0.0_f64;
        for j in 0..count {
            let w = found.penetration[j];
            residual[j] = w + deflection(coupling, &found.loads, j, count) + gaps[j] - found.approach;
            error = error.max(residual[j].abs() / (found.approach.abs() + gaps[j] + w.abs()));
        }
        let excess = found.loads[..count].iter().sum::<f64>() - total;
        let solved = Bordered::solve(coupling, &rises, &residual, count)?;
        let shift = (-excess - solved.offset) / solved.slope;
        let mut change = [0.0; MOST_SPRINGS];
        for (j, change) in change[..count].iter_mut().enumerate() {
            *change = solved.particular[j] + solved.unit[j] * shift;
        }
        for j in 0..count {
            found.penetration[j] += if rises[j] > 0.0 {
                change[j] / rises[j]
            } else {
                shift - residual[j] - deflection(coupling, &change, j, count)
            };
        }
        found.approach += shift;
        found.slope = solved.slope;
        let error = error.max(excess.abs() / total);
        let lifts = || found.loads.iter().zip(change).any(|(load, change)| load + change < 0.0);
        // Near a singular matrix rounding alone keeps it from getting better.
        let settled = error <= NEARLY && ((error <= FALL * before && !lifts()) || error >= before);
        before = error;
        if !is_about && (error <= ROUNDING || settled) {
            for (load, change) in found.loads.iter_mut().zip(change) {
                *load = (*load + change).max(0.0);
            }
            return Some(found);
        }
        if !found.approach.is_finite() {
            return None;
        }
        // From far above each step halves it, as often as that takes; what does not is a cycle in the end.
        if found.approach > 0.75 * from {
            left -= 1;
        }
    }
    None
}

fn deflection(coupling: &Coupling, loads: &PerSpring, at: usize, count: usize) -> f64 {
    (0..count).filter(|other| *other != at).map(|other| coupling[at][other] * loads[other]).sum()
}

/// For a given approach, each load in turn against the others (coordinate descent on the complementary energy); the
/// approach by bracketing. Slow and sure.
fn relaxed(springs: &impl Springs, gaps: &[f64], coupling: &Coupling, total: f64, above: f64) -> Balance {
    let count = gaps.len();
    let mut found = Balance::EMPTY;
    let mut excess = |approach: f64| {
        found.approach = approach;
        for _ in 0..20_000 {
            let mut change = 0.0_f64;
            for (j, gap) in gaps.iter().enumerate() {
                let w = approach - gap - deflection(coupling, &found.loads, j, count);
                let load = if w > 0.0 { springs.response(j, w).0 } else { 0.0 };
                change = change.max((load - found.loads[j]).abs());
                (found.penetration[j], found.loads[j]) = (w, load);
            }
            // The last bit of a load may go to and fro, and there are no bits below the least normal number.
            let largest = found.loads[..count].iter().copied().fold(total, f64::max);
            if change <= (f64::EPSILON * largest).max(f64::MIN_POSITIVE) {
                break;
            }
        }
        found.loads[..count].iter().sum::<f64>() - total
    };
    let mut upper = (above, excess(above));
    while upper.1 < 0.0 && upper.0 < f64::MAX / 4.0 {
        // Twice nothing is nothing: so it may come out under the least loads.
        let wider = (2.0 * upper.0).max(f64::MIN_POSITIVE);
        upper = (wider, excess(wider));
    }
    let root = crossing(&mut excess, (0.0, -total), upper, 0.0);
    excess(root);
    let rises: Vec<f64> = (0..count)
        .map(|j| if found.penetration[j] > 0.0 { springs.response(j, found.penetration[j]).1 } else { 0.0 })
        .collect();
    let mut padded = [0.0; MOST_SPRINGS];
    padded[..count].copy_from_slice(&rises);
    found.slope = Bordered::solve(coupling, &padded, &[0.0; MOST_SPRINGS], count).map_or(0.0, |solved| solved.slope);
    found
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    struct Linear(PerSpring);

    impl Springs for Linear {
        fn response(&self, spring: usize, penetration: f64) -> (f64, f64) {
            (self.0[spring] * penetration, self.0[spring])
        }
    }

    /// Tries every set of loaded springs and solves the linear equations by Gauss–Jordan.
    fn enumerated(compliance: &[Vec<f64>], gaps: &[f64], total: f64) -> (f64, Vec<f64>) {
        let n = gaps.len();
        for set in 1_u32..1 << n {
            let members: Vec<usize> = (0..n).filter(|j| set >> j & 1 == 1).collect();
            let size = members.len();
            let mut rows: Vec<Vec<f64>> = members
                .iter()
                .map(|&i| {
                    let mut row: Vec<f64> = members.iter().map(|&k| compliance[i][k]).collect();
                    row.extend([-1.0, -gaps[i]]);
                    row
                })
                .collect();
            rows.push([vec![1.0; size], vec![0.0, total]].concat());
            for column in 0..=size {
                let pivot = (column..=size).max_by(|a, b| rows[*a][column].abs().total_cmp(&rows[*b][column].abs()));
                rows.swap(column, pivot.unwrap());
                let scale = rows[column][column];
                rows[column].iter_mut().for_each(|entry| *entry /= scale);
                let pivot_row = rows[column].clone();
                for (index, row) in rows.iter_mut().enumerate() {
                    if index != column {
                        let factor = row[column];
                        row.iter_mut().zip(&pivot_row).for_each(|(entry, p)| *entry -= factor * p);
                    }
                }
            }
            let mut loads = vec![0.0; n];
            for (row, &member) in members.iter().enumerate() {
                loads[member] = rows[row][size + 1];
            }
            let approach = rows[size][size + 1];
            let open = |j: usize| gaps[j] + (0..n).map(|k| compliance[j][k] * loads[k]).sum::<f64>() - approach;
            if (0..n).all(|j| loads[j] >= -1e-12 * total && (set >> j & 1 == 1 || open(j) >= -1e-12 * approach)) {
                return (approach, loads);
            }
        }
        panic!("no set of loaded springs fits");
    }

    fn check(compliance: &[Vec<f64>], gaps: &[f64], total: f64, solved: &Balance) {
        let (approach, loads) = enumerated(compliance, gaps, total);
        assert!((solved.approach / approach - 1.0).abs() < 1e-9, "{} {approach}", solved.approach);
        for (j, load) in loads.iter().enumerate() {
            assert!((solved.loads[j] - load).abs() < 1e-9 * total, "{:?} {loads:?}", solved.loads);
            assert!(solved.loads[j] >= 0.0);
        }
        let sum: f64 = solved.loads[..gaps.len()].iter().sum();
        assert!((sum / total - 1.0).abs() < 1e-12, "{sum} {total}");
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn random_problems_agree_with_enumeration(
            count in 1_usize..=MOST_SPRINGS,
            roots in prop::collection::vec(-1.0_f64..1.0, MOST_SPRINGS * MOST_SPRINGS),
            own in prop::collection::vec(0.02_f64..2.0, MOST_SPRINGS),
            openings in prop::collection::vec(0.0_f64..3.0, MOST_SPRINGS),
            closed in 0_usize..MOST_SPRINGS,
            total in 1e-3_f64..10.0,
            coupled in any::<bool>(),
        ) {
            // B Bᵀ + diagonal: positive definite, off-diagonals of either sign and often larger than is mechanical.
            let entry = |i: usize, k: usize| (0..count).map(|m| roots[i * MOST_SPRINGS + m] * roots[k * MOST_SPRINGS + m]).sum::<f64>();
            let compliance: Vec<Vec<f64>> = (0..count)
                .map(|i| (0..count).map(|k| match (i == k, coupled) {
                    (true, _) => entry(i, i) + own[i],
                    (false, true) => entry(i, k),
                    (false, false) => 0.0,
                }).collect())
                .collect();
            let mut gaps = openings[..count].to_vec();
            gaps[closed % count] = 0.0;
            let (mut stiffness, mut coupling) = ([0.0; MOST_SPRINGS], [[0.0; MOST_SPRINGS]; MOST_SPRINGS]);
            for i in 0..count {
                stiffness[i] = 1.0 / compliance[i][i];
                for k in 0..count {
                    coupling[i][k] = compliance[i][k];
                }
            }
            let springs = Linear(stiffness);
            let above = linear_approach(&stiffness, &gaps, total);
            check(&compliance, &gaps, total, &balance_coupled(&springs, &gaps, &coupling, total, above));
            check(&compliance, &gaps, total, &relaxed(&springs, &gaps, &coupling, total, above));
            if !coupled {
                check(&compliance, &gaps, total, &balance(&springs, &gaps, total, above));
                let slopes = [balance(&springs, &gaps, total, above), balance_coupled(&springs, &gaps, &coupling, total, above)];
                prop_assert!((slopes[0].slope / slopes[1].slope - 1.0).abs() < 1e-13);
            }
        }
    }

    /// Slopes that are a hundredth off let Newton's method fall by that factor only: it must not stop early.
    #[test]
    fn inexact_slopes_are_iterated_to_the_end() {
        struct Inexact(f64);
        impl Springs for Inexact {
            fn response(&self, _: usize, w: f64) -> (f64, f64) {
                (w + w * w, self.0 * (1.0 + 2.0 * w))
            }
        }
        let (gaps, mut coupling) = ([0.0, 0.1], [[0.0; MOST_SPRINGS]; MOST_SPRINGS]);
        (coupling[0][1], coupling[1][0]) = (0.1, 0.1);
        let [exact, found] = [1.0, 1.01].map(|slope| balance_coupled(&Inexact(slope), &gaps, &coupling, 2.0, 3.0));
        for load in 0..2 {
            assert!((found.loads[load] / exact.loads[load] - 1.0).abs() < 1e-13, "{found:?} {exact:?}");
        }
        assert!((found.approach / exact.approach - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_vanishing_load_keeps_its_digits_beside_gaps() {
        let stiffness = [3.0e8; MOST_SPRINGS];
        for total in [1e-300, 1e-15, 1e-3, 1e12] {
            let gaps = [0.0, 4.0e-6];
            let found = balance(&Linear(stiffness), &gaps, total, linear_approach(&stiffness, &gaps, total));
            let exact = if total / 3.0e8 < 4.0e-6 { total / 3.0e8 } else { (total + 1200.0) / 6.0e8 };
            assert!((found.approach / exact - 1.0).abs() < 1e-15, "{total}");
        }
    }

    /// Loads that have few digits left, or none: there is an end all the same.
    #[test]
    fn the_least_loads_come_to_an_end() {
        struct Counted(std::cell::Cell<usize>);
        impl Springs for Counted {
            fn response(&self, _: usize, w: f64) -> (f64, f64) {
                self.0.set(self.0.get() + 1);
                (2e8 * w, 2e8)
            }
        }
        let (gaps, coupling) = ([0.0, 0.0, 1e-6], [[1e-9; MOST_SPRINGS]; MOST_SPRINGS]);
        for total in [5e-324, 1e-323, 3e-321, 1e-320, 1e-310, 1e-300, 1e-60] {
            let springs = Counted(std::cell::Cell::new(0));
            let above = linear_approach(&[2e8; MOST_SPRINGS], &gaps, total);
            let found = balance_coupled(&springs, &gaps, &coupling, total, above);
            assert!(found.approach >= 0.0 && found.loads.iter().all(|load| *load >= 0.0), "{total}");
            assert!(springs.0.get() < 100_000, "{} calls for {total}", springs.0.get());
        }
    }

    #[test]
    fn without_load_the_nearest_has_the_positive_margin() {
        let found = unloaded(&[2.0, 0.0, 3.0]);
        assert_eq!(found.penetration[..3], [-2.0, 2.0, -3.0]);
    }
}
