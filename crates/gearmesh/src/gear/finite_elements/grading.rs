//! Sizes of elements that grow with the distance from a boundary: across a tooth, and down the body.
//!
//! Must not know: outlines, nodes.

/// Depth of the body's elements over the radius, near a small bore.
const PROPORTION: f64 = 3.2;

/// Places across a tooth from 0 to 1, corners and middles alternating: the width of an element is `first` at the flanks, grows
/// with the distance from them, and is at most `largest`; each is cut into `parts`.
pub(super) fn across(first: f64, growth: f64, largest: f64, parts: usize) -> Vec<f64> {
    let first = first.min(largest);
    // Where the elements are as large as in the middle.
    let turn = ((largest - first) / growth).min(0.5);
    let near = libm::log1p(growth * turn / first) / growth;
    let total = near + (0.5 - turn) / (first + growth * turn);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a few dozen
    let count = parts * libm::round(total).max(1.0) as usize;
    let corner = |k: usize| {
        let weight = total * k as f64 / count as f64;
        if k == count {
            0.5
        } else if weight <= near {
            libm::expm1(growth * weight) * first / growth
        } else {
            turn + (weight - near) * (first + growth * turn)
        }
    };
    let mut half = Vec::new();
    for k in 0..count {
        half.extend([corner(k), 0.5 * (corner(k) + corner(k + 1))]);
    }
    let mirrored: Vec<f64> = half.iter().rev().map(|place| 1.0 - place).collect();
    half.push(0.5);
    half.extend(mirrored);
    half
}

/// Rows of the body as fractions of the way from the bore to the rim, corners and middles alternating: the depth of an
/// element is `rim` at the rim, grows with the distance from it, and is at most in proportion to the radius; each is cut into
/// `parts`.
pub(super) fn depths(bore: f64, outer: f64, [rim, growth]: [f64; 2], level: f64, parts: usize) -> Vec<f64> {
    let proportion = PROPORTION / level;
    let depth = outer - bore;
    // Where the two sizes are equal.
    let turn = ((proportion * outer - rim) / (growth + proportion)).clamp(0.0, depth);
    let near = libm::log1p(growth * turn / rim) / growth;
    let far = libm::log((outer - turn) / bore) / proportion;
    let total = near + far;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a few dozen
    let count = parts * libm::round(total).max(2.0) as usize;
    let place = |k: usize| {
        if k == 0 {
            return 0.0;
        }
        let weight = total * (1.0 - k as f64 / count as f64);
        let below = if weight <= near {
            libm::expm1(growth * weight) * rim / growth
        } else {
            outer - (outer - turn) * libm::exp(-proportion * (weight - near))
        };
        1.0 - below / depth
    };
    let mut fractions = Vec::new();
    for k in 0..count {
        fractions.extend([place(k), 0.5 * (place(k) + place(k + 1))]);
    }
    fractions.push(1.0);
    fractions
}
