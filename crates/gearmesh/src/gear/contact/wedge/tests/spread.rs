//! How a contact near a corner spreads: against closed forms, pressures in strips, and itself where its tables join.

use super::*;
use crate::numeric::parabola::peak;

/// Tier: closed form; on a half plane that ends, but yields as if it did not, nothing happens before the contact reaches the
/// end, from λ = 1 on, and then it ends where [`a_half_plane_that_ends_has_a_closed_form`] says.
#[test]
fn on_a_half_plane_that_ends_a_contact_is_that_of_hertz() {
    let wedge = Wedge::new(0.0);
    for step in -600..=300 {
        let place = 0.1 * f64::from(step);
        let found = wedge.spread(place);
        if place > 1.0 + 1e-3 {
            assert!(!found.reaches, "{place}");
            let off = [found.pressure - 1.0, found.half_width - 1.0, found.farther].map(f64::abs);
            assert!(off.into_iter().all(|off| off < 1e-5), "{place}: {found:?}");
        } else if place < 1.0 - 1e-3 {
            let end = (place + (place * place + 3.0).sqrt()) / 1.5;
            // Beyond the tables it goes with 1/λ, which leaves out ¾/λ².
            let off = if place < -30.0 { 0.75 / 900.0 } else { 2e-5 };
            assert!((2.0 * found.half_width / end - 1.0).abs() < off, "{place}: {found:?} for {end}");
            assert!(found.reaches && found.farther + place == 0.0, "the largest pressure is at the corner: {place}");
        }
    }
}

/// Tier: closed form; (ξ − λ)² less B/k₀ ln((ξ + η)/2) to second order in 1/λ is a parabola with another bend and top.
#[test]
fn far_inside_a_contact_is_that_of_another_parabola() {
    for ratio in [0.05, 0.29, 0.6] {
        let wedge = Wedge::new(ratio);
        for place in [6.0, 9.0, 20.0, 1e3] {
            let found = wedge.spread(place);
            let square = ratio / (16.0 * place * place);
            // Of fourth order in 1/λ is the next.
            let off = 2.0 / (place * place).min(100.0);
            let near = |found: f64, exact: f64, off: f64| {
                assert!((found / exact - 1.0).abs() < off, "{ratio} {place}: {found} for {exact}");
            };
            near(found.pressure - 1.0, square, off);
            near(1.0 - found.half_width, square, off);
            near(found.farther, ratio / (4.0 * place), off);
        }
    }
}

/// Tier: second method; the width to one strip, a hundredth of it.
#[test]
fn pressures_in_strips_spread_alike() {
    for ratio in [0.1, 0.3, 0.6] {
        let wedge = Wedge::new(ratio);
        for place in [8.0, 3.0, 1.5, 1.3, 1.1, 0.9, 0.7, 0.2, 0.0, -0.4, -1.5, -6.0] {
            let found = wedge.spread(place);
            let (_, strips) = by_strips::<240, 242>(place, ratio);
            let (first, last) = (strips[0].0, strips[strips.len() - 1].0);
            let half_width = 0.5 * (last[1] - first[0]);
            assert!(
                (found.half_width - half_width).abs() < last[1] - last[0],
                "{ratio} {place}: {found:?} {half_width}"
            );
            assert_eq!(found.reaches, first[0] == 0.0, "{ratio} {place}");
            if !found.reaches {
                let (places, pressures): (Vec<f64>, Vec<f64>) =
                    strips.iter().map(|([from, to], pressure)| (0.5 * (from + to), 0.5 * PI * pressure)).unzip();
                let (pressure, at) = peak(&places, &places, &pressures).unwrap();
                assert!((found.pressure - pressure).abs() < 4e-5, "{ratio} {place}: {found:?} {pressure}");
                assert!((found.farther - (at - place)).abs() < 3e-4, "{ratio} {place}: {found:?} {at}");
            }
        }
    }
}

/// What a unit load on one side of a wedge does there, normal to it, over ln(ξ/η): its Fourier transform, E′ = 1 (from Airy's
/// function as powers of the distance from the corner, Timoshenko and Goodier, 43).
fn transform(interior: f64, wave: f64) -> f64 {
    let (stretched, sine) = (wave * interior, wave * libm::sin(interior));
    let below = libm::sinh(stretched) * libm::sinh(stretched) - sine * sine;
    (libm::sinh(2.0 * stretched) + wave * libm::sin(2.0 * interior)) / (wave * below)
}

