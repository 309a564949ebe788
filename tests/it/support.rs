//! What several tests need.

use gearstudy::program::PROGRAM;
use studygraph::program::Program;
use studygraph::study::Study;

/// A study as a program with other code reads it.
pub fn with_code(study: Study, code_of: fn(&str) -> String) -> Study {
    let program = Program {
        kinds: PROGRAM.kinds,
        foreign: PROGRAM.foreign,
        derived: PROGRAM.derived,
        named: PROGRAM.named,
        code_of,
        counters: PROGRAM.counters,
        about: PROGRAM.about,
        pictures: PROGRAM.pictures,
    };
    Study { program: Box::leak(Box::new(program)), ..study }
}
