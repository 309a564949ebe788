//! The formulas at points that others have evaluated, with the values that their texts and programs print.

use super::*;

/// Worth of a point in the unit of the sources, volume in cm³.
fn worth(stated: &SpeedReducer, point: [f64; 7]) -> Worth {
    let mut si = point.map(|length| length * CENTIMETRE);
    si[2] = point[2];
    let mut worth = stated.problem().worth(&si);
    if stated.minimize[0] == Minimized::Volume {
        worth.objective /= CUBIC_CENTIMETRE;
    }
    worth
}

fn cagnina(second_length: f64) -> SpeedReducer {
    SpeedReducer { constants: Constants::Cagnina2008, second_length, ..SpeedReducer::default() }
}

fn near(found: f64, printed: f64, digits: f64) {
    assert!((found - printed).abs() <= digits, "{found} is not {printed}");
}

/// Tier: other program; genoxide's page of its example `speed-reducer` evaluates the
/// design that Cagnina, Esquivel and Coello print to six digits: its weight, by how much it breaks two constraints, and what
/// an eighteenth tooth costs.
#[test]
fn the_published_design_weighs_and_breaks_what_another_program_prints() {
    let printed = [3.5, 0.7, 17.0, 7.3, 7.8, 3.350_214, 5.286_683];
    let found = worth(&cagnina(0.078), printed);
    near(found.objective, 2_996.347_849, 5e-7);
    near(-found.constraints[4], 6.0e-7, 5e-9);
    near(-found.constraints[5], 1.3e-7, 5e-9);
    let (at_limit, kept): (Vec<f64>, Vec<f64>) = found.constraints.iter().partition(|reserve| reserve.abs() < 1e-6);
    assert!(at_limit.len() == 3 && kept.len() == 8 && kept.iter().all(|reserve| *reserve > 0.01), "{found:?}");
    let tooth = worth(&cagnina(0.078), [3.5, 0.7, 18.0, 7.3, 7.8, 3.350_214, 5.286_683]);
    near(tooth.objective - found.objective, 177.0, 0.5);
}

/// Tier: published value; points and minima of the three sets of constants. The first two are the same but for the least
/// length of the second shaft, the third was printed by Talatahari, Bayzidi and Saraee with their own formulas.
#[test]
fn each_set_of_constants_has_the_minimum_that_is_printed_with_it() {
    let corner = [3.5, 0.7, 17.0, 7.3, 7.715_319_912_5, 3.350_214_666_2, 5.286_654_465];
    near(worth(&cagnina(0.073), corner).objective, 2_994.471_066, 5e-7);
    let longer = [3.5, 0.7, 17.0, 7.3, 7.8, 3.350_214_666_1, 5.286_683_229_8];
    near(worth(&cagnina(0.078), longer).objective, 2_996.348_165, 5e-7);
    let talatahari = SpeedReducer { constants: Constants::Talatahari2021, ..SpeedReducer::default() };
    let [bending, torsion] = [745.0 * 7.3 / 11.9, 16.91e6_f64];
    let first = (bending.hypot(torsion.sqrt()) / 110.0).cbrt();
    let found = worth(&talatahari, [3.5, 0.7, 17.0, 7.3, 7.715_319_912_5, first, 5.286_654_465]);
    near(found.objective, 2_994.424_465_8, 5e-8);
    assert!(found.constraints.iter().all(|reserve| *reserve > -1e-9), "{found:?}");
}

/// Tier: published value; the ideal point of RE3-7-5 is that of corners of the box. Its nadir has the stress and the
/// violation of the least volume.
#[test]
fn corners_of_the_box_have_the_ideal_point_of_re_3_7_5() {
    let minimize = vec![Minimized::Volume, Minimized::Stress, Minimized::Violation];
    let stated = SpeedReducer { minimize, ..SpeedReducer::default() };
    assert!(stated.problem().constraints().is_empty());
    let least = worth(&stated, [2.6, 0.7, 17.0, 7.3, 7.3, 2.9, 5.0]);
    near(least.objective, 2_352.346_111_45, 5e-9);
    near(least.further[0], 1_695.963_877_46, 5e-9);
    near(least.further[1], 397.358_927_317, 5e-9);
    let strongest = worth(&stated, [2.6, 0.8, 28.0, 7.3, 7.3, 3.9, 5.0]);
    near(strongest.further[0], 694.233_587_469, 5e-10);
    let kept = worth(&stated, [3.5, 0.7, 17.0, 7.75, 7.4, 3.9, 5.0]);
    near(kept.further[1], 0.0, 0.0);
}

/// Tier: closed form; teeth count as the nearest whole number, as the programs of RE3-7-5 have it, or as they are.
#[test]
#[allow(clippy::approx_constant, reason = "π/4 as it is printed")]
fn teeth_are_whole_or_real() {
    let point = |teeth| [3.5, 0.7, teeth, 7.3, 7.8, 3.4, 5.3];
    let volume = |teeth, z| worth(&SpeedReducer { teeth, ..SpeedReducer::default() }, point(z)).objective;
    near(volume(Teeth::Whole, 17.4), volume(Teeth::Real, 17.0), 0.0);
    near(volume(Teeth::Whole, 17.6), volume(Teeth::Real, 18.0), 0.0);
    let more = volume(Teeth::Real, 17.5) - volume(Teeth::Real, 17.0);
    near(more, 0.7854 * 3.5 * 0.49 * (10.0 / 3.0 * (17.5 * 17.5 - 289.0) + 0.5 * 14.933), 1e-9);
}

/// Tier: invariant; the box is that of the sources, and what a stage shows of it is in SI.
#[test]
fn the_box_is_that_of_the_sources() {
    let variables = cagnina(0.078).problem().variables();
    let bounds: Vec<[f64; 2]> = variables.iter().map(|variable| [variable.minimum, variable.maximum]).collect();
    let printed =
        [[0.026, 0.036], [0.007, 0.008], [17.0, 28.0], [0.073, 0.083], [0.078, 0.083], [0.029, 0.039], [0.05, 0.055]];
    for (found, printed) in bounds.iter().flatten().zip(printed.iter().flatten()) {
        near(*found, *printed, 1e-15);
    }
    let named = cagnina(0.073).objectives();
    assert_eq!(named, [Objective { name: "volume", dimension: VOLUME }]);
}
