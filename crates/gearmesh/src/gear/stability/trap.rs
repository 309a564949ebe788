//! Named cases that naive programs get wrong: undercut, penetration, pointed tips, vanishing loads and modifications,
//! contact ratios at whole numbers.
//!
//! Must not know: what is checked, except for the continuity in the contact ratio, which takes two cases.

use std::sync::Arc;

use super::axis::Point;
use super::symmetry::values;
use super::{Case, Finding, Model, TABLE};
use crate::gear::compliance::ContactLaw;
use crate::gear::compliance::energy::{Energy, GearBody};
use crate::gear::geometry::root::RootShape;

/// Distance of the contact ratio from a whole number.
const NEAR: f64 = 1e-6;

/// The traps around a base point.
#[must_use]
pub fn traps(base: &Point, model: &Model) -> Vec<Case> {
    let mut cases = Vec::new();
    let mut add = |name: &str, model: &Model, change: &dyn Fn(&mut Point)| {
        let mut point = base.clone();
        change(&mut point);
        cases.push(point.case(name, "trap", 0.0, model));
    };
    let teeth = |pinion: f64, gear: f64| {
        move |point: &mut Point| {
            point.teeth = [pinion, gear];
            point.shift = [0.0; 2];
        }
    };
    add("z 17/48: just undercut", model, &teeth(17.0, 48.0));
    add("z 12/48: interference", model, &teeth(12.0, 48.0));
    add("z 14/100: interference", model, &teeth(14.0, 100.0));
    add("z 10/24: undercut deep", model, &teeth(10.0, 24.0));
    for (count, shift) in [(15.0, 1.0), (8.0, 0.7)] {
        add(&format!("z {count}, x {shift}: pointed tip"), model, &|point| {
            (point.teeth[0], point.shift[0]) = (count, shift);
        });
    }
    let other_root =
        Model { assumptions: super::Assumptions { root: RootShape::BaseCircle, ..model.assumptions }, ..model.clone() };
    add("z 48 without a root: base circle inside the root circle", &other_root, &|_| {});
    for ratio in [0.9, 1.0 + 1e-12, 1.0001, 1.9999, 2.0, 2.0001, 2.3, 2.7] {
        add(&format!("contact ratio {ratio}"), model, &move |point| {
            point.teeth = [60.0, 100.0];
            point.shift = [0.0; 2];
            point.contact_ratio = Some(ratio);
        });
    }
    ends(model, &mut add);
    for torque in [1e-12, 1e6] {
        add(&format!("torque {torque:e} N m"), model, &move |point| point.torque = torque);
    }
    for crowning in [0.0, 1e-306, 1e-15, 20e-6] {
        add(&format!("crowning {:e} um", crowning * 1e6), model, &move |point| point.crowning = crowning);
    }
    add("relief of 8 um over no length", model, &|point| (point.relief, point.relief_length) = (8e-6, 0.0));
    add("relief above the deflection: contact is lost", model, &|point| {
        (point.relief, point.relief_length, point.torque) = (200e-6, point.module, 10.0);
    });
    let weber = Model {
        assumptions: super::Assumptions { contact: ContactLaw::LoadDependent, ..model.assumptions },
        ..model.clone()
    };
    for torque in [1e-12, 1e-6, 1.0, 1e9] {
        add(&format!("load-dependent law at {torque:e} N m"), &weber, &move |point| point.torque = torque);
    }
    for count in [300.0, 500.0, 1000.0] {
        add(&format!("z {count}: gear body formula"), model, &move |point| point.teeth[1] = count);
    }
    for bore in [0.84, 0.999, 1.0 - 1e-9] {
        add(&format!("bore at {bore} of the root"), model, &move |point| point.bore = [bore; 2]);
    }
    if let Some(ring) = with_ring(model) {
        for (count, bore) in [(1000.0, 0.5), (48.0, 0.999)] {
            add(&format!("z {count}, bore at {bore} of the root: elastic ring"), &ring, &move |point| {
                point.teeth[1] = count;
                point.bore = [bore; 2];
            });
        }
    }
    cases
}

