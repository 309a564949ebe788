//! The stress at the roots of the loaded teeth, from influences of loads on them.
//!
//! A tooth's root feels its own load and, where the influences know of them, those of its neighbours. All loads are those per
//! width where each pair is loaded most: one section of the face. Must not know: where influences come from, strength.

use super::pressure::line_load;
use super::walk::refining;
use crate::gear::geometry::Side;
use crate::gear::mesh::cycle::roots::Roots;
use crate::gear::mesh::equilibrium::load_case::LoadCase;
use crate::gear::mesh::equilibrium::state::Equilibrium;
use crate::gear::mesh::trace::{Extremum, Trace};
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

/// The largest root stress of pinion and gear; none where nobody knows what loads do to the roots.
#[must_use]
pub(in crate::gear::mesh) fn root_stress(
    case: &LoadCase,
    position: f64,
    pairs: usize,
    state: &Equilibrium,
) -> Option<[RootStress; 2]> {
    let Roots(roots) = case.cycle.roots.as_deref()?;
    case.count.root_stress();
    let mut loaded = [(0, 0.0, [[0.0; 2]; 2]); MOST_SPRINGS];
    let mut count = 0;
    for spring in (0..case.cycle.springs(pairs)).filter(|spring| state.balance.loads[*spring] > 0.0) {
        let s = case.cycle.path_position(position, spring);
        let (rolls, turned) = (case.cycle.rolls(s), case.cycle.inclinations(s));
        let at = [0, 1].map(|gear| [rolls[gear], turned[gear]]);
        loaded[count] = (spring.cast_signed(), line_load(case, position, state, spring), at);
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
pub(in crate::gear::mesh) fn largest_root_stress(
    case: &LoadCase,
    traces: &[Trace; 2],
) -> Option<[LargestRootStress; 2]> {
    let of = |gear: usize| {
        if traces[gear].spans.is_empty() {
            return None;
        }
        let at = |position: f64, pairs: usize| {
            root_stress(case, position, pairs, &case.state(position, pairs)).map(|of_gears| of_gears[gear])
        };
        let stress = |position: f64, pairs: usize| at(position, pairs).map_or(0.0, |root| root.stress);
        let extremum = traces[gear].largest(&case.cycle.rows, refining(case), stress);
        let radius = at(extremum.position, extremum.pairs)?.radius;
        let error_estimate = case.cycle.roots.as_deref()?.0[gear].error_estimate;
        Some(LargestRootStress { extremum, radius, error_estimate })
    };
    Some([of(0)?, of(1)?])
}
