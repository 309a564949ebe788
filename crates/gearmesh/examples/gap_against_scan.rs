use gearmesh::prelude::*;
use gearmesh::gear::contact::separation::Facing;
use gearmesh::gear::modification::flank::Flank;
struct R(u64);
impl R { fn n(&mut self) -> f64 { self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407); (self.0 >> 11) as f64 / (1u64 << 53) as f64 } fn b(&mut self, a: f64, b: f64) -> f64 { a + (b - a) * self.n() } }
fn gear(teeth: u32, m: f64, x: f64) -> Specification {
    Specification { teeth, module: m, pressure_angle: 20_f64.to_radians(), profile_shift: x, thickness_allowance: 0.0, cutter: None,
        rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.25, ..Rack::ISO_53_A }, tip_radius: None, face_width: 10.0*m, bore_radius: m * (0.25 * teeth as f64), material: Material::STEEL }
}
fn main() {
    let mut r = R(std::env::args().nth(1).map_or(7, |a| a.parse().unwrap()));
    let (mut done, mut worst) = (0, 0.0_f64);
    for k in 0..400 {
        let m = 1e-3 * [0.5, 1.0, 3.0, 8.0, 20.0][(r.n() * 5.0) as usize];
        let (z1, z2) = ((r.b(12.0, 60.0)) as u32, (r.b(12.0, 150.0)) as u32);
        let (x1, x2) = (r.b(-0.3, 0.6), r.b(-0.3, 0.6));
        let Ok(pair) = GearPair::new(gear(z1, m, x1), gear(z2, m, x2), None) else { continue };
        let mut design = Design::default();
        let points = r.b(20.0, 1500.0) as u32;
        let (amp, kind, len) = (r.b(0.05e-6, 3e-6), r.n(), r.b(0.02, 2.0) * m);
        let relief = r.b(0.0, 20e-6);
        for (gears, side) in [(Gears::Pinion, Side::Pinion), (Gears::Gear, Side::Gear)] {
            if r.n() < 0.15 { continue; }
            let flank = Flank::new(&pair, side);
            let rolls: Vec<f64> = (0..points).map(|at| flank.root_roll + (flank.tip_roll - flank.root_roll) * f64::from(at) / f64::from(points - 1)).collect();
            let dev: Vec<f64> = rolls.iter().enumerate().map(|(at, roll)| { let q = at as f64 / f64::from(points); (if kind < 0.5 { amp * r.b(-1.0, 1.0) } else { amp * (std::f64::consts::TAU * roll * flank.base_radius / len).sin() }) - relief * (q - 0.7).max(0.0).powi(2) * 10.0 }).collect();
            let trace = Measured { deviations: dev, roll_lengths: Some(rolls.iter().map(|roll| roll * flank.base_radius).collect()), ..Measured::default() };
            if design.add(gears, &trace, &pair).is_err() { continue; }
        }
        let Ok(t) = Energy::default().tabulate(&pair, Assumptions { contact: ContactLaw::Linear, coupled: false, ..Assumptions::default() }) else { continue };
        for corner_contact in [CornerContact::None, CornerContact::Exact] {
            let Ok(cycle) = MeshCycle::new(&pair, &t.compliance, Settings { corner_contact, ..Settings::default() }) else { continue };
            let case = LoadCase::new(&cycle, &design, 30.0 * (m / 1e-3).powi(3));
            done += 1;
            let (a, e) = (pair.start_of_contact, pair.end_of_contact);
            let more = if corner_contact == CornerContact::None { 0.0 } else { 0.05 * (e - a) };
            for i in 0..40 {
                let s = a - more + (e - a + 2.0 * more) * (i as f64 + r.n()) / 40.0;
                let Some(gap) = case.gap(s) else { continue };
                let mut least = f64::INFINITY; let mut at = 0.0;
                for side in [Side::Gear, Side::Pinion] {
                    let facing = Facing::new(&pair, side);
                    let nominal = facing.turned(side, s);
                    let first = (facing.start - nominal).max(0.0);
                    for step in 0..=6000 {
                        let before = first + 0.6 * m * f64::from(step) / 6000.0;
                        let touch = facing.touch(nominal + before, before);
                        if nominal + before > facing.end || touch.curvature > facing.end { break; }
                        let d = design.depth(side, facing.point_roll(nominal + before)) + design.depth(side.other(), facing.flank_roll(touch.curvature));
                        if touch.separation + d < least { least = touch.separation + d; at = before; }
                    }
                }
                let off = gap - least;
                if off > 5e-11 * (1.0 + m / 1e-3) { println!("{k} z {z1}/{z2} m {m} x {x1:.2} {x2:.2} points {points} amp {amp:e} kind {kind:.2} len {len:e} corner {:?} s {s:e} [{a:e} {e:e}] gap {gap:e} least {least:e} at {at:e} off {off:e}", corner_contact); }
                worst = worst.max(off);
            }
            std::hint::black_box(case.peak_to_peak());
        }
    }
    println!("cases {done} worst {worst:e}");
}
