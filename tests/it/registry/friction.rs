//! Every law of friction runs through the stage: its tables are finite, agree with each other, and say what the law is not for.

use std::collections::BTreeSet;

use super::is_name;
use super::walk::{Ran, load, walk};
use gearmesh::gear::friction::members;
use gearstudy::program;
use studygraph::table::data::Table;

/// Ways to write each law; three of them beyond what the law is for.
const LAWS: &[(&str, &str, &str, Option<&str>)] = &[
    ("constant", "{ coefficient: 0.06 }", "1500 rpm", None),
    ("iso_14179_2", "{ viscosity: 40 mPa s, roughness: 0.4 um }", "1500 rpm", None),
    ("iso_14179_2", "{ viscosity: 0.04 Pa s, roughness: 400 nm, lubricant_factor: 0.8 }", "157 rad/s", None),
    ("benedict_kelley", "{ viscosity: 40 mPa s }", "1500 rpm", None),
    (
        "xu",
        "{ viscosity: 10 mPa s, roughness: 0.3 um }",
        "1500 rpm",
        Some("the slide-to-roll ratio is 1.3; the law `xu` of friction is known up to 1"),
    ),
    (
        "iso_14179_2",
        "{ viscosity: 40 mPa s, roughness: 0.4 um }",
        "30000 rpm",
        Some("the sum speed v_ΣC is 87.8 m/s; the law `iso_14179_2` of friction is known up to 34.2 m/s"),
    ),
    (
        "benedict_kelley",
        "{ viscosity: 10 Pa s }",
        "6000 rpm",
        Some("; the law `benedict_kelley` of friction is known from 1"),
    ),
];

fn study(law: &str, more: &str, speed: &str) -> String {
    format!(
        "study: t\nseed: 5\nstages:
  pair:
    kind: geometry
    module: 4.5 mm
    pinion: {{ teeth: 16, face_width: 14 mm, bore_radius: 15 mm, profile_shift: 0.1817 }}
    gear: {{ teeth: 24, face_width: 14 mm, bore_radius: 20 mm, profile_shift: 0.1715 }}
  k: {{ kind: stiffness, pair: pair }}
  designs: {{ kind: modification, pair: pair, designs: {{ none: [], relieved: [tip_relief: {{ gear: both, amount: 12 um, length: 3 mm }}] }} }}
  ste: {{ kind: ste, stiffness: k, designs: designs, torque: [200 N m, 400 N m], positions: 16{more}, friction: {{ law: {law}, speed: {speed}{} }} }}
",
        if more.is_empty() { ", positions: 8" } else { "" }
    )
}

fn table<'a>(ran: &'a Ran, name: &str) -> &'a Table {
    ran.tables.iter().find(|table| table.name() == name).unwrap()
}

#[test]
fn every_law_of_friction_runs() {
    let known: BTreeSet<_> = members().iter().map(|member| member.name).collect();
    assert_eq!(
        LAWS.iter().map(|law| law.0).collect::<BTreeSet<_>>(),
        known,
        "a law without a use here, or the reverse"
    );
    for (name, fields, speed, warning) in LAWS {
        assert!(is_name(name));
        let all = ["", ", in_load_balance: true", ", corner_contact: exact", ", helix_slope: 10 um"];
        for more in &all[..if *speed == "1500 rpm" { all.len() } else { 1 }] {
            let law = format!("{{ {name}: {fields} }}");
            let (of_stage, of_friction) = if more.contains("balance") { ("", *more) } else { (*more, "") };
            let text = study(&law, of_stage, &format!("{speed}{of_friction}"));
            let ran = &walk(&load(&text))["ste"];
            let told = |warning: &str| ran.warnings.iter().any(|said| said.contains(warning));
            assert!(warning.is_none_or(told), "{name}: {:?}", ran.warnings);
            assert!(warning.is_some() || !told("of friction"), "{name}: {:?}", ran.warnings);
            agree(ran, name);
        }
    }
}

