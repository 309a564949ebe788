//! Pressure and width of contacts: closed forms, brute force, balance over the map, convergence, corners.

use super::corner::exact;
use super::*;
use crate::gear::contact::flattening::Bodies;
use crate::gear::contact::{CornerContact, SliceCoupling};
use crate::gear::material::{Material, Plane};
use crate::gear::mesh::answers::face_map::Cell;
use crate::gear::mesh::answers::pressure::LineContact;
use std::f64::consts::PI;

const PRESSURE: Wanted = Wanted { harmonics: 0, pressure: true, root_stress: false };

fn with(contact: ContactLaw, plane: Plane) -> PairCompliance {
    PairCompliance { contact: Some(contact), plane, ..coupled() }
}

fn laws() -> [PairCompliance; 3] {
    [ContactLaw::Linear, ContactLaw::LoadDependent, ContactLaw::Resolved].map(|law| with(law, Plane::Strain))
}

/// What varies across the face: nothing, a crown, a slope, what has no closed form.
fn faces(pair: &GearPair) -> [Design; 4] {
    let ends = [
        ("amount", Quantity(20e-6)),
        ("length", Quantity(5e-3)),
        ("curve", Choice("power")),
        ("exponent", Number(1.7)),
    ];
    let tip = [("amount", Quantity(8e-6)), ("length", Quantity(4e-3)), ("curve", Choice("parabolic"))];
    let of = |part: &'static str, values: &[(&'static str, declare::record::Value)]| {
        design(pair, &[("tip_relief", "both", &tip), (part, "pinion", values)]).unwrap()
    };
    [
        relief(pair, 8e-6, 0.6),
        of("lead_crowning", &[("amount", Quantity(12e-6))]),
        of("helix_slope", &[("amount", Quantity(9e-6))]),
        of("end_relief", &ends),
    ]
}

/// Tier: closed form; far from the tips, with two materials in either plane state: the pressure over an ellipse is the load,
/// and b_H²= 4 p ρ Σ(1/E′)/π, written down once more.
#[test]
fn in_the_middle_of_the_path_contacts_are_those_of_hertz() {
    let mut pair = pair();
    pair.gear.specification.material = Material { youngs_modulus: 110e9, poisson_ratio: 0.26, ..Material::STEEL };
    for plane in [Plane::Strain, Plane::Stress] {
        for law in [ContactLaw::Linear, ContactLaw::LoadDependent, ContactLaw::Resolved] {
            let compliance = with(law, plane);
            let cycle = cycle(&pair, &compliance);
            for (s, load) in [(7e-3, 1e5), (9e-3, 3e5), (1.1e-2, 1e3)] {
                let found = cycle.contact(s, load);
                let soft = |modulus: f64, nu: f64| match plane {
                    Plane::Strain => (1.0 - nu * nu) / modulus,
                    Plane::Stress => 1.0 / modulus,
                };
                let radius = s * (pair.tangent_length - s) / pair.tangent_length;
                let half = (4.0 * load * radius * (soft(206e9, 0.3) + soft(110e9, 0.26)) / PI).sqrt();
                // And of both tips B/16 k₀ of the square of b_H over the distance along the flank.
                let near = |radius: f64, base: f64, tip: f64, corner: f64| {
                    let share = half / ((tip * tip - radius * radius) / (2.0 * base));
                    corner / (2.0 / PI * (soft(206e9, 0.3) + soft(110e9, 0.26))) * share * share / 16.0
                };
                let [other, gear_tip] = [s, pair.start_of_contact].map(|s| pair.tangent_length - s);
                let tips = near(s, pair.pinion.base_radius, pair.end_of_contact, compliance.pinion.corner)
                    + near(other, pair.gear.base_radius, gear_tip, compliance.gear.corner);
                let (tips, off) = if law == ContactLaw::Resolved { (tips, 1e-6) } else { (0.0, 1e-14) };
                close(found.half_width, half * (1.0 - tips), off);
                close(found.pressure, 2.0 * load / (PI * half) * (1.0 + tips), off);
                assert!(!found.at_corner && found.load == load);
            }
        }
    }
    assert_eq!(cycle(&pair, &laws()[2]).contact(9e-3, 0.0), LineContact::default());
}

