//! The finite-element method: tooth and gear body as one elastic body, the whole gear, clamped at its bore.
//!
//! `finite_elements` gives the influences of unit loads on a flank; here they become the pair's tables. What a load does
//! to its own tooth is one number, so all of it is in `body`, and bending, shear and compression are zero. With resolved
//! contact it is the displacement of the loaded point beside that of a half plane; otherwise that of the centreline along
//! the load line, to which the contact law adds the approach of the flank, over the depth `contact_depth`. Either way
//! nothing is counted twice. Must not know: how it is solved.

mod inclined;
mod roots;
mod solution;
#[cfg(test)]
mod tests;

use std::f64::consts::PI;

use self::inclined::AtTip;
use self::solution::{LEFT, Solution};
use super::inclined::Inclined;
use super::{
    Assumptions, ComplianceError, ContactLaw, Foreseen, MeshFacts, Method, PairCompliance, RootInfluences,
    RootStresses, Tabulated, ToothCompliance, neighbours, of_both,
};
use crate::gear::contact::wedge;
use crate::gear::finite_elements::MeshError;
use crate::gear::finite_elements::gear_model::{FlankLoad, GearModel, Influences};
use crate::gear::finite_elements::mesh::Sizing;
use crate::gear::geometry::root::Root;
use crate::gear::geometry::{Gear, GearPair, Side};
use crate::gear::material::Plane;
use crate::gear::work::{COMPLIANCE_EVALUATIONS, MESH_FACTORISATIONS};
use crate::numeric::chebyshev::{Series, nodes};
use crate::numeric::surface::Surface;
use declare::Declared;
use declare::work::Work;

/// Nodes along the flank: interpolation between them is exact to 1e-4, which a test holds.
const ROLLS: usize = 16;
/// The same of resolved contact: nearer to the corner of the tip meshes are off by more than what lies between fewer nodes.
const RESOLVED_ROLLS: usize = 12;
/// The fewest elements across that still make a mesh.
const LEAST: usize = 4;
const MOST_ELEMENTS: usize = 64;
/// ν up to which plane strain does not lock.
const MOST_POISSON: f64 = 0.49;
/// The order that the error estimate counts on where nothing is extrapolated; 2 to 4 are observed.
const ORDER: f64 = 1.5;
/// The distance from a resolved contact, in modules, at which the surface's displacement is the tooth's: far for any contact,
/// and so near that what is left for the tooth is positive.
const LENGTH: f64 = 0.25;
/// Parts of an element of the mesh half as fine, in each direction.
const HALVED: usize = 2;
/// Rows of the body in another block of a resolved load: what it gives must not depend on it.
const OTHER_BLOCK: usize = 1;
/// The least chamfer or rounding of a tip \[modules\]: it is smaller than the elements there, and than contacts are.
const LEAST_TIP_BREAK: f64 = 0.01;
/// Every so many loads have that block too.
const OTHER_LOADS: usize = 5;

/// Plane finite elements of the whole gear: teeth and body as one.
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "finite_element")]
pub struct FiniteElement {
    /// the plane state of the gear
    #[declared(default = "strain")]
    pub plane: Plane,
    /// elements across a tooth, an even number; all other sizes follow from it; where an accuracy is wanted, from how many
    /// on
    #[declared(minimum = 6, maximum = 64, multiple = 2, default = "16")]
    pub elements_across: u32,
}

/// Elements across with which a factorisation takes the usual time; it grows with their square.
const USUAL: f64 = 8.0;
/// Bytes that a mesh takes over the square of its elements across: 58,000 to 67,000 were measured with 6 to 48.
const MESH_BYTES: usize = 100_000;

impl Method for FiniteElement {
    fn needs_fillet(&self) -> bool {
        true
    }

    fn usual_contact(&self) -> ContactLaw {
        ContactLaw::Resolved
    }

    fn knows(&self, _contact: ContactLaw) -> bool {
        true
    }

