//! The root with the least stress, or with the stiffest tooth, at the same root circle and so at the same clearance: an
//! objective by finite elements over the one radius that shapes it.
//!
//! The root is generated (its radius is that of the rack's tip) or an arc tangent to root circle and flank (its own
//! radius). Two constraints keep the pair running: the flank must reach down to where the mate's tip touches it, and the
//! corner of that tip must pass the root. A mate's corner at the angle β from the line of centres is at R² = a² + r_a²
//! − 2 a r_a cos β from the gear's centre, so where it passes a point of the root is known in closed form; source: Litvin
//! and Fuentes, Gear Geometry and Applied Theory (2004), section 10.9 (the extended epicycloid of the tip). Objectives are
//! dimensionless: σ m b/F, and displacement times E b/F. They jump by the meshes' error where the mesh changes, so a search
//! needs no finer tolerance than 1e-3. Must not know: how anything is searched, strength.

use std::f64::consts::PI;

use super::{Family, Problem, Variable, Worth};
use crate::base::parameter::{Choice, Field, Member};
use crate::base::units::RATIO;
use crate::gear::finite_elements::MeshError;
use crate::gear::finite_elements::element::{PLANES, Plane};
use crate::gear::finite_elements::gear_model::GearModel;
use crate::gear::finite_elements::mesh::Sizing;
use crate::gear::finite_elements::root_stress;
use crate::gear::geometry::error::GeometryError;
use crate::gear::geometry::root::{Root, RootShape};
use crate::gear::geometry::{Gear, Pair, Rack, Side, Specification, trochoid};

pub const FAMILY: Family = Family {
    member: Member {
        name: "fillet",
        summary: "The root with the least stress, or the stiffest tooth, at the same clearance, by finite elements.",
        fields: FIELDS,
    },
    dimension: RATIO,
    build: |record, pair, side| {
        let across = usize::try_from(record.integer("elements_across")).unwrap_or(MOST_ACROSS);
        let tip = record.choice("load") == "tip";
        Ok(Box::new(Fillet {
            gear: pair.side(side).clone(),
            arc: record.choice("root") == "arc",
            stress: record.choice("minimize") == "stress",
            plane: if record.choice("plane") == "stress" { Plane::Stress } else { Plane::Strain },
            across: across.next_multiple_of(2),
            roll: if tip { pair.side(side).tip_roll() } else { single_contact(pair, side) },
            mate: Mate::new(pair, side),
        }))
    },
};

const MOST_ACROSS: usize = 64;

const FIELDS: &[Field] = &[
    Field::choice("root", ROOTS, "which root, and what is free of it").default("rack"),
    Field::choice("minimize", OBJECTIVES, "what is to be small").default("stress"),
    Field::choice("load", LOADS, "where the load acts").default("single_contact"),
    Field::choice("plane", PLANES, "the plane state of the gear").default("strain"),
    Field::integer("elements_across", 6, 64, "elements across a tooth, taken as an even number").default("12"),
];

const ROOTS: &[Choice] = &[
    Choice { name: "rack", summary: "generated; the rack's tip radius is free" },
    Choice { name: "arc", summary: "an arc tangent to root circle and flank; its radius is free" },
];

const OBJECTIVES: &[Choice] = &[
    Choice { name: "stress", summary: "the largest tension along the root's surface" },
    Choice { name: "compliance", summary: "the displacement of the loaded tooth" },
];

const LOADS: &[Choice] = &[
    Choice { name: "single_contact", summary: "at the outer point of single contact" },
    Choice { name: "tip", summary: "at the tip" },
];

/// The smallest radius that is tried, as a share of the largest; a sharp root has no finite stress.
const LEAST_SHARE: f64 = 0.1;

/// Points of each curve of a root at which the mate's tip must pass it.
const PASSED: usize = 64;

/// The gear's roll angle at the end of single contact that is nearer to its tip; the tip where contact is never single.
fn single_contact(pair: &Pair, side: Side) -> f64 {
    let s = match side {
        Side::Pinion => (pair.start_of_contact + pair.base_pitch).min(pair.end_of_contact),
        Side::Gear => (pair.end_of_contact - pair.base_pitch).max(pair.start_of_contact),
    };
    if pair.contact_ratio < 2.0 { pair.roll(side, s) } else { pair.side(side).tip_roll() }
}

