//! The table `validity`: how far each gear is from what it must not be; and what is to be said where it is that.
//!
//! Must not know: how any of it is computed.

use super::drawn::{Drawn, gear_column};
use declare::units::in_unit;
use gearmesh::gear::geometry::GearPair;
use gearmesh::gear::geometry::validity::{Mating, Validity};
use studygraph::table::data::Row;
use studygraph::table::schema::{Column, Schema};

/// With the columns of a pair, or of a gear alone.
#[must_use]
pub fn schema(paired: bool) -> Schema {
    let mut columns = vec![
        gear_column(),
        Column::integer("teeth", "Number of teeth z."),
        Column::float("profile_shift", "", "Profile shift coefficient x."),
        Column::float(
            "least_shift_sharp",
            "",
            "x_min = h_a*(z_min − z)/z_min of a sharp rack whose straight flank is h_a* deep, z_min = 2 h_a*/sin² α (zhai2020, 23).",
        )
        .tolerance(1e-12, 1e-9),
        Column::float("least_shift", "", "x_min of this rack: below it the rack undercuts.").tolerance(1e-12, 1e-9),
        Column::flag("undercut", "Whether the rack cuts into the involute, whatever root is drawn."),
        Column::float("form_radius", "mm", "Where the flank begins in the profile as drawn."),
        Column::float("root_gap", "mm", "How far the bottom of the space as drawn lies above the root circle.")
            .tolerance(1e-9, 1e-9),
        Column::float("tip_thickness", "mm", "Arc thickness of the unmodified tooth at the tip."),
        Column::float("tip_thickness_in_modules", "", "The same, in modules; 0.2 to 0.4 are usual least values."),
        Column::float("apex_radius", "mm", "Where the flanks would meet in a point."),
    ];
    if paired {
        columns.extend([
            Column::float("active_radius", "mm", "Where the mate's tip reaches."),
            Column::float("contact_reserve", "deg", "Roll angle from the form radius to the active radius.")
                .tolerance(1e-9, 1e-9),
            Column::flag("interference", "Whether the mate's tip reaches below the flank."),
            Column::float(
                "root_distance",
                "um",
                "Least distance of the mate's tip, broken as drawn, from the root as drawn, on its whole way past it; negative where it cuts in.",
            )
            .tolerance(1e-6, 1e-9),
            Column::flag("root_interference", "Whether the mate's tip cuts into the root."),
            Column::float("clearance", "mm", "Between the root circle and the mate's tip."),
            Column::float(
                "missing_tip_shortening",
                "",
                "By how many modules the mate's tip is to be lower for the rack's own clearance; negative where there is more.",
            )
            .tolerance(1e-12, 1e-9),
            Column::float("contact_ratio", "", "Transverse contact ratio ε_α."),
        ]);
    }
    let description = "How far each gear is from what it must not be.";
    Schema::new("validity", description, columns).on_demand()
}

/// The row of a gear, with its mate if it has one.
#[must_use]
pub fn row(drawn: &Drawn, mate: Option<(&GearPair, Mating)>) -> Row {
    let gear = &drawn.gear;
    let module = gear.specification.module;
    let alone = Validity::new(gear, &drawn.outline);
    let mut row: Row = vec![
        drawn.side.name().into(),
        gear.specification.teeth.into(),
        gear.specification.profile_shift.into(),
        alone.least_shift_sharp.into(),
        alone.least_shift.into(),
        gear.undercut.into(),
        in_unit(alone.form_radius, "mm").into(),
        in_unit(alone.root_gap, "mm").into(),
        in_unit(alone.tip_thickness, "mm").into(),
        (alone.tip_thickness / module).into(),
        in_unit(alone.apex_radius, "mm").into(),
    ];
    if let Some((pair, mating)) = mate {
        row.extend([
            in_unit(mating.active_radius, "mm").into(),
            in_unit(mating.contact_reserve, "deg").into(),
            mating.interferes().into(),
            in_unit(mating.root_distance, "um").into(),
            mating.cuts_root(module).into(),
            in_unit(mating.clearance, "mm").into(),
            mating.missing_tip_shortening.into(),
            pair.contact_ratio.into(),
        ]);
    }
    row
}

/// What is to be said of a root that the mate does not pass.
#[must_use]
pub fn warnings(drawn: &Drawn, mating: &Mating) -> Vec<String> {
    let side = drawn.side.name();
    let mut said = Vec::new();
    if mating.interferes() {
        let form = drawn.gear.radius_at(drawn.outline.form_roll);
        let [reached, form] = [mating.active_radius, form].map(|radius| in_unit(radius, "mm"));
        said.push(format!(
            "{side}: the mate's tip reaches to a radius of {reached:.6} mm, but the flank as drawn begins at {form:.6} mm"
        ));
    }
    if mating.cuts_root(drawn.gear.specification.module) {
        let depth = in_unit(-mating.root_distance, "um");
        said.push(format!("{side}: the mate's tip cuts {depth:.3} um deep into the root as drawn"));
    }
    said
}
