//! A figure for those who want to go on with it: Vega-Lite, with its values, as Altair reads it.
//!
//! Source: the grammar of Vega-Lite 6 (<https://vega.github.io/vega-lite/docs/>). Must not know: SVG, the page.

use serde_json::{Value, json};

use super::cells::Cells;
use super::look::Look;
use super::plot::{Axis, Kind, Plot, Size};
use declare::number::unit_symbol;

const SCHEMA: &str = "https://vega.github.io/schema/vega-lite/v6.json";

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
        let spec = json!({
            "$schema": SCHEMA,
            "title": self.title,
            "width": width,
            "height": height,
            "layer": layers,
            "resolve": { "scale": { "color": "independent", "shape": "independent" } },
        });
        // `{:#}` indents every number of every row.
        let mut text = spec.to_string().replace("{\"n\":", "\n{\"n\":");
        text.push('\n');
        text
    }

    fn computed(&self) -> Value {
        let names: Vec<&str> = self.series.iter().map(|series| series.label.as_str()).collect();
        let mut values = Vec::new();
        let mut count = 0;
        for series in &self.series {
            for (run, points) in series.runs.iter().enumerate() {
                if self.kind == Kind::Histogram {
                    let (Some(from), Some(to)) = (points.first(), points.last()) else { continue };
                    let (x, x2, y) = (number(from.0), number(to.0), number(from.1));
                    values.push(json!({ "n": count, "series": series.label, "x": x, "x2": x2, "y": y }));
                    count += 1;
                    continue;
                }
                for &(x, y) in points {
                    if self.kind == Kind::Tornado {
                        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // an index
                        let name = self.categories.get(y as usize);
                        values.push(json!({ "n": count, "series": series.label, "x": number(x), "y": name }));
                        count += 1;
                        continue;
                    }
                    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // an index
                    let category = self.categories.get(x as usize).filter(|_| self.kind == Kind::Bar);
                    let x = category.map_or_else(|| number(x), |category| json!(category));
                    values.push(json!({ "n": count, "series": series.label, "run": run, "x": x, "y": number(y) }));
                    count += 1;
                }
            }
        }
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
        json!({ "data": { "values": values }, "mark": mark, "encoding": encoding })
    }

    fn map(&self, cells: &Cells) -> Value {
        let columns = cells.xs.len() - 1;
        let cell = |(index, value): (usize, &f64)| {
            let (i, j) = (index % columns, index / columns);
            json!({
                "n": index, "x": cells.xs[i], "x2": cells.xs[i + 1], "y": cells.ys[j], "y2": cells.ys[j + 1],
                "value": number(*value),
            })
        };
        let values: Vec<Value> = cells.values.iter().enumerate().map(cell).collect();
        let value = Axis { label: cells.label.clone(), unit: cells.unit.clone(), is_log: false };
        let [mut x, mut y] = [channel("x", &self.x, "quantitative"), channel("y", &self.y, "quantitative")];
        (x["scale"]["zero"], y["scale"]["zero"]) = (json!(false), json!(false));
        json!({
            "data": { "values": values },
            "mark": { "type": "rect" },
            "encoding": {
                "x": x, "x2": { "field": "x2" }, "y": y, "y2": { "field": "y2" },
                "color": channel("value", &value, "quantitative"),
            },
        })
    }

    fn published(&self) -> Vec<Value> {
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
            json!({ "data": { "values": [row] }, "mark": shape, "encoding": encoding })
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
    let title = super::axes::with_power(&axis.label, &unit_symbol(&axis.unit), 0);
    let mut channel = json!({ "field": field, "type": kind, "title": title, "scale": {} });
    if axis.is_log {
        channel["scale"]["type"] = json!("log");
    }
    channel
}
