//! Logarithms of numbers next to one whose logarithm is known, for iterations that come nearer and nearer.
//!
//! ln(x/x₀) = 2 artanh((x − x₀)/(x + x₀)) as a series. Must not know: whose logarithms.

/// How far the argument of the series may be from 0: up to there it is good to rounding.
const REACH: f64 = 0.05;

/// Those of small numbers, from 0 on.
const LOGS: [f64; 7] = [
    f64::NEG_INFINITY,
    0.0,
    std::f64::consts::LN_2,
    1.098_612_288_668_109_7,
    2.0 * std::f64::consts::LN_2,
    1.609_437_912_434_100_3,
    1.791_759_469_228_055,
];

/// The bits of √½ without those of the lower half, and those of 1 less them: added to the bits of a number, these carry over to
/// its exponent from a mantissa of √2 on.
const LEAST: u64 = 0x3fe6_a09e_0000_0000;
const OFFSET: u64 = 0x3ff0_0000_0000_0000 - LEAST;
const MANTISSA: u64 = 0x000f_ffff_ffff_ffff;
/// The bits of 2⁵², to which whole numbers can be added as they are, and what is too much of an exponent then.
const WHOLE: u64 = 0x4330_0000_0000_0000;
const UNBIASED: f64 = 4_503_599_627_370_496.0 + 1023.0;

/// ln of each of several normal numbers > 0, to the last bit as the library has it one by one: its formula without its branches
/// for other numbers, so that a processor takes several at a time.
///
/// Source: Sun's `e_log.c`, as in FreeBSD's msun, by way of `libm`.
#[must_use]
#[inline]
pub fn of_each<const M: usize>(numbers: &[f64; M]) -> [f64; M] {
    let mut logs = [0.0; M];
    for m in 0..M {
        let bits = numbers[m].to_bits().wrapping_add(OFFSET);
        let exponent = f64::from_bits(WHOLE | (bits >> 52)) - UNBIASED;
        let f = f64::from_bits((bits & MANTISSA) + LEAST) - 1.0;
        // ln(1 + f) = 2 artanh s.
        let s = f / (2.0 + f);
        let z = s * s;
        let w = z * z;
        let even = w * (SERIES[1] + w * (SERIES[3] + w * SERIES[5]));
        let odd = z * (SERIES[0] + w * (SERIES[2] + w * (SERIES[4] + w * SERIES[6])));
        let half = 0.5 * f * f;
        logs[m] = s * (half + (odd + even)) + exponent * LN_2_REST - half + f + exponent * LN_2_FIRST;
    }
    logs
}

/// Of 2 artanh s/s − 2 in powers of s², so that the largest error is the least.
#[allow(clippy::excessive_precision)] // as they are published
const SERIES: [f64; 7] = [
    6.666_666_666_666_735_130e-01,
    3.999_999_999_940_941_908e-01,
    2.857_142_874_366_239_149e-01,
    2.222_219_843_214_978_396e-01,
    1.818_357_216_161_805_012e-01,
    1.531_383_769_920_937_332e-01,
    1.479_819_860_511_658_591e-01,
];
/// ln 2 in two parts, the first with few enough digits that its multiples are exact.
#[allow(clippy::excessive_precision)]
const LN_2_FIRST: f64 = 6.931_471_803_691_238_164_90e-01;
#[allow(clippy::excessive_precision)]
const LN_2_REST: f64 = 1.908_214_929_270_587_700_02e-10;

/// A number and its logarithm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// The number, > 0.
    pub number: f64,
    /// ln of it.
    pub log: f64,
}

impl Known {
    /// Of any number > 0.
    #[must_use]
    pub fn new(number: f64) -> Self {
        Self { number, log: libm::log(number) }
    }

    /// A part of it, of as many as there are.
    #[must_use]
    pub fn over(&self, parts: usize) -> Self {
        let number = self.number / parts as f64;
        LOGS.get(parts).map_or_else(|| Self::new(number), |log| Self { number, log: self.log - log })
    }

    /// Another one > 0, at little cost if it is within a tenth of this.
    #[must_use]
    #[inline]
    pub fn next(&self, number: f64) -> Self {
        self.near(number).unwrap_or_else(|| Self::new(number))
    }

    /// The same if it is within a tenth of this.
    #[must_use]
    #[inline]
    pub fn near(&self, number: f64) -> Option<Self> {
        let z = (number - self.number) / (number + self.number);
        if z.abs() > REACH || z.is_nan() {
            return None;
        }
        let q = z * z;
        let tail = 1.0 / 3.0 + q * (0.2 + q * (1.0 / 7.0 + q * (1.0 / 9.0 + q * (1.0 / 11.0 + q / 13.0))));
        Some(Self { number, log: self.log + 2.0 * (z + z * q * tail) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tier: second method; near the known number and far from it, where its own logarithm is small too.
    #[test]
    fn logarithms_are_those_of_the_library() {
        for number in [1e-9, 0.7, 1.0, 3.0, 8e5] {
            let known = Known::new(number);
            for step in -300..=300 {
                let other = number * libm::exp(f64::from(step) * 1e-3);
                let (found, exact) = (known.next(other), libm::log(other));
                assert!((found.log - exact).abs() <= 2.0 * f64::EPSILON * exact.abs().max(known.log.abs()) + 2e-17);
                assert!(found.number.to_bits() == other.to_bits());
            }
        }
        // Several at once to the last bit, whatever their exponents are.
        for exponent in -1000..=1000 {
            let number = libm::exp2(f64::from(exponent)) * (1.0 + 0.37 * libm::sin(f64::from(exponent)).abs());
            let near = 1.0 + f64::from(exponent) * 3e-4;
            let numbers = [number, near, 1.0, 1.0 / number, f64::MIN_POSITIVE, f64::MAX];
            assert_eq!(of_each(&numbers).map(f64::to_bits), numbers.map(|number| libm::log(number).to_bits()));
        }
        for parts in 1..=8 {
            let (part, exact) = (Known::new(700.0).over(parts), libm::log(700.0 / parts as f64));
            assert!((part.log / exact - 1.0).abs() < 3e-16 && (part.number * parts as f64 / 700.0 - 1.0).abs() < 3e-16);
        }
        assert!(Known::new(1.0).next(f64::INFINITY).log.is_infinite());
    }
}
