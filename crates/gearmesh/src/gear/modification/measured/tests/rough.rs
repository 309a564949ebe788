//! Curves of traces at 64 positions against those at thousands.

use super::*;
use crate::gear::mesh::answers::curve::Summary;

fn summary(pair: &GearPair, positions: usize, design: &Design) -> Summary {
    let settings = Settings { positions, ..Settings::default() };
    let cycle = Mesh::new(pair, &varying(), settings).unwrap();
    cycle.loaded(design, 50.0).curve_and_summary(Wanted::default()).1
}

/// Tier: second method; waves longer and shorter than the distance of positions: the mean of 64 positions is that of 8,192 to 1e-3, the loaded contact
/// ratio to 3e-3.
#[test]
fn few_positions_see_waves_as_many_do() {
    let pair = pair();
    for (amplitude, length, mean) in [(2e-6, 4e-3, 5e-5), (0.3e-6, 0.5e-3, 1e-3), (1e-6, 0.3e-3, 1e-3)] {
        let design = wavy(&pair, amplitude, length);
        let [few, many] = [64, 8192].map(|positions| summary(&pair, positions, &design));
        let off = [(few.mean - many.mean) / many.mean, few.loaded_contact_ratio - many.loaded_contact_ratio];
        assert!(off[0].abs() < mean && off[1].abs() < 3e-3, "{length}: {off:?}");
    }
}

/// Tier: second method; crests of both flanks between 64 positions: the extrema next to the highest and lowest nodes are refined, so that a peak-to-peak value is never
/// larger than that of 8,192 positions, and smaller by the crests that no node is near; without refining 3.2 and 2.3 %.
#[test]
fn peaks_between_positions_that_do_not_see_each_crest_are_looked_for() {
    let pair = pair();
    for (length, missed) in [(0.5e-3, 2.5e-2), (0.4e-3, 5e-3)] {
        let mut design = wavy(&pair, 0.5e-6, length);
        let turn = std::f64::consts::TAU * pair.gear.base_radius / length;
        let waves = |roll: f64| 0.5e-6 * libm::sin(turn * roll);
        design.add(Gears::Gear, &profile(&pair, Side::Gear, 1500, waves), &pair).unwrap();
        let [few, many] = [64, 8192].map(|positions| summary(&pair, positions, &design));
        let share = few.peak_to_peak / many.peak_to_peak - 1.0;
        assert!(share > -missed && share < 1e-6, "{length}: {share}");
        assert!((few.mean - many.mean).abs() < 2e-3 * many.mean);
    }
}

/// Tier: second method; a trace that rings about the kink of a relief: its pairs take up load where those of the relief do.
#[test]
fn a_trace_that_rings_about_a_kink_keeps_the_places_where_pairs_take_up_load() {
    let pair = pair();
    let kinked = relieved(&pair, 12e-6, 4e-3, Curve::Parabolic);
    let [exact, found] = [&kinked, &traced(&pair, &kinked, 500)].map(|design| summary(&pair, 64, design));
    assert!((exact.loaded_contact_ratio - found.loaded_contact_ratio).abs() < 1e-4);
    assert!((exact.mean - found.mean).abs() < 5e-5 * exact.mean);
}
