//! Gear pairs as tables: what the geometry stage writes and every stage downstream reads a pair back from.
//!
//! A pair is rebuilt from its specification columns by the same constructor that made it; the derived columns are there
//! for readers. Must not know: which stage asks.

use declare::error::Failure;
use declare::units::{in_unit, parse_unit};
use gearmesh::gear::geometry::{Gear, GearPair, Rack, Side, Specification};
use gearmesh::gear::material::Material;
use studygraph::table::data::{Row, Table, TableError};
use studygraph::table::schema::{Column, Schema};

/// One row per gear.
#[must_use]
pub fn gears_schema() -> Schema {
    let mut columns =
        vec![Column::text("gear", "Which gear: pinion or gear.").key(), Column::integer("teeth", "Number of teeth z.")];
    columns.extend(SPECIFIED.iter().map(|(name, unit, description, _)| Column::float(name, unit, description)));
    columns.extend(DERIVED.iter().map(|(name, unit, description, _)| Column::float(name, unit, description)));
    Schema::new("gears", "Each gear: what was specified, and what follows from it.", columns)
}

/// One row.
#[must_use]
pub fn pair_schema() -> Schema {
    let columns = PAIR.iter().map(|(name, unit, description, _)| Column::float(name, unit, description)).collect();
    Schema::new(
        "pair",
        "The pair on its centre distance. Path positions count from the pinion's tangent point T1.",
        columns,
    )
}

type Getter<T> = fn(&T) -> f64;

const SPECIFIED: &[(&str, &str, &str, Getter<Specification>)] = &[
    ("module", "mm", "Module m.", |gear| gear.module),
    ("pressure_angle", "deg", "Pressure angle α.", |gear| gear.pressure_angle),
    ("profile_shift", "", "Profile shift coefficient x.", |gear| gear.profile_shift),
    ("rack_addendum", "", "Addendum of the basic rack h_aP*, in modules.", |gear| gear.rack.addendum),
    ("rack_dedendum", "", "Dedendum of the basic rack h_fP*, in modules.", |gear| gear.rack.dedendum),
    ("rack_tip_radius", "", "Tip radius of the cutting rack ρ_fP*, in modules.", |gear| gear.rack.tip_radius),
    ("face_width", "mm", "Face width b.", |gear| gear.face_width),
    ("bore_radius", "mm", "Radius of the bore, where the body is clamped.", |gear| gear.bore_radius),
    ("youngs_modulus", "GPa", "Young's modulus E.", |gear| gear.material.youngs_modulus),
    ("poisson_ratio", "", "Poisson's ratio ν.", |gear| gear.material.poisson_ratio),
];

const DERIVED: &[(&str, &str, &str, Getter<Gear>)] = &[
    ("reference_radius", "mm", "Reference radius r.", |gear| gear.reference_radius),
    ("base_radius", "mm", "Base radius r_b.", |gear| gear.base_radius),
    ("tip_radius", "mm", "Tip radius r_a.", |gear| gear.tip_radius),
    ("root_radius", "mm", "Root radius r_f.", |gear| gear.root_radius),
    ("form_radius", "mm", "Radius at which the root curve meets the involute.", |gear| gear.form_radius),
    ("tip_thickness", "mm", "Arc thickness of the tooth at the tip.", Gear::tip_thickness),
];

const PAIR: &[(&str, &str, &str, Getter<GearPair>)] = &[
    ("centre_distance", "mm", "Centre distance a_w.", |pair| pair.centre_distance),
    ("working_pressure_angle", "deg", "Working pressure angle α_w.", |pair| pair.working_pressure_angle),
    ("base_pitch", "mm", "Base pitch p_b.", |pair| pair.base_pitch),
    ("contact_ratio", "", "Transverse contact ratio ε_α.", |pair| pair.contact_ratio),
    ("tangent_length", "mm", "Length T1T2 of the common tangent, L.", |pair| pair.tangent_length),
    ("start_of_contact", "mm", "Path position of A, the start of contact.", |pair| pair.start_of_contact),
    ("end_of_contact", "mm", "Path position of E, the end of contact.", |pair| pair.end_of_contact),
];

/// The table of gears.
///
/// # Errors
/// When a value is not finite, which a valid gear excludes.
pub fn write_gears(gears: &[(Side, &Gear)]) -> Result<Table, TableError> {
    let row = |(side, gear): &(Side, &Gear)| -> Row {
        let mut row: Row = vec![side.name().into(), gear.specification.teeth.into()];
        row.extend(SPECIFIED.iter().map(|(_, unit, _, get)| in_unit(get(&gear.specification), unit).into()));
        row.extend(DERIVED.iter().map(|(_, unit, _, get)| in_unit(get(gear), unit).into()));
        row
    };
    Table::from_rows(gears_schema(), gears.iter().map(row).collect())
}

/// The table of the pair.
///
/// # Errors
/// When a value is not finite, which a valid pair excludes.
pub fn write_pair(pair: &GearPair) -> Result<Table, TableError> {
    let values: Row = PAIR.iter().map(|(_, unit, _, get)| in_unit(get(pair), unit).into()).collect();
    Table::from_rows(pair_schema(), vec![values])
}

/// The pair that [`write_gears`] and [`write_pair`] wrote.
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
