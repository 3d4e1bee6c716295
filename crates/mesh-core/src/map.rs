//! Vectors indexed by typed ids: attributes that the caller owns.

use crate::ids::{FaceId, HalfedgeId, VertexId};
use std::marker::PhantomData;
use std::ops::{Index, IndexMut};

/// An id that is an index into a flat array.
pub trait Id: Copy {
    /// The id as an array index.
    fn index(self) -> usize;
}

/// A vector indexed by `I`.
#[derive(Clone, Debug, PartialEq)]
pub struct IdMap<I, T> {
    values: Vec<T>,
    id: PhantomData<fn(I)>,
}

/// One value per vertex.
pub type VertexMap<T> = IdMap<VertexId, T>;
/// One value per triangle.
pub type FaceMap<T> = IdMap<FaceId, T>;
/// One value per triangle corner, addressed by the halfedge that leaves it. UV seams live here.
pub type CornerMap<T> = IdMap<HalfedgeId, T>;

impl<I: Id, T> IdMap<I, T> {
    /// `len` copies of `value`.
    pub fn filled(len: usize, value: T) -> Self
    where
        T: Clone,
    {
        vec![value; len].into()
    }

    /// The value of `id`, or `None` beyond the end.
    pub fn get(&self, id: I) -> Option<&T> {
        self.values.get(id.index())
    }

    /// How many values there are.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Whether there are no values.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// The values in id order.
    pub fn as_slice(&self) -> &[T] {
        &self.values
    }

    /// The values in id order, mutable.
    pub fn as_mut_slice(&mut self) -> &mut [T] {
        &mut self.values
    }

    /// Appends the value of the next id.
    pub fn push(&mut self, value: T) {
        self.values.push(value);
    }

    /// Gives up the values.
    pub fn into_vec(self) -> Vec<T> {
        self.values
    }
}

impl<I, T> From<Vec<T>> for IdMap<I, T> {
    fn from(values: Vec<T>) -> Self {
        Self { values, id: PhantomData }
    }
}

impl<I, T> Default for IdMap<I, T> {
    fn default() -> Self {
        Vec::new().into()
    }
}

impl<I: Id, T> Index<I> for IdMap<I, T> {
    type Output = T;
    #[inline]
    fn index(&self, id: I) -> &T {
        &self.values[id.index()]
    }
}

impl<I: Id, T> IndexMut<I> for IdMap<I, T> {
    #[inline]
    fn index_mut(&mut self, id: I) -> &mut T {
        &mut self.values[id.index()]
    }
}
