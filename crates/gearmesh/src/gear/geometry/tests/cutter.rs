//! The rack as an oracle: a profile is right when the rolling rack touches every point of it and goes nowhere deeper.

use std::f64::consts::FRAC_PI_2;

use super::*;

/// The rack that cuts, at rest: distance of a point from one of its teeth, negative inside, by its half planes and
/// corners; y points from the pitch line to the tip. Knows nothing of envelopes.
fn distance_to_rack_tooth(specification: &Specification, x: f64, y: f64) -> f64 {
    let module = specification.module;
    let rack = &specification.rack;
    let (sine, cosine) = specification.pressure_angle.sin_cos();
    let round = rack.tip_radius * module;
    // The tooth without its outermost layer of thickness ρ is bounded by straight lines.
    let depth = rack.dedendum * module - round;
    let half_land = module * PI / 4.0 - depth * sine / cosine - round / cosine;
    let reference = -specification.profile_shift * module;
    distance_to_trapezoid([half_land, depth], specification.pressure_angle, round, [x, y - reference])
}

/// Distance from a trapezoid without upper end that is inflated by a round: half the width and the depth of its land, the angle of
/// its sides.
pub(super) fn distance_to_trapezoid([half_land, depth]: [f64; 2], angle: f64, round: f64, [x, y]: [f64; 2]) -> f64 {
    let (sine, cosine) = angle.sin_cos();
    let x = x.abs();
    let beside = (x - half_land) * cosine + (y - depth) * sine;
    let along = -(x - half_land) * sine + (y - depth) * cosine;
    let below = y - depth;
    let core = if x <= half_land && below > 0.0 {
        below
    } else if beside > 0.0 && along <= 0.0 {
        beside
    } else if beside <= 0.0 && below <= 0.0 {
        beside.max(below)
    } else {
        (x - half_land).hypot(below)
    };
    core - round
}

/// Least distance of a point of the tooth (x, y) to the rack over the whole roll.
pub(super) fn distance_to_swept_rack(gear: &Gear, x: f64, y: f64) -> f64 {
    distance_to_swept(gear, x, y, |x, y| distance_to_rack_tooth(&gear.specification, x, y))
}

/// The same to a rack with other teeth, by the distance of a point from one of them.
pub(super) fn distance_to_swept(gear: &Gear, x: f64, y: f64, tooth: impl Fn(f64, f64) -> f64) -> f64 {
    let specification = &gear.specification;
    let pitch = PI * specification.module;
    let at = |roll: f64| {
        // The tooth turns by `roll`, the rack moves with the pitch circle; its teeth are half a pitch beside. Of all its
        // teeth, the one within half a pitch is the nearest: they are convex and alike.
        let (sine, cosine) = roll.sin_cos();
        let across = x * cosine - y * sine + gear.reference_radius * roll - 0.5 * pitch;
        let depth = gear.reference_radius - (x * sine + y * cosine);
        tooth(across - (across / pitch).round() * pitch, depth)
    };
    // Contact is within cot α times the depth of the rack's tooth from the pitch point.
    let reach = 12.0 * specification.module / gear.reference_radius;
    let steps = 1200;
    let centre = x.atan2(y);
    let scan = |k: i32| centre + reach * (2.0 * f64::from(k) / f64::from(steps) - 1.0);
    // No point is nearer by more than it moves, and it turns about the pitch point.
    let radius = x.hypot(y);
    let lever = (radius - gear.reference_radius).hypot((radius * gear.reference_radius).sqrt() * reach);
    let moved = |by: i32| lever * 2.0 * reach * f64::from(by) / f64::from(steps);
    let (mut least, mut seen) = (f64::INFINITY, Vec::new());
    let mut open = vec![(0, steps)];
    while let Some((first, last)) = open.pop() {
        let middle = i32::midpoint(first, last);
        let value = at(scan(middle));
        least = least.min(value);
        seen.push((middle, value));
        if value - moved(last - middle) < least {
            open.extend([(first, middle - 1), (middle + 1, last)].into_iter().filter(|(first, last)| first <= last));
        }
    }
    // A thin neck is passed by the cutter on both sides: between two places either may be nearer than it is at them.
    let is_low = |k: i32, value: f64| value <= at(scan(k - 1)) && value <= at(scan(k + 1));
    let may_be_nearest = seen.into_iter().filter(|(k, value)| value - moved(1) < least && is_low(*k, *value));
    let nearest = |(k, _): (i32, f64)| {
        let (mut lower, mut upper) = (scan(k - 1), scan(k + 1));
        for _ in 0..60 {
            let (left, right) = (lower + 0.381_966 * (upper - lower), upper - 0.381_966 * (upper - lower));
            if at(left) < at(right) { upper = right } else { lower = left }
        }
        at(0.5 * (lower + upper))
    };
    may_be_nearest.map(nearest).fold(f64::INFINITY, f64::min)
}

/// Tier: the cutter itself. With 17 teeth the rack's straight flank ends 25 nm above the base circle, beyond the tangent
/// point, so the closed form of the form radius gives 11.981107 mm; the flank is cut down to 11.981087 mm.
#[test]
fn undercut_is_where_the_curves_cross() {
    let gear = gear(17, 1.5, 0.0);
    let curve = gear.trochoid();
    let distance = |(x, y): (f64, f64)| distance_to_swept_rack(&gear, x, y) * 1e3;
    let flank = |radius: f64| {
        let flank = gear.flank(gear.roll_at(radius));
        (flank.half_thickness, flank.height)
    };
    assert!(distance(flank(11.981_095e-3)).abs() < 1e-12, "the flank above the joint is left standing");
    assert!(distance(flank(11.981_083e-3)) < -1e-10, "the flank below the joint is cut away");
    assert!(distance(curve.point(20.0 * DEGREE)) < -1e-9, "the root curve above the joint is cut away");
    assert!(
        distance(curve.point(curve.joint() + 0.01)).abs() < 1e-12,
        "the root curve below the joint is left standing"
    );
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    /// Tier: the cutter itself. Every point of root and flank touches the swept rack, which nowhere goes deeper.
    #[test]
    fn the_cutter_touches_every_point(
        teeth in 7_u32..90, shift in -0.4..0.9_f64, angle in 14.5..28.0_f64, round in 0.0..1.0_f64, sharp in any::<bool>(),
    ) {
        let mut specification = specification(teeth, 3.0, shift);
        specification.pressure_angle = angle * DEGREE;
        specification.rack.addendum = 0.8;
        specification.rack.tip_radius = if sharp { 0.0 } else { round * crate::gear::geometry::trochoid::full_round(&specification) };
        specification.bore_radius = 1e-3;
        let Ok(gear) = Gear::new(&specification) else { return Err(TestCaseError::reject("no such gear")) };
        let curve = gear.trochoid();
        for k in 0..=6 {
            let part = f64::from(k) / 6.0;
            let (x, y) = curve.point(FRAC_PI_2 + part * (curve.joint() - FRAC_PI_2));
            let distance = distance_to_swept_rack(&gear, x, y) * 1e3;
            prop_assert!(distance.abs() < 1e-9, "root at {part}: {distance} mm, undercut {}", gear.undercut);
            let flank = gear.flank(gear.form_roll + part * (gear.tip_roll() - gear.form_roll));
            let distance = distance_to_swept_rack(&gear, flank.half_thickness, flank.height) * 1e3;
            prop_assert!(distance.abs() < 1e-9, "flank at {part}: {distance} mm, undercut {}", gear.undercut);
        }
    }
}
