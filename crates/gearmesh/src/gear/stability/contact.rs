//! The conditions that an equilibrium must meet, recomputed from the tables it was solved from.
//!
//! Gaps come from the search for the least one, compliances from the tables of the teeth, the passage through a crowned face from its
//! closed form; the solver's own quick copies are not used. Must not know: how an equilibrium is found.

use super::{Built, Case, Finding, ROUNDINGS, TABLE};
use crate::gear::compliance::ContactLaw;
use crate::gear::contact::CornerContact;
use crate::gear::contact::flattening::{Bodies, InSeries, Logarithmic, combined_radius};
use crate::gear::contact::gap::Gaps;
use crate::gear::mesh::answers::curve::Wanted;
use crate::gear::mesh::{Equilibrium, Loaded};
use crate::numeric::complementarity::MOST_SPRINGS;

/// The places in a zone that are checked.
const SHARES: [f64; 9] = [0.0, 1e-9, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0 - 1e-9, 1.0];
/// Distance from a zone's end, in base pitches, and how many deflections per base pitch a curve may rise there besides
/// what reliefs make it rise.
const NEAR: f64 = 1e-9;
const STEEPEST: f64 = 1e3;
/// A gap that no pair closes \[m\].
const FAR: f64 = 1e3;
/// What complementarity keeps where nothing large is subtracted.
const PROMISED: f64 = 1e-12;
/// What copies of gaps keep of the largest gap on each.
const COPY: f64 = 1e-14;
/// A few sums and products.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// The invariant whose value is the condition number of the compliance matrix.
const CONDITION: &str = "condition of the compliance matrix";

type Matrix = [[f64; MOST_SPRINGS]; MOST_SPRINGS];

/// The pairs at one position, from the tables.
struct Pairs<'a> {
    count: usize,
    /// From the smallest one up.
    gaps: [f64; MOST_SPRINGS],
    largest_gap: f64,
    /// Own compliances without a load-dependent part on the diagonal.
    compliance: Matrix,
    laws: [Option<InSeries<'a>>; MOST_SPRINGS],
}

fn pairs(built: &Built, position: f64, count: usize) -> Pairs<'_> {
    let Built { pair, design, compliance, cycle } = built;
    let gaps = Gaps::new(pair, &design.profiles(0.0));
    let bodies = Bodies::of(pair, compliance.plane);
    let s = |index: usize| cycle.path_position(position, index);
    let rolls = |index: usize| cycle.rolls(s(index));
    let mut found = Pairs {
        count,
        gaps: [0.0; MOST_SPRINGS],
        largest_gap: 0.0,
        compliance: [[0.0; MOST_SPRINGS]; MOST_SPRINGS],
        laws: [const { None }; MOST_SPRINGS],
    };
    for j in 0..count {
        let [pinion, gear] = rolls(j);
        // Pairs whose tips would pass each other are out of reach.
        found.gaps[j] = gaps.at(s(j)).unwrap_or(FAR);
        if found.gaps[j] < FAR {
            found.largest_gap = found.largest_gap.max(found.gaps[j]);
        }
        let [of_pinion, of_gear] = cycle.inclinations(s(j));
        let teeth = compliance.pinion.total(pinion)
            + compliance.pinion.added(of_pinion)
            + compliance.gear.total(gear)
            + compliance.gear.added(of_gear);
        let contact =
            if compliance.contact == Some(ContactLaw::Linear) { bodies.linear() / cycle.face_width } else { 0.0 };
        found.compliance[j][j] = teeth + contact;
        if let Some(contact @ (ContactLaw::LoadDependent | ContactLaw::Resolved)) = compliance.contact {
            let depths = [compliance.pinion.contact_depth.value(pinion), compliance.gear.contact_depth.value(gear)];
            let radius = combined_radius(cycle.radii(s(j)));
            let resolved = contact == ContactLaw::Resolved;
            let law = if resolved { Logarithmic::half_planes } else { Logarithmic::weber };
            let alone = law(&bodies, radius, depths).in_series(0.0);
            found.laws[j] = Some(match cycle.tips(s(j)) {
                None => alone,
                Some(tips) => alone.at_tips(tips),
            });
        }
        for k in 0..j {
            let [behind, ahead] = [rolls(k), rolls(j)];
            let pinion = compliance.pinion.neighbour(j - k - 1, [behind[0], ahead[0]], of_pinion);
            let gear = compliance.gear.neighbour(j - k - 1, [ahead[1], behind[1]], cycle.inclinations(s(k))[1]);
            let cross = if compliance.coupled { pinion + gear } else { 0.0 };
            (found.compliance[j][k], found.compliance[k][j]) = (cross, cross);
        }
    }
    let smallest = found.gaps[..count].iter().copied().fold(f64::INFINITY, f64::min);
    found.gaps[..count].iter_mut().for_each(|gap| *gap -= smallest);
    found
}

