//! Load per width and pressure over path and face: what is drawn as a map.
//!
//! The face is cut into equal strips, the base pitch into equal steps, so that the pairs of one mesh position are whole pitches
//! apart in the map. A load is the mean over its strip, so that loads times widths add up to the force. Must not know: tables.

use super::pressure::{LineContact, mean_load};
use crate::gear::contact::face::Face;
use crate::gear::mesh::equilibrium::flanks::{Flanks, equal_strips};
use crate::gear::mesh::equilibrium::load_case::LoadCase;

/// A strip of the face of a pair at a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Steps from A; below 0 before it.
    pub step: isize,
    /// From 1, in the order of z.
    pub strip: usize,
    /// From A along the line of action \[m\].
    pub path_position: f64,
    /// The pinion's roll angle where the flanks touch \[rad\].
    pub roll_angle: f64,
    /// z of the middle of the strip \[m\].
    pub z: f64,
    /// Under the mean load of the strip.
    pub contact: LineContact,
}

/// What the strips of a face stand back.
enum Across<'a> {
    /// Nothing: one strip is as wide as the face.
    Flat,
    /// The same at every position.
    Leads(Vec<Face<'a>>),
    /// At each position something else.
    Surface(Box<Flanks<'a>>),
    /// Slices hold each other, and are the strips.
    Slices,
}

/// The map with so many steps in a base pitch and so many strips of the face: one where flanks run parallel, and all
/// slices where they hold each other. Pairs from A to E, and those before A and after E that carry load.
#[must_use]
pub(in crate::gear::mesh) fn face_map(case: &LoadCase, steps: usize, strips: usize) -> Vec<Cell> {
    let cycle = case.cycle;
    let across = across(case, strips);
    let count = match &across {
        Across::Flat => 1,
        Across::Slices => cycle.settings.slices.max(1),
        Across::Leads(_) | Across::Surface(_) => strips,
    };
    let middles: Vec<f64> = equal_strips(cycle.face_width, count).iter().map(|[from, to]| 0.5 * (from + to)).collect();
    let mut cells = Vec::new();
    for step in 0..steps {
        let position = cycle.period() * step as f64 / steps as f64;
        let pairs = cycle.pairs_behind(position);
        for (spring, loads) in loads_across(case, position, pairs, &across, count).into_iter().enumerate() {
            let ahead = spring.cast_signed() - cycle.newest().cast_signed();
            let inside = (0..pairs.cast_signed()).contains(&ahead);
            if !inside && loads.iter().all(|load| *load <= 0.0) {
                continue;
            }
            let s = cycle.path_position(position, spring);
            cells.extend((1..).zip(&middles).zip(loads).map(|((strip, z), load)| Cell {
                step: step.cast_signed() + ahead * steps.cast_signed(),
                strip,
                path_position: s - cycle.pair.start_of_contact,
                roll_angle: cycle.rolls(s)[0],
                z: *z,
                contact: cycle.contact(s, load),
            }));
        }
    }
    cells.sort_by_key(|cell| (cell.step, cell.strip));
    cells
}

fn across<'c>(case: &'c LoadCase, strips: usize) -> Across<'c> {
    if case.flanks.is_flat() {
        return Across::Flat;
    }
    if case.cycle.across.is_some() {
        return Across::Slices;
    }
    let strips = equal_strips(case.cycle.face_width, strips);
    if case.flanks.is_surface {
        return Across::Surface(Box::new(case.flanks.cut_into(case.design, &strips)));
    }
    Across::Leads(strips.iter().map(|ends| Face::between(case.design, *ends, &case.cycle.slices)).collect())
}

/// The mean load per width \[N/m\] of each strip, pair by pair.
fn loads_across(case: &LoadCase, position: f64, pairs: usize, across: &Across, count: usize) -> Vec<Vec<f64>> {
    let cycle = case.cycle;
    let mut found = vec![vec![0.0; count]; cycle.springs(pairs)];
    if let Across::Slices = across {
        for (spring, loads) in case.loads_of_slices(position, pairs).unwrap_or_default() {
            found[spring] = loads;
        }
        return found;
    }
    let state = case.state(position, pairs);
    for (spring, loads) in found.iter_mut().enumerate().filter(|(spring, _)| state.balance.loads[*spring] > 0.0) {
        let (s, penetration) = (cycle.path_position(position, spring), state.balance.penetration[spring]);
        let of_face = |face: &Face, lowest: f64| mean_load(case, s, face, penetration - (face.offset - lowest));
        match across {
            Across::Leads(faces) => {
                let lowest = case.flanks.face.offset;
                *loads = faces.iter().map(|face| of_face(face, lowest)).collect();
            }
            Across::Surface(flanks) => {
                let lowest = case.flanks.gap(s).unwrap_or(0.0);
                *loads = flanks.strips_at(s, count).map(|face| of_face(&face, lowest)).collect();
            }
            Across::Flat | Across::Slices => loads.fill(state.balance.loads[spring] / cycle.face_width),
        }
    }
    found
}
