//! Contact near the corner of a tooth's tip: a parabola pressed on a wedge.
//!
//! Far from its edge a surface yields to a line load as a half plane does; at the distance c from a corner it yields by
//! −B ln c more (Timoshenko and Goodier, Theory of Elasticity, 3rd edition, article 38: a wedge loaded at its end). Between
//! two places at ξ and η from the corner it is taken for B ln((ξ + η)/2), which is right on the diagonal and at one corner
//! end, and elsewhere off by 0.15 of B at most. With half the Hertzian width b as unit and λ = c/b where the parabola has
//! its top, below 0 beyond the corner, the approach follows from
//!
//! (ξ − λ)² − ∫ [ln|ξ − η| + B/k₀ ln((ξ + η)/2)] p dη = Ψ/k₀, ∫ p = 1, p ≥ 0, ξ ≥ 0,
//!
//! k₀ = Σ 2/(πE′): without corner Ψ/k₀ = ln 2 + ½ (Johnson, Contact Mechanics, 4.2). The ends of the contact are given and
//! λ follows, since everything else in the equation is linear.
//!
//! The load at ξ acts along the normal of the other flank, which is turned against the wedge's side by (ξ − λ) b/ρ towards
//! the inside, ρ the parabola's radius; beyond the corner by −λ b/ρ at the corner itself, which is not counted here. To first
//! order that adds P² b/ρ (D ξ̄ − D_B M) to the energy of the load P, ξ̄ the mean of ξ, less λ where that is above 0, M the
//! mean of that times ln((ξ + η)/2), and with D − D_B ln c half of what the compliance at c gains per angle. What it adds to
//! the approach, with b ∝ √P and λ ∝ 1/b, are [`Wedge::turned`]. Must not know: gears, loads.

mod spread;

pub use spread::Spread;

use std::f64::consts::{FRAC_PI_2, LN_2, PI};

use self::spread::Spreads;
use crate::numeric::bundle::Bundle;
use crate::numeric::chebyshev::{Series, nodes};
use crate::numeric::crossing::crossing;
use crate::numeric::elimination::solve;

/// Terms of the pressure, a cosine series in the angle whose cosine is the place; near a corner it is 3e-5 off in Ψ/k₀.
const TERMS: usize = 16;
/// Points on which the corner's influence is summed.
const POINTS: usize = 2 * TERMS;
/// λ up to where there is a table; beyond, −B/k₀ ln λ is left and a rest that falls as 1/λ².
const FAR: f64 = 10.0;
/// λ down to where there is one; beyond, the contact is so narrow that only its logarithm changes.
const BEYOND: f64 = -30.0;
/// ln of its size.
const LN_BEYOND: f64 = 3.401_197_381_662_155_4;
/// Where the tables are joined besides the corner and the place where the contact reaches it.
const JOINTS: [f64; 2] = [-2.0, 2.0];
/// Nodes of a table.
const NODES: usize = 12;
/// How well the ends of a contact are found.
const CLOSE: f64 = 1e-8;
/// The narrowest contact that is looked at when λ is below [`BEYOND`].
const NARROWEST: f64 = 1e-3;
/// Start over end of a contact, when λ is above [`FAR`].
const ROUNDEST: f64 = 0.95;

/// By how much the end of a wedge moves under a load there along its bisector and under one across it, times E′, for each
/// factor e of the distance.
fn principal(interior: f64) -> [f64; 2] {
    let (half, shear) = (0.5 * interior, 0.5 * libm::sin(interior));
    [1.0 / (half + shear), 1.0 / (half - shear)]
}

/// B E′: near a corner of the angle `interior`, > 0 and < 2π \[rad\], the surface yields by −B ln c more than that of a half
/// plane to a load on one of its sides, normal to it, at the distance c from the corner. 0 for a half plane.
#[must_use]
pub fn softening(interior: f64) -> f64 {
    let [along, across] = principal(interior);
    // The load against the bisector.
    let (sine, cosine) = libm::sincos(FRAC_PI_2 - 0.5 * interior);
    cosine * cosine * along + sine * sine * across - 2.0 / PI
}

