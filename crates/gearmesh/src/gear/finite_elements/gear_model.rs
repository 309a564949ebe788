//! A gear's teeth under unit loads: what a load on a flank does to its own tooth and to the teeth that follow.
//!
//! The own compliance is either the displacement of the loaded point less that of a half plane (`point_load`), or that of
//! the point Q where the load line crosses the tooth's centreline, which local flattening does not reach: the laws of that
//! split (Weber and Banaschek, 1953) contain the approach of the flank to it. A neighbour's is that of its flank point,
//! along its own load line.
//! Dimensionless: times 1/(E b) it is m/N. Must not know: pairs, contact laws.

use super::MeshError;
use super::element::{Elasticity, edge_shape, elasticity};
use super::mesh::{Edge, ElementMesh, Sizing};
use super::outline::Outline;
use super::point_load::{Block, HalfPlane, Taken};
use super::root_stress::{self, Gauge, SurfaceStress};
use super::sector::{NodalForces, Response, Sector};
use super::wheel::{Pressed, Wheel};
use crate::gear::geometry::Gear;
use crate::gear::geometry::error::{Millimetres, Plain};
use crate::gear::geometry::root::Root;
use crate::gear::material::Plane;

/// Relative error of compliances by rounding, over the square of teeth times root radius over bore radius: it takes far less
/// force to turn a large gear on a small bore than to strain its elements by as much. Measured up to 1000 teeth.
const ROUNDING: f64 = 5e-15;
const MOST_ROUNDING: f64 = 1e-2;

/// A gear, meshed and factorised.
pub struct GearModel<'a> {
    gear: &'a Gear,
    plane: Plane,
    elasticity: Elasticity,
    /// Height at which the involute begins \[modules\].
    form: f64,
    /// One tooth with its share of the body.
    pub mesh: ElementMesh,
    /// The stiffness of that mesh, factorised.
    pub sector: Sector,
}

/// A unit load on the right flank.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlankLoad {
    /// Roll angle of its place \[rad\].
    pub roll: f64,
    /// By how much it is turned from the flank's normal towards the root \[rad\].
    pub inclination: f64,
    /// How many rows of the body its block of elements has beside the tooth.
    pub rows: usize,
}

impl FlankLoad {
    /// Along the flank's normal, in the block of the tooth alone.
    #[must_use]
    pub const fn normal(roll: f64) -> Self {
        Self { roll, inclination: 0.0, rows: 0 }
    }
}

/// The effects of loads at several places of a flank.
#[derive(Clone, Debug, PartialEq)]
pub struct Influences {
    /// At the loaded tooth's Q, per place.
    pub own: Vec<f64>,
    /// For teeth 1, 2, … pitches further, where roll angles are larger: by the loaded place, then the affected one.
    pub further: Vec<Vec<Vec<f64>>>,
}

impl<'a> GearModel<'a> {
    /// # Errors
    /// When the gear cannot be meshed or solved.
    pub fn new(gear: &'a Gear, root: &Root, plane: Plane, sizing: &Sizing) -> Result<Self, MeshError> {
        let outline = Outline::new(gear, root)?;
        let (teeth, ratio) = (f64::from(gear.specification.teeth), gear.root_radius / gear.specification.bore_radius);
        let maximum = (MOST_ROUNDING / ROUNDING).sqrt() / teeth;
        if ratio > maximum {
            return Err(MeshError::Rounding { ratio: Plain(ratio), maximum: Plain(maximum) });
        }
        let mesh = ElementMesh::new(&outline, sizing)?;
        let elasticity = elasticity(plane, gear.specification.material.poisson_ratio);
        let sector = Sector::new(&mesh, &elasticity)?;
        let form = gear.flank(root.form_roll).height / gear.specification.module * (1.0 + 1e-9);
        Ok(Self { gear, plane, elasticity, form, mesh, sector })
    }

    /// Bound on the relative error of the compliances by rounding.
    #[must_use]
    pub fn rounding(&self) -> f64 {
        let body = self.gear.root_radius / self.gear.specification.bore_radius;
        let product = f64::from(self.gear.specification.teeth) * body;
        ROUNDING * product * product
    }

    /// The way a flank is pressed at a roll angle: into the tooth, against (cos α_1, sin α_1).
    #[must_use]
    pub fn direction(&self, roll: f64) -> [f64; 2] {
        let (sine, cosine) = libm::sincos(self.gear.load_angle(roll));
        [-cosine, -sine]
    }

    /// A unit load on the right flank at a roll angle.
    #[must_use]
    pub fn load(&self, roll: f64) -> NodalForces {
        let height = self.gear.flank(roll).height / self.gear.specification.module;
        let (edge, place) = find(&self.mesh, &self.mesh.flank, height);
        spread(edge, place, self.direction(roll))
    }

