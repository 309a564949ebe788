//! The same pair in every version and form of REXS, and what becomes of each attribute. The files are this project's own.

use std::fs;
use std::io::Write;

use serde_json::{Value, json};

use super::{body, refused};
use crate::desk::Desk;
use gearstudy::program::load_text;
use gearstudy::rexs;

const VERSIONS: [&str; 10] = ["1.0", "1.1", "1.2", "1.3", "1.4", "1.5", "1.6", "1.7", "2.0", "2.0.0"];

/// Kind, identifier, and attributes: name, unit and value.
type Component = (&'static str, u32, Vec<[String; 3]>);
/// Kind, and the role of each component by its identifier.
type Relation = (&'static str, Vec<(&'static str, u32)>);

/// The same pair as each version says it: up to 1.2 gears refer to their tools in order, and flanks are `flank_geometry`; from 1.3 on
/// manufacturing steps have them; 2.0 names the tip radius otherwise. Stages, gears, flanks and so on by kind, id, and attributes.
fn said_by(version: &str) -> (Vec<Component>, Vec<Relation>) {
    let attribute = |id: &str, unit: &str, value: &str| [id, unit, value].map(str::to_owned);
    let is_old = ["1.0", "1.1", "1.2"].contains(&version);
    let degrees = if is_old { "°" } else { "deg" };
    let tip_radius =
        if version.starts_with('2') { "tip_corner_radius_factor_reference_profile" } else { "tip_radius_factor" };
    let gear = |teeth: &str, tip: &str| {
        vec![
            attribute("normal_module", "mm", "4.0"),
            attribute("number_of_teeth", "none", teeth),
            attribute("helix_angle_reference_diameter", degrees, "0.0"),
            attribute("face_width", "mm", "20"),
            attribute("tip_diameter", "mm", tip),
            attribute("inner_diameter", "mm", "24"),
            attribute("number_of_teeth_for_span_measurement", "none", "3"),
            attribute("upper_backlash_allowance_referenced_to_span", "mum", "-94"),
            attribute("lower_backlash_allowance_referenced_to_span", "mum", "-141"),
            attribute("support_vector", "mm", "1 0 0"),
        ]
    };
    let mut flank = vec![
        attribute("normal_pressure_angle", degrees, "20"),
        attribute("addendum_modification_coefficient", "none", "0.1"),
        attribute("tooth_tip_chamfer", "mm", "0.4"),
    ];
    let settings = vec![attribute("machining_allowance", "mm", "0.16")];
    let flank_kind = if is_old { "flank_geometry" } else { "cylindrical_gear_flank" };
    if is_old {
        flank.extend(settings.clone());
    }
    let mut components = vec![
        (
            "cylindrical_stage",
            1,
            vec![
                attribute("center_distance", "mm", "78.8"),
                attribute("upper_center_distance_allowance", "mum", "20"),
                attribute("lower_center_distance_allowance", "mum", "-20"),
            ],
        ),
        ("cylindrical_gear", 2, gear("17", "76.4")),
        ("cylindrical_gear", 3, gear("22", "96.4")),
        (
            "rack_shaped_tool",
            8,
            vec![
                attribute("addendum_coefficient_reference_profile", "none", "1.4"),
                attribute(tip_radius, "none", "0.3"),
                attribute("protuberance_amount_factor", "none", "0.05"),
                attribute("protuberance_angle", degrees, "8"),
            ],
        ),
        (
            "material",
            9,
            vec![
                attribute("elastic_modulus", "N / mm^2", "210000"),
                attribute("poisson_ratio", "none", "0.29"),
                attribute("density", "kg / dm^3", "7.8"),
            ],
        ),
        ("shaft", 12, vec![attribute("length", "mm", "100")]),
        ("gear_unit", 13, Vec::new()),
    ];
    components.extend([4, 5, 6, 7].map(|id| (flank_kind, id, flank.clone())));
    let mut relations = vec![
        ("stage", vec![("stage", 1), ("gear_1", 2), ("gear_2", 3)]),
        ("flank", vec![("gear", 2), ("left", 4), ("right", 5)]),
        ("flank", vec![("gear", 3), ("left", 6), ("right", 7)]),
        ("reference", vec![("origin", 2), ("referenced", 9)]),
        // The wheel is one piece with its shaft.
        ("assembly", vec![("assembly", 12), ("part", 3)]),
        ("reference", vec![("origin", 12), ("referenced", 9)]),
    ];
    if is_old {
        relations.extend([2, 3].map(|gear| ("ordered_reference", vec![("origin", gear), ("referenced", 8)])));
    } else {
        components.push(("cylindrical_gear_manufacturing_settings", 10, settings));
        relations.extend([4, 5, 6, 7].map(|flank| {
            ("manufacturing_step", vec![("workpiece", flank), ("tool", 8), ("manufacturing_settings", 10)])
        }));
    }
    (components, relations)
}

