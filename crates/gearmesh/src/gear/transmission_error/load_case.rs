//! One design under one torque: equilibrium at any position of the mesh cycle.
//!
//! Must not know: which positions are computed, what is done with the values.

use std::sync::Arc;

use super::apart::Apart;
use super::beyond_model::BeyondModel;
use super::count::Count;
use super::cycle::{Elasticity, MeshCycle};
use super::flanks::Flanks;
use super::friction::Resisted;
use super::sliced::Sliced;
use super::within_reach::WithinReach;
use crate::gear::contact::CornerContact;
use crate::gear::contact::flattening::InSeries;
use crate::gear::geometry::error::Millimetres;
use crate::gear::modification::Design;
use crate::numeric::complementarity::{Balance, MOST_SPRINGS, PerSpring};
use crate::numeric::logarithm::Known;

/// Places closer than this share of the base pitch are one.
pub(super) const CLOSEST: f64 = 1e-10;

/// A design under a torque.
#[derive(Clone)]
pub struct LoadCase<'a> {
    /// The pair's mesh cycle, without load and modifications.
    pub cycle: &'a MeshCycle,
    /// F = T / r_b1 \[N\].
    pub force: f64,
    /// F over the face width \[N/m\], and its logarithm.
    pub(super) line_load: Known,
    pub(super) design: &'a Design,
    pub(super) flanks: Arc<Flanks<'a>>,
    pub(super) regime: Regime<'a>,
    pub(super) touching: Touching,
    /// Cycle positions at which a profile is not smooth, ascending.
    pub(super) breaks: Arc<[f64]>,
    /// Penetrations at which the load of a pair is not smooth, besides 0.
    pub(super) levels: Vec<f64>,
    pub(super) count: Count<'a>,
    /// Positions per base pitch.
    pub(super) positions: usize,
    /// Whether spans next to a change are cut until their nodes can follow: for what is integrated.
    pub(super) refines: bool,
    /// What pairs have that the design does not say of all.
    pub(super) apart: Option<Apart<'a>>,
    /// Between what they may be farther apart by that than the design's flanks say \[m\].
    pub(super) distances_between: [f64; 2],
}

/// What holds what when the load spreads; each costs more than the one before.
#[derive(Clone)]
pub(super) enum Regime<'a> {
    /// Nothing is transmitted: the nearest pair just touches.
    Unloaded,
    /// Each pair holds itself.
    Pairs,
    /// Each pair's load deflects its neighbours too.
    CoupledPairs,
    /// Each slice's load deflects all others.
    CoupledSlices(Arc<Sliced<'a>>),
    /// Friction of the flanks takes part, beside what holds what.
    Resisted(Arc<Resisted<'a>>),
}

/// Where a pair may touch.
#[derive(Clone, Copy)]
pub(super) enum Touching {
    LineOfAction,
    /// With corner contact.
    Anywhere {
        /// Path positions farther out than these are too far apart under this load.
        window: (f64, f64),
        /// The gap where the model ends \[m\].
        limit: f64,
    },
}

/// How closely the outermost places that can touch are found, over their distance from the path: what is looked at farther
/// out costs time, and gaps there are large beside those that matter.
const NARROW: f64 = 0.125;
const MOST_HALVINGS: usize = 60;

/// The penetration of a pair that is out of reach \[m\]: far from any contact.
pub(super) const OUT_OF_REACH: f64 = -1.0;

/// Equilibrium at one position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equilibrium {
    /// The approach without load: the smallest gap and what the whole face has lost \[m\].
    pub unloaded: f64,
    /// Loads of the pairs \[N\], and their approach beyond the smallest gap \[m\].
    pub balance: Balance,
    /// The largest load per width of each pair \[N/m\], where slices hold each other.
    pub(super) peaks: Option<PerSpring>,
}

impl Equilibrium {
    /// Of nothing: fills what is computed later.
    pub(super) const NONE: Self = Self { unloaded: 0.0, balance: Balance::EMPTY, peaks: None };

    /// How many pairs carry load.
    #[must_use]
    pub fn loaded_pairs(&self) -> usize {
        // Signs add up as they are; comparisons would be gathered bit by bit and counted, in three times as many instructions.
        let signs = self.balance.loads.map(|load| usize::from((0.0 - load).is_sign_negative()));
        signs.iter().sum()
    }

    /// δ \[m\].
    #[must_use]
    pub fn transmission_error(&self) -> f64 {
        self.unloaded + self.balance.approach
    }
}

impl<'a> LoadCase<'a> {
    /// `torque` acts on the pinion \[N m\], finite and 0 or more; without torque the nearest pair just touches. Below 0 it
    /// counts as 0; what is not a finite number is beyond the model.
    #[must_use]
    pub fn new(cycle: &'a MeshCycle, design: &'a Design, torque: f64) -> Self {
        Self::of_flanks(Flanks::new(cycle, design), design, torque / cycle.pair.pinion.base_radius)
    }