    /// What measures the displacement of Q along the load line of a roll angle.
    ///
    /// # Errors
    /// When Q lies inside the bore.
    pub fn probe(&self, roll: f64) -> Result<NodalForces, MeshError> {
        let height = self.gear.base_radius / libm::cos(self.gear.load_angle(roll));
        let bore = self.gear.specification.bore_radius;
        if height <= bore {
            return Err(MeshError::Bore { height: Millimetres(height), bore: Millimetres(bore) });
        }
        let height = height / self.gear.specification.module;
        let (edge, place) = find(&self.mesh, &self.mesh.centreline, height);
        Ok(spread(edge, place, self.direction(roll)))
    }

    /// The field of a half plane under a unit load on the right flank at a roll angle, inclined by so much.
    fn field(&self, roll: f64, inclination: f64) -> HalfPlane {
        let height = self.gear.flank(roll).height / self.gear.specification.module;
        let (edge, place) = find(&self.mesh, &self.mesh.flank, height);
        let shares = edge_shape(place);
        let at = [0, 1].map(|axis| (0..3).map(|k| shares[k] * self.mesh.nodes[edge.nodes[k]][axis]).sum());
        let ([x, y], (sine, cosine)) = (self.direction(roll), libm::sincos(inclination));
        let along = [x * cosine - y * sine, y * cosine + x * sine];
        HalfPlane::new(at, along, &self.gear.specification.material, self.plane)
    }

    /// A unit load on the right flank, less that field.
    fn taken(&self, block: &Block, roll: f64, inclination: f64) -> Taken {
        block.take(&self.mesh.nodes, &self.field(roll, inclination))
    }

    /// The forces of a unit load at a roll angle, less its own field in the tooth, as [`Self::stress_influences`] has it.
    #[cfg(test)]
    pub(super) fn load_without_field(&self, roll: f64) -> Option<NodalForces> {
        let block = Block::new(&self.mesh.nodes, &self.mesh.elements, &self.mesh.tooth(0), &self.elasticity)?;
        Some(self.taken(&block, roll, 0.0).forces)
    }

    /// The influences of unit loads at `rolls`, on themselves and on as many neighbours as are asked for. Own is what is
    /// left of the displacement at the load when the field of a half plane is taken off, −2 ln r/(π E′) on its surface at
    /// the distance r \[modules\]. The block around the load is the tooth and as many `rows` of the body beneath it: what
    /// comes out does not depend on it but for the error of the mesh.
    ///
    /// # Errors
    /// When the gear is not held to rounding.
    pub fn rests(&self, rolls: &[f64], neighbours: u32, rows: usize) -> Result<Influences, MeshError> {
        let loads: Vec<FlankLoad> = rolls.iter().map(|&roll| FlankLoad { rows, ..FlankLoad::normal(roll) }).collect();
        self.rests_of(&loads, neighbours)
    }

    /// The same of loads that each have a block and an inclination of their own: displacements are those along each load.
    ///
    /// # Errors
    /// As [`Self::rests`].
    pub fn rests_of(&self, loads: &[FlankLoad], neighbours: u32) -> Result<Influences, MeshError> {
        let ElementMesh { nodes, elements, .. } = &self.mesh;
        let most = loads.iter().map(|load| load.rows).max().unwrap_or(0);
        // No element is folded over: they were factorised.
        let block =
            |rows| Block::new(nodes, elements, &self.mesh.tooth(rows), &self.elasticity).ok_or(MeshError::Singular);
        let blocks = (0..=most).map(block).collect::<Result<Vec<_>, _>>()?;
        let (forces, own): (Vec<NodalForces>, Vec<f64>) = loads
            .iter()
            .map(|load| self.taken(&blocks[load.rows], load.roll, load.inclination))
            .map(|taken| (taken.forces, taken.own))
            .unzip();
        let responses = self.sector.responses(&forces);
        let pressed: Vec<&Pressed> = responses.iter().map(|response| &response.pressed).collect();
        let steps: Vec<u32> = (0..=neighbours).collect();
        let stiffness = self.sector.stiffness();
        let wheel = Wheel { sectors: self.gear.specification.teeth, stiffness: &stiffness };
        let found = wheel.influences(&pressed, &pressed, &steps)?;
        let held = |k: usize| self.sector.held_work(&forces[k], &responses[k], &responses[k]);
        let own = own.into_iter().enumerate().map(|(k, own)| own + held(k) + found[0][k][k]).collect();
        let count = loads.len();
        let further = (found[1..].iter())
            .map(|matrix| (0..count).map(|by| (0..count).map(|on| matrix[on][by]).collect()).collect())
            .collect();
        Ok(Influences { own, further })
    }

