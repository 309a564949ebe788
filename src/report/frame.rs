//! Where points are placed: the frame between the axes, and how large the parts of a figure are.
//!
//! Must not know: SVG, how series are drawn.

use super::scale::{Scale, rounded_down};

/// How large a figure is as a file of its own.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Size {
    #[default]
    Page,
    /// A column of a journal.
    Column,
}

/// Lengths in px.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    pub width: f64,
    /// Of the frame.
    pub height: f64,
    /// The tallest frame of a drawing that others stand beside, and of one that is alone in its row, which it fills.
    pub tallest: [f64; 2],
    pub right: f64,
    /// Room for a title.
    pub title: f64,
    /// Average width of a character at the size of a label: browsers differ, so places that depend on it leave room.
    pub character: f64,
    /// Room for the label of the x axis, and where it stands.
    pub below: f64,
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

/// Lower, so that the factor is a round number and nothing stays blank below the greatest depth.
pub fn exaggerated(frame: Frame, length: f64) -> Frame {
    let along = frame.width / ((frame.x.high - frame.x.low) * length);
    let depths = frame.y.high - frame.y.low;
    let factor = rounded_down(frame.height / depths / along);
    let height = factor * along * depths;
    let fits = factor.is_finite() && factor > 0.0 && height.is_finite();
    if fits { Frame { height, exaggeration: Some(factor), ..frame } } else { frame }
}

#[cfg(test)]
mod tests {
    use super::super::plot::{Kind, Plot, Series};
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
