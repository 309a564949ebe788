//! Friction of a stage of the kind `ste`: what a study states of it, columns of its summary and its curve, the table `friction`.
//!
//! Must not know: how any coefficient is found.

use super::rows::{Keyed, Load, Lost, PointRow, keyed};
use super::{Named, Ste};
use crate::stage::{Context, Demand, names};
use declare::Declared;
use declare::error::{Diagnostic, Failure};
use declare::number::significant;
use declare::record::Record;
use declare::units::ANGULAR_SPEED;
use gearmesh::gear::contact::CornerContact;
use gearmesh::gear::friction::{Law, Limit};
use gearmesh::gear::mesh::answers::friction::Place;
use gearmesh::gear::mesh::cycle::flank_friction;
use gearmesh::gear::mesh::{Loaded, Mesh};
use gearmesh::gear::modification::Design;
use rayon::prelude::*;
use studygraph::table::columns::Columns;
use studygraph::table::data::Table;
use studygraph::table::schema::Column;
use studygraph::warning::{Cases, Warning};

/// The table along the path of contact.
pub const TABLE: &str = "friction";

/// Friction of the flanks.
#[derive(Debug, Declared)]
pub struct Friction {
    /// Where the coefficient of friction comes from.
    pub law: Box<dyn Law>,
    /// Speed of the pinion.
    #[declared(minimum = 1e-6, maximum = 1e6, dimension = ANGULAR_SPEED, example = "1500 rpm")]
    pub speed: f64,
    /// Whether friction takes part when the pairs share the load.
    #[declared(default = "false")]
    pub in_load_balance: bool,
    /// Positions per base pitch in the table `friction`.
    #[declared(minimum = 1, maximum = 100_000, default = "32")]
    pub positions: usize,
}

impl Friction {
    pub fn of(&self) -> flank_friction::Friction<'_> {
        flank_friction::Friction { law: &*self.law, speed: self.speed }
    }
}

/// Columns of the summary.
const OF_SUMMARY: [&str; 6] = [
    MEAN_COEFFICIENT,
    "tooth_loss_factor",
    "geometric_tooth_loss_factor",
    "friction_power_loss",
    "efficiency",
    "gear_torque",
];
/// The first of them, of which all others are known too.
pub const MEAN_COEFFICIENT: &str = "mean_friction_coefficient";
/// Columns of the curve.
const OF_CURVE: [&str; 2] = ["friction_power_loss", "gear_torque"];

impl Ste {
    /// A design under a torque, with friction in the balance where that is stated.
    pub fn loading<'a>(&'a self, cycle: &'a Mesh, design: &'a Design, torque: f64) -> Loaded<'a> {
        self.rubbed(cycle.loaded(design, torque))
    }

    /// The same with friction in the balance where that is stated.
    pub fn rubbed<'a>(&'a self, loading: Loaded<'a>) -> Loaded<'a> {
        match &self.friction {
            Some(friction) if friction.in_load_balance => loading.with_friction(friction.of()),
            _ => loading,
        }
    }

    /// Whether every equilibrium takes friction.
    pub fn is_resisted(&self) -> bool {
        self.friction.as_ref().is_some_and(|friction| friction.in_load_balance)
    }

    /// Refuses a balance that nothing is known for.
    pub fn check_friction(&self, record: &Record) -> Result<(), Diagnostic> {
        if !self.is_resisted() || self.contact.corner_contact == CornerContact::None {
            return Ok(());
        }
        let place = record.inside(Self::NAMES.friction).place_of(Friction::NAMES.in_load_balance);
        Err(Diagnostic::new(
            "`in_load_balance` is for `corner_contact: none`: friction at the corner of a tip is not in the balance",
        )
        .at(place)
        .help("leave one of them out; what is lost is known with both"))
    }

    /// What is lost over the cycle, where that is wanted, or where a warning may be due.
    pub fn lost(&self, loading: &Loaded, wanted: bool) -> Option<Lost> {
        let friction = self.friction.as_ref().filter(|friction| wanted || friction.in_load_balance)?;
        let geometric = loading.mesh().pair.tooth_loss_factor().unwrap_or(f64::NAN);
        Some(Lost { loss: loading.friction_loss(friction.of()), geometric })
    }

    /// The table along the path of contact, where it is wanted.
    pub fn along_path(
        &self,
        context: &Context,
        base: &Mesh,
        tasks: &[(&Named, f64)],
    ) -> Result<Option<Table>, Failure> {
        let Some(of) = self.friction.as_ref().filter(|_| context.demand.table(TABLE)) else { return Ok(None) };
        let places: Vec<Vec<PlaceRow>> = tasks
            .par_iter()
            .map(|&((design, name, deviation), torque)| {
                context.check_stop()?;
                let load = Load { torque, deviation: *deviation };
                let places = self.loading(base, design, torque).friction_along(of.of(), of.positions);
                Ok(places.into_iter().map(|place| (name.as_str(), load, place)).collect())
            })
            .collect::<Result<_, Failure>>()?;
        let columns = along(&self.deviations.stated());
        let table = columns.table_of(&places.iter().flatten().copied());
        table.map(Some).map_err(|error| Failure::new(error.to_string()))
    }

    /// Says of which quantities a law knows less.
    pub fn warn_of_friction(&self, context: &Context, answers: &[Keyed]) {
        let Some(friction) = &self.friction else { return };
        for (design, Load { torque, .. }, answer) in answers {
            let beyond = answer.lost.as_ref().map_or(&[][..], |lost| &lost.loss.beyond);
            for limit in beyond {
                let Limit { quantity, value, range: [from, to], .. } = limit;
                let (bound, word, times) =
                    if value < from { (from, "from", from / value) } else { (to, "up to", value / to) };
                let [value, bound] = [value, bound].map(|value| {
                    let space = if limit.unit.is_empty() { "" } else { " " };
                    format!("{}{space}{}", significant(*value, 3), limit.unit)
                });
                let sentence = format!(
                    "design `{design}` at {torque} N m: {quantity} is {value}; the law `{}` of friction is known {word} {bound}",
                    friction.law.name(),
                );
                (context.warn)(Warning::Cases(Cases::one(quantity, design, (*torque, "N m"), (times, sentence))));
            }
        }
    }
}

