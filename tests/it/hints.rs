//! What messages offer: no name and no number that means something else than what was written.
//!
//! Every field of every kind, with words before and behind its name, and with units that it does not have.

mod meanings;

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

/// Messages of a whole study; every part that is given stands in the place of the usual one.
struct Given<'a> {
    geometry: &'a str,
    pinion: &'a str,
    stiffness: &'a str,
    design: &'a str,
    ste: &'a str,
}

const USUAL: Given = Given { geometry: "", pinion: "", stiffness: "", design: "", ste: "torque: 100 N m" };

fn whole(given: &Given) -> String {
    let Given { geometry, pinion, stiffness, design, ste } = given;
    let text = format!(
        "study: hints\nstages:\n  pair:\n    kind: geometry\n    module: 2 mm\n    {geometry}\n    \
         pinion: {{ teeth: 20, face_width: 20 mm, bore_radius: 10 mm, {pinion} }}\n    \
         gear: {{ teeth: 60, face_width: 20 mm, bore_radius: 30 mm }}\n  \
         stiffness: {{ kind: stiffness, pair: pair, {stiffness} }}\n  \
         designs: {{ kind: modification, pair: pair, designs: {{ plain: [{design}] }} }}\n  \
         ste: {{ kind: ste, stiffness: stiffness, designs: designs, {ste} }}\n"
    );
    program::load_text(&text, Path::new("hints.yaml")).map_or_else(|error| error.to_string(), |_| String::new())
}

/// Every text of `has` is in the message, and none of `lacks`.
fn says(said: &str, written: &str, has: &[&str], lacks: &[&str]) {
    assert!(has.iter().all(|part| said.contains(part)), "{written} lacks one of {has:?}: {said}");
    assert!(!lacks.iter().any(|part| said.contains(part)), "{written} has one of {lacks:?}: {said}");
}

/// Tier: closed form; both numbers of an interval count in the module, and no help is refused in its turn.
#[test]
fn intervals_of_lengths_are_offered_in_modules() {
    for (text, has) in [
        ("0.4 mm ± 0.02 mm", "write `0.2 ± 0.01`"),
        ("0.4 mm ± 20 um", "write `0.2 ± 0.01`"),
        ("0.4 ± 0.02 mm", "write `0.2 ± 0.01`, or `0.4 ± 0.01`"),
        ("0.4 mm ± 0.02", "write `0.2 ± 0.01`, or `0.2 ± 0.02`"),
        ("0.4 mm ± 5 %", "write `0.2 ± 0.01`"),
        ("0.02 in ± 0.001 in", "write `0.254 ± 0.0127`"),
        ("0.4 +/- 0.02 m", "for 0.4 ± 0.02 times the module write `0.4 ± 0.02`"),
        ("0.4(2) mm", "write `0.2 ± 0.1`"),
        ("0.4 mm +0.02 -0.01", "as wide to both sides"),
        ("0.4 +0.02/-0.01 mm", "as wide to both sides"),
        ("1 deg ± 0.1 deg", "another quantity"),
    ] {
        let said = whole(&Given { pinion: &format!("profile_shift: {text}"), ..USUAL });
        says(&said, text, &[has], &["write `0.01`", "write `0.4 mm", "write `0.0127`"]);
    }
    let without = geometry("rack: { addendum: 2 mm ± 0.05 mm }").replace("module: 2 mm", "");
    says(&without, "addendum", &["write `1 ± 0.025`"], &[]);
    for (text, number) in [("0,4 mm", "0.2"), ("0.3*m", "0.3"), ("0.3 m_n", "0.3"), ("0.3 modules", "0.3")] {
        let said = whole(&Given { pinion: &format!("profile_shift: {text}"), ..USUAL });
        says(&said, text, &[&format!("write `{number}`")], &["write `0.3 m`", "write `0.4 mm`"]);
    }
}

/// Tier: closed form; T = P/(2 pi n) and T = F d/2, with the numbers of the study.
#[test]
fn another_quantity_has_the_rule_that_leads_to_the_field() {
    for (ste, has) in [
        ("torque: 10 kW", "T = P/(2 pi n), n in revolutions per second"),
        ("torque: 10 hp", "T = P/(2 pi n)"),
        ("torque: [10 kW, 20 kW]", "T = P/(2 pi n)"),
        ("torque: 10 kW, speed: 1500 rpm", "write `torque: 63.66198 N m`"),
        ("torque: 10 kW, friction: { law: { constant: { coefficient: 0.05 } }, speed: 1500 rpm }", "63.66198 N m"),
        ("power: 10 kW", "n in revolutions per second"),
        ("torque: 5 kN", "write `torque: 100 N m`"),
        ("load: 5 kN", "T = F_t d1/2"),
        ("torque: 200 N/mm", "face width"),
        ("torque: 100 Nmm2", "known here: `N m`, `N mm`"),
        ("torque: 100 N m^2", "a quantity in m^3 kg s^-2"),
    ] {
        let said = whole(&Given { ste, ..USUAL });
        says(&said, ste, &[has], &["is a quantity;", "which is a quantity;", "of another kind"]);
    }
}

