//! What a run shows while it goes on: bars on a terminal, plain lines elsewhere.
//!
//! Must not know: what stages compute.

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
            Some(bars) => drop(bars.println(text)),
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
        Some(bars) => bars.suspend(|| eprintln!("{text}")),
        None => eprintln!("{text}"),
    }
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
    stdout.write_all(text.as_bytes())?;
    stdout.flush()
}
