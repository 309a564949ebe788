//! `kind: accuracy`: error against cost of another stage's settings, measured against settings that have converged.
//!
//! Ladders are lists of settings, each a few fields that stand in the place of the other stage's own. Every variant is
//! that stage, built by its kind and run with the inputs it would have in the study; of its tables only the asked
//! quantities are compared. Must not know: any kind by name, or what a quantity means.

mod quantity;
mod tables;
mod trial;
mod variant;

use crate::stage::{Ahead, Context, Demand, Estimate, Inputs, Kind, Port, RowCount, Stage};
use declare::Declared;
use declare::declared::{Declared, Placed};
use declare::error::{Diagnostic, Failure, Faults};
use declare::record::{self, Record};
use declare::units::RATIO;
use quantity::Quantity;
use studygraph::table::data::Table;
use studygraph::table::schema::Schema;
use studygraph::warning::Warning;
use trial::{Plan, Trial};
use variant::Variant;

pub const KIND: Kind = Kind {
    name: "accuracy",
    version: 1,
    summary: Stated::MEMBER.summary,
    fields: Stated::MEMBER.fields,
    curves: &[],
    example: "
kind: accuracy
of: ste
quantities: [summary.peak_to_peak, summary.mean]
reference: { positions: 512 }
ladders:
  positions: [{ positions: 8 }, { positions: 16 }, { positions: 32 }]
",
    build,
};

/// Error and cost of a stage's settings against converged ones, and the cheapest that meet an accuracy.
#[derive(Debug, Declared)]
struct Stated {
    /// The stage whose settings are tried; it reads there what it reads in the study.
    #[declared(kinds = [])]
    pub of: String,
    /// Columns of its tables, `table.column` or `table[key=value, …].column`; of several rows the worst one counts.
    #[declared(example = "summary.peak_to_peak")]
    pub quantities: Vec<Placed<String>>,
    /// The settings that count as converged.
    #[declared(overrides = Stated::NAMES.of)]
    pub reference: record::Variant,
    /// Settings to try, in lists with names of their own, from coarse to fine.
    #[declared(overrides = Stated::NAMES.of)]
    pub ladders: Vec<(String, Vec<record::Variant>)>,
    /// A column of its tables that counts its work; of several rows the sum counts.
    #[declared(example = "summary.evaluations")]
    pub evaluations: Option<Placed<String>>,
    /// How often each run of a ladder is repeated; the median time counts.
    #[declared(minimum = 1, maximum = 1000, default = "3")]
    pub repeats: usize,
    /// With how many seeds a stage that draws random numbers is run.
    #[declared(minimum = 1, maximum = 1000, default = "1")]
    pub seeds: usize,
    /// Relative accuracies for which the cheapest setting is looked for.
    #[declared(minimum = 1e-15, maximum = 10.0, dimension = RATIO, default = "[1 %, 0.1 %, 0.01 %]")]
    pub wanted: Vec<f64>,
}

struct Accuracy {
    quantities: Vec<Quantity>,
    evaluations: Option<Quantity>,
    reference: Variant,
    ladders: Vec<Ladder>,
    plan: Plan,
    wanted: Vec<f64>,
}

/// Settings from coarse to fine.
struct Ladder {
    name: String,
    steps: Vec<Variant>,
}

fn build(record: &Record) -> Result<Box<dyn Stage>, Faults> {
    let stated = Stated::checked(record)?;
    let reference = Variant::build("reference".to_owned(), &stated.reference)?;
    let mut ladders = Vec::new();
    for (name, settings) in stated.ladders {
        let step = |(step, setting)| Variant::build(format!("{name} {step}"), setting);
        let steps = (1..).zip(&settings).map(step).collect::<Result<_, _>>()?;
        ladders.push(Ladder { name, steps });
    }
    if ladders.iter().all(|ladder| ladder.steps.is_empty()) {
        return Err(Diagnostic::new("the ladders are empty").at(record.place_of(Stated::NAMES.ladders)).into());
    }
    let variants = || ladders.iter().flat_map(|ladder| &ladder.steps).chain([&reference]);
    let read = |text: &Placed<String>| {
        let quantity = Quantity::read(&text.value).map_err(|problem| Diagnostic::new(problem).at(text.place))?;
        for variant in variants() {
            quantity.check(&variant.stage.outputs()).map_err(|found| found.at(text.place))?;
        }
        Ok::<_, Diagnostic>(quantity)
    };
    let mut quantities: Vec<Quantity> = Vec::new();
    for text in &stated.quantities {
        let quantity = read(text)?;
        if quantities.iter().any(|other| other.name == quantity.name) {
            return Err(Diagnostic::new(format!("`{}` is listed twice", quantity.name)).at(text.place).into());
        }
        quantities.push(quantity);
    }
    if quantities.is_empty() {
        return Err(Diagnostic::new("no quantities are given").at(record.place_of(Stated::NAMES.quantities)).into());
    }
    let evaluations = stated.evaluations.as_ref().map(read).transpose()?;
    let mut wanted = stated.wanted;
    wanted.sort_by(f64::total_cmp);
    wanted.dedup();
    let plan = Plan { repeats: stated.repeats, seeds: stated.seeds };
    Ok(Box::new(Accuracy { quantities, evaluations, reference, ladders, plan, wanted }))
}

