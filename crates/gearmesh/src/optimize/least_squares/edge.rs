//! A search that meets points at which the model has no residuals goes on along the edge of those at which it has some.
//!
//! The edge is known by its points alone: where a way ends at which the model still has residuals is found by bisection, and
//! the normal of the edge by central differences of such points. Among the normals at a point an active set is kept, as for linear
//! constraints (Nocedal and Wright, Numerical Optimization (2006), 16.5): the step of Gauss and Newton is taken at right angles
//! to all of them, then brought back to the edge. A point is least on its edge when no such step gains and every multiplier
//! pushes outward. Lengths are shares of the ranges of the parameters. Must not know: why the model has no residuals.

mod admitted;

use super::derivative::Steps;
use super::{Damped, Evaluate, Search};
use crate::numeric::singular_values::dot;
use admitted::{Admitted, BESIDE, CLOSE, INWARD, Vector, across, length, outward, plus};

/// How far ahead of a point a way is tried.
const PROBE: f64 = 1e-6;
/// What is no further from a bound than this share of the range may be at it.
const NEXT_TO: f64 = 1e-5;
/// Most times a step is halved, where much is expected of it or little, and most changes of an active set at a point.
const HALVINGS: usize = 30;
const FEW_HALVINGS: usize = 3;
const CHANGES: usize = 12;
/// What may be left of an expected gain, as a share of the sum of squares, where no step gains: the normals are not exact.
const LEFT: f64 = 1e-6;
/// What counts as a gain here, as a share of what counts elsewhere: steps along an edge need not be found again inside.
const OF_GAIN: f64 = 1e-4;

/// Where a search is.
pub(super) struct At {
    pub point: Vec<f64>,
    pub residuals: Vec<f64>,
    pub jacobian: Vec<Vec<f64>>,
    /// Steps taken.
    pub taken: usize,
}

/// How a search along the edge ended.
pub(super) enum Along {
    /// It left the edge, or never was at it.
    Inside,
    /// It is least where it is: at the edge, where a point beyond it is given.
    Least(Option<Vec<f64>>),
    /// The steps ran out.
    Unsettled,
    /// It ended, and whether it is least there is not known. A point beyond the edge, if that ended it.
    Stopped(Option<Vec<f64>>),
}

/// What can be done at a point.
enum Way {
    /// A step, the normals of the edges that it goes along, and what it is expected to gain.
    Step(Vector, Vec<Vector>, f64),
    /// None gains; the normals of the edges that stop it, and what the least of their multipliers is.
    Least(Vec<Vector>),
    /// An edge without a normal.
    Unknown(Vector),
}

impl Search {
    /// Goes on from a point beside which the model has no residuals.
    pub(super) fn along_edge<E>(&self, at: &mut At, steps: &mut Steps, evaluate: Evaluate<E>) -> Result<Along, E> {
        let origin = vec![0.0; at.point.len()];
        loop {
            // Bounds are edges as others are: which of them hold depends on the others.
            self.onto_bounds(at, evaluate)?;
            let mut admitted = Admitted { search: self, origin: at.point.clone(), evaluate: &mut *evaluate };
            let (step, normals, expected) = match self.way(at, &mut admitted)? {
                Way::Step(step, normals, expected) => (step, normals, expected),
                Way::Least(normals) if normals.is_empty() => return Ok(Along::Least(None)),
                Way::Least(normals) => (outward(&normals, origin.len()), normals, 0.0),
                Way::Unknown(along) => (along, Vec::new(), f64::INFINITY),
            };
            if at.taken == self.steps {
                return Ok(Along::Unsettled);
            }
            let sum = dot(&at.residuals, &at.residuals);
            // What is left may be no more than the normals are off by.
            let is_little = !normals.is_empty() && expected <= LEFT * sum.max(1.0);
            let halvings = if is_little { FEW_HALVINGS } else { HALVINGS };
            let mut found = None;
            if expected > 0.0 && expected.is_finite() {
                found = admitted.step((&step, &normals), (&at.residuals, sum), (expected, halvings))?;
            }
            if found.is_none() {
                let slope: Vector = self.scaled(&at.jacobian).iter().map(|column| dot(column, &at.residuals)).collect();
                found = admitted.poll(&slope, sum - LEFT * sum.max(1.0))?;
            }
            let Some((place, residuals, is_whole)) = found else {
                let way = if normals.is_empty() { step } else { outward(&normals, origin.len()) };
                let beyond = admitted.refused(&origin, &way)?;
                // No edge is near, no step leads lower, nor does any direction.
                let is_inside = normals.is_empty() && beyond.is_none();
                return Ok(if is_little || is_inside { Along::Least(beyond) } else { Along::Stopped(beyond) });
            };
            at.point = self.inside(&admitted.point(&place));
            at.residuals = residuals;
            at.taken += 1;
            at.jacobian = steps.jacobian(&at.point, &at.residuals, evaluate)?;
            if is_whole && normals.is_empty() {
                return Ok(Along::Inside);
            }
        }
    }

    /// Moves what is next to a bound onto it, if that is no worse.
    fn onto_bounds<E>(&self, at: &mut At, evaluate: Evaluate<E>) -> Result<(), E> {
        let one = |(value, (low, high)): (&f64, &(f64, f64))| {
            let slack = NEXT_TO * (high - low);
            if value - low <= slack {
                *low
            } else if high - value <= slack {
                *high
            } else {
                *value
            }
        };
        let point: Vec<f64> = at.point.iter().zip(&self.bounds).map(one).collect();
        if point != at.point
            && let Some(residuals) = evaluate(std::slice::from_ref(&point))?.pop().flatten()
            && dot(&residuals, &residuals) <= dot(&at.residuals, &at.residuals)
        {
            (at.point, at.residuals) = (point, residuals);
        }
        Ok(())
    }

