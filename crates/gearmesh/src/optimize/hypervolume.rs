//! The hypervolume of a front: how much of the space below a reference point it dominates.
//!
//! Source: Zitzler and Thiele, IEEE Trans. Evol. Comput. 3 (1999) 257; found by slicing objectives (While, Hingston, Barone,
//! Huband, IEEE Trans. Evol. Comput. 10 (2006) 29), n² log n with three objectives. Must not know: where points come from.

/// What points, each with as many objectives (to be small) as `reference`, dominate of the box below it; 0 of none.
#[must_use]
pub fn hypervolume(points: &[Vec<f64>], reference: &[f64]) -> f64 {
    let below = |point: &&Vec<f64>| point.iter().zip(reference).all(|(value, limit)| value < limit);
    let mut inside: Vec<&[f64]> = points.iter().filter(below).map(|point| &point[..]).collect();
    volume(&mut inside, reference)
}

/// `points` are all below the reference in as many of their first objectives as it has.
fn volume(points: &mut [&[f64]], reference: &[f64]) -> f64 {
    let Some((&limit, rest)) = reference.split_last() else { return 1.0 };
    let axis = rest.len();
    points.sort_by(|a, b| a[axis].total_cmp(&b[axis]));
    if rest.is_empty() {
        return points.first().map_or(0.0, |lowest| limit - lowest[0]);
    }
    // With the last objective growing, ever more points count.
    let mut sum = 0.0;
    if let [across] = rest {
        let mut lowest = *across;
        for (index, point) in points.iter().enumerate() {
            lowest = lowest.min(point[0]);
            let end = points.get(index + 1).map_or(limit, |next| next[axis]);
            sum += (across - lowest) * (end - point[axis]);
        }
        return sum;
    }
    for index in 0..points.len() {
        let end = points.get(index + 1).map_or(limit, |next| next[axis]);
        let height = end - points[index][axis];
        if height > 0.0 {
            sum += height * volume(&mut points[..=index].to_vec(), rest);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tier: closed form.
    #[test]
    #[allow(clippy::float_cmp, reason = "sums of these are exact")]
    fn boxes_that_overlap_count_once() {
        let points = vec![vec![1.0, 3.0], vec![2.0, 2.0], vec![3.0, 1.0], vec![2.5, 2.5], vec![5.0, 0.0]];
        assert_eq!(hypervolume(&points, &[4.0, 4.0]), 6.0);
        let three = vec![vec![0.0, 0.0, 1.0], vec![1.0, 0.0, 0.0], vec![0.0, 1.0, 0.0], vec![1.0, 1.0, 0.0]];
        // Two by two by two, less a cube of one that none reaches.
        assert_eq!(hypervolume(&three, &[2.0; 3]), 7.0);
        let four = vec![vec![0.5; 4], vec![0.0, 0.75, 0.75, 0.75]];
        assert_eq!(hypervolume(&four, &[1.0; 4]), 0.5_f64.powi(4) + 0.5 * 0.25_f64.powi(3));
        assert_eq!(hypervolume(&[], &[1.0, 1.0]), 0.0);
        assert_eq!(hypervolume(&[vec![3.0], vec![2.0]], &[5.0]), 3.0);
    }

    /// Tier: second method. Points drawn in the box are counted; 40,000 have a standard deviation of 0.25 %.
    #[test]
    fn it_is_the_share_of_points_that_are_dominated() {
        let draw = |at: usize, prime: usize| {
            let (mut index, mut share, mut value) = (at + 1, 1.0, 0.0);
            while index > 0 {
                share /= prime as f64;
                value += share * (index % prime) as f64;
                index /= prime;
            }
            value
        };
        for count in [3, 17] {
            let points: Vec<Vec<f64>> =
                (0..count).map(|at| [2, 3, 5].map(|prime| draw(31 * at + 5, prime)).to_vec()).collect();
            let dominated = (0..40_000).filter(|at| {
                let place = [7, 11, 13].map(|prime| draw(*at, prime));
                points.iter().any(|point| point.iter().zip(place).all(|(value, place)| *value <= place))
            });
            let (counted, found) = (dominated.count() as f64 / 40_000.0, hypervolume(&points, &[1.0; 3]));
            assert!((counted - found).abs() < 0.005, "{counted} {found}");
        }
    }
}
