//! The energy method: a tooth as a cantilever of varying section on an elastic body.
//!
//! With the load angle α_1 = u − ψ_b, the load line passes the section at height y at the distance r_b − y cos α_1, so
//! 1/k_b = ∫(r_b − y cos α_1)²/(E I) dy, I = (2x)³ b/12; 1/k_s = 1.2 cos²α_1 ∫dy/(G A); 1/k_a = sin²α_1 ∫dy/(E A),
//! A = 2xb: four integrals over the tooth serve every load. Source: Yang and Lin, Journal of Mechanisms, Transmissions
//! and Automation in Design 109 (1987) 189–196, with the root included; plane stress. The gear body comes from
//! `sainsot` or `ring`. Must not know: modification, load.

use super::ring::{self, Ring};
use super::sainsot::Body;
use super::{Assumptions, ComplianceError, Method, PairCompliance, ROUNDING, Tabulated, ToothCompliance, of_both};
use crate::gear::geometry::involute::Section;
use crate::gear::geometry::root::Root;
use crate::gear::geometry::{Gear, GearPair, Side};
use crate::gear::material::Plane;
use crate::gear::work::COMPLIANCE_EVALUATIONS;
use crate::numeric::chebyshev::Series;
use crate::numeric::quadrature::GaussLegendre;
use crate::numeric::surface::Surface;
use declare::work::Work;
use declare::{Declared, Words};

/// Points per piece of the root: twice as many as 1e-12 takes.
const ROOT_POINTS: usize = 40;
/// Below these bore ratios the fitted body formula gives 1.3 to 1.8 times as much as the ring it was fitted to, and it does
/// not vanish as the bore reaches the root. Up to the upper end it stays within a sixth of the ring; from there on its
/// square of the ratio runs away, to a thousand times the ring's value at a ratio of a thousand.
const BORE_RATIOS: [f64; 2] = [1.2, 20.0];
/// θ_f \[rad\] below which 1/θ_f² dominates the fitted formula: half of the least it was fitted for. It goes negative there,
/// and for still more teeth it comes back hundreds of times too large.
const LEAST_HALF_ANGLE: f64 = 0.005;

/// What the gear body under the tooth is taken from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Words)]
pub enum GearBody {
    /// the formula that Sainsot, Velex and Duverger fitted to the elastic ring
    #[default]
    Sainsot,
    /// the elastic ring itself, for any bore and root angle
    Ring,
}

/// Where the formula's arm of the load on the gear body is counted from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Words)]
pub enum Arm {
    /// the root circle, as in the source of the formula
    #[default]
    RootCircle,
    /// the clamped end of the tooth, as in programs whose teeth end at the base circle
    ClampedEnd,
}

/// Cantilever of varying section (bending, shear, compression) on an elastic gear body.
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "energy")]
pub struct Energy {
    /// how much more a section shears than under a uniform shear stress
    #[declared(minimum = 1.0, maximum = 2.0, default = "1.2")]
    pub shear_factor: f64,
    /// what the gear body under the tooth is taken from
    #[declared(default = "sainsot")]
    pub body: GearBody,
    /// where the formula's arm of the load on the gear body is counted from
    #[declared(default = "root_circle")]
    pub arm: Arm,
    /// harmonics of the elastic ring, times the half root angle; where an accuracy is wanted, as many as it takes
    #[declared(minimum = LEAST_HARMONICS, maximum = MOST_HARMONICS, default = "100")]
    pub harmonics: u32,
}

const LEAST_HARMONICS: i64 = 10;
const MOST_HARMONICS: i64 = 2000;

impl Method for Energy {
    fn tabulate(&self, pair: &GearPair, assumptions: Assumptions) -> Result<Tabulated, ComplianceError> {
        let mut warnings = Vec::new();
        let uses_ring = assumptions.coupled || self.body == GearBody::Ring;
        let [minimum, maximum] = [LEAST_HARMONICS as f64, MOST_HARMONICS as f64];
        let harmonics = match assumptions.accuracy {
            Some(accuracy) => {
                ring::harmonics((accuracy - ROUNDING).max(ROUNDING), assumptions.coupled, minimum, maximum)
            }
            None => f64::from(self.harmonics),
        };
        let (mut error_estimate, mut evaluations) = (ROUNDING, 0);
        let side = |side| {
            let (compliance, warning) = tabulate_side(self, pair, side, assumptions, harmonics, &mut evaluations)?;
            warnings.extend(warning);
            if uses_ring {
                let ends = [compliance.body.lower(), compliance.body.upper()];
                let share = ends.map(|roll| compliance.body.value(roll) / compliance.total(roll));
                let of_ring = ring::error(harmonics, assumptions.coupled) * share[0].max(share[1]);
                error_estimate = error_estimate.max(ROUNDING + of_ring);
            }
            Ok::<_, ComplianceError>(compliance)
        };
        let [pinion, gear] = of_both(pair, side)?;
        let Assumptions { contact, coupled, .. } = assumptions;
        let compliance = PairCompliance { pinion, gear, contact: Some(contact), plane: Plane::Strain, coupled };
        let work = Work::of(&COMPLIANCE_EVALUATIONS, evaluations);
        Ok(Tabulated { compliance, warnings, error_estimate, meshes: Vec::new(), work })
    }
}

