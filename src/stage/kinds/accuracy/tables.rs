//! The tables: each step of each ladder with its error and cost, the spread over seeds, and the cheapest that do.
//!
//! What depends on time is volatile: it stands in the tables and in no content hash. Must not know: how anything ran.

use super::quantity::{self, Distance};
use super::trial::{Trial, quantile};
use super::{Accuracy, Ladder};
use crate::stage::Demand;
use studygraph::table::columns::Columns;
use studygraph::table::data::Table;
use studygraph::table::schema::{Column, Schema};

/// Bytes of a megabyte.
const MEGABYTE: f64 = 1e6;

/// A setting of a ladder, and the quantity that a row is about.
#[derive(Clone, Copy)]
struct Tried<'a> {
    stage: &'a Accuracy,
    ladder: &'a Ladder,
    /// Counts from 0, as `quantity`.
    step: usize,
    quantity: usize,
    trial: &'a Trial,
}

impl<'a> Tried<'a> {
    fn quantity(&self) -> &'a str {
        &self.stage.quantities[self.quantity].name
    }

    /// As written.
    fn setting(&self) -> &'a str {
        &self.ladder.steps[self.step].written
    }
}

/// The columns that say which setting and quantity it is.
fn of_tried<'a, T>(columns: Columns<T>, get: impl Fn(&T) -> Tried<'a> + Copy + 'static) -> Columns<T> {
    columns
        .text("ladder", "Name of the ladder.", move |row| get(row).ladder.name.as_str())
        .key()
        .integer("step", "Counts the settings of a ladder, from 1.", move |row| get(row).step + 1)
        .key()
        .text("quantity", "The column that is compared.", move |row| get(row).quantity())
        .key()
        .text("setting", "The fields that were replaced, as written.", move |row| get(row).setting())
}

fn evaluations<T>(columns: Columns<T>, get: impl Fn(&T) -> f64 + 'static) -> Columns<T> {
    let description = "How much work it was, by the column that counts it; NaN where none does.";
    columns.float("evaluations", "", description, get).but(Column::allows_nan)
}

fn cost<'a, T>(columns: Columns<T>, get: impl Fn(&T) -> &'a Trial + Copy + 'static) -> Columns<T> {
    let seconds = "Median time of a run, on all threads, with nothing else running.";
    let megabytes = "The most memory a run held over what was held before (1e6 bytes asked of the allocator); NaN \
                     where uncounted.";
    columns
        .float("seconds", "s", seconds, move |row| get(row).seconds)
        .but(Column::volatile)
        .float("megabytes", "", megabytes, move |row| get(row).bytes / MEGABYTE)
        .but(|column| column.volatile().allows_nan())
}

/// A row of `ladder`.
struct Rung<'a> {
    tried: Tried<'a>,
    unit: &'a str,
    distance: Distance,
    order: f64,
    /// Known when all others are.
    on_front: bool,
}

impl Rung<'_> {
    /// Whether there is no reason to take this one when there is `other`.
    fn is_beaten_by(&self, other: &Self) -> bool {
        let (error, seconds) = (self.distance.rank(), self.tried.trial.seconds);
        let (better, faster) = (other.distance.rank(), other.tried.trial.seconds);
        better <= error && faster <= seconds && (better < error || faster < seconds)
    }
}

