//! Extrema are met whatever the number of positions: against finer cycles and a brute grid.

use super::*;

#[test]
fn peak_to_peak_does_not_depend_on_the_number_of_positions() {
    let pair = pair();
    let logarithmic = PairCompliance { contact: ContactLaw::LoadDependent, ..varying() };
    let power =
        [("amount", Quantity(9e-6)), ("length", Quantity(4e-3)), ("curve", Choice("power")), ("exponent", Number(2.5))];
    let root = [("amount", Quantity(5e-6)), ("fraction", Number(0.7))];
    let mixed = design(
        &pair,
        &[
            ("tip_relief", "pinion", &power),
            ("root_relief", "pinion", &root),
            ("profile_crowning", "gear", &[("amount", Quantity(4e-6))]),
            ("profile_slope", "pinion", &[("amount", Quantity(-3e-6))]),
            ("lead_crowning", "gear", &[("amount", Quantity(3e-6))]),
        ],
    )
    .unwrap();
    let designs = [
        Design::default(),
        ga_design(&pair, 6.93e-6, 3.41e-3, 5.67e-6),
        ga_design(&pair, 7.81e-6, 5.05e-3, 6.34e-6),
        ga_design(&pair, 20e-6, 5.9e-3, 0.0),
        ga_design(&pair, 3e-6, 8.0e-3, 20e-6),
        mixed,
    ];
    for (which, compliance) in [varying(), coupled(), logarithmic].iter().enumerate() {
        let run = |positions: usize, design: &Design, torque: f64| {
            let cycle = MeshCycle::new(&pair, compliance, Settings { positions, slices: 9 }).unwrap();
            Loading::new(&cycle, design, torque).peak_to_peak()
        };
        for (index, design) in designs.iter().enumerate() {
            for torque in [1.0, 10.0, 25.0, 50.0, 100.0, 700.0] {
                let fine = run(1000, design, torque);
                for positions in [16, 64] {
                    let coarse = run(positions, design, torque);
                    // Slices of a partly loaded face come and go at kinks of their own.
                    let bound = if which == 2 && index > 0 { 1e-4 } else { 1e-9 };
                    assert!(
                        (coarse / fine - 1.0).abs() < bound,
                        "{which} {index} {torque} N m, {positions}: {coarse:e} {fine:e} {:e}",
                        coarse / fine - 1.0
                    );
                }
            }
        }
    }
}

/// Brute force: a fine uniform grid with the zones told apart by comparison.
#[test]
fn peak_to_peak_agrees_with_a_brute_grid() {
    let pair = pair();
    let compliance = varying();
    let cycle = cycle(&pair, &compliance);
    let contact = 4.0 * 0.91 / (std::f64::consts::PI * 206e9 * 18e-3);
    for (amount, length) in [(6.93e-6, 3.41e-3), (12e-6, 5.5e-3)] {
        let design = ga_design(&pair, amount, length, 0.0);
        let force = 50.0 / pair.pinion.base_radius;
        let (mut low, mut high, mut sum) = (f64::INFINITY, 0.0_f64, 0.0);
        let count = 100_000;
        for i in 0..count {
            let tau = BASE_PITCH * (f64::from(i) + 0.5) / f64::from(count);
            let mut pairs = Vec::new();
            for s in [tau + pair.start_of_contact, tau + pair.start_of_contact + BASE_PITCH] {
                if s < pair.end_of_contact {
                    let (u1, u2) = (s / pair.pinion.base_radius, (pair.tangent_length - s) / pair.gear.base_radius);
                    let relief = |from_tip: f64| {
                        let t = (1.0 - from_tip / length).max(0.0);
                        amount * (0.44 * t + 0.56 * t * t)
                    };
                    let gap = relief(pair.end_of_contact - s) + relief(s - pair.start_of_contact);
                    pairs.push((gap, 1.0 / (compliance.pinion.total(u1) + compliance.gear.total(u2) + contact)));
                }
            }
            // Bisection on the load balance.
            let (mut a, mut b) = (0.0, 1e-3);
            for _ in 0..60 {
                let middle = 0.5 * (a + b);
                let load: f64 = pairs.iter().map(|(gap, k)| k * f64::max(middle - gap, 0.0)).sum();
                if load < force { a = middle } else { b = middle }
            }
            (low, high, sum) = (low.min(b), high.max(b), sum + b);
        }
        let summary = Loading::new(&cycle, &design, 50.0).summary(Wanted::default());
        close(summary.peak_to_peak, high - low, 3e-4);
        assert!(summary.peak_to_peak >= (high - low) * (1.0 - 1e-9), "a grid cannot see more than everything");
        close(summary.mean, sum / f64::from(count), 1e-9);
    }
}
