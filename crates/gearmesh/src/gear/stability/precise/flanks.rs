//! How near relieved flanks come to each other, in twice the precision: the least gap anywhere on them.
//!
//! A point of one flank is placed by its polar coordinates about the other gear's centre, (ρ, θ), and the other flank is turned
//! until the involute r(θ − arctan t + t), t = √(ρ²/r² − 1), goes through it: the gap without reliefs, whose derivative is
//! r dθ + r t dρ/ρ. With linear reliefs the gap falls to its least, at a root of its derivative or at the start of a relief,
//! and then rises. Must not know: the kernels.

use crate::numeric::double_double::Double;

/// Steps of the secant method, more than it takes to the last digit that matters.
const STEPS: usize = 40;
/// The last step, over the length of the path: what it leaves is smaller by as much as it is smaller than the one before. The
/// error of the gap is of second order in that.
const PLACE: f64 = 1e-12;

/// A linear tip relief: its depth at the tip, and its roll length.
#[derive(Clone, Copy)]
pub(super) struct TipRelief {
    pub depth: Double,
    pub length: Double,
}

/// Both flanks on the path of contact, pinion and gear.
pub(super) struct Flanks {
    pub base_radii: [Double; 2],
    pub tangent_length: Double,
    /// Where the flanks of gear and pinion end towards their tips, as path positions: where contact starts and ends, unless a flank
    /// has no involute to meet there.
    pub path: [Double; 2],
    pub reliefs: [TipRelief; 2],
}

/// Where flanks come nearest.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Spot {
    OnLineOfAction,
    /// Points of this gear on their way to the line of action, after so many starts of reliefs.
    Beside {
        point: usize,
        starts: usize,
    },
    /// The start of a relief, or where a flank ends.
    Start {
        point: usize,
        starts: usize,
    },
}

/// The least gap.
#[derive(Clone, Copy)]
pub(super) struct Least {
    pub gap: Double,
    pub spot: Spot,
}

impl Flanks {
    /// The least gap anywhere on the flanks at the path position s.
    pub(super) fn least(&self, s: Double) -> Least {
        if self.reliefs.iter().all(|relief| relief.depth.high == 0.0) {
            return Least { gap: Double::ZERO, spot: Spot::OnLineOfAction };
        }
        let (one, two) = (self.beside(1, s), self.beside(0, self.tangent_length - s));
        if two.gap < one.gap { two } else { one }
    }

    /// What the tip relief of a gear takes off where its roll angle times its base radius is `length`.
    fn depth(&self, gear: usize, length: Double) -> Double {
        let before = self.start(gear) - length;
        let TipRelief { depth, length } = self.reliefs[gear];
        if before.high >= 0.0 { Double::ZERO } else { -(depth * before / length) }
    }

    /// Where a relief starts, as such a length.
    fn start(&self, gear: usize) -> Double {
        [self.path[1], self.tangent_length - self.path[0]][gear] - self.reliefs[gear].length
    }

    /// The least gap of points of this gear that are on their way to the line of action, where `nominal` is the radius of
    /// curvature of the other gear's flank.
    fn beside(&self, point: usize, nominal: Double) -> Least {
        let way = Way { flanks: self, point, nominal };
        let end = [self.tangent_length - self.path[0], self.path[1]][point];
        let mut relieved = [self.start(point) < self.tangent_length - nominal, self.start(1 - point) <= nominal];
        let on_line = || self.depth(point, self.tangent_length - nominal) + self.depth(1 - point, nominal);
        let at_once = || Least { gap: on_line(), spot: Spot::OnLineOfAction };
        if !relieved[0] {
            return at_once();
        }
        let mut slope = way.slope(&way.on_line(), relieved).high;
        if slope >= 0.0 {
            return at_once();
        }
        let limit = end - nominal;
        let (mut from, mut starts) = (Double::ZERO, 0);
        loop {
            let own = if relieved[0] { self.tangent_length - self.start(point) - nominal } else { limit };
            let wall = if relieved[1] { end } else { self.start(1 - point).min(end) };
            let (mut to, mut of_point) = (own.min(limit), true);
            let mut place = way.place(to);
            if place.curvature > wall {
                (to, of_point) = (way.meets(wall, [from, to]), false);
                place = way.place(to);
            }
            if way.slope(&place, relieved).high > 0.0 {
                let guess = from - slope / way.bend();
                let near = PLACE * end.high;
                let place = secant([from, to], slope, guess, near, |before| way.slope(&way.place(before), relieved));
                return Least { gap: way.gap(&way.place(place)), spot: Spot::Beside { point, starts } };
            }
            let ends = to >= limit || (!of_point && wall >= end);
            relieved[usize::from(!of_point)] = !of_point;
            slope = way.slope(&place, relieved).high;
            if ends || slope >= 0.0 {
                return Least { gap: way.gap(&place), spot: Spot::Start { point, starts } };
            }
            (from, starts) = (to, starts + 1);
        }
    }
}

/// Points of one gear before the flank of the other one, at one position.
struct Way<'a> {
    flanks: &'a Flanks,
    point: usize,
    nominal: Double,
}

/// A point before the line of action.
struct Place {
    /// Its own roll angle times its base radius.
    length: Double,
    /// About the other gear's centre, y to its own.
    x: Double,
    y: Double,
    /// Derivatives of both.
    dx: Double,
    dy: Double,
    /// The radius of curvature of the flank there.
    curvature: Double,
}

