//! Wild inputs, in process: no panic and no hang, in the reader of studies and in the chain from geometry to transmission
//! error.
//!
//! A case is a function of its number alone. By default a fixed number of them is run; `GEARSTUDY_FUZZ_SECONDS=600`
//! runs for ten minutes, and `GEARSTUDY_FUZZ_FROM=12345` starts at a number, to see a case again.

mod chain;
mod loader;

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, mpsc};
use std::thread;
use std::time::{Duration, Instant};

/// Far above what any case takes.
const LIMIT: Duration = Duration::from_mins(1);

/// Runs cases until there are enough, each within the time limit.
fn drive(what: &str, count: u64, run: impl Fn(u64) + Send + 'static) {
    let setting = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let seconds = setting("GEARSTUDY_FUZZ_SECONDS");
    let from = setting("GEARSTUDY_FUZZ_FROM").unwrap_or(0);
    let began = Instant::now();
    let enough = move |done: u64| match seconds {
        Some(seconds) => began.elapsed() >= Duration::from_secs(seconds),
        None => done >= count,
    };
    let current = Arc::new(AtomicU64::new(from));
    let shown = Arc::clone(&current);
    let (sender, receiver) = mpsc::channel();
    let worker = thread::spawn(move || {
        for number in from.. {
            if enough(number - from) {
                break;
            }
            current.store(number, Ordering::SeqCst);
            run(number);
            if sender.send(number).is_err() {
                break;
            }
        }
    });
    let mut done = 0;
    loop {
        match receiver.recv_timeout(LIMIT) {
            Ok(_) => done += 1,
            Err(mpsc::RecvTimeoutError::Timeout) => panic!("{what}: case {} hangs", shown.load(Ordering::SeqCst)),
            Err(mpsc::RecvTimeoutError::Disconnected) => break,
        }
    }
    assert!(worker.join().is_ok(), "{what}: case {} panicked", shown.load(Ordering::SeqCst));
    println!("{what}: {done} cases in {:?}", began.elapsed());
    assert!(done > 0);
}
