//! `kind: hunting`: transmission error until the same teeth meet again, of gears with pitch deviations, and its order spectrum.
//!
//! Must not know: how equilibrium is found.

mod tables;

use self::tables::{Case, Found, Order, Row, curve, spectrum, summary};
use crate::stage::common::{Contact, Slices};
use crate::stage::names;
use crate::stage::{Ahead, Context, Curves, Demand, Estimate, Inputs, KeysOf, Kind, Omission, Port, RowCount, Stage};
use crate::stage::{common, designs};
use declare::Declared;
use declare::declared::Declared;
use declare::error::{Diagnostic, Failure, Faults};
use declare::record::Record;
use declare::units::{LENGTH, TORQUE, in_unit};
use declare::work::Work;
use gearmesh::gear::geometry::{GearPair, Side};
use gearmesh::gear::modification::{self, Design};
use gearmesh::gear::transmission_error::cycle::{MeshCycle, Settings};
use gearmesh::gear::transmission_error::hunting::{PitchDeviations, hunting_period};
use gearmesh::gear::transmission_error::load_case::LoadCase;
use gearmesh::gear::work::CONTACT_SOLVES;
use gearmesh::numeric::spectrum::amplitudes;
use rayon::prelude::*;
use studygraph::stage::steps::Steps;
use studygraph::table::data::{Cell, Table, TableError};
use studygraph::table::schema::Schema;

pub const KIND: Kind = Kind {
    name: "hunting",
    version: 1,
    summary: Stated::MEMBER.summary,
    fields: Stated::MEMBER.fields,
    curves: &[Curves { table: tables::CURVE, along: "pitch", quantity: "transmission_error" }],
    example: "
kind: hunting
stiffness: stiffness
designs: modification
torque: 100 N m
pinion: { single: [2 um, -3 um, 1 um, 4 um, -2 um, 0 um, 3 um, -4 um, 1 um, -1 um, 2 um, -2 um, 3 um, -3 um, 0 um, 1 um, -2 um, 2 um, -2 um] }
",
    build,
};

/// Transmission error over a hunting period, by the pitch deviations of every tooth, with its order spectrum.
#[derive(Debug, Declared)]
struct Stated {
    /// The pair's compliances.
    #[declared(kinds = ["stiffness"])]
    pub stiffness: String,
    /// Who gives the designs.
    #[declared(kinds = ["modification", "optimizer"])]
    pub designs: String,
    /// Torque on the pinion.
    #[declared(minimum = 0.0, maximum = 1e9, dimension = TORQUE, axis = usize::MAX, example = "100 N m")]
    pub torque: Vec<f64>,
    /// Pitch deviations of the pinion's teeth; none when not given.
    pub pinion: Option<StatedDeviations>,
    /// Pitch deviations of the gear's teeth; none when not given.
    pub gear: Option<StatedDeviations>,
    /// Positions per base pitch.
    #[declared(minimum = 4, maximum = 10_000, default = "32")]
    pub positions: usize,
    #[declared(flatten)]
    pub slices: Slices,
    #[declared(flatten)]
    pub contact: Contact,
    /// Up to which multiple of the mesh frequency the spectrum goes.
    #[declared(minimum = 0, maximum = 200, default = "2")]
    pub harmonics: usize,
}

/// Pitch deviations of the working flanks as they are measured on the reference circle, one of each tooth in the order in which
/// teeth come into mesh (ISO 1328-1).
#[derive(Clone, Debug, Declared)]
struct StatedDeviations {
    /// Cumulative pitch deviations F_p: how much farther from the first tooth's flank than its nominal place, in the direction of
    /// counting.
    #[declared(minimum = -MOST, maximum = MOST, dimension = LENGTH, example = "3 um")]
    pub cumulative: Option<Vec<f64>>,
    /// Single pitch deviations f_p: of the pitch that ends at this tooth. Their mean is taken off.
    #[declared(minimum = -MOST, maximum = MOST, dimension = LENGTH, example = "-3 um")]
    pub single: Option<Vec<f64>>,
}

/// The largest deviation that is looked at \[m\]; beyond it nothing is small against a tooth.
const MOST: f64 = 1e-3;
/// The most positions of a hunting period: a minute of solves.
const MOST_POSITIONS: usize = 50_000_000;
/// Base pitches that a thread takes at once.
const AT_ONCE: usize = 64;

