//! Section, and profile shifts that follow from a centre distance.

use std::sync::Arc as Shared;

use super::outline::shaped;
use super::*;
use crate::gear::geometry::outline::Outline;
use crate::gear::geometry::outline::curve::{Curve, OutlinePart, Relief, Segment};
use crate::gear::geometry::outline::roots::Toe;
use crate::gear::geometry::outline::sample::Density;
use crate::gear::geometry::outline::section::Section;
use crate::gear::geometry::outline::tip::Tip;
use crate::gear::geometry::pair::{profile_shift_sum, tip_shortening};

/// What a closed polygon encloses, whose corners are `points`; its second moment about the origin.
fn polygon(points: &[[f64; 2]]) -> Section {
    let mut sum = Section { area: 0.0, polar_moment: 0.0 };
    for (index, [x, y]) in points.iter().enumerate() {
        let [next_x, next_y] = points[(index + 1) % points.len()];
        let cross = x * next_y - next_x * y;
        let squares = x * x + x * next_x + next_x * next_x + y * y + y * next_y + next_y * next_y;
        sum.area += 0.5 * cross;
        sum.polar_moment += cross * squares / 12.0;
    }
    sum
}

#[derive(Debug)]
struct Parabola {
    from: f64,
}

impl Relief for Parabola {
    fn depth(&self, roll: f64) -> f64 {
        1e-4 * (roll - self.from).max(0.0).powi(2)
    }

    fn breaks(&self) -> Vec<f64> {
        vec![self.from]
    }
}

/// Tier: second method; a polygon whose chords are within 1 nm of the profile, and the whole gear as z such teeth.
#[test]
fn a_section_is_that_of_a_polygon() {
    let density = Density { points: 8, chord_error: Some(1e-9) };
    for (teeth, shift, root) in [(12, 0.0, "trochoid"), (12, 0.5, "trochoid"), (19, 0.0, "arc"), (60, -0.2, "trochoid")]
    {
        let gear = gear(teeth, 3.0, shift);
        let plain = shaped(&gear, root).unwrap();
        let toe = Toe {
            segments: plain.segments.iter().filter(|of| of.part == OutlinePart::Root).cloned().collect(),
            form_roll: plain.form_roll,
        };
        let from = 0.5 * (plain.form_roll + plain.end_roll);
        for tip in [Tip::Land, Tip::Chamfer(0.2e-3), Tip::Rounding(0.2e-3)] {
            for relief in [None, Some(Shared::new(Parabola { from }) as Shared<dyn Relief>)] {
                let outline = Outline::new(&gear, toe.clone(), tip, relief).unwrap();
                let mut right: Vec<[f64; 2]> = Vec::new();
                right.extend(outline.half(density).iter().map(|point| point.local.position));
                let mut corners = vec![[0.0; 2]];
                corners.extend(&right);
                let half = polygon(&corners);
                let halves = 2.0 * f64::from(teeth);
                let found = outline.section();
                let size = gear.tip_radius;
                // Twice the profile's length by 1 nm, in units of the section.
                assert_near(found.area / (halves * half.area), 1.0, 1e-6, "area");
                assert_near(found.polar_moment / (halves * half.polar_moment), 1.0, 1e-6, "polar moment");
                assert!(found.area < PI * size * size);
            }
        }
    }
}

/// Tier: closed forms; an involute sweeps r_b² ξ³/6 about the centre, a whole circle is a disc, and a ring the difference of
/// two.
#[test]
fn a_section_is_known_for_an_involute_and_a_circle() {
    let (base_radius, roll) = (0.03, 0.7);
    let swept = |segments: Vec<Segment>| Outline { segments, teeth: 1, form_roll: 0.0, end_roll: roll }.section();
    let curve = Curve::Involute { base_radius, half_base_angle: 0.1 };
    let found = swept(vec![Segment { part: OutlinePart::Flank, curve, from: 0.0, to: roll }]);
    // Twice, for both halves; with r² = r_b²(1 + ξ²) for the moment.
    let area = base_radius * base_radius * roll.powi(3) / 3.0;
    let moment = 0.5 * base_radius.powi(4) * (roll.powi(3) / 3.0 + roll.powi(5) / 5.0);
    assert_near(found.area / area, 1.0, 1e-13, "area");
    assert_near(found.polar_moment / moment, 1.0, 1e-13, "polar moment");
    let half_circle = Segment::about_centre(OutlinePart::TipLand, 0.02, PI, 0.0);
    let (disc, ring) = (swept(vec![half_circle]), Section::disc(0.02).without(Section::disc(0.015)));
    assert_near(disc.area / Section::disc(0.02).area, 1.0, 1e-14, "disc");
    assert_near(disc.polar_moment, 0.5 * PI * 0.02_f64.powi(4), 1e-21, "disc");
    assert_near(ring.area, PI * (0.02_f64.powi(2) - 0.015_f64.powi(2)), 1e-18, "ring");
}

/// Tier: second method; how fast a point runs along each kind of curve, by differences.
#[test]
fn a_curve_runs_as_fast_as_it_says() {
    for (teeth, shift) in [(12, 0.0), (30, 0.4)] {
        let outline = shaped(&gear(teeth, 3.0, shift), "trochoid").unwrap();
        for Segment { curve, from, to, .. } in &outline.segments {
            let (middle, step) = (0.5 * (from + to), 1e-5 * (to - from).abs());
            let [before, after] = [-step, step].map(|by| curve.point(middle + by));
            let found = libm::hypot(after[0] - before[0], after[1] - before[1]) / (2.0 * step);
            assert_near(curve.local(middle).speed / found, 1.0, 1e-8, curve.name());
        }
    }
}

/// Tier: published; Kohara Gear Industry, Gear Technical Reference, profile shifted spur gears from the centre distance:
/// m 3, z 12 and 24, a 56.4999 gives x1 + x2 0.9600 and, with x 0.6 and 0.36, tip diameters 44.840 and 79.400. And the pair
/// of a sum has that sum.
#[test]
fn profile_shifts_follow_from_a_centre_distance() {
    let angle = 20.0 * DEGREE;
    let sum = profile_shift_sum([12, 24], 3e-3, angle, 56.4999e-3).unwrap();
    assert_near(sum, 0.9600, 5e-5, "x1 + x2");
    let shortening = tip_shortening([12, 24], 3e-3, 0.96, 56.4999e-3);
    for (teeth, shift, printed) in [(12.0, 0.6, 44.840), (24.0, 0.36, 79.400)] {
        assert_near(3.0 * (teeth + 2.0 * (1.0 + shift - shortening)), printed, 5e-4, "d_a");
    }
    for (teeth, shifts) in [([12, 24], [0.6, 0.36]), ([19, 48], [-0.1, 0.3]), ([30, 31], [0.0, 0.0])] {
        let [pinion, gear] = [0, 1].map(|index| specification(teeth[index], 3.0, shifts[index]));
        let distance = GearPair::new(pinion, gear, None).unwrap().centre_distance;
        let found = profile_shift_sum(teeth, 3e-3, angle, distance).unwrap();
        assert_near(found, shifts[0] + shifts[1], 1e-12, "x1 + x2 of a pair");
    }
    for distance in [50.0e-3, f64::NAN, f64::INFINITY] {
        profile_shift_sum([12, 24], 3e-3, angle, distance).unwrap_err();
    }
}
