//! How far two involutes stand apart off the line of action.
//!
//! At the path position s unmodified flanks touch at one point of the line of action. Any other flank point of one gear
//! stands clear of the other gear's flank by a separation that grows with the square of its distance. It decides where
//! relieved flanks touch, and when a tip corner touches before A or after E. The flank point is placed where its gear
//! carries it. The involute through it has the rotation coordinate r_b(θ − atan u + u), u = √(ρ²/r_b² − 1), with θ and ρ
//! its polar coordinates about the other gear's centre. The separation is that coordinate less s: the turn of the other
//! flank along the base circle, which is the normal distance. Lengths in m. Source: the involute's property that its
//! normals touch the base circle (ISO 21771-1:2024, section 5); no iteration. Must not know: modification, load.
//!
//! First order: forces act along the line of action with the base radii as arms wherever the flanks touch. At a corner the
//! true arm of the point's gear is r_b(1 − dS/de), with e the distance before A or after E.

use crate::gear::geometry::{GearPair, Side};

/// One gear's flank points before the other gear's flank. Positions count from the flank's own tangent point, so that
/// they are its radii of curvature on the line of action; for points of the gear they are path positions s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facing {
    /// r_b of the gear that the points belong to.
    point_radius: f64,
    /// r_b of the gear whose flank they meet.
    flank_radius: f64,
    tangent_length: f64,
    /// Where the point is the end of its flank.
    pub start: f64,
    /// Where the other flank ends.
    pub end: f64,
    /// Radius of the arc that follows the end of the point's flank; 0 at a corner.
    pub round: f64,
}

/// A flank point and the place of the other flank that is nearest to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// S \[m\].
    pub separation: f64,
    /// dS/de along the points of the flank.
    pub slope: f64,
    /// d²S/de² \[1/m\].
    pub bend: f64,
    /// f: radius of curvature of the other flank at the place, its roll angle over its base radius \[m\].
    pub curvature: f64,
    /// df/de.
    pub rate: f64,
    /// d²f/de² \[1/m\].
    pub rate_slope: f64,
}

impl Facing {
    /// Points of `side` before the flank of the other gear.
    #[must_use]
    pub fn new(pair: &GearPair, side: Side) -> Self {
        let (pinion, gear) = (pair.pinion.base_radius, pair.gear.base_radius);
        let tangent_length = pair.tangent_length;
        let [start, end] = pair.flank_ends();
        let round = pair.side(side).flank_end.radius;
        match side {
            Side::Gear => Self { point_radius: gear, flank_radius: pinion, tangent_length, start, end, round },
            Side::Pinion => Self {
                point_radius: pinion,
                flank_radius: gear,
                tangent_length,
                start: tangent_length - end,
                end: tangent_length - start,
                round,
            },
        }
    }

    /// A path position as one of these positions, and back; `side` as in [`Facing::new`].
    #[must_use]
    pub fn turned(&self, side: Side, position: f64) -> f64 {
        if side == Side::Gear { position } else { self.tangent_length - position }
    }

    /// The roll angle of the point whose own position is `position`.
    #[must_use]
    pub fn point_roll(&self, position: f64) -> f64 {
        (self.tangent_length - position) / self.point_radius
    }

    /// The own position of the point with this roll angle.
    #[must_use]
    pub fn point_position(&self, roll: f64) -> f64 {
        self.tangent_length - roll * self.point_radius
    }

    /// By how much the roll angles of points and of the flank grow with the position.
    #[must_use]
    pub fn roll_rates(&self) -> [f64; 2] {
        [-1.0 / self.point_radius, 1.0 / self.flank_radius]
    }

    /// The radius of curvature of the flank at this roll angle.
    #[must_use]
    pub fn flank_position(&self, roll: f64) -> f64 {
        roll * self.flank_radius
    }

    /// The roll angle of the flank where its radius of curvature is `curvature`.
    #[must_use]
    pub fn flank_roll(&self, curvature: f64) -> f64 {
        curvature / self.flank_radius
    }

