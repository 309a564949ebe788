//! Root stresses as a study gets them: what they take, that threads do not change them, and that tables keep them.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use gearmesh::gear::compliance::finite_element::FiniteElement;
use gearmesh::gear::compliance::{Assumptions, ContactLaw, RootStresses};
use gearmesh::gear::geometry::{GearPair, Rack, Side, Specification};
use gearmesh::gear::material::{Material, Plane};
use gearmesh::gear::mesh::answers::curve::Wanted as Asked;
use gearmesh::gear::mesh::{Mesh, Settings};
use gearmesh::gear::modification::Design;
use gearmesh::gear::rating::root::nominal_root_stress;
use gearmesh::gear::work::{MESH_FACTORISATIONS, ROOT_STRESSES};
use gearstudy::program;
use studygraph::runner::events::Silent;
use studygraph::runner::execute::execute;
use studygraph::runner::options::{Options, Wanted};
use studygraph::runner::outcome::Outcome;
use studygraph::stage::Want;
use studygraph::store::cache::Cache;
use studygraph::table::data::Table;

const COLUMNS: [&str; 10] = [
    "largest_root_stress_pinion",
    "largest_root_stress_gear",
    "root_stress_position_pinion",
    "root_stress_position_gear",
    "root_stress_radius_pinion",
    "root_stress_radius_gear",
    "iso6336_root_stress_pinion",
    "iso6336_root_stress_gear",
    "root_stress_error_pinion",
    "root_stress_error_gear",
];

/// The pair 19/48 with so many designs, under 50 and 100 N m.
fn study(designs: usize) -> String {
    let relief = |amount: usize| {
        format!("relief_{amount}: [{{ tip_relief: {{ gear: both, amount: {amount} um, fraction: 0.8 }} }}]")
    };
    let designs: Vec<String> = (1..=designs).map(relief).collect();
    format!(
        "study: roots
title: Root stress
seed: 1
stages:
  pair:
    kind: geometry
    module: 3 mm
    pressure_angle: 20 deg
    rack: {{ addendum: 1.0, dedendum: 1.25, tip_radius: 0.38 }}
    material: {{ youngs_modulus: 206 GPa, poisson_ratio: 0.3 }}
    pinion: {{ teeth: 19, face_width: 20 mm, bore_radius: 15 mm }}
    gear: {{ teeth: 48, face_width: 18 mm, bore_radius: 38 mm }}
  stiffness: {{ kind: stiffness, pair: pair, method: {{ finite_element: {{ elements_across: 6 }} }}, torque: 100 N m }}
  designs: {{ kind: modification, pair: pair, designs: {{ unmodified: [], {} }} }}
  ste: {{ kind: ste, stiffness: stiffness, designs: [designs], torque: [50 N m, 100 N m] }}
",
        designs.join(", ")
    )
}

fn run(text: &str, jobs: usize, columns: &[&str]) -> (Outcome, [Table; 2]) {
    let study = program::load_text(text, Path::new("roots.yaml")).unwrap_or_else(|error| panic!("{error}"));
    let folder = tempfile::tempdir().unwrap();
    let cache = Cache::open(folder.path()).unwrap();
    let want = |table: &str, columns: &[&str]| {
        let columns = columns.iter().map(|&column| column.to_owned()).collect();
        Wanted { stage: "ste".to_owned(), want: Want { table: table.to_owned(), columns } }
    };
    let all = columns.len() == COLUMNS.len();
    let of_curve: &[&str] = if all { &["root_stress_pinion", "root_stress_gear"] } else { &[] };
    let wanted = vec![want("summary", columns), want("curve", of_curve)];
    let outcome =
        execute(&study, &cache, &Options { jobs, wanted, ..Options::default() }, &Silent, &AtomicBool::new(false));
    let outcome = outcome.unwrap();
    assert_eq!(outcome.faults().count(), 0);
    let tables = ["summary", "curve"].map(|table| outcome.table(&cache, "ste", table).unwrap());
    (outcome, tables)
}

