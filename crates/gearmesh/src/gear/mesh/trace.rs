//! A function over the mesh cycle as values on smooth spans, and what follows: extrema, quadrature nodes.
//!
//! Every span has its values at eight Gauss–Lobatto nodes, both ends included. A pair with a crowned face takes up load
//! as the 3/2 power of its penetration, so where a span starts or ends with a first or last touch its nodes are graded
//! quadratically and the function is smooth in the graded variable. Extrema are bracketed by nodes and refined on the
//! function itself, so their values do not depend on where the nodes happen to lie. Must not know: what the function is.

use crate::numeric::extremum::maximum;
use crate::numeric::harmonics::Node;
use crate::numeric::lobatto::{Rule, legendre};

/// Nodes of a span.
pub const NODES: usize = 8;

/// How far above a node the function may rise before the next one, in units of the falls from that node to its neighbours.
const OVERSHOOT: f64 = 4.0;
/// Distance of the probes that tell a kink from a maximum nearby, in distances of nodes.
const PROBE: f64 = 1e-6;
/// Accuracy of the place of an extremum, in distances of nodes; the error of its value is of second order in it.
const PLACE: f64 = 1e-5;
/// The same where there may be as many extrema as nodes, and how many of them are refined: those that nodes say are the highest. The
/// nodes themselves miss more of the others.
const FEW_PLACE: f64 = 1e-3;
const MOST: usize = 2;

/// Nodes and weights on the unit interval.
#[derive(Clone, Debug)]
pub struct SpanRule {
    /// Gauss–Lobatto nodes, ascending, from 0 to 1.
    pub nodes: [f64; NODES],
    /// Their quadrature weights, which add up to 1.
    pub weights: [f64; NODES],
    /// What turns values into the coefficients of the last two Legendre polynomials that the nodes hold.
    last: [[f64; NODES]; 2],
}

impl SpanRule {
    /// The rule with [`NODES`] nodes.
    #[must_use]
    pub fn new() -> Self {
        let rule = Rule::new(NODES);
        let nodes: [f64; NODES] = std::array::from_fn(|i| rule.nodes[i]);
        let weights: [f64; NODES] = std::array::from_fn(|i| rule.weights[i]);
        let last = [NODES - 2, NODES - 1].map(|degree| {
            let values = nodes.map(|node| legendre(degree, 2.0 * node - 1.0).0);
            let square: f64 = values.iter().zip(&weights).map(|(value, weight)| weight * value * value).sum();
            std::array::from_fn(|i| weights[i] * values[i] / square)
        });
        Self { nodes, weights, last }
    }

    /// The larger of the last two coefficients of the polynomial through the values, over the largest value: how far the
    /// nodes are from following a function.
    #[must_use]
    pub fn tail(&self, values: &[f64; NODES]) -> f64 {
        let coefficient = |row: &[f64; NODES]| row.iter().zip(values).map(|(a, b)| a * b).sum::<f64>().abs();
        let size = values.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        coefficient(&self.last[0]).max(coefficient(&self.last[1])) / size.max(f64::MIN_POSITIVE)
    }
}

impl Default for SpanRule {
    fn default() -> Self {
        Self::new()
    }
}

/// A stretch of the cycle on which everything is smooth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// τ where it begins \[m\].
    pub start: f64,
    /// τ where it ends \[m\].
    pub end: f64,
    /// Pairs in contact, loaded or not.
    pub pairs: usize,
    /// The pairs whose first or last touch the start and the end of the span are.
    pub touches: [Option<usize>; 2],
}

impl Span {
    /// τ of a node \[m\], graded towards touches; that of the last one is exactly `end`.
    #[must_use]
    pub fn position(&self, rows: &SpanRule, node: usize) -> f64 {
        let u = rows.nodes[node];
        if node + 1 == NODES {
            return self.end;
        }
        let share = match self.touches {
            [None, None] => u,
            [Some(_), None] => u * u,
            [None, Some(_)] => u * (2.0 - u),
            [Some(_), Some(_)] => u * u * (3.0 - 2.0 * u),
        };
        self.start + (self.end - self.start) * share
    }

