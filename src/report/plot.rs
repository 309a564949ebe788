//! A figure: lines, points, bars or a map over two axes, with published values beside them.
//!
//! Our own few hundred lines, because a page that follows the reader's light or dark scheme and the width of the window
//! needs colours as style variables and a `viewBox`; the plotting library at hand writes fixed colours, a fixed size and
//! identifiers from a process-wide counter. Must not know: tables, HTML. The bytes depend on the plot alone.

use std::fmt::Write;

use super::cells::Cells;
use super::frame::{Frame, Layout, Size};
use super::legend::{self, Item, Sign};
use super::look::{Line, Look};
use super::svg::{at, escape};

/// About the frame nothing is cut off, so that a line on its edge is not cut in half \[px\].
const ROOM: f64 = 6.0;

/// Room of a remark below a figure \[px\].
const REMARK: f64 = 20.0;

/// Colours, type and strokes of every figure; light, dark and print.
pub const STYLE: &str = include_str!("plot.css");

/// The page on which a browser prints a figure alone: as large as the figure, in whole points.
fn sheet(width: f64, height: f64) -> String {
    let points = |px: f64| (px * 0.75).ceil();
    format!("@page{{size:{}pt {}pt;margin:0}}", points(width), points(height))
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    #[default]
    Line,
    Points,
    Bar,
    /// Lines, true to scale.
    Drawing,
    /// Colours over both axes.
    Map,
    /// Points, and the steps between what they beat and what nobody reaches.
    Front,
    /// Depths of a profile or a lead, drawn downwards and so many times as long.
    Chart,
    /// Bars from one place to another; a run of two points each.
    Histogram,
    /// Bands between series that belong together, the first and the last, and so on; a line in the middle.
    Quantiles,
    /// Bars to the right, the largest on top; the y of a point is the index of its name.
    Tornado,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    pub label: String,
    pub unit: String,
    pub is_log: bool,
}

/// Something that a series is told apart by.
#[derive(Clone, Debug, PartialEq)]
pub enum Of {
    Word(String),
    /// A number of a column.
    Quantity {
        column: String,
        value: f64,
    },
}

/// Points of one look; a line is interrupted between runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    pub label: String,
    /// As the table has it, where `label` is what the study calls it.
    pub raw: String,
    /// Of one of these it has its colour: of the first, unless only another one stands alone somewhere on the page.
    pub of: Vec<Of>,
    pub look: Look,
    /// Of a drawing, where its table tells it.
    pub line: Option<Line>,
    pub runs: Vec<Vec<(f64, f64)>>,
}

impl Series {
    #[must_use]
    pub fn new(label: &str, runs: Vec<Vec<(f64, f64)>>) -> Self {
        let (label, of) = (label.to_owned(), vec![Of::Word(label.to_owned())]);
        Self { raw: label.clone(), label, of, look: Look::of(0), line: None, runs }
    }
}

/// A published point, or a line across (`x` is none) or upright (`y` is none).
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    pub label: String,
    pub x: Option<f64>,
    pub y: Option<f64>,
    pub look: Look,
}

/// A point with its name beside it.
#[derive(Clone, Debug, PartialEq)]
pub struct Named {
    pub name: String,
    pub place: (f64, f64),
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plot {
    pub title: String,
    pub kind: Kind,
    pub x: Axis,
    pub y: Axis,
    pub series: Vec<Series>,
    pub marks: Vec<Mark>,
    pub named: Vec<Named>,
    /// Names under or beside the bars; the x of a point, or its y, is their index.
    pub categories: Vec<String>,
    /// Of a map.
    pub cells: Option<Cells>,
    pub size: Size,
    /// Of a chart: the length that a unit of the x axis stands for, in units of the y axis.
    pub length: Option<f64>,
    /// The tables that it would be drawn from if they had rows.
    pub without_rows: Vec<String>,
    /// Points for which a logarithmic axis has no place.
    pub lost: usize,
}

impl Plot {
    /// With nothing in it.
    #[must_use]
    pub fn new(title: &str, kind: Kind) -> Self {
        Self { title: title.to_owned(), kind, ..Self::default() }
    }

