//! A note that a study is up to date: what was asked, and the files by which that is known, each with its stamp. While none
//! of them has changed, a run need read neither study nor manifest.
//!
//! Stamps are trusted as those of the index are (`store/index.rs`): not of another start of the machine, nor of the moment in
//! which the note was written. It lies in the cache, one for each study's file and results folder; losing it costs time only.
//! Beside it lies what need not be read again of a study whose text changed since (`recall.rs`). Must not know: how a run finds
//! out that there is nothing to do.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::thread;

use serde::{Deserialize, Serialize};

use super::events::{Event, Observer};
use super::options::{Force, Options};
use super::outcome::Outcome;
use super::recall::Recalled;
use crate::store::cache::{Cache, NOTES};
use crate::store::file::{self, Durability};
use crate::store::index::{INDEX, Seen, Stamp, TICK};
use crate::store::lock::boot;
use crate::store::results::{Folder, MANIFEST, Published};
use crate::study::Study;
use declare::digest::{Digest, Writer};

const FORMAT: u32 = 3;

/// What a run with nothing to do says.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Note {
    format: u32,
    pub study: String,
    pub stages: usize,
    #[serde(with = "crate::store::hexadecimal")]
    question: Digest,
    /// The same whatever the text.
    #[serde(with = "crate::store::hexadecimal")]
    asked: Digest,
    /// Of what is recalled; none where that is nothing.
    recalled: Option<String>,
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

