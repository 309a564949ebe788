//! What measured traces come to after ISO 1328-1, as columns of whoever has traces.
//!
//! Must not know: whose they are.

use gearmesh::gear::modification::measured;
use studygraph::table::columns::Columns;

/// What a trace comes to.
#[derive(Clone, Copy, Debug)]
pub struct Evaluated {
    /// `profile` or `helix`.
    trace: &'static str,
    /// In the order of [`measured::PROFILE`].
    values: [f64; 6],
}

impl Evaluated {
    /// The traces of a modification that comes to these parameters: one, of a grid two, of what was not measured none.
    #[must_use]
    pub fn all(resolved: &[(&'static str, f64)]) -> Vec<Self> {
        let of = |trace: &'static str, names: [&'static str; 6]| {
            let value = |name: &str| resolved.iter().find(|(given, _)| *given == name).map(|(_, value)| *value);
            let mut values = [0.0; 6];
            for (slot, name) in values.iter_mut().zip(names) {
                *slot = value(name).filter(|value| value.is_finite())?;
            }
            Some(Self { trace, values })
        };
        [of("profile", measured::PROFILE), of("helix", measured::HELIX)].into_iter().flatten().collect()
    }
}

/// Adds what traces come to, behind the columns that say whose they are; `get` finds it in a row.
#[must_use]
pub fn columns<T>(columns: Columns<T>, get: impl for<'b> Fn(&'b T) -> &'b Evaluated + Copy + 'static) -> Columns<T> {
    let start = "Where the evaluation starts: roll length of a profile, z of a helix.";
    let slope = "Slope deviation f_Hα or f_Hβ, over the whole of the active flank or of the face.";
    columns
        .text("trace", "Along which way: profile or helix.", move |row| get(row).trace)
        .key()
        .float("start", "mm", start, move |row| get(row).values[0])
        .float("end", "mm", "Where the evaluation ends.", move |row| get(row).values[1])
        .float("slope", "um", slope, move |row| get(row).values[2])
        .float("form", "um", "Form deviation f_fα or f_fβ.", move |row| get(row).values[3])
        .float("total", "um", "Total deviation F_α or F_β.", move |row| get(row).values[4])
        .float("crowning", "um", "Height C_α or C_β of the mean parabola over its chord.", move |row| {
            get(row).values[5]
        })
}
