//! The fields of a stage as a manifest shows them: JSON that is kept as the text it is, and looked into only where two runs
//! differ. Thousands of stages as trees of JSON took a tenth of a run that had little to do.
//!
//! Must not know: what any field means.

use std::sync::Arc;

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;
use serde_json::value::RawValue;

use super::lines::Lines;

/// JSON as its text.
#[derive(Clone, Debug)]
pub struct Config(Arc<RawValue>);

impl Config {
    /// As a manifest has it in its place.
    #[must_use]
    pub fn of(value: &impl Serialize) -> Self {
        let mut text = Vec::new();
        let written =
            value.serialize(&mut serde_json::Serializer::with_formatter(&mut text, Lines::inside(Self::DEPTH)));
        let text = written.ok().and_then(|()| String::from_utf8(text).ok());
        let raw = text.and_then(|text| RawValue::from_string(text).ok());
        Self(raw.unwrap_or_else(|| RawValue::NULL.to_owned()).into())
    }

    /// How many lists and objects of a manifest are around it.
    const DEPTH: usize = 3;

    /// What it says.
    #[must_use]
    pub fn value(&self) -> Value {
        serde_json::from_str(self.0.get()).unwrap_or_default()
    }

    pub(super) fn is_null(&self) -> bool {
        self.0.get() == "null"
    }
}

impl Default for Config {
    fn default() -> Self {
        Self(RawValue::NULL.to_owned().into())
    }
}

/// Another program may have written the same otherwise.
impl PartialEq for Config {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0.get() == other.0.get() || self.value() == other.value()
    }
}

impl From<Value> for Config {
    fn from(value: Value) -> Self {
        Self::of(&value)
    }
}

impl Serialize for Config {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Config {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Ok(Self(Box::<RawValue>::deserialize(deserializer)?.into()))
    }
}
