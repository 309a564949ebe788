//! A map: a value for each cell of a grid, as steps of colour, with the scale that says which is which.
//!
//! Places that the table does not have, and those with 0 where nothing is negative, stay blank: of pressures that is where
//! nothing touches. Those of which it says that there is no value are crossed out. Must not know: tables, axes.

use std::fmt::Write;

use super::frame::Frame;
use super::isolines::pieces;
use super::look::Colour;
use super::scale::{Scale, with_power};
use super::svg::{at, escape};
use declare::number::{significant, unit_symbol, with_unit};

/// Steps of colour: cells of one step next to each other are one rectangle.
const STEPS: usize = 24;
const BAR: f64 = 14.0;

#[derive(Clone, Debug, PartialEq)]
pub struct Cells {
    /// Edges of the columns, ascending, one more than there are columns.
    pub xs: Vec<f64>,
    /// Of the rows.
    pub ys: Vec<f64>,
    /// Places of the columns and of the rows.
    pub places: [Vec<f64>; 2],
    /// Row by row; NaN where there is none.
    pub values: Vec<f64>,
    /// Those of which the table says that there is none.
    pub missing: Vec<bool>,
    pub label: String,
    pub unit: String,
    pub isolines: bool,
    pub best: Best,
}

/// Which cell is marked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Best {
    #[default]
    None,
    Smallest,
    Largest,
}

impl Cells {
    /// From points `(x, y, value)` on a grid, in any order; `None` where there is none.
    #[must_use]
    pub fn new(points: &[(f64, f64, f64)], label: String, unit: String) -> Option<Self> {
        let sorted = |pick: fn(&(f64, f64, f64)) -> f64| {
            let mut all: Vec<f64> = points.iter().map(pick).filter(|value| value.is_finite()).collect();
            all.sort_by(f64::total_cmp);
            // Two values a rounding apart are one.
            let span = all.last().zip(all.first()).map_or(0.0, |(last, first)| last - first);
            all.dedup_by(|one, other| (*one - *other).abs() <= 1e-9 * span);
            all
        };
        let (columns, rows) = (sorted(|point| point.0), sorted(|point| point.1));
        if columns.is_empty() || rows.is_empty() {
            return None;
        }
        let mut values = vec![f64::NAN; columns.len() * rows.len()];
        let mut missing = vec![false; values.len()];
        for &(x, y, value) in points.iter().filter(|point| point.0.is_finite() && point.1.is_finite()) {
            let index = nearest(&rows, y) * columns.len() + nearest(&columns, x);
            (values[index], missing[index]) = (value, !value.is_finite());
        }
        let (xs, ys) = (edges(&columns), edges(&rows));
        let places = [columns, rows];
        Some(Self { xs, ys, places, values, missing, label, unit, isolines: false, best: Best::None })
    }

    /// Whether nothing varies along y.
    #[must_use]
    pub fn has_one_row(&self) -> bool {
        self.ys.len() == 2
    }

    fn is_drawn(&self, value: f64) -> bool {
        value.is_finite() && (value != 0.0 || self.values.iter().any(|value| *value < 0.0))
    }

    /// From the least value that is drawn to the largest, from 0 where that is near.
    #[must_use]
    pub fn scale(&self) -> Option<Scale> {
        let drawn = self.values.iter().copied().filter(|value| self.is_drawn(*value));
        let scale = Scale::around(drawn, false, 0.0, false)?;
        let low = if scale.low > 0.0 && scale.low < 0.5 * scale.high { 0.0 } else { scale.low };
        Some(Scale { low, ..scale })
    }

    fn step(scale: &Scale, value: f64) -> usize {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // between 0 and STEPS
        let step = (scale.share(value).clamp(0.0, 1.0) * STEPS as f64).floor() as usize;
        step.min(STEPS - 1)
    }

    fn colour(step: usize) -> Colour {
        Colour::along((step as f64 + 0.5) / STEPS as f64)
    }

