//! The curve of one design under one torque.
//!
//! Must not know: studies.

use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::ffi::CString;

use declare::error::{Diagnostic, Failure};
use gearmesh::gear::contact::{CornerContact, SliceCoupling};
use gearmesh::gear::mesh::Settings;
use gearmesh::gear::mesh::answers::curve::{Point, Summary, Wanted};
use gearmesh::gear::modification::Design;
use gearstudy::stage::neglected_corners::{Estimated, WithoutCorners};

use crate::design::Designs;
use crate::errors::{failed, refused};
use crate::stiffness::Stiffness;
use crate::torques;
use crate::values;
use crate::waiting::abandoning;

/// Positions times slices from which on a thread of its own is worth while: some milliseconds.
const LONG: usize = 200_000;
/// The most harmonics, as a study may state them.
const MOST_HARMONICS: usize = 200;

/// A curve over one mesh cycle, and what it comes to; :func:`transmission_error` makes it.
///
/// Numbers of the whole cycle are there unless the call said ``summary=False``; asking for one then raises InvalidInput.
/// Arrays of a curve have shape (points,), in the order of positions. There are as many points as :func:`len` says: those that
/// were asked for and, on either side of each place where contact begins or ends, two more, and with a summary the extrema. An array is made when it is asked
/// for.
///
/// >>> curve = transmission_error(stiffness, 150.0, relief)
/// >>> curve.transmission_error.shape == curve.cycle_position.shape == (len(curve),)
/// True
/// >>> ptp = curve.transmission_error.max() - curve.transmission_error.min()
/// >>> bool(abs(curve.peak_to_peak / ptp - 1) < 0.01)
/// True
#[pyclass(frozen, module = "gearstudy._gearstudy")]
pub struct TransmissionError {
    points: Vec<Point>,
    /// None where the call did without.
    summary: Option<Summary>,
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

    fn summary(&self, py: Python<'_>) -> PyResult<&Summary> {
        let none = || Diagnostic::new("this curve has no summary, since its call said `summary=False`");
        self.summary.as_ref().ok_or_else(|| refused(py, &none().help("a call without that word finds it")))
    }
}

#[pymethods]
impl TransmissionError {
    fn __len__(&self) -> usize {
        self.points.len()
    }

    fn __repr__(&self) -> String {
        let found = self.summary.as_ref().map_or_else(String::new, |Summary { peak_to_peak, mean, .. }| {
            format!(", peak_to_peak={peak_to_peak:e}, mean={mean:e}")
        });
        format!("TransmissionError(points={}{found})", self.points.len())
    }