    fn tabulate(&self, pair: &GearPair, assumptions: Assumptions) -> Result<Tabulated, ComplianceError> {
        let mut work = Work::NONE;
        let side = |side| {
            let task = Task::new(self, pair, side, assumptions)?;
            let (solution, facts) = task.solve(&mut work)?;
            Ok::<_, ComplianceError>((task.tables(&solution)?, facts))
        };
        let [(pinion, of_pinion), (gear, of_gear)] = of_both(pair, side)?;
        let meshes = vec![of_pinion, MeshFacts { side: Side::Gear, ..of_gear }];
        let Assumptions { contact, coupled, .. } = assumptions;
        let error_estimate = meshes.iter().map(|mesh| mesh.error_estimate).fold(0.0, f64::max);
        let compliance = PairCompliance { pinion, gear, contact: Some(contact), plane: self.plane, coupled };
        Ok(Tabulated { compliance, warnings: Vec::new(), error_estimate, meshes, work })
    }

    fn foresee(&self, assumptions: Assumptions) -> Foreseen {
        let told = self.elements_across as usize;
        // Each gear with its mesh and one half as fine; where an accuracy is wanted, finer ones may follow.
        let (finest, rounds) = if assumptions.accuracy.is_some() { (MOST_ELEMENTS, 2) } else { (told, 1) };
        let meshes = 4 * rounds;
        let neighbours = if assumptions.coupled { 6 * ROLLS * ROLLS } else { 0 };
        Foreseen {
            nodes: 48,
            neighbours,
            work: Work::of(&MESH_FACTORISATIONS, meshes).with(&COMPLIANCE_EVALUATIONS, meshes * ROLLS),
            times: (told as f64 / USUAL).powi(2),
            memory: (finest * finest * MESH_BYTES) as u64,
        }
    }

    fn root_stresses(&self) -> Option<&dyn RootStresses> {
        Some(self)
    }
}

impl RootStresses for FiniteElement {
    fn foresee_influences(&self, assumptions: Assumptions) -> usize {
        // About three places for each element across; three neighbours to either side, where contact ratios are 1 to 2.
        let teeth = if assumptions.coupled { 7 } else { 1 };
        2 * loads(assumptions.contact) * teeth * 3 * self.elements_across as usize
    }

    fn tabulate_with_roots(
        &self,
        pair: &GearPair,
        assumptions: Assumptions,
    ) -> Result<(Tabulated, [RootInfluences; 2]), ComplianceError> {
        let mut tabulated = self.tabulate(pair, assumptions)?;
        let (mut work, meshes) = (Work::NONE, &tabulated.meshes);
        let side = |side| {
            let across = meshes.iter().find(|mesh| mesh.side == side).map(|mesh| mesh.elements_across);
            let task = Task::new(self, pair, side, assumptions)?;
            roots::influences(&task, across.unwrap_or(task.across), &mut work)
        };
        let influences = of_both(pair, side)?;
        tabulated.work.add(&work);
        Ok((tabulated, influences))
    }
}

/// Loads along a flank.
fn loads(contact: ContactLaw) -> usize {
    if contact == ContactLaw::Resolved { RESOLVED_ROLLS } else { ROLLS }
}

/// One gear, and how it is to be solved.
struct Task<'a> {
    side: Side,
    gear: &'a Gear,
    root: Root,
    plane: Plane,
    across: usize,
    accuracy: Option<f64>,
    rolls: Vec<f64>,
    neighbours: u32,
    resolved: bool,
}

impl<'a> Task<'a> {
    fn new(
        method: &FiniteElement,
        pair: &'a GearPair,
        side: Side,
        assumptions: Assumptions,
    ) -> Result<Self, ComplianceError> {
        let gear = pair.side(side);
        let root = gear.root(assumptions.root).map_err(|error| ComplianceError::Root(error.on(side)))?;
        let plane = method.plane;
        let poisson_ratio = gear.specification.material.poisson_ratio;
        if plane == Plane::Strain && poisson_ratio > MOST_POISSON {
            return Err(ComplianceError::Incompressible { side, poisson_ratio, maximum: MOST_POISSON });
        }
        let resolved = assumptions.contact == ContactLaw::Resolved;
        let minimum = LEAST_TIP_BREAK * gear.specification.module;
        let size = gear.tip.size(gear);
        if size > 0.0 && size < minimum {
            return Err(ComplianceError::SmallTipBreak { side, size, minimum });
        }
        let rolls = nodes(root.form_roll, gear.flank_end.roll, loads(assumptions.contact));
        Ok(Self {
            side,
            gear,
            root,
            plane,
            across: method.elements_across as usize,
            accuracy: assumptions.accuracy,
            rolls,
            neighbours: if assumptions.coupled { neighbours(pair, side) } else { 0 },
            resolved,
        })
    }

