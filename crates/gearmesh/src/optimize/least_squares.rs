//! Least squares over a box: the parameters at which a sum of squared residuals is least.
//!
//! Levenberg's and Marquardt's method with the bounds as Kanzow, Yamashita and Fukushima have them (J. Comput. Appl. Math. 172
//! (2004) 375): a parameter that is at its bound and pushes outward is held there, the others take the damped step of Gauss and
//! Newton, and what leaves the box is put back on its side. Damping after Nielsen (IMM-REP-1999-05, Technical University of
//! Denmark), columns scaled by the largest length they had (Moré, Lecture Notes in Mathematics 630 (1978) 105). A search that meets
//! points at which the model has no residuals goes on along their edge (`edge.rs`).
//!
//! Of the crates looked at in 2026 `levenberg-marquardt` 0.15 is MINPACK's method without bounds and brings `nalgebra`; `argmin`
//! 0.11 has Gauss and Newton's step without either. Both call the model themselves, one point at a time, where this asks for
//! all points of a derivative at once. Must not know: what parameters and residuals mean.

pub mod derivative;
mod edge;
pub mod uncertainty;

use crate::numeric::singular_values::{SingularValues, dot};
use derivative::Steps;
use edge::{Along, At};

/// What a model gives at each of some points: its residuals, as many at each point, or none where it has none.
pub type Answers = Vec<Option<Vec<f64>>>;
/// A model, which is asked for several points at once.
pub type Evaluate<'e, E> = &'e mut dyn FnMut(&[Vec<f64>]) -> Result<Answers, E>;

/// A direction of the residuals is at right angles to all columns when every cosine is below this.
const RIGHT_ANGLE: f64 = 1e-10;
/// Steps below this share of a parameter's scale are none.
const NO_STEP: f64 = 1e-10;
/// A step is taken when it gains at least this share of what was expected.
const ENOUGH: f64 = 1e-4;
/// Where damping starts, as a share of the largest squared singular value; and where a step is none for certain.
const FIRST_DAMPING: f64 = 1e-3;
const MOST_REJECTED: usize = 40;

/// Where and how long is searched.
#[derive(Clone, Debug)]
pub struct Search {
    /// Least and most of each parameter; least < most.
    pub bounds: Vec<(f64, f64)>,
    /// Steps that are taken at most.
    pub steps: usize,
    /// A step that would lower the sum of squares by no more than this share of it, or of 1, is the last.
    pub gain: f64,
    /// Length of the noise of all residuals: see [`derivative::noise`].
    pub noise: f64,
}

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// No step leads lower.
    Settled,
    /// It would have gone on.
    Unsettled,
    /// The model has no residuals beyond it, and whether it is least among its neighbours is not known.
    Stopped,
}

/// Where a search ended.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The parameters.
    pub point: Vec<f64>,
    /// The residuals there.
    pub residuals: Vec<f64>,
    /// By parameter, the derivatives of the residuals.
    pub jacobian: Vec<Vec<f64>>,
    /// By parameter, how much of such a derivative is noise: the length of its error.
    pub doubt: Vec<f64>,
    /// By parameter, whether it is held at a bound beyond which the sum of squares would fall.
    pub is_held: Vec<bool>,
    /// Σ r².
    pub sum_of_squares: f64,
    /// Steps taken.
    pub steps: usize,
    /// Why it ended.
    pub end: End,
    /// Where the search ended at the edge of the points at which the model has residuals: a point beyond it.
    pub beyond: Option<Vec<f64>>,
}

/// A step that leads lower.
struct Step {
    next: Vec<f64>,
    found: Vec<f64>,
    is_last: bool,
}

