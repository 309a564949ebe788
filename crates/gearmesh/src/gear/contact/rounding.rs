//! Contact near the end of a flank that goes over into a rounding: two parabolas with one tangent, pressed on a half plane.
//!
//! The rounding begins with the tangent of the flank and another curvature, so that a contact near that place lies on both.
//! With half the Hertzian width b of the flank alone as unit, ξ from the junction outwards, λ = c/b how far inside the
//! flanks would touch without load (below 0 beyond the junction) and κ < 1 the combined radius of curvature on the rounding
//! over that on the flank, the flanks stand apart by h = (ξ + λ)² + g max(ξ, 0)², g = 1/κ − 1. For a contact from m − a to
//! m + a, ξ = m + a cos θ, at both ends of which the pressure vanishes (Johnson, Contact Mechanics, 2.7 and 4.2),
//!
//! ∫ h′ dθ = 0, (a/π) ∫ h′ cos θ dθ = 1, Ψ/k₀ = (1/π) ∫ h dθ − ln(a/2), θ from 0 to π.
//!
//! All integrals are elementary in t = −m/a, the cosine of θ at the junction. Must not know: gears, loads.

use std::f64::consts::{LN_2, PI};

use super::wedge::Spread;
use crate::numeric::crossing::bracketed;
use crate::numeric::extremum::maximum;
use crate::numeric::graded::Graded;

/// How well the tables follow; those of slopes from differences.
const ACCURACY: f64 = 1e-12;
const COARSE: f64 = 1e-6;
/// Of those differences.
const STEP: f64 = 1e-5;

/// By how much a flank that ends in a rounding approaches more than one that goes on.
#[derive(Clone, Debug, PartialEq)]
pub struct Rounding {
    /// κ.
    ratio: f64,
    /// λ from which on, outwards, all of the contact lies on the rounding.
    beyond: f64,
    /// Over λ, and its slope.
    more: [Graded; 2],
    /// g of what turns, over λ, and its slope.
    turned: [Graded; 2],
}

/// Places at which the largest pressure is looked for, and how well it is found \[rad\].
const LOOKS: u32 = 24;
const TOP: f64 = 1e-6;

/// A contact of which a part lies on the rounding.
struct Contact {
    /// t.
    junction: f64,
    /// κ.
    ratio: f64,
    /// a.
    half_width: f64,
    /// λ.
    place: f64,
    /// Ψ/k₀ above the least gap, less ln 2 + ½, and its slope over λ.
    more: [f64; 2],
}

impl Contact {
    /// The junction at the cosine t from 1, where the contact ends there, to −1, where it begins.
    fn new(t: f64, ratio: f64) -> Self {
        let g = 1.0 / ratio - 1.0;
        let (angle, sine) = (libm::acos(t), ((1.0 - t) * (1.0 + t)).sqrt());
        // ∫ (cos θ − t), its product with cos θ, and its square, over the rounding.
        let first = sine - t * angle;
        let moment = 0.5 * (angle - t * sine);
        let square = angle * (0.5 + t * t) - 1.5 * t * sine;
        let a = 1.0 / (1.0 + 2.0 * g * moment / PI).sqrt();
        let a_slope = a * a * a * g * sine / PI;
        // (m + λ)/−a.
        let q = g * first / PI;
        let (place, place_slope) = (a * (t - q), a_slope * (t - q) + a * (1.0 + g * angle / PI));
        let bent = q * q + 0.5 + g * square / PI;
        let above = a * a * bent - libm::log(0.5 * a);
        let above_slope = 2.0 * a * a_slope * bent - 2.0 * a * a * q * (g * angle / PI + 1.0) - a_slope / a;
        // Where the flanks would touch on the rounding.
        let beyond = place.min(0.0);
        let least = (1.0 - ratio) * beyond;
        Self {
            junction: t,
            ratio,
            half_width: a,
            place,
            more: [above - least * beyond - LN_2 - 0.5, above_slope / place_slope - 2.0 * least],
        }
    }
}

