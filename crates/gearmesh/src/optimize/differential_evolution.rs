//! Differential evolution with binomial crossover, mutants reflected into the cube, the whole generation at once; at the
//! end, if asked for, the best individual is polished by [`super::nelder_mead`].
//!
//! Source: Storn and Price, J. Global Optim. 11 (1997) 341, schemes rand/1/bin and current-to-best/1/bin; the first
//! population is a Latin hypercube. Must not know: what the variables mean.

use super::latin_hypercube;
use super::local::Limits;
use super::nelder_mead::SimplexSearch;
use super::random::{below, chance};
use super::restarts::Restarted;
use super::search::Reason;
use super::{Foreseen, Method, Strategy, points_held};
use declare::error::Diagnostic;
use declare::seed::Seed;
use declare::{Declared, Words};

/// global search by differences within a population
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "differential_evolution")]
pub struct DifferentialEvolution {
    /// individuals per generation; ten per variable is usual
    #[declared(minimum = 4, maximum = 100_000, default = "60")]
    pub population: usize,
    /// most generations, the first one included
    #[declared(minimum = 1, maximum = 1_000_000, default = "200")]
    pub generations: usize,
    /// how a mutant is made
    #[declared(default = "rand")]
    pub mutant: Mutant,
    /// F, the weight of a difference
    #[declared(minimum = 0.0, maximum = 2.0, default = "0.7")]
    pub weight: f64,
    /// CR, the probability that a variable is taken from the mutant
    #[declared(minimum = 0.0, maximum = 1.0, default = "0.9")]
    pub crossover: f64,
    /// spread of the values, as a share of the best, at which it has converged
    #[declared(minimum = 0.0, maximum = 1.0, default = "1e-8")]
    pub tolerance: f64,
    /// local search from the best individual
    #[declared(default = "none")]
    pub polish: Polish,
    /// most evaluations of the local search
    #[declared(minimum = 10, maximum = 10_000_000, default = "2000")]
    pub polish_evaluations: usize,
}

/// How a mutant is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum Mutant {
    /// a random individual plus one weighted difference: rand/1/bin
    Rand,
    /// moved towards the best, plus one difference: current-to-best/1/bin
    CurrentToBest,
}

/// Local search from the best individual.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum Polish {
    /// no local search
    None,
    /// a simplex as large as the last population
    NelderMead,
}

/// Extent at which the population or the polishing simplex has shrunk to a point, as a share of each range.
const POINT: f64 = 1e-10;

/// Largest and smallest edge of the polishing simplex, as a share of each range.
const EDGES: (f64, f64) = (1e-3, 0.1);

struct EvolutionSearch {
    settings: DifferentialEvolution,
    seed: Seed,
    population: Vec<Vec<f64>>,
    /// Empty until the first generation is told.
    values: Vec<f64>,
    trials: Vec<Vec<f64>>,
    told: usize,
    ended: Option<Reason>,
    polishing: Option<Restarted<SimplexSearch>>,
}

impl DifferentialEvolution {
    /// Evaluations of the polish, where there is one.
    fn polishing(&self) -> Option<usize> {
        match self.polish {
            Polish::None => None,
            Polish::NelderMead => Some(self.polish_evaluations),
        }
    }
}

impl Method for DifferentialEvolution {
    fn foresee(&self, dimension: usize) -> Result<Foreseen, Diagnostic> {
        if self.polishing().is_some_and(|evaluations| evaluations < dimension) {
            return Err(Diagnostic::new(format!("too few evaluations to polish {dimension} variables"))
                .of(Self::NAMES.polish_evaluations)
                .help(format!("give at least {dimension}")));
        }
        let polishing = self.polishing().unwrap_or(0);
        Ok(Foreseen {
            evaluations: self.population.saturating_mul(self.generations).saturating_add(polishing),
            batches: self.generations.saturating_add(polishing),
            exact: false,
            // Population, trials, and these in the box; the first time as a hypercube.
            memory: points_held(4 * self.population, dimension),
        })
    }

    fn unpolished(&self) -> Option<Box<dyn Method>> {
        Some(Box::new(Self { polish: Polish::None, ..self.clone() }))
    }

    fn strategy(&self, dimension: usize, seed: Seed) -> Box<dyn Strategy> {
        let population = latin_hypercube::points(self.population, dimension, &mut seed.generator(0));
        Box::new(EvolutionSearch {
            settings: self.clone(),
            seed,
            trials: population.clone(),
            population,
            values: Vec::new(),
            told: 0,
            ended: None,
            polishing: None,
        })
    }
}

impl Strategy for EvolutionSearch {
    fn batch(&self) -> &[Vec<f64>] {
        self.polishing.as_ref().map_or(&self.trials, |polishing| polishing.batch())
    }

    fn learn(&mut self, values: &[f64]) -> Result<(), String> {
        if let Some(polishing) = &mut self.polishing {
            return polishing.learn(values);
        }
        self.select(values);
        self.told += 1;
        self.ended = if self.converged() {
            Some(Reason::Converged)
        } else if self.told == self.settings.generations {
            Some(Reason::Generations)
        } else {
            self.trials = self.next_trials();
            None
        };
        if self.ended.is_some() {
            self.begin_polishing();
        }
        Ok(())
    }

    fn finished(&self) -> Option<Reason> {
        match &self.polishing {
            Some(polishing) => polishing.finished(),
            None => self.ended,
        }
    }

    fn budget(&self) -> usize {
        self.population.len() * self.settings.generations + self.settings.polishing().unwrap_or(0)
    }

    fn goes_on(&mut self) -> bool {
        if self.polishing.is_none() {
            self.begin_polishing();
            return self.polishing.is_some();
        }
        false
    }
}

