//! The axes of a figure: the frame between them, grid, ticks, labels.
//!
//! Must not know: what is drawn between them.

use std::fmt::Write;

use super::cells::Cells;
use super::drawing::true_to_scale;
use super::frame::{Frame, Layout, exaggerated};
use super::plot::{Axis, Kind, Plot};
use super::scale::{Scale, Tick, with_power};
use super::svg::{at, escape};
use declare::number::{significant, unit_symbol};

/// A drawing whose frame is wider has no other beside it \[px\].
const ALONE: f64 = 590.0;

impl Plot {
    fn points(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.series.iter().flat_map(|series| series.runs.iter().flatten().copied())
    }

    /// `None` where there is no finite value.
    pub(super) fn frame(&self, top: f64, layout: Layout) -> Option<Frame> {
        let edges = |pick: fn(&Cells) -> &[f64]| self.cells.iter().flat_map(pick).copied().collect::<Vec<f64>>();
        let named = || self.named.iter().map(|named| named.place);
        let xs = self.points().chain(named()).map(|point| point.0).chain(self.marks.iter().filter_map(|mark| mark.x));
        let ys = self.points().chain(named()).map(|point| point.1).chain(self.marks.iter().filter_map(|mark| mark.y));
        let (xs, ys) = (xs.chain(edges(|cells| &cells.xs)), ys.chain(edges(|cells| &cells.ys)));
        let x = if self.kind == Kind::Bar {
            Scale { low: -0.5, high: self.categories.len().max(1) as f64 - 0.5, is_log: false }
        } else {
            // A point at the very edge would be cut in half.
            let margin = if matches!(self.kind, Kind::Points | Kind::Front | Kind::Drawing)
                || self.marks.iter().any(|mark| mark.x.is_some())
            {
                0.02
            } else {
                0.0
            };
            let scale = Scale::around(xs, self.x.is_log, 0.0, self.kind == Kind::Tornado)?;
            let room = if scale.is_log { 0.0 } else { margin * (scale.high - scale.low) };
            Scale { low: scale.low - room, high: scale.high + room, ..scale }
        };
        // A drawing or a map need not show where zero is.
        let room = if matches!(self.kind, Kind::Drawing | Kind::Map) { 0.0 } else { 0.06 };
        let bars = matches!(self.kind, Kind::Bar | Kind::Histogram);
        let from_zero = (bars && !self.y.is_log) || self.kind == Kind::Chart;
        let is_lying = self.kind == Kind::Tornado;
        let names = || Scale { low: -0.5, high: self.categories.len().max(1) as f64 - 0.5, is_log: false };
        let y = if is_lying { names() } else { Scale::around(ys, self.y.is_log, room, from_zero)? };
        let longest = if is_lying {
            self.categories.iter().map(|name| name.chars().count()).max().unwrap_or(0)
        } else {
            y.ticks(layout.ticks[1]).iter().map(|tick| tick.label.chars().count()).max().unwrap_or(0)
        };
        let left = 8.0 + 6.0 * layout.character + layout.character * longest as f64;
        let right = layout.right + if self.kind == Kind::Map { 11.0 * layout.character } else { 0.0 };
        let width = layout.width - left - right;
        let (x, y, width, height) = if self.kind == Kind::Drawing {
            let [beside, alone] = layout.tallest;
            let tallest = if (x.high - x.low) * beside > ALONE * (y.high - y.low) { alone } else { beside };
            true_to_scale(x, y, width, tallest)
        } else {
            (x, y, width, layout.height)
        };
        let is_downward = self.kind == Kind::Chart || is_lying;
        let frame = Frame { left, top, width, height, x, y, is_downward, exaggeration: None, layout };
        Some(self.length.map_or(frame, |length| exaggerated(frame, length)))
    }

    /// Width and height of the whole figure.
    pub(super) fn extent(&self, frame: &Frame) -> (f64, f64) {
        let right = frame.layout.right + if self.kind == Kind::Map { 11.0 * frame.layout.character } else { 0.0 };
        let below = if self.slants_categories(frame) { 112.0 } else { frame.layout.below };
        (frame.right() + right, frame.bottom() + below)
    }

