//! The stress on the surface of a tooth's root under a load on its flank.
//!
//! The surface carries no load, so its only stress is along it: E′ times the strain along it, which is the rate of
//! the nodes' displacement. On an edge of three nodes that rate is most accurate at the two Gauss points (Barlow,
//! International Journal for Numerical Methods in Engineering 10 (1976) 243–251).
//! Stresses times the module over the load per width. Must not know: strength.

use super::mesh::{Edge, ElementMesh};
use super::sector::NodalForces;
use crate::gear::material::Plane;
use crate::numeric::parabola::peak;

/// 1/√3.
const GAUSS: f64 = 0.577_350_269_189_625_8;

/// A place of the surface, and what measures the stress there.
#[derive(Clone, Debug, PartialEq)]
pub struct Gauge {
    /// \[modules\].
    pub place: [f64; 2],
    /// Unit vector along the surface.
    pub along: [f64; 2],
    /// Length along the surface from its start \[modules\].
    pub length: f64,
    nodes: [usize; 3],
    /// Of the nodes' shares in the parameter along the edge.
    rates: [f64; 3],
    /// Length \[modules\] per parameter.
    speed: f64,
    /// E′ for E = 1.
    modulus: f64,
}

impl Gauge {
    /// The stress along the surface, positive in tension, where nothing presses on it, from the displacements of nodes.
    pub fn stress(&self, moved: impl Fn(usize) -> [f64; 2]) -> f64 {
        let moved = self.nodes.map(moved);
        let [u, v] = [0, 1].map(|axis| (0..3).map(|k| self.rates[k] * moved[k][axis]).sum::<f64>());
        self.modulus * (self.along[0] * u + self.along[1] * v) / self.speed
    }

    /// Forces at nodes whose work on the displacements is that stress.
    #[must_use]
    pub fn forces(&self) -> NodalForces {
        let scale = self.modulus / self.speed;
        self.nodes
            .into_iter()
            .zip(self.rates)
            .map(|(node, rate)| (node, self.along.map(|x| scale * rate * x)))
            .collect()
    }
}

/// Stress at a place of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceStress {
    /// \[modules\].
    pub place: [f64; 2],
    /// Unit vector along the surface.
    pub along: [f64; 2],
    /// Length along the surface from its start \[modules\].
    pub length: f64,
    /// The stress along the surface; positive in tension. The other principal stress in the plane is zero.
    pub stress: f64,
}

/// Gauges at two points of each of a chain of edges.
#[must_use]
pub fn gauges(mesh: &ElementMesh, edges: &[Edge], plane: Plane, poisson_ratio: f64) -> Vec<Gauge> {
    let modulus = match plane {
        Plane::Strain => 1.0 / (1.0 - poisson_ratio * poisson_ratio),
        Plane::Stress => 1.0,
    };
    let mut start = 0.0;
    let mut found = Vec::with_capacity(2 * edges.len());
    for edge in edges {
        let nodes = edge.nodes.map(|node| mesh.nodes[node]);
        let rates = |s: f64| [s - 0.5, -2.0 * s, s + 0.5];
        let rate = |s: f64| {
            let weights = rates(s);
            [0, 1].map(|axis| (0..3).map(|k| weights[k] * nodes[k][axis]).sum::<f64>())
        };
        let speed = |s: f64| {
            let [x, y] = rate(s);
            libm::hypot(x, y)
        };
        for s in [-GAUSS, GAUSS] {
            let ([x, y], speed_here) = (rate(s), speed(s));
            let along = [x / speed_here, y / speed_here];
            let weights = super::element::edge_shape(s);
            found.push(Gauge {
                place: [0, 1].map(|axis| (0..3).map(|k| weights[k] * nodes[k][axis]).sum()),
                along,
                // Simpson's rule from the start of the edge.
                length: start + (s + 1.0) / 6.0 * (speed(-1.0) + 4.0 * speed(0.5 * (s - 1.0)) + speed_here),
                nodes: edge.nodes,
                rates: rates(s),
                speed: speed_here,
                modulus,
            });
        }
        start += (speed(-1.0) + 4.0 * speed(0.0) + speed(1.0)) / 3.0;
    }
    found
}

/// The stress at two points of each of a chain of edges that carry no load, from the displacements of all nodes.
#[must_use]
pub fn along_surface(
    mesh: &ElementMesh,
    edges: &[Edge],
    displacements: &[[f64; 2]],
    plane: Plane,
    poisson_ratio: f64,
) -> Vec<SurfaceStress> {
    let stress = |gauge: Gauge| {
        let stress = gauge.stress(|node| displacements[node]);
        SurfaceStress { place: gauge.place, along: gauge.along, length: gauge.length, stress }
    };
    gauges(mesh, edges, plane, poisson_ratio).into_iter().map(stress).collect()
}

/// The largest stress along the surface and the radius it is at: the top of the parabola through the largest of
/// the points and its neighbours.
#[must_use]
pub fn largest(points: &[SurfaceStress]) -> Option<(f64, f64)> {
    let lengths: Vec<f64> = points.iter().map(|point| point.length).collect();
    let radii: Vec<f64> = points.iter().map(|point| libm::hypot(point.place[0], point.place[1])).collect();
    let stresses: Vec<f64> = points.iter().map(|point| point.stress).collect();
    peak(&lengths, &radii, &stresses)
}
