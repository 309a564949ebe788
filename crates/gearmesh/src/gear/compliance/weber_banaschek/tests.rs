//! The tooth against closed forms, another quadrature, another program and finite elements; the body against the ring.

use super::*;
use crate::gear::compliance::ContactLaw;
use crate::gear::compliance::ring::Ring;
use crate::gear::fixtures::standard;
use crate::gear::geometry::Specification;
use crate::gear::geometry::root::RootShape;
use crate::gear::material::Material;

/// 1 m wide.
fn specification(teeth: u32, module: f64, bore_ratio: f64) -> Specification {
    Specification { face_width: 1.0, ..standard(teeth, module, bore_ratio) }
}

fn tabulated(pair: &GearPair, root: RootShape, coupled: bool) -> Tabulated {
    let assumptions = Assumptions { root, contact: ContactLaw::LoadDependent, coupled, torque: None, accuracy: None };
    WeberBanaschek {}.tabulate(pair, assumptions).unwrap()
}

fn pair(teeth: [u32; 2], module: f64, bore_ratio: f64) -> GearPair {
    let [pinion, gear] = teeth.map(|teeth| specification(teeth, module, bore_ratio));
    GearPair::new(pinion, gear, None).unwrap()
}

/// Tier: second method; the formulas as printed in the head of the file, over plain heights by Simpson's rule, with the
/// angle's tangent and the height y_p; every root shape, both gears, 1e-9.
#[test]
fn tables_equal_the_printed_formulas_integrated_by_simpson() {
    let pair = pair([19, 48], 3e-3, 1.75);
    let simpson = |lower: f64, upper: f64, value: &dyn Fn(f64) -> [f64; 2]| {
        let steps = 6000;
        let step = (upper - lower) / f64::from(steps);
        let mut sum = [0.0; 2];
        for k in 0..=steps {
            let weight = if k == 0 || k == steps { 1.0 } else { f64::from(2 + 2 * (k % 2)) };
            for (sum, value) in sum.iter_mut().zip(value(lower + f64::from(k) * step)) {
                *sum += weight * value * step / 3.0;
            }
        }
        sum
    };
    let mut below = 0;
    for shape in [RootShape::Trochoid, RootShape::CircularFillet, RootShape::BaseCircle] {
        let tables = tabulated(&pair, shape, false).compliance;
        for (gear, table) in [(&pair.pinion, &tables.pinion), (&pair.gear, &tables.gear)] {
            let root = gear.root(shape).unwrap();
            let clamped =
                if shape == RootShape::BaseCircle { gear.root_radius.max(gear.base_radius) } else { gear.root_radius };
            let (foot, chord) = (clamped * root.half_angle.cos(), 2.0 * clamped * root.half_angle.sin());
            for k in 0..=8 {
                let roll = root.form_roll + f64::from(k) / 8.0 * (gear.tip_roll() - root.form_roll);
                let gamma = gear.load_angle(roll);
                let y_p = gear.base_radius / gamma.cos() - foot;
                let terms = |section: Section| {
                    let arm = y_p - (section.height - foot);
                    let thickness = 2.0 * section.half_thickness;
                    [arm * arm / thickness.powi(3), 1.0 / thickness].map(|value| value * section.height_rate)
                };
                // The section at y_p by bisection; the printed integral where it lies on the flank, from the joint down
                // along the continued involute where it does not.
                let (mut low, mut high) = (0.0, gear.tip_roll());
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    if gear.flank(middle).height - foot < y_p { low = middle } else { high = middle }
                }
                below += u32::from(low < root.form_roll);
                let mut integrals = simpson(root.form_roll, low, &|u| terms(gear.flank(u)));
                for piece in &root.pieces {
                    let (lower, upper) = piece.range();
                    let part = simpson(lower, upper, &|parameter| terms(piece.section(parameter)));
                    integrals = [integrals[0] + part[0], integrals[1] + part[1]];
                }
                let (nu, modulus) = (0.3, 206e9);
                let tangent = gamma.tan().powi(2);
                let front = gamma.cos().powi(2) * (1.0 - nu * nu) / modulus;
                let tooth = front * (12.0 * integrals[0] + (2.4 / (1.0 - nu) + tangent) * integrals[1]);
                let q = y_p / chord;
                let half_plane = front
                    * (18.0 / PI * q * q
                        + 2.0 * (1.0 - 2.0 * nu) / (1.0 - nu) * q
                        + 4.8 / PI * (1.0 + (1.0 - nu) / 2.4 * tangent));
                let shear_modulus = modulus / (2.0 * (1.0 + nu));
                let ring = gear.base_radius.powi(2) / (4.0 * PI * shear_modulus)
                    * (gear.specification.bore_radius.powi(-2) - gear.root_radius.powi(-2));
                let found = table.bending.value(roll) + table.shear.value(roll) + table.axial.value(roll);
                // Beside the body: a tooth without a root has none at its foot.
                let scale = half_plane + ring;
                assert!(((found - tooth) / scale).abs() < 1e-9, "{shape:?} at {roll}: {found} for {tooth}");
                assert!((table.body.value(roll) / scale - 1.0).abs() < 1e-9, "{shape:?} body at {roll}");
            }
        }
    }
    assert!((3..40).contains(&below), "{below} of 54 below the joint");
}

