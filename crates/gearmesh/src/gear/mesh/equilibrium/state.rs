//! Equilibrium at one position of the mesh cycle.
//!
//! Must not know: how it is found.

use crate::numeric::complementarity::{Balance, PerSpring};

/// The penetration of a pair that is out of reach \[m\]: far from any contact.
pub(in crate::gear::mesh) const OUT_OF_REACH: f64 = -1.0;

/// Equilibrium at one position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equilibrium {
    /// The approach without load: the smallest gap and what the whole face has lost \[m\].
    pub unloaded: f64,
    /// Loads of the pairs \[N\], and their approach beyond the smallest gap \[m\].
    pub balance: Balance,
    /// The largest load per width of each pair \[N/m\], where slices hold each other.
    pub(in crate::gear::mesh) peaks: Option<PerSpring>,
}

impl Equilibrium {
    /// Of nothing: fills what is computed later.
    pub(in crate::gear::mesh) const NONE: Self = Self { unloaded: 0.0, balance: Balance::EMPTY, peaks: None };

    /// How many pairs carry load.
    #[must_use]
    pub fn loaded_pairs(&self) -> usize {
        // Signs add up as they are; comparisons would be gathered bit by bit and counted, in three times as many instructions.
        let signs = self.balance.loads.map(|load| usize::from((0.0 - load).is_sign_negative()));
        signs.iter().sum()
    }

    /// δ \[m\].
    #[must_use]
    pub fn transmission_error(&self) -> f64 {
        self.unloaded + self.balance.approach
    }
}
