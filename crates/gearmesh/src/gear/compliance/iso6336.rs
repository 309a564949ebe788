//! ISO 6336-1:2019, clause 9 (method B): stiffness of a pair of teeth and of the mesh, per face width.
//!
//! c′ = c′_th C_M C_R C_B cos β · E/E_St is the largest stiffness of one pair, c_γα = c′(0.75 ε_α + 0.25) the mean of the
//! mesh. The standard says nothing about the curve between. As a method the pair's stiffness is the parabola over the path of
//! contact that has both: k = c′[1 − 3(1 − m) ξ²], ξ from −1 at A to 1 at E, m = c_γα/(c′ ε_α); its largest value is c′, and
//! its mean over the path times ε_α is c_γα. (Cai and Hayashi, Journal of Mechanical Design 116 (1994) 558–564, take a
//! parabola that falls to 0.55 of its top whatever ε_α is; it has only one of the two numbers.) The flattening of the
//! flanks is in c′. For standard basic rack teeth, x1 ≥ x2, −0.5 ≤ x1 + x2 ≤ 2, F_t/b ≥ 100 N/mm, ε_α of 1.2 and more.
//! Must not know: the tooth's shape beyond teeth numbers and shifts. Results in SI, N/(m·m) = Pa: 1 N/(mm µm) = 1e9 Pa.

use super::{
    Assumptions, ComplianceError, Foreseen, Method, PairCompliance, ROUNDING, Tabulated, ToothCompliance, integrated,
};
use crate::gear::geometry::{Gear, GearPair, Side};
use crate::gear::material::Plane;
use crate::gear::work::COMPLIANCE_EVALUATIONS;
use crate::numeric::chebyshev::Series;
use declare::Declared;
use declare::work::Work;

/// ISO 6336-1: a parabola over the path of contact with c′ as its top and c_γα as the mean of the mesh.
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "iso6336")]
pub struct Iso6336 {
    /// C_M: measured over theoretical stiffness
    #[declared(minimum = 0.1, maximum = 2.0, default = "0.8")]
    pub correction_factor: f64,
    /// C_R: gear blank factor, 1 for solid discs, less for rims on webs
    #[declared(minimum = 0.1, maximum = 2.0, default = "1.0")]
    pub blank_factor: f64,
}

/// E_St, what the standard measured its factors on \[Pa\].
const STEEL_MODULUS: f64 = 206e9;
/// N/(mm µm) in Pa.
const PER_MILLIMETRE_AND_MICROMETRE: f64 = 1e9;
/// F_t/b \[N/m\] above which c′ does not depend on the load.
const LEAST_SPECIFIC_LOAD: f64 = 100e3;
/// ε_α for which the mean is given.
const CONTACT_RATIOS: std::ops::RangeInclusive<f64> = 1.2..=2.5;
/// x1 + x2.
const SHIFT_SUMS: std::ops::RangeInclusive<f64> = -0.5..=2.0;

/// What clause 9 needs to know of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inputs {
    /// z1, z2 (virtual numbers of teeth z_n for helical gears).
    pub teeth: [f64; 2],
    /// x1, x2.
    pub profile_shift: [f64; 2],
    /// h_fP \[modules\], of each gear's basic rack.
    pub dedendum: [f64; 2],
    /// α_P \[rad\].
    pub pressure_angle: f64,
    /// β \[rad\], on the reference cylinder.
    pub helix_angle: f64,
    /// ε_α.
    pub contact_ratio: f64,
    /// E of both gears \[Pa\].
    pub youngs_modulus: [f64; 2],
    /// C_M: 0.8 where nothing is known.
    pub correction_factor: f64,
    /// C_R: 1 for solid discs.
    pub blank_factor: f64,
}

impl Inputs {
    /// The facts of a spur pair, with the factors of the method.
    #[must_use]
    pub fn of(pair: &GearPair, method: &Iso6336) -> Self {
        let mut both = [&pair.pinion, &pair.gear];
        // The standard's first gear is the smaller one, whichever drives.
        let later = |gear: &Gear| (gear.specification.teeth, -gear.specification.profile_shift);
        if later(both[0]) > later(both[1]) {
            both.swap(0, 1);
        }
        Self {
            teeth: both.map(|gear| f64::from(gear.specification.teeth)),
            profile_shift: both.map(|gear| gear.specification.profile_shift),
            dedendum: both.map(Gear::dedendum),
            pressure_angle: both[0].specification.pressure_angle,
            helix_angle: 0.0,
            contact_ratio: pair.contact_ratio,
            youngs_modulus: both.map(|gear| gear.specification.material.youngs_modulus),
            correction_factor: method.correction_factor,
            blank_factor: method.blank_factor,
        }
    }
}

