//! What a run shows while it goes on: bars on a terminal, plain lines elsewhere.
//!
//! Must not know: what stages compute.

use std::collections::BTreeMap;
use std::io::{ErrorKind, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use console::Term;
use indicatif::{MultiProgress, ProgressBar, ProgressStyle};

use super::format::{duration, plain, rough, shown};
use studygraph::runner::events::{Event, Observer};
use studygraph::study::Study;

/// Watches one study.
pub struct Watcher {
    quiet: bool,
    /// Width of the longest stage name.
    width: usize,
    bars: Option<MultiProgress>,
    running: Mutex<BTreeMap<String, Running>>,
    /// The file that is being published.
    writing: Mutex<Option<String>>,
}

/// A stage that is being computed.
#[derive(Default)]
struct Running {
    bar: Option<ProgressBar>,
    why: String,
    /// Nothing of one that was never begun.
    since: Option<Instant>,
    share: f64,
    /// Seconds after which that share was done.
    done_after: f64,
    /// How often it warned.
    warned: usize,
}

impl Running {
    fn elapsed(&self, now: Instant) -> f64 {
        self.since.map_or(0.0, |since| now.saturating_duration_since(since).as_secs_f64())
    }

    fn progressed(&mut self, share: f64, now: Instant) {
        (self.share, self.done_after) = (share, self.elapsed(now));
    }

    /// How far it is, and what is still to come.
    fn standing(&self, now: Instant) -> String {
        let elapsed = rough(self.elapsed(now));
        let still = self.still(now).map_or_else(String::new, |still| format!(", {still}"));
        if self.share < 1.0 {
            format!("{:.0} % after {elapsed}{still}", 100.0 * self.share)
        } else {
            format!("computed{still}, after {elapsed}")
        }
    }

    fn draw(&self, now: Instant) {
        let Some(bar) = &self.bar else { return };
        // A share is from 0 to 1.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        bar.set_position((self.share * 1000.0) as u64);
        bar.set_message(self.still(now).map_or_else(String::new, |still| format!("  {still}")));
        bar.tick();
    }

    /// The time that is left to compute it, or that it is computed.
    fn still(&self, now: Instant) -> Option<String> {
        if self.share >= 1.0 {
            return Some("being stored".to_owned());
        }
        left(self.share, self.done_after, self.elapsed(now)).map(|left| format!("{} left", rough(left)))
    }
}

/// Seconds left where a share was done after some of those that have gone by. Nothing at the beginning, which tells
/// nothing; nothing once they are over and the share still stands where it stood.
pub(super) fn left(share: f64, done_after: f64, elapsed: f64) -> Option<f64> {
    let left = done_after / share - elapsed;
    ((0.02..1.0).contains(&share) && elapsed >= 2.0 && left > 0.0).then_some(left)
}

/// Warnings of a stage that are told one by one.
const MOST_WARNINGS: usize = 5;
/// How often those are told how it stands who have no bars to look at.
const EVERY: Duration = Duration::from_secs(10);
/// How often bars are drawn where nothing happens.
const REDRAWN: Duration = Duration::from_millis(200);
/// Columns of a terminal from which a bar has its full length.
const WIDE: u16 = 100;

impl Watcher {
    /// How many of so many warnings were not told one by one.
    fn more_warnings(&self, stage: &str, count: usize) {
        self.of_more_warnings(stage, count).iter().for_each(|line| self.line(line));
    }

    fn of_more_warnings(&self, stage: &str, count: usize) -> Option<String> {
        let more = count.checked_sub(MOST_WARNINGS).filter(|more| *more > 0)?;
        Some(self.of_stage(stage, "warning", &format!("and {more} more; the report and `manifest.json` have all")))
    }

    #[must_use]
    pub fn new(quiet: bool, width: usize, bars: Option<MultiProgress>) -> Self {
        Self { quiet, width, bars, running: Mutex::default(), writing: Mutex::default() }
    }

    /// Does the work; while it goes on bars are kept true, and where there are none a line every ten seconds says what is
    /// running.
    pub fn telling<T>(&self, work: impl FnOnce() -> T) -> T {
        if self.quiet {
            return work();
        }
        let Some(bars) = &self.bars else { return Self::every(EVERY, || self.line(&self.stand(Instant::now())), work) };
        let files = bars.add(ProgressBar::new_spinner().with_style(style("  {msg}")));
        let result = Self::every(REDRAWN, || self.redraw(&files, Instant::now()), work);
        files.finish_and_clear();
        result
    }

    fn every<T>(pause: Duration, tell: impl Fn() + Send, work: impl FnOnce() -> T) -> T {
        thread::scope(|scope| {
            let (ended, wait) = mpsc::channel::<()>();
            // Where the system starts no thread, the work goes on without these lines.
            let _ = thread::Builder::new().spawn_scoped(scope, move || {
                // The other end is dropped when the work has ended, also by a panic.
                while wait.recv_timeout(pause) == Err(RecvTimeoutError::Timeout) {
                    tell();
                }
            });
            let result = work();
            drop(ended);
            result
        })
    }

    /// What is running, how far it is, and how long still.
    fn stand(&self, now: Instant) -> String {
        let running = self.running();
        let stages: Vec<String> =
            running.iter().map(|(stage, running)| format!("{stage} {}", running.standing(now))).collect();
        match self.written() {
            _ if !stages.is_empty() => format!("  running: {}", stages.join("; ")),
            None => "  running: no stage; results are read".to_owned(),
            Some(file) => format!("  running: no stage; `{file}` is made and written"),
        }
    }

    /// Bars between two events.
    fn redraw(&self, files: &ProgressBar, now: Instant) {
        for running in self.running().values() {
            running.draw(now);
        }
        if let Some(file) = self.written() {
            files.set_message(format!("{file} is made and written"));
        }
    }

    fn running(&self) -> MutexGuard<'_, BTreeMap<String, Running>> {
        self.running.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn written(&self) -> Option<String> {
        self.writing.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn line(&self, text: &str) {
        if self.quiet {
            return;
        }
        match &self.bars {
            // Above the bars; when the terminal is gone there is nobody to tell.
            Some(bars) => drop(bars.println(between_words(&shown(text), Term::stderr().size().1.into()))),
            None => tell(&format!("{}\n", shown(text))),
        }
    }

    fn stage(&self, stage: &str, word: &str, rest: &str) {
        self.line(&self.of_stage(stage, word, rest));
    }

    fn of_stage(&self, stage: &str, word: &str, rest: &str) -> String {
        let width = self.width;
        format!("  {stage:width$}  {word:7}  {rest}").trim_end().to_owned()
    }

    fn bar(&self, stage: &str) -> Option<ProgressBar> {
        let bars = self.bars.as_ref()?;
        let width = self.width;
        // Elsewhere it takes what the rest of the line leaves.
        let bar = if Term::stderr().size().1 >= WIDE { "{bar:30.cyan/blue}" } else { "{wide_bar:.cyan/blue}" };
        let style = style(&format!("  {{prefix}}  {bar}  {{percent:>3}} %  {{elapsed}}{{msg}}"));
        let bar = bars.add(ProgressBar::new(1000).with_style(style));
        bar.set_prefix(format!("{stage:width$}"));
        Some(bar)
    }

    /// What was known of it while it ran; its bar is gone.
    fn end(&self, stage: &str) -> Running {
        let mut running = self.running().remove(stage).unwrap_or_default();
        if let Some(bar) = running.bar.take() {
            bar.finish_and_clear();
        }
        running
    }
}

impl Observer for Watcher {
    fn event(&self, event: &Event<'_>) {
        match event {
            Event::Hit { .. } => {}
            Event::Started { stage, why, .. } => {
                let bar = self.bar(stage);
                let (why, since) = ((*why).to_owned(), Some(Instant::now()));
                self.running()
                    .insert((*stage).to_owned(), Running { bar, why, since, share: 0.0, done_after: 0.0, warned: 0 });
            }
            Event::Progressed { stage, share } => {
                let now = Instant::now();
                if let Some(running) = self.running().get_mut(*stage) {
                    running.progressed(*share, now);
                    running.draw(now);
                }
            }
            Event::Publishing { file } => {
                let mut writing = self.writing.lock().unwrap_or_else(PoisonError::into_inner);
                *writing = Some((*file).to_owned());
            }
            Event::Warned { stage, message } => {
                let count = self.running().get_mut(*stage).map_or(0, |running| {
                    running.warned += 1;
                    running.warned
                });
                if count <= MOST_WARNINGS {
                    self.stage(stage, "warning", message);
                }
            }
            Event::Recalled { warnings } => {
                let mut lines = Vec::new();
                for (stage, warnings) in *warnings {
                    let some = warnings.iter().take(MOST_WARNINGS);
                    lines.extend(some.map(|message| self.of_stage(stage, "warning", message)));
                    lines.extend(self.of_more_warnings(stage, warnings.len()));
                }
                // A run with nothing to do takes as long as its writes.
                if self.bars.is_none() && !lines.is_empty() {
                    lines = vec![lines.join("\n")];
                }
                for line in lines {
                    self.line(&line);
                }
            }
            Event::Finished { stage, seconds } => {
                let running = self.end(stage);
                self.more_warnings(stage, running.warned);
                // As long as somebody waited, which parts side by side shorten.
                let wall = running.since.map_or(*seconds, |_| running.elapsed(Instant::now()));
                self.stage(stage, "ran", &format!("{:>9}  {}", duration(wall), running.why));
            }
            Event::Failed { stage, fault } => {
                self.end(stage);
                // A failure is told even to those who want to hear nothing else.
                aside(self.bars.as_ref(), &format!("  {stage}: failed: {fault}"));
            }
            Event::Warning { message } => aside(self.bars.as_ref(), &format!("gearstudy: warning: {message}")),
            Event::Skipped { stage, why } => {
                self.end(stage);
                self.stage(stage, "skipped", why);
            }
        }
    }
}

/// What is told of a stage on a terminal of so many columns: lines end between words, and what goes on stands further in.
fn between_words(text: &str, columns: usize) -> String {
    textwrap::fill(text, textwrap::Options::new(columns).subsequent_indent("      ").break_words(false))
}

fn style(template: &str) -> ProgressStyle {
    // A template that cannot be read is no reason to stop a run.
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}

/// Bars, where there is somebody to look at them.
#[must_use]
pub fn bars(quiet: bool) -> Option<MultiProgress> {
    (!quiet && std::io::stdout().is_terminal() && std::io::stderr().is_terminal()).then(MultiProgress::new)
}

/// Says something on standard error while bars may be drawn there.
pub fn aside(bars: Option<&MultiProgress>, text: &str) {
    match bars {
        Some(bars) => bars.suspend(|| complain(text)),
        None => complain(text),
    }
}

/// A line on standard error; when it cannot be written (a full disk, a reader that is gone) there is nobody left to tell.
pub fn complain(text: &str) {
    let _ = writeln!(std::io::stderr(), "{}", shown(text));
}

/// What a lock says, which may be waited for.
pub fn told(message: &str) {
    aside(None, &format!("gearstudy: {message}"));
}

/// What is valid in a study and hardly meant.
pub fn warned(study: &Study) {
    for warning in study.warnings() {
        told(&format!("warning: {warning}"));
    }
}

/// Set once an answer could not be written.
static UNWRITTEN: AtomicBool = AtomicBool::new(false);

/// Writes to standard output what was asked for. A command whose answer is not taken comes to its own end all the same, which
/// removes its temporary files: quietly where the reader has closed the pipe (`| head`).
pub fn out(text: &str) {
    if let Err(error) = write(text)
        && error.kind() != ErrorKind::BrokenPipe
        && !UNWRITTEN.swap(true, Ordering::Relaxed)
    {
        complain(&format!("gearstudy: cannot write to standard output: {error}"));
    }
}

/// Whether an answer could not be written, though somebody waits for it.
pub(super) fn is_unwritten() -> bool {
    UNWRITTEN.load(Ordering::Relaxed)
}

/// Writes to standard output how the work goes; the work goes on when nobody reads it.
pub fn tell(text: &str) {
    let _ = write(text);
}

fn write(text: &str) -> std::io::Result<()> {
    let mut stdout = std::io::stdout().lock();
    stdout.write_all(plain(text).as_bytes())?;
    stdout.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A clock that stands where the test puts it.
    #[test]
    fn the_time_left_follows_the_share_that_is_done() {
        let watcher = Watcher::new(false, 4, None);
        let began = Instant::now();
        let after = |seconds| began + Duration::from_secs(seconds);
        let progressed = |share, seconds| watcher.running().get_mut("ste").unwrap().progressed(share, after(seconds));
        assert_eq!(watcher.stand(after(10)), "  running: no stage; results are read");
        let running = Running { since: Some(began), ..Running::default() };
        watcher.running().insert("ste".to_owned(), running);
        assert_eq!(watcher.stand(after(10)), "  running: ste 0 % after 10 s");
        progressed(0.25, 20);
        assert_eq!(watcher.stand(after(20)), "  running: ste 25 % after 20 s, 60 s left");
        // Nobody has said anything since.
        assert_eq!(watcher.stand(after(70)), "  running: ste 25 % after 70 s, 10 s left");
        assert_eq!(watcher.stand(after(90)), "  running: ste 25 % after 90 s");
        progressed(1.0, 91);
        assert_eq!(watcher.stand(after(95)), "  running: ste computed, being stored, after 95 s");
        watcher.event(&Event::Started { stage: "pair", why: "never ran", chunks: 1 });
        let both = watcher.stand(after(1000));
        assert!(both.contains("pair 0 % after ") && both.contains("; ste computed, being stored, "), "{both}");
        for stage in ["ste", "pair"] {
            watcher.event(&Event::Finished { stage, seconds: 1.0 });
        }
        watcher.event(&Event::Publishing { file: "s.h5" });
        assert_eq!(watcher.stand(after(2000)), "  running: no stage; `s.h5` is made and written");
        let lefts = [left(0.01, 100.0, 100.0), left(0.5, 1.0, 1.0), left(1.0, 9.0, 9.0), left(0.2, 8.0, 8.0)];
        assert_eq!(lefts, [None, None, None, Some(32.0)]);
    }

    #[test]
    fn whoever_has_no_bars_is_told_until_the_work_has_ended() {
        let watcher = Watcher::new(false, 4, None);
        watcher.event(&Event::Started { stage: "ste", why: "", chunks: 1 });
        let said = Mutex::new(Vec::new());
        let say = || said.lock().unwrap().push(watcher.stand(Instant::now()));
        let waited = Watcher::every(Duration::from_millis(1), say, || {
            let began = Instant::now();
            while said.lock().unwrap().len() < 3 && began.elapsed() < Duration::from_mins(1) {
                std::thread::yield_now();
            }
            7
        });
        assert_eq!((waited, said.lock().unwrap().len() >= 3), (7, true));
        assert!(said.lock().unwrap().iter().all(|line| line.starts_with("  running: ste 0 % after")), "{said:?}");
    }
}
