//! A declared figure and the tables it names, made into a plot.
//!
//! Must not know: SVG, HTML. A jump is kept a jump: a line is interrupted where the declared column changes, and where
//! two points share an abscissa.

use super::cells::Cells;
use super::order::Order;
use super::plot::{Axis, Kind, Mark, Named, Of, Plot, Series};
use super::spec::Spec;
use super::{ReportError, Tables, floats, integers, texts};
use crate::report::look::{Line, Look};
use declare::number::{significant, with_unit};
use declare::units::{in_unit, parse_quantity};
use studygraph::table::data::{Data, Table};
use studygraph::table::select::rows_where;

/// The column by which a table of curves says how each is drawn.
const LINE: &str = "line";

/// A plot with its name and remark.
pub struct Figure {
    pub name: String,
    pub note: String,
    pub plot: Plot,
    /// The tables it is drawn from.
    pub tables: String,
    /// Whether an axis shows what differs from run to run.
    pub varies: bool,
}

/// Reads the tables `figures` and `figure_published` of a report stage.
///
/// # Errors
/// When a table or column is missing or unfit.
pub fn figures(
    declared: &Table,
    published: &Table,
    order: &Order,
    tables: Tables<'_>,
) -> Result<Vec<Figure>, ReportError> {
    let one = |row: usize| {
        let spec = Spec::read(declared, row)?;
        let mut figure = figure(&spec, order, tables)?;
        figure.plot.marks = marks(published, spec.number)?;
        figure.plot.lost += figure.plot.marks.iter().filter(|mark| figure.plot.loses(mark.x, mark.y)).count();
        Ok(figure)
    };
    (0..declared.rows()).map(one).collect()
}

/// A figure without published values.
///
/// # Errors
/// When a table or column is missing or unfit.
pub fn figure(spec: &Spec, order: &Order, tables: Tables<'_>) -> Result<Figure, ReportError> {
    let Spec { kind, x, y: ys, conditions, .. } = spec;
    let reference = match spec.reference.as_str() {
        "" => None,
        name => Some(tables(name).ok_or_else(|| ReportError::Missing(name.to_owned()))?),
    };
    let mut drawing = Drawing::default();
    let mut varies = false;
    let mut plot = Plot::new(&spec.title, *kind);
    for name in &spec.tables {
        let table = tables(name).ok_or_else(|| ReportError::Missing(name.clone()))?;
        let rows = rows_where(&table, conditions).map_err(ReportError::Unfit)?;
        let volatile = |name: &str| table.schema().column(name).is_some_and(|column| column.volatile);
        let read = [x, &spec.series, &spec.segments, &spec.value, &spec.length].into_iter().chain(ys);
        varies |= read.chain(conditions.iter().map(|(column, _)| column)).any(|column| volatile(column));
        plot.x.unit = unit(&table, x);
        plot.y.unit = ys.first().map_or_else(String::new, |y| unit(&table, y));
        if table.rows() == 0 {
            plot.without_rows.push(name.clone());
        }
        if *kind == Kind::Map {
            plot.cells = cells(spec, &table, &rows)?;
            continue;
        }
        for y in ys {
            let stage = name.split('.').next().unwrap_or(name);
            let column =
                spec.labels.iter().find(|(known, _)| known == y).map_or_else(|| plain(y), |label| label.1.clone());
            let names = [(spec.tables.len() > 1).then(|| spec.label(stage)), (ys.len() > 1).then_some(column)];
            let first = drawing.series.len();
            drawing.add(spec, &table, &rows, y, &names)?;
            drawing.series[first..].sort_by_cached_key(|series| (series.line, order.rank(spec, &series.raw)));
            if let Some(reference) = &reference {
                drawing.relate(first, value_of(reference, conditions, y)?);
                plot.y.unit.clear();
            }
        }
        if !spec.length.is_empty() {
            plot.length = length(spec, &table, &rows, &plot.y.unit)?;
        }
    }
    plot.named = named(spec, tables)?;
    drawing.order_categories(spec, order);
    if *kind == Kind::Quantiles {
        let value = |of: &Of| if let Of::Quantity { value, .. } = of { Some(*value) } else { None };
        let share = |series: &Series| series.of.iter().find_map(value).unwrap_or(f64::NAN);
        drawing.series.sort_by(|one, two| share(one).total_cmp(&share(two)));
    }
    let label = |given: &str, column: &str| if given.is_empty() { sentence(column) } else { given.to_owned() };
    let y_column = ys.first().map_or("", String::as_str);
    let [x_log, y_log] = spec.is_log;
    plot.x = Axis { label: label(&spec.x_label, x), is_log: x_log && *kind != Kind::Bar, ..plot.x };
    plot.y = Axis { label: label(&spec.y_label, y_column), is_log: y_log, ..plot.y };
    plot.size = spec.size;
    plot.categories = drawing.categories.into_iter().map(|name| spec.label(&name)).collect();
    plot.series = drawing.series;
    plot.lie_down();
    if !matches!(*kind, Kind::Drawing | Kind::Histogram | Kind::Quantiles | Kind::Tornado) {
        plot.series = plot.series.into_iter().map(interrupted).collect();
    }
    let tables = spec.tables.join(", ");
    // Before those that nobody could tell apart are left out.
    let points = plot.series.iter().flat_map(|series| series.runs.iter().flatten());
    let places = points.copied().chain(plot.named.iter().map(|named| named.place));
    plot.lost = places.filter(|point| plot.loses(Some(point.0), Some(point.1))).count();
    Ok(Figure { name: spec.name.clone(), note: spec.note.clone(), plot: plot.thinned(), tables, varies })
}

