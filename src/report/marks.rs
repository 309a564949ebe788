//! What stands on a figure by itself: published values, and the named points of a drawing.
//!
//! Must not know: lines, axes, tables.

use std::fmt::Write;

use super::frame::Frame;
use super::plot::{Kind, Plot, Series};
use super::svg::{at, escape};

/// Of a named point.
const MARKER: &str = "m0-6l6 6l-6 6l-6-6z";

impl Plot {
    /// A series of a drawing that is made of single points is named where it stands, not in the legend.
    pub(super) fn is_named_point(&self, series: &Series) -> bool {
        self.kind == Kind::Drawing && series.runs.iter().all(|run| run.len() == 1)
    }

    pub(super) fn draw_named_points(&self, svg: &mut String, frame: &Frame) {
        for (index, series) in self.series.iter().enumerate().filter(|(_, series)| self.is_named_point(series)) {
            let _ = write!(svg, r#"<g data-s="s{index}">"#);
            for (x, y) in series.runs.iter().flatten().filter_map(|&point| frame.place(point)) {
                let (x, y, label) = (at(x), at(y), escape(&series.label));
                let _ = write!(
                    svg,
                    r#"<path class="dot" style="stroke:var(--ink)" d="M{x} {y}h0"/><text class="point" x="{x}" y="{y}" dx="9" dy="-8">{label}</text>"#
                );
            }
            svg.push_str("</g>");
        }
    }

    /// Points with their names beside them: of a design on a map or a front.
    pub(super) fn draw_named(&self, svg: &mut String, frame: &Frame) {
        for named in &self.named {
            let Some((x, y)) = frame.place(named.place) else { continue };
            // Beside the right edge there is no room on the right.
            let (anchor, aside) = if x > frame.left + 0.75 * frame.width { ("end", -9) } else { ("start", 9) };
            let below = if y < frame.top + 24.0 { 18 } else { -8 };
            let (x, y, name) = (at(x), at(y), escape(&named.name));
            let _ = write!(
                svg,
                r#"<path class="mark" style="stroke:var(--ink)" d="M{x} {y}{MARKER}"/><text class="point" x="{x}" y="{y}" dx="{aside}" dy="{below}" text-anchor="{anchor}">{name}</text>"#
            );
        }
    }

    pub(super) fn draw_marks(&self, svg: &mut String, frame: &Frame) {
        for mark in &self.marks {
            let x = mark.x.map(|x| frame.x(x)).filter(|x| x.is_finite());
            let y = mark.y.map(|y| frame.y(y)).filter(|y| y.is_finite());
            let (class, style, path) = match (x, y) {
                (Some(x), Some(y)) => {
                    let marker = mark.look.published_marker();
                    ("mark", mark.look.colour.stroke(), format!("M{} {}{marker}", at(x), at(y)))
                }
                (Some(x), None) if mark.y.is_none() => {
                    let path = format!("M{} {}V{}", at(x), at(frame.top), at(frame.bottom()));
                    ("dashes", mark.look.published_stroke(), path)
                }
                (None, Some(y)) if mark.x.is_none() => {
                    let path = format!("M{} {}H{}", at(frame.left), at(y), at(frame.right()));
                    ("dashes", mark.look.published_stroke(), path)
                }
                _ => continue,
            };
            let _ = write!(svg, r#"<g data-s="{}"><path class="{class}" {style} d="{path}"/></g>"#, self.key_of(mark));
        }
    }
}