/// The integrals over a tooth up to a load, and the load's angle: everything the beam gives.
#[derive(Clone, Debug)]
pub struct Beam<'a> {
    gear: &'a Gear,
    shear_factor: f64,
    /// Integrals from the clamped end to where `flank` starts.
    root: [f64; 4],
    /// Integrals over the flank, against v = −ln(u_p − u).
    flank: [Series; 4],
    apex_roll: f64,
}

/// Compliances \[m/N\] under a load at one roll angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parts {
    /// By bending, of the strain energy M²/(2EI).
    pub bending: f64,
    /// By shear, times the shear factor.
    pub shear: f64,
    /// By compression along the centreline.
    pub axial: f64,
    /// Distance from the contact point to the tooth's centreline along the load line \[m\].
    pub contact_depth: f64,
}

/// dy/x³ · (1, η, η²) and dy/x with the height η over the base radius, where the arm nearly vanishes under the load.
fn integrands(gear: &Gear, section: Section) -> [f64; 4] {
    let Section { half_thickness: x, height, height_rate } = section;
    let (eta, cubed) = (height - gear.base_radius, height_rate / (x * x * x));
    [cubed, eta * cubed, eta * eta * cubed, height_rate / x]
}

impl<'a> Beam<'a> {
    /// `None` when the flank cannot be integrated to rounding because the tip is almost pointed.
    #[must_use]
    pub fn new(gear: &'a Gear, root: &Root, shear_factor: f64) -> Option<Self> {
        Self::continued(gear, root, shear_factor, root.form_roll)
    }

    /// With the involute continued below its joint with the root, down to the roll angle `lowest`, so that
    /// [`Beam::parts_below`] can end at any section from there up.
    #[must_use]
    pub fn continued(gear: &'a Gear, root: &Root, shear_factor: f64, lowest: f64) -> Option<Self> {
        let rule = GaussLegendre::new(ROOT_POINTS);
        let mut root_integrals = [0.0; 4];
        for piece in &root.pieces {
            let (lower, upper) = piece.range();
            let part = rule.integrate(lower, upper, |parameter| integrands(gear, piece.section(parameter)));
            for (total, value) in root_integrals.iter_mut().zip(part) {
                *total += value;
            }
        }
        let apex_roll = gear.apex_roll();
        let logarithm = |roll: f64| -libm::log(apex_roll - roll);
        let flank = Series::converged(logarithm(lowest.min(root.form_roll)), logarithm(gear.tip_roll()), |v| {
            let distance = libm::exp(-v);
            integrands(gear, gear.flank(apex_roll - distance)).map(|value| value * distance)
        })?;
        let flank = flank.map(|series| series.integral());
        if lowest < root.form_roll {
            let joint = logarithm(root.form_roll);
            for (total, series) in root_integrals.iter_mut().zip(&flank) {
                *total -= series.value(joint);
            }
        }
        Some(Self { gear, shear_factor, root: root_integrals, flank, apex_roll })
    }

    /// The compliances under a load at a roll angle on the involute.
    #[must_use]
    pub fn parts(&self, roll: f64) -> Parts {
        self.parts_below(roll, roll)
    }

    /// What the sections below that of the roll angle `section` give under a load at the roll angle `roll`.
    #[must_use]
    pub fn parts_below(&self, section: f64, roll: f64) -> Parts {
        let v = -libm::log(self.apex_roll - section);
        let mut integrals = self.root;
        for (total, series) in integrals.iter_mut().zip(&self.flank) {
            *total += series.value(v);
        }
        let angle = self.gear.load_angle(roll);
        let (sine, cosine) = libm::sincos(angle);
        // The arm r_b − y cos α_1 as (1 − cos α_1) r_b − η cos α_1, without cancelling.
        let half = libm::sin(0.5 * angle);
        let offset = 2.0 * self.gear.base_radius * half * half;
        let [constant, linear, square, area] = integrals;
        let material = self.gear.specification.material;
        let stretch = material.youngs_modulus * self.gear.specification.face_width;
        let shear = stretch / (2.0 * (1.0 + material.poisson_ratio));
        let moment = offset * offset * constant - 2.0 * offset * cosine * linear + cosine * cosine * square;
        Parts {
            bending: 1.5 * moment / stretch,
            shear: self.shear_factor * cosine * cosine * area / (2.0 * shear),
            axial: sine * sine * area / (2.0 * stretch),
            contact_depth: self.gear.depth_to_centreline(roll),
        }
    }
}

