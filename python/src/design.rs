//! Modifications as Python states them, one design or as many as their arrays have elements.
//!
//! Must not know: load, studies.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::{PyAnyMethods, PyString, PyTuple};

use declare::error::{Diagnostic, suggest};
use declare::record::{Record, Value};
use gearmesh::gear::geometry::GearPair;
use gearmesh::gear::modification::{self, FAMILIES, Family};

use crate::errors::refused;
use crate::pair::Pair;
use crate::values::{self, Column};

/// A modification as it was stated; fields with a column have its first element.
pub struct Stated {
    family: &'static Family,
    record: Record,
    columns: Vec<Column>,
}

/// One design, or several that differ by the elements of arrays.
pub enum Designs {
    Built(Arc<modification::Design>, Arc<GearPair>),
    Stated(Vec<Stated>),
}

impl Designs {
    /// What was given as `design`: nothing, a `Design`, one modification or several.
    ///
    /// # Errors
    /// What is none of these; as [`values::record_of_arrays`].
    pub fn read(given: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let Some(given) = given.filter(|given| !given.is_none()) else { return Ok(Self::Stated(Vec::new())) };
        if let Ok(design) = given.cast::<Design>() {
            let (built, pair) = (&design.get().built, &design.get().pair.get().pair);
            return Ok(Self::Built(Arc::clone(built), Arc::clone(pair)));
        }
        let parts = match values::declared(given)? {
            Some(_) => vec![stated(given)?],
            None if given.is_instance_of::<PyString>() => vec![stated(given)?],
            None => match given.try_iter() {
                Ok(items) => items.map(|item| stated(&item?)).collect::<PyResult<_>>()?,
                Err(_) => vec![stated(given)?],
            },
        };
        Ok(Self::Stated(parts))
    }

    /// How many there are; none where nothing was given as an array.
    ///
    /// # Errors
    /// Arrays of different lengths.
    pub fn count(&self, more: Option<usize>) -> Result<Option<usize>, Diagnostic> {
        let Self::Stated(parts) = self else { return Ok(more) };
        let mut count = more;
        for (name, values) in parts.iter().flat_map(|part| &part.columns) {
            match count {
                Some(count) if count != values.len() => {
                    let message = format!("`{name}` has {} elements, and something else has {count}", values.len());
                    return Err(Diagnostic::new(message).help("arrays of one call have one length"));
                }
                _ => count = Some(values.len()),
            }
        }
        Ok(count)
    }

    /// The design at an index.
    ///
    /// # Errors
    /// What does not fit the pair.
    pub fn at(&self, index: usize, pair: &Arc<GearPair>) -> Result<Arc<modification::Design>, Diagnostic> {
        let parts = match self {
            Self::Built(design, own) if Arc::ptr_eq(own, pair) || own == pair => return Ok(Arc::clone(design)),
            Self::Built(..) => {
                let message = "`design` is that of another pair than `stiffness`";
                return Err(Diagnostic::new(message).help("make the Design for the pair, or give the modifications"));
            }
            Self::Stated(parts) => parts,
        };
        let mut design = modification::Design::default();
        for Stated { family, record, columns } in parts {
            if columns.is_empty() {
                design.add_record(family, record, pair)?;
                continue;
            }
            let mut own = record.clone();
            for (name, values) in columns {
                let entries = own.fields.iter_mut().filter(|(field, _)| field == name);
                entries.for_each(|(_, entry)| match &mut entry.value {
                    Value::Quantity(value) | Value::Number(value) => *value = values[index],
                    _ => (),
                });
            }
            design.add_record(family, &own, pair)?;
        }
        Ok(Arc::new(design))
    }
}

fn stated(given: &Bound<'_, PyAny>) -> PyResult<Stated> {
    let py = given.py();
    let names = || FAMILIES.iter().map(|family| family.member.name);
    let help = || {
        format!("a modification such as TipRelief is expected; families are {}", names().collect::<Vec<_>>().join(", "))
    };
    let Some((Some(name), fields)) = values::declared(given)? else {
        let kind = given.get_type().name()?;
        return Err(refused(py, &Diagnostic::new(format!("`design` has something of type {kind}")).help(help())));
    };
    let Some(family) = modification::family(&name) else {
        let wrong = Diagnostic::new(format!("`{name}` is no modification")).help(suggest(&name, names()));
        return Err(refused(py, &wrong));
    };
    let (record, columns) = values::record_of_arrays(family.member.fields, &fields, &format!("`{name}`"))?;
    Ok(Stated { family, record, columns })
}

/// Modifications on the gears of a pair, checked once for many calls.
///
/// Parameters
/// ----------
/// pair : Pair
///     What they are for.
/// modifications : modification, or sequence of modifications
///     Single values only.
///
/// Raises
/// ------
/// InvalidInput
///     What does not fit the pair.
///
/// >>> design = Design(pair, TipRelief(gear="both", amount=14e-6, fraction=0.8))
/// >>> bool(peak_to_peak(stiffness, 150.0, design) == peak_to_peak(stiffness, 150.0, relief))
/// True
#[pyclass(frozen, module = "gearstudy._gearstudy")]
pub struct Design {
    built: Arc<modification::Design>,
    pair: Py<Pair>,
    modifications: Py<PyAny>,
}

#[pymethods]
impl Design {
    #[new]
    fn new(pair: &Bound<'_, Pair>, modifications: &Bound<'_, PyAny>) -> PyResult<Self> {
        let py = pair.py();
        let stated = Designs::read(Some(modifications))?;
        let wrong = |wrong: Diagnostic| refused(py, &wrong);
        if stated.count(None).map_err(wrong)?.is_some() {
            let message = "one design has single values, and an array was given";
            return Err(wrong(Diagnostic::new(message).help("`peak_to_peak` and `summaries` take arrays")));
        }
        let design = stated.at(0, &pair.get().pair).map_err(wrong)?;
        Ok(Self { built: design, pair: pair.clone().unbind(), modifications: modifications.clone().unbind() })
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let (py, own) = (slf.py(), slf.get());
        let given = PyTuple::new(py, [own.pair.bind(py).as_any(), own.modifications.bind(py)])?;
        PyTuple::new(py, [slf.get_type().as_any(), given.as_any()])
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!("Design({})", self.modifications.bind(py).repr()?))
    }

    /// Gear, family, name and value in SI of everything that was stated, and of what follows from it.
    #[getter]
    fn resolved(&self) -> Vec<(&'static str, &'static str, &'static str, f64)> {
        self.built
            .resolved()
            .into_iter()
            .map(|(side, family, name, value)| (side.name(), family, name, value))
            .collect()
    }
}
