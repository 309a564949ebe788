//! The outline of half a tooth in units of the module: root land, root curve, involute, and how nodes are spread on it.
//!
//! The curves are those of the full profile (`geometry/outline`). Nodes lie on the exact curves; only where on them is
//! approximate. Must not know: elements, elasticity.

use std::f64::consts::{FRAC_PI_4, PI};

use super::MeshError;
use crate::gear::geometry::Gear;
use crate::gear::geometry::outline::Outline as Profile;
use crate::gear::geometry::outline::curve::{Curve, OutlinePart, Segment};
use crate::gear::geometry::outline::roots::Toe;
use crate::gear::geometry::root::Root;
use crate::gear::geometry::root_piece::Piece;

/// Samples of a curve from which its length and direction are taken.
const SAMPLES: usize = 400;
/// Width \[modules\] below which there is no land.
const NO_LAND: f64 = 1e-6;
/// Inclination against the circumference at which the tooth is cut off the body.
const CUT_INCLINATION: f64 = FRAC_PI_4;

/// A stretch of a curve, between two of its parameters; its points are in modules.
#[derive(Clone, Debug)]
pub struct Stretch {
    part: OutlinePart,
    curve: Curve,
    module: f64,
    /// The curve's parameter where the stretch starts.
    pub lower: f64,
    /// The curve's parameter where it ends, nearer to the tip; it may be the smaller of the two.
    pub upper: f64,
}

impl Stretch {
    /// The point \[modules\] at a parameter.
    #[must_use]
    pub fn point(&self, parameter: f64) -> [f64; 2] {
        self.curve.point(parameter).map(|length| length / self.module)
    }

    /// Whether it is the involute.
    #[must_use]
    pub fn is_flank(&self) -> bool {
        matches!(self.part, OutlinePart::Flank)
    }

    /// Its length \[modules\].
    #[must_use]
    pub fn length(&self) -> f64 {
        Samples::new(self).lengths[SAMPLES]
    }

    fn between(&self, lower: f64, upper: f64) -> Self {
        Self { lower, upper, ..self.clone() }
    }
}

/// Half a tooth's outline, cut where the tooth leaves the body.
#[derive(Clone, Debug)]
pub struct Outline {
    /// From the middle of the root land upwards to the cut.
    pub body: Vec<Stretch>,
    /// From the cut to the end of the flank, and to the middle of the rounding that follows it, if one does.
    pub tooth: Vec<Stretch>,
    /// What is left of a broken tip, up to the tooth's centreline: half a rounding or a chamfer, and the land. Empty where
    /// the corner is as it is: then the row that ends there is an arc through both corners.
    pub top: Vec<Stretch>,
    /// Half a pitch \[rad\].
    pub half_pitch: f64,
    /// The bore \[modules\].
    pub bore_radius: f64,
    /// ψ_y where the tooth ends.
    pub tip_half_angle: f64,
}

/// A curve by its samples: parameter, and length and turning up to it.
struct Samples {
    points: Vec<[f64; 2]>,
    parameters: Vec<f64>,
    lengths: Vec<f64>,
}

impl Samples {
    fn new(stretch: &Stretch) -> Self {
        let Stretch { lower, upper, .. } = *stretch;
        let parameters: Vec<f64> =
            (0..=SAMPLES).map(|k| lower + (upper - lower) * (k as f64 / SAMPLES as f64)).collect();
        let points: Vec<[f64; 2]> = parameters.iter().map(|&parameter| stretch.point(parameter)).collect();
        let mut lengths = vec![0.0];
        for pair in points.windows(2) {
            let step = libm::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]);
            lengths.push(lengths[lengths.len() - 1] + step);
        }
        Self { points, parameters, lengths }
    }

    /// Direction of the chord after sample `k`, as the angle above the inward circumference.
    fn inclination(&self, k: usize) -> f64 {
        let ([x, y], [next_x, next_y]) = (self.points[k], self.points[k + 1]);
        let (along, up) = (x - next_x, next_y - y);
        libm::atan2(up, along) + libm::atan2(x, y)
    }
}

impl Outline {
    /// The outline of a gear's teeth with a root.
    ///
    /// # Errors
    /// When the root has a re-entrant corner, or the tooth does not have a full profile.
    pub fn new(gear: &Gear, root: &Root) -> Result<Self, MeshError> {
        let module = gear.specification.module;
        let smooth = matches!(root.pieces.first(), Some(Piece::Trochoid(_) | Piece::Arc { .. }));
        if !smooth {
            return Err(MeshError::SharpRoot);
        }
        let profile = Profile::new(gear, Toe::of(root), gear.tip, None)?;
        let half_pitch = profile.half_pitch();
        let is_none = |segment: &Segment| {
            segment.part == OutlinePart::RootLand && gear.root_radius * (segment.to - segment.from) <= NO_LAND * module
        };
        let stretch =
            |Segment { part, curve, from, to }: Segment| Stretch { part, curve, module, lower: from, upper: to };
        let (top, wanted): (Vec<Segment>, Vec<Segment>) =
            (profile.segments.into_iter().filter(|segment| !is_none(segment)))
                .partition(|segment| matches!(segment.part, OutlinePart::TipBreak | OutlinePart::TipLand));
        let stretches: Vec<Stretch> = wanted.into_iter().map(stretch).collect();
        let mut top: Vec<Stretch> = top.into_iter().map(stretch).collect();

        let (place, parameter) = cut(&stretches);
        let whole = &stretches[place];
        let mut body = stretches[..place].to_vec();
        body.push(whole.between(whole.lower, parameter));
        let mut tooth = vec![whole.between(parameter, whole.upper)];
        tooth.extend_from_slice(&stretches[place + 1..]);
        let mut tip_half_angle = gear.half_angle_at_roll(gear.flank_end.roll);
        if gear.flank_end.radius > 0.0 {
            // The last row begins in its middle, so that neither its end nor the tip's elements are stretched along it.
            let round = top.remove(0);
            let middle = 0.5 * (round.lower + round.upper);
            let [x, y] = round.point(middle);
            tip_half_angle = libm::atan2(x, y);
            tooth.push(round.between(round.lower, middle));
            top.insert(0, round.between(middle, round.upper));
        } else if top.len() < 2 {
            top.clear();
        }
        let bore_radius = gear.specification.bore_radius / module;
        Ok(Self { body, tooth, top, half_pitch, bore_radius, tip_half_angle })
    }
}

