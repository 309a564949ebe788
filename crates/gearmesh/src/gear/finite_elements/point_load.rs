//! A point load on a flank: its own field taken off, so that the mesh has only what is smooth to follow.
//!
//! A half plane under a point load has the field of Flamant (Timoshenko and Goodier, Theory of Elasticity, 3rd edition,
//! article 36; Johnson, Contact Mechanics, 2.2), which is singular at the load. In a block of elements around the load the
//! displacement is that field and a rest; outside it is the rest alone, which starts from the field at the nodes that both
//! sides share. What is left of the displacement at the load is the rest there, an energy of smooth fields. Derivation:
//! `docs/methods.md`, "Contact that is resolved". Lengths in modules, E = 1, forces per width. Must not know: gears, the
//! ring of sectors.

use std::f64::consts::PI;

use super::element::{Elasticity, FREEDOMS, NODES, SIDES, edge_shape, stiffness};
use super::sector::NodalForces;
use crate::gear::material::{Material, Plane};
use crate::numeric::quadrature::GaussLegendre;

/// Points of the rule on each piece of an edge.
const POINTS: usize = 6;
/// An edge is halved towards the load until a piece is no longer than this share of its distance from the load, ...
const NEAR: f64 = 2.0;
/// ... or than this. Nearer to the load nothing is left to integrate but rounding: the traction is bounded there.
const SHORTEST: f64 = 1e-8;

/// The field of a unit load on the surface of a half plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfPlane {
    at: [f64; 2],
    /// Unit vector along the load.
    inward: [f64; 2],
    /// ν′.
    poisson_ratio: f64,
    /// 1/(π E′) for E = 1.
    scale: f64,
}

impl HalfPlane {
    /// A load at a place, along a unit vector.
    #[must_use]
    pub fn new(at: [f64; 2], inward: [f64; 2], material: &Material, plane: Plane) -> Self {
        let scale = material.plane_compliance(plane) * material.youngs_modulus / PI;
        Self { at, inward, poisson_ratio: material.plane_poisson_ratio(plane), scale }
    }

    /// Distances along the load and across it, and the square of the distance.
    fn relative_to_load(&self, [x, y]: [f64; 2]) -> [f64; 3] {
        let ([a, b], [n, m]) = (self.at, self.inward);
        let (dx, dy) = (x - a, y - b);
        [dx * n + dy * m, dy * n - dx * m, dx * dx + dy * dy]
    }

    /// The displacement, but for a rigid motion: on the surface −2 ln r/(π E′) along the load.
    #[must_use]
    pub fn displacement(&self, place: [f64; 2]) -> [f64; 2] {
        let ([n, m], nu) = (self.inward, self.poisson_ratio);
        let [depth, across, square] = self.relative_to_load(place);
        let angle = libm::atan2(across, depth);
        let along = self.scale * ((1.0 + nu) * depth * depth / square - libm::log(square));
        let aside = self.scale * ((1.0 + nu) * depth * across / square - (1.0 - nu) * angle);
        [along * n - aside * m, along * m + aside * n]
    }

    /// E′ times the strain of the field along a unit vector; 0 at the load itself, where it has none.
    #[must_use]
    pub fn stretch(&self, [x, y]: [f64; 2], [p, q]: [f64; 2]) -> f64 {
        let [depth, _, square] = self.relative_to_load([x, y]);
        if square <= 0.0 {
            return 0.0;
        }
        let (dx, dy) = (x - self.at[0], y - self.at[1]);
        let along = dx * p + dy * q;
        let part = along * along / square;
        -2.0 / PI * (depth / square) * (part - self.poisson_ratio * (1.0 - part))
    }

    /// What the field pulls with on a surface, per length, times a vector that is normal to it and points outwards.
    fn traction(&self, [x, y]: [f64; 2], [p, q]: [f64; 2]) -> [f64; 2] {
        let [depth, _, square] = self.relative_to_load([x, y]);
        let (dx, dy) = (x - self.at[0], y - self.at[1]);
        let size = -2.0 / PI * (depth / square) * ((dx * p + dy * q) / square);
        [size * dx, size * dy]
    }
}

/// A block of elements, in one piece, around the loads.
#[derive(Clone, Debug)]
pub struct Block {
    /// Sides of its elements that no other of its elements shares, with the inside to the left.
    boundary: Vec<[usize; 3]>,
    /// Which nodes it shares with the elements around it.
    shared: Vec<bool>,
    /// The elements with such nodes, and their stiffness.
    joined: Vec<([usize; NODES], [[f64; FREEDOMS]; FREEDOMS])>,
    rule: GaussLegendre,
}

/// A load on a block as the mesh sees it.
#[derive(Clone, Debug, PartialEq)]
pub struct Taken {
    /// What loads the rest.
    pub forces: NodalForces,
    /// What is added to their own work so that it is the rest of the displacement at the load: a₀.
    pub own: f64,
}

