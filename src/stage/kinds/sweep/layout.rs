//! The rows of a sweep: their order, their values, and the parts into which they are cut.
//!
//! Rows of a grid or a list come in the order of their values, what takes longest to change first; drawn ones in the order
//! in which they are drawn. No list of all rows is ever made. Must not know: what is computed of a row.

use super::draw::{Draw, Span};
use super::method::Method;
use crate::stage::RowCount;
use crate::stage::formula::{Formula, Names, Outcome};
use crate::stage::quantity::Number;
use crate::stage::rows::gathered::RowParts;
use crate::stage::rows::values::{Level, RowSet, level};
use crate::stage::rows::{Column, follows_nothing, rows_of_part};
use declare::digest::{Digest, Writer};
use declare::error::{Diagnostic, Failure, Place};
use declare::number::counted;
use declare::record::varied::{Axis, Values};
use declare::seed::Seed;
use declare::units::RATIO;
use gearmesh::optimize::sobol::MOST_VARIABLES;
use std::ops::Range;
use studygraph::stage::parts;

/// More rows than that are refused: a slip is likelier.
const MOST_IN_ALL: usize = 1_000_000_000;

/// All rows of a sweep.
#[derive(Debug)]
pub struct Layout {
    /// In the order of the table.
    pub columns: Vec<Column>,
    rows: Rows,
    filter: Option<Formula>,
    /// Units of each part.
    parts: Vec<Range<usize>>,
}

#[derive(Debug)]
enum Rows {
    /// By column the values, ascending. The columns from `split` on are in every unit as a whole.
    Grid { levels: Vec<Vec<Level>>, split: usize },
    /// A unit each.
    Listed(Vec<Vec<Level>>),
    /// A unit each.
    Drawn { method: Method, spans: Vec<Span> },
}

impl Layout {
    /// # Errors
    /// Values that do not go with the method, or with each other; a filter that cannot be evaluated.
    pub fn new(columns: Vec<Column>, method: Method, filter: Option<(Formula, Place)>) -> Result<Self, Diagnostic> {
        let rows = match method {
            Method::Grid => grid(&columns)?,
            Method::Zip => zip(&columns)?,
            _ => drawn(&columns, method)?,
        };
        let (filter, place) = filter.unzip();
        let mut layout = Self { columns, rows, filter, parts: Vec::new() };
        layout.parts = layout.cut();
        if let Some(place) = place {
            let first: Vec<f64> = layout.columns.iter().map(|column| first(&column.axis.values)).collect();
            layout.passes(&first).map_err(|problem| Diagnostic::new(problem).at(place))?;
        }
        Ok(layout)
    }

    /// Whether rows are known by the number under which they were drawn.
    pub fn is_drawn(&self) -> bool {
        matches!(self.rows, Rows::Drawn { .. })
    }

    pub fn uses_seed(&self) -> bool {
        matches!(self.rows, Rows::Drawn { method: Method::LatinHypercube(_) | Method::Random(_), .. })
    }

    /// The values of a column, where it has no more than those.
    pub fn levels(&self, column: usize) -> Option<Vec<Level>> {
        match &self.rows {
            Rows::Grid { levels, .. } => Some(levels[column].clone()),
            Rows::Listed(rows) => {
                let mut levels: Vec<Level> = rows.iter().map(|row| row[column]).collect();
                levels.sort_by(|one, two| one.shown.total_cmp(&two.shown));
                levels.dedup_by(|one, two| one.shown.to_bits() == two.shown.to_bits());
                Some(levels)
            }
            Rows::Drawn { spans, .. } => match &spans[column] {
                Span::Of(levels) => Some(levels.clone()),
                Span::Between { .. } => None,
            },
        }
    }

    /// Between which values a column is drawn, as shown.
    pub fn drawn_between(&self, column: usize) -> Option<[f64; 2]> {
        match &self.rows {
            Rows::Drawn { spans, .. } => match &spans[column] {
                Span::Between { low, high, unit, .. } => Some([level(*low, unit).shown, level(*high, unit).shown]),
                Span::Of(_) => None,
            },
            _ => None,
        }
    }

    /// Rows of all parts before the filter.
    pub fn count(&self) -> usize {
        self.units() * self.of_unit()
    }

    fn units(&self) -> usize {
        match &self.rows {
            Rows::Grid { levels, split } => levels[..*split].iter().map(Vec::len).product(),
            Rows::Listed(rows) => rows.len(),
            Rows::Drawn { method, .. } => method.samples().unwrap_or(0),
        }
    }

    /// Rows of a unit.
    fn of_unit(&self) -> usize {
        match &self.rows {
            Rows::Grid { levels, split } => levels[*split..].iter().map(Vec::len).product(),
            _ => 1,
        }
    }

    fn cut(&self) -> Vec<Range<usize>> {
        let each = (rows_of_part(self.count()) / self.of_unit()).max(1);
        if self.is_drawn() {
            let units = self.units();
            return (0..units.div_ceil(each)).map(|part| part * each..units.min((part + 1) * each)).collect();
        }
        parts::cut(self.units(), each, |unit| {
            let mut writer = Writer::new("gearstudy 1 sweep cut");
            write(&self.unit(unit), &mut writer);
            writer.finish()
        })
    }

