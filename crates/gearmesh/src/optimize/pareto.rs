//! Which points of several objectives are better than others: constrained domination, fronts, crowding.
//!
//! A point dominates another one when it breaks less of the constraints, or when both keep them and it is nowhere worse and
//! somewhere better (Deb, Pratap, Agarwal, Meyarivan, IEEE Trans. Evol. Comput. 6 (2002) 182, section VI). Those that nobody
//! dominates are the first front, those that only these dominate the second, and so on. Must not know: which method runs.

use super::constraints::Evaluation;

/// A point that was tried.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// One value per variable, within its bounds.
    pub point: Vec<f64>,
    /// What it came to.
    pub evaluation: Evaluation,
}

/// What domination looks at.
#[derive(Clone, Debug)]
pub(super) struct Standing {
    objectives: Vec<f64>,
    /// ∞ where there is no value.
    violation: f64,
}

impl Standing {
    pub(super) fn new(evaluation: &Evaluation) -> Self {
        let violation = if evaluation.admissible() { evaluation.violation() } else { f64::INFINITY };
        Self { objectives: evaluation.objectives().collect(), violation }
    }

    fn dominates(&self, other: &Self) -> bool {
        if self.violation > 0.0 || other.violation > 0.0 {
            return self.violation < other.violation;
        }
        let pairs = || self.objectives.iter().zip(&other.objectives);
        pairs().all(|(one, other)| one <= other) && pairs().any(|(one, other)| one < other)
    }
}

/// The front of each point, from 0.
pub(super) fn ranks(standings: &[Standing]) -> Vec<usize> {
    let count = standings.len();
    // Whom each one dominates, and how many dominate it.
    let mut below: Vec<Vec<usize>> = vec![Vec::new(); count];
    let mut above = vec![0_usize; count];
    for one in 0..count {
        for other in one + 1..count {
            if standings[one].dominates(&standings[other]) {
                below[one].push(other);
                above[other] += 1;
            } else if standings[other].dominates(&standings[one]) {
                below[other].push(one);
                above[one] += 1;
            }
        }
    }
    let mut ranks = vec![0; count];
    let mut front: Vec<usize> = (0..count).filter(|at| above[*at] == 0).collect();
    let mut rank = 0;
    while !front.is_empty() {
        let mut next = Vec::new();
        for at in front {
            ranks[at] = rank;
            for &other in &below[at] {
                above[other] -= 1;
                if above[other] == 0 {
                    next.push(other);
                }
            }
        }
        next.sort_unstable();
        (front, rank) = (next, rank + 1);
    }
    ranks
}

/// Half the circumference of the box around each point of a front that its neighbours leave, in shares of the front's
/// extent; ∞ for the ends of an objective.
pub(super) fn crowding(objectives: &[&[f64]]) -> Vec<f64> {
    let mut distances = vec![0.0; objectives.len()];
    let count = objectives.first().map_or(0, |first| first.len());
    for axis in 0..count {
        let mut order: Vec<usize> = (0..objectives.len()).collect();
        order.sort_by(|a, b| objectives[*a][axis].total_cmp(&objectives[*b][axis]));
        let value = |place: usize| objectives[order[place]][axis];
        let last = order.len() - 1;
        let extent = value(last) - value(0);
        for &end in [&order[0], &order[last]] {
            distances[end] = f64::INFINITY;
        }
        if extent > 0.0 {
            for place in 1..last {
                distances[order[place]] += (value(place + 1) - value(place - 1)) / extent;
            }
        }
    }
    distances
}

/// Which `count` points of a front to keep so that they lie evenly: the most crowded one goes, its neighbours are looked at
/// again (Kukkonen and Deb, Improved pruning of non-dominated solutions, CEC 2006), and so on; of very many several at once.
/// In their order.
pub(super) fn even(objectives: &[&[f64]], count: usize) -> Vec<usize> {
    let mut kept: Vec<usize> = (0..objectives.len()).collect();
    while kept.len() > count {
        let distances = crowding(&kept.iter().map(|at| objectives[*at]).collect::<Vec<_>>());
        let mut order: Vec<usize> = (0..kept.len()).collect();
        order.sort_by(|a, b| distances[*a].total_cmp(&distances[*b]));
        let gone = ((kept.len() - count) / AT_ONCE).max(1);
        let mut leaves = vec![false; kept.len()];
        order[..gone].iter().for_each(|place| leaves[*place] = true);
        let mut leaves = leaves.into_iter();
        kept.retain(|_| !leaves.next().unwrap_or(false));
    }
    kept
}

