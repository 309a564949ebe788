//! Paths of fields, and what is set by them: where each leads, what is left out, every message.

use std::path::Path;

use super::{PROGRAM, VALID, changed, load};
use crate::study::document::{Content, KeyValue, parse};
use crate::study::path::FieldPath;
use crate::study::{Settings, Study, changes};
use declare::error::Place;
use declare::record::{Record, Value};

fn stages(text: &str) -> Vec<KeyValue> {
    let Content::Mapping(pairs) = parse(text).unwrap().unwrap().content else { panic!() };
    let Content::Mapping(stages) = pairs.into_iter().find(|pair| pair.key == "stages").unwrap().node.content else {
        panic!()
    };
    stages
}

fn at(text: &str) -> Place {
    Place { line: 3, column: 5, offset: 40, length: text.len() }
}

/// Line and column of a value, and the declared field.
fn leads(path: &str) -> (usize, usize, &'static str) {
    let target = FieldPath::parse(path, at(path)).unwrap().find(&stages(VALID), PROGRAM.kinds).unwrap();
    (target.place.line, target.place.column, target.field.name)
}

fn with(text: &str, set: &[&str], name: Option<&str>) -> Result<Study, String> {
    let settings = Settings { set: set.iter().map(|one| (*one).to_owned()).collect(), name: name.map(str::to_owned) };
    changes::examine(text, Path::new("t.yaml"), &PROGRAM, &settings).map_err(|refused| refused.error().to_string())
}

fn set(path: &str) -> Study {
    with(VALID, &[path], None).unwrap_or_else(|error| panic!("{error}"))
}

fn record<'a>(study: &'a Study, stage: &str) -> &'a Record {
    &study.nodes.iter().find(|node| node.name == stage).unwrap().record
}

#[test]
fn every_written_value_is_found_where_it_stands() {
    for (path, expected) in [
        ("pair.module", (8, 13, "module")),
        ("pair.rack.addendum", (9, 23, "addendum")),
        ("pair.pinion.face_width", (10, 38, "face_width")),
        ("designs.designs.relieved[0].tip_relief.amount", (18, 33, "amount")),
        ("designs.designs.relieved[1]", (19, 11, "designs")),
        ("designs.designs.single[0].tip_relief.amount", (20, 39, "amount")),
        ("optimum.design[0].tip_relief.amount[1]", (25, 38, "amount")),
        ("ste.torque", (30, 13, "torque")),
        ("ste.torque.count", (30, 49, "torque")),
        ("ste.designs[1]", (29, 24, "designs")),
        // Left out: the value around it.
        ("pair.pressure_angle", (7, 5, "pressure_angle")),
        ("pair.rack.shift", (9, 11, "shift")),
    ] {
        assert_eq!(leads(path), expected, "{path}");
    }
}

