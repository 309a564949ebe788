//! One design under one torque: equilibrium at any position of the mesh cycle, and the walk over all of it.
//!
//! The cycle is cut at the ends of its zones, where a modification starts or ends, and where a pair takes up or loses its
//! load, which is found to rounding; in between everything is smooth. Must not know: what is done with the values.

use super::cycle::{Elasticity, MeshCycle};
use super::trace::{NODES, Span, Trace};
use crate::gear::contact::face::Face;
use crate::gear::contact::flattening::{InSeries, Logarithmic};
use crate::gear::contact::springs::{LinearPairs, LogarithmicPairs};
use crate::gear::geometry::Side;
use crate::gear::modification::{Design, Modification};
use crate::numeric::complementarity::{self, Balance, MOST, Springs};
use crate::numeric::crossing::crossing;
use crate::numeric::harmonics;

/// Cuts closer than this share of the base pitch are one.
const CLOSEST: f64 = 1e-10;
/// Cuts that one span may be given for pairs that take up or lose load.
const MOST_CUTS: usize = 24;

/// A design under a torque.
#[derive(Clone)]
pub struct Loading<'a> {
    pub cycle: &'a MeshCycle,
    /// F = T / r_b1 \[N\].
    pub force: f64,
    face: Face<'a>,
    profiles: [Vec<&'a dyn Modification>; 2],
    /// Cycle positions at which a profile is not smooth, ascending.
    breaks: Vec<f64>,
}

/// Equilibrium at one position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// The approach without load: the smallest gap and what the whole face has lost \[m\].
    pub unloaded: f64,
    pub balance: Balance,
}

impl State {
    /// δ \[m\].
    #[must_use]
    pub fn transmission_error(&self) -> f64 {
        self.unloaded + self.balance.approach
    }
}

impl<'a> Loading<'a> {
    /// `torque` acts on the pinion \[N m\], 0 or more; without torque the nearest pair only touches.
    #[must_use]
    pub fn new(cycle: &'a MeshCycle, design: &'a Design, torque: f64) -> Self {
        let face = Face::new(design, cycle.face_width, &cycle.slices);
        let of = |side: Side| {
            let parts = design.side(side).iter().map(|part| part.modification.as_ref());
            parts.filter(|part| part.varies_along_profile()).collect::<Vec<_>>()
        };
        let profiles = [of(Side::Pinion), of(Side::Gear)];
        let pair = &cycle.pair;
        let mut breaks = Vec::new();
        for (side, profile) in profiles.iter().enumerate() {
            for roll in profile.iter().flat_map(|part| part.profile_breaks()).flatten() {
                let s = if side == 0 {
                    roll * pair.pinion.base_radius
                } else {
                    pair.tangent_length - roll * pair.gear.base_radius
                };
                if s > pair.start_of_contact && s < pair.end_of_contact {
                    let pitches = (s - pair.start_of_contact) / pair.base_pitch;
                    breaks.push((pitches - pitches.floor()) * pair.base_pitch);
                }
            }
        }
        breaks.sort_by(f64::total_cmp);
        Self { cycle, force: torque / pair.pinion.base_radius, face, profiles, breaks }
    }

    /// The same design when nothing is transmitted.
    #[must_use]
    pub fn without_load(&self) -> Self {
        Self { force: 0.0, ..self.clone() }
    }

    fn gap(&self, s: f64) -> f64 {
        let pair = &self.cycle.pair;
        let depth = |profile: &[&dyn Modification], roll: f64| profile.iter().map(|part| part.depth(roll)).sum::<f64>();
        let [pinion, gear] = &self.profiles;
        depth(pinion, s / pair.pinion.base_radius) + depth(gear, (pair.tangent_length - s) / pair.gear.base_radius)
    }

