//! Printed tables as entries of their own: one for each number of each row.
//!
//! Must not know: what is compared, and how.

use std::collections::BTreeSet;

use super::stated::{PrintedRow, PrintedRowNames, PrintedTable, Published};
use crate::stage::formula::names_in;
use crate::stage::operand::names::check_name;
use declare::declared::Placed;
use declare::error::{Diagnostic, Place};
use declare::number::counted;
use declare::record::Record;
use studygraph::table::select::CellName;

/// Stands in a row where a column has no number.
const NOTHING: &str = "none";

/// A number to be compared.
pub struct Printed {
    pub published: Published,
    /// Of a number of a printed table.
    pub row: Option<Row>,
}

pub struct Row {
    /// What its cells begin with where they are columns alone.
    pub of: Option<Placed<String>>,
}

impl From<Published> for Printed {
    fn from(published: Published) -> Self {
        Self { published, row: None }
    }
}

/// A name, and what it stands for: one thing, or one in each column.
type Name = (String, Vec<Placed<String>>);

/// The numbers of a table, row by row, and what is wrong with rows and names; each number with the record of its row.
pub fn entries<'a>(table: &PrintedTable, record: &'a Record) -> Vec<Result<(Printed, &'a Record), Diagnostic>> {
    let mut used = BTreeSet::new();
    let mut entries: Vec<_> = wrong_columns(table, record).into_iter().map(Err).collect();
    if !entries.is_empty() {
        return entries;
    }
    for (row, record) in table.rows.iter().zip(record.each_inside(PrintedTable::NAMES.rows)) {
        match numbers(table, row, record) {
            Ok(numbers) => entries.extend(numbers.into_iter().map(|number| {
                used.extend(number.published.with.iter().flatten().map(|(name, _)| name.clone()));
                Ok((number, record))
            })),
            Err(wrong) => entries.push(Err(wrong)),
        }
    }
    let formulas = table.rows.iter().flat_map(|row| row.formula.iter().flatten());
    let are_read = formulas.into_iter().all(|formula| names_in(&formula.value).is_some());
    if are_read && entries.iter().all(Result::is_ok) {
        let unused = table.names.iter().flatten().filter(|(name, _)| !used.contains(name));
        entries.extend(unused.map(|named| {
            Err(at_name(named, record, format!("`let` gives `{}`, but no formula of the table uses it", named.0)))
        }));
    }
    entries
}

/// What is wrong with the columns of a table and with what stands for one thing in each.
fn wrong_columns(table: &PrintedTable, record: &Record) -> Vec<Diagnostic> {
    let begin = table.of.iter().chain(table.columns.iter().flatten().map(|(_, of)| of));
    let wrong: Vec<Diagnostic> = begin.filter_map(|of| check_beginning(of).err()).collect();
    if !wrong.is_empty() {
        return wrong;
    }
    let all = match &table.columns {
        Some(columns) if columns.len() < 2 => {
            let message = "`columns` are numbers that stand side by side, two or more; for one there is `of`";
            return vec![Diagnostic::new(message).at(record.place_of(PrintedTable::NAMES.columns))];
        }
        columns => columns.as_ref().map_or(1, Vec::len),
    };
    let named = || table.names.iter().flatten();
    let misnamed = named().filter_map(|named| Some((named, check_name(&named.0).err()?)));
    let misnamed: Vec<_> = misnamed.map(|(named, wrong)| wrong.at(place_of(named, record))).collect();
    if !misnamed.is_empty() {
        return misnamed;
    }
    named()
        .filter(|(_, values)| values.len() != 1 && values.len() != all)
        .map(|named| {
            let message = format!("`{}` stands for {} things in a table of {}", named.0, named.1.len(), columns(all));
            at_name(named, record, message).help("write one, or one for each of `columns`")
        })
        .collect()
}

/// Refuses what no cell begins with.
fn check_beginning(of: &Placed<String>) -> Result<(), Diagnostic> {
    let text = of.value.trim();
    CellName::parse(&format!("{text}.column")).map(drop).map_err(|_| {
        let message = format!("`{text}` is not what cells begin with; write `stage.table[key=value, …]`");
        Diagnostic::new(message).at(of.place)
    })
}

fn at_name(named: &Name, record: &Record, message: String) -> Diagnostic {
    Diagnostic::new(message).at(place_of(named, record))
}

fn place_of(named: &Name, record: &Record) -> Place {
    named.1.first().map_or_else(|| record.place_of(PrintedTable::NAMES.names), |value| value.place)
}

/// What each number of a row is called beside the row's label, and what its cells begin with.
type Places<'a> = Vec<(Option<&'a str>, Option<&'a Placed<String>>)>;

