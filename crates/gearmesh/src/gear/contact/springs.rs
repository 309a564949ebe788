//! The tooth pairs at one mesh position as springs behind gaps.
//!
//! Stiffness in N/m over the common face width. Must not know: where in the mesh cycle the position is.

use std::cell::{Cell, OnceCell};

use super::face::Face;
use super::flattening::InSeries;
use super::plain::PlainLaw;
use crate::numeric::by_loads::{Yielded, Yielding};
use crate::numeric::complementarity::{MOST_SPRINGS, PerSpring, Springs};
use crate::numeric::logarithm::Known;

/// The deviations across the common face.
#[derive(Clone, Copy)]
pub enum Faces<'a> {
    /// Of all pairs alike.
    Same(&'a Face<'a>),
    /// Of one pair after the other.
    Each(&'a [Face<'a>]),
}

impl<'a> Faces<'a> {
    #[inline]
    fn of(self, pair: usize) -> &'a Face<'a> {
        match self {
            Self::Same(face) => face,
            Self::Each(faces) => &faces[pair],
        }
    }

    /// Whether the flanks run parallel across the face.
    pub fn are_flat(self) -> bool {
        matches!(self, Self::Same(face) if face.is_flat())
    }

    /// The largest mean deviation above the smallest \[m\].
    #[must_use]
    pub fn mean(self) -> f64 {
        match self {
            Self::Same(face) => face.mean,
            Self::Each(faces) => faces.iter().map(|face| face.mean).fold(0.0, f64::max),
        }
    }
}

/// Pairs with the linear contact law.
pub struct LinearPairs<'a> {
    /// Stiffness of each pair as if the face were flat \[N/m\].
    pub stiffness: PerSpring,
    /// The deviation across the common face.
    pub faces: Faces<'a>,
}

impl Springs for LinearPairs<'_> {
    #[inline]
    fn response(&self, pair: usize, penetration: f64) -> (f64, f64) {
        let (passed, share) = self.faces.of(pair).passed(penetration);
        (self.stiffness[pair] * passed, self.stiffness[pair] * share)
    }
}

/// Pairs with the load-dependent contact law. A slice that carries p has the penetration b·c·p + p(α − β ln p), c the
/// compliance of both teeth without the contact.
pub struct LogarithmicPairs<'p, 'a, F> {
    /// Contact and teeth of each pair, per width, as far as that is known at once.
    pub plain: [PlainLaw; MOST_SPRINGS],
    /// β of all pairs \[1/Pa\].
    pub rate: f64,
    /// The whole of it, once it was needed.
    pub whole: &'p [OnceCell<InSeries<'a>>; MOST_SPRINGS],
    /// Where that comes from.
    pub series: F,
    /// Common face width b \[m\].
    pub width: f64,
    /// The deviation across the common face.
    pub faces: Faces<'p>,
    /// Loads per width that each pair had last, or may have, and their logarithms.
    pub logs: [Cell<Known>; MOST_SPRINGS],
}

impl<'a, F: Fn(usize) -> InSeries<'a>> LogarithmicPairs<'_, 'a, F> {
    #[inline]
    fn slice(&self, pair: usize) -> &InSeries<'a> {
        self.whole[pair].get_or_init(|| (self.series)(pair))
    }

    /// The penetration at which a pair alone carries `total` or more, whatever the shape of the face: by the convexity
    /// of the response, that of a flat face plus the mean deviation.
    #[must_use]
    pub fn above(&self, pair: usize, total: f64) -> f64 {
        self.slice(pair).penetration(total / self.width) + self.faces.of(pair).mean
    }

    /// Next to a tip, or beyond what the law is made for.
    #[cold]
    fn beyond_plain(&self, pair: usize, known: Known) -> ([f64; 3], bool) {
        self.slice(pair).rates_at(known.number, known.log)
    }
}

impl<'a, F: Fn(usize) -> InSeries<'a>> Yielding for LogarithmicPairs<'_, 'a, F> {
    /// On a flat face.
    #[inline]
    fn penetration(&self, pair: usize, load: f64) -> Yielded {
        let known = self.logs[pair].get().next(load / self.width);
        self.logs[pair].set(known);
        let plain = &self.plain[pair];
        let ([penetration, slope, bend], is_rough) = if plain.holds(known.number) {
            (plain.rates_at(self.rate, known.number, known.log), false)
        } else {
            self.beyond_plain(pair, known)
        };
        let per_width = 1.0 / self.width;
        Yielded { penetration, rate: slope * per_width, bend: bend * (per_width * per_width), is_rough }
    }
}

impl<'a, F: Fn(usize) -> InSeries<'a>> Springs for LogarithmicPairs<'_, 'a, F> {
    fn response(&self, pair: usize, penetration: f64) -> (f64, f64) {
        let slice = self.slice(pair);
        let (load, slope) = self.faces.of(pair).summed(penetration, |depth| slice.load(depth));
        (self.width * load, self.width * slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gear::contact::flattening::Logarithmic;
    use crate::gear::fixtures::{STEELS, design, pair};
    use crate::numeric::lobatto::Rule;
    use declare::record::Value::Quantity;

    /// Tier: invariant; what is said to be above is: the pair carries the load there, with a face that is flat or not.
    #[test]
    fn a_pair_carries_the_load_at_the_penetration_above() {
        let rule = Rule::new(17);
        let law = Logarithmic::weber(&STEELS, 7e-3, [2.5e-3, 3e-3]).in_series(4e-11);
        for crown in [0.0, 2e-6, 30e-6] {
            let crowned = design(&pair(), &[("lead_crowning", "gear", &[("amount", Quantity(crown))])]).unwrap();
            let face = Face::new(&crowned, 18e-3, &rule);
            let logs = std::array::from_fn(|_| Cell::new(Known::new(1.0)));
            let whole = [const { OnceCell::new() }; MOST_SPRINGS];
            let (plain, rate, series) = ([PlainLaw::NONE; MOST_SPRINGS], law.law.rate, |_| law.clone());
            let pairs =
                LogarithmicPairs { plain, rate, whole: &whole, series, width: 18e-3, faces: Faces::Same(&face), logs };
            for load in [1.0, 300.0, 2e3, 1e5] {
                let carried = pairs.response(0, pairs.above(0, load)).0;
                assert!(carried >= load * (1.0 - 1e-12), "{carried} N of {load} N with a crown of {crown} m");
            }
        }
    }
}
