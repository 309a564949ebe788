//! The root with the least stress, or with the stiffest tooth, at the same root circle and so at the same clearance: an
//! objective by finite elements over the one radius that shapes it.
//!
//! The root is generated (its radius is that of the rack's tip) or an arc tangent to root circle and flank (its own
//! radius). Two constraints keep the pair running: the flank must reach down to where the mate's tip touches it, and the
//! corner of that tip, unbroken, must pass the root (`geometry/tip_path.rs`). Objectives are dimensionless: σ m b/F, and
//! displacement times E b/F. They jump by the meshes' error where the mesh changes, so a search needs no finer tolerance
//! than 1e-3. Must not know: how anything is searched, strength.

use super::{Problem, Stated, Variable, Worth};
use crate::gear::finite_elements::MeshError;
use crate::gear::finite_elements::gear_model::GearModel;
use crate::gear::finite_elements::mesh::Sizing;
use crate::gear::finite_elements::root_stress;
use crate::gear::geometry::error::GeometryError;
use crate::gear::geometry::outline::roots::Toe;
use crate::gear::geometry::root::{Root, RootShape};
use crate::gear::geometry::tip_path::{Corner, TipPath};
use crate::gear::geometry::{Gear, GearPair, Side, trochoid};
use crate::gear::material::Plane;
use declare::units::{Dimension, LENGTH, RATIO};
use declare::{Declared, Words};

/// Which root, and what is free of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Words)]
pub enum FreeRoot {
    /// generated; the rack's tip radius is free
    #[default]
    Rack,
    /// an arc tangent to root circle and flank; its radius is free
    Arc,
}

/// What is to be small.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Words)]
pub enum Objective {
    /// the largest tension along the root's surface
    #[default]
    Stress,
    /// the displacement of the loaded tooth
    Compliance,
}

/// Where the load acts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Words)]
pub enum LoadPoint {
    /// at the outer point of single contact
    #[default]
    SingleContact,
    /// at the tip
    Tip,
}

/// The root with the least stress, or the stiffest tooth, at the same clearance, by finite elements.
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "fillet")]
pub struct FilletProblem {
    /// which root, and what is free of it
    #[declared(default = "rack")]
    pub root: FreeRoot,
    /// what is to be small
    #[declared(default = "stress")]
    pub minimize: Objective,
    /// where the load acts
    #[declared(default = "single_contact")]
    pub load: LoadPoint,
    /// the plane state of the gear
    #[declared(default = "strain")]
    pub plane: Plane,
    /// elements across a tooth, an even number
    #[declared(minimum = 6, maximum = 64, multiple = 2, default = "12")]
    pub elements_across: u32,
}

impl Stated for FilletProblem {
    fn dimension(&self) -> Dimension {
        RATIO
    }

    fn maximum(&self) -> [usize; 2] {
        [1, 2]
    }

    // Assembling and solving grow with the square of the elements across; at a dozen it is a fiftieth of a second.
    fn seconds(&self) -> f64 {
        0.02 * (f64::from(self.elements_across) / 12.0).powi(2)
    }

    fn on(&self, pair: &GearPair, side: Side) -> Result<Box<dyn Problem>, GeometryError> {
        let gear = pair.side(side);
        Ok(Box::new(Fillet {
            gear: gear.clone(),
            stated: self.clone(),
            roll: match self.load {
                LoadPoint::Tip => gear.flank_end.roll,
                LoadPoint::SingleContact => single_contact(pair, side),
            },
            active_radius: gear.radius_at(pair.lowest_roll(side)),
            tip: TipPath::new(pair, side, vec![Corner::of(pair.side(side.other()))]),
        }))
    }
}

/// Parts of the elements of a mesh that is graded to the fillet.
const PARTS: usize = 2;
/// The smallest radius that is tried, as a share of the largest; a sharp root has no finite stress.
const LEAST_SHARE: f64 = 0.1;

/// The gear's roll angle at the end of single contact that is nearer to its tip; the tip where contact is never single.
fn single_contact(pair: &GearPair, side: Side) -> f64 {
    let s = match side {
        Side::Pinion => (pair.start_of_contact + pair.base_pitch).min(pair.end_of_contact),
        Side::Gear => (pair.end_of_contact - pair.base_pitch).max(pair.start_of_contact),
    };
    if pair.contact_ratio < 2.0 { pair.roll(side, s) } else { pair.side(side).flank_end.roll }
}

struct Fillet {
    gear: Gear,
    stated: FilletProblem,
    roll: f64,
    /// Radius that the mate's tip reaches.
    active_radius: f64,
    tip: TipPath,
}

impl Fillet {
    fn arc(&self) -> bool {
        self.stated.root == FreeRoot::Arc
    }

