//! Full factorial grid: every combination of equally spaced levels, both bounds included, the last variable fastest.
//!
//! Must not know: seeds.

use super::sampling::{self, Sample};
use super::{Foreseen, Method, Strategy};
use declare::error::Diagnostic;
use declare::parameter::{Field, Member, Shape};
use declare::record::{Record, Value};
use declare::seed::Seed;

pub const METHOD: Method = Method {
    member: Member {
        name: "grid",
        summary: "every combination of equally spaced levels, bounds included",
        fields: FIELDS,
    },
    foresee,
    build,
};

const FIELDS: &[Field] = &[Field::new(
    "levels",
    Shape::List(&Shape::Integer { least: 2, most: 100_000, multiple: 1 }),
    "number of levels: one for all variables, or one for each",
)
.default("11")];

/// The levels of each variable.
fn levels(record: &Record, dimension: usize) -> Result<Vec<usize>, Diagnostic> {
    let given: Vec<usize> = record
        .list("levels")
        .iter()
        .filter_map(|entry| match entry.value {
            Value::Integer(levels) => usize::try_from(levels).ok(),
            _ => None,
        })
        .collect();
    match given[..] {
        [all] => Ok(vec![all; dimension]),
        _ if given.len() == dimension => Ok(given),
        _ => {
            let message = format!("{} levels are given for {dimension} variables", given.len());
            Err(Diagnostic::new(message)
                .at(record.place_of("levels"))
                .help("give one number for all variables, or one for each"))
        }
    }
}

fn combinations(levels: &[usize]) -> Option<usize> {
    levels.iter().try_fold(1_usize, |count, levels| count.checked_mul(*levels))
}

fn foresee(record: &Record, dimension: usize) -> Result<Foreseen, Diagnostic> {
    let count = combinations(&levels(record, dimension)?);
    sampling::foreseen(count, dimension, 0).map_err(|wrong| wrong.at(record.place_of("levels")))
}

fn build(record: &Record, dimension: usize, _: Seed) -> Box<dyn Strategy> {
    let levels = levels(record, dimension).unwrap_or_default();
    let count = combinations(&levels).unwrap_or(0);
    Box::new(Sample::new(count, Box::new(move |index| point(&levels, index))))
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
