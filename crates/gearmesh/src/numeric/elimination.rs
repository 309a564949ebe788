//! A few dense linear equations.
//!
//! Source: Golub and Van Loan, Matrix Computations, 4th edition, section 3.4. Must not know: what the unknowns are.

/// Gaussian elimination with partial pivoting: `rows` hold a square matrix and, in the columns behind it, right-hand sides,
/// in the place of which the solutions are put; they are not finite where the matrix is singular.
pub fn solve<const WIDTH: usize>(rows: &mut [[f64; WIDTH]]) {
    let size = rows.len();
    for column in 0..size {
        let larger = |a: usize, b: usize| if rows[b][column].abs() > rows[a][column].abs() { b } else { a };
        let pivot = (column..size).fold(column, larger);
        rows.swap(column, pivot);
        let above = rows[column];
        for row in &mut rows[column + 1..] {
            let factor = row[column] / above[column];
            for (value, pivot) in row[column..].iter_mut().zip(&above[column..]) {
                *value -= factor * pivot;
            }
        }
    }
    for row in (0..size).rev() {
        for side in size..WIDTH {
            let known: f64 = (row + 1..size).map(|column| rows[row][column] * rows[column][side]).sum();
            rows[row][side] = (rows[row][side] - known) / rows[row][row];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tier: closed form; Hilbert's matrix of order 4, whose inverse is whole numbers, with a zero where the first pivot
    /// would be.
    #[test]
    fn the_inverse_of_hilberts_matrix_is_whole() {
        let inverse = [
            [16.0, -120.0, 240.0, -140.0],
            [-120.0, 1200.0, -2700.0, 1680.0],
            [240.0, -2700.0, 6480.0, -4200.0],
            [-140.0, 1680.0, -4200.0, 2800.0],
        ];
        let mut rows = [[0.0; 9]; 5];
        // The last row is put first, where it begins with 0.
        rows[0][4] = 2.0;
        for (i, row) in rows[1..].iter_mut().enumerate() {
            for (j, value) in row[..4].iter_mut().enumerate() {
                *value = 1.0 / (i + j + 1) as f64;
            }
            row[5 + i] = 1.0;
        }
        solve(&mut rows);
        for (row, exact) in rows.iter().zip(inverse) {
            for (found, exact) in row[5..].iter().zip(exact) {
                assert!((found / exact - 1.0).abs() < 1e-11, "{found} for {exact}");
            }
        }
    }
}
