//! What a run shows while it goes on: bars on a terminal, plain lines elsewhere.
//!
//! Must not know: what stages compute.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{ErrorKind, IsTerminal, Write};
use std::sync::Mutex;

use indicatif::{MultiProgress, ProgressBar, ProgressStyle};

use crate::runner::events::{Event, Observer};

/// Watches one study.
pub struct Watcher {
    quiet: bool,
    /// Width of the longest stage name.
    width: usize,
    bars: Option<MultiProgress>,
    running: Mutex<BTreeMap<String, (Option<ProgressBar>, String)>>,
}

impl Watcher {
    #[must_use]
    pub fn new(quiet: bool, width: usize, bars: Option<MultiProgress>) -> Self {
        Self { quiet, width, bars, running: Mutex::default() }
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
        let style = ProgressStyle::with_template("  {prefix}  {bar:30.cyan/blue}  {percent:>3} %  {elapsed}").ok()?;
        let bar = bars.add(ProgressBar::new(1000).with_style(style));
        bar.set_prefix(format!("{stage:width$}"));
        Some(bar)
    }

    fn end(&self, stage: &str) -> String {
        let mut running = self.running.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let (bar, why) = running.remove(stage).unwrap_or_default();
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
                running.insert((*stage).to_owned(), (bar, (*why).to_owned()));
            }
            Event::Progressed { stage, share } => {
                let running = self.running.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                if let Some((Some(bar), _)) = running.get(*stage) {
                    // A share is from 0 to 1.
                    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
                    bar.set_position((share * 1000.0) as u64);
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
        Some(bars) => bars.suspend(|| eprintln!("{}", plain(text))),
        None => eprintln!("{}", plain(text)),
    }
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

/// Writes to standard output what was asked for; a reader that has closed it (`| head`) ends the program quietly.
pub fn out(text: &str) {
    match write(text) {
        Ok(()) => {}
        Err(error) if error.kind() == ErrorKind::BrokenPipe => std::process::exit(0),
        Err(error) => {
            eprintln!("gearstudy: cannot write to standard output: {error}");
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
    use super::plain;

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
