//! The root curve that a rack with a rounded tip generates: the envelope of the tip round, and where it meets an involute.
//!
//! While the gear rolls, the normal of the round at the generating point passes through the pitch point. The parameter
//! γ is the angle of that normal against the pitch line: π/2 at the root circle, α where the round meets the rack's
//! straight flank. Source: Litvin and Fuentes, Gear Geometry and Applied Theory, 2nd edition, chapter 6; a sharp rack
//! corner is a round of radius 0. Must not know: stiffness.

use std::f64::consts::{FRAC_PI_2, PI};

use super::involute::{Section, involute};
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
    /// γ at its upper end.
    joint: f64,
}

/// Half the width of the rack's tip land \[modules\]: h_fP tan α and the round taken from π/4, and s_pr added.
pub(super) fn half_tip_land(specification: &Specification) -> f64 {
    let (sine, cosine) = libm::sincos(specification.pressure_angle);
    let rack = &specification.rack;
    0.25 * PI - rack.dedendum * sine / cosine - rack.tip_radius * (1.0 - sine) / cosine
        + rack.residual_undercut() / cosine
}

/// ρ_fP at which the tip land vanishes \[modules\].
pub(in crate::gear) fn full_round(specification: &Specification) -> f64 {
    let (sine, cosine) = libm::sincos(specification.pressure_angle);
    let rack = &specification.rack;
    (0.25 * PI * cosine - rack.dedendum * sine + rack.residual_undercut()) / (1.0 - sine)
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
    /// The root curve of a gear whose rack has been checked, up to where the round of the tip faces the rack's flank.
    pub(super) fn of(specification: &Specification) -> Self {
        let module = specification.module;
        let rack = &specification.rack;
        Self {
            reference_radius: 0.5 * module * f64::from(specification.teeth),
            depth: module * (rack.dedendum - specification.generating_profile_shift() - rack.tip_radius),
            round: module * rack.tip_radius,
            offset: module * (0.5 * PI - half_tip_land(specification).max(0.0)),
            joint: specification.pressure_angle,
        }
    }

    /// The same curve up to another γ.
    pub(super) fn up_to(self, joint: f64) -> Self {
        Self { joint, ..self }
    }

    /// How it lies against the involute of a straight flank that is tangent to the round.
    pub(super) fn against(&self, angle: f64) -> Against<'_> {
        let sine = libm::sin(angle);
        let end = self.reference_radius * sine - (self.depth + self.round * sine) / sine;
        Against { curve: self, angle, base_radius: self.reference_radius * libm::cos(angle), end }
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

    /// γ at its upper end; the curve runs from π/2 down to it.
    #[must_use]
    pub fn joint(&self) -> f64 {
        self.joint
    }

    /// q at its upper end; the curve runs from 0 up to it.
    #[must_use]
    pub fn joint_parameter(&self) -> f64 {
        libm::asinh(1.0 / libm::tan(self.joint))
    }

    /// ψ_b of the involute that a straight flank generates, which is tangent to the round.
    pub(super) fn half_base_angle_of(&self, angle: f64) -> f64 {
        let (sine, cosine) = libm::sincos(angle);
        // Half the tooth's thickness on the pitch line.
        let half = self.offset - (self.depth * sine + self.round) / cosine;
        half / self.reference_radius + involute(angle)
    }

    /// θ_f: half the tooth's angle where the curve touches the root circle.
    #[must_use]
    pub fn root_half_angle(&self) -> f64 {
        self.offset / self.reference_radius
    }
}

/// A root curve and the involute that a straight flank generates, which is tangent to the same round.
///
/// At the threshold of undercut both meet next to where the round begins and next to the base circle. So everything is a
/// function of η = γ − α, and nothing is found as the difference of two large numbers: with t = r sin γ − D the
/// distance from the curve's point to the foot of its normal, D = d/sin γ + ρ, the radius is √(r² cos² γ + t²) and
/// the half angle (d cot γ + offset)/r − γ + atan(t/(r cos γ)); at η = 0 that is ψ_b − u + atan u with u = `end`/r_b.
#[derive(Clone, Copy, Debug)]
pub(super) struct Against<'a> {
    curve: &'a Trochoid,
    /// α of the straight flank.
    angle: f64,
    /// r_b of its involute.
    pub base_radius: f64,
    /// Where the straight flank ends on the path of contact, counted from the tangent point \[m\]; below 0 it undercuts.
    pub end: f64,
}

impl Against<'_> {
    /// sin η/sin γ, t/r_b, r cos γ/r_b and u² = t² + cos² γ/cos² α − 1.
    fn at(&self, eta: f64) -> (f64, f64, f64, f64) {
        let start = self.angle;
        let (alpha_sine, alpha_cosine) = libm::sincos(start);
        let (eta_sine, gamma) = (libm::sin(eta), start + eta);
        let (sine, cosine) = libm::sincos(gamma);
        let rise = 2.0 * libm::sin(0.5 * eta) * libm::cos(start + 0.5 * eta);
        let ahead = rise * (self.curve.depth / (sine * alpha_sine) + self.curve.reference_radius) / self.base_radius;
        let foot = self.end / self.base_radius + ahead;
        let square = foot * foot - eta_sine * libm::sin(gamma + start) / (alpha_cosine * alpha_cosine);
        (eta_sine / sine, foot, cosine / alpha_cosine, square)
    }

    /// η where an undercutting curve comes down to the base circle.
    pub(super) fn base(&self) -> f64 {
        crossing::bracketed(0.0, FRAC_PI_2 - self.angle, |eta| self.at(eta).3).unwrap_or(0.0)
    }

    /// By how much the tooth's half angle on the curve is larger than that on the involute.
    pub(super) fn excess(&self, eta: f64) -> f64 {
        let (turn, foot, across, square) = self.at(eta);
        let (slope, roll) = (foot / across, square.max(0.0).sqrt());
        let angles = libm::atan2(slope - roll, 1.0 + slope * roll);
        roll - self.end / self.base_radius
            - eta
            - self.curve.depth * turn / (self.curve.reference_radius * libm::sin(self.angle))
            + angles
    }

    /// The roll angle of that involute at the radius of the curve's point.
    pub(super) fn roll(&self, eta: f64) -> f64 {
        self.at(eta).3.max(0.0).sqrt()
    }

    /// η where the curve meets the involute: 0 where it is tangent to it, and above 0 where the straight flank ends beyond the
    /// tangent point. There the curve comes back through the involute it should have joined: it starts thicker than that by
    /// 2 inv α_y at γ = α, and is thinner at the base circle; its radius falls steadily between.
    pub(super) fn joint(&self) -> f64 {
        if self.end >= 0.0 {
            return 0.0;
        }
        let base = self.base();
        // No sign change only where both differ by rounding, at the very threshold of undercut.
        crossing::bracketed(0.0, base, |eta| self.excess(eta)).unwrap_or(base)
    }
}