    /// The gear and the root of a radius \[m\].
    fn shaped(&self, radius: f64) -> Result<(Gear, Root), GeometryError> {
        if self.arc() {
            return Ok((self.gear.clone(), self.gear.fillet(radius)?));
        }
        let given = self.gear.specification;
        let gear = Gear::new(&given.with_tool_tip_radius(radius / given.module))?.with_tip(self.gear.tip)?;
        let root = gear.root(RootShape::Trochoid)?;
        Ok((gear, root))
    }

    fn objective(&self, gear: &Gear, root: &Root) -> Result<f64, MeshError> {
        let across = self.stated.elements_across as usize;
        let sizing = match self.stated.minimize {
            Objective::Stress => Sizing::graded(across, PARTS),
            Objective::Compliance => Sizing::even(across),
        };
        let model = GearModel::new(gear, root, self.stated.plane, &sizing)?;
        if self.stated.minimize == Objective::Compliance {
            return Ok(model.influences(&[self.roll], 0)?.own[0]);
        }
        let points = model.root_stresses(&[self.roll])?;
        Ok(points.first().and_then(|points| root_stress::largest(points)).map_or(f64::NAN, |(stress, _)| stress))
    }

    /// How much lower the flank reaches than it must, and how far the mate's tip stays from the root.
    fn constraints(&self, gear: &Gear, root: &Root) -> Vec<f64> {
        let passed = self.tip.distance(&Toe::of(root).segments);
        vec![self.active_radius - gear.radius_at(root.form_roll), passed]
    }
}

impl Problem for Fillet {
    fn variables(&self) -> Vec<Variable> {
        let given = self.gear.specification;
        let largest = if self.arc() { self.gear.largest_fillet() } else { given.module * trochoid::full_round(&given) };
        let maximum = largest * (1.0 - 1e-9);
        vec![Variable {
            name: if self.arc() { "radius" } else { "rack_tip_radius" },
            dimension: LENGTH,
            minimum: LEAST_SHARE * maximum,
            maximum,
        }]
    }

