//! Nelder and Mead's simplex with coefficients that suit the number of variables, clipped to the cube, restarted.
//!
//! Sources: Nelder and Mead, Computer Journal 7 (1965) 308; coefficients ρ = 1, χ = 1 + 2/n, ψ = 3/4 − 1/(2n),
//! σ = 1 − 1/n of Gao and Han, Comput. Optim. Appl. 51 (2012) 259, section 4 (for n = 1 those of n = 2, since σ would be
//! 0). A simplex may be pressed flat against a bound, or stall: what becomes of one that has converged, `restarts.rs`
//! says. Sure for up to five variables; where from six on several lie on a bound at once it may use up its evaluations,
//! and differential evolution is the better choice. Lengths are shares of each variable's range.
//!
//! Must not know: randomness, but for a random start.

use super::local::{self, Limits, Search, Start, clip};
use super::restarts::Restarted;
use super::search::Reason;
use super::{Foreseen, Method, Strategy};
use declare::Declared;
use declare::error::Diagnostic;
use declare::seed::Seed;

/// local search by a moving simplex, without derivatives
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "nelder_mead")]
pub struct NelderMead {
    /// where it starts
    #[declared(default = "centre")]
    pub start: Start,
    /// edge of the first simplex, as a share of each range
    #[declared(minimum = 1e-6, maximum = 1.0, default = "0.1")]
    pub edge: f64,
    /// the simplex's extent, as a share of each range, at which it has converged
    #[declared(minimum = 1e-14, maximum = 0.1, default = "1e-8")]
    pub tolerance: f64,
    /// most restarts around the best point, or along a kink; with 0 it is not checked
    #[declared(minimum = 0, maximum = 1000, default = "30")]
    pub restarts: usize,
    /// most evaluations
    #[declared(minimum = 10, maximum = 10_000_000, default = "5000")]
    pub evaluations: usize,
}

impl Method for NelderMead {
    fn foresee(&self, dimension: usize) -> Result<Foreseen, Diagnostic> {
        let foreseen = local::foresee(self.evaluations, dimension, (dimension + 1, "a simplex in"));
        foreseen.map_err(|wrong| wrong.of(Self::NAMES.evaluations))
    }

    fn strategy(&self, dimension: usize, seed: Seed) -> Box<dyn Strategy> {
        let limits = Limits { tolerance: self.tolerance, restarts: self.restarts, evaluations: self.evaluations };
        let start = self.start.point(dimension, seed);
        Box::new(Restarted::new(SimplexSearch::new(start, None, self.edge, self.tolerance), self.edge, limits))
    }
}

#[derive(Clone, Debug)]
struct Vertex {
    at: Vec<f64>,
    value: f64,
}

/// What the values of the current batch are for.
enum Step {
    /// The vertices of a new simplex.
    Begin,
    Reflect,
    Expand {
        reflected: Vertex,
    },
    /// Outside when the reflected point was better than the worst vertex.
    Contract {
        limit: f64,
    },
    Shrink,
}

/// A simplex around what another search has found. It is no [`Strategy::local`]: begun on a point that keeps all constraints
/// it has no use for rounds with multipliers, which come from outside.
pub(super) struct Refinement(Restarted<SimplexSearch>);

/// Extent at which a refinement begins again, or looks for a kink: fine enough for gains of a thousandth, and reached before
/// patience ends.
const REFINED: f64 = 1e-4;
const AGAIN: usize = 10;

impl Refinement {
    pub(super) fn new(start: Vec<f64>, edge: f64, evaluations: usize) -> Self {
        let limits = Limits { tolerance: REFINED, restarts: AGAIN, evaluations };
        Self(Restarted::new(SimplexSearch::new(start, None, edge, REFINED), edge, limits))
    }
}

impl Strategy for Refinement {
    fn batch(&self) -> &[Vec<f64>] {
        self.0.batch()
    }

    fn learn(&mut self, values: &[f64]) -> Result<(), String> {
        self.0.learn(values)
    }

    fn finished(&self) -> Option<Reason> {
        self.0.finished()
    }

    fn budget(&self) -> usize {
        self.0.budget()
    }
}

/// The search; also used to polish what another method found.
pub struct SimplexSearch {
    edge: f64,
    tolerance: f64,
    expansion: f64,
    contraction: f64,
    shrinkage: f64,

    /// Best first.
    simplex: Vec<Vertex>,
    batch: Vec<Vec<f64>>,
    step: Step,
}

impl SimplexSearch {
    /// Starts at `start`, whose value may be known, with a simplex of edge `edge` along the axes.
    #[must_use]
    pub fn new(start: Vec<f64>, value: Option<f64>, edge: f64, tolerance: f64) -> Self {
        let dimension = start.len().max(2) as f64;
        let mut search = Self {
            edge,
            tolerance,
            expansion: 1.0 + 2.0 / dimension,
            contraction: 0.75 - 0.5 / dimension,
            shrinkage: 1.0 - 1.0 / dimension,
            simplex: Vec::new(),
            batch: Vec::new(),
            step: Step::Begin,
        };
        let mut vertices = search.around(&start);
        match value {
            Some(value) => search.simplex.push(Vertex { at: start, value }),
            None => vertices.insert(0, start),
        }
        search.propose(Step::Begin, vertices);
        search
    }

