//! The local coefficient of friction of Benedict and Kelley, of smooth discs.
//!
//! μ = 0.0127 lg(29.66e3 w/(η v_g v_Σ²)), in N/mm, mPa s and m/s; in the units of the source 3.17e8 in the place of 29.66e3, with
//! lb/in, cP and in/s. The factor of the source for roughness is left out: open sources disagree about its constant. The formula
//! grows without bound towards the pitch point, where nothing slides, and is 0 where its logarithm is. Source: Benedict and
//! Kelley, Instantaneous coefficients of gear tooth friction, ASLE Transactions 4 (1961) 59–70. Must not know: other laws.

use super::{Law, Limit, Rolling};
use declare::Declared;
use declare::units::DYNAMIC_VISCOSITY;

/// Local coefficient of friction of Benedict and Kelley (1961), of smooth flanks: less where flanks slide faster.
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "benedict_kelley")]
pub struct BenedictKelley {
    /// η: dynamic viscosity of the oil that enters the contact.
    #[declared(minimum = 1e-4, maximum = 1e3, dimension = DYNAMIC_VISCOSITY, example = "40 mPa s")]
    pub viscosity: f64,
}

impl BenedictKelley {
    /// Of which the logarithm is taken; in SI the constant is 0.02966 s/m.
    fn argument(&self, rolling: &Rolling) -> f64 {
        let sum = rolling.sum();
        0.029_66 * rolling.line_load / (self.viscosity * rolling.sliding().abs() * sum * sum)
    }
}

impl Law for BenedictKelley {
    fn coefficient(&self, rolling: &Rolling) -> f64 {
        (0.0127 * libm::log10(self.argument(rolling))).max(0.0)
    }

    fn limits(&self, rolling: &Rolling) -> Vec<Limit> {
        let value = self.argument(rolling);
        vec![Limit { quantity: "29.66e3 w/(η v_g v_Σ²)", unit: "", value, range: [1.0, f64::INFINITY] }]
    }
}
