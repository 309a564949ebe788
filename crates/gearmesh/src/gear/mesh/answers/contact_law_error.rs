//! How far off the transmission error may be where the law of contact is out of its depth: contacts that are wide, flanks that
//! are no parabolas beside the contact, two touches of one pair, flanks that end at their base circle.
//!
//! Pair by pair the approach that its law may miss, by `patch` and `uneven`; of all pairs at a position by their share of the
//! load, which is what the work of the load changes by. At some positions: it is an estimate. Must not know: who is told.

use super::pressure::line_load;
use crate::gear::contact::flattening::combined_radius;
use crate::gear::contact::gap::Gaps;
use crate::gear::contact::patch::{Patch, Surface};
use crate::gear::contact::tip::{Corner, Tips};
use crate::gear::contact::uneven::Uneven;
use crate::gear::contact::wedge;
use crate::gear::geometry::Side;
use crate::gear::geometry::flank_end::FlankEnd;
use crate::gear::geometry::outline::tip::Tip;
use crate::gear::mesh::cycle::mesh::{Elasticity, Mesh};
use crate::gear::mesh::equilibrium::load_case::LoadCase;

/// How many positions of a stretch with as many pairs are looked at, its ends among them.
const POSITIONS: usize = 5;
/// Beyond what a load closes nothing touches: (ξ² − ln 2ξ − ½) k₀ p.
const FAR: f64 = 2.5;
/// The farthest that is looked at, in half widths.
const FARTHEST: f64 = 40.0;
/// An involute's curvature matters from here on: b over the length of the flank down to the base circle.
const CURVED: f64 = 0.25;
/// Relative to the approach: what resolved contact promises, and what Weber's law leaves out in any case.
const RESOLVED: f64 = 1e-3;
const WEBER: f64 = 1e-2;
/// What the shape of flanks may do before it is told: every relief bends them.
const SHAPE: f64 = 1e-2;

/// By how much a doubt may exceed what first order makes of flanks that are no parabolas.
const BEYOND_FIRST_ORDER: f64 = 1.25;

/// How closely it is looked at what flanks that are no parabolas do.
#[derive(Clone, Copy, PartialEq)]
enum Look {
    /// To first order, without pressing them together.
    Quick,
    Close,
}

/// What most of a doubt comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cause {
    /// The contact is wide.
    Width,
    /// The flanks beside the contact do not stand apart as a parabola does.
    Shape,
    /// A pair touches at two places, so far apart \[m\].
    TwoTouches(f64),
    /// The contact is wider than this gear's flank is long down to its base circle.
    BaseCircle(Side),
}

/// What the law of contact may be off by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLawError {
    /// Of the transmission error, the largest of the positions that were looked at \[m\].
    pub size: f64,
    /// Where that is: cycle position \[m\].
    pub position: f64,
    /// The part of it that the shape of the flanks has.
    pub by_shape: f64,
    /// How far the gears approach there beyond their smallest gap \[m\].
    pub approach: f64,
    /// Half the width of the widest contact at any of them, and the one up to which surfaces are half planes to the law
    /// \[m\], infinite where it knows none.
    pub widest: [f64; 2],
    /// Of the pair that adds most.
    pub cause: Cause,
    /// The error that is promised otherwise, relative to the approach.
    pub promised: f64,
}

impl ContactLawError {
    /// The larger of two, with the wider contact.
    fn worse(self, other: Self) -> Self {
        let widest = if other.widest[0] > self.widest[0] { other.widest } else { self.widest };
        Self { widest, ..if other.size > self.size { other } else { self } }
    }

    /// If it is what first order makes of it: the most that it may be.
    fn at_most(self) -> Self {
        let more = (BEYOND_FIRST_ORDER - 1.0) * self.by_shape;
        Self { size: self.size + more, by_shape: self.by_shape + more, ..self }
    }

    /// Whether it exceeds what is promised.
    #[must_use]
    pub fn matters(&self) -> bool {
        let [half, limit] = self.widest;
        let shape = f64::max(SHAPE, self.promised);
        half > limit
            || self.size - self.by_shape > self.promised * self.approach
            || self.by_shape > shape * self.approach
    }
}

/// Of one pair \[m\].
#[derive(Clone, Copy)]
struct Missed {
    by_width: f64,
    by_shape: f64,
    cause: Cause,
    half_width: f64,
}

