//! `kind: rating`: a pair after ISO 6336-1, -2 and -3, method B: every factor, stresses, safety against given strengths.
//!
//! What finite elements and resolved contact find under the same torques stands beside it, where a stage of transmission
//! errors is named. Must not know: any formula.

mod tables;

use self::tables::{Beside, GearRow, PairRow, gears, summary};
use crate::stage::{Ahead, Context, Demand, Estimate, Inputs, KeysOf, Kind, Port, RowCount, Stage, names, pair};
use declare::Declared;
use declare::declared::{Declared, Placed};
use declare::error::{Diagnostic, Failure, Faults};
use declare::record::Record;
use declare::units::{ANGULAR_SPEED, TORQUE, in_unit};
use gearmesh::gear::geometry::{GearPair, Side};
use gearmesh::gear::rating::conditions::Conditions;
use gearmesh::gear::rating::dynamic::Range;
use gearmesh::gear::rating::{Rating, life, rate};
use studygraph::stage::Want;
use studygraph::table::data::{Cell, Table, TableError};
use studygraph::table::schema::Schema;

pub const KIND: Kind = Kind {
    name: "rating",
    version: 1,
    summary: Stated::MEMBER.summary,
    fields: Stated::MEMBER.fields,
    curves: &[],
    example: "
kind: rating
pair: geometry
torque: 100 N m
speed: 1500 rpm
application_factor: 1.25
base_pitch_deviation: 7 um
profile_form_deviation: 8 um
equivalent_misalignment: 12 um
viscosity: 220 mm^2/s
pinion:
  material: case_hardened_steel
  contact_strength: 1500 MPa
  bending_strength: 430 MPa
  cycles: 1e9
  flank_roughness: 4 um
  root_roughness: 16 um
gear:
  material: through_hardened_steel
  contact_strength: 700 MPa
  bending_strength: 280 MPa
  yield_strength: 600 MPa
  hardness: 230
  cycles: 4e8
  flank_roughness: 6 um
  root_roughness: 20 um
  rim_thickness: 15 mm
  web_thickness: 9 mm
",
    build,
};

/// A pair rated against pitting and tooth breakage after ISO 6336, method B, with every factor.
#[derive(Debug, Declared)]
struct Stated {
    /// The pair.
    #[declared(kinds = ["geometry"])]
    pub pair: String,
    /// Nominal torque on the pinion.
    #[declared(minimum = 1e-9, maximum = 1e9, dimension = TORQUE, axis = usize::MAX, example = "100 N m")]
    pub torque: Vec<f64>,
    /// Speed of the pinion.
    #[declared(minimum = 1e-6, maximum = 1e6, dimension = ANGULAR_SPEED, example = "1500 rpm")]
    pub speed: f64,
    #[declared(flatten)]
    pub conditions: Conditions,
    /// Who finds root stress and pressure under the same torques, to stand beside the standard's.
    #[declared(kinds = ["ste"])]
    pub ste: Option<String>,
    /// Which of its designs; the largest of all when it is not said.
    #[declared(example = "optimum")]
    pub design: Option<Placed<String>>,
}

/// Ports through which the stage of transmission errors is read: each for columns that take something of their own.
const PRESSURE: &str = "pressure";
const ROOT_STRESS: &str = "root_stress";

fn build(record: &Record) -> Result<Box<dyn Stage>, Faults> {
    let stated = Stated::checked(record)?;
    if let (Some(design), None) = (&stated.design, &stated.ste) {
        let message = "`design` needs `ste`: it is one of the designs of that stage";
        return Err(Diagnostic::new(message).at(design.place).into());
    }
    Ok(Box::new(stated))
}

impl Stated {
    fn port(
        &self,
        name: &'static str,
        columns: &[&str],
        only_for: &'static [(&'static str, &'static str)],
    ) -> Option<Port> {
        let columns = columns.iter().map(|column| (*column).to_owned()).collect();
        let want = Want { table: names::summary::TABLE.to_owned(), columns };
        let port = Port { wants: vec![want], ..Port::tables(name, self.ste.as_ref()?, &[]) };
        Some(port.only_for(only_for))
    }

    /// The largest value of a column of the stage beside it, under one torque, over the design that is asked for or all.
    fn largest(&self, inputs: &Inputs, port: &str, column: &str, torque: f64) -> Result<f64, Failure> {
        let table = inputs.table(port, names::summary::TABLE)?;
        let wanted = in_unit(torque, "N m");
        let design = self.design.as_ref().map(|design| &design.value);
        let (torques, designs) = (table.floats(names::summary::TORQUE), table.texts(names::summary::DESIGN));
        let same = |row: &usize| {
            (torques[*row] - wanted).abs() <= 1e-12 * wanted && design.is_none_or(|design| designs[*row] == *design)
        };
        let found = (0..table.rows()).filter(same).map(|row| pair::si(table, column, row));
        found.reduce(f64::max).ok_or_else(|| {
            let of = design.map_or(String::new(), |design| format!(" of the design `{design}`"));
            let stage = self.ste.as_deref().unwrap_or_default();
            Failure::new(format!("`{stage}` has no curve{of} at {wanted} N m, of which `{column}` is to stand here"))
        })
    }

    fn beside(&self, context: &Context, inputs: &Inputs, torque: f64) -> Result<Beside, Failure> {
        let mut beside = Beside::default();
        if context.demand.column(tables::SUMMARY, tables::LARGEST_PRESSURE) {
            beside.pressure = self.largest(inputs, PRESSURE, names::summary::LARGEST_PRESSURE, torque)?;
        }
        if context.demand.column(tables::GEARS, tables::LARGEST_ROOT_STRESS) {
            let columns = [names::summary::LARGEST_ROOT_STRESS_PINION, names::summary::LARGEST_ROOT_STRESS_GEAR];
            let [pinion, gear] = columns.map(|column| self.largest(inputs, ROOT_STRESS, column, torque));
            beside.root_stresses = [pinion?, gear?];
        }
        Ok(beside)
    }

