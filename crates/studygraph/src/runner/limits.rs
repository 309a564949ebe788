//! What a run may take.
//!
//! Must not know: what a run would take.

use std::fs;
use std::path::Path;

/// What a run may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Bytes; none: half of the machine's.
    pub memory: Option<u64>,
    /// Rows of all tables that are computed.
    pub rows: u64,
}

/// The rows that a run may have where nobody says otherwise.
pub const MOST_ROWS: u64 = 20_000_000;
/// The memory of a machine that does not tell.
const USUAL_MACHINE: u64 = 8_000_000_000;

impl Default for Limits {
    fn default() -> Self {
        Self { memory: None, rows: MOST_ROWS }
    }
}

impl Limits {
    /// Bytes that a run may hold.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.memory.unwrap_or_else(|| machine() / 2)
    }
}

/// Bytes of memory that this process may have: the machine's, or what its control groups allow where that is less.
fn machine() -> u64 {
    let read = |path: &Path| fs::read_to_string(path).ok();
    let installed = read(Path::new("/proc/meminfo")).and_then(|text| {
        let line = text.lines().find_map(|line| line.strip_prefix("MemTotal:")).map(str::to_owned)?;
        Some(line.trim().trim_end_matches("kB").trim().parse::<u64>().ok()? << 10)
    });
    let mut minimum = installed.unwrap_or(USUAL_MACHINE);
    let group = read(Path::new("/proc/self/cgroup")).unwrap_or_default();
    let group = group.lines().find_map(|line| line.strip_prefix("0::/")).unwrap_or_default();
    for folder in Path::new("/sys/fs/cgroup").join(group).ancestors().take_while(|path| path.starts_with("/sys/fs")) {
        let allowed = read(&folder.join("memory.max")).and_then(|text| text.trim().parse::<u64>().ok());
        minimum = minimum.min(allowed.unwrap_or(u64::MAX));
    }
    minimum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_machine_has_memory() {
        assert!(machine() > 100_000_000);
        assert_eq!(Limits { memory: Some(7), rows: 1 }.bytes(), 7);
        assert_eq!(Limits::default().bytes(), machine() / 2);
    }
}
