//! Compliances as tables: what the stiffness stage writes and every stage that loads teeth reads back.
//!
//! Values stand at Chebyshev nodes of the roll angle, so the series that comes back is the one that was written, to the
//! last few bits. Must not know: which method made them.

use super::names;
use super::pair::si;
use crate::stage::{Inputs, Port};
use declare::declared::Words;
use declare::error::Failure;
use gearmesh::gear::compliance::inclined::Inclined;
use gearmesh::gear::compliance::{ContactLaw, PairCompliance, ToothCompliance};
use gearmesh::gear::material::Plane;
use gearmesh::numeric::chebyshev::{Series, nodes};
use gearmesh::numeric::surface::Surface;
use studygraph::table::columns::Columns;
use studygraph::table::data::{Table, TableError};
use studygraph::table::schema::Schema;

type Getter = fn(&ToothCompliance) -> &Series;
type InclinedGetter = fn(&Inclined) -> f64;

/// Column and meaning of each series of a tooth.
const SERIES: &[(&str, &str, &str, Getter)] = &[
    ("bending", "nm/N", "Bending of the tooth, 1/k_b.", |tooth| &tooth.bending),
    ("shear", "nm/N", "Shear of the tooth, 1/k_s.", |tooth| &tooth.shear),
    ("axial", "nm/N", "Axial compression of the tooth, 1/k_a.", |tooth| &tooth.axial),
    ("body", "nm/N", "Gear body under the tooth's own load, 1/k_f.", |tooth| &tooth.body),
    (
        "contact_depth",
        "mm",
        "Depth of the contact law: to the tooth's centreline along the load line; of resolved contact a constant.",
        |tooth| &tooth.contact_depth,
    ),
];

/// Column and meaning of what loads do at the corner of the tip that are turned from the flank's normal towards the root.
const INCLINED: &[(&str, &str, &str, InclinedGetter)] = &[
    (
        "tip_across",
        "nm/N",
        "Of resolved contact: displacement of the tip's corner along the flank, towards the root, per load normal to it, \
         and the reverse; without the part of B.",
        |inclined| inclined.own[0],
    ),
    (
        "tip_along",
        "nm/N",
        "The corner's displacement along the flank under a load along it, less that along the normal under one normal to it; \
         without the part of B.",
        |inclined| inclined.own[1],
    ),
    (
        "corner_across",
        "nm mm/N",
        "B of a load normal to the flank for displacements along it, and the reverse.",
        |inclined| inclined.corner[0],
    ),
    ("corner_along", "nm mm/N", "B of a load along the flank, less that of one normal to it.", |inclined| {
        inclined.corner[1]
    }),
];

const AT_TIP: &str = "further_tip";

/// Instead of a contact law, where the compliances of the teeth include the contact.
const INCLUDED: &str = "included";

/// A tooth at one of its nodes.
struct NodeRow<'a> {
    gear: &'static str,
    /// From 1.
    node: usize,
    roll: f64,
    radius: f64,
    tooth: &'a ToothCompliance,
}

fn teeth<'a>() -> Columns<NodeRow<'a>> {
    let description = "Compliance of one tooth of each gear over its whole face width, along its active flank.";
    let columns = Columns::new(names::compliance::TABLE, description)
        .text(names::compliance::GEAR, "Which gear: pinion or gear.", |row: &NodeRow| row.gear)
        .key()
        .integer("node", "Chebyshev node, from 1 at the root side.", |row| row.node)
        .key()
        .float(names::compliance::ROLL_ANGLE, "rad", "Roll angle of the loaded point.", |row| row.roll)
        .float("radius", "mm", "Radius of the loaded point.", |row| row.radius);
    let corner = "B of resolved contact: −B ln(c/m) is added to the rest, c the distance to the tip's corner, or to the one that a rounding takes away, B per width.";
    let columns = SERIES.iter().fold(columns, |columns, &(name, unit, description, series)| {
        columns.float(name, unit, description, move |row| series(row.tooth).value(row.roll))
    });
    INCLINED.iter().fold(
        columns.float(names::compliance::CORNER, "nm mm/N", corner, |row| row.tooth.corner),
        |columns, &(name, unit, description, value)| {
            columns.float(name, unit, description, move |row| row.tooth.inclined.as_ref().map_or(0.0, value))
        },
    )
}

