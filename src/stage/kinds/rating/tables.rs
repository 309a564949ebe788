//! The tables `summary` and `gears`: every factor a column, with its symbol and the clause that has it.
//!
//! Must not know: how any of it is computed.

use gearmesh::gear::geometry::Side;
use gearmesh::gear::rating::conditions::GearConditions;
use gearmesh::gear::rating::root::Section;
use gearmesh::gear::rating::{GearRating, PairRating};
use studygraph::table::columns::Columns;
use studygraph::table::schema::Column;

pub const SUMMARY: &str = "summary";
pub const GEARS: &str = "gears";
pub const TORQUE: &str = "torque";
pub const GEAR: &str = "gear";
pub const LARGEST_PRESSURE: &str = "largest_pressure";
pub const LARGEST_ROOT_STRESS: &str = "largest_root_stress";

/// What a stage of transmission errors finds under the same torque; NaN where nobody asks.
#[derive(Clone, Copy, Debug)]
pub struct Beside {
    pub pressure: f64,
    pub root_stresses: [f64; 2],
}

impl Default for Beside {
    fn default() -> Self {
        Self { pressure: f64::NAN, root_stresses: [f64::NAN; 2] }
    }
}

/// The factors of the pair under one torque.
pub struct PairRow {
    pub torque: f64,
    pub speed: f64,
    pub application_factor: f64,
    pub specific_load: f64,
    /// F_bt \[N\].
    pub normal_load: f64,
    /// α_w \[rad\].
    pub working_pressure_angle: f64,
    pub rated: PairRating,
    pub pressure: f64,
}

/// The factors of a gear under one torque.
pub struct GearRow {
    torque: f64,
    side: Side,
    is_pinion: bool,
    module: f64,
    strengths: [f64; 2],
    test_stress_correction_factor: f64,
    rated: GearRating,
    root_stress: f64,
}

impl GearRow {
    #[must_use]
    pub fn new(
        torque: f64,
        side: Side,
        is_pinion: bool,
        module: f64,
        given: &GearConditions,
        rated: GearRating,
        root_stress: f64,
    ) -> Self {
        let strengths = [given.contact_strength, given.bending_strength].map(|strength| strength.unwrap_or(f64::NAN));
        let test_stress_correction_factor = given.factors.test_stress_correction_factor;
        Self { torque, side, is_pinion, module, strengths, test_stress_correction_factor, rated, root_stress }
    }

    fn section(&self, of: impl Fn(&Section) -> f64) -> f64 {
        self.rated.section.as_ref().map_or(f64::NAN, of)
    }
}

/// A cell may be empty: what nothing is known of.
fn maybe(column: Column) -> Column {
    column.allows_nan()
}

