//! Digests of the sources that results depend on, so that a cache key changes when the code does.
//!
//! Each stage kind's key holds the digest of the shared kernel layers and of its own file, with the folder of the same
//! name where it has one: a changed message in one stage does not recompute another.

use std::collections::BTreeMap;
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
    let folder = Path::new("src/stage/kinds");
    let (own, common): (Vec<_>, Vec<_>) = stages.into_iter().partition(|path| path.starts_with(folder));
    shared.extend(common);
    shared.sort();
    let mut kinds: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
    for path in own {
        let first = path.strip_prefix(folder).ok().and_then(|inside| inside.components().next());
        let name = first
            .map_or_else(String::new, |first| first.as_os_str().to_string_lossy().trim_end_matches(".rs").to_owned());
        kinds.entry(name).or_default().push(path);
    }
    let base = digest(&shared)?;
    let mut lines = format!("pub const SHARED_CODE: &str = \"{base}\";\npub const KIND_CODE: &[(&str, &str)] = &[\n");
    for (name, paths) in &kinds {
        if name != "mod" {
            lines += &format!("    ({name:?}, \"{}\"),\n", digest(paths)?);
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
