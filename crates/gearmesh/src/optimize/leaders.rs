//! The best of the points that were tried, each of a place of its own: those that a closer look has to choose from.
//!
//! Must not know: which method tried them, how they are looked at.

use super::bounds::Bounds;
use super::constraints::Evaluation;

/// Points nearer to each other than this share of every range are of one place.
const NEAR: f64 = 0.05;

/// A point of the box and what it came to.
#[derive(Clone, Debug, PartialEq)]
pub struct Leader {
    /// One value per variable.
    pub point: Vec<f64>,
    /// The objective there.
    pub value: f64,
    /// The sum of what is broken of the constraints.
    pub violation: f64,
    /// What is left of each.
    pub constraints: Vec<f64>,
}

/// The best points, each of a place of its own, the best first.
#[derive(Clone, Debug)]
pub struct Leaders {
    bounds: Bounds,
    most: usize,
    kept: Vec<Leader>,
}

impl Leaders {
    /// Keeps at most so many.
    #[must_use]
    pub fn new(bounds: Bounds, most: usize) -> Self {
        Self { bounds, most, kept: Vec::new() }
    }

    /// Takes in a point that was tried, if it leads its place.
    pub fn take(&mut self, point: &[f64], evaluation: &Evaluation) {
        if !evaluation.admissible() {
            return;
        }
        let found = Leader {
            point: point.to_vec(),
            value: evaluation.value,
            violation: evaluation.violation(),
            constraints: evaluation.constraints.clone(),
        };
        let rank = |leader: &Leader| (leader.violation, leader.value);
        let is_near = |leader: &Leader| {
            let pairs = leader.point.iter().zip(point).zip(self.bounds.pairs());
            pairs.into_iter().all(|((a, b), (minimum, maximum))| (a - b).abs() < NEAR * (maximum - minimum))
        };
        if self.kept.iter().any(|leader| rank(leader) <= rank(&found) && is_near(leader)) {
            return;
        }
        self.kept.retain(|leader| !is_near(leader));
        let place = self.kept.partition_point(|leader| rank(leader) <= rank(&found));
        self.kept.insert(place, found);
        self.kept.truncate(self.most);
    }

    /// The best first.
    #[must_use]
    pub fn all(&self) -> &[Leader] {
        &self.kept
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_place_has_one_leader_and_those_that_keep_the_constraints_come_first() {
        let mut leaders = Leaders::new(Bounds::new(vec![(0.0, 100.0)]).unwrap(), 3);
        let mut take = |x: f64, value: f64, constraint: f64| {
            leaders.take(&[x], &Evaluation { value, constraints: vec![constraint], ..Evaluation::default() });
        };
        take(10.0, 5.0, 1.0);
        take(12.0, 6.0, 1.0);
        take(50.0, 7.0, 1.0);
        take(11.0, 4.0, 1.0);
        take(90.0, 1.0, -0.5);
        take(30.0, f64::NAN, 1.0);
        let points = |leaders: &Leaders| leaders.all().iter().map(|leader| leader.point[0]).collect::<Vec<_>>();
        assert_eq!(points(&leaders), [11.0, 50.0, 90.0]);
        leaders.take(&[70.0], &Evaluation::from(0.0));
        assert_eq!(points(&leaders), [70.0, 11.0, 50.0]);
    }
}
