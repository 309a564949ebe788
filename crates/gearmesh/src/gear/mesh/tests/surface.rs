//! Modifications that are not a sum of a profile and a lead.

use std::sync::Arc;

use super::*;
use crate::gear::contact::{CornerContact, SliceCoupling};
use crate::gear::fixtures::least_gap_of;
use crate::gear::geometry::Side;
use crate::gear::mesh::answers::pressure::most_loaded;
use crate::gear::modification::helix_slope::HelixSlope;
use crate::gear::modification::{Gears, Modification, NamedModification, Specified};
use declare::error::Diagnostic;

/// A tip relief and a bow across the face, lowest at an end, where any slices have a place, told as a profile and a lead, or most of it as a
/// surface.
#[derive(Debug)]
struct Relieved {
    start: [f64; 1],
    as_surface: bool,
}

impl Relieved {
    fn profile(&self, roll: f64) -> f64 {
        120e-6 * (roll - self.start[0]).max(0.0)
    }

    fn across(z: f64) -> f64 {
        3e-6 * (1.0 - libm::cos(60.0 * (z + 9e-3)))
    }
}

impl Modification for Relieved {
    fn depth(&self, roll: f64) -> f64 {
        let part = if self.as_surface { 0.3 } else { 1.0 };
        part * self.profile(roll)
    }

    fn profile_breaks(&self) -> &[f64] {
        &self.start
    }

    fn varies_along_profile(&self) -> bool {
        true
    }

    fn lead(&self, z: f64) -> f64 {
        let part = if self.as_surface { 0.4 } else { 1.0 };
        part * Self::across(z)
    }

    fn lead_quadratic(&self, _z: f64) -> Option<[f64; 3]> {
        None
    }

    fn varies_along_face(&self) -> bool {
        true
    }

    fn surface(&self, roll: f64, z: f64) -> f64 {
        if self.as_surface { 0.7 * self.profile(roll) + 0.6 * Self::across(z) } else { 0.0 }
    }

    fn varies_over_surface(&self) -> bool {
        self.as_surface
    }

    fn resolved(&self) -> Vec<(&'static str, f64)> {
        Vec::new()
    }
}

fn of(modification: impl Modification + 'static) -> Design {
    Design {
        pinion: vec![NamedModification { family: "test", modification: Arc::new(modification) }],
        ..Design::default()
    }
}

/// Tier: second method; a surface that is a sum gives what profile and lead give, whatever the contact, the coupling, and
/// where the flanks touch.
#[test]
fn a_sum_told_as_a_surface_gives_the_same() {
    let pair = pair();
    let logarithmic = |pair: PairCompliance| PairCompliance { contact: Some(ContactLaw::LoadDependent), ..pair };
    for (corner_contact, slice_coupling, slices, positions) in [
        (CornerContact::None, SliceCoupling::None, 17, 24),
        (CornerContact::Exact, SliceCoupling::None, 9, 16),
        (CornerContact::None, SliceCoupling::Plate, 7, 16),
        (CornerContact::Exact, SliceCoupling::Plate, 5, 8),
    ] {
        let settings = Settings { positions, slices, corner_contact, slice_coupling };
        for compliance in [varying(), coupled(), logarithmic(varying()), logarithmic(coupled())] {
            let cycle = Mesh::new(&pair, &compliance, settings).unwrap();
            for torque in [0.0, 5.0, 120.0, 900.0] {
                let [sum, surface] = [false, true].map(|as_surface| of(Relieved { start: [0.42], as_surface }));
                let [sum, surface] = [&sum, &surface].map(|design| cycle.loaded(design, torque));
                let context = format!("{settings:?}, {torque} N m");
                assert!(sum.uses_slices() && surface.uses_slices());
                let [one, two] = [&surface, &sum].map(Loaded::peak_to_peak);
                assert!((one - two).abs() <= 1e-7 * two, "{context}: {one:e} {two:e}");
                for point in sum.curve(Wanted::default()) {
                    let at = (point.cycle_position, point.pairs);
                    let [one, two] = [&surface, &sum].map(|loading| loading.state(at.0, at.1));
                    let away = (one.transmission_error() - two.transmission_error()).abs();
                    assert!(away <= 1e-9 * two.transmission_error() + 1e-18, "{context}: {away:e}");
                    for spring in 0..5 {
                        let [here, there] = [&one, &two].map(|state| state.balance.loads[spring]);
                        assert!((here - there).abs() < 1e-7 * cycle_force(torque) + 1e-12, "{context}: {here} {there}");
                        let [here, there] = [(&surface, &one), (&sum, &two)]
                            .map(|(loading, state)| loading.line_load(at.0, state, spring));
                        let mean = cycle_force(torque) / cycle.face_width;
                        assert!((here - there).abs() < 1e-6 * mean + 1e-9, "{context}: {here} {there}");
                    }
                }
            }
        }
    }
}

