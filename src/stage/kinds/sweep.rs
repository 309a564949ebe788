//! `kind: sweep`: what a stage gives for many designs: any number of the study, of the stage or of one that it reads, with
//! many values.
//!
//! Rows are computed in parts that are kept by themselves; pairs and compliances are found once and used in order. Must not
//! know: how a transmission error is found.

mod draw;
mod effects;
mod layout;
mod method;
mod tables;

use self::effects::Effects;
use self::layout::Layout;
use self::method::Method;
use crate::stage::formula::Formula;
use crate::stage::rows::computed::REASON;
use crate::stage::rows::gathered::{Gathered, RowParts, Rows, Tally};
use crate::stage::rows::{Asked, Question};
use crate::stage::{Kind, RowCount, Stage};
use declare::Declared;
use declare::declared::{Declared, Placed};
use declare::digest::Writer;
use declare::error::{Diagnostic, Faults, suggest};
use declare::record::Record;
use declare::record::varied::Varied;
use studygraph::table::schema::{Column, Schema};

pub const KIND: Kind = Kind {
    name: "sweep",
    version: 1,
    summary: Stated::MEMBER.summary,
    fields: Stated::MEMBER.fields,
    curves: &[],
    example: "
kind: sweep
of: ste
vary:
  amount: { field: \"modification.designs.relieved[0].tip_relief.amount\", from: 0 um, to: 20 um, count: 5 }
  torque: { field: ste.torque, values: [25 N m, 50 N m, 100 N m] }
outputs: [peak_to_peak, mean, \"harmonics[order=1].amplitude\"]
",
    build,
};

/// What a stage gives for very many designs: any fields of it and of what it reads with many values, row by row.
#[derive(Debug, Declared)]
struct Stated {
    /// The stage whose numbers are asked; it and what it reads are as in the study but for what is varied.
    #[declared(kinds = ["ste", "stiffness"])]
    pub of: String,
    /// Which combinations of values are taken.
    #[declared(default = "grid")]
    pub method: Method,
    /// Names of columns, and the fields and values that stand in them.
    #[declared(varies = Stated::NAMES.of)]
    pub vary: Varied,
    /// Which rows are taken: a formula over the names of `vary` that is true there.
    #[declared(name = "where", example = "relief < 20")]
    pub filter: Option<Placed<String>>,
    /// Columns of the stage's tables: `column` of its summary, `table.column` or `table[key=value, …].column`.
    #[declared(example = "peak_to_peak")]
    pub outputs: Vec<Placed<String>>,
    /// The design that is meant, where the stage is given several.
    #[declared(example = "long")]
    pub design: Option<Placed<String>>,
    /// Which of the outputs is to be small: for the table of the best rows; the first one when it is not said.
    #[declared(example = "peak_to_peak")]
    pub minimize: Option<Placed<String>>,
    /// How many rows the table of the best has.
    #[declared(minimum = 1, maximum = 10_000, default = "20")]
    pub best: usize,
}

/// Those of its fields that say which rows there are, and what is made of all of them.
const OF_ROWS: &[&str] =
    &[Stated::NAMES.vary, Stated::NAMES.method, Stated::NAMES.filter, Stated::NAMES.minimize, Stated::NAMES.best];

/// The column of a drawn row's number.
const NUMBER: &str = "sample";

/// A sweep.
pub struct Sweep {
    asked: Asked,
    layout: Layout,
    /// Index of the output that is to be small.
    objective: usize,
    best: usize,
}

fn build(record: &Record) -> Result<Box<dyn Stage>, Faults> {
    let stated = Stated::checked(record)?;
    let nothing = |field: &str| Err(Diagnostic::new(format!("`{field}` is empty")).at(record.place_of(field)).into());
    if stated.vary.axes.is_empty() {
        return nothing(Stated::NAMES.vary);
    }
    if stated.outputs.is_empty() {
        return nothing(Stated::NAMES.outputs);
    }
    let question = Question {
        of: &stated.of,
        varied: stated.vary.clone(),
        outputs: &stated.outputs,
        design: stated.design.as_ref(),
        reserved: &[NUMBER, REASON],
    };
    let prepared = question.prepared()?;
    let layout = Layout::new(prepared.columns.clone(), stated.method, filter(&stated)?)?;
    let drawn = layout.is_drawn();
    let number = Column::integer(NUMBER, "Counts the designs in the order in which they are drawn, from 1.").key();
    let leading = if drawn { vec![number] } else { Vec::new() };
    let (asked, varied) = prepared.asked(leading, |_| !drawn)?;
    let objective = match &stated.minimize {
        None => 0,
        Some(text) => {
            let names = || asked.outputs.iter().map(|output| output.column.name.as_str());
            names().position(|name| name == text.value).ok_or_else(|| {
                let help = suggest(&text.value, names().collect::<Vec<_>>());
                Diagnostic::new(format!("`{}` is none of the outputs", text.value)).at(text.place).help(help)
            })?
        }
    };
    let sweep = Sweep { asked, layout, objective, best: stated.best };
    Ok(Box::new(sweep.cut(&varied)))
}

fn filter(stated: &Stated) -> Result<Option<(Formula, declare::error::Place)>, Diagnostic> {
    let Some(text) = &stated.filter else { return Ok(None) };
    let names: Vec<&str> = stated.vary.axes.iter().map(|axis| axis.name.as_str()).collect();
    let formula = Formula::parse(&text.value, &names).map_err(|problem| Diagnostic::new(problem).at(text.place))?;
    if !formula.is_claim() {
        let message = format!("`{}` is a number; `where` is true or false", formula.text);
        return Err(Diagnostic::new(message).at(text.place).help("for example `where: \"amount <= 0.01 * length\"`"));
    }
    Ok(Some((formula, text.place)))
}

impl Sweep {
    fn cut(self, varied: &Varied) -> Rows<Self> {
        let mut shared = Writer::new("gearstudy 1 sweep rows");
        varied.write_shared(&mut shared);
        shared.flag(self.layout.is_drawn()).count(self.layout.columns.len());
        for column in &self.layout.columns {
            shared.text(&column.axis.name);
        }
        let mut all = Writer::new("gearstudy 1 sweep of all");
        all.count(self.objective).count(self.best);
        Rows::new(self, OF_ROWS, shared, all)
    }
}

impl Gathered for Sweep {
    const SECONDS_OF_ROW: f64 = 1e-6;
    const PASSES: usize = 2;

    fn asked(&self) -> &Asked {
        &self.asked
    }

    fn layout(&self) -> &impl RowParts {
        &self.layout
    }

    fn is_random(&self) -> bool {
        self.layout.uses_seed()
    }

    fn schemas(&self) -> Vec<Schema> {
        effects::schemas(self)
    }

    fn foreseen(&self) -> Vec<RowCount> {
        effects::foreseen(self)
    }

    fn held(&self) -> u64 {
        effects::held(self)
    }

    fn tally(&self) -> Box<dyn Tally + '_> {
        Box::new(Effects::new(self))
    }
}
