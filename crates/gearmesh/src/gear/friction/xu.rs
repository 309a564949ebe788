//! The local coefficient of friction of Xu, Kahraman, Anderson and Maddock: a regression of elastohydrodynamic contacts.
//!
//! μ = exp(f) P_h^b2 SR^b3 V_e^b6 ν0^b7 R^b8 with f = b1 + b4 SR P_h lg ν0 + b5 exp(−SR P_h lg ν0) + b9 exp S, in GPa, m/s, mPa s, m
//! and µm; of one gear oil in thermal, non-Newtonian contacts. Sources: Xu, Kahraman, Anderson and Maddock, Prediction
//! of mechanical efficiency of parallel-axis gear pairs, Journal of Mechanical Design 129 (2007) 58–68; Xu, Development of a
//! generalized mechanical efficiency prediction methodology for gear pairs, dissertation, Ohio State University 2005. Must not
//! know: other laws.

use super::{Law, Limit, Rolling};
use declare::Declared;
use declare::units::{DYNAMIC_VISCOSITY, LENGTH};

/// Local coefficient of friction of Xu and others (2007), a regression of elastohydrodynamic contacts: none where nothing
/// slides, up to a slide-to-roll ratio of 1.
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "xu")]
pub struct Xu {
    /// ν0: dynamic viscosity of the oil that enters the contact, at ambient pressure.
    #[declared(minimum = 1e-3, maximum = 10.0, dimension = DYNAMIC_VISCOSITY, example = "10 mPa s")]
    pub viscosity: f64,
    /// S: root mean square roughness of both flanks together.
    #[declared(minimum = 0.0, maximum = 2e-6, dimension = LENGTH, example = "0.3 um")]
    pub roughness: f64,
}

/// b1 to b9.
const B: [f64; 9] =
    [-8.916_465, 1.033_03, 1.036_077, -0.354_068, 2.812_084, -0.100_601, 0.752_755, -0.390_958, 0.620_305];

impl Law for Xu {
    fn coefficient(&self, rolling: &Rolling) -> f64 {
        let [pressure, slide, entraining] = [rolling.pressure * 1e-9, rolling.slide_to_roll(), 0.5 * rolling.sum()];
        let viscosity = self.viscosity * 1e3;
        let sheared = slide * pressure * libm::log10(viscosity);
        let f = B[0] + B[3] * sheared + B[4] * libm::exp(-sheared) + B[8] * libm::exp(self.roughness * 1e6);
        let powers = [(pressure, B[1]), (slide, B[2]), (entraining, B[5]), (viscosity, B[6]), (rolling.radius, B[7])];
        powers.iter().fold(libm::exp(f), |product, (base, exponent)| product * libm::pow(*base, *exponent))
    }

    fn limits(&self, rolling: &Rolling) -> Vec<Limit> {
        let value = rolling.slide_to_roll();
        vec![Limit { quantity: "the slide-to-roll ratio", unit: "", value, range: [0.0, 1.0] }]
    }
}