    /// The influences of unit loads at `rolls`, on themselves and on as many neighbours as are asked for.
    ///
    /// # Errors
    /// When a load line meets the centreline inside the bore, or the gear is not held to rounding.
    pub fn influences(&self, rolls: &[f64], neighbours: u32) -> Result<Influences, MeshError> {
        let loads: Vec<NodalForces> = rolls.iter().map(|&roll| self.load(roll)).collect();
        let probes = rolls.iter().map(|&roll| self.probe(roll)).collect::<Result<Vec<_>, _>>()?;
        let by_load = self.sector.responses(&loads);
        let by_probe = self.sector.responses(&probes);
        let pressed: Vec<&Pressed> = by_load.iter().map(|response| &response.pressed).collect();
        let all: Vec<&Pressed> =
            by_probe.iter().map(|response| &response.pressed).chain(pressed.iter().copied()).collect();
        let steps: Vec<u32> = (0..=neighbours).collect();
        let stiffness = self.sector.stiffness();
        let wheel = Wheel { sectors: self.gear.specification.teeth, stiffness: &stiffness };
        let found = wheel.influences(&all, &pressed, &steps)?;
        let count = rolls.len();
        let own =
            (0..count).map(|k| self.sector.held_work(&probes[k], &by_probe[k], &by_load[k]) + found[0][k][k]).collect();
        let further = (found[1..].iter())
            .map(|matrix| (0..count).map(|by| (0..count).map(|on| matrix[count + on][by]).collect()).collect())
            .collect();
        Ok(Influences { own, further })
    }
}

impl GearModel<'_> {
    /// The work of `probe` on what any load on the same tooth does.
    ///
    /// # Errors
    /// When the gear is not held to rounding.
    pub fn work_of(&self, probe: &NodalForces, load: &NodalForces) -> Result<f64, MeshError> {
        let responses = self.sector.responses(&[probe.clone(), load.clone()]);
        let stiffness = self.sector.stiffness();
        let wheel = Wheel { sectors: self.gear.specification.teeth, stiffness: &stiffness };
        let found = wheel.influences(&[&responses[0].pressed], &[&responses[1].pressed], &[0])?;
        Ok(self.sector.held_work(probe, &responses[0], &responses[1]) + found[0][0][0])
    }

    /// The stress on the surface of the root on the side of the loads, which is the one in tension, from the middle of
    /// the root land up to the start of the involute or to two elements short of the load; for unit loads at `rolls`.
    ///
    /// # Errors
    /// When the gear is not held to rounding.
    pub fn root_stresses(&self, rolls: &[f64]) -> Result<Vec<Vec<SurfaceStress>>, MeshError> {
        let loads: Vec<NodalForces> = rolls.iter().map(|&roll| self.load(roll)).collect();
        let responses = self.sector.responses(&loads);
        let pressed: Vec<&Pressed> = responses.iter().map(|response| &response.pressed).collect();
        let stiffness = self.sector.stiffness();
        let wheel = Wheel { sectors: self.gear.specification.teeth, stiffness: &stiffness };
        let edges = wheel.displacements(&pressed)?;
        let surface: Vec<Edge> = self.mesh.root.iter().chain(&self.mesh.flank).copied().collect();
        let module = self.gear.specification.module;
        let found = responses.iter().zip(&edges).zip(rolls).map(|((response, edges), &roll)| {
            let displacements = self.sector.displacements(response, edges);
            let loaded = self.gear.flank(roll).height / module;
            let height = |edge: &Edge| self.mesh.nodes[edge.nodes[2]][1];
            let clear =
                surface.windows(3).take_while(|edges| height(&edges[2]) < loaded && height(&edges[0]) <= self.form);
            let count = clear.count();
            let nu = self.gear.specification.material.poisson_ratio;
            root_stress::along_surface(&self.mesh, &surface[..count], &displacements, self.plane, nu)
        });
        Ok(found.collect())
    }
}

/// What unit loads do to the surface of a tooth's root.
#[derive(Clone, Debug, PartialEq)]
pub struct StressInfluences {
    /// Where, from the root land upwards.
    pub gauges: Vec<Gauge>,
    /// Stress along the surface, by the loaded tooth, the loaded place and the gauge; the loaded tooth is from so many pitches
    /// behind up to as many further, where roll angles are larger.
    pub stresses: Vec<Vec<Vec<f64>>>,
}