/// The gear body by one of the two theories.
enum Foundation {
    Formula(Body),
    Ring,
}

/// One gear's tables, and a warning.
fn tabulate_side(
    method: &Energy,
    pair: &GearPair,
    side: Side,
    assumptions: Assumptions,
    harmonics: f64,
    evaluations: &mut usize,
) -> Result<(ToothCompliance, Option<String>), ComplianceError> {
    let gear = pair.side(side);
    let root = gear.root(assumptions.root).map_err(|error| ComplianceError::Root(error.on(side)))?;
    let (lower, upper) = (root.form_roll, gear.tip_roll());
    let unresolved = ComplianceError::Unresolved { side, thickness: gear.tip_thickness() };
    let beam = Beam::new(gear, &root, method.shear_factor).ok_or_else(|| unresolved.clone())?;

    let bore_ratio = gear.root_radius / gear.specification.bore_radius;
    let (foundation, warning) = if method.body == GearBody::Ring {
        (Foundation::Ring, None)
    } else {
        let mut body = Body::new(root.half_angle, bore_ratio);
        body.foot = (method.arm == Arm::ClampedEnd).then(|| root.clamped_end(gear).height);
        if !(BORE_RATIOS[0]..=BORE_RATIOS[1]).contains(&bore_ratio) {
            return Err(ComplianceError::BoreOfFormula { side, bore_ratio, range: BORE_RATIOS });
        }
        if root.half_angle < LEAST_HALF_ANGLE {
            let (half_angle, minimum) = (root.half_angle, LEAST_HALF_ANGLE);
            return Err(ComplianceError::ManyTeeth { side, half_angle, minimum });
        }
        let name = if side == Side::Pinion { "pinion" } else { "gear" };
        (Foundation::Formula(body), body.range_warning().map(|warning| format!("{name}: {warning}")))
    };

    let pitch = std::f64::consts::TAU / f64::from(gear.specification.teeth);
    let steps: Vec<f64> = if assumptions.coupled {
        (1..=super::neighbours(pair, side)).map(|k| f64::from(k) * pitch).collect()
    } else {
        Vec::new()
    };
    let ring = Ring::new(gear, root.half_angle).with_harmonics(harmonics);
    let needs_ring = assumptions.coupled || matches!(foundation, Foundation::Ring);
    let offsets: Vec<f64> = std::iter::once(0.0).chain(steps.iter().copied()).collect();
    let influences = if needs_ring { ring.influences(&offsets) } else { Vec::new() };
    let by_ring = |influence: &[[f64; 3]; 3], on: f64, by: f64| {
        ring.compliance(influence, ring.tractions(gear, on), ring.tractions(gear, by))
    };
    let body_at = |roll: f64| match foundation {
        Foundation::Formula(body) => body.compliance(gear, roll),
        Foundation::Ring => by_ring(&influences[0], roll, roll),
    };

    let series = Series::converged(lower, upper, |roll| {
        *evaluations += 1;
        let parts = beam.parts(roll);
        [parts.bending, parts.shear, parts.axial, body_at(roll), parts.contact_depth]
    });
    let [bending, shear, axial, body, contact_depth] = series.ok_or_else(|| unresolved.clone())?;
    let ends = [lower, upper].map(|roll| body.value(roll));
    if let Some(compliance) = body.node_values().into_iter().chain(ends).find(|value| *value <= 0.0) {
        return Err(ComplianceError::NegativeBody { side, compliance, half_angle: root.half_angle, bore_ratio });
    }

    let mut neighbours = Vec::new();
    // The square roots take a few nodes more than the body under its own load.
    let count = body.coefficients().len() + 4;
    for influence in influences.iter().skip(1) {
        neighbours.push(Surface::fit([lower; 2], [upper; 2], [count; 2], |first, further| {
            let cross = by_ring(influence, further, first);
            // The ring says how alike the two roots move, the formula how much: the matrix of all teeth stays
            // positive definite.
            let own = by_ring(&influences[0], first, first) * by_ring(&influences[0], further, further);
            cross / own.sqrt() * (body_at(first) * body_at(further)).sqrt()
        }));
    }
    Ok((
        ToothCompliance { bending, shear, axial, body, contact_depth, corner: 0.0, inclined: None, neighbours },
        warning,
    ))
}
