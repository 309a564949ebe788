//! Flanks beside a contact that do not stand apart as a parabola does: by how much that changes the approach, and whether they
//! touch at a second place.
//!
//! Laws of contact have the least gap and one radius of curvature. To first order another gap changes the approach by its mean
//! with the weights of a flat punch, 1/√(1 − ξ²); where that is not small, or where the flanks stand nearer beside the contact
//! than its load lets them ([`closing`]), both are pressed together strip by strip, as they are and as a parabola. Lengths
//! along the flanks in half widths b of the law's contact, gaps in k₀ p = b²/2ρ. Must not know: gears.

use std::f64::consts::PI;

use super::patch::{closing, pressed};

/// Places that are looked at to either side.
const PLACES: i32 = 12;
/// Steps of a search for the least gap between two of them.
const STEPS: usize = 8;
/// Halvings of a strip towards where a flank ends.
const HALVINGS: usize = 30;
/// Places in the contact, by the weights of a flat punch.
const POINTS: usize = 12;
/// A change below this is what first order says it is: an approach is some ten times k₀ p.
const SMALL: f64 = 1e-2;
/// How far to either side strips reach at least.
const BESIDE: f64 = 2.0;
/// The narrowest strips, and the most.
const SPACING: f64 = 0.1;
const STRIPS: f64 = 100.0;
/// From how far off on a touch is another one.
const APART: f64 = 1.5;

/// What comes of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Uneven {
    /// By how much the approach of a law is off, in k₀ p.
    pub change: f64,
    /// How far from the contact the flanks touch too; 0 where they do not.
    pub apart: f64,
}

impl Uneven {
    /// Of flanks with this `gap` beside a place, no farther than `reach`. None beyond a tip, which laws of contact know;
    /// without bound beyond a base circle, of which they know nothing.
    #[must_use]
    pub fn of(gap: impl Fn(f64) -> Option<f64>, reach: f64) -> Self {
        Self::below(gap, reach, SMALL)
    }

    /// The same to first order, which may be more, and is hardly less.
    #[must_use]
    pub fn quick(gap: impl Fn(f64) -> Option<f64>, reach: f64) -> Self {
        Self::below(gap, reach, f64::INFINITY)
    }

    /// To first order where that is below `small`.
    fn below(gap: impl Fn(f64) -> Option<f64>, reach: f64, small: f64) -> Self {
        let height = |place: f64| gap(place).unwrap_or(f64::INFINITY);
        let step = reach / f64::from(PLACES);
        let scanned: Vec<(f64, f64)> =
            (-PLACES..=PLACES).map(|place| f64::from(place) * step).map(|place| (place, height(place))).collect();
        let Some(&least) = scanned.iter().min_by(|one, two| one.1.total_cmp(&two.1)) else { return Self::default() };
        let (centre, floor) = lowest(&height, [least.0 - step, least.0 + step], least);
        if !floor.is_finite() {
            return Self::default();
        }
        let (mut sum, mut count) = (0.0, 0.0);
        for point in 0..POINTS {
            let place = libm::cos(PI * (point as f64 + 0.5) / POINTS as f64);
            if let Some(here) = gap(centre + place) {
                sum += here - floor - place * place;
                count += 1.0;
            }
        }
        let first: f64 = if count > 0.0 { f64::abs(sum / count) } else { 0.0 };
        // Where they stand nearer than the contact lets them, and by how much.
        let near = |&(place, height): &(f64, f64)| (place - centre, closing(place - centre) - (height - floor));
        let others = scanned.iter().map(near).filter(|(place, nearer)| place.abs() > 1.0 && *nearer > 0.0);
        let (mut ends, mut most, mut apart) = ([-BESIDE, BESIDE], 0.0_f64, (0.0, 0.0));
        for (place, nearer) in others {
            ends = [ends[0].min(place - 1.0), ends[1].max(place + 1.0)];
            most = most.max(nearer);
            if place.abs() > APART && nearer > apart.1 {
                apart = (place.abs(), nearer);
            }
        }
        if first + most < small {
            return Self { change: first + most, apart: 0.0 };
        }
        let spacing = SPACING.max((ends[1] - ends[0]) / STRIPS);
        // A strip lies in the middle of the contact.
        #[allow(clippy::cast_possible_truncation)] // no more than STRIPS
        let [from, to] = ends.map(|end| libm::round(end / spacing) as i64);
        let even: Vec<f64> = (from..=to).map(|place| place as f64 * spacing).collect();
        // ... unless a flank ends, as it does at a base circle: then two of them meet there.
        let shift = end(|place| gap(centre + place).is_none_or(f64::is_finite), &even).map_or(0.0, |[whole, end]| {
            let beyond = if end < whole { -0.5 * spacing } else { 0.5 * spacing };
            end - whole - beyond
        });
        let places: Vec<f64> = even.iter().map(|place| place + shift).collect();
        let found: Vec<Option<f64>> = places.iter().map(|place| gap(centre + place)).collect();
        let real: Vec<f64> = found.iter().map(|gap| gap.map_or(f64::INFINITY, |gap| gap - floor)).collect();
        // Parabolas touch no farther out than they would alone, where both go on up to there.
        let edge = 1.0 + 2.0 * spacing;
        let goes_on = places.iter().zip(&found).all(|(place, gap)| gap.is_some() || place.abs() > edge);
        let parabola = |(place, gap): (&f64, &Option<f64>)| {
            if gap.is_some() && !(goes_on && place.abs() > edge) { place * place } else { f64::INFINITY }
        };
        let ideal: Vec<f64> = places.iter().zip(&found).map(parabola).collect();
        let change = pressed(&real, spacing).zip(pressed(&ideal, spacing)).map_or(0.0, |(real, ideal)| real - ideal);
        Self { change: change.abs(), apart: apart.0 }
    }
}

