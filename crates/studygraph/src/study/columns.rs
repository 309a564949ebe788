//! The text of a CSV file as the fields that it stands for: a list for each column, one value for each line `# name: value`.
//!
//! The first line that is no comment names the columns, each as a field and its unit: `roll_lengths [mm]`. Columns are parted by `;`, a
//! tab or a comma; where it is no comma, numbers may have decimal commas. Columns of one name follow each other in one list. Every
//! value keeps its place in the file. Lines that do not count are left out by `conditions.rs`. Must not know: fields, what any is for.

use super::characters::check_merged;
use super::conditions::{
    Cell, Column, Condition, Line, average, chosen, is_error, is_mark, is_same, is_tooth, marks, missing, of_lines,
};
use super::document::{Content, KeyValue, Node, parse};
use super::words::{self, quote};
use declare::error::{Diagnostic, Place, nearest};
use declare::number::counted;
use declare::units::{ForeignUnit, UnitError, foreign_unit, parse_unit, symbols, with_powers};

/// The fields that the text says, in the order in which it does, and the line that names the columns; of the lines only those that
/// meet `conditions`.
///
/// # Errors
/// The first line that cannot be read.
pub fn fields(text: &str, conditions: &[Condition]) -> Result<(Vec<KeyValue>, Place), Diagnostic> {
    check_merged(text)?;
    let mut pairs: Vec<KeyValue> = Vec::new();
    let mut header: Option<(Vec<Column>, char, Place)> = None;
    let mut lines: Vec<Line> = Vec::new();
    let mut decimals = Decimals::default();
    let mut lists_of_marks: Vec<(&str, Place)> = Vec::new();
    let mut all_marks: Option<Vec<&str>> = None;
    let mut offset = 0;
    for (number, line) in (1..).zip(text.split('\n')) {
        let here = Place { line: number, column: 1, offset, length: line.len() };
        offset += line.len() + 1;
        let is_cells = |(columns, separator, _): &(Vec<Column>, char, Place)| {
            let cells = cells(line, *separator, here);
            cells.len() == columns.len() && is_error(cells[0].text)
        };
        if let Some(said) = line.trim_start().strip_prefix('#').filter(|_| !header.as_ref().is_some_and(is_cells)) {
            match missing(said) {
                Some(list) => {
                    lists_of_marks.push((list, part(line, here, list)));
                    all_marks = None;
                }
                None => pairs.extend(said_by(said, line, here)?),
            }
        } else if line.trim().is_empty() {
        } else if let Some((columns, separator, _)) = &header {
            let mut cells = cells(line, *separator, here);
            // Programs end lines with what parts their values.
            if cells.len() == columns.len() + 1 && cells.last().is_some_and(|cell| cell.text.is_empty()) {
                cells.pop();
            }
            if cells.len() != columns.len() {
                return Err(other_count(cells.len(), columns.len(), *separator).at(here));
            }
            let of_values = |at: &usize| !columns[*at].is_key;
            if all_marks.is_none() {
                let of_lists = lists_of_marks
                    .iter()
                    .map(|(list, place)| marks(list, *separator).map_err(|found| found.at(*place)));
                all_marks = Some(of_lists.collect::<Result<Vec<_>, _>>()?.concat());
            }
            let is_missing = |cell: &Cell| all_marks.iter().flatten().any(|mark| is_same(mark, cell.text));
            if (0..cells.len()).filter(of_values).any(|at| is_missing(&cells[at])) {
                continue;
            }
            for at in (0..cells.len()).filter(of_values) {
                if !is_mark(cells[at].text) {
                    decimals.see(at, &cells[at], *separator)?;
                }
            }
            lines.push(Line { cells });
        } else {
            let separator = if line.contains(';') {
                ';'
            } else if line.contains('\t') {
                '\t'
            } else {
                ','
            };
            let columns = cells(line, separator, here)
                .into_iter()
                .map(|cell| column(cell, conditions))
                .collect::<Result<Vec<_>, _>>()?;
            header = Some((columns, separator, here));
        }
    }
    let Some((columns, separator, header)) = header else {
        let start = Place { line: 1, column: 1, ..Place::default() };
        return Err(Diagnostic::new("this file has no columns").at(start).help(HEADER));
    };
    let (lines, averaged) = chosen(lines, &columns, conditions, header)?;
    let mut lists: Vec<(Vec<Node>, Place)> =
        columns.iter().map(|column| (Vec::with_capacity(lines.len()), column.name.place)).collect();
    for line in &lines {
        for ((cell, column), (items, _)) in line.cells.iter().zip(&columns).zip(&mut lists) {
            if !column.is_key {
                items.push(value(cell, column, separator)?);
            }
        }
    }
    decimals.check_thousands()?;
    if averaged > 1 {
        average(&columns, &mut lists, averaged)?;
    }
    let said = pairs.len();
    for (column, (items, place)) in columns.iter().zip(lists).filter(|(column, _)| !column.is_key) {
        if pairs[..said].iter().any(|pair| pair.key == column.name.text) {
            return Err(twice(column.name.text).at(place));
        }
        match pairs.iter_mut().find(|pair| pair.key == column.name.text) {
            // Columns of one name are one list, which ends with the last of them.
            Some(KeyValue { node: Node { content: Content::Sequence(all), place: last }, .. }) => {
                all.extend(items);
                *last = place;
            }
            Some(_) => return Err(twice(column.name.text).at(place)),
            None => pairs.push(KeyValue {
                key: column.name.text.to_owned(),
                place,
                node: Node { content: Content::Sequence(items), place },
            }),
        }
    }
    for (at, pair) in pairs.iter().enumerate() {
        if pairs[..at].iter().any(|earlier| earlier.key == pair.key) {
            return Err(twice(&pair.key).at(pair.place));
        }
    }
    Ok((pairs, header))
}