/// The same of loads that are turned from the normal, towards the inside: along the side by a load normal to it, and by one
/// along it less by one normal to it. A half plane yields alike in all directions.
#[must_use]
pub fn inclined_softening(interior: f64) -> [f64; 2] {
    let [along, across] = principal(interior);
    let (sine, cosine) = libm::sincos(PI - interior);
    [0.5 * sine * (along - across), cosine * (across - along)]
}

/// By how much a parabola approaches a wedge more than a half plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Wedge {
    /// B/k₀.
    ratio: f64,
    /// In order; the first one over ln(−λ).
    tables: [Table; 5],
    /// Of the first two what [`Wedge::more`] grows by per B/k₀, and its slope.
    by_ratio: [Bundle<2, NODES>; 2],
    /// Times 1/λ² beyond [`FAR`].
    rest: f64,
    /// At [`BEYOND`].
    last: [f64; 4],
    /// What turns, at [`FAR`].
    first: [f64; 2],
    /// [`Wedge::turned`] at twice [`FAR`], and the logarithm of that.
    second: [f64; 3],
    /// How the contact spreads.
    spreads: Spreads,
}

/// A stretch of λ: `more` and its slope, both that turn, and their slopes.
type Table = Bundle<6, NODES>;

/// What a wedge does at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rates {
    /// [`Wedge::more`], and its slope.
    pub more: [f64; 2],
    /// What that grows by per B/k₀, and the slope of it; 0 inside, at λ > 0.
    pub by_ratio: [f64; 2],
    /// [`Wedge::turned`], and the slopes of it.
    pub turned: [[f64; 2]; 2],
}

impl Wedge {
    /// `ratio`: B/k₀, 0 or more, below 1.
    #[must_use]
    pub fn new(ratio: f64) -> Self {
        let waves = Waves::new();
        let at_corner = Shape::new(0.0, ratio, &waves);
        let inside = |start: f64| Shape::new(start, ratio, &waves).inside();
        let (reached, roundest) = (at_corner.inside(), inside(ROUNDEST).place);
        let narrowest = at_corner.ending_at(NARROWEST).place;
        let contact = |place: f64| {
            if place >= reached.place {
                let miss = |start: f64| inside(start).place - place;
                let ends = [(0.0, reached.place - place), (ROUNDEST, roundest - place)];
                inside(crossing(miss, ends[0], ends[1], CLOSE))
            } else {
                let miss = |end: f64| at_corner.ending_at(end).place - place;
                let ends = [(NARROWEST, narrowest - place), (reached.end, reached.place - place)];
                at_corner.ending_at(crossing(miss, ends[0], ends[1], CLOSE * NARROWEST))
            }
        };
        // Above the least gap, which is at the corner where the top is beyond it.
        let values = |place: f64, found: &Contact| {
            let more = found.above_corner + if place < 0.0 { 0.0 } else { place * place } - LN_2 - 0.5;
            let [mean, logarithm, product] = found.means(&waves);
            let inside = place.max(0.0);
            [more, logarithm, mean - inside, product - inside * logarithm]
        };
        let logs = [libm::log(-JOINTS[0]), libm::log(-BEYOND)];
        let ranges = [logs, [JOINTS[0], 0.0], [0.0, reached.place], [reached.place, JOINTS[1]], [JOINTS[1], FAR]];
        // λ at the nodes of a table, and what turns a slope of it into λ d/dλ.
        let places: [Vec<[f64; 2]>; 5] = std::array::from_fn(|table| {
            let arguments = nodes(ranges[table][0], ranges[table][1], NODES).into_iter();
            arguments.map(|at| if table == 0 { [-libm::exp(at), 1.0] } else { [at; 2] }).collect()
        });
        let contacts: [Vec<Contact>; 5] =
            std::array::from_fn(|table| places[table].iter().map(|[place, _]| contact(*place)).collect());
        let tabulated: [(Table, Bundle<2, NODES>); 5] = std::array::from_fn(|table| {
            let found = places[table].iter().zip(&contacts[table]).map(|([place, _], found)| values(*place, found));
            tabulated(ranges[table], &places[table], &found.collect::<Vec<_>>())
        });
        let by_ratio = [0, 1].map(|table: usize| tabulated[table].1.clone());
        let tables = tabulated.map(|(table, _)| table);
        let spreads = Spreads::new(&ranges, &contacts, &reached);
        let at = |table: usize, at: f64| {
            let [more, _, g, h, _, _] = tables[table].values(at);
            [more, g, h]
        };
        let ([more, g, h], [last, last_g, last_h]) = (at(4, FAR), at(0, logs[1]));
        let last = [last, by_ratio[0].values(logs[1])[0], last_g, last_h];
        let rest = (more + ratio * libm::log(FAR)) * FAR * FAR;
        let (first, second) = ([g, h], [0.0; 3]);
        let mut wedge = Self { ratio, tables, by_ratio, rest, last, first, second, spreads };
        let [[g, h], _] = wedge.turned(2.0 * FAR);
        wedge.second = [g, h, libm::log(2.0 * FAR)];
        wedge
    }

