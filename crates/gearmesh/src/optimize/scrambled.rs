//! Sobol points whose bits are scrambled: evenly spread as before, and each uniform by itself, so that replicates with
//! scramblings of their own say how far what they estimate is off.
//!
//! Nested uniform scrambling (Owen, Randomly permuted (t,m,s)-nets, 1995): a bit is turned or not by chance, and the chance is
//! another one for each value of the bits before it. What depends smoothly on a point is estimated from n of them with an
//! error that falls nearly as n^(−3/2) (Owen, Ann. Stat. 25 (1997) 1541), where independent points have n^(−1/2). The chance
//! is a hash of the bits before, so any point is found by itself. Must not know: what the points are for.

use rand_core::Rng;

use super::by_number::mixed;
use super::sobol::Sequence;
use declare::seed::Seed;

const BITS: u32 = 32;
/// Bits behind those of the sequence.
const FURTHER: u32 = 20;

/// Scrambled sequences.
#[derive(Clone, Debug)]
pub struct Scrambled {
    sequence: Sequence,
    /// By replicate and variable.
    keys: Vec<Vec<u64>>,
}

impl Scrambled {
    /// So many of them, each scrambled in its own way.
    ///
    /// # Panics
    /// With more variables than [`super::sobol::MOST_VARIABLES`].
    #[must_use]
    pub fn new(replicates: usize, dimension: usize, seed: &Seed) -> Self {
        let of_replicate = |replicate: usize| {
            let mut generator = seed.generator(replicate as u64);
            (0..dimension).map(|_| generator.next_u64()).collect()
        };
        Self { sequence: Sequence::new(dimension), keys: (0..replicates).map(of_replicate).collect() }
    }

    /// One coordinate of point `index` of a replicate, counted from 0 and below 2³²; above 0 and below 1.
    #[must_use]
    pub fn coordinate(&self, replicate: usize, variable: usize, index: usize) -> f64 {
        scrambled(self.sequence.bits(variable, index), self.keys[replicate][variable])
    }
}

fn scrambled(bits: u32, key: u64) -> f64 {
    // Bits before one, with a 1 ahead of them: a number of its own for each.
    let chance = |before: u32| mixed(key ^ mixed((1 << before) | u64::from(bits) >> (BITS - before)));
    let mut found = u64::from(bits);
    for before in 0..BITS {
        found ^= (chance(before) >> 63) << (BITS - 1 - before);
    }
    // Behind the last one all is chance. In the middle of its 2⁻⁵², no point is at an end.
    let further = chance(BITS) >> (u64::BITS - FURTHER);
    ((found << FURTHER | further) as f64 + 0.5) * (1.0 / (1_u64 << (BITS + FURTHER)) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(count: usize, dimension: usize) -> Vec<Vec<f64>> {
        let scrambled = Scrambled::new(3, dimension, &Seed::of_stage(5, "scrambled"));
        (0..count).map(|index| (0..dimension).map(|at| scrambled.coordinate(2, at, index)).collect()).collect()
    }

    /// Tier: invariant; a scrambled net is a net. Of 2¹⁰ points every one of 2¹⁰ strata of a variable holds one, and of the first
    /// two variables, a net of its best kind, every box of 2⁻ᵃ by 2⁻ᵇ with a + b = 10 too.
    #[test]
    fn a_scrambled_net_is_a_net() {
        let (bits, points) = (10_u32, points(1 << 10, 6));
        let cell = |value: f64, bits: u32| {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let cell = (value * f64::from(1_u32 << bits)) as usize;
            cell
        };
        let holds_one_each = |of: &dyn Fn(&Vec<f64>) -> usize| {
            let mut found: Vec<usize> = points.iter().map(of).collect();
            found.sort_unstable();
            assert!(found.into_iter().eq(0..1 << bits));
        };
        for variable in 0..6 {
            holds_one_each(&|point| cell(point[variable], bits));
        }
        for first in 0..=bits {
            holds_one_each(&|point| cell(point[0], first) << (bits - first) | cell(point[1], bits - first));
        }
    }

    /// Each point by itself is uniform over scramblings: 4,000 of them, 20 strata, 19 degrees of freedom, 99.9 % below 43.8.
    #[test]
    fn each_point_is_uniform_over_scramblings() {
        for (variable, index) in [(0, 0), (1, 5), (3, 1023)] {
            let scrambled = Scrambled::new(4000, 4, &Seed::of_stage(1, "uniform"));
            let mut counts = [0_u32; 20];
            for replicate in 0..4000 {
                let value = scrambled.coordinate(replicate, variable, index);
                assert!(value > 0.0 && value < 1.0);
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
                let at = (value * 20.0) as usize;
                counts[at] += 1;
            }
            let square: f64 = counts.iter().map(|count| (f64::from(*count) - 200.0).powi(2) / 200.0).sum();
            assert!(square < 43.8, "{counts:?}");
        }
        assert!(scrambled(u32::MAX, 3) < 1.0 && scrambled(0, 9) > 0.0);
    }
}
