//! Influences of loads on the roots of both gears, quick to add up.
//!
//! Must not know: where influences come from, loads of a position.

use crate::gear::compliance::RootInfluences;
use crate::numeric::chebyshev::Series;

/// Influences on the roots of both gears, quick to add up.
#[derive(Clone, Debug)]
pub(in crate::gear::mesh) struct Roots(pub(in crate::gear::mesh) [Root; 2]);

/// Influences on the root of one gear.
#[derive(Clone, Debug)]
pub(in crate::gear::mesh) struct Root {
    pub(in crate::gear::mesh) radii: Vec<f64>,
    pub(in crate::gear::mesh) lengths: Vec<f64>,
    /// Of roll angles.
    range: [f64; 2],
    /// By the loaded tooth: coefficients of all places, order by order.
    coefficients: Vec<Vec<f64>>,
    /// By the loaded tooth: what a load along the flank at its tip does, place by place, if that is known.
    along: Vec<Vec<f64>>,
    pub(in crate::gear::mesh) error_estimate: f64,
}

impl Roots {
    pub(in crate::gear::mesh) fn new(influences: &[RootInfluences; 2]) -> Self {
        Self([Root::new(&influences[0]), Root::new(&influences[1])])
    }
}

impl Root {
    fn new(influences: &RootInfluences) -> Self {
        let RootInfluences { radii, lengths, stresses, along, error_estimate } = influences;
        let of_tooth = |places: &Vec<Series>| {
            let orders = places.iter().map(|series| series.coefficients().len()).max().unwrap_or(0);
            let of = |order: usize| places.iter().map(move |series| series.coefficients().get(order).copied());
            (0..orders).flat_map(of).map(|coefficient| coefficient.unwrap_or(0.0)).collect()
        };
        let range = stresses.iter().flatten().next().map_or([-1.0, 1.0], |series| [series.lower(), series.upper()]);
        let coefficients = stresses.iter().map(of_tooth).collect();
        let (radii, lengths, along) = (radii.clone(), lengths.clone(), along.clone());
        Self { radii, lengths, range, coefficients, along, error_estimate: *error_estimate }
    }

    /// Adds to the stress at every place what a load per width at a roll angle does, on a tooth so many pitches further; at the
    /// corner of a tip it is turned by an angle from the flank's normal.
    pub(in crate::gear::mesh) fn add(
        &self,
        stresses: &mut [f64],
        further: isize,
        [roll, inclination]: [f64; 2],
        load: f64,
    ) {
        let tooth = (self.coefficients.len() / 2).checked_add_signed(further);
        let Some((tooth, coefficients)) = tooth.and_then(|tooth| Some((tooth, self.coefficients.get(tooth)?))) else {
            return;
        };
        let mut load = load;
        if let Some(along) = self.along.get(tooth).filter(|along| inclination != 0.0 && !along.is_empty()) {
            let (sine, cosine) = libm::sincos(inclination);
            for (stress, along) in stresses.iter_mut().zip(along) {
                *stress += load * sine * along;
            }
            load *= cosine;
        }
        let [lower, upper] = self.range;
        let t = (2.0 * roll - lower - upper) / (upper - lower);
        // load T_n(t), and the one before it.
        let (mut weight, mut before) = (load, load * t);
        for row in coefficients.chunks(self.radii.len()) {
            for (stress, coefficient) in stresses.iter_mut().zip(row) {
                *stress += weight * coefficient;
            }
            (weight, before) = (2.0 * t * weight - before, weight);
        }
    }
}
