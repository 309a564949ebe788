//! How far a stage is that takes many like steps on all threads.
//!
//! Whoever is told locks something, so it is told a hundred times and not at every step. Must not know: what a step is.

use std::sync::atomic::{AtomicUsize, Ordering};

use crate::stage::Context;

/// The steps of a stage, counted.
pub struct Steps<'a> {
    context: &'a Context<'a>,
    all: usize,
    done: AtomicUsize,
}

/// How often it is told, about.
const TIMES: usize = 100;

impl<'a> Steps<'a> {
    #[must_use]
    pub fn new(context: &'a Context<'a>, all: usize) -> Self {
        Self { context, all, done: AtomicUsize::new(0) }
    }

    /// Another one is done.
    pub fn done(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        if done.is_multiple_of(self.all.div_ceil(TIMES)) {
            (self.context.progress)(done as f64 / self.all as f64);
        }
    }
}