/// The numbers of a row.
fn numbers(table: &PrintedTable, row: &PrintedRow, record: &Record) -> Result<Vec<Printed>, Diagnostic> {
    let places: Places = match (&table.columns, row.value.len()) {
        (Some(columns), 2..) => columns.iter().map(|(name, of)| (Some(name.as_str()), Some(of))).collect(),
        _ => vec![(None, table.of.as_ref())],
    };
    let all = places.len();
    let is_printed = |value: &Placed<String>| value.value.trim() != NOTHING;
    check_counts(table, row, record, [all, row.value.iter().filter(|value| is_printed(value)).count()])?;
    if all == 1 {
        check_alone(table, row)?;
    }
    let mut expected = row.expected.iter().flatten();
    let numbers = row.value.iter().zip(places).enumerate().filter(|(_, (value, _))| is_printed(value));
    let numbers = numbers.map(|(at, (value, (name, of)))| {
        let formula = row.formula.as_ref().and_then(|each| one(each, at));
        let published = Published {
            label: Some(name.map_or_else(|| row.label.clone(), |name| format!("{}, {name}", row.label.trim()))),
            location: table.location.clone(),
            cell: row.cell.as_ref().and_then(|each| one(each, at)).map(|cell| within(of, cell)),
            with: formula.as_ref().and_then(|formula| with(table, &formula.value, at)),
            formula,
            claim: None,
            value: Some(value.clone()),
            tolerance: row.tolerance.clone().unwrap_or_else(|| table.tolerance.clone()),
            expected: expected.next().cloned(),
            because: row.because.clone().or_else(|| table.because.clone()),
            proof: None,
            note: row.note.clone(),
        };
        Printed { published, row: Some(Row { of: of.cloned() }) }
    });
    Ok(numbers.collect())
}

/// Refuses lists that do not go together: with `all` values, of which some are printed.
fn check_counts(
    table: &PrintedTable,
    row: &PrintedRow,
    record: &Record,
    [all, printed]: [usize; 2],
) -> Result<(), Diagnostic> {
    const NAMES: PrintedRowNames = PrintedRow::NAMES;
    let counts = [
        (NAMES.value, Some(row.value.len()), [all; 2]),
        (NAMES.cell, row.cell.as_ref().map(Vec::len), [1, all]),
        (NAMES.formula, row.formula.as_ref().map(Vec::len), [1, all]),
        (NAMES.expected, row.expected.as_ref().map(Vec::len), [printed; 2]),
    ];
    if printed == 0 && (row.value.is_empty() || row.value.len() == all) {
        return Err(Diagnostic::new("the row has no number").at(record.place_of(NAMES.value)));
    }
    for (field, count, counts) in counts {
        if let Some(count) = count.filter(|count| !counts.contains(count)) {
            return Err(miscounted(table, field, count, counts[1]).at(record.place_of(field)));
        }
    }
    Ok(())
}

/// Refuses what only a row of several numbers can say.
fn check_alone(table: &PrintedTable, row: &PrintedRow) -> Result<(), Diagnostic> {
    let alone = |cell: &&Placed<String>| table.of.is_none() && !cell.value.contains('.');
    if let Some(cell) = row.cell.iter().flatten().find(alone) {
        let message = format!("`{}` is a column alone, and the table does not say of what", cell.value.trim());
        let help = "add `of: stage.table[key=value, …]`, or name the cell";
        return Err(Diagnostic::new(message).at(cell.place).help(help));
    }
    let formulas = row.formula.iter().flatten();
    let named = formulas.flat_map(|formula| named_in(&formula.value, table).map(|named| (named, formula.place)));
    for ((name, values), place) in named {
        if values.len() > 1 {
            let message = format!("`{name}` stands for one thing in each of `columns`, and this row has one number");
            return Err(Diagnostic::new(message).at(place));
        }
    }
    Ok(())
}

/// What is wrong with a field of a row that says `found` things where `wanted` are meant.
fn miscounted(table: &PrintedTable, field: &str, found: usize, wanted: usize) -> Diagnostic {
    let values = |count: usize| counted(count, "value");
    if field != PrintedRow::NAMES.value {
        let one = if field == PrintedRow::NAMES.expected { "" } else { "one, or " };
        let message = format!("`{field}` lists {found} for {}", values(wanted));
        return Diagnostic::new(message).help(format!("write {one}one for each value"));
    }
    let wrong = Diagnostic::new(format!("{} in a table of {}", values(found), columns(wanted)));
    match &table.columns {
        None => wrong.help(
            "numbers that stand side by side need names, and where their cells begin, for example \
             `columns: { pinion: \"pair.inspection[gear=pinion]\", gear: \"pair.inspection[gear=gear]\" }`",
        ),
        Some(columns) => {
            let names: Vec<&str> = columns.iter().map(|(name, _)| name.as_str()).collect();
            wrong.help(format!("one for each of {}, or `{NOTHING}` where nothing is printed", names.join(", ")))
        }
    }
}

fn columns(count: usize) -> String {
    if count == 1 { "one column".to_owned() } else { format!("{count} `columns`") }
}

/// Those names of the table that a formula uses, with what they stand for in a column.
fn with(table: &PrintedTable, formula: &str, column: usize) -> Option<Vec<(String, Placed<String>)>> {
    let names = named_in(formula, table);
    let with: Vec<_> = names.filter_map(|(name, values)| Some((name.clone(), one(values, column)?))).collect();
    (!with.is_empty()).then_some(with)
}

fn named_in<'a>(formula: &str, table: &'a PrintedTable) -> impl Iterator<Item = &'a Name> {
    let used = names_in(formula).unwrap_or_default();
    table.names.iter().flatten().filter(move |(name, _)| used.contains(name))
}

/// The one for all, or that of a column.
fn one(each: &[Placed<String>], column: usize) -> Option<Placed<String>> {
    each.get(column).or(each.first()).cloned()
}

/// The cell of a column, which may say stage and table itself.
pub fn within(of: Option<&Placed<String>>, column: Placed<String>) -> Placed<String> {
    match of {
        Some(of) if !column.value.contains('.') => {
            Placed { value: format!("{}.{}", of.value.trim(), column.value.trim()), place: column.place }
        }
        _ => column,
    }
}
