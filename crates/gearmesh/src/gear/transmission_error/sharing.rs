//! How the pairs within reach share the load, by what their contact follows and what holds what.
//!
//! Must not know: which pairs are within reach, which positions are computed.

use std::cell::{Cell, OnceCell, RefCell};

use super::cycle::Elasticity;
use super::load_case::{LoadCase, Regime};
use super::within_reach::WithinReach;
use crate::gear::contact::face::Face;
use crate::gear::contact::flattening::InSeries;
use crate::gear::contact::plain::PlainLaw;
use crate::gear::contact::springs::{Faces, LinearPairs, LogarithmicPairs};
use crate::numeric::by_loads;
use crate::numeric::complementarity::{self, Balance, Coupling, MOST_SPRINGS, PerSpring, Springs};

impl<'a> LoadCase<'a> {
    /// Equilibrium of the pairs within reach, of the nearest of which the law may be known, and, where slices hold each other,
    /// the largest load per width of each.
    #[inline]
    pub(super) fn balance(&self, reach: &WithinReach, nearest: Option<&InSeries<'a>>) -> (Balance, Option<PerSpring>) {
        let slices = match &self.regime {
            Regime::Unloaded => return (complementarity::unloaded(reach.gaps()), None),
            // Friction is beside what is shared here.
            Regime::Pairs | Regime::CoupledPairs | Regime::Resisted(_) => None,
            Regime::CoupledSlices(slices) => Some(slices),
        };
        self.count.solves(1);
        if let Some(slices) = slices {
            let (balance, peaks) = slices.balance(self, reach, [self.force, self.above(reach, &mut None)]);
            return (balance, Some(peaks));
        }
        if self.flanks.is_surface {
            return (self.balance_of_surfaces(reach, nearest), None);
        }
        (self.balance_behind(reach, nearest, Faces::Same(&self.flanks.face)), None)
    }

    #[cold]
    fn balance_of_surfaces(&self, reach: &WithinReach, nearest: Option<&InSeries<'a>>) -> Balance {
        let pairs = reach.springs().iter().zip(reach.positions());
        let faces: Vec<Face> = pairs.map(|(&spring, &s)| self.flanks_of(spring).face_at(s)).collect();
        self.balance_behind(reach, nearest, Faces::Each(&faces))
    }

    /// Where slices do not hold each other.
    #[inline]
    fn balance_behind(&self, reach: &WithinReach, nearest: Option<&InSeries<'a>>, faces: Faces) -> Balance {
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
        reach: &WithinReach,
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

    fn balance_of_pairs(&self, reach: &WithinReach, responses: &impl Springs, above: f64) -> Balance {
        let gaps = reach.gaps();
        match self.coupling_of(reach) {
            None => complementarity::balance(responses, gaps, self.force, above),
            Some(coupling) => complementarity::balance_coupled(responses, gaps, &coupling, self.force, above),
        }
    }

    /// What the pairs' loads do to each other; none where nothing couples them.
    #[inline]
    fn coupling_of(&self, reach: &WithinReach) -> Option<Coupling> {
        if matches!(self.regime, Regime::Pairs) || reach.springs().len() < 2 {
            return None;
        }
        Some(self.coupling_between(reach))
    }

    fn coupling_between(&self, reach: &WithinReach) -> Coupling {
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
}