/// Mean and peak-to-peak transmission error, and a finding for each invariant; or, where flanks approach by more than
/// what is modelled, why there is none.
pub(super) fn check(case: &Case, built: &Built, findings: &mut Vec<Finding>) -> Result<[f64; 2], String> {
    let loading = built.cycle.loaded(&built.design, case.torque);
    let (points, summary) = loading.curve_and_summary(Wanted { harmonics: 3, pressure: true, ..Wanted::default() });
    loading.check_approach(summary.largest.value).map_err(|beyond| beyond.to_string())?;
    let numbers = points.iter().flat_map(|point| {
        let pressure = point.pressed.map_or(0.0, |pressed| pressed.largest);
        let own = [point.transmission_error, point.unloaded_transmission_error, point.secant_stiffness, pressure];
        own.into_iter().chain([point.tangent_stiffness]).chain(point.loads)
    });
    let sums = [
        summary.mean,
        summary.peak_to_peak,
        summary.variance,
        summary.unloaded_peak_to_peak,
        summary.loaded_contact_ratio,
        summary.largest_load_share,
    ];
    let strange = numbers.chain(sums).chain(summary.harmonics.clone()).filter(|value| !value.is_finite()).count();
    findings.push(Finding::new("no NaN, no infinity", strange as f64, 0.0));

    let (mut imbalance, mut negative, mut condition) = (0.0_f64, 0.0_f64, 1.0_f64);
    let (mut growth, mut softening) = (0.0_f64, 0.0_f64);
    let mut jump = (0.0_f64, 1.0_f64);
    let mut residual = Some((0.0_f64, ROUNDING));
    let ladder = [1.0, 2.0].map(|factor| built.cycle.loaded(&built.design, case.torque * factor));
    for zone in &built.cycle.zones {
        for share in SHARES {
            let position = zone.start + share * (zone.end - zone.start);
            let state = loading.state(position, zone.pairs);
            let springs = built.cycle.springs(zone.pairs);
            let loads = &state.balance.loads[..springs];
            let sum: f64 = loads.iter().sum();
            imbalance = imbalance.max((sum / loading.force() - 1.0).abs());
            negative = loads.iter().fold(negative, |worst, load| worst.max(-load / loading.force()));
            let pairs = pairs(built, position, springs);
            condition = condition.max(pairs.condition(loads, built.cycle.face_width));
            residual = residual.and_then(|worst| {
                let of_slices = loading.unexplained_by_slices(position, zone.pairs);
                let (value, limit) = match of_slices {
                    Some([value, scale]) => (value, ROUNDING + (ROUNDING + TABLE) * scale),
                    None => pairs.residual(case, built, &state, loading.force())?,
                };
                Some(if value * worst.1 >= worst.0 * limit { (value, limit) } else { worst })
            });
            let [once, twice] = [&ladder[0], &ladder[1]].map(|load| load.state(position, zone.pairs).balance.approach);
            growth = growth.max(once / twice);
            softening = softening.max(twice / (2.0 * once));
        }
        for (end, inwards) in [(zone.start, 1.0), (zone.end, -1.0)] {
            let at = |position: f64| loading.state(position, zone.pairs).transmission_error();
            let distance = NEAR * built.cycle.period();
            let (here, near) = (at(end), at(end + inwards * distance));
            let ramps = 2.0 * case.relief / case.relief_length.max(f64::MIN_POSITIVE);
            let size = here.abs().max(near.abs());
            // Both flanks of a pair may be relieved there; a shorter relief than the distance is passed over.
            let limit = NEAR * STEEPEST + ROUNDING + (distance * ramps).min(2.0 * case.relief) / size;
            let change = (here - near).abs() / size;
            if change * jump.1 >= jump.0 * limit {
                jump = (change, limit);
            }
        }
    }
    findings.push(Finding::new("load balance", imbalance, ROUNDING));
    findings.push(Finding::new("no negative load", negative, 0.0));
    // Where slices hold each other it is that of the slices.
    findings.push(residual.map_or_else(
        || Finding::refused("complementarity", "a crowned face under the load-dependent law has no closed form"),
        |(value, limit)| Finding::new("complementarity", value, limit),
    ));
    findings.push(Finding::new("deflection grows with the load", growth, 1.0 - TABLE));
    findings.push(Finding::new("deflection grows no faster than the load", softening, 1.0 + TABLE));
    findings.push(Finding::new("continuous at the ends of zones", jump.0, jump.1));
    if built.cycle.settings.corner_contact == CornerContact::Exact {
        findings.push(across_zones(case, built, &loading));
    }
    findings.push(Finding::new(CONDITION, condition, 1.0 / f64::EPSILON.sqrt()));
    Ok([summary.mean, summary.peak_to_peak])
}

