//! What `arc` and `parabola` share: a curve that leaves the flank at B along its tangent and ends at A on the tip circle.
//!
//! Source: Mei et al., Mathematical Problems in Engineering 2016, 6347987 (`mei2016`), sections 3 to 5. Frame of the
//! article: the involute is r_b(cos t + t sin t, sin t − t cos t), t the roll angle, with the tangent (cos t, sin t).
//! Frame used here: the origin in B, X along that tangent, Y out of the tooth, so that nothing cancels near B. A point d
//! inside the flank on the normal at roll angle u lies on a line tangent to the base circle; where that line meets the
//! curve is a quadratic. A itself, moved by the angle σ along the tip circle, is r_b σ deep on the normal of u_a + σ:
//! beyond the roll angle u_a of the nominal corner, where the depth is less. Must not know: compliance, load.

#[cfg(test)]
mod tests;

use super::{MOST_AMOUNT, Modification};
use crate::gear::geometry::Gear;
use crate::gear::geometry::error::shown::decimals;
use declare::error::Diagnostic;
use declare::units::LENGTH;
use declare::{Alternatives, Declared, Words};

/// Where the curve ends: how far A is moved from the corner inwards along the tip circle.
#[derive(Clone, Copy, Debug, PartialEq, Alternatives)]
pub enum TipPoint {
    /// How far A is moved from the corner inwards along the tip circle, as a share of the tip thickness s_a.
    #[declared(name = "tip_share", minimum = 0.0, maximum = 0.5, range, example = "0.06")]
    Share(f64),
    /// Instead of `tip_share`: the same as a length along the tip circle.
    #[declared(name = "tip_amount", dimension = LENGTH, minimum = 0.0, maximum = MOST_AMOUNT, range, example = "12 um")]
    Amount(f64),
}

/// Where the curve starts: B.
#[derive(Clone, Copy, Debug, PartialEq, Alternatives)]
pub enum FlankPoint {
    /// How far B is from the tip, as a share of the arc length of the whole involute, from the form circle to the tip.
    #[declared(name = "length_share", minimum = 0.0, maximum = 1.0, range, example = "0.15")]
    Share(f64),
    /// Instead of `length_share`: diameter at which B lies.
    #[declared(name = "start_diameter", dimension = LENGTH, minimum = 1e-4, maximum = 100.0, range, example = "75 mm")]
    Diameter(f64),
}

/// Which formulas give the curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Words)]
pub enum Formulas {
    /// tangent to the involute at B, through A
    #[default]
    Derived,
    /// equations 9 to 15 of mei2016 to the letter, in mm; refused where they give no flank
    Printed,
}

/// What `arc` and `parabola` go through.
#[derive(Clone, Copy, Debug, PartialEq, Declared)]
pub struct Through {
    /// A, where it ends.
    #[declared(flatten)]
    pub tip: TipPoint,
    /// B, where it starts.
    #[declared(flatten)]
    pub start: FlankPoint,
    /// Which formulas give the curve.
    #[declared(default = "derived")]
    pub formulas: Formulas,
}

/// xx X² + 2 xy XY + yy Y² + 2 x X + 2 y Y + constant, 0 on the curve, positive outside the tooth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Conic {
    pub xx: f64,
    pub xy: f64,
    pub yy: f64,
    pub x: f64,
    pub y: f64,
    pub constant: f64,
}

impl Conic {
    /// The same curve, given in the frame of the article, with the origin moved to `origin` and the axes turned by the
    /// angle of the tangent at t.
    fn seen_from(self, origin: [f64; 2], t: f64) -> Self {
        let Self { xx, xy, yy, x, y, constant } = self;
        let [a, b] = origin;
        let (slope_x, slope_y) = (xx * a + xy * b + x, xy * a + yy * b + y);
        let constant = xx * a * a + 2.0 * xy * a * b + yy * b * b + 2.0 * (x * a + y * b) + constant;
        // Article's (x, y) = origin + X (c, s) + Y (s, −c).
        let (s, c) = libm::sincos(t);
        Self {
            xx: xx * c * c + 2.0 * xy * s * c + yy * s * s,
            xy: (xx - yy) * s * c + xy * (s * s - c * c),
            yy: xx * s * s - 2.0 * xy * s * c + yy * c * c,
            x: slope_x * c + slope_y * s,
            y: slope_x * s - slope_y * c,
            constant,
        }
    }

