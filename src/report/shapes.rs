//! Series as paths: lines with their jumps, points, bars.
//!
//! Places are absolute and shapes about them relative, so that the page's script can move places to other axes. Must not
//! know: axes, tables.

use std::cmp::Reverse;
use std::fmt::Write;

use super::frame::Frame;
use super::plot::{Kind, Plot, Series};
use super::svg::at;

impl Plot {
    pub(super) fn draw_lines(&self, svg: &mut String, frame: &Frame) {
        let mut lines: Vec<(usize, &Series)> =
            self.series.iter().enumerate().filter(|(_, series)| !self.is_named_point(series)).collect();
        // Bodies above what helps to read them.
        lines.sort_by_key(|(_, series)| Reverse(series.line));
        for (index, series) in lines {
            let style = series.look.stroke();
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
            let _ = write!(svg, r#"<g data-s="s{index}">"#);
            if !jumps.is_empty() {
                let _ = write!(svg, r#"<path class="jump" {} d="{jumps}"/>"#, series.look.colour.stroke());
            }
            let _ = write!(svg, r#"<path class="series" {style} d="{line}"/>"#);
            if self.shows_points(series) {
                markers(svg, frame, series);
            }
            svg.push_str("</g>");
        }
    }

    /// From point to point of a front, along what the ones to the left still beat.
    pub(super) fn draw_steps(&self, svg: &mut String, frame: &Frame) {
        for (index, series) in self.series.iter().enumerate() {
            let mut points: Vec<(f64, f64)> =
                series.runs.iter().flatten().filter(|(x, y)| x.is_finite() && y.is_finite()).copied().collect();
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut line = String::new();
            for (x, y) in points.into_iter().filter_map(|point| frame.place(point)) {
                let _ = if line.is_empty() {
                    write!(line, "M{} {}", at(x), at(y))
                } else {
                    write!(line, "H{}V{}", at(x), at(y))
                };
            }
            let stroke = series.look.colour.stroke();
            let _ = write!(svg, r#"<g data-s="s{index}"><path class="jump" {stroke} d="{line}"/></g>"#);
        }
    }

    pub(super) fn draw_points(&self, svg: &mut String, frame: &Frame) {
        for (index, series) in self.series.iter().enumerate() {
            let _ = write!(svg, r#"<g data-s="s{index}">"#);
            markers(svg, frame, series);
            svg.push_str("</g>");
        }
    }

    pub(super) fn draw_bars(&self, svg: &mut String, frame: &Frame) {
        let slot = frame.width / self.categories.len().max(1) as f64;
        let bar = (0.78 * slot / self.series.len().max(1) as f64).min(64.0);
        let base = if frame.y.is_log { frame.bottom() } else { frame.y(0.0) };
        for (index, series) in self.series.iter().enumerate() {
            let offset = (index as f64 - 0.5 * self.series.len() as f64) * bar;
            let mut path = String::new();
            for (x, y) in series.runs.iter().flatten().filter_map(|&point| frame.place(point)) {
                let (left, right) = (at(x + offset + 0.5), at(x + offset + bar - 0.5));
                let _ = write!(path, "M{left} {}H{right}V{}H{left}Z", at(base), at(y));
            }
            let _ = write!(svg, r#"<g data-s="s{index}"><path class="bar" {} d="{path}"/></g>"#, series.look.bar());
        }
    }
}

/// All points of a series as one path.
fn markers(svg: &mut String, frame: &Frame, series: &Series) {
    let (class, shape) = series.look.marker();
    let mut path = String::new();
    for (x, y) in series.runs.iter().flatten().filter_map(|&point| frame.place(point)) {
        let _ = write!(path, "M{} {}{shape}", at(x), at(y));
    }
    let style = if class == "sign" { series.look.colour.fill() } else { series.look.colour.stroke() };
    let _ = write!(svg, r#"<path class="{class}" {style} d="{path}"/>"#);
}
