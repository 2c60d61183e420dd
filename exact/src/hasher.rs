//! Hashing of field elements, which are random already, and of what is small: one multiplication a word.
//!
//! No order depends on a hash. Keys come from the generator and not from a user, so nothing is gained by
//! a hash that no one can foresee, which takes several times longer.

use std::collections::{HashMap, HashSet};
use std::hash::{BuildHasherDefault, Hasher};

/// A multiplicative hash of words.
#[derive(Debug, Default, Clone)]
pub struct FieldHasher(u64);

impl Hasher for FieldHasher {
    #[inline]
    fn finish(&self) -> u64 {
        self.0
    }
    #[inline]
    fn write(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.write_u64(u64::from(*byte));
        }
    }
    #[inline]
    fn write_u32(&mut self, value: u32) {
        self.write_u64(u64::from(value));
    }
    #[inline]
    fn write_u64(&mut self, value: u64) {
        self.0 = (self.0.rotate_left(23) ^ value).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }
    #[inline]
    fn write_i128(&mut self, value: i128) {
        self.write_u64(value as u64);
        self.write_u64((value >> 64) as u64);
    }
    #[inline]
    fn write_usize(&mut self, value: usize) {
        self.write_u64(value as u64);
    }
    #[inline]
    fn write_isize(&mut self, value: isize) {
        self.write_u64(value as u64);
    }
}

/// A map whose keys are hashed quickly.
pub type QuickMap<K, T> = HashMap<K, T, BuildHasherDefault<FieldHasher>>;

/// A set of what is hashed quickly.
pub type QuickSet<T> = HashSet<T, BuildHasherDefault<FieldHasher>>;
