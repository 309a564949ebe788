//! The command line: words in, exit code out. The only layer that prints.
//!
//! Must not know: how anything is computed.

pub mod archive;
pub mod arguments;
mod complete;
mod diff;
pub mod draw;
pub mod embedded;
mod engine;
mod events;
pub mod format;
mod gc;
mod help;
mod json;
mod lsp;
pub mod pages;
mod plan;
pub mod print;
pub mod progress;
mod query;
mod report;
mod rights;
pub mod run;
mod scratch;
mod serve;
mod shard;
pub mod show;
mod signals;
mod status;
mod studies;
pub mod verify;
mod watch;

use std::ffi::OsString;
use std::io::Write;

pub use progress::complain;

/// What the program allocates with.
pub use studygraph::stage::memory::Allocator;

use clap::Parser;

use declare::error::Diagnostic;
use studygraph::store::parquet;
use studygraph::study::LoadError;

use arguments::{Arguments, Command, Places};
use studies::load_all;

/// Why a command ended without doing all of its work.
#[derive(Debug, thiserror::Error)]
pub enum Ending {
    /// A word or a name on the command line that makes no sense, a file that is not there or cannot be written.
    #[error("{0}")]
    Usage(String),
    #[error("{0}")]
    Invalid(Box<LoadError>),
    /// A query that makes no sense, or asks for what is not there.
    #[error("{0}")]
    Query(String),
    /// Some of several studies are none; what is wrong with them was printed.
    #[error("{0}")]
    Unreadable(String),
    /// A study that would take more than it may.
    #[error("{0}")]
    Beyond(String),
    /// A stage failed; what it said was printed where it happened.
    #[error("{0}")]
    Failed(String),
    /// Something came out other than it was; empty where what was printed says it all.
    #[error("{0}")]
    Differs(String),
    #[error("stopped; what was finished is kept, and the next run goes on from there")]
    Stopped,
}

impl Ending {
    /// What is wrong that has no place in a file: a name on the command line that no stage has, for one.
    fn without_place(diagnostic: &Diagnostic) -> Self {
        let help = diagnostic.help.as_ref().map(|help| format!("; {help}")).unwrap_or_default();
        Self::Usage(format!("{}{help}", diagnostic.message))
    }

    /// The exit code, as the help lists it.
    #[must_use]
    pub fn code(&self) -> i32 {
        match self {
            Self::Usage(_) => 1,
            Self::Invalid(error) if error.is_of_no_file() => 1,
            Self::Invalid(_) | Self::Beyond(_) | Self::Query(_) | Self::Unreadable(_) => 2,
            Self::Failed(_) => 3,
            Self::Differs(_) => 4,
            // As a shell reports a program that a signal ended.
            Self::Stopped => signals::code(),
        }
    }
}

/// What `70` in the help means.
pub const BUG: i32 = 70;

/// A panic says where it was, but for those that become an error elsewhere.
pub fn tell_panics() {
    let tell = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if !parquet::is_guarded() {
            tell(panic);
        }
    }));
}

/// Runs the program with these words and gives its exit code.
pub fn main(words: impl Iterator<Item = OsString>) -> i32 {
    if let Some(code) = complete::asked() {
        return code;
    }
    signals::report_large_files();
    let arguments = match Arguments::try_parse_from(words) {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version are asked for; everything else is a slip. When even this cannot be printed, the code says it.
            let printed = error.print().and_then(|()| std::io::stdout().flush());
            return i32::from(error.use_stderr() || printed.is_err());
        }
    };
    let code = match command(&arguments) {
        Ok(()) => 0,
        Err(ending) => {
            match &ending {
                Ending::Invalid(error) => draw::invalid_study(error),
                Ending::Differs(message) if message.is_empty() => {}
                other => progress::aside(None, &format!("gearstudy: {other}")),
            }
            ending.code()
        }
    };
    if progress::is_unwritten() { 1 } else { code }
}

