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
