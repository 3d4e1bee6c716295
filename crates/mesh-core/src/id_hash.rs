//! Tables keyed by ids, with a fast hash: ids are not chosen by an attacker.

use rustc_hash::{FxHashMap, FxHashSet};

/// A set of ids. Iteration order is unspecified.
pub type IdSet<Id> = FxHashSet<Id>;

/// A map from ids. Iteration order is unspecified.
pub(crate) type IdTable<Id, T> = FxHashMap<Id, T>;
