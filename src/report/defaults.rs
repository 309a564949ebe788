//! The figures of a study that declares none: what an engineer looks at first, as far as its tables go.
//!
//! Must not know: how anything is drawn. A figure whose table or column is not among the results is left out.

use super::figure::{Figure, figure};
use super::order::Order;
use super::plot::Kind;
use super::spec::{Draw, Spec};
use super::{ReportError, Tables};
use declare::number::{significant, with_unit};
use studygraph::store::bundle::MANY;
use studygraph::store::manifest::{Manifest, StageRecord};
use studygraph::table::data::{Data, Table};
use studygraph::table::schema::{Column, Type};

/// Of the pair in mesh.
const POINTS_OF_CONTACT: &str = "A: contact begins, at the root of the driving pinion; B and D: inner and outer point of \
                                 single pair contact, where the pair before leaves and the next one enters; C: pitch \
                                 point; E: contact ends";

/// # Errors
/// When a table is damaged.
pub fn figures(manifest: &Manifest, order: &Order, tables: Tables<'_>) -> Result<Vec<Figure>, ReportError> {
    let mut drawn = Vec::new();
    // Results first, what they come from after them.
    for kind in ["scatter", "ste", "stiffness", "optimizer", "modification", "geometry"] {
        let stages: Vec<&StageRecord> = manifest.stages.iter().filter(|stage| stage.kind == kind).collect();
        // Nobody looks at thousands of figures.
        for stage in stages.iter().filter(|_| stages.len() <= MANY) {
            for spec in specs(stage, stages.len() > 1, tables) {
                let mut figure = figure(&spec, order, tables)?;
                // Two designs may differ in nothing that the name of a file can have.
                let is_taken = |name: &str| drawn.iter().any(|other: &Figure| other.name.eq_ignore_ascii_case(name));
                let mut number = 2;
                while is_taken(&figure.name) {
                    figure.name = format!("{}-{number}", spec.name);
                    number += 1;
                }
                drawn.push(figure);
            }
        }
    }
    Ok(drawn)
}

/// `several`: with several stages of a kind a title says which it is.
fn specs(stage: &StageRecord, several: bool, tables: Tables<'_>) -> Vec<Spec> {
    let name = &stage.name;
    let draw = |what: &str, title: &str, kind: Kind, table: &str, x: &str, y: &str| {
        let title = if several { format!("{title} ({name})") } else { title.to_owned() };
        Spec::new(&format!("{name}_{what}"), &title, kind, &format!("{name}.{table}"), x, y)
    };
    let labelled = |spec: Spec, x: &str, y: &str| Spec { x_label: x.to_owned(), y_label: y.to_owned(), ..spec };
    let by = |spec: Spec, series: &str| Spec { series: series.to_owned(), ..spec };
    let cycle = "Path position in the mesh cycle";
    let mut found = match stage.kind.as_str() {
        "ste" => of_transmission_error(name, &draw, tables),
        "scatter" => super::scattered::specs(stage, &draw, tables),
        "stiffness" => {
            let curve =
                draw("mesh", "Mesh stiffness over the mesh cycle", Kind::Line, "curve", "cycle_position", "stiffness");
            vec![Spec { segments: "pairs".to_owned(), ..labelled(curve, cycle, "Mesh stiffness") }]
        }
        "optimizer" => {
            let history = draw("search", "The search", Kind::Line, "history", "evaluations", "best_so_far");
            let mut found = vec![labelled(history, "Designs tried", "Best objective so far")];
            found.extend(of_front(name, &draw, tables));
            found
        }
        "modification" => of_modification(&draw, &by, tables),
        "geometry" => {
            let mesh =
                draw("teeth", "The pair in mesh, with its path of contact", Kind::Drawing, "mesh_drawing", "x", "y");
            // Others are in the order of their lines.
            let labels = ["pinion", "gear"].map(|curve| (curve.to_owned(), curve.to_owned())).to_vec();
            let note = POINTS_OF_CONTACT.to_owned();
            let mesh = Spec { segments: "run".to_owned(), labels, note, ..by(labelled(mesh, "x", "y"), "curve") };
            if fits(&mesh, tables) { vec![mesh] } else { of_gear_alone(name, &draw, &labelled, tables) }
        }
        _ => Vec::new(),
    };
    found.retain(|spec| fits(spec, tables));
    found
}

