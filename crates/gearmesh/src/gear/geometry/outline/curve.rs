//! The exact curves a profile is made of: point, direction and curvature at a parameter.
//!
//! Tooth frame: y along the tooth's centreline from the gear's centre, x across. The gear's outline runs
//! counterclockwise, so the right half of a tooth goes upwards, the body is on the left, and a curvature is positive
//! where the profile is convex. Source of the involute: ISO 21771-1:2024, section 5. Must not know: what a curve is part
//! of, how many points are wanted.

use std::f64::consts::FRAC_PI_2;
use std::fmt::Debug;
use std::sync::Arc as Shared;

use crate::gear::geometry::trochoid::Trochoid;

/// Step of the roll angle \[rad\] for the slope and the bend of a relief: the rounding of a depth of 1e-5 m
/// and the next term of the difference are both below 1e-9 of the direction and 1e-4 of the curvature.
const STEP: f64 = 1e-4;

/// What is taken off a flank, normal to it \[m\], over the roll angle \[rad\]; positive into the material.
pub trait Relief: Debug + Send + Sync {
    /// Continuous, and defined for every roll angle.
    fn depth(&self, roll: f64) -> f64;

    /// Roll angles at which the depth is not smooth, ascending.
    fn breaks(&self) -> Vec<f64>;
}

/// A smooth curve over its parameter.
#[derive(Clone, Debug)]
pub enum Curve {
    /// Over the length from its start; `direction` is a unit vector.
    Line {
        /// Where the parameter is 0 \[m\].
        start: [f64; 2],
        /// Unit vector towards larger parameters.
        direction: [f64; 2],
    },
    /// Over the angle about its centre, counterclockwise from the x axis.
    Arc {
        /// Its centre \[m\].
        centre: [f64; 2],
        /// Its radius \[m\].
        radius: f64,
    },
    /// Over q = asinh(cot γ).
    Trochoid(Trochoid),
    /// Over the roll angle.
    Involute {
        /// r_b \[m\].
        base_radius: f64,
        /// ψ_b \[rad\].
        half_base_angle: f64,
    },
    /// The same, with a relief taken off along its normals; the relief is smooth between the two roll angles of `smooth`.
    Modified {
        /// r_b \[m\].
        base_radius: f64,
        /// ψ_b \[rad\].
        half_base_angle: f64,
        /// What is taken off.
        relief: Shared<dyn Relief>,
        /// The two roll angles \[rad\]; infinite on a side where no break is known.
        smooth: [f64; 2],
    },
}

/// Where a curve is at a parameter, and how it runs there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Local {
    /// \[m\].
    pub position: [f64; 2],
    /// Unit tangent, towards larger parameters.
    pub tangent: [f64; 2],
    /// \[1/m\], positive where the curve turns left towards larger parameters.
    pub curvature: f64,
    /// \[m\] of length per unit of the parameter.
    pub speed: f64,
}

impl Curve {
    /// Its name in tables and drawings.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Line { .. } => "line",
            Self::Arc { .. } => "arc",
            Self::Trochoid(_) => "trochoid",
            Self::Involute { .. } => "involute",
            Self::Modified { .. } => "modified_involute",
        }
    }

    /// The line from one point to another, and its length.
    #[must_use]
    pub fn line(start: [f64; 2], end: [f64; 2]) -> (Self, f64) {
        let length = libm::hypot(end[0] - start[0], end[1] - start[1]);
        let direction = if length > 0.0 { [0, 1].map(|axis| (end[axis] - start[axis]) / length) } else { [0.0, 1.0] };
        (Self::Line { start, direction }, length)
    }

    /// The same curve, known to be smooth between two parameters.
    #[must_use]
    pub fn between(&self, low: f64, high: f64) -> Self {
        let mut curve = self.clone();
        if let Self::Modified { smooth, .. } = &mut curve {
            *smooth = [low, high];
        }
        curve
    }

    /// The point \[m\] at a parameter.
    #[must_use]
    pub fn point(&self, parameter: f64) -> [f64; 2] {
        match self {
            Self::Line { start, direction } => [0, 1].map(|axis| start[axis] + parameter * direction[axis]),
            Self::Arc { centre, radius } => {
                let (sine, cosine) = libm::sincos(parameter);
                [centre[0] + radius * cosine, centre[1] + radius * sine]
            }
            Self::Trochoid(curve) => curve.point_at(parameter),
            Self::Involute { base_radius, half_base_angle } => {
                let (sine, cosine) = libm::sincos(parameter - half_base_angle);
                [base_radius * (parameter * cosine - sine), base_radius * (cosine + parameter * sine)]
            }
            Self::Modified { base_radius, half_base_angle, relief, .. } => {
                let (sine, cosine) = libm::sincos(parameter - half_base_angle);
                let along = base_radius * parameter - relief.depth(parameter);
                [along * cosine - base_radius * sine, base_radius * cosine + along * sine]
            }
        }
    }

    /// Point, tangent and curvature at a parameter.
    #[must_use]
    pub fn local(&self, parameter: f64) -> Local {
        let position = self.point(parameter);
        match self {
            Self::Line { direction, .. } => Local { position, tangent: *direction, curvature: 0.0, speed: 1.0 },
            Self::Arc { radius, .. } => {
                let (sine, cosine) = libm::sincos(parameter);
                Local { position, tangent: [-sine, cosine], curvature: 1.0 / radius, speed: *radius }
            }
            Self::Trochoid(curve) => {
                let (tilt, rate, turning) = curve.rates(parameter);
                let (sine, cosine) = libm::sincos(tilt);
                // dγ/dq = −1/cosh q.
                let speed = (rate / libm::cosh(parameter)).abs();
                Local { position, tangent: [-sine, cosine], curvature: -turning / rate, speed }
            }
            Self::Involute { base_radius, half_base_angle } => {
                let (sine, cosine) = libm::sincos(parameter - half_base_angle);
                let speed = base_radius * parameter;
                Local { position, tangent: [-sine, cosine], curvature: 1.0 / speed, speed }
            }
            Self::Modified { base_radius, half_base_angle, relief, smooth: [low, high] } => {
                let (sine, cosine) = libm::sincos(parameter - half_base_angle);
                let at = relief.depth(parameter);
                // A parabola through three places on this side of a break.
                let step = STEP.min(0.5 * (high - low));
                let middle = parameter.max(low + step).min(high - step);
                let [before, here, after] = [-step, 0.0, step].map(|by| relief.depth(middle + by));
                let bend = (after - 2.0 * here + before) / (step * step);
                let slope = (after - before) / (2.0 * step) + bend * (parameter - middle);
                // In the frame of the flank's normal, which turns by the roll angle: the point is `along` out on it.
                let along = base_radius * parameter - at;
                let speed = libm::hypot(slope, along);
                // On the base circle an unrelieved flank starts with no length, along the radius.
                let (out, up) = if speed > 0.0 { (-slope / speed, along / speed) } else { (0.0, 1.0) };
                let turning = along * (bend + along) - slope * (base_radius - 2.0 * slope);
                Local {
                    position,
                    tangent: [out * cosine - up * sine, out * sine + up * cosine],
                    curvature: turning / (speed * speed * speed),
                    speed,
                }
            }
        }
    }
}

