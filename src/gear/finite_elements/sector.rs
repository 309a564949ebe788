//! One sector's stiffness: factorised once, its inside eliminated on to the two radial edges.
//!
//! Freedoms of the edges are radial and clockwise, so that they are the same seen from either sector that shares them.
//! Nondimensional: E = 1, lengths in modules, forces per width. Must not know: the ring of sectors, gears.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Conj, MatMut, Par, Side, Spec};

use super::MeshError;
use super::element::{Elasticity, FREEDOMS, stiffness};
use super::mesh::Mesh;

/// Columns solved for at a time.
const BLOCK: usize = 32;

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
    symbolic: SymbolicCholesky<usize>,
    factor: Vec<f64>,
    /// For each freedom of the edges the stiffness towards the inside.
    coupling: Vec<Vec<(usize, f64)>>,
    /// Stiffness of the edges with the inside eliminated, by columns.
    pub condensed: Vec<Vec<f64>>,
}

/// A load (or what measures a displacement by its work) as forces at nodes.
pub type NodalForces = Vec<(usize, [f64; 2])>;

impl Sector {
    /// # Errors
    /// When an element is folded over, or the stiffness is not positive definite to rounding.
    pub fn new(mesh: &Mesh, elasticity: &Elasticity) -> Result<Self, MeshError> {
        let (freedoms, inside) = number(mesh);
        let edge = 2 * mesh.left.len();
        let (sine, cosine) = libm::sincos(mesh.half_pitch);
        let directions = [[-sine, cosine], [sine, cosine]];
        let mut sector = Self {
            freedoms,
            directions,
            inside,
            edge,
            symbolic: factorize(&[], 0)?.0,
            factor: Vec::new(),
            coupling: vec![Vec::new(); 2 * edge],
            condensed: vec![vec![0.0; 2 * edge]; 2 * edge],
        };
        let mut triplets: Vec<Triplet<usize, usize, f64>> = Vec::new();
        for (index, element) in mesh.elements.iter().enumerate() {
            let folded = MeshError::Folded { element: index + 1, elements: mesh.elements.len() };
            let mut matrix = stiffness(&mesh.corners(index), elasticity).ok_or(folded)?;
            let mut places = [Freedom::Fixed; FREEDOMS];
            for (local, &node) in element.iter().enumerate() {
                places[2 * local..2 * local + 2].copy_from_slice(&sector.freedoms[node]);
                if let Freedom::Edge(place) = sector.freedoms[node][0] {
                    turn(&mut matrix, local, sector.directions[usize::from(place >= edge)]);
                }
            }
            for (row, from) in places.into_iter().enumerate() {
                for (column, to) in places.into_iter().enumerate() {
                    let value = matrix[row][column];
                    match (from, to) {
                        (Freedom::Inside(i), Freedom::Inside(j)) if i >= j => triplets.push(Triplet::new(i, j, value)),
                        (Freedom::Inside(i), Freedom::Edge(e)) => sector.coupling[e].push((i, value)),
                        (Freedom::Edge(d), Freedom::Edge(e)) => sector.condensed[e][d] += value,
                        _ => {}
                    }
                }
            }
        }
        (sector.symbolic, sector.factor) = factorize(&triplets, inside)?;
        sector.condense();
        Ok(sector)
    }

    /// S = K_EE − K_EI K_II⁻¹ K_IE.
    fn condense(&mut self) {
        let all: Vec<usize> = (0..2 * self.edge).collect();
        for block in all.chunks(BLOCK) {
            let mut columns = vec![0.0; self.inside * block.len()];
            for (column, &freedom) in columns.chunks_mut(self.inside).zip(block) {
                for &(place, value) in &self.coupling[freedom] {
                    column[place] += value;
                }
            }
            self.solve(&mut columns);
            for (column, &freedom) in columns.chunks(self.inside).zip(block) {
                for (other, row) in self.coupling.iter().enumerate() {
                    let moved: f64 = row.iter().map(|&(place, value)| value * column[place]).sum();
                    self.condensed[freedom][other] -= moved;
                }
            }
        }
        // Symmetric to rounding; exactly so that influences are reciprocal to the last bits.
        for row in 0..2 * self.edge {
            for column in 0..row {
                let mean = 0.5 * (self.condensed[row][column] + self.condensed[column][row]);
                self.condensed[row][column] = mean;
                self.condensed[column][row] = mean;
            }
        }
    }

