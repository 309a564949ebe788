//! The whole gear: a ring of identical sectors, solved by Fourier series over the sectors.
//!
//! Edge j lies between the sectors j − 1 and j, which are counted clockwise. Every row of the ring's stiffness is
//! S_RL e_(j−1) + (S_LL + S_RR) e_j + S_LR e_(j+1); harmonic n turns it into one Hermitian system of the size of an edge.
//! Source: Thomas, International Journal for Numerical Methods in Engineering 14 (1979) 81–102 (cyclic symmetry).
//! Must not know: elements, teeth.

use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Mat, Par, Side, c64};

use super::MeshError;

/// What presses on the edges of one sector: left, right.
pub type Pressed = [Vec<f64>; 2];

/// A ring of `sectors`, each with a stiffness (by columns, left edge before right edge).
pub struct Wheel<'a> {
    pub sectors: u32,
    pub stiffness: &'a [Vec<f64>],
}

impl Wheel<'_> {
    fn edge(&self) -> usize {
        self.stiffness.len() / 2
    }

    /// A harmonic's Hermitian matrix and e^(2πi n/z).
    fn matrix(&self, harmonic: u32) -> (Mat<c64>, c64) {
        let edge = self.edge();
        let turn = self.turn(harmonic, 1);
        let matrix = Mat::from_fn(edge, edge, |row, column| {
            let block = |right_row: bool, right_column: bool| {
                let column = if right_column { edge + column } else { column };
                self.stiffness[column][if right_row { edge + row } else { row }]
            };
            turn * block(false, true) + turn.conj() * block(true, false) + (block(false, false) + block(true, true))
        });
        (matrix, turn)
    }

    /// e^(2πi n k/z), from the remainder so that it does not lose digits.
    fn turn(&self, harmonic: u32, steps: u32) -> c64 {
        let part = u64::from(harmonic) * u64::from(steps) % u64::from(self.sectors);
        let (sine, cosine) = libm::sincos(std::f64::consts::TAU * part as f64 / f64::from(self.sectors));
        c64::new(cosine, sine)
    }

    /// Work \[load by affected, then load\] of the pressures `affected` on a sector k pitches clockwise of one that
    /// `loads` press, for each of `steps` k.
    ///
    /// # Errors
    /// When the ring is not held to rounding.
    pub fn influences(
        &self,
        affected: &[&Pressed],
        loads: &[&Pressed],
        steps: &[u32],
    ) -> Result<Vec<Vec<Vec<f64>>>, MeshError> {
        let edge = self.edge();
        let mut result = vec![vec![vec![0.0; loads.len()]; affected.len()]; steps.len()];
        let both: Vec<&Pressed> = affected.iter().chain(loads).copied().collect();
        for harmonic in 0..=self.sectors / 2 {
            let (matrix, turn) = self.matrix(harmonic);
            let factor = matrix.llt(Side::Lower).map_err(|_| MeshError::Singular)?;
            let mut waves = Mat::from_fn(edge, both.len(), |row, column| {
                turn.conj() * both[column][1][row] + both[column][0][row]
            });
            solve_lower_triangular_in_place(factor.L(), waves.as_mut(), Par::Seq);
            let twice = if harmonic == 0 || 2 * harmonic == self.sectors { 1.0 } else { 2.0 };
            let weight = twice / f64::from(self.sectors);
            for (row, column) in (0..affected.len()).flat_map(|row| (0..loads.len()).map(move |column| (row, column))) {
                let (left, right) = (waves.col(row), waves.col(affected.len() + column));
                let mut product = c64::new(0.0, 0.0);
                for place in 0..edge {
                    product += left[place].conj() * right[place];
                }
                for (&step, matrix) in steps.iter().zip(&mut result) {
                    matrix[row][column] += weight * (self.turn(harmonic, step) * product).re;
                }
            }
        }
        Ok(result)
    }

    /// Displacements of the edges (left, then right) of the pressed sector itself.
    ///
    /// # Errors
    /// As [`Self::influences`].
    pub fn displacements(&self, pressed: &Pressed) -> Result<Vec<f64>, MeshError> {
        let edge = self.edge();
        let unit = |place: usize| {
            let mut sides = [vec![0.0; edge], vec![0.0; edge]];
            sides[place / edge][place % edge] = 1.0;
            sides
        };
        let units: Vec<Pressed> = (0..2 * edge).map(unit).collect();
        let found = self.influences(&units.iter().collect::<Vec<_>>(), &[pressed], &[0])?;
        Ok(found[0].iter().map(|row| row[0]).collect())
    }
}
