//! What the tables of a stage of the kind `ste` are made of: a curve under its key, its points, and what was found of both.
//!
//! Must not know: how anything is found.

use crate::stage::cases::{DEVIATIONS, Deviation};
use crate::stage::neglected_corners::Estimated;
use gearmesh::gear::mesh::Settings;
use gearmesh::gear::mesh::answers::contact_law_error::ContactLawError;
use gearmesh::gear::mesh::answers::corner_stretches::CornerStretches;
use gearmesh::gear::mesh::answers::curve::{Point, Summary};
use gearmesh::gear::mesh::answers::friction::Loss;
use gearmesh::gear::mesh::answers::pressure::LineContact;
use studygraph::table::columns::Columns;

/// Pairs that a position may have: with corner contact there is one before A.
pub const PAIRS: usize = 7;

/// Torque, and by how much the pair is off as it is made and mounted.
#[derive(Clone, Copy)]
pub struct Load {
    /// On the pinion \[N m\].
    pub torque: f64,
    pub deviation: Deviation,
}

/// Design, load, and what they gave.
pub type Keyed<'a, T = Answer> = (&'a str, Load, T);

/// The columns that say which curve a row is of; those of deviations are there where they are stated.
pub fn keyed<'a, T>(name: &str, description: &str, stated: &[usize]) -> Columns<Keyed<'a, T>> {
    let columns = Columns::new(name, description)
        .text("design", "Name of the design.", |row: &Keyed<'a, T>| row.0)
        .key()
        .float("torque", "N m", "Torque on the pinion.", |row| row.1.torque)
        .key();
    stated.iter().fold(columns, |columns, &field| {
        let (name, description) = DEVIATIONS[field];
        columns.float(name, "um", description, move |row| row.1.deviation.of_fields[field]).key()
    })
}

/// One design under one torque; its points are in the table `curve`.
pub struct Answer {
    pub summary: Summary,
    pub settings: Settings,
    pub error: f64,
    pub seconds: f64,
    /// Where sharp corners are in contact, if pressures were asked for.
    pub cornered: Option<CornerStretches>,
    /// Error estimate of the contact law.
    pub doubt: Option<ContactLawError>,
    /// Tip corners that `corner_contact: none` leaves out, where a warning is heard.
    pub left_out: Option<Estimated>,
    /// What friction takes, if that was asked for.
    pub lost: Option<Lost>,
    /// Nominal root stress by ISO 6336-3 \[Pa\], where it was asked for and holds.
    pub iso6336: [f64; 2],
}

/// What a curve loses.
pub struct Lost {
    pub loss: Loss,
    /// Of halves of the load.
    pub geometric: f64,
}

/// What is lost at a position \[W\], and what the gear is left with \[N m\].
pub type Left = [f64; 2];

/// The contacts of all pairs of a position, from the one before A on.
pub type Contacts = [LineContact; PAIRS];

/// A point of a curve.
#[derive(Clone, Copy)]
pub struct OfCurve<'a> {
    /// Which it is, from 1.
    pub number: usize,
    pub point: &'a Point,
    /// Of its pairs, where somebody wants them.
    pub contacts: Option<&'a Contacts>,
    /// By friction, where somebody wants it.
    pub left: Option<Left>,
}

pub type PointRow<'a> = Keyed<'a, OfCurve<'a>>;

/// The points of a curve, and of each the contacts of its pairs and what friction leaves, or none.
pub struct Found {
    pub points: Vec<Point>,
    pub contacts: Vec<Contacts>,
    pub left: Vec<Left>,
}
