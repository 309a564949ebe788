//! The size of the error where `corner_contact: none` leaves out tip corners that touch: one sentence a stage, of the worst
//! design and torque.
//!
//! A curve by itself says where corners would touch, and about how much that matters. Where it matters, one curve with corner
//! contact says how much it does. Must not know: whose designs they are.

use std::sync::Arc;

use crate::stage::{Inputs, common};
use declare::number::significant;
use declare::units::in_unit;
use gearmesh::gear::contact::CornerContact;
use gearmesh::gear::mesh::answers::curve::{Point, Summary, Wanted};
use gearmesh::gear::mesh::answers::needs::Needs;
use gearmesh::gear::mesh::answers::neglected_corners::NeglectedCorners;
use gearmesh::gear::mesh::{Loaded, Mesh, Settings};
use studygraph::warning::{Cases, Warning};

/// Ends a warning of a curve.
pub const REMEDY: &str = "set `corner_contact: exact`";

/// What its cases are about.
pub const ABOUT: &str = "corner contact";

/// The change of the peak-to-peak, relative to that with corner contact, from which it is reported. Methods of stiffness
/// differ by more from each other; and without reliefs the change grows as the root of the load, so that a limit of 0.1 %
/// would report every pair under any load.
const REPORTED: f64 = 0.02;
/// The same relative to the largest approach: below it a relief has made the peak-to-peak so small that contact laws matter more.
const OF_APPROACH: f64 = 1e-3;
/// A change \[m\] that is rounding: lengths on the path of contact are some millimetres.
const ROUNDED_M: f64 = 1e-15;
/// An estimate of the change that is this much smaller than [`REPORTED`] is not verified by a curve with corner contact.
const MARGIN: f64 = 0.5;

/// The corners that a curve leaves out, and about how much they matter.
#[derive(Clone, Copy, Debug)]
pub struct Estimated {
    /// Where they would touch.
    pub corners: NeglectedCorners,
    /// The change that is expected of the peak-to-peak, relative to it.
    pub change: f64,
}

impl Estimated {
    /// Of a curve; none where no corner touches.
    #[must_use]
    pub fn of(loading: &Loaded, points: &[Point], summary: &Summary) -> Option<Self> {
        let corners = loading.neglected_corners(summary.largest.value)?;
        let change = (summary.peak_to_peak / corners.peak_to_peak(points, loading.force()) - 1.0).abs();
        Some(Self { corners, change })
    }
}

/// A curve without corner contact.
#[derive(Clone, Copy, Debug)]
pub struct WithoutCorners<'a> {
    /// The design's name.
    pub name: &'a str,
    /// On the pinion \[N m\].
    pub torque: f64,
    /// Of the transmission error \[m\].
    pub peak_to_peak: f64,
    /// Of the transmission error \[m\].
    pub mean: f64,
    /// The corners that are left out.
    pub estimated: Estimated,
    /// The deviations of the load case, as they stand behind its torque; empty without any.
    pub deviations: &'a str,
}

impl<'a> WithoutCorners<'a> {
    /// The curve of a load case; none where it leaves no corner out.
    #[must_use]
    pub fn of(name: &'a str, torque: f64, loading: &Loaded) -> Option<Self> {
        let (points, summary) = loading.curve_and_summary(Wanted::default());
        let estimated = Estimated::of(loading, &points, &summary)?;
        Some(Self { name, torque, peak_to_peak: summary.peak_to_peak, mean: summary.mean, estimated, deviations: "" })
    }

    /// Whether a curve with corner contact is worth while.
    #[must_use]
    pub fn may_matter(&self) -> bool {
        self.estimated.change > MARGIN * REPORTED
    }

    /// The index of the one that corners are expected to change most, of those that they may matter to.
    #[must_use]
    pub fn worst(all: &[Option<Self>]) -> Option<usize> {
        let change = |index: &usize| all[*index].map_or(0.0, |one| one.estimated.change);
        let matters = (0..all.len()).filter(|index| all[*index].is_some_and(|one| one.may_matter()));
        matters.reduce(|worst, index| if change(&index) > change(&worst) { index } else { worst })
    }

    /// What the curve of the same load case with corner contact changes; none where that is little. `remedy` ends the sentence.
    #[must_use]
    pub fn compared(&self, loading: &Loaded, remedy: &str) -> Option<Warning> {
        self.error(loading, remedy).map(|(size, sentence)| self.warning(size, &sentence))
    }

    /// The warning of an error.
    #[must_use]
    pub fn warning(&self, size: f64, sentence: &str) -> Warning {
        let Self { name, torque, deviations, .. } = *self;
        let sentence = format!("design `{name}` at {torque} N m{deviations}: {sentence}");
        Warning::Cases(Cases::one(ABOUT, name, (torque, "N m"), (size, sentence)))
    }

    /// Relative error of the peak-to-peak, by the same load case with corner contact, and a sentence about it; none where it is small.
    #[must_use]
    pub fn error(&self, loading: &Loaded, remedy: &str) -> Option<(f64, String)> {
        let with = loading.summary_of(Needs { integrals: true, ..Needs::default() });
        let [before, after] = self.estimated.corners.lengths.map(|length| significant(in_unit(length, "mm"), 3));
        let touch = format!(
            "`corner_contact` is `none`, but the gears approach so far that tip corners touch up to {before} mm before A and \
             {after} mm after E"
        );
        if let Err(beyond) = loading.check_approach(with.largest.value) {
            let limit = significant(in_unit(beyond.largest.0, "mm"), 3);
            let sentence = format!(
                "{touch}; the size of the error is unknown, since `corner_contact: exact` holds up to an approach of {limit} \
                 mm only"
            );
            return Some((f64::INFINITY, sentence));
        }
        let peak_to_peak = with.largest.value - with.smallest.value;
        let change = (self.peak_to_peak - peak_to_peak).abs();
        if change <= REPORTED * peak_to_peak || change <= OF_APPROACH * with.largest.value || change <= ROUNDED_M {
            return None;
        }
        let compared = |quantity: &str, without: f64, with: f64| {
            let [shown, shown_with] = [without, with].map(|value| significant(in_unit(value, "um"), 4));
            format!(
                "the {quantity} is {shown} um without and {shown_with} um with corner contact, {}",
                apart(without, with)
            )
        };
        let sentence = format!(
            "{touch}; {}; {}; {remedy}",
            compared("peak-to-peak", self.peak_to_peak, peak_to_peak),
            compared("mean", self.mean, with.mean),
        );
        Some((change / peak_to_peak, sentence))
    }
}

/// The mesh cycle of the same inputs with corner contact; none where that is not modelled: a contact ratio too large for two
/// more pairs, with which corners matter little.
#[must_use]
pub fn cycle(inputs: &Inputs, settings: Settings) -> Option<Arc<Mesh>> {
    common::shared_mesh_cycle(inputs, Settings { corner_contact: CornerContact::Exact, ..settings }).ok()
}

/// By how much a value is too large or too small.
fn apart(value: f64, exact: f64) -> String {
    let percent = 100.0 * (value / exact - 1.0);
    if percent.abs() < 0.05 {
        return "the same to 0.1 %".to_owned();
    }
    let word = if percent < 0.0 { "small" } else { "large" };
    let digits = usize::from(percent.abs() < 9.95);
    format!("{:.digits$} % too {word}", percent.abs())
}
