//! Counting numbers that come one by one: moments, steps, quantiles, groups of values, reasons alike.
//!
//! Must not know: what is counted.

/// Steps between the extremes of an output.
pub const BINS: usize = 1024;
/// Strata of a field that has no few values of its own: of few rows fewer, so that two fields' strata share some of them.
const FEWEST_STRATA: usize = 4;
const MOST_STRATA: usize = 20;
/// Rows that a cell of two fields' strata has on average, unless there are too many or too few of them.
const ROWS_OF_CELL: usize = 4;

/// In how many strata so many rows are looked at.
pub fn strata(rows: usize) -> usize {
    (rows / ROWS_OF_CELL).isqrt().clamp(FEWEST_STRATA, MOST_STRATA)
}

/// Values of a field that are looked at together.
#[derive(Clone, Debug)]
pub enum Group {
    /// Each by itself, ascending.
    Each(Vec<f64>),
    /// So many equal strata.
    Strata { low: f64, high: f64, count: usize },
}

impl Group {
    pub fn len(&self) -> usize {
        match self {
            Self::Each(values) => values.len(),
            Self::Strata { count, .. } => *count,
        }
    }

    /// Which of them a value is in.
    pub fn at(&self, value: f64) -> usize {
        match self {
            Self::Each(values) => values.partition_point(|other| other.total_cmp(&value).is_lt()).min(values.len() - 1),
            Self::Strata { low, high, count } => bin(value, *low, *high, *count),
        }
    }

    /// What stands for one of them: its value, or the middle of its stratum.
    pub fn value(&self, at: usize) -> f64 {
        match self {
            Self::Each(values) => values[at],
            Self::Strata { low, high, count } => low + (high - low) * (at as f64 + 0.5) / *count as f64,
        }
    }
}

/// Which of so many equal steps from `low` to `high` a value is in.
pub fn bin(value: f64, low: f64, high: f64, bins: usize) -> usize {
    let share = (value - low) / (high - low) * bins as f64;
    // A number of bins, or below 0, or NaN where there is but one value.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let at = share as usize;
    at.min(bins - 1)
}

/// Count, mean and squared deviations of numbers that come one by one (Welford, Technometrics 4 (1962) 419).
#[derive(Clone, Copy, Debug)]
pub struct Moments {
    pub count: u64,
    pub mean: f64,
    pub squares: f64,
    pub low: f64,
    pub high: f64,
}

impl Default for Moments {
    fn default() -> Self {
        Self { count: 0, mean: 0.0, squares: 0.0, low: f64::INFINITY, high: f64::NEG_INFINITY }
    }
}

impl Moments {
    pub fn add(&mut self, value: f64) {
        self.count += 1;
        let off = value - self.mean;
        self.mean += off / self.count as f64;
        self.squares += off * (value - self.mean);
        self.low = self.low.min(value);
        self.high = self.high.max(value);
    }
}

/// The reason with `…` in the place of every number, so that those alike are counted together.
pub fn without_numbers(reason: &str) -> String {
    let mut kept = String::with_capacity(reason.len());
    let mut characters = reason.chars().peekable();
    let mut in_word = false;
    while let Some(c) = characters.next() {
        if c.is_ascii_digit() && !in_word {
            while characters.next_if(|next| next.is_ascii_alphanumeric() || matches!(next, '.' | '-' | '+')).is_some() {
            }
            kept.push('…');
            continue;
        }
        in_word = c.is_alphanumeric() || c == '_';
        kept.push(c);
    }
    kept
}

/// Where a share of the numbers lies below, between the extremes, from counts in equal steps.
pub fn quantile(counts: &[u64], moments: &Moments, share: f64) -> f64 {
    let Moments { low, high, count, .. } = *moments;
    if share <= 0.0 || high <= low {
        return low;
    }
    let (wanted, width) = (share * count as f64, (high - low) / counts.len() as f64);
    let mut below = 0.0;
    for (at, here) in counts.iter().enumerate() {
        let here = *here as f64;
        if below + here >= wanted && here > 0.0 {
            return (low + width * (at as f64 + (wanted - below) / here)).min(high);
        }
        below += here;
    }
    high
}

#[cfg(test)]
#[allow(clippy::float_cmp)] // what must be met exactly
mod tests {
    use super::*;

    #[test]
    fn moments_are_those_of_their_formulas() {
        let values = [3.0, -1.0, 4.5, 4.5, 0.25];
        let mut moments = Moments::default();
        for value in &values {
            moments.add(*value);
        }
        let mean = values.iter().sum::<f64>() / 5.0;
        let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
        assert!((moments.mean - mean).abs() < 1e-15 && (moments.squares - squares).abs() < 1e-13);
        assert!((moments.low, moments.high, moments.count) == (-1.0, 4.5, 5));
    }

    /// Tier: closed form; of evenly spread numbers the quantile is the share.
    #[test]
    fn quantiles_are_right_to_a_step() {
        let mut moments = Moments::default();
        let values: Vec<f64> = (0..=10_000).map(|at| f64::from(at) * 1e-4).collect();
        for value in &values {
            moments.add(*value);
        }
        let mut counts = vec![0; BINS];
        for value in &values {
            counts[bin(*value, 0.0, 1.0, BINS)] += 1;
        }
        for share in [0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0] {
            assert!((quantile(&counts, &moments, share) - share).abs() <= 1.0 / BINS as f64, "{share}");
        }
        let mut one = Moments::default();
        one.add(7.0);
        assert!(quantile(&[1], &one, 0.5) == 7.0 && bin(7.0, 7.0, 7.0, BINS) == 0);
    }

    #[test]
    fn reasons_alike_but_for_numbers_are_one() {
        let one = without_numbers("tip_relief: 5.05 mm is longer than 1.2e-3 m (iso6336, T1)");
        assert_eq!(one, "tip_relief: … mm is longer than … m (iso6336, T1)");
        assert_eq!(one, without_numbers("tip_relief: 5 mm is longer than 12 m (iso6336, T1)"));
    }

    #[test]
    fn groups_find_their_values_and_strata() {
        let each = Group::Each(vec![1.0, 2.5, 7.0]);
        assert_eq!([1.0, 2.5, 7.0].map(|value| each.at(value)), [0, 1, 2]);
        let strata = Group::Strata { low: 0.0, high: 10.0, count: 20 };
        assert_eq!([0.0, 0.49, 0.5, 9.99, 10.0].map(|value| strata.at(value)), [0, 0, 1, 19, 19]);
        assert!((strata.value(1) - 0.75).abs() < 1e-15);
        assert_eq!([0, 32, 64, 100, 400, 1600, 1_000_000].map(super::strata), [4, 4, 4, 5, 10, 20, 20]);
    }
}
