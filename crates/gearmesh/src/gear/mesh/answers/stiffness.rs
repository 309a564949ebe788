//! Mesh stiffness of unmodified gears over a mesh cycle, and its extremes by zone.
//!
//! Stiffness is F/δ \[N/m\]: with the linear contact law and no coupling the sum of the pairs' stiffnesses, whatever the
//! load. Must not know: tables.

use super::curve::{Point, Wanted, extend};
use super::walk::{span_length, walk};
use crate::gear::mesh::cycle::mesh::Mesh;
use crate::gear::mesh::equilibrium::load_case::LoadCase;
use crate::gear::mesh::trace::{NODES, Refining, Trace};
use crate::gear::modification::Design;

/// Extremes of the stiffness where the same number of pairs is in contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ZoneStiffness {
    /// That number of pairs.
    pub pairs: usize,
    /// The smallest stiffness \[N/m\].
    pub minimum: f64,
    /// The largest stiffness \[N/m\].
    pub maximum: f64,
}

/// Extremes by zone and the mean over the cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct StiffnessSummary {
    /// Where the fewest pairs are in contact: the single-contact zone for 1 < ε_α < 2.
    pub fewest_pairs: ZoneStiffness,
    /// Where one more is; none when the contact ratio is whole.
    pub most_pairs: Option<ZoneStiffness>,
    /// Integral mean over the cycle.
    pub mean: f64,
}

/// The curve of unmodified gears and its summary; `torque` \[N m\] > 0 matters only for the load-dependent contact law.
#[must_use]
pub fn stiffness(cycle: &Mesh, torque: f64) -> (Vec<Point>, StiffnessSummary) {
    let design = Design::default();
    let loading = LoadCase::new(cycle, &design, torque);
    let secant = |position: f64, pairs: usize| loading.force / loading.state(position, pairs).balance.approach;
    let mut trace = Trace::default();
    let mut points = Vec::new();
    walk(&loading, span_length(&loading, 0), |span, states| {
        extend(&loading, &mut points, span, states, Wanted::default());
        let values: [f64; NODES] = states.map(|state| loading.force / state.balance.approach);
        trace.spans.push((*span, values));
    });
    let of = |pairs: usize| {
        let zone = Trace { spans: trace.spans.iter().filter(|(span, _)| span.pairs == pairs).copied().collect() };
        let (minimum, maximum) = (
            zone.smallest(&cycle.rows, Refining::Each, secant).value,
            zone.largest(&cycle.rows, Refining::Each, secant).value,
        );
        ZoneStiffness { pairs, minimum, maximum }
    };
    let fewest = cycle.zones.iter().map(|zone| zone.pairs).min().unwrap_or(1);
    let nodes = trace.nodes(&cycle.rows);
    let mean = nodes.iter().map(|node| node.weight * node.value).sum::<f64>() / cycle.period();
    let most_pairs = (cycle.zones.len() > 1).then(|| of(fewest + 1));
    (points, StiffnessSummary { fewest_pairs: of(fewest), most_pairs, mean })
}
