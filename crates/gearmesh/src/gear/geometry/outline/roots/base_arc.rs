//! Arcs that leave the tooth on the base circle along the radius there: what the families of arcs share.
//!
//! A is the point of the flank on the base circle, θ = ψ_b its angle from the tooth's centreline, and the flank is radial
//! there. The centre C lies beside A at a right angle to the radius, so |C|² = r_b² + r_c². Source: Zhai, Liang and Fu, A
//! Mathematical Model for Parametric Tooth Profile of Spur Gears, Mathematical Problems in Engineering 2020, equations
//! 13 to 20 and 26 to 30. Must not know: which family asks.

use std::f64::consts::{FRAC_PI_2, PI};

use super::super::curve::{Curve, OutlinePart, Segment};
use crate::gear::geometry::Gear;
use crate::gear::geometry::error::{GeometryError, Millimetres, Plain, Problem};

/// What the construction starts from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Base {
    /// r_b \[m\].
    pub base_radius: f64,
    /// r_f \[m\].
    pub root_radius: f64,
    /// θ = ψ_b \[rad\].
    pub angle: f64,
    /// π/z \[rad\]: the middle of the space.
    pub half_pitch: f64,
    /// A \[m\].
    pub a: [f64; 2],
}

/// A circle: X = (x_c, y_c, r_c) of equation 27 \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// (x_c, y_c) in the tooth's frame.
    pub centre: [f64; 2],
    /// r_c.
    pub radius: f64,
}

impl Base {
    /// # Errors
    /// When the root circle does not lie inside the base circle: nothing is left for the arc to bridge.
    pub fn new(gear: &Gear, construction: &'static str) -> Result<Self, GeometryError> {
        let (base_radius, root_radius) = (gear.base_radius, gear.root_radius);
        if root_radius >= base_radius {
            let rack = gear.dedendum() - gear.specification.generating_profile_shift();
            let teeth = 2.0 * rack / (1.0 - libm::cos(gear.specification.pressure_angle));
            return Err(Problem::NothingBelowBase {
                construction,
                root: Millimetres(root_radius),
                base: Millimetres(base_radius),
                teeth: gear.specification.teeth,
                maximum: Plain(teeth),
            }
            .into());
        }
        let (sine, cosine) = libm::sincos(gear.half_base_angle);
        Ok(Self {
            base_radius,
            root_radius,
            angle: gear.half_base_angle,
            half_pitch: PI / f64::from(gear.specification.teeth),
            a: [base_radius * sine, base_radius * cosine],
        })
    }

    /// The circle of a radius that leaves A along the flank.
    #[must_use]
    pub fn tangent_circle(&self, radius: f64) -> Circle {
        let (sine, cosine) = libm::sincos(self.angle);
        Circle { centre: [self.a[0] + radius * cosine, self.a[1] - radius * sine], radius }
    }

    /// Equations 17 to 20, with the sign in 20 that puts the lowest point H = r_b − r_f below A.
    #[must_use]
    pub fn article_circle(&self) -> Circle {
        self.tangent_circle(self.article_radius())
    }

    /// r_c = H/(1 + sin θ), equations 17 and 18.
    #[must_use]
    pub fn article_radius(&self) -> f64 {
        (self.base_radius - self.root_radius) / (1.0 + libm::sin(self.angle))
    }

    /// r_c = (r_b² − r_f²)/(2 r_f): the circle touches the root circle, r_f + r_c = √(r_b² + r_c²).
    #[must_use]
    pub fn touching_radius(&self) -> f64 {
        (self.base_radius - self.root_radius) * (self.base_radius + self.root_radius) / (2.0 * self.root_radius)
    }

    /// The radius with which the centre lies in the middle of the space; larger circles overlap.
    #[must_use]
    pub fn middle_radius(&self) -> f64 {
        self.base_radius * libm::tan(self.half_pitch - self.angle)
    }

    /// How far the circle's nearest point to the gear's centre lies outside the root circle \[m\].
    #[must_use]
    pub fn gap(&self, circle: Circle) -> f64 {
        libm::hypot(circle.centre[0], circle.centre[1]) - circle.radius - self.root_radius
    }

    /// The circle from A down to whichever comes first: the root circle, the middle of the space, or its lowest point
    /// towards `down` \[rad\], and from there straight to the root circle.
    #[must_use]
    pub fn segments(&self, circle: Circle, down: f64) -> Vec<Segment> {
        let Circle { centre, radius } = circle;
        // Angles about the arc's centre; the way down is counterclockwise.
        let start = libm::atan2(self.a[1] - centre[1], self.a[0] - centre[0]);
        let start = if start < 0.0 { start + 2.0 * PI } else { start };
        let distance = libm::hypot(centre[0], centre[1]);
        let place = libm::atan2(centre[1], centre[0]);
        let root =
            (self.root_radius * self.root_radius - distance * distance - radius * radius) / (2.0 * radius * distance);
        let (sine, cosine) = libm::sincos(self.half_pitch);
        let beside = (centre[1] * sine - centre[0] * cosine) / radius;
        // A circle that only touches the root circle may miss it by a rounding.
        let root = if (-1.0 - 1e-12..=-1.0).contains(&root) { -1.0 } else { root };
        let reaches = |place: f64| place.is_finite() && place >= start;
        let root = Some(place + libm::acos(root)).filter(|place| reaches(*place));
        let middle = Some(2.0 * PI - libm::acos(beside) - self.half_pitch).filter(|place| reaches(*place));
        let end = [root, middle].into_iter().flatten().fold(down, f64::min);
        let arc = Segment { part: OutlinePart::Root, curve: Curve::Arc { centre, radius }, from: end, to: start };
        let lowest = arc.start();
        let height = libm::hypot(lowest[0], lowest[1]);
        let stops = [root, middle].into_iter().flatten().all(|place| end < place - SAME_PLACE);
        let mut segments = Vec::new();
        if stops && height > self.root_radius * (1.0 + 1e-12) {
            let foot = lowest.map(|part| part * self.root_radius / height);
            segments.push(Segment::straight(OutlinePart::Step, foot, lowest));
        }
        segments.push(arc);
        segments
    }
}

/// Angle \[rad\] within which two ends of an arc are the same: where circles touch, errors are the roots of roundings.
const SAME_PLACE: f64 = 1e-6;

/// The direction in which equation 18 has B below C: down the page.
pub const DOWN_THE_PAGE: f64 = 3.0 * FRAC_PI_2;
