//! How a total load spreads over many springs behind gaps that all deflect each other.
//!
//! The problem of `complementarity`, with `Springs` of its kind, for as many springs as there are slices of tooth pairs:
//! matrices of their size are kept here, which the few springs of whole pairs do without. Semismooth Newton; where it
//! should cycle, relaxation inside a bracket. Gaps are measured from the smallest one. Must not know: what the springs are.

use super::complementarity::Springs;
use super::crossing::crossing;

/// Share of the total below which what a Newton step leaves is rounding: of second order, but for slices at whose edge a
/// contact ends, which take up load as the 3/2 power.
const NEARLY: f64 = 1e-12;
/// Share of the total that rounding leaves in sums over many springs.
const ROUNDING: f64 = 1e-14;

/// Equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct Balance {
    /// Counted from the smallest gap.
    pub approach: f64,
    /// 0 or more; they add up to the total.
    pub loads: Vec<f64>,
    /// Where there is no load, minus the distance that is still open.
    pub penetration: Vec<f64>,
    /// d total/d approach.
    pub slope: f64,
}

/// Equilibrium. `total` > 0, the smallest gap is 0; `coupling` is symmetric, by rows; its diagonal is what a spring's
/// own load does to it beyond its response. Together they must be positive definite. `above` > 0 is where the search
/// starts: springs with smaller gaps carry load at first, best all that will, and few more.
pub fn balance(springs: &impl Springs, gaps: &[f64], coupling: &[f64], total: f64, above: f64) -> Balance {
    newton(springs, gaps, coupling, total, above).unwrap_or_else(|| relaxed(springs, gaps, coupling, total, above))
}

fn row(coupling: &[f64], spring: usize, count: usize) -> &[f64] {
    &coupling[spring * count..(spring + 1) * count]
}

/// What loads do to each spring, beyond its response to its own.
fn deflections(coupling: &[f64], loads: &[f64], into: &mut [f64]) {
    let count = loads.len();
    into.fill(0.0);
    for (spring, &load) in loads.iter().enumerate().filter(|(_, load)| **load != 0.0) {
        for (deflection, influence) in into.iter_mut().zip(row(coupling, spring, count)) {
            *deflection += influence * load;
        }
    }
}

fn newton(springs: &impl Springs, gaps: &[f64], coupling: &[f64], total: f64, above: f64) -> Option<Balance> {
    let count = gaps.len();
    let penetration = gaps.iter().map(|gap| above - gap).collect();
    let mut found = Balance { approach: above, loads: vec![0.0; count], penetration, slope: 0.0 };
    let [mut rises, mut residual, mut change, mut moved] = [(); 4].map(|()| vec![0.0; count]);
    let mut work = Factor::default();
    for _ in 0..60 {
        for (spring, rise) in rises.iter_mut().enumerate() {
            let w = found.penetration[spring];
            (found.loads[spring], *rise) = if w > 0.0 { springs.response(spring, w) } else { (0.0, 0.0) };
        }
        deflections(coupling, &found.loads, &mut residual);
        // The largest residual against what it was made of.
        let mut error = 0.0_f64;
        for (spring, residual) in residual.iter_mut().enumerate() {
            let w = found.penetration[spring];
            let size = found.approach.abs() + gaps[spring] + w.abs() + *residual;
            *residual += w + gaps[spring] - found.approach;
            error = error.max(residual.abs() / size);
        }
        let excess = found.loads.iter().sum::<f64>() - total;
        let [offset, slope] = work.solve(coupling, &rises, &residual)?;
        let shift = (-excess - offset) / slope;
        change.fill(0.0);
        for (index, &spring) in work.loaded.iter().enumerate() {
            change[spring] = work.solved[index][0] + work.solved[index][1] * shift;
        }
        deflections(coupling, &change, &mut moved);
        for spring in 0..count {
            found.penetration[spring] += if rises[spring] > 0.0 {
                change[spring] / rises[spring]
            } else {
                shift - residual[spring] - moved[spring]
            };
        }
        found.approach += shift;
        found.slope = slope;
        let error = error.max(excess.abs() / total);
        let lifts = || found.loads.iter().zip(&change).any(|(load, change)| load + change < 0.0);
        if error <= ROUNDING || (error <= NEARLY && !lifts()) {
            for (load, change) in found.loads.iter_mut().zip(&change) {
                *load = (*load + change).max(0.0);
            }
            return Some(found);
        }
        if !found.approach.is_finite() {
            return None;
        }
    }
    None
}

