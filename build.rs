//! Digests of the sources that results depend on, so that a cache key changes when the code does.
//!
//! Each stage kind's key holds the digest of the shared kernel layers and of its own file: a changed message in one
//! stage does not recompute another, a changed test nothing. The compiler's version, the commit and the digest of
//! `Cargo.lock` go into the program for the manifest.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs, io};

// The repository around the sources, whatever hook or alias builds them.
#[path = "crates/studygraph/src/git.rs"]
#[allow(dead_code)]
mod git;

/// Where everything is that the tables of any stage may depend on; beside it the files of `src/stage` that belong to no
/// single kind.
const SHARED: [&str; 5] = [
    "crates/cholesky/src",
    "crates/declare/src",
    "crates/gearmesh/src",
    "crates/studygraph/src/stage",
    "crates/studygraph/src/table",
];
/// All sources.
const ALL: [&str; 2] = ["crates", "src"];

fn main() -> io::Result<()> {
    prefer_static_hdf5()?;
    // At a fixed address, sixty thousand addresses need not be written anew at every start, which took half of it. Given up is
    // that its code lies elsewhere each time, which guards programs that others send data to; this one reads what its user has.
    let target = |name: &str| env::var(format!("CARGO_CFG_TARGET_{name}")).unwrap_or_default();
    if (&*target("OS"), &*target("ENV")) == ("linux", "gnu") {
        println!("cargo:rustc-link-arg-bins=-no-pie");
    }
    let rustc = Command::new(env::var_os("RUSTC").unwrap_or_else(|| "rustc".into())).arg("--version").output()?;
    println!("cargo:rustc-env=GEARSTUDY_RUSTC={}", String::from_utf8_lossy(&rustc.stdout).trim());
    println!("cargo:rustc-env=GEARSTUDY_PROFILE={}", env::var("PROFILE").unwrap_or_default());
    // An installed program has no Cargo.lock beside it; which versions it was built from it must know itself.
    let dependencies = fs::read("Cargo.lock").map_or_else(|_| String::new(), |lock| blake3::hash(&lock).to_string());
    println!("cargo:rustc-env=GEARSTUDY_DEPENDENCIES={dependencies}");
    println!("cargo:rerun-if-changed=Cargo.lock");
    println!("cargo:rerun-if-changed=crates");
    println!("cargo:rerun-if-changed=src");
    println!("cargo:rerun-if-changed=build.rs");
    // The whole program, whatever a result depends on: what a manifest names it by.
    let mut all = Vec::new();
    for folder in ALL {
        collect(Path::new(folder), &mut all)?;
    }
    println!("cargo:rustc-env=GEARSTUDY_CODE={}", digest(&all)?);
    let (commit, changed) = commit().unwrap_or_default();
    println!("cargo:rustc-env=GEARSTUDY_COMMIT={commit}");
    println!("cargo:rustc-env=GEARSTUDY_CHANGED={changed}");
    let mut shared = Vec::new();
    for folder in SHARED {
        collect(Path::new(folder), &mut shared)?;
    }
    let mut stages = Vec::new();
    collect(Path::new("src/stage"), &mut stages)?;
    let mut kinds: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
    for path in stages {
        match kind_of(&path) {
            Some(kind) => kinds.entry(kind).or_default().push(path),
            None => shared.push(path),
        }
    }
    shared.sort();
    let base = digest(&shared)?;
    let digests = kinds.into_iter().map(|(kind, paths)| Ok(format!("    ({kind:?}, \"{}\"),\n", digest(&paths)?)));
    let digests = digests.collect::<io::Result<Vec<_>>>()?.concat();
    let lines =
        format!("pub const SHARED_CODE: &str = \"{base}\";\npub const KIND_CODE: &[(&str, &str)] = &[\n{digests}];\n");
    fs::write(Path::new(&env::var("OUT_DIR").expect("cargo sets OUT_DIR")).join("code.rs"), lines)
}

