//! A spline whose valleys are bridged by parabolas: the largest function below it that bends back no more than is allowed.
//!
//! With what bends the other way by as much added, that is the lower convex hull: straight where it bridges. Its vertices are
//! found among knots, then its lines are made tangents of the cubics beside them, so that the slope has no step. This is the
//! opening of a profile by a parabola (ISO 16610-41 has it by a disk). Must not know: what the spline is of.

use super::{Index, Spline};

/// How often a tangent is drawn anew: the error of its touching points is squared each time.
const ROUNDS: usize = 3;
/// How far a crest between two points may come below a bridge, over half of the allowed bend and the square of the length; and how much
/// farther it is taken to come than a parabola does.
const NEGLIGIBLE: f64 = 1e-4;
const OVERESTIMATE: f64 = 2.0;
/// What a cubic may bend back beyond what is allowed, over that: rounding.
const ROUNDING: f64 = 1e-6;

/// A part of the range, in which the allowed bend is the same: where it begins, and half of that bend; what is added there, and its
/// slope.
#[derive(Clone, Copy)]
struct Part {
    from: f64,
    half_bend: f64,
    added: f64,
    slope: f64,
}

impl Part {
    /// What is added, and its slope.
    fn at(&self, x: f64) -> [f64; 2] {
        let t = x - self.from;
        [self.added + t * (self.slope + t * self.half_bend), self.slope + 2.0 * t * self.half_bend]
    }
}

/// A cubic of the spline within one part.
struct Cut {
    /// As the pieces of a spline.
    piece: [f64; 5],
    part: usize,
    /// Value and slope of the sum where it begins.
    value: f64,
    slope: f64,
}

/// A straight line of the hull between two vertices: the places that it touches, with the cuts that they lie on, and its height at
/// the first one and its slope.
#[derive(Clone, Copy)]
struct Bridge {
    vertices: [usize; 2],
    places: [f64; 2],
    cuts: [usize; 2],
    height: f64,
    slope: f64,
}

struct Hull {
    parts: Vec<Part>,
    cuts: Vec<Cut>,
    /// Where the last cut ends, and the value there.
    end: [f64; 2],
}

impl Spline {
    /// The same between `from` and `to`, bending back by no more than `bends` allow in equal parts of that range (each 0 or more); on the
    /// sum of both, vertices are looked for no farther apart than `finest`.
    #[must_use]
    pub fn bridged(&self, [from, to]: [f64; 2], bends: &[f64], finest: f64) -> Self {
        let hull = Hull::new(self, [from, to], bends, finest);
        let bridges = hull.bridges();
        let pieces = hull.pieces(&bridges);
        let mut knots: Vec<f64> = Vec::with_capacity(pieces.len() + 1);
        knots.extend(pieces.iter().map(|piece| piece[0]));
        knots.push(to);
        let index = Index::new(&knots);
        // Of parabolas, and of cubics at both their ends.
        let bend = |piece: &[f64; 5], end: f64| 2.0 * piece[3] + 6.0 * (end - piece[0]) * piece[4];
        let bends = pieces.iter().zip(&knots[1..]).map(|(piece, end)| (2.0 * piece[3]).min(bend(piece, *end)));
        let least_bend = bends.fold(f64::INFINITY, f64::min);
        Self { knots, pieces, index, least_bend }
    }
}