impl Contact {
    /// The one at λ.
    fn at(place: f64, ratio: f64) -> Self {
        let t = bracketed(-1.0, 1.0, |t| Self::new(t, ratio).place - place);
        Self::new(t.unwrap_or(if place < 0.0 { -1.0 } else { 1.0 }), ratio)
    }

    /// How much farther inside the mean place of the load is than the flanks would touch without load, and its slope over λ:
    /// the mean of cos θ is a² g sin³ θ/(3π) with θ at the junction.
    fn beside(&self) -> [f64; 2] {
        let Self { junction: t, ratio, half_width: a, place, .. } = *self;
        let (g, sine) = (1.0 / ratio - 1.0, ((1.0 - t) * (1.0 + t)).sqrt());
        let angle = libm::acos(t);
        let cube = g * sine * sine * sine / (3.0 * PI);
        let mean = a * t - a * a * a * cube;
        let touch = if place < 0.0 { ratio } else { 1.0 };
        let a_slope = a * a * a * g * sine / PI;
        let q = g * (sine - t * angle) / PI;
        let place_slope = a_slope * (t - q) + a * (1.0 + g * angle / PI);
        let mean_slope = a_slope * (t - 3.0 * a * a * cube) + a + a * a * a * g * t * sine / PI;
        [mean - touch * place, mean_slope / place_slope - touch]
    }

    /// The pressure over Hertz' at the angle θ: a sin θ and the same of the conjugate function of (cos θ − t) on the rounding.
    fn pressure(&self, angle: f64) -> f64 {
        let Self { junction, ratio, half_width, .. } = *self;
        let (end, apart) = (libm::acos(junction), libm::cos(angle) - junction);
        let [sum, difference] = [angle + end, angle - end].map(|turn| libm::sin(0.5 * turn).abs());
        let logarithm = if difference > 0.0 { apart * libm::log(sum / difference) } else { 0.0 };
        let round = (end * libm::sin(angle) + logarithm) / PI;
        half_width * (libm::sin(angle) + (1.0 / ratio - 1.0) * round)
    }

    fn spread(&self) -> Spread {
        let angle = |look: u32| PI * f64::from(look) / f64::from(LOOKS);
        let higher = |a: u32, b: u32| if self.pressure(angle(b)) > self.pressure(angle(a)) { b } else { a };
        let best = (1..LOOKS).reduce(higher).unwrap_or(LOOKS / 2);
        let [lower, guess, upper] = [best - 1, best, best + 1].map(angle);
        let (top, pressure) = maximum(|angle| self.pressure(angle), lower, guess, upper, TOP);
        let place = self.half_width * (libm::cos(top) - self.junction);
        Spread { pressure, half_width: self.half_width, farther: -place - self.place, reaches: false }
    }
}

impl Rounding {
    /// `ratio`: κ, above 0 and at most 1.
    #[must_use]
    pub fn new(ratio: f64) -> Self {
        let beyond = -1.0 / ratio.sqrt();
        let at = |place: f64| Contact::at(place, ratio).more;
        let more = [0, 1].map(|which| {
            let mut graded = Graded::default();
            // The least gap bends where the flanks would touch at the junction; at its ends a contact begins like a root.
            graded.push((beyond, 0.0), [true, false], ACCURACY, |place| at(place)[which]);
            graded.push((0.0, 1.0), [false, true], ACCURACY, |place| at(place)[which]);
            graded
        });
        let g = |place: f64| {
            let [beside, slope] = Contact::at(place, ratio).beside();
            2.5 * beside - 0.5 * place * slope
        };
        // The slope has no bound where the contact just reaches the junction.
        let g_slope = |place: f64| {
            let near = place.clamp(beyond + 2.0 * STEP, 1.0 - 2.0 * STEP);
            (g(near + STEP) - g(near - STEP)) / (2.0 * STEP)
        };
        let functions: [&dyn Fn(f64) -> f64; 2] = [&g, &g_slope];
        let turned = [0, 1].map(|which: usize| {
            let mut graded = Graded::default();
            let accuracy = [ACCURACY, COARSE][which];
            graded.push((beyond, 0.0), [true, false], accuracy, functions[which]);
            graded.push((0.0, 1.0), [false, true], accuracy, functions[which]);
            graded
        });
        Self { ratio, beyond, more, turned }
    }

