//! The halfedges that are still to be looked at.

use rayon::prelude::*;

/// A set of halfedges, taken in the order of their ids.
///
/// A sweep that looks only at what is worth it from the start, and at what an edit may have changed, finds what one over all
/// halfedges finds, in the same order.
pub(crate) struct Agenda {
    words: Vec<u64>,
}

impl Agenda {
    /// Those below `count` that are worth a look, asked in parallel.
    pub fn of(count: u32, is_worth: impl Fn(u32) -> bool + Sync) -> Self {
        let word =
            |w: u32| (64 * w..count.min(64 * w + 64)).fold(0, |bits, h| bits | u64::from(is_worth(h)) << (h % 64));
        Self { words: (0..count.div_ceil(64)).into_par_iter().with_min_len(64).map(word).collect() }
    }

    #[inline]
    pub fn add(&mut self, h: u32) {
        let word = h as usize / 64;
        if word >= self.words.len() {
            self.words.resize(word + 1, 0);
        }
        self.words[word] |= 1 << (h % 64);
    }

    /// Takes the first from `from` on.
    #[inline]
    pub fn take(&mut self, from: u32) -> Option<u32> {
        let mut word = from as usize / 64;
        let mut bits = self.words.get(word)? & (u64::MAX << (from % 64));
        while bits == 0 {
            word += 1;
            bits = *self.words.get(word)?;
        }
        self.words[word] &= !(bits & bits.wrapping_neg());
        Some(64 * word as u32 + bits.trailing_zeros())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    proptest! {
        #[test]
        fn is_a_set(count in 0u32..200, odd in prop::bool::ANY, steps in prop::collection::vec((0u32..300, prop::bool::ANY), 0..100)) {
            let is_worth = |h: u32| !odd || h % 2 == 1;
            let (mut agenda, mut twin) = (Agenda::of(count, is_worth), (0..count).filter(|&h| is_worth(h)).collect::<BTreeSet<u32>>());
            for (h, adds) in steps {
                if adds {
                    agenda.add(h);
                    twin.insert(h);
                } else {
                    let first = twin.range(h..).next().copied();
                    first.map(|h| twin.remove(&h));
                    prop_assert_eq!(agenda.take(h), first);
                }
            }
        }
    }
}
