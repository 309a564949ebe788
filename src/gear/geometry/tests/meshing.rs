//! The pair at work, by brute force: polygons turned through a pitch nowhere overlap, and touch on the path of contact.

use super::outline::outlined;
use super::*;
use crate::gear::geometry::outline::sample::{Density, Point};

/// Half the angle of the tooth over its radius, read off a polygon of its right half: knows nothing of involutes.
struct Silhouette {
    /// Radius and half angle, by ascending radius from the lowest point of the space.
    rows: Vec<(f64, f64)>,
    teeth: u32,
}

impl Silhouette {
    fn new(gear: &Gear) -> Self {
        let outline = outlined(gear, "trochoid", ("rack_tip", "given")).unwrap();
        let half = outline.half(Density { points: 40_000, chord_error: None });
        let polar = |[x, y]: [f64; 2]| (x.hypot(y), x.atan2(y));
        let rows = half.iter().map(|point| polar(point.local.position)).collect();
        Self { rows, teeth: gear.specification.teeth }
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
fn deepest(pair: &Pair, points: &[Point], gear: &Silhouette, turn: f64, centre_distance: f64) -> (f64, [f64; 2]) {
    let [z1, z2] = [&pair.pinion, &pair.gear].map(|gear| f64::from(gear.specification.teeth));
    let gear_turn = -turn * z1 / z2;
    let mut deepest = (f64::NEG_INFINITY, [0.0; 2]);
    for neighbour in -2..=2 {
        let (sine, cosine) = (turn + f64::from(neighbour) * 2.0 * PI / z1).sin_cos();
        for point in points {
            let [x, y] = point.local.position;
            let (x, y) = (cosine * x - sine * y, sine * x + cosine * y);
            // Seen from the gear, whose tooth beside the space is half a pitch from the line of centres.
            let (radius, place) = (x.hypot(centre_distance - y), x.atan2(centre_distance - y));
            if radius < pair.gear.tip_radius {
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
            rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.3 },
            ..specification(teeth, 3.0, shift)
        };
        let pair = Pair::new(of(z1, x1), of(z2, x2), None).unwrap();
        let outline = outlined(&pair.pinion, "trochoid", ("rack_tip", "given")).unwrap();
        let (points, gear) = (outline.tooth(Density { points: 4000, chord_error: None }), Silhouette::new(&pair.gear));
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