/// The stiffnesses of clause 9 \[Pa\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness {
    /// c′_th, theoretical single stiffness of steel gears.
    pub theoretical: f64,
    /// c′, single stiffness: the largest of one pair of teeth.
    pub single: f64,
    /// c_γα, mean over the mesh.
    pub mesh: f64,
}

/// Clause 9.3.
#[must_use]
pub fn stiffness(inputs: &Inputs) -> Stiffness {
    let [z1, z2] = inputs.teeth;
    let [x1, x2] = inputs.profile_shift;
    let flexibility = 0.047_23 + 0.155_51 / z1 + 0.257_91 / z2
        - 0.006_35 * x1
        - 0.116_54 * x1 / z1
        - 0.001_93 * x2
        - 0.241_88 * x2 / z2
        + 0.005_29 * x1 * x1
        + 0.001_82 * x2 * x2;
    let theoretical = PER_MILLIMETRE_AND_MICROMETRE / flexibility;
    let steepness = 1.0 - 0.02 * (20.0 - inputs.pressure_angle.to_degrees());
    let rack = |dedendum: f64| (1.0 + 0.5 * (1.2 - dedendum)) * steepness;
    let rack = 0.5 * (rack(inputs.dedendum[0]) + rack(inputs.dedendum[1]));
    let [one, two] = inputs.youngs_modulus;
    let material = 2.0 / (STEEL_MODULUS / one + STEEL_MODULUS / two);
    let factors = inputs.correction_factor * inputs.blank_factor * rack * material;
    let single = theoretical * factors * libm::cos(inputs.helix_angle);
    Stiffness { theoretical, single, mesh: single * (0.75 * inputs.contact_ratio + 0.25) }
}

impl Method for Iso6336 {
    fn whole_pair(&self) -> bool {
        true
    }

    fn foresee(&self, assumptions: Assumptions) -> Foreseen {
        Foreseen { neighbours: 0, ..integrated(assumptions) }
    }

    fn tabulate(&self, pair: &GearPair, assumptions: Assumptions) -> Result<Tabulated, ComplianceError> {
        let inputs = Inputs::of(pair, self);
        let Stiffness { single, mesh, .. } = stiffness(&inputs);
        if !(single > 0.0 && single.is_finite()) {
            return Err(ComplianceError::NoIsoStiffness { single });
        }
        let top = single * pair.contact_width();
        let fall = 3.0 * (1.0 - mesh / (single * pair.contact_ratio));
        let (start, end) = (pair.start_of_contact, pair.end_of_contact);
        let mut evaluations = 0;
        let mut tooth = |side: Side| {
            let rolls = [pair.roll(side, start), pair.roll(side, end)];
            let (lower, upper) = (rolls[0].min(rolls[1]), rolls[0].max(rolls[1]));
            let half = |roll: f64| {
                evaluations += 1;
                let along = (2.0 * pair.path_position(side, roll) - start - end) / (end - start);
                [0.5 / (top * (1.0 - fall * along * along))]
            };
            let unresolved = ComplianceError::Unresolved { side, thickness: pair.side(side).tip_thickness() };
            let [whole] = Series::converged(lower, upper, half).ok_or(unresolved)?;
            let nothing = || Series::from_values(lower, upper, &[0.0]);
            Ok::<_, ComplianceError>(ToothCompliance {
                bending: whole,
                shear: nothing(),
                axial: nothing(),
                body: nothing(),
                contact_depth: nothing(),
                corner: 0.0,
                inclined: None,
                neighbours: Vec::new(),
            })
        };
        let compliance = PairCompliance {
            pinion: tooth(Side::Pinion)?,
            gear: tooth(Side::Gear)?,
            contact: None,
            plane: Plane::Strain,
            coupled: false,
        };
        let warnings = warnings(&inputs, pair, assumptions.torque);
        let work = Work::of(&COMPLIANCE_EVALUATIONS, evaluations);
        Ok(Tabulated { compliance, warnings, error_estimate: ROUNDING, meshes: Vec::new(), work })
    }
}

