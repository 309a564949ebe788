//! Slices of the face that hold each other: equilibrium at one position.
//!
//! A load that is spread evenly gives what it gives without coupling. On a face that is the same on either side of its
//! middle, two slices that mirror each other are one. Must not know: how lengths are found.

use std::borrow::Cow;
use std::sync::Arc;

use super::candidate_pairs::CandidatePairs;
use super::flanks::{Flanks, strips};
use crate::gear::contact::face::Face;
use crate::gear::contact::slices::{Slice, Slices};
use crate::gear::mesh::cycle::across::Across;
use crate::gear::mesh::cycle::mesh::{Elasticity, Mesh};
use crate::gear::modification::Design;
use crate::numeric::complementarity::{Balance, MOST_SPRINGS, PerSpring, Springs};
use crate::numeric::layer::add_influences;
use crate::numeric::many_springs;

/// The flanks of a pair by its spring.
type FlanksOf<'f, 'a> = &'f dyn Fn(usize) -> &'f Flanks<'a>;

/// The slices of a design.
pub(in crate::gear::mesh) struct CoupledSlices<'a> {
    flanks: Arc<Flanks<'a>>,
    across: &'a Across,
    /// The deviations within each slice; none of a surface, where each position has its own.
    strips: Deviations<'a>,
    /// How many slices of the face each stands for: itself, or itself and its mirror image.
    stands_for: Vec<f64>,
    /// The width of that \[m\].
    widths: Vec<f64>,
    /// Slices of the whole face.
    whole: usize,
    /// Influences of the wind-up.
    body: Vec<f64>,
}

/// Slice by slice, of one pair that stands for all or of one after the other.
#[derive(Clone, Default)]
struct Deviations<'a> {
    faces: Vec<Face<'a>>,
    /// The smallest deviation of each slice, above that of the whole face.
    lows: Vec<f64>,
}

impl Deviations<'_> {
    /// How far each slice of the pairs stands back, whose gaps are these.
    fn behind(&self, gaps: &[f64], count: usize) -> Vec<f64> {
        let place = |index: usize| gaps[index / count] + self.lows[index % self.lows.len()];
        (0..gaps.len() * count).map(place).collect()
    }
}

impl<'a> CoupledSlices<'a> {
    /// None where slices are independent, or one does for all.
    pub(in crate::gear::mesh) fn new(flanks: &Arc<Flanks<'a>>, design: &Design) -> Option<Self> {
        let cycle = flanks.cycle;
        let across = cycle.across.as_ref().filter(|_| !flanks.is_flat())?;
        let count = cycle.settings.slices.max(1);
        let places = strips(cycle, flanks.is_even);
        let kept = places.len();
        let stands_for = |slice: usize| if kept == count || slice == count - 1 - slice { 1.0 } else { 2.0 };
        let strips = if flanks.is_surface {
            Deviations::default()
        } else {
            let strip = |ends: [f64; 2]| Face::between(design, ends, &across.rule);
            let faces: Vec<Face> = places.into_iter().map(strip).collect();
            // The lowest place of the face is one of a slice but for rounding, unless it was looked for in other places.
            let lowest = if flanks.face.is_sliced() { f64::NEG_INFINITY } else { 0.0 };
            let lows = faces.iter().map(|face| (face.offset - flanks.face.offset).max(lowest)).collect();
            Deviations { faces, lows }
        };
        let stands_for: Vec<f64> = (0..kept).map(stands_for).collect();
        let widths = stands_for.iter().map(|stands_for| stands_for * cycle.face_width / count as f64).collect();
        let mut body = vec![0.0; count * count];
        add_influences(across.reach, 1.0, count, count, &mut body);
        Some(Self { flanks: Arc::clone(flanks), across, strips, stands_for, widths, whole: count, body })
    }

    /// How many slices are looked at.
    pub(in crate::gear::mesh) fn count(&self) -> usize {
        self.stands_for.len()
    }

    /// The deviations within the slices of the pairs within reach.
    fn deviations(&self, flanks_of: FlanksOf<'_, 'a>, reach: &CandidatePairs) -> Cow<'_, Deviations<'a>> {
        if !self.flanks.is_surface {
            return Cow::Borrowed(&self.strips);
        }
        let mut found = Deviations::default();
        for (&spring, &s) in reach.springs().iter().zip(reach.positions()) {
            let flanks = flanks_of(spring);
            let gap = flanks.gap(s).unwrap_or(0.0);
            let faces = flanks.strips_at(s, self.count());
            let from = found.faces.len();
            found.faces.extend(faces);
            found.lows.extend(found.faces[from..].iter().map(|face| face.offset - gap));
        }
        Cow::Owned(found)
    }

    /// Equilibrium of the pairs within reach and the largest load per width of each, as a mean
    /// over a slice. `above`: an approach that is large enough.
    pub(in crate::gear::mesh) fn balance(
        &self,
        flanks_of: FlanksOf<'_, 'a>,
        reach: &CandidatePairs,
        [force, above]: [f64; 2],
    ) -> (Balance, PerSpring) {
        let count = self.count();
        let (found, smallest) = self.slices(flanks_of, reach, [force, above]);
        let (approach, slope) = (found.approach + smallest, found.slope);
        let mut balance = Balance { approach, loads: [0.0; MOST_SPRINGS], penetration: [0.0; MOST_SPRINGS], slope };
        let mut peaks = [0.0; MOST_SPRINGS];
        let pairs = found.loads.chunks(count).zip(found.penetration.chunks(count));
        for (pair, (loads, penetration)) in pairs.enumerate() {
            let largest = |values: &[f64]| values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            balance.loads[pair] = loads.iter().sum();
            balance.penetration[pair] = largest(penetration);
            let per_width = loads.iter().zip(&self.widths).map(|(load, width)| load / width);
            peaks[pair] = per_width.fold(f64::NEG_INFINITY, f64::max);
        }
        (balance, peaks)
    }

