//! Gear pairs as tables: what the geometry stage writes and every stage downstream reads a pair back from.
//!
//! A pair is rebuilt from its specification columns by the same constructor that made it; the derived columns are there
//! for readers. Must not know: which stage asks.

use super::names;
use crate::stage::{Inputs, Port};
use declare::error::Failure;
use declare::units::parse_unit;
use gearmesh::gear::geometry::outline::tip::Tip;
use gearmesh::gear::geometry::pinion_cutter::PinionCutter;
use gearmesh::gear::geometry::{Gear, GearPair, Rack, Side, Specification};
use gearmesh::gear::material::Material;
use studygraph::table::columns::Columns;
use studygraph::table::data::Table;

/// Which gear, and what it is.
pub type GearRow<'a> = (Side, &'a Gear);

/// One row per gear.
#[must_use]
pub fn gears<'a>() -> Columns<GearRow<'a>> {
    let allowance = "By how much the teeth are thicker on the reference circle than x says A_s; below 0 for backlash.";
    let form_radius = "Radius at which the root curve meets the involute.";
    Columns::new(names::gears::TABLE, "Each gear: what was specified, and what follows from it.")
        .text(names::gears::GEAR, "Which gear: pinion or gear.", |row: &GearRow| row.0.name())
        .key()
        .integer(names::gears::TEETH, "Number of teeth z.", |row| row.1.specification.teeth)
        .float(names::gears::MODULE, "mm", "Module m.", |row| row.1.specification.module)
        .float(names::gears::PRESSURE_ANGLE, "deg", "Pressure angle α.", |row| row.1.specification.pressure_angle)
        .float(names::gears::PROFILE_SHIFT, "", "Profile shift coefficient x.", |row| row.1.specification.profile_shift)
        .float(names::gears::THICKNESS_ALLOWANCE, "um", allowance, |row| row.1.specification.thickness_allowance)
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("generating_profile_shift", "", "Generating profile shift coefficient x_E.", |row| {
            row.1.specification.generating_profile_shift()
        })
        .float(names::gears::RACK_ADDENDUM, "", "Addendum of the basic rack h_aP*, in modules.", |row| {
            row.1.specification.rack.addendum
        })
        .float(names::gears::RACK_DEDENDUM, "", "Dedendum of the basic rack h_fP*, in modules.", |row| {
            row.1.specification.rack.dedendum
        })
        .float(names::gears::RACK_TIP_RADIUS, "", "Tip radius of the cutting rack ρ_fP*, in modules.", |row| {
            row.1.specification.rack.tip_radius
        })
        .float(names::gears::PROTUBERANCE, "", "Protuberance of the cutting rack pr*, in modules.", |row| {
            row.1.specification.rack.protuberance
        })
        .float(names::gears::PROTUBERANCE_ANGLE, "deg", "Angle of the protuberance's straight side α_prP.", |row| {
            row.1.specification.rack.protuberance_angle
        })
        .float(names::gears::MACHINING_ALLOWANCE, "", "Machining allowance on each flank q*, in modules.", |row| {
            row.1.specification.rack.machining_allowance
        })
        .float(names::gears::NOTCH_RADIUS, "", "Radius of a grinding notch in the root ρ_g*, in modules.", |row| {
            row.1.specification.rack.notch_radius
        })
        .integer(names::gears::CUTTER_TEETH, "Teeth of the pinion-type cutter z_0; 0 where a rack cuts.", |row| {
            row.1.specification.cutter.map_or(0, |cutter| cutter.teeth)
        })
        .float(names::gears::CUTTER_PROFILE_SHIFT, "", "Profile shift coefficient of the cutter x_0.", |row| {
            row.1.specification.cutter.map_or(0.0, |cutter| cutter.profile_shift)
        })
        .float(names::gears::CUTTER_ADDENDUM, "", "Addendum of the cutter h_aP0*, in modules.", |row| {
            row.1.specification.cutter.map_or(0.0, |cutter| cutter.addendum)
        })
        .float(names::gears::CUTTER_TIP_RADIUS, "", "Radius of the cutter's tip rounding ρ_aP0*, in modules.", |row| {
            row.1.specification.cutter.map_or(0.0, |cutter| cutter.tip_radius)
        })
        .float(names::gears::FACE_WIDTH, "mm", "Face width b.", |row| row.1.specification.face_width)
        .float(names::gears::BORE_RADIUS, "mm", "Radius of the bore, where the body is clamped.", |row| {
            row.1.specification.bore_radius
        })
        .float(names::gears::YOUNGS_MODULUS, "GPa", "Young's modulus E.", |row| {
            row.1.specification.material.youngs_modulus
        })
        .float(names::gears::POISSON_RATIO, "", "Poisson's ratio ν.", |row| row.1.specification.material.poisson_ratio)
        .float(names::gears::DENSITY, "kg/m^3", "Density ρ.", |row| row.1.specification.material.density)
        .float(names::gears::TIP_CHAMFER, "mm", "Size of the chamfer at the tip; 0 without one.", |row| {
            if let Tip::Chamfer(size) = row.1.tip { size } else { 0.0 }
        })
        .float(names::gears::TIP_ROUNDING, "mm", "Radius of the rounding at the tip; 0 without one.", |row| {
            if let Tip::Rounding(radius) = row.1.tip { radius } else { 0.0 }
        })
        .float(names::gears::TIP_RAMP_ANGLE, "deg", "Angle α_KP of a semi-topping tool's ramp; 0 without one.", |row| {
            if let Tip::SemiTopping { angle, .. } = row.1.tip { angle } else { 0.0 }
        })
        .float(
            names::gears::TIP_RAMP_HEIGHT,
            "mm",
            "How far below the rack's addendum line the ramp begins h_K.",
            |row| {
                if let Tip::SemiTopping { height, .. } = row.1.tip { height } else { 0.0 }
            },
        )
        .float("reference_radius", "mm", "Reference radius r.", |row| row.1.reference_radius)
        .float("base_radius", "mm", "Base radius r_b.", |row| row.1.base_radius)
        .float(names::gears::TIP_RADIUS, "mm", "Tip radius r_a.", |row| row.1.tip_radius)
        .float("tip_form_radius", "mm", "Radius at which the flank ends towards the tip r_Fa.", |row| {
            row.1.radius_at(row.1.flank_end.roll)
        })
        .float("root_radius", "mm", "Root radius r_f.", |row| row.1.root_radius)
        .float("form_radius", "mm", form_radius, |row| row.1.form_radius)
        .float("tip_thickness", "mm", "Arc thickness of the tooth at the tip.", |row| row.1.tip_thickness())
}