#[test]
fn a_wrong_step_says_the_nearest_name_and_its_own_place() {
    for (path, column, expected) in [
        ("", 5, "a path is missing"),
        ("pair..module", 9, "a name is missing in `pair..module`"),
        (".pair", 5, "a name is missing in `.pair`"),
        ("[0].pair", 5, "a name is missing in `[0].pair`"),
        ("pair module", 9, "` ` cannot stand in a path"),
        ("ste.designs[x]", 16, "`[x]` is not an item of a list, such as `[0]` for the first"),
        ("ste.designs[-1]", 16, "`[-1]` is not an item of a list, such as `[0]` for the first"),
        ("ste.designs[1", 16, "`[1` is not an item of a list, such as `[0]` for the first"),
        ("ste.designs[1]x", 19, "`.` or `[` is expected before `x`"),
        ("pear.module", 5, "there is no stage `pear`; did you mean `pair`?"),
        ("pair", 5, "`pair` is a stage; name one of its fields"),
        ("pair.modul", 10, "unknown field `modul` of `pair`; did you mean `module`?"),
        ("pair.kind", 10, "unknown field `kind` of `pair`; known here: `module`"),
        ("pair.pinion.fac_width", 17, "unknown field `fac_width` of `pinion`; did you mean `face_width`?"),
        ("pair.module.amount", 17, "`module` is a value; nothing is below it"),
        ("pair[0]", 9, "`pair` has fields, not items"),
        ("designs.designs.releived[0]", 21, "there is no `releived` in `designs`; did you mean `relieved`?"),
        ("designs.designs[0]", 20, "`designs` has labels, not items"),
        ("designs.designs.plain[0]", 26, "`plain` is an empty list; there is no `[0]`"),
        ("designs.designs.relieved[2]", 29, "`relieved` is a list of 2 items, `[0]` to `[1]`; there is no `[2]`"),
        ("designs.designs.single[1]", 27, "`single` is a list of one item, `[0]`; there is no `[1]`"),
        (
            "designs.designs.relieved.tip_relief",
            30,
            "`relieved` is a list of 2 items, `[0]` to `[1]`; `tip_relief` is none of them",
        ),
        (
            "designs.designs.relieved[0].tip_releif",
            33,
            "unknown name `tip_releif` in `relieved[0]`; did you mean `tip_relief`?",
        ),
        (
            "designs.designs.relieved[0].tip_relief",
            33,
            "`tip_relief` has fields of its own; name one of them; its fields are `amount` or `length`",
        ),
        (
            "designs.designs.relieved[0].lead_crowning.amount",
            33,
            "`relieved[0]` is `tip_relief` here, not `lead_crowning`; replace it as a whole: `{ lead_crowning: { … } }` is the value of `relieved[0]`",
        ),
        ("ste.torque.cuont", 16, "there is no `cuont` in `torque`; did you mean `count`?"),
    ] {
        let wrong = FieldPath::parse(path, at(path))
            .and_then(|path| path.find(&stages(VALID), PROGRAM.kinds).map(drop))
            .unwrap_err();
        let place = wrong.place.unwrap();
        assert!(wrong.to_string().starts_with(expected), "{path}: {wrong}");
        assert_eq!((place.line, place.column, place.offset), (3, column, column + 35), "{path}");
    }
}

#[test]
fn a_label_may_have_dots_and_a_member_no_fields() {
    let text = changed("single:", "\"v1.5.b\":");
    let path = FieldPath::parse("designs.designs.v1.5.b[0].tip_relief.length", at("")).unwrap();
    assert_eq!(path.find(&stages(&text), PROGRAM.kinds).unwrap().field.name, "length");
    let study = with(&text, &["designs.designs.v1.5.b[0].tip_relief.length=2 mm"], None).unwrap();
    let Value::List(items) = &record(&study, "designs").map("designs")[2].1.value else { panic!() };
    let Value::Member("tip_relief", relief) = &items[0].value else { panic!() };
    assert_eq!(relief.quantity("length").to_bits(), 0.002_f64.to_bits());
    // A default that is a bare name gets fields of its own.
    let study = set("optimum.method={ tip_relief: { amount: 3 um } }");
    assert_eq!(record(&study, "optimum").member("method").0, "tip_relief");
}

