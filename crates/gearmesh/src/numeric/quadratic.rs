//! Quadratics about a place of their own: near where they begin they keep their digits, which powers of x itself would lose.
//!
//! Must not know: what they describe.

/// c₀ + c₁ (x − x₀) + c₂ (x − x₀)².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quadratic {
    /// x₀.
    pub origin: f64,
    /// c₀, c₁, c₂.
    pub coefficients: [f64; 3],
}

impl Quadratic {
    /// 0 everywhere.
    pub const ZERO: Self = Self { origin: 0.0, coefficients: [0.0; 3] };

    /// Whether it is 0 everywhere.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.coefficients.iter().all(|coefficient| *coefficient == 0.0)
    }

    /// The value at `x`.
    #[must_use]
    #[inline]
    pub fn value(&self, x: f64) -> f64 {
        let ([c0, c1, c2], x) = (self.coefficients, x - self.origin);
        c0 + x * (c1 + x * c2)
    }

    /// The value at `x` and both derivatives.
    #[must_use]
    #[inline]
    pub fn rates(&self, x: f64) -> [f64; 3] {
        let ([c0, c1, c2], x) = (self.coefficients, x - self.origin);
        [c0 + x * (c1 + x * c2), c1 + 2.0 * x * c2, 2.0 * c2]
    }

    /// The same as a function of y, of which x is linear: where y is `origin` x is x₀, and x grows by `rate` per y.
    #[must_use]
    pub fn against(&self, origin: f64, rate: f64) -> Self {
        let [c0, c1, c2] = self.coefficients;
        Self { origin, coefficients: [c0, c1 * rate, c2 * rate * rate] }
    }

    /// The sum, about the place of the first that is not 0.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        if self.is_zero() {
            return *other;
        }
        let ([a0, a1, a2], [b0, b1, b2]) = (self.coefficients, other.rates(self.origin));
        Self { coefficients: [a0 + b0, a1 + b1, a2 + 0.5 * b2], ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tier: closed form, (1 + 2x − x²) about 3 and 4 − (x + 1)/2.
    #[test]
    fn quadratics_add_and_turn_as_polynomials_do() {
        let one = Quadratic { origin: 3.0, coefficients: [-2.0, -4.0, -1.0] };
        let two = Quadratic { origin: -1.0, coefficients: [4.0, -0.5, 0.0] };
        for x in [-2.0, 0.0, 0.7, 3.0, 5.5] {
            let (first, second) = (1.0 + 2.0 * x - x * x, 4.0 - 0.5 * (x + 1.0));
            assert!((one.value(x) - first).abs() < 1e-14);
            for sum in [one.plus(&two), two.plus(&one), one.plus(&two).plus(&Quadratic::ZERO)] {
                assert!((sum.value(x) - first - second).abs() < 1e-13, "{x}: {sum:?}");
            }
            // y = 5 − x/2.
            let against = one.against(3.5, -2.0);
            let [value, slope, bend] = against.rates(5.0 - 0.5 * x);
            assert!((value - first).abs() < 1e-13 && (slope + 2.0 * (2.0 - 2.0 * x)).abs() < 1e-13);
            assert!((bend + 8.0).abs() < 1e-14);
        }
        assert!(Quadratic::ZERO.plus(&two) == two && !two.is_zero() && Quadratic::ZERO.is_zero());
    }
}
