//! How well residuals determine parameters: covariance, condition, directions in which nothing changes, and which fits are one.
//!
//! Source: Bates and Watts, Nonlinear Regression Analysis (1988), 2.2; Belsley, Kuh and Welsch, Regression Diagnostics (1980),
//! 3.2 for the condition of columns that are scaled to one length. Must not know: how a fit was found.

use super::Fit;
use crate::numeric::singular_values::{SingularValues, dot};

/// Singular values of scaled columns below this share of the largest are none, beside what derivatives are off by.
const NOTHING: f64 = 1e-9;
/// A column is noise unless it is longer than its error by this factor.
const ABOVE_NOISE: f64 = 3.0;
/// Parameters whose share of a direction is below this have no part in it.
const NO_PART: f64 = 1e-4;

/// How well the residuals of a fit determine its parameters.
#[derive(Clone, Debug)]
pub struct Uncertainty {
    /// (Jᵀ J)⁻¹ of the parameters that are not held: their covariance where every residual has a standard deviation of 1. NaN
    /// for those that are held, infinite on the diagonal for those that the residuals do not determine.
    pub covariance: Vec<Vec<f64>>,
    /// The largest over the least singular value of the columns scaled to one length; infinite where one is none.
    pub condition: f64,
    /// How many directions of the parameters the residuals determine.
    pub rank: usize,
    /// How many parameters are not held.
    pub free: usize,
    /// A direction along which no residual changes, by parameter, the largest part 1.
    pub flat: Option<Vec<f64>>,
}

impl Uncertainty {
    /// Of a fit.
    #[must_use]
    pub fn of(fit: &Fit) -> Self {
        let count = fit.point.len();
        let free: Vec<usize> = (0..count).filter(|at| !fit.is_held[*at]).collect();
        let lengths: Vec<f64> = fit.jacobian.iter().map(|column| dot(column, column).sqrt()).collect();
        let is_noise = |at: usize| lengths[at] <= ABOVE_NOISE * fit.doubt[at] || lengths[at] == 0.0;
        let scaled = free.iter().map(|&at| {
            let column = &fit.jacobian[at];
            column.iter().map(|entry| if is_noise(at) { 0.0 } else { entry / lengths[at] }).collect()
        });
        let parts = SingularValues::of(&scaled.collect::<Vec<Vec<f64>>>());
        let doubt = free.iter().filter(|at| !is_noise(**at)).map(|at| fit.doubt[*at] / lengths[*at]);
        let least = parts.values.first().map_or(0.0, |largest| largest * NOTHING.max(doubt.fold(0.0, f64::max)));
        let is_none: Vec<bool> = parts.values.iter().map(|value| *value <= least).collect();
        let mut covariance = vec![vec![f64::NAN; count]; count];
        for (one, &at) in free.iter().enumerate() {
            for (two, &other) in free.iter().enumerate() {
                let mut sum = 0.0;
                for (k, value) in parts.values.iter().enumerate() {
                    let both = parts.right[k][one] * parts.right[k][two];
                    if !is_none[k] {
                        sum += both / (value * value);
                    } else if both.abs() > NO_PART * NO_PART {
                        sum += if both > 0.0 { f64::INFINITY } else { f64::NEG_INFINITY };
                    }
                }
                let scale = |at: usize| if is_noise(at) { 1.0 } else { lengths[at] };
                covariance[at][other] = sum / (scale(at) * scale(other));
            }
        }
        let rank = is_none.iter().filter(|is_none| !**is_none).count();
        let flat = is_none.iter().position(|is_none| *is_none).map(|k| {
            let mut direction = vec![0.0; count];
            for (row, &at) in free.iter().enumerate() {
                direction[at] = parts.right[k][row] / if is_noise(at) { 1.0 } else { lengths[at] };
            }
            let largest = direction.iter().fold(0.0_f64, |largest, part| largest.max(part.abs()));
            direction.iter().map(|part| part / largest).collect()
        });
        let condition = match (parts.values.first(), parts.values.last()) {
            (Some(first), Some(last)) if rank == free.len() => first / last,
            (None, _) | (_, None) => f64::NAN,
            _ => f64::INFINITY,
        };
        Self { covariance, condition, rank, free: free.len(), flat }
    }

    /// Standard deviations of the parameters where every residual has this one.
    pub fn deviations(&self, of_residual: f64) -> impl Iterator<Item = f64> {
        (0..self.covariance.len()).map(move |at| of_residual * self.covariance[at][at].sqrt())
    }

    /// The correlation of two parameters; NaN where one is not determined.
    #[must_use]
    pub fn correlation(&self, one: usize, two: usize) -> f64 {
        let product = self.covariance[one][one] * self.covariance[two][two];
        if product.is_finite() { self.covariance[one][two] / product.sqrt() } else { f64::NAN }
    }
}

impl Fit {
    /// How many residuals there are beyond the parameters that are not held.
    #[must_use]
    pub fn freedom(&self) -> usize {
        let free = self.is_held.iter().filter(|is_held| !**is_held).count();
        self.residuals.len().saturating_sub(free)
    }

    /// Whether two fits are one: the sums of squares are alike, and the way from one to the other changes no residual by more
    /// than `alike`, or is short. `scales` are what counts as far, by parameter.
    #[must_use]
    pub fn is_as(&self, other: &Self, alike: f64, scales: &[f64]) -> bool {
        let way: Vec<f64> = self.point.iter().zip(&other.point).map(|(one, two)| two - one).collect();
        if way.iter().zip(scales).all(|(way, scale)| way.abs() <= 1e-6 * scale) {
            return true;
        }
        let changes = |jacobian: &[Vec<f64>]| {
            let rows = (0..self.residuals.len())
                .map(|row| jacobian.iter().zip(&way).map(|(column, way)| column[row] * way).sum::<f64>().abs());
            rows.fold(0.0, f64::max)
        };
        self.apart(other) <= alike && changes(&self.jacobian).min(changes(&other.jacobian)) <= alike
    }

    /// The largest difference of a residual of two fits.
    #[must_use]
    pub fn apart(&self, other: &Self) -> f64 {
        self.residuals.iter().zip(&other.residuals).map(|(one, two)| (one - two).abs()).fold(0.0, f64::max)
    }
}

/// How many digits of a value its standard deviation leaves: half a unit in the last of them is not less than the deviation.
/// 0 where none is left, or the deviation is not finite; 15 at most.
#[must_use]
pub fn digits(value: f64, deviation: f64) -> usize {
    if value == 0.0 || !value.is_finite() || deviation.is_nan() || deviation.is_infinite() {
        return 0;
    }
    let first = libm::floor(libm::log10(value.abs()));
    let count = libm::floor(first + 1.0 + libm::log10(0.5 / deviation.max(f64::MIN_POSITIVE)));
    // Whole, and between the two.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let count = count.clamp(0.0, 15.0) as usize;
    count
}
