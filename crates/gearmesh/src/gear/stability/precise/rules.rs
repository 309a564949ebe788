//! Quadrature and interpolation in twice the precision: Gauss–Legendre rules and panels at Chebyshev nodes.
//!
//! Sources: Davis and Rabinowitz, Methods of Numerical Integration, 2.7; Berrut and Trefethen, SIAM Review 46 (2004) 501
//! (barycentric formula);
//! Takahasi and Mori, Publ. RIMS Kyoto 9 (1974) 721 (double exponential rule). Must not know: what is integrated.

use crate::numeric::double_double::Double;

/// Step of the double exponential rule.
const STEP: f64 = 0.06;
/// Steps to either side: to 1e-20 from the ends.
const STEPS: i32 = 56;

/// Points and weights on −1..1, one for long intervals, one for the short ones between nodes, and Chebyshev nodes.
pub struct Rule {
    /// Points and weights on 0..1 for what has a logarithm at the ends.
    singular: Vec<(Double, Double)>,
    long: Vec<(Double, Double)>,
    short: Vec<(Double, Double)>,
    /// Node and barycentric weight, ascending.
    chebyshev: Vec<(Double, Double)>,
}

impl Rule {
    /// With `points` on a long interval, half as many on a short one, and `nodes` on a panel.
    pub fn new(points: usize, nodes: usize) -> Self {
        let angle = |k: usize| Double::PI * (2 * k + 1) as f64 / (2 * nodes) as f64;
        let chebyshev = (0..nodes).map(|k| {
            let (sine, cosine) = angle(k).sine_cosine();
            (-cosine, if k % 2 == 0 { sine } else { -sine })
        });
        Self {
            long: legendre(points),
            short: legendre(points / 2),
            chebyshev: chebyshev.collect(),
            singular: double_exponential(),
        }
    }

    /// Adds the integrals of several functions from `from` to `to`.
    pub fn integrate<const N: usize>(
        &self,
        from: Double,
        to: Double,
        sums: &mut [Double; N],
        function: impl Fn(Double) -> [Double; N],
    ) {
        accumulate(&self.long, from, to, sums, function);
    }

    /// The same over a part of a panel.
    pub fn short<const N: usize>(
        &self,
        from: Double,
        to: Double,
        sums: &mut [Double; N],
        function: impl Fn(Double) -> [Double; N],
    ) {
        accumulate(&self.short, from, to, sums, function);
    }

    /// Points and weights on 0..1, of a rule that is exact for high powers of the place, or for its logarithm too.
    pub fn unit(&self, singular: bool) -> Vec<(Double, Double)> {
        if singular {
            return self.singular.clone();
        }
        // u²(3 − 2u) and its rate: the 3/2 power of a distance from either end is smooth in u.
        let graded = self.long.iter().map(|(node, weight)| {
            let u = (*node + 1.0).half();
            let share = u.square() * (Double::from(3.0) - u.times_power_of_two(2.0));
            (share, weight.half() * u * (Double::ONE - u) * 6.0)
        });
        graded.collect()
    }
}

fn accumulate<const N: usize>(
    rule: &[(Double, Double)],
    from: Double,
    to: Double,
    sums: &mut [Double; N],
    function: impl Fn(Double) -> [Double; N],
) {
    let (middle, half) = ((from + to).half(), (to - from).half());
    for (node, weight) in rule {
        for (sum, value) in sums.iter_mut().zip(function(middle + half * *node)) {
            *sum += value * (*weight * half);
        }
    }
}

/// 1/(1 + exp(−π sinh t)) in equal steps of t.
fn double_exponential() -> Vec<(Double, Double)> {
    let node = |index: i32| {
        let t = Double::from(STEP) * f64::from(index);
        let (up, down) = (t.exponential(), (-t).exponential());
        let decay = (-(Double::PI * (up - down).half())).exponential();
        let share = Double::ONE / (Double::ONE + decay);
        (share, share.square() * decay * Double::PI * (up + down).half() * STEP)
    };
    (-STEPS..=STEPS).map(node).collect()
}

/// The zeros of a Legendre polynomial by Newton's method, and 2/((1 − x²) P′²).
fn legendre(count: usize) -> Vec<(Double, Double)> {
    let polynomial = |x: Double| {
        let (mut before, mut value) = (Double::ONE, x);
        for k in 2..=count {
            let k = k as f64;
            (before, value) = (value, (x * value * (2.0 * k - 1.0) - before * (k - 1.0)) / k);
        }
        (value, (x * value - before) * count as f64 / (x.square() - 1.0))
    };
    let node = |index: usize| {
        let guess = -libm::cos(std::f64::consts::PI * (index as f64 + 0.75) / (count as f64 + 0.5));
        let mut x = Double::from(guess);
        for _ in 0..6 {
            let (value, rate) = polynomial(x);
            x -= value / rate;
        }
        let rate = polynomial(x).1;
        (x, Double::from(2.0) / ((Double::ONE - x.square()) * rate.square()))
    };
    (0..count).map(node).collect()
}

