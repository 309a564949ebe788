//! `Optimizer`: the searches of `gearmesh::optimize`, asked for points and told their values.
//!
//! Must not know: gears, studies.

use std::sync::{Mutex, MutexGuard, TryLockError};

use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

use declare::error::{Diagnostic, suggest};
use declare::seed::Seed;
use gearmesh::optimize;
use gearmesh::optimize::bounds::Bounds;
use gearmesh::optimize::constraints::Evaluation;
use gearmesh::optimize::pareto::Member;
use gearmesh::optimize::search::Optimizer as Search;

use crate::errors::{failed, refused};
use crate::values;

/// A search of a box by one of the methods, with one objective or several: asked for points, told what they are worth.
///
/// Parameters
/// ----------
/// method : str or Search
///     A name of a method, or one with settings such as ``DifferentialEvolution(population=40)``.
/// bounds : sequence of (least, most)
///     One pair for each variable.
/// seed : int
///     Where random numbers start; the same seed asks for the same points.
///
/// Raises
/// ------
/// InvalidInput
///     Bounds or settings that make no sense.
///
/// >>> search = Optimizer("differential_evolution", [(-5, 5), (-5, 5)], seed=1)
/// >>> while not search.finished:
/// ...     points = search.ask()
/// ...     search.tell((points**2).sum(axis=1))
/// >>> search.best.value < 1e-3
/// True
#[pyclass(frozen, module = "gearstudy._gearstudy")]
pub struct Optimizer {
    search: Mutex<Search>,
    variables: usize,
}

/// The best point of a search; :attr:`Optimizer.best` has it.
///
/// >>> search = Optimizer("sobol", [(0, 1)])
/// >>> search.tell(search.ask()[:, 0])
/// >>> search.best.point.shape
/// (1,)
#[pyclass(frozen, module = "gearstudy._gearstudy")]
pub struct Candidate {
    point: Vec<f64>,
    /// The objective there; the first of several.
    #[pyo3(get)]
    value: f64,
    /// The sum of what constraints are below 0; 0 where all are kept.
    #[pyo3(get)]
    violation: f64,
}

#[pymethods]
impl Candidate {
    /// One value for each variable, shape (variables,).
    #[getter]
    fn point<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.point.clone().into_pyarray(py)
    }

    fn __repr__(&self) -> String {
        format!("Candidate(point={:?}, value={:e}, violation={:e})", self.point, self.value, self.violation)
    }
}

#[pymethods]
impl Optimizer {
    #[new]
    #[pyo3(signature = (method, bounds, *, seed = 0))]
    fn new(method: &Bound<'_, PyAny>, bounds: Vec<(f64, f64)>, seed: u64) -> PyResult<Self> {
        let py = method.py();
        let wrong = |wrong: Diagnostic| refused(py, &wrong);
        let (name, fields) = if let Ok(name) = method.cast::<PyString>() {
            (name.to_str()?.to_owned(), PyDict::new(py))
        } else {
            match values::declared(method)? {
                Some((Some(name), fields)) => (name, fields),
                _ => {
                    return Err(wrong(Diagnostic::new(
                        "`method` is no name of a method, nor one of `gearstudy.declared`",
                    )));
                }
            }
        };
        let names = || optimize::METHODS.iter().map(|method| method.member.name);
        let found = optimize::METHODS
            .iter()
            .find(|method| method.member.name == name)
            .ok_or_else(|| wrong(Diagnostic::new(format!("`method` is `{name}`")).help(suggest(&name, names()))))?;
        let record = values::record(found.member.fields, &fields, &format!("`{name}`"))?;
        (found.consistent)(&record).map_err(wrong)?;
        let variables = bounds.len();
        let bounds = Bounds::new(bounds).map_err(wrong)?;
        let method = (found.read)(&record);
        // As a stage of this name has it.
        let search = optimize::search(method.as_ref(), bounds, Seed::of_stage(seed, &name)).map_err(wrong)?;
        Ok(Self { search: Mutex::new(search), variables })
    }

