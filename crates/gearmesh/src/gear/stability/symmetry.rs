//! What no choice of units and no name of a gear may change: everything scaled, and the gears in each other's place.
//!
//! Scaled by a power of two every rounding is the same, so any difference comes from a length or a load that somebody
//! wrote into the code. With the gears swapped the same contact runs backwards. Must not know: the second evaluation.

use super::{Case, Finding, MOST_LOST};
use crate::gear::mesh::answers::curve::Wanted;

/// 2¹⁰ and 2⁵ either way: the first that leaves every length in its range.
const SCALES: [f64; 4] = [1.0 / 1024.0, 1024.0, 0.03125, 32.0];

/// Mean and peak-to-peak.
pub(super) fn values(case: &Case) -> Result<[f64; 2], String> {
    let built = case.build().map_err(|(_, reason)| reason)?;
    let summary = built.cycle.loaded(&built.design, case.torque).summary(Wanted::default());
    Ok([summary.mean, summary.peak_to_peak])
}

/// Relative changes of both per relative change of what rounding touches first, summed, by the kernels themselves: as
/// [`super::precise::conditions`] where there is no second evaluation. A change that makes the case impossible counts for nothing.
pub(super) fn conditions(case: &Case, here: [f64; 2]) -> [f64; 2] {
    // Far above what the kernels lose, far below what a condition number need be known to.
    const STEP: f64 = 1e-6;
    fn shorter(case: &mut Case, gear: usize) {
        let of = &mut case.gears[gear];
        let natural = of.module * (0.5 * f64::from(of.teeth) + of.rack.addendum + of.profile_shift);
        of.tip_radius = Some(of.tip_radius.unwrap_or(natural) / (1.0 + STEP));
    }
    let changes: [fn(&mut Case); 9] = [
        |case| case.gears.iter_mut().for_each(|gear| gear.pressure_angle *= 1.0 + STEP),
        |case| case.gears[0].profile_shift += STEP,
        |case| case.gears[1].profile_shift += STEP,
        |case| shorter(case, 0),
        |case| shorter(case, 1),
        |case| case.torque *= 1.0 + STEP,
        |case| case.relief *= 1.0 + STEP,
        |case| case.relief_length += case.gears[0].module * f64::from(case.gears[0].teeth) * STEP,
        |case| case.crowning *= 1.0 + STEP,
    ];
    let mut sums = [0.0; 2];
    for change in changes {
        let mut changed = case.clone();
        change(&mut changed);
        let Ok(found) = values(&changed) else { continue };
        for (sum, (found, here)) in sums.iter_mut().zip(found.into_iter().zip(here)) {
            if here != 0.0 {
                *sum += ((found - here) / here).abs() / STEP;
            }
        }
    }
    sums
}

/// The larger of the two relative differences, each in units of what its condition number lets through.
fn difference(found: [f64; 2], expected: [f64; 2], conditions: [f64; 2]) -> f64 {
    let one = |index: usize| {
        let difference = (found[index] - expected[index]).abs();
        if difference == 0.0 { 0.0 } else { difference / (expected[index].abs() * conditions[index].max(1.0)) }
    };
    one(0).max(one(1))
}

/// Mean and peak-to-peak are compared relative to themselves and their condition numbers.
pub(super) fn check(case: &Case, values_here: [f64; 2], conditions: [f64; 2], findings: &mut Vec<Finding>) {
    let limit = f64::EPSILON * libm::pow(10.0, MOST_LOST);
    for (invariant, other, factor) in [("scale", scaled(case)), ("which gear drives", swapped(case))]
        .map(|(name, (case, factor))| (name, case, factor))
    {
        match values(&other) {
            Ok(found) => {
                let expected = values_here.map(|value| value * factor);
                findings.push(Finding::new(invariant, difference(found, expected, conditions), limit));
            }
            Err(reason) => findings.push(Finding::refused(invariant, reason)),
        }
    }
}

/// Lengths times k, torque times k³: loads grow with k², loads per width with k, displacements with k.
fn scaled(case: &Case) -> (Case, f64) {
    let by = |factor: f64| {
        let mut other = case.clone();
        for gear in &mut other.gears {
            gear.module *= factor;
            gear.face_width *= factor;
            gear.bore_radius *= factor;
            gear.tip_radius = gear.tip_radius.map(|radius| radius * factor);
            gear.thickness_allowance *= factor;
        }
        other.tips = other.tips.map(|tip| tip.scaled(factor));
        other.relief *= factor;
        other.relief_length *= factor;
        other.crowning *= factor;
        other.torque *= factor * factor * factor;
        (other, factor)
    };
    SCALES.into_iter().map(by).find(|(other, _)| other.pair().is_ok()).unwrap_or_else(|| by(SCALES[0]))
}

/// The same force on the line of action.
fn swapped(case: &Case) -> (Case, f64) {
    let mut other = case.clone();
    other.gears.swap(0, 1);
    other.tips.swap(0, 1);
    other.torque *= f64::from(case.gears[1].teeth) / f64::from(case.gears[0].teeth);
    (other, 1.0)
}
