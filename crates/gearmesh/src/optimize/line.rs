//! The minimum along a bounded line, asked for one place at a time: bracketing by growing steps, then Brent's golden
//! section with parabolic steps.
//!
//! Source: Brent, Algorithms for Minimization without Derivatives (1973), chapter 5; a bracket comes with three values, so
//! the first step is already parabolic. A minimum at an end of the line is met exactly. Lengths are those of the line's
//! parameter. Must not know: how many variables there are, what is minimised.

/// A place on the line and the value there.
type Met = (f64, f64);

/// 2 − golden ratio: the smaller part of a golden section.
const SECTION: f64 = 0.381_966_011_250_105_1;

/// How much a step grows while the values fall.
const GROWTH: f64 = 1.0 / SECTION;

enum Stage {
    /// One step forward from 0.
    Forward,
    /// One step backward, since the step forward led upwards to that place.
    Backward {
        ahead: Option<Met>,
    },
    /// Falling: from the first place to the best one.
    Falling {
        previous: Met,
    },
    /// The lowest value is that of an end of the line; is it lower than just before?
    End {
        previous: Met,
    },
    Closing(Bracket),
    Done,
}

/// Brent's state: the minimum lies in `lower..upper`.
struct Bracket {
    lower: f64,
    upper: f64,
    second: Met,
    third: Met,
    step: f64,
    before: f64,
}

/// A search along one line that has begun at its place 0.
pub(super) struct Line {
    minimum: f64,
    maximum: f64,
    tolerance: f64,
    step: f64,
    best: Met,
    stage: Stage,
    asked: f64,
}

impl Line {
    /// From 0, where the value is `value`, within `minimum..=maximum` (which holds 0), first by `step` > 0; the place of the
    /// minimum is found to `tolerance` > 0.
    pub(super) fn new(value: f64, (minimum, maximum): (f64, f64), step: f64, tolerance: f64) -> Self {
        let best = (0.0, value);
        let mut line = Self { minimum, maximum, tolerance, step, best, stage: Stage::Done, asked: 0.0 };
        if maximum > tolerance {
            line.ask(Stage::Forward, step.min(maximum));
        } else {
            line.backward(None);
        }
        line
    }

    /// The next place to evaluate; none when the search has ended.
    pub(super) fn place(&self) -> Option<f64> {
        (!matches!(self.stage, Stage::Done)).then_some(self.asked)
    }

    /// The place with the lowest value, and that value.
    pub(super) fn best(&self) -> Met {
        self.best
    }

    fn ask(&mut self, stage: Stage, place: f64) {
        (self.stage, self.asked) = (stage, place);
    }

    fn backward(&mut self, ahead: Option<Met>) {
        if self.minimum < -self.tolerance {
            let place = (-self.step).max(self.minimum);
            self.ask(Stage::Backward { ahead }, place);
        } else if let Some(ahead) = ahead {
            // No room behind: what is not lower at once lies between 0 and there.
            self.close(self.best, ahead);
        }
    }

    /// The value at [`Line::place`], a number or +∞.
    pub(super) fn learn(&mut self, value: f64) {
        let met = (self.asked, value);
        match std::mem::replace(&mut self.stage, Stage::Done) {
            Stage::Forward | Stage::Backward { .. } | Stage::Falling { .. } if value < self.best.1 => self.fall(met),
            Stage::Forward => self.backward(Some(met)),
            Stage::Backward { ahead } => self.close(met, ahead.unwrap_or(self.best)),
            Stage::Falling { previous } => self.close(previous, met),
            Stage::End { .. } if value >= self.best.1 => {}
            Stage::End { previous } => {
                let end = std::mem::replace(&mut self.best, met);
                self.close(previous, end);
            }
            Stage::Closing(bracket) => self.narrow(bracket, met),
            Stage::Done => {}
        }
    }

