//! Every family of roots and every tip gives finite tables of full profiles, and refusals stand at their field.

use std::collections::BTreeSet;
use std::path::Path;

use super::is_name;
use super::walk::{load, walk};
use gearmesh::gear::geometry::outline::{roots, tip};
use gearstudy::program;
use studygraph::table::data::Table;

const ROOTS: &[(&str, &str)] = &[
    ("trochoid", "trochoid"),
    ("trochoid", "{ trochoid: { rack_tip: sharp } }"),
    ("trochoid", "{ trochoid: { rack_tip: full_round } }"),
    ("arc", "arc"),
    ("arc", "{ arc: { formulas: printed } }"),
    ("tangent_arc", "tangent_arc"),
    ("tangent_arc", "{ tangent_arc: { size: largest } }"),
    ("tangent_arc", "{ tangent_arc: { radius: 0.7 mm } }"),
    ("optimised_arc", "optimised_arc"),
];

const TIPS: &[(&str, &str)] = &[
    ("land", "land"),
    ("chamfer", "{ chamfer: { size: 0.2 mm } }"),
    ("rounding", "{ rounding: { radius: 0.2 mm } }"),
    ("semi_topping", "{ semi_topping: { height: 0.2 mm } }"),
];

fn study(teeth: u32, outline: &str) -> String {
    format!(
        "study: t\nseed: 1\nstages:\n  pair:\n    kind: geometry\n    module: 2 mm\n    pinion: {{ teeth: {teeth}, face_width: 9 mm, bore_radius: 5 mm }}\n    gear: {{ teeth: 31, face_width: 9 mm, bore_radius: 5 mm, tip_shortening: 0.05 }}\n    outline: {outline}\n"
    )
}

#[test]
fn every_root_and_tip_gives_a_closed_profile() {
    let known: BTreeSet<_> = roots::members().iter().chain(tip::members()).map(|member| member.name).collect();
    let used: BTreeSet<_> = ROOTS.iter().chain(TIPS).map(|(name, _)| *name).collect();
    assert_eq!(used, known, "a member without a use here, or the reverse");
    for (name, root) in ROOTS {
        assert!(is_name(name));
        for (_, tip) in TIPS {
            let flank = "[tip_relief: { gear: both, amount: 8 um, length: 3 mm }]";
            for flank in ["", &format!(", flank: {flank}")] {
                let ran =
                    walk(&load(&study(29, &format!("{{ root: {root}, tip: {tip}{flank}, points: 40, teeth: all }}"))));
                let table = |name| ran["pair"].tables.iter().find(|table| table.name() == name).unwrap();
                let (outline, junctions) = (table("outline"), table("junctions"));
                assert!(junctions.floats("position_jump").iter().all(|jump| *jump < 1e-9), "{root} {tip}");
                let parts = outline.texts("part").iter().collect::<BTreeSet<_>>();
                assert_eq!(parts.iter().any(|part| *part == "tip_break"), *tip != "land");
                let modified = outline.texts("curve").iter().any(|curve| curve == "modified_involute");
                assert_eq!(modified, !flank.is_empty());
                // The last point of a gear is its first.
                for gear in ["pinion", "gear"] {
                    let rows: Vec<_> = (0..outline.rows()).filter(|&row| outline.texts("gear")[row] == gear).collect();
                    let at = |row: usize| [outline.floats("x")[row], outline.floats("y")[row]];
                    let (first, last) = (at(rows[0]), at(rows[rows.len() - 1]));
                    assert!((first[0] - last[0]).hypot(first[1] - last[1]) < 1e-11, "{root} {tip}: {first:?} {last:?}");
                }
                assert!(table("validity").rows() == 2 && table("root_arc").rows() == 2);
                assert!(table("mesh_drawing").rows() > 300 && table("arc_drawing").rows() > 300);
            }
        }
    }
}

