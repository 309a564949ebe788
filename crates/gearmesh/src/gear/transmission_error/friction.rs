//! Friction of the flanks along the path of contact: what rubs where, what is lost, and equilibrium with it.
//!
//! At path position s the contact moves along the flanks of pinion and gear at ω1 s and ω2 (L − s), and friction has these
//! levers s and L − s about the centres. Before the pitch point it drives the pinion and holds the gear back, beyond it the
//! reverse, and with a normal force F the moments are F(r_b1 ± μ s) and F(r_b2 ± μ(L − s)): the torque T1 is in equilibrium where
//! Σ F(1 ± μ s/r_b1) = T1/r_b1. The energy that is lost is then μ F v_g at every position. At a corner of a tip the levers are
//! those of the point that touches. Exactly at the pitch point nothing slides, and nothing rubs. Teeth do not deflect under
//! friction. Source of the local loss factor: Wimmer, Lastverluste von Stirnradverzahnungen, dissertation, TU München 2006. Must
//! not know: any single law, tables.

use std::sync::Arc;

use super::cycle::MeshCycle;
use super::load_case::{Equilibrium, LoadCase, Regime};
use super::sliced::Sliced;
use crate::gear::contact::flattening::combined_radius;
use crate::gear::friction::{Law, Limit, Rolling};
use crate::gear::geometry::Side;
use crate::numeric::complementarity::MOST_SPRINGS;
use crate::numeric::logarithm::Known;

/// The total normal force is that of equilibrium when another step changes it by less than this of it.
const EQUAL: f64 = 4.0 * f64::EPSILON;
/// Steps to it: a step of the secant takes some three digits more than the one before.
const MOST_STEPS: usize = 40;
/// Of the force: pairs that carry less are not asked whether a law knows them.
const SMALL: f64 = 0.05;

/// Under what flanks rub.
#[derive(Clone, Copy, Debug)]
pub struct Friction<'a> {
    /// The coefficient of friction.
    pub law: &'a dyn Law,
    /// ω1: at which the pinion turns \[rad/s\], above 0.
    pub speed: f64,
}

/// A pair that rubs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rubbing {
    /// F: normal force \[N\].
    pub load: f64,
    /// What its contact is like, under the mean load per width.
    pub rolling: Rolling,
    /// μ; 0 without load, and of a local law where nothing slides.
    pub coefficient: f64,
    /// Of friction about the centres of pinion and gear \[m\].
    pub levers: [f64; 2],
}

impl Rubbing {
    /// μ F \[N\].
    #[must_use]
    pub fn force(&self) -> f64 {
        self.coefficient * self.load
    }

    /// μ F v_g \[W\].
    #[must_use]
    pub fn power(&self) -> f64 {
        self.force() * self.rolling.sliding().abs()
    }

    /// Moments of normal force and friction about the centres \[N m\], as pinion and gear need and give them.
    #[must_use]
    pub fn moments(&self, base_radii: [f64; 2]) -> [f64; 2] {
        let sliding = self.rolling.sliding();
        let direction = if sliding > 0.0 {
            1.0
        } else if sliding < 0.0 {
            -1.0
        } else {
            0.0
        };
        [0, 1].map(|gear| self.load * (base_radii[gear] + direction * self.coefficient * self.levers[gear]))
    }
}

/// What is lost over the mesh cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct Loss {
    /// H_VL = (1/p_b) ∫ Σ (F/F_b)(v_g/v_b) dτ under the loads that there are, with F_b = T1/r_b1 and v_b = ω1 r_b1.
    pub tooth_loss_factor: f64,
    /// P_VZP: integral mean of Σ μ F v_g \[W\].
    pub power: f64,
    /// μ_m = P_VZP/(P_A H_VL): the mean coefficient, by load and sliding.
    pub mean_coefficient: f64,
    /// η = 1 − P_VZP/P_A.
    pub efficiency: f64,
    /// T2 = (P_A − P_VZP)/ω2 \[N m\].
    pub gear_torque: f64,
    /// What the law does not know of loaded pairs: each quantity where it is farthest out.
    pub beyond: Vec<Limit>,
}