    /// Position in the mesh cycle along the line of action [m], from 0, shape (points,).
    #[getter]
    fn cycle_position<'py>(&self, py: Python<'py>) -> Floats<'py> {
        self.each(py, |point| point.cycle_position)
    }

    /// Contact of the leading pair along the line of action, from the point T1 where it touches the base circle of the pinion [m],
    /// shape (points,).
    #[getter]
    fn path_position<'py>(&self, py: Python<'py>) -> Floats<'py> {
        self.each(py, |point| point.path_position)
    }

    /// Roll angle of the pinion at the contact of the leading pair [rad], shape (points,).
    #[getter]
    fn roll_angle<'py>(&self, py: Python<'py>) -> Floats<'py> {
        self.each(py, |point| point.roll_angle)
    }

    /// TE under load along the line of action [m], positive where the gear lags, shape (points,).
    #[getter]
    fn transmission_error<'py>(&self, py: Python<'py>) -> Floats<'py> {
        self.each(py, |point| point.transmission_error)
    }

    /// TE without load along the line of action [m]: what the modifications alone make, shape (points,).
    #[getter]
    fn unloaded_transmission_error<'py>(&self, py: Python<'py>) -> Floats<'py> {
        self.each(py, |point| point.unloaded_transmission_error)
    }

    /// Normal force over the approach of the gears [N/m], shape (points,).
    #[getter]
    fn secant_stiffness<'py>(&self, py: Python<'py>) -> Floats<'py> {
        self.each(py, |point| point.secant_stiffness)
    }

    /// Change of the normal force with the approach of the gears [N/m], shape (points,).
    #[getter]
    fn tangent_stiffness<'py>(&self, py: Python<'py>) -> Floats<'py> {
        self.each(py, |point| point.tangent_stiffness)
    }

    /// How many pairs of teeth carry load, shape (points,), integers.
    #[getter]
    fn pairs<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        let pairs = self.points.iter().map(|point| i64::try_from(point.pairs).unwrap_or(i64::MAX));
        pairs.collect::<Vec<_>>().into_pyarray(py)
    }

    /// Normal force of each pair of teeth in contact [N], shape (points, pairs), 0 where one carries none.
    #[getter]
    fn loads<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let carried = |point: &Point| point.loads.iter().rposition(|load| *load > 0.0).map_or(0, |last| last + 1);
        let most = self.points.iter().map(carried).max().unwrap_or(0);
        let rows: Vec<Vec<f64>> = self.points.iter().map(|point| point.loads[..most].to_vec()).collect();
        PyArray2::from_vec2(py, &rows).map_err(|error| crate::errors::bug(&error.to_string()))
    }

    /// Largest Hertzian pressure of any contact [Pa], shape (points,); None unless the call said ``pressure=True``.
    #[getter]
    fn pressure<'py>(&self, py: Python<'py>) -> Option<Floats<'py>> {
        self.pressed(py, |point| point.pressed.map(|pressed| pressed.largest))
    }

    /// Largest less least transmission error of the cycle [m], found between points too.
    #[getter]
    fn peak_to_peak(&self, py: Python<'_>) -> PyResult<f64> {
        self.summary(py).map(|found| found.peak_to_peak)
    }

    /// Mean of the transmission error over the cycle [m].
    #[getter]
    fn mean(&self, py: Python<'_>) -> PyResult<f64> {
        self.summary(py).map(|found| found.mean)
    }

    /// Mean square deviation of the transmission error from its mean over the cycle [m^2].
    #[getter]
    fn variance(&self, py: Python<'_>) -> PyResult<f64> {
        self.summary(py).map(|found| found.variance)
    }

    /// Amplitudes of the mesh harmonics of the transmission error [m], the first first, shape (harmonics,).
    #[getter]
    fn harmonics<'py>(&self, py: Python<'py>) -> PyResult<Floats<'py>> {
        self.summary(py).map(|found| found.harmonics.clone().into_pyarray(py))
    }

    /// Largest less least transmission error without load [m].
    #[getter]
    fn unloaded_peak_to_peak(&self, py: Python<'_>) -> PyResult<f64> {
        self.summary(py).map(|found| found.unloaded_peak_to_peak)
    }

    /// Share of the cycle, summed over the pairs, in which a pair carries load; the contact ratio under load.
    #[getter]
    fn loaded_contact_ratio(&self, py: Python<'_>) -> PyResult<f64> {
        self.summary(py).map(|found| found.loaded_contact_ratio)
    }

    /// Largest share of the normal force on one pair, up to 1.
    #[getter]
    fn largest_load_share(&self, py: Python<'_>) -> PyResult<f64> {
        self.summary(py).map(|found| found.largest_load_share)
    }

    /// Largest Hertzian pressure of the cycle [Pa]; None unless the call said ``pressure=True``.
    #[getter]
    fn largest_pressure(&self, py: Python<'_>) -> PyResult<Option<f64>> {
        self.summary(py).map(|found| found.largest_pressure.as_ref().map(|found| found.extremum.value))
    }
}

