//! Relations that hold in closed form for constant, or plainly varying, stiffness.

use super::*;

/// Harris' relations for constant pair stiffness k: no relief F/2k, long linear relief |F/k − C|/2, short F/2k.
#[test]
fn harris_relations_hold() {
    for ratio in [1.1, 1.35, 1.645_626_2, 1.9] {
        let pair = pair_with_contact_ratio(ratio);
        let cycle = cycle(&pair, &constant(&pair, STIFFNESS));
        for force in [1e-6, 10.0, 700.0, 1867.0, 2800.0, 40_000.0] {
            let run = |design: &Design| Loading::new(&cycle, design, torque(force)).summary(Wanted::default());
            close(run(&Design::default()).peak_to_peak, 0.5 * force / STIFFNESS, 1e-11);
            let amount = 7e-6;
            let long = run(&relief(&pair, amount, 1.0));
            let exact = 0.5 * (force / STIFFNESS - amount).abs();
            assert!(
                (long.peak_to_peak - exact).abs() < 1e-9 * (force / STIFFNESS + amount),
                "long, {force} N, {ratio}"
            );
            close(long.unloaded_peak_to_peak, 0.5 * amount, 1e-9);
            if ratio < 1.9 {
                let short = run(&relief(&pair, amount, 0.5));
                // Of a path position against the length of the relief.
                let rounding = 2e-14 * amount;
                let error = (short.peak_to_peak - 0.5 * force / STIFFNESS).abs();
                assert!(error < 1e-9 * (force / STIFFNESS) + rounding, "short, {force} N, {ratio}");
                assert!(short.unloaded_peak_to_peak < rounding);
            }
        }
    }
}

/// Two levels, F/2k for a share ε − 1 of the cycle and F/k for the rest: mean, variance and harmonics in closed form.
#[test]
fn moments_and_harmonics_of_unmodified_gears_are_those_of_a_rectangular_wave() {
    let pair = pair();
    let cycle = cycle(&pair, &constant(&pair, STIFFNESS));
    let (force, share) = (1867.0, pair.contact_ratio - 1.0);
    let design = Design::default();
    let summary = Loading::new(&cycle, &design, torque(force)).summary(Wanted { harmonics: 8, pressure: false });
    let (low, high) = (0.5 * force / STIFFNESS, force / STIFFNESS);
    close(summary.mean, low * share + high * (1.0 - share), 1e-13);
    close(summary.variance, (high - low) * (high - low) * share * (1.0 - share), 1e-12);
    close(summary.reciprocal_variance.unwrap() * summary.variance, 1.0, 1e-15);
    for (index, amplitude) in summary.harmonics.iter().enumerate() {
        let angle = std::f64::consts::PI * (index + 1) as f64;
        close(*amplitude, 2.0 * (high - low) * libm::sin(angle * share).abs() / angle, 1e-8);
    }
    close(summary.loaded_contact_ratio, pair.contact_ratio, 1e-12);
    close(summary.largest_load_share, 1.0, 1e-13);
    assert_eq!(summary.unloaded_peak_to_peak, 0.0);
}

#[test]
fn every_contact_ratio_gives_its_levels() {
    for (ratio, fewest, most) in
        [(1.0, 1.0, 1.0), (1.0001, 1.0, 2.0), (2.0, 2.0, 2.0), (2.5, 2.0, 3.0), (3.2, 3.0, 4.0), (3.0, 3.0, 3.0)]
    {
        let pair = pair_with_contact_ratio(ratio);
        let cycle = cycle(&pair, &constant(&pair, STIFFNESS));
        let force = 1000.0;
        let design = Design::default();
        let summary = Loading::new(&cycle, &design, torque(force)).summary(Wanted::default());
        let exact = force / STIFFNESS * (1.0 / fewest - 1.0 / most);
        assert!((summary.peak_to_peak - exact).abs() < 1e-12 * force / STIFFNESS, "{ratio}");
        let (_, stiffness) = stiffness(&cycle, 10.0);
        close(stiffness.fewest.least, fewest * STIFFNESS, 1e-12);
        assert_eq!(stiffness.most.is_some(), fewest < most);
        close(stiffness.most.map_or(most * STIFFNESS, |zone| zone.most), most * STIFFNESS, 1e-12);
        close(stiffness.mean, ratio * STIFFNESS, 1e-9);
    }
    for ratio in [0.999, 6.001, f64::NAN] {
        let pair = pair_with_contact_ratio(ratio);
        let message = MeshCycle::new(&pair, &varying(), Settings::default()).unwrap_err().to_string();
        assert!(message.contains("contact ratio"), "{message}");
    }
}

/// Stiffness of varying teeth against a fine grid of the sum of reciprocals, with one-sided ends.
#[test]
fn stiffness_of_varying_teeth_is_the_sum_over_pairs() {
    let pair = pair();
    let compliance = varying();
    let (points, summary) = stiffness(&cycle(&pair, &compliance), 50.0);
    let single = |s: f64| {
        let contact = 4.0 * 0.91 / (std::f64::consts::PI * 206e9 * 18e-3);
        let (u1, u2) = (s / pair.pinion.base_radius, (pair.tangent_length - s) / pair.gear.base_radius);
        1.0 / (compliance.pinion.total(u1) + compliance.gear.total(u2) + contact)
    };
    for point in &points {
        let s = point.path_position;
        let exact = if point.pairs == 2 { single(s) + single(s + BASE_PITCH) } else { single(s) };
        close(point.secant_stiffness, exact, 1e-12);
        close(point.tangent_stiffness, exact, 1e-12);
    }
    let shared = pair.end_of_contact - BASE_PITCH - pair.start_of_contact;
    let grid = |from: f64, to: f64| (0..=20_000).map(move |i| from + (to - from) * f64::from(i) / 20_000.0);
    let a = pair.start_of_contact;
    let singles: Vec<f64> = grid(a + shared, a + BASE_PITCH).map(single).collect();
    let doubles: Vec<f64> = grid(a, a + shared).map(|s| single(s) + single(s + BASE_PITCH)).collect();
    let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    let smallest = |values: &[f64]| values.iter().copied().fold(f64::INFINITY, f64::min);
    let double = summary.most.unwrap();
    close(summary.fewest.most, largest(&singles), 1e-8);
    close(summary.fewest.least, smallest(&singles), 1e-8);
    close(double.most, largest(&doubles), 1e-8);
    close(double.least, smallest(&doubles), 1e-8);
}
