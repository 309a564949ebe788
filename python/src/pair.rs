//! `Pair`: two gears on their centre distance.
//!
//! Must not know: load, studies.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use declare::declared::Declared;
use declare::error::Diagnostic;
use gearmesh::gear::geometry::outline::tip::Tip;
use gearmesh::gear::geometry::{Gear, GearPair};
use gearstudy::stage::kinds::geometry::stated::StatedGears;

use crate::errors::refused;
use crate::values;

/// What a pair is called in messages.
const PAIR: &str = "a pair";

#[pyclass(frozen, subclass, module = "gearstudy._gearstudy")]
pub struct Pair {
    pub pair: Arc<GearPair>,
    /// What it was made of, to be made again.
    fields: Py<PyDict>,
}

#[pymethods]
impl Pair {
    #[new]
    #[pyo3(signature = (**fields))]
    fn new(py: Python<'_>, fields: Option<Bound<'_, PyDict>>) -> PyResult<Self> {
        let fields = fields.unwrap_or_else(|| PyDict::new(py));
        let record = values::record(StatedGears::MEMBER.fields, &fields, PAIR)?;
        let stated = StatedGears::checked(&record).map_err(|wrong| refused(py, &wrong))?;
        stated.check(&record).map_err(|wrong| refused(py, &wrong))?;
        let pair = stated.pair(Tip::Land).ok_or_else(|| {
            refused(
                py,
                &Diagnostic::new("a pair needs `gear`").help("the mating gear, with teeth and widths of its own"),
            )
        })?;
        let pair = pair.map_err(|error| refused(py, &Diagnostic::new(error.to_string())))?;
        Ok(Self { pair: Arc::new(pair), fields: fields.copy()?.unbind() })
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        crate::made_again(slf.as_any(), &[], slf.get().fields.bind(slf.py()))
    }

    fn __repr__(&self) -> String {
        let [z1, z2] = [&self.pair.pinion, &self.pair.gear].map(|gear| gear.specification.teeth);
        let module = self.pair.pinion.specification.module;
        format!("Pair({z1}/{z2}, module={module}, contact_ratio={:.4})", self.pair.contact_ratio)
    }

    /// a_w [m]
    #[getter]
    fn centre_distance(&self) -> f64 {
        self.pair.centre_distance
    }

    /// α_w [rad]
    #[getter]
    fn working_pressure_angle(&self) -> f64 {
        self.pair.working_pressure_angle
    }

    /// p_b [m]
    #[getter]
    fn base_pitch(&self) -> f64 {
        self.pair.base_pitch
    }

    /// ε_α
    #[getter]
    fn contact_ratio(&self) -> f64 {
        self.pair.contact_ratio
    }

    /// T1T2 [m]
    #[getter]
    fn tangent_length(&self) -> f64 {
        self.pair.tangent_length
    }

    /// T1A [m]
    #[getter]
    fn start_of_contact(&self) -> f64 {
        self.pair.start_of_contact
    }

    /// T1E [m]
    #[getter]
    fn end_of_contact(&self) -> f64 {
        self.pair.end_of_contact
    }

    #[getter]
    fn pinion(&self) -> GearFacts {
        GearFacts::of(&self.pair.pinion)
    }

    #[getter]
    fn gear(&self) -> GearFacts {
        GearFacts::of(&self.pair.gear)
    }
}

/// What follows from what was stated of a gear.
#[pyclass(frozen, get_all, module = "gearstudy._gearstudy")]
pub struct GearFacts {
    teeth: u32,
    face_width: f64,
    bore_radius: f64,
    profile_shift: f64,
    reference_radius: f64,
    base_radius: f64,
    tip_radius: f64,
    root_radius: f64,
    form_radius: f64,
    tip_thickness: f64,
    undercut: bool,
}

impl GearFacts {
    fn of(gear: &Gear) -> Self {
        Self {
            teeth: gear.specification.teeth,
            face_width: gear.specification.face_width,
            bore_radius: gear.specification.bore_radius,
            profile_shift: gear.specification.profile_shift,
            reference_radius: gear.reference_radius,
            base_radius: gear.base_radius,
            tip_radius: gear.tip_radius,
            root_radius: gear.root_radius,
            form_radius: gear.form_radius,
            tip_thickness: gear.tip_thickness(),
            undercut: gear.undercut,
        }
    }
}

#[pymethods]
impl GearFacts {
    fn __repr__(&self) -> String {
        format!("GearFacts(teeth={}, tip_radius={}, root_radius={})", self.teeth, self.tip_radius, self.root_radius)
    }
}
