//! Sobol points: a sequence that fills the cube evenly at every length, best at powers of two. Not scrambled.
//!
//! Source: Joe and Kuo, SIAM J. Sci. Comput. 30 (2008) 2635, primitive polynomials and initial direction numbers of
//! their set D6; the order is that of the Gray code (Antonov and Saleev 1979). Must not know: seeds.

use super::sampling::{self, MOST_POINTS, Sample};
use super::{Foreseen, Method, Strategy};
use declare::Declared;
use declare::error::Diagnostic;
use declare::seed::Seed;

/// evenly spread points, best when their number is a power of two
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "sobol")]
pub struct Sobol {
    /// number of points
    #[declared(minimum = 1, maximum = MOST_POINTS, default = "256")]
    pub points: usize,
}

const BITS: u32 = 32;

/// For the second variable onwards: the inner coefficients of the primitive polynomial as bits, and m₁, m₂, …; the
/// polynomial's degree is the number of the m.
const DIRECTIONS: &[(u32, &[u32])] = &[
    (0, &[1]),
    (1, &[1, 3]),
    (1, &[1, 3, 1]),
    (2, &[1, 1, 1]),
    (1, &[1, 1, 3, 3]),
    (4, &[1, 3, 5, 13]),
    (2, &[1, 1, 5, 5, 17]),
    (4, &[1, 1, 5, 5, 5]),
    (7, &[1, 1, 7, 11, 19]),
    (11, &[1, 1, 5, 1, 1]),
    (13, &[1, 1, 1, 3, 11]),
    (14, &[1, 3, 5, 5, 31]),
    (1, &[1, 3, 3, 9, 7, 49]),
    (13, &[1, 1, 1, 15, 21, 21]),
    (16, &[1, 3, 1, 13, 27, 49]),
];

impl Method for Sobol {
    fn foresee(&self, dimension: usize) -> Result<Foreseen, Diagnostic> {
        let maximum = MOST_VARIABLES;
        if dimension > maximum {
            return Err(Diagnostic::new(format!(
                "Sobol points are tabulated for at most {maximum} variables, not {dimension}"
            ))
            .help("use `latin_hypercube`"));
        }
        sampling::foreseen(Some(self.points), dimension, 0)
    }

    fn learns(&self) -> bool {
        false
    }

    fn strategy(&self, dimension: usize, _: Seed) -> Box<dyn Strategy> {
        let sequence = Sequence::new(dimension);
        let layout =
            Box::new(move |index| (0..dimension).map(|variable| sequence.coordinate(variable, index)).collect());
        Box::new(Sample::new(self.points, layout))
    }
}

/// The most variables that there are direction numbers for.
pub const MOST_VARIABLES: usize = DIRECTIONS.len() + 1;

/// The points by their number, in any order.
#[derive(Clone, Debug)]
pub struct Sequence(Vec<[u32; BITS as usize]>);

impl Sequence {
    /// # Panics
    /// With more variables than [`MOST_VARIABLES`].
    #[must_use]
    pub fn new(dimension: usize) -> Self {
        Self((0..dimension).map(directions).collect())
    }

    /// One coordinate of point `index`, counted from 0 and below 2³²; in 0..1.
    #[must_use]
    pub fn coordinate(&self, variable: usize, index: usize) -> f64 {
        coordinate(&self.0[variable], index)
    }
}

/// v₁ … v₃₂ of one variable, as fractions of 2³².
fn directions(variable: usize) -> [u32; BITS as usize] {
    let mut directions = [0; BITS as usize];
    let Some((polynomial, initial)) = variable.checked_sub(1).map(|at| DIRECTIONS[at]) else {
        for (bit, direction) in (0..BITS).zip(&mut directions) {
            *direction = 1 << (BITS - 1 - bit);
        }
        return directions;
    };
    let degree = initial.len();
    for at in 0..BITS as usize {
        directions[at] = if at < degree {
            initial[at] << (BITS as usize - 1 - at)
        } else {
            let mut direction = directions[at - degree] ^ (directions[at - degree] >> degree);
            for inner in 1..degree {
                if polynomial >> (degree - 1 - inner) & 1 == 1 {
                    direction ^= directions[at - inner];
                }
            }
            direction
        };
    }
    directions
}

fn coordinate(directions: &[u32; BITS as usize], index: usize) -> f64 {
    let gray = index ^ (index >> 1);
    let bits = directions.iter().enumerate().filter(|(bit, _)| gray >> bit & 1 == 1).fold(0, |sum, (_, v)| sum ^ v);
    f64::from(bits) / 4_294_967_296.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tier: second method; SciPy 1.17, `qmc.Sobol(16, scramble=False)` after `fast_forward(…)`, times 2²⁰. The Gray code of
    /// the first number is twenty ones, so the first twenty direction numbers of every variable are in its point; that of the
    /// second has every other one, so that what cancels in one does not in both.
    #[test]
    fn points_far_on_are_those_of_joe_and_kuo() {
        let expected = [
            [
                1_048_575, 65_553, 324_859, 774_285, 477_635, 327_961, 399_107, 888_303, 94_959, 377_517, 54_201,
                65_591, 912_827, 610_221, 271_419, 296_243,
            ],
            [
                349_525, 196_659, 826_517, 946_295, 194_369, 200_439, 687_361, 583_261, 1_003_941, 147_915, 209_479,
                197_093, 464_773, 467_255, 380_041, 100_181,
            ],
        ];
        let found = [0xAAAAA, 0xCCCCC]
            .map(|index| std::array::from_fn(|variable| coordinate(&directions(variable), index) * 1_048_576.0));
        assert_eq!(found, expected.map(|point: [u32; 16]| point.map(f64::from)));
    }
}