/// One row.
#[must_use]
pub fn pair<'a>() -> Columns<&'a GearPair> {
    let description = "The pair on its centre distance. Path positions count from the pinion's tangent point T1.";
    Columns::new(names::pair::TABLE, description)
        .float(names::pair::CENTRE_DISTANCE, "mm", "Centre distance a_w.", |pair: &&GearPair| pair.centre_distance)
        .float("working_pressure_angle", "deg", "Working pressure angle α_w.", |pair| pair.working_pressure_angle)
        .float("base_pitch", "mm", "Base pitch p_b.", |pair| pair.base_pitch)
        .float("contact_ratio", "", "Transverse contact ratio ε_α.", |pair| pair.contact_ratio)
        .float("tangent_length", "mm", "Length T1T2 of the common tangent, L.", |pair| pair.tangent_length)
        .float("start_of_contact", "mm", "Path position of A, the start of contact.", |pair| pair.start_of_contact)
        .float("end_of_contact", "mm", "Path position of E, the end of contact.", |pair| pair.end_of_contact)
        .float("pinion_tip_usable_radius", "mm", "Tip usable radius r_Na1 of the pinion.", |pair| {
            pair.pinion.radius_at(pair.highest_roll(Side::Pinion))
        })
        .float("pinion_root_usable_radius", "mm", "Root usable radius r_Nf1 of the pinion.", |pair| {
            pair.pinion.radius_at(pair.lowest_roll(Side::Pinion))
        })
        .float("gear_tip_usable_radius", "mm", "Tip usable radius r_Na2 of the gear.", |pair| {
            pair.gear.radius_at(pair.highest_roll(Side::Gear))
        })
        .float("gear_root_usable_radius", "mm", "Root usable radius r_Nf2 of the gear.", |pair| {
            pair.gear.radius_at(pair.lowest_roll(Side::Gear))
        })
}

