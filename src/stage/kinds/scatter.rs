//! `kind: scatter`: what a stage gives where fields of the study, or of what it reads, are not quite what they should be.
//!
//! Samples are computed in parts that are kept by themselves, as the rows of a sweep are. Must not know: how a transmission
//! error is found.

mod correlation;
mod distributions;
mod layout;
mod results;
mod tables;

use self::correlation::{Copula, Correlation};
use self::layout::{Layout, Method};
use self::results::{Results, SHARES};
use crate::stage::limit::Limit;
use crate::stage::rows::computed::REASON;
use crate::stage::rows::gathered::{Gathered, RowParts, Rows, Tally};
use crate::stage::rows::{Asked, Column as Field, Question};
use crate::stage::{Kind, Omission, RowCount, Stage};
use declare::Declared;
use declare::declared::{Declared, Placed};
use declare::digest::Writer;
use declare::error::{Diagnostic, Faults};
use declare::record::Record;
use declare::record::varied::Varied;
use declare::units::RATIO;
use gearmesh::numeric::distribution::Distribution;
use gearmesh::numeric::replicates::REPLICATES;
use gearmesh::optimize::sobol::MOST_VARIABLES;
use studygraph::table::schema::{Column, Schema};

pub const KIND: Kind = Kind {
    name: "scatter",
    version: 1,
    summary: Stated::MEMBER.summary,
    fields: Stated::MEMBER.fields,
    curves: &[],
    example: "
kind: scatter
of: ste
vary:
  amount: { field: \"modification.designs.relieved[0].tip_relief.amount\", within: ± 2 um }
  tilt: { field: ste.helix_slope, normal: 5 um }
  torque: { field: ste.torque, values: [25 N m, 50 N m] }
samples: 128
indices: 64
outputs: [peak_to_peak]
limits: [peak_to_peak <= 3 um]
",
    build,
};

/// How the numbers of a stage scatter where fields are not quite what they should be: samples, quantiles, yields, indices.
#[derive(Debug, Declared)]
struct Stated {
    /// The stage whose numbers are asked; it and what it reads are as in the study but for what is varied.
    #[declared(kinds = ["ste", "stiffness"])]
    pub of: String,
    /// Names of columns, with fields and how they are distributed; at `values` of a field every sample is looked at.
    #[declared(varies = Stated::NAMES.of)]
    pub vary: Varied,
    /// Where samples come from.
    #[declared(default = "sobol")]
    pub method: Method,
    /// How many samples are drawn.
    #[declared(minimum = 16, maximum = 1_000_000_000, default = "1024")]
    pub samples: usize,
    /// How many of them also come with each field as another point has it, for Sobol' indices; 0 for none.
    #[declared(minimum = 0, maximum = 100_000_000, default = "512")]
    pub indices: usize,
    /// Which fields go together, and how closely.
    pub correlations: Option<Vec<Correlation>>,
    /// Columns of the stage's tables: `column` of its summary, `table.column` or `table[key=value, …].column`.
    #[declared(example = "peak_to_peak")]
    pub outputs: Vec<Placed<String>>,
    /// What the outputs should keep to; the table `yield` says how many samples do.
    #[declared(example = "peak_to_peak <= 1 um")]
    pub limits: Option<Vec<Placed<String>>>,
    /// Shares of the samples whose quantiles are found; 1, 5, 25, 50, 75, 95 and 99 % unless it is said.
    #[declared(minimum = 0.0, maximum = 1.0, dimension = RATIO, axis = usize::MAX, example = "99.7 %")]
    pub quantiles: Option<Vec<f64>>,
    /// The design that is meant, where the stage is given several.
    #[declared(example = "long")]
    pub design: Option<Placed<String>>,
}

/// Those of its fields that say which rows there are, and what is made of all of them.
const OF_ROWS: &[&str] = &[
    Stated::NAMES.vary,
    Stated::NAMES.method,
    Stated::NAMES.samples,
    Stated::NAMES.indices,
    Stated::NAMES.correlations,
    Stated::NAMES.limits,
    Stated::NAMES.quantiles,
];

/// The columns that tell rows apart, beside those that every sample is looked at with.
const NUMBER: &str = "sample";
const REPLACED: &str = "replaced";

/// A scatter.
pub struct Scatter {
    asked: Asked,
    layout: Layout,
    limits: Vec<Limit>,
    shares: Vec<f64>,
    /// Whether indices were wanted and cannot be.
    is_correlated: bool,
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
        reserved: &[NUMBER, REPLACED, REASON, "output", "share", "field", "limit", "case", "bin"],
    };
    let prepared = question.prepared()?;
    let distributions: Vec<Option<Distribution>> = prepared
        .columns
        .iter()
        .map(|column| distributions::of_column(column, &prepared.varied))
        .collect::<Result<_, _>>()?;
    let drawn: Vec<&Field> =
        prepared.columns.iter().zip(&distributions).filter_map(|(column, found)| found.map(|_| column)).collect();
    if drawn.is_empty() {
        return Err(Diagnostic::new("nothing is distributed: all that is varied has values")
            .at(record.place_of(Stated::NAMES.vary))
            .help("write for example `within: ± 2 um`; combinations of values are `kind: sweep`")
            .into());
    }
    let correlations = stated.correlations.as_deref().unwrap_or_default();
    let copula = Copula::new(correlations, &drawn)?;
    let pairs = if copula.is_some() { 0 } else { stated.indices };
    if pairs > 0 && pairs < 2 * REPLICATES {
        let message = format!("`indices` is {pairs}; with fewer than {} they have no errors", 2 * REPLICATES);
        let help = "take more, or 0 for none";
        return Err(Diagnostic::new(message).at(record.place_of(Stated::NAMES.indices)).help(help).into());
    }
    // Pairs of points have twice as many coordinates.
    if stated.method == Method::Sobol && 2 * drawn.len() > MOST_VARIABLES {
        let message =
            format!("Sobol points are tabulated for at most {} fields here, not {}", MOST_VARIABLES / 2, drawn.len());
        let place = record.place_of(Stated::NAMES.vary);
        return Err(Diagnostic::new(message).at(place).help("use `method: latin_hypercube`").into());
    }
    let layout = Layout::new(&prepared.columns, &distributions, stated.method, [stated.samples, pairs], copula.clone());
    let number = Column::integer(NUMBER, "Counts the samples in the order in which they are drawn, from 1.").key();
    let replaced = "0 for the sample itself; otherwise counts the field that another point has, in the order of the \
                    columns, and after them all fields together.";
    let leading = vec![number, Column::integer(REPLACED, replaced).key()];
    let is_key: Vec<bool> = distributions.iter().map(Option::is_none).collect();
    let names: Vec<String> = prepared.columns.iter().map(|column| column.axis.name.clone()).collect();
    let keyed = |column: &Field| names.iter().position(|name| *name == column.axis.name).is_some_and(|at| is_key[at]);
    let (asked, varied) = prepared.asked(leading, keyed)?;
    let columns: Vec<(&str, &str)> =
        asked.outputs.iter().map(|output| (output.column.name.as_str(), output.column.unit.as_str())).collect();
    let limits = stated.limits.iter().flatten().map(|text| Limit::read(&text.value, text.place, &columns));
    let limits = Faults::collect(limits)?;
    let shares = stated.quantiles.clone().unwrap_or_else(|| SHARES.to_vec());
    let is_correlated = copula.is_some() && stated.indices > 0;
    let scatter = Scatter { asked, layout, limits, shares, is_correlated };
    Ok(Box::new(scatter.cut(&varied)))
}