const HEADER: &str = "the first line names the columns and their units, such as `roll_lengths [mm], deviations [um]`";

fn twice(name: &str) -> Diagnostic {
    Diagnostic::new(format!("{} stands here a second time", quote(name))).help("keep one of them")
}

fn other_count(cells: usize, columns: usize, separator: char) -> Diagnostic {
    let are = if columns == 1 { "is" } else { "are" };
    let message = format!("this line has {}, and there {are} {}", counted(cells, "value"), counted(columns, "column"));
    if separator == ',' && cells > columns {
        Diagnostic::new(message).help("with decimal commas, part columns by `;`")
    } else {
        Diagnostic::new(message).help("write every value of a line, and leave out a line that has none")
    }
}

/// Which sign stands before decimals: a file has one.
#[derive(Default)]
struct Decimals {
    /// The first number with it, and its line.
    sign: Option<(char, usize)>,
    /// By column.
    seen: Vec<Commas>,
}

/// What the numbers of a column have of thousands.
#[derive(Default)]
struct Commas {
    /// The first with a comma before three digits, which does not begin with 0.
    first: Option<(String, Place)>,
    /// Whether some number is 100 to 999 without a comma, and none is otherwise.
    has_hundreds: bool,
    has_others: bool,
}

impl Decimals {
    /// # Errors
    /// When it has another sign than a number before it.
    fn see(&mut self, column: usize, cell: &Cell<'_>, separator: char) -> Result<(), Diagnostic> {
        if separator == ',' {
            return Ok(());
        }
        if self.seen.len() <= column {
            self.seen.resize_with(column + 1, Commas::default);
        }
        let commas = &mut self.seen[column];
        let digits = cell.text.trim_start_matches(['-', '+']);
        let sign = [',', '.'].into_iter().find(|sign| digits.contains(*sign));
        match digits.split_once(',') {
            Some((whole, rest)) if rest.len() == 3 && (1..4).contains(&whole.len()) && !whole.starts_with('0') => {
                commas.first.get_or_insert_with(|| (cell.text.to_owned(), cell.place));
            }
            None if sign.is_none() && digits.len() < 4 => commas.has_hundreds |= digits.len() == 3,
            _ => commas.has_others = true,
        }
        let Some(sign) = sign else { return Ok(()) };
        let (first, line) = *self.sign.get_or_insert((sign, cell.place.line));
        if first == sign {
            return Ok(());
        }
        let name = |sign| if sign == ',' { "comma" } else { "point" };
        let message =
            format!("{} has a {}, and a number in line {line} a {}", quote(cell.text), name(sign), name(first));
        Err(Diagnostic::new(message)
            .at(cell.place)
            .help("a file has one sign before decimals, and nothing parts thousands"))
    }

    /// # Errors
    /// When the commas of a column seem to part thousands: all stand before three digits, and numbers without one end at 999.
    fn check_thousands(&self) -> Result<(), Diagnostic> {
        let is_parted = |commas: &&Commas| commas.has_hundreds && !commas.has_others;
        match self.seen.iter().filter(is_parted).find_map(|commas| commas.first.as_ref()) {
            None => Ok(()),
            Some((text, place)) => {
                let message =
                    format!("the comma of {} seems to part thousands, as it is a decimal comma here", quote(text));
                let help = "nothing parts thousands; a decimal comma stands in some number before another count of digits than three";
                Err(Diagnostic::new(message).at(*place).help(help))
            }
        }
    }
}

/// The field of a line `# name: value`; any other is a comment.
fn said_by(said: &str, line: &str, here: Place) -> Result<Option<KeyValue>, Diagnostic> {
    let Some((name, value)) = said.split_once(':') else { return Ok(None) };
    let name = name.trim();
    if name.is_empty() || !name.bytes().all(|byte| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_') {
        return Ok(None);
    }
    let place = part(line, here, name);
    let value = value.trim();
    let node = parse(value).map_err(|found| Diagnostic { place: Some(part(line, here, value)), ..found })?;
    let Some(node) = node.filter(|node| !node.is_null()) else {
        return Err(Diagnostic::new(format!("{} has no value", quote(name))).at(place));
    };
    Ok(Some(KeyValue { key: name.to_owned(), place, node: node.moved_to(part(line, here, value)) }))
}

