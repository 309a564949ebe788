//! Searches that do not learn: a fixed set of points, handed out in batches.
//!
//! Must not know: how the points were laid out.

use super::Strategy;
use super::search::Reason;
use crate::base::error::Diagnostic;

/// More points than this are refused: nobody waits for them, and a slip (`levels: 1000` on five variables) is likelier.
pub const MOST_POINTS: i64 = 1 << 24;

/// Points per batch: enough for any number of threads, few enough to stop and to show progress between batches.
const BATCH: usize = 256;

type Layout = Box<dyn Fn(usize) -> Vec<f64> + Send>;

/// `count` points of the unit cube, made when their batch comes up.
pub struct Sample {
    layout: Layout,
    count: usize,
    told: usize,
    batch: Vec<Vec<f64>>,
}

impl Sample {
    /// # Errors
    /// When there are more than [`MOST_POINTS`] (`None`: too many to count).
    pub fn new(count: Option<usize>, layout: Layout) -> Result<Self, Diagnostic> {
        let Some(count) = count.filter(|count| i64::try_from(*count).is_ok_and(|count| count <= MOST_POINTS)) else {
            let found = count.map_or("too many points to count".to_owned(), |count| format!("{count} points"));
            return Err(Diagnostic::new(format!("{found}; at most {MOST_POINTS} are evaluated")));
        };
        let mut sample = Self { layout, count, told: 0, batch: Vec::new() };
        sample.fill();
        Ok(sample)
    }

    fn fill(&mut self) {
        let end = self.count.min(self.told + BATCH);
        self.batch = (self.told..end).map(|index| (self.layout)(index)).collect();
    }
}

impl Strategy for Sample {
    fn batch(&self) -> &[Vec<f64>] {
        &self.batch
    }

    fn learn(&mut self, values: &[f64]) -> Result<(), String> {
        self.told += values.len();
        self.fill();
        Ok(())
    }

    fn finished(&self) -> Option<Reason> {
        (self.told == self.count).then_some(Reason::Complete)
    }

    fn budget(&self) -> usize {
        self.count
    }
}
