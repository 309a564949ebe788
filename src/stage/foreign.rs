//! What users of other programs, standards and textbooks call the fields of this one.
//!
//! Symbols and words of ISO 21771 and ISO 6336, of the American standards, and of the programs whose printouts users have.
//! Must not know: which stage a field belongs to.

use std::f64::consts::TAU;

use declare::number::significant;
use declare::units::{ANGULAR_SPEED, Dimension, LENGTH, POWER, Quantity, TORQUE, in_unit, parse_quantity};
use studygraph::program::{Around, Foreign};

const fn word(word: &'static str, field: &'static str) -> Foreign {
    Foreign { word, field: Some(field), remark: "", is_other: false, remedy: None }
}

const fn remarked(word: &'static str, field: &'static str, remark: &'static str) -> Foreign {
    Foreign { word, field: Some(field), remark, is_other: false, remedy: None }
}

const fn half(word: &'static str, field: &'static str) -> Foreign {
    Foreign { remedy: Some(half_of), ..remarked(word, field, "a radius, half of the diameter") }
}

const fn none(word: &'static str, remark: &'static str) -> Foreign {
    Foreign { word, field: None, remark, is_other: false, remedy: None }
}

/// Another quantity than the field's, which the remark says how to find.
const fn other(word: &'static str, field: &'static str, remark: &'static str) -> Foreign {
    Foreign { is_other: true, ..remarked(word, field, remark) }
}

const fn power(word: &'static str) -> Foreign {
    Foreign { remedy: Some(of_power), ..other(word, "torque", "the torque on the pinion is T = P/(2 pi n)") }
}

const fn gear_torque(word: &'static str) -> Foreign {
    Foreign { remedy: Some(of_gear_torque), ..other(word, "torque", GEAR_TORQUE) }
}

const fn pitch(word: &'static str) -> Foreign {
    let remark = "25.4 mm over the diametral pitch";
    Foreign { remedy: Some(of_diametral_pitch), ..other(word, "module", remark) }
}

const fn backlash(word: &'static str) -> Foreign {
    other(word, "tooth_thickness", BACKLASH)
}

const fn clearance(word: &'static str) -> Foreign {
    other(word, "dedendum", CLEARANCE)
}

const fn hardness(word: &'static str) -> Foreign {
    other(word, "hardness", "Brinell, a plain number; convert other scales by the tables of ISO 18265")
}

const SPUR: &str = "spur gears only: there is no helix, and every section is the transverse section";
const STATIC: &str = "the pair is computed at rest: there is no speed, no mass and no damping";
const SPEED: &str = "the pair is loaded by its `torque` alone; friction and `kind: rating` take a `speed`";
const EXTERNAL: &str = "pairs of external gears only: neither internal gears nor planets are modelled";
const GEAR_TORQUE: &str = "that on the pinion, T_pinion = T_gear z1/z2";
const PINION: &str = "that on the pinion";
const DRIVER: &str = "that on the pinion, whichever gear drives; of a torque on the gear T_pinion = T_gear z1/z2";
const BACKLASH: &str = "backlash follows from the thickness of the teeth of each gear and from the centre distance: give \
                        allowances, as in `tooth_thickness: { allowance: { upper: -60 um, lower: -90 um } }`, and \
                        `centre_distance`";
const CLEARANCE: &str = "the clearance is m(h_fP* - h_aP*) where the centre distance is nominal: with an addendum of 1 a clearance \
                         of 0.25 m is a dedendum of 1.25";
const RATIO: &str = "the gear ratio follows from the numbers of teeth; give `teeth` of pinion and gear";
const REFERENCE: &str = "reference and base circles follow from the module, the teeth and the pressure angle: d = m z, \
                         d_b = d cos(alpha)";
const ROOT: &str =
    "the root circle follows from the tool: d_f = m(z + 2 x - 2 h_fP*), with `dedendum` of `rack` as h_fP*";

/// The number of a quantity, if it has this dimension.
fn si(quantity: Option<Quantity>, dimension: Dimension) -> Option<f64> {
    quantity.filter(|read| read.dimension == dimension).map(|read| read.value)
}

/// A number that reads back, with as many digits as a user would write.
fn shown(si: f64, unit: &str) -> String {
    let value = in_unit(si, unit);
    format!("{} {unit}", format!("{value:.6e}").parse().unwrap_or(value))
}

fn half_of(around: &Around) -> Option<String> {
    Some(format!("write `{}`", shown(0.5 * si(around.value, LENGTH)?, "mm")))
}

/// T = P/ω, of a speed beside it.
fn of_power(around: &Around) -> Option<String> {
    let power = si(around.value, POWER)?;
    let speed =
        ["speed", "n", "rpm", "n1", "rotational_speed", "input_speed", "pinion_speed"].iter().find_map(|name| {
            let read = (around.beside)(name)?;
            match read.dimension {
                ANGULAR_SPEED => Some(read.value),
                // A speed without a unit is in turns per minute where its name says so.
                _ if !read.has_unit && *name == "rpm" => Some(read.value * TAU / 60.0),
                _ => None,
            }
        })?;
    let torque = (speed > 0.0).then(|| power / speed)?;
    let (power, speed) = (significant(in_unit(power, "kW"), 6), significant(in_unit(speed, "rpm"), 6));
    Some(format!("{power} kW at {speed} rpm of the pinion: write `torque: {}`", shown(torque, "N m")))
}