/// Two nodes of two teeth of a gear, the first tooth's before the further one's.
struct NeighbourRow {
    gear: &'static str,
    /// How many pitches they are apart.
    neighbour: usize,
    /// From 1.
    nodes: [usize; 2],
    rolls: [f64; 2],
    compliance: f64,
    at_tip: f64,
}

fn neighbours() -> Columns<NeighbourRow> {
    let further_roll = "Roll angle on the further tooth, where roll angles grow.";
    let compliance = "Deflection along the load line of one per load on the other; symmetric.";
    let at_tip = "Of resolved contact: deflection of the first tooth per load along the flank, towards the root, at the corner of \
                  the further tooth's tip.";
    Columns::new(names::neighbours::TABLE, "Deflection of a tooth per load on a neighbour, through the gear body.")
        .text(names::neighbours::GEAR, "Which gear: pinion or gear.", |row: &NeighbourRow| row.gear)
        .key()
        .integer(names::neighbours::NEIGHBOUR, "How many pitches apart the two teeth are.", |row| row.neighbour)
        .key()
        .integer(names::neighbours::NODE, "Chebyshev node of the first tooth, from 1.", |row| row.nodes[0])
        .key()
        .integer("further_node", "Chebyshev node of the further tooth, from 1.", |row| row.nodes[1])
        .key()
        .float(names::neighbours::ROLL_ANGLE, "rad", "Roll angle of the loaded point of the first tooth.", |row| {
            row.rolls[0]
        })
        .float(names::neighbours::FURTHER_ROLL_ANGLE, "rad", further_roll, |row| row.rolls[1])
        .float(names::neighbours::COMPLIANCE, "nm/N", compliance, |row| row.compliance)
        .float(AT_TIP, "nm/N", at_tip, |row| row.at_tip)
}

/// What compliances were made with.
struct ModelRow<'a> {
    compliance: &'a PairCompliance,
    method: &'a str,
    root: &'a str,
}

