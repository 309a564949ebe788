//! Remedies for intervals, places of fields, and composed words: each keeps the meaning of the text in the study.

use super::{Given, USUAL, geometry, says, whole};

/// Tier: closed form; what is done to a number is done to half the width of its interval, or no number is offered.
#[test]
fn remedies_of_intervals_have_both_numbers() {
    for (pinion, has) in [
        ("da: 44 mm ± 0.1 mm", "write `22 mm ± 0.05 mm`"),
        ("da: 44 ± 0.1 mm", "write `22 mm ± 0.05 mm`"),
        ("da: 44(1) mm", "write `22 mm ± 0.5 mm`"),
        ("Kopfkreis: 2 in ± 0.01 in", "write `25.4 mm ± 0.127 mm`"),
        ("k: -0.1 ± 0.01", "write `0.1 ± 0.01`"),
        ("k: -0.2 mm ± 0.02 mm", "write `0.1 ± 0.01`"),
        ("Kopfkürzung: 0.2 mm ± 0.02 mm", "write `0.1 ± 0.01`"),
        ("tip_radius: 1 ± 0.01 inch", "write `25.4 mm ± 0.254 mm`: 1 inch is 25.4 mm"),
        ("tip_radius: 22 mm ± 0.01 inch", "write `22 mm ± 0.254 mm`"),
        ("tip_radius: 1 in ± 0.1 mm", "write `25.4 mm ± 0.1 mm`"),
        ("tip_radius: 022 ± 0.1 mm", "write `22 ± 0.1 mm`, without zeros in front"),
        ("tip_radius: 22 ± 00.1 mm", "write `22 ± 0.1 mm`"),
        ("tip_radius: 1_000 ± 5 mm", "write `1000 ± 5 mm`"),
        ("tip_radius: 22 ± 0.1", "`22 ± 0.1` has no unit; a length is expected, for example `22 ± 0.1 mm`"),
        ("material: { density: 7.85 ± 0.01 g/cm^3 }", "write `7850 kg/m^3 ± 10 kg/m^3`"),
        ("material: { youngs_modulus: 206000 ± 1000 N/mm2 }", "write `206000 N/mm^2 ± 1000 N/mm^2`"),
        ("material: { youngs_modulus: 206 ± 1 kN/mm mm }", "write `206 kN/(mm mm) ± 1 kN/(mm mm)`"),
    ] {
        says(&whole(&Given { pinion, ..USUAL }), pinion, &[has], &["not one of a list"]);
    }
    let start = "tip_relief: { gear: pinion, amount: 20 um, start_radius: 21 mm ± 0.1 mm }";
    says(&whole(&Given { design: start, ..USUAL }), start, &["write `42 mm ± 0.2 mm`"], &[]);
    let minutes = "pressure_angle: 20°30' ± 3'";
    says(&geometry(minutes), minutes, &["write `20.5 deg ± 0.05 deg`"], &[]);
    let renamed = whole(&Given { pinion: "material: { E: 206 ± 1 GPa }", ..USUAL });
    says(&renamed, "E", &["called `youngs_modulus`"], &["not one of a list"]);
    // A share of the number, a reciprocal, and a field that takes no interval.
    for (given, rule) in [
        (Given { pinion: "da: 44 mm ± 5 %", ..USUAL }, "half of the diameter"),
        (Given { geometry: "diametral_pitch: 8 ± 0.1", ..USUAL }, "25.4 mm over"),
        (Given { ste: "gear_torque: 300 ± 3 N m", ..USUAL }, "T_gear z1/z2"),
        (Given { ste: "power: 10 kW ± 1 kW, speed: 1500 rpm", ..USUAL }, "P/(2 pi n)"),
        (Given { ste: "power: 10 kW, speed: 1500 ± 10 rpm", ..USUAL }, "P/(2 pi n)"),
        (Given { ste: "torque: 5 ± 1 kN", ..USUAL }, "F_t d1/2"),
        (
            Given {
                ste: "power: 10 kW, friction: { law: { constant: { coefficient: 0.05 } }, speed: 1500 ± 10 rpm }",
                ..USUAL
            },
            "P/(2 pi n)",
        ),
    ] {
        says(&whole(&given), rule, &[rule], &["write `"]);
    }
}

