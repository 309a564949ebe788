//! What laws of contact leave out: they take a contact for narrow, and flanks beside it for parabolas.
//!
//! A law has the approach of two parabolas on half planes under the load per width p. What is left of a tooth, R(x, y) between
//! two places of the contact, is one number to it, R(0, 0), and so is the radius of curvature. To first order in what differs
//! the energy changes by its integral over Hertz' pressure, and the approach by the derivative of that with respect to p; with
//! b ∝ √p a change of energy p² b ε is one of approach 5/2 p b ε, and p² b² ε one of 3 p b² ε.
//!
//! - A curved surface has a kink in R: (1 − ν′)/(2E′ρ) |x − y|, of which Hertz' pressure has the mean
//!   (1 − ν′)/(2E′) 0.5764 b/ρ.
//! - A tooth is no thicker than 2h: (b/h)²/E′ times a number that finite elements have between −0.1 and 0.05.
//! - R changes along the flank by S′ for both teeth together: the contact moves by −ρ p S′/2 to where less is yielded, which
//!   saves 3/16 b² S′²/k₀ of the approach per load, k₀ = Σ 2/(πE′).
//!
//! Flanks that are no parabolas are pressed together as they are: half planes, strip by strip ([`pressed`]). Must not know:
//! gears, where on the path this is.

use crate::numeric::complementarity::Springs;
use crate::numeric::many_springs;

/// The mean distance of two places under Hertz' pressure, over half its width: 256/(45 π²).
const MEAN_DISTANCE: f64 = 0.576_4;
/// What a tooth of the thickness 2h adds, over (b/h)²/E′: as much as was found with finite elements, and more.
const THICKNESS: f64 = 0.1;
/// The estimate over the sum of its parts: contacts of CalculiX are up to 3.3 times as far off.
const SAFETY: f64 = 4.0;

/// One of two surfaces in contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// 1/E′ \[1/Pa\].
    pub compliance: f64,
    /// ν′.
    pub poisson_ratio: f64,
    /// ρ of this surface \[m\].
    pub radius: f64,
    /// h: how far below it the middle of the tooth is \[m\].
    pub depth: f64,
}

/// A contact of two surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// p \[N/m\].
    pub line_load: f64,
    /// b \[m\].
    pub half_width: f64,
    /// k₀ \[1/Pa\].
    pub rate: f64,
    /// S′: by how much more both teeth yield per load per width along the flank \[1/(Pa m)\].
    pub slope: f64,
    /// Both.
    pub surfaces: [Surface; 2],
}

impl Patch {
    /// The approach that the law may be off by, since the contact is as wide as it is \[m\]: the sum of the parts' sizes, with
    /// a margin for what is of higher order.
    #[must_use]
    pub fn left_out(&self) -> f64 {
        let of_surface = |surface: &Surface| {
            let [kink, thickness] = surface.left_out(self.half_width);
            1.25 * kink + 1.5 * thickness
        };
        let in_place = self.line_load * self.surfaces.iter().map(of_surface).sum::<f64>();
        SAFETY * (in_place + self.moved())
    }

    /// What is saved where the contact moves along the flank \[m\].
    fn moved(&self) -> f64 {
        let change = self.half_width * self.slope;
        3.0 / 16.0 * self.line_load * change * change / self.rate
    }
}

impl Surface {
    /// Twice the energy per square of the load that a contact of the half width b has beyond that of a law: of the kink, and of
    /// the thickness.
    #[must_use]
    pub fn left_out(&self, half_width: f64) -> [f64; 2] {
        let share = half_width / self.depth;
        let kink = 0.5 * (1.0 - self.poisson_ratio) * MEAN_DISTANCE * half_width / self.radius;
        [kink * self.compliance, THICKNESS * share * share * self.compliance]
    }
}