    /// The load per width of each slice of the whole face, as a mean over it, pair by pair.
    pub(in crate::gear::mesh) fn line_loads(
        &self,
        flanks_of: FlanksOf<'_, 'a>,
        reach: &CandidatePairs,
        known: [f64; 2],
    ) -> Vec<Vec<f64>> {
        let (found, _) = self.slices(flanks_of, reach, known);
        let looked_at = |slice: usize| if slice < self.count() { slice } else { self.whole - 1 - slice };
        let of_pair =
            |loads: &[f64]| (0..self.whole).map(looked_at).map(|slice| loads[slice] / self.widths[slice]).collect();
        found.loads.chunks(self.count()).map(of_pair).collect()
    }

    /// Equilibrium of all slices, pair by pair, its approach counted from the smallest gap of a slice, and that gap.
    fn slices(
        &self,
        flanks_of: FlanksOf<'_, 'a>,
        reach: &CandidatePairs,
        [force, above]: [f64; 2],
    ) -> (many_springs::Balance, f64) {
        let cycle = self.flanks.cycle;
        let (matrix, own) = self.matrix(cycle, reach.springs(), reach.positions());
        // The lowest place of the face is one of a slice but for rounding.
        let strips = self.deviations(flanks_of, reach);
        let mut behind = strips.behind(reach.gaps(), self.count());
        let smallest = behind.iter().copied().fold(f64::INFINITY, f64::min);
        for gap in &mut behind {
            *gap -= smallest;
        }
        let slices = self.springs(cycle, reach.positions(), &own, &strips.faces);
        (many_springs::balance(&slices, &behind, &matrix, force, above), smallest)
    }

    /// The load over the force that a slice carries and its penetration, recomputed from loads, gaps and influences, does
    /// not explain, and how much of it rounding of what is subtracted is worth: of the slice where most of that is used up.
    pub(in crate::gear::mesh) fn unexplained(
        &self,
        flanks_of: FlanksOf<'_, 'a>,
        reach: &CandidatePairs,
        [force, above]: [f64; 2],
    ) -> [f64; 2] {
        self.unexplained_in(flanks_of, reach, force, &self.slices(flanks_of, reach, [force, above]))
    }

    /// The same in a balance whose smallest gap is given with it.
    fn unexplained_in(
        &self,
        flanks_of: FlanksOf<'_, 'a>,
        reach: &CandidatePairs,
        force: f64,
        (found, smallest): &(many_springs::Balance, f64),
    ) -> [f64; 2] {
        let cycle = self.flanks.cycle;
        let size = reach.gaps().len() * self.count();
        let (matrix, own) = self.matrix(cycle, reach.springs(), reach.positions());
        let strips = self.deviations(flanks_of, reach);
        let behind = strips.behind(reach.gaps(), self.count());
        let slices = self.springs(cycle, reach.positions(), &own, &strips.faces);
        let mut worst = [0.0, 1.0];
        for (slice, &load) in found.loads.iter().enumerate() {
            let row = &matrix[slice * size..][..size];
            let others: f64 = row.iter().zip(&found.loads).map(|(influence, load)| influence * load).sum();
            let gap = behind[slice] - smallest;
            let penetration = found.approach - gap - others;
            let (carried, rise) =
                if penetration > 0.0 { slices.response(slice, penetration) } else { (0.0, 1.0 / own[slice]) };
            let value = (carried - load).abs() / force;
            let scale = 1.0 + rise * (found.approach + gap + others.abs()) / force;
            if value * worst[1] >= worst[0] * scale {
                worst = [value, scale];
            }
        }
        worst
    }

    /// What each slice carries by itself.
    fn springs<'b>(&'b self, cycle: &'b Mesh, positions: &[f64], own: &[f64], faces: &'b [Face]) -> Slices<'b> {
        let mut slices = Vec::with_capacity(own.len());
        for (&s, own) in positions.iter().zip(own.chunks(self.count())) {
            let own = own.iter().zip(&self.widths);
            match &cycle.elasticity {
                Elasticity::Linear(_) => {
                    slices.extend(own.map(|(own, width)| Slice::Linear(1.0 / (own + self.across.contact / width))));
                }
                elasticity @ Elasticity::Logarithmic { .. } => {
                    slices.extend(own.map(|(own, width)| Slice::Logarithmic(elasticity.series(s, Some(own * width)))));
                }
            }
        }
        Slices { slices, faces, widths: &self.widths }
    }

    /// Penetration of each slice, pair by pair, per load on each \[m/N\], contact left out; by rows. And that of each
    /// slice by its own load, which is not in it.
    fn matrix(&self, cycle: &Mesh, springs: &[usize], positions: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let (across, count) = (self.across, self.count());
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

    /// Puts influences between all slices of two pairs, given by their places, into the matrix of those that are looked at:
    /// what a load that is shared with the mirror image does to either of the two.
    fn put(&self, block: &[f64], scale: f64, matrix: &mut [f64], [by, on]: [usize; 2], size: usize) {
        let count = self.count();
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