/// A place on the path of contact and the pair there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Steps from A; below 0 before it.
    pub step: isize,
    /// From A along the line of action \[m\].
    pub path_position: f64,
    /// The pinion's roll angle where the flanks touch \[rad\].
    pub roll_angle: f64,
    /// What rubs there.
    pub rubbing: Rubbing,
}

/// A law under a torque.
#[derive(Clone, Copy, Debug)]
struct Loaded<'a> {
    friction: Friction<'a>,
    /// Of a law that is the same all along the path.
    mean: Option<f64>,
}

/// What holds what beside friction, and friction.
pub(super) struct Resisted<'a> {
    loaded: Loaded<'a>,
    regime: Regime<'a>,
    /// Where in the cycle a pair passes the pitch point.
    pitch_point: Option<f64>,
}

impl<'a> Resisted<'a> {
    pub(super) fn friction(&self) -> Friction<'a> {
        self.loaded.friction
    }

    pub(super) fn slices(&self) -> Option<&Sliced<'a>> {
        if let Regime::CoupledSlices(slices) = &self.regime { Some(slices) } else { None }
    }
}

impl MeshCycle {
    /// Levers of friction about the centres of pinion and gear \[m\]: s and L − s, and those of the point at the corner of a tip,
    /// along the normal of the other flank.
    pub(super) fn friction_levers(&self, s: f64) -> [f64; 2] {
        let (radii, turned) = (self.radii(s), self.inclinations(s));
        let base_radii = self.base_radii();
        [0, 1].map(|gear| {
            if turned[gear] == 0.0 {
                return radii[gear];
            }
            let (sine, cosine) = libm::sincos(turned[gear]);
            radii[gear] * cosine + base_radii[gear] * sine
        })
    }

    fn base_radii(&self) -> [f64; 2] {
        [Side::Pinion, Side::Gear].map(|side| self.pair.side(side).base_radius)
    }

    /// Where in the cycle a pair passes the pitch point; none where that is not on the path of contact.
    fn at_pitch_point(&self) -> Option<f64> {
        let points = self.pair.zone_points();
        (points.c > points.a && points.c < points.e).then(|| (points.c - points.a).rem_euclid(self.period()))
    }

    fn rolling(&self, s: f64, line_load: f64, speed: f64) -> (Rolling, [f64; 2]) {
        let (levers, base_radii) = (self.friction_levers(s), self.base_radii());
        let radius = combined_radius(self.touching(s).0);
        let speeds = [levers[0] * speed, levers[1] * (speed * base_radii[0] / base_radii[1])];
        let pressure = if radius > 0.0 { self.bodies.pressure(radius, line_load) } else { 0.0 };
        (Rolling { line_load, pressure, radius, speeds }, levers)
    }
}

impl<'a> LoadCase<'a> {
    /// The same design under the same torque on the pinion, with friction of the flanks in the balance of the loads. For flanks
    /// that touch from A to E only. Without load nothing rubs.
    #[must_use]
    pub fn with_friction(self, friction: Friction<'a>) -> Self {
        if self.force <= 0.0 || !self.force.is_finite() {
            return self;
        }
        let (loaded, pitch_point) = (self.loaded(friction), self.cycle.at_pitch_point());
        let breaks = self.breaks_and_pitch_point();
        let regime = Regime::Resisted(Arc::new(Resisted { loaded, regime: self.regime.clone(), pitch_point }));
        // Local laws bend without end towards the pitch point, where halving goes on at a price that the laws are not worth.
        Self { regime, breaks, refines: self.refines && friction.law.is_mean(), ..self }
    }

