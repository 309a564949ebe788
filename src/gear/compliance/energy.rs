//! The energy method: a tooth as a cantilever of variable section on an elastic body.
//!
//! Bending, shear and axial compression after `energy_ga` (section "Analytical calculation of mesh stiffness"), with
//! the arm in its closed form r_b − y cos a1; the body after Sainsot; neighbours through the body by the ring. Compliances
//! in m/N over the tooth's whole face width. Must not know: micro-geometry, load.

use std::f64::consts::PI;

use crate::base::parameter::Member;
use crate::base::record::Record;
use crate::gear::compliance::ring::{Load, Ring};
use crate::gear::compliance::sainsot::Body;
use crate::gear::compliance::sections::Sections;
use crate::gear::compliance::{ComplianceError, Method, Setting, ToothCompliance};
use crate::gear::geometry::root::Root;
use crate::gear::geometry::{Gear, Pair, Side};
use crate::numeric::chebyshev::Series;

pub const METHOD: Method = Method {
    member: Member {
        name: "energy",
        summary: "Strain energy of a cantilever of variable section on an elastic body (Sainsot); plane stress.",
        fields: &[],
    },
    tooth: |_: &Record, pair, side, setting| tabulate(pair, side, setting),
};

/// Shear factor of a rectangular section.
const SHEAR_FACTOR: f64 = 1.2;
/// Nodes in roll angle; 1e-12 relative on every gear the tests try.
const NODES: usize = 40;

/// One tooth, ready to be loaded anywhere on its flank.
pub struct Tooth {
    sections: Sections,
    body: Body,
    base_radius: f64,
    half_base_angle: f64,
    clamped_height: f64,
    /// 1/(E b) and 1/(G b).
    per_modulus: f64,
    per_shear_modulus: f64,
}

/// 1/k_b, 1/k_s, 1/k_a, 1/k_f \[m/N\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Components {
    pub bending: f64,
    pub shear: f64,
    pub axial: f64,
    pub body: f64,
}

impl Tooth {
    #[must_use]
    pub fn new(gear: &Gear, root: &Root) -> Self {
        let material = gear.specification.material;
        let per_modulus = 1.0 / (material.youngs_modulus * gear.specification.face_width);
        Self {
            sections: Sections::new(gear, root),
            body: Body::new(gear, root),
            base_radius: gear.base_radius,
            half_base_angle: gear.half_base_angle,
            clamped_height: root.clamped_height,
            per_modulus,
            per_shear_modulus: 2.0 * (1.0 + material.poisson_ratio) * per_modulus,
        }
    }

    /// The compliances with the load at a roll angle.
    #[must_use]
    pub fn components(&self, roll: f64) -> Components {
        let angle = roll - self.half_base_angle;
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        let [inertia, first, second, area] = self.sections.up_to(roll);
        // The arm at the clamped section; counted from there the sum does not cancel.
        let arm = self.base_radius - self.clamped_height * cos;
        Components {
            bending: self.per_modulus * (arm * arm * inertia - 2.0 * arm * cos * first + cos * cos * second),
            shear: self.per_shear_modulus * SHEAR_FACTOR * cos * cos * area,
            axial: self.per_modulus * sin * sin * area,
            body: self.body.compliance(roll),
        }
    }
}

fn tabulate(pair: &Pair, side: Side, setting: &Setting) -> Result<(ToothCompliance, Vec<String>), ComplianceError> {
    let gear = pair.side(side);
    let root = Root::new(gear, setting.root);
    let tooth = Tooth::new(gear, &root);
    let warnings = tooth.body.warning(side.name()).into_iter().collect();
    let deepest = match side {
        Side::Pinion => pair.roll(side, pair.start_of_contact),
        Side::Gear => pair.roll(side, pair.end_of_contact),
    };
    let (lower, upper) = (deepest, gear.roll_at(gear.tip_radius));
    if lower < root.junction_roll - 1e-9 {
        return Err(ComplianceError::Root {
            gear: side.name(),
            reached: gear.radius_at(lower),
            starts: gear.radius_at(root.junction_roll),
        });
    }
    let lower = lower.max(root.junction_roll);
    let fit =
        |component: fn(Components) -> f64| Series::fit(lower, upper, NODES, |roll| component(tooth.components(roll)));
    let compliance = ToothCompliance {
        bending: fit(|c| c.bending),
        shear: fit(|c| c.shear),
        axial: fit(|c| c.axial),
        body: fit(|c| c.body),
        contact_depth: Series::fit(lower, upper, NODES, |roll| {
            let angle = roll - gear.half_base_angle;
            gear.base_radius * (roll - libm::tan(angle))
        }),
        neighbours: if setting.coupled {
            neighbours(pair, gear, &root, &tooth.body, (lower, upper))
        } else {
            Vec::new()
        },
    };
    let worst = compliance.body.node_values().into_iter().fold(f64::INFINITY, f64::min);
    if worst.is_nan() || worst <= 0.0 {
        let Body { radius_ratio, half_angle, .. } = tooth.body;
        return Err(ComplianceError::Body { gear: side.name(), radius_ratio, half_angle });
    }
    Ok((compliance, warnings))
}

/// The ring gives how strongly two teeth are correlated, Sainsot's formula how much each moves: their product keeps
/// the matrix positive definite and agrees with the formula on the diagonal.
fn neighbours(pair: &Pair, gear: &Gear, root: &Root, body: &Body, (lower, upper): (f64, f64)) -> Vec<Series> {
    let ring =
        Ring::new(gear.specification.bore_radius, gear.root_radius, root.half_angle, &gear.specification.material);
    let load = |roll: f64| {
        let angle = roll - gear.half_base_angle;
        Load { across: libm::cos(angle), outwards: -libm::sin(angle), moment: gear.base_radius }
    };
    let pitch = 2.0 * PI / f64::from(gear.specification.teeth);
    let own = ring.influence(0.0);
    let mut series = Vec::new();
    let mut apart = 1.0;
    while pair.contact_ratio > apart && lower + apart * pitch < upper {
        let angle = apart * pitch;
        let across = ring.influence(angle);
        series.push(Series::fit(lower, upper - angle, NODES / 2, |roll| {
            let (behind, ahead) = (load(roll), load(roll + angle));
            let alone = own.compliance(behind, behind) * own.compliance(ahead, ahead);
            let correlation = across.compliance(ahead, behind) / alone.sqrt();
            correlation * (body.compliance(roll) * body.compliance(roll + angle)).sqrt()
        }));
        apart += 1.0;
    }
    series
}
