//! A figure as SVG: lines, points or bars over two axes, with published values beside them.
//!
//! Our own few hundred lines, because a page that follows the reader's light or dark scheme and the width of the window
//! needs colours as style variables and a `viewBox`; the plotting library at hand writes fixed colours, a fixed size and
//! identifiers from a process-wide counter. Must not know: tables, HTML. The bytes depend on the plot alone.

use std::fmt::Write;

use super::drawing::true_to_scale;
use super::legend::{self, Colour, Item, Sign};
use super::scale::{Scale, Tick};
use super::svg::{CHARACTER, at, escape};
use declare::number::{superscript, unit_symbol};

/// Colours, type and strokes of every figure; light, dark and print.
pub const STYLE: &str = include_str!("plot.css");

const WIDTH: f64 = 860.0;
const PLOT_HEIGHT: f64 = 340.0;
const RIGHT: f64 = 18.0;
/// Series beyond this many are coloured along a ramp.
const COLOURS: usize = 8;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Line,
    Points,
    Bar,
    /// Lines, true to scale.
    Drawing,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    pub label: String,
    pub unit: String,
    pub is_log: bool,
}

/// Points drawn in one colour; a line is interrupted between runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    pub label: String,
    pub runs: Vec<Vec<(f64, f64)>>,
}

/// A published point, or a line across (`x` is none) or upright (`y` is none).
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    pub label: String,
    pub x: Option<f64>,
    pub y: Option<f64>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    pub title: String,
    pub kind: Kind,
    pub x: Axis,
    pub y: Axis,
    pub series: Vec<Series>,
    pub marks: Vec<Mark>,
    /// Names under the bars; the x of a point is their index.
    pub categories: Vec<String>,
}

/// The frame in which points are placed.
pub(super) struct Frame {
    pub left: f64,
    pub top: f64,
    width: f64,
    height: f64,
    x: Scale,
    y: Scale,
}

impl Frame {
    pub fn x(&self, value: f64) -> f64 {
        self.left + self.width * self.x.share(value)
    }

    pub fn y(&self, value: f64) -> f64 {
        self.top + self.height * (1.0 - self.y.share(value))
    }

    pub fn bottom(&self) -> f64 {
        self.top + self.height
    }

    pub fn right(&self) -> f64 {
        self.left + self.width
    }

    /// Both coordinates, when the point can be drawn on these scales.
    pub fn place(&self, (x, y): (f64, f64)) -> Option<(f64, f64)> {
        let (x, y) = (self.x(x), self.y(y));
        (x.is_finite() && y.is_finite()).then_some((x, y))
    }
}

