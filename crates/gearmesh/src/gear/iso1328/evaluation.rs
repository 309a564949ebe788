//! What a trace of a flank comes to: slope, form, total and crowning, ISO 1328-1:2013, clauses 3 and 4 and its figures 8 to 11.
//!
//! A deviation is positive where there is more material than the design has. Of a profile the place along the trace is the roll
//! length, which grows to the tip; of a helix it is z. The trace between two points is the line between them, and all that is
//! integrated is integrated along it: points need not be equally far apart. Must not know: gears, modifications.

/// What a trace comes to over its evaluation range, all in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evaluation {
    /// The evaluation range: L_α of a profile, L_β of a helix.
    pub range: [f64; 2],
    /// f_Hα, f_Hβ: how far the mean line rises over the whole of the flank, which it is extended to; positive where material
    /// grows along the trace.
    pub slope: f64,
    /// f_fα, f_fβ: how far apart two lines parallel to the mean line are that hold the trace between them.
    pub form: f64,
    /// F_α, F_β: how far apart two lines along the design are that hold the trace between them.
    pub total: f64,
    /// C_α, C_β: the height of the mean parabola over its chord; positive where the middle has more material than both ends.
    pub crowning: f64,
}

/// Evaluates the trace through the points (`places[i]`, `deviations[i]`) over the part of `range` that it covers; `whole` is the
/// length over which the slope is stated: 2013 extends the mean line to the profile control diameter and the tip, or to both ends
/// of the face. All in m, `places` ascending. None where less than two points cover any length of the range.
#[must_use]
pub fn evaluate(places: &[f64], deviations: &[f64], range: [f64; 2], whole: f64) -> Option<Evaluation> {
    let points = inside(places, deviations, range);
    let ([from, _], [to, _]) = (*points.first()?, *points.last()?);
    let length = to - from;
    if length.is_nan() || length <= 0.0 {
        return None;
    }
    // On −1..=1, where Legendre's polynomials are orthogonal.
    let unit = |place: f64| (2.0 * place - from - to) / length;
    let [mut mean, mut rise, mut bend] = [0.0; 3];
    for ends in points.windows(2) {
        let ([start, one], [end, other]) = (ends[0], ends[1]);
        let half = 0.5 * (unit(end) - unit(start));
        // Gauss's rule with two points: exact for a line times a parabola.
        for side in [-1.0, 1.0] {
            let share = 0.5 * (1.0 + side / 3.0_f64.sqrt());
            let (t, value) = (unit(start + (end - start) * share), one + (other - one) * share);
            mean += 0.5 * half * value;
            rise += 1.5 * half * value * t;
            bend += 2.5 * half * value * (1.5 * t * t - 0.5);
        }
    }
    let spread = |off: &dyn Fn(&[f64; 2]) -> f64| {
        let (least, most) = points
            .iter()
            .map(off)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| (least.min(value), most.max(value)));
        most - least
    };
    Some(Evaluation {
        range: [from, to],
        slope: 2.0 * rise * whole / length,
        form: spread(&|[place, value]| value - mean - rise * unit(*place)),
        total: spread(&|[_, value]| *value),
        crowning: -1.5 * bend,
    })
}

