//! Where the set of loaded pairs changes, or a face comes into contact over its whole width: the ends of smooth spans.
//!
//! Must not know: what is done with the values.

use crate::gear::mesh::equilibrium::load_case::LoadCase;
use crate::gear::mesh::equilibrium::state::Equilibrium;
use crate::gear::mesh::trace::{NODES, Span};
use crate::numeric::crossing::crossing;

/// Changes closer than this share of the base pitch are one: a deep relief takes a pair's load away next to where it
/// starts.
const CLOSEST: f64 = 1e-14;
/// Roundings in a path position.
const ROUNDINGS: f64 = 4.0;

/// Where a span ends before its end, and for a first or last touch of which pair.
pub(in crate::gear::mesh) type Cut = (f64, Option<usize>);

/// How near to the end of a span a change counts as being at that end: path positions are not known any better.
fn closest(case: &LoadCase) -> f64 {
    let pair = &case.cycle.pair;
    (CLOSEST * pair.base_pitch).max(ROUNDINGS * f64::EPSILON * pair.tangent_length)
}

/// The first change of the set of loaded pairs between one of these nodes of a span and the next of them, or the first
/// level that a pair's penetration passes.
pub(in crate::gear::mesh) fn change(
    case: &LoadCase,
    span: &Span,
    states: &[Equilibrium; NODES],
    nodes: &[usize],
) -> Option<Cut> {
    let springs = case.cycle.springs(span.pairs);
    // Most spans have neither, which shows at a glance.
    let any = (0..springs).any(|pair| {
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for node in nodes {
            let penetration = states[*node].balance.penetration[pair];
            least = if penetration < least { penetration } else { least };
            most = if penetration > most { penetration } else { most };
        }
        let passes = |level: f64| (least > level) != (most > level);
        passes(0.0) || case.levels.iter().any(|level| passes(*level))
    });
    if !any {
        return None;
    }
    for ends in nodes.windows(2) {
        let ends = [ends[0], ends[1]];
        for pair in 0..springs {
            let touch = if known(span, ends, pair) { None } else { Some((0.0, Some(pair))) };
            for (level, touch) in touch.into_iter().chain(case.levels.iter().map(|level| (*level, None))) {
                let [before, after] = ends.map(|node| states[node].balance.penetration[pair] - level);
                if (before > 0.0) == (after > 0.0) {
                    continue;
                }
                let closest = closest(case);
                let [from, to] = ends.map(|node| span.position(&case.cycle.rows, node));
                let above = |position: f64| case.state(position, span.pairs).balance.penetration[pair] - level;
                let at = if touch.is_some() {
                    let pressed = |at: f64| case.pressed_by_others(at, span.pairs, pair);
                    // Where it is not loaded, that is its penetration.
                    let smooth = |at: f64, value: f64| {
                        let pressed = if value > 0.0 { pressed(at) } else { None };
                        (at, pressed.filter(|pressed| *pressed > 0.0).unwrap_or(value))
                    };
                    let value = |at: f64| pressed(at).unwrap_or_else(|| above(at));
                    crossing(value, smooth(from, before), smooth(to, after), 0.1 * closest)
                } else {
                    crossing(above, (from, before), (to, after), 0.1 * closest)
                };
                if at - span.start > closest && span.end - at > closest {
                    return Some((at, touch));
                }
            }
        }
    }
    None
}

/// Gives a node at an end of a span the limit from inside where a pair changes sides right there: rounding decides
/// on which side of the change the end itself lies, and its weight in a mean is that of a node.
pub(in crate::gear::mesh) fn settle(case: &LoadCase, span: &Span, states: &mut [Equilibrium; NODES]) {
    let step = 2.0 * closest(case);
    if case.force <= 0.0 || span.end - span.start <= 2.0 * step {
        return;
    }
    for (node, end, next, inside) in [(0, 0, 1, span.start + step), (NODES - 2, NODES - 1, NODES - 2, span.end - step)]
    {
        let differs = (0..case.cycle.springs(span.pairs)).any(|pair| {
            let loaded = |at: usize| states[at].balance.penetration[pair] > 0.0;
            loaded(end) != loaded(next) && !known(span, [node, node + 1], pair)
        });
        if differs {
            states[end] = case.state(inside, span.pairs);
        }
    }
}

/// Whether the change of a pair between two nodes is what the span's own end is.
fn known(span: &Span, [from, to]: [usize; 2], pair: usize) -> bool {
    let ends = [from == 0, to + 1 == NODES];
    (0..2).any(|end| ends[end] && span.touches[end] == Some(pair))
}