fn in_xml(version: &str) -> String {
    let (components, relations) = said_by(version);
    let mut text = format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model version=\"{version}\">\n<relations>\n");
    for (id, (kind, refs)) in relations.iter().enumerate() {
        let order = if kind.contains("order") || kind.contains("step") { " order=\"1\"" } else { "" };
        let refs: Vec<String> = refs.iter().map(|(role, id)| format!("<ref id=\"{id}\" role=\"{role}\"/>")).collect();
        let refs = refs.concat();
        text += &format!("<relation id=\"{}\"{order} type=\"{kind}\">{refs}</relation>\n", 100 + id);
    }
    text += "</relations>\n<components>\n";
    for (kind, id, attributes) in &components {
        let attributes: Vec<String> = attributes
            .iter()
            .map(|[name, unit, value]| format!("<attribute id=\"{name}\" unit=\"{unit}\">{value}</attribute>\n"))
            .collect();
        text += &format!("<component id=\"{id}\" type=\"{kind}\">\n{}</component>\n", attributes.concat());
    }
    text + "</components>\n</model>\n"
}

fn in_json(version: &str) -> String {
    let (components, relations) = said_by(version);
    let attribute = |[name, unit, value]: &[String; 3]| match value.parse::<f64>() {
        Ok(value) => json!({ "id": name, "unit": unit, "floating_point": value }),
        Err(_) => json!({ "id": name, "unit": unit, "floating_point_array": [1.0, 0.0, 0.0] }),
    };
    let components: Vec<Value> = components
        .iter()
        .map(|(kind, id, list)| {
            json!({ "id": id, "type": kind, "attributes": list.iter().map(attribute).collect::<Vec<_>>() })
        })
        .collect();
    let relation = |(kind, refs): &(&str, Vec<(&str, u32)>)| {
        let refs: Vec<Value> = refs.iter().map(|(role, id)| json!({ "id": id, "role": role })).collect();
        json!({ "id": 1, "type": kind, "refs": refs })
    };
    let relations: Vec<Value> = relations.iter().map(relation).collect();
    json!({ "model": { "version": version, "relations": relations, "components": components } }).to_string()
}

