use std::hint::black_box;
use gearmesh::prelude::*;
use gearmesh::gear::modification::flank::Flank;
const POINTS: u32 = 500;
fn gear(teeth: u32, face_width: f64, bore_radius: f64) -> Specification {
    Specification { teeth, module: 3e-3, pressure_angle: 20_f64.to_radians(), profile_shift: 0.0, thickness_allowance: 0.0, cutter: None,
        rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.38, ..Rack::ISO_53_A }, tip_radius: None, face_width, bore_radius,
        material: Material { youngs_modulus: 206e9, poisson_ratio: 0.3, ..Material::STEEL } }
}
fn relieved(pair: &GearPair, curve: Curve) -> Design {
    let (amount, start) = (Amount::Depth(12e-6), Start::Length(4e-3));
    let mut design = Design::default();
    design.add(Gears::Both, &TipRelief { amount, start, counted_from: FromTip::Tip, curve }, pair).unwrap();
    design
}
fn waves(a: f64, l: f64) -> Box<dyn FnMut(f64) -> f64> { Box::new(move |p| a * (std::f64::consts::TAU * p / l).sin()) }
fn noise(most: f64) -> Box<dyn FnMut(f64) -> f64> {
    let mut state = 12345_u64;
    Box::new(move |_| { state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        most * ((state >> 33) as f64 / f64::from(1_u32 << 30) - 1.0) })
}
fn traced(pair: &GearPair, mut beside: Box<dyn FnMut(f64) -> f64>, points: u32) -> Design {
    let plain = relieved(pair, Curve::Power { exponent: 2.0 });
    let mut design = Design::default();
    for (gears, side) in [(Gears::Pinion, Side::Pinion), (Gears::Gear, Side::Gear)] {
        let flank = Flank::new(pair, side);
        let part = |at: u32| f64::from(at) / f64::from(points - 1);
        let rolls = (0..points).map(|at| flank.root_roll + (flank.tip_roll - flank.root_roll) * part(at));
        let trace = Measured {
            deviations: rolls.clone().map(|roll| beside(roll * flank.base_radius) - plain.depth(side, roll)).collect(),
            roll_lengths: Some(rolls.map(|roll| roll * flank.base_radius).collect()),
            ..Measured::default() };
        design.add(gears, &trace, pair).unwrap();
    }
    design
}
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let pair = GearPair::new(gear(19, 20e-3, 14.079e-3), gear(48, 18e-3, 38.823e-3), None).unwrap();
    let points = a.get(4).map_or(POINTS, |p| p.parse().unwrap());
    let design = match a[1].as_str() {
        "relief" => relieved(&pair, Curve::Parabolic),
        "trace" => traced(&pair, waves(0.0, 1.0), points),
        "w4" => traced(&pair, waves(2e-6, 4e-3), points),
        "w05" => traced(&pair, waves(0.3e-6, 0.5e-3), points),
        "w03" => traced(&pair, waves(1e-6, 0.3e-3), points),
        "w01" => traced(&pair, waves(1e-6, 0.1e-3), points),
        "noise" => traced(&pair, noise(0.5e-6), points),
        "noise2" => traced(&pair, noise(2e-6), points),
        _ => panic!() };
    let corner = if std::env::var("CORNER").is_ok() { CornerContact::Exact } else { CornerContact::None };
    let contact = match std::env::var("LAW").as_deref() { Ok("weber") => ContactLaw::LoadDependent, Ok("resolved") => ContactLaw::Resolved, _ => ContactLaw::Linear };
    let assumptions = Assumptions { root: RootShape::CircularFillet, contact, coupled: false, torque: None, accuracy: None };
    let compliance = Energy::default().tabulate(&pair, assumptions).unwrap().compliance;
    let cycle = MeshCycle::new(&pair, &compliance, Settings { corner_contact: corner, positions: std::env::var("POS").map_or(64, |p| p.parse().unwrap()), ..Settings::default() }).unwrap();
    let calls: u32 = a[3].parse().unwrap();
    let begin = std::time::Instant::now();
    let mut out = String::new();
    for _ in 0..calls {
        let case = LoadCase::new(black_box(&cycle), &design, 50.0);
        match a[2].as_str() {
            "case" => { black_box(&case); }
            "curve" => { let c = case.curve(Wanted::default()); out = format!("{} {:e}", c.len(), c.iter().map(|p| p.transmission_error).sum::<f64>()); black_box(&c); }
            "summary" => { let s = case.curve_and_summary(Wanted::default()); out = format!("{:e} {:e} {:e}", s.1.peak_to_peak, s.1.mean, s.1.unloaded_peak_to_peak); out += &format!(" var {:e} cr {:.6} share {:.6} n {}", s.1.variance, s.1.loaded_contact_ratio, s.1.largest_load_share, s.0.len()); black_box(&s); }
            "ptp" => { let p = case.peak_to_peak(); out = format!("{p:e}"); black_box(p); }
            _ => panic!() }
    }
    if std::env::var("TIME").is_ok() { println!("{} {} {:.1} us {out}", a[1], a[2], begin.elapsed().as_secs_f64() / f64::from(calls) * 1e6); }
}
