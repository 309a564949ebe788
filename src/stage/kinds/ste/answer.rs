//! What one design comes to under one torque.
//!
//! Must not know: tables, other designs.

use std::time::Instant;

use super::friction::Lost;
use super::tables::Found;
use super::{Named, Ste, pressures};
use crate::stage::neglected_corners::Estimated;
use declare::error::Failure;
use gearmesh::gear::transmission_error::curve::{Summary, Wanted};
use gearmesh::gear::transmission_error::cycle::{MeshCycle, Settings};
use gearmesh::gear::transmission_error::doubt::Doubt;
use gearmesh::gear::transmission_error::load_case::LoadCase;
use gearmesh::gear::transmission_error::pressure::Cornered;
use gearmesh::gear::transmission_error::sampling::{Against, Sampled};

/// One design under one torque; its points are in the table `curve`.
pub struct Answer {
    pub summary: Summary,
    pub settings: Settings,
    pub error: f64,
    pub seconds: f64,
    /// Where sharp corners are in contact, if pressures were asked for.
    pub cornered: Option<Cornered>,
    /// As [`LoadCase::contact_doubt`] has it.
    pub doubt: Option<Doubt>,
    /// Tip corners that `corner_contact: none` leaves out, where a warning is heard.
    pub left_out: Option<Estimated>,
    /// What friction takes, if that was asked for.
    pub lost: Option<Lost>,
    /// Nominal root stress by ISO 6336-3 \[Pa\], where it was asked for and holds.
    pub iso6336: [f64; 2],
}

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

/// What was loaded last.
pub type Before<'a> = Option<(&'a Named, LoadCase<'a>)>;

impl Ste {
    /// `before` is left as this load case.
    ///
    /// # Errors
    /// When the gears approach by more than is modelled.
    pub fn answer<'a>(
        &'a self,
        base: &'a MeshCycle,
        named: &'a Named,
        torque: f64,
        before: &mut Before<'a>,
        wanted: &WantedHere,
        iso6336: [f64; 2],
    ) -> Result<(Answer, Found), Failure> {
        let began = Instant::now();
        let (design, name, _) = named;
        // Gaps do not ask for the torque.
        let loading = match before.take() {
            Some((other, loading)) if std::ptr::eq(other, named) => loading.with_torque(torque),
            _ => self.loading(base, design, torque),
        };
        *before = Some((named, loading.clone()));
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
        let doubt = loading.contact_doubt();
        let left_out = if wanted.corners { Estimated::of(&loading, &points, &summary) } else { None };
        let cornered = loading.cornered(&points);
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
