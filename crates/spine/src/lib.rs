//! Rolling-ball spine and linkage curves on triangle meshes
