//! Random numbers that depend on nothing but the study's seed, the stage and the row.
//!
//! `ChaCha8`, keyed by a digest of (study seed, stage name), one stream per row: no order of execution and no thread
//! count can enter. Must not know: what the numbers are used for.

use chacha20::ChaCha8Rng;
use rand_core::SeedableRng;

use super::digest::{Digest, Writer};

/// The seed of one stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Seed(Digest);

impl Seed {
    /// A seed of a program without studies.
    #[must_use]
    pub fn new(number: u64) -> Self {
        Self::of_stage(number, "")
    }

    /// The seed of the stage `stage` in a study whose seed is `study`.
    #[must_use]
    pub fn of_stage(study: u64, stage: &str) -> Self {
        Self(Writer::new("gearstudy 1 stage seed").digest(&number(study)).text(stage).finish())
    }

    /// One of many seeds that start here.
    #[must_use]
    pub fn branch(&self, index: usize) -> Self {
        Self(Writer::new("gearstudy 1 seed branch").digest(&self.0).count(index).finish())
    }

    #[must_use]
    pub fn digest(&self) -> Digest {
        self.0
    }

    /// The generator of row `stream`.
    #[must_use]
    pub fn generator(&self, stream: u64) -> ChaCha8Rng {
        let mut generator = ChaCha8Rng::from_seed(self.0.0);
        generator.set_stream(stream);
        generator
    }
}

fn number(value: u64) -> Digest {
    let mut bytes = [0; 32];
    bytes[..8].copy_from_slice(&value.to_le_bytes());
    Digest(bytes)
}

#[cfg(test)]
mod tests {
    use rand_core::Rng;

    use super::*;

    /// J. Strombergson, Test Vectors for the Stream Cipher ChaCha (2013), TC1, 256 bits, 8 rounds.
    #[test]
    fn the_generator_is_chacha8() {
        let mut block = [0; 64];
        Seed(Digest([0; 32])).generator(0).fill_bytes(&mut block);
        let expected = "3e00ef2f895f40d67f5bb8e81f09a5a12c840ec3ce9a7f3b181be188ef711a1e\
                        984ce172b9216f419f445367456d5619314a42a3da86b001387bfdb80e0cfe42";
        assert_eq!(block.map(|byte| format!("{byte:02x}")).concat(), expected);
    }

    #[test]
    fn streams_and_stages_are_apart_and_repeat() {
        let draw = |study, stage: &str, stream| Seed::of_stage(study, stage).generator(stream).next_u64();
        assert_eq!(draw(7, "optimum", 0), draw(7, "optimum", 0));
        assert_ne!(draw(7, "optimum", 0), draw(7, "optimum", 1));
        assert_ne!(draw(7, "optimum", 0), draw(8, "optimum", 0));
        assert_ne!(draw(7, "optimum", 0), draw(7, "optimum2", 0));
        let seed = Seed::of_stage(7, "optimum");
        assert_ne!(seed.branch(0), seed);
        assert_ne!(seed.branch(0), seed.branch(1));
        assert_eq!(seed.branch(1), Seed::of_stage(7, "optimum").branch(1));
    }
}
