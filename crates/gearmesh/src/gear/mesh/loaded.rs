//! A mesh with a design, under a torque: the way to every answer.
//!
//! Each layer keeps what those below it do not change: a [`Mesh`] the teeth and the sampling, a [`MeshedDesign`] the gaps of the
//! flanks, which no torque changes. Must not know: how anything is computed.

use std::ops::Range;

use super::answers::contact_law_error::{self, ContactLawError};
use super::answers::corner_stretches::{self, CornerStretches};
use super::answers::curve::{self, Point, Summary, Wanted};
use super::answers::face_map::{self, Cell};
use super::answers::friction::{self, Loss, Place};
use super::answers::hunting::{self, Teeth};
use super::answers::needs::{self, Needs};
use super::answers::neglected_corners::{self, NeglectedCorners};
use super::answers::pressure::{self, LineContact};
use super::answers::quantities::Quantity;
use super::answers::root_stress::{self, RootStress};
use super::answers::walk;
use super::cycle::error::MeshError;
use super::cycle::flank_friction::{FlankFriction, Friction};
use super::cycle::mesh::{Mesh, Settings};
use super::equilibrium::beyond_model::BeyondModel;
use super::equilibrium::load_case::LoadCase;
use super::equilibrium::state::Equilibrium;
use super::trace::Trace;
use crate::gear::compliance::{Assumptions, Method};
use crate::gear::geometry::GearPair;
use crate::gear::modification::Design;
use crate::numeric::complementarity::MOST_SPRINGS;

impl Mesh {
    /// The mesh of a pair with the compliances of a method, by its default assumptions and [`Settings::default`].
    ///
    /// # Errors
    /// If the method does not hold for the pair, and as [`Mesh::new`].
    pub fn by(pair: &GearPair, method: &impl Method) -> Result<Self, MeshError> {
        Self::new(pair, &method.tabulate(pair, Assumptions::default())?.compliance, Settings::default())
    }

    /// The mesh of teeth with this design.
    #[must_use]
    pub fn design<'m>(&'m self, design: &'m Design) -> MeshedDesign<'m> {
        MeshedDesign { mesh: self, design, last: None }
    }

    /// One design under one torque on the pinion \[N m\]; for several torques see [`Mesh::design`].
    #[must_use]
    pub fn loaded<'m>(&'m self, design: &'m Design, torque: f64) -> Loaded<'m> {
        Loaded { case: LoadCase::new(self, design, torque) }
    }
}

/// A mesh whose teeth have a design. Gaps between the flanks are found once, for the first torque.
#[derive(Clone)]
pub struct MeshedDesign<'m> {
    mesh: &'m Mesh,
    design: &'m Design,
    last: Option<LoadCase<'m>>,
}

impl<'m> MeshedDesign<'m> {
    /// Under a torque on the pinion \[N m\], finite and 0 or more; without torque the nearest pair just touches. Below 0 it
    /// counts as 0; a number that is not finite is beyond the model. The same bits whatever torques came before.
    pub fn under(&mut self, torque: f64) -> Loaded<'m> {
        let case = match &self.last {
            Some(other) => other.with_torque(torque),
            None => LoadCase::new(self.mesh, self.design, torque),
        };
        self.last = Some(case.clone());
        Loaded { case }
    }
}

/// A mesh with a design under a torque.
#[derive(Clone)]
pub struct Loaded<'m> {
    pub(super) case: LoadCase<'m>,
}

