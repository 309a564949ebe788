//! Studies of small stage kinds that exist only here: every message, and what can never happen.

mod columns;
mod declared;
mod files;
mod messages;
mod notation;
mod paths;
mod properties;
mod structure;
mod texts;
mod units;
mod values;

use std::path::Path;

use super::{LoadError, Study, load_text};
use crate::about::ABOUT;
use crate::program::{Foreign, Pictures, Program};
use crate::stage::{Ahead, Context, Demand, Estimate, Inputs, Kind, Port, Stage, Want};
use crate::table::data::Table;
use crate::table::schema::{Column, Schema};
use declare::error::{Diagnostic, Failure};
use declare::parameter::{Choice, Field, Member, Shape};
use declare::record::{Record, Value};
use declare::units::{ANGLE, LENGTH, RATIO, STRESS, TORQUE};

static RACK: &[Field] = &[
    Field::number("addendum", 0.1, 2.0, "Addendum h_aP, times the module.").default("1.0"),
    Field::number("shift", -1.0, f64::INFINITY, "Profile shift x.").optional().example("0.2"),
];

static BODY: &[Field] = &[
    Field::integer("teeth", 5, 1000, "Number of teeth z.").example("24"),
    Field::quantity("face_width", LENGTH, 1e-5, 1.0, "Face width b.").example("20 mm"),
];

static GEOMETRY: &[Field] = &[
    Field::quantity("module", LENGTH, 1e-5, 0.1, "Module m.").example("3 mm"),
    Field::quantity("pressure_angle", ANGLE, 0.1, 0.8, "Pressure angle α.").default("20 deg"),
    Field::group("rack", RACK, "The basic rack.").default("{}"),
    Field::quantity("youngs_modulus", STRESS, 1e8, 1e12, "Young's modulus E.").default("206 GPa"),
    Field::group("pinion", BODY, "The driving gear."),
    Field::quantity("overlap", RATIO, 0.0, 1.0, "An overlap.").optional().example("5 %"),
    Field::new("ground", Shape::Flag, "Whether the flanks are ground.").default("false"),
    Field::choice(
        "side",
        &[Choice { name: "left", summary: "The left flank." }, Choice { name: "right", summary: "The right flank." }],
        "The flank.",
    )
    .default("right"),
    Field::new("note", Shape::Text, "Anything.").optional().example("as cut"),
    Field::integer("bolts", 4, 12, "Bolts, in pairs.").multiple_of(2).optional().example("6"),
];

static RELIEF: &[Field] = &[
    Field::quantity("amount", LENGTH, 0.0, 1e-3, "Relief C_a.").range().example("12 um"),
    Field::quantity("length", LENGTH, 0.0, 0.1, "Relief length L_Ca.").range().optional().example("4 mm"),
];
static FAMILIES: &[Member] = &[
    Member { name: "tip_relief", summary: "Relief of the tip.", fields: RELIEF },
    Member { name: "lead_crowning", summary: "Crowning.", fields: RELIEF },
    Member { name: "nothing", summary: "No change.", fields: &[] },
];
static FAMILY: Shape = Shape::Member(|| FAMILIES);
static DESIGN: Shape = Shape::List(&FAMILY);

static MODIFICATION: &[Field] = &[
    Field::reference("pair", &["geometry"], "The gears."),
    Field::new("designs", Shape::Map(&DESIGN), "Designs by name."),
];

static OPTIMIZER: &[Field] = &[
    Field::reference("pair", &["geometry"], "The gears."),
    Field::new("design", DESIGN, "What is chosen.").chooses(),
    Field::new("method", FAMILY, "How.").default("nothing"),
];

static PLACES: Shape = Shape::Reference(&["modification", "optimizer"]);

static STE: &[Field] = &[
    Field::reference("pair", &["geometry"], "The gears."),
    Field::new("designs", Shape::List(&PLACES), "What is run."),
    Field::quantity("torque", TORQUE, 0.0, 1e7, "Torque T.").axis(8).example("100 N m"),
    Field::number("factor", 0.0, 10.0, "A factor.").axis(8).default("1"),
    Field::reference("before", &["ste"], "Another one.").optional(),
];

static CELL: Shape = Shape::Text;
static REPORT: &[Field] = &[
    Field::new("cells", Shape::List(&CELL), "Cells, as `stage.table.column`.").default("[]"),
    Field::new("value", Shape::AnyQuantity, "A published value.").optional().example("4.2 um"),
    Field::reference("around", &["modification", "report"], "Read through it.").optional(),
];

struct Part {
    record: Record,
    kind: &'static str,
}

impl Stage for Part {
    fn inputs(&self) -> Vec<Port> {
        let mut ports = Vec::new();
        for name in ["pair", "before"] {
            if let Some(entry) = self.record.entry(name) {
                let Value::Reference(stage) = &entry.value else { panic!("a reference") };
                ports.push(Port::tables(name, stage, &["summary"]));
            }
        }
        if self.record.entry("around").is_some() {
            let stage = self.record.reference("around");
            ports.push(Port::tables("around", stage, &["flank"]).through("pair"));
        }
        if self.kind == "report" {
            for entry in self.record.list("cells") {
                let Value::Text(text) = &entry.value else { panic!("a text") };
                let mut words = text.split('.').map(str::to_owned);
                let mut next = || words.next().unwrap_or_default();
                let (stage, table, column) = (next(), next(), next());
                let wants = vec![Want { table, columns: vec![column] }];
                ports.push(Port { name: text.clone(), stage, through: None, wants, only_for: &[] });
            }
        }
        ports
    }

