//! Numbers of twice the precision: the unevaluated sum of two `f64`, about 31 digits in the exponent range of one.
//!
//! Sources: Dekker, Numerische Mathematik 18 (1971) 224 (exact sums and products without a fused multiply-add, so that
//! every processor gives the same bits); Hida, Li and Bailey, 15th IEEE Symposium on Computer Arithmetic (2001) 155
//! (sum, quotient, root, elementary functions). Digits of the lower part fade below about 1e-290. Angles up to some
//! hundred radians. It is for checking other numbers and not for speed. Must not know: what is computed.

use std::cmp::Ordering;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// high + low, |low| ≤ half a unit in the last place of high.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Double {
    /// The number rounded to an `f64`.
    pub high: f64,
    /// What that rounding left out.
    pub low: f64,
}

/// 2²⁷ + 1: splits a number into two halves of 26 bits.
const SPLITTER: f64 = 134_217_729.0;
/// Times an angle is halved, or an exponent divided by two, before its series is summed.
const HALVINGS: usize = 6;
/// What π/4 is then, nearly: up to there a series needs no halves.
const SMALL: f64 = 0.0123;

fn quick_sum(a: f64, b: f64) -> Double {
    let high = a + b;
    Double { high, low: b - (high - a) }
}

fn exact_sum(a: f64, b: f64) -> Double {
    let high = a + b;
    let part = high - a;
    Double { high, low: (a - (high - part)) + (b - part) }
}

fn split(a: f64) -> (f64, f64) {
    let t = SPLITTER * a;
    let high = t - (t - a);
    (high, a - high)
}

fn exact_product(a: f64, b: f64) -> Double {
    let high = a * b;
    let ((a1, a0), (b1, b0)) = (split(a), split(b));
    Double { high, low: ((a1 * b1 - high) + a1 * b0 + a0 * b1) + a0 * b0 }
}

impl Double {
    /// 0.
    pub const ZERO: Self = Self { high: 0.0, low: 0.0 };
    /// 1.
    pub const ONE: Self = Self { high: 1.0, low: 0.0 };
    /// π to twice the precision.
    pub const PI: Self = Self { high: std::f64::consts::PI, low: 1.224_646_799_147_353_2e-16 };
    const LN_2: Self = Self { high: std::f64::consts::LN_2, low: 2.319_046_813_846_299_6e-17 };

    /// |self|.
    #[must_use]
    pub fn abs(self) -> Self {
        if self.high < 0.0 { -self } else { self }
    }

    /// The larger of the two; `self` where one is NaN.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        if self < other { other } else { self }
    }

    /// The smaller of the two; `self` where one is NaN.
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        if self > other { other } else { self }
    }

    /// self².
    #[must_use]
    pub fn square(self) -> Self {
        self * self
    }

    /// Exact.
    #[must_use]
    pub fn times_power_of_two(self, factor: f64) -> Self {
        Self { high: self.high * factor, low: self.low * factor }
    }

    /// self/2, exact.
    #[must_use]
    pub fn half(self) -> Self {
        self.times_power_of_two(0.5)
    }

    /// √self; 0 for what is not positive.
    #[must_use]
    pub fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return Self::ZERO;
        }
        // One Newton step for 1/√a, arranged so that only one product has to be exact.
        let inverse = 1.0 / self.high.sqrt();
        let guess = self.high * inverse;
        exact_sum(guess, (self - exact_product(guess, guess)).high * (0.5 * inverse))
    }

    /// Sine and cosine.
    #[must_use]
    pub fn sine_cosine(self) -> (Self, Self) {
        let quarter = Self::PI.half();
        let turns = (self.high / quarter.high).round();
        let rest = self - quarter * turns;
        // A small angle needs no halves.
        let (halvings, share) = if rest.high.abs() <= SMALL { (0, 1.0) } else { (HALVINGS, 0.015_625) };
        let small = rest.times_power_of_two(share);
        let square = small.square();
        // sin x and 1 − cos x, so that doubling the angle loses nothing; the last terms are those of x¹⁷ and x¹⁶.
        let mut sine = small * series(-square, 9, |k| (2 * k + 2) * (2 * k + 3));
        let mut versine = square.half() * series(-square, 8, |k| (2 * k + 3) * (2 * k + 4));
        for _ in 0..halvings {
            (sine, versine) =
                (sine.times_power_of_two(2.0) * (Self::ONE - versine), sine.square().times_power_of_two(2.0));
        }
        let cosine = Self::ONE - versine;
        match turns.rem_euclid(4.0) {
            turn if turn < 0.5 => (sine, cosine),
            turn if turn < 1.5 => (cosine, -sine),
            turn if turn < 2.5 => (-sine, -cosine),
            _ => (-cosine, sine),
        }
    }

    /// tan self, of an angle \[rad\].
    #[must_use]
    pub fn tangent(self) -> Self {
        let (sine, cosine) = self.sine_cosine();
        sine / cosine
    }

    /// The angle of the point (`x`, `self`).
    #[must_use]
    pub fn arctangent(self, x: Self) -> Self {
        let guess = libm::atan2(self.high, x.high);
        let (sine, cosine) = Self::from(guess).sine_cosine();
        // The tangent of what is missing: its cube is below the last digit.
        Self::from(guess) + (self * cosine - x * sine) / (x * cosine + self * sine)
    }

    /// e^self, for exponents of a few hundred at most.
    #[must_use]
    pub fn exponential(self) -> Self {
        let power = (self.high / Self::LN_2.high).round();
        let small = (self - Self::LN_2 * power).times_power_of_two(0.015_625);
        // e^x − 1, so that squaring loses nothing; the last term is that of x¹⁵.
        let mut excess = small * series(small, 15, |k| k + 2);
        for _ in 0..HALVINGS {
            excess = excess.times_power_of_two(2.0) + excess.square();
        }
        #[allow(clippy::cast_possible_truncation)] // a few hundred
        let scale = libm::ldexp(1.0, power as i32);
        (excess + Self::ONE).times_power_of_two(scale)
    }

    /// ln self, of a positive number.
    #[must_use]
    pub fn logarithm(self) -> Self {
        let guess = Self::from(libm::log(self.high));
        let rest = self * (-guess).exponential() - Self::ONE;
        guess + rest - rest.square().half()
    }
}