impl GearModel<'_> {
    /// The stress on the surface of the root on the side of the loads, from one edge beside the middle of the root land up to
    /// the start of the involute; for unit loads at `rolls` of that tooth and of as many neighbours to either side as are
    /// asked for. The own loads' fields are taken off and added in closed form, so that stresses near a load are right too.
    ///
    /// # Errors
    /// When the gear is not held to rounding.
    pub fn stress_influences(&self, rolls: &[f64], neighbours: u32) -> Result<StressInfluences, MeshError> {
        let loads: Vec<FlankLoad> = rolls.iter().map(|&roll| FlankLoad::normal(roll)).collect();
        self.stress_influences_of(&loads, neighbours)
    }

    /// The same of loads that each have an inclination of their own, in the block of the tooth alone.
    ///
    /// # Errors
    /// As [`Self::stress_influences`].
    pub fn stress_influences_of(&self, places: &[FlankLoad], neighbours: u32) -> Result<StressInfluences, MeshError> {
        let ElementMesh { nodes, elements, root, flank, .. } = &self.mesh;
        let block = Block::new(nodes, elements, &self.mesh.tooth(0), &self.elasticity).ok_or(MeshError::Singular)?;
        let loads: Vec<NodalForces> =
            places.iter().map(|load| self.taken(&block, load.roll, load.inclination).forces).collect();
        let fillet = flank.iter().take_while(|edge| nodes[edge.nodes[2]][1] <= self.form);
        // The nodes of the first edge belong to two sectors.
        let edges: Vec<Edge> = root.iter().chain(fillet).skip(1).copied().collect();
        let below = 2 * (root.len() - 1);
        let gauges =
            root_stress::gauges(&self.mesh, &edges, self.plane, self.gear.specification.material.poisson_ratio);
        let probes: Vec<NodalForces> = gauges.iter().map(Gauge::forces).collect();
        let (by_load, by_probe) = (self.sector.responses(&loads), self.sector.responses(&probes));
        let pressed = |responses: &'_ [Response]| responses.iter().map(|one| one.pressed.clone()).collect::<Vec<_>>();
        let (of_loads, of_probes) = (pressed(&by_load), pressed(&by_probe));
        let teeth = self.gear.specification.teeth;
        // A tooth that is k pitches behind the gauges' has them k pitches further; one that is further, all the others.
        let steps: Vec<u32> = (0..=neighbours).rev().chain((1..=neighbours).map(|ahead| teeth - ahead)).collect();
        let stiffness = self.sector.stiffness();
        let wheel = Wheel { sectors: teeth, stiffness: &stiffness };
        let found =
            wheel.influences(&of_probes.iter().collect::<Vec<_>>(), &of_loads.iter().collect::<Vec<_>>(), &steps)?;
        let own = |load: usize, place: usize| {
            let gauge = &gauges[place];
            let held = self.sector.held_work(&probes[place], &by_probe[place], &by_load[load]);
            if place < below {
                return held;
            }
            // In the block the mesh has the rest alone.
            let field = self.field(places[load].roll, places[load].inclination);
            held + field.stretch(gauge.place, gauge.along) - gauge.stress(|node| block.at_shared(nodes, &field, node))
        };
        let stresses = (found.iter().zip(&steps))
            .map(|(matrix, &step)| {
                let of =
                    |load: usize, place: usize| matrix[place][load] + if step == 0 { own(load, place) } else { 0.0 };
                (0..places.len()).map(|load| (0..gauges.len()).map(|place| of(load, place)).collect()).collect()
            })
            .collect();
        Ok(StressInfluences { gauges, stresses })
    }
}

/// The edge that contains a height, and the place s on it; an end where the height lies beyond.
fn find<'a>(mesh: &ElementMesh, edges: &'a [Edge], height: f64) -> (&'a Edge, f64) {
    let above = edges.partition_point(|edge| mesh.nodes[edge.nodes[2]][1] < height).min(edges.len() - 1);
    let edge = &edges[above];
    let [start, middle, end] = edge.nodes.map(|node| mesh.nodes[node][1]);
    // y = y_m + b s + a s², the root nearest to the straight edge's.
    let (a, b, c) = (0.5 * (start + end) - middle, 0.5 * (end - start), middle - height);
    let place = -2.0 * c / (b + (b * b - 4.0 * a * c).max(0.0).sqrt());
    (edge, place.clamp(-1.0, 1.0))
}

/// A force at a place of an edge as forces at its nodes.
fn spread(edge: &Edge, place: f64, force: [f64; 2]) -> NodalForces {
    edge.nodes.into_iter().zip(edge_shape(place)).map(|(node, share)| (node, force.map(|f| f * share))).collect()
}
