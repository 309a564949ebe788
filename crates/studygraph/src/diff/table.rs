//! Two tables: their columns, their rows by key, their values.
//!
//! Must not know: where they come from.

use std::borrow::Cow;

use super::columns::{self, Differences, KEPT};
use super::model::{ColumnDiff, Difference, Extreme, Key, SchemaChange, TableDiff, Value, Worst};
use super::rows::{KeyColumn, MatchedRows, by_keys, by_position};
use crate::store::manifest::{ColumnRecord, TableRecord};
use crate::store::parquet::unit_beside;
use crate::table::data::{Data, Table};
use crate::table::schema::{Column, Tolerance, Type};
use declare::units::parse_unit;

/// Gives a column's tolerance, where another is wanted than its own.
pub type Tolerances<'a> = &'a dyn Fn(&Column) -> Option<Tolerance>;

/// A column of both tables that can be compared.
pub(super) struct Shared<'a> {
    pub(super) column: &'a Column,
    /// In the unit of `after`.
    pub(super) before: Cow<'a, Data>,
    pub(super) after: &'a Data,
    pub(super) converted: bool,
}

/// Compares two tables by their values. `key` names the columns to match rows by, where the tables' own key would not do.
#[must_use]
pub fn compare(
    name: &str,
    before: &Table,
    after: &Table,
    key: Option<&[&str]>,
    tolerances: Tolerances<'_>,
) -> TableDiff {
    let mut diff = TableDiff {
        name: name.to_owned(),
        by_values: true,
        rows_before: before.rows(),
        rows_after: after.rows(),
        schema: schema_changes(
            &before.schema().columns.iter().map(ColumnRecord::from).collect::<Vec<_>>(),
            &after.schema().columns.iter().map(ColumnRecord::from).collect::<Vec<_>>(),
        ),
        ..TableDiff::default()
    };
    let shared = shared(before, after);
    let own_key = |column: &Column| column.key && before.schema().column(&column.name).is_some_and(|other| other.key);
    let is_key = |column: &Column| key.map_or_else(|| own_key(column), |key| key.contains(&column.name.as_str()));
    let rows = match match_rows(before, after, &shared, &is_key) {
        Ok(rows) => rows,
        Err(problem) => {
            diff.note = format!("rows cannot be matched: {problem}");
            diff.state = Difference::Changed;
            return diff;
        }
    };
    (diff.rows_added, diff.rows_removed) = (rows.added.len(), rows.removed.len());
    let keys = |table: &Table, rows: &[usize]| -> Vec<Key> {
        rows.iter().take(KEPT).map(|&row| key_of(table, row, &is_key)).collect()
    };
    (diff.added, diff.removed) = (keys(after, &rows.added), keys(before, &rows.removed));
    let compared = shared.iter().filter(|shared| !is_key(shared.column)).map(|shared| {
        let tolerance = tolerances(shared.column).unwrap_or(shared.column.tolerance);
        let found = columns::compare(&shared.before, shared.after, &rows.matched, tolerance, shared.converted);
        (shared, tolerance, found)
    });
    let compared: Vec<_> = compared.filter(|(.., found)| found.changed > 0).collect();
    let key_at = |place: usize| key_of(after, rows.matched[place].1, &is_key);
    let unit_at = |column: &Column, place: usize| unit_of(after, column, rows.matched[place].1);
    for (shared, tolerance, found) in &compared {
        let extreme = |(difference, place): (f64, usize)| {
            let (i, j) = rows.matched[place];
            let (before, after) = (shared.before.cell(i).into(), shared.after.cell(j).into());
            Extreme { difference, before, after, key: key_at(place) }
        };
        diff.columns.push(ColumnDiff {
            name: shared.column.name.clone(),
            unit: found.shown().map_or_else(|| shared.column.unit.clone(), |place| unit_at(shared.column, place)),
            compared: rows.matched.len(),
            changed: found.changed,
            beyond: found.beyond,
            absolute_tolerance: tolerance.absolute,
            relative_tolerance: tolerance.relative,
            largest_absolute: found.largest_absolute.map(extreme),
            largest_relative: found.largest_relative.map(extreme),
            largest_over: found.largest_over.map(extreme),
        });
    }
    let compared: Vec<_> = compared.iter().map(|(shared, _, found)| (*shared, found)).collect();
    diff.worst = worst(&compared, &rows, &key_at, &unit_at);
    let structure = diff.schema.iter().any(|change| change.differs) || diff.rows_added + diff.rows_removed > 0;
    diff.state = if structure || diff.columns.iter().any(|column| column.beyond > 0) {
        Difference::Changed
    } else if diff.columns.is_empty() {
        Difference::Same
    } else {
        Difference::WithinTolerance
    };
    diff
}

