//! Why two specifications are no pair of gears. Every message carries the values and the admissible range; lengths are
//! shown in mm, angles in degrees. Must not know: where the specification was written.

/// A specification that is no gear, or two gears that do not mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GeometryError {
    #[error("the {gear} is impossible: {problem}")]
    Gear { gear: &'static str, field: &'static str, problem: String },
    #[error("the pair is impossible: {problem}")]
    Pair { field: &'static str, problem: String },
}

impl GeometryError {
    /// The parameter it is about, for example `pinion.teeth`.
    #[must_use]
    pub fn field(&self) -> String {
        match self {
            Self::Gear { field, .. } if field.contains('.') => (*field).to_owned(),
            Self::Gear { gear, field, .. } => format!("{gear}.{field}"),
            Self::Pair { field, .. } => (*field).to_owned(),
        }
    }
}

/// A length for a message.
pub(super) fn mm(length: f64) -> String {
    let text = format!("{:.6}", length * 1e3);
    format!("{} mm", text.trim_end_matches('0').trim_end_matches('.'))
}