/// Tier: second method; the integral along the true root curve instead of the continued involute, where the load line
/// crosses the centreline below their joint: what continuing costs on the active flank, at most.
#[test]
fn continuing_the_involute_costs_little() {
    let mut maximum: f64 = 0.0;
    for teeth in [[19, 48], [19, 100], [60, 100]] {
        let pair = pair(teeth, 3e-3, 1.75);
        let (gear, table) = (&pair.gear, tabulated(&pair, RootShape::Trochoid, false).compliance.gear);
        let root = gear.root(RootShape::Trochoid).unwrap();
        let piece = root.pieces[0];
        for k in 0..40 {
            let active = pair.roll(Side::Gear, pair.end_of_contact);
            let roll = active + 0.01 * f64::from(k) * (gear.tip_roll() - active);
            let (gamma, joint) = (gear.load_angle(roll), piece.range().1);
            let height = gear.base_radius / gamma.cos();
            if piece.section(joint).height <= height {
                continue;
            }
            let end = bracketed(0.0, joint, |parameter| piece.section(parameter).height - height).unwrap();
            let rule = crate::numeric::quadrature::GaussLegendre::new(60);
            let [bending, area] = rule.integrate(0.0, end, |parameter| {
                let Section { half_thickness: x, height: y, height_rate } = piece.section(parameter);
                [(height - y).powi(2) / (8.0 * x.powi(3)) * height_rate, height_rate / (2.0 * x)]
            });
            let front = gamma.cos().powi(2) * 0.91 / 206e9;
            let exact = front * (12.0 * bending + (2.4 / 0.7 + gamma.tan().powi(2)) * area) + table.body.value(roll);
            maximum = maximum.max((table.total(roll) / exact - 1.0).abs());
        }
    }
    assert!((2.2e-3..2.4e-3).contains(&maximum), "{maximum}");
}

/// Tier: closed form; a rack's tooth is a trapezoid, and a gear of z teeth comes near to it as 1/z.
#[test]
fn many_teeth_come_near_to_a_trapezoid() {
    let module = 1e-3;
    let off = |teeth: u32| {
        let mut specification = specification(teeth, module, 2.0);
        specification.face_width = 0.02;
        let gear = Gear::new(&specification).unwrap();
        let root = gear.root(RootShape::BaseCircle).unwrap();
        let beam = Beam::new(&gear, &root, SHEAR_FACTOR).unwrap();
        let (above, slope) = (0.6 * module, 20f64.to_radians().tan());
        let roll = gear.roll_at(gear.reference_radius + above);
        let parts = beam.parts_below(crossing_roll(&gear, roll), roll);
        // Clamped at h_fP below the pitch line, loaded at `above`, square to the side.
        let foot = 1.25 * module;
        let length = foot + above;
        let foot_thickness = 0.5 * PI * module + 2.0 * foot * slope;
        let (w0, w1) = (foot_thickness, foot_thickness - 2.0 * length * slope);
        let y_p = length - 0.5 * w1 * slope;
        // η = (w0 − w)/(2t): ∫(y_p − η)²/w³ dη = 1/(8t³) ∫(w − w_p)²/w³ dw, w_p = w0 − 2t y_p, from w_p to w0.
        let w_p = w0 - 2.0 * slope * y_p;
        let primitive = |w: f64| w.ln() + 2.0 * w_p / w - 0.5 * w_p * w_p / (w * w);
        let bending = (primitive(w0) - primitive(w_p)) / (8.0 * slope.powi(3));
        let area = (w0 / w_p).ln() / (2.0 * slope);
        let (nu, stretch) = (0.3_f64, 206e9 * 0.02);
        let front = 20f64.to_radians().cos().powi(2) * (1.0 - nu * nu) / stretch;
        let exact = front * (12.0 * bending + (2.4 / (1.0 - nu) + slope * slope) * area);
        let found = plane_strain(&gear) * (parts.bending + parts.axial) + parts.shear;
        found / exact - 1.0
    };
    let (near, nearer) = (off(2000), off(4000));
    assert!(near.abs() < 2e-3 && (near / nearer - 2.0).abs() < 0.02, "{near} {nearer}");
}

