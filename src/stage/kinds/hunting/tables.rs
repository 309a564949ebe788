//! The tables of a stage of the kind `hunting`.
//!
//! Must not know: how a curve is found.

use studygraph::table::columns::Columns;

pub const SUMMARY: &str = "summary";
pub const SPECTRUM: &str = "spectrum";
pub const CURVE: &str = "curve";

/// The transmission error over a hunting period.
pub struct Found {
    /// At equidistant positions \[m\].
    pub errors: Vec<f64>,
    /// Of these a base pitch has so many.
    pub positions: usize,
    /// The base pitch \[m\].
    pub period: f64,
}

impl Found {
    pub fn maximum(&self) -> f64 {
        self.errors.iter().copied().fold(f64::NEG_INFINITY, f64::max)
    }

    fn minimum(&self) -> f64 {
        self.errors.iter().copied().fold(f64::INFINITY, f64::min)
    }

    fn mean(&self) -> f64 {
        self.errors.iter().sum::<f64>() / self.errors.len() as f64
    }

    fn pitches(&self) -> usize {
        self.errors.len() / self.positions
    }

    /// f'_i: the largest range within a base pitch from where a pair starts contact, its end included; and in which one, from 1.
    fn tooth_to_tooth(&self) -> (f64, usize) {
        let (count, positions) = (self.errors.len(), self.positions);
        let range = |pitch: usize| {
            let of = (0..=positions).map(|index| self.errors[(pitch * positions + index) % count]);
            let (low, high) =
                of.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), error| (low.min(error), high.max(error)));
            high - low
        };
        let ranges = (0..self.pitches()).map(|pitch| (range(pitch), pitch + 1));
        ranges.fold((0.0, 1), |largest, here| if here.0 > largest.0 { here } else { largest })
    }
}

/// A design under a torque.
pub struct Case {
    pub name: String,
    /// On the pinion \[N m\].
    pub torque: f64,
    pub found: Found,
    /// The peak-to-peak without pitch deviations \[m\].
    pub plain: f64,
    /// Of the orders of the hunting period from 1 on \[m\].
    pub amplitudes: Vec<f64>,
    /// F_p of each tooth, pinion and gear \[m\].
    pub cumulative: [Vec<f64>; 2],
}

/// F_p: the total cumulative pitch deviation \[m\].
fn total(cumulative: &[f64]) -> f64 {
    let (low, high) = cumulative
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)));
    if cumulative.is_empty() { 0.0 } else { high - low }
}

/// f_p: the largest single pitch deviation, without its sign \[m\].
fn single(cumulative: &[f64]) -> f64 {
    let before = cumulative.iter().cycle().skip(cumulative.len().saturating_sub(1));
    cumulative.iter().zip(before).map(|(here, before)| (here - before).abs()).fold(0.0, f64::max)
}

fn keyed<T>(name: &str, description: &str, case: impl Fn(&T) -> &Case + Copy + 'static) -> Columns<T> {
    Columns::new(name, description)
        .text("design", "Name of the design.", move |row: &T| case(row).name.clone())
        .key()
        .float("torque", "N m", "Torque on the pinion.", move |row| case(row).torque)
        .key()
}

