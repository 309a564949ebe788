//! One design under one torque: equilibrium at any position of the mesh cycle.
//!
//! Must not know: which positions are computed, what is done with the values.

use std::sync::Arc;

use super::beyond_model::BeyondModel;
use super::coupled_slices::CoupledSlices;
use super::flanks::Flanks;
use super::individual_pairs::IndividualPairs;
use super::state::{Equilibrium, OUT_OF_REACH};
use crate::gear::contact::CornerContact;
use crate::gear::geometry::error::Millimetres;
use crate::gear::mesh::cycle::count::Count;
use crate::gear::mesh::cycle::flank_friction::{Friction, FrictionUnderForce};
use crate::gear::mesh::cycle::mesh::{Elasticity, Mesh};
use crate::gear::mesh::cycle::path::CLOSEST;
use crate::gear::modification::Design;
use crate::numeric::complementarity::{Balance, MOST_SPRINGS, PerSpring};
use crate::numeric::logarithm::Known;

/// A design under a torque.
#[derive(Clone)]
pub(in crate::gear::mesh) struct LoadCase<'a> {
    /// The pair's mesh cycle, without load and modifications.
    pub(in crate::gear::mesh) cycle: &'a Mesh,
    /// F = T / r_b1 \[N\].
    pub(in crate::gear::mesh) force: f64,
    /// F over the face width \[N/m\], and its logarithm.
    pub(in crate::gear::mesh) line_load: Known,
    pub(in crate::gear::mesh) design: &'a Design,
    pub(in crate::gear::mesh) flanks: Arc<Flanks<'a>>,
    pub(in crate::gear::mesh) regime: Regime<'a>,
    pub(in crate::gear::mesh) touching: Touching,
    /// Cycle positions at which a profile is not smooth, ascending.
    pub(in crate::gear::mesh) breaks: Arc<[f64]>,
    /// Penetrations at which the load of a pair is not smooth, besides 0.
    pub(in crate::gear::mesh) levels: Vec<f64>,
    pub(in crate::gear::mesh) count: Count<'a>,
    /// Positions per base pitch.
    pub(in crate::gear::mesh) positions: usize,
    /// Whether spans next to a change are cut until their nodes can follow: for what is integrated.
    pub(in crate::gear::mesh) refines: bool,
    /// What pairs have that the design does not say of all.
    pub(in crate::gear::mesh) apart: Option<IndividualPairs<'a>>,
    /// Between what they may be farther apart by that than the design's flanks say \[m\].
    pub(in crate::gear::mesh) distances_between: [f64; 2],
}

/// What holds what when the load spreads; each costs more than the one before.
#[derive(Clone)]
pub(in crate::gear::mesh) enum Regime<'a> {
    /// Nothing is transmitted: the nearest pair just touches.
    Unloaded,
    /// Each pair holds itself.
    Pairs,
    /// Each pair's load deflects its neighbours too.
    CoupledPairs,
    /// Each slice's load deflects all others.
    CoupledSlices(Arc<CoupledSlices<'a>>),
    /// Friction of the flanks takes part, beside what holds what.
    Resisted(Arc<Resisted<'a>>),
}

/// What holds what beside friction, and friction.
pub(in crate::gear::mesh) struct Resisted<'a> {
    friction: FrictionUnderForce<'a>,
    regime: Regime<'a>,
    /// Where in the cycle a pair passes the pitch point.
    pitch_point: Option<f64>,
}

impl<'a> Resisted<'a> {
    pub(in crate::gear::mesh) fn slices(&self) -> Option<&CoupledSlices<'a>> {
        if let Regime::CoupledSlices(slices) = &self.regime { Some(slices) } else { None }
    }
}

/// Where a pair may touch.
#[derive(Clone, Copy)]
pub(in crate::gear::mesh) enum Touching {
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
/// The total normal force is that of equilibrium if another step changes it by less than this share of it.
const EQUAL: f64 = 4.0 * f64::EPSILON;
/// Steps to it: a step of the secant takes some three digits more than the one before.
const MOST_STEPS: usize = 40;

impl<'a> LoadCase<'a> {
    /// `torque` acts on the pinion \[N m\], finite and 0 or more; without torque the nearest pair just touches. Below 0 it
    /// counts as 0; what is not a finite number is beyond the model.
    #[must_use]
    pub(in crate::gear::mesh) fn new(cycle: &'a Mesh, design: &'a Design, torque: f64) -> Self {
        Self::of_flanks(Flanks::new(cycle, design), design, torque / cycle.pair.pinion.base_radius)
    }

