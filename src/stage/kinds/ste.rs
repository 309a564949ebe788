//! `kind: ste`: static transmission error of designs under torques: curves, summaries, harmonics.
//!
//! Up to 128 torques are a chunk each, so an added one computes only itself. Must not know: who made the designs.

mod ahead;
mod answer;
mod friction;
mod nominal;
mod pressures;
mod rows;
mod samples;
mod simpler;
mod tables;
mod warnings;

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

use rayon::prelude::*;

use self::answer::WantedHere;
use self::friction::Friction;
use self::nominal::nominal_root_stresses;
use self::pressures::CellRow;
use self::rows::{Keyed, Load};
use self::samples::{Sample, Samples};
use self::tables::{HARMONICS, amplitudes, cost, curve, harmonics, points, summary};
use crate::stage::cases::{DEVIATIONS, Deviation, Deviations};
use crate::stage::common::{Contact, Slices};
use crate::stage::names::{self, summary};
use crate::stage::{
    Ahead, Context, Curves, Demand, Estimate, Inputs, KeysOf, Kind, Omission, Port, Saved, Stage, common, designs,
    root_influences, simpler as long_relief,
};
use declare::Declared;
use declare::declared::{Declared, Placed};
use declare::error::{Diagnostic, Failure, Faults};
use declare::record::Record;
use declare::units::{ANGLE, RATIO, TORQUE, in_unit};
use gearmesh::gear::contact::SliceCoupling;
use gearmesh::gear::mesh::Settings;
use gearmesh::gear::mesh::answers::curve::Wanted;
use gearmesh::gear::modification::{self, Design};
use gearmesh::gear::work::{CONTACT_PRESSURES, CONTACT_SOLVES, ROOT_STRESSES};
use studygraph::stage::steps::Steps;
use studygraph::table::data::{Cell, Table, TableError};
use studygraph::table::schema::Schema;

pub const KIND: Kind = Kind {
    name: "ste",
    version: 1,
    summary: Ste::MEMBER.summary,
    fields: Ste::MEMBER.fields,
    curves: &[Curves { table: names::curve::TABLE, along: "cycle_position", quantity: "transmission_error" }],
    example: "
kind: ste
stiffness: stiffness
designs: modification
torque: { from: 25 N m, to: 100 N m, count: 4 }
friction: { law: { constant: { coefficient: 0.05 } }, speed: 1500 rpm }
",
    build,
};

/// Static transmission error of designs under torques, with load sharing and contact pressure.
#[derive(Debug, Declared)]
struct Ste {
    /// The pair's compliances.
    #[declared(kinds = ["stiffness"])]
    pub stiffness: String,
    /// Who gives the designs.
    #[declared(kinds = ["modification", "optimizer"])]
    pub designs: Vec<Placed<String>>,
    /// Torque on the pinion.
    #[declared(minimum = 0.0, maximum = 1e9, dimension = TORQUE, axis = 1, example = "100 N m")]
    pub torque: Vec<f64>,
    #[declared(flatten)]
    pub deviations: Deviations,
    /// Wanted relative accuracy of the peak-to-peak; sets positions and slices.
    #[declared(minimum = 1e-9, maximum = 0.1, dimension = RATIO, example = "0.1 %")]
    pub accuracy: Option<f64>,
    /// Positions per base pitch; zone ends, relief starts, first touches and extrema come on top.
    #[declared(minimum = 8, maximum = 100_000, default = "64")]
    pub positions: usize,
    #[declared(flatten)]
    pub slices: Slices,
    #[declared(flatten)]
    pub contact: Contact,
    /// Friction of the flanks, for what is lost and, if that is stated, for the loads.
    pub friction: Option<Friction>,
    /// By how much of a design's peak-to-peak that of long relief may be larger, to be told as a simpler one that is as good.
    #[declared(minimum = 0.0, maximum = 0.5, dimension = RATIO, example = "5 %")]
    pub simpler_within: Option<f64>,
    /// How many harmonics of the mesh frequency.
    #[declared(minimum = 0, maximum = 200, default = "8")]
    pub harmonics: usize,
    /// Equidistant positions per mesh cycle in the table `samples`.
    #[declared(minimum = 1, maximum = 100_000, default = "12")]
    pub samples: usize,
    /// Where the first of them is: rotation of the pinion from where a pair starts contact in A, in driving direction.
    #[declared(minimum = -TAU, maximum = TAU, dimension = ANGLE, default = "0 deg")]
    pub first_sample: f64,
    /// Positions per base pitch in the table `pressure`.
    #[declared(minimum = 1, maximum = 100_000, default = "32")]
    pub pressure_positions: usize,
}

