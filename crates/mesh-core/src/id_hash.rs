//! Tables keyed by ids, which are spread by one multiplication: they are nobody's attack.

use std::collections::{HashMap, HashSet};
use std::hash::{BuildHasherDefault, Hasher};

/// A set of ids. Its order is no order to be read out in.
pub type IdSet<Id> = HashSet<Id, BuildHasherDefault<IdHasher>>;

/// A map from ids. Its order is no order to be read out in.
pub(crate) type IdTable<Id, T> = HashMap<Id, T, BuildHasherDefault<IdHasher>>;

/// Spreads u32 ids over the table.
#[derive(Clone, Copy, Debug, Default)]
pub struct IdHasher(u64);

impl Hasher for IdHasher {
    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.write_u32(u32::from(byte));
        }
    }
    #[inline]
    fn write_u32(&mut self, id: u32) {
        self.0 = (self.0 ^ u64::from(id)).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(32);
    }
    #[inline]
    fn finish(&self) -> u64 {
        self.0
    }
}
