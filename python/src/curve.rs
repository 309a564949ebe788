//! Transmission errors: one curve, or what many designs come to.
//!
//! Must not know: studies.

use std::sync::atomic::{AtomicBool, Ordering};

use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::ThreadPoolBuilder;
use rayon::prelude::*;

use declare::error::{Diagnostic, Failure};
use gearmesh::gear::transmission_error::curve::{Point, Summary, Wanted};
use gearmesh::gear::transmission_error::cycle::MeshCycle;
use gearmesh::gear::transmission_error::load_case::LoadCase;

use crate::design::Designs;
use crate::errors::{failed, refused, refused_at, run_failed};
use crate::stiffness::{Stiffness, settings};
use crate::{is_scalar, stopping, torques};

/// The most harmonics, as a study may state them.
const MOST_HARMONICS: usize = 200;
/// Designs that a thread takes at once.
const AT_ONCE: usize = 64;

/// A curve over one mesh cycle, and what it comes to. Arrays are made when they are asked for.
#[pyclass(frozen, module = "gearstudy._gearstudy")]
pub struct TransmissionError {
    points: Vec<Point>,
    summary: Summary,
}

type Floats<'py> = Bound<'py, PyArray1<f64>>;

impl TransmissionError {
    fn each<'py>(&self, py: Python<'py>, value: impl Fn(&Point) -> f64) -> Floats<'py> {
        self.points.iter().map(value).collect::<Vec<_>>().into_pyarray(py)
    }

    fn pressed<'py>(&self, py: Python<'py>, value: impl Fn(&Point) -> Option<f64>) -> Option<Floats<'py>> {
        let values: Option<Vec<f64>> = self.points.iter().map(value).collect();
        values.map(|values| values.into_pyarray(py))
    }
}

#[pymethods]
impl TransmissionError {
    fn __len__(&self) -> usize {
        self.points.len()
    }

    fn __repr__(&self) -> String {
        let Summary { peak_to_peak, mean, .. } = self.summary;
        format!("TransmissionError(points={}, peak_to_peak={peak_to_peak:e}, mean={mean:e})", self.points.len())
    }

    #[getter]
    fn cycle_position<'py>(&self, py: Python<'py>) -> Floats<'py> {
        self.each(py, |point| point.cycle_position)
    }

    #[getter]
    fn path_position<'py>(&self, py: Python<'py>) -> Floats<'py> {
        self.each(py, |point| point.path_position)
    }

    #[getter]
    fn roll_angle<'py>(&self, py: Python<'py>) -> Floats<'py> {
        self.each(py, |point| point.roll_angle)
    }

    #[getter]
    fn transmission_error<'py>(&self, py: Python<'py>) -> Floats<'py> {
        self.each(py, |point| point.transmission_error)
    }

    #[getter]
    fn unloaded_transmission_error<'py>(&self, py: Python<'py>) -> Floats<'py> {
        self.each(py, |point| point.unloaded_transmission_error)
    }

    #[getter]
    fn secant_stiffness<'py>(&self, py: Python<'py>) -> Floats<'py> {
        self.each(py, |point| point.secant_stiffness)
    }

    #[getter]
    fn tangent_stiffness<'py>(&self, py: Python<'py>) -> Floats<'py> {
        self.each(py, |point| point.tangent_stiffness)
    }

    #[getter]
    fn pairs<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        let pairs = self.points.iter().map(|point| i64::try_from(point.pairs).unwrap_or(i64::MAX));
        pairs.collect::<Vec<_>>().into_pyarray(py)
    }

    /// By point and pair.
    #[getter]
    fn loads<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let carried = |point: &Point| point.loads.iter().rposition(|load| *load > 0.0).map_or(0, |last| last + 1);
        let most = self.points.iter().map(carried).max().unwrap_or(0);
        let rows: Vec<Vec<f64>> = self.points.iter().map(|point| point.loads[..most].to_vec()).collect();
        PyArray2::from_vec2(py, &rows).map_err(|error| crate::errors::bug(&error.to_string()))
    }

    #[getter]
    fn pressure<'py>(&self, py: Python<'py>) -> Option<Floats<'py>> {
        self.pressed(py, |point| point.pressed.map(|pressed| pressed.largest))
    }

    #[getter]
    fn peak_to_peak(&self) -> f64 {
        self.summary.peak_to_peak
    }

    #[getter]
    fn mean(&self) -> f64 {
        self.summary.mean
    }

    #[getter]
    fn variance(&self) -> f64 {
        self.summary.variance
    }

    #[getter]
    fn harmonics<'py>(&self, py: Python<'py>) -> Floats<'py> {
        self.summary.harmonics.clone().into_pyarray(py)
    }

    #[getter]
    fn unloaded_peak_to_peak(&self) -> f64 {
        self.summary.unloaded_peak_to_peak
    }

    #[getter]
    fn loaded_contact_ratio(&self) -> f64 {
        self.summary.loaded_contact_ratio
    }

    #[getter]
    fn largest_load_share(&self) -> f64 {
        self.summary.largest_load_share
    }

    #[getter]
    fn largest_pressure(&self) -> Option<f64> {
        self.summary.largest_pressure.as_ref().map(|found| found.extremum.value)
    }
}