/// What the other gear's tip asks for.
struct Mate {
    centre_distance: f64,
    tip_radius: f64,
    tip_half_angle: f64,
    /// z_1/z_2: how far the mate turns while the gear turns by 1.
    ratio: f64,
    half_pitch: f64,
    /// Half the backlash, as an angle of the gear.
    slack: f64,
    /// Radius on the gear that its tip reaches.
    active_radius: f64,
}

impl Mate {
    fn new(pair: &Pair, side: Side) -> Self {
        let (own, mate, lowest) = match side {
            Side::Pinion => (&pair.pinion, &pair.gear, pair.start_of_contact),
            Side::Gear => (&pair.gear, &pair.pinion, pair.end_of_contact),
        };
        let half_pitch = PI / f64::from(own.specification.teeth);
        let ratio = f64::from(own.specification.teeth) / f64::from(mate.specification.teeth);
        let working = libm::tan(pair.working_pressure_angle);
        let space = half_pitch - own.half_angle_at_roll(working);
        Self {
            centre_distance: pair.centre_distance,
            tip_radius: mate.tip_radius,
            tip_half_angle: mate.half_angle_at_roll(mate.tip_roll()),
            ratio,
            half_pitch,
            slack: space - mate.half_angle_at_roll(working) / ratio,
            active_radius: own.radius_at(pair.roll(side, lowest)),
        }
    }

    /// How far the corner of the mate's tip stays from a point of the gear's right flank or root, along the
    /// circumference, while the flanks touch \[m\]; infinite where it never comes so low.
    fn passes(&self, [half_thickness, height]: [f64; 2]) -> f64 {
        let radius = libm::hypot(half_thickness, height);
        let (a, tip) = (self.centre_distance, self.tip_radius);
        let cosine = (a * a + tip * tip - radius * radius) / (2.0 * a * tip);
        if cosine > 1.0 {
            return f64::INFINITY;
        }
        let room = self.half_pitch - libm::atan2(half_thickness, height);
        let corner = |beta: f64| {
            let (sine, cosine) = libm::sincos(beta);
            let turned = (beta - self.tip_half_angle) / self.ratio;
            libm::atan2(tip * sine, a - tip * cosine) - turned + self.slack
        };
        let beta = libm::acos(cosine.max(-1.0));
        radius * (room - corner(beta).max(corner(-beta)))
    }
}

struct Fillet {
    gear: Gear,
    arc: bool,
    stress: bool,
    plane: Plane,
    across: usize,
    roll: f64,
    mate: Mate,
}

impl Fillet {
    /// The gear and the root of a radius \[m\].
    fn shaped(&self, radius: f64) -> Result<(Gear, Root), GeometryError> {
        if self.arc {
            return Ok((self.gear.clone(), self.gear.fillet(radius)?));
        }
        let given = self.gear.specification;
        let rack = Rack { tip_radius: radius / given.module, ..given.rack };
        let gear = Gear::new(&Specification { rack, ..given })?;
        let root = gear.root(RootShape::Trochoid)?;
        Ok((gear, root))
    }

    fn objective(&self, gear: &Gear, root: &Root) -> Result<f64, MeshError> {
        let model = GearModel::new(gear, root, self.plane, &Sizing::even(self.across))?;
        if !self.stress {
            return Ok(model.influences(&[self.roll], 0)?.own[0]);
        }
        let points = model.root_stresses(&[self.roll])?;
        Ok(points.first().and_then(|points| root_stress::largest(points)).map_or(f64::NAN, |(stress, _)| stress))
    }

    /// How much lower the flank reaches than it must, and how far the mate's tip stays from the root.
    fn constraints(&self, gear: &Gear, root: &Root) -> Vec<f64> {
        let place = |piece: &crate::gear::geometry::root::Piece, step: usize| {
            let (from, to) = piece.range();
            let section = piece.section(from + (to - from) * (step as f64 / PASSED as f64));
            self.mate.passes([section.half_thickness, section.height])
        };
        let passed = root.pieces.iter().flat_map(|piece| (0..=PASSED).map(move |step| place(piece, step)));
        // Nothing comes near a root that the mate does not reach; a module is as good as any distance.
        let nearest = passed.fold(gear.specification.module, f64::min);
        vec![self.mate.active_radius - gear.radius_at(root.form_roll), nearest]
    }
}

impl Problem for Fillet {
    fn variables(&self) -> Vec<Variable> {
        let given = self.gear.specification;
        let largest = if self.arc { self.gear.largest_fillet() } else { given.module * trochoid::full_round(&given) };
        let most = largest * (1.0 - 1e-9);
        vec![Variable { name: if self.arc { "radius" } else { "rack_tip_radius" }, least: LEAST_SHARE * most, most }]
    }

