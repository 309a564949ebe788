//! What one load case computes, counted by itself and added to the cycle's total when it is dropped.
//!
//! A counter that threads share would cost as much as what it counts. Must not know: what is computed.

use std::cell::Cell;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::gear::work::{CONTACT_PRESSURES, CONTACT_SOLVES, ROOT_STRESSES, SLICES};
use declare::work::Work;

/// What the load cases of a cycle computed in all. Threads that search among designs add to it some hundred thousand times
/// a second, so it takes neither a lock nor memory.
#[derive(Debug, Default)]
pub(in crate::gear::mesh) struct Total {
    solves: AtomicUsize,
    slices: AtomicUsize,
    pressures: AtomicUsize,
    root_stresses: AtomicUsize,
}

impl Total {
    pub(in crate::gear::mesh) fn work(&self) -> Work {
        let [solves, slices, pressures, root_stresses] =
            [&self.solves, &self.slices, &self.pressures, &self.root_stresses]
                .map(|count| count.load(Ordering::Relaxed));
        Work::of(&CONTACT_SOLVES, solves)
            .with(&SLICES, slices)
            .with(&CONTACT_PRESSURES, pressures)
            .with(&ROOT_STRESSES, root_stresses)
    }
}

#[derive(Debug)]
pub(in crate::gear::mesh) struct Count<'a> {
    total: &'a Total,
    slices: usize,
    solves: Cell<usize>,
    pressures: Cell<usize>,
    root_stresses: Cell<usize>,
}

impl<'a> Count<'a> {
    /// `slices`: how many the face of a pair is cut into.
    pub(in crate::gear::mesh) fn new(total: &'a Total, slices: usize) -> Self {
        Self { total, slices, solves: Cell::new(0), pressures: Cell::new(0), root_stresses: Cell::new(0) }
    }

    pub(in crate::gear::mesh) fn solves(&self, count: usize) {
        self.solves.set(self.solves.get() + count);
    }

    pub(in crate::gear::mesh) fn pressure(&self) {
        self.pressures.set(self.pressures.get() + 1);
    }

    pub(in crate::gear::mesh) fn root_stress(&self) {
        self.root_stresses.set(self.root_stresses.get() + 1);
    }
}

impl Clone for Count<'_> {
    /// What was counted stays with the load case that counted it.
    fn clone(&self) -> Self {
        Self::new(self.total, self.slices)
    }
}

impl Drop for Count<'_> {
    fn drop(&mut self) {
        let [solves, pressures, root_stresses] = [&self.solves, &self.pressures, &self.root_stresses].map(Cell::get);
        if solves > 0 {
            self.total.solves.fetch_add(solves, Ordering::Relaxed);
            self.total.slices.fetch_max(self.slices, Ordering::Relaxed);
            if pressures > 0 {
                self.total.pressures.fetch_add(pressures, Ordering::Relaxed);
            }
            if root_stresses > 0 {
                self.total.root_stresses.fetch_add(root_stresses, Ordering::Relaxed);
            }
        }
    }
}
