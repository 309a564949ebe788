//! Facts about a run that its results do not depend on: program, machine, time.
//!
//! Asking `git` starts a process, so the facts are collected only when a manifest is to be written. Must not know:
//! studies, tables.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use super::manifest::{Machine, Program, StudyFolder};
use crate::about::About;
use crate::git;
use crate::presence;

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
    /// Of a run by the program `about` of a study in `study_folder`.
    #[must_use]
    pub fn collect(about: &About, study_folder: StudyFolder, threads: usize) -> Self {
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
            study_folder,
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

impl StudyFolder {
    /// The commit of the repository around a study (none before the first), and whether the study is another one there: its file,
    /// which is the first of `files`, or one of the others that it names. A file that the commit does not hold is a change. Nothing
    /// outside of a repository.
    ///
    /// # Errors
    /// The reason of git for not answering although a repository surrounds the study.
    pub fn of(files: &[PathBuf]) -> Result<Self, String> {
        let folder = files.first().and_then(|file| file.parent()).unwrap_or(Path::new(""));
        if !git::may_know(folder) {
            return Ok(Self::default());
        }
        let tracked: Vec<PathBuf> = files.iter().filter_map(|file| tracked(folder, file)).collect();
        // Said in full, since settings of the user change the defaults.
        let all = ["--untracked-files=all", "--ignored=matching", "--ignore-submodules=none", "--no-renames", "--"];
        let words = ["status", "--porcelain=v2", "--branch", "-z"].into_iter().chain(all).map(OsStr::new);
        let paths = tracked.iter().map(|path| path.as_os_str());
        let answer = match git::ask(folder, &words.chain(paths).collect::<Vec<_>>()) {
            // A bare repository has no files that a study could be one of.
            Err(problem) if problem.contains(git::NO_WORK_TREE) => return Ok(Self::default()),
            answer => answer?,
        };
        let text = String::from_utf8_lossy(&answer);
        let entries = || text.split('\0').filter(|entry| !entry.is_empty());
        let commit = entries().find_map(|entry| entry.strip_prefix("# branch.oid "));
        let is_changed = tracked.len() < files.len() || entries().any(|entry| !entry.starts_with("# "));
        let commit = commit.filter(|commit| *commit != "(initial)").map(str::to_owned);
        Ok(Self { commit, uncommitted_changes: Some(is_changed), ..Self::default() })
    }
}

/// The path by which git knows a file, from the folder of the study: its own, that of the submodule or repository around it, that of
/// the file behind a link. None for a file that is not there, or lies elsewhere.
fn tracked(folder: &Path, file: &Path) -> Option<PathBuf> {
    let (folder, file) = (real(folder)?, real(file)?);
    let inside = file.strip_prefix(&folder).ok()?;
    let below = || inside.ancestors().skip(1).filter(|below| !below.as_os_str().is_empty());
    let nested = below().find(|below| matches!(presence::link_metadata(&folder.join(below).join(".git")), Ok(Some(_))));
    Some(nested.unwrap_or(inside).to_owned())
}

fn real(path: &Path) -> Option<PathBuf> {
    if path.as_os_str().is_empty() { Path::new(".").canonicalize().ok() } else { path.canonicalize().ok() }
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
        let found = StudyFolder::of(&[folder.path().join("a.yaml")]).unwrap();
        assert_eq!(found, StudyFolder::default());
        let facts = Facts::collect(&ABOUT, found, 3);
        // Built here, wherever the study lies.
        assert_eq!(facts.program.commit.as_deref(), Some("built"));
        assert_eq!(facts.program.code, ABOUT.code);
        assert!(facts.machine.cores >= 1 && facts.machine.threads == 3);
    }

    /// Files of the study count: changed, staged, new, ignored, in a submodule, behind a link. Others do not.
    #[test]
    fn a_change_is_one_of_the_study_alone() {
        let folder = tempfile::tempdir().unwrap();
        let run = |at: &str, arguments: &[&str]| {
            let identity = ["-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"];
            let mut git = git::command(&folder.path().join(at));
            let git = git.args(identity).args(arguments).output().unwrap();
            assert!(git.status.success(), "{arguments:?}: {git:?}");
        };
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
        let of = |names: &[&str]| {
            let files: Vec<PathBuf> = names.iter().map(|name| folder.path().join(name)).collect();
            StudyFolder::of(&files).unwrap()
        };
        let changed = |names: &[&str]| of(names).uncommitted_changes.unwrap();
        run("", &["init", "-q"]);
        // A pattern of git in a name is no pattern here.
        write("a*.yaml", "1");
        assert_eq!(of(&["a*.yaml"]), StudyFolder { uncommitted_changes: Some(true), ..StudyFolder::default() });
        std::fs::create_dir_all(folder.path().join("traces/sub")).unwrap();
        write("traces/b.csv", "1");
        write("traces/ignored.csv", "1");
        write(".gitignore", "ignored.csv\n");
        run("traces/sub", &["init", "-q"]);
        write("traces/sub/c.csv", "1");
        run("traces/sub", &["add", "-A"]);
        run("traces/sub", &["commit", "-qm", "c"]);
        run("", &["add", "-A"]);
        run("", &["commit", "-qm", "a"]);
        write("new.txt", "results and notes");
        write("ab.yaml", "1");
        let study = ["a*.yaml", "traces/b.csv", "traces/sub/c.csv"];
        assert_eq!((of(&study).commit.unwrap().len(), changed(&study)), (40, false));
        assert!(changed(&["a*.yaml", "traces/ignored.csv"]) && changed(&["ab.yaml"]) && changed(&["none.yaml"]));
        write("traces/b.csv", "2");
        assert!(changed(&study) && !changed(&study[..1]));
        run("", &["add", "-A"]);
        assert!(changed(&study));
        run("", &["commit", "-qm", "b"]);
        write("traces/sub/c.csv", "2");
        assert!(changed(&study) && !changed(&study[..2]));
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("a*.yaml", folder.path().join("link.yaml")).unwrap();
            assert!(!changed(&["link.yaml"]));
            write("a*.yaml", "2");
            assert!(changed(&["link.yaml"]));
        }
        // The study's commit is none of the program's.
        let facts = Facts::collect(&ABOUT, of(&study), 1);
        assert_eq!((&facts.study_folder, facts.study_folder.uncommitted_changes), (&of(&study), Some(true)));
        assert_ne!(facts.program.commit, facts.study_folder.commit);
    }
}