    /// What a reader would look for in vain; empty where that is nothing.
    #[must_use]
    pub fn remark(&self) -> String {
        let rows = match &self.without_rows[..] {
            [] => String::new(),
            [one] => format!("table {one} has no rows"),
            several => format!("tables {} have no rows", several.join(", ")),
        };
        let lost = match self.lost {
            0 => String::new(),
            1 => "1 point at or below 0 is not drawn".to_owned(),
            many => format!("{many} points at or below 0 are not drawn"),
        };
        [rows, lost].into_iter().filter(|said| !said.is_empty()).collect::<Vec<_>>().join("; ")
    }

    /// Whether a point with values has no place, because an axis is logarithmic; of a line across one of them is told.
    pub(super) fn loses(&self, x: Option<f64>, y: Option<f64>) -> bool {
        let is_number = |value: Option<f64>| value.is_none_or(f64::is_finite);
        let is_below = |axis: &Axis, value: Option<f64>| axis.is_log && value.is_some_and(|value| value <= 0.0);
        is_number(x) && is_number(y) && (is_below(&self.x, x) || is_below(&self.y, y))
    }

    /// Whether there is anything to draw.
    #[must_use]
    pub fn is_drawn(&self) -> bool {
        self.frame(0.0, Layout::PAGE).is_some()
    }

