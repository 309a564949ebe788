//! Files of a commit, read from git's objects: nothing is checked out.
//!
//! Asks the program `git`, so worktrees, packs, alternates and sparse checkouts are its business. Must not know: what
//! the files mean.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Component, Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::{Mutex, PoisonError};

use declare::error::nearest;

/// The work tree that holds a folder.
#[derive(Clone, Debug)]
pub struct Repository {
    top: PathBuf,
    /// A link, and the folder that the last commit has in its place.
    link: Option<(PathBuf, PathBuf)>,
}

/// A revision that was found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Commit {
    /// As it was asked for.
    pub word: String,
    pub id: String,
}

impl Commit {
    /// `main (59b124e)`; of a word that is the start of the hash, the hash alone.
    #[must_use]
    pub fn label(&self) -> String {
        let short: String = self.id.chars().take(7).collect();
        if self.id.starts_with(&self.word) { short } else { format!("{} ({short})", self.word) }
    }
}

fn git(folder: &Path) -> Command {
    let mut command = Command::new("git");
    command.arg("-C").arg(folder).env("LC_ALL", "C");
    command
}

/// Standard output of a command that succeeds, or the first line of what it says.
fn ask<S: AsRef<OsStr>>(folder: &Path, words: &[S]) -> Result<Vec<u8>, String> {
    let output = git(folder).args(words).output().map_err(|error| format!("`git` cannot be started: {error}"))?;
    if output.status.success() {
        return Ok(output.stdout);
    }
    let said = String::from_utf8_lossy(&output.stderr);
    let first = said.lines().find(|line| !line.trim().is_empty()).unwrap_or("it gave no reason");
    Err(first.trim_start_matches("fatal: ").to_owned())
}

impl Repository {
    /// The repository around `path`, which need not exist itself. A link is followed, unless the last commit has a folder
    /// in its place: results may have been moved to a larger disk.
    ///
    /// # Errors
    /// When there is none, or git refuses.
    pub fn around(path: &Path) -> Result<Self, String> {
        if let Some(found) = Self::around_link(path) {
            return Ok(found);
        }
        let mut folder = path;
        while !folder.is_dir() {
            folder = folder.parent().unwrap_or(Path::new(""));
            if folder.as_os_str().is_empty() {
                folder = Path::new(".");
            }
        }
        Self::top(folder).map_err(|problem| {
            if problem.contains("not a git repository") {
                format!("`{}` is not in a git repository", folder.display())
            } else {
                problem
            }
        })
    }

    fn top(folder: &Path) -> Result<Self, String> {
        let top = ask(folder, &["rev-parse", "--show-toplevel"])?;
        let text = String::from_utf8_lossy(&top);
        Ok(Self { top: PathBuf::from(text.trim_end_matches(['\n', '\r'])), link: None })
    }

    fn around_link(path: &Path) -> Option<Self> {
        let path = std::path::absolute(path).ok()?;
        let (parent, name) = (path.parent()?, path.file_name()?);
        if !path.symlink_metadata().ok()?.is_symlink() {
            return None;
        }
        let found = Self::top(parent).ok()?;
        let inside = found.inside(parent).ok()?.join(name);
        let words = ["ls-tree", "-d", "HEAD", "--"].map(OsStr::new);
        let listed = ask(&found.top, &[&words[..], &[inside.as_os_str()]].concat()).ok()?;
        (!listed.is_empty()).then_some(Self { link: Some((path, inside)), ..found })
    }

    /// `path` relative to the top of the work tree.
    ///
    /// # Errors
    /// When it lies outside.
    pub fn inside(&self, path: &Path) -> Result<PathBuf, String> {
        let cannot = |error: std::io::Error| format!("cannot find `{}`: {error}", path.display());
        let absolute = std::path::absolute(path).map_err(cannot)?;
        if let Some((link, inside)) = &self.link
            && let Ok(rest) = absolute.strip_prefix(link)
        {
            return Ok(if rest.as_os_str().is_empty() { inside.clone() } else { inside.join(rest) });
        }
        // What exists may lie behind symbolic links; the rest is taken by its name.
        let (mut existing, mut rest) = (absolute.as_path(), Vec::new());
        while !existing.exists() {
            rest.extend(existing.file_name().map(OsStr::to_owned));
            existing = existing.parent().unwrap_or(Path::new("/"));
        }
        let real = existing.canonicalize().map_err(cannot)?;
        let top = self.top.canonicalize().map_err(cannot)?;
        let outside = || format!("`{}` lies outside the repository `{}`", path.display(), self.top.display());
        let mut inside = real.strip_prefix(&top).map_err(|_| outside())?.to_owned();
        inside.extend(rest.into_iter().rev());
        if inside.components().any(|part| part == Component::ParentDir) { Err(outside()) } else { Ok(inside) }
    }

