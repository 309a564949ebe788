//! A row is what the stage gives for these values, to the last bit; how many there are, and where they lie.

use super::*;

/// Deviations of the pair as it is mounted, of its flanks, and of its modifications.
#[test]
fn a_sample_is_the_stage_with_its_values() {
    let slope = "slope: { field: \"designs.designs.long[2].profile_slope.amount\", iso1328: 7 }";
    let shaft = "shaft: { field: ste.parallelism_out_of_plane, normal: 10 um, from: -30 um, to: 30 um }";
    let text = scattered(
        &[AMOUNT, TILT, slope, shaft, TORQUES],
        "samples: 16\nindices: 16\noutputs: [peak_to_peak, mean, largest_pressure]",
    );
    let (of, warnings) = ran(&text);
    // These loads press tip corners against the flanks.
    assert!(warnings.iter().all(|told| told.contains("`corner_contact` is `none`")), "{warnings:?}");
    let rows = of("rows");
    // Four fields: each sample itself, with one field after the other, and with all; three torques.
    assert_eq!(rows.rows(), 16 * 6 * 3);
    assert!(rows.texts("reason").iter().all(String::is_empty), "{:?}", rows.texts("reason")[0]);
    for row in [0, 4, 17, 100, 287] {
        let value = |name: &str| rows.floats(name)[row];
        let design = DESIGN
            .replace("amount: 8 um", &format!("amount: {} um", value("amount")))
            .replace("pinion, amount: 0 um", &format!("pinion, amount: {} um", value("slope")));
        let ste = STE.replace(
            "50 N m",
            &format!(
                "{} N m, helix_slope: {} um, parallelism_out_of_plane: {} um",
                value("torque"),
                value("tilt"),
                value("shaft")
            ),
        );
        let alone = walk(&load(&study(&[PAIR, STIFFNESS, &design, &ste])));
        let summary = alone["ste"].tables.iter().find(|table| table.name() == "summary").unwrap().clone();
        for column in ["peak_to_peak", "mean", "largest_pressure"] {
            assert_eq!(summary.floats(column)[0].to_bits(), value(column).to_bits(), "{column} of row {row}");
        }
        assert!((summary.floats("helix_slope")[0] - value("tilt")).abs() < 1e-12);
    }
    // Of a sample with another field, that field is the one of the sample that has all of them.
    let (replaced, tilts) = (rows.integers("replaced"), rows.floats("tilt"));
    let place = rows.schema().columns.iter().filter(|column| column.name != "torque").position(|c| c.name == "tilt");
    let tilt = i64::try_from(place.unwrap() - 2 + 1).unwrap();
    for sample in rows.integers("sample").chunks(18).zip(0..).map(|(_, sample)| sample * 18..(sample + 1) * 18) {
        let at = |which: i64| sample.clone().find(|row| replaced[*row] == which).map(|row| tilts[row].to_bits());
        assert_eq!(at(tilt), at(5), "the field of another point");
        assert_ne!(at(tilt), at(0));
    }
}

