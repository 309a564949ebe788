//! NSGA-II: a population that is pressed towards the front of several objectives and kept even along it.
//!
//! Source: Deb, Pratap, Agarwal, Meyarivan, IEEE Trans. Evol. Comput. 6 (2002) 182: fronts with constrained domination,
//! tournaments by front and crowding, survivors of parents and children together. Children by simulated binary crossover
//! (Deb and Agrawal, Complex Systems 9 (1995) 115) and polynomial mutation (Deb and Goyal, Computer Science and Informatics
//! 26 (1996) 30), both bounded as in Deb, An efficient constraint handling method (2000), appendix. The last front that has
//! room is pruned point by point (`pareto.rs`), which leaves it more even than the article's cut by one look at the
//! distances. The first population is a Latin hypercube. Must not know: what variables and objectives mean.

use chacha20::ChaCha8Rng;

use super::constraints::Evaluation;
use super::latin_hypercube;
use super::pareto::{Standing, crowding, even, ranks};
use super::random::{below, chance, permutation, uniform};
use super::search::Reason;
use super::{Foreseen, Fronts, Method, Strategy, points_held};
use declare::Declared;
use declare::error::Diagnostic;
use declare::seed::Seed;

/// evolution towards the front of several objectives
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "nsga2")]
pub struct Nsga2 {
    /// individuals per generation
    #[declared(minimum = 4, maximum = 10_000, default = "100")]
    pub population: usize,
    /// generations, the first one included
    #[declared(minimum = 1, maximum = 1_000_000, default = "200")]
    pub generations: usize,
    /// probability that two parents are crossed
    #[declared(minimum = 0.0, maximum = 1.0, default = "0.9")]
    pub crossover: f64,
    /// index of the crossover: the larger, the nearer children are to their parents
    #[declared(minimum = 0.0, maximum = 1000.0, default = "15")]
    pub crossover_index: f64,
    /// probability that a variable mutates; without it one in as many as there are variables
    #[declared(minimum = 0.0, maximum = 1.0, example = "0.25")]
    pub mutation: Option<f64>,
    /// index of the mutation: the larger, the smaller its steps
    #[declared(minimum = 0.0, maximum = 1000.0, default = "20")]
    pub mutation_index: f64,
}

/// Parents nearer to each other than this share of the range are one: there is nothing between them.
const ALIKE: f64 = 1e-14;

struct Nsga2Search {
    settings: Nsga2,
    /// Of a variable of a child.
    mutation: f64,
    seed: Seed,
    /// Empty until the first generation is told.
    parents: Vec<Parent>,
    batch: Vec<Vec<f64>>,
    told: usize,
}

#[derive(Clone)]
struct Parent {
    at: Vec<f64>,
    standing: Standing,
    objectives: Vec<f64>,
    rank: usize,
    crowding: f64,
}

impl Method for Nsga2 {
    fn foresee(&self, dimension: usize) -> Result<Foreseen, Diagnostic> {
        let evaluations = self.population.saturating_mul(self.generations);
        // Parents and children with whom they dominate, and a front that may hold all that was tried.
        let pairs = 16_usize.saturating_mul(self.population * self.population);
        let memory = points_held(4 * self.population, dimension).saturating_add(pairs);
        let memory = memory.saturating_add(points_held(evaluations, dimension));
        Ok(Foreseen { evaluations, batches: self.generations, exact: true, memory })
    }

    fn finds_fronts(&self) -> bool {
        true
    }

    fn strategy(&self, dimension: usize, seed: Seed) -> Box<dyn Strategy> {
        Box::new(Nsga2Search {
            settings: self.clone(),
            mutation: self.mutation.unwrap_or(1.0 / dimension as f64),
            batch: latin_hypercube::points(self.population, dimension, &mut seed.generator(0)),
            seed,
            parents: Vec::new(),
            told: 0,
        })
    }
}

impl Strategy for Nsga2Search {
    fn batch(&self) -> &[Vec<f64>] {
        &self.batch
    }

    fn learn(&mut self, values: &[f64]) -> Result<(), String> {
        self.learn_all(&values.iter().copied().map(Evaluation::from).collect::<Vec<_>>());
        Ok(())
    }

