//! Slices of the face that hold each other: what a cycle knows of it, and equilibrium at one position.
//!
//! Compliances of a pair are layers in series: the tooth of each gear with the body under it, and the wind-up of both
//! bodies. Each spreads a load along the face by its own length. What neighbouring teeth do to each other goes through
//! the bodies, so it spreads as the wind-up does; since that is the longest length, the matrix of all slices of all pairs
//! is positive definite where the one of whole pairs is. An evenly spread load gives the same as without coupling.
//! On a face that is the same on both sides of its middle, two slices that mirror each other are one.
//! Must not know: how lengths are found.

use super::cycle::{Elasticity, MeshCycle};
use super::path::Path;
use crate::gear::compliance::across_face::Layers;
use crate::gear::compliance::{ContactLaw, PairCompliance};
use crate::gear::contact::face::Face;
use crate::gear::contact::flattening::{self, Logarithmic};
use crate::gear::contact::slices::{Slice, Slices};
use crate::gear::geometry::Pair;
use crate::gear::modification::Design;
use crate::numeric::complementarity::{Balance, MOST, PerSpring, Springs};
use crate::numeric::graded::Graded;
use crate::numeric::layer::add_influences;
use crate::numeric::lobatto::Rule;
use crate::numeric::many_springs;
use declare::error::Failure;

/// Points within a slice where there is no closed form.
const POINTS: usize = 3;
/// Path positions from which the longest tooth's length is taken.
const LENGTHS: u32 = 64;

/// Against the path position.
#[derive(Clone, Debug)]
pub(super) struct Across {
    /// Compliances of the teeth, pinion and gear, without wind-up and contact \[m/N\].
    teeth: [Graded; 2],
    /// Their lengths over the face width.
    lengths: [Graded; 2],
    /// Wind-up of both bodies \[m/N\].
    wind_up: f64,
    /// Its length over the face width.
    reach: f64,
    /// Interference per load per width \[1/Pa\] of the linear contact law.
    contact: f64,
    rule: Rule,
}

impl Across {
    /// # Errors
    /// When the compliances know the pair only as a whole.
    pub(super) fn new(pair: &Pair, compliance: &PairCompliance, path: &Path, face_width: f64) -> Result<Self, Failure> {
        if compliance.contact == ContactLaw::Included {
            return Err(Failure::new(
                "`slice_coupling: plate` needs compliances of single teeth; this stiffness is that of pairs as a whole",
            ));
        }
        let gears = [(&pair.pinion, &compliance.pinion), (&pair.gear, &compliance.gear)];
        let layers = gears.map(|(gear, tooth)| Layers::new(gear, tooth, face_width));
        let rolls = |side: usize, s: f64| if side == 0 { path.rolls(s).0 } else { path.rolls(s).1 };
        let tooth = |side: usize, s: f64| gears[side].1.total(rolls(side, s)) - layers[side].wind_up;
        let length = |side: usize, s: f64| layers[side].length(rolls(side, s), tooth(side, s)) / face_width;
        let fit = |function: &dyn Fn(f64) -> f64| path.fit(0.0, function).unwrap_or_default();
        let wind_up = layers[0].wind_up + layers[1].wind_up;
        let squares = layers.iter().map(|layers| layers.wind_up * layers.wind_up_length * layers.wind_up_length);
        let mean = if wind_up > 0.0 { (squares.sum::<f64>() / wind_up).sqrt() / face_width } else { 0.0 };
        let (first, last) = path.window();
        let places = (0..=LENGTHS).map(|place| first + (last - first) * f64::from(place) / f64::from(LENGTHS));
        let reach = places.fold(mean, |reach, s| reach.max(length(0, s)).max(length(1, s)));
        let materials = [&pair.pinion.specification.material, &pair.gear.specification.material];
        Ok(Self {
            teeth: [0, 1].map(|side| fit(&|s| tooth(side, s))),
            lengths: [0, 1].map(|side| fit(&|s| length(side, s))),
            wind_up,
            reach,
            contact: flattening::linear(materials),
            rule: Rule::new(POINTS),
        })
    }

    /// The same with all lengths scaled.
    #[cfg(test)]
    pub(super) fn scaled(mut self, factor: f64) -> Self {
        for graded in &mut self.lengths {
            let length = graded.clone();
            *graded = Graded::default();
            graded.push((-1.0, 1.0), [false; 2], 1e-12, |s| factor * length.value(s));
        }
        Self { reach: factor * self.reach, ..self }
    }
}

