//! Derivatives by central differences, with steps as long as the noise of the model asks for.
//!
//! The error of a central difference is least where that of its formula and that of the numbers are alike: at (3 ε/f‴)^(1/3),
//! with ε the noise (Gill, Murray and Wright, Practical Optimization (1981), 8.6). The noise itself is read off a table of
//! differences at points so near to each other that nothing but noise is left in the higher ones (Moré and Wild, SIAM J. Sci.
//! Comput. 33 (2011) 1292). Must not know: how a search goes on.

use super::Evaluate;
use crate::numeric::singular_values::dot;

/// A parameter's scale is its size, or this share of its range where that is more.
const OF_RANGE: f64 = 0.01;
/// Points of a table of differences, and how far they are apart, as a share of the scale.
const POINTS: usize = 7;
const APART: f64 = 1e-6;
/// Noise that is there in any case: of the rounding of a number of size 1.
const ROUNDING: f64 = f64::EPSILON;
/// The shortest and the longest step, as shares of the scale.
const SHORTEST: f64 = 1e-6;
const LONGEST: f64 = 0.05;
/// Steps that are wrong by less than this factor are kept.
const NEAR_ENOUGH: f64 = 3.0;

/// How long the steps are.
pub struct Steps {
    bounds: Vec<(f64, f64)>,
    /// By parameter, as shares of its scale.
    shares: Vec<f64>,
    /// Length of the noise of all residuals.
    noise: f64,
    is_fitted: bool,
}

/// The length of the noise of all residuals around a point; none where the model has none there.
///
/// # Errors
/// What `evaluate` says.
pub fn noise<E>(bounds: &[(f64, f64)], point: &[f64], evaluate: Evaluate<E>) -> Result<Option<f64>, E> {
    let scales = Steps::new(bounds, 0.0).scales(point);
    // Inward, so that all points are in the box.
    let way = point.iter().zip(bounds).zip(&scales);
    let way: Vec<f64> =
        way.map(|((value, (low, high)), scale)| if high - value > value - low { *scale } else { -scale }).collect();
    let at = |number: usize| {
        let along = APART * number as f64;
        point.iter().zip(&way).map(|(value, way)| value + along * way).collect::<Vec<f64>>()
    };
    let points: Vec<Vec<f64>> = (0..POINTS).map(at).collect();
    let answers = evaluate(&points)?;
    let Some(middle) = answers[0].clone() else { return Ok(None) };
    let all: Option<Vec<Vec<f64>>> = answers.into_iter().collect();
    let of_row = |row: usize| {
        let floor = ROUNDING * middle[row].abs();
        let values = all.as_ref().map(|all| all.iter().map(|answer| answer[row]).collect());
        values.and_then(noise_in).unwrap_or(0.0).max(floor)
    };
    let all: Vec<f64> = (0..middle.len()).map(of_row).collect();
    Ok(Some(dot(&all, &all).sqrt()))
}

impl Steps {
    /// For a model with this noise.
    pub fn new(bounds: &[(f64, f64)], noise: f64) -> Self {
        let share = libm::cbrt(3.0 * ROUNDING);
        Self { bounds: bounds.to_vec(), shares: vec![share; bounds.len()], noise, is_fitted: false }
    }

    /// Over which length each parameter changes much.
    pub fn scales(&self, point: &[f64]) -> Vec<f64> {
        let one = |(value, (low, high)): (&f64, &(f64, f64))| value.abs().max(OF_RANGE * (high - low));
        point.iter().zip(&self.bounds).map(one).collect()
    }

    /// By parameter, the length of what noise does to its derivative.
    pub fn doubt(&self, point: &[f64]) -> Vec<f64> {
        self.scales(point).iter().zip(&self.shares).map(|(scale, share)| self.noise / (share * scale)).collect()
    }

