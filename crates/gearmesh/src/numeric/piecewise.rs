//! A function that is smooth between known breaks as polynomials: its quick copy where it is evaluated some hundred times.
//!
//! A stretch is followed by a polynomial of degree 6 or else, with as many nodes between, of degree 12; what neither follows
//! is halved, a few times, and what is left then has no copy. Nodes are where T_12 is 1 or −1, every other of which is one of
//! T_6, so that pieces meet at their ends as the function does. Source: Trefethen, Approximation Theory
//! and Approximation Practice, chapters 2 and 3. Must not know: what the function is.

use std::f64::consts::PI;

const TERMS: usize = 13;
/// Those of the polynomial that is tried first.
const FEW: usize = TERMS / 2 + 1;
/// How often a stretch is halved.
const HALVINGS: u32 = 4;
/// Where a polynomial is compared with the function: between two nodes near the ends, where interpolation errs the most, and
/// near the middle.
const PROBES: [f64; 3] = [-0.924, 0.924, 0.13];
/// How much larger than what may be left the last coefficient is where no comparison is needed: the polynomial does not follow.
const HOPELESS: f64 = 1e3;

/// Nodes on −1..=1, and what makes coefficients of values there.
#[derive(Clone, Debug)]
pub struct Rule {
    nodes: [f64; TERMS],
    to_few: [[f64; FEW]; FEW],
    to_coefficients: [[f64; TERMS]; TERMS],
}

/// How far a copy may be off.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    /// Of the largest value on each piece.
    pub relative: f64,
    /// Beside that: what the function itself is rounded to.
    pub absolute: f64,
}

/// The copy.
#[derive(Clone, Debug, Default)]
pub struct Piecewise {
    lower: f64,
    pieces: Vec<Piece>,
    index: Option<Index>,
}

/// Where to look for the piece of a place.
#[derive(Clone, Debug)]
struct Index {
    per_bin: f64,
    /// For each of equal parts of the range a piece that does not lie behind its beginning.
    first: [u8; BINS],
}

#[derive(Clone, Copy, Debug)]
struct Piece {
    upper: f64,
    middle: f64,
    per_half: f64,
    follows: Follows,
    /// Of Chebyshev's polynomials of the distance from the middle, in halves of the piece.
    coefficients: [f64; TERMS],
}

/// Equal parts of the range, each of which knows where to look.
const BINS: usize = 64;
const LAST_BIN: u32 = 63;

/// What follows the function on a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Follows {
    /// No polynomial does.
    Nothing,
    /// It is 0.
    Zero,
    /// The first few polynomials.
    Few,
    All,
}

impl Rule {
    /// The nodes and their matrix, the same for any function.
    #[must_use]
    pub fn new() -> Self {
        let last = TERMS - 1;
        Self {
            // Ascending: of the angles π, …, 0.
            nodes: std::array::from_fn(|index| libm::cos(PI * (last - index) as f64 / last as f64)),
            to_few: to_coefficients(),
            to_coefficients: to_coefficients(),
        }
    }
}

/// For each node of the last of so many polynomials, what a value there adds to the coefficients.
fn to_coefficients<const N: usize>() -> [[f64; N]; N] {
    let last = N - 1;
    let cosine = |multiple: usize| libm::cos(PI * (multiple % (2 * last)) as f64 / last as f64);
    let half_at_ends = |index: usize| if index == 0 || index == last { 0.5 } else { 1.0 };
    let coefficient = |order: usize, index: usize| {
        2.0 / last as f64 * half_at_ends(order) * half_at_ends(index) * cosine(order * (last - index))
    };
    std::array::from_fn(|index| std::array::from_fn(|order| coefficient(order, index)))
}

/// The coefficients of the polynomial through values at its nodes; those of higher order are 0.
fn fitted<const N: usize>(to_coefficients: &[[f64; N]; N], values: impl Fn(usize) -> f64) -> [f64; TERMS] {
    let mut sums = [0.0; N];
    for (index, parts) in to_coefficients.iter().enumerate() {
        let value = values(index);
        for (sum, part) in sums.iter_mut().zip(parts) {
            *sum += part * value;
        }
    }
    let mut coefficients = [0.0; TERMS];
    coefficients[..N].copy_from_slice(&sums);
    coefficients
}