fn command(arguments: &Arguments) -> Result<(), Ending> {
    let places = &arguments.places;
    places.check().map_err(Ending::Usage)?;
    let quiet = arguments.quiet;
    match &arguments.command {
        Command::New { file, template, output } => show::new_study(file, template, output.is_json()),
        Command::Check { studies: words, changes, output } => {
            show::check(&studies::named_or_all(words)?, changes, output.is_json(), quiet)
        }
        Command::Plan { studies, changes, selection, limits, output } => run::plan(
            &load_all(studies, changes)?,
            places,
            selection,
            &run::How { limits: *limits, ..run::How::default() },
            output.is_json(),
        ),
        Command::Run { studies, changes, selection, limits, jobs, dry_run: true, output, .. } => {
            let how = run::How { limits: *limits, jobs: jobs.map(usize::from), ..run::How::default() };
            run::plan(&load_all(studies, changes)?, places, selection, &how, output.is_json())
        }
        Command::Run { output, .. } => {
            let result = run_studies(&arguments.command, places, quiet);
            if output.is_json() {
                events::ended(&result);
            }
            result
        }
        Command::Shard(asked) => shard::shard(asked, places, quiet),
        Command::Watch { study, changes, selection, port, output } => {
            watch::watch(study, changes, places, selection, *port, (output.is_json(), quiet))
        }
        Command::Status { studies: words, changes, output, check } => {
            status::status(words, changes, places, output.is_json(), *check)
        }
        Command::Archive { study, changes, output, license, authors, telling } => {
            let about = archive::About { license: license.as_deref(), authors };
            let study = &load_all(std::slice::from_ref(study), changes)?[0];
            archive::archive(study, places, output, &about, telling.is_json(), quiet)
        }
        Command::Verify { file, limits, jobs, output } => {
            verify::verify(file, jobs.map(usize::from), limits, output.is_json(), quiet)
        }
        Command::Report { studies, changes, check, output } => {
            report::report(&load_all(studies, changes)?, places, *check, output.is_json(), quiet)
        }
        Command::Table { study, changes, table, conditions, columns, format } => show::table(
            &load_all(std::slice::from_ref(study), changes)?[0],
            places,
            table.as_deref(),
            conditions,
            columns,
            *format,
            quiet,
        ),
        Command::Diff(asked) => diff::diff(asked, places, quiet),
        Command::Query(asked) => query::query(asked, places, quiet),
        Command::Gc(asked) => gc::gc(places, asked),
        Command::Import { file, stage, output } => show::import(file, stage.as_deref(), output.is_json()),
        Command::Kinds { kind, output } => show::kinds(kind.as_deref(), output.is_json()),
        Command::Lsp => lsp::lsp(),
        Command::Help { command, man } => help::help(command, man.as_deref()),
        Command::Completions { shell } => complete::script(*shell),
        Command::Schema => {
            show::schema();
            Ok(())
        }
    }
}

/// `run`, here or elsewhere.
fn run_studies(command: &Command, places: &Places, quiet: bool) -> Result<(), Ending> {
    let Command::Run { studies, changes, selection, limits, explain, keep_going, jobs, elsewhere, output, .. } =
        command
    else {
        return Ok(());
    };
    let jobs = jobs.map(usize::from);
    if elsewhere.engine.is_some() {
        let (studies, told) = (load_all(studies, changes)?, shard::told(quiet, *output));
        return engine::run(&studies, places, selection, limits, jobs, elsewhere, told);
    }
    let (explain, keep_going, json) = (*explain, *keep_going, output.is_json());
    let how = run::How { explain, keep_going, jobs, limits: *limits, quiet, json };
    if studies::settings(changes).is_empty() && run::is_up_to_date(studies, places, selection, &how)? {
        return Ok(());
    }
    run::run(&load_all(studies, changes)?, places, selection, &how)
}
