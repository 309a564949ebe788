//! A fit from several starts: where each ends, which ends are one, and what is to be said of them.
//!
//! Must not know: what parameters and residuals are of.

use declare::error::Failure;
use declare::seed::Seed;
use gearmesh::numeric::student;
use gearmesh::optimize::by_number::LatinHypercube;
use gearmesh::optimize::least_squares::derivative::noise;
use gearmesh::optimize::least_squares::uncertainty::Uncertainty;
use gearmesh::optimize::least_squares::{End, Evaluate, Fit, Search};

/// Ends are one when the way between them changes no residual by more than this, in tolerances, or this share of the largest.
const ALIKE: f64 = 0.1;
/// A residual of exactly one tolerance is within it, whichever way its last bit was rounded.
const EDGE: f64 = 1.0 + 1e-9;
/// Share of the interval that stands beside a value.
const INTERVAL: f64 = 0.95;

/// Ends of searches that are one.
pub struct Solution {
    pub fit: Fit,
    /// How many starts led to it.
    pub starts: usize,
}

impl Solution {
    /// The largest residual, in tolerances.
    pub fn largest(&self) -> f64 {
        self.fit.residuals.iter().fold(0.0, |largest, residual| largest.max(residual.abs()))
    }

    /// Whether every residual is within its tolerance.
    pub fn meets(&self) -> bool {
        self.largest() <= EDGE
    }

    pub fn is_settled(&self) -> bool {
        self.fit.end == End::Settled
    }

    /// Whether inputs that a stage refuses ended the search.
    pub fn is_at_edge(&self) -> bool {
        self.fit.beyond.is_some()
    }

    /// √(Σr²/freedom), in tolerances; NaN where there are no more residuals than parameters.
    pub fn scatter(&self) -> f64 {
        let freedom = self.fit.freedom();
        if freedom == 0 { f64::NAN } else { (self.fit.sum_of_squares / freedom as f64).sqrt() }
    }

    /// By parameter the standard deviation: of tolerances, or of what is left where that is more.
    pub fn deviations(&self, uncertainty: &Uncertainty) -> Vec<f64> {
        uncertainty.deviations(self.scatter().max(1.0)).collect()
    }

    /// How many standard deviations to either side the interval goes.
    pub fn reach(&self) -> f64 {
        student::half_width(INTERVAL, (self.scatter() > 1.0).then(|| self.fit.freedom()))
    }
}

/// What came of all starts.
pub struct Found {
    /// The best first.
    pub solutions: Vec<Solution>,
    /// Starts at which the model had no numbers.
    pub without: usize,
}

impl Found {
    /// How many different solutions meet all that is to be met. Searches that were stopped short of a least one may be on the way to
    /// the same: together they are one, where no other is known.
    pub fn meeting(&self) -> usize {
        let meeting = || self.solutions.iter().filter(|solution| solution.meets());
        let settled = meeting().filter(|solution| solution.is_settled()).count();
        settled.max(usize::from(meeting().next().is_some()))
    }
}

/// The starts: the values of the study, where they are in the box, and a point in each of as many strata of every parameter.
pub fn starts(own: Option<Vec<f64>>, bounds: &[(f64, f64)], count: usize, seed: &Seed) -> Vec<Vec<f64>> {
    let drawn = count - usize::from(own.is_some());
    let hypercube = LatinHypercube::new(drawn, bounds.len(), seed);
    let point = |index: usize| {
        let mut shares = vec![0.0; bounds.len()];
        hypercube.point(index, &mut shares);
        shares.iter().zip(bounds).map(|(share, (low, high))| low + share * (high - low)).collect()
    };
    own.into_iter().chain((0..drawn).map(point)).collect()
}

fn is_flat(fit: &Fit) -> bool {
    Uncertainty::of(fit).flat.is_some()
}

/// A step is the last that would move no parameter by more than 1e-4 of its standard deviation.
const GAIN: f64 = 1e-8;

/// Searches from each start.
///
/// # Errors
/// What `evaluate` says.
pub fn from_all(
    (bounds, steps): (&[(f64, f64)], usize),
    starts: &[Vec<f64>],
    evaluate: Evaluate<Failure>,
    progress: &dyn Fn(f64),
) -> Result<Found, Failure> {
    let mut found = Found { solutions: Vec::new(), without: 0 };
    let mut search = Search { bounds: bounds.to_vec(), steps, gain: GAIN, noise: f64::NAN };
    let scales: Vec<f64> = bounds.iter().map(|(low, high)| high - low).collect();
    for (number, start) in starts.iter().enumerate() {
        if search.noise.is_nan() {
            // It is about the same everywhere.
            search.noise = noise(bounds, start, evaluate)?.unwrap_or(f64::NAN);
        }
        match search.from(start, evaluate)? {
            None => found.without += 1,
            Some(fit) => {
                let same = found.solutions.iter_mut().find(|other| {
                    let alike = ALIKE * other.largest().max(1.0);
                    // On a valley in which nothing changes ends may be far apart, and the way between them may be bent.
                    let are_flat = || is_flat(&other.fit) && is_flat(&fit);
                    other.fit.is_as(&fit, alike, &scales) || (other.fit.apart(&fit) <= alike && are_flat())
                });
                match same {
                    Some(other) => {
                        other.starts += 1;
                        if fit.sum_of_squares < other.fit.sum_of_squares {
                            other.fit = fit;
                        }
                    }
                    None => found.solutions.push(Solution { fit, starts: 1 }),
                }
            }
        }
        progress((number + 1) as f64 / starts.len() as f64);
    }
    // Those that come out alike stay in the order of their starts.
    found.solutions.sort_by(|one, two| one.fit.sum_of_squares.total_cmp(&two.fit.sum_of_squares));
    Ok(found)
}