/// How far half planes approach, ∫ −ln|ξ − η| q dη + G(ξ) = Ψ where they touch, ∫ q = 1, q ≥ 0: Ψ, for gaps G at places that
/// are `spacing` apart. In units of a length b and of k₀ p; of G = ξ² it is ln 2 + ½ (Johnson, Contact Mechanics, 4.2), but for
/// the strips on each of which q is constant. None where less than one of the gaps is finite.
#[must_use]
pub fn pressed(gaps: &[f64], spacing: f64) -> Option<f64> {
    let least = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    if !least.is_finite() {
        return None;
    }
    // Places that are never reached are no springs.
    let open: Vec<(usize, f64)> =
        gaps.iter().enumerate().filter(|(_, gap)| gap.is_finite()).map(|(place, gap)| (place, gap - least)).collect();
    // A constant that makes all influences positive, and is taken off in the end.
    let length = libm::log(4.0 * spacing * gaps.len() as f64);
    let influence = |apart: usize| {
        let (distance, half) = (apart as f64, 0.5);
        let part = |at: f64| if at == 0.0 { 0.0 } else { at * libm::log(at.abs() * spacing) };
        length + 1.0 - (part(distance + half) - part(distance - half))
    };
    let influences: Vec<f64> = (0..gaps.len()).map(influence).collect();
    let own = Strips { compliance: 0.5 * influences[0] };
    let coupling: Vec<f64> = (open.iter())
        .flat_map(|(one, _)| open.iter().map(move |(other, _)| one.abs_diff(*other)))
        .map(|apart| influences[apart] - if apart == 0 { own.compliance } else { 0.0 })
        .collect();
    let behind: Vec<f64> = open.iter().map(|(_, gap)| *gap).collect();
    // As if they touched where they are nearer to each other than the edges of a parabola's contact are: nearly all that do.
    let found = many_springs::balance(&own, &behind, &coupling, 1.0, 1.0);
    Some(found.approach + least - length)
}

/// Strips of a surface, with part of what their own load does to them.
struct Strips {
    compliance: f64,
}

impl Springs for Strips {
    fn response(&self, _strip: usize, penetration: f64) -> (f64, f64) {
        (penetration / self.compliance, 1.0 / self.compliance)
    }
}