impl Plot {
    /// The figure; `standalone` adds its style, background and title, as a file of its own needs them.
    #[must_use]
    pub fn svg(&self, standalone: bool) -> String {
        let legend = self.legend();
        let rows = legend::rows(&legend, WIDTH);
        let title_height = if standalone { 34.0 } else { 6.0 };
        let legend_height = if legend.is_empty() { 8.0 } else { 12.0 + 22.0 * rows.len() as f64 };
        let Some(frame) = self.frame(title_height + legend_height) else { return self.empty() };
        let is_slanted = self.slants_categories(&frame);
        let height = frame.bottom() + if is_slanted { 112.0 } else { 58.0 };
        let mut svg = String::new();
        let _ = write!(
            svg,
            r#"<svg xmlns="http://www.w3.org/2000/svg" class="plot" viewBox="0 0 {WIDTH} {}" role="img" aria-label="{}""#,
            at(height),
            escape(&self.title)
        );
        if standalone {
            let _ = write!(
                svg,
                r#" width="{WIDTH}" height="{}"><style>{STYLE}</style><rect class="paper" width="100%" height="100%"/>"#,
                at(height)
            );
            let _ = write!(svg, r#"<text class="title" x="16" y="26">{}</text>"#, escape(&self.title));
        } else {
            let _ = write!(svg, r#" tabindex="0" data-plot="{}">"#, escape(&self.data(&frame)));
        }
        legend::draw(&mut svg, &legend, &rows, frame.left, title_height);
        self.draw_axes(&mut svg, &frame, is_slanted);
        match self.kind {
            Kind::Line | Kind::Drawing => self.draw_lines(&mut svg, &frame),
            Kind::Points => self.draw_points(&mut svg, &frame),
            Kind::Bar => self.draw_bars(&mut svg, &frame),
        }
        self.draw_marks(&mut svg, &frame);
        self.draw_named_points(&mut svg, &frame);
        svg.push_str("</svg>");
        svg
    }

    fn points(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.series.iter().flat_map(|series| series.runs.iter().flatten().copied())
    }

    pub(super) fn frame(&self, top: f64) -> Option<Frame> {
        let xs = self.points().map(|point| point.0).chain(self.marks.iter().filter_map(|mark| mark.x));
        let ys = self.points().map(|point| point.1).chain(self.marks.iter().filter_map(|mark| mark.y));
        let x = if self.kind == Kind::Bar {
            Scale { low: -0.5, high: self.categories.len().max(1) as f64 - 0.5, is_log: false }
        } else {
            // A point at the very edge would be cut in half.
            let margin = if matches!(self.kind, Kind::Points | Kind::Drawing)
                || self.marks.iter().any(|mark| mark.x.is_some())
            {
                0.02
            } else {
                0.0
            };
            let scale = Scale::around(xs, self.x.is_log, 0.0, false)?;
            let room = if scale.is_log { 0.0 } else { margin * (scale.high - scale.low) };
            Scale { low: scale.low - room, high: scale.high + room, ..scale }
        };
        // A drawing need not show where zero is.
        let room = if self.kind == Kind::Drawing { 0.0 } else { 0.06 };
        let y = Scale::around(ys, self.y.is_log, room, self.kind == Kind::Bar && !self.y.is_log)?;
        let longest = y.ticks(6).iter().map(|tick| tick.label.chars().count()).max().unwrap_or(0);
        let left = 50.0 + CHARACTER * longest as f64;
        let width = WIDTH - left - RIGHT;
        let (x, y, height) = if self.kind == Kind::Drawing { true_to_scale(x, y, width) } else { (x, y, PLOT_HEIGHT) };
        Some(Frame { left, top, width, height, x, y })
    }

    fn empty(&self) -> String {
        let title = escape(&self.title);
        format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" class="plot" viewBox="0 0 {WIDTH} 80" role="img" aria-label="{title}"><style>{STYLE}</style><text class="label" x="16" y="44">{title}: there is no finite value to draw</text></svg>"#
        )
    }

    fn colour(&self, series: usize) -> Colour {
        let lines = |series: &[Series]| series.iter().filter(|series| !self.is_named_point(series)).count();
        match (lines(&self.series[..series]), lines(&self.series)) {
            _ if self.is_named_point(&self.series[series]) => Colour::Ink,
            (line, count) if count <= COLOURS => Colour::Of(line),
            (line, count) => Colour::ramp(line, count),
        }
    }

    pub(super) fn colour_of_mark(&self, mark: &Mark) -> Colour {
        self.series
            .iter()
            .position(|series| series.label == mark.label)
            .map_or(Colour::Ink, |series| self.colour(series))
    }

    fn legend(&self) -> Vec<Item> {
        let is_alone = self.series.len() < 2 && self.marks.is_empty();
        let sign = match self.kind {
            Kind::Line | Kind::Drawing => Sign::Line,
            Kind::Points => Sign::Dot,
            Kind::Bar => Sign::Square,
        };
        let series = self.series.iter().enumerate().filter(|(_, series)| !is_alone && !self.is_named_point(series));
        let mut items: Vec<Item> = series
            .map(|(index, series)| Item {
                label: if series.label.is_empty() { "computed".to_owned() } else { series.label.clone() },
                sign,
                colour: self.colour(index),
            })
            .collect();
        for mark in &self.marks {
            let shares_name = self.series.iter().any(|series| series.label == mark.label);
            let label = if shares_name { format!("{}, published", mark.label) } else { mark.label.clone() };
            let sign = if mark.x.is_some() && mark.y.is_some() { Sign::Diamond } else { Sign::Dashes };
            let item = Item { label, sign, colour: self.colour_of_mark(mark) };
            if !items.contains(&item) {
                items.push(item);
            }
        }
        items
    }

    fn slants_categories(&self, frame: &Frame) -> bool {
        let longest = self.categories.iter().map(|name| name.chars().count()).max().unwrap_or(0);
        CHARACTER * longest as f64 > 0.94 * frame.width / self.categories.len().max(1) as f64
    }

    fn draw_axes(&self, svg: &mut String, frame: &Frame, is_slanted: bool) {
        let (left, right, top, bottom) = (at(frame.left), at(frame.right()), at(frame.top), at(frame.bottom()));
        for Tick { value, label } in frame.y.ticks(6) {
            let y = frame.y(value);
            let _ = write!(svg, r#"<path class="grid" d="M{left} {0}H{right}"/>"#, at(y));
            let _ = write!(
                svg,
                r#"<text class="tick" x="{}" y="{}" text-anchor="end">{label}</text>"#,
                at(frame.left - 8.0),
                at(y + 4.5)
            );
        }
        if self.kind == Kind::Bar {
            for (index, name) in self.categories.iter().enumerate() {
                let (x, y) = (frame.x(index as f64), frame.bottom() + 19.0);
                let (x, y, name) = (at(x), at(y), escape(name));
                let _ = if is_slanted {
                    write!(
                        svg,
                        r#"<text class="tick" x="{x}" y="{y}" text-anchor="end" transform="rotate(-28 {x} {y})">{name}</text>"#
                    )
                } else {
                    write!(svg, r#"<text class="tick" x="{x}" y="{y}" text-anchor="middle">{name}</text>"#)
                };
            }
        } else {
            for Tick { value, label } in frame.x.ticks(8) {
                let x = at(frame.x(value));
                let _ = write!(
                    svg,
                    r#"<path class="grid" d="M{x} {top}V{bottom}"/><path class="axis" d="M{x} {bottom}v5"/>"#
                );
                let _ = write!(
                    svg,
                    r#"<text class="tick" x="{x}" y="{}" text-anchor="middle">{label}</text>"#,
                    at(frame.bottom() + 20.0)
                );
            }
        }
        let _ = write!(svg, r#"<path class="axis" d="M{left} {top}V{bottom}H{right}"/>"#);
        let (x_power, y_power) = (if self.kind == Kind::Bar { 0 } else { frame.x.power() }, frame.y.power());
        let label_y = frame.bottom() + if is_slanted { 100.0 } else { 46.0 };
        let middle = at(frame.left + frame.width / 2.0);
        let _ = write!(
            svg,
            r#"<text class="label" x="{middle}" y="{}" text-anchor="middle">{}</text>"#,
            at(label_y),
            escape(&axis_label(&self.x, x_power))
        );
        let middle = at(frame.top + frame.height / 2.0);
        let _ = write!(
            svg,
            r#"<text class="label" x="16" y="{middle}" text-anchor="middle" transform="rotate(-90 16 {middle})">{}</text>"#,
            escape(&axis_label(&self.y, y_power))
        );
    }

    fn draw_lines(&self, svg: &mut String, frame: &Frame) {
        for (index, series) in self.series.iter().enumerate() {
            if self.is_named_point(series) {
                continue;
            }
            let style = self.colour(index).stroke();
            let (mut line, mut jumps) = (String::new(), String::new());
            let mut last: Option<(f64, f64)> = None;
            for run in &series.runs {
                // A point that cannot be placed (NaN, or 0 on a logarithmic axis) interrupts the line.
                let mut is_drawing = false;
                for (nth, &point) in run.iter().enumerate() {
                    let Some((x, y)) = frame.place(point) else {
                        is_drawing = false;
                        continue;
                    };
                    if let Some((from_x, from_y)) = last.filter(|_| nth == 0 && self.kind == Kind::Line)
                        && (x - from_x).abs() < 0.03 * frame.width
                    {
                        let _ = write!(jumps, "M{} {}L{} {}", at(from_x), at(from_y), at(x), at(y));
                    }
                    let _ = write!(line, "{}{} {}", if is_drawing { 'L' } else { 'M' }, at(x), at(y));
                    is_drawing = true;
                    last = Some((x, y));
                }
            }
            if !jumps.is_empty() {
                let _ = write!(svg, r#"<path class="jump" {style} d="{jumps}"/>"#);
            }
            let _ = write!(svg, r#"<path class="series" {style} d="{line}"/>"#);
            let count = series.runs.iter().map(Vec::len).sum::<usize>();
            if count <= 24 && self.kind == Kind::Line {
                // Few points: show where they are, a line between them is only a guide.
                dots(svg, frame, series, self.colour(index), 2.6);
            }
        }
    }

    fn draw_points(&self, svg: &mut String, frame: &Frame) {
        for (index, series) in self.series.iter().enumerate() {
            dots(svg, frame, series, self.colour(index), 3.6);
        }
    }

    fn draw_bars(&self, svg: &mut String, frame: &Frame) {
        let slot = frame.width / self.categories.len().max(1) as f64;
        let bar = (0.78 * slot / self.series.len().max(1) as f64).min(64.0);
        let base = if frame.y.is_log { frame.bottom() } else { frame.y(0.0) };
        for (index, series) in self.series.iter().enumerate() {
            let offset = (index as f64 - 0.5 * self.series.len() as f64) * bar;
            for (x, y) in series.runs.iter().flatten().filter_map(|&point| frame.place(point)) {
                let (top, height) = (y.min(base), (y - base).abs());
                let _ = write!(
                    svg,
                    r#"<rect class="bar" {} x="{}" y="{}" width="{}" height="{}"/>"#,
                    self.colour(index).fill(),
                    at(x + offset + 0.5),
                    at(top),
                    at(bar - 1.0),
                    at(height)
                );
            }
        }
    }

    /// What the page's script needs to find the nearest point and to say its values.
    fn data(&self, frame: &Frame) -> String {
        let series: Vec<_> = self
            .series
            .iter()
            .enumerate()
            .map(|(index, series)| {
                let placed = series.runs.iter().flatten().filter_map(|&point| {
                    let (x, y) = frame.place(point)?;
                    Some(serde_json::json!([rounded(x, 5), rounded(y, 5), rounded(point.0, 6), rounded(point.1, 6)]))
                });
                let points: Vec<_> = placed.collect();
                serde_json::json!({ "label": series.label, "colour": self.colour(index).value(), "points": points })
            })
            .collect();
        let axis = |axis: &Axis| serde_json::json!({ "label": axis.label, "unit": unit_symbol(&axis.unit) });
        serde_json::json!({
            "frame": [rounded(frame.left, 6), rounded(frame.top, 6), rounded(frame.width, 6), rounded(frame.height, 6)],
            "x": axis(&self.x),
            "y": axis(&self.y),
            "categories": self.categories,
            "series": series,
        })
        .to_string()
    }
}

/// `value` with so many significant digits, for a shorter text.
fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}

fn axis_label(axis: &Axis, power: i32) -> String {
    let symbol = unit_symbol(&axis.unit);
    match (power, symbol.is_empty()) {
        (0, true) => axis.label.clone(),
        (0, false) => format!("{} ({symbol})", axis.label),
        (power, true) => format!("{} (10{})", axis.label, superscript(power)),
        (power, false) => format!("{} (10{} {symbol})", axis.label, superscript(power)),
    }
}

fn dots(svg: &mut String, frame: &Frame, series: &Series, colour: Colour, radius: f64) {
    for (x, y) in series.runs.iter().flatten().filter_map(|&point| frame.place(point)) {
        let _ = write!(svg, r#"<circle {} cx="{}" cy="{}" r="{radius}"/>"#, colour.fill(), at(x), at(y));
    }
}