/// Tier: second method; the kernel of the wedge itself instead of ln((ξ + η)/2): that is ½ ln ξη and a function of ln(ξ/η), which
/// is 0 on the diagonal. What is nearer to a half plane has less of either; the corner is reached a little sooner.
#[test]
fn the_kernel_of_the_wedge_itself_gives_nearly_the_same() {
    const APART: f64 = 10.0;
    for degrees in [110.0_f64, 125.0] {
        let interior = degrees.to_radians();
        let softening = softening(interior);
        let waves = (0..3000).map(|k| 0.01 * (f64::from(k) + 0.5));
        let parts: Vec<[f64; 2]> =
            waves.map(|wave| [wave, 0.01 * (transform(interior, wave) - transform(PI, wave)) / PI]).collect();
        let exact = |t: f64| -> f64 {
            let sum: f64 = parts.iter().map(|[wave, part]| part * (1.0 - libm::cos(wave * t))).sum();
            sum / softening
        };
        let near = Series::fit(0.0, APART, 40, exact);
        let beside = |t: f64| near.value(t.abs().min(APART)) + 0.5 * (t.abs() - APART).max(0.0);
        // Far apart it goes on with half of the logarithm, and nowhere it is more than 0.15 off.
        assert!((beside(APART) - beside(APART - 1.0) - 0.5).abs() < 2e-3, "{degrees}");
        for step in 0..=100 {
            let t = 0.01 * APART * f64::from(step);
            assert!((beside(t) - libm::log(libm::cosh(0.5 * t))).abs() < 0.15, "{degrees} {t}");
        }
        // Both bodies of one material.
        let ratio = softening * PI / 4.0;
        let wedge = Wedge::new(ratio);
        for place in [3.0, 2.0, 1.5, 1.2, 1.0] {
            let found = wedge.spread(place);
            let corner = |x: f64, [from, to]: [f64; 2]| {
                let y = 0.5 * (from + to);
                (to - from) * (0.5 * libm::log(x * y) + beside(libm::log(x / y)))
            };
            let (_, strips) = by_strips_with::<200, 202>(place, ratio, corner);
            let largest = strips.iter().map(|(_, pressure)| 0.5 * PI * pressure).fold(0.0, f64::max);
            let more = (largest - 1.0) / (found.pressure - 1.0);
            assert!(found.pressure - largest > 0.0 && found.pressure - largest < 5e-3, "{degrees} {place}: {largest}");
            assert!((0.79..0.92).contains(&more), "{degrees} {place}: {more}");
        }
    }
}

/// Tier: invariant; where tables join nothing jumps but the place, which goes to the corner.
#[test]
fn spreads_join() {
    for ratio in [0.0, 0.05, 0.29, 0.8] {
        let wedge = Wedge::new(ratio);
        let joints = wedge.tables[1..].iter().flat_map(|table| [table.lower(), table.upper()]);
        for joint in joints.chain([BEYOND]) {
            let [below, above] = [-1e-9, 1e-9].map(|step| wedge.spread(joint + step));
            assert!(
                (below.pressure - above.pressure).abs() < 2e-4,
                "{ratio}: pressure at {joint}: {below:?} {above:?}"
            );
            assert!((below.half_width - above.half_width).abs() < 1e-4, "{ratio}: {joint}: {below:?} {above:?}");
            if below.reaches == above.reaches {
                assert!((below.farther - above.farther).abs() < 1e-5, "{ratio}: place at {joint}: {below:?} {above:?}");
            }
        }
    }
}

/// Tier: invariant; what yields more towards the corner bends the surface more, until the contact reaches the corner.
#[test]
fn the_nearer_the_corner_the_larger_the_pressure() {
    let wedge = Wedge::new(0.29);
    let mut before = 1.0;
    for step in 0..2000 {
        let found = wedge.spread(20.0 - 0.01 * f64::from(step));
        assert!(found.pressure >= before, "{step}: {found:?} after {before}");
        before = found.pressure;
    }
}