/// Tier: invariant; where a word means another thing in another mapping it is answered there by what it means there.
#[test]
fn words_mean_what_they_mean_where_they_stand() {
    for (geometry, has, lacks) in [
        ("rack: { root_radius: 0.38 }", "`tip_radius`: the fillet", "in another place"),
        ("rack: { fillet_radius: 0.38 }", "`tip_radius`: the fillet", "in another place"),
        ("rack: { tip_diameter: 44 mm }", "known here", "half of"),
        ("rack: { d_a: 44 mm }", "known here", "half of"),
        ("rack: { clearance: 0.25 }", "`dedendum`", "in another place"),
        ("addendum: 1.0", "`rack`", "did you mean"),
        ("basic_rack: A", "`rack`", "did you mean"),
        ("rack: { haP: 1.0 }", "called `addendum`", ""),
        ("AGMA: 10", "the other way", "did you mean"),
        ("Achsabstand: 90 mm", "called `centre_distance`", ""),
        ("Flankenspiel: 0.1 mm", "allowances", ""),
        ("tip_relief: 20 um", "`kind: modification`", ""),
        ("contact_ratio: 1.5", "follows", ""),
        ("pressure_angle: 20 grad", "write `deg`", "`rad`?"),
        ("pressure_angle: 20°30'", "write `20.5 deg`", ""),
        ("material: { density: 7.85 }", "for example `7830 kg/m^3`", "`7.85 kg/m^3`"),
        ("material: { E: 210 }", "called `youngs_modulus`", ""),
        ("material: { E-Modul: 210 GPa }", "called `youngs_modulus`", ""),
        ("module: 8 DP", "diametral pitch", ""),
    ] {
        let said = match geometry.strip_prefix("module: ") {
            Some(module) => whole(&Given { geometry: &format!("centre_distance: {module}"), ..USUAL }),
            None => whole(&Given { geometry, ..USUAL }),
        };
        says(&said, geometry, &[has], if lacks.is_empty() { &[] } else { std::slice::from_ref(&lacks) });
    }
    for (pinion, has, lacks) in [
        ("da: 44 mm", "write `22 mm`", ""),
        ("Kopfkreisdurchmesser: 44 mm", "write `22 mm`", ""),
        ("df: 35 mm", "d_f = m(z + 2 x - 2 h_fP*)", ""),
        ("db: 37.6 mm", "d_b = d cos(alpha)", ""),
        ("d: 40 mm", "d = m z", ""),
        ("rho_fP: 0.38", "`rack`", "called `tip_radius`"),
        ("fillet_radius: 0.38", "`rack`", "called `tip_radius`"),
        ("Profilverschiebung: 0.6 mm", "write `0.3`", ""),
        ("k: -0.1", "write `0.1`", "called `tip_shortening`"),
        ("Kopfhöhenänderung: -0.2 mm", "write `0.1`", "called `tip_shortening`"),
        ("Kopfkürzung: 0.2 mm", "write `0.1`", ""),
        ("Profilverschiebungsfaktor: 0.3", "called `profile_shift`", ""),
        ("Schrägungswinkel: 15 deg", "spur gears only", ""),
        ("crowning: 10 um", "`kind: modification`", "did you mean"),
        ("Kopfrücknahme: 20 um", "`tip_relief`", ""),
        ("rim_thickness: 5 mm", "`bore_radius`", "here it is called"),
        ("W_k: 15.3 mm", "`tooth_thickness`", ""),
        ("tooth_thickness: 3.1 mm", "takes fields, not a number", "unknown name"),
    ] {
        let said = whole(&Given { pinion, ..USUAL });
        says(&said, pinion, &[has], if lacks.is_empty() { &[] } else { std::slice::from_ref(&lacks) });
    }
    for (design, has, lacks) in [
        ("crowning: { gear: pinion, amount: 10 um }", "did you mean `profile_crowning` or `lead_crowning`?", ""),
        ("relief: { gear: pinion, amount: 10 um }", "`root_relief`", "did you mean `tip_relief`?"),
        ("Kopfrücknahme: { gear: pinion, amount: 10 um, length: 1 mm }", "called `tip_relief`", ""),
        ("Breitenballigkeit: { gear: pinion, amount: 10 um }", "called `lead_crowning`", ""),
        ("tip_relief: { gear: pinion, c_beta: 10 um, length: 1 mm }", "`lead_crowning`", "called `amount`"),
        ("tip_relief: { gear: wheel, amount: 10 um, length: 1 mm }", "called `gear`", ""),
        ("tip_relief: { gear: pinion, amount: 20 um, start_radius: 21 mm }", "write `42 mm`", ""),
        ("tip_relief: { gear: pinion, amount: 0.02, length: 1 mm }", "`0.02 mm`", "`0.02 um`"),
    ] {
        let said = whole(&Given { design, ..USUAL });
        says(&said, design, &[has], if lacks.is_empty() { &[] } else { std::slice::from_ref(&lacks) });
    }
    for (stiffness, has) in [
        ("method: FEM", "called `finite_element`"),
        ("method: potential_energy", "called `energy`"),
        ("c_gamma: 20 N/(mm um)", "is computed"),
    ] {
        says(&whole(&Given { stiffness, ..USUAL }), stiffness, &[has], &[]);
    }
    for (ste, has) in [
        ("Drehmoment: 100 Nm", "called `torque`"),
        ("Leistung: 10 kW, Drehzahl: 1500 rpm", "write `torque: 63.66198 N m`"),
        ("misalignment: 10 um", "helix_slope"),
        ("fpt: 10 um", "pitch deviations"),
        ("inertia: 0.1 kg m^2", "at rest"),
    ] {
        says(&whole(&Given { ste: &format!("{ste}, torque: 100 N m"), ..USUAL }), ste, &[has], &[]);
    }
}