/// Tier: another program: rack rolled point by point, trapezium over 6e5 sections, with the printed formulas; µm per N/mm.
#[test]
fn values_of_another_program() {
    for (teeth, radius, ratio, bending, shear, axial, half_plane, wind_up) in [
        (19, 9.4, 1.75, 0.002_383_893, 0.008_009_588, 0.000_130_635, 0.012_103_040, 0.002_425_499),
        (19, 10.2, 1.75, 0.012_817_792, 0.013_103_197, 0.000_915_469, 0.018_291_198, 0.002_425_499),
        (43, 21.5, 1.4, 0.001_737_726, 0.007_097_037, 0.000_216_126, 0.010_994_355, 0.000_959_767),
        (43, 22.4434, 1.4, 0.017_100_666, 0.015_900_170, 0.000_987_533, 0.019_832_387, 0.000_959_767),
    ] {
        let pair = pair([teeth, 43], 1e-3, ratio);
        let table = tabulated(&pair, RootShape::Trochoid, false).compliance.pinion;
        let roll = pair.pinion.roll_at(radius * 1e-3);
        let found = [&table.bending, &table.shear, &table.axial, &table.body].map(|part| part.value(roll) * 1e9);
        for (value, other) in found.into_iter().zip([bending, shear, axial, half_plane + wind_up]) {
            assert!((value - other).abs() < 2e-9, "z {teeth} at {radius}: {value} for {other}");
        }
    }
}

/// Tier: second method; finite elements of whole gears in plane strain, two unrelated codes, µm per N/mm. The wheel is within
/// 1.3 % of them. The body of the pinion is 2.1 modules deep and its tooth 2.6 thick: no half plane, and 20 to 30 % too
/// compliant, which the warning says.
#[test]
fn finite_elements_agree_where_the_body_is_deep() {
    let pair = pair([17, 43], 1e-3, 1.4);
    let Tabulated { compliance: tables, warnings, .. } = tabulated(&pair, RootShape::Trochoid, false);
    assert!(warnings.len() == 1 && warnings[0].starts_with("pinion: "), "{warnings:?}");
    for (gear, table, radius, elements, ratio) in [
        (&pair.pinion, &tables.pinion, 8.0023, 0.016_26, 1.296),
        (&pair.pinion, &tables.pinion, 8.5, 0.022_26, 1.197),
        (&pair.gear, &tables.gear, 21.5, 0.020_85, 1.007),
        (&pair.gear, &tables.gear, 22.4434, 0.054_11, 1.012),
    ] {
        let found = table.total(gear.roll_at(radius * 1e-3)) * 1e9 / elements;
        assert!((found - ratio).abs() < 2e-3, "at {radius}: {found}");
    }
}

