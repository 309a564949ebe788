//! What the values around a point say where a local search has stopped: is the function smooth there, and if it has a
//! kink, which way does the kink go down?
//!
//! On a kink every line along a few fixed directions may lead upwards although the kink itself goes down. Gradients on
//! all its sides tell: the shortest vector of their convex hull is zero where the point is stationary, and else points up
//! along the kink. Sources: Burke, Lewis and Overton, SIAM J. Optim. 15 (2005) 751, section 2; gradients from differences
//! as in Kiwiel, SIAM J. Optim. 20 (2010) 1983. The places are a turned cross, another one in each try and dense in all
//! directions (Abramson, Audet, Dennis and Le Digabel, SIAM J. Optim. 20 (2009) 948, section 3: a Householder reflection
//! of the axes by a Halton point). Lengths are shares of each variable's range. Must not know: who asks.

use super::local::clip;

/// An orthonormal basis; those of all numbers are dense.
fn basis(number: usize, dimension: usize) -> Vec<Vec<f64>> {
    let normal: Vec<f64> = primes().take(dimension).map(|prime| 2.0 * halton(number + 1, prime) - 1.0).collect();
    let square: f64 = normal.iter().map(|x| x * x).sum();
    // Only the centre of the cube has no direction, and of these points none but the first of one variable is there.
    let factor = if square > 0.0 { 2.0 / square } else { 0.0 };
    let entry = |row: usize, column: usize| f64::from(u8::from(row == column)) - factor * normal[row] * normal[column];
    (0..dimension).map(|row| (0..dimension).map(|column| entry(row, column)).collect()).collect()
}

fn primes() -> impl Iterator<Item = usize> {
    (2..).filter(|candidate: &usize| {
        (2..*candidate).take_while(|d| d * d <= *candidate).all(|d| !candidate.is_multiple_of(d))
    })
}

/// The digits of `index` in a base, mirrored at the point.
fn halton(mut index: usize, base: usize) -> f64 {
    let (mut value, mut share) = (0.0, 1.0 / base as f64);
    while index > 0 {
        value += share * (index % base) as f64;
        share /= base as f64;
        index /= base;
    }
    value
}

/// The arms of the cross of this number around a point, one after the other, clipped to the cube.
pub(super) fn cross(at: &[f64], radius: f64, number: usize) -> Vec<Vec<f64>> {
    let arm = |direction: &[f64], radius: f64| at.iter().zip(direction).map(|(x, d)| clip(x + radius * d)).collect();
    basis(number, at.len()).iter().flat_map(|direction| [arm(direction, radius), arm(direction, -radius)]).collect()
}

/// Two crosses around a point that are turned against each other, others in every try.
pub(super) fn crosses(at: &[f64], radius: f64, attempt: usize) -> Vec<Vec<f64>> {
    let first = 2 * attempt + 2;
    // Points of the sequence that lie opposite each other give the same axes.
    let other = (first + 1..first + MOST_TURNS).find(|&number| is_turned(first, number, at.len())).unwrap_or(first + 1);
    [first, other].map(|number| cross(at, radius, number)).concat()
}

/// Whether no axes of two bases are nearly the same.
fn is_turned(one: usize, other: usize, dimension: usize) -> bool {
    let (one, other) = (basis(one, dimension), basis(other, dimension));
    one.iter().all(|axis| other.iter().all(|next| dot(axis, next).abs() < TURNED))
}

/// The cosine of 15 degrees.
const TURNED: f64 = 0.966;
const MOST_TURNS: usize = 64;

/// Whether differences of second order fall otherwise than like the square of the radius, in any direction: values of a
/// wide and of a narrow [`cross`] around a point of value `value`, the wide one `ratio` times as large. On a kink they fall
/// like the radius, and beside one, which only the wide cross meets, much faster.
pub(super) fn kinked(value: f64, wide: &[f64], narrow: &[f64], ratio: f64) -> bool {
    let second = |arms: &[f64]| ((arms[0] - value) + (arms[1] - value)).abs();
    wide.chunks_exact(2).zip(narrow.chunks_exact(2)).any(|(wide, narrow)| {
        let (wide, narrow) = (second(wide), second(narrow) * ratio * ratio);
        narrow > wide * ratio.sqrt() || wide > narrow * ratio.sqrt()
    })
}

/// The points whose values give the gradient in each of `places` by differences over `step`: the place itself, and one
/// along each axis, towards the inside of the cube.
pub(super) fn stencils(places: &[Vec<f64>], step: f64) -> Vec<Vec<f64>> {
    let mut points = Vec::new();
    for place in places {
        points.push(place.clone());
        for axis in 0..place.len() {
            let mut point = place.clone();
            point[axis] += inward(place[axis], step);
            points.push(point);
        }
    }
    points
}

