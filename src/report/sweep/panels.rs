//! The small drawings of a sweep, one beside the other: cells of colour, a line in its band, bars.
//!
//! Must not know: tables, what is drawn.

use std::fmt::Write;

use super::super::scale::{Scale, with_power};
use super::super::svg::{at, escape};
use declare::number::significant;

/// A column and the symbol of its unit.
pub struct Named {
    pub name: String,
    pub unit: String,
}

/// Room around what is drawn \[px\].
const LEFT: f64 = 62.0;
const RIGHT: f64 = 12.0;
const ABOVE: f64 = 26.0;
const BELOW: f64 = 46.0;
/// Of lines and bars, and of cells with the scale of their colours.
const SMALL: [f64; 2] = [270.0, 180.0];
const LARGE: [f64; 2] = [370.0, 260.0];
const LEGEND: f64 = 86.0;
/// Values along an axis that have their label, at most.
const LABELS: usize = 6;

struct Panel {
    svg: String,
    size: [f64; 2],
}

impl Panel {
    fn new(size: [f64; 2], beside: f64, label: &str, title: &str) -> Self {
        let (width, height) = (LEFT + size[0] + beside, ABOVE + size[1] + BELOW);
        let mut panel = Self { svg: String::new(), size };
        let _ = write!(
            panel.svg,
            r#"<svg class="plot" viewBox="0 0 {0} {1}" width="{0}" height="{1}" role="img" aria-label="{2}">"#,
            at(width),
            at(height),
            escape(label)
        );
        panel.text("tick", [LEFT, ABOVE - 9.0], "start", title);
        panel
    }