/// Counted: whatever number of designs there is, two gears with two meshes each are factorised, with two more each for the roots
/// where their stress is asked for, and no other.
#[test]
fn designs_and_torques_take_no_factorisation() {
    for (designs, columns) in [(1, &COLUMNS[..0]), (1, &COLUMNS[..]), (12, &COLUMNS[..])] {
        let (outcome, [summary, _]) = run(&study(designs), 0, columns);
        let work = |stage: &str| &outcome.stage(stage).unwrap().work;
        assert_eq!(work("stiffness").count(&MESH_FACTORISATIONS), if columns.is_empty() { 4 } else { 8 });
        assert_eq!(work("ste").count(&MESH_FACTORISATIONS), 0);
        assert_eq!(work("ste").count(&ROOT_STRESSES) > 0, !columns.is_empty());
        assert_eq!(summary.rows(), 2 * (designs + 1));
        let read =
            outcome.stage("stiffness").unwrap().tables.iter().any(|(schema, _)| schema.name == "root_influences");
        assert_eq!(read, !columns.is_empty(), "what nobody asks for is not there");
    }
    // The standard's stress needs no mesh at all.
    let energy = study(1).replace("{ finite_element: { elements_across: 6 } }", "energy");
    let (outcome, [summary, _]) = run(&energy, 0, &COLUMNS[6..8]);
    assert!(summary.floats(COLUMNS[6]).iter().all(|stress| *stress > 50.0));
    assert_eq!(outcome.stage("stiffness").unwrap().work.count(&MESH_FACTORISATIONS), 0);
}

#[test]
fn any_number_of_threads_gives_the_same_root_stresses() {
    let bits = |jobs: usize| {
        let (_, [summary, curve]) = run(&study(9), jobs, &COLUMNS);
        let column =
            |table: &Table, name: &str| table.floats(name).iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        let of_summary: Vec<_> = COLUMNS.iter().map(|name| column(&summary, name)).collect();
        [of_summary, vec![column(&curve, "root_stress_pinion"), column(&curve, "root_stress_gear")]].concat()
    };
    let one = bits(1);
    assert!(one.iter().flatten().collect::<std::collections::BTreeSet<_>>().len() > 1000, "they differ");
    for jobs in [2, 3, 8] {
        assert!(one == bits(jobs), "{jobs} threads");
    }
}

/// Tables, units and the way there: what the kernels give without them.
#[test]
fn the_columns_are_what_the_kernels_give() {
    let specification = |teeth: u32, width: f64, bore: f64| Specification {
        teeth,
        module: 3e-3,
        pressure_angle: 20_f64.to_radians(),
        profile_shift: 0.0,
        thickness_allowance: 0.0,
        cutter: None,
        rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.38, ..Rack::ISO_53_A },
        tip_radius: None,
        face_width: width,
        bore_radius: bore,
        material: Material::STEEL,
    };
    let pair = GearPair::new(specification(19, 20e-3, 15e-3), specification(48, 18e-3, 38e-3), None).unwrap();
    let method = FiniteElement { plane: Plane::Strain, elements_across: 6 };
    let assumptions = Assumptions { contact: ContactLaw::Resolved, ..Assumptions::default() };
    let (tabulated, roots) = method.tabulate_with_roots(&pair, assumptions).unwrap();
    let cycle = Mesh::new(&pair, &tabulated.compliance, Settings::default()).unwrap().with_roots(&roots);
    let design = Design::default();
    let asked = Asked { harmonics: 8, root_stress: true, ..Asked::default() };
    let (points, summary) = cycle.loaded(&design, 100.0).curve_and_summary(asked);

    let (_, [table, curve]) = run(&study(1), 0, &COLUMNS);
    let unmodified = |table: &Table| -> Vec<usize> {
        let designs = table.texts("design");
        (0..table.rows()).filter(|&row| designs[row] == "unmodified" && table.floats("torque")[row] > 75.0).collect()
    };
    let row = unmodified(&table)[0];
    let near = |name: &str, ours: f64| {
        let found = table.floats(name)[row];
        assert!((found / ours - 1.0).abs() < 1e-9, "{name}: {found} for {ours}");
    };
    for (at, side) in [Side::Pinion, Side::Gear].into_iter().enumerate() {
        let root = summary.largest_root_stress.unwrap()[at];
        near(COLUMNS[at], root.extremum.value * 1e-6);
        near(COLUMNS[2 + at], root.extremum.position * 1e3);
        near(COLUMNS[4 + at], root.radius * 1e3);
        near(COLUMNS[6 + at], nominal_root_stress(&pair, side, 100.0).unwrap() * 1e-6);
        let name = ["root_stress_pinion", "root_stress_gear"][at];
        let rows = unmodified(&curve);
        assert_eq!(rows.len(), points.len());
        for (row, point) in rows.into_iter().zip(&points) {
            let (found, ours) = (curve.floats(name)[row], point.root_stress.unwrap()[at] * 1e-6);
            assert!((found / ours - 1.0).abs() < 1e-9, "{name}: {found} for {ours}");
        }
    }
}