    /// B/k₀.
    #[must_use]
    pub const fn ratio(&self) -> f64 {
        self.ratio
    }

    /// Which table λ is in, from the end of the first one to [`FAR`].
    fn table(&self, place: f64) -> usize {
        1 + self.tables[1..4].iter().position(|table| place <= table.upper()).unwrap_or(3)
    }

    /// How a contact with its top at λ spreads.
    #[must_use]
    pub fn spread(&self, place: f64) -> Spread {
        let table = if place < JOINTS[0] { 0 } else { self.table(place) };
        self.spreads.at(table, place)
    }

    /// All that it does at λ, of which `log` is ln|λ|.
    #[must_use]
    pub fn rates(&self, place: f64, log: f64) -> Rates {
        // What turns falls as 1/λ.
        let far = |[g, h]: [f64; 2]| [[g, h], [-g / place, -h / place]];
        if place > FAR {
            let square = self.rest / (place * place);
            let [values, slopes] = far(self.first.map(|value| value * FAR / place));
            let beyond = log - std::f64::consts::LN_10;
            return Rates {
                more: [square - self.ratio * log, -(2.0 * square + self.ratio) / place],
                by_ratio: [0.0; 2],
                turned: [
                    [values[0], values[1] + beyond * values[0]],
                    [slopes[0], slopes[1] + beyond * slopes[0] + values[0] / place],
                ],
            };
        }
        if place < BEYOND {
            let (slope, beyond) = (1.0 + self.ratio, log - LN_BEYOND);
            return Rates {
                more: [self.last[0] + slope * beyond, slope / place],
                by_ratio: [self.last[1] + beyond, 1.0 / place],
                turned: far([self.last[2], self.last[3]].map(|value| value * BEYOND / place)),
            };
        }
        let (table, at, rate) = if place < JOINTS[0] { (0, log, 1.0 / place) } else { (self.table(place), place, 1.0) };
        let [more, slope, g, h, g_slope, h_slope] = self.tables[table].values(at);
        let [by_ratio, by_ratio_slope] = self.by_ratio.get(table).map_or([0.0; 2], |table| table.values(at));
        Rates {
            more: [more, slope * rate],
            by_ratio: [by_ratio, by_ratio_slope * rate],
            turned: [[g, h], [g_slope * rate, h_slope * rate]],
        }
    }

    fn rates_at(&self, place: f64) -> Rates {
        self.rates(place, libm::log(place.abs()))
    }

    /// (Ψ − k₀ λ² where λ < 0)/k₀ − ln 2 − ½, and its slope over λ. Continuous; towards −B/k₀ ln λ far inside, and by
    /// (1 + B/k₀) ln|λ| larger and larger beyond the corner.
    #[must_use]
    pub fn more(&self, place: f64) -> [f64; 2] {
        self.rates_at(place).more
    }

    /// How much [`Wedge::more`] grows per B/k₀ at λ < 0, and the slope of that over λ.
    #[must_use]
    pub fn by_ratio(&self, place: f64) -> [f64; 2] {
        self.rates_at(place).by_ratio
    }