    fn outputs(&self) -> Vec<Schema> {
        let peak = || vec![Column::float("peak_to_peak", "um", "Peak to peak.")];
        let mut all = vec![Schema::new("summary", "A summary.", peak())];
        if self.kind == "geometry" {
            all.push(Schema::new("flank", "The flank.", peak()));
        }
        all
    }

    fn estimate(&self, _: &Demand, _: &Ahead) -> Estimate {
        Estimate::default()
    }

    fn run(&self, _: &Context, _: &Inputs) -> Result<Vec<Table>, Failure> {
        Ok(Vec::new())
    }
}

macro_rules! kind {
    ($name:literal, $fields:expr) => {
        Kind {
            name: $name,
            version: 1,
            summary: concat!("A stage of the tests: ", $name, "."),
            fields: $fields,
            curves: &[],
            example: concat!("kind: ", $name),
            build: |record| {
                // Something that no declaration can say.
                if record.entry("note").is_some() && record.text("note") == "impossible" {
                    return Err(Diagnostic::new("this pair is impossible").into());
                }
                Ok(Box::new(Part { record: record.clone(), kind: $name }))
            },
        }
    };
}

static KIND_GEOMETRY: Kind = kind!("geometry", GEOMETRY);
static KIND_MODIFICATION: Kind = kind!("modification", MODIFICATION);
static KIND_OPTIMIZER: Kind = kind!("optimizer", OPTIMIZER);
static KIND_STE: Kind = kind!("ste", STE);
static KIND_REPORT: Kind = kind!("report", REPORT);

static FOREIGN: &[Foreign] = &[
    Foreign { word: "z", field: Some("teeth"), inside: &[], remark: "", is_other: false, remedy: None },
    Foreign {
        word: "bore_diameter",
        field: Some("bore_radius"),
        inside: &[],
        remark: "half of it",
        is_other: false,
        remedy: None,
    },
    Foreign {
        word: "diameter",
        field: Some("teeth"),
        inside: &[],
        remark: "a length over the module",
        is_other: false,
        remedy: None,
    },
    Foreign { word: "helix_angle", field: None, inside: &[], remark: "spur gears only", is_other: false, remedy: None },
];
static PROGRAM: Program = Program {
    kinds: KINDS,
    foreign: &[FOREIGN],
    derived: &[],
    named: &[],
    code_of: |_| String::new(),
    counters: &[],
    about: ABOUT,
    pictures: Pictures::NONE,
};
pub static KINDS: &[&Kind] = &[&KIND_GEOMETRY, &KIND_MODIFICATION, &KIND_OPTIMIZER, &KIND_STE, &KIND_REPORT];

/// A valid study that uses every shape.
pub const VALID: &str = "\
study: small
title: A small study of 5 µm
source: { paper: nobody, tables: [1, 2], figures: 3 }
seed: 7
stages:
  pair:
    kind: geometry
    module: 3 mm
    rack: { addendum: 1.25 }
    pinion: { teeth: 19, face_width: 20 mm }
    overlap: 12.5 %
  designs:
    kind: modification
    pair: pair
    designs:
      plain: []
      relieved:
        - tip_relief: { amount: 7.81 um }
        - nothing
      single: { tip_relief: { amount: 1 µm } }
  optimum:
    kind: optimizer
    pair: pair
    design:
      - tip_relief: { amount: [0 um, 8 um], length: 2 mm }
  ste:
    kind: ste
    pair: pair
    designs: [designs, optimum]
    torque: { from: 25 N m, to: 100 N m, count: 16 }
  report:
    kind: report
    cells: ste.summary.peak_to_peak
    value: 2.316 um
    around: designs
";

pub fn load(text: &str) -> Result<Study, LoadError> {
    load_text(text, Path::new("t.yaml"), &PROGRAM)
}

/// The valid study with one text in place of another.
fn changed(old: &str, new: &str) -> String {
    assert!(VALID.contains(old), "{old}");
    VALID.replacen(old, new, 1)
}

/// The whole message of a study that must be refused.
fn refused(text: &str) -> String {
    match load(text) {
        Ok(_) => panic!("this was accepted:\n{text}"),
        Err(error) => error.to_string(),
    }
}

/// What stands in the valid study, what stands there instead, and the whole message after the file's name.
fn each_is_refused(changes: &[(&str, &str, &str)]) {
    let mut wrong = Vec::new();
    for (old, new, expected) in changes {
        let message = refused(&changed(old, new));
        if message != format!("t.yaml:{expected}") {
            wrong.push(format!("{new:?}\n expected {expected:?}\n but got  {message:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
