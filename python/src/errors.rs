//! What went wrong, as the exceptions of `gearstudy.errors`.
//!
//! Must not know: what anybody was about.

use pyo3::exceptions::{PyException, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use declare::error::{Diagnostic, Failure, Place};
use studygraph::study::LoadError;

/// An exception of this name, with what it has beside its sentence.
fn exception(
    py: Python<'_>,
    name: &str,
    message: &str,
    told: impl FnOnce(&Bound<'_, PyDict>) -> PyResult<()>,
) -> PyErr {
    let made = || -> PyResult<Bound<'_, PyAny>> {
        let beside = PyDict::new(py);
        told(&beside)?;
        py.import("gearstudy.errors")?.getattr(name)?.call((message,), Some(&beside))
    };
    made().map_or_else(|failed| failed, PyErr::from_value)
}

fn placed(of: &Bound<'_, PyDict>, file: Option<&str>, place: Option<Place>) -> PyResult<()> {
    of.set_item("file", file)?;
    of.set_item("line", place.map(|place| place.line))?;
    of.set_item("column", place.map(|place| place.column))
}

/// What somebody stated is wrong.
pub fn refused(py: Python<'_>, wrong: &Diagnostic) -> PyErr {
    exception(py, "InvalidInput", &wrong.message, |beside| beside.set_item("help", wrong.help.as_deref()))
}

/// The same of the element of arrays that stands at `index`.
pub fn refused_at(py: Python<'_>, index: usize, wrong: &Diagnostic) -> PyErr {
    let message = format!("element {index}: {}", wrong.message);
    exception(py, "InvalidInput", &message, |beside| beside.set_item("help", wrong.help.as_deref()))
}

/// What is wrong with a study: the first mistake, and all of them as a list.
pub fn invalid_study(py: Python<'_>, error: &LoadError) -> PyErr {
    let file = error.path.to_string_lossy();
    let all = || {
        error.each().map(|wrong| {
            let beside = PyDict::new(py);
            beside.set_item("message", &wrong.message)?;
            beside.set_item("help", wrong.help.as_deref())?;
            placed(&beside, Some(&file), wrong.place)?;
            Ok(beside)
        })
    };
    exception(py, "InvalidStudy", &error.diagnostic.message, |beside| {
        beside.set_item("help", error.diagnostic.help.as_deref())?;
        placed(beside, Some(&file), error.diagnostic.place)?;
        beside.set_item("mistakes", all().collect::<PyResult<Vec<_>>>()?)
    })
}

/// Something that was stated soundly cannot be computed.
pub fn failed(py: Python<'_>, failure: &Failure) -> PyErr {
    if matches!(failure, Failure::Stopped) {
        return PyErr::new::<pyo3::exceptions::PyKeyboardInterrupt, _>(());
    }
    run_failed(py, &failure.to_string())
}

/// The same in other words.
pub fn run_failed(py: Python<'_>, message: &str) -> PyErr {
    exception(py, "RunFailed", message, |_| Ok(()))
}

/// What is said of something that Python could not make sense of; a signal, or the end of the interpreter, stays what it is.
pub fn unless_stopped(py: Python<'_>, raised: PyErr, otherwise: impl FnOnce() -> PyErr) -> PyErr {
    if raised.is_instance_of::<PyException>(py) { otherwise() } else { raised }
}

/// A mistake of this program, never the user's.
pub fn bug(message: &str) -> PyErr {
    PyRuntimeError::new_err(format!("this is a bug of gearstudy; please report it: {message}"))
}