/// With corner contact pairs come and go off the line of action: nothing jumps where a zone ends and the next begins,
/// including the first after the last. What remains are quick copies, and reliefs over the rounding of a path position.
fn across_zones(case: &Case, built: &Built, loading: &Loaded) -> Finding {
    let zones = &built.cycle.zones;
    let ramps = 2.0 * case.relief / case.relief_length.max(f64::MIN_POSITIVE);
    let rounding = ROUNDINGS * f64::EPSILON * built.pair.tangent_length;
    let (mut jump, mut limit) = (0.0_f64, 0.0);
    for (index, zone) in zones.iter().enumerate() {
        let next = &zones[(index + 1) % zones.len()];
        let before = loading.state(zone.end, zone.pairs).transmission_error();
        let after = loading.state(next.start, next.pairs).transmission_error();
        let size = before.abs().max(after.abs());
        let allowed = TABLE + ROUNDING + (rounding * ramps).min(2.0 * case.relief) / size;
        if (before - after).abs() * limit >= jump * size * allowed {
            (jump, limit) = ((before - after).abs() / size, allowed);
        }
    }
    Finding::new("continuous from zone to zone", jump, limit)
}

/// The condition number that [`check`] found.
pub(super) fn condition_found(findings: &[Finding]) -> f64 {
    findings.iter().find(|finding| finding.invariant == CONDITION).map_or(1.0, |finding| finding.value)
}

impl Pairs<'_> {
    /// The largest load that the penetrations do not explain, over the force, and what rounding may leave; the
    /// penetration is the difference of approach and gap, so a pair's own limit grows with what is subtracted.
    fn residual(&self, case: &Case, built: &Built, state: &Equilibrium, force: f64) -> Option<(f64, f64)> {
        let crown = case.crown();
        let width = built.cycle.face_width;
        let balance = &state.balance;
        // The solver takes copies of the gaps, which are as near as this to the largest gap on each.
        let copied = COPY * 2.0 * case.relief;
        let mut worst = (0.0_f64, ROUNDING);
        for j in 0..self.count {
            if self.gaps[j] > 0.5 * FAR {
                worst = if balance.loads[j] > 0.0 { (f64::INFINITY, ROUNDING) } else { worst };
                continue;
            }
            let others: f64 =
                (0..self.count).filter(|k| *k != j).map(|k| self.compliance[j][k] * balance.loads[k]).sum();
            let penetration = balance.approach - self.gaps[j] - others;
            let own = self.compliance[j][j];
            let (value, stiffness) = if let Some(law) = &self.laws[j] {
                if crown != 0.0 {
                    return None;
                }
                let load = balance.loads[j] / width;
                let needed = balance.loads[j] * own + law.penetration(load);
                (((penetration.max(0.0) - needed) / own).abs(), 1.0 / own)
            } else {
                let w = penetration.max(0.0);
                let share = if w >= crown { 1.0 } else { (w / crown).sqrt() };
                ((share * (w - crown * share * share / 3.0) / own - balance.loads[j]).abs(), share / own)
            };
            let taken = balance.approach + self.largest_gap + others.abs();
            let by_copies = stiffness * copied / force;
            let by_differences = ROUNDING + (ROUNDING + TABLE) * (1.0 + stiffness * taken / force);
            // Copies are no reason to promise less than is promised of every pair.
            let limit = (by_differences + by_copies).min(by_differences.max(PROMISED));
            if value / force * worst.1 >= worst.0 * limit {
                worst = (value / force, limit);
            }
        }
        Some(worst)
    }

    /// Largest over smallest eigenvalue of the compliance matrix of the loaded pairs, by Jacobi's rotations.
    fn condition(&self, loads: &[f64], width: f64) -> f64 {
        let loaded: Vec<usize> = (0..self.count).filter(|j| loads[*j] > 0.0).collect();
        let n = loaded.len();
        let mut matrix: Vec<Vec<f64>> =
            loaded.iter().map(|j| loaded.iter().map(|k| self.compliance[*j][*k]).collect()).collect();
        for (row, j) in loaded.iter().enumerate() {
            if let Some(law) = &self.laws[*j] {
                matrix[row][row] += law.penetration(loads[*j] / width) / loads[*j];
            }
        }
        for _ in 0..30 {
            for p in 0..n {
                for q in p + 1..n {
                    if matrix[p][q] == 0.0 {
                        continue;
                    }
                    let theta = 0.5 * libm::atan2(2.0 * matrix[p][q], matrix[q][q] - matrix[p][p]);
                    let (sine, cosine) = libm::sincos(theta);
                    let turn = |a: &mut f64, b: &mut f64| (*a, *b) = (cosine * *a - sine * *b, sine * *a + cosine * *b);
                    for row in &mut matrix {
                        let (before, after) = row.split_at_mut(q);
                        turn(&mut before[p], &mut after[0]);
                    }
                    let (before, after) = matrix.split_at_mut(q);
                    before[p].iter_mut().zip(&mut after[0]).for_each(|(a, b)| turn(a, b));
                }
            }
        }
        let values = (0..n).map(|k| matrix[k][k]);
        let (minimum, maximum) =
            values.fold((f64::INFINITY, 0.0_f64), |(minimum, maximum), value| (minimum.min(value), maximum.max(value)));
        if minimum > 0.0 { maximum / minimum } else { f64::INFINITY }
    }
}

#[cfg(test)]
mod tests;
