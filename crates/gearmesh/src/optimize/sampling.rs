//! Searches that do not learn: a fixed set of points, handed out in batches.
//!
//! Must not know: how the points were laid out.

use super::search::Reason;
use super::{Foreseen, Strategy, points_held};
use declare::error::Diagnostic;

/// More points than this are refused: nobody waits for them, and a slip (`levels: 1000` on five variables) is likelier.
pub const MOST_POINTS: i64 = 1 << 24;

/// Points per batch: enough for any number of threads, few enough to stop and to show progress between batches.
const BATCH: usize = 256;

type Layout = Box<dyn FnMut(usize) -> Vec<f64> + Send>;

/// What a sample of `count` points will ask for; `each` is the bytes that its layout holds for a point.
///
/// # Errors
/// When there are more than [`MOST_POINTS`] (`None`: too many to count).
pub fn foreseen(count: Option<usize>, dimension: usize, each: usize) -> Result<Foreseen, Diagnostic> {
    let Some(count) = count.filter(|count| i64::try_from(*count).is_ok_and(|count| count <= MOST_POINTS)) else {
        let found = count.map_or("too many points to count".to_owned(), |count| format!("{count} points"));
        return Err(Diagnostic::new(format!("{found}; at most {MOST_POINTS} are evaluated")));
    };
    let memory = count * each + points_held(2 * BATCH, dimension);
    Ok(Foreseen { evaluations: count, batches: count.div_ceil(BATCH), exact: true, memory })
}

/// `count` points of the unit cube, made when their batch comes up.
pub struct Sample {
    layout: Layout,
    count: usize,
    told: usize,
    batch: Vec<Vec<f64>>,
}

impl Sample {
    /// `layout` is asked for the points in their order.
    #[must_use]
    pub fn new(count: usize, layout: Layout) -> Self {
        let mut sample = Self { layout, count, told: 0, batch: Vec::new() };
        sample.fill();
        sample
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
