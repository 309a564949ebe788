//! The description of an archive: a Workflow Run RO-Crate, in JSON-LD.
//!
//! Profiles: Process, Workflow and Provenance Run Crate 0.6 (<https://w3id.org/ro/wfrun/provenance/0.6>), which stand on
//! RO-Crate 1.3, and Workflow RO-Crate 1.1. The study is the workflow, a kind of stage a tool, a stage a step; one action
//! per stage, however many chunks or rows it has. Left out because the profiles leave it open and the study says it
//! itself: formal parameters, connections; when a single stage ended is not known. Must not know: the graph.

mod rights;

use std::collections::BTreeSet;

use serde_json::{Map, Value, json};

use self::rights::{address, authors, license, license_text, licenses, paper, rights};
use super::pack::Entries;
use super::{CITATION, METADATA, SCHEMA, results, sha256, study};
use crate::about::About;
use crate::store::index::INDEX;
use crate::store::manifest::{Manifest, StageRecord};
use crate::store::results::{MANIFEST, PAGE};

const CRATE: &str = "https://w3id.org/ro/crate/1.3";
const TERMS: &str = "https://w3id.org/ro/terms/workflow-run";
const PROFILES: [(&str, &str, &str); 4] = [
    ("https://w3id.org/ro/wfrun/process/0.6", "Process Run Crate", "0.6"),
    ("https://w3id.org/ro/wfrun/workflow/0.6", "Workflow Run Crate", "0.6"),
    ("https://w3id.org/ro/wfrun/provenance/0.6", "Provenance Run Crate", "0.6"),
    ("https://w3id.org/workflowhub/workflow-ro-crate/1.1", "Workflow RO-Crate", "1.1"),
];
/// The program, the language of its studies, the run, its command.
const PROGRAM: &str = "#gearstudy";
const LANGUAGE: &str = "#gearstudy-study";
const RUN: &str = "#run";
const ENGINE_RUN: &str = "#engine-run";
/// The state of a stage that has ended well, by schema.org.
const COMPLETED: &str = "http://schema.org/CompletedActionStatus";

/// What the manifest does not say.
pub struct Description<'a> {
    pub manifest: &'a Manifest,
    /// Every file but the description itself.
    pub entries: &'a Entries,
    /// Every stage after all it reads.
    pub steps: &'a [Step],
    /// SPDX expression of the licence of study and results.
    pub license: Option<&'a str>,
    pub authors: &'a [Author],
    /// The program that makes the archive.
    pub about: &'a About,
}

/// A stage, and what it read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Step {
    pub stage: String,
    /// What its kind does, in a sentence.
    pub summary: String,
    /// `stage.table`.
    pub reads: Vec<String>,
}

/// Somebody who made the study.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Author {
    pub name: String,
    pub orcid: Option<String>,
}

/// The text of the description.
///
/// # Errors
/// None that is known; JSON of words cannot fail.
pub fn metadata(description: &Description<'_>) -> Result<Vec<u8>, String> {
    let mut graph = vec![
        json!({
            "@id": METADATA, "@type": "CreativeWork", "about": reference("./"), "conformsTo": reference(CRATE),
        }),
        root(description),
    ];
    for (id, name, version) in PROFILES {
        graph.push(json!({ "@id": id, "@type": ["CreativeWork", "Profile"], "name": name, "version": version }));
    }
    graph.extend(rights(description));
    graph.push(workflow(description));
    graph.extend(programs(description.manifest, description.about));
    graph.extend(tools_and_steps(description));
    graph.extend(actions(description));
    graph.extend(files(description));
    let crated = json!({ "@context": [format!("{CRATE}/context"), format!("{TERMS}/context")], "@graph": graph });
    let mut text = serde_json::to_vec_pretty(&crated).map_err(|error| error.to_string())?;
    text.push(b'\n');
    Ok(text)
}

fn reference(id: &str) -> Value {
    json!({ "@id": id })
}

/// Several references; one by itself is not a list, as RO-Crate recommends.
fn references<I: AsRef<str>>(ids: impl IntoIterator<Item = I>) -> Value {
    let mut all: Vec<Value> = ids.into_iter().map(|id| reference(id.as_ref())).collect();
    match all.len() {
        1 => all.remove(0),
        _ => Value::Array(all),
    }
}

