//! Files of a commit, read from git's objects: nothing is checked out.
//!
//! Asks the program `git`, so worktrees, packs, alternates and sparse checkouts are its business. Must not know: what
//! the files mean.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Component, Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Stdio};
use std::sync::{Mutex, PoisonError};

use crate::git::{self, ask};
use crate::presence;
use declare::error::nearest;

/// The repository that holds a folder.
#[derive(Clone, Debug)]
pub struct Repository {
    /// The top of the work tree; of a bare repository the folder that stands for it.
    top: PathBuf,
    is_bare: bool,
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
        while !presence::is_folder(folder).map_err(presence::unread(folder))? {
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
        let path = |answer: Vec<u8>| PathBuf::from(String::from_utf8_lossy(&answer).trim_end_matches(['\n', '\r']));
        match ask(folder, &["rev-parse", "--show-toplevel"]) {
            Err(problem) if problem.contains(git::NO_WORK_TREE) => {
                let own = path(ask(folder, &["rev-parse", "--absolute-git-dir"])?);
                Ok(Self { top: bare_top(folder, &own)?, is_bare: true, link: None })
            }
            top => Ok(Self { top: path(top?), is_bare: false, link: None }),
        }
    }

    fn around_link(path: &Path) -> Option<Self> {
        let path = std::path::absolute(path).ok()?;
        let (parent, name) = (path.parent()?, path.file_name()?);
        if !presence::link_metadata(&path).ok()??.is_symlink() {
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
        while !presence::exists(existing).map_err(cannot)? {
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

    /// Whether it has no work tree: its commits are all that there is.
    #[must_use]
    pub fn is_bare(&self) -> bool {
        self.is_bare
    }

    /// Finds a commit.
    ///
    /// # Errors
    /// When there is none of this name: with [`Repository::help`].
    pub fn commit(&self, word: &str) -> Result<Commit, String> {
        if let Some(found) = self.find(word) {
            return Ok(found);
        }
        if self.find("HEAD").is_none() && self.names().is_empty() {
            return Err(format!("there is no revision `{word}`: this repository has no commit yet"));
        }
        Err(format!("there is no revision `{word}`{}", self.help(word, word, &[])))
    }

    fn find(&self, word: &str) -> Option<Commit> {
        let wanted = format!("{word}^{{commit}}");
        let found = ask(&self.top, &["rev-parse", "--verify", "--quiet", "--end-of-options", &wanted]).ok()?;
        Some(Commit { word: word.to_owned(), id: String::from_utf8_lossy(&found).trim().to_owned() })
    }

    /// The two commits of `A..B`, or of `A...B`: the common ancestor of both and `B`, as in `git diff`. `HEAD` stands for a side
    /// without a name. Nothing for a word that is not a range.
    ///
    /// # Errors
    /// When there is no such commit, or no common ancestor.
    pub fn range(&self, word: &str) -> Result<Option<[Commit; 2]>, String> {
        let Some((before, after, from_ancestor)) = ends(word) else { return Ok(None) };
        let commit = |end: &str| self.commit(if end.is_empty() { "HEAD" } else { end });
        let (before, after) = (commit(before)?, commit(after)?);
        if !from_ancestor {
            return Ok(Some([before, after]));
        }
        let (one, other) = (&before.word, &after.word);
        let none = |_| format!("`{one}` and `{other}` have no common ancestor{}", self.shallow());
        let found = ask(&self.top, &["merge-base", &before.id, &after.id]).map_err(none)?;
        let id = String::from_utf8_lossy(&found).trim().to_owned();
        Ok(Some([Commit { word: format!("common ancestor of {one} and {other}"), id }, after]))
    }

    /// A remedy for a `word` that names no revision: the nearest name to `name` of branches, tags and `others`; that a range is
    /// two commits; that a clone has no more of its history. It follows a sentence.
    #[must_use]
    pub fn help(&self, word: &str, name: &str, others: &[String]) -> String {
        if ends(word).is_some() {
            return format!("; it is a range, and one commit is expected{}", self.shallow());
        }
        let names = self.names();
        // `main~9` does not mean `main`: the branch is there, and its ancestor is not.
        let branch = word.split(['~', '^', '@', ':']).next().unwrap_or(word);
        let is_ancestor = branch != word && self.find(branch).is_some();
        let known = others.iter().chain(&names).map(String::as_str).filter(|_| !is_ancestor);
        let near = nearest(name, known).map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
        near + &self.shallow()
    }

    fn shallow(&self) -> String {
        let answer = ask(&self.top, &["rev-parse", "--is-shallow-repository"]).unwrap_or_default();
        let text = "; this clone is shallow: fetch more of its history first (git fetch --unshallow)";
        if answer.starts_with(b"true") { text.to_owned() } else { String::new() }
    }

    /// Names of branches and tags.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        let format = "--format=%(refname:short)";
        let listed = ask(&self.top, &["for-each-ref", format, "refs/heads", "refs/tags", "refs/remotes"]);
        String::from_utf8_lossy(&listed.unwrap_or_default()).lines().map(str::to_owned).collect()
    }

    /// Whether git is told to leave this file alone, wherever it is.
    ///
    /// # Errors
    /// The reason of git for not answering.
    pub fn leaves_out(&self, path: &Path) -> Result<bool, String> {
        let Some(inside) = self.inside(path).ok().filter(|_| !self.is_bare) else { return Ok(false) };
        // It knows no patterns, and refuses to be told so. Nothing that begins with a dot is a magic word of git.
        let mut command = git::command(&self.top);
        command.env_remove("GIT_LITERAL_PATHSPECS");
        let below = Path::new(".").join(inside);
        let words = [OsStr::new("check-ignore"), OsStr::new("--quiet"), OsStr::new("--"), below.as_os_str()];
        let cannot = |problem| format!("it is not known whether git keeps `{}`: {problem}", path.display());
        git::decide(&mut command, &words).map_err(cannot)
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
        let listed = git::answer(&mut git::fetching(&self.top), &words)?;
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
        Ok(Files { objects, reader: Mutex::new(Reader { top: self.top.clone(), process: None, has_failed: false }) })
    }
}

/// The folder that stands for the top of the work tree of a bare repository: its own, or that of the `.git` that names it.
fn bare_top(folder: &Path, own: &Path) -> Result<PathBuf, String> {
    let cannot = |error: std::io::Error| format!("cannot find `{}`: {error}", folder.display());
    let folder = folder.canonicalize().map_err(cannot)?;
    let own = own.canonicalize().map_err(cannot)?;
    if folder.starts_with(&own) {
        return Ok(own);
    }
    let named = folder.ancestors().find(|above| matches!(presence::link_metadata(&above.join(".git")), Ok(Some(_))));
    Ok(named.unwrap_or(&folder).to_owned())
}

/// The ends of a range, and whether it begins at the common ancestor of both. No name of git has `..`; a path that has it has a
/// separator beside it.
fn ends(word: &str) -> Option<(&str, &str, bool)> {
    let (before, after, from_ancestor) = match word.split_once("...") {
        Some((before, after)) => (before, after, true),
        None => word.split_once("..").map(|(before, after)| (before, after, false))?,
    };
    let is_path = before.ends_with(['/', '\\']) || after.starts_with(['/', '\\']) || word.trim_matches('.').is_empty();
    (!is_path).then_some((before, after, from_ancestor))
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
        let bytes = read.map_err(|problem| format!("git cannot read `{}`: {problem}", path.display()))?;
        bytes.map(Some).ok_or_else(|| format!("git has no contents of `{}`: fetch them first", path.display()))
    }
}

/// Reads many objects by one process of git, which is started again where it ended.
struct Reader {
    top: PathBuf,
    process: Option<Process>,
    /// Set once a process ended by itself, as it does where it cannot fetch an object: its successors fetch nothing.
    has_failed: bool,
}

impl Reader {
    /// None for an object that this clone does not hold.
    fn read(&mut self, id: &str) -> Result<Option<Vec<u8>>, String> {
        loop {
            let mut process = match self.process.take() {
                Some(process) => process,
                None => Process::start(&self.top, !self.has_failed)?,
            };
            match process.read(id) {
                Ok(found) => {
                    self.process = Some(process);
                    return Ok(found);
                }
                Err(error) if process.may_fetch => {
                    self.has_failed = true;
                    drop((process, error));
                }
                // Its own words say more than that it ended.
                Err(error) => {
                    return ask(&self.top, &["cat-file", "blob", id])
                        .map(Some)
                        .map_err(|problem| if problem == git::NO_REASON { error.to_string() } else { problem });
                }
            }
        }
    }
}

/// One `git cat-file --batch`.
struct Process {
    child: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
    may_fetch: bool,
}

impl Process {
    fn start(top: &Path, may_fetch: bool) -> Result<Self, String> {
        let mut command = if may_fetch { git::fetching(top) } else { git::command(top) };
        command.args(["cat-file", "--batch"]).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        let cannot = |problem: &dyn std::fmt::Display| format!("`git cat-file` cannot be started: {problem}");
        let mut child = command.spawn().map_err(|error| cannot(&error))?;
        let output = child.stdout.take().ok_or_else(|| cannot(&"it has no output"))?;
        Ok(Self { input: child.stdin.take(), output: BufReader::new(output), child, may_fetch })
    }

