//! What a stage of the kind `ste` will take: so much per design and torque.
//!
//! Must not know: how a curve is found.

use super::pressures::{self, CellRow};
use super::rows::{Contacts, Left};
use super::tables::{cost, curve, harmonics, summary};
use super::{MOST_AT_ONCE, Ste, friction, samples};
use crate::stage::{Ahead, Demand, Estimate, RowCount, common, names, root_influences, simpler};
use declare::work::Work;
use gearmesh::gear::mesh::answers::curve::Point;
use gearmesh::gear::work::{CONTACT_PRESSURES, CONTACT_SOLVES, ROOT_STRESSES};
use gearmesh::numeric::complementarity::MOST_SPRINGS;

/// Solves for each row of a curve: extrema, first touches, the coarser curve for the error.
const SOLVES_PER_ROW: f64 = 2.3;
/// Solves for an equilibrium with friction in it.
const RESISTED: usize = 4;
/// Bytes of a pair with its compliances, ready to be loaded.
const CYCLE: u64 = 1 << 20;
/// Of a large machine: each holds the points of some curves, before they are rows.
const THREADS: usize = 64;

impl Ste {
    pub fn ahead(&self, demand: &Demand, ahead: &Ahead) -> Estimate {
        let ports = (1..=self.designs.len()).map(|index| format!("designs_{index}"));
        let designs = ports.map(|port| ahead.rows(&port, names::designs::TABLE)).fold(RowCount::NONE, RowCount::and);
        let stated = &self.deviations.stated()[..];
        let loads = self.torque.len().saturating_mul(self.deviations.combinations().len());
        let curves = designs.times(RowCount::exact(loads));
        let of_each = common::curve_rows(self.settings(), self.harmonics);
        let rows = curves.times(RowCount::about(of_each));
        let points = rows.count.min((THREADS * MOST_AT_ONCE).saturating_mul(of_each) as u64);
        let (pressed, of_pairs) = (pressures::are_wanted(demand), pressures::of_pairs_are_wanted(demand));
        // Nobody knows yet which designs vary across the face.
        let of_map = MOST_SPRINGS.saturating_mul(self.pressure_positions).saturating_mul(self.settings().slices.max(1));
        let cells = curves.times(RowCount::at_most(of_map));
        let mapped = if demand.table(pressures::TABLE) { self.pressure_positions } else { 0 };
        let held = if mapped > 0 { cells.count.saturating_mul(2 * size_of::<CellRow>() as u64) } else { 0 };
        let positions = curves.times(RowCount::exact(mapped)).index();
        let samples = if demand.table(samples::TABLE) || demand.table(samples::SUMMARY) { self.samples } else { 0 };
        let sampled = curves.times(RowCount::exact(samples)).index();
        // Of this many rows the product is far below 2^53, or the estimate is beyond any limit.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let solves = (SOLVES_PER_ROW * rows.count as f64) as usize;
        // Long relief in the place of each design.
        let solves = solves.saturating_mul(if self.simpler_within.is_some() { 1 + simpler::TRIED } else { 1 });
        let of_each_row = |is_wanted: bool| if is_wanted { rows.index() } else { 0 };
        let again = of_each_row(of_pairs);
        let places = self.friction.as_ref().map_or(0, |friction| friction.positions);
        let places = if demand.table(friction::TABLE) { places } else { 0 };
        let rubbing = of_each_row(self.is_resisted() || friction::of_summary_is_wanted(demand))
            .saturating_add(of_each_row(friction::of_curve_is_wanted(demand)))
            .saturating_add(curves.times(RowCount::exact(places)).index());
        let solves = solves.saturating_add(sampled).saturating_add(positions).saturating_add(again);
        let solves = solves.saturating_add(rubbing).saturating_mul(if self.is_resisted() { RESISTED } else { 1 });
        // As many pairs as there are at the most.
        let along = curves.times(RowCount::at_most(MOST_SPRINGS.saturating_mul(places)));
        let work = Work::of(&CONTACT_SOLVES, solves)
            .with(&CONTACT_PRESSURES, if pressed { rows.index().saturating_add(again) } else { 0 })
            .with(&ROOT_STRESSES, if root_influences::are_wanted(demand) { rows.index() } else { 0 });
        let left = if friction::of_curve_is_wanted(demand) { size_of::<Left>() } else { 0 };
        let point = (size_of::<Point>() + if of_pairs { size_of::<Contacts>() } else { 0 } + left) as u64;
        Estimate::new(true)
            .work(&work, common::solve_times(self.settings()))
            // Room for as many points again as there are.
            .holding(CYCLE.saturating_add(points.saturating_mul(2 * point)).saturating_add(held))
            .rows(demand, summary(stated, self.friction.is_some()).schema(), curves)
            .columns(demand, curve(stated, self.friction.is_some()).schema(), rows)
            .rows(demand, harmonics(stated).schema(), curves.times(RowCount::exact(self.harmonics)))
            .rows(demand, cost(stated).schema(), curves)
            .rows(demand, samples::samples(stated).schema(), curves.times(RowCount::exact(self.samples)))
            .rows(demand, samples::summary(stated).schema(), curves)
            .columns(demand, pressures::map(stated).schema(), cells)
            .columns(demand, friction::along(stated).schema(), along)
    }
}
