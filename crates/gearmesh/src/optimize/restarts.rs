//! Local searches until nothing more is gained: begun again around the best point, and where they have stopped on a kink,
//! led along it.
//!
//! A simplex that is pressed flat, or lines along directions that a kink blocks, meet a measure of convergence far from
//! any minimum. So a search that has converged begins again; one that gains nothing is looked at ([`super::kink`]): where
//! the function is smooth, or its gradients on all sides of the kink balance, it has converged. Else it goes on along the
//! kink. Where the gradients say that it goes down but no line does, or the restarts are used up, it has stalled, and says
//! so. Where points next to the one it found have no value, steps across that edge were refused, and the point may be no minimum: it
//! then ends at the edge. Must not know: which search runs, why a point has no value.

use std::collections::VecDeque;

use super::kink::{self, STATIONARY, Slope};
use super::line::Line;
use super::local::{Limits, Search, ends, moved};
use super::search::Reason;
use super::{Local, Strategy};

/// The least tolerance that looks follow: below, differences would drown in rounding.
const FINEST: f64 = 1e-8;

/// Looks at one point, each with crosses that are turned, and their radii. A difference that a kink runs through, or a
/// point beside the one where several meet, misleads one look; most of them decide. Near the point where several kinks meet wide looks see all
/// their sides and find it stationary: it is no nearer than the narrowest.
const LOOKS: [f64; 4] = [1.0, 0.1, 10.0, 0.01];

/// Points without a value that are kept: enough for all looks at a point of some variables.
const MOST_REFUSED: usize = 256;

enum Phase {
    /// The search itself.
    Searching,
    /// A wide and a narrow cross around the best point.
    Looking,
    /// Gradients at these places.
    Sloping(Vec<Vec<f64>>),
    /// Down along the kink.
    Falling(Slope, Line),
}

/// A local search with its restarts.
pub(super) struct Restarted<S> {
    search: S,
    limits: Limits,
    /// The first step of the search.
    step: f64,
    phase: Phase,
    batch: Vec<Vec<f64>>,
    told: usize,
    /// Restarts.
    used: usize,
    /// The value when the search was begun.
    before: f64,
    /// Whether it was begun on a kink: then it is looked at again at once.
    led: bool,
    /// The looks at this point, and at all.
    looks: [usize; 2],
    /// How many looks at this point said that it should go down, though no line did.
    doubts: usize,
    /// The gradients of all these looks.
    gradients: Vec<Vec<f64>>,
    /// The lowest of the points where gradients were taken.
    aside: (Vec<f64>, f64),
    /// The latest points without a value, at most [`MOST_REFUSED`].
    refused: VecDeque<Vec<f64>>,
    ended: Option<Reason>,
}

impl<S: Search> Restarted<S> {
    pub(super) fn new(search: S, step: f64, limits: Limits) -> Self {
        let batch = search.batch().to_vec();
        let mut restarted = Self {
            search,
            limits,
            step,
            phase: Phase::Searching,
            batch: Vec::new(),
            told: 0,
            used: 0,
            before: f64::INFINITY,
            led: false,
            looks: [0; 2],
            doubts: 0,
            gradients: Vec::new(),
            aside: (Vec::new(), f64::INFINITY),
            refused: VecDeque::new(),
            ended: None,
        };
        restarted.ask(Phase::Searching, batch);
        restarted
    }

    fn ask(&mut self, phase: Phase, batch: Vec<Vec<f64>>) {
        if self.told + batch.len() > self.limits.evaluations {
            self.ended = Some(Reason::Evaluations);
        }
        (self.phase, self.batch) = (phase, batch);
    }

    fn end(&mut self, reason: Reason) {
        self.ended = Some(if self.is_beside_refused() { Reason::Edge } else { reason });
        self.batch.clear();
    }

    /// Whether a point without a value is as near to the best one as the points of a wide look are.
    fn is_beside_refused(&self) -> bool {
        let (at, value) = self.search.best();
        let near = (self.step * self.limits.tolerance.max(FINEST)).sqrt();
        let distance =
            |point: &Vec<f64>| point.iter().zip(at).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
        // A cross has its arms, which are rounded, at that distance.
        value.is_finite() && self.refused.iter().any(|point| distance(point) <= (1.0 + 1e-9) * near)
    }

    /// Radii of the looks: between the first step and the tolerance, and between that and the tolerance.
    fn radii(&self) -> (f64, f64) {
        let tolerance = self.limits.tolerance.max(FINEST);
        let wide = (self.step * tolerance).sqrt();
        let wide = (wide * LOOKS[self.looks[0]]).min(self.step);
        (wide, (wide * tolerance).sqrt())
    }

    fn gained(&self) -> bool {
        // Where nothing is admissible nothing is gained: ∞ − ∞ is not a number.
        let value = self.search.best().1;
        self.before - value > self.limits.tolerance * value.abs()
    }