/// The data set as a whole.
fn root(description: &Description<'_>) -> Value {
    let manifest = description.manifest;
    let mut root = json!({
        "@id": "./",
        "@type": "Dataset",
        "name": manifest.title,
        "description": format!(
            "The study `{}` of spur-gear tooth modifications and what came of it, by gearstudy {}. \
             `gearstudy verify` computes it again and compares every table.",
            manifest.study, manifest.program.version
        ),
        // Of the run: the same results give the same archive, whenever it is made.
        "datePublished": manifest.written,
        "conformsTo": references(PROFILES.map(|(id, ..)| id)),
        "license": reference(&license(description)),
        "hasPart": references(description.entries.keys()),
        "mainEntity": reference(&study(&manifest.study)),
        "mentions": references([ENGINE_RUN.to_owned(), RUN.to_owned()].into_iter().chain(manifest.stages.iter().map(run))),
        "isBasedOn": references([PROGRAM.to_owned()].into_iter().chain(manifest.source.as_ref().map(paper))),
    });
    if !description.authors.is_empty() {
        root["author"] = references(authors(description).map(|(id, _)| id));
    }
    if let Some(source) = &manifest.source {
        // A citation is an absolute URI; the words for a paper need not contain one.
        if let Some(address) = address(&source.paper) {
            root["citation"] = reference(&address);
        }
    }
    root
}

fn workflow(description: &Description<'_>) -> Value {
    let manifest = description.manifest;
    let file = study(&manifest.study);
    let kinds: BTreeSet<&str> = manifest.stages.iter().map(|stage| stage.kind.as_str()).collect();
    json!({
        "@id": file,
        "@type": ["File", "SoftwareSourceCode", "ComputationalWorkflow", "HowTo"],
        "name": manifest.title,
        "alternateName": manifest.study,
        "description": "The study: its stages and the values of their fields.",
        "encodingFormat": "application/yaml",
        "contentSize": size(description.entries, &file),
        "sha256": digest(description.entries, &file),
        "identifier": format!("blake3:{}", manifest.study_digest),
        "programmingLanguage": reference(LANGUAGE),
        "hasPart": references(kinds.into_iter().map(tool)),
        "step": references(manifest.stages.iter().map(step)),
    })
}

/// The program, its language, its licences, and what it was built from.
fn programs(manifest: &Manifest, about: &About) -> Vec<Value> {
    let program = &manifest.program;
    // Without a page of its own, the program is described by a file in the archive.
    let page = about.cited("url").or(about.cited("repository-code")).unwrap_or(CITATION);
    let mut entities = vec![
        json!({
            "@id": PROGRAM, "@type": "SoftwareApplication", "name": "gearstudy", "url": reference(page),
            "version": program.version, "softwareVersion": program.version,
            "description": about.summary,
            "license": references(licenses(about.license).map(license_text)),
            "author": reference("#gearstudy-authors"),
            "citation": reference(CITATION),
            "softwareRequirements": references(["#rustc", "#dependencies"]),
        }),
        json!({
            "@id": "#gearstudy-authors", "@type": "Organization",
            "name": about.cited("name").unwrap_or("The gearstudy authors"),
        }),
        json!({
            "@id": LANGUAGE, "@type": "ComputerLanguage", "name": "gearstudy study", "url": reference(SCHEMA),
            "description": format!("YAML by the schema in `{SCHEMA}`."), "version": program.version,
        }),
        json!({
            "@id": "#rustc", "@type": "SoftwareApplication", "name": "rustc", "url": reference("https://www.rust-lang.org/"),
            "version": program.rustc, "softwareVersion": program.rustc,
            "description": format!("The compiler; profile {}.", program.profile),
        }),
        json!({
            "@id": "#dependencies", "@type": "CreativeWork", "name": "Cargo.lock",
            "description": "The exact versions of every dependency; the identifier is the digest of the file.",
            "identifier": match program.dependencies.as_str() {
                "" => "unknown".to_owned(),
                digest => format!("blake3:{digest}"),
            },
        }),
    ];
    if page != CITATION {
        entities.push(json!({ "@id": page, "@type": "WebPage", "name": "gearstudy" }));
    }
    entities.push(json!({ "@id": "https://www.rust-lang.org/", "@type": "WebPage", "name": "Rust" }));
    entities
}

