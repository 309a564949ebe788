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

fn spawned(failed: &std::io::Error, py: Python<'_>) -> PyErr {
    errors::run_failed(py, &format!("cannot start a thread: {failed}"))
}

/// Does something that takes long; a signal of Python tells it to stop, and is raised when it has.
///
/// # Errors
/// What the signal raises.
pub fn stopping<T: Send>(py: Python<'_>, work: impl FnOnce(&AtomicBool) -> T + Send) -> PyResult<T> {
    let listed = Listed::new();
    let stop = &*listed.0;
    thread::scope(|scope| {
        let (tell, told) = mpsc::channel();
        let spawning = thread::Builder::new().name("gearstudy".to_owned()).spawn_scoped(scope, move || {
            caught(&tell, || work(stop));
        });
        spawning.map_err(|failed| spawned(&failed, py))?;
        let mut raised = None;
        let done = waited(py, told, |signal| {
            stop.store(true, Ordering::Relaxed);
            raised.get_or_insert(signal);
            None
        })?;
        raised.map_or_else(|| outcome(done), Err)
    })
}

/// The same of something that has no ear for signals and touches nothing of Python: it is left behind, and what it comes to
/// is of no use to anybody. It may look whether that has happened.
///
/// # Errors
/// What the signal raises.
pub fn abandoning<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&AtomicBool) -> T + Send + 'static,
) -> PyResult<T> {
    let left = Arc::new(AtomicBool::new(false));
    let (tell, told) = mpsc::channel();
    let own = Arc::clone(&left);
    let spawning = thread::Builder::new().name("gearstudy".to_owned()).spawn(move || caught(&tell, || work(&own)));
    spawning.map_err(|failed| spawned(&failed, py))?;
    outcome(waited(py, told, |signal| {
        left.store(true, Ordering::Relaxed);
        Some(signal)
    })?)
}

fn caught<T>(tell: &Sender<Outcome<T>>, work: impl FnOnce() -> T) {
    // Nobody listens to what was left behind.
    let _ = tell.send(catch_unwind(AssertUnwindSafe(work)));
}

/// Waits with the interpreter's lock given back; `signal` hears what signals raise, and what it gives ends the wait.
fn waited<T: Send>(
    py: Python<'_>,
    told: Receiver<Outcome<T>>,
    mut signal: impl FnMut(PyErr) -> Option<PyErr>,
) -> PyResult<Outcome<T>> {
    // What waits without the interpreter's lock has it to itself.
    let told = Mutex::new(told);
    loop {
        let waited = || told.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(SIGNALS);
        match py.detach(waited) {
            Ok(done) => return Ok(done),
            Err(RecvTimeoutError::Timeout) => {
                if let Some(ended) = py.check_signals().err().and_then(&mut signal) {
                    return Err(ended);
                }
            }
            Err(RecvTimeoutError::Disconnected) => return Err(errors::bug("a thread ended without a word")),
        }
    }
}

/// What it came to; a panic is a mistake of ours.
pub fn outcome<T>(done: Outcome<T>) -> PyResult<T> {
    done.map_err(|panic| {
        let words = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
        errors::bug(words.unwrap_or("a panic"))
    })
}