pub fn summary() -> Columns<Case> {
    let composite =
        "Total transmission deviation F'_i: largest less smallest transmission error of the hunting period.";
    let tooth = "Tooth-to-tooth transmission deviation f'_i: the largest range within a base pitch.";
    let plain = "Peak-to-peak of the same design without pitch deviations.";
    let pitches = "Base pitches of the hunting period, lcm(z1, z2): after them the same teeth meet again.";
    keyed(SUMMARY, "What the transmission error of each hunting period amounts to.", |row: &Case| row)
        .integer("pitches", pitches, |row| row.found.pitches())
        .float("peak_to_peak", "um", composite, |row| row.found.maximum() - row.found.minimum())
        .but(|column| column.tolerance(1e-12, 1e-9))
        .float("tooth_to_tooth", "um", tooth, |row| row.found.tooth_to_tooth().0)
        .but(|column| column.tolerance(1e-12, 1e-9))
        .integer("tooth_to_tooth_pitch", "In which base pitch that is, from 1.", |row| row.found.tooth_to_tooth().1)
        .float("peak_to_peak_without_deviations", "um", plain, |row| row.plain)
        .but(|column| column.tolerance(1e-12, 1e-9))
        .float("mean", "um", "Mean of the transmission error over the hunting period.", |row| row.found.mean())
        .float("maximum", "um", "Largest transmission error.", |row| row.found.maximum())
        .float("minimum", "um", "Smallest transmission error.", |row| row.found.minimum())
        .float("pinion_cumulative_deviation", "um", "Total cumulative pitch deviation F_p of the pinion.", |row| {
            total(&row.cumulative[0])
        })
        .float("gear_cumulative_deviation", "um", "Total cumulative pitch deviation F_p of the gear.", |row| {
            total(&row.cumulative[1])
        })
        .float("pinion_single_deviation", "um", "Largest single pitch deviation f_p of the pinion.", |row| {
            single(&row.cumulative[0])
        })
        .but(|column| column.tolerance(1e-12, 1e-9))
        .float("gear_single_deviation", "um", "Largest single pitch deviation f_p of the gear.", |row| {
            single(&row.cumulative[1])
        })
        .but(|column| column.tolerance(1e-12, 1e-9))
}

/// An order of the hunting period.
#[derive(Clone, Copy)]
pub struct Order<'a> {
    case: &'a Case,
    number: usize,
    teeth: [u32; 2],
}

impl<'a> Order<'a> {
    pub fn all(case: &'a Case, teeth: [u32; 2]) -> impl Iterator<Item = Self> + Clone {
        (1..=case.amplitudes.len()).map(move |number| Self { case, number, teeth })
    }

    /// How often in a period of so many base pitches.
    fn per(&self, pitches: f64) -> f64 {
        self.number as f64 * pitches / self.case.found.pitches() as f64
    }
}

pub fn spectrum<'a>() -> Columns<Order<'a>> {
    keyed(SPECTRUM, "Orders of the transmission error over each hunting period.", |row: &Order<'a>| row.case)
        .integer("order", "How often in a hunting period.", |row| row.number)
        .key()
        .float("mesh_order", "", "Multiple of the mesh frequency.", |row| row.per(1.0))
        .float("pinion_order", "", "How often in a turn of the pinion.", |row| row.per(f64::from(row.teeth[0])))
        .float("gear_order", "", "How often in a turn of the gear.", |row| row.per(f64::from(row.teeth[1])))
        .float("amplitude", "um", "Amplitude of the transmission error.", |row| row.case.amplitudes[row.number - 1])
        .but(|column| column.tolerance(1e-12, 1e-9))
}

/// A position of a hunting period.
#[derive(Clone, Copy)]
pub struct Row<'a> {
    case: &'a Case,
    index: usize,
}

impl<'a> Row<'a> {
    pub fn all(case: &'a Case) -> impl Iterator<Item = Self> + Clone {
        (0..case.found.errors.len()).map(move |index| Self { case, index })
    }
}

pub fn curve<'a>() -> Columns<Row<'a>> {
    let position = "How many base pitches from where the first teeth of both gears start contact.";
    keyed(CURVE, "Transmission error at equidistant positions of each hunting period.", |row: &Row<'a>| row.case)
        .integer("point", "Counts the positions, from 1.", |row| row.index + 1)
        .key()
        .float("pitch", "", position, |row| row.index as f64 / row.case.found.positions as f64)
        .float("distance", "mm", "The same along the line of action.", |row| {
            row.index as f64 / row.case.found.positions as f64 * row.case.found.period
        })
        .float("transmission_error", "um", "Approach of the gears along the line of action.", |row| {
            row.case.found.errors[row.index]
        })
        .on_demand()
}
