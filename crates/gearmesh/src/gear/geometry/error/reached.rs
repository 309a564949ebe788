//! How deep interference reaches, and how a message says it. Must not know: what touches.

use std::fmt;

use super::shown::{Millimetres, beside};

/// How deep interference reaches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reached {
    /// Down to this radius of the gear \[m\], below its form radius.
    Radius(Millimetres),
    /// Beyond the tangent point of the path of contact, where there is no involute.
    InsideBaseCircle,
}

impl Reached {
    /// Beside the form radius, which it is below.
    pub(super) fn beside(&self, form: Millimetres) -> String {
        match self {
            Self::Radius(radius) => format!("at a radius of {}", beside(radius, &form)),
            Self::InsideBaseCircle => self.to_string(),
        }
    }

    /// The form radius beside it.
    pub(super) fn form(&self, form: Millimetres) -> String {
        if let Self::Radius(radius) = self { beside(&form, radius) } else { form.to_string() }
    }
}

impl fmt::Display for Reached {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Radius(radius) => write!(formatter, "at a radius of {radius}"),
            Self::InsideBaseCircle => formatter.write_str("beyond the tangent point on the base circle"),
        }
    }
}
