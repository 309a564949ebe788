//! What no measurement of a flank of this gear can be: points out of order, gaps, spikes, other units, another gear.
//!
//! Must not know: what a trace becomes.

use super::{MOST_POINTS, Measured, Smoothing, outliers};
use crate::gear::geometry::Gear;
use crate::gear::modification::flank::Flank;
use declare::error::Diagnostic;
use declare::number::counted;

/// A deviation beyond this is in another unit \[m\].
const LARGEST: f64 = 0.5e-3;
/// A trace that nowhere deviates by more than this, and somewhere does, is in another unit: no machine measures so little \[m\].
const SMALLEST: f64 = 0.05e-6;
/// By how much of it the module of a drawing and that of a protocol may differ.
const SAME_MODULE: f64 = 1e-6;
/// How much farther than usual two points may be apart, of so many or more.
const GAP: f64 = 10.0;
const FEWEST_FOR_GAPS: usize = 5;
/// A deviation beyond this share of the module, and beyond this length \[m\], is in another unit.
const OF_MODULE: f64 = 0.1;
const LEAST_OF_MODULE: f64 = 50e-6;
/// By how much of the flank a trace may go beyond what there is of it, and how much of the active flank, or of the face, it must cover.
const BEYOND: f64 = 0.05;
const COVERED: f64 = 0.5;

/// A list of places, and what it is called.
type Way<'a> = (&'static str, &'a [f64]);

/// Refuses points that no measurement has, whatever the gear.
pub(super) fn consistent(stated: &Measured) -> Result<(), Diagnostic> {
    let given = along(stated);
    if let [(_, _), (second, _), ..] = given[..] {
        let names: Vec<String> = given.iter().map(|(name, _)| format!("`{name}`")).collect();
        let message = format!("the points along the profile are given twice, by {}", names.join(" and "));
        return Err(Diagnostic::new(message).of(second).help("keep one of them"));
    }
    let across = stated.face_positions.as_deref().map(|places| (Measured::NAMES.face_positions, places));
    let ways: Vec<Way> = given.first().copied().into_iter().chain(across).collect();
    if ways.is_empty() {
        return Err(no_places());
    }
    ways.iter().try_for_each(|(name, places)| ascending(name, places))?;
    let count = stated.deviations.len();
    let expected: usize = ways.iter().map(|(_, places)| places.len()).product();
    if count != expected {
        let counts: Vec<String> = ways.iter().map(|(name, places)| format!("{} `{name}`", places.len())).collect();
        let (are, found) = (if count == 1 { "is" } else { "are" }, counted(count, "deviation"));
        let message = format!("there {are} {found} for {}; {expected} are expected", counts.join(" times "));
        return Err(Diagnostic::new(message).of(Measured::NAMES.deviations));
    }
    if count > MOST_POINTS {
        let message = format!("a trace of {count} points; {MOST_POINTS} are the most");
        return Err(Diagnostic::new(message)
            .of(Measured::NAMES.deviations)
            .help("leave out points, or average them: half a wave of the cutoff is as far apart as they need to be"));
    }
    if let Some((at, value)) =
        stated.deviations.iter().enumerate().find(|(_, value)| value.is_nan() || value.abs() > LARGEST)
    {
        let message = format!("deviation {} is {}, and a deviation is 0.5 mm at the most", at + 1, millimetres(*value));
        return Err(Diagnostic::new(message).of_item(Measured::NAMES.deviations, at).help(beyond(
            &stated.deviations,
            LARGEST,
            "deviations are mostly written in micrometres: is the unit `um`?",
        )));
    }
    let largest = stated.deviations.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    if largest > 0.0 && largest < SMALLEST {
        let message = format!(
            "no deviation is larger than {:.1e} um, and no measurement tells less than {:.2} um from nothing",
            1e6 * largest,
            1e6 * SMALLEST
        );
        return Err(Diagnostic::new(message).of(Measured::NAMES.deviations).help("is the unit `mm`?"));
    }
    for (_, places, points) in lines(&ways, count) {
        let values: Vec<f64> = points.iter().map(|at| stated.deviations[*at]).collect();
        if let Some((at, beyond)) = outliers::spike(places, &values) {
            let message = format!(
                "deviation {} stands {} out of those around it, more than 10 times as far as is usual there: a spike",
                points[at] + 1,
                micrometres(beyond)
            );
            return Err(Diagnostic::new(message)
                .of_item(Measured::NAMES.deviations, points[at])
                .help("leave the point out, or measure the trace again"));
        }
    }
    let names = Measured::NAMES;
    for (name, place, of_diameter, diameter) in [
        (
            names.evaluation_start,
            stated.evaluation_start,
            names.evaluation_start_diameter,
            stated.evaluation_start_diameter,
        ),
        (names.evaluation_end, stated.evaluation_end, names.evaluation_end_diameter, stated.evaluation_end_diameter),
    ] {
        if diameter.is_none() {
            continue;
        }
        if place.is_some() {
            let message = format!("`{name}` and `{of_diameter}` say the same limit of the evaluation");
            return Err(Diagnostic::new(message).of(of_diameter).help("keep one of them"));
        }
        if given.is_empty() {
            let message = format!("`{of_diameter}` is of a trace along the profile, and this one goes across the face");
            return Err(Diagnostic::new(message).of(of_diameter).help(format!("state z as `{name}`")));
        }
    }
    match (stated.evaluation_start, stated.evaluation_end) {
        (Some(start), Some(end)) if start >= end => Err(backwards(names.evaluation_end, start, end)),
        _ => match (stated.evaluation_start_diameter, stated.evaluation_end_diameter) {
            (Some(start), Some(end)) if start >= end => Err(backwards(names.evaluation_end_diameter, start, end)),
            _ => Ok(()),
        },
    }
}

