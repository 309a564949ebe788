//! The few distributions the methods need, from the bits of a generator.
//!
//! Written out so that a result never changes because a library draws in another order. Must not know: seeds.

use rand_core::Rng;

/// Uniform in 0..1, a multiple of 2⁻⁵³.
pub fn uniform(generator: &mut impl Rng) -> f64 {
    (generator.next_u64() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
}

/// True with the given probability; never for 0, always for 1.
pub fn chance(generator: &mut impl Rng, probability: f64) -> bool {
    uniform(generator) < probability
}

/// Uniform in 0..count, without the bias of a remainder: draws from the incomplete last cycle are thrown away.
///
/// # Panics
/// When `count` is 0.
pub fn below(generator: &mut impl Rng, count: usize) -> usize {
    let count = count as u64;
    let last = u64::MAX - (u64::MAX % count + 1) % count;
    loop {
        let draw = generator.next_u64();
        if draw <= last {
            return usize::try_from(draw % count).expect("it is below a usize");
        }
    }
}

/// 0..count in random order (Fisher and Yates; Knuth, The Art of Computer Programming 2, algorithm 3.4.2 P).
pub fn permutation(generator: &mut impl Rng, count: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    for last in (1..count).rev() {
        order.swap(last, below(generator, last + 1));
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use declare::seed::Seed;

    /// Gives the draws it was made with.
    struct Fixed(Vec<u64>);

    impl rand_core::TryRng for Fixed {
        type Error = std::convert::Infallible;

        fn try_next_u32(&mut self) -> Result<u32, Self::Error> {
            unreachable!("no distribution here takes 32 bits")
        }

        fn try_next_u64(&mut self) -> Result<u64, Self::Error> {
            Ok(self.0.remove(0))
        }

        fn try_fill_bytes(&mut self, _: &mut [u8]) -> Result<(), Self::Error> {
            unreachable!("no distribution here takes bytes")
        }
    }

    #[test]
    fn the_ends_of_the_interval_are_as_stated() {
        assert_eq!(uniform(&mut Fixed(vec![0])).to_bits(), 0.0_f64.to_bits());
        assert_eq!(uniform(&mut Fixed(vec![u64::MAX])).to_bits(), (1.0 - f64::EPSILON / 2.0).to_bits());
        assert!(!chance(&mut Fixed(vec![0]), 0.0));
        assert!(chance(&mut Fixed(vec![u64::MAX]), 1.0));
    }

    #[test]
    fn the_incomplete_cycle_is_thrown_away() {
        // 2⁶⁴ = 3·k + 1, so the largest draw belongs to a cycle of its own.
        assert_eq!(below(&mut Fixed(vec![u64::MAX, u64::MAX - 1]), 3), 2);
        // A power of two divides 2⁶⁴: nothing is thrown away.
        assert_eq!(below(&mut Fixed(vec![u64::MAX]), 4), 3);
        assert_eq!(below(&mut Fixed(vec![7]), 1), 0);
    }

    #[test]
    fn permutations_are_equally_likely() {
        let mut generator = Seed::of_stage(1, "permutations").generator(0);
        let mut counts = std::collections::BTreeMap::new();
        for _ in 0..60_000 {
            *counts.entry(permutation(&mut generator, 4)).or_insert(0_u32) += 1;
        }
        assert_eq!(counts.len(), 24);
        let expected = 60_000.0 / 24.0;
        let square: f64 = counts.values().map(|count| (f64::from(*count) - expected).powi(2) / expected).sum();
        // 23 degrees of freedom: 99.9 % of true shuffles stay below 49.7.
        assert!(square < 49.7, "{square}");
    }
}
