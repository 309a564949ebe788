//! Which rows there are, which have no numbers, and what all come to.

use super::*;

const TWO: &str = "vary:\n  amount: { field: \"designs.designs.long[1].tip_relief.amount\", from: 1 um, to: 9 um, count: 5 }\n  \
                   torque: { field: ste.torque, from: 25 N m, to: 100 N m, count: 4 }\n";

fn all(text: &str) -> std::collections::BTreeMap<String, Table> {
    let ran = walk(&load(text));
    ran["sweep"].tables.iter().map(|table| (table.name().to_owned(), table.clone())).collect()
}

/// Tier: second method; sums over the table of rows.
#[test]
fn effects_best_and_maps_are_those_of_the_rows() {
    let tables = all(&swept(&format!("{TWO}outputs: [mean, peak_to_peak]\nminimize: peak_to_peak\nbest: 3")));
    let (rows, effects) = (&tables["rows"], &tables["effects"]);
    let close =
        |found: f64, expected: f64| assert!((found - expected).abs() <= 1e-12 * expected.abs(), "{found} {expected}");
    assert_eq!(effects.rows(), (5 + 4) * 2);
    for row in 0..effects.rows() {
        let (field, output) = (&effects.texts("field")[row], &effects.texts("output")[row]);
        let at = effects.floats("value")[row];
        let values: Vec<f64> =
            (0..20).filter(|row| rows.floats(field)[*row] == at).map(|row| rows.floats(output)[row]).collect();
        assert_eq!(effects.integers("rows")[row] as usize, values.len());
        close(effects.floats("mean")[row], values.iter().sum::<f64>() / values.len() as f64);
        let (low, high) =
            values.iter().fold((f64::MAX, f64::MIN), |(low, high), value| (low.min(*value), high.max(*value)));
        assert_eq!((effects.floats("minimum")[row], effects.floats("maximum")[row]), (low, high));
        let mut sorted = values.clone();
        sorted.sort_by(f64::total_cmp);
        let median = effects.floats("median")[row];
        let below = sorted.iter().filter(|value| **value <= median + (high - low) / 1024.0).count();
        assert!(2 * below >= sorted.len() && median <= sorted[sorted.len() / 2] + (high - low) / 1024.0);
    }
    // The variance of the means over the variance of all.
    let shares = &tables["sensitivity"];
    for row in 0..shares.rows() {
        let (field, output) = (&shares.texts("field")[row], &shares.texts("output")[row]);
        let values = rows.floats(output);
        let mean = values.iter().sum::<f64>() / 20.0;
        let total: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let between: f64 = (0..20)
            .map(|row| {
                let alike = (0..20).filter(|other| rows.floats(field)[*other] == rows.floats(field)[row]);
                let (sum, count) = alike.fold((0.0, 0.0), |(sum, count), other| (sum + values[other], count + 1.0));
                (sum / count - mean).powi(2)
            })
            .sum();
        close(shares.floats("share")[row], between / total);
    }
    let mut sorted: Vec<f64> = rows.floats("peak_to_peak").to_vec();
    sorted.sort_by(f64::total_cmp);
    assert_eq!(tables["best"].floats("peak_to_peak"), &sorted[..3]);
    let map = &tables["map"];
    assert_eq!((map.rows(), map.integers("rows").iter().sum::<i64>()), (20, 20));
    let expected: Vec<f64> = rows.floats("peak_to_peak").to_vec();
    assert_eq!(map.floats("minimum"), expected);
    let bins: i64 = (0..tables["distribution"].rows())
        .filter(|row| tables["distribution"].texts("output")[*row] == "mean")
        .map(|row| tables["distribution"].integers("rows")[row])
        .sum();
    assert_eq!(bins, 20);
    let quantiles = &tables["quantiles"];
    let of = |share: f64| {
        (0..quantiles.rows())
            .find(|row| quantiles.texts("output")[*row] == "peak_to_peak" && quantiles.floats("share")[*row] == share)
            .map(|row| quantiles.floats("value")[row])
            .unwrap()
    };
    assert_eq!((of(0.0), of(1.0)), (sorted[0], sorted[19]));
    assert!((of(0.5) - sorted[9]).abs() <= (sorted[19] - sorted[0]) / 1024.0);
    assert_eq!(tables["invalid"].rows(), 0);
}

/// Tier: closed form; what one field alone decides has all of the variance, the others have none.
#[test]
fn a_field_that_decides_alone_has_all_of_the_variance() {
    let fields = "vary:\n  positions: { field: ste.positions, values: [8, 9, 30] }\n  \
                  amount: { field: \"designs.designs.long[1].tip_relief.amount\", values: [3 um, 5 um] }\noutputs: [slices, \"summary.positions\"]";
    let text = swept(&fields.replace("positions: {", "count: {"));
    let shares = &all(&text)["sensitivity"];
    let of = |field: &str| {
        let row = (0..shares.rows())
            .find(|row| shares.texts("field")[*row] == field && shares.texts("output")[*row] == "positions");
        shares.floats("share")[row.unwrap()]
    };
    assert!((of("count") - 1.0).abs() < 1e-14 && of("amount").abs() < 1e-14);
    assert!(
        (0..shares.rows())
            .filter(|row| shares.texts("output")[*row] == "slices")
            .all(|row| shares.floats("share")[row].is_nan())
    );
}