/// The remedy for deviations of which some are beyond `most` \[m\]: a unit is that of all of them, and programs write large numbers, such
/// as 999 or 32767, for points that were not measured.
fn beyond(deviations: &[f64], most: f64, unit: &str) -> String {
    let count = deviations.iter().filter(|value| value.abs() > most).count();
    if 2 * count >= deviations.len() {
        return unit.to_owned();
    }
    "the others are much smaller: if the number marks a missing value, as 999 and 32767 often do, leave the point out; in a CSV file \
     `# missing: ` and the number, above the columns, leave out every such line"
        .to_owned()
}

/// The lines of a trace or a grid: what its places are called, the places, and which deviations are theirs. Of a grid those along the profile
/// come first, then those across the face.
fn lines<'a>(ways: &'a [Way<'a>], count: usize) -> impl Iterator<Item = (&'static str, &'a [f64], Vec<usize>)> {
    let along = ways.first().map_or(1, |(_, places)| places.len());
    ways.iter().enumerate().flat_map(move |(way, (name, places))| {
        let of = move |line: usize| match way {
            0 => (line * along..(line + 1) * along).collect(),
            _ => (line..count).step_by(along).collect(),
        };
        (0..if way == 0 { count / along } else { along }).map(move |line| (*name, *places, of(line)))
    })
}

/// The lists of points along the profile that are given.
fn along(stated: &Measured) -> Vec<Way<'_>> {
    let names = Measured::NAMES;
    let all = [
        (names.roll_lengths, stated.roll_lengths.as_deref()),
        (names.roll_angles, stated.roll_angles.as_deref()),
        (names.diameters, stated.diameters.as_deref()),
    ];
    all.into_iter().filter_map(|(name, places)| Some((name, places?))).collect()
}

/// The name of the list of points along the profile that is given.
pub(super) fn profile(stated: &Measured) -> Option<&'static str> {
    along(stated).first().map(|(name, _)| *name)
}

pub(super) fn no_places() -> Diagnostic {
    let wrong = Diagnostic::new("nothing says where the deviations were measured").of(Measured::NAMES.deviations);
    wrong.help(
        "along the profile `roll_lengths`, `roll_angles` or `diameters` are needed, across the face `face_positions`, and \
         both of them for a grid",
    )
}

