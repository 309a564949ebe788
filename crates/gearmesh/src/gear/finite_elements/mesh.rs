//! The mesh of one sector, a tooth and its share of the body, in units of the module, and its boundaries.
//!
//! Two blocks of quadrilaterals share the curve on which the tooth is cut off the body. Rows of the tooth are circular
//! arcs from flank to flank, from that curve up to the tip circle; lines of the body run radially from it, and from the
//! root below the cut, to the bore. Everything is symmetric about the tooth's centreline, on which nodes lie.
//! Must not know: elasticity, loads.

use std::borrow::Cow;
use std::f64::consts::TAU;

use super::MeshError;
use super::element::{self, NODES, RULE};
use super::grading::{self, depths};
use super::outline::{Division, Outline, Stretch, grade};
use super::tooth_rows::{ToothRows, chain};

/// Sizes for one element across; they are inversely proportional to the number of elements across.
/// Length of an element along the flank over the tooth's thickness there.
const ALONG: f64 = 1.2;
/// Turn of the outline along one element \[rad\].
const TURN: f64 = 3.2;
/// Depth of the body's outermost elements over the tooth's thickness at the cut, and its growth with the depth.
const RIM: [f64; 2] = [0.7, 3.0];
/// The same where loads are points: elements across are thinner there, and those below must not be what limits.
const FINE_RIM: [f64; 2] = [0.45, 3.5];

/// Turn of the involute along one element where loads are points \[rad\]: next to the base circle its curvature has no bound.
const INVOLUTE_TURN: f64 = 0.8;
/// By which share elements at the flanks are thinner than if all across were alike, where loads are points: what such a load
/// leaves varies most there. Those in the middle are thicker by as much.
const CROWDED: f64 = 0.6;
/// The same of the root curve where its stress is to be known: a quarter of a turn of fillet has 8 to 16 elements.
const FILLET_TURN: f64 = 1.6;
/// By how much elements grow for each length of the way from the sharpest place of the root.
const FILLET_GROWTH: f64 = 0.9;
/// The least length of elements there \[modules\], before they are cut into parts.
const LEAST_SIZE: f64 = 5e-4;
/// Length of an element along the flank at the tip over what it would be, where its corner matters.
const AT_TIP: f64 = 1.0 / 16.0;
/// By how much elements grow for each length of the way from there, for one element across.
const FROM_TIP: f64 = 0.9;

/// Sizes of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Sizing {
    /// From the right flank (0) to the left (1), corners and middles alternating; symmetric, with ½ at a corner if the
    /// centreline is to be an edge of elements. Not used with `fillet`, which decides it.
    pub across: Vec<f64>,
    /// Elements across if they were all alike; all other sizes follow from it.
    pub level: f64,
    /// Depth of the body's outermost elements and its growth, for one element across.
    pub rim: [f64; 2],
    /// Turn of the involute along one element, for one element across \[rad\].
    pub involute_turn: f64,
    /// Where on the flank the mesh must be finer.
    pub focus: Option<Focus>,
    /// Whether elements at the root are in proportion to its radius of curvature.
    pub fillet: Option<Fillet>,
    /// Into how many parts each element along the outline, and down the body, is cut: so that meshes are nested.
    pub parts: usize,
}

/// A place on the flank where elements are shorter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Focus {
    /// Its height in the tooth's frame \[modules\].
    pub height: f64,
    /// Length of an element there \[modules\].
    pub size: f64,
    /// By how much it grows for each length of the way from there.
    pub growth: f64,
}

/// Elements at the root that are in proportion to the radius of curvature of its curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fillet {
    /// Turn of the root curve along one element, for one element across \[rad\].
    pub turn: f64,
    /// By how much elements grow for each length of the way from the smallest, along the surface and into the depth.
    pub growth: f64,
}

impl Sizing {
    /// `across` equal elements between the flanks, an even number.
    #[must_use]
    pub fn even(across: usize) -> Self {
        let half = (0..=2 * across).map(|k| k as f64 / (2 * across) as f64).collect();
        Self { across: half, level: across as f64, rim: RIM, involute_turn: TURN, focus: None, fillet: None, parts: 1 }
    }

