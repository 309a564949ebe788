//! The points at which a model has residuals: where a way leaves them, the normal of their edge, and steps that stay among them.
//!
//! Must not know: which step is the right one.

use super::super::{Evaluate, Search};
use crate::numeric::singular_values::dot;

/// How far beside a point other points of the edge are looked for.
pub(super) const BESIDE: f64 = 1e-4;
/// Share of a step by which it keeps off edges that it goes along.
pub(super) const INWARD: f64 = 0.02;
/// Points of the edge are found to this share of a way, those beside a point to this share of how far they are beside it; and no
/// closer than this.
const END: f64 = 1e-10;
const CROSSING: f64 = 1e-6;
pub(super) const CLOSE: f64 = 1e-12;
/// Directions of which less than this is left are none.
const NOTHING: f64 = 1e-7;
/// Most times that a bracket is made larger.
const WIDENINGS: usize = 4;
/// Least share of the expected gain that counts as one.
const ENOUGH: f64 = 1e-4;
/// How far around a point, and in how many directions for each two parameters, lower values are looked for before it is called
/// least.
const AROUND: [f64; 3] = [1e-2, 1e-3, 1e-4];
const DIRECTIONS: usize = 16;

pub(super) type Vector = Vec<f64>;

pub(super) fn plus(one: &[f64], share: f64, two: &[f64]) -> Vector {
    one.iter().zip(two).map(|(one, two)| one + share * two).collect()
}

pub(super) fn length(vector: &[f64]) -> f64 {
    dot(vector, vector).sqrt()
}

/// What is left of a vector beside others of length 1 at right angles to each other; none where that is nothing.
pub(super) fn beside(vector: &[f64], others: &[Vector]) -> Option<Vector> {
    let mut left = vector.to_vec();
    // Twice, for what is nearly nothing.
    for _ in 0..2 {
        for other in others {
            left = plus(&left, -dot(&left, other), other);
        }
    }
    let size = length(&left);
    (size > NOTHING).then(|| left.iter().map(|part| part / size).collect())
}

/// Directions of length 1 at right angles to some, and to each other.
pub(super) fn across(count: usize, normals: &[Vector]) -> Vec<Vector> {
    let mut taken: Vec<Vector> = Vec::new();
    for normal in normals {
        taken.extend(beside(normal, &taken));
    }
    let first = taken.len();
    while taken.len() < count {
        let axes = (0..count).map(|at| (0..count).map(|other| f64::from(u8::from(other == at))).collect::<Vector>());
        let left = |axis: Vector| {
            let kept: f64 = taken.iter().map(|other| dot(&axis, other) * dot(&axis, other)).sum();
            (1.0 - kept, axis)
        };
        // The axis of which most is left.
        let most = axes.map(left).max_by(|one, two| one.0.total_cmp(&two.0));
        let Some(next) = most.and_then(|(_, axis)| beside(&axis, &taken)) else { break };
        taken.push(next);
    }
    taken.split_off(first)
}

/// The mean of some normals, of length 1.
pub(super) fn outward(normals: &[Vector], count: usize) -> Vector {
    let sum = normals.iter().fold(vec![0.0; count], |sum, normal| plus(&sum, 1.0, normal));
    beside(&sum, &[]).unwrap_or(sum)
}

/// Whether the model has residuals at points, in shares of the ranges from `origin`.
pub(super) struct Admitted<'a, 'e, E> {
    pub search: &'a Search,
    pub origin: Vec<f64>,
    pub evaluate: Evaluate<'e, E>,
}

impl<E> Admitted<'_, '_, E> {
    fn ranges(&self) -> impl Iterator<Item = f64> {
        self.search.bounds.iter().map(|(low, high)| high - low)
    }

    /// A place as the parameters have it.
    pub(super) fn point(&self, place: &[f64]) -> Vec<f64> {
        self.origin
            .iter()
            .zip(place)
            .zip(self.ranges())
            .map(|((origin, share), range)| origin + share * range)
            .collect()
    }

