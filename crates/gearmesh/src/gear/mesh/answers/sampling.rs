//! By how much sampling changes a number of the mesh cycle, and the coarsest sampling that meets an accuracy.
//!
//! The number is computed with several samplings. With coarser ones, the error is what halving, quartering … changes; each
//! halving is assumed to cost 2^(3/2) times the error. The largest of several counts, since on faces that are cut into
//! slices a single change can be small by chance. Slices are compared with twice as many too: where the number is smooth
//! those show the error itself, and coarser ones only their own. No other sampling sees what lies between two slices; it is
//! added. A finer sampling, four times as fine, is dearer, but right for means and variances too, which few spans hold no
//! better than half of them do. Must not know: what the number is.

use crate::gear::contact::{MOST_COUPLED_SLICES, SliceCoupling};
use crate::gear::mesh::cycle::mesh::Settings;

/// The estimate over the largest of the changes: from coarser samplings, and from a single finer one.
const SAFETY: f64 = 2.25;
const SAFETY_OF_FINER: f64 = 4.0;
/// By how much a halving is assumed to change the error: load begins at an edge as the 3/2 power of the way in, so 2^(3/2).
const FALL: f64 = 2.83;
/// How many coarser samplings are used: slices change a number by chance, positions hardly at all.
const HALVINGS_OF_POSITIONS: usize = 1;
const HALVINGS_OF_SLICES: usize = 3;
/// Relative error that remains when sampling adds none: an extremum is refined to 1e-5 of the distance of two nodes, over
/// which a curve may bend by a few times its peak-to-peak.
const ROUNDING: f64 = 5e-10;
/// The fewest positions for which half as many are another sampling: with fewer, every smooth stretch is one span.
const LEAST_POSITIONS: usize = 16;
const MOST_POSITIONS: usize = 4096;
const LEAST_SLICES: usize = 9;
/// From here on slices that hold each other are compared only with coarser ones: twice as many take eight times as long.
const ENOUGH_COUPLED_SLICES: usize = 17;
const MOST_SLICES: usize = 1025;

/// What samplings are compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    /// Coarser ones where there are any: cheap. Slices also with twice as many, where that does not take too long.
    Coarser,
    /// Four times the positions, twice and four times the slices: dearer, but right for means and variances too.
    Finer,
}

/// A number that depends on the sampling.
pub struct Sampled<F> {
    number: F,
    /// Whether slices matter.
    sliced: bool,
    against: Against,
    known: Vec<(Settings, f64)>,
}

impl<F: FnMut(Settings) -> f64> Sampled<F> {
    /// `number` computes it with given settings; `sliced` says whether it depends on the number of slices.
    pub fn new(sliced: bool, against: Against, number: F) -> Self {
        Self { number, sliced, against, known: Vec::new() }
    }

    /// Gives the number for some settings, so that it need not be computed.
    pub fn know(&mut self, settings: Settings, value: f64) {
        self.known.push((settings, value));
    }

    fn value(&mut self, settings: Settings) -> f64 {
        if let Some((_, value)) = self.known.iter().find(|(known, _)| *known == settings) {
            return *value;
        }
        let value = (self.number)(settings);
        self.known.push((settings, value));
        value
    }

    fn change(&mut self, settings: Settings, other: Settings) -> f64 {
        let (value, other) = (self.value(settings), self.value(other));
        if value.to_bits() == other.to_bits() {
            0.0
        } else {
            (value - other).abs() / value.abs().max(f64::MIN_POSITIVE)
        }
    }

    /// Estimated relative error with these settings, at most 1: more would say that nothing is known.
    pub fn error(&mut self, settings: Settings) -> f64 {
        (ROUNDING + self.by_positions(settings) + self.by_slices(settings)).min(1.0)
    }

