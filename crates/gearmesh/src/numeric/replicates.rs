//! Numbers of a sample and their own errors, from replicates: samples of one size that were drawn apart.
//!
//! Points of a sample may depend on each other, as those of a net or a Latin hypercube do; replicates do not. So how far a
//! number of each replicate lies from that of all says how far that of all lies from the truth, whatever the method: s/√R with
//! s² = Σ(q_r − q)²/(R − 1) ("sectioning": Asmussen and Glynn, Stochastic Simulation (2007), III.5; for quantiles Nakayama, ACM
//! TOMACS 24 (2014) 19). The error itself is right to 1/√(2(R − 1)). Must not know: how points are drawn.

/// How many replicates a sample is cut into: an error that is right to 27 %, and points enough in each of them.
pub const REPLICATES: usize = 8;

/// A number and its standard error; both NaN where there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The number itself.
    pub value: f64,
    /// Its standard error.
    pub error: f64,
}

impl Estimate {
    /// Of nothing.
    pub const NONE: Self = Self { value: f64::NAN, error: f64::NAN };

    /// That of all, and those of the replicates; those that have none do not count.
    #[must_use]
    pub fn new(value: f64, replicates: impl Iterator<Item = f64>) -> Self {
        let (mut sum, mut count) = (0.0, 0.0);
        for replicate in replicates.filter(|replicate| replicate.is_finite()) {
            sum += (replicate - value) * (replicate - value);
            count += 1.0;
        }
        let error = if count > 1.0 { (sum / (count - 1.0) / count).sqrt() } else { f64::NAN };
        Self { value, error }
    }
}

/// Numbers of a sample, those that there are, replicate by replicate.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Ascending.
    replicates: Vec<Vec<f64>>,
    /// Of all replicates, ascending.
    all: Vec<f64>,
}

impl Sample {
    /// Values in the order in which they were drawn, one from each replicate in turn; NaN is none.
    #[must_use]
    pub fn new(values: &[f64]) -> Self {
        let of = |first: usize, step: usize| {
            let mut own: Vec<f64> = values.iter().skip(first).step_by(step).copied().filter(|x| !x.is_nan()).collect();
            own.sort_by(f64::total_cmp);
            own
        };
        Self { replicates: (0..REPLICATES).map(|first| of(first, REPLICATES)).collect(), all: of(0, 1) }
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.all.len()
    }

    /// Smallest and largest; none where there are none.
    #[must_use]
    pub fn range(&self) -> Option<(f64, f64)> {
        Some((*self.all.first()?, *self.all.last()?))
    }

    fn estimate(&self, of: impl Fn(&[f64]) -> f64) -> Estimate {
        if self.all.is_empty() {
            return Estimate::NONE;
        }
        Estimate::new(of(&self.all), self.replicates.iter().filter(|own| !own.is_empty()).map(|own| of(own)))
    }

    /// The mean.
    #[must_use]
    pub fn mean(&self) -> Estimate {
        self.estimate(mean)
    }

    /// The standard deviation.
    #[must_use]
    pub fn deviation(&self) -> Estimate {
        self.estimate(|values| {
            let mean = mean(values);
            let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
            if values.len() > 1 { (squares / (values.len() - 1) as f64).sqrt() } else { f64::NAN }
        })
    }

    /// The value below which a share lies.
    #[must_use]
    pub fn quantile(&self, share: f64) -> Estimate {
        self.estimate(|values| quantile(values, share))
    }
}

fn mean(values: &[f64]) -> f64 {
    // About one of them: what they have in common costs no digits.
    let origin = values[values.len() / 2];
    origin + values.iter().map(|value| value - origin).sum::<f64>() / values.len() as f64
}

/// Of ascending values, not empty: in straight lines through (i − ½)/n, which is off by no more than 1/n² where the density
/// is smooth (Hyndman and Fan, The American Statistician 50 (1996) 361, definition 5).
#[must_use]
pub fn quantile(values: &[f64], share: f64) -> f64 {
    let place = (share * values.len() as f64 - 0.5).clamp(0.0, (values.len() - 1) as f64);
    // Below the number of values.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let below = place.floor() as usize;
    let next = (below + 1).min(values.len() - 1);
    let part = place - below as f64;
    values[below] * (1.0 - part) + values[next] * part
}

/// How many of all keep to something, with the standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Of all.
    pub share: Estimate,
    /// Above which value it lies with 97.5 %, by Wilson's interval (J. Am. Stat. Assoc. 22 (1927) 209), which says something
    /// where all keep to it, or none. It takes points as independent; those of nets are better than that.
    pub low: f64,
    /// Below which value it lies with 97.5 %.
    pub high: f64,
}

/// The share of those that are true, in the order in which they were drawn.
///
/// # Panics
/// When there are none.
#[must_use]
pub fn share(kept: &[bool]) -> Share {
    let of = |first: usize, step: usize| {
        let own = || kept.iter().skip(first).step_by(step);
        own().filter(|kept| **kept).count() as f64 / own().count() as f64
    };
    let share = Estimate::new(of(0, 1), (0..REPLICATES.min(kept.len())).map(|first| of(first, REPLICATES)));
    let (count, z) = (kept.len() as f64, super::normal::quantile(0.975));
    let (part, square) = (share.value, z * z / count);
    let middle = (part + 0.5 * square) / (1.0 + square);
    let half = z * (part * (1.0 - part) / count + 0.25 * square / count).sqrt() / (1.0 + square);
    Share { share, low: (middle - half).max(0.0), high: (middle + half).min(1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tier: worked by hand.
    #[test]
    fn numbers_of_a_sample_are_those_of_their_formulas() {
        // Replicate r has r and r + 10.
        let values: Vec<f64> = (0..16).map(|at| f64::from(at % 8) + if at < 8 { 0.0 } else { 10.0 }).collect();
        let sample = Sample::new(&values);
        let mean = sample.mean();
        assert!((mean.value - 8.5).abs() < 1e-14);
        // Means of replicates r + 5: deviations −3.5 … 3.5, squares 42, over 7 and 8.
        assert!((mean.error - (42.0_f64 / 56.0).sqrt()).abs() < 1e-14, "{}", mean.error);
        assert!((quantile(&[1.0, 2.0, 4.0, 8.0], 0.5) - 3.0).abs() < 1e-15);
        assert!((quantile(&[1.0, 2.0, 4.0, 8.0], 0.25) - 1.5).abs() < 1e-15);
        assert!((quantile(&[1.0, 2.0, 4.0, 8.0], 1.0) - 8.0).abs() < 1e-15);
        assert_eq!(sample.range(), Some((0.0, 17.0)));
        let none = Sample::new(&[f64::NAN; 9]);
        assert!(none.mean().value.is_nan() && none.count() == 0 && none.range().is_none());
    }

    /// Tier: published value; Wilson's interval of 0 of 10 goes to 0.2775, that of 5 of 10 from 0.2366 to 0.7634 (Newcombe,
    /// Statistics in Medicine 17 (1998) 857, method 3).
    #[test]
    fn a_share_has_an_interval_even_where_all_keep_to_it() {
        let none = share(&[false; 10]);
        assert!(none.share.value < 1e-15 && none.low < 1e-15 && (none.high - 0.2775).abs() < 5e-5, "{none:?}");
        let half: Vec<bool> = (0..10).map(|at| at < 5).collect();
        let half = share(&half);
        assert!((half.low - 0.2366).abs() < 5e-5 && (half.high - 0.7634).abs() < 5e-5, "{half:?}");
        assert!(share(&[true; 10]).high > 1.0 - 1e-15);
    }
}
