//! Inputs that were printed rounded, `0.504 ± 0.0005`: what the rows of a report say of the values inside. Against closed forms, whole
//! studies at the ends, and a fit that looks for such a value.

use std::collections::BTreeMap;
use std::path::Path;

use crate::desk::Desk;
use crate::registry::walk::{Ran, load, walk};
use declare::digest::{Digest, Writer};
use declare::record::varied::Varied;
use gearstudy::program;
use studygraph::study::Study;
use studygraph::study::settings::Shown;
use studygraph::table::data::Table;

const PAIR: &str = "
  pair:
    kind: geometry
    module: 3 mm
    pressure_angle: 20 deg
    material: { youngs_modulus: 206 GPa, poisson_ratio: 0.3 }
    pinion: { teeth: 19, profile_shift: 0.21, face_width: 20 mm, bore_radius: 14.079 mm }
    gear: { teeth: 48, face_width: 20 mm, bore_radius: 38.823 mm }
";
const STE: &str = "
  stiffness: { kind: stiffness, pair: pair, method: energy, contact: linear, coupling: none }
  designs:
    kind: modification
    pair: pair
    designs: { relieved: [{ tip_relief: { gear: both, amount: 8 um, length: 4 mm, curve: linear } }] }
  ste: { kind: ste, stiffness: stiffness, designs: designs, torque: 50 N m, positions: 16 }
";
const DIAMETER: &str = "\"pair.inspection[gear=pinion].reference_diameter\"";
const THICKNESS: &str = "\"pair.inspection[gear=pinion].tooth_thickness\"";

fn study(stages: &[&str], published: &str) -> String {
    format!("study: t\nseed: 3\nstages:{}  report:\n    kind: report\n    published:\n{published}", stages.concat())
}

fn ran(stages: &[&str], published: &str) -> BTreeMap<String, Ran> {
    walk(&load(&study(stages, published)))
}

fn table<'r>(ran: &'r BTreeMap<String, Ran>, stage: &str, name: &str) -> &'r Table {
    ran[stage].tables.iter().find(|table| table.name() == name).unwrap()
}

fn verdicts(ran: &BTreeMap<String, Ran>) -> &Table {
    table(ran, "report", "verdicts")
}

/// The least and the largest value of a row.
fn range(table: &Table, row: usize) -> [f64; 2] {
    [table.floats("least")[row], table.floats("largest")[row]]
}

fn row(cell: &str, value: &str) -> String {
    format!("      - {{ cell: {cell}, value: {value} }}\n")
}

/// m (π/2 + 2 x tan 20°) \[mm\]
fn thickness(module: f64, shift: f64) -> f64 {
    module * (std::f64::consts::FRAC_PI_2 + 2.0 * shift * libm::tan(20_f64.to_radians()))
}

fn assert_near(found: [f64; 2], expected: [f64; 2], what: &str) {
    let is_near = |(one, other): (f64, f64)| (one - other).abs() <= 1e-12 * other.abs();
    assert!(found.into_iter().zip(expected).all(is_near), "{what}: {found:?} is not {expected:?}");
}

/// The pair with a module and a profile shift that were printed rounded.
fn rounded() -> String {
    PAIR.replace("module: 3 mm", "module: 3 ± 0.005 mm").replace("shift: 0.21", "shift: 0.21 ± 0.005")
}