    /// The same under the force F \[N\], between these flanks of the design.
    pub(in crate::gear::mesh) fn of_flanks(flanks: Flanks<'a>, design: &'a Design, force: f64) -> Self {
        let (cycle, flanks) = (flanks.cycle, Arc::new(flanks));
        let face = &flanks.face;
        let sliced = CoupledSlices::new(&flanks, design).map(Arc::new);
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
    pub(in crate::gear::mesh) fn follow(&mut self) {
        let window = match self.touching {
            Touching::LineOfAction => (self.cycle.pair.start_of_contact, self.cycle.pair.end_of_contact),
            Touching::Anywhere { window, .. } => window,
        };
        self.breaks = Arc::make_mut(&mut self.flanks).follow(window).into();
    }

    /// With corner contact: between which path positions anything can touch, and the gap where the model ends. What quick
    /// copies there may be makes no difference.
    pub(in crate::gear::mesh) fn corners(&self) -> Touching {
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
    pub(in crate::gear::mesh) fn uses_slices(&self) -> bool {
        self.slices().is_some()
            || self.flanks.face.is_sliced()
            || (!self.flanks.is_flat() && matches!(self.cycle.elasticity, Elasticity::Logarithmic { .. }))
    }

    /// Checks that an approach \[m\] is within the model.
    ///
    /// # Errors
    /// With corner contact, if a pair that is no longer considered would touch, or a tip would pass the other one.
    pub(in crate::gear::mesh) fn check_approach(&self, approach: f64) -> Result<(), BeyondModel> {
        let largest = self.largest_approach();
        let beyond = || BeyondModel { approach: Millimetres(approach), largest: Millimetres(largest) };
        if approach <= largest { Ok(()) } else { Err(beyond()) }
    }

    /// The largest approach that is modelled \[m\].
    pub(in crate::gear::mesh) fn largest_approach(&self) -> f64 {
        match self.touching {
            Touching::LineOfAction => f64::INFINITY,
            Touching::Anywhere { limit, .. } => limit,
        }
    }

    /// Whether flanks touch on the line of action only, from A to E.
    #[inline]
    pub(in crate::gear::mesh) fn touches_on_line(&self) -> bool {
        matches!(self.touching, Touching::LineOfAction)
    }

    /// Where slices hold each other.
    pub(in crate::gear::mesh) fn slices(&self) -> Option<&CoupledSlices<'a>> {
        match &self.regime {
            Regime::CoupledSlices(slices) => Some(slices),
            Regime::Resisted(resisted) => resisted.slices(),
            Regime::Unloaded | Regime::Pairs | Regime::CoupledPairs => None,
        }
    }

    /// The same without the cuts that only integrals need: for values at points, and for extrema, which are refined on the
    /// function itself.
    #[must_use]
    pub(in crate::gear::mesh) fn for_values(&self) -> Self {
        Self { levels: Vec::new(), refines: false, ..self.clone() }
    }

    /// The same with as many positions per base pitch: gaps need not be found again.
    #[must_use]
    pub(in crate::gear::mesh) fn with_positions(&self, positions: usize) -> Self {
        Self { positions, ..self.clone() }
    }

    /// The same design without friction under another torque, as [`LoadCase::new`] gives it, to the last bit: gaps need not be found again, but
    /// with corner contact where the load makes them be looked at farther out, or less far.
    #[must_use]
    pub(in crate::gear::mesh) fn with_torque(&self, torque: f64) -> Self {
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
    pub(in crate::gear::mesh) fn without_load(&self) -> Self {
        Self { force: 0.0, regime: Regime::Unloaded, levels: Vec::new(), refines: false, ..self.clone() }
    }

    /// The gap, where the flanks come nearest; with corner contact none where they are too far apart.
    #[must_use]
    pub(in crate::gear::mesh) fn gap(&self, s: f64) -> Option<f64> {
        self.gap_between(&self.flanks, s)
    }

    #[inline]
    pub(in crate::gear::mesh) fn gap_between(&self, flanks: &Flanks<'a>, s: f64) -> Option<f64> {
        match self.touching {
            Touching::Anywhere { window, .. } if s < window.0 || s > window.1 => None,
            _ => flanks.gap(s),
        }
    }

    /// Equilibrium at the cycle position τ with `pairs` inside the path of contact, the newest first.
    #[must_use]
    pub(in crate::gear::mesh) fn state(&self, position: f64, pairs: usize) -> Equilibrium {
        let mut found = [Equilibrium::NONE];
        if self.together(&[position], pairs, &mut found).is_some() {
            return found[0];
        }
        self.in_general(position, pairs)
    }

    /// The same whatever the pairs, their faces and their laws are.
    pub(in crate::gear::mesh) fn in_general(&self, position: f64, pairs: usize) -> Equilibrium {
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

    /// Whether every pair is what the design says of all.
    #[inline]
    pub(in crate::gear::mesh) fn is_evenly_spaced(&self) -> bool {
        self.apart.is_none()
    }

    /// The flanks of the pair that is this spring.
    #[inline]
    pub(in crate::gear::mesh) fn flanks_of(&self, spring: usize) -> &Flanks<'a> {
        let own = self.apart.as_ref().and_then(|apart| apart.flanks[spring].as_deref());
        own.unwrap_or(&self.flanks)
    }

    /// The gap of the pair that is this spring.
    #[inline]
    pub(in crate::gear::mesh) fn gap_of(&self, spring: usize, s: f64) -> Option<f64> {
        match &self.apart {
            None => self.gap(s),
            Some(apart) => Some(self.gap_between(self.flanks_of(spring), s)? + apart.distances[spring]),
        }
    }

    /// The same for pairs that are farther apart than the design's flanks say, by amounts between these \[m\].
    pub(in crate::gear::mesh) fn with_distances_between(self, distances_between: [f64; 2]) -> Self {
        let mut other = Self { distances_between, ..self };
        if !other.touches_on_line() {
            other.touching = other.corners();
            other.follow();
        }
        other
    }

    /// The same design under the same torque on the pinion, with friction of the flanks in the balance of the loads. For flanks
    /// that touch from A to E only. Without load nothing rubs.
    #[must_use]
    pub(in crate::gear::mesh) fn with_friction(self, friction: Friction<'a>) -> Self {
        if self.force <= 0.0 || !self.force.is_finite() {
            return self;
        }
        let breaks = self.breaks_and_pitch_point();
        let resisted = Resisted {
            friction: self.under_friction(friction),
            regime: self.regime.clone(),
            pitch_point: self.cycle.pitch_point_position(),
        };
        let regime = Regime::Resisted(Arc::new(resisted));
        // Local laws bend without end towards the pitch point, where halving goes on at a price that the laws are not worth.
        Self { regime, breaks, refines: self.refines && friction.law.is_mean(), ..self }
    }

    pub(in crate::gear::mesh) fn without_friction(&self, resisted: &Resisted<'a>) -> Self {
        Self { regime: resisted.regime.clone(), ..self.clone() }
    }

    /// Whether loads jump there, since friction changes its direction.
    #[allow(clippy::float_cmp)] // one is a copy of the other
    pub(in crate::gear::mesh) fn jumps_at(&self, position: f64) -> bool {
        matches!(&self.regime, Regime::Resisted(resisted) if resisted.pitch_point == Some(position))
    }

    /// A law of friction under the force of this load case.
    pub(in crate::gear::mesh) fn under_friction(&self, friction: Friction<'a>) -> FrictionUnderForce<'a> {
        FrictionUnderForce::new(self.cycle, friction, self.force)
    }

    pub(in crate::gear::mesh) fn breaks_and_pitch_point(&self) -> Arc<[f64]> {
        let mut breaks: Vec<f64> = self.breaks.iter().copied().chain(self.cycle.pitch_point_position()).collect();
        breaks.sort_by(f64::total_cmp);
        breaks.into()
    }

    /// With friction in the balance: the same without, under as much more or less normal force as it takes at a position, and its
    /// equilibrium.
    #[inline]
    pub(in crate::gear::mesh) fn resisted(&self, position: f64, pairs: usize) -> Option<(Self, Equilibrium)> {
        if let Regime::Resisted(resisted) = &self.regime {
            Some(self.resisted_by(resisted, position, pairs))
        } else {
            None
        }
    }

    #[cold]
    fn resisted_by(&self, resisted: &Resisted<'a>, position: f64, pairs: usize) -> (Self, Equilibrium) {
        let mut loading = self.without_friction(resisted);
        let base_radii = self.cycle.base_radii();
        // Equilibrium under a total normal force, and by how much its moment is too large, as a force.
        let state = balanced_force(self.force, |force| {
            loading.force = force;
            loading.line_load = Known::new(force / self.cycle.face_width);
            let state = loading.state(position, pairs);
            let rubbing = resisted.friction.rubbing(position, pairs, &state.balance.loads);
            let moment: f64 = rubbing.iter().map(|rubbing| rubbing.moments(base_radii)[0]).sum();
            (state, moment / base_radii[0] - self.force)
        });
        (loading, state)
    }
}

/// The total normal force under which nothing is left of an excess that is nearly proportional to it, by the secant method from
/// the force without friction: the last value of `under`, which gives a state and its excess.
fn balanced_force<State>(without: f64, mut under: impl FnMut(f64) -> (State, f64)) -> State {
    let mut before = without;
    let (mut state, mut excess_before) = under(before);
    if excess_before.abs() <= EQUAL * before {
        return state;
    }
    let mut force = before * without / (without + excess_before);
    for _ in 0..MOST_STEPS {
        let excess;
        (state, excess) = under(force);
        let step = excess * (force - before) / (excess - excess_before);
        // Where the excess no longer changes, it is rounding.
        if !step.is_finite() || step.abs() <= EQUAL * force {
            break;
        }
        (before, excess_before) = (force, excess);
        force -= step;
    }
    state
}
