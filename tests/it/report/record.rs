//! What the stage `report` is told, as a record built by hand: one entry for each verdict, one figure for each shape.

use declare::error::Place;
use declare::record::{PlacedValue, Record, Value};

pub fn item(value: Value) -> PlacedValue {
    PlacedValue { value, place: Place { line: 40, ..Place::default() } }
}

pub fn text(text: &str) -> Value {
    Value::Text(text.to_owned())
}

pub fn map(pairs: &[(&str, &str)]) -> Value {
    Value::Map(pairs.iter().map(|(name, value)| ((*name).to_owned(), item(text(value)))).collect())
}

pub fn group(fields: &[(&'static str, Value)]) -> Value {
    let fields = fields.iter().map(|(name, value)| (*name, item(value.clone()))).collect();
    Value::Group(Record { fields, place: Place::default() })
}

pub fn list(values: Vec<Value>) -> Value {
    Value::List(values.into_iter().map(item).collect())
}

pub fn cell(design: &str) -> String {
    format!("ste.summary[design={design}, torque=50 N m].peak_to_peak")
}

pub fn published() -> Vec<Value> {
    let entry = |label: &str, place: &str, rest: &[(&'static str, Value)]| {
        let mut fields = vec![("label", text(label)), ("where", text(place))];
        fields.extend(rest.iter().cloned());
        group(&fields)
    };
    let pp = |design: &str| format!("ste.summary[design={design}].peak_to_peak");
    vec![
        entry(
            "Largest stiffness, one pair",
            "Table 1, Figure 1",
            &[
                ("cell", text("stiffness.summary.single_max")),
                ("value", text("2.738e8 N/m")),
                ("note", text("with the bore radius fitted to this number; it is the only one that is fitted")),
            ],
        ),
        entry(
            "Largest stiffness, two pairs",
            "Figure 1",
            &[
                ("cell", text("stiffness.summary.double_max")),
                ("value", text("4.724e8 N/m")),
                ("tolerance", text("0.1 %")),
            ],
        ),
        entry(
            "Peak-to-peak transmission error, unmodified",
            "Table 2",
            &[
                ("cell", text(&cell("unmodified"))),
                ("value", text("2.316 um")),
                ("tolerance", text("1 %")),
                ("expected", group(&[("value", text("3.08 um")), ("tolerance", text("1 %"))])),
                (
                    "because",
                    text(
                        "the stiffnesses that the paper prints bound it from below, so the printed value contradicts them",
                    ),
                ),
                (
                    "proof",
                    group(&[
                        ("claim", text("F / k1 - F / k2 > published")),
                        ("with", map(&[("F", "1866.979 N"), ("k1", "2.738e8 N/m"), ("k2", "4.724e8 N/m")])),
                    ]),
                ),
            ],
        ),
        entry(
            "Peak-to-peak transmission error, ISO relief",
            "Table 2",
            &[("cell", text(&cell("iso"))), ("value", text("0.728 um")), ("tolerance", text("3 %"))],
        ),
        entry(
            "Peak-to-peak transmission error, genetic algorithm",
            "Table 2",
            &[
                ("cell", text(&cell("optimum"))),
                ("value", text("0.414 um")),
                ("because", text("counted from the tip, this relief leaves more than the printed value")),
                ("proof", group(&[("claim", text("computed < published"))])),
            ],
        ),
        entry(
            "Reduction by the ISO relief, from the paper's own table",
            "page 9",
            &[
                ("formula", text("1 - iso / unmodified")),
                ("with", map(&[("iso", "0.728 um"), ("unmodified", "2.316 um")])),
                ("value", text("68.5 %")),
                ("tolerance", text("0.2 %")),
            ],
        ),
        entry(
            "The genetic design is the lowest at all torques",
            "Figure 4",
            &[
                ("claim", text("optimum <= iso && optimum <= unmodified")),
                ("with", map(&[("optimum", &pp("optimum")), ("iso", &pp("iso")), ("unmodified", &pp("unmodified"))])),
                (
                    "because",
                    text("each relief is best at one load; a longer and deeper one wins where the load is high"),
                ),
            ],
        ),
        entry(
            "Modified designs are below the unmodified one at 50 N·m",
            "Table 2",
            &[
                ("claim", text("iso < unmodified")),
                ("with", map(&[("iso", &cell("iso")), ("unmodified", &cell("unmodified"))])),
            ],
        ),
        entry(
            "Mean transmission error at 100 N·m, ISO relief",
            "made up, to be seen moving",
            &[
                ("cell", text("ste.summary[design=iso, torque=100 N m].mean")),
                ("value", text("9 um")),
                ("because", text("the crowning is not in the printed one")),
                ("expected", group(&[("value", text("14.00 um")), ("tolerance", text("0.5 %"))])),
            ],
        ),
        entry(
            "Torque of the first row",
            "made up, to be seen outdated",
            &[
                ("formula", text("torque + 0 * torque")),
                ("with", map(&[("torque", "25 N m")])),
                ("value", text("25 N m")),
                ("because", text("a reason that is no longer needed")),
            ],
        ),
    ]
}

pub fn figures() -> Vec<Value> {
    let figure = |name: &str, title: &str, table: &str, x: &str, y: &str, rest: &[(&'static str, Value)]| {
        let mut fields = vec![
            ("name", text(name)),
            ("title", text(title)),
            ("table", list(vec![text(table)])),
            ("x", text(x)),
            ("y", list(vec![text(y)])),
        ];
        fields.extend(rest.iter().cloned());
        for (name, default) in [("kind", "line"), ("log", "none")] {
            if fields.iter().all(|(field, _)| *field != name) {
                fields.push((name, Value::Choice(default)));
            }
        }
        group(&fields)
    };
    let mark = |fields: &[(&'static str, &str)]| {
        let fields: Vec<_> = fields.iter().map(|(name, value)| (*name, text(value))).collect();
        group(&fields)
    };
    vec![
        figure(
            "stiffness",
            "Mesh stiffness over one mesh cycle",
            "stiffness.curve",
            "position",
            "stiffness",
            &[
                ("segments", text("pairs")),
                (
                    "note",
                    text(
                        "Two pairs carry the load up to B, one from there on; the dashed lines are the maxima that the paper prints.",
                    ),
                ),
                (
                    "published",
                    list(vec![
                        mark(&[("y", "2.738e8 N/m"), ("label", "energy method, paper")]),
                        mark(&[("y", "4.724e8 N/m"), ("label", "energy method, paper")]),
                    ]),
                ),
            ],
        ),
        figure(
            "transmission_error",
            "Static transmission error over one mesh cycle at 50 N·m",
            "ste.curve",
            "position",
            "transmission_error",
            &[
                ("series", text("design")),
                ("where", map(&[("torque", "50 N m")])),
                ("x_label", text("Position along the path of contact")),
            ],
        ),
        figure(
            "torque_sweep",
            "Peak-to-peak transmission error against torque",
            "ste.summary",
            "torque",
            "peak_to_peak",
            &[
                ("series", text("design")),
                ("note", text("Each relief has its own best load.")),
                (
                    "published",
                    list(vec![
                        mark(&[("x", "50 N m"), ("y", "2.316 um"), ("label", "unmodified")]),
                        mark(&[("x", "50 N m"), ("y", "0.728 um"), ("label", "iso")]),
                        mark(&[("x", "50 N m"), ("y", "0.414 um"), ("label", "optimum")]),
                    ]),
                ),
            ],
        ),
        figure(
            "convergence",
            "Best design, generation by generation",
            "optimum.history",
            "generation",
            "best",
            &[
                ("series", text("method")),
                ("log", Value::Choice("y")),
                ("y_label", text("Least peak-to-peak error so far")),
            ],
        ),
        figure(
            "parts",
            "What the deflection at the pitch point is made of",
            "stiffness.parts",
            "part",
            "compliance",
            &[("kind", Value::Choice("bar")), ("series", text("gear"))],
        ),
        figure(
            "all_torques",
            "Transmission error of the ISO relief at every torque",
            "ste.curve",
            "position",
            "transmission_error",
            &[("series", text("torque")), ("where", map(&[("design", "iso")]))],
        ),
    ]
}