#[test]
fn every_version_and_form_says_the_same_pair() {
    // h_fP* = h_aP0* − q*/sin α.
    let dedendum = 1.4 - 0.04 / 20.0_f64.to_radians().sin();
    let expected = format!(
        "\
study: imported
title: Cylindrical stage 1 of a REXS file

stages:
  pair:
    kind: geometry
    module: 4 mm
    pressure_angle: 20 deg
    rack: {{ dedendum: {dedendum}, tip_radius: 0.3, protuberance: 0.05, protuberance_angle: 8 deg, machining_allowance: 0.04 }}
"
    );
    for version in VERSIONS {
        let xml = in_xml(version);
        let study = body(&xml);
        assert!(study.starts_with(&expected), "{version}\n{study}");
        assert_eq!(study, body(&in_xml("1.4")), "{version}");
        assert_eq!(study, body(&in_json(version)), "{version}");
        // Nothing is said not to be there that is, and every attribute of the pair is reported, each once.
        let imported = rexs::import(&xml, None).unwrap();
        let defaults: Vec<&String> = imported.notes.iter().filter(|note| note.contains("does not say")).collect();
        assert_eq!(defaults, ["It does not say: the rack's addendum (1.0 modules stand for it)."], "{version}");
        let shaft = "The gear has no material of its own: that of its shaft stands for it.";
        assert!(imported.notes.iter().any(|note| note == shaft), "{:?}", imported.notes);
        let (components, _) = said_by(version);
        let all: usize = components.iter().filter(|(kind, ..)| *kind != "shaft").map(|(_, _, list)| list.len()).sum();
        let reported = [&imported.read, &imported.follows, &imported.not_supported];
        assert_eq!(reported.iter().map(|list| list.len()).sum::<usize>(), all, "{version}\n{reported:?}");
        assert_eq!(
            imported.not_supported,
            ["cylindrical_gear 2: support_vector", "cylindrical_gear 3: support_vector"]
        );
        assert!(
            imported.study.contains("# Not supported, 2 attributes: of cylindrical_gear 2 and 3: support_vector.\n")
        );
        assert!(
            imported.study.contains("# Other components, with their attributes: 1 × gear_unit (0), 1 × shaft (1).\n")
        );
    }
    // A_sn = A_W/cos α.
    let study = body(&in_xml("1.1"));
    let value =
        |name: &str| study.split(name).nth(1).unwrap().split([' ', ',']).next().unwrap().parse::<f64>().unwrap();
    let cos = 20.0_f64.to_radians().cos();
    assert!(
        (value("allowance: { upper: ") + 0.094 / cos).abs() < 1e-12 && (value("lower: ") + 0.141 / cos).abs() < 1e-12
    );
    for part in [
        "tip: { chamfer: { size: 0.4 mm } }",
        "measured_with: { span_teeth: 3 }",
        "material: { youngs_modulus: 210000 MPa, poisson_ratio: 0.29, density: 7800 kg/m^3 } }",
        "centre_distance_allowance: { upper: 0.02 mm, lower: -0.02 mm }",
    ] {
        assert!(study.contains(part), "{part}\n{study}");
    }
    // A later version is read, and said to be; a zipped file is read too.
    let newer = rexs::geometry(&in_xml("2.0").replacen("version=\"2.0\"", "version=\"2.1\"", 1), None).unwrap();
    assert!(newer.contains("# Version 2.1 of REXS is newer than this reader"), "{newer}");
    let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    zip.start_file("model.rexs", zip::write::SimpleFileOptions::default()).unwrap();
    zip.write_all(in_xml("1.4").as_bytes()).unwrap();
    let bytes = zip.finish().unwrap().into_inner();
    assert_eq!(rexs::text_of(bytes.clone()).unwrap(), in_xml("1.4"));
    assert!(rexs::text_of(bytes[..200].to_vec()).unwrap_err().to_string().contains("damaged archive"));
}

/// 17/22, m 4 mm, tool 1.4 and 0.3: root radii r_f = m(z/2 − 1.4 + x); the chamfer takes its share of the path of contact.
#[test]
fn an_old_file_gives_its_tool_and_its_chamfer() {
    let desk = Desk::with("quick.yaml");
    let cells = |text: &str, table: &str, columns: &str| -> Vec<f64> {
        fs::write(desk.path("pair.rexs"), text).unwrap();
        let (study, _) = desk.run(&["import", "pair.rexs"], 0);
        fs::write(desk.path("imported.yaml"), study).unwrap();
        desk.run(&["run", "imported.yaml", "--quiet"], 0);
        let csv = desk.run(&["table", "imported.yaml", table, "--columns", columns, "--format", "csv"], 0).0;
        csv.lines().skip(1).filter_map(|line| line.split(',').next_back()?.parse().ok()).collect()
    };
    let plain = in_xml("1.1")
        .replace("_backlash_", "_other_")
        .replace("machining_allowance", "other_allowance")
        .replace("protuberance_amount_factor", "other");
    let mut roots = cells(&plain, "pair.gears", "root_radius");
    roots.sort_by(f64::total_cmp);
    for (root, teeth) in roots.iter().zip([17.0, 22.0]) {
        assert!((root - 4.0 * (0.5 * teeth - 1.4 + 0.1)).abs() < 1e-9, "{roots:?}");
    }
    let ratio = |text: &str| cells(text, "pair.pair", "contact_ratio")[0];
    let without = ratio(&plain.replace("\"mm\">0.4<", "\"mm\">0<"));
    assert!(without - ratio(&plain) > 0.1, "{without}");
}