    /// Finds a commit.
    ///
    /// # Errors
    /// When there is none of this name: with the nearest branch or tag.
    pub fn commit(&self, word: &str) -> Result<Commit, String> {
        let wanted = format!("{word}^{{commit}}");
        let words = ["rev-parse", "--verify", "--quiet", "--end-of-options", &wanted];
        if let Ok(found) = ask(&self.top, &words) {
            return Ok(Commit { word: word.to_owned(), id: String::from_utf8_lossy(&found).trim().to_owned() });
        }
        let names = self.names();
        if names.is_empty() && ask(&self.top, &["rev-parse", "--verify", "--quiet", "HEAD"]).is_err() {
            return Err(format!("there is no revision `{word}`: this repository has no commit yet"));
        }
        let near = nearest(word, names.iter().map(String::as_str));
        let help = near.map_or_else(|| shallow(&self.top), |near| format!("; did you mean `{near}`?"));
        Err(format!("there is no revision `{word}`{help}"))
    }

    /// Names of branches and tags.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        let format = "--format=%(refname:short)";
        let listed = ask(&self.top, &["for-each-ref", format, "refs/heads", "refs/tags", "refs/remotes"]);
        String::from_utf8_lossy(&listed.unwrap_or_default()).lines().map(str::to_owned).collect()
    }

    /// Whether git is told to leave this file alone, wherever it is.
    #[must_use]
    pub fn leaves_out(&self, path: &Path) -> bool {
        let Ok(inside) = self.inside(path) else { return false };
        let words = [OsStr::new("check-ignore"), OsStr::new("--quiet"), OsStr::new("--"), inside.as_os_str()];
        ask(&self.top, &words).is_ok()
    }

    /// The files below `folder` at a commit.
    ///
    /// # Errors
    /// When git cannot be started or its answer not be read.
    pub fn files(&self, commit: &Commit, folder: &Path) -> Result<Files, String> {
        let mut words = vec![OsStr::new("ls-tree"), OsStr::new("-r"), OsStr::new("-z"), OsStr::new(&commit.id)];
        let mut below = folder.as_os_str().to_owned();
        if !below.is_empty() {
            below.push("/");
            words.extend([OsStr::new("--"), &below]);
        }
        let listed = ask(&self.top, &words)?;
        let mut objects = BTreeMap::new();
        for entry in listed.split(|byte| *byte == 0).filter(|entry| !entry.is_empty()) {
            let text = String::from_utf8_lossy(entry);
            let Some((about, path)) = text.split_once('\t') else { continue };
            let about: Vec<&str> = about.split(' ').collect();
            // A link or a submodule is not a file.
            if let ["100644" | "100755", "blob", id] = about[..]
                && let Ok(inside) = Path::new(path).strip_prefix(folder)
            {
                objects.insert(inside.to_owned(), id.to_owned());
            }
        }
        Ok(Files { objects, reader: Mutex::new(Reader::start(&self.top)?) })
    }
}

fn shallow(top: &Path) -> String {
    let answer = ask(top, &["rev-parse", "--is-shallow-repository"]).unwrap_or_default();
    let shallow = answer.starts_with(b"true");
    if shallow { "; this clone is shallow: fetch more of its history first".to_owned() } else { String::new() }
}

/// The files of one commit below one folder.
pub struct Files {
    objects: BTreeMap<PathBuf, String>,
    reader: Mutex<Reader>,
}

impl Files {
    /// Paths below the folder.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.objects.keys().map(PathBuf::as_path)
    }

    #[must_use]
    pub fn has(&self, path: &Path) -> bool {
        self.objects.contains_key(path)
    }

    /// A file's bytes; none when it is not in the commit.
    ///
    /// # Errors
    /// When git cannot give them.
    pub fn read(&self, path: &Path) -> Result<Option<Vec<u8>>, String> {
        let Some(id) = self.objects.get(path) else { return Ok(None) };
        let read = self.reader.lock().unwrap_or_else(PoisonError::into_inner).read(id);
        let bytes = read.map_err(|error| format!("git cannot read `{}`: {error}", path.display()))?;
        bytes.map(Some).ok_or_else(|| format!("git has no contents of `{}`: fetch them first", path.display()))
    }
}

/// One `git cat-file --batch` for many files.
struct Reader {
    child: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
}

impl Reader {
    fn start(top: &Path) -> Result<Self, String> {
        let mut command = git(top);
        command.args(["cat-file", "--batch"]).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        let cannot = |problem: &dyn std::fmt::Display| format!("`git cat-file` cannot be started: {problem}");
        let mut child = command.spawn().map_err(|error| cannot(&error))?;
        let output = child.stdout.take().ok_or_else(|| cannot(&"it has no output"))?;
        Ok(Self { input: child.stdin.take(), output: BufReader::new(output), child })
    }

    /// None for an object that this clone does not hold.
    fn read(&mut self, id: &str) -> std::io::Result<Option<Vec<u8>>> {
        if let Some(input) = &mut self.input {
            writeln!(input, "{id}")?;
            input.flush()?;
        }
        let mut head = String::new();
        self.output.read_line(&mut head)?;
        let Some(size) = head.trim_end().split(' ').nth(2).and_then(|size| size.parse::<usize>().ok()) else {
            return Ok(None);
        };
        let mut bytes = vec![0; size + 1];
        self.output.read_exact(&mut bytes)?;
        bytes.truncate(size);
        Ok(Some(bytes))
    }
}

impl Drop for Reader {
    fn drop(&mut self) {
        // Its input at an end, git ends.
        self.input = None;
        let _ = self.child.wait();
    }
}