/// The place of a part of a line, which is a slice of it.
fn part(line: &str, here: Place, part: &str) -> Place {
    let at = (part.as_ptr() as usize).saturating_sub(line.as_ptr() as usize).min(line.len());
    Place { column: line[..at].chars().count() + 1, offset: here.offset + at, length: part.len(), ..here }
}

/// The values of a line, without spaces and quotes around them.
fn cells(line: &str, separator: char, here: Place) -> Vec<Cell<'_>> {
    let mut is_quoted = false;
    let parts = line.split(|character: char| {
        is_quoted ^= character == '"';
        character == separator && !is_quoted
    });
    let bare = |text| unquoted(str::trim(text));
    parts.map(bare).map(|text| Cell { text, place: part(line, here, text) }).collect()
}

fn unquoted(text: &str) -> &str {
    text.strip_prefix('"').and_then(|text| text.strip_suffix('"')).unwrap_or(text)
}

fn column<'a>(cell: Cell<'a>, conditions: &[Condition]) -> Result<Column<'a>, Diagnostic> {
    // A number of a tooth has no unit, and neither has what a condition names.
    let key = cell.text.split('[').next().unwrap_or_default().trim_end();
    if is_tooth(key) || conditions.iter().any(|condition| condition.column.eq_ignore_ascii_case(key)) {
        let name = Cell { text: key, place: Place { length: key.len(), ..cell.place } };
        return Ok(Column { name, unit: None, is_key: true });
    }
    let wrong = |message: String| Diagnostic::new(message).at(cell.place);
    if cell.text.is_empty() {
        return Err(wrong("a column has no name".to_owned()).help(HEADER));
    }
    if cell.text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) {
        let message = format!("{} stands where the name of a column is expected", quote(cell.text));
        return Err(wrong(message).help(HEADER));
    }
    if let Some(help) = of_lines(key).filter(|_| key == cell.text || cell.text.ends_with("[-]")) {
        return Err(wrong(format!("the column {} is no field", quote(key))).help(help));
    }
    let written = cell.text.split_once('[').and_then(|(name, unit)| Some((name.trim_end(), unit.strip_suffix(']')?)));
    let Some((name, unit)) = written else {
        let help =
            format!("write `{} [mm]` if that is its unit, or `[-]` behind it where numbers are plain", cell.text);
        return Err(wrong(format!("the column {} has no unit", quote(cell.text))).help(help));
    };
    let unit = unit.trim();
    let place = Place { length: name.len(), ..cell.place };
    let name = Cell { text: name, place };
    if unit == "-" {
        return Ok(Column { name, unit: None, is_key: false });
    }
    match parse_unit(unit) {
        Ok(_) => Ok(Column { name, unit: Some(unit), is_key: false }),
        Err(UnitError::Unknown(symbol)) => {
            let found = wrong(format!("unknown unit {} of the column {}", quote(&symbol), quote(name.text)));
            let converted = || {
                Some(match foreign_unit(unit)? {
                    ForeignUnit::Of(factor, own) => {
                        format!("convert the numbers to `{own}`: 1 {unit} is {} {own}", words::number(factor))
                    }
                    ForeignUnit::None(why) => why.to_owned(),
                })
            };
            let near = || nearest(&symbol, symbols()).map(|near| format!("did you mean `{near}`?"));
            let help = with_powers(unit).map(|powers| format!("write `[{powers}]`")).or_else(converted).or_else(near);
            Err(match help {
                Some(help) => found.help(help),
                None => found,
            })
        }
        Err(error) => Err(wrong(format!("{} cannot be read as a unit: {error}", quote(unit)))),
    }
}

/// What a study would say.
fn value(cell: &Cell<'_>, column: &Column<'_>, separator: char) -> Result<Node, Diagnostic> {
    if is_mark(cell.text) {
        let name = quote(column.name.text);
        let (message, mark) = match cell.text {
            "" => (format!("a value of {name} is missing"), "\"\""),
            mark => (format!("{} stands for a missing value of {name}", quote(mark)), mark),
        };
        let help =
            format!("leave out the line, or write `# missing: {mark}` above the columns to leave out every such line");
        return Err(Diagnostic::new(message).at(cell.place).help(help));
    }
    let comma = separator != ',' && cell.text.matches(',').count() == 1 && !cell.text.contains('.');
    let number = if comma { cell.text.replacen(',', ".", 1) } else { cell.text.to_owned() };
    let text = column.unit.map_or_else(|| number.clone(), |unit| format!("{number} {unit}"));
    Ok(Node { content: Content::Scalar { text, quoted: false }, place: cell.place })
}