/// The tables that a study gives follow from its records, and those must be as if the text said it.
#[test]
fn what_is_set_is_as_if_it_had_been_written_there() {
    for (setting, old, new) in [
        ("pair.module=4 mm", "module: 3 mm", "module: 4 mm"),
        ("pair.pinion.teeth=23", "teeth: 19", "teeth: 23"),
        ("pair.pinion={ teeth: 23, face_width: 20 mm }", "teeth: 19", "teeth: 23"),
        ("pair.rack.shift=0.5", "addendum: 1.25 }", "addendum: 1.25, shift: 0.5 }"),
        ("pair.pressure_angle=25 deg", "overlap:", "pressure_angle: 25 deg\n    overlap:"),
        ("ste.torque=[1 N m, 2 N m]", "{ from: 25 N m, to: 100 N m, count: 16 }", "[1 N m, 2 N m]"),
        ("ste.torque.count=5", "count: 16", "count: 5"),
        (
            "designs.designs.relieved[1]={ lead_crowning: { amount: 2 um } }",
            "- nothing",
            "- lead_crowning: { amount: 2 um }",
        ),
        ("designs.designs.single[0].tip_relief.amount=9 um", "1 µm", "9 um"),
        ("report.cells[0]=ste.summary.peak_to_peak", "report:", "report:"),
        ("seed=11", "seed: 7", "seed: 11"),
        ("title=\"A: b\"", "title: A small study of 5 µm", "title: \"A: b\""),
    ] {
        let (set, written) = (set(setting), load(&changed(old, new)).unwrap());
        assert_eq!((set.seed, &set.title), (written.seed, &written.title), "{setting}");
        let canonical = |study: &Study| {
            let mut writer = declare::digest::Writer::new("test");
            study.nodes.iter().for_each(|node| node.record.write(&mut writer));
            writer.finish()
        };
        assert_eq!(canonical(&set), canonical(&written), "{setting}");
        // The text by itself is the same study, names and all.
        let again = load(&set.text).unwrap();
        assert_eq!((canonical(&again), &again.name), (canonical(&set), &set.name), "{setting}\n{}", set.text);
        assert!(set.text.starts_with(VALID), "what the file says stays as it is");
    }
}

#[test]
fn other_settings_are_other_studies() {
    let name = |set: &[&str], name: Option<&str>| with(VALID, set, name).unwrap().name;
    let (a, b) = ("pair.module=4 mm", "pair.pinion.teeth=23");
    let first = name(&[a], None);
    assert!(first.starts_with("small-") && first.len() == "small-".len() + 8, "{first}");
    assert_eq!(first, name(&[a], None));
    assert_eq!(name(&[a, b], None), name(&[b, a], None), "in any order");
    assert_ne!(first, name(&["pair.module=5 mm"], None));
    assert_ne!(first, name(&[a, b], None));
    assert_eq!(name(&[a], Some("mine")), "mine");
    assert_eq!(name(&["study=mine", a], None), "mine");
    assert_eq!(name(&[], Some("mine")), "mine");
    assert_eq!(name(&[], None), "small");
    let long = VALID.replacen("small", &"x".repeat(64), 1);
    assert_eq!(with(&long, &[a], None).unwrap().name.len(), 64);
}

#[test]
fn a_message_about_what_is_set_has_the_option_for_its_place() {
    for (set, expected) in [
        ("pair.module=4", "--set pair.module=4:1:13: `4` has no unit; a length is expected, for example `4 mm`"),
        ("pair.module=4 N", "--set pair.module=4 N:1:13: `4 N` is a force; a length (for example `3 mm`) is expected"),
        (
            "pair.modul=4 mm",
            "--set pair.modul=4 mm:1:6: unknown field `modul` of `pair`\n  help: did you mean `module`?",
        ),
        ("pear.module=4 mm", "--set pear.module=4 mm:1:1: there is no stage `pear`\n  help: did you mean `pair`?"),
        (
            "pair.module",
            "--set pair.module:1:1: a path, `=` and a value are expected\n  help: for example `pair.pinion.face_width=20 mm`",
        ),
        ("pair.module=", "--set pair.module=:1:13: `pair.module` has no value"),
        (
            "pair.rack={ addendun: 1 }",
            "--set pair.rack={ addendun: 1 }:1:13: unknown field `addendun` of `rack`\n  help: did you mean `addendum`?",
        ),
        ("pair.rack={ addendum: 1", "--set pair.rack={ addendum: 1:1:11: `{` is opened and never closed"),
        (
            "pair.module=a: b",
            "--set pair.module=a: b:1:13: this cannot be on one line\n  help: put lists between `[` and `]`, mappings between `{` and `}`",
        ),
        (
            "pair.module=3 mm\nseed: 4",
            "--set pair.module=3 mm\nseed: 4:1:13: a value is on one line\n  help: lists are `[a, b]`, mappings `{ a: b }`",
        ),
        ("seed=-1", "--set seed=-1:1:6: `seed` must be at least 0, not `-1`"),
        ("pair.note=impossible", "t.yaml:6:3: this pair is impossible"),
        ("ste.pair=nobody", "--set ste.pair=nobody:1:10: there is no stage `nobody`"),
    ] {
        let message = with(VALID, &[set], None).err().unwrap_or_else(|| panic!("{set} was taken"));
        assert!(message.starts_with(expected), "{set}\n expected {expected:?}\n but got  {message:?}");
    }
    let message = with(VALID, &["pair.module=3 mm", "pair.module=4 mm"], None).err().unwrap();
    let help = "\n  help: the first is `--set pair.module=3 mm`; keep one of them";
    assert_eq!(message, format!("--set pair.module=4 mm:1:1: `pair.module` stands here a second time{help}"));
    let message = with(VALID, &[], Some("Mine")).err().unwrap();
    assert!(message.starts_with("--name Mine:1:1: `Mine` cannot be the name of a study"), "{message}");
}

