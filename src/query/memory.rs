//! A limit on the memory that a query takes: joins of large tables have more rows than any machine can hold.
//!
//! Nothing stops polars once it works, so it works in a thread of its own and is left behind. What the system says of
//! this process is looked at every few milliseconds; where it says nothing (not on Linux), there is no limit. Must not
//! know: what is asked.

use std::fs;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

/// Bytes over those held before.
pub(super) const MOST: u64 = 2 << 30;

/// Memory for a plan of terms within terms; only what is used of it is taken.
const STACK: usize = 512 << 20;
const PAUSE: Duration = Duration::from_millis(5);

/// What `work` gives; nothing, when it panics.
///
/// # Errors
/// One sentence, when it takes more memory than `maximum` or no thread can be started. The thread goes on: the program
/// should end soon.
pub(super) fn within<T: Send + 'static>(maximum: u64, work: impl FnOnce() -> T + Send + 'static) -> Result<T, String> {
    let before = held();
    let (sender, receiver) = mpsc::channel();
    let asked = thread::Builder::new().stack_size(STACK).spawn(move || {
        // Nobody listens any more when it took too much.
        let _ = sender.send(work());
    });
    asked.map_err(|error| format!("no thread can be started: {error}"))?;
    loop {
        match receiver.recv_timeout(PAUSE) {
            Ok(result) => return Ok(result),
            Err(RecvTimeoutError::Disconnected) => return Err("the query cannot be answered".to_owned()),
            Err(RecvTimeoutError::Timeout) => {
                if let (Some(before), Some(now)) = (before, held())
                    && now > before.saturating_add(maximum)
                {
                    let size = maximum >> 20;
                    return Err(format!(
                        "the query takes more than {size} MiB of memory: join on more columns, or choose fewer rows with \
                         WHERE"
                    ));
                }
            }
        }
    }
}

/// Bytes in memory that are this process's.
fn held() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    Some(line.trim().trim_end_matches("kB").trim().parse::<u64>().ok()? << 10)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_that_takes_too_much_is_left_behind() {
        assert_eq!(within(64 << 20, || 7), Ok(7));
        assert!(within(64 << 20, || panic!("expected by this test")).is_err());
        if held().is_some() {
            let said = within(64 << 20, || {
                let taken = vec![1_u8; 256 << 20];
                thread::sleep(Duration::from_secs(1));
                taken.len()
            });
            assert!(said.clone().is_err_and(|said| said.contains("more than 64 MiB")), "{said:?}");
        }
    }
}
