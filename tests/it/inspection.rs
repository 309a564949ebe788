//! What is measured of gears, beside flanks that another program draws.

use gearmesh::gear::geometry::inspection::{Balls, Span};
use gearmesh::gear::geometry::{Gear, Specification};
use serde_json::{Value, json};

use crate::estimates::random::Random;

/// A gear whose teeth may be thinner, with a span and a ball near the usual ones.
fn measured(random: &mut Random, specification: &Specification) -> Option<(Gear, Span, Balls)> {
    let thickness_allowance = random.of(&[0.0, -1.0]) * random.between(0.0, 0.05) * specification.module;
    let gear = Gear::new(&Specification { thickness_allowance, ..*specification }).ok()?;
    let span = gear.span((gear.usual_span_teeth() + random.of(&[0_u32, 1, 2])).saturating_sub(1));
    let balls = gear.balls(gear.usual_ball_diameter() * random.between(0.9, 1.1))?;
    (span.on_flank && balls.measurable).then_some((gear, span, balls))
}

/// Gears of random pairs of which both measurements can be taken.
fn gears(count: usize) -> Vec<(Gear, Span, Balls)> {
    let mut random = Random::new(21771);
    let mut found = Vec::new();
    while found.len() < count {
        let pair = random.pair();
        for gear in [&pair.pinion, &pair.gear] {
            found.extend(measured(&mut random, &gear.specification));
        }
    }
    found.truncate(count);
    found
}

/// Tier: somebody else's flanks; W_k and M_dK of 200 random gears, by planes and balls laid against the involutes of `py_gearworks`.
#[test]
fn another_program_s_flanks_measure_the_same() {
    let gears = gears(200);
    let asked = |(gear, span, balls): &(Gear, Span, Balls)| {
        let own = &gear.specification;
        json!({
            "teeth": own.teeth,
            "profile_shift": own.profile_shift,
            "pressure_angle": own.pressure_angle,
            // There the flanks are nearer by this, along their normal.
            "backlash": -own.thickness_allowance * own.pressure_angle.cos() / own.module,
            "span_teeth": span.teeth,
            "ball_diameter": balls.diameter / own.module,
        })
    };
    let given = Value::from(gears.iter().map(asked).collect::<Vec<_>>());
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("gears.json");
    std::fs::write(&file, given.to_string()).unwrap();
    let Some(said) = crate::python::run("gearworks_flanks.py", &[file.as_os_str()]) else { return };
    if said.trim().is_empty() {
        eprintln!("SKIPPED: tests/python/gearworks_flanks.py: there is no py_gearworks");
        return;
    }
    let answers: Vec<Value> = serde_json::from_str(&said).unwrap();
    assert_eq!(answers.len(), gears.len());
    for ((gear, span, balls), theirs) in gears.iter().zip(&answers) {
        let own = &gear.specification;
        for (name, ours) in [("span", span.length), ("over_two", balls.over_two)] {
            let off = (theirs[name].as_f64().unwrap() * own.module / ours - 1.0).abs();
            assert!(off < 1e-14, "{name} of z {}: {off:e}", own.teeth);
        }
    }
}
