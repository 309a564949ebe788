//! What users of other programs, standards and textbooks call the fields of this one.
//!
//! Symbols and words of ISO 21771 and ISO 6336, of the American standards, and of the programs whose printouts users have.
//! Must not know: which stage a field belongs to.

mod german;
mod remedies;

pub use remedies::DERIVED;

use german::GERMAN;
use remedies::{half_of, of_diametral_pitch, of_force, of_gear_torque, of_power, of_tip_alteration, twice};
use studygraph::program::Foreign;

const GEARS: &[&str] = &["pinion", "gear"];
const RACK: &[&str] = &["rack"];

const fn word(word: &'static str, field: &'static str) -> Foreign {
    remarked(word, field, "")
}

const fn remarked(word: &'static str, field: &'static str, remark: &'static str) -> Foreign {
    Foreign { word, field: Some(field), inside: &[], remark, is_other: false, remedy: None }
}

/// A word that means this field in these mappings alone.
const fn within(inside: &'static [&'static str], foreign: Foreign) -> Foreign {
    Foreign { inside, ..foreign }
}

const fn half(word: &'static str, field: &'static str) -> Foreign {
    Foreign { remedy: Some(half_of), ..within(GEARS, remarked(word, field, "a radius, half of the diameter")) }
}

const fn none(word: &'static str, remark: &'static str) -> Foreign {
    Foreign { word, field: None, inside: &[], remark, is_other: false, remedy: None }
}

/// Another quantity than the field's, which the remark says how to find.
const fn other(word: &'static str, field: &'static str, remark: &'static str) -> Foreign {
    Foreign { is_other: true, ..remarked(word, field, remark) }
}

const fn power(word: &'static str) -> Foreign {
    Foreign { remedy: Some(of_power), ..other(word, "torque", OF_POWER) }
}

const fn tangential_force(word: &'static str) -> Foreign {
    Foreign { remedy: Some(of_force), ..other(word, "torque", OF_FORCE) }
}

const fn gear_torque(word: &'static str) -> Foreign {
    Foreign { remedy: Some(of_gear_torque), ..other(word, "torque", GEAR_TORQUE) }
}

const fn gear_speed(word: &'static str) -> Foreign {
    other(word, "speed", "that of the pinion, n_pinion = n_gear z2/z1")
}

const fn pitch(word: &'static str) -> Foreign {
    let remark = "25.4 mm over the diametral pitch";
    Foreign { remedy: Some(of_diametral_pitch), ..other(word, "module", remark) }
}

const fn tip_alteration(word: &'static str) -> Foreign {
    Foreign { remedy: Some(of_tip_alteration), ..within(GEARS, other(word, "tip_shortening", TIP_ALTERATION)) }
}

const fn backlash(word: &'static str) -> Foreign {
    other(word, "tooth_thickness", BACKLASH)
}

const fn clearance(word: &'static str) -> Foreign {
    other(word, "dedendum", CLEARANCE)
}

const fn fillet(word: &'static str) -> Foreign {
    within(
        RACK,
        remarked(word, "tip_radius", "the fillet of the root is the tip radius of the tool, rho_fP over the module"),
    )
}

const fn thickness(word: &'static str) -> Foreign {
    other(word, "tooth_thickness", THICKNESS)
}

const fn hardness(word: &'static str) -> Foreign {
    other(word, "hardness", "Brinell, a plain number; convert other scales by the tables of ISO 18265")
}

const fn grade(word: &'static str) -> Foreign {
    remarked(word, "tolerance_class", "of ISO 1328-1")
}

const fn agma(word: &'static str) -> Foreign {
    other(word, "tolerance_class", "of ISO 1328-1; older AGMA numbers count the other way")
}

const SPUR: &str = "spur gears only: there is no helix, and every section is the transverse section";
const STATIC: &str = "the pair is computed at rest: there is no speed, no mass and no damping";
const SPEED: &str = "the pair is loaded by its `torque` alone; friction and `kind: rating` take a `speed`";
const EXTERNAL: &str = "pairs of external gears only: neither internal gears nor planets are modelled";
const TIP_ALTERATION: &str =
    "the tip alteration coefficient k of ISO 21771 is negative where the tip is shortened: tip_shortening = -k";
const GEAR_TORQUE: &str = "that on the pinion, T_pinion = T_gear z1/z2";
const PINION: &str = "that on the pinion";
const DRIVER: &str = "that on the pinion, whichever gear drives; of a torque on the gear T_pinion = T_gear z1/z2";
const BACKLASH: &str = "backlash follows from the thickness of the teeth of each gear and from the centre distance: give \
                        allowances, as in `tooth_thickness: { allowance: { upper: -60 um, lower: -90 um } }`, and \
                        `centre_distance`";
