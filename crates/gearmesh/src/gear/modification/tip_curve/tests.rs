//! Conics in two frames.

use super::*;

/// Tier: invariant; a conic has the same value at a place, whichever frame that is given in.
#[test]
fn a_conic_seen_from_another_frame_is_the_same() {
    let value = |of: &Conic, [x, y]: [f64; 2]| {
        let Conic { xx, xy, yy, .. } = *of;
        xx * x * x + 2.0 * xy * x * y + yy * y * y + 2.0 * (of.x * x + of.y * y) + of.constant
    };
    let conic = Conic { xx: 0.7, xy: -0.4, yy: 1.3, x: 0.2, y: -0.9, constant: 0.5 };
    let ([a, b], t) = ([0.3, -0.8], 0.6_f64);
    let (s, c) = t.sin_cos();
    let seen = conic.seen_from([a, b], t);
    for [x, y] in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [-0.6, 0.9], [2.0, -1.5], [0.4, 0.4]] {
        let there = value(&conic, [a + x * c + y * s, b + x * s - y * c]);
        assert!((value(&seen, [x, y]) - there).abs() < 1e-14, "at {x}, {y}");
    }
}