impl Hull {
    fn new(spline: &Spline, [from, to]: [f64; 2], bends: &[f64], finest: f64) -> Self {
        let width = (to - from) / bends.len() as f64;
        let (mut added, mut slope) = (0.0, 0.0);
        let mut parts = Vec::with_capacity(bends.len());
        for (index, bend) in bends.iter().enumerate() {
            parts.push(Part { from: from + width * index as f64, half_bend: 0.5 * bend, added, slope });
            added += width * (slope + 0.5 * width * bend);
            slope += width * bend;
        }
        let mut cuts = Vec::with_capacity(spline.pieces.len() + 2 * bends.len());
        let first = spline.index.interval(spline.pieces.len(), from, |at| spline.pieces[at][0]);
        let (mut at, mut index, mut part) = (from, first, 0);
        while at < to && index < spline.pieces.len() {
            let piece = &spline.pieces[index];
            let next_part = if part + 1 < parts.len() { parts[part + 1].from } else { f64::INFINITY };
            let next_knot = if index + 1 < spline.pieces.len() { spline.pieces[index + 1][0] } else { f64::INFINITY };
            let end = next_knot.min(next_part).min(to);
            if end > at {
                // Seldom more than one.
                let mut begin = at;
                while begin < end {
                    let [value, slope] = parts[part].at(begin);
                    let piece = moved(piece, begin);
                    cuts.push(Cut { piece, part, value: piece[1] + value, slope: piece[2] + slope });
                    begin = if end - begin > finest { begin + finest } else { end };
                }
                at = end;
            }
            index += usize::from(next_knot <= end);
            part += usize::from(next_part <= end);
        }
        let end = spline.value(to) + parts.last().map_or(0.0, |part| part.at(to)[0]);
        Self { parts, cuts, end: [to, end] }
    }

    /// Where a vertex may lie, and the height there.
    fn point(&self, vertex: usize) -> [f64; 2] {
        self.cuts.get(vertex).map_or(self.end, |cut| [cut.piece[0], cut.value])
    }

    /// The lower hull of the points at which cuts begin, with its lines as tangents.
    fn bridges(&self) -> Vec<Bridge> {
        let mut vertices: Vec<(usize, [f64; 2])> = Vec::with_capacity(self.cuts.len() + 1);
        for next in 0..=self.cuts.len() {
            let [x, height] = self.point(next);
            while let [.., (_, one), (_, other)] = vertices[..] {
                // Below the line from `one` to the next.
                if (other[1] - one[1]) * (x - one[0]) < (height - one[1]) * (other[0] - one[0]) {
                    break;
                }
                vertices.pop();
            }
            vertices.push((next, [x, height]));
        }
        let mut bridges: Vec<Bridge> = Vec::new();
        let mut ahead: Vec<usize> = Vec::new();
        for ends in vertices.windows(2) {
            let [mut from, to] = [ends[0].0, ends[1].0];
            if to == from + 1 && !self.bends_back(from) {
                continue;
            }
            ahead.push(to);
            while let Some(&to) = ahead.last() {
                let mut bridge = self.tangent([from, to]);
                if let Some(crest) = self.crest_below(&bridge) {
                    ahead.push(crest);
                    continue;
                }
                // A crest that only its points made a vertex.
                while let Some(last) = bridges.last().filter(|last| last.places[1] > bridge.places[0]) {
                    bridge = self.tangent([last.vertices[0], to]);
                    bridges.pop();
                }
                bridges.push(bridge);
                from = to;
                ahead.pop();
            }
        }
        bridges
    }

    /// Beside which point between both ends of a bridge the sum comes the farthest below it, though the point does not.
    fn crest_below(&self, bridge: &Bridge) -> Option<usize> {
        let Bridge { vertices: [first, last], places: [from, to], height, slope, .. } = *bridge;
        let mut lowest = -NEGLIGIBLE * self.parts[self.cuts[first].part].half_bend * (to - from) * (to - from);
        let mut found = None;
        for vertex in first + 1..last {
            let Cut { piece, part, value, slope: here } = &self.cuts[vertex];
            let above = |[x, value]: [f64; 2]| value - height - slope * (x - from);
            let (bend, steeper) = (2.0 * (piece[3] + self.parts[*part].half_bend), here - slope);
            // As low as the parabola comes, before anything is searched for.
            if bend > 0.0 && 2.0 * bend * above([piece[0], *value]) < OVERESTIMATE * steeper * steeper {
                let (point, _) = self.touched(vertex, slope);
                if above(point) < lowest && point[0] > from && point[0] < to {
                    (lowest, found) = (above(point), Some(vertex));
                }
            }
        }
        found
    }

    /// Whether a cut does so more than is allowed.
    fn bends_back(&self, cut: usize) -> bool {
        let Cut { piece, part, .. } = &self.cuts[cut];
        let allowed = 2.0 * self.parts[*part].half_bend;
        let bend = 2.0 * piece[3] + 6.0 * (self.point(cut + 1)[0] - piece[0]) * piece[4];
        (2.0 * piece[3]).min(bend) + allowed < -ROUNDING * allowed
    }