    /// (Ψ/k₀ above the least gap) − ln 2 − ½, and its slope over λ: 0 inside, −½ ln κ beyond, where it is a contact of
    /// parabolas on the rounding.
    #[must_use]
    pub fn more(&self, place: f64) -> [f64; 2] {
        if place >= 1.0 {
            [0.0; 2]
        } else if place <= self.beyond {
            [-0.5 * libm::log(self.ratio), 0.0]
        } else {
            [self.more[0].value(place), self.more[1].value(place)]
        }
    }

    /// What the normal of the other flank adds to the approach as it turns along the contact, as [`Wedge::turned`] has it;
    /// a rounding has no B. Nothing where all of the contact lies on one side of the junction.
    ///
    /// [`Wedge::turned`]: super::wedge::Wedge::turned
    #[must_use]
    pub fn turned(&self, place: f64) -> [[f64; 2]; 2] {
        if place >= 1.0 || place <= self.beyond {
            return [[0.0; 2]; 2];
        }
        [[self.turned[0].value(place), 0.0], [self.turned[1].value(place), 0.0]]
    }

    /// How it spreads: as on the flank inside, as on the rounding beyond.
    #[must_use]
    pub fn spread(&self, place: f64) -> Spread {
        let Self { ratio, beyond, .. } = *self;
        if place >= 1.0 {
            return Spread { pressure: 1.0, half_width: 1.0, farther: 0.0, reaches: false };
        }
        if place <= beyond {
            let root = ratio.sqrt();
            return Spread { pressure: 1.0 / root, half_width: root, farther: -place * (1.0 - ratio), reaches: false };
        }
        Contact::at(place, ratio).spread()
    }

