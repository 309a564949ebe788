//! How something scatters: histograms, bands between quantiles, bars of indices.
//!
//! Must not know: axes, tables.

use std::fmt::Write;

use super::frame::Frame;
use super::legend::{Item, Sign};
use super::look::Look;
use super::plot::{Kind, Plot, Series};
use super::svg::at;

impl Plot {
    /// A bar for each run, from its first point to its last.
    pub(super) fn draw_histogram(&self, svg: &mut String, frame: &Frame) {
        let base = at(if frame.y.is_log { frame.bottom() } else { frame.y(0.0) });
        for (index, series) in self.series.iter().enumerate() {
            let mut path = String::new();
            for run in &series.runs {
                let (Some(from), Some(to)) = (run.first(), run.last()) else { continue };
                if let (Some((left, top)), Some((right, _))) = (frame.place(*from), frame.place(*to)) {
                    // A hair between two of them, and each to be seen.
                    let right = (right - 0.6).max(left + 0.8);
                    let _ = write!(path, "M{} {base}V{}H{}V{base}Z", at(left), at(top), at(right));
                }
            }
            let style = series.look.bar();
            let _ = write!(svg, r#"<g data-s="s{index}"><path class="bar" {style} d="{path}"/></g>"#);
        }
    }

    /// Bands from the widest to the narrowest, and a line where one series is left.
    pub(super) fn draw_bands(&self, svg: &mut String, frame: &Frame) {
        let path = |series: &Series, backwards: bool| {
            let mut points: Vec<(f64, f64)> =
                series.runs.iter().flatten().filter_map(|&point| frame.place(point)).collect();
            if backwards {
                points.reverse();
            }
            points.iter().map(|(x, y)| format!("{} {}", at(*x), at(*y))).collect::<Vec<_>>().join("L")
        };
        let colour = Look::of(0).colour;
        for (index, [low, high]) in self.bands().enumerate() {
            let (there, back) = (path(low, false), path(high, true));
            let _ = write!(
                svg,
                r#"<g data-s="s{index}"><path {} fill-opacity=".2" d="M{there}L{back}Z"/></g>"#,
                colour.fill()
            );
        }
        if let Some(middle) = self.middle() {
            let index = self.series.len() / 2;
            let line = path(middle, false);
            let _ = write!(svg, r#"<g data-s="s{index}"><path class="series" {} d="M{line}"/></g>"#, colour.stroke());
        }
    }

    fn bands(&self) -> impl Iterator<Item = [&Series; 2]> {
        let last = self.series.len().saturating_sub(1);
        (0..self.series.len() / 2).map(move |at| [&self.series[at], &self.series[last - at]])
    }

    fn middle(&self) -> Option<&Series> {
        self.series.get(self.series.len() / 2).filter(|_| self.series.len() % 2 == 1)
    }

    pub(super) fn legend_of_bands(&self) -> Vec<Item> {
        let look = Look::of(0);
        let bands = self.bands().enumerate().map(|(index, [low, high])| Item {
            label: format!("{} to {}", low.label, high.label),
            key: format!("s{index}"),
            sign: Sign::Band(index),
            look,
        });
        let middle = self.middle().map(|middle| Item {
            label: middle.label.clone(),
            key: format!("s{}", self.series.len() / 2),
            sign: Sign::Line,
            look,
        });
        bands.chain(middle).collect()
    }

    /// Bars from 0 to the right, those of one name below each other.
    pub(super) fn draw_tornado(&self, svg: &mut String, frame: &Frame) {
        let slot = frame.height / self.categories.len().max(1) as f64;
        let bar = (0.78 * slot / self.series.len().max(1) as f64).min(40.0);
        let base = at(frame.x(0.0));
        for (index, series) in self.series.iter().enumerate() {
            let offset = (index as f64 - 0.5 * self.series.len() as f64) * bar;
            let mut path = String::new();
            for (x, y) in series.runs.iter().flatten().filter_map(|&point| frame.place(point)) {
                let (top, bottom) = (at(y + offset + 0.5), at(y + offset + bar - 0.5));
                let _ = write!(path, "M{base} {top}H{}V{bottom}H{base}Z", at(x));
            }
            let style = series.look.bar();
            let _ = write!(svg, r#"<g data-s="s{index}"><path class="bar" {style} d="{path}"/></g>"#);
        }
    }

    /// Names and bars turned from upright to lying, the name with the largest bar first.
    pub(super) fn lie_down(&mut self) {
        if self.kind != Kind::Tornado {
            return;
        }
        let largest = |name: usize| {
            let points = self.series.iter().flat_map(|series| series.runs.iter().flatten());
            let own = points.filter(|point| (point.0 - name as f64).abs() < 0.5 && point.1.is_finite());
            own.map(|point| point.1).fold(f64::NEG_INFINITY, f64::max)
        };
        let mut order: Vec<usize> = (0..self.categories.len()).collect();
        order.sort_by(|one, two| largest(*two).total_cmp(&largest(*one)));
        self.categories = order.iter().map(|name| self.categories[*name].clone()).collect();
        for point in self.series.iter_mut().flat_map(|series| &mut series.runs).flatten() {
            let place = order.iter().position(|name| (*name as f64 - point.0).abs() < 0.5).unwrap_or(0);
            *point = (point.1, place as f64);
        }
        std::mem::swap(&mut self.x, &mut self.y);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths<'a>(svg: &'a str, class: &str) -> Vec<&'a str> {
        svg.split(class).skip(1).filter_map(|rest| rest.split("d=\"").nth(1)?.split('"').next()).collect()
    }

    #[test]
    fn a_histogram_has_a_bar_for_each_step() {
        let bars = vec![vec![(0.0, 3.0), (1.0, 3.0)], vec![(1.0, 6.0), (2.0, 6.0)], vec![(2.0, 0.0), (3.0, 0.0)]];
        let plot = Plot { series: vec![Series::new("", bars)], ..Plot::new("t", Kind::Histogram) };
        let frame = plot.frame(0.0, super::super::frame::Layout::PAGE).unwrap();
        assert!((frame.y(0.0) - frame.bottom()).abs() < 1e-9, "bars stand on the axis");
        let svg = plot.file();
        let path = paths(&svg, r#"class="bar""#)[0];
        assert_eq!(path.matches('M').count(), 3);
        // Twice as high, of the same width.
        let tops: Vec<f64> =
            path.split('V').skip(1).step_by(2).map(|rest| rest.split('H').next().unwrap().parse().unwrap()).collect();
        let base: f64 = path.split(['M', ' ', 'V']).nth(2).unwrap().parse().unwrap();
        assert!(((base - tops[1]) / (base - tops[0]) - 2.0).abs() < 1e-2, "{path}");
    }

    #[test]
    fn bands_lie_between_the_first_and_the_last_and_so_on() {
        let line = |label: &str, y: f64| Series::new(label, vec![vec![(0.0, y), (1.0, y + 1.0)]]);
        let series = vec![line("5 %", 1.0), line("25 %", 2.0), line("50 %", 3.0), line("75 %", 4.0), line("95 %", 5.0)];
        let plot = Plot { series, ..Plot::new("t", Kind::Quantiles) };
        let legend = plot.legend();
        let labels: Vec<&str> = legend.iter().map(|item| item.label.as_str()).collect();
        assert_eq!(labels, ["5 % to 95 %", "25 % to 75 %", "50 %"]);
        assert_ne!(legend[0].swatch(), legend[1].swatch(), "as dark as they lie upon each other");
        let svg = plot.file();
        // The line is in the legend too.
        assert_eq!((svg.matches("fill-opacity").count(), paths(&svg, r#"class="series""#).len()), (2 + 3, 2));
    }

    #[test]
    fn the_largest_bar_of_a_tornado_is_on_top() {
        let values = [(0.0, 0.1), (1.0, 0.7), (2.0, 0.4)].to_vec();
        let mut plot = Plot {
            series: vec![Series::new("total", vec![values])],
            categories: ["a", "b", "c"].map(str::to_owned).to_vec(),
            ..Plot::new("t", Kind::Tornado)
        };
        plot.lie_down();
        assert_eq!(plot.categories, ["b", "c", "a"]);
        assert_eq!(plot.series[0].runs[0], [(0.1, 2.0), (0.7, 0.0), (0.4, 1.0)]);
        let frame = plot.frame(0.0, super::super::frame::Layout::PAGE).unwrap();
        assert!(frame.y(0.0) < frame.y(1.0) && (frame.x(0.0) - frame.left).abs() < 1e-9);
        assert!(plot.file().contains(">b</text>"));
    }
}