fn ascending(name: &'static str, places: &[f64]) -> Result<(), Diagnostic> {
    let wrong = |message: String| Err(Diagnostic::new(message).of(name));
    if places.len() < 2 {
        return wrong(format!("`{name}` has {}; 2 are the fewest of a trace", counted(places.len(), "point")));
    }
    if let Some(at) = places.windows(2).position(|ends| ends[1].is_nan() || ends[1] <= ends[0]) {
        let falls = places.windows(2).filter(|ends| ends[1] < ends[0]).count();
        if falls == places.len() - 1 {
            let message = format!("`{name}` falls all along: the trace runs the other way");
            return Err(Diagnostic::new(message)
                .of(name)
                .help("turn it round, deviations too: from the root to the tip, or to larger z"));
        }
        let (one, other) = (places[at], places[at + 1]);
        if at > 0 && other <= places[0] {
            let message = format!("`{name}` starts again at its point {}; points are in ascending order", at + 2);
            return Err(Diagnostic::new(message)
                .of(name)
                .help("columns and lines that follow each other are one list: keep one"));
        }
        #[allow(clippy::float_cmp)] // the same point twice, not one nearby
        let is = if one == other { "is the same as the one before it" } else { "is not above the one before it" };
        let message = format!("point {} of `{name}` {is}; points are in ascending order", at + 2);
        return Err(Diagnostic::new(message).of_item(name, at + 1));
    }
    if places.len() >= FEWEST_FOR_GAPS {
        let mut steps: Vec<f64> = places.windows(2).map(|ends| ends[1] - ends[0]).collect();
        let usual = *steps.select_nth_unstable_by(places.len() / 2, f64::total_cmp).1;
        if let Some(at) = places.windows(2).position(|ends| ends[1] - ends[0] > GAP * usual) {
            let times = (places[at + 1] - places[at]) / usual;
            let message = format!(
                "there is a gap between points {} and {} of `{name}`, {times:.0} times as wide as is usual among them",
                at + 1,
                at + 2
            );
            return Err(Diagnostic::new(message).of_item(name, at + 1));
        }
    }
    Ok(())
}

/// Refuses a gear that is another one than was measured.
pub(super) fn of_this_gear(stated: &Measured, gear: &Gear) -> Result<(), Diagnostic> {
    let own = &gear.specification;
    if let Some(teeth) = stated.teeth.filter(|teeth| *teeth != own.teeth) {
        let message = format!("a gear of {teeth} teeth was measured, and this one has {}", own.teeth);
        return Err(Diagnostic::new(message)
            .of(Measured::NAMES.teeth)
            .help("is the trace of the other gear of the pair?"));
    }
    if let Some(module) = stated.module.filter(|module| (module - own.module).abs() > SAME_MODULE * own.module) {
        let [module, own] = [module, own.module].map(millimetres);
        let message = format!("a gear of module {module} was measured, and this one has {own}");
        return Err(Diagnostic::new(message).of(Measured::NAMES.module));
    }
    let most = LEAST_OF_MODULE.max(OF_MODULE * own.module);
    match stated.deviations.iter().position(|value| value.abs() > most) {
        None => Ok(()),
        Some(at) => {
            let [value, module] = [stated.deviations[at], own.module].map(millimetres);
            let message = format!("deviation {} is {value}, more than a tenth of the module, {module}", at + 1);
            Err(Diagnostic::new(message).of_item(Measured::NAMES.deviations, at).help(beyond(
                &stated.deviations,
                most,
                "is the unit another one, or the point beside the flank?",
            )))
        }
    }
}

