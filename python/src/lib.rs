//! What Python loads as `gearstudy._gearstudy`; `gearstudy/` beside it is what a user imports.
//!
//! Kernels release the interpreter's lock. Nothing here waits for a lock that another thread may hold while it waits for
//! the interpreter, nor uses threads that a fork leaves behind. Must not know: formulas.

// Words of one call of Python, each an argument, as PyO3 hands them over.
#![allow(clippy::needless_pass_by_value, clippy::too_many_arguments)]
// Docstrings are Python's.
#![allow(clippy::doc_link_with_quotes)]

mod curve;
mod declarations;
mod design;
mod errors;
mod many;
mod pair;
mod search;
mod stiffness;
mod study;
mod tables;
mod values;
mod waiting;

use pyo3::prelude::*;
use pyo3::types::{PyAnyMethods, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};

use declare::error::Diagnostic;
use declare::units::TORQUE;
use gearstudy::cli;

use errors::refused;

/// Counts what a stage asks to be measured, and is the system's otherwise.
#[global_allocator]
static ALLOCATOR: cli::Allocator = cli::Allocator;

/// The largest torque that a study may state [N m].
const MOST_TORQUE: f64 = 1e9;

/// A torque, or several, in SI and within what a study may state.
fn torques(given: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let py = given.py();
    let several = if is_scalar(given)? { None } else { values::quantities(given, TORQUE, "torque")? };
    let is_one = several.is_none();
    let found = match several {
        Some(values) => values,
        None => vec![values::number(given, TORQUE, "torque")?],
    };
    if found.is_empty() {
        return Err(refused(py, &Diagnostic::new("`torque` is an empty array")));
    }
    match found.iter().position(|torque| !(0.0..=MOST_TORQUE).contains(torque)) {
        None => Ok(found),
        Some(index) => {
            let wrong = Diagnostic::new(format!("`torque` is {} N m", found[index])).help("it may be 0 to 1e9 N m");
            Err(if is_one { refused(py, &wrong) } else { errors::refused_at(py, index, &wrong) })
        }
    }
}

/// Whether something is one number.
fn is_scalar(given: &Bound<'_, PyAny>) -> PyResult<bool> {
    if given.is_instance_of::<PyFloat>() || given.is_instance_of::<PyInt>() || given.is_instance_of::<PyString>() {
        return Ok(true);
    }
    // Each element may have a unit of its own.
    if given.is_instance_of::<PyList>() || given.is_instance_of::<PyTuple>() {
        return Ok(false);
    }
    let magnitude = given.getattr_opt("magnitude")?;
    Ok(values::array(magnitude.as_ref().unwrap_or(given), "torque")?.is_none())
}

/// What pickle makes an object of again: a function of `gearstudy`, which calls its class with these values and words.
fn made_again<'py>(
    of: &Bound<'py, PyAny>,
    values: &[&Bound<'py, PyAny>],
    words: &Bound<'py, PyDict>,
) -> PyResult<Bound<'py, PyTuple>> {
    let py = of.py();
    let again = py.import("gearstudy._again")?.getattr("again")?;
    let values = PyTuple::new(py, values)?;
    let given = PyTuple::new(py, [of.get_type().as_any(), values.as_any(), words.as_any()])?;
    PyTuple::new(py, [again.as_any(), given.as_any()])
}

#[pymodule]
mod _gearstudy {
    #[pymodule_export]
    use super::curve::{TransmissionError, transmission_error};
    #[pymodule_export]
    use super::declarations::declarations;
    #[pymodule_export]
    use super::design::Design;
    #[pymodule_export]
    use super::many::{peak_to_peak, summaries};
    #[pymodule_export]
    use super::pair::{GearFacts, Pair};
    #[pymodule_export]
    use super::search::{Candidate, Optimizer};
    #[pymodule_export]
    use super::stiffness::Stiffness;
    #[pymodule_export]
    use super::study::{Study, command_line};
    #[pymodule_export]
    use super::tables::Table;

    use pyo3::prelude::*;

    #[pymodule_export]
    use super::waiting::_end;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        let py = module.py();
        // What cannot be loaded is told here, and not in the middle of a call.
        py.import("numpy")?;
        drop(numpy::PyArray1::<f64>::zeros(py, 0, false));
        py.import("atexit")?.call_method1("register", (module.getattr("_end")?,))?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
