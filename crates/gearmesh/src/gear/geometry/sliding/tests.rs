//! Rigid flanks in motion, and closed forms.

use std::f64::consts::PI;

use super::*;
use crate::gear::fixtures::standard;

fn pair(extra: f64) -> GearPair {
    let (pinion, gear) = (standard(19, 3e-3, 2.0), standard(48, 3e-3, 2.0));
    GearPair::new(pinion, gear, Some(3e-3 * 67.0 / 2.0 + extra)).unwrap()
}

/// Tier: second method; the speeds of the contact along both flanks by differences of the flanks' arc lengths, r_b u²/2.
#[test]
fn specific_sliding_is_that_of_arc_lengths() {
    let pair = pair(0.1e-3);
    let step = 1e-7;
    for share in [0.0, 0.2, 0.5, 0.9, 1.0] {
        let s = pair.start_of_contact + share * (pair.end_of_contact - pair.start_of_contact);
        let along = |side: Side| {
            let arc = |s: f64| 0.5 * pair.side(side).base_radius * pair.roll(side, s).powi(2);
            (arc(s + step) - arc(s - step)).abs()
        };
        for side in [Side::Pinion, Side::Gear] {
            let expected = 1.0 - along(side.other()) / along(side);
            assert!((pair.specific_sliding(side, s) - expected).abs() < 1e-6, "{side:?} {share}");
        }
        // Both flanks' speeds over that of the working circles, whose rolls by s are s/r_b.
        let speeds = [Side::Pinion, Side::Gear].map(along);
        let circles = 2.0 * step / libm::cos(pair.working_pressure_angle);
        assert!((pair.sliding_factor(s) - (speeds[0] - speeds[1]) / circles).abs() < 1e-6);
    }
}

#[test]
fn nothing_slides_at_the_pitch_point() {
    let pair = pair(0.0);
    let c = pair.zone_points().c;
    assert!(pair.sliding_factor(c).abs() < 1e-15);
    for side in [Side::Pinion, Side::Gear] {
        assert!(pair.specific_sliding(side, c).abs() < 1e-12);
    }
    let stands_still = pair.specific_sliding(Side::Pinion, 0.0);
    assert!(stands_still.is_infinite() && stands_still < 0.0);
}

/// Tier: closed form; j_bn = 2 a_w cos α_w (inv α_w − inv α) of gears without profile shift.
#[test]
fn backlash_follows_from_the_centre_distance() {
    for extra in [0.0, 1e-6, 0.1e-3, 0.5e-3] {
        let pair = pair(extra);
        let Backlash { circumferential, normal, radial } = pair.backlash();
        let involute = |angle: f64| libm::tan(angle) - angle;
        let angle = pair.working_pressure_angle;
        let opened = involute(angle) - involute(20.0 * PI / 180.0);
        let expected = 2.0 * pair.centre_distance * libm::cos(angle) * opened;
        assert!((normal - expected).abs() < 1e-15, "{normal} for {expected}");
        assert!((circumferential * libm::cos(angle) - normal).abs() < 1e-18);
        // The tangent at the working angle, so that it differs by the square of what the distance is larger.
        assert!((radial - extra).abs() < 20.0 * extra * extra / pair.centre_distance + 1e-15);
    }
}
