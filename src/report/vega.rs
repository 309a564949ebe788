//! A figure for those who want to go on with it: Vega-Lite, with its values, as Altair reads it.
//!
//! Source: the grammar of Vega-Lite 6 (<https://vega.github.io/vega-lite/docs/>). Rows are written as they stand: thousands of
//! them as trees of JSON took a tenth of a small run. Must not know: SVG, the page.

use serde::Serialize;
use serde_json::{Value, json};

use super::cells::Cells;
use super::frame::Size;
use super::look::Look;
use super::plot::{Axis, Kind, Plot, Series};
use super::scale::with_power;
use declare::number::unit_symbol;

const SCHEMA: &str = "https://vega.github.io/schema/vega-lite/v6.json";

#[derive(Serialize)]
struct Spec<'a> {
    #[serde(rename = "$schema")]
    schema: &'static str,
    title: &'a str,
    width: u32,
    height: u32,
    layer: Vec<Layer<'a>>,
    resolve: Value,
}

#[derive(Serialize)]
struct Layer<'a> {
    data: Values<'a>,
    mark: Value,
    encoding: Value,
}

#[derive(Serialize)]
struct Values<'a> {
    values: Vec<Row<'a>>,
}

/// JSON has no NaN: a number that is none is written as null, which interrupts a line.
#[derive(Serialize)]
#[serde(untagged)]
enum Row<'a> {
    Point {
        n: usize,
        series: &'a str,
        run: usize,
        x: Place<'a>,
        y: f64,
    },
    /// Of a histogram.
    Bar {
        n: usize,
        series: &'a str,
        x: f64,
        x2: f64,
        y: f64,
    },
    /// Of a tornado.
    Named {
        n: usize,
        series: &'a str,
        x: f64,
        y: Option<&'a String>,
    },
    /// Of a map.
    Cell {
        n: usize,
        x: f64,
        x2: f64,
        y: f64,
        y2: f64,
        value: f64,
    },
    Published(Value),
}

#[derive(Serialize)]
#[serde(untagged)]
enum Place<'a> {
    Number(f64),
    Category(&'a str),
}

impl Plot {
    /// As JSON, indented.
    #[must_use]
    pub fn vega_lite(&self) -> String {
        let mut layers = vec![self.cells.as_ref().map_or_else(|| self.computed(), |cells| self.map(cells))];
        layers.extend(self.published());
        let (width, height) = match self.size {
            Size::Page => (720, 320),
            Size::Column => (260, 180),
        };
        let spec = Spec {
            schema: SCHEMA,
            title: &self.title,
            width,
            height,
            layer: layers,
            resolve: json!({ "scale": { "color": "independent", "shape": "independent" } }),
        };
        // Indented, every number of every row would have a line of its own. Nothing here can fail to be JSON.
        let mut text = serde_json::to_string(&spec).unwrap_or_default().replace("{\"n\":", "\n{\"n\":");
        text.push('\n');
        text
    }

