//! The tables of finite elements on a processor without FMA and AVX, emulated: what the mask of the C library does not
//! reach. `qemu-x86_64` on the path, from the Debian package qemu-user; where there is none the check is skipped, loudly.

use std::env;
use std::fs;
use std::io::Write;
use std::path::PathBuf;

use assert_cmd::Command;
use serde_json::Value;

use crate::desk::Desk;

const STUDY: &str = "
study: quick
title: Finite elements
seed: 1
stages:
  pair:
    kind: geometry
    module: 3 mm
    pressure_angle: 20 deg
    rack: { addendum: 1.0, dedendum: 1.25, tip_radius: 0.38 }
    material: { youngs_modulus: 206 GPa, poisson_ratio: 0.3 }
    pinion: { teeth: 19, face_width: 20 mm, bore_radius: 14.079 mm }
    gear: { teeth: 48, face_width: 18 mm, bore_radius: 38.823 mm }
  stiffness: { kind: stiffness, pair: pair, method: { finite_element: { elements_across: 6 } }, torque: 50 N m }
  designs: { kind: modification, pair: pair, designs: { unmodified: [] } }
  ste: { kind: ste, stiffness: stiffness, designs: designs, torque: 200 N m }
";

fn emulator() -> Option<PathBuf> {
    let names = ["qemu-x86_64", "qemu-x86_64-static"];
    let folders: Vec<PathBuf> = env::split_paths(&env::var_os("PATH")?).collect();
    names.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name))).find(|program| program.is_file())
}

/// Every value moves by less than its column's tolerance, and some do move: it is another processor.
#[test]
fn finite_elements_on_a_lesser_processor_are_within_tolerance() {
    let Some(emulator) = emulator() else {
        let missing = b"\nSKIPPED: no qemu-x86_64: finite elements were not run on another processor\n";
        std::io::stderr().write_all(missing).unwrap();
        return;
    };
    let desk = Desk::with("quick.yaml");
    fs::write(desk.path("quick.yaml"), STUDY).unwrap();
    let words = ["run", "quick.yaml", "--quiet", "--jobs", "1"];
    desk.run(&words, 0);
    let mut emulated = Command::new(emulator);
    emulated.args(["-cpu", "Nehalem", env!("CARGO_BIN_EXE_gearstudy")]).args(words);
    emulated.args(["--results", "emulated", "--cache", "emulated_cache"]).current_dir(desk.path(""));
    emulated.assert().success();
    // The cache has the other tables too; what is compared are the two folders.
    let words = ["diff", "results", "emulated", "--cache", "none", "--format", "json"];
    let diff: Value = serde_json::from_str(&desk.run(&words, 0).0).unwrap();
    let stages = diff["studies"][0]["stages"].as_array().unwrap();
    let state = |name: &str| stages.iter().find(|stage| stage["name"] == name).unwrap()["state"].clone();
    assert_eq!((state("pair"), state("designs")), ("same".into(), "same".into()));
    if std::arch::is_x86_feature_detected!("fma") {
        assert_eq!((state("stiffness"), state("ste")), ("within_tolerance".into(), "within_tolerance".into()));
    }
}
