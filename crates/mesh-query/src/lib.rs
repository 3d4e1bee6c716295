//! Closest points, rays and overlapping triangle pairs on triangle meshes