/// Where the tooth is cut off: at the inclination of 45°, or half of what the first curve reaches, if that is less.
fn cut(stretches: &[Stretch]) -> (usize, f64) {
    let place = usize::from(stretches[0].part == OutlinePart::RootLand);
    let samples = Samples::new(&stretches[place]);
    let steepest = (0..SAMPLES).map(|k| samples.inclination(k)).fold(0.0, f64::max);
    let wanted = CUT_INCLINATION.min(0.5 * steepest);
    let found = (1..SAMPLES).find(|&k| samples.inclination(k) >= wanted).unwrap_or(SAMPLES / 2);
    (place, samples.parameters[found])
}

/// Sizes of the elements on a stretch, by the samples of its curve.
pub struct Division<'a> {
    stretch: &'a Stretch,
    samples: Samples,
    /// Elements in each interval between samples.
    densities: Vec<f64>,
}

impl<'a> Division<'a> {
    /// Elements of the length `size` at a point, and none that turns by more than `turn`.
    #[must_use]
    pub fn new(stretch: &'a Stretch, turn: f64, size: impl Fn([f64; 2]) -> f64) -> Self {
        let samples = Samples::new(stretch);
        let density = |k: usize| {
            let length = samples.lengths[k + 1] - samples.lengths[k];
            let [from, to] = [k.max(1) - 1, k.min(SAMPLES - 2) + 1];
            let direction = |k: usize| {
                let ([x, y], [p, q]) = (samples.points[k], samples.points[k + 1]);
                libm::atan2(q - y, p - x)
            };
            let turned = (direction(to) - direction(from)) / (to - from) as f64;
            // A curve's direction never jumps by half a turn.
            let turned = libm::remainder(turned, 2.0 * PI).abs();
            (length / size(samples.points[k])).max(turned / turn)
        };
        let densities = (0..SAMPLES).map(density).collect();
        Self { stretch, samples, densities }
    }

    fn length(&self, k: usize) -> f64 {
        self.samples.lengths[k + 1] - self.samples.lengths[k]
    }

    /// The least length of an element \[modules\].
    #[must_use]
    pub fn smallest(&self) -> f64 {
        (0..SAMPLES).map(|k| self.length(k) / self.densities[k]).fold(f64::INFINITY, f64::min)
    }

    /// Parameters of corner and middle nodes, alternating, each element cut into `parts`.
    #[must_use]
    pub fn parameters(&self, parts: usize) -> Vec<f64> {
        let samples = &self.samples;
        let mut weights = vec![0.0];
        for density in &self.densities {
            weights.push(weights[weights.len() - 1] + density);
        }
        let total = weights[SAMPLES];
        // A few dozen elements at most.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let count = parts * libm::round(total).max(1.0) as usize;
        let corners: Vec<f64> =
            (0..=count).map(|k| invert(&weights, &samples.lengths, total * (k as f64 / count as f64))).collect();
        let mut parameters = Vec::new();
        for pair in corners.windows(2) {
            for length in [pair[0], 0.5 * (pair[0] + pair[1])] {
                parameters.push(invert(&samples.lengths, &samples.parameters, length));
            }
        }
        parameters[0] = self.stretch.lower;
        parameters.push(self.stretch.upper);
        parameters
    }
}

/// Lets the elements of a chain of stretches be no shorter than `least` and grow by no more than `growth` for each length
/// along it.
pub fn grade(divisions: &mut [Division], least: f64, growth: f64) {
    let places: Vec<[usize; 2]> =
        (0..divisions.len()).flat_map(|stretch| (0..SAMPLES).map(move |k| [stretch, k])).collect();
    let mut pass = |[stretch, k]: [usize; 2], allowed: &mut f64| {
        let division = &mut divisions[stretch];
        let length = division.length(k);
        *allowed += 0.5 * growth * length;
        let size = (length / division.densities[k]).max(least).min(*allowed);
        division.densities[k] = length / size;
        *allowed = size + 0.5 * growth * length;
    };
    let mut allowed = f64::INFINITY;
    for &place in &places {
        pass(place, &mut allowed);
    }
    allowed = f64::INFINITY;
    for &place in places.iter().rev() {
        pass(place, &mut allowed);
    }
}

/// The value of `others` where `ascending` is `wanted`, by straight lines between samples.
fn invert(ascending: &[f64], others: &[f64], wanted: f64) -> f64 {
    let after = ascending.partition_point(|value| *value < wanted).clamp(1, ascending.len() - 1);
    let (low, high) = (ascending[after - 1], ascending[after]);
    let part = if high > low { (wanted - low) / (high - low) } else { 0.0 };
    others[after - 1] + part * (others[after] - others[after - 1])
}
