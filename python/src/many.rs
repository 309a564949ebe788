//! What the curves of many designs come to.
//!
//! Must not know: studies.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::ThreadPoolBuilder;
use rayon::prelude::*;

use declare::error::Diagnostic;
use gearmesh::gear::geometry::GearPair;
use gearmesh::gear::mesh::answers::curve::Summary;
use gearmesh::gear::mesh::answers::quantities::{Need, QUANTITIES};
use gearmesh::gear::mesh::{BeyondModel, Loaded, Mesh};

use crate::curve::{is_long, wanted};
use crate::design::Designs;
use crate::errors::{refused, refused_at, run_failed};
use crate::stiffness::Stiffness;
use crate::values;
use crate::waiting::abandoning;
use crate::{is_scalar, torques};

/// Designs that a thread takes at once.
const AT_ONCE: usize = 64;

/// Why there is no number for a design.
enum Missing {
    /// It does not fit the pair.
    Unfit(Diagnostic),
    /// It is loaded beyond the model.
    Beyond(BeyondModel),
}

impl Missing {
    /// Of the element of arrays that stands at an index, if there are any.
    fn exception(&self, py: Python<'_>, index: Option<usize>) -> PyErr {
        match (self, index) {
            (Self::Unfit(wrong), Some(index)) => refused_at(py, index, wrong),
            (Self::Unfit(wrong), None) => refused(py, wrong),
            (Self::Beyond(beyond), Some(index)) => run_failed(py, &format!("element {index}: {beyond}")),
            (Self::Beyond(beyond), None) => run_failed(py, &beyond.to_string()),
        }
    }
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

