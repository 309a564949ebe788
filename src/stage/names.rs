//! Names of tables and columns by which one stage reads what another one writes.
//!
//! Writer and reader take a name from here, so neither can change it alone; that the tables have these columns is checked
//! with the registry of kinds. Must not know: what is in a table.

/// Through which port a stage reads the pair.
pub const PAIR_PORT: &str = "pair";
/// Through which port a stage reads the pair's compliances.
pub const STIFFNESS_PORT: &str = "stiffness";
/// Through which port a stage reads what loads do to the roots.
pub const ROOT_INFLUENCES_PORT: &str = "root_influences";

/// A table that is read by name.
pub struct Read {
    /// The kind of the stage that writes it.
    pub kind: &'static str,
    pub table: &'static str,
    /// Those of its columns that are read by name.
    pub columns: &'static [&'static str],
}

macro_rules! tables {
    ($($module:ident of $kind:literal: $table:literal { $($column:ident = $name:literal),* $(,)? })*) => {
        $(pub mod $module {
            pub const TABLE: &str = $table;
            $(pub const $column: &str = $name;)*
        })*

        /// All of them.
        pub const READ: &[Read] = &[$(Read { kind: $kind, table: $table, columns: &[$($name),*] }),*];
    };
}

tables! {
    gears of "geometry": "gears" {
        GEAR = "gear",
        TEETH = "teeth",
        MODULE = "module",
        PRESSURE_ANGLE = "pressure_angle",
        PROFILE_SHIFT = "profile_shift",
        THICKNESS_ALLOWANCE = "thickness_allowance",
        RACK_ADDENDUM = "rack_addendum",
        RACK_DEDENDUM = "rack_dedendum",
        RACK_TIP_RADIUS = "rack_tip_radius",
        PROTUBERANCE = "protuberance",
        PROTUBERANCE_ANGLE = "protuberance_angle",
        MACHINING_ALLOWANCE = "machining_allowance",
        NOTCH_RADIUS = "notch_radius",
        CUTTER_TEETH = "cutter_teeth",
        CUTTER_PROFILE_SHIFT = "cutter_profile_shift",
        CUTTER_ADDENDUM = "cutter_addendum",
        CUTTER_TIP_RADIUS = "cutter_tip_radius",
        FACE_WIDTH = "face_width",
        BORE_RADIUS = "bore_radius",
        YOUNGS_MODULUS = "youngs_modulus",
        POISSON_RATIO = "poisson_ratio",
        DENSITY = "density",
        TIP_RADIUS = "tip_radius",
        TIP_CHAMFER = "tip_chamfer",
        TIP_ROUNDING = "tip_rounding",
        TIP_RAMP_ANGLE = "tip_ramp_angle",
        TIP_RAMP_HEIGHT = "tip_ramp_height",
    }
    pair of "geometry": "pair" { CENTRE_DISTANCE = "centre_distance" }
    outline of "geometry": "outline" {
        GEAR = "gear",
        TOOTH = "tooth",
        POINT = "point",
        STRETCH = "stretch",
        PART = "part",
        CURVE = "curve",
        X = "x",
        Y = "y",
        DIRECTION = "direction",
        CURVATURE = "curvature",
    }
    compliance of "stiffness": "compliance" { GEAR = "gear", ROLL_ANGLE = "roll_angle", CORNER = "corner" }
    neighbours of "stiffness": "neighbours" {
        GEAR = "gear",
        NEIGHBOUR = "neighbour",
        NODE = "node",
        ROLL_ANGLE = "roll_angle",
        FURTHER_ROLL_ANGLE = "further_roll_angle",
        COMPLIANCE = "compliance",
    }
    model of "stiffness": "model" { CONTACT = "contact", PLANE = "plane", COUPLING = "coupling" }
    designs of "modification": "designs" { DESIGN = "design", ORDER = "order", ELEMENTS = "elements" }
    elements of "modification": "elements" {
        DESIGN = "design",
        ELEMENT = "element",
        FAMILY = "family",
        PARAMETER = "parameter",
        VALUE = "value",
        UNIT = "unit",
        WORD = "word",
    }
    root_influences of "stiffness": "root_influences" {
        GEAR = "gear",
        TOOTH = "tooth",
        NODE = "node",
        PLACE = "place",
        ROLL_ANGLE = "roll_angle",
        RADIUS = "radius",
        LENGTH = "length",
        STRESS = "stress",
        ERROR_ESTIMATE = "error_estimate",
    }
    summary of "ste": "summary" {
        DESIGN = "design",
        TORQUE = "torque",
        LARGEST_PRESSURE = "largest_pressure",
        LARGEST_ROOT_STRESS_PINION = "largest_root_stress_pinion",
        LARGEST_ROOT_STRESS_GEAR = "largest_root_stress_gear",
        ROOT_STRESS_POSITION_PINION = "root_stress_position_pinion",
        ROOT_STRESS_POSITION_GEAR = "root_stress_position_gear",
        ROOT_STRESS_RADIUS_PINION = "root_stress_radius_pinion",
        ROOT_STRESS_RADIUS_GEAR = "root_stress_radius_gear",
        ROOT_STRESS_ERROR_PINION = "root_stress_error_pinion",
        ROOT_STRESS_ERROR_GEAR = "root_stress_error_gear",
        ISO6336_ROOT_STRESS_PINION = "iso6336_root_stress_pinion",
        ISO6336_ROOT_STRESS_GEAR = "iso6336_root_stress_gear",
    }
    curve of "ste": "curve" {
        PRESSURE = "pressure",
        ROOT_STRESS_PINION = "root_stress_pinion",
        ROOT_STRESS_GEAR = "root_stress_gear",
    }
}