fn of_transmission_error(stage: &str, draw: &Draw<'_>, tables: Tables<'_>) -> Vec<Spec> {
    let Some(summary) = tables(&format!("{stage}.summary")) else { return Vec::new() };
    let torques = super::scattered::values(&summary, "torque");
    // The one in the middle: at the ends there is often no contact, or nothing but deflection.
    let Some(&torque) = torques.get(torques.len() / 2) else { return Vec::new() };
    let off = deviations(&summary);
    let at = off.iter().fold(with_unit(&significant(torque, 6), "N m"), |at, (name, value, unit)| {
        format!("{at}, {} {}", name.replace('_', " "), with_unit(&significant(*value, 6), unit))
    });
    let with_off = |mut spec: Spec| {
        spec.conditions.extend(off.iter().map(|(name, value, unit)| (name.clone(), format!("{value} {unit}"))));
        spec
    };
    let at_torque =
        |spec: Spec| with_off(Spec { conditions: vec![("torque".to_owned(), format!("{torque} N m"))], ..spec });
    let by_design = |spec: Spec| Spec { series: "design".to_owned(), ..spec };
    let cycle = |spec: Spec, y: &str| Spec {
        x_label: "Path position in the mesh cycle".to_owned(),
        y_label: y.to_owned(),
        segments: "pairs".to_owned(),
        ..at_torque(by_design(spec))
    };
    let title = format!("Transmission error over the mesh cycle at {at}");
    let error = draw("transmission_error", &title, Kind::Line, "curve", "cycle_position", "transmission_error");
    let title = format!("Share of the load on the pair that came last, at {at}");
    let share = draw("load_share", &title, Kind::Line, "curve", "cycle_position", "newest_load_share");
    let amplitude = if torques.len() > 1 {
        let over = draw(
            "torque",
            "Peak-to-peak transmission error over torque",
            Kind::Line,
            "summary",
            "torque",
            "peak_to_peak",
        );
        with_off(by_design(over))
    } else {
        let title = format!("Peak-to-peak transmission error at {at}");
        with_off(draw("peak_to_peak", &title, Kind::Bar, "summary", "design", "peak_to_peak"))
    };
    let mut found = vec![
        cycle(error, "Transmission error"),
        Spec { y_label: "Peak-to-peak transmission error".to_owned(), ..amplitude },
        cycle(share, "Load share"),
    ];
    for design in designs(&summary) {
        for (what, column, label) in
            [("pressure", "pressure", "Pressure"), ("load", "load_per_width", "Load per width")]
        {
            let title = format!("{label} over path of contact and face, {design} at {at}");
            let map =
                draw(&format!("{what}_{}", file_name(&design)), &title, Kind::Map, "pressure", "path_position", "z");
            let mut map = at_torque(map);
            map.conditions.push(("design".to_owned(), design.clone()));
            found.push(Spec {
                value: column.to_owned(),
                x_label: "Distance from A along the line of action".to_owned(),
                y_label: "Across the face".to_owned(),
                ..map
            });
        }
    }
    found
}

/// The front of a search with several objectives, its balanced point named.
fn of_front(stage: &str, draw: &Draw<'_>, tables: Tables<'_>) -> Option<Spec> {
    let table = tables(&format!("{stage}.front"))?;
    // After what it is called come the objectives, in the order of the study.
    let numbers = table.schema().columns.iter().filter(|column| column.kind == Type::Float);
    let mut objectives = numbers.map(|column| column.name.clone());
    let (x, y) = (objectives.next()?, objectives.next()?);
    let front = draw("front", "Designs that no other one beats", Kind::Front, "front", &x, &y);
    Some(Spec { marked: [format!("{stage}.best"), "objective".to_owned(), y], ..front })
}

