//! Sobol points: a sequence that fills the cube evenly at every length, best at powers of two. Not scrambled: see
//! [`super::scrambled`].
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
    (19, &[1, 1, 1, 15, 7, 5]),
    (22, &[1, 3, 1, 15, 13, 25]),
    (25, &[1, 1, 5, 5, 19, 61]),
    (1, &[1, 3, 7, 11, 23, 15, 103]),
    (4, &[1, 3, 7, 13, 13, 15, 69]),
    (7, &[1, 1, 3, 13, 7, 35, 63]),
    (8, &[1, 3, 5, 9, 1, 25, 53]),
    (14, &[1, 3, 1, 13, 9, 35, 107]),
    (19, &[1, 3, 1, 5, 27, 61, 31]),
    (21, &[1, 1, 5, 11, 19, 41, 61]),
    (28, &[1, 3, 5, 3, 3, 13, 69]),
    (31, &[1, 1, 7, 13, 1, 19, 1]),
    (32, &[1, 3, 7, 5, 13, 19, 59]),
    (37, &[1, 1, 3, 9, 25, 29, 41]),
    (41, &[1, 3, 5, 13, 23, 1, 55]),
    (42, &[1, 3, 7, 3, 13, 59, 17]),
    (50, &[1, 3, 1, 3, 5, 53, 69]),
    (55, &[1, 1, 5, 5, 23, 33, 13]),
    (56, &[1, 1, 7, 7, 1, 61, 123]),
    (59, &[1, 1, 7, 9, 13, 61, 49]),
    (62, &[1, 3, 3, 5, 3, 55, 33]),
    (14, &[1, 3, 1, 15, 31, 13, 49, 245]),
    (21, &[1, 3, 5, 15, 31, 59, 63, 97]),
    (22, &[1, 3, 1, 11, 11, 11, 77, 249]),
    (38, &[1, 3, 1, 11, 27, 43, 71, 9]),
    (47, &[1, 1, 7, 15, 21, 11, 81, 45]),
    (49, &[1, 3, 7, 3, 25, 31, 65, 79]),
    (50, &[1, 3, 1, 1, 19, 11, 3, 205]),
    (52, &[1, 1, 5, 9, 19, 21, 29, 157]),
    (56, &[1, 3, 7, 11, 1, 33, 89, 185]),
    (67, &[1, 3, 3, 3, 15, 9, 79, 71]),
    (70, &[1, 3, 7, 11, 15, 39, 119, 27]),
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
        f64::from(self.bits(variable, index)) / 4_294_967_296.0
    }

    /// The same as a fraction of 2³².
    #[must_use]
    pub(super) fn bits(&self, variable: usize, index: usize) -> u32 {
        bits(&self.0[variable], index)
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

fn bits(directions: &[u32; BITS as usize], index: usize) -> u32 {
    let gray = index ^ (index >> 1);
    directions.iter().enumerate().filter(|(bit, _)| gray >> bit & 1 == 1).fold(0, |sum, (_, v)| sum ^ v)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tier: second method; SciPy 1.17, `qmc.Sobol(48, scramble=False)` after `fast_forward(…)`, times 2²⁰. The Gray code of
    /// the first number is twenty ones, so the first twenty direction numbers of every variable are in its point; that of the
    /// second has every other one, so that what cancels in one does not in both.
    #[test]
    fn points_far_on_are_those_of_joe_and_kuo() {
        let expected = [
            [
                1_048_575, 65_553, 324_859, 774_285, 477_635, 327_961, 399_107, 888_303, 94_959, 377_517, 54_201,
                65_591, 912_827, 610_221, 271_419, 296_243, 331_841, 299_467, 124_117, 346_981, 799_433, 1_005_169,
                929_799, 965_405, 109_847, 1_032_203, 848_367, 655_325, 753_945, 875_551, 677_119, 1_001_329, 236_415,
                672_335, 151_871, 958_759, 20_529, 1_039_033, 985_969, 140_989, 519_437, 232_461, 271_433, 362_055,
                226_767, 919_233, 615_733, 218_485,
            ],
            [
                349_525, 196_659, 826_517, 946_295, 194_369, 200_439, 687_361, 583_261, 1_003_941, 147_915, 209_479,
                197_093, 464_773, 467_255, 380_041, 100_181, 159_895, 638_813, 400_635, 877_267, 355_659, 96_199,
                561_165, 815_399, 589_609, 933_893, 84_801, 182_887, 653_091, 443_405, 448_369, 324_555, 1_030_901,
                385_505, 121_661, 1_036_093, 684_087, 296_211, 538_515, 616_471, 239_367, 33_803, 944_847, 688_589,
                797_261, 668_231, 973_971, 658_523,
            ],
        ];
        let found = [0xAAAAA, 0xCCCCC]
            .map(|index| std::array::from_fn(|variable| Sequence::new(48).coordinate(variable, index) * 1_048_576.0));
        assert_eq!(found, expected.map(|point: [u32; 48]| point.map(f64::from)));
    }
}
