//! What a curve spans is the summary's peak-to-peak, over random pairs, loads and designs.

use crate::gear::contact::{CornerContact, SliceCoupling};
use crate::gear::mesh::Settings;
use crate::gear::mesh::answers::curve::{Point, Wanted};
use crate::gear::random::Random;

/// Tier: invariant. What a curve spans is the summary's peak-to-peak, under load and without, also where corners touch; its
/// points are in order, and no share of the load exceeds 1.
#[test]
fn a_curve_spans_its_summary_s_peak_to_peak() {
    let mut random = Random::new(13);
    let mut added = 0;
    for case in 0..200 {
        let corner_contact = random.of(&[CornerContact::None, CornerContact::Exact]);
        let positions = random.of(&[8, 16, 24]);
        let settings = Settings { positions, slices: 5, corner_contact, slice_coupling: SliceCoupling::None };
        let case = (case, random.case(settings));
        let loading = case.1.load_case();
        let (points, summary) = loading.curve_and_summary(Wanted::default());
        let spanned = |value: &dyn Fn(&Point) -> f64| {
            let values = || points.iter().map(value);
            values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
        };
        let loaded = spanned(&|point| point.transmission_error);
        assert!((loaded - summary.peak_to_peak).abs() <= 1e-15 * summary.largest.value, "{}: {loaded:e}", case.0);
        let unloaded = spanned(&|point| point.unloaded_transmission_error);
        assert!((unloaded - summary.unloaded_peak_to_peak).abs() <= 1e-12 * unloaded.abs(), "{}: {unloaded:e}", case.0);
        for two in points.windows(2).filter(|two| two[0].pairs == two[1].pairs) {
            assert!(two[0].cycle_position <= two[1].cycle_position, "{}", case.0);
        }
        let share = summary.largest_load_share;
        assert!((1.0 / 6.0..=1.0).contains(&share), "{}: {share}", case.0);
        for point in &points {
            assert!(point.loads.iter().all(|load| *load <= point.load()), "{}: {point:?}", case.0);
        }
        let nodes = loading.trace().nodes(&loading.mesh().rows);
        let is_node = |point: &Point| nodes.iter().any(|node| node.position.total_cmp(&point.cycle_position).is_eq());
        added += usize::from(!points.iter().all(is_node));
    }
    assert!(added > 100, "extrema between nodes: {added}");
}
