//! Where points are placed: the frame between the axes, and how large the parts of a figure are.
//!
//! Must not know: SVG, how series are drawn.

use super::drawing::true_to_scale;
use super::plot::{Kind, Plot, Size};
use super::scale::{Scale, rounded_down};

/// A drawing whose frame is wider has no other beside it \[px\].
const ALONE: f64 = 590.0;

/// Lengths in px.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    pub width: f64,
    /// Of the frame.
    height: f64,
    /// The tallest frame of a drawing that others stand beside, and of one that is alone in its row, which it fills.
    tallest: [f64; 2],
    right: f64,
    /// Room for a title.
    pub title: f64,
    /// Average width of a character at the size of a label: browsers differ, so places that depend on it leave room.
    pub character: f64,
    /// Room for the label of the x axis, and where it stands.
    below: f64,
    pub label: f64,
    /// About so many ticks has an axis.
    pub ticks: [usize; 2],
}

impl Layout {
    pub const PAGE: Self = Self {
        width: 920.0,
        height: 340.0,
        tallest: [440.0, 540.0],
        right: 18.0,
        title: 0.0,
        character: 7.0,
        below: 58.0,
        label: 46.0,
        ticks: [8, 6],
    };

    pub const fn of_file(size: Size) -> Self {
        match size {
            Size::Page => Self { title: 34.0, tallest: [820.0; 2], ..Self::PAGE },
            Size::Column => Self {
                width: 340.0,
                height: 190.0,
                tallest: [400.0; 2],
                right: 12.0,
                title: 2.0,
                character: 5.7,
                below: 44.0,
                label: 36.0,
                ticks: [5, 5],
            },
        }
    }
}

#[derive(Clone, Copy, Debug)]
pub struct Frame {
    pub left: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
    pub x: Scale,
    pub y: Scale,
    /// Depths grow downwards.
    pub is_downward: bool,
    /// Of a chart: how many times as long as what is along the x axis a depth is drawn.
    pub exaggeration: Option<f64>,
    pub layout: Layout,
}

impl Frame {
    pub fn x(&self, value: f64) -> f64 {
        self.left + self.width * self.x.share(value)
    }

    pub fn y(&self, value: f64) -> f64 {
        let share = self.y.share(value);
        self.top + self.height * if self.is_downward { share } else { 1.0 - share }
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
    fn points(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.series.iter().flat_map(|series| series.runs.iter().flatten().copied())
    }

    /// `None` where there is no finite value.
    pub(super) fn frame(&self, top: f64, layout: Layout) -> Option<Frame> {
        let edges =
            |pick: fn(&super::cells::Cells) -> &[f64]| self.cells.iter().flat_map(pick).copied().collect::<Vec<f64>>();
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
}

/// Lower, so that the factor is a round number and nothing stays blank below the greatest depth.
fn exaggerated(frame: Frame, length: f64) -> Frame {
    let along = frame.width / ((frame.x.high - frame.x.low) * length);
    let depths = frame.y.high - frame.y.low;
    let factor = rounded_down(frame.height / depths / along);
    let height = factor * along * depths;
    let fits = factor.is_finite() && factor > 0.0 && height.is_finite();
    if fits { Frame { height, exaggeration: Some(factor), ..frame } } else { frame }
}

#[cfg(test)]
mod tests {
    use super::super::plot::Series;
    use super::*;

    #[test]
    fn depths_are_drawn_a_round_number_of_times_as_long() {
        for (depth, length, along) in [(12.0, 1000.0, 9.0), (0.3, 523.6, 14.0), (80.0, 1e3, 2.5)] {
            let line = vec![(10.0, 0.0), (10.0 + along, depth)];
            // A unit along x is so many units of depth long.
            let plot =
                Plot { series: vec![Series::new("", vec![line])], length: Some(length), ..Plot::new("t", Kind::Chart) };
            let frame = plot.frame(0.0, Layout::PAGE).unwrap();
            let factor = frame.exaggeration.unwrap();
            let drawn = (frame.y(depth) - frame.y(0.0)) / depth;
            let path = (frame.x(10.0 + along) - frame.x(10.0)) / (along * length);
            assert!((drawn / path / factor - 1.0).abs() < 1e-12, "{factor}");
            assert_eq!(factor.to_bits(), rounded_down(factor).to_bits(), "{factor} is round");
            assert!(frame.y.share(depth) > 0.9, "the depth fills the chart");
            assert!(frame.height > 0.6 * Layout::PAGE.height, "{factor}: {} px high", frame.height);
            assert!(frame.y(depth) > frame.y(0.0) && frame.y(depth) <= frame.bottom(), "downwards, inside");
        }
    }
}