    /// One vertex along each axis.
    fn around(&self, centre: &[f64]) -> Vec<Vec<f64>> {
        (0..centre.len())
            .map(|axis| {
                let mut vertex = centre.to_vec();
                let moved = vertex[axis] + self.edge;
                // No room above: a vertex below, clipped to the cube.
                vertex[axis] = if moved <= 1.0 { moved } else { clip(vertex[axis] - self.edge) };
                vertex
            })
            .collect()
    }

    fn propose(&mut self, step: Step, points: Vec<Vec<f64>>) {
        self.step = step;
        self.batch = points;
    }

    /// (1 + factor)·centroid − factor·worst, clipped; the centroid is that of all vertices but the worst.
    fn along(&self, factor: f64) -> Vec<f64> {
        let (worst, others) = self.simplex.split_last().expect("a simplex has at least two vertices");
        (0..worst.at.len())
            .map(|axis| {
                let centroid = others.iter().map(|vertex| vertex.at[axis]).sum::<f64>() / others.len() as f64;
                clip((1.0 + factor) * centroid - factor * worst.at[axis])
            })
            .collect()
    }

    fn replace_worst(&mut self, vertex: Vertex) {
        self.simplex.pop();
        self.simplex.push(vertex);
        self.go_on();
    }

    fn go_on(&mut self) {
        // Stable: of equal vertices the older stays ahead.
        self.simplex.sort_by(|a, b| a.value.total_cmp(&b.value));
        let best = &self.simplex[0];
        let extent = self.simplex[1..]
            .iter()
            .flat_map(|vertex| vertex.at.iter().zip(&best.at).map(|(a, b)| (a - b).abs()))
            .fold(0.0, f64::max);
        if extent > self.tolerance {
            let reflected = self.along(1.0);
            self.propose(Step::Reflect, vec![reflected]);
            return;
        }
        self.batch.clear();
    }

    fn shrink(&mut self) {
        let best = &self.simplex[0].at;
        let points = self.simplex[1..]
            .iter()
            .map(|vertex| vertex.at.iter().zip(best).map(|(a, b)| clip(b + self.shrinkage * (a - b))).collect())
            .collect();
        self.propose(Step::Shrink, points);
    }

    fn reflected(&mut self, vertex: Vertex) {
        let last = self.simplex.len() - 1;
        if vertex.value < self.simplex[0].value {
            let expanded = self.along(self.expansion);
            self.propose(Step::Expand { reflected: vertex }, vec![expanded]);
        } else if vertex.value < self.simplex[last - 1].value {
            self.replace_worst(vertex);
        } else if vertex.value < self.simplex[last].value {
            let outside = self.along(self.contraction);
            self.propose(Step::Contract { limit: vertex.value }, vec![outside]);
        } else {
            let inside = self.along(-self.contraction);
            // Inside, the contracted point must be lower than the worst vertex, not merely as low.
            let limit = self.simplex[last].value.next_down();
            self.propose(Step::Contract { limit }, vec![inside]);
        }
    }
}

impl Search for SimplexSearch {
    fn batch(&self) -> &[Vec<f64>] {
        &self.batch
    }

    fn learn(&mut self, values: &[f64]) -> Result<(), String> {
        let batch = std::mem::take(&mut self.batch);
        let mut vertices: Vec<Vertex> =
            batch.into_iter().zip(values).map(|(at, &value)| Vertex { at, value }).collect();
        match std::mem::replace(&mut self.step, Step::Begin) {
            Step::Begin => {
                self.simplex.append(&mut vertices);
                self.go_on();
            }
            Step::Shrink => {
                self.simplex.truncate(1);
                self.simplex.append(&mut vertices);
                self.go_on();
            }
            step => {
                let vertex = vertices.pop().ok_or("the batch was empty")?;
                match step {
                    Step::Expand { reflected } => {
                        self.replace_worst(if vertex.value < reflected.value { vertex } else { reflected });
                    }
                    Step::Contract { limit } if vertex.value > limit => self.shrink(),
                    Step::Contract { .. } => self.replace_worst(vertex),
                    _ => self.reflected(vertex),
                }
            }
        }
        Ok(())
    }

    fn converged(&self) -> bool {
        self.batch.is_empty()
    }

    fn best(&self) -> (&[f64], f64) {
        self.simplex.first().map_or((&[], f64::INFINITY), |best| (&best.at, best.value))
    }

    fn begin(&mut self, at: Vec<f64>, value: Option<f64>, _down: Option<Vec<f64>>) {
        *self = Self::new(at, value, self.edge, self.tolerance);
    }
}
