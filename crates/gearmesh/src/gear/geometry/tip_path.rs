//! The way of the mate's tip through a gear's spaces, and how far it stays from the root: the clearance of a drawn root.
//!
//! Seen from the gear, a point of the mate moves on an extended epicycloid, whose normal always passes through the pitch
//! point. So the foot of a root's point on that path is where the root's point, the corner and the pitch point are on one
//! line. This is one equation for β, the corner's angle from the line of centres, solved by Newton's method in three to
//! five steps. Along the root the distance is searched on each curve from `LOOKS` intervals. A rounding is a circle that
//! moves with its centre; it lies inside the tooth, and whether the flank beside it reaches too low is another question.
//! Between two corners of a tip the mate is farther away, since roots are concave, and the tip circle is nearest in the
//! middle of the space. The flanks are assumed to touch on the side of the root, unmodified.
//! Source: Litvin and Fuentes, Gear Geometry and Applied Theory (2004), section 10.9. Must not know: which root it is.

use std::f64::consts::PI;

use super::outline::Outline;
use super::outline::curve::{Curve, OutlinePart, Segment};
use super::{Gear, GearPair, Side};
use crate::numeric::crossing;

/// Intervals of each curve in which the distance is sampled; the one with the least is refined.
const LOOKS: usize = 8;
/// A step of β \[rad\] after which Newton's method is done: the distance is off by its square.
const SETTLED: f64 = 1e-8;
/// The longest step of β \[rad\].
const STRIDE: f64 = 0.2;
const MOST_STEPS: u32 = 30;

/// What the mate's root meets of a tip: a corner, or a rounding about a centre; in the frame of its own tooth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// Distance from its gear's centre \[m\].
    pub radius: f64,
    /// Angle from its tooth's centreline \[rad\].
    pub half_angle: f64,
    /// Radius of the rounding \[m\]; 0 for a corner.
    pub round: f64,
}

impl Corner {
    /// The corner of an unbroken, unmodified tip.
    #[must_use]
    pub fn of(gear: &Gear) -> Self {
        Self { radius: gear.tip_radius, half_angle: gear.half_angle_at_roll(gear.tip_roll()), round: 0.0 }
    }

    fn at([x, y]: [f64; 2], round: f64) -> Self {
        Self { radius: libm::hypot(x, y), half_angle: libm::atan2(x, y), round }
    }

    /// The corners of a tip as drawn: one, the two of a chamfer, or a rounding.
    #[must_use]
    pub fn all(outline: &Outline) -> Vec<Self> {
        let mut corners = Vec::new();
        for segment in &outline.segments {
            match (segment.part, &segment.curve) {
                (OutlinePart::TipBreak, Curve::Arc { centre, radius }) => corners.push(Self::at(*centre, *radius)),
                // The land begins on the rounding.
                (OutlinePart::TipLand, _) if corners.iter().any(|corner| corner.round > 0.0) => {}
                (OutlinePart::TipBreak | OutlinePart::TipLand, _) => corners.push(Self::at(segment.start(), 0.0)),
                _ => {}
            }
        }
        corners
    }
}

/// The mate's tip as a gear of a pair sees it.
#[derive(Clone, Debug, PartialEq)]
pub struct TipPath {
    /// a_w \[m\].
    centre_distance: f64,
    /// r_w of the gear \[m\].
    pitch_radius: f64,
    /// r_a of the mate \[m\].
    tip_radius: f64,
    /// How far the gear turns while the mate turns by 1.
    turn: f64,
    /// π/z of the gear.
    half_pitch: f64,
    /// Half the backlash, as an angle of the gear.
    slack: f64,
    corners: Vec<Corner>,
}

impl TipPath {
    /// The tip of a gear's mate, with the corners of that tip.
    #[must_use]
    pub fn new(pair: &GearPair, side: Side, corners: Vec<Corner>) -> Self {
        let (own, mate) = (pair.side(side), pair.side(side.other()));
        let half_pitch = PI / f64::from(own.specification.teeth);
        let turn = f64::from(mate.specification.teeth) / f64::from(own.specification.teeth);
        let working = libm::tan(pair.working_pressure_angle);
        let space = half_pitch - own.half_angle_at_roll(working);
        Self {
            centre_distance: pair.centre_distance,
            pitch_radius: own.base_radius / libm::cos(pair.working_pressure_angle),
            tip_radius: mate.tip_radius,
            turn,
            half_pitch,
            slack: space - mate.half_angle_at_roll(working) * turn,
            corners,
        }
    }