    /// Quadrature weight of a node \[length\].
    #[must_use]
    pub fn weight(&self, rows: &SpanRule, node: usize) -> f64 {
        let u = rows.nodes[node];
        let grading = match self.touches {
            [None, None] => 1.0,
            [Some(_), None] => 2.0 * u,
            [None, Some(_)] => 2.0 - 2.0 * u,
            [Some(_), Some(_)] => 6.0 * u * (1.0 - u),
        };
        (self.end - self.start) * grading * rows.weights[node]
    }
}

/// Which extrema are refined on the function itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refining {
    /// All that may be the largest or the smallest.
    Each,
    /// Of a function with kinks between its nodes: the few that nodes say are.
    Few,
}

/// A function over the whole cycle, by position.
#[derive(Clone, Debug, Default)]
pub struct Trace {
    /// Each span with the values at its nodes, in the order of τ.
    pub spans: Vec<(Span, [f64; NODES])>,
}

/// A place in the cycle and the value there; `pairs` tells which one-sided limit it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremum {
    /// τ \[m\].
    pub position: f64,
    /// Pairs in contact in the zone it was found in, loaded or not.
    pub pairs: usize,
    /// In the unit of the function.
    pub value: f64,
}

/// A node with its neighbours; `None` beyond the end of a zone, where the function jumps.
struct Neighbourhood {
    before: Option<(f64, f64)>,
    at: (f64, f64),
    after: Option<(f64, f64)>,
    /// Whether two spans meet here, so that the function may have a kink.
    joint: bool,
}

impl Trace {
    /// The largest value; `function` gives the value at any position with a number of pairs.
    pub fn largest(&self, rows: &SpanRule, refining: Refining, function: impl Fn(f64, usize) -> f64) -> Extremum {
        self.extreme(rows, 1.0, refining, function)
    }

    /// The smallest value.
    pub fn smallest(&self, rows: &SpanRule, refining: Refining, function: impl Fn(f64, usize) -> f64) -> Extremum {
        self.extreme(rows, -1.0, refining, function)
    }

    fn extreme(
        &self,
        rows: &SpanRule,
        sign: f64,
        refining: Refining,
        function: impl Fn(f64, usize) -> f64,
    ) -> Extremum {
        let mut highest: Vec<(f64, usize, Neighbourhood)> = Vec::new();
        let mut best = Extremum { position: 0.0, pairs: 0, value: f64::NEG_INFINITY };
        let mut lowest = f64::INFINITY;
        for (span, values) in &self.spans {
            for (node, value) in values.iter().enumerate() {
                let value = sign * value;
                lowest = lowest.min(value);
                if value > best.value {
                    best = Extremum { position: span.position(rows, node), pairs: span.pairs, value };
                }
            }
        }
        // Below this there is nothing but rounding.
        if best.value - lowest <= 1e-13 * best.value.abs() {
            return Extremum { value: sign * best.value, ..best };
        }
        for (index, (span, values)) in self.spans.iter().enumerate() {
            for node in 0..NODES {
                let value = sign * values[node];
                // Most nodes are out of the question at a glance.
                let topped = (node > 0 && sign * values[node - 1] > value)
                    || (node + 1 < NODES && sign * values[node + 1] > value)
                    || value + OVERSHOOT * (value - lowest) < best.value;
                if topped {
                    continue;
                }
                let near = self.neighbourhood(rows, index, node, sign);
                let sides = [near.before, near.after];
                let low = sides.iter().flatten().fold(value, |low, side| low.min(side.1));
                let topped = sides.iter().flatten().any(|side| side.1 > value);
                // The first node of a span stands for the last one of the span before it.
                let twin = node + 1 == NODES && near.after.is_some();
                // On a plateau there is nothing to look for.
                if topped || twin || low >= value || value + OVERSHOOT * (value - low) < best.value {
                    continue;
                }
                if refining != Refining::Each {
                    highest.push((value, span.pairs, near));
                    continue;
                }
                let found = near.maximum(PLACE, |position| sign * function(position, span.pairs));
                if found.1 > best.value {
                    best = Extremum { position: found.0, pairs: span.pairs, value: found.1 };
                }
            }
        }
        highest.sort_by(|one, other| other.0.total_cmp(&one.0));
        for (_, pairs, near) in highest.into_iter().take(MOST) {
            let found = near.maximum(FEW_PLACE, |position| sign * function(position, pairs));
            if found.1 > best.value {
                best = Extremum { position: found.0, pairs, value: found.1 };
            }
        }
        Extremum { value: sign * best.value, ..best }
    }

