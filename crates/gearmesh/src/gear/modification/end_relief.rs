//! End relief C_βI, C_βII: material taken off towards one or both ends of the face (ISO 21771-1).
//!
//! End I is at z = −b/2, end II at z = +b/2. Must not know: compliance, load.

use std::sync::Arc;

use super::curve::{Curve, Growth};
use super::{MOST_AMOUNT, Modification, Specified};
use crate::gear::geometry::error::shown::decimals;
use crate::gear::geometry::{GearPair, Side};
use declare::error::Diagnostic;
use declare::units::LENGTH;
use declare::{Declared, Words};

/// Which end of the face is relieved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Words)]
pub enum FaceEnd {
    /// the end at z = −b/2
    #[declared(name = "I")]
    First,
    /// the end at z = +b/2
    #[declared(name = "II")]
    Second,
    /// both, alike
    #[default]
    Both,
}

/// C_βI, C_βII: relief that grows from a start on the face to one or both of its ends.
#[derive(Clone, Copy, Debug, PartialEq, Declared)]
#[declared(name = "end_relief")]
pub struct EndRelief {
    /// C_βI, C_βII: depth at the end of the gear's own face.
    #[declared(dimension = LENGTH, minimum = 0.0, maximum = MOST_AMOUNT, range, example = "5 um")]
    pub amount: f64,
    /// L_CβI, L_CβII: how far from the end of the face the relief starts; at most the face width for one end, half of it
    /// for both; a relief of no length removes nothing.
    #[declared(dimension = LENGTH, minimum = 0.0, maximum = 10.0, range, example = "2 mm")]
    pub length: f64,
    /// Which end of the face is relieved; two of them with different values are two entries.
    #[declared(default = "both")]
    pub end: FaceEnd,
    /// How the depth grows from the start to the end of the face.
    #[declared(flatten)]
    pub curve: Curve,
}

impl Specified for EndRelief {
    fn on(&self, pair: &GearPair, side: Side) -> Result<Arc<dyn Modification>, Diagnostic> {
        let face_width = pair.side(side).specification.face_width;
        let longest = if self.end == FaceEnd::Both { 0.5 * face_width } else { face_width };
        if self.length > longest {
            let (given, longest) = (self.length * 1e3, longest * 1e3);
            let digits = decimals(given, longest);
            let message = format!(
                "the end relief is {given:.digits$} mm long; the face leaves room for 0 to {longest:.digits$} mm"
            );
            return Err(Diagnostic::new(message).of(Self::NAMES.length));
        }
        let start = 0.5 * face_width - self.length;
        let (first, second) = (self.end != FaceEnd::Second, self.end != FaceEnd::First);
        let breaks = [first.then_some(-start), second.then_some(start)].into_iter().flatten().collect();
        let (amount, length) = (self.amount, self.length);
        Ok(Arc::new(Ramps { amount, length, start, first, second, breaks, growth: self.curve.growth() }))
    }
}

/// The same on a gear.
#[derive(Debug)]
struct Ramps {
    amount: f64,
    length: f64,
    /// Distance from the middle of the face at which the relief starts; negative when it crosses the middle.
    start: f64,
    first: bool,
    second: bool,
    breaks: Vec<f64>,
    growth: Growth,
}

impl Ramps {
    /// −1 or 1 where z lies in a relief towards end I or II, 0 elsewhere.
    fn direction(&self, z: f64) -> f64 {
        if self.second && z > self.start {
            1.0
        } else if self.first && -z > self.start {
            -1.0
        } else {
            0.0
        }
    }
}

impl Modification for Ramps {
    fn lead(&self, z: f64) -> f64 {
        let distance = self.direction(z) * z - self.start;
        if self.direction(z) == 0.0 || self.length == 0.0 {
            0.0
        } else {
            self.amount * self.growth.value(distance / self.length)
        }
    }

    fn lead_quadratic(&self, z: f64) -> Option<[f64; 3]> {
        let direction = self.direction(z);
        if direction == 0.0 || self.length == 0.0 {
            return Some([0.0; 3]);
        }
        let Growth::Quadratic { linear } = self.growth else { return None };
        // amount · (a t + (1 − a) t²) with t = (±z − start)/length.
        let (start, scale) = (self.start / self.length, direction / self.length);
        let bend = 1.0 - linear;
        let coefficients =
            [start * (bend * start - linear), scale * (linear - 2.0 * bend * start), scale * scale * bend];
        Some(coefficients.map(|coefficient| self.amount * coefficient))
    }

    fn lead_breaks(&self) -> &[f64] {
        &self.breaks
    }

    fn varies_along_face(&self) -> bool {
        self.amount != 0.0 && self.length != 0.0
    }

    fn lead_is_even(&self) -> bool {
        self.first == self.second || !self.varies_along_face()
    }

    fn resolved(&self) -> Vec<(&'static str, f64)> {
        vec![("amount", self.amount), ("length", self.length)]
    }
}
