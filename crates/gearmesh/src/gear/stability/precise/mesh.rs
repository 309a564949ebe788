//! A pair in twice the precision: path of contact, equilibrium at a position, transmission error over a cycle.
//!
//! Positions τ run over one base pitch from where a pair starts contact. Spans between ends of zones, starts of reliefs
//! and first touches are integrated by one Gauss–Legendre rule each, in a variable that is cubic at both ends, so that
//! the 3/2 power of a crowned face that begins to carry is smooth. Must not know: the kernels.

use super::flanks::{Flanks, Least, Spot};
use super::rules::Rule;
use super::tooth::{Tooth, inverse_involute};
use super::{GearInputs, Inputs};
use crate::numeric::double_double::Double;

/// Steps between a span's ends at which a touch or an extremum is searched for.
const STEPS: usize = 24;
/// Halvings to the place of a touch: what is integrated errs by the square of what is left.
const HALVINGS: usize = 44;
/// Zones shorter than this share of the base pitch do not exist, by definition.
const SHORTEST_ZONE: f64 = 1e-9;

/// The pair on its path of contact.
pub(super) struct PreciseMesh<'a> {
    inputs: &'a Inputs,
    pub centre_distance: Double,
    tangent_length: Double,
    pub start: Double,
    end: Double,
    base_pitch: Double,
    force: Double,
    /// Common face width.
    width: f64,
    /// Crowning of both gears at the end of the common face.
    crown: Double,
    base_radii: [Double; 2],
    flanks: Flanks,
}

/// 2/π Σ(1 − ν²)/E.
fn flattening(gears: &[GearInputs; 2]) -> Double {
    let of = |gear: &GearInputs| (Double::ONE - Double::from(gear.poisson_ratio).square()) / gear.youngs_modulus;
    (of(&gears[0]) + of(&gears[1])).times_power_of_two(2.0) / Double::PI
}

/// Shares of a span at which touches are looked for: in steps, denser towards its ends, where flanks touch at the start of a
/// relief for a while.
fn looks() -> impl Iterator<Item = f64> {
    let near = |halvings: u32| libm::exp2(-f64::from(halvings));
    let steps = (1..STEPS).map(|index| index as f64 / STEPS as f64);
    let first = (3..14).rev().map(move |halvings| near(2 * halvings));
    let last = (3..14).map(move |halvings| 1.0 - near(2 * halvings));
    [0.0].into_iter().chain(first).chain(steps).chain(last).chain([1.0])
}

/// How a pair of teeth answers a penetration.
enum Spring {
    Linear {
        stiffness: Double,
    },
    /// α, β and the compliance of both teeth per load per width.
    Logarithmic {
        constant: Double,
        rate: Double,
        compliance: Double,
        width: f64,
    },
}

impl Spring {
    /// Load and rate of a pair without crowning at a penetration > 0.
    fn flat(&self, penetration: Double) -> (Double, Double) {
        match self {
            Self::Linear { stiffness } => (*stiffness * penetration, *stiffness),
            Self::Logarithmic { constant, rate, compliance, width } => {
                let last = (*constant / *rate - 1.0).exponential();
                if penetration >= (*compliance + *rate) * last {
                    return ((penetration - *rate * last) / *compliance * *width, Double::from(*width) / *compliance);
                }
                // p(c + α − β ln p) = w, Newton's method on ln p.
                let target = penetration.logarithm();
                let mut logarithm = target - (*compliance + *rate).logarithm();
                let mut total = *compliance + *constant - *rate * logarithm;
                for _ in 0..60 {
                    let step = (logarithm + total.logarithm() - target) / (Double::ONE - *rate / total);
                    logarithm -= step;
                    total = *compliance + *constant - *rate * logarithm;
                    if step.high.abs() < 1e-15 {
                        break;
                    }
                }
                (penetration / total * *width, Double::from(*width) / (total - *rate))
            }
        }
    }

    /// The same on a face with a parabola of the height `crown` at its ends.
    fn response(&self, penetration: Double, crown: Double) -> (Double, Double) {
        if crown.high == 0.0 {
            return self.flat(penetration);
        }
        let (_, stiffness) = self.flat(penetration);
        let share = if penetration >= crown { Double::ONE } else { (penetration / crown).sqrt() };
        let passed = share * (penetration - crown * share.square() / 3.0);
        (stiffness * passed, stiffness * share)
    }