    /// For point loads less their own fields, up to the end of a flank where half the tooth is `half` thick, at a `height`
    /// \[modules\]: `across` elements between the flanks, thinner there, and shorter towards the tip. With two `parts` it
    /// is the mesh of half as many across and one part, of which each element is cut into four: their errors differ by the
    /// power of their size alone.
    #[must_use]
    pub fn nested(across: usize, parts: usize, [half, height]: [f64; 2]) -> Self {
        let place = |k: usize| {
            let even = k as f64 / (2 * across) as f64;
            even - CROWDED / TAU * libm::sin(TAU * even)
        };
        let size = AT_TIP * Self::along(half, across / parts);
        Self {
            across: (0..=2 * across).map(place).collect(),
            level: across as f64 / parts as f64,
            rim: FINE_RIM,
            involute_turn: INVOLUTE_TURN,
            focus: Some(Focus { height, size, growth: FROM_TIP }),
            fillet: None,
            parts,
        }
    }

    /// For the stress at the root: elements are in proportion to the radius of the root curve where that is smallest, in
    /// both directions, and grow with the distance from it; `across` elements between the flanks would there be without it.
    /// `parts` are those of [`Self::nested`].
    #[must_use]
    pub fn graded(across: usize, parts: usize) -> Self {
        Self {
            across: Vec::new(),
            level: across as f64 / parts as f64,
            rim: FINE_RIM,
            involute_turn: INVOLUTE_TURN,
            focus: None,
            fillet: Some(Fillet { turn: FILLET_TURN, growth: FILLET_GROWTH }),
            parts,
        }
    }

    /// Length of an element along the flank with so many across, where half the tooth is `half` thick \[modules\].
    #[must_use]
    pub fn along(half: f64, across: usize) -> f64 {
        ALONG * 2.0 * half / across as f64
    }
}

/// An element's edge on a boundary: the element, which of its edges, and its nodes (start, middle, end).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// Its place in [`ElementMesh::elements`].
    pub element: usize,
    /// Which edge of the unit square it is, counterclockwise: 0 at η = −1, 1 at ξ = 1, 2 at η = 1, 3 at ξ = −1.
    pub side: usize,
    /// Their places in [`ElementMesh::nodes`], in the direction in which the boundary runs.
    pub nodes: [usize; 3],
}

/// A meshed sector.
#[derive(Clone, Debug, PartialEq)]
pub struct ElementMesh {
    /// \[modules\], in the tooth's frame.
    pub nodes: Vec<[f64; 2]>,
    /// The nodes of each element: its corners counterclockwise, then the middles of its edges in the same order.
    pub elements: Vec<[usize; NODES]>,
    /// Nodes on the bore.
    pub bore: Vec<usize>,
    /// Nodes on the radial edges outside the bore, outwards; one edge is the other turned by a pitch.
    pub left: Vec<usize>,
    /// The same at the other edge, node by node.
    pub right: Vec<usize>,
    /// The right flank above the cut, upwards.
    pub flank: Vec<Edge>,
    /// The right root below the cut, upwards from the middle of the root land.
    pub root: Vec<Edge>,
    /// The tooth's centreline, outwards.
    pub centreline: Vec<Edge>,
    /// Where the elements of the tooth begin in [`ElementMesh::elements`], from the cut upwards; before them are those of the body,
    /// row by row from the bore, each row from the left edge to the right one.
    pub first_of_tooth: usize,
    /// Elements in a row of the body, and how many of them lie beside the tooth at its left.
    pub body_row: [usize; 2],
    /// π/z: half the angle of the sector \[rad\].
    pub half_pitch: f64,
}

/// A block of elements as a grid of node numbers; the middles of elements have no number.
struct Grid {
    columns: usize,
    numbers: Vec<usize>,
}

const NONE: usize = usize::MAX;

