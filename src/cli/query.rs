//! The command `query`: SQL over tables.
//!
//! Must not know: how a query is answered.

use std::path::Path;
use std::time::Duration;

use serde_json::Value;

use super::arguments::{Format, Places, Question};
use super::diff::{side, study_name, working_tree};
use super::print::{Grid, Heading};
use super::progress::{out, told};
use super::show::table_value;
use super::{Ending, json, studies};
use crate::query::tables::{List, Tables};
use crate::query::{Answer, Kind, ask};
use declare::number::counted;
use studygraph::history::git::Repository;
use studygraph::store::cache::Cache;
use studygraph::store::file::{self, Durability};
use studygraph::store::manifest::TableRecord;
use studygraph::store::parquet;
use studygraph::table::data::{Cell, Data, Table};
use studygraph::table::schema::{Column, Schema};

pub(super) fn query(asked: &Question, places: &Places, quiet: bool) -> Result<(), Ending> {
    let target = asked.output.as_deref().map(|path| Target::of(path).map_err(Ending::Usage)).transpose()?;
    let cache = Cache::open_if_there(&places.cache).map_err(|error| Ending::Usage(error.to_string()))?;
    let repository = Repository::around(&places.results);
    let open = |revision: Option<&str>| {
        let Some(word) = revision.or(asked.at.as_deref()) else {
            return working_tree(places).map_err(|error| error.to_string());
        };
        let none = || match repository.as_ref().map(|repository| repository.commit(word)) {
            Ok(Err(problem)) => problem,
            Err(problem) => problem.clone(),
            Ok(Ok(_)) => format!("there are no results at `{word}`"),
        };
        side(word, places, &repository)?.ok_or_else(none)
    };
    let study = asked.study.as_deref().map(study_name);
    let on_demand = |study: &str, name: &str| studies::only_on_demand(&studies::of_name(study)?, name);
    let mut tables = Tables::new(&open, &on_demand, study.as_deref(), cache.as_ref());
    let Some(text) = &asked.sql else {
        match asked.format {
            Format::Pretty => out(&list(&mut tables).map_err(Ending::Usage)?),
            Format::Json => json::answer(&listed(&mut tables).map_err(Ending::Usage)?),
            Format::Csv | Format::Excel | Format::ExcelComma | Format::Markdown => {
                return Err(Ending::Usage("the list of tables is shown as `pretty` or as `json`".to_owned()));
            }
        }
        return Ok(());
    };
    let limit = Duration::from_secs(asked.timeout.into());
    let answer = ask(text, &mut tables, limit);
    let answer = answer.map_err(if tables.is_unread() { Ending::Usage } else { Ending::Query })?;
    match (asked.output.as_deref(), target) {
        (Some(path), Some(target)) => write(&answer, path, target, quiet),
        _ => {
            out(&grid(&answer).text(asked.format).map_err(Ending::Usage)?);
            Ok(())
        }
    }
}

/// Every table and its columns with their units, since an answer has none.
fn list(tables: &mut Tables<'_>) -> Result<String, String> {
    let mut text = String::new();
    for (name, record) in all(tables)? {
        text += &format!("{name}  {}\n", counted(record.rows, "row"));
        for column in record.columns.iter() {
            let unit = if column.unit.is_empty() { String::new() } else { format!(" [{}]", column.unit) };
            text += &format!("  {}{unit}: {}\n", column.name, column.description);
        }
    }
    Ok(text)
}

fn listed(tables: &mut Tables<'_>) -> Result<Value, String> {
    Ok(all(tables)?.iter().map(|(name, record)| table_value(record, name)).collect())
}

/// All tables; of studies that cannot be read, a warning.
fn all(tables: &mut Tables<'_>) -> Result<Vec<(String, TableRecord)>, String> {
    let List { tables, problems } = tables.list()?;
    for problem in problems {
        told(&format!("warning: {problem}"));
    }
    Ok(tables)
}