    pub fn draw(&self, svg: &mut String, frame: &Frame) {
        let Some(scale) = self.scale() else { return };
        let columns = self.xs.len() - 1;
        let step = |value: f64| self.is_drawn(value).then(|| Self::step(&scale, value));
        let mut paths = vec![String::new(); STEPS];
        for (row, values) in self.values.chunks(columns).enumerate() {
            let mut from = 0;
            for run in values.chunk_by(|one, other| step(*one) == step(*other)) {
                let to = from + run.len();
                if let Some(step) = step(run[0]) {
                    let _ = write!(
                        paths[step],
                        "M{} {}H{}V{}H{0}Z",
                        at(frame.x(self.xs[from])),
                        at(frame.y(self.ys[row + 1])),
                        at(frame.x(self.xs[to])),
                        at(frame.y(self.ys[row]))
                    );
                }
                from = to;
            }
        }
        svg.push_str(r#"<g data-s="s0" shape-rendering="crispEdges">"#);
        for (step, path) in paths.iter().enumerate().filter(|(_, path)| !path.is_empty()) {
            let _ = write!(svg, r#"<path class="cell" {} d="{path}"/>"#, Self::colour(step).fill());
        }
        svg.push_str("</g>");
        self.draw_missing(svg, frame);
        if self.isolines {
            self.draw_isolines(svg, frame, &scale);
        }
        self.draw_best(svg, frame);
    }

    /// The steps with their values, to the right of the frame.
    pub fn draw_scale(&self, svg: &mut String, frame: &Frame) {
        let Some(scale) = self.scale() else { return };
        let left = frame.right() + 16.0;
        let height = frame.height / STEPS as f64;
        svg.push_str(r#"<g class="steps">"#);
        for step in 0..STEPS {
            let y = frame.bottom() - height * (step + 1) as f64;
            let (x, y, fill) = (at(left), at(y), Self::colour(step).fill());
            let _ = write!(svg, r#"<rect {fill} x="{x}" y="{y}" width="{BAR}" height="{}"/>"#, at(height + 0.4));
        }
        for tick in scale.ticks(frame.layout.ticks[1]) {
            let y = frame.bottom() - frame.height * scale.share(tick.value);
            let (x, y, label) = (at(left + BAR + 5.0), at(y + 4.5), tick.label);
            let _ = write!(svg, r#"<text class="tick" x="{x}" y="{y}">{label}</text>"#);
        }
        let symbol = unit_symbol(&self.unit);
        let power = with_power(&self.label, &symbol, scale.power());
        let (x, y) = (at(left + BAR + 9.0 * frame.layout.character), at(frame.top + 0.5 * frame.height));
        let _ = write!(
            svg,
            r#"<text class="label" x="{x}" y="{y}" text-anchor="middle" transform="rotate(-90 {x} {y})">{}</text></g>"#,
            escape(&power)
        );
    }
}

impl Cells {
    /// A cross over each cell of which the table says that there is no value.
    fn draw_missing(&self, svg: &mut String, frame: &Frame) {
        let columns = self.xs.len() - 1;
        let mut path = String::new();
        for (index, _) in self.missing.iter().enumerate().filter(|(_, is_missing)| **is_missing) {
            let (column, row) = (index % columns, index / columns);
            let [left, right] = [frame.x(self.xs[column]), frame.x(self.xs[column + 1])].map(at);
            let [low, high] = [frame.y(self.ys[row]), frame.y(self.ys[row + 1])].map(at);
            let _ = write!(path, "M{left} {low}L{right} {high}M{left} {high}L{right} {low}");
        }
        if !path.is_empty() {
            let _ = write!(svg, r#"<path class="missing" d="{path}"><title>no value</title></path>"#);
        }
    }

    /// A line for each tick of the scale of colours, with its value where it is longest.
    fn draw_isolines(&self, svg: &mut String, frame: &Frame, scale: &Scale) {
        let [xs, ys] = &self.places;
        for tick in scale.ticks(frame.layout.ticks[1]) {
            let pieces = pieces(xs, ys, &self.values, tick.value);
            let placed: Vec<[(f64, f64); 2]> = pieces
                .iter()
                .filter_map(|[from, to]| Some([frame.place(*from)?, frame.place(*to)?]))
                .filter(|[from, to]| from != to)
                .collect();
            let long = |[from, to]: &[(f64, f64); 2]| (from.0 - to.0).hypot(from.1 - to.1);
            let Some(longest) = placed.iter().max_by(|a, b| long(a).total_cmp(&long(b))) else { continue };
            let mut path = String::new();
            for [from, to] in &placed {
                let _ = write!(path, "M{} {}L{} {}", at(from.0), at(from.1), at(to.0), at(to.1));
            }
            let (x, y) = (at(0.5 * (longest[0].0 + longest[1].0)), at(0.5 * (longest[0].1 + longest[1].1)));
            let _ = write!(
                svg,
                r#"<path class="isoline" d="{path}"/><text class="tick isovalue" x="{x}" y="{y}" dy="4" text-anchor="middle">{}</text>"#,
                tick.label
            );
        }
    }

    /// A frame around the cell with the smallest or the largest value.
    fn draw_best(&self, svg: &mut String, frame: &Frame) {
        let numbers = self.values.iter().enumerate().filter(|(_, value)| value.is_finite());
        let found = match self.best {
            Best::None => None,
            Best::Smallest => numbers.min_by(|a, b| a.1.total_cmp(b.1)),
            Best::Largest => numbers.max_by(|a, b| a.1.total_cmp(b.1)),
        };
        let Some((index, value)) = found else { return };
        let (column, row) = (index % (self.xs.len() - 1), index / (self.xs.len() - 1));
        let [left, right] = [frame.x(self.xs[column]), frame.x(self.xs[column + 1])].map(at);
        let [low, high] = [frame.y(self.ys[row]), frame.y(self.ys[row + 1])].map(at);
        let title = with_unit(&significant(*value, 4), &self.unit);
        let _ = write!(
            svg,
            r#"<path class="best" d="M{left} {low}H{right}V{high}H{left}Z"><title>{}</title></path>"#,
            escape(&title)
        );
    }
}

/// The place of the value nearest to one.
fn nearest(sorted: &[f64], value: f64) -> usize {
    let after = sorted.partition_point(|known| *known < value).min(sorted.len() - 1);
    let before = after.saturating_sub(1);
    if (value - sorted[before]).abs() <= (sorted[after] - value).abs() { before } else { after }
}

/// Half way between neighbours, and as far beyond the first and the last.
fn edges(middles: &[f64]) -> Vec<f64> {
    let (first, last) = (middles[0], middles[middles.len() - 1]);
    if middles.len() == 1 {
        return vec![first - 0.5, first + 0.5];
    }
    let between = middles.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
    let inner: Vec<f64> = between.collect();
    let (low, high) = (2.0 * first - inner[0], 2.0 * last - inner[inner.len() - 1]);
    std::iter::once(low).chain(inner).chain([high]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::plot::{Kind, Plot};

    fn cells() -> Cells {
        let values = [(2, 0, 5.0), (0, 0, 0.0), (1, 0, 1.0), (0, 1, 1.0), (1, 1, 1.02), (2, 1, 10.0)];
        let points: Vec<(f64, f64, f64)> = values.map(|(x, y, v)| (f64::from(x), 10.0 * f64::from(y), v)).to_vec();
        Cells::new(&points, "Pressure".to_owned(), "MPa".to_owned()).unwrap()
    }

    #[test]
    fn points_in_any_order_become_rows_of_cells() {
        let cells = cells();
        assert_eq!((cells.xs.as_slice(), cells.ys.as_slice()), (&[-0.5, 0.5, 1.5, 2.5][..], &[-5.0, 5.0, 15.0][..]));
        assert_eq!(cells.values, [0.0, 1.0, 5.0, 1.0, 1.02, 10.0]);
        assert_eq!(cells.scale().map(|scale| (scale.low, scale.high)), Some((0.0, 10.0)));
        assert_eq!(Cells::new(&[(f64::NAN, 0.0, 1.0)], String::new(), String::new()), None);
        // A place that was reached in two ways is one place.
        let close =
            Cells::new(&[(0.1 + 0.2, 0.0, 1.0), (0.3, 1.0, 2.0), (1.0, 0.0, 3.0)], String::new(), String::new());
        assert_eq!(close.unwrap().xs.len(), 3);
    }

    /// The area of each step is that of its cells: 5 of 6 are drawn, and two of one step are one rectangle.
    #[test]
    fn every_cell_is_drawn_once_and_zero_is_blank() {
        let plot = Plot { cells: Some(cells()), ..Plot::new("t", Kind::Map) };
        let svg = plot.inline();
        let rectangles: Vec<Vec<f64>> = svg
            .split(r#"class="cell""#)
            .skip(1)
            .flat_map(|path| path.split(" d=\"").nth(1).unwrap().split('"').next().unwrap().split_terminator('Z'))
            .map(|one| one.trim_start_matches('M').split([' ', 'H', 'V']).map(|n| n.parse().unwrap()).collect())
            .collect();
        assert_eq!(rectangles.len(), 4, "{rectangles:?}");
        let frame = plot.frame(8.0, crate::report::frame::Layout::PAGE).unwrap();
        let area: f64 = rectangles.iter().map(|r| (r[2] - r[0]) * (r[3] - r[1])).sum();
        assert!((area / (frame.width * frame.height) - 5.0 / 6.0).abs() < 1e-3, "{area}");
    }

    /// The numbers of a path with absolute commands, by its class.
    fn numbers(svg: &str, class: &str) -> Vec<f64> {
        let path =
            svg.split(&format!(r#"class="{class}" d=""#)).nth(1).map_or("", |rest| rest.split('"').next().unwrap());
        path.split(|c: char| c.is_ascii_alphabetic() || c == ' ').filter_map(|number| number.parse().ok()).collect()
    }

    /// Around the middle of the cell half way to its neighbours; a cell without a value is never the best.
    #[test]
    fn the_best_cell_is_framed() {
        let points =
            [(0.0, 0.0, 4.0), (1.0, 0.0, 3.0), (2.0, 0.0, f64::NAN), (0.0, 1.0, 7.0), (1.0, 1.0, 9.0), (2.0, 1.0, 8.0)];
        let drawn = |best: Best| {
            let cells = Cells::new(&points, "Error".to_owned(), "um".to_owned()).unwrap();
            Plot { cells: Some(Cells { best, ..cells }), ..Plot::new("t", Kind::Map) }
        };
        let frame = drawn(Best::None).frame(8.0, crate::report::frame::Layout::PAGE).unwrap();
        for (best, [column, row], title) in
            [(Best::Smallest, [1.0, 0.0], "3\u{202f}µm"), (Best::Largest, [1.0, 1.0], "9\u{202f}µm")]
        {
            let svg = drawn(best).inline();
            let [left, low, right, high, back] = numbers(&svg, "best")[..] else { panic!("{svg}") };
            let sides = [left, right, low, high].into_iter();
            let meant = [frame.x(column - 0.5), frame.x(column + 0.5), frame.y(row - 0.5), frame.y(row + 0.5)];
            assert!(sides.zip(meant).all(|(drawn, meant)| (drawn - meant).abs() < 0.1), "{best:?}: {meant:?} {svg}");
            assert!(back.total_cmp(&left).is_eq() && svg.contains(&format!("<title>{title}</title>")), "{svg}");
        }
        assert!(!drawn(Best::None).inline().contains(r#"class="best""#));
        // What has no value is crossed out, corner to corner, once.
        let crossed = numbers(&drawn(Best::None).inline(), "missing");
        let [left, right, low, high] = [frame.x(1.5), frame.x(2.5), frame.y(-0.5), frame.y(0.5)];
        let meant = [left, low, right, high, left, high, right, low];
        assert!(
            crossed.len() == 8 && crossed.iter().zip(meant).all(|(a, b)| (a - b).abs() < 0.1),
            "{crossed:?} {meant:?}"
        );
    }

    /// Of the plane x + 2 y the lines are straight, and each stands with its value at a tick of the scale of colours.
    #[test]
    fn isolines_are_where_the_plane_has_their_value() {
        let points: Vec<(f64, f64, f64)> = (0..5)
            .flat_map(|x| (0..4).map(move |y| (f64::from(x), f64::from(y), 1.0 + f64::from(x) + 2.0 * f64::from(y))))
            .collect();
        let cells = Cells::new(&points, String::new(), String::new()).unwrap();
        let ticks = cells.scale().unwrap().ticks(crate::report::frame::Layout::PAGE.ticks[1]);
        let plain = Plot { cells: Some(cells.clone()), ..Plot::new("t", Kind::Map) };
        let plot = Plot { cells: Some(Cells { isolines: true, ..cells }), ..Plot::new("t", Kind::Map) };
        assert!(!plain.inline().contains("isoline"));
        let (svg, frame) = (plot.inline(), plot.frame(8.0, crate::report::frame::Layout::PAGE).unwrap());
        let (unit_x, unit_y) = (frame.x(1.0) - frame.x(0.0), frame.y(1.0) - frame.y(0.0));
        let mut lines = 0;
        for one in svg.split(r#"<path class="isoline""#).skip(1) {
            let value: f64 = one.split("</text>").next().unwrap().rsplit('>').next().unwrap().parse().unwrap();
            let places = numbers(&format!(r#"class="isoline"{one}"#), "isoline");
            for place in places.chunks(2) {
                let at = 1.0 + (place[0] - frame.x(0.0)) / unit_x + 2.0 * (place[1] - frame.y(0.0)) / unit_y;
                assert!((at - value).abs() < 0.02, "{value}: {at}");
            }
            lines += 1;
        }
        // One for each tick between the corners, 1 and 11.
        assert_eq!(lines, ticks.iter().filter(|tick| tick.value > 1.0 && tick.value < 11.0).count());
        assert!(lines >= 3);
    }
}
