//! The table `validity`: how far each gear is from what it must not be; and what is to be said where it is that.
//!
//! Must not know: how any of it is computed.

use super::drawn::{Drawn, of_gear};
use declare::units::in_unit;
use gearmesh::gear::geometry::validity::{Mating, Validity};
use gearmesh::gear::geometry::{GearPair, Side};
use studygraph::table::columns::Columns;

/// A gear, and how it meets its mate if it has one.
pub type Mated<'a> = (&'a Drawn, Option<(&'a GearPair, Mating)>);

/// A gear with what is known of it alone.
pub struct ValidRow<'a> {
    drawn: &'a Drawn,
    alone: Validity,
    mate: Option<(&'a GearPair, Mating)>,
}

impl<'a> ValidRow<'a> {
    #[must_use]
    pub fn new((drawn, mate): &Mated<'a>) -> Self {
        Self { drawn, alone: Validity::new(&drawn.gear, &drawn.outline), mate: *mate }
    }

    fn module(&self) -> f64 {
        self.drawn.gear.specification.module
    }

    /// NaN without a mate, whose columns are not there then.
    fn mating(&self, get: impl Fn(&Mating) -> f64) -> f64 {
        self.mate.as_ref().map_or(f64::NAN, |(_, mating)| get(mating))
    }

    fn fails(&self, test: impl Fn(&Mating) -> bool) -> bool {
        self.mate.as_ref().is_some_and(|(_, mating)| test(mating))
    }
}

/// With the columns of a pair, or of a gear alone.
#[must_use]
pub fn columns<'a>(paired: bool) -> Columns<ValidRow<'a>> {
    let sharp = "x_min = h_a*(z_min − z)/z_min of a sharp rack whose straight flank is h_a* deep, z_min = 2 h_a*/sin² \
                 α (zhai2020, 23).";
    let undercut = "Whether the tool cuts into the involute, whatever root is drawn.";
    let gap = "How far the bottom of the space as drawn lies above the root circle.";
    let in_modules = "The same, in modules; 0.2 to 0.4 are usual least values.";
    let columns =
        of_gear(Columns::new("validity", "How far each gear is from what it must not be."), |row: &ValidRow| {
            row.drawn.side
        })
        .integer("teeth", "Number of teeth z.", |row| row.drawn.gear.specification.teeth)
        .float("profile_shift", "", "Profile shift coefficient x.", |row| row.drawn.gear.specification.profile_shift)
        .float("least_shift_sharp", "", sharp, |row| row.alone.least_shift_sharp)
        .but(|column| column.tolerance(1e-12, 1e-9))
        .float(
            "least_shift",
            "",
            "x_Emin of this tool: with a generating profile shift below it the tool undercuts.",
            |row| row.alone.least_shift,
        )
        .but(|column| column.tolerance(1e-12, 1e-9))
        .flag("undercut", undercut, |row| row.drawn.gear.undercut)
        .float("form_radius", "mm", "Where the flank begins in the profile as drawn.", |row| row.alone.form_radius)
        .float("root_gap", "mm", gap, |row| row.alone.root_gap)
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("tip_thickness", "mm", "Arc thickness of the unmodified tooth at the tip.", |row| {
            row.alone.tip_thickness
        })
        .float("tip_thickness_in_modules", "", in_modules, |row| row.alone.tip_thickness / row.module())
        .float("apex_radius", "mm", "Where the flanks would meet in a point.", |row| row.alone.apex_radius)
        .on_demand();
    if paired { of_mate(columns) } else { columns }
}

fn of_mate(columns: Columns<ValidRow>) -> Columns<ValidRow> {
    let distance = "Least distance of the mate's tip, broken as drawn, from the root as drawn, on its whole way past \
                    it; negative where it cuts in.";
    let shortening = "By how many modules the mate's tip is to be lower for the clearance of the rack, of a shaped gear that of the depth to which it is cut; negative where \
                      there is more.";
    let reserve = "Roll angle from the form radius to where the mate's tip would reach on an involute.";
    let clearance = "Between the root circle and the mate's tip.";
    columns
        .float(
            "active_radius",
            "mm",
            "Down to where the flank works: where the mate's tip reaches, or the form circle.",
            |row| row.mating(|mating| mating.active_radius),
        )
        .float("contact_reserve", "deg", reserve, |row| row.mating(|mating| mating.contact_reserve))
        .but(|column| column.tolerance(1e-9, 1e-9))
        .flag("interference", "Whether the mate's tip reaches below the flank.", |row| row.fails(Mating::interferes))
        .float("root_distance", "um", distance, |row| row.mating(|mating| mating.root_distance))
        .but(|column| column.tolerance(1e-6, 1e-9))
        .flag("root_interference", "Whether the mate's tip cuts into the root.", |row| {
            row.fails(|mating| mating.cuts_root(row.module()))
        })
        .float("clearance", "mm", clearance, |row| row.mating(|mating| mating.clearance))
        .float("missing_tip_shortening", "", shortening, |row| row.mating(|mating| mating.missing_tip_shortening))
        .but(|column| column.tolerance(1e-12, 1e-9))
        .float("contact_ratio", "", "Transverse contact ratio ε_α.", |row| {
            row.mate.map_or(f64::NAN, |(pair, _)| pair.contact_ratio)
        })
}

/// What is to be said of a pair whose contact ends at a form circle.
pub fn curtailed(pair: &GearPair) -> impl Iterator<Item = String> + '_ {
    let sides = [Side::Pinion, Side::Gear].into_iter().filter(|side| pair.is_curtailed(*side));
    sides.map(|side| {
        let gear = pair.side(side);
        let lost = gear.base_radius * (gear.form_roll - pair.reached_roll(side));
        let [form, lost] = [gear.form_radius, lost].map(|length| in_unit(length, "mm"));
        let why = if gear.undercut { "where its undercut ends" } else { "where its root begins" };
        format!(
            "{}: contact ends at its root form circle (radius {form:.6} mm), {why}: {lost:.3} mm of the path that the mate's tip \
             allows are lost, and the contact ratio is {:.4}",
            side.name(),
            pair.contact_ratio
        )
    })
}

/// What is to be said of a root that the mate does not pass.
#[must_use]
pub fn warnings(drawn: &Drawn, mating: &Mating) -> Vec<String> {
    let side = drawn.side.name();
    let mut said = Vec::new();
    let form = drawn.gear.radius_at(drawn.outline.form_roll);
    // Where contact ends at the form circle it does not reach below a flank that is drawn from there.
    if mating.interferes() && mating.active_radius < form * (1.0 - 1e-12) {
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
