//! How the pairs within reach share the load, by what their contact follows and what holds what.
//!
//! Must not know: which pairs are within reach, which positions are computed.

use std::cell::{Cell, OnceCell, RefCell};

use super::candidate_pairs::CandidatePairs;
use super::flanks::Flanks;
use super::load_case::{LoadCase, Regime, Touching};
use crate::gear::contact::face::Face;
use crate::gear::contact::flattening::InSeries;
use crate::gear::contact::plain::PlainLaw;
use crate::gear::contact::springs::{Faces, LinearPairs, LogarithmicPairs};
use crate::gear::mesh::cycle::mesh::Elasticity;
use crate::numeric::by_loads;
use crate::numeric::complementarity::{self, Balance, Coupling, MOST_SPRINGS, PerSpring, Springs};
use crate::numeric::logarithm::Known;

impl<'a> LoadCase<'a> {
    /// Equilibrium of the pairs within reach, of the nearest of which the law may be known, and, where slices hold each other,
    /// the largest load per width of each.
    #[inline]
    pub(in crate::gear::mesh) fn balance(
        &self,
        reach: &CandidatePairs,
        nearest: Option<&InSeries<'a>>,
    ) -> (Balance, Option<PerSpring>) {
        let slices = match &self.regime {
            Regime::Unloaded => return (complementarity::unloaded(reach.gaps()), None),
            // Friction is beside what is shared here.
            Regime::Pairs | Regime::CoupledPairs | Regime::Resisted(_) => None,
            Regime::CoupledSlices(slices) => Some(slices),
        };
        self.count.solves(1);
        if let Some(slices) = slices {
            let (balance, peaks) =
                slices.balance(&|spring| self.flanks_of(spring), reach, [self.force, self.above(reach, &mut None)]);
            return (balance, Some(peaks));
        }
        if self.flanks.is_surface {
            return (self.balance_of_surfaces(reach, nearest), None);
        }
        (self.balance_behind(reach, nearest, Faces::Same(&self.flanks.face)), None)
    }

    #[cold]
    fn balance_of_surfaces(&self, reach: &CandidatePairs, nearest: Option<&InSeries<'a>>) -> Balance {
        let pairs = reach.springs().iter().zip(reach.positions());
        let faces: Vec<Face> = pairs.map(|(&spring, &s)| self.flanks_of(spring).face_at(s)).collect();
        self.balance_behind(reach, nearest, Faces::Each(&faces))
    }

    /// Where slices do not hold each other.
    #[inline]
    fn balance_behind(&self, reach: &CandidatePairs, nearest: Option<&InSeries<'a>>, faces: Faces) -> Balance {
        match &self.cycle.elasticity {
            Elasticity::Linear(graded) => {
                let mut stiffness = [0.0; MOST_SPRINGS];
                for (slot, s) in stiffness.iter_mut().zip(reach.positions()) {
                    *slot = graded.value(*s);
                }
                let above = complementarity::linear_approach(&stiffness, reach.gaps(), self.force) + faces.mean();
                self.balance_of_pairs(reach, &LinearPairs { stiffness, faces }, above)
            }
            Elasticity::Logarithmic { .. } if reach.springs().len() <= 2 => {
                self.balance_of_logarithms::<2>(reach, nearest, faces)
            }
            Elasticity::Logarithmic { .. } => self.balance_of_logarithms::<MOST_SPRINGS>(reach, nearest, faces),
        }
    }