/// A design and a torque beyond what corner contact is modelled for.
fn beyond(loading: &LoadCase<'_>, approach: f64) -> String {
    format!(
        "the gears approach by {approach:e} m, but `corner_contact` of `exact` holds up to {:e} m only",
        loading.largest_approach()
    )
}

/// The curve of one design under one torque.
#[pyfunction]
#[pyo3(signature = (stiffness, torque, design = None, *, positions = 64, harmonics = 8, pressure = false, **cycle))]
pub fn transmission_error(
    py: Python<'_>,
    stiffness: &Bound<'_, Stiffness>,
    torque: &Bound<'_, PyAny>,
    design: Option<&Bound<'_, PyAny>>,
    positions: usize,
    harmonics: usize,
    pressure: bool,
    cycle: Option<&Bound<'_, PyDict>>,
) -> PyResult<TransmissionError> {
    let own = stiffness.get();
    let [torque] = torques(torque)?[..] else {
        let message = "a curve is that of one torque, and `torque` has several";
        return Err(refused(py, &Diagnostic::new(message).help("`peak_to_peak` and `summaries` take arrays")));
    };
    let wrong = |wrong: Diagnostic| refused(py, &wrong);
    let designs = Designs::read(design)?;
    if designs.count(None).map_err(wrong)?.is_some() {
        let message = "a curve is that of one design, and a modification has an array";
        return Err(wrong(Diagnostic::new(message).help("`peak_to_peak` and `summaries` take arrays")));
    }
    let settings = settings(py, cycle, positions)?;
    let wanted = wanted(py, harmonics, pressure)?;
    let design = designs.at(0, &own.of).map_err(wrong)?;
    let made = py.detach(|| {
        let cycle = own.cycle(settings)?;
        let loading = LoadCase::new(&cycle, &design, torque);
        let (points, summary) = loading.curve_and_summary(wanted);
        if !loading.holds(summary.largest.value) {
            return Err(Failure::new(beyond(&loading, summary.largest.value)));
        }
        Ok(TransmissionError { points, summary })
    });
    made.map_err(|failure| failed(py, &failure))
}

fn wanted(py: Python<'_>, harmonics: usize, pressure: bool) -> PyResult<Wanted> {
    if harmonics > MOST_HARMONICS {
        let message = format!("`harmonics` is {harmonics}");
        return Err(refused(py, &Diagnostic::new(message).help(format!("it may be 0 to {MOST_HARMONICS}"))));
    }
    Ok(Wanted { harmonics, pressure, root_stress: false })
}

/// Designs and torques of one call, as many as the longest array has elements.
struct Many {
    designs: Designs,
    torques: Vec<f64>,
    count: usize,
    is_single: bool,
}

impl Many {
    fn read(torque: &Bound<'_, PyAny>, design: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let py = torque.py();
        let designs = Designs::read(design)?;
        let single = is_scalar(torque)?;
        let torques = torques(torque)?;
        let count = designs.count((!single).then_some(torques.len())).map_err(|wrong| refused(py, &wrong))?;
        Ok(Self { designs, torques, count: count.unwrap_or(1), is_single: count.is_none() })
    }

    fn torque(&self, index: usize) -> f64 {
        if self.torques.len() == 1 { self.torques[0] } else { self.torques[index] }
    }

