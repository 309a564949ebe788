//! The axes of a figure: grid, ticks, labels.
//!
//! Must not know: what is drawn between them.

use std::fmt::Write;

use super::frame::Frame;
use super::plot::{Axis, Kind, Plot};
use super::scale::Tick;
use super::svg::{at, escape};
use declare::number::{significant, superscript, unit_symbol};

impl Plot {
    pub(super) fn draw_axes(&self, svg: &mut String, frame: &Frame) {
        let (left, right, top, bottom) = (at(frame.left), at(frame.right()), at(frame.top), at(frame.bottom()));
        let is_slanted = self.slants_categories(frame);
        // Where nothing varies along y, its values say nothing.
        let is_flat = self.cells.as_ref().is_some_and(super::cells::Cells::has_one_row);
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

/// A quantity's name with its unit and the power of ten that its values are without.
pub fn with_power(label: &str, symbol: &str, power: i32) -> String {
    match (power, symbol.is_empty()) {
        (0, true) => label.to_owned(),
        (0, false) => format!("{label} ({symbol})"),
        (power, true) => format!("{label} (10{})", superscript(power)),
        (power, false) => format!("{label} (10{} {symbol})", superscript(power)),
    }
}

fn axis_label(axis: &Axis, power: i32) -> String {
    with_power(&axis.label, &unit_symbol(&axis.unit), power)
}
