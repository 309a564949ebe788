//! `kind: fit` against numbers that were computed with what is to be found, and closed forms.

mod messages;

use std::collections::BTreeMap;

use crate::registry::walk::{Ran, load, walk};
use studygraph::table::data::{Cell, Table};

const PAIR: &str = "
  pair:
    kind: geometry
    module: 3 mm
    pressure_angle: 20 deg
    material: { youngs_modulus: 206 GPa, poisson_ratio: 0.3 }
    pinion: { teeth: 19, face_width: 20 mm, bore_radius: 14.079 mm }
    gear: { teeth: 48, face_width: 20 mm, bore_radius: 38.823 mm }
";
const STIFFNESS: &str =
    "  stiffness: { kind: stiffness, pair: pair, method: energy, contact: linear, coupling: none }\n";
const STE: &str = "
  designs:
    kind: modification
    pair: pair
    designs: { relieved: [{ tip_relief: { gear: both, amount: 8 um, length: 4 mm, curve: linear } }] }
  ste: { kind: ste, stiffness: stiffness, designs: designs, torque: 50 N m, positions: 16 }
";
const BORES: &str = "
      bore: { field: pair.pinion.bore_radius, from: 8 mm, to: 20 mm }
      bore_of_gear: { field: pair.gear.bore_radius, follows: 38.823 / 14.079 * bore }";

fn study(stages: &[&str]) -> String {
    format!("study: t\nseed: 3\nstages:{}", stages.concat())
}

/// A fit of a stage that varies these and meets those.
fn fit(of: &str, vary: &str, meet: &str, more: &str) -> String {
    format!("  fit:\n    kind: fit\n    of: {of}\n    vary: {vary}\n    meet:{meet}\n    {more}\n")
}

fn ran(stages: &[&str]) -> BTreeMap<String, Ran> {
    walk(&load(&study(stages)))
}

fn table<'r>(ran: &'r BTreeMap<String, Ran>, stage: &str, name: &str) -> &'r Table {
    ran[stage].tables.iter().find(|table| table.name() == name).unwrap()
}

/// A number of the only row of a summary.
fn number(ran: &BTreeMap<String, Ran>, stage: &str, column: &str) -> f64 {
    table(ran, stage, "summary").floats(column)[0]
}

fn said(ran: &BTreeMap<String, Ran>) -> String {
    table(ran, "fit", "summary").texts("said")[0].clone()
}

/// Tier: closed form; a stiffness that was computed with a bore gives that bore back, and the standard deviation is the
/// tolerance over the derivative, which a difference of two whole studies has.
#[test]
fn a_bore_is_recovered_from_its_stiffness() {
    let with = |bore: f64| {
        let gear = 38.823 / 14.079 * bore;
        let pair = PAIR.replace("14.079 mm", &format!("{bore} mm")).replace("38.823 mm", &format!("{gear} mm"));
        number(&ran(&[&pair, STIFFNESS]), "stiffness", "single_max")
    };
    let (known, step) = (12.25, 0.01);
    let slope = (with(known + step) - with(known - step)) / (2.0 * step);
    let meet = format!(
        "\n      - {{ cell: stiffness.summary.single_max, value: {:.9e} N/m, tolerance: 1e5 N/m }}",
        with(known)
    );
    let found = ran(&[PAIR, STIFFNESS, &fit("stiffness", BORES, &meet, "")]);
    let solutions = table(&found, "fit", "solutions");
    assert!((solutions.floats("bore")[0] / known - 1.0).abs() < 1e-6, "{:?}", solutions.floats("bore"));
    assert!((solutions.floats("bore_of_gear")[0] / (38.823 / 14.079 * known) - 1.0).abs() < 1e-6);
    let deviation = solutions.floats("bore_standard_deviation")[0];
    assert!((deviation * slope.abs() / 1e5 - 1.0).abs() < 1e-4, "{deviation} at a slope of {slope}");
    assert_eq!(said(&found), "one solution meets all within their tolerances");
    let parameters = table(&found, "fit", "parameters");
    // 1.96 standard deviations to either side; 12.25 ± 0.025 has three digits.
    assert!((parameters.floats("upper")[0] - known - 1.959_964 * deviation).abs() < 1e-5);
    assert_eq!(parameters.texts("at_bound"), [""]);
    assert!(found["fit"].warnings.is_empty());
}

