//! How a relief grows from its start to its end: a curve from (0, 0) to (1, 1).
//!
//! Parabolic: 0.44 t + 0.56 t², from the article `energy_ga`. Must not know: which flank, which direction.

use declare::error::Diagnostic;
use declare::parameter::{Choice, Field};
use declare::record::Record;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Curve {
    /// a t + (1 − a) t².
    Quadratic { linear: f64 },
    /// t^n.
    Power { exponent: f64 },
}

pub const CURVE: Field = Field::choice(
    "curve",
    &[
        Choice { name: "linear", summary: "t" },
        Choice { name: "parabolic", summary: "0.44 t + 0.56 t²" },
        Choice { name: "power", summary: "t^n, n given as `exponent`" },
    ],
    "How the depth grows over the relief, with t from 0 at its start to 1 at its end.",
)
.default("linear");

pub const EXPONENT: Field =
    Field::number("exponent", 0.5, 10.0, "n of the curve `power`: 1 is linear, 2 has no kink at the start.")
        .range()
        .optional();

impl Curve {
    pub(crate) fn check(record: &Record) -> Result<(), Diagnostic> {
        let place = record.place_of(EXPONENT.name);
        match (record.choice(CURVE.name) == "power", record.entry(EXPONENT.name).is_some()) {
            (true, false) => Err(Diagnostic::new("the curve `power` needs its `exponent`").at(place)),
            (false, true) => Err(Diagnostic::new("`exponent` goes with `curve: power` only").at(place)),
            _ => Ok(()),
        }
    }

    pub(crate) fn read(record: &Record) -> Self {
        match record.choice(CURVE.name) {
            "parabolic" => Self::Quadratic { linear: 0.44 },
            "power" => Self::power(record.number(EXPONENT.name)),
            _ => Self::Quadratic { linear: 1.0 },
        }
    }

    fn power(exponent: f64) -> Self {
        // Whole exponents that are quadratics keep the closed forms.
        match exponent {
            1.0 => Self::Quadratic { linear: 1.0 },
            2.0 => Self::Quadratic { linear: 0.0 },
            _ => Self::Power { exponent },
        }
    }

    /// The value at t, 0 below and 1 above the unit interval.
    #[must_use]
    pub fn value(self, t: f64) -> f64 {
        if t <= 0.0 {
            return 0.0;
        }
        let t = t.min(1.0);
        match self {
            Self::Quadratic { linear } => t * (linear + (1.0 - linear) * t),
            Self::Power { exponent } => libm::pow(t, exponent),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[allow(clippy::float_cmp)] // the ends are exact
    fn curves_go_from_nothing_to_everything() {
        let curves = [
            Curve::Quadratic { linear: 1.0 },
            Curve::Quadratic { linear: 0.44 },
            Curve::power(1.5),
            Curve::power(2.0),
            Curve::power(4.0),
        ];
        for curve in curves {
            assert_eq!([curve.value(-1.0), curve.value(0.0), curve.value(1.0), curve.value(2.0)], [0.0, 0.0, 1.0, 1.0]);
            let values: Vec<f64> = (0..=100).map(|i| curve.value(f64::from(i) * 0.01)).collect();
            assert!(values.windows(2).all(|pair| pair[0] < pair[1]));
        }
        // The article's own numbers at half the length: 0.22 + 0.14.
        assert!((curves[1].value(0.5) - 0.36).abs() < 1e-15);
        assert!((curves[2].value(0.25) - 0.125).abs() < 1e-15);
        assert!((curves[3].value(0.3) - 0.09).abs() < 1e-15);
    }
}
