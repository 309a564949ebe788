//! Transmission error over a hunting period: until the same teeth meet again, lcm(z1, z2) base pitches of mesh.
//!
//! Pitch deviations set each pair of teeth apart by its own amount, the same from A to E: a pair of pinion tooth i and gear tooth
//! j stands (F_p,i − F_p,j) cos α farther from contact. A pair of which a tooth has a flank of its own has a gap of its own, found as
//! that of a design is: bent contact and corners included. Teeth yield and are placed as those of the design. Source: ISO
//! 1328-1:2013, 3.2 (pitch deviations) and Annex C (transmission deviation, single flank). Must not know: where deviations come
//! from, what is done with the values.

mod flanks;

use std::ops::Range;
use std::sync::Arc;

use crate::gear::geometry::{GearPair, Side};
use crate::gear::mesh::equilibrium::flanks::Flanks;
use crate::gear::mesh::equilibrium::individual_pairs::IndividualPairs;
use crate::gear::mesh::equilibrium::load_case::LoadCase;
use crate::gear::modification::Design;
use crate::numeric::complementarity::MOST_SPRINGS;

pub use flanks::ToothFlanks;

/// What single teeth of both gears have of their own.
#[derive(Clone, Debug)]
pub struct Teeth {
    /// Their places.
    pub pitch: PitchDeviations,
    /// Their flanks.
    pub flanks: ToothFlanks,
}

/// By how much the teeth of both gears are off their places, as far as the mate feels it.
#[derive(Clone, Debug, PartialEq)]
pub struct PitchDeviations {
    /// By how much a tooth's working flank is farther from the mate's, along the line of action \[m\]; teeth in the order in
    /// which they come into mesh. One 0 where nothing is off.
    apart: [Vec<f64>; 2],
}

/// Why deviations are not those of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the {} has {teeth} teeth, but {stated} pitch deviations are stated", side.name())]
pub struct NotOfEachTooth {
    /// Of which gear.
    pub side: Side,
    /// z.
    pub teeth: u32,
    /// How many there are.
    pub stated: usize,
}

/// Why a tooth is not one of a gear.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the {} has {teeth} teeth, and no tooth {tooth}", side.name())]
pub struct NoSuchTooth {
    /// Of which gear.
    pub side: Side,
    /// z.
    pub teeth: u32,
    /// Which one, from 1.
    pub tooth: usize,
}

impl Teeth {
    /// Between what the distances of all pairs of teeth are beside those of the design's flanks \[m\].
    fn between(&self) -> [f64; 2] {
        let of = |end: usize, pick: fn(f64, f64) -> f64, start: f64| {
            let of_gear = |side: usize| {
                let apart = &self.pitch.apart[side];
                let teeth = 0..apart.len().max(self.flanks.teeth(side));
                let of_tooth = |tooth: usize| apart[tooth % apart.len()] + self.flanks.range(side, tooth)[end];
                teeth.map(of_tooth).fold(start, pick)
            };
            of_gear(0) + of_gear(1)
        };
        let [least, most] = [of(0, f64::min, f64::INFINITY), of(1, f64::max, f64::NEG_INFINITY)];
        // Where pairs touch at the highest place of the face only, the approach is as much larger as the others are lower.
        let uneven = if self.flanks.vary_across() { 2.0 * (most - least) } else { 0.0 };
        [least, most + uneven]
    }
}

impl PitchDeviations {
    /// Of cumulative pitch deviations F_p \[m\] on the reference circle, pinion and gear: by how much the working flank of each
    /// tooth is farther from the first one's than its nominal place, in the direction of counting, which is the order in which
    /// teeth come into mesh. An empty slice is a gear without deviations.
    ///
    /// # Errors
    /// When there are neither none nor as many as teeth.
    pub fn new(pair: &GearPair, cumulative: [&[f64]; 2]) -> Result<Self, NotOfEachTooth> {
        let cosine = libm::cos(pair.pinion.specification.pressure_angle);
        let of = |side: Side, sign: f64| {
            let (stated, teeth) = (cumulative[side as usize], pair.side(side).specification.teeth);
            if stated.is_empty() {
                return Ok(vec![0.0]);
            }
            if stated.len() != teeth as usize {
                return Err(NotOfEachTooth { side, teeth, stated: stated.len() });
            }
            Ok(stated.iter().map(|deviation| sign * cosine * deviation).collect())
        };
        // A later tooth is behind: the pinion's is late to come, the gear's is met early.
        Ok(Self { apart: [of(Side::Pinion, 1.0)?, of(Side::Gear, -1.0)?] })
    }