    /// The values that all rows of a unit have.
    fn unit(&self, unit: usize) -> Vec<Level> {
        match &self.rows {
            Rows::Grid { levels, split } => digits(&levels[..*split], unit),
            Rows::Listed(rows) => rows[unit].clone(),
            Rows::Drawn { .. } => Vec::new(),
        }
    }

    fn passes(&self, row: &[f64]) -> Result<bool, String> {
        let Some(filter) = &self.filter else { return Ok(true) };
        let value = |name: &str, _| {
            let column = self.columns.iter().position(|column| column.axis.name == name)?;
            Some(Number { si: row[column], dimension: self.columns[column].axis.dimension.unwrap_or(RATIO) })
        };
        match filter.evaluate(Names { value: &value, row: 0, rows: 1 })? {
            Outcome::Truth(passes) => Ok(passes),
            Outcome::Number(_) => Err("`where` is true or false, not a number".to_owned()),
        }
    }
}

impl RowParts for Layout {
    fn parts(&self) -> usize {
        self.parts.len()
    }

    /// What is in a part: its rows, whatever others there are.
    fn digest(&self, part: usize) -> Digest {
        let mut writer = Writer::new("gearstudy 1 sweep part");
        writer.text(self.filter.as_ref().map_or("", |filter| &filter.text));
        let range = self.parts[part].clone();
        match &self.rows {
            Rows::Grid { levels, split } => {
                for levels in &levels[*split..] {
                    writer.floats(&levels.iter().map(|level| level.shown).collect::<Vec<_>>());
                }
            }
            Rows::Listed(_) => {}
            Rows::Drawn { method, spans } => {
                writer.text(method.name()).count(range.start).count(range.end);
                // The strata follow from how many there are; the other sequences do not.
                writer.count(if let Method::LatinHypercube(one) = method { one.samples } else { 0 });
                for span in spans {
                    match span {
                        Span::Between { low, high, .. } => writer.text("between").float(*low).float(*high),
                        Span::Of(levels) => writer.floats(&levels.iter().map(|level| level.shown).collect::<Vec<_>>()),
                    };
                }
                return writer.finish();
            }
        }
        writer.count(range.len());
        for unit in range {
            write(&self.unit(unit), &mut writer);
        }
        writer.finish()
    }

    /// Those that pass the filter; an error where it cannot be evaluated.
    fn rows(&self, part: usize, seed: &Seed) -> Result<RowSet, Failure> {
        let range = self.parts[part].clone();
        let mut rows = RowSet::new(usize::from(self.is_drawn()), self.columns.len());
        let kept = |rows: &mut RowSet| -> Result<(), Failure> {
            let passes = self.passes(rows.si(rows.len() - 1)).map_err(Failure::new)?;
            if !passes {
                rows.pop();
            }
            Ok(())
        };
        match &self.rows {
            Rows::Grid { levels, split } => {
                let inner = self.of_unit();
                for unit in range {
                    let outer = self.unit(unit);
                    for index in 0..inner {
                        let inner = digits(&levels[*split..], index);
                        rows.push(&[], outer.iter().copied().chain(inner));
                        kept(&mut rows)?;
                    }
                }
            }
            Rows::Listed(all) => {
                for unit in range {
                    rows.push(&[], all[unit].iter().copied());
                    kept(&mut rows)?;
                }
            }
            Rows::Drawn { method, spans } => {
                let draw = Draw::new(*method, spans.len(), seed);
                let mut point = vec![0.0; spans.len()];
                for number in range {
                    draw.point(number, &mut point);
                    rows.push(&[number + 1], spans.iter().zip(&point).map(|(span, share)| span.at(*share)));
                    kept(&mut rows)?;
                }
            }
        }
        Ok(rows)
    }

    fn row_count(&self, part: Option<usize>) -> RowCount {
        let count = part.map_or_else(|| self.count(), |part| self.parts[part].len() * self.of_unit());
        if self.filter.is_some() { RowCount::at_most(count) } else { RowCount::exact(count) }
    }
}

fn write(levels: &[Level], writer: &mut Writer) {
    for level in levels {
        writer.float(level.shown);
    }
}

fn first(values: &Values) -> f64 {
    match values {
        Values::Each(values) => values[0],
        Values::Between(low, _) => *low,
        Values::Spread(spread) => spread.about,
        // Refused before.
        Values::Follows(_) => f64::NAN,
    }
}

/// The digits of a number, the last column fastest.
fn digits(levels: &[Vec<Level>], mut number: usize) -> Vec<Level> {
    let mut found = vec![Level { si: 0.0, shown: 0.0 }; levels.len()];
    for (slot, levels) in found.iter_mut().zip(levels).rev() {
        *slot = levels[number % levels.len()];
        number /= levels.len();
    }
    found
}

