//! One design under one torque: equilibrium at any position of the mesh cycle, and the walk over all of it.
//!
//! The cycle is cut at the ends of its zones, where a modification starts or ends, where flanks begin to touch at another
//! place (with corner contact), and where a pair takes up or loses its load, which is found to rounding; in between
//! everything is smooth. Must not know: what is done with the values.

use super::cycle::{Elasticity, MeshCycle};
use super::trace::{NODES, Span, Trace};
use crate::gear::contact::CornerContact;
use crate::gear::contact::face::Face;
use crate::gear::contact::flattening::{InSeries, Logarithmic};
use crate::gear::contact::gap::Gaps;
use crate::gear::contact::springs::{LinearPairs, LogarithmicPairs};
use crate::gear::geometry::Side;
use crate::gear::modification::{Design, Modification};
use crate::numeric::complementarity::{self, Balance, Coupling, MOST, PerSpring, Springs};
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
    corners: Option<Corners<'a>>,
    /// Cycle positions at which a profile is not smooth, ascending.
    breaks: Vec<f64>,
    /// Interferences at which the load of a pair is not smooth, besides 0.
    pub(super) levels: Vec<f64>,
}

/// What corner contact adds.
#[derive(Clone)]
struct Corners<'a> {
    gaps: Gaps<'a>,
    /// Path positions farther out than these are too far apart under this load.
    window: (f64, f64),
    /// The gap where the model ends \[m\].
    limit: f64,
}

/// The pairs of one position that can carry load.
struct Carried {
    count: usize,
    /// Their places among the springs of the position, ascending.
    springs: [usize; MOST],
    positions: PerSpring,
    /// From the smallest one up.
    gaps: PerSpring,
    smallest: f64,
}

