//! Signals that ask a run to stop: Ctrl-C, what `kill` sends, and a terminal that is closed.
//!
//! The first one sets a flag, which stages look at; the second one ends the program at once. A signal that was ignored
//! when the program was started stays ignored: so `nohup` and the background of a script do it. Must not know: what is
//! stopped.

use std::sync::atomic::{AtomicBool, AtomicI32, Ordering};
#[cfg(unix)]
use std::sync::mpsc;
use std::sync::{Arc, OnceLock};
#[cfg(unix)]
use std::thread;

use indicatif::MultiProgress;

/// The number of the first signal, 0 before.
static RECEIVED: AtomicI32 = AtomicI32::new(0);

/// What a shell adds to the number of the signal that ended a program.
const ENDED_BY_SIGNAL: i32 = 128;
/// Ctrl-C.
const INTERRUPT: i32 = 2;

/// The exit code of a program that was asked to stop: 130 for Ctrl-C, 143 for `kill`, 129 for a closed terminal.
#[must_use]
pub fn code() -> i32 {
    match RECEIVED.load(Ordering::Relaxed) {
        0 => ENDED_BY_SIGNAL + INTERRUPT,
        signal => ENDED_BY_SIGNAL + signal,
    }
}

/// Set by the first signal, and the same for all who ask: two that heard one signal would take it for two. Without a
/// handler any signal ends the program at once; what is finished is kept in that case too.
pub(super) fn stop_flag(bars: Option<MultiProgress>) -> Arc<AtomicBool> {
    static STOP: OnceLock<Arc<AtomicBool>> = OnceLock::new();
    let made = || {
        let stop = Arc::new(AtomicBool::new(false));
        watch(&stop, bars);
        stop
    };
    Arc::clone(STOP.get_or_init(made))
}

/// Makes a write beyond the limit on the size of files (`ulimit -f`) an error that is reported, and not the end of the
/// program. A handler and not `SIG_IGN`: programs that are started from here have the signal as it was.
#[cfg(unix)]
pub(super) fn report_large_files() {
    // Without it the signal ends the program, as it did before.
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default());
}

/// No such signal is known.
#[cfg(not(unix))]
pub(super) fn report_large_files() {}

#[cfg(unix)]
fn watch(stop: &Arc<AtomicBool>, bars: Option<MultiProgress>) {
    use super::progress::aside;
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};

    let ignored = ignored();
    let heard = [SIGHUP, SIGINT, SIGTERM].into_iter().filter(|signal| ignored >> (signal - 1) & 1 == 0);
    let flag = Arc::clone(stop);
    let (hand, handed) = mpsc::channel::<signal_hook::iterator::Signals>();
    // First the thread: without one, signals that nobody reads would be lost.
    let started = thread::Builder::new().name("signals".to_owned()).spawn(move || {
        let Ok(mut signals) = handed.recv() else { return };
        for signal in signals.forever() {
            if RECEIVED.compare_exchange(0, signal, Ordering::Relaxed, Ordering::Relaxed).is_err() {
                std::process::exit(code());
            }
            flag.store(true, Ordering::Release);
            aside(bars.as_ref(), "gearstudy: stopping; once more to stop at once");
        }
    });
    if started.is_ok()
        && let Ok(signals) = signal_hook::iterator::Signals::new(heard)
    {
        // The thread waits for nothing else.
        let _ = hand.send(signals);
    }
}

/// Elsewhere nobody says what is to be done before the end.
#[cfg(not(unix))]
fn watch(stop: &Arc<AtomicBool>, _bars: Option<MultiProgress>) {
    use signal_hook::consts::{SIGINT, SIGTERM};

    for signal in [SIGINT, SIGTERM] {
        // In this order: the second signal finds the flag set.
        let _ = signal_hook::flag::register_conditional_shutdown(signal, ENDED_BY_SIGNAL + signal, Arc::clone(stop));
        let _ = signal_hook::flag::register(signal, Arc::clone(stop));
    }
}

/// The signals that are ignored, a bit each, the first for signal 1. Linux says it; elsewhere none is known.
#[cfg(unix)]
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}
