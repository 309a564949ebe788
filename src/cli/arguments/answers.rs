//! What is asked of results, and how answers are shown. Must not know: what any command does.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

/// How a command tells what it found or did.
#[derive(Args, Debug, Clone, Copy, Default)]
pub struct Output {
    /// For people, or for programs as JSON, whose shapes docs/json.md describes.
    #[arg(long, value_enum, default_value_t, value_name = "FORMAT")]
    format: Telling,
    /// The same as `--format json`.
    #[arg(long, hide = true, conflicts_with = "format")]
    json: bool,
}

impl Output {
    #[must_use]
    pub const fn is_json(self) -> bool {
        self.json || matches!(self.format, Telling::Json)
    }
}

#[derive(ValueEnum, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Telling {
    #[default]
    Pretty,
    Json,
}

#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Pretty,
    Csv,
    /// CSV that Excel opens by a double click: in UTF-8 with its mark, where numbers have a decimal point
    Excel,
    /// The same where numbers have a decimal comma: cells parted by semicolons
    ExcelComma,
    Json,
    Markdown,
}

/// What is asked, of which results.
#[derive(Args, Debug, Clone)]
pub struct Question {
    /// One SELECT; a table is `study.stage.table`, at a commit `"REVISION:study.stage.table"`.
    pub sql: Option<String>,
    /// The revision or folder of results that is meant where a table does not say it [default: the results folder].
    #[arg(long, value_name = "REVISION")]
    pub at: Option<String>,
    /// The study whose tables may be called `stage.table`; not needed where there is one alone.
    #[arg(long, value_name = "NAME")]
    pub study: Option<String>,
    /// Without a query, `json` has the list of tables; the others are for answers.
    #[arg(long, value_enum, default_value_t = Format::Pretty)]
    pub format: Format,
    /// Write to this file, as its name ends: .csv, .json, .md or .parquet.
    #[arg(long, short, value_name = "FILE", conflicts_with = "format", requires = "sql")]
    pub output: Option<PathBuf>,
    /// Seconds after which a query is given up; the time to read its tables does not count.
    #[arg(long, value_name = "SECONDS", default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..))]
    pub timeout: u32,
}

/// What to compare, and how far apart is the same.
#[derive(Args, Debug, Clone)]
pub struct Differences {
    /// Up to two revisions or folders of results, then studies: by default HEAD and the results folder, every study.
    #[arg(value_name = "[A [B]] [STUDY]")]
    pub words: Vec<String>,
    /// Studies whose names are also revisions.
    #[arg(last = true, value_name = "STUDY")]
    pub studies: Vec<String>,
    /// How far a column may differ: relative as a number, absolute with a unit; `stage.table.column`, `table.column` or
    /// `column`; may be given several times.
    #[arg(long = "tolerance", value_name = "COLUMN=VALUE")]
    pub tolerances: Vec<String>,
    #[arg(long, value_enum, default_value_t = Shown::Pretty)]
    pub format: Shown,
}

/// How a comparison is shown.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    Pretty,
    Json,
    Markdown,
    Html,
}
