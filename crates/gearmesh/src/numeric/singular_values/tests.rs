//! Singular values against closed forms.

use super::*;

/// Tier: closed form; Läuchli's matrix [1 1; e 0; 0 e] has √(2 + e²) and e, of which a method by AᵀA loses the second.
#[test]
fn a_small_value_is_found_beside_a_large_one() {
    let small = 1e-9;
    let found = SingularValues::of(&[vec![1.0, small, 0.0], vec![1.0, 0.0, small]]);
    assert!((found.values[0] / 2.0_f64.sqrt() - 1.0).abs() < 1e-15);
    assert!((found.values[1] / small - 1.0).abs() < 1e-6, "{:e}", found.values[1]);
}

/// Tier: invariant; the parts make up the matrix, U and V have columns at right angles. Hilbert's matrix of order 5 with a
/// sixth row; the condition of order 5 is 476 607.25 (Todd, National Bureau of Standards AMS 39 (1954) 109).
#[test]
fn parts_make_up_hilberts_matrix() {
    let hilbert = |rows: usize| -> Vec<Vec<f64>> {
        (0..5).map(|j| (0..rows).map(|i| 1.0 / (i + j + 1) as f64).collect()).collect()
    };
    let matrix = hilbert(6);
    let found = SingularValues::of(&matrix);
    for (j, column) in matrix.iter().enumerate() {
        for (i, entry) in column.iter().enumerate() {
            let made: f64 = (0..5).map(|k| found.left[k][i] * found.values[k] * found.right[k][j]).sum();
            assert!((made - entry).abs() < 1e-15, "{i} {j}");
        }
    }
    for one in 0..5 {
        for two in 0..5 {
            let wanted = f64::from(u8::from(one == two));
            assert!((dot(&found.left[one], &found.left[two]) - wanted).abs() < 1e-14);
            assert!((dot(&found.right[one], &found.right[two]) - wanted).abs() < 1e-14);
        }
    }
    let square = SingularValues::of(&hilbert(5));
    assert!((square.values[0] / square.values[4] / 476_607.25 - 1.0).abs() < 1e-6);
}

/// Columns that say the same, or nothing, or more of them than rows: values of 0, and no NaN.
#[test]
fn what_is_not_independent_has_a_value_of_zero() {
    let same = SingularValues::of(&[vec![1.0, 2.0], vec![2.0, 4.0]]);
    assert!((same.values[0] - 5.0).abs() < 1e-14 && same.values[1] < 1e-15);
    // Along (2, −1) nothing changes.
    assert!((same.right[1][0] + 2.0 * same.right[1][1]).abs() < 1e-14);
    let nothing = SingularValues::of(&[vec![0.0], vec![0.0]]);
    assert!(nothing.values.iter().all(|value| *value == 0.0) && nothing.left[0][0] == 0.0);
    let wide = SingularValues::of(&[vec![3.0], vec![4.0]]);
    assert!((wide.values[0] - 5.0).abs() < 1e-15 && wide.values[1] < 1e-15);
}