    /// λ from which on, inwards, none of the contact lies on the rounding.
    #[must_use]
    pub const fn far() -> f64 {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::elimination::solve;

    /// Ψ/k₀ by pressures that are constant on each of many strips; those that would pull are taken away. And between which
    /// places there are any left; the largest, its place, and the mean place.
    fn by_strips(place: f64, ratio: f64, [from, to]: [f64; 2]) -> (f64, [f64; 2], [f64; 3]) {
        const STRIPS: usize = 160;
        let gap = |x: f64| (x + place).powi(2) + (1.0 / ratio - 1.0) * x.max(0.0).powi(2);
        let width = (to - from) / STRIPS as f64;
        let end = |k: usize| from + width * k as f64;
        let moment = |x: f64| x * (libm::log(x.abs()) - 1.0);
        let mut loaded: Vec<usize> = (0..STRIPS).collect();
        loop {
            let size = loaded.len() + 1;
            let mut rows = vec![[0.0; STRIPS + 2]; size];
            for (row, &on) in loaded.iter().enumerate() {
                let x = end(on) + 0.5 * width;
                for (column, &by) in loaded.iter().enumerate() {
                    rows[row][column] = moment(end(by) - x) - moment(end(by + 1) - x);
                }
                (rows[row][size - 1], rows[row][size]) = (-1.0, -gap(x));
            }
            rows[size - 1][..size - 1].fill(width);
            rows[size - 1][size] = 1.0;
            // Unknowns that are not there are zero: their columns move out of the way.
            for row in &mut rows {
                row.swap(size, STRIPS + 1);
            }
            solve(&mut rows);
            let pressed = |k: &usize| rows[*k][STRIPS + 1] >= 0.0;
            if (0..loaded.len()).all(|k| pressed(&k)) {
                let ends = [end(loaded[0]), end(loaded[loaded.len() - 1] + 1)];
                let pressure = |k: usize| rows[k][STRIPS + 1];
                let higher = |a: usize, b: usize| if pressure(b) > pressure(a) { b } else { a };
                let top = (0..loaded.len()).reduce(higher).unwrap();
                let middle = |k: usize| end(loaded[k]) + 0.5 * width;
                let mean = (0..loaded.len()).map(|k| width * pressure(k) * middle(k)).sum();
                return (rows[size - 1][STRIPS + 1], ends, [pressure(top), middle(top), mean]);
            }
            loaded = (0..loaded.len()).filter(pressed).map(|k| loaded[k]).collect();
        }
    }

    /// Tier: second method.
    #[test]
    fn pressures_in_strips_give_the_same() {
        for ratio in [0.03, 0.2, 0.7] {
            let rounding = Rounding::new(ratio);
            for place in [1.5, 0.9, 0.5, 0.1, 0.0, -0.2, -0.6, -1.1, -3.0, -7.0] {
                let least = f64::min(place, 0.0).powi(2) * (1.0 - ratio);
                let (_, coarse, _) = by_strips(place, ratio, [-place.max(0.0) - 1.1, (-place * ratio).max(0.0) + 1.1]);
                let (strips, ends, [top, at, mean]) = by_strips(place, ratio, [coarse[0] - 1e-3, coarse[1] + 1e-3]);
                let strips = strips - least - LN_2 - 0.5;
                let spread = rounding.spread(place);
                let width = 0.5 * (ends[1] - ends[0]);
                assert!(
                    (spread.half_width / width - 1.0).abs() < 0.04,
                    "{ratio} {place}: {spread:?}, by strips {width}"
                );
                let hertz = 2.0 / PI;
                assert!(
                    (spread.pressure * hertz / top - 1.0).abs() < 0.01,
                    "{ratio} {place}: {spread:?}, by strips {top}"
                );
                let [beside, _] = Contact::at(place.max(rounding.beyond), ratio).beside();
                if place > rounding.beyond && place < 1.0 {
                    let touch = if place < 0.0 { ratio * place } else { place };
                    assert!((beside - (-mean - touch)).abs() < 2e-3, "{ratio} {place}: {beside}, by strips {mean}");
                }
                let farther = -at - place;
                assert!(
                    (spread.farther - farther).abs() < 0.05 * width,
                    "{ratio} {place}: {spread:?}, by strips {farther}"
                );
                let [found, _] = rounding.more(place);
                assert!((found - strips).abs() < 1e-3, "{ratio} {place}: {found}, by strips {strips}");
            }
        }
    }

    /// Tier: closed form; one curvature is Hertz', and beyond it is Hertz' with the other curvature: b is √κ as large.
    #[test]
    fn far_on_either_side_it_is_hertz() {
        for place in [-3.0, -0.5, 0.0, 0.4, 2.0] {
            assert!(Rounding::new(1.0).more(place)[0].abs() < 1e-12, "{place}");
        }
        for ratio in [0.03, 0.2, 0.7] {
            let [inside, beyond] = [1.0, -1.0 / f64::sqrt(ratio)].map(|place| Rounding::new(ratio).more(place + 1e-9));
            assert!(inside[0].abs() < 1e-12);
            assert!((beyond[0] + 0.5 * f64::ln(ratio)).abs() < 1e-7, "{ratio}: {beyond:?}");
        }
    }

    /// Tier: invariant; continuous, with the slope of differences, and never less than one curvature alone gives.
    #[test]
    fn slopes_are_those_of_differences() {
        for ratio in [0.03, 0.2, 0.7] {
            let rounding = Rounding::new(ratio);
            for step in -400..=120 {
                let place = 0.02 * f64::from(step) + 1e-3;
                let [low, high] = [-1e-6, 1e-6].map(|change| rounding.more(place + change)[0]);
                let [value, slope] = rounding.more(place);
                assert!(((high - low) / 2e-6 - slope).abs() < 1e-7, "{ratio}: slope at {place}");
                assert!(value >= -1e-12 && value <= -0.5 * f64::ln(ratio) + 1e-12, "{ratio}: {value} at {place}");
            }
        }
    }
}