    fn finished(&self) -> Option<Reason> {
        (self.told >= self.settings.generations).then_some(Reason::Generations)
    }

    fn budget(&self) -> usize {
        self.settings.population * self.settings.generations
    }

    fn fronts(&mut self) -> Option<&mut dyn Fronts> {
        Some(self)
    }
}

impl Fronts for Nsga2Search {
    fn learn_all(&mut self, evaluations: &[Evaluation]) {
        let children = self.batch.drain(..).zip(evaluations).map(|(at, evaluation)| Parent {
            at,
            standing: Standing::new(evaluation),
            objectives: evaluation.objectives().collect(),
            rank: 0,
            crowding: 0.0,
        });
        self.parents.extend(children);
        self.survive();
        self.told += 1;
        if self.finished().is_none() {
            self.batch = self.children();
        }
    }
}

impl Nsga2Search {
    /// The best fronts as a whole, of the last one what is even; each with its front and how crowded it is there.
    fn survive(&mut self) {
        let standings: Vec<Standing> = self.parents.iter().map(|parent| parent.standing.clone()).collect();
        let ranks = ranks(&standings);
        let mut survivors: Vec<Parent> = Vec::with_capacity(self.settings.population);
        for rank in 0.. {
            let room = self.settings.population - survivors.len();
            let front: Vec<usize> = (0..ranks.len()).filter(|at| ranks[*at] == rank).collect();
            if room == 0 || front.is_empty() {
                break;
            }
            let objectives: Vec<&[f64]> = front.iter().map(|at| &self.parents[*at].objectives[..]).collect();
            let kept = if front.len() > room { even(&objectives, room) } else { (0..front.len()).collect() };
            let distances = crowding(&kept.iter().map(|at| objectives[*at]).collect::<Vec<_>>());
            let of_front = kept.into_iter().zip(distances);
            survivors.extend(of_front.map(|(at, crowding)| Parent {
                rank,
                crowding,
                ..self.parents[front[at]].clone()
            }));
        }
        self.parents = survivors;
    }

    /// The next generation: each parent is in two tournaments, two winners have two children.
    fn children(&self) -> Vec<Vec<f64>> {
        let mut generator = self.seed.generator(self.told as u64);
        let size = self.settings.population;
        let mut winners = Vec::with_capacity(2 * size);
        while winners.len() < size + 1 {
            let order = permutation(&mut generator, self.parents.len());
            winners.extend(order.chunks_exact(2).map(|pair| self.winner(pair[0], pair[1])));
        }
        let mut children: Vec<Vec<f64>> = Vec::with_capacity(size + 1);
        for pair in winners.chunks_exact(2) {
            if children.len() >= size {
                break;
            }
            let parents = [pair[0], pair[1]].map(|at| &self.parents[at].at);
            for mut child in self.crossed(parents, &mut generator) {
                self.mutate(&mut child, &mut generator);
                if self.parents.iter().any(|parent| parent.at == child) {
                    // Nothing would be learned of it.
                    let axis = below(&mut generator, child.len());
                    child[axis] = self.mutated(child[axis], &mut generator);
                }
                children.push(child);
            }
        }
        children.truncate(size);
        children
    }

    fn winner(&self, first: usize, second: usize) -> usize {
        let (one, other) = (&self.parents[first], &self.parents[second]);
        let second_wins = other.rank < one.rank || (other.rank == one.rank && other.crowding > one.crowding);
        if second_wins { second } else { first }
    }