#[test]
fn a_study_may_set_its_own_paths_and_more_can_be_set_behind_them() {
    let text = format!("{VALID}set:\n    pair.module: 4 mm\n");
    let own = load(&text).unwrap();
    assert_eq!(record(&own, "pair").quantity("module").to_bits(), 0.004_f64.to_bits());
    let more = with(&text, &["pair.pinion.teeth=23"], None).unwrap();
    assert_eq!(
        (record(&more, "pair").quantity("module"), record(&more, "pair").group("pinion").integer("teeth")),
        (0.004, 23)
    );
    let twice = with(&text, &["pair.module=5 mm"], None).err().unwrap();
    assert!(twice.contains("stands here a second time"), "{twice}");
    // In any form, and anywhere.
    for text in [
        format!("set: {{ pair.module: 4 mm }}\n{VALID}"),
        format!("set:\n  pair.module: 4 mm\n{VALID}"),
        format!("{VALID}set: {{ pair.module: 4 mm }} # a comment\n"),
        format!("{VALID}set: {{ pair.module: 4 mm,\n }}\n...\n"),
    ] {
        let more = with(&text, &["pair.pinion.teeth=23"], None).unwrap();
        let again = load(&more.text).unwrap();
        for study in [&more, &again] {
            let pair = record(study, "pair");
            assert_eq!((pair.quantity("module"), pair.group("pinion").integer("teeth")), (0.004, 23), "{}", more.text);
        }
        let twice = with(&text, &["pair.module=5 mm"], None).err().unwrap();
        let line = 1 + text.lines().position(|line| line.contains("pair.module")).unwrap();
        let help = format!("the first is in line {line} of t.yaml; keep one of them");
        assert!(twice.starts_with("--set pair.module=5 mm:1:1: ") && twice.ends_with(&help), "{twice}");
    }
    let message = load(&format!("{VALID}set: 3\n")).err().unwrap().to_string();
    assert!(message.starts_with("t.yaml:36:6: `set` is `3`; a mapping from paths to values is expected"), "{message}");
    let message = load(&format!("{VALID}set:\n  pair.modul: 3 mm\n")).err().unwrap().to_string();
    assert!(message.starts_with("t.yaml:37:8: unknown field `modul` of `pair`"), "{message}");
    // All keys indented, no line break at the end, and the other line ends.
    let indented = format!("  {}\r\n", VALID.lines().collect::<Vec<_>>().join("\r\n  "));
    let study = with(indented.trim_end(), &["pair.module=4 mm"], None).unwrap();
    assert_eq!(record(&study, "pair").quantity("module").to_bits(), 0.004_f64.to_bits());
    load(&study.text).unwrap();
}

