//! Numbers of a curve of the transmission error that a row may have, as their columns show them.
//!
//! Must not know: where the curve comes from.

use super::output::Output;
use crate::stage::measures::{Measure, Measures};
use declare::units::showing;
use gearmesh::gear::mesh::{Loaded, Settings};

/// The field of the stage that says how many harmonics there are.
pub const HARMONICS: &str = "harmonics";

type Shown = Box<dyn Fn(f64) -> f64 + Send + Sync>;

/// The numbers of a row.
pub struct Numbers {
    measures: Measures,
    shown: Vec<Shown>,
}

impl Numbers {
    /// None where one of them is not known here, or takes what a row has not: stresses at the roots.
    pub fn new(outputs: &[Output]) -> Option<Self> {
        let measure = |output: &Output| Measure::of_cell(&output.cell).filter(|measure| !measure.needs_roots());
        let measures: Vec<Measure> = outputs.iter().map(measure).collect::<Option<_>>()?;
        let shown = outputs.iter().map(|output| Box::new(showing(&output.column.unit)) as Shown).collect();
        Some(Self { measures: Measures::new(measures), shown })
    }

    /// The highest harmonic that is asked; 0 where none is.
    pub fn highest_order(&self) -> usize {
        self.measures.highest_order()
    }

    /// As their columns show them; `again` gives the peak-to-peak with other settings.
    ///
    /// # Errors
    /// Why there are none.
    pub fn of(
        &self,
        loading: &Loaded,
        sampling: (Settings, usize),
        again: impl Fn(Settings) -> f64,
    ) -> Result<Vec<f64>, String> {
        let numbers = self.measures.of(loading, sampling, again)?;
        Ok(numbers.into_iter().zip(&self.shown).map(|(value, shown)| shown(value)).collect())
    }
}