/// What the law of contact may be off by over the cycle; none without load, or where contact is linear and knows no width.
#[must_use]
pub(in crate::gear::mesh) fn contact_law_error(case: &LoadCase) -> Option<ContactLawError> {
    let Elasticity::Logarithmic { .. } = &case.cycle.elasticity else { return None };
    let places = case.cycle.zones.iter().flat_map(|zone| {
        let place = |index: usize| zone.start + (zone.end - zone.start) * index as f64 / (POSITIONS - 1) as f64;
        (0..POSITIONS).map(move |index| (place(index), zone.pairs))
    });
    let gaps = case.flanks.gaps();
    let quick = |place: (f64, usize)| error_at(case, place, &gaps, Look::Quick).map(|doubt| (place, doubt));
    let mut found: Vec<((f64, usize), ContactLawError)> = places.filter_map(quick).collect();
    let all = found.iter().map(|(_, doubt)| *doubt).reduce(ContactLawError::worse)?;
    if !all.at_most().matters() {
        return Some(all);
    }
    // To press flanks together takes some ten times as long as a curve: where most is expected first, and no longer than
    // there may be more.
    found.sort_by(|one, other| other.1.at_most().size.total_cmp(&one.1.at_most().size));
    let mut worst: Option<ContactLawError> = None;
    for (place, quick) in found {
        if worst.is_some_and(|worst| worst.size >= quick.at_most().size) {
            break;
        }
        let here = error_at(case, place, &gaps, Look::Close)?;
        worst = Some(worst.map_or(here, |worst| worst.worse(here)));
    }
    worst.map(|worst| ContactLawError { widest: all.widest, ..worst })
}

/// The same at one position of the cycle with `pairs` inside the path of contact.
#[must_use]
pub(in crate::gear::mesh) fn contact_law_error_at(
    case: &LoadCase,
    position: f64,
    pairs: usize,
) -> Option<ContactLawError> {
    error_at(case, (position, pairs), &case.flanks.gaps(), Look::Close)
}

fn error_at(case: &LoadCase, (position, pairs): (f64, usize), gaps: &Gaps, look: Look) -> Option<ContactLawError> {
    if case.force <= 0.0 || !case.force.is_finite() {
        return None;
    }
    let state = case.state(position, pairs);
    let loads = state.balance.loads;
    let load: f64 = loads.iter().sum();
    let missed: Vec<(f64, Missed)> = (0..case.cycle.springs(pairs))
        .filter(|spring| loads[*spring] > 0.0)
        .map(|spring| {
            let line_load = line_load(case, position, &state, spring);
            (loads[spring] / load, missed(case, case.cycle.path_position(position, spring), line_load, gaps, look))
        })
        .collect();
    let sum = |part: fn(&Missed) -> f64| missed.iter().map(|(share, missed)| share * part(missed)).sum::<f64>();
    let (by_width, by_shape) = (sum(|missed| missed.by_width), sum(|missed| missed.by_shape));
    let larger = |(share, missed): &(f64, Missed)| share * (missed.by_width + missed.by_shape);
    let (_, most) = missed.iter().max_by(|one, two| larger(one).total_cmp(&larger(two)))?;
    let resolved = case.cycle.elasticity.is_resolved();
    let limit = case.cycle.tips(case.cycle.pair.start_of_contact).map_or(f64::INFINITY, |tips| tips.widest);
    Some(ContactLawError {
        size: by_width + by_shape,
        position,
        by_shape,
        approach: state.balance.approach,
        widest: [missed.iter().map(|(_, missed)| missed.half_width).fold(0.0, f64::max), limit],
        cause: most.cause,
        promised: if resolved { RESOLVED } else { WEBER },
    })
}