/// Time of a solve that a slice adds, over that of a solve without slices.
const PER_SLICE: f64 = 0.01;
/// Solves that a curve takes for each of its positions, with its extrema and first touches.
const SOLVES_PER_POSITION: f64 = 4.0;
/// Solves for what a curve loses, over those of the curve.
const LOSS_OF_CURVE: f64 = 0.5;

fn build(record: &Record) -> Result<Box<dyn Stage>, Faults> {
    let ste = Ste::checked(record)?;
    if ste.designs.is_empty() {
        return Err(Diagnostic::new("no designs are given").at(record.place_of(Ste::NAMES.designs)).into());
    }
    for (index, Placed { value: name, place }) in ste.designs.iter().enumerate() {
        if ste.designs[..index].iter().any(|other| other.value == *name) {
            return Err(Diagnostic::new(format!("the designs of `{name}` are listed twice")).at(*place).into());
        }
    }
    ste.deviations.check(record)?;
    common::check_slices(ste.settings(), record)?;
    ste.check_friction(record)?;
    Ok(Box::new(ste))
}

/// Tasks of which a thread keeps all points, until they are rows: no more than fit its caches.
const MOST_AT_ONCE: usize = 16;
/// Shares of each thread, at least, where there are as many tasks: they take unlike times.
const SHARES: usize = 16;

impl Ste {
    fn settings(&self) -> Settings {
        common::settings(self.positions, self.slices, self.contact)
    }
}

/// A design as it is made and mounted, its name, and what is off.
type Named = (Design, String, Deviation);

impl Stage for Ste {
    fn inputs(&self) -> Vec<Port> {
        let mut ports = common::mesh_cycle_ports(&self.stiffness);
        for (index, stage) in self.designs.iter().enumerate() {
            ports.push(designs::port(format!("designs_{}", index + 1), &stage.value));
        }
        ports.push(root_influences::port(&self.stiffness));
        ports
    }

    fn outputs(&self) -> Vec<Schema> {
        let stated = &self.deviations.stated()[..];
        let rubs = self.friction.is_some();
        let mut schemas = vec![
            summary(stated, rubs).schema(),
            curve(stated, rubs).schema(),
            harmonics(stated).schema(),
            cost(stated).schema(),
            samples::samples(stated).schema(),
            samples::summary(stated).schema(),
            pressures::map(stated).schema(),
        ];
        schemas.extend(rubs.then(|| friction::along(stated).schema()));
        schemas
    }

    fn keys(&self, table: &str, column: &str, of: KeysOf) -> Option<Vec<Cell>> {
        match column {
            "order" if table == HARMONICS => Some((1..=self.harmonics).map(Cell::from).collect()),
            "torque" => Some(self.torque.iter().map(|torque| in_unit(*torque, "N m").into()).collect()),
            "design" => {
                let names = |giver: &Placed<String>| of(&giver.value, names::designs::TABLE, names::designs::DESIGN);
                Some(self.designs.iter().map(names).collect::<Option<Vec<_>>>()?.concat())
            }
            _ => {
                let field = DEVIATIONS.iter().position(|(name, _)| *name == column)?;
                Some(self.deviations.values(field).iter().map(|value| in_unit(*value, "um").into()).collect())
            }
        }
    }

    fn combines(&self, _table: &str) -> bool {
        true
    }

    fn estimate(&self, demand: &Demand, ahead: &Ahead) -> Estimate {
        self.ahead(demand, ahead)
    }