/// Tier: closed form; what is linear in one input, a product of two, a quotient whose ends are at other corners, and what is least
/// in the middle. And what no interval changes has no range.
#[test]
fn the_range_of_a_row_is_that_of_its_closed_form() {
    let quotient = "      - { formula: s / d, with: { s: THICKNESS, d: DIAMETER }, value: \"0.1\" }\n";
    let square = "      - { formula: \"(d / d_0 - 1)^2\", with: { d: DIAMETER, d_0: 57 mm }, value: \"0\" }\n";
    let published = [
        row(DIAMETER, "57.0 mm"),
        row(THICKNESS, "5.17 mm"),
        quotient.replace("THICKNESS", THICKNESS).replace("DIAMETER", DIAMETER),
        square.replace("DIAMETER", DIAMETER),
        "      - { formula: \"2 * z\", with: { z: \"pair.gears[gear=pinion].teeth\" }, value: \"38\" }\n".to_owned(),
    ];
    let found = ran(&[&rounded()], &published.concat());
    let table = verdicts(&found);
    let (low, high) = ((2.995, 0.205), (3.005, 0.215));
    assert_near(range(table, 0), [19.0 * low.0, 19.0 * high.0], "a diameter");
    assert_near(range(table, 1), [thickness(low.0, low.1), thickness(high.0, high.1)], "a thickness");
    // The module cancels.
    assert_near(range(table, 2), [thickness(1.0, low.1) / 19.0, thickness(1.0, high.1) / 19.0], "a quotient");
    let [least, largest] = range(table, 3);
    assert!(least == table.floats("computed")[3] && least < 1e-20, "{least}");
    assert!((largest / (0.005_f64 / 3.0).powi(2) - 1.0).abs() < 1e-9, "{largest}");
    assert!(range(table, 4).into_iter().all(f64::is_nan) && table.texts("rounding")[4].is_empty());
    assert_eq!(
        table.texts("rounding")[0],
        "56.905 to 57.095\u{202f}mm over the rounded inputs; as stated they reproduce it"
    );
}

/// Tier: closed form; a stage that stands inside a formula alone, after a sign, a bracket or another stage, is computed anew as well.
#[test]
fn stages_inside_formulas_are_found() {
    let other = PAIR.replace("  pair:", "  other:");
    for formula in [
        "2*pair.pair.base_pitch",
        "(pair.pair.base_pitch)*2",
        "other.pair.base_pitch - other.pair.base_pitch + 2*pair.pair.base_pitch",
        "-(-2)*pair.pair.base_pitch",
    ] {
        let published = format!(
            "      []\n    printout:\n      - rows:\n          - {{ label: x, formula: \"{formula}\", value: 17.7 mm, tolerance: 1 mm }}\n"
        );
        let found = ran(&[&rounded(), &other], &published);
        let pitch = |module: f64| 2.0 * std::f64::consts::PI * module * libm::cos(20_f64.to_radians());
        assert_near(range(verdicts(&found), 0), [pitch(2.995), pitch(3.005)], formula);
    }
}

/// Second method: a fit that looks for values inside finds some where the row is reproduced, and none where it is not.
#[test]
fn a_row_is_reproduced_where_a_fit_finds_values_inside() {
    let mut verdict_of = Vec::new();
    for (module, shift) in [(3.004, 0.2149), (2.996, 0.2056), (3.0055, 0.2155), (2.9945, 0.2045)] {
        let wanted = format!("{:.9} mm, tolerance: 1e-6 mm", thickness(module, shift));
        let fit = format!(
            "  fit:\n    kind: fit\n    of: pair\n    vary:\n      shift: {{ field: pair.pinion.profile_shift, within: ± 0.005 }}
      module: {{ field: pair.module, within: ± 0.005 mm }}\n    meet:\n{}    starts: 2\n",
            row(THICKNESS, &wanted)
        );
        // The fit reads the intervals as well, and takes their middles.
        let found = ran(&[&rounded(), &fit], &row(THICKNESS, &wanted));
        let table = verdicts(&found);
        let solutions = self::table(&found, "fit", "summary").integers("solutions")[0];
        let verdict = table.texts("verdict")[0].clone();
        assert_eq!(verdict == "reproduced", solutions > 0, "{wanted}: {verdict}, {solutions} solutions");
        let said =
            if solutions > 0 { "; some value inside reproduces it" } else { "; none found inside reproduces it" };
        assert!(table.texts("rounding")[0].ends_with(said), "{}", table.texts("rounding")[0]);
        verdict_of.push(verdict);
    }
    assert_eq!(verdict_of, ["reproduced", "reproduced", "unexplained", "unexplained"]);
}

