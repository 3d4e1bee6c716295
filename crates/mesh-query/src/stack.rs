//! The traversal stack: on the stack of the thread while shallow, on the heap when a degenerate tree is deep.

const INLINE: usize = 40;

pub(crate) struct Stack<T> {
    inline: [T; INLINE],
    len: usize,
    spill: Vec<T>,
}

impl<T: Copy + Default> Stack<T> {
    #[inline]
    pub(crate) fn new() -> Self {
        Self { inline: [T::default(); INLINE], len: 0, spill: Vec::new() }
    }

    #[inline]
    pub(crate) fn push(&mut self, value: T) {
        if self.len < INLINE {
            self.inline[self.len] = value;
            self.len += 1;
        } else {
            self.spill.push(value);
        }
    }

    #[inline]
    pub(crate) fn pop(&mut self) -> Option<T> {
        if let Some(value) = self.spill.pop() {
            return Some(value);
        }
        self.len = self.len.checked_sub(1)?;
        Some(self.inline[self.len])
    }
}
