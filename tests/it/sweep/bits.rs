//! A row is what the stage gives for these values, to the last bit.

use super::*;

const OUTPUTS: &str = "outputs: [peak_to_peak, mean, variance, maximum, unloaded_peak_to_peak, largest_pressure, pressure_position, \
                       loaded_contact_ratio, error_estimate, \"harmonics[order=3].amplitude\"]";
const COLUMNS: [&str; 9] = [
    "peak_to_peak",
    "mean",
    "variance",
    "maximum",
    "unloaded_peak_to_peak",
    "largest_pressure",
    "pressure_position",
    "loaded_contact_ratio",
    "error_estimate",
];

/// The sweep's rows against a study for every row, whose text has the row's values in it; `given` finds them.
fn as_in_studies(sweep: &Table, keys: &[&str], given: impl Fn(&[f64]) -> String) {
    assert!(sweep.rows() >= 4 && sweep.texts("reason").iter().all(String::is_empty), "{:?}", sweep.texts("reason"));
    for row in 0..sweep.rows() {
        let values: Vec<f64> = keys.iter().map(|key| sweep.floats(key)[row]).collect();
        let ran = walk(&load(&given(&values)));
        let of = |name: &str| ran["ste"].tables.iter().find(|table| table.name() == name).unwrap();
        let at = of("summary").texts("design").iter().position(|design| design == "long").unwrap();
        for column in COLUMNS.iter().filter(|column| sweep.column(column).is_some()) {
            let (swept, alone) = (sweep.floats(column)[row], of("summary").floats(column)[at]);
            assert_eq!(swept.to_bits(), alone.to_bits(), "{column} of {values:?}: {swept} {alone}");
        }
        let harmonics = of("harmonics");
        let third = |at: &usize| harmonics.texts("design")[*at] == "long" && harmonics.integers("order")[*at] == 3;
        let third = (0..harmonics.rows()).find(third).unwrap();
        assert_eq!(sweep.floats("amplitude_3")[row].to_bits(), harmonics.floats("amplitude")[third].to_bits());
    }
}

fn relieved(amount: f64, length: f64) -> String {
    DESIGN.replace("amount: 8 um, length: 5 mm", &format!("amount: {amount} um, length: {length} mm"))
}

#[test]
fn modifications_and_torques() {
    let sweep = rows(&swept(&format!(
        "vary:\n  amount: {{ field: \"designs.designs.long[1].tip_relief.amount\", values: [7.81 um, 3 um] }}\n  \
         torque: {{ field: ste.torque, values: [25 N m, 130 N m] }}\n  \
         length: {{ field: \"designs.designs.long[1].tip_relief.length\", values: [5.05 mm] }}\n{OUTPUTS}"
    )));
    assert_eq!(sweep.floats("amount"), [3.0, 3.0, 7.81, 7.81], "what changes most slowly comes first");
    as_in_studies(&sweep, &["amount", "length", "torque"], |values| {
        let ste = STE.replace("50 N m", &format!("{} N m", values[2]));
        study(&[PAIR, STIFFNESS, &relieved(values[0], values[1]), &ste])
    });
}

/// What is read as tables, what is computed anew below it, and how curves are sampled.
#[test]
fn geometry_material_and_settings() {
    let sweep = rows(&swept(&format!(
        "method: zip\nvary:\n  width: {{ field: pair.gear.face_width, values: [18 mm, 18 mm, 12.5 mm, 12.5 mm] }}\n  \
         modulus: {{ field: pair.material.youngs_modulus, values: [206 GPa, 210 GPa, 206 GPa, 206 GPa] }}\n  \
         positions: {{ field: ste.positions, values: [8, 16, 16, 40] }}\n  \
         amount: {{ field: \"designs.designs.long[0].lead_crowning.amount\", values: [0 um, 4 um, 9 um, 9 um] }}\n{}",
        OUTPUTS.replace(", error_estimate", "")
    ).replace("loaded_contact_ratio, ", "")));
    assert_eq!(sweep.integers("positions"), [16, 40, 8, 16]);
    let positions: Vec<i64> = sweep.integers("positions").to_vec();
    let mut next = positions.into_iter();
    let next = std::cell::RefCell::new(&mut next);
    as_in_studies(&sweep, &["width", "modulus", "amount"], |values| {
        let pair = PAIR.replace("face_width: 18 mm", &format!("face_width: {} mm", values[0]));
        let pair = format!("{pair}    material: {{ youngs_modulus: {} GPa }}\n", values[1]);
        let design = DESIGN.replace("amount: 6 um", &format!("amount: {} um", values[2]));
        let ste = STE.replace("positions: 16", &format!("positions: {}", next.borrow_mut().next().unwrap()));
        study(&[&pair, STIFFNESS, &design, &ste])
    });
}

