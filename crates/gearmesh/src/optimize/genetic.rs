//! The genetic algorithm of the article `energy_ga`: binary chromosomes, roulette selection, one-point crossover,
//! mutation, and a new population that replaces the old.
//!
//! Where the article leaves a choice, both readings are options and the first is the default: mutation strikes an
//! offspring, flipping one of its bits, or strikes each bit; bits count in plain binary or in Gray code.
//!
//! Fitness is 1/objective, as f_min/f: the same shares of the wheel, and no overflow. So a negative objective is refused;
//! individuals at exactly 0 share the whole wheel (the limit of 1/f); inadmissible ones (+∞) have no share, and when all
//! are inadmissible the wheel is even. Tournament selection compares only, and takes any sign.
//!
//! Must not know: what the variables mean.

use chacha20::ChaCha8Rng;

use super::random::{below, chance, uniform};
use super::search::Reason;
use super::{Foreseen, Method, Strategy, points_held};
use declare::error::Diagnostic;
use declare::seed::Seed;
use declare::{Declared, Words};

/// genetic algorithm on binary chromosomes
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "genetic")]
pub struct Genetic {
    /// individuals per generation
    #[declared(minimum = 2, maximum = 100_000, default = "100")]
    pub population: usize,
    /// generations, the first random one included
    #[declared(minimum = 1, maximum = 1_000_000, default = "100")]
    pub generations: usize,
    /// bits per variable: its range in 2^bits values, bounds included
    #[declared(minimum = 1, maximum = 32, default = "10")]
    pub bits: usize,
    /// how bits stand for a number
    #[declared(default = "binary")]
    pub coding: Coding,
    /// how parents are chosen
    #[declared(default = "roulette")]
    pub selection: Selection,
    /// probability that two parents exchange what follows a random cut
    #[declared(minimum = 0.0, maximum = 1.0, default = "0.5")]
    pub crossover: f64,
    /// probability of a mutation
    #[declared(minimum = 0.0, maximum = 1.0, default = "0.5")]
    pub mutation: f64,
    /// what the probability of a mutation is of
    #[declared(default = "offspring")]
    pub mutation_of: MutationOf,
    /// best individuals that live on unchanged
    #[declared(minimum = 0, maximum = 100_000, default = "0")]
    pub elite: usize,
    /// ends after this many generations without improvement
    #[declared(minimum = 1, maximum = 1_000_000, example = "20")]
    pub converged_after: Option<usize>,
    /// share of the best value below which a gain is not an improvement
    #[declared(minimum = 0.0, maximum = 1.0, default = "0")]
    pub least_improvement: f64,
}

/// How bits stand for a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum Coding {
    /// plain binary
    Binary,
    /// Gray code: neighbouring values differ in one bit
    Gray,
}

/// How parents are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum Selection {
    /// in proportion to fitness, 1/objective
    Roulette,
    /// the better of two drawn at random
    Tournament,
}

/// What the probability of a mutation is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum MutationOf {
    /// one random bit of an offspring flips, with this probability
    Offspring,
    /// every bit flips with this probability
    Bit,
}

type Chromosome = Vec<bool>;

struct GeneticSearch {
    settings: Genetic,
    seed: Seed,
    population: Vec<Chromosome>,
    batch: Vec<Vec<f64>>,
    /// Generations told.
    told: usize,
    best: f64,
    /// Generations since the last improvement.
    stalled: usize,
}

impl Method for Genetic {
    fn foresee(&self, dimension: usize) -> Result<Foreseen, Diagnostic> {
        let (size, elite) = (self.population, self.elite);
        if elite >= size {
            let message = format!("an elite of {elite} leaves no room for offspring in a population of {size}");
            let help = format!("the elite may be 0 to {} here", size.saturating_sub(1));
            return Err(Diagnostic::new(message).of(Self::NAMES.elite).help(help));
        }
        // Two generations of chromosomes, one decoded twice: here and in the box.
        let memory = size * 2 * (self.bits * dimension + 40) + points_held(2 * size, dimension);
        let exact = self.converged_after.is_none();
        let evaluations = size.saturating_mul(self.generations);
        Ok(Foreseen { evaluations, batches: self.generations, exact, memory })
    }

    fn strategy(&self, dimension: usize, seed: Seed) -> Box<dyn Strategy> {
        let mut generator = seed.generator(0);
        let mut chromosome = || (0..self.bits * dimension).map(|_| chance(&mut generator, 0.5)).collect();
        let mut search = GeneticSearch {
            settings: self.clone(),
            seed,
            population: (0..self.population).map(|_| chromosome()).collect(),
            batch: Vec::new(),
            told: 0,
            best: f64::INFINITY,
            stalled: 0,
        };
        search.decode_all();
        Box::new(search)
    }
}