#[test]
fn modifications_of_flanks_are_a_design() {
    let attribute =
        |name: &str, unit: &str, value: &str| format!("<attribute id=\"{name}\" unit=\"{unit}\">{value}</attribute>");
    let relief = attribute("tip_relief_depth", "mum", "20")
        + &attribute("tip_relief_datum_diameter", "mm", "74")
        + &attribute("shape_of_relief", "none", "parabolic");
    let crowning = attribute("helix_crowning_amount_datum_face", "mm", "0.004")
        + &attribute("helix_crowning_amount_non_datum_face", "mm", "0.004");
    let with = |second: &str| {
        let components = format!(
            "<components><component id=\"20\" type=\"tip_relief\">{relief}</component><component id=\"21\" \
             type=\"tip_relief\">{}</component><component id=\"22\" type=\"helix_crowning\">{crowning}</component>",
            relief.replace(">20<", second)
        );
        let refs = [(4, 20), (5, 21), (4, 22), (5, 22)].map(|(flank, to)| {
            format!("<relation type=\"reference\"><ref role=\"origin\" id=\"{flank}\"/><ref role=\"referenced\" id=\"{to}\"/></relation>")
        });
        in_xml("1.4").replacen("<components>", &components, 1).replacen(
            "<relations>",
            &format!("<relations>{}", refs.concat()),
            1,
        )
    };
    let study = body(&with(">20<"));
    let designs = "  designs:\n    kind: modification\n    pair: pair\n    designs:\n      imported:\n        - lead_crowning: { gear: \
                   pinion, amount: 0.004 mm }\n        - tip_relief: { gear: pinion, amount: 0.02 mm, start_diameter: 74 mm, curve: \
                   power, exponent: 2 }\n";
    assert!(study.ends_with(designs), "{study}");
    // Flanks that differ are no design of a study, and are named.
    let imported = rexs::import(&with(">21<"), None).unwrap();
    assert!(
        imported.notes.iter().any(|note| note == "Not supported as it is: the tip_relief 20 and 21."),
        "{:?}",
        imported.notes
    );
    assert!(imported.not_supported.iter().any(|name| name == "tip_relief 20: tip_relief_depth"));
    assert!(!imported.study.contains("- tip_relief"), "{}", imported.study);
}

#[test]
fn an_allowance_without_protuberance_asks_for_the_notch() {
    let study = rexs::geometry(&in_xml("1.3").replace("protuberance_amount_factor", "other"), None).unwrap();
    assert!(study.contains("machining_allowance: 0.04, notch_radius: FILL_IN }\n"), "{study}");
    let line = 1 + study.lines().position(|line| line.contains(": FILL_IN")).unwrap();
    let says = format!(
        "# It does not say: the rack's notch_radius (modules); fill it in in line {line}, where FILL_IN stands."
    );
    assert!(study.contains(&says), "{study}");
    assert!(load_text(&study.replace(": FILL_IN", ": 0.2"), std::path::Path::new("imported.yaml")).is_ok());
}

/// No text of a file gets out of the comments, and a broken JSON has a place.
#[test]
fn names_from_a_file_stay_in_their_line() {
    let text = in_xml("1.4").replacen("support_vector", "a&#10;stages: {}&#10;#", 1);
    assert_eq!(body(&text), body(&in_xml("1.4")));
    assert!(
        refused("{ \"model\": }").starts_with("1:12: it is no file of REXS in JSON"),
        "{}",
        refused("{ \"model\": }")
    );
    assert!(refused("{}").contains("it is no file of REXS in JSON: missing field `model`"), "{}", refused("{}"));
    let deep = format!("{{\"model\":{}", "[".repeat(1_000_000));
    assert!(refused(&deep).contains("JSON"), "{}", refused(&deep));
}

