//! The stress on the surface of a tooth's root under a load on its flank.
//!
//! The surface carries no load, so its only stress is along it: E′ times the strain along it, which is the rate of
//! the nodes' displacement. On an edge of three nodes that rate is most accurate at the two Gauss points (Barlow,
//! International Journal for Numerical Methods in Engineering 10 (1976) 243–251).
//! Stresses times the module over the load per width. Must not know: strength.

use super::mesh::{Edge, Mesh};
use crate::gear::material::Plane;

/// 1/√3.
const GAUSS: f64 = 0.577_350_269_189_625_8;

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

/// The stress at two points of each of a chain of edges that carry no load, from the displacements of all nodes.
#[must_use]
pub fn along_surface(
    mesh: &Mesh,
    edges: &[Edge],
    displacements: &[[f64; 2]],
    plane: Plane,
    poisson_ratio: f64,
) -> Vec<SurfaceStress> {
    let modulus = match plane {
        Plane::Strain => 1.0 / (1.0 - poisson_ratio * poisson_ratio),
        Plane::Stress => 1.0,
    };
    let mut start = 0.0;
    let mut found = Vec::new();
    for edge in edges {
        let nodes = edge.nodes.map(|node| mesh.nodes[node]);
        let moved = edge.nodes.map(|node| displacements[node]);
        let rate = |values: &[[f64; 2]; 3], s: f64| {
            let weights = [s - 0.5, -2.0 * s, s + 0.5];
            [0, 1].map(|axis| (0..3).map(|k| weights[k] * values[k][axis]).sum::<f64>())
        };
        let speed = |s: f64| {
            let [x, y] = rate(&nodes, s);
            libm::hypot(x, y)
        };
        for s in [-GAUSS, GAUSS] {
            let ([x, y], [u, v]) = (rate(&nodes, s), rate(&moved, s));
            let speed_here = speed(s);
            let along = [x / speed_here, y / speed_here];
            let weights = super::element::edge_shape(s);
            found.push(SurfaceStress {
                place: [0, 1].map(|axis| (0..3).map(|k| weights[k] * nodes[k][axis]).sum()),
                along,
                // Simpson's rule from the start of the edge.
                length: start + (s + 1.0) / 6.0 * (speed(-1.0) + 4.0 * speed(0.5 * (s - 1.0)) + speed_here),
                stress: modulus * (along[0] * u + along[1] * v) / speed_here,
            });
        }
        start += (speed(-1.0) + 4.0 * speed(0.0) + speed(1.0)) / 3.0;
    }
    found
}

/// The largest stress along the surface and the radius it is at: the top of the parabola through the largest of
/// the points and its neighbours.
#[must_use]
pub fn largest(points: &[SurfaceStress]) -> Option<(f64, f64)> {
    let radius = |point: &SurfaceStress| libm::hypot(point.place[0], point.place[1]);
    let top = (0..points.len()).reduce(|a, b| if points[b].stress > points[a].stress { b } else { a })?;
    if top == 0 || top + 1 == points.len() {
        return Some((points[top].stress, radius(&points[top])));
    }
    let [before, at, after] = [&points[top - 1], &points[top], &points[top + 1]];
    let (a, b) = (before.length - at.length, after.length - at.length);
    // y ≈ y_0 + p x + q x² through the three.
    let parabola = |y: [f64; 3]| {
        let (left, right) = ((y[0] - y[1]) / a, (y[2] - y[1]) / b);
        let curve = (right - left) / (b - a);
        [y[1], left - curve * a, curve]
    };
    let [value, slope, curve] = parabola([before.stress, at.stress, after.stress]);
    let x = if curve < 0.0 { (-0.5 * slope / curve).clamp(a, b) } else { 0.0 };
    let [r, rate, bend] = parabola([before, at, after].map(radius));
    Some((value + x * (slope + x * curve), r + x * (rate + x * bend)))
}