/// Cholesky's factorisation of the compliance matrix of the loaded springs, with room that is kept between steps.
#[derive(Default)]
struct Factor {
    loaded: Vec<usize>,
    /// By columns, from the diagonal down; the rest is not used.
    columns: Vec<f64>,
    /// Load changes of the loaded springs: what undoes the residual, what follows a unit of approach.
    solved: Vec<[f64; 2]>,
}

impl Factor {
    /// Sums of both columns of `solved`; `None` when the matrix is not positive definite or nothing is loaded.
    fn solve(&mut self, coupling: &[f64], rises: &[f64], residual: &[f64]) -> Option<[f64; 2]> {
        self.loaded.clear();
        self.loaded.extend((0..rises.len()).filter(|&spring| rises[spring] > 0.0));
        let size = self.loaded.len();
        self.columns.clear();
        self.columns.resize(size * size, 0.0);
        self.solved.clear();
        self.solved.extend(self.loaded.iter().map(|&spring| [-residual[spring], 1.0]));
        for (column, &spring) in self.loaded.iter().enumerate() {
            let influences = row(coupling, spring, rises.len());
            let (before, rest) = self.columns.split_at_mut(column * size);
            let entries = &mut rest[column..size];
            for (entry, &other) in entries.iter_mut().zip(&self.loaded[column..]) {
                *entry = influences[other];
            }
            entries[0] += 1.0 / rises[spring];
            for earlier in before.chunks_exact(size) {
                let factor = earlier[column];
                for (entry, other) in entries.iter_mut().zip(&earlier[column..]) {
                    *entry -= factor * other;
                }
            }
            let pivot = entries[0];
            if !(pivot > 0.0 && pivot.is_finite()) {
                return None;
            }
            let root = pivot.sqrt();
            for entry in entries.iter_mut() {
                *entry /= root;
            }
            let (done, below) = self.solved[column..].split_at_mut(1);
            done[0] = done[0].map(|value| value / root);
            for (value, entry) in below.iter_mut().zip(&entries[1..]) {
                value[0] -= entry * done[0][0];
                value[1] -= entry * done[0][1];
            }
        }
        let mut sums = [0.0; 2];
        for column in (0..size).rev() {
            let entries = &self.columns[column * size + column..(column + 1) * size];
            let mut value = self.solved[column];
            for (entry, later) in entries[1..].iter().zip(&self.solved[column + 1..]) {
                value[0] -= entry * later[0];
                value[1] -= entry * later[1];
            }
            self.solved[column] = value.map(|value| value / entries[0]);
            sums[0] += self.solved[column][0];
            sums[1] += self.solved[column][1];
        }
        (sums[1] > 0.0).then_some(sums)
    }
}

