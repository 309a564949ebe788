//! `Stiffness`: the compliances of a pair's teeth, tabulated once, and the mesh cycles that are made of them.
//!
//! Must not know: modifications, studies.

use std::sync::{Arc, Mutex, TryLockError};

use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use declare::declared::{Declared, Words};
use declare::error::{Diagnostic, Failure};
use declare::parameter::Field;
use gearmesh::gear::compliance::{PairCompliance, Tabulated};
use gearmesh::gear::geometry::GearPair;
use gearmesh::gear::mesh::answers::stiffness::stiffness;
use gearmesh::gear::mesh::{Mesh, Settings};
use gearstudy::stage::common;
use gearstudy::stage::common::{Contact, Slices};
use gearstudy::stage::kinds::stiffness::Deflection;

use crate::errors::{failed, refused};
use crate::pair::Pair;
use crate::values;
use crate::waiting::abandoning;

type Floats<'py> = Bound<'py, PyArray1<f64>>;

/// Cycles of other settings that are kept.
const MOST_CYCLES: usize = 8;

/// The compliances of a pair's teeth; what they are made of, :class:`gearstudy.Stiffness` says.
///
/// >>> 0 <= stiffness.error_estimate < 1
/// True
#[pyclass(frozen, subclass, module = "gearstudy._gearstudy")]
pub struct Stiffness {
    pub of: Arc<GearPair>,
    pair: Py<Pair>,
    tabulated: Tabulated,
    contact: &'static str,
    /// The torque that was stated \[N m\].
    torque: Option<f64>,
    cycles: Mutex<Vec<Arc<Mesh>>>,
    fields: Py<PyDict>,
}

#[pymethods]
impl Stiffness {
    #[new]
    #[pyo3(signature = (pair, **fields))]
    fn new(pair: &Bound<'_, Pair>, fields: Option<Bound<'_, PyDict>>) -> PyResult<Self> {
        let py = pair.py();
        let fields = fields.unwrap_or_else(|| PyDict::new(py));
        let record = values::record(Deflection::MEMBER.fields, &fields, "a stiffness")?;
        let wrong = |wrong: Diagnostic| refused(py, &wrong);
        let stated = Deflection::checked(&record).map_err(wrong)?;
        stated.teeth.check(&record).map_err(wrong)?;
        let of = Arc::clone(&pair.get().pair);
        let (contact, torque) = (stated.teeth.contact().word(), stated.torque);
        let own = Arc::clone(&of);
        // A mesh is factorised in one go.
        let tabulated = abandoning(py, move |_| stated.teeth.method.tabulate(&own, stated.assumptions()))?;
        let tabulated = tabulated.map_err(|error| refused(py, &Diagnostic::new(error.to_string())))?;
        let (pair, fields) = (pair.clone().unbind(), fields.copy()?.unbind());
        Ok(Self { of, pair, tabulated, contact, torque, cycles: Mutex::default(), fields })
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let own = slf.get();
        crate::made_again(slf.as_any(), &[own.pair.bind(slf.py()).as_any()], own.fields.bind(slf.py()))
    }

    fn __repr__(&self) -> String {
        format!("Stiffness(contact={:?}, error_estimate={:.1e})", self.contact, self.tabulated.error_estimate)
    }

    /// The pair that it is of.
    #[getter]
    fn pair(&self, py: Python<'_>) -> Py<Pair> {
        self.pair.clone_ref(py)
    }

