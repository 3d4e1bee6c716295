//! Which entries of a vector are asked for, and which are held.

const HELD: u32 = u32::MAX;

/// The free entries of a vector, numbered in ascending order.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknowns {
    free: Vec<u32>,
    number: Vec<u32>,
}

impl Unknowns {
    /// Of `count` entries, those that `free` says.
    pub fn new(count: usize, free: impl Fn(usize) -> bool) -> Self {
        let free: Vec<u32> = (0..count).filter(|&i| free(i)).map(|i| i as u32).collect();
        let mut number = vec![HELD; count];
        (0..).zip(&free).for_each(|(k, &i)| number[i as usize] = k);
        Self { free, number }
    }

    /// The free entries, ascending.
    pub fn free(&self) -> &[u32] {
        &self.free
    }

    /// The number of an entry among the free ones; `None` where it is held or there is none.
    #[inline]
    pub fn number(&self, entry: usize) -> Option<u32> {
        self.number.get(entry).copied().filter(|&k| k != HELD)
    }
}
