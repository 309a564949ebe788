//! This program: its kinds of stages, and what it knows of itself since it was built.
//!
//! Must not know: what any of it is for.

use std::path::{Path, PathBuf};

use crate::stage::foreign::{DERIVED, FOREIGN};
use crate::stage::kinds::KINDS;
use crate::stage::rows::computed::{ROWS_COMPUTED, ROWS_TAKEN_OVER};
use declare::work::Counter;
use gearmesh::gear::work::COUNTERS;
use studygraph::about::About;
use studygraph::program::{Names, Naming, Pictures, Program};
use studygraph::study::{self, LoadError, Refused, Settings, Study};

/// What studies are run with.
pub static PROGRAM: Program = Program {
    kinds: KINDS,
    foreign: FOREIGN,
    derived: DERIVED,
    named: NAMED,
    code_of: code_digest,
    counters: &COUNTED,
    about: About {
        version: env!("CARGO_PKG_VERSION"),
        summary: env!("CARGO_PKG_DESCRIPTION"),
        license: env!("CARGO_PKG_LICENSE"),
        citation: include_str!("../CITATION.cff"),
        code: env!("GEARSTUDY_CODE"),
        commit: commit(),
        rustc: env!("GEARSTUDY_RUSTC"),
        profile: env!("GEARSTUDY_PROFILE"),
        dependencies: env!("GEARSTUDY_DEPENDENCIES"),
    },
    pictures: Pictures {
        reader: "report",
        tables: &[
            ("geometry", &["mesh_drawing", "outline"]),
            ("modification", &["profile"]),
            ("modification", &["lead"]),
        ],
    },
};

/// Fields that name what is in tables.
static NAMED: &[Naming] = {
    const TABLE: Names = Names::Columns { table: "table" };
    const MARKED: Names = Names::Columns { table: "marked" };
    const ROWS: Names = Names::CellsOf { stage: "of", table: Some("summary") };
    const RUNS: Names = Names::CellsOf { stage: "of", table: None };
    const CURVE: Names = Names::CellsOfKind { kind: "ste", table: Some("summary") };
    const fn of(kind: &'static str, field: &'static str, names: Names) -> Naming {
        Naming { kind, field, names }
    }
    &[
        of("report", "cell", Names::Cells),
        of("report", "against", Names::Cells),
        of("report", "with", Names::Cells),
        of("report", "let", Names::Cells),
        of("report", "table", Names::Table),
        of("report", "reference", Names::Table),
        of("report", "marked", Names::Table),
        of("report", "x", TABLE),
        of("report", "y", TABLE),
        of("report", "value", TABLE),
        of("report", "series", TABLE),
        of("report", "segments", TABLE),
        of("report", "length", TABLE),
        of("report", "where", TABLE),
        of("report", "marked_x", MARKED),
        of("report", "marked_y", MARKED),
        of("fit", "cell", Names::Cells),
        of("fit", "with", Names::Cells),
        of("sweep", "outputs", ROWS),
        of("scatter", "outputs", ROWS),
        of("accuracy", "quantities", RUNS),
        of("accuracy", "evaluations", RUNS),
        of("optimizer", "minimize", CURVE),
        of("optimizer", "subject_to", CURVE),
    ]
};

/// What the kernels count, and what stages count themselves.
static COUNTED: [&Counter; COUNTERS.len() + 2] = {
    let mut all = [&ROWS_COMPUTED; COUNTERS.len() + 2];
    let mut index = 0;
    while index < COUNTERS.len() {
        all[index] = COUNTERS[index];
        index += 1;
    }
    all[index] = &ROWS_TAKEN_OVER;
    all
};

const fn commit() -> Option<(&'static str, bool)> {
    let (commit, changed) = (env!("GEARSTUDY_COMMIT"), env!("GEARSTUDY_CHANGED"));
    // `true` or `false`.
    if commit.is_empty() { None } else { Some((commit, changed.len() == 4)) }
}

/// The files that a study names, as far as that can be told, where they would be.
#[must_use]
pub fn files(text: &str, path: &Path, settings: &Settings) -> Vec<PathBuf> {
    study::files(text, path, &PROGRAM, settings)
}

/// Reads and checks a study of this program.
///
/// # Errors
/// As [`study::load`].
pub fn load(path: &Path) -> Result<Study, LoadError> {
    study::load(path, &PROGRAM)
}

/// The same with something set from outside.
///
/// # Errors
/// As [`study::load_changed`].
pub fn load_changed(path: &Path, settings: &Settings) -> Result<Study, LoadError> {
    study::load_changed(path, &PROGRAM, settings)
}

/// The same, with what is sound of a study that is refused.
///
/// # Errors
/// As [`study::examine`].
pub fn examine(path: &Path, settings: &Settings) -> Result<Study, Refused> {
    study::examine(path, &PROGRAM, settings)
}

/// The same of a text that was read from `path`.
///
/// # Errors
/// As [`study::examine`].
pub fn examine_text(text: &str, path: &Path) -> Result<Study, Refused> {
    study::examine_text(text, path, &PROGRAM)
}

/// The same with something set from outside.
///
/// # Errors
/// As [`study::examine_changed_text`].
pub fn examine_changed_text(text: &str, path: &Path, settings: &Settings) -> Result<Study, Refused> {
    study::examine_changed_text(text, path, &PROGRAM, settings)
}

/// Checks a study of this program, whose text was read from `path`.
///
/// # Errors
/// As [`study::load`].
pub fn load_text(text: &str, path: &Path) -> Result<Study, LoadError> {
    study::load_text(text, path, &PROGRAM)
}

/// The digest of the code that the tables of a kind come from, made when the program was built.
#[must_use]
pub fn code_digest(kind: &str) -> String {
    let own = code::KIND_CODE.iter().find(|(name, _)| *name == kind).map_or("", |(_, digest)| digest);
    format!("{}{own}", code::SHARED_CODE)
}

mod code {
    include!(concat!(env!("OUT_DIR"), "/code.rs"));
}

#[cfg(test)]
mod tests {
    use super::*;
    use studygraph::study::describe;

    #[test]
    fn fields_that_name_what_is_in_tables_are_there() {
        for naming in NAMED {
            let kind = PROGRAM.kind(naming.kind).unwrap();
            assert!(describe::mentions(kind, naming.field), "{} has no `{}`", naming.kind, naming.field);
            let beside = match naming.names {
                Names::Columns { table } => table,
                Names::CellsOf { stage, .. } => stage,
                Names::CellsOfKind { kind, .. } => {
                    assert!(PROGRAM.kind(kind).is_some(), "{kind}");
                    continue;
                }
                Names::Cells | Names::Table => continue,
            };
            assert!(describe::mentions(kind, beside), "{} has no `{beside}`", naming.kind);
        }
    }

    #[test]
    fn the_citation_file_says_who_and_what() {
        let about = &PROGRAM.about;
        assert_eq!(about.cited("name"), Some("The gearstudy authors"));
        assert!(about.cited("title").is_some_and(|title| title.starts_with("gearstudy: ") && !title.contains('"')));
        assert_eq!(about.cited("version"), Some(about.version), "CITATION.cff and Cargo.toml disagree");
        assert_eq!(about.cited("nothing"), None);
        // `[MIT, Apache-2.0]` and `MIT OR Apache-2.0` are the same licences.
        let license = about.cited("license").unwrap();
        assert!(about.license.split(" OR ").all(|one| license.contains(one)), "{license}");
        assert_eq!((about.dependencies.len(), about.code.len()), (64, 32));
        assert!(about.commit.is_none_or(|(commit, _)| commit.len() >= 40));
    }
}