    fn go_on(&mut self) {
        if !self.search.converged() {
            let batch = self.search.batch().to_vec();
            self.ask(Phase::Searching, batch);
            return;
        }
        let (at, value) = self.search.best();
        let at = at.to_vec();
        if self.limits.restarts == 0 || at.len() == 1 || !value.is_finite() {
            self.end(Reason::Converged);
        } else if self.gained() && !self.led && self.used < self.limits.restarts {
            self.used += 1;
            self.begin(at, Some(value), None);
        } else {
            (self.looks[0], self.doubts, self.led) = (0, 0, false);
            self.gradients.clear();
            let (wide, narrow) = self.radii();
            let batch = [kink::cross(&at, wide, self.looks[1]), kink::cross(&at, narrow, self.looks[1])].concat();
            self.ask(Phase::Looking, batch);
        }
    }

    fn begin(&mut self, at: Vec<f64>, value: Option<f64>, down: Option<Vec<f64>>) {
        self.before = self.search.best().1;
        self.search.begin(at, value, down);
        self.go_on();
    }

    fn looked(&mut self, values: &[f64]) {
        let (wide, narrow) = self.radii();
        let (far, near) = values.split_at(values.len() / 2);
        if kink::kinked(self.search.best().1, far, near, wide / narrow) {
            self.slope();
        } else {
            self.end(Reason::Converged);
        }
    }

    fn slope(&mut self) {
        let (wide, narrow) = self.radii();
        let at = self.search.best().0;
        // Two crosses, so that most sides of several kinks are met.
        let places = kink::crosses(at, wide, self.looks[1]);
        let batch = kink::stencils(&places, narrow);
        self.ask(Phase::Sloping(places), batch);
    }

    fn sloped(&mut self, places: &[Vec<f64>], values: &[f64]) {
        let lowest = (0..values.len()).min_by(|a, b| values[*a].total_cmp(&values[*b])).unwrap_or(0);
        self.aside = (self.batch[lowest].clone(), values[lowest]);
        let (wide, narrow) = self.radii();
        let gradients = kink::gradients(places, narrow, values);
        self.gradients.extend_from_slice(&gradients);
        let (at, value) = self.search.best();
        let Some(slope) = kink::slope(at, gradients) else {
            self.look_again();
            return;
        };
        let line = Line::new(value, (0.0, ends(at, &slope.along).1), wide, self.limits.tolerance);
        self.fall(slope, line);
    }

    fn fall(&mut self, slope: Slope, line: Line) {
        let at = self.search.best().0;
        if let Some(place) = line.place() {
            let point = moved(at, &slope.along, place);
            self.ask(Phase::Falling(slope, line), vec![point]);
            return;
        }
        let (place, lowest) = line.best();
        if self.is_lower(lowest) {
            let point = moved(at, &slope.along, place);
            self.lead(point, lowest, Some(slope.along));
        } else {
            self.doubts += usize::from(slope.share > STATIONARY);
            self.look_again();
        }
    }

    fn is_lower(&self, value: f64) -> bool {
        let best = self.search.best().1;
        best - value > self.limits.tolerance * best.abs()
    }

    fn lead(&mut self, point: Vec<f64>, value: f64, down: Option<Vec<f64>>) {
        if self.used == self.limits.restarts {
            self.end(Reason::Stalled);
            return;
        }
        self.used += 1;
        self.led = true;
        self.begin(point, Some(value), down);
    }

    fn look_again(&mut self) {
        self.looks = [self.looks[0] + 1, self.looks[1] + 1];
        if self.is_lower(self.aside.1) {
            let (point, value) = std::mem::take(&mut self.aside);
            self.lead(point, value, None);
        } else if self.looks[0] < LOOKS.len() {
            self.slope();
        } else {
            // Many kinks may meet here, and no look alone have met all their sides.
            let together = kink::slope(self.search.best().0, std::mem::take(&mut self.gradients));
            let doubtful = 2 * self.doubts > LOOKS.len() && together.is_some_and(|slope| slope.share > STATIONARY);
            self.end(if doubtful { Reason::Stalled } else { Reason::Converged });
        }
    }
}

impl<S: Search> Strategy for Restarted<S> {
    fn batch(&self) -> &[Vec<f64>] {
        &self.batch
    }

    fn learn(&mut self, values: &[f64]) -> Result<(), String> {
        self.told += values.len();
        let refused = self.batch.iter().zip(values).filter(|(_, value)| **value == f64::INFINITY);
        self.refused.extend(refused.map(|(point, _)| point.clone()));
        self.refused.drain(..self.refused.len().saturating_sub(MOST_REFUSED));
        match std::mem::replace(&mut self.phase, Phase::Searching) {
            Phase::Searching => {
                self.search.learn(values)?;
                self.go_on();
            }
            Phase::Looking => self.looked(values),
            Phase::Sloping(places) => self.sloped(&places, values),
            Phase::Falling(slope, mut line) => {
                line.learn(values[0]);
                self.fall(slope, line);
            }
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

impl<S: Search> Local for Restarted<S> {
    fn start_over(&mut self, at: Vec<f64>) {
        (self.used, self.led, self.ended) = (0, false, None);
        self.before = f64::INFINITY;
        self.search.begin(at, None, None);
        self.go_on();
    }
}