fn build(record: &Record) -> Result<Box<dyn Stage>, Faults> {
    let stated = Stated::checked(record)?;
    for (name, gear) in [(Stated::NAMES.pinion, &stated.pinion), (Stated::NAMES.gear, &stated.gear)] {
        let Some(gear) = gear else { continue };
        if gear.cumulative.is_some() == gear.single.is_some() {
            let names = StatedDeviations::NAMES;
            let message = format!("give `{}` or `{}` of the {name}'s teeth", names.cumulative, names.single);
            return Err(Diagnostic::new(message).at(record.place_of(name)).into());
        }
    }
    common::check_slices(stated.settings(), record)?;
    Ok(Box::new(stated))
}

impl StatedDeviations {
    /// F_p of each tooth \[m\].
    fn cumulative(&self) -> Vec<f64> {
        let Some(single) = &self.single else { return self.cumulative.clone().unwrap_or_default() };
        let mean = single.iter().sum::<f64>() / single.len().max(1) as f64;
        let mut sum = 0.0;
        let summed = |deviation: &f64| {
            sum += deviation - mean;
            sum
        };
        single.iter().map(summed).collect()
    }
}

impl Stated {
    fn settings(&self) -> Settings {
        common::settings(self.positions, self.slices, self.contact)
    }

    /// F_p of both gears; empty where none are stated.
    fn cumulative(&self) -> [Vec<f64>; 2] {
        [&self.pinion, &self.gear].map(|gear| gear.as_ref().map(StatedDeviations::cumulative).unwrap_or_default())
    }

    /// After how many base pitches everything is as before.
    fn period(&self, pair: &GearPair) -> Result<usize, Failure> {
        let period = hunting_period([Side::Pinion, Side::Gear].map(|side| pair.side(side).specification.teeth));
        let positions = period.saturating_mul(self.positions);
        if positions > MOST_POSITIONS {
            return Err(Failure::new(format!(
                "the same teeth meet again after {period} base pitches, {positions} positions; {MOST_POSITIONS} at most are \
                 computed: take fewer `positions`"
            )));
        }
        Ok(period)
    }

    fn answer(
        &self,
        context: &Context,
        cycle: &MeshCycle,
        (name, design): (&str, &Design),
        torque: f64,
        (deviations, period): (&PitchDeviations, usize),
        steps: &Steps,
    ) -> Result<Found, Failure> {
        let pitches: Vec<isize> = (0..period.cast_signed()).collect();
        let loading = || LoadCase::new(cycle, design, torque).with_pitch_deviations(deviations);
        let parts: Vec<Vec<f64>> = pitches
            .par_chunks(AT_ONCE)
            .map(|pitches| {
                context.check_stop()?;
                let loading = loading();
                let of = |pitch: &isize| loading.over_pitch(deviations, *pitch, self.positions);
                let found = pitches.iter().flat_map(of).collect();
                steps.done();
                Ok::<Vec<f64>, Failure>(found)
            })
            .collect::<Result<_, Failure>>()?;
        let found = Found { errors: parts.concat(), positions: self.positions, period: cycle.period() };
        let (loading, largest) = (loading(), found.maximum());
        if !loading.holds(largest) {
            let (found, maximum) = (in_unit(largest, "mm"), in_unit(loading.largest_approach(), "mm"));
            return Err(Failure::new(format!(
                "design `{name}` at {torque} N m: the gears approach by {found:.6} mm, but `corner_contact: exact` holds \
                 up to {maximum:.6} mm only; beyond that a tip passes the other one, or a pair farther out would touch"
            )));
        }
        Ok(found)
    }
}

impl Stage for Stated {
    fn inputs(&self) -> Vec<Port> {
        let mut ports = common::mesh_cycle_ports(&self.stiffness);
        ports.push(designs::port(names::designs::TABLE.to_owned(), &self.designs));
        ports
    }

    fn outputs(&self) -> Vec<Schema> {
        vec![summary().schema(), spectrum().schema(), curve().schema()]
    }