/// The slices of a design.
#[derive(Clone)]
pub(super) struct Sliced<'a> {
    across: &'a Across,
    faces: Vec<Face<'a>>,
    /// The smallest deviation of each slice, above that of the whole face.
    lows: Vec<f64>,
    /// How many slices of the face each stands for: itself, or itself and its mirror image.
    stands_for: Vec<f64>,
    /// The width of that \[m\].
    widths: Vec<f64>,
    /// Slices of the whole face.
    whole: usize,
    /// Influences of the wind-up.
    body: Vec<f64>,
}

impl<'a> Sliced<'a> {
    /// None where slices are independent, or where one slice is enough.
    pub(super) fn new(cycle: &'a MeshCycle, design: &Design, whole: &Face) -> Option<Self> {
        let across = cycle.across.as_ref().filter(|_| !whole.is_flat())?;
        let count = cycle.settings.slices.max(1);
        let kept = if design.lead_is_even() { count.div_ceil(2) } else { count };
        let stands_for = |slice: usize| if kept == count || slice == count - 1 - slice { 1.0 } else { 2.0 };
        let place = |index: usize| cycle.face_width * (index as f64 / count as f64 - 0.5);
        let strip = |slice: usize| Face::between(design, [place(slice), place(slice + 1)], &across.rule);
        let faces: Vec<Face> = (0..kept).map(strip).collect();
        let lows = faces.iter().map(|face| (face.offset - whole.offset).max(0.0)).collect();
        let stands_for: Vec<f64> = (0..kept).map(stands_for).collect();
        let widths = stands_for.iter().map(|stands_for| stands_for * cycle.face_width / count as f64).collect();
        let mut body = vec![0.0; count * count];
        add_influences(across.reach, 1.0, count, count, &mut body);
        Some(Self { across, faces, lows, stands_for, widths, whole: count, body })
    }

    /// How many slices are computed.
    pub(super) fn count(&self) -> usize {
        self.faces.len()
    }

    /// Equilibrium of the pairs `springs` at `positions` behind `gaps`, and the largest load per width of each, as a mean
    /// over a slice. `above`: an approach that is large enough.
    pub(super) fn balance(
        &self,
        cycle: &MeshCycle,
        springs: &[usize],
        positions: &[f64],
        gaps: &[f64],
        [force, above]: [f64; 2],
    ) -> (Balance, PerSpring) {
        let count = self.faces.len();
        let (found, smallest) = self.slices(cycle, springs, positions, gaps, [force, above]);
        let (approach, slope) = (found.approach + smallest, found.slope);
        let mut balance = Balance { approach, loads: [0.0; MOST], interference: [0.0; MOST], slope };
        let mut peaks = [0.0; MOST];
        let pairs = found.loads.chunks(count).zip(found.interference.chunks(count));
        for (pair, (loads, interference)) in pairs.enumerate() {
            let largest = |values: &[f64]| values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            balance.loads[pair] = loads.iter().sum();
            balance.interference[pair] = largest(interference);
            let per_width = loads.iter().zip(&self.widths).map(|(load, width)| load / width);
            peaks[pair] = per_width.fold(f64::NEG_INFINITY, f64::max);
        }
        (balance, peaks)
    }

    /// Equilibrium of all slices, pair by pair, its approach counted from the smallest gap of a slice, and that gap.
    fn slices(
        &self,
        cycle: &MeshCycle,
        springs: &[usize],
        positions: &[f64],
        gaps: &[f64],
        [force, above]: [f64; 2],
    ) -> (many_springs::Balance, f64) {
        let (matrix, own) = self.matrix(cycle, springs, positions);
        // The lowest place of the face is one of a slice but for rounding.
        let behind = || gaps.iter().flat_map(|gap| self.lows.iter().map(move |low| gap + low));
        let smallest = behind().fold(f64::INFINITY, f64::min);
        let behind: Vec<f64> = behind().map(|gap| gap - smallest).collect();
        let slices = self.springs(cycle, positions, &own);
        (many_springs::balance(&slices, &behind, &matrix, force, above), smallest)
    }

