//! Numbers of a curve of the transmission error by the names that the stage kind `ste` gives them, and what is asked of the
//! curve for them.
//!
//! They are those of the stage, to the last bit but for what `asked.rs` of the kernels says of extremes. Must not know: where
//! the curve comes from, who asks.

use crate::stage::names::summary;
use declare::declared::Placed;
use declare::error::{Diagnostic, suggest};
use gearmesh::gear::geometry::Side;
use gearmesh::gear::transmission_error::asked::{Asked, Found};
use gearmesh::gear::transmission_error::curve::{Summary, Wanted};
use gearmesh::gear::transmission_error::cycle::Settings;
use gearmesh::gear::transmission_error::load_case::LoadCase;
use gearmesh::gear::transmission_error::pressure::LargestPressure;
use gearmesh::gear::transmission_error::sampling::{Against, Sampled};
use studygraph::table::select::CellName;

/// The table of the harmonics.
pub const HARMONICS: &str = "harmonics";
const ORDER: &str = "order";
const AMPLITUDE: &str = "amplitude";
/// Beyond it a harmonic says more of the sampling than of the gears: what `harmonics` of the stage may be.
const HIGHEST_ORDER: usize = 200;

/// A number of a curve, in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Get {
    Mean,
    PeakToPeak,
    Maximum,
    Minimum,
    Variance,
    ReciprocalVariance,
    Unloaded,
    ContactRatio,
    LoadShare,
    Pressure,
    PressurePosition,
    PressureRoll,
    PressureZ,
    PressureHalfWidth,
    RootStress(Side),
    Positions,
    Slices,
    ErrorEstimate,
    Harmonic(usize),
}

/// Columns of the summary, with their units.
const OF_SUMMARY: &[(&str, &str, Get)] = &[
    ("mean", "um", Get::Mean),
    ("peak_to_peak", "um", Get::PeakToPeak),
    ("maximum", "um", Get::Maximum),
    ("minimum", "um", Get::Minimum),
    ("variance", "um^2", Get::Variance),
    ("reciprocal_variance", "1/um^2", Get::ReciprocalVariance),
    ("unloaded_peak_to_peak", "um", Get::Unloaded),
    ("loaded_contact_ratio", "", Get::ContactRatio),
    ("largest_load_share", "", Get::LoadShare),
    (summary::LARGEST_PRESSURE, "MPa", Get::Pressure),
    ("pressure_position", "mm", Get::PressurePosition),
    ("pressure_roll_angle", "deg", Get::PressureRoll),
    ("pressure_z", "mm", Get::PressureZ),
    ("pressure_half_width", "um", Get::PressureHalfWidth),
    (summary::LARGEST_ROOT_STRESS_PINION, "MPa", Get::RootStress(Side::Pinion)),
    (summary::LARGEST_ROOT_STRESS_GEAR, "MPa", Get::RootStress(Side::Gear)),
    ("positions", "", Get::Positions),
    ("slices", "", Get::Slices),
    ("error_estimate", "", Get::ErrorEstimate),
];

/// Those that tell about the sampling, not about the gears.
const OF_SAMPLING: [Get; 3] = [Get::Positions, Get::Slices, Get::ErrorEstimate];

