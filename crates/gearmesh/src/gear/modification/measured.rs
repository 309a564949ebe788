//! A flank as it was measured: deviations along the profile, across the face, or over both.
//!
//! A deviation is positive where there is more material than the design has (ISO 1328-1:2013, clause 3), so a depth is minus
//! that, and nothing where the trace has 0: a trace is taken as it stands, with the zero of its own design line. Between points it
//! is a cubic spline, outside of them it keeps the value of its end. Must not know: compliance, load.

mod checks;
mod grid;
mod outliers;
mod smoothing;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use self::grid::Grid;
use super::flank::Flank;
use super::{Modification, Specified};
use crate::gear::geometry::{GearPair, Side};
use crate::gear::iso1328::evaluation::evaluate;
use crate::numeric::spline::Spline;
use declare::error::Diagnostic;
use declare::units::{ANGLE, LENGTH};
use declare::{Declared, Tagged};

/// The most points of a trace or of a grid.
pub const MOST_POINTS: usize = 10_000;

/// Flank as measured: deviations (ISO 1328-1) along the profile, across the face, or over both.
#[derive(Clone, Debug, Default, PartialEq, Declared)]
#[declared(name = "measured")]
pub struct Measured {
    /// L_y: roll lengths of the points along the profile, r_b times the roll angle, from the root to the tip.
    #[declared(dimension = LENGTH, minimum = 0.0, maximum = 10.0, example = "4 mm")]
    pub roll_lengths: Option<Vec<f64>>,
    /// Instead of `roll_lengths`: roll angles of the points along the profile.
    #[declared(dimension = ANGLE, minimum = 0.0, maximum = 10.0, example = "20 deg")]
    pub roll_angles: Option<Vec<f64>>,
    /// Instead of `roll_lengths`: diameters of the points along the profile.
    #[declared(dimension = LENGTH, minimum = 1e-4, maximum = 100.0, example = "75 mm")]
    pub diameters: Option<Vec<f64>>,
    /// z of the points across the face, from its middle; with points along the profile too, the deviations are those of a grid.
    #[declared(dimension = LENGTH, minimum = -10.0, maximum = 10.0, example = "-8 mm")]
    pub face_positions: Option<Vec<f64>>,
    /// Deviations normal to the flank, positive where there is more material than designed, in the order of the points; of a grid
    /// all along the profile for each place across the face.
    #[declared(dimension = LENGTH, minimum = -10.0, maximum = 10.0, example = "-2 um")]
    pub deviations: Vec<f64>,
    /// Roll length, or z of a trace across the face, from which the trace is evaluated; the start of the active flank, or the end
    /// of the face, when left out.
    #[declared(dimension = LENGTH, minimum = -10.0, maximum = 10.0, example = "3 mm")]
    pub evaluation_start: Option<f64>,
    /// Up to which it is evaluated; the tip, or the other end of the face, when left out.
    #[declared(dimension = LENGTH, minimum = -10.0, maximum = 10.0, example = "15 mm")]
    pub evaluation_end: Option<f64>,
    /// Instead of `evaluation_start`: diameter from which a trace along the profile is evaluated.
    #[declared(dimension = LENGTH, minimum = 1e-4, maximum = 100.0, example = "53 mm")]
    pub evaluation_start_diameter: Option<f64>,
    /// Instead of `evaluation_end`: diameter up to which it is evaluated, such as the tip form circle's.
    #[declared(dimension = LENGTH, minimum = 1e-4, maximum = 100.0, example = "62 mm")]
    pub evaluation_end_diameter: Option<f64>,
    /// z: number of teeth of the gear that was measured; another gear is refused.
    #[declared(minimum = 4, maximum = 10_000, example = "19")]
    pub teeth: Option<u32>,
    /// m: module of the gear that was measured; another gear is refused.
    #[declared(minimum = 1e-5, maximum = 1.0, dimension = LENGTH, example = "3 mm")]
    pub module: Option<f64>,
    /// What is taken for roughness and left out.
    #[declared(flatten)]
    pub smoothing: Smoothing,
}

/// What is left out of a trace before it is a flank.
#[derive(Clone, Copy, Debug, Default, PartialEq, Tagged)]
#[declared(default = "none")]
pub enum Smoothing {
    /// nothing: the flank goes through every point
    #[default]
    None,
    /// waves shorter than a `cutoff`, by Gaussian regression of second order (ISO 16610-31)
    Gaussian {
        /// λ: wavelength of which half is left, along the roll length or across the face; ISO 1328-1 has λ_α = L_α/30.
        #[declared(dimension = LENGTH, minimum = 1e-6, maximum = 1.0, example = "0.25 mm")]
        cutoff: f64,
    },
}

