//! The canonical digest: one writer for everything that is hashed, so two things hash alike only when they are alike.
//!
//! Every value is written with a tag and, where its length varies, its length: `["ab","c"]` and `["a","bc"]` differ.
//! BLAKE3 in `derive_key` mode separates the uses by context. Must not know: what it is a digest of.

use std::fmt;

/// 256 bits, shown as hexadecimal.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Digest(pub [u8; 32]);

impl Digest {
    /// The first twelve hexadecimal digits: enough to tell two apart for a reader.
    #[must_use]
    pub fn short(&self) -> String {
        self.to_string()[..12].to_owned()
    }

    /// Reads 64 hexadecimal digits.
    #[must_use]
    pub fn from_hex(text: &str) -> Option<Self> {
        let bytes = text.as_bytes();
        if bytes.len() != 64 {
            return None;
        }
        let mut digest = [0; 32];
        for (byte, pair) in digest.iter_mut().zip(bytes.chunks_exact(2)) {
            let high = char::from(pair[0]).to_digit(16)?;
            let low = char::from(pair[1]).to_digit(16)?;
            *byte = u8::try_from(high * 16 + low).ok()?;
        }
        Some(Self(digest))
    }
}

impl fmt::Display for Digest {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digit = |value: u8| b"0123456789abcdef"[usize::from(value)];
        let digits: Vec<u8> = self.0.iter().flat_map(|byte| [digit(byte >> 4), digit(byte & 15)]).collect();
        formatter.write_str(std::str::from_utf8(&digits).unwrap_or_default())
    }
}

impl fmt::Debug for Digest {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "Digest({self})")
    }
}

/// Bytes that are hashed at once: many values, for the hash is quick on kilobytes and slow on the nine bytes of a number.
const PENDING: usize = 1 << 15;

/// Writes values into a digest.
pub struct Writer {
    hasher: blake3::Hasher,
    /// Written, but not yet hashed.
    pending: Vec<u8>,
}

impl Writer {
    /// `context` names the use, for example `gearstudy 1 table content`; it never changes once released.
    #[must_use]
    pub fn new(context: &str) -> Self {
        Self { hasher: blake3::Hasher::new_derive_key(context), pending: Vec::new() }
    }

    fn tagged(&mut self, tag: u8, bytes: &[u8]) -> &mut Self {
        self.pending.push(tag);
        self.pending.extend_from_slice(bytes);
        self.hash_from(PENDING)
    }

    /// Hashes what is pending once it has `length` bytes.
    fn hash_from(&mut self, length: usize) -> &mut Self {
        if self.pending.len() >= length {
            self.hasher.update(&self.pending);
            self.pending.clear();
        }
        self
    }

    pub fn text(&mut self, text: &str) -> &mut Self {
        self.count(text.len()).tagged(b't', text.as_bytes())
    }

    pub fn count(&mut self, count: usize) -> &mut Self {
        self.tagged(b'n', &(count as u64).to_le_bytes())
    }

    pub fn integer(&mut self, value: i64) -> &mut Self {
        self.tagged(b'i', &value.to_le_bytes())
    }

    pub fn flag(&mut self, value: bool) -> &mut Self {
        self.tagged(b'b', &[u8::from(value)])
    }

    /// The bits of `value`; −0 counts as 0 and every NaN as one, so equal numbers have equal digests.
    pub fn float(&mut self, value: f64) -> &mut Self {
        self.tagged(b'f', &canonical_bits(value).to_le_bytes())
    }

    /// A whole column at once: as [`Writer::float`] for each value, behind one tag.
    pub fn floats(&mut self, values: &[f64]) -> &mut Self {
        self.begin_floats(values.len()).more_floats(values)
    }

    /// A whole column that comes in pieces: so many values follow by [`Writer::more_floats`].
    pub fn begin_floats(&mut self, count: usize) -> &mut Self {
        self.count(count).tagged(b'F', &[])
    }

    /// The next values of a column that was begun.
    pub fn more_floats(&mut self, values: &[f64]) -> &mut Self {
        for chunk in values.chunks(PENDING / 8) {
            let from = self.pending.len();
            self.pending.resize(from + 8 * chunk.len(), 0);
            for (slot, value) in self.pending[from..].chunks_exact_mut(8).zip(chunk) {
                slot.copy_from_slice(&canonical_bits(*value).to_le_bytes());
            }
            self.hash_from(PENDING);
        }
        self
    }

    pub fn digest(&mut self, digest: &Digest) -> &mut Self {
        self.tagged(b'd', &digest.0)
    }

    #[must_use]
    pub fn finish(&self) -> Digest {
        Digest(*self.hasher.clone().update(&self.pending).finalize().as_bytes())
    }
}

fn canonical_bits(value: f64) -> u64 {
    if value.is_nan() {
        f64::NAN.to_bits()
    } else if value == 0.0 {
        0
    } else {
        value.to_bits()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_keep_neighbours_apart() {
        let digest = |parts: &[&str]| {
            let mut writer = Writer::new("test");
            for part in parts {
                writer.text(part);
            }
            writer.finish()
        };
        assert_ne!(digest(&["ab", "c"]), digest(&["a", "bc"]));
        assert_eq!(digest(&["ab", "c"]), digest(&["ab", "c"]));
    }

    #[test]
    fn equal_numbers_have_equal_digests() {
        let digest = |value: f64| Writer::new("test").float(value).finish();
        assert_eq!(digest(0.0), digest(-0.0));
        assert_eq!(digest(f64::NAN), digest(-f64::NAN));
        assert_ne!(digest(1.0), digest(1.0 + f64::EPSILON));
    }

    /// Tier: second method; the same bytes in one piece, at lengths around those that are hashed at once.
    #[test]
    fn bytes_are_those_of_one_piece() {
        for count in [0, 1, 3639, 3640, 3641, 3642, 4094, 4095, 4096, 8190, 8191, 8192, 20_000] {
            let values: Vec<f64> = (0..count).map(|at| f64::from(at) - 5.5).collect();
            let mut writer = Writer::new("test");
            let mut bytes = Vec::new();
            for value in &values {
                writer.float(*value);
                bytes.push(b'f');
                bytes.extend(value.to_le_bytes());
            }
            writer.floats(&values);
            bytes.push(b'n');
            bytes.extend((values.len() as u64).to_le_bytes());
            bytes.push(b'F');
            bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
            assert_eq!(writer.finish().0, blake3::derive_key("test", &bytes), "{count}");
        }
    }

    #[test]
    fn hexadecimal_round_trips() {
        let digest = Writer::new("test").text("x").finish();
        assert_eq!(Digest::from_hex(&digest.to_string()), Some(digest));
        assert_eq!(Digest::from_hex("xyz"), None);
    }
}
