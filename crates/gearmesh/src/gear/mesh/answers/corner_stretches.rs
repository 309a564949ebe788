//! Stretches of the mesh cycle in which sharp corners of tips are in contact.
//!
//! Must not know: how pressures are found.

use super::curve::Point;
use super::pressure::pressed;
use crate::gear::mesh::equilibrium::load_case::LoadCase;

/// Of the distance of two positions, until the end of a stretch is found: to a millionth.
const HALVINGS: usize = 20;

/// Where sharp corners are in contact.
#[derive(Clone, Debug, PartialEq)]
pub struct CornerStretches {
    /// Stretches of the cycle \[m\], ascending.
    pub stretches: Vec<[f64; 2]>,
    /// The largest share of the load.
    pub share: f64,
}

/// Where along a curve whose pressures were found sharp corners are in contact; none where they nowhere are.
#[must_use]
pub(in crate::gear::mesh) fn corner_stretches(case: &LoadCase, points: &[Point]) -> Option<CornerStretches> {
    let share = |point: &Point| point.pressed.map_or(0.0, |pressed| pressed.corner_share);
    let mut found = CornerStretches { stretches: Vec::new(), share: 0.0 };
    for (index, point) in points.iter().enumerate() {
        let before = index.checked_sub(1).map(|before| &points[before]);
        let (was, is) = (before.is_some_and(|before| share(before) > 0.0), share(point) > 0.0);
        if was != is {
            let (end, at_end) = match before {
                Some(before) if before.pairs == point.pairs => end_of_corner(case, before, point),
                Some(before) if was => (before.cycle_position, 0.0),
                _ => (point.cycle_position, 0.0),
            };
            found.share = found.share.max(at_end);
            match found.stretches.last_mut() {
                Some(last) if was => last[1] = end,
                _ => found.stretches.push([end; 2]),
            }
        }
        if let Some(last) = found.stretches.last_mut().filter(|_| is) {
            last[1] = point.cycle_position;
        }
        found.share = found.share.max(share(point));
    }
    (found.share > 0.0).then_some(found)
}

/// Between two points of which one has a corner in contact: the last place that has, and the share of the load there.
fn end_of_corner(case: &LoadCase, one: &Point, other: &Point) -> (f64, f64) {
    let pairs = one.pairs;
    let share = |position: f64| pressed(case, position, pairs, &case.state(position, pairs)).corner_share;
    let has = one.pressed.is_some_and(|pressed| pressed.corner_share > 0.0);
    let [mut inside, mut outside] = if has { [one, other] } else { [other, one] }.map(|point| point.cycle_position);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (inside + outside);
        if share(middle) > 0.0 { inside = middle } else { outside = middle }
    }
    (inside, share(inside))
}
