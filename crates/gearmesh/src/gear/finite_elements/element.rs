//! The 8-node quadrilateral (serendipity), isoparametric, 3 × 3 Gauss points, and plane elasticity with E = 1.
//!
//! Corners first, counter-clockwise, then the middles of the edges 1–2, 2–3, 3–4, 4–1: the order of CPE8 and CPS8.
//! Source: Zienkiewicz and Taylor, The Finite Element Method, 5th edition, volume 1, chapters 8 and 9.
//! Must not know: gears, the mesh.

use crate::gear::material::Plane;

/// Nodes of an element.
pub const NODES: usize = 8;
/// Freedoms of an element: two at each node.
pub const FREEDOMS: usize = 2 * NODES;

/// The nodes of each side of an element: start, middle, end, with the element to the left.
pub const SIDES: [[usize; 3]; 4] = [[0, 4, 1], [1, 5, 2], [2, 6, 3], [3, 7, 0]];

/// √(3/5).
const GAUSS: f64 = 0.774_596_669_241_483_4;
/// Abscissas and weights of the three-point rule.
pub const RULE: [(f64, f64); 3] = [(-GAUSS, 5.0 / 9.0), (0.0, 8.0 / 9.0), (GAUSS, 5.0 / 9.0)];

/// σ = D ε with ε = (ε_x, ε_y, γ_xy).
pub type Elasticity = [[f64; 3]; 3];

/// D for E = 1; plane strain needs ν < 0.5.
#[must_use]
pub fn elasticity(plane: Plane, nu: f64) -> Elasticity {
    let (direct, cross) = match plane {
        Plane::Strain => {
            let scale = 1.0 / ((1.0 + nu) * (1.0 - 2.0 * nu));
            ((1.0 - nu) * scale, nu * scale)
        }
        Plane::Stress => (1.0 / (1.0 - nu * nu), nu / (1.0 - nu * nu)),
    };
    [[direct, cross, 0.0], [cross, direct, 0.0], [0.0, 0.0, 0.5 / (1.0 + nu)]]
}

/// Corners in the unit square, in order.
const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// The shape functions and their derivatives at (ξ, η).
#[must_use]
pub fn shape([xi, eta]: [f64; 2]) -> ([f64; NODES], [[f64; 2]; NODES]) {
    let mut values = [0.0; NODES];
    let mut rates = [[0.0; 2]; NODES];
    for (k, [a, b]) in CORNERS.into_iter().enumerate() {
        let (p, q) = (1.0 + a * xi, 1.0 + b * eta);
        values[k] = 0.25 * p * q * (a * xi + b * eta - 1.0);
        rates[k] = [0.25 * a * q * (2.0 * a * xi + b * eta), 0.25 * b * p * (a * xi + 2.0 * b * eta)];
    }
    let (across, along) = (1.0 - xi * xi, 1.0 - eta * eta);
    for (k, b) in [(4, -1.0), (6, 1.0)] {
        values[k] = 0.5 * across * (1.0 + b * eta);
        rates[k] = [-xi * (1.0 + b * eta), 0.5 * b * across];
    }
    for (k, a) in [(5, 1.0), (7, -1.0)] {
        values[k] = 0.5 * along * (1.0 + a * xi);
        rates[k] = [0.5 * a * along, -eta * (1.0 + a * xi)];
    }
    (values, rates)
}

/// Shape functions of an edge (start, middle, end) at s in −1..=1.
#[must_use]
pub fn edge_shape(s: f64) -> [f64; 3] {
    [0.5 * s * (s - 1.0), 1.0 - s * s, 0.5 * s * (s + 1.0)]
}

/// Derivatives of the shape functions by x and y at a point of the unit square, and the Jacobian's determinant.
#[must_use]
pub fn gradients(nodes: &[[f64; 2]; NODES], at: [f64; 2]) -> ([[f64; 2]; NODES], f64) {
    let (_, rates) = shape(at);
    let mut jacobian = [[0.0; 2]; 2];
    for (node, rate) in nodes.iter().zip(&rates) {
        for (row, slope) in jacobian.iter_mut().zip(rate) {
            row[0] += slope * node[0];
            row[1] += slope * node[1];
        }
    }
    let [[a, b], [c, d]] = jacobian;
    let determinant = a * d - b * c;
    let gradients = rates.map(|[p, q]| [(d * p - b * q) / determinant, (a * q - c * p) / determinant]);
    (gradients, determinant)
}

/// The stiffness of an element; `None` where it is folded over: its Jacobian is not positive at a Gauss point.
#[must_use]
pub fn stiffness(nodes: &[[f64; 2]; NODES], elasticity: &Elasticity) -> Option<[[f64; FREEDOMS]; FREEDOMS]> {
    let [[direct, cross, _], _, [.., shear]] = *elasticity;
    let mut matrix = [[0.0; FREEDOMS]; FREEDOMS];
    for (xi, first) in RULE {
        for (eta, second) in RULE {
            let (gradients, determinant) = gradients(nodes, [xi, eta]);
            // Named for what must hold, so that a NaN fails too.
            let upright = determinant > 0.0;
            if !upright {
                return None;
            }
            let weight = first * second * determinant;
            for (i, [x, y]) in gradients.into_iter().enumerate() {
                let [dx, dy] = [weight * direct * x, weight * direct * y];
                let [cx, cy] = [weight * cross * x, weight * cross * y];
                let [sx, sy] = [weight * shear * x, weight * shear * y];
                for (j, [p, q]) in gradients.into_iter().enumerate().skip(i) {
                    matrix[2 * i][2 * j] += dx * p + sy * q;
                    matrix[2 * i][2 * j + 1] += cx * q + sy * p;
                    matrix[2 * i + 1][2 * j] += cy * p + sx * q;
                    matrix[2 * i + 1][2 * j + 1] += dy * q + sx * p;
                }
            }
        }
    }
    for row in 1..FREEDOMS {
        let (above, below) = matrix.split_at_mut(row);
        for (value, mirrored) in below[0].iter_mut().zip(above.iter()) {
            *value = mirrored[row];
        }
    }
    Some(matrix)
}

/// The stress (σ_x, σ_y, τ_xy) at a point of the unit square.
#[must_use]
pub fn stress(
    nodes: &[[f64; 2]; NODES],
    displacements: &[[f64; 2]; NODES],
    elasticity: &Elasticity,
    at: [f64; 2],
) -> [f64; 3] {
    let (gradients, _) = gradients(nodes, at);
    let mut strain = [0.0; 3];
    for ([x, y], [u, v]) in gradients.into_iter().zip(*displacements) {
        strain[0] += x * u;
        strain[1] += y * v;
        strain[2] += y * u + x * v;
    }
    elasticity.map(|row| row[0] * strain[0] + row[1] * strain[1] + row[2] * strain[2])
}