    /// The derivatives over shares of the ranges.
    fn scaled(&self, jacobian: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let columns = jacobian.iter().zip(&self.bounds);
        columns.map(|(column, (low, high))| column.iter().map(|entry| entry * (high - low)).collect()).collect()
    }

    fn way<E>(&self, at: &At, admitted: &mut Admitted<'_, '_, E>) -> Result<Way, E> {
        let count = at.point.len();
        let columns = self.scaled(&at.jacobian);
        let sum = dot(&at.residuals, &at.residuals);
        let counts = (self.gain * OF_GAIN * sum.max(1.0)).max(self.noise * self.noise);
        let mut normals: Vec<Vector> = Vec::new();
        for _ in 0..CHANGES {
            let (step, expected) = gauss_newton(&columns, &at.residuals, &across(count, &normals));
            let size = length(&step);
            // NaN is no gain.
            if !(expected > counts && size > CLOSE) {
                match outward_multipliers(&columns, &at.residuals, &normals) {
                    None => return Ok(Way::Least(normals)),
                    Some(inward) => drop(normals.remove(inward)),
                }
                continue;
            }
            // A bound is an edge whose normal is known.
            if let Some(bound) = self.bound_ahead(&at.point, &step).filter(|_| normals.len() < count) {
                normals.push(bound);
                continue;
            }
            let inward: Vector = outward(&normals, count).iter().map(|part| -part).collect();
            let ahead = plus(
                &step.iter().map(|part| part * (PROBE / size).min(1.0)).collect::<Vec<_>>(),
                INWARD * PROBE.min(size),
                &inward,
            );
            if admitted.at(&self.in_box(&at.point, &ahead))?.is_some() {
                return Ok(Way::Step(step, normals, expected));
            }
            let along: Vector = step.iter().map(|part| part / size).collect();
            let beyond = plus(&vec![0.0; count], BESIDE, &along);
            if normals.len() >= count {
                return Ok(Way::Unknown(beyond));
            }
            let Some(normal) = admitted.normal(&along, &inward)? else { return Ok(Way::Unknown(beyond)) };
            normals.push(normal);
        }
        Ok(Way::Unknown(vec![0.0; count]))
    }

    /// The normal of a bound at which a point is, and beyond which a step leads.
    fn bound_ahead(&self, point: &[f64], step: &[f64]) -> Option<Vector> {
        let is_out = |at: &usize| {
            let ((low, high), value, step) = (self.bounds[*at], point[*at], step[*at]);
            (value <= low && step < -CLOSE) || (value >= high && step > CLOSE)
        };
        let at = (0..point.len()).find(is_out)?;
        let mut normal = vec![0.0; point.len()];
        normal[at] = step[at].signum();
        Some(normal)
    }

    /// A place moved into the box.
    fn in_box(&self, origin: &[f64], place: &[f64]) -> Vector {
        let one = |((origin, share), (low, high)): ((&f64, &f64), &(f64, f64))| {
            let range = high - low;
            share.clamp((low - origin) / range, (high - origin) / range)
        };
        origin.iter().zip(place).zip(&self.bounds).map(one).collect()
    }
}

/// The step of Gauss and Newton within some directions, and by how much it should lower the sum of squares.
fn gauss_newton(columns: &[Vec<f64>], residuals: &[f64], directions: &[Vector]) -> (Vector, f64) {
    let none = vec![0.0; columns.len()];
    if directions.is_empty() {
        return (none, 0.0);
    }
    let along = |direction: &Vector| {
        let parts = columns.iter().zip(direction);
        parts.fold(vec![0.0; residuals.len()], |sum, (column, part)| plus(&sum, *part, column))
    };
    let within: Vec<Vec<f64>> = directions.iter().map(along).collect();
    let lengths: Vec<f64> = within.iter().map(|column| length(column)).collect();
    let all: Vec<usize> = (0..within.len()).collect();
    let damped = Damped::new(&all, &within, residuals, &lengths);
    let damping = f64::EPSILON * damped.parts.values[0] * damped.parts.values[0];
    let (mut step, mut after) = (none, residuals.to_vec());
    for (at, change) in damped.step(damping) {
        step = plus(&step, change, &directions[at]);
        after = plus(&after, change, &within[at]);
    }
    (step, dot(residuals, residuals) - dot(&after, &after))
}

/// The edge whose multiplier pushes inward most; none where all push outward.
fn outward_multipliers(columns: &[Vec<f64>], residuals: &[f64], normals: &[Vector]) -> Option<usize> {
    if normals.is_empty() {
        return None;
    }
    let slope: Vector = columns.iter().map(|column| dot(column, residuals)).collect();
    let all: Vec<usize> = (0..normals.len()).collect();
    let damped = Damped::new(&all, normals, &slope, &vec![1.0; normals.len()]);
    let multipliers: Vec<f64> = damped.step(0.0).map(|(_, multiplier)| multiplier).collect();
    let least = multipliers.iter().enumerate().min_by(|one, two| one.1.total_cmp(two.1))?;
    (*least.1 < -1e-6 * length(&slope)).then_some(least.0)
}