/// The points inside a range, and those of the trace at its ends.
fn inside(places: &[f64], deviations: &[f64], [from, to]: [f64; 2]) -> Vec<[f64; 2]> {
    let points = || places.iter().zip(deviations).map(|(place, value)| [*place, *value]);
    let mut found: Vec<[f64; 2]> = points().filter(|[place, _]| *place >= from && *place <= to).collect();
    let at = |end: f64| {
        let after = places.partition_point(|place| *place < end);
        let is_between = after > 0 && after < places.len() && places[after] > end;
        is_between.then(|| {
            let share = (end - places[after - 1]) / (places[after] - places[after - 1]);
            [end, deviations[after - 1] + share * (deviations[after] - deviations[after - 1])]
        })
    };
    if let Some(first) = at(from) {
        found.insert(0, first);
    }
    found.extend(at(to).filter(|_| to > from));
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `count` points from 1 to 5 mm, unevenly spaced.
    fn trace(count: usize, of: impl Fn(f64) -> f64) -> [Vec<f64>; 2] {
        let place = |at: usize| {
            let t = at as f64 / (count - 1) as f64;
            1e-3 + 4e-3 * (t + 0.3 * t * (1.0 - t))
        };
        let places: Vec<f64> = (0..count).map(place).collect();
        let values = places.iter().map(|place| of((place - 1e-3) / 4e-3)).collect();
        [places, values]
    }

    fn evaluated(count: usize, of: impl Fn(f64) -> f64) -> Evaluation {
        let [places, values] = trace(count, of);
        evaluate(&places, &values, [0.0, 1.0], 4e-3).unwrap()
    }

    #[track_caller]
    fn are(found: &Evaluation, exact: [f64; 4], within: f64) {
        let found = [found.slope, found.form, found.total, found.crowning];
        for (found, exact) in found.iter().zip(exact) {
            assert!((found - exact).abs() <= within, "{found:e} is not {exact:e}");
        }
    }

    /// Tier: closed form; a line has its rise and no form, whatever it counts from, and however few points tell it.
    #[test]
    fn a_line_is_slope_alone() {
        for count in [2, 3, 40] {
            are(&evaluated(count, |t| 3e-6 - 8e-6 * t), [-8e-6, 0.0, 8e-6, 0.0], 1e-19);
        }
        // Over half of it, with ends between points, and stated over all of it.
        let [places, values] = trace(7, |t| 5e-6 * t);
        let half = evaluate(&places, &values, [2e-3, 4e-3], 4e-3).unwrap();
        are(&half, [5e-6, 0.0, 2.5e-6, 0.0], 1e-19);
        assert!((half.range[0] - 2e-3).abs() < 1e-18 && (half.range[1] - 4e-3).abs() < 1e-18);
    }

    /// Tier: closed form; h(1 − (2t − 1)²) is crowned by h, which is its form and its total, and does not slope; with a line beside it the
    /// form and the crowning stay.
    #[test]
    fn a_parabola_is_crowning_and_form() {
        let crowned = |rise: f64| evaluated(2001, move |t| 6e-6 * (1.0 - (2.0 * t - 1.0) * (2.0 * t - 1.0)) + rise * t);
        are(&crowned(0.0), [0.0, 6e-6, 6e-6, 6e-6], 3e-12);
        // Total: the crest of 24 t (1 − t) + 12 t is 13.5 at t = 3/4, above 0 at the start.
        are(&crowned(12e-6), [12e-6, 6e-6, 13.5e-6, 6e-6], 3e-12);
    }

    /// Tier: closed form; n whole waves A sin 2πnt lie about a line that falls by 6A/πn. 4001 points cut 2e-6 of a crest.
    #[test]
    fn whole_waves_lie_about_a_line_that_falls() {
        let waves = 5.0;
        let found = evaluated(4001, |t| 1e-6 * libm::sin(std::f64::consts::TAU * waves * t));
        let slope = -6e-6 / (std::f64::consts::PI * waves);
        assert!((found.slope - slope).abs() < 4e-12 && found.crowning.abs() < 2e-12, "{found:?}");
        assert!((found.total - 2e-6).abs() < 2e-12);
        // The first trough and the last crest are 7/10 apart; the extremes about the line lie beside them by (slope/2πnA)²/2 of A each.
        assert!((found.form - (2e-6 + slope.abs() * 0.7)).abs() < 2e-10, "{found:?}");
    }

    /// Tier: second method; `numpy.polyfit` (2.4) over 400 000 samples of the broken line through these points: first order for the slope,
    /// second for the crowning.
    #[test]
    fn the_mean_line_is_that_of_numpy() {
        let places = [0.0, 0.4e-3, 1.0e-3, 1.1e-3, 1.9e-3, 2.5e-3];
        let values = [1.0e-6, -0.5e-6, 0.7e-6, 2.2e-6, 1.8e-6, -1.1e-6];
        let found = evaluate(&places, &values, [0.0, 2.5e-3], 2.5e-3).unwrap();
        are(&found, NUMPY, 1e-13);
    }

    const NUMPY: [f64; 4] = [0.655_52e-6, 3.667_091_2e-6, 3.3e-6, 2.180_208e-6];

    #[test]
    fn what_covers_nothing_is_not_evaluated() {
        let [places, values] = trace(5, |t| t);
        assert!(evaluate(&places, &values, [6e-3, 7e-3], 1.0).is_none());
        assert!(evaluate(&places, &values, [2e-3, 2e-3], 1.0).is_none());
        assert!(evaluate(&[], &[], [0.0, 1.0], 1.0).is_none());
    }
}
