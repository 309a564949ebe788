//! Tables like those of a real study, from a few lines of load balance: two pairs of parabolic stiffness, relief at their
//! ends. Smooth, with true jumps, and cheap.

use std::collections::BTreeMap;

use studygraph::table::data::{Row, Table};
use studygraph::table::schema::{Column, Schema};

const BASE_PITCH: f64 = 8.856;
const CONTACT_RATIO: f64 = 1.6457;
const FORCE_PER_TORQUE: f64 = 1000.0 / 26.781_24;

/// Relief amount [µm], roll length [mm], crowning [µm].
const DESIGNS: [(&str, [f64; 3]); 3] =
    [("iso", [7.81, 5.05, 6.34]), ("optimum", [6.93, 3.41, 5.67]), ("unmodified", [0.0; 3])];

/// Stiffness of one pair at `s` from A, N/µm.
fn pair_stiffness(s: f64) -> Option<f64> {
    let length = CONTACT_RATIO * BASE_PITCH;
    let from_middle = (2.0 * s / length - 1.0).abs();
    (from_middle <= 1.0).then(|| 273.8 * (1.0 - 0.29 * from_middle.powi(2)))
}

fn total_stiffness(s: f64) -> f64 {
    [s, s + BASE_PITCH].into_iter().filter_map(pair_stiffness).sum()
}

/// Static transmission error at `s` [µm] for a force [N].
fn deflection(s: f64, force: f64, [amount, length, crown]: [f64; 3]) -> f64 {
    let total = CONTACT_RATIO * BASE_PITCH;
    let relief = |s: f64| {
        let t = ((length - s.min(total - s)) / length.max(1e-12)).clamp(0.0, 1.0);
        if length == 0.0 { 0.0 } else { amount * (0.44 * t + 0.56 * t * t) }
    };
    let pairs: Vec<(f64, f64)> =
        [s, s + BASE_PITCH].into_iter().filter_map(|s| pair_stiffness(s).map(|k| (k, relief(s)))).collect();
    let (mut low, mut high) = (0.0, 1000.0);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        let load: f64 = pairs.iter().map(|(k, gap)| k * (middle - gap).max(0.0)).sum();
        if load < force { low = middle } else { high = middle }
    }
    low + 0.33 * crown
}

/// Mesh positions with both sides of the jumps at B and D.
fn positions() -> Vec<f64> {
    let double = (CONTACT_RATIO - 1.0) * BASE_PITCH;
    let mut positions: Vec<f64> = (0..64).map(|index| BASE_PITCH * f64::from(index) / 63.0).collect();
    positions.extend([double - 1e-9, double + 1e-9]);
    positions.sort_by(f64::total_cmp);
    positions
}

pub fn tables() -> BTreeMap<String, Table> {
    let mut tables = BTreeMap::new();
    let mut add = |stage: &str, schema: Schema, rows: Vec<Row>| {
        let table = Table::from_rows(schema, rows).unwrap();
        tables.insert(format!("{stage}.{}", table.name()), table);
    };
    // Without the two points at the jump: only the column `pairs` tells where it is.
    let rows = (0..64).map(|index| BASE_PITCH * f64::from(index) / 63.0).map(|s| {
        let pairs = i64::from(pair_stiffness(s).is_some()) + i64::from(pair_stiffness(s + BASE_PITCH).is_some());
        vec![s.into(), (1e6 * total_stiffness(s)).into(), pairs.into()]
    });
    add(
        "stiffness",
        Schema::new(
            "curve",
            "Mesh stiffness over one mesh cycle",
            vec![
                Column::float("position", "mm", "Position along the path of contact from A, s").key(),
                Column::float("stiffness", "N/m", "Mesh stiffness, k (secant, unmodified)"),
                Column::integer("pairs", "Tooth pairs in contact"),
            ],
        ),
        rows.collect(),
    );
    add(
        "stiffness",
        Schema::new(
            "summary",
            "Characteristic stiffnesses",
            vec![
                Column::float("single_max", "N/m", "Largest stiffness with one pair in contact"),
                Column::float("double_max", "N/m", "Largest stiffness with two pairs in contact"),
                Column::float("seconds", "s", "Time it took").volatile(),
            ],
        ),
        vec![vec![2.738_2e8.into(), 4.727e8.into(), 0.001_9.into()]],
    );
    let (mut curve, mut summary) = (Vec::new(), Vec::new());
    for (design, amounts) in DESIGNS {
        for step in 0..16 {
            let torque = 25.0 + 5.0 * f64::from(step);
            let values: Vec<f64> =
                positions().iter().map(|&s| deflection(s, FORCE_PER_TORQUE * torque, amounts)).collect();
            let (low, high) = values.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
            let mean = values.iter().sum::<f64>() / 66.0;
            summary.push(vec![design.into(), torque.into(), mean.into(), (high - low).into()]);
            for (s, value) in positions().into_iter().zip(values) {
                curve.push(vec![design.into(), torque.into(), s.into(), value.into()]);
            }
        }
    }
    let keys =
        || vec![Column::text("design", "Name of the design").key(), Column::float("torque", "N m", "Torque, T").key()];
    let more = |columns: Vec<Column>| keys().into_iter().chain(columns).collect::<Vec<_>>();
    let curve_columns = more(vec![
        Column::float("position", "mm", "Position along the path of contact from A, s").key(),
        Column::float("transmission_error", "um", "Static transmission error, δ"),
    ]);
    let summary_columns = more(vec![
        Column::float("mean", "um", "Mean of the transmission error"),
        Column::float("peak_to_peak", "um", "Peak-to-peak transmission error"),
    ]);
    add("ste", Schema::new("curve", "Transmission error over one mesh cycle", curve_columns), curve);
    add("ste", Schema::new("summary", "Transmission error by design and torque", summary_columns), summary);
    let mut history = Vec::new();
    for generation in 0..100_i64 {
        let progress = 1.0 - (-0.09 * generation as f64).exp();
        let genetic = 1.24 - 0.82 * progress - if generation > 31 { 0.01 } else { 0.0 };
        history.push(vec!["genetic".into(), generation.into(), genetic.into()]);
        if generation < 60 {
            let refined = 0.23 + 0.9 * (-0.16 * generation as f64).exp();
            history.push(vec!["differential evolution".into(), generation.into(), refined.into()]);
        }
    }
    add(
        "optimum",
        Schema::new(
            "history",
            "Best design so far, generation by generation",
            vec![
                Column::text("method", "Method").key(),
                Column::integer("generation", "Generation").key(),
                Column::float("best", "um", "Least peak-to-peak transmission error so far"),
            ],
        ),
        history,
    );
    let parts = [
        ("bending", 21.0, 8.0),
        ("shear", 14.0, 9.0),
        ("axial", 5.0, 3.0),
        ("body", 31.0, 27.0),
        ("contact", 12.0, 12.0),
    ];
    let rows = parts.into_iter().flat_map(|(part, pinion, gear)| {
        [("pinion", pinion), ("gear", gear)]
            .map(|(body, share): (&str, f64)| vec![body.into(), part.into(), (1e-10 * share).into()])
    });
    add(
        "stiffness",
        Schema::new(
            "parts",
            "What the deflection at the pitch point is made of",
            vec![
                Column::text("gear", "Pinion or gear").key(),
                Column::text("part", "Part of the compliance").key(),
                Column::float("compliance", "m/N", "Compliance at the pitch point"),
            ],
        ),
        rows.collect(),
    );
    tables
}
