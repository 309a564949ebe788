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
    /// The form radius \[m\].
    pub radius: f64,
    /// Roll angle of the involute there \[rad\].
    pub roll: f64,
    /// γ.
    pub normal_angle: f64,
    /// Whether the root curve crosses the involute instead of being tangent to it.
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

impl Gear {
    /// x_min: the least profile shift \[modules\] at which this rack does not undercut this number of teeth.
    #[must_use]
    pub fn least_shift_without_undercut(&self) -> f64 {
        least_shift_without_undercut(&self.specification)
    }
}

fn least_shift_without_undercut(specification: &Specification) -> f64 {
    let sine = libm::sin(specification.pressure_angle);
    let rack = &specification.rack;
    rack.dedendum - rack.tip_radius * (1.0 - sine) - 0.5 * f64::from(specification.teeth) * sine * sine
}

impl Trochoid {
    /// The root curve of a gear whose rack and circles have been checked.
    pub(super) fn generate(specification: &Specification, base_radius: f64) -> (Self, Joint) {
        let module = specification.module;
        let rack = &specification.rack;
        let reference_radius = 0.5 * module * f64::from(specification.teeth);
        let mut curve = Self {
            reference_radius,
            depth: module * (rack.dedendum - specification.generating_profile_shift() - rack.tip_radius),
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
            curve.crossing(base_radius, end)
        };
        curve.joint = joint.normal_angle;
        (curve, joint)
    }

    /// The undercut joint: the rack's straight flank ends beyond the tangent point, and the root curve comes back
    /// through the involute it should have joined. It starts thicker than the involute by 2 inv α_y at γ = α, and is
    /// thinner at the base circle; its radius falls steadily between.
    ///
    /// At the threshold of undercut all of this happens next to α and next to the base circle. So everything is a
    /// function of η = γ − α, and nothing is found as the difference of two large numbers: with t = r sin γ − D the
    /// distance from the curve's point to the foot of its normal, D = d/sin γ + ρ, the radius is √(r² cos² γ + t²) and
    /// the half angle (d cot γ + offset)/r − γ + atan(t/(r cos γ)); at η = 0 that is ψ_b − u + atan u with u = `end`/r_b.
    fn crossing(&self, base_radius: f64, end: f64) -> Joint {
        let start = self.joint;
        let (alpha_sine, alpha_cosine) = libm::sincos(start);
        let start_roll = end / base_radius;
        // sin η, t/r_b, r cos γ/r_b and u² = t² + cos² γ/cos² α − 1.
        let at = |eta: f64| {
            let (eta_sine, gamma) = (libm::sin(eta), start + eta);
            let (sine, cosine) = libm::sincos(gamma);
            let rise = 2.0 * libm::sin(0.5 * eta) * libm::cos(start + 0.5 * eta);
            let ahead = rise * (self.depth / (sine * alpha_sine) + self.reference_radius) / base_radius;
            let foot = start_roll + ahead;
            let square = foot * foot - eta_sine * libm::sin(gamma + start) / (alpha_cosine * alpha_cosine);
            (eta_sine / sine, foot, cosine / alpha_cosine, square)
        };
        let base = crossing::bracketed(0.0, FRAC_PI_2 - start, |eta| at(eta).3).unwrap_or(0.0);
        let excess = |eta: f64| {
            let (turn, foot, across, square) = at(eta);
            let (slope, roll) = (foot / across, square.max(0.0).sqrt());
            let angles = libm::atan2(slope - roll, 1.0 + slope * roll);
            roll - start_roll - eta - self.depth * turn / (self.reference_radius * alpha_sine) + angles
        };
        // No sign change only where both differ by rounding, at the very threshold of undercut.
        let eta = crossing::bracketed(0.0, base, excess).unwrap_or(base);
        let roll = at(eta).3.max(0.0).sqrt();
        Joint { radius: base_radius * (1.0 + roll * roll).sqrt(), roll, normal_angle: start + eta, undercut: true }
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
        Trochoid::generate(&self.specification, self.base_radius).0
    }
}