/// Tier: closed form; with a linear contact law and no relief the mean transmission error is proportional to the torque, and
/// the thickness of a tooth on the reference circle is m (π/2 + 2 x tan α).
#[test]
fn a_torque_and_a_profile_shift_are_recovered() {
    let plain = STE.replace("[{ tip_relief: { gear: both, amount: 8 um, length: 4 mm, curve: linear } }]", "[]");
    let at_50 = number(&ran(&[PAIR, STIFFNESS, &plain]), "ste", "mean");
    let meet = format!("\n      - {{ cell: ste.summary.mean, value: {:.12} um }}", 1.7 * at_50);
    let vary = "{ torque: { field: ste.torque, from: 10 N m, to: 200 N m } }";
    let found = ran(&[PAIR, STIFFNESS, &plain, &fit("ste", vary, &meet, "starts: 2")]);
    let torque = table(&found, "fit", "solutions").floats("torque")[0];
    assert!((torque - 85.0).abs() < 1e-7, "{torque}");

    let shift = 0.21;
    let thickness = 3.0 * (std::f64::consts::FRAC_PI_2 + 2.0 * shift * libm::tan(20_f64.to_radians()));
    let meet =
        format!("\n      - {{ cell: \"pair.inspection[gear=pinion]tooth_thickness\", value: {thickness:.9} mm }}");
    let meet = meet.replace("]tooth", "].tooth");
    let vary = "{ shift: { field: pair.pinion.profile_shift, from: -0.2, to: 0.6 } }";
    let pair = PAIR.replace("teeth: 19,", "teeth: 19, profile_shift: 0,");
    let found = ran(&[&pair, &fit("pair", vary, &meet, "")]);
    let found = table(&found, "fit", "solutions").floats("shift")[0];
    assert!((found - shift).abs() < 1e-8, "{found}");
}

/// Tier: invariant; a relief that is too short and one that is too long fluctuate alike: both are found, and each, put into the
/// study, gives what was to be met.
#[test]
fn two_reliefs_that_fluctuate_alike_are_two_solutions() {
    let vary = "{ amount: { field: \"designs.designs.relieved[0].tip_relief.amount\", from: 1 um, to: 30 um } }";
    let meet = "\n      - { cell: ste.summary.peak_to_peak, value: 1.5 um }";
    let found = ran(&[PAIR, STIFFNESS, STE, &fit("ste", vary, meet, "starts: 6")]);
    let solutions = table(&found, "fit", "solutions");
    let meets = match solutions.column("meets") {
        Some(studygraph::table::data::Data::Flag(meets)) => meets.clone(),
        other => panic!("{other:?}"),
    };
    let amounts: Vec<f64> =
        solutions.floats("amount").iter().zip(&meets).filter(|(_, meets)| **meets).map(|(amount, _)| *amount).collect();
    assert_eq!(amounts.len(), 2, "{amounts:?}: {}", said(&found));
    assert_eq!(said(&found), "2 different solutions meet all within their tolerances");
    assert_eq!(found["fit"].warnings.len(), 1);
    for amount in amounts {
        let with = STE.replace("amount: 8 um", &format!("amount: {amount} um"));
        let there = number(&ran(&[PAIR, STIFFNESS, &with]), "ste", "peak_to_peak");
        assert!((there - 1.5).abs() < 1e-4, "{there} at {amount}");
    }
}

