//! What the page's script needs of a figure: values, scales, and the names it says them by.
//!
//! Must not know: how the figure is drawn.

use serde_json::{Value, json};

use super::cells::Cells;
use super::frame::Frame;
use super::plot::{Axis, Kind, Plot};
use super::scale::Scale;
use declare::number::unit_symbol;

impl Plot {
    /// As JSON.
    pub(super) fn data(&self, frame: &Frame) -> String {
        let series: Vec<Value> = self
            .series
            .iter()
            .map(|series| {
                let points = series.runs.iter().flatten().filter(|point| frame.place(**point).is_some());
                let points: Vec<[f64; 2]> = points.map(|point| [rounded(point.0, 6), rounded(point.1, 6)]).collect();
                json!({ "label": series.label, "colour": series.look.colour.value(), "points": points })
            })
            .collect();
        let axis = |axis: &Axis, scale: &Scale, ticks: usize| {
            json!({
                "label": axis.label,
                "unit": unit_symbol(&axis.unit),
                "low": scale.low,
                "high": scale.high,
                "log": scale.is_log,
                "ticks": ticks,
            })
        };
        let [x_ticks, y_ticks] = frame.layout.ticks;
        let place = [frame.left, frame.top, frame.width, frame.height].map(|length| rounded(length, 6));
        let mut data = json!({
            "frame": place,
            "x": axis(&self.x, &frame.x, x_ticks),
            "y": axis(&self.y, &frame.y, y_ticks),
            "down": frame.is_downward,
            "equal": self.kind == Kind::Drawing,
            "ratio": frame.exaggeration,
            "names": if self.kind == Kind::Bar { &self.categories[..] } else { &[] },
            "series": series,
        });
        if let Some(cells) = &self.cells {
            data["cells"] = of_cells(cells);
        }
        data.to_string()
    }
}

fn of_cells(cells: &Cells) -> Value {
    let middles =
        |edges: &[f64]| -> Vec<f64> { edges.windows(2).map(|pair| rounded(0.5 * (pair[0] + pair[1]), 7)).collect() };
    let values: Vec<Option<f64>> =
        cells.values.iter().map(|value| value.is_finite().then(|| rounded(*value, 5))).collect();
    json!({
        "x": middles(&cells.xs),
        "y": middles(&cells.ys),
        "values": values,
        "label": cells.label,
        "unit": unit_symbol(&cells.unit),
    })
}

/// `value` with so many significant digits, for a shorter text.
pub fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}
