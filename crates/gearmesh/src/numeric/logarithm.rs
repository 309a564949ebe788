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
        for parts in 1..=8 {
            let (part, exact) = (Known::new(700.0).over(parts), libm::log(700.0 / parts as f64));
            assert!((part.log / exact - 1.0).abs() < 3e-16 && (part.number * parts as f64 / 700.0 - 1.0).abs() < 3e-16);
        }
        assert!(Known::new(1.0).next(f64::INFINITY).log.is_infinite());
    }
}