/// A reason that the rounding of an input makes needless is told of, one that it does not stands.
#[test]
fn a_reason_that_rounding_replaces_is_outdated() {
    let with = |value: &str| format!("      - {{ cell: {DIAMETER}, value: {value}, because: the paper says so }}\n");
    let found = ran(&[&rounded()], &[with("57.09 mm"), with("57.2 mm")].concat());
    assert_eq!(verdicts(&found).texts("verdict"), ["outdated", "explained"]);
    let counts = table(&found, "report", "verdict_counts");
    assert_eq!(counts.integers("count").iter().sum::<i64>(), 2);
}

fn digest(study: &Study, stage: &str) -> Digest {
    let mut writer = Writer::new("test");
    study.nodes.iter().find(|node| node.name == stage).unwrap().record.write(&mut writer);
    writer.finish()
}

/// Invariant: all that a study computes is computed with the middles, to the last bit; the report alone says more.
#[test]
fn everything_else_is_as_without_intervals() {
    let published = [row("ste.summary.peak_to_peak", "3 um"), row(THICKNESS, "5.2 mm")].concat();
    let (plain, with) = (study(&[PAIR, STE], &published), study(&[&rounded(), STE], &published));
    let (plain, with) = (load(&plain), load(&with));
    for stage in ["pair", "stiffness", "designs", "ste"] {
        assert_eq!(digest(&plain, stage), digest(&with, stage), "{stage}");
    }
    assert_ne!(digest(&plain, "report"), digest(&with, "report"));
    let (plain, with) = (walk(&plain), walk(&with));
    for stage in ["pair", "stiffness", "designs", "ste"] {
        // As text, since no NaN is another; without what says how long it took.
        let text = |ran: &BTreeMap<String, Ran>| {
            let tables = ran[stage].tables.iter().filter(|table| table.name() != "cost");
            tables.map(|table| format!("{table:?}")).collect::<Vec<_>>()
        };
        assert!(text(&plain) == text(&with), "{stage}");
    }
    for column in ["published", "computed", "difference", "tolerance"] {
        assert_eq!(verdicts(&plain).floats(column), verdicts(&with).floats(column), "{column}");
    }
    assert!(verdicts(&plain).floats("least").iter().all(|value| value.is_nan()));
}

/// Second method: a stage that reads the interval from afar comes to what whole studies at its ends come to.
#[test]
fn far_stages_are_those_of_whole_studies_at_the_ends() {
    let cell = "ste.summary.mean";
    let at = |modulus: &str| {
        let pair = PAIR.replace("206 GPa", modulus);
        table(&ran(&[&pair, STE], &row(cell, "3 um")), "ste", "summary").floats("mean")[0]
    };
    let found = ran(&[&PAIR.replace("206 GPa", "206 ± 0.5 GPa"), STE], &row(cell, "3 um"));
    // The stiffer, the less.
    assert_eq!(range(verdicts(&found), 0), [at("206.5 GPa"), at("205.5 GPa")]);
}

/// What a stage refuses at an end is said in the row, and the rest is told all the same.
#[test]
fn a_point_that_is_refused_is_said_in_its_row() {
    // The root circle is 49.5 mm + 2 · 0.21 · 3 mm wide.
    let pair = PAIR.replace("14.079 mm", "23 ± 3 mm").replace("module: 3 mm", "module: 3 ± 0.005 mm");
    let found = ran(&[&pair], &row(DIAMETER, "57.05 mm"));
    let table = verdicts(&found);
    assert_near(range(table, 0), [19.0 * 2.995, 19.0 * 3.005], "a diameter");
    let said = &table.texts("rounding")[0];
    let cut = "some value inside reproduces it · searched only up to `pair.pinion.bore_radius` at 25.3";
    assert!(said.contains(cut), "{said}");
    assert!(said.contains(", above which there is no value: geometry: pinion: the bore radius is "), "{said}");
}