/// The port through which [`of`] reads.
#[must_use]
pub fn port(stage: &str) -> Port {
    Port::tables(names::PAIR_PORT, stage, &[names::gears::TABLE, names::pair::TABLE])
}

/// The pair that came in.
///
/// # Errors
/// When its tables did not, or are not from a valid pair.
pub fn of(inputs: &Inputs) -> Result<GearPair, Failure> {
    let table = |table| inputs.table(names::PAIR_PORT, table);
    read(table(names::gears::TABLE)?, table(names::pair::TABLE)?)
}

/// The pair that the tables [`gears`] and [`pair`] hold.
///
/// # Errors
/// When the tables are not from a valid pair.
pub fn read(gears: &Table, pair: &Table) -> Result<GearPair, Failure> {
    let specification = |side: Side| -> Result<Specification, Failure> {
        let row = row(gears, side)?;
        let value = |column: &str| si(gears, column, row);
        let whole = |column: &str| {
            let found = u32::try_from(gears.integers(column)[row]);
            found.map_err(|_| Failure::new(format!("`{column}` is out of range")))
        };
        let (teeth, cutter_teeth) = (whole(names::gears::TEETH)?, whole(names::gears::CUTTER_TEETH)?);
        Ok(Specification {
            teeth,
            module: value(names::gears::MODULE),
            pressure_angle: value(names::gears::PRESSURE_ANGLE),
            profile_shift: value(names::gears::PROFILE_SHIFT),
            thickness_allowance: value(names::gears::THICKNESS_ALLOWANCE),
            rack: Rack {
                addendum: value(names::gears::RACK_ADDENDUM),
                dedendum: value(names::gears::RACK_DEDENDUM),
                tip_radius: value(names::gears::RACK_TIP_RADIUS),
                protuberance: value(names::gears::PROTUBERANCE),
                protuberance_angle: value(names::gears::PROTUBERANCE_ANGLE),
                machining_allowance: value(names::gears::MACHINING_ALLOWANCE),
                notch_radius: value(names::gears::NOTCH_RADIUS),
            },
            cutter: (cutter_teeth > 0).then(|| PinionCutter {
                teeth: cutter_teeth,
                profile_shift: value(names::gears::CUTTER_PROFILE_SHIFT),
                addendum: value(names::gears::CUTTER_ADDENDUM),
                tip_radius: value(names::gears::CUTTER_TIP_RADIUS),
            }),
            tip_radius: Some(value(names::gears::TIP_RADIUS)),
            face_width: value(names::gears::FACE_WIDTH),
            bore_radius: value(names::gears::BORE_RADIUS),
            material: Material {
                youngs_modulus: value(names::gears::YOUNGS_MODULUS),
                poisson_ratio: value(names::gears::POISSON_RATIO),
                density: value(names::gears::DENSITY),
            },
        })
    };
    let tip = |side: Side| {
        let row = row(gears, side)?;
        let [chamfer, rounding, angle, height] = [
            names::gears::TIP_CHAMFER,
            names::gears::TIP_ROUNDING,
            names::gears::TIP_RAMP_ANGLE,
            names::gears::TIP_RAMP_HEIGHT,
        ]
        .map(|column| si(gears, column, row));
        if angle > 0.0 {
            return Ok(Tip::SemiTopping { angle, height });
        }
        Ok::<_, Failure>(match (chamfer > 0.0, rounding > 0.0) {
            (false, false) => Tip::Land,
            (true, _) => Tip::Chamfer(chamfer),
            (false, true) => Tip::Rounding(rounding),
        })
    };
    let distance = si(pair, names::pair::CENTRE_DISTANCE, 0);
    let specifications = [specification(Side::Pinion)?, specification(Side::Gear)?];
    GearPair::with_tips(specifications, [tip(Side::Pinion)?, tip(Side::Gear)?], Some(distance))
        .map_err(|error| Failure::new(error.to_string()))
}

fn row(gears: &Table, side: Side) -> Result<usize, Failure> {
    let name = side.name();
    let row = gears.texts(names::gears::GEAR).iter().position(|gear| gear == name);
    row.ok_or_else(|| Failure::new(format!("the geometry has no row for the {name}")))
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
