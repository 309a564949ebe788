//! Powell's direction set: line after line, and in the place of the direction that gained most the one that the whole
//! cycle went, so that on a quadratic function the directions become conjugate. Without derivatives.
//!
//! Source: Powell, Computer Journal 7 (1964) 155, sections 2 and 3 (the test that keeps the directions independent is its
//! step 6). A line ends where its last variable has met a bound; a variable that has met one stays there while the others
//! go on, so a minimum on a face, an edge or in a corner is met exactly and the directions can still follow the face. Once
//! a cycle moves by less than the tolerance, the search starts again along the axes around its best point until that gains
//! nothing. Lengths are shares of each variable's range. Must not know: randomness, but for a random start.

use super::line::Line;
use super::local::{self, Limits, Local, clip};
use super::search::Reason;
use super::{Method, Strategy};
use crate::base::error::Diagnostic;
use crate::base::parameter::{Field, Member};
use crate::base::record::Record;
use crate::base::seed::Seed;

pub const METHOD: Method = Method {
    member: Member {
        name: "powell",
        summary: "local search along directions that become conjugate, without derivatives",
        fields: FIELDS,
    },
    build,
};

const FIELDS: &[Field] = &[
    local::START,
    Field::number("step", 1e-6, 1.0, "first step along each axis, as a share of each range").default("0.1"),
    local::tolerance(1e-12, "a cycle's way, as a share of each range, at which it has converged"),
    local::restarts("most restarts along the axes, around the best point"),
    local::EVALUATIONS,
];

fn build(record: &Record, dimension: usize, seed: Seed) -> Result<Box<dyn Strategy>, Diagnostic> {
    let least = (2 * dimension + 1, "a line along each of");
    let (start, limits) = local::read(record, dimension, seed, least)?;
    Ok(Box::new(Powell::new(start, record.number("step"), limits)))
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

struct Powell {
    step: f64,
    limits: Limits,
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
    told: usize,
    restarted: usize,
    /// The value when the search began along the axes.
    before: f64,
    ended: Option<Reason>,
}

impl Powell {
    fn new(start: Vec<f64>, step: f64, limits: Limits) -> Self {
        Self {
            step,
            limits,
            directions: Vec::new(),
            began: (start.clone(), f64::INFINITY),
            batch: vec![start.clone()],
            at: start,
            value: f64::INFINITY,
            phase: Phase::Start,
            line: None,
            largest: (0, 0.0),
            told: 0,
            restarted: 0,
            before: f64::INFINITY,
            ended: None,
        }
    }

    fn ask(&mut self, point: Vec<f64>) {
        if self.told == self.limits.evaluations {
            self.ended = Some(Reason::Evaluations);
        }
        self.batch = vec![point];
    }

    fn begin_along_the_axes(&mut self) {
        self.before = self.value;
        let axis = |axis| {
            let along = (0..self.at.len()).map(|other| if other == axis { 1.0 } else { 0.0 }).collect();
            Direction { along, step: self.step }
        };
        self.directions = (0..self.at.len()).map(axis).collect();
        self.begin_cycle();
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
            let line = Line::new(self.value, ends(&self.at, along), *step, self.limits.tolerance);
            if let Some(place) = line.place() {
                let point = moved(&self.at, along, place);
                (self.phase, self.line) = (Phase::Line(number), Some(line));
                self.ask(point);
                return;
            }
        }
        let way = self.way();
        if way <= self.limits.tolerance {
            self.converged();
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

    fn converged(&mut self) {
        let gained = self.before - self.value > self.limits.tolerance * self.value.abs();
        // Where nothing is admissible nothing is gained: ∞ − ∞ is no number.
        if self.restarted == self.limits.restarts || !gained {
            self.ended = Some(Reason::Converged);
            self.batch.clear();
            return;
        }
        self.restarted += 1;
        self.begin_along_the_axes();
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
        let line = Line::new(self.value, ends(&self.at, &along), way, self.limits.tolerance);
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
        let step = place.abs().max(10.0 * self.limits.tolerance);
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

/// The stretch of a line on which at least one variable is off its bounds.
fn ends(at: &[f64], along: &[f64]) -> (f64, f64) {
    let (mut least, mut most) = (0.0_f64, 0.0_f64);
    for (at, along) in at.iter().zip(along) {
        if *along != 0.0 {
            let (zero, one) = (-at / along, (1.0 - at) / along);
            least = least.min(zero.min(one));
            most = most.max(zero.max(one));
        }
    }
    (least, most)
}

fn moved(at: &[f64], along: &[f64], place: f64) -> Vec<f64> {
    at.iter().zip(along).map(|(at, along)| clip(at + place * along)).collect()
}

impl Strategy for Powell {
    fn batch(&self) -> &[Vec<f64>] {
        &self.batch
    }

    fn learn(&mut self, values: &[f64]) -> Result<(), String> {
        let [value] = *values else { return Err("Powell's method evaluates one point at a time".to_owned()) };
        self.told += 1;
        match std::mem::replace(&mut self.phase, Phase::Start) {
            Phase::Start => {
                self.value = value;
                self.begin_along_the_axes();
            }
            Phase::Further => self.decide(value),
            phase => self.along(value, phase),
        }
        Ok(())
    }

    fn finished(&self) -> Option<Reason> {
        self.ended
    }

    fn budget(&self) -> usize {
        self.limits.evaluations
    }

    fn local(&mut self) -> Option<&mut dyn Local> {
        Some(self)
    }
}

impl Local for Powell {
    fn start_over(&mut self, at: Vec<f64>) {
        let (told, step, limits) = (self.told, self.step, self.limits);
        *self = Self { told, ..Self::new(at.clone(), step, limits) };
        self.ask(at);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits { tolerance: 1e-9, restarts: 0, evaluations: 5000 };

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
    fn after(cycles: usize, function: &Quadratic) -> Powell {
        let mut search = Powell::new(vec![0.5; function.0.len()], 0.1, LIMITS);
        let mut begun = 0;
        while search.ended.is_none() && begun <= cycles {
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
        let (least, most) = ends(&at, &along);
        assert_eq!(moved(&at, &along, most), [1.0, 1.0]);
        assert_eq!(moved(&at, &along, least), [0.0, 0.0]);
        assert!((least + 0.9).abs() < 1e-15 && (most - 1.6).abs() < 1e-15);
    }
}