fn column_is_wanted(demand: &Demand, table: &str, columns: &[&str]) -> bool {
    columns.iter().any(|name| demand.column(table, name))
}

/// Whether anything that is demanded takes what is lost over the cycle.
pub fn of_summary_is_wanted(demand: &Demand) -> bool {
    column_is_wanted(demand, names::summary::TABLE, &OF_SUMMARY)
}

/// Whether anything that is demanded takes what is lost at every position of a curve.
pub fn of_curve_is_wanted(demand: &Demand) -> bool {
    column_is_wanted(demand, names::curve::TABLE, &OF_CURVE)
}

/// Coefficient, loss factors, what is lost and what is left.
pub fn of_summary(columns: Columns<Keyed<'_>>) -> Columns<Keyed<'_>> {
    let of = |get: fn(&Lost) -> f64| move |row: &Keyed| row.2.lost.as_ref().map_or(f64::NAN, get);
    let [coefficient, local, geometric, power, efficiency, torque] = OF_SUMMARY;
    let about_coefficient =
        "Mean coefficient of friction μ_m over load and sliding: P_VZP/(P_A H_VL); NaN without load.";
    let about_local = "Loss factor H_VL by the loads of the pairs; NaN without load.";
    let about_geometric = "Loss factor H_V of halves of the load in double contact (Ohlendorf); NaN where the pitch point is not in \
                           single contact.";
    let on_demand = |column: Column| column.on_demand().allows_nan().tolerance(1e-12, 1e-9);
    columns
        .float(coefficient, "", about_coefficient, of(|lost| lost.loss.mean_coefficient))
        .but(on_demand)
        .float(local, "", about_local, of(|lost| lost.loss.tooth_loss_factor))
        .but(on_demand)
        .float(geometric, "", about_geometric, of(|lost| lost.geometric))
        .but(on_demand)
        .float(
            power,
            "W",
            "Power P_VZP that friction of the flanks takes, mean over the mesh cycle.",
            of(|lost| lost.loss.power),
        )
        .but(on_demand)
        .float(
            efficiency,
            "",
            "Share of the pinion's power that is left: 1 − P_VZP/P_A; NaN without load.",
            of(|lost| lost.loss.efficiency),
        )
        .but(on_demand)
        .float(
            torque,
            "N m",
            "Torque that the gear is left with, mean over the mesh cycle.",
            of(|lost| lost.loss.gear_torque),
        )
        .but(on_demand)
}

/// The same along the curve.
pub fn of_curve(columns: Columns<PointRow<'_>>) -> Columns<PointRow<'_>> {
    let of = |index: usize| move |row: &PointRow| row.2.left.map_or(f64::NAN, |left| left[index]);
    let [power, torque] = OF_CURVE;
    columns
        .float(power, "W", "Power that friction of the flanks takes at this position.", of(0))
        .but(|column| column.on_demand().tolerance(1e-9, 1e-9))
        .float(torque, "N m", "Torque that the gear is left with at this position.", of(1))
        .but(Column::on_demand)
}

/// A place of the path of contact.
pub type PlaceRow<'a> = Keyed<'a, Place>;

/// The table along the path of contact.
pub fn along<'a>(stated: &[usize]) -> Columns<PlaceRow<'a>> {
    let step = "Counts the positions of the pair: from 0 in A, so many in a base pitch; below 0 before A.";
    let sliding = "Sliding speed v_g: positive beyond the pitch point, where the pinion's flank is the faster one.";
    let coefficient = "Coefficient of friction μ; 0 without load, and of a local law at the pitch point itself.";
    keyed(TABLE, "Sliding and friction of a pair along the path of contact, on a regular grid.", stated)
        .integer("step", step, |row: &PlaceRow| row.2.step)
        .key()
        .float("path_position", "mm", "Distance of the pair from A along the line of action.", |row| {
            row.2.path_position
        })
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("roll_angle", "deg", "The pinion's roll angle where the pair touches.", |row| row.2.roll_angle)
        .float("normal_force", "N", "Normal force of the pair.", |row| row.2.rubbing.load)
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("sliding_speed", "m/s", sliding, |row| row.2.rubbing.rolling.sliding())
        .but(|column| column.tolerance(1e-12, 1e-9))
        .float("slide_to_roll_ratio", "", "Sliding speed over the mean speed of both flanks, without sign.", |row| {
            row.2.rubbing.rolling.slide_to_roll()
        })
        .but(|column| column.tolerance(1e-12, 1e-9))
        .float("friction_coefficient", "", coefficient, |row| row.2.rubbing.coefficient)
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("friction_force", "N", "Friction force μ F of the pair.", |row| row.2.rubbing.force())
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("friction_power_loss", "W", "Power μ F v_g that this pair loses.", |row| row.2.rubbing.power())
        .but(|column| column.tolerance(1e-9, 1e-9))
        .on_demand()
}
