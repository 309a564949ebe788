//! Long series with the points that can be told apart on a figure: a line of a million points has not more to show than
//! one with the first, lowest, highest and last point of every half pixel.
//!
//! A short series stays as it is. Must not know: tables, colours.

use std::collections::BTreeSet;

use super::frame::{Frame, Layout, Size};
use super::plot::{Kind, Plot, Series};

/// Points of a series that are few enough.
const FEW: usize = 6000;
/// Cells per unit of the drawing, about a pixel.
const FINENESS: f64 = 2.0;

impl Plot {
    /// Leaves out what nobody could see.
    #[must_use]
    pub(super) fn thinned(mut self) -> Self {
        let is_long = |series: &Series| series.runs.iter().map(Vec::len).sum::<usize>() > FEW;
        if !self.series.iter().any(is_long) {
            return self;
        }
        // How far from the top it stands changes nothing.
        let Some(frame) = self.frame(0.0, Layout::of_file(Size::Page)) else { return self };
        for series in self.series.iter_mut().filter(|series| is_long(series)) {
            match self.kind {
                Kind::Points => spread(&mut series.runs, &frame),
                Kind::Line | Kind::Drawing | Kind::Chart | Kind::Quantiles => {
                    series.runs.iter_mut().for_each(|run| *run = outlined(run, &frame));
                }
                Kind::Bar | Kind::Map | Kind::Front | Kind::Histogram | Kind::Tornado => {}
            }
        }
        self
    }
}

#[allow(clippy::cast_possible_truncation)] // a drawing has far fewer than 2^31 cells
fn cell(frame: &Frame, point: (f64, f64)) -> Option<(i32, i32)> {
    frame.place(point).map(|(x, y)| ((x * FINENESS).floor() as i32, (y * FINENESS).floor() as i32))
}

/// One point of each cell; what cannot be placed is not drawn, and was counted before.
fn spread(runs: &mut [Vec<(f64, f64)>], frame: &Frame) {
    let mut taken = BTreeSet::new();
    for run in runs {
        run.retain(|point| cell(frame, *point).is_some_and(|cell| taken.insert(cell)));
    }
}

/// Of points that follow each other in one column the first, the lowest, the highest and the last; where one cannot be
/// placed, which interrupts the line, one of those that follow it.
fn outlined(run: &[(f64, f64)], frame: &Frame) -> Vec<(f64, f64)> {
    let mut kept = Vec::new();
    for column in run.chunk_by(|one, two| cell(frame, *one).map(|cell| cell.0) == cell(frame, *two).map(|cell| cell.0))
    {
        let by_height = |one: &usize, two: &usize| column[*one].1.total_cmp(&column[*two].1);
        let all = || 0..column.len();
        let mut places = vec![0];
        if cell(frame, column[0]).is_some() {
            places.extend([
                all().min_by(by_height).unwrap_or(0),
                all().max_by(by_height).unwrap_or(0),
                column.len() - 1,
            ]);
        }
        places.sort_unstable();
        places.dedup();
        kept.extend(places.into_iter().map(|place| column[place]));
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(kind: Kind, points: Vec<(f64, f64)>) -> Plot {
        Plot { series: vec![Series::new("s", vec![points])], ..Plot::new("t", kind) }
    }

    /// 200,000 points of a wave whose every period has one spike: the drawing is a hundredth as long, has every spike, and
    /// each point that was left out lies within a cell of what is drawn.
    #[test]
    fn a_long_line_keeps_its_outline() {
        let height = |x: f64| libm::sin(40.0 * x) + if (x * 1e5) % 9973.0 < 0.5 { 3.0 } else { 0.0 };
        let points: Vec<(f64, f64)> = (0..200_000).map(|i| f64::from(i) * 1e-5).map(|x| (x, height(x))).collect();
        for kind in [Kind::Line, Kind::Drawing, Kind::Points] {
            let whole = plot(kind, points.clone());
            let thin = whole.clone().thinned();
            let kept = &thin.series[0].runs[0];
            assert!(kept.len() < 8000 && kept.len() > 1000, "{kind:?}: {}", kept.len());
            assert!(kept.iter().all(|point| points.contains(point)), "nothing is made up");
            let spikes = |points: &[(f64, f64)]| points.iter().filter(|point| point.1 > 2.0).count();
            assert_eq!(spikes(kept), spikes(&points), "{kind:?}");
            let frame = whole.frame(0.0, Layout::of_file(Size::Page)).unwrap();
            let cells: BTreeSet<_> = kept.iter().filter_map(|point| cell(&frame, *point)).collect();
            if kind == Kind::Points {
                assert!(points.iter().all(|point| cells.contains(&cell(&frame, *point).unwrap())));
            } else {
                let lowest = |points: &[(f64, f64)]| points.iter().map(|point| point.1).fold(f64::INFINITY, f64::min);
                assert!((lowest(kept) - lowest(&points)).abs() < 1e-15, "{kind:?}");
            }
        }
    }

    #[test]
    fn gaps_stay_gaps_and_short_lines_stay_whole() {
        let with_gap = |count: u32| -> Vec<(f64, f64)> {
            (0..count).map(|i| (f64::from(i), if i / 100 == 3 { f64::NAN } else { 1.0 + f64::from(i % 7) })).collect()
        };
        let short = plot(Kind::Line, with_gap(6000));
        assert_eq!(format!("{:?}", short.clone().thinned()), format!("{short:?}"));
        let long = plot(Kind::Line, with_gap(60_000)).thinned();
        assert_eq!(long.series[0].runs[0].iter().filter(|point| point.1.is_nan()).count(), 1);
    }
}
