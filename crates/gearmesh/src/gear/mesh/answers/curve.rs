//! The curve of the transmission error over a mesh cycle, and its summary.
//!
//! Must not know: tables, units other than SI.

use super::pressure::{LargestPressure, Pressed, largest_pressure, pressed};
use super::root_stress::{LargestRootStress, largest_root_stress, root_stress};
use super::walk::{refining, span_length, trace, walk};
use crate::gear::geometry::Side;
use crate::gear::mesh::equilibrium::beyond_model::BeyondModel;
use crate::gear::mesh::equilibrium::load_case::LoadCase;
use crate::gear::mesh::equilibrium::state::Equilibrium;
use crate::gear::mesh::trace::{Extremum, NODES, Span, Trace};
use crate::numeric::complementarity::PerSpring;
use crate::numeric::harmonics;

/// One position of a curve. Where the number of pairs in contact changes there are two points at one place, one for
/// each side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// τ: distance from the position at which a pair starts contact \[m\].
    pub cycle_position: f64,
    /// s of the newest pair, from A to one base pitch behind it (to D, where 1 < ε_α < 2) \[m\].
    pub path_position: f64,
    /// The pinion's roll angle of the newest pair \[rad\].
    pub roll_angle: f64,
    /// Pairs inside the path of contact, loaded or not.
    pub pairs: usize,
    /// Pairs that carry load.
    pub loaded_pairs: usize,
    /// δ \[m\].
    pub transmission_error: f64,
    /// δ without load at the same position \[m\].
    pub unloaded_transmission_error: f64,
    /// Load of each pair \[N\], the newest first, then those one, two … base pitches ahead; with corner contact the pair
    /// before A comes before them all.
    pub loads: PerSpring,
    /// Load of the newest pair inside the path of contact \[N\].
    pub newest_load: f64,
    /// F / (δ − δ without load) \[N/m\]; NaN without load.
    pub secant_stiffness: f64,
    /// dF/dδ \[N/m\]; NaN without load.
    pub tangent_stiffness: f64,
    /// How hard the flanks press on each other, if it was asked for.
    pub pressed: Option<Pressed>,
    /// The largest root stress of pinion and gear \[Pa\], if it was asked for and is known.
    pub root_stress: Option<[f64; 2]>,
}

/// What a curve amounts to.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Integral mean over the cycle \[m\].
    pub mean: f64,
    /// PPTE: the largest less the smallest δ \[m\].
    pub peak_to_peak: f64,
    /// The largest δ \[m\], and where it is.
    pub largest: Extremum,
    /// The smallest δ \[m\], and where it is.
    pub smallest: Extremum,
    /// Integral mean of the squared deviation from the mean \[m²\].
    pub variance: f64,
    /// f = 1/variance \[1/m²\], the measure of `mei2016`; none where nothing varies.
    pub reciprocal_variance: Option<f64>,
    /// Amplitudes of the harmonics 1, 2 … of the mesh frequency \[m\].
    pub harmonics: Vec<f64>,
    /// Peak-to-peak of the transmission error without load \[m\].
    pub unloaded_peak_to_peak: f64,
    /// Mean number of loaded pairs: the contact ratio under load.
    pub loaded_contact_ratio: f64,
    /// The largest share of the load that one pair carries.
    pub largest_load_share: f64,
    /// The largest pressure in the cycle, if it was asked for.
    pub largest_pressure: Option<LargestPressure>,
    /// The largest root stress of pinion and gear in the cycle, if it was asked for and is known.
    pub largest_root_stress: Option<[LargestRootStress; 2]>,
}

/// What a summary holds beyond the minimum.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    /// How many harmonics.
    pub harmonics: usize,
    /// Whether the pressure is found at every position.
    pub pressure: bool,
    /// Whether the stress at the roots is found at every position, of a cycle that knows what loads do to them.
    pub root_stress: bool,
}

impl Point {
    /// What all pairs carry together \[N\]: the load, up to rounding.
    #[must_use]
    pub fn load(&self) -> f64 {
        self.loads.iter().sum()
    }

    fn is_at(&self, extremum: &Extremum) -> bool {
        self.cycle_position.total_cmp(&extremum.position).is_eq() && self.pairs == extremum.pairs
    }
}

/// The largest share that one pair has of what all carry. A sum of terms that are not negative is rounded to no less than
/// any of them, so no share exceeds 1, and a single pair has all of it.
fn largest_share(loads: &PerSpring) -> f64 {
    let load: f64 = loads.iter().sum();
    if load > 0.0 { loads.iter().copied().fold(0.0, f64::max) / load } else { 0.0 }
}

/// The curve at the positions of the spans only, without those that only integrals need.
#[must_use]
pub(in crate::gear::mesh) fn curve(case: &LoadCase, wanted: Wanted) -> Vec<Point> {
    let mut points = room_for_points(case, wanted, 8.0);
    walk(&case.for_values(), span_length(case, wanted.harmonics), |span, states| {
        extend(case, &mut points, span, states, wanted);
    });
    points
}

