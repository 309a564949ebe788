//! Figures as declared: which columns of which tables, and the published values drawn beside them.
//!
//! Only the declaration is kept (and checked against the tables); the points are drawn from the tables themselves. Must
//! not know: how anything is drawn.

mod checks;
mod warned;

use super::stated_figure::{Best, How, Logarithmic, StatedFigure, StatedFigureNames, StatedMark, Width, check_map};
use crate::stage::quantity::read;
use crate::stage::{Ahead, Named};
use declare::declared::{Placed, Words};
use declare::error::Diagnostic;
use declare::record::{Record, Value};
use declare::text::is_device;
use declare::units::Dimension;
use studygraph::table::columns::Columns;
use studygraph::table::schema::Column;
use studygraph::table::select::CellName;

/// The column with the names of points.
const DESIGN: &str = "design";

/// A published point or line; lengths along the axes, in SI.
struct Mark {
    label: String,
    x: Option<Place>,
    y: Option<Place>,
}

struct Place {
    text: String,
    dimension: Dimension,
}

pub struct Figure {
    number: usize,
    name: String,
    /// As stated, for the places of its fields.
    record: Record,
    title: String,
    kind: How,
    /// Stage and table.
    tables: Vec<(String, String)>,
    x: String,
    y: Vec<String>,
    value: String,
    isolines: bool,
    best: Best,
    /// Stage and table of the named points, and their columns.
    marked: Option<(String, String)>,
    marked_columns: [String; 2],
    series: String,
    segments: String,
    length: String,
    labels: Vec<(String, String)>,
    width: Width,
    /// Stage and table.
    reference: Option<(String, String)>,
    conditions: Vec<(String, String)>,
    x_label: String,
    y_label: String,
    log: Logarithmic,
    published: Vec<Mark>,
    note: String,
}

impl Figure {
    /// # Errors
    /// What is wrong with it, at the place of the field.
    pub fn read(number: usize, stated: &StatedFigure, record: &Record) -> Result<Self, Diagnostic> {
        const NAMES: StatedFigureNames = StatedFigure::NAMES;
        let text = |text: &String| text.trim().to_owned();
        let maybe = |maybe: &Option<String>| maybe.as_ref().map(text).unwrap_or_default();
        let name = text(&stated.name);
        let fits = |character: char| character.is_ascii_alphanumeric() || matches!(character, '-' | '_');
        if name.is_empty() || name.len() > 60 || !name.chars().all(fits) {
            let message = format!("`{name}` is not a name for a file; use up to 60 letters, digits, - and _");
            return Err(Diagnostic::new(message).at(record.place_of(NAMES.name)));
        }
        if is_device(&name) {
            let message = format!("`{name}` is not a name for a file: Windows keeps it for a device");
            let help = format!("for example `{name}-figure`");
            return Err(Diagnostic::new(message).at(record.place_of(NAMES.name)).help(help));
        }
        let tables = stated.table.iter().map(read_table).collect::<Result<Vec<_>, _>>()?;
        let reference = stated.reference.as_ref().map(read_table).transpose()?;
        for (field, is_empty) in [(NAMES.table, tables.is_empty()), (NAMES.y, stated.y.is_empty())] {
            if is_empty {
                return Err(Diagnostic::new(format!("`{field}` is empty")).at(record.place_of(field)));
            }
        }
        let conditions = stated.conditions.iter().flatten();
        let marks = stated.published.iter().flatten().zip(record.each_inside(NAMES.published));
        let published = marks.map(|(mark, record)| read_mark(mark, record)).collect::<Result<_, _>>()?;
        if stated.kind == How::Drawing && stated.log != Logarithmic::None {
            let message = "a drawing that is true to scale has no logarithmic axis";
            return Err(Diagnostic::new(message).at(record.place_of(NAMES.log)));
        }
        check_map(stated, record)?;
        Ok(Self {
            number,
            name,
            record: record.clone(),
            title: text(&stated.title),
            kind: stated.kind,
            tables,
            x: text(&stated.x),
            y: stated.y.iter().map(text).collect(),
            value: maybe(&stated.value),
            isolines: stated.isolines,
            best: stated.best,
            marked: stated.marked.as_ref().map(read_table).transpose()?,
            marked_columns: [
                stated.marked_x.as_ref().map_or_else(|| text(&stated.x), text),
                stated.marked_y.as_ref().or(stated.y.first()).map(text).unwrap_or_default(),
            ],
            series: maybe(&stated.series),
            segments: maybe(&stated.segments),
            length: maybe(&stated.length),
            labels: stated.labels.iter().flatten().map(|(of, label)| (of.clone(), text(label))).collect(),
            width: stated.width,
            reference,
            conditions: conditions.map(|(column, value)| (column.clone(), text(value))).collect(),
            x_label: maybe(&stated.x_label),
            y_label: maybe(&stated.y_label),
            log: stated.log,
            published,
            note: maybe(&stated.note),
        })
    }