fn grid(answer: &Answer) -> Grid<'_> {
    let heading = |column: &crate::query::Column| {
        let name = column.name.clone();
        Heading { shown: name.clone(), name, is_number: column.is_number() }
    };
    Grid {
        columns: answer.columns.iter().map(heading).collect(),
        rows: answer.columns.first().map_or(0, |column| column.cells.len()),
        cell: Box::new(|row, column| answer.columns[column].cells[row].clone()),
    }
}

/// What a file's name asks for.
#[derive(Clone, Copy)]
enum Target {
    Text(Format),
    Parquet,
}

impl Target {
    fn of(path: &Path) -> Result<Self, String> {
        match path.extension().and_then(|end| end.to_str()) {
            Some("csv") => Ok(Self::Text(Format::Csv)),
            Some("json") => Ok(Self::Text(Format::Json)),
            Some("md") => Ok(Self::Text(Format::Markdown)),
            Some("parquet") => Ok(Self::Parquet),
            _ => Err(format!("`{}` ends in none of .csv, .json, .md, .parquet", path.display())),
        }
    }
}

fn write(answer: &Answer, path: &Path, target: Target, quiet: bool) -> Result<(), Ending> {
    let bytes = match target {
        Target::Text(format) => grid(answer).text(format).map_err(Ending::Usage)?.into_bytes(),
        Target::Parquet => {
            let table = table(answer).map_err(Ending::Query)?;
            parquet::write(&table).map_err(|error| Ending::Usage(error.to_string()))?
        }
    };
    file::sweep_ended(path.parent().unwrap_or(Path::new("")));
    file::write(path, &bytes, Durability::Lazy).map_err(|error| Ending::Usage(error.to_string()))?;
    let rows = answer.columns.first().map_or(0, |column| column.cells.len());
    if !quiet {
        out(&format!("wrote {}, {}\n", path.display(), counted(rows, "row")));
    }
    Ok(())
}

/// The rows as a table of this program; where a number does not apply, it has NaN.
fn table(answer: &Answer) -> Result<Table, String> {
    let (mut columns, mut data) = (Vec::new(), Vec::new());
    for column in &answer.columns {
        let empty = || {
            let name = &column.name;
            format!(
                "`{name}` has empty cells, which only columns of numbers have in a Parquet file of this program: \
                 write COALESCE({name}, …)"
            )
        };
        let cells = &column.cells;
        let (own, values) = match column.kind {
            None | Some(Kind::Float) => {
                let values = cells.iter().map(|cell| match cell {
                    Some(Cell::Float(value)) if value.is_infinite() => Err(format!(
                        "`{}` has {value}, which a Parquet file of this program does not hold: write another kind of \
                         file, or leave it out with WHERE",
                        column.name
                    )),
                    Some(Cell::Float(value)) => Ok(*value),
                    _ => Ok(f64::NAN),
                });
                let values = values.collect::<Result<_, _>>()?;
                (Column::float(&column.name, "", "").allows_nan(), Data::Float(values))
            }
            Some(Kind::Integer) => {
                let value = |cell: &Option<Cell>| match cell {
                    Some(Cell::Integer(value)) => Ok(*value),
                    _ => Err(empty()),
                };
                (Column::integer(&column.name, ""), Data::Integer(cells.iter().map(value).collect::<Result<_, _>>()?))
            }
            Some(Kind::Text) => {
                let value = |cell: &Option<Cell>| cell.as_ref().map(Cell::to_string).ok_or_else(empty);
                (Column::text(&column.name, ""), Data::Text(cells.iter().map(value).collect::<Result<_, _>>()?))
            }
            Some(Kind::Flag) => {
                let value = |cell: &Option<Cell>| match cell {
                    Some(Cell::Flag(value)) => Ok(*value),
                    _ => Err(empty()),
                };
                (Column::flag(&column.name, ""), Data::Flag(cells.iter().map(value).collect::<Result<_, _>>()?))
            }
        };
        columns.push(own);
        data.push(values);
    }
    Table::from_columns(Schema::new("query", "The answer to a query.", columns), data)
        .map_err(|error| error.to_string())
}
