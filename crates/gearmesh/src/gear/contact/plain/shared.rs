//! How a load spreads over two pairs of plain laws.
//!
//! The unknown is the share λ of the first: with v(λ) = w(λP)/P of each, f(λ) = v₁(λ) − v₂(1 − λ) + (g₁ − g₂)/P grows from
//! f(0) to f(1), and is 0 where both touch alike. At equal shares no logarithm is left in f, and it is nearly straight, so that
//! it leads to within some 10⁻³ of the share; from there one or two steps of fourth order are enough. Must not know: what
//! the gaps are.

use std::f64::consts::LN_2;

use super::PlainLaw;
use crate::numeric::logarithm::Known;

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

/// How both carry a load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shared {
    /// From where gaps are counted \[m\].
    pub approach: f64,
    /// d load per width/d approach \[Pa\].
    pub slope: f64,
    /// The share of the first pair.
    pub share: f64,
    /// By how much each yields; minus the distance that is still open where it carries nothing \[m\].
    pub penetration: [f64; 2],
}

/// The law of one pair, in shares of the load.
#[derive(Clone, Copy)]
struct Scaled {
    /// T − β ln P.
    total: f64,
    /// R P.
    rest: f64,
    /// β.
    rate: f64,
}

impl Scaled {
    /// v and its first four derivatives at a share, the last without its sign.
    #[inline]
    fn rates(&self, share: f64) -> [f64; 5] {
        let Self { total, rest, rate } = *self;
        let (here, inverse) = (total - rate * libm::log(share), 1.0 / share);
        let (bent, more) = (rate * inverse, rest * share);
        let twist = bent * inverse;
        [share * (here + more), (here - rate) + 2.0 * more, 2.0 * rest - bent, twist, 2.0 * (twist * inverse)]
    }

    /// v(1).
    #[inline]
    fn whole(&self) -> f64 {
        self.total + self.rest
    }
}

/// Loads under a load per width P > 0, of pairs behind gaps ≥ 0 of which one is 0; `rate`: β. None where a law does not hold, or
/// one carries next to nothing.
#[must_use]
#[inline]
pub fn shared(laws: &[PlainLaw; 2], rate: f64, gaps: [f64; 2], load: Known) -> Option<Shared> {
    let Known { number: whole, log } = load;
    let [one, two] = laws.map(|law| Scaled { total: law.total - rate * log, rest: law.rest * whole, rate });
    let apart = (gaps[0] - gaps[1]) / whole;
    // f(0) and f(1): where one is open, the other has all of it.
    let ends = [apart - two.whole(), apart + one.whole()];
    if ends[0] >= 0.0 || ends[1] <= 0.0 {
        let (index, alone) = if ends[0] >= 0.0 { (1, two) } else { (0, one) };
        if !laws[index].holds(whole) {
            return None;
        }
        let approach = whole * alone.whole() + gaps[index];
        let slope = 1.0 / ((alone.total - rate) + 2.0 * alone.rest);
        let penetration = gaps.map(|gap| approach - gap);
        return Some(Shared { approach, slope, share: if index == 0 { 1.0 } else { 0.0 }, penetration });
    }
    let mut share = start([one, two], apart, ends);
    for _ in 0..STEPS {
        let rest = 1.0 - share;
        let [v1, rate1, bend1, twist1, fourth1] = one.rates(share);
        let [v2, rate2, bend2, twist2, fourth2] = two.rates(rest);
        // f + f′ x + bend x² + twist x³ = 0, over f′: nearly straight.
        let inverse = 1.0 / (rate1 + rate2);
        let (bend, twist) = (0.5 * inverse * (bend1 - bend2), SIXTH * inverse * (twist1 + twist2));
        let straight = ((v2 - v1) - apart) * inverse;
        let mut step = straight;
        for _ in 0..3 {
            step = straight - step * step * (bend + twist * step);
        }
        let (next, other) = (share + step, rest - step);
        if !(next > SHORTEST * share && other > SHORTEST * rest) {
            // Farther than what is known here reaches; f rises, so that at least the side is right.
            share = if step < 0.0 { SHORTEST * share } else { 1.0 - SHORTEST * rest };
            continue;
        }
        let left = (fourth1 + fourth2) * inverse * ((step * step) * (step * step));
        if left > 24.0 * LEFT || step.abs() > CLOSE * share.min(rest) {
            share = next;
            continue;
        }
        let holds = laws[0].holds(next * whole) && laws[1].holds(other * whole);
        if !holds || next.min(other) < LEAST {
            return None;
        }
        let yielded = v1 + step * (rate1 + step * (0.5 * bend1 + SIXTH * step * twist1));
        let rates = [
            rate1 + step * (bend1 + step * (0.5 * twist1 - SIXTH * step * fourth1)),
            rate2 - step * (bend2 - step * (0.5 * twist2 + SIXTH * step * fourth2)),
        ];
        let approach = whole * yielded + gaps[0];
        let slope = 1.0 / rates[0] + 1.0 / rates[1];
        return Some(Shared { approach, slope, share: next, penetration: gaps.map(|gap| approach - gap) });
    }
    None
}

