//! How a contact near the corner of a wedge spreads: its largest pressure, its width, and where that pressure is.
//!
//! What is softer towards the corner moves the pressure away from it. Far inside, by what the wedge adds to second order in
//! 1/λ, the contact is that of a parabola bent 1 + B/(8 k₀ λ²) times as much, whose top is B/(4 k₀ λ) farther from the corner.
//! Where the contact reaches the corner the pressure is infinite there. Must not know: gears, loads.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, PI};

use super::{BEYOND, Contact, FAR, TERMS};
use crate::numeric::chebyshev::{Series, nodes};
use crate::numeric::extremum::maximum;

/// How a contact spreads, against that of half planes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// The largest pressure over Hertz'; where the contact reaches the corner, what it is where it just does so.
    pub pressure: f64,
    /// Half the width of the contact, in half Hertzian widths.
    pub half_width: f64,
    /// How much farther from the corner than λ the largest pressure is, in half Hertzian widths.
    pub farther: f64,
    /// Whether it reaches the corner.
    pub reaches: bool,
}

/// Of a wedge, against λ.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Spreads {
    /// Half widths; in the first table, over ln(−λ), times −λ.
    widths: [Series; 5],
    /// Of the tables where the contact does not reach the corner: pressures and their places.
    tops: [[Series; 2]; 2],
    /// Pressure where it just does.
    reached: f64,
    /// What of the last table is left beyond it: pressure and width times λ², place times λ.
    rests: [f64; 3],
    /// Half width at the end of the first table, times −λ.
    narrow: f64,
}

impl Spreads {
    /// `contacts`: those at the nodes of the `ranges`, which are of λ, or of ln(−λ) in the first.
    pub(super) fn new(ranges: &[[f64; 2]; 5], contacts: &[Vec<Contact>; 5], reached: &Contact) -> Self {
        let series = |table: usize, of: &dyn Fn(&Contact) -> f64| {
            let values: Vec<f64> = contacts[table].iter().map(of).collect();
            Series::from_values(ranges[table][0], ranges[table][1], &values)
        };
        let widths = std::array::from_fn(|table| {
            let scale = |contact: &Contact| if table == 0 { -contact.place } else { 1.0 };
            series(table, &|contact| contact.half_width() * scale(contact))
        });
        let tops = [3, 4].map(|table| {
            let places = nodes(ranges[table][0], ranges[table][1], contacts[table].len());
            let tops: Vec<[f64; 2]> =
                contacts[table].iter().zip(places).map(|(contact, place)| contact.top(place)).collect();
            [0, 1].map(|of| {
                let values: Vec<f64> = tops.iter().map(|top| top[of]).collect();
                Series::from_values(ranges[table][0], ranges[table][1], &values)
            })
        });
        let [pressure, place] = tops[1].each_ref().map(|series| series.value(FAR));
        let width = widths[4].value(FAR);
        let rests = [(pressure - 1.0) * FAR * FAR, (width - 1.0) * FAR * FAR, place * FAR];
        let narrow = widths[0].value(ranges[0][1]);
        Self { widths, tops, reached: reached.top(reached.place)[0], rests, narrow }
    }

    /// At λ, which is in this table or beyond its end.
    pub(super) fn at(&self, table: usize, place: f64) -> Spread {
        if place > FAR {
            let [pressure, width, farther] = self.rests;
            let square = place * place;
            return Spread {
                pressure: 1.0 + pressure / square,
                half_width: 1.0 + width / square,
                farther: farther / place,
                reaches: false,
            };
        }
        if let Some([pressure, farther]) = table.checked_sub(3).map(|of| &self.tops[of]) {
            return Spread {
                pressure: pressure.value(place),
                half_width: self.widths[table].value(place),
                farther: farther.value(place),
                reaches: false,
            };
        }
        let half_width = match table {
            0 if place < BEYOND => self.narrow / -place,
            0 => self.widths[0].value(libm::log(-place)) / -place,
            _ => self.widths[table].value(place),
        };
        Spread { pressure: self.reached, half_width, farther: -place, reaches: true }
    }
}

impl Contact {
    fn half_width(&self) -> f64 {
        0.5 * self.end * (1.0 - self.start)
    }

    /// The largest pressure over Hertz', 2/π, and how much farther from the corner than the parabola's top it is. The
    /// pressure is 0 at both ends, so that its cosine series is the sine times a sine series.
    fn top(&self, place: f64) -> [f64; 2] {
        let mut sines = [0.0; TERMS];
        for k in 0..TERMS - 2 {
            // That of sin (k + 1)θ: cosines of order k are half the difference of the sines before and after.
            sines[k] = 2.0 * self.terms[k] + if k >= 2 { sines[k - 2] } else { 0.0 };
        }
        let pressure = |angle: f64| {
            let sum = (1..).zip(&sines).map(|(order, sine)| sine * libm::sin(f64::from(order) * angle));
            sum.sum::<f64>() / (FRAC_2_PI * self.half_width())
        };
        let (angle, largest) = maximum(pressure, 0.0, FRAC_PI_2, PI, 1e-7);
        [largest, self.end - self.half_width() * (1.0 - libm::cos(angle)) - place]
    }
}