    /// The same under the force F \[N\], between these flanks of the design.
    pub(super) fn of_flanks(flanks: Flanks<'a>, design: &'a Design, force: f64) -> Self {
        let (cycle, flanks) = (flanks.cycle, Arc::new(flanks));
        let face = &flanks.face;
        let sliced = Sliced::new(&flanks, design).map(Arc::new);
        // Where slices hold each other, the load of a pair is not a function of its penetration alone.
        let levels = if sliced.is_some() { Vec::new() } else { face.levels() };
        let uncoupled = match cycle.elasticity {
            Elasticity::Linear(_) => face.slices_passed(),
            Elasticity::Logarithmic { .. } => face.slices(),
        };
        let count = Count::new(&cycle.work, sliced.as_ref().map_or(uncoupled, |sliced| sliced.count()));
        // Slices take up load one by one: no cut makes what they carry smooth.
        // Corners come into contact as a square root: halving goes on to no end there, at three times the price.
        // The law of a wedge bends where the contact reaches the corner.
        let refines = sliced.is_none()
            && !face.is_sliced()
            && cycle.settings.corner_contact == CornerContact::None
            && !cycle.elasticity.is_resolved()
            // Between any two nodes there are others of a spline's points: halving would go on to all of them.
            && !flanks.is_sampled();
        let regime = match sliced {
            _ if force <= 0.0 => Regime::Unloaded,
            Some(sliced) => Regime::CoupledSlices(sliced),
            None if cycle.coupled() => Regime::CoupledPairs,
            None => Regime::Pairs,
        };
        let mut load_case = Self {
            count,
            levels,
            cycle,
            design,
            force,
            line_load: Known::new(force / cycle.face_width),
            regime,
            flanks,
            touching: Touching::LineOfAction,
            breaks: Arc::default(),
            positions: cycle.settings.positions,
            refines,
            apart: None,
            distances_between: [0.0; 2],
        };
        if cycle.settings.corner_contact == CornerContact::Exact {
            load_case.touching = load_case.corners();
        }
        load_case.follow();
        load_case
    }

    /// Finds the gaps wherever pairs may touch.
    pub(super) fn follow(&mut self) {
        let window = match self.touching {
            Touching::LineOfAction => (self.cycle.pair.start_of_contact, self.cycle.pair.end_of_contact),
            Touching::Anywhere { window, .. } => window,
        };
        self.breaks = Arc::make_mut(&mut self.flanks).follow(window).into();
    }

    /// With corner contact: between which path positions anything can touch, and the gap where the model ends. What quick
    /// copies there may be makes no difference.
    pub(super) fn corners(&self) -> Touching {
        let (pair, flanks) = (&self.cycle.pair, &self.flanks);
        let (first, last) = self.cycle.path.window();
        // A little inside, for rounding.
        let inwards = CLOSEST * pair.base_pitch;
        let ends = [flanks.searched(first + inwards), flanks.searched(last - inwards)];
        let [nearer, farther] = self.distances_between;
        let limit = ends.into_iter().flatten().fold(f64::INFINITY, f64::min) + flanks.offset() + nearer;
        // Farther out than a pair can be loaded nothing is looked at.
        let (from, to) = (pair.start_of_contact, pair.end_of_contact);
        let inside = (0..=16).map(|index| from + (to - from) * f64::from(index) / 16.0);
        let maximum = inside.fold(0.0, |maximum: f64, s| {
            maximum.max(self.alone(s, flanks, &mut None) + flanks.searched(s).unwrap_or(0.0))
        });
        let outermost = |from: f64, to: f64| {
            let (mut near, mut far) = (from, to);
            for _ in 0..MOST_HALVINGS {
                if (far - near).abs() <= NARROW * (near - from).abs() {
                    break;
                }
                let middle = 0.5 * (near + far);
                let can_touch = flanks.searched(middle).is_some_and(|gap| gap + nearer <= maximum + farther);
                *(if can_touch { &mut near } else { &mut far }) = middle;
            }
            far
        };
        Touching::Anywhere { window: (outermost(from, first), outermost(to, last)), limit }
    }

    /// Whether the number of slices across the face matters: not where every pair's load has a closed form.
    #[must_use]
    pub fn uses_slices(&self) -> bool {
        self.slices().is_some()
            || self.flanks.face.is_sliced()
            || (!self.flanks.is_flat() && matches!(self.cycle.elasticity, Elasticity::Logarithmic { .. }))
    }

    /// Checks that an approach \[m\] is within the model.
    ///
    /// # Errors
    /// With corner contact, if a pair that is no longer considered would touch, or a tip would pass the other one.
    pub fn check_approach(&self, approach: f64) -> Result<(), BeyondModel> {
        let largest = self.largest_approach();
        let beyond = || BeyondModel { approach: Millimetres(approach), largest: Millimetres(largest) };
        if approach <= largest { Ok(()) } else { Err(beyond()) }
    }