/// The published points and lines of a figure.
fn marks(published: &Table, number: i64) -> Result<Vec<Mark>, ReportError> {
    let (owners, labels) = (integers(published, "figure")?, texts(published, "label")?);
    let (x, y) = (floats(published, "x")?, floats(published, "y")?);
    let some = |value: f64| value.is_finite().then_some(value);
    let own = (0..published.rows()).filter(|&mark| owners[mark] == number);
    let mark =
        |mark: usize| Mark { label: labels[mark].clone(), x: some(x[mark]), y: some(y[mark]), look: Look::ink(0) };
    Ok(own.map(mark).collect())
}

/// The points that are named.
fn named(spec: &Spec, tables: Tables<'_>) -> Result<Vec<Named>, ReportError> {
    let [name, x, y] = &spec.marked;
    if name.is_empty() {
        return Ok(Vec::new());
    }
    let table = tables(name).ok_or_else(|| ReportError::Missing(name.clone()))?;
    let column = |name: &str| table.column(name).ok_or_else(|| missing(&table, name));
    let (names, xs, ys) = (texts(&table, "design")?, column(x)?, column(y)?);
    let one = |row: usize| {
        let place = (number(&table, x, xs, row)?, number(&table, y, ys, row)?);
        Ok(Named { name: spec.label(&names[row]), place })
    };
    (0..table.rows()).map(one).collect()
}

/// The cells of a map.
fn cells(spec: &Spec, table: &Table, rows: &[usize]) -> Result<Option<Cells>, ReportError> {
    let column = |name: &str| table.column(name).ok_or_else(|| missing(table, name));
    let y = spec.y.first().map_or("", String::as_str);
    let [x_data, y_data, values] = [column(&spec.x)?, column(y)?, column(&spec.value)?];
    let point = |&row: &usize| {
        let place = (number(table, &spec.x, x_data, row)?, number(table, y, y_data, row)?);
        Ok((place.0, place.1, number(table, &spec.value, values, row)?))
    };
    let points: Vec<(f64, f64, f64)> = rows.iter().map(point).collect::<Result<_, ReportError>>()?;
    let label = spec.labels.iter().find(|(known, _)| *known == spec.value);
    let label = label.map_or_else(|| sentence(&spec.value), |label| label.1.clone());
    let cells = Cells::new(&points, label, unit(table, &spec.value));
    Ok(cells.map(|cells| Cells { isolines: spec.isolines, best: spec.best, ..cells }))
}