/// Where a surface ends, if it does: the last of `places` where it is, seen from the middle, and the end.
fn end(is: impl Fn(f64) -> bool, places: &[f64]) -> Option<[f64; 2]> {
    let two = places.windows(2).find(|two| is(two[0]) != is(two[1]))?;
    let (whole, mut beyond) = if is(two[0]) { (two[0], two[1]) } else { (two[1], two[0]) };
    let mut last = whole;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (last + beyond);
        *(if is(middle) { &mut last } else { &mut beyond }) = middle;
    }
    Some([whole, last])
}

/// The least height between two places, and where it is.
fn lowest(height: &impl Fn(f64) -> f64, [mut lower, mut upper]: [f64; 2], mut best: (f64, f64)) -> (f64, f64) {
    for _ in 0..STEPS {
        let (left, right) = (lower + 0.382 * (upper - lower), upper - 0.382 * (upper - lower));
        let [at_left, at_right] = [left, right].map(|place| (place, height(place)));
        for here in [at_left, at_right] {
            if here.1 < best.1 {
                best = here;
            }
        }
        if at_left.1 < at_right.1 { upper = right } else { lower = left }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gear::contact::wedge::Wedge;
    use std::f64::consts::LN_2;

    /// Tier: closed form; a parabola of another radius has another ln b.
    #[test]
    fn another_radius_is_another_logarithm() {
        for (bend, tolerance) in [(1.001, 1e-5), (1.2, 2e-3), (2.0, 5e-3), (0.7, 5e-3)] {
            let found = Uneven::of(|x| Some(bend * (x - 0.3) * (x - 0.3)), 3.0);
            let exact = 0.5 * f64::ln(bend);
            assert!((found.change - exact.abs()).abs() < tolerance && found.apart == 0.0, "{bend}: {found:?} {exact}");
        }
        assert!(Uneven::of(|x| Some(x * x), 3.0).change < 1e-6);
    }

    /// Tier: closed form; two parabolas with the same least gap share the load, by ½ ln 2 + … less approach than one has alone.
    #[test]
    fn two_touches_are_found() {
        for apart in [3.0, 5.0] {
            let gap = |x: f64| {
                let off = (x - 0.5 * apart).abs().min((x + 0.5 * apart).abs());
                Some(off * off)
            };
            let found = Uneven::of(gap, 4.0);
            let alone = LN_2 + 0.5;
            let shared = 0.5 * ((2.0 * 2_f64.sqrt()).ln() + 0.5) - 0.5 * f64::ln(apart);
            assert!((found.change - (alone - shared)).abs() < 0.02, "{apart}: {found:?} {}", alone - shared);
            assert!((found.apart - apart).abs() < 1.0, "{found:?}");
        }
    }

    /// Tier: closed form; on a knee between two straight slopes that are steep the contact is that of a blunt wedge,
    /// Ψ = ln(2/a) + 1 with a = π/(2 k).
    #[test]
    fn a_sharp_knee_is_a_blunt_wedge() {
        let slope = 3.0;
        let found = Uneven::of(|x| Some(slope * x.abs()), 3.0);
        let exact = (4.0 * slope / PI).ln() + 1.0 - LN_2 - 0.5;
        assert!((found.change - exact).abs() < 0.03, "{found:?} {exact}");
    }

    /// Tier: second method; a flank that ends in the middle of the contact, as the law of wedges has it for a half plane that
    /// ends but yields as if it did not.
    #[test]
    fn beyond_a_base_circle_there_is_no_flank() {
        // On either side, in the middle of a strip, between two, and anywhere.
        for end in [0.02, 0.05, 0.1, 0.13, 0.37, 0.5, 0.55] {
            let exact = Wedge::new(0.0).more(end)[0];
            for side in [-1.0, 1.0] {
                let found = Uneven::of(|x| Some(if side * x > end { f64::INFINITY } else { x * x }), 3.0);
                assert!((found.change - exact).abs() < f64::min(0.02, 0.08 * exact), "{end}: {found:?} {exact}");
            }
        }
    }

    /// Tier: invariant; flanks that end beside the contact change nothing of what is measured against a parabola that ends there.
    #[test]
    fn an_end_is_no_unevenness() {
        let found = Uneven::of(|x| (x < 0.4).then_some(x * x), 3.0);
        assert!(found.change < 1e-6, "{found:?}");
        assert_eq!(Uneven::of(|_| None, 3.0), Uneven::default());
    }
}
