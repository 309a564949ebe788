//! `Optimizer`: the searches of `gearmesh::optimize`, asked for points and told their values.
//!
//! Must not know: gears, studies.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, TryLockError};

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
use crate::waiting::outcome;

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
    name: &'static str,
    finds_fronts: bool,
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
    fn new(method: &Bound<'_, PyAny>, bounds: &Bound<'_, PyAny>, seed: u64) -> PyResult<Self> {
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
        let bounds = pairs(bounds)?;
        let variables = bounds.len();
        let bounds = Bounds::new(bounds).map_err(wrong)?;
        let method = (found.read)(&record);
        let finds_fronts = method.finds_fronts();
        // As a stage of this name has it.
        let search = optimize::search(method.as_ref(), bounds, Seed::of_stage(seed, &name)).map_err(wrong)?;
        Ok(Self { search: Mutex::new(search), variables, name: found.member.name, finds_fronts })
    }

    /// The points to evaluate next, shape (points, variables); no points when the search has ended. Asked again before they
    /// were told of, it gives the same.
    fn ask<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let points = self.with(py, |search| search.ask().to_vec())?;
        if points.is_empty() {
            return Ok(PyArray2::zeros(py, [0, self.variables], false));
        }
        PyArray2::from_vec2(py, &points).map_err(|error| crate::errors::bug(&error.to_string()))
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
        let rows = table(values, "values")?;
        if rows.first().is_some_and(|row| row.len() > 1) && !self.finds_fronts {
            let message = format!("`values` has {} objectives, and `{}` minimises one", rows[0].len(), self.name);
            return Err(refused(py, &Diagnostic::new(message).help("`nsga2` and samples take several")));
        }
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
        self.with(py, |search| search.tell_constrained(told))?.map_err(|failure| failed(py, &failure))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let evaluations = self.evaluations(py)?;
        Ok(format!("Optimizer({:?}, variables={}, evaluations={evaluations})", self.name, self.variables))
    }

    /// Whether it has ended.
    #[getter]
    fn finished(&self, py: Python<'_>) -> PyResult<bool> {
        self.with(py, |search| search.finished().is_some())
    }

    /// Why it has ended; None before.
    #[getter]
    fn reason(&self, py: Python<'_>) -> PyResult<Option<String>> {
        self.with(py, |search| search.finished().map(|reason| reason.to_string()))
    }

    /// How many points it was told of.
    #[getter]
    fn evaluations(&self, py: Python<'_>) -> PyResult<usize> {
        self.with(py, |search| search.evaluations())
    }

    /// The best point so far; None where none has a value.
    #[getter]
    fn best(&self, py: Python<'_>) -> PyResult<Option<Candidate>> {
        let found = self.with(py, |search| search.best().cloned())?;
        Ok(found.map(|best| Candidate { point: best.point, value: best.value, violation: best.violation }))
    }

    /// Of several objectives: the points that no other one dominates, shape (points, variables), and their values, shape (points,
    /// objectives).
    #[getter]
    fn front<'py>(&self, py: Python<'py>) -> PyResult<[Bound<'py, PyArray2<f64>>; 2]> {
        let front = |search: &mut Search| search.front(usize::MAX).into_iter().map(of_front).unzip();
        let (points, values): (Vec<Vec<f64>>, Vec<Vec<f64>>) = self.with(py, front)?;
        let array = |rows: &[Vec<f64>]| match rows {
            [] => Ok(PyArray2::zeros(py, [0, 0], false)),
            rows => PyArray2::from_vec2(py, rows).map_err(|error| crate::errors::bug(&error.to_string())),
        };
        Ok([array(&points)?, array(&values)?])
    }
}

impl Optimizer {
    /// Does something with the search, which one thread has at a time, while other threads have the interpreter.
    fn with<T: Send>(&self, py: Python<'_>, work: impl FnOnce(&mut Search) -> T + Send) -> PyResult<T> {
        let done = py.detach(|| {
            let mut search = match self.search.try_lock() {
                Ok(search) => search,
                Err(TryLockError::Poisoned(poisoned)) => poisoned.into_inner(),
                Err(TryLockError::WouldBlock) => return None,
            };
            Some(catch_unwind(AssertUnwindSafe(|| work(&mut search))))
        });
        let Some(done) = done else {
            let message = "another thread is telling this search its values";
            return Err(refused(py, &Diagnostic::new(message).help("a search is one thread's; make one for each")));
        };
        outcome(done)
    }
}

/// The point of a member of a front, and the value of each objective.
fn of_front(Member { point, evaluation }: &Member) -> (Vec<f64>, Vec<f64>) {
    let values = [evaluation.value].into_iter().chain(evaluation.further.iter().copied());
    (point.clone(), values.collect())
}

/// Rows of numbers: one of each row for an array of one dimension.
fn table(given: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<Vec<f64>>> {
    let py = given.py();
    let (array, kind, shape) = values::numpy_array(given, name)?;
    let is_number = matches!(kind.as_str(), "f" | "i" | "u") || shape.contains(&0);
    let floats = || array.call_method1("astype", ("float64",));
    match shape[..] {
        [_] if is_number => Ok(floats()?.extract::<Vec<f64>>()?.into_iter().map(|value| vec![value]).collect()),
        [_, columns] if is_number && columns > 0 => floats()?.extract(),
        _ => {
            let message = format!("`{name}` has the shape {shape:?} and the type {}", array.getattr("dtype")?);
            Err(refused(py, &Diagnostic::new(message).help("a number or a row of numbers for each point")))
        }
    }
}

/// The least and the most of each variable.
fn pairs(given: &Bound<'_, PyAny>) -> PyResult<Vec<(f64, f64)>> {
    let rows = table(given, "bounds")?;
    let pair = |row: &Vec<f64>| if let [least, most] = row[..] { Some((least, most)) } else { None };
    rows.iter().map(pair).collect::<Option<_>>().ok_or_else(|| {
        let message = "`bounds` has no pair for each variable";
        refused(given.py(), &Diagnostic::new(message).help("the least and the most of each: shape (variables, 2)"))
    })
}
