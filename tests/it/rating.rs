//! Rating beside another program's, over random gears; and as a stage beside finite elements.

use std::fmt::Write as _;

use gearmesh::gear::geometry::{GearPair, Side};
use gearmesh::gear::rating::root::{Section, critical_section, nominal_root_stress};
use serde_json::{Value, json};

use crate::estimates::random::Random;
use crate::registry::walk::{load, walk};

/// Pairs of which both gears have a critical section, with it.
fn pairs(count: usize) -> Vec<(GearPair, [Section; 2])> {
    let mut random = Random::new(6336);
    let sections = |pair: &GearPair| {
        let of = |side| critical_section(pair, side).ok();
        Some([of(Side::Pinion)?, of(Side::Gear)?])
    };
    std::iter::repeat_with(|| random.pair())
        .filter_map(|pair| sections(&pair).map(|found| (pair, found)))
        .take(count)
        .collect()
}

/// Tier: somebody else's implementation; Y_F, Y_S and σ_F0 of 200 random gears by python-gearbox. It iterates for θ nine times.
#[test]
fn another_program_finds_the_same_root_stresses() {
    let pairs = pairs(100);
    let torque = 100.0;
    let asked = |(pair, _): &(GearPair, _)| {
        let both = [&pair.pinion.specification, &pair.gear.specification];
        let own = both[0];
        json!({
            "teeth": both.map(|gear| gear.teeth),
            "profile_shift": both.map(|gear| gear.profile_shift),
            "pressure_angle": own.pressure_angle.to_degrees(),
            "addendum": own.rack.addendum,
            "dedendum": own.rack.dedendum,
            "tip_radius": own.rack.tip_radius,
            "contact_ratio": pair.contact_ratio,
            // A module of 1 mm there: both lengths of F_t/(b m) in modules, in N/mm².
            "load": torque / pair.pinion.reference_radius / (1e3 * own.module).powi(2),
            "width": pair.contact_width() / own.module,
        })
    };
    let given = Value::from(pairs.iter().map(asked).collect::<Vec<_>>());
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("pairs.json");
    std::fs::write(&file, given.to_string()).unwrap();
    let Some(said) = crate::python::run("gearbox_root.py", &[file.as_os_str()]) else { return };
    if said.trim().is_empty() {
        eprintln!("SKIPPED: tests/python/gearbox_root.py: there is no python-gearbox");
        return;
    }
    let answers: Vec<Value> = serde_json::from_str(&said).unwrap();
    assert_eq!(answers.len(), 100);
    for ((pair, sections), theirs) in pairs.iter().zip(&answers) {
        for (at, side) in [Side::Pinion, Side::Gear].into_iter().enumerate() {
            let ours = [
                sections[at].form_factor,
                sections[at].stress_correction_factor,
                1e-6 * nominal_root_stress(pair, side, torque).unwrap(),
            ];
            for (place, name) in ["form", "notch", "stress"].into_iter().enumerate() {
                let off = (theirs[name][at].as_f64().unwrap() / ours[place] - 1.0).abs();
                assert!(off < 3e-5, "{name} of z {}: {off:e}", pair.side(side).specification.teeth);
            }
        }
    }
}

fn steel(extra: &str) -> String {
    let mut text = "study: t\nstages:\n".to_owned();
    write!(
        text,
        "
  geometry:
    kind: geometry
    module: 3 mm
    pinion: {{ teeth: 19, face_width: 20 mm, bore_radius: 14 mm }}
    gear: {{ teeth: 48, face_width: 20 mm, bore_radius: 38 mm }}
  designs: {{ kind: modification, pair: geometry, designs: {{ plain: [], other: [{{ lead_crowning: {{ gear: pinion, amount: 5 um }} }}] }} }}
  stiffness: {{ kind: stiffness, pair: geometry, method: finite_element, torque: 100 N m }}
  ste: {{ kind: ste, stiffness: stiffness, designs: [designs], torque: [50 N m, 100 N m] }}
  rating:
    kind: rating
    pair: geometry
    torque: [50 N m, 100 N m]
    speed: 1000 rpm
    factors:
      dynamic_factor: 1.0
      face_load_factor_contact: 1.0
      transverse_load_factor_contact: 1.0
      transverse_load_factor_root: 1.0
    pinion: {{ material: case_hardened_steel }}
    gear: {{ material: case_hardened_steel }}
{extra}
"
    )
    .unwrap();
    text
}

/// Tier: invariant; what stands beside the standard's stresses is what the stage of transmission errors has: the largest of its designs, or
/// the one that is named. σ_F0 is that of its column after ISO 6336, and finite elements are within 10 % of it.
#[test]
fn finite_elements_stand_beside_the_standard() {
    for (extra, designs) in [("    ste: ste", &["plain", "other"][..]), ("    ste: ste\n    design: plain", &["plain"])]
    {
        let ran = walk(&load(&steel(extra)));
        let table = |stage: &str, name: &str| ran[stage].tables.iter().find(|table| table.name() == name).unwrap();
        let (ste, pair, gears) = (table("ste", "summary"), table("rating", "summary"), table("rating", "gears"));
        let largest = |column: &str, torque: f64| {
            (0..ste.rows())
                .filter(|row| ste.floats("torque")[*row].to_bits() == torque.to_bits())
                .filter(|row| designs.contains(&ste.texts("design")[*row].as_str()))
                .map(|row| ste.floats(column)[row])
                .fold(0.0, f64::max)
        };
        for row in 0..pair.rows() {
            let torque = pair.floats("torque")[row];
            let found = pair.floats("largest_pressure")[row];
            assert_eq!(found.to_bits(), largest("largest_pressure", torque).to_bits(), "{torque}");
        }
        for row in 0..gears.rows() {
            let (torque, gear) = (gears.floats("torque")[row], &gears.texts("gear")[row]);
            let found = gears.floats("largest_root_stress")[row];
            assert_eq!(found.to_bits(), largest(&format!("largest_root_stress_{gear}"), torque).to_bits(), "{torque}");
            let nominal = gears.floats("nominal_root_stress")[row];
            let column = largest(&format!("iso6336_root_stress_{gear}"), torque);
            assert!((nominal / column - 1.0).abs() < 1e-12, "{nominal} {column}");
            if designs.len() == 1 {
                assert!((found / nominal - 1.0).abs() < 0.1, "{gear} {torque}: {found} {nominal}");
            }
        }
    }
}