    /// The place just met is the lowest: on in the same direction.
    fn fall(&mut self, met: Met) {
        let previous = std::mem::replace(&mut self.best, met);
        let (last, step) = (met.0 - previous.0, self.tolerance.copysign(previous.0 - met.0));
        if met.0 <= self.minimum || met.0 >= self.maximum {
            if last.abs() > step.abs() {
                self.ask(Stage::End { previous }, met.0 + step);
            }
            return;
        }
        let place = (met.0 + GROWTH * last).clamp(self.minimum, self.maximum);
        self.ask(Stage::Falling { previous }, place);
    }

    /// The best place lies between the two, or is one of them.
    fn close(&mut self, one: Met, other: Met) {
        let (lower, upper) = if one.0 < other.0 { (one, other) } else { (other, one) };
        let (second, third) = if lower.1 < upper.1 { (lower, upper) } else { (upper, lower) };
        let width = upper.0 - lower.0;
        let bracket = Bracket { lower: lower.0, upper: upper.0, second, third, step: width, before: width };
        self.propose(bracket);
    }

    fn propose(&mut self, mut bracket: Bracket) {
        let Bracket { lower, upper, second, third, .. } = bracket;
        let (best, near) = (self.best, self.tolerance);
        let middle = 0.5 * (lower + upper);
        if (best.0 - middle).abs() <= 2.0 * near - 0.5 * (upper - lower) {
            return;
        }
        // The lowest point of the parabola through the three best places; no number where they do not make one.
        let (a, b) = ((best.0 - second.0) * (best.1 - third.1), (best.0 - third.0) * (best.1 - second.1));
        let parabola = 0.5 * ((best.0 - third.0) * b - (best.0 - second.0) * a) / (a - b);
        let place = best.0 + parabola;
        let shrinking = bracket.before.abs() > near && parabola.abs() < 0.5 * bracket.before.abs();
        bracket.step = if shrinking && lower < place && place < upper {
            bracket.before = bracket.step;
            // Not at an end of the bracket, where nothing is learned.
            if place - lower < 2.0 * near || upper - place < 2.0 * near {
                near.copysign(middle - best.0)
            } else {
                parabola
            }
        } else {
            bracket.before = if best.0 < middle { upper - best.0 } else { lower - best.0 };
            SECTION * bracket.before
        };
        let step = if bracket.step.abs() < near { near.copysign(bracket.step) } else { bracket.step };
        self.ask(Stage::Closing(bracket), best.0 + step);
    }