impl Strategy for GeneticSearch {
    fn batch(&self) -> &[Vec<f64>] {
        &self.batch
    }

    fn learn(&mut self, values: &[f64]) -> Result<(), String> {
        if self.settings.selection == Selection::Roulette
            && let Some(negative) = values.iter().find(|value| **value < 0.0)
        {
            return Err(format!(
                "roulette selection takes 1/objective for fitness, so the objective must be at least 0, not {negative}; \
                 `selection: tournament` takes any"
            ));
        }
        let lowest = values.iter().copied().fold(f64::INFINITY, f64::min);
        let gain = self.best - lowest;
        // From +∞ any number is a gain; +∞ − +∞ is NaN and none.
        let improved =
            gain > 0.0 && (self.best.is_infinite() || gain >= self.settings.least_improvement * self.best.abs());
        self.stalled = if improved { 0 } else { self.stalled + 1 };
        self.best = self.best.min(lowest);
        self.told += 1;
        if self.finished().is_none() {
            self.population = self.offspring(values);
            self.decode_all();
        }
        Ok(())
    }

    fn finished(&self) -> Option<Reason> {
        if self.told >= self.settings.generations {
            Some(Reason::Generations)
        } else if self.settings.converged_after.is_some_and(|patience| self.stalled >= patience) {
            Some(Reason::Converged)
        } else {
            None
        }
    }

    fn budget(&self) -> usize {
        self.population.len() * self.settings.generations
    }
}

impl GeneticSearch {
    fn decode_all(&mut self) {
        let (bits, coding) = (self.settings.bits, self.settings.coding);
        self.batch = self.population.iter().map(|chromosome| decode(chromosome, bits, coding)).collect();
    }

    /// The generation after the one with these values: the elite, then children in pairs.
    fn offspring(&self, values: &[f64]) -> Vec<Chromosome> {
        let mut generator = self.seed.generator(self.told as u64);
        let size = self.population.len();
        let mut next = Vec::with_capacity(size + 1);
        if self.settings.elite > 0 {
            let mut order: Vec<usize> = (0..size).collect();
            order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
            next.extend(order[..self.settings.elite].iter().map(|at| self.population[*at].clone()));
        }
        let wheel = Wheel::new(values);
        while next.len() < size {
            let mut parent = || {
                let at = match self.settings.selection {
                    Selection::Roulette => wheel.spin(&mut generator),
                    Selection::Tournament => tournament(values, &mut generator),
                };
                self.population[at].clone()
            };
            let mut pair = [parent(), parent()];
            cross(&mut pair, self.settings.crossover, &mut generator);
            for mut child in pair {
                mutate(&mut child, self.settings.mutation, self.settings.mutation_of, &mut generator);
                next.push(child);
            }
        }
        // An odd number of places leaves out the last pair's second child.
        next.truncate(size);
        next
    }
}

fn mutate(child: &mut Chromosome, probability: f64, of: MutationOf, generator: &mut ChaCha8Rng) {
    match of {
        MutationOf::Bit => child.iter_mut().for_each(|bit| *bit ^= chance(generator, probability)),
        MutationOf::Offspring => {
            if chance(generator, probability) {
                let at = below(generator, child.len());
                child[at] = !child[at];
            }
        }
    }
}

/// Each variable's bits, most significant first, as a share of the largest number: all zeros is 0, and all ones (in Gray
/// code: a one and zeros) is 1.
fn decode(chromosome: &[bool], bits: usize, coding: Coding) -> Vec<f64> {
    let maximum = (1_u64 << bits) - 1;
    chromosome
        .chunks_exact(bits)
        .map(|gene| {
            let (number, _) = gene.iter().fold((0_u64, false), |(number, above), &bit| {
                let digit = match coding {
                    Coding::Gray => bit ^ above,
                    Coding::Binary => bit,
                };
                (number << 1 | u64::from(digit), digit)
            });
            number as f64 / maximum as f64
        })
        .collect()
}

/// With the given probability exchanges what follows a cut, uniform over the places between two bits.
fn cross(pair: &mut [Chromosome; 2], probability: f64, generator: &mut ChaCha8Rng) {
    let places = pair[0].len() - 1;
    if places > 0 && chance(generator, probability) {
        let cut = 1 + below(generator, places);
        let [first, second] = pair;
        first[cut..].swap_with_slice(&mut second[cut..]);
    }
}

fn tournament(values: &[f64], generator: &mut ChaCha8Rng) -> usize {
    let (first, second) = (below(generator, values.len()), below(generator, values.len()));
    if values[second] < values[first] { second } else { first }
}

