//! A profile split into cells, each a cubic or another curve, with lower bounds for branch and bound.
//!
//! Must not know: the other flank, the search.

use super::{Outline, share};

/// Number of cells of a piece that is not a cubic.
const CURVED_CELLS: usize = 8;
/// Largest jump of slope that counts as rounding, as a share of the largest slope of the profile.
const SLOPE_TOLERANCE: f64 = 1e-10;
/// Number of cells in a block, whose lower bounds are stored together.
const BLOCK: usize = 16;

/// All cells of a flank, in order of position.
#[derive(Clone, Debug, Default)]
pub(in super::super) struct Cells {
    /// The start of each cell and the end of the last, ascending.
    ends: Vec<f64>,
    curves: Vec<Cell>,
    /// The cells that begin at a kink, or where smoothness is unknown, and `count()`; ascending.
    corners: Vec<usize>,
    /// Lower bounds of depth and of second derivative over blocks of cells.
    blocks: Vec<[f64; 2]>,
    /// A lower bound of the depth over each cell and all behind it.
    from: Vec<f64>,
}

#[derive(Clone, Copy, Debug)]
struct Cell {
    /// Coefficients over the distance from the start of the cell; `None` if the curve is not a cubic.
    cubic: Option<[f64; 4]>,
    /// Index of the piece of the outline.
    piece: usize,
    /// A lower bound of the depth.
    least: f64,
    /// The second derivative of the cubic at both ends.
    bends: [f64; 2],
}

/// A function that is nowhere above a profile on an interval and equals it at both ends: its least second derivative and its slopes at the ends.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Underestimator {
    pub(in super::super) bend: f64,
    pub(in super::super) slopes: [f64; 2],
    /// True if the function is the profile itself.
    pub(in super::super) is_exact: bool,
}

impl Underestimator {
    /// A lower bound of the values inside an interval of this width with these values at its ends.
    pub(in super::super) fn least(&self, values: [f64; 2], width: f64) -> f64 {
        // Lowering the end slopes by β w/2 makes the function convex.
        let more = 0.5 * width * self.bend.min(0.0);
        let [falls, rises] = [self.slopes[0] + more, self.slopes[1] - more];
        if falls >= 0.0 {
            return values[0];
        }
        if rises <= 0.0 {
            return values[1];
        }
        // Intersection of the tangents at both ends.
        values[0] + falls * ((values[1] - values[0] - rises * width) / (falls - rises))
    }
}

impl Cells {
    pub(in super::super) fn new(outline: &Outline) -> Self {
        let mut cells = Self::default();
        // A tip may reach beyond the base circle of the other gear, where its flank has no points.
        let base = outline.position(0.0);
        let [first, last] = if outline.is_point { [f64::NEG_INFINITY, base] } else { [base, f64::INFINITY] };
        cells.ends.push(outline.cuts[0].max(first));
        let mut knots: Vec<f64> = outline
            .parts
            .iter()
            .flat_map(crate::gear::modification::section::Section::knots)
            .map(|roll| outline.position(*roll))
            .collect();
        knots.sort_by(f64::total_cmp);
        let closest = 1e-9 * (outline.facing.end - outline.facing.start);
        for (piece, ends) in outline.cuts.windows(2).enumerate() {
            let ends = [ends[0].max(first), ends[1].min(last)];
            if ends[1] <= ends[0] {
                continue;
            }
            let mut from = ends[0];
            let inside = knots.iter().copied().filter(|knot| *knot > ends[0] && ends[1] - knot > closest);
            for to in inside.chain([ends[1]]) {
                if to - from > closest || to >= ends[1] {
                    cells.push(outline, piece, [from, to]);
                    from = to;
                }
            }
        }
        cells.find_corners(outline);
        cells.find_bounds();
        cells
    }

    /// Adds one cell for a cubic, several for another curve.
    fn push(&mut self, outline: &Outline, piece: usize, ends: [f64; 2]) {
        if let Some(cubic) = outline.cubic(piece, ends) {
            let length = ends[1] - ends[0];
            let [c0, c1, c2, c3] = cubic;
            // Bernstein coefficients: their minimum bounds the cubic from below.
            let (one, other) = (c0 + length * c1 / 3.0, c0 + length * (2.0 * c1 + length * c2) / 3.0);
            let last = c0 + length * (c1 + length * (c2 + length * c3));
            let bends = [2.0 * c2, 2.0 * c2 + 6.0 * c3 * length];
            let least = c0.min(one).min(other).min(last);
            self.curves.push(Cell { cubic: Some(cubic), piece, least, bends });
            self.ends.push(ends[1]);
            return;
        }
        for at in 0..CURVED_CELLS {
            let ends = [at, at + 1].map(|end| share(&ends, end, CURVED_CELLS));
            let values = ends.map(|end| outline.depth_on(end, piece));
            let least = outline.underestimator(piece, ends).least(values, ends[1] - ends[0]);
            self.curves.push(Cell { cubic: None, piece, least, bends: [0.0; 2] });
            self.ends.push(ends[1]);
        }
    }

