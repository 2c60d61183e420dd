//! Pseudo-random numbers that are equal in every run and on every machine.

use super::field::mix;

/// A deterministic stream of numbers in (-1, 1).
#[derive(Debug)]
pub struct Stream(u64);

impl Stream {
    /// A stream for a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(mix(seed))
    }

    /// The next number.
    pub fn number(&mut self) -> f64 {
        self.0 = mix(self.0);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
    /// The next integer below a bound; zero for bound zero.
    pub fn below(&mut self, bound: usize) -> usize {
        self.0 = mix(self.0);
        ((u128::from(self.0) * bound as u128) >> 64) as usize
    }
}
