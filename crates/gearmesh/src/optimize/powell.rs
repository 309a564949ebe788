//! Powell's direction set: line after line, and in the place of the direction that gained most the one that the whole
//! cycle went, so that on a quadratic function the directions become conjugate. Without derivatives.
//!
//! Source: Powell, Computer Journal 7 (1964) 155, sections 2 and 3 (the test that keeps the directions independent is its
//! step 6). A line ends where its last variable has met a bound; a variable that has met one stays there while the others
//! go on, so a minimum on a face, an edge or in a corner is met exactly and the directions can still follow the face. Once
//! a cycle moves by less than the tolerance, the search has converged; what then, `restarts.rs` says. Lengths are
//! shares of each variable's range. Must not know: randomness, but for a random start.

use super::line::Line;
use super::local::{self, Limits, Search, Start, clip, ends, moved};
use super::restarts::Restarted;
use super::{Foreseen, Method, Strategy};
use declare::Declared;
use declare::error::Diagnostic;
use declare::seed::Seed;

/// local search along directions that become conjugate, without derivatives
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "powell")]
pub struct Powell {
    /// where it starts
    #[declared(default = "centre")]
    pub start: Start,
    /// first step along each axis, as a share of each range
    #[declared(minimum = 1e-6, maximum = 1.0, default = "0.1")]
    pub step: f64,
    /// a cycle's way, as a share of each range, at which it has converged
    #[declared(minimum = 1e-12, maximum = 0.1, default = "1e-8")]
    pub tolerance: f64,
    /// most restarts around the best point, along the axes or a kink; with 0 it is not checked
    #[declared(minimum = 0, maximum = 1000, default = "30")]
    pub restarts: usize,
    /// most evaluations
    #[declared(minimum = 10, maximum = 10_000_000, default = "5000")]
    pub evaluations: usize,
}

impl Method for Powell {
    fn foresee(&self, dimension: usize) -> Result<Foreseen, Diagnostic> {
        let foreseen = local::foresee(self.evaluations, dimension, (2 * dimension + 1, "a line along each of"));
        foreseen.map_err(|wrong| wrong.of(Self::NAMES.evaluations))
    }

    fn strategy(&self, dimension: usize, seed: Seed) -> Box<dyn Strategy> {
        let limits = Limits { tolerance: self.tolerance, restarts: self.restarts, evaluations: self.evaluations };
        let start = self.start.point(dimension, seed);
        Box::new(Restarted::new(DirectionSearch::new(start, self.step, self.tolerance), self.step, limits))
    }
}

/// A direction whose largest component is 1, and the length of the first step along it.
struct Direction {
    along: Vec<f64>,
    step: f64,
}

/// What the value of the current point is for.
enum Phase {
    /// The value of the starting point.
    Start,
    /// The line along the direction of this number.
    Line(usize),
    /// As far again as the whole cycle went.
    Further,
    /// The line along the way of the whole cycle.
    Way(Direction),
}

struct DirectionSearch {
    step: f64,
    tolerance: f64,
    directions: Vec<Direction>,
    at: Vec<f64>,
    value: f64,
    phase: Phase,
    line: Option<Line>,
    batch: Vec<Vec<f64>>,
    /// Where the cycle began, and the value there.
    began: (Vec<f64>, f64),
    /// The direction of the cycle that gained most, and its gain.
    largest: (usize, f64),
}

impl DirectionSearch {
    fn new(start: Vec<f64>, step: f64, tolerance: f64) -> Self {
        let axis = |axis| {
            let along = (0..start.len()).map(|other| if other == axis { 1.0 } else { 0.0 }).collect();
            Direction { along, step }
        };
        Self {
            step,
            tolerance,
            directions: (0..start.len()).map(axis).collect(),
            began: (start.clone(), f64::INFINITY),
            batch: vec![start.clone()],
            at: start,
            value: f64::INFINITY,
            phase: Phase::Start,
            line: None,
            largest: (0, 0.0),
        }
    }

    fn ask(&mut self, point: Vec<f64>) {
        self.batch = vec![point];
    }

    fn begin_cycle(&mut self) {
        self.began = (self.at.clone(), self.value);
        self.largest = (0, 0.0);
        self.go_on_from(0);
    }

