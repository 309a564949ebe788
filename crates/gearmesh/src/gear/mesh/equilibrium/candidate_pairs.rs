//! The pairs of one position that can carry load.
//!
//! Must not know: what a gap is made of, how loads are found.

use crate::numeric::complementarity::{MOST_SPRINGS, PerSpring};

/// Pairs and the gaps they stand behind, in the order of the springs of the position.
pub(in crate::gear::mesh) struct CandidatePairs {
    count: usize,
    springs: [usize; MOST_SPRINGS],
    positions: PerSpring,
    gaps: PerSpring,
    /// The smallest gap \[m\]; all others count from it.
    pub(in crate::gear::mesh) smallest: f64,
    nearest: usize,
}

impl CandidatePairs {
    pub(in crate::gear::mesh) fn none() -> Self {
        Self {
            count: 0,
            springs: [0; MOST_SPRINGS],
            positions: [0.0; MOST_SPRINGS],
            gaps: [0.0; MOST_SPRINGS],
            smallest: f64::INFINITY,
            nearest: 0,
        }
    }

    /// Adds a pair; its gap counts from nothing until [`CandidatePairs::count_gaps_from_the_smallest`].
    #[inline]
    pub(in crate::gear::mesh) fn push(&mut self, spring: usize, position: f64, gap: f64) {
        let index = self.count;
        (self.springs[index], self.positions[index], self.gaps[index]) = (spring, position, gap);
        self.count += 1;
        if gap < self.smallest {
            (self.smallest, self.nearest) = (gap, index);
        }
    }

    /// Every pair is there.
    #[inline]
    pub(in crate::gear::mesh) fn count_gaps_from_the_smallest(&mut self) {
        for gap in &mut self.gaps[..self.count] {
            *gap -= self.smallest;
        }
    }

    /// Leaves out the pairs whose gap is larger.
    pub(in crate::gear::mesh) fn keep_nearer_than(&mut self, gap: f64) {
        let nearest = self.springs[self.nearest];
        let mut kept = 0;
        for index in 0..self.count {
            if self.gaps[index] <= gap {
                self.springs[kept] = self.springs[index];
                self.positions[kept] = self.positions[index];
                self.gaps[kept] = self.gaps[index];
                if self.springs[kept] == nearest {
                    self.nearest = kept;
                }
                kept += 1;
            }
        }
        self.count = kept;
    }

    /// The places of the pairs among the springs of the position, ascending.
    pub(in crate::gear::mesh) fn springs(&self) -> &[usize] {
        &self.springs[..self.count]
    }

    /// Path positions \[m\].
    pub(in crate::gear::mesh) fn positions(&self) -> &[f64] {
        &self.positions[..self.count]
    }

    /// Gaps from the smallest one up \[m\].
    pub(in crate::gear::mesh) fn gaps(&self) -> &[f64] {
        &self.gaps[..self.count]
    }

    /// Which pair is the nearest.
    pub(in crate::gear::mesh) fn nearest(&self) -> usize {
        self.nearest
    }

    pub(in crate::gear::mesh) fn nearest_position(&self) -> f64 {
        self.positions[self.nearest]
    }

    pub(in crate::gear::mesh) fn nearest_spring(&self) -> usize {
        self.springs[self.nearest]
    }
}