    /// What the normal of the other flank adds to the approach as it turns along the contact, [g, h], and their slopes over
    /// λ: b/ρ [(D − D_B ln b) g − D_B h] per load. Far from the corner it falls as 1/λ; far inside so that it is D − D_B ln c
    /// that counts.
    #[must_use]
    pub fn turned(&self, place: f64) -> [[f64; 2]; 2] {
        self.rates_at(place).turned
    }

    /// g and h at twice the λ from which on they fall as 1/λ, and the logarithm of that λ.
    #[must_use]
    pub const fn turned_far(&self) -> [f64; 3] {
        self.second
    }

    /// What is left of [`Wedge::more`] far inside, besides −B/k₀ ln λ, times λ².
    #[must_use]
    pub fn rest(&self) -> f64 {
        self.rest
    }

    /// λ from which on that is all.
    #[must_use]
    pub const fn far() -> f64 {
        FAR
    }
}

/// The tables of a stretch of a variable, from λ at its nodes, with what turns slopes into λ d/dλ, and what was found there;
/// and what `more` grows by per B/k₀, with its slope.
fn tabulated([lower, upper]: [f64; 2], places: &[[f64; 2]], found: &[[f64; 4]]) -> (Table, Bundle<2, NODES>) {
    let series = |values: &dyn Fn(usize) -> f64| {
        Series::from_values(lower, upper, &(0..NODES).map(values).collect::<Vec<f64>>())
    };
    let rates = [1, 2, 3].map(|which| {
        let slope = series(&|k| found[k][which]).derivative();
        nodes(lower, upper, NODES)
            .iter()
            .zip(places)
            .map(|(at, place)| slope.value(*at) * place[1])
            .collect::<Vec<f64>>()
    });
    let with_slope = |values: Series| {
        let slope = values.derivative();
        (values, slope)
    };
    let values = [
        with_slope(series(&|k| found[k][0])),
        with_slope(series(&|k| 0.25 * rates[0][k] - found[k][1] - 0.25)),
        with_slope(series(&|k| 2.5 * found[k][2] - 0.5 * rates[1][k])),
        with_slope(series(&|k| 2.5 * found[k][3] - 0.5 * rates[2][k] + 0.5 * found[k][2])),
    ];
    let [(more, slope), (by_ratio, by_ratio_slope), (g, g_slope), (h, h_slope)] = &values;
    (Bundle::of([more, slope, g, h, g_slope, h_slope]), Bundle::of([by_ratio, by_ratio_slope]))
}

/// A contact from `start` to 1 by what its pressures do to it: −∫ [ln|x − y| + B/k₀ ln((x + y)/2)] at places x, for each
/// term of the pressure.
struct Shape {
    ratio: f64,
    start: f64,
    places: [f64; TERMS],
    influence: [[f64; TERMS]; TERMS],
}

/// A contact in half Hertzian widths.
#[derive(Clone, Copy)]
struct Contact {
    /// λ.
    place: f64,
    /// Ψ/k₀ − λ².
    above_corner: f64,
    /// How far from the corner it ends.
    end: f64,
    /// Where it starts over where it ends.
    start: f64,
    /// Of the pressure times the sine of the angle whose cosine is the place, times half the width: a cosine series.
    terms: [f64; TERMS],
}

impl Contact {
    /// The means of ξ, of ln((ξ + η)/2) and of ξ times that, under the pressures at ξ and η.
    fn means(&self, waves: &Waves) -> [f64; 3] {
        let (middle, half) = (0.5 * (1.0 + self.start), 0.5 * (1.0 - self.start));
        let places = waves.points.map(|waves| self.end * (middle + half * waves[1]));
        let part = |k: usize| self.terms.iter().zip(&waves.points[k]).map(|(term, wave)| term * wave).sum::<f64>();
        let parts: [f64; POINTS] = std::array::from_fn(|k| PI / POINTS as f64 * part(k));
        let mut means = [0.0; 3];
        for (x, on) in places.iter().zip(&parts) {
            let by = places.iter().zip(&parts).map(|(y, by)| by * libm::log(0.5 * (x + y))).sum::<f64>();
            for (mean, value) in means.iter_mut().zip([*x, by, x * by]) {
                *mean += on * value;
            }
        }
        means
    }
}

