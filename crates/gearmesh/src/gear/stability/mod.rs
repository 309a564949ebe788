//! What must hold for any pair under any load, however extreme: invariants checked on a case, each with its limit.
//!
//! A case is a pair, a load, modifications, and a model. [`check()`] runs the chain from geometry to transmission error on
//! it and gives one finding per invariant: `Holds`, `Broken`, or `Refused` where physics or the model excludes the case,
//! with the reason. Limits come from rounding: a small multiple of ε times the condition number, which is found by
//! changing the inputs of a second evaluation in twice the precision, or of the kernels where it does not know the teeth. Must not
//! know: tables, studies.

mod axis;
mod contact;
pub mod digits;
pub mod precise;
mod symmetry;
#[cfg(test)]
mod tests;
mod trap;

use std::any::Any;
use std::sync::Arc;

pub use axis::{AXES, Axis, Point, axis, sample};
pub use trap::{Continuity, continuity, traps};

use super::compliance::energy::{Arm, Energy, GearBody};
use super::compliance::{Assumptions, ContactLaw, Method, PairCompliance};
use super::contact::{CornerContact, SliceCoupling};
use super::geometry::outline::tip::Tip;
use super::geometry::{GearPair, Specification};
use super::mesh::{Mesh, Settings};
use super::modification::curve::Curve;
use super::modification::lead_crowning::LeadCrowning;
use super::modification::relief::{Amount, FromTip, Start};
use super::modification::tip_relief::TipRelief;
use super::modification::{Design, Gears};
use crate::numeric::double_double::Double;
use precise::Rule;

/// How the case is computed.
#[derive(Clone)]
pub struct Model {
    /// The method of the compliances.
    pub method: Arc<dyn Method>,
    /// What that method is asked for.
    pub assumptions: Assumptions,
    /// How the mesh cycle is sampled, and where flanks may touch.
    pub settings: Settings,
}

impl Model {
    /// The energy method, where that is the method: the one that the second evaluation knows.
    fn energy(&self) -> Option<&Energy> {
        (self.method.as_ref() as &dyn Any).downcast_ref()
    }
}

/// A pair under a load. SI.
#[derive(Clone)]
pub struct Case {
    /// What makes it special, in words; it names the case in tables.
    pub name: String,
    /// The axis it lies on; `trap` and `sample` for those that lie on none.
    pub axis: &'static str,
    /// Where on the axis: 0 at its first value, 1 at its last.
    pub place: f64,
    /// Pinion, gear; without backlash.
    pub gears: [Specification; 2],
    /// What is done to the corners of their tips.
    pub tips: [Tip; 2],
    /// T on the pinion \[N m\].
    pub torque: f64,
    /// Linear tip relief of both gears, and its roll length.
    pub relief: f64,
    /// L: roll length of that relief along the line of action \[m\].
    pub relief_length: f64,
    /// Lead crowning of both gears.
    pub crowning: f64,
    /// How it is computed.
    pub model: Model,
}

/// The finding about an invariant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The value is within its limit.
    Holds,
    /// The value is above its limit, or not a number.
    Broken,
    /// There is no value: the case is impossible, or the check does not cover it.
    Refused,
}

impl Verdict {
    /// How tables write it.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Broken => "broken",
            Self::Refused => "refused",
        }
    }
}

/// One invariant of one case; value and limit are NaN where it is refused.
#[derive(Clone, Debug)]
pub struct Finding {
    /// What must hold, in words; where a case is impossible, the step that refuses it.
    pub invariant: &'static str,
    /// What was found; small is good.
    pub value: f64,
    /// The largest value with which it holds.
    pub limit: f64,
    /// What follows from value and limit.
    pub verdict: Verdict,
    /// Why it is refused; empty otherwise.
    pub reason: String,
}

impl Finding {
    /// It holds where the value is not above the limit; a NaN is above everything.
    #[must_use]
    pub fn new(invariant: &'static str, value: f64, limit: f64) -> Self {
        let verdict = if value <= limit { Verdict::Holds } else { Verdict::Broken };
        Self { invariant, value, limit, verdict, reason: String::new() }
    }

    /// An invariant that cannot be checked on this case, and why.
    #[must_use]
    pub fn refused(invariant: &'static str, reason: impl Into<String>) -> Self {
        Self { invariant, value: f64::NAN, limit: f64::NAN, verdict: Verdict::Refused, reason: reason.into() }
    }
}

