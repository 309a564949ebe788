//! Closed forms, invariants and traps of the transmission error.

mod closed_forms;
mod invariants;
mod sampling;
mod traps;

use super::curve::Wanted;
use super::cycle::{MeshCycle, Settings};
use super::loading::Loading;
use super::stiffness::stiffness;
use crate::base::record::Value::{Choice, Number, Quantity};
use crate::gear::compliance::{ContactLaw, PairCompliance};
use crate::gear::fixtures::{self, BASE_PITCH, constant, coupled, design, pair, pair_with_contact_ratio, varying};
use crate::gear::geometry::Pair;
use crate::gear::modification::Design;

const STIFFNESS: f64 = 2.8e8;

fn cycle(pair: &Pair, compliance: &PairCompliance) -> MeshCycle {
    MeshCycle::new(pair, compliance, Settings::default()).unwrap()
}

fn torque(force: f64) -> f64 {
    force * pair().pinion.base_radius
}

fn relief(pair: &Pair, amount: f64, fraction: f64) -> Design {
    design(pair, &[("tip_relief", "both", &[("amount", Quantity(amount)), ("fraction", Number(fraction))])]).unwrap()
}

fn crowned(pair: &Pair, amount: f64) -> Design {
    design(pair, &[("lead_crowning", "pinion", &[("amount", Quantity(amount))])]).unwrap()
}

fn ga_design(pair: &Pair, amount: f64, length: f64, crown: f64) -> Design {
    let tip = [("amount", Quantity(amount)), ("length", Quantity(length)), ("curve", Choice("parabolic"))];
    design(pair, &[("tip_relief", "both", &tip), ("lead_crowning", "pinion", &[("amount", Quantity(crown))])]).unwrap()
}

#[track_caller]
fn close(value: f64, exact: f64, relative: f64) {
    assert!((value - exact).abs() <= relative * exact.abs(), "{value:e} is not {exact:e}");
}
