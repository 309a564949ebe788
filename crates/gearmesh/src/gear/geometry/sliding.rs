//! How the flanks of a pair slide on each other, and what play they have.
//!
//! At path position s the flanks have radii of curvature s and L − s, and the sliding speed is proportional to the distance from
//! the pitch point C. Lengths in m. Source: ISO 21771-1:2024, clauses on sliding conditions and backlash. Must not know: load.

use super::error::{GeometryError, Millimetres, Problem};
use super::{Gear, GearPair, Side};

/// The play between the flanks that do not drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Backlash {
    /// j_wt: along the working pitch circles.
    pub circumferential: f64,
    /// j_bn: normal to the flanks.
    pub normal: f64,
    /// j_r: by how much the centre distance is larger than without backlash, by the tangent at the working angle.
    pub radial: f64,
}

impl GearPair {
    /// r_w: radius of a gear's working pitch circle.
    #[must_use]
    pub fn working_radius(&self, side: Side) -> f64 {
        self.side(side).base_radius / libm::cos(self.working_pressure_angle)
    }

    /// ζ: specific sliding of a gear's flank at a path position, 1 − v_mate/v_own by the speeds of the contact along the flanks;
    /// −∞ where its own stands still, at its tangent point.
    #[must_use]
    pub fn specific_sliding(&self, side: Side, s: f64) -> f64 {
        let (own, mate) = (self.side(side), self.side(side.other()));
        let rolling = |of: Side| match of {
            Side::Pinion => s,
            Side::Gear => self.tangent_length - s,
        };
        let ratio = f64::from(own.specification.teeth) / f64::from(mate.specification.teeth);
        1.0 - ratio * rolling(side.other()) / rolling(side)
    }

    /// K_g: sliding speed over the speed of the working pitch circles at a path position, positive beyond the pitch point.
    #[must_use]
    pub fn sliding_factor(&self, s: f64) -> f64 {
        let turning: f64 = [Side::Pinion, Side::Gear].map(|side| 1.0 / self.working_radius(side)).iter().sum();
        (s - self.zone_points().c) * turning
    }

    /// H_V of the geometry alone, with half of the load on each of two pairs: π(u + 1)/(z1 u)·(1 − ε_α + ε1² + ε2²) with the
    /// contact ratios ε1 and ε2 of the pinion's and the gear's addendum; none where the pitch point is not in single contact, for
    /// which the formula is. Sources: Ohlendorf, Verlustleistung und Erwärmung von Stirnrädern, dissertation, TU München 1958;
    /// ISO/TR 14179-2:2001.
    #[must_use]
    pub fn tooth_loss_factor(&self) -> Option<f64> {
        let points = self.zone_points();
        if !(points.b <= points.c && points.c <= points.d) {
            return None;
        }
        let [first, second] = [points.e - points.c, points.c - points.a].map(|length| length / self.base_pitch);
        let [pinion, gear] = [&self.pinion, &self.gear].map(|gear| f64::from(gear.specification.teeth));
        let shares = 1.0 - (first + second) + first * first + second * second;
        Some(std::f64::consts::PI * (1.0 / pinion + 1.0 / gear) * shares)
    }

    /// j at the thicknesses that the teeth have.
    #[must_use]
    pub fn backlash(&self) -> Backlash {
        Backlash::at([&self.pinion, &self.gear], self.working_pressure_angle)
    }
}

impl Backlash {
    /// That of two gears on a centre distance; below 0 where their teeth do not fit into each other.
    ///
    /// # Errors
    /// When their base circles overlap.
    pub fn of(gears: [&Gear; 2], centre_distance: f64) -> Result<Self, GeometryError> {
        let base_sum = gears[0].base_radius + gears[1].base_radius;
        if centre_distance.is_nan() || centre_distance <= base_sum {
            let [found, minimum] = [centre_distance, base_sum].map(Millimetres);
            return Err(Problem::CentreDistance { found, minimum }.into());
        }
        let tangent_length = ((centre_distance - base_sum) * (centre_distance + base_sum)).sqrt();
        Ok(Self::at(gears, libm::atan2(tangent_length, base_sum)))
    }

    fn at(gears: [&Gear; 2], working_pressure_angle: f64) -> Self {
        let (sine, cosine) = libm::sincos(working_pressure_angle);
        let [pinion, gear] = gears.map(|gear| {
            let radius = gear.base_radius / cosine;
            // The difference to half a pitch, so that no backlash comes out as none.
            radius * (0.5 * std::f64::consts::PI / f64::from(gear.specification.teeth) - gear.half_angle(radius))
        });
        let circumferential = 2.0 * (pinion + gear);
        Self { circumferential, normal: circumferential * cosine, radial: 0.5 * circumferential * cosine / sine }
    }
}

#[cfg(test)]
mod tests;
