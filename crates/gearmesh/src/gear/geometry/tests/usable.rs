//! Where contact ends at a root form circle: found by turning two drawn gears, and what is still refused.

use super::outline::shaped;
use super::passing::{between, seen, turns};
use super::*;
use crate::gear::geometry::outline::curve::OutlinePart;
use crate::gear::geometry::outline::sample::Density;

/// How far the flank of the mate is from the drawn pinion while the mate's tooth is at an angle, and the radii at which they are
/// nearest, on the pinion and on the gear.
fn apart(pair: &GearPair, own: &[[f64; 2]], mate: &[[f64; 2]], angle: f64) -> [f64; 3] {
    let turns = turns(pair, Side::Pinion, angle);
    let mut best = [f64::INFINITY, 0.0, 0.0];
    for &[x, y] in mate {
        let point = seen(pair, turns, [x, y]);
        for segment in own.windows(2) {
            let ([a, b], [c, d]) = (segment[0], segment[1]);
            let (dx, dy) = (c - a, d - b);
            let along = (((point[0] - a) * dx + (point[1] - b) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
            let foot = [a + along * dx, b + along * dy];
            let distance = between(point, foot);
            if distance < best[0] {
                best = [distance, foot[0].hypot(foot[1]), x.hypot(y)];
            }
        }
    }
    best
}

/// Tier: second method; polylines of both drawn flanks, turned gear by gear: they touch from the pinion's form circle on, at the
/// gear's tip usable circle, and nothing touches before, although the gear's tip goes on.
#[test]
fn drawn_gears_touch_from_the_form_circle_on() {
    for (pinion, gear) in [(12, 48), (14, 100), (10, 24)] {
        let pair = pair(pinion, gear).unwrap();
        assert!(pair.is_curtailed(Side::Pinion) && !pair.is_curtailed(Side::Gear));
        let fine = Density { points: 1000, chord_error: None };
        let outlines = [Side::Pinion, Side::Gear].map(|side| {
            let outline = shaped(pair.side(side), "trochoid").unwrap();
            let all = outline.half(fine);
            let flank = all
                .iter()
                .filter(|point| outline.segments[point.segment].part == OutlinePart::Flank || side == Side::Pinion);
            flank.map(|point| point.local.position).collect::<Vec<_>>()
        });
        let at = |angle: f64| apart(&pair, &outlines[0], &outlines[1], angle);
        // The mate's tooth swings from one side to the other; it is in touch for as long as contact lasts.
        let gap = 1e-7;
        let step = 4e-3;
        let touching: Vec<f64> =
            (-100..150).map(|count| f64::from(count) * step).filter(|angle| at(*angle)[0] < gap).collect();
        let turned = (touching[touching.len() - 1] - touching[0] + step) * pair.gear.base_radius;
        let lasts = pair.end_of_contact - pair.start_of_contact;
        assert!((turned - lasts).abs() < 2.0 * step * pair.gear.base_radius, "{pinion}: {turned:e} for {lasts:e}");
        // One of both ends is at the form circle.
        let ends = [touching[0], touching[touching.len() - 1]].map(at);
        let [_, on_pinion, on_gear] = if ends[0][1] < ends[1][1] { ends[0] } else { ends[1] };
        let usable = [pair.pinion.form_radius, pair.gear.radius_at(pair.highest_roll(Side::Gear))];
        for (found, expected) in [on_pinion, on_gear].into_iter().zip(usable) {
            assert!(
                (found - expected).abs() < 2.0 * step * pair.gear.base_radius,
                "{pinion}: {found:e} for {expected:e}"
            );
        }
        assert!(usable[1] < pair.gear.tip_radius - 0.05e-3, "the tip goes on");
    }
}

/// Tier: closed form; T1A is the radius of curvature at the form circle, and both usable circles pass through A.
#[test]
fn contact_ends_at_the_usable_circles() {
    let pair = pair(12, 48).unwrap();
    let form = pair.pinion.form_radius;
    let start = ((form - pair.pinion.base_radius) * (form + pair.pinion.base_radius)).sqrt();
    assert_near(pair.start_of_contact, start, 1e-15, "A");
    let usable = pair.gear.radius_at(pair.highest_roll(Side::Gear));
    assert_near(usable, (pair.tangent_length - start).hypot(pair.gear.base_radius), 1e-15, "d_Na2");
    assert_near(pair.pinion.radius_at(pair.lowest_roll(Side::Pinion)), form, 1e-15, "d_Nf1");
    // What is left of contact.
    let ratio = (pair.end_of_contact - start) / pair.base_pitch;
    assert_near(pair.contact_ratio, ratio, 1e-14, "contact ratio");
}

/// Tier: closed form; what is left and what is lost are the contact ratio of the tips alone. And on the centre distance without
/// backlash there is none.
#[test]
fn what_contact_loses_is_what_is_left() {
    for (teeth, lost) in [((12, 48), true), ((14, 100), true), ((24, 36), false)] {
        let pair = pair(teeth.0, teeth.1).unwrap();
        let along = |gear: &Gear| (gear.tip_radius.powi(2) - gear.base_radius.powi(2)).sqrt();
        let of_tips = (along(&pair.pinion) + along(&pair.gear) - pair.tangent_length) / pair.base_pitch;
        assert_near(pair.contact_ratio + pair.lost_contact_ratio(), of_tips, 1e-12, "contact ratio");
        assert_eq!(pair.lost_contact_ratio() > 1e-3, lost, "{teeth:?}: {}", pair.lost_contact_ratio());
        assert_near(pair.nearest_centre_distance(), pair.centre_distance, 1e-12, "no backlash");
        let thin = |teeth| Specification { thickness_allowance: -80e-6, ..specification(teeth, 3.0, 0.0) };
        let thin = GearPair::new(thin(teeth.0), thin(teeth.1), None).unwrap();
        let nearest =
            GearPair::new(thin.pinion.specification, thin.gear.specification, Some(thin.nearest_centre_distance()));
        assert!(thin.nearest_centre_distance() < thin.centre_distance - 1e-5);
        assert_near(nearest.unwrap().backlash().normal, 0.0, 1e-15, "backlash");
    }
}

/// A tip that would be in the root is an error: deeper than the rack, whose round begins where the flank ends.
#[test]
fn a_tip_that_cuts_in_is_refused() {
    let rack = Rack { addendum: 1.0, dedendum: 1.4, tip_radius: 0.39, ..Rack::ISO_53_A };
    let of = |teeth, longer: f64| Specification {
        rack,
        tip_radius: Some(3e-3 * (0.5 * f64::from(teeth) + 1.0 + longer)),
        ..specification(teeth, 3.0, 0.0)
    };
    let pair = |longer: f64| GearPair::new(of(30, 0.0), of(60, longer), None);
    let free = pair(0.0).unwrap();
    assert!(!free.is_curtailed(Side::Pinion) && free.refuse_interference().is_ok());
    let error = pair(0.38).unwrap_err();
    assert!(matches!(error.problem, Problem::Interference { .. }) && error.side == Some(Side::Pinion), "{error}");
    // The largest tip that the message names is just not curtailed.
    let Problem::Interference { largest, .. } = error.problem else { unreachable!() };
    let longest = largest.0 / 3e-3 - 31.0;
    assert!(!pair(longest - 1e-9).unwrap().is_curtailed(Side::Pinion));
    assert!(pair(longest + 1e-4).is_err());
}
