//! The tooth pairs at one mesh position as springs behind gaps.
//!
//! Stiffness in N/m over the common face width. Must not know: where in the mesh cycle the position is.

use std::cell::{Cell, OnceCell, RefCell, RefMut};

use super::face::{Face, LineLaw};
use super::flattening::InSeries;
use super::inverse::Inverse;
use super::plain::PlainLaw;
use crate::numeric::by_loads::{Yielded, Yielding};
use crate::numeric::complementarity::{PerSpring, Springs};
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
pub struct LogarithmicPairs<'p, 'a, F, const N: usize> {
    /// Contact and teeth of each pair, per width, as far as that is known at once.
    pub plain: [PlainLaw; N],
    /// β of all pairs \[1/Pa\], and its logarithm.
    pub rates: [f64; 2],
    /// The whole of it, once it was needed.
    pub whole: &'p [OnceCell<InSeries<'a>>; N],
    /// Where that comes from.
    pub series: F,
    /// Common face width b \[m\].
    pub width: f64,
    /// The deviation across the common face.
    pub faces: Faces<'p>,
    /// Loads per width that each pair had last, or may have, and their logarithms.
    pub logs: [Cell<Known>; N],
    /// Where on the law each slice of each pair, or end of a crown, was last.
    pub last: [RefCell<Vec<Inverse>>; N],
}

impl<'a, F: Fn(usize) -> InSeries<'a>, const N: usize> LogarithmicPairs<'_, 'a, F, N> {
    #[inline]
    fn slice(&self, pair: usize) -> &InSeries<'a> {
        self.whole[pair].get_or_init(|| (self.series)(pair))
    }

    /// The penetration at which a pair alone carries `total` or more, whatever the shape of the face: by the convexity
    /// of the response, that of a flat face plus the mean deviation.
    #[must_use]
    pub fn above(&self, pair: usize, total: f64) -> f64 {
        let (load, plain) = (total / self.width, &self.plain[pair]);
        let penetration = if plain.holds(load) && load > 0.0 {
            plain.rates_at(self.rates[0], load, libm::log(load))[0]
        } else {
            self.slice(pair).penetration(load)
        };
        penetration + self.faces.of(pair).mean
    }

    /// Of whole pairs.
    #[inline]
    fn yielded(&self, [penetration, slope, bend]: [f64; 3], is_rough: bool) -> Yielded {
        let per_width = 1.0 / self.width;
        Yielded { penetration, rate: slope * per_width, bend: bend * (per_width * per_width), is_rough }
    }

    /// At any load per width.
    #[inline]
    fn rates_at(&self, pair: usize, known: Known) -> ([f64; 3], bool) {
        let plain = &self.plain[pair];
        if plain.holds(known.number) {
            return (plain.rates_at(self.rates[0], known.number, known.log), false);
        }
        self.beyond_plain(pair, known)
    }

    fn law(&self, pair: usize) -> OfPair<'_, '_, 'a, F, N> {
        OfPair { pairs: self, pair, last: self.last[pair].borrow_mut() }
    }

    /// Where a slice of a pair is on the law, if nothing is known of places nearby.
    fn inverted(&self, pair: usize, penetration: f64) -> Inverse {
        let known = self.plain[pair].load(self.rates, penetration);
        Inverse::new(penetration, known.unwrap_or_else(|| self.slice(pair).load(penetration)))
    }

    /// Next to a tip, or beyond what the law is made for.
    #[cold]
    fn beyond_plain(&self, pair: usize, known: Known) -> ([f64; 3], bool) {
        self.slice(pair).rates_at(known.number, known.log)
    }
}

impl<'a, F: Fn(usize) -> InSeries<'a>, const N: usize> Yielding for LogarithmicPairs<'_, 'a, F, N> {
    /// On a flat face.
    #[inline]
    fn penetration(&self, pair: usize, load: f64) -> Yielded {
        let known = self.logs[pair].get().next(load / self.width);
        self.logs[pair].set(known);
        let (rates, is_rough) = self.rates_at(pair, known);
        self.yielded(rates, is_rough)
    }

    #[inline]
    fn about(&self, pair: usize, load: f64) -> Yielded {
        let known = self.logs[pair].get().next(load / self.width);
        let about = self.plain[pair].about(self.rates[0], known.number, known.log);
        about.map_or_else(|| self.penetration(pair, load), |rates| self.yielded(rates, true))
    }
}

