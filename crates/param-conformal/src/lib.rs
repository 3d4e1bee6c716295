//! Fixed-boundary conformal maps of rings and discs of triangles.
