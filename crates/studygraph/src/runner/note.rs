//! A note that a study is up to date: what was asked, and the files by which that is known, each with its stamp. While none
//! of them has changed, a run need read neither study nor manifest.
//!
//! Stamps are trusted as those of the index are (`store/index.rs`): not of another start of the machine, nor of the moment in
//! which the note was written. It lies in the cache, one for each study's file and results folder; losing it costs time only.
//! Must not know: how a run finds out that there is nothing to do.

use std::fs;
use std::path::{Path, PathBuf};
use std::thread;

use serde::{Deserialize, Serialize};

use super::events::{Event, Observer};
use super::options::{Force, Options};
use super::outcome::Outcome;
use crate::store::cache::{Cache, NOTES};
use crate::store::file::{self, Durability};
use crate::store::index::{INDEX, Seen, Stamp, TICK};
use crate::store::lock::boot;
use crate::store::results::{Folder, MANIFEST, Published};
use crate::study::Study;
use declare::digest::{Digest, Writer};

const FORMAT: u32 = 4;

/// What a run with nothing to do says.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Note {
    format: u32,
    pub study: String,
    pub stages: usize,
    #[serde(with = "crate::store::hexadecimal")]
    question: Digest,
    boot: String,
    files: Vec<(PathBuf, u64, Stamp)>,
    /// Of the study itself.
    notes: Vec<String>,
    /// Of its stages that have any.
    warnings: Vec<(String, Vec<String>)>,
}

/// Where a run reads and writes.
pub struct Where<'a> {
    pub study: &'a Path,
    pub results: &'a Path,
    pub cache: &'a Path,
}

impl Where<'_> {
    /// The file of the note; none where a path cannot be made absolute.
    fn note(&self) -> Option<PathBuf> {
        let mut writer = Writer::new("gearstudy 1 note");
        for path in [self.study, self.results] {
            writer.text(&std::path::absolute(path).ok()?.to_string_lossy());
        }
        Some(self.cache.join(NOTES).join(format!("{}.json", writer.finish().short())))
    }
}

/// Everything that decides what a run comes to, besides files; none where it computes in any case.
fn question(code: &str, options: &Options, text: &[u8]) -> Option<Digest> {
    let Options { jobs: _, keep_going: _, force, only, wanted, limits: _, share } = options;
    // What is only a part of a run leaves nothing that is up to date.
    if *force != Force::Nothing || !share.is_empty() {
        return None;
    }
    let mut writer = Writer::new("gearstudy 1 question");
    writer.text(code).text(&blake3::hash(text).to_string()).count(only.len());
    for name in only {
        writer.text(name);
    }
    writer.count(wanted.len());
    for wanted in wanted {
        writer.text(&wanted.stage).text(&wanted.want.table).count(wanted.want.columns.len());
        for column in &wanted.want.columns {
            writer.text(column);
        }
    }
    Some(writer.finish())
}

/// The note that a study is up to date, when it still is.
#[must_use]
pub fn of(at: &Where<'_>, code: &str, options: &Options) -> Option<Note> {
    let path = at.note()?;
    let moment = Stamp::of(&fs::metadata(&path).ok()?).earlier();
    let note: Note = serde_json::from_slice(&file::read(&path, file::MOST_MANIFEST).ok()?).ok()?;
    let text = file::read(at.study, file::MOST_MANIFEST).ok()?;
    let is_asked = note.format == FORMAT && note.boot == boot() && question(code, options, &text)? == note.question;
    let is_as_noted = |(path, bytes, stamp): &(PathBuf, u64, Stamp)| {
        let now = fs::metadata(path).ok().filter(fs::Metadata::is_file);
        stamp.is_before(moment) && now.is_some_and(|now| (now.len(), Stamp::of(&now)) == (*bytes, *stamp))
    };
    (is_asked && note.files.iter().all(is_as_noted)).then_some(note)
}

impl Note {
    /// Tells the warnings of the study and of all its stages.
    pub fn tell_warnings(&self, observer: &dyn Observer) {
        for message in &self.notes {
            observer.event(&Event::Warning { message });
        }
        let warnings: Vec<_> =
            self.warnings.iter().map(|(stage, warnings)| (stage.as_str(), warnings.as_slice())).collect();
        observer.event(&Event::Recalled { warnings: &warnings });
    }
}

/// Notes that a study is up to date, where a run came to its end and all it needs is on the disk.
pub(super) fn keep(
    study: &Study,
    (cache, options, folder): (&Cache, &Options, &Folder),
    (outcome, published): (&Outcome, &Published),
) {
    let results = folder.path().parent().unwrap_or(folder.path());
    let at = Where { study: &study.path, results, cache: cache.root() };
    let ended = outcome.faults().next().is_none() && !outcome.stopped && published.undrawn.is_none();
    if !ended || outcome.unkept(cache) > 0 || cache.problems() != (None, None) || published.seen.is_empty() {
        return;
    }
    let code = study.program.about.code;
    let (Some(path), Some(question)) = (at.note(), question(code, options, study.text.as_bytes())) else { return };
    let Some(files) = files((cache, &study.name), folder, outcome, &published.seen) else { return };
    let of_stages = outcome.stages.iter().filter(|stage| !stage.warnings.is_empty());
    let note = Note {
        format: FORMAT,
        study: study.name.clone(),
        stages: outcome.stages.len(),
        question,
        boot: boot(),
        files,
        notes: study.warnings().collect(),
        warnings: of_stages.map(|stage| (stage.name.clone(), stage.warnings.clone())).collect(),
    };
    if of(&at, code, options).is_some_and(|earlier| earlier == note) {
        return;
    }
    // Without it the next run finds out for itself.
    let _ = write(&path, &note);
}

fn write(path: &Path, note: &Note) -> Option<()> {
    let bytes = serde_json::to_vec(note).ok()?;
    fs::create_dir_all(path.parent()?).ok()?;
    let newest = note.files.iter().map(|(_, _, stamp)| stamp.later()).max()?;
    // Written in the same moment, a stamp would tell nothing.
    for _ in 0..2 {
        file::write(path, &bytes, Durability::Lazy).ok()?;
        if newest < Stamp::of(&fs::metadata(path).ok()?).earlier() {
            break;
        }
        thread::sleep(TICK);
    }
    Some(())
}

/// All files that a run with nothing to do would look at; none when one is not there.
fn files(
    (cache, study): (&Cache, &str),
    folder: &Folder,
    outcome: &Outcome,
    seen: &[Seen],
) -> Option<Vec<(PathBuf, u64, Stamp)>> {
    let mut files = Vec::new();
    for seen in seen {
        files.push((folder.path().join(&seen.file), seen.bytes, seen.stamp?));
    }
    let own = [MANIFEST, INDEX].map(|name| folder.path().join(name));
    let of_cache =
        cache.files(outcome.keys()).into_iter().chain([cache.journal_path(study), cache.root().join("lock")]);
    for path in of_cache.chain(own) {
        let metadata = fs::metadata(&path).ok()?;
        files.push((path, metadata.len(), Stamp::of(&metadata)));
    }
    files.iter_mut().try_for_each(|(path, _, _)| {
        *path = std::path::absolute(&*path).ok()?;
        Some(())
    })?;
    Some(files)
}