    fn left_out(&self, _demand: &Demand) -> Vec<Omission> {
        let slices = match self.settings().slice_coupling {
            SliceCoupling::None => {
                "crowning, slopes and linear or parabolic end relief have a closed form under linear contact"
            }
            SliceCoupling::Plate => "one does for designs that do not vary across the face",
        };
        let sliced = Saved::For {
            done: &CONTACT_SOLVES,
            saved: &CONTACT_SOLVES,
            times: PER_SLICE * self.settings().slices as f64,
        };
        let mut omissions = vec![Omission::new("slices across the face", slices).saving(Some(sliced))];
        omissions.extend(common::corner_contact_left_out(self.settings()));
        if self.harmonics == 0 {
            omissions.push(Omission::new("harmonics", "`harmonics` is 0"));
        }
        omissions
    }

    fn saved(&self, demand: &Demand, table: &str, column: Option<&str>) -> Option<Saved> {
        let for_each_solve = |saved, times| Some(Saved::For { done: &CONTACT_SOLVES, saved, times });
        match (table, column) {
            // Any of them takes all pressures.
            (summary::TABLE, Some(summary::LARGEST_PRESSURE)) if !pressures::are_wanted(demand) => {
                for_each_solve(&CONTACT_PRESSURES, 1.0)
            }
            // Any of them takes all root stresses.
            (summary::TABLE, Some(summary::LARGEST_ROOT_STRESS_PINION)) if !root_influences::are_wanted(demand) => {
                for_each_solve(&ROOT_STRESSES, 1.0)
            }
            // Any of them takes what is lost.
            (summary::TABLE, Some(friction::MEAN_COEFFICIENT)) if !friction::of_summary_is_wanted(demand) => {
                for_each_solve(&CONTACT_SOLVES, LOSS_OF_CURVE)
            }
            (samples::TABLE, None) if !demand.table(samples::SUMMARY) => {
                let curve = SOLVES_PER_POSITION * self.settings().positions as f64;
                for_each_solve(&CONTACT_SOLVES, self.samples as f64 / curve)
            }
            (pressures::TABLE, None) => {
                let curve = SOLVES_PER_POSITION * self.settings().positions as f64;
                for_each_solve(&CONTACT_SOLVES, self.pressure_positions as f64 / curve)
            }
            _ => None,
        }
    }

    fn refuses(&self, inputs: &Inputs) -> Result<(), Failure> {
        common::refused_cycle(inputs, &self.stiffness, self.settings())
    }