    /// How far before its own position the point is that lies `along` its flank from the nominal one, towards its root \[m\];
    /// none beyond its base circle.
    #[must_use]
    pub fn before(&self, nominal: f64, along: f64) -> Option<f64> {
        let roll = self.point_roll(nominal);
        let square = roll * roll - 2.0 * along / self.point_radius;
        // Half the difference of the squares is the length of an involute over its base radius.
        (square >= 0.0 && roll >= 0.0).then(|| 2.0 * along / (roll + square.sqrt()))
    }

    /// The point whose own position is `point`, `before` ≥ 0 before it comes there: relative to e²/2ρ exact to 1e-13,
    /// however small `before` is.
    #[must_use]
    pub fn touch(&self, point: f64, before: f64) -> Touch {
        let Self { point_radius, flank_radius, tangent_length, .. } = *self;
        // Line of action along x from the flank's tangent point; the flank's centre is r_b below, the point's above.
        let per_point = 1.0 / point_radius;
        let roll = (tangent_length - point) * per_point;
        let angle = -before * per_point;
        let (sine, lift, lag) = sine_lift_and_defect(angle);
        let cosine = 1.0 - lift;
        // Of second order: how far the point is from the nominal contact along the line of action.
        let along = point_radius * (roll * lift - lag);
        let (x, y) = (point - before + along, point_radius * (lift - roll * sine));
        let beyond = y * (y + 2.0 * flank_radius);
        let curvature = (x * x + beyond).max(0.0).sqrt();
        let excess = if x > 0.0 { beyond / (curvature + x) } else { curvature - x };
        let per_flank = 1.0 / flank_radius;
        let flank_roll = curvature * per_flank;
        // The turn of the tangent to the base circle through the point, against the line of action.
        let (up, across) = (-(excess + flank_roll * y), y + flank_radius + x * flank_roll);
        let per_length = per_flank / (1.0 + flank_roll * flank_roll);
        let (sine_turn, cosine_turn) = (up * per_length, across * per_length);
        let bulge = x * sine_turn * sine_turn / (1.0 + cosine_turn);
        let sine_sum = sine * cosine_turn + cosine * sine_turn;
        let cosine_sum = cosine * cosine_turn - sine * sine_turn;
        // A flank that is met at its base circle has no curvature there; then the rates are only very large.
        let per_curved = 1.0 / curvature.max(1e-12 * flank_radius);
        let over = roll * cosine_sum * per_curved;
        let rate = roll * ((y + flank_radius) * cosine - x * sine) * per_curved;
        let (forward, sideways) = ((sine + roll * cosine) * per_point, (roll * sine - cosine) * per_point);
        let turned = x * forward + (y + flank_radius) * sideways;
        Touch {
            separation: along + flank_radius * arc_excess(sine_turn, cosine_turn) - bulge - y * sine_turn,
            slope: -roll * sine_sum,
            bend: sine_sum * per_point + roll * cosine_sum * (per_point + over),
            curvature,
            rate,
            rate_slope: (roll * roll - rate * rate + turned) * per_curved,
        }
    }

    /// The nominal point of contact.
    #[must_use]
    pub fn on_line(&self, nominal: f64) -> Touch {
        let roll = self.point_roll(nominal);
        let curvature = nominal.max(1e-12 * self.flank_radius);
        let over = roll / curvature;
        let rate = over * self.flank_radius;
        let turned = (nominal * roll - self.flank_radius) / self.point_radius;
        Touch {
            separation: 0.0,
            slope: 0.0,
            bend: roll * (1.0 / self.point_radius + over),
            curvature: nominal,
            rate,
            rate_slope: (roll * roll - rate * rate + turned) / curvature,
        }
    }