    fn neighbourhood(&self, rows: &SpanRule, index: usize, node: usize, sign: f64) -> Neighbourhood {
        let point = |index: usize, node: usize| {
            let (span, values) = &self.spans[index];
            (span.position(rows, node), sign * values[node])
        };
        let joined = |one: usize, two: usize| {
            let (one, two) = (self.spans.get(one), self.spans.get(two));
            one.zip(two)
                .is_some_and(|(one, two)| one.0.end.total_cmp(&two.0.start).is_eq() && one.0.pairs == two.0.pairs)
        };
        let before = match node {
            0 => (index > 0 && joined(index - 1, index)).then(|| point(index - 1, NODES - 2)),
            _ => Some(point(index, node - 1)),
        };
        let after = match node + 1 {
            NODES => joined(index, index + 1).then(|| point(index + 1, 1)),
            next => Some(point(index, next)),
        };
        Neighbourhood { before, at: point(index, node), after, joint: node == 0 || node + 1 == NODES }
    }

    /// The nodes of the quadrature over the cycle.
    #[must_use]
    pub fn nodes(&self, rows: &SpanRule) -> Vec<Node> {
        let mut nodes = Vec::with_capacity(self.spans.len() * NODES);
        for (span, values) in &self.spans {
            for (node, &value) in values.iter().enumerate() {
                nodes.push(Node { position: span.position(rows, node), weight: span.weight(rows, node), value });
            }
        }
        nodes
    }
}

impl Neighbourhood {
    /// The maximum of `function` next to a node that none of its neighbours exceeds.
    fn maximum(&self, place: f64, function: impl Fn(f64) -> f64) -> (f64, f64) {
        let at = self.at;
        if let (Some(before), Some(after), false) = (self.before, self.after, self.joint) {
            let guess = vertex(before, at, after);
            return maximum(&function, before.0, guess, after.0, place * (after.0 - before.0));
        }
        for side in [self.before, self.after].into_iter().flatten() {
            let step = PROBE * (side.0 - at.0);
            let probe = (at.0 + step, function(at.0 + step));
            if probe.1 > at.1 {
                // The parabola with the value and the slope of the node that passes through its neighbour.
                let (slope, reach) = ((probe.1 - at.1) / step, side.0 - at.0);
                let bend = (side.1 - at.1 - slope * reach) / (reach * reach);
                let guess = at.0 + (-0.5 * slope / bend / reach).clamp(0.0, 1.0) * reach;
                return maximum(&function, at.0.min(side.0), guess, at.0.max(side.0), place * reach.abs());
            }
        }
        at
    }
}

