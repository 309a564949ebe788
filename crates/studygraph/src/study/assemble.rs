//! From the tree of a file to a study: its own keys, its stages, and each stage built by its kind.
//!
//! Must not know: any kind by name.

use std::path::Path;

use super::blame::Blame;
use super::decode::{Decoder, Reference};
use super::document::{Content, KeyValue, Node as Tree};
use super::files::{self, FILES};
use super::identity::plain_name;
use super::links::Draft;
use super::overrides::Stages;
use super::path::FieldPath;
use super::words::{alternatives, quote};
use super::{Changes, Node, Source, Study, cells, intervals, links, settings};
use crate::program::Program;
use crate::stage::Kind;
use crate::table::tolerance::Allowance;
use declare::error::{Diagnostic, Place, suggest};
use declare::parameter::{Field, Shape};
use declare::record::{Record, Value};
use declare::text;

/// Characters of a name.
pub const LONGEST_NAME: usize = 64;
/// What names of studies and stages look like, as a regular expression.
pub const NAME_PATTERN: &str = "^[a-z0-9][a-z0-9_-]{0,63}$";

static NUMBERS: Shape = Shape::Integer { minimum: 0, maximum: 9999, multiple: 1 };

static SOURCE: &[Field] = &[
    Field::new("paper", Shape::Text, "The paper, by the name under which the project keeps it.").example("mei2016"),
    Field::new("tables", Shape::List(&NUMBERS), "Numbers of the tables that are reproduced.").default("[]"),
    Field::new("figures", Shape::List(&NUMBERS), "Numbers of the figures that are reproduced.").default("[]"),
];

/// The keys of a study besides `stages`.
pub static KEYS: &[Field] = &[
    Field::new("study", Shape::Text, "The study's name: the folder of its results.").example("my-study"),
    Field::new("title", Shape::Text, "One line that says what is studied.")
        .optional()
        .example("Tip relief for a torque range"),
    Field::group("source", SOURCE, "What the study reproduces.").optional(),
    Field::integer("seed", 0, i64::MAX, "Where all random numbers start.").default("0"),
    Field::new(
        "tolerances",
        Shape::Map(&Shape::AnyQuantity),
        "By how much `gearstudy diff` lets columns differ: relative as a number, absolute with a unit.",
    )
    .optional()
    .example("0.01 um"),
];

/// The key of a study under which paths are given other values.
pub const SET: &str = "set";

/// A study of what is sound in the tree of a text, and everything that is wrong with the rest.
pub fn examine(
    root: Option<Tree>,
    text: &str,
    path: &Path,
    program: &'static Program,
) -> (Option<Study>, Vec<Diagnostic>) {
    let mut wrong = Vec::new();
    let sound = sound_tree(root, text, path, program, &mut wrong).unwrap_or_else(|found| {
        wrong.push(found);
        None
    });
    (sound, wrong)
}

