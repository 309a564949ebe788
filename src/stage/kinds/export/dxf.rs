//! A contour as DXF of AutoCAD 2000 (AC1015) in mm: arcs as ARC, straight lines as LINE, chords as LWPOLYLINE on the layer
//! `profile`, the bore as CIRCLE on the layer `bore`.
//!
//! Source: Autodesk, DXF Reference (2000). The version is the first that knows LWPOLYLINE and `$INSUNITS`. Written by hand:
//! the crate `dxf` 0.6 brings 38 others for it. Must not know: how a contour comes about.

use std::fmt::Display;

use super::contour::{Contour, Piece};

const PROFILE: &str = "profile";
const BORE: &str = "bore";

/// Handles of what entities and tables refer to; the others are counted from [`FIRST`].
const MODEL_RECORD: &str = "1A";
const PAPER_RECORD: &str = "1B";
const ROOT_DICTIONARY: &str = "C";
const GROUPS: &str = "D";
const FIRST: u32 = 0x30;

/// A record of a table: its handle, if others name it, and its groups of code and value.
type Record<'a> = (Option<&'a str>, &'a [(u16, &'a str)]);

/// Groups of code and value, each on a line of its own.
struct Groups {
    lines: Vec<String>,
    handle: u32,
}

impl Groups {
    #[allow(clippy::needless_pass_by_value)] // numbers and words as they come
    fn put(&mut self, code: u16, value: impl Display) {
        self.lines.push(code.to_string());
        self.lines.push(format!("{value}"));
    }

    fn all(&mut self, groups: &[(u16, &str)]) {
        for (code, value) in groups {
            self.put(*code, value);
        }
    }

    fn point(&mut self, code: u16, [x, y]: [f64; 2]) {
        // Adding 0 makes of minus zero what everybody reads.
        self.put(code, x + 0.0);
        self.put(code + 10, y + 0.0);
    }

    fn fresh(&mut self) -> String {
        self.handle += 1;
        format!("{:X}", self.handle - 1)
    }

    fn section(&mut self, name: &str, content: impl FnOnce(&mut Self)) {
        self.all(&[(0, "SECTION"), (2, name)]);
        content(self);
        self.put(0, "ENDSEC");
    }

    /// A table and its records, each with a handle (given or new), classes and groups.
    fn table(&mut self, name: &str, records: &[Record], class: &str) {
        let own = self.fresh();
        self.all(&[(0, "TABLE"), (2, name), (5, &own), (330, "0"), (100, "AcDbSymbolTable")]);
        self.put(70, records.len());
        if name == "DIMSTYLE" {
            self.put(100, "AcDbDimStyleTable");
        }
        for (handle, groups) in records {
            let handle = handle.map_or_else(|| self.fresh(), str::to_owned);
            // The one table whose records have their handle under another code.
            let code = if name == "DIMSTYLE" { 105 } else { 5 };
            self.put(0, name);
            self.all(&[(code, &handle), (330, &own), (100, "AcDbSymbolTableRecord"), (100, class)]);
            self.all(groups);
        }
        self.put(0, "ENDTAB");
    }

    fn entity(&mut self, name: &str, layer: &str, class: &str) {
        let handle = self.fresh();
        self.all(&[(0, name), (5, &handle), (330, MODEL_RECORD), (100, "AcDbEntity"), (8, layer), (100, class)]);
    }
}

#[must_use]
pub fn lines(contour: &Contour) -> Vec<String> {
    let mut body = Groups { lines: Vec::new(), handle: FIRST };
    tables(&mut body);
    blocks(&mut body);
    body.section("ENTITIES", |body| entities(body, contour));
    body.section("OBJECTS", |body| {
        body.all(&[(0, "DICTIONARY"), (5, ROOT_DICTIONARY), (330, "0"), (100, "AcDbDictionary"), (281, "1")]);
        body.all(&[(3, "ACAD_GROUP"), (350, GROUPS)]);
        body.all(&[(0, "DICTIONARY"), (5, GROUPS), (330, ROOT_DICTIONARY), (100, "AcDbDictionary"), (281, "1")]);
    });
    body.put(0, "EOF");

    let mut file = Groups { lines: Vec::new(), handle: 0 };
    file.put(999, format!("{} in mm; chords within {:e} mm of their curves", contour.gear, contour.chord_error()));
    let next = format!("{:X}", body.handle);
    file.section("HEADER", |file| {
        file.all(&[(9, "$ACADVER"), (1, "AC1015"), (9, "$HANDSEED"), (5, &next)]);
        file.all(&[(9, "$INSUNITS"), (70, "4"), (9, "$MEASUREMENT"), (70, "1")]);
        let reach = contour.points.iter().map(|point| libm::hypot(point.at[0], point.at[1])).fold(0.0, f64::max);
        for (name, sign) in [("$EXTMIN", -1.0), ("$EXTMAX", 1.0)] {
            file.put(9, name);
            file.point(10, [sign * reach; 2]);
            file.put(30, 0);
        }
    });
    file.lines.append(&mut body.lines);
    file.lines
}

