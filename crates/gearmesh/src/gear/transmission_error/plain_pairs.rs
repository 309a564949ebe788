//! Equilibria of one pair or two that hold themselves, between parallel flanks, where what each follows is known at once.
//!
//! That is most of a cycle under a logarithmic law without coupling. Must not know: which positions are computed.

use super::load_case::{Equilibrium, LoadCase};
use crate::gear::contact::plain::PlainLaw;
use crate::gear::contact::plain::shared::{Shared, shared};
use crate::numeric::complementarity::{Balance, MOST_SPRINGS};

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
        let at = |spring: usize| {
            let places = positions.map(|position| self.cycle.path_position(position, spring));
            (self.cycle.elasticity.plain_at_each(&places), self.gaps_on_line(&places))
        };
        let offset = self.flanks.offset();
        match pairs {
            1 => {
                let (laws, gaps) = at(0);
                for m in 0..M {
                    let balance = self.alone_on(&laws.at(m))?;
                    found[m] = Equilibrium { unloaded: gaps[m] + offset, balance, peaks: None };
                }
            }
            2 => {
                let [(ones, gaps), (others, beside)] = [at(0), at(1)];
                for m in 0..M {
                    let gap = gaps[m].min(beside[m]);
                    let balance = self.both_on(&[ones.at(m), others.at(m)], [gaps[m] - gap, beside[m] - gap])?;
                    found[m] = Equilibrium { unloaded: gap + offset, balance, peaks: None };
                }
            }
            _ => return None,
        }
        self.count.solves(M);
        Some(())
    }

    #[inline]
    fn alone_on(&self, law: &PlainLaw) -> Option<Balance> {
        let (rate, load) = (self.cycle.elasticity.rates()[0], self.line_load);
        if !law.holds(load.number) {
            return None;
        }
        let [approach, rise, _] = law.rates_at(rate, load.number, load.log);
        let mut balance = Balance { approach, slope: self.cycle.face_width / rise, ..Balance::EMPTY };
        (balance.loads[0], balance.penetration[0]) = (self.force, approach);
        Some(balance)
    }

    #[inline]
    fn both_on(&self, laws: &[PlainLaw; 2], gaps: [f64; 2]) -> Option<Balance> {
        let Shared { approach, slope, share, penetration } =
            shared(laws, self.cycle.elasticity.rates()[0], gaps, self.line_load)?;
        let (mut loads, mut penetrations) = ([0.0; MOST_SPRINGS], [0.0; MOST_SPRINGS]);
        let first = share * self.force;
        (loads[0], loads[1]) = (first, self.force - first);
        (penetrations[0], penetrations[1]) = (penetration[0], penetration[1]);
        Some(Balance { approach, loads, penetration: penetrations, slope: slope * self.cycle.face_width })
    }
}