/// The roulette wheel: where each individual's sector ends.
struct Wheel(Vec<f64>);

impl Wheel {
    /// `values` are at least 0, or +∞.
    fn new(values: &[f64]) -> Self {
        let lowest = values.iter().copied().fold(f64::INFINITY, f64::min);
        let share = |value: f64| {
            if lowest.is_infinite() || value <= lowest { 1.0 } else { lowest / value }
        };
        let mut end = 0.0;
        Self(
            values
                .iter()
                .map(|value| {
                    end += share(*value);
                    end
                })
                .collect(),
        )
    }

    fn spin(&self, generator: &mut ChaCha8Rng) -> usize {
        let total = self.0.last().copied().unwrap_or(0.0);
        let ball = uniform(generator) * total;
        // The product can round up to the total only where the last sector ends.
        self.0.partition_point(|end| *end <= ball).min(self.0.len() - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn generator(name: &str) -> ChaCha8Rng {
        Seed::of_stage(11, name).generator(0)
    }

    /// Pearson's statistic of `spins` against the shares 1/value, and the counts.
    fn spin_many(values: &[f64], spins: usize) -> (Vec<usize>, f64) {
        let (wheel, mut generator) = (Wheel::new(values), generator("wheel"));
        let mut counts = vec![0; values.len()];
        for _ in 0..spins {
            counts[wheel.spin(&mut generator)] += 1;
        }
        let total: f64 = values.iter().map(|value| 1.0 / value).sum();
        let square = values
            .iter()
            .zip(&counts)
            .map(|(value, count)| {
                let expected = spins as f64 / value / total;
                (*count as f64 - expected).powi(2) / expected
            })
            .sum();
        (counts, square)
    }

    #[test]
    fn the_wheel_gives_shares_of_inverse_values() {
        // 4 degrees of freedom: 99.9 % of true wheels stay below 18.47.
        let (_, square) = spin_many(&[0.414, 0.728, 2.316, 1.0, 5.0], 200_000);
        assert!(square < 18.47, "{square}");
    }

    #[test]
    fn zeros_share_the_wheel_and_inadmissible_ones_have_no_part() {
        let (counts, _) = spin_many(&[0.0, 1e-300, f64::INFINITY, 0.0, 2.0], 20_000);
        assert_eq!((counts[1], counts[2], counts[4]), (0, 0, 0));
        // Binomial(20000, 1/2): a standard deviation of 70.7.
        assert!(counts[0].abs_diff(10_000) < 283, "{counts:?}");
        let (counts, _) = spin_many(&[f64::INFINITY; 4], 20_000);
        // Binomial(20000, 1/4): 61.2.
        assert!(counts.iter().all(|count| count.abs_diff(5_000) < 245), "{counts:?}");
        // 1/5e-324 would overflow.
        let (counts, _) = spin_many(&[5e-324, 1e-323], 30_000);
        assert!(counts[0].abs_diff(20_000) < 327, "{counts:?}");
    }

    #[test]
    fn one_point_crossover_keeps_every_bit_in_its_place_and_cuts_evenly() {
        let mut generator = generator("cross");
        let (length, pairs) = (8, 70_000);
        let mut cuts = vec![0_usize; length];
        for _ in 0..pairs {
            let mut pair = [vec![false; length], vec![true; length]];
            cross(&mut pair, 0.5, &mut generator);
            // Where one child has the first parent's bit the other has the second's.
            assert!(pair[0].iter().zip(&pair[1]).all(|(a, b)| a != b));
            let cut = pair[0].iter().position(|bit| *bit).unwrap_or(0);
            assert!(pair[0][..cut].iter().all(|bit| !bit) && (cut == 0 || pair[0][cut..].iter().all(|bit| *bit)));
            cuts[cut] += 1;
        }
        // Half are not crossed (binomial, deviation 132); the others are cut at 7 places (deviation 70 each).
        assert!(cuts[0].abs_diff(35_000) < 529, "{cuts:?}");
        assert!(cuts[1..].iter().all(|count| count.abs_diff(5_000) < 280), "{cuts:?}");
        let mut single = [vec![true], vec![false]];
        cross(&mut single, 1.0, &mut generator);
        assert_eq!(single, [vec![true], vec![false]]);
    }

    #[test]
    fn mutation_strikes_as_often_and_as_evenly_as_it_should() {
        let (length, children) = (8, 40_000);
        let strike = |probability, of: MutationOf| {
            let mut generator = generator("mutate");
            let (mut struck, mut flips) = (0_usize, vec![0_usize; length]);
            for _ in 0..children {
                let mut child = vec![false; length];
                mutate(&mut child, probability, of, &mut generator);
                struck += usize::from(child.contains(&true));
                assert!(of == MutationOf::Bit || child.iter().filter(|bit| **bit).count() <= 1);
                flips.iter_mut().zip(child).for_each(|(flips, bit)| *flips += usize::from(bit));
            }
            (struck, flips)
        };
        // One offspring in two; each bit in one of sixteen. Binomial deviations 100 and 48.
        let (struck, flips) = strike(0.5, MutationOf::Offspring);
        assert!(struck.abs_diff(20_000) < 400, "{struck}");
        assert!(flips.iter().all(|flips| flips.abs_diff(2_500) < 192), "{flips:?}");
        // Each bit one time in ten: deviation 60. Some bit in 1 − 0.9⁸ = 0.56953 of the children: deviation 99.
        let (struck, flips) = strike(0.1, MutationOf::Bit);
        assert!(flips.iter().all(|flips| flips.abs_diff(4_000) < 240), "{flips:?}");
        assert!(struck.abs_diff(22_781) < 396, "{struck}");
        assert_eq!((strike(0.0, MutationOf::Offspring).0, strike(0.0, MutationOf::Bit).0), (0, 0));
        assert_eq!(
            (strike(1.0, MutationOf::Offspring).0, strike(1.0, MutationOf::Bit).1),
            (children, vec![children; length])
        );
        // Ones become zeros as zeros become ones.
        let mut ones = vec![true; length];
        mutate(&mut ones, 1.0, MutationOf::Bit, &mut generator("mutate"));
        assert_eq!(ones, vec![false; length]);
    }

    /// What a setting is for, seen from outside: without mutation only crossing makes a child that is not a parent.
    #[test]
    fn the_probability_of_crossing_is_the_one_that_was_set() {
        let unlike_parents = |crossover| {
            let settings = Genetic { population: 4000, bits: 20, mutation: 0.0, crossover, ..Genetic::default() };
            let mut search = settings.strategy(2, Seed::of_stage(11, "crossing"));
            let parents = search.batch().to_vec();
            search.learn(&vec![1.0; parents.len()]).unwrap();
            search.batch().iter().filter(|child| !parents.contains(child)).count()
        };
        assert_eq!(unlike_parents(0.0), 0);
        // A cut at one of 39 places leaves a child as its parent was when all bits on one side of it agree: 1/2 at the first
        // place, 1/4 at the second, and so from the other end, together 2/39. Binomial in pairs: deviations 38 and 20.
        let [quarter, all] = [0.25, 1.0].map(unlike_parents);
        assert!(quarter.abs_diff(949) < 152 && all.abs_diff(3795) < 80, "{quarter}, {all}");
    }

    #[test]
    fn a_gain_counts_as_a_share_of_the_best_value() {
        let gains = |from: f64, to: f64| {
            let (selection, converged_after) = (Selection::Tournament, Some(1));
            let settings =
                Genetic { population: 2, least_improvement: 0.1, selection, converged_after, ..Genetic::default() };
            let mut search = settings.strategy(1, Seed::of_stage(11, "gain"));
            search.learn(&[from, from]).unwrap();
            assert_eq!(search.finished(), None);
            search.learn(&[to, from]).unwrap();
            search.finished().is_none()
        };
        for scale in [1e-3, 1.0, 1e3, -1e3] {
            assert!(gains(scale, scale - 0.101 * scale.abs()) && !gains(scale, scale - 0.099 * scale.abs()), "{scale}");
        }
    }

    #[test]
    fn codes_end_on_the_bounds_and_gray_neighbours_differ_in_one_bit() {
        for bits in [1, 10, 32] {
            assert_eq!(decode(&vec![false; bits], bits, Coding::Binary), [0.0]);
            assert_eq!(decode(&vec![true; bits], bits, Coding::Binary), [1.0]);
            let mut top = vec![false; bits];
            top[0] = true;
            assert_eq!(decode(&top, bits, Coding::Gray), [1.0]);
        }
        let chromosome = |number: u32| (0..4).rev().map(|bit| number >> bit & 1 == 1).collect::<Chromosome>();
        assert_eq!(decode(&chromosome(5), 4, Coding::Binary), [5.0 / 15.0]);
        for number in 0..16_u32 {
            assert_eq!(decode(&chromosome(number ^ (number >> 1)), 4, Coding::Gray), [f64::from(number) / 15.0]);
        }
        assert_eq!(decode(&[true, true, false, true], 2, Coding::Binary), [1.0, 1.0 / 3.0]);
    }
}