/// Where the parabola through three points has its vertex, kept well inside them.
fn vertex(before: (f64, f64), at: (f64, f64), after: (f64, f64)) -> f64 {
    let (left, right) = (at.0 - before.0, after.0 - at.0);
    let (fall, rise) = ((at.1 - before.1) / left, (after.1 - at.1) / right);
    let shift = if fall > rise { 0.5 * (fall * right + rise * left) / (fall - rise) } else { 0.0 };
    at.0 + shift.clamp(-0.9 * left, 0.9 * right)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn span(start: f64, end: f64, touches: [bool; 2]) -> Span {
        Span { start, end, pairs: 1, touches: touches.map(|touch| touch.then_some(0)) }
    }

    fn trace(spans: &[Span], function: impl Fn(f64) -> f64) -> Trace {
        let rows = SpanRule::new();
        let values = |span: &Span| std::array::from_fn(|node| function(span.position(&rows, node)));
        Trace { spans: spans.iter().map(|span| (*span, values(span))).collect() }
    }

    #[test]
    fn graded_nodes_integrate_the_3_2_power_of_a_first_touch() {
        let rows = SpanRule::new();
        let total = |touches, function: &dyn Fn(f64) -> f64| -> f64 {
            trace(&[span(0.0, 2.0, touches)], function).nodes(&rows).iter().map(|node| node.weight * node.value).sum()
        };
        let power = |x: f64| x * x.sqrt();
        let exact = 0.4 * 2_f64.powf(2.5);
        assert!((total([true, false], &power) / exact - 1.0).abs() < 1e-14);
        assert!((total([false, true], &|x| power(2.0 - x)) / exact - 1.0).abs() < 1e-14);
        assert!((total([false, false], &power) / exact - 1.0).abs() > 1e-7, "not without the grading");
        for touches in [[false, false], [true, false], [false, true], [true, true]] {
            assert!((total(touches, &|x| 1.0 + x * x * x) - 6.0).abs() < 1e-13);
        }
    }

    #[test]
    fn the_tail_tells_what_the_nodes_follow() {
        let rows = SpanRule::new();
        let tail = |function: &dyn Fn(f64) -> f64| rows.tail(&rows.nodes.map(function));
        assert!(tail(&|x| 3.0 + x.powi(5)) < 1e-14);
        // Legendre's own P_6 and P_7 on 0..=1, whose largest value at the nodes is 1.
        for degree in [6, 7] {
            assert!((tail(&|x| legendre(degree, 2.0 * x - 1.0).0) - 1.0).abs() < 1e-14);
        }
        // A pole at p: coefficients fall as ρ⁻ⁿ with Bernstein's ellipse through it, ρ = q + √(q² − 1), q = 2p − 1.
        for pole in [1.25_f64, 3.0, 9.0] {
            let q = 2.0 * pole - 1.0;
            let fall = (q + (q * q - 1.0).sqrt()).powi(-6);
            assert!((1.0..5.0).contains(&(tail(&|x| 1.0 / (pole - x)) / fall)), "{pole}");
        }
    }

    #[test]
    fn extrema_inside_spans_at_kinks_and_next_to_them_are_found() {
        let rows = SpanRule::new();
        let spans = [span(0.0, 1.0, [false, true]), span(1.0, 2.5, [true, false])];
        let check = |function: &dyn Fn(f64) -> f64, at: f64| {
            let found = trace(&spans, function).largest(&rows, Refining::Each, |x, _| function(x));
            assert!((found.value - function(at)).abs() < 1e-11, "{found:?}, not at {at}");
            let found = trace(&spans, |x| -function(x)).smallest(&rows, Refining::Each, |x, _| -function(x));
            assert!((found.value + function(at)).abs() < 1e-11, "{found:?}, not at {at}");
        };
        for at in [0.0, 1e-3, 0.3, 0.999, 1.001, 1.7, 2.4999, 2.5] {
            check(&|x| -(x - at) * (x - at), at);
        }
        // A kink at the joint, and a rise that a 3/2 power stops just after it.
        check(&|x| -(x - 1.0).abs(), 1.0);
        check(&|x| x - 20.0 * (x - 1.0).max(0.0).powf(1.5), 1.0 + 1.0 / 900.0);
    }
}