    fn run(&self, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let (pair, base) = common::mesh_cycle(inputs, self.settings())?;
        let stated = &self.deviations.stated()[..];
        let combinations = self.deviations.combinations();
        let (mut designs, mut simple): (Vec<Named>, BTreeSet<String>) = Default::default();
        let mut givers: BTreeMap<String, &str> = BTreeMap::new();
        for (index, Placed { value: giver, .. }) in (1..).zip(&self.designs) {
            let port = format!("designs_{index}");
            for named in designs::of(inputs, &port, modification::members())? {
                if let Some(earlier) = givers.insert(named.name.clone(), giver) {
                    return Err(Failure::new(format!(
                        "`{earlier}` and `{giver}` both give a design called `{}`; one of them needs another name",
                        named.name
                    )));
                }
                let drawn = named.built(&pair)?;
                if long_relief::is_simple(&named.elements) {
                    simple.insert(named.name.clone());
                }
                for deviation in &combinations {
                    let off = deviation.on(&drawn, &pair);
                    let off =
                        off.map_err(|wrong| Failure::new(format!("design `{}`: {}", named.name, wrong.message)))?;
                    designs.push((off, named.name.clone(), *deviation));
                }
            }
        }
        let root_stress = root_influences::are_wanted(context.demand);
        let base = if root_stress { base.with_roots(&root_influences::of(inputs)?) } else { base };
        let pressure = pressures::are_wanted(context.demand);
        let wanted = &WantedHere {
            of_curve: Wanted { harmonics: self.harmonics, pressure, root_stress },
            of_pairs: pressures::of_pairs_are_wanted(context.demand),
            loss: friction::of_summary_is_wanted(context.demand),
            left: friction::of_curve_is_wanted(context.demand),
            corners: context.is_heard,
        };
        let rubs = self.friction.is_some();
        let per_torque = nominal_root_stresses(context, &pair);
        let mut tasks: Vec<(&Named, f64)> =
            designs.iter().flat_map(|named| self.torque.iter().map(move |torque| (named, *torque))).collect();
        // Sorted while they are few: a table sorts by comparing the texts of every row.
        tasks.sort_by(|a, b| a.0.1.cmp(&b.0.1).then(a.1.total_cmp(&b.1)));
        let narrowed = |schema: Schema| context.demand.narrowed(schema);
        let failed = |error: TableError| Failure::new(error.to_string());
        let of_curve = narrowed(curve(stated, rubs).schema());
        let steps = Steps::new(context, tasks.len());
        let at_once = (tasks.len() / (SHARES * rayon::current_num_threads())).clamp(1, MOST_AT_ONCE);
        let parts: Vec<(Vec<Keyed>, Table)> = tasks
            .par_chunks(at_once)
            .map(|tasks| {
                let mut answers = Vec::with_capacity(tasks.len());
                let mut found = Vec::with_capacity(tasks.len());
                let mut before = None;
                for &(named, torque) in tasks {
                    context.check_stop()?;
                    let (_, name, deviation) = named;
                    let load = Load { torque, deviation: *deviation };
                    let of_torque = per_torque.map(|unit| unit * torque);
                    let (answer, curve) = self.answer(&base, named, torque, &mut before, wanted, of_torque)?;
                    answers.push((name.as_str(), load, answer));
                    found.push((name.as_str(), load, curve));
                    steps.done();
                }
                let rows = curve(stated, rubs).only(&of_curve).table_of(&points(&found)).map_err(failed)?;
                Ok((answers, rows))
            })
            .collect::<Result<_, Failure>>()?;
        let (answers, parts): (Vec<_>, Vec<_>) = parts.into_iter().unzip();
        let keyed: Vec<Keyed> = answers.into_iter().flatten().collect();
        self.warn(context, &keyed, pair.pinion.specification.module);
        self.warn_of_corners((context, inputs), &base, &keyed, &tasks);
        self.tell_if_simpler_does(context, (&pair, &base), (&keyed, &simple))?;
        pressures::warn(context, &base, &keyed);
        self.warn_of_friction(context, &keyed);
        let none = || Table::from_rows(of_curve, Vec::new());
        let curves = Table::concatenated(parts).and_then(|curves| curves.map_or_else(none, Ok));
        let mut tables = vec![
            summary(stated, rubs).only(&narrowed(summary(stated, rubs).schema())).table(&keyed).map_err(failed)?,
            curves.map_err(failed)?,
            harmonics(stated)
                .only(&narrowed(harmonics(stated).schema()))
                .table_of(&amplitudes(&keyed))
                .map_err(failed)?,
        ];
        if context.demand.table(tables::COST) {
            tables.push(cost(stated).table(&keyed).map_err(failed)?);
        }
        let [each, of_each] = [samples::TABLE, samples::SUMMARY].map(|table| context.demand.table(table));
        if each || of_each {
            let (mut rows, mut sums): (Vec<Keyed<Sample>>, Vec<Keyed<Samples>>) = Default::default();
            for &((design, name, deviation), torque) in &tasks {
                context.check_stop()?;
                let (name, load) = (name.as_str(), Load { torque, deviation: *deviation });
                let loading = self.loading(&base, design, torque);
                let (taken, sum) = samples::taken(&loading, self.first_sample, self.samples);
                rows.extend(taken.into_iter().map(|sample| (name, load, sample)));
                sums.push((name, load, sum));
            }
            if each {
                tables.push(samples::samples(stated).table(&rows).map_err(failed)?);
            }
            if of_each {
                tables.push(samples::summary(stated).table(&sums).map_err(failed)?);
            }
        }
        if context.demand.table(pressures::TABLE) {
            let strips = self.settings().slices;
            let maps: Vec<Vec<CellRow>> = tasks
                .par_iter()
                .map(|&((design, name, deviation), torque)| {
                    context.check_stop()?;
                    let load = Load { torque, deviation: *deviation };
                    let cells = self.loading(&base, design, torque).map(self.pressure_positions, strips);
                    Ok(cells.into_iter().map(|cell| (name.as_str(), load, cell)).collect())
                })
                .collect::<Result<_, Failure>>()?;
            tables.push(pressures::map(stated).table_of(&maps.iter().flatten().copied()).map_err(failed)?);
        }
        tables.extend(self.along_path(context, &base, &tasks)?);
        context.work.add(&base.work());
        Ok(tables)
    }
}