fn inward(coordinate: f64, step: f64) -> f64 {
    if coordinate > 0.5 { -step } else { step }
}

/// What gradients around a point say of it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Slope {
    /// Down; its largest component is 1.
    pub along: Vec<f64>,
    /// Length of the shortest vector of the hull of the gradients, over that of the longest gradient.
    pub share: f64,
}

/// The gradients by the values at [`stencils`] of `places`, but for those that are not finite.
pub(super) fn gradients(places: &[Vec<f64>], step: f64, values: &[f64]) -> Vec<Vec<f64>> {
    let gradient = |(place, values): (&Vec<f64>, &[f64])| -> Vec<f64> {
        place.iter().zip(&values[1..]).map(|(x, value)| (value - values[0]) / inward(*x, step)).collect()
    };
    let stencil = places.first().map_or(1, Vec::len) + 1;
    let mut gradients: Vec<Vec<f64>> = places.iter().zip(values.chunks_exact(stencil)).map(gradient).collect();
    gradients.retain(|gradient| gradient.iter().all(|slope| slope.is_finite()));
    gradients
}

/// The way down from `at` where these are the gradients around; none where it is stationary or flat. A variable on its
/// bound does not go out.
pub(super) fn slope(at: &[f64], mut gradients: Vec<Vec<f64>>) -> Option<Slope> {
    let longest = gradients.iter().map(|gradient| dot(gradient, gradient)).fold(0.0, f64::max).sqrt();
    if longest == 0.0 {
        return None;
    }
    // Each round holds at least one variable more.
    let up = loop {
        let up = shortest(&gradients);
        let held: Vec<usize> = (0..at.len())
            .filter(|&axis| (at[axis] <= 0.0 && up[axis] > 0.0) || (at[axis] >= 1.0 && up[axis] < 0.0))
            .collect();
        if held.is_empty() {
            break up;
        }
        for gradient in &mut gradients {
            for &axis in &held {
                gradient[axis] = 0.0;
            }
        }
    };
    let largest = up.iter().map(|slope| slope.abs()).fold(0.0, f64::max);
    let share = dot(&up, &up).sqrt() / longest;
    (largest > 0.0).then(|| Slope { along: up.iter().map(|slope| -slope / largest).collect(), share })
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Length of the shortest vector of the hull, over that of the longest gradient, below which a point is stationary:
/// differences over the tolerance tell no less.
pub(super) const STATIONARY: f64 = 1e-3;

/// Of the gap between the hull and the plane through the vector found, as a share of its square.
const GAP: f64 = 1e-10;
const MOST_STEPS: usize = 10_000;

/// The shortest vector of the convex hull, by exchange of weight between the two vectors that gain most by it. Below
/// [`STATIONARY`] of the longest of them it is no nearer to zero than that needs. Vectors that are nearly the same may take
/// more than [`MOST_STEPS`]; then it is farther away.
///
/// Source: Mitchell, Dem'yanov and Malozemov, SIAM J. Control 12 (1974) 19.
fn shortest(vectors: &[Vec<f64>]) -> Vec<f64> {
    let enough = STATIONARY * STATIONARY * vectors.iter().map(|vector| dot(vector, vector)).fold(0.0, f64::max);
    let mut weights = vec![0.0; vectors.len()];
    weights[0] = 1.0;
    let mut found = vectors[0].clone();
    for _ in 0..MOST_STEPS {
        let (mut low, mut high) = (0, 0);
        let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
        for (at, (vector, weight)) in vectors.iter().zip(&weights).enumerate() {
            // Anew in every step: carried along, they drift, and where vectors are nearly the same no step helps any more.
            let product = dot(vector, &found);
            if product < lowest {
                (low, lowest) = (at, product);
            }
            if *weight > 0.0 && product >= highest {
                (high, highest) = (at, product);
            }
        }
        // No less than the square of how far away the shortest vector is.
        let gap = highest - lowest;
        let apart = || vectors[low].iter().zip(&vectors[high]).map(|(to, from)| to - from);
        let square: f64 = apart().map(|part| part * part).sum();
        if gap <= GAP * dot(&found, &found).max(enough) || square == 0.0 {
            break;
        }
        let moved = (gap / square).min(weights[high]);
        weights[high] -= moved;
        weights[low] += moved;
        for (found, part) in found.iter_mut().zip(apart()) {
            *found += moved * part;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tier: closed form, by hand.
    #[test]
    fn halton_points_are_mirrored_digits_in_prime_bases() {
        assert_eq!(primes().take(10).collect::<Vec<_>>(), [2, 3, 5, 7, 11, 13, 17, 19, 23, 29]);
        let of = |base: usize, count: usize| (1..=count).map(|index| halton(index, base)).collect::<Vec<_>>();
        assert_eq!(of(2, 7), [0.5, 0.25, 0.75, 0.125, 0.625, 0.375, 0.875]);
        for (found, ninths) in of(3, 9).into_iter().zip([3.0, 6.0, 1.0, 4.0, 7.0, 2.0, 5.0, 8.0, 1.0 / 3.0]) {
            assert!((found - ninths / 9.0).abs() < 1e-15, "{found} {ninths}");
        }
        // The axes reflected by the point itself: that along (0, −1/3) keeps the first and turns the second.
        assert_eq!(basis(0, 2), [[1.0, 0.0], [0.0, -1.0]]);
    }

    #[test]
    fn bases_are_orthonormal_and_turn() {
        for dimension in 2..=6 {
            let bases: Vec<_> = (0..50).map(|number| basis(number, dimension)).collect();
            for (number, basis) in bases.iter().enumerate() {
                for (row, one) in basis.iter().enumerate() {
                    for (column, other) in basis.iter().enumerate() {
                        let expected = if row == column { 1.0 } else { 0.0 };
                        assert!((dot(one, other) - expected).abs() < 1e-14);
                    }
                }
                assert!(number == 0 || bases[number - 1] != *basis, "{number}");
            }
        }
    }

    /// Tier: invariant; in two variables the fifth and the sixth cross are the same.
    #[test]
    fn two_crosses_are_never_one() {
        assert!(!is_turned(4, 5, 2));
        for dimension in 2..=6 {
            for attempt in 0..200 {
                let arms = crosses(&vec![0.5; dimension], 0.1, attempt);
                assert_eq!(arms.len(), 4 * dimension);
                let (one, other) = arms.split_at(2 * dimension);
                let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt();
                let nearest = one.iter().flat_map(|a| other.iter().map(|b| apart(a, b))).fold(1.0, f64::min);
                assert!(nearest > 0.02, "{dimension}, {attempt}: {nearest}");
            }
        }
    }

    /// Tier: closed form. A vertex, a point on an edge, a point inside.
    #[test]
    fn the_shortest_vector_of_a_hull() {
        let cases: [(&[[f64; 2]], [f64; 2]); 4] = [
            (&[[3.0, 4.0]], [3.0, 4.0]),
            (&[[1.0, 5.0], [1.0, -4.0]], [1.0, 0.0]),
            (&[[2.0, 0.0], [0.0, 2.0], [3.0, 3.0]], [1.0, 1.0]),
            (&[[1.0, 0.0], [-1.0, 1.0], [-1.0, -1.0]], [0.0, 0.0]),
        ];
        for (vectors, expected) in cases {
            let vectors: Vec<Vec<f64>> = vectors.iter().map(|vector| vector.to_vec()).collect();
            let found = shortest(&vectors);
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?} {expected:?}");
        }
    }

    /// The nearest point to the origin of all triangles, by their edges: 0 inside of one.
    fn nearest_of_triangles(points: &[Vec<f64>]) -> [f64; 2] {
        let turn = |a: &[f64], b: &[f64]| a[0] * b[1] - a[1] * b[0];
        let mut nearest = [f64::INFINITY; 2];
        for (i, a) in points.iter().enumerate() {
            for (j, b) in points[..i].iter().enumerate() {
                let edge = [b[0] - a[0], b[1] - a[1]];
                let along = (-dot(a, &edge) / dot(&edge, &edge)).clamp(0.0, 1.0);
                let foot = [a[0] + along * edge[0], a[1] + along * edge[1]];
                if dot(&foot, &foot) < dot(&nearest, &nearest) {
                    nearest = foot;
                }
                for c in &points[..j] {
                    let turns = [turn(a, b), turn(b, c), turn(c, a)];
                    if turns.iter().all(|turn| *turn > 0.0) || turns.iter().all(|turn| *turn < 0.0) {
                        return [0.0; 2];
                    }
                }
            }
        }
        nearest
    }

    /// Tier: second method; hulls about the origin, near it and beside it, of any size, as near as the least gap makes sure.
    #[test]
    fn the_shortest_vector_is_as_near_as_it_must_be() {
        let mut inside = 0;
        for number in 1..=600 {
            let size = libm::pow(10.0, 3.0 - (number % 16) as f64);
            // Farther from the origin with the number.
            let (shift, count) = (number as f64 / 600.0, 3 + number % 5);
            let place = |index: usize| {
                let index = 7 * number + index;
                vec![size * (2.0 * halton(index, 2) - 1.0 + shift), size * (2.0 * halton(index, 3) - 1.0)]
            };
            let mut points: Vec<Vec<f64>> = (0..count).map(place).collect();
            // Moved towards the origin by most of its distance, it is nearest at the same point.
            let (away, left) = (nearest_of_triangles(&points), [1.0, 0.1, 1e-2, 1e-3, 1e-4][number % 5]);
            for point in &mut points {
                (point[0], point[1]) = (point[0] - (1.0 - left) * away[0], point[1] - (1.0 - left) * away[1]);
            }
            let (found, exact) = (shortest(&points), away.map(|part| left * part));
            let longest = points.iter().map(|point| dot(point, point)).fold(0.0, f64::max).sqrt();
            let apart = (found[0] - exact[0]).hypot(found[1] - exact[1]);
            let share = dot(&exact, &exact).sqrt() / longest;
            let allowed = GAP.sqrt() * share.max(STATIONARY) * longest;
            assert!(apart <= allowed * (1.0 + 1e-4), "{number}: {apart:e} for {allowed:e}");
            inside += usize::from(share == 0.0);
        }
        assert!((150..450).contains(&inside), "{inside}");
    }

    /// Tier: duality; the gap bounds how far away the shortest vector is, in two to six dimensions, where several vectors
    /// are the same as where they are not.
    #[test]
    fn the_gap_is_closed_among_vectors_that_are_the_same() {
        let mut left_open = 0;
        for number in 1..4000 {
            let dimension = 2 + number % 5;
            let coordinate = |index: usize, (axis, prime): (usize, usize)| {
                let shift = if axis == 0 { number as f64 / 5000.0 } else { 0.0 };
                2.0 * halton(11 * number + index / 4, prime) - 1.0 + shift
            };
            let vector = |index| primes().take(dimension).enumerate().map(|axis| coordinate(index, axis)).collect();
            let vectors: Vec<Vec<f64>> = (0..3 + number % 30).map(vector).collect();
            let found = shortest(&vectors);
            let square = |vector: &[f64]| dot(vector, vector);
            let longest = vectors.iter().map(|vector| square(vector)).fold(0.0, f64::max);
            let lowest = vectors.iter().map(|vector| dot(vector, &found)).fold(f64::INFINITY, f64::min);
            let allowed = GAP * square(&found).max(STATIONARY * STATIONARY * longest);
            left_open += usize::from(square(&found) - lowest > 1.001 * allowed);
        }
        assert!(left_open <= 4, "{left_open}");
    }

    fn slope_of(function: impl Fn(&[f64]) -> f64, at: &[f64]) -> Option<Slope> {
        let places = cross(at, 1e-4, 3);
        let values: Vec<f64> = stencils(&places, 1e-6).iter().map(|point| function(point)).collect();
        slope(at, gradients(&places, 1e-6, &values))
    }

    /// Tier: closed form. A roof a thousand times as steep as its valley falls, which no cross would hit.
    #[test]
    fn a_narrow_valley_is_seen_along_its_floor() {
        let valley = |x: &[f64]| 1000.0 * (x[0] - 2.0 * x[1]).abs() + 2.0 * x[0] + x[1];
        let found = slope_of(valley, &[0.6, 0.3]).unwrap();
        // The floor goes along (2, 1), and falls by 5 along it.
        assert!((found.along[0] + 1.0).abs() < 1e-6 && (found.along[1] + 0.5).abs() < 1e-5, "{found:?}");
        assert!((found.share - 1e-3).abs() < 1e-5, "{found:?}");
        let around = |x: &[f64]| 3.0 * (x[0] - 0.6).abs() + (x[0] - x[1] - 0.3).abs();
        assert!(slope_of(around, &[0.6, 0.3]).is_none_or(|slope| slope.share < 1e-3));
    }

    #[test]
    fn on_a_bound_only_what_is_left_counts() {
        let found = slope_of(|x| x[0] - x[1], &[0.0, 0.4]).unwrap();
        assert_eq!(found.along, [-0.0, 1.0]);
        assert_eq!(slope_of(|x| x[0] - x[1], &[0.0, 1.0]), None);
        assert_eq!(slope_of(|_| f64::INFINITY, &[0.2, 1.0]), None);
    }

    #[test]
    fn kinks_are_told_from_curves() {
        let look = |function: fn(&[f64]) -> f64| {
            let at = [0.4, 0.7];
            let around = |radius| cross(&at, radius, 1).iter().map(|x| function(x)).collect::<Vec<_>>();
            kinked(function(&at), &around(1e-4), &around(1e-5), 10.0)
        };
        assert!(look(|x| (x[0] - 0.4).abs() + x[1]));
        assert!(!look(|x| (x[0] - 0.4).powi(2) + 50.0 * (x[0] - 0.4) * (x[1] - 0.7) + x[1]));
        assert!(!look(|_| 1.0));
    }
}
