//! The deviation across the face and how much of a penetration it lets through.
//!
//! A tooth pair is a row of independent slices: under the penetration w its load is its stiffness times
//! Φ(w) = 1/b ∫ max(0, w − h(z)) dz, where h is the deviation of both flanks above its smallest value. Where h is
//! piecewise quadratic Φ has a closed form (for crowning alone w t − C_β t³/3 with t = min(1, √(w/C_β))); other shapes
//! are cut into slices. Where h(−z) = h(z), only half of the face is used. Lengths in m. Must not know: stiffness, profile.

use crate::gear::modification::Design;
use crate::numeric::lobatto::Rule;

mod crown;
mod piece;

pub use crown::LineLaw;
pub use piece::Piece;

/// The deviation over the common face width of a pair.
#[derive(Clone, Debug)]
pub struct Face<'a> {
    /// The smallest deviation: what both flanks lose all along the face.
    pub offset: f64,
    /// The mean deviation above the smallest.
    pub mean: f64,
    /// z of the smallest deviation \[m\], the smallest of several; none where nothing varies, or slices do not know their places.
    pub lowest: Option<f64>,
    shape: DeviationForm,
    /// Where slices lie on a smooth stretch.
    rule: &'a Rule,
}

#[derive(Clone, Debug, PartialEq)]
enum DeviationForm {
    Flat,
    Quadratic(Vec<Piece>),
    /// Share of the width and deviation of each slice.
    Sliced(Vec<(f64, f64)>),
}

impl<'a> Face<'a> {
    /// The common face of width `width`, centred, of gears with this design. `rule` places the slices where something
    /// has no closed form: on the part of each quadratic stretch that is in contact, or on each stretch of another kind.
    #[must_use]
    pub fn new(design: &Design, width: f64, rule: &'a Rule) -> Self {
        Self::between(design, [-0.5 * width, 0.5 * width], rule)
    }

    /// The same for the part of the face between two z.
    #[must_use]
    pub fn between(design: &Design, [from, to]: [f64; 2], rule: &'a Rule) -> Self {
        let width = to - from;
        let parts = || design.pinion.iter().chain(&design.gear).map(|part| &part.modification);
        if design.tilt == 0.0 && !parts().any(|part| part.varies_along_face()) {
            return Self::flat(rule);
        }
        #[allow(clippy::float_cmp)] // the middle of the face is 0 only where it was put there
        let even = from == -to && design.lead_is_even();
        let cuts = cuts(design, [from, to]);
        let quadratic = |z: f64| {
            parts().map(|part| part.lead_quadratic(z)).try_fold([0.0, design.tilt, 0.0], |sum, part| {
                part.map(|part| [sum[0] + part[0], sum[1] + part[1], sum[2] + part[2]])
            })
        };
        let stretches = || cuts.windows(2).map(|cut| (cut[0], cut[1]));
        let polynomials: Option<Vec<_>> = stretches().map(|(from, to)| quadratic(0.5 * (from + to))).collect();
        match polynomials {
            Some(polynomials) => Self::quadratic(stretches().zip(polynomials), width, rule, even),
            None => Self::sliced(stretches(), width, rule, even, |z| design.lead(z)),
        }
    }

    /// One across which nothing varies.
    #[must_use]
    pub fn flat(rule: &'a Rule) -> Self {
        Self { offset: 0.0, mean: 0.0, lowest: None, shape: DeviationForm::Flat, rule }
    }

    /// One whose deviations are known slice by slice: shares of the width, and deviations that count from `lowest`.
    #[must_use]
    pub fn of_slices(mut slices: Vec<(f64, f64)>, lowest: f64, rule: &'a Rule) -> Self {
        for slice in &mut slices {
            slice.1 -= lowest;
        }
        let mean = slices.iter().map(|slice| slice.0 * slice.1).sum();
        Self { offset: lowest, mean, lowest: None, shape: DeviationForm::Sliced(slices), rule }
    }

