//! What a study does not need is not computed: counted in the manifest, told by `plan` and on the page.

use std::fs;

use serde_json::Value;

use crate::desk::Desk;

const STUDY: &str = "
study: scene
title: What each part of a scene takes
stages:
  pair:
    kind: geometry
    module: 3 mm
    pinion: { teeth: 24, face_width: 20 mm, bore_radius: 18 mm }
    gear: { teeth: 36, face_width: 20 mm, bore_radius: 28 mm }
  alike:
    kind: geometry
    module: 3 mm
    pinion: { teeth: 24, face_width: 20 mm, bore_radius: 18 mm }
    gear: { teeth: 24, face_width: 20 mm, bore_radius: 18 mm }
  beam: { kind: stiffness, pair: pair, method: energy, contact: load_dependent, torque: 100 N m }
  beam_alike: { kind: stiffness, pair: alike, method: energy }
  mesh: { kind: stiffness, pair: pair, method: { finite_element: { elements_across: 6 } }, torque: 50 N m }
  mesh_alike: { kind: stiffness, pair: alike, method: { finite_element: { elements_across: 6 } }, torque: 50 N m }
  parallel: { kind: modification, pair: pair, designs: { short: [tip_relief: { gear: both, amount: 12 um, length: 1 mm }] } }
  crowned: { kind: modification, pair: pair, designs: { crowned: [lead_crowning: { gear: pinion, amount: 9 um }] } }
  askew:
    kind: modification
    pair: pair
    designs: { askew: [lead_crowning: { gear: pinion, amount: 9 um }, helix_slope: { gear: pinion, amount: 2 um }] }
  plain: { kind: ste, stiffness: beam, designs: [parallel], torque: 100 N m, slices: 9 }
  half: { kind: ste, stiffness: beam, designs: [crowned], torque: 100 N m, slices: 9 }
  whole: { kind: ste, stiffness: beam, designs: [askew], torque: 100 N m, slices: 9 }
";

/// Counts of a stage; 0 where the manifest names none.
fn count(manifest: &Value, stage: &str, counter: &str) -> u64 {
    let stages = manifest["stages"].as_array().unwrap();
    let found = stages.iter().find(|record| record["name"] == stage).unwrap();
    assert!(found["work"].is_object(), "{stage} counts nothing");
    found["work"].get(counter).map_or(0, |count| count.as_u64().unwrap())
}

#[test]
fn nothing_is_computed_that_the_scene_does_not_need() {
    let desk = Desk::with("quick.yaml");
    fs::write(desk.path("scene.yaml"), STUDY).unwrap();
    desk.run(&["run", "scene.yaml", "--jobs", "1"], 0);
    let manifest = desk.manifest("scene");
    let of = |stage: &str, counter: &str| count(&manifest, stage, counter);

    assert_eq!(of("plain", "slices"), 1, "nothing varies across the face");
    // Of two times 9 less 1 slices, which the estimate of the error compares with.
    assert_eq!([of("half", "slices"), of("whole", "slices")], [17, 34], "half of a face that is even");
    assert_eq!(of("beam", "mesh_factorisations"), 0);
    assert_eq!([of("mesh", "mesh_factorisations"), of("mesh_alike", "mesh_factorisations")], [4, 2]);
    assert_eq!(of("beam", "compliance_evaluations"), 2 * of("beam_alike", "compliance_evaluations"));
    for stage in ["plain", "half", "whole"] {
        assert!(of(stage, "contact_solves") > 64);
        assert_eq!(of(stage, "contact_pressures"), 0, "nobody asked for pressures");
        assert_eq!(of(stage, "compliance_evaluations"), 0, "compliances come from their stage");
    }
    let solves = of("plain", "contact_solves");

    // The counts belong to the cached tables, and threads do not change them.
    let works = |manifest: &Value| -> Vec<Value> {
        manifest["stages"].as_array().unwrap().iter().map(|stage| stage["work"].clone()).collect()
    };
    let before = works(&manifest);
    desk.run(&["run", "scene.yaml", "--force", "--jobs", "3"], 0);
    assert_eq!(works(&desk.manifest("scene")), before);

    desk.run(&["run", "scene.yaml", "--want", "plain.summary.largest_pressure"], 0);
    let manifest = desk.manifest("scene");
    assert!(count(&manifest, "plain", "contact_pressures") > 64);
    assert_eq!(count(&manifest, "half", "contact_pressures"), 0);
    assert!(count(&manifest, "plain", "contact_solves") >= solves);
}

#[test]
fn what_was_left_out_is_told_with_the_time_it_saved() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "quick.yaml"], 0);
    let (plan, _) = desk.run(&["plan", "quick.yaml"], 0);
    let line = |what: &str| {
        let mut lines = plan.lines().filter(|line| line.contains(what));
        lines.next().unwrap_or_else(|| panic!("{what} is not in\n{plan}"))
    };
    for what in ["finite-element mesh", "corner contact", "summary.largest_pressure", "table `samples`"] {
        assert!(line(what).contains("left out: ") && line(what).contains("; saves about "), "{}", line(what));
    }
    let (json, _) = desk.run(&["plan", "quick.yaml", "--json"], 0);
    let json: Value = serde_json::from_str(&json).unwrap();
    let saved = json[0]["stages"].as_array().unwrap().iter().flat_map(|stage| stage["left_out"].as_array().unwrap());
    assert!(saved.filter_map(|omission| omission["saved_seconds"].as_f64()).all(|seconds| seconds > 0.0));
    let page = fs::read_to_string(desk.path("results/quick/report.html")).unwrap();
    assert!(page.contains("saved about ") && page.contains("contact solves"));
}
