//! What is measured of a gear to know how thick its teeth are: spans, balls in spaces, chords.
//!
//! Lengths in m, angles in rad. Source: ISO 21771-1:2024, clauses on tooth
//! thickness, span measurement and dimensions over balls. Must not know: the mate.

use std::f64::consts::{FRAC_PI_2, PI};

use super::Gear;
use super::involute::inverse_involute;

/// A span over teeth, between two parallel planes that touch flanks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// k: teeth between the planes.
    pub teeth: u32,
    /// W_k.
    pub length: f64,
    /// Half of d_k: radius at which the planes touch.
    pub radius: f64,
    /// Whether they touch the involute, neither below the root form circle nor above the tip form circle.
    pub on_flank: bool,
}

/// Balls, or pins, in opposite spaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Balls {
    /// D_M.
    pub diameter: f64,
    /// Half of d_K: radius of the ball's centre.
    pub centre_radius: f64,
    /// Half of d_M: radius at which it touches the flanks.
    pub contact_radius: f64,
    /// M_rK: from the gear's centre over one ball.
    pub radial: f64,
    /// M_dK: over two balls in opposite spaces; with an odd number of teeth they are half a pitch from opposite.
    pub over_two: f64,
    /// Whether it touches the involute, stands out of the tip circle and does not reach the root circle.
    pub measurable: bool,
}

/// A chord between the flanks of a tooth, as a gear tooth calliper measures it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chord {
    /// Its length.
    pub length: f64,
    /// From the tip circle down to it, along the centreline.
    pub height: f64,
}

/// By what a dimension over two balls is smaller than over opposite ones.
pub(super) fn odd(teeth: u32) -> f64 {
    if teeth.is_multiple_of(2) { 1.0 } else { libm::cos(FRAC_PI_2 / f64::from(teeth)) }
}

impl Gear {
    /// s_y: arc thickness of the tooth at a radius ≥ r_b.
    #[must_use]
    pub fn thickness_at(&self, radius: f64) -> f64 {
        2.0 * radius * self.half_angle(radius)
    }

    fn is_on_flank(&self, roll: f64) -> bool {
        (self.form_roll..=self.flank_end.roll).contains(&roll)
    }

    /// r_v: the V-circle m(z/2 + x_E), within the flank: where the middle of the flank is measured.
    fn middle_radius(&self) -> f64 {
        let (module, profile_shift) = (self.specification.module, self.specification.generating_profile_shift());
        let [form, end] = [self.form_roll, self.flank_end.roll].map(|roll| self.radius_at(roll));
        (self.reference_radius + module * profile_shift).clamp(form, end)
    }

    /// The usual number of teeth to span: that whose planes touch nearest the V-circle.
    #[must_use]
    pub fn usual_span_teeth(&self) -> u32 {
        let z = f64::from(self.specification.teeth);
        // W/2 = r_b tan α_v there, and W_k grows by a base pitch with each tooth.
        let roll = self.roll_at(self.middle_radius());
        let teeth = (2.0 * (roll - self.half_base_angle) * z / (2.0 * PI) + 1.0).round();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // between 1 and z
        let teeth = teeth.clamp(1.0, z) as u32;
        teeth
    }

    /// The span over `teeth`.
    #[must_use]
    pub fn span(&self, teeth: u32) -> Span {
        let pitch = 2.0 * PI / f64::from(self.specification.teeth);
        let length = self.base_radius * (f64::from(teeth.saturating_sub(1)) * pitch + 2.0 * self.half_base_angle);
        let roll = 0.5 * length / self.base_radius;
        Span { teeth, length, radius: self.radius_at(roll), on_flank: teeth > 0 && self.is_on_flank(roll) }
    }

    /// η_b: half the angle of the space at the base circle; negative where the teeth meet above it.
    fn half_space_angle(&self) -> f64 {
        PI / f64::from(self.specification.teeth) - self.half_base_angle
    }

    /// The diameter of the ball that touches at the V-circle.
    #[must_use]
    pub fn usual_ball_diameter(&self) -> f64 {
        let roll = self.roll_at(self.middle_radius());
        // The centre is on the normal of the contact and on the centreline of the space: α_K = tan α_v + η_b.
        2.0 * self.base_radius * (libm::tan(roll + self.half_space_angle()) - roll)
    }

    /// Balls of a diameter in the spaces; none where they find no place between the flanks.
    #[must_use]
    pub fn balls(&self, diameter: f64) -> Option<Balls> {
        let half_turn = 0.5 * diameter / self.base_radius;
        let value = half_turn - self.half_space_angle();
        if !(diameter > 0.0 && value > 0.0) {
            return None;
        }
        let angle = inverse_involute(value, 0.5);
        let roll = libm::tan(angle) - half_turn;
        if roll < 0.0 {
            return None;
        }
        let centre_radius = self.base_radius / libm::cos(angle);
        let radial = centre_radius + 0.5 * diameter;
        let stands_out = radial > self.tip_radius && centre_radius - 0.5 * diameter > self.root_radius;
        Some(Balls {
            diameter,
            centre_radius,
            contact_radius: self.radius_at(roll),
            radial,
            over_two: 2.0 * centre_radius * odd(self.specification.teeth) + diameter,
            measurable: self.is_on_flank(roll) && stands_out,
        })
    }

    /// s̄ and h̄_a: the chord on the circle of a radius ≥ r_b.
    #[must_use]
    pub fn chord(&self, radius: f64) -> Chord {
        let (sine, cosine) = libm::sincos(self.half_angle(radius));
        Chord { length: 2.0 * radius * sine, height: self.tip_radius - radius * cosine }
    }

    /// s̄_c and h̄_c: the constant chord, between the points where the basic rack touches both flanks of a tooth.
    #[must_use]
    pub fn constant_chord(&self) -> Chord {
        let angle = self.specification.pressure_angle;
        let (sine, cosine) = libm::sincos(angle);
        let length = self.thickness_at(self.reference_radius) * cosine * cosine;
        Chord { length, height: self.tip_radius - self.reference_radius - 0.5 * length * sine / cosine }
    }
}

#[cfg(test)]
mod tests;