/// How long a unit of the x axis is, in the unit of the y axis; `None` where that is not one length everywhere.
fn length(spec: &Spec, table: &Table, rows: &[usize], y_unit: &str) -> Result<Option<f64>, ReportError> {
    let column = |name: &str| table.column(name).ok_or_else(|| missing(table, name));
    let (x_data, lengths) = (column(&spec.x)?, column(&spec.length)?);
    let place = |row: usize| Ok((number(table, &spec.x, x_data, row)?, number(table, &spec.length, lengths, row)?));
    let mut found: Option<f64> = None;
    for pair in rows.windows(2) {
        let (from, to) = (place(pair[0])?, place(pair[1])?);
        let ratio = (to.1 - from.1) / (to.0 - from.0);
        // Where another line begins, or two points share a place, nothing is to be learnt.
        if !ratio.is_finite() || to.0 <= from.0 {
            continue;
        }
        if found.is_some_and(|found| (ratio / found - 1.0).abs() > 1e-6) {
            return Ok(None);
        }
        found = found.or(Some(ratio));
    }
    let unit = unit(table, &spec.length);
    let in_y = |length: f64| parse_quantity(&format!("{length:e} {unit}")).ok().map(|long| in_unit(long.value, y_unit));
    Ok(found.and_then(in_y).filter(|length| length.is_finite() && *length > 0.0))
}

/// The value of a column in the only row that meets the conditions.
fn value_of(table: &Table, conditions: &[(String, String)], column: &str) -> Result<f64, ReportError> {
    let data = table.column(column).ok_or_else(|| missing(table, column))?;
    match rows_where(table, conditions).map_err(ReportError::Unfit)?[..] {
        [row] => number(table, column, data, row),
        _ => Err(ReportError::Unfit(format!("table `{}` has not one row to compare with", table.name()))),
    }
}

fn unit(table: &Table, column: &str) -> String {
    table.schema().column(column).map(|column| column.unit.clone()).unwrap_or_default()
}

/// `peak_to_peak` as words.
fn plain(column: &str) -> String {
    column.replace('_', " ")
}

/// `peak_to_peak` as words with a capital.
pub fn sentence(column: &str) -> String {
    let words = plain(column);
    let mut characters = words.chars();
    characters.next().map_or_else(String::new, |first| first.to_uppercase().chain(characters).collect())
}

#[derive(Default)]
struct Drawing {
    series: Vec<Series>,
    categories: Vec<String>,
}