#[must_use]
pub fn summary(beside: bool) -> Columns<PairRow> {
    let about = "Load, dynamics and the factors that both gears share, after ISO 6336-1 and -2, method B.";
    let which = "Which gear is the pinion of the standard: the one with fewer teeth.";
    let range =
        "Where the pair runs: subcritical, main resonance, intermediate, supercritical; empty when K_V is stated.";
    let elasticity = "Elasticity factor Z_E in √(N/mm²) (ISO 6336-2, 7).";
    let columns = Columns::new(SUMMARY, about)
        .float(TORQUE, "N m", "Nominal torque on the pinion of the geometry.", |row: &PairRow| row.torque)
        .key()
        .float("speed", "rpm", "Speed of the pinion of the geometry.", |row| row.speed)
        .text("standard_pinion", which, |row| row.rated.pinion.name())
        .float("gear_ratio", "", "Gear ratio u, 1 or more.", |row| row.rated.gear_ratio)
        .float("tangential_load", "N", "Nominal tangential load F_t on the reference circles.", |row| {
            row.rated.tangential_load
        })
        .float("base_tangential_load", "N", "Load F_bt normal to the flanks, along the line of action.", |row| {
            row.normal_load
        })
        .float("working_tangential_load", "N", "Tangential load F_wt on the working pitch circles.", |row| {
            row.normal_load * libm::cos(row.working_pressure_angle)
        })
        .float("radial_load", "N", "Radial load F_r, which pushes the gears apart.", |row| {
            row.normal_load * libm::sin(row.working_pressure_angle)
        })
        .float("circumferential_velocity", "m/s", "Velocity v of the reference circles.", |row| row.rated.velocity)
        .float("application_factor", "", "Application factor K_A, given.", |row| row.application_factor)
        .float("specific_load", "N/mm", "F_t K_A over the common face width.", |row| row.specific_load)
        .float("blank_factor", "", "Gear blank factor C_R, mean of both gears (ISO 6336-1, 9.3).", |row| {
            row.rated.blank_factor
        })
        .float("single_stiffness", "N/(mm um)", "Single stiffness c′ (ISO 6336-1, 9.3).", |row| {
            row.rated.single_stiffness
        })
        .float("mesh_stiffness", "N/(mm um)", "Mesh stiffness c_γα (ISO 6336-1, 9.3).", |row| {
            row.rated.mesh_stiffness
        })
        .float("reduced_mass", "kg/m", "Reduced mass m_red per face width (ISO 6336-1, 6.5.9).", |row| {
            row.rated.reduced_mass
        })
        .float("resonance_speed", "rpm", "Resonance speed n_E1 of the standard's pinion (ISO 6336-1, 6.5.3).", |row| {
            row.rated.resonance_speed
        })
        .float("resonance_ratio", "", "Resonance ratio N (ISO 6336-1, 6.5.3).", |row| row.rated.resonance_ratio)
        .text("running_range", range, |row| row.rated.range.map_or("", |range| range.name()))
        .float("pitch_parameter", "", "B_p, pitch deviation over deflection (ISO 6336-1, 6.5.4).", |row| {
            row.rated.deviations[0]
        })
        .but(maybe)
        .float("profile_parameter", "", "B_f, profile deviation over deflection (ISO 6336-1, 6.5.4).", |row| {
            row.rated.deviations[1]
        })
        .but(maybe)
        .float("relief_parameter", "", "B_k, what tip relief leaves of the deflection (ISO 6336-1, 6.5.4).", |row| {
            row.rated.deviations[2]
        })
        .but(maybe)
        .float(
            "equivalent_misalignment",
            "um",
            "Equivalent misalignment F_βx before running in (ISO 6336-1, 7).",
            |row| row.rated.equivalent_misalignment,
        )
        .but(maybe)
        .float("running_in_transverse", "um", "Running-in allowance y_α (ISO 6336-1, 8).", |row| {
            row.rated.running_in_transverse
        })
        .but(maybe)
        .float("running_in_helix", "um", "Running-in allowance y_β (ISO 6336-1, 7).", |row| row.rated.running_in_helix)
        .but(maybe)
        .float("dynamic_factor", "", "Internal dynamic factor K_V (ISO 6336-1, 6.5).", |row| row.rated.dynamic_factor)
        .float("face_load_factor_contact", "", "Face load factor K_Hβ (ISO 6336-1, 7).", |row| {
            row.rated.face_load_factor_contact
        })
        .float("face_load_factor_root", "", "Face load factor K_Fβ (ISO 6336-1, 7).", |row| {
            row.rated.face_load_factor_root
        })
        .float("transverse_load_factor_contact", "", "Transverse load factor K_Hα (ISO 6336-1, 8).", |row| {
            row.rated.transverse_load_factor_contact
        })
        .float("transverse_load_factor_root", "", "Transverse load factor K_Fα (ISO 6336-1, 8).", |row| {
            row.rated.transverse_load_factor_root
        })
        .float("zone_factor", "", "Zone factor Z_H (ISO 6336-2, 6.1).", |row| row.rated.zone_factor)
        .shown("elasticity_factor", "", elasticity, |row| 1e-3 * row.rated.elasticity_factor)
        .float("contact_ratio_factor", "", "Contact ratio factor Z_ε (ISO 6336-2, 8).", |row| {
            row.rated.contact_ratio_factor
        })
        .float("helix_angle_factor_contact", "", "Helix angle factor Z_β, 1 of spur gears (ISO 6336-2, 9).", |_| 1.0)
        .float(
            "nominal_contact_stress",
            "MPa",
            "Nominal contact stress σ_H0 at the pitch point (ISO 6336-2, 5).",
            |row| row.rated.nominal_contact_stress,
        )
        .float("lubricant_factor", "", "Lubricant factor Z_L (ISO 6336-2, 12).", |row| row.rated.lubricant_factor)
        .but(maybe)
        .float("velocity_factor", "", "Velocity factor Z_V (ISO 6336-2, 12).", |row| row.rated.velocity_factor)
        .but(maybe)
        .float("roughness_factor", "", "Roughness factor Z_R (ISO 6336-2, 12).", |row| row.rated.roughness_factor)
        .but(maybe);
    if !beside {
        return columns;
    }
    let pressure =
        "Largest contact pressure in the mesh cycle under the nominal torque, by the stage of transmission errors.";
    columns.float(LARGEST_PRESSURE, "MPa", pressure, |row| row.pressure).but(|column| column.on_demand().allows_nan())
}