/// Tier: closed form; the stiffness is proportional to Young's modulus and to the width, so that two stiffnesses determine their
/// product alone. And what no bore can give is not given: the nearest is at the bound, and said to be.
#[test]
fn what_is_not_determined_and_what_cannot_be_is_said() {
    let vary = "
      modulus: { field: pair.material.youngs_modulus, from: 100 GPa, to: 400 GPa }
      width: { field: pair.pinion.face_width, from: 10 mm, to: 40 mm }
      width_of_gear: { field: pair.gear.face_width, follows: width }";
    let plain = ran(&[PAIR, STIFFNESS]);
    let (single, double) = (number(&plain, "stiffness", "single_max"), number(&plain, "stiffness", "double_max"));
    let meet = format!(
        "
      - {{ cell: stiffness.summary.single_max, value: {single:e} N/m, tolerance: 0.1 % }}
      - {{ cell: stiffness.summary.double_max, value: {double:e} N/m, tolerance: 0.1 % }}"
    );
    let found = ran(&[PAIR, STIFFNESS, &fit("stiffness", vary, &meet, "starts: 2")]);
    let summary = table(&found, "fit", "summary");
    let solutions = table(&found, "fit", "solutions");
    let product = solutions.floats("modulus")[0] * solutions.floats("width")[0];
    assert!((product / (206.0 * 20.0) - 1.0).abs() < 1e-6, "{product}");
    assert!(summary.floats("condition")[0].is_nan() && solutions.floats("width_standard_deviation")[0].is_nan());
    // Along the product, width falls by width/modulus.
    let per = solutions.floats("width")[0] / solutions.floats("modulus")[0];
    let wanted = format!("modulus + 1\u{202f}GPa, width − {}\u{202f}mm", declare::number::significant(per, 3));
    assert_eq!(solutions.rows(), 1, "{}", said(&found));
    assert_eq!(summary.texts("flat")[0], wanted, "{}", said(&found));
    assert!(found["fit"].warnings[0].contains("nothing that is met changes along modulus"));

    let meet = "\n      - { cell: stiffness.summary.single_max, value: 9e8 N/m }";
    let found = ran(&[PAIR, STIFFNESS, &fit("stiffness", BORES, meet, "")]);
    let parameters = table(&found, "fit", "parameters");
    let is_lower = parameters.texts("at_bound")[0] == "lower";
    let bound = if is_lower { 8.0 } else { 20.0 };
    assert!(
        (parameters.floats("value")[0] - bound).abs() < 1e-9 && parameters.floats("standard_deviation")[0].is_nan()
    );
    assert!(
        said(&found)
            .starts_with("no search ended at values that meet all within their tolerances; the nearest leave one")
    );
    assert!(said(&found).contains("`bore` is held at its bound"), "{}", said(&found));
}

