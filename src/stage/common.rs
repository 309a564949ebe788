//! What several kinds declare and read alike: how teeth deflect, and how a mesh cycle is sampled and loaded.
//!
//! A field that is added to one of these structs is a field of every kind that has it. Must not know: what any kind
//! computes.

use std::sync::Arc;

use crate::stage::{Inputs, Omission, Port, Saved, compliance as codec, names, pair};
use declare::Declared;
use declare::declared::Words;
use declare::error::{Diagnostic, Failure};
use declare::record::Record;
use gearmesh::gear::compliance::{Assumptions, ContactLaw, Method, PairCompliance};
use gearmesh::gear::contact::{CornerContact, MOST_COUPLED_SLICES, SliceCoupling};
use gearmesh::gear::geometry::GearPair;
use gearmesh::gear::geometry::root::RootShape;
use gearmesh::gear::mesh::trace::NODES;
use gearmesh::gear::mesh::{Mesh, MeshError, Settings};
use gearmesh::gear::work::CONTACT_SOLVES;

/// How the teeth of a pair deflect.
#[derive(Debug, Declared)]
pub struct Teeth {
    /// How the compliance of a tooth is found.
    #[declared(default = "energy")]
    pub method: Box<dyn Method>,
    /// The shape of the tooth below its involute.
    #[declared(default = "trochoid")]
    pub root: RootShape,
    /// How the flanks flatten against each other: with finite elements `resolved` unless said otherwise, with other methods
    /// `linear`.
    pub contact: Option<ContactLaw>,
}

impl Teeth {
    /// Refuses choices that exclude each other.
    ///
    /// # Errors
    /// Which of them, with its place in `record`.
    pub fn check(&self, record: &Record) -> Result<(), Diagnostic> {
        let Self { method, root, .. } = self;
        let contact = self.contact();
        if !method.knows(contact) {
            let (reason, help) = if method.whole_pair() {
                (
                    "its stiffness is that of a pair with its contact",
                    "leave `contact` out, or take a method of single teeth",
                )
            } else {
                (
                    "it does not know how a tooth yields at its surface",
                    "take `load_dependent`, or `method: finite_element`",
                )
            };
            return Err(Diagnostic::new(format!(
                "`contact: {}` is not for the method `{}`: {reason}",
                contact.word(),
                method.name()
            ))
            .at(record.place_of(Self::NAMES.contact))
            .help(help));
        }
        if method.needs_fillet() && *root == RootShape::BaseCircle {
            return Err(Diagnostic::new(format!(
                "`root: {}` is not for the method `{}`: it meets the body in a sharp corner, where no stress is finite",
                root.word(),
                method.name()
            ))
            .at(record.place_of(Self::NAMES.root))
            .help("take a root with a fillet, `trochoid` or `circular_fillet`"));
        }
        Ok(())
    }

    /// The contact law: what was said, or what goes with the method.
    pub fn contact(&self) -> ContactLaw {
        self.contact.unwrap_or_else(|| self.method.usual_contact())
    }

    /// What the method is to assume, but for what is each kind's own.
    pub fn assumptions(&self, coupled: bool) -> Assumptions {
        Assumptions { root: self.root, contact: self.contact(), coupled, torque: None, accuracy: None }
    }
}

/// How finely the face is divided.
#[derive(Clone, Copy, Debug, Declared)]
pub struct Slices {
    /// Slices on each smooth stretch of the face where no closed form exists; with `slice_coupling`, equal ones on the
    /// whole face, 200 at most.
    #[declared(minimum = 1, maximum = 10_000, default = "17")]
    pub slices: usize,
}

/// Where flanks touch and what holds them.
#[derive(Clone, Copy, Debug, Declared)]
pub struct Contact {
    /// Whether tip corners can touch before A and after E.
    #[declared(default = "none")]
    pub corner_contact: CornerContact,
    /// Whether slices across the face hold each other.
    #[declared(default = "none")]
    pub slice_coupling: SliceCoupling,
}

/// How a mesh cycle is sampled and loaded.
pub fn settings(positions: usize, Slices { slices }: Slices, contact: Contact) -> Settings {
    let Contact { corner_contact, slice_coupling } = contact;
    Settings { positions, slices, corner_contact, slice_coupling }
}