const CLEARANCE: &str = "the clearance is m(h_fP* - h_aP*) where the centre distance is nominal: with an addendum of 1 a clearance \
                         of 0.25 m is a dedendum of 1.25";
const MODIFICATION: &str = "modifications of the flanks are the designs of a stage of `kind: modification`, such as \
                            `tip_relief: { gear: pinion, amount: 20 um, length: 4 mm }`";
const THICKNESS: &str = "by an `allowance` of the thickness, a `span` over teeth or a size `over_balls`, such as \
                         `tooth_thickness: { allowance: { upper: -60 um, lower: -90 um } }`";
const OF_POWER: &str = "the torque on the pinion is T = P/(2 pi n), n in revolutions per second of the pinion";
const OF_FORCE: &str = "T = F_t d1/2, of the tangential force F_t at the reference circle of the pinion, d1 = m z1";
const OF_LINE_LOAD: &str =
    "T = w b d1/2, of the load w per face width b at the reference circle of the pinion, d1 = m z1";
const RIM: &str = "the radius of the root circle minus the thickness of the rim";
const COMPUTED: &str = "it follows from the geometry and is computed: it is in the tables of the pair";
const STIFFNESS: &str = "the stiffness of the teeth is computed from their geometry by the `method`";
const MISALIGNMENT: &str = "the slope of the contact line over the face width: a `helix_slope` of the load case, or `parallelism_in_plane` and \
                            `parallelism_out_of_plane` of the axes";
const PITCH: &str = "pitch deviations of single teeth are stated as `pinion` and `gear` of `kind: hunting`; tolerances by \
                     `tolerance_class` belong to `kind: rating`";
const RATIO: &str = "the gear ratio follows from the numbers of teeth; give `teeth` of pinion and gear";
const REFERENCE: &str = "reference and base circles follow from the module, the teeth and the pressure angle: d = m z, \
                         d_b = d cos(alpha)";
const ROOT: &str =
    "the root circle follows from the tool: d_f = m(z + 2 x - 2 h_fP*), with `dedendum` of `rack` as h_fP*";

/// Words of others, by language. Of those with several fields the likeliest is the first.
pub static FOREIGN: &[&[Foreign]] = &[ENGLISH, GERMAN];