/// A stretch of a curve, from one parameter to the other.
#[derive(Clone, Debug)]
pub struct Segment {
    /// The part of the tooth it belongs to.
    pub part: OutlinePart,
    /// The curve it lies on.
    pub curve: Curve,
    /// The curve's parameter where it starts.
    pub from: f64,
    /// The curve's parameter where it ends; it may be the smaller of the two.
    pub to: f64,
}

/// Which part of the tooth a segment is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutlinePart {
    /// Arc about the gear's centre between the roots of two neighbouring teeth, where they leave room for one.
    RootLand,
    /// From the root land, or the middle of the space, up to where the flank begins.
    Root,
    /// Radial, or normal to the flank, where two curves do not meet.
    Step,
    /// The involute, as modified; between two breaks of a relief each stretch is a segment of its own.
    Flank,
    /// Chamfer or rounding between flank and tip land.
    TipBreak,
    /// Arc of the tip circle, up to the tooth's centreline.
    TipLand,
}

impl OutlinePart {
    /// Its name in tables and drawings.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::RootLand => "root_land",
            Self::Root => "root",
            Self::Step => "step",
            Self::Flank => "flank",
            Self::TipBreak => "tip_break",
            Self::TipLand => "tip_land",
        }
    }
}

impl Segment {
    /// The parameter at a share of the way, 0 to 1. Equal shares are equal lengths, except on a trochoid, where they are
    /// equal steps of q, and except for what a relief adds.
    #[must_use]
    pub fn parameter(&self, share: f64) -> f64 {
        let blend = |from: f64, to: f64| from * (1.0 - share) + to * share;
        match self.curve {
            // The length of an involute goes with the square of the roll angle.
            Curve::Involute { .. } | Curve::Modified { .. } => {
                blend(self.from * self.from, self.to * self.to).sqrt().clamp(self.from, self.to)
            }
            _ => blend(self.from, self.to),
        }
    }

    /// Position, tangent and curvature in the direction of travel.
    #[must_use]
    pub fn local(&self, parameter: f64) -> Local {
        let local = self.curve.local(parameter);
        if self.to >= self.from {
            return local;
        }
        // A trochoid's own tangent already points up; the other curves turn with the direction of travel.
        Local { tangent: local.tangent.map(|part| -part), curvature: -local.curvature, ..local }
    }

    /// The point \[m\] where it starts.
    #[must_use]
    pub fn start(&self) -> [f64; 2] {
        self.curve.point(self.from)
    }

    /// The point \[m\] where it ends.
    #[must_use]
    pub fn end(&self) -> [f64; 2] {
        self.curve.point(self.to)
    }

    /// A straight segment between two points.
    #[must_use]
    pub fn straight(part: OutlinePart, start: [f64; 2], end: [f64; 2]) -> Self {
        let (curve, length) = Curve::line(start, end);
        Self { part, curve, from: 0.0, to: length }
    }

    /// A part of a circle about the gear's centre, between two angles from the tooth's centreline, clockwise positive.
    #[must_use]
    pub fn about_centre(part: OutlinePart, radius: f64, from: f64, to: f64) -> Self {
        Self { part, curve: Curve::Arc { centre: [0.0; 2], radius }, from: FRAC_PI_2 - from, to: FRAC_PI_2 - to }
    }
}