impl Specified for Measured {
    fn check(&self) -> Result<(), Diagnostic> {
        checks::consistent(self)
    }

    fn on(&self, pair: &GearPair, side: Side) -> Result<Arc<dyn Modification>, Diagnostic> {
        checks::of_this_gear(self, pair.side(side))?;
        let flank = Flank::new(pair, side);
        let along = checks::roll_angles(self, pair.side(side), &flank)?;
        let across = checks::face_positions(self, &flank)?;
        let depths: Vec<f64> = self.deviations.iter().map(|deviation| -deviation).collect();
        let flank_ends = [flank.root_roll, flank.tip_roll];
        let profile_ends = flank_ends.map(|roll| roll * flank.base_radius);
        let limits = checks::limits(self, &flank)?;
        let face_ends = [-0.5 * flank.face_width, 0.5 * flank.face_width];
        let lengths = |rolls: &[f64]| rolls.iter().map(|roll| roll * flank.base_radius).collect::<Vec<_>>();
        for places in along.as_deref().map(lengths).iter().chain(&across) {
            checks::smoothed(&self.smoothing, places[places.len() - 1] - places[0])?;
        }
        Ok(match (along, across) {
            (Some(rolls), None) => {
                let lengths = lengths(&rolls);
                let depths = self.smoothing.smoothed(&lengths, &depths);
                checks::swings([checks::profile(self).zip(Some(&lengths[..])), None], &depths)?;
                checks::evaluation(&limits, &lengths)?;
                let values = evaluated(&PROFILE, &lengths, &depths, limits.range(profile_ends), profile_ends);
                Arc::new(Profile(Line::new(&rolls, &depths, flank_ends, values)))
            }
            (None, Some(places)) => {
                let depths = self.smoothing.smoothed(&places, &depths);
                checks::swings([Some((Measured::NAMES.face_positions, &places[..])), None], &depths)?;
                checks::evaluation(&limits, &places)?;
                let values = evaluated(&HELIX, &places, &depths, limits.range(face_ends), face_ends);
                Arc::new(Lead(Line::new(&places, &depths, face_ends, values)))
            }
            (Some(rolls), Some(places)) => {
                let lengths = lengths(&rolls);
                let depths = self.smoothing.smoothed_grid(&lengths, &places, &depths);
                let across = Some((Measured::NAMES.face_positions, &places[..]));
                checks::swings([checks::profile(self).zip(Some(&lengths[..])), across], &depths)?;
                checks::evaluation(&limits, &lengths)?;
                let grid = Grid::new(&rolls, &places, &depths);
                // The trace in the middle of the face, and the one in the middle of the active flank.
                let along: Vec<f64> = rolls.iter().map(|roll| grid.value(*roll, 0.0)).collect();
                let middle = 0.5 * (flank.root_roll + flank.tip_roll);
                let across: Vec<f64> = places.iter().map(|z| grid.value(middle, *z)).collect();
                let mut values = evaluated(&PROFILE, &lengths, &along, limits.range(profile_ends), profile_ends);
                values.extend(evaluated(&HELIX, &places, &across, face_ends, face_ends));
                values.retain(|value| value.0 != AMOUNT);
                values.insert(0, (AMOUNT, deepest(&depths)));
                let breaks = [inner(&rolls, flank_ends), inner(&places, face_ends)];
                Arc::new(Surface { grid, breaks, values })
            }
            (None, None) => return Err(checks::no_places()),
        })
    }
}

/// The deepest place, with its sign.
fn deepest(depths: &[f64]) -> f64 {
    depths.iter().copied().fold(0.0, |deepest: f64, depth| if depth.abs() > deepest.abs() { depth } else { deepest })
}

const AMOUNT: &str = "amount";