/// The transmission error of one design under one torque over a mesh cycle.
///
/// Parameters
/// ----------
/// stiffness : Stiffness
///     Of the pair.
/// torque : number [N m]
///     On the pinion. 0 to 1e9 N m.
/// design : Design, modification, sequence of modifications, optional
///     Unmodified teeth without it.
/// positions : int
///     Of the cycle, evenly spread. 8 to 100,000.
/// harmonics : int
///     How many mesh harmonics. 0 to 200.
/// pressure : bool
///     Whether Hertzian pressures are found.
/// summary : bool
///     Whether extrema between positions, means and harmonics are found; they take about half of the time.
/// slices : int
///     Across the face, where modifications vary along it and nothing is known in closed form; 17 without it.
/// corner_contact : "none" or "exact"
///     Whether teeth touch before and beyond the path of contact too, with the corners of their tips; "none" without it. Where
///     that changes the peak-to-peak by more than 2 %, a UserWarning says by how much, but with ``summary=False``.
/// slice_coupling : "none" or "plate"
///     Whether slices support one another, as the tooth of a plate does; "none" without it. These three are fields of a study's
///     ``ste`` too.
///
/// Raises
/// ------
/// InvalidInput
///     What makes no sense or does not fit the pair; arrays, which :func:`peak_to_peak` and :func:`summaries` take.
/// RunFailed
///     Where the gears approach farther than corner contact is modelled for.
///
/// >>> curve = transmission_error(stiffness, 150.0, relief, harmonics=3)
/// >>> curve.harmonics.shape
/// (3,)
/// >>> bool(1e-6 < curve.mean < 100e-6)
/// True
#[pyfunction]
#[pyo3(signature = (stiffness, torque, design = None, *, positions = 64, harmonics = 8, pressure = false, summary = true, **cycle))]
pub fn transmission_error(
    py: Python<'_>,
    stiffness: &Bound<'_, Stiffness>,
    torque: &Bound<'_, PyAny>,
    design: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = values::count)] positions: usize,
    #[pyo3(from_py_with = values::count)] harmonics: usize,
    pressure: bool,
    summary: bool,
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
    let cycle = own.asked(py, cycle, positions)?;
    let wanted = wanted(py, harmonics, pressure)?;
    let design = designs.at(0, &own.of).map_err(wrong)?;
    let settings = cycle.settings;
    let is_long = is_long(settings, 1);
    let own_design = design.clone();
    let make = move || {
        let loading = cycle.loaded(&design, torque);
        let mut without = None;
        let (points, summary, largest) = if summary {
            let (points, summary) = loading.curve_and_summary(wanted);
            let largest = summary.largest.value;
            let (peak_to_peak, mean) = (summary.peak_to_peak, summary.mean);
            without = Estimated::of(&loading, &points, &summary).map(|estimated| WithoutCorners {
                name: "",
                torque,
                peak_to_peak,
                mean,
                estimated,
                deviations: "",
            });
            (points, Some(summary), largest)
        } else {
            let points = loading.curve(wanted);
            let largest = points.iter().map(|point| point.transmission_error).fold(f64::NEG_INFINITY, f64::max);
            (points, None, largest)
        };
        loading.check_approach(largest).map_err(|beyond| Failure::new(beyond.to_string()))?;
        Ok((TransmissionError { points, summary }, without))
    };
    let made = if is_long { abandoning(py, move |_| make())? } else { py.detach(make) };
    let (curve, without) = made.map_err(|failure| failed(py, &failure))?;
    if let Some(without) = without.filter(WithoutCorners::may_matter) {
        warn_of_corners(py, own, settings, (&own_design, torque), &without)?;
    }
    Ok(curve)
}

/// Warns of the error by `corner_contact` of `none`, as a study does.
///
/// # Errors
/// The warning, where the caller has made it an exception.
fn warn_of_corners(
    py: Python<'_>,
    stiffness: &Stiffness,
    settings: Settings,
    (design, torque): (&Design, f64),
    without: &WithoutCorners<'_>,
) -> PyResult<()> {
    // Not modelled for contact ratios that are too large for two more pairs; corners matter little there.
    let Ok(cycle) = stiffness.cycle(Settings { corner_contact: CornerContact::Exact, ..settings }) else {
        return Ok(());
    };
    let error = py.detach(|| without.error(&cycle.loaded(design, torque), "pass `corner_contact=\"exact\"`"));
    let Some((_, sentence)) = error else { return Ok(()) };
    // No sentence has a zero byte.
    let sentence = CString::new(sentence)?;
    PyErr::warn(py, &py.get_type::<PyUserWarning>(), &sentence, 1)
}

/// Whether so many curves take longer than anybody waits for without the wish to interrupt them.
pub fn is_long(settings: Settings, curves: usize) -> bool {
    // Slices that hold each other are a problem for each position.
    let each = if settings.slice_coupling == SliceCoupling::None { 1 } else { settings.slices };
    curves.saturating_mul(settings.positions).saturating_mul(settings.slices).saturating_mul(each) > LONG
}

/// What a curve comes to, as the words of a call say.
///
/// # Errors
/// More harmonics than a study may state.
pub fn wanted(py: Python<'_>, harmonics: usize, pressure: bool) -> PyResult<Wanted> {
    if harmonics > MOST_HARMONICS {
        let message = format!("`harmonics` is {harmonics}");
        return Err(refused(py, &Diagnostic::new(message).help(format!("it may be 0 to {MOST_HARMONICS}"))));
    }
    Ok(Wanted { harmonics, pressure, root_stress: false })
}
