//! Studies: read, planned, run and compared, as the command line does it.
//!
//! Must not know: how any of it is decided.

use std::cell::RefCell;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use pyo3::exceptions::{PyKeyError, PyKeyboardInterrupt};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use serde_json::Value;

use declare::error::{Diagnostic, Faults, suggest};
use gearstudy::cli::embedded::{self, Places, Problem};
use gearstudy::program;
use studygraph::runner::limits::{Limits, MOST_ROWS};
use studygraph::runner::options::{Force, Options};
use studygraph::store::manifest::Manifest;
use studygraph::store::results::Folder;
use studygraph::study::{self, Settings};

use crate::errors::{bug, invalid_study, refused, run_failed};
use crate::tables::Table;
use crate::values;
use crate::waiting::stopping;

/// A study, read and checked, and where its results lie; :class:`gearstudy.Study` has the rest.
///
/// >>> study.stages["ste"]
/// 'ste'
#[pyclass(frozen, subclass, module = "gearstudy._gearstudy")]
pub struct Study {
    study: Arc<study::Study>,
    places: Places,
}

/// What is asked of a run beside the study.
fn options(
    only: Vec<String>,
    want: &[String],
    force: &Bound<'_, PyAny>,
    (jobs, keep_going): (usize, bool),
    limits: (Option<u64>, Option<u64>),
) -> PyResult<Options> {
    let py = force.py();
    let force = match force.extract::<bool>() {
        Ok(true) => Force::All,
        Ok(false) => Force::Nothing,
        Err(_) => Force::Stages(force.extract::<Vec<String>>()?.into_iter().collect()),
    };
    let wanted = want.iter().map(|name| embedded::wanted(name)).collect::<Result<_, _>>();
    let wanted = wanted.map_err(|wrong: String| refused(py, &Diagnostic::new(wrong)))?;
    let limits = Limits { memory: limits.0, rows: limits.1.unwrap_or(MOST_ROWS) };
    Ok(Options { jobs, keep_going, force, only, wanted, limits, ..Options::default() })
}

thread_local! {
    /// The folders whose runs have called what this thread is in.
    static CALLED_BY: RefCell<Vec<PathBuf>> = const { RefCell::new(Vec::new()) };
}

/// Tells a callable of Python what happens; what it raises stops the run.
struct Telling<'a> {
    callable: Option<Py<PyAny>>,
    /// Of the results.
    folder: &'a Path,
    stop: &'a AtomicBool,
    raised: Mutex<Option<PyErr>>,
    warnings: Mutex<Vec<String>>,
}

impl Telling<'_> {
    fn tell(&self, event: &Value) {
        if event["event"] == "warning" {
            let text = |key: &str| event[key].as_str();
            let stage = text("stage").map_or_else(String::new, |stage| format!("{stage}: "));
            let warning = stage + text("message").unwrap_or_default();
            self.warnings.lock().unwrap_or_else(PoisonError::into_inner).push(warning);
        }
        let Some(callable) = self.callable.as_ref().filter(|_| !self.stop.load(Ordering::Relaxed)) else { return };
        let process = std::process::id();
        CALLED_BY.with_borrow_mut(|folders| folders.push(self.folder.to_owned()));
        // None while the interpreter ends: nobody is left to be told.
        let told = Python::try_attach(|py| {
            let called = callable.call1(py, (from_json(py, event)?,)).map(drop);
            if std::process::id() != process {
                // Here are none of the threads that the run has.
                eprintln!("gearstudy: a process that was forked in a callback cannot go on with the run");
                std::process::exit(1);
            }
            called
        });
        CALLED_BY.with_borrow_mut(Vec::pop);
        match told {
            Some(Ok(())) => {}
            Some(Err(error)) => {
                self.raised.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
                self.stop.store(true, Ordering::Relaxed);
            }
            None => self.stop.store(true, Ordering::Relaxed),
        }
    }
}

/// What Python's own reader makes of it.
fn from_json<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (value.to_string(),))
}

fn problem(py: Python<'_>, study: &study::Study, problem: Problem) -> PyErr {
    match problem {
        Problem::Study(wrong) => match Faults::all(wrong) {
            Err(wrong) => invalid_study(py, &study.refused(wrong)),
            Ok(()) => bug("a study is refused, and nothing is wrong with it"),
        },
        Problem::Said(message) => run_failed(py, &message),
        Problem::Stopped => PyKeyboardInterrupt::new_err(()),
    }
}

#[pymethods]
impl Study {
    #[new]
    #[pyo3(signature = (text, path, *, set = Vec::new(), name = None, results = PathBuf::from("results"), cache = None))]
    fn new(
        py: Python<'_>,
        text: Option<String>,
        path: PathBuf,
        set: Vec<String>,
        name: Option<String>,
        results: PathBuf,
        cache: Option<PathBuf>,
    ) -> PyResult<Self> {
        let settings = Settings { set, name };
        let read = stopping(py, move |_| match text {
            Some(text) => program::examine_changed_text(&text, &path, &settings),
            None => program::examine(&path, &settings),
        })?;
        let study = read.map_err(|refused| invalid_study(py, &refused.error()))?;
        Ok(Self { study: Arc::new(study), places: Places::new(results, cache) })
    }

    /// Its name, that of its folder in the results.
    #[getter]
    fn name(&self) -> &str {
        &self.study.name
    }