#[test]
fn anything_can_be_set_whatever_the_end_of_the_text() {
    let plain = with(VALID, &["pair.module=4 mm"], None).unwrap();
    let canonical = |study: &Study| {
        let mut writer = declare::digest::Writer::new("test");
        study.nodes.iter().for_each(|node| node.record.write(&mut writer));
        (study.name.clone(), writer.finish())
    };
    let json = serde_json::to_string(&value(&parse(VALID).unwrap().unwrap())).unwrap();
    let loose = |text: &str| with(text, &["pair.module=4 mm"], None).unwrap_or_else(|error| panic!("{error}\n{text}"));
    for text in [
        format!("{VALID}..."),
        format!("{VALID}...\n"),
        format!("{VALID}... # the end\n# and a comment\n"),
        format!("---\n{VALID}...\n"),
        format!("# before\n--- # a comment\n{VALID}\n\n# behind\n"),
        format!("\u{feff}{VALID}...\n").replace('\n', "\r\n"),
        format!("{VALID}  \t\n"),
        format!("{}\n   # a comment without an end", VALID.trim_end()),
        VALID.trim_end().to_owned(),
        VALID.replace('\n', "\r\n"),
        VALID.replacen("study: small", "? study\n: small", 1),
        VALID.replacen("study: small", "&a study: small", 1),
        json.clone(),
        format!("\u{feff}{json}"),
        format!("--- {json}\n...\n"),
        format!("{}, }} # a comment }}", json.strip_suffix('}').unwrap()),
        json.replace(',', ",\n\t"),
    ] {
        let study = loose(&text);
        assert_eq!(canonical(&study), canonical(&plain), "{text}");
        // What is stored is one document of the same study, and more can be set in that.
        let again = load(&study.text).unwrap_or_else(|error| panic!("{error}\n{}", study.text));
        assert_eq!(canonical(&again), canonical(&plain), "{text}\n{}", study.text);
        let more = with(&study.text, &["ste.factor=2"], Some("more")).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(canonical(&load(&more.text).unwrap()), canonical(&more));
        // A message has a place of the file, or the option.
        let lines = text.lines().count();
        let wrong = text.replacen("Contact", "Contract", 1).replacen("206 GPa", "206 mm", 1);
        if let Err(message) = with(&wrong, &["pair.pinion.face_width=1 mm"], None) {
            let line: usize = message.split(':').nth(1).unwrap().parse().unwrap_or_else(|_| panic!("{message}"));
            assert!(message.starts_with("t.yaml:") && line <= lines, "{message}");
        }
        let message = with(&text, &["pair.modul=4 mm"], None).err().unwrap();
        assert!(message.starts_with("--set pair.modul=4 mm:1:6: unknown field"), "{message}");
    }
}

/// A tree as JSON; what is a number or nothing there stays one.
fn value(node: &crate::study::document::Node) -> serde_json::Value {
    match &node.content {
        Content::Scalar { text, quoted: false } => serde_json::from_str(text).unwrap_or_else(|_| text.as_str().into()),
        Content::Scalar { text, .. } => text.as_str().into(),
        Content::Sequence(items) => items.iter().map(value).collect(),
        Content::Mapping(pairs) => {
            serde_json::Value::Object(pairs.iter().map(|pair| (pair.key.clone(), value(&pair.node))).collect())
        }
    }
}

#[test]
fn a_label_that_is_not_there_is_added() {
    let study = set("designs.designs.new=[tip_relief: { amount: 9 um }]");
    let labels: Vec<&str> = record(&study, "designs").map("designs").iter().map(|(name, _)| name.as_str()).collect();
    assert!(
        labels.ends_with(&["new"]) && labels.len() == 1 + record(&load(VALID).unwrap(), "designs").map("designs").len()
    );
    assert_eq!(record(&set("designs.designs.new=[]"), "designs").map("designs").len(), labels.len());
    // What it holds must fit, and nothing is below what is not there.
    for (set, expected) in [
        ("designs.designs.new=3", "--set designs.designs.new=3:1:21: "),
        (
            "designs.designs.new[0].tip_relief.amount=3 um",
            "--set designs.designs.new[0].tip_relief.amount=3 um:1:17: there is no `new`",
        ),
        ("designs.designs.bad name=[]", "--set designs.designs.bad name=[]:1:20: "),
    ] {
        let message = with(VALID, &[set], None).err().unwrap();
        assert!(message.starts_with(expected), "{message}");
    }
}