    fn constraints(&self) -> &'static [&'static str] {
        &["flank reaches below the mate's tip", "mate's tip passes the root"]
    }

    fn worth(&self, point: &[f64]) -> Worth {
        let Ok((gear, root)) = self.shaped(point[0]) else {
            return Worth { objective: f64::INFINITY, constraints: vec![f64::NAN; 2] };
        };
        let objective = self.objective(&gear, &root).unwrap_or(f64::INFINITY);
        Worth { objective, constraints: self.constraints(&gear, &root) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::error::Place;
    use crate::base::record::{Entry, Record, Value};
    use crate::gear::material::Material;

    fn pair(shift: f64) -> Pair {
        let gear = |teeth, profile_shift| Specification {
            teeth,
            module: 3e-3,
            pressure_angle: 20_f64.to_radians(),
            profile_shift,
            rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.25 },
            tip_radius: None,
            face_width: 0.02,
            bore_radius: 0.012,
            material: Material { youngs_modulus: 206e9, poisson_ratio: 0.3 },
        };
        Pair::new(gear(25, shift), gear(40, 0.1), None).unwrap()
    }

    fn problem(pair: &Pair, side: Side, given: &[(&'static str, &'static str)]) -> Box<dyn Problem> {
        let place = Place::default();
        let entry = |value| Entry { value, place };
        let chosen =
            |name: &str, usual| given.iter().find(|(field, _)| *field == name).map_or(usual, |(_, word)| *word);
        let words = [("root", "rack"), ("minimize", "stress"), ("load", "tip"), ("plane", "strain")];
        let mut fields: Vec<_> =
            words.into_iter().map(|(name, usual)| (name, entry(Value::Choice(chosen(name, usual))))).collect();
        fields.push(("elements_across", entry(Value::Integer(6))));
        (FAMILY.build)(&Record { fields, place }, pair, side).unwrap()
    }

    /// Tier: second way. Where the mate's tip begins to touch, its corner is on the involute; above, it is off it.
    #[test]
    fn the_corner_of_the_mate_s_tip_is_on_the_flank_where_contact_begins() {
        for shift in [0.0, 0.35] {
            let pair = pair(shift);
            for side in [Side::Pinion, Side::Gear] {
                let mate = Mate::new(&pair, side);
                let gear = pair.side(side);
                let place = |radius: f64| {
                    let section = gear.flank(((radius / gear.base_radius).powi(2) - 1.0).sqrt());
                    [section.half_thickness, section.height]
                };
                let at = mate.passes(place(mate.active_radius));
                assert!(at.abs() < 1e-15, "{side:?} {at:e}");
                for above in [1.01, 1.03] {
                    let off = mate.passes(place(mate.active_radius * above));
                    assert!(off > 1e-6, "{side:?} {above}: {off:e}");
                }
                assert!(mate.passes([0.0, pair.centre_distance - mate.tip_radius - 1e-6]).is_infinite());
            }
        }
    }

    /// Tier: invariant. The rack that generates the root leaves room for a mate of any size.
    #[test]
    fn a_generated_root_keeps_the_constraints() {
        let pair = pair(0.0);
        for side in [Side::Pinion, Side::Gear] {
            let problem = problem(&pair, side, &[("minimize", "compliance")]);
            let [variable] = problem.variables()[..] else { panic!("one variable") };
            for share in [0.1, 0.5, 0.9] {
                let radius = variable.least + share * (variable.most - variable.least);
                let worth = problem.worth(&[radius]);
                assert!(worth.constraints.iter().all(|value| *value > 0.0), "{side:?} {share}: {worth:?}");
            }
        }
    }

    /// Tier: invariant. Rounder is less stressed and stiffer; large arcs reach up to where the mate touches.
    #[test]
    fn rounder_roots_are_less_stressed_until_the_mate_is_in_the_way() {
        let pair = pair(0.0);
        for minimize in ["stress", "compliance"] {
            for root in ["rack", "arc"] {
                let problem = problem(&pair, Side::Pinion, &[("root", root), ("minimize", minimize)]);
                let [variable] = problem.variables()[..] else { panic!("one variable") };
                let [small, large] =
                    [0.2, 0.9].map(|share| problem.worth(&[variable.least + share * (variable.most - variable.least)]));
                assert!(large.objective < small.objective, "{root} {minimize}: {small:?} {large:?}");
                assert!(large.constraints.iter().zip(&small.constraints).all(|(a, b)| a < b), "{root}: {large:?}");
            }
        }
    }
}