/// A quantity against its second evaluation.
#[derive(Clone, Debug)]
pub struct DigitsLost {
    /// One of [`precise::NAMES`].
    pub quantity: &'static str,
    /// The kernels' value. SI.
    pub value: f64,
    /// That of the second evaluation, rounded to an `f64`. SI.
    pub exact: f64,
    /// 15.95 + log10 of the relative difference, at least 0.
    pub lost: f64,
    /// Relative change per relative change of the inputs.
    pub condition: f64,
}

/// Everything that was found of a case.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// One per invariant; a single refusal where the case is impossible.
    pub findings: Vec<Finding>,
    /// One per quantity that was compared.
    pub digits: Vec<DigitsLost>,
}

/// Digits that may be lost on top of what the condition number takes: log10 of 2¹³ roundings that all go one way, more
/// than any number of the chain has gone through.
pub const MOST_LOST: f64 = 4.0;
/// Roundings in a path position.
const ROUNDINGS: f64 = 4.0;
/// Of the base pitch.
const SHORTEST_RELIEF: f64 = 1e-9;
/// How far quick copies of functions of the path are from them, relative: their series end at 1e-14.
const TABLE: f64 = 1e-13;

/// Pair, design and compliance of a case.
pub(crate) struct Built {
    pub pair: GearPair,
    pub design: Design,
    pub compliance: PairCompliance,
    pub cycle: Mesh,
}

/// Why a case is impossible: which step refuses it.
pub(crate) type Refusal = (&'static str, String);

impl Case {
    /// The pair.
    ///
    /// # Errors
    /// Why there is none.
    pub fn pair(&self) -> Result<GearPair, String> {
        GearPair::with_tips(self.gears, self.tips, None).map_err(|error| error.to_string())
    }

    /// The same modifications on both gears.
    ///
    /// # Errors
    /// When one does not fit the pair.
    pub fn design(&self, pair: &GearPair) -> Result<Design, String> {
        let mut design = Design::default();
        if self.relief != 0.0 {
            let amount = Amount::Depth(self.relief);
            let start = Start::Length(self.relief_length);
            let relief = TipRelief { amount, start, counted_from: FromTip::Tip, curve: Curve::Linear };
            design.add_of_any_size(Gears::Both, &relief, pair).map_err(|error| error.message)?;
        }
        if self.crowning != 0.0 {
            let crowning = LeadCrowning { amount: self.crowning };
            design.add_of_any_size(Gears::Both, &crowning, pair).map_err(|error| error.message)?;
        }
        Ok(design)
    }

    pub(crate) fn build(&self) -> Result<Built, Refusal> {
        let pair = self.pair().map_err(|reason| ("geometry", reason))?;
        let design = self.design(&pair).map_err(|reason| ("modification", reason))?;
        let Model { method, assumptions, settings } = &self.model;
        let tabulated = method.tabulate(&pair, *assumptions);
        let compliance = tabulated.map_err(|error| ("compliance", error.to_string()))?.compliance;
        let cycle = Mesh::new(&pair, &compliance, *settings).map_err(|error| ("mesh cycle", error.to_string()))?;
        Ok(Built { pair, design, compliance, cycle })
    }

    /// C_β at the end of the common face, of both gears.
    pub(crate) fn crown(&self) -> f64 {
        let width = self.gears[0].face_width.min(self.gears[1].face_width);
        self.gears.iter().map(|gear| self.crowning * (width / gear.face_width) * (width / gear.face_width)).sum()
    }

    /// Why the second evaluation does not cover the teeth.
    fn other_teeth(&self) -> Option<&'static str> {
        if self.gears.iter().any(|gear| gear.cutter.is_some()) {
            Some("the second evaluation knows gears that a rack cuts only")
        } else if self.gears.iter().any(|gear| gear.rack.residual_undercut() != 0.0) {
            Some("the second evaluation knows racks without protuberance and stock only")
        } else if self.tips.iter().any(|tip| *tip != Tip::Land) {
            Some("the second evaluation knows tips with a land only")
        } else {
            None
        }
    }

    /// Why the second evaluation does not cover the loaded pair.
    fn not_covered(&self) -> Option<&'static str> {
        let Model { assumptions, settings, .. } = &self.model;
        let is_known = |energy: &Energy| energy.body == GearBody::Sainsot && energy.arm == Arm::RootCircle;
        if !self.model.energy().is_some_and(is_known) {
            Some("the second evaluation knows the energy method with the fitted gear body only")
        } else if assumptions.root != super::geometry::root::RootShape::Trochoid {
            Some("the second evaluation knows the generated root only")
        } else if assumptions.coupled {
            Some("the second evaluation adds pairs; coupling comes from a Fourier series of the ring")
        } else if settings.corner_contact != CornerContact::None {
            Some("the second evaluation stays between A and E")
        } else if self.crowning != 0.0 && settings.slice_coupling != SliceCoupling::None {
            Some("the slices of the second evaluation do not hold each other")
        } else if self.crowning != 0.0 && assumptions.contact != ContactLaw::Linear {
            Some("a crowned face under the load-dependent law has no closed form: its slices decide, not rounding")
        } else {
            None
        }
    }

    pub(crate) fn inputs(&self) -> precise::Inputs {
        // As a definition, a relief shorter than this takes nothing away.
        let specification = &self.gears[0];
        let base_pitch = std::f64::consts::PI * specification.module * libm::cos(specification.pressure_angle);
        let relief = if self.relief_length > SHORTEST_RELIEF * base_pitch { self.relief } else { 0.0 };
        let of = |gear: &Specification| precise::GearInputs {
            teeth: f64::from(gear.teeth),
            shift: gear.profile_shift.into(),
            thickness_allowance: gear.thickness_allowance,
            addendum: gear.rack.addendum,
            dedendum: gear.rack.dedendum,
            round: gear.rack.tip_radius,
            tip_radius: gear.tip_radius.map(Double::from),
            tip_scale: Double::ONE,
            face_width: gear.face_width,
            bore_radius: gear.bore_radius,
            youngs_modulus: gear.material.youngs_modulus,
            poisson_ratio: gear.material.poisson_ratio,
            relief: relief.into(),
            relief_length: self.relief_length.into(),
            crowning: self.crowning.into(),
        };
        precise::Inputs {
            gears: [of(&self.gears[0]), of(&self.gears[1])],
            module: self.gears[0].module.into(),
            pressure_angle: self.gears[0].pressure_angle.into(),
            torque: self.torque.into(),
            shear_factor: self.model.energy().map_or(1.2, |energy| energy.shear_factor),
            load_dependent: self.model.assumptions.contact == ContactLaw::LoadDependent && self.crowning == 0.0,
        }
    }
}

