//! What is to be met: cells or formulas over them, and their published values.
//!
//! Must not know: what is varied, how the values are found.

use crate::stage::Inputs;
use crate::stage::formula::{Formula, Outcome};
use crate::stage::operand::names::{Operands, Shared, read_formula, read_operands};
use crate::stage::operand::rows::OperandRows;
use crate::stage::operand::{Operand, Source};
use crate::stage::quantity::Number;
use crate::stage::rows::output::Output;
use crate::stage::target::{Target, read_target};
use crate::stage::{Demand, Named};
use declare::Declared;
use declare::declared::Placed;
use declare::error::{Diagnostic, Place};
use declare::number::counted;
use declare::record::Record;
use declare::units::{Dimension, in_unit, parse_unit};
use studygraph::table::schema::Schema;
use studygraph::table::select::CellName;

/// A published number, or several in the order of the rows of a cell.
#[derive(Debug, Declared)]
pub struct Met {
    /// what it is, in words
    #[declared(example = "Mean stiffness")]
    pub label: Option<String>,
    /// where the paper says it: a table, an equation, a page
    #[declared(name = "where", example = "Table 3")]
    pub location: Option<String>,
    /// the computed cell, `stage.table[key=value, …].column`, or a column of several rows
    #[declared(example = "stiffness.summary.mean")]
    pub cell: Option<Placed<String>>,
    /// or arithmetic over the names in `with`
    #[declared(example = "double / single")]
    pub formula: Option<Placed<String>>,
    /// what the names in a formula stand for: cells or quantities
    #[declared(example = "stiffness.summary.mean")]
    pub with: Option<Vec<(String, Placed<String>)>>,
    /// the published value as printed, with its unit; of several rows as many values, with commas between
    #[declared(example = "4.2 um")]
    pub value: Placed<String>,
    /// how far apart counts as equal, and by which a difference is measured: `digits`, `1 %`, or a quantity
    #[declared(default = "digits")]
    pub tolerance: Placed<String>,
}

/// A stage and the tables that it has.
pub type Schemas = (String, Vec<Schema>);

enum Subject {
    Cell(Operand),
    Formula(Formula, Operands),
}

/// What is to be met.
pub struct Goal {
    label: String,
    pub location: String,
    subject: Subject,
    /// One, or one for each row.
    pub targets: Vec<Target>,
    place: Place,
}

impl Goal {
    /// Of these stages with their tables, which are computed anew; the last is the one that is asked.
    ///
    /// # Errors
    /// What is wrong with it, at its place.
    pub fn read(met: &Met, record: &Record, stages: &[Schemas]) -> Result<Self, Diagnostic> {
        let of = stages.last().map_or("stage", |(name, _)| name.as_str());
        let (subject, place) = match (&met.cell, &met.formula) {
            (Some(cell), None) => {
                if met.with.is_some() {
                    return Err(Diagnostic::new("`with` gives names to a `formula`, not to a `cell`")
                        .at(record.place_of(Met::NAMES.with)));
                }
                let operand = Operand::read(cell)?;
                if operand.cell().is_none() {
                    let message = format!("`{}` is not a cell; write `{of}.table[key=value, …].column`", cell.value);
                    return Err(Diagnostic::new(message).at(cell.place));
                }
                (Subject::Cell(operand), cell.place)
            }
            (None, Some(text)) => {
                let with = read_operands(met.with.as_deref().unwrap_or_default(), &[])?;
                let (formula, with) = read_formula(&text.value, with, &[], text.place, &Shared::default())?;
                if formula.is_claim() {
                    let message = format!("`{}` is true or false; a fit meets numbers", text.value);
                    return Err(Diagnostic::new(message).at(text.place));
                }
                if with.iter().all(|(_, operand)| operand.cell().is_none()) {
                    let message = format!("`{}` has no cell in it, so nothing that is varied changes it", text.value);
                    return Err(Diagnostic::new(message).at(text.place));
                }
                (Subject::Formula(formula, with), text.place)
            }
            _ => {
                let message = "what is to be met is one `cell` or one `formula`";
                return Err(Diagnostic::new(message).at(record.place));
            }
        };
        let mut targets: Vec<Target> = Vec::new();
        for piece in met.value.value.split(',') {
            let piece = Placed { value: piece.to_owned(), place: met.value.place };
            let dimension = targets.first().map(|first| first.stated.dimension);
            let target = read_target(&piece, &met.tolerance, dimension)?;
            if target.tolerance <= 0.0 {
                let message =
                    format!("a tolerance of 0 for `{}` leaves no measure of a difference", target.stated.text);
                return Err(Diagnostic::new(message)
                    .at(met.tolerance.place)
                    .help("write how far apart counts as equal"));
            }
            targets.push(target);
        }
        let trimmed = |text: &Option<String>| text.as_deref().unwrap_or_default().trim().to_owned();
        let goal = Self { label: trimmed(&met.label), location: trimmed(&met.location), subject, targets, place };
        for operand in goal.operands() {
            let Some(cell) = operand.cell() else { continue };
            let Some((_, schemas)) = stages.iter().find(|(name, _)| *name == cell.stage) else {
                let names = stages.iter().map(|(name, _)| format!("`{name}`")).collect::<Vec<_>>().join(", ");
                let message = format!("`{}` is no cell of what is computed anew: {names}", operand.text);
                return Err(Diagnostic::new(message)
                    .at(operand.place)
                    .help("name cells of these, or another stage with `of`"));
            };
            Self::output(operand, schemas)?;
        }
        if let Some(dimension) = goal.dimension(stages)? {
            let number = Number { si: f64::NAN, dimension };
            let fits = goal.targets[0].stated.check_dimension(number);
            fits.map_err(|message| Diagnostic::new(message).at(goal.targets[0].place))?;
        }
        Ok(goal)
    }