impl Block {
    /// `members` are the places of the block's elements among all of them. None where an element is folded over.
    #[must_use]
    pub fn new(
        nodes: &[[f64; 2]],
        elements: &[[usize; NODES]],
        members: &[usize],
        elasticity: &Elasticity,
    ) -> Option<Self> {
        let mut inside = vec![false; elements.len()];
        for &member in members {
            inside[member] = true;
        }
        let (mut within, mut around) = (vec![false; nodes.len()], vec![false; nodes.len()]);
        for (element, inside) in elements.iter().zip(&inside) {
            let found = if *inside { &mut within } else { &mut around };
            for &node in element {
                found[node] = true;
            }
        }
        let shared: Vec<bool> = within.iter().zip(&around).map(|(within, around)| *within && *around).collect();
        // The middle of a side is a node of the elements at that side alone.
        let mut sides = vec![0_u8; nodes.len()];
        for &member in members {
            for [_, middle, _] in SIDES {
                sides[elements[member][middle]] += 1;
            }
        }
        let of_member = |&member: &usize| SIDES.map(|side| side.map(|place| elements[member][place]));
        let boundary = members.iter().flat_map(of_member).filter(|side| sides[side[1]] == 1).collect();
        let joined = members.iter().map(|&member| elements[member]).filter(|nodes| nodes.iter().any(|&n| shared[n]));
        let joined = joined
            .map(|element| Some((element, stiffness(&element.map(|node| nodes[node]), elasticity)?)))
            .collect::<Option<Vec<_>>>()?;
        Some(Self { boundary, shared, joined, rule: GaussLegendre::new(POINTS) })
    }

    /// The field at nodes that the block shares with the elements around it, which have all of the displacement; none at
    /// others.
    #[must_use]
    pub fn at_shared(&self, nodes: &[[f64; 2]], field: &HalfPlane, node: usize) -> [f64; 2] {
        if self.shared[node] { field.displacement(nodes[node]) } else { [0.0; 2] }
    }

    /// A load on the surface of the block.
    #[must_use]
    pub fn take(&self, nodes: &[[f64; 2]], field: &HalfPlane) -> Taken {
        let at_shared = |node: usize| self.at_shared(nodes, field, node);
        let (mut forces, mut own) = (NodalForces::new(), 0.0);
        for (element, matrix) in &self.joined {
            let given = element.map(at_shared);
            let value = |place: usize| given[place / 2][place % 2];
            let force: [f64; FREEDOMS] =
                matrix.map(|row| row.iter().enumerate().map(|(column, entry)| entry * value(column)).sum());
            own -= force.iter().enumerate().map(|(row, force)| force * value(row)).sum::<f64>();
            forces.extend(element.iter().enumerate().map(|(k, &node)| (node, [force[2 * k], force[2 * k + 1]])));
        }
        for side in &self.boundary {
            let (pulled, work) = self.pull(&side.map(|node| nodes[node]), &side.map(at_shared), field);
            forces.extend(side.iter().zip(pulled).map(|(&node, [x, y])| (node, [-x, -y])));
            own += work;
        }
        Taken { forces, own }
    }

    /// What the field pulls with on a side, ∫ N t ds, and ∫ t · (2 N Φ − u) ds with the field Φ at its shared nodes.
    fn pull(&self, side: &[[f64; 2]; 3], given: &[[f64; 2]; 3], field: &HalfPlane) -> ([[f64; 2]; 3], f64) {
        let (mut pulled, mut work) = ([[0.0; 2]; 3], 0.0);
        for piece in pieces(side, field) {
            let [a, b, c, d, e, f, part] = self.rule.integrate(piece[0], piece[1], |s| {
                let shares = edge_shape(s);
                let at = |values: &[[f64; 2]; 3], axis: usize| (0..3).map(|k| shares[k] * values[k][axis]).sum::<f64>();
                let place = [at(side, 0), at(side, 1)];
                let [x, y] = rate(side, s);
                let [p, q] = field.traction(place, [y, -x]);
                let [u, v] = field.displacement(place);
                let work = p * (2.0 * at(given, 0) - u) + q * (2.0 * at(given, 1) - v);
                let [g, h, i] = shares;
                [g * p, g * q, h * p, h * q, i * p, i * q, work]
            });
            for (total, value) in pulled.iter_mut().flatten().zip([a, b, c, d, e, f]) {
                *total += value;
            }
            work += part;
        }
        (pulled, work)
    }
}

/// d(x, y)/ds on a side.
fn rate(side: &[[f64; 2]; 3], s: f64) -> [f64; 2] {
    [0, 1].map(|axis| (s - 0.5) * side[0][axis] - 2.0 * s * side[1][axis] + (s + 0.5) * side[2][axis])
}

/// The stretches of s in −1..=1 on which a side is integrated: shorter and shorter towards where it is nearest to the load.
fn pieces(side: &[[f64; 2]; 3], field: &HalfPlane) -> Vec<[f64; 2]> {
    let length = libm::hypot(side[2][0] - side[0][0], side[2][1] - side[0][1]);
    let distance = |s: f64| {
        let shares = edge_shape(s);
        let place = [0, 1].map(|axis| (0..3).map(|k| shares[k] * side[k][axis]).sum::<f64>());
        field.relative_to_load(place)[2].sqrt()
    };
    let nearest = nearest(side, field.at);
    let closest = distance(nearest);
    let mut found = Vec::new();
    for end in [-1.0, 1.0] {
        // From the far end inwards, by halves.
        let mut from: f64 = end;
        while (from - nearest).abs() * length > f64::max(NEAR * closest, SHORTEST) {
            let to = 0.5 * (from + nearest);
            found.push([from.min(to), from.max(to)]);
            from = to;
        }
        if (from - nearest).abs() * length > SHORTEST {
            found.push([from.min(nearest), from.max(nearest)]);
        }
    }
    found
}

/// About where on a side it is nearest to a place: where the straight line through its ends is.
fn nearest(side: &[[f64; 2]; 3], [x, y]: [f64; 2]) -> f64 {
    let mut s: f64 = 0.0;
    for _ in 0..4 {
        let shares = edge_shape(s);
        let at = [0, 1].map(|axis| (0..3).map(|k| shares[k] * side[k][axis]).sum::<f64>());
        let [p, q] = rate(side, s);
        s = (s + ((x - at[0]) * p + (y - at[1]) * q) / (p * p + q * q)).clamp(-1.0, 1.0);
    }
    s
}