/// The names of what a trace comes to: range, slope, form, total and crowning.
type Names = [&'static str; 6];

/// L_α; f_Hα, f_fα, F_α, C_α.
pub const PROFILE: Names = [
    "profile_evaluation_start",
    "profile_evaluation_end",
    "profile_slope_deviation",
    "profile_form_deviation",
    "profile_total_deviation",
    "profile_crowning",
];

/// L_β; f_Hβ, f_fβ, F_β, C_β.
pub const HELIX: Names = [
    "helix_evaluation_start",
    "helix_evaluation_end",
    "helix_slope_deviation",
    "helix_form_deviation",
    "helix_total_deviation",
    "helix_crowning",
];

/// What a trace of depths comes to over a range, its slope over the whole of the flank; NaN where it covers nothing of the range.
fn evaluated(
    names: &Names,
    places: &[f64],
    depths: &[f64],
    range: [f64; 2],
    whole: [f64; 2],
) -> Vec<(&'static str, f64)> {
    let deviations: Vec<f64> = depths.iter().map(|depth| -depth).collect();
    let found = evaluate(places, &deviations, range, whole[1] - whole[0]);
    let values = found.map_or([f64::NAN; 6], |found| {
        [found.range[0], found.range[1], found.slope, found.form, found.total, found.crowning]
    });
    std::iter::once((AMOUNT, deepest(depths))).chain(names.iter().copied().zip(values)).collect()
}

/// A trace: depths along one way, held at its ends.
#[derive(Debug)]
struct Line {
    spline: Spline,
    /// Where it ends on the flank, and is not smooth.
    breaks: Vec<f64>,
    values: Vec<(&'static str, f64)>,
}

impl Line {
    fn new(places: &[f64], depths: &[f64], range: [f64; 2], values: Vec<(&'static str, f64)>) -> Self {
        Self { spline: Spline::new(places, depths), breaks: inner(places, range), values }
    }

    fn depth(&self, place: f64) -> f64 {
        let [first, last] = self.spline.ends();
        self.spline.value(place.clamp(first, last))
    }

    fn rates(&self, place: f64, inside: f64) -> [f64; 3] {
        let [first, last] = self.spline.ends();
        if inside < first || inside > last {
            return [self.depth(inside), 0.0, 0.0];
        }
        self.spline.rates(place)
    }
}

/// The ends of a trace that lie inside a range.
fn inner(places: &[f64], [from, to]: [f64; 2]) -> Vec<f64> {
    let ends = [places.first(), places.last()].into_iter().flatten().copied();
    ends.filter(|end| *end > from && *end < to).collect()
}

/// Along the roll angle.
#[derive(Debug)]
struct Profile(Line);

impl Modification for Profile {
    fn depth(&self, roll: f64) -> f64 {
        self.0.depth(roll)
    }

    fn profile_rates(&self, roll: f64, inside: f64) -> Option<[f64; 3]> {
        Some(self.0.rates(roll, inside))
    }

    fn profile_breaks(&self) -> &[f64] {
        &self.0.breaks
    }

    fn profile_knots(&self) -> &[f64] {
        self.0.spline.knots()
    }

    fn varies_along_profile(&self) -> bool {
        true
    }

    fn resolved(&self) -> Vec<(&'static str, f64)> {
        self.0.values.clone()
    }
}

/// Across the face.
#[derive(Debug)]
struct Lead(Line);

impl Modification for Lead {
    fn lead(&self, z: f64) -> f64 {
        self.0.depth(z)
    }

    fn lead_quadratic(&self, _z: f64) -> Option<[f64; 3]> {
        None
    }

    fn lead_breaks(&self) -> &[f64] {
        &self.0.breaks
    }

    fn varies_along_face(&self) -> bool {
        true
    }

    fn resolved(&self) -> Vec<(&'static str, f64)> {
        self.0.values.clone()
    }
}

/// Over both.
#[derive(Debug)]
struct Surface {
    grid: Grid,
    /// Along the profile and across the face.
    breaks: [Vec<f64>; 2],
    values: Vec<(&'static str, f64)>,
}

impl Modification for Surface {
    fn surface(&self, roll: f64, z: f64) -> f64 {
        self.grid.value(roll, z)
    }

    fn surface_rates(&self, roll: f64, z: f64) -> Option<[f64; 3]> {
        Some(self.grid.rates(roll, z))
    }

    fn varies_over_surface(&self) -> bool {
        true
    }

    fn profile_knots(&self) -> &[f64] {
        self.grid.along()
    }

    fn profile_breaks(&self) -> &[f64] {
        &self.breaks[0]
    }

    fn lead_breaks(&self) -> &[f64] {
        &self.breaks[1]
    }

    fn resolved(&self) -> Vec<(&'static str, f64)> {
        self.values.clone()
    }
}
