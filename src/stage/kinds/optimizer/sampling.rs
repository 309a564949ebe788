//! Samplings for a wanted accuracy of the objective: picked before the search, checked at what it found.
//!
//! Before the search a few designs of the box stand for those it will try; what counts is the design it finds. Must not
//! know: how the search goes on.

use super::Optimizer;
use gearmesh::gear::contact::SliceCoupling;
use gearmesh::gear::mesh::answers::sampling::{Against, Sampled};
use gearmesh::gear::mesh::{Mesh, Settings};
use gearmesh::gear::modification::template::Fitted;

/// Places on the diagonal of the box that stand for all of it.
const PROBES: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];

/// With fewer positions spans are as long as a smooth stretch; with fewer slices a crowned face is hardly seen.
const FEWEST_POSITIONS: usize = 16;
const FEWEST_SLICES: usize = 5;

impl Optimizer {
    /// The settings to begin with.
    pub fn first_settings(&self, base: &Mesh, fitted: &Fitted) -> Settings {
        let Some(accuracy) = self.stated.accuracy else { return self.settings };
        let variables = self.template.variables();
        let at = |share: &f64| -> Vec<f64> {
            variables.iter().map(|variable| variable.minimum + share * (variable.maximum - variable.minimum)).collect()
        };
        let chosen = PROBES.iter().map(at).map(|point| self.settings_for(base, fitted, &point, accuracy));
        chosen.reduce(finer).unwrap_or(self.settings)
    }

    /// The coarsest settings that meet an accuracy at one design.
    pub fn settings_for(&self, base: &Mesh, fitted: &Fitted, point: &[f64], accuracy: f64) -> Settings {
        self.at(base, fitted, point, |mut sampled| sampled.coarsest(self.settings, accuracy)).unwrap_or(self.settings)
    }

    /// Estimated relative error of the objective at one design.
    pub fn error(&self, base: &Mesh, fitted: &Fitted, point: &[f64], settings: Settings) -> f64 {
        self.at(base, fitted, point, |mut sampled| sampled.error(settings)).unwrap_or(1.0)
    }

    /// None where the design cannot be built.
    fn at<T>(
        &self,
        base: &Mesh,
        fitted: &Fitted,
        point: &[f64],
        look: impl FnOnce(Sampled<&mut dyn FnMut(Settings) -> f64>) -> T,
    ) -> Option<T> {
        let design = fitted.design(point).ok()?;
        let sliced = self.of_cases((fitted, base), &design, |loading, _| loading.uses_slices());
        let sliced = sliced?.contains(&true);
        let mut value = |settings| self.worth(&base.sampled(settings), fitted, point).evaluation.value;
        Some(look(Sampled::new(sliced, Against::Finer, &mut value)))
    }
}

/// What a search looks at on its way to the asked sampling, the coarsest first: a quarter of the positions, and half of the
/// slices, as long as either says anything. Slices that hold each other are halved twice: their cost goes with their number to
/// a power above two.
pub fn coarser(asked: Settings) -> Vec<Settings> {
    let positions = (asked.positions / 4).max(FEWEST_POSITIONS).min(asked.positions);
    let half = |slices: usize| (slices / 2 + 1).max(FEWEST_SLICES).min(slices);
    let once = half(asked.slices);
    let slices = match asked.slice_coupling {
        SliceCoupling::Plate if half(once) < once => vec![half(once), once],
        _ => vec![once],
    };
    slices.into_iter().map(|slices| Settings { positions, slices, ..asked }).collect()
}

/// As fine as either.
pub fn finer(one: Settings, two: Settings) -> Settings {
    Settings { positions: one.positions.max(two.positions), slices: one.slices.max(two.slices), ..one }
}
