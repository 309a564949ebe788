//! `--format json` of a run: what happens, a line of JSON each (JSON Lines), on standard output.
//!
//! `docs/json.md` describes every event. Must not know: what stages compute, how a run goes on.

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::pages::{self, Counts};
use super::progress::{left, tell};
use super::{Ending, json};
use crate::program::PROGRAM;
use studygraph::runner::events::{Event, Observer};
use studygraph::store::results::Folder;
use studygraph::study::Study;

/// The format of the lines; another one where a reader of these could not go on.
const FORMAT: u32 = 1;
/// A stage says no oftener how far it is.
const SELDOM: Duration = Duration::from_millis(200);

/// Watches one study.
pub(super) struct Lines<'a> {
    study: String,
    /// Where events go.
    say: &'a (dyn Fn(&Value) + Sync),
    running: Mutex<BTreeMap<String, Running>>,
}

struct Running {
    since: Instant,
    /// When its share was told last.
    told: Option<Instant>,
}

/// One event.
pub(super) fn line(value: &Value) {
    tell(&format!("{value}\n"));
}

/// The last line of a command.
pub(super) fn ended(result: &Result<(), Ending>) {
    let mut value = json!({ "event": "ended", "code": 0, "message": null, "mistakes": [] });
    if let Err(ending) = result {
        value["code"] = json!(ending.code());
        match ending {
            Ending::Invalid(error) => {
                value["message"] = json!(error.diagnostic.message);
                value["mistakes"] = json::mistakes(error);
            }
            other => value["message"] = json!(other.to_string()),
        }
    }
    line(&value);
}

impl Lines<'static> {
    /// Of a study that begins to run.
    pub(super) fn of(study: &Study) -> Self {
        line(&json!({
            "event": "started", "format": FORMAT, "program": PROGRAM.about.version, "study": study.name,
            "file": study.path.to_string_lossy(), "stages": study.nodes.len(),
        }));
        Self::named(&study.name)
    }

    /// Of something that is announced elsewhere.
    pub(super) fn named(study: &str) -> Self {
        Lines::telling(study, &line)
    }
}

impl<'a> Lines<'a> {
    /// For somebody who reads no lines.
    pub(super) fn telling(study: &str, say: &'a (dyn Fn(&Value) + Sync)) -> Self {
        Self { study: study.to_owned(), say, running: Mutex::default() }
    }

    /// A study has run; `said` of its results as they are now.
    pub(super) fn finished(&self, stages: usize, ran: usize, seconds: f64, folder: &Folder, said: &Counts) {
        (self.say)(&json!({
            "event": "finished", "study": self.study, "stages": stages, "ran": ran, "seconds": seconds,
            "results": folder.path().to_string_lossy(), "page": pages::path(folder).to_string_lossy(),
            "verdicts": json::verdicts(&said.verdicts), "comparisons": json::verdicts(&said.comparisons),
            "needs_attention": said.attention(),
        }));
    }

    /// Something that a reader may want to know, and that is no event of a stage.
    pub(super) fn note(&self, message: &str) {
        (self.say)(&json!({ "event": "note", "study": self.study, "message": message }));
    }

    fn running(&self) -> MutexGuard<'_, BTreeMap<String, Running>> {
        self.running.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn state(&self, stage: &str, state: &str, why: Option<&str>) {
        let seconds = self.running().remove(stage).map(|running| running.since.elapsed().as_secs_f64());
        (self.say)(&json!({
            "event": "stage", "study": self.study, "stage": stage, "state": state, "why": why, "seconds": seconds,
        }));
    }

    fn progressed(&self, stage: &str, share: f64) {
        let mut running = self.running();
        let Some(of_stage) = running.get_mut(stage) else { return };
        if of_stage.told.is_some_and(|told| told.elapsed() < SELDOM) && share < 1.0 {
            return;
        }
        of_stage.told = Some(Instant::now());
        let elapsed = of_stage.since.elapsed().as_secs_f64();
        (self.say)(&json!({
            "event": "progress", "study": self.study, "stage": stage, "share": share, "seconds": elapsed,
            "seconds_left": left(share, elapsed, elapsed),
        }));
    }

    fn warned(&self, stage: Option<&str>, message: &str) {
        (self.say)(&json!({ "event": "warning", "study": self.study, "stage": stage, "message": message }));
    }
}

impl Observer for Lines<'_> {
    fn event(&self, event: &Event<'_>) {
        match event {
            Event::Hit { stage } => self.state(stage, "hit", None),
            Event::Started { stage, why, .. } => {
                self.state(stage, "running", Some(why));
                let running = Running { since: Instant::now(), told: None };
                self.running().insert((*stage).to_owned(), running);
            }
            Event::Progressed { stage, share } => self.progressed(stage, *share),
            Event::Warned { stage, message } => self.warned(Some(stage), message),
            Event::Recalled { warnings } => {
                let each = warnings.iter().flat_map(|(stage, warnings)| warnings.iter().map(move |one| (stage, one)));
                each.for_each(|(stage, message)| self.warned(Some(stage), message));
            }
            Event::Publishing { file } => {
                (self.say)(&json!({ "event": "writing", "study": self.study, "file": file }));
            }
            Event::Finished { stage, .. } => self.state(stage, "done", None),
            Event::Failed { stage, fault } => self.state(stage, "failed", Some(&fault.to_string())),
            Event::Skipped { stage, why } => self.state(stage, "skipped", Some(why)),
            Event::Warning { message } => self.warned(None, message),
        }
    }
}