fn sound_tree(
    root: Option<Tree>,
    text: &str,
    path: &Path,
    program: &'static Program,
    wrong: &mut Vec<Diagnostic>,
) -> Result<Option<Study>, Diagnostic> {
    let start = Place { line: 1, column: 1, ..Place::default() };
    let help = "a study starts with `study: NAME` and `stages:`";
    let empty = || Diagnostic::new("the file is empty").at(start).help(help);
    let root = root.filter(|root| !root.is_null()).ok_or_else(empty)?;
    let mut root = files::expanded(with_what_is_set(root, program.kinds)?, text)?;
    name_as_yaml_reads_it(&mut root)?;
    let Content::Mapping(pairs) = &root.content else {
        let message = format!("a study is a mapping that starts with `study: NAME`, not {}", root.describe());
        return Err(Diagnostic::new(message).at(root.place));
    };
    let start = pairs.first().map_or(root.place, |pair| pair.place);
    let belong = ranges_belong(program.kinds);
    let mut decoder = Decoder::new(&belong, Stages::default());
    let keys = decoder.record(&root, KEYS, &["stages", SET, FILES], "the study", start);
    wrong.append(&mut decoder.faults);
    let keys = keys.map_err(|found| wrong.push(found)).ok();
    if let Some(keys) = &keys {
        wrong.extend(check_name("study", keys.text("study"), keys.place_of("study")).err());
    }
    let stages = pairs.iter().find(|pair| pair.key == "stages").ok_or_else(|| {
        Diagnostic::new("the study has no `stages`").at(start).help("stages are written `NAME: { kind: KIND, … }`")
    })?;
    let mut blame = Blame::default();
    let drafts = drafts(stages, program, &belong, &mut blame)?;
    blame.is_misnamed = drafts.iter().any(|draft| draft.is_misnamed);
    links::check_references(&drafts, &mut blame);
    let notes = intervals::without_effect(&drafts).into_iter().collect();
    let mut built = Vec::with_capacity(drafts.len());
    for (index, Draft { name, place, kind, record, .. }) in drafts.into_iter().enumerate() {
        let stage = kind.zip(record).map(|(kind, record)| ((kind.build)(&record), kind, record));
        let stage = match stage {
            Some((Ok(stage), kind, record)) => {
                stage.wrong().iter().for_each(|found| blame.put(index, found.clone().or_at(place)));
                Ok(Node { name, place, kind, record, stage })
            }
            Some((Err(found), ..)) => {
                found.into_iter().for_each(|found| blame.put(index, found.or_at(place)));
                Err(name)
            }
            None => Err(name),
        };
        built.push(stage);
    }
    links::check_ports(&built, &mut blame);
    cells::check(&built, &mut blame);
    let is_whole = built.iter().all(Result::is_ok);
    let tolerances = keys.as_ref().map_or_else(Vec::new, |keys| tolerances(keys, wrong));
    let nodes = blame.sound(built);
    wrong.extend(blame.wrong);
    wrong.extend(links::check_tolerances(&tolerances, &nodes, is_whole));
    Ok(keys.map(|keys| Study {
        tolerances: tolerances.into_iter().map(|(allowance, _)| allowance).collect(),
        title: keys.maybe_text("title").unwrap_or(keys.text("study")).to_owned(),
        source: keys.maybe_group("source").map(source),
        seed: keys.integer("seed").unsigned_abs(),
        path: path.to_owned(),
        text: text.to_owned(),
        changes: Changes::default(),
        name: keys.text("study").to_owned(),
        nodes,
        notes,
        program,
    }))
}

