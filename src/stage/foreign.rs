//! What users of other programs, standards and textbooks call the fields of this one.
//!
//! Symbols and words of ISO 21771 and ISO 6336, of the American standards, and of the programs whose printouts users have.
//! Must not know: which stage a field belongs to.

use studygraph::program::Foreign;

const fn word(word: &'static str, field: &'static str) -> Foreign {
    Foreign { word, field: Some(field), remark: "" }
}

const fn half(word: &'static str, field: &'static str) -> Foreign {
    Foreign { word, field: Some(field), remark: "a radius, half of the diameter" }
}

const fn none(word: &'static str, remark: &'static str) -> Foreign {
    Foreign { word, field: None, remark }
}

const SPUR: &str = "spur gears only: there is no helix, and every section is the transverse section";
const STATIC: &str = "the pair is computed at rest: there is no speed, no mass and no damping";

/// Words of others. One with several fields has the likeliest first.
pub static FOREIGN: &[Foreign] = &[
    word("z", "teeth"),
    word("number_of_teeth", "teeth"),
    word("tooth_count", "teeth"),
    word("m", "module"),
    word("m_n", "module"),
    word("mn", "module"),
    word("normal_module", "module"),
    word("transverse_module", "module"),
    word("m_t", "module"),
    Foreign { word: "diametral_pitch", field: Some("module"), remark: "25.4 mm over the diametral pitch" },
    word("alpha", "pressure_angle"),
    word("alpha_n", "pressure_angle"),
    word("x", "profile_shift"),
    word("addendum_modification", "profile_shift"),
    word("profile_shift_coefficient", "profile_shift"),
    word("b", "face_width"),
    word("width", "face_width"),
    word("a", "centre_distance"),
    word("a_w", "centre_distance"),
    word("center_distance", "centre_distance"),
    half("bore_diameter", "bore_radius"),
    half("bore", "bore_radius"),
    half("inner_diameter", "bore_radius"),
    half("tip_diameter", "tip_radius"),
    half("d_a", "tip_radius"),
    half("outside_diameter", "tip_radius"),
    word("k", "tip_shortening"),
    word("h_ap", "addendum"),
    word("h_fp", "dedendum"),
    word("rho_fp", "tip_radius"),
    word("e", "youngs_modulus"),
    word("elastic_modulus", "youngs_modulus"),
    word("nu", "poisson_ratio"),
    word("poissons_ratio", "poisson_ratio"),
    word("t", "torque"),
    word("moment", "torque"),
    word("load", "torque"),
    word("c_a", "amount"),
    word("ca", "amount"),
    word("c_beta", "amount"),
    word("depth", "amount"),
    word("l_ca", "length"),
    none("helix_angle", SPUR),
    none("beta", SPUR),
    none("helix", SPUR),
    none("hand", SPUR),
    none("speed", STATIC),
    none("rpm", STATIC),
    word("rho", "density"),
    none("damping", STATIC),
];