    /// Equilibrium at the cycle position τ with `pairs` in contact, the newest first.
    #[must_use]
    pub fn state(&self, position: f64, pairs: usize) -> State {
        let mut gaps = [0.0; MOST];
        let gaps = &mut gaps[..pairs];
        let mut smallest = f64::INFINITY;
        for (pair, gap) in gaps.iter_mut().enumerate() {
            *gap = self.gap(self.cycle.path_position(position, pair));
            smallest = smallest.min(*gap);
        }
        for gap in gaps.iter_mut() {
            *gap -= smallest;
        }
        let balance = if self.force > 0.0 { self.loaded(position, gaps) } else { complementarity::unloaded(gaps) };
        State { unloaded: smallest + self.face.offset, balance }
    }

    fn loaded(&self, position: f64, gaps: &[f64]) -> Balance {
        match &self.cycle.elasticity {
            Elasticity::Linear(panels) => {
                let mut stiffness = [0.0; MOST];
                for (pair, slot) in stiffness[..gaps.len()].iter_mut().enumerate() {
                    *slot = panels.value(self.cycle.path_position(position, pair));
                }
                let above = complementarity::linear_approach(&stiffness, gaps, self.force) + self.face.mean;
                self.balanced(position, gaps, &LinearPairs { stiffness, face: &self.face }, above)
            }
            Elasticity::Logarithmic { .. } => {
                let springs = self.logarithmic(position, gaps.len());
                let nearest = gaps.iter().position(|gap| *gap == 0.0).unwrap_or(0);
                let above = springs.above(nearest, self.force);
                self.balanced(position, gaps, &springs, above)
            }
        }
    }

    fn balanced(&self, position: f64, gaps: &[f64], springs: &impl Springs, above: f64) -> Balance {
        if self.cycle.coupled() && gaps.len() > 1 {
            let coupling = self.cycle.coupling(position, gaps.len());
            complementarity::balance_coupled(springs, gaps, &coupling, self.force, above)
        } else {
            complementarity::balance(springs, gaps, self.force, above)
        }
    }

