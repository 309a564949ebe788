//! What a program knows of itself: citation, licence, and what it was built from.
//!
//! Must not know: studies, results.

/// What a program knows of itself. All of it is put in when the program is built, so an installed one has it.
#[derive(Clone, Copy, Debug)]
pub struct About {
    pub version: &'static str,
    /// One sentence.
    pub summary: &'static str,
    /// SPDX expression.
    pub license: &'static str,
    /// Its citation file, in the Citation File Format.
    pub citation: &'static str,
    /// Digest of all sources.
    pub code: &'static str,
    /// The commit of the sources, and whether they differed from it; none where it was built outside a repository.
    pub commit: Option<(&'static str, bool)>,
    /// The compiler and its version.
    pub rustc: &'static str,
    /// `debug` or `release`.
    pub profile: &'static str,
    /// BLAKE3 of `Cargo.lock`, which fixes every dependency; empty when it was built without one.
    pub dependencies: &'static str,
}

impl About {
    /// The value of a line `key: "value"` of the citation file, also as an item of a list.
    #[must_use]
    pub fn cited(&self, key: &str) -> Option<&'static str> {
        let value = |line: &'static str| line.trim_start_matches([' ', '-']).strip_prefix(key)?.strip_prefix(':');
        self.citation.lines().find_map(value).map(|value| value.trim().trim_matches('"'))
    }
}

#[cfg(test)]
pub(crate) const ABOUT: About = About {
    version: "0.1.0",
    summary: "A program of tests.",
    license: "MIT",
    citation: "authors:\n  - name: \"Somebody\"\n",
    code: "0123456789abcdef0123456789abcdef",
    commit: Some(("built", false)),
    rustc: "rustc 1.0.0",
    profile: "debug",
    dependencies: "",
};
