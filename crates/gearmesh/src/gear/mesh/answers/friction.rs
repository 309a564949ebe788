//! Friction of the flanks along the path of contact: what rubs where, what is lost, and equilibrium with it.
//!
//! At path position s the contact moves along the flanks of pinion and gear at ω1 s and ω2 (L − s), and friction has these
//! levers s and L − s about the centres. Before the pitch point it drives the pinion and holds the gear back, beyond it the
//! reverse, and with a normal force F the moments are F(r_b1 ± μ s) and F(r_b2 ± μ(L − s)): the torque T1 is in equilibrium where
//! Σ F(1 ± μ s/r_b1) = T1/r_b1. The energy that is lost is then μ F v_g at every position. At a corner of a tip the levers are
//! those of the point that touches. Exactly at the pitch point nothing slides, and nothing rubs. Teeth do not deflect under
//! friction. Source of the local loss factor: Wimmer, Lastverluste von Stirnradverzahnungen, dissertation, TU München 2006. Must
//! not know: any single law, tables.

use super::walk::{span_length, walk};
use crate::gear::friction::Limit;
use crate::gear::mesh::cycle::flank_friction::{FlankFriction, Friction};
use crate::gear::mesh::equilibrium::load_case::LoadCase;
use crate::numeric::complementarity::MOST_SPRINGS;

/// Of the force: pairs that carry less are not asked whether a law knows them.
const SMALL: f64 = 0.05;

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
    pub rubbing: FlankFriction,
}

/// Friction at a position, by its springs.
pub(in crate::gear::mesh) fn rubbing<'a>(
    case: &LoadCase<'a>,
    friction: Friction<'a>,
    position: f64,
    pairs: usize,
) -> [FlankFriction; MOST_SPRINGS] {
    case.under_friction(friction).rubbing(position, pairs, &case.state(position, pairs).balance.loads)
}

/// The loss over the cycle, and the torque that the gear is left with. Without torque or beyond the model all of it is NaN.
pub(in crate::gear::mesh) fn friction_loss<'a>(case: &LoadCase<'a>, friction: Friction<'a>) -> Loss {
    let (cycle, law) = (case.cycle, case.under_friction(friction));
    // Its direction changes at the pitch point, so that the power has a kink there.
    let cut = LoadCase { breaks: case.breaks_and_pitch_point(), ..case.clone() };
    let (mut sliding, mut power) = (0.0, 0.0);
    let mut beyond = Beyond::default();
    if law.mean.is_some() {
        beyond.see(&friction.law.limits(&law.at_pitch_point()));
    }
    walk(&cut, span_length(&cut, 0), |span, states| {
        for (node, state) in states.iter().enumerate() {
            let weight = span.weight(&cycle.rows, node) / cycle.period();
            let position = span.position(&cycle.rows, node);
            for rubbing in law.rubbing(position, span.pairs, &state.balance.loads) {
                sliding += weight * rubbing.load * rubbing.rolling.sliding().abs();
                power += weight * rubbing.power();
                let slides = rubbing.rolling.sliding() != 0.0;
                if law.mean.is_none() && slides && rubbing.load > SMALL * case.force {
                    beyond.see(&friction.law.limits(&rubbing.rolling));
                }
            }
        }
    });
    let base_radii = cycle.base_radii();
    let torque = case.force * base_radii[0];
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

/// Power lost at a position \[W\], and the torque that the gear is left with \[N m\].
pub(in crate::gear::mesh) fn friction_at<'a>(
    case: &LoadCase<'a>,
    friction: Friction<'a>,
    position: f64,
    pairs: usize,
) -> [f64; 2] {
    let power: f64 = rubbing(case, friction, position, pairs).iter().map(FlankFriction::power).sum();
    let base_radii = case.cycle.base_radii();
    [power, (case.force * base_radii[0] - power / friction.speed) * base_radii[1] / base_radii[0]]
}

/// Friction along the path of contact, with so many steps in a base pitch: pairs from A to E, and those before A and after E
/// that carry load.
pub(in crate::gear::mesh) fn friction_along<'a>(
    case: &LoadCase<'a>,
    friction: Friction<'a>,
    steps: usize,
) -> Vec<Place> {
    let cycle = case.cycle;
    let mut places = Vec::new();
    for step in 0..steps {
        let position = cycle.period() * step as f64 / steps as f64;
        let pairs = cycle.pairs_behind(position);
        let rubbing = rubbing(case, friction, position, pairs);
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