fn cycle_force(torque: f64) -> f64 {
    torque / pair().pinion.base_radius
}

/// Twisted: ever more to one end towards the tip, and to the other end towards the root.
#[derive(Debug)]
struct Twist {
    middle: f64,
    /// Slope across the face by roll angle.
    rate: f64,
}

impl Modification for Twist {
    fn surface(&self, roll: f64, z: f64) -> f64 {
        self.rate * (roll - self.middle) * z
    }

    fn varies_over_surface(&self) -> bool {
        true
    }

    fn resolved(&self) -> Vec<(&'static str, f64)> {
        Vec::new()
    }
}

/// Tier: closed form and invariant. With the whole face in contact a twist adds the mean of its least gaps, which but for
/// the slopes of its profiles is 0; where less is in contact, one pair with a slope a across the face b carries k w²/2ab;
/// and the mirrored twist gives the same.
#[test]
fn a_twisted_flank_is_a_slope_that_turns() {
    let pair = pair();
    let settings = Settings { slices: 257, ..Settings::default() };
    let cycle = Mesh::new(&pair, &constant(&pair, STIFFNESS), settings).unwrap();
    let (middle, rate) = (0.3, 4e-3);
    let (twisted, mirrored) = (of(Twist { middle, rate }), of(Twist { middle, rate: -rate }));
    let width = cycle.face_width;
    let (mut whole, mut partly) = (0, 0);
    let mut loadings = [&twisted, &mirrored].map(|design| cycle.design(design));
    for torque in [2.0, 20.0, 4000.0] {
        let [points, other] = loadings.each_mut().map(|loading| loading.under(torque).curve(Wanted::default()));
        let force = cycle_force(torque);
        for (point, mirror) in points.iter().zip(&other) {
            close(mirror.transmission_error, point.transmission_error, 1e-9);
            if point.pairs != 1 {
                continue;
            }
            let roll = point.path_position / pair.pinion.base_radius;
            let slope = (rate * (roll - middle)).abs();
            let gap = |z: f64| {
                let depth = |side, roll| if side == Pinion { rate * (roll - middle) * z } else { 0.0 };
                least_gap_of(&pair, depth, point.path_position)
            };
            let across = crate::numeric::lobatto::Rule::new(9);
            let gaps: Vec<f64> = across.nodes.iter().map(|node| gap(width * (node - 0.5))).collect();
            let mean: f64 = gaps.iter().zip(&across.weights).map(|(gap, weight)| weight * gap).sum();
            if force / STIFFNESS + mean > gaps[0].max(gaps[8]) {
                whole += 1;
                let (found, exact) = (point.transmission_error, force / STIFFNESS + mean);
                // Of the slices, which are straight between their places.
                let off = 1e-9 * exact + 1.6e-5 * mean.abs();
                assert!((found - exact).abs() < off, "{found:e} is not {exact:e}");
            } else {
                partly += 1;
                // Across the face the gaps are a parabola but for terms of third order in the slopes.
                let [low, middle, high] = [gaps[0], gaps[4], gaps[8]];
                let parabola = |x: f64| middle + (high - low) * x + 2.0 * (high - 2.0 * middle + low) * x * x;
                let carried = |approach: f64| {
                    let at = |step: u32| (f64::from(step) + 0.5) * 1e-4 - 0.5;
                    let sum: f64 = (0..10_000).map(|step| (approach - parabola(at(step))).max(0.0)).sum();
                    STIFFNESS * sum * 1e-4 - force
                };
                let exact = crate::numeric::crossing::bracketed(low.min(high), 1e-3, carried).unwrap();
                let size = exact + 0.5 * slope * width;
                assert!(
                    (point.transmission_error - exact).abs() < 2e-3 * size,
                    "{:e} {exact:e}",
                    point.transmission_error
                );
            }
        }
    }
    assert!(whole > 10 && partly > 10, "{whole} {partly}");
}

/// What is left of the tooth is looked at where the surface is deepest.
#[test]
fn a_surface_that_takes_half_the_tooth_is_refused() {
    let pair = pair();
    let mut design = of(Twist { middle: 0.3, rate: 4e-3 });
    let slope = HelixSlope { amount: 1e-6 };
    assert!(design.add(Gears::Pinion, &slope, &pair).is_ok());
    design.pinion.extend(of(Twist { middle: 0.3, rate: 4.0 }).pinion);
    assert!(design.add(Gears::Pinion, &slope, &pair).is_err());
}

