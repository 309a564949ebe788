//! The tables: each step of each ladder with its error and cost, the spread over seeds, and the cheapest that do.
//!
//! What depends on time is volatile: it stands in the tables and in no content hash. Must not know: how anything ran.

use super::quantity::{self, Distance};
use super::trial::{Trial, quantile};
use super::{Accuracy, Ladder};
use crate::stage::Demand;
use studygraph::table::data::{Row, Table};
use studygraph::table::schema::{Column, Schema};

/// Bytes of a megabyte.
const MEGABYTE: f64 = 1e6;

fn keys() -> Vec<Column> {
    vec![
        Column::text("ladder", "Name of the ladder.").key(),
        Column::integer("step", "Counts the settings of a ladder, from 1.").key(),
        Column::text("quantity", "The column that is compared.").key(),
        Column::text("setting", "The fields that were replaced, as written."),
    ]
}

fn evaluations() -> Column {
    Column::float("evaluations", "", "How much work it was, by the column that counts it; NaN where none does.")
        .allows_nan()
}

fn cost() -> [Column; 2] {
    [
        Column::float("seconds", "s", "Median time of a run, on all threads, with nothing else running.").volatile(),
        Column::float(
            "megabytes",
            "",
            "The most memory a run held over what was held before (1e6 bytes asked of the allocator); NaN where uncounted.",
        )
        .volatile()
        .allows_nan(),
    ]
}

pub fn schemas() -> Vec<Schema> {
    let unit = || Column::text("unit", "Unit of the values.");
    let mut ladder = keys();
    ladder.extend([
        Column::text("row", "The row of the table that is farthest off, relative to the reference; the next columns are of it."),
        unit(),
        Column::float("value", "", "What it is with this setting; of several seeds that with the median error.").allows_nan(),
        Column::float("reference", "", "What it is with the reference settings.").allows_nan(),
        Column::float("absolute_error", "", "Distance of the two, in their unit.").allows_nan().tolerance(1e-12, 1e-3),
        Column::float("relative_error", "", "The same over the reference; NaN where that is 0.")
            .allows_nan()
            .tolerance(1e-12, 1e-3),
        Column::float(
            "observed_order",
            "",
            "log(error before/error)/|log(setting/setting before)|, where one number was changed since the step before.",
        )
        .allows_nan()
        .tolerance(1e-2, 1e-2),
        evaluations(),
    ]);
    ladder.extend(cost());
    ladder.push(
        Column::flag(
            "on_front",
            "Whether no other setting has an error as small in less time, or a smaller one as fast.",
        )
        .volatile(),
    );
    let mut spread = keys();
    spread.extend([
        unit(),
        Column::integer("seeds", "How many seeds it was run with."),
        evaluations(),
        Column::float("smallest", "", "The smallest value of all seeds."),
        Column::float("lower_quartile", "", "A quarter of the seeds are below it."),
        Column::float("median", "", "Half of the seeds are below it."),
        Column::float("upper_quartile", "", "Three quarters of the seeds are below it."),
        Column::float("largest", "", "The largest value of all seeds."),
    ]);
    let choice = vec![
        Column::text("quantity", "The column that is compared.").key(),
        Column::float("wanted", "", "Relative accuracy that is wanted.").key(),
        Column::flag("met", "Whether a setting meets it."),
        Column::text("ladder", "The ladder of the one that does in the least time; empty where none does.").volatile(),
        Column::text("setting", "Its setting.").volatile(),
        Column::float("relative_error", "", "Its error.").volatile().allows_nan(),
        Column::float("seconds", "s", "Its time.").volatile().allows_nan(),
    ];
    let mut reference = vec![Column::text("setting", "The fields that were replaced, as written.")];
    reference.extend(cost());
    vec![
        Schema::new("ladder", "Error and cost of every setting that was tried.", ladder),
        Schema::new(
            "spread",
            "The values of all seeds, for stages that draw random numbers; no rows with one seed.",
            spread,
        ),
        Schema::new("choice", "The cheapest setting for each wanted accuracy.", choice),
        Schema::new("reference", "The settings that count as converged, and what they cost.", reference),
    ]
}

/// A row of `ladder` before the front is known.
struct Rung<'a> {
    ladder: &'a Ladder,
    step: usize,
    quantity: usize,
    distance: Distance,
    order: f64,
    trial: &'a Trial,
}

impl Rung<'_> {
    /// Whether there is no reason to take this one when there is `other`.
    fn is_beaten_by(&self, other: &Self) -> bool {
        let (error, seconds) = (self.distance.rank(), self.trial.seconds);
        let (better, faster) = (other.distance.rank(), other.trial.seconds);
        better <= error && faster <= seconds && (better < error || faster < seconds)
    }
}

