//! `kind: limit` against closed forms of where a stage refuses, and against a sweep over the same field.

mod messages;

use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI};

use crate::registry::walk::{Ran, load, walk};
use studygraph::table::data::{Data, Table};

const PAIR: &str = "
  pair:
    kind: geometry
    module: 3 mm
    pinion: { teeth: 19, face_width: 20 mm, bore_radius: 14 mm }
    gear: { teeth: 48, face_width: 20 mm, bore_radius: 38 mm }
";
const DESIGNS: &str = "
  designs:
    kind: modification
    pair: pair
    designs: { relieved: [{ tip_relief: { gear: pinion, amount: 8 um, length: 4 mm } }] }
";

fn study(stages: &[&str]) -> String {
    format!("study: t\ntitle: T\nseed: 3\nstages:{}", stages.concat())
}

/// The limits of a stage that varies these.
fn limit(of: &str, vary: &str, more: &str) -> String {
    format!("  limit:\n    kind: limit\n    of: {of}\n    vary: {vary}\n    {more}\n")
}

fn ran(stages: &[&str]) -> BTreeMap<String, Ran> {
    walk(&load(&study(stages)))
}

fn table<'r>(ran: &'r BTreeMap<String, Ran>, stage: &str, name: &str) -> &'r Table {
    ran[stage].tables.iter().find(|table| table.name() == name).unwrap()
}

/// Lower and upper end of a parameter: its value, and why it goes no further.
fn ends(ran: &BTreeMap<String, Ran>, parameter: &str) -> [(f64, Option<String>); 2] {
    let (limits, admitted) = (table(ran, "limit", "limits"), table(ran, "limit", "admitted"));
    let Some(Data::Flag(refused)) = limits.column("refused") else { panic!("a flag") };
    ["lower", "upper"].map(|side| {
        let is_it = |row: &usize| limits.texts("parameter")[*row] == parameter && limits.texts("side")[*row] == side;
        let row = (0..limits.rows()).find(is_it).unwrap();
        let beside = admitted.texts("side").iter().position(|other| other == side).unwrap();
        let (value, reason) = (limits.floats("value")[row], limits.texts("reason")[row].clone());
        assert_eq!(value.to_bits(), admitted.floats(parameter)[beside].to_bits());
        assert_eq!(refused[row], !reason.is_empty());
        (value, refused[row].then_some(reason))
    })
}

/// That an end is where a closed form has it, for a reason.
fn is_at(end: &(f64, Option<String>), value: f64, words: &str) {
    let (found, reason) = end;
    let reason = reason.as_deref().unwrap_or("nothing");
    assert!((found - value).abs() <= 1e-11 * value.abs(), "{found} is not {value}: {reason}");
    assert!(reason.contains(words), "{reason}");
}

/// Reference, base, tip and root radii in mm of gears without profile shift, of module 3 mm.
fn radii(teeth: f64) -> [f64; 4] {
    let r = 1.5 * teeth;
    [r, r * libm::cos(PI / 9.0), r + 3.0, r - 3.75]
}

fn along(tip: f64, base: f64) -> f64 {
    (tip * tip - base * base).sqrt()
}

