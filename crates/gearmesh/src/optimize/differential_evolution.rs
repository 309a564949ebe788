//! Differential evolution with binomial crossover, mutants reflected into the cube, the whole generation at once; at the
//! end, if asked for, the best individual is polished by [`super::nelder_mead`].
//!
//! Source: Storn and Price, J. Global Optim. 11 (1997) 341, schemes rand/1/bin and current-to-best/1/bin; the first
//! population is a Latin hypercube. Must not know: what the variables mean.

use super::latin_hypercube;
use super::local::Limits;
use super::nelder_mead::NelderMead;
use super::random::{below, chance};
use super::restarts::Restarted;
use super::search::Reason;
use super::{Foreseen, Method, Strategy, count, points_held};
use declare::error::Diagnostic;
use declare::parameter::{Choice, Field, Member};
use declare::record::Record;
use declare::seed::Seed;

pub const METHOD: Method = Method {
    member: Member {
        name: "differential_evolution",
        summary: "global search by differences within a population",
        fields: FIELDS,
    },
    foresee,
    build,
};

const FIELDS: &[Field] = &[
    Field::integer("population", 4, 100_000, "individuals per generation; ten per variable is usual").default("60"),
    Field::integer("generations", 1, 1_000_000, "most generations, the first one included").default("200"),
    Field::choice("mutant", MUTANTS, "how a mutant is made").default("rand"),
    Field::number("weight", 0.0, 2.0, "F, the weight of a difference").default("0.7"),
    Field::number("crossover", 0.0, 1.0, "CR, the probability that a variable is taken from the mutant").default("0.9"),
    Field::number("tolerance", 0.0, 1.0, "spread of the values, as a share of the best, at which it has converged")
        .default("1e-8"),
    Field::choice("polish", POLISHES, "local search from the best individual").default("none"),
    Field::integer("polish_evaluations", 10, 10_000_000, "most evaluations of the local search").default("2000"),
];

const MUTANTS: &[Choice] = &[
    Choice { name: "rand", summary: "a random individual plus one weighted difference: rand/1/bin" },
    Choice { name: "current_to_best", summary: "moved towards the best, plus one difference: current-to-best/1/bin" },
];

const POLISHES: &[Choice] = &[
    Choice { name: "none", summary: "no local search" },
    Choice { name: "nelder_mead", summary: "a simplex as large as the last population" },
];

/// Extent at which the population or the polishing simplex has shrunk to a point, as a share of each range.
const POINT: f64 = 1e-10;

/// Largest and smallest edge of the polishing simplex, as a share of each range.
const EDGES: (f64, f64) = (1e-3, 0.1);

struct DifferentialEvolution {
    seed: Seed,
    generations: usize,
    towards_best: bool,
    weight: f64,
    crossover: f64,
    tolerance: f64,
    polish: Option<usize>,

    population: Vec<Vec<f64>>,
    /// Empty until the first generation is told.
    values: Vec<f64>,
    trials: Vec<Vec<f64>>,
    told: usize,
    ended: Option<Reason>,
    polishing: Option<Restarted<NelderMead>>,
}

/// Evaluations of the polish, where there is one.
fn polish(record: &Record) -> Option<usize> {
    (record.choice("polish") == "nelder_mead").then(|| count(record, "polish_evaluations"))
}

fn foresee(record: &Record, dimension: usize) -> Result<Foreseen, Diagnostic> {
    let polish = polish(record);
    if polish.is_some_and(|evaluations| evaluations < dimension) {
        return Err(Diagnostic::new(format!("too few evaluations to polish {dimension} variables"))
            .at(record.place_of("polish_evaluations"))
            .help(format!("give at least {dimension}")));
    }
    let (size, generations) = (count(record, "population"), count(record, "generations"));
    let polishing = polish.unwrap_or(0);
    Ok(Foreseen {
        evaluations: size.saturating_mul(generations).saturating_add(polishing),
        batches: generations.saturating_add(polishing),
        exact: false,
        // Population, trials, and these in the box; the first time as a hypercube.
        memory: points_held(4 * size, dimension),
    })
}

fn build(record: &Record, dimension: usize, seed: Seed) -> Box<dyn Strategy> {
    let population = latin_hypercube::points(count(record, "population"), dimension, &mut seed.generator(0));
    let polish = polish(record);
    Box::new(DifferentialEvolution {
        seed,
        generations: count(record, "generations"),
        towards_best: record.choice("mutant") == "current_to_best",
        weight: record.number("weight"),
        crossover: record.number("crossover"),
        tolerance: record.number("tolerance"),
        polish,
        trials: population.clone(),
        population,
        values: Vec::new(),
        told: 0,
        ended: None,
        polishing: None,
    })
}

impl Strategy for DifferentialEvolution {
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
        } else if self.told == self.generations {
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
        self.population.len() * self.generations + self.polish.unwrap_or(0)
    }
}

impl DifferentialEvolution {
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
        highest - lowest <= self.tolerance * lowest.abs() || self.extent() <= POINT
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
                        if !chance(&mut generator, self.crossover) && axis != certain {
                            return parent[axis];
                        }
                        reflect(if self.towards_best {
                            parent[axis] + self.weight * (best[axis] - parent[axis]) + self.weight * (a[axis] - b[axis])
                        } else {
                            a[axis] + self.weight * (b[axis] - c[axis])
                        })
                    })
                    .collect()
            })
            .collect()
    }

    fn begin_polishing(&mut self) {
        let best = self.best();
        if let Some(evaluations) = self.polish
            && self.values[best].is_finite()
        {
            let edge = self.extent().clamp(EDGES.0, EDGES.1);
            let limits = Limits { tolerance: POINT, restarts: 3, evaluations };
            let start = self.population[best].clone();
            let simplex = NelderMead::new(start, Some(self.values[best]), edge, POINT);
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

    #[test]
    fn a_trial_replaces_its_parent_unless_it_is_worse() {
        let mut search = DifferentialEvolution {
            seed: Seed::of_stage(1, "select"),
            generations: 1,
            towards_best: false,
            weight: 0.7,
            crossover: 0.9,
            tolerance: 0.0,
            polish: None,
            population: vec![vec![0.1], vec![0.2], vec![0.3]],
            values: vec![1.0, 2.0, 3.0],
            trials: vec![vec![0.4], vec![0.5], vec![0.6]],
            told: 1,
            ended: None,
            polishing: None,
        };
        search.select(&[1.5, 2.0, 0.5]);
        assert_eq!(search.population, [[0.1], [0.5], [0.6]]);
        assert_eq!(search.values, [1.0, 2.0, 0.5]);
        assert_eq!(search.best(), 2);
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