/// Tier: second method; the distance of the tip along the flank is the difference of the involute's arcs, and how far that is
/// in half Hertzian widths says what the wedge does.
#[test]
fn near_a_tip_contacts_are_those_of_its_wedge() {
    let pair = pair();
    let compliance = &laws()[2];
    let cycle = cycle(&pair, compliance);
    let bodies = Bodies::of(&pair, Plane::Strain);
    let wedge = crate::gear::contact::wedge::Wedge::new(compliance.gear.corner / bodies.linear());
    let arc = |rho: f64| rho * rho / (2.0 * pair.gear.base_radius);
    for load in [2e4_f64, 1e5, 4e5] {
        for beyond in [0.0, 3e-5, 1e-4, 2e-4, 5e-4] {
            let s = pair.start_of_contact + beyond;
            let radii = [s, pair.tangent_length - s];
            let radius = radii[0] * radii[1] / (radii[0] + radii[1]);
            let half = bodies.half_width(radius) * load.sqrt();
            let place = (arc(pair.tangent_length - pair.start_of_contact) - arc(radii[1])) / half;
            let (found, spread) = (cycle.contact(s, load), wedge.spread(place));
            // The pinion's own tip, which is a hundred half widths away, adds less than 1e-5.
            close(found.pressure, bodies.pressure(radius, load) * spread.pressure, 1e-5);
            close(found.half_width, half * spread.half_width, 1e-5);
            assert!((found.aside - spread.farther * half).abs() < 3e-3 * half, "{found:?} {spread:?}");
            assert_eq!(found.at_corner, place < 0.85 && spread.reaches);
        }
    }
}

/// Tier: invariant; contacts pass A and E and the place where the contact reaches the corner without a jump, and the gears may
/// be swapped.
#[test]
fn contacts_go_on_without_a_jump() {
    let pair = pair();
    let swapped = swapped(&pair);
    for compliance in laws() {
        let mirrored =
            PairCompliance { pinion: compliance.gear.clone(), gear: compliance.pinion.clone(), ..compliance.clone() };
        let (cycle, other) = (exact(&pair, &compliance, 24), exact(&swapped, &mirrored, 24));
        for end in [pair.start_of_contact, pair.end_of_contact] {
            let mut before: Option<LineContact> = None;
            for step in -1000..=1000 {
                let s = end + 5e-7 * f64::from(step);
                let found = cycle.contact(s, 1.1e5);
                if let Some(before) = before {
                    close(found.pressure, before.pressure, 1e-3);
                    close(found.half_width, before.half_width, 6e-3);
                }
                before = Some(found);
                if step % 50 == 7 {
                    let there = other.contact(pair.tangent_length - s, 1.1e5);
                    close(there.pressure, found.pressure, 1e-12);
                    close(there.half_width, found.half_width, 1e-12);
                    assert!((there.aside + found.aside).abs() < 1e-12, "{found:?} {there:?}");
                    assert_eq!(there.at_corner, found.at_corner);
                }
            }
        }
    }
}

/// Tier: brute force; no position of a fine grid has more than the summary, and one has it but for the grid, at the same place.
#[test]
fn the_largest_pressure_agrees_with_a_brute_grid() {
    let pair = pair();
    for compliance in laws() {
        for corner_contact in [CornerContact::None, CornerContact::Exact] {
            let settings = Settings { corner_contact, ..Settings::default() };
            let cycle = Mesh::new(&pair, &compliance, settings).unwrap();
            for design in faces(&pair).iter().chain([&Design::default()]) {
                let loading = cycle.loaded(design, 80.0);
                let found = loading.summary(PRESSURE).largest_pressure.unwrap();
                let mut largest = (0.0, 0.0, LineContact::default(), 0);
                for zone in &cycle.zones {
                    for step in 0..=1000 {
                        let position = zone.start + (zone.end - zone.start) * f64::from(step) / 1000.0;
                        let state = loading.state(position, zone.pairs);
                        for (spring, contact) in loading.contacts(position, zone.pairs, &state).into_iter().enumerate()
                        {
                            if contact.pressure > largest.0 {
                                let s = cycle.path_position(position, spring);
                                let roll = cycle.rolls(s)[0] + contact.aside / cycle.radii(s)[0];
                                largest = (contact.pressure, roll, contact, spring.cast_signed());
                            }
                        }
                    }
                }
                assert!(largest.0 <= found.extremum.value * (1.0 + 1e-9), "{largest:?} {found:?}");
                close(found.extremum.value, largest.0, 2e-4);
                assert!((found.roll_angle - largest.1).abs() < 5e-3, "{found:?} {largest:?}");
                close(found.contact.half_width, largest.2.half_width, 2e-2);
                assert_eq!(found.ahead + cycle.newest().cast_signed(), largest.3);
                assert_eq!(found.across.is_some(), design.pinion.len() > 1, "{found:?}");
            }
            let none = cycle.loaded(&faces(&pair)[1], 0.0).summary(PRESSURE).largest_pressure.unwrap();
            assert!(none.extremum.value == 0.0 && none.roll_angle.is_nan(), "{none:?}");
        }
    }
}