    /// What each comes to, in order, on so many threads; a design beyond the model or
    /// one that does not fit is none where it is kept, and ends it elsewhere.
    fn each<T: Send + Clone + 'static>(
        self,
        py: Python<'_>,
        pair: &Arc<GearPair>,
        cycle: Arc<Mesh>,
        threads: usize,
        keeps_invalid: bool,
        of: impl Fn(&Loaded<'_>) -> Result<T, BeyondModel> + Send + Sync + 'static,
    ) -> PyResult<Vec<Option<T>>> {
        let (is_single, count, pair) = (self.is_single, self.count, Arc::clone(pair));
        let is_short = count <= AT_ONCE && !is_long(cycle.settings, count);
        // A thread looks between chunks whether anybody still waits.
        let chunk = if is_long(cycle.settings, AT_ONCE) { 1 } else { AT_ONCE };
        let is_same = matches!(self.designs.count(None), Ok(None));
        let kept = move |index: usize, found: Result<T, Missing>| match found {
            Ok(found) => Ok(Some(found)),
            Err(_) if keeps_invalid => Ok(None),
            Err(missing) => Err((index, missing)),
        };
        let some = move |stop: &AtomicBool, first: usize| {
            if stop.load(Ordering::Relaxed) {
                return Ok(Vec::new());
            }
            let indices = first..count.min(first + chunk);
            let built = |index: usize| self.designs.at(index, &pair).map_err(Missing::Unfit);
            let answer = |loading: &Loaded<'_>| of(loading).map_err(Missing::Beyond);
            if is_same && let Ok(design) = built(first) {
                // The gaps of the flanks are found once for all torques.
                let mut meshed = cycle.design(&design);
                return indices.map(|index| kept(index, answer(&meshed.under(self.torque(index))))).collect();
            }
            let alone = |index: usize| {
                let design = built(index)?;
                answer(&cycle.loaded(&design, self.torque(index)))
            };
            indices.map(|index| kept(index, alone(index))).collect::<Result<Vec<_>, _>>()
        };
        let firsts: Vec<usize> = (0..count).step_by(chunk).collect();
        let found: Result<Vec<Vec<Option<T>>>, (usize, Missing)> = if is_short {
            py.detach(|| firsts.iter().map(|first| some(&AtomicBool::new(false), *first)).collect())
        } else if threads == 1 {
            abandoning(py, move |left| firsts.iter().map(|first| some(left, *first)).collect())?
        } else {
            // Of its own: those of everybody do not survive a fork.
            let pool = ThreadPoolBuilder::new().num_threads(threads).build();
            let pool = pool.map_err(|error| run_failed(py, &format!("cannot start threads: {error}")))?;
            abandoning(py, move |left| pool.install(|| firsts.par_iter().map(|first| some(left, *first)).collect()))?
        };
        found
            .map(|found| found.concat())
            .map_err(|(index, missing)| missing.exception(py, (!is_single).then_some(index)))
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

/// The peak-to-peak transmission error [m] of one design under one torque, or of each of many.
///
/// Parameters
/// ----------
/// stiffness : Stiffness
///     Of the pair.
/// torque : number [N m], or an array of shape (designs,)
///     On the pinion. 0 to 1e9 N m.
/// design : Design, modification, sequence of modifications, optional
///     With arrays of shape (designs,) in any of its numbers; unmodified teeth without it.
/// positions : int
///     Of the cycle, evenly spread. 8 to 100,000.
/// threads : int
///     On which designs are spread; 0 for as many as the machine has. They change no bit of any number.
/// invalid : "raise" or "nan"
///     What becomes of a design that does not fit the pair, or is loaded beyond the model.
/// slices, corner_contact, slice_coupling
///     As :func:`transmission_error` has them, but no warning reports what ``corner_contact="none"`` changes.
///
/// Returns
/// -------
/// float, or an array of shape (designs,) where anything was given as an array.
///
/// Raises
/// ------
/// InvalidInput
///     What makes no sense, and which element of an array it is; arrays of different lengths.
/// RunFailed
///     Where the gears approach farther than corner contact is modelled for.
/// KeyboardInterrupt
///     Ctrl-C.
///
/// >>> import numpy as np
/// >>> amounts = np.array([0.0, 7e-6, 14e-6])
/// >>> found = peak_to_peak(stiffness, 150.0, TipRelief(gear="both", amount=amounts, fraction=0.8))
/// >>> found.shape
/// (3,)
/// >>> bool(found[0] == peak_to_peak(stiffness, 150.0))
/// True
#[pyfunction]
#[pyo3(signature = (stiffness, torque, design = None, *, positions = 64, threads = 1, invalid = "raise", **cycle))]
pub fn peak_to_peak<'py>(
    py: Python<'py>,
    stiffness: &Bound<'py, Stiffness>,
    torque: &Bound<'py, PyAny>,
    design: Option<&Bound<'py, PyAny>>,
    #[pyo3(from_py_with = values::count)] positions: usize,
    #[pyo3(from_py_with = values::count)] threads: usize,
    invalid: &str,
    cycle: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let many = Many::read(torque, design)?;
    let own = stiffness.get();
    let cycle = own.asked(py, cycle, positions)?;
    let is_single = many.is_single;
    // The path of the method would have one lifetime only.
    #[allow(clippy::redundant_closure_for_method_calls)]
    let found =
        many.each(py, &own.of, cycle, threads, is_kept(py, invalid)?, |loading| loading.checked_peak_to_peak())?;
    let found: Vec<f64> = found.into_iter().map(|found| found.unwrap_or(f64::NAN)).collect();
    match found[..] {
        [found] if is_single => Ok(found.into_pyobject(py)?.into_any()),
        _ => Ok(found.into_pyarray(py).into_any()),
    }
}

/// What the transmission errors of many designs come to.
///
/// Parameters are those of :func:`peak_to_peak`, with ``harmonics`` and ``pressure`` of :func:`transmission_error`.
///
/// Returns
/// -------
/// dict from name to an array of shape (designs,), in SI units: the numbers of a curve that the table ``summary`` of the stage ``ste``
/// has, by its names, those of pressure with ``pressure`` only; and ``harmonic_1`` on in metres. With ``invalid="nan"`` a design that
/// does not fit, or approaches farther than corner contact is modelled for, has NaN throughout.
///
/// >>> found = summaries(stiffness, [100.0, 150.0], relief, harmonics=1)
/// >>> sorted(found)[:3]
/// ['harmonic_1', 'largest_load_share', 'loaded_contact_ratio']
/// >>> bool(found["mean"][0] < found["mean"][1])
/// True
#[pyfunction]
#[pyo3(signature = (stiffness, torque, design = None, *, positions = 64, harmonics = 8, pressure = false, threads = 1, invalid = "raise", **cycle))]
pub fn summaries<'py>(
    py: Python<'py>,
    stiffness: &Bound<'py, Stiffness>,
    torque: &Bound<'py, PyAny>,
    design: Option<&Bound<'py, PyAny>>,
    #[pyo3(from_py_with = values::count)] positions: usize,
    #[pyo3(from_py_with = values::count)] harmonics: usize,
    pressure: bool,
    #[pyo3(from_py_with = values::count)] threads: usize,
    invalid: &str,
    cycle: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyDict>> {
    let many = Many::read(torque, design)?;
    let own = stiffness.get();
    let cycle = own.asked(py, cycle, positions)?;
    let wanted = wanted(py, harmonics, pressure)?;
    let found = many.each(py, &own.of, cycle, threads, is_kept(py, invalid)?, move |loading| {
        let summary = loading.summary(wanted);
        loading.check_approach(summary.largest.value).map(|()| summary)
    })?;
    let all = PyDict::new(py);
    let column = |value: &dyn Fn(&Summary) -> f64| -> Bound<'py, PyArray1<f64>> {
        found.iter().map(|found| found.as_ref().map_or(f64::NAN, value)).collect::<Vec<_>>().into_pyarray(py)
    };
    let of_curve = QUANTITIES.iter().filter(|quantity| match quantity.need {
        Need::Pressure => pressure,
        Need::RootStress => false,
        _ => true,
    });
    for quantity in of_curve {
        all.set_item(quantity.name, column(&quantity.get))?;
    }
    for order in 0..harmonics {
        all.set_item(format!("harmonic_{}", order + 1), column(&|summary| summary.harmonics[order]))?;
    }
    Ok(all)
}
