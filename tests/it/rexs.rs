//! Importing REXS: what a file says comes out as a study that is valid, what it does not say is named, and a file that
//! means harm is refused in one sentence. The file is this project's own, by the public schema.

mod versions;

use std::fs;

use proptest::prelude::*;

use crate::desk::Desk;
use gearstudy::program::load_text;
use gearstudy::rexs;

const FLANK: &str = r#"<attribute id="normal_pressure_angle" unit="deg">20</attribute>
      <attribute id="addendum_coefficient_basic_profile" unit="none">1.0</attribute>"#;

fn file() -> String {
    let gear = |id: u32, teeth: u32, width: f64, tip: f64, bore: f64| {
        format!(
            r#"    <component id="{id}" type="cylindrical_gear" name="gear">
      <attribute id="normal_module" unit="mm">3.0</attribute>
      <attribute id="number_of_teeth" unit="none">{teeth}</attribute>
      <attribute id="helix_angle_reference_diameter" unit="°">0.0</attribute>
      <attribute id="face_width" unit="mm">{width}</attribute>
      <attribute id="tip_diameter" unit="mm">{tip}</attribute>
      <attribute id="inner_diameter" unit="mm">{bore}</attribute>
      <attribute id="support_vector" unit="mm"><array><c>1.0</c><c>0.0</c></array></attribute>
    </component>
"#
        )
    };
    let flank = |id: u32, shift: f64| {
        format!(
            r#"    <component id="{id}" type="cylindrical_gear_flank">
      {FLANK}
      <attribute id="addendum_modification_coefficient" unit="none">{shift}</attribute>
    </component>
"#
        )
    };
    let relation = |kind: &str, refs: &[(&str, u32)]| {
        let refs =
            refs.iter().map(|(role, id)| format!(r#"<ref id="{id}" role="{role}"/>"#)).collect::<Vec<_>>().concat();
        format!(
            r#"    <relation id="{}" type="{kind}">{refs}</relation>
"#,
            1000 + refs.len()
        )
    };
    let mut text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- two gears -->\n<model version=\"1.4\" \
                    applicationId=\"none\" applicationVersion=\"1\" date=\"2026-01-01T00:00:00+00:00\">\n  <relations>\n"
        .to_owned();
    text += &relation("stage", &[("stage", 1), ("gear_1", 2), ("gear_2", 3)]);
    text += &relation("flank", &[("gear", 2), ("left", 4), ("right", 5)]);
    text += &relation("flank", &[("gear", 3), ("left", 6), ("right", 7)]);
    for flank in [4, 5, 6, 7] {
        text += &relation("manufacturing_step", &[("workpiece", flank), ("tool", 8)]);
    }
    text += &relation("reference", &[("origin", 2), ("referenced", 9)]);
    text += "  </relations>\n  <components>\n";
    text += "    <component id=\"1\" type=\"cylindrical_stage\"><attribute id=\"center_distance\" unit=\"mm\">102.0\
             </attribute></component>\n";
    text += &gear(2, 19, 20.0, 64.2, 28.0);
    text += &gear(3, 48, 18.0, 151.0, 70.0);
    text += &[(4, 0.2), (5, 0.2), (6, 0.3), (7, 0.3)].map(|(id, shift)| flank(id, shift)).concat();
    text += r#"    <component id="8" type="rack_shaped_tool">
      <attribute id="addendum_coefficient_reference_profile" unit="none">1.25</attribute>
      <attribute id="tip_radius_factor" unit="none">0.3</attribute>
    </component>
    <component id="9" type="material">
      <attribute id="elastic_modulus" unit="N / mm^2">210000</attribute>
      <attribute id="poisson_ratio" unit="">0.29</attribute>
    </component>
  </components>
</model>
"#;
    text
}

/// The study without its comments.
fn body(text: &str) -> String {
    let study = rexs::geometry(text, None).unwrap_or_else(|refusal| panic!("{refusal}\n{text}"));
    study.lines().filter(|line| !line.starts_with('#')).flat_map(|line| [line, "\n"]).collect()
}

fn refused(xml: &str) -> String {
    rexs::geometry(xml, None).unwrap_err().to_string()
}

/// Marks that a merge left, in a file of every form.
#[test]
fn a_conflict_of_a_merge_is_named() {
    let text = file();
    let line = text.lines().position(|line| line.contains("<attribute ")).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let both =
        [&lines[..line], &["<<<<<<< HEAD", lines[line], "=======", lines[line], ">>>>>>> f"], &lines[line + 1..]];
    let place = format!("{}:1: a merge left both versions from line {} to {}; keep one", line + 1, line + 1, line + 5);
    let said = refused(&both.concat().join("\n"));
    assert!(said.starts_with(&place), "{said}");
    let said = refused("{\n<<<<<<< HEAD\n\"model\": 1\n=======\n\"model\": 2\n>>>>>>> f\n}\n");
    assert!(said.starts_with("2:1: a merge left both versions from line 2 to 6"), "{said}");
    // A line of a comment is none.
    let comment = text.replacen("?>", "?>\n<!--\n=======\n-->", 1);
    assert!(comment.contains("=======") && rexs::geometry(&comment, None).is_ok());
}

#[test]
fn a_pair_comes_out_as_a_valid_study() {
    let desk = Desk::with("quick.yaml");
    fs::write(desk.path("pair.rexs"), file()).unwrap();
    let (text, _) = desk.run(&["import", "pair.rexs"], 0);
    let (json, _) = desk.run(&["import", "pair.rexs", "--format", "json"], 0);
    let said: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!((said["file"].as_str(), said["study"].as_str()), (Some("pair.rexs"), Some(text.as_str())));
    for line in [
        "# From a file of REXS 1.4.",
        "    module: 3 mm",
        "    pressure_angle: 20 deg",
        "    rack: { addendum: 1, dedendum: 1.25, tip_radius: 0.3 }",
        "    pinion: { teeth: 19, face_width: 20 mm, bore_radius: 14 mm, profile_shift: 0.2, tip_radius: 32.1 mm, material: { \
         youngs_modulus: 210000 MPa, poisson_ratio: 0.29 } }",
        "    gear: { teeth: 48, face_width: 18 mm, bore_radius: 35 mm, profile_shift: 0.3, tip_radius: 75.5 mm }",
        "    centre_distance: 102 mm",
    ] {
        assert!(text.lines().any(|found| found == line), "{line}\n{text}");
    }
    let defaults: Vec<&str> = text.lines().filter(|line| line.contains("does not say")).collect();
    assert_eq!(
        defaults,
        [
            "# It does not say: modulus_of_elasticity (206 GPa stands for it) of the gear.",
            "# It does not say: poisson_ratio (0.3 stands for it) of the gear."
        ]
    );
    fs::write(desk.path("imported.yaml"), &text).unwrap();
    desk.run(&["run", "imported.yaml", "--quiet"], 0);
    let words = ["table", "imported.yaml", "pair.pair", "--columns", "centre_distance", "--format", "csv"];
    assert!(desk.run(&words, 0).0.lines().last().unwrap().starts_with("102"));
}

#[test]
fn what_a_file_does_not_say_is_named_and_left_out() {
    let bare = file().replace("inner_diameter", "outer_diameter").replace("manufacturing_step", "other");
    let text = rexs::geometry(&bare, None).unwrap();
    let open: Vec<usize> = text
        .lines()
        .enumerate()
        .filter(|(_, line)| line.contains("bore_radius: FILL_IN mm"))
        .map(|(at, _)| at + 1)
        .collect();
    for (line, gear) in open.iter().zip(["pinion", "gear"]) {
        let says =
            format!("# It does not say: bore_radius of the {gear}; fill it in in line {line}, where FILL_IN stands.\n");
        assert!(text.contains(&says), "{says}{text}");
    }
    // As it is it is refused right there; filled in, it is a study.
    let read = |text: &str| load_text(text, std::path::Path::new("imported.yaml"));
    let place = read(&text).err().unwrap().diagnostic.place.unwrap();
    assert_eq!((open.len(), place.line), (2, open[0]));
    assert!(read(&text.replace("FILL_IN", "14")).is_ok(), "{text}");
    assert!(text.contains("# It does not say: the rack's dedendum (1.25 modules stand for it).\n"), "{text}");
    assert!(text.contains("rack: { addendum: 1 }"), "{text}");
    // The root circle says it too: r_f = m(z/2 − h_fP* + x).
    let by_root = |gear: &str, teeth: f64, shift: f64| {
        let root = 2.0 * 3.0 * (0.5 * teeth - 1.3 + shift);
        (
            format!("{gear}</attribute>"),
            format!("{gear}</attribute><attribute id=\"root_diameter\" unit=\"mm\">{root}</attribute>"),
        )
    };
    let (first, with_first) = by_root(">19", 19.0, 0.2);
    let (second, with_second) = by_root(">48", 48.0, 0.3);
    let text = rexs::geometry(&bare.replace(&first, &with_first).replace(&second, &with_second), None).unwrap();
    let dedendum = text.split("dedendum: ").nth(1).unwrap().split([' ', ',']).next().unwrap().parse::<f64>().unwrap();
    assert!((dedendum - 1.3).abs() < 1e-12, "{text}");
}

#[test]
fn what_a_pair_here_cannot_have_is_refused() {
    for (from, to, says) in [
        ("°\">0.0", "°\">15.0", "a helix angle of 15°; only spur gears"),
        ("\"mm\">3.0", "\"in\">3.0", "`normal_module` of the cylindrical_gear 2 is in `in`, not in mm"),
        ("\"mm\">3.0", "\"mm\">three", "is `three`, which is not a number"),
        ("\"mm\">3.0", "\"mm\">inf", "is `inf`, which is not a number"),
        ("\"mm\">3.0", "\"mm\">-3.0", "a module of -3 mm"),
        ("\"mm\">3.0", "\"mm\">1e308", "`normal_module` of the cylindrical_gear 2 is 1e308; it must be -1e9 to 1e9"),
        ("id=\"5\" type", "id=\"4\" type", "the component 4 is given twice, first in line 3"),
        ("version=\"1.4\"", "version=\"9.9\"", "its version is `9.9`; versions 1.0 to 2.0"),
        ("model version=\"1.4\"", "model", "its version is ``; versions 1.0 to 2.0"),
        ("\"mm\">102.0", "\"mm\">1", "centre"),
        ("\"mm\">20<", "\"mm\">2e8<", "`face_width` must be between 1 um and 100 m, not `200000000 mm`"),
        ("unit=\"mm\">20<", "unit=\"mm\">20</attribute><attribute id=\"face_width\" unit=\"mm\">21<", "given twice"),
        ("\"none\">19", "\"none\">19.5", "19.5 teeth"),
        ("\"none\">19", "\"none\">-19", "-19 teeth"),
        (
            "\"none\">0.3</attribute>\n    </component>\n    <component id=\"7\"",
            "\"none\">0.4</attribute>\n    </component>\n    <component id=\"7\"",
            "both flanks of a gear must be alike",
        ),
        ("role=\"gear_2\"", "role=\"planet\"", "the stage has no `gear_2`"),
        ("id=\"3\" type=\"cylindrical_gear\"", "id=\"3\" type=\"ring_gear\"", "is a ring_gear; only external"),
        ("type=\"cylindrical_stage\"", "type=\"bevel_stage\"", "no stage of two cylindrical gears"),
        ("<model ", "<modell ", "it is not XML"),
    ] {
        let changed = file().replacen(from, to, 1);
        assert!(changed != file(), "{from}");
        let refusal = refused(&changed);
        assert!(refusal.contains(says), "{says}: {refusal}");
        let place: Vec<&str> = refusal.split(": ").next().unwrap().split(':').collect();
        assert!(place.len() == 2 && place.iter().all(|number| number.parse::<usize>().is_ok()), "{refusal}");
    }
    // The number itself is what is pointed at.
    let far = file().replacen("\"mm\">102.0", "\"mm\">1", 1);
    let line = 1 + far.lines().position(|line| line.contains("center_distance")).unwrap();
    assert!(refused(&far).starts_with(&format!("{line}:")), "{}", refused(&far));
    assert!(refused("<a/>").contains("outermost element is `a`"));
    let one = r#"<relation id="1" type="stage"><ref id="1" role="stage"/>"#;
    let two = file().replacen("  <relations>", &format!("  <relations>{one}</relation>"), 1);
    assert!(refused(&two).contains("2 cylindrical stages; name one of 1, 1"), "{}", refused(&two));
    assert!(rexs::geometry(&file(), Some("5")).unwrap_err().to_string().contains("no cylindrical stage `5`; it has 1"));
    assert!(rexs::geometry(&file(), Some("1")).is_ok());
}

/// Finding each stage by looking at all components would take minutes here.
#[test]
fn a_file_of_a_whole_factory_is_read_in_one_pass() {
    let stage = |id: usize| {
        let relation = format!("<relation id=\"r{id}\" type=\"stage\"><ref id=\"s{id}\" role=\"stage\"/></relation>");
        (relation, format!("<component id=\"s{id}\" type=\"cylindrical_stage\"/>"))
    };
    let (relations, components): (String, String) = (0..300_000).map(stage).unzip();
    let large = file().replacen("  <relations>", &format!("<relations>{relations}"), 1).replacen(
        "  <components>",
        &format!("<components>{components}"),
        1,
    );
    assert!(refused(&large).contains("it has 300001 cylindrical stages; name one of s0, s1, "), "{}", refused(&large));
    assert!(rexs::geometry(&large, Some("1")).is_ok());
}

/// The parser compares the attributes of an element pairwise and copies namespaces inwards; looking at every relation for
/// every flank is a square too. Each of these took minutes.
#[test]
fn no_part_of_a_file_takes_more_than_its_share() {
    let attributes = (0..500_000).map(|at| format!(" a{at}='1'")).collect::<Vec<_>>().concat();
    let wide = file().replacen("<component id=\"2\"", &format!("<component{attributes} id=\"2\""), 1);
    let says = "an element has more than 100 attributes; those of REXS have a few";
    assert_eq!(refused(&wide), format!("16:5: {says}"));
    // A sign in a value, in a comment or in a text is not an attribute, and 100 are not too many.
    let values = "=".repeat(200);
    let quoted = format!("<component note='{values}<' ").replace('<', "&lt;").replacen("&lt;", "<", 1);
    let text = file().replacen("<component ", &quoted, 1).replace("two gears", &values);
    let text =
        text.replacen("  <components>", &format!("{values}<![CDATA[<a {values}>]]><?p <a {values} ?><components>"), 1);
    assert!(rexs::geometry(&text, None).is_ok(), "{}", refused(&text));
    let maximum = (0..97).map(|at| format!(" a{at} = '1'")).collect::<Vec<_>>().concat();
    let text = |more: &str| file().replacen("<component id=\"2\"", &format!("<component{maximum}{more} id=\"2\""), 1);
    assert!(rexs::geometry(&text(""), None).is_ok() && refused(&text(" b='1'")).ends_with(says));

    let spaces = (0..500_000).map(|at| format!("<a xmlns:n{at}='u'/>")).collect::<Vec<_>>().concat();
    let spaces = file().replacen("  <components>", &format!("{spaces}<components>"), 1);
    assert!(refused(&spaces).contains("more than 100 namespaces are declared"), "{}", refused(&spaces));

    let flank = "<relation type=\"flank\"><ref role=\"gear\" id=\"2\"/><ref role=\"left\" id=\"4\"/></relation>";
    let tool = "<relation type=\"manufacturing_step\"><ref role=\"workpiece\" id=\"4\"/><ref role=\"tool\" id=\"8\"/></relation>";
    let notes = "<attribute id=\"note\"/>".repeat(100_000);
    let many = file()
        .replacen("  <relations>", &format!("<relations>{}{}", flank.repeat(100_000), tool.repeat(100_000)), 1)
        .replacen("type=\"cylindrical_gear_flank\">", &format!("type=\"cylindrical_gear_flank\">{notes}"), 4)
        .replacen("type=\"rack_shaped_tool\">", &format!("type=\"rack_shaped_tool\">{notes}"), 1);
    assert_eq!(body(&many), body(&file()));
    let pieces = format!("{}<a/>", "<![CDATA[a]]>b&amp;".repeat(200_000));
    let pieces = file().replacen("  <components>", &format!("{pieces}<components>"), 1);
    assert_eq!(body(&pieces), body(&file()));
}

#[test]
fn a_hostile_file_is_refused_at_once() {
    let bomb = "<!DOCTYPE m [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;\">]><model>&b;</model>";
    assert!(refused(bomb).contains("document type"), "{}", refused(bomb));
    assert!(refused("<!DOCTYPE m SYSTEM \"file:///etc/passwd\"><model/>").contains("document type"));
    let deep = format!("<model version=\"1.4\">{}{}</model>", "<a>".repeat(1_000_000), "</a>".repeat(1_000_000));
    assert!(refused(&deep).contains("no stage of two cylindrical gears"), "{}", refused(&deep));
    assert!(refused(&"<model>".repeat(1_000_000)).contains("not XML"));
    let many = format!("<model>{}</model>", "<a/>".repeat(5_000_000));
    assert!(refused(&many).contains("more than 4000000 elements"), "{}", refused(&many));
    for wrong in ["", "<", "<model", "<model>", "\u{feff}", "<model></modem>", "not XML", "<model>&nothing;</model>"] {
        assert!(refused(wrong).contains("not XML"), "{wrong}: {}", refused(wrong));
    }
    let long = refused(&format!("<{}/>", "m".repeat(1_000_000)));
    assert!(long.contains("no REXS file") && long.ends_with(" …") && long.len() < 600, "{}", long.len());
    let desk = Desk::with("quick.yaml");
    fs::write(desk.path("bytes.rexs"), [0xFF, 0xFE, 0x00, 0x3C]).unwrap();
    for (name, says) in [("bytes.rexs", "not UTF-8"), ("nothing.rexs", "cannot read"), (".", "cannot read")] {
        let (out, err) = desk.run(&["import", name], 1);
        assert!(out.is_empty() && err.contains(says) && err.lines().count() == 1, "{name}: {err}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 200, ..ProptestConfig::default() })]

    /// Whatever is cut out of a file or put in: a refusal or a text that the reader of studies takes or refuses in turn.
    #[test]
    fn a_damaged_file_never_panics(at in 0_usize..3500, length in 0_usize..60, with in "[<>/a-z0-9\"=: {}#\n]{0,12}") {
        let mut text = file();
        let floor = |mut place: usize| { place = place.min(text.len()); while !text.is_char_boundary(place) { place -= 1; } place };
        let (from, to) = (floor(at), floor(at + length));
        text.replace_range(from..to, &with);
        if let Ok(study) = rexs::geometry(&text, None) {
            let _ = load_text(&study, std::path::Path::new("imported.yaml"));
        }
    }
}