    /// Where slices lie across a face on which anything may vary: shares of the width, and z \[m\].
    #[must_use]
    pub fn places(design: &Design, [from, to]: [f64; 2], rule: &Rule) -> Vec<(f64, f64)> {
        let cuts = cuts(design, [from, to]);
        let stretches = cuts.windows(2).map(|cut| (cut[0], cut[1]));
        slices(stretches, rule).into_iter().map(|(length, z)| (length / (to - from), z)).collect()
    }

    fn quadratic(
        stretches: impl Iterator<Item = ((f64, f64), [f64; 3])>,
        width: f64,
        rule: &'a Rule,
        even: bool,
    ) -> Self {
        let mut pieces = Vec::with_capacity(4);
        // Half of an even face stands for both.
        let width = if even { 0.5 * width } else { width };
        for ((from, to), polynomial) in stretches.filter(|((from, _), _)| !even || *from < 0.0) {
            let to = if even { to.min(0.0) } else { to };
            let vertex = -0.5 * polynomial[1] / polynomial[2];
            if vertex > from && vertex < to {
                pieces.push(Piece::new(polynomial, from, vertex, width));
                pieces.push(Piece::new(polynomial, vertex, to, width));
            } else {
                pieces.push(Piece::new(polynomial, from, to, width));
            }
        }
        let offset = pieces.iter().map(|piece| piece.base).fold(f64::INFINITY, f64::min);
        for piece in &mut pieces {
            piece.base -= offset;
        }
        let mean = pieces.iter().map(Piece::mean).sum();
        let lower =
            |one: &'_ Piece, other: &'_ Piece| other.base < one.base || (other.base <= one.base && other.low < one.low);
        let lowest =
            pieces.iter().reduce(|one, other| if lower(one, other) { other } else { one }).map(|piece| piece.low);
        Self { offset, mean, lowest, shape: DeviationForm::Quadratic(pieces), rule }
    }

    fn sliced(
        stretches: impl Iterator<Item = (f64, f64)>,
        width: f64,
        rule: &'a Rule,
        even: bool,
        lead: impl Fn(f64) -> f64,
    ) -> Self {
        let places = slices(stretches, rule);
        // Of an even face the first half stands for both, and an odd place in the middle for itself.
        let kept = if even { places.len().div_ceil(2) } else { places.len() };
        let share = |index: usize| if index == places.len() - 1 - index || !even { 1.0 } else { 2.0 };
        let slice = |(index, (length, z)): (usize, &(f64, f64))| (share(index) * length / width, lead(*z));
        let found: Vec<(f64, f64)> = places[..kept].iter().enumerate().map(slice).collect();
        let lower = |one: usize, other: usize| if found[other].1 < found[one].1 { other } else { one };
        let Some(slice) = (0..kept).reduce(lower) else { return Self::flat(rule) };
        let (lowest, place) = (found[slice].1, places[slice].1);
        Self { lowest: Some(place), ..Self::of_slices(found, lowest, rule) }
    }

    /// Whether both flanks run parallel across the face.
    #[must_use]
    pub fn is_flat(&self) -> bool {
        self.shape == DeviationForm::Flat
    }

    /// Whether its shape itself is cut into slices.
    #[must_use]
    pub fn is_sliced(&self) -> bool {
        matches!(self.shape, DeviationForm::Sliced(_))
    }

    /// How many slices a width mean is summed over.
    #[must_use]
    pub fn slices(&self) -> usize {
        match &self.shape {
            DeviationForm::Flat => 1,
            DeviationForm::Quadratic(pieces) => pieces.len() * self.rule.nodes.len(),
            DeviationForm::Sliced(slices) => slices.len(),
        }
    }

    /// How many slices [`Face::passed`] is summed over: 1 where it has a closed form.
    #[must_use]
    pub fn slices_passed(&self) -> usize {
        if self.is_sliced() { self.slices() } else { 1 }
    }