/// The commit that the sources are of, and whether they differ from it; none outside a repository that tracks them.
///
/// A commit alone builds nothing anew: the program says what it was built from, and its sources are the same.
fn commit() -> Option<(String, bool)> {
    let git = |words: &[&str]| {
        let answer = git::ask(Path::new("."), words).ok()?;
        Some(String::from_utf8_lossy(&answer).trim().to_owned())
    };
    // The folder of a dependency may lie in the repository of somebody else.
    git(&["ls-files", "--error-unmatch", "Cargo.toml", "build.rs"])?;
    let changed = git(&["status", "--porcelain", "--", "src", "crates", "build.rs", "Cargo.toml", "Cargo.lock"])?;
    Some((git(&["rev-parse", "--verify", "HEAD"])?, !changed.is_empty()))
}

/// Debian's libhdf5 brings thirty other shared libraries along (its network driver needs curl, and that the rest), which
/// cost every start 4 ms. Where the archive lies beside the shared library it is linked instead: the network driver is
/// not used, so its object and curl stay out. Where anything is missing, nothing changes. A development build takes the
/// shared one: it makes Python's extension too, which the archive, at a fixed address, cannot be linked into.
fn prefer_static_hdf5() -> io::Result<()> {
    let given = |name: &str| env::var_os(name).is_some();
    let elsewhere =
        given("HDF5_DIR") || given("CARGO_FEATURE_HDF5_STATIC") || env::var_os("HOST") != env::var_os("TARGET");
    let is_release = env::var("PROFILE").is_ok_and(|profile| profile == "release");
    println!("cargo:rerun-if-env-changed=HDF5_DIR");
    if elsewhere || !is_release || !given("CARGO_FEATURE_HDF5") {
        return Ok(());
    }
    let Ok(triplet) = Command::new("cc").arg("-print-multiarch").output() else { return Ok(()) };
    let system = Path::new("/usr/lib").join(String::from_utf8_lossy(&triplet.stdout).trim());
    let archive = system.join("hdf5/serial/libhdf5.a");
    for file in [archive.clone(), system.join("libz.so"), system.join("libsz.so")] {
        match fs::metadata(file) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
            found => found.map(drop)?,
        }
    }
    // A folder with the archive alone, searched before the one with both.
    let folder = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR")).join("hdf5");
    fs::create_dir_all(&folder)?;
    fs::copy(&archive, folder.join("libhdf5.a"))?;
    println!("cargo:rerun-if-changed={}", archive.display());
    println!("cargo:rustc-link-search=native={}", folder.display());
    for library in ["z", "sz", "m", "dl"] {
        println!("cargo:rustc-link-arg=-l{library}");
    }
    Ok(())
}

/// The kind that `src/stage/kinds/<kind>.rs` or a file of `src/stage/kinds/<kind>/` belongs to.
fn kind_of(path: &Path) -> Option<String> {
    let first = path.strip_prefix("src/stage/kinds").ok()?.components().next()?;
    let name = Path::new(&first).file_stem()?.to_string_lossy().into_owned();
    (name != "mod").then_some(name)
}

fn collect(folder: &Path, into: &mut Vec<PathBuf>) -> io::Result<()> {
    #[allow(clippy::disallowed_methods, reason = "every error is returned")]
    let mut entries: Vec<_> = fs::read_dir(folder)?.collect::<Result<_, _>>()?;
    entries.sort_by_key(fs::DirEntry::path);
    for entry in entries {
        let path = entry.path();
        // No result depends on a test.
        if path.file_stem().is_some_and(|name| name == "tests") {
            continue;
        }
        if entry.file_type()?.is_dir() {
            collect(&path, into)?;
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            into.push(path);
        }
    }
    Ok(())
}

/// Names and contents, each behind its length.
fn digest(paths: &[PathBuf]) -> io::Result<String> {
    let mut hasher = blake3::Hasher::new_derive_key("gearstudy 1 code");
    for path in paths {
        let name = path.to_string_lossy().replace('\\', "/");
        hasher.update(&(name.len() as u64).to_le_bytes()).update(name.as_bytes());
        let text = fs::read(path)?;
        hasher.update(&(text.len() as u64).to_le_bytes()).update(&text);
    }
    Ok(hasher.finalize().to_hex()[..32].to_owned())
}