impl Drawing {
    /// Adds the points of some rows; `names` are those of stage and column, where there are several.
    fn add(
        &mut self,
        spec: &Spec,
        table: &Table,
        rows: &[usize],
        y: &str,
        names: &[Option<String>; 2],
    ) -> Result<(), ReportError> {
        let Spec { x, series, segments, .. } = spec;
        let column = |name: &str| table.column(name).ok_or_else(|| missing(table, name));
        let (x_data, y_data) = (column(x)?, column(y)?);
        let series_data = if series.is_empty() { None } else { Some(column(series)?) };
        let segment_data = if segments.is_empty() { None } else { Some(column(segments)?) };
        // Of a histogram each row is a bar, which ends somewhere.
        let ends = if spec.kind == Kind::Histogram { Some(column(&spec.value)?) } else { None };
        let lines = table.column(LINE).filter(|_| spec.kind == Kind::Drawing);
        let own = self.series.len();
        let mut segment: Vec<Option<String>> = Vec::new();
        for &row in rows {
            let raw = series_data.map(|data| shown(data, row, &unit(table, series))).unwrap_or_default();
            let known = (own..self.series.len()).find(|&index| self.series[index].raw == raw);
            let at = known.unwrap_or_else(|| {
                let [stage, column] = names;
                let is_named = stage.is_some() || column.is_some();
                let value = (!is_named || !raw.is_empty()).then(|| spec.label(&raw));
                let said: Vec<&str> = [stage, column, &value].into_iter().flatten().map(String::as_str).collect();
                let number = series_data.and_then(|data| number(table, series, data, row).ok());
                let of_value = value.clone().map(|word| match number {
                    Some(value) => Of::Quantity { column: series.clone(), value },
                    None => Of::Word(word),
                });
                let word = |name: &Option<String>| name.clone().map(Of::Word);
                let of = [word(stage), of_value, word(column)].into_iter().flatten().collect();
                let label = said.join(", ");
                let line = lines.and_then(|data| Line::named(&data.cell(row).to_string()));
                self.series.push(Series { raw, of, line, ..Series::new(&label, Vec::new()) });
                segment.push(None);
                self.series.len() - 1
            });
            let x = if matches!(spec.kind, Kind::Bar | Kind::Tornado) {
                self.category(shown(x_data, row, &unit(table, x)))
            } else {
                number(table, x, x_data, row)?
            };
            let point = (x, number(table, y, y_data, row)?);
            if let Some(ends) = ends {
                let end = number(table, &spec.value, ends, row)?;
                self.series[at].runs.push(vec![point, (end, point.1)]);
                continue;
            }
            let current = segment_data.map(|data| data.cell(row).to_string());
            let is_new = self.series[at].runs.is_empty() || segment[at - own] != current;
            if is_new {
                self.series[at].runs.push(Vec::new());
            }
            segment[at - own] = current;
            if let Some(run) = self.series[at].runs.last_mut() {
                run.push(point);
            }
        }
        Ok(())
    }

    /// The y of the series from `first` on as their relative distance from `reference`.
    fn relate(&mut self, first: usize, reference: f64) {
        for (_, y) in self.series[first..].iter_mut().flat_map(|series| &mut series.runs).flatten() {
            *y = (*y / reference - 1.0).abs();
        }
    }

    fn category(&mut self, name: String) -> f64 {
        let at = self.categories.iter().position(|category| *category == name).unwrap_or_else(|| {
            self.categories.push(name);
            self.categories.len() - 1
        });
        at as f64
    }

    /// Names under the bars in the order of the study.
    fn order_categories(&mut self, spec: &Spec, order: &Order) {
        let mut places: Vec<usize> = (0..self.categories.len()).collect();
        places.sort_by_cached_key(|&place| order.rank_in(&spec.x, spec, &self.categories[place]));
        self.categories = places.iter().map(|&place| self.categories[place].clone()).collect();
        if spec.kind != Kind::Bar {
            return;
        }
        for point in self.series.iter_mut().flat_map(|series| &mut series.runs).flatten() {
            // Both are counts.
            if let Some(at) = places.iter().position(|&place| (place as f64 - point.0).abs() < 0.5) {
                point.0 = at as f64;
            }
        }
    }
}

fn missing(table: &Table, column: &str) -> ReportError {
    ReportError::Unfit(format!("table `{}` has no column `{column}`", table.name()))
}

fn number(table: &Table, name: &str, data: &Data, row: usize) -> Result<f64, ReportError> {
    match data {
        Data::Float(values) => Ok(values[row]),
        Data::Integer(values) => Ok(values[row] as f64),
        _ => Err(ReportError::Unfit(format!("column `{name}` of table `{}` holds no numbers", table.name()))),
    }
}

fn shown(data: &Data, row: usize, unit: &str) -> String {
    match data {
        Data::Float(values) => with_unit(&significant(values[row], 6), unit),
        other => other.cell(row).to_string(),
    }
}