fn model<'a>() -> Columns<ModelRow<'a>> {
    let contact = "Contact law: linear, load_dependent, or included in the teeth.";
    Columns::new(names::model::TABLE, "What the compliances were made with, and how contact is to be added.")
        .text("method", "Method of the tooth compliance.", |row: &ModelRow<'a>| row.method)
        .text("root", "Root curve of the teeth; none where the method asks for none.", |row| row.root)
        .text(names::model::CONTACT, contact, |row| row.compliance.contact.map_or(INCLUDED, ContactLaw::word))
        .text(names::model::PLANE, "Plane state of the flanks in contact: strain or stress.", |row| {
            row.compliance.plane.word()
        })
        .text(names::model::COUPLING, "Whether loaded neighbours share the gear body: none or body.", |row| {
            if row.compliance.coupled { "body" } else { "none" }
        })
}

/// Those of the tables that [`write()`] makes.
#[must_use]
pub fn schemas() -> [Schema; 3] {
    [teeth().schema(), neighbours().schema(), model().schema()]
}

/// The three tables of a pair's compliances.
///
/// # Errors
/// When a compliance is not finite.
pub fn write(
    compliance: &PairCompliance,
    base_radii: [f64; 2],
    method: &str,
    root: &str,
) -> Result<[Table; 3], TableError> {
    let mut of_teeth = Vec::new();
    let mut of_neighbours = Vec::new();
    for ((gear, tooth), base_radius) in
        [("pinion", &compliance.pinion), ("gear", &compliance.gear)].into_iter().zip(base_radii)
    {
        let rolls = common_nodes(tooth).into_iter();
        of_teeth.extend(rolls.zip(1..).map(|(roll, node)| {
            let radius = base_radius * (1.0 + roll * roll).sqrt();
            NodeRow { gear, node, roll, radius, tooth }
        }));
        for (surface, neighbour) in tooth.neighbours.iter().zip(1..) {
            let [first, further] = surface_nodes(surface);
            let inclined = tooth.inclined.as_ref().and_then(|inclined| inclined.neighbours.get(neighbour - 1));
            let mut values = surface.node_values().into_iter();
            for (&roll, node) in first.iter().zip(1..) {
                let at_tip = inclined.map_or(0.0, |series| series.value(roll));
                for ((&further, other), compliance) in further.iter().zip(1..).zip(&mut values) {
                    let (nodes, rolls) = ([node, other], [roll, further]);
                    of_neighbours.push(NeighbourRow { gear, neighbour, nodes, rolls, compliance, at_tip });
                }
            }
        }
    }
    let of_model = ModelRow { compliance, method, root };
    Ok([teeth().table(&of_teeth)?, neighbours().table(&of_neighbours)?, model().table(&[of_model])?])
}

/// Nodes that hold every series of a tooth: those of the longest one. All run over the same flank.
fn common_nodes(tooth: &ToothCompliance) -> Vec<f64> {
    let count = SERIES.iter().map(|(.., series)| series(tooth).coefficients().len()).max().unwrap_or(1);
    nodes(tooth.bending.lower(), tooth.bending.upper(), count)
}

fn surface_nodes(surface: &Surface) -> [Vec<f64>; 2] {
    std::array::from_fn(|axis| nodes(surface.lower()[axis], surface.upper()[axis], surface.counts()[axis]))
}

/// The port through which [`of`] reads.
#[must_use]
pub fn port(stage: &str) -> Port {
    let tables = [names::compliance::TABLE, names::neighbours::TABLE, names::model::TABLE];
    Port::tables(names::STIFFNESS_PORT, stage, &tables)
}

/// The table of the compliances.
///
/// # Errors
/// If it did not come in.
pub fn table<'a>(inputs: &Inputs<'a>) -> Result<&'a Table, Failure> {
    inputs.table(names::STIFFNESS_PORT, names::compliance::TABLE)
}

/// The compliances that came in.
///
/// # Errors
/// When their tables did not, or are not what [`write()`] made.
pub fn of(inputs: &Inputs) -> Result<PairCompliance, Failure> {
    let table = |table| inputs.table(names::STIFFNESS_PORT, table);
    read(table(names::compliance::TABLE)?, table(names::neighbours::TABLE)?, table(names::model::TABLE)?)
}

/// The compliances that [`write()`] wrote.
///
/// # Errors
/// When a table is not one that [`write()`] made.
pub fn read(compliance: &Table, neighbours: &Table, model: &Table) -> Result<PairCompliance, Failure> {
    let contact = match model.texts(names::model::CONTACT).first().map_or("", String::as_str) {
        INCLUDED => None,
        word => Some(ContactLaw::of(word).ok_or_else(|| Failure::new(format!("unknown contact law `{word}`")))?),
    };
    let plane = model.texts(names::model::PLANE).first().map_or("", String::as_str);
    Ok(PairCompliance {
        pinion: tooth("pinion", compliance, neighbours, contact)?,
        gear: tooth("gear", compliance, neighbours, contact)?,
        contact,
        plane: Plane::of(plane).ok_or_else(|| Failure::new(format!("unknown plane state `{plane}`")))?,
        coupled: model.texts(names::model::COUPLING).first().is_some_and(|coupling| coupling == "body"),
    })
}