/// Everything that decides what a run comes to, besides files and the study's text; none where it computes in any case.
fn asked(code: &str, options: &Options) -> Option<Digest> {
    let Options { jobs: _, keep_going: _, force, only, wanted, limits: _, share } = options;
    // What is only a part of a run leaves nothing that is up to date.
    if *force != Force::Nothing || !share.is_empty() {
        return None;
    }
    let mut writer = Writer::new("gearstudy 1 question");
    writer.text(code).count(only.len());
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

fn question(asked: &Digest, text: &[u8]) -> Digest {
    Writer::new("gearstudy 1 question of a text").digest(asked).text(&blake3::hash(text).to_string()).finish()
}

/// A note of which all files are as they were, for what is asked now of whatever text.
fn unchanged(at: &Where<'_>, code: &str, options: &Options) -> Option<Note> {
    let path = at.note()?;
    let moment = Stamp::of(&fs::metadata(&path).ok()?).earlier();
    let note: Note = serde_json::from_slice(&file::read(&path, file::MOST_MANIFEST).ok()?).ok()?;
    let is_asked = note.format == FORMAT && note.boot == boot() && asked(code, options)? == note.asked;
    let is_told = |(_, _, stamp): &(PathBuf, u64, Stamp)| stamp.is_before(moment);
    let is_as_noted = |(path, bytes, stamp): &(PathBuf, u64, Stamp)| is_as_noted(path, *bytes, stamp);
    (is_asked && note.files.iter().all(is_told) && note.files.iter().all(is_as_noted)).then_some(note)
}

/// The note that a study is up to date, when it still is.
#[must_use]
pub fn of(at: &Where<'_>, code: &str, options: &Options) -> Option<Note> {
    let note = unchanged(at, code, options)?;
    let text = file::read(at.study, file::MOST_MANIFEST).ok()?;
    (question(&note.asked, &text) == note.question).then_some(note)
}

/// What is recalled of the study of the last run, while all files but its own are as that run left them.
pub(super) fn recalled(at: &Where<'_>, code: &str, options: &Options) -> Option<(Note, Recalled)> {
    let note = unchanged(at, code, options)?;
    // Of what is only a part of the stages the others may have no tables.
    let digest = note.recalled.as_ref().filter(|_| options.only.is_empty())?;
    let bytes = file::read(&stages(&at.note()?), file::MOST_MANIFEST).ok()?;
    if blake3::hash(&bytes).to_string() != *digest {
        return None;
    }
    let recalled = postcard::from_bytes(&bytes).ok()?;
    Some((note, recalled))
}

impl Note {
    /// Tells the warnings of the study and of all its stages.
    pub fn tell_warnings(&self, observer: &dyn Observer) {
        for message in &self.notes {
            observer.event(&Event::Warning { message });
        }
        self.tell_warnings_of(|_| true, observer);
    }

    /// Tells the warnings of the stages that are chosen.
    pub(super) fn tell_warnings_of(&self, is_chosen: impl Fn(&str) -> bool, observer: &dyn Observer) {
        for (stage, warnings) in self.warnings.iter().filter(|(stage, _)| is_chosen(stage)) {
            observer.event(&Event::Recalled { stage, warnings });
        }
    }

    /// Whether all its files in a folder are as they were.
    pub(super) fn holds_in(&self, folder: &Path) -> bool {
        let Ok(folder) = std::path::absolute(folder) else { return false };
        let mut inside = self.files.iter().filter(|(path, _, _)| path.starts_with(&folder));
        self.boot == boot() && inside.all(|(path, bytes, stamp)| is_as_noted(path, *bytes, stamp))
    }
}

fn is_as_noted(path: &Path, bytes: u64, stamp: &Stamp) -> bool {
    let now = fs::metadata(path).ok().filter(fs::Metadata::is_file);
    now.is_some_and(|now| (now.len(), Stamp::of(&now)) == (bytes, *stamp))
}

/// Where what is recalled lies.
fn stages(note: &Path) -> PathBuf {
    note.with_extension("stages")
}

/// Notes that a study is up to date, where a run came to its end and all it needs is on the disk; `earlier`: the note of the
/// run whose stages were not read again.
pub(super) fn keep<'r>(
    study: &Study,
    (cache, options, folder): (&Cache, &Options, &Folder),
    (outcome, published): (&Outcome, &Published),
    recalled: impl FnOnce() -> Option<Cow<'r, Recalled>>,
    earlier: Option<&Note>,
) {
    let results = folder.path().parent().unwrap_or(folder.path());
    let at = Where { study: &study.path, results, cache: cache.root() };
    let ended = outcome.faults().next().is_none() && !outcome.stopped && published.undrawn.is_none();
    if !ended || outcome.unkept(cache) > 0 || cache.problems() != (None, None) || published.seen.is_empty() {
        return;
    }
    let (Some(path), Some(asked)) = (at.note(), asked(study.program.about.code, options)) else { return };
    let before = earlier.map_or(&[][..], |note| &note.files).iter().map(|(path, _, _)| path);
    // Those of the cache: what lies in the results is what was published now.
    let before = before.filter(|path| std::path::absolute(cache.root()).is_ok_and(|root| path.starts_with(root)));
    let Some(files) = files((cache, &study.name), folder, outcome, &published.seen, before.cloned()) else { return };
    let (question, code) = (question(&asked, study.text.as_bytes()), study.program.about.code);
    let notes = study.warnings().collect();
    let of_run = outcome.stages.iter().map(|stage| (stage.name.clone(), stage.warnings.clone()));
    let is_unread = |stage: &str| study.unread.iter().any(|unread| unread.name == stage);
    let of_earlier = earlier.iter().flat_map(|note| &note.warnings).filter(|(stage, _)| is_unread(stage)).cloned();
    let warnings = of_run.chain(of_earlier).filter(|(_, warnings)| !warnings.is_empty()).collect();
    let (study, stages) = (study.name.clone(), outcome.stages.len() + study.unread.len());
    let mut note =
        Note { format: FORMAT, study, stages, question, asked, recalled: None, boot: boot(), files, notes, warnings };
    let same = |known: &Note| Note { recalled: note.recalled.clone(), ..known.clone() } == note;
    if unchanged(&at, code, options).is_some_and(|earlier| same(&earlier)) {
        return;
    }
    note.recalled = recalled().and_then(|recalled| {
        let bytes = postcard::to_stdvec(&*recalled).ok()?;
        fs::create_dir_all(path.parent()?).ok()?;
        file::write(&self::stages(&path), &bytes, Durability::Lazy).ok()?;
        Some(blake3::hash(&bytes).to_string())
    });
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
    before: impl Iterator<Item = PathBuf>,
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
    let known: BTreeSet<PathBuf> = files.iter().map(|(path, _, _)| path.clone()).collect();
    for path in before.filter(|path| !known.contains(path)) {
        let metadata = fs::metadata(&path).ok()?;
        files.push((path, metadata.len(), Stamp::of(&metadata)));
    }
    Some(files)
}
