//! The whole gear: a ring of identical sectors, solved by Fourier series over the sectors.
//!
//! Edge j lies between the sectors j − 1 and j, which are counted clockwise. Every row of the ring's stiffness is
//! S_RL e_(j−1) + (S_LL + S_RR) e_j + S_LR e_(j+1); harmonic n turns it into one Hermitian system of the size of an edge.
//! Sectors are their own mirror images, so it is real when tangential freedoms are counted in units of i.
//! Source: Thomas, International Journal for Numerical Methods in Engineering 14 (1979) 81–102 (cyclic symmetry).
//! Must not know: elements, teeth.

use super::MeshError;

/// What presses on the edges of one sector: left, right; radial and clockwise alternate.
pub type Pressed = [Vec<f64>; 2];

/// Real and imaginary part, freedom by freedom.
type Wave = Vec<[f64; 2]>;

/// A ring of `sectors`, each with a stiffness (by columns, left edge before right edge).
pub struct Wheel<'a> {
    /// z: one sector per tooth.
    pub sectors: u32,
    /// Forces on the edges of a sector per displacement of them, dimensionless as E = 1; square and symmetric.
    pub stiffness: &'a [Vec<f64>],
}

impl Wheel<'_> {
    fn edge(&self) -> usize {
        self.stiffness.len() / 2
    }

    /// cos and sin of 2π n k/z, from the remainder so that they do not lose digits.
    fn turn(&self, harmonic: u32, steps: u32) -> [f64; 2] {
        let part = u64::from(harmonic) * u64::from(steps) % u64::from(self.sectors);
        let (sine, cosine) = libm::sincos(std::f64::consts::TAU * part as f64 / f64::from(self.sectors));
        [cosine, sine]
    }

    /// The lower half of a harmonic's matrix, by rows.
    fn matrix(&self, [cosine, sine]: [f64; 2]) -> Vec<Vec<f64>> {
        let edge = self.edge();
        let across = |row: usize, column: usize| self.stiffness[edge + column][row];
        let entry = |row: usize, column: usize| {
            let (there, back) = (across(row, column), across(column, row));
            match (row % 2, column % 2) {
                (0, 1) => -sine * (there - back),
                (1, 0) => sine * (there - back),
                _ => {
                    let own = self.stiffness[column][row] + self.stiffness[edge + column][edge + row];
                    own + cosine * (there + back)
                }
            }
        };
        (0..edge).map(|row| (0..=row).map(|column| entry(row, column)).collect()).collect()
    }

    /// A pressure's harmonic, real and imaginary: left + e^(−iφ) right, tangential parts over i.
    fn wave([cosine, sine]: [f64; 2], [left, right]: &Pressed) -> Wave {
        let part = |(place, (left, right)): (usize, (&f64, &f64))| {
            let (real, imaginary) = (left + cosine * right, -sine * right);
            if place % 2 == 0 { [real, imaginary] } else { [imaginary, -real] }
        };
        left.iter().zip(right).enumerate().map(part).collect()
    }

    /// Work \[affected, load\] of the pressures `affected`, on a sector k pitches clockwise, on what the `loads` do, for
    /// each of `steps` k.
    ///
    /// # Errors
    /// When the ring is not held to rounding.
    pub fn influences(
        &self,
        affected: &[&Pressed],
        loads: &[&Pressed],
        steps: &[u32],
    ) -> Result<Vec<Vec<Vec<f64>>>, MeshError> {
        let mut result = vec![vec![vec![0.0; loads.len()]; affected.len()]; steps.len()];
        for harmonic in 0..=self.sectors / 2 {
            let turn = self.turn(harmonic, 1);
            let factor = cholesky(self.matrix(turn)).ok_or(MeshError::Singular)?;
            let solved = |pressed: &&Pressed| forward(&factor, Self::wave(turn, pressed));
            let waves: Vec<Wave> = loads.iter().map(solved).collect();
            let others: Vec<Wave> =
                if std::ptr::eq(affected, loads) { Vec::new() } else { affected.iter().map(solved).collect() };
            let affected = if std::ptr::eq(affected, loads) { &waves } else { &others };
            let twice = if harmonic == 0 || 2 * harmonic == self.sectors { 1.0 } else { 2.0 };
            let weight = twice / f64::from(self.sectors);
            let turns: Vec<[f64; 2]> = steps.iter().map(|&step| self.turn(harmonic, step)).collect();
            for (row, affected) in affected.iter().enumerate() {
                for (column, load) in waves.iter().enumerate() {
                    let [real, imaginary] = work(affected, load);
                    for ([cosine, sine], matrix) in turns.iter().zip(&mut result) {
                        matrix[row][column] += weight * (cosine * real - sine * imaginary);
                    }
                }
            }
        }
        Ok(result)
    }

    /// Displacements of the edges (left, then right) of the pressed sector itself, for each of several pressures.
    ///
    /// # Errors
    /// As [`Self::influences`].
    pub fn displacements(&self, pressed: &[&Pressed]) -> Result<Vec<Vec<f64>>, MeshError> {
        let edge = self.edge();
        let unit = |place: usize| {
            let mut sides = [vec![0.0; edge], vec![0.0; edge]];
            sides[place / edge][place % edge] = 1.0;
            sides
        };
        let units: Vec<Pressed> = (0..2 * edge).map(unit).collect();
        let found = self.influences(&units.iter().collect::<Vec<_>>(), pressed, &[0])?;
        Ok((0..pressed.len()).map(|load| found[0].iter().map(|row| row[load]).collect()).collect())
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// L of L Lᵀ, in place of the lower half by rows; `None` when a pivot is not positive.
fn cholesky(mut rows: Vec<Vec<f64>>) -> Option<Vec<Vec<f64>>> {
    for row in 0..rows.len() {
        let (above, rest) = rows.split_at_mut(row);
        let current = &mut rest[0];
        for column in 0..row {
            let known = dot(&current[..column], &above[column][..column]);
            current[column] = (current[column] - known) / above[column][column];
        }
        let pivot = current[row] - dot(&current[..row], &current[..row]);
        if !(pivot > 0.0 && pivot.is_finite()) {
            return None;
        }
        current[row] = pivot.sqrt();
    }
    Some(rows)
}

/// L⁻¹ b. Both parts side by side: a processor adds to several sums in the time of one.
fn forward(factor: &[Vec<f64>], mut values: Wave) -> Wave {
    for (row, entries) in factor.iter().enumerate() {
        let known = entries[..row].iter().zip(&values).fold([0.0; 2], |[real, imaginary], (entry, value)| {
            [real + entry * value[0], imaginary + entry * value[1]]
        });
        values[row] = [0, 1].map(|part| (values[row][part] - known[part]) / entries[row]);
    }
    values
}

/// Real and imaginary part of the sum of conj(one) other.
fn work(one: &Wave, other: &Wave) -> [f64; 2] {
    let products = one
        .iter()
        .zip(other)
        .fold([0.0; 4], |sums, ([a, b], [c, d])| [sums[0] + a * c, sums[1] + b * d, sums[2] + a * d, sums[3] + b * c]);
    [products[0] + products[1], products[2] - products[3]]
}
