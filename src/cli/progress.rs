//! What a run shows while it goes on: bars on a terminal, plain lines elsewhere.
//!
//! Must not know: what stages compute.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{ErrorKind, IsTerminal, Write};
use std::sync::Mutex;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::{Duration, Instant};

use indicatif::{MultiProgress, ProgressBar, ProgressStyle};

use crate::runner::events::{Event, Observer};

/// Watches one study.
pub struct Watcher {
    quiet: bool,
    /// Width of the longest stage name.
    width: usize,
    bars: Option<MultiProgress>,
    running: Mutex<BTreeMap<String, Running>>,
}

/// A stage that is being computed.
#[derive(Default)]
struct Running {
    bar: Option<ProgressBar>,
    why: String,
    /// Nothing of one that was never begun.
    since: Option<Instant>,
    share: f64,
}

impl Running {
    /// How far it is, and how long still.
    fn standing(&self, now: Instant) -> String {
        let elapsed = self.since.map_or(0.0, |since| now.saturating_duration_since(since).as_secs_f64());
        let left = left(self.share, elapsed).map_or_else(String::new, |left| format!(", about {} left", rough(left)));
        format!("{:.0} % after {}{left}", 100.0 * self.share, rough(elapsed))
    }
}

/// Seconds left where a share was done in some; nothing before that tells anything.
fn left(share: f64, elapsed: f64) -> Option<f64> {
    ((0.02..1.0).contains(&share) && elapsed >= 2.0).then(|| elapsed * (1.0 - share) / share)
}

/// How often those are told how it stands who have no bars to look at.
const EVERY: Duration = Duration::from_secs(10);

impl Watcher {
    #[must_use]
    pub fn new(quiet: bool, width: usize, bars: Option<MultiProgress>) -> Self {
        Self { quiet, width, bars, running: Mutex::default() }
    }

    /// Does the work; while it goes on, and there are no bars, a line every ten seconds says what is running.
    pub fn telling<T>(&self, work: impl FnOnce() -> T) -> T {
        if self.quiet || self.bars.is_some() {
            return work();
        }
        self.telling_every(EVERY, |line| self.line(line), work)
    }

    fn telling_every<T>(&self, every: Duration, say: impl Fn(&str) + Send, work: impl FnOnce() -> T) -> T {
        std::thread::scope(|scope| {
            let (ended, wait) = mpsc::channel::<()>();
            scope.spawn(move || {
                // The other end is dropped when the work has ended, also by a panic.
                while wait.recv_timeout(every) == Err(RecvTimeoutError::Timeout) {
                    say(&self.stand(Instant::now()));
                }
            });
            let result = work();
            drop(ended);
            result
        })
    }

    /// What is running, how far it is, and how long still.
    fn stand(&self, now: Instant) -> String {
        let running = self.running.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let stages: Vec<String> =
            running.iter().map(|(stage, running)| format!("{stage} {}", running.standing(now))).collect();
        let stages =
            if stages.is_empty() { "no stage; results are read or written".to_owned() } else { stages.join("; ") };
        format!("  running: {stages}")
    }

    fn line(&self, text: &str) {
        if self.quiet {
            return;
        }
        match &self.bars {
            // Above the bars; when the terminal is gone there is nobody to tell.
            Some(bars) => drop(bars.println(plain(text))),
            None => tell(&format!("{text}\n")),
        }
    }

    fn stage(&self, stage: &str, word: &str, rest: &str) {
        let width = self.width;
        self.line(format!("  {stage:width$}  {word:7}  {rest}").trim_end());
    }

    fn bar(&self, stage: &str) -> Option<ProgressBar> {
        let bars = self.bars.as_ref()?;
        let width = self.width;
        let style =
            ProgressStyle::with_template("  {prefix}  {bar:30.cyan/blue}  {percent:>3} %  {elapsed}{msg}").ok()?;
        let bar = bars.add(ProgressBar::new(1000).with_style(style));
        bar.set_prefix(format!("{stage:width$}"));
        Some(bar)
    }

    fn end(&self, stage: &str) -> String {
        let mut running = self.running.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let Running { bar, why, .. } = running.remove(stage).unwrap_or_default();
        if let Some(bar) = bar {
            bar.finish_and_clear();
        }
        why
    }
}

