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

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use pyo3::prelude::*;
use pyo3::types::{PyAnyMethods, PyDict, PyFloat, PyInt, PyTuple};

use declare::error::Diagnostic;
use declare::units::TORQUE;
use gearstudy::cli;

use errors::refused;

/// Counts what a stage asks to be measured, and is the system's otherwise.
#[global_allocator]
static ALLOCATOR: cli::Allocator = cli::Allocator;

/// How long a signal waits, at most, until what runs is told of it.
const SIGNALS: Duration = Duration::from_millis(20);
/// The largest torque that a study may state [N m].
const MOST_TORQUE: f64 = 1e9;

/// Does something that takes long, on a thread of its own; a signal of Python stops it.
///
/// # Errors
/// What the signal raises.
pub fn stopping<T: Send>(py: Python<'_>, work: impl FnOnce(&AtomicBool) -> T + Send) -> PyResult<T> {
    let stop = AtomicBool::new(false);
    thread::scope(|scope| {
        let (tell, told) = mpsc::channel();
        // What waits without the interpreter's lock has it to itself.
        let told = Mutex::new(told);
        let stop = &stop;
        let spawned = thread::Builder::new().name("gearstudy".to_owned()).spawn_scoped(scope, move || {
            let _ = tell.send(catch_unwind(AssertUnwindSafe(|| work(stop))));
        });
        spawned.map_err(|error| errors::run_failed(py, &format!("cannot start a thread: {error}")))?;
        let mut raised = None;
        let done = loop {
            let waited = || told.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(SIGNALS);
            match py.detach(waited) {
                Ok(done) => break done,
                Err(RecvTimeoutError::Timeout) => {
                    if let Err(signal) = py.check_signals() {
                        stop.store(true, Ordering::Relaxed);
                        raised.get_or_insert(signal);
                    }
                }
                Err(RecvTimeoutError::Disconnected) => return Err(errors::bug("a thread ended without a word")),
            }
        };
        match (raised, done) {
            (Some(raised), _) => Err(raised),
            (None, Ok(done)) => Ok(done),
            (None, Err(panic)) => {
                let words =
                    panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
                Err(errors::bug(words.unwrap_or("a panic")))
            }
        }
    })
}

/// A torque, or several, in SI and within what a study may state.
fn torques(given: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let py = given.py();
    let several = if is_scalar(given)? { None } else { values::array(given, "torque")? };
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
    if given.is_instance_of::<PyFloat>() || given.is_instance_of::<PyInt>() {
        return Ok(true);
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

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
