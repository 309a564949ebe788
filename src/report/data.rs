//! What the page's script needs of a figure: values, scales, and the names it says them by.
//!
//! Must not know: how the figure is drawn.

use serde::Serialize;
use serde_json::{Value, json};

use super::cells::Cells;
use super::frame::Frame;
use super::plot::{Axis, Kind, Plot};
use super::scale::Scale;
use declare::number::unit_symbol;

/// What the script reads, by its names. Points may be thousands: they are no tree of JSON.
#[derive(Serialize)]
struct Data<'a> {
    frame: [f64; 4],
    x: Value,
    y: Value,
    down: bool,
    equal: bool,
    ratio: Option<f64>,
    names: &'a [String],
    series: Vec<Drawn<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cells: Option<Value>,
}

#[derive(Serialize)]
struct Drawn<'a> {
    label: &'a str,
    colour: String,
    points: Vec<[f64; 2]>,
}

impl Plot {
    /// As JSON.
    pub(super) fn data(&self, frame: &Frame) -> String {
        let series = self.series.iter().map(|series| {
            let points = series.runs.iter().flatten().filter(|point| frame.place(**point).is_some());
            Drawn {
                label: &series.label,
                colour: series.look.colour.value(),
                points: points.map(|point| [rounded(point.0, 6), rounded(point.1, 6)]).collect(),
            }
        });
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
        let data = Data {
            frame: [frame.left, frame.top, frame.width, frame.height].map(|length| rounded(length, 6)),
            x: axis(&self.x, &frame.x, x_ticks),
            y: axis(&self.y, &frame.y, y_ticks),
            down: frame.is_downward,
            equal: self.kind == Kind::Drawing,
            ratio: frame.exaggeration,
            names: if self.kind == Kind::Bar { &self.categories } else { &[] },
            series: series.collect(),
            cells: self.cells.as_ref().map(of_cells),
        };
        // Nothing here can fail to be JSON.
        serde_json::to_string(&data).unwrap_or_default()
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
