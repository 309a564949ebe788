//! What a rating needs to know beside the pair: load, deviations, lubricant, materials, blanks; and factors that are stated.
//!
//! A factor that is stated stands in the place of the computed one. Must not know: any formula.

use declare::Declared;
use declare::units::{LENGTH, MOMENT_OF_INERTIA, STRESS, VISCOSITY};

use super::life::Pitting;
use super::material::MaterialClass;

/// The largest deviation, relief and roughness \[m\].
const MOST: f64 = 1e-3;
/// The largest factor that is stated.
const LARGEST: f64 = 100.0;

/// What a pair is rated under.
#[derive(Clone, Debug, PartialEq, Declared)]
pub struct Conditions {
    /// K_A: what loads from outside add to the nominal torque.
    #[declared(minimum = 0.01, maximum = LARGEST, default = "1.0")]
    pub application_factor: f64,
    /// Tolerance class of both gears by ISO 1328-1:2013, for those deviations that are not stated.
    #[declared(minimum = 1, maximum = 11, example = "6")]
    pub tolerance_class: Option<i64>,
    /// f_pb: transverse base pitch deviation, the larger one of both gears.
    #[declared(minimum = 0.0, maximum = MOST, dimension = LENGTH, example = "7 um")]
    pub base_pitch_deviation: Option<f64>,
    /// f_fα: profile form deviation, the larger one of both gears.
    #[declared(minimum = 0.0, maximum = MOST, dimension = LENGTH, example = "8 um")]
    pub profile_form_deviation: Option<f64>,
    /// F_βx: equivalent misalignment over the face width before running in; without it, what `shaft` and f_Hβ of both gears give.
    #[declared(minimum = 0.0, maximum = MOST, dimension = LENGTH, example = "12 um")]
    pub equivalent_misalignment: Option<f64>,
    /// The shaft of the standard's pinion, for F_βx; without it the pinion sits in the middle between its bearings.
    pub shaft: Option<Shaft>,
    /// C_a: tip relief for K_V; without it, what running in leaves (C_ay). In a `tolerance_class` of 6 or more it counts for nothing.
    #[declared(minimum = 0.0, maximum = MOST, dimension = LENGTH, example = "20 um")]
    pub tip_relief: Option<f64>,
    /// ν40: nominal viscosity of the lubricant at 40 °C.
    #[declared(minimum = 1e-6, maximum = 1e-1, dimension = VISCOSITY, example = "220 mm^2/s")]
    pub viscosity: Option<f64>,
    /// Whether some pitting is allowed.
    #[declared(default = "none")]
    pub pitting: Pitting,
    /// Z_NT and Y_NT at 1e10 load cycles: 0.85, up to 1 with the best of material, manufacture and lubrication.
    #[declared(minimum = 0.85, maximum = 1.0, default = "0.85")]
    pub long_life_factor: f64,
    /// How far the root of a wider gear carries beyond the common face width at each end, in modules.
    #[declared(minimum = 0.0, maximum = 1.0, default = "1.0", counts_in = "module")]
    pub overhang: f64,
    /// S_Hmin: least safety against pitting.
    #[declared(minimum = 0.1, maximum = LARGEST, default = "1.0")]
    pub least_contact_safety: f64,
    /// S_Fmin: least safety against tooth breakage.
    #[declared(minimum = 0.1, maximum = LARGEST, default = "1.0")]
    pub least_root_safety: f64,
    /// Factors of the pair that are stated, not computed.
    #[declared(default = "{}")]
    pub factors: PairFactors,
    /// The pinion of the geometry.
    pub pinion: GearConditions,
    /// The gear of the geometry.
    pub gear: GearConditions,
}

/// How the shaft of a pinion bends and winds up: what f_sh follows from (ISO 6336-1, 7, figure 13).
#[derive(Clone, Copy, Debug, PartialEq, Declared)]
pub struct Shaft {
    /// K′: of where the pinion sits and torque comes in, −1 to 1.33.
    #[declared(minimum = -2.0, maximum = 2.0, example = "0.48")]
    pub arrangement: f64,
    /// l: distance of the bearings.
    #[declared(minimum = 1e-4, maximum = 100.0, dimension = LENGTH, example = "120 mm")]
    pub span: f64,
    /// s: distance of the pinion from the middle between them.
    #[declared(minimum = 0.0, maximum = 100.0, dimension = LENGTH, example = "15 mm")]
    pub offset: f64,
    /// d_sh: diameter of the shaft.
    #[declared(minimum = 1e-4, maximum = 10.0, dimension = LENGTH, example = "40 mm")]
    pub diameter: f64,
}