impl Scatter {
    /// The columns that are distributed, and those at whose values every sample is looked at.
    fn drawn(&self) -> impl Iterator<Item = &Field> {
        self.asked.columns.iter().enumerate().filter(|(at, _)| !self.layout.is_crossed(*at)).map(|(_, column)| column)
    }

    fn crossed(&self) -> impl Iterator<Item = &Field> {
        self.asked.columns.iter().enumerate().filter(|(at, _)| self.layout.is_crossed(*at)).map(|(_, column)| column)
    }

    fn cut(self, varied: &Varied) -> Rows<Self> {
        let mut shared = Writer::new("gearstudy 1 scatter rows");
        varied.write_shared(&mut shared);
        for column in &self.asked.columns {
            shared.text(&column.axis.name);
        }
        let mut all = Writer::new("gearstudy 1 scatter of all");
        all.count(self.layout.samples).count(self.layout.pairs).floats(&self.shares).count(self.limits.len());
        for limit in &self.limits {
            all.text(&limit.text);
        }
        Rows::new(self, OF_ROWS, shared, all)
    }
}

impl Gathered for Scatter {
    const SECONDS_OF_ROW: f64 = 1e-6;
    const PASSES: usize = 1;

    fn asked(&self) -> &Asked {
        &self.asked
    }

    fn layout(&self) -> &impl RowParts {
        &self.layout
    }

    fn is_random(&self) -> bool {
        true
    }

    fn schemas(&self) -> Vec<Schema> {
        results::schemas(self)
    }

    fn foreseen(&self) -> Vec<RowCount> {
        results::foreseen(self)
    }

    fn held(&self) -> u64 {
        results::held(self)
    }

    fn not_made(&self) -> Option<Omission> {
        let why = "fields are correlated, and what one of them explains by itself is then not defined";
        self.is_correlated.then(|| Omission::new("Sobol' indices", why))
    }

    fn tally(&self) -> Box<dyn Tally + '_> {
        Box::new(Results::new(self))
    }
}