/// 1 + x/q₀ + x²/(q₀ q₁) + …, `terms` of them, with q of the index and the product of all q below 2⁵³: brought to one
/// denominator, since a quotient takes as long as five products.
fn series(x: Double, terms: u32, q: impl Fn(u32) -> u32) -> Double {
    let (mut sum, mut denominator) = (Double::ONE, 1.0);
    for index in (0..terms - 1).rev() {
        denominator *= f64::from(q(index));
        sum = sum * x + denominator;
    }
    sum / denominator
}

impl From<f64> for Double {
    fn from(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }
}

impl PartialOrd for Double {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        match self.high.partial_cmp(&other.high) {
            Some(Ordering::Equal) => self.low.partial_cmp(&other.low),
            order => order,
        }
    }
}

impl Neg for Double {
    type Output = Self;
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Add for Double {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (high, low) = (exact_sum(self.high, other.high), exact_sum(self.low, other.low));
        let first = quick_sum(high.high, high.low + low.high);
        quick_sum(first.high, first.low + low.low)
    }
}

impl Sub for Double {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Double {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let product = exact_product(self.high, other.high);
        quick_sum(product.high, product.low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for Double {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        // Long division, two digits of the size of an `f64`: the next one is below the last.
        let first = self.high / other.high;
        let rest = self - other * first;
        quick_sum(first, rest.high / other.high)
    }
}

impl Add<f64> for Double {
    type Output = Self;
    fn add(self, other: f64) -> Self {
        self + Self::from(other)
    }
}

impl Sub<f64> for Double {
    type Output = Self;
    fn sub(self, other: f64) -> Self {
        self + Self::from(-other)
    }
}

impl Mul<f64> for Double {
    type Output = Self;
    fn mul(self, other: f64) -> Self {
        let product = exact_product(self.high, other);
        quick_sum(product.high, product.low + self.low * other)
    }
}

impl Div<f64> for Double {
    type Output = Self;
    fn div(self, other: f64) -> Self {
        let first = self.high / other;
        let rest = self - exact_product(first, other);
        quick_sum(first, rest.high / other)
    }
}

impl AddAssign for Double {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Double {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Digits = (f64, f64);