/// `trials` in the order of the variants: the reference, then ladder by ladder.
///
/// # Errors
/// When the rows of a table depend on the settings.
pub fn tables(stage: &Accuracy, trials: &[Trial], demand: &Demand) -> Result<Vec<Table>, String> {
    let (reference, tried) = trials.split_first().ok_or("nothing was run")?;
    let outputs = stage.reference.stage.outputs();
    let units: Vec<String> = stage.quantities.iter().map(|quantity| quantity.unit(&outputs)).collect();
    let mut rungs: Vec<Rung> = Vec::new();
    let mut spread: Vec<Row> = Vec::new();
    let mut trials = tried.iter();
    for ladder in &stage.ladders {
        let mut before: Vec<f64> = Vec::new();
        for (step, (variant, trial)) in ladder.steps.iter().zip(&mut trials).enumerate() {
            let refined = step.checked_sub(1).and_then(|coarser| variant.refined(&ladder.steps[coarser]));
            let mut errors = Vec::new();
            for (index, unit) in units.iter().enumerate() {
                let distance = median(trial, index, reference).map_err(|problem| {
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
                rungs.push(Rung { ladder, step, quantity: index, distance, order, trial });
                if trial.values.len() > 1 {
                    spread.push([key(stage, ladder, step, index), spread_row(trial, index, unit)?].concat());
                }
            }
            before = errors;
        }
    }
    let ladder = rungs.iter().map(|rung| {
        let others = rungs.iter().filter(|other| other.quantity == rung.quantity);
        let on_front = !others.into_iter().any(|other| rung.is_beaten_by(other));
        let Rung { distance, trial, .. } = rung;
        let mut row = key(stage, rung.ladder, rung.step, rung.quantity);
        row.extend([distance.row.as_str().into(), units[rung.quantity].as_str().into()]);
        let numbers = [
            distance.value,
            distance.reference,
            distance.absolute(),
            distance.relative(),
            rung.order,
            trial.evaluations,
            trial.seconds,
            trial.bytes / MEGABYTE,
        ];
        row.extend(numbers.map(Into::into));
        row.push(on_front.into());
        row
    });
    let rows = [
        ladder.collect(),
        spread,
        choices(stage, &rungs),
        vec![vec![
            stage.reference.written.as_str().into(),
            reference.seconds.into(),
            (reference.bytes / MEGABYTE).into(),
        ]],
    ];
    let wanted = schemas().into_iter().zip(rows).filter(|(schema, _)| demand.table(&schema.name));
    wanted.map(|(schema, rows)| Table::from_rows(schema, rows).map_err(|error| error.to_string())).collect()
}

fn key(stage: &Accuracy, ladder: &Ladder, step: usize, quantity: usize) -> Row {
    vec![
        ladder.name.as_str().into(),
        (step + 1).into(),
        stage.quantities[quantity].name.as_str().into(),
        ladder.steps[step].written.as_str().into(),
    ]
}

/// The distance of the seed in the middle.
fn median(trial: &Trial, quantity: usize, reference: &Trial) -> Result<Distance, String> {
    let converged = &reference.values[0][quantity];
    let one = |values: &Vec<Vec<quantity::Value>>| quantity::distance(&values[quantity], converged);
    let mut distances: Vec<Distance> = trial.values.iter().map(one).collect::<Result<_, _>>()?;
    distances.sort_by(|one, two| one.rank().total_cmp(&two.rank()));
    Ok(distances.swap_remove((distances.len() - 1) / 2))
}

fn spread_row(trial: &Trial, quantity: usize, unit: &str) -> Result<Row, String> {
    let mut values = Vec::new();
    for seed in &trial.values {
        let [only] = &seed[quantity][..] else {
            return Err(
                "with several seeds a quantity must be one row; name it with `table[key=value, …].column`".to_owned()
            );
        };
        values.push(only.value);
    }
    let mut row: Row = vec![unit.into(), values.len().into(), trial.evaluations.into()];
    row.extend([0.0, 0.25, 0.5, 0.75, 1.0].map(|share| quantile(&mut values, share).into()));
    Ok(row)
}

fn choices(stage: &Accuracy, rungs: &[Rung]) -> Vec<Row> {
    let mut rows: Vec<Row> = Vec::new();
    for (index, quantity) in stage.quantities.iter().enumerate() {
        for &wanted in &stage.wanted {
            let good = rungs.iter().filter(|rung| rung.quantity == index && rung.distance.rank() <= wanted);
            let best = good.min_by(|one, two| one.trial.seconds.total_cmp(&two.trial.seconds));
            let mut row: Row = vec![quantity.name.as_str().into(), wanted.into(), best.is_some().into()];
            row.extend(match best {
                Some(Rung { ladder, step, distance, trial, .. }) => [
                    ladder.name.as_str().into(),
                    ladder.steps[*step].written.as_str().into(),
                    distance.relative().into(),
                    trial.seconds.into(),
                ],
                None => ["".into(), "".into(), f64::NAN.into(), f64::NAN.into()],
            });
            rows.push(row);
        }
    }
    rows
}