    #[allow(clippy::float_cmp)] // asks whether two places are the same one, not whether numbers agree
    fn narrow(&mut self, mut bracket: Bracket, met: Met) {
        // An equal value is no reason to leave: on a plateau the search stays where it is.
        let lower = met.1 < self.best.1;
        let (end, centre) = if lower { (self.best.0, met.0) } else { (met.0, self.best.0) };
        if end < centre {
            bracket.lower = end;
        } else {
            bracket.upper = end;
        }
        if lower {
            (bracket.third, bracket.second, self.best) = (bracket.second, self.best, met);
        } else if met.1 <= bracket.second.1 || bracket.second.0 == self.best.0 {
            (bracket.third, bracket.second) = (bracket.second, met);
        } else if met.1 <= bracket.third.1 || bracket.third.0 == self.best.0 || bracket.third.0 == bracket.second.0 {
            bracket.third = met;
        }
        self.propose(bracket);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The minimum, and how many places it took.
    fn search(function: impl Fn(f64) -> f64, ends: (f64, f64), step: f64, tolerance: f64) -> (f64, usize) {
        let mut line = Line::new(function(0.0), ends, step, tolerance);
        let mut count = 0;
        while let Some(place) = line.place() {
            assert!(ends.0 <= place && place <= ends.1, "{place}");
            line.learn(function(place));
            count += 1;
            assert!(count < 200, "{place}");
        }
        assert_eq!(line.best().1.to_bits(), function(line.best().0).to_bits());
        (line.best().0, count)
    }

    #[test]
    fn a_parabola_takes_the_bracket_and_two_steps_more() {
        for (at, step) in [(0.3, 0.1), (-0.07, 0.2), (0.004, 0.1), (0.9, 0.5)] {
            let (found, count) = search(|t| (t - at) * (t - at) + 2.0, (-1.0, 1.0), step, 1e-8);
            assert!((found - at).abs() < 1e-8, "{found} {at}");
            assert!(count <= 8, "{count}");
        }
    }

    /// Tier: second implementation; Brent's method of SciPy 1.17.1 (`minimize_scalar`, bracket 0 and 0.1, the same tolerance)
    /// takes this many values, the one at 0 included. Ours starts from three other places, so it may take one more.
    #[test]
    fn smooth_minima_take_as_few_values_as_scipy_s() {
        type Function = fn(f64) -> f64;
        let cases: [(Function, f64, [usize; 3]); 5] = [
            (|t| (3.0 * t).exp() - 5.0 * t, (5.0_f64 / 3.0).ln() / 3.0, [9, 11, 12]),
            (|t| (2.0 * (t - 0.45)).cosh(), 0.45, [10, 12, 12]),
            (|t| -1.0 / (1.0 + 25.0 * (t - 0.35).powi(2)), 0.35, [11, 12, 13]),
            (|t| (t - 0.5).powi(2) - 0.05 * (9.0 * (t - 0.5)).cos(), 0.5, [12, 12, 13]),
            (|t| t + 0.6 - (t + 1.05).ln(), -0.05, [9, 11, 12]),
        ];
        for (index, (function, minimum, scipy)) in cases.into_iter().enumerate() {
            for (tolerance, values) in [1e-4, 1e-6, 1e-8].into_iter().zip(scipy) {
                let (found, count) = search(function, (-1.0, 2.0), 0.1, tolerance);
                // Below 1e-8 values no longer tell places apart.
                assert!((found - minimum).abs() <= tolerance.max(2e-8), "{index}: {found}");
                assert!(count < values + 1, "{index}, {tolerance}: {} for {values}", count + 1);
            }
        }
    }

    #[test]
    fn kinks_and_flat_minima_are_met_to_the_tolerance() {
        for tolerance in [1e-3, 1e-6, 1e-10] {
            let (kink, count) = search(|t| (t - 0.618).abs(), (-0.2, 0.9), 0.1, tolerance);
            assert!((kink - 0.618).abs() <= 3.0 * tolerance, "{kink} {tolerance}");
            assert!(count < 80, "{count}");
        }
        let (quartic, _) = search(|t| (t + 0.4).powi(4), (-1.0, 1.0), 0.1, 1e-9);
        assert!((quartic + 0.4).abs() < 1e-4, "{quartic}");
    }

    #[test]
    fn an_end_is_met_exactly_and_left_when_the_minimum_is_just_before() {
        assert_eq!(search(|t| -t, (-1.0, 0.73), 0.1, 1e-8).0.to_bits(), 0.73_f64.to_bits());
        assert_eq!(search(|t| t, (-0.41, 0.73), 0.1, 1e-8).0.to_bits(), (-0.41_f64).to_bits());
        assert_eq!(search(|t| t, (0.0, 0.73), 0.1, 1e-8).0.to_bits(), 0);
        assert_eq!(search(|t| t, (0.0, 0.0), 0.1, 1e-8), (0.0, 0));
        let (found, _) = search(|t| (t - 0.729).abs(), (-1.0, 0.73), 0.1, 1e-8);
        assert!((found - 0.729).abs() < 3e-8, "{found}");
    }

    #[test]
    fn what_is_not_admissible_is_left() {
        let barrier = |t: f64| if t > 0.25 { f64::INFINITY } else { -t };
        let (found, _) = search(barrier, (-1.0, 1.0), 0.1, 1e-8);
        assert!((0.25 - found) < 3e-8 && found <= 0.25, "{found}");
        // From an inadmissible place to an admissible one.
        let (found, _) = search(|t| if t < 0.05 { f64::INFINITY } else { (t - 0.5).powi(2) }, (-1.0, 1.0), 0.1, 1e-8);
        assert!((found - 0.5).abs() < 1e-7, "{found}");
        search(|_| f64::INFINITY, (-1.0, 1.0), 0.1, 1e-8);
        assert_eq!(search(|_| 1.0, (-1.0, 1.0), 0.1, 1e-8).0.to_bits(), 0);
    }
}