static ENGLISH: &[Foreign] = &[
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
    word("basic_rack", "rack"),
    word("tool", "rack"),
    word("hob", "rack"),
    word("fem", "finite_element"),
    word("fea", "finite_element"),
    word("fe", "finite_element"),
    word("potential_energy", "energy"),
    word("energy_method", "energy"),
    word("weber", "weber_banaschek"),
    word("iso", "iso6336"),
    within(&["gear"], word("wheel", "gear")),
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
    half("d_i", "bore_radius"),
    half("tip_circle_diameter", "tip_radius"),
    other("rim_thickness", "bore_radius", RIM),
    other("rim", "bore_radius", RIM),
    thickness("span"),
    thickness("w_k"),
    thickness("span_measurement"),
    thickness("base_tangent_length"),
    thickness("over_balls"),
    thickness("over_pins"),
    thickness("m_dk"),
    thickness("s_n"),
    none("contact_ratio", COMPUTED),
    none("eps_alpha", COMPUTED),
    none("epsilon_alpha", COMPUTED),
    none("c_gamma", STIFFNESS),
    none("mesh_stiffness", STIFFNESS),
    tip_alteration("k"),
    tip_alteration("tip_alteration"),
    tip_alteration("tip_alteration_coefficient"),
    word("h_ap", "addendum"),
    word("h_fp", "dedendum"),
    word("addendum_coefficient", "addendum"),
    word("dedendum_coefficient", "dedendum"),
    within(RACK, word("rho_fp", "tip_radius")),
    within(RACK, word("rho_a0", "tip_radius")),
    fillet("root_radius"),
    fillet("fillet_radius"),
    fillet("root_fillet"),
    fillet("root_fillet_radius"),
    fillet("tool_tip_radius"),
    fillet("edge_radius"),
    other("root_diameter", "rack", ROOT),
    other("root_radius", "rack", ROOT),
    other("d_f", "rack", ROOT),
    none("d", REFERENCE),
    none("d_p", REFERENCE),
    none("d_w", WORKING),
    none("working_pitch_diameter", WORKING),
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
    remarked("torque_on_pinion", "torque", PINION),
    remarked("torque_at_pinion", "torque", PINION),
    remarked("torque_of_pinion", "torque", PINION),
    remarked("t1", "torque", PINION),
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
    gear_torque("torque_on_gear"),
    gear_torque("torque_on_wheel"),
    gear_torque("torque_at_gear"),
    gear_torque("torque_at_wheel"),
    gear_torque("torque_of_gear"),
    gear_torque("gear_moment"),
    gear_torque("t2"),
    gear_torque("t_2"),
    tangential_force("force"),
    tangential_force("tangential_force"),
    tangential_force("f_t"),
    other("line_load", "torque", OF_LINE_LOAD),
    other("specific_load", "torque", OF_LINE_LOAD),
    other("normal_force", "torque", "T = F_bn d_b1/2, of the normal force F_bn and the base circle of the pinion"),
    power("power"),
    power("kw"),
    power("hp"),
    power("nominal_power"),
    power("rated_power"),
    power("input_power"),
    power("output_power"),
    power("driving_power"),
    power("driven_power"),
    power("transmitted_power"),
    power("motor_power"),
    power("shaft_power"),
    within(&["tip_relief"], word("c_a", "amount")),
    within(&["root_relief"], word("c_f", "amount")),
    within(&["profile_crowning"], word("c_alpha", "amount")),
    Foreign { remedy: Some(twice), ..remarked("start_radius", "start_diameter", "twice the radius") },
    within(&["lead_crowning"], word("c_beta", "amount")),
    other("c_beta", "lead_crowning", "the crowning height of a `lead_crowning`"),
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
    none("internal_teeth", EXTERNAL),
    none("internal_toothing", EXTERNAL),
    none("ring", EXTERNAL),
    none("ring_gear", EXTERNAL),
    none("annulus", EXTERNAL),
    none("planet", EXTERNAL),
    none("planets", EXTERNAL),
    none("planet_gear", EXTERNAL),
    none("sun", EXTERNAL),
    none("sun_gear", EXTERNAL),
    remarked("rpm", "speed", "with its unit, such as `1500 rpm`"),
    word("rotational_speed", "speed"),
    word("angular_speed", "speed"),
    word("angular_velocity", "speed"),
    word("n", "speed"),
    word("n1", "speed"),
    word("input_speed", "speed"),
    word("omega", "speed"),
    gear_speed("gear_speed"),
    gear_speed("wheel_speed"),
    gear_speed("speed_of_gear"),
    gear_speed("driven_speed"),
    gear_speed("output_speed"),
    none("speed", SPEED),
    none("rpm", SPEED),
    none("rotational_speed", SPEED),
    none("n", SPEED),
    none("n1", SPEED),
    none("omega", SPEED),
    word("rho", "density"),
    none("tip_relief", MODIFICATION),
    none("root_relief", MODIFICATION),
    none("end_relief", MODIFICATION),
    none("crowning", MODIFICATION),
    none("lead_crowning", MODIFICATION),
    none("profile_crowning", MODIFICATION),
    none("modifications", MODIFICATION),
    none("damping", STATIC),
    none("inertia", STATIC),
    none("moment_of_inertia", STATIC),
    none("mass", STATIC),
    other("misalignment", "helix_slope", MISALIGNMENT),
    other("f_sigma_gamma", "helix_slope", MISALIGNMENT),
    other("f_beta_x", "helix_slope", MISALIGNMENT),
    other("f_beta_y", "helix_slope", MISALIGNMENT),
    none("f_pt", PITCH),
    none("f_p", PITCH),
    none("pitch_error", PITCH),
    none("pitch_deviation", PITCH),
    word("k_a", "application_factor"),
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
    grade("quality"),
    grade("quality_grade"),
    grade("accuracy_grade"),
    grade("iso_quality"),
    agma("agma_quality"),
    agma("agma"),
    agma("agma_number"),
    none("agma_quality", AGMA),
    none("agma", AGMA),
    none("agma_number", AGMA),
    none("quality", QUALITY),
    none("quality_grade", QUALITY),
    none("accuracy_grade", QUALITY),
];

const AGMA: &str =
    "a quality grade is the `tolerance_class` (ISO 1328-1) of `kind: rating`; older AGMA numbers count the other way";
const WORKING: &str = "pitch circles follow from the centre distance and the numbers of teeth: d_w1 = 2 a z1/(z1 + z2)";
const HARDNESS: &str = "hardness matters to strength alone: `kind: rating` takes `contact_strength` and `bending_strength` (sigma_Hlim and \
                        sigma_FE by ISO 6336-5), and a Brinell `hardness` of a soft gear";
const QUALITY: &str = "a quality grade is the `tolerance_class` (ISO 1328-1) of `kind: rating`; transmission errors take measured or \
                       stated deviations of the flanks";
