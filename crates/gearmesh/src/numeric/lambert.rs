//! The lower real branch of Lambert's function, in the form in which laws with a logarithm need it.
//!
//! Must not know: whose law it is.

use std::f64::consts::SQRT_2;

/// The larger root u > 1 of u − ln u = `excess` + 1, which is −W₋₁(−exp(−1 − excess)), for 0 < `excess` < 1e150; below
/// 2e-16, u at 2e-16. Exact to rounding of the equation: u moves by u / (u − 1) times what its right side does.
///
/// A guess in √`excess`, fitted to mpmath's values, good to 1.1e-5 of u − 1 below 100 and never off by more than ln u, and
/// one step of Halley's method, which leaves 1.4e-16 of u.
#[must_use]
#[inline]
pub fn larger_root(excess: f64) -> f64 {
    let excess = excess.max(f64::EPSILON);
    let r = excess.sqrt();
    // As 1 + √2 r + 2/3 r² + … for small r.
    let above = r * (SQRT_2 + r * (0.788_758 + r * 0.051_337_9));
    let guess = 1.0 + excess + above / (1.0 + r * (0.793_351 + r * (0.168_219 + r * 0.005_213_59)));
    let (residual, above_one) = (guess - 1.0 - excess - libm::log(guess), guess - 1.0);
    guess - 2.0 * residual * guess * above_one / (2.0 * above_one * above_one - residual)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tier: second method; −W₋₁(−exp(−1 − excess)) by mpmath 1.3 to 40 digits.
    #[test]
    fn roots_are_those_of_another_library() {
        let known = [
            (1e-12, 1.000_001_414_214_229),
            (1e-08, 1.000_141_428_022_982_6),
            (1e-05, 1.004_478_805_104_705),
            (0.001, 1.045_390_495_963_692_6),
            (0.01, 1.148_165_122_379_394_7),
            (0.1, 1.516_221_161_425_022),
            (0.3, 1.986_246_855_970_234),
            (1.0, 3.146_193_220_620_582_5),
            (2.0, 4.505_241_495_792_883),
            (4.0, 6.936_847_407_220_219),
            (7.0, 10.335_593_630_314_841),
            (11.0, 14.686_960_027_117_406),
            (16.0, 19.995_507_629_814_185),
            (25.0, 29.380_325_240_828_377),
            (40.0, 44.802_258_552_263_21),
            (100.0, 105.660_228_554_849_95),
            (400.0, 407.008_834_892_559_7),
            (1000.0, 1_007.915_639_754_409_2),
        ];
        for (excess, exact) in known {
            let condition = exact / (exact - 1.0);
            let error = (larger_root(excess) / exact - 1.0).abs();
            assert!(error <= 2.5e-16 * condition.max(2.0), "{excess:e}: {error:e}");
        }
    }

    /// Tier: invariant; the equation holds, over every order of magnitude, and the root grows.
    #[test]
    fn the_equation_holds_everywhere() {
        let mut before = 1.0;
        for step in -300..=3000 {
            let excess = libm::pow(10.0, f64::from(step) * 0.05);
            let root = larger_root(excess);
            assert!(root > 1.0 && root >= before, "{excess:e}");
            let rounding = 4.0 * f64::EPSILON * (root + excess);
            assert!((root - libm::log(root) - 1.0 - excess).abs() <= rounding, "{excess:e}");
            before = root;
        }
        for excess in [0.0, -1e-3, 1e-300] {
            assert!((larger_root(excess) - 1.0 - libm::sqrt(2.0 * f64::EPSILON)).abs() < 1e-15, "{excess:e}");
        }
    }
}