    /// Displacements of the inside with both edges held, in place of forces; one column after the other.
    fn solve(&self, columns: &mut [f64]) {
        let count = columns.len() / self.inside;
        let mut memory = MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(count, Par::Seq));
        LltRef::new(&self.symbolic, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(columns, self.inside, count),
            Par::Seq,
            MemStack::new(&mut memory),
        );
    }

    /// Displacements of the inside under each load with both edges held.
    #[must_use]
    pub fn held(&self, loads: &[NodalForces]) -> Vec<Vec<f64>> {
        let mut columns = vec![0.0; self.inside * loads.len()];
        for (column, load) in columns.chunks_mut(self.inside).zip(loads) {
            for &(node, force) in load {
                for (freedom, value) in self.freedoms[node].into_iter().zip(force) {
                    if let Freedom::Inside(place) = freedom {
                        column[place] += value;
                    }
                }
            }
        }
        for block in columns.chunks_mut(self.inside * BLOCK) {
            self.solve(block);
        }
        columns.chunks(self.inside).map(<[f64]>::to_vec).collect()
    }

    /// What a load on the inside, whose displacements are `held`, presses on the edges: left, right.
    #[must_use]
    pub fn pressed(&self, held: &[f64]) -> [Vec<f64>; 2] {
        let forces: Vec<f64> = (self.coupling.iter())
            .map(|row| -row.iter().map(|&(place, value)| value * held[place]).sum::<f64>())
            .collect();
        [forces[..self.edge].to_vec(), forces[self.edge..].to_vec()]
    }

    /// The work of a load on displacements of the inside.
    #[must_use]
    pub fn work(&self, load: &NodalForces, inside: &[f64]) -> f64 {
        let part = |freedom: Freedom, force: f64| match freedom {
            Freedom::Inside(place) => force * inside[place],
            _ => 0.0,
        };
        load.iter().map(|&(node, [x, y])| part(self.freedoms[node][0], x) + part(self.freedoms[node][1], y)).sum()
    }

    /// Displacements (x, y) of all nodes: those of the inside with the edges `held`, and what the edges' own
    /// displacements (left, then right) add.
    #[must_use]
    pub fn displacements(&self, held: &[f64], edges: &[f64]) -> Vec<[f64; 2]> {
        let mut moved = vec![0.0; self.inside];
        for (row, edge) in self.coupling.iter().zip(edges) {
            for &(place, value) in row {
                moved[place] -= value * edge;
            }
        }
        self.solve(&mut moved);
        let value = |freedom: Freedom| match freedom {
            Freedom::Fixed => 0.0,
            Freedom::Inside(place) => held[place] + moved[place],
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

    /// Freedoms of one edge.
    #[must_use]
    pub fn edge(&self) -> usize {
        self.edge
    }

    /// Unknowns of a sector: each edge counts once, since two share it.
    #[must_use]
    pub fn unknowns(&self) -> usize {
        self.inside + self.edge
    }
}

fn number(mesh: &Mesh) -> (Vec<[Freedom; 2]>, usize) {
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
    for column in 0..FREEDOMS {
        let (a, b) = (matrix[first][column], matrix[second][column]);
        (matrix[first][column], matrix[second][column]) = (x * a + y * b, y * a - x * b);
    }
}

/// K = L Lᵀ of the lower half in triplets.
fn factorize(
    triplets: &[Triplet<usize, usize, f64>],
    size: usize,
) -> Result<(SymbolicCholesky<usize>, Vec<f64>), MeshError> {
    let matrix = SparseColMat::try_new_from_triplets(size, size, triplets).map_err(|_| MeshError::Memory)?;
    let ordering = SymmetricOrdering::Amd;
    let symbolic =
        factorize_symbolic_cholesky(matrix.symbolic(), Side::Lower, ordering, CholeskySymbolicParams::default())
            .map_err(|_| MeshError::Memory)?;
    let mut values = vec![0.0; symbolic.len_val()];
    let scratch = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default());
    symbolic
        .factorize_numeric_llt(
            &mut values,
            matrix.as_ref(),
            Side::Lower,
            LltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
            Spec::default(),
        )
        .map_err(|_| MeshError::Singular)?;
    Ok((symbolic, values))
}