    /// Penetrations > 0 at which a stretch begins to touch or has come into contact all along: Φ is not smooth there.
    #[must_use]
    pub fn levels(&self) -> Vec<f64> {
        let DeviationForm::Quadratic(pieces) = &self.shape else { return Vec::new() };
        let mut levels: Vec<f64> = pieces.iter().flat_map(|piece| [piece.base, piece.base + piece.rise]).collect();
        levels.retain(|level| *level > 0.0);
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        levels
    }

    /// The stretch that stands for all of the face, if one does: of a flat or a crowned one.
    #[must_use]
    #[inline]
    pub fn one_piece(&self) -> Option<&Piece> {
        match &self.shape {
            DeviationForm::Flat => Some(&Piece::FLAT),
            DeviationForm::Quadratic(pieces) if pieces.len() == 1 => pieces.first(),
            _ => None,
        }
    }

    /// Φ(w) and dΦ/dw, the share of the face in contact, for w > 0.
    #[must_use]
    #[inline]
    pub fn passed(&self, penetration: f64) -> (f64, f64) {
        match &self.shape {
            DeviationForm::Flat => (penetration, 1.0),
            DeviationForm::Quadratic(pieces) => {
                let (mut sum, mut share) = (0.0, 0.0);
                for piece in pieces {
                    let (part, width) = piece.passed(penetration);
                    sum += part;
                    share += width;
                }
                (sum, share)
            }
            DeviationForm::Sliced(_) => self.summed(penetration, |_, depth| (depth, 1.0)),
        }
    }

    /// Width means of `response` (value and slope of a slice, by its place among all, at a local penetration > 0), by slices.
    /// The slope is that of the sum itself, whose slices move as the contact widens: Newton's method for pairs that nearly
    /// share their deflection takes more of its digits than slices give the integral of slopes.
    #[must_use]
    pub fn summed(&self, penetration: f64, mut response: impl FnMut(usize, f64) -> (f64, f64)) -> (f64, f64) {
        let (mut sum, mut slope, mut slice) = (0.0, 0.0, 0);
        let mut add = |share: f64, depth: f64, [widening, sinking]: [f64; 2]| {
            if depth > 0.0 {
                let (value, rise) = response(slice, depth);
                sum += share * value;
                slope += widening * value + share * sinking * rise;
            }
            slice += 1;
        };
        match &self.shape {
            DeviationForm::Flat => add(1.0, penetration, [0.0, 1.0]),
            DeviationForm::Quadratic(pieces) => {
                for piece in pieces {
                    let depth = penetration - piece.base;
                    if depth <= 0.0 {
                        continue;
                    }
                    let reach = piece.reach(depth);
                    let rate = piece.widening(depth, reach);
                    for (node, weight) in self.rule.nodes.iter().zip(&self.rule.weights) {
                        let distance = reach * node;
                        let rise = distance * (piece.slope + distance * piece.bend);
                        let sinking = 1.0 - node * rate * (piece.slope + 2.0 * distance * piece.bend);
                        add(piece.weight * reach * weight, depth - rise, [piece.weight * rate * weight, sinking]);
                    }
                }
            }
            DeviationForm::Sliced(slices) => {
                for (share, deviation) in slices {
                    add(*share, penetration - deviation, [0.0, 1.0]);
                }
            }
        }
        (sum, slope)
    }

    /// The mean load per width under a penetration > 0, and its slope, of slices that follow `law`; of crowns by its loads.
    #[must_use]
    pub fn carried(&self, penetration: f64, law: &mut impl LineLaw) -> (f64, f64) {
        let by_loads = self.by_loads(penetration, [&self.rule.nodes, &self.rule.weights], law);
        by_loads.unwrap_or_else(|| self.summed(penetration, |slice, depth| law.load(slice, depth)))
    }

