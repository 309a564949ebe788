//! The pair at work, by brute force: polygons turned through a pitch nowhere overlap, and touch on the path of contact.

use super::outline::shaped;
use super::*;
use crate::gear::geometry::outline::Outline;
use crate::gear::geometry::outline::sample::{Density, Point};
use crate::gear::geometry::validity::{Mating, Validity};

/// Half the angle of the tooth over its radius, read off a polygon of its right half: knows nothing of involutes.
struct Silhouette {
    /// Radius and half angle, by ascending radius from the lowest point of the space.
    rows: Vec<(f64, f64)>,
    teeth: u32,
}

impl Silhouette {
    fn new(outline: &Outline) -> Self {
        let half = outline.half(Density { points: 40_000, chord_error: None });
        let polar = |[x, y]: [f64; 2]| (x.hypot(y), x.atan2(y));
        let rows = half.iter().map(|point| polar(point.local.position)).collect();
        Self { rows, teeth: outline.teeth }
    }

    /// How deep a point at this polar angle from a tooth's centreline lies inside the material, as a length along the
    /// circle; negative outside.
    fn depth(&self, radius: f64, angle: f64) -> f64 {
        let pitch = 2.0 * PI / f64::from(self.teeth);
        let angle = (angle - (angle / pitch).round() * pitch).abs();
        // The lands are parts of circles, of one radius; between them the radius grows with the point.
        let after = self.rows.partition_point(|row| row.0 < radius);
        if after == 0 {
            return f64::INFINITY;
        }
        if after == self.rows.len() {
            return f64::NEG_INFINITY;
        }
        let ((low, wide), (high, narrow)) = (self.rows[after - 1], self.rows[after]);
        let share = if high > low { (radius - low) / (high - low) } else { 0.0 };
        radius * (wide + share * (narrow - wide) - angle)
    }
}

/// Depth and place of the pinion's point that lies deepest in the gear, the gears turned by `turn` out of the middle
/// position, in which a tooth of the pinion points at a space of the gear, and `centre_distance` apart.
fn deepest(pair: &GearPair, points: &[Point], gear: &Silhouette, turn: f64, centre_distance: f64) -> (f64, [f64; 2]) {
    let [z1, z2] = [&pair.pinion, &pair.gear].map(|gear| f64::from(gear.specification.teeth));
    let gear_turn = -turn * z1 / z2;
    let mut deepest = (f64::NEG_INFINITY, [0.0; 2]);
    for neighbour in -2..=2 {
        let (sine, cosine) = (turn + f64::from(neighbour) * 2.0 * PI / z1).sin_cos();
        for point in points {
            let [x, y] = point.local.position;
            let (x, y) = (cosine * x - sine * y, sine * x + cosine * y);
            // Seen from the gear, whose tooth beside the space is half a pitch from the line of centres.
            let radius = x.hypot(centre_distance - y);
            if radius < pair.gear.tip_radius {
                let place = x.atan2(centre_distance - y);
                let depth = gear.depth(radius, place - gear_turn - PI / z2);
                if depth > deepest.0 {
                    deepest = (depth, [x, y]);
                }
            }
        }
    }
    deepest
}