/// What can be said of two tables whose values are not both at hand.
#[must_use]
pub fn by_record(before: &TableRecord, after: &TableRecord, note: String) -> TableDiff {
    let same = before.content == after.content;
    TableDiff {
        name: after.name.clone(),
        state: if same { Difference::Same } else { Difference::Changed },
        by_values: false,
        note,
        rows_before: before.rows,
        rows_after: after.rows,
        schema: if same { Vec::new() } else { schema_changes(&before.columns, &after.columns) },
        ..TableDiff::default()
    }
}

/// What differs between the columns of two tables; volatile ones are left out.
fn schema_changes(before: &[ColumnRecord], after: &[ColumnRecord]) -> Vec<SchemaChange> {
    let mut changes = Vec::new();
    let mut change = |column: &ColumnRecord, what: &'static str, before: String, after: String, differs: bool| {
        changes.push(SchemaChange { column: column.name.clone(), what, before, after, differs });
    };
    let described = |column: &ColumnRecord| {
        if column.unit.is_empty() { column.kind.clone() } else { format!("{} [{}]", column.kind, column.unit) }
    };
    let key = |column: &ColumnRecord| if column.key { "key" } else { "no key" }.to_owned();
    let tolerance =
        |column: &ColumnRecord| tolerance_text(column.absolute_tolerance, column.relative_tolerance, &column.unit);
    for old in before.iter().filter(|column| !column.volatile) {
        let Some(new) = after.iter().find(|new| new.name == old.name && !new.volatile) else {
            change(old, "removed", described(old), String::new(), true);
            continue;
        };
        if old.kind != new.kind {
            change(new, "type", old.kind.clone(), new.kind.clone(), true);
        }
        if old.unit != new.unit {
            // Two spellings of one unit are not a difference; millimetres for metres are one a reader must know of.
            let same = parse_unit(&old.unit).is_ok_and(|unit| parse_unit(&new.unit) == Ok(unit));
            change(new, "unit", old.unit.clone(), new.unit.clone(), !same);
        }
        if old.key != new.key {
            change(new, "key", key(old), key(new), true);
        }
        if tolerance(old) != tolerance(new) && (&old.kind, &old.unit) == (&new.kind, &new.unit) {
            change(new, "tolerance", tolerance(old), tolerance(new), false);
        }
    }
    for new in after.iter().filter(|column| !column.volatile) {
        if !before.iter().any(|old| old.name == new.name && !old.volatile) {
            change(new, "added", String::new(), described(new), true);
        }
    }
    changes
}

/// `0.01 um + 1e-6 relative`.
#[must_use]
pub fn tolerance_text(absolute: f64, relative: f64, unit: &str) -> String {
    let absolute = (absolute > 0.0).then(|| format!("{absolute} {unit}").trim().to_owned());
    let relative = (relative > 0.0).then(|| format!("{relative:e} relative"));
    let parts: Vec<String> = absolute.into_iter().chain(relative).collect();
    if parts.is_empty() { "exact".to_owned() } else { parts.join(" + ") }
}

pub(super) fn shared<'a>(before: &'a Table, after: &'a Table) -> Vec<Shared<'a>> {
    let one = |(column, data): (&'a Column, &'a Data)| {
        let old = before.schema().column(&column.name)?;
        let old_data = before.column(&column.name)?;
        if column.volatile || old.volatile || column.kind != old.kind {
            return None;
        }
        let (before, converted) = if old.unit == column.unit {
            (Cow::Borrowed(old_data), false)
        } else {
            (Cow::Owned(converted(old_data, &old.unit, &column.unit)?), true)
        };
        Some(Shared { column, before, after: data, converted })
    };
    after.schema().columns.iter().zip(after.columns()).filter_map(one).collect()
}