/// A number of a curve and how it is written.
#[derive(Clone, Debug, PartialEq)]
pub struct Measure {
    get: Get,
    /// As a column of a table of its own.
    pub column: String,
    /// As that column shows it.
    pub unit: &'static str,
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
        let (name, unit, get) = OF_SUMMARY.iter().find(|(name, ..)| *name == cell.column)?;
        Some(Self { get: *get, column: (*name).to_owned(), unit })
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
        let names = || OF_SUMMARY.iter().filter(|(.., get)| !OF_SAMPLING.contains(get)).map(|(name, ..)| *name);
        found.filter(|measure| !OF_SAMPLING.contains(&measure.get)).ok_or_else(|| {
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
        matches!(self.get, Get::RootStress(_))
    }

    /// Whether it is the peak-to-peak, and nothing else is asked.
    #[must_use]
    pub fn is_peak_to_peak(&self) -> bool {
        self.get == Get::PeakToPeak
    }

    /// Whether it is the variance.
    #[must_use]
    pub fn is_variance(&self) -> bool {
        self.get == Get::Variance
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
        loading: &LoadCase,
        (settings, harmonics): (Settings, usize),
        again: impl Fn(Settings) -> f64,
    ) -> Result<Vec<f64>, String> {
        let asks = |wanted: &[Get]| self.0.iter().any(|measure| wanted.contains(&measure.get));
        let pressure =
            [Get::Pressure, Get::PressurePosition, Get::PressureRoll, Get::PressureZ, Get::PressureHalfWidth];
        let pressure = asks(&pressure);
        let root_stress = self.0.iter().any(Measure::needs_roots);
        let of_states = root_stress || asks(&[Get::ContactRatio, Get::LoadShare]);
        let (curve, of_pairs, of_roots) = if of_states {
            let harmonics = harmonics.max(self.highest_order());
            let summary = loading.summary(Wanted { harmonics, pressure, root_stress });
            let of_pairs = [summary.loaded_contact_ratio, summary.largest_load_share];
            let of_roots = summary.largest_root_stress.map(|roots| roots.map(|root| root.extremum.value));
            (of_summary(summary), of_pairs, of_roots.unwrap_or([f64::NAN; 2]))
        } else {
            let asked = Asked {
                integrals: asks(&[Get::Mean, Get::Variance, Get::ReciprocalVariance]),
                harmonics: self.highest_order(),
                spans_for: harmonics,
                pressure,
                unloaded: asks(&[Get::Unloaded]),
            };
            (loading.asked(asked), [f64::NAN; 2], [f64::NAN; 2])
        };
        loading.check_approach(curve.largest.value).map_err(|beyond| beyond.to_string())?;
        let peak_to_peak = curve.largest.value - curve.smallest.value;
        let of_pressure = |get: fn(&LargestPressure) -> f64| curve.pressure.as_ref().map_or(f64::NAN, get);
        let mut numbers = Vec::with_capacity(self.0.len());
        for measure in &self.0 {
            let value = match measure.get {
                Get::Mean => curve.mean,
                Get::PeakToPeak => peak_to_peak,
                Get::Maximum => curve.largest.value,
                Get::Minimum => curve.smallest.value,
                Get::Variance => curve.variance,
                Get::ReciprocalVariance if curve.variance > 0.0 => 1.0 / curve.variance,
                Get::ReciprocalVariance => f64::NAN,
                Get::Unloaded => curve.unloaded_peak_to_peak,
                Get::ContactRatio => of_pairs[0],
                Get::LoadShare => of_pairs[1],
                Get::Pressure => of_pressure(|largest| largest.extremum.value),
                Get::PressurePosition => of_pressure(|largest| largest.extremum.position),
                Get::PressureRoll => of_pressure(|largest| largest.roll_angle),
                Get::PressureZ => of_pressure(|largest| largest.across.unwrap_or(f64::NAN)),
                Get::PressureHalfWidth => of_pressure(|largest| largest.contact.half_width),
                Get::RootStress(side) => of_roots[usize::from(side == Side::Gear)],
                Get::Positions => settings.positions as f64,
                Get::Slices => settings.slices as f64,
                Get::ErrorEstimate => {
                    let sliced = loading.uses_slices();
                    let mut sampled = Sampled::new(sliced, Against::Coarser, &again);
                    sampled.know(settings, peak_to_peak);
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

fn of_summary(summary: Summary) -> Found {
    Found {
        largest: summary.largest,
        smallest: summary.smallest,
        mean: summary.mean,
        variance: summary.variance,
        harmonics: summary.harmonics,
        pressure: summary.largest_pressure,
        unloaded_peak_to_peak: summary.unloaded_peak_to_peak,
    }
}
