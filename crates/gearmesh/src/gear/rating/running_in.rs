//! By how much running in evens out deviations: ISO 6336-1:2019, 7 (y_β), 8 (y_α), 6.5 and table 8 (C_ay).
//!
//! Lengths in m, strengths in Pa. Must not know: where deviations come from.

use super::material::{MaterialClass, Surface};

/// Which deviation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Deviation {
    /// f_pb with y_α, and f_fα with y_f, which goes by the same formulas.
    Transverse,
    /// F_βx with y_β.
    Helix,
}

/// Pitch line velocities \[m/s\] above which a soft gear runs in as if no deviation were larger than the two below.
const VELOCITIES: [f64; 2] = [5.0, 10.0];
const MOST_DEVIATION: [f64; 2] = [80e-6, 40e-6];
const MEGAPASCAL: f64 = 1e6;
const MICROMETRE: f64 = 1e-6;

/// y_α or y_β \[m\] of one gear with σ_Hlim \[Pa\], by a deviation \[m\] and the pitch line velocity \[m/s\].
///
/// A soft gear without a strength runs in by nothing that is known: none.
#[must_use]
pub fn allowance(
    which: Deviation,
    class: MaterialClass,
    strength: Option<f64>,
    deviation: f64,
    velocity: f64,
) -> Option<f64> {
    let of_helix = which == Deviation::Helix;
    let (share, most) = match class.surface() {
        Surface::Soft => (if of_helix { 320.0 } else { 160.0 } * MEGAPASCAL / strength?, None),
        // What 80 µm leave of F_βx is 44 µm; the standard has 45.
        Surface::CastIron if of_helix => (0.55, Some([45.0 * MICROMETRE, 22.0 * MICROMETRE])),
        Surface::CastIron => (0.275, Some([22.0 * MICROMETRE, 11.0 * MICROMETRE])),
        Surface::Hard if of_helix => return Some((0.15 * deviation).min(6.0 * MICROMETRE)),
        Surface::Hard => return Some((0.075 * deviation).min(3.0 * MICROMETRE)),
    };
    let [middle, fast] = most.unwrap_or(MOST_DEVIATION.map(|deviation| share * deviation));
    let allowed = if velocity <= VELOCITIES[0] {
        f64::INFINITY
    } else if velocity <= VELOCITIES[1] {
        middle
    } else {
        fast
    };
    Some((share * deviation).min(allowed).min(deviation))
}

/// The mean of both gears, as for unlike materials.
#[must_use]
pub fn mean(which: Deviation, gears: [(MaterialClass, Option<f64>); 2], deviation: f64, velocity: f64) -> Option<f64> {
    let [one, two] = gears.map(|(class, strength)| allowance(which, class, strength, deviation, velocity));
    Some(0.5 * (one? + two?))
}

/// C_ay \[m\]: tip relief by running in, by σ_Hlim \[Pa\].
#[must_use]
pub fn tip_relief(strength: f64) -> f64 {
    let off = strength / MEGAPASCAL / 97.0 - 18.45;
    (off * off / 18.0 + 1.5) * MICROMETRE
}
