//! Equilibria of one pair or two that hold themselves, between parallel flanks, where what each follows is known at once.
//!
//! That is most of a cycle under a logarithmic law without coupling. Must not know: which positions are computed.

use super::load_case::{Equilibrium, LoadCase};
use crate::gear::contact::plain::shared::{Shared, shared};
use crate::gear::contact::plain::{PlainLaw, PlainLaws};
use crate::numeric::complementarity::Balance;

impl LoadCase<'_> {
    /// Equilibria at ascending cycle positions with `pairs` inside the path of contact; nothing where there is more to any.
    #[inline]
    pub(super) fn of_plain_pairs<const M: usize>(
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
    pub(super) fn of_plain_pair(&self, position: f64, spring: usize) -> Option<f64> {
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
