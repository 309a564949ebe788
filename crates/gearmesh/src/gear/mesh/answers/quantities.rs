//! The quantities of the curve of one load case: name, unit, description, tolerance, prerequisite and value.
//!
//! One list for all readers: columns of tables, goals and constraints of searches, sweeps, keys in Python. Harmonics are not
//! in it, since their number is free. Must not know: tables, stages.

use super::curve::Summary;
use super::pressure::LargestPressure;
use super::root_stress::LargestRootStress;

/// What a quantity needs beside the largest and the smallest transmission error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// Nothing.
    Extremes,
    /// Integrals over the mesh cycle.
    Integrals,
    /// The extrema without load.
    Unloaded,
    /// The load of each pair at every position.
    LoadSharing,
    /// The pressure at every position.
    Pressure,
    /// The root stress at every position.
    RootStress,
}

/// A number that the curve of one load case amounts to.
#[derive(Debug)]
pub struct Quantity {
    /// The name of its column.
    pub name: &'static str,
    /// The unit of its column; empty for a plain number.
    pub unit: &'static str,
    /// One sentence.
    pub description: &'static str,
    /// Absolute \[unit of the column\] and relative tolerance of comparisons; `None` for that of all columns.
    pub tolerance: Option<[f64; 2]>,
    /// True if it is NaN for some curves.
    pub allows_nan: bool,
    /// Its prerequisite.
    pub need: Need,
    /// The value in SI; NaN where the curve has none.
    pub get: fn(&Summary) -> f64,
}

impl Quantity {
    const fn new(
        [name, unit, description]: [&'static str; 3],
        need: Need,
        get: fn(&Summary) -> f64,
        tolerance: Option<[f64; 2]>,
    ) -> Self {
        Self { name, unit, description, tolerance, allows_nan: false, need, get }
    }

    const fn or_nan(self) -> Self {
        Self { allows_nan: true, ..self }
    }
}

/// The quantity with this name.
#[must_use]
pub fn quantity(name: &str) -> Option<&'static Quantity> {
    QUANTITIES.iter().find(|quantity| quantity.name == name)
}

fn pressure(summary: &Summary, get: fn(&LargestPressure) -> f64) -> f64 {
    summary.largest_pressure.as_ref().map_or(f64::NAN, get)
}

/// Of the pinion, 0, or the gear, 1.
fn root<const GEAR: usize>(summary: &Summary, get: fn(&LargestRootStress) -> f64) -> f64 {
    summary.largest_root_stress.as_ref().map_or(f64::NAN, |of_gears| get(&of_gears[GEAR]))
}

const LENGTH: Option<[f64; 2]> = Some([1e-12, 1e-9]);
const PLACE: Option<[f64; 2]> = Some([1e-6, 1e-9]);

