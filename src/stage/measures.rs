//! Numbers of a curve of the transmission error by the names that the stage kind `ste` gives them, and what is asked of the
//! curve for them.
//!
//! They are those of the stage, to the last bit but for what `needs.rs` of the kernels says of extremes. Must not know: where
//! the curve comes from, who asks.

use crate::stage::names::summary;
use declare::declared::Placed;
use declare::error::{Diagnostic, suggest};
use gearmesh::gear::mesh::answers::needs::Needs;
use gearmesh::gear::mesh::answers::quantities::{Need, QUANTITIES, Quantity, quantity};
use gearmesh::gear::mesh::answers::sampling::{Against, Sampled};
use gearmesh::gear::mesh::{Loaded, Settings};
use studygraph::table::select::CellName;

/// The table of the harmonics.
pub const HARMONICS: &str = "harmonics";
const ORDER: &str = "order";
const AMPLITUDE: &str = "amplitude";
/// Beyond it a harmonic says more of the sampling than of the gears: what `harmonics` of the stage may be.
const HIGHEST_ORDER: usize = 200;

/// A number of a curve.
#[derive(Clone, Copy, Debug)]
enum Get {
    Quantity(&'static Quantity),
    Harmonic(usize),
    Positions,
    Slices,
    ErrorEstimate,
}

/// Numbers of the sampling, which no design changes.
const OF_SAMPLING: [(&str, Get); 3] =
    [("positions", Get::Positions), ("slices", Get::Slices), ("error_estimate", Get::ErrorEstimate)];

/// A number of a curve and how it is written.
#[derive(Clone, Debug)]
pub struct Measure {
    get: Get,
    /// As a column of a table of its own.
    pub column: String,
    /// As that column shows it.
    pub unit: &'static str,
}

/// The column names it.
impl PartialEq for Measure {
    fn eq(&self, other: &Self) -> bool {
        self.column == other.column
    }
}

impl Measure {
    /// Which number a cell of the stage `ste` is, but for what a curve by itself does not tell; none where it is not known
    /// here.
    #[must_use]
    pub fn of_cell(cell: &CellName) -> Option<Self> {
        if cell.table == HARMONICS && cell.column == AMPLITUDE {
            let [(key, order)] = &cell.conditions[..] else { return None };
            let order = order.parse().ok().filter(|order| key == ORDER && (1..=HIGHEST_ORDER).contains(order))?;
            let column = format!("{AMPLITUDE}_{order}");
            return Some(Self { get: Get::Harmonic(order), column, unit: "um" });
        }
        if cell.table != summary::TABLE || !cell.conditions.is_empty() {
            return None;
        }
        let of_sampling = || OF_SAMPLING.iter().find(|(name, _)| *name == cell.column).map(|(_, get)| (*get, ""));
        let of_curve = quantity(&cell.column).map(|quantity| (Get::Quantity(quantity), quantity.unit));
        let (get, unit) = of_curve.or_else(of_sampling)?;
        Some(Self { get, column: cell.column.clone(), unit })
    }

    /// Reads `column` of the summary, or `harmonics[order=2].amplitude`: a number that a design changes.
    ///
    /// # Errors
    /// Which names there are.
    pub fn read(text: &str) -> Result<Self, Diagnostic> {
        let written = text.trim();
        let whole = if written.contains(['.', '[']) {
            format!("ste.{written}")
        } else {
            format!("ste.{}.{written}", summary::TABLE)
        };
        let found = CellName::parse(&whole).ok().as_ref().and_then(Self::of_cell);
        let names = || QUANTITIES.iter().map(|quantity| quantity.name);
        let is_of_curve = |measure: &Self| matches!(measure.get, Get::Quantity(_) | Get::Harmonic(_));
        found.filter(is_of_curve).ok_or_else(|| {
            let help = if written.starts_with(HARMONICS) {
                format!("a harmonic is written `{HARMONICS}[{ORDER}=1].{AMPLITUDE}`, its order at most {HIGHEST_ORDER}")
            } else {
                format!("{}; a harmonic is `{HARMONICS}[{ORDER}=1].{AMPLITUDE}`", suggest(written, names()))
            };
            Diagnostic::new(format!("`{written}` is no number of a curve that a design can change")).help(help)
        })
    }

    /// As [`Measure::read`], of a text of a study.
    ///
    /// # Errors
    /// As [`Measure::read`], at its place.
    pub fn placed(text: &Placed<String>) -> Result<Self, Diagnostic> {
        Self::read(&text.value).map_err(|wrong| wrong.at(text.place))
    }

    /// Whether a cycle has to know what loads do to the roots.
    #[must_use]
    pub fn needs_roots(&self) -> bool {
        matches!(self.get, Get::Quantity(quantity) if quantity.need == Need::RootStress)
    }

    /// Whether it is the quantity with this name.
    #[must_use]
    pub fn is(&self, name: &str) -> bool {
        matches!(self.get, Get::Quantity(quantity) if quantity.name == name)
    }
}

/// Numbers that are asked of one curve together.
#[derive(Clone, Debug)]
pub struct Measures(Vec<Measure>);

impl Measures {
    #[must_use]
    pub fn new(measures: Vec<Measure>) -> Self {
        Self(measures)
    }

    /// The highest harmonic that is asked; 0 where none is.
    #[must_use]
    pub fn highest_order(&self) -> usize {
        let order = |measure: &Measure| if let Get::Harmonic(order) = measure.get { order } else { 0 };
        self.0.iter().map(order).max().unwrap_or(0)
    }

    /// In SI, in their order; `again` gives the peak-to-peak with other settings. One that a curve has not, such as where
    /// the pressure is largest without load, is NaN.
    ///
    /// # Errors
    /// Why there are none.
    pub fn of(
        &self,
        loading: &Loaded,
        (settings, harmonics): (Settings, usize),
        again: impl Fn(Settings) -> f64,
    ) -> Result<Vec<f64>, String> {
        let needs = Needs { harmonics: self.highest_order(), spans_for: harmonics, ..Needs::default() };
        let needs = self.0.iter().fold(needs, |needs, measure| match measure.get {
            Get::Quantity(quantity) => needs.and(quantity),
            _ => needs,
        });
        let curve = loading.summary_of(needs);
        loading.check_approach(curve.largest.value).map_err(|beyond| beyond.to_string())?;
        let mut numbers = Vec::with_capacity(self.0.len());
        for measure in &self.0 {
            let value = match measure.get {
                Get::Quantity(quantity) => (quantity.get)(&curve),
                Get::Positions => settings.positions as f64,
                Get::Slices => settings.slices as f64,
                Get::ErrorEstimate => {
                    let sliced = loading.uses_slices();
                    let mut sampled = Sampled::new(sliced, Against::Coarser, &again);
                    sampled.know(settings, curve.peak_to_peak);
                    sampled.error(settings)
                }
                Get::Harmonic(order) => curve.harmonics[order - 1],
            };
            if value.is_infinite() {
                return Err("a number is beyond what the model holds".to_owned());
            }
            numbers.push(value);
        }
        Ok(numbers)
    }
}
