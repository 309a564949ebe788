//! How a total load spreads over a few springs behind gaps, where each spring's penetration is known for its load.
//!
//! The problem of [`complementarity`](super::complementarity), whose springs know the load of a penetration: where it is the
//! other way round, Newton's method for the loads has nothing to invert. It is for springs that are well loaded or well
//! open; next to where one begins to touch the other way is taken. Must not know: what the springs are.

use super::complementarity::bordered::Bordered;
use super::complementarity::{Balance, Coupling, MOST_SPRINGS, PerSpring, linear_approach};

/// Share of the total below which a spring is on the brink of losing its load.
const BRINK: f64 = 0.02;
/// Share of the total that a last step may leave.
const LEFT: f64 = 5e-16;
/// The most steps; two or three are taken.
const STEPS: usize = 12;

/// What a spring does at a load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Yielded {
    /// By how much it yields; increases with the load.
    pub penetration: f64,
    /// d penetration/d load.
    pub rate: f64,
    /// d² penetration/d load², or about that.
    pub bend: f64,
    /// Whether it is about that: then it only shortens the way.
    pub is_rough: bool,
}

impl Yielded {
    const NONE: Self = Self { penetration: 0.0, rate: 1.0, bend: 0.0, is_rough: false };

    /// About the same where the load has changed.
    fn about(self, change: f64) -> Self {
        let Self { penetration, rate, bend, .. } = self;
        let penetration = penetration + change * (rate + 0.5 * bend * change);
        Self { penetration, rate: rate + bend * change, ..self }
    }

    /// Where the load has changed a little.
    fn rate_after(&self, change: f64) -> f64 {
        if self.is_rough { self.rate } else { self.rate + self.bend * change }
    }
}

/// Penetrations and their slopes as functions of the load.
pub trait Yielding {
    /// At a load > 0.
    fn penetration(&self, spring: usize, load: f64) -> Yielded;

    /// About the same, from which to start: it only shortens the way.
    fn about(&self, spring: usize, load: f64) -> Yielded {
        self.penetration(spring, load)
    }
}

type Each = [Yielded; MOST_SPRINGS];

/// Equilibrium of springs that are well loaded or well open; `total` > 0, the smallest gap is 0. None where one of them is
/// neither, or Newton's method does not settle.
pub fn balance(springs: &impl Yielding, gaps: &[f64], coupling: Option<&Coupling>, total: f64) -> Option<Balance> {
    let count = gaps.len();
    let mut found = Balance::EMPTY;
    if let [gap] = gaps {
        let Yielded { penetration, rate, .. } = springs.penetration(0, total);
        (found.approach, found.loads[0], found.penetration[0]) = (penetration + gap, total, penetration);
        return Some(Balance { slope: 1.0 / rate, ..found });
    }
    if let [one, two] = *gaps {
        return among_two(springs, [one, two], coupling, total);
    }
    // Which are loaded: as if each were linear, as stiff as under its part of the load.
    let even = total / count as f64;
    let (mut each, mut stiffness) = ([Yielded::NONE; MOST_SPRINGS], [0.0; MOST_SPRINGS]);
    for (spring, stiffness) in stiffness[..count].iter_mut().enumerate() {
        each[spring] = springs.about(spring, even);
        *stiffness = even / each[spring].penetration;
    }
    found.approach = linear_approach(&stiffness, gaps, total);
    let (mut loaded, mut size) = ([0; MOST_SPRINGS], 0);
    let mut estimate = [0.0; MOST_SPRINGS];
    for (spring, gap) in gaps.iter().enumerate() {
        let load = stiffness[spring] * (found.approach - gap);
        if load.abs() < BRINK * total {
            return None;
        }
        if load > 0.0 {
            (estimate[spring], found.loads[spring]) = (load, even);
            (loaded[size], size) = (spring, size + 1);
        }
    }
    let loaded = &loaded[..size];
    if let [one] = *loaded {
        return alone(springs, one, gaps, coupling, total);
    }
    if let [one, two] = *loaded {
        // Loads that add up to the total, and about what is known there.
        let half = 0.5 * total;
        let each = [one, two].map(|spring| each[spring].about(half - even));
        let start = Two { springs: [one, two], each, loads: [half; 2] };
        let c = coupling.map_or(0.0, |coupling| coupling[one][two]);
        start.balance(springs, [gaps[one], gaps[two], c], total, [estimate[one], estimate[two]], &mut found)?;
        return opened(found, gaps, coupling);
    }
    // What is known under equal parts makes the first step, if that leads to loads.
    let first = step(&each, gaps, coupling, total, loaded, &found)?;
    if loaded.iter().all(|&spring| found.loads[spring] + first.change[spring] >= BRINK * total) {
        for &spring in loaded {
            found.loads[spring] += first.change[spring];
        }
        found.approach += first.shift;
    } else {
        found.loads = estimate;
    }
    for _ in 0..STEPS {
        for &spring in loaded {
            each[spring] = springs.penetration(spring, found.loads[spring]);
        }
        let Step { change, shift, left } = step(&each, gaps, coupling, total, loaded, &found)?;
        found.approach += shift;
        for &spring in loaded {
            found.loads[spring] += change[spring];
            if found.loads[spring] < BRINK * total {
                return None;
            }
        }
        if left <= LEFT * total {
            found.slope = slope(&each, coupling, loaded, &change, count)?;
            return opened(found, gaps, coupling);
        }
        if !found.approach.is_finite() {
            return None;
        }
    }
    None
}