/// The share of what is too many that goes at once is one of so many.
const AT_ONCE: usize = 64;

/// The points of a search that keep all constraints and that no other one dominates.
#[derive(Clone, Debug, Default)]
pub(super) struct Archive(Vec<(Standing, Member)>);

impl Archive {
    /// Takes in a point, unless one that is there is as good everywhere.
    pub(super) fn add(&mut self, point: &[f64], evaluation: &Evaluation) {
        let standing = Standing::new(evaluation);
        let as_good = |other: &Standing| other.objectives == standing.objectives || other.dominates(&standing);
        if standing.violation > 0.0 || self.0.iter().any(|(other, _)| as_good(other)) {
            return;
        }
        self.0.retain(|(other, _)| !standing.dominates(other));
        let member = Member { point: point.to_vec(), evaluation: evaluation.clone() };
        self.0.push((standing, member));
    }

    /// At most `count` of them, evenly, from the smallest first objective on.
    pub(super) fn even(&self, count: usize) -> Vec<&Member> {
        let objectives: Vec<&[f64]> = self.0.iter().map(|(standing, _)| &standing.objectives[..]).collect();
        let mut kept: Vec<&Member> = even(&objectives, count).into_iter().map(|at| &self.0[at].1).collect();
        kept.sort_by(|a, b| a.evaluation.value.total_cmp(&b.evaluation.value));
        kept
    }

    /// The objectives of at most `count` of them.
    pub(super) fn objectives(&self, count: usize) -> Vec<Vec<f64>> {
        self.even(count).into_iter().map(|member| member.evaluation.objectives().collect()).collect()
    }
}

/// The members of a front, each of which nobody dominates, out of any points, in their order; one of those that are alike.
#[must_use]
pub fn front(members: &[Member]) -> Vec<Member> {
    let mut archive = Archive::default();
    for member in members {
        archive.add(&member.point, &member.evaluation);
    }
    archive.0.into_iter().map(|(_, member)| member).collect()
}

/// At most `count` members of a front, evenly, in their order.
#[must_use]
pub fn thinned(front: Vec<Member>, count: usize) -> Vec<Member> {
    let objectives: Vec<Vec<f64>> = front.iter().map(|member| member.evaluation.objectives().collect()).collect();
    let kept = even(&objectives.iter().map(|objectives| &objectives[..]).collect::<Vec<_>>(), count);
    let mut kept = kept.into_iter().peekable();
    let numbered = front.into_iter().enumerate();
    numbered.filter(|(at, _)| kept.next_if_eq(at).is_some()).map(|(_, member)| member).collect()
}

