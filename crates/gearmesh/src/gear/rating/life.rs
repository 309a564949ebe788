//! Life factors Z_NT (ISO 6336-2:2019, 11, table 2) and Y_NT (ISO 6336-3:2019, 12, table 1).
//!
//! Straight lines over the logarithms of load cycles and factor. Must not know: load.

use super::material::{MaterialClass, Surface};
use declare::Words;

/// Load cycles at which the curves end.
const LONGEST: f64 = 1e10;

/// Whether some pitting may be on a flank that still counts as whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum Pitting {
    /// no pitting
    None,
    /// a limited amount, of steels and hardened gears
    Limited,
}

/// The factor after `cycles`; `long_life` is that at 1e10 cycles and beyond, 0.85 to 1.
fn along(points: &[(f64, f64)], long_life: f64, cycles: f64) -> f64 {
    let mut from = points[0];
    if cycles <= from.0 {
        return from.1;
    }
    for to in points[1..].iter().copied().chain([(LONGEST, long_life)]) {
        if cycles <= to.0 {
            let share = libm::log(cycles / from.0) / libm::log(to.0 / from.0);
            return from.1 * libm::pow(to.1 / from.1, share);
        }
        from = to;
    }
    long_life
}

/// Cycles and Z_NT up to the knee, from where it is 1.
fn contact(class: MaterialClass, pitting: Pitting) -> &'static [(f64, f64)] {
    match (class, class.surface(), pitting) {
        (MaterialClass::NitrocarburizedSteel, ..) => &[(1e5, 1.1), (2e6, 1.0)],
        (MaterialClass::NitridedSteel, ..) | (_, Surface::CastIron, _) => &[(1e5, 1.3), (2e6, 1.0)],
        (.., Pitting::None) => &[(1e5, 1.6), (5e7, 1.0)],
        (.., Pitting::Limited) => &[(6e5, 1.6), (1e7, 1.3), (1e9, 1.0)],
    }
}

/// Cycles and Y_NT up to the knee, from where it is 1.
fn root(class: MaterialClass) -> &'static [(f64, f64)] {
    match (class, class.surface()) {
        (MaterialClass::CaseHardenedSteel | MaterialClass::SurfaceHardenedSteel, _) => &[(1e3, 2.5), (3e6, 1.0)],
        (MaterialClass::NitrocarburizedSteel, _) => &[(1e3, 1.1), (3e6, 1.0)],
        (MaterialClass::NitridedSteel, _) | (_, Surface::CastIron) => &[(1e3, 1.6), (3e6, 1.0)],
        _ => &[(1e4, 2.5), (3e6, 1.0)],
    }
}

/// Z_NT after as many load cycles.
#[must_use]
pub fn contact_factor(class: MaterialClass, pitting: Pitting, long_life: f64, cycles: f64) -> f64 {
    along(contact(class, pitting), long_life, cycles)
}

/// Y_NT after as many load cycles.
#[must_use]
pub fn root_factor(class: MaterialClass, long_life: f64, cycles: f64) -> f64 {
    along(root(class), long_life, cycles)
}

/// Load cycles from which a gear has its long life: below, other factors are not those of long life either.
#[must_use]
pub fn knees(class: MaterialClass, pitting: Pitting) -> [f64; 2] {
    [contact(class, pitting), root(class)].map(|points| points[points.len() - 1].0)
}
