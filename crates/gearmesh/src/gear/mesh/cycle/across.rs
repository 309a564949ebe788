//! Slices of the face that hold each other: what a cycle knows of it, whatever the design.
//!
//! Compliances of a pair are layers in series: the tooth of each gear with the body under it, and the wind-up of both
//! bodies. Each spreads a load along the face by its own length. What neighbouring teeth do to each other goes through
//! the bodies, so it spreads as the wind-up does; since that is the longest length, the matrix of all slices of all pairs
//! is positive definite where the one of whole pairs is. Must not know: designs, loads.

use super::error::MeshError;
use super::path::Path;
use crate::gear::compliance::PairCompliance;
use crate::gear::compliance::across_face::Layers;
use crate::gear::contact::flattening::Bodies;
use crate::gear::geometry::{GearPair, Side};
use crate::numeric::graded::Graded;
use crate::numeric::lobatto::Rule;

/// Points within a slice where there is no closed form.
const POINTS: usize = 3;
/// Path positions from which the longest tooth's length is taken.
const LENGTHS: u32 = 64;

/// Against the path position.
#[derive(Clone, Debug)]
pub(in crate::gear::mesh) struct Across {
    /// Compliances of the teeth, pinion and gear, without wind-up and contact \[m/N\].
    pub(in crate::gear::mesh) teeth: [Graded; 2],
    /// Their lengths over the face width.
    pub(in crate::gear::mesh) lengths: [Graded; 2],
    /// Wind-up of both bodies \[m/N\].
    pub(in crate::gear::mesh) wind_up: f64,
    /// Its length over the face width.
    pub(in crate::gear::mesh) reach: f64,
    /// Penetration per load per width \[1/Pa\] of the linear contact law.
    pub(in crate::gear::mesh) contact: f64,
    pub(in crate::gear::mesh) rule: Rule,
}

impl Across {
    /// # Errors
    /// When the compliances know the pair only as a whole.
    pub(in crate::gear::mesh) fn new(
        pair: &GearPair,
        compliance: &PairCompliance,
        path: &Path,
        face_width: f64,
    ) -> Result<Self, MeshError> {
        if compliance.contact.is_none() {
            return Err(MeshError::StiffnessOfPairs);
        }
        let gears = [(&pair.pinion, &compliance.pinion), (&pair.gear, &compliance.gear)];
        let layers = gears.map(|(gear, tooth)| Layers::new(gear, tooth, face_width));
        let rolls = |side: usize, s: f64| if side == 0 { path.rolls(s).0 } else { path.rolls(s).1 };
        let added = |side: usize, s: f64| gears[side].1.added(path.inclination([Side::Pinion, Side::Gear][side], s));
        let tooth = |side: usize, s: f64| gears[side].1.total(rolls(side, s)) + added(side, s) - layers[side].wind_up;
        let length = |side: usize, s: f64| layers[side].length(rolls(side, s), tooth(side, s)) / face_width;
        let fit = |function: &dyn Fn(f64) -> f64| path.fit(0.0, function).unwrap_or_default();
        let wind_up = layers[0].wind_up + layers[1].wind_up;
        let squares = layers.iter().map(|layers| layers.wind_up * layers.wind_up_length * layers.wind_up_length);
        let mean = if wind_up > 0.0 { (squares.sum::<f64>() / wind_up).sqrt() / face_width } else { 0.0 };
        let (first, last) = path.window();
        let places = (0..=LENGTHS).map(|place| first + (last - first) * f64::from(place) / f64::from(LENGTHS));
        let reach = places.fold(mean, |reach, s| reach.max(length(0, s)).max(length(1, s)));
        Ok(Self {
            teeth: [0, 1].map(|side| fit(&|s| tooth(side, s))),
            lengths: [0, 1].map(|side| fit(&|s| length(side, s))),
            wind_up,
            reach,
            contact: Bodies::of(pair, compliance.plane).linear(),
            rule: Rule::new(POINTS),
        })
    }

    /// The same with all lengths scaled.
    #[cfg(test)]
    pub(in crate::gear::mesh) fn scaled(mut self, factor: f64) -> Self {
        for graded in &mut self.lengths {
            let length = graded.clone();
            *graded = Graded::default();
            graded.push((-1.0, 1.0), [false; 2], 1e-12, |s| factor * length.value(s));
        }
        Self { reach: factor * self.reach, ..self }
    }
}
