//! How a total load spreads over a few springs behind gaps, where each spring's penetration is known for its load.
//!
//! The problem of [`complementarity`](super::complementarity), whose springs know the load of a penetration: where it is the
//! other way round, Newton's method for the loads has nothing to invert. It is for springs that are well loaded or well
//! open; next to where one begins to touch the other way is taken. Must not know: what the springs are.

use super::complementarity::bordered::Bordered;
use super::complementarity::{Balance, Coupling, MOST_SPRINGS, PerSpring, linear_approach};

/// Share of the total below which a spring is on the brink of losing its load.
const BRINK: f64 = 0.02;
/// Share of the total of a last step: what it leaves is of second order.
const NEARLY: f64 = 3e-8;
/// Share of the total of a step that is taken with what penetrations bend, so that it leaves what is of third order.
const BENT: f64 = 1e-5;
/// The most steps; two or three are taken.
const STEPS: usize = 12;

/// Penetrations and their slopes as functions of the load.
pub trait Yielding {
    /// Penetration at a load > 0, d penetration/d load, and about d² penetration/d load², which only shortens the way: the
    /// first increases with the load.
    fn penetration(&self, spring: usize, load: f64) -> [f64; 3];
}

/// Equilibrium of springs that are well loaded or well open; `total` > 0, the smallest gap is 0. None where one of them is
/// neither, or Newton's method does not settle.
pub fn balance(springs: &impl Yielding, gaps: &[f64], coupling: Option<&Coupling>, total: f64) -> Option<Balance> {
    let count = gaps.len();
    let mut found = Balance { approach: 0.0, loads: [0.0; MOST_SPRINGS], penetration: [0.0; MOST_SPRINGS], slope: 0.0 };
    if let [gap] = gaps {
        let [penetration, rate, _] = springs.penetration(0, total);
        (found.approach, found.loads[0], found.penetration[0]) = (penetration + gap, total, penetration);
        return Some(Balance { slope: 1.0 / rate, ..found });
    }
    // As if each were linear, as stiff as under its part of the load.
    let even = total / count as f64;
    let mut stiffness = [0.0; MOST_SPRINGS];
    for (spring, stiffness) in stiffness[..count].iter_mut().enumerate() {
        *stiffness = even / springs.penetration(spring, even)[0];
    }
    found.approach = linear_approach(&stiffness, gaps, total);
    let mut loaded = [false; MOST_SPRINGS];
    for (spring, gap) in gaps.iter().enumerate() {
        let load = stiffness[spring] * (found.approach - gap);
        if load.abs() < BRINK * total {
            return None;
        }
        (found.loads[spring], loaded[spring]) = (load.max(0.0), load > 0.0);
    }
    for _ in 0..STEPS {
        let change = step(springs, gaps, coupling, total, loaded, &mut found)?;
        let mut largest = 0.0_f64;
        for (spring, load) in found.loads[..count].iter_mut().enumerate().filter(|(spring, _)| loaded[*spring]) {
            *load += change[spring];
            largest = largest.max(change[spring].abs());
            if *load < BRINK * total {
                return None;
            }
        }
        if largest <= NEARLY * total {
            for (spring, gap) in gaps.iter().enumerate() {
                found.penetration[spring] = found.approach - gap - by_others(coupling, &found.loads[..count], spring);
                let open = -found.penetration[spring];
                if !loaded[spring] && open < BRINK * found.approach {
                    return None;
                }
            }
            return Some(found);
        }
    }
    None
}

/// What the loads of the others do to a spring.
fn by_others(coupling: Option<&Coupling>, loads: &[f64], at: usize) -> f64 {
    coupling.map_or(0.0, |coupling| {
        let others = loads.iter().enumerate().filter(|(other, _)| *other != at);
        others.map(|(other, load)| coupling[at][other] * load).sum()
    })
}

/// A step of Newton's method: by how much loads change; the approach changes here.
fn step(
    springs: &impl Yielding,
    gaps: &[f64],
    coupling: Option<&Coupling>,
    total: f64,
    loaded: [bool; MOST_SPRINGS],
    found: &mut Balance,
) -> Option<PerSpring> {
    let count = gaps.len();
    let (mut residual, mut rises, mut bends) = ([0.0; MOST_SPRINGS], [0.0; MOST_SPRINGS], [0.0; MOST_SPRINGS]);
    for spring in (0..count).filter(|spring| loaded[*spring]) {
        let [penetration, rate, bend] = springs.penetration(spring, found.loads[spring]);
        residual[spring] =
            penetration + by_others(coupling, &found.loads[..count], spring) + gaps[spring] - found.approach;
        (rises[spring], bends[spring]) = (1.0 / rate, bend);
    }
    let excess = found.loads[..count].iter().sum::<f64>() - total;
    let (mut change, mut shift, slope) = linear_step(&residual, &rises, coupling, excess, count)?;
    if change.iter().any(|change| change.abs() > BENT * total) {
        for spring in 0..count {
            residual[spring] += 0.5 * bends[spring] * change[spring] * change[spring];
        }
        (change, shift, _) = linear_step(&residual, &rises, coupling, excess, count)?;
    }
    found.slope = slope;
    found.approach += shift;
    found.approach.is_finite().then_some(change)
}

