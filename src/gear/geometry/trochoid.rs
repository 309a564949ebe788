//! The root curve that a rack with a rounded tip generates: the envelope of the tip round, and where it meets the flank.
//!
//! While the gear rolls, the normal of the round at the generating point passes through the pitch point. The parameter
//! γ is the angle of that normal against the pitch line: π/2 at the root circle, α where the round meets the rack's
//! straight flank. Source: Litvin and Fuentes, Gear Geometry and Applied Theory, 2nd edition, chapter 6; a sharp rack
//! corner is a round of radius 0. Must not know: stiffness.

use std::f64::consts::{FRAC_PI_2, PI};

use super::involute::Section;
use super::{Gear, Specification};
use crate::numeric::crossing;

/// The generated root curve of a tooth's right half.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trochoid {
    /// r \[m\].
    reference_radius: f64,
    /// Depth of the tip round's centre below the pitch line \[m\]; negative above it.
    depth: f64,
    /// ρ_fP \[m\].
    round: f64,
    /// Distance of the round's centre from the centreline of the tooth, along the pitch line \[m\].
    offset: f64,
    /// γ at the joint with the involute.
    joint: f64,
}

/// Where the root curve meets the involute.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    pub radius: f64,
    pub roll: f64,
    /// γ.
    pub normal_angle: f64,
    pub undercut: bool,
}

/// Half the width of the rack's tip land \[modules\]: h_fP tan α and the round taken from π/4.
pub(super) fn half_tip_land(specification: &Specification) -> f64 {
    let (sine, cosine) = libm::sincos(specification.pressure_angle);
    let rack = &specification.rack;
    0.25 * PI - rack.dedendum * sine / cosine - rack.tip_radius * (1.0 - sine) / cosine
}

/// ρ_fP at which the tip land vanishes \[modules\].
pub(in crate::gear) fn full_round(specification: &Specification) -> f64 {
    let (sine, cosine) = libm::sincos(specification.pressure_angle);
    (0.25 * PI * cosine - specification.rack.dedendum * sine) / (1.0 - sine)
}

pub(super) fn least_shift_without_undercut(specification: &Specification) -> f64 {
    let sine = libm::sin(specification.pressure_angle);
    let rack = &specification.rack;
    rack.dedendum - rack.tip_radius * (1.0 - sine) - 0.5 * f64::from(specification.teeth) * sine * sine
}

impl Trochoid {
    /// The root curve of a gear whose rack and circles are known to be possible.
    pub(super) fn generate(specification: &Specification, base_radius: f64, half_base_angle: f64) -> (Self, Joint) {
        let module = specification.module;
        let rack = &specification.rack;
        let reference_radius = 0.5 * module * f64::from(specification.teeth);
        let mut curve = Self {
            reference_radius,
            depth: module * (rack.dedendum - specification.profile_shift - rack.tip_radius),
            round: module * rack.tip_radius,
            offset: module * (0.5 * PI - half_tip_land(specification).max(0.0)),
            joint: specification.pressure_angle,
        };
        let sine = libm::sin(specification.pressure_angle);
        // The end of the rack's straight flank on the path of contact, counted from the tangent point.
        let end = reference_radius * sine - (curve.depth + curve.round * sine) / sine;
        let joint = if end >= 0.0 {
            Joint {
                radius: (base_radius * base_radius + end * end).sqrt(),
                roll: end / base_radius,
                normal_angle: specification.pressure_angle,
                undercut: false,
            }
        } else {
            curve.crossing(base_radius, half_base_angle)
        };
        curve.joint = joint.normal_angle;
        (curve, joint)
    }

