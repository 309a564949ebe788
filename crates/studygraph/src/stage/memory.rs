//! How much memory something takes: an allocator that counts while it is asked to, and is the system's otherwise.
//!
//! What it counts is bytes asked for and not given back, of the whole process: a measurement is worth something only
//! where nothing else runs beside. Pages, fragments and what libraries take from the system themselves are not in it.
//! The program installs it (`main.rs`); without it nothing is measured. And what the system's allocator holds for threads that
//! have ended is given back on demand. Must not know: what is measured.

#![expect(
    unsafe_code,
    reason = "an allocator is an unsafe trait, each call is handed on as it came; one call of the C library"
)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicBool, AtomicIsize, Ordering};

/// The allocator of the program.
pub struct Allocator;

static COUNTS: AtomicBool = AtomicBool::new(false);
/// Bytes held, from where counting began; less than none where older memory was given back.
static HELD: AtomicIsize = AtomicIsize::new(0);
static PEAK: AtomicIsize = AtomicIsize::new(0);

fn count(more: usize, less: usize) {
    if COUNTS.load(Ordering::Relaxed) {
        // The sizes of allocations fit isize: `Layout` refuses others.
        let change = more.cast_signed() - less.cast_signed();
        let held = HELD.fetch_add(change, Ordering::Relaxed) + change;
        PEAK.fetch_max(held, Ordering::Relaxed);
    }
}

// SAFETY: every call goes to the system's allocator as it came; counting neither allocates nor panics.
unsafe impl GlobalAlloc for Allocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size(), 0);
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(layout.size(), 0);
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count(0, layout.size());
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(size, layout.size());
        unsafe { System.realloc(pointer, layout, size) }
    }
}

/// Gives back to the system what was freed, where its allocator holds it: each thread has a part of its own, which other ones
/// do not take from.
pub fn give_back() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    // SAFETY: it takes no pointer, and changes nothing that is in use.
    unsafe {
        libc::malloc_trim(0);
    }
}

/// Counting ends also where `work` panics.
struct Counting;
impl Drop for Counting {
    fn drop(&mut self) {
        COUNTS.store(false, Ordering::Relaxed);
    }
}

/// What `work` gives, and the most bytes that were held while it ran over those held before; none where the program does
/// not count, or counts for somebody else.
pub fn most_during<T>(work: impl FnOnce() -> T) -> (T, Option<usize>) {
    if COUNTS.swap(true, Ordering::Relaxed) {
        return (work(), None);
    }
    HELD.store(0, Ordering::Relaxed);
    PEAK.store(0, Ordering::Relaxed);
    let counting = Counting;
    let result = work();
    drop(counting);
    let maximum = usize::try_from(PEAK.load(Ordering::Relaxed)).ok();
    // Nothing that is worth measuring does without memory: no allocator counted.
    (result, maximum.filter(|maximum| *maximum > 0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tests do not install it; called by hand it counts what it hands out, and only while it is asked to.
    #[test]
    fn the_most_that_was_held_is_counted() {
        let block = |size| Layout::from_size_align(size, 8).unwrap();
        let take = |size| unsafe { Allocator.alloc(block(size)) };
        let give = |pointer, size| unsafe { Allocator.dealloc(pointer, block(size)) };
        let old = take(5000);
        let ((), maximum) = most_during(|| {
            let one = take(1000);
            let two = unsafe { Allocator.realloc(one, block(1000), 3000) };
            give(two, 3000);
            let three = unsafe { Allocator.alloc_zeroed(block(2000)) };
            assert_eq!(most_during(|| ()).1, None, "only one measures at a time");
            give(three, 2000);
            give(old, 5000);
            give(take(4000), 4000);
        });
        assert_eq!(maximum, Some(3000));
        give(take(9000), 9000);
        assert_eq!(most_during(|| ()).1, None, "nothing was counted");
    }
}