    /// Whether a place is in the box, but for rounding.
    fn is_inside(&self, place: &[f64]) -> bool {
        let point = self.point(place);
        let mut inside = point.iter().zip(&self.search.bounds);
        inside.all(|(value, (low, high))| {
            let slack = CLOSE * (high - low);
            low - slack <= *value && *value <= high + slack
        })
    }

    /// The residuals at a place of the box; none outside of it.
    pub(super) fn at(&mut self, place: &[f64]) -> Result<Option<Vec<f64>>, E> {
        if !self.is_inside(place) {
            return Ok(None);
        }
        let point = self.search.inside(&self.point(place));
        Ok((self.evaluate)(std::slice::from_ref(&point))?.pop().flatten())
    }

    /// A point of the box without residuals close to a place in a direction, if there is one.
    pub(super) fn refused(&mut self, place: &[f64], along: &[f64]) -> Result<Option<Vec<f64>>, E> {
        let size = length(along);
        if size == 0.0 {
            return Ok(None);
        }
        let point = self.search.inside(&self.point(&plus(place, BESIDE / size, along)));
        let found = (self.evaluate)(std::slice::from_ref(&point))?.pop().flatten();
        Ok(found.is_none().then_some(point))
    }

    /// The last place with residuals on the way from one that has some to one that has none, and what they are.
    fn last(&mut self, (from, found): (&[f64], Vec<f64>), to: &[f64]) -> Result<(Vector, Vec<f64>), E> {
        let (mut inside, mut found, mut outside) = (from.to_vec(), found, to.to_vec());
        let whole = length(&plus(to, -1.0, from));
        while length(&plus(&outside, -1.0, &inside)) > (END * whole).max(CLOSE) {
            let middle = plus(&inside, 0.5, &plus(&outside, -1.0, &inside));
            match self.at(&middle)? {
                Some(residuals) => (inside, found) = (middle, residuals),
                None => outside = middle,
            }
        }
        Ok((inside, found))
    }

    /// How far along a direction from a place the edge is, where it is within a few `reach` of it, to either side.
    fn crossing(&mut self, from: &[f64], along: &[f64], reach: f64) -> Result<Option<f64>, E> {
        let (mut inside, mut outside) = (None, None);
        if self.at(from)?.is_some() {
            inside = Some(0.0);
        } else {
            outside = Some(0.0);
        }
        let mut step = reach;
        for _ in 0..WIDENINGS {
            if inside.is_some() && outside.is_some() {
                break;
            }
            let side = if inside.is_some() { step } else { -step };
            if self.at(&plus(from, side, along))?.is_some() {
                inside = Some(side);
            } else {
                outside = Some(side);
            }
            step *= 4.0;
        }
        let Some((mut inside, mut outside)) = inside.zip(outside) else { return Ok(None) };
        while (outside - inside).abs() > (CROSSING * reach).max(CLOSE) {
            let middle = f64::midpoint(inside, outside);
            if self.at(&plus(from, middle, along))?.is_some() { inside = middle } else { outside = middle }
        }
        Ok(Some(f64::midpoint(inside, outside)))
    }

    /// The normal, outward, of the edge that a direction meets at the origin; none where it is no smooth one.
    pub(super) fn normal(&mut self, along: &[f64], inward: &[f64]) -> Result<Option<Vector>, E> {
        let base: Vector = inward.iter().map(|part| part * INWARD * BESIDE).collect();
        let Some(middle) = self.crossing(&base, along, BESIDE)? else { return Ok(None) };
        let mut normal = along.to_vec();
        for direction in across(along.len(), &[along.to_vec()]) {
            let mut slopes = Vec::new();
            for side in [BESIDE, -BESIDE] {
                let place = plus(&plus(&base, side, &direction), middle, along);
                if !self.is_inside(&place) {
                    continue;
                }
                slopes.extend(self.crossing(&place, along, BESIDE)?.map(|off| off / side));
            }
            if slopes.is_empty() {
                return Ok(None);
            }
            let slope = slopes.iter().sum::<f64>() / slopes.len() as f64;
            normal = plus(&normal, -slope, &direction);
        }
        Ok(beside(&normal, &[]))
    }