    /// The same with some 1e-6 left; none where it takes no less.
    #[must_use]
    pub fn carried_about(&self, penetration: f64, law: &mut impl LineLaw) -> Option<(f64, f64)> {
        (self.rule.nodes.len() > crown::FEW[0].len()).then(|| self.by_loads(penetration, crown::FEW, law)).flatten()
    }

    /// None where it is not made of crowns.
    fn by_loads(&self, penetration: f64, nodes: [&[f64]; 2], law: &mut impl LineLaw) -> Option<(f64, f64)> {
        let DeviationForm::Quadratic(pieces) = &self.shape else { return None };
        if !pieces.iter().all(|piece| piece.is_crown(penetration - piece.base, nodes)) {
            return None;
        }
        let (mut sum, mut slope) = (0.0, 0.0);
        for (index, piece) in pieces.iter().enumerate() {
            let depth = penetration - piece.base;
            if depth > 0.0 {
                let (part, rise) = piece.carried(depth, nodes, [index, pieces.len() + index], law);
                sum += part;
                slope += rise;
            }
        }
        Some((sum, slope))
    }
}

/// Both ends, and what is not smooth between them.
fn cuts(design: &Design, [from, to]: [f64; 2]) -> Vec<f64> {
    let parts = design.pinion.iter().chain(&design.gear);
    let inside = parts.flat_map(|part| part.modification.lead_breaks()).copied().filter(|z| *z > from && *z < to);
    let mut cuts: Vec<f64> = [from, to].into_iter().chain(inside).collect();
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    cuts
}