    /// The load, over the force, that a slice carries and that its interference, recomputed from loads, gaps and influences,
    /// does not explain; and how much of it rounding may leave. Both are of the slice that uses up most of that allowance.
    pub(super) fn unexplained(
        &self,
        cycle: &MeshCycle,
        springs: &[usize],
        positions: &[f64],
        gaps: &[f64],
        [force, above]: [f64; 2],
    ) -> [f64; 2] {
        let (count, size) = (self.faces.len(), gaps.len() * self.faces.len());
        let (found, smallest) = self.slices(cycle, springs, positions, gaps, [force, above]);
        let (matrix, own) = self.matrix(cycle, springs, positions);
        let slices = self.springs(cycle, positions, &own);
        let mut worst = [0.0, 1.0];
        for (slice, &load) in found.loads.iter().enumerate() {
            let row = &matrix[slice * size..][..size];
            let others: f64 = row.iter().zip(&found.loads).map(|(influence, load)| influence * load).sum();
            let gap = gaps[slice / count] + self.lows[slice % count] - smallest;
            let interference = found.approach - gap - others;
            let (carried, rise) =
                if interference > 0.0 { slices.response(slice, interference) } else { (0.0, 1.0 / own[slice]) };
            let value = (carried - load).abs() / force;
            let scale = 1.0 + rise * (found.approach + gap + others.abs()) / force;
            if value * worst[1] >= worst[0] * scale {
                worst = [value, scale];
            }
        }
        worst
    }

    /// What each slice carries on its own.
    fn springs(&self, cycle: &MeshCycle, positions: &[f64], own: &[f64]) -> Slices<'_> {
        let mut slices = Vec::with_capacity(own.len());
        for (&s, own) in positions.iter().zip(own.chunks(self.count())) {
            let own = own.iter().zip(&self.widths);
            match &cycle.elasticity {
                Elasticity::Linear(_) => {
                    slices.extend(own.map(|(own, width)| Slice::Linear(1.0 / (own + self.across.contact / width))));
                }
                Elasticity::Logarithmic { constant, rate, .. } => {
                    let law = Logarithmic { constant: constant.value(s), rate: *rate };
                    slices.extend(own.map(|(own, width)| Slice::Logarithmic(law.in_series(own * width))));
                }
            }
        }
        Slices { slices, faces: &self.faces, widths: &self.widths }
    }

    /// Interference of each slice, pair by pair, per load on each \[m/N\], without contact, by rows. And the interference of
    /// each slice by its own load, which is not in the former.
    fn matrix(&self, cycle: &MeshCycle, springs: &[usize], positions: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let (across, count) = (self.across, self.faces.len());
        let size = positions.len() * count;
        let (mut matrix, mut own) = (vec![0.0; size * size], Vec::with_capacity(size));
        let mut block = vec![0.0; self.body.len()];
        for (pair, &s) in positions.iter().enumerate() {
            block.fill(0.0);
            for (compliance, length) in across.teeth.iter().zip(&across.lengths) {
                add_influences(length.value(s), compliance.value(s), self.whole, self.whole, &mut block);
            }
            for (entry, influence) in block.iter_mut().zip(&self.body) {
                *entry += across.wind_up * influence;
            }
            for (slice, stands_for) in self.stands_for.iter().enumerate() {
                let at = slice * (self.whole + 1);
                own.push(block[at] / stands_for);
                block[at] = 0.0;
            }
            self.put(&block, 1.0, &mut matrix, [pair, pair], size);
            for ahead in pair + 1..positions.len() {
                let influence = cycle.coupling(s, springs[ahead] - springs[pair]);
                for place in [[pair, ahead], [ahead, pair]] {
                    self.put(&self.body, influence, &mut matrix, place, size);
                }
            }
        }
        (matrix, own)
    }

    /// Puts influences between all slices of two pairs, given by their places, into the matrix of those that are computed:
    /// what a load that is shared with the mirror image does to each of the two.
    fn put(&self, block: &[f64], scale: f64, matrix: &mut [f64], [by, on]: [usize; 2], size: usize) {
        let count = self.faces.len();
        for (slice, influences) in block.chunks(self.whole).take(count).enumerate() {
            let start = (by * count + slice) * size + on * count;
            let mirrored = influences.iter().rev();
            let entries = matrix[start..start + count].iter_mut().zip(&self.stands_for);
            for ((entry, stands_for), (near, far)) in entries.zip(influences.iter().zip(mirrored)) {
                *entry = scale * if *stands_for > 1.0 { 0.5 * (near + far) } else { *near };
            }
        }
    }
}

#[cfg(test)]
mod tests;