/// A pair without relations to tools, whose first gear has these further attributes; with these relations and components.
fn pair_with(of_gear: &str, relations: &str, components: &str) -> String {
    let gear = |id: u32, teeth: u32, further: &str| {
        format!(
            r#"<component id="{id}" type="cylindrical_gear"><attribute id="normal_module" unit="mm">3</attribute>
<attribute id="number_of_teeth" unit="none">{teeth}</attribute><attribute id="face_width" unit="mm">20</attribute>
<attribute id="inner_diameter" unit="mm">28</attribute>
<attribute id="addendum_modification_coefficient" unit="none">0.2</attribute>{further}</component>"#
        )
    };
    format!(
        r#"<?xml version="1.0"?><model version="1.4" applicationId="x" applicationVersion="1" date="2026-01-01T00:00:00+00:00">
<relations><relation id="100" type="stage"><ref id="1" role="stage"/><ref id="2" role="gear_1"/><ref id="3" role="gear_2"/></relation>
{relations}</relations><components><component id="1" type="cylindrical_stage"><attribute id="center_distance" unit="mm">101.8</attribute>
</component>{}{}{components}</components></model>"#,
        gear(2, 19, of_gear),
        gear(3, 48, "")
    )
}

fn cut(gear: u32, tool: u32) -> String {
    format!(
        r#"<relation id="{}" type="manufacturing_step" order="1"><ref id="{gear}" role="workpiece"/><ref id="{tool}" role="tool"/></relation>"#,
        100 + gear
    )
}

