//! Reads and writes OBJ, STL, PLY, OFF, glTF and 3MF triangle meshes
