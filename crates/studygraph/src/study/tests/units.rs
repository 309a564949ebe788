//! Units of a study: what is read alike, what is refused because it could mean two things, and where.

use super::{changed, each_is_refused, load};

const CHANGES: &[(&str, &str, &str)] = &[
    (
        "value: 2.316 um",
        "value: 19.05 N/mm um",
        "34:12: `N/mm um` in `19.05 N/mm um` can be read in two ways\n  help: write the unit as `N/(mm um)` or `N um/mm`",
    ),
    (
        "value: 2.316 um",
        "value: 206*GPa",
        "34:12: `*GPa` in `206*GPa` cannot be read as a unit: nothing stands before `*`\n  help: write `206 GPa`",
    ),
    (
        "value: 2.316 um",
        "value: 3 N/",
        "34:12: `N/` in `3 N/` cannot be read as a unit: nothing stands after `/`\n  help: units are written like `mm`, `N m`, `N/(mm um)` or `1/um^2`",
    ),
    (
        "overlap: 12.5 %",
        "youngs_modulus: 206 *GPa*",
        "11:21: `*GPa*` in `206 *GPa*` cannot be read as a unit: nothing stands before `*`; a stress (for example `206 GPa`) is expected\n  help: write `206 GPa`",
    ),
    // Only one reading is a stress.
    (
        "overlap: 12.5 %",
        "youngs_modulus: 0.206 kN/mm um",
        "11:21: `kN/mm um` in `0.206 kN/mm um` can be read in two ways; a stress (for example `206 GPa`) is expected\n  help: write `0.206 kN/(mm um)`",
    ),
    (
        "overlap: 12.5 %",
        "youngs_modulus: 206 N um/mm^2 s",
        "11:21: `N um/mm^2 s` in `206 N um/mm^2 s` can be read in two ways; a stress (for example `206 GPa`) is expected\n  help: write the unit as `N um/(mm^2 s)` or `N um s/mm^2`",
    ),
    // The place is that of the point of the axis.
    (
        "torque: { from: 25 N m, to: 100 N m, count: 16 }",
        "torque: [25 N m, 50 N**m]",
        "30:22: `N**m` in `50 N**m` cannot be read as a unit: nothing stands between `*` and `*`; a torque (for example `100 N m`) is expected\n  help: write `50 N m`",
    ),
    (
        "module: 3 mm",
        "module: 3 mm^0",
        "8:13: `mm^0` in `3 mm^0` cannot be read as a unit: a power is a whole number from 1 to 9 or from -9 to -1; a length (for example `3 mm`) is expected\n  help: units are written like `mm`, `N m`, `N/(mm um)` or `1/um^2`",
    ),
];

#[test]
fn a_unit_that_could_mean_two_things_or_nothing_is_refused_with_what_to_write() {
    each_is_refused(CHANGES);
}

#[test]
fn negative_powers_and_repeated_divisions_are_the_same_quantity() {
    let modulus = |text: &str| {
        let study = load(&changed("overlap: 12.5 %", &format!("youngs_modulus: {text}"))).unwrap();
        let pair = study.nodes.iter().find(|node| node.name == "pair").unwrap();
        pair.record.quantity("youngs_modulus").to_bits()
    };
    for text in ["206 N/(mm um)", "206 N/mm/um", "206 N mm^-1 um^-1", "206e9 N m^-2", "206e3 N mm⁻²", "206e9 Pa"] {
        assert_eq!(modulus(text), 206e9_f64.to_bits(), "{text}");
    }
}

/// What a message offers is taken where it was offered.
#[test]
fn what_is_offered_is_accepted() {
    for (old, new, message) in CHANGES {
        let Some((_, offered)) = message.split_once("help: write `") else { continue };
        let offered = offered.trim_end_matches('`');
        let field = new.split(':').next().unwrap();
        if !new.contains('[') {
            load(&changed(old, &format!("{field}: {offered}"))).unwrap_or_else(|error| panic!("{offered}: {error}"));
        }
    }
}
