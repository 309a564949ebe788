//! Correlations between fields: a Gaussian copula, of which any share is found by itself.
//!
//! What is stated is the correlation of the normal numbers behind the shares: that of the fields themselves where they are
//! normal, and otherwise nearly so, with the rank correlation (6/π) asin(ρ/2) (Nelsen, An Introduction to Copulas, 2006, 5.1).
//! Must not know: what a field is.

use crate::stage::rows::Column;
use declare::Declared;
use declare::declared::Placed;
use declare::error::{Diagnostic, suggest};
use gearmesh::numeric::normal;

/// Two fields that go together.
#[derive(Debug, Declared)]
pub struct Correlation {
    /// The names of two columns.
    #[declared(example = "pinion_slope")]
    pub between: Vec<Placed<String>>,
    /// Their correlation.
    #[declared(minimum = -1.0, maximum = 1.0, example = "0.5")]
    pub is: f64,
}

/// The lower factor of the matrix of correlations, by rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Copula(Vec<Vec<f64>>);

/// A pivot that is no more than rounding, and the factor that it has none.
const LEAST: f64 = 1e-12;

impl Copula {
    /// Of the columns that are distributed, in their order; none where nothing is correlated.
    ///
    /// # Errors
    /// A name that is no such column; a matrix that no numbers have.
    pub fn new(stated: &[Correlation], columns: &[&Column]) -> Result<Option<Self>, Diagnostic> {
        let names: Vec<&str> = columns.iter().map(|column| column.axis.name.as_str()).collect();
        let mut matrix: Vec<Vec<f64>> =
            (0..names.len()).map(|row| (0..names.len()).map(|at| f64::from(u8::from(at == row))).collect()).collect();
        let mut known: Vec<[usize; 2]> = Vec::new();
        let mut last = None;
        for Correlation { between, is } in stated {
            let [one, two] = &between[..] else {
                let place = between.first().map_or_else(Default::default, |name| name.place);
                let message = format!("`between` names two columns, not {}", between.len());
                return Err(Diagnostic::new(message).at(place));
            };
            let index = |name: &Placed<String>| {
                names.iter().position(|known| *known == name.value).ok_or_else(|| {
                    let message = format!("`{}` is none of the columns that are distributed", name.value);
                    Diagnostic::new(message).at(name.place).help(suggest(&name.value, names.iter().copied()))
                })
            };
            let pair = [index(one)?, index(two)?];
            if pair[0] == pair[1] {
                return Err(Diagnostic::new(format!("`{}` is one column", one.value)).at(two.place));
            }
            let pair = [pair[0].min(pair[1]), pair[0].max(pair[1])];
            if known.contains(&pair) {
                let message = format!("the correlation of `{}` and `{}` is stated twice", one.value, two.value);
                return Err(Diagnostic::new(message).at(one.place));
            }
            known.push(pair);
            matrix[pair[0]][pair[1]] = *is;
            matrix[pair[1]][pair[0]] = *is;
            last = Some((pair, one, two));
        }
        let Some((pair, one, two)) = last else { return Ok(None) };
        if let Some(factor) = factor(&matrix) {
            return Ok(Some(Self(factor)));
        }
        let wrong = Diagnostic::new("the correlations contradict each other: no numbers go together like that");
        Err(match admissible(&matrix, pair) {
            Some([low, high]) => wrong.at(one.place).help(format!(
                "with the others as they are, that of `{}` and `{}` lies between {low:.4} and {high:.4}",
                one.value, two.value
            )),
            None => wrong.at(one.place),
        })
    }

    /// Shares of correlated columns, from independent ones.
    pub fn correlate(&self, shares: &mut [f64]) {
        let independent: Vec<f64> = shares.iter().map(|share| normal::quantile(*share)).collect();
        for (share, row) in shares.iter_mut().zip(&self.0) {
            let sum: f64 = row.iter().zip(&independent).map(|(factor, number)| factor * number).sum();
            *share = normal::below(sum);
        }
    }