    fn find_corners(&mut self, outline: &Outline) {
        let slopes: Vec<[f64; 2]> =
            (0..self.count()).map(|at| [at, at + 1].map(|end| self.rates(outline, self.ends[end], at)[1])).collect();
        let finite = slopes.iter().flatten().filter(|slope| slope.is_finite());
        let negligible = SLOPE_TOLERANCE * finite.fold(0.0_f64, |most, slope| most.max(slope.abs()));
        let is_cubic = |at: usize| self.curves[at].cubic.is_some();
        let is_smooth =
            |at: usize| is_cubic(at - 1) && is_cubic(at) && (slopes[at][0] - slopes[at - 1][1]).abs() <= negligible;
        self.corners = (1..self.count()).filter(|at| !is_smooth(*at)).chain([self.count()]).collect();
    }

    fn find_bounds(&mut self) {
        let of_block = |cells: &[Cell]| {
            cells.iter().fold([f64::INFINITY; 2], |[least, bend], cell| {
                [least.min(cell.least), bend.min(cell.bends[0]).min(cell.bends[1])]
            })
        };
        self.blocks = self.curves.chunks(BLOCK).map(of_block).collect();
        self.from = self.curves.iter().map(|cell| cell.least).collect();
        for at in (1..self.from.len()).rev() {
            self.from[at - 1] = self.from[at - 1].min(self.from[at]);
        }
    }

    pub(in super::super) fn count(&self) -> usize {
        self.curves.len()
    }

    /// The start of a cell; for `count()`, the end of the last cell.
    pub(in super::super) fn end(&self, at: usize) -> f64 {
        self.ends[at]
    }

    /// Index of the piece of the outline that a cell belongs to.
    pub(in super::super) fn piece(&self, cell: usize) -> usize {
        self.curves[cell].piece
    }

    /// Index of the first cell after this one that starts at a corner.
    pub(in super::super) fn next_corner(&self, cell: usize) -> usize {
        self.corners[self.corners.partition_point(|corner| *corner <= cell)]
    }

    /// The cell that contains a position, within this range; at a boundary the cell behind it.
    #[inline]
    pub(in super::super) fn cell(&self, position: f64, [first, last]: [usize; 2]) -> usize {
        first + self.ends[first + 1..=last].partition_point(|end| *end <= position)
    }

    /// Depth and its first two derivatives on a cell.
    #[inline]
    pub(in super::super) fn rates(&self, outline: &Outline, position: f64, cell: usize) -> [f64; 3] {
        let Cell { cubic, piece, .. } = &self.curves[cell];
        if let Some([c0, c1, c2, c3]) = cubic {
            let t = position - self.ends[cell];
            return [c0 + t * (c1 + t * (c2 + t * c3)), c1 + t * (2.0 * c2 + 3.0 * t * c3), 2.0 * c2 + 6.0 * t * c3];
        }
        outline.rates(position, *piece)
    }

    /// A lower bound of the depth over a range of cells.
    #[inline]
    pub(in super::super) fn least(&self, [first, last]: [usize; 2]) -> f64 {
        self.over(first, last + 1, |cell| cell.least, 0)
    }

    /// A lower bound of the depth over a cell and all behind it.
    pub(in super::super) fn least_from(&self, cell: usize) -> f64 {
        self.from[cell]
    }

    /// An underestimator between two positions on these cells with these rates, without a corner in between.
    #[inline]
    pub(in super::super) fn underestimator(
        &self,
        outline: &Outline,
        [first, last]: [usize; 2],
        ends: [f64; 2],
        rates: [&[f64; 3]; 2],
    ) -> Underestimator {
        if self.curves[first].cubic.is_none() {
            return outline.underestimator(self.curves[first].piece, ends);
        }
        // The second derivative is linear within a cell.
        let mut bend = rates[0][2].min(rates[1][2]);
        if first < last {
            let inside = self.over(first + 1, last, |cell| cell.bends[0].min(cell.bends[1]), 1);
            bend = bend.min(self.curves[first].bends[1]).min(self.curves[last].bends[0]).min(inside);
        }
        Underestimator { bend, slopes: [rates[0][1], rates[1][1]], is_exact: true }
    }

    /// The minimum of `of` over a half-open range of cells; whole blocks use their stored minimum.
    #[inline]
    fn over(&self, from: usize, to: usize, of: impl Fn(&Cell) -> f64, which: usize) -> f64 {
        let least = |from: usize, to: usize| self.curves[from..to].iter().map(&of).fold(f64::INFINITY, f64::min);
        let (begin, end) = (from.div_ceil(BLOCK), to / BLOCK);
        if begin >= end {
            return if from < to { least(from, to) } else { f64::INFINITY };
        }
        let blocks = self.blocks[begin..end].iter().map(|block| block[which]).fold(f64::INFINITY, f64::min);
        blocks.min(least(from, begin * BLOCK)).min(least(end * BLOCK, to))
    }
}