/// Adds the points of a span; where it joins the one before smoothly their common point is taken once.
pub(in crate::gear::mesh) fn extend(
    case: &LoadCase,
    points: &mut Vec<Point>,
    span: &Span,
    states: &[Equilibrium; NODES],
    wanted: Wanted,
) {
    points.extend((joined(case, points, span)..NODES).map(|node| {
        let position = span.position(&case.cycle.rows, node);
        point_at(case, position, span.pairs, &states[node], wanted)
    }));
}

/// What [`LoadCase::curve_and_summary`] gives, without the curve.
#[must_use]
pub(in crate::gear::mesh) fn summary(case: &LoadCase, wanted: Wanted) -> Summary {
    curve_and_summary(case, wanted).1
}

/// Both, from the same positions; the curve also has the points of its extrema.
#[must_use]
pub(in crate::gear::mesh) fn curve_and_summary(case: &LoadCase, wanted: Wanted) -> (Vec<Point>, Summary) {
    let cycle = case.cycle;
    let rows = &cycle.rows;
    let mut points = room_for_points(case, wanted, if case.refines { 24.0 } else { 8.0 });
    let (mut error, mut pressure, mut roots) =
        (Trace::default(), Trace::default(), [Trace::default(), Trace::default()]);
    let (mut loaded, mut share) = (0.0, 0.0_f64);
    walk(case, span_length(case, wanted.harmonics), |span, states| {
        error.spans.push((*span, states.map(|state| state.transmission_error())));
        // They are the same all over the span, up to its ends.
        loaded += (span.end - span.start) * states[1].loaded_pairs() as f64;
        share = states.iter().map(|state| largest_share(&state.balance.loads)).fold(share, f64::max);
        if !wanted.pressure && !wanted.root_stress {
            return extend(case, &mut points, span, states, wanted);
        }
        let here = points_of_span(case, span, states, wanted);
        points.extend_from_slice(&here[joined(case, &points, span)..]);
        if wanted.pressure {
            pressure.spans.push((*span, here.map(|point| point.pressed.map_or(0.0, |pressed| pressed.largest))));
        }
        for (gear, root) in roots.iter_mut().enumerate().filter(|_| here[0].root_stress.is_some()) {
            root.spans.push((*span, here.map(|point| point.root_stress.map_or(0.0, |of_gears| of_gears[gear]))));
        }
    });
    let value = |position: f64, pairs: usize| case.state(position, pairs).transmission_error();
    let (largest, smallest) = (error.largest(rows, refining(case), value), error.smallest(rows, refining(case), value));
    let nodes = error.nodes(rows);
    let (mean, variance) = harmonics::mean_and_variance(cycle.period(), &nodes);
    let nominal = case.without_load();
    let unloaded = extremes(&nominal);
    add_extremes(case, &mut points, [largest, smallest], unloaded, wanted);
    let summary = Summary {
        mean,
        peak_to_peak: largest.value - smallest.value,
        largest,
        smallest,
        variance,
        reciprocal_variance: (variance > 0.0).then(|| 1.0 / variance),
        harmonics: harmonics::amplitudes(cycle.period(), &nodes, wanted.harmonics),
        unloaded_peak_to_peak: difference(&nominal, unloaded),
        loaded_contact_ratio: loaded / cycle.period(),
        largest_load_share: points.iter().map(|point| largest_share(&point.loads)).fold(share, f64::max),
        largest_pressure: wanted.pressure.then(|| largest_pressure(case, &pressure)),
        largest_root_stress: largest_root_stress(case, &roots),
    };
    (points, summary)
}

/// The peak-to-peak transmission error \[m\], infinite beyond the model: the lean path for optimisers.
#[must_use]
pub(in crate::gear::mesh) fn peak_to_peak(case: &LoadCase) -> f64 {
    if case.force.is_finite() { checked_peak_to_peak(case).unwrap_or(f64::INFINITY) } else { f64::INFINITY }
}

/// The peak-to-peak transmission error \[m\].
///
/// # Errors
/// If the gears approach by more than is modelled.
pub(in crate::gear::mesh) fn checked_peak_to_peak(case: &LoadCase) -> Result<f64, BeyondModel> {
    let [largest, smallest] = extremes(&case.for_values());
    case.check_approach(largest.value)?;
    Ok(largest.value - smallest.value)
}

/// The largest and the smallest transmission error.
pub(in crate::gear::mesh) fn extremes(case: &LoadCase) -> [Extremum; 2] {
    let (trace, rows) = (trace(case), &case.cycle.rows);
    let value = |position: f64, pairs: usize| case.state(position, pairs).transmission_error();
    [trace.largest(rows, refining(case), value), trace.smallest(rows, refining(case), value)]
}