/// Tier: second method; under a small root the elastic ring is a half plane: what moments turn, and what forces across
/// turn. In plane stress with E/(1 − ν²) and ν/(1 − ν) the ring is in plane strain with E and ν.
#[test]
fn the_half_plane_is_the_limit_of_the_ring() {
    let nu = 0.3_f64;
    let mut specification = specification(40, 1e-3, 3.0);
    specification.material =
        Material { youngs_modulus: 206e9 / (1.0 - nu * nu), poisson_ratio: nu / (1.0 - nu), ..Material::STEEL };
    let stressed = Gear::new(&specification).unwrap();
    let off = |theta: f64| {
        let ring = Ring::new(&stressed, theta);
        let influence = ring.influences(&[0.0])[0];
        // Traction θ/θ_f along the radius: moment 2θ_f²/3 in units of r_f; 1 across: force 2θ_f; chord 2θ_f.
        let (moment, force, chord) = (2.0 / 3.0 * theta * theta, 2.0 * theta, 2.0 * theta);
        let unit = (1.0 - nu * nu) / 206e9;
        let turned = ring.compliance(&influence, [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]);
        let crossed = ring.compliance(&influence, [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]);
        let body = |arm: f64, nu: f64| {
            // Body::compliance with a load square to the centreline, an arm in chords, and no wind-up.
            let square = Gear { half_base_angle: 0.3, base_radius: 1.0 + arm, ..stressed.clone() };
            let material = Material { youngs_modulus: 206e9, poisson_ratio: nu, ..Material::STEEL };
            let square = Gear { specification: Specification { material, ..specification }, ..square };
            Body { height: 1.0, chord: 1.0, wind_up: 0.0 }.compliance(&square, 0.3)
        };
        let [low, none, high] = [-1.0, 0.0, 1.0].map(|arm| body(arm, nu));
        let (by_moment, by_both) = (0.5 * (low + high) - none, 0.5 * (high - low));
        assert!((by_moment / unit * PI - 18.0).abs() < 1e-9, "{by_moment}");
        [
            turned / (by_moment * (moment / chord).powi(2)) - 1.0,
            2.0 * crossed / (by_both * force * moment / chord) - 1.0,
        ]
    };
    let [large, small] = [1e-3, 1e-4].map(off);
    for (index, (large, small)) in large.into_iter().zip(small).enumerate() {
        assert!(small.abs() < 3e-3 && small.abs() < 0.15 * large.abs() + 1e-5, "{index}: {large} {small}");
    }
}

/// The wind-up couples all teeth of a gear alike, and nothing else does.
#[test]
fn neighbours_feel_the_wind_up() {
    let pair = pair([19, 48], 3e-3, 1.75);
    let coupled = tabulated(&pair, RootShape::Trochoid, true).compliance;
    assert!(coupled.coupled && coupled.pinion.neighbours.len() >= 2);
    for (gear, table) in [(&pair.pinion, &coupled.pinion), (&pair.gear, &coupled.gear)] {
        // Lamé's ring: the shear stress F r_b/(2πr²) integrated from the bore to the root circle.
        let shear_modulus = 206e9 / 2.6;
        let (bore, rim, steps) = (gear.specification.bore_radius, gear.root_radius, 2000);
        let step = (rim - bore) / f64::from(steps);
        let turn: f64 = (0..steps)
            .map(|k| bore + (f64::from(k) + 0.5) * step)
            .map(|r| gear.base_radius / (2.0 * PI * shear_modulus * r.powi(3)) * step)
            .sum();
        for surface in &table.neighbours {
            for (first, further) in [(0.1, 0.5), (0.4, 0.2)] {
                let ratio = surface.value(first, further) / (turn * gear.base_radius);
                assert!((ratio - 1.0).abs() < 1e-6, "{ratio}");
            }
            assert!(surface.value(0.2, 0.2) < table.body.value(0.2));
        }
    }
    let alone = tabulated(&pair, RootShape::Trochoid, false).compliance;
    assert!(!alone.coupled && alone.gear.neighbours.is_empty());
    assert_eq!(alone.gear.body, coupled.gear.body);
}

#[test]
fn a_body_that_is_no_half_plane_is_told() {
    assert!(tabulated(&pair([19, 48], 3e-3, 1.75), RootShape::Trochoid, true).warnings.is_empty());
    // 19 teeth: 24.75 mm at the root, 7.8 mm thick; 24.75 less 24.75/1.2 is 4.1 mm.
    let warnings = tabulated(&pair([19, 48], 3e-3, 1.2), RootShape::Trochoid, true).warnings;
    assert!(
        warnings.len() == 1 && warnings[0].starts_with("pinion: ") && warnings[0].contains("4.125 mm deep"),
        "{warnings:?}"
    );
}