    fn keys(&self, _table: &str, column: &str, of: KeysOf) -> Option<Vec<Cell>> {
        match column {
            "torque" => Some(self.torque.iter().map(|torque| in_unit(*torque, "N m").into()).collect()),
            "design" => of(&self.designs, names::designs::TABLE, names::designs::DESIGN),
            _ => None,
        }
    }

    fn combines(&self, table: &str) -> bool {
        table == tables::SUMMARY
    }

    fn estimate(&self, demand: &Demand, ahead: &Ahead) -> Estimate {
        let designs = ahead.rows(names::designs::TABLE, names::designs::TABLE);
        let curves = designs.times(RowCount::exact(self.torque.len()));
        // Nobody knows yet how many teeth there are but those that are stated: a usual ratio, and no common factor.
        let period = hunting_period(match self.cumulative().map(|of| u32::try_from(of.len()).unwrap_or(u32::MAX)) {
            [0, 0] => [30, 61],
            [pinion, 0] => [pinion, pinion.saturating_mul(2).saturating_add(1)],
            [0, gear] => [(gear / 2).saturating_sub(1), gear],
            both => both,
        });
        let positions = curves.times(RowCount::about(period.saturating_mul(self.positions)));
        let orders = curves.times(RowCount::about(period.saturating_mul(self.harmonics)));
        Estimate::new(true)
            .work(&Work::of(&CONTACT_SOLVES, positions.index()), common::solve_times(self.settings()))
            .holding(positions.count.saturating_mul(8 * 8))
            .rows(demand, summary().schema(), curves)
            .columns(demand, spectrum().schema(), orders)
            .columns(demand, curve().schema(), positions)
    }

    fn left_out(&self, _demand: &Demand) -> Vec<Omission> {
        common::corner_contact_left_out(self.settings()).into_iter().collect()
    }

    fn refuses(&self, inputs: &Inputs) -> Result<(), Failure> {
        common::refused_cycle(inputs, &self.stiffness, self.settings())
    }

    fn run(&self, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let failed = |error: TableError| Failure::new(error.to_string());
        let (pair, cycle) = common::mesh_cycle(inputs, self.settings())?;
        let period = self.period(&pair)?;
        let cumulative = self.cumulative();
        let deviations = PitchDeviations::new(&pair, [&cumulative[0], &cumulative[1]])
            .map_err(|why| Failure::new(why.to_string()))?;
        let named = designs::of(inputs, names::designs::TABLE, modification::members())?;
        let mut tasks: Vec<(String, Design, f64)> = Vec::new();
        for named in &named {
            let design = named.built(&pair)?;
            tasks.extend(self.torque.iter().map(|torque| (named.name.clone(), design.clone(), *torque)));
        }
        tasks.sort_by(|a, b| a.0.cmp(&b.0).then(a.2.total_cmp(&b.2)));
        let chunks = period.div_ceil(AT_ONCE);
        let steps = Steps::new(context, tasks.len().saturating_mul(chunks));
        let mut cases: Vec<Case> = Vec::with_capacity(tasks.len());
        for (name, design, torque) in tasks {
            let found = self.answer(context, &cycle, (&name, &design), torque, (&deviations, period), &steps)?;
            let plain = LoadCase::new(&cycle, &design, torque).peak_to_peak();
            let orders = period.saturating_mul(self.harmonics);
            let orders = if context.demand.table(tables::SPECTRUM) { orders } else { 0 };
            let amplitudes = amplitudes(&found.errors, orders.min(found.errors.len() / 2));
            cases.push(Case { name, torque, found, plain, amplitudes, cumulative: cumulative.clone() });
        }
        context.work.add(&cycle.work());
        let teeth = [Side::Pinion, Side::Gear].map(|side| pair.side(side).specification.teeth);
        let mut tables = vec![summary().table(&cases).map_err(failed)?];
        if context.demand.table(tables::SPECTRUM) {
            let rows = cases.iter().flat_map(|case| Order::all(case, teeth));
            tables.push(spectrum().table_of(&rows).map_err(failed)?);
        }
        if context.demand.table(tables::CURVE) {
            let rows = cases.iter().flat_map(Row::all);
            tables.push(curve().table_of(&rows).map_err(failed)?);
        }
        Ok(tables)
    }
}
