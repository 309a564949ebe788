//! How a load spreads over two pairs of plain laws, at several positions side by side.
//!
//! The unknown is the share λ of the first: with v(λ) = w(λP)/P of each, f(λ) = v₁(λ) − v₂(1 − λ) + (g₁ − g₂)/P grows from
//! f(0) to f(1), and is 0 where both touch alike. At equal shares no logarithm is left in f, and it is nearly straight, so that
//! it leads to within some 10⁻³ of the share; from there one or two steps of fourth order are enough. What a position has does
//! not depend on which others are beside it: it stays where it has settled. Must not know: what the gaps are.

use std::f64::consts::LN_2;

use super::{PlainLaw, PlainLaws};
use crate::numeric::logarithm::{self, Known};

/// A share below which another way is taken: its logarithm would need more and more steps.
const LEAST: f64 = 1e-6;
/// −ln of it, and a little more.
const LARGEST_LOG: f64 = 14.0;
/// How far a share may be off after the last step.
const LEFT: f64 = 1e-16;
/// The last step, over the smaller share: the slope is then good to about the fourth power of it.
const CLOSE: f64 = 1e-2;
/// The most steps; one or two are taken.
const STEPS: usize = 12;
const SIXTH: f64 = 1.0 / 6.0;
/// What a step leaves of a share at least.
const SHORTEST: f64 = 0.3;

/// How both carry a load, at each position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shared<const M: usize> {
    /// From where gaps are counted \[m\].
    pub approach: [f64; M],
    /// d load per width/d approach \[Pa\].
    pub slope: [f64; M],
    /// The share of the first pair.
    pub share: [f64; M],
}

/// Both laws in shares of the load, and how far they stand apart; each an array of what each position has.
struct Pairs<const M: usize> {
    /// β.
    rate: f64,
    /// T − β ln P of each pair.
    totals: [[f64; M]; 2],
    /// R P of each pair.
    rests: [[f64; M]; 2],
    /// (g₁ − g₂)/P.
    apart: [f64; M],
    /// f(0) and f(1): where one is open, the other has all of it.
    ends: [[f64; M]; 2],
}

/// Where a step leads.
struct Step<const M: usize> {
    /// Whether it was the last.
    is_last: [bool; M],
    /// From where to go on: where it was the last, from where it came, so that another step changes nothing.
    from: [f64; M],
    /// What there is if it was the last: the share, v₁ of it, and d load per width/d approach.
    share: [f64; M],
    yielded: [f64; M],
    slope: [f64; M],
}

/// Loads under a load per width P > 0, of pairs behind gaps ≥ 0 of which one is 0; `rate`: β. None where at any position a law
/// does not hold, or one carries next to nothing.
#[must_use]
#[inline]
pub fn shared<const M: usize>(
    laws: &[PlainLaws<M>; 2],
    rate: f64,
    gaps: &[[f64; M]; 2],
    load: Known,
) -> Option<Shared<M>> {
    let pairs = Pairs::new(laws, rate, gaps, load);
    if !(0..M).any(|m| pairs.is_alone(m)) {
        return pairs.both(laws, gaps, load.number);
    }
    let mut found = Shared { approach: [0.0; M], slope: [0.0; M], share: [0.0; M] };
    for m in 0..M {
        let (laws, gaps) = (laws.each_ref().map(|laws| laws.at(m)), [gaps[0][m], gaps[1][m]]);
        let pairs = pairs.at(m);
        let at = if pairs.is_alone(0) {
            pairs.alone(&laws, gaps, load.number)?
        } else {
            pairs.both(&laws.map(PlainLaws::from), &gaps.map(|gap| [gap]), load.number)?
        };
        (found.approach[m], found.slope[m], found.share[m]) = (at.approach[0], at.slope[0], at.share[0]);
    }
    Some(found)
}

impl<const M: usize> Pairs<M> {
    #[inline]
    fn new(laws: &[PlainLaws<M>; 2], rate: f64, gaps: &[[f64; M]; 2], Known { number: whole, log }: Known) -> Self {
        let (mut totals, mut rests) = ([[0.0; M]; 2], [[0.0; M]; 2]);
        let (mut apart, mut ends) = ([0.0; M], [[0.0; M]; 2]);
        for pair in 0..2 {
            for m in 0..M {
                totals[pair][m] = laws[pair].totals[m] - rate * log;
                rests[pair][m] = laws[pair].rests[m] * whole;
            }
        }
        let per_load = 1.0 / whole;
        for m in 0..M {
            apart[m] = (gaps[0][m] - gaps[1][m]) * per_load;
            ends[0][m] = apart[m] - (totals[1][m] + rests[1][m]);
            ends[1][m] = apart[m] + (totals[0][m] + rests[0][m]);
        }
        Self { rate, totals, rests, apart, ends }
    }