    /// The largest approach that is modelled \[m\].
    pub(super) fn largest_approach(&self) -> f64 {
        match self.touching {
            Touching::LineOfAction => f64::INFINITY,
            Touching::Anywhere { limit, .. } => limit,
        }
    }

    /// Whether flanks touch on the line of action only, from A to E.
    #[inline]
    pub(super) fn touches_on_line(&self) -> bool {
        matches!(self.touching, Touching::LineOfAction)
    }

    /// Where slices hold each other.
    pub(super) fn slices(&self) -> Option<&Sliced<'a>> {
        match &self.regime {
            Regime::CoupledSlices(slices) => Some(slices),
            Regime::Resisted(resisted) => resisted.slices(),
            Regime::Unloaded | Regime::Pairs | Regime::CoupledPairs => None,
        }
    }

    /// The same without the cuts that only integrals need: for values at points, and for extrema, which are refined on the
    /// function itself.
    #[must_use]
    pub fn for_values(&self) -> Self {
        Self { levels: Vec::new(), refines: false, ..self.clone() }
    }

    /// The same with as many positions per base pitch: gaps need not be found again.
    #[must_use]
    pub fn with_positions(&self, positions: usize) -> Self {
        Self { positions, ..self.clone() }
    }

    /// The same design under another torque, as [`LoadCase::new`] gives it, to the last bit: gaps need not be found again, but
    /// with corner contact where the load makes them be looked at farther out, or less far.
    #[must_use]
    pub fn with_torque(&self, torque: f64) -> Self {
        if let Regime::Resisted(resisted) = &self.regime {
            return self.without_friction(resisted).with_torque(torque).with_friction(resisted.friction());
        }
        let is_anywhere = !self.touches_on_line();
        if self.force <= 0.0 || torque <= 0.0 || (is_anywhere && self.flanks.is_surface) {
            return Self::new(self.cycle, self.design, torque);
        }
        let force = torque / self.cycle.pair.pinion.base_radius;
        let mut other = Self { force, line_load: Known::new(force / self.cycle.face_width), ..self.clone() };
        if let Touching::Anywhere { window, .. } = self.touching {
            other.touching = other.corners();
            if !matches!(other.touching, Touching::Anywhere { window: now, .. } if now == window) {
                other.follow();
            }
        }
        other
    }

    /// The same design when nothing is transmitted.
    #[must_use]
    pub fn without_load(&self) -> Self {
        Self { force: 0.0, regime: Regime::Unloaded, levels: Vec::new(), refines: false, ..self.clone() }
    }

    /// The gap, where the flanks come nearest; with corner contact none where they are too far apart.
    #[must_use]
    pub fn gap(&self, s: f64) -> Option<f64> {
        self.gap_between(&self.flanks, s)
    }

    #[inline]
    pub(super) fn gap_between(&self, flanks: &Flanks<'a>, s: f64) -> Option<f64> {
        match self.touching {
            Touching::Anywhere { window, .. } if s < window.0 || s > window.1 => None,
            _ => flanks.gap(s),
        }
    }

    /// Equilibrium at the cycle position τ with `pairs` inside the path of contact, the newest first.
    #[must_use]
    pub fn state(&self, position: f64, pairs: usize) -> Equilibrium {
        let mut found = [Equilibrium::NONE];
        if self.together(&[position], pairs, &mut found).is_some() {
            return found[0];
        }
        self.in_general(position, pairs)
    }

    /// The same whatever the pairs, their faces and their laws are.
    pub(super) fn in_general(&self, position: f64, pairs: usize) -> Equilibrium {
        if let Some((_, state)) = self.resisted(position, pairs) {
            return state;
        }
        let mut nearest = None;
        let reach = self.within_reach(position, pairs, None, &mut nearest);
        let (balance, peaks) = self.balance(&reach, nearest.as_ref());
        let unloaded = reach.smallest + self.flanks.offset();
        if matches!(self.touching, Touching::LineOfAction) {
            return Equilibrium { unloaded, balance, peaks };
        }
        let spread = |values: &PerSpring, missing: f64| {
            let mut spread = [missing; MOST_SPRINGS];
            reach.springs().iter().zip(values).for_each(|(&spring, value)| spread[spring] = *value);
            spread
        };
        let (loads, penetration) = (spread(&balance.loads, 0.0), spread(&balance.penetration, OUT_OF_REACH));
        let balance = Balance { loads, penetration, ..balance };
        Equilibrium { unloaded, balance, peaks: peaks.map(|peaks| spread(&peaks, 0.0)) }
    }

    /// How far the loads of all others would press the flanks of a pair into each other, if it carried nothing: of the sign of
    /// its penetration, but smooth where it takes up load. None where slices hold each other, friction takes part, or there are no
    /// others.
    pub(super) fn pressed_by_others(&self, position: f64, pairs: usize, spring: usize) -> Option<f64> {
        if matches!(self.regime, Regime::Unloaded | Regime::CoupledSlices(_) | Regime::Resisted(_)) {
            return None;
        }
        let s = self.cycle.path_position(position, spring);
        let gap = self.gap_of(spring, s)?;
        if self.cycle.springs(pairs) == 2
            && let Some(other) = self.of_plain_pair(position, 1 - spring)
        {
            return Some(other - gap);
        }
        let mut nearest = None;
        let reach = self.within_reach(position, pairs, Some(spring), &mut nearest);
        if reach.springs().is_empty() {
            return None;
        }
        let balance = self.balance(&reach, nearest.as_ref()).0;
        let by_others = if matches!(self.regime, Regime::Pairs) {
            0.0
        } else {
            let others = reach.springs().iter().zip(reach.positions()).zip(&balance.loads);
            others.map(|((&other, &at), load)| load * self.cycle.coupling(s.min(at), spring.abs_diff(other))).sum()
        };
        Some(reach.smallest - gap + balance.approach - by_others)
    }

    /// Where slices hold each other: the load, over the force, that a slice carries and its recomputed penetration does not
    /// explain, and its limit in roundings.
    #[must_use]
    pub fn unexplained_by_slices(&self, position: f64, pairs: usize) -> Option<[f64; 2]> {
        let slices = self.slices()?;
        if let Some((loading, _)) = self.resisted(position, pairs) {
            return loading.unexplained_by_slices(position, pairs);
        }
        let reach = self.within_reach(position, pairs, None, &mut None);
        Some(slices.unexplained(self, &reach, [self.force, self.above(&reach, &mut None)]))
    }

    /// Where slices hold each other: the load per width \[N/m\] of each slice of the whole face, of each pair within reach by
    /// its spring.
    pub(super) fn loads_of_slices(&self, position: f64, pairs: usize) -> Option<Vec<(usize, Vec<f64>)>> {
        let slices = self.slices()?;
        if let Some((loading, _)) = self.resisted(position, pairs) {
            return loading.loads_of_slices(position, pairs);
        }
        let reach = self.within_reach(position, pairs, None, &mut None);
        let loads = slices.line_loads(self, &reach, [self.force, self.above(&reach, &mut None)]);
        Some(reach.springs().iter().copied().zip(loads).collect())
    }

    /// The pairs that can touch at all, but for one that may be left out; with corner contact, only those that come near
    /// enough. Finding those may take the law of the nearest pair, which is left for what follows.
    #[inline(always)]
    #[allow(clippy::inline_always)] // returned, it would be copied for every equilibrium
    fn within_reach(
        &self,
        position: f64,
        pairs: usize,
        left_out: Option<usize>,
        nearest: &mut Option<InSeries<'a>>,
    ) -> WithinReach {
        let mut reach = WithinReach::none();
        for spring in (0..self.cycle.springs(pairs)).filter(|spring| Some(*spring) != left_out) {
            let s = self.cycle.path_position(position, spring);
            if let Some(gap) = self.gap_of(spring, s) {
                reach.push(spring, s, gap);
            }
        }
        reach.count_gaps_from_the_smallest();
        if matches!(self.touching, Touching::Anywhere { .. }) && self.force > 0.0 {
            reach.keep_nearer_than(self.above(&reach, nearest));
        }
        reach
    }

    /// An approach that no equilibrium exceeds, from the smallest gap on, where the nearest pair is at `s` and has these flanks:
    /// twice that of this pair alone. For loads λ_j of least complementary energy U, x F = Σ w_j λ_j + Σ gap_j λ_j ≤ 2 U since
    /// approaches bend down with the load, and U ≤ F w(F) of any one pair alone.
    ///
    /// Leaves the law of that pair, if it took it.
    pub(super) fn alone(&self, s: f64, flanks: &Flanks<'a>, law: &mut Option<InSeries<'a>>) -> f64 {
        let alone = match &self.cycle.elasticity {
            Elasticity::Linear(stiffness) => self.force / stiffness.value(s),
            elasticity @ Elasticity::Logarithmic { .. } if self.force > 0.0 => {
                let (Known { number, log }, plain) = (self.line_load, elasticity.plain(s));
                if plain.holds(number) {
                    return 2.0 * (plain.rates_at(elasticity.rates()[0], number, log)[0] + flanks.mean(s));
                }
                let law = law.insert(elasticity.series(s, None));
                law.at_known_load(number, log).0
            }
            Elasticity::Logarithmic { .. } => 0.0,
        };
        2.0 * (alone + flanks.mean(s))
    }
}