/// The tree with the values that the key `set` gives in the places of those that stand there.
pub fn with_what_is_set(mut root: Tree, kinds: &[&'static Kind]) -> Result<Tree, Diagnostic> {
    let Content::Mapping(pairs) = &mut root.content else { return Ok(root) };
    let Some(position) = pairs.iter().position(|pair| pair.key == SET) else { return Ok(root) };
    let set = pairs[position].node.clone();
    let Content::Mapping(set) = set.content else {
        let message = format!("`{SET}` is {}; a mapping from paths to values is expected", set.describe());
        return Err(Diagnostic::new(message).at(set.place).help("a path is written `stage.field`"));
    };
    for KeyValue { key, place, node } in set {
        let path = FieldPath::parse(&key, place)?;
        if let Some(own) = path.only().filter(|name| KEYS.iter().any(|key| key.name == *name)) {
            match pairs.iter_mut().find(|pair| pair.key == own) {
                Some(pair) => pair.node = node,
                None => pairs.push(KeyValue { key: own.to_owned(), place, node }),
            }
        } else if let Some(pair) = pairs.iter_mut().find(|pair| pair.key == "stages")
            && let Content::Mapping(stages) = &mut pair.node.content
        {
            path.set(stages, kinds, node)?;
        }
    }
    Ok(root)
}

fn source(record: &Record) -> Source {
    let numbers = |name: &str| {
        let entries = record.list(name).iter();
        entries.filter_map(|entry| if let Value::Integer(number) = entry.value { Some(number) } else { None }).collect()
    };
    Source { paper: record.text("paper").to_owned(), tables: numbers("tables"), figures: numbers("figures") }
}

fn tolerances(keys: &Record, wrong: &mut Vec<Diagnostic>) -> Vec<(Allowance, Place)> {
    let mut read = Vec::new();
    for (name, entry) in keys.maybe_map("tolerances").unwrap_or_default() {
        match Allowance::new(name, &settings::any_quantity(&entry.value)) {
            Ok(allowance) => read.push((allowance, entry.place)),
            Err(problem) => wrong.push(Diagnostic::new(problem).at(entry.place)),
        }
    }
    read
}

fn drafts(
    stages: &KeyValue,
    program: &'static Program,
    belong: &str,
    blame: &mut Blame,
) -> Result<Vec<Draft>, Diagnostic> {
    let written = "stages are written `NAME: { kind: KIND, … }`";
    let pairs = match &stages.node.content {
        Content::Mapping(pairs) if !pairs.is_empty() => pairs,
        Content::Mapping(_) => {
            return Err(Diagnostic::new("a study has at least one stage").at(stages.node.place).help(written));
        }
        _ => {
            let message = format!("`stages` is {}; a mapping from names to stages is expected", stages.node.describe());
            return Err(Diagnostic::new(message).at(stages.node.place).help(written));
        }
    };
    let stages = Stages { pairs, kinds: program.kinds, foreign: program.foreign, derived: program.derived };
    let (mut drafts, mut above) = (Vec::with_capacity(pairs.len()), None);
    for (index, pair) in pairs.iter().enumerate() {
        let draft = draft(pair, stages, belong, above, |found| blame.put(index, found));
        above = draft.kind.map(|kind| (pair.key.as_str(), kind)).or(above);
        drafts.push(draft);
    }
    Ok(drafts)
}

/// The stages that can be built, of all that are written.
pub fn that_stand(pairs: &[KeyValue], program: &Program) -> Vec<Node> {
    let belong = ranges_belong(program.kinds);
    let stages = Stages { pairs, kinds: program.kinds, foreign: program.foreign, derived: program.derived };
    let built = |pair: &KeyValue| {
        let mut is_wrong = false;
        let Draft { name, place, kind, record, references, .. } =
            draft(pair, stages, &belong, None, |_| is_wrong = true);
        let (kind, record) = (kind?, record?);
        // No stage is built elsewhere before all that it refers to was found.
        let all_there = references.iter().all(|Reference { stage, place, kinds, .. }| {
            stages.any(stage, *place).is_ok_and(|(kind, _)| kinds.is_empty() || kinds.contains(&kind.name))
        });
        let stage = (!is_wrong && all_there).then(|| (kind.build)(&record).ok())??;
        Some(Node { name, place, kind, record, stage })
    };
    pairs.iter().filter_map(built).collect()
}

/// One stage, as far as it can be read; what is wrong with it goes to `blame`. `above`: the nearest one above it whose kind can be.
pub fn draft(
    pair: &KeyValue,
    stages: Stages,
    belong: &str,
    above: Option<(&str, &'static Kind)>,
    mut blame: impl FnMut(Diagnostic),
) -> Draft {
    let mut draft = Draft {
        name: pair.key.clone(),
        place: pair.place,
        is_misnamed: false,
        kind: None,
        record: None,
        references: Vec::new(),
        intervals: Vec::new(),
    };
    if let Err(found) = check_name("stage", &draft.name, draft.place) {
        draft.is_misnamed = true;
        blame(found);
    }
    match kind_of(pair, stages.kinds) {
        Err(found) => blame(above.and_then(|above| dedented(pair, above)).unwrap_or(found)),
        Ok(kind) => {
            let mut decoder = Decoder::new(belong, stages);
            let record = decoder.record(&pair.node, kind.fields, &["kind"], &quote(&draft.name), draft.place);
            decoder.faults.into_iter().for_each(&mut blame);
            draft.kind = Some(kind);
            draft.record = record.map_err(blame).ok().map(|record| intervals::with_intervals(record, kind, stages));
            draft.references = decoder.references;
            draft.intervals = decoder.intervals;
        }
    }
    draft
}

fn kind_of(pair: &KeyValue, kinds: &[&'static Kind]) -> Result<&'static Kind, Diagnostic> {
    let known = || format!("kinds are {}", alternatives(kinds.iter().map(|kind| kind.name)));
    let name = &pair.key;
    let Content::Mapping(fields) = &pair.node.content else {
        let message =
            format!("stage {} is {}; a mapping with its `kind` is expected", quote(name), pair.node.describe());
        return Err(Diagnostic::new(message).at(pair.node.place).help(known()));
    };
    let Some(KeyValue { node: wanted, .. }) = fields.iter().find(|field| field.key == "kind" && !field.node.is_null())
    else {
        return Err(Diagnostic::new(format!("stage {} has no `kind`", quote(name))).at(pair.place).help(known()));
    };
    kind_named(wanted, kinds)
}

/// That what stands as a stage is a field of the one above it.
fn dedented(pair: &KeyValue, (name, kind): (&str, &'static Kind)) -> Option<Diagnostic> {
    let field = kind.fields.iter().find(|field| field.name == pair.key)?;
    let message = format!("{} stands among the stages, and is a field of {} above it", quote(field.name), quote(name));
    Some(
        Diagnostic::new(message)
            .at(pair.place)
            .help(format!("indent it as deep as the other fields of {}", quote(name))),
    )
}

fn kind_named(node: &Tree, kinds: &[&'static Kind]) -> Result<&'static Kind, Diagnostic> {
    let found = match &node.content {
        Content::Scalar { text, .. } => kinds.iter().copied().find(|kind| kind.name == text).ok_or(text.as_str()),
        _ => Err(""),
    };
    found.map_err(|text| {
        let help = suggest(text, kinds.iter().map(|kind| kind.name));
        Diagnostic::new(format!("unknown kind of stage: {}", node.describe())).at(node.place).help(help)
    })
}

/// Replaces the name of the study by the one that it is to readers of YAML, as the schema has it.
fn name_as_yaml_reads_it(root: &mut Tree) -> Result<(), Diagnostic> {
    let Content::Mapping(pairs) = &mut root.content else { return Ok(()) };
    let Some(pair) = pairs.iter_mut().find(|pair| pair.key == "study" && !pair.node.is_null()) else { return Ok(()) };
    let Content::Scalar { text, quoted: false } = &mut pair.node.content else { return Ok(()) };
    let Some(name) = plain_name(text) else {
        let message = format!("{} is a number to readers of YAML, and no name of a study", quote(text));
        let help =
            "a number that is a name is whole, not negative and has 64 digits at most; in quotes any name is text";
        return Err(Diagnostic::new(message).at(pair.node.place).help(help));
    };
    *text = name;
    Ok(())
}

/// Lower-case letters, digits, `-` and `_`, beginning with a letter or digit: names become files and words of commands.
/// Those of Windows' devices can be neither there, and a study is to run everywhere.
fn check_name(what: &str, name: &str, place: Place) -> Result<(), Diagnostic> {
    let allowed = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-' || c == '_';
    let message = format!("{} cannot be the name of a {what}", quote(name));
    if text::is_device(name) {
        let better = name.split('.').next().unwrap_or(name).to_ascii_lowercase();
        let help =
            format!("Windows keeps it for a device, so no file there can have it: for example `{better}-{what}`");
        return Err(Diagnostic::new(message).at(place).help(help));
    }
    if name.starts_with(|c: char| c.is_ascii_alphanumeric()) && name.chars().all(allowed) && name.len() <= LONGEST_NAME
    {
        return Ok(());
    }
    let rule = format!("lower-case letters, digits, `-` and `_` make a name, at most {LONGEST_NAME} of them");
    let better: String =
        name.to_lowercase().chars().map(|c| if allowed(c) { c } else { '-' }).take(LONGEST_NAME).collect();
    let better = better.trim_matches(['-', '_']);
    let help = if better.is_empty() { rule } else { format!("{rule}: for example `{better}`") };
    Err(Diagnostic::new(message).at(place).help(help))
}

/// Which fields take ranges, in words.
pub fn ranges_belong(kinds: &[&'static Kind]) -> String {
    let fields = kinds
        .iter()
        .flat_map(|kind| kind.fields.iter().filter(|field| field.chooses).map(|field| (field.name, kind.name)));
    let places: Vec<_> = fields.map(|(field, kind)| format!("in `{field}` of a stage of kind `{kind}`")).collect();
    if places.is_empty() { "where an optimiser chooses".to_owned() } else { places.join(" or ") }
}
