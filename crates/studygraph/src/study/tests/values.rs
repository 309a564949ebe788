//! What a valid study means: values in SI, defaults, axes, names, order.

use super::{VALID, changed, load};
use crate::study::{Source, Study};
use declare::digest::Writer;
use declare::record::{Record, Value};

fn valid(text: &str) -> Study {
    load(text).unwrap_or_else(|error| panic!("{error}"))
}

fn record<'a>(study: &'a Study, stage: &str) -> &'a Record {
    &study.nodes.iter().find(|node| node.name == stage).unwrap().record
}

#[test]
fn a_valid_study_is_read_whole() {
    let study = valid(VALID);
    assert_eq!((study.name.as_str(), study.title.as_str(), study.seed), ("small", "A small study of 5 µm", 7));
    assert_eq!(study.source, Some(Source { paper: "nobody".into(), tables: vec![1, 2], figures: vec![3] }));
    let names: Vec<_> = study.nodes.iter().map(|node| node.name.as_str()).collect();
    assert_eq!(names, ["pair", "designs", "optimum", "ste", "report"]);

    let pair = record(&study, "pair");
    assert_eq!(pair.quantity("module").to_bits(), 0.003_f64.to_bits());
    assert_eq!(pair.quantity("pressure_angle").to_bits(), 20_f64.to_radians().to_bits());
    assert_eq!(pair.quantity("overlap").to_bits(), 0.125_f64.to_bits());
    assert_eq!(pair.group("rack").number("addendum").to_bits(), 1.25_f64.to_bits());
    assert_eq!(pair.group("rack").maybe_number("shift"), None);
    assert_eq!(pair.group("pinion").integer("teeth"), 19);
    assert_eq!((pair.flag("ground"), pair.choice("side")), (false, "right"));

    let designs = record(&study, "designs").map("designs");
    let sizes: Vec<_> = designs
        .iter()
        .map(|(name, entry)| (name.as_str(), if let Value::List(items) = &entry.value { items.len() } else { 99 }))
        .collect();
    assert_eq!(sizes, [("plain", 0), ("relieved", 2), ("single", 1)]);

    let Value::Member(name, relief) = &record(&study, "optimum").list("design")[0].value else { panic!() };
    assert_eq!(*name, "tip_relief");
    assert_eq!(relief.entry("amount").unwrap().value, Value::Range(0.0, 8e-6));
    assert_eq!(relief.entry("length").unwrap().value, Value::Quantity(0.002));
    assert_eq!(record(&study, "optimum").member("method").0, "nothing");
}

#[test]
fn places_are_where_the_words_stand() {
    let study = valid(VALID);
    let pair = record(&study, "pair");
    let at = |needle: &str| VALID.find(needle).unwrap();
    assert_eq!(study.nodes[0].place.offset, at("pair:"));
    assert_eq!(pair.place_of("module").offset, at("3 mm"));
    assert_eq!((pair.place_of("module").line, pair.place_of("module").column), (8, 13));
    // A default stands where its parent does.
    assert_eq!(pair.place_of("pressure_angle"), study.nodes[0].place);
    let relieved = record(&study, "designs").map("designs")[1].1.place;
    assert_eq!(&VALID[relieved.offset..relieved.offset + relieved.length], "-");
}

#[test]
fn spelling_order_and_comments_leave_the_digest_alone() {
    let digest = |text: &str| {
        let study = valid(text);
        let mut writer = Writer::new("test");
        for node in &study.nodes {
            node.record.write(&mut writer);
        }
        writer.finish()
    };
    let first = digest(VALID);
    for (old, new) in [
        ("module: 3 mm", "module: 3000 um # the module"),
        ("module: 3 mm\n    rack: { addendum: 1.25 }", "rack:\n      addendum: 125e-2\n    module: '0.003 m'"),
        ("overlap: 12.5 %", "overlap: 0.125"),
        ("overlap: 12.5 %", "overlap: 0.125\n    side: right\n    pressure_angle: 20 deg"),
        ("method: ", "method: "),
        ("count: 16 }", "count: 16 }\n    factor: [1]"),
    ] {
        if VALID.contains(old) {
            assert_eq!(digest(&changed(old, new)), first, "{new}");
        }
    }
    assert_eq!(digest(&VALID.replace('\n', "\r\n")), first);
    assert_eq!(digest(&format!("\u{feff}{VALID}")), first);
    assert_eq!(digest(&format!("---\n{VALID}...\n")), first);
    assert_ne!(digest(&changed("3 mm", "3.1 mm")), first);
}

