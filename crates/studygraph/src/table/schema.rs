//! What a table's columns are: name, type, unit, meaning, and how far two values may differ and still agree.

use serde::{Deserialize, Serialize};

use declare::digest::Writer;

/// The type of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Type {
    Float,
    Integer,
    Text,
    Flag,
}

impl Type {
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Float => "float",
            Self::Integer => "integer",
            Self::Text => "text",
            Self::Flag => "flag",
        }
    }

    /// The reverse of [`Type::name`].
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Float, Self::Integer, Self::Text, Self::Flag].into_iter().find(|kind| kind.name() == name)
    }
}

/// How far two values of a column may be apart and still count as the same: `|a − b| ≤ absolute + relative·max(|a|, |b|)`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tolerance {
    /// In the column's unit.
    pub absolute: f64,
    pub relative: f64,
}

/// One column. Values are kept in `unit`, as a reader sees them, not in SI.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Column {
    pub name: String,
    pub kind: Type,
    /// Empty for counts, words and ratios.
    pub unit: String,
    /// One sentence with the symbol and the source.
    pub description: String,
    /// Part of the row's key; keys are unique and sorted.
    pub key: bool,
    pub tolerance: Tolerance,
    /// Differs from run to run (seconds): outside content hash and comparison.
    pub volatile: bool,
    /// Whether NaN ("not applicable here") may stand in it.
    pub allows_nan: bool,
    /// Computed only when somebody asks for it by name.
    pub on_demand: bool,
}

impl Column {
    fn new(name: &str, kind: Type, unit: &str, description: &str) -> Self {
        Self {
            name: name.to_owned(),
            kind,
            unit: unit.to_owned(),
            description: description.to_owned(),
            key: false,
            tolerance: Tolerance::default(),
            volatile: false,
            allows_nan: false,
            on_demand: false,
        }
    }

    /// A number; two values agree within 1e-9 relative unless [`Column::tolerance`] says otherwise.
    #[must_use]
    pub fn float(name: &str, unit: &str, description: &str) -> Self {
        Self {
            tolerance: Tolerance { absolute: 0.0, relative: 1e-9 },
            ..Self::new(name, Type::Float, unit, description)
        }
    }

    #[must_use]
    pub fn integer(name: &str, description: &str) -> Self {
        Self::new(name, Type::Integer, "", description)
    }

    #[must_use]
    pub fn text(name: &str, description: &str) -> Self {
        Self::new(name, Type::Text, "", description)
    }

    #[must_use]
    pub fn flag(name: &str, description: &str) -> Self {
        Self::new(name, Type::Flag, "", description)
    }

    #[must_use]
    pub fn key(mut self) -> Self {
        self.key = true;
        self
    }

    #[must_use]
    pub fn tolerance(mut self, absolute: f64, relative: f64) -> Self {
        self.tolerance = Tolerance { absolute, relative };
        self
    }

    #[must_use]
    pub fn volatile(mut self) -> Self {
        self.volatile = true;
        self
    }

    #[must_use]
    pub fn allows_nan(mut self) -> Self {
        self.allows_nan = true;
        self
    }

    #[must_use]
    pub fn on_demand(mut self) -> Self {
        self.on_demand = true;
        self
    }
}

/// The columns of a table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Schema {
    pub name: String,
    pub description: String,
    pub columns: Vec<Column>,
    /// Computed only when somebody asks for it by name.
    pub on_demand: bool,
    /// Files that the table holds line by line, in its text columns `file` and `text`: the store puts them beside the
    /// tables. No part of the table's content.
    pub files: Vec<String>,
}

impl Schema {
    #[must_use]
    pub fn new(name: &str, description: &str, columns: Vec<Column>) -> Self {
        let (name, description) = (name.to_owned(), description.to_owned());
        Self { name, description, columns, on_demand: false, files: Vec::new() }
    }

    /// A table that holds these files.
    #[must_use]
    pub fn of_files(name: &str, description: &str, files: Vec<String>) -> Self {
        let columns = vec![
            Column::text("file", "Name of the file.").key(),
            Column::integer("line", "Number of the line, from 1.").key(),
            Column::text("text", "The line."),
        ];
        Self { files, ..Self::new(name, description, columns) }
    }

    #[must_use]
    pub fn on_demand(mut self) -> Self {
        self.on_demand = true;
        self
    }

    #[must_use]
    pub fn position(&self, column: &str) -> Option<usize> {
        self.columns.iter().position(|candidate| candidate.name == column)
    }

    #[must_use]
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name)
    }

    pub fn key_columns(&self) -> impl Iterator<Item = usize> + '_ {
        self.columns.iter().enumerate().filter(|(_, column)| column.key).map(|(index, _)| index)
    }

    /// Writes what the columns are; volatile columns and prose stay out.
    pub fn write(&self, writer: &mut Writer) {
        let kept: Vec<_> = self.columns.iter().filter(|column| !column.volatile).collect();
        writer.text(&self.name).count(kept.len());
        for column in kept {
            writer.text(&column.name).text(column.kind.name()).text(&column.unit).flag(column.key);
        }
    }
}
