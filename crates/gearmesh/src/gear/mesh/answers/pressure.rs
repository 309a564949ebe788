//! How hard the flanks of a pair press on each other: largest pressure and width of a contact, and where that is.
//!
//! Hertz' line contact (Johnson, Contact Mechanics, 4.2) with the flanks' curvature where they touch: ρ1 = s, ρ2 = L − s on the
//! line of action. Where contact is resolved, each tip changes it by what [`Shape::spread`] has, and the factors of both are
//! multiplied. A sharp corner that the contact reaches, or that touches by itself, presses without limit: there the pressure is
//! that of the flank beside it, and it is said. Must not know: how loads are found.
//!
//! [`Shape::spread`]: crate::gear::contact::tip::Shape::spread

use super::walk::refining;
use crate::gear::contact::face::Face;
use crate::gear::contact::flattening::combined_radius;
use crate::gear::contact::tip::Tips;
use crate::gear::mesh::cycle::mesh::{Elasticity, Mesh};
use crate::gear::mesh::equilibrium::flanks::equal_strips;
use crate::gear::mesh::equilibrium::load_case::LoadCase;
use crate::gear::mesh::equilibrium::state::Equilibrium;
use crate::gear::mesh::trace::{Extremum, Trace};
use crate::numeric::complementarity::MOST_SPRINGS;

/// The contact of a pair in one section of the face.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineContact {
    /// Per width \[N/m\].
    pub load: f64,
    /// The largest pressure \[Pa\].
    pub pressure: f64,
    /// Half of the width of the contact \[m\].
    pub half_width: f64,
    /// How far along the flank, towards larger roll angles of the pinion, the largest pressure is from where the flanks would
    /// touch without load \[m\].
    pub aside: f64,
    /// Whether a sharp corner is in contact: the pressure is infinite there, and the one here is the flank's beside it.
    pub at_corner: bool,
}

/// The contacts at a position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pressed {
    /// The largest pressure of any pair \[Pa\].
    pub largest: f64,
    /// The largest share of the load on a pair that a sharp corner is in contact with.
    pub corner_share: f64,
}

/// The largest pressure over the cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LargestPressure {
    /// The pressure \[Pa\] and where in the cycle it is.
    pub extremum: Extremum,
    /// How many pitches the pair is ahead of the newest one inside the path of contact; the one before A is one behind.
    pub ahead: isize,
    /// The pinion's roll angle at that place \[rad\]; NaN without load.
    pub roll_angle: f64,
    /// z \[m\], where the load is not the same all across the face; the smallest of several.
    pub across: Option<f64>,
    /// The contact there.
    pub contact: LineContact,
}

impl Mesh {
    /// What the flanks are like where a pair touches: their combined radius of curvature, and the tips, where those are known
    /// to the law of contact. And whether the corner of one touches by itself.
    fn flanks(&self, s: f64) -> (f64, Option<Tips<'_>>, bool) {
        let tips = self.tips(s);
        if tips.is_some() {
            return (combined_radius(self.path.radii(s)), tips, false);
        }
        let (radii, corner) = self.touching(s);
        (combined_radius(radii), None, corner.is_some())
    }

    /// The contact of a pair at a path position under a load per width.
    #[must_use]
    pub fn contact(&self, s: f64, load: f64) -> LineContact {
        if load <= 0.0 {
            return LineContact::default();
        }
        let (radius, tips, at_corner) = self.flanks(s);
        let (pressure, half_width) = (self.bodies.pressure(radius, load), self.bodies.half_width(radius) * load.sqrt());
        let hertz = LineContact { load, pressure, half_width, at_corner, ..LineContact::default() };
        let Some(tips) = tips else { return hertz };
        // Away from the corner of the pinion is towards A.
        tips.corners.iter().zip([-1.0, 1.0]).fold(hertz, |found, (corner, towards)| {
            let spread = corner.shape.spread(corner.distance / half_width);
            LineContact {
                load,
                pressure: found.pressure * spread.pressure,
                half_width: found.half_width * spread.half_width,
                aside: found.aside + towards * spread.farther * half_width,
                at_corner: found.at_corner || spread.reaches,
            }
        })
    }
}

/// The mean load per width \[N/m\] of a part of the face of a pair, whose highest place is in by `penetration`.
pub(in crate::gear::mesh) fn mean_load(case: &LoadCase, s: f64, face: &Face, penetration: f64) -> f64 {
    if penetration <= 0.0 {
        return 0.0;
    }
    match &case.cycle.elasticity {
        Elasticity::Linear(stiffness) => stiffness.value(s) * face.passed(penetration).0 / case.cycle.face_width,
        elasticity @ Elasticity::Logarithmic { .. } => {
            let law = elasticity.series(s, None);
            face.summed(penetration, |_, depth| law.load(depth)).0
        }
    }
}

