//! The kernels' numbers against those of the second evaluation, as decimal digits lost.
//!
//! Must not know: how either is computed.

use super::precise::{GEOMETRIC, NAMES, Quantities};
use super::{Built, Case, DigitsLost, Finding, MOST_LOST, Report};
use crate::gear::geometry::Side;
use crate::gear::modification::Design;
use crate::numeric::double_double::Double;

/// The place of the stiffness where one pair more than the fewest is in contact.
const MOST_PAIRS: usize = 10;
/// −log10 ε.
pub const DIGITS: f64 = 15.95;

/// Digits lost between a number and the exact one; a NaN has lost all.
#[must_use]
pub fn lost(value: f64, exact: Double) -> f64 {
    let difference = (Double::from(value) - exact).high.abs();
    if difference == 0.0 {
        return 0.0;
    }
    let relative = difference / exact.high.abs();
    if relative.is_nan() { DIGITS } else { (DIGITS + libm::log10(relative)).clamp(0.0, 2.0 * DIGITS) }
}

/// The same quantities by the kernels; `values` are mean and peak-to-peak.
fn quantities(case: &Case, built: &Built, values: [f64; 2]) -> Quantities<f64> {
    let Built { pair, compliance, cycle, .. } = built;
    let unmodified = Design::default();
    let loading = cycle.loaded(&unmodified, case.torque);
    let stiffness = |zone: usize| {
        let zone = cycle.zones[zone];
        let state = loading.state(0.5 * (zone.start + zone.end), zone.pairs);
        loading.force() / state.balance.approach
    };
    let pinion = pair.side(Side::Pinion);
    [
        pinion.form_radius,
        pinion.form_roll,
        pinion.tip_roll(),
        pinion.tip_thickness(),
        pair.centre_distance,
        pair.start_of_contact,
        pair.contact_ratio,
        compliance.pinion.total(pinion.form_roll),
        compliance.pinion.total(pinion.tip_roll()),
        stiffness(cycle.zones.len() - 1),
        stiffness(0),
        values[0],
        values[1],
    ]
}

pub(super) fn check(
    case: &Case,
    built: &Built,
    values: [f64; 2],
    (exact, conditions): (&Quantities<Double>, &Quantities<f64>),
    report: &mut Report,
) {
    let found = quantities(case, built, values);
    let reason = case.not_covered();
    let count = if reason.is_some() { GEOMETRIC } else { NAMES.len() };
    if let Some(reason) = reason {
        report.findings.push(Finding::refused("second evaluation of the loaded pair", reason));
    }
    for index in 0..count {
        if index == MOST_PAIRS && built.cycle.zones.len() == 1 {
            report
                .findings
                .push(Finding::refused(NAMES[index], "the contact ratio is a whole number: there is one zone"));
            continue;
        }
        let (value, exact, condition) = (found[index], exact[index], conditions[index]);
        let lost = lost(value, exact);
        let limit = MOST_LOST + libm::log10(condition.max(1.0));
        report.findings.push(Finding::new(NAMES[index], lost, limit));
        report.digits.push(DigitsLost { quantity: NAMES[index], value, exact: exact.high, lost, condition });
    }
}
