//! Noise of a known width, and derivatives of what has it.

use super::super::Answers;
use super::*;

/// Numbers of which nothing but their spread is known: a linear congruential generator (Knuth's MMIX).
fn scattered(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
}

/// Tier: closed form; the standard deviation of uniform noise is its width over √12. Seven points tell it within a factor.
#[test]
fn noise_is_told_from_what_is_smooth() {
    let mut state = 1;
    for width in [1e-12, 1e-9, 1e-7] {
        let mut all: Vec<f64> = Vec::new();
        for _ in 0..40 {
            let values: Vec<f64> =
                (0..POINTS).map(|at| libm::sin(1.0 + APART * at as f64) + width * scattered(&mut state)).collect();
            all.extend(noise_in(values));
        }
        assert!(all.len() > 20, "{}", all.len());
        let wanted = width / 12.0_f64.sqrt();
        let mean = all.iter().sum::<f64>() / all.len() as f64;
        assert!(mean > 0.5 * wanted && mean < 2.0 * wanted, "{mean:e} for {wanted:e}");
    }
    // Of what has none, nothing is made up.
    let exact: Vec<f64> = (0..POINTS).map(|at| 1.0 + at as f64).collect();
    assert!(noise_in(exact).unwrap_or(0.0) < 1e-15);
}

/// Tier: closed form; the derivative of a sine with noise is right to about ε^(2/3), which a step for exact numbers is not, and
/// beside a bound too.
#[test]
fn steps_are_as_long_as_the_noise_asks_for() {
    let width = 1e-8;
    let mut state = 7;
    let mut model = |points: &[Vec<f64>]| -> Result<Answers, ()> {
        Ok(points.iter().map(|point| Some(vec![libm::sin(point[0]) + width * scattered(&mut state)])).collect())
    };
    for at in [1.0, 0.2, 1.5] {
        let residuals = model(&[vec![at]]).unwrap().pop().flatten().unwrap();
        let mut steps = Steps::new(&[(0.2, 1.5)], noise(&[(0.2, 1.5)], &[at], &mut model).unwrap().unwrap());
        let found = steps.jacobian(&[at], &residuals, &mut model).unwrap();
        let off = (found[0][0] - libm::cos(at)).abs();
        assert!(off < 3e-5, "{off:e} at {at}, step {:e}", steps.shares[0]);
        assert!(steps.shares[0] > 3e-4, "{:e}", steps.shares[0]);
    }
}

/// A point without residuals leaves the difference to the other side; between two of them there is none.
#[test]
fn a_hole_beside_the_point_is_gone_round() {
    let middle = [1.0];
    assert_eq!(column(&middle, &[None, Some(vec![0.8])], &[0.1, -0.1]), [(0.8 - 1.0) / -0.1]);
    assert_eq!(column(&middle, &[Some(vec![1.3]), None], &[0.1, -0.1]), [(1.3 - 1.0) / 0.1]);
    assert_eq!(column(&middle, &[None, None], &[0.1, -0.1]), [0.0]);
}