    /// x, sin x, cos x, eˣ, atan x, ln |x|: by another program with 60 digits, for the very `f64` that x is.
    const VALUES: [(f64, Digits, Digits, Digits, Digits, Digits); 6] = [
        (
            0.1,
            (0.099_833_416_646_828_15, 3.080_015_129_294_92e-18),
            (0.995_004_165_278_025_8, -5.502_101_569_183_77e-17),
            (1.105_170_918_075_647_7, -8.149_523_913_327_619e-17),
            (0.099_668_652_491_162_04, -5.190_520_336_352_787e-18),
            (-2.302_585_092_994_045_5, -1.715_024_362_805_798_5e-16),
        ),
        (
            0.5,
            (0.479_425_538_604_203, -5.103_969_860_556_013e-18),
            (0.877_582_561_890_372_8, -4.262_314_986_427_999_7e-17),
            (1.648_721_270_700_128_2, -4.731_568_479_435_833e-17),
            (0.463_647_609_000_806_1, 2.269_877_745_296_168_7e-17),
            (-std::f64::consts::LN_2, -2.319_046_813_846_299_6e-17),
        ),
        (
            1.2,
            (0.932_039_085_967_226_3, 4.514_654_241_894_944_6e-17),
            (0.362_357_754_476_673_6, -2.339_608_366_477_996_7e-18),
            (3.320_116_922_736_547_2, 1.040_282_007_097_269_4e-16),
            (0.876_058_050_598_193_4, -1.137_812_227_761_662_4e-17),
            (0.182_321_556_793_954_6, -3.041_725_967_180_815_8e-18),
        ),
        (
            2.9,
            (0.239_249_329_213_982_43, -1.126_766_664_349_812_4e-17),
            (-0.970_958_165_149_590_5, 4.579_633_153_232_696e-17),
            (18.174_145_369_443_06, -1.031_993_582_585_590_2e-15),
            (1.238_736_859_252_011_2, -2.571_119_118_874_906e-17),
            (1.064_710_736_992_428_2, 7.091_773_787_274_429e-17),
        ),
        (
            -7.3,
            (-0.850_436_620_628_564_4, -2.486_256_361_786_5e-17),
            (0.526_077_517_381_105_3, 3.150_282_613_539_294e-17),
            (0.000_675_538_775_193_844_4, -2.907_750_493_846_276_6e-20),
            (-1.434_657_365_941_755_9, 1.905_353_342_392_367e-18),
            (1.987_874_348_154_345_5, -7.332_585_751_995_12e-17),
        ),
        (
            0.0001,
            (9.999_999_983_333_334e-5, -5.100_142_875_961_974_4e-21),
            (0.999_999_995, -2.622_068_866_855_033e-17),
            (1.000_100_005_000_166_7, -4.325_932_211_872_079e-17),
            (9.999_999_966_666_667e-5, 5.185_574_723_232_158_6e-21),
            (-9.210_340_371_976_182, -8.601_326_140_234_914e-16),
        ),
    ];

    #[test]
    fn elementary_functions_have_thirty_digits() {
        for (x, sine, cosine, exponential, arctangent, logarithm) in VALUES {
            let x = Double::from(x);
            let (s, c) = x.sine_cosine();
            let all = [
                (s, sine),
                (c, cosine),
                (x.exponential(), exponential),
                (x.arctangent(Double::ONE), arctangent),
                (x.abs().logarithm(), logarithm),
                (x.tangent() * c, sine),
            ];
            for (index, (found, (high, low))) in all.into_iter().enumerate() {
                let exact = Double { high, low };
                let error = ((found - exact) / exact).high.abs();
                assert!(error < 2e-30, "{index} of {x:?}: {error:e}");
            }
        }
    }

    #[test]
    fn arithmetic_is_exact_to_thirty_one_digits() {
        let (third, tenth) = (Double::ONE / 3.0, Double::ONE / 10.0);
        let nothing = |value: Double| assert!(value.high.abs() < 1e-31, "{value:?}");
        nothing(third * 3.0 - Double::ONE);
        nothing((third + tenth) * (third - tenth) - (third.square() - tenth.square()));
        nothing(Double::from(2.0).sqrt().square().half() - Double::ONE);
        nothing((Double::PI / third) * third - Double::PI);
        // What an `f64` forgets.
        assert_eq!((Double::ONE + 1e-25) - Double::ONE, Double::from(1e-25));
        assert_eq!(Double::from(-4.0).sqrt(), Double::ZERO);
        assert!(Double::ONE + 1e-25 > Double::ONE && Double::ONE.max(Double::PI) == Double::PI);
    }

    /// Tier: exact; products of whole numbers of 53 bits, counted in 128.
    #[test]
    #[allow(clippy::cast_possible_truncation)]
    fn a_product_is_split_without_rest() {
        let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
        let mut whole = || {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (bits >> 11) | 1 << 52 | 1
        };
        for _ in 0..10_000 {
            let (a, b) = (whole(), whole());
            let Double { high, low } = exact_product(a as f64, b as f64);
            assert_eq!(high as i128 + low as i128, i128::from(a) * i128::from(b), "{a} {b}");
        }
    }

    #[test]
    fn every_quadrant_is_met() {
        for quarter in -9_i32..=9 {
            let angle = Double::PI.half() * f64::from(quarter) + 0.3;
            let (sine, cosine) = angle.sine_cosine();
            let (s, c) = libm::sincos(angle.high);
            assert!((sine.high - s).abs() < 1e-15 && (cosine.high - c).abs() < 1e-15, "{quarter}");
            assert!((sine.square() + cosine.square() - Double::ONE).high.abs() < 1e-30);
        }
    }

    /// Tier: invariant; whatever the size of the divisor.
    #[test]
    fn a_quotient_times_its_divisor_is_the_dividend() {
        for size in [1e-9, 1e-3, 1.0, 7e4, 3e11] {
            let divisor = Double::PI.sqrt() * size;
            let error = Double::PI / divisor * divisor / Double::PI - Double::ONE;
            assert!(error.high.abs() < 4e-31, "{size}: {error:?}");
        }
    }
}