/// Tier: closed form; a formula with a pole at x = 0.2134 takes none of the values between those at the ends of 0.21 ± 0.005 and all
/// beyond, and a refusal inside is approached.
#[test]
fn a_pole_between_the_ends_is_said_in_its_row() {
    let pair = PAIR.replace("shift: 0.21", "shift: 0.21 ± 0.005");
    let pole = |value: &str| {
        format!(
            "      - {{ formula: 1 / (x - 0.2134), with: {{ x: \"pair.gears[gear=pinion].profile_shift\" }}, value: \"{value}\" }}\n"
        )
    };
    let found = ran(&[&pair], &["0.5", "-2000", "-294.1", "-100", "3000"].map(pole).concat());
    let table = verdicts(&found);
    assert_eq!(table.texts("verdict"), ["unexplained", "reproduced", "reproduced", "unexplained", "reproduced"]);
    let said = table.texts("rounding");
    for row in [0, 3] {
        let there = "none found inside reproduces it · inside it is not finite, near what it is with `pair.pinion.profile_shift` at 0.213";
        assert!(said[row].contains(there), "{}", said[row]);
    }
    assert!(
        said[2].ends_with("; as stated they reproduce it") && said[1].ends_with("; some value inside reproduces it")
    );
}

/// Tier: closed form; a saddle, on which each input alone changes nothing, has its range at the corners.
#[test]
fn few_inputs_are_tried_at_all_corners() {
    let saddle = "      - { formula: \"(x - 0.21) * (m / 3 - 1)\", with: { x: \"pair.gears[gear=pinion].profile_shift\", \
                  m: \"pair.gears[gear=pinion].module\" }, value: \"0\" }\n";
    let saddle = saddle.replace("m / 3", "m / m_0").replace("with: { ", "with: { m_0: 3 mm, ");
    let found = ran(&[&rounded()], &saddle);
    let [least, largest] = range(verdicts(&found), 0);
    let exact = 0.005 * 0.005 / 3.0;
    assert!((least / exact + 1.0).abs() < 1e-9 && (largest / exact - 1.0).abs() < 1e-9, "{least:e} {largest:e}");
}

/// One number that stands in two places is the same in both; and what a sweep made of it is held, so that a formula with both has no
/// range.
#[test]
fn an_alias_is_one_number_and_what_is_held_has_no_range() {
    let pair = PAIR.replace("{ teeth: 19, profile_shift: 0.21,", "{ teeth: 19, profile_shift: &x 0.21 ± 0.005,");
    let pair = pair.replace("{ teeth: 48,", "{ teeth: 48, profile_shift: *x,");
    let sweep =
        "  sweep:\n    kind: sweep\n    of: ste\n    vary: { torque: { field: ste.torque, values: [40 N m, 50 N m] } }
    outputs: [peak_to_peak]\n";
    let of = |gear: &str| format!("\"pair.gears[gear={gear}].profile_shift\"");
    let apart =
        format!("      - {{ formula: a - b, with: {{ a: {}, b: {} }}, value: \"0.01\" }}\n", of("pinion"), of("gear"));
    let swept = "\"sweep.rows[torque=50 N m].peak_to_peak\"";
    let mixed = format!(
        "      - {{ formula: a / b, with: {{ a: {swept}, b: \"ste.summary.peak_to_peak\" }}, value: \"0.990\" }}\n"
    );
    let found = ran(&[&pair, STE, sweep], &[apart, mixed, row(swept, "1.000 um")].concat());
    let table = verdicts(&found);
    assert_eq!(table.texts("verdict"), ["unexplained"; 3]);
    assert!(table.floats("least").iter().all(|value| value.is_nan()));
    let said = table.texts("rounding");
    assert!(said[0].is_empty(), "{}", said[0]);
    for row in [1, 2] {
        assert!(said[row].contains("`sweep` is not computed anew"), "{}", said[row]);
    }
}

/// The manifest says of a report which inputs it took for intervals, as the study does, and of every other stage what it computes with.
#[test]
fn the_settings_of_a_report_have_the_intervals() {
    let pair =
        rounded().replace("bore_radius: 14.079 mm", "bore_radius: 14.079 mm ± 1 um").replace("20 deg", "20 ± 0.3 deg");
    let study = load(&study(&[&pair], &row(DIAMETER, "57 mm")));
    let settings = |name: &str| {
        let node = study.nodes.iter().find(|node| node.name == name).unwrap();
        serde_json::to_value(Shown { fields: node.kind.fields, record: &node.record }).unwrap()
    };
    let expected = serde_json::json!({
        "pair.module": "3 ± 0.005 mm",
        "pair.pinion.bore_radius": "14.079 ± 0.001 mm",
        "pair.pinion.profile_shift": "0.21 ± 0.005",
        "pair.pressure_angle": "20 ± 0.3 deg",
    });
    assert_eq!(settings("report")["intervals"], expected);
    assert_eq!(settings("pair")["pinion"]["profile_shift"], 0.21);
    assert_eq!(settings("pair").get("intervals"), None);
}