/// A sentence for each range of the standard that the pair is outside of.
fn warnings(inputs: &Inputs, pair: &GearPair, torque: Option<f64>) -> Vec<String> {
    let mut warnings = Vec::new();
    let [x1, x2] = inputs.profile_shift;
    if x1 < x2 {
        warnings.push(format!("ISO 6336-1 gives c′ for x1 ≥ x2; here x1 is {x1} and x2 is {x2}"));
    }
    if !SHIFT_SUMS.contains(&(x1 + x2)) {
        warnings.push(format!("ISO 6336-1 gives c′ for x1 + x2 of −0.5 to 2; here it is {}", x1 + x2));
    }
    if !CONTACT_RATIOS.contains(&inputs.contact_ratio) {
        warnings.push(format!(
            "ISO 6336-1 gives c_γα for contact ratios of 1.2 to 2.5 (below, it may be 10 % less); here it is {:.3}",
            inputs.contact_ratio
        ));
    }
    let specific_load = torque.map(|torque| torque / pair.pinion.reference_radius / pair.contact_width());
    if let Some(load) = specific_load.filter(|load| *load < LEAST_SPECIFIC_LOAD) {
        warnings.push(format!(
            "ISO 6336-1 gives c′ for a specific load F_t/b of 100 N/mm and more; here it is {:.4} N/mm, and c′ is less",
            load * 1e-3
        ));
    }
    warnings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gear::compliance::ContactLaw;
    use crate::gear::geometry::root::RootShape;
    use crate::gear::geometry::{Rack, Specification};
    use crate::gear::material::Material;
    use crate::gear::mesh::answers::stiffness::stiffness as mesh_stiffness;
    use crate::gear::mesh::{Mesh, Settings};

    const STEEL: Material = Material::STEEL;

    /// Tier: published value, ISO/TR 6336-30:2017, example 1.
    #[test]
    fn example_1_of_iso_tr_6336_30() {
        let helix = 15.8_f64.to_radians();
        // Virtual numbers of teeth, ISO 21771: z_n = z/(cos² β_b cos β).
        let base = libm::asin(libm::sin(helix) * 20f64.to_radians().cos());
        let virtual_teeth = |z: f64| z / (base.cos().powi(2) * helix.cos());
        let transverse = libm::atan(20f64.to_radians().tan() / helix.cos());
        let contact_ratio = contact_ratio(transverse);
        let found = stiffness(&Inputs {
            teeth: [virtual_teeth(17.0), virtual_teeth(103.0)],
            profile_shift: [0.145, 0.0],
            dedendum: [1.4; 2],
            pressure_angle: 20f64.to_radians(),
            helix_angle: helix,
            contact_ratio,
            youngs_modulus: [206e9; 2],
            correction_factor: 0.8,
            blank_factor: 1.0,
        });
        for (value, printed) in [(found.theoretical, 17.855_84), (found.single, 12.370_47), (found.mesh, 17.464_85)] {
            assert!((value * 1e-9 - printed).abs() < 6e-6, "{} for {printed}", value * 1e-9);
        }
    }

    fn pair(teeth: [u32; 2], shift: [f64; 2], addendum: f64) -> GearPair {
        let rack = Rack { addendum, dedendum: addendum + 0.25, tip_radius: 0.2, ..Rack::ISO_53_A };
        let gear = |index: usize| Specification {
            teeth: teeth[index],
            module: 3e-3,
            pressure_angle: 20f64.to_radians(),
            profile_shift: shift[index],
            thickness_allowance: 0.0,
            cutter: None,
            rack,
            tip_radius: None,
            face_width: [20e-3, 18e-3][index],
            bore_radius: 5e-3,
            material: STEEL,
        };
        GearPair::new(gear(0), gear(1), None).unwrap()
    }

    fn tables(pair: &GearPair, torque: Option<f64>) -> Tabulated {
        let assumptions = Assumptions {
            root: RootShape::BaseCircle,
            contact: ContactLaw::Linear,
            coupled: true,
            torque,
            accuracy: None,
        };
        Iso6336::default().tabulate(pair, assumptions).unwrap()
    }

    /// Tier: the standard's own two numbers, through the whole mesh cycle: the largest stiffness of a single pair is c′ b, the
    /// mean of the mesh c_γα b, whatever the load; with one to three pairs in contact.
    #[test]
    fn the_mesh_has_both_numbers_of_the_standard() {
        for (teeth, addendum) in [([19, 48], 1.0), ([30, 40], 1.0), ([48, 19], 1.0), ([50, 60], 0.8), ([50, 60], 1.35)]
        {
            let pair = pair(teeth, [0.0; 2], addendum);
            let expected = stiffness(&Inputs::of(&pair, &Iso6336::default()));
            let Tabulated { compliance, warnings, .. } = tables(&pair, None);
            assert!(warnings.is_empty() && compliance.contact.is_none(), "{warnings:?}");
            let cycle = Mesh::new(&pair, &compliance, Settings::default()).unwrap();
            for torque in [1e-6, 50.0, 1e6] {
                let (_, summary) = mesh_stiffness(&cycle, torque);
                let near = |value: f64, exact: f64| (value / (exact * 18e-3) - 1.0).abs() < 1e-9;
                assert!(near(summary.mean, expected.mesh), "{} for {expected:?}", summary.mean);
                let single = summary.fewest_pairs.pairs == 1;
                assert!(!single || near(summary.fewest_pairs.maximum, expected.single), "{summary:?} for {expected:?}");
            }
            // The ends of the path, by the formula as printed in the head of the file.
            let share = expected.mesh / (expected.single * pair.contact_ratio);
            let end = expected.single * (1.0 - 3.0 * (1.0 - share)) * 18e-3;
            for s in [pair.start_of_contact, pair.end_of_contact] {
                let [one, two] = [(&compliance.pinion, Side::Pinion), (&compliance.gear, Side::Gear)]
                    .map(|(tooth, side)| tooth.total(pair.roll(side, s)));
                assert!(((one + two) * end - 1.0).abs() < 1e-12 && (one / two - 1.0).abs() < 1e-12, "{one} {two}");
            }
        }
    }

    /// Tier: invariant; the smaller gear is the standard's first, whichever drives.
    #[test]
    fn swapping_the_gears_changes_nothing() {
        let of = |teeth, shift| stiffness(&Inputs::of(&pair(teeth, shift, 1.0), &Iso6336::default()));
        assert_eq!(of([19, 48], [0.3, -0.1]), of([48, 19], [-0.1, 0.3]));
        assert_eq!(of([30, 30], [0.2, 0.0]), of([30, 30], [0.0, 0.2]));
        assert_ne!(of([19, 48], [0.3, -0.1]), of([19, 48], [-0.1, 0.3]));
    }

    /// Tier: invariant; of two gears with as many teeth the one with more profile shift is the first, whichever drives.
    #[test]
    fn of_equal_gears_the_one_with_more_shift_comes_first() {
        for shift in [[0.1, 0.4], [0.4, 0.1]] {
            let inputs = Inputs::of(&pair([30, 30], shift, 1.0), &Iso6336::default());
            assert_eq!(inputs.profile_shift.map(f64::to_bits), [0.4_f64, 0.1].map(f64::to_bits));
        }
    }

    #[test]
    fn what_the_standard_does_not_cover_is_told_with_both_numbers() {
        let told = |teeth, shift, addendum, torque, words: &[&str]| {
            let warnings = tables(&pair(teeth, shift, addendum), torque).warnings;
            assert_eq!(warnings.len(), 1, "{warnings:?}");
            assert!(words.iter().all(|word| warnings[0].contains(word)), "{warnings:?}");
        };
        told([19, 48], [0.0, 0.4], 1.0, None, &["x1 ≥ x2", "x1 is 0", "x2 is 0.4"]);
        told([60, 61], [-0.3, -0.3], 1.0, None, &["−0.5 to 2", "-0.6"]);
        told([50, 60], [0.0, 0.0], 0.6, None, &["1.2 to 2.5", "1.1"]);
        // 50 N m on 28.5 mm and 18 mm: 97.5 N/mm.
        told([19, 48], [0.0, 0.0], 1.0, Some(50.0), &["100 N/mm", "97.4"]);
        assert!(tables(&pair([19, 48], [0.0; 2], 1.0), Some(51.4)).warnings.is_empty());
    }

    /// Tier: published; the ranges of ISO 6336-1:2019, clause 9, as printed, looked at a thousandth inside and outside.
    #[test]
    fn the_ranges_are_the_standard_s() {
        let pair = pair([19, 48], [0.0; 2], 1.0);
        let steel = Inputs::of(&pair, &Iso6336::default());
        let told = |inputs: &Inputs, torque| !warnings(inputs, &pair, torque).is_empty();
        for (limit, outwards) in [(-0.5, 1.001), (2.0, 1.001)] {
            let of = |sum: f64| Inputs { profile_shift: [sum + 0.6, -0.6], ..steel };
            assert!(told(&of(limit * outwards), None) && !told(&of(limit / outwards), None), "x1 + x2 {limit}");
        }
        for (limit, outwards) in [(1.2, 0.999), (2.5, 1.001)] {
            let of = |contact_ratio| Inputs { contact_ratio, ..steel };
            assert!(told(&of(limit * outwards), None) && !told(&of(limit / outwards), None), "ε_α {limit}");
        }
        // 100 N/mm on the reference radius of 28.5 mm and 18 mm.
        let torque = 100e3 * 28.5e-3 * 18e-3;
        assert!(told(&steel, Some(0.999 * torque)) && !told(&steel, Some(1.001 * torque)));
    }

    /// Tier: published; ISO 6336-1:2019, clause 9.3, C1 to C9 as printed, each from differences that leave it alone.
    #[test]
    fn every_constant_of_the_flexibility_is_the_standard_s() {
        let steel = Inputs::of(&pair([19, 48], [0.0; 2], 1.0), &Iso6336::default());
        let q = |teeth, profile_shift| {
            PER_MILLIMETRE_AND_MICROMETRE / stiffness(&Inputs { teeth, profile_shift, ..steel }).theoretical
        };
        let rack = f64::INFINITY;
        let c1 = q([rack, rack], [0.0, 0.0]);
        let odd = |teeth, [x1, x2]: [f64; 2]| 0.5 * (q(teeth, [x1, x2]) - q(teeth, [-x1, -x2]));
        let even = |[x1, x2]: [f64; 2]| 0.5 * (q([rack, rack], [x1, x2]) + q([rack, rack], [-x1, -x2])) - c1;
        let (c4, c6) = (odd([rack, rack], [1.0, 0.0]), odd([rack, rack], [0.0, 1.0]));
        let found = [
            c1,
            q([1.0, rack], [0.0, 0.0]) - c1,
            q([rack, 1.0], [0.0, 0.0]) - c1,
            c4,
            odd([1.0, rack], [1.0, 0.0]) - c4,
            c6,
            odd([rack, 1.0], [0.0, 1.0]) - c6,
            even([1.0, 0.0]),
            even([0.0, 1.0]),
        ];
        let printed = [0.04723, 0.15551, 0.25791, -0.00635, -0.11654, -0.00193, -0.24188, 0.00529, 0.00182];
        for (number, (found, printed)) in found.into_iter().zip(printed).enumerate() {
            assert!((found - printed).abs() < 1e-14, "C{}: {found} for {printed}", number + 1);
        }
        // C_B of the basic rack: 1 for h_fP 1.2 and 20°, 2 % less for each degree below, half of what h_fP is below 1.2 more.
        let single = |dedendum, degrees: f64| {
            let inputs = Inputs { dedendum, pressure_angle: degrees.to_radians(), ..steel };
            stiffness(&inputs).single
        };
        let base = single([1.2; 2], 20.0);
        let shares = [([1.2; 2], 19.0, 0.98), ([1.0; 2], 20.0, 1.1), ([1.0, 1.2], 20.0, 1.05)];
        for (dedendum, degrees, share) in shares {
            assert!((single(dedendum, degrees) / base - share).abs() < 1e-13, "{dedendum:?}, {degrees}°");
        }
        let found = stiffness(&Inputs { contact_ratio: 1.8, ..steel });
        assert!((found.mesh / found.single - 1.6).abs() < 1e-14);
    }

    /// Tier: the standard's factor for other materials, ξ = E/E_St with E = 2E1E2/(E1 + E2), and its two other factors.
    #[test]
    fn factors_multiply() {
        let steel = Inputs::of(&pair([19, 48], [0.0; 2], 1.0), &Iso6336::default());
        let base = stiffness(&steel);
        let other = stiffness(&Inputs { youngs_modulus: [206e9, 103e9], ..steel });
        assert!((other.single / base.single - 2.0 / 3.0).abs() < 1e-15);
        assert!((other.theoretical / base.theoretical - 1.0).abs() < 1e-15);
        let other = stiffness(&Inputs { correction_factor: 0.9, blank_factor: 0.7, ..steel });
        assert!((other.mesh / base.mesh - 0.9 * 0.7 / 0.8).abs() < 1e-15);
    }

    /// m_n 8, z 17/103, a 500, tip diameters 159.66 and 872.35 of the same example.
    fn contact_ratio(transverse: f64) -> f64 {
        let module = 8.0 / 15.8_f64.to_radians().cos();
        let reference = [17.0, 103.0].map(|z| 0.5 * z * module);
        let tangent = [159.66, 872.35]
            .into_iter()
            .zip(reference)
            .map(|(tip, r): (f64, f64)| ((0.5 * tip).powi(2) - (r * transverse.cos()).powi(2)).sqrt());
        let sum = (reference[0] + reference[1]) * transverse.cos();
        let working = (500f64.powi(2) - sum * sum).sqrt();
        (tangent.sum::<f64>() - working) / (std::f64::consts::PI * module * transverse.cos())
    }
}
