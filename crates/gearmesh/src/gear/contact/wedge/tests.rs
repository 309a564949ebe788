//! The wedge against closed forms, against pressures found in another way, and against itself at its joints.

use super::*;

mod spread;

/// Tier: closed form; the wedge of 180° is a half plane, that of 90° has 2 cos² and 2 sin² of 45° over π/2 ± 1; one that is
/// loaded along its bisector moves as Michell's.
#[test]
fn a_wedge_yields_as_its_closed_form() {
    assert!(softening(PI).abs() < 1e-15);
    let right = 1.0 / (FRAC_PI_2 + 1.0) + 1.0 / (FRAC_PI_2 - 1.0) - 2.0 / PI;
    assert!((softening(FRAC_PI_2) / right - 1.0).abs() < 1e-14);
    let mut before = f64::INFINITY;
    for degrees in 10..360 {
        let found = softening(f64::from(degrees).to_radians());
        assert!(found < before, "the narrower, the softer: {degrees}");
        before = found;
    }
}

/// Tier: closed form; a half plane that ends, but yields as if it did not: a parabola that touches it from 0 to e presses
/// with √((e − ξ)/ξ) (a + ξ). The moments of that are ¾ e² − λ e = 1 and Ψ/k₀ − λ² = ⅜ e² − λ e + ln(4/e).
#[test]
fn a_half_plane_that_ends_has_a_closed_form() {
    let wedge = Wedge::new(0.0);
    for step in -300..=300 {
        let place = 0.1 * f64::from(step);
        let exact = if place >= 1.0 {
            0.0
        } else {
            let end = (place + (place * place + 3.0).sqrt()) / 1.5;
            let above = 0.375 * end * end - place * end + libm::log(4.0 / end);
            above + if place > 0.0 { place * place } else { 0.0 } - LN_2 - 0.5
        };
        let [found, _] = wedge.more(place);
        assert!((found - exact).abs() < 2e-6, "{place}: {found} for {exact}");
    }
}

/// Ψ/k₀ by pressures that are constant on each of many strips, which get thinner towards the corner; those that would pull
/// are taken away until none is left. And the strips that press: between where, and how much.
fn by_strips<const STRIPS: usize, const WIDTH: usize>(place: f64, ratio: f64) -> (f64, Vec<([f64; 2], f64)>) {
    by_strips_with::<STRIPS, WIDTH>(place, ratio, |x, [from, to]| {
        moment(to + x) - moment(from + x) - LN_2 * (to - from)
    })
}

/// ∫ ln|x| dx.
fn moment(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x * (libm::log(x.abs()) - 1.0) }
}

/// The same with what the corner adds at x under a strip that presses, over −B/k₀.
fn by_strips_with<const STRIPS: usize, const WIDTH: usize>(
    place: f64,
    ratio: f64,
    corner: impl Fn(f64, [f64; 2]) -> f64,
) -> (f64, Vec<([f64; 2], f64)>) {
    let width = f64::max(place, 0.0) + 1.6;
    let ends: Vec<f64> = (0..=STRIPS)
        .map(|k| {
            let share = k as f64 / STRIPS as f64;
            if place > 2.5 { place - 1.3 + 2.6 * share } else { width * share * share * share }
        })
        .collect();
    let mut loaded = [true; STRIPS];
    loop {
        let strips: Vec<usize> = (0..STRIPS).filter(|&k| loaded[k]).collect();
        let mut rows = vec![[0.0; WIDTH]; strips.len() + 1];
        for (row, &on) in strips.iter().enumerate() {
            let x = 0.5 * (ends[on] + ends[on + 1]);
            for (column, &by) in strips.iter().enumerate() {
                let (from, to) = (ends[by], ends[by + 1]);
                let direct = moment(to - x) - moment(from - x);
                rows[row][column] = -direct - ratio * corner(x, [from, to]);
            }
            rows[row][strips.len()] = -1.0;
            rows[row][WIDTH - 1] = -(x - place) * (x - place);
        }
        for (column, &by) in strips.iter().enumerate() {
            rows[strips.len()][column] = ends[by + 1] - ends[by];
        }
        rows[strips.len()][WIDTH - 1] = 1.0;
        // Unknowns that are not there are zero: their columns move out of the way.
        let size = strips.len() + 1;
        for row in &mut rows {
            row.swap(size, WIDTH - 1);
        }
        solve(&mut rows);
        let pulled: Vec<usize> = (0..strips.len()).filter(|&k| rows[k][size] < 0.0).map(|k| strips[k]).collect();
        if pulled.is_empty() {
            let presses = strips.iter().zip(&rows).map(|(&k, row)| ([ends[k], ends[k + 1]], row[size]));
            return (rows[strips.len()][size], presses.collect());
        }
        for strip in pulled {
            loaded[strip] = false;
        }
    }
}

/// Tier: second method.
#[test]
fn pressures_in_strips_give_the_same() {
    for ratio in [0.1, 0.3, 0.6] {
        let wedge = Wedge::new(ratio);
        for place in [8.0, 3.0, 1.5, 1.0, 0.7, 0.2, 0.0, -0.4, -1.5, -6.0] {
            let [found, _] = wedge.more(place);
            let square = if place > 0.0 { 0.0 } else { place * place };
            let strips = by_strips::<90, 92>(place, ratio).0 - square - LN_2 - 0.5;
            assert!((found - strips).abs() < 2e-3, "{ratio} {place}: {found}, by strips {strips}");
        }
    }
}

/// Tier: invariant; values join, slopes are those of differences, and both ends go over into what is beyond.
#[test]
fn the_tables_join() {
    for ratio in [0.0, 0.05, 0.29, 0.8] {
        let wedge = Wedge::new(ratio);
        let joints: Vec<f64> =
            wedge.tables[1..].iter().flat_map(|(values, _)| [values.lower(), values.upper()]).collect();
        for joint in joints.into_iter().chain([BEYOND]) {
            let [below, above] = [-1e-9, 1e-9].map(|step| wedge.more(joint + step));
            assert!((below[0] - above[0]).abs() < 1e-5, "{ratio}: values at {joint}: {below:?} {above:?}");
            assert!((below[1] - above[1]).abs() < 1e-3, "{ratio}: slopes at {joint}: {below:?} {above:?}");
        }
        for place in [-80.0, -20.0, -1.1, 0.3, 1.4, 6.0, 30.0] {
            let [low, high] = [-1e-5, 1e-5].map(|step| wedge.more(place + step)[0]);
            assert!(((high - low) / 2e-5 - wedge.more(place)[1]).abs() < 1e-6, "{ratio}: slope at {place}");
        }
    }
}

/// Tier: order of convergence in the distance: the rest beyond the tables falls as 1/λ², a quarter of what is left at half
/// the distance, and the contact that is all beyond the corner goes by its logarithm alone.
#[test]
fn far_from_the_corner_only_its_logarithm_is_left() {
    let ratio = 0.29;
    let wedge = Wedge::new(ratio);
    let left = |place: f64| wedge.more(place)[0] + ratio * libm::log(place);
    assert!((3.6..4.4).contains(&(left(4.5) / left(9.0))), "{} {}", left(4.5), left(9.0));
    let grown = wedge.more(-28.0)[0] - wedge.more(-14.0)[0];
    assert!((grown / ((1.0 + ratio) * LN_2) - 1.0).abs() < 5e-3, "{grown}");
}
