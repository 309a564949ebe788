//! Gaps of profiles that are no quadratics but know their derivatives.

use super::*;
use crate::gear::fixtures::least_gap;
use crate::gear::geometry::GearPair;

/// The article's designs, shallow and deep, on either gear and on both.
fn arcs(pair: &GearPair) -> Vec<Design> {
    let shares = |tip: f64, length: f64| [("tip_share", Number(tip)), ("length_share", Number(length))];
    let of = |parts: &[NamedModification]| design(pair, parts).unwrap();
    vec![
        of(&[("arc", "pinion", &shares(0.02, 0.25))]),
        of(&[("arc", "gear", &shares(0.1, 0.05))]),
        of(&[("arc", "pinion", &shares(0.06, 0.15)), ("arc", "gear", &shares(0.04, 0.2))]),
        of(&[("parabola", "pinion", &shares(0.06, 0.15)), ("parabola", "gear", &shares(0.1, 0.25))]),
        of(&[("arc", "both", &shares(0.05, 0.2)), ("tip_relief", "pinion", &ramp(8e-6, 3e-3, "parabolic"))]),
    ]
}

/// Tier: second method; to rounding, at quick copies too, which need no more pieces than a few.
#[test]
fn gaps_of_arcs_are_the_least_of_a_search_by_thirds() {
    let pair = pair();
    let window = (pair.start_of_contact, pair.end_of_contact);
    for (index, design) in arcs(&pair).iter().enumerate() {
        let profiles = design.profiles(0.0);
        let gaps = Gaps::new(&pair, &profiles);
        assert!(gaps.is_convex, "{index}");
        let breaks = gaps.breaks(window);
        let copy = gaps.copied(&crate::numeric::piecewise::Rule::new(), &breaks);
        let mut missing = 0;
        for step in 0..=300 {
            let s = window.0 + (window.1 - window.0) * f64::from(step) / 300.0;
            let exact = least_gap(&pair, design, s);
            let found = gaps.at(s).unwrap();
            assert!((found - exact).abs() < 4e-16 + 1e-12 * exact, "{index} {s}: {found:e} {exact:e}");
            match copy.value(s) {
                Some(copied) => assert!((copied - exact).abs() < 4e-16 + 1e-12 * exact, "{index} {s}: {copied:e}"),
                None => missing += 1,
            }
        }
        // Next to where it vanishes alone.
        assert!(missing < 12, "{index}: {missing} without a copy");
        assert!(copy.pieces() <= 4 * breaks.len(), "{index}: {} pieces between {breaks:?}", copy.pieces());
    }
}
