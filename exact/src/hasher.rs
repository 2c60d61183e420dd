//! Fast hashing of field elements and small keys: one multiplication per word.
//!
//! No order depends on a hash. Keys come from the generator and not from a user, so a hash that
//! resists attacks, which takes several times longer, is not needed.

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

/// A map with fast hashing.
pub type QuickMap<K, T> = HashMap<K, T, BuildHasherDefault<FieldHasher>>;

/// A set with fast hashing.
pub type QuickSet<T> = HashSet<T, BuildHasherDefault<FieldHasher>>;
