//! The article's root arc with every value its equations name, as printed and as derived (zhai2020, 13 to 31).
//!
//! Must not know: which root is drawn.

use super::drawn::{Drawn, of_gear};
use gearmesh::gear::geometry::Side;
use gearmesh::gear::problem::root_arc::RootArc;
use studygraph::table::columns::Columns;
use studygraph::table::schema::Column;

const OBJECTIVE: &str = "objective";

type Get = fn(&RootArc) -> f64;

const LENGTHS: &[(&str, &str, Get)] = &[
    ("x_a", "X of A, the point of the flank on the base circle.", |arc| arc.base.a[0]),
    ("y_a", "Y of the same point.", |arc| arc.base.a[1]),
    ("h", "H = r_b − r_f (17).", |arc| arc.base.base_radius - arc.base.root_radius),
    ("r_c", "Radius of the arc (18).", |arc| arc.article().radius),
    ("x_c", "X of its centre (19).", |arc| arc.article().centre[0]),
    ("y_c", "Y of its centre (20), with the sign that makes flank and arc share a tangent.", |arc| {
        arc.article().centre[1]
    }),
    ("y_c_printed", "Y of its centre as equation 20 is printed.", |arc| 2.0 * arc.base.a[1] - arc.article().centre[1]),
    ("gap", "How far the arc's circle passes outside the root circle.", |arc| arc.base.gap(arc.article())),
    (OBJECTIVE, "F of equation 28 at this arc; NaN where x_c is larger than r_f.", |arc| arc.objective(arc.article())),
    ("radius_less_dedendum", "r_c − h_f, which (29) wants not to be negative.", |arc| {
        arc.inequalities_derived(arc.article())[0]
    }),
    ("middle_less_centre", "(x_a + x_a1)/2 − x_c, which (30) wants not to be negative.", |arc| {
        arc.inequalities_derived(arc.article())[1]
    }),
    ("centre_less_a", "x_c − x_a, which (30) wants not to be negative.", |arc| {
        arc.inequalities_derived(arc.article())[2]
    }),
    (
        "middle_less_a_printed",
        "Room that (30) leaves to x_c with A where (26) puts it; negative: none, at any z.",
        |arc| {
            let [_, below, above] = arc.inequalities_printed(arc.article());
            below + above
        },
    ),
    ("r_c_touching", "(r_b² − r_f²)/(2 r_f): the arc from A that touches the root circle.", |arc| {
        arc.base.touching_radius()
    }),
    ("r_c_middle", "r_b tan(π/z − ψ_b): the arc from A whose centre is in the middle of the space.", |arc| {
        arc.base.middle_radius()
    }),
    ("r_c_optimal", "Radius of the best arc of the corrected problem.", |arc| arc.optimum().radius),
    ("gap_optimal", "How far that arc passes outside the root circle.", |arc| arc.base.gap(arc.optimum())),
];

/// A gear and its arc.
pub type ArcRow = (Side, RootArc);

#[must_use]
pub fn columns() -> Columns<ArcRow> {
    let description = "The root arc of zhai2020; no row for a gear whose root circle is not inside its base circle.";
    let theta = "θ, the angle of A from the tooth's centreline (16).";
    let columns = of_gear(Columns::new("root_arc", description), |row: &ArcRow| row.0)
        .float("theta", "deg", theta, |row| row.1.base.angle)
        .float("theta_printed", "deg", "The same as equation 26 is printed.", |row| row.1.printed_angle());
    let length = |columns: Columns<ArcRow>, &(name, description, get): &(&str, &str, Get)| {
        let change = |column: Column| {
            let column = column.tolerance(1e-9, 1e-9);
            // F has no value where the centre lies farther across than the root circle reaches.
            if name == OBJECTIVE { column.allows_nan() } else { column }
        };
        columns.float(name, "mm", description, move |row| get(&row.1)).but(change)
    };
    LENGTHS.iter().fold(columns, length).on_demand()
}

#[must_use]
pub fn row(drawn: &Drawn) -> Option<ArcRow> {
    Some((drawn.side, RootArc::new(&drawn.gear).ok()?))
}