/// The distribution of each field: what a class of tolerances comes to, and that samples fill it evenly.
#[test]
fn samples_fill_their_distributions() {
    let slope = "slope: { field: \"designs.designs.long[2].profile_slope.amount\", iso1328: 7 }";
    let helix = "helix: { field: ste.gear_helix_slope, iso1328: 6, shape: normal }";
    let mode = "length: { field: \"designs.designs.long[1].tip_relief.length\", from: 4 mm, mode: 5 mm, to: 5.5 mm }";
    let text =
        scattered(&[AMOUNT, TILT, slope, helix, mode], "samples: 512\nindices: 0\noutputs: [unloaded_peak_to_peak]");
    let (of, _) = ran(&text);
    let (rows, fields) = (of("rows"), of("fields"));
    assert_eq!(rows.rows(), 512);
    let of_field = |name: &str| {
        let at = fields.texts("field").iter().position(|field| field == name).unwrap();
        ["mean", "standard_deviation", "from", "to"].map(|column| fields.floats(column)[at])
    };
    // ISO 1328-1: pinion 19, module 3, class 7: 11 µm; gear 48, 18 mm wide, class 6: (0.6 + 1.485 + 4)·√2 = 8.605, so 8.5 µm.
    let [.., from, to] = of_field("slope");
    assert!((from + 11.0).abs() < 1e-9 && (to - 11.0).abs() < 1e-9, "{from} {to}");
    let [_, deviation, from, to] = of_field("helix");
    assert!((from + 8.5).abs() < 1e-9 && (to - 8.5).abs() < 1e-9, "{from} {to}");
    assert!((deviation - 8.5 / 3.0 * 0.986_58).abs() < 1e-4 * deviation, "cut off at three: {deviation}");
    let [mean, ..] = of_field("length");
    assert!((mean - 14.5 / 3.0).abs() < 1e-12);
    for name in ["amount", "tilt", "slope", "helix", "length"] {
        let ([mean, deviation, from, to], values) = (of_field(name), rows.floats(name));
        let found = values.iter().sum::<f64>() / 512.0;
        // Eight nets of 64: far closer than the 4 % of independent ones.
        assert!((found - mean).abs() < 0.01 * deviation, "{name}: {found} {mean}");
        let squares = values.iter().map(|value| (value - found) * (value - found)).sum::<f64>() / 512.0;
        assert!((squares.sqrt() / deviation - 1.0).abs() < 0.03, "{name}: {} {deviation}", squares.sqrt());
        assert!(values.iter().all(|value| (from..=to).contains(value) || from.is_infinite()), "{name}");
    }
}

/// Same seed, same bits, with any number of threads; another seed gives others.
#[test]
fn bits_depend_on_the_seed_alone() {
    let text = scattered(&[AMOUNT, TILT, TORQUES], "samples: 64\nindices: 16\noutputs: [peak_to_peak]");
    let with = |threads: usize, text: &str| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let (of, _) = ran(text);
            (of("rows").content_hash(), of("indices").content_hash(), of("quantiles").content_hash())
        })
    };
    let one = with(1, &text);
    assert_eq!(one, with(3, &text));
    assert_ne!(one.0, with(1, &text.replace("seed: 3", "seed: 4")).0);
}

/// Geometry scatters too, and gears that cannot be are counted, shown and told.
#[test]
fn impossible_gears_are_counted_and_not_dropped() {
    let length = "length: { field: \"designs.designs.long[1].tip_relief.length\", from: 4 mm, to: 16 mm }";
    let shift = "shift: { field: pair.pinion.profile_shift, within: 0.02 }";
    let text = scattered(
        &[length, shift],
        "samples: 64\nindices: 16\noutputs: [peak_to_peak]\nlimits: [peak_to_peak <= 100 um]",
    );
    let (of, warnings) = ran(&text);
    let (rows, yields, invalid) = (of("rows"), of("yield"), of("invalid"));
    let own = (0..rows.rows()).filter(|row| rows.integers("replaced")[*row] == 0);
    let lost = own.filter(|row| !rows.texts("reason")[*row].is_empty()).count();
    assert!(lost > 3 && lost < 60, "{lost}");
    let lost_there: i64 = invalid.integers("rows").iter().sum();
    assert_eq!(usize::try_from(lost_there).unwrap(), lost);
    for at in 0..yields.rows() {
        assert_eq!(yields.integers("samples")[at], 64);
        assert_eq!(usize::try_from(yields.integers("kept")[at]).unwrap(), 64 - lost, "{}", yields.texts("limit")[at]);
    }
    assert!(warnings.iter().any(|told| told.contains(&format!("{lost} of 64 samples"))), "{warnings:?}");
    assert_eq!(usize::try_from(of("statistics").integers("samples")[0]).unwrap(), 64 - lost);
    assert!(of("indices").integers("pairs")[0] < 16, "pairs that lack a number do not count");
}