    /// Of as many pairs at the most.
    #[inline]
    fn balance_of_logarithms<const N: usize>(
        &self,
        reach: &CandidatePairs,
        nearest: Option<&InSeries<'a>>,
        faces: Faces,
    ) -> Balance {
        let elasticity = &self.cycle.elasticity;
        let mut plain = [PlainLaw::NONE; N];
        for (plain, s) in plain.iter_mut().zip(reach.positions()) {
            *plain = elasticity.plain(*s);
        }
        let whole = [const { OnceCell::new() }; N];
        if let Some(nearest) = nearest {
            whole[reach.nearest()].get_or_init(|| nearest.clone());
        }
        let series = |pair: usize| elasticity.series(reach.positions()[pair], None);
        // As if all carried alike.
        let even = self.line_load.over(reach.springs().len());
        let logs = std::array::from_fn(|_| Cell::new(even));
        let (rates, width) = (elasticity.rates(), self.cycle.face_width);
        let last = [const { RefCell::new(Vec::new()) }; N];
        let pairs = LogarithmicPairs { plain, rates, whole: &whole, series, width, faces, logs, last };
        if faces.are_flat() {
            let coupling = self.coupling_of(reach);
            let found = by_loads::balance(&pairs, reach.gaps(), coupling.as_ref(), self.force);
            if let Some(found) = found {
                return found;
            }
        }
        let above = pairs.above(reach.nearest(), self.force);
        self.balance_of_pairs(reach, &pairs, above)
    }

    fn balance_of_pairs(&self, reach: &CandidatePairs, responses: &impl Springs, above: f64) -> Balance {
        let gaps = reach.gaps();
        match self.coupling_of(reach) {
            None => complementarity::balance(responses, gaps, self.force, above),
            Some(coupling) => complementarity::balance_coupled(responses, gaps, &coupling, self.force, above),
        }
    }

    /// What the pairs' loads do to each other; none where nothing couples them.
    #[inline]
    fn coupling_of(&self, reach: &CandidatePairs) -> Option<Coupling> {
        if matches!(self.regime, Regime::Pairs) || reach.springs().len() < 2 {
            return None;
        }
        Some(self.coupling_between(reach))
    }

    fn coupling_between(&self, reach: &CandidatePairs) -> Coupling {
        let (springs, positions) = (reach.springs(), reach.positions());
        let mut coupling: Coupling = [PerSpring::default(); MOST_SPRINGS];
        for (ahead, &spring) in springs.iter().enumerate() {
            for behind in 0..ahead {
                let value = self.cycle.coupling(positions[behind], spring - springs[behind]);
                (coupling[behind][ahead], coupling[ahead][behind]) = (value, value);
            }
        }
        coupling
    }

    /// The pairs that can touch at all, but for one that may be left out; with corner contact, only those that come near
    /// enough. Finding those may take the law of the nearest pair, which is left for what follows.
    #[inline(always)]
    #[allow(clippy::inline_always)] // returned, it would be copied for every equilibrium
    pub(in crate::gear::mesh) fn within_reach(
        &self,
        position: f64,
        pairs: usize,
        left_out: Option<usize>,
        nearest: &mut Option<InSeries<'a>>,
    ) -> CandidatePairs {
        let mut reach = CandidatePairs::none();
        for spring in (0..self.cycle.springs(pairs)).filter(|spring| Some(*spring) != left_out) {
            let s = self.cycle.path_position(position, spring);
            if let Some(gap) = self.gap_of(spring, s) {
                reach.push(spring, s, gap);
            }
        }
        reach.count_gaps_from_the_smallest();
        if matches!(self.touching, Touching::Anywhere { .. }) && self.force > 0.0 {
            reach.keep_nearer_than(self.above(&reach, nearest));
        }
        reach
    }

