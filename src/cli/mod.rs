//! The command line: words in, exit code out. The only layer that prints.
//!
//! Must not know: how anything is computed.

pub mod archive;
pub mod arguments;
mod diff;
pub mod draw;
mod engine;
mod gc;
mod lsp;
pub mod pages;
mod plan;
pub mod print;
pub mod progress;
mod query;
mod rights;
pub mod run;
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

use studygraph::store::parquet;
use studygraph::study::LoadError;

use arguments::{Arguments, Command};
use studies::load_all;

/// Why a command ended without doing all of its work.
#[derive(Debug, thiserror::Error)]
pub enum Ending {
    /// A word or a name on the command line that makes no sense, or a file that cannot be written.
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
    /// The exit code, as the help lists it.
    #[must_use]
    pub fn code(&self) -> i32 {
        match self {
            Self::Usage(_) => 1,
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
    let arguments = match Arguments::try_parse_from(words) {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version are asked for; everything else is a slip. When even this cannot be printed, the code says it.
            let printed = error.print().and_then(|()| std::io::stdout().flush());
            return i32::from(error.use_stderr() || printed.is_err());
        }
    };
    match command(&arguments) {
        Ok(()) => 0,
        Err(ending) => {
            match &ending {
                Ending::Invalid(error) => draw::invalid_study(error),
                Ending::Differs(message) if message.is_empty() => {}
                other => progress::aside(None, &format!("gearstudy: {other}")),
            }
            ending.code()
        }
    }
}

fn command(arguments: &Arguments) -> Result<(), Ending> {
    let places = &arguments.places;
    places.check().map_err(Ending::Usage)?;
    let quiet = arguments.quiet;
    match &arguments.command {
        Command::New { file, template } => show::new_study(file, template),
        Command::Check { studies: words, changes } => show::check(&studies::named_or_all(words)?, changes, quiet),
        Command::Plan { studies, changes, selection, limits, json } => run::plan(
            &load_all(studies, changes)?,
            places,
            selection,
            &run::How { limits: *limits, ..run::How::default() },
            *json,
        ),
        Command::Run { studies, changes, selection, limits, jobs, dry_run: true, .. } => {
            let how = run::How { limits: *limits, jobs: jobs.map(usize::from), ..run::How::default() };
            run::plan(&load_all(studies, changes)?, places, selection, &how, false)
        }
        Command::Run { studies, changes, selection, limits, jobs, elsewhere, .. } if elsewhere.engine.is_some() => {
            engine::run(
                &load_all(studies, changes)?,
                places,
                selection,
                limits,
                jobs.map(usize::from),
                elsewhere,
                quiet,
            )
        }
        Command::Shard(asked) => shard::shard(asked, places, quiet),
        Command::Run { studies, changes, selection, limits, explain, keep_going, jobs, .. } => {
            let (explain, keep_going) = (*explain, *keep_going);
            let how = run::How { explain, keep_going, jobs: jobs.map(usize::from), limits: *limits, quiet };
            if studies::settings(changes).is_empty() && run::is_up_to_date(studies, places, selection, &how)? {
                return Ok(());
            }
            run::run(&load_all(studies, changes)?, places, selection, &how)
        }
        Command::Watch { study, changes, selection, port } => {
            watch::watch(study, changes, places, selection, *port, quiet)
        }
        Command::Status { studies: words, changes, json, check } => {
            status::status(words, changes, places, *json, *check)
        }
        Command::Archive { study, changes, output, license, authors } => {
            let about = archive::About { license: license.as_deref(), authors };
            archive::archive(&load_all(std::slice::from_ref(study), changes)?[0], places, output, &about, quiet)
        }
        Command::Verify { file, limits, jobs, json } => {
            verify::verify(file, jobs.map(usize::from), limits, *json, quiet)
        }
        Command::Report { studies, changes } => run::report(&load_all(studies, changes)?, places, quiet),
        Command::Table { study, changes, table, conditions, columns, format } => show::table(
            &load_all(std::slice::from_ref(study), changes)?[0],
            places,
            table.as_deref(),
            conditions,
            columns,
            *format,
        ),
        Command::Diff(asked) => diff::diff(asked, places, quiet),
        Command::Query(asked) => query::query(asked, places, quiet),
        Command::Gc(asked) => gc::gc(places, asked),
        Command::Import { file, stage } => show::import(file, stage.as_deref()),
        Command::Kinds { kind } => show::kinds(kind.as_deref()),
        Command::Lsp => lsp::lsp(),
        Command::Schema => {
            show::schema();
            Ok(())
        }
    }
}