/// By how much loads and approach change as if penetrations were linear; and the slope of the total.
#[inline]
fn linear_step(
    residual: &PerSpring,
    rises: &PerSpring,
    coupling: Option<&Coupling>,
    excess: f64,
    count: usize,
) -> Option<(PerSpring, f64, f64)> {
    let mut change = [0.0; MOST_SPRINGS];
    if let Some(coupling) = coupling {
        let solved = Bordered::solve(coupling, rises, residual, count)?;
        let shift = (-excess - solved.offset) / solved.slope;
        for (spring, change) in change[..count].iter_mut().enumerate() {
            *change = solved.particular[spring] + solved.unit[spring] * shift;
        }
        return Some((change, shift, solved.slope));
    }
    let slope = rises[..count].iter().sum();
    let undone: f64 = residual[..count].iter().zip(rises).map(|(residual, rise)| residual * rise).sum();
    let shift = (undone - excess) / slope;
    for (spring, change) in change[..count].iter_mut().enumerate() {
        *change = (shift - residual[spring]) * rises[spring];
    }
    Some((change, shift, slope))
}

#[cfg(test)]
mod tests {
    use super::super::complementarity::{self, Springs};
    use super::*;

    /// w = s p^¾ and back.
    struct Powers(PerSpring);

    impl Yielding for Powers {
        fn penetration(&self, spring: usize, load: f64) -> [f64; 3] {
            let penetration = self.0[spring] * load.powf(0.75);
            [penetration, 0.75 * penetration / load, -0.1875 * penetration / (load * load)]
        }
    }

    impl Springs for Powers {
        fn response(&self, spring: usize, penetration: f64) -> (f64, f64) {
            let load = (penetration / self.0[spring]).powf(4.0 / 3.0);
            (load, load / penetration * 4.0 / 3.0)
        }
    }

    /// Tier: second method; as by penetrations, wherever there is an answer, and there is one away from first touches.
    #[test]
    fn loads_are_those_found_by_penetrations() {
        let springs = Powers([1.0, 1.3, 0.8, 2.0, 0.0, 0.0]);
        let mut answers = 0;
        for coupled in [false, true] {
            let mut coupling: Coupling = [PerSpring::default(); MOST_SPRINGS];
            for (row, column, value) in [(0, 1, 0.1), (1, 2, 0.1), (2, 3, 0.1), (0, 2, 0.05), (1, 3, 0.05)] {
                (coupling[row][column], coupling[column][row]) = (value, value);
            }
            for gaps in [vec![0.0], vec![0.0, 0.4], vec![0.3, 0.0, 0.1], vec![0.0, 0.7, 2.0, 0.2], vec![0.0, 9.0]] {
                for total in [0.3, 1.0, 3.0, 10.0] {
                    let chosen = coupled.then_some(&coupling);
                    let Some(found) = balance(&springs, &gaps, chosen, total) else { continue };
                    answers += 1;
                    let above = 2.0 * springs.penetration(3, total)[0] + 10.0;
                    let exact = if coupled {
                        complementarity::balance_coupled(&springs, &gaps, &coupling, total, above)
                    } else {
                        complementarity::balance(&springs, &gaps, total, above)
                    };
                    assert!(
                        (found.approach / exact.approach - 1.0).abs() < 1e-13,
                        "{gaps:?} {total}: {found:?} {exact:?}"
                    );
                    for (a, b) in found.loads.iter().zip(exact.loads) {
                        assert!((a - b).abs() < 1e-13 * total, "{gaps:?} {total}: {found:?} {exact:?}");
                    }
                    for (a, b) in found.penetration.iter().zip(exact.penetration).take(gaps.len()) {
                        assert!((a - b).abs() < 1e-13 * found.approach, "{gaps:?} {total}: {found:?} {exact:?}");
                    }
                    assert!((found.slope / exact.slope - 1.0).abs() < 1e-8, "{gaps:?} {total}");
                }
            }
        }
        assert!(answers >= 25, "{answers}");
    }
}