    /// All numbers of the factor.
    pub fn factors(&self) -> Vec<f64> {
        self.0.concat()
    }
}

/// L of L Lᵀ; none where the matrix is not positive definite.
fn factor(matrix: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let size = matrix.len();
    let mut factor = vec![vec![0.0; size]; size];
    for row in 0..size {
        for at in 0..=row {
            let sum: f64 = (0..at).map(|inner| factor[row][inner] * factor[at][inner]).sum();
            let rest = matrix[row][at] - sum;
            if at < row {
                factor[row][at] = rest / factor[at][at];
            } else if rest <= LEAST {
                return None;
            } else {
                factor[row][row] = rest.sqrt();
            }
        }
    }
    Some(factor)
}

/// Between which values one correlation may lie, with the others as they are: those of what the others leave of both.
fn admissible(matrix: &[Vec<f64>], [one, two]: [usize; 2]) -> Option<[f64; 2]> {
    let others: Vec<usize> = (0..matrix.len()).filter(|at| *at != one && *at != two).collect();
    let of_others: Vec<Vec<f64>> =
        others.iter().map(|row| others.iter().map(|at| matrix[*row][*at]).collect()).collect();
    let factor = factor(&of_others)?;
    // L⁻¹ r of both.
    let reduced = |of: usize| {
        let mut found: Vec<f64> = Vec::with_capacity(others.len());
        for (row, other) in others.iter().enumerate() {
            let sum: f64 = factor[row].iter().zip(&found).map(|(factor, known)| factor * known).sum();
            found.push((matrix[*other][of] - sum) / factor[row][row]);
        }
        found
    };
    let (first, second) = (reduced(one), reduced(two));
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let left = [1.0 - product(&first, &first), 1.0 - product(&second, &second)];
    let half = (left[0].max(0.0) * left[1].max(0.0)).sqrt();
    let middle = product(&first, &second);
    (left[0] > 0.0 && left[1] > 0.0).then_some([middle - half, middle + half])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(ab: f64, bc: f64, ac: f64) -> Vec<Vec<f64>> {
        vec![vec![1.0, ab, ac], vec![ab, 1.0, bc], vec![ac, bc, 1.0]]
    }

    /// Tier: closed form; of three, ρ_ac lies within ρ_ab ρ_bc ± √((1 − ρ_ab²)(1 − ρ_bc²)).
    #[test]
    fn contradictory_correlations_say_what_would_be_possible() {
        let [low, high] = admissible(&matrix(0.9, 0.9, -0.9), [0, 2]).unwrap();
        assert!((low - 0.62).abs() < 1e-12 && (high - 1.0).abs() < 1e-12, "{low} {high}");
        assert!(factor(&matrix(0.9, 0.9, -0.9)).is_none() && factor(&matrix(0.9, 0.9, 0.63)).is_some());
        assert!(factor(&matrix(0.9, 0.9, 0.61)).is_none() && factor(&matrix(1.0, 0.0, 0.0)).is_none());
    }

    /// Tier: closed form; of even points the shares have the rank correlation (6/π) asin(ρ/2) and stay uniform.
    #[test]
    fn shares_have_the_correlation_that_is_stated() {
        let copula = Copula(factor(&[vec![1.0, 0.7], vec![0.7, 1.0]]).unwrap());
        let side = 200;
        let (mut both, mut second, mut squares) = (0.0, 0.0, 0.0);
        for at in 0..side * side {
            let mut shares = [at % side, at / side].map(|at| (f64::from(at) + 0.5) / f64::from(side));
            copula.correlate(&mut shares);
            let [one, two] = shares.map(|share| share - 0.5);
            (both, second, squares) = (both + one * two, second + two, squares + two * two);
        }
        let count = f64::from(side * side);
        let exact = 6.0 / std::f64::consts::PI * libm::asin(0.35);
        assert!((12.0 * both / count - exact).abs() < 1e-3, "{} {exact}", 12.0 * both / count);
        assert!((second / count).abs() < 1e-12 && (12.0 * squares / count - 1.0).abs() < 2e-3);
    }
}
