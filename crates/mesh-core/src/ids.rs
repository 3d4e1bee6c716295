//! Typed indices. A `VertexId` cannot be used where a `FaceId` is meant.

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(transparent)]
        pub struct $name(pub u32);

        impl $name {
            /// The id as an index into a flat array.
            #[inline]
            pub const fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl From<usize> for $name {
            /// Narrows an array index. Meshes are limited to `u32::MAX / 3` faces, which [`crate::Connected`] checks.
            #[inline]
            fn from(index: usize) -> Self {
                debug_assert!(u32::try_from(index).is_ok());
                Self(index as u32)
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                self.0.fmt(f)
            }
        }

        impl crate::map::Id for $name {
            #[inline]
            fn index(self) -> usize {
                self.0 as usize
            }
        }
    };
}

id!(
    /// A vertex.
    VertexId
);
id!(
    /// A triangle.
    FaceId
);
id!(
    /// A directed side of a triangle: `h = 3·f + corner`, from corner `corner` to the next one.
    HalfedgeId
);
id!(
    /// An undirected edge, named by the lower of its two halfedges. Edge ids are therefore sparse.
    EdgeId
);

impl FaceId {
    /// Its three halfedges, from the one that leaves its first corner.
    #[inline]
    #[must_use]
    pub const fn halfedges(self) -> [HalfedgeId; 3] {
        [HalfedgeId::new(self, 0), HalfedgeId::new(self, 1), HalfedgeId::new(self, 2)]
    }
}

impl HalfedgeId {
    /// The halfedge of `face` that leaves its `corner` (0, 1 or 2).
    #[inline]
    pub const fn new(face: FaceId, corner: usize) -> Self {
        Self(3 * face.0 + corner as u32)
    }

    /// The triangle this halfedge bounds.
    #[inline]
    pub const fn face(self) -> FaceId {
        FaceId(self.0 / 3)
    }

    /// The corner (0, 1 or 2) this halfedge leaves.
    #[inline]
    pub const fn corner(self) -> usize {
        (self.0 % 3) as usize
    }

    /// The next halfedge around the same triangle.
    #[inline]
    #[must_use]
    pub const fn next(self) -> Self {
        Self(if self.0 % 3 == 2 { self.0 - 2 } else { self.0 + 1 })
    }

    /// The previous halfedge around the same triangle.
    #[inline]
    #[must_use]
    pub const fn prev(self) -> Self {
        Self(if self.0.is_multiple_of(3) { self.0 + 2 } else { self.0 - 1 })
    }
}