/// Tier: closed form; several rows of a cell are met by as many values in their order, formulas beside them: twelve samples that
/// were taken from 3° on are met from 3° on.
#[test]
fn rows_are_met_in_their_order() {
    let sampled = STE.replace("positions: 16", "positions: 32, samples: 6, first_sample: 3 deg");
    let known = ran(&[PAIR, STIFFNESS, &sampled]);
    let samples = table(&known, "ste", "samples");
    let written: Vec<String> = samples
        .floats("transmission_error")
        .iter()
        .map(|value| format!("{value:.9} {}", samples.schema().column("transmission_error").unwrap().unit))
        .collect();
    let meet = format!(
        "
      - {{ cell: ste.samples.transmission_error, value: \"{}\", tolerance: 0.01 um }}
      - {{ formula: a / b, with: {{ a: ste.summary.maximum, b: ste.summary.minimum }}, value: 0, tolerance: 1e9 }}",
        written.join(", ")
    );
    let other = sampled.replace("first_sample: 3 deg", "first_sample: 2.2 deg");
    let vary = "
      first: { field: ste.first_sample, from: 1 deg, to: 5 deg }
      torque: { field: ste.torque, from: 20 N m, to: 90 N m }";
    let found = ran(&[PAIR, STIFFNESS, &other, &fit("ste", vary, &meet, "starts: 1")]);
    let solutions = table(&found, "fit", "solutions");
    assert!((solutions.floats("first")[0] - 3.0).abs() < 1e-3, "{:?}", solutions.floats("first"));
    assert!((solutions.floats("torque")[0] - 50.0).abs() < 1e-2, "{:?}", solutions.floats("torque"));
    assert_eq!(table(&found, "fit", "residuals").rows(), 7);
}

/// Tier: closed form; what was printed rounded is an interval. A module of 3 ± 0.005 mm and a profile shift of 0.21 ± 0.005 leave a
/// tooth thickness of m (π/2 + 2 x tan α) all that lies between its least and its most, and nothing beyond.
#[test]
fn some_value_inside_the_printed_intervals_reproduces_a_number_or_none_does() {
    let vary = "
      shift: { field: pair.pinion.profile_shift, within: ± 0.005 }
      module: { field: pair.module, within: ± 0.005 mm }";
    let pair = PAIR.replace("teeth: 19,", "teeth: 19, profile_shift: 0.21,");
    let thickness =
        |module: f64, shift: f64| module * (std::f64::consts::FRAC_PI_2 + 2.0 * shift * libm::tan(20_f64.to_radians()));
    for (module, shift, is_inside) in [(3.004, 0.2149, true), (2.996, 0.2056, true), (3.0055, 0.2155, false)] {
        let wanted = thickness(module, shift);
        let meet = format!(
            "\n      - {{ cell: \"pair.inspection[gear=pinion].tooth_thickness\", value: {wanted:.9} mm, tolerance: 1e-6 mm }}"
        );
        let found = ran(&[&pair, &fit("pair", vary, &meet, "starts: 2")]);
        let said = said(&found);
        if is_inside {
            assert_eq!(said, "one solution meets all within their tolerances", "{module} {shift}");
            assert!(found["fit"].warnings.is_empty());
        } else {
            let off = (wanted - thickness(3.005, 0.215)) / 1e-6;
            let off = declare::number::significant(off, 3);
            let nearest = format!("the nearest leave one {off} tolerances off");
            assert!(said.contains(&nearest) && said.contains("`module` is held at its bound"), "{said}");
        }
    }
}

/// Tier: invariant; a bore and a torque that give a stiffness and a transmission error are found from both, each a cell of its own
/// stage.
#[test]
fn cells_of_several_stages_are_met_together() {
    let pair = PAIR.replace("14.079 mm", "11 mm");
    let known = ran(&[&pair, STIFFNESS, &STE.replace("torque: 50 N m", "torque: 64 N m")]);
    let meet = format!(
        "
      - {{ cell: stiffness.summary.single_max, value: {:.9e} N/m }}
      - {{ cell: ste.summary.mean, value: {:.9} um }}",
        number(&known, "stiffness", "single_max"),
        number(&known, "ste", "mean")
    );
    let vary = "
      bore: { field: pair.pinion.bore_radius, from: 8 mm, to: 20 mm }
      torque: { field: ste.torque, from: 20 N m, to: 90 N m }";
    let found = ran(&[PAIR, STIFFNESS, STE, &fit("ste", vary, &meet, "starts: 2")]);
    let solutions = table(&found, "fit", "solutions");
    assert_eq!(said(&found), "one solution meets all within their tolerances");
    let (bore, torque) = (solutions.floats("bore")[0], solutions.floats("torque")[0]);
    assert!((bore - 11.0).abs() < 1e-4 && (torque - 64.0).abs() < 1e-4, "{bore} {torque}");
}

/// Two measured spans at a centre distance without much backlash.
fn at_edge(centre_distance: &str, starts: usize) -> String {
    format!(
        "
study: t
seed: 3
stages:
  pair:
    kind: geometry
    module: 4 mm
    centre_distance: {centre_distance}
    pinion: {{ teeth: 12, profile_shift: 0.3, tip_radius: 29 mm, face_width: 20 mm, bore_radius: 9 mm, measured_with: {{ span_teeth: 2 }} }}
    gear: {{ teeth: 25, face_width: 20 mm, bore_radius: 15 mm, measured_with: {{ span_teeth: 3 }} }}
  fit:
    kind: fit
    of: pair
    starts: {starts}
    vary:
      x1: {{ field: pair.pinion.profile_shift, from: 0, to: 0.6 }}
      x2: {{ field: pair.gear.profile_shift, from: -0.4, to: 0.4 }}
    meet:
      - {{ cell: \"pair.inspection[gear=pinion].span\", value: 19.70 mm, tolerance: 0.02 mm }}
      - {{ cell: \"pair.inspection[gear=gear].span\", value: 30.96 mm, tolerance: 0.02 mm }}
"
    )
}

/// The least sum of squares with x1 + x2 no larger than `most`, and where it is: spans are linear in the profile shifts, with
/// slope 2 m sin α each, so it is a parabola along the edge.
fn least_at_edge(most: f64) -> (f64, [f64; 2]) {
    let slope = 8.0 * (20.0_f64.to_radians()).sin();
    let involute = 20.0_f64.to_radians().tan() - 20.0_f64.to_radians();
    // W_k = m cos α (π (k − ½) + z inv α) + 2 x m sin α.
    let span = |teeth: f64, of: f64, x: f64| {
        4.0 * 20.0_f64.to_radians().cos() * (std::f64::consts::PI * (of - 0.5) + teeth * involute) + slope * x
    };
    let sum = |x1: f64| {
        let one = (span(12.0, 2.0, x1) - 19.70) / 0.02;
        let two = (span(25.0, 3.0, most - x1) - 30.96) / 0.02;
        one * one + two * two
    };
    let steps = 600_000;
    let grid = (0..=steps).map(|at| 0.6 * f64::from(at) / f64::from(steps));
    let least = grid.min_by(|one, two| sum(*one).total_cmp(&sum(*two))).unwrap_or_default();
    (sum(least), [least, most - least])
}

/// Tier: closed form along the edge, where backlash ends what is valid. There is one solution, from however many starts.
#[test]
fn a_fit_goes_along_the_edge_of_valid_values() {
    for (centre_distance, starts, published) in
        [("75.78 mm", 4, 1.124), ("75.81 mm", 4, 0.047), ("75.81 mm", 16, 0.047)]
    {
        let found = walk(&load(&at_edge(centre_distance, starts)));
        let solutions = table(&found, "fit", "solutions");
        let (x1, x2) = (solutions.floats("x1")[0], solutions.floats("x2")[0]);
        let (least, [one, two]) = least_at_edge(x1 + x2);
        let sum = solutions.floats("sum_of_squares")[0];
        assert!((sum - published).abs() < 1e-3, "{centre_distance}: {sum}");
        assert!((sum - least).abs() < 1e-5, "{centre_distance}: {sum}, not {least}");
        assert!((x1 - one).abs() < 1e-5 && (x2 - two).abs() < 1e-5, "{centre_distance}: {x1}, {x2}");
        assert_eq!(solutions.rows(), 1, "{centre_distance} from {starts}: {:?}", solutions.floats("sum_of_squares"));
        let edge = &solutions.texts("edge")[0];
        assert!(edge.starts_with("geometry: "), "{edge:?}");
        assert!(matches!(solutions.column("settled").map(|data| data.cell(0)), Some(Cell::Flag(true))));
        let said = said(&found);
        assert!(
            said.starts_with("one solution meets all") && said.contains("at the edge of the valid values"),
            "{said}"
        );
        assert!(found["fit"].warnings[0].contains(edge.as_str()), "{:?}", found["fit"].warnings);
    }
    let found = walk(&load(&at_edge("76 mm", 4)));
    let solutions = table(&found, "fit", "solutions");
    assert!(solutions.rows() == 1 && solutions.floats("sum_of_squares")[0] < 1e-18, "{:?}", said(&found));
    assert_eq!(
        (solutions.texts("edge")[0].as_str(), said(&found).as_str()),
        ("", "one solution meets all within their tolerances")
    );
}