fn each(column: &Column, method: &str) -> Result<Vec<Level>, Diagnostic> {
    let Axis { name, unit, values, values_place, .. } = &column.axis;
    match values {
        Values::Each(values) => Ok(values.iter().map(|si| level(*si, unit)).collect()),
        Values::Between(..) => {
            Err(Diagnostic::new(format!("`{name}` has no values of its own, as `{method}` needs them"))
                .at(*values_place)
                .help("add a `count`, write its `values`, or take `method: { sobol: { samples: … } }`"))
        }
        Values::Spread(_) => Err(no_distribution(column)),
        Values::Follows(_) => Err(follows_nothing(column)),
    }
}

fn no_distribution(column: &Column) -> Diagnostic {
    Diagnostic::new(format!("`{}` has a distribution, and a sweep takes values", column.axis.name))
        .at(column.axis.values_place)
        .help("write its `values`, or `from` and `to`; distributions are for `kind: scatter`")
}

fn too_many() -> Diagnostic {
    Diagnostic::new(format!("there are more than {MOST_IN_ALL} combinations"))
        .help("take fewer values, or draw some at random")
}

fn grid(columns: &[Column]) -> Result<Rows, Diagnostic> {
    let mut all = Vec::new();
    for column in columns {
        let mut levels = each(column, "grid")?;
        levels.sort_by(|one, two| one.shown.total_cmp(&two.shown));
        if let Some(pair) = levels.windows(2).find(|pair| pair[0].shown.to_bits() == pair[1].shown.to_bits()) {
            let Axis { name, unit, values_place, .. } = &column.axis;
            let shown = format!("{} {unit}", pair[0].shown);
            return Err(Diagnostic::new(format!("`{name}` has the value {} twice", shown.trim())).at(*values_place));
        }
        all.push(levels);
    }
    let count = all.iter().try_fold(1_usize, |count, levels| count.checked_mul(levels.len()));
    let count = count.filter(|count| *count <= MOST_IN_ALL).ok_or_else(too_many)?;
    let target = rows_of_part(count);
    let (mut split, mut inner) = (all.len(), 1);
    while split > 0 && inner * all[split - 1].len() <= target {
        split -= 1;
        inner *= all[split].len();
    }
    Ok(Rows::Grid { levels: all, split })
}

fn zip(columns: &[Column]) -> Result<Rows, Diagnostic> {
    let all = columns.iter().map(|column| each(column, "zip")).collect::<Result<Vec<_>, _>>()?;
    let count = all.first().map_or(0, Vec::len);
    if let Some((column, levels)) = columns.iter().zip(&all).find(|(_, levels)| levels.len() != count) {
        let (name, first) = (&column.axis.name, &columns[0].axis.name);
        let message = format!(
            "`{name}` has {} and `{first}` {count}; `zip` takes as many of each",
            counted(levels.len(), "value")
        );
        return Err(Diagnostic::new(message).at(column.axis.values_place));
    }
    let mut rows: Vec<Vec<Level>> = (0..count).map(|row| all.iter().map(|levels| levels[row]).collect()).collect();
    let order = |one: &Vec<Level>, two: &Vec<Level>| {
        let pairs = one.iter().zip(two).map(|(one, two)| one.shown.total_cmp(&two.shown));
        pairs.fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
    };
    rows.sort_by(order);
    let twice = rows.iter().zip(&rows[1..]).find(|(one, two)| order(one, two).is_eq());
    if let Some((row, _)) = twice {
        let shown = columns.iter().zip(row).map(|(column, level)| {
            format!("{} = {} {}", column.axis.name, level.shown, column.axis.unit).trim().to_owned()
        });
        let message = format!("two designs are the same: {}", shown.collect::<Vec<_>>().join(", "));
        return Err(Diagnostic::new(message).at(columns[0].axis.values_place));
    }
    Ok(Rows::Listed(rows))
}

fn drawn(columns: &[Column], method: Method) -> Result<Rows, Diagnostic> {
    if matches!(method, Method::Sobol(_)) && columns.len() > MOST_VARIABLES {
        let message = format!("Sobol points are tabulated for at most {MOST_VARIABLES} fields, not {}", columns.len());
        return Err(Diagnostic::new(message).at(columns[MOST_VARIABLES].axis.place).help("use `latin_hypercube`"));
    }
    if let Some(column) = columns.iter().find(|column| matches!(column.axis.values, Values::Spread(_))) {
        return Err(no_distribution(column));
    }
    if let Some(column) = columns.iter().find(|column| matches!(column.axis.values, Values::Follows(_))) {
        return Err(follows_nothing(column));
    }
    let span = |column: &Column| match &column.axis.values {
        // Both were refused.
        Values::Follows(_) => Span::Of(Vec::new()),
        Values::Spread(spread) => Span::Of(vec![level(spread.about, &column.axis.unit)]),
        Values::Between(low, high) => Span::Between {
            low: *low,
            high: *high,
            whole: column.axis.multiple.map(|multiple| multiple as f64),
            unit: column.axis.unit.clone(),
        },
        Values::Each(values) => Span::Of(values.iter().map(|si| level(*si, &column.axis.unit)).collect()),
    };
    Ok(Rows::Drawn { method, spans: columns.iter().map(span).collect() })
}
