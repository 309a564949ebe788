//! Printing rows: for people, as CSV, JSON and Markdown. Must not know: where they came from.

use comfy_table::{Cell as DrawnCell, CellAlignment, ContentArrangement, Row, Table as Drawn, presets};
use serde_json::{Map, Value, json};

use super::arguments::Format;
use declare::number::counted;
use studygraph::diff::markdown::escaped;
use studygraph::store::csv::{Dialect, heading, write_cells};
use studygraph::table::data::{Cell, Table};
use studygraph::table::schema::Type;
use studygraph::table::select::{parse_conditions, rows_where, unknown_column, why_none};

/// Rows to print, wherever they come from.
pub struct Grid<'a> {
    pub columns: Vec<Heading>,
    pub rows: usize,
    /// By row and column; `None` where there is nothing.
    pub cell: Box<dyn Fn(usize, usize) -> Option<Cell> + 'a>,
}

pub struct Heading {
    /// In JSON.
    pub name: String,
    /// Everywhere else: with the unit.
    pub shown: String,
    /// Numbers stand on the right.
    pub is_number: bool,
}

/// The rows and columns that were asked for, as text.
///
/// # Errors
/// An unknown column, a condition that does not fit or that no row meets, with the nearest known name.
pub fn table(table: &Table, conditions: &[String], columns: &[String], format: Format) -> Result<String, String> {
    let mut parsed = Vec::new();
    for condition in conditions {
        if condition.contains(['<', '>', '!']) {
            let compared = format!("`gearstudy query \"select * from … where {condition}\"` compares");
            return Err(format!("`{condition}` is not a condition; write `column=value`, or ask in SQL: {compared}"));
        }
        parsed.extend(parse_conditions(condition)?);
    }
    let rows = rows_where(table, &parsed)?;
    if rows.is_empty() && !parsed.is_empty() {
        return Err(why_none(table, &parsed)?);
    }
    let chosen: Vec<usize> = if columns.is_empty() {
        (0..table.schema().columns.len()).collect()
    } else {
        let find = |name: &String| table.schema().position(name).ok_or_else(|| unknown_column(table.schema(), name));
        columns.iter().map(find).collect::<Result<_, _>>()?
    };
    grid(table, &chosen, &rows).text(format)
}

/// All rows of a table as JSON.
pub(super) fn objects(table: &Table) -> Vec<Value> {
    let columns: Vec<usize> = (0..table.schema().columns.len()).collect();
    let rows: Vec<usize> = (0..table.rows()).collect();
    grid(table, &columns, &rows).objects().collect()
}

/// Some columns and rows of a table.
fn grid<'a>(table: &'a Table, columns: &'a [usize], rows: &'a [usize]) -> Grid<'a> {
    let headings = columns.iter().map(|&index| {
        let column = &table.schema().columns[index];
        let is_number = matches!(column.kind, Type::Float | Type::Integer);
        Heading { name: column.name.clone(), shown: heading(column), is_number }
    });
    Grid {
        columns: headings.collect(),
        rows: rows.len(),
        cell: Box::new(|row, column| Some(table.columns()[columns[column]].cell(rows[row]))),
    }
}

