//! Exact-predicate triangle-mesh intersection, cutting and booleans