/// For a given approach, each load in turn against the others; the approach by bracketing. Slow and sure.
fn relaxed(springs: &impl Springs, gaps: &[f64], coupling: &[f64], total: f64, above: f64) -> Balance {
    let count = gaps.len();
    let mut found = Balance { approach: 0.0, loads: vec![0.0; count], penetration: vec![0.0; count], slope: 0.0 };
    let mut excess = |approach: f64| {
        found.approach = approach;
        for _ in 0..20_000 {
            let mut change = 0.0_f64;
            for (spring, gap) in gaps.iter().enumerate() {
                let influences = row(coupling, spring, count);
                let all: f64 = influences.iter().zip(&found.loads).map(|(influence, load)| influence * load).sum();
                let w = approach - gap - all;
                let load = if w > 0.0 { springs.response(spring, w).0 } else { 0.0 };
                change = change.max((load - found.loads[spring]).abs());
                (found.penetration[spring], found.loads[spring]) = (w, load);
            }
            if change <= 1e-15 * total {
                break;
            }
        }
        found.loads.iter().sum::<f64>() - total
    };
    let mut upper = (above, excess(above));
    while upper.1 < 0.0 && upper.0 < f64::MAX / 4.0 {
        upper = (2.0 * upper.0, excess(2.0 * upper.0));
    }
    let root = crossing(&mut excess, (0.0, -total), upper, 0.0);
    excess(root);
    let response = |(spring, w): (usize, &f64)| if *w > 0.0 { springs.response(spring, *w).1 } else { 0.0 };
    let rises: Vec<f64> = found.penetration.iter().enumerate().map(response).collect();
    let solved = Factor::default().solve(coupling, &rises, &vec![0.0; count]);
    found.slope = solved.map_or(0.0, |[_, slope]| slope);
    found
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::numeric::complementarity::{self, MOST_SPRINGS};

    /// Stiffness, and the penetration above which it doubles.
    struct Bent(Vec<f64>);

    impl Springs for Bent {
        fn response(&self, spring: usize, w: f64) -> (f64, f64) {
            let stiffness = self.0[spring];
            (stiffness * (w + (w - 0.5).max(0.0)), stiffness * if w > 0.5 { 2.0 } else { 1.0 })
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]
        /// Tier: second method. The solver for few springs, and relaxation.
        #[test]
        fn few_springs_are_balanced_as_by_the_solver_for_few(
            count in 1_usize..=MOST_SPRINGS,
            roots in prop::collection::vec(-1.0_f64..1.0, MOST_SPRINGS * MOST_SPRINGS),
            own in prop::collection::vec(0.1_f64..2.0, MOST_SPRINGS),
            openings in prop::collection::vec(0.0_f64..2.0, MOST_SPRINGS),
            closed in 0_usize..MOST_SPRINGS,
            total in 1e-3_f64..4.0,
        ) {
            let entry = |i: usize, k: usize| (0..count).map(|m| roots[i * MOST_SPRINGS + m] * roots[k * MOST_SPRINGS + m]).sum::<f64>();
            let mut gaps = openings[..count].to_vec();
            gaps[closed % count] = 0.0;
            let off = |i: usize, k: usize| if i == k { 0.0 } else { entry(i, k) };
            let coupling: Vec<f64> = (0..count * count).map(|at| off(at / count, at % count)).collect();
            let mut few = [[0.0; MOST_SPRINGS]; MOST_SPRINGS];
            for at in 0..count * count {
                few[at / count][at % count] = coupling[at];
            }
            // Twice as stiff must still be positive definite with the coupling.
            let springs = Bent((0..count).map(|i| 0.5 / (own[i] + entry(i, i))).collect());
            let above = 2.0 + 4.0 * total;
            let exact = complementarity::balance_coupled(&springs, &gaps, &few, total, above);
            // The last from an approach under which the springs carry next to nothing of the load.
            let slow = [above, 1e-4 * total].map(|above| relaxed(&springs, &gaps, &coupling, total, above));
            for found in slow.into_iter().chain([balance(&springs, &gaps, &coupling, total, above)]) {
                prop_assert!((found.approach / exact.approach - 1.0).abs() < 1e-9);
                prop_assert!((found.slope / exact.slope - 1.0).abs() < 1e-6 || found.penetration.iter().any(|w| w.abs() < 1e-6 || (w - 0.5).abs() < 1e-6));
                for spring in 0..count {
                    prop_assert!((found.loads[spring] - exact.loads[spring]).abs() < 1e-9 * total);
                }
                prop_assert!((found.loads.iter().sum::<f64>() / total - 1.0).abs() < 1e-12);
            }
        }
    }
}
