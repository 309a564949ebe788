//! Distributions of one number, by the value below which a share of it lies.
//!
//! Must not know: where shares come from, what the number is.

use super::normal;

/// How a number is distributed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Distribution {
    /// All values alike.
    Uniform {
        /// The smallest.
        low: f64,
        /// The largest, above it.
        high: f64,
    },
    /// Rising in a straight line to a mode, and falling.
    Triangular {
        /// The smallest.
        low: f64,
        /// The most frequent, from `low` to `high`.
        mode: f64,
        /// The largest, above `low`.
        high: f64,
    },
    /// Normal, and cut off.
    Normal {
        /// Before it is cut off.
        mean: f64,
        /// Standard deviation before it is cut off, above 0.
        deviation: f64,
        /// The smallest, or −∞.
        low: f64,
        /// The largest, or ∞; above `low`.
        high: f64,
    },
}

impl Distribution {
    /// The value below which a share of 0 to 1 lies; of an endless distribution infinite for 0 or 1.
    #[must_use]
    pub fn quantile(&self, share: f64) -> f64 {
        match *self {
            Self::Uniform { low, high } => (low * (1.0 - share) + high * share).clamp(low, high),
            Self::Triangular { low, mode, high } => {
                let width = high - low;
                let value = if share * width <= mode - low {
                    low + (share * width * (mode - low)).sqrt()
                } else {
                    high - ((1.0 - share) * width * (high - mode)).sqrt()
                };
                value.clamp(low, high)
            }
            Self::Normal { mean, deviation, low, high } => {
                let [from, to] = [low, high].map(|end| (end - mean) / deviation);
                // Seen from the side on which shares are small, where they have all their digits.
                let standard = if from > 0.0 {
                    let (least, most) = (normal::below(-to), normal::below(-from));
                    -normal::quantile(least * share + most * (1.0 - share))
                } else {
                    let (least, most) = (normal::below(from), normal::below(to));
                    normal::quantile(least * (1.0 - share) + most * share)
                };
                (mean + deviation * standard).clamp(low, high)
            }
        }
    }

    /// Between which values it lies; infinite where it has no end.
    #[must_use]
    pub fn range(&self) -> (f64, f64) {
        match *self {
            Self::Uniform { low, high } | Self::Triangular { low, high, .. } | Self::Normal { low, high, .. } => {
                (low, high)
            }
        }
    }

    /// What part of a normal distribution lies between its ends, before it is cut off; 1 of others.
    #[must_use]
    pub fn kept(&self) -> f64 {
        let Self::Normal { mean, deviation, low, high } = *self else { return 1.0 };
        let [from, to] = [low, high].map(|end| (end - mean) / deviation);
        if from > 0.0 { normal::below(-from) - normal::below(-to) } else { normal::below(to) - normal::below(from) }
    }

    /// Mean and standard deviation, as it is cut off.
    #[must_use]
    pub fn moments(&self) -> (f64, f64) {
        match *self {
            Self::Uniform { low, high } => (0.5 * (low + high), (high - low) / 12_f64.sqrt()),
            Self::Triangular { low, mode, high } => {
                let [one, two, three] = [mode - low, high - mode, high - low];
                let mean = low + (one + three) / 3.0;
                (mean, ((one * one + two * two + one * two) / 18.0).sqrt())
            }
            Self::Normal { mean, deviation, low, high } => {
                // Johnson, Kotz, Balakrishnan, Continuous Univariate Distributions 1 (1994), 13.10.1.
                let [from, to] = [low, high].map(|end| (end - mean) / deviation);
                let density = |x: f64| libm::exp(-0.5 * x * x) / (2.0 * std::f64::consts::PI).sqrt();
                let weighted = |x: f64| if x.is_finite() { x * density(x) } else { 0.0 };
                let kept = self.kept();
                let shift = (density(from) - density(to)) / kept;
                let variance = 1.0 + (weighted(from) - weighted(to)) / kept - shift * shift;
                (mean + deviation * shift, deviation * variance.max(0.0).sqrt())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> [Distribution; 7] {
        let normal = |low: f64, high: f64| Distribution::Normal { mean: 2.0, deviation: 0.5, low, high };
        [
            Distribution::Uniform { low: -1.0, high: 3.0 },
            Distribution::Triangular { low: -1.0, mode: 0.5, high: 3.0 },
            Distribution::Triangular { low: -1.0, mode: -1.0, high: 3.0 },
            normal(f64::NEG_INFINITY, f64::INFINITY),
            normal(0.5, 3.5),
            normal(1.9, 2.0),
            // Far out on one side.
            normal(5.0, f64::INFINITY),
        ]
    }

    /// Tier: second method; the midpoint rule over shares gives the moments of the closed forms. Its error at endless ends falls
    /// as 1/n but for a logarithm.
    #[test]
    fn quantiles_have_the_moments_of_the_closed_forms() {
        for distribution in all() {
            let (mean, deviation) = distribution.moments();
            let count = 200_000;
            let values = || (0..count).map(|at| distribution.quantile((f64::from(at) + 0.5) / f64::from(count)));
            let found = values().sum::<f64>() / f64::from(count);
            let variance = values().map(|value| (value - found) * (value - found)).sum::<f64>() / f64::from(count);
            assert!((found - mean).abs() < 2e-5 * deviation, "{distribution:?}: {found} {mean}");
            assert!(
                (variance.sqrt() / deviation - 1.0).abs() < 2e-4,
                "{distribution:?}: {} {deviation}",
                variance.sqrt()
            );
        }
    }

    #[test]
    fn values_rise_with_their_share_from_end_to_end() {
        for distribution in all() {
            let (low, high) = distribution.range();
            let values: Vec<f64> = (0..=1000).map(|at| distribution.quantile(f64::from(at) / 1000.0)).collect();
            assert!(values.windows(2).all(|pair| pair[0] < pair[1]), "{distribution:?}");
            for (end, value) in [(low, values[0]), (high, values[1000])] {
                assert!(
                    (value - end).abs() <= 1e-12 * end.abs() || value.to_bits() == end.to_bits(),
                    "{distribution:?}"
                );
            }
        }
        let normal = Distribution::Normal { mean: 0.0, deviation: 1.0, low: -1.0, high: f64::INFINITY };
        assert!((normal.kept() - 0.841_344_746_068_542_9).abs() < 1e-15, "the share above minus one sigma");
    }
}
