//! What messages offer: no name and no number that means something else than what was written.
//!
//! Every field of every kind, with words before and behind its name, and with units that it does not have.

use std::path::Path;

use declare::error::nearest;
use declare::parameter::{Field, Shape};
use gearstudy::program;
use gearstudy::stage::kinds::KINDS;

/// Words that make another quantity of a name.
const QUALIFIERS: [&str; 18] = [
    "gear", "pinion", "wheel", "ring", "driven", "driving", "input", "output", "left", "right", "inner", "outer",
    "minimum", "maximum", "mean", "1", "2", "normal",
];

/// The names of the fields of every mapping, and the way to each field that has a number.
struct Fields {
    mappings: Vec<Vec<&'static str>>,
    /// The kind, and the names down to the field.
    numbers: Vec<(Vec<String>, &'static Field)>,
}

impl Fields {
    fn all() -> Self {
        let mut found = Self { mappings: Vec::new(), numbers: Vec::new() };
        for kind in KINDS {
            found.mapping(kind.fields, &[kind.name.to_owned()]);
        }
        found
    }

    fn mapping(&mut self, fields: &'static [Field], way: &[String]) {
        if way.len() > 6 {
            return;
        }
        self.mappings.push(fields.iter().map(|field| field.name).collect());
        for field in fields {
            let way = [way, &[field.name.to_owned()]].concat();
            self.shape(field, &field.shape, &way);
        }
    }