/// cos(nθ) for the terms n: at the angles of the places, term by term, and at those of the points, point by point.
struct Waves {
    places: [[f64; TERMS]; TERMS],
    points: [[f64; TERMS]; POINTS],
}

impl Waves {
    fn new() -> Self {
        let wave = |n: usize, k: usize, count: usize| libm::cos(PI * n as f64 * (k as f64 + 0.5) / count as f64);
        Self {
            places: std::array::from_fn(|n| std::array::from_fn(|k| wave(n, k, TERMS))),
            points: std::array::from_fn(|k| std::array::from_fn(|n| wave(n, k, POINTS))),
        }
    }
}

impl Shape {
    fn new(start: f64, ratio: f64, waves: &Waves) -> Self {
        let (middle, half) = (0.5 * (1.0 + start), 0.5 * (1.0 - start));
        let places = waves.places[1].map(|cosine| middle + half * cosine);
        let points = waves.points.map(|waves| middle + half * waves[1]);
        let weight = -ratio * PI / POINTS as f64;
        let influence = std::array::from_fn(|row| {
            let mut summed = [0.0; TERMS];
            for (y, waves) in points.iter().zip(&waves.points) {
                let part = weight * libm::log(0.5 * (places[row] + y));
                for (sum, wave) in summed.iter_mut().zip(waves) {
                    *sum += part * wave;
                }
            }
            std::array::from_fn(|n| {
                let own = if n == 0 { -PI * libm::log(0.5 * half) } else { PI / n as f64 * waves.places[n][row] };
                own + summed[n]
            })
        });
        Self { ratio, start, places, influence }
    }

    /// The contact that starts at the corner and ends at `end`, where the pressure is 0.
    fn ending_at(&self, end: f64) -> Contact {
        // Unknown: the terms, λ, Ψ/k₀ − λ².
        let mut rows = [[0.0; TERMS + 3]; TERMS + 2];
        let known = (1.0 + self.ratio) * libm::log(end);
        for (row, (x, influence)) in rows.iter_mut().zip(self.places.iter().zip(&self.influence)) {
            row[..TERMS].copy_from_slice(influence);
            (row[TERMS], row[TERMS + 1]) = (-2.0 * end * x, -1.0);
            row[TERMS + 2] = known - end * end * x * x;
        }
        (rows[TERMS][0], rows[TERMS][TERMS + 2]) = (PI, 1.0);
        rows[TERMS + 1][..TERMS].fill(1.0);
        solve(&mut rows);
        Contact {
            place: rows[TERMS][TERMS + 2],
            above_corner: rows[TERMS + 1][TERMS + 2],
            end,
            start: self.start,
            terms: std::array::from_fn(|n| rows[n][TERMS + 2]),
        }
    }

    /// The contact of this shape at both ends of which the pressure is 0.
    fn inside(&self) -> Contact {
        // Unknown: the terms, the square of the end, λ times the end, Ψ/k₀ − λ² + (1 + B/k₀) ln(end).
        let mut rows = [[0.0; TERMS + 4]; TERMS + 3];
        for (row, (x, influence)) in rows.iter_mut().zip(self.places.iter().zip(&self.influence)) {
            row[..TERMS].copy_from_slice(influence);
            (row[TERMS], row[TERMS + 1], row[TERMS + 2]) = (x * x, -2.0 * x, -1.0);
        }
        (rows[TERMS][0], rows[TERMS][TERMS + 3]) = (PI, 1.0);
        rows[TERMS + 1][..TERMS].fill(1.0);
        for (n, value) in rows[TERMS + 2][..TERMS].iter_mut().enumerate() {
            *value = if n % 2 == 0 { 1.0 } else { -1.0 };
        }
        solve(&mut rows);
        let [square, product, sum] = [0, 1, 2].map(|k| rows[TERMS + k][TERMS + 3]);
        let end = square.sqrt();
        Contact {
            place: product / end,
            above_corner: sum - (1.0 + self.ratio) * libm::log(end),
            end,
            start: self.start,
            terms: std::array::from_fn(|n| rows[n][TERMS + 3]),
        }
    }
}

#[cfg(test)]
mod tests;