impl Way<'_> {
    /// Where the point is that is still so far before the line of action.
    fn place(&self, before: Double) -> Place {
        let [own, other] = [self.point, 1 - self.point].map(|gear| self.flanks.base_radii[gear]);
        let length = self.flanks.tangent_length - self.nominal - before;
        let (sine, cosine) = (before / own).sine_cosine();
        let x = self.flanks.tangent_length - length * cosine - own * sine;
        let y = own + other + length * sine - own * cosine;
        let (arm, curvature) = (length / own, (x.square() + y.square() - other.square()).sqrt());
        Place { length, x, y, dx: arm * sine, dy: arm * cosine, curvature }
    }

    /// Where it is on it.
    fn on_line(&self) -> Place {
        let length = self.flanks.tangent_length - self.nominal;
        let [own, other] = [self.point, 1 - self.point].map(|gear| self.flanks.base_radii[gear]);
        let (x, y, curvature) = (self.nominal, other, self.nominal);
        Place { length, x, y, dx: Double::ZERO, dy: length / own, curvature }
    }

    fn gap(&self, place: &Place) -> Double {
        let Place { length, x, y, curvature, .. } = *place;
        let other = self.flanks.base_radii[1 - self.point];
        // The difference of the angles of (y, x) and (r, r t).
        let angle = (x * other - y * curvature).arctangent(y * other + x * curvature);
        let turned = angle * other + curvature - self.nominal;
        turned + self.flanks.depth(self.point, length) + self.flanks.depth(1 - self.point, curvature)
    }

    /// Its derivative, with point and flank on their reliefs or not.
    fn slope(&self, place: &Place, relieved: [bool; 2]) -> Double {
        let Place { x, y, dx, dy, curvature, .. } = *place;
        let other = self.flanks.base_radii[1 - self.point];
        let (outwards, around) = (x * dx + y * dy, y * dx - x * dy);
        let rate = |gear: usize| self.flanks.reliefs[gear].depth / self.flanks.reliefs[gear].length;
        let mut slope = (other * around + curvature * outwards) / (x.square() + y.square());
        if relieved[0] {
            slope -= rate(self.point);
        }
        if relieved[1] {
            slope += rate(1 - self.point) * outwards / curvature;
        }
        slope
    }

    /// About the second derivative of the gap.
    fn bend(&self) -> f64 {
        let roll = (self.flanks.tangent_length - self.nominal).high / self.flanks.base_radii[self.point].high;
        roll * (roll / self.nominal.high + 1.0 / self.flanks.base_radii[self.point].high)
    }

    /// Where the flank has this radius of curvature.
    fn meets(&self, wall: Double, [from, to]: [Double; 2]) -> Double {
        let miss = |before: Double| self.place(before).curvature - wall;
        secant([from, to], miss(from).high, (from + to).half(), PLACE * wall.high, miss)
    }
}

/// Where a function that rises from `at_low`, below zero, to above is zero: by secants, and by halves where they lead away.
fn secant(
    [mut low, mut high]: [Double; 2],
    at_low: f64,
    guess: Double,
    near: f64,
    function: impl Fn(Double) -> Double,
) -> Double {
    let (mut last, mut at_last) = (low, at_low);
    let mut next = if guess > low && guess < high { guess } else { high };
    for _ in 0..STEPS {
        let (here, at_here) = (next, function(next).high);
        if at_here < 0.0 {
            low = here;
        } else {
            high = here;
        }
        // Steps need no more digits than a number has: each takes the error down by as many.
        next = here - at_here * ((here - last).high / (at_here - at_last));
        if at_here == 0.0 || (next - here).high.abs() <= near {
            break;
        }
        if !(next > low && next < high) {
            next = (low + high).half();
        }
        (last, at_last) = (here, at_here);
    }
    if next >= low && next <= high { next } else { high }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gear::fixtures::{design, least_gap, pair};
    use declare::record::Value::Quantity;

    /// Tier: second method; the same in plain precision, by thirds: reliefs that are steep, long enough to overlap, and short.
    #[test]
    fn the_least_gap_is_that_of_a_search_by_thirds() {
        let pair = pair();
        for (depth, length) in [(9e-6, 4e-3), (60e-6, 1e-3), (20e-6, 9e-3), (5e-6, 0.1e-3)] {
            let relief = [("amount", Quantity(depth)), ("length", Quantity(length))];
            let design = design(&pair, &[("tip_relief", "both", &relief)]).unwrap();
            let relief = TipRelief { depth: depth.into(), length: length.into() };
            let flanks = Flanks {
                base_radii: [pair.pinion.base_radius, pair.gear.base_radius].map(Double::from),
                tangent_length: pair.tangent_length.into(),
                path: [pair.start_of_contact, pair.end_of_contact].map(Double::from),
                reliefs: [relief; 2],
            };
            for index in 0..=200 {
                let s =
                    pair.start_of_contact + (pair.end_of_contact - pair.start_of_contact) * f64::from(index) / 200.0;
                let (found, plain) = (flanks.least(s.into()).gap.high, least_gap(&pair, &design, s));
                assert!((found - plain).abs() < 2e-16, "{depth} {length} at {s}: {found:e} {plain:e}");
            }
        }
    }
}