    /// What there is at one position.
    #[inline]
    fn at(&self, m: usize) -> Pairs<1> {
        let of = |values: &[f64; M]| [values[m]];
        Pairs {
            rate: self.rate,
            totals: self.totals.each_ref().map(of),
            rests: self.rests.each_ref().map(of),
            apart: of(&self.apart),
            ends: self.ends.each_ref().map(of),
        }
    }

    /// Whether one pair carries all of it at a position.
    #[inline]
    fn is_alone(&self, m: usize) -> bool {
        self.ends[0][m] >= 0.0 || self.ends[1][m] <= 0.0
    }

    /// Where both carry some of it.
    #[inline]
    fn both(&self, laws: &[PlainLaws<M>; 2], gaps: &[[f64; M]; 2], whole: f64) -> Option<Shared<M>> {
        let mut share = self.start();
        for _ in 0..STEPS {
            let step = self.step(&share);
            if step.is_last != [true; M] {
                share = step.from;
                continue;
            }
            let mut approach = [0.0; M];
            let mut holds = true;
            for m in 0..M {
                let (first, second) = (step.share[m], 1.0 - step.share[m]);
                holds &= first * whole < laws[0].lasts[m] && second * whole < laws[1].lasts[m];
                holds &= first >= LEAST && second >= LEAST;
                approach[m] = whole * step.yielded[m] + gaps[0][m];
            }
            return holds.then_some(Shared { approach, slope: step.slope, share: step.share });
        }
        None
    }

    /// From shares to what the first terms of f say of where it is 0: it is nearly straight.
    #[inline]
    fn step(&self, shares: &[f64; M]) -> Step<M> {
        let mut rests = [0.0; M];
        for m in 0..M {
            rests[m] = 1.0 - shares[m];
        }
        let logs = [logarithm::of_each(shares), logarithm::of_each(&rests)];
        let mut to = Step { is_last: [false; M], from: [0.0; M], share: [0.0; M], yielded: [0.0; M], slope: [0.0; M] };
        for m in 0..M {
            let (share, rest) = (shares[m], rests[m]);
            let [v1, rate1, bend1, twist1, fourth1] = self.rates(0, m, share, logs[0][m]);
            let [v2, rate2, bend2, twist2, fourth2] = self.rates(1, m, rest, logs[1][m]);
            // f + f′ x + bend x² + twist x³ = 0, over f′.
            let inverse = 1.0 / (rate1 + rate2);
            let (bend, twist) = (0.5 * inverse * (bend1 - bend2), SIXTH * inverse * (twist1 + twist2));
            let straight = ((v2 - v1) - self.apart[m]) * inverse;
            let mut step = straight;
            for _ in 0..3 {
                step = straight - step * step * (bend + twist * step);
            }
            let (next, other) = (share + step, rest - step);
            let is_within = next > SHORTEST * share && other > SHORTEST * rest;
            let left = (fourth1 + fourth2) * inverse * ((step * step) * (step * step));
            let is_last = is_within && left <= 24.0 * LEFT && step.abs() <= CLOSE * share.min(rest);
            // Farther than what is known here reaches; f rises, so that at least the side is right.
            let beyond = if step < 0.0 { SHORTEST * share } else { 1.0 - SHORTEST * rest };
            let onwards = if is_within { next } else { beyond };
            (to.is_last[m], to.share[m]) = (is_last, next);
            to.from[m] = if is_last { share } else { onwards };
            to.yielded[m] = v1 + step * (rate1 + step * (0.5 * bend1 + SIXTH * step * twist1));
            let slope1 = rate1 + step * (bend1 + step * (0.5 * twist1 - SIXTH * step * fourth1));
            let slope2 = rate2 - step * (bend2 - step * (0.5 * twist2 + SIXTH * step * fourth2));
            to.slope[m] = (slope1 + slope2) / (slope1 * slope2);
        }
        to
    }

