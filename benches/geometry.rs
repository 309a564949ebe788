//! Full profiles: the points of one gear, and a sweep of designs with every check that a study makes of them.

use std::hint::black_box;

use criterion::{Criterion, criterion_group};

use crate::brief;
use gearmesh::gear::geometry::outline::Outline;
use gearmesh::gear::geometry::outline::roots::Root;
use gearmesh::gear::geometry::outline::roots::trochoid::Trochoid;
use gearmesh::gear::geometry::outline::sample::Density;
use gearmesh::gear::geometry::outline::tip::Tip;
use gearmesh::gear::geometry::validity::{Mating, Validity};
use gearmesh::gear::geometry::{Gear, GearPair, Rack, Side, Specification};
use gearmesh::gear::material::Material;

criterion_group!(name = benches; config = brief(); targets = profiles);

fn specification(teeth: u32, profile_shift: f64, tip_radius: f64) -> Specification {
    Specification {
        teeth,
        module: 3e-3,
        pressure_angle: 20_f64.to_radians(),
        profile_shift,
        thickness_allowance: 0.0,
        cutter: None,
        rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius, ..Rack::ISO_53_A },
        tip_radius: None,
        face_width: 20e-3,
        bore_radius: 5e-3,
        material: Material::STEEL,
    }
}

fn outline(gear: &Gear) -> Option<Outline> {
    let toe = Trochoid::default().toe(gear).ok()?;
    Outline::new(gear, toe, Tip::Land, None).ok()
}

/// Numbers of teeth, profile shifts and rack rounds: 25 × 20 × 20, half of which cannot be or cannot run.
fn sweep() -> usize {
    let mut smooth = 0;
    for teeth in 10..35 {
        for shift in 0..20 {
            for round in 0..20 {
                let of = |teeth, shift| specification(teeth, shift, 0.02 * f64::from(round));
                let shift = 0.05 * f64::from(shift) - 0.3;
                let Ok(pair) = GearPair::new(of(teeth, shift), of(48, 0.0), None) else { continue };
                let [Some(pinion), Some(gear)] = [&pair.pinion, &pair.gear].map(outline) else { continue };
                let valid = [(Side::Pinion, &pinion, &gear), (Side::Gear, &gear, &pinion)].into_iter().all(
                    |(side, own, mate)| {
                        let alone = black_box(Validity::new(pair.side(side), own));
                        let mating = Mating::new(&pair, side, own, mate);
                        alone.root_gap < 1e-12
                            && !mating.interferes()
                            && !mating.cuts_root(3e-3)
                            && own.junctions().iter().all(|junction| junction.position_jump() < 1e-12)
                    },
                );
                smooth += usize::from(valid);
            }
        }
    }
    smooth
}

fn profiles(criterion: &mut Criterion) {
    let gear = Gear::new(&specification(17, 0.3, 0.38)).expect("it can be cut");
    let mut group = criterion.benchmark_group("profile");
    group.bench_function("whole gear, 17 teeth x 200 points", |bencher| {
        bencher.iter(|| {
            outline(black_box(&gear)).map(|outline| outline.whole(Density { points: 200, chord_error: None }))
        });
    });
    let large = Gear::new(&specification(48, 0.0, 0.38)).expect("it can be cut");
    group.bench_function("whole gear, 48 teeth x 200 points", |bencher| {
        bencher.iter(|| {
            outline(black_box(&large)).map(|outline| outline.whole(Density { points: 200, chord_error: None }))
        });
    });
    group.sample_size(10).bench_function("sweep of 10,000 designs", |bencher| bencher.iter(|| black_box(sweep())));
    group.finish();
}
