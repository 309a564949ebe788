//! The same coefficient of friction everywhere.
//!
//! Must not know: other laws.

use super::{Law, Rolling};
use declare::Declared;

/// The same coefficient of friction everywhere.
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "constant")]
pub struct Constant {
    /// Coefficient of friction μ.
    #[declared(minimum = 0.0, maximum = 1.0, example = "0.05")]
    pub coefficient: f64,
}

impl Law for Constant {
    fn is_mean(&self) -> bool {
        true
    }

    fn coefficient(&self, _rolling: &Rolling) -> f64 {
        self.coefficient
    }
}
