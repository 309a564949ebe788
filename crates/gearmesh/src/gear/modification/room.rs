//! Whether enough of a tooth is left under all modifications of a gear.
//!
//! Must not know: any single family, load.

use super::flank::Flank;
use super::{Design, Gears, Modification};
use crate::gear::geometry::error::shown::decimals;
use crate::gear::geometry::{GearPair, Side};
use declare::error::Diagnostic;

/// Into how many parts flank and face are divided to see whether enough of the tooth is left.
const LOOKS: u32 = 16;

impl Design {
    /// What both designs take off together.
    ///
    /// # Errors
    /// When that is more than half of a tooth.
    pub fn with(&self, other: &Self, pair: &GearPair) -> Result<Self, Diagnostic> {
        let mut whole = self.clone();
        whole.append(other);
        whole.check_rooms(Gears::Both, pair)?;
        Ok(whole)
    }

    /// The same without a look at what is left of the tooth.
    pub(super) fn append(&mut self, other: &Self) {
        self.pinion.extend_from_slice(&other.pinion);
        self.gear.extend_from_slice(&other.gear);
        self.tilt += other.tilt;
    }

    /// Refuses a design that takes more than half of a tooth.
    pub(super) fn check_rooms(&self, gears: Gears, pair: &GearPair) -> Result<(), Diagnostic> {
        gears.sides().iter().try_for_each(|side| self.check_room(*side, pair))
    }

    /// Half of the tooth must be left, since the other flank may be modified the same way: no point of the flank may pass
    /// the tooth's centreline, up to the normal through the middle of the tip land, u_a + ψ_a, where r_b ψ_a is left to take.
    /// Depths nowhere add material to the active flank, so a part that is refused cannot be saved by one that follows.
    fn check_room(&self, side: Side, pair: &GearPair) -> Result<(), Diagnostic> {
        let (gear, flank, parts) = (pair.side(side), Flank::new(pair, side), self.side(side));
        if parts.is_empty() {
            return Ok(());
        }
        let sum = |of: &dyn Fn(&dyn Modification) -> f64| parts.iter().map(|part| of(&*part.modification)).sum::<f64>();
        let face = (-0.5 * flank.face_width, 0.5 * flank.face_width);
        let edges = || parts.iter().flat_map(|part| part.modification.lead_breaks()).copied();
        let lead = looks(face, edges()).map(|z| sum(&|part| part.lead(z))).fold(0.0, f64::max);
        let surface = parts.iter().any(|part| part.modification.varies_over_surface());
        let last = flank.tip_roll + gear.half_angle_at_roll(flank.tip_roll);
        let places = || {
            let breaks = parts.iter().flat_map(|part| part.modification.profile_breaks()).copied();
            looks((flank.root_roll, last), breaks)
        };
        let depth = |roll: f64| {
            let at = |z: f64| sum(&|part| part.lead(z) + part.surface(roll, z));
            sum(&|part| part.depth(roll))
                + if surface { looks(face, edges()).map(at).fold(0.0, f64::max) } else { lead }
        };
        // Room falls with the roll angle, by r_b tan²(u − ψ_b): what fits where there is least need not be looked at closer.
        let minimum = gear.depth_to_centreline(last);
        if places().all(|roll| depth(roll) <= minimum) {
            return Ok(());
        }
        // The place with the least room; NaN counts as none.
        let mut tightest = (f64::INFINITY, flank.tip_roll, 0.0);
        for roll in places() {
            let depth = depth(roll);
            let room = gear.depth_to_centreline(roll) - depth;
            if room.is_nan() || room < tightest.0 {
                tightest = (room, roll, depth);
            }
        }
        let (room, roll, depth) = tightest;
        if room >= 0.0 {
            return Ok(());
        }
        let [diameter, depth, maximum] =
            [flank.diameter(roll.min(flank.tip_roll)), depth, gear.depth_to_centreline(roll)].map(|m| m * 1e3);
        let digits = decimals(depth, maximum);
        Err(Diagnostic::new(format!(
            "the {}'s flank would lose {depth:.digits$} mm, normal to it, at a diameter of {diameter:.6} mm; all its \
             modifications together may take 0 to {maximum:.digits$} mm there, which is half of the tooth",
            side.name()
        )))
    }
}

/// The ends of a range, the `breaks` inside it, and equidistant places between.
fn looks((from, to): (f64, f64), breaks: impl Iterator<Item = f64>) -> impl Iterator<Item = f64> {
    let inside = breaks.filter(move |place| *place > from && *place < to);
    let between = (1..LOOKS).map(move |look| from + (to - from) * f64::from(look) / f64::from(LOOKS));
    [from, to].into_iter().chain(between).chain(inside)
}