    /// The figure as a file of its own, with style, background, title and legend.
    #[must_use]
    pub fn file(&self) -> String {
        let layout = Layout::of_file(self.size);
        let legend = self.legend();
        let Some(frame) = self.frame(0.0, layout) else { return self.empty(layout) };
        let rows = legend::rows(&legend, frame.left + frame.width, layout.character);
        let legend_height = if legend.is_empty() { 8.0 } else { 12.0 + 22.0 * rows.len() as f64 };
        let frame = Frame { top: layout.title + legend_height, ..frame };
        let (width, mut height) = self.extent(&frame);
        let remark = self.remark();
        if !remark.is_empty() {
            height += REMARK;
        }
        let scale = match self.size {
            Size::Page => format!(r#"width="{}" height="{}""#, at(width), at(height)),
            // 96 to the inch, as CSS has it: a column is 90 mm.
            Size::Column => {
                format!(r#"width="{}mm" height="{}mm""#, at(width * 25.4 / 96.0), at(height * 25.4 / 96.0))
            }
        };
        let class = if self.size == Size::Column { "plot column" } else { "plot" };
        let mut svg = format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" class="{class}" viewBox="0 0 {} {}" role="img" aria-label="{}" {scale}><style>{}{STYLE}</style><rect class="paper" width="100%" height="100%"/>"#,
            at(width),
            at(height),
            escape(&self.title),
            sheet(width, height)
        );
        // A journal has a caption of its own.
        if self.size == Size::Page {
            let _ = write!(svg, r#"<text class="title" x="16" y="26">{}</text>"#, escape(&self.title));
        }
        legend::draw(&mut svg, &legend, &rows, (frame.left, layout.title), layout.character);
        if !remark.is_empty() {
            let (x, y) = (at(frame.left), at(height - 0.4 * REMARK));
            let _ = write!(svg, r#"<text x="{x}" y="{y}">{}</text>"#, escape(&remark));
        }
        self.draw(&mut svg, &frame);
        svg
    }

    /// The figure in a page, which has its style, and shows title and legend itself.
    #[must_use]
    pub fn inline(&self) -> String {
        let layout = Layout::PAGE;
        let Some(frame) = self.frame(8.0, layout) else { return self.empty(layout) };
        let (width, height) = self.extent(&frame);
        let mut svg = format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" class="plot" viewBox="0 0 {} {}" role="img" style="max-width:{}px" aria-label="{}" data-plot="{}">"#,
            at(width),
            at(height),
            // Larger would be crude, smaller would leave blank beside it.
            at(1.3 * width),
            escape(&self.title),
            escape(&self.data(&frame))
        );
        self.draw(&mut svg, &frame);
        svg
    }

    /// How wide the figure in a page is drawn, where two have room beside each other.
    #[must_use]
    pub fn narrow(&self) -> Option<f64> {
        let frame = self.frame(0.0, Layout::PAGE)?;
        let width = self.extent(&frame).0;
        (width < 680.0).then_some(width.round().min(535.0))
    }

    /// Axes and data, and the end of the figure.
    fn draw(&self, svg: &mut String, frame: &Frame) {
        svg.push_str(r#"<g class="axes">"#);
        self.draw_axes(svg, frame);
        svg.push_str("</g>");
        // A frame of its own cuts off what lies outside.
        let view = [frame.left - ROOM, frame.top - ROOM, frame.width + 2.0 * ROOM, frame.height + 2.0 * ROOM];
        let [x, y, width, height] = view.map(at);
        let _ = write!(
            svg,
            r#"<svg class="data" x="{x}" y="{y}" width="{width}" height="{height}" viewBox="{x} {y} {width} {height}">"#
        );
        match self.kind {
            Kind::Line | Kind::Drawing | Kind::Chart => self.draw_lines(svg, frame),
            Kind::Points => self.draw_points(svg, frame),
            Kind::Front => {
                self.draw_steps(svg, frame);
                self.draw_points(svg, frame);
            }
            Kind::Bar => self.draw_bars(svg, frame),
            Kind::Histogram => self.draw_histogram(svg, frame),
            Kind::Quantiles => self.draw_bands(svg, frame),
            Kind::Tornado => self.draw_tornado(svg, frame),
            Kind::Map => self.cells.iter().for_each(|cells| cells.draw(svg, frame)),
        }
        self.draw_marks(svg, frame);
        self.draw_named_points(svg, frame);
        self.draw_named(svg, frame);
        svg.push_str("</svg>");
        self.cells.iter().for_each(|cells| cells.draw_scale(svg, frame));
        svg.push_str("</svg>");
    }

    fn empty(&self, layout: Layout) -> String {
        let (title, width) = (escape(&self.title), at(layout.width));
        let why = Some(self.remark()).filter(|remark| !remark.is_empty());
        let why = why.map_or_else(|| "there is no finite value to draw".to_owned(), |why| escape(&why));
        format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" class="plot" viewBox="0 0 {width} 80" role="img" aria-label="{title}"><style>{STYLE}</style><text class="label" x="16" y="44">{title}: {why}</text></svg>"#
        )
    }

    /// What the legend names; empty where one series stands alone.
    #[must_use]
    pub fn legend(&self) -> Vec<Item> {
        if self.kind == Kind::Quantiles {
            return self.legend_of_bands();
        }
        let is_alone = self.series.len() < 2 && self.marks.is_empty();
        let series = self.series.iter().enumerate().filter(|(_, series)| !is_alone && !self.is_named_point(series));
        let mut items: Vec<Item> = series
            .map(|(index, series)| Item {
                label: if series.label.is_empty() { "computed".to_owned() } else { series.label.clone() },
                key: format!("s{index}"),
                sign: match self.kind {
                    Kind::Points | Kind::Front => Sign::Marker,
                    Kind::Bar | Kind::Histogram | Kind::Tornado => Sign::Square,
                    _ if self.shows_points(series) => Sign::LineAndMarker,
                    _ => Sign::Line,
                },
                look: series.look,
            })
            .collect();
        for mark in &self.marks {
            let shares_name = self.series.iter().any(|series| series.label == mark.label);
            let label = if shares_name { format!("{}, published", mark.label) } else { mark.label.clone() };
            let sign = if mark.x.is_some() && mark.y.is_some() { Sign::PublishedPoint } else { Sign::PublishedLine };
            if !items.iter().any(|item| item.label == label && item.sign == sign) {
                items.push(Item { label, key: self.key_of(mark), sign, look: mark.look });
            }
        }
        items
    }

    /// Marks of one name are shown and hidden together.
    pub(super) fn key_of(&self, mark: &Mark) -> String {
        let first = self.marks.iter().position(|other| other.label == mark.label).unwrap_or(0);
        format!("m{first}")
    }

    /// Of a line of few points it is shown where they are: what is between them is only a guide.
    pub(super) fn shows_points(&self, series: &Series) -> bool {
        self.kind == Kind::Line && series.runs.iter().map(Vec::len).sum::<usize>() <= 24
    }
}