/// Lengths and places of the slices of smooth stretches.
fn slices(stretches: impl Iterator<Item = (f64, f64)>, rule: &Rule) -> Vec<(f64, f64)> {
    let place = |(from, to): (f64, f64)| {
        let nodes = rule.nodes.iter().zip(&rule.weights);
        nodes.map(move |(node, weight)| (weight * (to - from), from + (to - from) * node))
    };
    stretches.flat_map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gear::fixtures::{NamedModification, design, pair};
    use declare::record::Value::{Choice, Number, Quantity};

    const WIDTH: f64 = 18e-3;

    fn designs() -> Vec<Design> {
        let amount = |value: f64| ("amount", Quantity(value));
        let end = |curve| [amount(9e-6), ("length", Quantity(5e-3)), ("curve", Choice(curve))];
        let one_end = [amount(4e-6), ("length", Quantity(12e-3)), ("curve", Choice("parabolic")), ("end", Choice("I"))];
        let pair = pair();
        let of = |parts: &[NamedModification]| design(&pair, parts).unwrap();
        vec![
            of(&[("lead_crowning", "pinion", &[amount(8e-6)])]),
            of(&[("helix_slope", "gear", &[amount(-6e-6)])]),
            of(&[("lead_crowning", "pinion", &[amount(8e-6)]), ("helix_slope", "gear", &[amount(5e-6)])]),
            of(&[("end_relief", "gear", &end("linear"))]),
            of(&[("end_relief", "pinion", &end("parabolic")), ("lead_crowning", "both", &[amount(3e-6)])]),
            of(&[("end_relief", "gear", &one_end), ("helix_slope", "pinion", &[amount(40e-6)])]),
        ]
    }

    #[test]
    fn the_closed_form_agrees_with_fine_slices_of_the_deviation() {
        let rule = Rule::new(17);
        for (index, design) in designs().iter().enumerate() {
            let face = Face::new(design, WIDTH, &rule);
            let count = 200_000;
            let heights: Vec<f64> =
                (0..count).map(|i| design.lead(WIDTH * ((f64::from(i) + 0.5) / f64::from(count) - 0.5))).collect();
            let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
            assert!((face.offset - lowest).abs() < 1e-9, "{index}");
            let mean = heights.iter().map(|h| h - face.offset).sum::<f64>() / f64::from(count);
            assert!((face.mean / mean - 1.0).abs() < 1e-7, "{index}");
            for penetration in [1e-8, 3e-7, 2e-6, 5e-6, 9e-6, 30e-6, 1e-3] {
                let depths = heights.iter().map(|h| (penetration + face.offset - h).max(0.0));
                let exact = depths.clone().sum::<f64>() / f64::from(count);
                let share = depths.filter(|depth| *depth > 0.0).count() as f64 / f64::from(count);
                let (passed, width) = face.passed(penetration);
                let grid = 1e-7 + 1.0 / (share * f64::from(count)) / (share * f64::from(count));
                assert!((passed / exact - 1.0).abs() < grid, "{index} {penetration}: {passed:e} {exact:e}");
                assert!((width - share).abs() < 2e-5, "{index} {penetration}: {width} {share}");
                let (summed, _) = face.summed(penetration, |_, depth| (depth, 1.0));
                assert!((summed / passed - 1.0).abs() < 1e-12, "slices are exact for what is quadratic");
            }
        }
    }

    /// The slope of a sum over few slices of a law that is not a polynomial is that of the sum, not of the integral. Central
    /// differences show it, since seventeen slices of w/(1 − ln w) are off by 1e-4.
    #[test]
    fn the_slope_is_that_of_the_sum_of_slices() {
        let law = |_: usize, w: f64| {
            let total = 1.0 - libm::log(w / 1e-3);
            (w / total, (1.0 + 1.0 / total) / total)
        };
        let rule = Rule::new(9);
        for (index, design) in designs().iter().enumerate() {
            let face = Face::new(design, WIDTH, &rule);
            for penetration in [1e-8, 3e-7, 2.5e-6, 7e-6, 60e-6] {
                let step = 1e-5 * penetration;
                let [below, above] = [-step, step].map(|step| face.summed(penetration + step, law).0);
                let (_, slope) = face.summed(penetration, law);
                let ratio = slope * 2.0 * step / (above - below);
                assert!((ratio - 1.0).abs() < 1e-8, "{index} {penetration}: {ratio}");
            }
        }
    }

    #[test]
    fn crowning_alone_is_the_known_formula_down_to_vanishing_penetration() {
        let rule = Rule::new(5);
        let pair = pair();
        for crown in [1e-300, 1e-15, 8e-6] {
            let face = Face::new(
                &design(&pair, &[("lead_crowning", "gear", &[("amount", Quantity(crown))])]).unwrap(),
                WIDTH,
                &rule,
            );
            for penetration in [1e-25, 1e-12, 3e-6, 7.999e-6, 8e-6, 1e-3] {
                let t = f64::min(1.0, f64::sqrt(penetration / crown));
                let exact = penetration * t - crown * t * t * t / 3.0;
                assert!((face.passed(penetration).0 / exact - 1.0).abs() < 1e-13, "{crown} {penetration}");
            }
        }
    }

    #[test]
    fn other_curves_are_sliced_and_agree_where_they_are_quadratic_after_all() {
        let pair = pair();
        let relief = |exponent: f64| {
            let values = [
                ("amount", Quantity(9e-6)),
                ("length", Quantity(5e-3)),
                ("curve", Choice("power")),
                ("exponent", Number(exponent)),
            ];
            design(&pair, &[("end_relief", "both", &values)]).unwrap()
        };
        let rule = Rule::new(400);
        let (quadratic, near) = (Face::new(&relief(2.0), WIDTH, &rule), Face::new(&relief(2.0 + 1e-9), WIDTH, &rule));
        assert!(matches!((&quadratic.shape, &near.shape), (DeviationForm::Quadratic(_), DeviationForm::Sliced(_))));
        for penetration in [1e-6, 4e-6, 30e-6] {
            let ratio = quadratic.passed(penetration).0 / near.passed(penetration).0;
            assert!((ratio - 1.0).abs() < 5e-6, "{ratio}");
        }
    }
}
