//! Full factorial grid: every combination of equally spaced levels, both bounds included, the last variable fastest.
//!
//! Must not know: seeds.

use super::sampling::{self, Sample};
use super::{Foreseen, Method, Strategy};
use declare::Declared;
use declare::error::Diagnostic;
use declare::seed::Seed;

/// every combination of equally spaced levels, bounds included
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "grid")]
pub struct Grid {
    /// number of levels: one for all variables, or one for each
    #[declared(minimum = 2, maximum = 100_000, default = "11")]
    pub levels: Vec<usize>,
}

impl Grid {
    /// The levels of each variable.
    fn of_each(&self, dimension: usize) -> Result<Vec<usize>, Diagnostic> {
        match self.levels[..] {
            [all] => Ok(vec![all; dimension]),
            _ if self.levels.len() == dimension => Ok(self.levels.clone()),
            _ => {
                let message = format!("{} levels are given for {dimension} variables", self.levels.len());
                Err(Diagnostic::new(message).help("give one number for all variables, or one for each"))
            }
        }
    }
}

impl Method for Grid {
    fn foresee(&self, dimension: usize) -> Result<Foreseen, Diagnostic> {
        let levels = self.of_each(dimension);
        let foreseen = levels.and_then(|levels| sampling::foreseen(combinations(&levels), dimension, 0));
        foreseen.map_err(|wrong| wrong.of(Self::NAMES.levels))
    }

    fn learns(&self) -> bool {
        false
    }

    fn strategy(&self, dimension: usize, _: Seed) -> Box<dyn Strategy> {
        let levels = self.of_each(dimension).unwrap_or_default();
        let count = combinations(&levels).unwrap_or(0);
        Box::new(Sample::new(count, Box::new(move |index| point(&levels, index))))
    }
}

fn combinations(levels: &[usize]) -> Option<usize> {
    levels.iter().try_fold(1_usize, |count, levels| count.checked_mul(*levels))
}

/// The digits of `index` in the mixed radix of `levels`, as shares of the highest digit.
fn point(levels: &[usize], mut index: usize) -> Vec<f64> {
    let mut unit = vec![0.0; levels.len()];
    for (coordinate, &levels) in unit.iter_mut().zip(levels).rev() {
        *coordinate = (index % levels) as f64 / (levels - 1) as f64;
        index /= levels;
    }
    unit
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_combination_comes_once_the_last_fastest() {
        let points: Vec<_> = (0..6).map(|index| point(&[2, 3], index)).collect();
        assert_eq!(points, [[0.0, 0.0], [0.0, 0.5], [0.0, 1.0], [1.0, 0.0], [1.0, 0.5], [1.0, 1.0]]);
    }
}
