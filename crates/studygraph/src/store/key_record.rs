//! The parts of a cache key, so that two runs can say *why* they differ.
//!
//! The key is kept whole. Of its parts only the beginnings are: they explain a difference and decide nothing. Must not know:
//! how keys are made.

use std::fmt;
use std::sync::Arc;

use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

use super::shared;
use declare::digest::Digest;

/// The beginning of a digest: twelve hexadecimal digits.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Short([u8; 6]);

impl From<&Digest> for Short {
    fn from(digest: &Digest) -> Self {
        let mut start = [0; 6];
        start.copy_from_slice(&digest.0[..6]);
        Self(start)
    }
}

impl fmt::Display for Short {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(formatter, "{byte:02x}"))
    }
}

impl fmt::Debug for Short {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "Short({self})")
    }
}

impl Serialize for Short {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let digits = self.0.map(|byte| [byte >> 4, byte & 15].map(|digit| b"0123456789abcdef"[usize::from(digit)]));
        serializer.serialize_str(std::str::from_utf8(digits.as_flattened()).unwrap_or_default())
    }
}

impl<'de> Deserialize<'de> for Short {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl serde::de::Visitor<'_> for Visitor {
            type Value = Short;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("at least 12 hexadecimal digits")
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<Short, E> {
                short(text).ok_or_else(|| E::invalid_value(serde::de::Unexpected::Str(text), &self))
            }
        }
        deserializer.deserialize_str(Visitor)
    }
}

/// None for what does not begin with twelve hexadecimal digits.
fn short(text: &str) -> Option<Short> {
    let digits = text.as_bytes().get(..12)?;
    let mut start = [0; 6];
    for (byte, pair) in start.iter_mut().zip(digits.chunks_exact(2)) {
        let digit = |byte: u8| char::from(byte).to_digit(16).and_then(|digit| u8::try_from(digit).ok());
        *byte = digit(pair[0])? << 4 | digit(pair[1])?;
    }
    Some(Short(start))
}

/// One chunk of a stage, or all of it: its key, and what the key was made from.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq, Eq)]
pub struct KeyRecord {
    #[serde(with = "super::hexadecimal")]
    pub key: Digest,
    /// All fields but the chunked axis.
    pub config: Short,
    /// Field, and its digest: which part of `config` it was that changed.
    #[serde(default, serialize_with = "shared::serialize", deserialize_with = "shared::all")]
    pub fields: Arc<[(String, Short)]>,
    /// The values of the chunked axis; none for a stage that runs in one piece.
    #[serde(default, with = "optional")]
    pub axis: Option<Short>,
    /// Kind, version and sources.
    pub code: Short,
    /// None for a stage that draws no random numbers.
    #[serde(default, with = "optional")]
    pub seed: Option<Short>,
    pub demand: Short,
    /// Port, and the digest of what came in through it.
    #[serde(serialize_with = "shared::serialize", deserialize_with = "shared::all")]
    pub inputs: Arc<[(String, Short)]>,
}

/// Nothing is an empty text.
pub(super) mod optional {
    use super::{Short, short};
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    #[allow(clippy::ref_option, clippy::trivially_copy_pass_by_ref)] // as serde calls it
    pub fn serialize<S: Serializer>(value: &Option<Short>, serializer: S) -> Result<S::Ok, S::Error> {
        match value {
            Some(value) => value.serialize(serializer),
            None => serializer.serialize_str(""),
        }
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Short>, D::Error> {
        let text = std::borrow::Cow::<str>::deserialize(deserializer)?;
        let wrong = || D::Error::custom("at least 12 hexadecimal digits expected");
        if text.is_empty() { Ok(None) } else { short(&text).ok_or_else(wrong).map(Some) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Manifests of earlier versions have whole digests.
    #[test]
    fn a_record_is_read_whether_its_digests_are_whole_or_not() {
        let digest = Digest(std::array::from_fn(|index| u8::try_from(index * 7).unwrap()));
        let start = Short::from(&digest);
        assert_eq!(start.to_string(), digest.short());
        let record = KeyRecord {
            key: digest,
            config: start,
            fields: vec![("teeth".to_owned(), start)].into(),
            axis: Some(start),
            code: start,
            seed: None,
            demand: start,
            inputs: vec![("pair".to_owned(), start)].into(),
        };
        let text = serde_json::to_string(&record).unwrap();
        assert_eq!(serde_json::from_str::<KeyRecord>(&text).unwrap(), record);
        let whole = text.replace(&format!("\"{start}\""), &format!("\"{digest}\""));
        assert!(whole.len() > text.len());
        assert_eq!(serde_json::from_str::<KeyRecord>(&whole).unwrap(), record);
        for wrong in ["0123456789a", "0123456789ag", "é", ""] {
            assert!(serde_json::from_value::<Short>(wrong.into()).is_err(), "{wrong}");
        }
    }
}