impl Default for Rule {
    fn default() -> Self {
        Self::new()
    }
}

impl Piecewise {
    /// A copy from `lower` on, to which stretches are added.
    #[must_use]
    pub fn from(lower: f64) -> Self {
        Self { lower, pieces: Vec::new(), index: None }
    }

    /// Adds the stretch up to `upper`, on which `function` is smooth. `quick` is what it is believed to be there, at less
    /// cost; the copy is made of it, as long as it is found to be that. Where the function is not finite there is no copy.
    pub fn push(
        &mut self,
        rule: &Rule,
        upper: f64,
        tolerance: Tolerance,
        quick: impl Fn(f64) -> f64,
        function: impl Fn(f64) -> f64,
    ) {
        let lower = self.upper();
        self.index = None;
        if upper > lower && !self.follow(rule, [lower, upper], tolerance, quick, &function) {
            self.halve(rule, [lower, upper], tolerance, HALVINGS, &function);
        }
    }

    /// Leaves a stretch up to `upper` without a copy.
    pub fn skip(&mut self, upper: f64) {
        if upper > self.upper() {
            let (follows, coefficients) = (Follows::Nothing, [0.0; TERMS]);
            self.pieces.push(Piece { upper, middle: upper, per_half: 0.0, follows, coefficients });
        }
    }

    /// The same, prepared for many values. No more stretches are added.
    #[must_use]
    pub fn indexed(mut self) -> Self {
        let width = (self.upper() - self.lower) / BINS as f64;
        if width > 0.0 && self.pieces.len() < usize::from(u8::MAX) {
            let mut first = [0; BINS];
            let mut piece: u8 = 0;
            for (bin, first) in first.iter_mut().enumerate() {
                // One bin earlier than it seems, for rounding.
                let begin = self.lower + width * (bin as f64 - 1.0);
                while self.pieces[usize::from(piece)].upper < begin {
                    piece += 1;
                }
                *first = piece;
            }
            self.index = Some(Index { per_bin: 1.0 / width, first });
        }
        self
    }

    /// The piece of a place that is not below the lower end.
    #[inline]
    fn piece(&self, x: f64) -> Option<&Piece> {
        let Some(Index { per_bin, first }) = &self.index else {
            return self.pieces.get(self.pieces.partition_point(|piece| piece.upper < x));
        };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // what is too large is the last bin
        let bin = (((x - self.lower) * per_bin) as u32).min(LAST_BIN) as usize;
        self.pieces[usize::from(first[bin])..].iter().find(|piece| x <= piece.upper)
    }

    /// How many polynomials there are, stretches without a copy among them.
    #[cfg(test)]
    pub(crate) fn pieces(&self) -> usize {
        self.pieces.len()
    }

    fn upper(&self) -> f64 {
        self.pieces.last().map_or(self.lower, |piece| piece.upper)
    }

    /// In two parts, as often as that is allowed and needed.
    fn halve(
        &mut self,
        rule: &Rule,
        [lower, upper]: [f64; 2],
        tolerance: Tolerance,
        halvings: u32,
        function: &impl Fn(f64) -> f64,
    ) {
        let middle = 0.5 * (lower + upper);
        if halvings == 0 || middle <= lower || middle >= upper {
            self.skip(upper);
            return;
        }
        for ends in [[lower, middle], [middle, upper]] {
            if !self.follow(rule, ends, tolerance, function, function) {
                self.halve(rule, ends, tolerance, halvings - 1, function);
            }
        }
    }