    fn crossed(&self, [one, other]: [&Vec<f64>; 2], generator: &mut ChaCha8Rng) -> [Vec<f64>; 2] {
        let mut children = [one.clone(), other.clone()];
        if !chance(generator, self.settings.crossover) {
            return children;
        }
        for axis in 0..one.len() {
            if !chance(generator, 0.5) {
                continue;
            }
            let (low, high) = (one[axis].min(other[axis]), one[axis].max(other[axis]));
            if high - low <= ALIKE {
                continue;
            }
            let draw = uniform(generator);
            // How far a child may lie beyond its parent, and how far it lies, in halves of their distance.
            let spread = |room: f64| {
                let power = self.settings.crossover_index + 1.0;
                let alpha = 2.0 - libm::pow(1.0 + 2.0 * room / (high - low), -power);
                let scaled = draw * alpha;
                libm::pow(if scaled <= 1.0 { scaled } else { 1.0 / (2.0 - scaled) }, 1.0 / power)
            };
            let middle = 0.5 * (low + high);
            let half = 0.5 * (high - low);
            let lower = (middle - spread(low) * half).clamp(0.0, 1.0);
            let upper = (middle + spread(1.0 - high) * half).clamp(0.0, 1.0);
            let swapped = chance(generator, 0.5);
            children[usize::from(swapped)][axis] = lower;
            children[usize::from(!swapped)][axis] = upper;
        }
        children
    }

    fn mutate(&self, child: &mut [f64], generator: &mut ChaCha8Rng) {
        for coordinate in child {
            if chance(generator, self.mutation) {
                *coordinate = self.mutated(*coordinate, generator);
            }
        }
    }

    fn mutated(&self, coordinate: f64, generator: &mut ChaCha8Rng) -> f64 {
        let power = self.settings.mutation_index + 1.0;
        let draw = uniform(generator);
        let step = if draw < 0.5 {
            libm::pow(2.0 * draw + (1.0 - 2.0 * draw) * libm::pow(1.0 - coordinate, power), 1.0 / power) - 1.0
        } else {
            let rest = 2.0 * (1.0 - draw);
            1.0 - libm::pow(rest + (1.0 - rest) * libm::pow(coordinate, power), 1.0 / power)
        };
        (coordinate + step).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn search(settings: Nsga2) -> Nsga2Search {
        Nsga2Search {
            settings,
            mutation: 1.0,
            seed: Seed::of_stage(1, "children"),
            parents: Vec::new(),
            batch: Vec::new(),
            told: 0,
        }
    }

    /// Tier: closed form. Without bounds in sight two children have the mean of their parents, and half of the distances are
    /// contracted: the spread β has the median 1 (Deb and Agrawal 1995, equation 9).
    #[test]
    fn children_keep_the_mean_of_their_parents_and_half_lie_between() {
        let search = search(Nsga2 { crossover: 1.0, ..Nsga2::default() });
        let (low, high) = (0.4999, 0.5001);
        let mut generator = Seed::of_stage(1, "crossed").generator(0);
        let (mut crossed, mut between) = (0_u32, 0_u32);
        for _ in 0..40_000 {
            let [one, other] = search.crossed([&vec![low], &vec![high]], &mut generator).map(|child| child[0]);
            assert!((one + other - 1.0).abs() < 1e-12);
            if (one - low).abs() > 1e-15 && (one - high).abs() > 1e-15 {
                crossed += 1;
                between += u32::from((one - 0.5).abs() < 1e-4);
            }
        }
        // Half of the variables are crossed: standard deviations of 100 and 71.
        assert!(crossed.abs_diff(20_000) < 400 && between.abs_diff(crossed / 2) < 300, "{crossed} {between}");
    }

    /// Tier: closed form. In the middle of the range the mean step is 1/(η + 2) of it, but for what the bounds take.
    #[test]
    fn mutations_are_as_large_as_their_index_says_and_stay_inside() {
        let search = search(Nsga2::default());
        let mut generator = Seed::of_stage(1, "mutated").generator(0);
        let steps: Vec<f64> = (0..40_000).map(|_| search.mutated(0.5, &mut generator) - 0.5).collect();
        let mean = steps.iter().map(|step| step.abs()).sum::<f64>() / 40_000.0;
        let drift = steps.iter().sum::<f64>() / 40_000.0;
        // Standard deviations of 2.2e-4 and 3.1e-4.
        assert!((mean - 1.0 / 22.0).abs() < 1e-3 && drift.abs() < 1.5e-3, "{mean} {drift}");
        for at in [0.0, 1e-300, 1.0 - f64::EPSILON, 1.0] {
            assert!((0..1000).all(|_| (0.0..=1.0).contains(&search.mutated(at, &mut generator))));
        }
    }
}