    /// The line that touches the sum near both vertices.
    fn tangent(&self, vertices: [usize; 2]) -> Bridge {
        let mut touched = vertices.map(|vertex| (self.point(vertex), vertex.min(self.cuts.len() - 1)));
        let slope = |[one, other]: [([f64; 2], usize); 2]| (other.0[1] - one.0[1]) / (other.0[0] - one.0[0]);
        for _ in 0..ROUNDS {
            let along = slope(touched);
            touched = vertices.map(|vertex| self.touched(vertex, along));
        }
        let [one, other] = touched;
        Bridge {
            vertices,
            places: [one.0[0], other.0[0]],
            cuts: [one.1, other.1],
            height: one.0[1],
            slope: slope(touched),
        }
    }

    /// The point beside a vertex at which the sum has a slope, and the cut on which that lies.
    fn touched(&self, vertex: usize, slope: f64) -> ([f64; 2], usize) {
        let last = self.cuts.len() - 1;
        let own = (self.point(vertex), vertex.min(last));
        let cut = match self.cuts.get(vertex) {
            Some(here) if here.slope <= slope => vertex,
            _ if vertex > 0 => vertex - 1,
            _ => return own,
        };
        let Cut { piece, part, value, slope: here } = &self.cuts[cut];
        let half_bend = piece[3] + self.parts[*part].half_bend;
        // Where the slope of the cubic is this one and grows.
        let (miss, bend, third) = (here - slope, 2.0 * half_bend, 3.0 * piece[4]);
        let t = -2.0 * miss / (bend + (bend * bend - 4.0 * third * miss).sqrt());
        let at = piece[0] + t;
        if !(t >= 0.0 && at <= self.point(cut + 1)[0]) {
            return own;
        }
        ([at, value + t * (here + t * (half_bend + t * piece[4]))], cut)
    }

    /// The cubics between bridges, and the bridges.
    fn pieces(&self, bridges: &[Bridge]) -> Vec<[f64; 5]> {
        let mut pieces = Vec::with_capacity(self.cuts.len());
        let (mut at, mut cut) = (self.point(0)[0], 0);
        let end = Bridge { places: [self.end[0]; 2], cuts: [self.cuts.len() - 1; 2], ..Bridge::NONE };
        for bridge in bridges.iter().chain([&end]) {
            let [to, behind] = bridge.places;
            for index in cut..=bridge.cuts[0] {
                let begin = at.max(self.cuts[index].piece[0]);
                let before = to.min(self.point(index + 1)[0]);
                if before > begin {
                    pieces.push(moved(&self.cuts[index].piece, begin));
                }
            }
            at = to;
            for index in self.cuts[bridge.cuts[0]].part..=self.cuts[bridge.cuts[1]].part {
                let ends = if index + 1 < self.parts.len() { self.parts[index + 1].from } else { self.end[0] };
                let before = behind.min(ends);
                if before > at {
                    let Part { half_bend, .. } = self.parts[index];
                    let [added, slope] = self.parts[index].at(at);
                    let height = bridge.height + bridge.slope * (at - to);
                    pieces.push([at, height - added, bridge.slope - slope, -half_bend, 0.0]);
                    at = before;
                }
            }
            (at, cut) = (behind, bridge.cuts[1]);
        }
        pieces
    }
}

impl Bridge {
    const NONE: Self = Self { vertices: [0; 2], places: [0.0; 2], cuts: [0; 2], height: 0.0, slope: 0.0 };
}

/// The same cubic counted from another place.
#[allow(clippy::float_cmp)] // asks whether it is the place where it begins
fn moved(piece: &[f64; 5], to: f64) -> [f64; 5] {
    let [from, c0, c1, c2, c3] = *piece;
    if to == from {
        return *piece;
    }
    let t = to - from;
    [to, c0 + t * (c1 + t * (c2 + t * c3)), c1 + t * (2.0 * c2 + 3.0 * t * c3), c2 + 3.0 * t * c3, c3]
}

#[cfg(test)]
mod tests;
