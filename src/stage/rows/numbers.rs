//! Numbers of a curve of the transmission error that a row may have, and what is asked of the curve for them.
//!
//! They are those of the stage, to the last bit but for what `asked.rs` of the kernels says of extremes. Must not know: where
//! the curve comes from.

use super::output::Output;
use crate::stage::names::summary;
use declare::units::{in_unit, showing};
use gearmesh::gear::transmission_error::asked::{Asked, Found};
use gearmesh::gear::transmission_error::curve::{Summary, Wanted};
use gearmesh::gear::transmission_error::cycle::Settings;
use gearmesh::gear::transmission_error::load_case::LoadCase;
use gearmesh::gear::transmission_error::sampling::{Against, Sampled};

/// The table of the harmonics, and the field of the stage that says how many there are.
pub const HARMONICS: &str = "harmonics";
const ORDER: &str = "order";
const AMPLITUDE: &str = "amplitude";

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
    Positions,
    Slices,
    ErrorEstimate,
    Harmonic(usize),
}

fn getter(output: &Output) -> Option<Get> {
    let of_summary = output.cell.table == summary::TABLE && output.cell.conditions.is_empty();
    match output.cell.column.as_str() {
        AMPLITUDE if output.cell.table == HARMONICS => match &output.cell.conditions[..] {
            [(key, order)] if key == ORDER => order.parse().ok().filter(|order| *order > 0).map(Get::Harmonic),
            _ => None,
        },
        _ if !of_summary => None,
        "mean" => Some(Get::Mean),
        "peak_to_peak" => Some(Get::PeakToPeak),
        "maximum" => Some(Get::Maximum),
        "minimum" => Some(Get::Minimum),
        "variance" => Some(Get::Variance),
        "reciprocal_variance" => Some(Get::ReciprocalVariance),
        "unloaded_peak_to_peak" => Some(Get::Unloaded),
        "loaded_contact_ratio" => Some(Get::ContactRatio),
        "largest_load_share" => Some(Get::LoadShare),
        summary::LARGEST_PRESSURE => Some(Get::Pressure),
        "pressure_position" => Some(Get::PressurePosition),
        "pressure_roll_angle" => Some(Get::PressureRoll),
        "pressure_z" => Some(Get::PressureZ),
        "pressure_half_width" => Some(Get::PressureHalfWidth),
        "positions" => Some(Get::Positions),
        "slices" => Some(Get::Slices),
        "error_estimate" => Some(Get::ErrorEstimate),
        _ => None,
    }
}

type Shown = Box<dyn Fn(f64) -> f64 + Send + Sync>;

/// The numbers of a row.
pub struct Numbers {
    gets: Vec<(Get, Shown)>,
}

impl Numbers {
    /// None where one of them is not known here.
    pub fn new(outputs: &[Output]) -> Option<Self> {
        let get = |output: &Output| Some((getter(output)?, Box::new(showing(&output.column.unit)) as Shown));
        Some(Self { gets: outputs.iter().map(get).collect::<Option<_>>()? })
    }

    /// The highest harmonic that is asked; 0 where none is.
    pub fn highest_order(&self) -> usize {
        let order = |get: &Get| if let Get::Harmonic(order) = get { *order } else { 0 };
        self.gets.iter().map(|(get, _)| order(get)).max().unwrap_or(0)
    }

    /// As their columns show them; `again` gives the peak-to-peak with other settings.
    ///
    /// # Errors
    /// Why there are none.
    pub fn of(
        &self,
        loading: &LoadCase,
        (settings, harmonics): (Settings, usize),
        again: impl Fn(Settings) -> f64,
    ) -> Result<Vec<f64>, String> {
        let asks = |wanted: &[Get]| self.gets.iter().any(|(get, _)| wanted.contains(get));
        let pressure =
            [Get::Pressure, Get::PressurePosition, Get::PressureRoll, Get::PressureZ, Get::PressureHalfWidth];
        let pressure = asks(&pressure);
        let shares = asks(&[Get::ContactRatio, Get::LoadShare]);
        let (curve, of_pairs) = if shares {
            let wanted = Wanted { harmonics, pressure, root_stress: false };
            let summary = loading.summary(wanted);
            let of_pairs = [summary.loaded_contact_ratio, summary.largest_load_share];
            (of_summary(summary), of_pairs)
        } else {
            let asked = Asked {
                integrals: asks(&[Get::Mean, Get::Variance, Get::ReciprocalVariance]),
                harmonics: self.highest_order(),
                spans_for: harmonics,
                pressure,
                unloaded: asks(&[Get::Unloaded]),
            };
            (loading.asked(asked), [f64::NAN; 2])
        };
        if !loading.holds(curve.largest.value) {
            let (found, maximum) = (in_unit(curve.largest.value, "mm"), in_unit(loading.largest_approach(), "mm"));
            return Err(format!(
                "the gears approach by {found:.6} mm, but `corner_contact: exact` holds up to {maximum:.6} mm only"
            ));
        }
        let peak_to_peak = curve.largest.value - curve.smallest.value;
        let mut numbers = Vec::with_capacity(self.gets.len());
        for (get, shown) in &self.gets {
            let of_pressure = |get: fn(&gearmesh::gear::transmission_error::pressure::LargestPressure) -> f64| {
                curve.pressure.as_ref().map_or(f64::NAN, get)
            };
            let value = match get {
                Get::Mean => curve.mean,
                Get::PeakToPeak => peak_to_peak,
                Get::Maximum => curve.largest.value,
                Get::Minimum => curve.smallest.value,
                Get::Variance => curve.variance,
                Get::ReciprocalVariance => {
                    if curve.variance > 0.0 {
                        1.0 / curve.variance
                    } else {
                        f64::NAN
                    }
                }
                Get::Unloaded => curve.unloaded_peak_to_peak,
                Get::ContactRatio => of_pairs[0],
                Get::LoadShare => of_pairs[1],
                Get::Pressure => of_pressure(|largest| largest.extremum.value),
                Get::PressurePosition => of_pressure(|largest| largest.extremum.position),
                Get::PressureRoll => of_pressure(|largest| largest.roll_angle),
                Get::PressureZ => of_pressure(|largest| largest.across.unwrap_or(f64::NAN)),
                Get::PressureHalfWidth => of_pressure(|largest| largest.contact.half_width),
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
            numbers.push(shown(value));
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
