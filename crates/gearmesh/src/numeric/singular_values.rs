//! The singular values of a small dense matrix: A = U diag(s) Vᵀ.
//!
//! By one-sided Jacobi rotations, which find small singular values to their own digits (Demmel and Veselić, SIAM J. Matrix
//! Anal. Appl. 13 (1992) 1204; Golub and Van Loan, Matrix Computations, 4th edition, section 8.6.3). Must not know: what the
//! columns are.

/// Sweeps over all pairs of columns: a handful is enough, and each halves the digits that are left.
const MOST_SWEEPS: usize = 60;

/// A matrix taken apart; of each column of A one value.
#[derive(Clone, Debug)]
pub struct SingularValues {
    /// s, descending.
    pub values: Vec<f64>,
    /// Columns of U, of length 1, or 0 where the value is 0.
    pub left: Vec<Vec<f64>>,
    /// Columns of V.
    pub right: Vec<Vec<f64>>,
}

impl SingularValues {
    /// Of a matrix by its columns, which have one length.
    #[must_use]
    pub fn of(columns: &[Vec<f64>]) -> Self {
        let count = columns.len();
        let mut turned = columns.to_vec();
        let mut right: Vec<Vec<f64>> =
            (0..count).map(|at| (0..count).map(|row| f64::from(u8::from(at == row))).collect()).collect();
        for _ in 0..MOST_SWEEPS {
            let mut is_done = true;
            for one in 0..count {
                for two in one + 1..count {
                    let (a, b) = (dot(&turned[one], &turned[one]), dot(&turned[two], &turned[two]));
                    let c = dot(&turned[one], &turned[two]);
                    if c == 0.0 || c.abs() <= f64::EPSILON * (a * b).sqrt() {
                        continue;
                    }
                    is_done = false;
                    let zeta = (b - a) / (2.0 * c);
                    let tangent = zeta.signum() / (zeta.abs() + libm::hypot(1.0, zeta));
                    let cosine = 1.0 / libm::hypot(1.0, tangent);
                    rotate(&mut turned, [one, two], cosine, tangent * cosine);
                    rotate(&mut right, [one, two], cosine, tangent * cosine);
                }
            }
            if is_done {
                break;
            }
        }
        let mut parts: Vec<(f64, Vec<f64>, Vec<f64>)> = turned
            .into_iter()
            .zip(right)
            .map(|(column, right)| {
                let value = dot(&column, &column).sqrt();
                let left = column.iter().map(|entry| if value > 0.0 { entry / value } else { 0.0 }).collect();
                (value, left, right)
            })
            .collect();
        parts.sort_by(|one, two| two.0.total_cmp(&one.0));
        let mut found = Self { values: Vec::new(), left: Vec::new(), right: Vec::new() };
        for (value, left, right) in parts {
            found.values.push(value);
            found.left.push(left);
            found.right.push(right);
        }
        found
    }
}

/// Σ aᵢ bᵢ.
#[must_use]
pub fn dot(one: &[f64], two: &[f64]) -> f64 {
    one.iter().zip(two).map(|(one, two)| one * two).sum()
}

fn rotate(columns: &mut [Vec<f64>], [one, two]: [usize; 2], cosine: f64, sine: f64) {
    for row in 0..columns[one].len() {
        let (a, b) = (columns[one][row], columns[two][row]);
        columns[one][row] = cosine * a - sine * b;
        columns[two][row] = sine * a + cosine * b;
    }
}

#[cfg(test)]
mod tests;
