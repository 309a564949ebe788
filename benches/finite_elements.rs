//! The finite-element method: error against run time, the sweeps of `mei2016`, and the memory of a whole run.

use std::process::{Command, Stdio};
use std::time::Duration;

use std::hint::black_box;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, criterion_group};

use crate::accuracy::{relative, seconds};
use crate::article::{Stages, TORQUE, study_path};
use crate::brief;
use gearmesh::gear::compliance::finite_element::FiniteElement;
use gearmesh::gear::compliance::{Assumptions, ContactLaw, Method, Tabulated};
use gearmesh::gear::contact::CornerContact;
use gearmesh::gear::geometry::GearPair;
use gearmesh::gear::geometry::root::RootShape;
use gearmesh::gear::mesh::answers::curve::Wanted;
use gearmesh::gear::mesh::{Mesh, Settings};
use gearmesh::gear::modification::arc::ArcRelief;
use gearmesh::gear::modification::curve::Curve;
use gearmesh::gear::modification::relief::{Amount, FromTip, Start};
use gearmesh::gear::modification::tip_curve::{FlankPoint, Formulas, Through, TipPoint};
use gearmesh::gear::modification::tip_relief::TipRelief;
use gearmesh::gear::modification::{Design, Gears};

criterion_group!(name = benches; config = brief().sample_size(10); targets = finite_elements);

const COUPLED: Assumptions = Assumptions {
    root: RootShape::Trochoid,
    contact: ContactLaw::LoadDependent,
    coupled: true,
    torque: None,
    accuracy: None,
};

/// Both gears of a pair, from so many elements across, to an accuracy if one is wanted.
fn tabulate(pair: &GearPair, elements_across: u32, accuracy: Option<f64>) -> Tabulated {
    with_law(pair, COUPLED.contact, elements_across, accuracy)
}

fn with_law(pair: &GearPair, contact: ContactLaw, elements_across: u32, accuracy: Option<f64>) -> Tabulated {
    let method = FiniteElement { elements_across, ..FiniteElement::default() };
    method.tabulate(pair, Assumptions { accuracy, contact, ..COUPLED }).expect("the pair can be meshed")
}

/// Two gears of 48 teeth: half of the time is one gear's.
fn gears_of_48() -> GearPair {
    let pair = Stages::new().pair();
    let gear = pair.gear.specification;
    GearPair::new(gear, gear, None).expect("they fit")
}

fn finite_elements(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("finite elements");
    let pair = gears_of_48();
    group.bench_function("48 teeth, 0.2 %", |bencher| {
        bencher.iter_custom(|times| {
            let began = std::time::Instant::now();
            for _ in 0..times {
                std::hint::black_box(tabulate(&pair, 16, Some(0.002)));
            }
            began.elapsed() / 2
        });
    });
    group.bench_function("48 teeth, resolved, 0.1 %", |bencher| {
        bencher.iter_custom(|times| {
            let began = std::time::Instant::now();
            for _ in 0..times {
                std::hint::black_box(with_law(&pair, ContactLaw::Resolved, 16, Some(0.001)));
            }
            began.elapsed() / 2
        });
    });
    curves(&mut group);
    let mut stages = Stages::of("mei2016");
    stages.prepare("arc");
    group.measurement_time(Duration::from_secs(8));
    group.bench_function("both sweeps of mei2016", |bencher| {
        bencher.iter(|| (stages.run("arc"), stages.run("parabola")));
    });
}

/// Curves of both contact laws of a pair with relief on both tips, 64 positions.
fn curves(group: &mut BenchmarkGroup<WallTime>) {
    let pair = Stages::new().pair();
    let relief = TipRelief {
        amount: Amount::Depth(10e-6),
        start: Start::Length(3.4e-3),
        counted_from: FromTip::Tip,
        curve: Curve::Parabolic,
    };
    let mut design = Design::default();
    design.add(Gears::Both, &relief, &pair).expect("it is shorter than the flank");
    for (law, contact) in [("Weber", ContactLaw::LoadDependent), ("resolved", ContactLaw::Resolved)] {
        let mut compliance = with_law(&pair, contact, 16, None).compliance;
        for (what, corner_contact, coupled) in
            [("uncoupled", CornerContact::None, false), ("coupled, corner contact", CornerContact::Exact, true)]
        {
            compliance.coupled = coupled;
            let settings = Settings { corner_contact, ..Settings::default() };
            let cycle = Mesh::new(&pair, &compliance, settings).expect("its contact ratio is 1.65");
            group.bench_function(format!("curve, {law}, {what}"), |bencher| {
                bencher.iter(|| black_box(&cycle).loaded(&design, TORQUE).curve(Wanted::default()));
            });
        }
        group.bench_function(format!("cycle, {law}"), |bencher| {
            bencher.iter(|| Mesh::new(black_box(&pair), &compliance, Settings::default()));
        });
    }
}