    /// An penetration at which the pair carries `load` or more.
    fn above(&self, load: Double, crown: Double) -> Double {
        let flat = match self {
            Self::Linear { stiffness } => load / *stiffness,
            Self::Logarithmic { constant, rate, compliance, width } => {
                let load = load / *width;
                let held = load.min((*constant / *rate - 1.0).exponential());
                *compliance * load + held * (*constant - *rate * held.logarithm())
            }
        };
        flat + crown / 3.0
    }
}

/// A position with everything that is needed there.
struct SolvedPosition {
    error: Double,
    /// Penetration of each pair: below zero by what is still open.
    penetration: Vec<Double>,
    /// Where the flanks of each pair come nearest.
    spots: Vec<Spot>,
}

impl<'a> PreciseMesh<'a> {
    pub(super) fn new(inputs: &'a Inputs, teeth: &[Tooth; 2]) -> Self {
        let (sine, cosine) = inputs.pressure_angle.sine_cosine();
        let tangent = sine / cosine;
        let [one, two] = &inputs.gears;
        let sum = (one.shift + two.shift) / Double::from(one.teeth + two.teeth);
        let working = tangent - tangent.arctangent(Double::ONE) + (tangent * sum).times_power_of_two(2.0);
        let base_radii = [teeth[0].base_radius, teeth[1].base_radius];
        let base_sum = base_radii[0] + base_radii[1];
        let tangent_length = base_sum * inverse_involute(working, tangent.high);
        let width = one.face_width.min(two.face_width);
        // Where a flank ends towards its tip, unless its mate has no involute as far as that.
        let path = [tangent_length - base_radii[1] * teeth[1].tip_roll, base_radii[0] * teeth[0].tip_roll];
        let start = path[0].max(base_radii[0] * teeth[0].form_roll);
        let end = path[1].min(tangent_length - base_radii[1] * teeth[1].form_roll);
        let share = |gear: &GearInputs| gear.crowning * (Double::from(width) / gear.face_width).square();
        Self {
            inputs,
            centre_distance: (tangent_length.square() + base_sum.square()).sqrt(),
            tangent_length,
            start,
            end,
            base_pitch: Double::PI * inputs.module * cosine,
            force: inputs.torque / base_radii[0],
            width,
            crown: share(one) + share(two),
            base_radii,
            flanks: Flanks { base_radii, tangent_length, path, reliefs: [one.tip_relief(), two.tip_relief()] },
        }
    }

    pub(super) fn contact_ratio(&self) -> Double {
        (self.end - self.start) / self.base_pitch
    }

    /// Start, end and number of pairs of each zone; a contact ratio within 1e-9 of a whole number is that number.
    pub(super) fn zones(&self) -> Vec<(Double, Double, usize)> {
        let ratio = self.contact_ratio();
        let whole = (ratio.high + SHORTEST_ZONE).floor().max(1.0);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a contact ratio
        let fewest = whole as usize;
        let share = ratio - whole;
        if share.high < SHORTEST_ZONE {
            return vec![(Double::ZERO, self.base_pitch, fewest)];
        }
        let shared = share * self.base_pitch;
        vec![(Double::ZERO, shared, fewest + 1), (shared, self.base_pitch, fewest)]
    }