    /// d³S/de³ at the nominal point of contact \[1/m²\].
    #[must_use]
    pub fn bend_slope(&self, nominal: f64) -> f64 {
        let over = self.point_roll(nominal) / nominal.max(1e-12 * self.flank_radius);
        let turn = 1.0 / self.point_radius;
        -2.0 * turn * turn - over * (3.0 * turn + over * over * self.flank_radius)
    }

    /// The end of the flank, `before` ≥ 0 before its own position.
    #[must_use]
    pub fn flank_end(&self, before: f64) -> Touch {
        self.touch(self.start, before)
    }

    /// What comes nearest when the flank ends `before` ≥ 0 before its own position, before A or after E: its corner, or the
    /// arc that follows. The centre of an arc faces the other flank's parallel at the distance of the radius, an involute
    /// of the same base circle.
    #[must_use]
    pub fn tip(&self, before: f64) -> Touch {
        self.turned_tip(before, 0.0)
    }

    /// The same where the flank ends in another direction, so that the arc's own position is by `shift` farther inside.
    #[must_use]
    pub fn turned_tip(&self, before: f64, shift: f64) -> Touch {
        let centre = self.touch(self.start + self.round + shift, before + shift);
        Touch { curvature: centre.curvature - self.round, ..centre }
    }

    /// By how much the other flank's normal there is turned from that of the end of the own flank, towards its root \[rad\].
    #[must_use]
    pub fn inclination(&self, before: f64) -> f64 {
        let sine = self.tip(before).slope / self.point_roll(self.start + self.round);
        libm::asin(sine.clamp(-1.0, 1.0))
    }

    /// How far before its own position the tip can meet the other flank, which ends at its own tip; at most `maximum`.
    #[must_use]
    pub fn reach(&self, maximum: f64) -> f64 {
        let room = |before: f64| self.end - self.tip(before).curvature;
        if room(maximum) >= 0.0 {
            return maximum;
        }
        crate::numeric::crossing::bracketed(0.0, maximum, room).unwrap_or(0.0)
    }
}

/// Angles up to which the series below are good to rounding; flanks touch within it.
const SMALL: f64 = 0.1;

/// Squares of angles up to which three terms after the first are.
const TINY: f64 = 1e-4;

/// sin t, 1 − cos t and t − sin t.
#[inline]
fn sine_lift_and_defect(angle: f64) -> (f64, f64, f64) {
    let lag = defect(angle);
    if angle.abs() > SMALL {
        let half = libm::sin(0.5 * angle);
        return (libm::sin(angle), 2.0 * half * half, lag);
    }
    let q = angle * angle;
    let lift = 0.5 * q * nested(q, [-1.0 / 12.0, -1.0 / 30.0, -1.0 / 56.0, -1.0 / 90.0, -1.0 / 132.0]);
    (angle - lag, lift, lag)
}

/// t − sin t.
#[inline]
fn defect(angle: f64) -> f64 {
    if angle.abs() > 0.5 {
        return angle - libm::sin(angle);
    }
    let q = angle * angle;
    let ratios = [-1.0 / 20.0, -1.0 / 42.0, -1.0 / 72.0, -1.0 / 110.0, -1.0 / 156.0, -1.0 / 210.0];
    (1.0 / 6.0) * angle * q * nested(q, ratios)
}

/// The same of the angle with this sine and cosine.
#[inline]
fn arc_excess(sine: f64, cosine: f64) -> f64 {
    if sine.abs() > SMALL || cosine < 0.0 {
        return defect(libm::atan2(sine, cosine));
    }
    // Of the arc sine.
    let q = sine * sine;
    let ratios = [9.0 / 20.0, 25.0 / 42.0, 49.0 / 72.0, 81.0 / 110.0, 121.0 / 156.0, 169.0 / 210.0, 225.0 / 272.0];
    (1.0 / 6.0) * sine * q * nested(q, ratios)
}