/// Factors of a pair that are stated.
#[derive(Clone, Debug, PartialEq, Declared)]
pub struct PairFactors {
    /// C_R: gear blank factor.
    #[declared(minimum = 0.01, maximum = LARGEST, example = "1.0")]
    pub blank_factor: Option<f64>,
    /// B_k: what tip relief leaves of the deflection.
    #[declared(minimum = 0.0, maximum = LARGEST, example = "1.0")]
    pub relief_parameter: Option<f64>,
    /// K_V: internal dynamic factor.
    #[declared(minimum = 0.01, maximum = LARGEST, example = "1.05")]
    pub dynamic_factor: Option<f64>,
    /// K_Hβ: face load factor, contact.
    #[declared(minimum = 1.0, maximum = LARGEST, example = "1.15")]
    pub face_load_factor_contact: Option<f64>,
    /// K_Fβ: face load factor, root.
    #[declared(minimum = 1.0, maximum = LARGEST, example = "1.1")]
    pub face_load_factor_root: Option<f64>,
    /// K_Hα: transverse load factor, contact.
    #[declared(minimum = 1.0, maximum = LARGEST, example = "1.0")]
    pub transverse_load_factor_contact: Option<f64>,
    /// K_Fα: transverse load factor, root.
    #[declared(minimum = 1.0, maximum = LARGEST, example = "1.0")]
    pub transverse_load_factor_root: Option<f64>,
    /// Z_H: zone factor.
    #[declared(minimum = 0.01, maximum = LARGEST, example = "2.495")]
    pub zone_factor: Option<f64>,
    /// Z_E in √(N/mm²): elasticity factor.
    #[declared(minimum = 0.01, maximum = 10_000.0, example = "189.8")]
    pub elasticity_factor: Option<f64>,
    /// Z_ε: contact ratio factor.
    #[declared(minimum = 0.01, maximum = LARGEST, example = "0.9")]
    pub contact_ratio_factor: Option<f64>,
    /// Z_L: lubricant factor.
    #[declared(minimum = 0.01, maximum = LARGEST, example = "1.0")]
    pub lubricant_factor: Option<f64>,
    /// Z_V: velocity factor.
    #[declared(minimum = 0.01, maximum = LARGEST, example = "1.0")]
    pub velocity_factor: Option<f64>,
    /// Z_R: roughness factor.
    #[declared(minimum = 0.01, maximum = LARGEST, example = "1.0")]
    pub roughness_factor: Option<f64>,
}

