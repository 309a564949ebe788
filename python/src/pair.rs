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

/// Two spur gears on their centre distance; what it is made of, :class:`gearstudy.Pair` says.
///
/// >>> pair.contact_ratio > 1
/// True
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

    /// a_w: centre distance [m].
    #[getter]
    fn centre_distance(&self) -> f64 {
        self.pair.centre_distance
    }

    /// α_w: working pressure angle [rad].
    #[getter]
    fn working_pressure_angle(&self) -> f64 {
        self.pair.working_pressure_angle
    }

    /// p_b: base pitch, the length of a mesh cycle on the line of action [m].
    #[getter]
    fn base_pitch(&self) -> f64 {
        self.pair.base_pitch
    }

    /// ε_α: transverse contact ratio.
    #[getter]
    fn contact_ratio(&self) -> f64 {
        self.pair.contact_ratio
    }

    /// T1T2: length of the line of action between the base circles [m].
    #[getter]
    fn tangent_length(&self) -> f64 {
        self.pair.tangent_length
    }

    /// T1A: where contact begins, from the base circle of the pinion along the line of action [m].
    #[getter]
    fn start_of_contact(&self) -> f64 {
        self.pair.start_of_contact
    }

    /// T1E: where contact ends, from the base circle of the pinion along the line of action [m].
    #[getter]
    fn end_of_contact(&self) -> f64 {
        self.pair.end_of_contact
    }

    /// What follows for the pinion.
    #[getter]
    fn pinion(&self) -> GearFacts {
        GearFacts::of(&self.pair.pinion)
    }

    /// What follows for the gear.
    #[getter]
    fn gear(&self) -> GearFacts {
        GearFacts::of(&self.pair.gear)
    }
}

/// What was stated of a gear, and what follows from it; :class:`Pair` has one for each of its gears.
///
/// >>> pair.pinion.base_radius < pair.pinion.reference_radius < pair.pinion.tip_radius
/// True
#[pyclass(frozen, get_all, module = "gearstudy._gearstudy")]
pub struct GearFacts {
    /// z: number of teeth.
    teeth: u32,
    /// b: face width [m].
    face_width: f64,
    /// Radius of the bore [m].
    bore_radius: f64,
    /// x: profile shift coefficient.
    profile_shift: f64,
    /// r: reference radius [m].
    reference_radius: f64,
    /// r_b: base radius [m].
    base_radius: f64,
    /// r_a: tip radius [m].
    tip_radius: f64,
    /// r_f: root radius [m].
    root_radius: f64,
    /// r_Ff: root form radius, where the involute begins [m].
    form_radius: f64,
    /// s_a: tooth thickness at the tip, along its circle [m].
    tip_thickness: f64,
    /// Whether the tool removes a part of the involute at the root.
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