/// The loads of a step of a map, which are those of the pairs of one mesh position.
fn sums(cells: &[Cell], steps: isize, width: f64) -> Vec<f64> {
    let of = |step: isize| cells.iter().filter(move |cell| cell.step.rem_euclid(steps) == step);
    let strips = cells.iter().map(|cell| cell.strip).max().unwrap() as f64;
    (0..steps).map(|step| of(step).map(|cell| cell.contact.load).sum::<f64>() * width / strips).collect()
}

/// Tier: invariant; loads per width over the strips of all pairs of a position add up to the force: to rounding where a strip has
/// a closed form or is a slice, else to what its points make of the integral. No strip has more than the summary.
#[test]
fn the_loads_of_a_map_add_up_to_the_force() {
    let pair = pair();
    for compliance in laws() {
        for corner_contact in [CornerContact::None, CornerContact::Exact] {
            for slice_coupling in [SliceCoupling::None, SliceCoupling::Plate] {
                let settings = Settings { corner_contact, slice_coupling, ..Settings::default() };
                let cycle = Mesh::new(&pair, &compliance, settings).unwrap();
                for (face, design) in faces(&pair).iter().enumerate() {
                    for torque in [5.0, 300.0] {
                        let loading = cycle.loaded(design, torque);
                        let cells = loading.map(6, 17);
                        let rounding = face == 0
                            || slice_coupling == SliceCoupling::Plate
                            || (face < 3 && compliance.contact == Some(ContactLaw::Linear));
                        let mut worst = 0.0_f64;
                        for sum in sums(&cells, 6, cycle.face_width) {
                            worst = worst.max((sum / loading.force() - 1.0).abs());
                        }
                        println!(
                            "{:?} {corner_contact:?} {slice_coupling:?} {face} {torque}: {worst:e}",
                            compliance.contact
                        );
                        assert!(worst < if rounding { 1e-12 } else { 1e-2 }, "{worst:e}");
                        let most = loading.summary(PRESSURE).largest_pressure.unwrap().extremum.value;
                        let largest = cells.iter().map(|cell| cell.contact.pressure).fold(0.0, f64::max);
                        assert!(largest <= most * (1.0 + 1e-9), "{largest} {most}");
                        assert!(cells.iter().all(|cell| cell.contact.load >= 0.0));
                        assert_eq!(cells.iter().any(|cell| cell.strip > 1), face > 0);
                    }
                }
            }
        }
    }
}

/// Tier: brute force; the load is largest where the sum of the leads is smallest, at the smallest of such z, and slices that hold
/// each other have it in the middle of that slice. The map of an even face is even, and falls away from a crown.
#[test]
fn the_most_loaded_place_is_where_flanks_stand_highest() {
    let pair = pair();
    for slice_coupling in [SliceCoupling::None, SliceCoupling::Plate] {
        let settings = Settings { slice_coupling, ..Settings::default() };
        let cycle = Mesh::new(&pair, &laws()[2], settings).unwrap();
        for (face, design) in faces(&pair).iter().enumerate().skip(1) {
            let loading = cycle.loaded(design, 80.0);
            let place = |index: i32| cycle.face_width * (f64::from(index) / 3600.0 - 0.5);
            let lead = |index: i32| design.lead(place(index));
            let lowest = (0..=3600).map(lead).fold(f64::INFINITY, f64::min);
            let exact = place((0..=3600).find(|index| lead(*index) <= lowest + 1e-18).unwrap());
            let found = loading.summary(PRESSURE).largest_pressure.unwrap().across.unwrap();
            match slice_coupling {
                SliceCoupling::None => assert!((found - exact).abs() < 1e-12, "{face}: {found} for {exact}"),
                // Slices that others hold from one side only carry more: those where the relief begins, 4 mm from the middle.
                SliceCoupling::Plate if face < 3 => {
                    assert!((found - exact).abs() < 0.51 * cycle.face_width / 17.0, "{face}: {found} for {exact}");
                }
                SliceCoupling::Plate => assert!((found + 4e-3).abs() < 1.5e-3, "{face}: {found}"),
            }
            let cells = loading.map(3, 17);
            for row in cells.chunks(17).filter(|_| face != 2) {
                for (strip, cell) in row.iter().enumerate() {
                    close(row[16 - strip].contact.load, cell.contact.load, 1e-9);
                    let falls = strip < 8 || strip == 16 || row[strip + 1].contact.load <= cell.contact.load;
                    assert!(falls || face != 1, "{row:?}");
                }
            }
        }
    }
}