/// Refuses points between which the flank would go far beyond what was measured; `depths` hold all of the first way's places for each of
/// the second's.
pub(super) fn swings(ways: [Option<Way>; 2], depths: &[f64]) -> Result<(), Diagnostic> {
    let ways: Vec<Way> = ways.into_iter().flatten().collect();
    for (name, places, points) in lines(&ways, depths.len()) {
        let line: Vec<f64> = points.iter().map(|at| depths[*at]).collect();
        if let Some((at, beyond)) = outliers::swing(places, &line) {
            let message = format!(
                "points {} and {} of `{name}` are so near each other that the flank would swing {} beyond those around it",
                at + 1,
                at + 2,
                micrometres(beyond)
            );
            return Err(Diagnostic::new(message).of_item(name, at + 1).help("leave one of them out, or average them"));
        }
    }
    Ok(())
}

/// The roll angles of the points along the profile of this gear, if there are any.
pub(super) fn roll_angles(stated: &Measured, gear: &Gear, flank: &Flank) -> Result<Option<Vec<f64>>, Diagnostic> {
    let Some((name, places)) = along(stated).first().copied() else { return Ok(None) };
    let names = Measured::NAMES;
    let roll = |place: &f64| match name {
        name if name == names.roll_angles => Some(*place),
        name if name == names.roll_lengths => Some(*place / flank.base_radius),
        _ => flank.roll_at_diameter(*place),
    };
    let rolls: Option<Vec<f64>> = places.iter().map(roll).collect();
    let Some(rolls) = rolls else {
        let base = millimetres(2.0 * flank.base_radius);
        let message = format!("a trace from {} on, and the base circle of this gear is {base}", millimetres(places[0]));
        return Err(of_another_gear(message, name));
    };
    let written = |roll: f64| match name {
        name if name == names.roll_angles => format!("{:.4} deg", roll.to_degrees()),
        name if name == names.roll_lengths => millimetres(roll * flank.base_radius),
        _ => millimetres(flank.diameter(roll)),
    };
    let slack = BEYOND * (flank.tip_roll - flank.root_roll);
    let tip = gear.flank_end.roll.max(flank.tip_roll);
    let (first, last) = (rolls[0], rolls[rolls.len() - 1]);
    let covered = last.min(flank.tip_roll) - first.max(flank.root_roll);
    if last > tip + slack || covered < COVERED * (flank.tip_roll - flank.root_roll) {
        let message = format!(
            "the trace goes from {} to {}; the active flank of this gear goes from {} to {}, at least half of which must be \
             measured, and its tooth ends at {}",
            written(first),
            written(last),
            written(flank.root_roll),
            written(flank.tip_roll),
            written(tip)
        );
        return Err(of_another_gear(message, name));
    }
    Ok(Some(rolls))
}

/// z of the points across the face of this gear, if there are any.
pub(super) fn face_positions(stated: &Measured, flank: &Flank) -> Result<Option<Vec<f64>>, Diagnostic> {
    let Some(places) = &stated.face_positions else { return Ok(None) };
    let (half, first, last) = (0.5 * flank.face_width, places[0], places[places.len() - 1]);
    let covered = last.min(half) - first.max(-half);
    if first < -(1.0 + 2.0 * BEYOND) * half || last > (1.0 + 2.0 * BEYOND) * half || covered < COVERED * 2.0 * half {
        let message = format!(
            "the trace goes from {} to {}; the face of this gear goes from {} to {}, at least half of which must be measured",
            millimetres(first),
            millimetres(last),
            millimetres(-half),
            millimetres(half)
        );
        return Err(Diagnostic::new(message)
            .of(Measured::NAMES.face_positions)
            .help("positions count from the middle of the face; a trace of another gear fits none"));
    }
    Ok(Some(places.clone()))
}