fn tool(id: u32, kind: &str, attributes: &[(&str, &str, f64)]) -> String {
    let attribute = |(name, unit, value): &(&str, &str, f64)| {
        format!(r#"<attribute id="{name}" unit="{unit}">{value}</attribute>"#)
    };
    let attributes: String = attributes.iter().map(attribute).collect();
    format!(r#"<component id="{id}" type="{kind}">{attributes}</component>"#)
}

const CUTTER: [(&str, &str, f64); 4] = [
    ("number_of_teeth", "none", 25.0),
    ("addendum_modification_coefficient", "none", 0.1),
    ("addendum_coefficient_reference_profile", "none", 1.25),
    ("tip_radius_factor", "none", 0.2),
];
const RACK: [(&str, &str, f64); 2] =
    [("addendum_coefficient_reference_profile", "none", 1.4), ("tip_radius_factor", "none", 0.25)];

/// A gear that is shaped has its cutter in the study, if that says all of it; the other gear keeps its rack.
#[test]
fn a_pinion_type_cutter_is_read() {
    let tools = tool(8, "cutter_wheel_tool", &CUTTER) + &tool(9, "rack_shaped_tool", &RACK);
    let imported = rexs::import(&pair_with("", &(cut(2, 8) + &cut(3, 9)), &tools), None).unwrap();
    let pinion = imported.study.lines().find(|line| line.starts_with("    pinion:")).unwrap();
    let cutter = "pinion_cutter: { teeth: 25, profile_shift: 0.1, addendum: 1.25, tip_radius: 0.2 }";
    assert!(pinion.contains(cutter), "{pinion}");
    assert!(imported.study.contains("rack: { dedendum: 1.4, tip_radius: 0.25 }"), "{}", imported.study);
    assert!(imported.not_supported.is_empty(), "{:?}", imported.not_supported);
    assert!(!imported.notes.iter().any(|note| note.contains("pinion's rack")), "{:?}", imported.notes);
    // Both gears shaped: no word of the root of a rack.
    let both = rexs::import(&pair_with("", &(cut(2, 8) + &cut(3, 8)), &tools), None).unwrap();
    assert!(
        !both.notes.iter().any(|note| note.contains("dedendum") || note.contains("tip_radius")),
        "{:?}",
        both.notes
    );
    // Without its addendum it is not read, and the reason is given.
    let imported = rexs::import(&pair_with("", &cut(2, 8), &tool(8, "cutter_wheel_tool", &CUTTER[..2])), None).unwrap();
    let reason = "Not supported: the cutter_wheel_tool that cuts the pinion, since it does not say \
                  addendum_coefficient_reference_profile and tip_radius_factor; a rack stands for it.";
    assert!(imported.notes.iter().any(|note| note == reason), "{:?}", imported.notes);
    assert_eq!(imported.not_supported.len(), 2, "{:?}", imported.not_supported);
}

/// Of a rack that only one gear has the other's is a default, and said to be one.
#[test]
fn a_rack_of_one_gear_is_a_default_of_the_other() {
    let rack = tool(9, "rack_shaped_tool", &RACK);
    let imported = rexs::import(&pair_with("", &cut(2, 9), &rack), None).unwrap();
    let note = "It does not say: dedendum, tip_radius of the gear's rack (as of the pinion's, which stands for it).";
    assert!(imported.notes.iter().any(|found| found == note), "{:?}", imported.notes);
    let both = rexs::import(&pair_with("", &(cut(2, 9) + &cut(3, 9)), &rack), None).unwrap();
    assert!(!both.notes.iter().any(|found| found.contains("gear's rack")), "{:?}", both.notes);
}

/// A second value of a quantity follows from the one that is read only if it is the same; the dedendum of a tool is in no study.
#[test]
fn contradictions_are_not_reported_as_following() {
    let import = |radius: f64, root: f64| {
        let mut rack = RACK.to_vec();
        rack.extend([("tip_radius", "mm", radius), ("dedendum_coefficient_reference_profile", "none", 0.7)]);
        let of_gear = format!(r#"<attribute id="root_diameter" unit="mm">{root}</attribute>"#);
        rexs::import(&pair_with(&of_gear, &(cut(2, 9) + &cut(3, 9)), &tool(9, "rack_shaped_tool", &rack)), None)
            .unwrap()
    };
    let dedendum = ["rack_shaped_tool 9: dedendum_coefficient_reference_profile"];
    // d_f = 3 (19 − 2 (1.4 − 0.2)).
    let same = import(0.75, 49.8);
    assert_eq!((same.contradicting.len(), same.not_supported.as_slice()), (0, &dedendum.map(String::from)[..]));
    assert_eq!(same.follows, ["cylindrical_gear 2: root_diameter", "rack_shaped_tool 9: tip_radius"]);
    let other = import(1.2, 51.3);
    assert_eq!(other.contradicting, ["cylindrical_gear 2: root_diameter", "rack_shaped_tool 9: tip_radius"]);
    assert_eq!(other.not_supported, dedendum);
    let line = "# Not read, since they contradict those that are, 2 attributes: of cylindrical_gear 2: root_diameter; of \
                rack_shaped_tool 9: tip_radius.\n";
    assert!(other.study.contains(line), "{}", other.study);
}

/// What no study takes is listed: chords of a tooth, end reliefs.
#[test]
fn chords_and_end_reliefs_are_not_supported() {
    let chord = r#"<attribute id="normal_chordal_tooth_thickness" unit="mm">4.7</attribute>
<attribute id="chordal_tooth_thickness_upper_deviation" unit="mm">-0.05</attribute>"#;
    let flanks = r#"<relation id="110" type="flank"><ref id="2" role="gear"/><ref id="4" role="left"/><ref id="5" role="right"/></relation>
<relation id="111" type="reference"><ref id="4" role="origin"/><ref id="10" role="referenced"/></relation>"#;
    let components = tool(4, "cylindrical_gear_flank", &[])
        + &tool(5, "cylindrical_gear_flank", &[])
        + &tool(
            10,
            "end_relief_datum_face",
            &[("end_relief_depth_datum_face", "mum", 10.0), ("end_relief_length_datum_face", "mm", 2.0)],
        );
    let imported = rexs::import(&pair_with(chord, flanks, &components), None).unwrap();
    assert_eq!(
        imported.not_supported,
        [
            "cylindrical_gear 2: normal_chordal_tooth_thickness",
            "cylindrical_gear 2: chordal_tooth_thickness_upper_deviation",
            "end_relief_datum_face 10: end_relief_depth_datum_face",
            "end_relief_datum_face 10: end_relief_length_datum_face",
        ]
    );
}