impl<'a, F: Fn(usize) -> InSeries<'a>, const N: usize> Springs for LogarithmicPairs<'_, 'a, F, N> {
    fn response(&self, pair: usize, penetration: f64) -> (f64, f64) {
        let (load, slope) = self.faces.of(pair).carried(penetration, &mut self.law(pair));
        (self.width * load, self.width * slope)
    }

    fn response_about(&self, pair: usize, penetration: f64) -> Option<(f64, f64)> {
        let found = self.faces.of(pair).carried_about(penetration, &mut self.law(pair));
        found.map(|(load, slope)| (self.width * load, self.width * slope))
    }
}

/// The law of one of the pairs.
struct OfPair<'l, 'p, 'a, F, const N: usize> {
    pairs: &'l LogarithmicPairs<'p, 'a, F, N>,
    pair: usize,
    last: RefMut<'l, Vec<Inverse>>,
}

impl<'a, F: Fn(usize) -> InSeries<'a>, const N: usize> LineLaw for OfPair<'_, '_, 'a, F, N> {
    fn load(&mut self, place: usize, penetration: f64) -> (f64, f64) {
        let (pairs, pair) = (self.pairs, self.pair);
        // From where it was before, or else from the place beside it.
        let near = self.last.get(place).or(self.last.last());
        let found = near.and_then(|near| near.next(penetration, |load| pairs.rates_at(pair, load)));
        let found = found.unwrap_or_else(|| pairs.inverted(pair, penetration));
        if let Some(last) = self.last.get_mut(place) {
            *last = found;
        } else {
            self.last.push(found);
        }
        (found.load, found.slope)
    }

    #[inline]
    fn penetration(&self, load: Known) -> [f64; 2] {
        let ([penetration, slope, _], _) = self.pairs.rates_at(self.pair, load);
        [penetration, slope]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gear::contact::flattening::Logarithmic;
    use crate::gear::fixtures::{STEELS, design, pair};
    use crate::numeric::lobatto::Rule;
    use declare::record::Value::Quantity;

    /// Tier: invariant; what is said to be above is: the pair carries the load there, with a face that is flat or not, whether
    /// its law is known at once or not, which makes no difference.
    #[test]
    fn a_pair_carries_the_load_at_the_penetration_above() {
        let rule = Rule::new(17);
        let law = Logarithmic::weber(&STEELS, 7e-3, [2.5e-3, 3e-3]).in_series(4e-11);
        let known = PlainLaw { total: 4e-11 + law.law.constant, rest: 0.0, last: law.law.last() };
        for crown in [0.0, 2e-6, 30e-6] {
            let crowned = design(&pair(), &[("lead_crowning", "gear", &[("amount", Quantity(crown))])]).unwrap();
            let face = Face::new(&crowned, 18e-3, &rule);
            let rates = [law.law.rate, law.law.log_rate];
            let logs = || [Cell::new(Known::new(1.0))];
            let (whole, faces) = ([const { OnceCell::new() }; 1], Faces::Same(&face));
            let series = |_: usize| law.clone();
            let of = |plain, whole| LogarithmicPairs {
                plain: [plain],
                rates,
                whole,
                series,
                width: 18e-3,
                faces,
                logs: logs(),
                last: [RefCell::default()],
            };
            let none = [const { OnceCell::new() }; 1];
            let (slow, quick) = (of(PlainLaw::NONE, &whole), of(known, &none));
            for load in [1.0, 300.0, 2e3, 1e5] {
                let (above, at_once) = (slow.above(0, load), quick.above(0, load));
                assert!((at_once / above - 1.0).abs() < 1e-14, "{above} {at_once}");
                let carried = [slow.response(0, above), quick.response(0, above)];
                assert!(carried[0].0 >= load * (1.0 - 1e-12), "{carried:?} N of {load} N with a crown of {crown} m");
                assert!(
                    (carried[1].0 / carried[0].0 - 1.0).abs() < 1e-12
                        && (carried[1].1 / carried[0].1 - 1.0).abs() < 1e-11
                );
                let [one, other] = [slow.penetration(0, load), quick.penetration(0, load)];
                assert!((one.penetration / other.penetration - 1.0).abs() < 1e-14 && quick.about(0, load).is_rough);
            }
        }
        const { assert!(PlainLaw::NONE.last < 0.0) };
    }
}