/// Rules of the second evaluation: a fine one for values, a coarse one for condition numbers.
pub struct Rules {
    fine: Rule,
    coarse: Rule,
}

impl Rules {
    /// The two rules that [`check()`] takes; they serve any number of cases.
    #[must_use]
    pub fn new() -> Self {
        Self { fine: Rule::new(20, 24), coarse: Rule::new(10, 12) }
    }
}

impl Default for Rules {
    fn default() -> Self {
        Self::new()
    }
}

/// All invariants of a case.
#[must_use]
pub fn check(case: &Case, rules: &Rules) -> Report {
    let built = match case.build() {
        Ok(built) => built,
        Err((step, reason)) => {
            return Report { findings: vec![Finding::refused(step, reason)], ..Report::default() };
        }
    };
    let mut report = Report::default();
    let values = match contact::check(case, &built, &mut report.findings) {
        Ok(values) => values,
        Err(reason) => {
            report.findings.push(Finding::refused("approach within the model", reason));
            return report;
        }
    };
    if let Some(reason) = case.other_teeth() {
        report.findings.push(Finding::refused("second evaluation", reason));
        check_symmetry(case, values, symmetry::conditions(case, values), &mut report);
        return report;
    }
    let inputs = case.inputs();
    let exact = precise::evaluate(&inputs, &rules.fine);
    let mut conditions = precise::conditions(&inputs, &rules.coarse);
    // An extremum where a relief starts lies as far off as a path position is rounded, times the slope of the relief.
    if case.relief > 0.0 && case.relief_length > 0.0 {
        let rise = ROUNDINGS * built.pair.tangent_length * case.relief / case.relief_length;
        conditions[precise::NAMES.len() - 1] += rise / values[1] / libm::pow(10.0, MOST_LOST);
    }
    digits::check(case, &built, values, (&exact, &conditions), &mut report);
    let [.., mean, peak_to_peak] = conditions;
    check_symmetry(case, values, [mean, peak_to_peak], &mut report);
    report
}

/// `conditions` are those of mean and peak-to-peak.
fn check_symmetry(case: &Case, values: [f64; 2], conditions: [f64; 2], report: &mut Report) {
    // Where bodies couple, teeth that all turn with one bore make the matrix worse than the pair without it is.
    let matrix = if case.model.assumptions.coupled { contact::condition_found(&report.findings) } else { 1.0 };
    symmetry::check(case, values, conditions.map(|condition| condition.max(matrix)), &mut report.findings);
}
