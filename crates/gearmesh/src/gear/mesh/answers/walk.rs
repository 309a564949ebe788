//! The walk over the whole mesh cycle of a design under a torque, in smooth spans.
//!
//! The cycle is cut at the ends of its zones, where a modification starts or ends, where flanks begin to touch at another
//! place (with corner contact), and where a pair takes up or loses its load, which is found to rounding. In between
//! everything is smooth. Must not know: how equilibrium is found, what is done with the values.

use super::contact_change::{Cut, change, settle};
use crate::gear::mesh::cycle::path::CLOSEST;
use crate::gear::mesh::equilibrium::load_case::LoadCase;
use crate::gear::mesh::equilibrium::state::Equilibrium;
use crate::gear::mesh::trace::{NODES, Refining, Span, Trace};

/// Cuts that one span may be given for pairs that take up or lose load.
const MOST_CUTS: usize = 24;
/// Roundings of a path position, from the roll angle where a modification starts and back.
const ROUNDINGS: f64 = 4.0;
/// What the last of a span's polynomials may hold of the transmission error: quadrature is then good to about the square
/// of it, next to a change of a logarithmic law to 1e-12.
const TAIL: f64 = 1e-8;

/// The nodes between which changes are looked for.
const ENDS: [usize; 2] = [0, NODES - 1];
const EACH: [usize; NODES] = [0, 1, 2, 3, 4, 5, 6, 7];

/// Which extrema of a curve are refined.
pub(in crate::gear::mesh) fn refining(case: &LoadCase) -> Refining {
    if case.flanks.is_sampled() { Refining::Few } else { Refining::Each }
}

/// Visits the whole cycle in order, in smooth spans no longer than `longest` \[m\].
pub(in crate::gear::mesh) fn walk(case: &LoadCase, longest: f64, mut visit: impl FnMut(&Span, &[Equilibrium; NODES])) {
    let closest = CLOSEST * case.cycle.period();
    let rounding = ROUNDINGS * f64::EPSILON * case.cycle.pair.tangent_length;
    // Of one span after the other.
    let mut states = [Equilibrium::NONE; NODES];
    for zone in &case.cycle.zones {
        let mut start = zone.start;
        // A steep relief makes much of a rounded position, so that where one starts the limit from inside is taken.
        let mut inwards = [0.0; 2];
        let inside = case.breaks.iter().copied().filter(|cut| zone.end - cut > closest).chain([zone.end]);
        for end in inside {
            if end - start <= closest {
                continue;
            }
            let panels = ((end - start) / longest - 1e-9).ceil().max(1.0);
            let width = (end - start) / panels;
            let mut from = start;
            inwards[1] = if end < zone.end { rounding } else { 0.0 };
            let mut first = case.state(start + inwards[0], zone.pairs);
            let mut panel = 1.0;
            while panel <= panels {
                let to = if panel < panels { start + width * panel } else { end };
                let span = Span { start: from, end: to, pairs: zone.pairs, touches: [None; 2] };
                let mut cuts = MOST_CUTS;
                let last = case.state(if panel < panels { to } else { end - inwards[1] }, zone.pairs);
                smooth(case, &span, &[first, last], &mut states, &mut cuts, &mut visit);
                first = last;
                from = to;
                panel += 1.0;
            }
            (start, inwards[0]) = (end, inwards[1]);
        }
    }
}

/// Visits a span with the states at its ends, in parts if the set of loaded pairs changes inside it, or where it bends
/// more than its nodes can follow: the next change may be near, though beyond the end.
///
/// All parts share `cuts`: where gaps are equal but for rounding, the changes that rounding makes have no end.
fn smooth(
    case: &LoadCase,
    span: &Span,
    ends: &[Equilibrium; 2],
    states: &mut [Equilibrium; NODES],
    cuts: &mut usize,
    visit: &mut impl FnMut(&Span, &[Equilibrium; NODES]),
) {
    (states[0], states[NODES - 1]) = (ends[0], ends[1]);
    let Some((position, pair)) = fill(case, span, states, *cuts > 0) else {
        return visit(span, states);
    };
    *cuts -= 1;
    let before = Span { end: position, touches: [span.touches[0], pair], ..*span };
    let after = Span { start: position, touches: [pair, span.touches[1]], ..*span };
    let middle = case.state(position, span.pairs);
    smooth(case, &before, &[ends[0], middle], states, cuts, visit);
    smooth(case, &after, &[middle, ends[1]], states, cuts, visit);
}

/// Fills in the states between both ends of a span; where it is to be cut, if that is still allowed.
fn fill(case: &LoadCase, span: &Span, states: &mut [Equilibrium; NODES], may_cut: bool) -> Option<Cut> {
    // Most changes show at the ends, before anything is computed between them.
    if may_cut && let Some(cut) = change(case, span, states, &ENDS) {
        return Some(cut);
    }
    let rows = &case.cycle.rows;
    let inside: [f64; NODES - 2] = std::array::from_fn(|node| span.position(rows, node + 1));
    let [_, found @ .., _] = &mut *states;
    if case.together(&inside, span.pairs, found).is_none() {
        for (state, position) in found.iter_mut().zip(inside) {
            *state = case.state(position, span.pairs);
        }
    }
    if may_cut && let Some(cut) = change(case, span, states, &EACH) {
        return Some(cut);
    }
    let bent = || rows.tail(&states.each_ref().map(Equilibrium::transmission_error)) > TAIL;
    if case.refines && may_cut && bent() {
        return Some((0.5 * (span.start + span.end), None));
    }
    settle(case, span, states);
    None
}

/// The transmission error over the cycle.
#[must_use]
pub(in crate::gear::mesh) fn trace(case: &LoadCase) -> Trace {
    let mut trace = Trace { spans: Vec::with_capacity(32) };
    walk(case, span_length(case, 0), |span, states| {
        trace.spans.push((*span, std::array::from_fn(|node| states[node].transmission_error())));
    });
    trace
}

/// The longest span for the wanted number of positions, short enough for `harmonics`.
pub(in crate::gear::mesh) fn span_length(case: &LoadCase, harmonics: usize) -> f64 {
    let spans = (case.positions as f64 / (NODES - 1) as f64).max(harmonics as f64);
    case.cycle.period() / spans.max(1.0)
}