/// The equilibrium of two springs.
fn among_two(springs: &impl Yielding, gaps: [f64; 2], coupling: Option<&Coupling>, total: f64) -> Option<Balance> {
    // Which are loaded: as if each were linear, as stiff as under half of the load.
    let half = 0.5 * total;
    let each = [springs.about(0, half), springs.about(1, half)];
    let stiffness = [half / each[0].penetration, half / each[1].penetration];
    let (near, far) = if gaps[1] < gaps[0] { (1, 0) } else { (0, 1) };
    let mut approach = (total + stiffness[near] * gaps[near]) / stiffness[near];
    if approach > gaps[far] {
        let moment = stiffness[0] * gaps[0] + stiffness[1] * gaps[1];
        approach = (total + moment) / (stiffness[0] + stiffness[1]);
    }
    let loads = [stiffness[0] * (approach - gaps[0]), stiffness[1] * (approach - gaps[1])];
    if loads[0].abs().min(loads[1].abs()) < BRINK * total {
        return None;
    }
    if loads[far] < 0.0 {
        return alone(springs, near, &gaps, coupling, total);
    }
    let c = coupling.map_or(0.0, |coupling| coupling[0][1]);
    let mut found = Balance::EMPTY;
    Two { springs: [0, 1], each, loads: [half; 2] }.balance(
        springs,
        [gaps[0], gaps[1], c],
        total,
        loads,
        &mut found,
    )?;
    found.penetration[0] = found.approach - gaps[0] - c * found.loads[1];
    found.penetration[1] = found.approach - gaps[1] - c * found.loads[0];
    Some(found)
}

/// One spring has all of the load.
#[inline]
fn alone(
    springs: &impl Yielding,
    spring: usize,
    gaps: &[f64],
    coupling: Option<&Coupling>,
    total: f64,
) -> Option<Balance> {
    let Yielded { penetration, rate, .. } = springs.penetration(spring, total);
    let mut found = Balance { approach: penetration + gaps[spring], slope: 1.0 / rate, ..Balance::EMPTY };
    found.loads[spring] = total;
    opened(found, gaps, coupling)
}

/// With the penetrations that follow from loads and approach, if what carries nothing is well open.
#[inline]
fn opened(mut found: Balance, gaps: &[f64], coupling: Option<&Coupling>) -> Option<Balance> {
    for (spring, gap) in gaps.iter().enumerate() {
        found.penetration[spring] = found.approach - gap - by_others(coupling, &found.loads[..gaps.len()], spring);
        if found.loads[spring] <= 0.0 && -found.penetration[spring] < BRINK * found.approach {
            return None;
        }
    }
    Some(found)
}

/// Two loaded springs: one unknown, the load of the first.
struct Two {
    springs: [usize; 2],
    each: [Yielded; 2],
    /// At which they yield so.
    loads: [f64; 2],
}

impl Two {
    /// Puts loads, approach and slope into what is found; from `estimate` on, if what is known leads nowhere. Gaps of both, and
    /// what each does to the other.
    #[inline]
    fn balance(
        mut self,
        springs: &impl Yielding,
        [near, far, c]: [f64; 3],
        total: f64,
        estimate: [f64; 2],
        found: &mut Balance,
    ) -> Option<()> {
        for round in 0..=STEPS {
            let [one, two] = self.each;
            let rate = one.rate + two.rate - 2.0 * c;
            let apart = (one.penetration - two.penetration) + (near - far) + c * (self.loads[1] - self.loads[0]);
            let step = -apart / rate;
            // Again with what both bend along the way.
            let step = -(apart + 0.5 * (one.bend - two.bend) * step * step) / rate;
            let mut loads = [self.loads[0] + step, self.loads[1] - step];
            if loads[0].min(loads[1]) < BRINK * total {
                if round > 0 {
                    return None;
                }
                // Which add up to the total, as those that follow do.
                loads = [estimate[0], total - estimate[0]];
            } else if round > 0 && self.left(step) <= LEFT * total * rate {
                let rates = [one.rate_after(step), two.rate_after(-step)];
                let determinant = rates[0] * rates[1] - c * c;
                if !(determinant > 0.0 && determinant.is_finite()) {
                    return None;
                }
                found.approach = one.penetration + near + c * loads[1] + step * (one.rate + 0.5 * one.bend * step);
                found.slope = (rates[0] + rates[1] - 2.0 * c) / determinant;
                (found.loads[self.springs[0]], found.loads[self.springs[1]]) = (loads[0], loads[1]);
                return Some(());
            }
            self.each =
                [springs.penetration(self.springs[0], loads[0]), springs.penetration(self.springs[1], loads[1])];
            self.loads = loads;
        }
        None
    }