/// Fields of what is written once and used twice are found in both places; `set` and labels with dots lead there too.
#[test]
fn every_field_is_found() {
    let text = "study: t\nstages:\n  pair:\n    kind: geometry\n    module: 3 mm
    pinion: &wheel { teeth: 24, face_width: 20 mm, bore_radius: 18 ± 0.5 mm }\n    gear: { <<: *wheel, teeth: 36 }
  designs:\n    kind: modification\n    pair: pair
    designs: { v.2: [{ lead_crowning: { gear: pinion, amount: 3 um } }, { tip_relief: { gear: both, amount: 8 ± 0.5 um, length: 4 mm, curve: linear } }] }
  other: { kind: geometry, module: 2 mm ± 5 um, pinion: *wheel, gear: *wheel }
  report:\n    kind: report\n    published:\n      - { cell: \"designs.resolved[design=v.2, gear=pinion, element=2].amount\", value: 8 um }\nset: { pair.module: 3 ± 0.05 mm }\n";
    let study = program::load_text(text, Path::new("t.yaml")).unwrap_or_else(|error| panic!("{error}"));
    let report = study.nodes.iter().find(|node| node.name == "report").unwrap();
    let varied = Varied::intervals(&report.record).unwrap();
    let paths: Vec<&str> = varied.axes.iter().map(|axis| axis.path.as_str()).collect();
    let own = "designs.designs.v.2[1].tip_relief.amount";
    assert_eq!(paths, ["pair.module", "pair.pinion.bore_radius", "pair.gear.bore_radius", own]);
    let stages: Vec<&str> = varied.stages.iter().map(|stage| stage.name.as_str()).collect();
    assert_eq!(stages, ["pair", "designs"], "what no row comes from is left out");
}

/// As a user runs it: set from outside it is the same study; pieces are one run; an archive is verified; only the report differs
/// from the study without intervals, and that it does is told.
#[test]
fn intervals_are_set_cut_archived_and_compared() {
    let desk = Desk::with("quick.yaml");
    let published = row(DIAMETER, "57.09 mm");
    let ste = STE.replace("torque: 50 N m", "torque: { from: 50 N m, to: 65 N m, count: 16 }");
    std::fs::write(desk.path("plain.yaml"), study(&[PAIR, &ste], &published).replace("study: t", "study: plain"))
        .unwrap();
    let pair = PAIR.replace("module: 3 mm", "module: 3 ± 0.005 mm");
    std::fs::write(desk.path("rounded.yaml"), study(&[&pair, &ste], &published).replace("study: t", "study: rounded"))
        .unwrap();
    desk.run(&["run", "plain.yaml", "--quiet"], 0);
    let (out, _) = desk.run(&["plan", "rounded.yaml"], 0);
    assert!(out.contains("config changed") || out.contains("report"), "{out}");
    desk.run(&["run", "rounded.yaml", "--quiet"], 0);
    assert_eq!(desk.ran("rounded"), ["report"], "all else is there already");
    let set = ["--set", "pair.module=3 ± 0.005 mm", "--name", "set"];
    desk.run(&[&["run", "plain.yaml", "--quiet"], &set[..]].concat(), 0);
    assert_eq!(desk.contents("set"), desk.contents("rounded"));
    assert_eq!(desk.ran("set"), Vec::<String>::new(), "the same keys");
    let (text, _) = desk.run(&["report", "rounded.yaml"], 0);
    assert!(text.contains("some value inside reproduces it"), "{text}");
    let page = std::fs::read_to_string(desk.path("results/rounded/report.html")).unwrap();
    assert!(page.contains("56.905 to 57.095\u{202f}mm over the rounded inputs"));
    let (text, _) = desk.run(&["diff", "results/plain", "results/rounded"], 4);
    assert!(text.contains("unexplained") && text.contains("reproduced"), "{text}");
    let whole = desk.contents("rounded");
    desk.run(&["archive", "rounded.yaml", "-o", "a.zip"], 0);
    assert!(desk.run(&["verify", "a.zip"], 0).0.contains(" 0 different"));
    std::fs::remove_dir_all(desk.path("results")).unwrap();
    std::fs::remove_dir_all(desk.path(".gearstudy")).unwrap();
    desk.run(&["shard", "plan", "rounded.yaml", "--shards", "2", "--into", "plan"], 0);
    for index in ["1", "0"] {
        desk.run(&["shard", "run", "plan", index, "--quiet"], 0);
    }
    desk.run(&["shard", "merge", "plan"], 0);
    assert_eq!(desk.contents("rounded"), whole);
}

/// The warnings of a study that is valid.
fn warned(text: &str) -> Vec<String> {
    load(text).warnings().collect()
}

/// Reported once for a study: an interval that no report sets anything against, with its field, its line and the way to a tolerance.
#[test]
fn an_interval_without_effect_is_warned_of() {
    let wide = STE.replace("amount: 8 um", "amount: 20 um ± 3 um");
    let alone = format!("study: t\nseed: 3\nstages:{PAIR}{wide}");
    let found = warned(&alone);
    let [only] = &found[..] else { panic!("{found:?}") };
    let line = 1 + alone[..alone.find('±').unwrap()].matches('\n').count();
    for part in [
        "`designs.designs.relieved[0].tip_relief.amount` is `20 um ± 3 um`",
        "not a tolerance",
        "computed with `20 um`",
        "kind `scatter`",
        "{ field: designs.designs.relieved[0].tip_relief.amount, within: ± 3 um }",
        &format!(":{line}:"),
    ] {
        assert!(only.contains(part), "{part}: {only}");
    }

    // A report of other stages does not use it; one of a stage that reads it does.
    let of_pair = row(DIAMETER, "57 mm");
    assert_eq!(warned(&study(&[PAIR, &wide], &of_pair)).len(), 1);
    let of_ste = row("\"ste.summary[design=relieved, torque=50 N m].peak_to_peak\"", "2 um");
    assert!(warned(&study(&[PAIR, &wide], &of_ste)).is_empty());

    // Several are one warning with their lines; what the report uses is not among them.
    let pair = PAIR.replace("0.21", "0.21 ± 0.005").replace("14.079 mm", "14.079 ± 0.001 mm");
    let found = warned(&format!("study: t\nseed: 3\nstages:{pair}{wide}"));
    assert!(found.len() == 1 && found[0].contains("; the same is true of the intervals in lines "), "{found:?}");
    let bore = PAIR.replace("14.079 mm", "14.079 ± 0.001 mm");
    let found = warned(&format!("study: t\nseed: 3\nstages:{bore}{wide}"));
    assert!(found.len() == 1 && found[0].contains("; the same is true of the interval in line "), "{found:?}");
    let found = warned(&study(&[&pair, &wide], &of_pair));
    assert!(found.len() == 1 && found[0].contains("`20 um ± 3 um`") && !found[0].contains("lines"), "{found:?}");
}

/// A number of several stages, by an alias, has an effect if it has one in any of them; numbers alone are never warned of.
#[test]
fn an_interval_with_an_effect_is_not_warned_of() {
    let pair = PAIR.replace("14.079 mm", "14.079 ± 0.001 mm").replacen("  pair:", "  pair: &pair", 1);
    let other = "  other: { <<: *pair }\n";
    assert!(warned(&study(&[&pair, other], &row(DIAMETER, "57 mm"))).is_empty());
    assert!(warned(&study(&[PAIR, STE], &row(DIAMETER, "57 mm"))).is_empty());
    for name in ["rating", "sun_planet"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("studies").join(format!("{name}.yaml"));
        let text = std::fs::read_to_string(&path).unwrap();
        let study = program::load_text(&text, &path).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(study.warnings().collect::<Vec<_>>(), Vec::<String>::new(), "{name}");
    }
}
