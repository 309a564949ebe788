//! What several kinds declare and read alike: how teeth deflect, and how a mesh cycle is sampled and loaded.
//!
//! A field that is added to one of these tables is a field of every kind that has it. Must not know: what any kind computes.

use crate::stage::{Inputs, Omission, Port, Saved, compliance as codec, pair};
use declare::declared::Words;
use declare::error::{Diagnostic, Failure};
use declare::parameter::{Field, Shape};
use declare::record::Record;
use gearmesh::gear::compliance::{self, Assumptions, ContactLaw, Method};
use gearmesh::gear::contact::{CornerContact, MOST_COUPLED_SLICES, SliceCoupling};
use gearmesh::gear::geometry::GearPair;
use gearmesh::gear::geometry::root::RootShape;
use gearmesh::gear::transmission_error::cycle::{MeshCycle, Settings};
use gearmesh::gear::transmission_error::trace::NODES;
use gearmesh::gear::work::CONTACT_SOLVES;

/// How the teeth of a pair deflect; read by [`teeth`].
pub const TEETH: &[Field] = &[
    Field::new("method", Shape::Member(compliance::members), "How the compliance of a tooth is found.")
        .default("energy"),
    Field::choice("root", RootShape::CHOICES, "The shape of the tooth below its involute.").default("trochoid"),
    Field::choice("contact", ContactLaw::CHOICES, "How the flanks flatten against each other.").default("linear"),
];

/// How teeth deflect: a method, what it is called, and what it is to assume but for what is each kind's own.
pub struct Teeth {
    pub name: &'static str,
    pub method: Box<dyn Method>,
    pub assumptions: Assumptions,
}

/// What [`TEETH`] says.
///
/// # Errors
/// When the choices exclude each other.
pub fn teeth(record: &Record) -> Result<Teeth, Diagnostic> {
    let (name, options) = record.member("method");
    let method = compliance::read(name, options)?;
    let (root, contact): (RootShape, ContactLaw) = (record.word("root"), record.word("contact"));
    if method.whole_pair() && contact != ContactLaw::Linear {
        return Err(Diagnostic::new(format!(
            "`contact: {}` is not for the method `{name}`: its stiffness is that of a pair with its contact",
            contact.word()
        ))
        .at(record.place_of("contact"))
        .help("leave `contact` out, or take a method of single teeth"));
    }
    if method.needs_fillet() && root == RootShape::BaseCircle {
        return Err(Diagnostic::new(format!(
            "`root: {}` is not for the method `{name}`: it meets the body in a sharp corner, where no stress is finite",
            root.word()
        ))
        .at(record.place_of("root"))
        .help("take a root with a fillet, `trochoid` or `circular_fillet`"));
    }
    let coupled = record.choice("coupling") == "body";
    let assumptions = Assumptions { root, contact, coupled, torque: None, accuracy: None };
    Ok(Teeth { name, method, assumptions })
}

pub const STIFFNESS: Field = Field::reference("stiffness", &["stiffness"], "The pair's compliances.");

/// At most `maximum`.
pub const fn positions(maximum: i64) -> Field {
    let summary = "Positions per base pitch; zone ends, relief starts, first touches and extrema come on top.";
    Field::integer("positions", 8, maximum, summary).default("64")
}

pub const SLICES: Field = Field::integer(
    "slices",
    1,
    10_000,
    "Slices on each smooth stretch of the face where no closed form exists; with `slice_coupling`, equal ones on the \
     whole face, 200 at most.",
)
.default("17");

/// Where flanks touch and what holds them.
pub const CONTACT: &[Field] = &[
    Field::choice(
        "corner_contact",
        CornerContact::CHOICES,
        "Where flanks can touch: on the line of action, or also off it.",
    )
    .default("none"),
    Field::choice("slice_coupling", SliceCoupling::CHOICES, "Whether slices across the face hold each other.")
        .default("none"),
];

/// What [`positions`], [`SLICES`] and [`CONTACT`] say.
///
/// # Errors
/// With more slices than can hold each other.
pub fn settings(record: &Record) -> Result<Settings, Diagnostic> {
    let settings = Settings {
        positions: whole(record, "positions"),
        slices: whole(record, "slices"),
        corner_contact: record.word("corner_contact"),
        slice_coupling: record.word("slice_coupling"),
    };
    let slices = settings.slices;
    if settings.slice_coupling == SliceCoupling::Plate && slices > MOST_COUPLED_SLICES {
        return Err(Diagnostic::new(format!(
            "`slices` is {slices}, but with `slice_coupling: plate` it must be 1 to {MOST_COUPLED_SLICES}"
        ))
        .at(record.place_of("slices")));
    }
    Ok(settings)
}

/// A whole number that is declared not to be negative.
pub fn whole(record: &Record, name: &str) -> usize {
    usize::try_from(record.integer(name)).unwrap_or(0)
}

/// The ports through which [`mesh_cycle`] reads.
pub fn mesh_cycle_ports(stiffness: &str) -> Vec<Port> {
    vec![
        Port::tables("pair", stiffness, &["gears", "pair"]).through("pair"),
        Port::tables("stiffness", stiffness, &["compliance", "neighbours", "model"]),
    ]
}

/// The pair and its mesh cycle.
///
/// # Errors
/// When a table is not what its schema says, or the pair cannot be loaded.
pub fn mesh_cycle(inputs: &Inputs, settings: Settings) -> Result<(GearPair, MeshCycle), Failure> {
    let pair = pair::read(inputs.table("pair", "gears")?, inputs.table("pair", "pair")?)?;
    let read = |table| inputs.table("stiffness", table);
    let compliance = codec::read(read("compliance")?, read("neighbours")?, read("model")?)?;
    let cycle = MeshCycle::new(&pair, &compliance, settings)?;
    Ok((pair, cycle))
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