/// Of the pair at a path position under a load per width.
fn missed(case: &LoadCase, s: f64, line_load: f64, gaps: &Gaps, look: Look) -> Missed {
    let cycle = case.cycle;
    let (bodies, radii) = (&cycle.bodies, cycle.radii(s));
    let touching = case.cycle.reached(s, line_load);
    let radius = combined_radius(touching);
    let half_width = bodies.half_width(radius) * line_load.sqrt();
    let rate = bodies.linear();
    let sides = [Side::Pinion, Side::Gear];
    let surfaces = sides.map(|side| {
        let (gear, material) = (cycle.pair.side(side), &bodies.materials[side as usize]);
        Surface {
            compliance: material.plane_compliance(bodies.plane),
            poisson_ratio: material.plane_poisson_ratio(bodies.plane),
            radius: touching[side as usize],
            depth: gear.flank(radii[side as usize] / gear.base_radius).half_thickness,
        }
    });
    let inside = s >= cycle.pair.start_of_contact && s <= cycle.pair.end_of_contact;
    let slope = if inside { cycle.slope(s, radii, half_width) } else { 0.0 };
    let patch = Patch { line_load, half_width, rate, slope, surfaces };
    let by_width = patch.left_out() + cycle.beyond_law(s, line_load) + cycle.beyond_chamfers(s, half_width, line_load);
    let wide = Missed { by_width, by_shape: 0.0, cause: Cause::Width, half_width };
    if !inside {
        return wide;
    }
    // Down to the base circles.
    let lengths = sides.map(|side| 0.5 * radii[side as usize].powi(2) / cycle.pair.side(side).base_radius);
    let is_curved = lengths.iter().any(|length| half_width > CURVED * length);
    if !is_curved && case.flanks.is_unmodified() {
        return wide;
    }
    let closed = 0.5 * half_width * half_width / radius;
    let least = case.gap(s).unwrap_or(0.0);
    let reach = (FAR * FAR + least / closed).sqrt().min(FARTHEST);
    let gap = |place: f64| gaps.beside(s, place * half_width).map(|gap| (gap - least) / closed);
    let uneven = if look == Look::Quick { Uneven::quick(gap, reach) } else { Uneven::of(gap, reach) };
    let by_shape = uneven.change * closed;
    let ended = sides.into_iter().find(|side| half_width > lengths[*side as usize]);
    let cause = match ended {
        Some(side) if by_shape > by_width => Cause::BaseCircle(side),
        _ if uneven.apart > 0.0 && by_shape > by_width => Cause::TwoTouches(uneven.apart * half_width),
        _ if by_shape > by_width => Cause::Shape,
        _ => Cause::Width,
    };
    Missed { by_width, by_shape, cause, half_width }
}

impl Mesh {
    /// S′ at a path position: by how much more both teeth yield per load per width along the flank, towards the pinion's tip.
    /// Corners that a contact reaches are with the law of wedges.
    fn slope(&self, s: f64, radii: [f64; 2], half_width: f64) -> f64 {
        let Some(tips) = self.tips(s) else { return 0.0 };
        let (pinion, gear) = self.path.rolls(s);
        let [of_pinion, of_gear] = [(0, pinion), (1, gear)].map(|(side, roll)| {
            let rate = self.rates[side].as_ref().map_or(0.0, |rate| rate.value(roll));
            let corner = &tips.corners[side];
            let by_corner = if corner.distance > half_width { corner.rate / corner.distance } else { 0.0 };
            self.face_width * rate / radii[side] + by_corner
        });
        of_pinion - of_gear
    }

    /// The radii of curvature of what the contact reaches: those of roundings, where a part of it lies on one.
    fn reached(&self, s: f64, load: f64) -> [f64; 2] {
        let mut radii = self.touching(s).0;
        let half_width = self.bodies.half_width(combined_radius(self.path.radii(s))) * load.sqrt();
        for (side, corner) in
            [Side::Pinion, Side::Gear].into_iter().zip(self.tips(s).iter().flat_map(|tips| tips.corners))
        {
            let round = self.pair.side(side).flank_end.radius;
            if round > 0.0 && corner.distance < half_width {
                radii[side as usize] = round;
            }
        }
        radii
    }

    /// By how much the approach may differ where a contact reaches the corner of a chamfer and is wider than that is long: what
    /// yields is a tooth whose corner is not as blunt \[m\].
    fn beyond_chamfers(&self, s: f64, half_width: f64, load: f64) -> f64 {
        let Some(tips) = self.tips(s) else { return 0.0 };
        let of = |(side, corner): (Side, &Corner)| {
            let gear = self.pair.side(side);
            let size = if matches!(gear.tip, Tip::Rounding(_)) { 0.0 } else { gear.tip.size(gear) };
            if size <= 0.0 || corner.distance >= half_width {
                return 0.0;
            }
            let material = &self.bodies.materials[side as usize];
            let sharp = FlankEnd::corner(gear.tip_roll()).interior_angle;
            let rate = material.plane_compliance(self.bodies.plane) * wedge::softening(sharp);
            load * rate * libm::log(2.0 * half_width / size).max(0.0)
        };
        [Side::Pinion, Side::Gear].into_iter().zip(&tips.corners).map(of).sum()
    }

    /// By how much the approach differs where the law is not followed, since a contact is wider than it has a meaning \[m\].
    fn beyond_law(&self, s: f64, load: f64) -> f64 {
        let Elasticity::Logarithmic { compliance, .. } = &self.elasticity else { return 0.0 };
        let series = self.elasticity.series(s, None);
        let (law, teeth) = (series.law, compliance.value(s));
        let free = match self.tips(s) {
            Some(tips) => law.in_series(teeth).at_tips(Tips { widest: f64::INFINITY, ..tips }).penetration(load),
            None => load * (teeth + law.constant - law.rate * libm::log(load)),
        };
        (free - series.penetration(load)).abs()
    }
}
