//! A declared figure and the tables it names, made into a plot.
//!
//! Must not know: SVG, HTML. A jump is kept a jump: a line is interrupted where the declared column changes, and where
//! two points share an abscissa.

use super::plot::{Axis, Kind, Mark, Plot, Series};
use super::{ReportError, floats, integers, texts};
use declare::number::{significant, with_unit};
use studygraph::table::data::{Data, Table};
use studygraph::table::select::{parse_conditions, rows_where};

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
    tables: &dyn Fn(&str) -> Option<Table>,
) -> Result<Vec<Figure>, ReportError> {
    (0..declared.rows()).map(|row| figure(declared, row, published, tables)).collect()
}

fn figure(
    declared: &Table,
    row: usize,
    published: &Table,
    tables: &dyn Fn(&str) -> Option<Table>,
) -> Result<Figure, ReportError> {
    let text = |column: &str| texts(declared, column).map(|values| values[row].as_str());
    let number = integers(declared, "figure")?[row];
    let words =
        |text: &str| -> Vec<String> { text.split(", ").filter(|word| !word.is_empty()).map(str::to_owned).collect() };
    let kind = match text("kind")? {
        "bar" => Kind::Bar,
        "points" => Kind::Points,
        "drawing" => Kind::Drawing,
        _ => Kind::Line,
    };
    let log = text("log")?;
    let (x, ys) = (text("x")?, words(text("y")?));
    let names = words(text("tables")?);
    let conditions = parse_conditions(text("conditions")?).map_err(ReportError::Unfit)?;
    let reference = match text("reference")? {
        "" => None,
        name => Some(tables(name).ok_or_else(|| ReportError::Missing(name.to_owned()))?),
    };
    let mut drawing = Drawing::default();
    let mut varies = false;
    let (mut x_unit, mut y_unit) = (String::new(), String::new());
    for name in &names {
        let table = tables(name).ok_or_else(|| ReportError::Missing(name.clone()))?;
        let rows = rows_where(&table, &conditions).map_err(ReportError::Unfit)?;
        for y in &ys {
            let stage = name.split('.').next().unwrap_or(name);
            let prefix = match (names.len() > 1, ys.len() > 1) {
                (true, true) => format!("{stage}, {}", plain(y)),
                (true, false) => stage.to_owned(),
                (false, true) => plain(y),
                (false, false) => String::new(),
            };
            let first = drawing.series.len();
            let volatile = |name: &str| table.schema().column(name).is_some_and(|column| column.volatile);
            let read = [x, y, text("series")?, text("segments")?];
            varies |= read.into_iter().chain(conditions.iter().map(|(column, _)| column.as_str())).any(volatile);
            drawing.add(&table, &rows, kind, read, &prefix)?;
            x_unit.clone_from(&unit(&table, x));
            y_unit.clone_from(&unit(&table, y));
            if let Some(reference) = &reference {
                drawing.relate(first, value_of(reference, &conditions, y)?);
                y_unit.clear();
            }
        }
    }
    let (owners, labels) = (integers(published, "figure")?, texts(published, "label")?);
    let (mark_x, mark_y) = (floats(published, "x")?, floats(published, "y")?);
    let some = |value: f64| value.is_finite().then_some(value);
    let marks = (0..published.rows()).filter(|&mark| owners[mark] == number);
    let marks =
        marks.map(|mark| Mark { label: labels[mark].clone(), x: some(mark_x[mark]), y: some(mark_y[mark]) }).collect();
    let label = |given: &str, column: &str| if given.is_empty() { sentence(column) } else { given.to_owned() };
    let y_column = ys.first().map_or("", String::as_str);
    let plot = Plot {
        title: text("title")?.to_owned(),
        kind,
        x: Axis {
            label: label(text("x_label")?, x),
            unit: x_unit,
            is_log: matches!(log, "x" | "both") && kind != Kind::Bar,
        },
        y: Axis { label: label(text("y_label")?, y_column), unit: y_unit, is_log: matches!(log, "y" | "both") },
        series: if kind == Kind::Drawing {
            drawing.series
        } else {
            drawing.series.into_iter().map(interrupted).collect()
        },
        marks,
        categories: drawing.categories,
    };
    Ok(Figure {
        name: text("name")?.to_owned(),
        note: text("note")?.to_owned(),
        plot: plot.thinned(),
        tables: names.join(", "),
        varies,
    })
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

fn sentence(column: &str) -> String {
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
    /// Adds the points of some rows; `columns` are x, y, series, segments, the last two empty when there are none.
    fn add(
        &mut self,
        table: &Table,
        rows: &[usize],
        kind: Kind,
        columns: [&str; 4],
        prefix: &str,
    ) -> Result<(), ReportError> {
        let [x, y, series, segments] = columns;
        let column = |name: &str| table.column(name).ok_or_else(|| missing(table, name));
        let (x_data, y_data) = (column(x)?, column(y)?);
        let series_data = if series.is_empty() { None } else { Some(column(series)?) };
        let segment_data = if segments.is_empty() { None } else { Some(column(segments)?) };
        let own = self.series.len();
        let mut segment: Vec<Option<String>> = Vec::new();
        for &row in rows {
            let value = series_data.map(|data| shown(data, row, &unit(table, series)));
            let label = match (prefix.is_empty(), value) {
                (true, value) => value.unwrap_or_default(),
                (false, None) => prefix.to_owned(),
                (false, Some(value)) => format!("{prefix}, {value}"),
            };
            let at = (own..self.series.len()).find(|&index| self.series[index].label == label).unwrap_or_else(|| {
                self.series.push(Series { label, runs: Vec::new() });
                segment.push(None);
                self.series.len() - 1
            });
            let x = if kind == Kind::Bar {
                self.category(shown(x_data, row, &unit(table, x)))
            } else {
                number(table, x, x_data, row)?
            };
            let point = (x, number(table, y, y_data, row)?);
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
        let schema = vec![Column::integer("figure", "Number.").key()];
        let texts = columns.iter().map(|(name, _)| Column::text(name, "A word."));
        let row: Row = std::iter::once(1.into()).chain(columns.iter().map(|(_, word)| (*word).into())).collect();
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
            Some(Table::from_rows(Schema::new("summary", "Summary.", columns), vec![row]).unwrap())
        };
        let words = |reference| {
            [
                ("name", "f"),
                ("title", "t"),
                ("kind", "points"),
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
        let drawn =
            |reference| figures(&declared(&words(reference)), &marks, &table).map(|mut found| found.remove(0).plot);
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
