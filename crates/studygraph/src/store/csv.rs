//! Tables as CSV: one header line with the units, then the rows, numbers with every digit that tells them apart.
//!
//! An empty cell is a number that does not apply. A text that a spreadsheet would take for a formula, or that begins with
//! an apostrophe, has an apostrophe in front; whoever reads it back drops the first apostrophe of a text. Must not know:
//! where the text goes.

use std::io;

use crate::table::data::{Cell, Table};
use crate::table::schema::Column;

/// What makes a formula of a cell, in spreadsheets of any country.
const FORMULA: [char; 10] = ['=', '+', '-', '@', '\t', '\r', '＝', '＋', '－', '＠'];

/// For whom the text is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Dialect {
    /// Programs: commas, points, lines that end with a line feed.
    #[default]
    Plain,
    /// Excel where numbers have a decimal point. It takes a text for UTF-8 only behind a byte order mark.
    Excel,
    /// Excel where they have a decimal comma: there it parts cells at semicolons.
    ExcelComma,
}

impl Dialect {
    fn number(self, number: &Cell) -> String {
        let text = number.to_string();
        if self == Self::ExcelComma { text.replace('.', ",") } else { text }
    }
}

/// A text that no spreadsheet computes.
fn inert(text: String) -> String {
    if text.starts_with(FORMULA) || text.starts_with('\'') { format!("'{text}") } else { text }
}

/// A column as a reader sees it: `torque [N m]`.
#[must_use]
pub fn heading(column: &Column) -> String {
    if column.unit.is_empty() { column.name.clone() } else { format!("{} [{}]", column.name, column.unit) }
}

/// Writes the rows and columns given by index, in their order.
///
/// # Errors
/// When `sink` cannot be written to.
pub fn write(table: &Table, columns: &[usize], rows: &[usize], sink: &mut dyn io::Write) -> io::Result<()> {
    let headings = columns.iter().map(|&column| heading(&table.schema().columns[column]));
    let cells = |&row: &usize| columns.iter().map(move |&column| Some(table.columns()[column].cell(row)));
    write_cells(headings, rows.iter().map(cells), Dialect::Plain, sink)
}

/// Writes cells row by row; `None` is an empty cell too.
///
/// # Errors
/// When `sink` cannot be written to.
pub fn write_cells(
    headings: impl Iterator<Item = String>,
    rows: impl Iterator<Item = impl Iterator<Item = Option<Cell>>>,
    dialect: Dialect,
    sink: &mut dyn io::Write,
) -> io::Result<()> {
    let mut options = csv::WriterBuilder::new();
    if dialect != Dialect::Plain {
        sink.write_all("\u{feff}".as_bytes())?;
        options.terminator(csv::Terminator::CRLF);
    }
    if dialect == Dialect::ExcelComma {
        options.delimiter(b';');
    }
    let mut writer = options.from_writer(sink);
    writer.write_record(headings.map(inert).collect::<Vec<_>>())?;
    for row in rows {
        writer.write_record(row.map(|cell| match cell {
            None => String::new(),
            Some(Cell::Float(value)) if value.is_nan() => String::new(),
            Some(Cell::Text(text)) => inert(text),
            Some(number) => dialect.number(&number),
        }))?;
    }
    writer.flush()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::parquet::tests::everything;

    #[test]
    fn cells_are_quoted_where_needed_and_numbers_read_back() {
        let table = everything(4);
        let mut bytes = Vec::new();
        write(&table, &[0, 2, 4], &[0, 1, 2, 3], &mut bytes).unwrap();
        let mut reader = csv::Reader::from_reader(bytes.as_slice());
        assert_eq!(reader.headers().unwrap(), ["design", "te [um]", "inside"].as_slice());
        let records: Vec<_> = reader.records().map(Result::unwrap).collect();
        assert_eq!(records.len(), 4);
        for (row, record) in records.iter().enumerate() {
            assert_eq!(record[0], table.texts("design")[row]);
            let te = table.floats("te")[row];
            let read = if record[1].is_empty() { f64::NAN } else { record[1].parse().unwrap() };
            assert!(te.to_bits() == read.to_bits() || (te.is_nan() && read.is_nan()), "{te} {read}");
        }
    }

    #[test]
    fn excel_has_its_mark_its_line_ends_and_the_separators_of_its_country() {
        let written = |dialect| {
            let row = [Cell::Text("a;b, ε_α".to_owned()), Cell::Float(-1.5e-7), Cell::Integer(3), Cell::Flag(true)];
            let headings = ["design", "te [um]", "count", "is"].into_iter().map(str::to_owned);
            let mut bytes = Vec::new();
            write_cells(headings, [row.into_iter().map(Some)].into_iter(), dialect, &mut bytes).unwrap();
            String::from_utf8(bytes).unwrap()
        };
        assert_eq!(written(Dialect::Plain), "design,te [um],count,is\n\"a;b, ε_α\",-0.00000015,3,true\n");
        let excel = "\u{feff}design,te [um],count,is\r\n\"a;b, ε_α\",-0.00000015,3,true\r\n";
        assert_eq!(written(Dialect::Excel), excel);
        let comma = "\u{feff}design;te [um];count;is\r\n\"a;b, ε_α\";-0,00000015;3;true\r\n";
        assert_eq!(written(Dialect::ExcelComma), comma);
    }

    #[test]
    fn no_text_is_a_formula_and_every_text_comes_back() {
        let texts =
            ["=1+1", "+x", "-5", "@SUM(A1)", "\t=1", "\r=1", "＝1", "'", "'=1", "''", "a=b", " =1", "", "a\n=1"];
        let rows = texts.iter().map(|text| {
            [Some(Cell::Text((*text).to_owned())), Some(Cell::Float(-1.5)), Some(Cell::Integer(-2))].into_iter()
        });
        let mut bytes = Vec::new();
        let headings = ["text", "=number", "-"].into_iter().map(str::to_owned);
        write_cells(headings, rows, Dialect::Plain, &mut bytes).unwrap();
        let mut reader = csv::Reader::from_reader(bytes.as_slice());
        assert_eq!(reader.headers().unwrap(), ["text", "'=number", "'-"].as_slice());
        for (text, record) in texts.iter().zip(reader.records().map(Result::unwrap)) {
            assert!(!record[0].starts_with(FORMULA), "{text:?}");
            assert_eq!(record[0].strip_prefix('\'').unwrap_or(&record[0]), *text);
            // Numbers stay numbers.
            assert_eq!([&record[1], &record[2]], ["-1.5", "-2"]);
        }
    }
}
