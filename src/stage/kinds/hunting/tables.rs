//! The tables of a stage of the kind `hunting`.
//!
//! Must not know: how a curve is found.

use crate::stage::evaluated::{self, Evaluated};
use gearmesh::gear::geometry::Side;
use studygraph::table::columns::Columns;

pub const SUMMARY: &str = "summary";
pub const SPECTRUM: &str = "spectrum";
pub const CURVE: &str = "curve";
pub const FLANKS: &str = "flanks";

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

/// A design under a torque: what is left of its curve.
pub struct Case {
    pub name: String,
    /// On the pinion \[N m\].
    pub torque: f64,
    /// The peak-to-peak of the same design whose teeth do not deviate \[m\].
    pub plain: f64,
    pub deviations: Deviations,
    extent: Extent,
    /// Of the orders of the hunting period from 1 on \[m\].
    pub amplitudes: Vec<f64>,
    /// None where nobody asks for it.
    curve: Option<Found>,
}

/// What a curve amounts to.
struct Extent {
    /// Base pitches.
    pitches: usize,
    /// \[m\].
    maximum: f64,
    minimum: f64,
    mean: f64,
    tooth_to_tooth: (f64, usize),
}

impl Case {
    pub fn new(
        (name, torque): (String, f64),
        (plain, deviations): (f64, Deviations),
        found: Found,
        amplitudes: Vec<f64>,
        keeps_curve: bool,
    ) -> Self {
        let extent = Extent {
            pitches: found.pitches(),
            maximum: found.maximum(),
            minimum: found.minimum(),
            mean: found.mean(),
            tooth_to_tooth: found.tooth_to_tooth(),
        };
        Self { name, torque, plain, deviations, extent, amplitudes, curve: keeps_curve.then_some(found) }
    }
}

/// What the teeth of pinion and gear deviate by.
#[derive(Clone, Copy, Debug)]
pub struct Deviations {
    /// F_p: total cumulative pitch deviations \[m\].
    totals: [f64; 2],
    /// f_p: the largest single pitch deviations, without their signs \[m\].
    singles: [f64; 2],
    /// How many teeth have flanks of their own.
    flanks: [usize; 2],
}

impl Deviations {
    /// Of the cumulative pitch deviations F_p of each tooth \[m\], if any, and of how many teeth have flanks of their own.
    pub fn new(cumulative: &[Vec<f64>; 2], flanks: [usize; 2]) -> Self {
        let of = |deviation: fn(&[f64]) -> f64| cumulative.each_ref().map(|gear| deviation(gear));
        Self { totals: of(total), singles: of(single), flanks }
    }
}

fn total(cumulative: &[f64]) -> f64 {
    let (low, high) = cumulative
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)));
    if cumulative.is_empty() { 0.0 } else { high - low }
}

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
    let plain = "Peak-to-peak of the same design whose teeth do not deviate from it, found at its extremes as in `ste`; peak_to_peak is that of \
                 the positions.";
    let pitches = "Base pitches of the hunting period, lcm(z1, z2): after them the same teeth meet again.";
    keyed(SUMMARY, "What the transmission error of each hunting period amounts to.", |row: &Case| row)
        .integer("pitches", pitches, |row| row.extent.pitches)
        .float("peak_to_peak", "um", composite, |row| row.extent.maximum - row.extent.minimum)
        .but(|column| column.tolerance(1e-12, 1e-9))
        .float("tooth_to_tooth", "um", tooth, |row| row.extent.tooth_to_tooth.0)
        .but(|column| column.tolerance(1e-12, 1e-9))
        .integer("tooth_to_tooth_pitch", "In which base pitch that is, from 1.", |row| row.extent.tooth_to_tooth.1)
        .float("peak_to_peak_without_deviations", "um", plain, |row| row.plain)
        .but(|column| column.tolerance(1e-12, 1e-9))
        .float("mean", "um", "Mean of the transmission error over the hunting period.", |row| row.extent.mean)
        .float("maximum", "um", "Largest transmission error.", |row| row.extent.maximum)
        .float("minimum", "um", "Smallest transmission error.", |row| row.extent.minimum)
        .float("pinion_cumulative_deviation", "um", "Total cumulative pitch deviation F_p of the pinion.", |row| {
            row.deviations.totals[0]
        })
        .float("gear_cumulative_deviation", "um", "Total cumulative pitch deviation F_p of the gear.", |row| {
            row.deviations.totals[1]
        })
        .float("pinion_single_deviation", "um", "Largest single pitch deviation f_p of the pinion.", |row| {
            row.deviations.singles[0]
        })
        .but(|column| column.tolerance(1e-12, 1e-9))
        .float("gear_single_deviation", "um", "Largest single pitch deviation f_p of the gear.", |row| {
            row.deviations.singles[1]
        })
        .but(|column| column.tolerance(1e-12, 1e-9))
        .integer("pinion_flanks", "How many teeth of the pinion have a measured flank of their own.", |row| {
            row.deviations.flanks[0]
        })
        .integer("gear_flanks", "How many teeth of the gear have a measured flank of their own.", |row| {
            row.deviations.flanks[1]
        })
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
        self.number as f64 * pitches / self.case.extent.pitches as f64
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
    curve: &'a Found,
    index: usize,
}

impl<'a> Row<'a> {
    pub fn all(case: &'a Case) -> impl Iterator<Item = Self> + Clone {
        case.curve.iter().flat_map(move |curve| (0..curve.errors.len()).map(move |index| Self { case, curve, index }))
    }

    /// How many base pitches it is from the first.
    fn pitch(&self) -> f64 {
        self.index as f64 / self.curve.positions as f64
    }
}

pub fn curve<'a>() -> Columns<Row<'a>> {
    let position = "How many base pitches from where the first teeth of both gears start contact.";
    keyed(CURVE, "Transmission error at equidistant positions of each hunting period.", |row: &Row<'a>| row.case)
        .integer("point", "Counts the positions, from 1.", |row| row.index + 1)
        .key()
        .float("pitch", "", position, Row::pitch)
        .float("distance", "mm", "The same along the line of action.", |row| row.pitch() * row.curve.period)
        .float("transmission_error", "um", "Approach of the gears along the line of action.", |row| {
            row.curve.errors[row.index]
        })
        .on_demand()
}

/// What the trace of a tooth comes to.
pub struct Flank {
    pub side: Side,
    /// From 1.
    pub tooth: usize,
    pub evaluated: Evaluated,
}

pub fn flanks() -> Columns<Flank> {
    let description = "What the measured flank of each tooth comes to after ISO 1328-1:2013, of a grid that in the middle of its other way; \
                       positive where there is more material than designed.";
    let columns = Columns::new(FLANKS, description)
        .text("gear", "Which gear: pinion or gear.", |row: &Flank| row.side.name())
        .key()
        .integer("tooth", "Number of the tooth, from 1 in the order in which teeth come into mesh.", |row| row.tooth)
        .key();
    evaluated::columns(columns, |row| &row.evaluated).on_demand()
}