    fn failed(&self, across: usize, error: MeshError) -> ComplianceError {
        ComplianceError::Mesh { side: self.side, across, error }
    }

    /// The mesh with so many elements across; for point loads it is `parts` times as fine as the one that it is made of.
    fn model_of(&self, across: usize, parts: usize, work: &mut Work) -> Result<GearModel<'_>, ComplianceError> {
        let sizing = if self.resolved {
            let tip = self.gear.flank(self.gear.flank_end.roll);
            let end = [tip.half_thickness, tip.height].map(|length| length / self.gear.specification.module);
            Sizing::nested(across, parts, end)
        } else {
            Sizing::even(across)
        };
        self.factorised(across, &sizing, work)
    }

    fn factorised(&self, across: usize, sizing: &Sizing, work: &mut Work) -> Result<GearModel<'_>, ComplianceError> {
        work.add(&Work::of(&MESH_FACTORISATIONS, 1));
        GearModel::new(self.gear, &self.root, self.plane, sizing).map_err(|error| self.failed(across, error))
    }

    fn at(&self, across: usize, parts: usize, work: &mut Work) -> Result<(Solution, MeshFacts), ComplianceError> {
        let model = self.model_of(across, parts, work)?;
        work.add(&Work::of(&COMPLIANCE_EVALUATIONS, self.rolls.len()));
        let failed = |error| self.failed(across, error);
        let (found, other_block) = if self.resolved {
            self.rests(&model).map_err(failed)?
        } else {
            let influences = model.influences(&self.rolls, self.neighbours).map_err(failed)?;
            (Solution { influences, tip: None }, 0.0)
        };
        let facts = MeshFacts {
            side: self.side,
            elements_across: across,
            elements: model.mesh.elements.len(),
            unknowns: model.sector.unknowns(),
            error_estimate: model.rounding() + other_block,
        };
        Ok((found, facts))
    }

    /// The influences, refined if an accuracy is asked for. The error is estimated from a mesh half as fine; where contact
    /// is resolved that is one of which each element is cut into four, and the influences are those that both tend to.
    fn solve(&self, work: &mut Work) -> Result<(Solution, MeshFacts), ComplianceError> {
        let mut across = self.across;
        loop {
            let nested = self.resolved && across >= HALVED * LEAST;
            let coarse = if nested { across / HALVED } else { even(across / 2).max(LEAST) };
            let (mut found, mut facts) = self.at(across, HALVED, work)?;
            let (half, ..) = self.at(coarse, 1, work)?;
            let change = found.difference(&half);
            if nested {
                facts.error_estimate += change * LEFT;
                found = found.extrapolated(&half);
            } else {
                facts.error_estimate += change / (libm::pow(across as f64 / coarse as f64, ORDER) - 1.0);
            }
            let Some(accuracy) = self.accuracy else { return Ok((found, facts)) };
            if facts.error_estimate <= accuracy || across >= MOST_ELEMENTS {
                return Ok((found, facts));
            }
            let factor = libm::cbrt(facts.error_estimate / accuracy).clamp(1.0, 2.0);
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // below 2 MOST_ELEMENTS
            let next = libm::ceil(across as f64 * factor) as usize;
            across = even(next.max(across + 2)).min(MOST_ELEMENTS);
        }
    }

    /// 1/E′ for E = 1.
    fn half_plane(&self) -> f64 {
        let material = &self.gear.specification.material;
        material.plane_compliance(self.plane) * material.youngs_modulus
    }

    /// The angle of the corner in which the flank ends \[rad\], or which a rounding takes away.
    fn angle(&self) -> f64 {
        self.gear.last_corner().interior_angle
    }

    /// B for E = 1.
    fn corner(&self) -> f64 {
        self.half_plane() * wedge::softening(self.angle())
    }

    /// What inclined loads have of it.
    fn inclined_corner(&self) -> [f64; 2] {
        wedge::inclined_softening(self.angle()).map(|value| value * self.half_plane())
    }

    /// How far a place of the flank is from that corner \[modules\].
    fn distance(&self, roll: f64) -> f64 {
        let (tip, radius) = (self.gear.last_corner().roll, self.gear.base_radius / self.gear.specification.module);
        0.5 * radius * (tip - roll) * (tip + roll)
    }

    /// What the tooth yields beside the half plane, and how much of it depends on the block of elements around the load, in
    /// units of the tooth's own.
    fn rests(&self, model: &GearModel) -> Result<(Solution, f64), MeshError> {
        let count = self.rolls.len();
        let nearest = self.rolls[count - 1];
        let others = self
            .rolls
            .iter()
            .step_by(OTHER_LOADS)
            .map(|&roll| FlankLoad { rows: OTHER_BLOCK, ..FlankLoad::normal(roll) });
        let at_tip = inclined::loads(nearest);
        let own = self.rolls.iter().map(|&roll| FlankLoad::normal(roll));
        let loads: Vec<FlankLoad> = own.chain(at_tip).chain(others).collect();
        let all = model.rests_of(&loads, self.neighbours)?;
        let bodies = [self.half_plane(), self.gear.specification.material.plane_poisson_ratio(self.plane)];
        let apart = (libm::log(self.distance(nearest)), self.inclined_corner());
        let tip = AtTip::new(&all, [count, count], apart, bodies);
        let Influences { own, further } = all;
        let (own, others) = (&own[..count], &own[count + at_tip.len()..]);
        let found = self.beside(&self.rolls, own);
        let changes = others.iter().zip(own.iter().zip(&found).step_by(OTHER_LOADS));
        let change = changes.map(|(other, (own, found))| ((other - own) / found).abs()).fold(0.0, f64::max);
        let of_rolls = |rows: &Vec<Vec<f64>>| rows[..count].iter().map(|row| row[..count].to_vec()).collect();
        let influences = Influences { own: found, further: further.iter().map(of_rolls).collect() };
        Ok((Solution { influences, tip: Some(tip) }, change))
    }

    /// What a tooth yields beside the half plane and beside −B ln c.
    fn beside(&self, rolls: &[f64], rests: &[f64]) -> Vec<f64> {
        let corner = self.corner();
        let beside = |(&roll, rest): (&f64, &f64)| {
            rest + corner * libm::log(self.distance(roll)) - 2.0 / PI * self.half_plane() * libm::log(LENGTH)
        };
        rolls.iter().zip(rests).map(beside).collect()
    }

    /// SI, over the whole face width.
    fn tables(&self, solution: &Solution) -> Result<ToothCompliance, ComplianceError> {
        let Solution { influences: solution, tip } = solution;
        let (lower, upper) = (self.root.form_roll, self.gear.flank_end.roll);
        let scale = 1.0 / (self.gear.specification.material.youngs_modulus * self.gear.specification.face_width);
        let scaled = |values: &[f64]| values.iter().map(|value| value * scale).collect::<Vec<f64>>();
        let nothing = || Series::from_values(lower, upper, &[0.0]);
        let contact_depth = if self.resolved {
            Series::from_values(lower, upper, &[LENGTH * self.gear.specification.module])
        } else {
            let [depth] = Series::converged(lower, upper, |roll| [self.gear.depth_to_centreline(roll)])
                .ok_or(ComplianceError::Unresolved { side: self.side, thickness: self.gear.tip_thickness() })?;
            depth
        };
        let corner = if self.resolved { self.corner() } else { 0.0 };
        let last = solution.own.len() - 1;
        let is_stiff = |place: &usize| {
            let own = solution.own[*place];
            own <= 0.0 || (*place == last && tip.as_ref().is_some_and(|tip| tip.is_stiff(own)))
        };
        if self.resolved
            && let Some(place) = (0..=last).find(is_stiff)
        {
            let length = LENGTH * self.gear.specification.module;
            return Err(ComplianceError::Stiff { side: self.side, roll: self.rolls[place], length });
        }
        let neighbours = (solution.further.iter())
            .map(|rows| Surface::from_values([lower; 2], [upper; 2], [self.rolls.len(); 2], &scaled(&rows.concat())))
            .collect();
        Ok(ToothCompliance {
            bending: nothing(),
            shear: nothing(),
            axial: nothing(),
            body: Series::from_values(lower, upper, &scaled(&solution.own)),
            contact_depth,
            corner: corner / self.gear.specification.material.youngs_modulus,
            inclined: tip.as_ref().map(|tip| Inclined {
                own: tip.own.map(|own| own * scale),
                corner: self.inclined_corner().map(|own| own / self.gear.specification.material.youngs_modulus),
                neighbours: tip.neighbours.iter().map(|row| Series::from_values(lower, upper, &scaled(row))).collect(),
            }),
            neighbours,
        })
    }
}

/// The next even number.
fn even(count: usize) -> usize {
    count.next_multiple_of(2)
}