/// All of them, in the order of the columns.
pub static QUANTITIES: &[Quantity] = &[
    Quantity::new(
        ["mean", "um", "Integral mean of the transmission error over the mesh cycle."],
        Need::Integrals,
        |curve| curve.mean,
        None,
    ),
    Quantity::new(
        ["peak_to_peak", "um", "Largest less smallest transmission error."],
        Need::Extremes,
        |curve| curve.peak_to_peak,
        LENGTH,
    ),
    Quantity::new(["maximum", "um", "Largest transmission error."], Need::Extremes, |curve| curve.largest.value, None),
    Quantity::new(
        ["minimum", "um", "Smallest transmission error."],
        Need::Extremes,
        |curve| curve.smallest.value,
        None,
    ),
    Quantity::new(
        ["variance", "um^2", "Integral mean of the squared deviation from the mean."],
        Need::Integrals,
        |curve| curve.variance,
        Some([1e-15, 1e-9]),
    ),
    Quantity::new(
        ["reciprocal_variance", "1/um^2", "f = 1/variance (mei2016, equation 16); NaN where nothing varies."],
        Need::Integrals,
        |curve| curve.reciprocal_variance.unwrap_or(f64::NAN),
        Some([0.0, 1e-8]),
    )
    .or_nan(),
    Quantity::new(
        ["unloaded_peak_to_peak", "um", "The same without load."],
        Need::Unloaded,
        |curve| curve.unloaded_peak_to_peak,
        LENGTH,
    ),
    Quantity::new(
        ["loaded_contact_ratio", "", "Mean number of pairs that carry load."],
        Need::LoadSharing,
        |curve| curve.loaded_contact_ratio,
        None,
    ),
    Quantity::new(
        ["largest_load_share", "", "Largest share of the load on one pair."],
        Need::LoadSharing,
        |curve| curve.largest_load_share,
        None,
    ),
    Quantity::new(
        ["largest_pressure", "MPa", "Largest pressure in the mesh cycle."],
        Need::Pressure,
        |curve| pressure(curve, |largest| largest.extremum.value),
        None,
    ),
    Quantity::new(
        ["pressure_position", "mm", "Distance from where a pair starts contact, where that is."],
        Need::Pressure,
        |curve| pressure(curve, |largest| largest.extremum.position),
        PLACE,
    ),
    Quantity::new(
        ["pressure_roll_angle", "deg", "The pinion's roll angle at that place; NaN without load."],
        Need::Pressure,
        |curve| pressure(curve, |largest| largest.roll_angle),
        Some([1e-4, 1e-9]),
    )
    .or_nan(),
    Quantity::new(
        ["pressure_z", "mm", "Where across the face, from its middle; NaN where it is the same all across."],
        Need::Pressure,
        |curve| pressure(curve, |largest| largest.across.unwrap_or(f64::NAN)),
        PLACE,
    )
    .or_nan(),
    Quantity::new(
        ["pressure_half_width", "um", "Half the width of the contact there."],
        Need::Pressure,
        |curve| pressure(curve, |largest| largest.contact.half_width),
        Some([1e-3, 1e-6]),
    ),
    Quantity::new(
        [
            "largest_root_stress_pinion",
            "MPa",
            "Largest tensile stress at the roots of the pinion's teeth in the mesh cycle.",
        ],
        Need::RootStress,
        |curve| root::<0>(curve, |largest| largest.extremum.value),
        None,
    ),
    Quantity::new(
        [
            "root_stress_position_pinion",
            "mm",
            "Distance from where a pair starts contact, where the pinion's root stress is largest.",
        ],
        Need::RootStress,
        |curve| root::<0>(curve, |largest| largest.extremum.position),
        PLACE,
    ),
    Quantity::new(
        ["root_stress_radius_pinion", "mm", "Radius of the place on the pinion's root; NaN without load."],
        Need::RootStress,
        |curve| root::<0>(curve, |largest| largest.radius),
        PLACE,
    )
    .or_nan(),
    Quantity::new(
        ["root_stress_error_pinion", "%", "Estimated error of the pinion's root stresses by its mesh."],
        Need::RootStress,
        |curve| root::<0>(curve, |largest| largest.error_estimate),
        // The difference of two stresses.
        Some([1e-7, 1e-9]),
    ),
    Quantity::new(
        [
            "largest_root_stress_gear",
            "MPa",
            "Largest tensile stress at the roots of the gear's teeth in the mesh cycle.",
        ],
        Need::RootStress,
        |curve| root::<1>(curve, |largest| largest.extremum.value),
        None,
    ),
    Quantity::new(
        [
            "root_stress_position_gear",
            "mm",
            "Distance from where a pair starts contact, where the gear's root stress is largest.",
        ],
        Need::RootStress,
        |curve| root::<1>(curve, |largest| largest.extremum.position),
        PLACE,
    ),
    Quantity::new(
        ["root_stress_radius_gear", "mm", "Radius of the place on the gear's root; NaN without load."],
        Need::RootStress,
        |curve| root::<1>(curve, |largest| largest.radius),
        PLACE,
    )
    .or_nan(),
    Quantity::new(
        ["root_stress_error_gear", "%", "Estimated error of the gear's root stresses by its mesh."],
        Need::RootStress,
        |curve| root::<1>(curve, |largest| largest.error_estimate),
        // The difference of two stresses.
        Some([1e-7, 1e-9]),
    ),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_name_is_there_once_and_each_description_is_a_sentence() {
        for (index, one) in QUANTITIES.iter().enumerate() {
            assert!(QUANTITIES[..index].iter().all(|other| other.name != one.name), "{}", one.name);
            assert!(one.description.ends_with('.'), "{}", one.name);
            assert!(std::ptr::eq(quantity(one.name).unwrap(), one));
        }
    }
}