    /// The lowest of some places around the point, in directions in which the sum of squares falls, and its residuals; none where
    /// none is lower. The normals of edges that meet may be wrong: this does not ask for any.
    pub(super) fn poll(&mut self, slope: &[f64], below: f64) -> Result<Option<(Vector, Vec<f64>, bool)>, E> {
        let mut lowest = below;
        let mut found = None;
        for radius in AROUND {
            for number in 1..=1 + DIRECTIONS * slope.len() * (slope.len() - 1) {
                let way: Vector = spread(number, slope.len()).map(|share| 2.0 * share - 1.0).collect();
                let Some(way) = beside(&way, &[]) else { continue };
                let side = if dot(&way, slope) > 0.0 { -radius } else { radius };
                let place = self.search.in_box(&self.origin, &plus(&vec![0.0; slope.len()], side, &way));
                if let Some(residuals) = self.at(&place)? {
                    let other = dot(&residuals, &residuals);
                    if other < lowest {
                        lowest = other;
                        found = Some((place, residuals, false));
                    }
                }
            }
            if found.is_some() {
                break;
            }
        }
        Ok(found)
    }

    /// The place to which a step leads, brought back to the edges that it goes along, its residuals, and whether nothing was in
    /// its way; none where it gains nothing, however short.
    pub(super) fn step(
        &mut self,
        (step, normals): (&[f64], &[Vector]),
        (residuals, sum): (&[f64], f64),
        (expected, halvings): (f64, usize),
    ) -> Result<Option<(Vector, Vec<f64>, bool)>, E> {
        let origin = vec![0.0; step.len()];
        let outward = outward(normals, step.len());
        let mut share = 1.0;
        for _ in 0..halvings {
            let target = self.search.in_box(&self.origin, &plus(&origin, share, step));
            let size = length(&target);
            let mut is_whole = share >= 1.0;
            let found = match self.at(&target)? {
                Some(residuals) if normals.is_empty() => Some((target, residuals)),
                Some(residuals) => {
                    // Out to the edge, if it is near.
                    let beyond = self.search.in_box(&self.origin, &plus(&target, size, &outward));
                    if self.at(&beyond)?.is_some() {
                        Some((target, residuals))
                    } else {
                        Some(self.last((&target, residuals), &beyond)?)
                    }
                }
                None if normals.is_empty() => {
                    is_whole = false;
                    Some(self.last((&origin, residuals.to_vec()), &target)?)
                }
                None => {
                    let mut back = 1e-3 * size;
                    let mut found = None;
                    while found.is_none() && back <= size {
                        let inside = plus(&target, -back, &outward);
                        if let Some(residuals) = self.at(&inside)? {
                            found = Some(self.last((&inside, residuals), &target)?);
                        }
                        back *= 4.0;
                    }
                    found
                }
            };
            if let Some((place, residuals)) = found
                && sum - dot(&residuals, &residuals) > ENOUGH * share * expected.min(sum)
                && length(&place) > CLOSE
            {
                return Ok(Some((place, residuals, is_whole)));
            }
            share *= 0.5;
        }
        Ok(None)
    }
}

/// Point `number` of a sequence that fills the unit cube evenly: multiples of the powers of 1/φ, with φ^(count + 1) = φ + 1.
fn spread(number: usize, count: usize) -> impl Iterator<Item = f64> {
    let mut root = 2.0_f64;
    for _ in 0..64 {
        root = libm::pow(1.0 + root, 1.0 / (count as f64 + 1.0));
    }
    (1..=count).map(move |power| {
        let value = 0.5 + number as f64 / libm::pow(root, power as f64);
        value - libm::floor(value)
    })
}