/// Refuses more slices than can hold each other.
///
/// # Errors
/// How many can, with the place in `record`.
pub fn check_slices(settings: Settings, record: &Record) -> Result<(), Diagnostic> {
    let slices = settings.slices;
    if settings.slice_coupling == SliceCoupling::Plate && slices > MOST_COUPLED_SLICES {
        return Err(Diagnostic::new(format!(
            "`slices` is {slices}, but with `slice_coupling: plate` it must be 1 to {MOST_COUPLED_SLICES}"
        ))
        .at(record.place_of(Slices::NAMES.slices)));
    }
    Ok(())
}

/// The ports through which [`mesh_cycle`] reads.
pub fn mesh_cycle_ports(stiffness: &str) -> Vec<Port> {
    vec![pair::port(stiffness).through(names::PAIR_PORT), codec::port(stiffness)]
}

/// The pair and its mesh cycle.
///
/// # Errors
/// When a table is not what its schema says, or the pair cannot be loaded.
pub fn mesh_cycle(inputs: &Inputs, settings: Settings) -> Result<(GearPair, Mesh), Failure> {
    let cycle = shared_mesh_cycle(inputs, settings)?;
    Ok((cycle.pair.clone(), cycle.counted_separately()))
}

/// The same cycle, whose work is counted for all parts of a stage together.
///
/// # Errors
/// As [`mesh_cycle`].
pub fn shared_mesh_cycle(inputs: &Inputs, settings: Settings) -> Result<Arc<Mesh>, Failure> {
    // The pair behind a stage of compliances is always the same, so both are kept with its table.
    let derived = codec::table(inputs)?.derived();
    let read = derived
        .get(|_: &(GearPair, PairCompliance)| true, || Ok::<_, Failure>((pair::of(inputs)?, codec::of(inputs)?)))?;
    derived.get(|cycle: &Mesh| cycle.settings == settings, || Mesh::new(&read.0, &read.1, settings).map_err(no_mesh))
}

/// The failure of a stage whose pair has no mesh.
#[must_use]
#[allow(clippy::needless_pass_by_value)] // as `map_err` gives it
pub fn no_mesh(wrong: MeshError) -> Failure {
    Failure::new(wrong.to_string())
}

/// That the pair cannot be loaded so, where its tables are there.
///
/// # Errors
/// As [`mesh_cycle`].
pub fn refused_cycle(inputs: &Inputs, stiffness: &str, settings: Settings) -> Result<(), Failure> {
    let is_there = |port: &Port| inputs.ports.contains_key(&port.name);
    if mesh_cycle_ports(stiffness).iter().all(is_there) { mesh_cycle(inputs, settings).map(drop) } else { Ok(()) }
}

/// About how many rows the curve of one design under one torque has.
///
/// Spans hold as many positions as were asked for, or are as many as there are harmonics; those at zone ends, reliefs and
/// first touches come on top, and where pairs take up load.
#[must_use]
pub fn curve_rows(settings: Settings, harmonics: usize) -> usize {
    (NODES - 1) * (settings.positions.div_ceil(NODES - 1).max(harmonics) + 12)
}

/// How many times as long as usual a solve takes with these settings.
#[must_use]
pub fn solve_times(settings: Settings) -> f64 {
    match (settings.slice_coupling, settings.corner_contact) {
        // Slices that hold each other are one system of equations.
        (SliceCoupling::Plate, _) => (settings.slices * settings.slices) as f64,
        (SliceCoupling::None, CornerContact::None) => 1.0,
        (SliceCoupling::None, _) => CORNER_SOLVES,
    }
}

/// Time of a solve with corner contact over that of one without.
const CORNER_SOLVES: f64 = 8.0;

/// What the settings leave out.
pub fn corner_contact_left_out(settings: Settings) -> Option<Omission> {
    let none = settings.corner_contact == CornerContact::None;
    let saved = Saved::For { done: &CONTACT_SOLVES, saved: &CONTACT_SOLVES, times: CORNER_SOLVES - 1.0 };
    let omission = Omission::new("corner contact", "`corner_contact` is `none`: flanks touch from A to E only");
    none.then(|| omission.saving(Some(saved)))
}