    fn rows(&self) -> Vec<Row<'_>> {
        let mut rows = Vec::new();
        for Series { label, runs, .. } in &self.series {
            for (run, points) in runs.iter().enumerate() {
                if self.kind == Kind::Histogram {
                    let (Some(from), Some(to)) = (points.first(), points.last()) else { continue };
                    rows.push(Row::Bar { n: rows.len(), series: label, x: from.0, x2: to.0, y: from.1 });
                    continue;
                }
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // an index
                let category = |place: f64| self.categories.get(place as usize);
                for &(x, y) in points {
                    let n = rows.len();
                    rows.push(if self.kind == Kind::Tornado {
                        Row::Named { n, series: label, x, y: category(y) }
                    } else {
                        let name = category(x).filter(|_| self.kind == Kind::Bar);
                        let x = name.map_or(Place::Number(x), |name| Place::Category(name));
                        Row::Point { n, series: label, run, x, y }
                    });
                }
            }
        }
        rows
    }

    fn computed(&self) -> Layer<'_> {
        let names: Vec<&str> = self.series.iter().map(|series| series.label.as_str()).collect();
        let x_type = if self.kind == Kind::Bar { "nominal" } else { "quantitative" };
        let mut x = channel("x", &self.x, x_type);
        let mut y = channel("y", &self.y, if self.kind == Kind::Tornado { "nominal" } else { "quantitative" });
        if self.kind == Kind::Tornado {
            y["sort"] = json!(self.categories);
        } else if self.kind == Kind::Histogram {
            x["scale"]["zero"] = json!(false);
        } else if self.kind == Kind::Bar {
            x["sort"] = json!(self.categories);
        } else {
            x["scale"]["zero"] = json!(false);
            y["scale"]["zero"] = json!(false);
        }
        if self.kind == Kind::Chart {
            y["sort"] = json!("descending");
        }
        let mut encoding = json!({ "x": x, "y": y });
        if names.len() > 1 {
            let colours: Vec<String> = self.series.iter().map(|series| series.look.colour.on_white()).collect();
            let scale = json!({ "domain": names, "range": colours });
            encoding["color"] = json!({ "field": "series", "type": "nominal", "title": null, "scale": scale });
        }
        // Parts of one thing have its colour.
        if self.series.iter().any(|series| series.look.opacity() < 1.0) {
            let by = |range: Vec<Value>| json!({ "field": "series", "type": "nominal", "legend": null, "scale": { "domain": names, "range": range } });
            let of =
                |pick: fn(Look) -> Value| self.series.iter().map(|series| pick(series.look)).collect::<Vec<Value>>();
            match self.kind {
                Kind::Bar | Kind::Histogram | Kind::Tornado => {
                    encoding["opacity"] = by(of(|look| json!(look.opacity())));
                }
                Kind::Points | Kind::Front => encoding["shape"] = json!({ "field": "series", "legend": null }),
                _ => encoding["strokeDash"] = by(of(|look| dashes(look.dash()))),
            }
        }
        let mark = match self.kind {
            Kind::Points | Kind::Front => json!({ "type": "point", "filled": true }),
            Kind::Bar => {
                encoding["xOffset"] = json!({ "field": "series" });
                json!({ "type": "bar" })
            }
            Kind::Histogram => {
                encoding["x2"] = json!({ "field": "x2" });
                json!({ "type": "bar" })
            }
            Kind::Tornado => {
                encoding["yOffset"] = json!({ "field": "series" });
                json!({ "type": "bar" })
            }
            _ => {
                // Points in their order, and jumps stay jumps.
                encoding["order"] = json!({ "field": "n" });
                encoding["detail"] = json!([{ "field": "run" }, { "field": "series" }]);
                json!({ "type": "line" })
            }
        };
        Layer { data: Values { values: self.rows() }, mark, encoding }
    }

    fn map(&self, cells: &Cells) -> Layer<'_> {
        let columns = cells.xs.len() - 1;
        let cell = |(n, &value): (usize, &f64)| {
            let (i, j) = (n % columns, n / columns);
            Row::Cell { n, x: cells.xs[i], x2: cells.xs[i + 1], y: cells.ys[j], y2: cells.ys[j + 1], value }
        };
        let values = cells.values.iter().enumerate().map(cell).collect();
        let value = Axis { label: cells.label.clone(), unit: cells.unit.clone(), is_log: false };
        let [mut x, mut y] = [channel("x", &self.x, "quantitative"), channel("y", &self.y, "quantitative")];
        (x["scale"]["zero"], y["scale"]["zero"]) = (json!(false), json!(false));
        let encoding = json!({
            "x": x, "x2": { "field": "x2" }, "y": y, "y2": { "field": "y2" },
            "color": channel("value", &value, "quantitative"),
        });
        Layer { data: Values { values }, mark: json!({ "type": "rect" }), encoding }
    }

    fn published(&self) -> Vec<Layer<'_>> {
        let mark = |mark: &super::plot::Mark| {
            let mut row = json!({ "n": 0, "label": mark.label });
            let mut encoding = json!({});
            for (name, place, axis) in [("x", mark.x, &self.x), ("y", mark.y, &self.y)] {
                if let Some(place) = place {
                    row[name] = number(place);
                    encoding[name] = channel(name, axis, "quantitative");
                }
            }
            let is_point = mark.x.is_some() && mark.y.is_some();
            let colour = mark.look.colour.on_white();
            let shape = if is_point {
                json!({ "type": "point", "shape": "diamond", "size": 90, "color": colour })
            } else {
                json!({ "type": "rule", "strokeDash": [7, 5], "color": colour })
            };
            encoding["tooltip"] = json!({ "field": "label" });
            Layer { data: Values { values: vec![Row::Published(row)] }, mark: shape, encoding }
        };
        self.marks.iter().map(mark).collect()
    }
}

/// Lengths of dashes and gaps; of a solid line one dash after the other.
fn dashes(lengths: &str) -> Value {
    let lengths: Vec<f64> = lengths.split(' ').filter_map(|length| length.parse().ok()).collect();
    if lengths.is_empty() { json!([1, 0]) } else { json!(lengths) }
}

/// JSON has no NaN: null interrupts a line.
fn number(value: f64) -> Value {
    serde_json::Number::from_f64(value).map_or(Value::Null, Value::Number)
}

fn channel(field: &str, axis: &Axis, kind: &str) -> Value {
    let title = with_power(&axis.label, &unit_symbol(&axis.unit), 0);
    let mut channel = json!({ "field": field, "type": kind, "title": title, "scale": {} });
    if axis.is_log {
        channel["scale"]["type"] = json!("log");
    }
    channel
}