    /// The contact law: linear, load_dependent or resolved.
    #[getter]
    fn contact(&self) -> &'static str {
        self.contact
    }

    /// How far a tooth's own compliance may be off, relatively.
    #[getter]
    fn error_estimate(&self) -> f64 {
        self.tabulated.error_estimate
    }

    /// A sentence for each formula that is used outside its range.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.tabulated.warnings.clone()
    }

    /// The mesh stiffness of unmodified teeth over one cycle.
    ///
    /// Parameters
    /// ----------
    /// torque : number [N m], optional
    ///     On the pinion; without it the one that was stated, or else 1 N m. It matters where the contact law depends on load.
    /// positions : int, optional
    ///     Of the cycle, evenly spread. 8 to 100,000; 64 without it.
    ///
    /// Returns
    /// -------
    /// positions [m] and stiffness [N/m], both of shape (points,), and the mean stiffness [N/m].
    ///
    /// >>> position, stiff, mean = stiffness.mesh(150.0)
    /// >>> position.shape == stiff.shape
    /// True
    /// >>> bool(stiff.min() < mean < stiff.max())
    /// True
    #[pyo3(signature = (torque = None, *, positions = None))]
    fn mesh<'py>(
        &self,
        py: Python<'py>,
        torque: Option<&Bound<'_, PyAny>>,
        positions: Option<usize>,
    ) -> PyResult<(Floats<'py>, Floats<'py>, f64)> {
        let torque = match torque.map(|torque| crate::torques(torque)).transpose()?.as_deref() {
            None => self.torque.unwrap_or(1.0),
            Some([torque]) if *torque > 0.0 => *torque,
            Some(several) => {
                let message = if several.len() == 1 { "`torque` is 0" } else { "`torque` has several values" };
                let help = "a mesh stiffness is that of one torque above 0";
                return Err(refused(py, &Diagnostic::new(message).help(help)));
            }
        };
        let mut settings = Settings::default();
        settings.positions = positions.unwrap_or(settings.positions);
        checked(py, settings)?;
        let cycle = self.cycle(settings).map_err(|failure| failed(py, &failure))?;
        let (points, summary) = py.detach(|| stiffness(&cycle, torque));
        let (at, stiff): (Vec<f64>, Vec<f64>) =
            points.iter().map(|point| (point.cycle_position, point.secant_stiffness)).unzip();
        Ok((at.into_pyarray(py), stiff.into_pyarray(py), summary.mean))
    }
}

/// Refuses settings that a study could not state.
fn checked(py: Python<'_>, settings: Settings) -> PyResult<()> {
    if (8..=100_000).contains(&settings.positions) {
        return Ok(());
    }
    let message = format!("`positions` is {}", settings.positions);
    Err(refused(py, &Diagnostic::new(message).help("it may be 8 to 100000")))
}

/// How a mesh cycle is sampled and loaded, as the words of a call say.
///
/// # Errors
/// What is no such word, or out of its range.
fn settings(py: Python<'_>, given: Option<&Bound<'_, PyDict>>, positions: usize) -> PyResult<Settings> {
    let usual = Settings { positions, ..Settings::default() };
    let Some(given) = given.filter(|given| !given.is_empty()) else {
        return checked(py, usual).map(|()| usual);
    };
    let record = values::record(CYCLE, given, "a mesh cycle")?;
    let wrong = |wrong: Diagnostic| refused(py, &wrong);
    let settings = common::settings(
        positions,
        Slices::checked(&record).map_err(wrong)?,
        Contact::checked(&record).map_err(wrong)?,
    );
    common::check_slices(settings, &record).map_err(wrong)?;
    checked(py, settings)?;
    Ok(settings)
}

/// The fields of [`Slices`] and [`Contact`].
pub const CYCLE: &[Field] = {
    const TABLES: [&[Field]; 2] = [Slices::MEMBER.fields, Contact::MEMBER.fields];
    const COUNT: usize = declare::parameter::count(&TABLES);
    const ALL: [Field; COUNT] = declare::parameter::joined(&TABLES);
    &ALL
};

impl Stiffness {
    pub fn compliance(&self) -> &PairCompliance {
        &self.tabulated.compliance
    }

    /// The mesh cycle that the words of a call ask for.
    ///
    /// # Errors
    /// As [`settings`] and [`Stiffness::cycle`].
    pub fn asked(&self, py: Python<'_>, words: Option<&Bound<'_, PyDict>>, positions: usize) -> PyResult<Arc<Mesh>> {
        self.cycle(settings(py, words, positions)?).map_err(|failure| failed(py, &failure))
    }

    /// The mesh cycle with these settings; kept, since no modification changes it.
    ///
    /// # Errors
    /// When the pair cannot be loaded so.
    pub fn cycle(&self, settings: Settings) -> Result<Arc<Mesh>, Failure> {
        // Nobody is waited for: a process that was forked has the lock as it was, and nobody to give it back.
        let cycles = match self.cycles.try_lock() {
            Ok(cycles) => Some(cycles),
            Err(TryLockError::Poisoned(poisoned)) => Some(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => None,
        };
        let known = cycles.as_ref().and_then(|cycles| cycles.iter().find(|cycle| cycle.settings == settings));
        if let Some(known) = known {
            return Ok(Arc::clone(known));
        }
        let made = Arc::new(Mesh::new(&self.of, self.compliance(), settings).map_err(common::no_mesh)?);
        if let Some(mut cycles) = cycles {
            cycles.truncate(MOST_CYCLES - 1);
            cycles.insert(0, Arc::clone(&made));
        }
        Ok(made)
    }
}