    /// The points to evaluate next, shape (points, variables); no points when the search has ended. Asked again before they
    /// were told of, it gives the same.
    fn ask<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let search = self.held(py)?;
        let points = search.ask();
        if points.is_empty() {
            return Ok(PyArray2::zeros(py, [0, self.variables], false));
        }
        PyArray2::from_vec2(py, points).map_err(|error| crate::errors::bug(&error.to_string()))
    }

    /// Tells what the points that were asked for are worth.
    ///
    /// Parameters
    /// ----------
    /// values : array of shape (points,), or (points, objectives)
    ///     The less the better; NaN or infinity where there is no value.
    /// constraints : array of shape (points,), or (points, constraints), optional
    ///     Kept where they are not negative.
    ///
    /// Raises
    /// ------
    /// InvalidInput
    ///     Another shape.
    /// RunFailed
    ///     Another number of points than was asked for.
    #[pyo3(signature = (values, constraints = None))]
    fn tell(&self, py: Python<'_>, values: &Bound<'_, PyAny>, constraints: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let mut search = self.held(py)?;
        let rows = table(values, "values")?;
        let kept = constraints.map(|constraints| table(constraints, "constraints")).transpose()?;
        if kept.as_ref().is_some_and(|kept| kept.len() != rows.len()) {
            let message =
                format!("`constraints` has {} rows for {} values", kept.map_or(0, |kept| kept.len()), rows.len());
            return Err(refused(py, &Diagnostic::new(message).help("one row for each point is expected")));
        }
        let evaluation = |(index, row): (usize, &Vec<f64>)| Evaluation {
            constraints: kept.as_ref().map_or_else(Vec::new, |kept| kept[index].clone()),
            further: row[1..].to_vec(),
            ..Evaluation::from(row[0])
        };
        let told = rows.iter().enumerate().map(evaluation).collect();
        search.tell_constrained(told).map_err(|failure| failed(py, &failure))
    }

    /// Whether it has ended.
    #[getter]
    fn finished(&self, py: Python<'_>) -> PyResult<bool> {
        Ok(self.held(py)?.finished().is_some())
    }

    /// Why it has ended; None before.
    #[getter]
    fn reason(&self, py: Python<'_>) -> PyResult<Option<String>> {
        Ok(self.held(py)?.finished().map(|reason| reason.to_string()))
    }

    /// How many points it was told of.
    #[getter]
    fn evaluations(&self, py: Python<'_>) -> PyResult<usize> {
        Ok(self.held(py)?.evaluations())
    }

    /// The best point so far; None where none has a value.
    #[getter]
    fn best(&self, py: Python<'_>) -> PyResult<Option<Candidate>> {
        let found = self.held(py)?.best().cloned();
        Ok(found.map(|best| Candidate { point: best.point, value: best.value, violation: best.violation }))
    }

    /// Of several objectives: the points that no other one dominates, shape (points, variables), and their values, shape (points,
    /// objectives).
    #[getter]
    fn front<'py>(&self, py: Python<'py>) -> PyResult<[Bound<'py, PyArray2<f64>>; 2]> {
        let search = self.held(py)?;
        let (points, values): (Vec<Vec<f64>>, Vec<Vec<f64>>) =
            search.front(usize::MAX).into_iter().map(of_front).unzip();
        let array = |rows: &[Vec<f64>]| match rows {
            [] => Ok(PyArray2::zeros(py, [0, 0], false)),
            rows => PyArray2::from_vec2(py, rows).map_err(|error| crate::errors::bug(&error.to_string())),
        };
        Ok([array(&points)?, array(&values)?])
    }
}

impl Optimizer {
    /// The search, which one thread has at a time.
    fn held(&self, py: Python<'_>) -> PyResult<MutexGuard<'_, Search>> {
        match self.search.try_lock() {
            Ok(search) => Ok(search),
            Err(TryLockError::Poisoned(poisoned)) => Ok(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => {
                let message = "another thread is telling this search its values";
                Err(refused(py, &Diagnostic::new(message).help("a search is one thread's; make one for each")))
            }
        }
    }
}

/// The point of a member of a front, and the value of each objective.
fn of_front(Member { point, evaluation }: &Member) -> (Vec<f64>, Vec<f64>) {
    let values = [evaluation.value].into_iter().chain(evaluation.further.iter().copied());
    (point.clone(), values.collect())
}

/// Rows of numbers: one of each row for an array of one dimension.
fn table(given: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<Vec<f64>>> {
    let numpy = given.py().import("numpy")?;
    let array = numpy.call_method1("asarray", (given, "float64")).map_err(|_| {
        refused(given.py(), &Diagnostic::new(format!("`{name}` are no numbers")).help("an array is expected"))
    })?;
    match array.getattr("ndim")?.extract::<usize>()? {
        1 => Ok(array.extract::<Vec<f64>>()?.into_iter().map(|value| vec![value]).collect()),
        2 if array.getattr("shape")?.get_item(1)?.extract::<usize>()? > 0 => array.extract(),
        _ => {
            let message = format!("`{name}` has the shape {}", array.getattr("shape")?);
            Err(refused(given.py(), &Diagnostic::new(message).help("a number or a row of numbers for each point")))
        }
    }
}