    fn times(self, factor: f64) -> Self {
        let [xx, xy, yy, x, y, constant] =
            [self.xx, self.xy, self.yy, self.x, self.y, self.constant].map(|value| value * factor);
        Self { xx, xy, yy, x, y, constant }
    }
}

/// Where A and B lie on a gear.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ends {
    pub base_radius: f64,
    /// ψ_b: the angle from where the involute starts to the tooth's centreline.
    half_base_angle: f64,
    /// t: roll angle of B.
    pub start: f64,
    /// Roll angle of the nominal corner.
    tip: f64,
    /// σ: the angle by which A is turned from the nominal corner.
    pub shift: f64,
}

impl Ends {
    /// Roll angle of the normal through A.
    fn corner(&self) -> f64 {
        self.tip + self.shift
    }

    /// The flank point at a roll angle, seen from B, and the sine and cosine of the turn from B's normal to its own.
    fn flank(&self, roll: f64) -> ([f64; 2], f64, f64) {
        let turn = roll - self.start;
        let (sine, cosine) = libm::sincos(turn);
        let half = libm::sin(0.5 * turn);
        let versed = 2.0 * half * half;
        let along = self.base_radius * (roll * sine - versed);
        let across = -self.base_radius * (lag(turn) + self.start * versed);
        ([along, across], sine, cosine)
    }

    /// A, seen from B.
    pub(super) fn a(&self) -> [f64; 2] {
        let ([along, across], sine, cosine) = self.flank(self.corner());
        let depth = self.base_radius * self.shift;
        [along - depth * sine, across - depth * cosine]
    }

    /// A in the frame of the article.
    pub(super) fn a_in_article(&self) -> [f64; 2] {
        let angle = self.tip - libm::atan(self.tip) + self.shift;
        let radius = self.base_radius * libm::hypot(1.0, self.tip);
        [radius * libm::cos(angle), radius * libm::sin(angle)]
    }

    /// The involute's point at the roll angle `roll` in the frame of the article: its equation 11.
    pub(super) fn b_in_article(&self, roll: f64) -> [f64; 2] {
        let (sine, cosine) = libm::sincos(roll);
        [self.base_radius * (cosine + roll * sine), self.base_radius * (sine - roll * cosine)]
    }

    /// α' as the article defines it: the pressure angle at B.
    pub(super) fn pressure_angle(&self) -> f64 {
        libm::atan(self.start)
    }
}

/// 2k/(2k + 1)! with alternating signs.
const LAG: [f64; 12] = {
    let mut coefficients = [1.0 / 3.0; 12];
    let mut k = 2;
    while k <= 12 {
        let whole = k as f64;
        coefficients[k - 1] = -coefficients[k - 2] / ((whole - 1.0) * 2.0 * (2.0 * whole + 1.0));
        k += 1;
    }
    coefficients
};

/// sin v − v cos v = v³/3 − v⁵/30 + …, whose two terms would cancel; for v up to 1.5.
fn lag(v: f64) -> f64 {
    let square = v * v;
    LAG.iter().rev().fold(0.0, |sum, coefficient| coefficient + square * sum) * square * v
}

/// What one of the two families adds: its curve by each set of formulas.
pub(super) struct CurveThrough {
    /// Seen from B.
    pub derived: fn(&Ends) -> Conic,
    /// In the frame of the article, in mm, for its A and B and its α.
    pub printed: fn([f64; 2], [f64; 2], f64) -> Conic,
}

/// The modification: nothing below B, the curve from there to A, A's own depth beyond.
#[derive(Debug)]
pub(super) struct TipCurve {
    ends: Ends,
    conic: Conic,
    /// Roll angles of B and A.
    breaks: [f64; 2],
}