    /// Of what the standard says to be careful with, under one torque.
    fn warn_of_speed(context: &Context, torque: f64, rating: &Rating) {
        let at = in_unit(torque, "N m");
        if let Some(range @ (Range::MainResonance | Range::Intermediate)) = rating.pair.range {
            (context.warn)(
                format!(
                    "at {at} N m the pair runs at {:.2} of its resonance speed, in the range `{}`: ISO 6336-1 asks for a \
                     dynamic calculation there, and K_V of method B can be far off",
                    rating.pair.resonance_ratio,
                    range.name()
                )
                .into(),
            );
        }
    }

    /// The same, under any.
    fn warn(&self, context: &Context, pair: &GearPair) {
        let given = &self.conditions;
        if pair.contact_ratio < 1.2 {
            (context.warn)(
                format!(
                    "ISO 6336-1 gives c_γα for contact ratios of 1.2 to 2.5 (below, it may be 10 % less); here it is {:.3}",
                    pair.contact_ratio
                )
                .into(),
            );
        }
        for (side, own) in [(Side::Pinion, &given.pinion), (Side::Gear, &given.gear)] {
            let knees = life::knees(own.material, given.pitting);
            let strengths = [own.contact_strength, own.bending_strength];
            let stated = [own.factors.life_factor_contact, own.factors.life_factor_root];
            for (at, what) in ["pitting", "tooth breakage"].into_iter().enumerate() {
                let short = own.cycles.is_some_and(|cycles| cycles < knees[at]);
                if short && strengths[at].is_some() && stated[at].is_none() {
                    (context.warn)(
                        format!(
                            "the {} has {:e} load cycles, fewer than the {:e} of long life against {what}: its life factor is \
                             that of a limited life, its other factors are those of long life",
                            side.name(),
                            own.cycles.unwrap_or_default(),
                            knees[at]
                        )
                        .into(),
                    );
                }
            }
        }
    }
}

impl Stage for Stated {
    fn inputs(&self) -> Vec<Port> {
        let pressure =
            self.port(PRESSURE, &[names::summary::LARGEST_PRESSURE], &[(tables::SUMMARY, tables::LARGEST_PRESSURE)]);
        let root = self.port(
            ROOT_STRESS,
            &[names::summary::LARGEST_ROOT_STRESS_PINION, names::summary::LARGEST_ROOT_STRESS_GEAR],
            &[(tables::GEARS, tables::LARGEST_ROOT_STRESS)],
        );
        [pair::port(&self.pair)].into_iter().chain(pressure).chain(root).collect()
    }

    fn outputs(&self) -> Vec<Schema> {
        let beside = self.ste.is_some();
        vec![summary(beside).schema(), gears(beside).schema()]
    }

    fn keys(&self, _table: &str, column: &str, _of: KeysOf) -> Option<Vec<Cell>> {
        match column {
            tables::TORQUE => Some(self.torque.iter().map(|torque| in_unit(*torque, "N m").into()).collect()),
            tables::GEAR => Some([Side::Pinion, Side::Gear].map(|side| side.name().into()).into()),
            _ => None,
        }
    }

    fn combines(&self, _table: &str) -> bool {
        true
    }

    fn estimate(&self, demand: &Demand, _ahead: &Ahead) -> Estimate {
        let torques = self.torque.len();
        let beside = self.ste.is_some();
        Estimate::new(false).rows(demand, summary(beside).schema(), RowCount::exact(torques)).rows(
            demand,
            gears(beside).schema(),
            RowCount::exact(2 * torques),
        )
    }

    fn run(&self, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let failed = |error: TableError| Failure::new(error.to_string());
        let pair = pair::of(inputs)?;
        self.warn(context, &pair);
        let (mut pairs, mut of_gears) = (Vec::new(), Vec::new());
        for &torque in &self.torque {
            let rating =
                rate(&pair, torque, self.speed, &self.conditions).map_err(|why| Failure::new(why.to_string()))?;
            Self::warn_of_speed(context, torque, &rating);
            let beside = self.beside(context, inputs, torque)?;
            for (at, side) in [Side::Pinion, Side::Gear].into_iter().enumerate() {
                let rated = &rating.gears[at];
                let (given, own) = match side {
                    Side::Pinion => (&self.conditions.pinion, &pair.pinion),
                    Side::Gear => (&self.conditions.gear, &pair.gear),
                };
                let is_pinion = rating.pair.pinion == side;
                let module = own.specification.module;
                let root_stress = beside.root_stresses[at];
                of_gears.push(GearRow::new(torque, side, is_pinion, module, given, *rated, root_stress));
            }
            let specific_load = rating.pair.tangential_load * self.conditions.application_factor / pair.contact_width();
            pairs.push(PairRow {
                torque,
                speed: self.speed,
                application_factor: self.conditions.application_factor,
                specific_load,
                normal_load: torque / pair.pinion.base_radius,
                working_pressure_angle: pair.working_pressure_angle,
                rated: rating.pair,
                pressure: beside.pressure,
            });
        }
        let stated = self.ste.is_some();
        let narrowed = |schema: Schema| context.demand.narrowed(schema);
        let mut tables = vec![
            summary(stated).only(&narrowed(summary(stated).schema())).table(&pairs).map_err(failed)?,
            gears(stated).only(&narrowed(gears(stated).schema())).table(&of_gears).map_err(failed)?,
        ];
        tables.retain(|table| context.demand.table(table.name()));
        Ok(tables)
    }
}
