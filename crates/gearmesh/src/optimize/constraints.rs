//! Constraints, for every method alike: an objective says by how much each is broken, and two rules make of it the one
//! number that a method sees.
//!
//! *Feasible first* (Deb, Comput. Methods Appl. Mech. Eng. 186 (2000) 311, section 3) for methods that compare points of
//! a population or a sample: any point that keeps the constraints is lower than any that breaks one; of two that break
//! some, the one that breaks less is lower. Nothing is to be tuned, and no number of the objective enters.
//!
//! *Augmented Lagrangian* (Powell in Fletcher, Optimization, 1969, 283; Rockafellar, Math. Programming 5 (1973) 354) for
//! local searches: they go along a constraint only where the function is smooth across it. Under feasible-first or an
//! exact penalty it has a cliff or a kink there, on which line searches along fixed directions stop, far from the
//! minimum. Here rounds of the search minimise f + μ/2 Σ [max(0, λ/μ − g)² − (λ/μ)²] under g ≥ 0, each with better multipliers λ; its
//! minimum is that of the constrained problem at a finite μ. A kink of f itself is left to `restarts.rs`.
//!
//! Must not know: which method runs.

/// How much of a constraint may be broken by a point that counts as keeping it. A local search places a minimum to the
/// root of the rounding error, so less could not be asked of a point on a constraint.
pub const KEPT: f64 = 1e-7;

/// What an objective says of a point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Evaluation {
    /// To be small; NaN or +∞ where there is no value.
    pub value: f64,
    /// What else is to be small, where there are several objectives; as many for every point.
    pub further: Vec<f64>,
    /// Each kept where it is not negative, and of the order of −1 where it is clearly broken: lengths as shares of a
    /// length. As many for every point. An equation is two constraints, of both signs.
    pub constraints: Vec<f64>,
}

impl From<f64> for Evaluation {
    fn from(value: f64) -> Self {
        Self { value, ..Self::default() }
    }
}

impl Evaluation {
    /// All that is to be small.
    pub fn objectives(&self) -> impl Iterator<Item = f64> + '_ {
        std::iter::once(self.value).chain(self.further.iter().copied())
    }

    /// Without a value, or with a constraint that is not a number, a point is inadmissible.
    pub(super) fn admissible(&self) -> bool {
        self.objectives().all(|value| value < f64::INFINITY)
            && self.constraints.iter().all(|constraint| constraint.is_finite())
    }

    /// The sum of what is broken; 0 where all constraints are kept.
    #[must_use]
    pub fn violation(&self) -> f64 {
        self.constraints
            .iter()
            .map(|constraint| -constraint)
            .filter(|broken| *broken > KEPT)
            .fold(0.0, |sum, broken| sum + broken)
    }
}

/// Above every value of an objective.
const BROKEN: f64 = 1e300;

/// The value of a point that keeps all constraints, and above all these the order of what is broken.
pub(super) fn feasible_first(evaluation: &Evaluation) -> f64 {
    match evaluation.violation() {
        _ if evaluation.constraints.is_empty() => evaluation.value,
        0.0 => evaluation.value.min(BROKEN),
        broken => (BROKEN * (1.0 + broken)).min(f64::MAX),
    }
}

/// Growth of μ after a round that did not bring the point near enough to the constraints.
const GROWTH: f64 = 10.0;

/// The share of the last round's error above which μ grows.
const SLOW: f64 = 0.25;

const MOST_ROUNDS: usize = 40;

/// The state of the augmented Lagrangian.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Multipliers {
    /// λ, one per constraint, ≥ 0.
    weights: Vec<f64>,
    /// μ.
    penalty: f64,
    error: f64,
    rounds: usize,
}

impl Multipliers {
    /// `first` is the first point's evaluation: μ is of the objective's size, whatever its unit.
    pub(super) fn new(first: &Evaluation) -> Self {
        let size = if first.value == 0.0 || !first.value.is_finite() { 1.0 } else { first.value.abs() };
        Self { weights: vec![0.0; first.constraints.len()], penalty: GROWTH * size, error: f64::INFINITY, rounds: 0 }
    }

