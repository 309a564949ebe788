//! `kind: hunting`: transmission error until the same teeth meet again, of gears whose teeth deviate, and its order spectrum.
//!
//! Must not know: how equilibrium is found.

mod stated;
mod tables;

use self::stated::{OfPair, StatedDeviations};
use self::tables::{Case, Found, Order, Row, curve, flanks, spectrum, summary};
use crate::stage::common::{Contact, Slices};
use crate::stage::neglected_corners::{self, REMEDY, WithoutCorners};
use crate::stage::{Ahead, Context, Curves, Demand, Estimate, Inputs, KeysOf, Kind, Omission, Port, RowCount, Stage};
use crate::stage::{common, designs, names, pair};
use declare::Declared;
use declare::declared::Declared;
use declare::error::{Failure, Faults};
use declare::record::Record;
use declare::units::{TORQUE, in_unit};
use declare::work::Work;
use gearmesh::gear::geometry::{GearPair, Side};
use gearmesh::gear::mesh::answers::hunting::{Teeth, hunting_period};
use gearmesh::gear::mesh::{Mesh, Settings};
use gearmesh::gear::modification::{self, Design};
use gearmesh::gear::work::CONTACT_SOLVES;
use gearmesh::numeric::spectrum::amplitudes;
use rayon::prelude::*;
use studygraph::stage::steps::Steps;
use studygraph::table::data::{Cell, Table, TableError};
use studygraph::table::schema::Schema;

/// The curves that the warning of corners compares.
const MEAN_TEETH: &str = ", without the deviations of single teeth";

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
gear:
  flanks:
    - { tooth: 1, roll_lengths: [18 mm, 23 mm, 28 mm, 32 mm], deviations: [2 um, 0 um, -1 um, -6 um] }
",
    build,
};

/// Transmission error over a hunting period, by the deviations of every tooth, with its order spectrum.
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
    /// Deviations of the pinion's teeth; none when not given.
    pub pinion: Option<StatedDeviations>,
    /// Deviations of the gear's teeth; none when not given.
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

/// The most positions of a hunting period: a minute of solves.
const MOST_POSITIONS: usize = 50_000_000;
/// Time of a solve between flanks of single teeth over that of one between the design's: five where all teeth have some, little
/// more than one where one has.
const TRACED_SOLVES: f64 = 3.0;
/// What a slice adds to that where all teeth of a gear have traces across the face alone, where no closed form passes the slices, and
/// where they have traces over all of the flank.
const SLICED_SOLVES: [f64; 2] = [0.35, 3.0];
/// Base pitches that a thread takes at once.
const AT_ONCE: usize = 64;

fn build(record: &Record) -> Result<Box<dyn Stage>, Faults> {
    let stated = Stated::checked(record)?;
    let gears = [(Stated::NAMES.pinion, stated.pinion.as_ref()), (Stated::NAMES.gear, stated.gear.as_ref())];
    let checked = |(name, gear): (&str, Option<&StatedDeviations>)| {
        gear.map_or(Ok(()), |gear| gear.check(name, record.place_of(name)))
    };
    Faults::collect(gears.into_iter().map(checked))?;
    common::check_slices(stated.settings(), record)?;
    Ok(Box::new(stated))
}

impl Stated {
    fn settings(&self) -> Settings {
        common::settings(self.positions, self.slices, self.contact)
    }

    fn gears(&self) -> [Option<&StatedDeviations>; 2] {
        [self.pinion.as_ref(), self.gear.as_ref()]
    }

    /// How many times as long as usual a solve takes by the traces of single teeth, of gears of about so many.
    fn traced_times(&self, teeth: [u32; 2]) -> f64 {
        let (mut times, mut is_traced) = (1.0, false);
        for (gear, teeth) in self.gears().into_iter().zip(teeth) {
            let Some(gear) = gear else { continue };
            is_traced |= gear.traces() > 0;
            let share = |traces: usize| (traces as f64 / f64::from(teeth.max(1))).min(1.0);
            let of_each = gear.traces_across().map(share).into_iter().zip(SLICED_SOLVES);
            times += of_each.map(|(share, per_slice)| share * per_slice).sum::<f64>() * self.settings().slices as f64;
        }
        if is_traced { TRACED_SOLVES * times } else { 1.0 }
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
        cycle: &Mesh,
        (name, design): (&str, &Design),
        torque: f64,
        (teeth, period): (&Teeth, usize),
        steps: &Steps,
    ) -> Result<Found, Failure> {
        let loading = || cycle.loaded(design, torque).with_teeth(teeth);
        let parts: Vec<Vec<f64>> = (0..period.div_ceil(AT_ONCE))
            .into_par_iter()
            .map(|part| {
                context.check_stop()?;
                let pitches = part * AT_ONCE..period.min((part + 1) * AT_ONCE);
                let pitches = pitches.start.cast_signed()..pitches.end.cast_signed();
                let found = loading().over_pitches(teeth, pitches, self.positions);
                steps.done();
                Ok::<Vec<f64>, Failure>(found)
            })
            .collect::<Result<_, Failure>>()?;
        let found = Found { errors: parts.concat(), positions: self.positions, period: cycle.period() };
        let (loading, largest) = (loading(), found.maximum());
        loading
            .check_approach(largest)
            .map_err(|beyond| Failure::new(format!("design `{name}` at {torque} N m: {beyond}")))?;
        Ok(found)
    }