fn tool(kind: &str) -> String {
    format!("#kind-{kind}")
}

fn step(stage: &StageRecord) -> String {
    format!("#step-{}", stage.name)
}

fn run(stage: &StageRecord) -> String {
    format!("#run-{}", stage.name)
}

fn control(stage: &StageRecord) -> String {
    format!("#control-{}", stage.name)
}

fn tools_and_steps(description: &Description<'_>) -> Vec<Value> {
    let manifest = description.manifest;
    let mut entities = Vec::new();
    let mut seen = BTreeSet::new();
    for (position, stage) in manifest.stages.iter().enumerate() {
        let summary = description.steps.iter().find(|step| step.stage == stage.name).map(|step| step.summary.as_str());
        if seen.insert(&stage.kind) {
            let version = format!("{}+{}", manifest.program.version, stage.version);
            entities.push(json!({
                "@id": tool(&stage.kind), "@type": "SoftwareApplication", "name": format!("gearstudy {}", stage.kind),
                "description": summary, "url": reference(SCHEMA), "version": version, "softwareVersion": version,
                "isPartOf": reference(PROGRAM),
            }));
        }
        entities.push(json!({
            "@id": step(stage), "@type": "HowToStep", "name": stage.name, "position": position.to_string(),
            "workExample": reference(&tool(&stage.kind)),
        }));
    }
    entities
}

/// What was done: the run, each stage, and the program that led them.
fn actions(description: &Description<'_>) -> Vec<Value> {
    let manifest = description.manifest;
    let folder = results(&manifest.study);
    let file = |name: &str| {
        let table = manifest.stages.iter().flat_map(|stage| &stage.tables).find(|table| table.name == name)?;
        Some(format!("{folder}{}", table.file))
    };
    let made = description.entries.keys().filter(|name| name.starts_with(&folder));
    let agents: Vec<String> = authors(description).map(|(id, _)| id).collect();
    let by = |mut action: Value| {
        if let (Some(first), Some(action)) = (agents.first(), action.as_object_mut()) {
            action.insert("agent".to_owned(), reference(first));
        }
        action
    };
    let program = &manifest.program;
    let mut facts = vec![
        ("system", manifest.machine.system.clone()),
        ("processor", manifest.machine.processor.clone()),
        ("cores", manifest.machine.cores.to_string()),
        ("threads", manifest.machine.threads.to_string()),
    ];
    let folder_of_study = &manifest.study_folder;
    facts.extend((!program.code.is_empty()).then(|| ("program code", program.code.clone())));
    facts.extend(program.commit.clone().map(|commit| ("program commit", commit)));
    let changes = |changes: Option<bool>| changes.map(|changes| changes.to_string());
    facts.extend(changes(program.uncommitted_changes).map(|changes| ("program uncommitted changes", changes)));
    facts.extend(folder_of_study.commit.clone().map(|commit| ("study commit", commit)));
    facts.extend(changes(folder_of_study.uncommitted_changes).map(|changes| ("study uncommitted changes", changes)));
    let fact = |name: &str| format!("#fact-{}", name.replace(' ', "-"));
    let mut entities = vec![
        by(json!({
            "@id": ENGINE_RUN, "@type": "OrganizeAction", "name": format!("Run of gearstudy {}", program.version),
            "instrument": reference(PROGRAM), "object": references(manifest.stages.iter().map(control)),
            "result": reference(RUN), "endTime": manifest.written,
            "additionalProperty": references(facts.iter().map(|(name, _)| fact(name))),
        })),
        by(json!({
            "@id": RUN, "@type": "CreateAction", "name": format!("Run of the study {}", manifest.study),
            "description": format!("gearstudy run {}", study(&manifest.study)),
            "instrument": reference(&study(&manifest.study)), "endTime": manifest.written,
            "actionStatus": reference(COMPLETED),
            "result": references(made),
        })),
        json!({ "@id": COMPLETED, "@type": "ActionStatusType", "name": "Completed" }),
    ];
    entities.extend(
        facts
            .iter()
            .map(|(name, value)| json!({ "@id": fact(name), "@type": "PropertyValue", "name": name, "value": value })),
    );
    for stage in &manifest.stages {
        let seconds = format!("{}-seconds", run(stage));
        let reads = description.steps.iter().filter(|step| step.stage == stage.name).flat_map(|step| &step.reads);
        let read: Vec<String> =
            [study(&manifest.study)].into_iter().chain(reads.filter_map(|name| file(name))).collect();
        entities.push(by(json!({
            "@id": run(stage), "@type": "CreateAction", "name": format!("Run of the stage {}", stage.name),
            "description": format!(
                "Kind {}, version {}; keys {}.", stage.kind, stage.version,
                stage.keys.iter().map(|key| key.key.to_string()).collect::<Vec<_>>().join(", ")
            ),
            "instrument": reference(&tool(&stage.kind)),
            "actionStatus": reference(COMPLETED),
            "object": references(read),
            "result": references(stage.tables.iter().flat_map(|table| {
                [&table.file].into_iter().chain(&table.files).map(|file| format!("{folder}{file}"))
            })),
            "resourceUsage": references([&seconds]),
        })));
        entities.push(json!({
            "@id": seconds, "@type": "PropertyValue", "name": "seconds of computing",
            "propertyID": "https://schema.org/duration", "unitCode": "https://qudt.org/vocab/unit/SEC",
            "value": stage.seconds.to_string(),
        }));
        entities.push(json!({
            "@id": control(stage), "@type": "ControlAction", "name": format!("Orchestrate {}", stage.name),
            "instrument": reference(&step(stage)), "object": reference(&run(stage)),
        }));
    }
    entities
}