/// Summary, curve and path tell the same.
fn agree(ran: &Ran, name: &str) {
    let (summary, curve, along) = (table(ran, "summary"), table(ran, "curve"), table(ran, "friction"));
    for row in 0..summary.rows() {
        let of = |column: &str| summary.floats(column)[row];
        let (lost, torque) = (of("friction_power_loss"), of("torque"));
        assert!((of("geometric_tooth_loss_factor") - 0.1986).abs() < 5e-5);
        assert!((0.05..0.25).contains(&of("tooth_loss_factor")));
        let input = lost / of("mean_friction_coefficient") / of("tooth_loss_factor");
        if lost > 0.0 {
            assert!((of("efficiency") - (1.0 - lost / input)).abs() < 1e-12, "{name}");
            assert!((of("gear_torque") / (1.5 * torque) - of("efficiency")).abs() < 1e-12, "{name}");
        }
        let is_of = |other: &Table, at: usize| {
            other.texts("design")[at] == summary.texts("design")[row] && other.floats("torque")[at] == torque
        };
        let rows: Vec<usize> = (0..curve.rows()).filter(|at| is_of(curve, *at)).collect();
        let within = |column: &str| {
            let values = || rows.iter().map(|at| curve.floats(column)[*at]);
            [values().fold(f64::MAX, f64::min), values().fold(f64::MIN, f64::max)]
        };
        let [least, most] = within("friction_power_loss");
        assert!(least >= 0.0 && least <= lost && lost <= most, "{name}: {least} {lost} {most}");
        let [least, most] = within("gear_torque");
        assert!(least <= of("gear_torque") && of("gear_torque") <= most && most <= 1.5 * torque * (1.0 + 1e-12));
    }
    for row in 0..along.rows() {
        let of = |column: &str| along.floats(column)[row];
        let (force, sliding) = (of("friction_force"), of("sliding_speed"));
        assert!((force - of("friction_coefficient") * of("normal_force")).abs() <= 1e-12 * force);
        let power = force * sliding.abs();
        assert!((of("friction_power_loss") - power).abs() <= 1e-12 * power);
        let beyond = of("path_position") > 9.68;
        assert!((sliding > 0.0) == beyond || of("slide_to_roll_ratio") < 0.01, "{name}: {sliding}");
    }
}

/// Without it nothing of it is there.
#[test]
fn columns_of_friction_are_there_where_it_is_stated() {
    let with = study("{ constant: { coefficient: 0.06 } }", "", "1500 rpm");
    let without = with.split(", friction:").next().unwrap().to_owned() + " }\n";
    let stated = |text: &str| {
        let study = load(text);
        let node = study.nodes.iter().find(|node| node.name == "ste").unwrap();
        let schemas = node.stage.outputs();
        let columns = schemas.iter().flat_map(|schema| schema.columns.iter().map(|column| column.name.clone()));
        columns.filter(|name| name.contains("friction") || name.contains("loss_factor")).count()
    };
    assert_eq!([stated(&with), stated(&without)], [8, 0]);
}

#[test]
fn friction_that_nothing_is_known_for_is_refused_at_its_field() {
    let law = "{ constant: { coefficient: 0.06 } }";
    for (text, message) in [
        (
            study(law, ", corner_contact: exact", "1500 rpm, in_load_balance: true"),
            "`in_load_balance` is for `corner_contact: none`",
        ),
        (study(law, "", "0 rpm"), "`speed` must be between"),
        (study("{ iso_14179_2: { roughness: 0.4 um } }", "", "1500 rpm"), "`viscosity`"),
        (study("{ iso_14179_2: { viscosity: 40 mm^2/s, roughness: 0.4 um } }", "", "1500 rpm"), "a dynamic viscosity"),
        (study("{ schlenk: {} }", "", "1500 rpm"), "schlenk"),
    ] {
        let Err(error) = program::load_text(&text, std::path::Path::new("t.yaml")) else { panic!("accepted:\n{text}") };
        let error = error.to_string();
        assert!(error.contains(message) && error.starts_with("t.yaml:11:"), "{error}");
    }
}
