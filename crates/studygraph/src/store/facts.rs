//! Facts about a run that its results do not depend on: program, machine, time.
//!
//! Asking `git` starts a process, so the facts are collected only when a manifest is to be written. Must not know:
//! studies, tables.

use std::path::Path;
use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

use super::manifest::{Machine, Program, StudyFolder};
use crate::about::About;

/// What a manifest says besides the results.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Facts {
    pub program: Program,
    pub study_folder: StudyFolder,
    pub machine: Machine,
    /// UTC, RFC 3339.
    pub written: String,
}

impl Facts {
    /// Of a run by the program `about`; `folder`: where the study lies, whose git commit is recorded.
    #[must_use]
    pub fn collect(about: &About, folder: &Path, threads: usize) -> Self {
        let (commit, uncommitted_changes) = git(folder).map_or((None, None), |(commit, dirty)| (commit, Some(dirty)));
        let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
        Self {
            program: Program {
                version: about.version.to_owned(),
                code: about.code.to_owned(),
                commit: about.commit.map(|(commit, _)| commit.to_owned()),
                uncommitted_changes: about.commit.map(|(_, changed)| changed),
                rustc: about.rustc.to_owned(),
                profile: about.profile.to_owned(),
                dependencies: about.dependencies.to_owned(),
            },
            study_folder: StudyFolder { commit, uncommitted_changes },
            machine: Machine {
                system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
                processor: processor(),
                cores: std::thread::available_parallelism().map_or(1, usize::from),
                threads,
            },
            written: utc(seconds),
        }
    }
}

/// The commit (none before the first) and whether tracked or new files differ from it; one process answers both.
fn git(folder: &Path) -> Option<(Option<String>, bool)> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    if !may_be_in_git(folder) {
        return None;
    }
    let status = ["status", "--porcelain=v2", "--branch"];
    let output = Command::new("git").arg("-C").arg(folder).args(status).output().ok()?;
    if !output.status.success() {
        return None;
    }
    let text = String::from_utf8_lossy(&output.stdout);
    let commit = text.lines().find_map(|line| line.strip_prefix("# branch.oid "));
    let dirty = text.lines().any(|line| !line.starts_with('#'));
    Some((commit.filter(|commit| *commit != "(initial)").map(str::to_owned), dirty))
}

/// Whether there is a work tree around a folder, as git looks for one. To start git for nothing takes as long as a small study.
fn may_be_in_git(folder: &Path) -> bool {
    let Ok(folder) = folder.canonicalize() else { return true };
    std::env::var_os("GIT_DIR").is_some() || folder.ancestors().any(|folder| folder.join(".git").exists())
}

fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = text.lines().find(|line| line.starts_with("model name")).and_then(|line| line.split_once(':'));
    model.map_or_else(|| "unknown".to_owned(), |(_, name)| name.trim().to_owned())
}

/// Seconds since 1970 as RFC 3339.
#[must_use]
pub fn utc(seconds: u64) -> String {
    let (days, second) = (seconds / 86_400, seconds % 86_400);
    // Counted from 1 March of year 0, so that a leap day ends its year; 719 468 days lie between that day and 1970.
    let since = days + 719_468;
    let (era, day_of_era) = (since / 146_097, since % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1_460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * shifted + 2) / 5 + 1;
    let month = if shifted < 10 { shifted + 3 } else { shifted - 9 };
    let year = era * 400 + year_of_era + u64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02}T{:02}:{:02}:{:02}Z", second / 3600, second / 60 % 60, second % 60)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::about::ABOUT;

    #[test]
    fn known_moments_in_utc() {
        for (seconds, text) in [
            (0, "1970-01-01T00:00:00Z"),
            (951_782_399, "2000-02-28T23:59:59Z"),
            (951_782_400, "2000-02-29T00:00:00Z"),
            (1_000_000_000, "2001-09-09T01:46:40Z"),
            (1_234_567_890, "2009-02-13T23:31:30Z"),
            (4_107_542_399, "2100-02-28T23:59:59Z"),
            (4_107_542_400, "2100-03-01T00:00:00Z"),
        ] {
            assert_eq!(utc(seconds), text);
        }
    }

    #[test]
    fn a_folder_outside_git_has_no_commit() {
        let folder = tempfile::tempdir().unwrap();
        let facts = Facts::collect(&ABOUT, folder.path(), 3);
        assert_eq!(facts.study_folder, StudyFolder::default());
        // Built here, wherever the study lies.
        assert_eq!(facts.program.commit.as_deref(), Some("built"));
        assert_eq!(facts.program.code, ABOUT.code);
        assert!(facts.machine.cores >= 1 && facts.machine.threads == 3);
    }

    #[test]
    fn a_commit_and_a_change_are_seen() {
        let folder = tempfile::tempdir().unwrap();
        let run = |arguments: &[&str]| {
            let identity = ["-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"];
            let git = Command::new("git").arg("-C").arg(folder.path()).args(identity).args(arguments).output().unwrap();
            assert!(git.status.success(), "{arguments:?}");
        };
        run(&["init", "-q"]);
        std::fs::write(folder.path().join("a"), "1").unwrap();
        assert_eq!(git(folder.path()), Some((None, true)));
        run(&["add", "a"]);
        run(&["commit", "-qm", "a"]);
        let (commit, dirty) = git(folder.path()).unwrap();
        assert_eq!((commit.unwrap().len(), dirty), (40, false));
        std::fs::write(folder.path().join("a"), "2").unwrap();
        assert!(git(folder.path()).unwrap().1);
        // The study's commit is none of the program's.
        let facts = Facts::collect(&ABOUT, folder.path(), 1);
        assert_eq!(
            (facts.study_folder.commit.clone(), facts.study_folder.uncommitted_changes),
            (git(folder.path()).unwrap().0, Some(true))
        );
        assert_ne!(facts.program.commit, facts.study_folder.commit);
    }
}