impl Grid {
    fn at(&self, column: usize, row: usize) -> usize {
        self.numbers[row * self.columns + column]
    }

    fn rows(&self) -> usize {
        self.numbers.len() / self.columns
    }

    /// The element whose lower left corner is at (column, row).
    fn element(&self, column: usize, row: usize) -> [usize; NODES] {
        [[0, 0], [2, 0], [2, 2], [0, 2], [1, 0], [2, 1], [1, 2], [0, 1]].map(|[x, y]| self.at(column + x, row + y))
    }
}

impl ElementMesh {
    /// # Errors
    /// When an element is folded over.
    pub fn new(outline: &Outline, sizing: &Sizing) -> Result<Self, MeshError> {
        let level = sizing.level;
        let cut_point = outline.tooth[0].point(outline.tooth[0].lower);
        let cut_thickness = 2.0 * cut_point[0];
        let body_size = ALONG * cut_thickness / level;
        let root_turn = sizing.fillet.map_or(TURN, |fillet| fillet.turn);
        let turn = |stretch: &Stretch| if stretch.is_flank() { sizing.involute_turn } else { root_turn } / level;
        let body = outline.body.iter().map(|stretch| Division::new(stretch, turn(stretch), |_| body_size));
        let tooth = outline.tooth.iter().map(|stretch| {
            Division::new(stretch, turn(stretch), |[x, y]| {
                let size = ALONG * 2.0 * x / level;
                sizing.focus.map_or(size, |focus| size.min(focus.size + focus.growth * (y - focus.height).abs()))
            })
        });
        let mut divisions: Vec<Division> = body.chain(tooth).collect();
        let mut across = Cow::from(&sizing.across);
        let [mut rim_depth, mut growth] = sizing.rim.map(|size| size / level);
        rim_depth *= cut_thickness;
        if let Some(fillet) = sizing.fillet {
            let stretches = outline.body.iter().chain(&outline.tooth);
            let of_root = stretches.zip(&divisions).filter(|(stretch, _)| !stretch.is_flank());
            let least = of_root.map(|(_, division)| division.smallest()).fold(f64::INFINITY, f64::min).max(LEAST_SIZE);
            grade(&mut divisions, least, fillet.growth);
            rim_depth = rim_depth.min(least);
            growth = fillet.growth;
            across = Cow::from(grading::across(least / cut_thickness, growth, 1.0 / level, sizing.parts));
        }
        let (of_body, of_tooth) = divisions.split_at(outline.body.len());
        let mut root_points = chain(&outline.body, of_body, sizing.parts);
        // A root without land ends there but for rounding.
        let (sine, cosine) = libm::sincos(outline.half_pitch);
        let radius = libm::hypot(root_points[0][0], root_points[0][1]);
        root_points[0] = [radius * sine, radius * cosine];
        let flank_points = chain(&outline.tooth, of_tooth, sizing.parts);

        let rows = ToothRows::new(outline, &flank_points, &across);
        let top: Vec<[f64; 2]> = (0..across.len()).map(|place| rows.point(0, place)).collect();
        // From the left sector edge to the right one.
        let half = root_points.len() - 1;
        let rim: Vec<[f64; 2]> = (root_points.iter().take(half).map(|&[x, y]| [-x, y]))
            .chain(top.iter().rev().copied())
            .chain(root_points.iter().take(half).rev().copied())
            .collect();
        let outer = libm::hypot(cut_point[0], cut_point[1]);
        let fractions = depths(outline.bore_radius, outer, [rim_depth, growth], level, sizing.parts);

        let mut nodes = Vec::new();
        let mut body = Grid { columns: rim.len(), numbers: Vec::new() };
        for (row, fraction) in fractions.iter().enumerate() {
            for (column, &[x, y]) in rim.iter().enumerate() {
                if row % 2 == 1 && column % 2 == 1 {
                    body.numbers.push(NONE);
                    continue;
                }
                body.numbers.push(nodes.len());
                let radius = libm::hypot(x, y);
                let scale = if row + 1 == fractions.len() {
                    1.0
                } else {
                    (outline.bore_radius + (radius - outline.bore_radius) * fraction) / radius
                };
                nodes.push([x * scale, y * scale]);
            }
        }
        let across = across.len();
        let mut tooth = Grid { columns: across, numbers: Vec::new() };
        for row in 0..flank_points.len() {
            for column in 0..across {
                if row == 0 {
                    tooth.numbers.push(body.at(half + column, body.rows() - 1));
                } else if row % 2 == 1 && column % 2 == 1 {
                    tooth.numbers.push(NONE);
                } else {
                    tooth.numbers.push(nodes.len());
                    nodes.push(rows.point(row, across - 1 - column));
                }
            }
        }
        Self::assemble(nodes, &body, &tooth, half, outline.half_pitch)
    }