    /// Both teeth and the contact of the pair at the path position s.
    fn spring(&self, teeth: &[Tooth; 2], s: Double) -> Spring {
        let rolls = [s / self.base_radii[0], (self.tangent_length - s) / self.base_radii[1]];
        let compliance = teeth[0].value(rolls[0]) + teeth[1].value(rolls[1]);
        if !self.inputs.load_dependent {
            let contact = flattening(&self.inputs.gears) / self.width;
            return Spring::Linear { stiffness: Double::ONE / (compliance + contact) };
        }
        let radius = s * (self.tangent_length - s) / self.tangent_length;
        let total = flattening(&self.inputs.gears);
        // b_H = √(4 p ρ Σ(1 − ν²)/E / π) at p = 1.
        let half_width = (radius * total.times_power_of_two(2.0)).sqrt();
        let mut constant = Double::ZERO;
        for (index, gear) in self.inputs.gears.iter().enumerate() {
            let nu = Double::from(gear.poisson_ratio);
            let factor = (Double::ONE - nu.square()) / gear.youngs_modulus / Double::PI;
            let depth = teeth[index].contact_depth(rolls[index]).times_power_of_two(2.0);
            let bracket = (depth / half_width).logarithm() - nu.half() / (Double::ONE - nu);
            constant += (factor * bracket).times_power_of_two(2.0);
        }
        Spring::Logarithmic { constant, rate: total.half(), compliance: compliance * self.width, width: self.width }
    }

    fn state(&self, teeth: &[Tooth; 2], position: Double, pairs: usize) -> SolvedPosition {
        let places: Vec<Double> =
            (0..pairs).map(|index| self.start + position + self.base_pitch * index as f64).collect();
        let springs: Vec<Spring> = places.iter().map(|s| self.spring(teeth, *s)).collect();
        let nearest_places: Vec<Least> = places.iter().map(|s| self.flanks.least(*s)).collect();
        let gaps: Vec<Double> = nearest_places.iter().map(|least| least.gap).collect();
        let nearest = (0..pairs).fold(0, |minimum, index| if gaps[index] < gaps[minimum] { index } else { minimum });
        let open: Vec<Double> = gaps.iter().map(|gap| *gap - gaps[nearest]).collect();
        let mut approach = springs[nearest].above(self.force, self.crown);
        for _ in 0..300 {
            let (mut load, mut slope) = (Double::ZERO, Double::ZERO);
            for (spring, gap) in springs.iter().zip(&open) {
                let penetration = approach - *gap;
                if penetration > Double::ZERO {
                    let (part, rise) = spring.response(penetration, self.crown);
                    load += part;
                    slope += rise;
                }
            }
            let step = (load - self.force) / slope;
            approach -= step;
            if step.high.abs() <= 1e-28 * approach.high.abs() {
                break;
            }
        }
        SolvedPosition {
            error: gaps[nearest] + approach,
            penetration: open.iter().map(|gap| approach - *gap).collect(),
            spots: nearest_places.iter().map(|least| least.spot).collect(),
        }
    }

    /// F/δ without modifications, in the middle of the zones with the fewest and with the most pairs.
    pub(super) fn stiffness(&self, teeth: &[Tooth; 2]) -> [Double; 2] {
        let zones = self.zones();
        [zones.len() - 1, 0].map(|zone| {
            let (from, to, pairs) = zones[zone];
            let middle = (from + to).half();
            let springs =
                (0..pairs).map(|index| self.spring(teeth, self.start + middle + self.base_pitch * index as f64));
            let springs: Vec<Spring> = springs.collect();
            let mut approach = springs[0].above(self.force, Double::ZERO);
            for _ in 0..300 {
                let (mut load, mut slope) = (Double::ZERO, Double::ZERO);
                for spring in &springs {
                    let (part, rise) = spring.flat(approach);
                    load += part;
                    slope += rise;
                }
                let step = (load - self.force) / slope;
                approach -= step;
                if step.high.abs() <= 1e-28 * approach.high.abs() {
                    break;
                }
            }
            self.force / approach
        })
    }

    /// Mean and peak-to-peak over the cycle.
    pub(super) fn transmission_error(&self, teeth: &[Tooth; 2], rule: &Rule) -> [Double; 2] {
        let mut integral = Double::ZERO;
        let (mut minimum, mut maximum) = (Double::from(f64::INFINITY), Double::from(f64::NEG_INFINITY));
        let points = rule.unit(self.inputs.load_dependent);
        for (from, to, pairs) in self.zones() {
            for (from, to) in self.spans(teeth, from, to, pairs) {
                for (share, weight) in &points {
                    let error = self.state(teeth, from + (to - from) * *share, pairs).error;
                    integral += error * *weight * (to - from);
                }
                for sign in [1.0, -1.0] {
                    let value = self.largest(teeth, (from, to), pairs, sign) * sign;
                    (minimum, maximum) = (minimum.min(value), maximum.max(value));
                }
            }
        }
        [integral / self.base_pitch, maximum - minimum]
    }