    /// What each comes to, in order, on so many threads; what does not fit is `invalid`, or ends it.
    fn each<T: Send + Clone>(
        &self,
        py: Python<'_>,
        stiffness: &Stiffness,
        cycle: &MeshCycle,
        threads: usize,
        invalid: Option<&(dyn Fn() -> T + Sync)>,
        of: impl Fn(&LoadCase<'_>) -> T + Sync,
    ) -> PyResult<Vec<T>> {
        let one = |index: usize| {
            let design = match (self.designs.at(index, &stiffness.of), invalid) {
                (Ok(design), _) => design,
                (Err(_), Some(invalid)) => return Ok(invalid()),
                (Err(wrong), None) => return Err((index, wrong)),
            };
            Ok(of(&LoadCase::new(cycle, &design, self.torque(index))))
        };
        let some = |stop: &AtomicBool, first: usize| {
            if stop.load(Ordering::Relaxed) {
                return Ok(Vec::new());
            }
            (first..self.count.min(first + AT_ONCE)).map(one).collect::<Result<Vec<T>, _>>()
        };
        let firsts: Vec<usize> = (0..self.count).step_by(AT_ONCE).collect();
        let found: Result<Vec<Vec<T>>, (usize, Diagnostic)> = match (firsts.len(), threads) {
            // Not long enough for anybody to interrupt it.
            (0 | 1, _) => py.detach(|| some(&AtomicBool::new(false), 0).map(|found| vec![found])),
            (_, 1) => stopping(py, |stop| firsts.iter().map(|first| some(stop, *first)).collect())?,
            // Of its own: those of everybody do not survive a fork.
            _ => {
                let pool = ThreadPoolBuilder::new().num_threads(threads).build();
                let pool = pool.map_err(|error| run_failed(py, &format!("cannot start threads: {error}")))?;
                stopping(py, |stop| pool.install(|| firsts.par_iter().map(|first| some(stop, *first)).collect()))?
            }
        };
        found
            .map(|found| found.concat())
            .map_err(|(index, wrong)| if self.is_single { refused(py, &wrong) } else { refused_at(py, index, &wrong) })
    }
}

/// What becomes of a design that does not fit.
fn is_kept(py: Python<'_>, invalid: &str) -> PyResult<bool> {
    match invalid {
        "raise" => Ok(false),
        "nan" => Ok(true),
        _ => Err(refused(py, &Diagnostic::new(format!("`invalid` is `{invalid}`")).help("it may be `raise` or `nan`"))),
    }
}

/// The peak-to-peak of one design, or of each of several.
#[pyfunction]
#[pyo3(signature = (stiffness, torque, design = None, *, positions = 64, threads = 1, invalid = "raise", **cycle))]
pub fn peak_to_peak<'py>(
    py: Python<'py>,
    stiffness: &Bound<'py, Stiffness>,
    torque: &Bound<'py, PyAny>,
    design: Option<&Bound<'py, PyAny>>,
    positions: usize,
    threads: usize,
    invalid: &str,
    cycle: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let many = Many::read(torque, design)?;
    let own = stiffness.get();
    let settings = settings(py, cycle, positions)?;
    let cycle = own.cycle(settings).map_err(|failure| failed(py, &failure))?;
    let none: &(dyn Fn() -> f64 + Sync) = &|| f64::NAN;
    let none = is_kept(py, invalid)?.then_some(none);
    #[allow(clippy::redundant_closure_for_method_calls)] // the method itself is that of one lifetime
    let found = many.each(py, own, &cycle, threads, none, |loading| loading.peak_to_peak())?;
    if many.is_single {
        return Ok(found.first().copied().unwrap_or(f64::NAN).into_pyobject(py)?.into_any());
    }
    Ok(found.into_pyarray(py).into_any())
}

/// What curves come to, an array for each number.
#[pyfunction]
#[pyo3(signature = (stiffness, torque, design = None, *, positions = 64, harmonics = 8, pressure = false, threads = 1, invalid = "raise", **cycle))]
pub fn summaries<'py>(
    py: Python<'py>,
    stiffness: &Bound<'py, Stiffness>,
    torque: &Bound<'py, PyAny>,
    design: Option<&Bound<'py, PyAny>>,
    positions: usize,
    harmonics: usize,
    pressure: bool,
    threads: usize,
    invalid: &str,
    cycle: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyDict>> {
    let many = Many::read(torque, design)?;
    let own = stiffness.get();
    let settings = settings(py, cycle, positions)?;
    let wanted = wanted(py, harmonics, pressure)?;
    let cycle = own.cycle(settings).map_err(|failure| failed(py, &failure))?;
    let none: &(dyn Fn() -> Option<Summary> + Sync) = &|| None;
    let none = is_kept(py, invalid)?.then_some(none);
    let found = many.each(py, own, &cycle, threads, none, |loading| {
        let summary = loading.summary(wanted);
        loading.holds(summary.largest.value).then_some(summary)
    })?;
    let all = PyDict::new(py);
    let column = |value: &dyn Fn(&Summary) -> f64| -> Bound<'py, PyArray1<f64>> {
        found.iter().map(|found| found.as_ref().map_or(f64::NAN, value)).collect::<Vec<_>>().into_pyarray(py)
    };
    all.set_item("peak_to_peak", column(&|summary| summary.peak_to_peak))?;
    all.set_item("mean", column(&|summary| summary.mean))?;
    all.set_item("variance", column(&|summary| summary.variance))?;
    all.set_item("unloaded_peak_to_peak", column(&|summary| summary.unloaded_peak_to_peak))?;
    all.set_item("loaded_contact_ratio", column(&|summary| summary.loaded_contact_ratio))?;
    all.set_item("largest_load_share", column(&|summary| summary.largest_load_share))?;
    if pressure {
        let largest =
            |summary: &Summary| summary.largest_pressure.as_ref().map_or(f64::NAN, |found| found.extremum.value);
        all.set_item("largest_pressure", column(&largest))?;
    }
    for order in 0..harmonics {
        all.set_item(format!("harmonic_{}", order + 1), column(&|summary| summary.harmonics[order]))?;
    }
    Ok(all)
}
