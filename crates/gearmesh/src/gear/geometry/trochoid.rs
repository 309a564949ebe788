//! The root curve that a tool with a rounded tip generates: the envelope of the tip round, and where it meets an involute.
//!
//! While the gear rolls, the normal of the round at the generating point passes through the pitch point. γ is the angle of that normal
//! against the pitch line: π/2 at the root circle, α where the round meets the rack's straight flank. The parameter is q: the round's
//! centre, e below the pitch point at q = 0, has then moved along the pitch circle of the tool by L = e sinh q/(1 + k e), k the curvature
//! of that circle. For a rack k = 0, L = e sinh q, and q = asinh(cot γ). Seen from the pitch point the centre of a cutter's round is
//! at e (s sinc β, cos β − k e s² sinc²(β/2)/(2(1 + k e)²)) with s = sinh q and β = k L, which is smooth in e and in k. Source: Litvin and Fuentes, Gear Geometry and Applied Theory, 2nd edition, chapter 6; a sharp rack
//! corner is a round of radius 0. Must not know: stiffness.

use std::f64::consts::{FRAC_PI_2, PI};

use super::involute::{Section, involute};
use super::pinion_cutter::{PinionCutter, Shaping};
use super::{Gear, Specification};
use crate::numeric::crossing;

/// The generated root curve of a tooth's right half.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trochoid {
    /// r \[m\]; on which the gear rolls in generation.
    reference_radius: f64,
    /// 1/r_w0 of a cutter that rolls on it \[1/m\]; 0 for a rack.
    bend: f64,
    /// Depth of the tip round's centre below the pitch line \[m\]; negative above it.
    depth: f64,
    /// ρ_fP \[m\].
    round: f64,
    /// Distance of the round's centre from the centreline of the tooth, along the pitch line \[m\].
    offset: f64,
    /// γ at its upper end.
    joint: f64,
    /// q there.
    upper: f64,
}

/// Half the width of the rack's tip land \[modules\]: h_fP tan α and the round taken from π/4, and s_pr added.
pub(super) fn half_tip_land(specification: &Specification) -> f64 {
    let (sine, cosine) = libm::sincos(specification.pressure_angle);
    let rack = &specification.rack;
    0.25 * PI - rack.dedendum * sine / cosine - rack.tip_radius * (1.0 - sine) / cosine
        + rack.residual_undercut() / cosine
}

/// ρ_fP at which the tip land of the tool vanishes \[modules\].
pub(in crate::gear) fn full_round(specification: &Specification) -> f64 {
    if let Some(cutter) = &specification.cutter {
        return cutter.full_round(specification);
    }
    let (sine, cosine) = libm::sincos(specification.pressure_angle);
    let rack = &specification.rack;
    (0.25 * PI * cosine - rack.dedendum * sine + rack.residual_undercut()) / (1.0 - sine)
}

/// The round of the tool at a place of its way.
struct Place {
    /// γ.
    normal_angle: f64,
    /// sin γ.
    sine: f64,
    /// From the pitch point to the generated point \[m\].
    distance: f64,
    /// By how much the gear has turned from where the tooth's centreline points to the pitch point.
    turn: f64,
    /// Both by −dq/cosh q, which is dγ for a rack.
    normal_rate: f64,
    turn_rate: f64,
}

impl Gear {
    /// x_min: the least profile shift \[modules\] at which this tool does not undercut this number of teeth.
    #[must_use]
    pub fn least_shift_without_undercut(&self) -> f64 {
        least_shift_without_undercut(&self.specification)
    }
}