    /// Its title; empty where it has none.
    #[getter]
    fn title(&self) -> &str {
        &self.study.title
    }

    /// The names of its stages and the kind of each, in the order of the file.
    #[getter]
    fn stages<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for node in &self.study.nodes {
            all.set_item(&node.name, node.kind.name)?;
        }
        Ok(all)
    }

    /// The folder of its results.
    #[getter]
    fn folder(&self) -> PathBuf {
        self.places.folder(&self.study.name).path().to_owned()
    }

    fn __repr__(&self) -> String {
        format!("Study({:?}, stages={})", self.study.name, self.study.nodes.len())
    }

    #[pyo3(signature = (*, only, want, force, jobs, keep_going, limit_memory, limit_rows, progress))]
    fn _run(
        &self,
        py: Python<'_>,
        only: Vec<String>,
        want: Vec<String>,
        force: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = values::count)] jobs: usize,
        keep_going: bool,
        limit_memory: Option<u64>,
        limit_rows: Option<u64>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Vec<String>> {
        let options = options(only, &want, force, (jobs, keep_going), (limit_memory, limit_rows))?;
        let folder = self.folder();
        if CALLED_BY.with_borrow(|folders| folders.contains(&folder)) {
            let message = format!("`{}` is running: what it calls cannot run it again", self.study.name);
            return Err(run_failed(py, &message));
        }
        let (study, places) = self.own();
        let (ran, raised, warnings) = stopping(py, move |stop| {
            let (raised, warnings) = (Mutex::default(), Mutex::default());
            let telling = Telling { callable: progress, folder: &folder, stop, raised, warnings };
            let ran = embedded::run(&study, &places, &options, &|event| telling.tell(event), stop);
            let raised = telling.raised.into_inner().unwrap_or_else(PoisonError::into_inner);
            (ran, raised, telling.warnings.into_inner().unwrap_or_else(PoisonError::into_inner))
        })?;
        if let Some(raised) = raised {
            return Err(raised);
        }
        ran.map_err(|found| problem(py, &self.study, found))?;
        Ok(warnings)
    }

    /// What a run would do, as `gearstudy plan --format json` has it.
    #[pyo3(signature = (*, only, want, force))]
    fn _plan<'py>(
        &self,
        py: Python<'py>,
        only: Vec<String>,
        want: Vec<String>,
        force: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let options = options(only, &want, force, (0, false), (None, None))?;
        let (study, places) = self.own();
        let plan = stopping(py, move |_| embedded::plan(&study, &places, &options))?;
        from_json(py, &plan.map_err(|found| problem(py, &self.study, found))?)
    }

    /// What differs between the results of this study and those of another one, as `gearstudy diff --format json` has it.
    fn _diff<'py>(&self, py: Python<'py>, before: &Self) -> PyResult<Bound<'py, PyAny>> {
        let one = |study: &Self| study.places.folder(&study.study.name);
        let (before, after) = (one(before), one(self));
        let found = stopping(py, move |_| embedded::diff(&before, &after))?;
        from_json(py, &found.map_err(|message| run_failed(py, &message))?)
    }

    /// The names of the tables that the last run published.
    fn _tables<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let manifest = self.manifest(py)?;
        PyList::new(py, manifest.stages.iter().flat_map(|stage| &stage.tables).map(|table| table.name.as_str()))
    }

    fn _table(&self, py: Python<'_>, name: &str) -> PyResult<Table> {
        let manifest = self.manifest(py)?;
        let all = || manifest.stages.iter().flat_map(|stage| stage.tables.iter().map(move |record| (stage, record)));
        let found = all().find(|(_, record)| record.name == name);
        let Some((stage, record)) = found.map(|(stage, record)| (stage.clone(), record.clone())) else {
            let help = suggest(name, all().map(|(_, record)| record.name.as_str()).collect::<Vec<_>>());
            return Err(PyKeyError::new_err(format!("there is no table `{name}`; {help}")));
        };
        let (study, places) = self.own();
        let table = stopping(py, move |_| embedded::table(&study.name, &places, &stage, &record))?;
        let table = table.map_err(|problem| run_failed(py, &problem))?;
        Ok(Table::new(name, table))
    }

    /// The page that shows its results; None before it was run.
    #[getter]
    fn report(&self, py: Python<'_>) -> PyResult<Option<PathBuf>> {
        embedded::page(&self.places.folder(&self.study.name)).map_err(|problem| run_failed(py, &problem))
    }
}

impl Study {
    /// For what may go on after its call.
    fn own(&self) -> (Arc<study::Study>, Places) {
        (Arc::clone(&self.study), self.places.clone())
    }

    fn manifest(&self, py: Python<'_>) -> PyResult<Manifest> {
        let folder: Folder = self.places.folder(&self.study.name);
        let read = py.detach(|| folder.read_manifest()).map_err(|error| run_failed(py, &error.to_string()))?;
        read.ok_or_else(|| run_failed(py, &format!("`{}` has no results yet; run it first", self.study.name)))
    }
}

/// Runs the program with these words, the first being its own name, and gives its exit code.
///
/// >>> command_line(["gearstudy", "--version"])  # doctest: +SKIP
/// 0
#[pyfunction]
pub fn command_line(py: Python<'_>, words: Vec<OsString>) -> i32 {
    py.detach(|| gearstudy::cli::main(words.into_iter()))
}