/// What one of the gears is made of, and as what.
#[derive(Clone, Debug, PartialEq, Declared)]
pub struct GearConditions {
    /// Material and heat treatment.
    #[declared(example = "case_hardened_steel")]
    pub material: MaterialClass,
    /// σ_Hlim: allowable stress number for contact; without it no safety against pitting is computed.
    #[declared(minimum = 1e6, maximum = 1e10, dimension = STRESS, example = "1500 MPa")]
    pub contact_strength: Option<f64>,
    /// σ_Flim: nominal stress number for bending; without it no safety against breakage is computed.
    #[declared(minimum = 1e6, maximum = 1e10, dimension = STRESS, example = "430 MPa")]
    pub bending_strength: Option<f64>,
    /// σ_S or σ_0.2, for Y_δrelT of structural and through-hardened steel, pearlitic nodular and malleable iron.
    #[declared(minimum = 1e6, maximum = 1e10, dimension = STRESS, example = "700 MPa")]
    pub yield_strength: Option<f64>,
    /// σ_B, for Y_δrelT of grey and of ferritic nodular cast iron.
    #[declared(minimum = 1e6, maximum = 1e10, dimension = STRESS, example = "250 MPa")]
    pub tensile_strength: Option<f64>,
    /// HB: Brinell hardness of the flank, for Z_W of a soft gear.
    #[declared(minimum = 50.0, maximum = 1000.0, example = "260")]
    pub hardness: Option<f64>,
    /// f_Hβ: helix slope deviation of this gear, for F_βx.
    #[declared(minimum = 0.0, maximum = MOST, dimension = LENGTH, example = "8 um")]
    pub helix_slope_deviation: Option<f64>,
    /// Load cycles N_L; without them the life factors are 1, as at the knee of the curves.
    #[declared(minimum = 1.0, maximum = 1e15, example = "1e9")]
    pub cycles: Option<f64>,
    /// R_z of the flank.
    #[declared(minimum = 1e-8, maximum = MOST, dimension = LENGTH, example = "4 um")]
    pub flank_roughness: Option<f64>,
    /// R_z of the fillet.
    #[declared(minimum = 1e-8, maximum = MOST, dimension = LENGTH, example = "16 um")]
    pub root_roughness: Option<f64>,
    /// s_R: thickness of the rim below the root circle; without it the blank is solid down to the bore.
    #[declared(minimum = 1e-6, maximum = 1e2, dimension = LENGTH, example = "12 mm")]
    pub rim_thickness: Option<f64>,
    /// b_s: thickness of the web that carries the rim; without it as wide as the face.
    #[declared(minimum = 1e-6, maximum = 1e2, dimension = LENGTH, example = "6 mm")]
    pub web_thickness: Option<f64>,
    /// J: moment of inertia, in the place of that of the rim.
    #[declared(minimum = 1e-15, maximum = 1e9, dimension = MOMENT_OF_INERTIA, example = "2e-4 kg m^2")]
    pub moment_of_inertia: Option<f64>,
    /// Factors of this gear that are stated, not computed.
    #[declared(default = "{}")]
    pub factors: GearFactors,
}

/// Factors of a gear that are stated.
#[derive(Clone, Debug, PartialEq, Declared)]
pub struct GearFactors {
    /// Z_B of the standard's pinion, Z_D of its wheel: single pair tooth contact factor.
    #[declared(minimum = 0.01, maximum = LARGEST, example = "1.0")]
    pub single_contact_factor: Option<f64>,
    /// Z_NT: life factor, contact.
    #[declared(minimum = 0.01, maximum = LARGEST, example = "1.0")]
    pub life_factor_contact: Option<f64>,
    /// Z_W: work hardening factor.
    #[declared(minimum = 0.01, maximum = LARGEST, example = "1.0")]
    pub work_hardening_factor: Option<f64>,
    /// Z_X: size factor, contact; 1 unless it is said.
    #[declared(minimum = 0.01, maximum = LARGEST, default = "1.0")]
    pub size_factor_contact: f64,
    /// Y_F: form factor.
    #[declared(minimum = 0.01, maximum = LARGEST, example = "1.4")]
    pub form_factor: Option<f64>,
    /// Y_S: stress correction factor.
    #[declared(minimum = 0.01, maximum = LARGEST, example = "2.0")]
    pub stress_correction_factor: Option<f64>,
    /// Y_B: rim thickness factor.
    #[declared(minimum = 0.01, maximum = LARGEST, example = "1.0")]
    pub rim_thickness_factor: Option<f64>,
    /// Y_ST: stress correction factor of the test gears; 2 by the standard.
    #[declared(minimum = 0.01, maximum = LARGEST, default = "2.0")]
    pub test_stress_correction_factor: f64,
    /// Y_NT: life factor, root.
    #[declared(minimum = 0.01, maximum = LARGEST, example = "1.0")]
    pub life_factor_root: Option<f64>,
    /// Y_δrelT: relative notch sensitivity factor.
    #[declared(minimum = 0.01, maximum = LARGEST, example = "1.0")]
    pub notch_sensitivity_factor: Option<f64>,
    /// Y_RrelT: relative surface factor.
    #[declared(minimum = 0.01, maximum = LARGEST, example = "1.0")]
    pub surface_factor: Option<f64>,
    /// Y_X: size factor, root.
    #[declared(minimum = 0.01, maximum = LARGEST, example = "1.0")]
    pub size_factor_root: Option<f64>,
}