    /// What it is called: its label, or else what is met as written.
    pub fn label(&self) -> &str {
        if self.label.is_empty() { self.text() } else { &self.label }
    }

    /// The cell or formula as written.
    pub fn text(&self) -> &str {
        match &self.subject {
            Subject::Cell(operand) => &operand.text,
            Subject::Formula(formula, _) => &formula.text,
        }
    }

    fn operands(&self) -> impl Iterator<Item = &Operand> {
        let (cell, with) = match &self.subject {
            Subject::Cell(operand) => (Some(operand), [].as_slice()),
            Subject::Formula(_, with) => (None, with.as_slice()),
        };
        cell.into_iter().chain(with.iter().map(|(_, operand)| operand))
    }

    /// The cells that it names; one row each where one number is meant.
    pub fn named(&self) -> impl Iterator<Item = Named> {
        let is_one = self.targets.len() == 1 && matches!(self.subject, Subject::Cell(_));
        self.operands().filter_map(move |operand| {
            Some(Named {
                cell: operand.cell()?.clone(),
                place: operand.place,
                rows: operand.rows,
                is_one,
                beside: None,
            })
        })
    }

    /// A cell as an output of the stage.
    fn output(operand: &Operand, schemas: &[Schema]) -> Result<Output, Diagnostic> {
        let rest = operand.text.split_once('.').map_or("", |(_, rest)| rest);
        Output::read(&Placed { value: rest.to_owned(), place: operand.place }, schemas)
    }

    /// Adds what it needs of a stage's tables.
    pub fn ask(&self, (stage, schemas): &Schemas, demand: &mut Demand) {
        let of_stage = |operand: &&Operand| operand.cell().is_some_and(|cell| cell.stage == *stage);
        for operand in self.operands().filter(of_stage) {
            if let Ok(output) = Self::output(operand, schemas) {
                output.ask(schemas, demand);
            }
        }
    }

    fn dimension(&self, stages: &[Schemas]) -> Result<Option<Dimension>, Diagnostic> {
        let of_cell = |cell: &CellName| {
            let (_, schemas) = stages.iter().find(|(name, _)| *name == cell.stage)?;
            let schema = schemas.iter().find(|schema| schema.name == cell.table)?;
            parse_unit(&schema.column(&cell.column)?.unit).ok().map(|unit| unit.dimension)
        };
        match &self.subject {
            Subject::Cell(operand) => Ok(operand.cell().and_then(of_cell)),
            Subject::Formula(formula, with) => {
                let of_name = |name: &str| {
                    let (_, operand) = with.iter().find(|(known, _)| known == name)?;
                    match &operand.source {
                        Source::Cells(cell) => of_cell(cell),
                        Source::Quantities { numbers, .. } => numbers.first().map(|number| number.dimension),
                    }
                };
                formula.dimension(&of_name).map_err(|message| Diagnostic::new(message).at(self.place))
            }
        }
    }

    /// What is found, each in the unit of its target.
    ///
    /// # Errors
    /// A cell that is not there, or not as many rows as there are values.
    pub fn found(&self, inputs: &Inputs) -> Result<Vec<f64>, Diagnostic> {
        let numbers = match &self.subject {
            Subject::Cell(operand) => operand.resolve(inputs)?.numbers,
            Subject::Formula(formula, with) => {
                let rows = OperandRows::of(inputs, with)?;
                let value = rows.lookup(None);
                let one = |row: usize| match formula.evaluate(rows.names(row, &value)) {
                    Ok(Outcome::Number(number)) => Ok(number),
                    Ok(Outcome::Truth(_)) => Err(Diagnostic::new("a formula gives a number")),
                    Err(message) => Err(Diagnostic::new(message).at(self.place)),
                };
                (0..rows.judged(formula)).map(one).collect::<Result<_, _>>()?
            }
        };
        if numbers.len() != self.targets.len() {
            let (rows, values) = (numbers.len(), self.targets.len());
            let message = format!("`{}` names {}, and `value` has {values}", self.text(), counted(rows, "row"));
            return Err(Diagnostic::new(message)
                .at(self.place)
                .help("write as many values as there are rows, in their order"));
        }
        Ok(numbers.iter().zip(&self.targets).map(|(number, target)| in_unit(number.si, &target.stated.unit)).collect())
    }
}