#[must_use]
pub fn gears(beside: bool) -> Columns<GearRow> {
    let about = "Factors, stresses and safeties of each gear after ISO 6336-2 and -3, method B.";
    let single =
        "Single pair tooth contact factor, Z_B of the standard's pinion and Z_D of its wheel (ISO 6336-2, 6.2).";
    let columns = Columns::new(GEARS, about)
        .float(TORQUE, "N m", "Nominal torque on the pinion of the geometry.", |row: &GearRow| row.torque)
        .key()
        .text(GEAR, "Which gear: pinion or gear.", |row| row.side.name())
        .key()
        .flag("is_standard_pinion", "Whether it is the pinion of the standard.", |row| row.is_pinion)
        .float("single_contact_factor", "", single, |row| row.rated.single_contact_factor)
        .float("contact_stress", "MPa", "Contact stress σ_H (ISO 6336-2, 5).", |row| row.rated.contact_stress)
        .float("contact_strength", "MPa", "Allowable stress number σ_Hlim, given.", |row| row.strengths[0])
        .but(maybe)
        .float("life_factor_contact", "", "Life factor Z_NT (ISO 6336-2, 11).", |row| row.rated.life_factor_contact)
        .float("work_hardening_factor", "", "Work hardening factor Z_W (ISO 6336-2, 13).", |row| {
            row.rated.work_hardening_factor
        })
        .but(maybe)
        .float("size_factor_contact", "", "Size factor Z_X (ISO 6336-2, 14).", |row| row.rated.size_factor_contact)
        .float("contact_stress_limit", "MPa", "Pitting stress limit σ_HG (ISO 6336-2, 5).", |row| {
            row.rated.contact_limit
        })
        .but(maybe)
        .float("permissible_contact_stress", "MPa", "Permissible contact stress σ_HP (ISO 6336-2, 5).", |row| {
            row.rated.permissible_contact_stress
        })
        .but(maybe)
        .float("contact_safety", "", "Safety factor S_H against pitting (ISO 6336-2, 5).", |row| {
            row.rated.contact_safety
        })
        .but(maybe);
    let columns = root(columns);
    if !beside {
        return columns;
    }
    let stress = "Largest tensile stress at the root in the mesh cycle under the nominal torque, by finite elements.";
    columns
        .float(LARGEST_ROOT_STRESS, "MPa", stress, |row| row.root_stress)
        .but(|column| column.on_demand().allows_nan())
}