    /// The lines from direction `next` on; then what becomes of the directions.
    fn go_on_from(&mut self, next: usize) {
        for number in next..self.directions.len() {
            let Direction { along, step } = &self.directions[number];
            let line = Line::new(self.value, ends(&self.at, along), *step, self.tolerance);
            if let Some(place) = line.place() {
                let point = moved(&self.at, along, place);
                (self.phase, self.line) = (Phase::Line(number), Some(line));
                self.ask(point);
                return;
            }
        }
        let way = self.way();
        if way <= self.tolerance {
            self.batch.clear();
        } else if self.at.len() == 1 {
            self.begin_cycle();
        } else {
            let further = self.at.iter().zip(&self.began.0).map(|(at, began)| clip(2.0 * at - began)).collect();
            self.phase = Phase::Further;
            self.ask(further);
        }
    }

    /// How far the cycle went, in the maximum norm.
    fn way(&self) -> f64 {
        self.at.iter().zip(&self.began.0).map(|(at, began)| (at - began).abs()).fold(0.0, f64::max)
    }

    /// Step 6 of the source: whether the way of the cycle shall replace the direction that gained most. It shall not when
    /// the function turns up further on, or when another direction's gain made most of the cycle's.
    fn decide(&mut self, further: f64) {
        let (first, last, gain) = (self.began.1, self.value, self.largest.1);
        let curvature = first - 2.0 * last + further;
        if further >= first || 2.0 * curvature * (first - last - gain).powi(2) >= gain * (first - further).powi(2) {
            self.begin_cycle();
            return;
        }
        let way = self.way();
        let along: Vec<f64> = self.at.iter().zip(&self.began.0).map(|(at, began)| (at - began) / way).collect();
        let line = Line::new(self.value, ends(&self.at, &along), way, self.tolerance);
        let Some(place) = line.place() else {
            self.begin_cycle();
            return;
        };
        let point = moved(&self.at, &along, place);
        (self.phase, self.line) = (Phase::Way(Direction { along, step: way }), Some(line));
        self.ask(point);
    }

    /// A value on the current line: the next place on it, or its end.
    fn along(&mut self, value: f64, phase: Phase) {
        let Some(mut line) = self.line.take() else { return };
        line.learn(value);
        let along = match &phase {
            Phase::Way(direction) => &direction.along,
            Phase::Line(number) => &self.directions[*number].along,
            _ => return,
        };
        if let Some(place) = line.place() {
            let point = moved(&self.at, along, place);
            (self.phase, self.line) = (phase, Some(line));
            self.ask(point);
            return;
        }
        let (place, lowest) = line.best();
        let gain = self.value - lowest;
        self.at = moved(&self.at, along, place);
        self.value = lowest;
        // The next line along it is likely to be as short.
        let step = place.abs().max(10.0 * self.tolerance);
        match phase {
            Phase::Way(direction) => {
                self.directions.remove(self.largest.0);
                self.directions.push(Direction { step, ..direction });
                self.begin_cycle();
            }
            Phase::Line(number) => {
                self.directions[number].step = step;
                if gain > self.largest.1 {
                    self.largest = (number, gain);
                }
                self.go_on_from(number + 1);
            }
            _ => {}
        }
    }
}

impl Search for DirectionSearch {
    fn batch(&self) -> &[Vec<f64>] {
        &self.batch
    }

    fn learn(&mut self, values: &[f64]) -> Result<(), String> {
        let [value] = *values else { return Err("Powell's method evaluates one point at a time".to_owned()) };
        match std::mem::replace(&mut self.phase, Phase::Start) {
            Phase::Start => {
                self.value = value;
                self.begin_cycle();
            }
            Phase::Further => self.decide(value),
            phase => self.along(value, phase),
        }
        Ok(())
    }

    fn converged(&self) -> bool {
        self.batch.is_empty()
    }

    fn best(&self) -> (&[f64], f64) {
        (&self.at, self.value)
    }

