//! Transmission error over a hunting period: until the same teeth meet again, lcm(z1, z2) base pitches of mesh.
//!
//! Pitch deviations set each pair of teeth apart by its own amount, the same from A to E: a pair of pinion tooth i and gear tooth
//! j stands (F_p,i − F_p,j) cos α farther from contact. Flanks themselves are alike. Source: ISO 1328-1:2013, 3.2 (pitch deviations)
//! and Annex C (transmission deviation, single flank). Must not know: where deviations come from, what is done with the values.

use super::load_case::LoadCase;
use crate::gear::geometry::{GearPair, Side};
use crate::numeric::complementarity::PerSpring;

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

    /// Between what the distances of all pairs of teeth are \[m\].
    fn range(&self) -> [f64; 2] {
        let of = |pick: fn(f64, f64) -> f64, start: f64| {
            self.apart.iter().map(|apart| apart.iter().copied().fold(start, pick)).sum()
        };
        [of(f64::min, f64::INFINITY), of(f64::max, f64::NEG_INFINITY)]
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

impl LoadCase<'_> {
    /// The same with pitch deviations, of which [`LoadCase::over_pitch`] takes those of the pairs in contact.
    #[must_use]
    pub fn with_pitch_deviations(self, deviations: &PitchDeviations) -> Self {
        self.with_distances_between(deviations.range())
    }

    /// The same for pairs that are farther apart than their flanks say, by amounts between these \[m\].
    fn with_distances_between(self, distances_between: [f64; 2]) -> Self {
        let mut other = Self { distances_between, ..self };
        if !other.touches_on_line() {
            other.touching = other.corners();
            other.follow();
        }
        other
    }

    /// The same with pairs so much farther apart, by their springs.
    fn with_distances(&self, distances: PerSpring) -> Self {
        Self { distances: Some(distances), ..self.clone() }
    }

    /// The transmission error \[m\] at `positions` equidistant positions of a base pitch of mesh, of a load case that was made
    /// with the same deviations: from where pair number `pitch` starts contact in A on, the last position one short of where
    /// the next does.
    #[must_use]
    pub fn over_pitch(&self, deviations: &PitchDeviations, pitch: isize, positions: usize) -> Vec<f64> {
        let newest = self.cycle.newest().cast_signed();
        let apart: PerSpring = std::array::from_fn(|spring| deviations.of_pair(pitch + newest - spring.cast_signed()));
        let here = self.with_distances(apart);
        let step = self.cycle.period() / positions as f64;
        let at = |index: usize| {
            let position = step * index as f64;
            here.state(position, self.cycle.pairs_behind(position)).transmission_error()
        };
        (0..positions).map(at).collect()
    }
}

#[cfg(test)]
mod tests;