/// Where the evaluation of a trace starts and ends: the name of the field that says it, and the roll length or z \[m\].
pub(super) struct Limits([Option<(&'static str, f64)>; 2]);

impl Limits {
    /// The part of a trace that is evaluated; what is not stated is an end of `whole`.
    pub(super) fn range(&self, whole: [f64; 2]) -> [f64; 2] {
        let at = |end: usize| self.0[end].map_or(whole[end], |(_, place)| place);
        [at(0), at(1)]
    }
}

/// The limits of the evaluation; those that are diameters as roll lengths of this gear.
pub(super) fn limits(stated: &Measured, flank: &Flank) -> Result<Limits, Diagnostic> {
    let names = Measured::NAMES;
    let both = [
        (
            names.evaluation_start,
            stated.evaluation_start,
            names.evaluation_start_diameter,
            stated.evaluation_start_diameter,
        ),
        (names.evaluation_end, stated.evaluation_end, names.evaluation_end_diameter, stated.evaluation_end_diameter),
    ];
    let mut limits = [None; 2];
    for (limit, (name, place, of_diameter, diameter)) in limits.iter_mut().zip(both) {
        *limit = match (place, diameter) {
            (Some(place), _) => Some((name, place)),
            (None, Some(diameter)) => match flank.roll_at_diameter(diameter) {
                Some(roll) => Some((of_diameter, roll * flank.base_radius)),
                None => {
                    let [diameter, base] = [diameter, 2.0 * flank.base_radius].map(millimetres);
                    let message = format!("`{of_diameter}` is {diameter}, inside the base circle of this gear, {base}");
                    return Err(of_another_gear(message, of_diameter));
                }
            },
            (None, None) => None,
        };
    }
    match limits {
        [Some((_, start)), Some((name, end))] if start >= end => Err(backwards(name, start, end)),
        limits => Ok(Limits(limits)),
    }
}

fn backwards(name: &'static str, start: f64, end: f64) -> Diagnostic {
    let message = format!("the evaluation ends at {} and starts at {}", millimetres(end), millimetres(start));
    Diagnostic::new(message).of(name)
}

/// Refuses an evaluation that is stated to begin or end beside the trace, or leaves nothing of it.
pub(super) fn evaluation(Limits(limits): &Limits, places: &[f64]) -> Result<(), Diagnostic> {
    let (first, last) = (places[0], places[places.len() - 1]);
    let slack = BEYOND * (last - first);
    let trace = format!("the trace goes from {} to {}", millimetres(first), millimetres(last));
    for (name, place) in limits.iter().flatten() {
        if *place < first - slack || *place > last + slack {
            let is_diameter = [Measured::NAMES.evaluation_start_diameter, Measured::NAMES.evaluation_end_diameter];
            let what = if is_diameter.contains(name) { "at the roll length" } else { "" };
            let message = format!("`{name}` is {what} {}, and {trace}", millimetres(*place)).replace("  ", " ");
            return Err(Diagnostic::new(message).of(name));
        }
    }
    let [from, to] = Limits(*limits).range([first, last]);
    match limits.iter().flatten().next() {
        Some((name, _)) if from.max(first) >= to.min(last) => {
            Err(Diagnostic::new(format!("the evaluation leaves nothing of the trace: {trace}")).of(name))
        }
        _ => Ok(()),
    }
}

/// Refuses a smoothing that leaves nothing of what was measured over this length \[m\].
pub(super) fn smoothed(smoothing: &Smoothing, over: f64) -> Result<(), Diagnostic> {
    match smoothing {
        Smoothing::Gaussian { cutoff } if *cutoff > over => {
            let [cutoff, over] = [*cutoff, over].map(millimetres);
            let message = format!("the cutoff of {cutoff} is longer than the trace, which goes over {over}");
            Err(Diagnostic::new(message).of("cutoff").help("ISO 1328-1 has a thirtieth of the evaluated length"))
        }
        _ => Ok(()),
    }
}

fn of_another_gear(message: String, name: &'static str) -> Diagnostic {
    Diagnostic::new(message)
        .of(name)
        .help("is it of a gear with another module or number of teeth, or of the other gear of the pair?")
}

fn millimetres(length: f64) -> String {
    format!("{:.6} mm", 1e3 * length)
}

fn micrometres(length: f64) -> String {
    format!("{:.3} um", 1e6 * length)
}
