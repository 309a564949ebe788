//! Exports as a user makes them: files beside the tables, listed, archived, gone when no longer wanted; and what another
//! program reads in them.

use std::ffi::OsStr;
use std::fs;

use crate::archive::entries;
use crate::desk::Desk;
use crate::python;
use studygraph::store::manifest::Manifest;

fn study(outline: &str, export: &str) -> String {
    format!(
        "study: cut
stages:
  pair:
    kind: geometry
    module: 1.5 mm
    pinion: {{ teeth: 23, face_width: 10 mm, bore_radius: 5 mm }}
    gear: {{ teeth: 31, face_width: 10 mm, bore_radius: 6 mm }}
    outline: {outline}
  drawing: {{ kind: export, pair: pair{export} }}
"
    )
}

fn desk(outline: &str, export: &str) -> Desk {
    let desk = Desk::with("quick.yaml");
    fs::write(desk.path("cut.yaml"), study(outline, export)).unwrap();
    desk
}

fn run(desk: &Desk) -> Manifest {
    desk.run(&["run", "cut.yaml", "--quiet"], 0);
    serde_json::from_slice(&fs::read(desk.path("results/cut/manifest.json")).unwrap()).unwrap()
}

fn exported(manifest: &Manifest) -> Vec<&str> {
    let files = manifest.files.iter().map(|record| record.file.as_str());
    files.filter(|file| file.starts_with("drawing.") && !file.ends_with(".parquet")).collect()
}

#[test]
fn files_are_listed_archived_and_gone_when_no_longer_wanted() {
    let desk = desk("{ teeth: all, points: 40 }", "");
    let first = run(&desk);
    let all = ["drawing.pinion.dxf", "drawing.pinion.svg", "drawing.pinion.csv"].into_iter().chain([
        "drawing.gear.dxf",
        "drawing.gear.svg",
        "drawing.gear.csv",
    ]);
    assert_eq!(exported(&first), all.collect::<Vec<_>>());
    let read = |name: &str| fs::read(desk.path(&format!("results/cut/{name}"))).unwrap();
    let before = read("drawing.gear.dxf");
    fs::remove_file(desk.path("results/cut/drawing.gear.dxf")).unwrap();
    run(&desk);
    assert!(before == read("drawing.gear.dxf"), "the same contour, other bytes");

    desk.run(&["archive", "cut.yaml", "-o", "a.zip"], 0);
    let archived = entries(&desk.path("a.zip"));
    assert!(archived["results/cut/drawing.gear.dxf"] == before);
    let described = String::from_utf8(archived["ro-crate-metadata.json"].clone()).unwrap();
    assert!(described.contains("image/vnd.dxf") && described.contains("text/csv"));
    desk.run(&["verify", "a.zip"], 0);

    // One digit of a drawing, at the same size: neither is it packed nor is it the same.
    let mut changed = before.clone();
    let last = changed.iter().rposition(|byte| *byte == b'7').unwrap();
    changed[last] = b'8';
    fs::write(desk.path("results/cut/drawing.gear.dxf"), &changed).unwrap();
    let (_, refused) = desk.run(&["archive", "cut.yaml", "-o", "b.zip"], 1);
    assert!(refused.contains("`drawing.gear.dxf` is not as the manifest lists it"), "{refused}");
    let (told, _) = desk.run(&["diff", "results", "results"], 4);
    assert!(told.contains("drawing.gear.dxf is not what the table `drawing.files` holds"), "{told}");
    fs::write(desk.path("results/cut/drawing.gear.dxf"), &before).unwrap();

    fs::write(desk.path("cut.yaml"), study("{ teeth: all, points: 40 }", ", gear: pinion, formats: svg")).unwrap();
    assert_eq!(exported(&run(&desk)), ["drawing.pinion.svg"]);
    for gone in ["drawing.gear.svg", "drawing.pinion.dxf", "drawing.gear.dxf"] {
        assert!(!desk.path(&format!("results/cut/{gone}")).exists(), "{gone}");
    }
}

/// Tier: second program and closed form; see the script. An arc for a root has no chords but those of the flanks.
#[test]
fn another_program_reads_the_drawing() {
    for (root, counts) in [
        ("tangent_arc", [("ARC", 5 * 23), ("LWPOLYLINE", 2 * 23), ("CIRCLE", 1)]),
        ("arc", [("ARC", 3 * 23), ("LWPOLYLINE", 2 * 23), ("CIRCLE", 1)]),
        ("trochoid", [("ARC", 3 * 23), ("LWPOLYLINE", 4 * 23), ("CIRCLE", 1)]),
    ] {
        let desk = desk(&format!("{{ root: {root}, teeth: all, points: 200, chord_error: 0.5 um }}"), "");
        run(&desk);
        let cells = |table: &str, columns: &str| -> Vec<f64> {
            let words = ["table", "cut.yaml", table, "--where", "gear=pinion", "--columns", columns, "--format", "csv"];
            let (output, _) = desk.run(&words, 0);
            output.lines().last().unwrap().split(',').map(|cell| cell.parse().unwrap()).collect()
        };
        let stated = cells("drawing.contours", "chord_error,area");
        // 0.5 µm was asked for; what is stated is an upper bound, up to twice that.
        assert!(stated[0] > 0.0 && stated[0] < 1.01, "{root}: {} um", stated[0]);
        let base = cells("pair.gears", "base_radius")[0];
        let half = 0.5 * std::f64::consts::PI / 23.0 + 20_f64.to_radians().tan() - 20_f64.to_radians();
        let facts = serde_json::json!({
            "base_radius": base, "half_base_angle": half, "teeth": 23, "chord_error": 0.5e-3 * (1.0 + 1e-6), "gap": 1e-9,
            "area": stated[1], "counts": counts.into_iter().collect::<std::collections::BTreeMap<_, _>>(),
        })
        .to_string();
        let path = desk.path("results/cut/drawing.pinion.dxf");
        if let Some(said) = python::run("dxf.py", &[path.as_os_str(), OsStr::new(&facts)]) {
            println!("{root}: {said}");
        }
    }
}