/// A power series in q as the ratios of its coefficients: 1 + r q (1 + r′ q (…)).
#[inline]
fn nested<const N: usize>(q: f64, ratios: [f64; N]) -> f64 {
    if q <= TINY {
        return 1.0 + ratios[0] * q * (1.0 + ratios[1] * q * (1.0 + ratios[2] * q));
    }
    ratios.iter().rev().fold(1.0, |sum, ratio| 1.0 + ratio * q * sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gear::fixtures::pair;

    /// Tier: values computed by another program, 19/48, module 3 mm, to every printed digit.
    #[test]
    fn corners_stand_apart_as_computed_elsewhere() {
        let before = [(0.1, 0.580), (0.25, 3.465), (0.5, 13.188), (1.0, 49.813), (2.0, 189.108)];
        let after = [(0.1, 0.224), (0.25, 1.412), (0.5, 5.710), (1.0, 23.337), (2.0, 97.218)];
        for (side, table) in [(Side::Gear, before), (Side::Pinion, after)] {
            let facing = Facing::new(&pair(), side);
            for (distance, micrometres) in table {
                let found = facing.tip(distance * 1e-3).separation * 1e6;
                assert!((found - micrometres).abs() <= 0.000_5, "{side:?} {distance}: {found}");
            }
        }
    }

    /// The same by plain trigonometry, which loses digits near A but not far from it.
    #[test]
    fn separations_agree_with_polar_coordinates() {
        let pair = pair();
        let (one, two) = (pair.pinion.base_radius, pair.gear.base_radius);
        let facing = Facing::new(&pair, Side::Gear);
        for point in [facing.start, 5e-3, 12e-3] {
            for before in [0.5e-3, 2e-3, 5e-3, 7.5e-3] {
                let (roll, angle) = ((pair.tangent_length - point) / two, -before / two);
                let x = pair.tangent_length - two * (roll * angle.cos() - angle.sin());
                let y = one + two - two * (roll * angle.sin() + angle.cos());
                let touched = (f64::hypot(x, y) / one).powi(2) - 1.0;
                let coordinate = one * (f64::atan2(x, y) - touched.sqrt().atan() + touched.sqrt());
                let found = facing.touch(point, before);
                let exact = coordinate - (point - before);
                assert!((found.separation / exact - 1.0).abs() < 1e-10, "{point} {before}");
                assert!((found.curvature / (one * touched.sqrt()) - 1.0).abs() < 1e-12);
            }
        }
    }

    /// Tier: closed form; where t and sin t are far enough apart for their difference to keep its digits.
    #[test]
    fn the_series_of_the_defect_is_t_less_its_sine() {
        for share in 5..=10 {
            let t = 0.05 * f64::from(share);
            assert!((defect(t) / (t - t.sin()) - 1.0).abs() < 1e-13 * (0.5 / t).powi(2), "at {t}");
        }
    }

    /// Tier: closed form; on both sides of where the series end, as long as a difference keeps its digits.
    #[test]
    fn the_series_of_small_angles_are_those_of_the_functions() {
        for share in 1..=24 {
            let t = 0.005 * f64::from(share);
            for angle in [t, -t] {
                let (sine, cosine) = angle.sin_cos();
                let (found, lift, _) = sine_lift_and_defect(angle);
                assert!((found / sine - 1.0).abs() < 4e-16, "sine of {angle}");
                let half = (0.5 * angle).sin();
                assert!((lift / (2.0 * half * half) - 1.0).abs() < 1e-15, "1 − cosine of {angle}");
                let excess = arc_excess(sine, cosine) / defect(angle) - 1.0;
                assert!(excess.abs() < 4e-15, "arc excess of {angle}: {excess:e}");
            }
        }
        let far = arc_excess(3.0_f64.sin(), 3.0_f64.cos());
        assert!((far / (3.0 - 3.0_f64.sin()) - 1.0).abs() < 1e-14, "beyond a right angle: {far}");
    }

    /// S = x²/2ρ with x = u e the tangential offset, and the first correction vanishes with e.
    #[test]
    fn near_the_nominal_point_separation_is_a_parabola() {
        let pair = pair();
        for side in [Side::Gear, Side::Pinion] {
            let facing = Facing::new(&pair, side);
            for point in [facing.start, 8e-3, 14e-3] {
                let parabola = |before: f64| {
                    let offset = facing.point_roll(point) * before;
                    let curvature = 1.0 / point + 1.0 / (pair.tangent_length - point);
                    0.5 * offset * offset * curvature
                };
                let off = |before: f64| facing.touch(point, before).separation / parabola(before) - 1.0;
                let rate = 2.0 * off(1e-7) / 1e-7 - off(2e-7) / 2e-7;
                for before in [1e-8, 1e-9, 1e-12, 1e-15] {
                    assert!((off(before) - rate * before).abs() < 1e-12 + 3e6 * before * before, "{point} {before}");
                }
                assert!((off(1e-6) / off(2e-6) - 0.5).abs() < 1e-2, "of first order");
            }
        }
    }

    /// At a fixed nominal position, against differences.
    #[test]
    fn rates_are_derivatives() {
        let facing = Facing::new(&pair(), Side::Gear);
        for (nominal, before) in [(3e-3, 1.3e-3), (10e-3, 3e-3), (-2e-3, 6e-3)] {
            let step = 1e-8;
            let at = |shift: f64| facing.touch(nominal + before + shift, before + shift);
            let (low, middle, high) = (at(-step), at(0.0), at(step));
            let rate = |value: fn(&Touch) -> f64| (value(&high) - value(&low)) / (2.0 * step);
            assert!((rate(|touch| touch.separation) / middle.slope - 1.0).abs() < 1e-7);
            assert!((rate(|touch| touch.slope) / middle.bend - 1.0).abs() < 1e-6);
            assert!((rate(|touch| touch.curvature) / middle.rate - 1.0).abs() < 1e-6);
            assert!((rate(|touch| touch.rate) / middle.rate_slope - 1.0).abs() < 1e-6);
        }
    }

    /// Tier: second method; against differences, those of the bend from where e is 0.
    #[test]
    fn the_third_derivative_on_the_line_of_action_is_that_of_differences() {
        for side in [Side::Gear, Side::Pinion] {
            let facing = Facing::new(&pair(), side);
            for nominal in [facing.start, 6e-3, 12e-3] {
                let bend = |before: f64| facing.touch(nominal + before, before).bend;
                let step = 1e-7 * nominal;
                let difference = (-1.5 * bend(0.0) + 2.0 * bend(step) - 0.5 * bend(2.0 * step)) / step;
                assert!((difference / facing.bend_slope(nominal) - 1.0).abs() < 1e-6, "{side:?} {nominal}");
            }
        }
    }

    /// Tier: second method; the closed form where e is 0.
    #[test]
    fn the_nominal_point_is_a_point_like_any_other() {
        for side in [Side::Gear, Side::Pinion] {
            let facing = Facing::new(&pair(), side);
            for nominal in [facing.start, 8e-3, facing.end] {
                let (short, long) = (facing.on_line(nominal), facing.touch(nominal, 0.0));
                for value in [
                    |touch: &Touch| touch.curvature,
                    |touch: &Touch| touch.bend,
                    |touch: &Touch| touch.rate,
                    |touch: &Touch| touch.rate_slope,
                ] {
                    assert!((value(&short) / value(&long) - 1.0).abs() < 1e-13, "{short:?} {long:?}");
                }
                assert!([short, long].iter().all(|touch| touch.separation == 0.0 && touch.slope == 0.0));
            }
        }
    }

    #[test]
    fn a_corner_reaches_to_the_other_tip_and_no_farther() {
        let facing = Facing::new(&pair(), Side::Gear);
        let reach = facing.reach(8.85e-3);
        assert!((facing.tip(reach).curvature / facing.end - 1.0).abs() < 1e-12 && reach < 8.85e-3);
        assert!((facing.reach(1e-3) - 1e-3).abs() < 1e-18);
    }
}
