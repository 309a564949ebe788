//! One sector's stiffness: factorised once, its inside eliminated onto the two radial edges.
//!
//! Freedoms of the edges are radial and clockwise, so that they are the same seen from either sector that shares them.
//! Nondimensional: E = 1, lengths in modules, forces per width. Must not know: the ring of sectors, gears.

use cholesky::{CholeskyError, Entries, Factor, Order};

use super::MeshError;
use super::element::{Elasticity, FREEDOMS, stiffness};
use super::mesh::ElementMesh;

/// Columns solved for at a time.
const BLOCK: usize = 32;
/// Springs to ground on the freedoms of the edges, in units of E: a sector on its own, a sliver of a large gear, would
/// be too floppy to be factorised to rounding. They are removed again.
const SUPPORT: f64 = 1.0;

/// Where a freedom belongs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Freedom {
    Fixed,
    Inside(usize),
    /// Among those of the left edge, then of the right one.
    Edge(usize),
}

/// A factorised sector.
pub struct Sector {
    /// Two for each node: along x and y, on the edges radial and clockwise.
    freedoms: Vec<[Freedom; 2]>,
    /// Radial direction of the edges: left, right.
    directions: [[f64; 2]; 2],
    inside: usize,
    /// Freedoms of one edge.
    edge: usize,
    factor: Factor,
    /// Stiffness of the edges with the inside eliminated and with their supports, by columns.
    supported: Vec<Vec<f64>>,
}

/// A load (or what measures a displacement by its work) as forces at nodes.
pub type NodalForces = Vec<(usize, [f64; 2])>;

/// What a load does to the sector on its own, on its supports.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    /// Displacements, of the inside and then of the edges.
    moved: Vec<f64>,
    /// What it would press on the edges, left and right, if they were held.
    pub pressed: [Vec<f64>; 2],
}

impl Sector {
    /// # Errors
    /// When an element is folded over, or the stiffness is not positive definite to rounding.
    pub fn new(mesh: &ElementMesh, elasticity: &Elasticity) -> Result<Self, MeshError> {
        Self::factorised(mesh, elasticity, Order::Blocks)
    }

    pub(super) fn factorised(mesh: &ElementMesh, elasticity: &Elasticity, order: Order) -> Result<Self, MeshError> {
        let (freedoms, inside) = number(mesh);
        let edge = 2 * mesh.left.len();
        let (sine, cosine) = libm::sincos(mesh.half_pitch);
        let directions = [[-sine, cosine], [sine, cosine]];
        let mut entries = Entries::default();
        for (index, element) in mesh.elements.iter().enumerate() {
            let folded = MeshError::Folded { element: index + 1, elements: mesh.elements.len() };
            let mut matrix = stiffness(&mesh.corners(index), elasticity).ok_or(folded)?;
            let mut places = [None; FREEDOMS];
            for (local, &node) in element.iter().enumerate() {
                for (place, freedom) in places[2 * local..].iter_mut().zip(freedoms[node]) {
                    *place = match freedom {
                        Freedom::Fixed => None,
                        Freedom::Inside(place) => Some(place),
                        Freedom::Edge(place) => Some(inside + place),
                    };
                }
                if let Freedom::Edge(place) = freedoms[node][0] {
                    turn(&mut matrix, local, directions[usize::from(place >= edge)]);
                }
            }
            for (&row, values) in places.iter().zip(matrix) {
                let Some(row) = row else { continue };
                for (&column, value) in places.iter().zip(values) {
                    if let Some(column) = column.filter(|&column| row >= column) {
                        entries.add(row, column, value);
                    }
                }
            }
        }
        for place in inside..inside + 2 * edge {
            entries.add(place, place, SUPPORT);
        }
        let factor = Factor::new(&entries, inside, inside + 2 * edge, order).map_err(|error| match error {
            CholeskyError::Memory => MeshError::Memory,
            CholeskyError::Singular => MeshError::Singular,
        })?;
        let supported = factor.trailing(inside);
        Ok(Self { freedoms, directions, inside, edge, factor, supported })
    }

    /// Stiffness of the edges with the inside eliminated, by columns, left edge before right edge; symmetric.
    #[must_use]
    pub fn stiffness(&self) -> Vec<Vec<f64>> {
        let mut stiffness = self.supported.clone();
        for (place, column) in stiffness.iter_mut().enumerate() {
            column[place] -= SUPPORT;
        }
        stiffness
    }