    /// v of a pair and its first four derivatives at a share, the last without its sign.
    #[inline]
    fn rates(&self, pair: usize, m: usize, share: f64, log: f64) -> [f64; 5] {
        let (here, inverse, more) = (self.totals[pair][m] - self.rate * log, 1.0 / share, self.rests[pair][m] * share);
        let bent = self.rate * inverse;
        let twist = bent * inverse;
        [
            share * (here + more),
            (here - self.rate) + 2.0 * more,
            2.0 * self.rests[pair][m] - bent,
            twist,
            2.0 * (twist * inverse),
        ]
    }

    /// About the share, from what is known at equal ones: within what both ends say of it.
    #[inline]
    fn start(&self) -> [f64; M] {
        let ([ones, twos], [rests, others]) = (&self.totals, &self.rests);
        let rate = self.rate;
        let mut shares = [0.0; M];
        for m in 0..M {
            let (totals, rest) = (ones[m] + twos[m], rests[m] - others[m]);
            let value = 0.5 * (ones[m] - twos[m]) + 0.25 * rest + self.apart[m];
            let inverse = 1.0 / (totals + 2.0 * (LN_2 - 1.0) * rate + (rests[m] + others[m]));
            let straight = value * inverse;
            let bent = straight * straight * (rest - 4.0 / 3.0 * rate * straight) * inverse;
            let least = 1.0 / (totals + LARGEST_LOG * rate + 2.0 * (rests[m].abs() + others[m].abs()));
            let (from, to) = ((-self.ends[0][m] * least).max(LEAST), 1.0 - (self.ends[1][m] * least).max(LEAST));
            shares[m] = (0.5 - straight - bent).max(from).min(to.max(from));
        }
        shares
    }
}