    /// The smooth parts of a zone.
    fn spans(&self, teeth: &[Tooth; 2], from: Double, to: Double, pairs: usize) -> Vec<(Double, Double)> {
        let [one, two] = &self.inputs.gears;
        let mut cuts = vec![from];
        let [first, last] = self.flanks.path;
        for (s, gear) in [(last - one.relief_length, one), (first + two.relief_length, two)] {
            let pitches = (s - self.start) / self.base_pitch;
            let folded = (pitches - pitches.high.floor()) * self.base_pitch;
            if gear.relief.high != 0.0 && folded > from && folded < to {
                cuts.push(folded);
            }
        }
        cuts.push(to);
        cuts.sort_by(|a, b| a.high.total_cmp(&b.high));
        let mut spans = Vec::new();
        for pair in cuts.windows(2) {
            let (mut before, to) = (pair[0], pair[1]);
            for touch in self.touches(teeth, (pair[0], to), pairs) {
                spans.push((before, touch));
                before = touch;
            }
            spans.push((before, to));
        }
        spans
    }

    /// Where a pair takes up or loses load, comes into contact all over its face, or begins to touch at another place.
    fn touches(&self, teeth: &[Tooth; 2], (from, to): (Double, Double), pairs: usize) -> Vec<Double> {
        let [one, two] = &self.inputs.gears;
        if one.relief.high == 0.0 && two.relief.high == 0.0 && self.crown.high == 0.0 {
            return Vec::new();
        }
        let states: Vec<(Double, SolvedPosition)> = looks()
            .map(|share| {
                let place = from + (to - from) * share;
                (place, self.state(teeth, place, pairs))
            })
            .collect();
        let mut touches = Vec::new();
        for ends in states.windows(2) {
            let [(low, before), (high, after)] = [&ends[0], &ends[1]];
            let mut search = |alike: &dyn Fn(&SolvedPosition) -> bool| {
                if alike(after) {
                    return;
                }
                let (mut low, mut high) = (*low, *high);
                for _ in 0..HALVINGS {
                    let middle = (low + high).half();
                    if alike(&self.state(teeth, middle, pairs)) { low = middle } else { high = middle }
                }
                touches.push(high);
            };
            for pair in 0..pairs {
                search(&|state| state.spots[pair] == before.spots[pair]);
                let levels = [Double::ZERO, self.crown];
                for &level in &levels[..if self.crown.high == 0.0 { 1 } else { 2 }] {
                    let carries = |state: &SolvedPosition| state.penetration[pair] > level;
                    search(&|state| carries(state) == carries(before));
                }
            }
        }
        touches.sort_by(|a, b| a.high.total_cmp(&b.high));
        touches
    }

    /// The largest value of sign·δ on a smooth span: by steps, then by thirds around the largest.
    fn largest(&self, teeth: &[Tooth; 2], (from, to): (Double, Double), pairs: usize, sign: f64) -> Double {
        let value = |position: Double| self.state(teeth, position, pairs).error * sign;
        let place = |index: usize| from + (to - from) * (index as f64) / STEPS as f64;
        let values: Vec<Double> = (0..=STEPS).map(|index| value(place(index))).collect();
        let best = (0..=STEPS).fold(0, |best, index| if values[index] > values[best] { index } else { best });
        let (mut low, mut high, mut found) =
            (place(best.saturating_sub(1)), place((best + 1).min(STEPS)), values[best]);
        // At an end of the span it is the value there, unless the function still rises inwards.
        let inwards = (high - low) * if best == 0 { 1e-9 } else { -1e-9 };
        if (best == 0 || best == STEPS) && value(place(best) + inwards) <= found {
            return found;
        }
        // The value is of second order in the place.
        for _ in 0..60 {
            let third = (high - low) / 3.0;
            let (one, two) = (low + third, high - third);
            let (at_one, at_two) = (value(one), value(two));
            found = found.max(at_one).max(at_two);
            if at_one > at_two { high = two } else { low = one }
        }
        found
    }
}