/// Tier: closed form; a relief can be as long as the active flank along the line of action, √(r_a1² − r_b1²) +
/// √(r_a2² − r_b2²) − a sin α, which the stage that refuses it says too. A report compares it with a length in any unit.
#[test]
fn the_longest_relief_is_the_active_flank() {
    let [[r1, b1, a1, _], [r2, b2, a2, _]] = [19.0, 48.0].map(radii);
    let longest = along(a1, b1) + along(a2, b2) - (r1 + r2) * libm::sin(PI / 9.0);
    let vary = "{ length: { field: \"designs.designs.relieved[0].tip_relief.length\", from: 0 mm, to: 40 mm } }";
    let row = format!(
        "  report:
    kind: report
    published:
      - {{ label: Longest relief, cell: \"limit.admitted[side=upper].length\", value: {:.3} um }}\n",
        1e3 * longest
    );
    let found = ran(&[PAIR, DESIGNS, &limit("designs", vary, ""), &row]);
    let [lower, upper] = ends(&found, "length");
    is_at(&upper, longest, "modification: design `relieved`, tip_relief: the relief starts");
    // Told from what is refused, a share of 1e-12 beyond.
    let said = upper.1.unwrap();
    let flank = said.split_once("the active flank is ").unwrap().1.split_once(" mm long").unwrap().0;
    assert!((flank.parse::<f64>().unwrap() / longest - 1.0).abs() < 1e-12, "{said}");
    assert_eq!(lower, (0.0, None));
    let verdicts = table(&found, "report", "verdicts");
    assert_eq!(verdicts.texts("verdict")[0], "reproduced", "{:?}", verdicts.floats("computed"));
}

/// Tier: closed form; a bore lies between a thousandth of the root circle and the circle, and the thinnest bore of two that
/// go together is that of the gear whose root is nearer.
#[test]
fn bores_end_at_root_circles() {
    let root = 1.5 * 19.0 - 3.75;
    let vary = "{ bore: { field: pair.pinion.bore_radius, from: 0 mm, to: 60 mm } }";
    let [lower, upper] = ends(&ran(&[PAIR, &limit("pair", vary, "")]), "bore");
    is_at(&upper, root, "geometry: pinion: the bore radius");
    // The stage lets a billionth of it pass, for a bore that went through a table.
    assert!((1e3 * lower.0 / root - 1.0).abs() < 4e-9 && lower.1.unwrap().contains("bore radius"), "{}", lower.0);
    // The gear's bore is at its root, 68.25 mm, when the pinion's is at a quarter of it.
    let vary = "
      bore: { field: pair.pinion.bore_radius, from: 0 mm, to: 60 mm }
      other: { field: pair.gear.bore_radius, follows: 4 * bore }
      shift: { field: pair.pinion.profile_shift, from: -0.5, to: 0.5 }";
    let found = ran(&[PAIR, &limit("pair", vary, "")]);
    is_at(&ends(&found, "bore")[1], 68.25 / 4.0, "geometry: gear: the bore radius");
    // What follows has no end of its own.
    assert_eq!(table(&found, "limit", "admitted").schema().columns.len(), 3);
}

/// Tier: closed form; the tip circle of a pinion ends where the contact ratio is 1, and where it meets the mate's root circle.
#[test]
fn a_tip_circle_ends_at_a_contact_ratio_of_1_and_at_the_mate_s_root() {
    let [[r1, b1, ..], [r2, b2, a2, f2]] = [19.0, 48.0].map(radii);
    let (distance, pitch) = (r1 + r2, 3.0 * PI * libm::cos(PI / 9.0));
    let rest = pitch + distance * libm::sin(PI / 9.0) - along(a2, b2);
    let least = (b1 * b1 + rest * rest).sqrt();
    // Without a value in the study it is looked for from the middle of the bounds.
    let vary = "{ tip: { field: pair.pinion.tip_radius, from: 27 mm, to: 40 mm } }";
    let found = ran(&[PAIR, &limit("pair", vary, "")]);
    let [lower, upper] = ends(&found, "tip");
    is_at(&lower, least, "the contact ratio is");
    is_at(&upper, distance - f2, "clearance");
}

/// Tier: closed form; a tooth is pointed where s_a = 0: (π/2 + 2 x tan α)/z + inv α = inv α_a, with cos α_a = r_b/r_a. Second
/// method: bisection of that equation.
#[test]
fn a_profile_shift_ends_at_a_pointed_tooth() {
    let alone = "
  alone: { kind: geometry, module: 3 mm, pinion: { teeth: 12, face_width: 20 mm, bore_radius: 5 mm } }
";
    let angle = PI / 9.0;
    let involute = |angle: f64| libm::tan(angle) - angle;
    let thickness = |shift: f64| {
        let (tip, base) = (3.0 * (6.0 + 1.0 + shift), 18.0 * libm::cos(angle));
        (FRAC_PI_2 + 2.0 * shift * libm::tan(angle)) / 12.0 + involute(angle) - involute(libm::acos(base / tip))
    };
    let (mut low, mut high) = (0.0, 2.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if thickness(middle) > 0.0 { low = middle } else { high = middle }
    }
    let vary = "{ shift: { field: alone.pinion.profile_shift, from: -1, to: 2 } }";
    let [lower, upper] = ends(&ran(&[alone, &limit("alone", vary, "")]), "shift");
    is_at(&upper, low, "the teeth are pointed");
    assert_eq!(lower, (-1.0, None));
}

/// Tier: closed form; with `interference: refuse` the mate's tip ends where it touches the pinion's form circle, which the
/// straight flank of the rack reaches: r sin α − (h_fP − ρ_fP (1 − sin α)) m/sin α along the line of action.
#[test]
fn interference_ends_at_the_form_circle() {
    let pair = PAIR.replace("    pinion:", "    interference: refuse\n    pinion:");
    let [[r1, ..], [r2, b2, ..]] = [19.0, 48.0].map(radii);
    let (sine, tip_radius) = (libm::sin(PI / 9.0), 0.38);
    let form = r1 * sine - 3.0 * (1.25 - tip_radius * (1.0 - sine)) / sine;
    let reach = (r1 + r2) * sine - form;
    let vary = "{ tip: { field: pair.gear.tip_radius, from: 74 mm, to: 76 mm } }";
    let pair = pair
        .replace("    interference", "    rack: { addendum: 1.0, dedendum: 1.25, tip_radius: 0.38 }\n    interference");
    let [_, upper] = ends(&ran(&[&pair, &limit("pair", vary, "")]), "tip");
    is_at(&upper, (b2 * b2 + reach * reach).sqrt(), "interference");
}

/// Tier: limit; a mate of very many teeth is a rack, whose tip is where the straight flank of the tool ends: the pair is
/// refused from the least profile shift without undercut on, x_min = h_a0* − z sin² α/2 with h_a0* = h_fP* − ρ_fP* (1 − sin α),
/// and nearer to it the more teeth the mate has.
#[test]
fn against_a_rack_interference_begins_with_undercut() {
    let sine = libm::sin(PI / 9.0);
    let least = 1.25 - 0.38 * (1.0 - sine) - 6.0 * sine * sine;
    let below = |teeth: u32| {
        let pair = format!(
            "
  pair:
    kind: geometry
    module: 3 mm
    rack: {{ addendum: 1.0, dedendum: 1.25, tip_radius: 0.38 }}
    interference: refuse
    pinion: {{ teeth: 12, face_width: 20 mm, bore_radius: 5 mm, profile_shift: 0.4 }}
    gear: {{ teeth: {teeth}, face_width: 20 mm, bore_radius: 20 mm, profile_shift: -0.4 }}
"
        );
        let vary = "
      shift: { field: pair.pinion.profile_shift, from: 0, to: 0.5 }
      other: { field: pair.gear.profile_shift, follows: -shift }";
        let [lower, _] = ends(&ran(&[&pair, &limit("pair", vary, "")]), "shift");
        assert!(lower.1.unwrap().contains("interference"));
        least - lower.0
    };
    // The distance falls as the curvature of the mate does.
    let found = [1000, 10_000].map(below);
    assert!(found[1] > 0.0 && found[1] < 3e-4 && (9.0..12.0).contains(&(found[0] / found[1])), "{found:?}");
}

/// Tier: closed form; tooth numbers are whole. The bore of 14 mm needs a root circle above it, m(z/2 − 1.25) > 14 mm.
#[test]
fn tooth_numbers_are_whole() {
    let alone = "
  alone: { kind: geometry, module: 3 mm, pinion: { teeth: 30, face_width: 20 mm, bore_radius: 14 mm } }
";
    let vary = "{ teeth: { field: alone.pinion.teeth, from: 4, to: 200 } }";
    let [lower, upper] = ends(&ran(&[alone, &limit("alone", vary, "probes: 5")]), "teeth");
    assert_eq!((lower.0, upper), (12.0, (200.0, None)));
    assert!(lower.1.unwrap().contains("below the root radius 12.75 mm"));
}

/// Tier: closed form; what follows must be whole where its field is: 1.5 times an odd number of teeth is none, the study's 19 too.
#[test]
fn what_follows_is_whole_where_its_field_is() {
    let vary = "
      teeth: { field: pair.pinion.teeth, from: 18, to: 22 }
      other: { field: pair.gear.teeth, follows: 1.5 * teeth }";
    let pair = PAIR.replace("bore_radius: 38 mm", "bore_radius: 10 mm");
    let [lower, upper] = ends(&ran(&[&pair, &limit("pair", vary, "")]), "teeth");
    assert_eq!((lower, upper.0), ((18.0, None), 18.0));
    assert_eq!(upper.1.unwrap(), "`other` would be 2.85e1, which `pair.gear.teeth` cannot be");
}

/// Tier: second method; rows of a sweep over the same field have numbers inside of the ends and the same reasons beyond them.
#[test]
fn a_sweep_is_refused_beyond_the_same_ends() {
    let stiffness = "  stiffness: { kind: stiffness, pair: pair, method: iso6336 }\n";
    let vary = "{ shift: { field: pair.pinion.profile_shift, from: -1.5, to: 2.5 } }";
    let sweep = "  sweep:
    kind: sweep
    of: stiffness
    vary: { shift: { field: pair.pinion.profile_shift, from: -1.5, to: 2.5, count: 161 } }
    outputs: [single_max]
";
    let found = ran(&[PAIR, stiffness, &limit("stiffness", vary, ""), sweep]);
    let [lower, upper] = ends(&found, "shift");
    assert!(lower.1.is_some() && upper.1.is_some());
    let rows = table(&found, "sweep", "rows");
    let mut counts = [0; 2];
    for (shift, reason) in rows.floats("shift").iter().zip(rows.texts("reason")) {
        let is_inside = lower.0 <= *shift && *shift <= upper.0;
        assert_eq!(reason.is_empty(), is_inside, "{shift}: {reason}");
        counts[usize::from(is_inside)] += 1;
    }
    assert!(counts[0] > 10 && counts[1] > 40, "{counts:?}");
}

/// Invariant: what is refused and what it must be are not the same text, a share of 1e-12 apart.
#[test]
fn a_reason_has_the_digits_that_tell_it_from_the_limit() {
    let of_pair = "{ bore: { field: pair.pinion.bore_radius, from: 1 mm, to: 40 mm }, \
        addendum: { field: pair.rack.addendum, from: 0.2, to: 2 }, tip: { field: pair.rack.tip_radius, from: 0, to: 1 } }";
    let of_designs = "{ length: { field: \"designs.designs.relieved[0].tip_relief.length\", from: 1 mm, to: 40 mm }, \
        amount: { field: \"designs.designs.relieved[0].tip_relief.amount\", from: 1 um, to: 4 mm } }";
    let found = [ran(&[PAIR, &limit("pair", of_pair, "")]), ran(&[PAIR, DESIGNS, &limit("designs", of_designs, "")])];
    let numbers = |reason: &str, before: &str| -> f64 {
        let (_, rest) = reason.split_once(before).unwrap_or_else(|| panic!("{before} is not in: {reason}"));
        let end = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len());
        rest[..end].trim_end_matches('.').parse().unwrap()
    };
    for (of, parameter, side, refused, must_be, is_below) in [
        (0, "bore", 1, "bore radius is ", "root radius ", false),
        (0, "addendum", 0, "contact ratio is ", "must be above ", true),
        (0, "addendum", 1, "at a radius of ", "form radius ", true),
        (0, "addendum", 1, "the mate's tip (", "must be at most ", false),
        (0, "tip", 1, "tip radius is ", "0 to ", false),
        (1, "length", 1, "relief starts ", "active flank is ", false),
        (1, "amount", 1, "would lose ", "may take 0 to ", false),
    ] {
        let (_, reason) = &ends(&found[of], parameter)[side];
        let reason = reason.as_deref().unwrap();
        let [refused, must_be] = [numbers(reason, refused), numbers(reason, must_be)];
        assert!(if is_below { refused < must_be } else { refused > must_be }, "{reason}");
    }
}
