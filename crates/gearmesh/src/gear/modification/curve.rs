//! How a relief grows from its start to its end: a curve from (0, 0) to (1, 1).
//!
//! Parabolic: 0.44 t + 0.56 t², from the article `energy_ga`. Must not know: which flank, which direction.

use declare::Tagged;

/// How the depth grows over the relief, with t from 0 at its start to 1 at its end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Tagged)]
#[declared(default = "linear")]
pub enum Curve {
    /// t
    #[default]
    Linear,
    /// 0.44 t + 0.56 t²
    Parabolic,
    /// t^n, n given as `exponent`
    Power {
        /// n of the curve `power`: 1 is linear, 2 has no kink at the start.
        #[declared(minimum = 0.5, maximum = 10.0, range, example = "2")]
        exponent: f64,
    },
}

impl Curve {
    pub(crate) fn growth(self) -> Growth {
        match self {
            // Whole exponents that are quadratics keep the closed forms.
            Self::Linear | Self::Power { exponent: 1.0 } => Growth::Quadratic { linear: 1.0 },
            Self::Parabolic => Growth::Quadratic { linear: 0.44 },
            Self::Power { exponent: 2.0 } => Growth::Quadratic { linear: 0.0 },
            Self::Power { exponent } => Growth::Power { exponent },
        }
    }
}

/// A curve as it is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Growth {
    /// a t + (1 − a) t².
    Quadratic { linear: f64 },
    /// t^n.
    Power { exponent: f64 },
}

impl Growth {
    /// a and 1 − a on the unit interval, of a quadratic.
    #[must_use]
    pub(crate) fn quadratic(self) -> Option<[f64; 2]> {
        match self {
            Self::Quadratic { linear } => Some([linear, 1.0 - linear]),
            Self::Power { .. } => None,
        }
    }

    /// The value at t, 0 below and 1 above the unit interval.
    #[must_use]
    pub(crate) fn value(self, t: f64) -> f64 {
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

impl Growth {
    /// The value at t on the unit interval, and the first and second derivative there; at 0 they may be without bound.
    #[must_use]
    pub(crate) fn rates(self, t: f64) -> [f64; 3] {
        match self {
            Self::Quadratic { linear } => [self.value(t), linear + 2.0 * (1.0 - linear) * t, 2.0 * (1.0 - linear)],
            Self::Power { exponent } => [
                self.value(t),
                exponent * libm::pow(t, exponent - 1.0),
                exponent * (exponent - 1.0) * libm::pow(t, exponent - 2.0),
            ],
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
            Curve::Linear,
            Curve::Parabolic,
            Curve::Power { exponent: 1.5 },
            Curve::Power { exponent: 2.0 },
            Curve::Power { exponent: 4.0 },
        ]
        .map(Curve::growth);
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
