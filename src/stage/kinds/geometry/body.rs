//! The table `body`: what a gear weighs and how it resists being turned faster.
//!
//! Solid from the bore to the profile, as wide as the face. Must not know: how a section is measured.

use super::drawn::{Drawn, of_gear};
use gearmesh::gear::geometry::Side;
use gearmesh::gear::geometry::outline::section::Section;
use studygraph::table::columns::Columns;

/// A gear's section without its bore.
pub struct BodyRow {
    side: Side,
    section: Section,
    face_width: f64,
    density: f64,
}

impl BodyRow {
    #[must_use]
    pub fn new(drawn: &Drawn) -> Self {
        let own = &drawn.gear.specification;
        let section = drawn.outline.section().without(Section::disc(own.bore_radius));
        Self { side: drawn.side, section, face_width: own.face_width, density: own.material.density }
    }

    fn volume(&self) -> f64 {
        self.section.area * self.face_width
    }
}

#[must_use]
pub fn columns() -> Columns<BodyRow> {
    let description =
        "Mass and moment of inertia of each gear, solid from its bore to its profile and as wide as its face.";
    let moment = "Moment of inertia J about the gear's axis.";
    of_gear(Columns::new("body", description), |row: &BodyRow| row.side)
        .float("section_area", "mm^2", "Area of the section square to the axis.", |row| row.section.area)
        .float("volume", "cm^3", "Volume V.", BodyRow::volume)
        .float("density", "kg/m^3", "Density ρ of its material.", |row| row.density)
        .float("mass", "kg", "Mass m = ρ V.", |row| row.density * row.volume())
        .float("moment_of_inertia", "kg mm^2", moment, |row| row.density * row.face_width * row.section.polar_moment)
        .on_demand()
}