fn ladder<'a>() -> Columns<Rung<'a>> {
    let row = "The row of the table that is farthest off, relative to the reference; the next columns are of it.";
    let value = "What it is with this setting; of several seeds that with the median error.";
    let relative = "The same over the reference; NaN where that is 0.";
    let order =
        "log(error before/error)/|log(setting/setting before)|, where one number was changed since the step before.";
    let front = "Whether no other setting has an error as small in less time, or a smaller one as fast.";
    let columns = Columns::new("ladder", "Error and cost of every setting that was tried.");
    let columns = of_tried(columns, |row: &Rung<'a>| row.tried)
        .text("row", row, |row| row.distance.row.clone())
        .text("unit", UNIT, |row| row.unit)
        .float("value", "", value, |row| row.distance.value)
        .but(Column::allows_nan)
        .float("reference", "", "What it is with the reference settings.", |row| row.distance.reference)
        .but(Column::allows_nan)
        .float("absolute_error", "", "Distance of the two, in their unit.", |row| row.distance.absolute())
        .but(|column| column.allows_nan().tolerance(1e-12, 1e-3))
        .float("relative_error", "", relative, |row| row.distance.relative())
        .but(|column| column.allows_nan().tolerance(1e-12, 1e-3))
        .float("observed_order", "", order, |row| row.order)
        .but(|column| column.allows_nan().tolerance(1e-2, 1e-2));
    cost(evaluations(columns, |row| row.tried.trial.evaluations), |row| row.tried.trial)
        .flag("on_front", front, |row| row.on_front)
        .but(Column::volatile)
}

const UNIT: &str = "Unit of the values.";

/// The values of all seeds.
struct SpreadRow<'a> {
    tried: Tried<'a>,
    unit: &'a str,
    seeds: usize,
    /// From the smallest value to the largest.
    quartiles: [f64; 5],
}

fn spread<'a>() -> Columns<SpreadRow<'a>> {
    let description = "The values of all seeds, for stages that draw random numbers; no rows with one seed.";
    let columns = of_tried(Columns::new("spread", description), |row: &SpreadRow<'a>| row.tried)
        .text("unit", UNIT, |row| row.unit)
        .integer("seeds", "How many seeds it was run with.", |row| row.seeds);
    evaluations(columns, |row| row.tried.trial.evaluations)
        .float("smallest", "", "The smallest value of all seeds.", |row| row.quartiles[0])
        .float("lower_quartile", "", "A quarter of the seeds are below it.", |row| row.quartiles[1])
        .float("median", "", "Half of the seeds are below it.", |row| row.quartiles[2])
        .float("upper_quartile", "", "Three quarters of the seeds are below it.", |row| row.quartiles[3])
        .float("largest", "", "The largest value of all seeds.", |row| row.quartiles[4])
}

/// The setting that meets a wanted accuracy in the least time, if any does.
struct ChoiceRow<'a> {
    quantity: &'a str,
    wanted: f64,
    best: Option<&'a Rung<'a>>,
}

