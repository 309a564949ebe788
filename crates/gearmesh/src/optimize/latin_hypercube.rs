//! Latin hypercube: each variable's range cut into as many strata as there are points, one point in each.
//!
//! Source: McKay, Beckman, Conover, Technometrics 21 (1979) 239. Must not know: the objective.

use rand_core::Rng;

use super::random::{permutation, uniform};
use super::sampling::{self, MOST_POINTS, Sample};
use super::{Foreseen, Method, Strategy};
use declare::Declared;
use declare::error::Diagnostic;
use declare::seed::Seed;

/// random points, one in each stratum of every variable
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "latin_hypercube")]
pub struct LatinHypercube {
    /// number of points
    #[declared(minimum = 1, maximum = MOST_POINTS, default = "256")]
    pub points: usize,
}

impl Method for LatinHypercube {
    fn foresee(&self, dimension: usize) -> Result<Foreseen, Diagnostic> {
        // A number for each variable, and while one is drawn its strata.
        sampling::foreseen(Some(self.points), dimension, 8 * (dimension + 1))
    }

    fn learns(&self) -> bool {
        false
    }

    fn strategy(&self, dimension: usize, seed: Seed) -> Box<dyn Strategy> {
        let columns = columns(self.points, dimension, &mut seed.generator(0));
        let layout = move |index: usize| columns.iter().map(|column| column[index]).collect();
        Box::new(Sample::new(self.points, Box::new(layout)))
    }
}

/// `count` points of the unit cube, coordinates in 0..1.
pub fn points(count: usize, dimension: usize, generator: &mut impl Rng) -> Vec<Vec<f64>> {
    let columns = columns(count, dimension, generator);
    (0..count).map(|index| columns.iter().map(|column| column[index]).collect()).collect()
}

/// The same, variable by variable: a point by itself takes as much again as its numbers.
fn columns(count: usize, dimension: usize, generator: &mut impl Rng) -> Vec<Vec<f64>> {
    let column = |_| {
        let strata = permutation(generator, count);
        // Rounding may lift the topmost point of the last stratum to 1, which is still in the cube.
        strata.into_iter().map(|stratum| ((stratum as f64 + uniform(generator)) / count as f64).min(1.0)).collect()
    };
    (0..dimension).map(column).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stratum_of_every_variable_holds_one_point() {
        for count in [1, 2, 17, 100] {
            let points = points(count, 3, &mut Seed::of_stage(3, "strata").generator(0));
            for variable in 0..3 {
                let mut strata: Vec<f64> =
                    points.iter().map(|point| (point[variable] * count as f64).floor()).collect();
                strata.sort_by(f64::total_cmp);
                let expected: Vec<f64> = (0..count).map(|stratum| stratum as f64).collect();
                assert_eq!(strata, expected);
            }
        }
    }

    #[test]
    fn the_variables_are_not_correlated() {
        // 2000 points: the correlation of independent orders has a standard deviation of 1/√1999 = 0.0224.
        let points = points(2000, 2, &mut Seed::of_stage(3, "correlation").generator(0));
        let covariance: f64 = points.iter().map(|point| (point[0] - 0.5) * (point[1] - 0.5)).sum::<f64>() / 2000.0;
        assert!((covariance * 12.0).abs() < 4.0 * 0.0224, "{}", covariance * 12.0);
    }
}