#[test]
fn an_invalid_design_is_a_row_with_its_reason() {
    let text = swept(
        "vary:\n  length: { field: \"designs.designs.long[1].tip_relief.length\", values: [5 mm, 14 mm, 40 mm, 900 mm] }\n  \
         torque: { field: ste.torque, values: [0 N m, 1e9 N m] }\n  \
         width: { field: pair.gear.bore_radius, values: [38.823 mm, 100 mm] }\noutputs: [peak_to_peak, mean, largest_pressure]",
    );
    let tables = all(&text);
    let (rows, invalid) = (&tables["rows"], &tables["invalid"]);
    let reasons = rows.texts("reason");
    for (row, reason) in reasons.iter().enumerate() {
        let (length, bore) = (rows.floats("length")[row], rows.floats("width")[row]);
        let values = ["peak_to_peak", "mean", "largest_pressure"].map(|column| rows.floats(column)[row]);
        let expected = if bore > 50.0 {
            "geometry: "
        } else if length > 15.0 {
            "modification: "
        } else {
            ""
        };
        assert!(reason.starts_with(expected) && reason.is_empty() == expected.is_empty(), "{reason}");
        assert!(values.iter().all(|value| value.is_nan() != expected.is_empty()), "{values:?}");
    }
    assert_eq!(reasons.iter().filter(|reason| reason.is_empty()).count(), 4);
    assert_eq!(invalid.rows(), 2, "{:?}", invalid.texts("reason"));
    assert_eq!(invalid.integers("rows").iter().sum::<i64>(), 12);
    assert!(
        invalid.texts("example")[1].contains("40.000000 mm")
            && invalid.texts("first_row")[1].contains("length = 40 mm")
    );
}

/// Each kind of failure on the way, and that the rest goes on: a mesh that loses contact, a pair that cannot be.
#[test]
fn extreme_pairs() {
    let text = swept(
        "design: long\nmethod: { random: { samples: 60 } }\nvary:\n  teeth: { field: pair.pinion.teeth, from: 4, to: 60 }\n  \
         module: { field: pair.module, from: 0.5 mm, to: 8 mm }\n  \
         shift: { field: pair.pinion.profile_shift, from: -1.5, to: 1.5 }\n  \
         torque: { field: ste.torque, from: 0 N m, to: 1e9 N m }\noutputs: [peak_to_peak, mean]",
    );
    let rows = rows(&text);
    let valid = |row: &usize| rows.texts("reason")[*row].is_empty();
    let count = (0..60).filter(valid).count();
    assert!((3..57).contains(&count), "{count} of 60 are valid");
    assert!((0..60).all(|row| valid(&row) == rows.floats("mean")[row].is_finite()));
}

#[test]
fn a_filter_leaves_rows_out() {
    let lengths =
        "  length: { field: \"designs.designs.long[1].tip_relief.length\", from: 2 mm, to: 8 mm, count: 4 }\n";
    let filter = |text: &str| swept(&format!("{TWO}{lengths}where: \"{text}\"\noutputs: [mean]"));
    let found = rows(&filter("amount <= 1e-3 * length && !(length / amount > 3000) || amount > length / 900"));
    let kept = |amount: f64, length: f64| amount <= length && length / amount <= 3.0 || amount > length / 0.9;
    let of_row = |row: usize| kept(found.floats("amount")[row], found.floats("length")[row]);
    assert!((0..found.rows()).all(of_row));
    let grid = [1.0, 3.0, 5.0, 7.0, 9.0].iter().flat_map(|amount| [2.0, 4.0, 6.0, 8.0].map(|length| (*amount, length)));
    let count = grid.filter(|(amount, length)| kept(*amount, *length)).count();
    assert!((2..19).contains(&count) && found.rows() == 4 * count, "{count} {}", found.rows());
    let none = all(&filter("amount < 0"));
    assert_eq!((none["rows"].rows(), none["best"].rows(), none["effects"].rows()), (0, 0, 0));
}

const DRAWN: &str = "vary:\n  amount: { field: \"designs.designs.long[1].tip_relief.amount\", from: 0 um, to: 16 um }\n  \
                     length: { field: \"designs.designs.long[1].tip_relief.length\", values: [3 mm, 5 mm] }\n  \
                     positions: { field: ste.positions, from: 8, to: 11 }\noutputs: [mean]\n";

/// Tier: published; the first points of Sobol's sequence (Joe and Kuo), and strata of Latin hypercubes by their definition.
#[test]
fn drawn_rows_are_where_their_method_says() {
    let drawn = |method: &str| rows(&swept(&format!("{DRAWN}method: {{ {method} }}")));
    let sobol = drawn("sobol: { samples: 8 }");
    assert_eq!(sobol.integers("sample"), [1, 2, 3, 4, 5, 6, 7, 8]);
    // The columns go by how long it takes to go on: positions, then amount, then length.
    let [first, second] =
        [[0.0, 0.5, 0.75, 0.25, 0.375, 0.875, 0.625, 0.125], [0.0, 0.5, 0.25, 0.75, 0.375, 0.875, 0.125, 0.625]];
    assert_eq!(sobol.integers("positions"), first.map(|share| 8 + (share * 4.0) as i64));
    assert_eq!(sobol.floats("amount"), second.map(|share| 16.0 * share));
    let strata = drawn("latin_hypercube: { samples: 32 }");
    let mut found: Vec<usize> = strata.floats("amount").iter().map(|amount| (amount * 2.0) as usize).collect();
    found.sort_unstable();
    assert!(found.into_iter().eq(0..32));
    assert_eq!(
        [3.0, 5.0].map(|length| strata.floats("length").iter().filter(|value| **value == length).count()),
        [16, 16]
    );
    assert_eq!(
        [8, 9, 10, 11].map(|count| strata.integers("positions").iter().filter(|value| **value == count).count()),
        [8; 4]
    );
    let (few, many) = (drawn("random: { samples: 10 }"), drawn("random: { samples: 25 }"));
    assert_eq!(bits(few.floats("amount")), bits(&many.floats("amount")[..10]), "more rows leave the first as they are");
    assert_eq!(bits(few.floats("mean")), bits(&many.floats("mean")[..10]));
}