/// Splits runs where the line jumps at one place: two points (nearly) above each other, far apart.
fn interrupted(series: Series) -> Series {
    let span = |pick: fn(&(f64, f64)) -> f64| {
        let values = series.runs.iter().flatten().map(pick).filter(|value| value.is_finite());
        let (low, high) =
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        high - low
    };
    let (width, height) = (span(|point| point.0), span(|point| point.1));
    let mut runs: Vec<Vec<(f64, f64)>> = Vec::new();
    for run in series.runs {
        let mut current: Vec<(f64, f64)> = Vec::new();
        for point in run {
            if let Some(last) = current.last()
                && (point.0 - last.0).abs() <= 1e-6 * width
                && (point.1 - last.1).abs() > 5e-3 * height
            {
                runs.push(std::mem::take(&mut current));
            }
            current.push(point);
        }
        runs.push(current);
    }
    Series { runs, ..series }
}

#[cfg(test)]
mod tests {
    use super::*;
    use studygraph::table::data::Row;
    use studygraph::table::schema::{Column, Schema};

    fn declared(columns: &[(&str, &str)]) -> Table {
        let schema = vec![Column::integer("figure", "Number.").key(), Column::flag("isolines", "A flag.")];
        let texts = columns.iter().map(|(name, _)| Column::text(name, "A word."));
        let row: Row =
            [1.into(), false.into()].into_iter().chain(columns.iter().map(|(_, word)| (*word).into())).collect();
        Table::from_rows(Schema::new("figures", "Figures.", schema.into_iter().chain(texts).collect()), vec![row])
            .unwrap()
    }

    #[test]
    fn values_are_drawn_as_their_distance_from_a_reference() {
        let marks = vec![
            Column::integer("figure", "Number.").key(),
            Column::integer("number", "Number.").key(),
            Column::text("label", "A word."),
            Column::float("x", "", "A place.").allows_nan(),
            Column::float("y", "", "A place.").allows_nan(),
        ];
        let marks = Table::from_rows(Schema::new("figure_published", "Marks.", marks), Vec::new()).unwrap();
        let table = |name: &str| {
            let columns =
                vec![Column::float("seconds", "s", "Time.").volatile(), Column::float("k", "N/m", "Stiffness.")];
            let row: Row = match name {
                "one.summary" => vec![0.5.into(), 3.0e8.into()],
                "two.summary" => vec![2.0.into(), 1.9e8.into()],
                "best.summary" => vec![9.0.into(), 2.0e8.into()],
                _ => return None,
            };
            Some(Table::from_rows(Schema::new("summary", "Summary.", columns), vec![row]).unwrap().into())
        };
        let words = |reference| {
            [
                ("name", "f"),
                ("title", "t"),
                ("kind", "points"),
                ("value", ""),
                ("length", ""),
                ("labels", ""),
                ("best", "none"),
                ("marked", ""),
                ("marked_x", ""),
                ("marked_y", ""),
                ("width", "page"),
                ("tables", "one.summary, two.summary"),
                ("x", "seconds"),
                ("y", "k"),
                ("series", ""),
                ("segments", ""),
                ("reference", reference),
                ("conditions", ""),
                ("x_label", ""),
                ("y_label", ""),
                ("log", "both"),
                ("note", ""),
            ]
        };
        let drawn = |reference| {
            figures(&declared(&words(reference)), &marks, &Order::default(), &table)
                .map(|mut found| found.remove(0).plot)
        };
        let plot = drawn("best.summary").unwrap();
        let points: Vec<(f64, f64)> = plot.series.iter().flat_map(|series| series.runs.concat()).collect();
        assert_eq!(plot.y.unit, "");
        assert_eq!(points.len(), 2);
        for (point, (x, y)) in points.into_iter().zip([(0.5, 0.5), (2.0, 0.05)]) {
            assert!((point.0 - x).abs() < 1e-15 && (point.1 - y).abs() < 1e-15, "{point:?}");
        }
        assert_eq!(drawn("").unwrap().y.unit, "N/m");
        assert!(drawn("none.summary").err().unwrap().to_string().contains("none.summary"));
    }
}