    fn by_positions(&mut self, settings: Settings) -> f64 {
        let with = |positions| Settings { positions, ..settings };
        if self.against == Against::Finer || settings.positions < LEAST_POSITIONS {
            return SAFETY_OF_FINER * self.change(settings, with(4 * settings.positions.max(LEAST_POSITIONS)));
        }
        let coarser = halves(settings.positions, HALVINGS_OF_POSITIONS, LEAST_POSITIONS / 2);
        self.by_halving(settings, coarser.map(with))
    }

    fn by_slices(&mut self, settings: Settings) -> f64 {
        if !self.sliced {
            return 0.0;
        }
        // What slices change hardly depends on the positions.
        let settings = Settings { positions: settings.positions.min(LEAST_POSITIONS), ..settings };
        let slices = settings.slices;
        let with = |slices| Settings { slices, ..settings };
        let (finer, finest) = (2 * slices.max(2) - 1, 4 * slices.max(3) - 3);
        let allowed = |slices| settings.slice_coupling == SliceCoupling::None || slices <= MOST_COUPLED_SLICES;
        let few = slices < LEAST_SLICES;
        let changes = if allowed(finest) && (self.against == Against::Finer || few) {
            // Two, for one may agree by chance.
            let safety = if few { SAFETY } else { SAFETY_OF_FINER };
            safety * self.change(settings, with(finer)).max(self.change(settings, with(finest)))
        } else {
            let coarser = halves(slices, HALVINGS_OF_SLICES, 3);
            let changes = self.by_halving(settings, coarser.map(with));
            if settings.slice_coupling == SliceCoupling::None || slices < ENOUGH_COUPLED_SLICES {
                // A coarser sampling differs by its own error, which is larger.
                (changes / FALL).max(SAFETY * self.change(settings, with(finer)))
            } else {
                changes
            }
        };
        changes + unseen(settings)
    }

    /// `coarser` are samplings that halve the count each time.
    fn by_halving(&mut self, settings: Settings, coarser: impl Iterator<Item = Settings>) -> f64 {
        let (mut largest, mut trust) = (0.0_f64, 1.0);
        for other in coarser {
            largest = largest.max(self.change(settings, other) / trust);
            trust *= FALL;
        }
        SAFETY * largest
    }

    /// The coarsest settings whose estimated error is no more than `accuracy`, or the finest there are.
    pub fn coarsest(&mut self, settings: Settings, accuracy: f64) -> Settings {
        let mut found = Settings { positions: LEAST_POSITIONS, ..settings };
        let share = if self.sliced { 0.5 } else { 1.0 };
        if self.sliced {
            found.slices = LEAST_SLICES;
            while self.by_slices(found) > share * (accuracy - ROUNDING) && 2 * found.slices - 1 <= most_slices(found) {
                found.slices = 2 * found.slices - 1;
            }
        }
        while self.by_positions(found) > share * (accuracy - ROUNDING) && found.positions < MOST_POSITIONS {
            found.positions *= 2;
        }
        found
    }
}

/// What half of the distance between the last two slices of a stretch may hide: load begins at an edge from nothing, so the
/// load on a strip there is of second order in its width. Equal slices are 1/s wide, Lobatto's nodes 3.7/s² at the ends.
fn unseen(settings: Settings) -> f64 {
    let slices = settings.slices.max(2) as f64;
    let half = match settings.slice_coupling {
        SliceCoupling::None => 2.0 / (slices * (slices - 1.0)),
        SliceCoupling::Plate => 0.5 / slices,
    };
    half * half
}

/// Coupled slices cost the cube of their number.
fn most_slices(settings: Settings) -> usize {
    if settings.slice_coupling == SliceCoupling::Plate { MOST_COUPLED_SLICES } else { MOST_SLICES }
}

/// Half of the count, a quarter …, rounded up, as long as they are `minimum`.
fn halves(count: usize, maximum: usize, minimum: usize) -> impl Iterator<Item = usize> {
    let halve = |count: &usize| Some(count.div_ceil(2));
    std::iter::successors(Some(count), halve).skip(1).take(maximum).take_while(move |count| *count >= minimum)
}