impl Accuracy {
    /// All variants, the reference first.
    fn variants(&self) -> Vec<&Variant> {
        [&self.reference].into_iter().chain(self.ladders.iter().flat_map(|ladder| &ladder.steps)).collect()
    }

    /// Of the tables only those with an asked quantity.
    fn demand(&self) -> Demand {
        let mut demand = Demand::default();
        let schemas = self.reference.stage.outputs();
        for quantity in self.quantities.iter().chain(&self.evaluations) {
            quantity.ask(&schemas, &mut demand);
        }
        demand
    }
}

impl Stage for Accuracy {
    fn inputs(&self) -> Vec<Port> {
        variant::ports(&self.variants()).into_iter().map(|(port, _)| port).collect()
    }

    fn outputs(&self) -> Vec<Schema> {
        tables::schemas()
    }

    fn estimate(&self, asked: &Demand, ahead: &Ahead) -> Estimate {
        let variants = self.variants();
        let (ports, demand) = (variant::ports(&variants), self.demand());
        let steps = variants.len() - 1;
        let compared = RowCount::exact(steps * self.quantities.len());
        let mut all = Estimate::new(true);
        let mut maximum = 0;
        for (index, variant) in variants.iter().enumerate() {
            let runs = if index == 0 { 1 } else { self.plan.runs(variant.stage.as_ref()) };
            let one = variant.stage.estimate(&demand, &variant::ahead(&ports, index, ahead));
            maximum = maximum.max(one.memory);
            all.seconds += runs as f64 * one.seconds;
        }
        for schema in tables::schemas() {
            let rows = match schema.name.as_str() {
                "spread" if !self.uses_seed() || self.plan.seeds == 1 => RowCount::NONE,
                "choice" => RowCount::exact(self.quantities.len() * self.wanted.len()),
                "reference" => RowCount::exact(1),
                _ => compared,
            };
            all = all.rows(asked, schema, rows);
        }
        all.holding(maximum)
    }

    fn uses_seed(&self) -> bool {
        self.variants().iter().any(|variant| variant.stage.uses_seed())
    }

    fn runs_alone(&self) -> bool {
        true
    }

    fn run(&self, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let variants = self.variants();
        let ports = variant::ports(&variants);
        let demand = self.demand();
        // The reference is there to be compared with: one run, and one seed, will do.
        let once = Plan { repeats: 1, seeds: 1 };
        let plan = |index: usize| if index == 0 { &once } else { &self.plan };
        let runs = |(index, variant): (usize, &&Variant)| plan(index).runs(variant.stage.as_ref());
        let total = variants.iter().enumerate().map(runs).sum::<usize>() as f64;
        let mut done = 0;
        let mut trials: Vec<Trial> = Vec::new();
        for (index, variant) in variants.iter().enumerate() {
            let inputs = variant::inputs(&ports, index, inputs);
            let (reached, share) = (done as f64 / total, runs((index, variant)) as f64 / total);
            let progress = |part: f64| (context.progress)((reached + share * part).min(1.0));
            // What a coarse setting warns of is in the ladder's own columns.
            let warn: &(dyn Fn(Warning) + Sync) = if index == 0 { context.warn } else { &|_| () };
            let is_heard = context.is_heard && index == 0;
            let inner = Context { demand: &demand, progress: &progress, warn, is_heard, ..*context };
            let asked = (self.quantities.as_slice(), self.evaluations.as_ref());
            trials.push(trial::run(variant, plan(index), asked, &inner, &inputs)?);
            done += runs((index, variant));
        }
        tables::tables(self, &trials, context.demand).map_err(Failure::new)
    }
}

#[cfg(test)]
mod tests;
