//! Influences of loads on the stress at the root, from meshes that are graded to the sharpest place of its curve.
//!
//! Those meshes are others than the compliances have: a fillet is much sharper than what bends a tooth. Must not know: how it
//! is solved.

use super::{HALVED, Task, inclined};
use crate::gear::compliance::{ComplianceError, RootInfluences};
use crate::gear::finite_elements::gear_model::{FlankLoad, StressInfluences};
use crate::gear::finite_elements::mesh::Sizing;
use crate::numeric::chebyshev::Series;
use crate::numeric::parabola::peak;
use declare::work::Work;

/// Of loads at the nodes of the tables, on the tooth and on as many to either side as the tables know, and of one along the
/// flank at the last of them where contact is resolved; SI. The error is estimated from a mesh of which each element is four
/// of the other.
pub(super) fn influences(task: &Task, across: usize, work: &mut Work) -> Result<RootInfluences, ComplianceError> {
    let mut loads: Vec<FlankLoad> = task.rolls.iter().map(|&roll| FlankLoad::normal(roll)).collect();
    let normal = loads.len();
    if task.resolved {
        loads.push(inclined::loads(task.rolls[normal - 1])[0]);
    }
    let mut at = |across: usize, parts: usize, loads: &[FlankLoad], neighbours: u32| {
        task.factorised(across, &Sizing::graded(across, parts), work)?
            .stress_influences_of(loads, neighbours)
            .map_err(|error| task.failed(across, error))
    };
    let found = at(across, HALVED, &loads, task.neighbours)?;
    let coarse = at(across / HALVED, 1, &loads[..normal], 0)?;
    let own = &found.stresses[task.neighbours as usize];
    // As if the error were halved by elements half as long; it falls to a third to a sixth.
    let error_estimate = change(own, &found, &coarse);

    let module = task.gear.specification.module;
    let (lower, upper) = (task.root.form_roll, task.gear.flank_end.roll);
    let series = |loads: &Vec<Vec<f64>>, place: usize| {
        let values: Vec<f64> = loads[..normal].iter().map(|stresses| stresses[place] / module).collect();
        Series::from_values(lower, upper, &values)
    };
    let along = |loads: &Vec<Vec<f64>>| {
        loads[normal..]
            .iter()
            .flat_map(|turned| inclined::along(turned, &loads[normal - 1]))
            .map(|stress| stress / module)
            .collect()
    };
    let count = found.gauges.len();
    Ok(RootInfluences {
        radii: found.gauges.iter().map(|gauge| module * libm::hypot(gauge.place[0], gauge.place[1])).collect(),
        lengths: found.gauges.iter().map(|gauge| module * gauge.length).collect(),
        stresses: found.stresses.iter().map(|loads| (0..count).map(|place| series(loads, place)).collect()).collect(),
        along: found.stresses.iter().map(along).collect(),
        error_estimate,
    })
}

/// The largest relative change of a load's largest stress from a coarser mesh.
fn change(own: &[Vec<f64>], fine: &StressInfluences, coarse: &StressInfluences) -> f64 {
    let largest = |of: &StressInfluences, stresses: &[f64]| {
        let lengths: Vec<f64> = of.gauges.iter().map(|gauge| gauge.length).collect();
        peak(&lengths, &lengths, stresses).map_or(f64::NAN, |(stress, _)| stress)
    };
    let pairs = own.iter().zip(&coarse.stresses[0]);
    pairs.map(|(own, other)| (largest(coarse, other) / largest(fine, own) - 1.0).abs()).fold(0.0, f64::max)
}