/// At how many places the curve is checked before it is accepted.
const LOOKS: u32 = 64;

/// A curve whose distance from B is more than this share of the base radius does not pass through B.
const THROUGH: f64 = 1e-9;

impl TipCurve {
    pub(super) fn new(through: Through, gear: &Gear, shape: &CurveThrough) -> Result<Self, Diagnostic> {
        let (share, tip_name) = (through.tip.share(gear)?, through.tip.field());
        let (start, start_name) = (through.start.roll(gear)?, through.start.field());
        let ends = |share: f64, start: f64| Ends {
            base_radius: gear.base_radius,
            half_base_angle: gear.half_base_angle,
            start,
            tip: gear.tip_roll(),
            shift: share * gear.tip_thickness() / gear.tip_radius,
        };
        let mut given = ends(share, start);
        if through.formulas == Formulas::Printed {
            let angle = given.pressure_angle();
            // The article calls α' the pressure angle and puts it where its own source has the roll angle.
            given.start = angle;
            let millimetres = |point: [f64; 2]| point.map(|value| value * 1e3);
            let (a, b) = (millimetres(given.a_in_article()), millimetres(given.b_in_article(angle)));
            let printed = (shape.printed)(a, b, 2.0 * angle - libm::tan(angle)).seen_from(b, angle);
            // From mm to m: the quadratic terms are per length.
            let Conic { xx, xy, yy, constant, .. } = printed;
            let metres = Conic { xx: xx * 1e3, xy: xy * 1e3, yy: yy * 1e3, constant: constant * 1e-3, ..printed };
            let metres = if metres.y < 0.0 { metres.times(-1.0) } else { metres };
            let curve = Self::along(given, metres);
            return match curve.fault() {
                None => Ok(curve),
                Some(fault) => Err(Diagnostic::new(format!("the formulas as printed give no flank: {fault}"))
                    .of(Through::NAMES.formulas)
                    .help("`formulas: derived` is the curve they are meant to give")),
            };
        }
        let curve = |ends: Ends| Self::along(ends, (shape.derived)(&ends));
        let Some(fault) = curve(given).fault() else { return Ok(curve(given)) };
        let fits = |share: f64, start: f64| curve(ends(share, start)).fault().is_none();
        let roll = |length: f64| roll_at_length(gear, length);
        let (name, remedy) = if let Some((minimum, maximum)) = range(0.5, |share| fits(share, start)) {
            let [shortest, longest] = [minimum, maximum].map(|share| share * gear.tip_thickness() * 1e3);
            let (minimum, maximum) = (minimum * 1e2, maximum * 1e2);
            let room =
                format!("{minimum:.4} to {maximum:.4} % of the tip thickness ({shortest:.6} to {longest:.6} mm)");
            (tip_name, format!("with this B, A may be moved by {room}"))
        } else if let Some((minimum, maximum)) = range(1.0, |length| fits(share, roll(length))) {
            let [highest, lowest] = [minimum, maximum].map(|length| gear.radius_at(roll(length)) * 2e3);
            let (minimum, maximum) = (minimum * 1e2, maximum * 1e2);
            let room =
                format!("{minimum:.4} to {maximum:.4} % of the involute (diameters {lowest:.6} to {highest:.6} mm)");
            (start_name, format!("with this A, B may lie below the tip by {room}"))
        } else {
            (tip_name, "with this A no B will do".to_owned())
        };
        Err(Diagnostic::new(format!("{fault}; {remedy}")).of(name))
    }

    fn along(ends: Ends, conic: Conic) -> Self {
        Self { ends, conic, breaks: [ends.start, ends.corner()] }
    }

    /// The smaller root of the quadratic at a roll angle; none where the normal misses the curve or is its tangent.
    fn intersection(&self, roll: f64) -> Option<f64> {
        self.intersection_of(&self.ends.flank(roll))
    }