fn of_gear_torque(around: &Around) -> Option<String> {
    let torque = si(around.value, TORQUE)?;
    let teeth = |gear: &str| Some((around.anywhere)(&[gear, "teeth"])?.value).filter(|teeth| *teeth > 0.0);
    let (pinion, gear) = (teeth("pinion")?, teeth("gear")?);
    Some(format!("with {pinion} and {gear} teeth write `torque: {}`", shown(torque * pinion / gear, "N m")))
}

/// Of a plain number, or one per inch.
fn of_diametral_pitch(around: &Around) -> Option<String> {
    let read = around.value.filter(|read| read.value > 0.0)?;
    let inch = parse_quantity("25.4 mm").ok()?.value;
    let module = if read.has_unit { None } else { Some(inch / read.value) };
    Some(format!("write `module: {}`", shown(module?, "mm")))
}

/// Words of others. One with several fields has the likeliest first.
pub static FOREIGN: &[Foreign] = &[
    word("z", "teeth"),
    word("number_of_teeth", "teeth"),
    word("tooth_count", "teeth"),
    word("teeth_number", "teeth"),
    word("tooth_number", "teeth"),
    word("no_of_teeth", "teeth"),
    word("num_teeth", "teeth"),
    word("n_teeth", "teeth"),
    word("m", "module"),
    word("m_n", "module"),
    word("mn", "module"),
    word("normal_module", "module"),
    word("transverse_module", "module"),
    word("m_t", "module"),
    pitch("diametral_pitch"),
    pitch("normal_diametral_pitch"),
    pitch("dp"),
    pitch("p_d"),
    word("alpha", "pressure_angle"),
    word("alpha_n", "pressure_angle"),
    word("normal_pressure_angle", "pressure_angle"),
    other("working_pressure_angle", "centre_distance", "cos(alpha_w) = m (z1 + z2) cos(alpha) / (2 a)"),
    other("alpha_w", "centre_distance", "cos(alpha_w) = m (z1 + z2) cos(alpha) / (2 a)"),
    word("x", "profile_shift"),
    word("shift", "profile_shift"),
    word("shift_coefficient", "profile_shift"),
    word("addendum_modification", "profile_shift"),
    word("addendum_modification_coefficient", "profile_shift"),
    word("profile_shift_coefficient", "profile_shift"),
    word("profile_shift_factor", "profile_shift"),
    word("b", "face_width"),
    word("width", "face_width"),
    word("tooth_width", "face_width"),
    word("breadth", "face_width"),
    word("a", "centre_distance"),
    word("a_w", "centre_distance"),
    word("center_distance", "centre_distance"),
    word("centre_dist", "centre_distance"),
    word("center_dist", "centre_distance"),
    word("axis_distance", "centre_distance"),
    word("working_centre_distance", "centre_distance"),
    word("working_center_distance", "centre_distance"),
    half("bore_diameter", "bore_radius"),
    half("bore", "bore_radius"),
    half("inner_diameter", "bore_radius"),
    half("shaft_diameter", "bore_radius"),
    half("tip_diameter", "tip_radius"),
    half("d_a", "tip_radius"),
    half("outside_diameter", "tip_radius"),
    half("outer_diameter", "tip_radius"),
    half("addendum_diameter", "tip_radius"),
    word("k", "tip_shortening"),
    word("h_ap", "addendum"),
    word("h_fp", "dedendum"),
    word("addendum_coefficient", "addendum"),
    word("dedendum_coefficient", "dedendum"),
    word("rho_fp", "tip_radius"),
    other("root_diameter", "rack", ROOT),
    other("root_radius", "rack", ROOT),
    other("d_f", "rack", ROOT),
    none("pitch_diameter", REFERENCE),
    none("reference_diameter", REFERENCE),
    none("pitch_radius", REFERENCE),
    none("base_diameter", REFERENCE),
    none("base_radius", REFERENCE),
    none("d_b", REFERENCE),
    none("ratio", RATIO),
    none("gear_ratio", RATIO),
    none("transmission_ratio", RATIO),
    none("u", RATIO),
    backlash("backlash"),
    backlash("circumferential_backlash"),
    backlash("normal_backlash"),
    backlash("j_t"),
    backlash("j_n"),
    backlash("jn"),
    none("backlash", BACKLASH),
    clearance("clearance"),
    clearance("tip_clearance"),
    clearance("bottom_clearance"),
    clearance("root_clearance"),
    clearance("c_star"),
    none("clearance", CLEARANCE),
    word("e", "youngs_modulus"),
    word("elastic_modulus", "youngs_modulus"),
    word("e_modulus", "youngs_modulus"),
    word("young_modulus", "youngs_modulus"),
    word("modulus_of_elasticity", "youngs_modulus"),
    word("nu", "poisson_ratio"),
    word("poisson", "poisson_ratio"),
    word("poissons_ratio", "poisson_ratio"),
    word("t", "torque"),
    word("moment", "torque"),
    word("load", "torque"),
    remarked("pinion_torque", "torque", PINION),
    remarked("torque_pinion", "torque", PINION),
    remarked("t1", "torque", PINION),
    remarked("t_1", "torque", PINION),
    remarked("input_torque", "torque", DRIVER),
    remarked("driving_torque", "torque", DRIVER),
    remarked("driver_torque", "torque", DRIVER),
    gear_torque("gear_torque"),
    gear_torque("torque_gear"),
    gear_torque("wheel_torque"),
    gear_torque("torque_wheel"),
    gear_torque("output_torque"),
    gear_torque("driven_torque"),
    gear_torque("load_torque"),
    gear_torque("torque_2"),
    gear_torque("torque2"),
    gear_torque("t2"),
    gear_torque("t_2"),
    other("force", "torque", "T = F_t d1/2, of the tangential force F_t at the reference circle of the pinion"),
    other(
        "tangential_force",
        "torque",
        "T = F_t d1/2, of the tangential force F_t at the reference circle of the pinion",
    ),
    other("normal_force", "torque", "T = F_bn d_b1/2, of the normal force F_bn and the base circle of the pinion"),
    power("power"),
    power("kw"),
    power("hp"),
    power("nominal_power"),
    power("rated_power"),
    power("input_power"),
    word("c_a", "amount"),
    word("ca", "amount"),
    word("c_beta", "amount"),
    word("depth", "amount"),
    word("l_ca", "length"),
    none("helix_angle", SPUR),
    none("beta", SPUR),
    none("helix", SPUR),
    none("helical", SPUR),
    none("hand", SPUR),
    none("internal", EXTERNAL),
    none("is_internal", EXTERNAL),
    none("internal_gear", EXTERNAL),
    none("ring", EXTERNAL),
    none("ring_gear", EXTERNAL),
    none("annulus", EXTERNAL),
    none("planet", EXTERNAL),
    none("planets", EXTERNAL),
    none("sun", EXTERNAL),
    remarked("rpm", "speed", "with its unit, such as `1500 rpm`"),
    word("rotational_speed", "speed"),
    word("angular_speed", "speed"),
    word("angular_velocity", "speed"),
    word("n", "speed"),
    word("n1", "speed"),
    word("input_speed", "speed"),
    word("omega", "speed"),
    other("gear_speed", "speed", "that of the pinion, n_pinion = n_gear z2/z1"),
    other("wheel_speed", "speed", "that of the pinion, n_pinion = n_gear z2/z1"),
    other("output_speed", "speed", "that of the pinion, n_pinion = n_gear z2/z1"),
    none("speed", SPEED),
    none("rpm", SPEED),
    none("rotational_speed", SPEED),
    none("n", SPEED),
    none("n1", SPEED),
    none("omega", SPEED),
    word("rho", "density"),
    none("damping", STATIC),
    word("k_a", "application_factor"),
    word("ka", "application_factor"),
    word("service_factor", "application_factor"),
    word("overload_factor", "application_factor"),
    none("k_a", "the torque is the load as it is: multiply it by K_A; `kind: rating` takes an `application_factor`"),
    none(
        "application_factor",
        "the torque is the load as it is: multiply it by K_A; `kind: rating` takes an `application_factor`",
    ),
    hardness("hrc"),
    hardness("hv"),
    hardness("hb"),
    hardness("hbw"),
    hardness("brinell"),
    hardness("surface_hardness"),
    none("hrc", HARDNESS),
    none("hardness", HARDNESS),
    none("hb", HARDNESS),
    none("hv", HARDNESS),
    remarked("quality", "tolerance_class", "of ISO 1328-1"),
    remarked("quality_grade", "tolerance_class", "of ISO 1328-1"),
    remarked("accuracy_grade", "tolerance_class", "of ISO 1328-1"),
    remarked("iso_quality", "tolerance_class", "of ISO 1328-1"),
    other("agma_quality", "tolerance_class", "of ISO 1328-1; older AGMA numbers count the other way"),
    none("quality", QUALITY),
    none("quality_grade", QUALITY),
    none("accuracy_grade", QUALITY),
];

const HARDNESS: &str = "hardness matters to strength alone: `kind: rating` takes `contact_strength` and `bending_strength` (sigma_Hlim and \
                        sigma_FE by ISO 6336-5), and a Brinell `hardness` of a soft gear";
const QUALITY: &str = "a quality grade is the `tolerance_class` (ISO 1328-1) of `kind: rating`; transmission errors take measured or \
                       stated deviations of the flanks";