    /// The undercut joint: the rack's straight flank ends beyond the tangent point, and the root curve comes back
    /// through the involute it should have joined. It starts thicker than the involute by 2 inv α_y at γ = α, and is
    /// thinner at the base circle; its radius falls steadily between.
    fn crossing(&self, base_radius: f64, half_base_angle: f64) -> Joint {
        let at = |normal_angle: f64| {
            let (x, y) = self.point(normal_angle);
            (libm::hypot(x, y), libm::atan2(x, y))
        };
        let roll = |radius: f64| ((radius - base_radius) * (radius + base_radius)).max(0.0).sqrt() / base_radius;
        let start = self.joint;
        let base = crossing::bracketed(start, FRAC_PI_2, |angle| at(angle).0 - base_radius).unwrap_or(start);
        let excess = |angle: f64| {
            let (radius, half_angle) = at(angle);
            let roll = roll(radius);
            half_angle - half_base_angle + (roll - libm::atan(roll))
        };
        // No sign change only where both differ by rounding, at the very threshold of undercut.
        let normal_angle = crossing::bracketed(start, base, excess).unwrap_or(base);
        let radius = at(normal_angle).0.max(base_radius);
        Joint { radius, roll: roll(radius), normal_angle, undercut: true }
    }

    /// Half thickness x and height y \[m\] at γ.
    #[must_use]
    pub fn point(&self, normal_angle: f64) -> (f64, f64) {
        let (sine, cosine) = libm::sincos(normal_angle);
        let turn = (self.depth * cosine / sine + self.offset) / self.reference_radius;
        let distance = self.depth / sine + self.round;
        let (turn_sine, turn_cosine) = libm::sincos(turn);
        let (tilt_sine, tilt_cosine) = libm::sincos(normal_angle - turn);
        (
            self.reference_radius * turn_sine - distance * tilt_cosine,
            self.reference_radius * turn_cosine - distance * tilt_sine,
        )
    }

    /// The point at q = asinh(cot γ), in which the curve is smooth from end to end, with dy/dq.
    ///
    /// dy/dγ = −cos(γ − φ) R with the curve's rate R = ds/dγ = ρ + (e/sin γ + ρ) e/(r sin² γ) and the turn φ.
    #[must_use]
    pub fn section(&self, q: f64) -> Section {
        let [half_thickness, height] = self.point_at(q);
        let (tilt, rate, _) = self.rates(q);
        Section { half_thickness, height, height_rate: libm::cos(tilt) * rate / libm::cosh(q) }
    }

    /// The point at q.
    #[must_use]
    pub fn point_at(&self, q: f64) -> [f64; 2] {
        let (x, y) = self.point(FRAC_PI_2 - libm::atan(libm::sinh(q)));
        [x, y]
    }

    /// At q: the angle γ − φ of the curve's normal against x; R = ds/dγ \[m\]; and d(γ − φ)/dγ = 1 + e/(r sin² γ), which
    /// over R is the curvature. At the root circle their ratio is the known ρ + e²/(r + e).
    #[must_use]
    pub fn rates(&self, q: f64) -> (f64, f64, f64) {
        let stretch = libm::cosh(q);
        let turn = (self.depth * libm::sinh(q) + self.offset) / self.reference_radius;
        let distance = self.depth * stretch + self.round;
        let lean = self.depth * stretch / self.reference_radius * stretch;
        let rate = self.round + distance * self.depth * stretch * stretch / self.reference_radius;
        (FRAC_PI_2 - libm::atan(libm::sinh(q)) - turn, rate, 1.0 + lean)
    }

    /// γ at the joint with the involute; the curve runs from π/2 down to it.
    #[must_use]
    pub fn joint(&self) -> f64 {
        self.joint
    }

    /// q at the joint; the curve runs from 0 up to it.
    #[must_use]
    pub fn joint_parameter(&self) -> f64 {
        libm::asinh(1.0 / libm::tan(self.joint))
    }

    /// θ_f: half the tooth's angle where the curve touches the root circle.
    #[must_use]
    pub fn root_half_angle(&self) -> f64 {
        self.offset / self.reference_radius
    }
}

impl Gear {
    /// The root curve this gear's rack generates.
    #[must_use]
    pub fn trochoid(&self) -> Trochoid {
        Trochoid::generate(&self.specification, self.base_radius, self.half_base_angle).0
    }
}