fn tooth(
    name: &str,
    table: &Table,
    neighbours: &Table,
    contact: Option<ContactLaw>,
) -> Result<ToothCompliance, Failure> {
    let rows: Vec<usize> = (0..table.rows()).filter(|&row| table.texts(names::compliance::GEAR)[row] == name).collect();
    let series = |column: &str| series_from(table, column, &rows);
    let resolved = contact == Some(ContactLaw::Resolved);
    let (mut across, mut at_tip) = (Vec::new(), Vec::new());
    for neighbour in 1.. {
        let rows: Vec<usize> = (0..neighbours.rows())
            .filter(|&row| {
                neighbours.texts(names::neighbours::GEAR)[row] == name
                    && neighbours.integers(names::neighbours::NEIGHBOUR)[row] == neighbour
            })
            .collect();
        if rows.is_empty() {
            break;
        }
        across.push(surface_from(neighbours, &rows));
        if resolved {
            at_tip.push(at_tip_from(neighbours, &rows));
        }
    }
    let first = rows.first().copied().unwrap_or_default();
    let constant = |column: &str| si(table, column, first);
    let inclined = resolved.then(|| Inclined {
        own: [constant("tip_across"), constant("tip_along")],
        corner: [constant("corner_across"), constant("corner_along")],
        neighbours: at_tip,
    });
    Ok(ToothCompliance {
        bending: series("bending")?,
        shear: series("shear")?,
        axial: series("axial")?,
        body: series("body")?,
        contact_depth: series("contact_depth")?,
        corner: constant(names::compliance::CORNER),
        inclined,
        neighbours: across,
    })
}

fn series_from(table: &Table, column: &str, rows: &[usize]) -> Result<Series, Failure> {
    let rolls: Vec<f64> = rows.iter().map(|&row| table.floats(names::compliance::ROLL_ANGLE)[row]).collect();
    if rolls.is_empty() {
        return Err(Failure::new(format!("table `{}` has no rows for this gear", table.name())));
    }
    let (lower, upper) = interval(&rolls);
    let values: Vec<f64> = rows.iter().map(|&row| si(table, column, row)).collect();
    Ok(Series::from_values(lower, upper, &values))
}

/// The interval whose Chebyshev nodes are `nodes`: the outermost ones are its ends drawn in by cos(π/2n). A single node
/// is that of a constant, which is the same on any interval.
pub(super) fn interval(nodes: &[f64]) -> (f64, f64) {
    let (first, last) = (nodes[0], nodes[nodes.len() - 1]);
    if nodes.len() == 1 {
        return (first - 1.0, first + 1.0);
    }
    let shrink = libm::cos(std::f64::consts::PI / (2 * nodes.len()) as f64);
    let (middle, half) = (0.5 * (first + last), 0.5 * (last - first) / shrink);
    (middle - half, middle + half)
}

/// `rows` are not empty and in order of their keys.
fn surface_from(table: &Table, rows: &[usize]) -> Surface {
    let column = |name: &str| table.floats(name);
    let first_node = table.integers(names::neighbours::NODE)[rows[0]];
    let across = rows.iter().take_while(|&&row| table.integers(names::neighbours::NODE)[row] == first_node).count();
    let first: Vec<f64> = rows.iter().step_by(across).map(|&row| column(names::neighbours::ROLL_ANGLE)[row]).collect();
    let further: Vec<f64> =
        rows[..across].iter().map(|&row| column(names::neighbours::FURTHER_ROLL_ANGLE)[row]).collect();
    let (first_range, further_range) = (interval(&first), interval(&further));
    let values: Vec<f64> = rows.iter().map(|&row| si(table, names::neighbours::COMPLIANCE, row)).collect();
    Surface::from_values(
        [first_range.0, further_range.0],
        [first_range.1, further_range.1],
        [first.len(), further.len()],
        &values,
    )
}