/// The member nearest to the point that has the least of every objective, in shares of the front's extents: the compromise
/// that a front offers when nothing else is known (Zeleny, Multiple Criteria Decision Making, 1982: compromise programming
/// with the Euclidean distance). `None` of an empty front.
#[must_use]
pub fn balanced(front: &[Member]) -> Option<&Member> {
    let objectives: Vec<Vec<f64>> = front.iter().map(|member| member.evaluation.objectives().collect()).collect();
    let ends = |axis: usize| {
        let values = objectives.iter().map(|objectives| objectives[axis]);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
    };
    let ends: Vec<_> = (0..objectives.first().map_or(0, Vec::len)).map(ends).collect();
    let distance = |at: usize| -> f64 {
        let share =
            |(value, (low, high)): (&f64, &(f64, f64))| if high > low { (value - low) / (high - low) } else { 0.0 };
        objectives[at].iter().zip(&ends).map(share).map(|share| share * share).sum()
    };
    (0..front.len()).min_by(|a, b| distance(*a).total_cmp(&distance(*b))).map(|at| &front[at])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn evaluation(objectives: [f64; 2], constraints: &[f64]) -> Evaluation {
        Evaluation { value: objectives[0], further: vec![objectives[1]], constraints: constraints.to_vec() }
    }

    fn members(objectives: &[[f64; 2]]) -> Vec<Member> {
        let member = |(at, objectives): (usize, &[f64; 2])| Member {
            point: vec![at as f64],
            evaluation: evaluation(*objectives, &[]),
        };
        objectives.iter().enumerate().map(member).collect()
    }

    #[test]
    fn fronts_are_peeled_one_by_one_and_what_breaks_constraints_comes_last() {
        let points = [
            evaluation([1.0, 4.0], &[0.1]),
            evaluation([2.0, 2.0], &[0.0]),
            evaluation([2.0, 4.0], &[1.0]),
            evaluation([3.0, 3.0], &[1.0]),
            evaluation([3.0, 4.0], &[1.0]),
            // The better objectives are, the less they count where constraints are broken.
            evaluation([0.0, 0.0], &[-0.1]),
            evaluation([-9.0, -9.0], &[-0.2]),
            evaluation([f64::NAN, 0.0], &[1.0]),
            evaluation([0.0, f64::INFINITY], &[1.0]),
        ];
        let standings: Vec<Standing> = points.iter().map(Standing::new).collect();
        assert_eq!(ranks(&standings), [0, 0, 1, 1, 2, 3, 4, 5, 5]);
    }

    /// Tier: closed form. Equal points are of one front; the sum of a front's gaps along an axis is twice its extent but for
    /// what the ends leave.
    #[test]
    fn crowding_is_what_the_neighbours_leave() {
        let points = [[0.0, 4.0], [1.0, 2.0], [1.5, 1.5], [4.0, 0.0]];
        let distances = crowding(&points.each_ref().map(|point| &point[..]));
        assert_eq!(distances, [f64::INFINITY, 1.5 / 4.0 + 2.5 / 4.0, 3.0 / 4.0 + 2.0 / 4.0, f64::INFINITY]);
        assert_eq!(even(&points.each_ref().map(|point| &point[..]), 3), [0, 2, 3]);
    }

    /// Of an even front and a cluster the cluster is thinned, and the ends stay.
    #[test]
    fn a_thinned_front_is_even_and_has_its_ends() {
        let mut objectives: Vec<[f64; 2]> = (0..=20).map(|at| f64::from(at) / 20.0).map(|x| [x, 1.0 - x]).collect();
        objectives.extend((1..400).map(|at| 0.5 + f64::from(at) * 1e-4).map(|x| [x, 1.0 - x]));
        let slices: Vec<&[f64]> = objectives.iter().map(|point| &point[..]).collect();
        let mut kept: Vec<f64> = even(&slices, 11).into_iter().map(|at| objectives[at][0]).collect();
        kept.sort_by(f64::total_cmp);
        assert_eq!((kept[0], kept[10]), (0.0, 1.0));
        assert!(kept.windows(2).all(|pair| (0.04..0.2).contains(&(pair[1] - pair[0]))), "{kept:?}");
    }

    #[test]
    fn an_archive_keeps_what_nobody_dominates_once() {
        let found = front(&members(&[[3.0, 3.0], [1.0, 4.0], [2.0, 2.0], [2.0, 2.0], [4.0, 1.0], [4.0, 1.5]]));
        assert_eq!(found.iter().map(|member| member.point[0]).collect::<Vec<_>>(), [1.0, 2.0, 4.0]);
        let broken = Member { point: vec![0.0], evaluation: evaluation([0.0, 0.0], &[-1.0]) };
        assert!(front(&[broken]).is_empty());
    }

    #[test]
    fn the_balanced_point_is_nearest_to_the_best_of_everything_whatever_the_units() {
        for unit in [1.0, 1e-6] {
            let front = members(&[[0.0, 10.0 * unit], [1.0, 2.0 * unit], [4.0, unit], [9.0, 0.0]]);
            assert_eq!(balanced(&front).unwrap().point, [1.0]);
        }
        assert!(balanced(&[]).is_none());
    }
}