impl EvolutionSearch {
    /// A trial replaces its parent unless it is worse: equal ones may drift across a plateau.
    fn select(&mut self, values: &[f64]) {
        if self.values.is_empty() {
            self.values = values.to_vec();
            return;
        }
        for (at, &value) in values.iter().enumerate() {
            if value <= self.values[at] {
                self.values[at] = value;
                std::mem::swap(&mut self.population[at], &mut self.trials[at]);
            }
        }
    }

    fn best(&self) -> usize {
        (1..self.values.len()).fold(0, |best, at| if self.values[at] < self.values[best] { at } else { best })
    }

    /// The largest distance of an individual from the best one, in the maximum norm.
    fn extent(&self) -> f64 {
        let best = &self.population[self.best()];
        self.population
            .iter()
            .flat_map(|individual| individual.iter().zip(best).map(|(a, b)| (a - b).abs()))
            .fold(0.0, f64::max)
    }

    fn converged(&self) -> bool {
        let lowest = self.values[self.best()];
        let highest = self.values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        highest - lowest <= self.settings.tolerance * lowest.abs() || self.extent() <= POINT
    }

    fn next_trials(&self) -> Vec<Vec<f64>> {
        let mut generator = self.seed.generator(self.told as u64);
        let (size, best) = (self.population.len(), self.best());
        (0..size)
            .map(|at| {
                let mut others = [at; 3];
                for drawn in 0..3 {
                    while others[drawn] == at || others[..drawn].contains(&others[drawn]) {
                        others[drawn] = below(&mut generator, size);
                    }
                }
                let [a, b, c] = others.map(|other| &self.population[other]);
                let (parent, best) = (&self.population[at], &self.population[best]);
                // One variable comes from the mutant in any case, or the trial could be its parent again.
                let certain = below(&mut generator, parent.len());
                (0..parent.len())
                    .map(|axis| {
                        if !chance(&mut generator, self.settings.crossover) && axis != certain {
                            return parent[axis];
                        }
                        reflect(if self.settings.mutant == Mutant::CurrentToBest {
                            parent[axis]
                                + self.settings.weight * (best[axis] - parent[axis])
                                + self.settings.weight * (a[axis] - b[axis])
                        } else {
                            a[axis] + self.settings.weight * (b[axis] - c[axis])
                        })
                    })
                    .collect()
            })
            .collect()
    }

    fn begin_polishing(&mut self) {
        let best = self.best();
        if let Some(evaluations) = self.settings.polishing()
            && self.values[best].is_finite()
        {
            let edge = self.extent().clamp(EDGES.0, EDGES.1);
            let limits = Limits { tolerance: POINT, restarts: 3, evaluations };
            let start = self.population[best].clone();
            let simplex = SimplexSearch::new(start, Some(self.values[best]), edge, POINT);
            self.polishing = Some(Restarted::new(simplex, edge, limits));
        }
    }
}

/// Mirrors a coordinate at 0 and 1 as often as it takes.
fn reflect(coordinate: f64) -> f64 {
    if (0.0..=1.0).contains(&coordinate) {
        return coordinate;
    }
    let folded = coordinate.rem_euclid(2.0);
    if folded > 1.0 { 2.0 - folded } else { folded }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A search of one variable, with a tolerance of 1 %.
    fn search(population: [f64; 3], values: [f64; 3], trials: [f64; 3]) -> EvolutionSearch {
        EvolutionSearch {
            settings: DifferentialEvolution { tolerance: 0.01, ..DifferentialEvolution::default() },
            seed: Seed::of_stage(1, "select"),
            population: population.map(|x| vec![x]).to_vec(),
            values: values.to_vec(),
            trials: trials.map(|x| vec![x]).to_vec(),
            told: 1,
            ended: None,
            polishing: None,
        }
    }

    #[test]
    fn a_trial_replaces_its_parent_unless_it_is_worse() {
        let mut search = search([0.1, 0.2, 0.3], [1.0, 2.0, 3.0], [0.4, 0.5, 0.6]);
        assert_eq!(search.best(), 0);
        search.select(&[1.5, 2.0, 0.5]);
        assert_eq!(search.population, [[0.1], [0.5], [0.6]]);
        assert_eq!(search.values, [1.0, 2.0, 0.5]);
        assert_eq!(search.best(), 2);
    }

    #[test]
    fn it_has_converged_where_all_values_or_all_places_are_one() {
        let (apart, alike) = ([0.1, 0.5, 0.9], [2.0, 2.019, 2.001]);
        let converged = |population, values| search(population, values, [0.0; 3]).converged();
        assert!(converged(apart, alike) && converged(apart, alike.map(|value| value - 4.03)));
        assert!(!converged(apart, [2.0, 2.021, 2.001]) && !converged(apart, [-2.0, -1.979, -2.0]));
        let (near, far) = ([0.5, 0.5 + 4e-11, 0.5 - 9e-11], [0.5, 0.5 + 4e-11, 0.5 - 1.1e-10]);
        let unlike = [1.0, 2.0, 3.0];
        assert!(converged(near, unlike) && !converged(far, unlike));
    }

    #[test]
    fn reflection_mirrors_and_stays_inside() {
        for (outside, inside) in [(0.25, 0.25), (-0.25, 0.25), (1.25, 0.75), (2.25, 0.25), (-1.25, 0.75), (3.5, 0.5)] {
            assert_eq!(reflect(outside).to_bits(), f64::to_bits(inside), "{outside}");
        }
        for outside in [-1e-20, -f64::MIN_POSITIVE, 1.0 + f64::EPSILON, 2.0, -2.0, 3.0] {
            assert!((0.0..=1.0).contains(&reflect(outside)), "{outside}");
        }
    }
}