/// Tier: second method (brute force); a full pitch in 40 steps. A micrometre nearer, and they overlap.
#[test]
fn pairs_touch_on_the_path_of_contact_and_nowhere_overlap() {
    for (z1, z2, x1, x2, angle) in
        [(17, 43, 0.3, 0.1, 20.0), (19, 48, 0.0, 0.0, 20.0), (30, 30, 0.5, -0.5, 25.0), (40, 41, 0.0, 0.0, 14.5)]
    {
        let of = |teeth, shift| Specification {
            pressure_angle: angle * DEGREE,
            rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.3, ..Rack::ISO_53_A },
            ..specification(teeth, 3.0, shift)
        };
        let pair = GearPair::new(of(z1, x1), of(z2, x2), None).unwrap();
        let [pinion, gear] = [&pair.pinion, &pair.gear].map(|gear| shaped(gear, "trochoid").unwrap());
        let (points, gear) = (pinion.tooth(Density { points: 4000, chord_error: None }), Silhouette::new(&gear));
        let (a, alpha) = (pair.centre_distance, pair.working_pressure_angle);
        for step in 0..40 {
            let turn = 2.0 * PI / f64::from(z1) * (f64::from(step) / 40.0 - 0.5);
            let what = format!("{z1}/{z2} at step {step}");
            let (depth, [x, y]) = deepest(&pair, &points, &gear, turn, a);
            assert!(depth < 1e-9, "{what}: {} um inside", depth * 1e6);
            // The nearest of points 1.5 µm apart on flanks with radii of curvature of millimetres.
            assert!(depth > -3e-9, "{what}: no contact, {} um away", -depth * 1e6);
            // Both lines of action through the pitch point are possible, since there is no backlash.
            let pitch_point = pair.pinion.base_radius / alpha.cos();
            let off = [1.0, -1.0].map(|side| (side * x * alpha.sin() - (y - pitch_point) * alpha.cos()).abs());
            assert!(off[0].min(off[1]) < 3e-5, "{what}: {off:?} beside the path of contact");
            let (nearer, _) = deepest(&pair, &points, &gear, turn, a - 1e-6);
            assert!(nearer > 2e-7 && nearer < 1e-6, "{what}: {nearer} m inside when 1 um nearer");
        }
    }
}

/// Tier: second method (brute force); the turned polygons of a pair overlap where the closed form has the mate's tip cut
/// into the root, and nowhere else. Along the circumference the overlap is deeper than along the normal.
#[test]
fn polygons_overlap_where_the_mate_s_tip_cuts_into_the_root() {
    for (z1, z2, family, cuts) in [
        (17, 23, "optimised_arc", true),
        (17, 17, "optimised_arc", true),
        (17, 23, "arc", true),
        (30, 38, "arc", false),
        (30, 38, "optimised_arc", false),
        (23, 24, "trochoid", false),
    ] {
        let pair = GearPair::new(specification(z1, 1.0, 0.0), specification(z2, 1.0, 0.0), None).unwrap();
        let [pinion, gear] = [&pair.pinion, &pair.gear].map(|gear| shaped(gear, family).unwrap());
        let points = pinion.tooth(Density { points: 4000, chord_error: None });
        let silhouette = Silhouette::new(&gear);
        let turn = |step: u32| 2.0 * PI / f64::from(z1) * (f64::from(step) / 200.0 - 0.5);
        let depths = (0..200).map(|step| deepest(&pair, &points, &silhouette, turn(step), pair.centre_distance).0);
        let depth = depths.fold(f64::NEG_INFINITY, f64::max);
        // Either tip in the other's root.
        let [one, other] = [(Side::Pinion, &pinion, &gear), (Side::Gear, &gear, &pinion)]
            .map(|(side, own, mate)| Mating::new(&pair, side, own, mate));
        let distance = one.root_distance.min(other.root_distance);
        let what = format!("{z1}/{z2} {family}: {depth:e} for {distance:e}");
        assert!((distance < 0.0) == cuts && (depth > 1e-8) == cuts, "{what}");
        let module = pair.pinion.specification.module;
        assert_eq!([&one, &other].map(|mating| mating.cuts_root(module)).contains(&true), cuts, "{what}");
        assert!(depth >= -0.98 * distance && (!cuts || depth < -2.5 * distance), "{what}");
    }
}

