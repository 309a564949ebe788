//! Where two segments of an outline meet: how far apart they are, and by how much the direction turns.
//!
//! Must not know: what makes a junction good.

use std::f64::consts::PI;

use super::Outline;
use super::curve::Local;

/// A place where a segment ends and the next begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Junction {
    /// Which segments meet here.
    pub place: Place,
    /// Where the segment before it ends.
    pub before: Local,
    /// Where the segment after it starts.
    pub after: Local,
}

/// Which junction of the right half of a tooth it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// In the middle of the space.
    Space,
    /// Between this segment and the next.
    Behind(usize),
    /// On the tooth's centreline.
    Centreline,
}

impl Junction {
    /// \[m\].
    #[must_use]
    pub fn position_jump(&self) -> f64 {
        let ([a, b], [c, d]) = (self.before.position, self.after.position);
        libm::hypot(c - a, d - b)
    }

    /// By how much the direction turns to the left, −π to π \[rad\].
    #[must_use]
    pub fn tangent_jump(&self) -> f64 {
        let ([a, b], [c, d]) = (self.before.tangent, self.after.tangent);
        libm::atan2(a * d - b * c, a * c + b * d)
    }

    /// Whether the segments meet, within `length` \[m\], and continue in the same direction, within `angle` \[rad\].
    #[must_use]
    pub fn is_smooth(&self, length: f64, angle: f64) -> bool {
        self.position_jump() <= length && self.tangent_jump().abs() <= angle
    }
}

/// The mirror image in the line through the gear's centre at an angle from the y axis, run through the other way.
fn mirrored(local: Local, angle: f64) -> Local {
    let (sine, cosine) = libm::sincos(2.0 * angle);
    let image = |[x, y]: [f64; 2]| [-cosine * x + sine * y, sine * x + cosine * y];
    Local { position: image(local.position), tangent: image(local.tangent).map(|part| -part), ..local }
}

impl Outline {
    /// Every junction of the right half of a tooth, from the middle of the space to the centreline.
    #[must_use]
    pub fn junctions(&self) -> Vec<Junction> {
        let mut junctions = Vec::new();
        let (Some(first), Some(last)) = (self.segments.first(), self.segments.last()) else { return junctions };
        let start = first.local(first.from);
        junctions.push(Junction {
            place: Place::Space,
            before: mirrored(start, PI / f64::from(self.teeth)),
            after: start,
        });
        for (index, pair) in self.segments.windows(2).enumerate() {
            let (before, after) = (pair[0].local(pair[0].to), pair[1].local(pair[1].from));
            junctions.push(Junction { place: Place::Behind(index), before, after });
        }
        let end = last.local(last.to);
        junctions.push(Junction { place: Place::Centreline, before: end, after: mirrored(end, 0.0) });
        junctions
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tier: closed form; 3, 4 and 5, and a quarter turn to the left.
    #[test]
    fn a_gap_and_a_corner_are_seen() {
        let local = |position, tangent| Local { position, tangent, curvature: 0.0, speed: 1.0 };
        let before = local([1e-3, 2e-3], [1.0, 0.0]);
        let junction = |after| Junction { place: Place::Centreline, before, after };
        let apart = junction(local([4e-3, 6e-3], [1.0, 0.0]));
        assert!((apart.position_jump() - 5e-3).abs() < 1e-18 && apart.tangent_jump().abs() < 1e-18);
        assert!(apart.is_smooth(5.1e-3, 0.0) && !apart.is_smooth(4.9e-3, 1.0));
        let corner = junction(local([1e-3, 2e-3], [0.0, 1.0]));
        assert!(corner.position_jump() < 1e-18 && (corner.tangent_jump() - 0.5 * PI).abs() < 1e-15);
        assert!(corner.is_smooth(0.0, 1.6) && !corner.is_smooth(1.0, 1.5));
    }
}
