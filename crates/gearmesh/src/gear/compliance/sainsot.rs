//! The gear body under one tooth's load, fitted to the theory of an elastic ring.
//!
//! Source: Sainsot, Velex and Duverger, Contribution of gear body to tooth deflections: a new bidimensional analytical
//! formula, Journal of Mechanical Design 126 (2004) 748–752. Must not know: the tooth above the root circle.
//!
//! 1/k_f = cos²α_1/(E b)·[L q² + M q + P(1 + Q tan²α_1)], q = u_f/S_f, with u_f = r_b/cos α_1 − r_f from the root circle
//! to where the load line crosses the centreline, and S_f = 2 r_f θ_f. Some programs count u_f from elsewhere.

use crate::gear::geometry::Gear;

/// A … F of X = A/θ_f² + B h² + C h/θ_f + D/θ_f + E h + F, for X = L, M, P, Q.
const COEFFICIENTS: [[f64; 6]; 4] = [
    [-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045],
    [60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086],
    [-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236],
    [-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904],
];

/// The formula for one gear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// θ_f \[rad\].
    pub half_angle: f64,
    /// h = r_f/r_bore.
    pub bore_ratio: f64,
    /// L, M, P, Q.
    pub polynomials: [f64; 4],
    /// Height on the tooth's centreline that u_f is counted from \[m\], where that is not the root circle.
    pub foot: Option<f64>,
}

impl Body {
    /// The polynomials L, M, P and Q for θ_f \[rad\] and h = r_f/r_bore.
    #[must_use]
    pub fn new(half_angle: f64, bore_ratio: f64) -> Self {
        let (t, h) = (half_angle, bore_ratio);
        let terms = [1.0 / (t * t), h * h, h / t, 1.0 / t, h, 1.0];
        let polynomials = COEFFICIENTS.map(|row| row.iter().zip(terms).map(|(c, term)| c * term).sum());
        Self { half_angle, bore_ratio, polynomials, foot: None }
    }

    /// 1/k_f \[m/N\] for a load at a roll angle.
    #[must_use]
    pub fn compliance(&self, gear: &Gear, roll: f64) -> f64 {
        let (sine, cosine) = libm::sincos(gear.load_angle(roll));
        let [l, m, p, q] = self.polynomials;
        let foot = self.foot.unwrap_or(gear.root_radius);
        let arm = (gear.base_radius / cosine - foot) / (2.0 * gear.root_radius * self.half_angle);
        let bracket = cosine * cosine * ((l * arm + m) * arm + p) + p * q * sine * sine;
        bracket / (gear.specification.material.youngs_modulus * gear.specification.face_width)
    }

    /// A sentence where the formula is used outside the range it was fitted for.
    #[must_use]
    pub fn range_warning(&self) -> Option<String> {
        let inside = (0.01..=0.12).contains(&self.half_angle) && (1.4..=7.0).contains(&self.bore_ratio);
        (!inside).then(|| {
            format!(
                "the gear body formula is fitted for half root angles of 0.01 to 0.12 rad and root-to-bore ratios of 1.4 to 7; \
                 here they are {:.4} rad and {:.3}",
                self.half_angle, self.bore_ratio
            )
        })
    }
}