/// What of a gear is about its roots.
fn root(columns: Columns<GearRow>) -> Columns<GearRow> {
    let width = "Face width b that the root counts with: the common one, and what a wider gear adds (ISO 6336-3, 5).";
    let test = "Stress correction factor Y_ST of the test gears (ISO 6336-3, 5).";
    columns
        .float("root_chord", "mm", "Tooth root chord s_Fn at the critical section (ISO 6336-3, 6).", |row| {
            row.module * row.section(|section| section.chord)
        })
        .but(maybe)
        .float("fillet_radius", "mm", "Fillet radius ρ_F at the critical section (ISO 6336-3, 6).", |row| {
            row.module * row.section(|section| section.fillet_radius)
        })
        .but(maybe)
        .float("bending_lever", "mm", "Bending moment arm h_Fe (ISO 6336-3, 6).", |row| {
            row.module * row.section(|section| section.lever)
        })
        .but(maybe)
        .float("load_angle", "deg", "Load direction angle α_Fen (ISO 6336-3, 6).", |row| {
            row.section(|section| section.load_angle)
        })
        .but(maybe)
        .float("notch_parameter", "", "Notch parameter q_s (ISO 6336-3, 7).", |row| {
            row.section(|section| section.notch)
        })
        .but(maybe)
        .float("form_factor", "", "Form factor Y_F (ISO 6336-3, 6).", |row| row.rated.form_factor)
        .float("stress_correction_factor", "", "Stress correction factor Y_S (ISO 6336-3, 7).", |row| {
            row.rated.stress_correction_factor
        })
        .float("helix_angle_factor_root", "", "Helix angle factor Y_β, 1 of spur gears (ISO 6336-3, 8).", |_| 1.0)
        .float("rim_thickness_factor", "", "Rim thickness factor Y_B (ISO 6336-3, 9).", |row| {
            row.rated.rim_thickness_factor
        })
        .float("deep_tooth_factor", "", "Deep tooth factor Y_DT, 1 below ε_α = 2.05 (ISO 6336-3, 10).", |_| 1.0)
        .float("root_width", "mm", width, |row| row.rated.root_width)
        .float("nominal_root_stress", "MPa", "Nominal tooth root stress σ_F0 (ISO 6336-3, 5).", |row| {
            row.rated.nominal_root_stress
        })
        .float("root_stress", "MPa", "Tooth root stress σ_F (ISO 6336-3, 5).", |row| row.rated.root_stress)
        .float("bending_strength", "MPa", "Nominal stress number σ_Flim, given.", |row| row.strengths[1])
        .but(maybe)
        .float("test_stress_correction_factor", "", test, |row| row.test_stress_correction_factor)
        .float("life_factor_root", "", "Life factor Y_NT (ISO 6336-3, 12).", |row| row.rated.life_factor_root)
        .float("notch_sensitivity_factor", "", "Relative notch sensitivity factor Y_δrelT (ISO 6336-3, 13).", |row| {
            row.rated.notch_sensitivity_factor
        })
        .but(maybe)
        .float("surface_factor", "", "Relative surface factor Y_RrelT (ISO 6336-3, 14).", |row| {
            row.rated.surface_factor
        })
        .but(maybe)
        .float("size_factor_root", "", "Size factor Y_X (ISO 6336-3, 15).", |row| row.rated.size_factor_root)
        .float("root_stress_limit", "MPa", "Tooth root stress limit σ_FG (ISO 6336-3, 5).", |row| row.rated.root_limit)
        .but(maybe)
        .float("permissible_root_stress", "MPa", "Permissible tooth root stress σ_FP (ISO 6336-3, 5).", |row| {
            row.rated.permissible_root_stress
        })
        .but(maybe)
        .float("root_safety", "", "Safety factor S_F against tooth breakage (ISO 6336-3, 5).", |row| {
            row.rated.root_safety
        })
        .but(maybe)
}