    /// Stage, table and columns that it draws.
    pub fn wants(&self) -> impl Iterator<Item = (&str, &str, Vec<&str>)> {
        let columns = || {
            let single = [&self.x, &self.value, &self.series, &self.segments, &self.length].map(String::as_str);
            let several = self.y.iter().chain(self.conditions.iter().map(|(column, _)| column)).map(String::as_str);
            single.into_iter().filter(|column| !column.is_empty()).chain(several).collect()
        };
        let tables = self.tables.iter().map(move |(stage, table)| (stage.as_str(), table.as_str(), columns()));
        let several = move || self.y.iter().chain(self.conditions.iter().map(|(column, _)| column)).map(String::as_str);
        let marked = move || self.marked_columns.iter().map(String::as_str).chain([DESIGN]).collect();
        tables
            .chain(
                self.reference
                    .iter()
                    .map(move |(stage, table)| (stage.as_str(), table.as_str(), several().collect::<Vec<&str>>())),
            )
            .chain(self.marked.iter().map(move |(stage, table)| (stage.as_str(), table.as_str(), marked())))
    }

    /// What it names of its tables: conditions that some rows must meet, one by one, and columns of numbers.
    pub fn named(&self) -> Vec<Named> {
        const NAMES: StatedFigureNames = StatedFigure::NAMES;
        let listed = |field: &str| match self.record.entry(field).map(|entry| &entry.value) {
            Some(Value::Map(placed)) => placed.iter().map(|(_, value)| value.place).collect(),
            Some(Value::List(placed)) => placed.iter().map(|value| value.place).collect(),
            _ => Vec::new(),
        };
        let conditions = self.conditions.iter().zip(listed(NAMES.conditions));
        let conditions = conditions.map(|(condition, place)| (vec![condition.clone()], String::new(), place));
        let x = (!self.has_words()).then(|| (self.x.clone(), self.record.place_of(NAMES.x)));
        let axes = x.into_iter().chain(self.y.iter().cloned().zip(listed(NAMES.y)));
        let all: Vec<_> = conditions.chain(axes.map(|(column, place)| (Vec::new(), column, place))).collect();
        let of_table = |(stage, table): &(String, String)| {
            let (stage, table) = (stage.clone(), table.clone());
            all.clone().into_iter().map(move |(conditions, column, place)| {
                let cell = CellName { stage: stage.clone(), table: table.clone(), conditions, column };
                Named { cell, place, rows: place, is_one: false, beside: None }
            })
        };
        self.tables.iter().flat_map(of_table).collect()
    }

    /// Whether its x axis may show words.
    fn has_words(&self) -> bool {
        matches!(self.kind, How::Bar | How::Tornado)
    }

    /// How many points it is drawn from, at most: which rows meet its conditions is not known.
    pub fn points(&self, ahead: &Ahead) -> u64 {
        let rows = self.tables.iter().map(|(stage, table)| ahead.rows(stage, table).count);
        rows.fold(0, u64::saturating_add).saturating_mul(self.y.len() as u64)
    }

    /// How many published points and lines it shows.
    pub fn marks(&self) -> usize {
        self.published.len()
    }

    /// As JSON: a name may have any character.
    fn labels(&self) -> String {
        if self.labels.is_empty() { String::new() } else { serde_json::json!(self.labels).to_string() }
    }

    fn conditions(&self) -> String {
        let conditions = self.conditions.iter().map(|(column, value)| format!("{column}={value}"));
        conditions.collect::<Vec<_>>().join(", ")
    }
}

fn read_table(Placed { value, place }: &Placed<String>) -> Result<(String, String), Diagnostic> {
    let text = value.trim();
    text.split_once('.')
        .filter(|(stage, table)| !stage.is_empty() && !table.is_empty())
        .map(|(stage, table)| (stage.to_owned(), table.to_owned()))
        .ok_or_else(|| Diagnostic::new(format!("`{text}` is not a table; write `stage.table`")).at(*place))
}

