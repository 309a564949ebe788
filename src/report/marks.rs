//! What stands on a figure by itself: published values, and the named points of a drawing.
//!
//! Must not know: lines, axes, tables.

use std::fmt::Write;

use super::plot::{Frame, Kind, Plot, Series};
use super::svg::{at, escape};

impl Plot {
    /// A series of a drawing that is made of single points is named where it stands, not in the legend.
    pub(super) fn is_named_point(&self, series: &Series) -> bool {
        self.kind == Kind::Drawing && series.runs.iter().all(|run| run.len() == 1)
    }

    pub(super) fn draw_named_points(&self, svg: &mut String, frame: &Frame) {
        for series in self.series.iter().filter(|series| self.is_named_point(series)) {
            for (x, y) in series.runs.iter().flatten().filter_map(|&point| frame.place(point)) {
                let _ = write!(
                    svg,
                    r#"<circle class="point" cx="{}" cy="{}" r="4"/><text class="point" x="{}" y="{}">{}</text>"#,
                    at(x),
                    at(y),
                    at(x + 9.0),
                    at(y - 8.0),
                    escape(&series.label)
                );
            }
        }
    }

    pub(super) fn draw_marks(&self, svg: &mut String, frame: &Frame) {
        for mark in &self.marks {
            let colour = self.colour_of_mark(mark);
            let x = mark.x.map(|x| frame.x(x)).filter(|x| x.is_finite());
            let y = mark.y.map(|y| frame.y(y)).filter(|y| y.is_finite());
            let style = colour.stroke();
            let _ = match (x, y) {
                (Some(x), Some(y)) => {
                    write!(svg, r#"<path class="mark" {style} d="M{} {}l6 6l-6 6l-6 -6z"/>"#, at(x), at(y - 6.0))
                }
                (Some(x), None) if mark.y.is_none() => {
                    write!(
                        svg,
                        r#"<path class="dashes" {style} d="M{} {}V{}"/>"#,
                        at(x),
                        at(frame.top),
                        at(frame.bottom())
                    )
                }
                (None, Some(y)) if mark.x.is_none() => {
                    write!(
                        svg,
                        r#"<path class="dashes" {style} d="M{} {}H{}"/>"#,
                        at(frame.left),
                        at(y),
                        at(frame.right())
                    )
                }
                _ => Ok(()),
            };
        }
    }
}