fn tables(body: &mut Groups) {
    let view: &[(u16, &str)] = &[
        (2, "*ACTIVE"),
        (70, "0"),
        (10, "0"),
        (20, "0"),
        (11, "1"),
        (21, "1"),
        (12, "0"),
        (22, "0"),
        (13, "0"),
        (23, "0"),
        (14, "10"),
        (24, "10"),
        (15, "10"),
        (25, "10"),
        (16, "0"),
        (26, "0"),
        (36, "1"),
        (17, "0"),
        (27, "0"),
        (37, "0"),
        (40, "100"),
        (41, "1"),
        (42, "50"),
        (43, "0"),
        (44, "0"),
        (50, "0"),
        (51, "0"),
        (71, "0"),
        (72, "100"),
        (73, "1"),
        (74, "3"),
        (75, "0"),
        (76, "0"),
        (77, "0"),
        (78, "0"),
    ];
    let style: &[(u16, &str)] =
        &[(2, "STANDARD"), (70, "0"), (40, "0"), (41, "1"), (50, "0"), (71, "0"), (42, "2.5"), (3, "txt"), (4, "")];
    body.section("TABLES", |body| {
        body.table("VPORT", &[(None, view)], "AcDbViewportTableRecord");
        let solid = |name: &'static str, text: &'static str| {
            [(2, name), (70, "0"), (3, text), (72, "65"), (73, "0"), (40, "0")]
        };
        let types = [solid("ByBlock", ""), solid("ByLayer", ""), solid("Continuous", "Solid line")];
        body.table("LTYPE", &[(None, &types[0]), (None, &types[1]), (None, &types[2])], "AcDbLinetypeTableRecord");
        let layer = |name: &'static str, colour: &'static str| [(2, name), (70, "0"), (62, colour), (6, "Continuous")];
        let layers = [layer("0", "7"), layer(PROFILE, "7"), layer(BORE, "5")];
        body.table("LAYER", &[(None, &layers[0]), (None, &layers[1]), (None, &layers[2])], "AcDbLayerTableRecord");
        body.table("STYLE", &[(None, style)], "AcDbTextStyleTableRecord");
        body.table("VIEW", &[], "");
        body.table("UCS", &[], "");
        body.table("APPID", &[(None, &[(2, "ACAD"), (70, "0")])], "AcDbRegAppTableRecord");
        body.table("DIMSTYLE", &[(None, &[(2, "STANDARD"), (70, "0")])], "AcDbDimStyleTableRecord");
        let records: [Record; 2] =
            [(Some(MODEL_RECORD), &[(2, "*Model_Space")]), (Some(PAPER_RECORD), &[(2, "*Paper_Space")])];
        body.table("BLOCK_RECORD", &records, "AcDbBlockTableRecord");
    });
}

fn blocks(body: &mut Groups) {
    body.section("BLOCKS", |body| {
        for (name, owner) in [("*Model_Space", MODEL_RECORD), ("*Paper_Space", PAPER_RECORD)] {
            let [begin, end] = [body.fresh(), body.fresh()];
            body.all(&[
                (0, "BLOCK"),
                (5, &begin),
                (330, owner),
                (100, "AcDbEntity"),
                (8, "0"),
                (100, "AcDbBlockBegin"),
            ]);
            body.all(&[(2, name), (70, "0"), (10, "0"), (20, "0"), (30, "0"), (3, name), (1, "")]);
            body.all(&[(0, "ENDBLK"), (5, &end), (330, owner), (100, "AcDbEntity"), (8, "0"), (100, "AcDbBlockEnd")]);
        }
    });
}

fn entities(body: &mut Groups, contour: &Contour) {
    for piece in &contour.pieces {
        match piece {
            Piece::Line { start, end } => {
                body.entity("LINE", PROFILE, "AcDbLine");
                body.point(10, *start);
                body.put(30, 0);
                body.point(11, *end);
                body.put(31, 0);
            }
            Piece::Arc { centre, radius, from, turn, .. } => {
                circle(body, "ARC", PROFILE, *centre, *radius);
                body.put(100, "AcDbArc");
                // Arcs are counterclockwise in DXF, whichever way the contour goes.
                let (begin, end) = if *turn < 0.0 { (from + turn, *from) } else { (*from, from + turn) };
                body.put(50, degrees(begin));
                body.put(51, degrees(end));
            }
            Piece::Chords(range) => {
                let points = contour.chords(range);
                body.entity("LWPOLYLINE", PROFILE, "AcDbPolyline");
                body.put(90, points.len());
                body.put(70, 0);
                for point in points {
                    body.point(10, point);
                }
            }
        }
    }
    if contour.closed && contour.bore_radius > 0.0 {
        circle(body, "CIRCLE", BORE, [0.0; 2], contour.bore_radius);
    }
}

fn circle(body: &mut Groups, name: &str, layer: &str, centre: [f64; 2], radius: f64) {
    body.entity(name, layer, "AcDbCircle");
    body.point(10, centre);
    body.put(30, 0);
    body.put(40, radius);
}

/// 0 to 360.
fn degrees(angle: f64) -> f64 {
    let turned = angle.to_degrees().rem_euclid(360.0);
    if turned < 360.0 { turned + 0.0 } else { 0.0 }
}