    fn assemble(
        nodes: Vec<[f64; 2]>,
        body: &Grid,
        tooth: &Grid,
        half: usize,
        half_pitch: f64,
    ) -> Result<Self, MeshError> {
        let mut elements = Vec::new();
        let (mut flank, mut root, mut centreline) = (Vec::new(), Vec::new(), Vec::new());
        for grid in [body, tooth] {
            let middle = (grid.columns - 1) / 2;
            for row in (0..grid.rows() - 1).step_by(2) {
                for column in (0..grid.columns - 1).step_by(2) {
                    let element = elements.len();
                    let nodes = grid.element(column, row);
                    let upright = |side: usize, column: usize| Edge {
                        element,
                        side,
                        nodes: [0, 1, 2].map(|step| grid.at(column, row + step)),
                    };
                    if column + 2 == middle {
                        centreline.push(upright(1, middle));
                    }
                    if std::ptr::eq(grid, tooth) && column + 3 == grid.columns {
                        flank.push(upright(1, column + 2));
                    }
                    // Above the body's right end lies the root.
                    if std::ptr::eq(grid, body) && row + 3 == grid.rows() && column >= half + tooth.columns - 1 {
                        root.push(Edge {
                            element,
                            side: 2,
                            nodes: [2, 1, 0].map(|step| grid.at(column + step, row + 2)),
                        });
                    }
                    elements.push(nodes);
                }
            }
        }
        root.reverse();
        let edge = |column: usize| (1..body.rows()).map(|row| body.at(column, row)).collect();
        let mesh = Self {
            bore: (0..body.columns).map(|column| body.at(column, 0)).collect(),
            left: edge(0),
            right: edge(body.columns - 1),
            nodes,
            elements,
            flank,
            root,
            centreline,
            first_of_tooth: (body.columns - 1) / 2 * ((body.rows() - 1) / 2),
            body_row: [(body.columns - 1) / 2, half / 2],
            half_pitch,
        };
        let folded = (0..mesh.elements.len()).find(|&element| {
            let nodes = mesh.corners(element);
            RULE.iter().any(|(xi, _)| {
                RULE.iter().any(|(eta, _)| {
                    let upright = element::gradients(&nodes, [*xi, *eta]).1 > 0.0;
                    !upright
                })
            })
        });
        match folded {
            Some(element) => Err(MeshError::Folded { element: element + 1, elements: mesh.elements.len() }),
            None => Ok(mesh),
        }
    }

    /// The elements of the tooth and of as many rows of the body beneath it.
    #[must_use]
    pub fn tooth(&self, rows: usize) -> Vec<usize> {
        let [row, beside] = self.body_row;
        let beneath = (1..=rows.min(self.first_of_tooth / row.max(1))).flat_map(|depth| {
            self.first_of_tooth - depth * row + beside..self.first_of_tooth - (depth - 1) * row - beside
        });
        beneath.chain(self.first_of_tooth..self.elements.len()).collect()
    }

    /// The nodes of an element.
    #[must_use]
    pub fn corners(&self, element: usize) -> [[f64; 2]; NODES] {
        self.elements[element].map(|node| self.nodes[node])
    }
}