/// Finite elements, resolved contact, coupled bodies, tips that touch outside of the line of action.
#[test]
fn finite_elements_with_corner_contact() {
    let stiffness = "  stiffness: { kind: stiffness, pair: pair, method: { finite_element: { elements_across: 6 } }, torque: 50 N m }\n";
    let ste = STE.replace("torque: 50 N m", "corner_contact: exact, torque: 50 N m");
    let fields = format!(
        "  sweep:\n    kind: sweep\n    of: ste\n    vary:\n      \
         amount: {{ field: \"designs.designs.long[1].tip_relief.amount\", values: [2 um, 30 um] }}\n      \
         torque: {{ field: ste.torque, values: [20 N m, 200 N m] }}\n    {OUTPUTS}\n"
    );
    let sweep = rows(&study(&[PAIR, stiffness, DESIGN, &ste, &fields]));
    as_in_studies(&sweep, &["amount", "torque"], |values| {
        let ste = ste.replace("50 N m", &format!("{} N m", values[1]));
        study(&[PAIR, stiffness, &relieved(values[0], 5.0), &ste])
    });
}

/// The short way and the long one, from table to table, which is taken where a column is asked that the short one does not
/// know, or the stage picks its own sampling.
#[test]
fn the_short_way_is_the_long_one() {
    let vary = "vary:\n  amount: { field: \"designs.designs.long[1].tip_relief.amount\", values: [7.81 um, 3 um] }\n  \
                torque: { field: ste.torque, values: [0 N m, 25 N m, 130 N m] }\n";
    let (short, long) = (OUTPUTS.to_owned(), OUTPUTS.replace("outputs: [", "outputs: [corner_load_share, "));
    let [short, long] = [short, long].map(|outputs| rows(&swept(&format!("{vary}{outputs}"))));
    assert_eq!(short.rows(), 6);
    for column in COLUMNS.iter().chain(&["amplitude_3"]) {
        assert_eq!(bits(short.floats(column)), bits(long.floats(column)), "{column}");
    }
    assert!(long.floats("corner_load_share").iter().all(|share| *share == 0.0));
    let own = swept(&format!("{vary}outputs: [peak_to_peak, positions, error_estimate]"));
    let own = own.replace("positions: 16", "accuracy: 0.01 %");
    let found = rows(&own);
    assert!(found.floats("error_estimate").iter().all(|error| *error <= 1e-4));
    let ste = STE.replace("positions: 16", "accuracy: 0.01 %").replace("50 N m", "[0 N m, 25 N m, 130 N m]");
    for (at, amount) in [(0, 3.0), (3, 7.81)] {
        let summary = table(&study(&[PAIR, STIFFNESS, &relieved(amount, 5.0), &ste]), "ste", "summary");
        // Designs are in the order of their names: `long` comes first.
        for column in ["peak_to_peak", "error_estimate"] {
            assert_eq!(bits(&found.floats(column)[at..at + 3]), bits(&summary.floats(column)[..3]), "{column}");
        }
    }
}

/// What nothing but extremes takes is what an optimiser takes.
#[test]
fn a_grid_of_an_optimiser() {
    let optimizer = "
  grid:
    kind: optimizer
    stiffness: stiffness
    method: { grid: { levels: 3 } }
    at: { torque: 50 N m }
    positions: 16
    design:
      - lead_crowning: { gear: pinion, amount: [0 um, 8 um] }
      - tip_relief: { gear: both, amount: [0 um, 10 um], length: 5 mm, curve: parabolic }
";
    let text = swept(
        "vary:\n  crown: { field: \"designs.designs.long[0].lead_crowning.amount\", from: 0 um, to: 8 um, count: 3 }\n  \
         amount: { field: \"designs.designs.long[1].tip_relief.amount\", from: 0 um, to: 10 um, count: 3 }\noutputs: [peak_to_peak]",
    );
    let ran = walk(&load(&format!("{text}{optimizer}")));
    let of = |stage: &str, name: &str| ran[stage].tables.iter().find(|table| table.name() == name).unwrap();
    let (swept, tried) = (of("sweep", "rows"), of("grid", "evaluations"));
    // Both go through the last field first.
    assert_eq!(bits(swept.floats("peak_to_peak")), bits(tried.floats("objective")));
    assert_eq!(swept.rows(), 9);
}

#[test]
fn stiffness_of_many_pairs() {
    let text = study(&[
        PAIR,
        STIFFNESS,
        "  sweep:\n    kind: sweep\n    of: stiffness\n    vary:\n      teeth: { field: pair.gear.teeth, values: [48, 60] }\n      bore: { field: pair.gear.bore_radius, values: [38.823 mm, 30 mm] }\n    outputs: [mean, single_max]\n",
    ]);
    let sweep = rows(&text);
    assert_eq!(
        (sweep.integers("teeth"), sweep.floats("bore")),
        (&[48, 48, 60, 60][..], &[30.0, 38.823, 30.0, 38.823][..])
    );
    for row in 0..4 {
        let pair = PAIR.replace("teeth: 48", &format!("teeth: {}", sweep.integers("teeth")[row]));
        let pair = pair.replace("38.823 mm", &format!("{} mm", sweep.floats("bore")[row]));
        let summary = table(&study(&[&pair, STIFFNESS]), "stiffness", "summary");
        for column in ["mean", "single_max"] {
            assert_eq!(sweep.floats(column)[row].to_bits(), summary.floats(column)[0].to_bits(), "{column}");
        }
    }
}
