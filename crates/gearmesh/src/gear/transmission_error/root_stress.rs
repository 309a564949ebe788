//! The stress at the roots of the loaded teeth, from influences of loads on them.
//!
//! A tooth's root feels its own load and, where the influences know of them, those of its neighbours. All loads are those per
//! width where each pair is loaded most: one section of the face. Must not know: where influences come from, strength.

use super::cycle::MeshCycle;
use super::load_case::{Equilibrium, LoadCase};
use super::trace::{Extremum, Trace};
use crate::gear::compliance::RootInfluences;
use crate::gear::geometry::Side;
use crate::numeric::chebyshev::Series;
use crate::numeric::complementarity::MOST_SPRINGS;
use crate::numeric::parabola::peak;

/// The largest tensile stress along the surface of a gear's loaded teeth, on the side of the loads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RootStress {
    /// \[Pa\]; 0 without load.
    pub stress: f64,
    /// Radius of its place \[m\]; NaN without load.
    pub radius: f64,
}

/// The largest root stress of a gear over the cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LargestRootStress {
    /// The stress \[Pa\] and where in the cycle it is.
    pub extremum: Extremum,
    /// Radius of its place on the root \[m\]; NaN without load.
    pub radius: f64,
    /// Estimated relative error of the stress, of the influences on this gear's roots.
    pub error_estimate: f64,
}

/// Influences on the roots of both gears, quick to add up.
#[derive(Clone, Debug)]
pub(super) struct Roots([Root; 2]);

#[derive(Clone, Debug)]
struct Root {
    radii: Vec<f64>,
    lengths: Vec<f64>,
    /// Of roll angles.
    range: [f64; 2],
    /// By the loaded tooth: coefficients of all places, order by order.
    coefficients: Vec<Vec<f64>>,
    /// By the loaded tooth: what a load along the flank at its tip does, place by place, if that is known.
    along: Vec<Vec<f64>>,
    error_estimate: f64,
}

impl Roots {
    pub(super) fn new(influences: &[RootInfluences; 2]) -> Self {
        Self([Root::new(&influences[0]), Root::new(&influences[1])])
    }
}

impl Root {
    fn new(influences: &RootInfluences) -> Self {
        let RootInfluences { radii, lengths, stresses, along, error_estimate } = influences;
        let of_tooth = |places: &Vec<Series>| {
            let orders = places.iter().map(|series| series.coefficients().len()).max().unwrap_or(0);
            let of = |order: usize| places.iter().map(move |series| series.coefficients().get(order).copied());
            (0..orders).flat_map(of).map(|coefficient| coefficient.unwrap_or(0.0)).collect()
        };
        let range = stresses.iter().flatten().next().map_or([-1.0, 1.0], |series| [series.lower(), series.upper()]);
        let coefficients = stresses.iter().map(of_tooth).collect();
        let (radii, lengths, along) = (radii.clone(), lengths.clone(), along.clone());
        Self { radii, lengths, range, coefficients, along, error_estimate: *error_estimate }
    }

    /// Adds to the stress at every place what a load per width at a roll angle does, on a tooth so many pitches further; at the
    /// corner of a tip it is turned by an angle from the flank's normal.
    fn add(&self, stresses: &mut [f64], further: isize, [roll, inclination]: [f64; 2], load: f64) {
        let tooth = (self.coefficients.len() / 2).checked_add_signed(further);
        let Some((tooth, coefficients)) = tooth.and_then(|tooth| Some((tooth, self.coefficients.get(tooth)?))) else {
            return;
        };
        let mut load = load;
        if let Some(along) = self.along.get(tooth).filter(|along| inclination != 0.0 && !along.is_empty()) {
            let (sine, cosine) = libm::sincos(inclination);
            for (stress, along) in stresses.iter_mut().zip(along) {
                *stress += load * sine * along;
            }
            load *= cosine;
        }
        let [lower, upper] = self.range;
        let t = (2.0 * roll - lower - upper) / (upper - lower);
        // load T_n(t), and the one before it.
        let (mut weight, mut before) = (load, load * t);
        for row in coefficients.chunks(self.radii.len()) {
            for (stress, coefficient) in stresses.iter_mut().zip(row) {
                *stress += weight * coefficient;
            }
            (weight, before) = (2.0 * t * weight - before, weight);
        }
    }
}

impl MeshCycle {
    /// The same cycle with what loads do to the roots of pinion and gear.
    #[must_use]
    pub fn with_roots(mut self, influences: &[RootInfluences; 2]) -> Self {
        self.roots = Some(Roots::new(influences).into());
        self
    }
}

impl LoadCase<'_> {
    /// The largest root stress of pinion and gear; none where nobody knows what loads do to the roots.
    #[must_use]
    pub fn root_stress(&self, position: f64, pairs: usize, state: &Equilibrium) -> Option<[RootStress; 2]> {
        let Roots(roots) = self.cycle.roots.as_deref()?;
        self.count.root_stress();
        let mut loaded = [(0, 0.0, [[0.0; 2]; 2]); MOST_SPRINGS];
        let mut count = 0;
        for spring in (0..self.cycle.springs(pairs)).filter(|spring| state.balance.loads[*spring] > 0.0) {
            let s = self.cycle.path_position(position, spring);
            let (rolls, turned) = (self.cycle.rolls(s), self.cycle.inclinations(s));
            let at = [0, 1].map(|gear| [rolls[gear], turned[gear]]);
            loaded[count] = (spring.cast_signed(), self.line_load(position, state, spring), at);
            count += 1;
        }
        let loaded = &loaded[..count];
        let largest = |side: Side| {
            let gear = usize::from(side == Side::Gear);
            let root = &roots[gear];
            let mut largest = RootStress { stress: 0.0, radius: f64::NAN };
            let mut stresses = vec![0.0; root.radii.len()];
            for (stressed, ..) in loaded {
                stresses.fill(0.0);
                for (spring, load, at) in loaded {
                    // The pair ahead has the larger roll angle on the pinion and the smaller one on the gear.
                    let further = if side == Side::Pinion { spring - stressed } else { stressed - spring };
                    root.add(&mut stresses, further, at[gear], *load);
                }
                if let Some((stress, radius)) = peak(&root.lengths, &root.radii, &stresses)
                    && stress > largest.stress
                {
                    largest = RootStress { stress, radius };
                }
            }
            largest
        };
        Some([largest(Side::Pinion), largest(Side::Gear)])
    }

    /// The largest over the cycle, from the values of pinion and gear along it; none where there are none.
    pub(super) fn largest_root_stress(&self, traces: &[Trace; 2]) -> Option<[LargestRootStress; 2]> {
        let of = |gear: usize| {
            if traces[gear].spans.is_empty() {
                return None;
            }
            let at = |position: f64, pairs: usize| {
                self.root_stress(position, pairs, &self.state(position, pairs)).map(|of_gears| of_gears[gear])
            };
            let stress = |position: f64, pairs: usize| at(position, pairs).map_or(0.0, |root| root.stress);
            let extremum = traces[gear].largest(&self.cycle.rows, self.refining(), stress);
            let radius = at(extremum.position, extremum.pairs)?.radius;
            let error_estimate = self.cycle.roots.as_deref()?.0[gear].error_estimate;
            Some(LargestRootStress { extremum, radius, error_estimate })
        };
        Some([of(0)?, of(1)?])
    }
}
