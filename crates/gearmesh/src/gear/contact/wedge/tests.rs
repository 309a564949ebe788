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

/// Tier: closed form; the softening of an inclined load is that of its angle to the bisector.
#[test]
fn inclined_loads_yield_by_their_angle_to_the_bisector() {
    for interior in [0.6_f64, 1.6, 2.1, 3.0] {
        let (half, shear) = (0.5 * interior, 0.5 * interior.sin());
        let [across, along] = inclined_softening(interior);
        for turn in [-0.7, -0.1, 0.05, 0.5, FRAC_PI_2] {
            let angle = FRAC_PI_2 - half - turn;
            let exact = angle.cos().powi(2) / (half + shear) + angle.sin().powi(2) / (half - shear) - 2.0 / PI;
            let found = softening(interior) + (2.0 * turn).sin() * across + turn.sin().powi(2) * along;
            assert!((found - exact).abs() < 1e-13 * exact.abs().max(1.0), "{interior} {turn}: {found} for {exact}");
        }
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

/// Tier: closed form; of the same contacts the mean place is (e³ − λ e²)/4.
#[test]
fn a_half_plane_that_ends_is_loaded_beside_the_top() {
    let wedge = Wedge::new(0.0);
    let beside = |place: f64| {
        let end = (place + (place * place + 3.0).sqrt()) / 1.5;
        0.25 * (end - place) * end * end - if place > 0.0 { place } else { 0.0 }
    };
    for step in -290..100 {
        let place = 0.1 * f64::from(step) + 0.05;
        let (low, high) = (beside(place - 1e-4), beside(place + 1e-4));
        let exact = if place < 1.0 { 2.5 * beside(place) - 0.5 * place * (high - low) / 2e-4 } else { 0.0 };
        let [[found, _], _] = wedge.turned(place);
        assert!((found - exact).abs() < 2e-4, "{place}: {found} for {exact}");
    }
}

/// Ψ/k₀ by pressures that are constant on each of many strips, which get thinner towards the corner; those that would pull
/// are taken away until none is left. And the strips that press: between where, and how much.
fn by_strips<const STRIPS: usize, const WIDTH: usize>(place: f64, ratio: f64) -> (f64, Vec<([f64; 2], f64)>) {
    by_strips_with::<STRIPS, WIDTH>(place, ratio, of_corner)
}

/// What the corner adds at x under a strip that presses, over −B/k₀.
fn of_corner(x: f64, [from, to]: [f64; 2]) -> f64 {
    moment(to + x) - moment(from + x) - LN_2 * (to - from)
}

/// ∫ ln|x| dx.
fn moment(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x * (libm::log(x.abs()) - 1.0) }
}

/// The same with another one that adds, over −B/k₀.
fn by_strips_with<const STRIPS: usize, const WIDTH: usize>(
    place: f64,
    ratio: f64,
    corner: impl Fn(f64, [f64; 2]) -> f64,
) -> (f64, Vec<([f64; 2], f64)>) {
    let width = f64::max(place, 0.0) + 1.6;
    let ends: Vec<f64> = (0..=STRIPS)
        .map(|k| {
            let share = k as f64 / STRIPS as f64;
            if place > 1.4 { place - 1.3 + 2.6 * share } else { width * share * share * share }
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

/// Tier: second method; a load that turns along the contact, by what it adds to the influences of strips; and B that is
/// another one.
#[test]
fn influences_that_turn_along_the_contact_give_the_same() {
    let ratio = 0.25;
    let wedge = Wedge::new(ratio);
    for place in [3.0, 1.5, 1.0, 0.7, 0.2, 0.0, -0.4, -1.5, -6.0] {
        let inside = f64::max(place, 0.0);
        let change = |added: &dyn Fn(f64, f64) -> f64| {
            let [low, high] = [-0.02, 0.02].map(|size| {
                let corner = |x: f64, strip: [f64; 2]| {
                    let more = size * added(x, 0.5 * (strip[0] + strip[1])) * (strip[1] - strip[0]);
                    of_corner(x, strip) - more / ratio
                };
                by_strips_with::<160, 162>(place, ratio, corner).0
            });
            (high - low) / 0.04
        };
        let turn = |x: f64, y: f64| x + y - 2.0 * inside;
        let logarithm = |x: f64, y: f64| libm::log(0.5 * (x + y));
        let [values, _] = wedge.turned(place);
        let exact = [change(&turn), change(&|x, y| turn(x, y) * logarithm(x, y))];
        for (found, exact) in values.into_iter().zip(exact) {
            assert!((found - exact).abs() < 5e-3, "{place}: {values:?}, by strips {exact}");
        }
        if place < 0.0 {
            let exact = change(&|x, y| -logarithm(x, y));
            let [found, _] = wedge.by_ratio(place);
            assert!((found - exact).abs() < 3e-3, "{place}: {found}, by strips {exact}");
        }
    }
}

/// Tier: second method; B that is less by two fifths, as 5° of inclination make it, is nearly a linear change.
#[test]
fn another_wedge_is_a_linear_change() {
    let (wedge, other) = (Wedge::new(0.22), Wedge::new(0.13));
    for step in 0..400 {
        let place = -0.1 * f64::from(step);
        let found = wedge.more(place)[0] - 0.09 * wedge.by_ratio(place)[0];
        let exact = other.more(place)[0];
        assert!((found - exact).abs() < 5e-3, "{place}: {found} for {exact}");
    }
}

/// Tier: invariant; values join, slopes are those of differences, and both ends go over into what is beyond.
#[test]
fn the_tables_join() {
    for ratio in [0.0, 0.05, 0.29, 0.8] {
        let wedge = Wedge::new(ratio);
        let joints: Vec<f64> = wedge.tables[1..].iter().flat_map(|table| [table.lower(), table.upper()]).collect();
        for joint in joints.into_iter().chain([BEYOND]) {
            let [below, above] = [-1e-9, 1e-9].map(|step| wedge.more(joint + step));
            assert!((below[0] - above[0]).abs() < 1e-5, "{ratio}: values at {joint}: {below:?} {above:?}");
            assert!((below[1] - above[1]).abs() < 1e-3, "{ratio}: slopes at {joint}: {below:?} {above:?}");
        }
        for place in [-80.0, -20.0, -1.1, 0.3, 1.4, 6.0, 30.0] {
            let [low, high] = [-1e-5, 1e-5].map(|step| wedge.more(place + step)[0]);
            assert!(((high - low) / 2e-5 - wedge.more(place)[1]).abs() < 1e-6, "{ratio}: slope at {place}");
        }
        for joint in [BEYOND, JOINTS[0], 0.0, JOINTS[1], FAR] {
            let [below, above] = [-1e-9, 1e-9].map(|step| wedge.turned(joint + step)[0]);
            for (below, above) in below.into_iter().zip(above) {
                assert!((below - above).abs() < 3e-4, "{ratio}: turned at {joint}: {below} {above}");
            }
        }
        for place in [-80.0, -20.0, -1.1, 0.3, 1.4, 6.0, 30.0] {
            let [low, high] = [-1e-5, 1e-5].map(|step| wedge.turned(place + step)[0]);
            for (k, slope) in wedge.turned(place)[1].into_iter().enumerate() {
                assert!(((high[k] - low[k]) / 2e-5 - slope).abs() < 1e-5, "{ratio}: slope at {place}");
            }
            if place < 0.0 {
                let [low, high] = [-1e-5, 1e-5].map(|step| wedge.by_ratio(place + step)[0]);
                assert!(((high - low) / 2e-5 - wedge.by_ratio(place)[1]).abs() < 1e-6, "{ratio}: slope at {place}");
            }
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