impl Search {
    /// Searches from a point of the box; none where the model has no residuals at the start.
    ///
    /// # Errors
    /// What `evaluate` says.
    pub fn from<E>(&self, start: &[f64], evaluate: Evaluate<E>) -> Result<Option<Fit>, E> {
        let mut point = self.inside(start);
        let Some(mut residuals) = evaluate(std::slice::from_ref(&point))?.pop().flatten() else { return Ok(None) };
        let mut steps = Steps::new(&self.bounds, self.noise);
        let mut lengths = vec![0.0_f64; point.len()];
        let (mut taken, mut damping, mut end, mut beyond) = (0, None, End::Settled, None);
        let mut jacobian = steps.jacobian(&point, &residuals, evaluate)?;
        let is_held = loop {
            let is_held = self.held(&point, &jacobian, &residuals);
            let free: Vec<usize> = (0..point.len()).filter(|at| !is_held[*at]).collect();
            if is_at_right_angles(&free, &jacobian, &residuals) {
                break is_held;
            }
            if taken == self.steps {
                end = End::Unsettled;
                break is_held;
            }
            for at in &free {
                lengths[*at] = lengths[*at].max(dot(&jacobian[*at], &jacobian[*at]).sqrt());
            }
            let damped = Damped::new(&free, &jacobian, &residuals, &lengths);
            let mut is_refused = false;
            let step = {
                let asked: Evaluate<E> = &mut |points| {
                    let answers = evaluate(points)?;
                    is_refused |= answers.iter().any(Option::is_none);
                    Ok(answers)
                };
                self.step((&point, &residuals, &jacobian), &damped, &mut damping, &steps, asked)?
            };
            let is_last = step.as_ref().is_none_or(|step| step.is_last);
            if let Some(Step { next, found, .. }) = step {
                (point, residuals) = (next, found);
                taken += 1;
            }
            if is_last && !is_refused {
                // A last step is so short that the derivatives are as before.
                break is_held;
            }
            jacobian = steps.jacobian(&point, &residuals, evaluate)?;
            if !is_refused {
                continue;
            }
            let mut at = At { point, residuals, jacobian, taken };
            let along = self.along_edge(&mut at, &mut steps, evaluate)?;
            At { point, residuals, jacobian, taken } = at;
            damping = None;
            (end, beyond) = match along {
                Along::Inside => continue,
                Along::Least(beyond) => (End::Settled, beyond),
                Along::Unsettled => (End::Unsettled, None),
                Along::Stopped(beyond) => (End::Stopped, beyond),
            };
            break self.held(&point, &jacobian, &residuals);
        };
        let sum_of_squares = dot(&residuals, &residuals);
        let doubt = steps.doubt(&point);
        Ok(Some(Fit { point, residuals, jacobian, doubt, is_held, sum_of_squares, steps: taken, end, beyond }))
    }

    fn inside(&self, point: &[f64]) -> Vec<f64> {
        point.iter().zip(&self.bounds).map(|(value, (low, high))| value.clamp(*low, *high)).collect()
    }

    /// Which parameters are at a bound beyond which the sum of squares would fall by more than what counts.
    fn held(&self, point: &[f64], jacobian: &[Vec<f64>], residuals: &[f64]) -> Vec<bool> {
        let counts = self.gain * dot(residuals, residuals).max(1.0);
        let one = |((value, (low, high)), column): ((&f64, &(f64, f64)), &Vec<f64>)| {
            let rise = dot(column, residuals);
            let is_outward = (value <= low && rise > 0.0) || (value >= high && rise < 0.0);
            is_outward && rise * rise > counts * dot(column, column)
        };
        point.iter().zip(&self.bounds).zip(jacobian).map(one).collect()
    }