/// The profile of a gear without a mate: a tooth, or the whole gear where the study asks for all teeth.
fn of_gear_alone(
    stage: &str,
    draw: &Draw<'_>,
    labelled: &dyn Fn(Spec, &str, &str) -> Spec,
    tables: Tables<'_>,
) -> Vec<Spec> {
    let teeth = match tables(&format!("{stage}.outline")).as_ref().and_then(|table| table.column("tooth")) {
        Some(Data::Integer(teeth)) => teeth.iter().copied().max().unwrap_or(1),
        _ => return Vec::new(),
    };
    if tables(&format!("{stage}.pair")).is_some() {
        // Both in one place would be no picture of a pair.
        return Vec::new();
    }
    let title = if teeth > 1 { "The gear" } else { "A tooth of the gear, with half a space on either side" };
    vec![labelled(draw("profile", title, Kind::Drawing, "outline", "x", "y"), "x", "y")]
}

/// Charts of what is modified by a design; the first one says what is not.
fn of_modification(draw: &Draw<'_>, by: &dyn Fn(Spec, &str) -> Spec, tables: Tables<'_>) -> Vec<Spec> {
    let chart = |gear: &str, (what, table, x): (&str, &str, &str), (x_label, length): (&str, &str)| {
        let title = format!("{what} of the {gear}");
        let spec = draw(&format!("{table}_{gear}"), &title, Kind::Chart, table, x, "depth");
        let spec = Spec {
            conditions: vec![("gear".to_owned(), gear.to_owned())],
            length: length.to_owned(),
            x_label: x_label.to_owned(),
            y_label: "Depth".to_owned(),
            ..by(spec, "design")
        };
        (format!("the {table} of the {gear}"), spec)
    };
    let profile = ("Profile modification", "profile", "roll_angle");
    let lead = ("Lead modification", "lead", "z");
    let charts = ["pinion", "gear"].iter().flat_map(|gear| {
        [chart(gear, profile, ("Roll angle", "roll_length")), chart(gear, lead, ("Across the face", "z"))]
    });
    let charts = charts.filter(|(_, spec)| fits(spec, tables));
    let (modified, unmodified): (Vec<_>, Vec<_>) = charts.partition(|(_, spec)| takes_something_off(spec, tables));
    let mut drawn: Vec<Spec> = modified.into_iter().map(|(_, spec)| spec).collect();
    let whole: Vec<String> = unmodified.into_iter().map(|(name, _)| name).collect();
    if let Some(first) = drawn.first_mut().filter(|_| !whole.is_empty()) {
        first.note = format!("unmodified in every design: {}", whole.join(", "));
    }
    drawn
}

/// Whether a chart shows a depth.
fn takes_something_off(spec: &Spec, tables: Tables<'_>) -> bool {
    let Some(table) = tables(&spec.tables[0]) else { return false };
    let rows = studygraph::table::select::rows_where(&table, &spec.conditions).unwrap_or_default();
    matches!(table.column("depth"), Some(Data::Float(depths)) if rows.iter().any(|&row| depths[row] != 0.0))
}

/// Whether all that it draws is there, and there are rows to draw.
fn fits(spec: &Spec, tables: Tables<'_>) -> bool {
    let columns = [&spec.x, &spec.value, &spec.series, &spec.segments, &spec.length].into_iter().chain(&spec.y);
    let mut columns = columns.chain(spec.conditions.iter().map(|(column, _)| column)).filter(|name| !name.is_empty());
    let table = tables(&spec.tables[0]);
    table.is_some_and(|table| {
        columns.all(|name| table.column(name).is_some())
            && studygraph::table::select::rows_where(&table, &spec.conditions).is_ok_and(|rows| !rows.is_empty())
    })
}

/// Further keys of a summary, with the value of each that is nearest to 0: a pair that is off as little as is looked at.
fn deviations(summary: &Table) -> Vec<(String, f64, String)> {
    let keys = summary.schema().columns.iter().filter(|column| column.key && column.name != "torque");
    let nearest = |column: &Column| {
        let Some(Data::Float(values)) = summary.column(&column.name) else { return None };
        let value = values.iter().copied().reduce(|one, two| if two.abs() < one.abs() { two } else { one })?;
        Some((column.name.clone(), value, column.unit.clone()))
    };
    keys.filter_map(nearest).collect()
}

fn designs(summary: &Table) -> Vec<String> {
    let Some(Data::Text(values)) = summary.column("design") else { return Vec::new() };
    let mut values = values.clone();
    values.dedup();
    values
}

/// A design's name as a part of a file's.
fn file_name(design: &str) -> String {
    design.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' }).take(40).collect()
}
