//! The words of the command line. Must not know: what any command does.

mod answers;
mod sharding;

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use clap::builder::{PathBufValueParser, TypedValueParser};
use clap::parser::ValueSource;
use clap::{Arg, Args, Parser, Subcommand, ValueEnum};

pub use answers::{Differences, Format, Output, Question, Shown};
pub use sharding::{Elsewhere, Engine, Sharding};

/// Declarative, reproducible studies of spur-gear tooth modifications.
#[derive(Parser, Debug)]
#[command(version, max_term_width = 110, disable_help_subcommand = true, arg_required_else_help = true)]
#[command(after_help = "Exit codes: 0 done, 1 usage, 2 invalid study or query, or a study beyond the \
    limits, 3 a stage failed, \
    4 differences, damage, or with --check what is stale or needs attention, 70 a bug of this program, 130 stopped by Ctrl-C \
    (143 by SIGTERM, 129 by SIGHUP).")]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
    #[command(flatten)]
    pub places: Places,
    /// Say only what went wrong.
    #[arg(long, short, global = true)]
    pub quiet: bool,
}

/// Where the cache is, if nobody says it.
pub const CACHE: &str = ".gearstudy/cache";
/// Where results are, if nobody says it.
pub const RESULTS: &str = "results";

/// Where things are.
#[derive(Args, Debug, Clone)]
pub struct Places {
    /// Folder for tables, manifest and report; each study has a folder of its own in it.
    #[arg(long, global = true, value_name = "DIR", default_value = RESULTS)]
    pub results: PathBuf,
    /// Folder of the cache of computed tables.
    #[arg(long, global = true, value_name = "DIR", env = "GEARSTUDY_CACHE", default_value = CACHE, value_parser = Cache)]
    pub cache: PathBuf,
}

impl Places {
    /// Whether both folders have names that every library takes: libhdf5, messages and JSON have text in UTF-8.
    ///
    /// # Errors
    /// Which one has not.
    pub fn check(&self) -> Result<(), String> {
        let named = |folder: &Path, what: &str, option: &str| match folder.to_str() {
            Some(_) => Ok(()),
            None => {
                Err(format!("the name of the {what} is not UTF-8: `{}`; name another with {option}", folder.display()))
            }
        };
        named(&self.results, "results folder", "--results")?;
        named(&self.cache, "cache folder", "--cache or GEARSTUDY_CACHE")
    }
}

/// The folder of the cache; a variable of the environment that is empty is one that is not set.
#[derive(Clone)]
struct Cache;

impl TypedValueParser for Cache {
    type Value = PathBuf;

    fn parse_ref(
        &self,
        command: &clap::Command,
        argument: Option<&Arg>,
        value: &OsStr,
    ) -> Result<PathBuf, clap::Error> {
        PathBufValueParser::new().parse_ref(command, argument, value)
    }

    fn parse_ref_(
        &self,
        command: &clap::Command,
        argument: Option<&Arg>,
        value: &OsStr,
        source: ValueSource,
    ) -> Result<PathBuf, clap::Error> {
        if source == ValueSource::EnvVariable && value.is_empty() {
            return Ok(PathBuf::from(CACHE));
        }
        self.parse_ref(command, argument, value)
    }
}