/// By how much the surfaces beside a contact come nearer than its middle, in units of k₀ p at ξ half widths from it: that of
/// parabolas that do not touch there.
#[must_use]
pub fn closing(place: f64) -> f64 {
    let square = place * place;
    if square <= 1.0 {
        return square;
    }
    let root = (square - 1.0).sqrt();
    square - place.abs() * root + libm::log(place.abs() + root)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{LN_2, PI};

    const COUNT: i32 = 40;

    /// Gaps at −COUNT..=COUNT times the spacing.
    fn gaps(spacing: f64, gap: impl Fn(f64) -> f64) -> Vec<f64> {
        (-COUNT..=COUNT).map(|place| gap(f64::from(place) * spacing)).collect()
    }

    /// Tier: closed form; two parabolas, and with another radius by the same law.
    #[test]
    fn parabolas_approach_as_hertz_has_it() {
        let spacing = 0.05;
        let hertz = pressed(&gaps(spacing, |x| x * x), spacing).unwrap();
        assert!((hertz - LN_2 - 0.5).abs() < 2e-3, "{hertz}");
        // b grows by √2 where the radius doubles.
        let flatter = pressed(&gaps(spacing, |x| 0.5 * x * x), spacing).unwrap();
        assert!((flatter - hertz + 0.5 * LN_2).abs() < 2e-3, "{flatter}");
    }

    /// Tier: closed form; a blunt wedge, gap k |x|: half the width of the contact is a = π/(2k), and Ψ = ln(2/a) + 1.
    #[test]
    fn a_wedge_approaches_as_its_closed_form() {
        for slope in [1.5, 3.0] {
            let spacing = 0.04;
            let half = 0.5 * PI / slope;
            let found = pressed(&gaps(spacing, |x| slope * x.abs()), spacing).unwrap();
            assert!((found - (2.0 / half).ln() - 1.0).abs() < 1e-2, "{found} {}", (2.0 / half).ln() + 1.0);
        }
    }

    /// Tier: closed form; two parabolas far apart share the load: Ψ = ½ (ln(2/b′) + ½) + ½ ln(1/d), b′ = 1/√2, up to terms of
    /// the order of 1/d².
    #[test]
    fn two_touches_share_the_load() {
        let spacing = 0.05;
        let apart = 3.0;
        let found = pressed(
            &(-80..=80)
                .map(|place| f64::from(place) * spacing)
                .map(|x| {
                    let off = x.abs() - 0.5 * apart;
                    off * off
                })
                .collect::<Vec<f64>>(),
            spacing,
        )
        .unwrap();
        let exact = 0.5 * ((2.0 * 2_f64.sqrt()).ln() + 0.5) - 0.5 * f64::ln(apart);
        assert!((found - exact).abs() < 2e-2, "{found} {exact}");
    }

    /// Tier: second method; where closing is the gap of a Hertzian contact beside it, half planes just do not touch.
    #[test]
    fn beside_a_contact_surfaces_close_in_by_what_strips_say() {
        let spacing = 0.05;
        let alone = pressed(&gaps(spacing, |x| if x.abs() < 1.2 { x * x } else { 1e3 }), spacing).unwrap();
        for place in [1.5, 1.8] {
            let with = |gap: f64| {
                let near = |x: f64| x.abs() < 1.2 || (x - place).abs() > 0.5 * spacing;
                pressed(
                    &gaps(spacing, |x| if near(x) { if x.abs() < 1.2 { x * x } else { 1e3 } } else { gap }),
                    spacing,
                )
                .unwrap()
            };
            let closed = closing(place);
            assert!((with(closed + 0.02) - alone).abs() < 1e-9, "at {place}");
            assert!(with(closed - 0.02) < alone - 1e-6, "at {place}");
        }
    }

    /// Tier: second method; the mean distance of two places, each x = cos θ under 2/π sin²θ.
    #[test]
    fn places_under_a_pressure_are_so_far_apart() {
        let count = 2000;
        let places: Vec<(f64, f64)> = (0..count)
            .map(|k| PI * (f64::from(k) + 0.5) / f64::from(count))
            .map(|angle| (angle.cos(), 2.0 / f64::from(count) * angle.sin().powi(2)))
            .collect();
        let far = |(x, p): &(f64, f64)| places.iter().map(|(y, q)| p * q * (x - y).abs()).sum::<f64>();
        let mean: f64 = places.iter().map(far).sum();
        assert!((mean / MEAN_DISTANCE - 1.0).abs() < 1e-4, "{mean}");
        assert!((mean - 256.0 / (45.0 * PI * PI)).abs() < 1e-6, "{mean}");
    }

    /// Tier: closed form; a strip of the thickness 2h that is pressed from both sides: its surface moves by
    /// (2/πE′) ∫ (K − 1) cos(tx/h)/t dt beside that of a half plane, K = 2 sinh²t/(sinh 2t + 2t), and so at x by
    /// I/(πE′) (x/h)², I = ∫ (1 − K) t dt, more than at the load. A pressure with <(x − y)²> = b²/2 has I/2π (b/h)²/E′ of it,
    /// which is more than any tooth was found to have: with its margin what is said holds for it too.
    #[test]
    fn a_pressed_strip_is_thinner_in_its_effect_than_is_said() {
        let rest = |t: f64| t * (1.0 + 2.0 * t - (-2.0 * t).exp()) / ((2.0 * t).sinh() + 2.0 * t);
        let steps = 4000;
        let size = 20.0 / f64::from(steps);
        let integral: f64 = (0..steps).map(|k| size * rest((f64::from(k) + 0.5) * size)).sum();
        assert!((integral - 1.042_08).abs() < 1e-5, "{integral}");
        let coefficient = integral / (2.0 * PI);
        for half_width in [0.05, 0.2] {
            let surface = Surface { compliance: 0.91, poisson_ratio: 0.43, radius: f64::INFINITY, depth: 1.0 };
            let [kink, said] = surface.left_out(half_width);
            let exact = coefficient * 0.91 * half_width * half_width;
            assert!(kink == 0.0 && exact > said && exact < SAFETY * said, "{exact} {said}");
        }
    }

    /// Tier: second method; the energy of a contact that may move, over all places.
    #[test]
    fn a_slope_saves_what_the_best_place_does() {
        let (rate, half_width, load) = (0.7, 0.3, 2.0);
        // ρ from b² = 2 k₀ p ρ.
        let radius = half_width * half_width / (2.0 * rate * load);
        let slope = 0.2;
        let least = |load: f64| {
            let energy = |x: f64| 0.5 * load * load * slope * x + 0.5 * load * x * x / radius;
            (-20_000..=20_000).map(|k| energy(f64::from(k) * 1e-5)).fold(f64::INFINITY, f64::min)
        };
        let step = 1e-3;
        let saved = -(least(load + step) - least(load - step)) / (2.0 * step);
        let bodies = Surface { compliance: 0.0, poisson_ratio: 0.3, radius: 1.0, depth: 1.0 };
        let patch = Patch { line_load: load, half_width, rate, slope, surfaces: [bodies; 2] };
        assert!((patch.moved() / saved - 1.0).abs() < 1e-3, "{saved} {}", patch.moved());
    }
}
