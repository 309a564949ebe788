//! Digests for serde: as 64 hexadecimal digits where people read them, else as their bytes. Must not know: what they are of.

use std::fmt;

use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

use declare::digest::Digest;

/// 64 digits. Many are written in a run: this takes a tenth of what a formatter does.
#[must_use]
pub fn text(digest: &Digest) -> String {
    blake3::Hash::from_bytes(digest.0).to_hex().to_string()
}

/// # Errors
/// Those of the serializer.
pub fn serialize<S: Serializer>(digest: &Digest, serializer: S) -> Result<S::Ok, S::Error> {
    if serializer.is_human_readable() {
        serializer.serialize_str(&text(digest))
    } else {
        digest.0.serialize(serializer)
    }
}

/// # Errors
/// For anything but 64 hexadecimal digits.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Digest, D::Error> {
    if !deserializer.is_human_readable() {
        return <[u8; 32]>::deserialize(deserializer).map(Digest);
    }
    deserializer.deserialize_str(Visitor)
}

struct Visitor;
impl serde::de::Visitor<'_> for Visitor {
    type Value = Digest;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("64 hexadecimal digits")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Digest, E> {
        Digest::from_hex(text).ok_or_else(|| E::invalid_value(serde::de::Unexpected::Str(text), &self))
    }
}
