//! Geometry detail carried from one region of a surface to another.