/// The interference of a pair that is out of reach \[m\]: far from any contact.
const OUT_OF_REACH: f64 = -1.0;

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
        let levels = face.levels();
        let mut loading = Self {
            levels,
            cycle,
            force: torque / cycle.pair.pinion.base_radius,
            face,
            profiles,
            corners: None,
            breaks: Vec::new(),
        };
        let pair = &cycle.pair;
        if cycle.settings.corner_contact == CornerContact::Exact {
            loading.add_corners();
            return loading;
        }
        let mut breaks = Vec::new();
        for (side, profile) in loading.profiles.iter().enumerate() {
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
        loading.breaks = breaks;
        loading
    }

    fn add_corners(&mut self) {
        let cycle = self.cycle;
        let pair = &cycle.pair;
        let gaps = Gaps::new(pair, &self.profiles);
        let (first, last) = cycle.path.window();
        // A little inside, for rounding.
        let inwards = CLOSEST * pair.base_pitch;
        let ends = [gaps.at(first + inwards), gaps.at(last - inwards)];
        let limit = ends.into_iter().flatten().fold(f64::INFINITY, f64::min) + self.face.offset;
        // Farther out than a pair can be loaded nothing is looked at.
        let (from, to) = (pair.start_of_contact, pair.end_of_contact);
        let inside = (0..=16).map(|index| from + (to - from) * f64::from(index) / 16.0);
        let most = inside.fold(0.0, |most: f64, s| most.max(self.alone(s) + gaps.at(s).unwrap_or(0.0)));
        let outermost = |from: f64, to: f64| {
            let (mut near, mut far) = (from, to);
            for _ in 0..8 {
                let middle = 0.5 * (near + far);
                if gaps.at(middle).is_some_and(|gap| gap <= most) { near = middle } else { far = middle }
            }
            far
        };
        let window = (outermost(from, first), outermost(to, last));
        let fold = |s: f64| {
            let pitches = (s - from) / pair.base_pitch;
            (pitches - pitches.floor()) * pair.base_pitch
        };
        self.breaks = gaps.breaks(window).into_iter().map(fold).collect();
        self.breaks.sort_by(f64::total_cmp);
        self.corners = Some(Corners { gaps, window, limit });
    }

    /// Whether an approach is within what is modelled: with corner contact, below the gap at which a pair would touch that
    /// is no longer looked at, or whose tip would pass the other one.
    #[must_use]
    pub fn holds(&self, transmission_error: f64) -> bool {
        transmission_error <= self.largest_approach()
    }

    /// The largest approach that is modelled \[m\].
    #[must_use]
    pub fn largest_approach(&self) -> f64 {
        self.corners.as_ref().map_or(f64::INFINITY, |corners| corners.limit)
    }

    /// The same design when nothing is transmitted.
    #[must_use]
    pub fn without_load(&self) -> Self {
        Self { force: 0.0, levels: Vec::new(), ..self.clone() }
    }

    /// The gap on the line of action; with corner contact, where the flanks come nearest, and none where they are
    /// too far apart.
    fn gap(&self, s: f64) -> Option<f64> {
        if let Some(Corners { gaps, window, .. }) = &self.corners {
            return if s >= window.0 && s <= window.1 { gaps.at(s) } else { None };
        }
        let pair = &self.cycle.pair;
        let depth = |profile: &[&dyn Modification], roll: f64| profile.iter().map(|part| part.depth(roll)).sum::<f64>();
        let [pinion, gear] = &self.profiles;
        Some(
            depth(pinion, s / pair.pinion.base_radius) + depth(gear, (pair.tangent_length - s) / pair.gear.base_radius),
        )
    }

    /// Equilibrium at the cycle position τ with `pairs` inside the path of contact, the newest first.
    #[must_use]
    pub fn state(&self, position: f64, pairs: usize) -> State {
        let carried = self.carried(position, pairs);
        let Carried { count, springs, positions, gaps, smallest } = &carried;
        let (springs, positions, gaps) = (&springs[..*count], &positions[..*count], &gaps[..*count]);
        let balance =
            if self.force > 0.0 { self.loaded(springs, positions, gaps) } else { complementarity::unloaded(gaps) };
        let unloaded = smallest + self.face.offset;
        if self.corners.is_none() {
            return State { unloaded, balance };
        }
        let mut spread = Balance { loads: [0.0; MOST], interference: [OUT_OF_REACH; MOST], ..balance };
        for (index, &spring) in springs.iter().enumerate() {
            spread.loads[spring] = balance.loads[index];
            spread.interference[spring] = balance.interference[index];
        }
        State { unloaded, balance: spread }
    }

    /// The pairs that can touch at all; with corner contact only those that come near enough.
    fn carried(&self, position: f64, pairs: usize) -> Carried {
        let mut carried = Carried {
            count: 0,
            springs: [0; MOST],
            positions: [0.0; MOST],
            gaps: [0.0; MOST],
            smallest: f64::INFINITY,
        };
        let mut nearest = 0.0;
        for spring in 0..self.cycle.springs(pairs) {
            let s = self.cycle.path_position(position, spring);
            if let Some(gap) = self.gap(s) {
                let index = carried.count;
                (carried.springs[index], carried.positions[index], carried.gaps[index]) = (spring, s, gap);
                carried.count += 1;
                if gap < carried.smallest {
                    (carried.smallest, nearest) = (gap, s);
                }
            }
        }
        for gap in &mut carried.gaps[..carried.count] {
            *gap -= carried.smallest;
        }
        if self.corners.is_some() && self.force > 0.0 {
            let near_enough = self.alone(nearest);
            let mut kept = 0;
            for index in 0..carried.count {
                if carried.gaps[index] <= near_enough {
                    carried.springs[kept] = carried.springs[index];
                    carried.positions[kept] = carried.positions[index];
                    carried.gaps[kept] = carried.gaps[index];
                    kept += 1;
                }
            }
            carried.count = kept;
        }
        carried
    }

    /// An approach that no equilibrium exceeds, from the smallest gap on, where the nearest pair is at `s`: twice that of
    /// this pair alone. For loads λ_j of least complementary energy U, x F = Σ w_j λ_j + Σ gap_j λ_j ≤ 2 U since
    /// approaches bend down with the load, and U ≤ F w(F) of any one pair alone.
    fn alone(&self, s: f64) -> f64 {
        let width = self.cycle.face_width;
        let alone = match &self.cycle.elasticity {
            Elasticity::Linear(stiffness) => self.force / stiffness.value(s),
            Elasticity::Logarithmic { .. } => self.slice(s).interference(self.force / width),
        };
        2.0 * (alone + self.face.mean)
    }

    fn loaded(&self, springs: &[usize], positions: &[f64], gaps: &[f64]) -> Balance {
        match &self.cycle.elasticity {
            Elasticity::Linear(graded) => {
                let mut stiffness = [0.0; MOST];
                for (slot, s) in stiffness.iter_mut().zip(positions) {
                    *slot = graded.value(*s);
                }
                let above = complementarity::linear_approach(&stiffness, gaps, self.force) + self.face.mean;
                self.balanced(springs, positions, gaps, &LinearPairs { stiffness, face: &self.face }, above)
            }
            Elasticity::Logarithmic { .. } => {
                let mut slices = [InSeries::NONE; MOST];
                for (slot, s) in slices.iter_mut().zip(positions) {
                    *slot = self.slice(*s);
                }
                let pairs = LogarithmicPairs { slices, width: self.cycle.face_width, face: &self.face };
                let nearest = gaps.iter().position(|gap| *gap == 0.0).unwrap_or(0);
                let above = pairs.above(nearest, self.force);
                self.balanced(springs, positions, gaps, &pairs, above)
            }
        }
    }

    fn balanced(
        &self,
        springs: &[usize],
        positions: &[f64],
        gaps: &[f64],
        responses: &impl Springs,
        above: f64,
    ) -> Balance {
        if !self.cycle.coupled() || gaps.len() < 2 {
            return complementarity::balance(responses, gaps, self.force, above);
        }
        let mut coupling: Coupling = [PerSpring::default(); MOST];
        for (ahead, &spring) in springs.iter().enumerate() {
            for behind in 0..ahead {
                let value = self.cycle.coupling(positions[behind], spring - springs[behind]);
                (coupling[behind][ahead], coupling[ahead][behind]) = (value, value);
            }
        }
        complementarity::balance_coupled(responses, gaps, &coupling, self.force, above)
    }

    /// A slice of the pair at `s` under the load-dependent law.
    fn slice(&self, s: f64) -> InSeries {
        match &self.cycle.elasticity {
            Elasticity::Linear(_) => InSeries::NONE,
            Elasticity::Logarithmic { compliance, constant, rate } => {
                Logarithmic { constant: constant.value(s), rate: *rate }.in_series(compliance.value(s))
            }
        }
    }

    /// The largest load per width of a pair \[N/m\], where the flanks stand highest across the face.
    #[must_use]
    pub fn line_load(&self, position: f64, state: &State, spring: usize) -> f64 {
        let interference = state.balance.interference[spring];
        if self.face.is_flat() || interference <= 0.0 {
            return state.balance.loads[spring] / self.cycle.face_width;
        }
        let s = self.cycle.path_position(position, spring);
        match &self.cycle.elasticity {
            Elasticity::Linear(stiffness) => stiffness.value(s) * interference / self.cycle.face_width,
            Elasticity::Logarithmic { .. } => self.slice(s).load(interference).0,
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
            let before = Span { end: position, touches: [span.touches[0], pair], ..*span };
            let after = Span { start: position, touches: [pair, span.touches[1]], ..*span };
            let middle = self.smooth(&before, first, cuts, visit);
            return self.smooth(&after, middle, cuts, visit);
        }
        let last = states[NODES - 1];
        self.settle(span, &mut states);
        visit(span, &states);
        last
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

    /// The peak-to-peak transmission error \[m\], infinite beyond what is modelled: the lean path for optimisers.
    #[must_use]
    pub fn peak_to_peak(&self) -> f64 {
        // Extrema are refined on the function itself and need no smooth spans.
        let trace = Self { levels: Vec::new(), ..self.clone() }.trace();
        let value = |position: f64, pairs: usize| self.state(position, pairs).transmission_error();
        let rows = &self.cycle.rows;
        let largest = trace.largest(rows, value).value;
        if self.holds(largest) { largest - trace.smallest(rows, value).value } else { f64::INFINITY }
    }

    /// The variance of the transmission error over the cycle \[m²\], an integral mean, infinite beyond what is modelled:
    /// the lean path for optimisers.
    #[must_use]
    pub fn variance(&self) -> f64 {
        let trace = self.trace();
        if !trace.spans.iter().flat_map(|(_, values)| values).all(|value| self.holds(*value)) {
            return f64::INFINITY;
        }
        harmonics::mean_and_variance(self.cycle.period(), &trace.nodes(&self.cycle.rows)).1
    }
}
