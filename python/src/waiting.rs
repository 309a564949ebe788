//! What takes long: on a thread of its own, while Python goes on and hears signals.
//!
//! Must not know: what takes long.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread;
use std::time::{Duration, Instant};

use pyo3::prelude::*;

use crate::errors;

/// How long a signal waits, at most, until what runs is told of it.
const SIGNALS: Duration = Duration::from_millis(20);
/// How long the end of the interpreter waits, at most, for what is running to stop.
const AT_END: Duration = Duration::from_secs(10);

/// What is to stop at the end of the interpreter, and the process that runs it: a fork has the list without the threads.
static RUNNING: Mutex<Runs> = Mutex::new(Vec::new());
type Runs = Vec<(u32, Arc<AtomicBool>)>;

/// The list, unless a fork took the lock along with nobody to give it back.
fn running() -> Option<MutexGuard<'static, Runs>> {
    let patience = Instant::now();
    loop {
        match RUNNING.try_lock() {
            Ok(list) => return Some(list),
            Err(TryLockError::Poisoned(poisoned)) => return Some(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) if patience.elapsed() > SIGNALS => return None,
            Err(TryLockError::WouldBlock) => thread::yield_now(),
        }
    }
}

/// Among what runs, for as long as it lives.
struct Listed(Arc<AtomicBool>);

impl Listed {
    fn new() -> Self {
        let stop = Arc::new(AtomicBool::new(false));
        if let Some(mut list) = running() {
            list.push((process::id(), Arc::clone(&stop)));
        }
        Self(stop)
    }
}

impl Drop for Listed {
    fn drop(&mut self) {
        if let Some(mut list) = running() {
            list.retain(|(_, stop)| !Arc::ptr_eq(stop, &self.0));
        }
    }
}

/// Stops what is running and waits for it: a thread that calls Python while the interpreter ends would take the process along.
#[pyfunction]
pub fn _end(py: Python<'_>) {
    let runs = || {
        let Some(list) = running() else { return false };
        let own = list.iter().filter(|(of, _)| *of == process::id());
        own.inspect(|(_, stop)| stop.store(true, Ordering::Relaxed)).count() > 0
    };
    py.detach(|| {
        let began = Instant::now();
        while runs() && began.elapsed() < AT_END {
            thread::sleep(Duration::from_millis(1));
        }
    });
}

type Outcome<T> = thread::Result<T>;

/// Does something that takes long and hears when it is to stop; a signal of Python tells it so, and is raised at once. What is
/// left then comes to its end by itself, and the interpreter's end waits for it.
///
/// # Errors
/// What the signal raises.
pub fn stopping<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&AtomicBool) -> T + Send + 'static,
) -> PyResult<T> {
    let listed = Listed::new();
    let stop = Arc::clone(&listed.0);
    left_behind(py, stop, move |stop| {
        let _listed = listed;
        work(stop)
    })
}

/// The same of something that touches nothing of Python: nobody waits for it, and what it comes to is of no use to anybody.
///
/// # Errors
/// What the signal raises.
pub fn abandoning<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&AtomicBool) -> T + Send + 'static,
) -> PyResult<T> {
    left_behind(py, Arc::default(), work)
}

fn left_behind<T: Send + 'static>(
    py: Python<'_>,
    left: Arc<AtomicBool>,
    work: impl FnOnce(&AtomicBool) -> T + Send + 'static,
) -> PyResult<T> {
    let (tell, told) = mpsc::channel();
    let own = Arc::clone(&left);
    let spawning = thread::Builder::new().name("gearstudy".to_owned()).spawn(move || caught(&tell, || work(&own)));
    spawning.map_err(|failed| errors::run_failed(py, &format!("cannot start a thread: {failed}")))?;
    // What waits without the interpreter's lock has it to itself.
    let told: Mutex<Receiver<Outcome<T>>> = Mutex::new(told);
    loop {
        let waited = || told.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(SIGNALS);
        match py.detach(waited) {
            Ok(done) => return outcome(done),
            Err(RecvTimeoutError::Timeout) => {
                py.check_signals().inspect_err(|_| left.store(true, Ordering::Relaxed))?;
            }
            Err(RecvTimeoutError::Disconnected) => return Err(errors::bug("a thread ended without a word")),
        }
    }
}

fn caught<T>(tell: &Sender<Outcome<T>>, work: impl FnOnce() -> T) {
    // Nobody listens to what was left behind.
    let _ = tell.send(catch_unwind(AssertUnwindSafe(work)));
}

/// What it came to; a panic is a mistake of ours.
pub fn outcome<T>(done: Outcome<T>) -> PyResult<T> {
    done.map_err(|panic| {
        let words = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
        errors::bug(words.unwrap_or("a panic"))
    })
}