/// Tier: closed form; ISO 21771: a rack with sharp corners undercuts below x = h_aP − z/2 sin²α, which is 0 for 17.0973 teeth.
/// Tips that are not lowered take from the clearance what the centre distance is short of both shifts: −k modules.
#[test]
fn least_shifts_and_missing_clearance_are_those_of_iso_21771() {
    for (z1, x1, z2, x2) in [(17, 0.4, 30, 0.3), (24, 0.0, 36, 0.0), (40, 0.7, 21, -0.1)] {
        let pair = GearPair::new(specification(z1, 3.0, x1), specification(z2, 3.0, x2), None).unwrap();
        let [pinion, gear] = [&pair.pinion, &pair.gear].map(|gear| shaped(gear, "trochoid").unwrap());
        let sharp = Validity::new(&pair.pinion, &pinion).least_shift_sharp;
        assert_near(sharp, 1.0 - f64::from(z1) / 17.097_264, 1e-7, "least shift of a sharp rack");
        let moved = (pair.centre_distance - 1.5e-3 * f64::from(z1 + z2)) / 3e-3;
        for (side, own, mate) in [(Side::Pinion, &pinion, &gear), (Side::Gear, &gear, &pinion)] {
            let missing = Mating::new(&pair, side, own, mate).missing_tip_shortening;
            assert_near(missing, x1 + x2 - moved, 1e-12, "missing tip shortening");
        }
    }
}

/// Tier: closed form; below the mate's tip the flank goes on for √(r_a² − r_b²) − √(r_F² − r_b²) over r_b in roll angle,
/// negative where a space ends above it; a space that is cut down to the root circle has no gap there.
#[test]
fn reserve_and_gap_are_those_of_the_radii() {
    for (teeth, shift) in [([17, 30], [0.4, 0.3]), ([24, 36], [0.0, 0.0]), ([20, 60], [0.0, 0.0])] {
        let [z1, z2] = teeth;
        let pair = GearPair::new(specification(z1, 3.0, shift[0]), specification(z2, 3.0, shift[1]), None).unwrap();
        let outlines = [&pair.pinion, &pair.gear].map(|gear| shaped(gear, "trochoid").unwrap());
        for (side, [own, mate]) in [(Side::Pinion, [0, 1]), (Side::Gear, [1, 0])] {
            let gear = pair.side(side);
            let mating = Mating::new(&pair, side, &outlines[own], &outlines[mate]);
            let alone = Validity::new(gear, &outlines[own]);
            let other = pair.side(side.other());
            // The mate's tip on the line of action: from there to the gear's own foot of the tangent.
            let beyond = (other.tip_radius.powi(2) - other.base_radius.powi(2)).sqrt();
            let active = (pair.tangent_length - beyond) / gear.base_radius;
            let form = (alone.form_radius.powi(2) - gear.base_radius.powi(2)).max(0.0).sqrt() / gear.base_radius;
            assert_near(mating.contact_reserve, active - form, 1e-9, "reserve");
            assert!(!mating.interferes() && Mating { contact_reserve: -1e-9, ..mating }.interferes());
            assert!(!Mating { contact_reserve: -1e-13, ..mating }.interferes(), "rounding");
            // Of the root, rounding is that of the module, 3 mm.
            for (root_distance, cuts) in [(1e-16, false), (-1e-15, false), (-1e-14, true)] {
                assert_eq!(Mating { root_distance, ..mating }.cuts_root(3e-3), cuts, "{root_distance:e}");
            }
            assert_near(alone.root_gap, 0.0, 1e-15, "gap");
        }
    }
}

/// Tier: definition; the gap is that of the outline's lowest point, also where a root's first piece already rises.
#[test]
fn the_gap_is_at_the_lowest_point() {
    let mut open = 0;
    for (teeth, family) in [(17, "arc"), (17, "trochoid"), (30, "arc"), (30, "tangent_arc"), (24, "optimised_arc")] {
        let gear = gear(teeth, 3.0, 0.0);
        let outline = shaped(&gear, family).unwrap();
        let lowest = outline.half(Density { points: 2_000, chord_error: None }).into_iter();
        let lowest =
            lowest.map(|point| point.local.position[0].hypot(point.local.position[1])).fold(f64::MAX, f64::min);
        let gap = Validity::new(&gear, &outline).root_gap;
        assert_near(gap, lowest - gear.root_radius, 1e-12, &format!("{teeth} {family}"));
        open += usize::from(gap > 1e-6);
    }
    assert!(open > 0, "some root stays above the root circle");
}