#[derive(Subcommand, Debug)]
pub enum Command {
    /// Write a small study to start from.
    New {
        /// The file to write; its name becomes the study's.
        file: PathBuf,
        /// Which study to start from.
        #[arg(long, value_name = "NAME", default_value = "quick")]
        template: String,
        #[command(flatten)]
        output: Output,
    },
    /// Read studies and say what is wrong with them, without running anything.
    Check {
        #[arg(required = true)]
        studies: Vec<PathBuf>,
        #[command(flatten)]
        changes: Changes,
        #[command(flatten)]
        output: Output,
    },
    /// Say what a run would do, and why, what it would leave out, and what it would take.
    Plan {
        #[arg(required = true)]
        studies: Vec<PathBuf>,
        #[command(flatten)]
        changes: Changes,
        #[command(flatten)]
        selection: Selection,
        #[command(flatten)]
        limits: Limits,
        #[command(flatten)]
        output: Output,
    },
    /// Run studies: compute what is missing, write tables, manifest and report.
    Run {
        /// Files, or names of studies in the folder `studies`; so with every command.
        #[arg(required = true)]
        studies: Vec<PathBuf>,
        #[command(flatten)]
        changes: Changes,
        #[command(flatten)]
        selection: Selection,
        #[command(flatten)]
        limits: Limits,
        /// Say for every stage why it runs or not.
        #[arg(long)]
        explain: bool,
        /// As `plan`: compute nothing, write nothing.
        #[arg(long)]
        dry_run: bool,
        /// Go on with the stages that do not depend on one that failed.
        #[arg(long)]
        keep_going: bool,
        /// How many threads to use [default: one per processor].
        #[arg(long, short, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
        jobs: Option<u16>,
        #[command(flatten)]
        elsewhere: Elsewhere,
        #[command(flatten)]
        output: Output,
    },
    /// Run a study whenever its file is saved, and show its page in a browser on this computer, which follows.
    Watch {
        study: PathBuf,
        #[command(flatten)]
        changes: Changes,
        #[command(flatten)]
        selection: Selection,
        /// Where the page is served, on this computer alone [default: a free port].
        #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
        port: u16,
        #[command(flatten)]
        output: Output,
    },
    /// Run a study in pieces on any number of machines: plan, run each piece, merge.
    #[command(subcommand)]
    Shard(Sharding),
    /// Say what is up to date, stale or missing, and why.
    Status {
        /// Without any, those in the folder `studies`.
        studies: Vec<PathBuf>,
        #[command(flatten)]
        changes: Changes,
        /// Read every byte of results and cache; what is damaged, stale, of another run, or missing and not in the cache ends with code 4.
        #[arg(long)]
        check: bool,
        #[command(flatten)]
        output: Output,
    },
    /// Print the verdicts of a study that was run, and write its report anew.
    Report {
        #[arg(required = true)]
        studies: Vec<PathBuf>,
        #[command(flatten)]
        changes: Changes,
        /// Write nothing; end with code 4 where a verdict or a comparison needs attention or the results are not those of the study.
        #[arg(long)]
        check: bool,
        #[command(flatten)]
        output: Output,
    },
    /// Print a table of a study that was run.
    Table {
        study: PathBuf,
        /// `stage.table`; without it, the tables there are.
        table: Option<String>,
        #[command(flatten)]
        changes: Changes,
        /// Only rows where a column has this value; may be given several times.
        #[arg(long = "where", value_name = "COLUMN=VALUE")]
        conditions: Vec<String>,
        /// Only these columns, in this order.
        #[arg(long, value_delimiter = ',', value_name = "A,B")]
        columns: Vec<String>,
        #[arg(long, value_enum, default_value_t = Format::Pretty)]
        format: Format,
    },
    /// Say what changed between two sets of results, and why, without running anything.
    Diff(Differences),
    /// Ask the tables of any studies and commits in SQL; without a query, say which tables there are.
    Query(Question),
    /// Put a study and all its results into one file that describes itself: a Workflow Run RO-Crate.
    Archive {
        study: PathBuf,
        #[command(flatten)]
        changes: Changes,
        /// The file to write.
        #[arg(long, short, value_name = "FILE.zip")]
        output: PathBuf,
        /// Licence of the study and its results as an SPDX expression, for example CC-BY-4.0 or "MIT OR Apache-2.0".
        #[arg(long, value_name = "SPDX")]
        license: Option<String>,
        /// Who made the study, with an ORCID iD behind the name if there is one; may be given several times.
        #[arg(long = "author", value_name = "NAME")]
        authors: Vec<String>,
        #[command(flatten)]
        telling: Output,
    },
    /// Run the study of an archive again, from nothing, and compare every table.
    Verify {
        file: PathBuf,
        #[command(flatten)]
        limits: Limits,
        #[command(flatten)]
        output: Output,
        /// How many threads to use [default: one per processor].
        #[arg(long, short, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
        jobs: Option<u16>,
    },
    /// Delete from the cache what no results need and no run has used lately.
    Gc(Cleaning),
    /// Print the gear pair of a REXS file as a study.
    Import {
        file: PathBuf,
        /// Which cylindrical stage, by its id, where the file has several.
        #[arg(long, value_name = "ID")]
        stage: Option<String>,
        #[command(flatten)]
        output: Output,
    },
    /// List the kinds of stages, or say everything about one, or about a field of it.
    Kinds {
        /// `optimizer`, or `optimizer.design.tip_relief` for what it says of that.
        kind: Option<String>,
        #[command(flatten)]
        output: Output,
    },
    /// Print the JSON schema of a study, for editors.
    Schema,
    /// Say what a command does: its words, its options; or write the manual as man pages.
    Help {
        /// The command, as `run` or `shard plan`.
        #[arg(value_name = "COMMAND")]
        command: Vec<String>,
        /// Write a man page for each command into this folder.
        #[arg(long, value_name = "DIR", conflicts_with = "command")]
        man: Option<PathBuf>,
    },
    /// Print what makes a shell complete words, those of a study too: `source <(gearstudy completions bash)`.
    Completions {
        #[arg(value_enum)]
        shell: Shell,
    },
    /// Serve an editor: mistakes, meanings, completion, by the Language Server Protocol on standard input and output.
    Lsp,
}