    /// One piece, if a polynomial follows there.
    fn follow(
        &mut self,
        rule: &Rule,
        [lower, upper]: [f64; 2],
        tolerance: Tolerance,
        quick: impl Fn(f64) -> f64,
        function: impl Fn(f64) -> f64,
    ) -> bool {
        let (middle, half) = (0.5 * (lower + upper), 0.5 * (upper - lower));
        // The ends themselves, not what rounding makes of them.
        let place = |index: usize| match index {
            0 => lower,
            index if index + 1 == TERMS => upper,
            index => middle + half * rule.nodes[index],
        };
        let mut values = [0.0; TERMS];
        for index in (0..TERMS).step_by(2) {
            values[index] = quick(place(index));
        }
        let size = values.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        let allowed = tolerance.relative * size + tolerance.absolute;
        let is_close = |coefficients: &[f64; TERMS], last: f64| {
            let off = |t: f64| (value(coefficients, t) - function(middle + half * t)).abs();
            last.abs() <= HOPELESS * allowed && PROBES.into_iter().all(|t| off(t) <= allowed)
        };
        let mut coefficients = fitted(&rule.to_few, |index| values[2 * index]);
        let mut found = is_close(&coefficients, coefficients[FEW - 1]);
        let mut follows = if size == 0.0 { Follows::Zero } else { Follows::Few };
        if !found {
            for index in (1..TERMS).step_by(2) {
                values[index] = quick(place(index));
            }
            coefficients = fitted(&rule.to_coefficients, |index| values[index]);
            found = is_close(&coefficients, coefficients[TERMS - 1]);
            follows = Follows::All;
        }
        if found {
            self.pieces.push(Piece { upper, middle, per_half: 1.0 / half, follows, coefficients });
        }
        found
    }

    /// The value at `x`; none where there is no copy.
    #[must_use]
    #[inline]
    pub fn value(&self, x: f64) -> Option<f64> {
        if x < self.lower {
            return None;
        }
        let piece = self.piece(x)?;
        let place = || (x - piece.middle) * piece.per_half;
        match piece.follows {
            Follows::Nothing => None,
            Follows::Zero => Some(0.0),
            Follows::Few => Some(few(&piece.coefficients, place())),
            Follows::All => Some(value(&piece.coefficients, place())),
        }
    }
}

impl Piecewise {
    /// The values at ascending places, if one piece has them all: each as [`Piecewise::value`] has it.
    #[must_use]
    #[inline]
    pub fn values<const M: usize>(&self, x: &[f64; M]) -> Option<[f64; M]> {
        if x[0] < self.lower {
            return None;
        }
        let piece = self.piece(x[0]).filter(|piece| x[M - 1] <= piece.upper)?;
        let mut values = [0.0; M];
        match piece.follows {
            Follows::Nothing => return None,
            Follows::Zero => (),
            Follows::Few => piece.each(x, &mut values, few),
            Follows::All => piece.each(x, &mut values, value),
        }
        Some(values)
    }
}

impl Piece {
    /// The values of its polynomials at several places.
    #[inline]
    fn each<const M: usize>(&self, x: &[f64; M], values: &mut [f64; M], of: impl Fn(&[f64; TERMS], f64) -> f64) {
        for m in 0..M {
            values[m] = of(&self.coefficients, (x[m] - self.middle) * self.per_half);
        }
    }
}

/// The first few polynomials, as in [`value`].
#[inline]
fn few([c0, c1, c2, c3, c4, c5, c6, ..]: &[f64; TERMS], t: f64) -> f64 {
    let t2 = 2.0 * t * t - 1.0;
    let (t3, t4) = (2.0 * t * t2 - t, 2.0 * t2 * t2 - 1.0);
    let (t5, t6) = (2.0 * t2 * t3 - t, 2.0 * t3 * t3 - 1.0);
    (c0 + c1 * t) + (c2 * t2 + c3 * t3) + ((c4 * t4 + c5 * t5) + c6 * t6)
}

