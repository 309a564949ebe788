//! Root shapes: the half section of a tooth from where it is clamped up to where its involute starts.
//!
//! Frame of the tooth as in `trochoid.rs`. Every shape is a list of smooth pieces, each parametrised so that Gauss
//! quadrature converges fast. Must not know: what is integrated along it.

use std::f64::consts::FRAC_PI_2;

use super::Gear;
use super::involute::{inv, point_angle};
use super::trochoid::{Point, Trochoid};

/// The shape of the tooth below its involute.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RootShape {
    /// As the rack's tip round cuts it.
    Trochoid,
    /// A circular arc with the rack's tip radius, tangent to the root circle and to the flank; where the arc would touch
    /// below the base circle, a radial line continues the flank down to it.
    CircularFillet,
    /// None: the tooth is clamped where its involute starts, at the base circle or, if that lies inside the body, at the
    /// root circle.
    BaseCircle,
}

/// One smooth piece of a root curve, from the root up.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Piece {
    /// Parameter q with cot γ = sinh q: evens out the curve's sharp turn near the root.
    Trochoid { curve: Trochoid, start: f64, end: f64 },
    /// Parameter: direction from the centre, measured from the y axis.
    Arc { centre: (f64, f64), radius: f64, start: f64, end: f64 },
    /// Parameter: radius, along the direction ψ.
    Radial { angle: f64, start: f64, end: f64 },
}

/// The root of one tooth: pieces, and the roll angle at which the involute takes over.
#[derive(Clone, Debug, PartialEq)]
pub struct Root {
    pieces: Vec<Piece>,
    /// Roll angle of the involute's lowest point that is part of the tooth.
    pub junction_roll: f64,
    /// θ_f: half the angle of the tooth where it is clamped \[rad\].
    pub half_angle: f64,
    /// y of the section where it is clamped \[m\].
    pub clamped_height: f64,
}

impl Root {
    #[must_use]
    pub fn new(gear: &Gear, shape: RootShape) -> Self {
        let (pieces, junction_roll) = match shape {
            RootShape::Trochoid => trochoid(gear),
            RootShape::CircularFillet => circular_fillet(gear),
            RootShape::BaseCircle => (Vec::new(), gear.roll_at(gear.root_radius)),
        };
        let foot = pieces.first().map(|piece| piece.point(piece.ends().0));
        let (half_angle, clamped_height) = foot.map_or_else(
            || {
                let angle = point_angle(junction_roll, gear.half_base_angle);
                (angle, gear.radius_at(junction_roll) * libm::cos(angle))
            },
            |foot| (foot.angle(), foot.y),
        );
        Self { pieces, junction_roll, half_angle, clamped_height }
    }

    /// Calls `integrate(start, end, point)` for every piece; `point` gives the section at a parameter in between.
    pub fn for_each(&self, mut integrate: impl FnMut(f64, f64, &dyn Fn(f64) -> Point)) {
        for piece in &self.pieces {
            let (start, end) = piece.ends();
            integrate(start, end, &|parameter| piece.point(parameter));
        }
    }
}

impl Piece {
    fn ends(&self) -> (f64, f64) {
        match *self {
            Self::Trochoid { start, end, .. } | Self::Arc { start, end, .. } | Self::Radial { start, end, .. } => {
                (start, end)
            }
        }
    }

    fn point(&self, parameter: f64) -> Point {
        match *self {
            Self::Trochoid { ref curve, .. } => {
                let (sinh, cosh) = (libm::sinh(parameter), libm::cosh(parameter));
                let Point { x, y, dx, dy } = curve.point(libm::atan2(1.0, sinh));
                // dγ/dq = −1/cosh q.
                Point { x, y, dx: -dx / cosh, dy: -dy / cosh }
            }
            Self::Arc { centre, radius, .. } => {
                let (sin, cos) = (libm::sin(parameter), libm::cos(parameter));
                Point { x: centre.0 + radius * sin, y: centre.1 + radius * cos, dx: radius * cos, dy: -radius * sin }
            }
            Self::Radial { angle, .. } => {
                let (sin, cos) = (libm::sin(angle), libm::cos(angle));
                Point { x: parameter * sin, y: parameter * cos, dx: sin, dy: cos }
            }
        }
    }
}

fn trochoid(gear: &Gear) -> (Vec<Piece>, f64) {
    let curve = Trochoid::new(&gear.specification);
    let (gamma, roll) = curve.junction(gear.base_radius, gear.half_base_angle);
    let end = libm::asinh(1.0 / libm::tan(gamma));
    (vec![Piece::Trochoid { curve, start: 0.0, end }], roll)
}

fn circular_fillet(gear: &Gear) -> (Vec<Piece>, f64) {
    let radius = gear.specification.rack.tip_radius * gear.specification.module;
    let centre_radius = gear.root_radius + radius;
    // The centre lies on the parallel of the involute at the distance ρ: an involute that starts ρ/r_b earlier.
    let on_involute = (centre_radius > gear.base_radius)
        .then(|| {
            let angle = libm::acos(gear.base_radius / centre_radius);
            (
                libm::tan(angle) - radius / gear.base_radius,
                gear.half_base_angle + radius / gear.base_radius - inv(angle),
            )
        })
        .filter(|(roll, _)| *roll >= 0.0);
    let (junction_roll, centre_angle, touching_radius) = match on_involute {
        Some((roll, angle)) => (roll, angle, gear.radius_at(roll)),
        None => {
            let touching = ((centre_radius - radius) * (centre_radius + radius)).sqrt();
            (0.0, gear.half_base_angle + libm::asin(radius / centre_radius), touching)
        }
    };
    let touching_angle = point_angle(junction_roll, gear.half_base_angle);
    let centre = (centre_radius * libm::sin(centre_angle), centre_radius * libm::cos(centre_angle));
    let touching = (touching_radius * libm::sin(touching_angle), touching_radius * libm::cos(touching_angle));
    // From the root circle, straight below the centre, to the flank, on the side towards the tooth.
    let start = centre_angle - 2.0 * FRAC_PI_2;
    let mut end = libm::atan2(touching.0 - centre.0, touching.1 - centre.1);
    if end < start {
        end += 4.0 * FRAC_PI_2;
    }
    let mut pieces = vec![Piece::Arc { centre, radius, start, end }];
    if on_involute.is_none() && touching_radius < gear.base_radius {
        pieces.push(Piece::Radial { angle: gear.half_base_angle, start: touching_radius, end: gear.base_radius });
    }
    (pieces, junction_roll)
}