/// Tier: order of convergence; the strip where a crown is highest misses of the largest load what a parabola does, the end of
/// a tilted face what a slope does.
#[test]
fn maps_converge_with_their_strips() {
    let pair = pair();
    let cycle = cycle(&pair, &laws()[2]);
    let [_, crowned, tilted, _] = faces(&pair);
    for (design, order) in [(crowned, 2.0), (tilted, 1.0)] {
        let loading = cycle.loaded(&design, 80.0);
        let at = |strips: usize| {
            let largest = |of: &dyn Fn(&Cell) -> bool| {
                loading.map(4, strips).iter().filter(|cell| of(cell)).map(|cell| cell.contact.load).fold(0.0, f64::max)
            };
            largest(&|cell| cell.step == 2)
        };
        let position = cycle.period() * 0.5;
        let state = loading.state(position, cycle.pairs_behind(position));
        let exact = loading.line_load(position, &state, 0);
        let off = [9, 27, 81].map(|strips| 1.0 - at(strips) / exact);
        for two in off.windows(2) {
            let found = libm::log(two[0] / two[1]) / libm::log(3.0);
            assert!((found - order).abs() < 0.1, "{found}: {off:?}");
        }
    }
}

/// Unmodified, the contact reaches the corners of both tips at A and E, whatever the load; a relief that takes the load away
/// keeps it from them. Other laws know of the corners only that they touch.
#[test]
fn corners_that_touch_are_told() {
    let pair = pair();
    let tip = |amount: f64| {
        let values = [("amount", Quantity(amount)), ("length", Quantity(5e-3)), ("curve", Choice("parabolic"))];
        design(&pair, &[("tip_relief", "both", &values)]).unwrap()
    };
    for compliance in laws() {
        let resolved = compliance.contact == Some(ContactLaw::Resolved);
        for corner_contact in [CornerContact::None, CornerContact::Exact] {
            let settings = Settings { corner_contact, ..Settings::default() };
            let cycle = Mesh::new(&pair, &compliance, settings).unwrap();
            let told = |design: &Design, torque: f64| {
                let loading = cycle.loaded(design, torque);
                loading.corner_stretches(&loading.curve(PRESSURE))
            };
            for torque in [5.0, 60.0, 300.0] {
                let Some(found) = told(&Design::default(), torque) else {
                    assert!(!resolved && corner_contact == CornerContact::None);
                    continue;
                };
                assert!(resolved || corner_contact == CornerContact::Exact);
                assert!(found.share > 0.01 && found.share < 0.6, "{found:?}");
                let ends = [0.0, pair.end_of_contact - pair.start_of_contact - cycle.period()];
                if resolved {
                    for end in ends {
                        let here = |[from, to]: &[f64; 2]| *from <= end + 1e-12 && end - 1e-12 <= *to;
                        assert!(found.stretches.iter().any(here), "{end}: {found:?}");
                    }
                }
                // The ends of stretches are those of what a fine grid has.
                let design = Design::default();
                let loading = cycle.loaded(&design, torque);
                for zone in &cycle.zones {
                    for step in 0..=500 {
                        let position = zone.start + (zone.end - zone.start) * f64::from(step) / 500.0;
                        let contacts = loading.contacts(position, zone.pairs, &loading.state(position, zone.pairs));
                        let inside = |by: f64| {
                            found.stretches.iter().any(|[from, to]| position >= from - by && position <= to + by)
                        };
                        let touches = contacts.iter().any(|contact| contact.at_corner);
                        assert!(if touches { inside(1e-7) } else { !inside(-1e-7) }, "{position}: {found:?}");
                    }
                }
                let long: f64 = found.stretches.iter().map(|[from, to]| to - from).sum();
                assert!(long < 0.3 * cycle.period(), "{found:?}");
            }
            assert_eq!(told(&tip(40e-6), 60.0), None);
        }
    }
}