impl Pairs<1> {
    /// Where one pair has all of it.
    fn alone(&self, laws: &[PlainLaw; 2], gaps: [f64; 2], whole: f64) -> Option<Shared<1>> {
        let pair = usize::from(self.ends[0][0] >= 0.0);
        if !laws[pair].holds(whole) {
            return None;
        }
        let (total, rest) = (self.totals[pair][0], self.rests[pair][0]);
        let approach = whole * (total + rest) + gaps[pair];
        let slope = 1.0 / ((total - self.rate) + 2.0 * rest);
        Some(Shared { approach: [approach], slope: [slope], share: [if pair == 0 { 1.0 } else { 0.0 }] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::lambert;

    fn one(laws: [PlainLaw; 2], rate: f64, gaps: [f64; 2], load: Known) -> Option<Shared<1>> {
        shared(&laws.map(PlainLaws::from), rate, &gaps.map(|gap| [gap]), load)
    }

    /// Tier: second method; loads of both at the approach by each law's own inverse, from touching alike to next to nothing.
    #[test]
    fn both_carry_what_they_do_at_the_approach() {
        let rate = 1e-12;
        let rates = [rate, libm::log(rate)];
        let mut found = 0;
        for totals in [[6e-11, 6e-11], [4.2e-11, 9e-11], [1.2e-10, 5e-11]] {
            for rest in [[0.0; 2], [1e-19, -4e-20]] {
                let law = |index: usize| PlainLaw { total: totals[index], rest: rest[index], last: 1e7 };
                let laws = [law(0), law(1)];
                for whole in [1.0, 3e2, 8e4, 2e6] {
                    let load = Known::new(whole);
                    let alone = laws.map(|law| law.rates_at(rate, whole, load.log)[0]);
                    for index in 0..=400 {
                        // From one pair alone to the other, closer and closer to where one is lifted off.
                        let part = f64::from(index - 200) / 200.0;
                        let open = if part < 0.0 { -alone[1] } else { alone[0] } * (1.0 - (1.0 - part.abs()).powi(3));
                        let gaps = [f64::max(-open, 0.0), f64::max(open, 0.0)];
                        let Some(Shared { approach: [approach], slope: [slope], share: [share] }) =
                            one(laws, rate, gaps, load)
                        else {
                            assert!(part.abs() > 0.98, "{part}");
                            continue;
                        };
                        found += 1;
                        let penetration = gaps.map(|gap| approach - gap);
                        let loads = [share * whole, (1.0 - share) * whole];
                        let mut stiffness = 0.0;
                        for pair in 0..2 {
                            if penetration[pair] <= 0.0 {
                                assert!(loads[pair] == 0.0);
                                continue;
                            }
                            let (exact, rise) = laws[pair].load(rates, penetration[pair]).expect("it holds");
                            assert!((loads[pair] - exact).abs() < 3e-14 * whole, "{part}: {loads:?}, {exact}");
                            stiffness += rise;
                        }
                        assert!((slope / stiffness - 1.0).abs() < 1e-9, "{part}: {slope} {stiffness}");
                    }
                }
            }
        }
        assert!(found > 24 * 390, "{found}");
    }

    /// Tier: second method, to the last bit; each position alone, whatever stands beside it: one that settles at once, one that
    /// takes several steps, one where a pair is open.
    #[test]
    fn positions_have_what_each_has_alone() {
        let (rate, load) = (1e-12, Known::new(4e5));
        let law = |total: f64| PlainLaw { total, rest: 2e-19, last: 1e7 };
        let places: Vec<_> = (0..60)
            .map(|index| {
                let open = 4e5 * 5.5e-11 * (f64::from(index * 37 % 60) / 30.0 - 1.0).powi(3);
                ([law(6e-11), law(6e-11 + 1e-12 * f64::from(index % 7))], [f64::max(-open, 0.0), f64::max(open, 0.0)])
            })
            .collect();
        let mut open = 0;
        for places in places.windows(5) {
            let each = |of: &dyn Fn(usize) -> f64| -> [f64; 5] { std::array::from_fn(of) };
            let laws = [0, 1].map(|pair| PlainLaws {
                totals: each(&|m| places[m].0[pair].total),
                rests: each(&|m| places[m].0[pair].rest),
                lasts: each(&|m| places[m].0[pair].last),
            });
            let gaps = [0, 1].map(|pair| each(&|m| places[m].1[pair]));
            let found = shared(&laws, rate, &gaps, load).expect("all hold");
            for (m, (laws, gaps)) in places.iter().enumerate() {
                let alone = one(*laws, rate, *gaps, load).expect("it holds");
                let at = Shared { approach: [found.approach[m]], slope: [found.slope[m]], share: [found.share[m]] };
                assert_eq!(at, alone);
                open += u32::from(alone.share[0] <= 0.0 || alone.share[0] >= 1.0);
            }
        }
        assert!((5..100).contains(&open), "{open}");
    }

    /// Tier: invariant; the pairs in the other order, and a law that ends below what a pair carries.
    #[test]
    fn order_makes_no_difference_and_no_law_is_taken_beyond_its_end() {
        let law = |total: f64, last: f64| PlainLaw { total, rest: 2e-19, last };
        let (laws, load) = ([law(5e-11, 1e7), law(8e-11, 1e7)], Known::new(4e5));
        for gap in [0.0, 1e-6, 1e-5, 3e-5, 1e-3] {
            let Shared { approach: [approach], slope: [slope], share: [share] } =
                one(laws, 1e-12, [0.0, gap], load).expect("both hold");
            let other = one([laws[1], laws[0]], 1e-12, [gap, 0.0], load).expect("both hold");
            assert!((approach / other.approach[0] - 1.0).abs() < 1e-15 && (slope / other.slope[0] - 1.0).abs() < 1e-13);
            assert!((share + other.share[0] - 1.0).abs() < 1e-15, "{gap}");
            let most = share.max(1.0 - share) * load.number;
            for (last, holds) in [(most * 1.001, true), (most * 0.999, false)] {
                let ending = [law(5e-11, last), law(8e-11, last)];
                assert_eq!(one(ending, 1e-12, [0.0, gap], load).is_some(), holds, "{gap}");
            }
        }
        assert!(one([PlainLaw::NONE; 2], 1e-12, [0.0; 2], load).is_none());
        assert!(one(laws, 1e-12, [f64::NAN, 0.0], load).is_none());
    }

    /// Equal laws without a gap share alike; what is nearly alike is found from there in a step.
    #[test]
    fn equal_pairs_have_half_each() {
        let law = PlainLaw { total: 6e-11, rest: 0.0, last: 1e7 };
        let found = one([law; 2], 1e-12, [0.0; 2], Known::new(1e5)).expect("it holds");
        assert!((found.share[0] - 0.5).abs() < 1e-16);
        // w = p (T − β ln p) is that of Lambert's function.
        let root = lambert::larger_root(6e-11 / 1e-12 + libm::log(1e-12) - 1.0 - libm::log(found.approach[0]));
        assert!((found.approach[0] / (1e-12 * root) / 5e4 - 1.0).abs() < 1e-14);
    }
}
