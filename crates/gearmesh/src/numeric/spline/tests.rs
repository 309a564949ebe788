//! Splines against SciPy's, closed forms and each other.

use super::*;

const KNOTS: [f64; 7] = [0.0, 0.1, 0.35, 0.4, 0.9, 1.0, 1.7];
const VALUES: [f64; 7] = [1.0, -0.3, 0.8, 0.2, 0.5, 2.0, -1.0];

/// Tier: second method; values and both derivatives of `scipy.interpolate.CubicSpline` (1.17) through the same points.
#[test]
fn splines_are_those_of_scipy() {
    let rows = [
        (0.05, [0.009_597_986_096_912_758, -12.279_612_334_608_757, 272.321_611_122_469_73]),
        (0.2, [0.258_750_912_755_206_23, 9.118_162_368_198_144, 12.982_051_581_622_216]),
        (0.37, [0.591_169_151_794_842, -12.091_058_430_937_28, -124.248_649_122_294_61]),
        (0.6, [-1.269_763_851_973_010_8, -1.795_784_531_354_970_7, 53.838_201_361_100_54]),
        (0.95, [1.211_895_117_124_747_2, 15.131_163_653_357_48, 30.483_906_300_201_568]),
        (1.3, [6.125_485_001_606_447, 6.519_473_814_878_623, -79.693_562_520_080_6]),
        (1.69, [-0.504_814_341_647_925_6, -48.501_005_578_759_774, -202.462_742_062_680_46]),
    ];
    let spline = Spline::new(&KNOTS, &VALUES);
    for (x, exact) in rows {
        for (found, exact) in spline.rates(x).into_iter().zip(exact) {
            assert!((found - exact).abs() <= 1e-12 * exact.abs().max(1.0), "{x}: {found} is not {exact}");
        }
        assert!((spline.value(x) - spline.rates(x)[0]).abs() < 1e-15);
    }
}

/// Tier: closed form; cubics come back, of two points lines, of three parabolas.
#[test]
fn cubics_are_followed_exactly() {
    let cubic = |degree: usize, x: f64| [1.0, x, x * x, x * x * x][..=degree].iter().sum::<f64>();
    for (count, degree) in [(2, 1), (3, 2), (4, 3), (5, 3), (7, 3)] {
        let values: Vec<f64> = KNOTS[..count].iter().map(|x| cubic(degree, *x)).collect();
        let spline = Spline::new(&KNOTS[..count], &values);
        for x in [-0.1, 0.02, 0.1, 0.2, 0.38, 0.5, 2.0] {
            assert!((spline.value(x) - cubic(degree, x)).abs() < 1e-12, "{count} points at {x}");
        }
    }
}

/// Tier: order of convergence, the fourth, up to both ends.
#[test]
fn twice_the_points_are_sixteen_times_as_good() {
    let off = |count: u32| {
        let knots: Vec<f64> = (0..=count).map(|at| 3.0 * f64::from(at) / f64::from(count)).collect();
        let values: Vec<f64> = knots.iter().map(|x| libm::sin(*x)).collect();
        let spline = Spline::new(&knots, &values);
        (0..=1000).map(|at| 3e-3 * f64::from(at)).map(|x| (spline.value(x) - libm::sin(x)).abs()).fold(0.0, f64::max)
    };
    for count in [20, 40, 80] {
        let order = libm::log2(off(count) / off(2 * count));
        assert!((order - 4.0).abs() < 0.5, "{count}: {order}");
    }
}

/// Tier: second method; with its own slopes, cubics between known values and slopes are the spline.
#[test]
fn cubics_of_values_and_slopes_are_the_spline() {
    let (spline, hermite) = (Spline::new(&KNOTS, &VALUES), Hermite::new(&KNOTS));
    let slopes = spline.slopes();
    for at in 0..=340 {
        let x = 5e-3 * f64::from(at);
        let (at, [a, b, c, d]) = hermite.weights(x);
        let value = a * VALUES[at] + b * VALUES[at + 1] + c * slopes[at] + d * slopes[at + 1];
        assert!((value - spline.value(x)).abs() < 1e-13, "{x}");
        let (at, rates) = hermite.rates(x);
        for (weights, exact) in rates.into_iter().zip(spline.rates(x)) {
            let ends = [VALUES[at], VALUES[at + 1], slopes[at], slopes[at + 1]];
            let found: f64 = weights.iter().zip(ends).map(|(weight, value)| weight * value).sum();
            assert!((found - exact).abs() < 1e-11 * exact.abs().max(1.0), "{x}: {found} {exact}");
        }
    }
    assert_eq!(hermite.weights(-1.0), (0, [1.0, 0.0, 0.0, 0.0]));
    assert_eq!(hermite.weights(9.0), (5, [0.0, 1.0, 0.0, 0.0]));
    assert_eq!(hermite.knots(), KNOTS);
}
