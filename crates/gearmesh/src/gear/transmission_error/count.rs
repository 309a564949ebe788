//! What one load case computes, counted by itself and added to the cycle's total when it is dropped.
//!
//! A counter that threads share would cost as much as what it counts. Must not know: what is computed.

use std::cell::Cell;

use crate::gear::work::{CONTACT_PRESSURES, CONTACT_SOLVES, SLICES};
use declare::work::{Tally, Work};

#[derive(Debug)]
pub(super) struct Count<'a> {
    total: &'a Tally,
    slices: usize,
    solves: Cell<usize>,
    pressures: Cell<usize>,
}

impl<'a> Count<'a> {
    /// `slices`: how many the face of a pair is cut into.
    pub(super) fn new(total: &'a Tally, slices: usize) -> Self {
        Self { total, slices, solves: Cell::new(0), pressures: Cell::new(0) }
    }

    pub(super) fn solve(&self) {
        self.solves.set(self.solves.get() + 1);
    }

    pub(super) fn pressure(&self) {
        self.pressures.set(self.pressures.get() + 1);
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
        let (solves, pressures) = (self.solves.get(), self.pressures.get());
        if solves > 0 {
            let work = Work::of(&CONTACT_SOLVES, solves).with(&SLICES, self.slices);
            self.total.add(&work.with(&CONTACT_PRESSURES, pressures));
        }
    }
}
