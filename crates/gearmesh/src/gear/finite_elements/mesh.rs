//! The mesh of one sector, a tooth and its share of the body, in units of the module, and its boundaries.
//!
//! Two blocks of quadrilaterals share the curve on which the tooth is cut off the body. Rows of the tooth are circular
//! arcs from flank to flank, from that curve up to the tip circle; lines of the body run radially from it, and from the
//! root below the cut, to the bore. Everything is symmetric about the tooth's centreline, on which nodes lie.
//! Must not know: elasticity, loads.

use super::MeshError;
use super::element::{self, NODES, RULE};
use super::outline::{Outline, divide};
use super::tooth_rows::{ToothRows, chain};

/// Sizes for one element across; they are inversely proportional to the number of elements across.
/// Length of an element along the flank over the tooth's thickness there.
const ALONG: f64 = 1.2;
/// Turn of the outline along one element \[rad\].
const TURN: f64 = 3.2;
/// Depth of the body's outermost elements over the tooth's thickness at the cut.
const RIM: f64 = 0.7;
/// Growth of the body's elements with the depth.
const GROWTH: f64 = 3.0;
/// Depth of the body's elements over the radius, near a small bore.
const PROPORTION: f64 = 3.2;

/// Sizes of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Sizing {
    /// From the right flank (0) to the left (1), corners and middles alternating; symmetric, with ½ at a corner.
    pub across: Vec<f64>,
    /// Elements across if they were all alike; all other sizes follow from it.
    pub level: f64,
    /// Element length along the flank near a height \[modules\], and the height, where the mesh must be finer.
    pub focus: Option<[f64; 2]>,
}

impl Sizing {
    /// `across` equal elements between the flanks, an even number.
    #[must_use]
    pub fn even(across: usize) -> Self {
        let half = (0..=2 * across).map(|k| k as f64 / (2 * across) as f64).collect();
        Self { across: half, level: across as f64, focus: None }
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
    /// Its place in [`Mesh::elements`].
    pub element: usize,
    /// Which edge of the unit square it is, counterclockwise: 0 at η = −1, 1 at ξ = 1, 2 at η = 1, 3 at ξ = −1.
    pub side: usize,
    /// Their places in [`Mesh::nodes`], in the direction in which the boundary runs.
    pub nodes: [usize; 3],
}

/// A meshed sector.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
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
    /// Where the elements of the tooth begin in [`Mesh::elements`], from the cut upwards; before them are those of the body,
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

impl Mesh {
    /// # Errors
    /// When an element is folded over.
    pub fn new(outline: &Outline, sizing: &Sizing) -> Result<Self, MeshError> {
        let level = sizing.level;
        let cut_point = outline.tooth[0].point(outline.tooth[0].lower);
        let cut_thickness = 2.0 * cut_point[0];
        let body_size = ALONG * cut_thickness / level;
        let mut root_points = chain(&outline.body, |stretch| divide(stretch, TURN / level, |_| body_size));
        // A root without land ends there but for rounding.
        let (sine, cosine) = libm::sincos(outline.half_pitch);
        let radius = libm::hypot(root_points[0][0], root_points[0][1]);
        root_points[0] = [radius * sine, radius * cosine];
        let flank_points = chain(&outline.tooth, |stretch| {
            divide(stretch, TURN / level, |[x, y]| {
                let size = ALONG * 2.0 * x / level;
                sizing.focus.map_or(size, |[fine, height]| size.min(fine + 0.3 * (y - height).abs()))
            })
        });

        let rows = ToothRows::new(outline, &flank_points, &sizing.across);
        let top: Vec<[f64; 2]> = (0..sizing.across.len()).map(|place| rows.point(0, place)).collect();
        // From the left sector edge to the right one.
        let half = root_points.len() - 1;
        let rim: Vec<[f64; 2]> = (root_points.iter().take(half).map(|&[x, y]| [-x, y]))
            .chain(top.iter().rev().copied())
            .chain(root_points.iter().take(half).rev().copied())
            .collect();
        let outer = libm::hypot(cut_point[0], cut_point[1]);
        let fractions = depths(outline.bore_radius, outer, RIM * cut_thickness / level, level);

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
        let across = sizing.across.len();
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

/// Rows of the body as fractions of the way from the bore to the rim, corners and middles alternating: the depth of an
/// element is `rim` at the rim, grows with the distance from it, and is at most in proportion to the radius.
fn depths(bore: f64, outer: f64, rim: f64, level: f64) -> Vec<f64> {
    let (growth, proportion) = (GROWTH / level, PROPORTION / level);
    let depth = outer - bore;
    // Where the two sizes are equal.
    let turn = ((proportion * outer - rim) / (growth + proportion)).clamp(0.0, depth);
    let near = libm::log1p(growth * turn / rim) / growth;
    let far = libm::log((outer - turn) / bore) / proportion;
    let total = near + far;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a few dozen
    let count = libm::round(total).max(2.0) as usize;
    let place = |k: usize| {
        if k == 0 {
            return 0.0;
        }
        let weight = total * (1.0 - k as f64 / count as f64);
        let below = if weight <= near {
            libm::expm1(growth * weight) * rim / growth
        } else {
            outer - (outer - turn) * libm::exp(-proportion * (weight - near))
        };
        1.0 - below / depth
    };
    let mut fractions = Vec::new();
    for k in 0..count {
        fractions.extend([place(k), 0.5 * (place(k) + place(k + 1))]);
    }
    fractions.push(1.0);
    fractions
}