/// Ends of the axes at which the pair in the middle of a grid is impossible, on pairs that are possible: the rack, the teeth
/// or the gear body are chosen for the end.
fn ends(model: &Model, add: &mut impl FnMut(&str, &Model, &dyn Fn(&mut Point))) {
    // The teeth of a rack at 20 deg end in a point before they are deep enough.
    add("contact ratio 3 at 14 deg", model, &|point| {
        (point.teeth, point.shift) = ([60.0, 100.0], [0.0; 2]);
        (point.pressure_angle, point.contact_ratio) = (14.0_f64.to_radians(), Some(3.0));
    });
    for (degrees, height) in [(10.0_f64, 1.0), (35.0, 0.9)] {
        add(&format!("pressure angle {degrees} deg"), model, &move |point| {
            (point.teeth, point.shift, point.pressure_angle) = ([100.0, 150.0], [0.0; 2], degrees.to_radians());
            (point.rack.addendum, point.rack.dedendum) = (height, height + 0.2);
        });
    }
    for shift in [-1.0, 1.5] {
        add(&format!("x {shift} on both gears"), model, &move |point| {
            (point.teeth, point.shift, point.pressure_angle) = ([100.0, 150.0], [shift; 2], 25.0_f64.to_radians());
            point.rack.addendum = 0.8;
        });
    }
    add("z 5/20 with stub teeth at 25 deg", model, &|point| {
        (point.teeth, point.shift, point.pressure_angle) = ([5.0, 20.0], [0.4, 0.0], 25.0_f64.to_radians());
        (point.rack.addendum, point.rack.dedendum) = (0.9, 1.05);
    });
    if let Some(ring) = with_ring(model) {
        add("z 2000/2000: elastic ring", &ring, &|point| (point.teeth, point.shift) = ([2000.0; 2], [0.0; 2]));
        for bore in [1e-3, 1.0 - 1e-9] {
            add(&format!("bore at {bore} of the root: elastic ring"), &ring, &move |point| point.bore = [bore; 2]);
        }
    }
}

/// The same model on the elastic ring, where its method has the choice.
fn with_ring(model: &Model) -> Option<Model> {
    let energy = Energy { body: GearBody::Ring, ..model.energy()?.clone() };
    Some(Model { method: Arc::new(energy), ..model.clone() })
}

/// A check of the mean transmission error just below and above a whole contact ratio.
pub struct Continuity {
    /// The contact ratio it is checked at, in words.
    pub name: String,
    /// The relative change of the mean, against what so small a change of the contact ratio allows.
    pub finding: Finding,
}

/// The mean is continuous where the contact ratio is a whole number, although the peak-to-peak is not: a zone shorter by a
/// share h of the base pitch changes the mean by at most h times the peak-to-peak.
#[must_use]
pub fn continuity(base: &Point, model: &Model, whole: f64) -> Continuity {
    let mut point = base.clone();
    point.teeth = [60.0, 100.0];
    point.shift = [0.0; 2];
    (point.relief, point.crowning) = (0.0, 0.0);
    // One rack, whose root does not change with the addendum.
    let highest = point.rack_for(Some(whole + 2.0 * NEAR));
    point.rack.dedendum = highest.dedendum;
    point.rack.tip_radius = highest.tip_radius;
    let of = |ratio: f64| {
        let mut here = point.clone();
        here.contact_ratio = Some(ratio);
        let mut case = here.case("", "trap", 0.0, model);
        for gear in &mut case.gears {
            gear.rack.dedendum = highest.dedendum;
        }
        values(&case)
    };
    // No contact ratio below 1 is allowed.
    let ratios = if whole > 1.0 { [whole - NEAR, whole + NEAR] } else { [whole + NEAR, whole + 2.0 * NEAR] };
    let invariant = "continuous in the contact ratio";
    let finding = match (of(ratios[0]), of(ratios[1])) {
        (Ok(below), Ok(above)) => {
            let change = (above[0] / below[0] - 1.0).abs();
            let limit = (ratios[1] - ratios[0]) * below[1].max(above[1]) / below[0] + 10.0 * TABLE;
            Finding::new(invariant, change, limit)
        }
        (Err(reason), _) | (_, Err(reason)) => Finding::refused(invariant, reason),
    };
    Continuity { name: format!("contact ratio from both sides of {whole}"), finding }
}
