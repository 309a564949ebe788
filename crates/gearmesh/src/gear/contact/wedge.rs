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
//! λ follows, since everything else in the equation is linear. Must not know: gears, loads.

mod spread;

pub use spread::Spread;

use std::f64::consts::{FRAC_PI_2, LN_2, PI};

use self::spread::Spreads;
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

/// B E′: near a corner of the angle `interior`, > 0 and < 2π \[rad\], the surface yields by −B ln c more than that of a half
/// plane to a load on one of its sides, normal to it, at the distance c from the corner. 0 for a half plane.
#[must_use]
pub fn softening(interior: f64) -> f64 {
    let half = 0.5 * interior;
    // The load against the bisector.
    let (sine, cosine) = libm::sincos(FRAC_PI_2 - half);
    let shear = 0.5 * libm::sin(interior);
    cosine * cosine / (half + shear) + sine * sine / (half - shear) - 2.0 / PI
}

/// By how much a parabola approaches a wedge more than a half plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Wedge {
    /// B/k₀.
    ratio: f64,
    /// In order, each with its slope; the first one over ln(−λ).
    tables: [(Series, Series); 5],
    /// Times 1/λ² beyond [`FAR`].
    rest: f64,
    /// At [`BEYOND`].
    last: f64,
    /// How the contact spreads.
    spreads: Spreads,
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
        let value = |place: f64, found: &Contact| {
            found.above_corner + if place < 0.0 { 0.0 } else { place * place } - LN_2 - 0.5
        };
        let logs = [libm::log(-JOINTS[0]), libm::log(-BEYOND)];
        let ranges = [logs, [JOINTS[0], 0.0], [0.0, reached.place], [reached.place, JOINTS[1]], [JOINTS[1], FAR]];
        let places = |table: usize| {
            let arguments = nodes(ranges[table][0], ranges[table][1], NODES).into_iter();
            arguments.map(move |argument| if table == 0 { -libm::exp(argument) } else { argument })
        };
        let contacts: [Vec<Contact>; 5] = std::array::from_fn(|table| places(table).map(contact).collect());
        let tables: [(Series, Series); 5] = std::array::from_fn(|table| {
            let values: Vec<f64> =
                places(table).zip(&contacts[table]).map(|(place, found)| value(place, found)).collect();
            let values = Series::from_values(ranges[table][0], ranges[table][1], &values);
            let slopes = values.derivative();
            (values, slopes)
        });
        let spreads = Spreads::new(&ranges, &contacts, &reached);
        let rest = (tables[4].0.value(FAR) + ratio * libm::log(FAR)) * FAR * FAR;
        let last = tables[0].0.value(libm::log(-BEYOND));
        Self { ratio, tables, rest, last, spreads }
    }

    /// (Ψ − k₀ λ² where λ < 0)/k₀ − ln 2 − ½, and its slope over λ. Continuous; towards −B/k₀ ln λ far inside, and by
    /// (1 + B/k₀) ln|λ| larger and larger beyond the corner.
    #[must_use]
    pub fn more(&self, place: f64) -> [f64; 2] {
        if place > FAR {
            let square = self.rest / (place * place);
            return [square - self.ratio * libm::log(place), -(2.0 * square + self.ratio) / place];
        }
        if place < JOINTS[0] {
            let log = libm::log(-place);
            if place < BEYOND {
                let slope = 1.0 + self.ratio;
                return [self.last + slope * (log - libm::log(-BEYOND)), slope / place];
            }
            let (values, slopes) = &self.tables[0];
            return [values.value(log), slopes.value(log) / place];
        }
        let (values, slopes) = &self.tables[self.table(place)];
        [values.value(place), slopes.value(place)]
    }

    /// Which table λ is in, from the end of the first one to [`FAR`].
    fn table(&self, place: f64) -> usize {
        1 + self.tables[1..4].iter().position(|(values, _)| place <= values.upper()).unwrap_or(3)
    }

    /// How a contact with its top at λ spreads.
    #[must_use]
    pub fn spread(&self, place: f64) -> Spread {
        let table = if place < JOINTS[0] { 0 } else { self.table(place) };
        self.spreads.at(table, place)
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
    /// How far from it it starts, over that.
    start: f64,
    /// Of the pressure times the sine of the angle whose cosine is the place, times half the width: a cosine series.
    terms: [f64; TERMS],
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
        let terms = std::array::from_fn(|n| rows[n][TERMS + 2]);
        Contact {
            place: rows[TERMS][TERMS + 2],
            above_corner: rows[TERMS + 1][TERMS + 2],
            end,
            start: self.start,
            terms,
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
        let terms = std::array::from_fn(|n| rows[n][TERMS + 3]);
        let above_corner = sum - (1.0 + self.ratio) * libm::log(end);
        Contact { place: product / end, above_corner, end, start: self.start, terms }
    }
}

#[cfg(test)]
mod tests;
