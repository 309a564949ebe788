//! Gears: geometry, compliance tables, mesh cycle, curves of the transmission error.

use std::hint::black_box;

use criterion::{Criterion, criterion_group};

use crate::article::{Stages, TORQUE, assumptions, compliance, cycle};
use crate::brief;
use gearmesh::gear::compliance::ContactLaw::{Linear, LoadDependent};
use gearmesh::gear::contact::SliceCoupling;
use gearmesh::gear::geometry::GearPair;
use gearmesh::gear::mesh::answers::curve::Wanted;
use gearmesh::gear::mesh::{Mesh, Settings};

criterion_group!(name = benches; config = brief(); targets = tables, curves, slices, stages);

/// What no modification changes.
fn tables(criterion: &mut Criterion) {
    let pair = Stages::new().pair();
    let mut group = criterion.benchmark_group("gear");
    group.bench_function("geometry", |bencher| {
        let specifications = (pair.pinion.specification, pair.gear.specification);
        bencher.iter(|| GearPair::new(black_box(specifications.0), specifications.1, None));
    });
    for (name, coupled) in [("uncoupled", false), ("coupled", true)] {
        let assumptions = assumptions(Linear, coupled);
        group.bench_function(format!("compliance {name}"), |bencher| {
            bencher.iter(|| compliance(black_box(&pair), assumptions));
        });
        let compliance = compliance(&pair, assumptions);
        group.bench_function(format!("cycle {name}"), |bencher| {
            bencher.iter(|| Mesh::new(black_box(&pair), &compliance, Settings::default()));
        });
    }
}

/// Tip relief on both gears and crowning, 64 positions; with the summary, and the lean path of optimisers.
fn curves(criterion: &mut Criterion) {
    let mut stages = Stages::new();
    let (pair, design) = (stages.pair(), stages.design("ga"));
    let mut group = criterion.benchmark_group("ste");
    for (name, contact, coupled) in
        [("uncoupled", Linear, false), ("coupled", Linear, true), ("load-dependent", LoadDependent, false)]
    {
        let cycle = cycle(&pair, contact, coupled);
        let wanted = Wanted { harmonics: 8, pressure: false, ..Wanted::default() };
        group.bench_function(format!("curve {name}"), |bencher| {
            bencher.iter(|| black_box(&cycle).loaded(&design, TORQUE).curve(Wanted::default()));
        });
        group.bench_function(format!("curve and summary {name}"), |bencher| {
            bencher.iter(|| black_box(&cycle).loaded(&design, TORQUE).curve_and_summary(wanted));
        });
        group.bench_function(format!("peak-to-peak {name}"), |bencher| {
            bencher.iter(|| black_box(&cycle).loaded(&design, TORQUE).peak_to_peak());
        });
    }
}

/// The same crowned design with slices that hold each other.
fn slices(criterion: &mut Criterion) {
    let mut stages = Stages::new();
    let (pair, design) = (stages.pair(), stages.design("ga"));
    let mut group = criterion.benchmark_group("ste");
    for contact in [Linear, LoadDependent] {
        let compliance = compliance(&pair, assumptions(contact, true));
        for slices in [11, 41] {
            let settings = Settings { slices, slice_coupling: SliceCoupling::Plate, ..Settings::default() };
            let cycle = Mesh::new(&pair, &compliance, settings).expect("the pair has teeth");
            group.bench_function(format!("curve {contact:?} {slices} coupled slices"), |bencher| {
                bencher.iter(|| black_box(&cycle).loaded(&design, TORQUE).curve(Wanted::default()));
            });
        }
    }
}

/// Stages of the study alone, on all threads.
fn stages(criterion: &mut Criterion) {
    let mut stages = Stages::new();
    let mut group = criterion.benchmark_group("stage");
    group.sample_size(10);
    for name in ["stiffness", "ste", "ste_coupled", "optimum", "optimum_de"] {
        stages.prepare(name);
        group.bench_function(name, |bencher| bencher.iter(|| stages.run(name)));
    }
}