/// The same quantities in another unit, where there is a way.
fn converted(data: &Data, from: &str, to: &str) -> Option<Data> {
    let unit = |text: &str| if text.is_empty() { parse_unit("1") } else { parse_unit(text) };
    let (from, to) = (unit(from).ok()?, unit(to).ok()?);
    let Data::Float(values) = data else { return None };
    if from.dimension != to.dimension {
        return None;
    }
    let ten = from.ten - to.ten;
    let power = 10f64.powi(ten.abs());
    let factor = from.factor / to.factor;
    let scaled = |value: f64| if ten >= 0 { value * factor * power } else { value * factor / power };
    Some(Data::Float(values.iter().map(|&value| scaled(value)).collect()))
}

fn match_rows(
    before: &Table,
    after: &Table,
    shared: &[Shared<'_>],
    is_key: &dyn Fn(&Column) -> bool,
) -> Result<MatchedRows, String> {
    let keys = shared.iter().filter(|shared| is_key(shared.column));
    let keys: Vec<_> = keys.map(|shared| KeyColumn::new(Cow::Borrowed(&*shared.before), shared.after)).collect();
    if !keys.is_empty() {
        return by_keys(before.rows(), after.rows(), &keys);
    }
    let has_key = |table: &Table| table.schema().key_columns().next().is_some();
    if has_key(before) || has_key(after) {
        return Err("the two tables have no column of the key in common".to_owned());
    }
    Ok(by_position(before.rows(), after.rows()))
}

/// The key of a row; its number, counted from 1, where there is no key.
pub(super) fn key_of(table: &Table, row: usize, is_key: &dyn Fn(&Column) -> bool) -> Key {
    let columns = table.schema().columns.iter().zip(table.columns()).filter(|(column, _)| is_key(column) || column.key);
    let cell = |(column, data): (&Column, &Data)| {
        let name =
            if column.unit.is_empty() { column.name.clone() } else { format!("{} [{}]", column.name, column.unit) };
        (name, Value::from(data.cell(row)))
    };
    let key: Key = columns.map(cell).collect();
    if key.is_empty() {
        vec![("row".to_owned(), Value::Integer(i64::try_from(row + 1).unwrap_or(i64::MAX)))]
    } else {
        key
    }
}

/// The unit of a column in a row: its own, or the one that stands beside each value.
fn unit_of(table: &Table, column: &Column, row: usize) -> String {
    let beside = unit_beside(table.schema(), column).and_then(|unit| table.column(unit));
    beside.map_or_else(|| column.unit.clone(), |units| units.cell(row).to_string())
}

fn worst(
    compared: &[(&Shared<'_>, &Differences)],
    rows: &MatchedRows,
    key_at: &dyn Fn(usize) -> Key,
    unit_at: &dyn Fn(&Column, usize) -> String,
) -> Vec<Worst> {
    let mut cells: Vec<(f64, usize, &Shared<'_>)> = Vec::new();
    for (shared, found) in compared {
        cells.extend(found.worst.iter().map(|&(size, place)| (size, place, *shared)));
    }
    // The sort is stable: of equals the first row, then the first column.
    cells.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut seen = Vec::new();
    cells.retain(|(_, place, _)| {
        !seen.contains(place) && {
            seen.push(*place);
            true
        }
    });
    let one = |&(_, place, shared): &(f64, usize, &Shared<'_>)| {
        let (i, j) = rows.matched[place];
        let difference = match (&*shared.before, shared.after) {
            (Data::Float(a), Data::Float(b)) => Some(b[j] - a[i]).filter(|difference| !difference.is_nan()),
            #[allow(clippy::cast_precision_loss)]
            (Data::Integer(a), Data::Integer(b)) => Some(b[j].wrapping_sub(a[i]) as f64),
            _ => None,
        };
        Worst {
            key: key_at(place),
            column: shared.column.name.clone(),
            unit: unit_at(shared.column, place),
            before: shared.before.cell(i).into(),
            after: shared.after.cell(j).into(),
            difference,
        }
    };
    cells.iter().take(KEPT).map(one).collect()
}

/// Whether a column may be given a tolerance.
#[must_use]
pub fn is_number(record: &ColumnRecord) -> bool {
    matches!(Type::from_name(&record.kind), Some(Type::Float | Type::Integer))
}