    /// Reports the error by `corner_contact: none`, of the mesh cycle without deviations of single teeth.
    fn warn_of_corners(&self, (context, inputs): (&Context, &Inputs), cycle: &Mesh, tasks: &[(String, Design, f64)]) {
        if !context.is_heard {
            return;
        }
        let without: Vec<Option<WithoutCorners>> = tasks
            .iter()
            .map(|(name, design, torque)| WithoutCorners::of(name, *torque, &cycle.loaded(design, *torque)))
            .collect();
        let Some(worst) = WithoutCorners::worst(&without) else { return };
        let Some(exact) = neglected_corners::cycle(inputs, self.settings()) else { return };
        let (_, design, torque) = &tasks[worst];
        let loading = exact.loaded(design, *torque);
        let mean = without[worst].map(|without| WithoutCorners { deviations: MEAN_TEETH, ..without });
        if let Some(warning) = mean.and_then(|without| without.compared(&loading, REMEDY)) {
            (context.warn)(warning);
        }
    }
}

impl Stage for Stated {
    fn inputs(&self) -> Vec<Port> {
        let mut ports = common::mesh_cycle_ports(&self.stiffness);
        ports.push(designs::port(names::designs::TABLE.to_owned(), &self.designs));
        ports
    }

    fn outputs(&self) -> Vec<Schema> {
        vec![summary().schema(), spectrum().schema(), curve().schema(), flanks().schema()]
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
        let teeth = self.gears().map(|gear| gear.and_then(StatedDeviations::teeth).unwrap_or(0));
        let teeth = match teeth.map(|teeth| u32::try_from(teeth).unwrap_or(u32::MAX)) {
            [0, 0] => [30, 61],
            [pinion, 0] => [pinion, pinion.saturating_mul(2).saturating_add(1)],
            [0, gear] => [(gear / 2).saturating_sub(1), gear],
            both => both,
        };
        let period = hunting_period(teeth);
        let positions = curves.times(RowCount::about(period.saturating_mul(self.positions)));
        let orders = curves.times(RowCount::about(period.saturating_mul(self.harmonics)));
        // The curve that is worked on, and its transform.
        let curve_bytes = (period.saturating_mul(self.positions) as u64).saturating_mul(13 * 8);
        let kept_bytes =
            |table: &str, rows: RowCount| if demand.table(table) { rows.count.saturating_mul(8) } else { 0 };
        let kept_bytes = kept_bytes(tables::CURVE, positions).saturating_add(kept_bytes(tables::SPECTRUM, orders));
        let traces: usize = self.gears().into_iter().flatten().map(StatedDeviations::traces).sum();
        let times = common::solve_times(self.settings()) * self.traced_times(teeth);
        Estimate::new(true)
            .work(&Work::of(&CONTACT_SOLVES, positions.index()), times)
            .holding(curve_bytes.saturating_add(kept_bytes))
            .rows(demand, summary().schema(), curves)
            .columns(demand, spectrum().schema(), orders)
            .columns(demand, curve().schema(), positions)
            .rows(demand, flanks().schema(), RowCount::at_most(2 * traces))
    }

    fn left_out(&self, _demand: &Demand) -> Vec<Omission> {
        common::corner_contact_left_out(self.settings()).into_iter().collect()
    }

    fn refuses(&self, inputs: &Inputs) -> Result<(), Failure> {
        if inputs.ports.contains_key(names::PAIR_PORT) {
            OfPair::new(&pair::of(inputs)?, self.gears())?;
        }
        common::refused_cycle(inputs, &self.stiffness, self.settings())
    }

    fn run(&self, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let failed = |error: TableError| Failure::new(error.to_string());
        let (pair, cycle) = common::mesh_cycle(inputs, self.settings())?;
        let period = self.period(&pair)?;
        let stated = OfPair::new(&pair, self.gears())?;
        let named = designs::of(inputs, names::designs::TABLE, modification::members())?;
        let mut tasks: Vec<(String, Design, f64)> = Vec::new();
        for named in &named {
            let design = named.built(&pair)?;
            stated.fit(&named.name, &design)?;
            tasks.extend(self.torque.iter().map(|torque| (named.name.clone(), design.clone(), *torque)));
        }
        tasks.sort_by(|a, b| a.0.cmp(&b.0).then(a.2.total_cmp(&b.2)));
        let chunks = period.div_ceil(AT_ONCE);
        let steps = Steps::new(context, tasks.len().saturating_mul(chunks));
        let mut cases: Vec<Case> = Vec::with_capacity(tasks.len());
        for (name, design, torque) in tasks.clone() {
            let found = self.answer(context, &cycle, (&name, &design), torque, (&stated.teeth, period), &steps)?;
            let plain = cycle.loaded(&design, torque).peak_to_peak();
            let orders = period.saturating_mul(self.harmonics);
            let orders = if context.demand.table(tables::SPECTRUM) { orders } else { 0 };
            let amplitudes = amplitudes(&found.errors, orders.min(found.errors.len() / 2));
            // A curve may be as large as memory: what nobody asks for goes.
            let keeps_curve = context.demand.table(tables::CURVE);
            cases.push(Case::new((name, torque), (plain, stated.deviations), found, amplitudes, keeps_curve));
        }
        self.warn_of_corners((context, inputs), &cycle, &tasks);
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
        if context.demand.table(tables::FLANKS) {
            tables.push(flanks().table(&stated.evaluated()).map_err(failed)?);
        }
        Ok(tables)
    }
}