pub(in crate::gear::mesh) fn difference(case: &LoadCase, [largest, smallest]: [Extremum; 2]) -> f64 {
    if case.check_approach(largest.value).is_ok() { largest.value - smallest.value } else { f64::INFINITY }
}

/// Adds the points of the extrema, under load and without, so that a curve spans what its summary says.
#[allow(clippy::float_cmp)] // asks whether a point is there, not whether numbers agree
fn add_extremes(
    case: &LoadCase,
    points: &mut Vec<Point>,
    loaded: [Extremum; 2],
    unloaded: [Extremum; 2],
    wanted: Wanted,
) {
    let at = |extremum: &Extremum| {
        let state = case.state(extremum.position, extremum.pairs);
        point_at(case, extremum.position, extremum.pairs, &state, wanted)
    };
    // At an end of a span the extremum may be the limit from inside, of which rounding has lost sight at the end itself.
    for extremum in loaded {
        if !points.iter().any(|point| point.is_at(&extremum) && point.transmission_error == extremum.value) {
            insert(points, Point { transmission_error: extremum.value, ..at(&extremum) });
        }
    }
    for extremum in unloaded {
        if !points.iter().any(|point| point.is_at(&extremum) && point.unloaded_transmission_error == extremum.value) {
            insert(points, Point { unloaded_transmission_error: extremum.value, ..at(&extremum) });
        }
    }
}

/// The variance of the transmission error over the cycle \[m²\], an integral mean, infinite beyond what is modelled:
/// the lean path for optimisers.
#[must_use]
pub(in crate::gear::mesh) fn variance(case: &LoadCase) -> f64 {
    if !case.force.is_finite() {
        return f64::INFINITY;
    }
    let trace = trace(case);
    if !trace.spans.iter().flat_map(|(_, values)| values).all(|value| case.check_approach(*value).is_ok()) {
        return f64::INFINITY;
    }
    harmonics::mean_and_variance(case.cycle.period(), &trace.nodes(&case.cycle.rows)).1
}

/// How many of a span's points are there already: where two spans join smoothly, their common one.
#[allow(clippy::float_cmp)] // the start of a span is a copy of the end of the one before
fn joined(case: &LoadCase, points: &[Point], span: &Span) -> usize {
    let is_same = |last: &Point| last.cycle_position == span.start && last.pairs == span.pairs;
    usize::from(points.last().is_some_and(is_same) && !case.jumps_at(span.start))
}

/// Room for the curve: `more` spans are added at zone ends, relief starts and first touches, or cut for integrals.
fn room_for_points(case: &LoadCase, wanted: Wanted, more: f64) -> Vec<Point> {
    let spans = case.cycle.period() / span_length(case, wanted.harmonics) + more;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // far below 2^53
    Vec::with_capacity(spans as usize * NODES)
}

pub(in crate::gear::mesh) fn points_of_span(
    case: &LoadCase,
    span: &Span,
    states: &[Equilibrium; NODES],
    wanted: Wanted,
) -> [Point; NODES] {
    std::array::from_fn(|node| point_at(case, span.position(&case.cycle.rows, node), span.pairs, &states[node], wanted))
}

#[inline]
fn point_at(case: &LoadCase, position: f64, pairs: usize, state: &Equilibrium, wanted: Wanted) -> Point {
    // What takes calls comes first, so that nothing else has to wait in memory.
    let pressed = wanted.pressure.then(|| pressed(case, position, pairs, state));
    let root_stress = (wanted.root_stress.then(|| root_stress(case, position, pairs, state)).flatten())
        .map(|of_gears| of_gears.map(|root| root.stress));
    let cycle = case.cycle;
    let path_position = cycle.path_position(position, cycle.newest());
    let loads = state.balance.loads;
    let stiffness = |value: f64| if case.force > 0.0 { value } else { f64::NAN };
    Point {
        cycle_position: position,
        path_position,
        roll_angle: cycle.pair.roll(Side::Pinion, path_position),
        pairs,
        loaded_pairs: state.loaded_pairs(),
        transmission_error: state.transmission_error(),
        unloaded_transmission_error: state.unloaded,
        loads,
        newest_load: loads[cycle.newest()],
        secant_stiffness: stiffness(case.force / state.balance.approach),
        tangent_stiffness: stiffness(state.balance.slope),
        pressed,
        root_stress,
    }
}

/// Puts a point where it belongs by its position, among those with as many pairs.
fn insert(points: &mut Vec<Point>, new: Point) {
    let zone = points.iter().position(|point| point.pairs == new.pairs).unwrap_or(points.len());
    let before = |point: &&Point| point.pairs == new.pairs && point.cycle_position <= new.cycle_position;
    let behind = points[zone..].iter().take_while(before).count();
    points.insert(zone + behind, new);
}
