//! Stages that cut themselves into parts, each computed and kept by itself.
//!
//! A part is known by the digest of what is in it, never by its number or by how many others there are: whatever else
//! changes, a part that is the same is not computed again. One that is not the same may still have rows that an earlier
//! part had, and take them over. Must not know: the runner, the store.

use std::ops::Range;
use std::sync::Arc;

use crate::table::data::{Cell, Table};
use declare::digest::Digest;
use declare::error::Failure;

/// The parts of a stage.
#[derive(Clone, Debug, PartialEq)]
pub struct Parts {
    /// Fields of its record that say which rows there are: they are in no part's key but through [`Parts::each`] and
    /// [`Parts::shared`].
    pub fields: &'static [&'static str],
    /// What of those fields every row depends on.
    pub shared: Digest,
    /// What is in each part.
    pub each: Vec<Digest>,
    /// Whether the last part is made of the tables of all others, and computed after them.
    pub last_is_of_all: bool,
}

/// What a part may read of other parts of its stage.
pub trait Others: Sync {
    /// A table of another part of this run; only the last part may ask, where it is made of all others.
    ///
    /// # Errors
    /// When it cannot be read; the runner knows why.
    fn of_part(&self, part: usize, table: &str) -> Result<Arc<Table>, Failure>;

    /// A table of those parts of the stage's last success that have rows with keys from `first` to `last`, in the order of
    /// their keys. They have the code, the fields, the inputs and the seed of this run, so a row in them is the same function
    /// of its values. Those that are not there any more are left out.
    fn earlier(&self, table: &str, first: &[Cell], last: &[Cell]) -> Vec<Arc<Table>>;
}

/// Nothing beside a part: for a stage that is run by itself.
pub struct Alone;

impl Others for Alone {
    fn of_part(&self, _part: usize, _table: &str) -> Result<Arc<Table>, Failure> {
        Err(Failure::new("there are no other parts"))
    }

    fn earlier(&self, _table: &str, _first: &[Cell], _last: &[Cell]) -> Vec<Arc<Table>> {
        Vec::new()
    }
}

/// Cuts `count` things in a row into stretches of `size` on average, of four times that at most; where one ends, the digest
/// of its last thing says, so that a thing put in between changes one stretch.
pub fn cut(count: usize, size: usize, digest: impl Fn(usize) -> Digest) -> Vec<Range<usize>> {
    let mut stretches = Vec::new();
    let mut start = 0;
    for index in 0..count {
        let full = index + 1 - start >= size.saturating_mul(4);
        if index + 1 == count || full || ends(&digest(index), size) {
            stretches.push(start..index + 1);
            start = index + 1;
        }
    }
    stretches
}

/// One digest in `size` ends a stretch.
fn ends(digest: &Digest, size: usize) -> bool {
    let number = digest.0[..8].iter().fold(0, |number, byte| number << 8 | u64::from(*byte));
    number % size.max(1) as u64 == 0
}
