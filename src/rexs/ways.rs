//! The ways in which versions say one quantity, and units. Must not know: what a quantity is for.

use super::Refusal;
use super::model::{Component, Fate, Said, Units, refuse};

/// Values of one quantity that differ by more than this share, or by more than this in modules, mm or degrees, contradict each other: less is
/// rounding of a printed number.
const ROUNDED: f64 = 5e-3;

pub(super) const LENGTHS: Units =
    &[("mm", 1.0), ("mum", 1e-3), ("um", 1e-3), ("µm", 1e-3), ("μm", 1e-3), ("m", 1e3), ("cm", 10.0)];
pub(super) const ANGLES: Units = &[("deg", 1.0), ("°", 1.0), ("rad", 180.0 / std::f64::consts::PI)];
pub(super) const PLAIN: Units = &[("none", 1.0), ("", 1.0), ("-", 1.0)];
pub(super) const STRESSES: Units = &[("MPa", 1.0), ("N / mm^2", 1.0), ("N/mm^2", 1.0), ("GPa", 1e3)];
pub(super) const DENSITIES: Units = &[("kg / dm^3", 1e3), ("kg/dm^3", 1e3), ("kg / m^3", 1.0), ("kg/m^3", 1.0)];

/// A way to say a quantity: an attribute, its units, and by what it is divided.
pub(super) type Way<'w> = (&'w str, Units, f64);

/// The one value that several components give in the first of several ways; the others say it again, or contradict it.
pub(super) fn agreed(components: &[&Component], ways: &[Way]) -> Result<Option<Said>, Refusal> {
    let mut found: Option<(Said, &str)> = None;
    for (name, units, divisor) in ways {
        if let Some((known, _)) = found {
            for component in components {
                component.compare(name, units, *divisor, known.value);
            }
            continue;
        }
        for component in components {
            let Some(said) = component.number(name, units)? else { continue };
            match found {
                Some((other, id)) if (other.value - said.value).abs() > 1e-12 * said.value.abs() => {
                    let message = format!(
                        "`{name}` is {} of the component {id} and {} of {}; both flanks of a gear must be alike",
                        other.value, said.value, component.id
                    );
                    return refuse(said.at, message);
                }
                _ => found = Some((said, &component.id)),
            }
        }
        found = found.map(|(said, id)| (said.map(|value| value / divisor), id));
    }
    Ok(found.map(|(said, _)| said))
}

impl Component {
    /// Notes whether an attribute that is not read says a value again or contradicts it.
    pub(super) fn compare(&self, name: &str, units: Units, divisor: f64, known: f64) {
        let fate = match self.number(name, units) {
            Ok(None) => return,
            Ok(Some(said)) => {
                let value = said.value / divisor;
                let is_rounded = (value - known).abs() <= ROUNDED * f64::max(1.0, known.abs());
                if is_rounded { Fate::Follows } else { Fate::Contradicts }
            }
            Err(_) => Fate::NotSupported,
        };
        self.set(name, fate);
    }
}

/// A value above 0; 0 says that there is none.
pub(super) fn some(said: Option<Said>) -> Option<Said> {
    said.filter(|said| said.value > 0.0)
}