/// About the share, from what is known at equal ones: within what both ends say of it.
#[inline]
fn start([one, two]: [Scaled; 2], apart: f64, [from, to]: [f64; 2]) -> f64 {
    let rate = one.rate;
    let value = 0.5 * (one.total - two.total) + 0.25 * (one.rest - two.rest) + apart;
    let rise = (one.total + two.total) + 2.0 * (LN_2 - 1.0) * rate + (one.rest + two.rest);
    let inverse = 1.0 / rise;
    let straight = value * inverse;
    let bent = straight * straight * ((one.rest - two.rest) - 4.0 / 3.0 * rate * straight) * inverse;
    let steepest = (one.total + two.total) + LARGEST_LOG * rate + 2.0 * (one.rest.abs() + two.rest.abs());
    let least = 1.0 / steepest;
    let (least, most) = ((-from * least).max(LEAST), 1.0 - (to * least).max(LEAST));
    (0.5 - straight - bent).clamp(least, most.max(least))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::lambert;

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
                        let Some(Shared { approach, slope, share, penetration }) = shared(&laws, rate, gaps, load)
                        else {
                            assert!(part.abs() > 0.98, "{part}");
                            continue;
                        };
                        found += 1;
                        let loads = [share * whole, (1.0 - share) * whole];
                        let mut stiffness = 0.0;
                        for pair in 0..2 {
                            assert!((penetration[pair] - (approach - gaps[pair])).abs() < 1e-15 * approach);
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

    /// Tier: invariant; the pairs in the other order, and a law that ends below what a pair carries.
    #[test]
    fn order_makes_no_difference_and_no_law_is_taken_beyond_its_end() {
        let law = |total: f64, last: f64| PlainLaw { total, rest: 2e-19, last };
        let (laws, load) = ([law(5e-11, 1e7), law(8e-11, 1e7)], Known::new(4e5));
        for gap in [0.0, 1e-6, 1e-5, 3e-5, 1e-3] {
            let one = shared(&laws, 1e-12, [0.0, gap], load).expect("both hold");
            let other = shared(&[laws[1], laws[0]], 1e-12, [gap, 0.0], load).expect("both hold");
            assert!(
                (one.approach / other.approach - 1.0).abs() < 1e-15 && (one.slope / other.slope - 1.0).abs() < 1e-13
            );
            assert!((one.share + other.share - 1.0).abs() < 1e-15, "{gap}");
            let most = one.share.max(1.0 - one.share) * load.number;
            for (last, holds) in [(most * 1.001, true), (most * 0.999, false)] {
                let ending = [law(5e-11, last), law(8e-11, last)];
                assert_eq!(shared(&ending, 1e-12, [0.0, gap], load).is_some(), holds, "{gap}");
            }
        }
        assert!(shared(&[PlainLaw::NONE; 2], 1e-12, [0.0; 2], load).is_none());
        assert!(shared(&laws, 1e-12, [f64::NAN, 0.0], load).is_none());
    }

    /// Equal laws without a gap share alike; what is nearly alike is found from there in a step.
    #[test]
    fn equal_pairs_have_half_each() {
        let law = PlainLaw { total: 6e-11, rest: 0.0, last: 1e7 };
        let found = shared(&[law; 2], 1e-12, [0.0; 2], Known::new(1e5)).expect("it holds");
        assert!((found.share - 0.5).abs() < 1e-16);
        // w = p (T − β ln p) is that of Lambert's function.
        let root = lambert::larger_root(6e-11 / 1e-12 + libm::log(1e-12) - 1.0 - libm::log(found.approach));
        assert!((found.approach / (1e-12 * root) / 5e4 - 1.0).abs() < 1e-14);
    }
}
