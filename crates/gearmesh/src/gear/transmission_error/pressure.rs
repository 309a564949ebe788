//! How hard the flanks of a pair press on each other: largest pressure and width of a contact, and where that is.
//!
//! Hertz' line contact (Johnson, Contact Mechanics, 4.2) with the flanks' curvature where they touch: ρ1 = s, ρ2 = L − s on the
//! line of action. Where contact is resolved, each tip changes it by what [`Shape::spread`] has, and the factors of both are
//! multiplied. A sharp corner that the contact reaches, or that touches by itself, presses without limit: there the pressure is
//! that of the flank beside it, and it is said. Must not know: how loads are found.
//!
//! [`Shape::spread`]: crate::gear::contact::tip::Shape::spread

use super::curve::Point;
use super::cycle::{Elasticity, MeshCycle};
use super::load_case::{Equilibrium, LoadCase};
use super::trace::{Extremum, Trace};
use crate::gear::contact::face::Face;
use crate::gear::contact::flattening::combined_radius;
use crate::gear::contact::tip::Tips;
use crate::numeric::complementarity::MOST_SPRINGS;

/// Of the distance of two positions, until the end of a stretch is found: to a millionth.
const HALVINGS: usize = 20;

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

/// Where sharp corners are in contact.
#[derive(Clone, Debug, PartialEq)]
pub struct Cornered {
    /// Stretches of the cycle \[m\], ascending.
    pub stretches: Vec<[f64; 2]>,
    /// The largest share of the load.
    pub share: f64,
}

impl MeshCycle {
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

impl LoadCase<'_> {
    /// The mean load per width \[N/m\] of a part of the face of a pair, whose highest place is in by `penetration`.
    pub(super) fn mean_load(&self, s: f64, face: &Face, penetration: f64) -> f64 {
        if penetration <= 0.0 {
            return 0.0;
        }
        match &self.cycle.elasticity {
            Elasticity::Linear(stiffness) => stiffness.value(s) * face.passed(penetration).0 / self.cycle.face_width,
            elasticity @ Elasticity::Logarithmic { .. } => {
                let law = elasticity.series(s, None);
                face.summed(penetration, |_, depth| law.load(depth)).0
            }
        }
    }

    /// The largest load per width of a pair \[N/m\], where the flanks stand highest across the face.
    #[must_use]
    pub fn line_load(&self, position: f64, state: &Equilibrium, spring: usize) -> f64 {
        if let Some(peaks) = state.peaks {
            return peaks[spring];
        }
        let penetration = state.balance.penetration[spring];
        if self.flanks.is_flat() || penetration <= 0.0 {
            return state.balance.loads[spring] / self.cycle.face_width;
        }
        let s = self.cycle.path_position(position, spring);
        match &self.cycle.elasticity {
            Elasticity::Linear(stiffness) => stiffness.value(s) * penetration / self.cycle.face_width,
            elasticity @ Elasticity::Logarithmic { .. } => elasticity.series(s, None).load(penetration).0,
        }
    }

    /// The contact of each pair where its face is loaded most, by the springs of the position.
    #[must_use]
    pub fn contacts(&self, position: f64, pairs: usize, state: &Equilibrium) -> [LineContact; MOST_SPRINGS] {
        self.count.pressure();
        let mut contacts = [LineContact::default(); MOST_SPRINGS];
        for (spring, contact) in contacts.iter_mut().enumerate().take(self.cycle.springs(pairs)) {
            if state.balance.loads[spring] > 0.0 {
                let load = self.line_load(position, state, spring);
                *contact = self.cycle.contact(self.cycle.path_position(position, spring), load);
            }
        }
        contacts
    }

    /// What these contacts come to.
    pub(super) fn pressed(&self, position: f64, pairs: usize, state: &Equilibrium) -> Pressed {
        self.count.pressure();
        let loads = &state.balance.loads;
        let mut found = Pressed::default();
        for (spring, load) in loads.iter().enumerate().take(self.cycle.springs(pairs)) {
            if *load > 0.0 {
                let line_load = self.line_load(position, state, spring);
                let contact = self.cycle.contact(self.cycle.path_position(position, spring), line_load);
                found.largest = found.largest.max(contact.pressure);
                if contact.at_corner {
                    found.corner_share = found.corner_share.max(load / loads.iter().sum::<f64>());
                }
            }
        }
        found
    }

    /// The largest over the cycle, from the values along it.
    pub(super) fn largest_pressure(&self, trace: &Trace) -> LargestPressure {
        let value = |position: f64, pairs: usize| self.pressed(position, pairs, &self.state(position, pairs)).largest;
        let extremum = trace.largest(&self.cycle.rows, self.refining(), value);
        let state = self.state(extremum.position, extremum.pairs);
        let contacts = self.contacts(extremum.position, extremum.pairs, &state);
        let larger =
            |one: usize, other: usize| if contacts[other].pressure > contacts[one].pressure { other } else { one };
        let spring = (0..MOST_SPRINGS).reduce(larger).unwrap_or(0);
        let (contact, s) = (contacts[spring], self.cycle.path_position(extremum.position, spring));
        let roll_angle = self.cycle.rolls(s)[0] + contact.aside / self.cycle.radii(s)[0];
        LargestPressure {
            extremum,
            ahead: spring.cast_signed() - self.cycle.newest().cast_signed(),
            roll_angle: if contact.load > 0.0 { roll_angle } else { f64::NAN },
            across: self.most_loaded(extremum.position, extremum.pairs, spring),
            contact,
        }
    }

    /// Where along a curve whose pressures were found sharp corners are in contact; none where they nowhere are.
    #[must_use]
    pub fn cornered(&self, points: &[Point]) -> Option<Cornered> {
        let share = |point: &Point| point.pressed.map_or(0.0, |pressed| pressed.corner_share);
        let mut found = Cornered { stretches: Vec::new(), share: 0.0 };
        for (index, point) in points.iter().enumerate() {
            let before = index.checked_sub(1).map(|before| &points[before]);
            let (was, is) = (before.is_some_and(|before| share(before) > 0.0), share(point) > 0.0);
            if was != is {
                let (end, at_end) = match before {
                    Some(before) if before.pairs == point.pairs => self.end_of_corner(before, point),
                    Some(before) if was => (before.cycle_position, 0.0),
                    _ => (point.cycle_position, 0.0),
                };
                found.share = found.share.max(at_end);
                match found.stretches.last_mut() {
                    Some(last) if was => last[1] = end,
                    _ => found.stretches.push([end; 2]),
                }
            }
            if let Some(last) = found.stretches.last_mut().filter(|_| is) {
                last[1] = point.cycle_position;
            }
            found.share = found.share.max(share(point));
        }
        (found.share > 0.0).then_some(found)
    }

    /// Between two points of which one has a corner in contact: the last place that has, and the share of the load there.
    fn end_of_corner(&self, one: &Point, other: &Point) -> (f64, f64) {
        let pairs = one.pairs;
        let share = |position: f64| self.pressed(position, pairs, &self.state(position, pairs)).corner_share;
        let has = one.pressed.is_some_and(|pressed| pressed.corner_share > 0.0);
        let [mut inside, mut outside] = if has { [one, other] } else { [other, one] }.map(|point| point.cycle_position);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            if share(middle) > 0.0 { inside = middle } else { outside = middle }
        }
        (inside, share(inside))
    }
}