fn read_mark(stated: &StatedMark, record: &Record) -> Result<Mark, Diagnostic> {
    let place = |Placed { value: text, place }: &Placed<String>| {
        let wrong = |message: String| Diagnostic::new(message).at(*place);
        let quantity = read(text).map_err(|error| wrong(format!("`{text}`: {error}")))?;
        Ok(Place { text: text.trim().to_owned(), dimension: quantity.dimension })
    };
    let [x, y] = [&stated.x, &stated.y].map(|text| text.as_ref().map(place).transpose());
    let mark = Mark { label: stated.label.trim().to_owned(), x: x?, y: y? };
    if mark.x.is_none() && mark.y.is_none() {
        return Err(Diagnostic::new("a published point needs `x`, `y`, or both").at(record.place));
    }
    Ok(mark)
}

/// Figures that have the name of an earlier one: they would be one file.
pub fn twice(figures: &[Figure]) -> impl Iterator<Item = Diagnostic> {
    let earlier = |(index, figure): &(usize, &Figure)| {
        figures[..*index].iter().any(|earlier| earlier.name.eq_ignore_ascii_case(&figure.name))
    };
    figures.iter().enumerate().filter(earlier).map(|(_, figure)| {
        let place = figure.record.place_of(StatedFigure::NAMES.name);
        Diagnostic::new(format!("two figures are called `{}`", figure.name)).at(place)
    })
}

fn dotted<'a>(tables: impl IntoIterator<Item = &'a (String, String)>) -> String {
    let tables = tables.into_iter().map(|(stage, table)| format!("{stage}.{table}"));
    tables.collect::<Vec<_>>().join(", ")
}

#[must_use]
pub fn figures<'a>() -> Columns<&'a Figure> {
    let conditions = "The rows that are drawn, `column=value`, separated by commas.";
    Columns::new("figures", "Figures of the report: what is drawn from which table.")
        .integer("figure", "Number of the figure, in the order of the study.", |row: &&'a Figure| row.number)
        .key()
        .text("name", "Name of the file in `figures/`.", |row| row.name.as_str())
        .text("title", "What is shown.", |row| row.title.as_str())
        .text("kind", "Line, points, bar, drawing, map, front, chart, histogram, quantiles or tornado.", |row| {
            row.kind.word()
        })
        .text("tables", "The tables it is drawn from, `stage.table`, separated by commas.", |row| dotted(&row.tables))
        .text("x", "Column of the x axis.", |row| row.x.as_str())
        .text("y", "Columns of the y axis, separated by commas.", |row| row.y.join(", "))
        .text("value", "Column that a map shows as colours, or where the bars of a histogram end.", |row| {
            row.value.as_str()
        })
        .flag("isolines", "Whether a map has lines of one value.", |row| row.isolines)
        .text("best", "Which cell of a map is marked: none, smallest or largest.", |row| row.best.word())
        .text("marked", "The table of the points that are named.", |row| dotted(&row.marked))
        .text("marked_x", "Its column for the x axis.", |row| row.marked_columns[0].as_str())
        .text("marked_y", "Its column for the y axis.", |row| row.marked_columns[1].as_str())
        .text("series", "Column whose values are drawn apart.", |row| row.series.as_str())
        .text("segments", "Column at whose changes a line is interrupted.", |row| row.segments.as_str())
        .text("length", "Column of the length that x stands for.", |row| row.length.as_str())
        .text("labels", "What values are called, pairs of a value and its name in JSON.", |row| row.labels())
        .text("width", "Page or column of a journal.", |row| row.width.word())
        .text("reference", "The table from whose values the relative distance is drawn.", |row| dotted(&row.reference))
        .text("conditions", conditions, |row| row.conditions())
        .text("x_label", "Name of the x axis, if not that of the column.", |row| row.x_label.as_str())
        .text("y_label", "Name of the y axis, if not that of the column.", |row| row.y_label.as_str())
        .text("log", "Axes with a logarithmic scale: none, x, y, both.", |row| row.log.word())
        .text("note", "What to see in it.", |row| row.note.as_str())
}

/// A published point or line in the units of its figure's axes.
pub struct MarkRow<'a> {
    figure: usize,
    number: usize,
    label: &'a str,
    x: f64,
    y: f64,
}

#[must_use]
pub fn marks<'a>() -> Columns<MarkRow<'a>> {
    Columns::new("figure_published", "Published points and lines drawn into the figures.")
        .integer("figure", "Number of the figure.", |row: &MarkRow<'a>| row.figure)
        .key()
        .integer("number", "Number of the point in the figure.", |row| row.number)
        .key()
        .text("label", "Name in the legend.", |row| row.label)
        .float("x", "", "Place on the x axis in the axis' unit; NaN for a line across.", |row| row.x)
        .but(Column::allows_nan)
        .float("y", "", "Place on the y axis in the axis' unit; NaN for an upright line.", |row| row.y)
        .but(Column::allows_nan)
}
