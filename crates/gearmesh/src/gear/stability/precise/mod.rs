//! The chain from geometry to transmission error a second time, in twice the precision: the kernels are held to its digits.
//!
//! It is compact and slow, and shares no code with the kernels: roots by bisection, integrals by composite Gauss–Legendre
//! rules of high order, contact by Newton's method on the load of all pairs. It covers gears with the generated root,
//! the energy method with the fitted gear body, pairs that are added, both contact laws, linear tip relief counted from
//! the tip, and crowning (its closed form). Inputs are the kernels' own `f64`, taken as exact. Must not know: the kernels.

mod flanks;
#[cfg(test)]
mod gaps;
mod mesh;
mod rules;
mod tooth;

use crate::numeric::double_double::Double;
use flanks::TipRelief;
#[cfg(test)]
pub(super) use gaps::exact_gap;
use mesh::PreciseMesh;
pub use rules::Rule;
use tooth::Tooth;

use crate::gear::geometry::Side;

/// One gear as specified.
#[derive(Clone, Debug)]
pub struct GearInputs {
    /// z.
    pub teeth: f64,
    /// x \[modules\].
    pub shift: Double,
    /// A_s \[m\].
    pub thickness_allowance: f64,
    /// h_aP*.
    pub addendum: f64,
    /// h_fP*.
    pub dedendum: f64,
    /// ρ_fP*.
    pub round: f64,
    /// r_a where it was given.
    pub tip_radius: Option<Double>,
    /// Factor on the tip radius: 1, except to find out how much depends on its last digit.
    pub tip_scale: Double,
    /// b \[m\].
    pub face_width: f64,
    /// Radius of the bore, where the body is clamped \[m\].
    pub bore_radius: f64,
    /// E \[Pa\].
    pub youngs_modulus: f64,
    /// ν.
    pub poisson_ratio: f64,
    /// Linear tip relief: depth at the tip, and roll length from the tip.
    pub relief: Double,
    /// That roll length \[m\].
    pub relief_length: Double,
    /// C_β at the ends of the gear's own face \[m\].
    pub crowning: Double,
}

/// A pair under a torque.
#[derive(Clone, Debug)]
pub struct Inputs {
    /// Pinion, gear.
    pub gears: [GearInputs; 2],
    /// m \[m\].
    pub module: Double,
    /// α \[rad\].
    pub pressure_angle: Double,
    /// T on the pinion \[N m\].
    pub torque: Double,
    /// By how much more a section shears than under a uniform stress, as in the energy method.
    pub shear_factor: f64,
    /// Whether flanks flatten by the law of Weber and Banaschek instead of the linear one; not with crowning.
    pub load_dependent: bool,
}

impl GearInputs {
    fn tip_relief(&self) -> TipRelief {
        TipRelief { depth: self.relief, length: self.relief_length }
    }
}

impl Inputs {
    fn shift_relief(&mut self, gear: usize, share: Double) {
        let diameter = self.module * self.gears[gear].teeth;
        self.gears[gear].relief_length += diameter * share;
    }
}

/// What is compared, in the order of [`Quantities`].
pub const NAMES: [&str; 13] = [
    "form radius",
    "form roll angle",
    "tip roll angle",
    "tip thickness",
    "centre distance",
    "start of contact",
    "contact ratio",
    "compliance at the form point",
    "compliance at the tip",
    "stiffness, fewest pairs",
    "stiffness, most pairs",
    "mean transmission error",
    "peak-to-peak transmission error",
];

/// One value per name.
pub type Quantities<T> = [T; NAMES.len()];

/// How many of the quantities belong to geometry alone.
pub const GEOMETRIC: usize = 7;

/// Everything at once.
pub fn evaluate(inputs: &Inputs, rule: &Rule) -> Quantities<Double> {
    let mut teeth = [Side::Pinion, Side::Gear].map(|side| Tooth::new(inputs, side));
    let mesh = PreciseMesh::new(inputs, &teeth);
    let pinion = &teeth[0];
    let geometry = [
        pinion.form_radius,
        pinion.form_roll,
        pinion.tip_roll,
        pinion.tip_thickness,
        mesh.centre_distance,
        mesh.start,
        mesh.contact_ratio(),
    ];
    for tooth in &mut teeth {
        tooth.tabulate(rule, inputs.shear_factor);
    }
    let compliance = [teeth[0].value(teeth[0].form_roll), teeth[0].value(teeth[0].tip_roll)];
    let stiffness = mesh.stiffness(&teeth);
    let error = mesh.transmission_error(&teeth, rule);
    let mut all = [Double::ZERO; NAMES.len()];
    for (slot, value) in all.iter_mut().zip(geometry.into_iter().chain(compliance).chain(stiffness).chain(error)) {
        *slot = value;
    }
    all
}

/// Relative changes per relative change of what rounding touches first: pressure angle, profile shifts (as parts of a
/// module), tip radii, relief, where it starts (as a part of the reference diameter, which is the size of the path
/// positions), crowning and torque. Their sum is the condition number of each quantity. A coarse rule
/// is enough, since it serves both sides of each difference.
pub fn conditions(inputs: &Inputs, rule: &Rule) -> Quantities<f64> {
    const STEP: f64 = 1e-14;
    let scale = Double::ONE + STEP;
    let changes: [fn(&mut Inputs, Double); 10] = [
        |inputs, scale| inputs.pressure_angle = inputs.pressure_angle * scale,
        |inputs, scale| inputs.gears[0].shift += scale - 1.0,
        |inputs, scale| inputs.gears[1].shift += scale - 1.0,
        |inputs, scale| inputs.gears[0].tip_scale = Double::ONE / scale,
        |inputs, scale| inputs.gears[1].tip_scale = Double::ONE / scale,
        |inputs, scale| inputs.torque = inputs.torque * scale,
        |inputs, scale| inputs.gears[0].relief = inputs.gears[0].relief * scale,
        |inputs, scale| inputs.shift_relief(0, scale - 1.0),
        |inputs, scale| inputs.shift_relief(1, scale - 1.0),
        |inputs, scale| inputs.gears[0].crowning = inputs.gears[0].crowning * scale,
    ];
    let here = evaluate(inputs, rule);
    let mut sums = [0.0; NAMES.len()];
    let [relieved, crowned] = [inputs.gears[0].relief, inputs.gears[0].crowning].map(|amount| amount.high != 0.0);
    for (change, wanted) in
        changes.into_iter().zip([true, true, true, true, true, true, relieved, relieved, relieved, crowned])
    {
        if !wanted {
            continue;
        }
        let mut changed = inputs.clone();
        change(&mut changed, scale);
        let values = evaluate(&changed, rule);
        for (sum, (value, here)) in sums.iter_mut().zip(values.into_iter().zip(here)) {
            if here.high != 0.0 {
                *sum += ((value - here) / here).high.abs() / STEP;
            }
        }
    }
    sums
}