    /// How much farther apart a pair of teeth is than one without deviations \[m\]; pairs count in the order in which they come
    /// into mesh, and before the first one.
    #[must_use]
    pub fn of_pair(&self, pair: isize) -> f64 {
        let tooth = |apart: &[f64]| apart[pair.rem_euclid(apart.len().cast_signed()).cast_unsigned()];
        tooth(&self.apart[0]) + tooth(&self.apart[1])
    }
}

/// lcm(z1, z2): after how many base pitches of mesh the same teeth meet again.
#[must_use]
pub fn hunting_period(teeth: [u32; 2]) -> usize {
    let (mut larger, mut smaller) = (teeth[0], teeth[1]);
    while smaller != 0 {
        (larger, smaller) = (smaller, larger % smaller);
    }
    (teeth[0] as usize).saturating_mul((teeth[1] / larger.max(1)) as usize)
}

/// The same load case with teeth that differ, of which [`over_pitches`] takes the pairs in contact. Without friction.
pub(in crate::gear::mesh) fn with_teeth<'a>(case: LoadCase<'a>, teeth: &Teeth) -> LoadCase<'a> {
    let is_surface = case.flanks.is_surface || teeth.flanks.vary_across();
    let is_even = case.flanks.is_even && teeth.flanks.are_even();
    let is_same = is_surface == case.flanks.is_surface && is_even == case.flanks.is_even;
    // All pairs have faces of one kind.
    let loading = if is_same {
        case
    } else {
        let flanks = Flanks::of(case.cycle, case.design, is_surface, is_even);
        LoadCase::of_flanks(flanks, case.design, case.force)
    };
    loading.with_distances_between(teeth.between())
}

/// The transmission error \[m\] at `positions` equidistant positions of each of these base pitches of mesh, of a load case that was
/// made with the same teeth: pitch n goes from where pair number n starts contact in A to where the next one does, the last
/// position one short of that. A pair's own gaps are kept for as long as it may touch.
pub(in crate::gear::mesh) fn over_pitches(
    case: &LoadCase,
    teeth: &Teeth,
    pitches: Range<isize>,
    positions: usize,
) -> Vec<f64> {
    let newest = case.cycle.newest().cast_signed();
    let zones = case.cycle.zones.iter();
    let springs = zones.map(|zone| case.cycle.springs(zone.pairs)).max().unwrap_or(0);
    let number = |pitch: isize, spring: usize| pitch + newest - spring.cast_signed();
    let oldest = number(pitches.start, springs.saturating_sub(1));
    let numbers = oldest..number(pitches.end, 0);
    let designs: Vec<Option<Design>> = numbers.map(|pair| teeth.flanks.design(case.design, pair)).collect();
    let flanks_of = |pair: isize| {
        let design = designs.get((pair - oldest).cast_unsigned())?.as_ref()?;
        let Flanks { cycle, is_surface, is_even, .. } = *case.flanks;
        Some(Arc::new(Flanks::of(cycle, design, is_surface, is_even)))
    };
    let step = case.cycle.period() / positions as f64;
    let mut flanks: [Option<Arc<Flanks>>; MOST_SPRINGS] = Default::default();
    let mut found = Vec::with_capacity(pitches.len().saturating_mul(positions));
    for pitch in pitches.clone() {
        // All but the newest pair were there a pitch ago.
        flanks.rotate_right(1);
        let fresh = if pitch == pitches.start { springs } else { 1 };
        for (spring, flanks) in flanks.iter_mut().enumerate().take(fresh) {
            *flanks = flanks_of(number(pitch, spring));
        }
        let distances = std::array::from_fn(|spring| teeth.pitch.of_pair(number(pitch, spring)));
        let apart = Some(IndividualPairs { distances, flanks: flanks.clone() });
        let here = LoadCase { apart, ..case.clone() };
        found.extend((0..positions).map(|index| {
            let position = step * index as f64;
            here.state(position, case.cycle.pairs_behind(position)).transmission_error()
        }));
    }
    found
}

#[cfg(test)]
mod tests;
