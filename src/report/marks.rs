//! What stands on a figure by itself: published values, and the named points of a drawing.
//!
//! Must not know: lines, axes, tables.

use std::fmt::Write;

use super::frame::Frame;
use super::plot::{Kind, Plot, Series};
use super::svg::{at, escape};

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