pub fn print() {
    let pair = gears_of_48();
    let own = |tabulated: &Tabulated| {
        let body = &tabulated.compliance.gear.body;
        (0..=20).map(|k| body.value(body.lower() + f64::from(k) / 20.0 * (body.upper() - body.lower()))).collect()
    };
    let finest: Vec<f64> = own(&tabulate(&pair, 48, None));
    println!("\nFinite elements, 48 teeth: largest relative error along the flank (48 across: no error), one gear\n");
    println!(
        "{:>7} {:>9} {:>9} {:>10} {:>10} {:>9} {:>9}",
        "across", "elements", "unknowns", "error", "estimate", "ms", "exponent"
    );
    let mut growth = Growth::default();
    for across in [6, 8, 12, 16, 24, 32] {
        let found = tabulate(&pair, across, None);
        let values: Vec<f64> = own(&found);
        let error = values.iter().zip(&finest).map(|(value, exact)| relative(*value, *exact)).fold(0.0, f64::max);
        let mesh = found.meshes[1];
        let taken = 0.5 * seconds(|| tabulate(&pair, across, None));
        println!(
            "{across:>7} {:>9} {:>9} {error:>10.1e} {:>10.1e} {:>9.1} {}",
            mesh.elements,
            mesh.unknowns,
            mesh.error_estimate,
            taken * 1e3,
            growth.next(mesh.unknowns as f64, taken)
        );
    }
    sweeps();
    println!("\nmei2016, whole process without a cache: {} MiB at most in memory", most_memory("mei2016") / 1024);
}

/// By which power of a number time has grown since the last one.
#[derive(Default)]
struct Growth(Option<(f64, f64)>);

impl Growth {
    fn next(&mut self, number: f64, taken: f64) -> String {
        let before = self.0.replace((number, taken));
        before.map_or_else(
            || format!("{:>9}", "-"),
            |(size, time)| format!("{:>9.2}", (taken / time).ln() / (number / size).ln()),
        )
    }
}

/// The sweep of `mei2016` over positions and over designs: coupled, load-dependent, corner contact; one thread.
fn sweeps() {
    let pair = Stages::of("mei2016").pair();
    let compliance = tabulate(&pair, 16, Some(0.002)).compliance;
    let base = Mesh::new(&pair, &compliance, Settings { corner_contact: CornerContact::Exact, ..Settings::default() })
        .expect("its contact ratio is 1.68");
    let design = |index: u32| {
        let mut design = Design::default();
        let level = |place: u32| f64::from(index / 5_u32.pow(place) % 5);
        for (gears, place) in [(Gears::Gear, 0), (Gears::Pinion, 2)] {
            let tip = TipPoint::Share(0.02 + 0.02 * level(place + 1));
            let start = FlankPoint::Share(0.05 + 0.05 * level(place));
            let arc = ArcRelief { through: Through { tip, start, formulas: Formulas::Derived } };
            design.add(gears, &arc, &pair).expect("the article has it");
        }
        design
    };
    // Designs of all kinds among the first ones, too: a deep relief takes longer than a shallow one.
    let variances = |positions: usize, designs: u32| {
        let cycle = base.sampled(Settings { positions, ..base.settings });
        (0..designs).map(|index| cycle.loaded(&design(index * 401 % 625), 420.0).variance()).sum::<f64>()
    };
    println!("\nGrowth: variance of arcs of mei2016, coupled, corner contact, one thread; 25 designs\n");
    println!("{:>9} {:>9} {:>12} {:>9}", "positions", "ms", "µs a design", "exponent");
    let mut growth = Growth::default();
    for positions in [8, 16, 32, 64, 128, 256, 512, 1024] {
        let taken = seconds(|| variances(positions, 25));
        let exponent = growth.next(positions as f64, taken);
        println!("{positions:>9} {:>9.1} {:>12.1} {exponent}", taken * 1e3, taken * 1e6 / 25.0);
    }
    println!("\nThe same over designs, 24 positions\n");
    println!("{:>9} {:>9} {:>12} {:>9}", "designs", "ms", "µs a design", "exponent");
    let mut growth = Growth::default();
    for designs in [5, 25, 125, 625] {
        let taken = seconds(|| variances(24, designs));
        let exponent = growth.next(f64::from(designs), taken);
        println!("{designs:>9} {:>9.1} {:>12.1} {exponent}", taken * 1e3, taken * 1e6 / f64::from(designs));
    }
}

/// The largest resident size of a run \[KiB\], as the kernel counts it while the process lives.
fn most_memory(study: &str) -> u64 {
    let folder = tempfile::tempdir().expect("there is a place for temporary files");
    let mut command = Command::new(env!("CARGO_BIN_EXE_gearstudy"));
    command.arg("run").arg(study_path(study)).arg("--results").arg(folder.path().join("results"));
    command.arg("--cache").arg(folder.path().join("cache"));
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("the program was built");
    let mut maximum = 0;
    while child.try_wait().expect("it is our child").is_none() {
        let status = std::fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let size = line.and_then(|line| line.trim().trim_end_matches(" kB").parse().ok());
        maximum = maximum.max(size.unwrap_or(0));
        std::thread::sleep(Duration::from_millis(5));
    }
    maximum
}