/// A shell that completions are made for.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shell {
    Bash,
    Zsh,
    Fish,
    Elvish,
    Powershell,
}

/// What of a study is other than its file says.
#[derive(Args, Debug, Clone, Default)]
pub struct Changes {
    /// Another value for a field, as `pair.pinion.face_width=22 mm`; may be given several times. The study is then called
    /// by its name and a digest of what is set, so that its results overwrite no others.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub set: Vec<String>,
    /// Another name for the study, and so for the folder of its results.
    #[arg(long, value_name = "NAME")]
    pub name: Option<String>,
}

/// What of the cache stays, besides what the results in the results folder need.
#[derive(Args, Debug, Clone)]
pub struct Cleaning {
    /// Keep what was used in the last N days.
    #[arg(long, value_name = "N", default_value_t = 30)]
    pub days: u32,
    /// Keep what the results of this commit need; may be given several times.
    #[arg(long, value_name = "COMMIT")]
    pub keep: Vec<String>,
    /// Of what no results need, delete also what was used longest ago, until the cache is no larger, as 800MB or 4GB.
    #[arg(long, value_name = "SIZE", value_parser = bytes)]
    pub max_size: Option<u64>,
    /// Only say what would be deleted.
    #[arg(long)]
    pub dry_run: bool,
    #[command(flatten)]
    pub output: Output,
}

/// Which stages, and whether to trust the cache.
#[derive(Args, Debug, Clone, Default)]
pub struct Selection {
    /// Only these stages, and what they need.
    #[arg(long, value_name = "STAGE,…", value_delimiter = ',')]
    pub only: Vec<String>,
    /// Also what is computed on demand only: tables (`stage.table`) and columns (`stage.table.column`).
    #[arg(long, value_name = "TABLE,…", value_delimiter = ',')]
    pub want: Vec<String>,
    /// Compute even what is in the cache: everything, or `--force=STAGE,…` only these stages.
    #[arg(long, value_name = "STAGE,…", value_delimiter = ',', num_args = 0.., require_equals = true)]
    pub force: Option<Vec<String>>,
}

/// What a run may take. What would take more is refused before anything runs.
#[derive(Args, Debug, Clone, Copy, Default)]
pub struct Limits {
    /// The most memory, as 800MB or 4GB [default: half of the machine's].
    #[arg(long, value_name = "SIZE", env = "GEARSTUDY_LIMIT_MEMORY", value_parser = bytes)]
    pub limit_memory: Option<u64>,
    /// The most rows of all tables that are computed [default: 20000000].
    #[arg(long, value_name = "N", env = "GEARSTUDY_LIMIT_ROWS")]
    pub limit_rows: Option<u64>,
}

/// A number of bytes with its unit.
fn bytes(text: &str) -> Result<u64, String> {
    const UNITS: [(&str, u64); 6] =
        [("kB", 1_000), ("MB", 1_000_000), ("GB", 1_000_000_000), ("KiB", 1 << 10), ("MiB", 1 << 20), ("GiB", 1 << 30)];
    let help = || "write a number and kB, MB, GB, KiB, MiB or GiB, for example 4GB".to_owned();
    let unit = UNITS.iter().find(|(name, _)| text.to_lowercase().ends_with(&name.to_lowercase()));
    let (name, factor) = unit.ok_or_else(help)?;
    let number: f64 = text[..text.len() - name.len()].trim().parse().map_err(|_| help())?;
    if !(number.is_finite() && number > 0.0) {
        return Err(help());
    }
    // Above 2^64 it is as good as no limit.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    Ok((number * *factor as f64) as u64)
}

#[cfg(test)]
mod tests {
    use super::bytes;

    #[test]
    fn sizes_have_units() {
        assert_eq!(
            ["800MB", "4 GB", "1.5GiB", "7kb"].map(|text| bytes(text).unwrap()),
            [800_000_000, 4_000_000_000, 3 << 29, 7000]
        );
        for wrong in ["", "4", "GB", "-1GB", "0MB", "nanGB", "4 gigabytes"] {
            assert!(bytes(wrong).is_err(), "{wrong}");
        }
    }
}