/// The largest load per width of a pair \[N/m\], where the flanks stand highest across the face.
#[must_use]
pub(in crate::gear::mesh) fn line_load(case: &LoadCase, position: f64, state: &Equilibrium, spring: usize) -> f64 {
    if let Some(peaks) = state.peaks {
        return peaks[spring];
    }
    let penetration = state.balance.penetration[spring];
    if case.flanks.is_flat() || penetration <= 0.0 {
        return state.balance.loads[spring] / case.cycle.face_width;
    }
    let s = case.cycle.path_position(position, spring);
    match &case.cycle.elasticity {
        Elasticity::Linear(stiffness) => stiffness.value(s) * penetration / case.cycle.face_width,
        elasticity @ Elasticity::Logarithmic { .. } => elasticity.series(s, None).load(penetration).0,
    }
}

/// The contact of each pair where its face is loaded most, by the springs of the position.
#[must_use]
pub(in crate::gear::mesh) fn contacts(
    case: &LoadCase,
    position: f64,
    pairs: usize,
    state: &Equilibrium,
) -> [LineContact; MOST_SPRINGS] {
    case.count.pressure();
    let mut contacts = [LineContact::default(); MOST_SPRINGS];
    for (spring, contact) in contacts.iter_mut().enumerate().take(case.cycle.springs(pairs)) {
        if state.balance.loads[spring] > 0.0 {
            let load = line_load(case, position, state, spring);
            *contact = case.cycle.contact(case.cycle.path_position(position, spring), load);
        }
    }
    contacts
}

/// What these contacts come to.
pub(in crate::gear::mesh) fn pressed(case: &LoadCase, position: f64, pairs: usize, state: &Equilibrium) -> Pressed {
    case.count.pressure();
    let loads = &state.balance.loads;
    let mut found = Pressed::default();
    for (spring, load) in loads.iter().enumerate().take(case.cycle.springs(pairs)) {
        if *load > 0.0 {
            let line_load = line_load(case, position, state, spring);
            let contact = case.cycle.contact(case.cycle.path_position(position, spring), line_load);
            found.largest = found.largest.max(contact.pressure);
            if contact.at_corner {
                found.corner_share = found.corner_share.max(load / loads.iter().sum::<f64>());
            }
        }
    }
    found
}

/// The largest over the cycle, from the values along it.
pub(in crate::gear::mesh) fn largest_pressure(case: &LoadCase, trace: &Trace) -> LargestPressure {
    let value = |position: f64, pairs: usize| pressed(case, position, pairs, &case.state(position, pairs)).largest;
    let extremum = trace.largest(&case.cycle.rows, refining(case), value);
    let state = case.state(extremum.position, extremum.pairs);
    let contacts = contacts(case, extremum.position, extremum.pairs, &state);
    let larger = |one: usize, other: usize| if contacts[other].pressure > contacts[one].pressure { other } else { one };
    let spring = (0..MOST_SPRINGS).reduce(larger).unwrap_or(0);
    let (contact, s) = (contacts[spring], case.cycle.path_position(extremum.position, spring));
    let roll_angle = case.cycle.rolls(s)[0] + contact.aside / case.cycle.radii(s)[0];
    LargestPressure {
        extremum,
        ahead: spring.cast_signed() - case.cycle.newest().cast_signed(),
        roll_angle: if contact.load > 0.0 { roll_angle } else { f64::NAN },
        across: most_loaded(case, extremum.position, extremum.pairs, spring),
        contact,
    }
}

/// Where the load of a pair is largest across its face: z of the smallest of such places, of the middle of a slice where
/// slices hold each other; none where it is the same everywhere.
pub(in crate::gear::mesh) fn most_loaded(case: &LoadCase, position: f64, pairs: usize, spring: usize) -> Option<f64> {
    let Some(of_slices) = case.loads_of_slices(position, pairs) else {
        return case.flanks.lowest(case.cycle.path_position(position, spring));
    };
    let (_, loads) = of_slices.into_iter().find(|(of, _)| *of == spring)?;
    let slice = (0..loads.len()).reduce(|one, other| if loads[other] > loads[one] { other } else { one })?;
    let [from, to] = equal_strips(case.cycle.face_width, loads.len())[slice];
    Some(0.5 * (from + to))
}
