//! Pipelines that join and blend triangle meshes