    /// The next point and its residuals; none where no step leads lower.
    fn step<E>(
        &self,
        (point, residuals, jacobian): (&[f64], &[f64], &[Vec<f64>]),
        damped: &Damped,
        damping: &mut Option<f64>,
        steps: &Steps,
        evaluate: Evaluate<E>,
    ) -> Result<Option<Step>, E> {
        let largest = damped.parts.values[0] * damped.parts.values[0];
        let mut now = damping.unwrap_or(FIRST_DAMPING * largest);
        let (sum, mut factor) = (dot(residuals, residuals), 2.0);
        for _ in 0..MOST_REJECTED {
            let mut next = point.to_vec();
            for (at, change) in damped.step(now) {
                next[at] += change;
            }
            let next = self.inside(&next);
            let moved: Vec<f64> = next.iter().zip(point).map(|(next, old)| next - old).collect();
            let is_none = moved.iter().zip(steps.scales(point)).all(|(moved, scale)| moved.abs() <= NO_STEP * scale);
            let linear = (0..residuals.len()).map(|row| {
                let change: f64 = jacobian.iter().zip(&moved).map(|(column, moved)| column[row] * moved).sum();
                residuals[row] + change
            });
            let expected = sum - linear.map(|value| value * value).sum::<f64>();
            if is_none {
                return Ok(None);
            }
            let is_last = expected > 0.0 && expected <= (self.gain * sum.max(1.0)).max(self.noise * self.noise);
            let found = evaluate(std::slice::from_ref(&next))?.pop().flatten();
            let gained = found.as_ref().map_or(f64::NAN, |found| sum - dot(found, found));
            let share = gained / expected;
            if let Some(found) = found.filter(|_| gained > 0.0 && share > ENOUGH) {
                let cube = 2.0 * share.min(1.0) - 1.0;
                let less = if share > 0.9 && share < 1.1 { 0.1 } else { (1.0 - cube * cube * cube).max(1.0 / 3.0) };
                *damping = Some((now * less).max(f64::EPSILON * f64::EPSILON * largest));
                return Ok(Some(Step { next, found, is_last }));
            }
            if is_last {
                return Ok(None);
            }
            now = (now * factor).max(f64::MIN_POSITIVE);
            factor *= 2.0;
        }
        Ok(None)
    }
}

/// Whether the residuals cannot be made less by any of these parameters.
fn is_at_right_angles(free: &[usize], jacobian: &[Vec<f64>], residuals: &[f64]) -> bool {
    let length = dot(residuals, residuals).sqrt();
    free.iter().all(|at| {
        let column = &jacobian[*at];
        dot(column, residuals).abs() <= RIGHT_ANGLE * dot(column, column).sqrt() * length
    })
}

/// The damped steps from a point: of Gauss and Newton without damping, down the slope with much of it.
struct Damped {
    free: Vec<usize>,
    scales: Vec<f64>,
    parts: SingularValues,
    /// −Uᵀ r.
    against: Vec<f64>,
}

impl Damped {
    fn new(free: &[usize], jacobian: &[Vec<f64>], residuals: &[f64], lengths: &[f64]) -> Self {
        let scales: Vec<f64> = free.iter().map(|at| if lengths[*at] > 0.0 { lengths[*at] } else { 1.0 }).collect();
        let scaled = free.iter().zip(&scales);
        let scaled: Vec<Vec<f64>> =
            scaled.map(|(at, scale)| jacobian[*at].iter().map(|entry| entry / scale).collect()).collect();
        let parts = SingularValues::of(&scaled);
        let against = parts.left.iter().map(|left| -dot(left, residuals)).collect();
        Self { free: free.to_vec(), scales, parts, against }
    }

    /// Parameters and by how much they change.
    fn step(&self, damping: f64) -> impl Iterator<Item = (usize, f64)> {
        let along = self.parts.values.iter().zip(&self.against);
        let along: Vec<f64> = along
            .map(|(value, against)| if *value > 0.0 { against * value / (value * value + damping) } else { 0.0 })
            .collect();
        self.free.iter().zip(&self.scales).enumerate().map(move |(row, (at, scale))| {
            let change: f64 = self.parts.right.iter().zip(&along).map(|(right, along)| right[row] * along).sum();
            (*at, change / scale)
        })
    }
}

#[cfg(test)]
mod strd;
#[cfg(test)]
mod tests;