    /// The same with its first and second derivative over the roll angle. The point on the curve is P = Q − d n, with the flank
    /// point Q, the normal n and the tangent t, Q' = r_b u t, n' = t, t' = −n, and F(P) = 0 is derived twice.
    fn rates(&self, roll: f64) -> Option<[f64; 3]> {
        let flank = self.ends.flank(roll);
        let (depth, ([along, across], sine, cosine)) = (self.intersection_of(&flank)?, flank);
        let Conic { xx, xy, yy, x, y, .. } = self.conic;
        let (px, py) = (along - depth * sine, across - depth * cosine);
        // Half of F's derivatives.
        let (fx, fy) = (xx * px + xy * py + x, xy * px + yy * py + y);
        let (along_tangent, along_normal) = (fx * cosine - fy * sine, fx * sine + fy * cosine);
        let radius = self.ends.base_radius * roll - depth;
        let slope = radius * along_tangent / along_normal;
        let (vx, vy) = (radius * cosine - slope * sine, -radius * sine - slope * cosine);
        let curved = vx * (xx * vx + 2.0 * xy * vy) + yy * vy * vy;
        let bend = ((self.ends.base_radius - 2.0 * slope) * along_tangent + curved) / along_normal - radius;
        Some([depth, slope, bend])
    }

    fn intersection_of(&self, ([along, across], sine, cosine): &([f64; 2], f64, f64)) -> Option<f64> {
        let Conic { xx, xy, yy, x, y, constant } = self.conic;
        let (slope_x, slope_y) = (xx * along + xy * across, xy * along + yy * across);
        let bend = xx * sine * sine + 2.0 * xy * sine * cosine + yy * cosine * cosine;
        let slope = (slope_x + x) * sine + (slope_y + y) * cosine;
        let value = slope_x * along + slope_y * across + 2.0 * (x * along + y * across) + constant;
        let root = slope * slope - bend * value;
        (slope > 0.0 && root >= 0.0).then(|| value / (slope + root.sqrt()))
    }

    /// Why material cannot be taken off along the curve.
    fn fault(&self) -> Option<String> {
        let Ends { base_radius, start, .. } = self.ends;
        let corner = self.ends.corner();
        let at = |roll: f64| format!("at a roll angle of {:.4} deg", roll.to_degrees());
        let reach = base_radius * THROUGH;
        match self.intersection(start) {
            Some(depth) if depth.abs() <= reach => {}
            Some(depth) => {
                return Some(format!("the curve passes B {:.4} mm beside it, {}", depth.abs() * 1e3, at(start)));
            }
            None => return Some(format!("the curve does not meet the flank's normal {}, in B", at(start))),
        }
        let mut worst = (0.0, start);
        for look in 1..=LOOKS {
            let roll = start + (corner - start) * f64::from(look) / f64::from(LOOKS);
            let Some(depth) = self.intersection(roll) else {
                return Some(format!("the curve does not meet the flank's normal {}", at(roll)));
            };
            if depth < worst.0 {
                worst = (depth, roll);
            }
            let rest = roll - depth / base_radius;
            if rest <= 0.0 || roll - libm::atan(rest) > self.ends.half_base_angle * (1.0 + THROUGH) {
                return Some(format!("the curve would take off more than half of the tooth {}", at(roll)));
            }
        }
        // What rounding makes of a curve that coincides with the flank is not material.
        if worst.0 < -reach * 1e-3 {
            return Some(format!("the curve would add {:.4} um of material {}", -worst.0 * 1e6, at(worst.1)));
        }
        let (depth, wanted) = (self.intersection(corner)?, base_radius * self.ends.shift);
        ((depth - wanted).abs() > reach)
            .then(|| format!("the curve passes A {:.4} mm beside it, {}", (depth - wanted).abs() * 1e3, at(corner)))
    }
}

