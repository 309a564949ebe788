//! Threads for work outside a run, which has a pool of its own.
//!
//! The pool that rayon makes for everybody panics where the system starts no threads (a limit on processes, on memory).
//! Must not know: what is computed.

use std::mem;
use std::sync::OnceLock;

use rayon::{ThreadPool, ThreadPoolBuilder};

/// Does work that may divide itself up, on one thread per processor; on this thread alone if the system starts no others.
pub fn with_all<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    static POOL: OnceLock<Option<ThreadPool>> = OnceLock::new();
    if rayon::current_thread_index().is_some() {
        return work();
    }
    let pool = POOL.get_or_init(|| ThreadPoolBuilder::new().thread_name(|index| format!("all {index}")).build().ok());
    if let Some(pool) = pool {
        return pool.install(work);
    }
    // This thread belongs to the pool from now on, so the pool must stay.
    if let Ok(alone) = ThreadPoolBuilder::new().num_threads(1).use_current_thread().build() {
        mem::forget(alone);
    }
    work()
}

#[cfg(test)]
mod tests {
    use rayon::prelude::*;

    use super::with_all;

    #[test]
    fn work_is_divided_up_and_may_ask_again() {
        let squares = || (0..100_u64).into_par_iter().map(|n| with_all(|| n * n)).sum::<u64>();
        assert_eq!(with_all(squares), 328_350);
        assert_eq!(with_all(|| rayon::join(|| 1, || 2)), (1, 2));
    }
}
