//! A function over the mesh cycle as values on smooth spans, and what follows: extrema, quadrature nodes.
//!
//! Every span has its values at the eight Gauss–Lobatto nodes, both ends included, and the function is smooth inside it.
//! An extremum inside a span is found from the derivative of the interpolant and then refined on the function itself,
//! so its value does not depend on where the nodes happen to lie. Must not know: what the function is.

use crate::numeric::extremum::maximum;
use crate::numeric::harmonics::Node;
use crate::numeric::lobatto::Rule;

/// Nodes of a span.
pub const NODES: usize = 8;

/// An extremum lies at most this share of the span's variation beyond the span's own nodes. (Between neighbouring
/// nodes a parabola rises by less than 0.05 of what it does over the span.)
const OVERSHOOT: f64 = 0.1;

/// Node positions, weights and derivatives on the unit interval.
#[derive(Clone, Debug)]
pub struct Rows {
    pub nodes: [f64; NODES],
    pub weights: [f64; NODES],
    pub derivatives: [[f64; NODES]; NODES],
}

impl Rows {
    #[must_use]
    pub fn new() -> Self {
        let rule = Rule::new(NODES);
        let matrix = rule.differentiation();
        Self {
            nodes: std::array::from_fn(|i| rule.nodes[i]),
            weights: std::array::from_fn(|i| rule.weights[i]),
            derivatives: std::array::from_fn(|i| std::array::from_fn(|k| matrix[i][k])),
        }
    }
}

impl Default for Rows {
    fn default() -> Self {
        Self::new()
    }
}

/// A stretch of the cycle on which everything is smooth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    pub start: f64,
    pub end: f64,
    /// Pairs in contact, loaded or not.
    pub pairs: usize,
}

impl Span {
    #[must_use]
    pub fn position(&self, rows: &Rows, node: usize) -> f64 {
        if node + 1 == NODES { self.end } else { self.start + (self.end - self.start) * rows.nodes[node] }
    }
}

/// A function over the whole cycle.
#[derive(Clone, Debug, Default)]
pub struct Trace {
    pub spans: Vec<(Span, [f64; NODES])>,
}

/// A place in the cycle and the value there; `pairs` tells which one-sided limit it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremum {
    pub position: f64,
    pub pairs: usize,
    pub value: f64,
}

impl Trace {
    /// The largest value; `function` gives the value at any position with a number of pairs.
    pub fn largest(&self, rows: &Rows, function: impl Fn(f64, usize) -> f64) -> Extremum {
        self.extreme(rows, 1.0, function)
    }

    /// The smallest value.
    pub fn smallest(&self, rows: &Rows, function: impl Fn(f64, usize) -> f64) -> Extremum {
        self.extreme(rows, -1.0, function)
    }

    fn extreme(&self, rows: &Rows, sign: f64, function: impl Fn(f64, usize) -> f64) -> Extremum {
        let mut best = Extremum { position: 0.0, pairs: 0, value: f64::NEG_INFINITY };
        for (span, values) in &self.spans {
            for (node, value) in values.iter().enumerate() {
                if sign * value > best.value {
                    best = Extremum { position: span.position(rows, node), pairs: span.pairs, value: sign * value };
                }
            }
        }
        for (span, values) in &self.spans {
            let ends = values.iter().map(|value| sign * value);
            let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
            // Below this there is nothing but rounding.
            if high + OVERSHOOT * (high - low) < best.value || high - low <= 1e-13 * high.abs() {
                continue;
            }
            let slopes: [f64; NODES] = std::array::from_fn(|i| {
                rows.derivatives[i].iter().zip(values).map(|(d, value)| sign * d * value).sum()
            });
            for i in 0..NODES - 1 {
                if slopes[i] > 0.0 && slopes[i + 1] < 0.0 {
                    let (from, to) = (span.position(rows, i), span.position(rows, i + 1));
                    let guess = from + (to - from) * slopes[i] / (slopes[i] - slopes[i + 1]);
                    let value = |position: f64| sign * function(position, span.pairs);
                    let (position, value) = maximum(value, from, guess, to, 1e-5 * (to - from));
                    if value > best.value {
                        best = Extremum { position, pairs: span.pairs, value };
                    }
                }
            }
        }
        Extremum { value: sign * best.value, ..best }
    }

    /// The nodes of the quadrature over the cycle.
    #[must_use]
    pub fn nodes(&self, rows: &Rows) -> Vec<Node> {
        let mut nodes = Vec::with_capacity(self.spans.len() * NODES);
        for (span, values) in &self.spans {
            for (node, &value) in values.iter().enumerate() {
                let weight = (span.end - span.start) * rows.weights[node];
                nodes.push(Node { position: span.position(rows, node), weight, value });
            }
        }
        nodes
    }
}