    fn text(&mut self, class: &str, [x, y]: [f64; 2], anchor: &str, text: &str) {
        let (x, y, text) = (at(x), at(y), escape(text));
        let _ = write!(self.svg, r#"<text class="{class}" x="{x}" y="{y}" text-anchor="{anchor}">{text}</text>"#);
    }

    fn x(&self, share: f64) -> f64 {
        LEFT + self.size[0] * share
    }

    fn y(&self, share: f64) -> f64 {
        ABOVE + self.size[1] * (1.0 - share)
    }

    /// Ticks at round values, with lines behind what is drawn.
    fn axes(&mut self, scales: [&Scale; 2], [across, up]: [&Named; 2]) {
        let (right, bottom) = (self.x(1.0), self.y(0.0));
        for tick in scales[0].ticks(4) {
            let x = self.x(scales[0].share(tick.value));
            let _ = write!(self.svg, r#"<path class="grid" d="M{0} {1}V{2}"/>"#, at(x), at(ABOVE), at(bottom));
            self.text("tick", [x, bottom + 17.0], "middle", &tick.label);
        }
        for tick in scales[1].ticks(4) {
            let y = self.y(scales[1].share(tick.value));
            let _ = write!(self.svg, r#"<path class="grid" d="M{0} {1}H{2}"/>"#, at(LEFT), at(y), at(right));
            self.text("tick", [LEFT - 7.0, y + 4.5], "end", &tick.label);
        }
        self.names([
            with_power(&across.name, &across.unit, scales[0].power()),
            with_power(&up.name, &up.unit, scales[1].power()),
        ]);
    }

    fn names(&mut self, [across, up]: [String; 2]) {
        self.text("label", [self.x(0.5), self.y(0.0) + 37.0], "middle", &across);
        let (x, y) = (at(15.0), at(self.y(0.5)));
        let up = escape(&up);
        let _ = write!(
            self.svg,
            r#"<text class="label" x="{x}" y="{y}" text-anchor="middle" transform="rotate(-90 {x} {y})">{up}</text>"#
        );
    }

    fn rectangle(&mut self, [left, top, right, bottom]: [f64; 4], fill: &str, title: &str) {
        let (x, y, width, height) = (at(left), at(top), at(right - left), at(bottom - top));
        let title = escape(title);
        let _ = write!(
            self.svg,
            r#"<rect x="{x}" y="{y}" width="{width}" height="{height}" style="fill:{fill}"><title>{title}</title></rect>"#
        );
    }

    fn finish(mut self) -> String {
        let (left, right, top, bottom) = (at(LEFT), at(self.x(1.0)), at(ABOVE), at(self.y(0.0)));
        let _ = write!(self.svg, r#"<path class="axis" d="M{left} {top}V{bottom}H{right}"/></svg>"#);
        self.svg
    }
}

/// From the smallest to the largest, some room where all are one.
fn scale(values: impl Iterator<Item = f64>, from_zero: bool) -> Scale {
    Scale::around(values, false, 0.0, from_zero).unwrap_or(Scale { low: 0.0, high: 1.0, is_log: false })
}

/// Cells of x, y and value; rows and columns of cells are equally wide, whatever lies between their values.
pub fn cells(title: &str, [across, up, value]: [Named; 3], cells: &[[f64; 3]]) -> String {
    let distinct = |axis: usize| {
        let mut all: Vec<f64> = cells.iter().map(|cell| cell[axis]).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    };
    let (columns, lines) = (distinct(0), distinct(1));
    let colours = scale(cells.iter().map(|cell| cell[2]), false);
    let label = format!("{}, {title}, over {} and {}", value.name, across.name, up.name);
    let mut panel = Panel::new(LARGE, LEGEND, &label, title);
    let place = |values: &[f64], value: f64| values.partition_point(|other| *other < value) as f64;
    for [x, y, shown] in cells.iter().filter(|cell| cell[2].is_finite()) {
        let (column, line) = (place(&columns, *x), place(&lines, *y));
        let (wide, high) = (columns.len() as f64, lines.len() as f64);
        let said = format!(
            "{} = {}, {} = {}: {}",
            across.name,
            significant(*x, 4),
            up.name,
            significant(*y, 4),
            significant(*shown, 4)
        );
        // A little over its neighbours: no paper shines through.
        let right = (panel.x((column + 1.0) / wide) + 0.4).min(panel.x(1.0));
        let bottom = (panel.y(line / high) + 0.4).min(panel.y(0.0));
        let rectangle = [panel.x(column / wide), panel.y((line + 1.0) / high), right, bottom];
        panel.rectangle(rectangle, &colour(colours.share(*shown)), &said);
    }
    let some = |count: usize| (0..count).step_by(count.div_ceil(LABELS).max(1));
    for at in some(columns.len()) {
        let x = panel.x((at as f64 + 0.5) / columns.len() as f64);
        panel.text("tick", [x, panel.y(0.0) + 17.0], "middle", &significant(columns[at], 3));
    }
    for at in some(lines.len()) {
        let y = panel.y((at as f64 + 0.5) / lines.len() as f64);
        panel.text("tick", [LEFT - 7.0, y + 4.5], "end", &significant(lines[at], 3));
    }
    panel.names([with_power(&across.name, &across.unit, 0), with_power(&up.name, &up.unit, 0)]);
    // The scale of the colours.
    let left = panel.x(1.0) + 16.0;
    for step in 0..STEPS {
        let (from, to) = (f64::from(step) / f64::from(STEPS), f64::from(step + 1) / f64::from(STEPS));
        let rectangle = [left, panel.y(to), left + 14.0, (panel.y(from) + 0.4).min(panel.y(0.0))];
        panel.rectangle(rectangle, &colour(0.5 * (from + to)), "");
    }
    for tick in colours.ticks(5) {
        panel.text("tick", [left + 19.0, panel.y(colours.share(tick.value)) + 4.5], "start", &tick.label);
    }
    let unit = with_power("", &value.unit, colours.power());
    panel.text("tick", [left, ABOVE - 9.0], "start", unit.trim());
    panel.finish()
}

const STEPS: u8 = 40;

/// From dark blue, small, to pale yellow, large: lightness grows all the way, so that it is read without colours too.
fn colour(share: f64) -> String {
    const STOPS: [[f64; 3]; 5] =
        [[31.0, 26.0, 84.0], [45.0, 86.0, 138.0], [43.0, 145.0, 140.0], [122.0, 200.0, 104.0], [250.0, 231.0, 120.0]];
    let place = share.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    // From 0 to 4.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let index = (place as usize).min(STOPS.len() - 2);
    let part = |channel: usize| {
        STOPS[index][channel] + (place - index as f64) * (STOPS[index + 1][channel] - STOPS[index][channel])
    };
    format!("rgb({:.0} {:.0} {:.0})", part(0), part(1), part(2))
}

/// Points of x, lower end, middle and upper end; `vertical` are values of which the scale has all.
pub fn band(title: &str, [across, up]: [Named; 2], points: &[[f64; 4]], vertical: &[f64]) -> String {
    let label = format!("{} over {}, {title}", up.name, across.name);
    let scales = [scale(points.iter().map(|point| point[0]), false), scale(vertical.iter().copied(), false)];
    let mut panel = Panel::new(SMALL, RIGHT, &label, title);
    panel.axes([&scales[0], &scales[1]], [&across, &up]);
    let place = |point: &[f64; 4], of: usize| {
        format!("{} {}", at(panel.x(scales[0].share(point[0]))), at(panel.y(scales[1].share(point[of]))))
    };
    let line = |of: usize| points.iter().map(|point| place(point, of)).collect::<Vec<_>>().join("L");
    let back = points.iter().rev().map(|point| place(point, 1)).collect::<Vec<_>>().join("L");
    let dots = points.iter().map(|point| place(point, 2)).collect::<Vec<_>>().join("h0M");
    let (upper, middle) = (line(3), line(2));
    let _ = write!(
        panel.svg,
        r#"<path d="M{upper}L{back}Z" style="fill:var(--s0);fill-opacity:.18"/><path class="series" style="stroke:var(--s0)" d="M{middle}"/><path class="dot" style="stroke:var(--s0)" d="M{dots}h0"/>"#
    );
    panel.finish()
}

/// Bars from, to, and how high.
pub fn bars([across, up]: [Named; 2], bars: &[[f64; 3]]) -> String {
    let label = format!("distribution of {}", across.name);
    let scales =
        [scale(bars.iter().flat_map(|bar| [bar[0], bar[1]]), false), scale(bars.iter().map(|bar| bar[2]), true)];
    let mut panel = Panel::new(SMALL, RIGHT, &label, "");
    panel.axes([&scales[0], &scales[1]], [&across, &up]);
    for [from, to, height] in bars.iter().filter(|bar| bar[2] > 0.0) {
        let (left, right) = (panel.x(scales[0].share(*from)), panel.x(scales[0].share(*to)));
        let top = panel.y(scales[1].share(*height));
        let said = format!("{} to {}: {height} {}", significant(*from, 4), significant(*to, 4), up.name);
        panel.rectangle([left + 0.6, top, (right - 0.6).max(left + 1.0), panel.y(0.0)], "var(--s0)", &said);
    }
    panel.finish()
}