    /// By parameter, the derivatives of the residuals; 0 where the model has no residuals to either side.
    ///
    /// # Errors
    /// What `evaluate` says.
    pub fn jacobian<E>(&mut self, point: &[f64], residuals: &[f64], evaluate: Evaluate<E>) -> Result<Vec<Vec<f64>>, E> {
        let all: Vec<usize> = (0..point.len()).collect();
        let mut columns = self.columns(&all, point, residuals, evaluate)?;
        if self.is_fitted {
            return Ok(columns);
        }
        // Now it is known how much changes over a scale, and so what share of it the noise is.
        self.is_fitted = true;
        let mut again = Vec::new();
        for (at, scale) in self.scales(point).into_iter().enumerate() {
            let change = scale * dot(&columns[at], &columns[at]).sqrt();
            let fitting = libm::cbrt(3.0 * self.noise / change).clamp(SHORTEST, LONGEST);
            let fitting = if fitting.is_nan() { LONGEST } else { fitting };
            let off = fitting / self.shares[at];
            if !(1.0 / NEAR_ENOUGH..=NEAR_ENOUGH).contains(&off) {
                self.shares[at] = fitting;
                again.push(at);
            }
        }
        for (at, column) in again.iter().zip(self.columns(&again, point, residuals, evaluate)?) {
            columns[*at] = column;
        }
        Ok(columns)
    }

    /// Those of some parameters.
    fn columns<E>(
        &self,
        which: &[usize],
        point: &[f64],
        residuals: &[f64],
        evaluate: Evaluate<E>,
    ) -> Result<Vec<Vec<f64>>, E> {
        let scales = self.scales(point);
        let mut points = Vec::new();
        let mut offsets = Vec::new();
        for &at in which {
            let ((low, high), value) = (self.bounds[at], point[at]);
            let step = (self.shares[at] * scales[at]).min(0.25 * (high - low));
            // Beside a bound both points lie on the other side.
            let pair = if value + step > high {
                [-step, -2.0 * step]
            } else if value - step < low {
                [step, 2.0 * step]
            } else {
                [step, -step]
            };
            for offset in pair {
                let mut other = point.to_vec();
                other[at] += offset;
                // As the numbers have it.
                offsets.push(other[at] - value);
                points.push(other);
            }
        }
        let answers = evaluate(&points)?;
        let pairs = answers.chunks(2).zip(offsets.chunks(2));
        Ok(pairs.map(|(answers, offsets)| column(residuals, answers, offsets)).collect())
    }
}

/// The derivative at 0 of the parabola through the values at 0 and at two offsets, or of the line through what there is.
fn column(middle: &[f64], answers: &[Option<Vec<f64>>], offsets: &[f64]) -> Vec<f64> {
    let (a, b) = (offsets[0], offsets[1]);
    (0..middle.len())
        .map(|row| {
            let slope = |answer: &Option<Vec<f64>>, offset: f64| {
                answer.as_ref().map(|answer| (answer[row] - middle[row]) / offset)
            };
            match (slope(&answers[0], a), slope(&answers[1], b)) {
                (Some(one), Some(two)) => (a * two - b * one) / (a - b),
                (Some(one), None) => one,
                (None, Some(two)) => two,
                (None, None) => 0.0,
            }
        })
        .collect()
}

/// The standard deviation of the noise in values at equal distances; none where the differences do not look like noise.
fn noise_in(values: Vec<f64>) -> Option<f64> {
    let mut table = values;
    let mut levels: Vec<(f64, bool)> = Vec::new();
    let mut factor = 1.0;
    for order in 1..POINTS {
        table = table.windows(2).map(|pair| pair[1] - pair[0]).collect();
        // (k!)²/(2k)!: what a k-th difference of independent errors is more than each of them.
        let k = order as f64;
        factor *= k / (2.0 * (2.0 * k - 1.0));
        let mean = dot(&table, &table) / table.len() as f64;
        let turns = table.iter().any(|value| *value > 0.0) && table.iter().any(|value| *value < 0.0);
        levels.push(((factor * mean).sqrt(), turns));
    }
    let alike = levels.windows(3).find(|three| {
        let (low, high) =
            three.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), (level, _)| (low.min(*level), high.max(*level)));
        three[0].1 && high <= 4.0 * low
    })?;
    Some(alike[0].0)
}

#[cfg(test)]
mod tests;