    /// An approach that no equilibrium exceeds, from the smallest gap on, where the nearest pair is at `s` and has these flanks:
    /// twice that of this pair alone. For loads λ_j of least complementary energy U, x F = Σ w_j λ_j + Σ gap_j λ_j ≤ 2 U since
    /// approaches bend down with the load, and U ≤ F w(F) of any one pair alone.
    ///
    /// Leaves the law of that pair, if it took it.
    pub(in crate::gear::mesh) fn alone(&self, s: f64, flanks: &Flanks<'a>, law: &mut Option<InSeries<'a>>) -> f64 {
        let alone = match &self.cycle.elasticity {
            Elasticity::Linear(stiffness) => self.force / stiffness.value(s),
            elasticity @ Elasticity::Logarithmic { .. } if self.force > 0.0 => {
                let (Known { number, log }, plain) = (self.line_load, elasticity.plain(s));
                if plain.holds(number) {
                    return 2.0 * (plain.rates_at(elasticity.rates()[0], number, log)[0] + flanks.mean(s));
                }
                let law = law.insert(elasticity.series(s, None));
                law.at_known_load(number, log).0
            }
            Elasticity::Logarithmic { .. } => 0.0,
        };
        2.0 * (alone + flanks.mean(s))
    }

    /// An approach that no equilibrium of the pairs within reach exceeds, from the smallest gap on; as [`LoadCase::alone`] of the
    /// nearest of them.
    #[inline]
    pub(in crate::gear::mesh) fn above(&self, reach: &CandidatePairs, law: &mut Option<InSeries<'a>>) -> f64 {
        self.alone(reach.nearest_position(), self.flanks_of(reach.nearest_spring()), law)
    }

    /// How far the loads of all others would press the flanks of a pair into each other, if it carried nothing: of the sign of
    /// its penetration, but smooth where it takes up load. None where slices hold each other, friction takes part, or there are no
    /// others.
    pub(in crate::gear::mesh) fn pressed_by_others(&self, position: f64, pairs: usize, spring: usize) -> Option<f64> {
        if matches!(self.regime, Regime::Unloaded | Regime::CoupledSlices(_) | Regime::Resisted(_)) {
            return None;
        }
        let s = self.cycle.path_position(position, spring);
        let gap = self.gap_of(spring, s)?;
        if self.cycle.springs(pairs) == 2
            && let Some(other) = self.of_plain_pair(position, 1 - spring)
        {
            return Some(other - gap);
        }
        let mut nearest = None;
        let reach = self.within_reach(position, pairs, Some(spring), &mut nearest);
        if reach.springs().is_empty() {
            return None;
        }
        let balance = self.balance(&reach, nearest.as_ref()).0;
        let by_others = if matches!(self.regime, Regime::Pairs) {
            0.0
        } else {
            let others = reach.springs().iter().zip(reach.positions()).zip(&balance.loads);
            others.map(|((&other, &at), load)| load * self.cycle.coupling(s.min(at), spring.abs_diff(other))).sum()
        };
        Some(reach.smallest - gap + balance.approach - by_others)
    }

    /// Where slices hold each other: the load, over the force, that a slice carries and its recomputed penetration does not
    /// explain, and its limit in roundings.
    #[must_use]
    pub(in crate::gear::mesh) fn unexplained_by_slices(&self, position: f64, pairs: usize) -> Option<[f64; 2]> {
        let slices = self.slices()?;
        if let Some((loading, _)) = self.resisted(position, pairs) {
            return loading.unexplained_by_slices(position, pairs);
        }
        let reach = self.within_reach(position, pairs, None, &mut None);
        Some(slices.unexplained(&|spring| self.flanks_of(spring), &reach, [self.force, self.above(&reach, &mut None)]))
    }

    /// Where slices hold each other: the load per width \[N/m\] of each slice of the whole face, of each pair within reach by
    /// its spring.
    pub(in crate::gear::mesh) fn loads_of_slices(&self, position: f64, pairs: usize) -> Option<Vec<(usize, Vec<f64>)>> {
        let slices = self.slices()?;
        if let Some((loading, _)) = self.resisted(position, pairs) {
            return loading.loads_of_slices(position, pairs);
        }
        let reach = self.within_reach(position, pairs, None, &mut None);
        let loads =
            slices.line_loads(&|spring| self.flanks_of(spring), &reach, [self.force, self.above(&reach, &mut None)]);
        Some(reach.springs().iter().copied().zip(loads).collect())
    }
}