    /// What loads do to the sector on its own.
    #[must_use]
    pub fn responses(&self, loads: &[NodalForces]) -> Vec<Response> {
        let size = self.inside + 2 * self.edge;
        let mut columns = vec![0.0; size * loads.len()];
        for (column, load) in columns.chunks_mut(size).zip(loads) {
            for &(node, force) in load {
                for (freedom, value) in self.freedoms[node].into_iter().zip(force) {
                    if let Freedom::Inside(place) = freedom {
                        column[place] += value;
                    }
                }
            }
        }
        for block in columns.chunks_mut(size * BLOCK) {
            self.factor.solve(block);
        }
        let response = |moved: &[f64]| {
            let forces = self.held_by(&moved[self.inside..]);
            let pressed = [forces[..self.edge].to_vec(), forces[self.edge..].to_vec()];
            Response { moved: moved.to_vec(), pressed }
        };
        columns.chunks(size).map(response).collect()
    }

    /// The forces that the condensed, supported edges need for displacements.
    fn held_by(&self, edges: &[f64]) -> Vec<f64> {
        let mut forces = vec![0.0; 2 * self.edge];
        for (column, displacement) in self.supported.iter().zip(edges) {
            for (force, stiffness) in forces.iter_mut().zip(column) {
                *force += stiffness * displacement;
            }
        }
        forces
    }

    /// The work of `probe` on what a load does to the sector with both edges held, from the responses to both.
    #[must_use]
    pub fn held_work(&self, probe: &NodalForces, of_probe: &Response, of_load: &Response) -> f64 {
        let part = |freedom: Freedom, force: f64| match freedom {
            Freedom::Inside(place) => force * of_load.moved[place],
            _ => 0.0,
        };
        let free: f64 =
            probe.iter().map(|&(node, [x, y])| part(self.freedoms[node][0], x) + part(self.freedoms[node][1], y)).sum();
        let [left, right] = &of_probe.pressed;
        let edges = &of_load.moved[self.inside..];
        let held: f64 = left.iter().chain(right).zip(edges).map(|(force, displacement)| force * displacement).sum();
        free - held
    }

    /// Displacements (x, y) of all nodes under a load, the edges' own displacements (left, then right) being known.
    #[must_use]
    pub fn displacements(&self, of_load: &Response, edges: &[f64]) -> Vec<[f64; 2]> {
        // The forces on the supported edges that move them from where the load alone brings them.
        let differences: Vec<f64> =
            edges.iter().zip(&of_load.moved[self.inside..]).map(|(to, from)| to - from).collect();
        let mut moved = vec![0.0; self.inside];
        moved.extend(self.held_by(&differences));
        self.factor.solve(&mut moved);
        let value = |freedom: Freedom| match freedom {
            Freedom::Fixed => 0.0,
            Freedom::Inside(place) => of_load.moved[place] + moved[place],
            Freedom::Edge(place) => edges[place],
        };
        let node = |freedoms: &[Freedom; 2]| {
            let [first, second] = freedoms.map(value);
            match freedoms[0] {
                Freedom::Edge(place) => {
                    let [x, y] = self.directions[usize::from(place >= self.edge)];
                    [x * first + y * second, y * first - x * second]
                }
                _ => [first, second],
            }
        };
        self.freedoms.iter().map(node).collect()
    }

    /// Unknowns of a sector: each edge counts once, since two share it.
    #[must_use]
    pub fn unknowns(&self) -> usize {
        self.inside + self.edge
    }
}

fn number(mesh: &ElementMesh) -> (Vec<[Freedom; 2]>, usize) {
    let mut freedoms = vec![[Freedom::Inside(0); 2]; mesh.nodes.len()];
    for (place, &node) in mesh.left.iter().chain(&mesh.right).enumerate() {
        freedoms[node] = [Freedom::Edge(2 * place), Freedom::Edge(2 * place + 1)];
    }
    for &node in &mesh.bore {
        freedoms[node] = [Freedom::Fixed; 2];
    }
    let mut inside = 0;
    for freedom in freedoms.iter_mut().flatten() {
        if let Freedom::Inside(place) = freedom {
            *place = inside;
            inside += 1;
        }
    }
    (freedoms, inside)
}

/// The rows and columns of one node in radial and clockwise components: u_x = x u_r + y u_t, u_y = y u_r − x u_t.
fn turn(matrix: &mut [[f64; FREEDOMS]; FREEDOMS], node: usize, [x, y]: [f64; 2]) {
    let (first, second) = (2 * node, 2 * node + 1);
    for row in matrix.iter_mut() {
        (row[first], row[second]) = (x * row[first] + y * row[second], y * row[first] - x * row[second]);
    }
    let (above, below) = matrix.split_at_mut(second);
    for (a, b) in above[first].iter_mut().zip(&mut below[0]) {
        (*a, *b) = (x * *a + y * *b, y * *a - x * *b);
    }
}