#[test]
fn refusals_stand_at_their_field() {
    for (teeth, outline, message) in [
        (44, "{ root: arc }", "pinion: the arc of zhai2020 begins on the base circle and ends on the root circle"),
        (17, "{ root: tangent_arc }", "its radius must be at most"),
        (29, "{ tip: { chamfer: { size: 9 mm } } }", "the tip is broken by 9 mm, but must be by"),
    ] {
        let error = program::load_text(&study(teeth, outline), Path::new("t.yaml")).err().unwrap().to_string();
        assert!(error.contains(message) && error.contains("t.yaml:9:"), "{error}");
    }
    let both = study(29, "{}").replace("tip_shortening: 0.05", "tip_shortening: 0.05, tip_radius: 32.9 mm");
    let error = program::load_text(&both, Path::new("t.yaml")).err().unwrap().to_string();
    assert!(error.contains("`tip_radius` and `tip_shortening` both say where the tip is"), "{error}");
}

fn alone(teeth: u32, module: &str, angle: &str, shift: f64, outline: &str) -> String {
    format!(
        "study: t\nseed: 1\nstages:\n  one:\n    kind: geometry\n    module: {module} mm\n    pressure_angle: {angle} deg\n    rack: {{ addendum: 0.8, dedendum: 1.1, tip_radius: 0.2 }}\n    pinion: {{ teeth: {teeth}, face_width: 9 mm, bore_radius: {bore} mm, profile_shift: {shift}, tip_shortening: 0.1 }}\n    outline: {outline}\n",
        bore = 0.2 * f64::from(teeth) * module.parse::<f64>().unwrap()
    )
}

/// One gear without a mate, at the ends of what is asked for, gives everything but what only a pair has.
#[test]
fn a_gear_alone_is_drawn_over_the_whole_range() {
    for (teeth, shift) in [(5, 0.6), (6, 0.5), (17, 0.0), (1000, -0.5), (1000, 1.0)] {
        for module in ["0.05", "3", "50"] {
            for angle in ["14.5", "20", "30"] {
                for (_, root) in ROOTS.iter().filter(|(_, root)| !root.contains("mm")) {
                    let text = alone(teeth, module, angle, shift, &format!("{{ root: {root}, points: 24 }}"));
                    let study = match program::load_text(&text, Path::new("t.yaml")) {
                        Ok(study) => study,
                        Err(error) => {
                            let error = error.to_string();
                            let says_why = ["must be", "must take up", "need a profile shift of at least"];
                            assert!(says_why.iter().any(|why| error.contains(why)), "{text}{error}");
                            // What a rack cuts is refused for pointed tips and for teeth that are cut off, of few teeth alone.
                            assert!(!root.contains("trochoid") || teeth < 7, "{text}{error}");
                            continue;
                        }
                    };
                    let ran = walk(&study);
                    let names: Vec<_> = ran["one"].tables.iter().map(Table::name).collect();
                    assert_eq!(
                        names,
                        ["gears", "outline", "junctions", "validity", "root_arc", "arc_drawing", "inspection", "body"]
                    );
                    assert!(ran["one"].tables[..4].iter().all(|table| table.rows() > 0), "{text}");
                    let jumps = ran["one"].tables[2].floats("position_jump");
                    let size = f64::from(teeth) * module.parse::<f64>().unwrap() * 1e3;
                    assert!(jumps.iter().all(|jump| *jump < 1e-13 * size), "{text}{jumps:?}");
                    assert!(ran["one"].tables[3].schema().column("clearance").is_none());
                }
            }
        }
    }
}

#[test]
fn what_needs_a_pair_says_so() {
    let refused = |text: &str| program::load_text(text, Path::new("t.yaml")).err().unwrap().to_string();
    let plain = alone(17, "3", "20", 0.0, "{}");
    for kind in ["stiffness", "root_optimizer, problem: root_arc", "modification, designs: { a: [] }"] {
        let error = refused(&format!("{plain}  other: {{ pair: one, kind: {kind} }}\n"));
        assert!(
            error.contains("stage `one` has no table `pair`") && error.contains("give it the mate as `gear`"),
            "{error}"
        );
    }
    let error = refused(&format!("{plain}    centre_distance: 60 mm\n"));
    assert!(error.contains("`centre_distance` needs a mate") && error.contains("t.yaml:11:"), "{error}");
    let error = refused(&alone(17, "3", "20", 0.0, "{ flank: [profile_crowning: { gear: pinion, amount: 5 um }] }"));
    assert!(error.contains("`flank` needs a mate: a modification is laid out"), "{error}");
}
