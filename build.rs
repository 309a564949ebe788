//! Digests of the sources that results depend on, so that a cache key changes when the code does.
//!
//! Each stage kind's key holds the digest of the shared kernel layers and of its own file: a changed message in one
//! stage does not recompute another.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// Layers every stage may use.
const SHARED: [&str; 5] = ["base", "numeric", "gear", "optimize", "table"];

fn main() -> io::Result<()> {
    let source = PathBuf::from("src");
    println!("cargo:rerun-if-changed=src");
    println!("cargo:rerun-if-changed=build.rs");
    let mut shared = Vec::new();
    for layer in SHARED {
        collect(&source.join(layer), &mut shared)?;
    }
    let mut stages = Vec::new();
    collect(&source.join("stage"), &mut stages)?;
    // Files of `stage/` that are no kind of their own (codecs, the trait) are shared by all kinds.
    let (kinds, common): (Vec<_>, Vec<_>) = stages.into_iter().partition(|path| path.parent() == Some(Path::new("src/stage/kinds")));
    shared.extend(common);
    shared.sort();
    let base = digest(&shared)?;
    let mut lines = format!("pub const SHARED_CODE: &str = \"{base}\";\npub const KIND_CODE: &[(&str, &str)] = &[\n");
    for path in kinds {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if name != "mod" {
            lines += &format!("    ({name:?}, \"{}\"),\n", digest(&[path])?);
        }
    }
    lines += "];\n";
    fs::write(Path::new(&env::var("OUT_DIR").expect("cargo sets OUT_DIR")).join("code.rs"), lines)
}

fn collect(folder: &Path, into: &mut Vec<PathBuf>) -> io::Result<()> {
    let mut entries: Vec<_> = fs::read_dir(folder)?.collect::<Result<_, _>>()?;
    entries.sort_by_key(fs::DirEntry::path);
    for entry in entries {
        let path = entry.path();
        if path.is_dir() {
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
