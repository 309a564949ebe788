//! Student's distribution against tables and closed forms.

use super::*;

/// Tier: published value; percentage points of Student's distribution, Abramowitz and Stegun, table 26.10, two-sided 0.95 and
/// 0.99.
#[test]
fn intervals_are_those_of_the_table() {
    let rows = [
        (1, 12.706, 63.657),
        (2, 4.303, 9.925),
        (3, 3.182, 5.841),
        (7, 2.365, 3.499),
        (10, 2.228, 3.169),
        (30, 2.042, 2.750),
        (120, 1.980, 2.617),
    ];
    for (freedom, at_95, at_99) in rows {
        assert!((half_width(0.95, Some(freedom)) - at_95).abs() <= 0.000_5, "{freedom}");
        assert!((half_width(0.99, Some(freedom)) - at_99).abs() <= 0.000_5, "{freedom}");
    }
    assert!((half_width(0.95, None) - 1.959_963_984_540_054).abs() < 1e-12);
    assert!(half_width(0.95, Some(0)).is_infinite());
}

/// Tier: closed form; with one degree of freedom (2/π) atan t, with two t/√(2 + t²).
#[test]
fn the_first_two_are_elementary() {
    for t in [0.0, 0.3, 1.0, 4.0, 250.0] {
        assert!((within(t, 1) - FRAC_2_PI * libm::atan(t)).abs() < 1e-15);
        assert!((within(t, 2) - t / (2.0 + t * t).sqrt()).abs() < 1e-15);
    }
}
