//! The formats.

use std::fmt;

/// A mesh file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Wavefront OBJ with MTL side file.
    Obj,
    /// Stereolithography; both kinds are read, binary is written.
    Stl,
    /// Stanford PLY; all three kinds are read, binary little-endian with `double` positions is written.
    Ply,
    /// Object File Format; text dialects.
    Off,
    /// glTF 2.0 in one binary file.
    Glb,
    /// glTF 2.0 as JSON with a `.bin` side file.
    Gltf,
    /// 3D Manufacturing Format.
    ThreeMf,
}

impl Format {
    /// Every format.
    pub const ALL: [Self; 7] = [Self::Obj, Self::Stl, Self::Ply, Self::Off, Self::Glb, Self::Gltf, Self::ThreeMf];

    /// The format's name, which is also its file extension.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Obj => "obj",
            Self::Stl => "stl",
            Self::Ply => "ply",
            Self::Off => "off",
            Self::Glb => "glb",
            Self::Gltf => "gltf",
            Self::ThreeMf => "3mf",
        }
    }

    /// Whether positions keep every bit of an f64. Where not, see [`crate::as_written`].
    pub const fn is_lossless(self) -> bool {
        !matches!(self, Self::Stl | Self::Glb | Self::Gltf)
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