/// A family that forgets a flag would do nothing.
#[test]
fn a_function_without_its_flag_is_refused() {
    /// One that says nothing of its function.
    #[derive(Clone, Copy, Debug, declare::Declared)]
    #[declared(name = "forgetful")]
    struct Forgetful {
        /// Which function it has.
        #[declared(minimum = 0, maximum = 3, default = "0")]
        pub function: u8,
    }

    impl Specified for Forgetful {
        fn on(&self, _: &GearPair, _: Side) -> Result<Arc<dyn Modification>, Diagnostic> {
            Ok(Arc::new(*self))
        }
    }

    impl Modification for Forgetful {
        fn depth(&self, _: f64) -> f64 {
            if self.function == 1 { 1e-6 } else { 0.0 }
        }

        fn lead(&self, _: f64) -> f64 {
            if self.function == 2 { 1e-6 } else { 0.0 }
        }

        fn surface(&self, _: f64, _: f64) -> f64 {
            if self.function == 3 { 1e-6 } else { 0.0 }
        }

        fn resolved(&self) -> Vec<(&'static str, f64)> {
            Vec::new()
        }
    }

    let pair = pair();
    let said = |function: u8| Design::default().add(Gears::Both, &Forgetful { function }, &pair);
    assert!(said(0).is_ok());
    for (function, name) in [(1, "depth"), (2, "lead"), (3, "surface")] {
        let message = said(function).unwrap_err().message;
        assert!(message.contains(&format!("`forgetful` has a {name} that is not 0")), "{message}");
    }
}

/// Tier: second method; a surface that is a sum has the map of profile and lead, and a twisted flank one that adds up to the
/// force as far as its slices do, and is largest at opposite ends of the face before and after its middle.
#[test]
fn maps_of_surfaces_are_those_of_their_slices() {
    let pair = pair();
    for slice_coupling in [SliceCoupling::None, SliceCoupling::Plate] {
        let settings = Settings { slices: 33, slice_coupling, ..Settings::default() };
        let cycle =
            Mesh::new(&pair, &PairCompliance { contact: Some(ContactLaw::Resolved), ..coupled() }, settings).unwrap();
        let [sum, surface] = [false, true].map(|as_surface| of(Relieved { start: [0.42], as_surface }));
        let [one, two] = [&sum, &surface].map(|design| cycle.loaded(design, 120.0).map(4, 33));
        assert_eq!(one.len(), two.len());
        let most = one.iter().map(|cell| cell.contact.load).fold(0.0, f64::max);
        for (one, two) in one.iter().zip(&two) {
            assert_eq!([one.step, one.strip.cast_signed()], [two.step, two.strip.cast_signed()]);
            assert!((one.contact.load - two.contact.load).abs() < 1e-3 * most, "{one:?} {two:?}");
        }
        let twisted = of(Twist { middle: 0.3, rate: 4e-3 });
        let loading = cycle.loaded(&twisted, 60.0);
        let cells = loading.map(8, 33);
        let sums = |step: isize| -> f64 {
            let here = cells.iter().filter(|cell| cell.step.rem_euclid(8) == step);
            here.map(|cell| cell.contact.load * cycle.face_width / 33.0).sum()
        };
        let rounding = if slice_coupling == SliceCoupling::Plate { 1e-12 } else { 2e-3 };
        (0..8).for_each(|step| close(sums(step), loading.force(), rounding));
        let top = |step: isize| {
            let here = cells.iter().filter(|cell| cell.step == step);
            here.max_by(|one, two| one.contact.load.total_cmp(&two.contact.load)).unwrap()
        };
        let middle = 0.3 * pair.pinion.base_radius - pair.start_of_contact;
        for step in [1, 2, 3, 9, 10, 11] {
            let cell = top(step);
            assert_eq!(cell.z > 0.0, cell.path_position < middle, "{cell:?}");
            let place = cell.path_position.rem_euclid(cycle.period());
            let spring = usize::from(step >= 8);
            let most = most_loaded(&loading.case, place, cycle.pairs_behind(place), spring).unwrap();
            assert!((most - cell.z).abs() < cycle.face_width / 33.0, "{most} {cell:?}");
        }
        let found = loading.summary(Wanted { pressure: true, ..Wanted::default() }).largest_pressure.unwrap();
        assert!(found.across.unwrap().abs() > 0.4 * cycle.face_width, "{found:?}");
    }
}
