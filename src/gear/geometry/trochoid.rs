//! The root curve that a rack's tip round cuts: the trochoid, and where it meets the involute.
//!
//! Frame of the tooth: origin in the gear's centre, y along the tooth's centreline, x to its right flank; lengths in m.
//! The parameter γ \[rad\] is the angle between the common normal and the pitch line: π/2 at the root circle, α where the
//! round ends. The normal always passes through the pitch point (the law of gearing), which gives the curve without an
//! envelope condition. Must not know: the mating gear.

use std::f64::consts::{FRAC_PI_2, PI};

use super::Specification;
use super::involute::{inverse_roll, point_angle};
use crate::numeric::crossing::crossing;

/// One gear's generated root curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trochoid {
    reference_radius: f64,
    /// Half the angular pitch, π/z.
    half_pitch: f64,
    /// Depth of the round's centre below the rolling line \[m\].
    depth: f64,
    /// Distance of the round's centre from the rack tooth's centreline \[m\].
    offset: f64,
    /// ρ_fP \[m\].
    radius: f64,
    /// α.
    pressure_angle: f64,
}

/// A point of a curve and its derivative by the curve's parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    pub x: f64,
    pub y: f64,
    pub dx: f64,
    pub dy: f64,
}

impl Point {
    #[must_use]
    pub fn radius(&self) -> f64 {
        libm::hypot(self.x, self.y)
    }

    /// Angle from the tooth's centreline \[rad\].
    #[must_use]
    pub fn angle(&self) -> f64 {
        libm::atan2(self.x, self.y)
    }
}

impl Trochoid {
    #[must_use]
    pub fn new(gear: &Specification) -> Self {
        let (m, rack, alpha) = (gear.module, &gear.rack, gear.pressure_angle);
        Self {
            reference_radius: 0.5 * m * f64::from(gear.teeth),
            half_pitch: PI / f64::from(gear.teeth),
            depth: m * (rack.dedendum - gear.profile_shift - rack.tip_radius),
            offset: m
                * (0.25 * PI
                    - (rack.dedendum - rack.tip_radius) * libm::tan(alpha)
                    - rack.tip_radius / libm::cos(alpha)),
            radius: m * rack.tip_radius,
            pressure_angle: alpha,
        }
    }

    /// Half the width of the rack tooth's flat tip \[m\]; negative when the round does not fit.
    #[must_use]
    pub fn rack_tip_land(&self) -> f64 {
        self.offset
    }

    /// The point at γ, of the right flank.
    #[must_use]
    pub fn point(&self, gamma: f64) -> Point {
        let (sin, cos) = (libm::sin(gamma), libm::cos(gamma));
        let (r, a) = (self.reference_radius, self.depth);
        let reach = a / sin + self.radius;
        let reach_slope = -a * cos / (sin * sin);
        let (across, deep) = (reach * cos, reach * sin);
        let (across_slope, deep_slope) = (reach_slope * cos - deep, reach_slope * sin + across);
        let theta = self.half_pitch + (a * cos / sin - self.offset) / r;
        let theta_slope = -a / (sin * sin * r);
        let (s, c) = (libm::sin(theta), libm::cos(theta));
        let high = r - deep;
        Point {
            x: high * s - across * c,
            y: high * c + across * s,
            dx: -deep_slope * s - across_slope * c + theta_slope * (high * c + across * s),
            dy: -deep_slope * c + across_slope * s - theta_slope * (high * s - across * c),
        }
    }

    /// Path distance \[m\] from the tangent point at which the rack's straight flank ends; negative when it undercuts.
    #[must_use]
    pub fn flank_end(&self) -> f64 {
        let alpha = self.pressure_angle;
        let sin = libm::sin(alpha);
        self.reference_radius * sin - (self.depth + self.radius * sin) / sin
    }

    /// Where root curve and involute meet: (γ, roll angle). Undercut is found as an intersection, never assumed.
    #[must_use]
    pub fn junction(&self, base_radius: f64, half_base_angle: f64) -> (f64, f64) {
        let end = self.flank_end();
        if end >= 0.0 {
            return (self.pressure_angle, end / base_radius);
        }
        // Signed angle from the involute to the curve; negative where the curve has cut into the tooth.
        let cut = |gamma: f64| {
            let point = self.point(gamma);
            let roll = inverse_roll(point.radius(), base_radius);
            point.angle() - point_angle(roll, half_base_angle)
        };
        let height = |gamma: f64| self.point(gamma).radius() - base_radius;
        let (lowest, highest) = (FRAC_PI_2, self.pressure_angle);
        let at_base = crossing(height, (lowest, height(lowest)), (highest, height(highest)), 1e-15);
        // Just inside, so that rounding cannot take the radius below the base circle on the wrong side of the root.
        let gamma = crossing(cut, (at_base, cut(at_base).min(-f64::MIN_POSITIVE)), (highest, cut(highest)), 1e-16);
        (gamma, inverse_roll(self.point(gamma).radius(), base_radius))
    }
}
