//! `gearstudy watch`: a study is run whenever its file is saved, or one that it names, and the page that is open follows.
//!
//! The system tells of saves; nothing looks at the disk in between. A study with a mistake shows its message over the last
//! good page. Must not know: how a study is run, how pages are sent.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::time::Duration;

use notify::event::{AccessKind, AccessMode, ModifyKind};
use notify::{EventKind, RecursiveMode, Watcher};
use serde_json::json;

use super::arguments::{Changes, Places, Selection};
use super::progress::{self, tell};
use super::run::{self, How};
use super::serve::{Board, Server};
use super::signals::stop_flag;
use super::{Ending, draw, events, pages, show, studies};
use crate::program::{self, examine};
use studygraph::presence;
use studygraph::store::file;
use studygraph::store::results::Folder;

/// How often it is looked whether somebody asked to stop.
const PAUSE: Duration = Duration::from_millis(100);
/// An editor saves in several steps: those that follow each other within this are one.
const SETTLED: Duration = Duration::from_millis(15);
/// How long whoever writes a file may hold it open before it is read as it is. A save empties the file first; a busy system
/// may leave it so for longer than steps of a save are apart.
const UNCLOSED: Duration = Duration::from_secs(2);

pub(super) fn watch(
    word: &Path,
    changes: &Changes,
    places: &Places,
    selection: &Selection,
    port: u16,
    (as_json, quiet): (bool, bool),
) -> Result<(), Ending> {
    let file = studies::file(word)?;
    // A mistake in a study can be mended while it is watched; of a file that is not there, the name is the mistake.
    if !presence::metadata(&file).is_ok_and(|found| found.is_some_and(|found| !found.is_dir())) {
        program::load_changed(&file, &studies::settings(changes)).map_err(|error| Ending::Invalid(Box::new(error)))?;
    }
    let cannot = |error: notify::Error| Ending::Usage(format!("cannot watch {}: {error}", file.display()));
    let (mut watcher, saves) = saves_of(&file).map_err(cannot)?;
    let (stop, board) = (stop_flag(None), Arc::new(Board::default()));
    let server = Server::start(port, Arc::clone(&board)).map_err(Ending::Usage)?;
    if as_json {
        let (file, page) = (file.to_string_lossy(), server.address());
        events::line(&json!({ "event": "watching", "file": file, "page": page }));
    } else if !quiet {
        tell(&format!("{} is watched; its page: {} (Ctrl-C ends)\n", file.display(), server.address()));
    }
    let mut last = None;
    loop {
        // A file that is gone is a change too.
        let saved = Some(saved(&file, changes));
        if last != saved {
            for (beside, _) in saved.iter().flatten().skip(1) {
                // A folder that is not there yet is not watched, and the study refused until it is saved again.
                let _ = watcher.watch(folder_of(beside), RecursiveMode::NonRecursive);
            }
            last = saved;
            renew(&file, changes, places, selection, (as_json, quiet), &stop, &board)?;
        }
        let mut step = loop {
            if stop.load(Ordering::Relaxed) {
                return Err(Ending::Stopped);
            }
            match saves.recv_timeout(PAUSE) {
                Ok(step) => break step,
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(Ending::Usage("the system tells of no more saves".to_owned()));
                }
            }
        };
        while let Ok(next) = saves.recv_timeout(if step == Step::Last { SETTLED } else { UNCLOSED }) {
            step = next;
        }
    }
}

/// The study's file, and those that it names, with what is in each.
fn saved(file: &Path, changes: &Changes) -> Vec<(PathBuf, Option<Vec<u8>>)> {
    // A pipe would be waited for.
    let read = |file: &Path| file::read(file, file::MOST_MANIFEST).ok();
    let bytes = read(file);
    let text = bytes.as_deref().map(String::from_utf8_lossy).unwrap_or_default();
    let beside = program::files(&text, file, &studies::settings(changes));
    let of = |file: PathBuf| {
        let bytes = read(&file);
        (file, bytes)
    };
    std::iter::once((file.to_owned(), bytes.clone())).chain(beside.into_iter().map(of)).collect()
}

fn folder_of(file: &Path) -> &Path {
    file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// What the system tells of a save.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Step {
    /// The file may still be written to.
    Early,
    /// It was closed, put in the place of another, or removed.
    Last,
}

impl Step {
    /// None where nothing changes.
    fn of(kind: EventKind) -> Option<Self> {
        match kind {
            EventKind::Access(AccessKind::Close(AccessMode::Write))
            | EventKind::Modify(ModifyKind::Name(_))
            | EventKind::Remove(_) => Some(Self::Last),
            EventKind::Access(_) => None,
            // Only Linux tells when a file is closed.
            _ if cfg!(target_os = "linux") => Some(Self::Early),
            _ => Some(Self::Last),
        }
    }
}

/// Tells of saves of a file, or of any table beside it, while the first is kept. Its folder is watched: an editor may put another file in its place.
fn saves_of(file: &Path) -> Result<(impl Watcher, Receiver<Step>), notify::Error> {
    let (saved, saves) = mpsc::channel();
    let name = file.file_name().map(std::ffi::OsStr::to_owned);
    let before = threads();
    let mut watcher = notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
        let Ok(event) = event else { return };
        let is_csv = |path: &Path| path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv"));
        let is_ours = event.paths.iter().any(|path| path.file_name() == name.as_deref() || is_csv(path));
        if let Some(step) = Step::of(event.kind).filter(|_| is_ours) {
            // Nobody listens any more once the program ends.
            let _ = saved.send(step);
        }
    })?;
    // The watcher starts a thread, does not report that it got none, and panics when it is used without.
    if before.is_some() && before == threads() {
        // Also when it is dropped.
        std::mem::forget(watcher);
        return Err(notify::Error::generic("cannot start a thread"));
    }
    watcher.watch(folder_of(file), RecursiveMode::NonRecursive)?;
    Ok((watcher, saves))
}

/// The number of threads of this program, where the system says it.
fn threads() -> Option<usize> {
    let tasks = presence::entries(Path::new("/proc/self/task")).ok()?;
    (!tasks.is_empty()).then_some(tasks.len())
}

/// Runs the study as it is now, and shows its page or what is wrong.
fn renew(
    file: &Path,
    changes: &Changes,
    places: &Places,
    selection: &Selection,
    (as_json, quiet): (bool, bool),
    stop: &AtomicBool,
    board: &Board,
) -> Result<(), Ending> {
    let study = match show::rehearsed(examine(file, &studies::settings(changes))) {
        Ok(study) => study,
        Err(error) => {
            board.show(error.to_string(), None);
            if as_json {
                events::ended(&Err(Ending::Invalid(Box::new(error))));
            } else {
                draw::invalid_study(&error);
            }
            return Ok(());
        }
    };
    let folder = Folder::new(&places.results, &study.name);
    let how = How { quiet, json: as_json, ..How::default() };
    let result = run::run_one(&study, places, selection, &how, progress::bars(quiet || as_json).as_ref(), stop);
    if as_json {
        events::ended(&result);
    }
    match result {
        Ok(()) => board.show(String::new(), Some(folder.path().to_owned())),
        Err(Ending::Stopped) => return Err(Ending::Stopped),
        Err(ending) => {
            progress::told(&ending.to_string());
            // What could be computed was published.
            let folder = presence::is_file(&pages::path(&folder)).unwrap_or(false).then(|| folder.path().to_owned());
            board.show(ending.to_string(), folder);
        }
    }
    Ok(())
}