impl<'m> Loaded<'m> {
    /// The mesh without design and load.
    #[must_use]
    pub fn mesh(&self) -> &'m Mesh {
        self.case.cycle
    }

    /// F = T / r_b1 \[N\].
    #[must_use]
    pub fn force(&self) -> f64 {
        self.case.force
    }

    /// These quantities, in SI and in their order; NaN where a curve has none.
    ///
    /// # Errors
    /// If the gears approach by more than is modelled.
    pub fn ask(&self, quantities: &[&Quantity]) -> Result<Vec<f64>, BeyondModel> {
        let summary = self.summary_of(quantities.iter().fold(Needs::default(), |needs, quantity| needs.and(quantity)));
        self.check_approach(summary.largest.value)?;
        Ok(quantities.iter().map(|quantity| (quantity.get)(&summary)).collect())
    }

    /// The curve at the positions of the spans only, without those that only integrals need.
    #[must_use]
    pub fn curve(&self, wanted: Wanted) -> Vec<Point> {
        curve::curve(&self.case, wanted)
    }

    /// The summary of [`Loaded::curve_and_summary`], without the curve.
    #[must_use]
    pub fn summary(&self, wanted: Wanted) -> Summary {
        curve::summary(&self.case, wanted)
    }

    /// Both, from the same positions; the curve also has the points of its extrema.
    #[must_use]
    pub fn curve_and_summary(&self, wanted: Wanted) -> (Vec<Point>, Summary) {
        curve::curve_and_summary(&self.case, wanted)
    }

    /// The summary with what is needed; everything else is NaN, empty or none.
    #[must_use]
    pub fn summary_of(&self, needs: Needs) -> Summary {
        needs::summary_of(&self.case, needs)
    }

    /// The peak-to-peak transmission error \[m\], infinite beyond the model: the lean path for optimisers.
    #[must_use]
    pub fn peak_to_peak(&self) -> f64 {
        curve::peak_to_peak(&self.case)
    }

    /// The peak-to-peak transmission error \[m\].
    ///
    /// # Errors
    /// If the gears approach by more than is modelled.
    pub fn checked_peak_to_peak(&self) -> Result<f64, BeyondModel> {
        curve::checked_peak_to_peak(&self.case)
    }

    /// The variance of the transmission error over the cycle \[m²\], an integral mean, infinite beyond the model: the lean path
    /// for optimisers.
    #[must_use]
    pub fn variance(&self) -> f64 {
        curve::variance(&self.case)
    }

    /// The transmission error over the cycle.
    #[must_use]
    pub fn trace(&self) -> Trace {
        walk::trace(&self.case)
    }

    /// Equilibrium at the cycle position τ with `pairs` inside the path of contact, the newest first.
    #[must_use]
    pub fn state(&self, position: f64, pairs: usize) -> Equilibrium {
        self.case.state(position, pairs)
    }

    /// The gap at a path position, where the flanks come nearest; with corner contact none where they are too far apart.
    #[must_use]
    pub fn gap(&self, s: f64) -> Option<f64> {
        self.case.gap(s)
    }

    /// Checks that an approach \[m\] is within the model.
    ///
    /// # Errors
    /// With corner contact, if a pair that is no longer considered would touch, or a tip would pass the other one.
    pub fn check_approach(&self, approach: f64) -> Result<(), BeyondModel> {
        self.case.check_approach(approach)
    }

    /// Whether the number of slices across the face matters: not where every pair's load has a closed form.
    #[must_use]
    pub fn uses_slices(&self) -> bool {
        self.case.uses_slices()
    }

    /// Where slices are coupled: the load, over the force, that a slice carries and its recomputed penetration does not
    /// explain, and its limit in roundings.
    #[must_use]
    pub fn unexplained_by_slices(&self, position: f64, pairs: usize) -> Option<[f64; 2]> {
        self.case.unexplained_by_slices(position, pairs)
    }

    /// The same with as many positions per base pitch: gaps need not be found again.
    #[must_use]
    pub fn with_positions(&self, positions: usize) -> Self {
        Self { case: self.case.with_positions(positions) }
    }

    /// The contact of each pair where its face is loaded most, by the springs of the position.
    #[must_use]
    pub fn contacts(&self, position: f64, pairs: usize, state: &Equilibrium) -> [LineContact; MOST_SPRINGS] {
        pressure::contacts(&self.case, position, pairs, state)
    }

    /// The largest load per width of a pair \[N/m\], where the flanks stand highest across the face.
    #[must_use]
    pub fn line_load(&self, position: f64, state: &Equilibrium, spring: usize) -> f64 {
        pressure::line_load(&self.case, position, state, spring)
    }

    /// The stretches of a curve with pressures in which sharp corners are in contact; none where they nowhere are.
    #[must_use]
    pub fn corner_stretches(&self, points: &[Point]) -> Option<CornerStretches> {
        corner_stretches::corner_stretches(&self.case, points)
    }

    /// The map of load and pressure with so many steps in a base pitch and so many strips of the face: one where flanks run
    /// parallel, and all slices where they are coupled. Pairs from A to E, and those before A and after E that carry load.
    #[must_use]
    pub fn map(&self, steps: usize, strips: usize) -> Vec<Cell> {
        face_map::face_map(&self.case, steps, strips)
    }

    /// The largest root stress of pinion and gear; none without influences of loads on the roots.
    #[must_use]
    pub fn root_stress(&self, position: f64, pairs: usize, state: &Equilibrium) -> Option<[RootStress; 2]> {
        root_stress::root_stress(&self.case, position, pairs, state)
    }

    /// The possible error of the law of contact over the cycle; none without load, or where contact is linear and knows no
    /// width.
    #[must_use]
    pub fn contact_law_error(&self) -> Option<ContactLawError> {
        contact_law_error::contact_law_error(&self.case)
    }

    /// The same at one position of the cycle with `pairs` inside the path of contact.
    #[must_use]
    pub fn contact_law_error_at(&self, position: f64, pairs: usize) -> Option<ContactLawError> {
        contact_law_error::contact_law_error_at(&self.case, position, pairs)
    }

    /// The corners that are left out, if the gears approach by `transmission_error` \[m\] at most and that presses any of them
    /// against a flank. None with corner contact, without load, and where contact ends at a form circle.
    #[must_use]
    pub fn neglected_corners(&self, transmission_error: f64) -> Option<NeglectedCorners> {
        neglected_corners::neglected_corners(&self.case, transmission_error)
    }

    /// The same with friction of the flanks in the balance of the loads. For flanks that touch from A to E only. Without load
    /// there is no friction.
    #[must_use]
    pub fn with_friction(self, friction: Friction<'m>) -> Self {
        Self { case: self.case.with_friction(friction) }
    }

    /// Friction at a position, by its springs.
    #[must_use]
    pub fn rubbing(&self, friction: Friction<'m>, position: f64, pairs: usize) -> [FlankFriction; MOST_SPRINGS] {
        friction::rubbing(&self.case, friction, position, pairs)
    }

    /// The loss over the cycle, and the torque that the gear is left with. Without torque or beyond the model all of it is NaN.
    #[must_use]
    pub fn friction_loss(&self, friction: Friction<'m>) -> Loss {
        friction::friction_loss(&self.case, friction)
    }

    /// Power lost at a position \[W\], and the torque that the gear is left with \[N m\].
    #[must_use]
    pub fn friction_at(&self, friction: Friction<'m>, position: f64, pairs: usize) -> [f64; 2] {
        friction::friction_at(&self.case, friction, position, pairs)
    }

    /// Friction along the path of contact, with so many steps in a base pitch: pairs from A to E, and those before A and after
    /// E that carry load.
    #[must_use]
    pub fn friction_along(&self, friction: Friction<'m>, steps: usize) -> Vec<Place> {
        friction::friction_along(&self.case, friction, steps)
    }

    /// The same design with teeth that differ, for [`Loaded::over_pitches`]. Without friction.
    #[must_use]
    pub fn with_teeth(self, teeth: &Teeth) -> Self {
        Self { case: hunting::with_teeth(self.case, teeth) }
    }

    /// The transmission error \[m\] at `positions` equidistant positions of each of these base pitches of mesh, of a load case
    /// made with the same teeth: pitch n goes from where pair number n starts contact in A to where the next one does, the
    /// last position one short of that.
    #[must_use]
    pub fn over_pitches(&self, teeth: &Teeth, pitches: Range<isize>, positions: usize) -> Vec<f64> {
        hunting::over_pitches(&self.case, teeth, pitches, positions)
    }
}
