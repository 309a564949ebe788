//! What the program knows of itself: citation, licence, and the versions it was built from.
//!
//! All of it is put in when the program is built, so an installed one has it. Must not know: studies, results.

/// The citation file of the project.
pub const CITATION: &str = include_str!("../../../CITATION.cff");
/// SPDX expression.
pub const LICENSE: &str = env!("CARGO_PKG_LICENSE");
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
pub const SUMMARY: &str = env!("CARGO_PKG_DESCRIPTION");
/// BLAKE3 of `Cargo.lock`, which fixes every dependency; empty when it was built without one.
pub const DEPENDENCIES: &str = env!("GEARSTUDY_DEPENDENCIES");
/// Digest of all sources of the program.
pub const CODE: &str = env!("GEARSTUDY_CODE");

/// The commit of the sources that the program was built from, and whether they differed from it; none where it was built
/// outside a repository.
#[must_use]
pub fn commit() -> Option<(&'static str, bool)> {
    Some((env!("GEARSTUDY_COMMIT"), env!("GEARSTUDY_CHANGED") == "true")).filter(|(commit, _)| !commit.is_empty())
}

/// The value of a line `key: "value"` of the citation file, also as an item of a list.
#[must_use]
pub fn citation(key: &str) -> Option<&'static str> {
    let value = |line: &'static str| line.trim_start_matches([' ', '-']).strip_prefix(key)?.strip_prefix(':');
    CITATION.lines().find_map(value).map(|value| value.trim().trim_matches('"'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_citation_file_says_who_and_what() {
        assert_eq!(citation("name"), Some("The gearstudy authors"));
        assert!(citation("title").is_some_and(|title| title.starts_with("gearstudy: ") && !title.contains('"')));
        assert_eq!(citation("version"), Some(VERSION), "CITATION.cff and Cargo.toml disagree");
        assert_eq!(citation("nothing"), None);
        // `[MIT, Apache-2.0]` and `MIT OR Apache-2.0` are the same licences.
        let license = citation("license").unwrap();
        assert!(LICENSE.split(" OR ").all(|one| license.contains(one)), "{license}");
        assert_eq!((DEPENDENCIES.len(), CODE.len()), (64, 32));
        assert!(commit().is_none_or(|(commit, _)| commit.len() >= 40));
    }
}
