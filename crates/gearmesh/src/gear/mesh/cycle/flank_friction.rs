//! Friction of the flanks of one pair: speeds, levers and the force, from a law, at a path position under a load.
//!
//! At path position s the contact moves along the flanks of pinion and gear at ω1 s and ω2 (L − s), and friction has the
//! levers s and L − s about the centres; at a corner of a tip those of the point that touches. Must not know: any single
//! law, equilibrium.

use super::mesh::Mesh;
use crate::gear::contact::flattening::combined_radius;
use crate::gear::friction::{Law, Rolling};
use crate::gear::geometry::Side;
use crate::numeric::complementarity::{MOST_SPRINGS, PerSpring};

/// Under what flanks rub.
#[derive(Clone, Copy, Debug)]
pub struct Friction<'a> {
    /// The coefficient of friction.
    pub law: &'a dyn Law,
    /// ω1: at which the pinion turns \[rad/s\], above 0.
    pub speed: f64,
}

/// A pair that rubs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FlankFriction {
    /// F: normal force \[N\].
    pub load: f64,
    /// What its contact is like, under the mean load per width.
    pub rolling: Rolling,
    /// μ; 0 without load, and of a local law where nothing slides.
    pub coefficient: f64,
    /// Of friction about the centres of pinion and gear \[m\].
    pub levers: [f64; 2],
}

impl FlankFriction {
    /// μ F \[N\].
    #[must_use]
    pub fn force(&self) -> f64 {
        self.coefficient * self.load
    }

    /// μ F v_g \[W\].
    #[must_use]
    pub fn power(&self) -> f64 {
        self.force() * self.rolling.sliding().abs()
    }

    /// Moments of normal force and friction about the centres \[N m\], as pinion and gear need and give them.
    #[must_use]
    pub fn moments(&self, base_radii: [f64; 2]) -> [f64; 2] {
        let sliding = self.rolling.sliding();
        let direction = if sliding > 0.0 {
            1.0
        } else if sliding < 0.0 {
            -1.0
        } else {
            0.0
        };
        [0, 1].map(|gear| self.load * (base_radii[gear] + direction * self.coefficient * self.levers[gear]))
    }
}

/// A law of friction under the force of a load case.
#[derive(Clone, Copy, Debug)]
pub(in crate::gear::mesh) struct FrictionUnderForce<'a> {
    pub(in crate::gear::mesh) friction: Friction<'a>,
    /// The coefficient of a law that is the same all along the path.
    pub(in crate::gear::mesh) mean: Option<f64>,
    cycle: &'a Mesh,
    /// F over the face width \[N/m\].
    line_load: f64,
}

impl<'a> FrictionUnderForce<'a> {
    /// Under the force F \[N\].
    pub(in crate::gear::mesh) fn new(cycle: &'a Mesh, friction: Friction<'a>, force: f64) -> Self {
        let mut found = Self { friction, mean: None, cycle, line_load: force / cycle.face_width };
        found.mean = friction.law.is_mean().then(|| friction.law.coefficient(&found.at_pitch_point()));
        found
    }

    /// The contact at the pitch point under the whole load.
    pub(in crate::gear::mesh) fn at_pitch_point(&self) -> Rolling {
        self.cycle.rolling(self.cycle.pair.zone_points().c, self.line_load, self.friction.speed).0
    }

    fn rubbing_of(&self, s: f64, load: f64) -> FlankFriction {
        let (rolling, levers) = self.cycle.rolling(s, load / self.cycle.face_width, self.friction.speed);
        let rubs = load > 0.0 && rolling.radius > 0.0;
        let coefficient = match self.mean {
            Some(mean) if rubs => mean,
            None if rubs && rolling.sliding() != 0.0 => self.friction.law.coefficient(&rolling),
            _ => 0.0,
        };
        FlankFriction { load, rolling, coefficient, levers }
    }

    /// Friction at a position under the loads of its springs \[N\].
    pub(in crate::gear::mesh) fn rubbing(
        &self,
        position: f64,
        pairs: usize,
        loads: &PerSpring,
    ) -> [FlankFriction; MOST_SPRINGS] {
        let mut found = [FlankFriction::default(); MOST_SPRINGS];
        for (spring, rubbing) in found.iter_mut().enumerate().take(self.cycle.springs(pairs)) {
            *rubbing = self.rubbing_of(self.cycle.path_position(position, spring), loads[spring]);
        }
        found
    }
}

impl Mesh {
    /// Levers of friction about the centres of pinion and gear \[m\]: s and L − s, and those of the point at the corner of a tip,
    /// along the normal of the other flank.
    pub(in crate::gear::mesh) fn friction_levers(&self, s: f64) -> [f64; 2] {
        let (radii, turned) = (self.radii(s), self.inclinations(s));
        let base_radii = self.base_radii();
        [0, 1].map(|gear| {
            if turned[gear] == 0.0 {
                return radii[gear];
            }
            let (sine, cosine) = libm::sincos(turned[gear]);
            radii[gear] * cosine + base_radii[gear] * sine
        })
    }

    /// r_b1 and r_b2 \[m\].
    pub(in crate::gear::mesh) fn base_radii(&self) -> [f64; 2] {
        [Side::Pinion, Side::Gear].map(|side| self.pair.side(side).base_radius)
    }

    /// Where in the cycle a pair passes the pitch point; none where that is not on the path of contact.
    pub(in crate::gear::mesh) fn pitch_point_position(&self) -> Option<f64> {
        let points = self.pair.zone_points();
        (points.c > points.a && points.c < points.e).then(|| (points.c - points.a).rem_euclid(self.period()))
    }

    fn rolling(&self, s: f64, line_load: f64, speed: f64) -> (Rolling, [f64; 2]) {
        let (levers, base_radii) = (self.friction_levers(s), self.base_radii());
        let radius = combined_radius(self.touching(s).0);
        let speeds = [levers[0] * speed, levers[1] * (speed * base_radii[0] / base_radii[1])];
        let pressure = if radius > 0.0 { self.bodies.pressure(radius, line_load) } else { 0.0 };
        (Rolling { line_load, pressure, radius, speeds }, levers)
    }
}
