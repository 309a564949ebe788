//! The schema that editors read, `schemas/study.schema.json`, is the one the program prints.

use std::fs;
use std::path::Path;

use crate::python;
use gearstudy::stage::kinds::KINDS;
use studygraph::study::schema::schema_text;

#[test]
fn the_schema_in_the_repository_is_up_to_date() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("schemas/study.schema.json");
    let kept = fs::read_to_string(&path).unwrap_or_default();
    let refresh = "cargo run -- schema > schemas/study.schema.json";
    assert!(kept == schema_text(KINDS), "schemas/study.schema.json is out of date; refresh it with: {refresh}");
}

/// Second method: another program reads the schema by the specification, and the studies with another YAML reader.
#[test]
fn another_validator_accepts_the_studies_and_refuses_mistakes() {
    python::run("schema.py", &[]);
}
