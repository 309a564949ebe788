//! Equilibria at several positions at once, of pairs that hold themselves: under the linear law on a face of one stretch, under
//! one that is known at once between parallel flanks.
//!
//! That is what most designs are that a search or a sweep tries. Each position has what it has alone, to the last bit. Must
//! not know: which positions are computed.

use super::load_case::{LoadCase, Regime};
use super::state::Equilibrium;
use crate::gear::contact::face::Piece;
use crate::gear::contact::plain::shared::{Shared, shared};
use crate::gear::contact::plain::{PlainLaw, PlainLaws};
use crate::gear::mesh::cycle::mesh::Elasticity;
use crate::numeric::complementarity::side_by_side::{balances, linear_approaches};
use crate::numeric::complementarity::{Balance, MOST_SPRINGS};
use crate::numeric::graded::Graded;

/// What all pairs have in common.
struct Alike<'a> {
    stiffness: &'a Graded,
    piece: &'a Piece,
}

impl LoadCase<'_> {
    /// Fills in equilibria at ascending positions with `pairs` inside the path of contact; nothing of any worth where there is
    /// more to them.
    #[inline]
    pub(in crate::gear::mesh) fn together<const M: usize>(
        &self,
        positions: &[f64; M],
        pairs: usize,
        found: &mut [Equilibrium; M],
    ) -> Option<()> {
        if !self.holds_pairs_on_line() {
            return None;
        }
        let Elasticity::Linear(stiffness) = &self.cycle.elasticity else {
            return self.of_plain_pairs(positions, pairs, found);
        };
        let alike = Alike { stiffness, piece: self.flanks.face.one_piece()? };
        match pairs {
            1 => self.alike::<1, M>(&alike, positions, found),
            2 => self.alike::<2, M>(&alike, positions, found),
            _ => return None,
        }
        Some(())
    }

    /// Whether pairs hold themselves, touch on the line of action only, are as far apart as their flanks say, and have the same
    /// face at every position.
    #[inline]
    pub(in crate::gear::mesh) fn holds_pairs_on_line(&self) -> bool {
        matches!(self.regime, Regime::Pairs)
            && self.touches_on_line()
            && self.is_evenly_spaced()
            && !self.flanks.is_surface
    }

    /// At ascending places on the line of action, where there always is one.
    #[inline]
    pub(in crate::gear::mesh) fn gaps_on_line<const M: usize>(&self, places: &[f64; M]) -> [f64; M] {
        self.flanks.quick_gaps(places).unwrap_or_else(|| places.map(|s| self.gap(s).unwrap_or(0.0)))
    }

    #[inline]
    fn alike<const N: usize, const M: usize>(
        &self,
        alike: &Alike,
        positions: &[f64; M],
        states: &mut [Equilibrium; M],
    ) {
        self.count.solves(M);
        let (mut stiffness, mut gaps) = ([[0.0; M]; N], [[0.0; M]; N]);
        let mut smallest = [f64::INFINITY; M];
        for spring in 0..N {
            let places = positions.map(|position| self.cycle.path_position(position, spring));
            stiffness[spring] = places.map(|s| alike.stiffness.value(s));
            gaps[spring] = self.gaps_on_line(&places);
            for m in 0..M {
                smallest[m] = smallest[m].min(gaps[spring][m]);
            }
        }
        for gaps in &mut gaps {
            for m in 0..M {
                gaps[m] -= smallest[m];
            }
        }
        let mean = self.flanks.face.mean;
        let above = linear_approaches(&stiffness, &gaps, self.force).map(|approach| approach + mean);
        let responses = |spring: usize, penetration: &[f64; M]| {
            let (mut loads, mut rises) = ([0.0; M], [0.0; M]);
            for m in 0..M {
                let (passed, share) = alike.piece.passed(penetration[m]);
                (loads[m], rises[m]) = (stiffness[spring][m] * passed, stiffness[spring][m] * share);
            }
            [loads, rises]
        };
        let found = balances(responses, &gaps, self.force, above);
        let offset = self.flanks.offset();
        for m in 0..M {
            let (mut loads, mut penetration) = ([0.0; MOST_SPRINGS], [0.0; MOST_SPRINGS]);
            for spring in 0..N {
                (loads[spring], penetration[spring]) = (found.loads[spring][m], found.penetration[spring][m]);
            }
            let balance = Balance { approach: found.approach[m], loads, penetration, slope: found.slope[m] };
            states[m] = Equilibrium { unloaded: smallest[m] + offset, balance, peaks: None };
        }
    }

    /// Equilibria at ascending cycle positions with `pairs` inside the path of contact; nothing where there is more to any.
    #[inline]
    pub(in crate::gear::mesh) fn of_plain_pairs<const M: usize>(
        &self,
        positions: &[f64; M],
        pairs: usize,
        found: &mut [Equilibrium; M],
    ) -> Option<()> {
        if !self.flanks.is_flat() {
            return None;
        }
        match pairs {
            1 => self.of_one(positions, found)?,
            2 => self.of_two(positions, found)?,
            _ => return None,
        }
        self.count.solves(M);
        Some(())
    }

    /// How far one pair alone would approach at a cycle position, its gap included; nothing where there is more to it.
    #[inline]
    pub(in crate::gear::mesh) fn of_plain_pair(&self, position: f64, spring: usize) -> Option<f64> {
        if !self.holds_pairs_on_line() || !self.flanks.is_flat() {
            return None;
        }
        let (laws, [gap]) = self.laws_and_gaps(&[position], spring);
        let [approach, _] = self.alone_on(&laws.at(0))?;
        self.count.solves(1);
        Some(gap + approach)
    }

    #[inline]
    fn laws_and_gaps<const M: usize>(&self, positions: &[f64; M], spring: usize) -> (PlainLaws<M>, [f64; M]) {
        let mut places = [0.0; M];
        for m in 0..M {
            places[m] = self.cycle.path_position(positions[m], spring);
        }
        (self.cycle.elasticity.plain_at_each(&places), self.gaps_on_line(&places))
    }

    #[inline]
    fn of_one<const M: usize>(&self, positions: &[f64; M], found: &mut [Equilibrium; M]) -> Option<()> {
        let (laws, gaps) = self.laws_and_gaps(positions, 0);
        let offset = self.flanks.offset();
        for m in 0..M {
            let [approach, rise] = self.alone_on(&laws.at(m))?;
            let mut balance = Balance { approach, slope: self.cycle.face_width / rise, ..Balance::EMPTY };
            (balance.loads[0], balance.penetration[0]) = (self.force, approach);
            found[m] = Equilibrium { unloaded: gaps[m] + offset, balance, peaks: None };
        }
        Some(())
    }

    /// The approach of a pair that carries all of the load, and d approach/d load per width.
    #[inline]
    fn alone_on(&self, law: &PlainLaw) -> Option<[f64; 2]> {
        let (rate, load) = (self.cycle.elasticity.rates()[0], self.line_load);
        let [approach, rise, _] = law.rates_at(rate, load.number, load.log);
        law.holds(load.number).then_some([approach, rise])
    }

    #[inline]
    fn of_two<const M: usize>(&self, positions: &[f64; M], found: &mut [Equilibrium; M]) -> Option<()> {
        let (ones, near) = self.laws_and_gaps(positions, 0);
        let (others, far) = self.laws_and_gaps(positions, 1);
        let mut gaps = [near, far];
        let mut smallest = [0.0; M];
        for m in 0..M {
            smallest[m] = near[m].min(far[m]);
            gaps[0][m] = near[m] - smallest[m];
            gaps[1][m] = far[m] - smallest[m];
        }
        let rate = self.cycle.elasticity.rates()[0];
        let Shared { approach, slope, share } = shared(&[ones, others], rate, &gaps, self.line_load)?;
        let offset = self.flanks.offset();
        for m in 0..M {
            let mut balance =
                Balance { approach: approach[m], slope: slope[m] * self.cycle.face_width, ..Balance::EMPTY };
            let first = share[m] * self.force;
            (balance.loads[0], balance.loads[1]) = (first, self.force - first);
            (balance.penetration[0], balance.penetration[1]) = (approach[m] - gaps[0][m], approach[m] - gaps[1][m]);
            found[m] = Equilibrium { unloaded: smallest[m] + offset, balance, peaks: None };
        }
        Some(())
    }
}
