//! The full profile of a gear as exact segments: root land, root, flank, tip; one description for drawing, export and mesh.
//!
//! Only the right half of one tooth is kept, from the middle of the space up to the tooth's centreline; the other half is
//! its mirror image, and the gear its rotations by 2π/z (Zhai, Liang and Fu 2020, equations 21 and 22). Must not know:
//! pairs, tables, how a drawing looks.

pub mod curve;
pub mod junction;
pub mod roots;
pub mod sample;
pub mod section;
pub mod tip;

use std::f64::consts::PI;
use std::sync::Arc as Shared;

use super::Gear;
use super::error::{GeometryError, Millimetres, Problem};
use super::root::Root;
use super::root_piece::Piece;
use curve::{Curve, OutlinePart, Relief, Segment};
use roots::Toe;
use tip::Tip;

/// Angle \[rad\] below which there is no land.
const NO_LAND: f64 = 1e-9;
/// Distance \[m\] between two curves below which there is no step.
const NO_STEP: f64 = 1e-13;

/// The right half of a tooth, and how often the gear repeats it.
#[derive(Clone, Debug)]
pub struct Outline {
    /// From the middle of the space to the tooth's centreline; each begins where the one before ends.
    pub segments: Vec<Segment>,
    /// z: how often the tooth is repeated.
    pub teeth: u32,
    /// Roll angle \[rad\] at which the flank begins.
    pub form_roll: f64,
    /// Roll angle at which it ends.
    pub end_roll: f64,
}

impl Outline {
    /// The outline of a gear with a root, a tip, and, if any, what is taken off its flanks.
    ///
    /// # Errors
    /// When the tip's break or the relief does not fit the tooth.
    pub fn new(gear: &Gear, toe: Toe, tip: Tip, relief: Option<Shared<dyn Relief>>) -> Result<Self, GeometryError> {
        let Toe { segments: root, form_roll } = toe;
        let (base_radius, half_base_angle) = (gear.base_radius, gear.half_base_angle);
        let breaks = relief.as_ref().map(|relief| relief.breaks()).unwrap_or_default();
        let flank = match relief {
            None => Curve::Involute { base_radius, half_base_angle },
            Some(relief) => {
                let depth = relief.depth(form_roll);
                if depth >= base_radius * form_roll && depth > NO_STEP {
                    return Err(Problem::ReliefTooDeep { depth: Millimetres(depth) }.into());
                }
                let smooth = [f64::NEG_INFINITY, f64::INFINITY];
                Curve::Modified { base_radius, half_base_angle, relief, smooth }
            }
        };
        let (end_roll, top) = tip.segments(gear, &flank, form_roll)?;
        let mut segments = land(&root, PI / f64::from(gear.specification.teeth));
        segments.extend(root);
        let begin = flank.point(form_roll);
        if let Some(last) = segments.last().map(Segment::end)
            && libm::hypot(begin[0] - last[0], begin[1] - last[1]) > NO_STEP.max(1e-12 * base_radius)
        {
            segments.push(Segment::straight(OutlinePart::Step, last, begin));
        }
        let inner = breaks.into_iter().filter(|place| *place > form_roll && *place < end_roll);
        let places: Vec<f64> = std::iter::once(form_roll).chain(inner).chain([end_roll]).collect();
        segments.extend(places.windows(2).map(|ends| Segment {
            part: OutlinePart::Flank,
            curve: flank.between(ends[0], ends[1]),
            from: ends[0],
            to: ends[1],
        }));
        segments.extend(top);
        Ok(Self { segments, teeth: gear.specification.teeth, form_roll, end_roll })
    }

    /// Half the angle of the pitch \[rad\].
    #[must_use]
    pub fn half_pitch(&self) -> f64 {
        PI / f64::from(self.teeth)
    }
}

/// The part of the root circle that the root leaves free, if any.
fn land(root: &[Segment], half_pitch: f64) -> Vec<Segment> {
    let Some([x, y]) = root.first().map(Segment::start) else { return Vec::new() };
    let angle = libm::atan2(x, y);
    if half_pitch - angle <= NO_LAND {
        return Vec::new();
    }
    vec![Segment::about_centre(OutlinePart::RootLand, libm::hypot(x, y), half_pitch, angle)]
}

impl Toe {
    /// The same root as it is known to the methods of compliance.
    #[must_use]
    pub fn of(root: &Root) -> Self {
        let segment = |piece: &Piece| {
            let (from, to) = piece.range();
            match *piece {
                Piece::Trochoid(curve) => Segment { part: OutlinePart::Root, curve: Curve::Trochoid(curve), from, to },
                Piece::Arc { centre_radius, centre_angle, radius, start, extent } => {
                    let (sine, cosine) = libm::sincos(centre_angle);
                    let curve = Curve::Arc { centre: [centre_radius * sine, centre_radius * cosine], radius };
                    // From the point towards the gear's centre, clockwise.
                    let lowest = 1.5 * PI - centre_angle;
                    Segment { part: OutlinePart::Root, curve, from: lowest - start, to: lowest - extent }
                }
                Piece::Involute { base_radius, half_base_angle, .. } => {
                    let curve = Curve::Involute { base_radius, half_base_angle };
                    Segment { part: OutlinePart::Root, curve, from, to }
                }
                Piece::Radial { angle, lower, upper } => {
                    let (sine, cosine) = libm::sincos(angle);
                    let curve = Curve::Line { start: [0.0; 2], direction: [sine, cosine] };
                    Segment { part: OutlinePart::Root, curve, from: lower, to: upper }
                }
            }
        };
        Self { segments: root.pieces.iter().map(segment).collect(), form_roll: root.form_roll }
    }
}