/// The least and the largest value from 0 to `maximum` that fits, when any of fifty does.
fn range(maximum: f64, fits: impl Fn(f64) -> bool) -> Option<(f64, f64)> {
    let places: Vec<f64> = (0..=50).map(|place| maximum * f64::from(place) / 50.0).collect();
    let (first, last) = (places.iter().position(|&place| fits(place))?, places.iter().rposition(|&place| fits(place))?);
    let edge = |inside: usize, outside: Option<usize>| {
        let (mut good, Some(mut bad)) = (places[inside], outside.map(|outside| places[outside])) else {
            return places[inside];
        };
        for _ in 0..30 {
            let middle = 0.5 * (good + bad);
            *(if fits(middle) { &mut good } else { &mut bad }) = middle;
        }
        good
    };
    Some((edge(first, first.checked_sub(1)), edge(last, (last < 50).then_some(last + 1))))
}

impl TipPoint {
    /// The share of the tip thickness by which A is moved.
    fn share(self, gear: &Gear) -> Result<f64, Diagnostic> {
        let amount = match self {
            Self::Share(share) => return Ok(share),
            Self::Amount(amount) => amount,
        };
        let thickness = gear.tip_thickness();
        if amount > 0.5 * thickness {
            let (given, maximum) = (amount * 1e3, thickness * 0.5e3);
            let digits = decimals(given, maximum);
            let message = format!(
                "A is moved by {given:.digits$} mm along the tip circle; half of the tip leaves 0 to {maximum:.digits$} mm"
            );
            return Err(Diagnostic::new(message).of(self.field()));
        }
        Ok(amount / thickness)
    }
}

impl FlankPoint {
    /// The roll angle of B.
    fn roll(self, gear: &Gear) -> Result<f64, Diagnostic> {
        let radius = match self {
            Self::Share(share) => return Ok(roll_at_length(gear, share)),
            Self::Diameter(diameter) => 0.5 * diameter,
        };
        if !(radius >= gear.form_radius && radius <= gear.tip_radius) {
            let [given, minimum, maximum] = [radius, gear.form_radius, gear.tip_radius].map(|radius| radius * 2e3);
            let digits = decimals(given, minimum).max(decimals(given, maximum));
            let message = format!(
                "the start diameter is {given:.digits$} mm; the involute has diameters of {minimum:.digits$} to {maximum:.digits$} mm"
            );
            return Err(Diagnostic::new(message).of(self.field()));
        }
        Ok(gear.roll_at(radius))
    }
}

/// The roll angle above which this share of the involute lies, whose arc length grows with the square of the roll angle.
fn roll_at_length(gear: &Gear, share: f64) -> f64 {
    let (tip, form) = (gear.tip_roll(), gear.form_roll);
    (tip * tip * (1.0 - share) + form * form * share).sqrt()
}

impl Modification for TipCurve {
    fn depth(&self, roll: f64) -> f64 {
        if roll <= self.ends.start {
            return 0.0;
        }
        // The curve was looked at all over: a normal that misses it would be one of a curve of no length.
        self.intersection(roll.min(self.ends.corner())).unwrap_or(0.0)
    }

    fn profile_rates(&self, roll: f64, inside: f64) -> Option<[f64; 3]> {
        let [start, corner] = self.breaks;
        if inside <= start {
            return Some([0.0; 3]);
        }
        if inside >= corner {
            return Some([self.depth(corner), 0.0, 0.0]);
        }
        self.rates(roll)
    }

    fn profile_breaks(&self) -> &[f64] {
        &self.breaks
    }

    fn varies_along_profile(&self) -> bool {
        self.ends.start < self.ends.tip
    }

    fn resolved(&self) -> Vec<(&'static str, f64)> {
        let Ends { base_radius, start, tip, shift, .. } = self.ends;
        let ([x_a, y_a], [x_b, y_b]) = (self.ends.a_in_article(), self.ends.b_in_article(start));
        vec![
            ("amount", base_radius * shift),
            ("length", base_radius * (tip - start)),
            ("start_roll_angle", start),
            ("start_diameter", 2.0 * base_radius * libm::hypot(1.0, start)),
            ("depth_at_tip", self.depth(tip)),
            ("x_A", x_a),
            ("y_A", y_a),
            ("x_B", x_b),
            ("y_B", y_b),
        ]
    }
}