    /// How far both may be from touching alike after a step that was taken with what they bend.
    fn left(&self, step: f64) -> f64 {
        let of = |side: usize| {
            // The third derivative of p ln p and of powers is about the second over the load.
            let order = if self.each[side].is_rough { 1.0 } else { step.abs() / self.loads[side] };
            self.each[side].bend.abs() * step * step * order
        };
        of(0) + of(1)
    }
}

/// What the loads of the others do to a spring.
fn by_others(coupling: Option<&Coupling>, loads: &[f64], at: usize) -> f64 {
    coupling.map_or(0.0, |coupling| {
        let others = loads.iter().enumerate().filter(|(other, _)| *other != at);
        others.map(|(other, load)| coupling[at][other] * load).sum()
    })
}

/// By how much loads and the approach change in a step, and how large what it leaves may be, as a load.
struct Step {
    change: PerSpring,
    shift: f64,
    left: f64,
}

/// A step of Newton's method, taken again with what penetrations bend along the way: what it leaves is of third order.
#[inline]
fn step(
    each: &Each,
    gaps: &[f64],
    coupling: Option<&Coupling>,
    total: f64,
    loaded: &[usize],
    found: &Balance,
) -> Option<Step> {
    let count = gaps.len();
    let (mut residual, mut rises) = ([0.0; MOST_SPRINGS], [0.0; MOST_SPRINGS]);
    let mut excess = -total;
    for &spring in loaded {
        residual[spring] = each[spring].penetration + by_others(coupling, &found.loads[..count], spring) + gaps[spring]
            - found.approach;
        rises[spring] = 1.0 / each[spring].rate;
        excess += found.loads[spring];
    }
    let (change, _) = linear_step(&residual, &rises, coupling, excess, loaded, count)?;
    for &spring in loaded {
        residual[spring] += 0.5 * each[spring].bend * change[spring] * change[spring];
    }
    let (change, shift) = linear_step(&residual, &rises, coupling, excess, loaded, count)?;
    let mut left = 0.0;
    for &spring in loaded {
        let (bend, change) = (each[spring].bend.abs(), change[spring].abs());
        // The third derivative of p ln p and of powers is about the second over the load.
        let order = if each[spring].is_rough { 1.0 } else { change / found.loads[spring] };
        left += rises[spring] * bend * change * change * order;
    }
    Some(Step { change, shift, left })
}

/// By how much the total changes with the approach, where the last step leads.
fn slope(each: &Each, coupling: Option<&Coupling>, loaded: &[usize], change: &PerSpring, count: usize) -> Option<f64> {
    let mut rises = [0.0; MOST_SPRINGS];
    for &spring in loaded {
        rises[spring] = 1.0 / each[spring].rate_after(change[spring]);
    }
    match coupling {
        None => Some(loaded.iter().map(|spring| rises[*spring]).sum()),
        Some(coupling) => Some(Bordered::solve(coupling, &rises, &[0.0; MOST_SPRINGS], count)?.slope),
    }
}

/// By how much loads and the approach change as if penetrations were linear.
#[inline]
fn linear_step(
    residual: &PerSpring,
    rises: &PerSpring,
    coupling: Option<&Coupling>,
    excess: f64,
    loaded: &[usize],
    count: usize,
) -> Option<(PerSpring, f64)> {
    let mut change = [0.0; MOST_SPRINGS];
    if let Some(coupling) = coupling {
        let solved = Bordered::solve(coupling, rises, residual, count)?;
        let shift = (-excess - solved.offset) / solved.slope;
        for &spring in loaded {
            change[spring] = solved.particular[spring] + solved.unit[spring] * shift;
        }
        return Some((change, shift));
    }
    let (mut slope, mut undone) = (0.0, 0.0);
    for &spring in loaded {
        slope += rises[spring];
        undone += residual[spring] * rises[spring];
    }
    let shift = (undone - excess) / slope;
    for &spring in loaded {
        change[spring] = (shift - residual[spring]) * rises[spring];
    }
    Some((change, shift))
}

#[cfg(test)]
mod tests {
    use super::super::complementarity::{self, Springs};
    use super::*;

    /// w = s p^¾ and back.
    struct Powers(PerSpring);

    impl Yielding for Powers {
        fn penetration(&self, spring: usize, load: f64) -> Yielded {
            let penetration = self.0[spring] * load.powf(0.75);
            let bend = -0.1875 * penetration / (load * load);
            Yielded { penetration, rate: 0.75 * penetration / load, bend, is_rough: false }
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
            for gaps in [
                vec![0.0],
                vec![0.0, 0.4],
                vec![0.3, 0.0, 0.1],
                vec![0.0, 0.7, 2.0, 0.2],
                vec![0.0, 9.0],
                vec![0.0, 9.0, 0.1],
            ] {
                for total in [0.3, 1.0, 3.0, 10.0] {
                    let chosen = coupled.then_some(&coupling);
                    let Some(found) = balance(&springs, &gaps, chosen, total) else { continue };
                    answers += 1;
                    let above = 2.0 * springs.penetration(3, total).penetration + 10.0;
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