    pub(super) fn slants_categories(&self, frame: &Frame) -> bool {
        if self.kind == Kind::Tornado {
            return false;
        }
        let longest = self.categories.iter().map(|name| name.chars().count()).max().unwrap_or(0);
        frame.layout.character * longest as f64 > 0.94 * frame.width / self.categories.len().max(1) as f64
    }

    pub(super) fn draw_axes(&self, svg: &mut String, frame: &Frame) {
        let (left, right, top, bottom) = (at(frame.left), at(frame.right()), at(frame.top), at(frame.bottom()));
        let is_slanted = self.slants_categories(frame);
        // Where nothing varies along y, its values say nothing.
        let is_flat = self.cells.as_ref().is_some_and(Cells::has_one_row);
        let is_lying = self.kind == Kind::Tornado;
        if is_lying {
            self.name_bars(svg, frame);
        }
        for Tick { value, label } in frame.y.ticks(frame.layout.ticks[1]).into_iter().filter(|_| !is_flat && !is_lying)
        {
            let y = frame.y(value);
            // What depths are counted from.
            let class = if self.kind == Kind::Chart && value == 0.0 { "axis" } else { "grid" };
            let _ = write!(svg, r#"<path class="{class}" d="M{left} {0}H{right}"/>"#, at(y));
            let _ = write!(
                svg,
                r#"<text class="tick" x="{}" y="{}" text-anchor="end">{label}</text>"#,
                at(frame.left - 8.0),
                at(y + 4.5)
            );
        }
        if self.kind == Kind::Bar {
            self.draw_categories(svg, frame, is_slanted);
        } else {
            for Tick { value, label } in frame.x.ticks(frame.layout.ticks[0]) {
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
        let (x_power, y_power) =
            (if self.kind == Kind::Bar { 0 } else { frame.x.power() }, if is_lying { 0 } else { frame.y.power() });
        let label_y = frame.bottom() + if is_slanted { 100.0 } else { frame.layout.label };
        let middle = at(frame.left + frame.width / 2.0);
        let _ = write!(
            svg,
            r#"<text class="label" x="{middle}" y="{}" text-anchor="middle">{}</text>"#,
            at(label_y),
            escape(&axis_label(&self.x, x_power))
        );
        let middle = at(frame.top + frame.height / 2.0);
        let label = match frame.exaggeration {
            Some(factor) => format!("{}, {} : 1", axis_label(&self.y, y_power), significant(factor, 2)),
            None if is_flat => self.y.label.clone(),
            None => axis_label(&self.y, y_power),
        };
        let x = at(2.3 * frame.layout.character);
        let _ = write!(
            svg,
            r#"<text class="label" x="{x}" y="{middle}" text-anchor="middle" transform="rotate(-90 {x} {middle})">{}</text>"#,
            escape(&label)
        );
    }

    /// Names beside lying bars.
    fn name_bars(&self, svg: &mut String, frame: &Frame) {
        for (index, name) in self.categories.iter().enumerate() {
            let (x, y, name) = (at(frame.left - 8.0), at(frame.y(index as f64) + 4.5), escape(name));
            let _ = write!(svg, r#"<text class="tick name" x="{x}" y="{y}" text-anchor="end">{name}</text>"#);
        }
    }

    fn draw_categories(&self, svg: &mut String, frame: &Frame, is_slanted: bool) {
        for (index, name) in self.categories.iter().enumerate() {
            let (x, y) = (frame.x(index as f64), frame.bottom() + 19.0);
            let (x, y, name) = (at(x), at(y), escape(name));
            let _ = if is_slanted {
                write!(
                    svg,
                    r#"<text class="tick name" x="{x}" y="{y}" text-anchor="end" transform="rotate(-28 {x} {y})">{name}</text>"#
                )
            } else {
                write!(svg, r#"<text class="tick name" x="{x}" y="{y}" text-anchor="middle">{name}</text>"#)
            };
        }
    }
}

fn axis_label(axis: &Axis, power: i32) -> String {
    with_power(&axis.label, &unit_symbol(&axis.unit), power)
}
