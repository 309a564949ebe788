//! Who owns a lock file or a temporary file: a process of a start of a computer, and whether it can still live.
//!
//! Must not know: what is owned.

use std::fs;
use std::time::{SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use super::facts;

/// A process, by what tells it apart from every other one.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Owner {
    pub host: String,
    /// Tells apart computers of one name, where the system has such a thing.
    pub(super) machine: String,
    /// Another one after every start of the computer; shared by its containers. Empty where it is not known.
    pub(super) boot: String,
    pub process: u32,
    /// When the process began, in ticks since the start of the computer: numbers of processes come again.
    pub(super) started: u64,
    /// In which numbers of processes mean anything: containers count for themselves.
    pub(super) space: String,
    /// UTC, RFC 3339.
    pub(super) since: String,
}

impl Owner {
    pub(super) fn current() -> Self {
        let text = |path: &str| fs::read_to_string(path).unwrap_or_default().trim().to_owned();
        let named = |name: &str| std::env::var(name).ok();
        let host = Some(text("/proc/sys/kernel/hostname")).filter(|host| !host.is_empty());
        let process = std::process::id();
        let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
        Self {
            host: host.or_else(|| named("HOSTNAME")).or_else(|| named("COMPUTERNAME")).unwrap_or_default(),
            machine: text("/etc/machine-id"),
            boot: boot(),
            process,
            started: started(process).unwrap_or(0),
            space: fs::read_link("/proc/self/ns/pid").map_or_else(|_| String::new(), |it| it.display().to_string()),
            since: facts::utc(seconds),
        }
    }

    /// Whether this owner cannot live any more, as far as `me` can tell. `held`: `me` has the kernel's lock.
    pub(super) fn is_gone(&self, me: &Self, held: bool) -> bool {
        let same_computer = self.host == me.host && self.machine == me.machine;
        if self.boot != me.boot {
            // A boot that is not known is not another one.
            return same_computer && !self.boot.is_empty() && !me.boot.is_empty();
        }
        if self.boot.is_empty() {
            return same_computer && held;
        }
        // One kernel: its lock would be held if its owner lived.
        held || (self.space == me.space && started(self.process) != Some(self.started))
    }
}

/// Names this start of the computer; empty where the system does not say.
#[must_use]
pub fn boot() -> String {
    fs::read_to_string("/proc/sys/kernel/random/boot_id").unwrap_or_default().trim().to_owned()
}

/// Whether there is such a process in this container, and not only what is left of it.
pub(super) fn lives(process: u32) -> bool {
    started(process).is_some()
}

/// When a process began, in ticks since the computer was started; none when there is no such process that lives.
fn started(process: u32) -> Option<u64> {
    let text = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    // The name of the program, in brackets, may hold anything. Fields 3 (state) and 22: proc(5).
    let mut fields = text.rsplit_once(')')?.1.split_whitespace();
    let dead = matches!(fields.next()?, "Z" | "X");
    fields.nth(18)?.parse().ok().filter(|_| !dead)
}