    pub(super) fn without_friction(&self, resisted: &Resisted<'a>) -> Self {
        Self { regime: resisted.regime.clone(), ..self.clone() }
    }

    /// Whether loads jump there, since friction changes its direction.
    #[allow(clippy::float_cmp)] // one is a copy of the other
    pub(super) fn jumps_at(&self, position: f64) -> bool {
        matches!(&self.regime, Regime::Resisted(resisted) if resisted.pitch_point == Some(position))
    }

    fn breaks_and_pitch_point(&self) -> Arc<[f64]> {
        let mut breaks: Vec<f64> = self.breaks.iter().copied().chain(self.cycle.at_pitch_point()).collect();
        breaks.sort_by(f64::total_cmp);
        breaks.into()
    }

    fn loaded(&self, friction: Friction<'a>) -> Loaded<'a> {
        let mean = friction.law.is_mean().then(|| friction.law.coefficient(&self.at_pitch_point(friction)));
        Loaded { friction, mean }
    }

    /// The contact at the pitch point under the whole load.
    fn at_pitch_point(&self, friction: Friction) -> Rolling {
        let s = self.cycle.pair.zone_points().c;
        self.cycle.rolling(s, self.force / self.cycle.face_width, friction.speed).0
    }

    fn rubbing_of(&self, loaded: &Loaded, s: f64, load: f64) -> Rubbing {
        let (rolling, levers) = self.cycle.rolling(s, load / self.cycle.face_width, loaded.friction.speed);
        let rubs = load > 0.0 && rolling.radius > 0.0;
        let coefficient = match loaded.mean {
            Some(mean) if rubs => mean,
            None if rubs && rolling.sliding() != 0.0 => loaded.friction.law.coefficient(&rolling),
            _ => 0.0,
        };
        Rubbing { load, rolling, coefficient, levers }
    }

    fn rubbing_at(&self, loaded: &Loaded, position: f64, pairs: usize, state: &Equilibrium) -> [Rubbing; MOST_SPRINGS] {
        let mut found = [Rubbing::default(); MOST_SPRINGS];
        for (spring, rubbing) in found.iter_mut().enumerate().take(self.cycle.springs(pairs)) {
            let s = self.cycle.path_position(position, spring);
            *rubbing = self.rubbing_of(loaded, s, state.balance.loads[spring]);
        }
        found
    }

    /// What rubs at a position, by its springs.
    #[must_use]
    pub fn rubbing(&self, friction: Friction<'a>, position: f64, pairs: usize) -> [Rubbing; MOST_SPRINGS] {
        self.rubbing_at(&self.loaded(friction), position, pairs, &self.state(position, pairs))
    }

    /// With friction in the balance: the same without, under as much more or less normal force as it takes at a position, and its
    /// equilibrium.
    #[inline]
    pub(super) fn resisted(&self, position: f64, pairs: usize) -> Option<(Self, Equilibrium)> {
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
        let mut under = |force: f64| {
            loading.force = force;
            loading.line_load = Known::new(force / self.cycle.face_width);
            let state = loading.state(position, pairs);
            let rubbing = self.rubbing_at(&resisted.loaded, position, pairs, &state);
            let moment: f64 = rubbing.iter().map(|rubbing| rubbing.moments(base_radii)[0]).sum();
            (state, moment / base_radii[0] - self.force)
        };
        let mut before = self.force;
        let (mut state, mut excess_before) = under(before);
        if excess_before.abs() <= EQUAL * before {
            return (loading, state);
        }
        // The moment is nearly proportional to the force.
        let mut force = before * self.force / (self.force + excess_before);
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
        (loading, state)
    }

    /// What is lost over the cycle, and what the gear is left with. Without torque or beyond the model all of it is NaN.
    #[must_use]
    pub fn friction_loss(&self, friction: Friction<'a>) -> Loss {
        let (cycle, loaded) = (self.cycle, self.loaded(friction));
        // Its direction changes at the pitch point, so that the power has a kink there.
        let cut = Self { breaks: self.breaks_and_pitch_point(), ..self.clone() };
        let (mut sliding, mut power) = (0.0, 0.0);
        let mut beyond = Beyond::default();
        if loaded.mean.is_some() {
            beyond.see(&friction.law.limits(&self.at_pitch_point(friction)));
        }
        cut.walk(cut.span_length(0), |span, states| {
            for (node, state) in states.iter().enumerate() {
                let weight = span.weight(&cycle.rows, node) / cycle.period();
                let position = span.position(&cycle.rows, node);
                for rubbing in self.rubbing_at(&loaded, position, span.pairs, state) {
                    sliding += weight * rubbing.load * rubbing.rolling.sliding().abs();
                    power += weight * rubbing.power();
                    let slides = rubbing.rolling.sliding() != 0.0;
                    if loaded.mean.is_none() && slides && rubbing.load > SMALL * self.force {
                        beyond.see(&friction.law.limits(&rubbing.rolling));
                    }
                }
            }
        });
        let base_radii = cycle.base_radii();
        let torque = self.force * base_radii[0];
        let input = torque * friction.speed;
        Loss {
            tooth_loss_factor: sliding / input,
            power,
            mean_coefficient: power / sliding,
            efficiency: 1.0 - power / input,
            gear_torque: (torque - power / friction.speed) * base_radii[1] / base_radii[0],
            beyond: beyond.found,
        }
    }

    /// Power that is lost at a position \[W\], and the torque that the gear is left with \[N m\].
    #[must_use]
    pub fn friction_at(&self, friction: Friction<'a>, position: f64, pairs: usize) -> [f64; 2] {
        let power: f64 = self.rubbing(friction, position, pairs).iter().map(Rubbing::power).sum();
        let base_radii = self.cycle.base_radii();
        [power, (self.force * base_radii[0] - power / friction.speed) * base_radii[1] / base_radii[0]]
    }

    /// What rubs along the path of contact, with so many steps in a base pitch: pairs from A to E, and those before A and after E
    /// that carry load.
    #[must_use]
    pub fn friction_along(&self, friction: Friction<'a>, steps: usize) -> Vec<Place> {
        let cycle = self.cycle;
        let mut places = Vec::new();
        for step in 0..steps {
            let position = cycle.period() * step as f64 / steps as f64;
            let pairs = cycle.pairs_behind(position);
            let rubbing = self.rubbing(friction, position, pairs);
            for (spring, rubbing) in rubbing.into_iter().enumerate().take(cycle.springs(pairs)) {
                let ahead = spring.cast_signed() - cycle.newest().cast_signed();
                if !(0..pairs.cast_signed()).contains(&ahead) && rubbing.load <= 0.0 {
                    continue;
                }
                let s = cycle.path_position(position, spring);
                places.push(Place {
                    step: step.cast_signed() + ahead * steps.cast_signed(),
                    path_position: s - cycle.pair.start_of_contact,
                    roll_angle: cycle.rolls(s)[0],
                    rubbing,
                });
            }
        }
        places.sort_by_key(|place| place.step);
        places
    }
}

/// The limits that were passed, each where it is passed most.
#[derive(Default)]
struct Beyond {
    found: Vec<Limit>,
}

impl Beyond {
    fn see(&mut self, limits: &[Limit]) {
        for limit in limits.iter().filter(|limit| limit.value < limit.range[0] || limit.value > limit.range[1]) {
            match self.found.iter_mut().find(|known| known.quantity == limit.quantity) {
                None => self.found.push(*limit),
                Some(known) if farther_out(limit, known) => *known = *limit,
                Some(_) => (),
            }
        }
    }
}

fn farther_out(one: &Limit, other: &Limit) -> bool {
    let out = |limit: &Limit| (limit.range[0] - limit.value).max(limit.value - limit.range[1]);
    out(one) > out(other)
}