    fn shape(&mut self, field: &'static Field, shape: &'static Shape, way: &[String]) {
        match shape {
            Shape::Number { .. } | Shape::Integer { .. } => self.numbers.push((way.to_vec(), field)),
            Shape::Group(fields) => self.mapping(fields, way),
            Shape::Member(members) => {
                for member in members() {
                    self.mapping(member.fields, &[way, &[member.name.to_owned()]].concat());
                }
            }
            _ => {}
        }
    }
}

/// Tier: invariant; what has a word more or less of the trade than a field is no slip for that field.
#[test]
fn no_name_is_offered_that_lacks_a_word() {
    let mut tried = 0;
    for known in Fields::all().mappings {
        for (name, word) in known.iter().flat_map(|name| QUALIFIERS.map(|word| (name, word))) {
            let ways = [format!("{word}_{name}"), format!("{name}_{word}"), format!("{name}{word}")];
            for way in ways.iter().filter(|way| !known.contains(&way.as_str())) {
                let near = nearest(way, known.iter().copied());
                let has_word =
                    near.is_none_or(|near| near.contains(word) || near.split('_').any(|other| word.starts_with(other)));
                assert!(has_word, "`{near:?}` is offered for `{way}`");
                tried += 1;
            }
        }
    }
    assert!(tried > 5000, "{tried}");
}

/// The message of a study whose only stage has this value at the end of this way.
fn message(way: &[String], value: &str) -> String {
    let (kind, way) = way.split_first().unwrap();
    let open: String = way.iter().flat_map(|name| ["{ ", name, ": "]).collect();
    let close = " }".repeat(way.len().saturating_sub(1));
    let fields = open.strip_prefix("{ ").unwrap_or_default();
    let text = format!("study: hints\nstages:\n  one: {{ kind: {kind}, {fields}{value}{close} }}\n");
    program::load_text(&text, Path::new("hints.yaml")).map_or_else(|error| error.to_string(), |_| String::new())
}

/// Tier: invariant; a number is never offered without the unit that it was written with.
#[test]
fn no_unit_is_dropped() {
    let mut refused = 0;
    for (way, field) in Fields::all().numbers {
        for unit in ["mm", "N", "deg", "mm^2", "in", "mm2"] {
            let said = message(&way, &format!("5 {unit}"));
            assert!(!said.contains("write `5`"), "{}: {said}", way.join("."));
            refused += usize::from(said.contains("`5 ") && said.contains(field.name));
        }
        let share = message(&way, "5 %");
        assert!(!share.contains("write `5`"), "{}: {share}", way.join("."));
    }
    assert!(refused > 300, "{refused}");
}

fn geometry(fields: &str) -> String {
    let text = format!(
        "study: hints\nstages:\n  pair:\n    kind: geometry\n    module: 2 mm\n    {fields}\n    \
         pinion: {{ teeth: 20, face_width: 20 mm, bore_radius: 10 mm }}\n"
    );
    program::load_text(&text, Path::new("hints.yaml")).map_or_else(|error| error.to_string(), |_| String::new())
}

/// Tier: closed form; lengths over the module, in any unit of length and wherever the module stands.
#[test]
fn lengths_are_offered_in_modules() {
    for (rack, number) in [
        ("addendum: 2 mm", "1"),
        ("addendum: 2000 um", "1"),
        ("dedendum: 2.5 mm", "1.25"),
        ("tip_radius: 0.76 mm", "0.38"),
        ("tip_radius: 0.02 in", "0.254"),
        ("protuberance: 0.1 mm", "0.05"),
        ("machining_allowance: 60 um", "0.03"),
        ("addendum: 110 %", "1.1"),
    ] {
        let said = geometry(&format!("rack: {{ {rack} }}"));
        assert!(said.contains(&format!("write `{number}`")), "{rack}: {said}");
    }
    let sweep = "study: hints
stages:
  pair:
    kind: geometry
    module: 2 mm
    pinion: { teeth: 20, face_width: 20 mm, bore_radius: 10 mm }
    gear: { teeth: 41, face_width: 20 mm, bore_radius: 20 mm }
  stiffness: { kind: stiffness, pair: pair }
  sweep:
    kind: sweep
    of: stiffness
    vary: { x: { field: pair.pinion.profile_shift, values: [0.4 mm] } }
    outputs: [zones.start]
";
    let said =
        program::load_text(sweep, Path::new("hints.yaml")).err().map(|error| error.to_string()).unwrap_or_default();
    assert!(said.contains("0.4 mm / 2 mm = 0.2; write `0.2`"), "{said}");
}

/// Tier: closed form; T = P/(2 pi n), T_pinion = T_gear z1/z2, m = 25.4 mm/P, and NIST's inch and pound.
#[test]
fn words_and_units_of_the_trade_have_a_remedy() {
    let study = |ste: &str| {
        let text = format!(
            "study: hints\nstages:\n  pair:\n    kind: geometry\n    module: 2 mm\n    \
             pinion: {{ teeth: 20, face_width: 20 mm, bore_radius: 10 mm }}\n    \
             gear: {{ teeth: 60, face_width: 20 mm, bore_radius: 30 mm }}\n  \
             stiffness: {{ kind: stiffness, pair: pair }}\n  \
             designs: {{ kind: modification, pair: pair, designs: {{ plain: [] }} }}\n  \
             ste: {{ kind: ste, stiffness: stiffness, designs: designs, {ste} }}\n"
        );
        program::load_text(&text, Path::new("hints.yaml")).map_or_else(|error| error.to_string(), |_| String::new())
    };
    for (ste, part) in [
        ("gear_torque: 300 N m", "write `torque: 100 N m`"),
        ("wheel_torque: 300 N m", "write `torque: 100 N m`"),
        ("driven_torque: 300 N m", "T_pinion = T_gear z1/z2"),
        ("power: 10 kW, speed: 1500 rpm", "write `torque: 63.66198 N m`"),
        ("power: 10 hp, n: 1500 1/min", "write `torque: 47.47273 N m`"),
        ("power: 10 kW", "T = P/(2 pi n)"),
        ("torque: 100 lbf in", "write `11.2984829028 N m`"),
        ("torque: 100 Nmm2", "is expected"),
        ("torque: 10 kW", "is a power; a torque"),
        ("torque: 100 N m, K_A: 1.25", "application_factor"),
    ] {
        let said = study(ste);
        assert!(said.contains(part), "{ste}: {said}");
    }
    for (fields, part) in [
        ("diametral_pitch: 8", "write `module: 3.175 mm`"),
        ("helix_angle: 15 deg", "spur gears only"),
        ("helical: true", "spur gears only"),
        ("internal: true", "external gears only"),
        ("backlash: 0.1 mm", "tooth_thickness"),
        ("clearance: 0.25", "dedendum"),
        ("center_distance: 90 mm", "`centre_distance`"),
        ("ratio: 3", "numbers of teeth"),
        ("pressure_angle: 20 degrees", "write `20 deg`"),
        ("centre_distance: 3.5 inch", "write `88.9 mm`"),
        ("material: { density: 7850 kg/m3 }", "write `7850 kg/m^3`"),
        ("material: { density: 7.85 g/cm^3 }", "write `7850 kg/m^3`"),
        ("material: { youngs_modulus: 206000 N/mm2 }", "write `206000 N/mm^2`"),
        ("material: { youngs_modulus: 30e6 psi }", "GPa"),
        ("material: { hardness: 60 HRC }", "`kind: rating`"),
        ("quality: 6", "tolerance_class"),
    ] {
        let said = geometry(fields);
        assert!(said.contains(part), "{fields}: {said}");
    }
    let negative = geometry("gear: { teeth: -60, face_width: 20 mm, bore_radius: 30 mm }");
    assert!(negative.contains("only external gears are modelled"), "{negative}");
}