fn choice<'a>() -> Columns<ChoiceRow<'a>> {
    let ladder = "The ladder of the one that does in the least time; empty where none does.";
    Columns::new("choice", "The cheapest setting for each wanted accuracy.")
        .text("quantity", "The column that is compared.", |row: &ChoiceRow<'a>| row.quantity)
        .key()
        .float("wanted", "", "Relative accuracy that is wanted.", |row| row.wanted)
        .key()
        .flag("met", "Whether a setting meets it.", |row| row.best.is_some())
        .text("ladder", ladder, |row| row.best.map_or("", |best| best.tried.ladder.name.as_str()))
        .but(Column::volatile)
        .text("setting", "Its setting.", |row| row.best.map_or("", |best| best.tried.setting()))
        .but(Column::volatile)
        .float("relative_error", "", "Its error.", |row| row.best.map_or(f64::NAN, |best| best.distance.relative()))
        .but(|column| column.volatile().allows_nan())
        .float("seconds", "s", "Its time.", |row| row.best.map_or(f64::NAN, |best| best.tried.trial.seconds))
        .but(|column| column.volatile().allows_nan())
}

/// The reference settings as written, and what came of them.
type ReferenceRow<'a> = (&'a str, &'a Trial);

fn reference<'a>() -> Columns<ReferenceRow<'a>> {
    let columns = Columns::new("reference", "The settings that count as converged, and what they cost.").text(
        "setting",
        "The fields that were replaced, as written.",
        |row: &ReferenceRow<'a>| row.0,
    );
    cost(columns, |row| row.1)
}

pub fn schemas() -> Vec<Schema> {
    vec![ladder().schema(), spread().schema(), choice().schema(), reference().schema()]
}

/// `trials` in the order of the variants: the reference, then ladder by ladder.
///
/// # Errors
/// When the rows of a table depend on the settings.
pub fn tables(stage: &Accuracy, trials: &[Trial], demand: &Demand) -> Result<Vec<Table>, String> {
    let (converged, tried) = trials.split_first().ok_or("nothing was run")?;
    let outputs = stage.reference.stage.outputs();
    let units: Vec<String> = stage.quantities.iter().map(|quantity| quantity.unit(&outputs)).collect();
    let mut rungs: Vec<Rung> = Vec::new();
    let mut seeds: Vec<SpreadRow> = Vec::new();
    let mut trials = tried.iter();
    for ladder in &stage.ladders {
        let mut before: Vec<f64> = Vec::new();
        for (step, (variant, trial)) in ladder.steps.iter().zip(&mut trials).enumerate() {
            let refined = step.checked_sub(1).and_then(|coarser| variant.refined(&ladder.steps[coarser]));
            let mut errors = Vec::new();
            for (index, unit) in units.iter().enumerate() {
                let distance = median(trial, index, converged).map_err(|problem| {
                    format!("{}, `{}`, {}: {problem}", variant.label, variant.written, stage.quantities[index].name)
                })?;
                let relative = distance.relative();
                let order = match (before.get(index), refined) {
                    (Some(&before), Some((from, to))) if before > 0.0 && relative > 0.0 => {
                        libm::log(before / relative) / libm::log(to / from).abs()
                    }
                    _ => f64::NAN,
                };
                errors.push(relative);
                let tried = Tried { stage, ladder, step, quantity: index, trial };
                rungs.push(Rung { tried, unit, distance, order, on_front: false });
                if trial.values.len() > 1 {
                    let quartiles = quartiles(trial, index)?;
                    seeds.push(SpreadRow { tried, unit, seeds: trial.values.len(), quartiles });
                }
            }
            before = errors;
        }
    }
    let beaten =
        |rung: &Rung| rungs.iter().any(|other| other.tried.quantity == rung.tried.quantity && rung.is_beaten_by(other));
    let on_front: Vec<bool> = rungs.iter().map(|rung| !beaten(rung)).collect();
    for (rung, on_front) in rungs.iter_mut().zip(on_front) {
        rung.on_front = on_front;
    }
    let table = |name: &str| match name {
        "ladder" => ladder().table(&rungs),
        "spread" => spread().table(&seeds),
        "choice" => choice().table(&choices(stage, &rungs)),
        _ => reference().table(&[(stage.reference.written.as_str(), converged)]),
    };
    let wanted = schemas().into_iter().filter(|schema| demand.table(&schema.name));
    wanted.map(|schema| table(&schema.name).map_err(|error| error.to_string())).collect()
}

/// The distance of the seed in the middle.
fn median(trial: &Trial, quantity: usize, reference: &Trial) -> Result<Distance, String> {
    let converged = &reference.values[0][quantity];
    let one = |values: &Vec<Vec<quantity::Value>>| quantity::distance(&values[quantity], converged);
    let mut distances: Vec<Distance> = trial.values.iter().map(one).collect::<Result<_, _>>()?;
    distances.sort_by(|one, two| one.rank().total_cmp(&two.rank()));
    Ok(distances.swap_remove((distances.len() - 1) / 2))
}

fn quartiles(trial: &Trial, quantity: usize) -> Result<[f64; 5], String> {
    let mut values = Vec::new();
    for seed in &trial.values {
        let [only] = &seed[quantity][..] else {
            return Err(
                "with several seeds a quantity must be one row; name it with `table[key=value, …].column`".to_owned()
            );
        };
        values.push(only.value);
    }
    Ok([0.0, 0.25, 0.5, 0.75, 1.0].map(|share| quantile(&mut values, share)))
}

fn choices<'a>(stage: &'a Accuracy, rungs: &'a [Rung<'a>]) -> Vec<ChoiceRow<'a>> {
    let mut rows = Vec::new();
    for (index, quantity) in stage.quantities.iter().enumerate() {
        for &wanted in &stage.wanted {
            let good = rungs.iter().filter(|rung| rung.tried.quantity == index && rung.distance.rank() <= wanted);
            let best = good.min_by(|one, two| one.tried.trial.seconds.total_cmp(&two.tried.trial.seconds));
            rows.push(ChoiceRow { quantity: &quantity.name, wanted, best });
        }
    }
    rows
}
