//! Student's distribution: the interval about 0 in which a share lies.
//!
//! For whole degrees of freedom the share is a finite sum (Abramowitz and Stegun, Handbook of Mathematical Functions, 26.7.3
//! and 26.7.4). Must not know: what is distributed.

use std::f64::consts::FRAC_2_PI;

use super::normal;

/// More degrees of freedom than that are as good as infinitely many: the interval differs by 1/(4·freedom) of itself at most.
const MANY: usize = 100_000;

/// The share of Student's distribution that lies in ±t, t ≥ 0, with this many degrees of freedom, from 1.
#[must_use]
pub fn within(t: f64, freedom: usize) -> f64 {
    let root = (freedom as f64).sqrt();
    let angle = libm::atan2(t, root);
    let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
    let square = cosine * cosine;
    let odd = freedom % 2 == 1;
    // Terms c, 2/3 c³, 2·4/(3·5) c⁵, … of the odd and 1, 1/2 c², 1·3/(2·4) c⁴, … of the even.
    let (mut term, mut sum) = (if odd { cosine } else { 1.0 }, 0.0);
    let mut power = usize::from(odd);
    while power + 2 <= freedom {
        sum += term;
        term *= square * (power + 1) as f64 / (power + 2) as f64;
        power += 2;
    }
    if odd { FRAC_2_PI * (angle + sine * sum) } else { sine * sum }
}

/// The t for which this share, of 0 to 1 (excluded), lies in ±t; none of infinitely many degrees of freedom.
#[must_use]
pub fn half_width(share: f64, freedom: Option<usize>) -> f64 {
    let of_normal = normal::quantile(0.5 + 0.5 * share);
    let Some(freedom) = freedom.filter(|freedom| *freedom < MANY) else { return of_normal };
    if freedom == 0 {
        return f64::INFINITY;
    }
    let (mut low, mut high) = (0.0, of_normal);
    while within(high, freedom) < share {
        (low, high) = (high, 2.0 * high);
    }
    for _ in 0..80 {
        let middle = f64::midpoint(low, high);
        if within(middle, freedom) < share { low = middle } else { high = middle }
    }
    f64::midpoint(low, high)
}

#[cfg(test)]
mod tests;