    /// None for an object that this clone does not hold.
    fn read(&mut self, id: &str) -> std::io::Result<Option<Vec<u8>>> {
        if let Some(input) = &mut self.input {
            writeln!(input, "{id}")?;
            input.flush()?;
        }
        let mut head = String::new();
        if self.output.read_line(&mut head)? == 0 {
            return Err(std::io::Error::new(std::io::ErrorKind::UnexpectedEof, "`git cat-file` has ended"));
        }
        let Some(size) = head.trim_end().split(' ').nth(2).and_then(|size| size.parse::<usize>().ok()) else {
            return Ok(None);
        };
        let mut bytes = vec![0; size + 1];
        self.output.read_exact(&mut bytes)?;
        bytes.truncate(size);
        Ok(Some(bytes))
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // Its input at an end, git ends.
        self.input = None;
        let _ = self.child.wait();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_is_no_path() {
        assert_eq!(ends("main..HEAD"), Some(("main", "HEAD", false)));
        assert_eq!(ends("v1.0...HEAD~1"), Some(("v1.0", "HEAD~1", true)));
        assert_eq!((ends("main.."), ends("...main")), (Some(("main", "", false)), Some(("", "main", true))));
        for path in ["..", "...", "../old", "a/..", "a/../b", "main", "v0.1.0", "./results"] {
            assert_eq!(ends(path), None, "{path}");
        }
    }
}
