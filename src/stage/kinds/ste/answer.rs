//! What one design comes to under one torque.
//!
//! Must not know: tables, other designs.

use std::time::Instant;

use super::rows::{Answer, Found};
use super::{Named, Ste, pressures};
use crate::stage::neglected_corners::Estimated;
use declare::error::Failure;
use gearmesh::gear::mesh::answers::curve::Wanted;
use gearmesh::gear::mesh::answers::sampling::{Against, Sampled};
use gearmesh::gear::mesh::{Mesh, MeshedDesign, Settings};

/// What is wanted of a curve.
pub struct WantedHere {
    pub of_curve: Wanted,
    /// The contacts of all pairs.
    pub of_pairs: bool,
    /// What friction takes over the cycle.
    pub loss: bool,
    /// What it leaves at every position.
    pub left: bool,
    /// How much tip corners matter that are left out.
    pub corners: bool,
}

/// The last design.
pub type Before<'a> = Option<(&'a Named, MeshedDesign<'a>)>;

impl Ste {
    /// `before` keeps the gaps of this design for its other torques.
    ///
    /// # Errors
    /// When the gears approach by more than is modelled.
    pub fn answer<'a>(
        &'a self,
        base: &'a Mesh,
        named: &'a Named,
        torque: f64,
        before: &mut Before<'a>,
        wanted: &WantedHere,
        iso6336: [f64; 2],
    ) -> Result<(Answer, Found), Failure> {
        let began = Instant::now();
        let (design, name, _) = named;
        if before.as_ref().is_none_or(|(other, _)| !std::ptr::eq(*other, named)) {
            *before = None;
        }
        let (_, meshed) = before.get_or_insert_with(|| (named, base.design(design)));
        let loading = self.rubbed(meshed.under(torque));
        // Most samplings differ in their positions alone, and a cycle with other slices is a copy of all its tables.
        let differs = |settings: Settings| Settings { positions: base.settings.positions, ..settings } != base.settings;
        let mut sampled = Sampled::new(loading.uses_slices(), Against::Coarser, |settings| {
            if differs(settings) {
                return self.loading(&base.sampled(settings), design, torque).peak_to_peak();
            }
            loading.with_positions(settings.positions).peak_to_peak()
        });
        let settings = self.accuracy.map_or(self.settings(), |accuracy| sampled.coarsest(self.settings(), accuracy));
        let resampled = differs(settings).then(|| base.sampled(settings));
        let loading = match &resampled {
            Some(cycle) => self.loading(cycle, design, torque),
            None => loading.with_positions(settings.positions),
        };
        let (points, summary) = loading.curve_and_summary(wanted.of_curve);
        loading
            .check_approach(summary.largest.value)
            .map_err(|beyond| Failure::new(format!("design `{name}` at {torque} N m: {beyond}")))?;
        if self.accuracy.is_none() {
            sampled.know(settings, summary.peak_to_peak);
        }
        let error = sampled.error(settings);
        let doubt = loading.contact_law_error();
        let left_out = if wanted.corners { Estimated::of(&loading, &points, &summary) } else { None };
        let cornered = loading.corner_stretches(&points);
        let lost = self.lost(&loading, wanted.loss);
        let each = |is_wanted: bool| points.iter().filter(move |_| is_wanted);
        let contacts = each(wanted.of_pairs)
            .map(|point| pressures::contacts(&loading, point.cycle_position, point.pairs))
            .collect();
        let left = self.friction.iter().flat_map(|friction| {
            each(wanted.left).map(|point| loading.friction_at(friction.of(), point.cycle_position, point.pairs))
        });
        let left = left.collect();
        let seconds = began.elapsed().as_secs_f64();
        Ok((
            Answer { summary, settings, error, seconds, cornered, doubt, left_out, lost, iso6336 },
            Found { points, contacts, left },
        ))
    }
}
