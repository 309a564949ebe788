//! The involute: its function, its inverse, and what a gear's flank has at a radius or a roll angle.
//!
//! The roll angle of a flank point is u = tan α_y, so the point is r_b u away from the tangent point of its normal.
//! Tooth frame: y along the tooth's centreline from the gear's centre, x across. Source: ISO 21771-1:2024, section 5.
//! Must not know: how the tooth ends at the root.

use super::Gear;

/// inv α = tan α − α.
#[must_use]
pub fn involute(angle: f64) -> f64 {
    libm::tan(angle) - angle
}

/// The angle whose involute function is `value` ≥ 0, below 1.5 rad; `start` is a guess, exact when it is the answer.
#[must_use]
pub fn inverse_involute(value: f64, start: f64) -> f64 {
    // The function is convex: after one step Newton's method comes down from above without overshooting.
    let mut angle = start;
    for _ in 0..100 {
        let tangent = libm::tan(angle);
        let next = (angle - (tangent - angle - value) / (tangent * tangent)).clamp(1e-9, 1.5);
        let done = (next - angle).abs() <= f64::EPSILON * angle;
        angle = next;
        if done {
            break;
        }
    }
    angle
}

/// A point of a tooth's right half and its rate: half thickness x, height y, dy per parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// x \[m\].
    pub half_thickness: f64,
    /// y \[m\].
    pub height: f64,
    /// dy/d(parameter).
    pub height_rate: f64,
}

impl Gear {
    /// u at a radius \[m\] ≥ r_b.
    #[must_use]
    pub fn roll_at(&self, radius: f64) -> f64 {
        // As a product: the difference of squares would lose the digits near the base circle.
        ((radius - self.base_radius) * (radius + self.base_radius)).max(0.0).sqrt() / self.base_radius
    }

    /// Radius \[m\] at a roll angle.
    #[must_use]
    pub fn radius_at(&self, roll: f64) -> f64 {
        self.base_radius * (1.0 + roll * roll).sqrt()
    }

    /// ψ_y, half the angle of the tooth at a roll angle: ψ_b − inv α_y.
    #[must_use]
    pub fn half_angle_at_roll(&self, roll: f64) -> f64 {
        self.half_base_angle - (roll - libm::atan(roll))
    }

    /// ψ_y at a radius \[m\] ≥ r_b.
    #[must_use]
    pub fn half_angle(&self, radius: f64) -> f64 {
        self.half_angle_at_roll(self.roll_at(radius))
    }

    /// s_a, the tooth's thickness along the tip circle \[m\].
    #[must_use]
    pub fn tip_thickness(&self) -> f64 {
        2.0 * self.tip_radius * self.half_angle(self.tip_radius)
    }

    /// Roll angle at the tip.
    #[must_use]
    pub fn tip_roll(&self) -> f64 {
        self.roll_at(self.tip_radius)
    }

    /// Roll angle at which the two flanks of a tooth would meet: inv α = ψ_b.
    #[must_use]
    pub fn apex_roll(&self) -> f64 {
        libm::tan(inverse_involute(self.half_base_angle, 1.0))
    }

    /// The angle between the load line at a flank point and the normal of the tooth's centreline: α_1 = u − ψ_b.
    #[must_use]
    pub fn load_angle(&self, roll: f64) -> f64 {
        roll - self.half_base_angle
    }

    /// From a flank point along its normal to the tooth's centreline, r_b(u − tan α_1) \[m\]: half of the tooth as its
    /// load line sees it. It falls from the root to the tip.
    #[must_use]
    pub fn depth_to_centreline(&self, roll: f64) -> f64 {
        self.flank(roll).half_thickness / libm::cos(self.load_angle(roll))
    }

    /// The flank point at a roll angle, with dy/du.
    #[must_use]
    pub fn flank(&self, roll: f64) -> Section {
        involute_at(self.base_radius, self.half_base_angle, roll)
    }
}

/// The point of an involute of a tooth's right half at a roll angle, with dy/du.
pub(super) fn involute_at(base_radius: f64, half_base_angle: f64, roll: f64) -> Section {
    let (sine, cosine) = libm::sincos(roll - half_base_angle);
    Section {
        half_thickness: base_radius * (roll * cosine - sine),
        height: base_radius * (cosine + roll * sine),
        height_rate: base_radius * roll * cosine,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inverse_undoes_the_function() {
        for degrees in [0.5_f64, 5.0, 14.5, 20.0, 32.0, 60.0, 80.0] {
            let angle = degrees.to_radians();
            for start in [0.1, 0.35, 1.0, 1.4] {
                // inv α ≈ α³/3 at small angles, so the inverse has a third of the digits to lose there.
                let tolerance = 1e-15 / (libm::tan(angle) * libm::tan(angle)) + 1e-14;
                assert!((inverse_involute(involute(angle), start) - angle).abs() < tolerance, "{degrees} from {start}");
            }
        }
        let angle = 20f64.to_radians();
        assert_eq!(inverse_involute(involute(angle), angle).to_bits(), angle.to_bits());
        // ISO 21771 and every handbook: inv 20° = 0.014904.
        assert!((involute(angle) - 0.014_904_38).abs() < 1e-8);
    }
}