    /// The least distance \[m\] of the tip from the root of a right half of a tooth, below its flank; negative where the
    /// tip cuts in. `segments` go upwards from the middle of the space.
    #[must_use]
    pub fn distance(&self, segments: &[Segment]) -> f64 {
        let Some([x, y]) = segments.first().map(Segment::start) else { return f64::INFINITY };
        let below = self.centre_distance - self.tip_radius - libm::hypot(x, y);
        // On the land of the root circle nothing is nearer than `below`.
        let curves = segments.iter().take_while(|segment| segment.part != OutlinePart::Flank);
        let curves = curves.filter(|segment| segment.part != OutlinePart::RootLand);
        let of_curve = |segment| self.corners.iter().map(move |corner| self.distance_to(corner, segment));
        curves.flat_map(of_curve).fold(below, f64::min)
    }

    fn distance_to(&self, corner: &Corner, segment: &Segment) -> f64 {
        let look = |look: usize| self.foot(corner, segment, segment.parameter(look as f64 / LOOKS as f64));
        let looks: [Foot; LOOKS + 1] = std::array::from_fn(look);
        let Some(nearest) = (0..looks.len()).min_by(|a, b| looks[*a].distance.total_cmp(&looks[*b].distance)) else {
            return f64::INFINITY;
        };
        let here = looks[nearest];
        let beside = if here.slope > 0.0 { nearest.wrapping_sub(1) } else { nearest + 1 };
        let Some(other) = looks.get(beside).filter(|other| other.slope * here.slope < 0.0) else {
            return here.distance;
        };
        let tolerance = 1e-6 * (other.parameter - here.parameter).abs();
        let slope = |parameter: f64| self.foot(corner, segment, parameter).slope;
        let ends = [(here.parameter, here.slope), (other.parameter, other.slope)];
        let parameter = crossing::crossing(slope, ends[0], ends[1], tolerance);
        self.foot(corner, segment, parameter).distance.min(here.distance)
    }

    /// The foot of a curve's point on the path.
    fn foot(&self, corner: &Corner, segment: &Segment, parameter: f64) -> Foot {
        let local = segment.local(parameter);
        let (a, r) = (self.centre_distance, corner.radius);
        let height = libm::hypot(local.position[0], local.position[1]);
        // From where the corner passes at the same height, or from its lowest point.
        let mut beta = libm::acos(((a * a + r * r - height * height) / (2.0 * a * r)).clamp(-1.0, 1.0));
        let mut at = self.at(corner, beta);
        for _ in 0..MOST_STEPS {
            // From the pitch point to the curve's point and to the corner; the rates of both over β.
            let [px, py] = at.turned(local.position);
            let [across, up] = [px, py - self.pitch_radius];
            let [cx, cy] = at.from_pitch_point;
            let [rx, ry] = at.rate;
            let line = across * cy - up * cx;
            let rate = self.turn * (py * cy + px * cx) + across * ry - up * rx;
            let step = (line / rate).clamp(-STRIDE, STRIDE);
            beta -= step;
            at = self.at(corner, beta);
            if step.is_nan() || step.abs() < SETTLED {
                break;
            }
        }
        let [px, py] = at.turned(local.position);
        let [cx, cy] = at.from_pitch_point;
        let length = libm::hypot(cx, cy);
        let [along, out] = at.turned(local.tangent);
        Foot {
            parameter,
            distance: ((px - cx) * cx + (py - self.pitch_radius - cy) * cy) / length - corner.round,
            slope: (along * cx + out * cy) / length,
        }
    }

    /// Gear and corner while the corner is at β from the line of centres.
    fn at(&self, corner: &Corner, beta: f64) -> Position {
        let (sine, cosine) = libm::sincos(beta);
        let [across, down] = [corner.radius * sine, corner.radius * cosine];
        let turned = (beta - corner.half_angle) * self.turn - self.slack;
        Position {
            turn: libm::sincos(self.half_pitch + turned),
            from_pitch_point: [across, self.centre_distance - down - self.pitch_radius],
            rate: [down, across],
        }
    }
}

/// A position of the pair: x across the line of centres towards the tooth, y from the gear's centre to the mate's.
struct Position {
    /// Sine and cosine of the angle between the line of centres and the tooth's centreline.
    turn: (f64, f64),
    /// From the pitch point to the corner \[m\], and its rate over β.
    from_pitch_point: [f64; 2],
    rate: [f64; 2],
}

impl Position {
    /// A vector of the tooth's frame, whose x points the other way.
    fn turned(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sine, cosine) = self.turn;
        [sine * y - cosine * x, cosine * y + sine * x]
    }
}

/// A point of a curve as the path sees it.
#[derive(Clone, Copy)]
struct Foot {
    parameter: f64,
    /// Signed distance from the path, positive outside of the mate \[m\].
    distance: f64,
    /// How the distance changes along the curve, per length.
    slope: f64,
}