    fn constraints(&self) -> &'static [&'static str] {
        &["flank reaches below the mate's tip", "mate's tip passes the root"]
    }

    fn worth(&self, point: &[f64]) -> Worth {
        let Ok((gear, root)) = self.shaped(point[0]) else {
            return Worth { objective: f64::INFINITY, further: Vec::new(), constraints: vec![f64::NAN; 2] };
        };
        let objective = self.objective(&gear, &root).unwrap_or(f64::INFINITY);
        Worth { objective, further: Vec::new(), constraints: self.constraints(&gear, &root) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gear::fixtures::pair_with_contact_ratio;
    use crate::gear::geometry::{Rack, Specification};
    use crate::gear::material::Material;

    fn pair(shift: f64) -> GearPair {
        let gear = |teeth, profile_shift| Specification {
            teeth,
            module: 3e-3,
            pressure_angle: 20_f64.to_radians(),
            profile_shift,
            thickness_allowance: 0.0,
            cutter: None,
            rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.25, ..Rack::ISO_53_A },
            tip_radius: None,
            face_width: 0.02,
            bore_radius: 0.012,
            material: Material::STEEL,
        };
        GearPair::new(gear(25, shift), gear(40, 0.1), None).unwrap()
    }

    fn problem(pair: &GearPair, side: Side, root: FreeRoot, minimize: Objective) -> Box<dyn Problem> {
        let load = LoadPoint::Tip;
        FilletProblem { root, minimize, load, elements_across: 6, ..FilletProblem::default() }.on(pair, side).unwrap()
    }

    /// Tier: invariant. The rack that generates the root leaves room for a mate of any size.
    #[test]
    fn a_generated_root_keeps_the_constraints() {
        let pair = pair(0.0);
        for side in [Side::Pinion, Side::Gear] {
            let problem = problem(&pair, side, FreeRoot::Rack, Objective::Compliance);
            let [variable] = problem.variables()[..] else { panic!("one variable") };
            for share in [0.1, 0.5, 0.9] {
                let radius = variable.minimum + share * (variable.maximum - variable.minimum);
                let worth = problem.worth(&[radius]);
                assert!(worth.constraints.iter().all(|value| *value > 0.0), "{side:?} {share}: {worth:?}");
            }
        }
    }

    /// Tier: invariant. Rounder is less stressed and stiffer; large arcs reach up to where the mate touches.
    #[test]
    fn rounder_roots_are_less_stressed_until_the_mate_is_in_the_way() {
        let pair = pair(0.0);
        for minimize in [Objective::Stress, Objective::Compliance] {
            for root in [FreeRoot::Rack, FreeRoot::Arc] {
                let problem = problem(&pair, Side::Pinion, root, minimize);
                let [variable] = problem.variables()[..] else { panic!("one variable") };
                let [small, large] = [0.2, 0.9]
                    .map(|share| problem.worth(&[variable.minimum + share * (variable.maximum - variable.minimum)]));
                assert!(large.objective < small.objective, "{root:?} {minimize:?}: {small:?} {large:?}");
                assert!(large.constraints.iter().zip(&small.constraints).all(|(a, b)| a < b), "{root:?}: {large:?}");
            }
        }
    }

    /// Tier: closed form; a pitch before its end of single contact the pinion's tooth comes into contact, and the gear's a
    /// pitch after it leaves. Where contact is never single, the tip carries alone.
    #[test]
    fn single_contact_ends_a_pitch_from_the_end_of_the_path() {
        let pair = pair(0.0);
        let s = single_contact(&pair, Side::Pinion) * pair.pinion.base_radius - pair.base_pitch;
        assert!((s - pair.start_of_contact).abs() < 1e-16, "{s}");
        let s = pair.tangent_length - single_contact(&pair, Side::Gear) * pair.gear.base_radius + pair.base_pitch;
        assert!((s - pair.end_of_contact).abs() < 1e-16, "{s}");
        for (ratio, single) in [(1.6, true), (1.99, true), (2.01, false), (2.3, false)] {
            let pair = pair_with_contact_ratio(ratio);
            let rolls =
                [Side::Pinion, Side::Gear].map(|side| (single_contact(&pair, side), pair.side(side).tip_roll()));
            assert!(rolls.iter().all(|(roll, tip)| (*roll < tip - 1e-6) == single), "{ratio}: {rolls:?}");
        }
    }

    /// Tier: invariant; both bounds can be built, at the largest arc neighbours meet and at the largest round the rack has
    /// no land. Stresses hardly know the plane state (Michell: not at all where nothing is held), compliances do, by about
    /// 1 - ν² = 0.91.
    #[test]
    fn what_is_free_reaches_as_far_as_there_is_room() {
        let pair = pair(0.0);
        let teeth = f64::from(pair.pinion.specification.teeth);
        for (root, name) in [(FreeRoot::Rack, "rack_tip_radius"), (FreeRoot::Arc, "radius")] {
            for (minimize, ratio) in [(Objective::Stress, 0.97..1.03), (Objective::Compliance, 0.87..0.95)] {
                let stated =
                    |plane| FilletProblem { root, minimize, plane, elements_across: 6, ..FilletProblem::default() };
                let on = |plane| stated(plane).on(&pair, Side::Pinion).unwrap();
                let (problem, thin) = (on(Plane::Strain), on(Plane::Stress));
                let [variable] = problem.variables()[..] else { panic!("one variable") };
                assert_eq!(variable.name, name);
                assert_eq!(stated(Plane::Strain).maximum(), [problem.variables().len(), problem.constraints().len()]);
                for radius in [variable.minimum, variable.maximum] {
                    let worth = problem.worth(&[radius]);
                    let found = worth.objective / thin.worth(&[radius]).objective;
                    assert!(ratio.contains(&found), "{root:?} {minimize:?} {radius}: {found}");
                    assert_eq!(worth.constraints.len(), problem.constraints().len());
                }
                assert!(problem.worth(&[1.01 * variable.maximum]).objective.is_infinite(), "{root:?}");
                if root == FreeRoot::Arc {
                    let meet = pair.pinion.fillet(variable.maximum).unwrap();
                    assert!((meet.half_angle * teeth / std::f64::consts::PI - 1.0).abs() < 1e-6);
                } else {
                    // ρ cos α = (c_land/2) of a rack whose tip is one arc: π/4 − h tan α = ρ (1 − sin α)/cos α.
                    let (sine, cosine) = 20_f64.to_radians().sin_cos();
                    let full = (std::f64::consts::FRAC_PI_4 - 1.25 * sine / cosine) * cosine / (1.0 - sine) * 3e-3;
                    assert!((variable.maximum / full - 1.0).abs() < 1e-8, "{} {full}", variable.maximum);
                }
            }
        }
    }

    /// Tier: second way; the flank begins where a gear that was made with this rack has it begin.
    #[test]
    fn the_radius_is_that_of_the_rack_s_tip() {
        let pair = pair(0.0);
        let problem = problem(&pair, Side::Pinion, FreeRoot::Rack, Objective::Compliance);
        for tip_radius in [0.1, 0.3, 0.4] {
            let rack = Rack { tip_radius, ..pair.pinion.specification.rack };
            let made = Gear::new(&Specification { rack, ..pair.pinion.specification }).unwrap();
            let active = pair.pinion.radius_at(pair.lowest_roll(Side::Pinion));
            let deeper = problem.worth(&[tip_radius * 3e-3]).constraints[0];
            assert!((deeper - (active - made.form_radius)).abs() < 1e-12, "{tip_radius}: {deeper}");
        }
    }
}
