//! The linear equations of a step of Newton's method for loads that deflect each other, bordered by that of their sum.
//!
//! Must not know: what the springs are, how many steps there are.

use super::{Coupling, MOST_SPRINGS, PerSpring};

/// Load changes of the loaded springs: `particular` undoes the residual, `unit` follows a unit of approach.
pub(in crate::numeric) struct Bordered {
    pub(in crate::numeric) particular: PerSpring,
    pub(in crate::numeric) unit: PerSpring,
    pub(in crate::numeric) offset: f64,
    pub(in crate::numeric) slope: f64,
}

impl Bordered {
    /// Cholesky's factorisation of the compliance matrix of the loaded springs; `None` when it is not positive definite
    /// or nothing is loaded.
    pub(in crate::numeric) fn solve(
        coupling: &Coupling,
        rises: &PerSpring,
        residual: &PerSpring,
        count: usize,
    ) -> Option<Self> {
        let mut loaded = [0; MOST_SPRINGS];
        let mut size = 0;
        for (spring, _) in rises[..count].iter().enumerate().filter(|(_, rise)| **rise > 0.0) {
            loaded[size] = spring;
            size += 1;
        }
        if size <= 2 {
            return Self::solve_two(coupling, rises, residual, &loaded[..size]);
        }
        let mut factor = [[0.0; MOST_SPRINGS]; MOST_SPRINGS];
        let (mut a, mut b) = ([0.0; MOST_SPRINGS], [0.0; MOST_SPRINGS]);
        for i in 0..size {
            for k in 0..=i {
                let (row, column) = (loaded[i], loaded[k]);
                let entry = if i == k { 1.0 / rises[row] } else { coupling[row][column] };
                let rest = entry - (0..k).map(|m| factor[i][m] * factor[k][m]).sum::<f64>();
                if i == k {
                    if rest <= 0.0 || !rest.is_finite() {
                        return None;
                    }
                    factor[i][i] = rest.sqrt();
                } else {
                    factor[i][k] = rest / factor[k][k];
                }
            }
            let below = |y: &PerSpring| (0..i).map(|m| factor[i][m] * y[m]).sum::<f64>();
            (a[i], b[i]) = ((-residual[loaded[i]] - below(&a)) / factor[i][i], (1.0 - below(&b)) / factor[i][i]);
        }
        let mut solved = Self { particular: [0.0; MOST_SPRINGS], unit: [0.0; MOST_SPRINGS], offset: 0.0, slope: 0.0 };
        for i in (0..size).rev() {
            for k in i + 1..size {
                a[i] -= factor[k][i] * a[k];
                b[i] -= factor[k][i] * b[k];
            }
            a[i] /= factor[i][i];
            b[i] /= factor[i][i];
            (solved.particular[loaded[i]], solved.unit[loaded[i]]) = (a[i], b[i]);
            solved.offset += a[i];
            solved.slope += b[i];
        }
        (solved.slope > 0.0).then_some(solved)
    }

    /// The same of one or two loaded springs, by their determinant.
    fn solve_two(coupling: &Coupling, rises: &PerSpring, residual: &PerSpring, loaded: &[usize]) -> Option<Self> {
        let mut solved = Self { particular: [0.0; MOST_SPRINGS], unit: [0.0; MOST_SPRINGS], offset: 0.0, slope: 0.0 };
        match *loaded {
            [one] => (solved.particular[one], solved.unit[one]) = (-residual[one] * rises[one], rises[one]),
            [one, two] => {
                // Of the matrix whose rows are times the springs' stiffnesses.
                let [towards_one, towards_two] = [one, two].map(|spring| coupling[one][two] * rises[spring]);
                let determinant = 1.0 - towards_one * towards_two;
                if determinant <= 0.0 || !determinant.is_finite() {
                    return None;
                }
                let pair = |a: f64, b: f64| {
                    let (a, b) = (a * rises[one], b * rises[two]);
                    [(a - towards_one * b) / determinant, (b - towards_two * a) / determinant]
                };
                [solved.particular[one], solved.particular[two]] = pair(-residual[one], -residual[two]);
                [solved.unit[one], solved.unit[two]] = pair(1.0, 1.0);
            }
            _ => {}
        }
        for spring in loaded {
            solved.offset += solved.particular[*spring];
            solved.slope += solved.unit[*spring];
        }
        (solved.slope > 0.0).then_some(solved)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tier: invariant; the equations hold, of one and two loaded springs, which have a closed form, and of more.
    #[test]
    fn changes_undo_the_residual() {
        let mut coupling: Coupling = [PerSpring::default(); MOST_SPRINGS];
        for (row, column, value) in [(0, 1, 0.3), (0, 2, 0.1), (1, 2, 0.2), (1, 3, -0.1), (2, 3, 0.25)] {
            (coupling[row][column], coupling[column][row]) = (value, value);
        }
        let residual = [0.4, -1.0, 0.7, 2.0, 0.0, 0.0];
        for loaded in [[1, 0, 0, 0], [0, 0, 1, 0], [1, 1, 0, 0], [0, 1, 0, 1], [1, 1, 1, 0], [1, 1, 1, 1]] {
            let mut rises = [0.0; MOST_SPRINGS];
            for (spring, loaded) in loaded.iter().enumerate().filter(|(_, loaded)| **loaded > 0) {
                rises[spring] = f64::from(*loaded) / (1.0 + 0.3 * spring as f64);
            }
            let solved = Bordered::solve(&coupling, &rises, &residual, 4).unwrap();
            let (mut offset, mut slope) = (0.0, 0.0);
            for row in (0..4).filter(|row| rises[*row] > 0.0) {
                let product = |of: &PerSpring| {
                    let others = (0..4).filter(|other| *other != row).map(|other| coupling[row][other] * of[other]);
                    of[row] / rises[row] + others.sum::<f64>()
                };
                assert!((product(&solved.particular) + residual[row]).abs() < 1e-14, "{loaded:?}");
                assert!((product(&solved.unit) - 1.0).abs() < 1e-14, "{loaded:?}");
                offset += solved.particular[row];
                slope += solved.unit[row];
            }
            assert!((solved.offset - offset).abs() < 1e-14 && (solved.slope - slope).abs() < 1e-14);
        }
        // Two springs that deflect each other more than themselves.
        let mut stiff = [0.0; MOST_SPRINGS];
        (stiff[0], stiff[1]) = (5.0, 5.0);
        assert!(Bordered::solve(&coupling, &stiff, &residual, 4).is_none());
    }
}
