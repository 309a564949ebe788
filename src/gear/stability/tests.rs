//! The second evaluation against itself, published values and the kernels; every check must be able to fail.

use std::f64::consts::PI;

use super::precise::{NAMES, Rule, evaluate};
use super::*;
use crate::base::record::Value;
use crate::gear::geometry::Rack;
use crate::gear::geometry::root::RootShape;
use crate::gear::material::Material;

const STEEL: Material = Material { youngs_modulus: 206e9, poisson_ratio: 0.3 };

pub fn model() -> Model {
    let entry = |value| Entry { value, place: Place::default() };
    Model {
        method: super::super::compliance::method("energy").unwrap(),
        options: Record {
            fields: vec![("shear_factor", entry(Value::Number(1.2))), ("body", entry(Value::Choice("sainsot")))],
            place: Place::default(),
        },
        assumptions: Assumptions {
            root: RootShape::Trochoid,
            contact: ContactLaw::Linear,
            coupled: false,
            torque: None,
            accuracy: None,
        },
        settings: Settings::default(),
    }
}

fn gear(teeth: u32, face_width: f64) -> Specification {
    let module = 3e-3;
    let root = 0.5 * module * f64::from(teeth) - 1.25 * module;
    Specification {
        teeth,
        module,
        pressure_angle: 20.0 * PI / 180.0,
        profile_shift: 0.0,
        rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.25 / (1.0 - libm::sin(20.0 * PI / 180.0)) },
        tip_radius: None,
        face_width,
        bore_radius: root / 1.75,
        material: STEEL,
    }
}

/// The pair 19/48 of the golden values.
pub fn base() -> Case {
    Case {
        name: "base".to_owned(),
        axis: "trap",
        place: 0.0,
        gears: [gear(19, 20e-3), gear(48, 18e-3)],
        torque: 50.0,
        relief: 0.0,
        relief_length: 0.0,
        crowning: 0.0,
        model: model(),
    }
}

/// Tier: second method and self-convergence. More points change nothing at the twentieth digit.
#[test]
fn the_second_evaluation_has_converged() {
    for (relief, crowning, torque, load_dependent) in
        [(0.0, 0.0, 50.0, false), (9e-6, 0.0, 50.0, false), (9e-6, 20e-6, 20.0, false), (9e-6, 0.0, 10.0, true)]
    {
        let mut case = base();
        (case.relief, case.relief_length, case.crowning, case.torque) = (relief, 4e-3, crowning, torque);
        let mut inputs = case.inputs();
        inputs.load_dependent = load_dependent;
        let (coarse, fine) = (evaluate(&inputs, &Rule::new(20, 24)), evaluate(&inputs, &Rule::new(32, 34)));
        for ((name, coarse), fine) in NAMES.iter().zip(coarse).zip(fine) {
            let difference = ((coarse - fine) / fine).high.abs();
            eprintln!("{name}: {:e} {difference:e}", fine.high);
            assert!(difference < 1e-19, "{name}: {difference:e}");
        }
    }
}

/// Tier: published values (physics of the pair 19/48, 40 digits by another program).
#[test]
fn the_second_evaluation_meets_published_values() {
    let values = evaluate(&base().inputs(), &Rule::new(20, 24));
    let peak_to_peak = values[12].high;
    assert!((peak_to_peak / 3.000_883_377e-6 - 1.0).abs() < 2e-10, "{peak_to_peak:e}");
}

#[test]
fn the_base_case_holds() {
    let rules = Rules::new();
    for (relief, crowning, torque) in [(0.0, 0.0, 50.0), (9e-6, 0.0, 50.0), (9e-6, 20e-6, 20.0)] {
        let mut case = base();
        (case.relief, case.relief_length, case.crowning, case.torque) = (relief, 4e-3, crowning, torque);
        let began = std::time::Instant::now();
        let report = check(&case, &rules);
        eprintln!("{:?}", began.elapsed());
        for finding in &report.findings {
            eprintln!("{finding:?}");
        }
        for digits in &report.digits {
            eprintln!("{digits:?}");
        }
        assert!(report.findings.iter().all(|finding| finding.verdict == Verdict::Holds));
    }
}
