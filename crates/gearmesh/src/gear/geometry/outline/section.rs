//! The section of a gear: its area, and its second moment about the axis, from which mass and moment of inertia follow.
//!
//! By Green's theorem along the exact curves of the profile: A = ½ ∮ (x dy − y dx), I_p = ¼ ∮ r² (x dy − y dx). The radial
//! lines that bound half a tooth add nothing to either. Must not know: what a gear is made of.

use std::f64::consts::PI;

use super::Outline;
use super::curve::Local;
use crate::numeric::quadrature::GaussLegendre;

/// Nodes on each curve: all are analytic, so that these leave nothing but roundings.
const NODES: usize = 24;

/// A plane section, whole round.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// A \[m²\].
    pub area: f64,
    /// I_p \[m⁴\]: ∫ r² dA about the gear's axis.
    pub polar_moment: f64,
}

impl Section {
    /// What a circle about the axis encloses.
    #[must_use]
    pub fn disc(radius: f64) -> Self {
        let square = radius * radius;
        Self { area: PI * square, polar_moment: 0.5 * PI * square * square }
    }

    /// What is left when the other is cut out of it.
    #[must_use]
    pub fn without(self, other: Self) -> Self {
        Self { area: self.area - other.area, polar_moment: self.polar_moment - other.polar_moment }
    }
}

impl Outline {
    /// What the profile encloses, down to the axis.
    #[must_use]
    pub fn section(&self) -> Section {
        let rule = GaussLegendre::new(NODES);
        let mut half = Section { area: 0.0, polar_moment: 0.0 };
        for segment in &self.segments {
            let [low, high] = [segment.from.min(segment.to), segment.from.max(segment.to)];
            let [area, polar_moment] = rule.integrate(low, high, |parameter| {
                let Local { position: [x, y], tangent, speed, .. } = segment.local(parameter);
                let turned = speed * (x * tangent[1] - y * tangent[0]);
                [0.5 * turned, 0.25 * (x * x + y * y) * turned]
            });
            half = Section { area: half.area + area, polar_moment: half.polar_moment + polar_moment };
        }
        let halves = 2.0 * f64::from(self.teeth);
        Section { area: halves * half.area, polar_moment: halves * half.polar_moment }
    }
}
