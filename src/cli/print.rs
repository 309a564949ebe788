//! Printing a table: for people, as CSV, as JSON. Must not know: where the table came from.

use comfy_table::{Cell, CellAlignment, ContentArrangement, Row, Table as Drawn, presets};
use serde_json::{Map, Value, json};

use crate::store::csv::{self, heading};
use crate::table::data::{Data, Table};
use crate::table::schema::Type;
use crate::table::select::{parse_conditions, rows_where, unknown_column};

use super::arguments::Format;

/// The rows and columns that were asked for, as text.
///
/// # Errors
/// An unknown column or a condition that does not fit, with the nearest known name.
pub fn table(table: &Table, conditions: &[String], columns: &[String], format: Format) -> Result<String, String> {
    let mut parsed = Vec::new();
    for condition in conditions {
        parsed.extend(parse_conditions(condition)?);
    }
    let rows = rows_where(table, &parsed)?;
    let chosen: Vec<usize> = if columns.is_empty() {
        (0..table.schema().columns.len()).collect()
    } else {
        let find = |name: &String| table.schema().position(name).ok_or_else(|| unknown_column(table.schema(), name));
        columns.iter().map(find).collect::<Result<_, _>>()?
    };
    match format {
        Format::Pretty => Ok(pretty(table, &rows, &chosen)),
        Format::Csv => csv(table, &rows, &chosen),
        Format::Json => Ok(json_rows(table, &rows, &chosen)),
    }
}

fn pretty(table: &Table, rows: &[usize], columns: &[usize]) -> String {
    let mut drawn = Drawn::new();
    drawn.load_style(presets::UTF8_BORDERS_ONLY).set_content_arrangement(ContentArrangement::Dynamic);
    drawn.set_header(columns.iter().map(|&index| heading(&table.schema().columns[index])));
    for &row in rows {
        drawn.add_row(Row::from(
            columns
                .iter()
                .map(|&index| {
                    let data = &table.columns()[index];
                    let align = if matches!(data.kind(), Type::Float | Type::Integer) {
                        CellAlignment::Right
                    } else {
                        CellAlignment::Left
                    };
                    Cell::new(shown(data, row)).set_alignment(align)
                })
                .collect::<Vec<_>>(),
        ));
    }
    let count = if rows.len() == 1 { "1 row".to_owned() } else { format!("{} rows", rows.len()) };
    format!("{drawn}\n{count}\n")
}

/// A number with eight significant digits and no trailing zeros; the exact value is in the CSV and the JSON.
fn shown(data: &Data, row: usize) -> String {
    let Data::Float(values) = data else { return data.cell(row).to_string() };
    let value = values[row];
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

fn csv(table: &Table, rows: &[usize], columns: &[usize]) -> Result<String, String> {
    let mut bytes = Vec::new();
    let broken = |error: &dyn std::fmt::Display| format!("the table could not be written as CSV: {error}");
    csv::write(table, columns, rows, &mut bytes).map_err(|error| broken(&error))?;
    String::from_utf8(bytes).map_err(|error| broken(&error))
}

fn json_rows(table: &Table, rows: &[usize], columns: &[usize]) -> String {
    let value = |index: usize, row: usize| match &table.columns()[index] {
        // JSON has no NaN: null says "not applicable here".
        Data::Float(values) => serde_json::Number::from_f64(values[row]).map_or(Value::Null, Value::Number),
        Data::Integer(values) => json!(values[row]),
        Data::Text(values) => json!(values[row]),
        Data::Flag(values) => json!(values[row]),
    };
    let name = |index: usize| table.schema().columns[index].name.clone();
    let lines: Vec<String> = rows
        .iter()
        .map(|&row| {
            let object: Map<String, Value> = columns.iter().map(|&index| (name(index), value(index, row))).collect();
            format!("  {}", Value::Object(object))
        })
        .collect();
    if lines.is_empty() { "[]\n".to_owned() } else { format!("[\n{}\n]\n", lines.join(",\n")) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::schema::{Column, Schema};

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
    }

    #[test]
    fn conditions_and_columns_choose() {
        let only = table(&sample(), &["design=none".into()], &["design".into()], Format::Csv).unwrap();
        assert_eq!(only, "design\nnone\n");
        assert!(table(&sample(), &[], &["desing".into()], Format::Csv).unwrap_err().contains("did you mean `design`"));
    }

    #[test]
    fn numbers_are_short_and_honest() {
        let shown_as = |value: f64| shown(&Data::Float(vec![value]), 0);
        assert_eq!(shown_as(2.738e8), "273800000");
        assert_eq!(shown_as(2.738e10), "2.738e10");
        assert_eq!(shown_as(0.1 + 0.2), "0.3");
        assert_eq!(shown_as(1.5e-7), "1.5e-7");
        assert_eq!(shown_as(-12.345_678_901), "-12.345679");
    }
}