impl Observer for Watcher {
    fn event(&self, event: &Event<'_>) {
        match event {
            Event::Planned { .. } | Event::Hit { .. } => {}
            Event::Started { stage, why, .. } => {
                let bar = self.bar(stage);
                let mut running = self.running.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                let since = Some(Instant::now());
                running.insert((*stage).to_owned(), Running { bar, why: (*why).to_owned(), since, share: 0.0 });
            }
            Event::Progressed { stage, share } => {
                let mut running = self.running.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                let Some(running) = running.get_mut(*stage) else { return };
                running.share = *share;
                if let Some(bar) = &running.bar {
                    // A share is from 0 to 1.
                    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
                    bar.set_position((share * 1000.0) as u64);
                    let left = left(*share, bar.elapsed().as_secs_f64());
                    bar.set_message(left.map_or_else(String::new, |left| format!("  about {} left", rough(left))));
                }
            }
            Event::Warned { stage, message } => self.stage(stage, "warning", message),
            Event::Finished { stage, seconds } => {
                let why = self.end(stage);
                self.stage(stage, "ran", &format!("{:>9}  {why}", duration(*seconds)));
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
    let _ = writeln!(std::io::stderr(), "{}", plain(text));
}

/// What a lock says, which may be waited for.
pub fn told(message: &str) {
    aside(None, &format!("gearstudy: {message}"));
}

/// A text that no terminal takes for more than text: what would move the cursor, colour, hide or turn round is written as
/// JSON writes it. Titles, labels and cells come from files that anybody may have made.
#[must_use]
pub fn plain(text: &str) -> Cow<'_, str> {
    if !text.contains(is_hidden) {
        return Cow::Borrowed(text);
    }
    let shown = |mut all: String, c: char| {
        if is_hidden(c) {
            all += &format!("\\u{:04x}", u32::from(c));
        } else {
            all.push(c);
        }
        all
    };
    Cow::Owned(text.chars().fold(String::with_capacity(text.len()), shown))
}

/// Control characters but line ends and tabs, and those that turn the direction of writing round.
pub fn is_hidden(c: char) -> bool {
    let turns = matches!(c, '\u{061c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    turns || (c.is_control() && c != '\n' && c != '\t')
}

/// Seconds in the unit that suits them.
#[must_use]
pub fn duration(seconds: f64) -> String {
    if seconds < 0.9995e-3 {
        format!("{:.0} µs", seconds * 1e6)
    } else if seconds < 0.9995 {
        format!("{:.1} ms", seconds * 1e3)
    } else {
        format!("{seconds:.2} s")
    }
}

/// A time that is estimated, or of which nobody wants to know more: one or two digits, minutes and hours.
#[must_use]
pub fn rough(seconds: f64) -> String {
    match seconds {
        ..0.0095 => "10 ms".to_owned(),
        ..0.0995 => format!("{:.0} ms", (seconds * 100.0).round() * 10.0),
        ..0.95 => format!("{:.0} ms", (seconds * 10.0).round() * 100.0),
        ..99.5 => format!("{seconds:.0} s"),
        ..5970.0 => format!("{:.0} min", seconds / 60.0),
        ..172_800.0 => format!("{:.0} h", seconds / 3600.0),
        _ => format!("{:.0} days", seconds / 86_400.0),
    }
}

/// Writes to standard output what was asked for; a reader that has closed it (`| head`) ends the program quietly.
pub fn out(text: &str) {
    match write(text) {
        Ok(()) => {}
        Err(error) if error.kind() == ErrorKind::BrokenPipe => std::process::exit(0),
        Err(error) => {
            complain(&format!("gearstudy: cannot write to standard output: {error}"));
            std::process::exit(1);
        }
    }
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
        assert_eq!(watcher.stand(after(10)), "  running: no stage; results are read or written");
        let running = Running { since: Some(began), ..Running::default() };
        watcher.running.lock().unwrap().insert("ste".to_owned(), running);
        assert_eq!(watcher.stand(after(10)), "  running: ste 0 % after 10 s");
        watcher.event(&Event::Progressed { stage: "ste", share: 0.25 });
        assert_eq!(watcher.stand(after(20)), "  running: ste 25 % after 20 s, about 60 s left");
        watcher.event(&Event::Started { stage: "pair", why: "never ran", chunks: 1 });
        let both = watcher.stand(after(1000));
        assert!(
            both.contains("pair 0 % after ") && both.contains("; ste 25 % after 17 min, about 50 min left"),
            "{both}"
        );
        for stage in ["ste", "pair"] {
            watcher.event(&Event::Finished { stage, seconds: 1.0 });
        }
        assert_eq!(watcher.stand(after(2000)), "  running: no stage; results are read or written");
        assert_eq!([left(0.01, 100.0), left(0.5, 1.0), left(1.0, 9.0), left(0.2, 8.0)], [None, None, None, Some(32.0)]);
    }

    #[test]
    fn whoever_has_no_bars_is_told_until_the_work_has_ended() {
        let watcher = Watcher::new(false, 4, None);
        watcher.event(&Event::Started { stage: "ste", why: "", chunks: 1 });
        let said = Mutex::new(Vec::new());
        let say = |line: &str| said.lock().unwrap().push(line.to_owned());
        let waited = watcher.telling_every(Duration::from_millis(1), say, || {
            while said.lock().unwrap().len() < 3 {
                std::thread::yield_now();
            }
            7
        });
        assert_eq!(waited, 7);
        assert!(said.lock().unwrap().iter().all(|line| line.starts_with("  running: ste 0 % after")), "{said:?}");
    }

    #[test]
    fn estimates_have_few_digits() {
        let shown = [0.0, 0.034, 0.26, 4.4, 61.0, 600.0, 9000.0, 400_000.0].map(rough);
        assert_eq!(shown, ["10 ms", "30 ms", "300 ms", "4 s", "61 s", "10 min", "2 h", "5 days"]);
    }

    #[test]
    fn no_text_steers_a_terminal() {
        assert_eq!(plain("µm\t→ 1\n"), "µm\t→ 1\n");
        assert_eq!(plain("\u{1b}[2J\r\u{7}\u{9b}\u{7f}a\u{202e}"), "\\u001b[2J\\u000d\\u0007\\u009b\\u007fa\\u202e");
        // In JSON it stays the same text.
        let text = "a\u{1b}\u{9b}\u{202e}\u{7f}";
        let json = serde_json::to_string(text).unwrap();
        assert_eq!(serde_json::from_str::<String>(&plain(&json)).unwrap(), text);
    }
}
