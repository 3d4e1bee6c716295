//! Still pictures of triangle meshes by ray casting
