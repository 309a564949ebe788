//! Against what the opening is by its definition, and against closed forms.

use super::*;

fn knots(count: u32, end: f64) -> Vec<f64> {
    (0..=count).map(|at| end * f64::from(at) / f64::from(count)).collect()
}

/// Tier: second method; at each place the highest of all parabolas that lie below the spline, by their definition: a parabola that bends
/// back by b lies below f if its apex at c is no higher than the least of f(x) + b (x − c)²/2.
#[test]
fn a_bridged_spline_is_the_upper_envelope_of_the_parabolas_below_it() {
    let knots = knots(150, 3.0);
    let wave = |x: f64| 0.3 * libm::sin(9.0 * x) + 0.2 * libm::cos(17.0 * x * (1.0 + 0.1 * x)) + 0.4 * x * x;
    let values: Vec<f64> = knots.iter().map(|x| wave(*x)).collect();
    let spline = Spline::new(&knots, &values);
    let bend = 2.5;
    let bridged = spline.bridged([0.0, 3.0], &[bend; 7], 0.1);
    let fine: Vec<(f64, f64)> = (0..=6000).map(|at| 5e-4 * f64::from(at)).map(|x| (x, spline.value(x))).collect();
    // The lines of all points are straight in the place of the apex: the highest of the lowest is found by shares of the golden section.
    let height = |x: f64, apex: f64| {
        let over = |(y, f): &(f64, f64)| f + 0.5 * bend * (y - x) * (y + x - 2.0 * apex);
        fine.iter().map(over).fold(f64::INFINITY, f64::min)
    };
    let (mut worst, mut lowered) = (0.0_f64, 0);
    for at in 0..=40 {
        let x = 0.075 * f64::from(at);
        let (mut from, mut to) = (-10.0, 10.0);
        for _ in 0..35 {
            let [one, other] = [0.381_966, 0.618_034].map(|share| from + share * (to - from));
            if height(x, one) < height(x, other) { from = one } else { to = other }
        }
        let exact = height(x, 0.5 * (from + to));
        worst = worst.max((bridged.value(x) - exact).abs());
        lowered += usize::from(spline.value(x) - exact > 1e-3);
    }
    assert!(worst < 4e-6 && lowered > 30, "{worst:e}, {lowered}");
    assert!(bridged.least_bend() >= -bend * (1.0 + 1e-5), "{}", bridged.least_bend());
    for knot in bridged.knots().iter().filter(|knot| **knot > 0.0 && **knot < 3.0) {
        let [before, after] = [knot - 1e-9, knot + 1e-9].map(|x| bridged.rates(x));
        assert!((before[0] - after[0]).abs() < 1e-7 && (before[1] - after[1]).abs() < 1e-5, "{knot}");
    }
}

/// Tier: closed form; over the valley of sin between its crests at both sides the bridge of no bend is straight and touches where sin is
/// least, also where no knot is.
#[test]
fn the_bridge_between_two_crests_touches_them_between_knots() {
    let knots = knots(64, 4.0 * std::f64::consts::PI);
    let values: Vec<f64> = knots.iter().map(|x| libm::sin(x + 0.07)).collect();
    let spline = Spline::new(&knots, &values);
    let bridged = spline.bridged([0.0, knots[64]], &[0.0; 3], 1.0);
    for at in 0..=20 {
        let x = 1.5 * std::f64::consts::PI - 0.07 + 2.0 * std::f64::consts::PI * f64::from(at) / 20.0;
        assert!((bridged.value(x) + 1.0).abs() < 2e-4, "{x}: {}", bridged.value(x));
    }
    assert!((bridged.value(0.5) - spline.value(0.5)).abs() > 0.1, "the crest before is bridged from the end");
}

/// Tier: invariant; what bends back no more than is allowed stays as it is, to the last bit where nothing is cut.
#[test]
fn what_bends_less_stays_as_it_is() {
    let knots = knots(40, 2.0);
    let values: Vec<f64> = knots.iter().map(|x| libm::sin(3.0 * x)).collect();
    let spline = Spline::new(&knots, &values);
    let bridged = spline.bridged([0.0, 2.0], &[9.5; 4], 1.0);
    for at in 0..=200 {
        let x = 0.01 * f64::from(at);
        assert!((bridged.value(x) - spline.value(x)).abs() < 1e-15, "{x}");
    }
    assert!((bridged.least_bend() - spline.least_bend()).abs() < 1e-12);
}
