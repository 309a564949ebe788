//! What loads do at the corner of a tip that are not normal to the flank, where contact is resolved.
//!
//! Must not know: how it is found, where a pair touches.

use super::ToothCompliance;
use crate::numeric::chebyshev::Series;

/// Loads at the corner of the tip that are turned from the flank's normal towards the root. Of two numbers the first is the
/// displacement along the flank under a load normal to it, and the reverse; the second that of a load along the flank less
/// that of one normal to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Inclined {
    /// What the tooth yields, without the part of B \[m/N\].
    pub own: [f64; 2],
    /// B's own \[1/Pa\].
    pub corner: [f64; 2],
    /// Deflection at a tooth per load along the flank at the tip of the one k + 1 pitches further, against the roll angle of
    /// the first.
    pub neighbours: Vec<Series>,
}

impl Inclined {
    /// What turning the load by an angle adds to a compliance.
    #[must_use]
    #[inline]
    pub fn added([cross, along]: [f64; 2], inclination: f64) -> f64 {
        if inclination == 0.0 {
            return 0.0;
        }
        let (sine, cosine) = libm::sincos(inclination);
        sine * (2.0 * cosine * cross + sine * along)
    }

    /// Half of what it adds per angle.
    #[must_use]
    #[inline]
    pub fn rate([cross, along]: [f64; 2], inclination: f64) -> f64 {
        if inclination == 0.0 {
            return cross;
        }
        let (sine, cosine) = libm::sincos(2.0 * inclination);
        cosine * cross + 0.5 * sine * along
    }
}

impl ToothCompliance {
    /// What the tooth yields more under a load at the corner of its tip that is turned by so much \[m/N\].
    #[must_use]
    pub fn added(&self, inclination: f64) -> f64 {
        match &self.inclined {
            Some(inclined) if inclination != 0.0 => Inclined::added(inclined.own, inclination),
            _ => 0.0,
        }
    }

    /// Deflection at a tooth per load on the one k + 1 pitches further, which is turned by so much at the corner of its tip.
    #[must_use]
    pub fn neighbour(&self, index: usize, [first, further]: [f64; 2], inclination: f64) -> f64 {
        let normal = self.neighbours.get(index).map_or(0.0, |surface| surface.value(first, further));
        match self.inclined.as_ref().and_then(|inclined| inclined.neighbours.get(index)) {
            Some(along) if inclination != 0.0 => {
                let (sine, cosine) = libm::sincos(inclination);
                cosine * normal + sine * along.value(first)
            }
            _ => normal,
        }
    }
}