/// Tier: invariant; a general word means something by its mapping, and is not answered with another mapping that has it.
#[test]
fn no_place_of_another_meaning_is_offered() {
    for design in [
        "helix_slope: { gear: pinion, angle: 1 deg }",
        "helix_slope: { gear: pinion, height: 1 um }",
        "lead_crowning: { gear: pinion, radius: 1 m }",
        "lead_crowning: { gear: pinion, size: 1 mm }",
        "profile_crowning: { gear: pinion, diameter: 44 mm }",
        "profile_crowning: { gear: pinion, offset: 1 mm }",
    ] {
        says(&whole(&Given { design, ..USUAL }), design, &["known here: "], &["belongs in", "did you mean"]);
    }
    for (given, has) in [
        (Given { geometry: "angle: 20 deg", ..USUAL }, "did you mean `pressure_angle`?"),
        (Given { geometry: "addendum: 1.0", ..USUAL }, "`addendum` belongs in `rack`"),
        (Given { geometry: "density: 7830 kg/m^3", ..USUAL }, "`density` belongs in `material`"),
        (Given { pinion: "chamfer: { size: 0.2 mm }", ..USUAL }, "`chamfer` belongs in `tip`"),
        (Given { ste: "torque: 100 N m, viscosity: 100 mPa s", ..USUAL }, "`friction.law."),
        (Given { design: "helix_slope: { gear: pinion, bore_radius: 9 mm }", ..USUAL }, "of `kind: geometry`"),
    ] {
        says(&whole(&given), has, &[has], &["semi_topping", "tangent_arc", "spread"]);
    }
}

/// Tier: invariant; a name that a study has elsewhere is no slip of the pen for a name of other words, or for what it qualifies.
#[test]
fn no_field_is_taken_for_a_slip_of_another_one() {
    for (given, lacks) in [
        (Given { pinion: "pinion_cutter: { teeth: 20, dedendum: 1.25 }", ..USUAL }, "did you mean `addendum`"),
        (Given { ste: "torque: 100 N m, load: 5 kN", ..USUAL }, "did you mean `in_load_balance`"),
        (Given { ste: "torque: 100 N m, friction: { load: 5 kN }", ..USUAL }, "did you mean `in_load_balance`"),
    ] {
        says(&whole(&given), lacks, &["unknown field"], &[lacks]);
    }
    let singular = whole(&Given { stiffness: "slices: 3", ste: "torque: 100 N m, position: 64", ..USUAL });
    says(&singular, "position", &["did you mean `positions`?"], &[]);
}

/// Tier: closed form; words that are made of a gear and a quantity, in English and in German.
#[test]
fn composed_words_of_the_trade_have_a_remedy() {
    for word in [
        "abtriebsmoment",
        "Abtriebsdrehmoment",
        "raddrehmoment",
        "Radmoment",
        "Lastmoment",
        "torque_on_gear",
        "torque_on_wheel",
        "torque_at_gear",
        "torque_of_gear",
    ] {
        let said = whole(&Given { ste: &format!("{word}: 300 N m"), ..USUAL });
        says(&said, word, &["T_pinion = T_gear z1/z2; with 20 and 60 teeth write `torque: 100 N m`"], &["known here"]);
    }
    for word in ["torque_on_pinion", "Ritzelmoment", "Ritzeldrehmoment", "Antriebsmoment", "Antriebsdrehmoment"] {
        says(&whole(&Given { ste: &format!("{word}: 100 N m"), ..USUAL }), word, &["called `torque`: that on"], &[]);
    }
    for word in
        ["output_power", "driven_power", "transmitted_power", "Abtriebsleistung", "Antriebsleistung", "Nennleistung"]
    {
        let said = whole(&Given { ste: &format!("{word}: 10 kW, speed: 1500 rpm"), ..USUAL });
        says(&said, word, &["write `torque: 63.66198 N m`"], &["known here"]);
    }
    for word in ["innenrad", "Innenverzahnung", "Planetenrad", "Sonnenrad", "internal_teeth", "sun_gear", "planet_gear"]
    {
        says(&geometry(&format!("{word}: true")), word, &["external gears only"], &["known here"]);
    }
    let friction = "torque: 100 N m, friction: { law: { constant: { coefficient: 0.05 } }";
    for (word, has) in [
        ("Antriebsdrehzahl", "called `speed`"),
        ("Ritzeldrehzahl", "called `speed`"),
        ("Abtriebsdrehzahl", "n_pinion = n_gear z2/z1"),
        ("Raddrehzahl", "n_pinion = n_gear z2/z1"),
        ("speed_of_gear", "n_pinion = n_gear z2/z1"),
    ] {
        let said = whole(&Given { ste: &format!("{friction}, {word}: 1500 rpm }}"), ..USUAL });
        says(&said, word, &[has], &["known here"]);
    }
}