/// The polynomials by T_(j+k) + T_(j−k) = 2 T_j T_k: short chains of dependent operations.
#[inline]
fn value([c0, c1, c2, c3, c4, c5, c6, c7, c8, c9, c10, c11, c12]: &[f64; TERMS], t: f64) -> f64 {
    let t2 = 2.0 * t * t - 1.0;
    let (t3, t4) = (2.0 * t * t2 - t, 2.0 * t2 * t2 - 1.0);
    let (t5, t6) = (2.0 * t2 * t3 - t, 2.0 * t3 * t3 - 1.0);
    let (t7, t8, t9) = (2.0 * t3 * t4 - t, 2.0 * t4 * t4 - 1.0, 2.0 * t4 * t5 - t);
    let (t10, t11, t12) = (2.0 * t5 * t5 - 1.0, 2.0 * t5 * t6 - t, 2.0 * t6 * t6 - 1.0);
    let low = (c0 + c1 * t) + (c2 * t2 + c3 * t3);
    let middle = (c4 * t4 + c5 * t5) + (c6 * t6 + c7 * t7);
    low + (middle + ((c8 * t8 + c9 * t9) + (c10 * t10 + (c11 * t11 + c12 * t12))))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn copy(breaks: &[f64], function: impl Fn(f64) -> f64) -> Piecewise {
        let (rule, tolerance) = (Rule::new(), Tolerance { relative: 1e-9, absolute: 0.0 });
        let mut copy = Piecewise::from(breaks[0]);
        for upper in &breaks[1..] {
            copy.push(&rule, *upper, tolerance, &function, &function);
        }
        copy
    }

    /// Tier: closed form, on pieces that no polynomial of low degree follows as a whole.
    #[test]
    fn every_piece_is_followed_as_well_as_was_asked() {
        let function = |x: f64| if x < 0.3 { libm::exp(x) } else { 0.9 * libm::exp(0.6 - x) / (1.2 - x) };
        let copy = copy(&[-1.0, 0.3, 1.0], function);
        for index in 0..=2000 {
            let x = -1.0 + 1e-3 * f64::from(index);
            let off = copy.value(x).map(|value| (value / function(x) - 1.0).abs());
            assert!(off.is_some_and(|off| off < 3e-9), "{x}: {off:?}");
        }
        assert!([-1.0 - 1e-12, 1.0 + 1e-12].into_iter().all(|outside| copy.value(outside).is_none()));
        assert!(copy.pieces.len() > 2, "the second piece was halved");
        let indexed = copy.clone().indexed();
        for index in -5000..=5000 {
            let x = 2e-4 * f64::from(index) * (1.0 + 1e-3 * f64::from(index % 7));
            assert_eq!(indexed.value(x).map(f64::to_bits), copy.value(x).map(f64::to_bits), "{x}");
        }
        for piece in &copy.pieces {
            assert_eq!(indexed.value(piece.upper).map(f64::to_bits), copy.value(piece.upper).map(f64::to_bits));
        }
    }

    /// What is not smooth has a copy all around the place where it is not.
    #[test]
    fn where_no_polynomial_follows_there_is_no_copy() {
        let steps = copy(&[0.0, 1.0], |x| if x < 0.03 { 1.0 } else { libm::exp(x) });
        assert!(steps.value(0.02).is_none() && steps.value(0.07).is_some());
        let ends = copy(&[0.0, 1.0], |x| if x < 0.5 { x } else { f64::NAN });
        assert!(ends.value(0.1).is_some() && ends.value(0.9).is_none());
        assert!(Piecewise::default().value(0.0).is_none());
        assert_eq!(copy(&[0.0, 1.0], |_| 0.0).value(0.7), Some(0.0));
    }

    /// Tier: closed form; each polynomial gives its own coefficient alone.
    #[test]
    fn values_give_the_coefficients_of_chebyshev_s_polynomials() {
        let rule = Rule::new();
        for degree in 0..TERMS {
            let function = |x: f64| libm::cos(degree as f64 * libm::acos(x.clamp(-1.0, 1.0)));
            let values = rule.nodes.map(function);
            let coefficients = fitted(&rule.to_coefficients, |index| values[index]);
            for (order, found) in coefficients.iter().enumerate() {
                assert!((found - f64::from(u8::from(order == degree))).abs() < 2e-15, "{degree}, {order}: {found}");
            }
            for x in [-1.0, -0.77, 0.0, 0.31, 1.0] {
                assert!((value(&coefficients, x) - function(x)).abs() < 1e-14, "{degree} at {x}");
                assert!(degree >= FEW || (few(&coefficients, x) - function(x)).abs() < 1e-14, "{degree} at {x}");
            }
        }
    }

    /// What was believed is not taken for the function where it is not the function.
    #[test]
    fn a_wrong_belief_is_found_out() {
        let (rule, tolerance) = (Rule::new(), Tolerance { relative: 1e-9, absolute: 0.0 });
        let mut copy = Piecewise::from(0.0);
        copy.push(&rule, 1.0, tolerance, |x| 1.0 + x + 1e-8, |x| 1.0 + x);
        assert!(copy.value(0.7).is_some_and(|value| (value - 1.7).abs() < 1e-15), "{copy:?}");
    }
}