impl Grid<'_> {
    /// # Errors
    /// When it cannot be written as CSV, which is a mistake of this program.
    pub fn text(&self, format: Format) -> Result<String, String> {
        match format {
            Format::Pretty => Ok(self.pretty()),
            Format::Csv => self.csv(Dialect::Plain),
            Format::Excel => self.csv(Dialect::Excel),
            Format::ExcelComma => self.csv(Dialect::ExcelComma),
            Format::Json => Ok(self.json()),
            Format::Markdown => Ok(self.markdown()),
        }
    }

    fn row(&self, row: usize) -> impl Iterator<Item = Option<Cell>> {
        (0..self.columns.len()).map(move |column| (self.cell)(row, column))
    }

    /// On a terminal as many columns as fit it, whole: text that is broken into letters says nothing.
    fn pretty(&self) -> String {
        self.pretty_in(Drawn::new().width())
    }

    /// `width` is that of a terminal; elsewhere there is room for all.
    fn pretty_in(&self, width: Option<u16>) -> String {
        let rows: Vec<Vec<String>> =
            (0..self.rows).map(|row| self.row(row).map(|cell| shown(cell.as_ref())).collect()).collect();
        let fitting = width.map_or(self.columns.len(), |width| self.fitting(&rows, usize::from(width)));
        let mut drawn = Drawn::new();
        drawn.load_style(presets::UTF8_BORDERS_ONLY).set_content_arrangement(ContentArrangement::Dynamic);
        if let Some(width) = width {
            drawn.set_width(width);
        }
        drawn.set_header(self.columns[..fitting].iter().map(|column| &column.shown));
        for row in &rows {
            let cell = |(text, column): (&String, &Heading)| {
                let align = if column.is_number { CellAlignment::Right } else { CellAlignment::Left };
                DrawnCell::new(text).set_alignment(align)
            };
            drawn.add_row(Row::from(row[..fitting].iter().zip(&self.columns).map(cell).collect::<Vec<_>>()));
        }
        let count = counted(self.rows, "row");
        let rest: Vec<&str> = self.columns[fitting..].iter().map(|column| column.name.as_str()).collect();
        let cut = match rest[..] {
            [] => String::new(),
            [only] => format!("; the column {only} does not fit: `--columns {only}`, or `--format csv`"),
            [first, ..] => format!(
                "; {} more columns do not fit: {} (`--columns {first},…` chooses, `--format csv` has all)",
                rest.len(),
                rest.join(", ")
            ),
        };
        format!("{drawn}\n{count}{cut}\n")
    }

    /// How many columns from the left fit a width, one at least.
    fn fitting(&self, rows: &[Vec<String>], width: usize) -> usize {
        let wide = |index: usize| {
            let cells = rows.iter().map(|row| row[index].chars().count());
            // A space to either side, and one between columns.
            cells.chain([self.columns[index].shown.chars().count()]).max().unwrap_or(0) + 3
        };
        let mut left = width.saturating_sub(1);
        let fits = |index: &usize| {
            let room = left.checked_sub(wide(*index));
            left = room.unwrap_or(0);
            room.is_some()
        };
        (0..self.columns.len()).take_while(fits).count().max(1).min(self.columns.len())
    }

    fn csv(&self, dialect: Dialect) -> Result<String, String> {
        let mut bytes = Vec::new();
        let broken = |error: &dyn std::fmt::Display| format!("the table could not be written as CSV: {error}");
        let headings = self.columns.iter().map(|column| column.shown.clone());
        let rows = (0..self.rows).map(|row| self.row(row));
        write_cells(headings, rows, dialect, &mut bytes).map_err(|error| broken(&error))?;
        String::from_utf8(bytes).map_err(|error| broken(&error))
    }

    /// The rows as objects.
    fn objects(&self) -> impl Iterator<Item = Value> {
        let value = |cell: Option<Cell>| match cell {
            // JSON has no NaN: null says "not applicable here".
            Some(Cell::Float(value)) => serde_json::Number::from_f64(value).map_or(Value::Null, Value::Number),
            Some(Cell::Integer(value)) => json!(value),
            Some(Cell::Text(value)) => json!(value),
            Some(Cell::Flag(value)) => json!(value),
            None => Value::Null,
        };
        (0..self.rows).map(move |row| {
            let names = self.columns.iter().map(|column| column.name.clone());
            Value::Object(names.zip(self.row(row).map(value)).collect::<Map<_, _>>())
        })
    }

    fn json(&self) -> String {
        let lines: Vec<String> = self.objects().map(|object| format!("  {object}")).collect();
        if lines.is_empty() { "[]\n".to_owned() } else { format!("[\n{}\n]\n", lines.join(",\n")) }
    }

    fn markdown(&self) -> String {
        let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        let rules = self.columns.iter().map(|column| if column.is_number { "---:" } else { "---" }.to_owned());
        let mut text = line(self.columns.iter().map(|column| escaped(&column.shown)).collect());
        text += &line(rules.collect());
        for row in 0..self.rows {
            text += &line(self.row(row).map(|cell| escaped(&shown(cell.as_ref()))).collect());
        }
        text
    }
}

