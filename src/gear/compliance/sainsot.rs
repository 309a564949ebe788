//! Deflection of a tooth through its gear body: Sainsot, Velex and Duverger, J. Mech. Des. 126 (2004) 748–752.
//!
//! Compliances in m/N. Must not know: the shape of the tooth above its root.

use crate::gear::geometry::Gear;
use crate::gear::geometry::root::Root;

/// A, B, C, D, E, F of L*, M*, P*, Q* (Table 1 of the paper).
const COEFFICIENTS: [[f64; 6]; 4] = [
    [-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045],
    [60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086],
    [-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236],
    [-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904],
];

/// Ranges the coefficients were fitted in: h = r_f/r_bore and θ_f \[rad\].
pub const RADIUS_RATIO_RANGE: (f64, f64) = (1.4, 7.0);
pub const HALF_ANGLE_RANGE: (f64, f64) = (0.01, 0.12);

/// The body of one gear under one of its teeth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// h = r_f/r_bore.
    pub radius_ratio: f64,
    /// θ_f \[rad\].
    pub half_angle: f64,
    /// L*, M*, P*, Q*.
    pub factors: [f64; 4],
    base_radius: f64,
    root_radius: f64,
    half_base_angle: f64,
    /// 1/(E b) \[m/N\].
    per_modulus: f64,
}

impl Body {
    #[must_use]
    pub fn new(gear: &Gear, root: &Root) -> Self {
        let (h, theta) = (gear.root_radius / gear.specification.bore_radius, root.half_angle);
        let factors = COEFFICIENTS
            .map(|[a, b, c, d, e, f]| a / (theta * theta) + b * h * h + c * h / theta + d / theta + e * h + f);
        Self {
            radius_ratio: h,
            half_angle: theta,
            factors,
            base_radius: gear.base_radius,
            root_radius: gear.root_radius,
            half_base_angle: gear.half_base_angle,
            per_modulus: 1.0 / (gear.specification.material.youngs_modulus * gear.specification.face_width),
        }
    }

    /// Deflection along the load line per load at roll angle u \[m/N\].
    #[must_use]
    pub fn compliance(&self, roll: f64) -> f64 {
        let angle = roll - self.half_base_angle;
        let (cos, tan) = (libm::cos(angle), libm::tan(angle));
        let [l, m, p, q] = self.factors;
        let height = (self.base_radius / cos - self.root_radius) / (2.0 * self.root_radius * self.half_angle);
        cos * cos * self.per_modulus * (l * height * height + m * height + p * (1.0 + q * tan * tan))
    }

    /// What is to be said when the formula is used outside the range it was fitted in.
    #[must_use]
    pub fn warning(&self, gear: &str) -> Option<String> {
        let outside = |value: f64, (least, most): (f64, f64)| !(least..=most).contains(&value);
        let (h, theta) = (self.radius_ratio, self.half_angle);
        (outside(h, RADIUS_RATIO_RANGE) || outside(theta, HALF_ANGLE_RANGE)).then(|| {
            format!(
                "the body formula of Sainsot et al. was fitted for h = r_f/r_bore from {} to {} and θ_f from {} to {} rad; \
                 the {gear} has h = {h:.3} and θ_f = {theta:.4} rad",
                RADIUS_RATIO_RANGE.0, RADIUS_RATIO_RANGE.1, HALF_ANGLE_RANGE.0, HALF_ANGLE_RANGE.1
            )
        })
    }
}