    pub(super) fn merit(&self, evaluation: &Evaluation) -> f64 {
        let term = |(weight, constraint): (&f64, &f64)| {
            let share = weight / self.penalty;
            let broken = (share - constraint).max(0.0);
            0.5 * self.penalty * (broken * broken - share * share)
        };
        evaluation.value + self.weights.iter().zip(&evaluation.constraints).map(term).sum::<f64>()
    }

    /// Learns from the minimum of a round; whether there is to be another one.
    pub(super) fn improve(&mut self, minimum: &Evaluation) -> bool {
        let pairs = || self.weights.iter().zip(&minimum.constraints);
        // Zero where each constraint is kept, and exactly met if its multiplier is not zero.
        let error = pairs().map(|(weight, constraint)| constraint.min(weight / self.penalty).abs()).fold(0.0, f64::max);
        self.weights = pairs().map(|(weight, constraint)| (weight - self.penalty * constraint).max(0.0)).collect();
        if error > SLOW * self.error {
            self.penalty *= GROWTH;
        }
        self.error = error;
        self.rounds += 1;
        error > 0.1 * KEPT && self.rounds < MOST_ROUNDS
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn evaluation(value: f64, constraints: &[f64]) -> Evaluation {
        Evaluation { value, constraints: constraints.to_vec(), ..Evaluation::default() }
    }

    #[test]
    fn feasible_points_come_first_and_then_those_that_break_less() {
        let order = [
            evaluation(-5.0, &[1.0, -0.5 * KEPT]),
            evaluation(7.0, &[0.0, 3.0]),
            evaluation(1e299, &[1.0, 1.0]),
            evaluation(-1e9, &[-2.0 * KEPT, 1.0]),
            evaluation(0.0, &[-0.1, -0.1]),
            evaluation(-1.0, &[-0.3, 8.0]),
            evaluation(-1.0, &[-1e9, 0.0]),
        ];
        assert!(order.windows(2).all(|pair| feasible_first(&pair[0]) < feasible_first(&pair[1])));
        assert_eq!(feasible_first(&order[0]).to_bits(), (-5.0_f64).to_bits());
    }

    #[test]
    fn the_multiplier_of_a_line_is_its_slope() {
        // Least x² with x ≥ 1: λ = 2. Each round's minimum is known: 2x = λ + μ(1 − x).
        let mut multipliers = Multipliers::new(&evaluation(0.25, &[-0.5]));
        loop {
            let (weight, penalty) = (multipliers.weights[0], multipliers.penalty);
            let x = (weight + penalty) / (2.0 + penalty);
            let at = |x: f64| multipliers.merit(&evaluation(x * x, &[x - 1.0]));
            assert!(at(x) < at(x + 1e-3) && at(x) < at(x - 1e-3));
            if !multipliers.improve(&evaluation(x * x, &[x - 1.0])) {
                assert!((x - 1.0).abs() < KEPT && (multipliers.weights[0] - 2.0).abs() < 1e-6);
                break;
            }
        }
        assert!(multipliers.rounds < 10 && multipliers.penalty < 1e4, "{multipliers:?}");
    }

    /// Nothing is known of an objective's size where it is zero or no number at first: the penalty is that of 1.
    #[test]
    fn a_first_value_without_a_size_gives_the_penalty_of_one() {
        let penalty = |value| {
            Multipliers::new(&evaluation(value, &[-0.5])).penalty / Multipliers::new(&evaluation(1.0, &[-0.5])).penalty
        };
        assert!([0.0, -0.0, f64::INFINITY, f64::NAN].iter().all(|value| (penalty(*value) - 1.0).abs() < 1e-15));
        assert!((penalty(-4e-6) - 4e-6).abs() < 1e-20);
    }
}
