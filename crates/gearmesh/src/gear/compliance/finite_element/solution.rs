//! What loads on a gear do, from one mesh, by how much it differs from that of another one, and what both tend to.
//!
//! Must not know: how it is solved.

use super::inclined::AtTip;
use crate::gear::finite_elements::gear_model::Influences;

/// The order of the error where contact is resolved: that of an energy, with quadratic elements. Halved elements leave of it
/// one part in 2⁴, so that what they change is 2⁴ − 1 times what is left.
const ORDER: i32 = 4;
/// What is left of the error when that is taken off, over the change, if the order were 2, as it is next to the corner of a
/// tip on coarse meshes: 1/(2² − 1) − 1/(2⁴ − 1).
pub(super) const LEFT: f64 = 1.0 / 3.0 - 1.0 / 15.0;

/// What loads on a gear do. E = 1, lengths in modules.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Solution {
    pub(super) influences: Influences,
    /// Those at the corner of the tip that are inclined, where contact is resolved.
    pub(super) tip: Option<AtTip>,
}

impl Solution {
    /// The largest difference from that of another mesh, in units of the teeth's own.
    pub(super) fn difference(&self, coarse: &Self) -> f64 {
        let normal = difference(&self.influences, &coarse.influences);
        let own = &self.influences.own;
        let inclined = self.tip.as_ref().zip(coarse.tip.as_ref()).map_or(0.0, |(fine, coarse)| fine.difference(coarse));
        normal.max(inclined / own[own.len() - 1])
    }

    /// What this one and that of the mesh half as fine tend to (Richardson): the term of fourth order is taken off.
    pub(super) fn extrapolated(mut self, coarse: &Self) -> Self {
        extrapolate(&mut self.influences.own, &coarse.influences.own);
        for (fine, coarse) in self.influences.further.iter_mut().zip(&coarse.influences.further) {
            extrapolate_rows(fine, coarse);
        }
        if let Some((fine, coarse)) = self.tip.as_mut().zip(coarse.tip.as_ref()) {
            extrapolate(&mut fine.own, &coarse.own);
            extrapolate_rows(&mut fine.neighbours, &coarse.neighbours);
        }
        self
    }
}

fn extrapolate(fine: &mut [f64], coarse: &[f64]) {
    let change = f64::from((1 << ORDER) - 1);
    for (fine, coarse) in fine.iter_mut().zip(coarse) {
        *fine += (*fine - coarse) / change;
    }
}

fn extrapolate_rows(fine: &mut [Vec<f64>], coarse: &[Vec<f64>]) {
    for (fine, coarse) in fine.iter_mut().zip(coarse) {
        extrapolate(fine, coarse);
    }
}

/// The largest difference of influences, in units of the teeth's own.
pub(super) fn difference(fine: &Influences, coarse: &Influences) -> f64 {
    let own = fine.own.iter().zip(&coarse.own).map(|(a, b)| (b / a - 1.0).abs()).fold(0.0, f64::max);
    let mut largest = own;
    for (fine_rows, coarse_rows) in fine.further.iter().zip(&coarse.further) {
        for (by, (a, b)) in fine_rows.iter().zip(coarse_rows).enumerate() {
            for (on, (a, b)) in a.iter().zip(b).enumerate() {
                largest = largest.max((a - b).abs() / (fine.own[by] * fine.own[on]).sqrt());
            }
        }
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::super::FiniteElement;
    use super::*;
    use crate::gear::compliance::{Assumptions, ContactLaw, Method};
    use crate::gear::fixtures::standard;
    use crate::gear::geometry::root::RootShape;
    use crate::gear::geometry::{GearPair, Side};
    use crate::numeric::chebyshev::nodes;

    /// Tier: closed form; what is off by the fourth power of the size of elements is exact after it, whatever it is of, and what
    /// is off by the second has four fifths of its error left.
    #[test]
    fn the_fourth_power_is_taken_off() {
        let of = |size: f64, power: i32| {
            let values = |first: f64| vec![first + 0.3 * size.powi(power), 2.0 * first - 0.1 * size.powi(power)];
            Solution {
                influences: Influences { own: values(3.0), further: vec![vec![values(1.0), values(-2.0)]] },
                tip: Some(AtTip { own: [5.0 + size.powi(power), -4.0], neighbours: vec![values(0.5)] }),
            }
        };
        assert!(of(0.5, 4).extrapolated(&of(1.0, 4)).difference(&of(0.0, 4)) < 1e-15);
        let [left, before] = [of(0.5, 2).extrapolated(&of(1.0, 2)), of(0.5, 2)].map(|one| one.difference(&of(0.0, 2)));
        assert!((left / before - 0.8).abs() < 0.01, "{left} {before}");
        // Which is what is said of it.
        assert!((left / of(0.5, 2).difference(&of(1.0, 2)) / LEFT - 1.0).abs() < 0.02);
    }

    /// Tier: order of convergence; the tables themselves with 16 and 32 elements across, against 64, where flanks touch: 8e-6 and
    /// a sixteenth of it. Within a tenth of a module of the corner of a tip it is 2 or more: there elements are no thinner than
    /// they are far from it.
    #[test]
    fn tables_of_resolved_contact_converge_with_the_fourth_order() {
        let resolved = ContactLaw::Resolved;
        let assumptions =
            Assumptions { root: RootShape::Trochoid, contact: resolved, coupled: false, torque: None, accuracy: None };
        for teeth in [[19, 48], [30, 200]] {
            let [pinion, gear] = teeth.map(|teeth| standard(teeth, 3e-3, 1.4));
            let pair = GearPair::new(pinion, gear, None).unwrap();
            let [coarse, middle, fine] = [16, 32, 64].map(|elements_across| {
                let method = FiniteElement { elements_across, ..FiniteElement::default() };
                let found = method.tabulate(&pair, assumptions).unwrap().compliance;
                [found.pinion.body, found.gear.body].map(|body| body.node_values())
            });
            for (side, of) in [Side::Pinion, Side::Gear].into_iter().enumerate() {
                let gear = pair.side(of);
                let form = gear.root(RootShape::Trochoid).unwrap().form_roll;
                let rolls = nodes(form, gear.tip_roll(), fine[side].len());
                let far = |roll: f64| gear.base_radius * (gear.tip_roll().powi(2) - roll * roll) > 0.2 * 3e-3;
                let touches = |roll: f64| roll > pair.lowest_roll(of) && far(roll);
                let places: Vec<usize> = (0..rolls.len()).filter(|&place| touches(rolls[place])).collect();
                let error = |found: &[Vec<f64>; 2], places: &[usize]| {
                    let of = |&place: &usize| (found[side][place] / fine[side][place] - 1.0).abs();
                    places.iter().map(of).fold(0.0, f64::max)
                };
                let [one, two] = [&coarse, &middle].map(|found| error(found, &places));
                let [tip, finer] = [&coarse, &middle].map(|found| error(found, &[rolls.len() - 1]));
                assert!(places.len() > 5 && one < 8e-6 && two < 5e-7, "{teeth:?}, {of:?}: {one} {two}");
                assert!(tip < 6e-5 && finer < 0.25 * tip, "{teeth:?}, {of:?}: {tip} {finer}");
            }
        }
    }
}