fn size(entries: &Entries, name: &str) -> String {
    entries.get(name).map_or(0, Vec::len).to_string()
}

fn digest(entries: &Entries, name: &str) -> String {
    sha256(entries.get(name).map_or(&[], Vec::as_slice))
}

/// Every file but the study, which is the workflow.
fn files(description: &Description<'_>) -> Vec<Value> {
    let manifest = description.manifest;
    let folder = results(&manifest.study);
    let others = description.entries.keys().filter(|name| **name != study(&manifest.study));
    let described = others.map(|name| {
        let inside = name.strip_prefix(&folder).unwrap_or(name);
        let table = manifest.stages.iter().flat_map(|stage| &stage.tables).find(|table| table.file == inside);
        let holder = manifest
            .stages
            .iter()
            .flat_map(|stage| &stage.tables)
            .find(|table| table.files.iter().any(|file| file == inside));
        let mut entity = Map::new();
        let mut put = |key: &str, value: Value| drop(entity.insert(key.to_owned(), value));
        put("@id", json!(name));
        put("@type", json!("File"));
        put("name", json!(table.map_or(inside, |table| &table.name)));
        let what = match inside {
            MANIFEST => "What was run, from what, where, and what came of it.",
            SCHEMA => "The schema of the study.",
            CITATION => "How to cite gearstudy.",
            INDEX => "Size and digest of every file of the results.",
            PAGE => "The report: figures, tables, and a verdict on every number that was compared.",
            _ => match table.or(holder) {
                Some(table) => &*table.description,
                None => match inside.rsplit_once('.') {
                    Some((_, "h5")) => "The tables of the study in one HDF5 file.",
                    Some((name, "json")) if name.rsplit('.').next() == Some("vl") => {
                        "A figure of the report, as Vega-Lite."
                    }
                    Some((_, "svg")) => "A figure of the report.",
                    _ => "A file of the results.",
                },
            },
        };
        put("description", json!(what));
        if let Some(format) = format_of(name) {
            put("encodingFormat", json!(format));
        }
        put("contentSize", json!(size(description.entries, name)));
        put("sha256", json!(digest(description.entries, name)));
        if let Some(table) = table {
            put("identifier", json!(format!("gearstudy-content:{}", table.content)));
        }
        if inside == MANIFEST || format_of(name) == Some("text/html") {
            put("about", reference(RUN));
        }
        Value::Object(entity)
    });
    described.collect()
}

fn format_of(name: &str) -> Option<&'static str> {
    let (_, ending) = name.rsplit_once('.')?;
    Some(match ending {
        "parquet" => "application/vnd.apache.parquet",
        "h5" => "application/x-hdf5",
        "json" => "application/json",
        "html" => "text/html",
        "svg" => "image/svg+xml",
        "dxf" => "image/vnd.dxf",
        "csv" => "text/csv",
        "yaml" | "cff" => "application/yaml",
        _ => return None,
    })
}