/// A number with eight significant digits and no trailing zeros; the exact value is in the CSV and the JSON.
fn shown(cell: Option<&Cell>) -> String {
    let value = match cell {
        None => return "–".to_owned(),
        Some(Cell::Float(value)) => *value,
        Some(cell) => return cell.to_string(),
    };
    if value == 0.0 || !value.is_finite() {
        return if value.is_nan() { "–".to_owned() } else { value.to_string() };
    }
    let magnitude = value.abs().log10().floor();
    if !(-4.0..9.0).contains(&magnitude) {
        let text = format!("{value:.7e}");
        let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        return format!("{}e{exponent}", trimmed(digits));
    }
    // Between −4 and 8, so the subtraction stays between −1 and 11.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let decimals = (7.0 - magnitude).max(0.0) as usize;
    trimmed(&format!("{value:.decimals$}")).to_owned()
}

fn trimmed(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;
    use studygraph::table::schema::{Column, Schema};

    fn sample() -> Table {
        let columns = vec![Column::text("design", "").key(), Column::float("peak_to_peak", "um", "").allows_nan()];
        let rows = vec![vec!["iso, long".into(), 0.728_123_456_789.into()], vec!["none".into(), f64::NAN.into()]];
        Table::from_rows(Schema::new("summary", "", columns), rows).unwrap()
    }

    #[test]
    fn every_format_shows_the_same_cells() {
        let print = |format| table(&sample(), &[], &[], format).unwrap();
        assert!(print(Format::Pretty).contains("0.72812346") && print(Format::Pretty).contains("peak_to_peak [um]"));
        assert_eq!(print(Format::Csv), "design,peak_to_peak [um]\n\"iso, long\",0.728123456789\nnone,\n");
        let parsed: Value = serde_json::from_str(&print(Format::Json)).unwrap();
        assert_eq!(parsed[0]["peak_to_peak"], 0.728_123_456_789);
        assert_eq!(parsed[1]["peak_to_peak"], Value::Null);
        let markdown =
            "| design | peak\\_to\\_peak \\[um\\] |\n| --- | ---: |\n| iso, long | 0.72812346 |\n| none | – |\n";
        assert_eq!(print(Format::Markdown), markdown);
    }

    #[test]
    fn a_narrow_terminal_has_whole_columns_and_the_names_of_the_others() {
        let table = sample();
        let grid = grid(&table, &[0, 1], &[0, 1]);
        let (wide, narrow) = (grid.pretty_in(Some(60)), grid.pretty_in(Some(20)));
        assert!(wide.contains("peak_to_peak [um]") && wide.ends_with("2 rows\n"), "{wide}");
        let note = "2 rows; the column peak_to_peak does not fit: `--columns peak_to_peak`, or `--format csv`\n";
        assert!(narrow.contains("iso, long") && narrow.ends_with(note), "{narrow}");
        assert!(narrow.lines().take(6).all(|line| line.chars().count() <= 20), "{narrow}");
        // What is broken at all is one column.
        assert!(grid.pretty_in(Some(3)).contains("does not fit"));
    }

    #[test]
    fn conditions_and_columns_choose() {
        let only = table(&sample(), &["design=none".into()], &["design".into()], Format::Csv).unwrap();
        assert_eq!(only, "design\nnone\n");
        assert!(table(&sample(), &[], &["desing".into()], Format::Csv).unwrap_err().contains("did you mean `design`"));
    }

    #[test]
    fn numbers_are_short_and_honest() {
        let shown_as = |value: f64| shown(Some(&Cell::Float(value)));
        assert_eq!(shown_as(2.738e8), "273800000");
        assert_eq!(shown_as(2.738e10), "2.738e10");
        assert_eq!(shown_as(0.1 + 0.2), "0.3");
        assert_eq!(shown_as(1.5e-7), "1.5e-7");
        assert_eq!(shown_as(-12.345_678_901), "-12.345679");
    }
}