#[test]
fn an_axis_is_sorted_and_its_points_have_the_bits_of_written_values() {
    let torques = |text: &str| {
        record(&valid(&changed("{ from: 25 N m, to: 100 N m, count: 16 }", text)), "ste").axis("torque").to_vec()
    };
    let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&torques("50 N m")), bits(&[50.0]));
    assert_eq!(bits(&torques("[100 N m, 2500 N mm, 50 N m]")), bits(&[2.5, 50.0, 100.0]));
    let spaced = torques("{ from: 25 N m, to: 100 N m, count: 16 }");
    let written: Vec<f64> = (0..16).map(|at| f64::from(25 + 5 * at)).collect();
    assert_eq!(bits(&spaced), bits(&written));
    // No multiples of a binary fraction, in SI even less: the points must be those that a user would write.
    let spaced = torques("{ from: 0.1 N mm, to: 0.5 N mm, count: 3 }");
    assert_eq!(bits(&spaced), bits(&torques("[0.1 N mm, 0.3 N mm, 0.5 N mm]")));
    let spaced = torques("{ from: 5 N mm, to: 20 N mm, count: 6 }");
    assert_eq!(bits(&spaced), bits(&torques("[5 N mm, 8 N mm, 11 N mm, 14 N mm, 17 N mm, 20 N mm]")));
    let mixed = torques("{ from: 500 N mm, to: 1 N m, count: 3 }");
    assert_eq!(bits(&mixed), bits(&[0.5, 0.75, 1.0]));
}

#[test]
fn anchors_and_merges_save_repetition() {
    let text = changed("rack: { addendum: 1.25 }", "rack: &rack { addendum: 1.25 }").replace(
        "  designs:\n    kind: modification",
        "  other:\n    kind: geometry\n    module: 3 mm\n    pinion: { teeth: 20, face_width: 1 mm }\n    rack: { <<: *rack, shift: 0.5 }\n  designs:\n    kind: modification",
    );
    let study = valid(&text);
    let rack = record(&study, "other").group("rack");
    assert_eq!(rack.number("addendum").to_bits(), 1.25_f64.to_bits());
    assert_eq!(rack.number("shift").to_bits(), 0.5_f64.to_bits());
    // What the mapping says itself stands, wherever the merge is written.
    let study = valid(
        &text.replace("{ <<: *rack, shift: 0.5 }", "{ <<: [*rack, { addendum: 2, shift: 0.25 }], addendum: 1.5 }"),
    );
    let rack = record(&study, "other").group("rack");
    assert_eq!((rack.number("addendum"), rack.number("shift")), (1.5, 0.25));
    let study = valid(&changed("plain: []", "plain: &plain []\n      <<: { single: nothing, merged: nothing }"));
    let names: Vec<_> = record(&study, "designs").map("designs").iter().map(|(name, _)| name.as_str()).collect();
    // What it adds stands where it is merged.
    assert_eq!(names, ["plain", "merged", "relieved", "single"]);
}

#[test]
fn words_that_yaml_once_took_for_something_else_are_names() {
    let study = valid(&changed("plain: []", "no: []\n      1: []\n      1e3: nothing\n      'null': []"));
    let names: Vec<_> = record(&study, "designs").map("designs").iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["no", "1", "1e3", "null", "relieved", "single"]);
    assert_eq!(valid(&changed("A small study of 5 µm", "2024")).title, "2024");
}

#[test]
fn the_title_may_be_left_out_and_the_seed_may_be_large() {
    let study = valid(&changed("title: A small study of 5 µm\n", "").replace("seed: 7", "seed: 9223372036854775807"));
    assert_eq!((study.title.as_str(), study.seed), ("small", u64::MAX / 2));
}

#[test]
fn numbers_that_every_reader_takes_alike_are_read() {
    let teeth = |text: &str| record(&valid(&changed("teeth: 19", text)), "pair").group("pinion").integer("teeth");
    assert_eq!((teeth("teeth: +30"), teeth("teeth: 5")), (30, 5));
    let addendum = |text: &str| record(&valid(&changed("1.25", text)), "pair").group("rack").number("addendum");
    for (text, value) in [(".5", 0.5), ("1.", 1.0), ("+1.5", 1.5), ("15e-1", 1.5), ("0.75", 0.75)] {
        assert_eq!(addendum(text).to_bits(), f64::to_bits(value), "{text}");
    }
}
