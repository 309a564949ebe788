//! Flanks that single teeth have of their own: what every one of them has beside the design.
//!
//! Must not know: where they come from, what they touch.

use super::NoSuchTooth;
use crate::gear::geometry::{GearPair, Side};
use crate::gear::modification::flank::Flank;
use crate::gear::modification::{Design, Modification, NamedModification};
use declare::error::Diagnostic;

/// Places along the profile and across the face at which the range of a modification is looked for, and parts of what lies
/// between two points of a spline.
const ALONG: usize = 64;
const ACROSS: usize = 32;
const BETWEEN: usize = 3;
/// By how much of the range of four equidistant values of it a cubic swings beyond them at the most, a little more than half of
/// what Lebesgue's constant of them, 1.631, is above 1.
const SWING: f64 = 0.33;

/// Modifications of single teeth, which add up with those of a design: traces of a gear whose teeth were measured one by one.
#[derive(Clone, Debug, Default)]
pub struct ToothFlanks {
    /// Pinion and gear, tooth by tooth in the order in which they come into mesh; nothing where no tooth has any.
    teeth: [Vec<OwnFlank>; 2],
}

/// What a tooth has.
#[derive(Clone, Debug, Default)]
struct OwnFlank {
    parts: Vec<NamedModification>,
    /// Between what all of them take off together \[m\].
    range: [f64; 2],
}

impl ToothFlanks {
    /// Gives a tooth, which counts from 0 in the order in which teeth come into mesh, what `own` has of its gear, beside what it has.
    ///
    /// # Errors
    /// When the gear has no such tooth.
    pub fn give(&mut self, pair: &GearPair, side: Side, tooth: usize, own: &Design) -> Result<(), NoSuchTooth> {
        let teeth = pair.side(side).specification.teeth;
        if tooth >= teeth as usize {
            return Err(NoSuchTooth { side, teeth, tooth: tooth + 1 });
        }
        let of_gear = &mut self.teeth[side as usize];
        of_gear.resize_with(teeth as usize, OwnFlank::default);
        let flank = &mut of_gear[tooth];
        for part in own.side(side) {
            let [least, most] = range(&*part.modification, pair, side);
            flank.range = [flank.range[0] + least, flank.range[1] + most];
            flank.parts.push(part.clone());
        }
        Ok(())
    }

    /// Refuses what leaves too little of a tooth together with a design.
    ///
    /// # Errors
    /// Of which gear, which tooth, from 0, and why.
    pub fn fit(&self, design: &Design, pair: &GearPair) -> Result<(), (Side, usize, Box<Diagnostic>)> {
        for side in [Side::Pinion, Side::Gear] {
            for (tooth, flank) in self.teeth[side as usize].iter().enumerate().filter(|(_, own)| !own.parts.is_empty())
            {
                let mut own = Design::default();
                let parts = if side == Side::Pinion { &mut own.pinion } else { &mut own.gear };
                parts.extend_from_slice(&flank.parts);
                design.with(&own, pair).map_err(|wrong| (side, tooth, Box::new(wrong)))?;
            }
        }
        Ok(())
    }

    /// How many teeth of a gear have flanks of their own.
    #[must_use]
    pub fn count(&self, side: Side) -> usize {
        self.teeth[side as usize].iter().filter(|flank| !flank.parts.is_empty()).count()
    }

    /// Of a pair of teeth the design with what both have; none where neither has anything. Pairs count in the order in which they
    /// come into mesh, and before the first one.
    pub(super) fn design(&self, design: &Design, pair: isize) -> Option<Design> {
        let own = self.teeth.each_ref().map(|teeth| match teeth.len() {
            0 => &[][..],
            count => &teeth[pair.rem_euclid(count.cast_signed()).cast_unsigned()].parts,
        });
        if own.iter().all(|parts| parts.is_empty()) {
            return None;
        }
        let mut whole = design.clone();
        whole.pinion.extend_from_slice(own[0]);
        whole.gear.extend_from_slice(own[1]);
        Some(whole)
    }

    /// Between what a tooth takes off \[m\].
    pub(super) fn range(&self, side: usize, tooth: usize) -> [f64; 2] {
        self.teeth[side].get(tooth).map_or([0.0; 2], |flank| flank.range)
    }

    /// How many teeth of a gear are looked at; none where none has any.
    pub(super) fn teeth(&self, side: usize) -> usize {
        self.teeth[side].len()
    }

    /// Whether any of them varies across the face.
    pub(super) fn vary_across(&self) -> bool {
        self.any(|part| part.varies_along_face() || part.varies_over_surface())
    }

    /// Whether all of them are the same on either side of the middle of the face.
    pub(super) fn are_even(&self) -> bool {
        !self.any(|part| !part.lead_is_even())
    }

    fn any(&self, is: impl Fn(&dyn Modification) -> bool) -> bool {
        self.teeth.iter().flatten().flat_map(|flank| &flank.parts).any(|part| is(&*part.modification))
    }
}

/// Between what a modification takes off anywhere on the flank \[m\], on the safe side: a trace is a cubic between any two points.
fn range(modification: &dyn Modification, pair: &GearPair, side: Side) -> [f64; 2] {
    let flank = Flank::new(pair, side);
    let even = |from: f64, to: f64, count: usize| {
        (0..=count).map(move |index| from + (to - from) * index as f64 / count as f64)
    };
    let knots = modification.profile_knots();
    let between = knots.windows(2).flat_map(|ends| even(ends[0], ends[1], BETWEEN));
    let last = flank.tip_roll.max(pair.side(side).flank_end.roll);
    let rolls = even(flank.root_roll.min(last), last, ALONG).chain(modification.profile_breaks().iter().copied());
    let half = 0.5 * flank.face_width;
    let is_across = modification.varies_along_face() || modification.varies_over_surface();
    let across: Vec<f64> = if is_across {
        even(-half, half, ACROSS).chain(modification.lead_breaks().iter().copied()).collect()
    } else {
        vec![0.0]
    };
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for roll in rolls.chain(between) {
        let depth = if modification.varies_along_profile() { modification.depth(roll) } else { 0.0 };
        for &z in &across {
            let lead = if modification.varies_along_face() { modification.lead(z) } else { 0.0 };
            let surface = if modification.varies_over_surface() { modification.surface(roll, z) } else { 0.0 };
            let here = depth + lead + surface;
            (least, most) = (least.min(here), most.max(here));
        }
    }
    [least - SWING * (most - least), most + SWING * (most - least)]
}