fn least_shift_without_undercut(specification: &Specification) -> f64 {
    if let Some(cutter) = &specification.cutter {
        return cutter.least_shift(specification);
    }
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
            bend: 0.0,
            depth: module * (rack.dedendum - specification.generating_profile_shift() - rack.tip_radius),
            round: module * rack.tip_radius,
            offset: module * (0.5 * PI - half_tip_land(specification).max(0.0)),
            joint: 0.0,
            upper: 0.0,
        }
        .up_to(specification.pressure_angle)
    }

    /// The root curve that a cutter shapes, up to where the round of its tip faces its flank.
    pub(super) fn shaped(shaping: &Shaping, teeth: u32, cutter: &PinionCutter) -> Self {
        let (sine, cosine) = libm::sincos(shaping.working_pressure_angle);
        let pitch_radius = shaping.base_radius / cosine;
        let reference_radius = shaping.centre_distance - pitch_radius;
        // From the tangent point on the cutter's base circle: the angles to the round's centre and to the pitch point.
        let to_centre = libm::atan(shaping.along / shaping.base_radius);
        let half = 0.5 * (to_centre - shaping.working_pressure_angle);
        let mean = 0.5 * (to_centre + shaping.working_pressure_angle);
        // β/e r_M, in which nothing cancels where the centre is on the pitch circle.
        let upper = libm::asinh(cosine / (libm::sin(mean) * sinc(half)));
        Self {
            reference_radius,
            bend: 1.0 / pitch_radius,
            depth: shaping.round_radius - pitch_radius,
            round: shaping.round,
            offset: reference_radius * shaping.turn(teeth, cutter),
            joint: libm::atan2(sine, cosine),
            upper,
        }
    }

    /// The same curve of a rack's round up to another γ.
    pub(super) fn up_to(self, joint: f64) -> Self {
        Self { joint, upper: libm::asinh(1.0 / libm::tan(joint)), ..self }
    }

    /// The same curve up to another q.
    pub(super) fn up_to_parameter(self, upper: f64) -> Self {
        Self { joint: self.place(upper).normal_angle, upper, ..self }
    }

    fn place(&self, q: f64) -> Place {
        let (sinh, cosh) = (libm::sinh(q), libm::cosh(q));
        let Self { reference_radius, bend, depth, round, offset, .. } = *self;
        let shrink = 1.0 / (1.0 + bend * depth);
        let path = depth * sinh * shrink;
        let beta = bend * path;
        let (beta_sine, beta_cosine) = libm::sincos(beta);
        let half = sinc(0.5 * beta) * shrink * sinh;
        let (across, down) = (sinh * sinc(beta), beta_cosine - 0.5 * bend * depth * half * half);
        let stretch = libm::hypot(across, down);
        Place {
            normal_angle: libm::atan2(down, across),
            sine: down / stretch,
            distance: depth * stretch + round,
            turn: (path + offset) / reference_radius,
            normal_rate: (across * beta_sine + down * beta_cosine) * (cosh / stretch) * (cosh / stretch),
            turn_rate: -depth * cosh * cosh * shrink / reference_radius,
        }
    }

    /// How it lies against the involute of a straight flank that is tangent to the round.
    pub(super) fn against(&self, angle: f64) -> Against<'_> {
        let sine = libm::sin(angle);
        let end = self.reference_radius * sine - (self.depth + self.round * sine) / sine;
        Against { curve: self, angle, base_radius: self.reference_radius * libm::cos(angle), end }
    }

    /// Half thickness x and height y \[m\] at γ of a rack's curve.
    #[must_use]
    pub fn point(&self, normal_angle: f64) -> (f64, f64) {
        let (sine, cosine) = libm::sincos(normal_angle);
        let turn = (self.depth * cosine / sine + self.offset) / self.reference_radius;
        self.point_of(normal_angle, turn, self.depth / sine + self.round)
    }

    fn point_of(&self, normal_angle: f64, turn: f64, distance: f64) -> (f64, f64) {
        let (turn_sine, turn_cosine) = libm::sincos(turn);
        let (tilt_sine, tilt_cosine) = libm::sincos(normal_angle - turn);
        (
            self.reference_radius * turn_sine - distance * tilt_cosine,
            self.reference_radius * turn_cosine - distance * tilt_sine,
        )
    }

    /// The point at q, in which the curve is smooth from end to end, with dy/dq.
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
        let (x, y) = if self.bend > 0.0 {
            let Place { normal_angle, turn, distance, .. } = self.place(q);
            self.point_of(normal_angle, turn, distance)
        } else {
            self.point(FRAC_PI_2 - libm::atan(libm::sinh(q)))
        };
        [x, y]
    }

    /// At q: the angle γ − φ of the curve's normal against x; R = ds/dγ \[m\]; and d(γ − φ)/dγ = 1 + e/(r sin² γ), which
    /// over R is the curvature. At the root circle their ratio is the known ρ + e²/(r + e). For a cutter both rates are by
    /// −dq/cosh q, with R = D dγ − (D − r sin γ) dφ, D from the pitch point to the generated point.
    #[must_use]
    pub fn rates(&self, q: f64) -> (f64, f64, f64) {
        if self.bend > 0.0 {
            let Place { normal_angle, sine, distance, turn, normal_rate, turn_rate } = self.place(q);
            let rate = distance * normal_rate - (distance - self.reference_radius * sine) * turn_rate;
            return (normal_angle - turn, rate, normal_rate - turn_rate);
        }
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
        self.upper
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

/// sin x/x.
fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-8 { 1.0 } else { libm::sin(x) / x }
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
