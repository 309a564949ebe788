//! The involute of a circle, by its roll angle. Angles in rad. Must not know: which circle it is.

/// inv α = tan α − α.
#[must_use]
pub fn inv(angle: f64) -> f64 {
    libm::tan(angle) - angle
}

/// Roll angle u of the point at `radius`: u² = (r/r_b)² − 1; 0 at and below the base circle.
#[must_use]
pub fn inverse_roll(radius: f64, base_radius: f64) -> f64 {
    // Factored, so that it stays exact near the base circle.
    ((radius - base_radius) * (radius + base_radius)).max(0.0).sqrt() / base_radius
}

/// Angle of the flank's point at roll angle u from the tooth's centreline: ψ = ψ_b − (u − arctan u).
#[must_use]
pub fn point_angle(roll: f64, half_base_angle: f64) -> f64 {
    half_base_angle - (roll - libm::atan(roll))
}
