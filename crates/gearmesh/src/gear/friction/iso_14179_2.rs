//! The mean coefficient of friction of ISO/TR 14179-2, by Schlenk.
//!
//! μ_mz = 0.048 ((F_bt/b)/(v_ΣC ρ_redC))^0.2 η_oil^−0.05 Ra^0.25 X_L, in N/mm, m/s, mm, mPa s and µm. Sources: ISO/TR
//! 14179-2:2001, Gears, Thermal capacity, part 2; Schlenk, Untersuchungen zur Fresstragfähigkeit von Zahnrädern, dissertation, TU
//! München 1994. Its range is that of DIN 3990-4:1987, which has the same form for the mean coefficient of friction. Must not
//! know: other laws.

use super::{Law, Limit, Rolling};
use declare::Declared;
use declare::units::{DYNAMIC_VISCOSITY, LENGTH};

/// Mean coefficient of friction of ISO/TR 14179-2 (Schlenk), for F_bt/b of 150 N/mm or more and circumferential speeds up to
/// 50 m/s.
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "iso_14179_2")]
pub struct Iso14179 {
    /// η_oil: dynamic viscosity at the temperature of the oil.
    #[declared(minimum = 1e-4, maximum = 1e3, dimension = DYNAMIC_VISCOSITY, example = "40 mPa s")]
    pub viscosity: f64,
    /// Ra: the mean of both flanks'.
    #[declared(minimum = 1e-9, maximum = 1e-4, dimension = LENGTH, example = "0.5 um")]
    pub roughness: f64,
    /// X_L: 1 for mineral oils, 0.8 for polyalphaolefins and esters.
    #[declared(minimum = 0.1, maximum = 10.0, default = "1.0")]
    pub lubricant_factor: f64,
}

/// The smallest F_bt/b \[N/mm\].
const LEAST_LOAD: f64 = 150.0;
/// The largest v_ΣC \[m/s\]: 2 v_t sin α_wt at 50 m/s and 20°.
const FASTEST: f64 = 34.2;

impl Law for Iso14179 {
    fn is_mean(&self) -> bool {
        true
    }

    fn coefficient(&self, rolling: &Rolling) -> f64 {
        let Rolling { line_load, radius, .. } = rolling;
        let load = line_load * 1e-3 / (rolling.sum() * radius * 1e3);
        let oil = libm::pow(self.viscosity * 1e3, -0.05) * self.lubricant_factor;
        0.048 * libm::pow(load, 0.2) * oil * libm::pow(self.roughness * 1e6, 0.25)
    }

    fn limits(&self, rolling: &Rolling) -> Vec<Limit> {
        let of = |quantity, unit, value, range| Limit { quantity, unit, value, range };
        vec![
            of("the load per width F_bt/b", "N/mm", rolling.line_load * 1e-3, [LEAST_LOAD, f64::INFINITY]),
            of("the sum speed v_ΣC", "m/s", rolling.sum(), [0.0, FASTEST]),
        ]
    }
}