/// The same of loads along the flank at the further tooth's tip.
fn at_tip_from(table: &Table, rows: &[usize]) -> Series {
    let nodes = table.integers(names::neighbours::NODE);
    let across = rows.iter().take_while(|&&row| nodes[row] == nodes[rows[0]]).count();
    let firsts: Vec<usize> = rows.iter().step_by(across).copied().collect();
    let rolls: Vec<f64> = firsts.iter().map(|&row| table.floats(names::neighbours::ROLL_ANGLE)[row]).collect();
    let values: Vec<f64> = firsts.iter().map(|&row| si(table, AT_TIP, row)).collect();
    let (lower, upper) = interval(&rolls);
    Series::from_values(lower, upper, &values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn compliances_come_back_to_the_last_bits() {
        let tooth = |scale: f64| ToothCompliance {
            bending: Series::fit(0.07, 0.62, 24, |u| scale * 1e-9 * libm::exp(u)),
            shear: Series::fit(0.07, 0.62, 17, |u| scale * 4e-10 * (1.0 + u)),
            axial: Series::fit(0.07, 0.62, 24, |u| scale * 1e-11 * u * u),
            body: Series::fit(0.07, 0.62, 24, |u| scale * 9e-10 * libm::cos(u)),
            contact_depth: Series::fit(0.07, 0.62, 24, |u| scale * 1e-3 * (2.0 - u)),
            corner: scale * 1.7e-12,
            inclined: Some(Inclined {
                own: [scale * -3e-10, scale * 2e-11],
                corner: [scale * -2e-12, scale * 3e-12],
                neighbours: vec![
                    Series::fit(0.07, 0.62, 12, |u| scale * -1e-10 * (1.0 + u * u)),
                    Series::from_values(0.07, 0.62, &[scale * -8e-11]),
                ],
            }),
            neighbours: vec![
                Surface::fit([0.07; 2], [0.62; 2], [12, 9], |u, v| scale * 3e-10 * (1.0 - u * v)),
                Surface::from_values([0.07; 2], [0.62; 2], [1, 1], &[scale * 2e-10]),
            ],
        };
        let pair = PairCompliance {
            pinion: tooth(1.0),
            gear: tooth(0.7),
            contact: Some(ContactLaw::LoadDependent),
            plane: Plane::Stress,
            coupled: true,
        };
        let round = |pair: &PairCompliance| {
            let [compliance, neighbours, model] = write(pair, [0.0268, 0.0677], "energy", "trochoid").unwrap();
            read(&compliance, &neighbours, &model).unwrap()
        };
        for contact in [Some(ContactLaw::Linear), Some(ContactLaw::Resolved), None] {
            assert_eq!(round(&PairCompliance { contact, ..pair.clone() }).contact, contact);
        }
        let resolved = round(&PairCompliance { contact: Some(ContactLaw::Resolved), ..pair.clone() });
        let inclined = |pair: &PairCompliance| {
            let tooth = &pair.gear;
            let of_corner = tooth.inclined.as_ref().map_or([0.0; 2], |inclined| inclined.corner);
            let neighbours = [0, 1].map(|index| tooth.neighbour(index, [0.15, 0.62], 0.3));
            [tooth.added(0.2), tooth.added(-0.1), neighbours[0], neighbours[1], of_corner[0], of_corner[1]]
        };
        for (back, written) in inclined(&resolved).into_iter().zip(inclined(&pair)) {
            assert!((back / written - 1.0).abs() < 1e-13, "{back:e} for {written:e}");
        }
        let back = round(&pair);
        assert!(back.gear.inclined.is_none(), "of resolved contact alone");
        assert!(back.coupled && back.plane == Plane::Stress && back.contact == Some(ContactLaw::LoadDependent));
        for roll in [0.07, 0.2, 0.41, 0.62] {
            assert!((back.gear.total(roll) / pair.gear.total(roll) - 1.0).abs() < 1e-14);
            assert!(
                (back.pinion.contact_depth.value(roll) / pair.pinion.contact_depth.value(roll) - 1.0).abs() < 1e-14
            );
        }
        let cross = |pair: &PairCompliance| pair.pinion.neighbours[0].value(0.15, 0.41);
        assert!((cross(&back) / cross(&pair) - 1.0).abs() < 1e-14);
        assert_eq!(back.gear.neighbours.len(), 2);
        assert!((back.gear.neighbours[1].value(0.3, 0.6) / 1.4e-10 - 1.0).abs() < 1e-14, "a constant");
    }
}
