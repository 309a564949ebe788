//! Cutting a stage along an axis into chunks that are computed and kept by themselves.
//!
//! Where one chunk ends is decided by the value that ends it, not by counting: a value put in between changes the
//! chunk it falls into and no other. Chunks hold as many values as declared on average, at most four times that; on a long
//! axis, where a file for each would cost more than what is in it, twice, four times … as many. Must not know: what the
//! axis is.

use crate::stage::{Kind, parts};
use declare::digest::Writer;
use declare::parameter::Span;
use declare::record::{Record, Value};

/// From about so many chunks on, they hold twice as many values. A value that takes the axis over such a step changes all
/// chunks; any other changes one.
const MOST_CHUNKS: usize = 128;

/// The axis along which a stage is cut, and the values of each chunk, ascending.
#[derive(Clone, Debug, PartialEq)]
pub struct Chunks {
    pub field: &'static str,
    pub values: Vec<Vec<f64>>,
}

/// The chunks of a stage; none when its kind declares no chunked axis.
#[must_use]
pub fn chunks(kind: &Kind, record: &Record) -> Option<Chunks> {
    let (field, chunk) = kind.fields.iter().find_map(|field| match field.span {
        Span::Axis { chunk } if chunk > 0 => Some((field.name, chunk)),
        _ => None,
    })?;
    let Value::Axis(values) = &record.entry(field)?.value else { return None };
    Some(Chunks { field, values: cut(values, size(values.len(), chunk)) })
}

/// How many values a chunk holds on average, of `count` in all: `minimum`, or as many times that as a power of two says.
fn size(count: usize, minimum: usize) -> usize {
    let times = count.div_ceil(minimum).div_ceil(MOST_CHUNKS).max(1);
    minimum.saturating_mul(times.next_power_of_two())
}

fn cut(values: &[f64], chunk: usize) -> Vec<Vec<f64>> {
    let digest = |index: usize| Writer::new("gearstudy 1 chunk end").float(values[index]).finish();
    parts::cut(values.len(), chunk, digest).into_iter().map(|stretch| values[stretch].to_vec()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_value_more_changes_one_chunk() {
        let values: Vec<f64> = (0..400).map(|index| f64::from(index) * 0.5).collect();
        for chunk in [1, 4, 16] {
            let before = cut(&values, chunk);
            assert_eq!(before.concat(), values);
            assert!(before.iter().all(|part| !part.is_empty() && part.len() <= 4 * chunk));
            let mean = 400.0 / before.len() as f64;
            assert!(mean > 0.5 * chunk as f64 && mean < 1.5 * chunk as f64, "{chunk}: {mean}");
            let mut more = 0;
            for extra in 0..400 {
                let mut longer = values.clone();
                longer.insert(extra + 1, f64::from(u32::try_from(extra).unwrap()) * 0.5 + 0.25);
                let after = cut(&longer, chunk);
                more += after.iter().filter(|part| !before.contains(part)).count();
            }
            // Some values end a chunk themselves and make two of one; a chunk that ran full passes one on to the next.
            assert!(more as f64 / 400.0 < 1.5, "{chunk}: {more}");
        }
        assert_eq!(cut(&values, usize::MAX).len(), 1);
        assert_eq!(cut(&[7.0], 4), [[7.0]]);
    }

    /// A file for each of ten thousand values took forty seconds of waiting for the disk.
    #[test]
    fn a_long_axis_has_about_a_hundred_chunks() {
        let count = |values: usize| {
            let values: Vec<f64> = (0..values).map(|index| 1.0 + index as f64 * 0.01).collect();
            cut(&values, size(values.len(), 1)).len()
        };
        assert_eq!([1, 2, 64, 128].map(count), [1, 2, 64, 128], "each value by itself");
        for values in [129, 200, 1000, 10_000, 100_000] {
            let chunks = count(values);
            assert!((40..=160).contains(&chunks), "{values}: {chunks}");
        }
        assert_eq!([size(128, 1), size(129, 1), size(256, 1), size(257, 1)], [1, 2, 2, 4]);
        assert_eq!([size(9, usize::MAX), size(1000, 16), size(100_000, 16)], [usize::MAX, 16, 16 * 64]);
    }
}
