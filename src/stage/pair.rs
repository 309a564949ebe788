//! Gear pairs as tables: what the geometry stage writes and every stage downstream reads a pair back from.
//!
//! A pair is rebuilt from its specification columns by the same constructor that made it; the derived columns are there
//! for readers. Must not know: which stage asks.

use declare::error::Failure;
use declare::units::parse_unit;
use gearmesh::gear::geometry::{Gear, GearPair, Rack, Side, Specification};
use gearmesh::gear::material::Material;
use studygraph::table::columns::Columns;
use studygraph::table::data::Table;

/// Which gear, and what it is.
pub type GearRow<'a> = (Side, &'a Gear);

/// One row per gear.
#[must_use]
pub fn gears<'a>() -> Columns<GearRow<'a>> {
    let form_radius = "Radius at which the root curve meets the involute.";
    Columns::new("gears", "Each gear: what was specified, and what follows from it.")
        .text("gear", "Which gear: pinion or gear.", |row: &GearRow| row.0.name())
        .key()
        .integer("teeth", "Number of teeth z.", |row| row.1.specification.teeth)
        .float("module", "mm", "Module m.", |row| row.1.specification.module)
        .float("pressure_angle", "deg", "Pressure angle α.", |row| row.1.specification.pressure_angle)
        .float("profile_shift", "", "Profile shift coefficient x.", |row| row.1.specification.profile_shift)
        .float("rack_addendum", "", "Addendum of the basic rack h_aP*, in modules.", |row| {
            row.1.specification.rack.addendum
        })
        .float("rack_dedendum", "", "Dedendum of the basic rack h_fP*, in modules.", |row| {
            row.1.specification.rack.dedendum
        })
        .float("rack_tip_radius", "", "Tip radius of the cutting rack ρ_fP*, in modules.", |row| {
            row.1.specification.rack.tip_radius
        })
        .float("face_width", "mm", "Face width b.", |row| row.1.specification.face_width)
        .float("bore_radius", "mm", "Radius of the bore, where the body is clamped.", |row| {
            row.1.specification.bore_radius
        })
        .float("youngs_modulus", "GPa", "Young's modulus E.", |row| row.1.specification.material.youngs_modulus)
        .float("poisson_ratio", "", "Poisson's ratio ν.", |row| row.1.specification.material.poisson_ratio)
        .float("reference_radius", "mm", "Reference radius r.", |row| row.1.reference_radius)
        .float("base_radius", "mm", "Base radius r_b.", |row| row.1.base_radius)
        .float("tip_radius", "mm", "Tip radius r_a.", |row| row.1.tip_radius)
        .float("root_radius", "mm", "Root radius r_f.", |row| row.1.root_radius)
        .float("form_radius", "mm", form_radius, |row| row.1.form_radius)
        .float("tip_thickness", "mm", "Arc thickness of the tooth at the tip.", |row| row.1.tip_thickness())
}

/// One row.
#[must_use]
pub fn pair<'a>() -> Columns<&'a GearPair> {
    let description = "The pair on its centre distance. Path positions count from the pinion's tangent point T1.";
    Columns::new("pair", description)
        .float("centre_distance", "mm", "Centre distance a_w.", |pair: &&GearPair| pair.centre_distance)
        .float("working_pressure_angle", "deg", "Working pressure angle α_w.", |pair| pair.working_pressure_angle)
        .float("base_pitch", "mm", "Base pitch p_b.", |pair| pair.base_pitch)
        .float("contact_ratio", "", "Transverse contact ratio ε_α.", |pair| pair.contact_ratio)
        .float("tangent_length", "mm", "Length T1T2 of the common tangent, L.", |pair| pair.tangent_length)
        .float("start_of_contact", "mm", "Path position of A, the start of contact.", |pair| pair.start_of_contact)
        .float("end_of_contact", "mm", "Path position of E, the end of contact.", |pair| pair.end_of_contact)
}

/// The pair that the tables [`gears`] and [`pair`] hold.
///
/// # Errors
/// When the tables are not from a valid pair.
pub fn read(gears: &Table, pair: &Table) -> Result<GearPair, Failure> {
    let specification = |side: Side| -> Result<Specification, Failure> {
        let name = side.name();
        let row = gears.texts("gear").iter().position(|gear| gear == name);
        let row = row.ok_or_else(|| Failure::new(format!("the geometry has no row for the {name}")))?;
        let value = |column: &str| si(gears, column, row);
        let teeth = u32::try_from(gears.integers("teeth")[row])
            .map_err(|_| Failure::new("the number of teeth is out of range"))?;
        Ok(Specification {
            teeth,
            module: value("module"),
            pressure_angle: value("pressure_angle"),
            profile_shift: value("profile_shift"),
            rack: Rack {
                addendum: value("rack_addendum"),
                dedendum: value("rack_dedendum"),
                tip_radius: value("rack_tip_radius"),
            },
            tip_radius: Some(value("tip_radius")),
            face_width: value("face_width"),
            bore_radius: value("bore_radius"),
            material: Material { youngs_modulus: value("youngs_modulus"), poisson_ratio: value("poisson_ratio") },
        })
    };
    let distance = si(pair, "centre_distance", 0);
    GearPair::new(specification(Side::Pinion)?, specification(Side::Gear)?, Some(distance))
        .map_err(|error| Failure::new(error.to_string()))
}

/// A cell of a column of numbers in SI.
#[must_use]
pub fn si(table: &Table, column: &str, row: usize) -> f64 {
    let value = table.floats(column)[row];
    let unit = table.schema().column(column).map_or("", |column| column.unit.as_str());
    if unit.is_empty() {
        return value;
    }
    // Units of columns are literals that a test reads; the fallback keeps a damaged file from being a panic.
    let Ok(unit) = parse_unit(unit) else { return f64::NAN };
    let power = 10f64.powi(unit.ten.abs());
    (if unit.ten < 0 { value / power } else { value * power }) * unit.factor
}
