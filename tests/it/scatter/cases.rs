//! Load cases beside torque: what a pair is off by, in the stage that loads it and in a search.

use super::*;

/// Tier: second method; a helix slope of the gear, which has the common face width, opens the gap that the load case states.
/// Tables have the deviations as keys.
#[test]
fn deviations_are_keys_of_the_tables_of_ste() {
    let ste = STE.replace("50 N m", "[50 N m, 80 N m], helix_slope: [-15 um, 0 um, 15 um]");
    let cases = walk(&load(&study(&[PAIR, STIFFNESS, DESIGN, &ste])));
    let of = |name: &str| cases["ste"].tables.iter().find(|table| table.name() == name).unwrap();
    let summary = of("summary");
    assert_eq!(summary.rows(), 6);
    assert_eq!(summary.floats("helix_slope"), [-15.0, 0.0, 15.0, -15.0, 0.0, 15.0]);
    assert_eq!(of("harmonics").rows(), 18);
    let design = format!("{DESIGN}        - helix_slope: {{ gear: gear, amount: 15 um }}\n");
    let slope = walk(&load(&study(&[PAIR, STIFFNESS, &design, STE])));
    let alone = slope["ste"].tables.iter().find(|table| table.name() == "summary").unwrap();
    let close = |one: f64, two: f64| assert!((one / two - 1.0).abs() < 1e-9, "{one} {two}");
    close(summary.floats("peak_to_peak")[2], alone.floats("peak_to_peak")[0]);
    // The modification takes material off, half of it on average.
    close(summary.floats("mean")[2], alone.floats("mean")[0] - 7.5);
    // An even face does not tell the signs apart.
    close(summary.floats("peak_to_peak")[0], summary.floats("peak_to_peak")[2]);
}

/// Shafts that are not parallel, over a span of their own: as a helix slope of the same gap, 2.75 times as much across the plane
/// of the axes as in it.
#[test]
fn parallelism_is_a_slope_over_the_bearing_span() {
    let at = |off: &str| {
        let ste = STE.replace("50 N m", &format!("50 N m, {off}"));
        let ran = walk(&load(&study(&[PAIR, STIFFNESS, DESIGN, &ste])));
        ran["ste"].tables.iter().find(|table| table.name() == "summary").unwrap().floats("peak_to_peak")[0]
    };
    let angle = 20_f64.to_radians();
    // Over 90 mm, 18 mm of which are the face.
    let slope = |sine: f64| format!("helix_slope: {} um", 60.0 * sine * 18.0 / 90.0);
    let close = |one: f64, two: f64| assert!((one / two - 1.0).abs() < 1e-9, "{one} {two}");
    close(at("parallelism_in_plane: 60 um, bearing_span: 90 mm"), at(&slope(angle.sin())));
    close(at("parallelism_out_of_plane: 60 um, bearing_span: 90 mm"), at(&slope(angle.cos())));
    assert!((at(&slope(angle.cos())) / at(&slope(angle.sin())) - 1.0).abs() > 0.02, "and both are to be seen");
}

/// Tier: second method; the stage that loads the design that is found, case by case.
#[test]
fn a_search_over_cases_counts_what_the_stage_gives_for_each() {
    let off = "helix_slope: [-12 um, 0 um, 12 um]";
    let search = |at: &str| {
        format!(
            "  found:\n    kind: optimizer\n    name: found\n    stiffness: stiffness\n    method: {{ grid: {{ levels: 3 }} }}\n    \
             positions: 16\n    at: {{ torque: [25 N m, 50 N m], {off}{at} }}\n    design:\n      \
             - end_relief: {{ gear: gear, amount: [4 um, 10 um], length: 4 mm, end: I }}\n"
        )
    };
    let ste =
        STE.replace("designs: designs, torque: 50 N m", &format!("designs: found, torque: [25 N m, 50 N m], {off}"));
    let ran = |at: &str| walk(&load(&study(&[PAIR, STIFFNESS, &search(at), &ste])));
    let of = |at: &str| {
        let ran = ran(at);
        let table =
            |stage: &str, name: &str| ran[stage].tables.iter().find(|table| table.name() == name).unwrap().clone();
        (table("found", "best").floats("objective")[0], table("ste", "summary").floats("peak_to_peak").to_vec())
    };
    let close = |one: f64, two: f64| assert!((one / two - 1.0).abs() < 1e-9, "{one} {two}");
    let (worst, all) = of("");
    assert_eq!(all.len(), 6);
    close(worst, all.iter().copied().fold(0.0, f64::max));
    // A relief at one end tells the signs apart.
    assert!((all[3] / all[5] - 1.0).abs() > 1e-3, "{all:?}");
    let weights = "weights: [{ torque: 50 N m, weight: 3 }, { torque: 25 N m, weight: 1 }]";
    let (mean, all) = of(&format!(", combine: mean, {weights}"));
    close(mean, (all[..3].iter().sum::<f64>() + 3.0 * all[3..].iter().sum::<f64>()) / 12.0);
    let (quantile, mut all) = of(", combine: quantile, quantile: 50 %");
    all.sort_by(f64::total_cmp);
    close(quantile, all[2]);
}