    /// The direction in which the function falls takes the place of the axis that is nearest to it.
    fn begin(&mut self, at: Vec<f64>, value: Option<f64>, down: Option<Vec<f64>>) {
        *self = Self::new(at, self.step, self.tolerance);
        if let Some(along) = down {
            let nearest = (0..along.len()).max_by(|a, b| along[*a].abs().total_cmp(&along[*b].abs())).unwrap_or(0);
            self.directions[nearest].along = along;
        }
        if let Some(value) = value {
            self.value = value;
            self.begin_cycle();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quadratic form with eigenvalues 1, 10, … along tilted axes, lowest at `MINIMUM`.
    struct Quadratic(Vec<Vec<f64>>);

    const MINIMUM: [f64; 5] = [0.42, 0.61, 0.53, 0.37, 0.58];

    impl Quadratic {
        /// A Householder reflection tilts the axes.
        fn new(dimension: usize) -> Self {
            let normal: Vec<f64> = (0..dimension).map(|axis| 1.0 + axis as f64).collect();
            let square: f64 = normal.iter().map(|x| x * x).sum();
            let reflected = |row: usize, column: usize| {
                f64::from(u8::from(row == column)) - 2.0 * normal[row] * normal[column] / square
            };
            let entry = |row: usize, column: usize| {
                let stiffnesses = [1.0, 10.0, 100.0, 1e3, 1e4];
                (0..dimension).map(|k| reflected(row, k) * stiffnesses[k] * reflected(k, column)).sum()
            };
            Self((0..dimension).map(|row| (0..dimension).map(|column| entry(row, column)).collect()).collect())
        }

        fn product(&self, a: &[f64], b: &[f64]) -> f64 {
            self.0.iter().zip(a).map(|(row, a)| a * row.iter().zip(b).map(|(entry, b)| entry * b).sum::<f64>()).sum()
        }

        fn value(&self, x: &[f64]) -> f64 {
            let from: Vec<f64> = x.iter().zip(MINIMUM).map(|(x, minimum)| x - minimum).collect();
            0.5 * self.product(&from, &from)
        }

        /// Cosine of the angle between two directions in the form's own metric.
        fn cosine(&self, a: &[f64], b: &[f64]) -> f64 {
            self.product(a, b) / (self.product(a, a) * self.product(b, b)).sqrt()
        }
    }

    /// The search after a number of cycles, or at its end.
    fn after(cycles: usize, function: &Quadratic) -> DirectionSearch {
        let mut search = DirectionSearch::new(vec![0.5; function.0.len()], 0.1, 1e-9);
        let mut begun = 0;
        while !search.converged() && begun <= cycles {
            let before = search.began.clone();
            let value = function.value(&search.batch[0]);
            search.learn(&[value]).unwrap();
            begun += usize::from(search.began != before);
        }
        search
    }

    /// Tier: closed form. Powell 1964, section 2: conjugate directions end at the minimum of a quadratic function; with
    /// the test that may keep a direction, one cycle more than there are variables.
    #[test]
    fn a_quadratic_function_takes_a_cycle_per_variable_and_one() {
        for dimension in 2..=5 {
            let function = Quadratic::new(dimension);
            let first = function.value(&vec![0.5; dimension]);
            let (early, late) = (after(dimension - 1, &function).began.1, after(dimension + 1, &function).began.1);
            assert!(early > 1e-4 * first, "{dimension}: {early:e} of {first:e}");
            assert!(late < 1e-12 * first, "{dimension}: {late:e} of {first:e}");
        }
    }

    #[test]
    fn directions_become_conjugate() {
        for dimension in 2..=4 {
            let function = Quadratic::new(dimension);
            let directions = after(dimension + 1, &function).directions;
            for (count, one) in directions.iter().enumerate() {
                for other in &directions[..count] {
                    let cosine = function.cosine(&one.along, &other.along);
                    assert!(cosine.abs() < 3e-6, "{dimension}: {cosine:e}");
                }
            }
        }
    }

    #[test]
    fn a_line_goes_on_along_the_face_it_has_met() {
        let (at, along) = ([0.9, 0.2], [1.0, 0.5]);
        let (minimum, maximum) = ends(&at, &along);
        assert_eq!(moved(&at, &along, maximum), [1.0, 1.0]);
        assert_eq!(moved(&at, &along, minimum), [0.0, 0.0]);
        assert!((minimum + 0.9).abs() < 1e-15 && (maximum - 1.6).abs() < 1e-15);
    }
}