    fn logarithmic(&self, position: f64, pairs: usize) -> LogarithmicPairs<'_> {
        let mut slices = [InSeries::NONE; MOST];
        if let Elasticity::Logarithmic { compliance, constant, rate } = &self.cycle.elasticity {
            for (pair, slot) in slices[..pairs].iter_mut().enumerate() {
                let s = self.cycle.path_position(position, pair);
                *slot = Logarithmic { constant: constant.value(s), rate: *rate }.in_series(compliance.value(s));
            }
        }
        LogarithmicPairs { slices, width: self.cycle.face_width, face: &self.face }
    }

    /// The largest load per width of a pair \[N/m\], where the flanks stand highest across the face.
    #[must_use]
    pub fn line_load(&self, position: f64, state: &State, pair: usize) -> f64 {
        let interference = state.balance.interference[pair];
        if self.face.is_flat() || interference <= 0.0 {
            return state.balance.loads[pair] / self.cycle.face_width;
        }
        match &self.cycle.elasticity {
            Elasticity::Linear(panels) => {
                panels.value(self.cycle.path_position(position, pair)) * interference / self.cycle.face_width
            }
            Elasticity::Logarithmic { .. } => self.logarithmic(position, pair + 1).slices[pair].load(interference).0,
        }
    }

    /// Visits the whole cycle in order, in smooth spans no longer than `longest` \[m\].
    pub fn walk(&self, longest: f64, mut visit: impl FnMut(&Span, &[State; NODES])) {
        let closest = CLOSEST * self.cycle.period();
        for zone in &self.cycle.zones {
            let mut start = zone.start;
            let inside = self.breaks.iter().copied().filter(|cut| zone.end - cut > closest).chain([zone.end]);
            for end in inside {
                if end - start <= closest {
                    continue;
                }
                let panels = ((end - start) / longest - 1e-9).ceil().max(1.0);
                let width = (end - start) / panels;
                let mut from = start;
                let mut first = self.state(start, zone.pairs);
                let mut panel = 1.0;
                while panel <= panels {
                    let to = if panel < panels { start + width * panel } else { end };
                    let span = Span { start: from, end: to, pairs: zone.pairs, touches: [None; 2] };
                    let mut cuts = MOST_CUTS;
                    first = self.smooth(&span, first, &mut cuts, &mut visit);
                    from = to;
                    panel += 1.0;
                }
                start = end;
            }
        }
    }

    /// Visits a span, in parts if the set of loaded pairs changes inside it. Returns the state at its end.
    ///
    /// All parts share `cuts`: where gaps are equal but for rounding, the changes that rounding makes have no end.
    fn smooth(
        &self,
        span: &Span,
        first: State,
        cuts: &mut usize,
        visit: &mut impl FnMut(&Span, &[State; NODES]),
    ) -> State {
        let rows = &self.cycle.rows;
        let mut states = [first; NODES];
        for (node, state) in states.iter_mut().enumerate().skip(1) {
            *state = self.state(span.position(rows, node), span.pairs);
        }
        if *cuts > 0
            && let Some((position, pair)) = self.change(span, &states)
        {
            *cuts -= 1;
            let before = Span { end: position, touches: [span.touches[0], Some(pair)], ..*span };
            let after = Span { start: position, touches: [Some(pair), span.touches[1]], ..*span };
            let middle = self.smooth(&before, first, cuts, visit);
            return self.smooth(&after, middle, cuts, visit);
        }
        visit(span, &states);
        states[NODES - 1]
    }

    /// The first change of the set of loaded pairs between the nodes of a span: where, and of which pair.
    fn change(&self, span: &Span, states: &[State; NODES]) -> Option<(f64, usize)> {
        let closest = CLOSEST * self.cycle.period();
        for node in 0..NODES - 1 {
            for pair in 0..span.pairs {
                let (before, after) =
                    (states[node].balance.interference[pair], states[node + 1].balance.interference[pair]);
                let ends = [node == 0, node + 2 == NODES];
                let at_known_end = (0..2).any(|end| ends[end] && span.touches[end] == Some(pair));
                if (before > 0.0) == (after > 0.0) || at_known_end {
                    continue;
                }
                let (from, to) = (span.position(&self.cycle.rows, node), span.position(&self.cycle.rows, node + 1));
                let interference = |position: f64| self.state(position, span.pairs).balance.interference[pair];
                let at = crossing(interference, (from, before), (to, after), 0.1 * closest);
                if at - span.start > closest && span.end - at > closest {
                    return Some((at, pair));
                }
            }
        }
        None
    }

    /// The transmission error over the cycle.
    #[must_use]
    pub fn trace(&self) -> Trace {
        let mut trace = Trace { spans: Vec::with_capacity(32) };
        self.walk(self.span_length(0), |span, states| {
            trace.spans.push((*span, std::array::from_fn(|node| states[node].transmission_error())));
        });
        trace
    }

    /// The longest span for the wanted number of positions, short enough for `harmonics`.
    pub(super) fn span_length(&self, harmonics: usize) -> f64 {
        let spans = (self.cycle.settings.positions as f64 / (NODES - 1) as f64).max(harmonics as f64);
        self.cycle.period() / spans.max(1.0)
    }

    /// The peak-to-peak transmission error \[m\]: the lean path for optimisers.
    #[must_use]
    pub fn peak_to_peak(&self) -> f64 {
        let trace = self.trace();
        let value = |position: f64, pairs: usize| self.state(position, pairs).transmission_error();
        let rows = &self.cycle.rows;
        trace.largest(rows, value).value - trace.smallest(rows, value).value
    }

    /// The variance of the transmission error over the cycle \[m²\], an integral mean: the lean path for optimisers.
    #[must_use]
    pub fn variance(&self) -> f64 {
        harmonics::mean_and_variance(self.cycle.period(), &self.trace().nodes(&self.cycle.rows)).1
    }
}