/// A function between two ends, known at Chebyshev nodes.
pub(super) struct Panel {
    pub upper: Double,
    points: Vec<(Double, Double, Double)>,
}

impl Panel {
    pub(super) fn nodes(from: Double, to: Double, rule: &Rule) -> Vec<Double> {
        let (middle, half) = ((from + to).half(), (to - from).half());
        rule.chebyshev.iter().map(|(node, _)| middle + half * *node).collect()
    }

    pub(super) fn new(to: Double, nodes: Vec<Double>, values: Vec<Double>, rule: &Rule) -> Self {
        let points = nodes.into_iter().zip(values).zip(&rule.chebyshev);
        Self { upper: to, points: points.map(|((node, value), (_, weight))| (node, value, *weight)).collect() }
    }

    pub(super) fn value(&self, x: Double) -> Double {
        let (mut above, mut below) = (Double::ZERO, Double::ZERO);
        for (node, value, weight) in &self.points {
            let distance = x - *node;
            if distance.high == 0.0 {
                return *value;
            }
            let part = *weight / distance;
            above += part * *value;
            below += part;
        }
        above / below
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rules() -> Rule {
        Rule::new(32, 12)
    }

    fn power(x: Double, exponent: usize) -> Double {
        (0..exponent).fold(Double::ONE, |product, _| product * x)
    }

    /// Tier: closed form; n points are exact for x^k up to k = 2n − 1, and no further.
    #[test]
    fn legendre_rules_are_exact_as_far_as_they_must_be() {
        let (from, to) = (Double::from(-1.0), Double::from(2.0));
        for (short, last) in [(false, 63), (true, 31)] {
            for exponent in [0, 1, 2, 5, 16, last - 1, last, last + 1] {
                let mut sum = [Double::ZERO];
                let function = |x: Double| [power(x, exponent)];
                if short {
                    rules().short(from, to, &mut sum, function);
                } else {
                    rules().integrate(from, to, &mut sum, function);
                }
                let exact = (power(to, exponent + 1) - power(from, exponent + 1)) / (exponent + 1) as f64;
                let error = ((sum[0] - exact) / exact).high.abs();
                assert_eq!(error < 1e-27, exponent <= last, "x^{exponent}: {error:e}");
            }
        }
    }

    /// Tier: closed form; powers of 3/2 at either end by the one, the logarithm by the other.
    #[test]
    fn unit_rules_integrate_what_is_not_smooth_at_the_ends() {
        let error = |singular: bool, function: fn(Double) -> Double, exact: f64| {
            let sum = rules().unit(singular).into_iter().fold(Double::ZERO, |sum, (x, w)| sum + w * function(x));
            (sum - exact).high.abs()
        };
        let rooted = |x: Double| x * x.sqrt() * 2.5;
        assert!(error(false, |_| Double::ONE, 1.0) < 1e-29);
        assert!(error(false, rooted, 1.0) < 1e-25, "{:e}", error(false, rooted, 1.0));
        let mirrored = |x: Double| (Double::ONE - x) * (Double::ONE - x).sqrt() * 2.5;
        assert!(error(false, mirrored, 1.0) < 1e-25, "{:e}", error(false, mirrored, 1.0));
        // The last step is 1e-20 from the end, where the logarithm is −46.
        for (function, exact) in [
            ((|_| Double::ONE) as fn(Double) -> Double, 1.0),
            (|x| x.logarithm(), -1.0),
            (|x| x * x.logarithm(), -0.25),
            (|x| x.sqrt() * 1.5, 1.0),
        ] {
            assert!(error(true, function, exact) < 1e-17, "{exact}: {:e}", error(true, function, exact));
        }
    }

    /// Tier: closed form; n nodes carry every polynomial of degree n − 1, at the nodes and between.
    #[test]
    fn a_panel_is_the_polynomial_through_its_nodes() {
        let rule = rules();
        let (from, to) = (Double::from(0.5), Double::from(0.8));
        let nodes = Panel::nodes(from, to, &rule);
        assert!(nodes.windows(2).all(|pair| pair[0].high < pair[1].high) && nodes.len() == 12);
        let values = nodes.iter().map(|x| power(*x, 11)).collect();
        let panel = Panel::new(to, nodes.clone(), values, &rule);
        let between = (0..=10).map(|part| from + (to - from) * (0.1 * f64::from(part)));
        for x in between.chain(nodes) {
            let error = (panel.value(x) / power(x, 11) - 1.0).high.abs();
            assert!(error < 1e-26, "{}: {error:e}", x.high);
        }
    }
}
